//! A quarter bend of thick pipe, to be welded in layers square to its middle line.

use super::outline::circle;
use crate::chart::Chart;
use crate::model::solid::Solid;
use glam::DVec2;
use planar::Polygon;

/// The middle line: up, a quarter turn, and away.
pub(super) const CHART: &str = "guide:points=0/0/0:0/0/145:145/0/145,radius=120";
const OUTER: f64 = 45.0;
const INNER: f64 = 25.0;
/// Each straight end.
const STRAIGHT: f64 = 25.0;
const BEND: f64 = 120.0 * std::f64::consts::FRAC_PI_2;
/// Chords stay within 0.01 mm of the arcs.
const STEPS: u32 = 120;

pub(super) fn build() -> Solid {
    let ring = |radius| circle(DVec2::ZERO, radius);
    let pipe = Polygon { outer: ring(OUTER), holes: vec![ring(INNER).reversed()] };
    let bent = (0..=STEPS).map(|k| STRAIGHT + BEND * f64::from(k) / f64::from(STEPS));
    let levels: Vec<f64> = std::iter::once(0.0).chain(bent).chain([STRAIGHT + BEND + STRAIGHT]).collect();
    let mut solid = Solid::loft(&pipe, &levels, |p, _| p);
    if let Ok(chart) = CHART.parse::<Chart>() {
        solid.vertices.iter_mut().for_each(|p| *p = chart.sheet(p.z).at(*p).place);
    }
    solid
}
