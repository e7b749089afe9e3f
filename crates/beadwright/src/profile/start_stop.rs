//! The section `[start_stop]`: how passes begin and end, and how long layers wait for each other.

use super::limits::Range;
use serde::{Deserialize, Serialize};

/// How passes begin and end, and how long layers wait; every key has a default, and all of them together change nothing.
///
/// Power is told as a part of the nominal energy per length of bead. Current follows the wire in the arcs that are used
/// here (synergic lines, CMT), so heat cannot be had without metal: both per length grow with the power alike. With
/// `process.follow = "speed"` the torch goes at speed / power, with `"wire-feed"` the wire comes at feed · power.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct StartStop {
    /// How far closed passes go on along their path beyond their start, mm, so that the seam is fused; at most once
    /// around; default 0.
    pub end_overlap: f64,
    /// Length of the hot start of a pass, mm, where the part is still cold; default 0. With the lead-out it shares passes
    /// that are too short for both.
    pub lead_in_length: f64,
    /// Power along it, of the nominal one, 1 or more; default 1.
    pub lead_in_power: f64,
    /// Length of the end of a pass with less power, mm, so that heat and metal do not pile up; default 0.
    pub lead_out_length: f64,
    /// Power along it, of the nominal one, 1 or less; default 1.
    pub lead_out_power: f64,
    /// How much higher than the bead a pass is where it starts, mm: the cold bead stands up before it flows; default 0. Used
    /// by the deposit model only, as the next three are; 0 where it was never measured.
    pub hump_height: f64,
    /// Length over which that hump falls to nothing, mm; default 0.
    pub hump_length: f64,
    /// How much lower than the bead a pass is where it ends, mm; default 0.
    pub crater_depth: f64,
    /// Length over which the bead falls to that, mm; default 0.
    pub crater_length: f64,
    /// Time for which the arc stands at the end of a pass to fill the crater, s; default 0.
    pub crater_fill_time: f64,
    /// Wire feed meanwhile, of the nominal one, 1 or less; default 1. Below 1 it is written by the dialect's
    /// `wire_feed` lines (RAPID's arc instructions have it in their seamdata).
    pub crater_power: f64,
    /// How far the wire is drawn back after the arc is off, mm; default 0. RAPID's arc instructions do it by themselves,
    /// in other dialects `arc_off` must hold `{{wire_retract}}` or `{{wire_retract_time}}`.
    pub wire_retract: f64,
    /// Wait between two layers, s; default 0.
    pub interpass_time: f64,
    /// Least time of a layer, s: what it takes less is waited for before the next layer; default 0.
    pub min_layer_time: f64,
    /// How far above the travels the torch waits, mm; default 0.
    pub dwell_height: f64,
}

impl Default for StartStop {
    fn default() -> Self {
        Self {
            end_overlap: 0.0,
            lead_in_length: 0.0,
            lead_in_power: 1.0,
            lead_out_length: 0.0,
            lead_out_power: 1.0,
            hump_height: 0.0,
            hump_length: 0.0,
            crater_depth: 0.0,
            crater_length: 0.0,
            crater_fill_time: 0.0,
            crater_power: 1.0,
            wire_retract: 0.0,
            interpass_time: 0.0,
            min_layer_time: 0.0,
            dwell_height: 0.0,
        }
    }
}

impl StartStop {
    /// Ranges of the numbers.
    pub(super) fn ranges(&self) -> [Range; 15] {
        [
            ("start_stop.end_overlap", self.end_overlap, 0.0, 200.0, "mm"),
            ("start_stop.lead_in_length", self.lead_in_length, 0.0, 200.0, "mm"),
            ("start_stop.lead_in_power", self.lead_in_power, 1.0, 4.0, "of the nominal power"),
            ("start_stop.lead_out_length", self.lead_out_length, 0.0, 200.0, "mm"),
            ("start_stop.lead_out_power", self.lead_out_power, 0.1, 1.0, "of the nominal power"),
            ("start_stop.hump_height", self.hump_height, 0.0, 50.0, "mm"),
            ("start_stop.hump_length", self.hump_length, 0.0, 200.0, "mm"),
            ("start_stop.crater_depth", self.crater_depth, 0.0, 50.0, "mm"),
            ("start_stop.crater_length", self.crater_length, 0.0, 200.0, "mm"),
            ("start_stop.crater_fill_time", self.crater_fill_time, 0.0, 60.0, "s"),
            ("start_stop.crater_power", self.crater_power, 0.05, 1.0, "of the wire feed"),
            ("start_stop.wire_retract", self.wire_retract, 0.0, 50.0, "mm of wire"),
            ("start_stop.interpass_time", self.interpass_time, 0.0, 36_000.0, "s"),
            ("start_stop.min_layer_time", self.min_layer_time, 0.0, 36_000.0, "s"),
            ("start_stop.dwell_height", self.dwell_height, 0.0, 2000.0, "mm"),
        ]
    }

    /// Whether metal is laid otherwise than a plan's passes tell.
    pub fn changes_passes(&self) -> bool {
        let leads = [(self.lead_in_length, self.lead_in_power), (self.lead_out_length, self.lead_out_power)];
        self.end_overlap > 0.0
            || leads.iter().any(|(length, power)| *length > 0.0 && *power != 1.0)
            || self.hump_height * self.hump_length > 0.0
            || self.crater_depth * self.crater_length > 0.0
    }

    /// Whether the wire feed changes at the end of a pass.
    pub(crate) fn crater_is_weaker(&self) -> bool {
        self.crater_fill_time > 0.0 && self.crater_power < 1.0
    }

    /// What does not fit the shortest pass, mm, as sentences.
    pub(super) fn notes(&self, shortest: f64) -> Vec<String> {
        let lead = self.lead_in_length + self.lead_out_length;
        let fits = format!("fill.min_pass_length is {shortest} mm");
        let lead_note = (lead > shortest).then(|| {
            format!("Lead-in and lead-out take {lead} mm, but {fits}: on passes shorter than that both are cut down.")
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
