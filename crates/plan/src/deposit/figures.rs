//! Areas and heights of one layer or many.

use super::field::{Band, Grid, Height};
use super::patch::Run;
use super::ridges::Ridges;
use super::stroke::Nominal;
use super::tiles::Square;
use super::{LOW, Mask, OUTSIDE, OVERFILL, VOID};
use serde::Serialize;

/// What a height field shows; areas in mm², heights in mm.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct Figures {
    /// Judged area: the outline less its rim.
    #[serde(rename = "judged_area_mm2")]
    pub area: f64,
    /// Area of voids.
    #[serde(rename = "void_area_mm2")]
    pub void: f64,
    /// Low area.
    #[serde(rename = "low_area_mm2")]
    pub low: f64,
    /// Overfilled area.
    #[serde(rename = "overfill_area_mm2")]
    pub overfill: f64,
    /// Area with metal outside the outline and the machining allowance.
    #[serde(rename = "outside_area_mm2")]
    pub outside: f64,
    /// Volume of the beads, mm³.
    #[serde(rename = "deposited_volume_mm3")]
    pub deposited_volume: f64,
    /// Least height.
    #[serde(rename = "min_height_mm")]
    pub min: f64,
    /// Greatest height.
    #[serde(rename = "max_height_mm")]
    pub max: f64,
    /// Height times area, mm³.
    #[serde(skip)]
    sum: f64,
    /// Squared height times area, mm⁴.
    #[serde(skip)]
    squares: f64,
}

impl Figures {
    /// The figures of a band.
    pub(super) fn of<H: Height>(band: &Band<'_, H>, mask: &Mask, nominal: &Nominal) -> Self {
        let h = nominal.bead.height;
        let mut tally = Tally::new(nominal);
        let metal = |heights: &[H]| heights.iter().map(|&height| u32::from(height > H::of(OUTSIDE * h))).sum::<u32>();
        let mut outside = 0;
        for (row, heights) in band.rows() {
            band.parts(mask.core(row)).for_each(|columns| tally.add(&heights[columns]));
            let mut end = 0;
            for columns in band.parts(mask.allowed(row)) {
                outside += metal(&heights[end..columns.start]);
                end = columns.end;
            }
            outside += metal(&heights[end..]);
        }
        let cell = band.grid.step * band.grid.step;
        Self { outside: f64::from(outside) * cell, ..tally.figures(cell) }
    }

    /// The figures of a square of ridges, including its voids and humps.
    pub(super) fn of_ridges(square: &Square, ridges: &Ridges, runs: &[Run], grid: &Grid) -> Self {
        let cell = grid.step * grid.step;
        let area = (square.rows.len() * square.columns.len()) as f64 * cell;
        let of = |overfilled: bool| runs.iter().filter(move |run| run.overfilled == overfilled);
        let points = |overfilled: bool| of(overfilled).map(|run| run.columns.len()).sum::<usize>();
        let void = points(false) as f64 * cell;
        Self {
            area,
            void,
            low: (ridges.low * area - void).max(0.0),
            overfill: points(true) as f64 * cell,
            min: ridges.least,
            max: ridges.greatest,
            sum: ridges.mean * area,
            squares: ridges.square * area,
            ..Self::default()
        }
    }

    /// Adds the figures of another part of the layer, or of another layer.
    pub fn add(&mut self, other: &Self) {
        self.min = match (self.area > 0.0, other.area > 0.0) {
            (true, true) => self.min.min(other.min),
            (true, false) => self.min,
            (false, _) => other.min,
        };
        self.max = self.max.max(other.max);
        self.area += other.area;
        self.void += other.void;
        self.low += other.low;
        self.overfill += other.overfill;
        self.outside += other.outside;
        self.deposited_volume += other.deposited_volume;
        self.sum += other.sum;
        self.squares += other.squares;
    }

    /// Void area, % of the judged area.
    pub fn void_percent(&self) -> f64 {
        self.percent(self.void)
    }

    /// Low area, % of the judged area.
    pub fn low_percent(&self) -> f64 {
        self.percent(self.low)
    }

    /// Overfilled area, % of the judged area.
    pub fn overfill_percent(&self) -> f64 {
        self.percent(self.overfill)
    }

    /// Area with metal outside, as % of the judged area.
    pub fn outside_percent(&self) -> f64 {
        self.percent(self.outside)
    }

    /// Mean height, mm.
    pub fn mean(&self) -> f64 {
        if self.area > 0.0 { self.sum / self.area } else { 0.0 }
    }

    /// Standard deviation of the height, mm.
    pub fn deviation(&self) -> f64 {
        let mean = self.mean();
        if self.area > 0.0 { (self.squares / self.area - mean * mean).max(0.0).sqrt() } else { 0.0 }
    }

    /// All figures, percentages included, as JSON.
    pub fn summary(&self) -> serde_json::Value {
        let mut value = serde_json::json!(self);
        value["void_percent"] = self.void_percent().into();
        value["low_percent"] = self.low_percent().into();
        value["overfill_percent"] = self.overfill_percent().into();
        value["outside_percent"] = self.outside_percent().into();
        value["mean_height_mm"] = self.mean().into();
        value["height_deviation_mm"] = self.deviation().into();
        value
    }

    fn percent(&self, part: f64) -> f64 {
        if self.area > 0.0 { 100.0 * part / self.area } else { 0.0 }
    }
}

/// Serializes all of [`Figures`], for `serde(with)`, including the sums that their own serialization for people omits.
pub mod whole {
    use super::Figures;
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    /// Writes ten numbers.
    ///
    /// # Errors
    /// Those of the format.
    pub fn serialize<S: Serializer>(figures: &Figures, serializer: S) -> Result<S::Ok, S::Error> {
        let Figures { area, void, low, overfill, outside, deposited_volume, min, max, sum, squares } = *figures;
        [area, void, low, overfill, outside, deposited_volume, min, max, sum, squares].serialize(serializer)
    }

    /// Reads them.
    ///
    /// # Errors
    /// Those of the format.
    pub fn deserialize<'a, D: Deserializer<'a>>(deserializer: D) -> Result<Figures, D::Error> {
        let [area, void, low, overfill, outside, deposited_volume, min, max, sum, squares] =
            Deserialize::deserialize(deserializer)?;
        Ok(Figures { area, void, low, overfill, outside, deposited_volume, min, max, sum, squares })
    }
}

/// Heights are summed in this many parallel sums, as in SIMD; the order never changes.
const LANES: usize = 8;
/// This many heights are summed in their own precision.
const MOST_ADDED: usize = 64;

/// Sums over the points of the judged area.
struct Tally<H> {
    /// Limits, mm: below the first a point is a void, below the second it is low, above the third overfilled.
    limits: [H; 3],
    points: usize,
    counts: [[u32; LANES]; 3],
    sum: f64,
    squares: f64,
    min: [H; LANES],
    max: [H; LANES],
}

impl<H: Height> Tally<H> {
    fn new(nominal: &Nominal) -> Self {
        Self {
            limits: [VOID, LOW, OVERFILL].map(|limit| H::of(limit * nominal.bead.height)),
            points: 0,
            counts: Default::default(),
            sum: 0.0,
            squares: 0.0,
            min: [H::of(f64::INFINITY); LANES],
            max: Default::default(),
        }
    }

    fn add(&mut self, heights: &[H]) {
        self.points += heights.len();
        // A few dozen points are summed in their own precision, longer sums in double.
        heights.chunks(MOST_ADDED).for_each(|heights| self.add_few(heights));
    }

    fn add_few(&mut self, heights: &[H]) {
        let [void, low, overfill] = self.limits;
        let [mut sums, mut squares] = [[H::default(); LANES]; 2];
        let mut add = |heights: &[H]| {
            for (k, &height) in heights.iter().enumerate() {
                self.counts[0][k] += u32::from(height < void);
                self.counts[1][k] += u32::from(height < low);
                self.counts[2][k] += u32::from(height > overfill);
                sums[k] = sums[k] + height;
                squares[k] = squares[k] + height * height;
                self.min[k] = if height < self.min[k] { height } else { self.min[k] };
                self.max[k] = if height > self.max[k] { height } else { self.max[k] };
            }
        };
        let (whole, rest) = heights.as_chunks::<LANES>();
        whole.iter().for_each(|heights| add(heights));
        add(rest);
        self.sum += sums.iter().map(|sum| sum.mm()).sum::<f64>();
        self.squares += squares.iter().map(|square| square.mm()).sum::<f64>();
    }

    fn figures(&self, cell: f64) -> Figures {
        let [void, low, overfill] = self.counts.map(|lanes| lanes.iter().sum::<u32>());
        let min = self.min.iter().map(|h| h.mm()).fold(f64::INFINITY, f64::min);
        Figures {
            area: self.points as f64 * cell,
            void: f64::from(void) * cell,
            low: f64::from(low - void) * cell,
            overfill: f64::from(overfill) * cell,
            min: if self.points > 0 { min } else { 0.0 },
            max: self.max.iter().map(|h| h.mm()).fold(0.0, f64::max),
            sum: self.sum * cell,
            squares: self.squares * cell,
            ..Figures::default()
        }
    }
}
