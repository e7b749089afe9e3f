//! The section `[start_stop]`: how passes begin and end, and how long layers wait for each other.

use crate::limit::section;

section! {
    /// How passes begin and end, and how long layers wait; every key has a default, and all of them together change nothing.
    ///
    /// Power is told as a part of the nominal energy per length of bead. Current follows the wire in the arcs that are used
    /// here (synergic lines, CMT), so heat cannot be had without metal: both per length grow with the power alike. With
    /// `process.follow = "speed"` the torch goes at speed / power, with `"wire-feed"` the wire comes at feed · power.
    StartStop "start_stop" {
        /// How far closed passes go on along their path beyond their start, mm, so that the seam is fused; at most once
        /// around; default 0.
        end_overlap: f64 = 0.0, 0.0, 200.0, "mm", "a longer overlap is a second bead";
        /// Length of the hot start of a pass, mm, where the part is still cold; default 0. With the lead-out it shares passes
        /// that are too short for both.
        lead_in_length: f64 = 0.0, 0.0, 200.0, "mm", "more than this is a pass of its own";
        /// Power along it, of the nominal one, 1 or more; default 1.
        lead_in_power: f64 = 1.0, 1.0, 4.0, "of the nominal power",
            "a hot start has more power than the pass, up to what burns through";
        /// Length of the end of a pass with less power, mm, so that heat and metal do not pile up; default 0.
        lead_out_length: f64 = 0.0, 0.0, 200.0, "mm", "more than this is a pass of its own";
        /// Power along it, of the nominal one, 1 or less; default 1.
        lead_out_power: f64 = 1.0, 0.1, 1.0, "of the nominal power", "the end of a pass has less power than the pass";
        /// How much higher than the bead a pass is where it starts, mm: the cold bead stands up before it flows; default 0. Used
        /// by the deposit model only, as the next three are; 0 where it was never measured.
        hump_height: f64 = 0.0, 0.0, 50.0, "mm", "beyond this it is no longer the start or end of a pass";
        /// Length over which that hump falls to nothing, mm; default 0.
        hump_length: f64 = 0.0, 0.0, 200.0, "mm", "beyond this it is no longer the start or end of a pass";
        /// How much lower than the bead a pass is where it ends, mm; default 0.
        crater_depth: f64 = 0.0, 0.0, 50.0, "mm", "beyond this it is no longer the start or end of a pass";
        /// Length over which the bead falls to that, mm; default 0.
        crater_length: f64 = 0.0, 0.0, 200.0, "mm", "beyond this it is no longer the start or end of a pass";
        /// Time for which the arc stands at the end of a pass to fill the crater, s; default 0.
        crater_fill_time: f64 = 0.0, 0.0, 60.0, "s", "a longer crater fill is a tower";
        /// Wire feed meanwhile, of the nominal one, 1 or less; default 1. Below 1 it is written by the dialect's
        /// `wire_feed` lines (RAPID's arc instructions have it in their seamdata).
        crater_power: f64 = 1.0, 0.05, 1.0, "of the wire feed", "the end of a pass has less power than the pass";
        /// How far the wire is drawn back after the arc is off, mm; default 0. RAPID's arc instructions do it by themselves,
        /// in other dialects `arc_off` must hold `{{wire_retract}}` or `{{wire_retract_time}}`.
        wire_retract: f64 = 0.0, 0.0, 50.0, "mm of wire", "farther back the wire leaves the contact tip";
        /// Wait between two layers, s; default 0.
        interpass_time: f64 = 0.0, 0.0, 36_000.0, "s", "ten hours cool any part";
        /// Least time of a layer, s: what it takes less is waited for before the next layer; default 0.
        min_layer_time: f64 = 0.0, 0.0, 36_000.0, "s", "ten hours cool any part";
        /// How far above the travels the torch waits, mm; default 0.
        dwell_height: f64 = 0.0, 0.0, 2000.0, "mm", "the torch must stay within reach of the robot";
    }
}

impl StartStop {
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
    pub(crate) fn notes(&self, shortest: f64) -> Vec<String> {
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
