//! Points on the boundary and the triangles between them.

use super::MedialOptions;
use super::boundary::{Boundary, Edge};
use super::disc::Tent;
use glam::DVec2;
use rustc_hash::FxHashMap;
use spade::{ConstrainedDelaunayTriangulation, HasPosition, Point2, Triangulation};

/// Rough upper limit on the number of samples; the spacing grows where more would be needed.
const MOST_SAMPLES: f64 = 1e6;

/// Vertices that turn by less than this, rad, never get samples of their own.
const LEAST_TURN: f64 = 2.0 * std::f64::consts::PI / 180.0;

/// Vertices that turn by more than this, rad, always get samples: every triangle has a corner that does.
const MOST_TURN: f64 = 90.0 * std::f64::consts::PI / 180.0;

/// The circle about a peak through the samples below it must be free of boundary up to this fraction of its radius.
const FREE_REACH: f64 = 0.8;

/// A point on the boundary.
#[derive(Clone, Copy)]
pub(super) struct Sample {
    pub at: DVec2,
    /// An edge on which it lies.
    pub edge: usize,
}

impl HasPosition for Sample {
    type Scalar = f64;

    fn position(&self) -> Point2<f64> {
        Point2::new(self.at.x, self.at.y)
    }
}

/// A triangle inside the polygon.
pub(super) struct Cell {
    /// Samples, counter-clockwise.
    pub corners: [usize; 3],
    /// The side opposite each corner, where it is a chord and not boundary.
    pub chords: [Option<usize>; 3],
}

/// The triangles inside and the chords between them.
pub(super) struct Mesh {
    pub samples: Vec<Sample>,
    /// The two ends of each chord.
    pub chords: Vec<[usize; 2]>,
    /// The triangles on either side of each chord.
    pub sides: Vec<[usize; 2]>,
    pub cells: Vec<Cell>,
    /// The middle of the circle round each triangle.
    pub centres: Vec<Option<DVec2>>,
}

type Cdt = ConstrainedDelaunayTriangulation<Sample>;

impl Mesh {
    /// `None` when rounding makes boundary edges cross each other.
    pub(super) fn of(boundary: &Boundary, options: &MedialOptions) -> Option<Self> {
        let (samples, sides) = sample(boundary, options);
        let mut crossed = false;
        let cdt = Cdt::try_bulk_load_cdt(samples, sides, |_| crossed = true).ok()?;
        if crossed {
            return None;
        }
        let samples: Vec<Sample> = cdt.vertices().map(|v| *v.data()).collect();
        let inside = faces_inside(&cdt);
        let mut mesh = Self { samples, chords: Vec::new(), sides: Vec::new(), cells: Vec::new(), centres: Vec::new() };
        let mut chord_of_edge = vec![None; cdt.num_undirected_edges()];
        for face in cdt.inner_faces().filter(|f| inside[f.index()]) {
            let cell = mesh.cells.len();
            let edges = face.adjacent_edges();
            let chords = [edges[1], edges[2], edges[0]].map(|edge| {
                if edge.is_constraint_edge() {
                    return None;
                }
                let ends = [edge.from().index(), edge.to().index()];
                Some(mesh.chord(&mut chord_of_edge[edge.as_undirected().index()], ends, cell))
            });
            let corners = edges.map(|e| e.from().index());
            mesh.centres.push(circumcentre(corners.map(|c| mesh.at(c))));
            mesh.cells.push(Cell { corners, chords });
        }
        Some(mesh)
    }

    fn chord(&mut self, known: &mut Option<usize>, ends: [usize; 2], cell: usize) -> usize {
        if let Some(chord) = *known {
            self.sides[chord][1] = cell;
            return chord;
        }
        *known = Some(self.chords.len());
        self.chords.push(ends);
        self.sides.push([cell, cell]);
        self.chords.len() - 1
    }

    /// The path over the midpoint of the Voronoi edge of a chord. It has no peak if that midpoint lies outside or the
    /// samples are too far apart for the thickness.
    pub(super) fn tent(&self, boundary: &Boundary, chord: usize) -> Tent {
        let ends = self.chords[chord].map(|s| self.samples[s]);
        let [p, q] = self.sides[chord].map(|cell| self.centres[cell]);
        let peak = p.zip(q).map(|(p, q)| (p + q) / 2.0).filter(|&peak| {
            let reach = peak.distance(ends[0].at);
            let foot = boundary.nearest(peak, reach * (1.0 + 1e-9));
            foot.is_some_and(|f| f.distance > FREE_REACH * reach && boundary.inside(&f, peak))
        });
        Tent { ends, peak }
    }

    pub(super) fn at(&self, sample: usize) -> DVec2 {
        self.samples[sample].at
    }
}

impl Cell {
    /// Its chords, each with the corner opposite.
    pub(super) fn chords(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        self.chords.iter().zip(self.corners).filter_map(|(chord, corner)| Some(((*chord)?, corner)))
    }
}

fn circumcentre([a, b, c]: [DVec2; 3]) -> Option<DVec2> {
    let (u, v) = (b - a, c - a);
    let centre = a + (u.length_squared() * v.perp() - v.length_squared() * u.perp()) / (2.0 * v.perp_dot(u));
    centre.is_finite().then_some(centre)
}

/// For each face by index, whether it lies inside: an odd number of boundaries separates it from the outside.
fn faces_inside(cdt: &Cdt) -> Vec<bool> {
    let mut inside: Vec<Option<bool>> = vec![None; cdt.num_all_faces()];
    let outer = cdt.outer_face();
    inside[outer.index()] = Some(false);
    let mut open = Vec::new();
    for edge in cdt.convex_hull() {
        // Hull edges have the outer face on one side; start from the triangle on the other.
        let edge = if edge.face().is_outer() { edge.rev() } else { edge };
        if !edge.face().is_outer() && inside[edge.face().index()].is_none() {
            inside[edge.face().index()] = Some(edge.is_constraint_edge());
            open.push(edge.face());
        }
    }
    while let Some(face) = open.pop() {
        let here = inside[face.index()];
        let Some(triangle) = face.as_inner() else { continue };
        for edge in triangle.adjacent_edges() {
            let other = edge.rev().face();
            if inside[other.index()].is_none() {
                inside[other.index()] = here.map(|here| here != edge.is_constraint_edge());
                open.push(other);
            }
        }
    }
    inside.into_iter().map(|i| i == Some(true)).collect()
}

/// Points along every ring, and the sides between them as pairs of indices.
fn sample(boundary: &Boundary, options: &MedialOptions) -> (Vec<Sample>, Vec<[usize; 2]>) {
    let spacing = options.spacing.max(boundary.length() / MOST_SAMPLES);
    let guards: Vec<Option<f64>> = (0..boundary.edges.len()).map(|e| guard(boundary, e, options.min_angle)).collect();
    let mut samples: Vec<Sample> = Vec::new();
    let mut known = FxHashMap::default();
    let mut index = |at: DVec2, edge: usize| {
        // Rings may share a vertex. Adding zero turns −0 into 0, so that equal points have equal bits.
        let bits = [(at.x + 0.0).to_bits(), (at.y + 0.0).to_bits()];
        *known.entry(bits).or_insert_with(|| {
            samples.push(Sample { at, edge });
            samples.len() - 1
        })
    };
    let mut sides = Vec::new();
    for (number, edge) in boundary.edges.iter().enumerate() {
        let mut last = index(edge.a, number);
        for t in stations(edge.a.distance(edge.b), [guards[number], guards[edge.next]], spacing) {
            let next = index(edge.a.lerp(edge.b, t), number);
            sides.push([last, next]);
            last = next;
        }
        sides.push([last, index(edge.b, edge.next)]);
    }
    sides.retain(|[a, b]| a != b);
    (samples, sides)
}

/// How far from the start of an edge, mm, the first samples must lie on both sides of that vertex, so that the
/// triangulation cuts off the corner and the axis runs into it: the circle through the vertex and both samples
/// must not reach any other edge. `None` where the vertex turns inwards or hardly at all.
fn guard(boundary: &Boundary, edge: usize, min_angle: f64) -> Option<f64> {
    let Edge { a, b, previous, .. } = boundary.edges[edge];
    let before = a - boundary.edges[previous].a;
    let turn = before.perp_dot(b - a).atan2(before.dot(b - a));
    if turn < min_angle.clamp(LEAST_TURN, MOST_TURN) {
        return None;
    }
    let other = boundary.nearest_but(a, f64::INFINITY, |e| e == edge || e == previous)?;
    let guard = other.distance * (0.8 * (turn / 2.0).sin()).min(0.3);
    (guard > 0.0).then_some(guard)
}

/// Positions of the samples between the ends of an edge, as fractions of its length: from a guarded end in doubling
/// steps, then evenly.
fn stations(length: f64, guards: [Option<f64>; 2], spacing: f64) -> Vec<f64> {
    let half = length / 2.0;
    if guards == [None, None] && length <= spacing {
        return Vec::new();
    }
    let mut places = half_stations(half, guards[0], spacing);
    places.push(half);
    places.extend(half_stations(half, guards[1], spacing).iter().rev().map(|x| length - x));
    places.iter().map(|x| x / length).filter(|&t| t > 0.0 && t < 1.0).collect()
}

/// Positions from an end up to, but not including, the middle of the edge, mm.
fn half_stations(half: f64, guard: Option<f64>, spacing: f64) -> Vec<f64> {
    let mut places = Vec::new();
    if let Some(guard) = guard {
        // The first sample always, equally far along both edges of the vertex.
        let mut x = guard.min(spacing);
        places.push(x);
        while 2.0 * x < spacing.min(half / 2.0) {
            x *= 2.0;
            places.push(x);
        }
    }
    let x = places.last().copied().unwrap_or(0.0);
    let steps = ((half - x) / spacing).ceil().max(1.0);
    places.extend((1..steps as usize).map(|k| x + (half - x) * k as f64 / steps));
    places
}
