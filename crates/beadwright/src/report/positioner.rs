//! The angles of a positioner over the passes, as plots with its limits.

use super::plot::{Curve, Plot};
use crate::layer::Layer;
use crate::program::{Instruction, Positioner, PositionerAxis, Programmer, Turning};
use glam::DVec2;

/// Maximum number of sections of a curve, each of several passes.
const STRETCHES: usize = 300;
/// Limits are drawn where they lie no farther apart than this many times the range that is used, or half a turn, °.
const WIDE: f64 = 4.0;
const HALF_TURN: f64 = 180.0;

/// Follows a positioner through a plan.
#[derive(Debug, Clone)]
pub(super) struct Turns {
    positioner: Positioner,
    programmer: Programmer,
    passes: Vec<[Stretch; 2]>,
}

/// The angles of an axis along some passes, °.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Stretch {
    first: f64,
    least: f64,
    most: f64,
    last: f64,
}

impl Stretch {
    fn at(angle: f64) -> Self {
        Self { first: angle, least: angle, most: angle, last: angle }
    }

    fn with(self, next: Self) -> Self {
        Self { first: self.first, least: self.least.min(next.least), most: self.most.max(next.most), last: next.last }
    }

    /// The angles in the order in which the axis reaches them, if it reaches each once.
    fn angles(&self) -> [f64; 4] {
        let (a, b) = if self.first <= self.last { (self.least, self.most) } else { (self.most, self.least) };
        [self.first, a, b, self.last]
    }
}

impl Turns {
    /// A positioner before the first layer, and the programmer that turns it.
    pub(super) fn new(positioner: Positioner, programmer: Programmer) -> Self {
        Self { positioner, programmer, passes: Vec::new() }
    }

    /// Takes the next layer.
    pub(super) fn layer(&mut self, layer: &Layer) {
        for instruction in self.programmer.layer(layer).instructions {
            let Some(held) = instruction.attitude().and_then(|attitude| attitude.held) else { continue };
            let here = held.angles.map(Stretch::at);
            match (instruction, self.passes.last_mut()) {
                (Instruction::PassStart { .. }, _) => self.passes.push(here),
                (Instruction::Weld { .. }, Some(pass)) => *pass = [0, 1].map(|axis| pass[axis].with(here[axis])),
                _ => {}
            }
        }
    }

    /// The plots as a section of the report.
    pub(super) fn section(&self) -> String {
        let numbered = self.positioner.axes.iter().enumerate();
        let pictures: String = numbered.map(|(number, axis)| self.plot(number, axis).svg()).collect();
        let when = match self.positioner.turning {
            Turning::Index => "between passes",
            Turning::IndexAtHome => "between passes, with the torch at home",
            Turning::Follow => "at every point",
        };
        format!(
            "<section class=\"card\"><h2>Positioner</h2>\n<p>The part is turned {when}. Travels wait {:.0} s in all until it has turned.</p>\n\
             <div class=\"plots\" role=\"group\" tabindex=\"0\" \
             aria-label=\"Angles of the positioner over the passes\">{pictures}</div>\n</section>",
            self.programmer.waited()
        )
    }

    fn plot(&self, number: usize, axis: &PositionerAxis) -> Plot {
        let [least, most] = axis.limits;
        Plot {
            title: format!("Axis {}, limits {least}° to {most}°", number + 1),
            x: "passes welded".to_owned(),
            y: "angle, °".to_owned(),
            curves: vec![Curve { name: format!("axis {}", number + 1), points: self.points(number) }],
            bands: self.within(number, axis).into_iter().collect(),
            floating: true,
            ..Plot::default()
        }
    }

    fn points(&self, axis: usize) -> Vec<DVec2> {
        let size = self.passes.len().div_ceil(STRETCHES).max(1);
        let stretches = self.passes.chunks(size).enumerate().filter_map(|(k, passes)| {
            let whole = passes.iter().map(|pass| pass[axis]).reduce(Stretch::with)?;
            let at = |i: usize| (k * size) as f64 + passes.len() as f64 * i as f64 / 3.0;
            Some([0, 1, 2, 3].map(|i| DVec2::new(at(i), whole.angles()[i])))
        });
        stretches.flatten().collect()
    }

    /// The limits as a range to be drawn; `None` if they would flatten the curve.
    fn within(&self, number: usize, axis: &PositionerAxis) -> Option<(f64, f64, String)> {
        let whole = self.passes.iter().map(|pass| pass[number]).reduce(Stretch::with)?;
        let [least, most] = axis.limits;
        let near = most - least <= WIDE * (whole.most - whole.least).max(HALF_TURN);
        near.then(|| (least, most, "within its limits".to_owned()))
    }
}
