//! Reads URScript: movej, movel, movep and movec to poses, written out or named, and the functions that a program
//! calls.
//!
//! Positions are in the frame given to `pose_trans`, in mm. The arc is switched by the codes in the options, such as
//! `set_standard_digital_out(1, True)`. Lines outside functions run from top to bottom; if a file only defines a
//! program, that program runs.

use crate::dialect::reading::fault::{ENDLESS_WAIT, LEFT_ON, RAPID_WITH_ARC, STOP_LEAVES_ON, TOO_LARGE, TURNING_TORCH};
use crate::dialect::reading::loops::{Mark, Next, behind, holds, stepped, unrolled};
use crate::dialect::reading::trace::{Stated, Step, Trace};
use crate::dialect::reading::truth::truth;
use crate::dialect::reading::words::{Patterns, arguments, before_comment, compact, name, number, strip_word};
use crate::dialect::reading::{FindModule, Options, ReadError, ReadProgram};
use glam::{DQuat, DVec3};
use std::collections::{BTreeSet, HashMap};
use std::rc::Rc;

/// Statements that affect neither position nor metal, by the beginning of their names.
const HARMLESS: [&str; 20] = [
    "join",
    "kill",
    "set_",
    "textmsg",
    "popup",
    "sync",
    "stopl",
    "stopj",
    "modbus_",
    "socket_",
    "rtde_",
    "enable_",
    "disable_",
    "write_",
    "zero_",
    "force_mode",
    "end_force_mode",
    "freedrive",
    "halt",
    "return",
];

/// Branches, loops and other blocks that `end` closes.
const BLOCKS: [&str; 3] = ["if", "while", "sec"];

/// Statements with their lines.
type Body = Vec<(usize, String)>;

/// A value of a variable.
#[derive(Clone)]
enum Value {
    Pose(Pose),
    Number(f64),
}

/// A pose.
#[derive(Clone)]
struct Pose {
    /// Its frame; empty for the base.
    frame: String,
    /// Position, mm.
    at: DVec3,
    tool: Option<DQuat>,
}

/// Whether a line can occur only in URScript.
pub(super) fn typical(line: &str) -> bool {
    // Calls; in RAPID no bracket follows a move.
    const CALLS: [&str; 5] = ["movel(", "movej(", "movep(", "movec(", "set_tcp("];
    let function = line.starts_with("def ") && before_comment(line, '#').trim_end().ends_with(':');
    function || CALLS.iter().any(|call| line.starts_with(call))
}

pub(super) fn read(text: &str, _module: &mut FindModule<'_>, options: &Options) -> Result<ReadProgram, ReadError> {
    let (functions, top, first) = functions(text);
    let mut reader = Reader {
        trace: Trace::new(),
        functions,
        values: HashMap::new(),
        frame: None,
        on: Patterns::new(&options.arc.on),
        off: Patterns::new(&options.arc.off),
        outputs: BTreeSet::new(),
        lit_with: BTreeSet::new(),
        low_when_stopped: BTreeSet::new(),
        thread: None,
    };
    reader.trace.bytes = text.len();
    let called = |(_, line): &(usize, String)| reader.functions.contains_key(name(line).0);
    let defines_only = !top.iter().any(called) && !top.iter().any(|(_, line)| line.starts_with("move"));
    reader.run(&top, 0)?;
    if let Some(first) = first.filter(|_| defines_only) {
        reader.call(&first, 1, 0)?;
    }
    let left: Vec<String> = reader.outputs.intersection(&reader.lit_with).map(|n| format!("output {n}")).collect();
    reader.trace.ends_with(&left);
    reader.review(options);
    reader.trace.finish(super::DIALECT.language)
}

/// The functions by name, the lines outside them, and the name of the first function.
fn functions(text: &str) -> (HashMap<String, Rc<Body>>, Body, Option<String>) {
    let (mut found, mut top, mut first) = (HashMap::new(), Body::new(), None);
    // Open functions, each with the number of other blocks open in it.
    let mut open: Vec<(String, Body, usize)> = Vec::new();
    for (i, raw) in text.lines().enumerate() {
        let line = before_comment(raw, '#').trim();
        let thread = strip_word(line, "thread");
        if let Some(head) = strip_word(line, "def").or(thread) {
            first = first.or_else(|| thread.is_none().then(|| name(head).0.to_owned()));
            open.push((name(head).0.to_owned(), Body::new(), 0));
            continue;
        }
        if line == "end" && open.last().is_some_and(|(_, _, blocks)| *blocks == 0) {
            found.extend(open.pop().map(|(name, body, _)| (name, Rc::new(body))));
            continue;
        }
        if let Some((_, _, blocks)) = open.last_mut() {
            match mark(line) {
                Some(Mark::Begin) => *blocks += 1,
                Some(Mark::End) => *blocks -= 1,
                Some(Mark::Else) | None => {}
            }
        }
        let body = open.last_mut().map_or(&mut top, |(_, body, _)| body);
        if !line.is_empty() {
            body.push((i + 1, line.to_owned()));
        }
    }
    // A truncated file runs as far as it goes.
    found.extend(open.into_iter().map(|(name, body, _)| (name, Rc::new(body))));
    (found, top, first)
}

struct Reader {
    trace: Trace,
    functions: HashMap<String, Rc<Body>>,
    values: HashMap<String, Value>,
    /// Frame of the first pose; empty for the base.
    frame: Option<String>,
    on: Patterns,
    off: Patterns,
    /// Digital outputs that are on.
    outputs: BTreeSet<u32>,
    /// Outputs that were on while the arc burned through them.
    lit_with: BTreeSet<u32>,
    /// Outputs that are low while the program is not running.
    low_when_stopped: BTreeSet<u32>,
    /// The handle of the thread that monitors the arc.
    thread: Option<String>,
}

/// Number and state of a digital output that a compact statement switches.
fn output(flat: &str) -> Option<(u32, bool)> {
    let (_, call) = flat.split_once("DIGITAL_OUT(")?;
    let (number, value) = call.strip_suffix(')')?.split_once(',')?;
    Some((number.parse().ok()?, value == "TRUE"))
}

impl Reader {
    /// Checks what a welding programmer notices without running it: questions and waits that leave outputs on, and
    /// stops that do so.
    fn review(&mut self, options: &Options) {
        let mut functions: Vec<(String, Rc<Body>)> = self.functions.clone().into_iter().collect();
        functions.sort_by(|a, b| a.0.cmp(&b.0));
        for (name, body) in functions {
            let mut on = if body.iter().any(|(_, line)| line.starts_with("move")) {
                BTreeSet::new()
            } else {
                self.lit_with.clone()
            };
            for (i, (line, text)) in body.iter().enumerate() {
                if let Some((output, state)) = output(&compact(text)) {
                    if state {
                        on.insert(output)
                    } else {
                        on.remove(&output)
                    };
                }
                let burning = on.intersection(&self.lit_with).map(u32::to_string).collect::<Vec<_>>().join(" and ");
                if burning.is_empty() {
                    continue;
                }
                let place = Some(self.trace.place(*line));
                let waits = strip_word(text, "while").and_then(input) == Some(false) && !moves_or_calls(&body[i..]);
                if text.starts_with("popup(") || text == "pause" {
                    self.trace.faults.add(&LEFT_ON, place, format!("{name} asks with output {burning} on."));
                } else if waits && !counts(&body[i..]) {
                    self.trace.faults.add(
                        &ENDLESS_WAIT,
                        place,
                        format!("{name} waits for ever, with output {burning} on."),
                    );
                }
            }
        }
        let left =
            self.lit_with.difference(&self.low_when_stopped).map(u32::to_string).collect::<Vec<_>>().join(" and ");
        if !left.is_empty() {
            let text =
                format!("output {left} is on with the arc, and stays as it is where the program stops or pauses.");
            self.trace.faults.add(&STOP_LEAVES_ON, None, text);
        }
        if let Some(most) = options.max_megabytes.filter(|most| self.trace.bytes as f64 > most * 1e6) {
            let size = self.trace.bytes as f64 / 1e6;
            let text = format!("the script has {size:.1} MB; the controller accepts {most:.1} MB.");
            self.trace.faults.add(&TOO_LARGE, None, text);
        }
    }

    fn run(&mut self, body: &Body, depth: usize) -> Result<(), ReadError> {
        unrolled(
            body.len(),
            |i| mark(&body[i].1),
            |i| {
                let (line, text) = &body[i];
                match mark(text) {
                    Some(Mark::Begin) => Ok(self.turns(&body[i..]).map_or_else(
                        || {
                            self.trace.note(name(text).0, "is not followed: its lines were read once", *line);
                            Next::On
                        },
                        Next::Turns,
                    )),
                    Some(Mark::Else) => Ok(Next::On),
                    Some(Mark::End) => self.trace.turn(*line).map(|()| Next::On),
                    None => self.statement(text, *line, depth).map(|()| Next::On),
                }
            },
        )
    }

    /// Number of iterations of the block at the start of these lines: a branch whose condition is known, or that only
    /// tests an input and moves nothing; `while i < 5:` where `i` is known and changes once per iteration by a plain
    /// number.
    fn turns(&mut self, lines: &[(usize, String)]) -> Option<u64> {
        let head = &lines.first()?.1;
        let until = behind(1, lines.len(), |at| mark(&lines[at].1));
        let called = |line: &str| self.functions.get(name(line).0).is_some_and(moves_directly);
        let moves = lines[1..until].iter().any(|(_, line)| line.starts_with("move") || called(line));
        let (word, condition) = name(head);
        let condition = condition.trim_end_matches(':');
        if condition.contains("digital_in(") {
            self.trace.watch.look();
        }
        let inner = lines.get(1..until - 1).unwrap_or_default();
        let waits = inner.iter().all(|(_, line)| ["sleep", "sync"].contains(&name(line).0));
        if word == "while" && waits && input(condition).is_some() {
            return Some(0);
        }
        let compared = |part: &str| holds(part, |name| self.number(name)).filter(|_| word == "if");
        let on = |part: &str| compared(part).or_else(|| input(part)).or_else(|| self.output_is_on(part));
        let asked = || truth(condition, &on).filter(|_| ["if", "while"].contains(&word) && !moves);
        if let Some(taken) = truth(condition, &compared).or_else(asked) {
            return Some(taken.into());
        }
        let condition = strip_word(head, "while")?.trim_end_matches(':').trim();
        let condition = condition.strip_prefix('(').and_then(|c| c.strip_suffix(')')).unwrap_or(condition);
        let (variable, bound) = condition.split_once(['<', '>'])?;
        let (bound, ends) = bound.strip_prefix('=').map_or((bound, false), |bound| (bound, true));
        let (variable, below) = (variable.trim(), condition.contains('<'));
        let (from, to, step) = (self.number(variable)?, self.number(bound)?, step(lines, variable)?);
        let holds = if below { from < to } else { from > to } || (ends && from == to);
        // Just short of an exclusive bound.
        let to = if ends { to } else { to - 1e-6 * step };
        match holds {
            false => Some(0),
            true if below == (step > 0.0) => stepped(from, to, step),
            true => None,
        }
    }

    /// Whether `get_standard_digital_out(1)` is on, that is, whether the program has switched it on.
    fn output_is_on(&self, part: &str) -> Option<bool> {
        let flat = compact(part);
        let (read, number) = flat.strip_suffix(')')?.split_once('(')?;
        let number = number.parse().ok().filter(|_| read.starts_with("GET_") && read.ends_with("_OUT"))?;
        self.outputs.contains(&number).then_some(true)
    }

    fn call(&mut self, function: &str, line: usize, depth: usize) -> Result<(), ReadError> {
        self.trace.call(function, depth, line)?;
        match self.functions.get(function).cloned() {
            Some(body) => self.run(&body, depth + 1),
            None => Ok(()),
        }
    }

    fn statement(&mut self, text: &str, line: usize, depth: usize) -> Result<(), ReadError> {
        let (word, rest) = name(text);
        if ["movel", "movep", "movej", "movec"].contains(&word) {
            return self.motion(word, inside(rest), line);
        }
        let flat = compact(text);
        if let Some((output, on)) = output(&flat) {
            if on {
                self.outputs.insert(output)
            } else {
                self.outputs.remove(&output)
            };
        }
        let (lit, ended) = (self.on.matches(&flat), self.off.matches(&flat));
        if lit || ended {
            self.trace.set_arc(lit, line);
            let place = self.trace.place(line);
            self.trace.watch.switch(lit, &mut self.trace.faults, place);
            if lit {
                self.lit_with.extend(&self.outputs);
            }
        } else if let Some(setting) = flat.strip_prefix("SET_RUNSTATE_STANDARD_DIGITAL_OUTPUT_TO_VALUE(") {
            // 1: low when the program is not running; 3: high while it runs, which is then maintained automatically.
            let numbers: Vec<u32> = setting.trim_end_matches(')').split(',').filter_map(|n| n.parse().ok()).collect();
            if let [output, 1 | 3] = numbers[..] {
                self.low_when_stopped.insert(output);
            }
        } else if strip_word(text, "kill").is_some_and(|handle| Some(handle) == self.thread.as_deref()) {
            let place = self.trace.place(line);
            self.trace.watch.disarm(text, &mut self.trace.faults, place);
        } else if ["popup", "pause", "halt"].contains(&word) {
            self.trace.halts(word, line);
        } else if word == "sleep" {
            let seconds = inside(rest);
            let wait = number(seconds).ok_or_else(|| self.trace.number_error(line, seconds))?;
            self.trace.dwell += wait.max(0.0);
        } else if let Some(thread) = started(text) {
            if self.functions.get(thread).is_none_or(moves_directly) {
                self.trace.note(thread, "runs alongside the program and was left out", line);
            }
            let watches = |body: &Rc<Body>| {
                body.iter().any(|(_, line)| line.contains("digital_in("))
                    && body.iter().any(|(_, line)| self.off.matches(&compact(line)))
            };
            if self.functions.get(thread).is_some_and(watches) {
                self.thread = text.split_once('=').map(|(handle, _)| handle.trim().to_owned());
                self.trace.watch.arm();
                // It monitors the input by itself, all the time.
                self.trace.watch.look();
            }
        } else if rest.starts_with('(') && self.functions.contains_key(word) {
            return self.call(word, line, depth);
        } else if flat.contains("DIGITAL_OUT(") && flat.ends_with(",TRUE)") {
            self.trace.see(text);
        } else if let Some((left, value)) = text.split_once('=').filter(|_| !rest.starts_with('(')) {
            return self.assign(left, value.trim(), line);
        } else if !HARMLESS.iter().any(|h| word.starts_with(h)) {
            self.trace.note(word, "is not understood and was left out", line);
        }
        Ok(())
    }

    /// `global part_frame = p[..]` and similar assignments; a variable that is neither a pose nor a number is forgotten.
    fn assign(&mut self, left: &str, value: &str, line: usize) -> Result<(), ReadError> {
        let Some(variable) = left.split_whitespace().next_back() else { return Ok(()) };
        let value = match number(value) {
            Some(number) => Some(Value::Number(number)),
            None => self.pose(value, line)?.map(Value::Pose),
        };
        match value {
            Some(value) => self.values.insert(variable.to_owned(), value),
            None => self.values.remove(variable),
        };
        Ok(())
    }

    /// Frame and position, mm, of `p[x,y,z,..]`, `pose_trans(frame, pose)` or a name; `None` for a computed pose.
    fn pose(&self, text: &str, line: usize) -> Result<Option<Pose>, ReadError> {
        if let Some(numbers) = text.strip_prefix("p[") {
            let numbers = numbers.trim_end_matches(']');
            let mut fields = numbers.split(',');
            let mut place = [0.0; 3];
            for axis in &mut place {
                let field = fields.next().unwrap_or_default();
                let wrong = if field.trim().is_empty() { text } else { field };
                *axis = 1e3 * number(field).ok_or_else(|| self.trace.number_error(line, wrong))?;
            }
            let turns: Vec<f64> = numbers.split(',').skip(3).filter_map(number).collect();
            let tool =
                <[f64; 3]>::try_from(turns).ok().map(|vector| DQuat::from_scaled_axis(DVec3::from_array(vector)));
            return Ok(Some(Pose { frame: String::new(), at: DVec3::from_array(place), tool }));
        }
        if let Some(rest) = strip_word(text, "pose_trans") {
            let [frame, pose] = arguments(inside(rest))[..] else { return Ok(None) };
            // Nested frames are not composed.
            let found = self.pose(pose, line)?.filter(|pose| pose.frame.is_empty());
            return Ok(found.map(|pose| Pose { frame: compact(frame), ..pose }));
        }
        Ok(match self.values.get(text) {
            Some(Value::Pose(pose)) => Some(pose.clone()),
            Some(Value::Number(_)) | None => None,
        })
    }

    fn number(&self, text: &str) -> Option<f64> {
        number(text).or_else(|| match self.values.get(text.trim()) {
            Some(Value::Number(number)) => Some(*number),
            Some(Value::Pose(_)) | None => None,
        })
    }

    fn motion(&mut self, word: &str, inside: &str, line: usize) -> Result<(), ReadError> {
        let pieces = arguments(inside);
        let poses = if word == "movec" { 2 } else { 1 };
        let mut places = Vec::with_capacity(poses);
        for piece in pieces.iter().take(poses) {
            places.push(self.pose(piece, line)?);
        }
        let speed = self.speed(&pieces, poses).filter(|_| word != "movej");
        if speed.is_none() && word != "movej" {
            self.trace.note("a speed", "is not given by a plain v= and was read as unknown", line);
        }
        let speed = speed.unwrap_or(0.0) * 1e3;
        let step = Step { speed, metal: self.trace.metal(), width: None, line };
        let blended = pieces.iter().any(|piece| {
            let radius = piece.strip_prefix('r').and_then(|rest| rest.trim_start().strip_prefix('='));
            radius.and_then(number).is_some_and(|radius| radius > 0.0)
        });
        let place = self.trace.place(line);
        self.trace.watch.go(blended.then_some("a blend"), &mut self.trace.faults, place.clone());
        if !blended {
            // The following statements run once the robot has stopped.
            self.trace.watch.wait();
        }
        if let Some(Some(last)) = places.last() {
            let stated = Stated { tool: last.tool, axes: [None; 6] };
            self.trace.stand(&stated, last.at, "a pose", line);
        }
        if self.trace.arc && word == "movej" {
            self.trace.faults.add(&RAPID_WITH_ARC, Some(place.clone()), "movej moves the joints with the arc on.");
        }
        if self.trace.arc && word == "movec" && pieces.iter().any(|piece| compact(piece) == "MODE=1") {
            let text = "mode=1 turns the torch with the arc's tangent.";
            self.trace.faults.add(&TURNING_TORCH, Some(place), text);
        }
        for Pose { frame, .. } in places.iter().flatten() {
            if self.frame.get_or_insert_with(|| frame.clone()) != frame {
                self.trace.note("a pose in another frame", "was read as if it were in the first", line);
            }
        }
        match &places[..] {
            [Some(to)] => self.trace.line(to.at.to_array().map(Some), step),
            [Some(via), Some(to)] => self.trace.arc_over(via.at, to.at, None, step),
            _ => {
                self.trace.note("a motion to a place that is unknown here", "was left out", line);
                self.trace.forget();
            }
        }
        Ok(())
    }

    /// Speed in m/s of `v=..`, or of the second number after the poses.
    fn speed(&self, pieces: &[&str], poses: usize) -> Option<f64> {
        let named = pieces.iter().find_map(|p| Some(p.strip_prefix('v')?.trim_start().strip_prefix('=')?.trim()));
        self.number(named.or_else(|| pieces.get(poses + 1).copied().filter(|p| !p.contains('=')))?)
    }
}

/// Whether a function moves the torch by itself.
fn moves_directly(body: &Rc<Body>) -> bool {
    body.iter().any(|(_, line)| line.starts_with("move"))
}

/// Whether the block at the start of these lines moves the torch.
fn moves_or_calls(lines: &[(usize, String)]) -> bool {
    let until = behind(1, lines.len(), |at| mark(&lines[at].1));
    lines[1..until].iter().any(|(_, line)| line.starts_with("move"))
}

/// Whether the block at the start of these lines tests something else as well, such as how long it has waited.
fn counts(lines: &[(usize, String)]) -> bool {
    let until = behind(1, lines.len(), |at| mark(&lines[at].1));
    lines[1..until].iter().any(|(_, line)| strip_word(line, "if").is_some())
}

/// The thread that `run thread()` or `handle = run thread()` starts.
fn started(text: &str) -> Option<&str> {
    let text = text.split_once('=').map_or(text, |(_, text)| text.trim_start());
    strip_word(text, "run").map(|thread| name(thread).0)
}

/// The value of a condition on inputs alone in normal operation: inputs such as that of a burning arc are on.
fn input(condition: &str) -> Option<bool> {
    truth(condition.trim_end_matches(':'), &|part| {
        let (called, rest) = name(part.trim());
        let reads =
            called.starts_with("get_") && called.ends_with("_in") && rest.starts_with('(') && rest.ends_with(')');
        reads.then_some(true)
    })
}

/// Where a block begins or ends.
fn mark(line: &str) -> Option<Mark> {
    if ["elif", "else"].iter().any(|word| strip_word(line, word).is_some()) {
        return Some(Mark::Else);
    }
    let begins = BLOCKS.iter().any(|block| strip_word(line, block).is_some());
    begins.then_some(Mark::Begin).or((line == "end").then_some(Mark::End))
}

/// The change of a variable per iteration of the block at the start of these lines; `None` if it changes in any way
/// other than by one `i = i + 1` outside inner blocks.
fn step(lines: &[(usize, String)], variable: &str) -> Option<f64> {
    let (mut depth, mut found) = (0, None);
    for (_, line) in lines {
        match mark(line) {
            Some(Mark::Begin) => depth += 1,
            Some(Mark::End) if depth == 1 => return found,
            Some(Mark::End) => depth -= 1,
            Some(Mark::Else) | None => {}
        }
        let assigned = line.split_once('=').filter(|(left, _)| left.split_whitespace().next_back() == Some(variable));
        if let Some((_, value)) = assigned.filter(|_| mark(line).is_none()) {
            let by = value.trim().strip_prefix(variable)?.replace(' ', "");
            // A second change, or one in an inner block.
            if found.is_some() || depth != 1 || !by.starts_with(['+', '-']) {
                return None;
            }
            found = Some(number(&by)?);
        }
    }
    found
}

/// The text between the first bracket and the last.
fn inside(text: &str) -> &str {
    let text = text.strip_prefix('(').unwrap_or(text);
    text.rsplit_once(')').map_or(text, |(inside, _)| inside)
}
