//! Layers that overhang.

use super::{Check, Finding, Subject};
use crate::layer::{Layer, overhang};

pub(super) const CHECK: Check = Check {
    name: "overhang",
    what: "parts of a layer that reach more than check.max_overhang beyond the layer below",
    why: "there is nothing to weld on: the bead drops off",
    example: "layer 20: 34.0 mm² overhang the layer below by more than half a bead.",
    remedy: "reorient the part, or add stock below it to be machined away",
    find,
};

fn find(subject: &Subject<'_>) -> Vec<Finding> {
    let width = subject.profile.bead.width;
    let reach = subject.profile.check.max_overhang * width;
    let hanging = |pair: &[&Layer]| {
        let (area, place) = overhang(&pair[0].islands, &pair[1].islands, reach, width)?;
        let text = format!("{area:.1} mm² overhang the layer below by more than {reach:.1} mm.");
        Some(CHECK.of_layer(pair[1], Some(place.extend(pair[1].z)), text))
    };
    subject.layers.windows(2).filter_map(hanging).collect()
}
