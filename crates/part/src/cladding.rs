//! Cladding: an even thickness of metal over the surface of an existing part, and the chart in which its layers follow
//! it.

use crate::chart::warp::{self, STEEPEST, WarpError};
use crate::chart::{Chart, Cylinder, Side, Surface, SurfaceError};
use crate::model::Mesh;
use crate::model::connected::joined;
use crate::model::solid::Solid;
use crate::task::Task;
use glam::{DQuat, DVec2, DVec3};
use planar::{FillRule, Join, Polygon, Region, Ring};
use std::collections::BTreeMap;
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

/// The metal to be laid, and the shape of its layers.
#[derive(Debug, Clone, PartialEq)]
pub struct Cladding {
    /// Closed, in the coordinates of the base, mm.
    pub mesh: Mesh,
    /// Layers over the surface of the base, or around its axis.
    pub chart: Chart,
    /// Area left out because it is too steep, hidden or missing, mm²: seen along the surface's direction, or around the
    /// axis.
    pub bare: f64,
}

/// Why something cannot be clad.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum CladdingError {
    /// The heights of the base do not define a surface.
    #[error(transparent)]
    Surface(#[from] SurfaceError),
    /// Cancelled by the caller, or the surface is too steep.
    #[error(transparent)]
    Warp(#[from] WarpError),
    /// The area and the visible part of the base do not overlap.
    #[error(
        "nothing of the base that is less steep than 17.7° lies within the area. Outlines lie in x and y of the base as it stands on the table."
    )]
    NoArea,
    /// No face of the base lies on the cylinder.
    #[error("nothing of the base lies {radius} mm from the axis, facing {facing}")]
    NotRound {
        /// Radius of the cylinder, mm.
        radius: f64,
        /// Which way its faces would point.
        facing: &'static str,
    },
    /// The cylinder has no face where it is to be clad.
    #[error("the face reaches {}, and nothing of it lies between the two places asked for", words(.stretches))]
    Beside {
        /// Intervals of its faces along the axis, mm.
        stretches: Vec<[f64; 2]>,
    },
    /// A bore too narrow for its cladding.
    #[error("a bore of {radius} mm radius has no room for {thickness} mm of cladding")]
    Narrow {
        /// Radius of the bore, mm.
        radius: f64,
        /// Thickness of the cladding, mm.
        thickness: f64,
    },
    /// The cylinder is interrupted, by flanges for example.
    #[error("the face has gaps along the axis: it reaches {}. Clad them one at a time", words(.stretches))]
    Gaps {
        /// Intervals of its faces along the axis, mm.
        stretches: Vec<[f64; 2]>,
    },
}

fn words(stretches: &[[f64; 2]]) -> String {
    stretches.iter().map(|[from, to]| format!("from {from:.1} to {to:.1} mm")).collect::<Vec<_>>().join(", ")
}

/// Faces looking up: least cosine of their slope, 45°. Scans are rougher than the scanned part.
const FACING: f64 = 0.7;
/// Faces are visible if they lie no deeper below the surface than this many grid steps.
const SEEN: f64 = 1.0;
/// Faces are examined in pieces of this many grid steps.
const PIECE: f64 = 2.0;
/// Heights are measured up to this many grid steps outside an area.
const BESIDE: f64 = 1.5;
/// Chord tolerance of the mesh, mm.
const TOLERANCE: f64 = 0.02;
/// Faces lie on a cylinder if their corners are this near to it, as a fraction of its radius and in mm; the smaller
/// counts.
const ROUND: f64 = 0.01;
const AWAY: f64 = 0.5;
/// Less missing than this fraction of a cylinder does not count: chords are shorter than their arcs.
const WHOLE: f64 = 0.01;
/// Segments of a full circle.
const SEGMENTS: u32 = 360;

/// Cladding over the part of a base that is visible along `up`, with the given thickness (mm) along `up`: over
/// everything not too steep, or only within `area` (mm, seen along `up`). The surface is measured on a grid of `step`
/// (mm).
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
    let facing = base.only(|corners| normal(corners).dot(up) >= FACING);
    let facing = warp::divided(&without_small(facing, step * step), PIECE * step, task)?;
    let level = level(&facing, up, step, kept)?;
    // So that what falls away beside those faces does not pull their edges down.
    let surface = Arc::new(Surface::of_faces(&level, up, step, kept)?.rounded());
    let chart = Chart::Surface(Arc::clone(&surface));
    let seen = shadow(&level, &chart);
    let (region, all) = match area {
        Some(area) => (seen.intersection(area), area.area()),
        None => (seen, shadow(&facing, &chart).area()),
    };
    let polygons = large(region.simplified(TOLERANCE).into_polygons(), step * step);
    if polygons.is_empty() {
        return Err(CladdingError::NoArea);
    }
    let covered: f64 = polygons.iter().map(Polygon::area).sum();
    let mesh = stacked(&polygons, &surface, thickness, task)?;
    // Where a plan looks at it.
    warp::check_slope(&surface, mesh.vertices.iter().map(|p| surface.coordinates(*p)))?;
    Ok(Cladding { mesh, chart, bare: (all - covered).max(0.0) })
}

/// A mesh without what is joined to less than an area, mm²: faces of a scan's walls that roughness turns upwards.
fn without_small(mut mesh: Mesh, area: f64) -> Mesh {
    let patches = joined(&mesh.triangles, mesh.vertices.len());
    let mut areas: BTreeMap<u32, f64> = BTreeMap::new();
    for (corners, patch) in mesh.triangles.iter().zip(&patches) {
        let [a, b, c] = corners.map(|corner| mesh.vertices[corner as usize]);
        *areas.entry(*patch).or_default() += 0.5 * (b - a).cross(c - a).length();
    }
    let mut patches = patches.iter();
    mesh.triangles.retain(|_| patches.next().is_some_and(|patch| areas.get(patch).is_some_and(|own| *own > area)));
    mesh
}

/// Polygons and holes larger than an area, mm². Smaller ones are roughness of a scan or gaps in it.
fn large(polygons: Vec<Polygon>, area: f64) -> Vec<Polygon> {
    let whole = polygons.into_iter().filter(|polygon| polygon.area() > area);
    let filled = whole.map(|mut polygon| {
        polygon.holes.retain(|hole| hole.area().abs() > area);
        polygon
    });
    filled.collect()
}

/// The faces, of those looking up, that are visible and not too steep, on a grid of `step` (mm), restricted to `kept`.
fn level(facing: &Mesh, up: DVec3, step: f64, kept: impl Fn(DVec2) -> bool + Copy) -> Result<Mesh, CladdingError> {
    let whole = Surface::of_faces(facing, up, step, kept).map_err(|error| match error {
        SurfaceError::Nothing => CladdingError::NoArea,
        other => other.into(),
    })?;
    let chart = Chart::Surface(Arc::new(whole));
    let level = facing.only(|corners| {
        let middle = chart.coordinates(corners.iter().sum::<DVec3>() / 3.0);
        let is_seen = middle.z >= -SEEN * step && kept(middle.truncate());
        is_seen && (chart.stretch(middle.truncate()) <= STEEPEST || normal(corners).dot(up) >= 1.0 / STEEPEST)
    });
    if level.triangles.is_empty() { Err(CladdingError::NoArea) } else { Ok(level) }
}

/// The solid of a thickness (mm) over polygons on a surface.
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

fn normal([a, b, c]: &[DVec3; 3]) -> DVec3 {
    (b - a).cross(c - a).normalize_or_zero()
}

/// The projection of upward-looking faces onto (u, v) of a surface.
fn shadow(mesh: &Mesh, chart: &Chart) -> Region {
    let flat: Vec<DVec2> = mesh.vertices.iter().map(|p| chart.coordinates(*p).truncate()).collect();
    let ring = |triangle: &[u32; 3]| Ring::new(triangle.map(|corner| flat[corner as usize]).to_vec());
    Region::from_rings(&mesh.triangles.iter().map(ring).collect::<Vec<_>>(), FillRule::NonZero)
}

/// Cladding of the given thickness (mm) around an axis, on the faces of a base that lie on the cylinder: over their
/// whole length along the axis, or only between two positions along it, mm from the point `through`.
///
/// # Errors
/// [`CladdingError`], for a cylinder.
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
    // Polygons inscribed in circles: moved out so that the middle of each chord lies on the circle.
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

/// Interval of a face along the axis, mm.
fn along(corners: &[DVec3; 3], cylinder: &Cylinder) -> [f64; 2] {
    let [a, b, c] = corners.map(|p| cylinder.axis.dot(p - cylinder.through));
    [a.min(b).min(c), a.max(b).max(c)]
}

/// Merges intervals that overlap or touch, mm.
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

/// Area of faces on a cylinder between two positions along its axis, mm²; of faces partly in between, the fraction of
/// their length that is.
fn round_area(faces: &[[DVec3; 3]], cylinder: &Cylinder, [low, high]: [f64; 2]) -> f64 {
    let share = |corners: &[DVec3; 3]| {
        let [from, to] = along(corners, cylinder);
        let common = (to.min(high) - from.max(low)).max(0.0);
        let [a, b, c] = *corners;
        0.5 * (b - a).cross(c - a).length() * if to > from { common / (to - from) } else { 1.0 }
    };
    faces.iter().map(share).sum()
}
