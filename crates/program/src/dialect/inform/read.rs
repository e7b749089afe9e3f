//! Reads Yaskawa INFORM (`.jbi`): MOVJ, MOVL and MOVC to the positions of the job, and the jobs that it calls.
//!
//! Positions are in the job's frame. Where it does not turn with a station (`+MOVJ EC00001`), they are brought back to the
//! part, if the options describe the station. The arc is switched by `ARCON` and `ARCOF`, or by the codes in the options. To the
//! controller, consecutive MOVC are one chain. Three of them are an arc; `FPT` on the last, or a MOVL to it, ends that
//! arc and lets the next one begin there, which Yaskawa's manuals require where the circle changes. Without either,
//! each further point lies on the circle through it and the two points before it. (Unconfirmed: verified only for
//! points of one circle, so a chain that leaves its circle is noted.)

use crate::dialect::reading::fault::{BAD_NAME, BLENDED_SWITCH, RAPID_WITH_ARC, TOO_LARGE, WEAVE_LEFT_ON};
use crate::dialect::reading::loops::{Next, holds, unrolled};
use crate::dialect::reading::trace::{Stated, Step, Trace};
use crate::dialect::reading::words::{Patterns, compact, number};
use crate::dialect::reading::{FindModule, Options, ReadError, ReadProgram, Station};
use glam::{DQuat, DVec3, EulerRot};
use std::collections::HashMap;
use std::rc::Rc;

/// Instructions that affect neither position nor metal, by their first words.
const HARMLESS: [&str; 19] = [
    "NOP", "END", "DOUT", "DIN", "AOUT", "PULSE", "WAIT", "SET", "SETE", "GETE", "GETS", "CLEAR", "INC", "DEC", "ADD",
    "SUB", "ARCSET", "MSG", "SPEED",
];

/// Maximum number of instructions of a job.
const MAX_INSTRUCTIONS: usize = 9_999;

/// Longest job name.
const MAX_NAME: usize = 32;

/// Branches and loops.
const CONTROL: [&str; 8] = ["JUMP", "IF", "IFTHENEXP", "ELSE", "FOR", "WHILE", "SWITCH", "RET"];

/// A MOVC this close to the torch's position begins a new arc, mm.
const ON_THE_SPOT_MM: f64 = 0.005;

/// A chain that continues this far from its circle has left it, mm.
const OFF_CIRCLE_MM: f64 = 0.1;

/// How the positions that follow are given.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Given {
    /// X, Y, Z, Rx, Ry, Rz.
    Cartesian,
    /// Each axis in pulses.
    Pulses,
    /// Each axis in degrees.
    Degrees,
}

/// A job: instructions with their lines, and positions by name; `None` for positions of the robot's axes.
struct Job {
    module: Option<String>,
    instructions: Vec<(usize, String)>,
    positions: HashMap<String, Option<(DVec3, Stated)>>,
    /// Positions of a station by name, in pulses or degrees.
    stations: HashMap<String, (Given, Vec<f64>)>,
}

/// Whether a line can occur only in a job.
pub(super) fn typical(line: &str) -> bool {
    line == "/JOB"
}

pub(super) fn read(text: &str, module: &mut FindModule<'_>, options: &Options) -> Result<ReadProgram, ReadError> {
    let mut reader = Reader {
        trace: Trace::new(),
        module,
        jobs: HashMap::new(),
        on: Patterns::new(&options.arc.on),
        off: Patterns::new(&options.arc.off),
        unit: if options.inform_cm_per_min { 10.0 / 60.0 } else { 1.0 },
        station: options.inform_station.clone(),
        circle: Circle::None,
        variables: HashMap::new(),
        unshifted: false,
        blended: None,
        weaves: false,
        shifts: false,
    };
    reader.trace.frame_turns = reader.station.is_some();
    let main = reader.job(None, text)?;
    if main.instructions.is_empty() {
        return Err(ReadError::NoProgram("INFORM"));
    }
    reader.run(&main, 0)?;
    reader.end_circle();
    if reader.shifts {
        reader.trace.faults.add(&WEAVE_LEFT_ON, None, "the moves are still shifted where the program ends (no SFTOF).");
    }
    reader.trace.finish(super::DIALECT.language)
}

/// State of a chain of arcs.
#[derive(Clone, Copy)]
enum Circle {
    /// No chain.
    None,
    /// The torch is where an arc begins.
    At,
    /// A point along the arc is known.
    Via(DVec3, Step),
    /// The torch is on an arc, after these two points of its chain.
    On([DVec3; 2]),
}

struct Reader<'a> {
    trace: Trace,
    module: &'a mut FindModule<'a>,
    jobs: HashMap<String, Rc<Job>>,
    on: Patterns,
    off: Patterns,
    /// mm/s for V=1.
    unit: f64,
    station: Option<Station>,
    circle: Circle,
    /// Variables with a plain number, such as `D090`.
    variables: HashMap<String, f64>,
    /// Whether the active shift is known to be 0.
    unshifted: bool,
    /// How the last move blends into the next, if it does not end exactly.
    blended: Option<String>,
    weaves: bool,
    /// Whether a shift is active.
    shifts: bool,
}

impl Reader<'_> {
    fn job(&mut self, module: Option<&str>, text: &str) -> Result<Rc<Job>, ReadError> {
        let caller = std::mem::replace(&mut self.trace.module, module.map(str::to_owned));
        let (mut instructions, mut positions, mut stations) = (Vec::new(), HashMap::new(), HashMap::new());
        let (mut given, mut running) = (Given::Cartesian, false);
        for (i, line) in text.lines().enumerate().map(|(i, l)| (i + 1, l.trim())) {
            if line.starts_with('/') {
                given = match line {
                    "///PULSE" => Given::Pulses,
                    "///ANGLE" => Given::Degrees,
                    "///RECTAN" => Given::Cartesian,
                    _ => given,
                };
                running |= line.starts_with("//INST");
            } else if running {
                instructions.push((i, line.to_owned()));
            } else if let Some((name, value)) = line.split_once('=').filter(|(name, _)| name.starts_with("EC")) {
                let axes: Option<Vec<f64>> = value.split(',').map(number).collect();
                let axes = axes.ok_or_else(|| self.trace.number_error(i, value))?;
                stations.insert(name.trim().to_owned(), (given, axes));
            } else if let Some((name, value)) = line.split_once('=') {
                let place = if given == Given::Cartesian { Some(self.place(value, i)?) } else { None };
                positions.insert(name.trim().to_owned(), place);
            }
        }
        if instructions.len() > MAX_INSTRUCTIONS {
            let text =
                format!("the job has {} instructions; controllers accept {MAX_INSTRUCTIONS}.", instructions.len());
            let place = Some(self.trace.place(1));
            self.trace.faults.add(&TOO_LARGE, place, text);
        }
        let name = text.lines().find_map(|line| line.trim().strip_prefix("//NAME")).map(str::trim).unwrap_or_default();
        let legal = |b: u8| b.is_ascii_uppercase() || b.is_ascii_digit() || b"_-".contains(&b);
        if name.is_empty() || name.len() > MAX_NAME || !name.bytes().all(legal) {
            let text = format!("\"{name}\" is not a job name: at most {MAX_NAME} capital letters, digits, _ and -.");
            self.trace.faults.add(&BAD_NAME, None, text);
        }
        self.trace.module = caller;
        Ok(Rc::new(Job { module: module.map(str::to_owned), instructions, positions, stations }))
    }

    fn place(&self, value: &str, line: usize) -> Result<(DVec3, Stated), ReadError> {
        let mut place = [0.0; 3];
        let mut fields = value.split(',');
        for axis in &mut place {
            let field = fields.next().unwrap_or_default();
            let wrong = if field.is_empty() { value } else { field };
            *axis = number(field).ok_or_else(|| self.trace.number_error(line, wrong))?;
        }
        let turns: Vec<f64> = value.split(',').skip(3).take(3).filter_map(number).map(f64::to_radians).collect();
        let tool = match turns[..] {
            [x, y, z] => Some(DQuat::from_euler(EulerRot::ZYX, z, y, x)),
            _ => None,
        };
        Ok((DVec3::from_array(place), Stated { tool, axes: [None; 6] }))
    }

    fn run(&mut self, job: &Rc<Job>, depth: usize) -> Result<(), ReadError> {
        let caller = std::mem::replace(&mut self.trace.module, job.module.clone());
        let all = &job.instructions;
        unrolled(
            all.len(),
            |_| None,
            |i| match self.jump(&all[i].1, &all[i + 1..]) {
                Some(by) => Ok(if by > 0 { Next::To(i + by) } else { Next::On }),
                None => self.instruction(&all[i].1, all[i].0, job, depth).map(|()| Next::On),
            },
        )?;
        self.trace.module = caller;
        Ok(())
    }

    /// The number of instructions that `JUMP *L1 IF D090>5` jumps ahead, 0 if it does not jump; `None` for anything
    /// else, for conditions that cannot be evaluated, and for labels that do not come after it.
    fn jump(&self, text: &str, behind: &[(usize, String)]) -> Option<usize> {
        let jump = text.strip_prefix("JUMP ")?;
        let (label, condition) = jump.split_once(" IF ").unwrap_or((jump, "0=0"));
        let taken = holds(condition, |variable| self.variables.get(variable).copied())?;
        let to = behind.iter().position(|(_, text)| text == label.trim())?;
        Some(if taken { to + 2 } else { 0 })
    }

    fn instruction(&mut self, text: &str, line: usize, job: &Job, depth: usize) -> Result<(), ReadError> {
        let mut words = text.split_whitespace();
        let word = words.next().unwrap_or_default();
        if word.is_empty() || word.starts_with(['\'', '*']) {
            return Ok(());
        }
        if let Some(kind) = word.strip_prefix('S').unwrap_or(word).strip_prefix("MOV") {
            return self.motion(kind, &words.collect::<Vec<_>>(), line, job);
        }
        let flat = compact(text);
        let (on, off) = (word == "ARCON" || self.on.matches(&flat), word == "ARCOF" || self.off.matches(&flat));
        if on || off {
            let place = Some(self.trace.place(line));
            if let Some(level) = self.blended.as_ref().filter(|_| on != self.trace.arc) {
                let what = if on { "struck" } else { "ended" };
                self.trace.faults.add(
                    &BLENDED_SWITCH,
                    place.clone(),
                    format!("the arc is {what} after a move with {level}."),
                );
            }
            self.end_circle();
            self.trace.set_arc(on, line);
        } else if word == "TIMER" {
            let seconds = words.next().and_then(|w| w.strip_prefix("T=")).unwrap_or_default();
            let wait = number(seconds).ok_or_else(|| self.trace.number_error(line, text))?;
            self.trace.dwell += wait.max(0.0);
        } else if word == "CALL" {
            return self.call(words.next().unwrap_or_default(), line, depth);
        } else if word == "SET" {
            let (variable, value) = (words.next().unwrap_or_default(), words.next().and_then(number));
            match value {
                Some(value) => self.variables.insert(variable.to_owned(), value),
                None => self.variables.remove(variable),
            };
        } else if word == "SETE" {
            // An element of a position variable, such as the height that shifts a layer.
            self.unshifted = words.nth(2).and_then(number) == Some(0.0);
        } else if word == "WVON" || word == "WVOF" {
            self.weaves = word == "WVON";
        } else if word == "SFTOF" {
            self.shifts = false;
        } else if word == "PAUSE" || word == "ABORT" {
            self.trace.halts(word, line);
        } else if word == "WAIT" && !text.contains(" T=") {
            self.trace.waits(text, line);
        } else if word == "SFTON" {
            self.shifts = true;
            if !self.unshifted {
                self.trace.note("SFTON", "shifts the moves after it, which is not applied", line);
            }
        } else if CONTROL.contains(&word) {
            self.trace.note(word, "is not followed: its lines were read once", line);
        } else if word == "DOUT" && flat.ends_with("ON") {
            self.trace.see(text);
        } else if !HARMLESS.contains(&word) {
            self.trace.note(word, "is not understood and was left out", line);
        }
        Ok(())
    }

    fn call(&mut self, target: &str, line: usize, depth: usize) -> Result<(), ReadError> {
        let called = target.strip_prefix("JOB:").unwrap_or(target);
        self.trace.call(called, depth, line)?;
        if !self.jobs.contains_key(called) {
            let Some(text) = (self.module)(called) else {
                return Err(ReadError::MissingModule { place: self.trace.place(line), name: called.to_owned() });
            };
            let job = self.job(Some(called), &text)?;
            self.jobs.insert(called.to_owned(), job);
        }
        match self.jobs.get(called).cloned() {
            Some(job) => self.run(&job, depth + 1),
            None => Ok(()),
        }
    }

    /// A position of the robot, on the part where a station (`+MOVJ EC00001`) has turned it.
    fn on_part(&mut self, (at, stated): (DVec3, Stated), words: &[&str], job: &Job, line: usize) -> (DVec3, Stated) {
        let name = words.iter().skip_while(|word| **word != "+MOVJ").nth(1);
        let Some((given, axes)) = name.and_then(|name| job.stations.get(*name)) else { return (at, stated) };
        let Some(Station { positioner, pulses, frame_turns }) = self.station.as_ref() else {
            let fate = "turns a station that is not described (program.positioner, inform.station_pulses and inform.frame_turns): \
                        positions were read as they are";
            self.trace.note("+MOVJ", fate, line);
            return (at, stated);
        };
        let scale = |k: usize| if *given == Given::Pulses { pulses[k] } else { 1.0 };
        let count = positioner.count().min(2);
        let angles = std::array::from_fn(|k| axes.get(k).filter(|_| k < count).map_or(0.0, |at| at / scale(k)));
        let (held, frame) = (positioner.held(angles), positioner.held([0.0; 2]).turn);
        let (back, mut stated) = (held.turn.inverse(), stated);
        (0..count).for_each(|k| stated.axes[k] = Some(angles[k]));
        if *frame_turns {
            return (at, stated);
        }
        stated.tool = stated.tool.map(|tool| back * frame * tool);
        (back * (frame * at - held.shift), stated)
    }

    /// `MOVL C00001 V=8.0 PL=0`, with `kind` = `L`.
    fn motion(&mut self, kind: &str, words: &[&str], line: usize, job: &Job) -> Result<(), ReadError> {
        let name = words.first().copied().unwrap_or_default();
        let position = job.positions.get(name).copied().map(|at| at.map(|at| self.on_part(at, words, job, line)));
        // Home positions may be in pulses: torch and arc are then off, and joints move.
        if matches!(position, Some(None)) && (kind != "J" || self.trace.arc) {
            return Err(ReadError::Pulses { place: self.trace.place(line), name: name.to_owned() });
        }
        let place = self.trace.place(line);
        if kind == "J" && self.trace.arc {
            self.trace.faults.add(&RAPID_WITH_ARC, Some(place.clone()), "the joints move with the arc on.");
        }
        if self.weaves && !self.trace.arc {
            self.trace.faults.add(&WEAVE_LEFT_ON, Some(place), "the torch weaves while moving without the arc.");
        }
        self.blended =
            words.iter().find(|word| word.starts_with("PL=") && **word != "PL=0").map(|word| (*word).to_owned());
        if let Some(Some((to, stated))) = position {
            self.trace.stand(&stated, to, "a position", line);
        }
        let speed = words.iter().find_map(|w| w.strip_prefix("V=")).and_then(number).map(|v| v * self.unit);
        if speed.is_none() && kind != "J" {
            self.trace.note("a speed", "is not a plain V= and was read as unknown", line);
        }
        let step = Step { speed: speed.unwrap_or(0.0), metal: self.trace.metal(), width: None, line };
        let Some((to, _)) = position.flatten() else {
            self.trace.note("a motion to a place that is unknown here", "was left out", line);
            self.circle = Circle::None;
            self.trace.forget();
            return Ok(());
        };
        match kind {
            "C" => self.arc(to, step, words.contains(&"FPT")),
            "L" | "J" => {
                self.end_circle();
                self.trace.line(to.to_array().map(Some), step);
            }
            _ => {
                self.end_circle();
                self.trace.note(&format!("MOV{kind}"), "was read as a straight move", line);
                self.trace.line(to.to_array().map(Some), step);
            }
        }
        Ok(())
    }

    /// The next point of a chain of arcs; an arc ends where `last` is set.
    fn arc(&mut self, to: DVec3, step: Step, last: bool) {
        self.circle = match self.circle {
            Circle::None => {
                self.trace.line(to.to_array().map(Some), step);
                Circle::At
            }
            Circle::At if self.trace.at.distance(to) < ON_THE_SPOT_MM => Circle::At,
            Circle::At => Circle::Via(to, step),
            Circle::Via(via, _) => {
                let start = self.trace.at;
                self.trace.arc_over(via, to, None, step);
                Circle::On([start, via])
            }
            Circle::On(_) if self.trace.at.distance(to) < ON_THE_SPOT_MM => {
                let fate = "was read as the start of a new arc; a controller needs FPT there, or a MOVL between";
                self.trace.note("a MOVC at the place of the one before it", fate, step.line);
                Circle::At
            }
            Circle::On(points) => {
                if self.trace.off_circle(points, to) > OFF_CIRCLE_MM {
                    let fate = "continues on another circle with neither FPT nor a MOVL between: each further point was read on \
                                the circle through it and the two before, which your controller may do differently";
                    self.trace.note("a chain of MOVC", fate, step.line);
                }
                let at = self.trace.at;
                self.trace.arc_on(points[1], to, step);
                Circle::On([points[1], at])
            }
        };
        if last && matches!(self.circle, Circle::On(_)) {
            self.circle = Circle::At;
        }
    }

    /// A chain without its end point runs straight to its last point.
    fn end_circle(&mut self) {
        if let Circle::Via(to, step) = std::mem::replace(&mut self.circle, Circle::None) {
            self.trace.note("an arc", "has no end point and was read as a straight move", step.line);
            self.trace.line(to.to_array().map(Some), step);
        }
    }
}
