//! The next layer, corrected by what was measured: how much metal goes where, and at what height the torch runs.

use super::levels::{Levels, Rung};
use super::surface::Surface;
use crate::layer::Layer;
use crate::pass::{Along, Pass};
use glam::DVec3;

/// What is done about a measured error.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Feedback {
    /// Nothing: the plan is welded as it is.
    None,
    /// The layers follow the mean height: their number, the torch, and the metal of a layer as a whole.
    Mean,
    /// Each place gets the metal that it lacks, and the torch keeps its distance there.
    Place,
}

/// How far a correction may go.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rules {
    /// Least and greatest metal per length, as multiples of the planned metal.
    pub window: (f64, f64),
    /// Metal and height change at points this far apart, mm.
    pub spacing: f64,
}

impl Rules {
    /// What may be chosen as the least metal of a window, and as the greatest.
    pub const LIMITS: [std::ops::RangeInclusive<f64>; 2] = [0.1..=1.0, 1.0..=5.0];
    /// The usual window.
    pub const WINDOW: [f64; 2] = [0.7, 1.3];

    /// Whether a window may be chosen.
    pub fn allow(window: [f64; 2]) -> bool {
        Self::LIMITS.iter().zip(window).all(|(limits, end)| limits.contains(&end))
    }
}

/// The next layer.
#[derive(Debug, Clone)]
pub(crate) struct Next {
    /// What it should add, the same everywhere: the planned passes, with metal for its thickness.
    pub promised: Layer,
    /// What is welded.
    pub layer: Layer,
    /// Least and greatest metal of its passes, as multiples of the planned metal.
    pub metal: (f64, f64),
    /// Number of pieces in its passes.
    pub pieces: usize,
    /// Number of pieces that need more or less metal than the window allows.
    pub clipped: usize,
}

/// The next layer on a surface whose level is its mean height; `None` where the part is complete. `index` counts from
/// 0.
pub(crate) fn next(
    planned: &[Layer],
    levels: &Levels,
    surface: &Surface,
    index: usize,
    by: Feedback,
    rules: &Rules,
) -> Option<Next> {
    let rung = match by {
        Feedback::None => {
            let layer = planned.get(index)?;
            Rung { top: layer.z, height: layer.height, source: index }
        }
        Feedback::Mean | Feedback::Place => levels.next(surface.level())?,
    };
    let source = planned.get(rung.source)?;
    let thicker = rung.height / source.height;
    let mut correction = Correction {
        surface,
        rules,
        rung,
        planned: source.height,
        by,
        pieces: 0,
        clipped: 0,
        metal: (f64::INFINITY, 0.0),
    };
    let layer = Layer { index, z: rung.top, height: rung.height, warnings: Vec::new(), ..source.clone() };
    let promised = source.passes.iter().map(|pass| Pass { pace: pass.pace.map(|pace| pace / thicker), ..pass.clone() });
    let passes = source.passes.iter().map(|pass| correction.pass(pass)).collect();
    let Correction { pieces, clipped, metal, .. } = correction;
    let promised = Layer { passes: promised.collect(), ..layer.clone() };
    Some(Next { promised, layer: Layer { passes, ..layer }, metal, pieces, clipped })
}

struct Correction<'a> {
    surface: &'a Surface,
    rules: &'a Rules,
    rung: Rung,
    /// Thickness of the layer that the planned metal fills, mm.
    planned: f64,
    by: Feedback,
    pieces: usize,
    clipped: usize,
    metal: (f64, f64),
}

impl Correction<'_> {
    fn pass(&mut self, planned: &Pass) -> Pass {
        let mut pass = if self.by == Feedback::Place { pieces(planned, self.rules.spacing) } else { planned.clone() };
        let middles: Vec<(DVec3, f64, f64)> =
            pass.segments().map(|s| (s.from.midpoint(s.to), s.width, s.pace)).collect();
        let mut paces: Vec<f64> = middles.into_iter().map(|(at, width, pace)| pace / self.metal(at, width)).collect();
        let heights: Vec<f64> =
            pass.points.iter().enumerate().map(|(i, p)| self.torch(*p, pass.width.after(i))).collect();
        pass.points.iter_mut().zip(heights).for_each(|(point, z)| point.z = z);
        paces.extend(paces.last().copied().filter(|_| !pass.closed));
        pass.pace = if paces.iter().all(|pace| *pace == paces[0]) { Along::Same(paces[0]) } else { Along::Each(paces) };
        pass
    }

    /// Metal at a place as a multiple of the planned metal, within the window.
    fn metal(&mut self, at: DVec3, width: f64) -> f64 {
        let wanted = (self.rung.height - self.error(at, width)) / self.planned;
        self.pieces += 1;
        if self.by == Feedback::None {
            return 1.0;
        }
        let (least, most) = self.rules.window;
        let metal = wanted.clamp(least, most);
        self.clipped += usize::from(metal != wanted);
        self.metal = (self.metal.0.min(metal), self.metal.1.max(metal));
        metal
    }

    /// Height of the torch's tool point, mm: one layer thickness above the metal below, but no more than that away from
    /// the layer's top.
    fn torch(&self, at: DVec3, width: f64) -> f64 {
        self.rung.top + self.error(at, width).clamp(-self.rung.height, self.rung.height)
    }

    /// How much too high the metal below a bead is, mm; 0 where that is not corrected for or not known.
    fn error(&self, at: DVec3, width: f64) -> f64 {
        match self.by {
            Feedback::Place => self.surface.mean_around(at.truncate(), width / 2.0).unwrap_or_default(),
            Feedback::None | Feedback::Mean => 0.0,
        }
    }
}

/// A pass cut into pieces at most `longest` (mm) long.
pub fn pieces(pass: &Pass, longest: f64) -> Pass {
    let (mut points, mut widths, mut paces) = (Vec::new(), Vec::new(), Vec::new());
    for segment in pass.segments() {
        let count = (segment.length() / longest).ceil().max(1.0) as usize;
        for k in 0..count {
            points.push(segment.from.lerp(segment.to, k as f64 / count as f64));
            widths.push(segment.width);
            paces.push(segment.pace);
        }
    }
    if let Some(end) = pass.points.last().filter(|_| !pass.closed) {
        points.push(*end);
        widths.extend(widths.last().copied());
        paces.extend(paces.last().copied());
    }
    Pass { points, width: Along::Each(widths), pace: Along::Each(paces), ..pass.clone() }
}
