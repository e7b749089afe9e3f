//! Cladding: metal of an even thickness over the surface of a part that is there, and the chart in which its layers follow it.

use crate::chart::warp::{self, STEEPEST, WarpError};
use crate::chart::{Chart, Cylinder, Side, Surface, SurfaceError};
use crate::model::Mesh;
use crate::model::solid::Solid;
use crate::task::Task;
use glam::{DQuat, DVec2, DVec3};
use planar::{Bounds, FillRule, Join, Polygon, Region, Ring};
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
    let near = area.map(|area| area.offset(BESIDE * step, Join::ROUND));
    let kept = |p: DVec2| near.as_ref().is_none_or(|near| near.contains(p));
    let facing = faces(base, |corners| normal(corners).dot(up) >= FACING);
    let facing = warp::divided(&facing, PIECE * step, task)?;
    let level = level(&facing, up, step, kept)?;
    // What falls away beside those faces does not pull their edges down.
    let surface = Arc::new(Surface::of_faces(&level, up, step, kept)?.rounded());
    let chart = Chart::Surface(Arc::clone(&surface));
    let seen = shadow(&level, &chart);
    let (region, all) = match area {
        Some(area) => (seen.intersection(area), area.area()),
        None => (seen, shadow(&facing, &chart).area()),
    };
    warp::check_slope(&surface, places(&region, step / 2.0))?;
    let polygons = region.simplified(TOLERANCE).into_polygons().into_iter();
    let polygons: Vec<Polygon> = polygons.filter(|polygon| polygon.area() > step * step).collect();
    if polygons.is_empty() {
        return Err(CladdingError::NoArea);
    }
    let covered: f64 = polygons.iter().map(Polygon::area).sum();
    let mesh = stacked(&polygons, &surface, thickness, task)?;
    Ok(Cladding { mesh, chart, bare: (all - covered).max(0.0) })
}

/// Those of the faces that look up which are seen and not too steep, on a grid of `step`, mm, where it is kept.
fn level(facing: &Mesh, up: DVec3, step: f64, kept: impl Fn(DVec2) -> bool + Copy) -> Result<Mesh, CladdingError> {
    let whole = Surface::of_faces(facing, up, step, kept).map_err(|error| match error {
        SurfaceError::Nothing => CladdingError::NoArea,
        other => other.into(),
    })?;
    let chart = Chart::Surface(Arc::new(whole));
    let level = faces(facing, |corners| {
        let middle = chart.coordinates(corners.iter().sum::<DVec3>() / 3.0);
        let is_seen = middle.z >= -SEEN * step && kept(middle.truncate());
        is_seen && (chart.stretch(middle.truncate()) <= STEEPEST || normal(corners).dot(up) >= 1.0 / STEEPEST)
    });
    if level.triangles.is_empty() { Err(CladdingError::NoArea) } else { Ok(level) }
}

/// The solid over polygons on a surface, of a thickness, mm.
fn stacked(polygons: &[Polygon], surface: &Surface, thickness: f64, task: &Task) -> Result<Mesh, WarpError> {
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    for polygon in polygons {
        let first = vertices.len() as u32;
        let flat = Solid::extrude(polygon, 0.0, thickness);
        let (flat, _) = Mesh::from_triangles(flat.vertices, flat.triangles);
        let bent = warp::bent(surface, &flat, TOLERANCE, task)?;
        vertices.extend(bent.vertices);
        triangles.extend(bent.triangles.iter().map(|corners| corners.map(|corner| corner + first)));
    }
    Ok(Mesh::from_triangles(vertices, triangles).0)
}

/// Places of a region on a grid, mm.
fn places(region: &Region, step: f64) -> impl Iterator<Item = DVec3> {
    let bounds = region.bounds().unwrap_or(Bounds { min: DVec2::ZERO, max: DVec2::ZERO });
    let counts = (bounds.size() / step).ceil();
    let at = move |i: usize, j: usize| bounds.min + DVec2::new(i as f64 + 0.5, j as f64 + 0.5) * step;
    let rows = (0..counts.y as usize).flat_map(move |j| (0..counts.x as usize).map(move |i| at(i, j)));
    rows.filter(|p| region.contains(*p)).map(|p| p.extend(0.0))
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
    let round = round(base, &cylinder);
    let whole = stretches(round.iter().map(|corners| along(corners, &cylinder)).collect());
    let [from, to] = [between[0].unwrap_or(f64::MIN), between[1].unwrap_or(f64::MAX)];
    let within = whole.iter().map(|[low, high]| [low.max(from), high.min(to)]);
    let found: Vec<[f64; 2]> = within.filter(|[low, high]| high - low > TOLERANCE).collect();
    let facing = if side == Side::Outer { "outwards" } else { "inwards" };
    let [low, high] = match found[..] {
        [one] => one,
        [] if whole.is_empty() => return Err(CladdingError::NotRound { radius, facing }),
        [] => return Err(CladdingError::Beside { stretches: whole }),
        _ => return Err(CladdingError::Gaps { stretches: found }),
    };
    let sign = outwards(side);
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

/// 1 where faces point away from the axis, -1 where they point to it.
fn outwards(side: Side) -> f64 {
    if side == Side::Outer { 1.0 } else { -1.0 }
}

/// The faces of a mesh that lie on a cylinder and point to its side.
fn round(mesh: &Mesh, cylinder: &Cylinder) -> Vec<[DVec3; 3]> {
    let out = |p: DVec3| (p - cylinder.through).reject_from_normalized(cylinder.axis);
    let near = (ROUND * cylinder.radius).min(AWAY);
    let is_on_it = |corners: &[DVec3; 3]| {
        let points = normal(corners).dot(out(corners.iter().sum::<DVec3>() / 3.0)) * outwards(cylinder.side) > 0.0;
        points && corners.iter().all(|p| (out(*p).length() - cylinder.radius).abs() <= near)
    };
    let triangles = mesh.triangles.iter().map(|corners| corners.map(|corner| mesh.vertices[corner as usize]));
    triangles.filter(is_on_it).collect()
}

/// Where a face begins and ends along the axis, mm.
fn along(corners: &[DVec3; 3], cylinder: &Cylinder) -> [f64; 2] {
    let [a, b, c] = corners.map(|p| cylinder.axis.dot(p - cylinder.through));
    [a.min(b).min(c), a.max(b).max(c)]
}

/// Spans put together where one goes on in the next, mm.
fn stretches(mut spans: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    spans.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let mut stretches: Vec<[f64; 2]> = Vec::new();
    for span in spans {
        match stretches.last_mut() {
            Some(last) if span[0] <= last[1] + TOLERANCE => last[1] = last[1].max(span[1]),
            _ => stretches.push(span),
        }
    }
    stretches
}

/// Area of faces on a cylinder between two places along its axis, mm²: all of those in between, and of others the part that their
/// length has in common.
fn round_area(faces: &[[DVec3; 3]], cylinder: &Cylinder, [low, high]: [f64; 2]) -> f64 {
    let share = |corners: &[DVec3; 3]| {
        let [from, to] = along(corners, cylinder);
        let common = (to.min(high) - from.max(low)).max(0.0);
        let [a, b, c] = *corners;
        0.5 * (b - a).cross(c - a).length() * if to > from { common / (to - from) } else { 1.0 }
    };
    faces.iter().map(share).sum()
}
