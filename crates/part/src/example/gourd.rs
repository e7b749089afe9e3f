//! A bottle gourd: two bellies, a waist and a neck, open at both ends. The wall is measured across, as a bead makes it:
//! where it leans, a layer shows it thicker.

use crate::curve::Nurbs;
use crate::model::solid::Solid;
use glam::{DVec2, DVec3};
use std::f64::consts::{FRAC_PI_2, PI};

const HEIGHT: f64 = 200.0;
const WALL: f64 = 4.0;
/// Heights and outer radii between which the outside swings: foot, belly, waist, upper belly, mouth.
const SWINGS: [(f64, f64); 5] = [(0.0, 42.0), (60.0, 60.0), (120.0, 26.0), (155.0, 38.0), (HEIGHT, 15.0)];
/// Height between two points of the outside; its chords stay within 0.013 mm.
const STEP: f64 = 1.25;
/// Chords around stay within 0.018 mm.
const SEGMENTS: u32 = 128;

pub(super) fn build() -> Solid {
    let count = (HEIGHT / STEP) as u32;
    let at = |k: u32, walls: f64| {
        let z = f64::from(k) * STEP;
        DVec2::new(outside(z) - walls * level_wall(z), z)
    };
    let profile: Vec<DVec2> = (0..=count).map(|k| at(k, 0.0)).chain((0..=count).rev().map(|k| at(k, 1.0))).collect();
    Solid::revolve(&profile, SEGMENTS)
}

/// Circles in the middle of the wall, one every 4 mm.
pub(super) fn curves() -> Vec<Nurbs> {
    let heights = (0..=50).map(|k| HEIGHT * f64::from(k) / 50.0);
    let circle = |z: f64| {
        let radius = outside(z) - level_wall(z) / 2.0;
        Nurbs::circle(DVec3::new(0.0, 0.0, z), DVec3::X * radius, DVec3::Y * radius).ok()
    };
    heights.filter_map(circle).collect()
}

/// Thickness of the wall in a level cut at height `z`, mm.
fn level_wall(z: f64) -> f64 {
    WALL * slope(z).hypot(1.0)
}

/// Outer radius at height `z`, mm: half a cosine from swing to swing.
fn outside(z: f64) -> f64 {
    let ((low, from), (high, to)) = swing(z);
    from + (to - from) * (1.0 - (PI * (z - low) / (high - low)).cos()) / 2.0
}

/// How much the outer radius grows per height at height `z`.
fn slope(z: f64) -> f64 {
    let ((low, from), (high, to)) = swing(z);
    (to - from) / (high - low) * FRAC_PI_2 * (PI * (z - low) / (high - low)).sin()
}

fn swing(z: f64) -> ((f64, f64), (f64, f64)) {
    let upper = SWINGS.partition_point(|swing| swing.0 < z).clamp(1, SWINGS.len() - 1);
    (SWINGS[upper - 1], SWINGS[upper])
}
