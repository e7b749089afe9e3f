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
    /// Where the first band begins and how wide each is, mm across the axis.
    low: f64,
    width: f64,
    /// The pieces in the frame of the axis.
    pieces: Vec<Piece>,
    rounding: f64,
    /// Where each band begins in `items`.
    starts: Vec<usize>,
    /// The pieces of each band, by the place where they begin along it.
    items: Vec<u32>,
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
        let mut bands = Self { axis, low: low.y, width, pieces, rounding, starts: Vec::new(), items: Vec::new() };
        bands.sort((size.y / width) as usize + 1);
        bands
    }

    fn sort(&mut self, count: usize) {
        let mut starts = vec![0; count + 2];
        for band in (0..self.pieces.len()).flat_map(|i| self.bands_of(i)) {
            starts[band.min(count - 1) + 2] += 1;
        }
        for i in 2..starts.len() {
            starts[i] += starts[i - 1];
        }
        let mut items = vec![0; starts[count + 1]];
        for i in 0..self.pieces.len() {
            for band in self.bands_of(i) {
                let at = &mut starts[band.min(count - 1) + 1];
                items[*at] = i as u32;
                *at += 1;
            }
        }
        starts.pop();
        let begin = |i: &u32| self.along(*i as usize).start;
        for band in starts.windows(2) {
            items[band[0]..band[1]].sort_unstable_by(|a, b| begin(a).total_cmp(&begin(b)).then(a.cmp(b)));
        }
        (self.starts, self.items) = (starts, items);
    }

    fn band(&self, y: f64) -> usize {
        ((y - self.low) / self.width).max(0.0) as usize
    }

    fn bands_of(&self, piece: usize) -> Range<usize> {
        let across = self.across(piece);
        self.band(across.start)..self.band(across.end) + 1
    }

    fn along(&self, piece: usize) -> Range<f64> {
        let [a, b] = self.pieces[piece];
        a.x.min(b.x) - self.rounding..a.x.max(b.x) + self.rounding
    }

    fn across(&self, piece: usize) -> Range<f64> {
        let [a, b] = self.pieces[piece];
        a.y.min(b.y) - self.rounding..a.y.max(b.y) + self.rounding
    }

    /// Visits every pair of pieces whose boxes meet, once.
    pub fn pairs(&self, mut visit: impl FnMut(usize, usize)) {
        for (band, range) in self.starts.windows(2).enumerate() {
            let items = &self.items[range[0]..range[1]];
            for (k, &i) in items.iter().enumerate() {
                let (i, end, across) = (i as usize, self.along(i as usize).end, self.across(i as usize));
                for j in items[k + 1..].iter().map(|&j| j as usize).take_while(|&j| self.along(j).start <= end) {
                    let other = self.across(j);
                    let start = across.start.max(other.start);
                    // Of the bands that both lie in, only the first one counts.
                    if start <= across.end.min(other.end) && self.band(start).min(self.starts.len() - 2) == band {
                        visit(i, j);
                    }
                }
            }
        }
    }

    /// Whether a point lies inside the rings that the first `edges` pieces are the edges of, by winding parity.
    pub fn inside(&self, point: DVec2, edges: usize) -> bool {
        let (p, band) = (turned(self.axis, point), self.band(turned(self.axis, point).y));
        let Some(range) = self.starts.get(band..band + 2) else { return false };
        let before = self.items[range[0]..range[1]].iter().map(|&i| i as usize);
        let before = before.take_while(|&i| self.along(i).start <= p.x).filter(|&i| i < edges);
        let crosses = |i: usize| {
            let [a, b] = self.pieces[i];
            (a.y > p.y) != (b.y > p.y) && p.x > (b.x - a.x) * (p.y - a.y) / (b.y - a.y) + a.x
        };
        before.filter(|&i| crosses(i)).count() % 2 == 1
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
