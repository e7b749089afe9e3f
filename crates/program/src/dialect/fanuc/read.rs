//! Reads FANUC TP as ASCII (`.ls`): J, L and C motions to the positions of the listing, and the programs that it calls.
//!
//! Positions are in the user frame. The arc is switched by `Weld Start`, `Arc Start` and the instructions that end
//! them, on lines of their own or after a motion, or by the codes in the options.

use crate::dialect::reading::fault::{BAD_NAME, BLENDED_SWITCH, RAPID_WITH_ARC, TOO_LARGE, WEAVE_LEFT_ON, WEAVE_PITCH};
use crate::dialect::reading::loops::{Counting, Mark, Next, holds, turns, unrolled};
use crate::dialect::reading::trace::{Stated, Step, Trace};
use crate::dialect::reading::words::{Patterns, begins_with, compact, name, number};
use crate::dialect::reading::{FindModule, Options, ReadError, ReadProgram};
use glam::{DQuat, DVec3, EulerRot};
use std::collections::HashMap;
use std::rc::Rc;

/// Instructions that affect neither position nor metal, by their first words.
const HARMLESS: [&str; 22] = [
    "END",
    "ABORT",
    "PAUSE",
    "LBL",
    "MESSAGE",
    "UALM",
    "TIMER",
    "OVERRIDE",
    "PAYLOAD",
    "COL",
    "MONITOR",
    "STOP_TRACKING",
    "Track",
    "TC_ONLINE",
    "RESUME_PROG",
    "MAINT_PROG",
    "ENDIF",
    "UFRAME_NUM",
    "UTOOL_NUM",
    "LOCK",
    "UNLOCK",
    "BREAK",
];

/// Maximum number of lines of a program.
const MAX_LINES: usize = 9_999;

/// Longest program name.
const MAX_NAME: usize = 36;

/// Branches and loops.
const CONTROL: [&str; 5] = ["IF", "ELSE", "SELECT", "JMP", "WHILE"];

/// The position of a motion.
#[derive(Clone, Copy)]
enum Position {
    /// User frame, point, mm, and what else the position states.
    Place(u32, DVec3, Stated),
    /// Joint angles, or not taught.
    Unknown,
}

/// A listing: statements with their lines, and positions by number.
struct Listing {
    module: Option<String>,
    statements: Vec<(usize, String)>,
    positions: HashMap<u32, Position>,
}

/// Whether a line can occur only in a FANUC program.
pub(super) fn typical(line: &str) -> bool {
    begins_with(line, &["/PROG"])
}

pub(super) fn read(text: &str, module: &mut FindModule<'_>, options: &Options) -> Result<ReadProgram, ReadError> {
    let mut reader = Reader {
        trace: Trace::new(),
        module,
        listings: HashMap::new(),
        on: Patterns::new(&options.arc.on),
        off: Patterns::new(&options.arc.off),
        frame: None,
        registers: HashMap::new(),
        unshifted: false,
        blended: None,
        weave: None,
        pitch: None,
    };
    let main = reader.listing(None, text)?;
    if main.statements.is_empty() {
        return Err(ReadError::NoProgram("FANUC TP"));
    }
    reader.run(&main, 0)?;
    reader.trace.finish(super::DIALECT.language)
}

struct Reader<'a> {
    trace: Trace,
    module: &'a mut FindModule<'a>,
    listings: HashMap<String, Rc<Listing>>,
    on: Patterns,
    off: Patterns,
    /// User frame of the first position.
    frame: Option<u32>,
    /// Registers with a plain number, such as `R[1]`.
    registers: HashMap<String, f64>,
    /// Whether the offset of motions is known to be 0.
    unshifted: bool,
    /// How the last move blends into the next, if it does not end exactly.
    blended: Option<String>,
    /// Weaving frequency, Hz; 0 where a schedule defines it.
    weave: Option<f64>,
    /// Pitch of the weave in this pass, mm.
    pitch: Option<f64>,
}

impl Reader<'_> {
    fn listing(&mut self, module: Option<&str>, text: &str) -> Result<Rc<Listing>, ReadError> {
        let caller = std::mem::replace(&mut self.trace.module, module.map(str::to_owned));
        let (mut statements, mut positions) = (Vec::<(usize, String)>::new(), HashMap::new());
        let (mut part, mut block) = ("", Block::default());
        for (i, line) in text.lines().enumerate().map(|(i, l)| (i + 1, l.trim())) {
            if let Some(head) = line.strip_prefix('/').filter(|l| !l.starts_with('/')) {
                part = head;
            } else if part.starts_with("MN") {
                statement(line, i, &mut statements);
            } else if part.starts_with("POS") && block.line(line, i, &self.trace)? {
                let Block { number, frame, place, turns, .. } = std::mem::take(&mut block);
                let tool = match turns.map(|turn| turn.map(f64::to_radians)) {
                    [Some(w), Some(p), Some(r)] => Some(DQuat::from_euler(EulerRot::ZYX, r, p, w)),
                    _ => None,
                };
                let stated = Stated { tool, axes: [None; 6] };
                let place = match place {
                    [Some(x), Some(y), Some(z)] => Position::Place(frame, DVec3::new(x, y, z), stated),
                    _ => Position::Unknown,
                };
                positions.extend(number.map(|n| (n, place)));
            }
        }
        if statements.len() > MAX_LINES {
            let text = format!("the program has {} lines; controllers accept {MAX_LINES}.", statements.len());
            let place = Some(self.trace.place(1));
            self.trace.faults.add(&TOO_LARGE, place, text);
        }
        let name = text.lines().find_map(|line| line.trim().strip_prefix("/PROG")).map(str::trim).unwrap_or_default();
        let name = name.split_whitespace().next().unwrap_or_default();
        let legal = |b: u8| b.is_ascii_uppercase() || b.is_ascii_digit() || b == b'_';
        let begins = name.starts_with(|c: char| c.is_ascii_uppercase());
        if name.len() > MAX_NAME || !begins || !name.bytes().all(legal) {
            let text =
                format!("\"{name}\" is not a program name: at most {MAX_NAME} letters, digits and _, a letter first.");
            self.trace.faults.add(&BAD_NAME, None, text);
        }
        self.trace.module = caller;
        Ok(Rc::new(Listing { module: module.map(str::to_owned), statements, positions }))
    }

    fn run(&mut self, listing: &Rc<Listing>, depth: usize) -> Result<(), ReadError> {
        let caller = std::mem::replace(&mut self.trace.module, listing.module.clone());
        let statements = &listing.statements;
        unrolled(
            statements.len(),
            |i| mark(&statements[i].1),
            |i| {
                let (line, text) = &statements[i];
                match mark(text) {
                    Some(Mark::Begin) => Ok(turns(text, "=", Counting::Up).map_or_else(
                        || {
                            self.trace.note("FOR", "is not followed: its lines were read once", *line);
                            Next::On
                        },
                        Next::Turns,
                    )),
                    Some(Mark::End) => self.trace.turn(*line).map(|()| Next::On),
                    Some(Mark::Else) => Ok(Next::On),
                    None => match self.jump(text, &statements[i + 1..]) {
                        Some(by) => Ok(if by > 0 { Next::To(i + by) } else { Next::On }),
                        None => self.statement(text, *line, listing, depth).map(|()| Next::On),
                    },
                }
            },
        )?;
        self.trace.module = caller;
        Ok(())
    }

    /// The number of statements that `IF R[1]>5,JMP LBL[3]` jumps ahead, 0 if it does not jump; `None` for anything
    /// else, for conditions that cannot be evaluated, and for labels that do not come after it.
    fn jump(&self, text: &str, behind: &[(usize, String)]) -> Option<usize> {
        let flat = compact(text);
        let (taken, label) = match flat.strip_prefix("JMP") {
            Some(label) => (true, label),
            None => {
                let (condition, label) = flat.strip_prefix("IF")?.split_once(",JMP")?;
                (holds(condition, |register| self.registers.get(register).copied())?, label)
            }
        };
        let to = behind.iter().position(|(_, text)| compact(text) == label)?;
        Some(if taken { to + 2 } else { 0 })
    }

    fn statement(&mut self, text: &str, line: usize, listing: &Listing, depth: usize) -> Result<(), ReadError> {
        if text.is_empty() || text.starts_with(['!', '/', '-']) {
            return Ok(());
        }
        let (word, rest) = name(text);
        let is = |other: &&str| other.eq_ignore_ascii_case(word);
        if ["J", "L", "C", "A", "S"].iter().any(is) && rest.starts_with(['P', 'p']) {
            self.motion(&word.to_ascii_uppercase(), rest, line, listing);
            return Ok(());
        }
        let flat = compact(text);
        if self.switches(&flat, line) {
        } else if let Some(kind) = flat.strip_prefix("WEAVE") {
            self.weaves(kind);
        } else if is(&"PAUSE") || is(&"ABORT") {
            self.trace.halts(word, line);
        } else if is(&"WAIT") {
            // Other waits are for signals.
            if let Some(seconds) = rest.split_once("(sec)").map(|(seconds, _)| seconds) {
                let wait = number(seconds).ok_or_else(|| self.trace.number_error(line, seconds))?;
                self.trace.dwell += wait.max(0.0);
            } else if !flat.contains("TIMEOUT") {
                self.trace.waits(text.trim_end_matches(';').trim(), line);
            }
        } else if is(&"CALL") || is(&"RUN") {
            return self.call(rest, line, depth);
        } else if CONTROL.iter().any(is) {
            self.trace.note(&word.to_ascii_uppercase(), "is not followed: its lines were read once", line);
            if let Some((_, called)) = text.split_once("CALL ").filter(|_| is(&"IF")) {
                return self.call(called, line, depth);
            }
        } else if let Some((_, value)) = flat.split_once(",3]=").filter(|_| flat.starts_with("PR[")) {
            // The height added to a layer; ours is 0 until somebody sets it.
            self.unshifted = number(value) == Some(0.0);
        } else if flat.starts_with("OFFSETCONDITION") {
        } else if let Some((register, value)) = flat.split_once('=').filter(|_| flat.starts_with("R[")) {
            match number(value) {
                Some(value) => self.registers.insert(register.to_owned(), value),
                None => self.registers.remove(register),
            };
        } else if (flat.starts_with("DO[") || flat.starts_with("RO[")) && flat.ends_with("=ON") {
            self.trace.see(text);
        } else if !HARMLESS.iter().any(is) && !flat.contains('=') {
            let word = text.split_whitespace().next().unwrap_or(text);
            self.trace.note(word, "is not understood and was left out", line);
        }
        Ok(())
    }

    /// Whether the statement, without blanks, switches the arc.
    fn switches(&mut self, flat: &str, line: usize) -> bool {
        let has = |words: [&str; 2]| words.iter().any(|w| flat.contains(w));
        let (on, off) = (has(["WELDSTART[", "ARCSTART["]), has(["WELDEND[", "ARCEND["]));
        let (on, off) = (on || self.on.matches(flat), off || self.off.matches(flat));
        if on || off {
            let place = Some(self.trace.place(line));
            if let Some(end) = self.blended.as_ref().filter(|_| on != self.trace.arc) {
                let what = if on { "struck" } else { "ended" };
                let text = format!("the arc is {what} after a move with {end}.");
                self.trace.faults.add(&BLENDED_SWITCH, place.clone(), text);
            }
            self.pitch = None;
            self.trace.set_arc(on, line);
        }
        on || off
    }

    /// `SINE[2.0HZ,1.5MM,0.1S,0.1S]`, `SINE[1]` or `END`.
    fn weaves(&mut self, kind: &str) {
        let inside = kind.split_once('[').map(|(_, inside)| inside);
        self.weave = match inside {
            _ if kind.starts_with("END") => None,
            Some(inside) => Some(inside.split(',').find_map(|field| number(field.strip_suffix("HZ")?)).unwrap_or(0.0)),
            None => self.weave,
        };
    }

    /// The pitch of a weave, mm, follows from speed and frequency.
    fn pitch(&mut self, speed: f64, line: usize) {
        let Some(hertz) = self.weave.filter(|hertz| *hertz > 0.0 && speed > 0.0 && self.trace.arc) else { return };
        let pitch = speed / hertz;
        let first = *self.pitch.get_or_insert(pitch);
        if (pitch / first - 1.0).abs() > 0.1 {
            let place = Some(self.trace.place(line));
            let text = format!(
                "the weave has {first:.1} mm per swing at first and {pitch:.1} mm here: its frequency stays as it was."
            );
            self.trace.faults.add(&WEAVE_PITCH, place, text);
        }
    }

    fn call(&mut self, rest: &str, line: usize, depth: usize) -> Result<(), ReadError> {
        let (called, arguments) = name(rest);
        self.trace.call(called, depth, line)?;
        let key = called.to_ascii_uppercase();
        if !self.listings.contains_key(&key) {
            let Some(text) = (self.module)(called) else {
                if arguments.starts_with('(') {
                    let fate = "is called with arguments, was not found and was left out";
                    self.trace.note(called, fate, line);
                    return Ok(());
                }
                return Err(ReadError::MissingModule { place: self.trace.place(line), name: called.to_owned() });
            };
            let listing = self.listing(Some(called), &text)?;
            self.listings.insert(key.clone(), listing);
        }
        match self.listings.get(&key).cloned() {
            Some(listing) => self.run(&listing, depth + 1),
            None => Ok(()),
        }
    }

    /// The rest of a motion after its first word: `P[2] 100mm/sec FINE Weld Start[1,1]`.
    fn motion(&mut self, word: &str, rest: &str, line: usize, listing: &Listing) {
        let (first, mut rest) = position(rest);
        let mut targets = vec![first];
        while rest.starts_with("P[") || rest.starts_with("PR[") {
            let (next, behind) = position(rest);
            targets.push(next);
            rest = behind;
        }
        let flat = compact(rest);
        let relative = rest.split_whitespace().any(|w| w.eq_ignore_ascii_case("INC"));
        if flat.contains("OFFSET") && !self.unshifted {
            self.trace.note("an offset of a motion", "is not applied", line);
        }
        let speed = rest.split_whitespace().next().unwrap_or_default();
        let speed = if word == "J" { Some(0.0) } else { mm_per_second(speed) };
        if speed.is_none() {
            self.trace.note("a speed", "is not a plain length per time and was read as unknown", line);
        }
        if ["A", "S"].contains(&word) {
            self.trace.note(word, "is a curve through several points and was read as straight moves", line);
        }
        let place = self.trace.place(line);
        if word == "J" && self.trace.arc {
            self.trace.faults.add(&RAPID_WITH_ARC, Some(place.clone()), "the joints move with the arc on.");
        }
        if self.weave.is_some() && !self.trace.arc {
            self.trace.faults.add(&WEAVE_LEFT_ON, Some(place), "the torch weaves while moving without the arc.");
        }
        self.pitch(speed.unwrap_or(0.0), line);
        self.blended =
            rest.split_whitespace().find(|word| word.starts_with("CNT") && *word != "CNT0").map(str::to_owned);
        if let Some(Position::Place(_, to, stated)) =
            targets.last().and_then(|n| listing.positions.get(&(*n)?)).copied()
        {
            self.trace.stand(&stated, to, "a position", line);
        }
        let step = Step { speed: speed.unwrap_or(0.0), metal: self.trace.metal(), width: None, line };
        let places: Vec<Option<DVec3>> = targets.iter().map(|t| self.place(*t, relative, listing, line)).collect();
        match places[..] {
            [Some(to)] => self.trace.line(to.to_array().map(Some), step),
            [Some(via), Some(to)] if word == "C" => self.trace.arc_over(via, to, None, step),
            _ => {
                self.trace.note("a motion to a place that is unknown here", "was left out", line);
                self.trace.forget();
            }
        }
        self.switches(&flat, line);
    }

    fn place(&mut self, number: Option<u32>, relative: bool, listing: &Listing, line: usize) -> Option<DVec3> {
        let Position::Place(frame, place, _) = *listing.positions.get(&number?)? else { return None };
        if *self.frame.get_or_insert(frame) != frame {
            self.trace.note("a position in another user frame", "was read as if it were in the first", line);
        }
        Some(if relative { self.trace.at + place } else { place })
    }
}

/// Where a loop begins or ends.
fn mark(text: &str) -> Option<Mark> {
    let begins = name(text).0.eq_ignore_ascii_case("FOR").then_some(Mark::Begin);
    begins.or_else(|| name(text).0.eq_ignore_ascii_case("ENDFOR").then_some(Mark::End))
}

/// Adds a line: the start of a statement, or the continuation of the one before.
fn statement(line: &str, number: usize, statements: &mut Vec<(usize, String)>) {
    let digits = line.bytes().take_while(u8::is_ascii_digit).count();
    let Some(text) = line[digits..].strip_prefix(':') else { return };
    let text = text.trim_end().trim_end_matches(';').trim();
    match statements.last_mut().filter(|_| digits == 0) {
        Some((_, open)) => *open = format!("{open} {text}"),
        None => statements.push((number, text.to_owned())),
    }
}

/// Number of the position at the start of the text (none for registers), and what follows it.
fn position(text: &str) -> (Option<u32>, &str) {
    let Some((head, rest)) = text.split_once(']') else { return (None, "") };
    let number = head.strip_prefix("P[").or_else(|| head.strip_prefix("p["));
    // A comment may follow the number.
    let number = number.and_then(|n| n.split(':').next()?.trim().parse().ok());
    (number, rest.trim_start())
}

/// Speed in mm/s from `8.0mm/sec`, `48.0cm/min` or `20.0inch/min`.
fn mm_per_second(text: &str) -> Option<f64> {
    let units = [("mm/sec", 1.0), ("cm/min", 10.0 / 60.0), ("inch/min", 25.4 / 60.0)];
    units.iter().find_map(|(unit, factor)| number(text.strip_suffix(unit)?).map(|v| v * factor))
}

/// The block of a position while it is being read.
#[derive(Default)]
struct Block {
    number: Option<u32>,
    groups: usize,
    frame: u32,
    place: [Option<f64>; 3],
    /// W, P and R, °.
    turns: [Option<f64>; 3],
}

impl Block {
    /// Reads a line of the block; true if it is the last. Only the first group moves the torch.
    fn line(&mut self, line: &str, i: usize, trace: &Trace) -> Result<bool, ReadError> {
        if line.starts_with("P[") {
            *self = Self { number: position(line).0, ..Self::default() };
        } else if line.starts_with("GP") {
            self.groups += 1;
        } else if line.starts_with('}') {
            return Ok(true);
        }
        for (field, value) in line.split(',').filter_map(|f| f.split_once(['=', ':'])).filter(|_| self.groups < 2) {
            let (field, value) = (field.trim(), value.trim().split(' ').next().unwrap_or_default());
            if let Some(turn) = ["W", "P", "R"].iter().position(|a| *a == field) {
                self.turns[turn] = number(value.trim_end_matches("deg"));
            }
            let value = value.trim_end_matches("mm");
            if field == "UF" {
                self.frame = value.parse().unwrap_or_default();
            }
            // Asterisks: not taught.
            let axis = ["X", "Y", "Z"].iter().position(|a| *a == field);
            if let Some(axis) = axis.filter(|_| !value.starts_with('*')) {
                self.place[axis] = Some(number(value).ok_or_else(|| trace.number_error(i, value))?);
            }
        }
        Ok(false)
    }
}
