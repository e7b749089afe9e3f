//! Where a scan lies inside the part.

use super::groove::RIM;
use super::mouth::{self, Face, Lacking, Scan, Stretch, nearest};
use super::{DamageError, Settings, cancelled};
use crate::chart::warp;
use crate::deviation::Surface;
use crate::model::Mesh;
use crate::model::connected::joined;
use crate::model::triangle::Triangle;
use crate::task::Task;
use glam::DVec3;
use rayon::prelude::*;
use rstar::primitives::GeomWithData;
use rstar::{PointDistance, RTree};
use std::collections::{BTreeMap, BTreeSet};

/// A place where metal is missing.
#[derive(Default)]
pub(super) struct Found {
    /// The scan's faces there, out of the metal, mm.
    pub(super) faces: Vec<Face>,
    /// The part's faces there that are missing, mm.
    pub(super) mouth: Vec<Face>,
    /// The part's faces beside those, mm.
    rim: Vec<Face>,
    /// The direction in which it is open.
    pub(super) open: DVec3,
    /// Its middle, on the part's surface, mm.
    pub(super) place: DVec3,
    /// How far the scan lies under its mouth, mm.
    pub(super) depth: f64,
    /// How long the edges are, mm, at which the scan ends inside the part there.
    pub(super) ends: f64,
}

/// What a scan says about a part.
pub(super) struct Known {
    pub(super) places: Vec<Found>,
    /// Stretches of the part's surface about which the scan says nothing, the largest first.
    pub(super) unseen: Vec<Stretch>,
}

/// Faces are looked at in pieces of this many steps of the grid, and the part's faces beside damage in pieces of one.
const PIECE: f64 = 2.0;
/// The same as fractions of a bead, at most, so that what is known of damage does not depend on a coarse grid.
const FINE: f64 = 0.5;
const BESIDE: f64 = 1.0 / 3.0;
/// Directions this close to an axis are along it: the cosine of 5°. Scans are never exactly level.
const ALONG: f64 = 0.9962;
/// Scan and part lie apart if half of the scan lies farther off than this part of the part's size.
const APART: f64 = 0.1;

/// What a scan says about a part.
///
/// # Errors
/// [`DamageError::Apart`], [`DamageError::Cancelled`].
pub(super) fn all(
    surface: &Surface,
    part: &Mesh,
    scan: &Mesh,
    settings: Settings,
    task: &Task,
) -> Result<Known, DamageError> {
    let mut far: Vec<f64> =
        nearest(surface, &scan.vertices, task)?.iter().map(|(distance, _)| distance.abs()).collect();
    let middle = far.len() / 2;
    let half = *far.select_nth_unstable_by(middle, f64::total_cmp).1;
    if half > APART * part.size().length() {
        return Err(DamageError::Apart(half));
    }
    let (low, high) = part.bounds();
    let (low, high) = (low - RIM * settings.step, high + RIM * settings.step);
    let is_within = |a: DVec3, b: DVec3| a.min(b).cmple(high).all() && a.max(b).cmpge(low).all();
    let mut fine = warp::divided_where(scan, piece(settings), task, is_within).map_err(cancelled)?;
    let nearest = nearest(surface, &fine.vertices, task)?;
    mouth::turned_out(&mut fine, surface, &nearest, settings.tolerance);
    let open = mouth::open_edges(&fine);
    let mut places = deep(&fine, &nearest, &open, settings);
    let Some(shown) = Scan::of(&fine, &open) else { return Err(DamageError::NoFaces) };
    let pieces = pieces(part, &places, settings, task)?;
    let lacking = shown.lacking(surface, pieces, settings, task)?;
    share(&lacking, &mut places, settings);
    let places = places.into_iter().map(|found| found.opened(surface)).collect();
    Ok(Known { places, unseen: lacking.unseen })
}

fn piece(settings: Settings) -> f64 {
    (PIECE * settings.step).min(FINE * settings.bead)
}

/// The places where the scan lies deeper inside the part than the tolerance.
fn deep(fine: &Mesh, nearest: &[(f64, DVec3)], open: &[[u32; 2]], settings: Settings) -> Vec<Found> {
    let is_deep = |corner: &u32| nearest[*corner as usize].0 < -settings.tolerance;
    let at = |corner: u32| fine.vertices[corner as usize];
    let faces: Vec<[u32; 3]> = fine.triangles.iter().copied().filter(|face| face.iter().all(is_deep)).collect();
    let mut places: BTreeMap<u32, Found> = BTreeMap::new();
    let mut place_of: BTreeMap<u32, u32> = BTreeMap::new();
    for (corners, place) in faces.iter().zip(joined(&faces, fine.vertices.len())) {
        let found = places.entry(place).or_default();
        found.faces.push(corners.map(at));
        corners.iter().for_each(|corner| {
            found.depth = found.depth.max(-nearest[*corner as usize].0);
            place_of.insert(*corner, place);
        });
    }
    for [a, b] in open.iter().filter(|edge| edge.iter().all(is_deep)) {
        if let Some(found) = place_of.get(a).and_then(|place| places.get_mut(place)) {
            found.ends += at(*a).distance(at(*b));
        }
    }
    // Roughness of the scan is no damage.
    places.into_values().filter(|found| found.area() > settings.bead * settings.bead / 4.0).collect()
}

/// The part's surface in pieces that are finer beside damage.
fn pieces(part: &Mesh, places: &[Found], settings: Settings, task: &Task) -> Result<Mesh, DamageError> {
    let coarse = warp::divided(part, piece(settings), task).map_err(cancelled)?;
    let around = (1.0 + RIM) * piece(settings) + settings.tolerance;
    let corners = |found: &Found| {
        let (low, high) = Mesh { vertices: found.points().copied().collect(), ..Mesh::default() }.bounds();
        [low - around - found.depth, high + around + found.depth]
    };
    let boxes: Vec<[DVec3; 2]> = places.iter().map(corners).collect();
    let is_beside =
        |a: DVec3, b: DVec3| boxes.iter().any(|[low, high]| a.min(b).cmple(*high).all() && a.max(b).cmpge(*low).all());
    warp::divided_where(&coarse, settings.step.min(BESIDE * settings.bead), task, is_beside).map_err(cancelled)
}

/// Gives each place the part's faces that are missing there, and those beside them.
fn share(lacking: &Lacking, places: &mut [Found], settings: Settings) {
    let Lacking { pieces, missing, .. } = lacking;
    let face = |k: usize| pieces.triangles[k].map(|corner| pieces.vertices[corner as usize]);
    let deep = places.iter().enumerate();
    let deep = deep.flat_map(|(k, found)| found.faces.iter().map(move |corners| (k, *corners)));
    let deep: Vec<_> = deep.map(|(k, corners)| GeomWithData::new(Triangle { corners }, k)).collect();
    let deep = RTree::bulk_load(deep);
    // Beside deep places the scan is not so deep: from there the way to a deep place is longer by no more than this.
    let beside = PIECE * piece(settings) + settings.tolerance;
    let place = |(k, distance): &(usize, f64)| {
        let middle = mouth::middle(&face(*k)).to_array();
        let nearest = deep.nearest_neighbor(&middle)?;
        (nearest.distance_2(&middle).sqrt() <= distance + beside).then_some((*k, nearest.data))
    };
    let shared: Vec<(usize, usize)> = missing.par_iter().filter_map(place).collect();
    let mut corners: BTreeMap<u32, usize> = BTreeMap::new();
    for (k, place) in &shared {
        places[*place].mouth.push(face(*k));
        corners.extend(pieces.triangles[*k].map(|corner| (corner, *place)));
    }
    let known: BTreeSet<usize> = missing.iter().map(|(k, _)| *k).collect();
    for (k, triangle) in pieces.triangles.iter().enumerate().filter(|(k, _)| !known.contains(k)) {
        if let Some(place) = triangle.iter().find_map(|corner| corners.get(corner)) {
            places[*place].rim.push(face(k));
        }
    }
    // A stray piece is no mouth.
    let least = settings.tolerance * settings.tolerance;
    for found in places {
        if found.mouth_area() < least {
            found.mouth.clear();
            found.rim.clear();
        }
    }
}

impl Found {
    /// Corners of the scan's faces, mm.
    pub(super) fn points(&self) -> impl Iterator<Item = &DVec3> {
        self.faces.iter().flatten()
    }

    /// Corners of the faces of scan and part, mm.
    pub(super) fn corners(&self) -> impl Iterator<Item = &DVec3> {
        self.points().chain(self.mouth.iter().flatten())
    }

    fn area(&self) -> f64 {
        self.faces.iter().map(|face| mouth::vector(face).length()).sum()
    }

    /// What is missing of the part by the faces of scan and part alone, without a grid, mm³: what lies under the mouth along a direction,
    /// less what lies under the scan.
    pub(super) fn missing(&self, up: DVec3) -> f64 {
        let under = |faces: &[Face], from: f64| {
            faces.iter().map(|face| (mouth::middle(face).dot(up) - from) * mouth::vector(face).dot(up)).sum::<f64>()
        };
        let from = self.place.dot(up);
        under(&self.mouth, from) - under(&self.faces, from)
    }

    /// The area of its mouth, mm².
    pub(super) fn mouth_area(&self) -> f64 {
        self.mouth.iter().map(|face| mouth::vector(face).length()).sum()
    }

    /// Two places as one.
    pub(super) fn and(mut self, other: Self, surface: &Surface) -> Self {
        self.faces.extend(other.faces);
        self.mouth.extend(other.mouth);
        self.rim.extend(other.rim);
        self.depth = self.depth.max(other.depth);
        self.ends += other.ends;
        self.opened(surface)
    }

    /// With its direction, its middle and its depth, by its mouth; without a mouth, by the scan's faces and the part's nearest places.
    fn opened(self, surface: &Surface) -> Self {
        let out = mouth::direction(&self.mouth).or_else(|| mouth::direction(&self.faces)).unwrap_or(DVec3::Z);
        let axes = [DVec3::X, DVec3::Y, DVec3::Z].into_iter().flat_map(|axis| [axis, -axis]);
        let open = axes.into_iter().find(|axis| axis.dot(out) >= ALONG).unwrap_or(out);
        let middle = |faces: &[Face]| Stretch::of(faces).map(|stretch| stretch.place);
        let under = || middle(&self.faces).map(|place| surface.nearest(place).1);
        let place = middle(&self.mouth).or_else(under).unwrap_or_default();
        let depth = self.under_mouth().unwrap_or(self.depth);
        Self { open, place, depth, ..self }
    }

    /// How far the scan lies under the mouth, mm.
    fn under_mouth(&self) -> Option<f64> {
        let triangles = self.mouth.iter().chain(&self.rim).map(|corners| Triangle { corners: *corners });
        let mouth = RTree::bulk_load(triangles.collect());
        let far = |p: &DVec3| mouth.nearest_neighbor(&p.to_array()).map(|face| face.closest(*p).distance(*p));
        self.faces.par_iter().flatten().filter_map(far).max_by(f64::total_cmp)
    }
}
