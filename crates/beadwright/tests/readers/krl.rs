//! A reader of KRL modules: follows the calls of the main program and checks the grammar that matters.

use super::{Machine, Motion, Point};
use std::collections::BTreeMap;

/// Runs the program `main` (file names with extension as keys). `arc` is the line that switches the arc, without its
/// value: `$OUT[2]`.
pub fn run(files: &BTreeMap<String, String>, main: &str, arc: &str) -> Motion {
    for (name, text) in files.iter().filter(|(name, _)| name.ends_with(".src") || name.ends_with(".dat")) {
        check_module(name, text);
    }
    let data = &files[&format!("{main}.dat")];
    assert!(data.contains(&format!("DEFDAT {main}\r\n")) && data.contains("DECL E6AXIS XHOME={A1 "));
    let mut machine = Reader { files, arc, machine: Machine::default(), speed: None, blended: false, homes: 0 };
    machine.module(main);
    assert_eq!(machine.homes, 2, "a program begins and ends at home");
    machine.machine.finish()
}

/// Names, heads, folds, line ends and characters.
fn check_module(file: &str, text: &str) {
    let name = file.split('.').next().unwrap();
    assert!(name.len() <= 24 && !name.starts_with(|c: char| c.is_ascii_digit()), "{name} is no module name");
    assert!(name.bytes().all(|b| b.is_ascii_uppercase() || b.is_ascii_digit() || b == b'_'), "{name}");
    assert!(text.is_ascii() && !text.contains('\t') && text.ends_with("\r\n"), "{file}");
    assert_eq!(text.matches('\n').count(), text.matches("\r\n").count(), "{file} mixes line ends");
    let lines: Vec<&str> = text.split("\r\n").collect();
    let head = lines.iter().take_while(|l| l.starts_with('&')).count();
    assert!(head > 0 && lines[head..].iter().all(|l| !l.starts_with('&')), "{file}: & lines only at the head");
    let begins = if file.ends_with(".dat") { format!("DEFDAT {name}") } else { format!("DEF {name}( )") };
    assert_eq!(lines[head], begins);
    assert_eq!(lines[lines.len() - 2], if file.ends_with(".dat") { "ENDDAT" } else { "END" });
    let folds = |word: &str| lines.iter().filter(|l| l.trim_start().starts_with(word)).count();
    assert_eq!(folds(";FOLD"), folds(";ENDFOLD"));
    for (open, close) in [('{', '}'), ('(', ')')] {
        assert!(lines.iter().all(|l| l.matches(open).count() == l.matches(close).count()), "{file}: unbalanced");
    }
}

/// Statements that neither move nor switch the arc.
const KNOWN: [&str; 7] =
    ["$OUT[", "$TOOL = ", "$BASE = ", "$APO.CDIS = ", "BAS(#", "GLOBAL INTERRUPT DECL ", "INTERRUPT ON "];

struct Reader<'a> {
    files: &'a BTreeMap<String, String>,
    arc: &'a str,
    machine: Machine,
    /// mm/s
    speed: Option<f64>,
    /// Whether the last motion was blended.
    blended: bool,
    homes: usize,
}

impl Reader<'_> {
    fn module(&mut self, name: &str) {
        let text = self.files.get(&format!("{name}.src")).unwrap_or_else(|| panic!("{name}.src is missing"));
        for line in text.split("\r\n").map(str::trim) {
            if line.is_empty() || line.starts_with(['&', ';']) || line.starts_with("DEF") || line == "END" {
                continue;
            } else if let Some(value) = line.strip_prefix("$VEL.CP = ") {
                let speed: f64 = value.parse().unwrap();
                assert!(speed > 0.0 && speed <= 2.0, "$VEL.CP = {speed}");
                self.speed = Some(speed * 1000.0);
            } else if let Some(rest) = line.strip_prefix("LIN ") {
                let (point, blend) = rest.split_once('}').unwrap();
                self.machine.move_to(coordinates(point), self.speed.unwrap());
                self.blended = blend.trim() == "C_DIS";
                assert!(self.blended || blend.is_empty(), "{line}");
            } else if let Some(rest) = line.strip_prefix("CIRC ") {
                let (via, rest) = rest.split_once("},").unwrap();
                let (point, blend) = rest.split_once('}').unwrap();
                self.machine.arc_to(coordinates(via), coordinates(point), self.speed.unwrap());
                self.blended = blend.trim() == "C_DIS";
                assert!(self.blended || blend.is_empty(), "{line}");
            } else if let Some(value) = line.strip_prefix(self.arc).and_then(|l| l.strip_prefix(" = ")) {
                assert!(!self.blended, "the arc is switched after a blended point");
                match value {
                    "TRUE" => self.machine.arc_on(),
                    "FALSE" if self.machine.burns() => self.machine.arc_off(),
                    "FALSE" => {}
                    _ => panic!("{line}"),
                }
            } else if let Some(seconds) = line.strip_prefix("WAIT SEC ") {
                assert!(!self.blended, "a wait at a blended point");
                self.machine.wait(seconds.parse().unwrap());
            } else if let Some(feed) = line.strip_prefix("$ANOUT[1] = ") {
                self.machine.motion.feeds.push(feed.parse().unwrap());
            } else if line == "PTP XHOME" {
                assert!(!self.machine.burns());
                self.homes += 1;
            } else if KNOWN.iter().any(|k| line.starts_with(k)) {
                continue;
            } else {
                let called = line.strip_suffix("( )").unwrap_or_else(|| panic!("unknown statement: {line}"));
                self.module(called);
            }
        }
    }
}

/// `{X 1.0,Y 2.0,Z 3.0,A …` to a point; every component has its decimals.
fn coordinates(frame: &str) -> Point {
    let fields: Vec<(&str, f64)> = frame
        .trim_start_matches('{')
        .split(',')
        .map(|field| field.split_once(' ').unwrap())
        .map(|(axis, value)| {
            assert!(value.contains('.') && value != "-0.000", "{frame}");
            (axis, value.parse().unwrap())
        })
        .collect();
    let axes: Vec<&str> = fields.iter().map(|f| f.0).collect();
    assert_eq!(axes, ["X", "Y", "Z", "A", "B", "C"]);
    [fields[0].1, fields[1].1, fields[2].1]
}
