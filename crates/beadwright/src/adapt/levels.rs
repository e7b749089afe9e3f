//! Where the layers that follow lie: their number and thickness are such that the last one ends at the height of the
//! part.

use crate::layer::Layer;

/// The planned layers as a scale: a height is a number of layers, with fractions.
#[derive(Debug, Clone)]
pub struct Levels {
    /// The floor of the lowest layer, then the top of each, mm.
    tops: Vec<f64>,
}

/// The next layer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rung {
    /// Its top, mm.
    pub top: f64,
    /// Its thickness, mm.
    pub height: f64,
    /// Index of the planned layer at the height of its middle: its passes are welded.
    pub source: usize,
}

impl Levels {
    /// The scale of a plan; `None` without layers.
    pub fn of(layers: &[Layer]) -> Option<Self> {
        let first = layers.first()?;
        let tops: Vec<f64> = [first.z - first.height].into_iter().chain(layers.iter().map(|layer| layer.z)).collect();
        tops.is_sorted_by(|a, b| a < b).then_some(Self { tops })
    }

    /// The height at which the plan ends, mm.
    pub fn end(&self) -> f64 {
        self.tops[self.tops.len() - 1]
    }

    /// The next of the layers that lead from the height `built` (mm) to the end, all the same fraction of the planned
    /// ones; `None` where less than half a layer is missing. Their number is the one that changes their thickness
    /// least.
    ///
    /// ```
    /// use beadwright::{Layer, adapt::Levels};
    ///
    /// // Three layers of 2 mm were planned; the first came out 2.1 mm high, so two of 1.95 mm follow.
    /// let layers = [2.0, 4.0, 6.0].map(|z| Layer { z, height: 2.0, ..Layer::default() });
    /// let levels = Levels::of(&layers).ok_or("no layers")?;
    /// let rung = levels.next(2.1).ok_or("nothing is missing")?;
    /// assert!((rung.height - 1.95).abs() < 1e-9);
    /// assert!(levels.next(5.5).is_none(), "less than half a layer");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn next(&self, built: f64) -> Option<Rung> {
        let (from, planned) = (self.number_at(built), self.tops.len() - 1);
        let left = planned as f64 - from;
        if left < 0.5 {
            return None;
        }
        let fewer = left.floor().max(1.0);
        let count = if left / fewer <= (fewer + 1.0) / left { fewer } else { fewer + 1.0 };
        let each = left / count;
        let top = self.height_at(from + each);
        let source = ((from + each / 2.0).max(0.0) as usize).min(planned - 1);
        Some(Rung { top, height: top - built, source })
    }

    /// The number of planned layers, with fractions, up to a height (mm).
    fn number_at(&self, z: f64) -> f64 {
        let k = self.tops.partition_point(|top| *top <= z).clamp(1, self.tops.len() - 1);
        (k - 1) as f64 + (z - self.tops[k - 1]) / (self.tops[k] - self.tops[k - 1])
    }

    /// The height at which this number of planned layers ends, mm.
    fn height_at(&self, number: f64) -> f64 {
        let k = (number.max(0.0) as usize).min(self.tops.len() - 2);
        self.tops[k] + (number - k as f64) * (self.tops[k + 1] - self.tops[k])
    }
}
