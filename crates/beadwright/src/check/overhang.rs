//! Layers that overhang.

use super::{Check, Finding, Subject};
use crate::layer::{Layer, overhang};
use crate::plan::charted::Across;

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
        let across = Across::layers(subject.profile, pair[0], pair[1]);
        let below = across.map(|across| across.islands(&pair[0].islands));
        let below = below.as_deref().unwrap_or(&pair[0].islands);
        let (area, place) = overhang(below, &pair[1].islands, reach, width)?;
        let text = format!("{area:.1} mm² overhang the layer below by more than {reach:.1} mm.");
        Some(CHECK.of_layer(pair[1], Some(place.extend(pair[1].z)), text))
    };
    subject.layers.windows(2).filter_map(hanging).collect()
}
