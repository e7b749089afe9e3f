//! Whether a disc fits into a polygon: a search over squares, cheaper than an offset where the answer is clear.

use crate::polyline::distance_squared_to_segment;
use crate::{Bounds, Join, Polygon};
use glam::DVec2;
use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// Squares examined before an offset decides.
const MOST_SQUARES: usize = 300;

/// A square of the search, and the largest disc that can be centred in it.
struct Square {
    middle: DVec2,
    /// Half its side, mm.
    half: f64,
    /// Upper bound on the radius of a disc centred in the square, mm.
    bound: f64,
}

impl Ord for Square {
    fn cmp(&self, other: &Self) -> Ordering {
        self.bound.total_cmp(&other.bound)
    }
}

impl PartialOrd for Square {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Square {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Square {}

impl Polygon {
    /// Whether a disc of this radius (mm) fits inside: whether an inward offset by the radius leaves anything.
    pub fn holds_disc(&self, radius: f64) -> bool {
        let Some(bounds) = Bounds::of(self.outer.points().iter().copied()) else { return false };
        let size = bounds.max - bounds.min;
        let half = size.min_element() / 2.0;
        if half < radius {
            return false;
        }
        let (columns, rows) = ((size.x / (2.0 * half)).ceil(), (size.y / (2.0 * half)).ceil());
        if columns * rows > MOST_SQUARES as f64 {
            return self.leaves_something(radius);
        }
        let mut squares = BinaryHeap::new();
        for (i, j) in (0..columns as usize).flat_map(|i| (0..rows as usize).map(move |j| (i, j))) {
            let middle = bounds.min + half * DVec2::new((2 * i + 1) as f64, (2 * j + 1) as f64);
            squares.push(self.square(middle, half));
        }
        for _ in 0..MOST_SQUARES {
            let Some(Square { middle, half, bound }) = squares.pop() else { return false };
            if bound - half * std::f64::consts::SQRT_2 >= radius {
                return true;
            }
            if bound < radius {
                return false;
            }
            let quarter = half / 2.0;
            for side in [DVec2::ONE, -DVec2::ONE, DVec2::new(1.0, -1.0), DVec2::new(-1.0, 1.0)] {
                squares.push(self.square(middle + quarter * side, quarter));
            }
        }
        self.leaves_something(radius)
    }

    fn leaves_something(&self, radius: f64) -> bool {
        !self.offset(-radius, Join::ROUND).is_empty()
    }

    fn square(&self, middle: DVec2, half: f64) -> Square {
        let edges = self.rings().flat_map(|ring| ring.edges());
        let square = edges.map(|(a, b)| distance_squared_to_segment(middle, a, b)).fold(f64::INFINITY, f64::min);
        let room = if self.contains(middle) { square.sqrt() } else { -square.sqrt() };
        Square { middle, half, bound: room + half * std::f64::consts::SQRT_2 }
    }
}

#[cfg(test)]
mod tests {
    use crate::{Polygon, Ring};
    use glam::DVec2;

    fn star(points: usize, inner: f64, outer: f64, turn: f64) -> Polygon {
        let at = |k: usize| {
            let radius = if k.is_multiple_of(2) { outer } else { inner };
            DVec2::from_angle(turn + k as f64 * std::f64::consts::PI / points as f64) * radius + DVec2::new(71.0, -13.0)
        };
        Polygon::simple(Ring::new((0..2 * points).map(at).collect()))
    }

    fn rectangle(a: f64, b: f64, turn: f64) -> Polygon {
        let corners = [(a, b), (-a, b), (-a, -b), (a, -b)];
        Polygon::simple(Ring::new(corners.map(|(x, y)| DVec2::from_angle(turn).rotate(DVec2::new(x, y))).to_vec()))
    }

    #[test]
    fn the_largest_disc_of_rectangles_and_rings() {
        for turn in [0.0, 0.3, 1.1] {
            for (a, b) in [(10.0, 1.0), (1.0, 400.0), (5.0, 5.0)] {
                let part = rectangle(a, b, turn);
                assert!(
                    part.holds_disc(0.99 * f64::min(a, b)) && !part.holds_disc(1.01 * f64::min(a, b)),
                    "{a} {b} {turn}"
                );
            }
            let mut ring = rectangle(10.0, 10.0, turn);
            ring.holes.push(rectangle(8.0, 8.0, turn).outer.reversed());
            // The largest disc lies in a corner: a diagonal of the gap is (1 + √2) radii.
            let most = 2.0 * std::f64::consts::SQRT_2 / (1.0 + std::f64::consts::SQRT_2);
            assert!(ring.holds_disc(0.99 * most) && !ring.holds_disc(1.01 * most));
        }
        assert!(!Polygon::simple(Ring::new(Vec::new())).holds_disc(1.0));
    }

    #[test]
    fn agrees_with_the_offset() {
        for points in [3, 5, 12] {
            for inner in [0.5, 3.0, 8.0] {
                let part = star(points, inner, 10.0, 0.7);
                for k in 1..40 {
                    let radius = 0.25 * f64::from(k);
                    assert_eq!(part.holds_disc(radius), part.leaves_something(radius), "{points} {inner} {radius}");
                }
            }
        }
    }
}
