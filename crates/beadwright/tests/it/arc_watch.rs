//! What happens when the arc does not start, goes out, or the program is stopped: the lines of the programs that watch it are
//! run here, one language at a time, and `docs/dialects.md` says in its table what they did.
//! `BEADWRIGHT_GOLDEN=write cargo test -p beadwright --test it arc_watch::` writes the table anew.

use crate::common;

use beadwright::dialect;
use beadwright::dialect::krl::KrlArc;
use beadwright::dialect::rapid::RapidArc;
use beadwright::layer::Layer;
use beadwright::pass::{Along, Pass, PassKind};
use beadwright::profile::Profile;
use common::{docs, profile, with_all_dialects};
use glam::DVec3;
use std::collections::BTreeMap;
use std::iter::Peekable;

/// A step of the lines that watch the arc.
#[derive(Debug, Clone, PartialEq)]
enum Step {
    /// Something is switched: "gas", "arc" or "wire".
    Set(&'static str, bool),
    /// s
    Wait(f64),
    /// Waits until the arc burns, for that many seconds at most; whether that was too long is kept in a variable.
    WaitForArc(f64, String),
    /// A variable takes the value of an expression.
    Let(String, String),
    If(String),
    While(String),
    Else,
    End,
    Call(String),
    /// The program stops until the operator lets it go on.
    Halt,
    /// The program ends.
    Quit,
    /// The robot goes on along its path.
    Go,
    Nothing,
}

/// What is done with the steps between an opening and its end.
#[derive(Debug, Clone)]
enum Node {
    One(Step),
    If(String, Vec<Node>, Vec<Node>),
    While(String, Vec<Node>),
}

/// Steps as a tree.
fn tree(steps: &mut Peekable<impl Iterator<Item = Step>>) -> Vec<Node> {
    let mut out = Vec::new();
    while let Some(step) = steps.next_if(|step| !matches!(step, Step::End | Step::Else)) {
        out.push(match step {
            Step::If(when) => {
                let then = tree(steps);
                let otherwise = steps.next_if_eq(&Step::Else).map(|_| tree(steps)).unwrap_or_default();
                assert_eq!(steps.next(), Some(Step::End));
                Node::If(when, then, otherwise)
            }
            Step::While(when) => {
                let body = tree(steps);
                assert_eq!(steps.next(), Some(Step::End));
                Node::While(when, body)
            }
            step => Node::One(step),
        });
    }
    out
}

/// How a language writes what a program does when the arc is watched.
struct Language {
    /// A line as a step; `None` where it does not know the line.
    step: fn(&str) -> Option<Step>,
    /// The name of the routine that begins with a line.
    head: fn(&str) -> Option<String>,
    /// Whether a line ends a routine; the lines of URScript end in pairs.
    ends: fn(&str, depth: usize) -> bool,
    /// How the input that says that the arc burns is written in expressions.
    input: &'static str,
}

/// Whether two values compare as a sign says.
type Compares = fn(f64, f64) -> bool;

/// What was switched when, in order, and where the program was.
#[derive(Debug, Clone, PartialEq)]
enum Event {
    Set(f64, &'static str, bool),
    Halt(f64),
    Quit(f64),
    Go(f64),
}

/// A controller that runs the lines.
struct Controller<'a> {
    language: &'a Language,
    routines: &'a BTreeMap<String, Vec<String>>,
    values: BTreeMap<String, f64>,
    on: BTreeMap<&'static str, bool>,
    /// Whether the arc burns where it is switched on; true from the first time that the operator goes on.
    burns: bool,
    seconds: f64,
    events: Vec<Event>,
    quit: bool,
    /// Steps that were made, and before which of them the program is stopped, which ends arc and gas.
    steps: usize,
    stopped: Option<usize>,
}

impl<'a> Controller<'a> {
    fn new(language: &'a Language, routines: &'a BTreeMap<String, Vec<String>>, on: bool) -> Self {
        let on = ["gas", "arc"].map(|what| (what, on)).into();
        let (values, events) = (BTreeMap::new(), Vec::new());
        let (burns, seconds, quit, steps, stopped) = (false, 0.0, false, 0, None);
        Self { language, routines, values, on, burns, seconds, events, quit, steps, stopped }
    }

    fn burning(&self) -> bool {
        self.burns && self.on["arc"]
    }

    fn run_lines<'b>(&mut self, lines: impl IntoIterator<Item = &'b str>) {
        let step = |line: &str| (self.language.step)(line).unwrap_or_else(|| panic!("what does {line:?} do?"));
        let mut steps = lines.into_iter().map(str::trim).filter(|line| !line.is_empty()).map(step).peekable();
        let nodes = tree(&mut steps);
        assert_eq!(steps.next(), None, "a block ends that never began");
        self.run(&nodes);
    }

    fn call(&mut self, name: &str) {
        let routine =
            self.routines.get(name).unwrap_or_else(|| panic!("no routine {name:?} in {:?}", self.routines.keys()));
        self.run_lines(routine.iter().map(String::as_str));
    }

    fn run(&mut self, nodes: &[Node]) {
        for node in nodes {
            if self.quit {
                return;
            }
            match node {
                Node::One(step) => self.step(step),
                Node::If(when, then, otherwise) => {
                    let taken = if self.value(when) == 0.0 { otherwise } else { then };
                    self.run(taken);
                }
                Node::While(when, body) => {
                    while self.value(when) != 0.0 && !self.quit {
                        self.run(body);
                        assert!(self.seconds < 1000.0, "waits for ever: {:?}", self.events);
                    }
                }
            }
        }
    }

    fn step(&mut self, step: &Step) {
        if self.stopped == Some(self.steps) {
            self.on.values_mut().for_each(|on| *on = false);
        }
        self.steps += 1;
        match step {
            Step::Set(what, on) => {
                self.on.insert(what, *on);
                self.events.push(Event::Set(self.seconds, what, *on));
            }
            Step::Wait(seconds) => self.seconds += seconds,
            Step::WaitForArc(limit, late) => {
                self.seconds += if self.burning() { 0.0 } else { *limit };
                self.values.insert(late.clone(), f64::from(u8::from(!self.burning())));
            }
            Step::Let(variable, expression) => {
                let value = self.value(expression);
                self.values.insert(variable.clone(), value);
            }
            Step::Call(name) => self.call(name),
            Step::Halt => {
                self.events.push(Event::Halt(self.seconds));
                let left: Vec<&&str> = self.on.iter().filter(|(_, on)| **on).map(|(what, _)| what).collect();
                assert!(left.is_empty(), "halts with {left:?} on");
                self.burns = true;
            }
            Step::Quit => {
                self.events.push(Event::Quit(self.seconds));
                self.quit = true;
            }
            Step::Go => {
                assert!(self.burning(), "leaves without an arc: {:?}", self.events);
                self.events.push(Event::Go(self.seconds));
            }
            Step::Nothing => {}
            Step::If(_) | Step::While(_) | Step::Else | Step::End => unreachable!(),
        }
    }

    /// The value of an expression; truth is 1.
    fn value(&self, expression: &str) -> f64 {
        let text = expression.trim();
        let truth = |holds: bool| f64::from(u8::from(holds));
        for (word, all) in [(" OR ", false), (" or ", false), (" AND ", true), (" and ", true)] {
            if let Some((a, b)) = outside(text, word) {
                let (a, b) = (self.value(a) != 0.0, self.value(b) != 0.0);
                return truth(if all { a && b } else { a || b });
            }
        }
        if let Some(rest) = text.strip_prefix("NOT ").or_else(|| text.strip_prefix("not ")) {
            return truth(self.value(rest) == 0.0);
        }
        if let Some(inner) = text.strip_prefix('(').and_then(|text| text.strip_suffix(')')) {
            return self.value(inner);
        }
        let compare: [(&str, Compares); 5] = [
            (">=", |a, b| a >= b),
            ("==", |a, b| a == b),
            (">", |a, b| a > b),
            ("<", |a, b| a < b),
            ("=", |a, b| a == b),
        ];
        for (sign, holds) in compare {
            if let Some((a, b)) = text.split_once(sign) {
                return truth(holds(self.value(a), self.value(b)));
            }
        }
        if let Some((a, b)) = text.split_once('+') {
            return self.value(a) + self.value(b);
        }
        match text {
            _ if text == self.language.input => truth(self.burning()),
            "TRUE" | "True" => 1.0,
            "FALSE" | "False" => 0.0,
            "$OUT[1]" | "DOutput(doGas)" | "get_standard_digital_out(0)" => truth(self.on["gas"]),
            "$OUT[2]" => truth(self.on["arc"]),
            _ => text.parse().unwrap_or_else(|_| self.values.get(text).copied().unwrap_or_else(|| panic!("{text:?}?"))),
        }
    }
}

/// The text before and after a word that is not in brackets.
fn outside<'a>(text: &'a str, word: &str) -> Option<(&'a str, &'a str)> {
    let depth = |at: usize| text[..at].matches('(').count() - text[..at].matches(')').count();
    let (at, _) = text.match_indices(word).find(|(at, _)| depth(*at) == 0)?;
    Some((&text[..at], &text[at + word.len()..]))
}

/// The word between an opening and what follows.
fn between<'a>(line: &'a str, before: &str, after: &str) -> Option<&'a str> {
    line.strip_prefix(before)?.split_once(after).map(|(word, _)| word.trim())
}

fn seconds(text: &str) -> Option<Step> {
    text.trim().parse().ok().map(Step::Wait)
}

const KRL: Language = Language {
    step: |line| {
        if let Some((output, state)) = line.strip_prefix("$OUT[").and_then(|rest| rest.split_once("] = ")) {
            return Some(Step::Set(if output == "1" { "gas" } else { "arc" }, state == "TRUE"));
        }
        if let Some((variable, value)) = line.split_once(" = ") {
            return Some(Step::Let(variable.to_owned(), value.to_owned()));
        }
        if let Some(when) = between(line, "IF ", " THEN") {
            return Some(Step::If(when.to_owned()));
        }
        Some(match line {
            "ENDIF" | "ENDWHILE" => Step::End,
            "ELSE" => Step::Else,
            "HALT" => Step::Halt,
            "WAIT FOR NOT $IN[1]" => Step::Nothing,
            _ if line.starts_with("WAIT SEC ") => return seconds(&line[9..]),
            _ if line.starts_with("WHILE ") => Step::While(line[6..].to_owned()),
            _ if line.starts_with("INTERRUPT O") || line.starts_with("DECL INT ") || line == "BRAKE" => Step::Nothing,
            _ => Step::Call(line.strip_suffix("( )")?.to_owned()),
        })
    },
    head: |line| {
        let line = line.strip_prefix("GLOBAL ").unwrap_or(line);
        line.strip_prefix("DEF ")?.strip_suffix("( )").map(str::to_owned)
    },
    ends: |line, _| line == "END",
    input: "$IN[1]",
};

const RAPID: Language = Language {
    step: |line| {
        let line = line.trim_end_matches(';');
        if let Some((output, state)) = line.strip_prefix("SetDO ").and_then(|rest| rest.split_once(',')) {
            return Some(Step::Set(if output == "doGas" { "gas" } else { "arc" }, state == "1"));
        }
        if let Some((limit, late)) =
            line.strip_prefix("WaitDI diArc,1\\MaxTime:=").and_then(|rest| rest.split_once("\\TimeFlag:="))
        {
            return Some(Step::WaitForArc(limit.parse().ok()?, late.to_owned()));
        }
        let plain = ["TPWrite ", "ISignalDI ", "CONNECT ", "IDelete "];
        let variable = line.strip_prefix("VAR num ").or_else(|| line.strip_prefix("VAR bool "));
        Some(match line {
            "ENDIF" | "ENDWHILE" => Step::End,
            "ELSE" => Step::Else,
            "Stop" => Step::Halt,
            "StartMove" => Step::Go,
            "StopMove" | "WaitDI diArc,0" => Step::Nothing,
            _ if line.starts_with("WaitTime ") => return seconds(line[9..].trim_start_matches("\\InPos,")),
            _ if line.starts_with("IF ") => Step::If(line[3..].trim_end_matches(" THEN").to_owned()),
            _ if line.starts_with("WHILE ") => Step::While(line[6..].trim_end_matches(" DO").to_owned()),
            _ if plain.iter().any(|word| line.starts_with(word)) => Step::Nothing,
            _ => match variable.unwrap_or(line).split_once(":=") {
                Some((variable, value)) => Step::Let(variable.to_owned(), value.to_owned()),
                None => Step::Call(line.to_owned()),
            },
        })
    },
    head: |line| between(line, "PROC ", "()").or_else(|| line.strip_prefix("TRAP ")).map(str::to_owned),
    ends: |line, _| line == "ENDPROC" || line == "ENDTRAP",
    input: "diArc",
};

const URSCRIPT: Language = Language {
    step: |line| {
        if let Some(rest) = line.strip_prefix("set_standard_digital_out(") {
            let (output, state) = rest.trim_end_matches(')').split_once(", ")?;
            return Some(Step::Set(if output == "0" { "gas" } else { "arc" }, state == "True"));
        }
        Some(match line {
            "end" => Step::End,
            "halt" => Step::Quit,
            "sync()" => Step::Wait(0.002),
            _ if line.starts_with("popup(") && line.ends_with("blocking=True)") => Step::Halt,
            _ if line.starts_with("sleep(") => return seconds(between(line, "sleep(", ")")?),
            _ if line.starts_with("while ") => Step::While(line[6..].trim_end_matches(':').to_owned()),
            _ if line.starts_with("if ") => Step::If(line[3..].trim_end_matches(':').to_owned()),
            _ => match line.split_once(" = ") {
                Some((_, value)) if value.starts_with("run ") => Step::Nothing,
                Some((variable, value)) => Step::Let(variable.to_owned(), value.to_owned()),
                None => Step::Call(line.strip_suffix("()")?.to_owned()),
            },
        })
    },
    head: |line| {
        let line = line.strip_prefix("def ").or_else(|| line.strip_prefix("thread "))?;
        line.strip_suffix("():").map(str::to_owned)
    },
    ends: |line, depth| line == "end" && depth == 0,
    input: "get_standard_digital_in(0)",
};

const LINUXCNC: Language = Language {
    step: |line| {
        let line = line.split_once(' ').filter(|(word, _)| word.starts_with('N')).map_or(line, |(_, rest)| rest);
        // M66 leaves a number below 0 where it waited too long.
        let expression = |text: &str| {
            let text = text.replace("#5399 LT 0", "late GE 1").replace(['[', ']', '#', '<', '>'], "");
            text.replace(" GE ", ">=").trim().to_owned()
        };
        if let Some((variable, value)) = line.strip_prefix('#').and_then(|rest| rest.split_once(" = ")) {
            return Some(Step::Let(expression(variable), expression(value)));
        }
        if let Some((word, when)) = line.strip_prefix('O').and_then(|rest| rest.split_once(' ')).map(|(_, rest)| {
            let (word, when) = rest.split_once(' ').unwrap_or((rest, ""));
            (word, expression(when))
        }) {
            return Some(match word {
                "while" => Step::While(when),
                "if" => Step::If(when),
                _ => Step::End,
            });
        }
        Some(match line {
            "M64 P0" => Step::Set("gas", true),
            "M65 P0" => Step::Set("gas", false),
            "M64 P1" => Step::Set("wire", true),
            "M65 P1" => Step::Set("wire", false),
            "M3 S1" => Step::Set("arc", true),
            "M5" => Step::Set("arc", false),
            "M0" => Step::Halt,
            _ if line.starts_with("(MSG, ") || line.starts_with("M66 P0 L4 ") => {
                Step::Let("late".to_owned(), "0".to_owned())
            }
            _ if line.starts_with("G4 P") => return seconds(&line[4..]),
            _ => {
                let (input, limit) = line.strip_prefix("M66 P")?.split_once(" L3 Q")?;
                assert_eq!(input, "0");
                Step::WaitForArc(limit.parse().ok()?, "late".to_owned())
            }
        })
    },
    head: |_| None,
    ends: |_, _| false,
    input: "burns",
};

type Files = BTreeMap<String, String>;

fn written(post: &str, profile: &Profile) -> Files {
    let z = 2.0;
    let points = vec![DVec3::new(0.0, 0.0, z), DVec3::new(60.0, 0.0, z)];
    let (width, pace) = (Along::Same(4.5), Along::Same(8.0));
    let pass = Pass { kind: PassKind::Contour, closed: false, points, width, pace, wait: 0.0 };
    let layer = Layer { index: 0, z, height: z, passes: vec![pass], ..Layer::default() };
    let files = dialect::write(post, &[layer], &profile.job("demo")).unwrap();
    files.into_iter().map(|(name, text)| (name, text.replace("\r\n", "\n"))).collect()
}

/// The routines of a program, by their names.
fn routines(language: &Language, files: &Files) -> BTreeMap<String, Vec<String>> {
    let mut all = BTreeMap::new();
    for text in files.values() {
        let mut lines = text.lines().map(str::trim).peekable();
        while let Some(line) = lines.next() {
            // The program itself surrounds the routines of URScript.
            if line == "def demo():" {
                continue;
            }
            let Some(name) = (language.head)(line) else { continue };
            let (mut body, mut depth) = (Vec::new(), 0_usize);
            for line in lines.by_ref() {
                if (language.ends)(line, depth) {
                    break;
                }
                depth += usize::from(line.ends_with(':'));
                depth -= usize::from(line == "end");
                body.push(line.to_owned());
            }
            all.insert(name, body);
        }
    }
    all
}

/// The lines between the beginning of the pass and its first move.
fn start_of_pass(files: &Files, moves: &[&str]) -> Vec<String> {
    let text = files.values().find(|text| text.to_lowercase().contains("pass 1 contour")).unwrap();
    let lines = text.lines().map(str::trim).skip_while(|line| !line.to_lowercase().contains("pass 1 contour")).skip(1);
    let moves = |line: &str| moves.iter().any(|word| line.starts_with(word) || line.contains(&format!(" {word}")));
    lines.take_while(|line| !moves(line)).map(str::to_owned).collect()
}

/// What a line of a program says between two texts.
fn found(files: &Files, before: &str, after: &str) -> String {
    let hit = files.values().flat_map(|text| text.lines()).find_map(|line| line.trim().split_once(before));
    let rest = hit.unwrap_or_else(|| panic!("no line with {before:?}")).1;
    rest.split_once(after).map_or(rest, |(found, _)| found).to_owned()
}

/// "0.5 s"
fn s(seconds: f64) -> String {
    format!("{} s", (seconds * 10.0).round() / 10.0)
}

/// What was switched off and when, from the last time that the arc was ended to the halt.
fn given_up(events: &[Event]) -> String {
    let stop = events.iter().position(|event| matches!(event, Event::Halt(_) | Event::Quit(_))).unwrap();
    let off = |what: &str| {
        events[..stop].iter().rev().find_map(|event| match event {
            Event::Set(at, name, false) if *name == what => Some(*at),
            _ => None,
        })
    };
    let (arc, gas) = (off("arc").expect("the arc goes off"), off("gas").expect("gas goes off"));
    let end = if matches!(events[stop], Event::Halt(_)) { "the program halts" } else { "the program ends" };
    let gas = if gas - arc < 0.05 {
        "arc and gas off".to_owned()
    } else {
        format!("arc off, gas off {} later", s(gas - arc))
    };
    format!("{gas}, {end}")
}

/// What is done when the operator goes on.
fn struck_again(events: &[Event]) -> String {
    let on = |what: &str| {
        events.iter().find_map(|event| match event {
            Event::Set(at, name, true) if *name == what => Some(*at),
            _ => None,
        })
    };
    let (gas, arc) = (on("gas").expect("gas comes on"), on("arc").expect("the arc comes on"));
    assert!(gas < arc, "{events:?}");
    format!("start: gas, {} later the arc; the torch leaves when it burns", s(arc - gas))
}

fn after_halt(events: &[Event]) -> &[Event] {
    &events[events.iter().position(|event| matches!(event, Event::Halt(_))).unwrap() + 1..]
}

/// What the start of a pass does where the arc never burns, until the program stops; and what it does then.
fn never_burns(language: &Language, files: &Files, moves: &[&str]) -> [String; 2] {
    let routines = routines(language, files);
    let lines = start_of_pass(files, moves);
    let mut controller = Controller::new(language, &routines, false);
    controller.run_lines(lines.iter().map(String::as_str));
    assert!(controller.burning(), "the torch leaves without an arc");
    tries(&controller.events)
}

fn tries(events: &[Event]) -> [String; 2] {
    let halt = events.iter().position(|event| matches!(event, Event::Halt(_))).unwrap();
    let struck: Vec<f64> = events[..halt]
        .iter()
        .filter_map(|event| match event {
            Event::Set(at, "arc", true) => Some(*at),
            _ => None,
        })
        .collect();
    let ended: Vec<f64> = events[..halt]
        .iter()
        .filter_map(|event| match event {
            Event::Set(at, "arc", false) => Some(*at),
            _ => None,
        })
        .collect();
    assert_eq!(struck.len(), ended.len(), "{events:?}");
    let longest = struck.iter().zip(&ended).map(|(on, off)| off - on).fold(0.0, f64::max);
    let first = format!("{} tries of {} at most; {}", struck.len(), s(longest), given_up(events));
    [first, struck_again(after_halt(events))]
}

/// Wherever the program is stopped while the arc is struck, which ends arc and gas, the torch leaves with both.
fn stops_while_it_is_struck(language: &Language, files: &Files, moves: &[&str]) {
    let routines = routines(language, files);
    let lines = start_of_pass(files, moves);
    let run = |stopped: Option<usize>| {
        let mut controller = Controller::new(language, &routines, false);
        (controller.burns, controller.stopped) = (true, stopped);
        controller.run_lines(lines.iter().map(String::as_str));
        controller
    };
    let steps = run(None).steps;
    assert!(steps > 5, "{steps}");
    // UR's thread looks by itself when it is started, which is the last step.
    let looked = steps - usize::from(language.input == URSCRIPT.input);
    for stopped in 0..looked {
        let after = run(Some(stopped));
        assert!(
            after.burning() && after.on["gas"],
            "{} stopped before step {stopped} of {steps}: {:?}",
            language.input,
            after.events
        );
    }
}

/// What a routine does where the arc was lost.
fn lost(language: &Language, files: &Files, routine: &str) -> String {
    let routines = routines(language, files);
    let mut controller = Controller::new(language, &routines, true);
    controller.call(routine);
    let first = given_up(&controller.events);
    if controller.quit {
        return first;
    }
    assert!(controller.burning());
    format!("the robot stops; {first}; {}", struck_again(after_halt(&controller.events)))
}

/// A row of the table: the dialect, then what happens where the arc does not start, goes out, the program is stopped, and the
/// operator goes on after that.
type Row = (&'static str, [String; 4]);

fn krl() -> Row {
    let files = written("krl", &with_all_dialects("cmt-al2319-kuka"));
    let [never, _] = never_burns(&KRL, &files, &["LIN", "CIRC", "$VEL"]);
    let lost = lost(&KRL, &files, &found(&files, "WHEN $IN[1]==FALSE DO ", "( )"));
    // A message that stops the robot, and the STOP key.
    let routines = routines(&KRL, &files);
    let mut message = Controller::new(&KRL, &routines, true);
    message.call(&found(&files, "DECL 2 WHEN $STOPMESS==TRUE DO ", "( )"));
    assert!(!message.on["arc"] && !message.on["gas"], "{:?}", message.events);
    let page = std::fs::read_to_string(docs().join("dialects/krl.md")).unwrap();
    let (_, sps) = page.split_once("```text\n  $FLAG[1] = TRUE\n").unwrap();
    let sps: Vec<&str> = sps.split_once("```").unwrap().0.lines().collect();
    let mut key = Controller::new(&KRL, &routines, true);
    let sps = |key: &mut Controller, state: f64| {
        key.values.insert("$PRO_STATE1".to_owned(), state);
        key.run_lines(sps.iter().copied());
    };
    let words = [("#P_ACTIVE", 1.0), ("#P_STOP", 2.0), ("$ON_PATH", 1.0), ("$FLAG[2]", 0.0), ("$FLAG[3]", 0.0)];
    key.values = words.map(|(k, v)| (k.to_owned(), v)).into();
    sps(&mut key, 1.0);
    assert!(key.events.is_empty(), "{:?}", key.events);
    sps(&mut key, 2.0);
    assert!(!key.on["arc"] && !key.on["gas"] && key.values["$FLAG[2]"] == 0.0, "{:?}", key.events);
    sps(&mut key, 1.0);
    assert_eq!(key.values["$FLAG[2]"], 1.0, "flag 2 starts an interrupt");
    key.events.clear();
    key.call(&found(&files, "WHEN $FLAG[2]==TRUE DO ", "( )"));
    assert_eq!(key.values["$FLAG[2]"], 0.0);
    assert!(key.burning());
    stops_while_it_is_struck(&KRL, &files, &["LIN", "CIRC", "$VEL"]);
    let stop = "arc and gas off: by an interrupt on `$STOPMESS`, and by `SPS.SUB` for the STOP key".to_owned();
    let on = format!("the robot stops, the program halts; {}", struck_again(after_halt(&key.events)));
    ("KRL, outputs", [never, lost, stop, on])
}

fn rapid() -> Row {
    let mut profile = with_all_dialects("cmt-al2319-kuka");
    profile.dialects.rapid.as_mut().unwrap().arc = RapidArc::Plain;
    let files = written("rapid", &profile);
    let [never, _] = never_burns(&RAPID, &files, &["Move"]);
    let trap = found(&files, "CONNECT iArc WITH ", ";");
    let lost = lost(&RAPID, &files, &trap);
    assert_eq!(found(&files, "TriggStopProc rdArc\\DO1:=", ","), "doArc");
    let routines = routines(&RAPID, &files);
    let page = std::fs::read_to_string(docs().join("dialects/rapid.md")).unwrap();
    let (_, routine) = page.split_once("PROC ArcOff()\n").unwrap();
    let mut event = Controller::new(&RAPID, &routines, true);
    event.run_lines(routine.split_once("ENDPROC").unwrap().0.lines());
    assert!(!event.on["arc"] && !event.on["gas"]);
    for shelf in ["STOP", "QSTOP"] {
        assert!(page.contains(&format!("-Routine \"ArcOff\" -Shelf \"{shelf}\"")), "{shelf}");
    }
    stops_while_it_is_struck(&RAPID, &files, &["Move"]);
    // What happens to diArc during a stop is kept until the program goes on.
    assert!(found(&files, "ISignalDI \\SingleSafe,diArc,", ";").starts_with("0,iArc"));
    let stop = "arc off by `TriggStopProc`, gas by the events `STOP` and `QSTOP`".to_owned();
    ("RAPID, outputs", [never, lost, stop, "as where the arc goes out: it halts once more, then strikes it".to_owned()])
}

fn urscript() -> Row {
    let files = written("urscript", &with_all_dialects("cmt-al2319-kuka"));
    let [never, _] = never_burns(&URSCRIPT, &files, &["movel"]);
    let thread = found(&files, "= run ", "()");
    let lost = lost(&URSCRIPT, &files, &thread);
    let low = |output: u32| {
        let line = format!("set_runstate_standard_digital_output_to_value({output}, 1)");
        assert!(files.values().any(|text| text.contains(&line)), "{line}");
    };
    [0, 1].into_iter().for_each(low);
    stops_while_it_is_struck(&URSCRIPT, &files, &["movel"]);
    let stop = "arc and gas off: outputs that are low while no program runs".to_owned();
    let on = format!("the thread finds no arc: {lost}; start anew by `program.restart`");
    ("URScript", [never, lost, stop, on])
}

fn linuxcnc() -> Row {
    let files = written("gcode", &profile("plasma-304-cnc"));
    let [never, _] = never_burns(&LINUXCNC, &files, &["G1"]);
    // `benches/linuxcnc.sh` runs these lines in LinuxCNC's own HAL.
    let hal = std::fs::read_to_string(docs().join("../examples/cells/linuxcnc-arc.hal")).unwrap();
    let gas = found(&[(String::new(), hal)].into(), "setp gas-delay.off-delay ", " ");
    let off = format!("arc and wire off, gas {gas} s later");
    let lost = format!("HAL: the feed is held; {off}");
    let stop = format!("HAL, paused or aborted: {off}");
    (
        "LinuxCNC",
        [never, lost, stop, "paused: the feed stays held; abort, and begin anew by `program.restart`".to_owned()],
    )
}

/// Where the weld equipment watches the arc, programs switch no outputs beside it.
fn equipment() -> Vec<Row> {
    let mut profile = with_all_dialects("cmt-al2319-kuka");
    profile.dialects.krl.as_mut().unwrap().arc = KrlArc::Arctech;
    let own = |post: &str, light: &str, outputs: &[&str]| {
        let files = written(post, &profile);
        assert!(files.values().any(|text| text.contains(light)), "{post}: {light}");
        for output in outputs {
            assert!(!files.values().any(|text| text.contains(output)), "{post}: {output}");
        }
    };
    own("krl", "ArcMainNG(#ArcOnBeforeMoveStd", &["$OUT[", "INTERRUPT DECL 11"]);
    own("rapid", "ArcLStart", &["SetDO", "ISignalDI", "TriggStopProc"]);
    own("fanuc", "Weld Start[", &["DO[", "RO["]);
    own("inform", "ARCON ASF#(1)", &["DOUT"]);
    let row = |name, by: &str| {
        let never = format!("{by} tries again, then stops");
        let [lost, stop, on] = [
            "as its error strategy is set",
            "it should end arc and gas: watch it once",
            "as its restart is set: watch it once",
        ];
        (name, [never, lost.to_owned(), stop.to_owned(), on.to_owned()])
    };
    let plc = |name| {
        let plc = || "the PLC, as in `[safety]`".to_owned();
        (name, [plc(), plc(), plc(), "by `program.restart`".to_owned()])
    };
    vec![
        row("KRL, ArcTech", "ArcTech Basic"),
        row("RAPID", "RobotWare Arc"),
        row("FANUC", "the weld equipment of ArcTool"),
        row("INFORM", "the welder of the condition files"),
        plc("Fanuc, Siemens, TwinCAT"),
    ]
}

#[test]
fn the_table_says_what_the_programs_do() {
    let mut table =
        "| | the arc does not start | the arc goes out | the program is stopped | the operator goes on |\n".to_owned();
    table.push_str("| --- | --- | --- | --- | --- |\n");
    let watched = [krl(), rapid(), urscript(), linuxcnc()];
    for (name, cells) in watched.into_iter().chain(equipment()) {
        table.push_str(&format!("| {name} | {} |\n", cells.join(" | ")));
    }
    common::page_shows("dialects.md", "arc", &format!("{table}\n"));
}
