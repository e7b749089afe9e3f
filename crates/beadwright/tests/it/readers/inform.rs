//! A reader of INFORM jobs: runs `main` and what it calls, and checks heads, counts and positions.

use super::{Machine, Motion, Stand, distance, euler};
use std::collections::BTreeMap;

/// Runs the job of that name (file names as keys).
pub fn run(files: &BTreeMap<String, String>, main: &str) -> Motion {
    let machine = Machine::default();
    let mut reader = Reader { files, machine, exact: true, arc_ended: false, homes: 0, start: 0.0, shift: 0.0 };
    reader.job(main);
    assert_eq!(reader.homes, 2);
    reader.machine.finish()
}

struct Reader<'a> {
    files: &'a BTreeMap<String, String>,
    machine: Machine,
    exact: bool,
    /// Whether the last move was along an arc.
    arc_ended: bool,
    homes: usize,
    /// Where the program begins.
    start: f64,
    /// Height in the position variable of the shift, mm.
    shift: f64,
}

impl Reader<'_> {
    fn job(&mut self, name: &str) {
        assert!(name.len() <= 32 && !name.is_empty());
        assert!(name.bytes().all(|b| b.is_ascii_uppercase() || b.is_ascii_digit() || b"_-".contains(&b)), "{name}");
        let text = &self.files[&format!("{name}.jbi")];
        assert!(text.is_ascii() && !text.contains('\t'));
        assert_eq!(text.matches('\n').count(), text.matches("\r\n").count(), "{name} mixes line ends");
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines[..3], ["/JOB", &format!("//NAME {name}"), "//POS"]);
        let positions: Vec<&str> = lines.iter().filter(|l| l.starts_with('C') && l.contains('=')).copied().collect();
        let positions: Vec<&str> =
            positions.into_iter().filter(|l| l[1..6].bytes().all(|b| b.is_ascii_digit())).collect();
        assert_eq!(lines[3], format!("///NPOS {},0,0,0,0,0", positions.len()));
        let comment = lines.iter().find_map(|l| l.strip_prefix("///COMM ")).unwrap();
        assert!(comment.len() <= 32);
        let relative = lines.contains(&"///RECTAN");
        assert_eq!(relative, lines.contains(&"///ATTR SC,RW,RJ"));
        assert!(!relative || (lines.contains(&"///USER 1") && lines.contains(&"////FRAME USER 1")));
        let begin = lines.iter().position(|l| *l == "NOP").unwrap();
        assert_eq!(lines.last(), Some(&"END"));
        assert!(lines.len() - begin < 9999);
        let (mut used, mut circle, mut at) = (0, Vec::new(), begin + 1);
        while at < lines.len() - 1 {
            at = match self.jump(lines[at]) {
                Some(label) => at + lines[at..].iter().position(|line| *line == label).expect("the label comes behind"),
                None => {
                    self.instruction(lines[at], &positions, &mut used, &mut circle);
                    at + 1
                }
            };
        }
        assert_eq!(self.machine.lift, 0.0, "{name} ends with a shift");
        assert!(circle.is_empty(), "{name} ends within an arc");
        assert!(used == positions.len() || text.contains("JUMP "), "{name}: positions that nothing uses");
    }

    /// The label to which a line jumps: conditions on the variable that says where to begin.
    fn jump(&self, line: &str) -> Option<String> {
        let jump = line.strip_prefix("JUMP ")?;
        let Some((label, condition)) = jump.split_once(" IF D090") else { return Some(jump.to_owned()) };
        let (sign, bound) = condition.split_at(1);
        let bound: f64 = bound.parse().unwrap();
        let taken = if sign == ">" { self.start > bound } else { self.start == bound };
        taken.then(|| label.to_owned())
    }

    fn instruction(&mut self, line: &str, positions: &[&str], used: &mut usize, circle: &mut Vec<Stand>) {
        let words: Vec<&str> = line.split_whitespace().collect();
        if words[0].starts_with("MOV") {
            // Those of branches that are not taken are passed over.
            let number: usize = words[1].strip_prefix('C').unwrap().parse().unwrap();
            assert!(number >= *used, "{line}");
            let numbers = positions[number].strip_prefix(&format!("C{number:05}=")).unwrap();
            *used = number + 1;
            let numbers: Vec<f64> = numbers.split(',').map(|v| v.parse().unwrap()).collect();
            assert_eq!(numbers.len(), 6);
            let tool = euler(numbers[5], numbers[4], numbers[3]);
            let to = Stand { at: [numbers[0], numbers[1], numbers[2]], tool, axes: [None; 2] };
            if words[0] == "MOVJ" {
                assert!(words[2].starts_with("VJ=") && !self.machine.burns());
                match words.get(3) {
                    Some(level) => {
                        assert_eq!(*level, "PL=0");
                        self.machine.approach(to);
                    }
                    None => self.homes += 1,
                }
                return;
            }
            let speed: f64 = words[2].strip_prefix("V=").unwrap().parse().unwrap();
            let level: u32 = words[3].strip_prefix("PL=").unwrap().parse().unwrap();
            assert!((0.1..=1500.0).contains(&speed) && level <= 8, "{line}");
            self.motion(words[0], to, speed, circle);
            self.exact = level == 0;
            return;
        }
        assert!(circle.is_empty(), "{line} within an arc");
        match words[..] {
            ["CALL", job] => self.job(job.strip_prefix("JOB:").unwrap()),
            ["ARCON", _] => {
                assert!(self.exact, "the arc is lit at a blended point");
                self.machine.arc_on();
            }
            ["ARCOF", _] => {
                assert!(self.exact, "the arc ends at a blended point");
                self.machine.arc_off();
            }
            ["TIMER", time] => {
                let seconds = time.strip_prefix("T=").unwrap().parse().unwrap();
                assert!(self.exact && seconds <= 655.35, "{line}");
                self.machine.wait(seconds);
            }
            ["WVON", file] => assert!(file.starts_with("WEV#(") && self.machine.burns(), "{line}"),
            ["WVOF"] => assert!(self.machine.burns(), "{line}"),
            ["SET", "D090", start] => self.start = start.parse().unwrap(),
            ["SUB", "P090", "P090"] => self.shift = 0.0,
            ["SETE", "P090", "(3)", micrometres] => self.shift = micrometres.parse::<f64>().unwrap() / 1000.0,
            ["SFTON", "P090", "UF#(1)"] => self.machine.lift = self.shift,
            ["SFTOF"] => self.machine.lift = 0.0,
            [label] if label.starts_with("*L") => {}
            // A jump that is not taken.
            ["JUMP", _, "IF", _] => {}
            ["AOUT", "AO#(1)", feed] => self.machine.motion.feeds.push(feed.parse().unwrap()),
            _ => assert!(line.starts_with('\'') || words[0] == "DOUT", "{line}"),
        }
    }

    /// Three MOVC make an arc; the robot goes straight to the first.
    fn motion(&mut self, word: &str, to: Stand, speed: f64, circle: &mut Vec<Stand>) {
        match (word, circle.len()) {
            // What separates two arcs.
            ("MOVL", 0) if self.arc_ended && self.machine.at == Some(to.at) => self.arc_ended = false,
            ("MOVL", 0) => {
                self.machine.move_to(to, speed);
                self.arc_ended = false;
            }
            ("MOVC", 0) => {
                assert!(!self.arc_ended, "arcs in a row are one chain to the controller");
                if self.machine.at.is_none_or(|at| distance(at, to.at) > 0.0) {
                    self.machine.move_to(to, speed);
                }
                circle.push(to);
            }
            ("MOVC", 1) => circle.push(to),
            ("MOVC", 2) => {
                self.machine.arc_to(circle[1], to, speed);
                circle.clear();
                self.arc_ended = true;
            }
            _ => panic!("{word} within an arc"),
        }
    }
}
