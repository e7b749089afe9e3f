//! The orientation in which a preform costs least.
//!
//! 1. The part becomes a grid of cells, looked at from directions all over the sphere, from all flat faces and axes. For each
//!    direction, layers of bits are laid from the top down as the preform's steps are: the part, and the layer above shrunk by
//!    what may hang.
//! 2. The best of them, no two alike, are scored by thick steps ([`Figures::score`]), and the best of these by thinner ones.
//! 3. The best that are left are turned by smaller and smaller angles as long as that helps.

use super::figures::{Figures, Rates};
use super::{Preform, PreformSettings};
use bead_part::model::{Mesh, holes, stand};
use bead_part::slice::{Slab, SliceOptions, Slicer};
use bead_part::task::{Cancelled, Task};
use glam::{DMat3, DQuat, DVec3, UVec3};
use planar::Region;
use rayon::prelude::*;
use std::cmp::Ordering;
use std::f64::consts::PI;

/// Directions spread over the sphere.
const DIRECTIONS: usize = 1200;
/// Cells along the longest side of the part.
const CELLS: f64 = 56.0;
/// Rounds in which ever fewer directions, no two alike, are scored ever more accurately and turned by ever smaller
/// angles.
const ROUNDS: [Round; 3] = [
    Round { count: 48, steps: 20.0, turns: &[] },
    Round { count: 6, steps: 20.0, turns: &[6.0, 3.0] },
    Round { count: 3, steps: STEPS, turns: &[2.0, 1.0, 0.5] },
];
/// A part with fewer triangles is viewed from twice as many directions.
const LARGE: usize = 40_000;
/// Steps over the height of a part for the final score.
const STEPS: f64 = 40.0;
/// Directions closer than this are alike: cosine of 8°.
const ALIKE: f64 = 0.9903;

/// Outlines of a part being scored are simplified by this many steps.
const ROUGH: f64 = 0.05;

/// A direction of the part that points down, with its figures.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Oriented {
    /// Unit vector, in the part's coordinates.
    pub down: DVec3,
    /// Figures of a preform in coarse steps, without the beads for thin places.
    pub figures: Figures,
}

/// The best orientations, no two alike, the best one first; only the given one for a surface with an opening wider than
/// a bead.
///
/// # Errors
/// [`Cancelled`] if the task was cancelled.
pub fn best(mesh: &Mesh, settings: &PreformSettings, rates: &Rates, task: &Task) -> Result<Vec<Oriented>, Cancelled> {
    // An open skin of a solid loses metal where its contours do not close; in the given orientation they were meant to
    // close.
    if holes::openings(mesh).iter().any(|opening| opening.width > settings.bead_width) {
        return Ok(vec![Oriented::of(mesh, DVec3::NEG_Z, settings, rates, task)?]);
    }
    let Some(cells) = Cells::of(mesh, settings, task)? else { return Ok(Vec::new()) };
    let directions: Vec<DVec3> = directions(mesh);
    let rough = |down: &DVec3| -> Result<(f64, DVec3), Cancelled> {
        task.check()?;
        Ok((cells.score(*down, settings, rates), *down))
    };
    let mut scored = directions.par_iter().map(rough).collect::<Result<Vec<_>, _>>()?;
    scored.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut ways: Vec<DVec3> = scored.into_iter().map(|(_, down)| down).collect();
    let search = Search { mesh, settings, rates, task };
    let mut found = Vec::new();
    let more = if mesh.triangles.len() < LARGE { 2 } else { 1 };
    for Round { count, steps, turns } in ROUNDS {
        let refined = |down: &DVec3| search.refined(search.at(*down, steps)?, steps, turns);
        found = apart(&ways, more * count).par_iter().map(refined).collect::<Result<Vec<_>, _>>()?;
        found.sort_by(Oriented::by_score);
        ways = found.iter().map(|one| one.down).collect();
    }
    Ok(found)
}

/// A round of the search.
struct Round {
    /// Number of directions.
    count: usize,
    /// Steps over the height of the part.
    steps: f64,
    /// Angles by which each direction is turned as long as that helps, °.
    turns: &'static [f64],
}

/// The first `count` directions that are not alike.
fn apart(directions: &[DVec3], count: usize) -> Vec<DVec3> {
    let mut few: Vec<DVec3> = Vec::new();
    for down in directions {
        if few.len() < count && few.iter().all(|other| other.dot(*down) < ALIKE) {
            few.push(*down);
        }
    }
    few
}

/// The part and settings for which directions are scored.
struct Search<'a> {
    mesh: &'a Mesh,
    settings: &'a PreformSettings,
    rates: &'a Rates,
    task: &'a Task,
}

impl Search<'_> {
    /// A direction with the figures of the preform in that orientation, with about this number of steps over the height
    /// of the part.
    fn at(&self, down: DVec3, steps: f64) -> Result<Oriented, Cancelled> {
        let Self { settings, rates, .. } = self;
        let turned = standing(self.mesh, down);
        let step = settings.step.max(turned.size().z / steps);
        // Otherwise a flat part would be scored up to one step too high, and would do better slightly tilted.
        let whole = settings.lift() + turned.size().z + settings.top;
        let step = whole / (whole / step).floor().max(1.0);
        let simplify = settings.simplify.max(ROUGH * step);
        let coarse = PreformSettings { bead_width: 0.0, step, simplify, ..**settings };
        let preform = Preform::of(&turned, &coarse, self.task)?;
        Ok(Oriented { down, figures: Figures::of(&turned, &preform, &coarse, rates) })
    }

    /// The best direction found by turning one.
    fn refined(&self, mut best: Oriented, steps: f64, turns: &[f64]) -> Result<Oriented, Cancelled> {
        for degrees in turns {
            let across = best.down.any_orthonormal_vector();
            let axes = [across, -across, best.down.cross(across), across.cross(best.down)];
            let turned = |axis: &DVec3| DQuat::from_axis_angle(*axis, degrees.to_radians()) * best.down;
            let tried: Vec<Oriented> =
                axes.par_iter().map(|axis| self.at(turned(axis), steps)).collect::<Result<_, _>>()?;
            best = tried.into_iter().fold(best, |best, one| if one.by_score(&best).is_lt() { one } else { best });
        }
        Ok(best)
    }
}

impl Oriented {
    /// A direction with the figures of the preform in that orientation.
    ///
    /// # Errors
    /// [`Cancelled`] if the task was cancelled.
    pub fn of(
        mesh: &Mesh,
        down: DVec3,
        settings: &PreformSettings,
        rates: &Rates,
        task: &Task,
    ) -> Result<Self, Cancelled> {
        Search { mesh, settings, rates, task }.at(down, STEPS)
    }

    fn by_score(&self, other: &Self) -> Ordering {
        self.figures.score().total_cmp(&other.figures.score())
    }
}

/// A mesh turned so that a direction points down, and moved to stand on z = 0.
pub fn standing(mesh: &Mesh, down: DVec3) -> Mesh {
    let turn = DQuat::from_rotation_arc(down.normalize_or(DVec3::NEG_Z), DVec3::NEG_Z);
    let mut turned = mesh.clone();
    turned.vertices.iter_mut().for_each(|vertex| *vertex = turn * *vertex);
    let floor = turned.bounds().0.z;
    turned.vertices.iter_mut().for_each(|vertex| vertex.z -= floor);
    turned
}

/// Directions spread evenly over the sphere (a golden-angle spiral), those of the axes, and those of the part's flat
/// faces.
fn directions(mesh: &Mesh) -> Vec<DVec3> {
    let golden = PI * (3.0 - 5_f64.sqrt());
    let spiral = |k: usize| {
        let z = 1.0 - (2.0 * k as f64 + 1.0) / DIRECTIONS as f64;
        let (sin, cos) = (golden * k as f64).sin_cos();
        let radius = (1.0 - z * z).sqrt();
        DVec3::new(radius * cos, radius * sin, z)
    };
    let axes = [DVec3::X, DVec3::Y, DVec3::Z].into_iter().flat_map(|axis| [axis, -axis]);
    // The given orientation comes first among equals.
    let mut all = vec![DVec3::NEG_Z];
    all.extend(stand::faces(mesh).chain(axes).chain((0..DIRECTIONS).map(spiral)));
    all
}

/// A part in cells.
struct Cells {
    /// Lowest corner, mm.
    low: DVec3,
    /// Side of a cell, mm.
    side: f64,
    count: UVec3,
    /// For each row along x, a bit per cell: whether it lies in the part.
    rows: Vec<u128>,
    /// Number of cells in the part.
    inside: u64,
    /// Thickness of the stock, mm.
    stock: f64,
    /// Points of the part that are farthest in some direction.
    extremes: Vec<DVec3>,
    /// Volume of the part, mm³.
    volume: f64,
}

impl Cells {
    /// `None` for a part without cells. Stock of at least half a cell becomes a layer of cells around the part.
    fn of(mesh: &Mesh, settings: &PreformSettings, task: &Task) -> Result<Option<Self>, Cancelled> {
        let (low, high) = mesh.bounds();
        let size = high - low;
        let side = size.max_element() / CELLS;
        if !(side > 0.0 && side.is_finite()) {
            return Ok(None);
        }
        let count = (size / side).ceil().max(DVec3::ONE).as_uvec3();
        let mut standing = mesh.clone();
        standing.vertices.iter_mut().for_each(|vertex| vertex.z -= low.z);
        let slabs = (0..count.z).map(|k| Slab { z: f64::from(k + 1) * side, height: side }).collect();
        let options = SliceOptions { layer_height: side, close_gap: 0.1 * side, simplify: 0.01 * side };
        let mut rows = Vec::with_capacity((count.y * count.z) as usize);
        for slice in Slicer::of_slabs(&standing, slabs, options, task)?.all(task)? {
            let region = Region::from_normalised(slice.islands);
            let lines = region.rows(low.y + 0.5 * side, side, count.y as usize);
            rows.extend(lines.iter().map(|ends| row(ends, low.x, side)));
        }
        let inside = rows.iter().map(|row| u64::from(row.count_ones())).sum();
        let farthest = |way: DVec3| {
            mesh.vertices.iter().copied().max_by(|a, b| a.dot(way).total_cmp(&b.dot(way))).unwrap_or_default()
        };
        let extremes = directions(&Mesh::default()).into_par_iter().step_by(EXTREMES).map(farthest).collect();
        let stock = (settings.side + settings.top + settings.bottom) / 3.0;
        let bare = Self { low, side, count, rows, inside, stock: 0.0, extremes, volume: mesh.volume() };
        Ok((inside > 0).then(|| if stock >= side / 2.0 { bare.grown() } else { bare }))
    }

    /// The same with a layer of cells around it.
    fn grown(self) -> Self {
        let count = self.count + 2;
        let at = |y: u32, z: u32| match (y.checked_sub(1), z.checked_sub(1)) {
            (Some(y), Some(z)) if y < self.count.y && z < self.count.z => {
                self.rows.get((z * self.count.y + y) as usize).map_or(0, |row| row << 1)
            }
            _ => 0,
        };
        let row = |y: u32, z: u32| {
            let own = at(y, z);
            let beside = at(y.wrapping_sub(1), z) | at(y + 1, z) | at(y, z.wrapping_sub(1)) | at(y, z + 1);
            own | (own << 1) | (own >> 1) | beside
        };
        let rows = (0..count.z).flat_map(|z| (0..count.y).map(move |y| (y, z))).map(|(y, z)| row(y, z)).collect();
        Self { low: self.low - self.side, count, rows, stock: self.side, ..self }
    }

    fn is_inside(&self, p: DVec3) -> bool {
        let at = (p - self.low) / self.side;
        if at.min_element() < 0.0 {
            return false;
        }
        let UVec3 { x, y, z } = at.as_uvec3();
        x < self.count.x && y < self.count.y && z < self.count.z && {
            let row = self.rows.get((z * self.count.y + y) as usize);
            row.is_some_and(|row| (row >> x) & 1 == 1)
        }
    }

    /// The score of a preform with this direction down, from the number of its cells.
    fn score(&self, down: DVec3, settings: &PreformSettings, rates: &Rates) -> f64 {
        let turn = DMat3::from_quat(DQuat::from_rotation_arc(down, DVec3::NEG_Z));
        let points = || self.extremes.iter().map(|p| turn * *p);
        let low = points().fold(DVec3::INFINITY, DVec3::min) - self.stock;
        let high = points().fold(DVec3::NEG_INFINITY, DVec3::max) + self.stock;
        let count = ((high - low) / self.side).ceil().max(DVec3::ONE).as_uvec3().min(UVec3::splat(u128::BITS));
        let back = turn.transpose();
        let mut laid = 0_u64;
        let mut above = vec![0_u128; count.y as usize];
        let (mut owed, mut square) = (0.0, false);
        for z in (0..count.z).rev() {
            owed += settings.reach.tan();
            while owed >= 1.0 {
                above = shrunk(&above, square);
                (owed, square) = (owed - 1.0, !square);
            }
            for (y, row) in above.iter_mut().enumerate() {
                let start = low + (DVec3::new(0.0, y as f64, f64::from(z)) + 0.5) * self.side;
                let (first, next) = (back * start, back.x_axis * self.side);
                for x in 0..count.x {
                    *row |= u128::from(self.is_inside(first + next * f64::from(x))) << x;
                }
            }
            laid += above.iter().map(|row| u64::from(row.count_ones())).sum::<u64>();
        }
        let cell = self.volume / self.inside as f64;
        let foot: u64 = above.iter().map(|row| u64::from(row.count_ones())).sum();
        let raised = foot as f64 * self.side * self.side * settings.lift();
        let volume = (laid as f64 * cell + raised).max(0.0);
        let columns = above.iter().fold(0, |all, row| all | row);
        // The lowest layer may be empty.
        let wide = f64::from((u128::BITS - columns.leading_zeros()).saturating_sub(columns.trailing_zeros()));
        let filled = |row: &u128| *row != 0;
        let deep = match (above.iter().position(filled), above.iter().rposition(filled)) {
            (Some(first), Some(last)) => (last - first + 1) as f64,
            _ => 0.0,
        };
        let margin = 2.0 * (settings.side + rates.preform.plate_margin);
        let plate = (wide * self.side + margin) * (deep * self.side + margin);
        Figures::from_volumes(self.volume, volume, plate, 0.0, rates).score()
    }
}

/// The farthest point is kept for one in this many directions.
const EXTREMES: usize = 4;

/// The cells of a row whose middles lie between pairs of crossings.
fn row(ends: &[f64], low: f64, side: f64) -> u128 {
    let cell = |x: f64| ((x - low) / side - 0.5).ceil().clamp(0.0, 127.0) as u32;
    let bits = |ends: &[f64]| (cell(ends[0])..cell(ends[1])).fold(0, |row, x| row | (1_u128 << x));
    ends.chunks_exact(2).map(bits).fold(0, |row, more| row | more)
}

/// Rows without the cells at their edge: those with a free neighbour at a side, or (if `square`) also at a corner.
fn shrunk(rows: &[u128], square: bool) -> Vec<u128> {
    let narrow = |row: u128| row & (row << 1) & (row >> 1);
    let at = |k: Option<usize>| k.and_then(|k| rows.get(k)).copied().unwrap_or(0);
    let one = |k: usize| {
        let (below, above) = (at(k.checked_sub(1)), at(Some(k + 1)));
        let (below, above) = if square { (narrow(below), narrow(above)) } else { (below, above) };
        narrow(rows[k]) & below & above
    };
    (0..rows.len()).map(one).collect()
}
