//! Neighbouring lines of a zigzag as one wide bead, so that what crosses hundreds of them need not look at each.

use super::metal::Bead;
use glam::DVec2;

/// Lines of a block: with more of them, less lies on all.
const LINES: usize = 32;
/// Lines are parallel if their ends lie apart across by less than this, in bead widths.
const PARALLEL: f64 = 1e-3;

/// The blocks of a pass, and the number of the block of each bead, if it has one.
pub(super) fn blocks(beads: &[Bead]) -> (Vec<Bead>, Vec<Option<u32>>) {
    let (mut blocks, mut of) = (Vec::new(), vec![None; beads.len()]);
    let mut close = |open: Option<Block>, lines: &mut Vec<usize>| {
        if let Some(block) = open.filter(|_| lines.len() > 2) {
            lines.iter().for_each(|line| of[*line] = Some(blocks.len() as u32));
            blocks.push(block.bead());
        }
        lines.clear();
    };
    let (mut open, mut lines) = (None::<Block>, Vec::new());
    for (number, bead) in beads.iter().enumerate() {
        // A turn, or a dot.
        if bead.length <= 2.0 * bead.half {
            continue;
        }
        let extended = open.as_ref().filter(|_| lines.len() < LINES).and_then(|block| block.extended(bead));
        if extended.is_none() {
            close(open.take(), &mut lines);
        }
        open = Some(extended.unwrap_or_else(|| Block::of(bead)));
        lines.push(number);
    }
    close(open, &mut lines);
    (blocks, of)
}

/// Parallel lines, each beside the one before and touching it: the rectangle that lies on all of them.
struct Block {
    /// Where the first line begins, its direction, and that in which the lines follow one another, of length 1; unknown
    /// for a single line.
    from: DVec2,
    axis: DVec2,
    across: Option<DVec2>,
    /// From and to, along and across, mm.
    low: DVec2,
    high: DVec2,
}

impl Block {
    fn of(line: &Bead) -> Self {
        let (low, high) = (DVec2::new(0.0, -line.half), DVec2::new(line.length, line.half));
        Self { from: line.from, axis: line.axis, across: None, low, high }
    }

    /// The block with one more line; `None` if that does not continue it.
    fn extended(&self, line: &Bead) -> Option<Self> {
        let ends = [line.from, line.to()].map(|end| end - self.from);
        let left = self.axis.perp();
        let across = self.across.unwrap_or_else(|| if left.dot(ends[0]) > 0.0 { left } else { -left });
        let [one, other] = ends.map(|end| DVec2::new(self.axis.dot(end), across.dot(end)));
        let (low, high) = (one.min(other), one.max(other));
        let parallel = high.y - low.y < 2.0 * PARALLEL * line.half;
        let touches = high.y - line.half <= self.high.y && low.y + line.half > self.high.y;
        let along = self.low.x.max(low.x)..self.high.x.min(high.x);
        (parallel && touches && !along.is_empty()).then_some(Self {
            across: Some(across),
            low: DVec2::new(along.start, self.low.y),
            high: DVec2::new(along.end, low.y + line.half),
            ..*self
        })
    }

    fn bead(&self) -> Bead {
        let middle = self.across.unwrap_or_default() * f64::midpoint(self.low.y, self.high.y);
        let (length, half) = (self.high.x - self.low.x, (self.high.y - self.low.y) / 2.0);
        Bead { from: self.from + self.axis * self.low.x + middle, axis: self.axis, length, half }
    }
}
