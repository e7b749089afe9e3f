//! Points that no controller can handle.

use super::{Check, Finding, Subject};
use crate::layer::Layer;
use crate::pass::Pass;
use crate::program::MIN_MOVE_MM;

pub(super) const CHECK: Check = Check {
    name: "points",
    what: "coordinates that are not numbers, passes of a single spot, and points off the height of their layer",
    why: "a controller stops at such a point with the arc on, or burns through",
    example: "layer 3, pass 2: the coordinate of point 17 is not a number.",
    remedy: "plan the part again; if the plan was edited, correct the point",
    find,
};

/// A pass may leave the height of its layer by this share of the layer's thickness.
const OFF_HEIGHT: f64 = 0.5;

fn find(subject: &Subject<'_>) -> Vec<Finding> {
    let wrong = |(layer, i, pass): (&Layer, usize, &Pass)| {
        let text = fault(layer, pass)?;
        Some(CHECK.of_pass(layer, i, pass.start().filter(|p| p.is_finite()), text))
    };
    subject.passes().filter_map(wrong).collect()
}

fn fault(layer: &Layer, pass: &Pass) -> Option<String> {
    if let Some(i) = pass.points.iter().position(|p| !p.is_finite()) {
        return Some(format!("the coordinate of point {} is not a number.", i + 1));
    }
    let spot = pass.points.iter().all(|p| p.distance(pass.points[0]) < MIN_MOVE_MM);
    if pass.points.len() < 2 || spot {
        return Some("all points lie on one spot, where the arc would burn through.".to_owned());
    }
    // The turn of a helix rises from the layer below.
    let lowest = layer.z - if layer.lit.is_turn() { 1.0 + OFF_HEIGHT } else { OFF_HEIGHT } * layer.height;
    let off = pass.points.iter().find(|p| p.z < lowest || p.z > layer.z + OFF_HEIGHT * layer.height);
    off.map(|p| format!("a point lies at z {:.2} mm, but the layer is at {:.2} mm.", p.z, layer.z))
}
