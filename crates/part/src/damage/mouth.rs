//! What a scan says about the part's surface: that it is there, that it is missing, or nothing.
//!
//! Where a piece of the part's surface lies outside the metal that the scan shows, it is missing: it belongs to the mouth of some damage,
//! and tells in which direction that is open. Where the nearest place of the scan lies on an open edge, or shows the metal from behind,
//! the scan says nothing about the piece.

use super::Settings;
use crate::deviation::Surface;
use crate::model::Mesh;
use crate::model::connected::joined;
use crate::task::{Cancelled, Task};
use glam::DVec3;
use rayon::prelude::*;
use rstar::primitives::Line;
use rstar::{PointDistance, RTree};
use std::collections::BTreeMap;

/// A face by its corners, mm.
pub(super) type Face = [DVec3; 3];

/// Points between two looks at whether the task was cancelled.
const BATCH: usize = 50_000;
/// A place this near to an open edge lies on it, mm.
const ON_EDGE: f64 = 1e-4;
/// Faces of a shell that are asked which way it faces, at most.
const ASKED: usize = 50;
/// Where less than this fraction of a mouth faces one way on the whole, it opens on opposite sides.
const ONE_WAY: f64 = 0.5;
/// Faces of a mouth that lean less than about 70° from a direction open in it: the cosine.
const WITH: f64 = 0.3;

/// A stretch of the part's surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stretch {
    /// Its middle, on the part's surface, mm.
    pub place: DVec3,
    /// Its area, mm².
    pub area: f64,
    /// The diameter of the circle around its middle that holds it, mm.
    pub across: f64,
}

impl Stretch {
    /// `None` if no face has an area.
    pub(super) fn of(faces: &[Face]) -> Option<Self> {
        let area: f64 = faces.iter().map(|face| vector(face).length()).sum();
        let centroid = faces.iter().map(|face| middle(face) * vector(face).length()).sum::<DVec3>() / area;
        let near = |a: &DVec3, b: &DVec3| a.distance(centroid).total_cmp(&b.distance(centroid));
        let place = faces.iter().map(middle).min_by(near)?;
        let radius = faces.iter().flatten().map(|corner| corner.distance(centroid)).fold(0.0, f64::max);
        (area > 0.0).then_some(Self { place, area, across: 2.0 * radius })
    }
}

pub(super) fn middle(face: &Face) -> DVec3 {
    face.iter().sum::<DVec3>() / 3.0
}

/// A face as a vector: its normal, as long as its area, mm².
pub(super) fn vector([a, b, c]: &Face) -> DVec3 {
    0.5 * (b - a).cross(c - a)
}

/// The direction in which a mouth is open. Where it opens on opposite sides, that of the larger side, or of the upper of two alike.
pub(super) fn direction(mouth: &[Face]) -> Option<DVec3> {
    let vectors: Vec<DVec3> = mouth.iter().map(vector).collect();
    let (sum, area) = (vectors.iter().sum::<DVec3>(), vectors.iter().map(|vector| vector.length()).sum::<f64>());
    if sum.length() >= ONE_WAY * area {
        return sum.try_normalize();
    }
    let coarse = |way: &DVec3| (way * 10.0).round().as_i64vec3().to_array();
    let ways: BTreeMap<_, DVec3> =
        vectors.iter().filter_map(|vector| vector.try_normalize()).map(|way| (coarse(&way), way)).collect();
    let open = |way: &DVec3| vectors.iter().map(|v| v.dot(*way).max(0.0)).sum::<f64>() + 1e-3 * area * way.z;
    let best = ways.into_values().max_by(|a, b| open(a).total_cmp(&open(b)))?;
    vectors.iter().filter(|v| v.dot(best) > WITH * v.length()).sum::<DVec3>().try_normalize()
}

/// For each point the distance from a surface, negative inside, mm, and the nearest point of it.
pub(super) fn nearest(surface: &Surface, points: &[DVec3], task: &Task) -> Result<Vec<(f64, DVec3)>, Cancelled> {
    let mut nearest = Vec::with_capacity(points.len());
    for batch in points.chunks(BATCH) {
        task.check()?;
        nearest.par_extend(batch.par_iter().map(|point| surface.nearest(*point)));
    }
    Ok(nearest)
}

/// Turns the faces of a scan so that they face out of the metal, each shell as most of it faces beside sound surface of the part.
/// `nearest` has the distance of each corner and the nearest place of the part.
pub(super) fn turned_out(mesh: &mut Mesh, part: &Surface, nearest: &[(f64, DVec3)], tolerance: f64) {
    let shells = joined(&mesh.triangles, mesh.vertices.len());
    let is_sound = |face: &[u32; 3]| face.iter().all(|corner| nearest[*corner as usize].0.abs() <= tolerance);
    let mut sound: BTreeMap<u32, Vec<Face>> = BTreeMap::new();
    let mut ways: BTreeMap<u32, f64> = BTreeMap::new();
    for (corners, shell) in mesh.triangles.iter().zip(&shells) {
        let face = corners.map(|corner| mesh.vertices[corner as usize]);
        if is_sound(corners) {
            sound.entry(*shell).or_default().push(face);
        }
        let way = corners.iter().map(|corner| nearest[*corner as usize].1).sum::<DVec3>() / 3.0 - middle(&face);
        *ways.entry(*shell).or_default() += vector(&face).dot(way);
    }
    for (shell, faces) in sound {
        let asked = faces.iter().step_by(faces.len().div_ceil(ASKED));
        let outwards = |face: &Face| {
            let (at, by) = (middle(face), vector(face).normalize_or_zero() * (2.0 * tolerance));
            vector(face).length() * (part.nearest(at + by).0 - part.nearest(at - by).0)
        };
        ways.insert(shell, asked.map(outwards).sum());
    }
    for (corners, shell) in mesh.triangles.iter_mut().zip(&shells) {
        if ways.get(shell).is_some_and(|way| *way < 0.0) {
            corners.swap(1, 2);
        }
    }
}

/// Edges that only one face has.
pub(super) fn open_edges(mesh: &Mesh) -> Vec<[u32; 2]> {
    let edges = |[a, b, c]: &[u32; 3]| [[*a, *b], [*b, *c], [*c, *a]].map(|[a, b]| [a.min(b), a.max(b)]);
    let mut all: Vec<[u32; 2]> = mesh.triangles.iter().flat_map(edges).collect();
    all.par_sort_unstable();
    all.chunk_by(|a, b| a == b).filter(|same| same.len() == 1).map(|same| same[0]).collect()
}

/// What a scan says about a place on the part's surface.
#[derive(Clone, Copy)]
enum Shown {
    /// It is there, or has metal over it.
    Sound,
    /// It is missing, and the scan is so far away, mm.
    Missing(f64),
    Nothing,
}

/// A scan, whose faces face out of the metal.
pub(super) struct Scan {
    surface: Surface,
    ends: RTree<Line<[f64; 3]>>,
}

/// The pieces of a part's surface that a scan lacks.
pub(super) struct Lacking {
    pub(super) pieces: Mesh,
    /// Those that are missing, and how far the scan is from them, mm.
    pub(super) missing: Vec<(usize, f64)>,
    /// Those about which the scan says nothing, where they are larger than a bead is wide; the largest first.
    pub(super) unseen: Vec<Stretch>,
}

impl Scan {
    /// `None` if no face has an area.
    pub(super) fn of(mesh: &Mesh, open: &[[u32; 2]]) -> Option<Self> {
        let at = |corner: u32| mesh.vertices[corner as usize].to_array();
        let ends = open.iter().map(|[a, b]| Line::new(at(*a), at(*b))).collect();
        Some(Self { surface: Surface::of(mesh)?, ends: RTree::bulk_load(ends) })
    }

    fn shown(&self, part: &Surface, p: DVec3, tolerance: f64) -> Shown {
        let (distance, spot) = self.surface.nearest(p);
        let at = spot.to_array();
        let has_ended = || self.ends.nearest_neighbor(&at).is_some_and(|end| end.distance_2(&at) < ON_EDGE * ON_EDGE);
        match distance {
            _ if distance.abs() <= tolerance => Shown::Sound,
            _ if has_ended() => Shown::Nothing,
            _ if distance > 0.0 => Shown::Missing(distance),
            _ if part.nearest(spot).0 > 0.0 => Shown::Sound,
            _ => Shown::Nothing,
        }
    }

    /// What the scan lacks of a part that is divided into pieces.
    ///
    /// # Errors
    /// [`Cancelled`].
    pub(super) fn lacking(
        &self,
        part: &Surface,
        pieces: Mesh,
        settings: Settings,
        task: &Task,
    ) -> Result<Lacking, Cancelled> {
        let face = |k: usize| pieces.triangles[k].map(|corner| pieces.vertices[corner as usize]);
        let numbers: Vec<usize> = (0..pieces.triangles.len()).collect();
        let mut shown = Vec::with_capacity(numbers.len());
        for batch in numbers.chunks(BATCH) {
            task.check()?;
            shown.par_extend(batch.par_iter().map(|k| self.shown(part, middle(&face(*k)), settings.tolerance)));
        }
        let (mut missing, mut dark) = (Vec::new(), Vec::new());
        for (k, shown) in shown.into_iter().enumerate() {
            match shown {
                Shown::Sound => {}
                Shown::Missing(distance) => missing.push((k, distance)),
                Shown::Nothing => dark.push(k),
            }
        }
        let corners: Vec<[u32; 3]> = dark.iter().map(|k| pieces.triangles[*k]).collect();
        let mut places: BTreeMap<u32, Vec<Face>> = BTreeMap::new();
        for (k, place) in dark.iter().zip(joined(&corners, pieces.vertices.len())) {
            places.entry(place).or_default().push(face(*k));
        }
        let unseen = places.values().filter_map(|faces| Stretch::of(faces));
        let mut unseen: Vec<Stretch> = unseen.filter(|place| place.area > settings.bead * settings.bead).collect();
        unseen.sort_by(|a, b| b.area.total_cmp(&a.area));
        Ok(Lacking { pieces, missing, unseen })
    }
}
