//! A reader of KRL modules: follows the calls of the main program and checks the grammar that matters. The arc is switched
//! by an output, or by the forms of ArcTech, whose data must be declared and used.

use super::{Carried, Machine, Motion, Stand, euler};
use std::collections::{BTreeMap, BTreeSet};

/// Runs the program `main` (file names with extension as keys). `arc` is the line that switches the arc, without its
/// value: `$OUT[2]`.
pub fn run(files: &BTreeMap<String, String>, main: &str, arc: &str) -> Motion {
    run_in(files, main, arc, None)
}

/// The same in a cell where the external axis with an index turns the table under the part.
pub fn run_in(files: &BTreeMap<String, String>, main: &str, arc: &str, table: Option<usize>) -> Motion {
    for (name, text) in files.iter().filter(|(name, _)| name.ends_with(".src") || name.ends_with(".dat")) {
        check_module(name, text);
    }
    let files = &super::branches::resolved(files);
    let data = &files[&format!("{main}.dat")];
    assert!(data.contains(&format!("DEFDAT {main}")) && data.contains("DECL E6AXIS XHOME={A1 "));
    let mut machine = Reader {
        files,
        arc,
        machine: Machine { table, ..Machine::default() },
        speed: None,
        blended: false,
        homes: 0,
        seam: None,
        triggers: Vec::new(),
        used: BTreeSet::new(),
        shift: 0.0,
    };
    machine.module(main);
    let stated = machine.machine.stand.expect("a move").axes;
    for (name, axis) in ["E1 ", "E2 "].into_iter().zip(stated) {
        let home = data.lines().find(|line| line.contains("XHOME=")).unwrap();
        assert_eq!(home.contains(name), axis.is_some(), "home has no {name}: {home}");
    }
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
    assert_eq!(lines[head].trim_end_matches(" PUBLIC"), begins);
    assert_eq!(lines[lines.len() - 2], if file.ends_with(".dat") { "ENDDAT" } else { "END" });
    let mut depth = 0_i32;
    for line in lines.iter().map(|l| l.trim_start()) {
        depth += i32::from(line.starts_with(";FOLD")) - i32::from(line.starts_with(";ENDFOLD"));
        assert!((0..=2).contains(&depth), "{file}: {line}");
    }
    assert_eq!(depth, 0, "{file}: folds");
    for (open, close) in [('{', '}'), ('(', ')')] {
        assert!(lines.iter().all(|l| l.matches(open).count() == l.matches(close).count()), "{file}: unbalanced");
    }
}

/// Statements that neither move nor switch the arc.
const KNOWN: [&str; 7] =
    ["$FLAG[2] = FALSE", "$OUT[", "$TOOL = ", "$ORI_TYPE = #VAR", "$APO.CDIS = ", "BAS(#", "GLOBAL INTERRUPT DECL "];

struct Reader<'a> {
    files: &'a BTreeMap<String, String>,
    arc: &'a str,
    machine: Machine,
    /// mm/s
    speed: Option<f64>,
    /// Whether the last motion was blended.
    blended: bool,
    homes: usize,
    /// Speed of the seam as ArcTech has it, mm/s.
    seam: Option<f64>,
    /// Triggers that wait for the next motion.
    triggers: Vec<&'a str>,
    /// Data of the module that were used.
    used: BTreeSet<String>,
    /// Height in the shift of the base, mm.
    shift: f64,
}

impl<'a> Reader<'a> {
    fn module(&mut self, name: &str) {
        let files = self.files;
        let text = files.get(&format!("{name}.src")).unwrap_or_else(|| panic!("{name}.src is missing"));
        let data = declared(files.get(&format!("{name}.dat")).map_or("", |t| t));
        let outside = std::mem::take(&mut self.used);
        for line in text.split("\r\n").map(str::trim) {
            if line.is_empty() || line.starts_with(['&', ';']) || line.starts_with("DEF") || line == "END" {
                continue;
            } else if let Some(value) = line.strip_prefix("$VEL.CP = ") {
                self.set_speed(value);
            } else if line.starts_with("LIN ") || line.starts_with("CIRC ") {
                self.motion(line, &data);
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
            } else if let Some(frame) = line.strip_prefix("$BASE = ") {
                // A frame on an external kinematic turns with it.
                let coupled = frame.strip_prefix("EK(MACHINE_DEF[2].ROOT,MACHINE_DEF[2].MECH_TYPE,");
                let data = coupled.map_or(frame, |frame| frame.strip_suffix(')').unwrap());
                let (base, shift) = data.split_once(':').unwrap_or((data, ""));
                assert!(base.starts_with("BASE_DATA[") && (shift.is_empty() || shift.ends_with("_SHIFT")), "{line}");
                self.machine.frame_turns = coupled.is_some();
                self.machine.lift = if shift.is_empty() { 0.0 } else { self.shift };
            } else if let Some((_, element)) = line.split_once("_SHIFT.Z = ") {
                // The array is declared in the data of the main module.
                let value = files
                    .values()
                    .flat_map(|text| text.lines())
                    .find_map(|l| l.strip_prefix(element)?.strip_prefix('='));
                self.shift = value.unwrap_or_else(|| panic!("{element} is not set")).parse().unwrap();
            } else if let Some(kind) = line.strip_prefix("$CIRC_TYPE = ") {
                self.machine.carried = match kind {
                    "#BASE" => Carried::InTheFrame,
                    "#PATH" => Carried::OnThePath,
                    _ => panic!("{line}"),
                };
            } else if let Some(feed) = line.strip_prefix("$ANOUT[1] = ") {
                self.machine.motion.feeds.push(feed.parse().unwrap());
            } else if let Some(pose) = line.strip_prefix("PTP {") {
                self.machine.approach(coordinates(pose.trim_end_matches('}')));
            } else if line == "PTP XHOME" {
                assert!(!self.machine.burns());
                self.homes += 1;
            } else if KNOWN.iter().any(|k| line.starts_with(k)) && !line.contains("CP_PARAMS") {
                continue;
            } else if !self.arctech(line, &data) {
                let called = line.strip_suffix("( )").unwrap_or_else(|| panic!("unknown statement: {line}"));
                self.module(called);
            }
        }
        let unused: Vec<_> = data.keys().filter(|k| *k != "XHOME" && !self.used.contains(*k)).collect();
        assert!(unused.is_empty(), "{name}.dat declares what nothing uses: {unused:?}");
        self.used = outside;
    }

    fn set_speed(&mut self, value: &str) {
        let speed: f64 = value.parse().unwrap();
        assert!(speed > 0.0 && speed <= 2.0, "$VEL.CP = {speed}");
        self.speed = Some(speed * 1000.0);
    }

    fn motion(&mut self, line: &str, data: &BTreeMap<String, String>) {
        let (word, rest) = line.split_once(' ').unwrap();
        let (rest, blended) = rest.strip_suffix(" C_DIS").map_or((rest, false), |rest| (rest, true));
        let poses: Vec<Stand> = if rest.starts_with('{') {
            rest.split("},").map(|pose| coordinates(pose.trim_end_matches('}'))).collect()
        } else {
            rest.split(", ").map(|name| coordinates(self.data(name, data).trim_end_matches('}'))).collect()
        };
        match (word, &poses[..]) {
            ("LIN", [to]) => self.machine.move_to(*to, self.speed.unwrap()),
            ("CIRC", [via, to]) => self.machine.arc_to(*via, *to, self.speed.unwrap()),
            _ => panic!("{line}"),
        }
        self.blended = blended;
    }

    /// The declaration of a name in the module's own data.
    fn data<'b>(&mut self, name: &str, data: &'b BTreeMap<String, String>) -> &'b str {
        self.used.insert(name.to_owned());
        data.get(name).unwrap_or_else(|| panic!("{name} is not declared"))
    }

    /// A statement of a form: whether it is one.
    fn arctech(&mut self, line: &'a str, data: &BTreeMap<String, String>) -> bool {
        if let Some(name) = line.strip_prefix("LDAT_ACT = ").or_else(|| line.strip_prefix("FDAT_ACT = ")) {
            self.data(name, data);
        } else if let Some(speed) = line.strip_prefix("BAS(#CP_PARAMS, ").and_then(|l| l.strip_suffix(')')) {
            match self.seam.filter(|_| speed == "gArcBasVelDefinition") {
                Some(seam) => self.speed = Some(seam),
                None => self.set_speed(speed),
            }
        } else if line.starts_with("TRIGGER WHEN ") {
            assert!(line.ends_with(" PRIO = -1"), "{line}");
            self.triggers.push(line);
        } else if let Some(rest) = line.strip_prefix("ArcMainNG(#") {
            self.main_ng(rest.strip_suffix(')').unwrap(), data);
        } else {
            return line == "$BWDSTART = FALSE" || line == "SET_CD_PARAMS (0)";
        }
        true
    }

    fn main_ng(&mut self, call: &str, data: &BTreeMap<String, String>) {
        let (what, names) = call.split_once(", ").unwrap();
        let sets: Vec<&str> = names.split(", ").map(|name| self.data(name, data)).collect();
        let group = |name: &str| sets[0].contains(&format!("{name} {{JobModeId[] \""));
        let velocity =
            || sets[0].split("Velocity ").nth(1).map(|v| v.split(',').next().unwrap().parse::<f64>().unwrap());
        assert!(sets[1..].iter().all(|s| s.contains("Info {Version 303030366}")), "{call}");
        match what {
            "ArcOnBeforeMoveStd" => self.expect_triggers(&["#PreDefinition", "#GasPreflow", "#ArcOnMoveStd"], names),
            "ArcSwiBeforeMoveStd" => self.expect_triggers(&["#ArcSwiMoveStd"], names),
            "ArcOffBeforeMoveStd" => self.expect_triggers(&["#ArcOffBeforeOffStd", "#ArcOffMoveStd"], names),
            "ArcOnAfterMoveStd" => {
                assert!(!self.blended && group("Strike") && group("Weld"), "{call}");
                self.machine.arc_on();
                self.seam = velocity().map(|v| v * 1000.0);
            }
            "ArcSwiAfterMoveStd" => {
                assert!(self.machine.burns() && group("Weld") && !group("Strike"), "{call}");
                self.seam = velocity().map(|v| v * 1000.0);
            }
            "ArcOffAfterMoveStd" => {
                assert!(!self.blended && group("Crater"), "{call}");
                self.machine.arc_off();
                (self.seam, self.speed) = (None, None);
            }
            _ => panic!("{call}"),
        }
    }

    /// The triggers in front of a form's motion, with its data.
    fn expect_triggers(&mut self, wanted: &[&str], names: &str) {
        let triggers = std::mem::take(&mut self.triggers);
        assert_eq!(triggers.len(), wanted.len(), "{triggers:?}");
        for (trigger, what) in triggers.iter().zip(wanted) {
            assert!(trigger.contains(&format!("DO ArcMainNG({what}, {names})")), "{trigger}");
        }
    }
}

/// Names that a data list declares, with their values.
fn declared(text: &str) -> BTreeMap<String, String> {
    let mut found = BTreeMap::new();
    for line in text.split("\r\n").filter(|l| l.starts_with("DECL ")) {
        // Where a program begins, and heights of layers.
        if line.starts_with("DECL GLOBAL ") {
            continue;
        }
        let (left, value) = line.split_once('=').unwrap();
        let [_, kind, name] = left.split(' ').collect::<Vec<_>>()[..] else { panic!("{line}") };
        assert!(["E6AXIS", "E6POS", "FDAT", "LDAT", "stArcDat_T"].contains(&kind) && name.len() <= 24, "{line}");
        assert!(kind != "stArcDat_T" || value.starts_with(&format!("{{WdatId[] \"{name}\",")), "{line}");
        assert!(found.insert(name.to_owned(), value.to_owned()).is_none(), "{name} is declared twice");
    }
    found
}

/// `{X 1.0,Y 2.0,Z 3.0,A …`, perhaps with E1 and E2; every component has its decimals.
fn coordinates(frame: &str) -> Stand {
    let fields: Vec<(&str, f64)> = frame
        .trim_start_matches('{')
        .split(',')
        .map(|field| field.split_once(' ').unwrap())
        .map(|(axis, value)| {
            assert!(value.contains('.') && value != "-0.000", "{frame}");
            (axis, value.parse().unwrap())
        })
        .collect();
    let names: Vec<&str> = fields.iter().map(|f| f.0).collect();
    assert!(names.len() >= 6 && ["X", "Y", "Z", "A", "B", "C", "E1", "E2"].starts_with(&names), "{frame}");
    let value = |i: usize| fields[i].1;
    Stand {
        at: [0, 1, 2].map(value),
        tool: euler(value(3), value(4), value(5)),
        axes: [6, 7].map(|i| fields.get(i).map(|field| field.1)),
    }
}
