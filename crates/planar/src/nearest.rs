//! Which of many segments is nearest to each point of a lattice: distance fields and Voronoi cells.
//!
//! The distance to a segment is measured at the points beside it; from there the nearest segment spreads from point to
//! neighbouring point, in two sweeps over the rows (Danielsson 1980, with segments in place of points). It spreads only
//! over the wanted points: segments beyond a gap of unwanted points are not seen. The distance to the segment found is
//! exact; in rare places, where three Voronoi cells meet, another segment may be nearer, by less than half a step.

use crate::lattice::Lattice;
use glam::{DVec2, Vec2};

/// No segment is known.
pub const NONE: u32 = u32::MAX;

/// The nearest segment of each wanted point.
#[derive(Debug, Clone, PartialEq)]
pub struct Nearest {
    /// Index of the segment, or [`NONE`].
    pub segment: Vec<u32>,
    /// Distance to it, mm; infinite where none is known.
    pub distance: Vec<f32>,
}

#[derive(Clone, Copy)]
struct Segment {
    from: Vec2,
    way: Vec2,
    inverse: f32,
}

impl Segment {
    /// Relative to the lattice's middle, to keep numbers small enough for 32-bit floats.
    fn new(a: DVec2, b: DVec2, lattice: &Lattice) -> Self {
        let way = (b - a).as_vec2();
        let square = way.length_squared();
        Self { from: (a - lattice.middle).as_vec2(), way, inverse: if square > 0.0 { 1.0 / square } else { 0.0 } }
    }

    #[inline]
    fn foot(&self, p: Vec2) -> Vec2 {
        let t = ((p - self.from).dot(self.way) * self.inverse).clamp(0.0, 1.0);
        self.from + self.way * t
    }

    #[inline]
    fn square_to(&self, p: Vec2) -> f32 {
        p.distance_squared(self.foot(p))
    }
}

/// The nearest of `segments` (mm) to each point for which `wanted` holds.
pub fn nearest(lattice: &Lattice, segments: &[(DVec2, DVec2)], wanted: &[bool]) -> Nearest {
    let mut sweep = Sweep {
        columns: lattice.columns,
        low: (lattice.low() - lattice.middle).as_vec2(),
        step: lattice.step as f32,
        segments: segments.iter().map(|&(a, b)| Segment::new(a, b, lattice)).collect(),
        nearest: vec![NONE; lattice.len()],
        square: vec![f32::INFINITY; lattice.len()],
        wanted,
    };
    sweep.seed(lattice, segments);
    for row in 0..lattice.rows {
        sweep.row(row, row.checked_sub(1));
    }
    for row in (0..lattice.rows).rev() {
        sweep.row(row, Some(row + 1).filter(|&r| r < lattice.rows));
    }
    let distance = sweep.square.iter().map(|square| square.sqrt()).collect();
    Nearest { segment: sweep.nearest, distance }
}

struct Sweep<'a> {
    columns: usize,
    low: Vec2,
    step: f32,
    segments: Vec<Segment>,
    nearest: Vec<u32>,
    square: Vec<f32>,
    wanted: &'a [bool],
}

impl Sweep<'_> {
    fn place(&self, column: usize, row: usize) -> Vec2 {
        self.low + Vec2::new(column as f32, row as f32) * self.step
    }

    /// Measures the points beside each segment.
    fn seed(&mut self, lattice: &Lattice, segments: &[(DVec2, DVec2)]) {
        for (number, &(a, b)) in segments.iter().enumerate() {
            let (from, to) = (lattice.in_steps(a), lattice.in_steps(b));
            let count = ((to - from).abs().max_element() * 1.5).ceil().max(1.0) as usize;
            for k in 0..=count {
                // Also on both sides of a segment that lies on a row of points: those on one side may not be wanted.
                let point = from.lerp(to, k as f64 / count as f64).round();
                for (dx, dy) in [-1.0, 0.0, 1.0].into_iter().flat_map(|dx| [-1.0, 0.0, 1.0].map(|dy| (dx, dy))) {
                    let at = point + DVec2::new(dx, dy);
                    let inside =
                        at.cmpge(DVec2::ZERO).all() && at.x < lattice.columns as f64 && at.y < lattice.rows as f64;
                    if inside {
                        self.offer(at.x as usize, at.y as usize, number as u32);
                    }
                }
            }
        }
    }

    #[inline]
    fn offer(&mut self, column: usize, row: usize, number: u32) {
        let i = row * self.columns + column;
        if self.wanted[i] && self.nearest[i] != number {
            let square = self.segments[number as usize].square_to(self.place(column, row));
            if square < self.square[i] {
                self.square[i] = square;
                self.nearest[i] = number;
            }
        }
    }

    /// Takes over the nearest segments from the neighbouring row, then along the row both ways.
    fn row(&mut self, row: usize, beside: Option<usize>) {
        let columns = self.columns;
        if let Some(beside) = beside {
            for column in 0..columns {
                if !self.wanted[row * columns + column] {
                    continue;
                }
                let mut last = NONE;
                for other in column.saturating_sub(1)..(column + 2).min(columns) {
                    let number = self.nearest[beside * columns + other];
                    if number != NONE && number != last {
                        self.offer(column, row, number);
                        last = number;
                    }
                }
            }
        }
        for column in 1..columns {
            self.take(column, row, column - 1);
        }
        for column in (1..columns).rev() {
            self.take(column - 1, row, column);
        }
    }

    #[inline]
    fn take(&mut self, column: usize, row: usize, from: usize) {
        let number = self.nearest[row * self.columns + from];
        if number != NONE {
            self.offer(column, row, number);
        }
    }
}

/// The point of a segment that is nearest to `p`.
pub fn foot((a, b): (DVec2, DVec2), p: DVec2) -> DVec2 {
    let way = b - a;
    let square = way.length_squared();
    let t = if square > 0.0 { ((p - a).dot(way) / square).clamp(0.0, 1.0) } else { 0.0 };
    a + way * t
}

#[cfg(test)]
mod tests {
    use super::nearest;
    use crate::lattice::Lattice;
    use crate::{Bounds, Ring};
    use glam::{DVec2, dvec2};

    /// Rectangles whose edges lie on rows and columns of the lattice, and half-way between them.
    #[test]
    fn every_edge_is_seen_from_inside() {
        let sizes = (4..40).flat_map(|columns| [1, 2, 3, 8].map(|of| (columns, 3 + columns / of)));
        for (columns, rows) in sizes {
            let half = 0.1875 * dvec2(f64::from(columns), f64::from(rows));
            let corners = [-half, dvec2(half.x, -half.y), half, dvec2(-half.x, half.y)];
            for turn in 0..4 {
                let mut corners = corners;
                corners.rotate_left(turn);
                let ring = Ring::new(corners.to_vec());
                let lattice = Lattice::covering(&Bounds { min: -half, max: half }, 0.75, 0.375, 4);
                let inside = lattice.inside([&ring]);
                let near = nearest(&lattice, &ring.edges().collect::<Vec<_>>(), &inside);
                for i in (0..lattice.len()).filter(|i| inside[*i]) {
                    let room: DVec2 = half - lattice.place_of(i).abs();
                    assert!((f64::from(near.distance[i]) - room.min_element()).abs() < 1e-4, "{}", lattice.place_of(i));
                }
            }
        }
    }
}
