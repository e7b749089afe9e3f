//! A reader of FANUC TP programs (ASCII): runs `main` and what it calls, and checks heads, numbers and positions.

use super::{Machine, Motion, Stand, euler};
use std::collections::BTreeMap;

/// Runs the program of that name (file names as keys).
pub fn run(files: &BTreeMap<String, String>, main: &str) -> Motion {
    let mut reader = Reader { files, machine: Machine::default(), exact: true, homes: 0, weaves: false, start: 0.0 };
    reader.program(main);
    assert_eq!(reader.homes, 2);
    reader.machine.finish()
}

struct Reader<'a> {
    files: &'a BTreeMap<String, String>,
    machine: Machine,
    exact: bool,
    homes: usize,
    weaves: bool,
    /// Where the program begins.
    start: f64,
}

enum Position {
    Pose(Stand),
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
        // What moves a table has its motion group in every point and on every line of motion.
        let coordinated = head.contains("DEFAULT_GROUP = 1,1,*,*,*;");
        assert!(coordinated || head.contains("DEFAULT_GROUP = 1,*,*,*,*;"), "{head}");
        let positions = read_positions(positions.strip_suffix("/END\r\n").unwrap(), coordinated);
        // An arc's second position goes on on the next line.
        let lines = lines.replace("\r\n    :", "");
        let (mut used, mut statements) = (0, Vec::new());
        for (i, line) in lines.lines().enumerate() {
            let (number, statement) = line.split_once(':').unwrap();
            assert_eq!(number.trim().parse::<usize>().unwrap(), i + 1, "{line}");
            statements.push(statement.strip_suffix(" ;").unwrap_or_else(|| panic!("no ; after {line}")).trim());
        }
        let (mut at, count) = (0, statements.len());
        while at < count {
            at = match self.jump(statements[at]) {
                Some(label) => at + statements[at..].iter().position(|s| *s == label).expect("the label comes behind"),
                None => {
                    let statement = statements[at];
                    if statement.starts_with("L ") || statement.starts_with("C ") {
                        assert_eq!(statement.contains(" COORD"), coordinated, "{statement}");
                    }
                    self.statement(&statement.replace(" COORD", ""), &positions, &mut used);
                    at + 1
                }
            };
        }
        assert!(count <= 9999 && head.contains(&format!("LINE_COUNT = {count};")), "{name}");
        assert!(used == positions.len() || lines.contains("JMP "), "{name}: positions that nothing uses");
    }

    /// The label to which a statement jumps: conditions on the register that says where to begin.
    fn jump(&self, statement: &str) -> Option<&str> {
        let label = |text: &str| -> &'static str { Box::leak(text.to_owned().into_boxed_str()) };
        if let Some(to) = statement.strip_prefix("JMP ") {
            return Some(label(to));
        }
        let (condition, to) = statement.strip_prefix("IF R[90]")?.split_once(",JMP ")?;
        let (sign, bound) = condition.split_at(1);
        let bound: f64 = bound.parse().unwrap();
        let taken = if sign == ">" { self.start > bound } else { self.start == bound };
        taken.then(|| label(to))
    }

    fn statement(&mut self, statement: &str, positions: &[Position], used: &mut usize) {
        let words: Vec<&str> = statement.split_whitespace().collect();
        match words[..] {
            ["CALL", name] => self.program(name),
            ["J", position, speed, "FINE"] | ["J", position, speed, "FINE", "Offset"] => {
                assert!(speed.ends_with('%') && !self.machine.burns());
                self.exact = true;
                match next(position, positions, used) {
                    Position::Joints => self.homes += 1,
                    Position::Pose(to) => self.machine.approach(*to),
                }
            }
            ["L", position, speed, end] | ["L", position, speed, end, "Offset"] => {
                let Position::Pose(to) = next(position, positions, used) else { panic!("{statement}") };
                self.machine.move_to(*to, mm_per_second(speed));
                self.end(end);
            }
            ["C", via, position, speed, end] | ["C", via, position, speed, end, "Offset"] => {
                let Position::Pose(via) = next(via, positions, used) else { panic!("{statement}") };
                let Position::Pose(to) = next(position, positions, used) else { panic!("{statement}") };
                self.machine.arc_to(*via, *to, mm_per_second(speed));
                self.end(end);
            }
            ["Weave", "End"] => assert!(std::mem::take(&mut self.weaves), "no weave to end"),
            ["Weave", sine] => {
                assert!(sine.starts_with("Sine[") && self.machine.burns() && !self.weaves, "{statement}");
                self.weaves = true;
            }
            ["OFFSET", "CONDITION", "PR[90]"] | ["PR[90]=LPOS-LPOS"] => {}
            [height] if height.starts_with("PR[90,3]=") => self.machine.lift = height[9..].parse().unwrap(),
            [start] if start.starts_with("R[90]=") => self.start = start[6..].parse().unwrap(),
            [label] if label.starts_with("LBL[") => {}
            // A jump that is not taken.
            ["IF", ..] => {}
            ["Weld", word] => {
                assert!(!self.weaves, "the arc is switched while the torch weaves");
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

/// Positions are used in order; those of branches that are not taken are passed over.
fn next<'a>(name: &str, positions: &'a [Position], used: &mut usize) -> &'a Position {
    let number: usize = name.strip_prefix("P[").and_then(|n| n.strip_suffix(']')).unwrap().parse().unwrap();
    assert!(number > *used, "{name} behind P[{used}]");
    *used = number;
    &positions[number - 1]
}

fn mm_per_second(text: &str) -> f64 {
    let speed = text.strip_suffix("mm/sec").map(|v| v.parse::<f64>().unwrap());
    let speed = speed.or_else(|| text.strip_suffix("cm/min").map(|v| v.parse::<f64>().unwrap() / 6.0));
    let speed = speed.unwrap_or_else(|| panic!("{text}"));
    assert!(speed > 0.0 && speed <= 2000.0);
    speed
}

fn read_positions(text: &str, coordinated: bool) -> Vec<Position> {
    let blocks: Vec<&str> = text.split("};\r\n").filter(|b| !b.is_empty()).collect();
    let read = |(i, block): (usize, &&str)| {
        assert!(block.starts_with(&format!("P[{}]{{\r\n   GP1:\r\n    UF : 1, UT : 1,", i + 1)), "{block}");
        let (block, second) = block.split_once("   GP2:\r\n    UF : 1, UT : 1,\r\n").unwrap_or((block, ""));
        assert_eq!(!second.is_empty(), coordinated, "{block}");
        let find = |block: &str, axis: &str, unit: &str| -> Option<f64> {
            let field = block.split([',', '\n']).find(|f| f.trim().starts_with(&format!("{axis} =")))?;
            let number = field.split('=').nth(1)?.trim().strip_suffix(unit)?.trim();
            assert!(number.contains('.') && number != "-0.000");
            Some(number.parse().unwrap())
        };
        let value = |axis: &str, unit: &str| find(block, axis, unit);
        if ["J1", "J2", "J3", "J4", "J5", "J6"].iter().all(|axis| value(axis, "deg").is_some()) {
            return Position::Joints;
        }
        assert!(block.contains("CONFIG : 'N U T, 0, 0, 0',"));
        let [w, p, r] = ["W", "P", "R"].map(|axis| value(axis, "deg").unwrap());
        let at = ["X", "Y", "Z"].map(|axis| value(axis, "mm").unwrap());
        let axes = ["J1", "J2"].map(|axis| find(second, axis, "deg"));
        Position::Pose(Stand { at, tool: euler(r, p, w), axes })
    };
    blocks.iter().enumerate().map(read).collect()
}
