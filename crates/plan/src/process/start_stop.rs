//! The section `[start_stop]`: how passes begin and end, and how long layers wait for each other.

use crate::limit::{Broken, broken_row, section};
use serde::{Deserialize, Serialize};

section! {
    /// How passes begin and end, and how long layers wait; every key has a default, and with the defaults nothing
    /// changes.
    ///
    /// Power is given as a multiple of the nominal energy per length of bead. In the arcs used here (synergic lines,
    /// CMT) the current follows the wire feed, so there is no heat without metal: per length, both grow in proportion
    /// to the power. With `process.follow = "speed"` the torch moves at speed / power; with `"wire-feed"` the wire is
    /// fed at feed · power.
    StartStop "start_stop" {
        /// How far closed passes continue along their path beyond their start, mm, so that the seam is fused; at most
        /// once around; default 0.
        end_overlap: f64 = 0.0, 0.0, 200.0, "mm", "a longer overlap is a second bead";
        /// Length of the hot start of a pass (lead-in), where the part is still cold, mm; default 0. Where a pass is
        /// too short for both, lead-in and lead-out are shortened in proportion.
        lead_in_length: f64 = 0.0, 0.0, 200.0, "mm", "a longer one would be a pass of its own";
        /// Power along the lead-in, as a multiple of the nominal power, 1 or more; default 1.
        lead_in_power: f64 = 1.0, 1.0, 4.0, "times the nominal power",
            "a hot start has more power than the rest of the pass, but must not burn through";
        /// Length of the end of a pass (lead-out) that is laid with less power, mm, so that heat and metal do not pile
        /// up; default 0.
        lead_out_length: f64 = 0.0, 0.0, 200.0, "mm", "a longer one would be a pass of its own";
        /// Power along the lead-out, as a fraction of the nominal power, 1 or less; default 1.
        lead_out_power: f64 = 1.0, 0.1, 1.0, "times the nominal power",
            "the end of a pass has less power than the rest of it";
        /// How much higher than the rest of the bead a pass is where it starts, mm: the cold bead stands up before it
        /// flows; default 0. Only the deposit model uses this and `hump_length`, `crater_depth` and `crater_length`;
        /// leave it at 0 if it was never measured.
        hump_height: f64 = 0.0, 0.0, 50.0, "mm", "beyond this it is no longer the start or end of a pass";
        /// Length over which the hump at the start of a pass falls to nothing, mm; default 0.
        hump_length: f64 = 0.0, 0.0, 200.0, "mm", "beyond this it is no longer the start or end of a pass";
        /// How much lower than the rest of the bead a pass is where it ends, mm; default 0.
        crater_depth: f64 = 0.0, 0.0, 50.0, "mm", "beyond this it is no longer the start or end of a pass";
        /// Length over which the bead falls to `crater_depth` at the end of a pass, mm; default 0.
        crater_length: f64 = 0.0, 0.0, 200.0, "mm", "beyond this it is no longer the start or end of a pass";
        /// Time for which the arc burns on the spot at the end of a pass to fill the crater, s; default 0.
        crater_fill_time: f64 = 0.0, 0.0, 60.0, "s", "a longer crater fill builds a tower";
        /// Wire feed while the crater is filled, as a fraction of the nominal wire feed, 1 or less; default 1. Below 1
        /// it is set by the dialect's `wire_feed` lines (RAPID's arc instructions have it in their seamdata).
        crater_power: f64 = 1.0, 0.05, 1.0, "(fraction of the wire feed)",
            "the end of a pass has less power than the rest of it";
        /// How far the wire is drawn back after the arc is off, mm; default 0. RAPID's arc instructions do this
        /// themselves; in other dialects `arc_off` must contain `{{wire_retract}}` or `{{wire_retract_time}}`.
        wire_retract: f64 = 0.0, 0.0, 50.0, "mm of wire", "if drawn back farther, the wire leaves the contact tip";
        /// Wait between two layers, s; default 0.
        interpass_time: f64 = 0.0, 0.0, 36_000.0, "s", "ten hours cool any part";
        /// Minimum time of a layer, s: after a faster layer the torch waits for the rest of this time; default 0.
        min_layer_time: f64 = 0.0, 0.0, 36_000.0, "s", "ten hours cool any part";
        /// Height above the travels at which the torch waits between layers, mm; default 0.
        dwell_height: f64 = 0.0, 0.0, 2000.0, "mm", "the torch must stay within reach of the robot";
        /// Other starts and ends for some layers, such as hotter ones on a cold plate; default none.
        #[serde(skip_serializing_if = "Vec::is_empty")]
        layers: Vec<LayerEnds> = Vec::new();
    }
}

/// How passes of some layers begin and end; what a row leaves out is as in the section.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct LayerEnds {
    /// First layer, from 1.
    pub from: usize,
    /// Last layer.
    pub to: usize,
    /// Length of the hot start, mm.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub lead_in_length: Option<f64>,
    /// Power along the hot start, as a multiple of the nominal power.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub lead_in_power: Option<f64>,
    /// Length of the lead-out, mm.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub lead_out_length: Option<f64>,
    /// Power along the lead-out, as a fraction of the nominal power.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub lead_out_power: Option<f64>,
    /// Time for which the arc burns on the spot to fill the crater, s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub crater_fill_time: Option<f64>,
    /// Wire feed while the crater is filled, as a fraction of the nominal wire feed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub crater_power: Option<f64>,
}

impl StartStop {
    /// How passes begin and end in the layer with this index: the first row that includes the layer applies.
    ///
    /// ```
    /// use bead_plan::process::{LayerEnds, StartStop};
    ///
    /// let first = LayerEnds { from: 1, to: 1, lead_in_power: Some(1.5), ..LayerEnds::default() };
    /// let ends = StartStop { lead_in_length: 8.0, layers: vec![first], ..StartStop::default() };
    /// assert_eq!([0, 1].map(|layer| ends.at_layer(layer).lead_in_power), [1.5, 1.0]);
    /// ```
    pub fn at_layer(&self, index: usize) -> Self {
        let row = self.layers.iter().find(|row| (row.from..=row.to).contains(&(index + 1)));
        self.with(&row.cloned().unwrap_or_default())
    }

    fn with(&self, row: &LayerEnds) -> Self {
        let usual = Self { layers: Vec::new(), ..self.clone() };
        Self {
            lead_in_length: row.lead_in_length.unwrap_or(self.lead_in_length),
            lead_in_power: row.lead_in_power.unwrap_or(self.lead_in_power),
            lead_out_length: row.lead_out_length.unwrap_or(self.lead_out_length),
            lead_out_power: row.lead_out_power.unwrap_or(self.lead_out_power),
            crater_fill_time: row.crater_fill_time.unwrap_or(self.crater_fill_time),
            crater_power: row.crater_power.unwrap_or(self.crater_power),
            ..usual
        }
    }

    /// The section as it holds for most layers, and for those of each row.
    fn all(&self) -> impl Iterator<Item = Self> {
        std::iter::once(LayerEnds::default()).chain(self.layers.iter().cloned()).map(|row| self.with(&row))
    }

    /// Whether craters are filled in any layer.
    pub fn fills_craters(&self) -> bool {
        self.all().any(|ends| ends.crater_fill_time > 0.0)
    }

    /// The first invalid row of layers.
    pub fn broken(&self) -> Option<Broken> {
        self.layers.iter().find_map(|row| broken_row("start_stop", row.from, row.to, &self.with(row).limits()))
    }

    /// The `hump_height`, mm, with which the deposit model makes starts so much higher than a bead of this height, mm: the metal of the
    /// hot start is a part of it.
    ///
    /// ```
    /// use bead_plan::process::StartStop;
    ///
    /// // A tenth more metal over the hot start: of 0.5 mm, 0.2 mm of a bead of 2 mm are due to it.
    /// let ends = StartStop { lead_in_length: 8.0, lead_in_power: 1.1, ..StartStop::default() };
    /// assert!((1.1 * (2.0 + ends.hump_of(0.5, 2.0)) - 2.5).abs() < 1e-12);
    /// ```
    pub fn hump_of(&self, higher: f64, height: f64) -> f64 {
        (height + higher) / lead(self.lead_in_length, self.lead_in_power) - height
    }

    /// The `crater_depth`, mm, with which it makes ends so much lower: the lead-out has a part in it.
    pub fn crater_of(&self, lower: f64, height: f64) -> f64 {
        height - (height - lower) / lead(self.lead_out_length, self.lead_out_power)
    }

    /// Whether metal is laid differently from what a plan's passes say.
    pub fn changes_passes(&self) -> bool {
        let leads = [(self.lead_in_length, self.lead_in_power), (self.lead_out_length, self.lead_out_power)];
        self.end_overlap > 0.0
            || leads.iter().any(|(length, power)| *length > 0.0 && *power != 1.0)
            || self.hump_height * self.hump_length > 0.0
            || self.crater_depth * self.crater_length > 0.0
    }

    /// Whether the wire feed changes at the end of a pass, in any layer.
    pub fn crater_is_weaker(&self) -> bool {
        self.all().any(|ends| ends.crater_fill_time > 0.0 && ends.crater_power < 1.0)
    }

    /// Settings that do not fit the shortest pass (mm), as sentences.
    pub fn notes(&self, shortest: f64) -> Vec<String> {
        let lead = self.all().map(|ends| ends.lead_in_length + ends.lead_out_length).fold(0.0, f64::max);
        let fits = format!("fill.min_pass_length is {shortest} mm");
        let lead_note = (lead > shortest).then(|| {
            format!("Lead-in and lead-out take {lead} mm, but {fits}: on passes shorter than that, both are shortened.")
        });
        let overlap = self.end_overlap;
        let overlap_note = (overlap > shortest).then(|| {
            format!(
                "start_stop.end_overlap is {overlap} mm, but {fits}: the shortest closed passes would be laid twice."
            )
        });
        lead_note.into_iter().chain(overlap_note).collect()
    }
}

/// Power along a lead over the nominal one.
fn lead(length: f64, power: f64) -> f64 {
    if length > 0.0 { power } else { 1.0 }
}
