//! A bound of a body: a plane above which it lies, or a cylinder inside or outside which it lies.
//!
//! Where a branch of a part begins on its trunk, the branch is what lies outside the trunk's cylinder: its first layers
//! end on the trunk, as on a saddle.

use super::polar::Polar;
use super::{Cylinder, Plane, Side, warp};
use crate::model::{Mesh, cut};
use crate::task::Task;
use glam::DVec3;
use serde::{Deserialize, Serialize};
use std::f64::consts::{PI, TAU};

/// A bound of a body. In files it is text: `up=0/0/-1,through=0/0/60`, or
/// `cylinder:axis=z,through=0/0/0,radius=15,side=inner`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub enum Bound {
    /// The body lies above a plane.
    Plane(Plane),
    /// It lies outside a cylinder, or inside it; the seam does not matter.
    Cylinder(Cylinder),
}

/// The cut follows the cylinder this closely, mm.
const TOLERANCE: f64 = 0.02;
/// Faces this close to a cylinder count as inside it, mm: those of a part that the cylinder describes are cut nowhere.
const IN_IT: f64 = 1e-4;
/// Longest edge that is cut, as a fraction of the radius.
const MOST_OF_RADIUS: f64 = 0.5;
/// A mesh that a cylinder cuts all around, but for this angle, is cut in halves, rad: more than the longest edge spans.
const GAP: f64 = 0.6;

impl Bound {
    /// Distance of a point from the bound, mm; positive on the side of the body.
    pub fn height(&self, p: DVec3) -> f64 {
        match self {
            Self::Plane(plane) => plane.coordinates(p).z,
            Self::Cylinder(cylinder) => cylinder.around(p).height,
        }
    }

    /// The part of a mesh on the side of the body, closed along the bound; empty if all of it lies on the other side.
    ///
    /// ```
    /// use bead_part::{chart::Bound, example};
    ///
    /// // A round bar of 10 mm radius out of the middle of a cross 20 mm high.
    /// let cross = example::find("cross").ok_or("no such example")?.mesh();
    /// let bar: Bound = "cylinder:axis=z,radius=10,side=inner".parse()?;
    /// let volume = std::f64::consts::PI * 100.0 * 20.0;
    /// assert!((bar.part_of(&cross).volume() / volume - 1.0).abs() < 0.002);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn part_of(&self, mesh: &Mesh) -> Mesh {
        match self {
            Self::Plane(plane) => plane.above(mesh),
            Self::Cylinder(cylinder) => side_of(cylinder, mesh),
        }
    }
}

impl From<Plane> for Bound {
    fn from(plane: Plane) -> Self {
        Self::Plane(plane)
    }
}

fn side_of(cylinder: &Cylinder, mesh: &Mesh) -> Mesh {
    let height = |p: DVec3| cylinder.around(p).height;
    // A straight edge leaves the cylinder by less than the tolerance, and none of those that are cut spans much of the circle.
    let step = (8.0 * cylinder.radius * TOLERANCE).sqrt().min(MOST_OF_RADIUS * cylinder.radius);
    let may_cross = |a: DVec3, b: DVec3| height(a.midpoint(b)).abs() <= a.distance(b) / 2.0;
    let Ok(fine) = warp::divided_where(mesh, step, &Task::new(), may_cross) else { return Mesh::default() };
    let at = if cylinder.side == Side::Outer { IN_IT } else { -IN_IT };
    let keeps = |p: DVec3| height(p) >= at;
    let kept = fine.vertices.iter().filter(|p| keeps(**p)).count();
    if kept == fine.vertices.len() {
        return mesh.clone();
    }
    if kept == 0 {
        return Mesh::default();
    }
    let crossing = fine.triangles.iter().map(|triangle| triangle.map(|corner| fine.vertices[corner as usize]));
    let crossing = crossing.filter(|corners| corners.iter().any(|p| keeps(*p)) && corners.iter().any(|p| !keeps(*p)));
    let angles: Vec<f64> = crossing.flatten().map(|p| cylinder.around(p).angle).collect();
    match gap(angles) {
        Some(middle) => {
            let seam = cylinder.seam + middle.to_degrees() + 180.0;
            cut_open(&Cylinder { seam, ..*cylinder }, &fine, at, step)
        }
        None => in_halves(cylinder, mesh),
    }
}

/// The middle of the widest gap between angles, rad; `None` if they go all around.
fn gap(mut angles: Vec<f64>) -> Option<f64> {
    angles.sort_by(f64::total_cmp);
    let first = *angles.first()?;
    let next = angles.iter().skip(1).copied().chain([first + TAU]);
    let widest = angles.iter().copied().zip(next).max_by(|a, b| (a.1 - a.0).total_cmp(&(b.1 - b.0)))?;
    (widest.1 - widest.0 > GAP).then_some((widest.0 + widest.1) / 2.0)
}

/// Cuts along the cylinder where it is unrolled; no triangle that is cut may cross its seam.
fn cut_open(cylinder: &Cylinder, mesh: &Mesh, at: f64, step: f64) -> Mesh {
    let (mut own, sign) = (mesh.clone(), if cylinder.side == Side::Outer { 1.0 } else { -1.0 });
    own.vertices.iter_mut().for_each(|p| {
        let around = cylinder.around(*p);
        *p = DVec3::new(sign * around.angle * cylinder.radius, around.along, around.height);
    });
    let Some((own, _)) = cut::above(&own, at) else { return Mesh::default() };
    // The closing face follows the cylinder.
    let on_it = |p: DVec3| p.z.abs() < IN_IT / 10.0;
    let rounds = |a: DVec3, b: DVec3| on_it(a) && on_it(b) && (a.x - b.x).abs() > step;
    let Ok(own) = warp::divided_where(&own, step, &Task::new(), rounds) else { return Mesh::default() };
    let place = |p: &DVec3| cylinder.at(sign * p.x / cylinder.radius, p.y, p.z + at).place;
    Mesh::from_triangles(own.vertices.iter().map(place).collect(), own.triangles).0
}

/// Cuts the halves on both sides of the axis, which lie side by side then.
fn in_halves(cylinder: &Cylinder, mesh: &Mesh) -> Mesh {
    let side = cylinder.at(PI / 2.0, 0.0, 0.0).normal;
    let half = |up: DVec3| side_of(cylinder, &Plane { origin: cylinder.through, up }.above(mesh));
    let mut whole = half(side);
    whole.add(half(-side));
    whole
}
