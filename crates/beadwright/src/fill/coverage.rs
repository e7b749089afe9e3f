//! What beads leave bare, by their footprints: each piece of a path covers half a width to both sides and
//! around its ends. Measured on rows across the region, exact along each row.

use super::Path;
use crate::pass::Along;
use glam::DVec2;
use planar::{Bounds, Region};
use std::ops::Range;

/// Rows in a bead's width.
const ROWS: f64 = 8.0;
/// The rows run aslant, radians: beads along them would be counted in whole rows.
const ASLANT: f64 = 0.3;
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
    Coverage::of(paths, region, width).map_or_else(Bare::default, |coverage| coverage.bare(region))
}

/// What passes cover, on rows across a region.
pub struct Coverage {
    /// Height of the first row and distance of the rows, mm.
    first: f64,
    step: f64,
    /// Of each row, by where they begin.
    covered: Vec<Vec<(f64, f64)>>,
}

impl Coverage {
    /// What passes cover where a region lies; `width` is the nominal bead's, mm. `None` for an empty region.
    pub fn of(paths: &[&Path], region: &Region, width: f64) -> Option<Self> {
        let turned = |p: &DVec2| DVec2::from_angle(-ASLANT).rotate(*p);
        let bounds = Bounds::of(region.polygons().iter().flat_map(|island| island.outer.points()).map(turned))?;
        let count = (ROWS * bounds.size().y / width).ceil().max(ROWS) as usize;
        let step = bounds.size().y / count as f64;
        let first = bounds.min.y + step / 2.0;
        let mut rows = Rows { first, step, covered: vec![Vec::new(); count], starts: vec![0.0; count] };
        for path in paths {
            let line: Vec<DVec2> = path.path().iter().map(turned).collect();
            rows.cover(&line, &path.width);
        }
        let mut covered = rows.covered;
        covered.iter_mut().for_each(|row| row.sort_unstable_by(|a, b| a.0.total_cmp(&b.0)));
        Some(Self { first, step, covered })
    }

    /// What is left bare of a region that lies within the one whose rows these are.
    pub fn bare(&self, region: &Region) -> Bare {
        let (mut found, mut widest) = (Bare::default(), 0.0);
        let inside = region.turned(DVec2::from_angle(-ASLANT)).rows(self.first, self.step, self.covered.len());
        for (k, (inside, covered)) in inside.iter().zip(&self.covered).enumerate() {
            for span in inside.chunks_exact(2) {
                for gap in gaps(span[0]..span[1], covered) {
                    let length = gap.end - gap.start;
                    found.area += length * self.step;
                    if length > widest {
                        let middle = DVec2::new(gap.start + length / 2.0, self.first + k as f64 * self.step);
                        (widest, found.place) = (length, DVec2::from_angle(ASLANT).rotate(middle));
                    }
                }
            }
        }
        found
    }
}

/// What sorted spans leave bare of one.
fn gaps(span: Range<f64>, covered: &[(f64, f64)]) -> impl Iterator<Item = Range<f64>> {
    let mut from = span.start;
    let before_end = covered.iter().copied().take_while(move |(low, _)| *low < span.end);
    before_end.chain([(span.end, f64::INFINITY)]).filter_map(move |(low, high)| {
        let gap = from..low;
        from = from.max(high);
        (gap.start < gap.end).then_some(gap)
    })
}

/// What is covered of each row, so far.
struct Rows {
    /// Height of the first row and distance of the rows, mm.
    first: f64,
    step: f64,
    covered: Vec<Vec<(f64, f64)>>,
    /// Where the run in progress begins on each row.
    starts: Vec<f64>,
}

/// Parallel strips, each overlapping the one before: the scan lines of a zigzag. On a row that crosses several of them
/// only the outer sides of the first and of the last matter, so a line costs as much as its rows differ from its
/// neighbour's.
struct Run {
    last: Strip,
    /// Rows that cross both long sides of the last strip.
    rows: Range<usize>,
    /// Whether the strips follow each other towards greater x; unknown for one alone.
    rising: Option<bool>,
}

impl Rows {
    fn cover(&mut self, line: &[DVec2], width: &Along) {
        let mut run: Option<Run> = None;
        for (i, ends) in line.windows(2).enumerate() {
            let strip = Strip::new(ends[0], ends[1], width.after(i) * (0.5 + TOUCHING / 2.0));
            let all = self.within(strip.low, strip.high);
            let core = strip.core().map_or(0..0, |(low, high)| self.within(low, high));
            if core.is_empty() || strip.is_short() {
                self.cover_by(&strip, all);
                continue;
            }
            self.cover_by(&strip, all.start..core.start);
            self.cover_by(&strip, core.end..all.end);
            run = Some(match run.take() {
                Some(run) => self.go_on(run, strip, core),
                None => Run { last: strip, rows: core, rising: None },
            });
        }
        if let Some(run) = run {
            self.close(&run, run.rows.clone());
        }
    }

    /// The rows from one height to another.
    fn within(&self, low: f64, high: f64) -> Range<usize> {
        let row = |y: f64| ((y - self.first) / self.step).clamp(0.0, self.covered.len() as f64);
        let to = (row(high).floor() as usize + 1).min(self.covered.len());
        (row(low).ceil() as usize).min(to)..to
    }

    fn height(&self, row: usize) -> f64 {
        self.first + row as f64 * self.step
    }

    fn cover_by(&mut self, strip: &Strip, rows: Range<usize>) {
        for row in rows {
            if let Some(span) = strip.across(self.height(row)) {
                add(&mut self.covered[row], span);
            }
        }
    }

    /// Adds a strip to a run, or begins another run where it does not continue this one.
    fn go_on(&mut self, run: Run, strip: Strip, rows: Range<usize>) -> Run {
        let rising = run.last.beside(&strip).filter(|rising| run.rising.is_none_or(|so_far| so_far == *rising));
        let Some(rising) = rising else {
            self.close(&run, run.rows.clone());
            return Run { last: strip, rows, rising: None };
        };
        if run.rising.is_none() {
            self.open(&run.last, run.rows.clone(), rising);
        }
        let run = Run { rising: Some(rising), ..run };
        let common = run.rows.start.max(rows.start)..run.rows.end.min(rows.end);
        let both = if common.is_empty() { run.rows.end..run.rows.end } else { common.clone() };
        self.close(&run, run.rows.start..both.start);
        self.close(&run, both.end..run.rows.end);
        let both = if common.is_empty() { rows.end..rows.end } else { common };
        self.open(&strip, rows.start..both.start, rising);
        self.open(&strip, both.end..rows.end, rising);
        Run { last: strip, rows, rising: Some(rising) }
    }

    /// Notes where a run begins on some rows.
    fn open(&mut self, strip: &Strip, rows: Range<usize>, rising: bool) {
        for row in rows {
            let (low, high) = strip.between_sides(self.height(row));
            self.starts[row] = if rising { low } else { high };
        }
    }

    /// Covers some rows from where a run begins to where its last strip ends.
    fn close(&mut self, run: &Run, rows: Range<usize>) {
        for row in rows {
            let (low, high) = run.last.between_sides(self.height(row));
            let span = match run.rising {
                None => (low, high),
                Some(true) => (self.starts[row], high),
                Some(false) => (low, self.starts[row]),
            };
            add(&mut self.covered[row], span);
        }
    }
}

/// Shorter pieces are covered one by one, in radii: they link scan lines, whose run goes on behind them.
const SHORT: f64 = 8.0;

/// Strips of a run overlap by this part of their width at least, and lean alike to this part of it.
const OVERLAP: f64 = 1e-3;

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

    fn is_short(&self) -> bool {
        self.ends[0].distance(self.ends[1]) < SHORT * self.radius
    }

    /// The heights between which rows cross both long sides.
    fn core(&self) -> Option<(f64, f64)> {
        let [a, b] = self.sides?;
        Some((a.0.max(b.0), a.1.min(b.1)))
    }

    /// Where a row between them does.
    fn between_sides(&self, y: f64) -> (f64, f64) {
        let [a, b] = self.sides.unwrap_or_default().map(|(from, _, x, lean)| x + (y - from) * lean);
        (a.min(b), a.max(b))
    }

    /// Whether another strip lies beside this one, parallel, as wide, and overlapping: then, whether towards greater x.
    fn beside(&self, other: &Self) -> Option<bool> {
        let (way, next) = (self.ends[1] - self.ends[0], other.ends[1] - other.ends[0]);
        let (own, along) = (way.try_normalize()?, next.try_normalize()?);
        let reach = way.length().max(next.length()) + self.ends[0].distance(other.ends[0]);
        let parallel = own.perp_dot(along).abs() * reach < OVERLAP * self.radius;
        let apart = own.perp_dot(other.ends[0] - self.ends[0]);
        let near = (OVERLAP..2.0 - OVERLAP).contains(&(apart.abs() / self.radius));
        // To the left of an upward way x decreases.
        (parallel && near && self.radius == other.radius).then_some((apart > 0.0) != (own.y > 0.0))
    }
}

#[cfg(test)]
mod tests {
    use super::{ASLANT, Strip, bare};
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
        let nothing = bare(&[], &square(20.0).turned(DVec2::from_angle(ASLANT)), 4.0);
        let middle = DVec2::from_angle(-ASLANT).rotate(nothing.place).x;
        assert!((nothing.area - 400.0).abs() < 1e-6 && (middle - 10.0).abs() < 1e-6, "{nothing:?}");
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
    fn scan_lines_in_one_path_cover_what_they_cover_one_by_one() {
        // Up and down with a gap, lines of many lengths, steep and flat, there and back again.
        for (turn, width) in [(0.3, 2.0), (0.785, 1.1), (1.5, 1.02), (2.4, 0.9), (-1.1, 3.0)] {
            let way = DVec2::from_angle(turn);
            let at = |k: usize, t: f64| DVec2::new(30.0, 30.0) + way * t + way.perp() * (k % 23) as f64;
            let ends = |k: usize| {
                let reach = 4.0 + (k * 7 % 11) as f64;
                if k.is_multiple_of(2) { [at(k, -reach), at(k, reach)] } else { [at(k, reach), at(k, 1.0 - reach)] }
            };
            let points: Vec<DVec2> = (0..40).flat_map(ends).collect();
            let path = |points: &[DVec2]| Path { points: points.to_vec(), ..line((0.0, 0.0), (0.0, 0.0), width) };
            let (whole, parts): (Path, Vec<Path>) = (path(&points), points.windows(2).map(path).collect());
            let (one, each) = (
                bare(&[&whole], &square(60.0), width).area,
                bare(&parts.iter().collect::<Vec<_>>(), &square(60.0), width).area,
            );
            assert!(one < 3400.0 && (one - each).abs() < 1e-8, "{one} {each} at {turn}");
        }
    }

    #[test]
    fn a_row_crosses_a_slanted_strip_between_its_sides() {
        let (low, high) = Strip::new(DVec2::new(0.0, 0.0), DVec2::new(10.0, 10.0), 1.0).across(5.0).unwrap_or_default();
        let half = 2.0_f64.sqrt();
        assert!((low - (5.0 - half)).abs() < 1e-12 && (high - (5.0 + half)).abs() < 1e-12);
        assert_eq!(Strip::new(DVec2::ZERO, DVec2::X, 1.0).across(2.0), None);
    }
}
