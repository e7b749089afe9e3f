//! What beads leave bare, by their footprints: each piece of a path covers half a width to both sides and
//! around its ends. Measured on rows across the region, exact along each row.

use super::Path;
use glam::DVec2;
use planar::{Bounds, Region};

/// Rows in a bead's width.
const ROWS: f64 = 16.0;
/// Beads count as wider by this fraction: neighbours that just touch leave nothing.
const TOUCHING: f64 = 0.01;

/// The part of a region that no bead covers.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Bare {
    /// mm²
    pub area: f64,
    /// Middle of its widest place, mm.
    pub place: DVec2,
}

/// What passes leave bare of a region; `width` is the nominal bead's, mm.
pub fn bare(paths: &[&Path], region: &Region, width: f64) -> Bare {
    let outlines = region.polygons().iter().flat_map(|island| island.outer.points().iter().copied());
    let Some(bounds) = Bounds::of(outlines) else { return Bare::default() };
    let count = (ROWS * bounds.size().y / width).ceil().max(ROWS) as usize;
    let step = bounds.size().y / count as f64;
    let first = bounds.min.y + step / 2.0;
    let mut covered: Vec<Vec<(f64, f64)>> = vec![Vec::new(); count];
    for path in paths {
        let line = path.path();
        for (i, ends) in line.windows(2).enumerate() {
            let strip = Strip::new(ends[0], ends[1], path.width.after(i) * (0.5 + TOUCHING / 2.0));
            let row = |y: f64| ((y - first) / step).clamp(0.0, count as f64);
            let to = (row(strip.high).floor() as usize + 1).min(count);
            let from = (row(strip.low).ceil() as usize).min(to);
            for (k, covered) in (from..).zip(&mut covered[from..to]) {
                if let Some(span) = strip.across(first + k as f64 * step) {
                    add(covered, span);
                }
            }
        }
    }
    let inside = region.rows(first, step, count);
    let (mut found, mut widest) = (Bare::default(), 0.0);
    for (k, (inside, covered)) in inside.iter().zip(&mut covered).enumerate() {
        covered.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
        for span in inside.chunks_exact(2) {
            let mut from = span[0];
            for (low, high) in covered.iter().copied().chain([(span[1], f64::INFINITY)]) {
                let gap = low.min(span[1]) - from;
                if gap > 0.0 {
                    found.area += gap * step;
                    if gap > widest {
                        (widest, found.place) = (gap, DVec2::new(from + gap / 2.0, first + k as f64 * step));
                    }
                }
                from = from.max(high);
                if from >= span[1] {
                    break;
                }
            }
        }
    }
    found
}

/// Adds a span to those of a row. Neighbouring passes are laid one after another, so most spans continue the last one.
fn add(spans: &mut Vec<(f64, f64)>, (low, high): (f64, f64)) {
    match spans.last_mut() {
        Some(last) if low <= last.1 && high >= last.0 => *last = (last.0.min(low), last.1.max(high)),
        _ => spans.push((low, high)),
    }
}

/// The strip with round ends that a straight piece covers.
struct Strip {
    ends: [DVec2; 2],
    radius: f64,
    /// The long sides: lowest and highest y, x at the lowest, and how x grows with y. None along a row.
    sides: Option<[(f64, f64, f64, f64); 2]>,
    low: f64,
    high: f64,
}

impl Strip {
    fn new(a: DVec2, b: DVec2, radius: f64) -> Self {
        let out = (b - a).perp().normalize_or_zero() * radius;
        let side = |out: DVec2| {
            let (from, to) = if a.y < b.y { (a + out, b + out) } else { (b + out, a + out) };
            let lean = (to.x - from.x) / (to.y - from.y);
            (from.y, to.y, from.x, lean)
        };
        let sides = (a.y != b.y).then(|| [side(out), side(-out)]);
        Self { ends: [a, b], radius, sides, low: a.y.min(b.y) - radius, high: a.y.max(b.y) + radius }
    }

    /// Where a row crosses it.
    #[inline]
    fn across(&self, y: f64) -> Option<(f64, f64)> {
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for end in self.ends {
            let square = self.radius * self.radius - (y - end.y) * (y - end.y);
            if square >= 0.0 {
                let half = square.sqrt();
                (low, high) = (low.min(end.x - half), high.max(end.x + half));
            }
        }
        for (from, to, x, lean) in self.sides.into_iter().flatten() {
            if from <= y && y <= to {
                let x = x + (y - from) * lean;
                (low, high) = (low.min(x), high.max(x));
            }
        }
        (low <= high).then_some((low, high))
    }
}

#[cfg(test)]
mod tests {
    use super::{Strip, bare};
    use crate::fill::Path;
    use crate::pass::{Along, PassKind};
    use glam::DVec2;
    use planar::{Polygon, Region, Ring};

    fn square(side: f64) -> Region {
        let points = [(0.0, 0.0), (side, 0.0), (side, side), (0.0, side)].map(DVec2::from);
        region(points.to_vec())
    }

    fn region(points: Vec<DVec2>) -> Region {
        Region::from_normalised(vec![Polygon { outer: Ring::new(points), holes: Vec::new() }])
    }

    fn line(from: (f64, f64), to: (f64, f64), width: f64) -> Path {
        let points = vec![DVec2::from(from), DVec2::from(to)];
        Path { kind: PassKind::Infill, closed: false, points, width: Along::Same(width), reversible: true }
    }

    #[test]
    fn a_line_through_a_square_covers_its_strip_and_half_discs() {
        let pass = line((3.0, 10.0), (17.0, 10.0), 4.0);
        let found = bare(&[&pass], &square(20.0), 4.0);
        let r = 2.0 * 1.01;
        let exact = 400.0 - 14.0 * 2.0 * r - std::f64::consts::PI * r * r;
        assert!((found.area / exact - 1.0).abs() < 2e-3, "{} for {exact}", found.area);
        let nothing = bare(&[], &square(20.0), 4.0);
        assert!((nothing.area - 400.0).abs() < 1e-6 && (nothing.place.x - 10.0).abs() < 1e-6);
    }

    #[test]
    fn turning_all_changes_nothing_but_the_rows() {
        let turn = DVec2::from_angle(0.7);
        let turned = |points: &[DVec2]| points.iter().map(|p| turn.rotate(*p)).collect::<Vec<_>>();
        let (island, pass) = (square(20.0), line((2.0, 4.0), (15.0, 13.0), 5.0));
        let moved = region(turned(island.polygons()[0].outer.points()));
        let along = Path { points: turned(&pass.points), ..pass.clone() };
        let (a, b) = (bare(&[&pass], &island, 5.0).area, bare(&[&along], &moved, 5.0).area);
        assert!((a / b - 1.0).abs() < 2e-3, "{a} {b}");
    }

    #[test]
    fn a_row_crosses_a_slanted_strip_between_its_sides() {
        let (low, high) = Strip::new(DVec2::new(0.0, 0.0), DVec2::new(10.0, 10.0), 1.0).across(5.0).unwrap_or_default();
        let half = 2.0_f64.sqrt();
        assert!((low - (5.0 - half)).abs() < 1e-12 && (high - (5.0 + half)).abs() < 1e-12);
        assert_eq!(Strip::new(DVec2::ZERO, DVec2::X, 1.0).across(2.0), None);
    }
}
