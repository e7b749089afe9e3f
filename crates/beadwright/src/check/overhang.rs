//! Layers that overhang.

use super::{Check, Finding, Subject};
use crate::layer::{Layer, overhang};
use crate::plan::charted::Across;
use planar::Polygon;

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
    let islands = |below: &Layer, layer: &Layer| match Across::layers(subject.profile, below, layer) {
        Some(across) => across.islands(&below.islands),
        None => below.islands.clone(),
    };
    let hanging = |layer: &&Layer| {
        let below: Vec<Polygon> = subject.below(layer).iter().flat_map(|below| islands(below, layer)).collect();
        let (area, place) = overhang(&below, &layer.islands, reach, width)?;
        let text = format!("{area:.1} mm² overhang the layer below by more than {reach:.1} mm.");
        Some(CHECK.of_layer(layer, Some(place.extend(layer.z)), text))
    };
    subject.layers.iter().skip(1).filter_map(hanging).collect()
}
