//! A reader of FANUC TP programs (ASCII): runs `main` and what it calls, and checks heads, numbers and positions.

use super::{Machine, Motion, Point};
use std::collections::BTreeMap;

/// Runs the program of that name (file names as keys).
pub fn run(files: &BTreeMap<String, String>, main: &str) -> Motion {
    let mut reader = Reader { files, machine: Machine::default(), exact: true, homes: 0 };
    reader.program(main);
    assert_eq!(reader.homes, 2);
    reader.machine.finish()
}

struct Reader<'a> {
    files: &'a BTreeMap<String, String>,
    machine: Machine,
    exact: bool,
    homes: usize,
}

enum Position {
    Pose(Point),
    Joints,
}

impl Reader<'_> {
    fn program(&mut self, name: &str) {
        assert!(name.len() <= 36 && name.starts_with(|c: char| c.is_ascii_uppercase()), "{name}");
        assert!(name.bytes().all(|b| b.is_ascii_uppercase() || b.is_ascii_digit() || b == b'_'), "{name}");
        let text = &self.files[&format!("{name}.ls")];
        assert!(text.is_ascii() && !text.contains('\t'));
        assert_eq!(text.matches('\n').count(), text.matches("\r\n").count(), "{name} mixes line ends");
        assert!(text.starts_with(&format!("/PROG  {name}\r\n/ATTR\r\n")) && text.ends_with("/END\r\n"));
        let (head, rest) = text.split_once("/MN\r\n").unwrap();
        let (lines, positions) = rest.split_once("/POS\r\n").unwrap();
        let comment = head.split("COMMENT = \"").nth(1).unwrap().split('"').next().unwrap();
        assert!(comment.len() <= 16, "{comment}");
        let positions = read_positions(positions.strip_suffix("/END\r\n").unwrap());
        // An arc's second position goes on on the next line.
        let lines = lines.replace("\r\n    :", "");
        let (mut used, mut count) = (0, 0);
        for (i, line) in lines.lines().enumerate() {
            let (number, statement) = line.split_once(':').unwrap();
            assert_eq!(number.trim().parse::<usize>().unwrap(), i + 1, "{line}");
            let statement = statement.strip_suffix(" ;").unwrap_or_else(|| panic!("no ; after {line}"));
            count += 1;
            self.statement(statement, &positions, &mut used);
        }
        assert!(count <= 9999 && head.contains(&format!("LINE_COUNT = {count};")), "{name}");
        assert_eq!(used, positions.len(), "{name}: positions that nothing uses");
    }

    fn statement(&mut self, statement: &str, positions: &[Position], used: &mut usize) {
        let words: Vec<&str> = statement.split_whitespace().collect();
        match words[..] {
            ["CALL", name] => self.program(name),
            ["J", position, speed, "FINE"] => {
                assert!(speed.ends_with('%') && !self.machine.burns());
                self.exact = true;
                match next(position, positions, used) {
                    Position::Joints => self.homes += 1,
                    Position::Pose(to) => self.machine.approach(*to),
                }
            }
            ["L", position, speed, end] => {
                let Position::Pose(to) = next(position, positions, used) else { panic!("{statement}") };
                self.machine.move_to(*to, mm_per_second(speed));
                self.end(end);
            }
            ["C", via, position, speed, end] => {
                let Position::Pose(via) = next(via, positions, used) else { panic!("{statement}") };
                let Position::Pose(to) = next(position, positions, used) else { panic!("{statement}") };
                self.machine.arc_to(*via, *to, mm_per_second(speed));
                self.end(end);
            }
            ["Weld", word] => {
                assert!(self.exact, "the arc is switched at a blended point");
                if word.starts_with("Start[") { self.machine.arc_on() } else { self.machine.arc_off() }
            }
            ["WAIT", time] => {
                let seconds = time.strip_suffix("(sec)").unwrap().parse().unwrap();
                assert!(self.exact && seconds <= 327.67, "{statement}");
                self.machine.wait(seconds);
            }
            [feed] if feed.starts_with("AO[1]=") => self.machine.motion.feeds.push(feed[6..].parse().unwrap()),
            _ => assert!(
                ["!", "DO[", "UFRAME_NUM=1", "UTOOL_NUM=1"].iter().any(|w| words[0].starts_with(w)),
                "{statement}"
            ),
        }
    }

    fn end(&mut self, end: &str) {
        self.exact = end == "FINE";
        let continuity = end.strip_prefix("CNT").map(|c| c.parse::<u32>().unwrap());
        assert!(self.exact || continuity.unwrap() <= 100, "{end}");
    }
}

/// Positions are used once each and in order.
fn next<'a>(name: &str, positions: &'a [Position], used: &mut usize) -> &'a Position {
    *used += 1;
    assert_eq!(name, format!("P[{used}]"));
    &positions[*used - 1]
}

fn mm_per_second(text: &str) -> f64 {
    let speed = text.strip_suffix("mm/sec").map(|v| v.parse::<f64>().unwrap());
    let speed = speed.or_else(|| text.strip_suffix("cm/min").map(|v| v.parse::<f64>().unwrap() / 6.0));
    let speed = speed.unwrap_or_else(|| panic!("{text}"));
    assert!(speed > 0.0 && speed <= 2000.0);
    speed
}

fn read_positions(text: &str) -> Vec<Position> {
    let blocks: Vec<&str> = text.split("};\r\n").filter(|b| !b.is_empty()).collect();
    let read = |(i, block): (usize, &&str)| {
        assert!(block.starts_with(&format!("P[{}]{{\r\n   GP1:\r\n    UF : 1, UT : 1,", i + 1)), "{block}");
        let value = |axis: &str, unit: &str| -> Option<f64> {
            let field = block.split([',', '\n']).find(|f| f.trim().starts_with(&format!("{axis} =")))?;
            let number = field.split('=').nth(1)?.trim().strip_suffix(unit)?.trim();
            assert!(number.contains('.') && number != "-0.000");
            Some(number.parse().unwrap())
        };
        if ["J1", "J2", "J3", "J4", "J5", "J6"].iter().all(|axis| value(axis, "deg").is_some()) {
            return Position::Joints;
        }
        assert!(block.contains("CONFIG : 'N U T, 0, 0, 0',"));
        assert!(["W", "P", "R"].iter().all(|axis| value(axis, "deg").is_some()), "{block}");
        Position::Pose(["X", "Y", "Z"].map(|axis| value(axis, "mm").unwrap()))
    };
    blocks.iter().enumerate().map(read).collect()
}
