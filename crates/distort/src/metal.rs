//! Which voxels hold metal, and from which step on.

use crate::error::{DistortError, not_too_many};
use crate::grid::Grid;
use crate::input::{Bead, Plate};
use crate::settings::Settings;
use glam::DVec3;
use std::ops::Range;

/// A voxel that beads fill by a smaller fraction is left out.
const LEAST_FILL: f64 = 0.15;
/// Samples of a bead lie this fraction of a voxel apart.
const SPACING: f64 = 0.4;
/// The step of voxels without metal.
pub(crate) const NEVER: u32 = u32::MAX;

/// Voxels of plate and part.
pub(crate) struct Metal {
    pub(crate) grid: Grid,
    /// Stiffness of each voxel when it is there, as a multiple of the part's.
    pub(crate) factors: Vec<f64>,
    /// Step from which each voxel is there; 0 for the plate, the first beads have step 1.
    pub(crate) born: Vec<u32>,
    /// Beads in the order of welding.
    pub(crate) order: Vec<usize>,
    /// The beads of each step, as ranges of `order`.
    pub(crate) steps: Vec<Range<usize>>,
    /// Height of the lattice up to the top of the plate, in voxels.
    pub(crate) plate_top: usize,
    /// The lowest nodes of the plate along z, in voxels.
    pub(crate) plate_bottom: usize,
}

/// A sample of a bead's section.
pub(crate) struct Sample {
    pub(crate) at: DVec3,
    /// Area of the section that it stands for, mm².
    pub(crate) area: f64,
}

/// A short piece of a bead.
pub(crate) struct Piece {
    middle: DVec3,
    /// Length, mm.
    pub(crate) length: f64,
    pub(crate) along: DVec3,
    pub(crate) across: DVec3,
    pub(crate) up: DVec3,
}

/// The middles and lengths, as fractions, of pieces of a line that cross no border between voxels and are no longer than
/// samples lie apart. So lines along the lattice are shared out exactly.
fn cuts(grid: &Grid, from: DVec3, way: DVec3) -> Vec<(f64, f64)> {
    /// Pieces shorter than this fraction are rounding.
    const NOTHING: f64 = 1e-9;
    let (begin, change) = ((from - grid.low) / grid.size, way / grid.size);
    let mut ends = vec![1.0];
    for d in (0..3).filter(|&d| change[d].abs() > NOTHING) {
        let (low, high) = (begin[d].min(begin[d] + change[d]), begin[d].max(begin[d] + change[d]));
        let borders = (low.ceil() as i64)..=(high.floor() as i64);
        ends.extend(borders.map(|border| (border as f64 - begin[d]) / change[d]));
    }
    ends.sort_by(f64::total_cmp);
    let spacing = SPACING * grid.size.min_element();
    let (mut pieces, mut last, length) = (Vec::with_capacity(ends.len()), 0.0, way.length());
    for end in ends {
        if end - last > NOTHING && (end >= 1.0 || 1.0 - end > NOTHING) {
            let count = ((end - last) * length / spacing - NOTHING).ceil().max(1.0);
            let part = (end - last) / count;
            pieces.extend((0..count as usize).map(|i| (last + part * (i as f64 + 0.5), part)));
            last = end;
        }
    }
    pieces
}

/// The pieces of a bead.
pub(crate) fn pieces<'a>(bead: &'a Bead, grid: &'a Grid) -> impl Iterator<Item = Piece> + 'a {
    bead.points.windows(2).flat_map(move |pair| {
        let (from, way) = (pair[0], pair[1] - pair[0]);
        let along = way.normalize_or_zero();
        let across = bead.up.cross(along).try_normalize().unwrap_or_else(|| along.any_orthonormal_vector());
        let (up, length) = (along.cross(across), way.length());
        let piece = move |(middle, part): (f64, f64)| Piece {
            middle: from + middle * way,
            length: part * length,
            along,
            across,
            up,
        };
        cuts(grid, from, way).into_iter().map(piece)
    })
}

impl Piece {
    /// Samples of a rectangle of the section, `width` wide and from one depth below the top to another, mm.
    pub(crate) fn samples<'a>(
        &self,
        grid: &'a Grid,
        width: f64,
        depths: Range<f64>,
    ) -> impl Iterator<Item = Sample> + 'a {
        let depth = depths.end - depths.start;
        let corner = self.middle - 0.5 * width * self.across - depths.start * self.up;
        let (beside, down) = (width * self.across, -depth * self.up);
        // Cut along its middle, so that voxels above each other are shared out alike.
        cuts(grid, corner + 0.5 * down, beside).into_iter().flat_map(move |(side, wide)| {
            let top = corner + side * beside;
            let sample =
                move |(row, deep): (f64, f64)| Sample { at: top + row * down, area: wide * deep * width * depth };
            cuts(grid, top, down).into_iter().map(sample)
        })
    }
}

impl Metal {
    pub(crate) fn new(plate: &Plate, beads: &[Bead], settings: &Settings) -> Result<Self, DistortError> {
        let (grid, first, counts) = lattice(plate, beads, settings)?;
        let mut order: Vec<usize> = (0..beads.len()).collect();
        order.sort_by(|&a, &b| beads[a].start.total_cmp(&beads[b].start));
        let steps = steps(&order, beads, settings.most_steps);
        let mut metal = Self {
            factors: vec![0.0; grid.voxels()],
            born: vec![NEVER; grid.voxels()],
            plate_bottom: first[2],
            plate_top: first[2] + counts[2],
            grid,
            order,
            steps,
        };
        metal.fill(beads);
        metal.fill_plate(plate, first, counts);
        Ok(metal)
    }

    fn fill_plate(&mut self, plate: &Plate, first: [usize; 3], counts: [usize; 3]) {
        for voxel in 0..self.grid.voxels() {
            let at = self.grid.voxel_at(voxel);
            if (0..3).all(|d| (first[d]..first[d] + counts[d]).contains(&at[d])) {
                self.factors[voxel] = plate.stiffness;
                self.born[voxel] = 0;
            }
        }
    }

    /// A voxel is there from the step on in which half of its metal is.
    fn fill(&mut self, beads: &[Bead]) {
        let volume = self.grid.volume();
        let mut filled = vec![0.0; self.grid.voxels()];
        self.each_sample(beads, |_, voxel, metal| filled[voxel] += metal / volume);
        let mut so_far = vec![0.0; filled.len()];
        let mut born = vec![NEVER; filled.len()];
        self.each_sample(beads, |step, voxel, metal| {
            so_far[voxel] += metal / volume;
            if born[voxel] == NEVER && filled[voxel] >= LEAST_FILL && so_far[voxel] >= 0.5 * filled[voxel] {
                born[voxel] = step;
            }
        });
        for ((factor, filled), &born) in self.factors.iter_mut().zip(filled).zip(&born) {
            *factor = if born == NEVER { 0.0 } else { f64::min(filled, 1.0) };
        }
        self.born = born;
    }

    /// Calls `visit` with step, voxel and volume (mm³) of all samples of all beads, in the order of welding.
    fn each_sample(&self, beads: &[Bead], mut visit: impl FnMut(u32, usize, f64)) {
        for (step, range) in self.steps.iter().enumerate() {
            for &bead in &self.order[range.clone()] {
                let bead = &beads[bead];
                for piece in pieces(bead, &self.grid) {
                    for sample in piece.samples(&self.grid, bead.width, 0.0..bead.height) {
                        if let Some(voxel) = self.grid.voxel_of(sample.at) {
                            visit(step as u32 + 1, voxel, sample.area * piece.length);
                        }
                    }
                }
            }
        }
    }
}

/// The lattice around plate and beads, with the plate's first voxel and numbers of voxels.
fn lattice(plate: &Plate, beads: &[Bead], settings: &Settings) -> Result<(Grid, [usize; 3], [usize; 3]), DistortError> {
    let wanted = DVec3::new(settings.voxel, settings.voxel, settings.voxel_height);
    let along = (plate.size() / wanted).round().max(DVec3::ONE);
    let size = plate.size() / along;
    let (mut low, mut high) = (plate.low, plate.high);
    for bead in beads {
        let beside = (DVec3::ONE - bead.up * bead.up).max(DVec3::ZERO).map(f64::sqrt);
        let reach = 0.5 * (bead.width * beside + bead.height * bead.up.abs());
        for &point in &bead.points {
            // A bead reaches down from its points.
            let middle = point - 0.5 * bead.height * bead.up;
            (low, high) = (low.min(middle - reach), high.max(middle + reach));
        }
    }
    // Half a sample of slack, so that beads that end on a border between voxels ask for no further one.
    let before = ((plate.low - low) / size - 0.01).ceil().max(DVec3::ZERO);
    let after = ((high - plate.high) / size - 0.01).ceil().max(DVec3::ZERO);
    let total = before + along + after;
    let counts = total.to_array().map(|n| if n < 1e9 { n as usize } else { usize::MAX });
    let grid = Grid { counts, size, low: plate.low - before * size };
    not_too_many(&grid)?;
    Ok((grid, before.to_array().map(|n| n as usize), along.to_array().map(|n| n as usize)))
}

/// Beads in the order of welding in groups of about the same volume.
fn steps(order: &[usize], beads: &[Bead], most: usize) -> Vec<Range<usize>> {
    if order.len() <= most {
        return (0..order.len()).map(|i| i..i + 1).collect();
    }
    let total: f64 = beads.iter().map(Bead::volume).sum();
    let (mut steps, mut begin, mut laid): (Vec<Range<usize>>, _, _) = (Vec::new(), 0, 0.0);
    for (i, &bead) in order.iter().enumerate() {
        laid += beads[bead].volume();
        let due = laid >= total * (steps.len() + 1) as f64 / most as f64 * (1.0 - 1e-12);
        if due || i + 1 == order.len() {
            steps.push(begin..i + 1);
            begin = i + 1;
        }
    }
    steps
}
