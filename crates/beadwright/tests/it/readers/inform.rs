//! A reader of INFORM jobs: runs `main` and what it calls, and checks heads, counts and positions.

use super::{Machine, Motion, Stand, distance, euler};
use std::collections::BTreeMap;

/// Runs the job of that name (file names as keys).
pub fn run(files: &BTreeMap<String, String>, main: &str) -> Motion {
    run_turned(files, main, &|stand| stand)
}

/// The same where a station turns the part: `on_part` brings a stand of the frame, with the pulses of the station, to the part.
pub fn run_turned(files: &BTreeMap<String, String>, main: &str, on_part: &dyn Fn(Stand) -> Stand) -> Motion {
    let (machine, axes) = (Machine::default(), [None; 2]);
    let mut reader =
        Reader { on_part, files, machine, exact: true, arc_ended: false, homes: 0, start: 0.0, shift: 0.0, axes };
    reader.job(main);
    assert_eq!(reader.homes, 2);
    reader.machine.finish()
}

struct Reader<'a> {
    on_part: &'a dyn Fn(Stand) -> Stand,
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
    /// Where the current move brings the axes of the station, pulses.
    axes: [Option<f64>; 2],
}

/// A move without what it says of the station, and where that brings it: both move together, at speeds that only the moves of joints give
/// to the station too.
fn with_station(line: &str, stations: &[&str]) -> (String, [Option<f64>; 2]) {
    let Some((robot, station)) = line.split_once("  +MOVJ ") else {
        assert!(stations.is_empty() || !line.starts_with("MOV"), "{line} leaves the station where it is");
        return (line.to_owned(), [None; 2]);
    };
    let number = &robot.split_whitespace().nth(1).unwrap()[1..];
    let (name, speed) = station.split_once(' ').unwrap_or((station, ""));
    assert_eq!(name, format!("EC{number}"), "{line}");
    assert_eq!(speed.starts_with("VJ="), robot.starts_with("MOVJ"), "{line}");
    let numbers = stations[number.parse::<usize>().unwrap()].strip_prefix(&format!("{name}=")).unwrap();
    let mut pulses = numbers.split(',').map(|pulses| pulses.parse::<i64>().unwrap() as f64);
    (robot.strip_prefix('S').unwrap_or(robot).to_owned(), [pulses.next(), pulses.next()])
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
        // A station has a position for each of the robot's.
        let stations: Vec<&str> = lines.iter().filter(|l| l.starts_with("EC") && l.contains('=')).copied().collect();
        assert!(stations.is_empty() || stations.len() == positions.len(), "{name}");
        assert_eq!(lines[3], format!("///NPOS {},0,{},0,0,0", positions.len(), stations.len()));
        assert_eq!(lines.contains(&"///GROUP2 ST1"), !stations.is_empty());
        let pulses = lines.iter().position(|l| *l == "///PULSE");
        assert!(stations.iter().all(|own| pulses < lines.iter().position(|line| line == own)), "{name}");
        assert!(stations.is_empty() || pulses.is_some(), "{name}: a station has pulses only");
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
                    let (line, axes) = with_station(lines[at], &stations);
                    self.axes = axes;
                    self.instruction(&line, &positions, &mut used, &mut circle);
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
            let to = (self.on_part)(Stand { at: [numbers[0], numbers[1], numbers[2]], tool, axes: self.axes });
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
