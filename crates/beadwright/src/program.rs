//! The neutral program: moves, arc on, arc off. Posts turn it into a controller's language.
//!
//! Coordinates are rounded to [`RESOLUTION_MM`] here, once, and points closer than [`MIN_MOVE_MM`] to the last one
//! are dropped: a weld move of no length burns through. Then, if it is asked for, straight pieces and circular arcs are
//! fitted within a tolerance ([`Programmer::with_fit`]): fewer moves along the same path.

mod spread;

use crate::fill::PassKind;
use crate::plan::{Layer, Pass};
use crate::profile::Program;
use glam::DVec3;
use planar::arcs::{Fit, Piece};
use spread::Spread;

/// Coordinates of a program are multiples of this, mm.
pub const RESOLUTION_MM: f64 = 1e-3;

/// No two points of a pass lie closer, mm.
pub const MIN_MOVE_MM: f64 = 0.01;

/// One step of a program. The arc is off until `ArcOn`, and `ArcOff` comes before the next `Travel`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Instruction {
    /// A straight move without arc, at travel speed; ends with an exact stop.
    Travel {
        /// Tool point, mm.
        to: DVec3,
    },
    /// Lights the arc at the start of a pass.
    ArcOn {
        /// Number of the pass in its layer, from 1.
        pass: usize,
        /// What it is for.
        kind: PassKind,
    },
    /// A move with the arc on.
    Weld {
        /// Tool point, mm.
        to: DVec3,
        /// The circle on which it goes there; none for a straight move.
        circle: Option<Circle>,
        /// Deposition speed, mm/s.
        speed: f64,
        /// Whether the pass ends here, with an exact stop.
        last: bool,
    },
    /// Ends the arc.
    ArcOff {
        /// Number of the pass in its layer, from 1.
        pass: usize,
    },
}

/// A circular arc in a plane of constant height, from where the torch stands; less than half a turn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Circle {
    /// A point about in its middle, mm. The circle is that through start, this point and end, as they are rounded.
    pub via: DVec3,
    /// Its centre, mm.
    pub centre: DVec3,
    /// Its radius, mm.
    pub radius: f64,
    /// Angle of the arc, counter-clockwise seen from above where it is over 0, radians.
    pub sweep: f64,
}

impl Circle {
    /// Length of the arc, mm.
    pub fn length(&self) -> f64 {
        self.radius * self.sweep.abs()
    }

    /// The word of G-code that runs it: G2 clockwise, G3 counter-clockwise.
    pub fn word(&self) -> &'static str {
        if self.sweep < 0.0 { "G2" } else { "G3" }
    }
}

/// The instructions of one layer.
#[derive(Debug, Clone, PartialEq)]
pub struct LayerProgram {
    /// Index from 0.
    pub index: usize,
    /// Top of the layer, mm.
    pub z: f64,
    /// What to do.
    pub instructions: Vec<Instruction>,
}

/// Turns layers into instructions, remembering where the torch stands.
#[derive(Debug, Clone)]
pub struct Programmer {
    clearance: f64,
    torch: Option<DVec3>,
    fit: Option<Fit>,
    speed_tolerance: f64,
    spread: Option<Spread>,
}

impl Programmer {
    /// Travels go `clearance` (mm) above the higher of their ends.
    pub fn new(clearance: f64) -> Self {
        Self { clearance, torch: None, fit: None, speed_tolerance: 0.0, spread: None }
    }

    /// Fits straight pieces and arcs as the profile says; without a tolerance every point is kept.
    pub fn with_fit(mut self, program: &Program) -> Self {
        // What dropping close points may have moved comes on top.
        let tolerance = program.chord_tolerance - MIN_MOVE_MM;
        // Merging points and fitting pieces each take half of it.
        let time = program.min_point_time;
        self.spread = (time > 0.0 && tolerance > 0.0).then_some(Spread { time, tolerance: tolerance / 2.0 });
        let tolerance = if self.spread.is_some() { tolerance / 2.0 } else { tolerance };
        self.speed_tolerance = program.speed_tolerance;
        self.fit = (tolerance > 0.0).then_some(Fit { tolerance, arcs: program.arcs, grid: RESOLUTION_MM });
        self
    }

    /// The instructions of the next layer; the torch ends above its last pass.
    pub fn layer(&mut self, layer: &Layer) -> LayerProgram {
        let mut instructions = Vec::with_capacity(layer.passes.iter().map(|p| p.points.len() + 6).sum());
        for (i, pass) in layer.passes.iter().enumerate() {
            self.pass(i + 1, pass, &mut instructions);
        }
        LayerProgram { index: layer.index, z: layer.z, instructions }
    }

    fn pass(&mut self, number: usize, pass: &Pass, out: &mut Vec<Instruction>) {
        let mut moves = distinct(pass);
        level_speeds(&mut moves, self.speed_tolerance);
        self.spread.into_iter().for_each(|s| spread::spread(&mut moves, s));
        let [(start, _), rest @ ..] = &moves[..] else { return };
        let (start, Some(&(end, _))) = (*start, rest.last()) else { return };
        let top = self.torch.map_or(start.z, |from| from.z.max(start.z)) + self.clearance;
        // Up, across, down; the very first move has no place to rise from.
        let rise = self.torch.map(|from| from.with_z(top));
        let legs = rise.into_iter().chain([start.with_z(top), start]);
        out.extend(legs.map(|to| Instruction::Travel { to }));
        out.push(Instruction::ArcOn { pass: number, kind: pass.kind });
        match &self.fit {
            Some(fit) => fitted(&moves, fit, out),
            None => out.extend(rest.iter().map(|&(to, speed)| weld(to, speed, None))),
        }
        if let Some(Instruction::Weld { last, .. }) = out.last_mut() {
            *last = true;
        }
        out.push(Instruction::ArcOff { pass: number });
        self.torch = Some(end);
    }

    /// The move that takes the torch away at the end of the program.
    pub fn leave(&self) -> Option<Instruction> {
        self.torch.map(|at| Instruction::Travel { to: at.with_z(at.z + self.clearance) })
    }
}

fn weld(to: DVec3, speed: f64, circle: Option<Circle>) -> Instruction {
    Instruction::Weld { to, circle, speed, last: false }
}

/// Gives neighbouring moves whose speeds differ by no more than that part one speed: the one that takes the same time
/// along them together, and so lays the same metal.
fn level_speeds(moves: &mut [(DVec3, f64)], tolerance: f64) {
    let mut start = 1;
    while tolerance > 0.0 && start < moves.len() {
        let (mut low, mut high, mut end) = (f64::INFINITY, 0.0_f64, start);
        while let Some(&(_, speed)) = moves.get(end) {
            (low, high) = (low.min(speed), high.max(speed));
            if high > low * (1.0 + tolerance) {
                break;
            }
            end += 1;
        }
        let end = end.max(start + 1);
        let pieces = || moves[start - 1..end].windows(2).map(|w| (w[0].0.distance(w[1].0), w[1].1));
        let (length, time) = pieces().fold((0.0, 0.0), |(l, t), (length, speed)| (l + length, t + length / speed));
        let (first, alike) = (moves[start].1, pieces().all(|(_, speed)| speed == moves[start].1));
        let speed = if alike || time <= 0.0 { first } else { length / time };
        moves[start..end].iter_mut().for_each(|(_, s)| *s = speed);
        start = end;
    }
}

/// The welds from the first point on. Pieces end where speed or height change.
fn fitted(moves: &[(DVec3, f64)], fit: &Fit, out: &mut Vec<Instruction>) {
    let mut start = 0;
    while let Some(&(first, speed)) = moves.get(start + 1) {
        let alike = |(to, s): &&(DVec3, f64)| *s == speed && to.z == first.z;
        let level = moves[start].0.z == first.z;
        let end = start + if level { moves[start + 1..].iter().take_while(alike).count() } else { 1 };
        let points: Vec<_> = moves[start..=end].iter().map(|(p, _)| p.truncate()).collect();
        let piece = |p: Piece| {
            let lift = |arc: planar::arcs::Arc| Circle {
                via: arc.via.extend(first.z),
                centre: arc.centre.extend(first.z),
                radius: arc.radius,
                sweep: arc.sweep,
            };
            weld(moves[start + p.end].0, speed, p.arc.map(lift))
        };
        out.extend(fit.pieces(&points).into_iter().map(piece));
        start = end;
    }
}

/// The rounded points of a pass and the speed on the way to each, without those too close to the last one; the end
/// point stays in any case.
fn distinct(pass: &Pass) -> Vec<(DVec3, f64)> {
    let round = |p: DVec3| (p / RESOLUTION_MM).round() * RESOLUTION_MM;
    let mut moves: Vec<(DVec3, f64)> = Vec::with_capacity(pass.points.len() + 1);
    let first = pass.start().map(|p| (p, pass.speed.after(0)));
    for (to, speed) in first.into_iter().chain(pass.segments().map(|s| (s.to, s.speed))) {
        let to = round(to);
        if moves.last().is_none_or(|(last, _)| last.distance(to) >= MIN_MOVE_MM) {
            moves.push((to, speed));
        }
    }
    if let (Some(end), [_, .., last]) = (pass.end().map(round), &mut moves[..]) {
        last.0 = end;
    }
    moves
}
