//! Where a scan lies inside the part.

use super::{DamageError, Settings};
use crate::chart::warp;
use crate::deviation::Surface;
use crate::model::Mesh;
use crate::task::{Cancelled, Task};
use glam::DVec3;
use rayon::prelude::*;
use std::collections::BTreeMap;

/// A place where metal is missing.
pub(super) struct Found {
    /// Corners of the scan's faces there, mm.
    pub(super) points: Vec<DVec3>,
    /// The direction in which it is open.
    pub(super) open: DVec3,
    /// Its deepest place, mm.
    pub(super) place: DVec3,
    /// How far that lies inside the part, mm.
    pub(super) depth: f64,
    /// Sum of the scan's faces there as vectors, mm²: where its rim is flat, it points out of it.
    faces: DVec3,
    /// Sum of the ways to the part's surface, mm³.
    ways: DVec3,
    area: f64,
}

/// Points between two looks at whether the task was cancelled.
const BATCH: usize = 50_000;
/// Faces are looked at in pieces of this many steps of the grid.
const PIECE: f64 = 2.0;
/// Directions this close to an axis are along it: the cosine of 5°. Scans are never exactly level.
const ALONG: f64 = 0.9962;
/// Scan and part lie apart if half of the scan lies farther off than this part of the part's size.
const APART: f64 = 0.1;

/// All places where metal is missing.
///
/// # Errors
/// [`DamageError::Apart`], [`DamageError::Cancelled`].
pub(super) fn all(
    surface: &Surface,
    part: &Mesh,
    scan: &Mesh,
    settings: Settings,
    task: &Task,
) -> Result<Vec<Found>, DamageError> {
    let mut far: Vec<f64> =
        nearest(surface, &scan.vertices, task)?.iter().map(|(distance, _)| distance.abs()).collect();
    let middle = far.len() / 2;
    let half = *far.select_nth_unstable_by(middle, f64::total_cmp).1;
    if half > APART * part.size().length() {
        return Err(DamageError::Apart(half));
    }
    let (low, high) = part.bounds();
    let is_within = |a: DVec3, b: DVec3| a.min(b).cmple(high).all() && a.max(b).cmpge(low).all();
    let fine = warp::divided_where(scan, PIECE * settings.step, task, is_within).map_err(super::cancelled)?;
    let nearest = nearest(surface, &fine.vertices, task)?;
    let deep = |corner: &u32| nearest[*corner as usize].0 < -settings.tolerance;
    let faces: Vec<[u32; 3]> = fine.triangles.iter().copied().filter(|face| face.iter().all(deep)).collect();
    let mut places: BTreeMap<u32, Found> = BTreeMap::new();
    for (face, place) in faces.iter().zip(joined(&faces, fine.vertices.len())) {
        let one = Found::face(face.map(|corner| (fine.vertices[corner as usize], nearest[corner as usize])));
        match places.get_mut(&place) {
            Some(found) => found.take(one),
            None => drop(places.insert(place, one)),
        }
    }
    // Roughness of the scan is no damage.
    let places = places.into_values().filter(|found| found.area > settings.bead * settings.bead / 4.0);
    Ok(places.map(Found::opened).collect())
}

/// For each point the distance from a surface, negative inside, mm, and the nearest point of it.
fn nearest(surface: &Surface, points: &[DVec3], task: &Task) -> Result<Vec<(f64, DVec3)>, Cancelled> {
    let mut nearest = Vec::with_capacity(points.len());
    for batch in points.chunks(BATCH) {
        task.check()?;
        nearest.par_extend(batch.par_iter().map(|point| surface.nearest(*point)));
    }
    Ok(nearest)
}

/// The number of the place to which each face belongs: faces that share a corner belong to one.
fn joined(faces: &[[u32; 3]], corners: usize) -> Vec<u32> {
    let mut parents: Vec<u32> = (0..corners as u32).collect();
    fn root(parents: &mut [u32], mut corner: u32) -> u32 {
        while parents[corner as usize] != corner {
            parents[corner as usize] = parents[parents[corner as usize] as usize];
            corner = parents[corner as usize];
        }
        corner
    }
    for &[a, b, c] in faces {
        let first = root(&mut parents, a);
        for other in [b, c] {
            let other = root(&mut parents, other);
            parents[other as usize] = first.min(other);
            parents[first as usize] = first.min(other);
        }
    }
    faces.iter().map(|face| root(&mut parents, face[0])).collect()
}

impl Found {
    /// One face, by its corners with their distances and the nearest places of the part.
    fn face(corners: [(DVec3, (f64, DVec3)); 3]) -> Self {
        let [a, b, c] = corners.map(|(corner, _)| corner);
        let faces = 0.5 * (b - a).cross(c - a);
        let area = faces.length();
        let ways = corners.iter().map(|(corner, (_, spot))| *spot - *corner).sum::<DVec3>() * (area / 3.0);
        let deepest = corners.into_iter().min_by(|a, b| a.1.0.total_cmp(&b.1.0));
        let (place, depth) = deepest.map_or((a, 0.0), |(corner, (distance, _))| (corner, -distance));
        Self { points: vec![a, b, c], open: DVec3::Z, place, depth, faces, ways, area }
    }

    fn take(&mut self, other: Self) {
        self.points.extend(other.points);
        self.faces += other.faces;
        self.ways += other.ways;
        self.area += other.area;
        if other.depth > self.depth {
            (self.place, self.depth) = (other.place, other.depth);
        }
    }

    /// Two places as one.
    pub(super) fn and(mut self, other: Self) -> Self {
        self.take(other);
        self.opened()
    }

    /// With its direction: out of its rim; the faces of a scan may point inwards.
    fn opened(self) -> Self {
        let out = if self.faces.dot(self.ways) < 0.0 { -self.faces } else { self.faces };
        let out = out.try_normalize().unwrap_or(DVec3::Z);
        let axes = [DVec3::X, DVec3::Y, DVec3::Z].into_iter().flat_map(|axis| [axis, -axis]);
        Self { open: axes.into_iter().find(|axis| axis.dot(out) >= ALONG).unwrap_or(out), ..self }
    }
}
