//! Where passes have laid metal.

use super::block::blocks;
use bead_plan::fill::line_index::cells_along;
use bead_plan::pass::{Pass, Segment};
use glam::DVec2;
use std::cell::Cell;

/// A place this far beyond the edge of a bead, in bead widths, is clear of it: less than a quarter of what is welded
/// there lies on it.
pub(super) const CLEAR: f64 = 0.25;
/// Rounding errors of places are smaller, mm.
const EDGE: f64 = 1e-9;

/// Metal laid by passes.
pub(super) struct Metal {
    cells: Cells,
    /// The beads of each pass, and their blocks.
    beads: Vec<Vec<Bead>>,
    blocks: Vec<(Vec<Bead>, Vec<Option<u32>>)>,
    /// The pass and the bead on which the last place lay: the next place lies on the same one or near it.
    last: Cell<(usize, usize)>,
}

/// A straight bead, mm.
pub(super) struct Bead {
    pub(super) from: DVec2,
    /// Its direction; zero for a dot.
    pub(super) axis: DVec2,
    pub(super) length: f64,
    /// Half its width.
    pub(super) half: f64,
}

impl Bead {
    pub(super) fn of(piece: Segment) -> Self {
        let (from, to) = (piece.from.truncate(), piece.to.truncate());
        Self { from, axis: (to - from).normalize_or_zero(), length: from.distance(to), half: piece.width / 2.0 }
    }

    pub(super) fn to(&self) -> DVec2 {
        self.from + self.axis * self.length
    }

    /// Whether a place is on the bead, or within `reach` (mm) of it.
    fn is_at(&self, p: DVec2, reach: f64) -> bool {
        let (away, half) = (p - self.from, self.half + reach);
        (away - self.axis * away.dot(self.axis).clamp(0.0, self.length)).length_squared() <= half * half
    }

    /// Whether a place is on its straight part.
    fn is_beside(&self, p: DVec2) -> bool {
        let away = p - self.from;
        (0.0..=self.length).contains(&self.axis.dot(away)) && self.axis.perp_dot(away).abs() <= self.half
    }

    /// How far the bead, wider by `reach` (mm) on both sides, surely goes on from a place on it in a direction (of length
    /// 1), mm: until it leaves its straight part.
    fn room(&self, p: DVec2, way: DVec2, reach: f64) -> f64 {
        let until = |place: f64, speed: f64, low: f64, high: f64| match speed {
            0.0 => f64::INFINITY,
            speed => (if speed > 0.0 { high - place } else { low - place }) / speed,
        };
        let (away, half) = (p - self.from, self.half + reach);
        let (foot, speed) = (self.axis.dot(away), self.axis.dot(way));
        let along = until(foot, speed, 0.0, self.length);
        let room = along.min(until(self.axis.perp_dot(away), self.axis.perp_dot(way), -half, half)).max(0.0);
        // A bead is convex, so that what lies between two places on it is on it; a place beyond its end may not be.
        if (-EDGE..=self.length + EDGE).contains(&(foot + room * speed)) && self.length > 0.0 { room } else { 0.0 }
    }
}

impl Metal {
    pub(super) fn of(passes: &[Pass], width: f64) -> Self {
        let beads: Vec<Vec<Bead>> = passes.iter().map(|pass| pass.segments().map(Bead::of).collect()).collect();
        let blocks = beads.iter().map(|beads| blocks(beads)).collect();
        Self { cells: Cells::of(&beads, CLEAR * width), beads, blocks, last: Cell::default() }
    }

    /// How much of the way `ahead` of a place, mm, beads are surely within `reach` (mm, at most a [`CLEAR`] width) of it;
    /// `None` where there is none.
    pub(super) fn room(&self, p: DVec2, ahead: DVec2, reach: f64) -> Option<f64> {
        let mut bead = self.bead_at(p, reach)?;
        let (way, far, mut room) = (ahead.normalize_or_zero(), ahead.length(), 0.0);
        loop {
            let at = p + way * room;
            let block = self.block(bead).filter(|block| block.is_beside(at));
            let (alone, together) =
                (self.beads[bead.0][bead.1].room(at, way, reach), block.map(|b| b.room(at, way, 0.0)));
            let more = alone.max(together.unwrap_or(0.0));
            room += more;
            if more <= EDGE || room >= far {
                return Some(room.min(far));
            }
            match self.bead_at(p + way * room, reach) {
                Some(next) => bead = next,
                None => return Some(room),
            }
        }
    }

    /// The block to which a bead belongs.
    fn block(&self, (pass, bead): (usize, usize)) -> Option<&Bead> {
        let (blocks, of) = self.blocks.get(pass)?;
        of.get(bead).copied().flatten().and_then(|block| blocks.get(block as usize))
    }

    /// The pass and the number in it of a bead within `reach` (mm) of a place.
    fn bead_at(&self, p: DVec2, reach: f64) -> Option<(usize, usize)> {
        let is_at = |(pass, bead): (usize, usize)| {
            self.beads.get(pass).and_then(|beads| beads.get(bead)).is_some_and(|bead| bead.is_at(p, reach))
        };
        let (pass, bead) = self.last.get();
        // Across a zigzag, every second bead is a turn.
        let beside = [2, -2, 0, 1, -1].into_iter().map(|step| (pass, bead.wrapping_add_signed(step)));
        let all = || self.cells.at(p).iter().map(|&(pass, bead)| (pass as usize, bead as usize));
        let found = beside.clone().find(|place| is_at(*place)).or_else(|| all().find(|place| is_at(*place)));
        found.inspect(|place| self.last.set(*place))
    }
}

/// Which beads come near each cell of a grid.
struct Cells {
    low: DVec2,
    /// Side of a cell, mm.
    size: f64,
    columns: usize,
    /// Where each cell begins in `held`, row by row, and the end of the last.
    starts: Vec<u32>,
    /// Passes, and beads in them.
    held: Vec<(u32, u32)>,
}

impl Cells {
    /// Side of a cell, in reaches of a bead.
    const SIDE: f64 = 4.0;

    /// Each cell holds the beads that come within `clear` (mm) of it.
    fn of(beads: &[Vec<Bead>], clear: f64) -> Self {
        let all = || beads.iter().flatten();
        let reach = |bead: &Bead| bead.half + clear + EDGE;
        let widest = all().map(reach).fold(clear + EDGE, f64::max);
        let ends = || all().flat_map(|bead| [bead.from, bead.to()]);
        let low = ends().fold(DVec2::INFINITY, DVec2::min) - widest;
        let extent = ends().fold(DVec2::NEG_INFINITY, DVec2::max) + widest - low;
        if !(extent.is_finite() && extent.cmpge(DVec2::ZERO).all()) {
            return Self { low: DVec2::ZERO, size: 1.0, columns: 0, starts: vec![0], held: Vec::new() };
        }
        // Thinly spread beads have larger cells, so that there are no more cells than entries.
        let length = all().map(|bead| bead.length).sum::<f64>();
        let size = (Self::SIDE * widest).max(extent.x * extent.y / length.max(widest));
        let [columns, rows] = (extent / size).to_array().map(|cells| cells as usize + 1);
        let cells = |bead: &Bead| {
            cells_along(bead.from - low, bead.to() - low, size, reach(bead)).filter_map(move |cell| {
                let (column, row) = (usize::try_from(cell.x).ok()?, usize::try_from(cell.y).ok()?);
                (column < columns && row < rows).then_some(row * columns + column)
            })
        };
        let mut starts = vec![0_u32; columns * rows + 1];
        all().flat_map(cells).for_each(|cell| starts[cell + 1] += 1);
        (0..columns * rows).for_each(|cell| starts[cell + 1] += starts[cell]);
        let mut next = starts.clone();
        let mut held = vec![(0, 0); starts[columns * rows] as usize];
        for (pass, beads) in beads.iter().enumerate() {
            for (number, bead) in beads.iter().enumerate() {
                for cell in cells(bead) {
                    held[next[cell] as usize] = (pass as u32, number as u32);
                    next[cell] += 1;
                }
            }
        }
        Self { low, size, columns, starts, held }
    }

    /// The beads near a place.
    fn at(&self, p: DVec2) -> &[(u32, u32)] {
        let cell = ((p - self.low) / self.size).floor();
        if !(cell.cmpge(DVec2::ZERO).all() && cell.x < self.columns as f64) {
            return &[];
        }
        let cell = cell.y as usize * self.columns + cell.x as usize;
        let range = self.starts.get(cell).zip(self.starts.get(cell + 1));
        range.map_or(&[], |(from, to)| &self.held[*from as usize..*to as usize])
    }
}
