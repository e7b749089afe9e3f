//! A mesh in the coordinates of a chart: its triangles are divided until their edges are straight in the chart as well,
//! what lies below the surface on which the build begins is cut off, and a mesh around an axis is cut open at the seam.
//!
//! A part around an axis and its unrolled mesh are linked by an intermediate mesh with angles as lengths, in which the
//! seam and the underside of the first layer are planes.

use super::polar::{Around, Polar, near};
use super::{Chart, Guide, Lie, Surface};
use crate::model::{Mesh, cut};
use crate::task::{Cancelled, Task};
use glam::DVec3;
use std::collections::{BTreeMap, HashMap};
use std::f64::consts::{PI, TAU};

/// A mesh in the coordinates of a chart, with edges within `tolerance` (mm) of the true ones. Empty if nothing lies
/// above the start of the chart's first layer.
///
/// ```
/// use bead_part::{chart::{Chart, warp}, example, task::Task};
///
/// // A cross 20 mm high, of two arms of 100 × 36 mm, unrolled from a radius of 30 mm on: the metal stays as much.
/// let chart: Chart = "cylinder:axis=z,radius=30".parse()?;
/// let cross = example::find("cross").ok_or("no such example")?.mesh();
/// let unrolled = warp::warped(&chart, &cross, 0.01, &Task::new())?;
/// let (low, high) = unrolled.bounds();
/// assert!(low.z == 0.0 && (high.z - (50_f64.hypot(18.0) - 30.0)).abs() < 0.01);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`WarpError`].
pub fn warped(chart: &Chart, mesh: &Mesh, tolerance: f64, task: &Task) -> Result<Mesh, WarpError> {
    let unrolled = unrolled(chart, mesh, tolerance, task)?;
    if let Lie::Over(surface) = chart.lie() {
        check_slope(surface, unrolled.vertices.iter().copied())?;
    }
    Ok(unrolled)
}

/// The same for metal that is not welded but lies under what is: however steep a surface is there.
///
/// # Errors
/// [`WarpError`], but not [`WarpError::Steep`].
pub fn unrolled(chart: &Chart, mesh: &Mesh, tolerance: f64, task: &Task) -> Result<Mesh, WarpError> {
    match chart.lie() {
        Lie::Flat(plane) => Ok(mapped(mesh.clone(), |p| plane.coordinates(p))),
        Lie::Along(guide) => along(guide, mesh, tolerance, task),
        Lie::Over(surface) => over(surface, mesh, tolerance, task),
        Lie::Around(polar) => around(polar, mesh, tolerance, task),
    }
}

/// The inverse for a surface: a mesh given in its coordinates, mapped to space and divided until its edges lie within
/// `tolerance` (mm) of the true ones.
///
/// # Errors
/// [`WarpError::Cancelled`].
pub fn bent(surface: &Surface, flat: &Mesh, tolerance: f64, task: &Task) -> Result<Mesh, WarpError> {
    let place = |p: DVec3| surface.at(p).place;
    let cut = |a: DVec3, b: DVec3| {
        let off = |part: f64| place(a.lerp(b, part)).distance(place(a).lerp(place(b), part));
        let is_short = a.distance(b) < SHORT_BENT * surface.step();
        let long = a.distance(b) > surface.step();
        let bent = !is_short && (long || [0.25, 0.5, 0.75].into_iter().any(|part| off(part) > tolerance));
        Ok(bent.then(|| a.midpoint(b)))
    };
    let Divided { vertices, triangles } = Divided::of(flat, cut, task)?;
    Ok(Mesh::from_triangles(vertices.into_iter().map(place).collect(), triangles).0)
}

/// The same mesh with edges no longer than this, mm.
///
/// # Errors
/// [`WarpError::Cancelled`].
pub fn divided(mesh: &Mesh, longest: f64, task: &Task) -> Result<Mesh, WarpError> {
    divided_where(mesh, longest, task, |_, _| true)
}

/// The same mesh with those edges that are wanted, by their ends, no longer than this, mm.
///
/// # Errors
/// [`WarpError::Cancelled`].
pub(crate) fn divided_where(
    mesh: &Mesh,
    longest: f64,
    task: &Task,
    wanted: impl Fn(DVec3, DVec3) -> bool,
) -> Result<Mesh, WarpError> {
    let cut = |a: DVec3, b: DVec3| Ok((a.distance(b) > longest && wanted(a, b)).then(|| a.midpoint(b)));
    let Divided { vertices, triangles } = Divided::of(mesh, cut, task)?;
    Ok(Mesh { vertices, triangles, ..Mesh::default() })
}

/// Edges shorter than this fraction of the grid are not divided further: at a kink they never become straight.
const SHORT_BENT: f64 = 0.1;

/// # Errors
/// [`WarpError::Steep`] where layers at these coordinates cannot follow a surface.
pub(crate) fn check_slope(surface: &Surface, mut coordinates: impl Iterator<Item = DVec3>) -> Result<(), WarpError> {
    match coordinates.find(|p| surface.stretch(p.truncate()) > STEEPEST) {
        Some(p) => Err(WarpError::Steep { place: surface.at(p).place, stretch: surface.stretch(p.truncate()) }),
        None => Ok(()),
    }
}

/// Why a mesh cannot be mapped to a chart.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum WarpError {
    /// Stopped by the caller.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// Metal on both sides of a place that is equally near to two sections of a guide.
    #[error(
        "near x {:.1} y {:.1} z {:.1} mm the part lies as near to one stretch of the guide as to another, or in the centre of a bend, so \
         it is not clear which layers it belongs to. Bend the guide less, or divide the part.",
        .0.x, .0.y, .0.z
    )]
    Torn(DVec3),
    /// A surface too steep for layers over it.
    #[error(
        "near x {:.1} y {:.1} z {:.1} mm the surface slopes so much that beads would lie {:.0} % farther apart than planned; {:.0} % are \
         allowed, which is a slope of 17.7°. Measure its heights along a direction nearer to its normal, or divide the part into bodies.",
        .place.x, .place.y, .place.z, 100.0 * (.stretch - 1.0), 100.0 * (STEEPEST - 1.0)
    )]
    Steep {
        /// Where, mm.
        place: DVec3,
        /// The factor by which beads would lie farther apart there.
        stretch: f64,
    },
}

fn mapped(mut mesh: Mesh, coordinates: impl Fn(DVec3) -> DVec3) -> Mesh {
    mesh.vertices.iter_mut().for_each(|p| {
        *p = coordinates(*p);
        p.z = on_it(p.z);
    });
    above(mesh, 0.0)
}

fn along(guide: &Guide, mesh: &Mesh, tolerance: f64, task: &Task) -> Result<Mesh, WarpError> {
    let divided = Divided::of(mesh, |a, b| cut_along(a, b, guide, tolerance), task)?;
    let whole = Mesh::from_triangles(divided.vertices, divided.triangles).0;
    Ok(mapped(whole, |p| guide.coordinates(p)))
}

fn over(surface: &Surface, mesh: &Mesh, tolerance: f64, task: &Task) -> Result<Mesh, WarpError> {
    let cut = |a: DVec3, b: DVec3| {
        let (from, to) = (surface.coordinates(a), surface.coordinates(b));
        let off = |part: f64| surface.coordinates(a.lerp(b, part)).distance(from.lerp(to, part));
        let is_short = a.distance(b) < tolerance.max(SHORT_OVER * surface.step());
        let bent = !is_short && [0.25, 0.5, 0.75].into_iter().any(|part| off(part) > tolerance);
        Ok(bent.then(|| a.midpoint(b)))
    };
    let divided = Divided::of(mesh, cut, task)?;
    let whole = Mesh::from_triangles(divided.vertices, divided.triangles).0;
    Ok(mapped(whole, |p| surface.coordinates(p)))
}

/// Edges shorter than this fraction of a surface's grid count as straight over it.
const SHORT_OVER: f64 = 0.02;
/// Largest factor by which slopes may spread beads apart; steeper ones are refused.
pub(crate) const STEEPEST: f64 = 1.05;

fn around(polar: &dyn Polar, mesh: &Mesh, tolerance: f64, task: &Task) -> Result<Mesh, WarpError> {
    let divided = Divided::of(mesh, |a, b| Ok(is_bent(a, b, polar, tolerance).then(|| a.midpoint(b))), task)?;
    let mut cut = Cut::opened(&divided, polar);
    let (low, high) = cut.bounds();
    let middle = low.midpoint(high);
    // Tips of the closing faces, to which no edge of the part leads.
    let under = middle.with_z(low.z.min(0.0) - APEX * SPREAD);
    cut.clip(Face { axis: 0, up: true, at: -PI * SPREAD }, under);
    cut.clip(Face { axis: 0, up: false, at: PI * SPREAD }, under);
    task.check()?;
    cut.clip(Face { axis: 2, up: true, at: 0.0 }, middle + DVec3::Y * (APEX * SPREAD));
    cut.vertices.iter_mut().for_each(|p| *p = polar.unrolled(p.x / SPREAD, p.y, p.z).extend(p.z));
    Ok(Mesh::from_triangles(cut.vertices, cut.triangles).0)
}

/// Scale for angles as lengths, mm per rad: large enough that neighbouring vertices stay distinct.
const SPREAD: f64 = 100.0;
/// How far out the tips of closing faces lie, in rad (scaled by [`SPREAD`]).
const APEX: f64 = 0.734_209;
/// Heights smaller than this count as 0, where a part begins on the underside of the first layer, mm.
const ON_IT: f64 = 1e-6;

/// A height, mm, set to 0 where the part begins on the underside of the first layer.
fn on_it(height: f64) -> f64 {
    if height.abs() < ON_IT { 0.0 } else { height }
}

/// What lies above a height, mm; heights are unchanged.
fn above(mesh: Mesh, z: f64) -> Mesh {
    if mesh.bounds().0.z >= z {
        return mesh;
    }
    let Some((mut rest, _)) = cut::above(&mesh, z) else { return Mesh::default() };
    rest.vertices.iter_mut().for_each(|vertex| vertex.z += z);
    rest
}

/// A plane square to an axis of the coordinates, and the side of it that is kept.
#[derive(Clone, Copy)]
struct Face {
    axis: usize,
    up: bool,
    at: f64,
}

impl Face {
    fn keeps(self, p: DVec3) -> bool {
        if self.up { p[self.axis] >= self.at } else { p[self.axis] <= self.at }
    }

    fn crossing(self, a: DVec3, b: DVec3) -> DVec3 {
        let mut crossing = a.lerp(b, (self.at - a[self.axis]) / (b[self.axis] - a[self.axis]));
        crossing[self.axis] = self.at;
        crossing
    }
}

/// Triangles at a plane.
struct Clip<'a> {
    face: Face,
    vertices: &'a mut Vec<DVec3>,
    /// The vertex on each edge that the plane cuts, by the edge's ends.
    crossings: HashMap<[u32; 2], u32>,
    /// Net direction count of each edge of the closing faces: how often it runs from its lower end to its higher one,
    /// less how often back. Where two faces leave along the same edge, nothing is open.
    rim: BTreeMap<[u32; 2], i32>,
}

impl Clip<'_> {
    /// The part of a triangle that is kept. A triangle in the plane is dropped, and its edges become rim, since the
    /// closing face replaces it.
    fn kept(&mut self, triangle: &[u32; 3]) -> Vec<[u32; 3]> {
        let edges = [0, 1, 2].map(|k| [triangle[k], triangle[(k + 1) % 3]]);
        if triangle.iter().all(|corner| self.vertices[*corner as usize][self.face.axis] == self.face.at) {
            edges.into_iter().for_each(|edge| self.open(edge));
            return Vec::new();
        }
        let (mut corners, mut leaves, mut enters) = (Vec::with_capacity(4), None, None);
        for ends in edges {
            let inside = ends.map(|end| self.face.keeps(self.vertices[end as usize]));
            if inside[0] {
                corners.push(ends[0]);
            }
            if inside[0] != inside[1] {
                let crossing = self.crossing(ends);
                corners.push(crossing);
                *if inside[0] { &mut leaves } else { &mut enters } = Some(crossing);
            }
        }
        corners.dedup();
        if corners.first() == corners.last() {
            corners.pop();
        }
        if let (Some(leaves), Some(enters)) = (leaves, enters)
            && leaves != enters
        {
            self.open([enters, leaves]);
        }
        (2..corners.len()).map(|k| [corners[0], corners[k - 1], corners[k]]).collect()
    }

    fn crossing(&mut self, [a, b]: [u32; 2]) -> u32 {
        let ends = [a.min(b), a.max(b)];
        let places = ends.map(|end| self.vertices[end as usize]);
        if let Some(on_it) = places.iter().position(|p| p[self.face.axis] == self.face.at) {
            return ends[on_it];
        }
        *self.crossings.entry(ends).or_insert_with(|| {
            self.vertices.push(self.face.crossing(places[0], places[1]));
            self.vertices.len() as u32 - 1
        })
    }

    /// Records an edge of the closing face.
    fn open(&mut self, [from, to]: [u32; 2]) {
        *self.rim.entry([from.min(to), from.max(to)]).or_default() += if from < to { 1 } else { -1 };
    }
}

/// Triangles that are cut.
#[derive(Default)]
struct Cut {
    vertices: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
}

impl Cut {
    fn bounds(&self) -> (DVec3, DVec3) {
        self.vertices.iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), &v| (low.min(v), high.max(v)))
    }

    /// Keeps one side of a plane. Each edge of the cut becomes a triangle with the tip `apex`, moved onto the plane.
    /// Where the edges form a ring, these triangles close it; they may overlap, so a slice may have edges there and
    /// back, but its area is right.
    fn clip(&mut self, face: Face, mut apex: DVec3) {
        apex[face.axis] = face.at;
        if self.vertices.iter().all(|p| face.keeps(*p)) {
            return;
        }
        let mut clip = Clip { face, vertices: &mut self.vertices, crossings: HashMap::new(), rim: BTreeMap::new() };
        let mut triangles: Vec<[u32; 3]> = self.triangles.iter().flat_map(|triangle| clip.kept(triangle)).collect();
        let rim = clip.rim;
        let tip = self.vertices.len() as u32;
        self.vertices.push(apex);
        for ([a, b], count) in rim {
            let closing = if count > 0 { [a, b, tip] } else { [b, a, tip] };
            triangles.extend((0..count.abs()).map(|_| closing));
        }
        self.triangles = triangles;
        self.compact();
    }

    /// Leaves out vertices that no triangle uses.
    fn compact(&mut self) {
        let (mut numbers, mut used) = (vec![None; self.vertices.len()], Vec::new());
        for corner in self.triangles.iter_mut().flatten() {
            let number = *numbers[*corner as usize].get_or_insert_with(|| {
                used.push(self.vertices[*corner as usize]);
                used.len() as u32 - 1
            });
            *corner = number;
        }
        self.vertices = used;
    }

    /// Triangles with angle × [`SPREAD`], position along the straight lines and height as coordinates; those that cross
    /// the seam appear on both sides.
    fn opened(mesh: &Divided, polar: &dyn Polar) -> Self {
        let snapped = |around: Around| Around { height: on_it(around.height), ..around };
        let around: Vec<Around> = mesh.vertices.iter().map(|p| snapped(polar.around(*p))).collect();
        let (mut vertices, mut triangles, mut numbers) = (Vec::new(), Vec::new(), HashMap::new());
        for triangle in &mesh.triangles {
            let corners = triangle.map(|corner| around[corner as usize]);
            if corners.iter().all(|corner| corner.height < 0.0) {
                continue;
            }
            let angles = corners.map(|corner| near(corner.angle, corners[0].angle));
            let beyond = |turns: f64| {
                let angles = angles.map(|angle| angle + turns * TAU);
                angles.iter().any(|angle| *angle < PI) && angles.iter().any(|angle| *angle > -PI)
            };
            for turns in [-1.0, 0.0, 1.0].into_iter().filter(|turns| beyond(*turns)) {
                triangles.push([0, 1, 2].map(|k| {
                    let angle = angles[k] + turns * TAU;
                    let turn = ((angle - corners[k].angle) / TAU).round() as i32;
                    *numbers.entry((triangle[k], turn)).or_insert_with(|| {
                        vertices.push(DVec3::new(angle * SPREAD, corners[k].along, corners[k].height));
                        vertices.len() as u32 - 1
                    })
                }));
            }
        }
        Self { vertices, triangles }
    }
}

/// A mesh whose edges are straight in a chart as well.
struct Divided {
    vertices: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
}

impl Divided {
    /// Divides edges at the points that `cut` returns, until it returns none.
    fn of(
        mesh: &Mesh,
        cut: impl Fn(DVec3, DVec3) -> Result<Option<DVec3>, WarpError>,
        task: &Task,
    ) -> Result<Self, WarpError> {
        let (mut vertices, mut open, mut done) = (mesh.vertices.clone(), mesh.triangles.clone(), Vec::new());
        let mut middles: HashMap<[u32; 2], Option<u32>> = HashMap::new();
        let mut middle = |vertices: &mut Vec<DVec3>, ends: [u32; 2]| -> Result<Option<u32>, WarpError> {
            if let Some(known) = middles.get(&ends) {
                return Ok(*known);
            }
            let [a, b] = ends.map(|end| vertices[end as usize]);
            let middle = cut(a, b)?.map(|place| {
                vertices.push(place);
                vertices.len() as u32 - 1
            });
            middles.insert(ends, middle);
            Ok(middle)
        };
        while !open.is_empty() {
            task.check()?;
            let mut next = Vec::new();
            for triangle in open {
                let mut halves = [None; 3];
                for (k, half) in halves.iter_mut().enumerate() {
                    let (a, b) = (triangle[k], triangle[(k + 1) % 3]);
                    *half = middle(&mut vertices, [a.min(b), a.max(b)])?;
                }
                match halves {
                    [None, None, None] => done.push(triangle),
                    _ => split(triangle, halves, &vertices, &mut next),
                }
            }
            open = next;
        }
        Ok(Self { vertices, triangles: done })
    }
}

/// Whether an edge bends in a chart by more than `tolerance` (mm). Edges wholly below the first layer do not matter.
fn is_bent(a: DVec3, b: DVec3, polar: &dyn Polar, tolerance: f64) -> bool {
    let length = a.distance(b);
    let [first, last] = [a, b].map(|p| polar.around(p));
    // Heights change by no more than the length of the edge.
    if length < tolerance || first.height + last.height + length < -4.0 * ON_IT {
        return false;
    }
    let angle = |around: Around| near(around.angle, first.angle);
    let unrolled =
        |angle: f64, around: Around| polar.unrolled(angle, around.along, around.height).extend(around.height);
    let (from, to) = (unrolled(first.angle, first), unrolled(angle(last), last));
    [0.25, 0.5, 0.75].into_iter().any(|part| {
        let on_it = polar.around(a.lerp(b, part));
        let place = unrolled(angle(on_it), on_it);
        // Between the two it is cut where angles are lengths.
        let even = first.angle + (angle(last) - first.angle) * part;
        place.distance(from.lerp(to, part)) > tolerance || place.distance(unrolled(even, on_it)) > tolerance
    })
}

/// Where to divide an edge that bends along a guide by more than `tolerance` (mm): first where spans of the guide meet,
/// because the edge has a corner there.
fn cut_along(a: DVec3, b: DVec3, guide: &Guide, tolerance: f64) -> Result<Option<DVec3>, WarpError> {
    let ([from, to], length) = ([a, b].map(|p| guide.coordinates(p)), a.distance(b));
    if length < tolerance || from.z.max(to.z) < 0.0 {
        return Ok(None);
    }
    if length < SHORT && from.distance(to) > JUMP * length {
        return Err(WarpError::Torn(a));
    }
    if let Some(place) = guide.joint_between([a, b], [from.z, to.z]) {
        return Ok(Some(place));
    }
    let off = |part: f64| guide.coordinates(a.lerp(b, part)).distance(from.lerp(to, part));
    Ok([0.25, 0.5, 0.75].into_iter().any(|part| off(part) > tolerance).then(|| a.midpoint(b)))
}

/// Edges shorter than this are checked, mm:
const SHORT: f64 = 1.0;
/// one that the chart lengthens by more than this factor jumps to another section of the guide, or past the centre of a
/// bend.
const JUMP: f64 = 20.0;

/// The pieces of a triangle of which some edges are divided.
fn split([a, b, c]: [u32; 3], middle: [Option<u32>; 3], vertices: &[DVec3], pieces: &mut Vec<[u32; 3]>) {
    match middle {
        [None, None, None] => pieces.push([a, b, c]),
        [Some(ab), Some(bc), Some(ca)] => pieces.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]),
        [Some(ab), None, None] => pieces.extend([[a, ab, c], [ab, b, c]]),
        [Some(ab), Some(bc), None] => {
            pieces.push([ab, b, bc]);
            // The shorter diagonal gives better-shaped triangles.
            let length = |from: u32, to: u32| vertices[from as usize].distance_squared(vertices[to as usize]);
            let shorter = length(a, bc) < length(ab, c);
            pieces.extend(if shorter { [[a, ab, bc], [a, bc, c]] } else { [[a, ab, c], [ab, bc, c]] });
        }
        _ => split([b, c, a], [middle[1], middle[2], middle[0]], vertices, pieces),
    }
}
