//! Places that grow out of the part.

use super::{Check, Finding, Subject};
use crate::pass::PassKind;

pub(super) const CHECK: Check = Check {
    name: "towers",
    what: "places where the stacked layers stand higher than travel.clearance above the mean height of the part",
    why: "the torch runs into them on its way",
    example: "layer 40: the highest point stands 11.2 mm above the mean height; travels pass 10 mm above the layer.",
    remedy: "alternate directions and start points from layer to layer, or raise travel.clearance",
    find,
};

fn find(subject: &Subject<'_>) -> Vec<Finding> {
    let clearance = subject.profile.travel.clearance;
    if clearance <= 0.0 || is_all_wall(subject) {
        return Vec::new();
    }
    let mut mean = 0.0;
    for (i, (growth, layer)) in subject.growth.iter().zip(&subject.layers).enumerate() {
        mean += subject.figures[i].mean();
        let above = subject.rise * (i + 1) as f64 + growth.peak - mean;
        if above > clearance {
            let text = format!(
                "the highest point stands {above:.1} mm above the mean height; travels pass {clearance} mm above the layer."
            );
            let place = Some(growth.peak_place.extend(layer.z));
            return vec![Finding { place, ..Finding::of_layer(&CHECK, layer, text) }];
        }
    }
    Vec::new()
}

/// Whether there is nothing but walls whose layers lie as high as their beads grow: of a wall, a bead's crest adds no more than
/// its mean height, since it is laid on the crest below and spreads over it.
fn is_all_wall(subject: &Subject<'_>) -> bool {
    let walls = subject.layers.iter().flat_map(|layer| &layer.passes).all(|pass| pass.kind == PassKind::Wall);
    walls && subject.profile.wall_bead().is_ok_and(|wall| wall.is_some())
}
