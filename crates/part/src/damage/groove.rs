//! The groove of one damaged place: as deep as the damage, no steeper than layers can follow, and what is welded in it.
//!
//! Its floor is the highest surface under the scan that rises from the damage by no more than [`GENTLE`] in any direction. It ends where
//! the part does, and at steps of the part, so that no wall beside the damage is milled.

use super::found::Found;
use super::{Reason, Settings, Unfilled};
use crate::chart::surface::Grid;
use crate::chart::warp::{self, WarpError};
use crate::chart::{Chart, Surface};
use crate::model::Mesh;
use crate::model::solid::Solid;
use crate::task::Task;
use glam::{DVec2, DVec3};
use planar::isolines::isolines;
use planar::{Bounds, FillRule, Join, Lattice, Polygon, Region, Ring};
use std::collections::VecDeque;
use std::f64::consts::SQRT_2;
use std::sync::Arc;

/// Rise of a groove's sides: less than layers can follow, since splines through its corners are a little steeper.
const GENTLE: f64 = 0.25;
/// The part has a step where it rises by more than this.
const STEP: f64 = 1.0;
/// A side of a groove that would be lower by less than this stays as it is, mm.
const LEAST: f64 = 0.01;
/// Heights are measured for this many steps of the grid beside a groove.
const BESIDE: usize = 2;
/// Chord tolerance, mm.
const TOLERANCE: f64 = 0.02;
/// Faces seen less steeply than this belong to what is seen: the cosine of their slope.
const FACING: f64 = 0.05;

/// How far a groove reaches beyond damage of a depth, mm.
pub(super) fn reach(depth: f64, bead: f64) -> f64 {
    depth / GENTLE + bead
}

/// A groove, seen along the direction in which it is open.
pub(super) struct Groove {
    grid: Grid,
    up: DVec3,
    /// The damaged part, where it is seen, on the grid, mm.
    ground: Vec<Option<f64>>,
    /// Whether metal is missing or milled, on the grid.
    open: Vec<bool>,
    /// The part's surface.
    top: Surface,
    /// What is welded on.
    pub(super) floor: Arc<Surface>,
}

impl Groove {
    /// The groove of a place.
    ///
    /// # Errors
    /// [`Unfilled`].
    pub(super) fn under(
        found: &Found,
        part: &Mesh,
        base: &Mesh,
        up: DVec3,
        settings: Settings,
    ) -> Result<Self, Unfilled> {
        let Settings { step, tolerance, bead, .. } = settings;
        let every = Grid::over(up, step, DVec2::ZERO, DVec2::ZERO)?;
        let seen = || found.points.iter().map(|p| every.seen(*p).truncate());
        let margin = reach(found.depth, bead) + (BESIDE + 1) as f64 * step;
        let low = seen().fold(DVec2::INFINITY, DVec2::min) - margin;
        let high = seen().fold(DVec2::NEG_INFINITY, DVec2::max) + margin;
        let grid = Grid::over(up, step, low, high)?;
        let (top, ground) = (grid.tops(part), grid.tops(base));
        let near = near(&grid, seen());
        let is_deep = |k: usize| near[k] && matches!((top[k], ground[k]), (Some(t), Some(g)) if t - g > tolerance);
        let (floor, open) = dug(&grid, &top, &ground, (0..top.len()).map(is_deep).collect());
        if !open.contains(&true) {
            return Err(Unfilled::Left(Reason::Hidden));
        }
        let kept = wider(&grid, &top, &open);
        let only = |heights: &[Option<f64>]| heights.iter().zip(&kept).map(|(h, kept)| h.filter(|_| *kept)).collect();
        let (top, floor) = (grid.surface(only(&top))?, grid.surface(only(&floor))?);
        Ok(Self { grid, up, ground, open, top, floor: Arc::new(floor.rounded()) })
    }

    /// Whether most of a place is hidden by what lies over it.
    pub(super) fn is_hidden(&self, found: &Found, tolerance: f64) -> bool {
        let over = |p: &&DVec3| {
            let seen = self.grid.seen(**p);
            let top = self.nearest(seen.truncate()).and_then(|k| self.ground[k]);
            top.is_some_and(|top| top > seen.z + tolerance + STEP * self.grid.step)
        };
        2 * found.points.iter().filter(over).count() > found.points.len()
    }

    /// What is welded, seen along the direction, mm: no narrower than a bead.
    ///
    /// # Errors
    /// [`WarpError::Cancelled`].
    pub(super) fn outline(&self, part: &Mesh, settings: Settings, task: &Task) -> Result<Vec<Polygon>, WarpError> {
        let Settings { step, tolerance, bead, .. } = settings;
        let rim = tolerance / 2.0;
        let (low, high) = self.bounds();
        let lattice = Lattice::covering(&Bounds { min: low, max: high }, step, step / 2.0, 1);
        let value = |k: usize| {
            let (column, row) = (k % lattice.columns, k / lattice.columns);
            let is_rim = column == 0 || row == 0 || column + 1 == lattice.columns || row + 1 == lattice.rows;
            // Only where it is as deep as its rim matters.
            if is_rim { 0.0 } else { (self.depth(lattice.place_of(k)) / rim).clamp(0.0, 1.5) as f32 }
        };
        let deep: Vec<f32> = (0..lattice.len()).map(value).collect();
        let lines = isolines(&lattice, &deep).into_iter().map(|line| Ring::new(line.points));
        let deep = Region::from_rings(&lines.collect::<Vec<_>>(), FillRule::NonZero);
        let of_part = self.shadow(part, task)?;
        let half = bead / 2.0;
        let open = deep.intersection(&of_part).offset(-half, Join::ROUND).offset(half, Join::ROUND);
        let polygons = open.intersection(&of_part).simplified(TOLERANCE).into_polygons().into_iter();
        Ok(polygons.filter(|polygon| polygon.area() > bead * bead).collect())
    }

    /// The part's surface around the groove, seen along the direction.
    fn shadow(&self, part: &Mesh, task: &Task) -> Result<Region, WarpError> {
        let step = self.grid.step;
        let pieces = self.divided(part, step, task)?;
        let ring = |corners: &[u32; 3]| {
            let [a, b, c] = corners.map(|corner| self.grid.seen(pieces.vertices[corner as usize]));
            let middle = (a + b + c) / 3.0;
            let faces_up = (b - a).cross(c - a).normalize_or_zero().z > FACING;
            let is_top = (middle.z - self.top.height(middle.truncate())).abs() < STEP * step;
            let is_near = faces_up && is_top && self.is_open(middle.truncate());
            is_near.then(|| Ring::new([a, b, c].map(|p| p.truncate()).to_vec()))
        };
        let rings: Vec<Ring> = pieces.triangles.iter().filter_map(ring).collect();
        Ok(Region::from_rings(&rings, FillRule::NonZero))
    }

    /// What is welded: from the floor up to the part's surface and what is to be milled off, closed, mm.
    ///
    /// # Errors
    /// [`WarpError`].
    pub(super) fn metal(&self, polygons: &[Polygon], settings: Settings, task: &Task) -> Result<Mesh, WarpError> {
        // A layer is welded where at least half of it lies in the solid.
        let over = settings.allowance - settings.layer / 2.0;
        let mut metal = Mesh::default();
        for polygon in polygons {
            let Solid { vertices, triangles } = Solid::extrude(polygon, 0.0, 1.0);
            let mut flat = warp::divided(&Mesh { vertices, triangles, ..Mesh::default() }, self.grid.step, task)?;
            flat.vertices.iter_mut().for_each(|p| p.z *= self.depth(p.truncate()).max(0.0) + over);
            metal.add(warp::bent(&self.floor, &flat, TOLERANCE, task)?);
        }
        Ok(metal)
    }

    /// What is missing of the part and what is milled off, mm³.
    pub(super) fn volumes(&self, polygons: &[Polygon]) -> (f64, f64) {
        let cell = self.grid.step * self.grid.step;
        let within = |k: &usize| polygons.iter().any(|polygon| polygon.contains(self.grid.place(*k)));
        let at = |k: usize| {
            let (place, ground) = (self.grid.place(k), self.ground[k]?);
            let floor = self.floor.height(place);
            Some(((self.top.height(place) - ground.max(floor)).max(0.0), (ground - floor).max(0.0)))
        };
        let parts = (0..self.open.len()).filter(within).filter_map(at);
        let (missing, milled) = parts.fold((0.0, 0.0), |(a, b), (c, d)| (a + c, b + d));
        (missing * cell, milled * cell)
    }

    /// The damaged part with the groove milled.
    ///
    /// # Errors
    /// [`WarpError::Cancelled`].
    pub(super) fn milled(
        &self,
        base: &Mesh,
        polygons: &[Polygon],
        settings: Settings,
        task: &Task,
    ) -> Result<Mesh, WarpError> {
        let mut milled = self.divided(base, self.grid.step, task)?;
        for vertex in &mut milled.vertices {
            let seen = self.grid.seen(*vertex);
            let place = seen.truncate();
            if self.is_open(place) && polygons.iter().any(|polygon| polygon.contains(place)) {
                let over = seen.z - self.floor.height(place);
                let is_metal = over > 0.0 && seen.z < self.top.height(place) + settings.allowance;
                *vertex -= if is_metal { self.up * over } else { DVec3::ZERO };
            }
        }
        Ok(milled)
    }

    pub(super) fn chart(&self) -> Chart {
        Chart::Surface(Arc::clone(&self.floor))
    }

    /// Places of the grid within polygons, on the floor.
    pub(super) fn places(&self, polygons: &[Polygon]) -> impl Iterator<Item = DVec3> {
        let places = (0..self.open.len()).map(|k| self.grid.place(k));
        places.filter(|p| polygons.iter().any(|polygon| polygon.contains(*p))).map(|p| p.extend(0.0))
    }

    /// How much lies between the floor and the part's surface at a place, mm.
    fn depth(&self, p: DVec2) -> f64 {
        self.top.height(p) - self.floor.height(p)
    }

    fn bounds(&self) -> (DVec2, DVec2) {
        (self.grid.place(0), self.grid.place(self.open.len() - 1))
    }

    /// A mesh whose edges in the groove are no longer than this, mm.
    fn divided(&self, mesh: &Mesh, longest: f64, task: &Task) -> Result<Mesh, WarpError> {
        let (low, high) = self.bounds();
        warp::divided_where(mesh, longest, task, |a, b| {
            let [a, b] = [a, b].map(|p| self.grid.seen(p).truncate());
            a.min(b).cmple(high).all() && a.max(b).cmpge(low).all()
        })
    }

    /// The number of the grid's place nearest to a place, where it lies on the grid.
    fn nearest(&self, p: DVec2) -> Option<usize> {
        nearest(&self.grid, p)
    }

    /// Whether metal is missing or milled at a corner of the cell around a place.
    fn is_open(&self, p: DVec2) -> bool {
        let half = self.grid.step / 2.0;
        let corners = [(-half, -half), (-half, half), (half, -half), (half, half)];
        corners.into_iter().any(|(x, y)| self.nearest(p + DVec2::new(x, y)).is_some_and(|k| self.open[k]))
    }
}

fn nearest(grid: &Grid, p: DVec2) -> Option<usize> {
    let at = ((p - grid.from) / grid.step).round();
    let is_on_it = at.cmpge(DVec2::ZERO).all() && at.x < grid.columns as f64 && at.y < grid.rows as f64;
    is_on_it.then(|| at.y as usize * grid.columns + at.x as usize)
}

/// Where a grid lies within two steps of places, which are no farther apart than that.
fn near(grid: &Grid, places: impl Iterator<Item = DVec2>) -> Vec<bool> {
    let mut near = vec![false; grid.columns * grid.rows];
    places.filter_map(|p| nearest(grid, p)).for_each(|k| near[k] = true);
    for _ in 0..2 {
        let beside = |k: usize| neighbours(grid, k).any(|(n, _)| near[n]);
        near = (0..near.len()).map(|k| near[k] || beside(k)).collect();
    }
    near
}

/// The floor of a groove under deep places, and where metal is missing or milled.
fn dug(grid: &Grid, top: &[Option<f64>], ground: &[Option<f64>], deep: Vec<bool>) -> (Vec<Option<f64>>, Vec<bool>) {
    let (mut floor, mut open) = (ground.to_vec(), deep);
    let mut queue: VecDeque<usize> = (0..open.len()).filter(|k| open[*k]).collect();
    while let Some(k) = queue.pop_front() {
        let Some(low) = floor[k] else { continue };
        for (n, away) in neighbours(grid, k) {
            let highest = low + GENTLE * away;
            if is_even(top, k, n, away) && floor[n].is_some_and(|floor| floor > highest + LEAST) {
                floor[n] = Some(highest);
                open[n] = true;
                queue.push_back(n);
            }
        }
    }
    (floor, open)
}

/// The same places and those around them, up to steps of the part.
fn wider(grid: &Grid, top: &[Option<f64>], open: &[bool]) -> Vec<bool> {
    let mut wider = open.to_vec();
    for _ in 0..BESIDE {
        let beside = |k: usize| neighbours(grid, k).any(|(n, away)| wider[n] && is_even(top, k, n, away));
        wider = (0..wider.len()).map(|k| wider[k] || beside(k)).collect();
    }
    wider
}

/// Whether the part has no step between two places.
fn is_even(top: &[Option<f64>], a: usize, b: usize, away: f64) -> bool {
    matches!((top[a], top[b]), (Some(a), Some(b)) if (a - b).abs() <= STEP * away)
}

/// The places around one, and how far away they are, mm.
fn neighbours(grid: &Grid, k: usize) -> impl Iterator<Item = (usize, f64)> {
    let (column, row) = ((k % grid.columns) as isize, (k / grid.columns) as isize);
    let (columns, rows, step) = (grid.columns as isize, grid.rows as isize, grid.step);
    let ways = (-1..=1).flat_map(|y| (-1..=1).map(move |x| (x, y))).filter(|way| *way != (0, 0));
    ways.filter_map(move |(x, y)| {
        let (column, row) = (column + x, row + y);
        let is_on_it = (0..columns).contains(&column) && (0..rows).contains(&row);
        let away = if x != 0 && y != 0 { SQRT_2 * step } else { step };
        is_on_it.then_some(((row * columns + column) as usize, away))
    })
}
