//! A four-bladed ship propeller: paddles, narrow at the root and round at the tip, on a bored hub. The outline turns
//! with height like a screw, half the turn below mid height and half above; the tips reach farthest at mid height.

use super::outline;
use crate::model::solid::Solid;
use glam::DVec2;
use planar::{Polygon, Ring, polyline};
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

const TIP_RADIUS: f64 = 130.0;
const HUB_RADIUS: f64 = 40.0;
const BORE_RADIUS: f64 = 18.0;
const HEIGHT: f64 = 20.0;
/// Half width of a blade at its root.
const ROOT_HALF_WIDTH: f64 = 17.5;
/// Half width of a blade where it is widest.
const WIDEST_HALF_WIDTH: f64 = 30.0;
/// Where a blade is widest, from the axis.
const WIDEST_RADIUS: f64 = TIP_RADIUS * 2.0 / 3.0;
/// Radius of the fillet between blade and hub.
const FILLET_RADIUS: f64 = 12.0;
/// Twist of the outline from bottom to top, radians.
const TWIST: f64 = 6.0 * PI / 180.0;
/// Steps of the twist; an even number, so that one level lies at mid height.
const STEPS: u32 = 8;
/// Largest distance between the outline of a blade and its chords.
const CHORD_MM: f64 = 0.04;
/// Points per curve before those that [`CHORD_MM`] allows are dropped.
const SAMPLES: u32 = 400;

pub(super) fn build() -> Solid {
    let levels: Vec<f64> = (0..=STEPS).map(|k| HEIGHT * f64::from(k) / f64::from(STEPS)).collect();
    Solid::loft(&planform(), &levels, |p, z| DVec2::from_angle(TWIST * (z / HEIGHT - 0.5)).rotate(p))
}

/// The outline at mid height: one blade along each axis.
fn planform() -> Polygon {
    let blade = blade();
    let turns = [DVec2::X, DVec2::Y, DVec2::NEG_X, DVec2::NEG_Y];
    let outer = turns.iter().flat_map(|turn| blade.iter().map(|&p| turn.rotate(p)));
    let bore = outline::circle(DVec2::ZERO, BORE_RADIUS).reversed();
    Polygon { outer: Ring::new(outer.collect()), holes: vec![bore] }
}

/// The blade along +x, from halfway to the previous blade to just short of halfway to the next.
fn blade() -> Vec<DVec2> {
    let flank = polyline::simplify(&flank(), CHORD_MM);
    let without_last = flank.len() - 1;
    let mirrored = flank.iter().rev().map(|p| DVec2::new(p.x, -p.y));
    mirrored.take(without_last).chain(flank.iter().copied().take(without_last)).collect()
}

/// Half a blade, from the tip over flank and fillet to the hub halfway to the next blade.
fn flank() -> Vec<DVec2> {
    let center_y = ROOT_HALF_WIDTH + FILLET_RADIUS;
    let center = DVec2::new(((HUB_RADIUS + FILLET_RADIUS).powi(2) - center_y * center_y).sqrt(), center_y);
    let mut points: Vec<DVec2> = curve(tip).collect();
    points.extend(curve(|t| side(t, center.x)));
    points.extend(curve(|t| {
        center + DVec2::from_angle(-FRAC_PI_2 - t * (FRAC_PI_2 - center.to_angle())) * FILLET_RADIUS
    }));
    points.extend(curve(|t| DVec2::from_angle(center.to_angle() + t * (FRAC_PI_4 - center.to_angle())) * HUB_RADIUS));
    points.dedup_by(|a, b| a.distance(*b) < 1e-9);
    points
}

/// Points of a curve with a parameter from 0 to 1.
fn curve(at: impl Fn(f64) -> DVec2) -> impl Iterator<Item = DVec2> {
    (0..=SAMPLES).map(move |k| at(f64::from(k) / f64::from(SAMPLES)))
}

/// A quarter of an ellipse, from the tip to where the blade is widest.
fn tip(t: f64) -> DVec2 {
    let (sin, cos) = (t * FRAC_PI_2).sin_cos();
    DVec2::new(WIDEST_RADIUS + (TIP_RADIUS - WIDEST_RADIUS) * cos, WIDEST_HALF_WIDTH * sin)
}

/// From where the blade is widest to its root at `root_x`, with no kink at either end.
fn side(t: f64, root_x: f64) -> DVec2 {
    let x = WIDEST_RADIUS + t * (root_x - WIDEST_RADIUS);
    let share = (1.0 + (t * PI).cos()) / 2.0;
    DVec2::new(x, ROOT_HALF_WIDTH + (WIDEST_HALF_WIDTH - ROOT_HALF_WIDTH) * share)
}
