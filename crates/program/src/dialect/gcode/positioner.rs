//! Rotary axes under the part, on controls with tool centre point control, which keeps the torch's tip on the part
//! while the axes turn.

use super::section::is_axis;
use crate::dialect::Templates;
use crate::number::push_fixed;
use crate::program::{Held, Positioner, ProgramSettings};
use bead_plan::limit::Broken;
use glam::{DQuat, DVec3};
use serde::{Deserialize, Serialize};

/// What the key is for.
pub(super) const TABLE: &str = "It says how the control names the axes that turn the part, and how it keeps the torch's tip on the \
                                part while they turn.";

/// Decimal places of angles, °: 0.001° is less than 0.01 mm at half a metre.
const DECIMALS: usize = 3;

/// The table `[gcode.positioner]`: rotary axes under the part, and how the control keeps the torch's tip on the part
/// while they turn. With that on, X, Y and Z are positions on the part and F is the speed of the tip along the part.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct GcodePositioner {
    /// The addresses of the axes, in the order of `program.positioner.axes`, such as `["A", "C"]`, or `["A=", "C="]`
    /// (Siemens).
    pub axes: Vec<String>,
    /// Blocks that switch tool centre point control on: `M428` (LinuxCNC's example of a tilting table), `G43.4 H1` (Fanuc),
    /// `TRAORI` (Siemens).
    pub tcp_on: Vec<String>,
    /// Blocks that switch it off, so that X, Y and Z are the machine's axes again: `M429`, `G49`, `TRAFOOF`.
    pub tcp_off: Vec<String>,
}

impl GcodePositioner {
    pub(super) fn templates(&self) -> Templates<'_> {
        vec![("gcode.positioner.tcp_on", &self.tcp_on), ("gcode.positioner.tcp_off", &self.tcp_off)]
    }

    pub(super) fn broken(&self, program: &ProgramSettings) -> Option<Broken> {
        let broken = |key: &str, value: String, reason: &str| {
            Some(Broken { key: format!("gcode.positioner.{key}"), value, reason: reason.to_owned() })
        };
        if let Some(axis) = self.axes.iter().find(|axis| !is_axis(axis)) {
            let reason =
                "it must be one letter that no other word uses, or a letter, a number and =, such as \"A\" or \"C1=\".";
            return broken("axes", format!("{axis:?}"), reason);
        }
        if self.tcp_on.is_empty() || self.tcp_off.is_empty() {
            let reason =
                "the control must keep the torch's tip on the part, and be able to stop it: give the blocks of both.";
            return broken("tcp_on and tcp_off", "[]".to_owned(), reason);
        }
        let own = program.positioner.as_ref()?;
        if own.count() != self.axes.len() {
            let reason = "program.positioner.axes has another number of axes.";
            return broken("axes", format!("{:?}", self.axes), reason);
        }
        let lies = standing(own).angle_between(DQuat::IDENTITY) > 1e-9;
        (program.arcs && lies).then(|| Broken {
            key: "program.arcs".to_owned(),
            value: "true".to_owned(),
            reason:
                "G2 and G3 run in the plane of X and Y, and program.positioner.up is not the part's z: set it to false."
                    .to_owned(),
        })
    }
}

/// The rotation from directions of the part, with all axes at 0, to those of the machine.
fn standing(positioner: &Positioner) -> DQuat {
    positioner.held([0.0; 2]).turn
}

/// The state of the axes while a program is written.
pub(super) struct Axes {
    pub(super) words: GcodePositioner,
    /// Greatest speeds, °/s.
    speeds: Vec<f64>,
    standing: DQuat,
    /// How the part is to be held from the next move on.
    pub(super) held: Option<Held>,
    /// See [`written`](Axes::written).
    written: Option<[f64; 2]>,
}

impl Axes {
    pub(super) fn new(words: &GcodePositioner, positioner: &Positioner) -> Self {
        let speeds = positioner.axes.iter().map(|axis| axis.speed).collect();
        Self { words: words.clone(), speeds, standing: standing(positioner), held: None, written: None }
    }

    /// X, Y and Z, mm, of a point of the part while tool centre point control is on.
    pub(super) fn on_part(&self, place: DVec3) -> DVec3 {
        self.standing * place
    }

    /// The same while it is off.
    pub(super) fn in_machine(&self, place: DVec3) -> DVec3 {
        self.held.map_or(place, |held| held.turn * place + held.shift)
    }

    fn wanted(&self) -> Option<[f64; 2]> {
        let rounded = |angle: f64| (angle * 10_f64.powi(DECIMALS as i32)).round() / 10_f64.powi(DECIMALS as i32);
        self.held.map(|held| held.angles.map(rounded))
    }

    /// Whether the next move turns the part.
    pub(super) fn turns(&self) -> bool {
        self.wanted() != self.written
    }

    /// Time and angle of a turn without any other move, s and °; controls then take F as degrees per minute.
    pub(super) fn turn(&self) -> Option<(f64, f64)> {
        let (from, to) = self.written.zip(self.wanted())?;
        let by: Vec<f64> = (0..self.words.axes.len()).map(|k| (to[k] - from[k]).abs()).collect();
        let seconds = by.iter().zip(&self.speeds).map(|(by, speed)| by / speed).fold(0.0, f64::max);
        Some((seconds, by.iter().map(|by| by * by).sum::<f64>().sqrt()))
    }

    /// Writes the words of the axes that are to turn.
    pub(super) fn write(&mut self, text: &mut String) {
        let Some(wanted) = self.wanted() else { return };
        for (k, word) in self.words.axes.iter().enumerate() {
            if self.written.is_none_or(|written| written[k] != wanted[k]) {
                text.push(' ');
                text.push_str(word);
                push_fixed(text, wanted[k], DECIMALS);
            }
        }
        self.written = Some(wanted);
    }

    /// The angles last written, °; `None` if they are unknown.
    pub(super) fn written(&self) -> Option<[f64; 2]> {
        self.written
    }

    /// Sets the angles of the axes, °; `None` if they are unknown.
    pub(super) fn stand(&mut self, at: Option<[f64; 2]>) {
        self.written = at;
    }
}
