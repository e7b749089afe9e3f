//! A thick tube that forks in two, to be welded as three bodies: a trunk up to where the arms part, and the rest of
//! each arm on the slopes at the top of the trunk.

use crate::model::solid::Solid;
use glam::DVec3;
use std::collections::BTreeMap;
use std::f64::consts::TAU;

/// The slopes and the arms' layers are inclined half as much as the arms.
pub(super) const BODIES: &str = r#"[[body]]
name = "trunk"
within = ["up=-0.241922/0/-0.970296,through=0/0/112", "up=0.241922/0/-0.970296,through=0/0/112"]

[[body]]
name = "right arm"
chart = "plane:up=0.241922/0/0.970296,through=0/0/112"
within = ["up=1/0/0"]

[[body]]
name = "left arm"
chart = "plane:up=-0.241922/0/0.970296,through=0/0/112"
within = ["up=-1/0/0"]
"#;
/// Radii of the tube, mm.
const RADII: [f64; 2] = [30.0, 14.0];
/// Height at which the three middle lines meet, mm.
const FORK: f64 = 45.0;
/// Length of an arm from there, mm.
const ARM: f64 = 110.0;
/// Angle between an arm and the vertical, °.
const ANGLE: f64 = 28.0;
/// Lines along each tube, including those at x = 0.
const LINES: i32 = 128;

pub(super) fn build() -> Solid {
    let mut triangles = Vec::new();
    let quad = |triangles: &mut Vec<[DVec3; 3]>, [a, b, c, d]: [DVec3; 4]| triangles.extend([[a, b, c], [a, c, d]]);
    let lines = |radius: f64| move |k: i32| Line::new(radius, k);
    let [outer, inner] = RADII.map(lines);
    for k in -LINES / 4..LINES / 4 {
        let [o, i] = [[outer(k), outer(k + 1)], [inner(k), inner(k + 1)]];
        quad(&mut triangles, [o[0].foot(), o[1].foot(), o[1].start(), o[0].start()]);
        quad(&mut triangles, [i[1].foot(), i[0].foot(), i[0].start(), i[1].start()]);
        quad(&mut triangles, [o[1].foot(), o[0].foot(), i[0].foot(), i[1].foot()]);
    }
    for k in -LINES / 4..3 * LINES / 4 {
        let [o, i] = [[outer(k), outer(k + 1)], [inner(k), inner(k + 1)]];
        quad(&mut triangles, [o[0].start(), o[1].start(), o[1].end(), o[0].end()]);
        quad(&mut triangles, [i[1].start(), i[0].start(), i[0].end(), i[1].end()]);
        quad(&mut triangles, [o[0].end(), o[1].end(), i[1].end(), i[0].end()]);
    }
    // The left half is the mirror image of the right one.
    let mirrored = |p: DVec3| DVec3::new(if p.x == 0.0 { 0.0 } else { -p.x }, p.y, p.z);
    let left: Vec<[DVec3; 3]> = triangles.iter().map(|[a, b, c]| [a, c, b].map(|p| mirrored(*p))).collect();
    indexed(triangles.into_iter().chain(left))
}

/// A line up the trunk and on along the right arm, at one position around the tube.
struct Line {
    /// Away from the middle line in the plane of the fork, and square to that plane, mm.
    across: f64,
    y: f64,
}

impl Line {
    fn new(radius: f64, k: i32) -> Self {
        let angle = TAU * f64::from(k) / f64::from(LINES);
        let is_middle = (k - LINES / 4) % (LINES / 2) == 0;
        Self { across: if is_middle { 0.0 } else { radius * angle.cos() }, y: radius * angle.sin() }
    }

    /// On the plate.
    fn foot(&self) -> DVec3 {
        DVec3::new(self.across, self.y, 0.0)
    }

    /// Where the arm begins: on the trunk, or in the crotch between the two arms.
    fn start(&self) -> DVec3 {
        let angle = ANGLE.to_radians();
        if self.across >= 0.0 {
            return DVec3::new(self.across, self.y, FORK - (angle / 2.0).tan() * self.across);
        }
        DVec3::new(0.0, self.y, FORK - self.across / angle.sin())
    }

    /// At the end of the arm.
    fn end(&self) -> DVec3 {
        let (sin, cos) = ANGLE.to_radians().sin_cos();
        DVec3::new(self.across * cos + ARM * sin, self.y, FORK - self.across * sin + ARM * cos)
    }
}

/// Triangles that share their corners.
fn indexed(triangles: impl Iterator<Item = [DVec3; 3]>) -> Solid {
    let (mut numbers, mut vertices) = (BTreeMap::new(), Vec::new());
    let mut number = |p: DVec3| {
        *numbers.entry(p.to_array().map(f64::to_bits)).or_insert_with(|| {
            vertices.push(p);
            vertices.len() as u32 - 1
        })
    };
    let triangles = triangles.map(|corners| corners.map(&mut number)).collect();
    Solid { vertices, triangles }
}
