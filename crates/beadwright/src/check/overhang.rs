//! Layers that hang over.

use super::{Check, Finding, Subject};
use crate::layer::Layer;
use planar::{Join, Region};

pub(super) const CHECK: Check = Check {
    name: "overhang",
    what: "parts of a layer that reach more than check.max_overhang beyond the layer below",
    why: "there is nothing to weld on: the bead drops off",
    example: "layer 20: 34.0 mm² hang more than half a bead over the layer below.",
    remedy: "turn the part, or add stock below that is machined away",
    find,
};

/// Smaller areas do not count, in squared bead widths.
const SMALLEST: f64 = 0.5;

fn find(subject: &Subject<'_>) -> Vec<Finding> {
    let width = subject.profile.bead.width;
    let reach = subject.profile.check.max_overhang * width;
    let hanging = |pair: &[&Layer]| {
        let [below, above] = [0, 1].map(|i| Region::from_normalised(pair[i].islands.clone()));
        let free = above.difference(&below.offset(reach, Join::ROUND));
        let large = free.polygons().iter().filter(|p| p.area() > SMALLEST * width * width);
        let area: f64 = large.clone().map(planar::Polygon::area).sum();
        let place = large.clone().next()?.outer.points().first()?.extend(pair[1].z);
        let text = format!("{area:.1} mm² reach more than {reach:.1} mm beyond the layer below.");
        Some(Finding { place: Some(place), ..Finding::of_layer(&CHECK, pair[1], text) })
    };
    subject.layers.windows(2).filter_map(hanging).collect()
}
