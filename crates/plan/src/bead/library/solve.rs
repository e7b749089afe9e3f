//! Finds the parameters that lay a wanted bead.
//!
//! 1. A grid covers the measured range inside the limits.
//! 2. From its best points, Levenberg–Marquardt steps inside the range reduce the deviations of width and layer height.
//!    A slight pull to λ = 2.5–3 and to the middle of the range decides where many parameters lay the same bead.
//! 3. Last come the same steps without the pull.
//!
//! Nothing is random, so the same wish has the same answer.

use super::least_squares::{Factored, dot};
use super::{BeadLibrary, Input, LibraryError, Prediction};
use crate::bead::wall::WallBead;

/// λ = width/height of good beads (Li et al., section 3).
pub const PREFERRED_RATIOS: (f64, f64) = (2.5, 3.0);
/// Weights of the pull to the preferred λ and of the pull to the middle of the range; relative deviations have weight
/// 1.
const PULL: (f64, f64) = (1e-4, 1e-5);
/// Weight of the penalty for leaving the measured region.
const BARRIER: f64 = 10.0;
/// Most points of the grid, and how many of them are followed.
const GRID: usize = 5000;
const STARTS: usize = 12;
/// A coded value this close to a bound counts as lying on it.
const TOUCHES: f64 = 1e-6;

/// How a layer height is to be understood.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Layering {
    /// A wall of one bead per layer: the rise h_n of [`WallBead`].
    SinglePass,
    /// A closed layer of neighbouring beads: the rise of the [`Bead`](crate::bead::Bead) at this stepover, mm.
    Overlapping {
        /// Distance of neighbouring centre-lines, mm.
        stepover: f64,
    },
}

impl Layering {
    /// Layer height that a predicted bead gives, mm; 0 where the prediction is not a bead.
    pub fn height(self, found: &Prediction) -> f64 {
        let bead = found.bead();
        match self {
            Self::SinglePass => WallBead::new(bead.width, bead.height).map_or(0.0, |wall| wall.rise()),
            Self::Overlapping { stepover } => bead.rise(stepover),
        }
    }
}

/// A narrower range of an input.
#[derive(Debug, Clone, PartialEq)]
pub struct Limit {
    /// Name of the input, with or without its unit.
    pub input: String,
    /// Least value that is wanted.
    pub min: f64,
    /// Greatest value that is wanted.
    pub max: f64,
}

/// A wanted bead.
#[derive(Debug, Clone, PartialEq)]
pub struct Wish {
    /// Width of the bead, mm.
    pub width: f64,
    /// Height of a layer, mm.
    pub layer_height: f64,
    /// How that height is to be understood.
    pub layering: Layering,
    /// Limits on the inputs.
    pub limits: Vec<Limit>,
    /// Relative deviation of width and layer height up to which the wish counts as met.
    pub tolerance: f64,
}

impl Wish {
    /// A wish for a wall of one bead per layer, met within 0.5 %.
    pub fn new(width: f64, layer_height: f64) -> Self {
        Self { width, layer_height, layering: Layering::SinglePass, limits: Vec::new(), tolerance: 0.005 }
    }
}

/// Parameters that meet a request.
#[derive(Debug, Clone, PartialEq)]
pub struct Recipe {
    /// One value per input, in the library's order.
    pub values: Vec<f64>,
    /// The bead they lay.
    pub prediction: Prediction,
    /// Height of its layers, mm.
    pub layer_height: f64,
    /// Remarks, as sentences.
    pub notes: Vec<String>,
}

impl BeadLibrary {
    /// Parameters inside the measured range and the limits that lay the wanted bead.
    ///
    /// ```
    /// use bead_plan::bead::library::{BeadLibrary, Columns, Layering, Measured, Wish, demonstration_csv};
    ///
    /// let library = BeadLibrary::fit(&Measured::read(&demonstration_csv(), &Columns::default())?)?;
    /// let bead = library.predict(&[125.0, 8.0])?.bead();
    /// let layering = Layering::Overlapping { stepover: 0.7 * bead.width };
    /// let wish = Wish { layering, ..Wish::new(bead.width, bead.rise(0.7 * bead.width)) };
    /// let recipe = library.solve(&wish)?;
    /// assert!((recipe.prediction.width.value / bead.width - 1.0).abs() < 0.01);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`LibraryError::OutOfReach`] names the blocking bounds and the nearest bead; [`LibraryError::Outside`] a limit
    /// that shares nothing with the measured range.
    pub fn solve(&self, wish: &Wish) -> Result<Recipe, LibraryError> {
        for (name, value) in [("width", wish.width), ("layer height", wish.layer_height), ("tolerance", wish.tolerance)]
        {
            if !(value.is_finite() && value > 0.0) {
                return Err(LibraryError::Wish {
                    reason: format!("a {name} of {value} is impossible: it must be above 0."),
                });
            }
        }
        let search = Search { library: self, wish, ranges: self.ranges(&wish.limits)? };
        let coded = search.run();
        let values: Vec<f64> = self.inputs.iter().zip(&coded).map(|(input, &z)| input.value(z)).collect();
        let prediction = self.at(&coded);
        let layer_height = wish.layering.height(&prediction);
        if search.deviation(&coded) > wish.tolerance {
            return Err(LibraryError::OutOfReach {
                width: wish.width,
                layer_height: wish.layer_height,
                blocked: search.blocked(&coded),
                near_width: prediction.width.value,
                near_layer: layer_height,
                point: self.describe(&values),
            });
        }
        let notes = ratio_note(prediction.ratio()).into_iter().collect();
        Ok(Recipe { prediction: self.predict(&values)?, values, layer_height, notes })
    }

    /// The measured ranges narrowed to the limits, as coded values.
    fn ranges(&self, limits: &[Limit]) -> Result<Vec<(f64, f64)>, LibraryError> {
        let mut ranges = vec![(-1.0_f64, 1.0_f64); self.inputs.len()];
        for limit in limits {
            let k = self.input_number(&limit.input)?;
            let input = &self.inputs[k];
            if limit.min > limit.max || limit.min.is_nan() || limit.max.is_nan() {
                let reason = format!(
                    "the limit {}={}..{} holds no value: write the smaller one first.",
                    limit.input, limit.min, limit.max
                );
                return Err(LibraryError::Wish { reason });
            }
            // Only a limit that lies wholly outside the measured range is refused.
            if limit.min > input.max || limit.max < input.min {
                input.check(if limit.min > input.max { limit.min } else { limit.max })?;
            }
            let (low, high) = ranges[k];
            ranges[k] = (low.max(input.coded(limit.min)), high.min(input.coded(limit.max)));
            if ranges[k].0 > ranges[k].1 {
                return Err(LibraryError::Wish { reason: format!("the limits of {} leave no value.", input.name) });
            }
        }
        Ok(ranges)
    }
}

fn ratio_note(ratio: f64) -> Option<String> {
    let (low, high) = PREFERRED_RATIOS;
    let side = if ratio < low { "below" } else { "above" };
    (!(low..=high).contains(&ratio)).then(|| {
        format!("width/height is {ratio:.2}, {side} the {low} to {high} of good beads (Li et al.); weld a trial.")
    })
}

struct Search<'a> {
    library: &'a BeadLibrary,
    wish: &'a Wish,
    ranges: Vec<(f64, f64)>,
}

impl Search<'_> {
    /// The best coded point.
    fn run(&self) -> Vec<f64> {
        let mut starts: Vec<(f64, Vec<f64>)> = self.grid().into_iter().map(|z| (self.cost(&z, 1.0), z)).collect();
        starts.sort_by(|a, b| a.0.total_cmp(&b.0));
        starts.truncate(STARTS);
        let ends = starts.into_iter().map(|(_, z)| self.descend(z, 1.0));
        let best = ends.min_by(|a, b| self.cost(a, 1.0).total_cmp(&self.cost(b, 1.0))).unwrap_or_default();
        let sharp = self.descend(best.clone(), 0.0);
        // Without the pull the steps may end at the edge of the measured region; then the pulled point is kept.
        if self.inside(&sharp) && self.deviation(&sharp) < self.deviation(&best) {
            sharp
        } else {
            self.brought_in(best)
        }
    }

    /// The barrier is soft: a point slightly outside is drawn towards the middle of the measurements.
    fn brought_in(&self, mut z: Vec<f64>) -> Vec<f64> {
        for _ in 0..200 {
            if self.inside(&z) {
                break;
            }
            z.iter_mut().zip(&self.ranges).for_each(|(z, (low, high))| *z = (*z * 0.999).clamp(*low, *high));
        }
        z
    }

    fn inside(&self, z: &[f64]) -> bool {
        self.library.at(z).leverage <= self.library.largest_leverage
    }

    fn grid(&self) -> Vec<Vec<f64>> {
        let most = (GRID as f64).powf(1.0 / self.ranges.len() as f64).floor().clamp(3.0, 41.0) as usize;
        let mut points = vec![Vec::new()];
        for (low, high) in &self.ranges {
            let steps = if high > low { most } else { 1 };
            let at = |i: usize| if steps > 1 { low + (high - low) * i as f64 / (steps - 1) as f64 } else { *low };
            let longer = points.iter().flat_map(|p: &Vec<f64>| (0..steps).map(move |i| [&p[..], &[at(i)]].concat()));
            points = longer.collect();
        }
        points
    }

    /// Greatest relative deviation of width and layer height.
    fn deviation(&self, z: &[f64]) -> f64 {
        let [width, layer] = self.misses(&self.library.at(z));
        width.abs().max(layer.abs())
    }

    fn misses(&self, found: &Prediction) -> [f64; 2] {
        let layer = self.wish.layering.height(found);
        [found.width.value / self.wish.width - 1.0, layer / self.wish.layer_height - 1.0]
    }

    /// What the steps minimise: the deviations, the barrier around the measurements, the pull.
    fn residuals(&self, z: &[f64], pull: f64) -> Vec<f64> {
        let found = self.library.at(z);
        let limit = self.library.largest_leverage;
        let [width, layer] = self.misses(&found);
        let ratio = found.ratio();
        let off = (PREFERRED_RATIOS.0 - ratio).max(ratio - PREFERRED_RATIOS.1).max(0.0);
        let mut residuals = vec![width, layer, BARRIER * (found.leverage / limit - 1.0).max(0.0), pull * PULL.0 * off];
        residuals.extend(z.iter().map(|z| pull * PULL.1 * z));
        residuals
    }

    fn cost(&self, z: &[f64], pull: f64) -> f64 {
        let residuals = self.residuals(z, pull);
        dot(&residuals, &residuals)
    }

    /// Levenberg–Marquardt inside the ranges.
    fn descend(&self, mut z: Vec<f64>, pull: f64) -> Vec<f64> {
        let (mut cost, mut damping) = (self.cost(&z, pull), 1e-3);
        for _ in 0..300 {
            let next = self.step(&z, pull, damping);
            let length = z.iter().zip(&next).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            let next_cost = self.cost(&next, pull);
            if next_cost < cost {
                (z, cost, damping) = (next, next_cost, damping / 5.0);
            } else {
                damping *= 4.0;
            }
            if length < 1e-14 || damping > 1e12 {
                break;
            }
        }
        z
    }

    /// One damped step; values at a bound that the step would push further out are kept.
    fn step(&self, z: &[f64], pull: f64, damping: f64) -> Vec<f64> {
        let residuals = self.residuals(z, pull);
        let mut free: Vec<usize> = (0..z.len()).filter(|&k| self.ranges[k].1 > self.ranges[k].0).collect();
        loop {
            let change = self.change(z, &residuals, &free, pull, damping);
            let out = |&(&k, d): &(&usize, &f64)| {
                let (low, high) = self.ranges[k];
                (z[k] <= low && *d < 0.0) || (z[k] >= high && *d > 0.0)
            };
            let stuck: Vec<usize> = free.iter().zip(&change).filter(out).map(|(&k, _)| k).collect();
            if stuck.is_empty() {
                let mut next = z.to_vec();
                for (&k, d) in free.iter().zip(&change) {
                    next[k] = (z[k] + d).clamp(self.ranges[k].0, self.ranges[k].1);
                }
                return next;
            }
            free.retain(|k| !stuck.contains(k));
        }
    }

    /// Least squares of the linearised residuals with damping, over the free inputs.
    fn change(&self, z: &[f64], residuals: &[f64], free: &[usize], pull: f64, damping: f64) -> Vec<f64> {
        const H: f64 = 1e-6;
        let moved = |k: usize, by: f64| {
            let mut moved = z.to_vec();
            moved[k] += by;
            self.residuals(&moved, pull)
        };
        let column = |(place, &k): (usize, &usize)| {
            let (ahead, behind) = (moved(k, H), moved(k, -H));
            let mut column: Vec<f64> = ahead.iter().zip(&behind).map(|(a, b)| (a - b) / (2.0 * H)).collect();
            column.extend((0..free.len()).map(|i| if i == place { damping.sqrt().max(1e-8) } else { 0.0 }));
            column
        };
        let columns: Vec<Vec<f64>> = free.iter().enumerate().map(column).collect();
        let mut target: Vec<f64> = residuals.iter().map(|r| -r).collect();
        target.resize(residuals.len() + free.len(), 0.0);
        let factored = Factored::new(&columns);
        let solved = factored.solve(&target);
        let mut change = vec![0.0; free.len()];
        factored.kept.iter().zip(solved).for_each(|(&k, d)| change[k] = d);
        change
    }

    /// The bounds that keep the nearest point from coming closer to the wish.
    fn blocked(&self, z: &[f64]) -> String {
        let mut bounds: Vec<String> = Vec::new();
        for ((k, input), (low, high)) in self.library.inputs.iter().enumerate().zip(&self.ranges) {
            for (bound, end) in [(*low, -1.0), (*high, 1.0)] {
                if (z[k] - bound).abs() < TOUCHES && self.would_help(z, k, end) {
                    bounds.push(bound_words(input, bound, end));
                }
            }
        }
        if self.library.at(z).leverage > self.library.largest_leverage * 0.99 {
            bounds.push("no bead was measured with parameters further in that direction (leverage)".to_owned());
        }
        match bounds.len() {
            0 => "inside the measured range no parameters meet both at once".to_owned(),
            _ => bounds.join("; "),
        }
    }

    /// Whether moving input k beyond its bound would bring width and layer height closer to the wish.
    fn would_help(&self, z: &[f64], k: usize, end: f64) -> bool {
        let miss = |z: &[f64]| self.misses(&self.library.at(z)).map(|m| m * m).iter().sum::<f64>();
        let mut beyond = z.to_vec();
        beyond[k] += end * 1e-3;
        miss(&beyond) < miss(z)
    }
}

/// `current would have to be above its measured 250 A`; `end` is −1 at the lower bound, 1 at the upper.
fn bound_words(input: &Input, bound: f64, end: f64) -> String {
    let side = if end < 0.0 { "below" } else { "above" };
    let whose = if (bound - end).abs() < TOUCHES { "its measured" } else { "its limit of" };
    let value = super::rounded(input.value(bound));
    format!("{} would have to be {side} {whose} {value} {}", input.name, input.unit).trim_end().to_owned()
}
