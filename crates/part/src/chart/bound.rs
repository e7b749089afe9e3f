//! A bound of a body: a plane above which it lies, or a cylinder inside or outside which it lies.
//!
//! Where a branch of a part begins on its trunk, the branch is what lies outside the trunk's cylinder: its first layers
//! end on the trunk, as on a saddle.

use super::polar::Polar;
use super::{Cylinder, Plane, Side, warp};
use crate::model::connected::joined;
use crate::model::{Mesh, cut};
use crate::task::Task;
use glam::DVec3;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};
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
/// Vertices this close to the cut lie on it, mm.
const ON_IT: f64 = IN_IT / 10.0;
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
    let crosses = |triangle: &&[u32; 3]| {
        let keeps = triangle.map(|corner| keeps(fine.vertices[corner as usize]));
        keeps.contains(&true) && keeps.contains(&false)
    };
    let crossing: Vec<[u32; 3]> = fine.triangles.iter().filter(crosses).copied().collect();
    match angles(cylinder, &fine, &crossing) {
        Some(angles) => cut_open(cylinder, &fine, &angles, at, step),
        None => in_halves(cylinder, mesh),
    }
}

/// For the vertices of triangles that cross the cylinder their angles, rad, such that those of each triangle lie side by
/// side, and of each cut with the holes in it; `None` if a cut goes all around.
fn angles(cylinder: &Cylinder, mesh: &Mesh, crossing: &[[u32; 3]]) -> Option<Vec<Option<f64>>> {
    let around: Vec<_> = mesh.vertices.iter().map(|p| cylinder.around(*p)).collect();
    let mut angles = vec![None; around.len()];
    for rim in rims(crossing, around.len(), |vertex| (around[vertex].angle, around[vertex].along)) {
        let seam = gap(rim.iter().map(|vertex| around[*vertex].angle).collect())?;
        let unrolled = |angle: f64| if angle < seam { angle + TAU } else { angle };
        rim.iter().for_each(|vertex| angles[*vertex] = Some(unrolled(around[*vertex].angle)));
    }
    Some(angles)
}

/// The vertices of triangles that hang together, or whose places (angle and length along the axis) lie around each other.
fn rims(crossing: &[[u32; 3]], corners: usize, place: impl Fn(usize) -> (f64, f64)) -> Vec<Vec<usize>> {
    let mut rims: BTreeMap<u32, BTreeSet<usize>> = BTreeMap::new();
    for (corners, rim) in crossing.iter().zip(joined(crossing, corners)) {
        rims.entry(rim).or_default().extend(corners.map(|corner| corner as usize));
    }
    let mut apart: Vec<(Vec<usize>, Spread)> = Vec::new();
    for rim in rims.into_values() {
        let mut rim = Vec::from_iter(rim);
        let mut spread = Spread::of(rim.iter().map(|vertex| place(*vertex)));
        while let Some(k) = apart.iter().position(|(_, other)| other.meets(&spread)) {
            rim.extend(apart.swap_remove(k).0);
            spread = Spread::of(rim.iter().map(|vertex| place(*vertex)));
        }
        apart.push((rim, spread));
    }
    apart.into_iter().map(|(rim, _)| rim).collect()
}

/// How far places on a cylinder reach: around it from an angle on, rad, and along it, mm.
struct Spread {
    from: f64,
    reach: f64,
    along: [f64; 2],
}

impl Spread {
    fn of(places: impl Iterator<Item = (f64, f64)> + Clone) -> Self {
        let along = places.clone().fold([f64::MAX, f64::MIN], |[low, high], (_, at)| [low.min(at), high.max(at)]);
        let angles: Vec<f64> = places.map(|(angle, _)| angle).collect();
        let seam = gap(angles.clone());
        let from = seam.unwrap_or_default();
        let turns: Vec<f64> = angles.iter().map(|angle| (angle - from).rem_euclid(TAU)).collect();
        let [low, high] = turns.iter().fold([TAU, 0.0], |[low, high], at| [at.min(low), at.max(high)]);
        match seam {
            Some(_) => Self { from: from + low, reach: high - low, along },
            None => Self { from: 0.0, reach: TAU, along },
        }
    }

    fn meets(&self, other: &Self) -> bool {
        let after = |a: &Self, b: &Self| (b.from - a.from).rem_euclid(TAU) <= a.reach;
        let along = self.along[0] <= other.along[1] && other.along[0] <= self.along[1];
        along && (after(self, other) || after(other, self))
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

/// Cuts along the cylinder where it is unrolled: at these angles of the vertices, rad.
fn cut_open(cylinder: &Cylinder, mesh: &Mesh, angles: &[Option<f64>], at: f64, step: f64) -> Mesh {
    let (mut own, sign) = (mesh.clone(), if cylinder.side == Side::Outer { 1.0 } else { -1.0 });
    own.vertices.iter_mut().zip(angles).for_each(|(p, angle)| {
        let around = cylinder.around(*p);
        // Only what is cut lies on the cylinder.
        let beside = angle.is_none() && (around.height - at).abs() < ON_IT;
        let height = if beside { around.height + 2.0 * ON_IT } else { around.height };
        *p = DVec3::new(sign * angle.unwrap_or(around.angle) * cylinder.radius, around.along, height);
    });
    let Some((own, _)) = cut::above(&own, at) else { return Mesh::default() };
    // The closing face follows the cylinder.
    let on_it = |p: DVec3| p.z.abs() < ON_IT;
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
