//! Points sorted into squares, to find those near a place.

use glam::{DVec2, I64Vec2};

/// Points by the square in which they lie.
pub struct Squares {
    side: f64,
    /// The lowest square, and how many there are in x and y.
    low: I64Vec2,
    size: I64Vec2,
    /// Where the points of each square begin in `points`, and one past the last.
    starts: Vec<u32>,
    points: Vec<u32>,
}

impl Squares {
    /// Sorts points into squares with sides of this length, mm.
    pub fn of(points: &[DVec2], side: f64) -> Self {
        let square = |p: &DVec2| (*p / side).floor().as_i64vec2();
        let low = points.iter().map(square).reduce(|a, b| a.min(b)).unwrap_or_default();
        let high = points.iter().map(square).reduce(|a, b| a.max(b)).unwrap_or_default();
        let size = high - low + 1;
        let index = |p: &DVec2| {
            let square = square(p) - low;
            (square.y * size.x + square.x) as usize
        };
        let mut starts = vec![0_u32; (size.x * size.y) as usize + 1];
        points.iter().for_each(|p| starts[index(p) + 1] += 1);
        (1..starts.len()).for_each(|i| starts[i] += starts[i - 1]);
        let (mut next, mut sorted) = (starts.clone(), vec![0_u32; points.len()]);
        for (number, p) in (0..).zip(points) {
            let place = &mut next[index(p)];
            sorted[*place as usize] = number;
            *place += 1;
        }
        Self { side, low, size, starts, points: sorted }
    }

    /// The points in the square of a place and in the squares around it: all that lie within a side of it, and some more.
    pub fn near(&self, p: DVec2) -> impl Iterator<Item = usize> + '_ {
        let home = (p / self.side).floor().as_i64vec2() - self.low;
        let low = (home - 1).max(I64Vec2::ZERO);
        // One past the last; the squares of a row lie one behind the other.
        let high = (home + 2).min(self.size).max(low);
        let start = |x: i64, y: i64| self.starts[(y * self.size.x + x) as usize] as usize;
        let rows = if low.x < high.x { low.y..high.y } else { 0..0 };
        let ranges = rows.map(move |y| start(low.x, y)..start(high.x, y));
        ranges.flat_map(|range| &self.points[range]).map(|&point| point as usize)
    }
}
