//! Places that grow out of the part.

use super::{Check, Finding, Subject};

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
    if clearance <= 0.0 {
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
