//! A shaft with two flanges: bar stock, on which the flanges are welded in layers around its axis.

use crate::model::solid::Solid;
use glam::DVec2;

const RADIUS: f64 = 25.0;
const LENGTH: f64 = 160.0;
/// Radius of each flange, and where it begins and ends.
const FLANGES: [(f64, [f64; 2]); 2] = [(61.0, [30.0, 60.0]), (45.0, [105.0, 127.0])];
/// Chords stay within 0.01 mm of the circle.
const SEGMENTS: u32 = 180;

pub(super) fn build() -> Solid {
    let flange = |(radius, [from, to]): (f64, [f64; 2])| [[RADIUS, from], [radius, from], [radius, to], [RADIUS, to]];
    let ends = [[0.0, 0.0], [RADIUS, 0.0]].into_iter();
    let profile = ends.chain(FLANGES.into_iter().flat_map(flange)).chain([[RADIUS, LENGTH], [0.0, LENGTH]]);
    Solid::revolve(&profile.map(DVec2::from_array).collect::<Vec<_>>(), SEGMENTS)
}
