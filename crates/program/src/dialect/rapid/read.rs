//! Reads ABB RAPID: motions to robtargets, written out or declared, and the procedures that a program calls.
//!
//! Positions are in the work object. The arc is struck by `ArcLStart` and ended by `ArcLEnd` or `ArcCEnd`, or by the
//! codes in the options. A weld instruction lays metal at the speed of its welddata; the times in seamdata count as
//! waits.

use super::module::{Module, Target, Value};
use super::{module, review};
use crate::dialect::reading::fault::{BLENDED_SWITCH, CONFIGURATION, RAPID_WITH_ARC, TWO_SWITCHES, WEAVE_PITCH};
use crate::dialect::reading::loops::{Counting, Mark, Next, behind, holds, turns, unrolled};
use crate::dialect::reading::trace::{Step, Trace};
use crate::dialect::reading::truth::truth;
use crate::dialect::reading::words::{
    Patterns, arguments, begins_with, compact, name, number, strip_word, unscoped, without_end,
};
use crate::dialect::reading::{FindModule, Metal, Options, ReadError, ReadProgram};
use glam::DVec3;
use std::collections::{BTreeSet, HashMap, HashSet};
use std::rc::Rc;

/// Instructions that affect neither position nor metal.
const HARMLESS: [&str; 58] = [
    "CirPathMode",
    "MechUnitLoad",
    "IDelete",
    "CONNECT",
    "ISignalDI",
    "IWatch",
    "TriggStopProc",
    "StartMove",
    "StopMove",
    "ConfL",
    "ConfJ",
    "SingArea",
    "AccSet",
    "VelSet",
    "PathAccLim",
    "WorldAccLim",
    "TPWrite",
    "TPErase",
    "TPReadFK",
    "Set",
    "Reset",
    "SetDO",
    "SetGO",
    "SetAO",
    "PulseDO",
    "InvertDO",
    "WaitDI",
    "WaitDO",
    "WaitUntil",
    "WaitRob",
    "ClkReset",
    "ClkStart",
    "ClkStop",
    "Stop",
    "Break",
    "ActUnit",
    "DeactUnit",
    "GripLoad",
    "ErrWrite",
    "Open",
    "Close",
    "Write",
    "VAR",
    "CONST",
    "PERS",
    "TASK",
    "LOCAL",
    "ENDIF",
    "ENDWHILE",
    "ENDTEST",
    "CASE",
    "DEFAULT",
    "RECORD",
    "ENDRECORD",
    "EOffsOff",
    "PDispOff",
    "MotionSup",
    "ISleep",
];

/// Branches and loops.
const CONTROL: [&str; 6] = ["IF", "WHILE", "TEST", "GOTO", "RETURN", "EXIT"];

/// Statements that only wait or report, up to the end of their block.
const WAITING: [&str; 7] = ["TPWrite", "ErrWrite", "Stop", "EXIT", "WaitTime", "ENDIF", "ENDWHILE"];

/// Where handlers begin: they run only on errors.
const HANDLERS: [&str; 3] = ["ERROR", "UNDO", "BACKWARD"];

/// The effect of a motion on the arc.
#[derive(Clone, Copy, PartialEq)]
enum Weld {
    /// Lays metal if the arc is on.
    No,
    /// Moves without metal, then strikes the arc.
    Start,
    /// Lays metal.
    Seam,
    /// Lays metal, then ends the arc.
    End,
}

/// Instruction, whether it is circular, and what it does to the arc.
const MOTIONS: [(&str, bool, Weld); 10] = [
    ("MoveL", false, Weld::No),
    ("MoveJ", false, Weld::No),
    ("MoveC", true, Weld::No),
    ("ArcL", false, Weld::Seam),
    ("ArcLStart", false, Weld::Start),
    ("ArcLEnd", false, Weld::End),
    ("ArcC", true, Weld::Seam),
    ("ArcCStart", true, Weld::Start),
    ("ArcCEnd", true, Weld::End),
    ("ArcMoveL", false, Weld::No),
];

/// Whether a line can occur only in RAPID.
pub(super) fn typical(line: &str) -> bool {
    const FIRST: [&str; 9] = ["MODULE", "PROC", "MoveL", "MoveJ", "MoveC", "MoveAbsJ", "ArcLStart", "PERS", "CONST"];
    // In URScript the word is followed by a bracket.
    let called = line.trim_start_matches(|c: char| c.is_ascii_alphanumeric()).starts_with('(');
    begins_with(unscoped(line), &FIRST) && !called
}

pub(super) fn read(text: &str, module: &mut FindModule<'_>, options: &Options) -> Result<ReadProgram, ReadError> {
    let mut reader = Reader {
        trace: Trace::new(),
        module,
        modules: Vec::new(),
        on: Patterns::new(&options.arc.on),
        off: Patterns::new(&options.arc.off),
        values: HashMap::new(),
        in_time: HashSet::new(),
        configured: [true; 2],
        interrupts: HashMap::new(),
        package: false,
        stops: false,
        lit_with: BTreeSet::new(),
        outputs: BTreeSet::new(),
        weaves: HashMap::new(),
    };
    let main = reader.load(None, text)?;
    let entry = main.proc("main").or_else(|| main.first_proc()).ok_or(ReadError::NoProgram("RAPID"))?;
    reader.run(&main, entry, 0)?;
    let Reader { mut trace, stops, lit_with, outputs, .. } = reader;
    let left: Vec<String> = outputs.intersection(&lit_with).cloned().collect();
    trace.ends_with(&left);
    review::program(&mut trace, &main, stops, &lit_with);
    trace.finish(super::DIALECT.language)
}

struct Reader<'a> {
    trace: Trace,
    module: &'a mut FindModule<'a>,
    /// Loaded modules, the main one first.
    modules: Vec<Rc<Module>>,
    on: Patterns,
    off: Patterns,
    /// Numbers of variables that were assigned, in upper case.
    values: HashMap<String, f64>,
    /// Flags set by waits that time out, in upper case.
    in_time: HashSet<String>,
    /// Whether the robot enforces configurations in joint moves, and monitors them in others.
    configured: [bool; 2],
    /// Interrupts on an input going off, in upper case, and whether they are active.
    interrupts: HashMap<String, bool>,
    /// Whether RobotWare Arc strikes the arc.
    package: bool,
    /// Whether a stop of the program ends the arc.
    stops: bool,
    /// Outputs that were on while the arc burned through them, in upper case.
    lit_with: BTreeSet<String>,
    /// Outputs that are on, in upper case.
    outputs: BTreeSet<String>,
    /// For the module and the length of each weave, the least and greatest dwell at a side, s: layers may differ in it.
    weaves: HashMap<(Option<String>, String), [f64; 2]>,
}

/// Output (in upper case) and state that a statement sets: `SetDO doArc,1;`, `Set doArc;`, `Reset doArc;`.
pub(super) fn output(word: &str, rest: &str) -> Option<(String, bool)> {
    let is = |name: &str| word.eq_ignore_ascii_case(name);
    let parts = arguments(rest);
    let high = || parts.get(1).is_some_and(|state| *state == "1" || state.eq_ignore_ascii_case("high"));
    let set = is("Set") || is("SetDO") && high();
    let named = is("Set") || is("Reset") || is("SetDO");
    named.then(|| (parts.first().copied().unwrap_or_default().to_ascii_uppercase(), set))
}

impl Reader<'_> {
    /// Loads a module and evaluates its data.
    fn load(&mut self, name: Option<&str>, text: &str) -> Result<Rc<Module>, ReadError> {
        let mut module = Module::new(name, text);
        self.trace.bytes += text.len();
        let caller = std::mem::replace(&mut self.trace.module, name.map(str::to_owned));
        for (line, kind, variable, value) in module.declarations() {
            let found = match kind {
                "ROBTARGET" => self.target(&value, &module, line)?.map(Value::Target),
                "SEAMDATA" => module::seam_times(&value).map(Value::Seam),
                "WOBJDATA" => module::moves_with_unit(&value).map(Value::WorkObject),
                "JOINTTARGET" => module::external_axes(&value).map(Value::Joints),
                "WEAVEDATA" => module::weave(&value).map(Value::Weave),
                "SPEEDDATA" => module::first_number(&value).map(Value::Speed),
                _ => module::first_number(&value).map(Value::Speed),
            };
            match found {
                Some(found) => module.set(&variable, found),
                None if ["NUM", "WOBJDATA", "JOINTTARGET", "WEAVEDATA"].contains(&kind) => {}
                None => self.trace.note(&variable, "has a value that is not understood", line),
            }
        }
        self.trace.module = caller;
        let module = Rc::new(module);
        self.modules.push(Rc::clone(&module));
        Ok(module)
    }

    fn run(&mut self, module: &Rc<Module>, proc: usize, depth: usize) -> Result<(), ReadError> {
        let caller = std::mem::replace(&mut self.trace.module, module.name.clone());
        let handler = |text: &str| HANDLERS.iter().any(|h| h.eq_ignore_ascii_case(name(text).0));
        let body: Vec<(&str, usize)> = module.body(proc).take_while(|(text, _)| !handler(text)).collect();
        unrolled(body.len(), |i| mark(body[i].0), |i| self.line(&body, i, module, depth))?;
        self.trace.module = caller;
        Ok(())
    }

    /// Reads a statement; returns what comes after it.
    fn line(&mut self, body: &[(&str, usize)], i: usize, module: &Rc<Module>, depth: usize) -> Result<Next, ReadError> {
        let (text, line) = body[i];
        match mark(text) {
            Some(Mark::Begin) => {
                let until = behind(i + 1, body.len(), |at| mark(body[at].0));
                let inside = || body[i + 1..until].iter().map(|(text, _)| *text);
                let waits = || inside().all(|text| begins_with(text, &WAITING)).then_some(false);
                let next = match (strip_word(text, "IF"), strip_word(text, "WHILE")) {
                    (Some(condition), _) => Next::taken(self.holds(condition, module).or_else(waits)),
                    // A loop that continues while something is late.
                    (_, Some(condition)) => Next::taken(self.goes_on(condition).or_else(waits)),
                    _ => turns(text, "FROM", Counting::Towards).map_or(Next::On, Next::Turns),
                };
                if next == Next::On {
                    let word = name(text).0.to_ascii_uppercase();
                    self.trace.note(&word, "is not followed: its lines were read once", line);
                }
                Ok(next)
            }
            Some(Mark::Else) => Ok(Next::On),
            Some(Mark::End) => self.trace.turn(line).map(|()| Next::On),
            None => self.statement(text, line, module, depth).map(|()| Next::On),
        }
    }

    /// Whether a condition up to its `THEN` holds, if that is known.
    fn holds(&self, condition: &str, module: &Module) -> Option<bool> {
        let condition = compact(without_end(condition, "THEN"));
        let value = |name: &str| match (self.values.get(name), self.value(name, module)) {
            (Some(value), _) => Some(*value),
            (None, Some(Value::Speed(value))) => Some(value),
            _ => None,
        };
        holds(&condition, value)
    }

    /// Whether a loop continues whose condition tests time-out flags of waits, and outputs: in normal operation no wait
    /// times out, and outputs are as they were set.
    fn goes_on(&self, condition: &str) -> Option<bool> {
        truth(without_end(condition, "DO"), &|part| {
            let flat = compact(part);
            let output = flat.strip_prefix("DOUTPUT(").and_then(|rest| rest.split_once(")="));
            let set = |(name, value): (&str, &str)| {
                self.outputs.contains(name).then(|| value == "1").filter(|_| ["0", "1"].contains(&value))
            };
            self.in_time.contains(&flat).then_some(false).or_else(|| set(output?))
        })
    }

    fn statement(&mut self, text: &str, line: usize, module: &Rc<Module>, depth: usize) -> Result<(), ReadError> {
        let (word, rest) = name(text);
        if let Some((_, flag)) = text.split_once("\\TimeFlag:=") {
            self.in_time.insert(name(flag).0.to_ascii_uppercase());
        }
        let is = |name: &str| name.eq_ignore_ascii_case(word);
        if let Some(&(_, round, weld)) = MOTIONS.iter().find(|m| is(m.0)) {
            return self.motion(round, weld, is("MoveJ"), text, line, module);
        }
        let flat = compact(text);
        self.watched(word, rest, &flat, line);
        let (lit, ended) = (self.on.matches(&flat), self.off.matches(&flat));
        if lit || ended {
            self.trace.set_arc(lit, line);
            let place = self.trace.place(line);
            self.trace.watch.switch(lit, &mut self.trace.faults, place);
            if lit {
                self.lit_with.extend(self.outputs.iter().cloned());
            }
        } else if is("WaitTime") {
            let seconds = arguments(rest).into_iter().rfind(|p| !p.starts_with('\\')).unwrap_or_default();
            let wait = number(seconds).ok_or_else(|| self.trace.number_error(line, seconds))?;
            self.trace.dwell += wait.max(0.0);
        } else if is("MoveAbsJ") || is("MoveExtJ") {
            let target = arguments(rest).first().copied().unwrap_or_default();
            let joints = match self.value(target, module) {
                Some(Value::Joints(axes)) => Some(axes),
                _ => module::external_axes(target).filter(|_| target.starts_with('[')),
            };
            if let Some(axes) = joints.filter(|_| is("MoveAbsJ")) {
                self.trace.home(&axes, target, line);
            }
            self.trace.note(word, "goes to a place that is unknown here and was left out", line);
            self.trace.forget();
        } else if is("Load") || is("StartLoad") {
            self.load_file(text, line)?;
        } else if is("UnLoad") {
            let file = module::stem(text).unwrap_or_default();
            self.modules.retain(|m| !m.name.as_deref().is_some_and(|n| n.eq_ignore_ascii_case(file)));
        } else if is("IF") && flat.to_ascii_uppercase().contains("ERASEMODULE") {
            // Clears what a stop may have left; a program read from its beginning has nothing to clear.
        } else if CONTROL.iter().any(|c| is(c)) {
            return self.control(text, line, module, depth);
        } else {
            return self.other(text, &flat, line, module, depth);
        }
        Ok(())
    }

    /// Evaluates a statement for arc monitoring and for how the robot moves.
    fn watched(&mut self, word: &str, rest: &str, flat: &str, line: usize) {
        let is = |name: &str| name.eq_ignore_ascii_case(word);
        let first = || arguments(rest).first().copied().unwrap_or_default().to_ascii_uppercase();
        if is("ConfJ") || is("ConfL") {
            self.configured[usize::from(is("ConfL"))] = !flat.ends_with("\\OFF");
        } else if is("TriggStopProc") {
            self.stops = true;
        } else if is("ISignalDI") {
            // An interrupt on a signal going off.
            let parts = arguments(rest);
            if let [_, value, interrupt] = parts[parts.len().saturating_sub(3)..]
                && value == "0"
            {
                self.interrupts.insert(interrupt.to_ascii_uppercase(), true);
                self.trace.watch.arm();
            }
        } else if (is("ISleep") || is("IDelete")) && self.interrupts.contains_key(&first()) {
            let place = self.trace.place(line);
            self.trace.watch.disarm(&format!("{word} {}", rest.trim()), &mut self.trace.faults, place);
        } else if is("IWatch") && self.interrupts.contains_key(&first()) {
            self.trace.watch.arm();
        } else if is("WaitDI") || is("WaitUntil") {
            self.trace.watch.look();
            if !flat.contains("\\MAXTIME") {
                self.trace.waits(word, line);
            }
        } else if is("Stop") || is("EXIT") || is("UIMsgBox") || is("TPReadFK") {
            self.trace.halts(word, line);
        } else if is("WaitTime") && flat.contains("\\INPOS") || is("WaitRob") {
            self.trace.watch.wait();
        } else if let Some((output, on)) = output(word, rest) {
            if on {
                self.outputs.insert(output.clone())
            } else {
                self.outputs.remove(&output)
            };
            if self.package && (self.on.matches(flat) || self.off.matches(flat)) {
                let place = Some(self.trace.place(line));
                let text = format!("{output} is switched alongside RobotWare Arc.");
                self.trace.faults.add(&TWO_SWITCHES, place, text);
            }
        }
    }

    /// `IF a THEN` on its own line needs nothing more; `IF a MoveL ..;` and `IF a THEN MoveL ..;` hold a statement.
    fn control(&mut self, text: &str, line: usize, module: &Rc<Module>, depth: usize) -> Result<(), ReadError> {
        let word = name(text).0.to_ascii_uppercase();
        self.trace.note(&word, "is not followed: its lines were read once", line);
        let upper = text.to_ascii_uppercase();
        let inner = ["THEN", " MOVE", " ARC", " SETDO"].iter().find_map(|w| {
            let at = upper.find(w)?;
            Some(if *w == "THEN" { &text[at + 4..] } else { &text[at..] })
        });
        match inner.map(str::trim).filter(|s| !s.is_empty() && word.contains("IF")) {
            Some(inner) => self.statement(inner, line, module, depth),
            None => Ok(()),
        }
    }

    /// Handles assignments, calls, and the remaining statements.
    fn other(
        &mut self,
        text: &str,
        flat: &str,
        line: usize,
        module: &Rc<Module>,
        depth: usize,
    ) -> Result<(), ReadError> {
        let (word, rest) = name(text);
        if let Some(late) = text.strip_prefix('%') {
            let called = late.trim_end_matches('%').trim_matches('"');
            if let Some((of, called)) = called.rsplit_once(':') {
                self.find_module(of, line)?;
                return self.call(called, line, module, depth);
            }
            return self.call(called, line, module, depth);
        }
        if word.eq_ignore_ascii_case("PDispSet") {
            // Heights added to layers are 0 until somebody sets them.
            let ours = flat.to_ascii_uppercase().starts_with("PDISPSET[[0,0,NDZ{") && self.offsets_are_zero();
            if !ours {
                self.trace.note("PDispSet", "is not applied", line);
            }
            return Ok(());
        }
        if HARMLESS.iter().any(|h| h.eq_ignore_ascii_case(word)) || word.is_empty() {
            let lights = flat.starts_with("SETDO") && flat.ends_with(",1");
            if lights || (flat.starts_with("SET") && !flat.contains(',')) {
                self.trace.see(text);
            }
            return Ok(());
        }
        if let Some(value) = rest.strip_prefix(":=").and_then(number) {
            self.values.insert(word.to_ascii_uppercase(), value);
            return Ok(());
        }
        if rest.starts_with(":=") || rest.starts_with(['.', '{']) {
            self.values.remove(&word.to_ascii_uppercase());
            self.trace.note("an assignment", "is not followed", line);
            return Ok(());
        }
        // With arguments it may equally be an instruction of a RobotWare option.
        if rest.is_empty() || self.find(word, module).is_some() {
            return self.call(word, line, module, depth);
        }
        self.trace.note(word, "is not understood and was left out", line);
        Ok(())
    }

    /// Whether the main module's heights added to layers are all 0.
    fn offsets_are_zero(&self) -> bool {
        let zero = |module: &Rc<Module>| module.zeros("nDz");
        self.modules.first().is_some_and(zero)
    }

    fn load_file(&mut self, text: &str, line: usize) -> Result<(), ReadError> {
        let Some(file) = module::stem(text) else {
            self.trace.note("Load", "names its file by a variable, which is not followed", line);
            return Ok(());
        };
        let missing = || ReadError::MissingModule { place: self.trace.place(line), name: file.to_owned() };
        let found = (self.module)(file).ok_or_else(missing)?;
        self.load(Some(file), &found).map(|_| ())
    }

    /// Loads a module that a call names and that is not loaded yet, as a `.pgf` would.
    fn find_module(&mut self, name: &str, line: usize) -> Result<(), ReadError> {
        let known = |m: &Rc<Module>| m.name.as_deref().is_some_and(|n| n.eq_ignore_ascii_case(name));
        if !self.modules.iter().any(known)
            && let Some(text) = (self.module)(name)
        {
            self.trace.call(name, 0, line)?;
            self.load(Some(name), &text)?;
        }
        Ok(())
    }

    /// The procedure in the module itself, or in the most recently loaded module that has it.
    fn find(&self, called: &str, module: &Rc<Module>) -> Option<(Rc<Module>, usize)> {
        let all = std::iter::once(module).chain(self.modules.iter().rev());
        all.into_iter().find_map(|m| m.proc(called).map(|p| (Rc::clone(m), p)))
    }

    fn call(&mut self, called: &str, line: usize, module: &Rc<Module>, depth: usize) -> Result<(), ReadError> {
        self.trace.call(called, depth, line)?;
        if self.find(called, module).is_none()
            && let Some(text) = (self.module)(called)
        {
            self.load(Some(called), &text)?;
        }
        match self.find(called, module) {
            Some((module, proc)) => self.run(&module, proc, depth + 1),
            None => Err(ReadError::MissingModule { place: self.trace.place(line), name: called.to_owned() }),
        }
    }

    fn motion(
        &mut self,
        round: bool,
        mut weld: Weld,
        joint: bool,
        text: &str,
        line: usize,
        module: &Module,
    ) -> Result<(), ReadError> {
        let (_, rest) = name(text);
        let (option, _) = name(rest.trim_start_matches('\\'));
        // Older RobotWare: ArcL\On and ArcL\Off.
        if weld == Weld::Seam && rest.starts_with('\\') {
            weld = if option.eq_ignore_ascii_case("On") { Weld::Start } else { weld };
            weld = if option.eq_ignore_ascii_case("Off") { Weld::End } else { weld };
        }
        let pieces: Vec<&str> = arguments(rest).into_iter().map(strip_option).filter(|p| !p.is_empty()).collect();
        let at = |i: usize| pieces.get(i).copied().unwrap_or_default();
        let speed_at = if round { 2 } else { 1 };
        let speed = self.speed(at(speed_at), rest, module);
        let welding = matches!(weld, Weld::Seam | Weld::End);
        let speed = if welding { self.speed(at(speed_at + 2), "", module).or(speed) } else { speed };
        if speed.is_none() && !joint {
            self.trace.note("a speed", "is not understood and was read as unknown", line);
        }
        let metal = match weld {
            Weld::No => self.trace.metal(),
            Weld::Start => Metal::Off,
            Weld::Seam | Weld::End => Metal::Arc,
        };
        let step = Step { speed: speed.unwrap_or(0.0), metal, width: None, line };
        self.package |= weld == Weld::Start;
        let zone = at(speed_at + if weld == Weld::No { 1 } else { 3 });
        if matches!(weld, Weld::Start | Weld::End) && !zone.eq_ignore_ascii_case("fine") {
            let (place, what) = (self.trace.place(line), if weld == Weld::End { "ends" } else { "is struck" });
            self.trace.faults.add(&BLENDED_SWITCH, Some(place), format!("the arc {what} at a point with zone {zone}."));
        }
        let targets = (self.target(at(0), module, line)?, round.then(|| self.target(at(1), module, line)).transpose()?);
        if let (_, Some(Some(last))) | (Some(last), None) = targets {
            self.before_motion(&last, joint, rest, module, line);
        }
        if metal == Metal::Arc {
            self.weaving(rest, step.speed, module, line);
        }
        match targets {
            (Some(to), None) => self.trace.line(to.at.to_array().map(Some), step),
            (Some(aux), Some(Some(end))) => self.trace.arc_over(aux.at, end.at, None, step),
            _ => {
                self.trace.note("a motion to a place that is computed or not declared", "was left out", line);
                self.trace.forget();
            }
        }
        if let Some(Value::Seam([start, end])) = self.value(at(speed_at + 1), module) {
            self.trace.dwell += match weld {
                Weld::Start => start,
                Weld::End => end,
                Weld::No | Weld::Seam => 0.0,
            };
        }
        if weld != Weld::No {
            self.trace.set_arc(matches!(weld, Weld::Start | Weld::Seam), line);
        }
        Ok(())
    }

    /// Evaluates what a motion states besides its position, before it is made.
    fn before_motion(&mut self, target: &Target, joint: bool, rest: &str, module: &Module, line: usize) {
        let wobj = rest.split_once("\\WObj:=").map(|(_, wobj)| name(wobj).0);
        if let Some(Value::WorkObject(moves)) = wobj.and_then(|wobj| self.value(wobj, module)) {
            self.trace.frame_turns = moves;
        }
        let place = self.trace.place(line);
        let controlled = self.configured[usize::from(!joint)];
        if target.unconfigured && controlled {
            let (word, kind) = if joint { ("ConfJ", "joint moves") } else { ("ConfL", "straight moves and arcs") };
            let text = format!("targets have the configuration [0,0,0,0], and {word} enforces it for {kind}.");
            self.trace.faults.add(&CONFIGURATION, Some(place.clone()), text);
        }
        if joint && self.trace.arc {
            self.trace.faults.add(&RAPID_WITH_ARC, Some(place.clone()), "MoveJ moves the joints with the arc on.");
        }
        if self.package {
            self.trace.watch.wait();
        } else {
            let exact = arguments(rest).iter().any(|piece| piece.eq_ignore_ascii_case("fine"));
            self.trace.watch.go((!exact).then_some("a zone"), &mut self.trace.faults, place);
        }
        self.trace.stand(&target.stated, target.at, "a target", line);
    }

    /// The dwell time of a weave at a side follows from its distance and the speed.
    fn weaving(&mut self, rest: &str, speed: f64, module: &Module, line: usize) {
        let weave = rest.split_once("\\Weave:=").map(|(_, weave)| name(weave).0);
        let Some(Value::Weave([length, stay])) = weave.and_then(|weave| self.value(weave, module)) else { return };
        if speed <= 0.0 || stay <= 0.0 {
            return;
        }
        let time = stay / speed;
        let times = self.weaves.entry((module.name.clone(), format!("{length}"))).or_insert([time, time]);
        *times = [times[0].min(time), times[1].max(time)];
        if times[1] > 1.1 * times[0] {
            let text = format!(
                "the weave dwells at its sides for {:.3} to {:.3} s: its data give a distance, not a time.",
                times[0], times[1]
            );
            let place = Some(self.trace.place(line));
            self.trace.faults.add(&WEAVE_PITCH, place, text);
        }
    }

    /// Speed in mm/s of a speeddata or welddata: predefined, named, or written out; `\V:=` overrides it.
    fn speed(&self, text: &str, options: &str, module: &Module) -> Option<f64> {
        if let Some((_, v)) = options.split_once("\\V:=") {
            return number(v.split([',', '\\']).next()?);
        }
        if text.starts_with('[') {
            return module::first_number(text);
        }
        match self.value(text, module) {
            Some(Value::Speed(speed)) => Some(speed),
            Some(_) => None,
            None => number(text.strip_prefix(['v', 'V'])?),
        }
    }

    fn value(&self, variable: &str, module: &Module) -> Option<Value> {
        module.get(variable).or_else(|| self.modules.iter().rev().find_map(|m| m.get(variable)))
    }

    /// `[[x,y,z],..]`, a name, or `Offs(place,x,y,z)`; `None` if it is something else.
    fn target(&self, text: &str, module: &Module, line: usize) -> Result<Option<Target>, ReadError> {
        if text.starts_with('[') {
            let target = module::target(text).map_err(|bad| self.trace.number_error(line, bad))?;
            return Ok(Some(target));
        }
        if let Some(inside) = strip_word(text, "Offs").and_then(|r| r.strip_prefix('(')?.strip_suffix(')')) {
            let pieces = arguments(inside);
            let [base, by @ ..] = &pieces[..] else { return Ok(None) };
            let mut offset = [0.0; 3];
            for (value, text) in offset.iter_mut().zip(by) {
                *value = number(text).ok_or_else(|| self.trace.number_error(line, text))?;
            }
            let offset = DVec3::from_array(offset);
            return Ok(self.target(base, module, line)?.map(|target| Target { at: target.at + offset, ..target }));
        }
        match self.value(text, module) {
            Some(Value::Target(to)) => Ok(Some(to)),
            _ => Ok(None),
        }
    }
}

/// Where a block begins or ends. An `IF` with a statement after its condition is not a block.
fn mark(text: &str) -> Option<Mark> {
    let is = |word: &str| strip_word(text, word).is_some();
    let ends =
        |last: &str| text.get(text.len().saturating_sub(last.len())..).is_some_and(|t| t.eq_ignore_ascii_case(last));
    if is("FOR") || (is("IF") && ends("THEN")) || (is("WHILE") && ends("DO")) {
        Some(Mark::Begin)
    } else if is("ELSE") || is("ELSEIF") {
        Some(Mark::Else)
    } else {
        (is("ENDFOR") || is("ENDIF") || is("ENDWHILE")).then_some(Mark::End)
    }
}

/// An argument without the optional ones after it, as in `weld1\Weave:=wv`.
fn strip_option(piece: &str) -> &str {
    piece.split('\\').next().unwrap_or_default().trim()
}
