//! The height field of lines on the room's lattice, in nominal bead heights, and its faults.

use super::LoopSettings;
use super::line::Line;
use super::room::Room;
use crate::bead::Section;
use crate::deposit::{LOW, OVERFILL, RIM, VOID};
use glam::DVec2;
use planar::Region;
use planar::lattice::Lattice;
use std::f64::consts::FRAC_2_PI;
use std::ops::Range;

/// Higher metal is capped at this height, so that a peak pushes no harder.
const MOST: f32 = 1.6;
/// Standard deviation of the blur of the heights, in bead widths.
const BLUR: f64 = 0.26;
/// Where less than this fraction of the blur lies inside, the wanted height is assumed.
const LEAST_AREA: f32 = 0.08;

/// Faults of a height field, % of the area where metal is wanted.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Faults {
    /// Voids.
    pub void: f64,
    /// Low places.
    pub low: f64,
    /// Too much metal.
    pub overfill: f64,
}

impl Faults {
    /// The faults as one weighted sum; the lower the better.
    pub fn cost(&self) -> f64 {
        10.0 * self.void + self.overfill + 0.3 * self.low
    }
}

/// Whether metal is wanted at a point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Place {
    /// Outside, or in the rim: no metal is wanted here.
    Outside,
    /// Metal may lie here, but a disc for two beads does not fit.
    Tight,
    /// Metal is wanted here.
    Wanted,
}

/// The lattice, masks and blur with which lines are judged.
pub struct Field<'a> {
    lattice: &'a Lattice,
    places: Vec<Place>,
    wanted: usize,
    /// For each row, the points from the first to the last one inside.
    spans: Vec<Range<usize>>,
    /// One half of the symmetric blur's weights, from its middle outwards.
    weights: Vec<f32>,
    /// The fraction of the blur around each point that lies inside.
    area: Vec<f32>,
    /// The wanted mean height.
    target: f32,
}

impl<'a> Field<'a> {
    /// The field of a room; metal is wanted in `open`, less a rim.
    pub fn of(room: &'a Room, open: &Region, settings: &LoopSettings) -> Self {
        let (lattice, rim) = (&room.lattice, (RIM * settings.bead_width) as f32);
        let open = room.inside_of(open);
        let place = |i: usize| match room.distance[i] {
            distance if !room.inside[i] || distance < rim => Place::Outside,
            _ if open[i] => Place::Wanted,
            _ => Place::Tight,
        };
        let places: Vec<Place> = (0..lattice.len()).map(place).collect();
        let wanted = places.iter().filter(|&&place| place == Place::Wanted).count();
        let spans = room.inside.chunks(lattice.columns).map(span).collect();
        let weights = gauss(BLUR * settings.bead_width / lattice.step);
        let mut field =
            Self { lattice, places, wanted, spans, weights, area: Vec::new(), target: settings.target() as f32 };
        field.area =
            field.convolved(|place, _| f32::from(u8::from(place != Place::Outside)), &vec![0.0; lattice.len()]);
        field
    }

    /// The heights of lines.
    pub fn heights(&self, lines: &[Line], settings: &LoopSettings) -> Vec<f32> {
        let (mut heights, mut squares) = (vec![0.0; self.lattice.len()], Vec::new());
        for (a, b, width) in lines.iter().flat_map(Line::pieces) {
            self.stamp(&mut heights, &mut squares, (a + b) / 2.0, (a.distance(b), width), settings);
        }
        heights
    }

    /// Adds a short piece of this length and width, treated as a stationary pool at its middle: to all points of the square
    /// around it, since finding the ends of each row takes longer. `squares` is room for the squared distances of columns.
    fn stamp(
        &self,
        heights: &mut [f32],
        squares: &mut Vec<f32>,
        at: DVec2,
        (length, width): (f64, f64),
        settings: &LoopSettings,
    ) {
        let Lattice { columns, rows, step, .. } = *self.lattice;
        let (at, radius) = (self.lattice.in_steps(at), width / 2.0 / step);
        let height = settings.height_of(width) * length / (step * radius);
        let reached = |at: f64, count: usize| from(at - radius)..((at + radius) as usize + 1).min(count);
        let (rows, reached) = (reached(at.y, rows), reached(at.x, columns));
        squares.clear();
        squares.extend(reached.clone().map(|column| (column as f64 - at.x).powi(2) as f32));
        let lines = heights.chunks_mut(columns).enumerate().take(rows.end).skip(rows.start);
        for (row, line) in lines {
            let square = radius * radius - (row as f64 - at.y).powi(2);
            let Some(line) = line.get_mut(reached.clone()) else { continue };
            pour(line, squares, square as f32, settings.bead.section, (height, radius));
        }
    }

    /// The faults of a height field.
    pub fn faults(&self, heights: &[f32]) -> Faults {
        let (mut void, mut low, mut overfill) = (0_usize, 0_usize, 0_usize);
        for (&height, &place) in heights.iter().zip(&self.places) {
            if place == Place::Wanted {
                void += usize::from(height < VOID as f32);
                low += usize::from(height < LOW as f32);
            }
            overfill += usize::from(place != Place::Outside && height > OVERFILL as f32);
        }
        let percent = |count: usize| 100.0 * count as f64 / self.wanted.max(1) as f64;
        Faults { void: percent(void), low: percent(low - void), overfill: percent(overfill) }
    }

    /// The heights, blurred over the points inside. Where two beads do not fit, only excess metal counts.
    pub fn blurred(&self, heights: &[f32]) -> Vec<f32> {
        let height = |place: Place, height: f32| match place {
            Place::Outside => 0.0,
            Place::Tight => height.clamp(self.target, MOST),
            Place::Wanted => height.min(MOST),
        };
        let mut sums = self.convolved(height, heights);
        for (sum, &area) in sums.iter_mut().zip(&self.area) {
            *sum = if area > LEAST_AREA { *sum / area } else { self.target };
        }
        sums
    }

    /// Values of the points inside, convolved with the blur, for the points inside.
    fn convolved(&self, value: impl Fn(Place, f32) -> f32, heights: &[f32]) -> Vec<f32> {
        let (columns, reach) = (self.lattice.columns, self.weights.len() - 1);
        let mut across = vec![0.0_f32; heights.len()];
        let mut line = vec![0.0_f32; columns + 2 * reach];
        for (row, span) in self.spans.iter().enumerate().filter(|(_, span)| !span.is_empty()) {
            let first = row * columns;
            line.fill(0.0);
            for i in span.clone() {
                line[reach + i] = value(self.places[first + i], heights[first + i]);
            }
            let wide = span.start.saturating_sub(reach)..(span.end + reach).min(columns);
            let out = &mut across[first + wide.start..first + wide.end];
            for (k, &weight) in self.weights.iter().enumerate() {
                let left = &line[wide.start + reach - k..];
                let right = &line[wide.start + reach + k..];
                let share = if k == 0 { weight / 2.0 } else { weight };
                out.iter_mut().zip(left.iter().zip(right)).for_each(|(o, (l, r))| *o += share * (l + r));
            }
        }
        let mut result = vec![0.0_f32; heights.len()];
        for (row, span) in self.spans.iter().enumerate() {
            let out = &mut result[row * columns + span.start..row * columns + span.end];
            for (k, &weight) in self.weights.iter().enumerate() {
                let above = Some(row + k).filter(|&r| r < self.lattice.rows && k > 0);
                for other in row.checked_sub(k).into_iter().chain(above) {
                    let values = &across[other * columns + span.start..other * columns + span.end];
                    out.iter_mut().zip(values).for_each(|(o, v)| *o += weight * v);
                }
            }
        }
        result
    }
}

/// The first whole number not below `x`, 0 or more: for baseline CPU targets a cast is faster than `ceil`.
fn from(x: f64) -> usize {
    let whole = x.max(0.0) as usize;
    whole + usize::from((whole as f64) < x)
}

/// Adds one row of a pool to `line`. In lattice steps: `squares` are the squared distances of the row's points from the
/// pool's middle along it, `square` is the squared half-width of the pool in this row, `radius` that of the pool. `height` is
/// that of a bead laid by a line of such pools. Code without branches, which becomes vector instructions.
fn pour(line: &mut [f32], squares: &[f32], square: f32, section: Section, (height, radius): (f64, f64)) {
    let points = line.iter_mut().zip(squares);
    match section {
        Section::Ellipse | Section::Stadium => {
            let half = (0.5 * height) as f32;
            points.for_each(|(h, x)| *h += if *x <= square { half } else { 0.0 });
        }
        Section::Parabola => {
            let factor = (height * FRAC_2_PI / radius) as f32;
            points.for_each(|(h, x)| *h += factor * (square - x).max(0.0).sqrt());
        }
    }
}

fn span(row: &[bool]) -> Range<usize> {
    let first = row.iter().position(|&inside| inside);
    let last = row.iter().rposition(|&inside| inside);
    first.zip(last).map_or(0..0, |(first, last)| first..last + 1)
}

fn gauss(sigma: f64) -> Vec<f32> {
    let reach = (3.0 * sigma).ceil() as i32;
    let weights: Vec<f64> = (0..=reach).map(|k| (-0.5 * (f64::from(k) / sigma).powi(2)).exp()).collect();
    let sum = weights.iter().sum::<f64>() * 2.0 - weights[0];
    weights.into_iter().map(|weight| (weight / sum) as f32).collect()
}
