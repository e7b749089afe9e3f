//! A gear with trapezoidal teeth and a bore. The tips are flat and wide enough for a bead along each flank.

use super::outline;
use crate::model::solid::Solid;
use glam::DVec2;
use planar::{Polygon, Ring};
use std::f64::consts::TAU;

const TEETH: u32 = 12;
/// Across the flat tips.
const OUTER_DIAMETER: f64 = 140.0;
const ROOT_DIAMETER: f64 = 108.0;
const BORE_DIAMETER: f64 = 40.0;
/// Width of a tooth at its tip.
const TIP_WIDTH: f64 = 12.0;
/// Width of a tooth on the root circle.
const ROOT_WIDTH: f64 = 18.0;
const HEIGHT: f64 = 20.0;

pub(super) fn build() -> Solid {
    let tooth = tooth();
    let turned = |k: u32| {
        let turn = DVec2::from_angle(TAU * f64::from(k) / f64::from(TEETH));
        tooth.iter().map(move |&p| turn.rotate(p))
    };
    let bore = outline::circle(DVec2::ZERO, BORE_DIAMETER / 2.0).reversed();
    let outer = Ring::new((0..TEETH).flat_map(turned).collect());
    Solid::extrude(&Polygon { outer, holes: vec![bore] }, 0.0, HEIGHT)
}

/// The tooth along +x and the root arc after it, up to the next tooth.
fn tooth() -> Vec<DVec2> {
    let (tip, root) = (OUTER_DIAMETER / 2.0, ROOT_DIAMETER / 2.0);
    let half_angle = (ROOT_WIDTH / 2.0 / root).asin();
    let mut points = vec![
        DVec2::from_angle(-half_angle) * root,
        DVec2::new(tip, -TIP_WIDTH / 2.0),
        DVec2::new(tip, TIP_WIDTH / 2.0),
    ];
    points.extend(outline::arc(DVec2::ZERO, root, half_angle, TAU / f64::from(TEETH) - half_angle));
    points.pop();
    points
}
