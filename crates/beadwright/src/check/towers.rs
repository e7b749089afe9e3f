//! Places that grow out of the part.

use super::{Check, Finding, Subject};

pub(super) const CHECK: Check = Check {
    name: "towers",
    what: "places where the metal, bead laid on bead, rises higher above the layer than the travels (travel.clearance)",
    why: "the torch runs into them on its way",
    example: "layer 40, x 12.0 y 3.5 z 80.00 mm: the highest point is 11.2 mm above the layer; travels pass 10 mm above it.",
    remedy: "alternate directions and start points from layer to layer, or raise travel.clearance",
    find,
};

fn find(subject: &Subject<'_>) -> Vec<Finding> {
    let clearance = subject.settings.weld.travel.clearance;
    let mut layers = subject.growth.iter().zip(&subject.layers);
    let Some((growth, layer)) = layers.find(|(growth, _)| clearance > 0.0 && growth.peak > clearance) else {
        return Vec::new();
    };
    let text =
        format!("the highest point is {:.1} mm above the layer; travels pass {clearance} mm above it.", growth.peak);
    vec![CHECK.of_layer(layer, Some(growth.peak_place.extend(layer.z)), text).sized(growth.peak)]
}
