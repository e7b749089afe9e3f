//! Cladding: metal of an even thickness over the surface of a part that is there, and the chart in which its layers follow it.

use crate::chart::warp::{self, WarpError};
use crate::chart::{Chart, Cylinder, Side, Surface, SurfaceError};
use crate::model::Mesh;
use crate::model::solid::Solid;
use crate::task::Task;
use glam::{DQuat, DVec2, DVec3};
use planar::{FillRule, Region, Ring};
use std::f64::consts::PI;
use std::sync::Arc;

/// Metal to be laid, and how its layers lie.
#[derive(Debug, Clone, PartialEq)]
pub struct Cladding {
    /// Closed, in the coordinates of the base, mm.
    pub mesh: Mesh,
    /// Layers over the surface of the base, or around its axis.
    pub chart: Chart,
}

/// Why nothing can be clad.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum CladdingError {
    /// The heights of the base.
    #[error(transparent)]
    Surface(#[from] SurfaceError),
    /// Stopped by the caller, or too steep.
    #[error(transparent)]
    Warp(#[from] WarpError),
    /// The area and what is seen of the base lie apart.
    #[error(
        "nothing of the base that is less steep than 17.7° lies within the area. Outlines lie in x and y of the base as it stands on the table."
    )]
    NoArea,
    /// Nothing of the base lies on the cylinder.
    #[error("nothing of the base lies {radius} mm from the axis, facing {facing}")]
    NotRound {
        /// mm
        radius: f64,
        /// Where its faces would point.
        facing: &'static str,
    },
    /// The cylinder is interrupted, by flanges for example.
    #[error(
        "the face has gaps along the axis: it reaches {}. Clad one of these after another",
        .stretches.iter().map(|[from, to]| format!("from {from:.1} to {to:.1} mm")).collect::<Vec<_>>().join(", ")
    )]
    Gaps {
        /// Where it begins and ends along the axis, mm.
        stretches: Vec<[f64; 2]>,
    },
}

/// Faces steeper than this are not clad from above: the cosine of 17.7°, on which beads lie 5 % farther apart.
const STEEPEST: f64 = 1.0 / 1.05;
/// Faces belong to what is seen from above if they lie no deeper under the surface than this part of its grid.
const SEEN: f64 = 1.0;
/// Chord tolerance of the mesh, mm.
const TOLERANCE: f64 = 0.02;
/// Faces lie on a cylinder if their corners are this near to it, in parts of its radius.
const ROUND: f64 = 0.01;
/// Pieces of a circle.
const SEGMENTS: u32 = 360;

/// Cladding over what is seen of a base along `up`, of the given thickness along `up`, mm: over all of it that is not too steep, or
/// over that part of it that lies within `area`, mm, seen along `up`. The surface is measured on a grid of `step`, mm.
///
/// # Errors
/// [`CladdingError`].
pub fn over(
    base: &Mesh,
    up: DVec3,
    step: f64,
    area: Option<&Region>,
    thickness: f64,
    task: &Task,
) -> Result<Cladding, CladdingError> {
    let surface = Arc::new(Surface::of_mesh(base, up, step)?.rounded());
    let chart = Chart::Surface(Arc::clone(&surface));
    let seen = seen(base, up, step, &chart);
    let region = match area {
        Some(area) => seen.intersection(area),
        None => seen,
    };
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    for polygon in region.simplified(TOLERANCE).polygons().iter().filter(|polygon| polygon.area() > step * step) {
        let first = vertices.len() as u32;
        let flat = Solid::extrude(polygon, 0.0, thickness);
        let (flat, _) = Mesh::from_triangles(flat.vertices, flat.triangles);
        let bent = warp::bent(&surface, &flat, TOLERANCE, task)?;
        vertices.extend(bent.vertices);
        triangles.extend(bent.triangles.iter().map(|corners| corners.map(|corner| corner + first)));
    }
    if triangles.is_empty() {
        return Err(CladdingError::NoArea);
    }
    Ok(Cladding { mesh: Mesh::from_triangles(vertices, triangles).0, chart })
}

/// What is seen of a base over its surface and is not too steep, as (u, v) of the surface.
fn seen(base: &Mesh, up: DVec3, step: f64, chart: &Chart) -> Region {
    let is_seen = |corners: &[DVec3; 3]| {
        let [a, b, c] = corners.map(|corner| chart.coordinates(corner));
        let level = [a, b, c].iter().all(|p| p.z.abs() <= SEEN * step);
        let [a, b, c] = *corners;
        level && (b - a).cross(c - a).normalize_or_zero().dot(up) >= STEEPEST
    };
    let triangles = base.triangles.iter().map(|corners| corners.map(|corner| base.vertices[corner as usize]));
    let flat = |corners: [DVec3; 3]| Ring::new(corners.map(|p| chart.coordinates(p).truncate()).to_vec());
    let rings: Vec<Ring> = triangles.filter(is_seen).map(flat).collect();
    Region::from_rings(&rings, FillRule::NonZero)
}

/// Cladding around an axis, of the given thickness, mm, on the faces of a base that lie on the cylinder: as far along the axis as
/// they reach, or only between two places along it, mm from the point `through`.
///
/// # Errors
/// [`CladdingError::NotRound`], [`CladdingError::Gaps`].
pub fn around(
    base: &Mesh,
    cylinder: Cylinder,
    between: [Option<f64>; 2],
    thickness: f64,
) -> Result<Cladding, CladdingError> {
    let Cylinder { axis, through, radius, side, .. } = cylinder;
    let out = |p: DVec3| (p - through).reject_from_normalized(axis);
    let sign = if side == Side::Outer { 1.0 } else { -1.0 };
    // A face closes the gap to one that begins no farther than this behind it.
    let together = |mut spans: Vec<[f64; 2]>| {
        spans.sort_by(|a, b| a[0].total_cmp(&b[0]));
        spans.into_iter().fold(Vec::new(), |mut all: Vec<[f64; 2]>, span| {
            match all.last_mut() {
                Some(last) if span[0] <= last[1] + TOLERANCE => last[1] = last[1].max(span[1]),
                _ => all.push(span),
            }
            all
        })
    };
    let is_on_it = |corners: &[DVec3; 3]| {
        let [a, b, c] = *corners;
        let faces = (b - a).cross(c - a).dot(out((a + b + c) / 3.0)) * sign > 0.0;
        faces && corners.iter().all(|p| (out(*p).length() - radius).abs() <= ROUND * radius)
    };
    let triangles = base.triangles.iter().map(|corners| corners.map(|corner| base.vertices[corner as usize]));
    let along = triangles.filter(is_on_it).map(|corners| corners.map(|p| axis.dot(p - through)));
    let spans = along.map(|at| [at[0].min(at[1]).min(at[2]), at[0].max(at[1]).max(at[2])]);
    let [from, to] = [between[0].unwrap_or(f64::MIN), between[1].unwrap_or(f64::MAX)];
    let within = together(spans.collect()).into_iter().map(|[low, high]| [low.max(from), high.min(to)]);
    let stretches: Vec<[f64; 2]> = within.filter(|[low, high]| high - low > TOLERANCE).collect();
    let [low, high] = match stretches[..] {
        [one] => one,
        [] => {
            let facing = if side == Side::Outer { "outwards" } else { "inwards" };
            return Err(CladdingError::NotRound { radius, facing });
        }
        _ => return Err(CladdingError::Gaps { stretches }),
    };
    // Circles of chords lie inside: these are as far out at the middle of each chord.
    let [near, far] = [radius, radius + sign * thickness].map(|radius| radius / (PI / f64::from(SEGMENTS)).cos());
    let section = [[near, low], [far, low], [far, high], [near, high]].map(DVec2::from_array);
    let Solid { vertices, triangles } = Solid::revolve(&section, SEGMENTS);
    let turn = DQuat::from_rotation_arc(DVec3::Z, axis);
    let vertices = vertices.into_iter().map(|p| turn * p + through).collect();
    Ok(Cladding { mesh: Mesh::from_triangles(vertices, triangles).0, chart: Chart::Cylinder(cylinder) })
}
