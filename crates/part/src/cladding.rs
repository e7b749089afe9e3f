//! Cladding: metal of an even thickness over the surface of a part that is there, and the chart in which its layers follow it.

use crate::chart::warp::{self, WarpError};
use crate::chart::{Chart, Cylinder, Side, Surface, SurfaceError};
use crate::model::Mesh;
use crate::model::solid::Solid;
use crate::task::Task;
use glam::{DQuat, DVec2, DVec3};
use planar::{FillRule, Join, Region, Ring};
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

/// Metal to be laid, and how its layers lie.
#[derive(Debug, Clone, PartialEq)]
pub struct Cladding {
    /// Closed, in the coordinates of the base, mm.
    pub mesh: Mesh,
    /// Layers over the surface of the base, or around its axis.
    pub chart: Chart,
    /// What is left out because it is too steep, hidden, or not there, mm²: seen along the direction of the surface, or around the axis.
    pub bare: f64,
}

/// Why nothing can be clad.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum CladdingError {
    /// The heights of the base.
    #[error(transparent)]
    Surface(#[from] SurfaceError),
    /// The caller stopped it, or the surface is too steep.
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
    /// Nothing of the cylinder lies where it is to be clad.
    #[error("the face reaches {}, and nothing of it lies between the two places asked for", words(.stretches))]
    Beside {
        /// Where it begins and ends along the axis, mm.
        stretches: Vec<[f64; 2]>,
    },
    /// A bore narrower than its cladding.
    #[error("a bore of {radius} mm radius has no room for {thickness} mm of cladding")]
    Narrow {
        /// mm
        radius: f64,
        /// mm
        thickness: f64,
    },
    /// The cylinder is interrupted, by flanges for example.
    #[error("the face has gaps along the axis: it reaches {}. Clad them one at a time", words(.stretches))]
    Gaps {
        /// Where it begins and ends along the axis, mm.
        stretches: Vec<[f64; 2]>,
    },
}

fn words(stretches: &[[f64; 2]]) -> String {
    stretches.iter().map(|[from, to]| format!("from {from:.1} to {to:.1} mm")).collect::<Vec<_>>().join(", ")
}

/// Where beads would lie farther apart than by this factor, nothing is clad: steeper than 17.7°.
const STEEPEST: f64 = 1.05;
/// Faces that look up: the cosine of their steepest slope, 45°. Scans are rougher than what was scanned.
const FACING: f64 = 0.7;
/// Faces are seen if they lie no deeper under the surface than this part of its grid.
const SEEN: f64 = 1.0;
/// Faces are looked at in pieces of this many steps of the grid.
const PIECE: f64 = 2.0;
/// Around an area heights are measured for this many steps of the grid.
const BESIDE: f64 = 1.5;
/// Chord tolerance of the mesh, mm.
const TOLERANCE: f64 = 0.02;
/// Faces lie on a cylinder if their corners are this near to it, in parts of its radius and mm.
const ROUND: f64 = 0.01;
const AWAY: f64 = 0.5;
/// This part of a cylinder may be missing before it counts: chords are shorter than their arcs.
const WHOLE: f64 = 0.01;
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
    // First as it is seen, then only what can be clad: what falls away beside it does not pull its edges down.
    let near = area.map(|area| area.offset(BESIDE * step, Join::ROUND));
    let kept = |p: DVec2| near.as_ref().is_none_or(|near| near.contains(p));
    let facing = faces(base, |corners| normal(corners).dot(up) >= FACING);
    let facing = warp::divided(&facing, PIECE * step, task)?;
    let whole = Surface::of_faces(&facing, up, step, kept).map_err(|error| match error {
        SurfaceError::Nothing => CladdingError::NoArea,
        other => other.into(),
    })?;
    let chart = Chart::Surface(Arc::new(whole.clone()));
    let level = faces(&facing, |corners| {
        let middle = chart.coordinates(corners.iter().sum::<DVec3>() / 3.0);
        let seen = middle.z >= -SEEN * step && kept(middle.truncate());
        seen && (whole.stretch(middle.truncate()) <= STEEPEST || normal(corners).dot(up) >= 1.0 / STEEPEST)
    });
    if level.triangles.is_empty() {
        return Err(CladdingError::NoArea);
    }
    task.check().map_err(WarpError::from)?;
    let surface = Arc::new(Surface::of_faces(&level, up, step, kept)?.rounded());
    let chart = Chart::Surface(Arc::clone(&surface));
    let region = match area {
        Some(area) => shadow(&level, &chart).intersection(area),
        None => shadow(&level, &chart),
    };
    warp::check_slope(&surface, &places(&region, step / 2.0))?;
    let (mut vertices, mut triangles, mut covered) = (Vec::new(), Vec::new(), 0.0);
    for polygon in region.simplified(TOLERANCE).polygons().iter().filter(|polygon| polygon.area() > step * step) {
        let first = vertices.len() as u32;
        let flat = Solid::extrude(polygon, 0.0, thickness);
        let (flat, _) = Mesh::from_triangles(flat.vertices, flat.triangles);
        let bent = warp::bent(&surface, &flat, TOLERANCE, task)?;
        vertices.extend(bent.vertices);
        triangles.extend(bent.triangles.iter().map(|corners| corners.map(|corner| corner + first)));
        covered += polygon.area();
    }
    if triangles.is_empty() {
        return Err(CladdingError::NoArea);
    }
    let all = match area {
        Some(area) => area.area(),
        None => shadow(&facing, &chart).area(),
    };
    let bare = (all - covered).max(0.0);
    Ok(Cladding { mesh: Mesh::from_triangles(vertices, triangles).0, chart, bare })
}

/// Places of a region on a grid, mm.
fn places(region: &Region, step: f64) -> Vec<DVec3> {
    let Some(bounds) = region.bounds() else { return Vec::new() };
    let counts = (bounds.size() / step).ceil();
    let at = |i: usize, j: usize| bounds.min + DVec2::new(i as f64 + 0.5, j as f64 + 0.5) * step;
    let rows = (0..counts.y as usize).flat_map(|j| (0..counts.x as usize).map(move |i| at(i, j)));
    rows.filter(|p| region.contains(*p)).map(|p| p.extend(0.0)).collect()
}

fn normal([a, b, c]: &[DVec3; 3]) -> DVec3 {
    (b - a).cross(c - a).normalize_or_zero()
}

/// A mesh with some of the faces.
fn faces(mesh: &Mesh, kept: impl Fn(&[DVec3; 3]) -> bool) -> Mesh {
    let corners = |triangle: &[u32; 3]| triangle.map(|corner| mesh.vertices[corner as usize]);
    let triangles = mesh.triangles.iter().copied().filter(|triangle| kept(&corners(triangle))).collect();
    Mesh { vertices: mesh.vertices.clone(), triangles, ..Mesh::default() }
}

/// What lies under or over faces that look up, as (u, v) of a surface.
fn shadow(mesh: &Mesh, chart: &Chart) -> Region {
    let flat: Vec<DVec2> = mesh.vertices.iter().map(|p| chart.coordinates(*p).truncate()).collect();
    let ring = |triangle: &[u32; 3]| Ring::new(triangle.map(|corner| flat[corner as usize]).to_vec());
    Region::from_rings(&mesh.triangles.iter().map(ring).collect::<Vec<_>>(), FillRule::NonZero)
}

/// Cladding around an axis, of the given thickness, mm, on the faces of a base that lie on the cylinder: as far along the axis as
/// they reach, or only between two places along it, mm from the point `through`.
///
/// # Errors
/// [`CladdingError`], of a cylinder.
pub fn around(
    base: &Mesh,
    cylinder: Cylinder,
    between: [Option<f64>; 2],
    thickness: f64,
) -> Result<Cladding, CladdingError> {
    let Cylinder { axis, through, radius, side, .. } = cylinder;
    if side == Side::Inner && thickness >= radius {
        return Err(CladdingError::Narrow { radius, thickness });
    }
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
        faces && corners.iter().all(|p| (out(*p).length() - radius).abs() <= (ROUND * radius).min(AWAY))
    };
    let triangles = base.triangles.iter().map(|corners| corners.map(|corner| base.vertices[corner as usize]));
    let round: Vec<[DVec3; 3]> = triangles.filter(is_on_it).collect();
    let along = round.iter().map(|corners| corners.map(|p| axis.dot(p - through)));
    let spans = along.map(|at| [at[0].min(at[1]).min(at[2]), at[0].max(at[1]).max(at[2])]);
    let [from, to] = [between[0].unwrap_or(f64::MIN), between[1].unwrap_or(f64::MAX)];
    let whole = together(spans.collect());
    let within = whole.iter().map(|[low, high]| [low.max(from), high.min(to)]);
    let stretches: Vec<[f64; 2]> = within.filter(|[low, high]| high - low > TOLERANCE).collect();
    let facing = if side == Side::Outer { "outwards" } else { "inwards" };
    let [low, high] = match stretches[..] {
        [one] => one,
        [] if whole.is_empty() => return Err(CladdingError::NotRound { radius, facing }),
        [] => return Err(CladdingError::Beside { stretches: whole }),
        _ => return Err(CladdingError::Gaps { stretches }),
    };
    // Circles of chords lie inside: these are as far out at the middle of each chord.
    let [near, far] = [radius, radius + sign * thickness].map(|radius| radius / (PI / f64::from(SEGMENTS)).cos());
    let section = [[near, low], [far, low], [far, high], [near, high]].map(DVec2::from_array);
    let Solid { vertices, triangles } = Solid::revolve(&section, SEGMENTS);
    let turn = DQuat::from_rotation_arc(DVec3::Z, axis);
    let vertices = vertices.into_iter().map(|p| turn * p + through).collect();
    let [all, there] = [TAU * radius * (high - low), round_area(&round, &cylinder, [low, high])];
    let bare = if there < (1.0 - WHOLE) * all { all - there } else { 0.0 };
    Ok(Cladding { mesh: Mesh::from_triangles(vertices, triangles).0, chart: Chart::Cylinder(cylinder), bare })
}

/// Area of faces on a cylinder between two places along its axis, mm²: all of those in between, and of others the part that their
/// length has in common.
fn round_area(faces: &[[DVec3; 3]], cylinder: &Cylinder, [low, high]: [f64; 2]) -> f64 {
    let share = |corners: &[DVec3; 3]| {
        let at = corners.map(|p| cylinder.axis.dot(p - cylinder.through));
        let [from, to] = [at[0].min(at[1]).min(at[2]), at[0].max(at[1]).max(at[2])];
        let common = (to.min(high) - from.max(low)).max(0.0);
        let [a, b, c] = *corners;
        0.5 * (b - a).cross(c - a).length() * if to > from { common / (to - from) } else { 1.0 }
    };
    faces.iter().map(share).sum()
}
