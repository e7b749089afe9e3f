//! Readers of programs for single CNC controls: each knows what its control takes, and refuses what it would not.
//!
//! Fanuc: series 30i (B-64484EN): `%`, O number, comments in parentheses, G4 P in ms. Siemens: Sinumerik 840D sl:
//! neither `%` nor O, comments after `;`, G4 F in s that is no feed. TwinCAT NC I (TF5100, infosys.beckhoff.com): words
//! apart by spaces, G4 X or F in s, auxiliary axes `Q1=` to `Q5=`, `#set …#` in a block of its own, M functions 0 to 159.

use super::Point;
use super::{Machine, Motion};

/// A control.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Control {
    Fanuc,
    Siemens,
    TwinCat,
}

/// What a program does, and how long it takes.
#[derive(Debug, Default)]
pub struct Run {
    pub motion: Motion,
    /// Time of the moves in feed with the arc on, s.
    pub arc_time: f64,
    /// Where the auxiliary axis of the wire ends, mm.
    pub wire: f64,
}

/// The M codes of the arc, on and off.
pub fn run(control: Control, text: &str, arc: [u32; 2]) -> Run {
    assert!(text.is_ascii() && !text.contains('\t') && !text.contains('\r'));
    let body = match control {
        Control::Fanuc => {
            let body = text.strip_prefix("%\n").and_then(|t| t.strip_suffix("%\n")).expect("no % at both ends");
            let (number, body) = body.split_once('\n').unwrap();
            let digits = number.strip_prefix('O').expect("no O number");
            assert!(digits.len() == 4 && digits.parse::<u32>().is_ok_and(|n| n > 0), "{number}");
            body
        }
        _ => text,
    };
    let mut reader = Reader {
        control,
        arc,
        machine: Machine::default(),
        axes: [None; 3],
        motion: 0,
        feed: None,
        out: Run::default(),
        ended: false,
        start: 0.0,
    };
    let lines: Vec<&str> = body.lines().collect();
    let mut at = 0;
    while at < lines.len() {
        at = match reader.jump(lines[at]) {
            Jump::No => {
                reader.line(lines[at]);
                at + 1
            }
            Jump::On => at + 1,
            Jump::To(label) => {
                let found = |line: &&str| line.split(' ').next() == Some(&label);
                at + 1 + lines[at + 1..].iter().position(found).expect("the label comes behind")
            }
        };
    }
    assert!(reader.ended, "no M30");
    assert_eq!(reader.machine.lift, 0.0, "the program ends with a shift");
    Run { motion: reader.machine.finish(), ..reader.out }
}

struct Reader {
    control: Control,
    arc: [u32; 2],
    machine: Machine,
    axes: [Option<f64>; 3],
    motion: u32,
    /// mm/min
    feed: Option<f64>,
    out: Run,
    ended: bool,
    /// Where the program begins.
    start: f64,
}

/// How a condition begins, what stands before its label, and when it holds.
type Condition = (&'static str, &'static str, fn(f64, f64) -> bool);

/// What comes after a line.
enum Jump {
    /// It is a block.
    No,
    /// It was a jump that is not taken, a label or an assignment.
    On,
    /// The line that begins with this.
    To(String),
}

/// A word: its address, with its number if it has one, and its value.
type Word<'a> = (&'a str, f64);

impl Reader {
    /// Branches in the control's own language: custom macro B, Sinumerik, and NC I's classic interpreter.
    fn jump(&mut self, line: &str) -> Jump {
        let (variable, label): (&str, fn(&str) -> String) = match self.control {
            Control::Fanuc => ("#100", |n| format!("N{n}")),
            Control::Siemens => ("R90", |n| format!("{n}:")),
            Control::TwinCat => ("R90", |n| format!("N{}", n.trim_start_matches('K'))),
        };
        if let Some(start) = line.strip_prefix(&format!("{variable}=")) {
            self.start = start.parse().unwrap();
            return Jump::On;
        }
        let conditions: [Condition; 2] = match self.control {
            Control::Fanuc => [("IF[#100GT", "]GOTO", |a, b| a > b), ("IF[#100EQ", "]GOTO", |a, b| a == b)],
            Control::Siemens => [("IF R90>", " GOTOF ", |a, b| a > b), ("IF R90==", " GOTOF ", |a, b| a == b)],
            Control::TwinCat => [("@126 R90 K", " ", |a, b| a > b), ("@122 R90 K", " ", |a, b| a == b)],
        };
        for (head, between, holds) in conditions {
            if let Some((bound, to)) = line.strip_prefix(head).and_then(|rest| rest.split_once(between)) {
                let taken = holds(self.start, bound.parse().unwrap());
                return if taken { Jump::To(label(to)) } else { Jump::On };
            }
        }
        let always = match self.control {
            Control::Fanuc => "GOTO",
            Control::Siemens => "GOTOF ",
            Control::TwinCat => "@100 ",
        };
        if let Some(to) = line.strip_prefix(always) {
            return Jump::To(label(to));
        }
        let digits = |text: &str| !text.is_empty() && text.bytes().all(|b| b.is_ascii_digit());
        let is_label = match self.control {
            Control::Fanuc => line.strip_prefix('N').is_some_and(digits),
            Control::Siemens => line.strip_prefix("LB").and_then(|l| l.strip_suffix(':')).is_some_and(digits),
            Control::TwinCat => line.strip_suffix(" G90").and_then(|l| l.strip_prefix('N')).is_some_and(digits),
        };
        if is_label { Jump::On } else { Jump::No }
    }

    /// Heights that are added to what follows, in a block of its own.
    fn lift(&mut self, line: &str) -> bool {
        let block = match line.split_once(' ') {
            Some((number, block)) if number.starts_with('N') => block,
            _ => line,
        };
        let head = match self.control {
            Control::Fanuc => "G52 X0.0 Y0.0 Z",
            Control::Siemens => "TRANS Z",
            Control::TwinCat => "G58 X0.0 Y0.0 Z",
        };
        let height = block.strip_prefix(head).map(|height| height.parse().unwrap());
        height.into_iter().for_each(|height| self.machine.lift = height);
        height.is_some()
    }

    fn line(&mut self, line: &str) {
        assert!(!line.is_empty() && !self.ended, "after M30 or empty: {line:?}");
        let comment = match self.control {
            Control::Siemens => line.starts_with("; "),
            _ => line.starts_with('(') && line.ends_with(')') && line.matches(['(', ')']).count() == 2,
        };
        let setting = line.strip_prefix("#set ").and_then(|rest| rest.strip_suffix('#'));
        if let Some(setting) = setting.filter(|_| self.control == Control::TwinCat) {
            assert!(
                setting.starts_with("paramVertexSmoothing(")
                    && setting.ends_with(')')
                    && setting.matches(';').count() == 2
            );
            return;
        }
        if comment {
            return;
        }
        if self.lift(line) {
            return;
        }
        assert!(!line.contains(['(', ';', '%', '#']), "{line}");
        let words: Vec<Word> = line.split(' ').map(|text| word(self.control, text)).collect();
        let words = if words[0].0 == "N" { &words[1..] } else { &words[..] };
        let mut letters: Vec<&str> = words.iter().map(|w| w.0).filter(|l| *l != "G").collect();
        letters.sort_unstable();
        assert!(letters.windows(2).all(|pair| pair[0] != pair[1]), "an address twice: {line}");
        match words {
            [("G", 4.0), time] => self.dwell(*time, line),
            [("M", code)] => self.switch(*code as u32),
            _ if letters.contains(&"M") || words.contains(&("G", 4.0)) => panic!("not alone: {line}"),
            _ => self.moves(words, line),
        }
    }

    fn dwell(&mut self, (address, time): Word, line: &str) {
        let seconds = match (self.control, address) {
            (Control::Fanuc, "P") if time.fract() == 0.0 => time / 1000.0,
            (Control::Fanuc, "X") | (Control::Siemens, "F") | (Control::TwinCat, "F" | "X") => time,
            _ => panic!("a dwell that {:?} does not know: {line}", self.control),
        };
        self.machine.wait(seconds);
    }

    fn switch(&mut self, code: u32) {
        assert!(code < 160, "M{code}");
        match code {
            _ if code == self.arc[0] => self.machine.arc_on(),
            _ if code == self.arc[1] => self.machine.arc_off(),
            30 => self.ended = true,
            _ => assert!(code > 2, "M{code} stops the program"),
        }
    }

    fn moves(&mut self, words: &[Word], line: &str) {
        let (mut moves, mut centre, mut wire) = (false, [None; 2], None);
        for &(address, value) in words {
            match address {
                "G" => self.code(value, line),
                "F" => self.feed = Some(value).filter(|f| *f > 0.0),
                "I" => centre[0] = Some(value),
                "J" => centre[1] = Some(value),
                "Q1=" => wire = Some(value),
                "X" | "Y" | "Z" => {
                    self.axes["XYZ".find(address).unwrap()] = Some(value);
                    moves = true;
                }
                _ => panic!("{address} in {line}"),
            }
        }
        let speed = if self.motion == 0 { f64::INFINITY } else { self.feed.expect("no F") / 60.0 };
        if let Some(wire) = wire {
            assert!(self.machine.burns() && wire > self.out.wire, "{line}");
            // Without a path the feed is that of the auxiliary axis.
            if !moves {
                self.out.arc_time += (wire - self.out.wire) / speed;
            }
            self.out.wire = wire;
        }
        let [Some(x), Some(y), Some(z)] = self.axes else { return };
        if moves {
            self.go([x, y, z], centre, speed, line);
        }
    }

    fn code(&mut self, code: f64, line: &str) {
        let known: &[f64] = match self.control {
            Control::Fanuc => &[17.0, 21.0, 40.0, 49.0, 54.0, 64.0, 80.0, 90.0, 94.0],
            Control::Siemens => &[17.0, 40.0, 54.0, 64.0, 90.0, 94.0, 710.0],
            Control::TwinCat => &[17.0, 40.0, 54.0, 71.0, 90.0],
        };
        match code {
            0.0..=3.0 => self.motion = code as u32,
            _ => assert!(known.contains(&code), "G{code}: {line}"),
        }
    }

    fn go(&mut self, to: Point, centre: [Option<f64>; 2], speed: f64, line: &str) {
        assert!(self.motion > 0 || !self.machine.burns(), "G0 with the arc on: {line}");
        assert!(self.motion == 0 || self.machine.burns(), "a feed move without arc: {line}");
        let from = self.machine.at;
        match (self.motion, centre) {
            (2 | 3, [Some(i), Some(j)]) => {
                self.machine.turn_about([i, j], self.motion == 3, to, speed);
                let radius = i.hypot(j);
                let (a, b) = (from.unwrap(), to);
                let angle = |p: Point| (p[1] - a[1] - j).atan2(p[0] - a[0] - i);
                self.out.arc_time += radius * super::angle_between(angle(a), angle(b)).abs() / speed;
            }
            (0 | 1, [None, None]) => {
                self.machine.move_to(to, speed);
                if self.motion == 1 {
                    self.out.arc_time += super::distance(from.unwrap(), to) / speed;
                }
            }
            _ => panic!("{line}"),
        }
    }
}

fn word(control: Control, text: &str) -> Word<'_> {
    let (address, value) = match text.split_once('=') {
        Some((index, value)) => {
            let axis = index.strip_prefix('Q').and_then(|n| n.parse::<u32>().ok());
            assert!(control == Control::TwinCat && axis.is_some_and(|n| (1..=5).contains(&n)), "{text}");
            (&text[..=index.len()], value)
        }
        None => text.split_at(1),
    };
    assert!(address.starts_with(|c: char| c.is_ascii_uppercase()) && !value.contains(['e', 'E', '+']), "{text}");
    let value: f64 = value.parse().unwrap_or_else(|_| panic!("{text} is no word"));
    assert!(
        !(control == Control::Fanuc && "XYZIJ".contains(address)) || text.contains('.'),
        "{text}: no decimal point"
    );
    (address, value)
}
