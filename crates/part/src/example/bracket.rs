//! A bracket: an upright plate, an arm at its upper end and a gusset below the arm. As it stands, arm and gusset hang
//! in the air, so it is welded as a preform.

use super::outline;
use crate::model::solid::Solid;
use glam::{DVec2, DVec3};
use planar::triangulate::triangulate_by_edges;
use planar::{Polygon, Ring};

const LENGTH: f64 = 100.0;
const WIDTH: f64 = 60.0;
const HEIGHT: f64 = 90.0;
/// Thickness of plate and arm.
const THICK: f64 = 14.0;
/// How far the gusset reaches along plate and arm, and how thick it is.
const GUSSET: f64 = 50.0;
const RIB: f64 = 12.0;
/// Height of two holes in the plate and reach of two in the arm; their distance from the middle, and their radius.
const LOW: f64 = 30.0;
const FAR: f64 = 80.0;
const ASIDE: f64 = 18.0;
const RADIUS: f64 = 7.0;

type Place<'a> = &'a dyn Fn(DVec2) -> DVec3;

pub(super) fn build() -> Solid {
    let (side, rib, below, foot) = (WIDTH / 2.0, RIB / 2.0, HEIGHT - THICK, HEIGHT - THICK - GUSSET);
    let middle = LENGTH / 2.0;
    let x = |x: f64| move |p: DVec2| DVec3::new(x - middle, p.x, p.y);
    let y = |y: f64| move |p: DVec2| DVec3::new(p.x - middle, y, p.y);
    let z = |z: f64| move |p: DVec2| DVec3::new(p.x - middle, p.y, z);
    let plate_holes = [-ASIDE, ASIDE].map(|aside| hole(aside, LOW));
    let arm_holes = [-ASIDE, ASIDE].map(|aside| hole(FAR, aside));
    let mut solid = Solid::default();

    // Where the gusset stands, the faces below it are left open.
    let upright = [
        (-side, 0.0),
        (side, 0.0),
        (side, below),
        (rib, below),
        (rib, foot),
        (-rib, foot),
        (-rib, below),
        (-side, below),
    ];
    let tip = THICK + GUSSET;
    let under = [
        (THICK, -side),
        (LENGTH, -side),
        (LENGTH, side),
        (THICK, side),
        (THICK, rib),
        (tip, rib),
        (tip, -rib),
        (THICK, -rib),
    ];
    face(&mut solid, drawn(&upright, &plate_holes), true, &x(THICK));
    face(&mut solid, rectangle((-side, 0.0), (side, HEIGHT), &plate_holes), false, &x(0.0));
    face(&mut solid, rectangle((-side, below), (side, HEIGHT), &[]), true, &x(LENGTH));
    face(&mut solid, drawn(&under, &arm_holes), false, &z(below));
    face(&mut solid, rectangle((0.0, -side), (LENGTH, side), &arm_holes), true, &z(HEIGHT));
    face(&mut solid, rectangle((0.0, -side), (THICK, side), &[]), false, &z(0.0));
    plate_holes.iter().for_each(|hole| bore(&mut solid, hole, &x(0.0), &x(THICK)));
    arm_holes.iter().for_each(|hole| bore(&mut solid, hole, &z(below), &z(HEIGHT)));

    let ell = [(0.0, 0.0), (THICK, 0.0), (THICK, below), (LENGTH, below), (LENGTH, HEIGHT), (0.0, HEIGHT)];
    let triangle = [(THICK, foot), (tip, below), (THICK, below)];
    for (corners, out) in [(&ell[..], side), (&triangle[..], rib)] {
        face(&mut solid, drawn(corners, &[]), true, &y(-out));
        face(&mut solid, drawn(corners, &[]), false, &y(out));
    }
    let slope = |p: DVec2| DVec3::new(THICK + p.x - middle, p.y, foot + p.x);
    face(&mut solid, rectangle((0.0, -rib), (GUSSET, rib), &[]), false, &slope);
    solid.welded()
}

fn hole(u: f64, v: f64) -> Ring {
    outline::circle(DVec2::new(u, v), RADIUS).reversed()
}

fn drawn(corners: &[(f64, f64)], holes: &[Ring]) -> Polygon {
    Polygon { outer: Ring::new(corners.iter().copied().map(DVec2::from).collect()), holes: holes.to_vec() }
}

fn rectangle(low: (f64, f64), high: (f64, f64), holes: &[Ring]) -> Polygon {
    drawn(&[low, (high.0, low.1), high, (low.0, high.1)], holes)
}

/// Adds a flat face; `ahead` if its outline is counter-clockwise seen from outside.
fn face(solid: &mut Solid, outline: Polygon, ahead: bool, place: Place) {
    let first = solid.vertices.len();
    solid.vertices.extend(outline.rings().flat_map(Ring::points).map(|p| place(*p)));
    let triangles =
        triangulate_by_edges(&outline).into_iter().map(|[a, b, c]| if ahead { [a, b, c] } else { [a, c, b] });
    solid.triangles.extend(triangles.map(|t| t.map(|corner| (first + corner) as u32)));
}

/// Adds the wall of a hole from one face to another.
fn bore(solid: &mut Solid, hole: &Ring, from: Place, to: Place) {
    for (p, q) in hole.edges() {
        let first = solid.vertices.len() as u32;
        solid.vertices.extend([from(p), from(q), to(q), to(p)]);
        solid.triangles.extend([[0, 1, 2], [0, 2, 3]].map(|t| t.map(|corner| first + corner)));
    }
}
