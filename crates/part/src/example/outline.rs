//! Points on circles and arcs, close enough that a chord stays within [`CHORD_MM`] of the curve.

use glam::DVec2;
use planar::Ring;
use std::f64::consts::TAU;

/// Largest distance between an arc and its chords, mm.
const CHORD_MM: f64 = 0.03;

/// A counter-clockwise circle, mm; the number of vertices is a multiple of four, so that they reach its full
/// extent along x and y.
pub(super) fn circle(center: DVec2, radius: f64) -> Ring {
    let count = 4 * (TAU / step(radius) / 4.0).ceil() as u32;
    let at = |k: u32| center + DVec2::from_angle(TAU * f64::from(k) / f64::from(count)) * radius;
    Ring::new((0..count).map(at).collect())
}

/// Points on an arc, mm, from the angle `from` to the angle `to` (radians), both ends included.
pub(super) fn arc(center: DVec2, radius: f64, from: f64, to: f64) -> Vec<DVec2> {
    let count = ((to - from).abs() / step(radius)).ceil().max(1.0) as u32;
    let angle = |k: u32| from + (to - from) * f64::from(k) / f64::from(count);
    (0..=count).map(|k| center + DVec2::from_angle(angle(k)) * radius).collect()
}

/// The angle of a chord that departs from its arc by [`CHORD_MM`], radians.
fn step(radius: f64) -> f64 {
    2.0 * (1.0 - CHORD_MM / radius.max(CHORD_MM)).acos()
}
