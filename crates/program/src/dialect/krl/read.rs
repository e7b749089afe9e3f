//! Reads KUKA KRL: motions to Cartesian positions, named or written out, and the subprograms that a program calls.
//!
//! Positions are in `$BASE`. The arc is struck by ArcTech (`ArcMainNG`, `ARCON`), by `ARC_ON( )` or by the codes in the
//! options; a trigger at the end of a motion takes effect after that motion. In a spline block, SLIN and SCIRC are read
//! as they are; only the controller knows the path of SPL, so it is refused where it welds.

use super::review;
use super::words::{MOTIONS, Target, number_before, with_speed};
use crate::dialect::reading::fault::TWO_SWITCHES;
use crate::dialect::reading::loops::{Counting, Mark, Next, behind, holds, turns, unrolled};
use crate::dialect::reading::trace::Trace;
use crate::dialect::reading::truth::truth;
use crate::dialect::reading::words::{
    Patterns, before_comment, begins_with, compact, name, strip_word, unscoped, without_end,
};
use crate::dialect::reading::{FindModule, Options, ReadError, ReadProgram, words};
use std::collections::{BTreeSet, HashMap};
use std::rc::Rc;

/// Statements that affect neither position nor metal.
const HARMLESS: [&str; 24] = [
    "DECL",
    "INT",
    "REAL",
    "BOOL",
    "CHAR",
    "STRUC",
    "ENUM",
    "E6POS",
    "E6AXIS",
    "POS",
    "FRAME",
    "AXIS",
    "SIGNAL",
    "EXT",
    "EXTFCT",
    "GLOBAL",
    "CONTINUE",
    "PTP_SPLINE",
    "WAIT",
    "BAS",
    "BRAKE",
    "ANOUT",
    "ANIN",
    "IMPORT",
];

/// System programs without motion.
const SYSTEM: [&str; 2] = ["BAS", "SET_CD_PARAMS"];

/// Branches and loops that are not followed, by their first words.
const CONTROL: [&str; 7] = ["LOOP", "REPEAT", "UNTIL", "SWITCH", "GOTO", "RETURN", "EXIT"];
const CONTROL_REST: [&str; 5] = ["ENDLOOP", "CASE", "DEFAULT", "ENDSWITCH", "HALT"];

/// First words of lines that only wait, up to the end of their block.
const WAITING: [&str; 4] = ["HALT", "WAIT", "ENDIF", "ENDWHILE"];

/// First words of blocks, and of their ends.
const BLOCKS: [(&str, &str); 3] = [("FOR", "ENDFOR"), ("IF", "ENDIF"), ("WHILE", "ENDWHILE")];

/// A module: its text, where each program in it begins, and its data.
pub(super) struct Source {
    /// Name of the module; `None` for the main file.
    pub(super) module: Option<String>,
    pub(super) text: Rc<str>,
    /// Name in upper case, byte after the DEF line, number of the next line.
    pub(super) programs: Vec<(String, usize, usize)>,
    pub(super) targets: HashMap<String, Target>,
    /// ArcTech data sets.
    arc_data: HashMap<String, ArcData>,
}

/// Speed and times of an ArcTech data set.
#[derive(Clone, Copy)]
struct ArcData {
    /// Weld speed, mm/s.
    speed: Option<f64>,
    /// Time for which the torch stands still while the arc starts or ends, s.
    pause: f64,
}

/// Times of an ArcTech data set during which the torch stands still, at the start and at the end of a seam.
const PAUSES: [&str; 5] = ["PreFlowTime", "StartTime", "CraterTime", "BurnBackTime", "PostflowTime"];

/// Whether a line can occur only in KRL.
pub(super) fn typical(line: &str) -> bool {
    const FIRST: [&str; 9] = ["DEF", "DEFDAT", "DEFFCT", "LIN", "PTP", "SLIN", "SPTP", "$VEL", "$OUT"];
    let marked = line.starts_with('&') || line.starts_with(";FOLD");
    // `def name():` is URScript.
    let script = line.starts_with("def ") && before_comment(line, '#').trim_end().ends_with(':');
    (marked || begins_with(unscoped(line), &FIRST)) && !script
}

pub(super) fn read(text: &str, module: &mut FindModule<'_>, options: &Options) -> Result<ReadProgram, ReadError> {
    let mut reader = Reader {
        trace: Trace::new(),
        module,
        sources: Vec::new(),
        on: Patterns::new(&options.arc.on),
        off: Patterns::new(&options.arc.off),
        speed: 0.0,
        weld_speed: None,
        block_speed: None,
        later: None,
        values: HashMap::new(),
        circle_by_path: false,
        interrupts: HashMap::new(),
        outputs: BTreeSet::new(),
        lit_with: BTreeSet::new(),
        forms: false,
        runs_on: false,
    };
    let main = reader.load(None, text.into())?;
    // A fragment without DEF starts at its first line.
    let start = match reader.sources[main].programs.first() {
        Some(&(_, byte, line)) => (byte, line),
        None if text.lines().any(|l| strip_word(l.trim_start(), "DEFDAT").is_some()) => {
            return Err(ReadError::NoProgram("KRL"));
        }
        None => (0, 1),
    };
    reader.run(main, start, 0)?;
    let Reader { mut trace, sources, interrupts, lit_with, outputs, .. } = reader;
    let left: Vec<String> = outputs.intersection(&lit_with).map(|output| format!("$OUT[{output}]")).collect();
    trace.ends_with(&left);
    review::program(&mut trace, &sources, &interrupts, &lit_with, options);
    trace.finish(super::DIALECT.language)
}

pub(super) struct Reader<'a> {
    pub(super) trace: Trace,
    module: &'a mut FindModule<'a>,
    pub(super) sources: Vec<Source>,
    on: Patterns,
    off: Patterns,
    /// Speed, mm/s; 0 if unknown.
    pub(super) speed: f64,
    /// Weld speed of the current ArcTech data, mm/s.
    weld_speed: Option<f64>,
    /// Speed of the spline block, mm/s.
    pub(super) block_speed: Option<f64>,
    /// State of the arc after the next motion; `None` if nothing switches it there.
    pub(super) later: Option<bool>,
    /// Variables with a plain number, in upper case.
    values: HashMap<String, f64>,
    /// Whether `$CIRC_TYPE` carries the tool along with the tangent.
    pub(super) circle_by_path: bool,
    /// Conditions of the interrupts that are declared, by their numbers, without blanks.
    interrupts: HashMap<u32, String>,
    /// Outputs that are on.
    outputs: BTreeSet<u32>,
    /// Outputs that were on while the arc burned through them.
    lit_with: BTreeSet<u32>,
    /// Whether forms of ArcTech strike the arc.
    pub(super) forms: bool,
    /// Whether the last line was CONTINUE.
    runs_on: bool,
}

impl Reader<'_> {
    /// Loads a module and its data file.
    fn load(&mut self, module: Option<&str>, text: Rc<str>) -> Result<usize, ReadError> {
        let programs = programs(&text);
        self.trace.bytes += text.len();
        let own = module.or(programs.first().map(|p| p.0.as_str())).map(|name| format!("{name}.dat"));
        let data = own.as_ref().and_then(|name| (self.module)(name));
        let caller = std::mem::replace(&mut self.trace.module, module.map(str::to_owned));
        let (targets, arc_data) = (HashMap::new(), HashMap::new());
        let mut source = Source { module: self.trace.module.clone(), text, programs, targets, arc_data };
        if let Some(data) = data {
            self.trace.bytes += data.len();
            self.trace.module = own;
            for (i, line) in data.lines().enumerate() {
                self.declaration(before_comment(line, ';').trim(), i + 1, &mut source)?;
            }
        }
        self.trace.module = caller;
        self.sources.push(source);
        Ok(self.sources.len() - 1)
    }

    /// `DECL E6POS XP1={..}` and ArcTech data; other declarations are not needed.
    fn declaration(&mut self, line: &str, number: usize, source: &mut Source) -> Result<(), ReadError> {
        let Some((left, value)) = line.split_once('=') else { return Ok(()) };
        let mut words = left.split_whitespace().rev();
        let Some(variable) = words.next() else { return Ok(()) };
        let Some(kind) = words.next() else {
            // An element of an array.
            self.values.extend(words::number(value).map(|value| (variable.to_ascii_uppercase(), value)));
            return Ok(());
        };
        let is = |name: &str| kind.eq_ignore_ascii_case(name);
        if ["E6POS", "POS", "FRAME", "E6AXIS", "AXIS"].into_iter().any(is) {
            let target = self.aggregate(value, number)?;
            source.targets.insert(variable.to_ascii_uppercase(), target);
        } else if is("stArcDat_T") {
            let value_of = |key: &str| value.split_once(key).and_then(|(_, v)| number_before(v));
            let speed = value_of("Velocity").map(|speed| speed * 1000.0);
            let pause = PAUSES.iter().filter_map(|key| value_of(key)).map(|time| time.max(0.0)).sum();
            source.arc_data.insert(variable.to_ascii_uppercase(), ArcData { speed, pause });
        } else if let Some(value) = words::number(value) {
            self.values.insert(variable.to_ascii_uppercase(), value);
        }
        Ok(())
    }

    fn run(&mut self, source: usize, start: (usize, usize), depth: usize) -> Result<(), ReadError> {
        let text = Rc::clone(&self.sources[source].text);
        let caller = std::mem::replace(&mut self.trace.module, self.sources[source].module.clone());
        let lines = text[start.0..].lines().map(|raw| before_comment(raw, ';').trim());
        let ends = |line: &&str| strip_word(line, "END").is_some() || is_head(line).is_some();
        let lines: Vec<&str> = lines.take_while(|line| !ends(line)).collect();
        unrolled(
            lines.len(),
            |i| mark(lines[i]),
            |i| match lines[i] {
                "" => Ok(Next::On),
                line if line.starts_with('&') => Ok(Next::On),
                _ => self.line(&lines, i, start.1 + i, source, depth),
            },
        )?;
        self.trace.module = caller;
        Ok(())
    }

    /// Reads a line; returns what comes after it.
    fn line(
        &mut self,
        lines: &[&str],
        i: usize,
        number: usize,
        source: usize,
        depth: usize,
    ) -> Result<Next, ReadError> {
        match mark(lines[i]) {
            Some(Mark::Begin) => Ok(self.block(lines, i, number)),
            Some(Mark::Else) => Ok(Next::On),
            Some(Mark::End) => self.trace.turn(number).map(|()| Next::On),
            None => self.statement(lines[i], number, source, depth).map(|()| Next::On),
        }
    }

    /// How often the block that begins with a line is run.
    fn block(&mut self, lines: &[&str], i: usize, number: usize) -> Next {
        let (word, rest) = name(lines[i]);
        let known = if word.eq_ignore_ascii_case("FOR") {
            turns(lines[i], "=", Counting::Up)
        } else {
            if rest.to_ascii_uppercase().contains("$IN[") {
                self.trace.watch.look();
            }
            let condition = without_end(rest, "THEN");
            let until = behind(i + 1, lines.len(), |at| mark(lines[at]));
            let moves = lines[i + 1..until].iter().any(|line| MOTIONS.iter().any(|m| strip_word(line, m.0).is_some()));
            let loops = word.eq_ignore_ascii_case("WHILE");
            let compared = |part: &str| holds(&compact(part), |name| self.values.get(name).copied()).filter(|_| !loops);
            let on = |part: &str| compared(part).or_else(|| self.is_on(part));
            let waits =
                lines[i + 1..until].iter().all(|line| WAITING.iter().any(|word| strip_word(line, word).is_some()));
            let known = truth(condition, &compared).or_else(|| truth(condition, &on).filter(|_| !moves));
            known.or(waits.then_some(false)).map(u64::from)
        };
        known.map_or_else(
            || {
                let fate = "is not followed: its lines were read once";
                self.trace.note(&word.to_ascii_uppercase(), fate, number);
                Next::On
            },
            Next::Turns,
        )
    }

    /// Whether an input, a flag or an output is on in normal operation: inputs and flags of a burning arc or of
    /// monitoring are.
    fn is_on(&self, part: &str) -> Option<bool> {
        let flat = compact(part);
        let (kind, number) = flat.strip_suffix(']')?.split_once('[')?;
        let number = number.parse::<u32>().ok()?;
        match kind {
            "$IN" | "$FLAG" => Some(true),
            "$OUT" => self.outputs.contains(&number).then_some(true),
            _ => None,
        }
    }

    fn statement(&mut self, line: &str, number: usize, source: usize, depth: usize) -> Result<(), ReadError> {
        let (word, rest) = name(line);
        if let Some((_, motion)) = MOTIONS.iter().find(|(m, _)| m.eq_ignore_ascii_case(word)) {
            return self.motion(*motion, rest, number, source);
        }
        if ["SPLINE", "ENDSPLINE"].iter().any(|w| w.eq_ignore_ascii_case(word)) {
            self.block_speed = with_speed(rest);
            return Ok(());
        }
        let flat = compact(line);
        // An output stops the advance run, unless CONTINUE precedes it.
        let runs_on = std::mem::replace(&mut self.runs_on, flat == "CONTINUE");
        if self.runs_on {
            return Ok(());
        }
        if flat.starts_with("$OUT[") && !runs_on {
            self.trace.watch.wait();
        }
        if self.arc(&flat, line, number, source)? {
            return Ok(());
        }
        if let Some(speed) = flat.strip_prefix("$VEL.CP=").or_else(|| bas_speed(&flat)) {
            return self.set_speed(speed, number);
        }
        if strip_word(line, "WAIT").is_some() || strip_word(line, "HALT").is_some() {
            self.trace.watch.wait();
            if flat.starts_with("HALT") {
                self.trace.halts("HALT", number);
            } else if flat.starts_with("WAITFOR") && !flat.contains("$TIMER") {
                self.trace.waits(line, number);
            }
        }
        if let Some(rest) = strip_word(line, "WAIT").and_then(|r| strip_word(r, "SEC")) {
            let seconds = words::number(rest);
            self.trace.dwell += seconds.ok_or_else(|| self.trace.number_error(number, rest))?.max(0.0);
            return Ok(());
        }
        self.other(line, &flat, number, source, depth)
    }

    /// Handles statements without motion.
    fn other(&mut self, line: &str, flat: &str, number: usize, source: usize, depth: usize) -> Result<(), ReadError> {
        let (word, rest) = name(line);
        let is = |name: &&str| name.eq_ignore_ascii_case(word);
        if line.starts_with('$') {
            if let Some(frame) = flat.strip_prefix("$BASE=") {
                self.trace.note("$BASE", "is not applied: places are those of the base", number);
                self.trace.frame_turns = frame.starts_with("EK(");
            } else if let Some(kind) = flat.strip_prefix("$CIRC_TYPE=") {
                self.circle_by_path = kind == "#PATH";
            } else if let Some((output, on)) = output(flat) {
                self.switch(output, on, line, number);
            }
        } else if let Some(rest) = strip_word(unscoped(line), "INTERRUPT") {
            self.interrupt(rest, number);
        } else if rest.starts_with('=') && rest[1..].trim_start().starts_with('{') {
            let target = self.aggregate(&rest[1..], number)?;
            self.sources[source].targets.insert(word.to_ascii_uppercase(), target);
        } else if CONTROL.iter().any(is) {
            self.trace.note(&word.to_ascii_uppercase(), "is not followed: its lines were read once", number);
        } else if rest.starts_with('(') && !SYSTEM.iter().any(is) {
            return self.call(word, rest, number, source, depth);
        } else if let Some(component) = flat.split_once("_SHIFT.Z=").map(|(_, component)| component) {
            // The height added to a layer; ours are 0 until somebody sets them.
            if self.values.get(component) != Some(&0.0) {
                self.trace.note("a height added to a layer", "is not applied", number);
            }
        } else if rest.starts_with(['.', '[', '=']) {
            if let Some(value) = rest.strip_prefix('=') {
                self.assign(word, value);
            } else if rest.starts_with('.') {
                self.trace.note(word, "is changed in a part, which is not understood", number);
            }
        } else if !HARMLESS.iter().chain(&CONTROL_REST).chain(&SYSTEM).any(is) && !flat.starts_with("TRIGGERWHEN") {
            self.trace.note(word, "is not understood and was left out", number);
        }
        Ok(())
    }

    /// Remembers a plain number; computed values are forgotten.
    fn assign(&mut self, variable: &str, value: &str) {
        let variable = variable.to_ascii_uppercase();
        match words::number(value) {
            Some(value) => self.values.insert(variable, value),
            None => self.values.remove(&variable),
        };
    }

    /// Whether the statement switches the arc; if so, switches it.
    fn arc(&mut self, flat: &str, line: &str, number: usize, source: usize) -> Result<bool, ReadError> {
        let starts = |words: [&str; 2]| words.iter().any(|w| flat.starts_with(w));
        let holds = |words: [&str; 2]| words.iter().any(|w| flat.contains(w));
        let lit = self.on.matches(flat) || starts(["ARCON", "ARC_ON("]) || holds(["MAINNG(#ARCON", "MAINNG(#ARCSWI"]);
        let ended = self.off.matches(flat) || starts(["ARCOFF", "ARC_OFF("]) || flat.contains("MAINNG(#ARCOFF");
        if !lit && !ended {
            return Ok(false);
        }
        let data = flat.split([',', ')']).find_map(|d| self.sources[source].arc_data.get(d)).copied();
        self.weld_speed = data.and_then(|data| data.speed).or(self.weld_speed);
        if !flat.starts_with("TRIGGERWHEN") && !flat.contains("BEFOREMOVE") && !flat.contains("#ARCSWI") {
            self.trace.dwell += data.map_or(0.0, |data| data.pause);
        }
        // An inline form contains its motion; the arc is switched at the end of it.
        let form = ["LIN", "PTP", "CIRC"].iter().find_map(|w| line.find(&format!(" {w} ")).map(|at| &line[at + 1..]));
        let at_end = flat.starts_with("TRIGGERWHEN") && !flat.contains("DISTANCE=0");
        if let Some(form) = form.filter(|_| starts(["ARCON", "ARCOFF"])) {
            self.statement(form, number, source, 0)?;
        } else if at_end || flat.contains("BEFOREMOVE") {
            self.later = Some(lit);
            return Ok(true);
        }
        self.trace.set_arc(lit, number);
        if let Some((output, on)) = output(flat) {
            self.switch(output, on, line, number);
            let place = self.trace.place(number);
            self.trace.watch.switch(lit, &mut self.trace.faults, place);
            if lit {
                self.lit_with.extend(&self.outputs);
            }
        } else if !self.forms && lit {
            self.forms = true;
        }
        Ok(true)
    }

    /// Records that an output is switched.
    fn switch(&mut self, output: u32, on: bool, line: &str, number: usize) {
        if on {
            self.outputs.insert(output);
            self.trace.see(line);
        } else {
            self.outputs.remove(&output);
        }
        let flat = compact(line);
        if self.forms && (self.on.matches(&flat) || self.off.matches(&flat)) {
            let place = Some(self.trace.place(number));
            let text = format!("$OUT[{output}] is switched alongside the forms of ArcTech.");
            self.trace.faults.add(&TWO_SWITCHES, place, text);
        }
    }

    /// `DECL 11 WHEN $IN[1]==FALSE DO LOST( )`, `ON 11` or `OFF 11`.
    fn interrupt(&mut self, rest: &str, line: usize) {
        let (word, rest) = name(rest);
        let (number, condition) = name(rest);
        let Ok(number) = number.parse::<u32>() else { return };
        let of_arc = self.interrupts.get(&number).is_some_and(|condition| condition.contains("$IN["));
        if word.eq_ignore_ascii_case("DECL") {
            let flat = compact(condition);
            let when = flat.strip_prefix("WHEN").and_then(|when| when.split_once("DO")).map(|(when, _)| when);
            self.interrupts.extend(when.map(|when| (number, when.to_owned())));
        } else if of_arc && word.eq_ignore_ascii_case("ON") {
            self.trace.watch.arm();
        } else if of_arc && word.eq_ignore_ascii_case("OFF") {
            let place = self.trace.place(line);
            self.trace.watch.disarm(&format!("INTERRUPT OFF {number}"), &mut self.trace.faults, place);
        }
    }

    fn set_speed(&mut self, text: &str, number: usize) -> Result<(), ReadError> {
        self.speed = match (words::number(text), self.weld_speed) {
            (Some(speed), _) => speed * 1000.0,
            (None, Some(speed)) if text.starts_with("GARC") => speed,
            _ => {
                self.trace.note("a speed", "is not set to a plain number and was read as unknown", number);
                0.0
            }
        };
        Ok(())
    }

    fn call(&mut self, called: &str, rest: &str, line: usize, source: usize, depth: usize) -> Result<(), ReadError> {
        self.trace.call(called, depth, line)?;
        let find = |s: &Source| s.programs.iter().find(|p| p.0.eq_ignore_ascii_case(called)).map(|p| (p.1, p.2));
        // Programs of the main module may be global.
        for near in [source, 0] {
            if let Some(start) = find(&self.sources[near]) {
                return self.run(near, start, depth + 1);
            }
        }
        let loaded = |s: &Source| s.module.as_deref().is_some_and(|m| m.eq_ignore_ascii_case(called));
        let target = match self.sources.iter().position(loaded) {
            Some(loaded) => loaded,
            None => match (self.module)(called) {
                Some(text) => self.load(Some(called), text.into())?,
                // Calls with arguments are mostly those of a technology package.
                None if compact(rest) != "()" => {
                    self.trace.note(called, "is called with arguments, was not found and was left out", line);
                    return Ok(());
                }
                None => {
                    return Err(ReadError::MissingModule { place: self.trace.place(line), name: called.to_owned() });
                }
            },
        };
        let found = &self.sources[target];
        let start = find(found).or(found.programs.first().map(|p| (p.1, p.2)));
        self.run(target, start.unwrap_or((0, 1)), depth + 1)
    }
}

/// Where a block begins or ends.
fn mark(line: &str) -> Option<Mark> {
    let is = |word: &str| strip_word(line, word).is_some();
    let of = |(begin, end): &(&str, &str)| is(begin).then_some(Mark::Begin).or_else(|| is(end).then_some(Mark::End));
    BLOCKS.iter().find_map(of).or_else(|| is("ELSE").then_some(Mark::Else))
}

/// Number and state of an output that a compact statement switches.
pub(super) fn output(flat: &str) -> Option<(u32, bool)> {
    let (number, value) = flat.strip_prefix("$OUT[")?.split_once("]=")?;
    Some((number.parse().ok()?, value == "TRUE"))
}

/// The name in a line `DEF NAME( )` or `GLOBAL DEF ..`.
pub(super) fn is_head(line: &str) -> Option<&str> {
    let line = strip_word(line, "GLOBAL").unwrap_or(line);
    let rest = strip_word(line, "DEF").or_else(|| strip_word(line, "DEFFCT"))?;
    // A function has a type before its name.
    Some(rest.split('(').next().unwrap_or(rest).split_whitespace().next_back().unwrap_or_default())
}

/// Programs of a module: name, byte after the head, number of the next line.
fn programs(text: &str) -> Vec<(String, usize, usize)> {
    let mut found = Vec::new();
    let mut byte = 0;
    for (i, line) in text.split_inclusive('\n').enumerate() {
        byte += line.len();
        found.extend(is_head(line.trim()).map(|name| (name.to_ascii_uppercase(), byte, i + 2)));
    }
    found
}

/// The value of `BAS(#VEL_CP,..)` or `BAS(#CP_PARAMS,..)` in a compact statement.
fn bas_speed(flat: &str) -> Option<&str> {
    let value = flat.strip_prefix("BAS(#VEL_CP,").or_else(|| flat.strip_prefix("BAS(#CP_PARAMS,"))?;
    Some(value.trim_end_matches(')'))
}
