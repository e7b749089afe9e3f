//! Straight pieces in bands, so that those that may meet are found without comparing all with all.
//!
//! The bands run along the longest piece. Scan lines then lie in one band each and meet little else there, while their
//! boxes along x and y would cover each other wherever they run aslant.

use glam::DVec2;
use std::ops::Range;

/// From one point to another, mm.
pub type Piece = [DVec2; 2];

/// Boxes are larger than their pieces by this part of the extent of all, so that rounding loses none.
const ROUNDING: f64 = 1e-9;

/// Pieces sorted into bands.
pub struct Bands {
    /// Direction of the bands.
    axis: DVec2,
    /// Where the first band begins, mm across the axis, and how many bands a millimetre has.
    low: f64,
    per_mm: f64,
    /// The pieces in the frame of the axis.
    pieces: Vec<Piece>,
    /// Where each band begins in `items`.
    starts: Vec<usize>,
    /// The pieces of each band, by the place where they begin along it.
    items: Vec<Item>,
}

/// The number of a piece, and a box a little larger than it in the frame of the axis.
#[derive(Clone, Copy, Default)]
struct Item {
    low: DVec2,
    high: DVec2,
    number: u32,
}

impl Bands {
    /// Sorts finite pieces.
    pub fn new(mut pieces: Vec<Piece>) -> Self {
        let square = |[a, b]: &Piece| a.distance_squared(*b);
        let longest = pieces.iter().max_by(|a, b| square(a).total_cmp(&square(b)));
        let axis = longest.map_or(DVec2::ZERO, |[a, b]| *b - *a).try_normalize().unwrap_or(DVec2::X);
        pieces.iter_mut().flatten().for_each(|p| *p = turned(axis, *p));
        let (low, high) = pieces.iter().flatten().fold((DVec2::MAX, DVec2::MIN), |(l, h), p| (l.min(*p), h.max(*p)));
        let size = (high - low).max(DVec2::ZERO);
        let rounding = ROUNDING * (low.abs().max(high.abs())).max_element().max(1.0);
        let count = pieces.len().max(1) as f64;
        // As wide as a piece reaches across on the average, so that each lies in few bands, and each band holds few.
        let mean = pieces.iter().map(|[a, b]| (a.y - b.y).abs()).sum::<f64>() / count;
        let width = mean.max(size.y / count).max(2.0 * rounding);
        let mut bands = Self { axis, low: low.y, per_mm: width.recip(), pieces, starts: Vec::new(), items: Vec::new() };
        bands.sort(rounding, (size.y / width) as usize + 1);
        bands
    }

    fn sort(&mut self, rounding: f64, count: usize) {
        let item = |(number, &[a, b]): (usize, &Piece)| {
            let (low, high) = (a.min(b) - rounding, a.max(b) + rounding);
            let bands = self.band(low.y).min(count - 1)..self.band(high.y).min(count - 1) + 1;
            (Item { low, high, number: number as u32 }, bands)
        };
        let all: Vec<(Item, Range<usize>)> = self.pieces.iter().enumerate().map(item).collect();
        let mut starts = vec![0; count + 2];
        for (_, bands) in &all {
            starts[bands.start + 2..bands.end + 2].iter_mut().for_each(|held| *held += 1);
        }
        for i in 2..starts.len() {
            starts[i] += starts[i - 1];
        }
        let mut items = vec![Item::default(); starts[count + 1]];
        for (item, bands) in all {
            for next in &mut starts[bands.start + 1..bands.end + 1] {
                items[*next] = item;
                *next += 1;
            }
        }
        starts.pop();
        for band in starts.windows(2) {
            let by_begin = |a: &Item, b: &Item| a.low.x.total_cmp(&b.low.x).then(a.number.cmp(&b.number));
            items[band[0]..band[1]].sort_unstable_by(by_begin);
        }
        (self.starts, self.items) = (starts, items);
    }

    fn band(&self, y: f64) -> usize {
        ((y - self.low) * self.per_mm).max(0.0) as usize
    }

    /// Visits every pair of pieces whose boxes meet, once.
    pub fn pairs(&self, mut visit: impl FnMut(usize, usize)) {
        let last = self.starts.len() - 2;
        for (band, range) in self.starts.windows(2).enumerate() {
            let items = &self.items[range[0]..range[1]];
            for (k, one) in items.iter().enumerate() {
                for other in items[k + 1..].iter().take_while(|other| other.low.x <= one.high.x) {
                    let start = one.low.y.max(other.low.y);
                    // Of the bands that both lie in, only the first one counts.
                    if start <= one.high.y.min(other.high.y) && self.band(start).min(last) == band {
                        visit(one.number as usize, other.number as usize);
                    }
                }
            }
        }
    }

    /// The pieces whose interior reaches across the height of a point before it along the axis.
    fn before(&self, point: DVec2) -> impl Iterator<Item = usize> {
        let p = turned(self.axis, point);
        let band = self.band(p.y);
        let range = self.starts.get(band..band + 2).map_or(0..0, |range| range[0]..range[1]);
        let crosses = move |&number: &usize| {
            let [a, b] = self.pieces[number];
            (a.y > p.y) != (b.y > p.y) && p.x > (b.x - a.x) * (p.y - a.y) / (b.y - a.y) + a.x
        };
        let before = self.items[range].iter().take_while(move |item| item.low.x <= p.x);
        before.map(|item| item.number as usize).filter(crosses)
    }

    /// Whether a point lies inside the rings that the first `edges` pieces are the edges of, by winding parity.
    pub fn inside(&self, point: DVec2, edges: usize) -> bool {
        self.before(point).filter(|&number| number < edges).count() % 2 == 1
    }

    /// How far a piece rises across the axis.
    pub(crate) fn rise(&self, [a, b]: Piece) -> f64 {
        self.axis.perp_dot(b - a)
    }

    /// How often closed rings, whose edges are the pieces, wind around the place just before a point along the axis that lies
    /// on a piece.
    pub(crate) fn winding_before(&self, point: DVec2, on: usize) -> i32 {
        let others = self.before(point).filter(|&number| number != on);
        others.map(|number| if self.pieces[number][1].y > self.pieces[number][0].y { -1 } else { 1 }).sum()
    }
}

fn turned(axis: DVec2, p: DVec2) -> DVec2 {
    DVec2::new(p.dot(axis), axis.perp_dot(p))
}

#[cfg(test)]
mod tests {
    use super::Bands;
    use glam::DVec2;
    use std::collections::BTreeSet;

    /// Pieces of every length and direction, from a fixed sequence.
    fn pieces(count: usize) -> Vec<[DVec2; 2]> {
        let mut state = 1_u64;
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 40) as f64 / f64::from(1 << 24)
        };
        let mut piece = || {
            let (at, way) = (DVec2::new(next(), next()) * 100.0, DVec2::new(next(), next()) - 0.5);
            [at, at + way * 60.0 * next().powi(3)]
        };
        (0..count).map(|_| piece()).collect()
    }

    #[test]
    fn every_pair_that_crosses_is_visited_once() {
        let pieces = pieces(400);
        let side = |a: DVec2, b: DVec2, p: DVec2| (b - a).perp_dot(p - a);
        let crosses = |i: usize, j: usize| {
            let ([a, b], [c, d]) = (pieces[i], pieces[j]);
            side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0
        };
        let all = (0..pieces.len()).flat_map(|i| (0..i).map(move |j| (j, i)));
        let crossing: BTreeSet<_> = all.filter(|&(i, j)| crosses(i, j)).collect();
        let (mut visited, mut visits) = (BTreeSet::new(), 0);
        Bands::new(pieces.clone()).pairs(|i, j| {
            visits += 1;
            visited.insert((i.min(j), i.max(j)));
        });
        assert_eq!(visits, visited.len(), "a pair was visited twice");
        assert!(crossing.len() > 100 && crossing.is_subset(&visited), "{} crossings", crossing.len());
    }

    #[test]
    fn inside_agrees_with_the_polygon() {
        let ring: Vec<DVec2> =
            (0..40).map(|k| DVec2::from_angle(f64::from(k) * 0.157) * f64::from(5 + k % 3 * 4)).collect();
        let polygon = crate::Ring::new(ring);
        let bands = Bands::new(polygon.edges().map(|(a, b)| [a, b]).collect());
        let places = pieces(500).into_iter().map(|[p, _]| p * 0.3 - 15.0);
        let (mut inside, mut total) = (0, 0);
        for place in places {
            assert_eq!(bands.inside(place, 40), polygon.contains(place), "{place}");
            inside += usize::from(polygon.contains(place));
            total += 1;
        }
        assert!(inside > 50 && inside < total);
    }
}
