//! A vase with a curved wall: belly below, neck above. The wall is measured horizontally, as every layer shows it.

use crate::model::solid::Solid;
use glam::DVec2;
use std::f64::consts::TAU;

const HEIGHT: f64 = 120.0;
const WALL: f64 = 14.0;
const BOTTOM: f64 = 12.0;
/// Outer radius at the foot and at the rim.
const RADIUS: f64 = 44.0;
/// How far the belly comes out and the neck goes in.
const SWING: f64 = 8.0;
/// Height between two points of the profile; the chords stay within 0.03 mm of the curve.
const STEP: f64 = 3.0;
const SEGMENTS: u32 = 72;

pub(super) fn build() -> Solid {
    let (bottom, top) = ((BOTTOM / STEP) as u32, (HEIGHT / STEP) as u32);
    let outside = (0..=top).map(|k| outside(f64::from(k) * STEP));
    let inside = (bottom..=top).rev().map(|k| self::outside(f64::from(k) * STEP) - DVec2::new(WALL, 0.0));
    let mut profile = vec![DVec2::ZERO];
    profile.extend(outside.chain(inside));
    profile.push(DVec2::new(0.0, BOTTOM));
    Solid::revolve(&profile, SEGMENTS)
}

/// The outer surface at height `z`, mm, as (radius, height).
fn outside(z: f64) -> DVec2 {
    DVec2::new(RADIUS + SWING * (TAU * z / HEIGHT).sin(), z)
}
