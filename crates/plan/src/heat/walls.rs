//! Beads by the temperature of the metal below: fitted to measured walls, and used to predict others.
//!
//! With the same program, a wall left to cool between layers grows higher and thinner. The thickness and the width of a
//! layer are assumed to be linear in the temperature of the metal just ahead of the torch: `layer = a + b · T`,
//! `width = c + d · T`, fitted by least squares to whole walls.

use super::build::Build;
use super::settings::HeatSettings;
use crate::bead::BeadByHeat;
use crate::layer::Layer;
use crate::pass::{Along, Pass, PassKind};
use crate::weld::WeldSettings;
use glam::{DVec2, dvec2};
use planar::{Bounds, Polygon, Ring};

/// A wall of one bead per layer, welded back and forth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wall {
    /// Length, mm.
    pub length: f64,
    /// Number of layers.
    pub layers: usize,
    /// Wait between layers, s.
    pub dwell: f64,
}

/// What was measured on a wall.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeasuredWall {
    /// How it was welded.
    pub wall: Wall,
    /// Height, mm.
    pub height: f64,
    /// Mean width, mm.
    pub width: f64,
}

/// A value that is linear in the temperature of the metal ahead of the torch.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct ByHeat {
    /// Value at 0 °C, mm.
    pub cold: f64,
    /// Change with temperature, mm/K.
    pub slope: f64,
}

/// How thickness and width of layers depend on temperature.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct WallLaw {
    /// Thickness of a layer.
    pub layer: ByHeat,
    /// Width of the wall.
    pub width: ByHeat,
}

/// A predicted wall.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct PredictedWall {
    /// Mean temperature of the metal ahead of the torch over all layers, °C.
    pub temperature: f64,
    /// Height, mm.
    pub height: f64,
    /// Mean width, mm.
    pub width: f64,
}

/// Why no law can be fitted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum WallFitError {
    /// Too few walls.
    #[error("a law that depends on heat needs two walls or more that were welded with different waits.")]
    TooFew,
    /// All walls were equally warm.
    #[error("all walls are equally warm (within 10 °C): weld them with waits that differ more.")]
    Alike,
}

impl ByHeat {
    /// The value at a temperature (°C), mm.
    pub fn at(&self, temperature: f64) -> f64 {
        self.cold + self.slope * temperature
    }

    /// The line through measured values, least squares.
    fn fit(points: &[DVec2]) -> Result<Self, WallFitError> {
        let mean = points.iter().sum::<DVec2>() / points.len().max(1) as f64;
        let [spread, common] =
            [|d: DVec2| d.x * d.x, |d: DVec2| d.x * d.y].map(|of| points.iter().map(|p| of(p - mean)).sum::<f64>());
        let (low, high) = points.iter().fold((f64::MAX, f64::MIN), |(low, high), p| (low.min(p.x), high.max(p.x)));
        if points.len() < 2 {
            return Err(WallFitError::TooFew);
        }
        if high - low < 10.0 {
            return Err(WallFitError::Alike);
        }
        let slope = common / spread;
        Ok(Self { cold: mean.y - slope * mean.x, slope })
    }
}

impl WallLaw {
    /// Fits measured walls; the temperatures of each come from the heat model.
    ///
    /// # Errors
    /// [`WallFitError`].
    pub fn fit(walls: &[MeasuredWall], settings: &HeatSettings, weld: &WeldSettings) -> Result<Self, WallFitError> {
        let layer = |w: &MeasuredWall| w.height / w.wall.layers.max(1) as f64;
        let warm = |w: &MeasuredWall| temperature(&w.wall, layer(w), w.width, settings, weld);
        let temperatures: Vec<f64> = walls.iter().map(warm).collect();
        let fit = |value: &dyn Fn(&MeasuredWall) -> f64| {
            let points = temperatures.iter().zip(walls).map(|(t, wall)| dvec2(*t, value(wall)));
            ByHeat::fit(&points.collect::<Vec<_>>())
        };
        Ok(Self { layer: fit(&layer)?, width: fit(&|w| w.width)? })
    }

    /// The law for a profile whose bead has this width (mm), referred to the temperature that gives that width. `None`
    /// if that is no temperature of solid metal.
    pub fn by_heat(&self, width: f64) -> Option<BeadByHeat> {
        /// Coldest and hottest metal that is welded onto, °C.
        const SOLID: (f64, f64) = (-50.0, 1500.0);
        let temperature = (width - self.width.cold) / self.width.slope;
        let law = BeadByHeat { temperature, width: self.width.slope, rise: self.layer.slope };
        (SOLID.0..=SOLID.1).contains(&temperature).then_some(law)
    }

    /// Predicts a wall. Its layers depend on its temperature and vice versa, so both are found by iteration.
    pub fn predict(&self, wall: &Wall, settings: &HeatSettings, weld: &WeldSettings) -> PredictedWall {
        /// Iterations; each brings the temperature closer by a factor of ten or more.
        const TURNS: usize = 3;
        let mut mean = 300.0;
        for _ in 0..TURNS {
            let [layer, width] = [self.layer, self.width].map(|law| law.at(mean).max(0.1));
            mean = temperature(wall, layer, width, settings, weld);
        }
        let [layer, width] = [self.layer, self.width].map(|law| law.at(mean).max(0.1));
        PredictedWall { temperature: mean, height: layer * wall.layers as f64, width }
    }
}

/// Mean temperature of the metal ahead of the torch over all layers of a wall, °C.
fn temperature(wall: &Wall, layer: f64, width: f64, settings: &HeatSettings, weld: &WeldSettings) -> f64 {
    let half = dvec2(wall.length, width) / 2.0;
    let tops: Vec<(f64, f64)> = (1..=wall.layers).map(|n| (n as f64 * layer, layer)).collect();
    let mut build = Build::new(settings, weld, &Bounds { min: -half, max: half }, &tops);
    let (mut sum, mut count) = (0.0, 0.0);
    for (index, &(z, height)) in tops.iter().enumerate() {
        let corners = [dvec2(-half.x, -half.y), dvec2(half.x, -half.y), half, dvec2(-half.x, half.y)];
        let ends = [dvec2(-half.x, 0.0), dvec2(half.x, 0.0)].map(|p| p.extend(z));
        let points = if index % 2 == 0 { ends.to_vec() } else { vec![ends[1], ends[0]] };
        let (width, pace) = (Along::Same(width), Along::Same(weld.process.deposition_speed));
        let wait = if index > 0 { wall.dwell } else { 0.0 };
        let pass = Pass { kind: PassKind::Wall, closed: false, points, width, pace, wait };
        let islands = vec![Polygon::simple(Ring::new(corners.to_vec()))];
        let heat = build.layer(&Layer { index, z, height, islands, passes: vec![pass], ..Layer::default() });
        for ahead in heat.passes.iter().flat_map(|pass| &pass.along) {
            (sum, count) = (sum + ahead, count + 1.0);
        }
    }
    if count > 0.0 { sum / count } else { settings.heat.ambient }
}
