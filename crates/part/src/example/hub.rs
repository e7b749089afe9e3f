//! A hub with four twisted blades: the hub is turned, the blades are welded onto it in layers around its axis.

use crate::model::solid::Solid;
use glam::{DQuat, DVec2, DVec3};
use planar::{Polygon, Ring};
use std::f64::consts::{FRAC_PI_2, TAU};

const RADIUS: f64 = 40.0;
const BORE: f64 = 18.0;
const LENGTH: f64 = 70.0;
const BLADES: u32 = 4;
/// Where blades begin, inside the hub, and end: distances from the axis, mm.
const ROOT: f64 = 34.0;
const TIP: f64 = 120.0;
/// Half the length of a blade's section at its root and at its tip, and half its thickness.
const HALF_CHORD: [f64; 2] = [30.0, 22.0];
const HALF_THICKNESS: [f64; 2] = [8.0, 6.0];
/// Angle between a section and the axis at the root and at the tip, °.
const PITCH: [f64; 2] = [20.0, 55.0];
/// Steps of the twist.
const STEPS: u32 = 24;
const SEGMENTS: u32 = 180;

pub(super) fn build() -> Solid {
    let profile = [[BORE, 0.0], [RADIUS, 0.0], [RADIUS, LENGTH], [BORE, LENGTH]].map(DVec2::from_array);
    let mut solid = Solid::revolve(&profile, SEGMENTS);
    for k in 0..BLADES {
        let blade = blade();
        let turn = DQuat::from_rotation_z(TAU * f64::from(k) / f64::from(BLADES)) * DQuat::from_rotation_y(FRAC_PI_2);
        let first = solid.vertices.len() as u32;
        solid.vertices.extend(blade.vertices.iter().map(|p| turn * *p + DVec3::Z * (LENGTH / 2.0)));
        solid.triangles.extend(blade.triangles.iter().map(|t| t.map(|corner| corner + first)));
    }
    solid
}

/// A blade along z, with the hub's axis along -x. Its section is a stadium of varying size.
fn blade() -> Solid {
    let half = |k: i32| f64::from(k) / 24.0 * TAU;
    let round = (0..24).map(|k| DVec2::from_angle(half(k)));
    let section = Polygon::simple(Ring::new(round.collect()));
    let levels: Vec<f64> = (0..=STEPS).map(|k| ROOT + (TIP - ROOT) * f64::from(k) / f64::from(STEPS)).collect();
    Solid::loft(&section, &levels, |p, z| {
        let share = (z - ROOT) / (TIP - ROOT);
        let between = |ends: [f64; 2]| ends[0] + (ends[1] - ends[0]) * share;
        let [chord, thickness] = [HALF_CHORD, HALF_THICKNESS].map(between);
        // Round ends on a straight middle section.
        let straight = p.x.signum() * (chord - thickness) * if p.x.abs() < 1e-9 { 0.0 } else { 1.0 };
        DVec2::from_angle(between(PITCH).to_radians()).rotate(p * thickness + DVec2::new(straight, 0.0))
    })
}
