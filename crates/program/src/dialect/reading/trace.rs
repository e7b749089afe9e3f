//! The moves of a program as a reader finds them: possibly unknown positions, arcs, notes.

use super::fault::{ENDLESS_WAIT, Faults, LEFT_ON, MISSING_AXIS, STATIC_FRAME, TURNING_TORCH};
use super::watch::Watch;
use super::{Metal, Move, Place, ReadError, ReadProgram};
use bead_part::model::MAX_REACH_MM;
use glam::{DQuat, DVec3};
use std::f64::consts::TAU;

/// Greatest distance of chords from their arc, mm.
pub const CHORD_MM: f64 = 0.01;

/// Deepest nesting of calls.
pub(in crate::dialect) const MAX_DEPTH: usize = 32;

/// Maximum number of calls in a program.
const MAX_CALLS: usize = 100_000;

/// Most iterations of all loops together.
pub(super) const MAX_TURNS: usize = 100_000;

/// Maximum number of moves, with arcs as chords.
pub(super) const MAX_MOVES: usize = 10_000_000;

/// Maximum number of chords of an arc.
const MAX_CHORDS: f64 = 100_000.0;

/// Most distinct notes; the rest are counted together.
const MAX_NOTES: usize = 60;

/// Most codes named if no arc was found.
const MAX_SEEN: usize = 8;

/// A move without its end point.
#[derive(Clone, Copy)]
pub(in crate::dialect) struct Step {
    /// Speed, mm/s; 0 if unknown.
    pub(in crate::dialect) speed: f64,
    pub(in crate::dialect) metal: Metal,
    /// Bead width, mm.
    pub(in crate::dialect) width: Option<f64>,
    pub(in crate::dialect) line: usize,
}

/// What a target states about the torch's orientation, besides its position.
#[derive(Clone, Copy, Default)]
pub(in crate::dialect) struct Stated {
    /// Orientation of the tool, in the frame of the position.
    pub(in crate::dialect) tool: Option<DQuat>,
    /// Axes other than the robot's, mm or °.
    pub(in crate::dialect) axes: [Option<f64>; 6],
}

/// With the arc on, a torch that turns faster than this swings, ° per mm of its path.
const MOST_TURN_A_MM: f64 = 30.0;

/// Turns smaller than this do not count, °.
const LEAST_TURN: f64 = 5.0;

/// Moves of an axis smaller than this do not count, mm or °.
const LEAST_AXIS: f64 = 0.05;

/// An arc `centre + u cos t + v sin t + rise t/sweep`, t from 0 to `sweep`.
pub(in crate::dialect) struct Curve {
    pub(in crate::dialect) centre: DVec3,
    pub(in crate::dialect) u: DVec3,
    pub(in crate::dialect) v: DVec3,
    /// Radians, positive.
    pub(in crate::dialect) sweep: f64,
    pub(in crate::dialect) rise: DVec3,
}

impl Curve {
    /// The arc from `start` through `aux` to `end`; `None` when they lie on one line.
    fn through(start: DVec3, aux: DVec3, end: DVec3) -> Option<Self> {
        let (a, b) = (aux - start, end - start);
        let normal = a.cross(b);
        let size = normal.length_squared();
        if size <= 1e-12 * a.length_squared() * b.length_squared() {
            return None;
        }
        let to_centre = (normal.cross(a) * b.length_squared() + b.cross(normal) * a.length_squared()) / (2.0 * size);
        let (centre, u) = (start + to_centre, -to_centre);
        let v = normal.normalize().cross(u);
        let sweep = (end - centre).dot(v).atan2((end - centre).dot(u)).rem_euclid(TAU);
        Some(Self { centre, u, v, sweep, rise: DVec3::ZERO })
    }

    /// The rest of the arc after one of its points.
    fn behind(&self, point: DVec3) -> Self {
        let u = point - self.centre;
        let passed = u.dot(self.v).atan2(u.dot(self.u)).rem_euclid(TAU);
        let v = self.u.cross(self.v).normalize_or_zero().cross(u);
        Self { centre: self.centre, u, v, sweep: self.sweep - passed, rise: DVec3::ZERO }
    }

    /// Distance of a point from the full circle, mm.
    fn off(&self, point: DVec3) -> f64 {
        let arm = point - self.centre;
        let height = arm.dot(self.u.cross(self.v).normalize_or_zero());
        height.hypot((arm.length_squared() - height * height).max(0.0).sqrt() - self.u.length())
    }

    pub(in crate::dialect) fn point(&self, part: f64) -> DVec3 {
        let (sin, cos) = (self.sweep * part).sin_cos();
        self.centre + self.u * cos + self.v * sin + self.rise * part
    }

    fn chords(&self) -> usize {
        let step = 2.0 * (1.0 - CHORD_MM / self.u.length().max(CHORD_MM)).acos();
        (self.sweep / step).ceil().clamp(1.0, MAX_CHORDS) as usize
    }
}

struct Note {
    what: String,
    fate: &'static str,
    count: usize,
    first: Place,
}

/// Moves, waits and notes while a program is being read.
pub(in crate::dialect) struct Trace {
    /// Last position; axes that are not `known` keep their last value.
    pub(in crate::dialect) at: DVec3,
    pub(in crate::dialect) known: [bool; 3],
    pub(in crate::dialect) arc: bool,
    pub(in crate::dialect) dwell: f64,
    /// The module being read; `None` for the main file.
    pub(in crate::dialect) module: Option<String>,
    /// Dangerous lines.
    pub(in crate::dialect) faults: Faults,
    /// Arc monitoring.
    pub(in crate::dialect) watch: Watch,
    /// Whether the frame of the part turns with the table under it.
    pub(in crate::dialect) frame_turns: bool,
    /// Bytes of text read.
    pub(in crate::dialect) bytes: usize,
    tool: Option<DQuat>,
    /// Axes other than the robot's, as stated by the last target.
    axes: Option<[Option<f64>; 6]>,
    /// The same for home.
    home: Option<[Option<f64>; 6]>,
    /// The table angle when the arc was first struck, and how far it has turned since below a frame that does not move, °: before
    /// the current move and after it.
    table: Option<f64>,
    turn: [f64; 2],
    moves: Vec<Move>,
    notes: Vec<Note>,
    seen: Vec<String>,
    calls: usize,
    turns: usize,
    /// Why nothing more is accepted.
    fault: Option<ReadError>,
}

impl Trace {
    pub(in crate::dialect) fn new() -> Self {
        Self {
            at: DVec3::ZERO,
            known: [false; 3],
            arc: false,
            dwell: 0.0,
            module: None,
            faults: Faults::default(),
            watch: Watch::default(),
            frame_turns: false,
            bytes: 0,
            tool: None,
            axes: None,
            home: None,
            table: None,
            turn: [0.0; 2],
            moves: Vec::new(),
            notes: Vec::new(),
            seen: Vec::new(),
            calls: 0,
            turns: 0,
            fault: None,
        }
    }

    pub(in crate::dialect) fn place(&self, line: usize) -> Place {
        Place { line, module: self.module.clone() }
    }

    pub(in crate::dialect) fn number_error(&self, line: usize, text: &str) -> ReadError {
        ReadError::Number { place: self.place(line), text: text.trim().chars().take(60).collect() }
    }

    /// Notes `what` and how it was handled.
    pub(in crate::dialect) fn note(&mut self, what: &str, fate: &'static str, line: usize) {
        let full = self.notes.len() >= MAX_NOTES;
        let (what, fate) = match self.notes.iter_mut().find(|n| n.fate == fate && n.what == what) {
            Some(note) => return note.count += 1,
            None if full => ("more", "was left out"),
            None => (what, fate),
        };
        if let Some(note) = self.notes.iter_mut().find(|n| n.fate == fate && n.what == what) {
            note.count += 1;
        } else {
            self.notes.push(Note { what: what.to_owned(), fate, count: 1, first: self.place(line) });
        }
    }

    /// Remembers a code that might switch the arc.
    pub(in crate::dialect) fn see(&mut self, code: &str) {
        if self.seen.len() < MAX_SEEN && self.seen.iter().all(|s| s != code) {
            self.seen.push(code.to_owned());
        }
    }

    pub(in crate::dialect) fn set_arc(&mut self, on: bool, line: usize) {
        // Struck again at the same position: two passes, not one.
        if let Some(last) = self.moves.last().filter(|m| on && !self.arc && m.metal.is_laid()) {
            self.push(last.to, Step { speed: 0.0, metal: Metal::Off, width: None, line });
        }
        self.arc = on;
    }

    /// Records a statement that halts the program or asks the operator.
    pub(in crate::dialect) fn halts(&mut self, statement: &str, line: usize) {
        if self.arc {
            let place = Some(self.place(line));
            self.faults.add(&LEFT_ON, place, format!("{statement} halts the program with the arc on."));
        }
    }

    /// Records a statement that waits for a signal without a time limit.
    pub(in crate::dialect) fn waits(&mut self, statement: &str, line: usize) {
        if self.arc {
            let place = Some(self.place(line));
            self.faults.add(&ENDLESS_WAIT, place, format!("{statement} waits for ever, with the arc on."));
        }
    }

    /// Records that the program ends with these outputs on, which were on while the arc burned.
    pub(in crate::dialect) fn ends_with(&mut self, outputs: &[String]) {
        if !outputs.is_empty() && !self.arc {
            self.faults.add(&LEFT_ON, None, format!("the program ends with {} on.", outputs.join(" and ")));
        }
    }

    /// The metal of moves in the current state of the arc: `Arc` or `Off`.
    pub(in crate::dialect) fn metal(&self) -> Metal {
        if self.arc { Metal::Arc } else { Metal::Off }
    }

    /// Makes the position unknown.
    pub(in crate::dialect) fn forget(&mut self) {
        self.known = [false; 3];
    }

    /// Checks what a motion to `to` states besides its position, before it is made; `what` names the motion.
    pub(in crate::dialect) fn stand(&mut self, stated: &Stated, to: DVec3, what: &str, line: usize) {
        let place = Some(self.place(line));
        self.states_axes(&stated.axes, what, line);
        self.turn[0] = self.turn[1];
        let moved = |(before, now): (&Option<f64>, &Option<f64>)| {
            before.zip(*now).is_some_and(|(before, now)| (before - now).abs() > LEAST_AXIS)
        };
        let moving = self.axes.and_then(|axes| axes.iter().zip(&stated.axes).position(moved));
        if let (Some(axis), true, false) = (moving, self.arc, self.frame_turns) {
            let text = format!(
                "external axis {} moves while the arc burns, but the part frame does not move. This is right only for a track \
                 under the robot.",
                axis + 1
            );
            self.faults.add(&STATIC_FRAME, place.clone(), text);
            // The part turns away underneath the path.
            let angle = stated.axes[axis].unwrap_or_default();
            let from = self.axes.and_then(|axes| axes[axis]).unwrap_or_default();
            self.turn[1] = angle - *self.table.get_or_insert(from);
        }
        if let (Some(before), Some(now), true) = (self.tool, stated.tool, self.arc) {
            let angle = before.angle_between(now).min(before.angle_between(-now)).to_degrees();
            let length = if self.known == [true; 3] { self.at.distance(to) } else { f64::INFINITY };
            if angle > LEAST_TURN && angle > MOST_TURN_A_MM * length {
                let text = format!("the torch turns by {angle:.0}° over {length:.2} mm with the arc on.");
                self.faults.add(&TURNING_TORCH, place, text);
            }
        }
        self.tool = stated.tool.or(self.tool);
        self.axes = Some(stated.axes);
    }

    /// Checks that all targets state the same axes, and that home states them too.
    pub(in crate::dialect) fn states_axes(&mut self, axes: &[Option<f64>; 6], what: &str, line: usize) {
        let differs = |axis: &usize| match (self.axes, self.home) {
            (Some(before), _) => before[*axis].is_some() != axes[*axis].is_some(),
            (None, Some(home)) => axes[*axis].is_some() && home[*axis].is_none(),
            (None, None) => false,
        };
        if let Some(axis) = (0..6).find(differs) {
            let (has, others) = if axes[axis].is_some() {
                ("states", "targets before it do not")
            } else {
                ("does not state", "others do")
            };
            let text = format!("{what} {has} external axis {}, but {others}.", axis + 1);
            let place = Some(self.place(line));
            self.faults.add(&MISSING_AXIS, place, text);
        }
    }

    /// Records the axes stated by a target without a position: home. It may state axes that are not used.
    pub(in crate::dialect) fn home(&mut self, axes: &[Option<f64>; 6], what: &str, line: usize) {
        let lacks = |axis: &usize| self.axes.is_some_and(|before| before[*axis].is_some()) && axes[*axis].is_none();
        if let Some(axis) = (0..6).find(lacks) {
            let text = format!("{what} does not state external axis {}, but others do.", axis + 1);
            let place = Some(self.place(line));
            self.faults.add(&MISSING_AXIS, place, text);
        }
        self.home = Some(*axes);
    }

    /// A straight move; axes without a value do not move.
    pub(in crate::dialect) fn line(&mut self, target: [Option<f64>; 3], mut step: Step) {
        let to = DVec3::from_array([0, 1, 2].map(|i| target[i].unwrap_or(self.at[i])));
        let reached = [0, 1, 2].map(|i| self.known[i] || target[i].is_some());
        if step.metal.is_laid() && self.known != [true; 3] {
            if reached == [true; 3] {
                self.note("a deposited move from an unknown place", "was read as a move without metal", step.line);
                step.metal = Metal::Off;
            } else {
                self.settle(step.line);
            }
        }
        self.known = [0, 1, 2].map(|i| self.known[i] || target[i].is_some());
        self.at = to;
        let on_part = turned_back(to, self.turn[1]);
        if self.known == [true; 3] && self.moves.last().is_none_or(|m| m.to != on_part) {
            self.push(on_part, step);
        }
    }

    /// Assumes the last values of unknown axes, because metal is laid from here.
    pub(in crate::dialect) fn settle(&mut self, line: usize) {
        if self.known != [true; 3] {
            self.note(
                "a deposited move",
                "begins where the program gives no complete place: missing values were taken as 0 or as they were last",
                line,
            );
            self.known = [true; 3];
            self.push(self.at, Step { speed: 0.0, metal: Metal::Off, width: None, line });
        }
    }

    /// An arc through `aux` to `end`; if `angle` (radians) is given, it turns through that angle, against the order of
    /// the points if negative.
    pub(in crate::dialect) fn arc_over(&mut self, aux: DVec3, end: DVec3, angle: Option<f64>, step: Step) {
        if self.known != [true; 3] {
            self.line(end.to_array().map(Some), step);
            return;
        }
        match Curve::through(self.at, aux, end) {
            Some(mut curve) => {
                curve.sweep = angle.map_or(curve.sweep, f64::abs);
                if angle.is_some_and(|angle| angle < 0.0) {
                    curve.v = -curve.v;
                }
                let end = if angle.is_some() { curve.point(1.0) } else { end };
                self.curve(&curve, end, step);
            }
            None if angle.is_some() => self.fail(ReadError::NoCircle { place: self.place(step.line) }),
            None => {
                self.note("an arc whose points lie on one line", "was read as straight moves", step.line);
                self.line(aux.to_array().map(Some), step);
                self.line(end.to_array().map(Some), step);
            }
        }
    }

    /// The arc from the current position to `end` on the circle through both and the point `before` them.
    pub(in crate::dialect) fn arc_on(&mut self, before: DVec3, end: DVec3, step: Step) {
        match Curve::through(before, self.at, end).filter(|_| self.known == [true; 3]) {
            Some(curve) => self.curve(&curve.behind(self.at), end, step),
            None => self.line(end.to_array().map(Some), step),
        }
    }

    /// Distance of a point from the circle through two points and the current position, mm.
    pub(in crate::dialect) fn off_circle(&self, [first, second]: [DVec3; 2], point: DVec3) -> f64 {
        Curve::through(first, second, self.at).map_or(0.0, |circle| circle.off(point))
    }

    /// An arc from the current position in chords; the last one ends at `end`. The volume is spread evenly.
    pub(in crate::dialect) fn curve(&mut self, curve: &Curve, end: DVec3, mut step: Step) {
        let chords = if self.fault.is_some() { 1 } else { curve.chords() };
        if let Metal::Volume(volume) = step.metal {
            step.metal = Metal::Volume(volume / chords as f64);
        }
        let [from, to] = self.turn;
        for i in 1..chords {
            let part = i as f64 / chords as f64;
            self.push(turned_back(curve.point(part), from + (to - from) * part), step);
        }
        self.push(turned_back(end, to), step);
        self.at = end;
    }

    fn push(&mut self, to: DVec3, step: Step) {
        let Step { speed, metal, width, line } = step;
        if self.fault.is_some() {
            return;
        }
        // NaN is not near either.
        let near = to.abs().max_element() <= MAX_REACH_MM && to.is_finite();
        if !near || self.moves.len() >= MAX_MOVES {
            let place = self.place(line);
            return self.fail(if near { ReadError::TooLong { place } } else { ReadError::TooFar { place } });
        }
        self.moves.push(Move { to, speed, metal, width: width.filter(|_| metal.is_laid()), line });
    }

    /// Accepts nothing more; the first fault is kept.
    fn fail(&mut self, fault: ReadError) {
        self.fault.get_or_insert(fault);
    }

    /// Counts an iteration of a loop.
    pub(in crate::dialect) fn turn(&mut self, line: usize) -> Result<(), ReadError> {
        self.turns += 1;
        match &self.fault {
            Some(fault) => Err(fault.clone()),
            None if self.turns > MAX_TURNS => Err(ReadError::TooManyTurns { place: self.place(line) }),
            None => Ok(()),
        }
    }

    /// Counts a call; `depth` is that of the caller.
    pub(in crate::dialect) fn call(&mut self, name: &str, depth: usize, line: usize) -> Result<(), ReadError> {
        self.calls += 1;
        if let Some(fault) = &self.fault {
            return Err(fault.clone());
        }
        if depth >= MAX_DEPTH || self.calls > MAX_CALLS {
            return Err(ReadError::TooDeep { place: self.place(line), name: name.to_owned() });
        }
        Ok(())
    }

    /// The program, if it lays any metal.
    pub(in crate::dialect) fn finish(mut self, language: &'static str) -> Result<ReadProgram, ReadError> {
        if let Some(fault) = self.fault {
            return Err(fault);
        }
        if !self.moves.iter().any(|m| m.metal.is_laid()) {
            let hint = if self.seen.is_empty() {
                String::new()
            } else {
                format!(" The program has: {}.", self.seen.join("; "))
            };
            return Err(ReadError::NoDeposition { hint });
        }
        if self.arc {
            self.faults.add(&LEFT_ON, None, "the program ends with the arc on.");
        }
        let sentence = |n: &Note| {
            let times = if n.count == 1 { "once, in".to_owned() } else { format!("{} times, first in", n.count) };
            format!("{} {} ({times} {}).", n.what, n.fate, n.first)
        };
        let notes = self.notes.iter().map(sentence).collect();
        let faults = self.faults.sorted();
        Ok(ReadProgram { language, moves: self.moves, dwell: self.dwell, notes, faults })
    }
}

/// The position, in a frame that does not move, of a point on a part that has turned by an angle (°) about the frame's
/// origin.
fn turned_back(at: DVec3, angle: f64) -> DVec3 {
    if angle == 0.0 { at } else { DQuat::from_rotation_z(-angle.to_radians()) * at }
}
