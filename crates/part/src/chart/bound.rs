//! A bound of a body: a plane above which it lies, or a cylinder inside or outside which it lies.
//!
//! Where a branch of a part begins on its trunk, the branch is what lies outside the trunk's cylinder: its first layers
//! end on the trunk, as on a saddle.

use super::polar::Polar;
use super::{Cylinder, Plane, Side, warp};
use crate::model::Mesh;
use crate::model::cut::{Along, Pieces, pieces};
use crate::task::Task;
use glam::{DVec2, DVec3};
use serde::{Deserialize, Serialize};

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
/// Edges of its face are this much longer at most, so that those of its rim, on arcs, count as short enough.
const LONGER: f64 = 1.1;
/// Its face is spread out by powers of e up to this one and down to its inverse.
const MOST_POWER: f64 = 60.0;

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
    // A triangle is covered by the balls over its edges, and no point of it lies farther from the axis than its corners.
    let is_out = |p: DVec3| cylinder.off_axis(p) > cylinder.radius + IN_IT;
    let may_cross = |a: DVec3, b: DVec3| (is_out(a) || is_out(b)) && height(a.midpoint(b)).abs() <= a.distance(b) / 2.0;
    // The cut through a triangle is at most as long as its two edges that are cut.
    let Ok(fine) = warp::divided_where(mesh, step / 2.0, &Task::new(), may_cross) else { return Mesh::default() };
    let cut = Cut::new(cylinder, &fine);
    let kept = fine.vertices.iter().filter(|p| cut.is_above(**p)).count();
    if kept == fine.vertices.len() {
        return mesh.clone();
    }
    if kept == 0 {
        return Mesh::default();
    }
    let Pieces { vertices, mut kept, face } = pieces(&fine, &cut);
    // The closing face follows the cylinder; its rim is fine enough, and shared with the rest.
    let spread: Vec<DVec3> = vertices.iter().map(|p| cut.flat(*p).extend(0.0)).collect();
    let nearest = face.iter().flatten().map(|corner| spread[*corner as usize].length()).fold(f64::MAX, f64::min);
    let spread = Mesh { vertices: spread, triangles: face, ..Mesh::default() };
    let most = LONGER * step / cylinder.radius;
    let rounds = |a: DVec3, b: DVec3| a.truncate().angle_to(b.truncate()).abs() > most;
    let Ok(face) = warp::divided_where(&spread, most * nearest, &Task::new(), rounds) else { return Mesh::default() };
    let more = face.vertices[vertices.len()..].iter().map(|p| cut.place(p.truncate()));
    let vertices = vertices.iter().copied().chain(more).collect();
    kept.extend(face.triangles);
    Mesh::from_triangles(vertices, kept).0
}

/// A cut along a cylinder.
///
/// Its points are spread out around the axis as if seen along it, each at a distance that is a power of e: angles stay, small
/// shapes as well, and nothing has to be cut open, however far around a cut goes.
struct Cut<'a> {
    cylinder: &'a Cylinder,
    /// Height of the cut, mm: a little beside the cylinder.
    at: f64,
    /// Place along the axis whose distance is 1, mm.
    middle: f64,
    /// Powers for each mm along the axis.
    power: f64,
    /// 1 if an angle runs counter-clockwise seen from above the face, -1 otherwise.
    sign: f64,
}

impl<'a> Cut<'a> {
    fn new(cylinder: &'a Cylinder, mesh: &Mesh) -> Self {
        let along = mesh.vertices.iter().map(|p| cylinder.around(*p).along);
        let [low, high] = along.fold([f64::MAX, f64::MIN], |[low, high], at| [low.min(at), high.max(at)]);
        let power = (1.0 / cylinder.radius).min(2.0 * MOST_POWER / (high - low).max(f64::MIN_POSITIVE));
        let (at, sign) = if cylinder.side == Side::Outer { (IN_IT, 1.0) } else { (-IN_IT, -1.0) };
        Self { cylinder, at, middle: low.midpoint(high), power, sign }
    }

    /// Inverse of [`Along::flat`].
    fn place(&self, flat: DVec2) -> DVec3 {
        let along = self.middle - flat.length().ln() / self.power;
        self.cylinder.at(self.sign * flat.to_angle(), along, self.at).place
    }
}

impl Along for Cut<'_> {
    fn is_above(&self, p: DVec3) -> bool {
        self.cylinder.around(p).height >= self.at
    }

    fn crossing(&self, below: DVec3, above: DVec3) -> DVec3 {
        let [low, high] = [below, above].map(|p| self.cylinder.around(p).height - self.at);
        let on_edge = self.cylinder.around(below.lerp(above, -low / (high - low)));
        if high == 0.0 { above } else { self.cylinder.at(on_edge.angle, on_edge.along, self.at).place }
    }

    fn flat(&self, p: DVec3) -> DVec2 {
        let around = self.cylinder.around(p);
        DVec2::from_angle(self.sign * around.angle) * ((self.middle - around.along) * self.power).exp()
    }
}
