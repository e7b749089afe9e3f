//! Where the layers of a wall lie: as high as its beads grow (Li et al., section 1.2).
//!
//! Where a wall leans by φ from the build direction, a bead h_n away from the one below lies h_n cos φ above it. The
//! lean is measured point by point between neighbouring layers. A layer stays level, so its rise is limited by its most
//! leaning points: nowhere is a bead farther than h_n from the one below. Each piece of its path is paced by the width
//! of the wall there: where the wall leans more, a level layer cuts it wider and takes more metal.

use crate::bead::wall::WallBead;
use crate::model::Mesh;
use crate::model::wall_curves::{Section, WallCurves};
use crate::plan::MAX_LAYERS;
use crate::plan::charted::Across;
use crate::plan::slicing::Slicing;
use crate::plan::warm::Warmth;
use crate::slice::{self, Lines, Slab, Slice};
use crate::task::{Cancelled, Task};
use glam::DVec2;
use planar::Ring;
use rayon::prelude::*;

/// Greatest lean of a wall, radians (60°): steeper places are shoulders and floors, not walls.
const MOST_LEAN: f64 = std::f64::consts::FRAC_PI_3;

/// Number of points of an outline at which its lean is measured.
const POINTS: usize = 64;

/// One in this many points may lean more than the rise of the layer allows for.
const ASIDE: usize = 20;

/// The layers of a mesh wall that is placed on z = 0.
pub(super) fn of_mesh(
    mesh: &Mesh,
    wall: &WallBead,
    warmth: &Warmth,
    slicing: &Slicing,
    task: &Task,
) -> Result<Vec<Slab>, Cancelled> {
    let (step, top) = (wall.rise(), mesh.bounds().1.z.max(0.0));
    let slabs = slice::even_slabs(mesh, step);
    let slicer = slicing.slicer(mesh, slabs, task)?;
    let is_surface = slicing.is_wall(mesh);
    let mut rises = Vec::with_capacity(slicer.layer_count());
    let mut below: Option<Vec<Vec<DVec2>>> = None;
    for batch in 0..slicer.batch_count() {
        let lines: Vec<_> = if is_surface {
            slicer.lines(batch, task)?.into_iter().map(of_sections).collect()
        } else {
            slicer.batch(batch, task)?.iter().map(of_outlines).collect()
        };
        let first = slice::BATCH * batch - usize::from(below.is_some());
        let layers: Vec<_> = below.take().into_iter().chain(lines).collect();
        rises.par_extend(layers.par_windows(2).enumerate().map(|(k, pair)| {
            let middle = |k: usize| (k as f64 + 0.5) * step;
            let across = Across::new(slicing.chart, middle(first + k), middle(first + k + 1));
            let edges = |line: &Vec<DVec2>| line.windows(2).map(|w| (w[0], w[1])).collect::<Vec<_>>();
            let upper: Vec<(DVec2, DVec2)> = pair[1].iter().flat_map(edges).collect();
            let beside = |p: DVec2| match across {
                None => to_nearest(p, &upper),
                Some(across) => across.places(p).map(|p| to_nearest(p, &upper)).fold(f64::INFINITY, f64::min),
            };
            let lean = |p: DVec2| (beside(p) / step).atan();
            rise(wall, pair[0].iter().flat_map(|line| evenly(line)).map(lean))
        }));
        below = layers.into_iter().last();
    }
    // Slices lie at (k + ½) · step.
    let rise = |z: f64| {
        let pair = (z / step - 0.5).max(0.0) as usize;
        rises.get(pair.min(rises.len().saturating_sub(1))).copied().unwrap_or(step)
    };
    Ok(stacked(top, wall, warmth, rise))
}

/// The rise of a layer that leans by these angles (radians) at its points, mm: h_n cos φ with the greatest angle,
/// except for a few points, which may lie on a corner or an edge.
fn rise(wall: &WallBead, leans: impl Iterator<Item = f64>) -> f64 {
    let mut leans: Vec<f64> = leans.map(|lean| lean.min(MOST_LEAN)).collect();
    leans.sort_by(f64::total_cmp);
    let aside = leans.len() / ASIDE;
    leans.iter().rev().nth(aside).map_or(wall.rise(), |lean| wall.rise_leaning(*lean))
}

/// The outlines of a layer; a closed line ends where it begins.
fn of_outlines(slice: &Slice) -> Vec<Vec<DVec2>> {
    let ring = |ring: &Ring| ring.points().iter().chain(ring.points().first()).copied().collect();
    slice.islands.iter().flat_map(|island| island.rings()).map(ring).collect()
}

/// The lines of a layer of an open surface.
fn of_sections(lines: Lines) -> Vec<Vec<DVec2>> {
    let line = |Section { points, closed }: Section| {
        let again = points.first().copied().filter(|_| closed);
        points.into_iter().chain(again).collect()
    };
    lines.sections.into_iter().map(line).collect()
}

/// Evenly spaced points along a line.
fn evenly(line: &[DVec2]) -> Vec<DVec2> {
    let length = planar::polyline::length(line);
    (0..POINTS).filter_map(|k| planar::polyline::point_at(line, length * k as f64 / POINTS as f64)).collect()
}

/// Distance from a point to the nearest edge, mm; 0 where there is none, such as above the top of a wall.
fn to_nearest(p: DVec2, edges: &[(DVec2, DVec2)]) -> f64 {
    let squared = edges.iter().map(|&(a, b)| planar::polyline::distance_squared_to_segment(p, a, b));
    squared.reduce(f64::min).unwrap_or_default().sqrt()
}

/// The layers of a wall of centre-lines.
pub(super) fn of_curves(curves: &WallCurves, height: f64, wall: &WallBead, warmth: &Warmth) -> Vec<Slab> {
    let half = wall.rise() / 2.0;
    stacked(height, wall, warmth, |z| rise(wall, curves.leans(z - half, z + half).into_iter().map(|(_, lean)| lean)))
}

/// How much centre-lines lean within a layer: places, and the angle from the build direction there, radians.
pub(super) fn leans(curves: &WallCurves, slab: Slab) -> Vec<(DVec2, f64)> {
    curves.leans(slab.z - slab.height, slab.z)
}

/// The lean at the place nearest to a point, radians.
pub(super) fn lean_at(leans: &[(DVec2, f64)], at: DVec2) -> f64 {
    let nearest = leans.iter().min_by(|a, b| a.0.distance_squared(at).total_cmp(&b.0.distance_squared(at)));
    nearest.map_or(0.0, |(_, lean)| lean.min(MOST_LEAN))
}

/// The first layer is as high as the first bead; each further one rises by what `rise` gives for its middle, mm,
/// changed where the metal is warm, until the nearest to the top.
fn stacked(top: f64, wall: &WallBead, warmth: &Warmth, rise: impl Fn(f64) -> f64) -> Vec<Slab> {
    let mut slabs = vec![Slab { z: wall.height(), height: wall.height() }];
    let mut z = wall.height();
    while slabs.len() < MAX_LAYERS {
        let height = rise(z + wall.rise() / 2.0) * warmth.lift(z);
        if z + height / 2.0 >= top {
            break;
        }
        z += height;
        slabs.push(Slab { z, height });
    }
    slabs
}
