//! The area that beads leave bare, judged by their footprints: each piece of a path covers half a width on both sides
//! and around its ends. Measured on rows across the region, exact along each row.

mod strip;

use super::Path;
use crate::pass::Along;
use glam::DVec2;
use planar::{Bounds, PerRow, Region};
use std::ops::Range;
use strip::{Disc, Span, Strip, union};

/// Rows per bead width, and the number used if those are too few.
const ROWS: [f64; 2] = [6.0, 12.0];
/// They are too few if more than this fraction of a region is bare, since strips thinner than the row spacing then
/// matter.
const MUCH: f64 = 0.03;
/// The rows are slanted, radians, since beads or edges along them would be counted in whole rows: at the first of these
/// angles at which they measure the region itself to within [`WELL`] and none of its edges runs along them, or at the
/// best one. Few of the angles coincide with edges of one regular polygon.
const ASLANT: [f64; 4] = [0.3, 1.32, 0.65, 1.75];
/// Greatest error, as a fraction of a region's area.
const WELL: f64 = 0.002;
/// An edge runs along the rows if it crosses fewer of them than the first number and extends over more than the second.
const ALONG: [f64; 2] = [2.0, 8.0];
/// Beads count as wider by this fraction, so that neighbours that just touch leave nothing bare.
const TOUCHING: f64 = 0.01;

/// The part of a region that no bead covers.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Bare {
    /// Bare area, mm².
    pub area: f64,
    /// Middle of its widest place, mm.
    pub place: DVec2,
}

/// What passes leave bare of a region; `width` is the nominal bead width, mm.
pub fn bare(paths: &[&Path], region: &Region, width: f64) -> Bare {
    Coverage::of(paths, region, width).map_or_else(Bare::default, |coverage| coverage.bare())
}

/// The area that passes cover, on rows across a region.
pub struct Coverage {
    grid: Grid,
    /// Where the rows cross the boundary of the region.
    inside: PerRow<f64>,
    /// The covered spans of each row, ordered by where they begin.
    covered: PerRow<Span>,
}

/// Position of the rows.
#[derive(Debug, Clone, Copy)]
struct Grid {
    /// The angle at which they run, radians.
    angle: f64,
    /// Height of the first row and distance between the rows, mm.
    first: f64,
    step: f64,
    count: usize,
}

impl Grid {
    /// Rows across a region at an angle, radians, at most this far apart, mm; `None` for an empty region.
    fn at(angle: f64, region: &Region, apart: f64) -> Option<Self> {
        let turn = DVec2::from_angle(-angle);
        let points = region.polygons().iter().flat_map(|island| island.outer.points());
        let bounds = Bounds::of(points.map(|p| turn.rotate(*p)))?;
        let count = (bounds.size().y / apart).ceil().max(ROWS[0]) as usize;
        let step = bounds.size().y / count as f64;
        Some(Self { angle, first: bounds.min.y + step / 2.0, step, count })
    }

    /// Where the rows cross the boundary of a region.
    fn rows(&self, region: &Region) -> PerRow<f64> {
        region.turned(DVec2::from_angle(-self.angle)).rows(self.first, self.step, self.count)
    }

    /// The rows that a region may reach.
    fn rows_at(&self, region: &Region) -> Range<usize> {
        let turn = DVec2::from_angle(-self.angle);
        let points = region.polygons().iter().flat_map(|island| island.outer.points());
        let Some(bounds) = Bounds::of(points.map(|p| turn.rotate(*p))) else { return 0..0 };
        let row = |y: f64| ((y - self.first) / self.step).max(0.0);
        let (low, high) = (row(bounds.min.y).floor() as usize, row(bounds.max.y).ceil() as usize + 1);
        low.min(self.count)..high.min(self.count)
    }

    /// Some of the rows.
    fn part(&self, rows: &Range<usize>) -> Self {
        Self { first: self.first + rows.start as f64 * self.step, count: rows.len(), ..*self }
    }

    /// Length of the edges of a region that run along the rows, mm.
    fn along(&self, region: &Region) -> f64 {
        let turn = DVec2::from_angle(-self.angle);
        let [few, many] = ALONG.map(|rows| rows * self.step);
        let edges = region.rings().flat_map(|ring| ring.edges()).map(|(a, b)| turn.rotate(b - a).abs());
        edges.filter(|edge| edge.y < few && edge.x > many).map(|edge| edge.x).sum()
    }

    /// The best rows for a region, and where they cross its boundary.
    fn across(region: &Region, apart: f64) -> Option<(Self, PerRow<f64>)> {
        let area = region.area();
        let mut best: Option<(f64, Self, PerRow<f64>)> = None;
        for angle in ASLANT {
            let grid = Self::at(angle, region, apart)?;
            let rows = grid.rows(region);
            let lengths = rows.iter().flat_map(|row| row.chunks_exact(2)).map(|span| span[1] - span[0]);
            let error = (lengths.sum::<f64>() * grid.step - area).abs() + grid.step * grid.along(region);
            if best.as_ref().is_none_or(|(least, ..)| error < *least) {
                best = Some((error, grid, rows));
            }
            if error <= WELL * area {
                break;
            }
        }
        best.map(|(_, grid, rows)| (grid, rows))
    }
}

impl Coverage {
    /// The area that passes cover within a region; `width` is the nominal bead width, mm. `None` for an empty region.
    pub fn of(paths: &[&Path], region: &Region, width: f64) -> Option<Self> {
        let [coarse, fine] = ROWS.map(|rows| width / rows);
        let found = Self::on_rows(paths, region, coarse)?;
        let is_fine = found.bare().area < MUCH * region.area();
        if is_fine { Some(found) } else { Self::on_rows(paths, region, fine) }
    }

    /// The same on rows this far apart, mm.
    fn on_rows(paths: &[&Path], region: &Region, apart: f64) -> Option<Self> {
        let (grid, inside) = Grid::across(region, apart)?;
        let mut rows = Rows::new(grid.first, grid.step, grid.count);
        let turn = DVec2::from_angle(-grid.angle);
        for path in paths {
            let line: Vec<DVec2> = path.points.iter().map(|p| turn.rotate(*p)).collect();
            rows.cover(&line, path.closed, &path.width);
        }
        Some(Self { grid, inside, covered: rows.covered() })
    }

    /// What is left bare of the region.
    pub fn bare(&self) -> Bare {
        self.bare_between(&self.inside, 0)
    }

    /// What is left bare of another region that lies within this one.
    pub fn bare_of(&self, region: &Region) -> Bare {
        let rows = self.grid.rows_at(region);
        self.bare_between(&self.grid.part(&rows).rows(region), rows.start)
    }

    /// What is left bare between the first and the second position on each row, the third and the fourth, and so on;
    /// `inside` starts at row number `from`.
    fn bare_between(&self, inside: &PerRow<f64>, from: usize) -> Bare {
        let Grid { angle, first, step, .. } = self.grid;
        let (mut found, mut widest) = (Bare::default(), 0.0);
        for (k, (inside, covered)) in (from..).zip(inside.iter().zip(self.covered.iter().skip(from))) {
            for span in inside.chunks_exact(2) {
                for gap in gaps(span[0]..span[1], covered) {
                    let length = gap.end - gap.start;
                    found.area += length * step;
                    if length > widest {
                        let middle = DVec2::new(gap.start + length / 2.0, first + k as f64 * step);
                        (widest, found.place) = (length, DVec2::from_angle(angle).rotate(middle));
                    }
                }
            }
        }
        found
    }
}

/// The gaps that sorted spans leave in a span.
fn gaps(span: Range<f64>, covered: &[Span]) -> impl Iterator<Item = Range<f64>> {
    let mut from = span.start;
    let before_end = covered.iter().copied().take_while(move |(low, _)| *low < span.end);
    before_end.chain([(span.end, f64::INFINITY)]).filter_map(move |(low, high)| {
        let gap = from..low;
        from = from.max(high);
        (gap.start < gap.end).then_some(gap)
    })
}

/// Covered spans of each row, being collected.
struct Rows {
    /// Height of the first row and distance between the rows, mm.
    first: f64,
    step: f64,
    /// Rows per millimetre.
    per_mm: f64,
    /// The last span of each row, and the earlier ones.
    last: Vec<Span>,
    before: Vec<(u32, Span)>,
    /// Where the run in progress begins on each row.
    starts: Vec<f64>,
}

/// The last span of a row on which nothing is covered yet.
const NOWHERE: Span = (f64::INFINITY, f64::NEG_INFINITY);

/// Parallel strips, each overlapping the one before: the scan lines of a zigzag. On a row that crosses several of them
/// only the outer sides of the first and the last matter, so the cost of a line is the number of rows in which it
/// differs from its neighbour.
struct Run {
    last: Strip,
    /// Rows that cross both long sides of the last strip.
    rows: Range<usize>,
    /// Whether each strip lies at greater x than the one before; unknown for a single strip.
    rising: Option<bool>,
}

impl Rows {
    fn new(first: f64, step: f64, count: usize) -> Self {
        let (last, before, starts) = (vec![NOWHERE; count], Vec::new(), vec![0.0; count]);
        Self { first, step, per_mm: step.recip(), last, before, starts }
    }

    fn cover(&mut self, line: &[DVec2], closed: bool, width: &Along) {
        let mut run: Option<Run> = None;
        for strip in self.strips(line, closed, width) {
            let (all, core) = (self.within(strip.all()), self.within(strip.core()));
            if core.is_empty() || strip.is_short() {
                self.cover_strip(&strip, all);
                continue;
            }
            self.cover_strip(&strip, all.start..core.start);
            self.cover_strip(&strip, core.end..all.end);
            run = Some(match run.take() {
                Some(run) => self.go_on(run, strip, core),
                None => Run { last: strip, rows: core, rising: None },
            });
        }
        if let Some(run) = run {
            self.close(&run, run.rows.clone());
        }
    }

    /// The strips covered by the pieces of a line. Where the line bends a little they are extended until they meet on
    /// the outside; where it bends more or its width changes, and at its ends, it covers a disc.
    fn strips(&mut self, line: &[DVec2], closed: bool, width: &Along) -> Vec<Strip> {
        let radius = |i: usize| width.after(i) * (0.5 + TOUCHING / 2.0);
        let again = closed.then(|| line.first()).flatten();
        let pieces = line.iter().zip(line.iter().skip(1).chain(again)).enumerate();
        let mut strips: Vec<Strip> = pieces.filter_map(|(i, (a, b))| Strip::new(*a, *b, radius(i))).collect();
        let Some(last) = strips.len().checked_sub(1) else {
            line.iter().take(1).for_each(|point| self.cover_disc(*point, radius(0)));
            return strips;
        };
        (1..=last).for_each(|i| self.join(&mut strips, i - 1, i));
        if closed {
            self.join(&mut strips, last, 0);
        } else {
            self.end(&mut strips[0], 0);
            self.end(&mut strips[last], 1);
        }
        strips
    }

    /// Covers the gap between a strip and the one that follows it.
    fn join(&mut self, strips: &mut [Strip], one: usize, other: usize) {
        let (into, out) = (strips[one], strips[other]);
        let (sine, cosine) = (into.way.perp_dot(out.way), into.way.dot(out.way));
        if cosine >= LITTLE && into.radius == out.radius {
            // The tangent of half the turn.
            let on = out.radius * sine.abs() / (1.0 + cosine);
            (strips[one].on[1], strips[other].on[0]) = (on, on);
        } else if into.radius > out.radius || (into.radius == out.radius && into.length < out.length) {
            self.end(&mut strips[one], 1);
        } else {
            self.end(&mut strips[other], 0);
        }
    }

    /// Rounds an end of a strip: for a short one together with the strip, otherwise at once.
    fn end(&mut self, strip: &mut Strip, end: usize) {
        if strip.is_short() {
            strip.round[end] = true;
        } else {
            self.cover_disc(strip.ends()[end], strip.radius);
        }
    }

    /// The rows from one height to another.
    fn within(&self, (low, high): (f64, f64)) -> Range<usize> {
        // The first row above a height; casts round down, as the values are not negative.
        let from = |y: f64| ((y - self.first) * self.per_mm + 1.0).max(0.0) as usize;
        let to = from(high).min(self.last.len());
        from(low).min(to)..to
    }

    fn height(&self, row: usize) -> f64 {
        self.first + row as f64 * self.step
    }

    fn cover_strip(&mut self, strip: &Strip, rows: Range<usize>) {
        if rows.is_empty() {
            return;
        }
        let (sides, between) = (strip.sides(), strip.between_ends());
        let discs = [0, 1].map(|end| Disc { middle: strip.ends()[end], radius: strip.radius });
        for row in rows {
            let y = self.height(row);
            let span = sides.meet(&between, y);
            let mut span = if span.0 <= span.1 { span } else { NOWHERE };
            for (disc, _) in discs.iter().zip(strip.round).filter(|(_, round)| *round) {
                span = union(span, disc.on(y));
            }
            self.add(row, span);
        }
    }

    fn cover_disc(&mut self, middle: DVec2, radius: f64) {
        let disc = Disc { middle, radius };
        for row in self.within((middle.y - radius, middle.y + radius)) {
            self.add(row, disc.on(self.height(row)));
        }
    }

    /// Adds a span to a row. Neighbouring passes are laid consecutively, so most spans extend the last one.
    fn add(&mut self, row: usize, (low, high): Span) {
        let last = &mut self.last[row];
        if low <= last.1 && high >= last.0 {
            *last = (last.0.min(low), last.1.max(high));
        } else if low <= high {
            if *last != NOWHERE {
                self.before.push((row as u32, *last));
            }
            *last = (low, high);
        }
    }

    /// All spans of each row, by where they begin.
    fn covered(self) -> PerRow<Span> {
        let last = self.last.iter().copied().enumerate().filter(|(_, span)| *span != NOWHERE);
        let before = self.before.iter().map(|&(row, span)| (row as usize, span));
        let mut covered = PerRow::grouped(self.last.len(), before.chain(last));
        covered.iter_mut().for_each(|row| row.sort_unstable_by(|a, b| a.0.total_cmp(&b.0)));
        covered
    }

    /// Adds a strip to a run, or begins a new run if the strip does not continue it.
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

    /// Records where a run begins on some rows.
    fn open(&mut self, strip: &Strip, rows: Range<usize>, rising: bool) {
        let sides = strip.sides();
        for row in rows {
            let (low, high) = sides.at(self.height(row));
            self.starts[row] = if rising { low } else { high };
        }
    }

    /// Covers some rows from where a run begins to where its last strip ends.
    fn close(&mut self, run: &Run, rows: Range<usize>) {
        let sides = run.last.sides();
        for row in rows {
            let (low, high) = sides.at(self.height(row));
            let span = match run.rising {
                None => (low, high),
                Some(true) => (self.starts[row], high),
                Some(false) => (low, self.starts[row]),
            };
            self.add(row, span);
        }
    }
}

/// Cosine of a turn that counts as slight: on its outer side strips meet 1 % of a radius beyond the round join.
const LITTLE: f64 = 0.96;

#[cfg(test)]
mod tests {
    use super::{ASLANT, Bare, Coverage, ROWS, Strip, bare};
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

    fn on_coarse_rows(paths: &[&Path], region: &Region, width: f64) -> Bare {
        Coverage::on_rows(paths, region, width / ROWS[0]).unwrap().bare()
    }

    #[test]
    fn a_line_through_a_square_covers_its_strip_and_half_discs() {
        let pass = line((3.0, 10.0), (17.0, 10.0), 4.0);
        let found = bare(&[&pass], &square(20.0), 4.0);
        let r = 2.0 * 1.01;
        let exact = 400.0 - 14.0 * 2.0 * r - std::f64::consts::PI * r * r;
        assert!((found.area / exact - 1.0).abs() < 2e-3, "{} for {exact}", found.area);
        // Its edges run along the first rows: others measure it.
        let turned = square(20.0).turned(DVec2::from_angle(ASLANT[0]));
        let nothing = on_coarse_rows(&[], &turned, 4.0);
        assert!((nothing.area - 400.0).abs() < 0.01 && turned.contains(nothing.place), "{nothing:?}");
    }

    /// A strip along the first rows would be measured in whole rows.
    #[test]
    fn thin_strips_along_rows_are_measured_across() {
        for (turn, thickness) in [(0.3, 1.2), (0.3, 0.9), (0.31, 1.7), (1.1, 1.3), (-0.4, 1.1)] {
            let way = DVec2::from_angle(turn);
            let strip = [(0.0, 0.0), (60.0, 0.0), (60.0, thickness), (0.0, thickness)].map(|p| way.rotate(p.into()));
            let comb = [(-20.0, 0.0), (0.0, 0.0), (0.0, 20.0), (-20.0, 20.0)].map(|p| way.rotate(p.into()));
            let parts = [strip, comb].map(|points| Polygon { outer: Ring::new(points.to_vec()), holes: Vec::new() });
            let found = bare(&[], &Region::from_normalised(parts.to_vec()), 7.0).area;
            let exact = 400.0 + 60.0 * thickness;
            assert!((found / exact - 1.0).abs() < 6e-3, "{found} for {exact} at {turn}");
        }
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
                on_coarse_rows(&[&whole], &square(60.0), width).area,
                on_coarse_rows(&parts.iter().collect::<Vec<_>>(), &square(60.0), width).area,
            );
            assert!(one < 3400.0 && (one - each).abs() < 1e-3, "{one} {each} at {turn}");
        }
    }

    #[test]
    fn a_row_crosses_a_slanted_strip_between_its_sides() {
        let strip = |x, y| Strip::new(DVec2::ZERO, DVec2::new(x, y), 1.0).unwrap();
        let on = |strip: Strip, y| strip.sides().meet(&strip.between_ends(), y);
        let (low, high) = on(strip(10.0, 10.0), 5.0);
        let half = 2.0_f64.sqrt();
        assert!((low - (5.0 - half)).abs() < 1e-12 && (high - (5.0 + half)).abs() < 1e-12);
        // Near its end only one long side is crossed.
        let (low, high) = on(strip(10.0, 10.0), 10.0);
        assert!((low - (10.0 - half)).abs() < 1e-12 && (high - 10.0).abs() < 1e-12, "{low} {high}");
        assert_eq!(on(strip(3.0, 0.0), 0.5), (0.0, 3.0));
        assert_eq!(on(strip(0.0, -3.0), -0.5), (-1.0, 1.0));
    }
}
