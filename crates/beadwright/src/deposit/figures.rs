//! Areas and heights of a layer, or of many.

use super::field::Band;
use super::stroke::Nominal;
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
    /// Area with metal outside the outline and its allowance.
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
    /// Squared height times area.
    #[serde(skip)]
    squares: f64,
}

impl Figures {
    /// The figures of a band.
    pub(super) fn of(band: &Band<'_>, mask: &Mask, nominal: &Nominal) -> Self {
        let h = nominal.bead.height;
        let mut count = Counts::default();
        let (mut sum, mut squares, mut min, mut max) = (0.0, 0.0, f64::INFINITY, 0.0_f64);
        for (row, heights) in band.rows() {
            for columns in mask.core(band.grid, row) {
                for &height in &heights[columns] {
                    count.core += 1;
                    count.void += usize::from(height < VOID * h);
                    count.low += usize::from(height < LOW * h);
                    count.overfill += usize::from(height > OVERFILL * h);
                    sum += height;
                    squares += height * height;
                    min = min.min(height);
                    max = max.max(height);
                }
            }
            let metal = |heights: &[f64]| heights.iter().filter(|&&height| height > OUTSIDE * h).count();
            let allowed: usize = mask.allowed(band.grid, row).map(|columns| metal(&heights[columns])).sum();
            count.outside += metal(heights) - allowed;
        }
        let cell = band.grid.step * band.grid.step;
        Self {
            area: count.core as f64 * cell,
            void: count.void as f64 * cell,
            low: (count.low - count.void) as f64 * cell,
            overfill: count.overfill as f64 * cell,
            outside: count.outside as f64 * cell,
            deposited_volume: 0.0,
            min: if count.core > 0 { min } else { 0.0 },
            max,
            sum: sum * cell,
            squares: squares * cell,
        }
    }

    /// Takes in the figures of another part of the layer, or of another layer.
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

    /// Area with metal outside, % of the judged area.
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

    /// All figures for machines, the percentages among them.
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

#[derive(Default)]
struct Counts {
    core: usize,
    void: usize,
    low: usize,
    overfill: usize,
    outside: usize,
}
