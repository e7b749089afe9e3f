//! A reader of RAPID modules: runs `main`, loads and unloads what it says, and checks the grammar that matters.

use super::{Carried, Machine, Motion, Stand};
use glam::DQuat;
use std::collections::{BTreeMap, BTreeSet};

/// Shapes of the data: n number, b truth, s text, brackets lists; A is arcdata.
const SHAPES: [(&str, &str); 9] = [
    ("weavedata", "(nnnnnnnnnnnnnnn)"),
    ("tooldata", "(b((nnn)(nnnn))(n(nnn)(nnnn)nnn))"),
    ("wobjdata", "(bbs((nnn)(nnnn))((nnn)(nnnn)))"),
    ("jointtarget", "((nnnnnn)(nnnnnn))"),
    ("speeddata", "(nnnn)"),
    ("zonedata", "(bnnnnnn)"),
    ("seamdata", "(nnAnnnnnAnnAnnAn)"),
    ("welddata", "(nnAA)"),
    ("robtarget", "((nnn)(nnnn)(nnnn)(nnnnnn))"),
];

/// Runs the program of that name (file names as keys). `output` switches the arc where there is no RobotWare Arc.
pub fn run(files: &BTreeMap<String, String>, main: &str, output: &str) -> Motion {
    run_in(files, main, output, None)
}

/// The same in a cell where the external axis with an index turns the table under the part.
pub fn run_in(files: &BTreeMap<String, String>, main: &str, output: &str, table: Option<usize>) -> Motion {
    let restarts = files.values().any(|text| text.contains("nStart"));
    let files = &if restarts { super::branches::resolved(files) } else { files.clone() };
    let modules: BTreeMap<String, Module> = files
        .iter()
        .filter_map(|(file, text)| Some((file.strip_suffix(".mod")?.to_owned(), Module::new(file, text))))
        .collect();
    let listed = files.get(&format!("{main}.pgf")).map(|text| pgf(text)).unwrap_or_default();
    assert!(listed.is_empty() || listed.contains(main), "the .pgf does not list {main}");
    let loaded = if listed.is_empty() { BTreeSet::from([main.to_owned()]) } else { listed };
    let mut reader = Reader {
        modules: &modules,
        loaded,
        erased: None,
        main,
        output,
        machine: Machine::default(),
        exact: true,
        homes: 0,
        home: None,
        active: BTreeSet::new(),
    };
    // An arc is welded with the tool turned as seen from the path unless the program says otherwise.
    reader.machine.carried = Carried::OnThePath;
    reader.machine.table = table;
    reader.check_names();
    let body = &modules[main].routines["main"];
    // Configurations are unknown, before anything moves.
    let first = body.iter().position(|line| line.starts_with("Move")).unwrap();
    let set = |line: &str| body[..first].iter().any(|l| l == line);
    assert!(["ConfL \\Off", "ConfJ \\Off", "SingArea \\Wrist"].into_iter().all(set), "{body:?}");
    assert!(
        body[first].starts_with("MoveAbsJ ") && body.last().unwrap().starts_with("MoveAbsJ "),
        "home first and last"
    );
    reader.routine(main, "main");
    assert_eq!(reader.homes, 2);
    reader.machine.finish()
}

/// Modules that the program file lists.
fn pgf(text: &str) -> BTreeSet<String> {
    assert!(text.starts_with("<?xml version=\"1.0\" ") && text.ends_with("</Program>\r\n") && text.is_ascii());
    let names = text.lines().filter_map(|l| l.trim().strip_prefix("<Module>")?.strip_suffix(".mod</Module>"));
    names.map(str::to_owned).collect()
}

/// Routines of the watch over the arc.
const WATCH: [&str; 3] = ["WatchArc", "ArcBurns", "tArcLost"];

/// Statements of that watch.
const WATCHING: [&str; 2] = ["IDelete", "TriggStopProc"];

struct Datum {
    kind: String,
    local: bool,
    value: Literal,
}

struct Module {
    data: BTreeMap<String, Datum>,
    routines: BTreeMap<String, Vec<String>>,
    /// Heights added to layers, mm.
    heights: Vec<f64>,
}

impl Module {
    fn new(file: &str, text: &str) -> Self {
        assert!(text.is_ascii() && !text.contains('\t') && text.ends_with("\r\n"), "{file}");
        assert_eq!(text.matches('\n').count(), text.matches("\r\n").count(), "{file} mixes line ends");
        for line in text.lines() {
            let strings = line.split('"').skip(1).step_by(2);
            assert!(strings.into_iter().all(|s| s.len() <= 80), "{file}: a string is too long: {line}");
        }
        let lines: Vec<&str> = text.lines().map(str::trim).filter(|l| !l.is_empty() && !l.starts_with('!')).collect();
        assert_eq!(
            lines[0],
            format!("MODULE {}", file.strip_suffix(".mod").unwrap()),
            "a module is called as its file"
        );
        assert_eq!(lines.last(), Some(&"ENDMODULE"));
        let mut module = Self { data: BTreeMap::new(), routines: BTreeMap::new(), heights: Vec::new() };
        let mut open: Option<(String, Vec<String>)> = None;
        for line in &lines[1..lines.len() - 1] {
            let routine = line.strip_prefix("PROC ").and_then(|l| l.strip_suffix("()"));
            if let Some(name) = routine.or_else(|| line.strip_prefix("TRAP ")) {
                assert!(open.replace((name.to_owned(), Vec::new())).is_none(), "{file}: a PROC in a PROC");
            } else if open.as_ref().is_some_and(|(name, _)| WATCH.contains(&&**name))
                && !["ENDPROC", "ENDTRAP"].contains(line)
            {
                // What runs where the arc is out, and nothing else.
                assert!(!line.starts_with("Move"), "{line}");
            } else if *line == "ENDPROC" || *line == "ENDTRAP" {
                let (name, body) = open.take().expect("ENDPROC without PROC");
                assert!(module.routines.insert(name, body).is_none(), "{file}: two routines of one name");
            } else {
                let statement = line.strip_suffix(';').unwrap_or_else(|| panic!("{file}: no ; after {line}"));
                match &mut open {
                    Some((_, body)) => body.push(statement.to_owned()),
                    None => module.declare(statement),
                }
            }
        }
        assert!(open.is_none(), "{file}: no ENDPROC");
        module
    }

    fn declare(&mut self, statement: &str) {
        assert!(self.routines.is_empty(), "declared behind a routine: {statement}");
        if statement == "VAR intnum iArc" {
            return;
        }
        let (head, value) = statement.split_once(":=").unwrap_or_else(|| panic!("no value: {statement}"));
        let words: Vec<&str> = head.split(' ').collect();
        let (local, kind, name) = match words[..] {
            ["LOCAL", "PERS" | "CONST", kind, name] => (true, kind, name),
            ["PERS", "num", "nStart"] | ["PERS", "restartdata", "rdArc"] => return,
            ["PERS", "num", array] if array.starts_with("nDz{") => {
                self.heights = value.trim_matches(['[', ']']).split(',').map(|v| v.parse().unwrap()).collect();
                return;
            }
            ["TASK", "PERS", kind, name] | ["CONST", kind, name] => (false, kind, name),
            _ => panic!("no declaration: {statement}"),
        };
        let value = literal(value);
        check(kind, &value);
        let datum = Datum { kind: kind.to_owned(), local, value };
        assert!(self.data.insert(name.to_owned(), datum).is_none(), "{name} is declared twice");
    }
}

/// A value as written.
enum Literal {
    Number(f64),
    Truth(bool),
    Text(String),
    List(Vec<Literal>),
}

impl Literal {
    fn shape(&self) -> String {
        match self {
            Self::Number(_) => "n".to_owned(),
            Self::Truth(_) => "b".to_owned(),
            Self::Text(_) => "s".to_owned(),
            Self::List(parts) => format!("({})", parts.iter().map(Self::shape).collect::<String>()),
        }
    }

    fn part(&self, index: usize) -> &Self {
        let Self::List(parts) = self else { panic!("no list") };
        &parts[index]
    }

    fn truth(&self) -> bool {
        let Self::Truth(value) = self else { panic!("no truth") };
        *value
    }

    fn text(&self) -> &str {
        let Self::Text(value) = self else { panic!("no text") };
        value
    }

    fn number(&self) -> f64 {
        let Self::Number(value) = self else { panic!("no number") };
        *value
    }
}

fn literal(text: &str) -> Literal {
    if let Some(inside) = text.strip_prefix('[') {
        let inside = inside.strip_suffix(']').unwrap_or_else(|| panic!("no end: {text}"));
        return Literal::List(parts(inside).into_iter().map(literal).collect());
    }
    match text {
        "TRUE" | "FALSE" => Literal::Truth(text == "TRUE"),
        _ if text.starts_with('"') && text.ends_with('"') => Literal::Text(text.trim_matches('"').to_owned()),
        _ => {
            assert!(!text.starts_with("-0.") || text.bytes().any(|b| (b'1'..=b'9').contains(&b)), "{text}");
            Literal::Number(text.parse().unwrap_or_else(|_| panic!("{text} is no number")))
        }
    }
}

/// Pieces between commas outside brackets.
fn parts(text: &str) -> Vec<&str> {
    let (mut depth, mut start, mut found) = (0, 0, Vec::new());
    for (i, c) in text.char_indices() {
        depth += i32::from(c == '[') - i32::from(c == ']');
        if c == ',' && depth == 0 {
            found.push(&text[start..i]);
            start = i + 1;
        }
    }
    found.push(&text[start..]);
    found
}

/// Arity, unit quaternions, masses and times.
fn check(kind: &str, value: &Literal) {
    let shape = SHAPES.iter().find(|s| s.0 == kind).unwrap_or_else(|| panic!("unknown type {kind}")).1;
    assert_eq!(value.shape(), shape.replace('A', "(nnnnnnnnn)"), "{kind}");
    let unit = |q: &Literal| {
        let norm = (0..4).map(|i| q.part(i).number().powi(2)).sum::<f64>().sqrt();
        assert!((norm - 1.0).abs() < 1e-6, "{kind}: a quaternion of length {norm}");
    };
    match kind {
        "robtarget" => unit(value.part(1)),
        "tooldata" => {
            unit(value.part(1).part(1));
            let load = value.part(2);
            unit(load.part(2));
            assert!(load.part(0).number() > 0.0 && (0..3).any(|i| load.part(1).part(i).number() != 0.0));
        }
        "wobjdata" => [3, 4].into_iter().for_each(|i| unit(value.part(i).part(1))),
        "speeddata" | "welddata" => assert!(value.part(0).number() > 0.0),
        _ => {}
    }
}

struct Reader<'a> {
    modules: &'a BTreeMap<String, Module>,
    loaded: BTreeSet<String>,
    /// The module that was just erased where it was loaded already.
    erased: Option<String>,
    main: &'a str,
    output: &'a str,
    machine: Machine,
    /// Whether the robot stands still: the motion before was exact and was waited for.
    exact: bool,
    homes: usize,
    /// Which external axes home states.
    home: Option<[bool; 2]>,
    /// Mechanical units beside the robot that are active.
    active: BTreeSet<String>,
}

impl Reader<'_> {
    /// Legal names; global ones once in the program, local ones once in their module, none of the system's.
    fn check_names(&self) {
        let mut global = BTreeSet::new();
        for (name, module) in self.modules {
            let data = module.data.iter().filter(|d| !d.1.local).map(|d| d.0);
            for name in std::iter::once(name).chain(data).chain(module.routines.keys()) {
                legal(name);
                assert!(global.insert(name.to_lowercase()), "{name} is there twice");
            }
        }
        for name in self.modules.values().flat_map(|m| m.data.iter().filter(|d| d.1.local).map(|d| d.0)) {
            legal(name);
            assert!(!global.contains(&name.to_lowercase()), "{name} hides a global one");
        }
    }

    fn routine(&mut self, module: &str, routine: &str) {
        let modules = self.modules;
        for statement in &modules[module].routines[routine] {
            self.statement(module, statement);
        }
    }

    fn statement(&mut self, module: &str, statement: &str) {
        let (word, rest) = statement.split_once(' ').unwrap_or((statement, ""));
        match word {
            "ConfL" | "ConfJ" | "SingArea" => {}
            "CirPathMode" => {
                self.machine.carried = match rest {
                    "\\ObjectFrame" => Carried::InTheFrame,
                    "\\PathFrame" => Carried::OnThePath,
                    _ => panic!("{statement}"),
                };
            }
            "PDispSet" => {
                let layer = rest.strip_prefix("[[0,0,nDz{").and_then(|r| r.strip_suffix("}],[1,0,0,0]]")).unwrap();
                self.machine.lift = self.modules[self.main].heights[layer.parse::<usize>().unwrap() - 1];
            }
            "PDispOff" => self.machine.lift = 0.0,
            "ActUnit" => assert!(self.active.insert(rest.to_owned()), "{rest} is active already"),
            "WatchArc" | "ArcBurns" => assert!(self.machine.burns(), "the arc is looked at before it is lit"),
            // No current flows before the arc is struck.
            "WaitDI" => assert!(rest == "diArc,0" && !self.machine.burns(), "{statement}"),
            _ if WATCHING.contains(&word) => {}
            "MoveAbsJ" => {
                assert!(!self.machine.burns());
                let [target, speed, zone, tool] = parts(rest)[..] else { panic!("{statement}") };
                let home = &self.datum(module, target, "jointtarget").value;
                let stated = [0, 1].map(|i| home.part(1).part(i).number() < 9e9);
                let stand = self.machine.stand;
                assert!(
                    stand.is_none_or(|stand| stand.axes.map(|axis| axis.is_some()) == stated),
                    "an axis is missing at home"
                );
                self.home = Some(stated);
                self.common(module, speed, zone, tool);
                self.homes += 1;
            }
            "MoveL" | "MoveJ" | "MoveC" | "ArcLStart" | "ArcL" | "ArcLEnd" | "ArcC" | "ArcCEnd" => {
                self.motion(module, word, rest)
            }
            "WaitTime" => {
                let seconds: f64 = rest.strip_prefix("\\InPos,").unwrap().parse().unwrap();
                self.machine.wait(seconds);
            }
            "SetDO" => self.set(rest),
            "SetAO" => self.machine.motion.feeds.push(rest.strip_prefix("aoWire,").unwrap().parse().unwrap()),
            "IF" => {
                let name = rest.strip_prefix("ModExist(\"").and_then(|r| r.split_once("\") EraseModule \"")).unwrap();
                assert_eq!(name.1, format!("{}\"", name.0));
                self.erased = Some(name.0.to_owned());
            }
            "Load" => {
                let name = self.file(rest.strip_prefix("\\Dynamic,").unwrap());
                assert_eq!(self.erased.take().as_ref(), Some(&name), "after a stop {name} may be loaded already");
                assert!(self.loaded.insert(name.clone()), "{name} is loaded already");
            }
            "UnLoad" => {
                let name = self.file(rest);
                assert!(self.loaded.remove(&name), "{name} was not loaded");
            }
            _ => {
                let called = statement.strip_prefix("%\"").and_then(|s| s.strip_suffix("\"%"));
                let (of, routine) = called.and_then(|c| c.split_once(':')).unwrap_or_else(|| panic!("{statement}"));
                assert!(self.loaded.contains(of), "{of} is not loaded");
                self.routine(of, routine);
            }
        }
    }

    /// The module in a string such as `"HOME:/part/L001.mod"`.
    fn file(&self, text: &str) -> String {
        let path = text.strip_prefix('"').and_then(|t| t.strip_suffix('"')).expect("a string");
        let name = path.rsplit('/').next().and_then(|f| f.strip_suffix(".mod")).expect("a module");
        assert!(self.modules.contains_key(name), "{name} is missing");
        name.to_owned()
    }

    fn set(&mut self, text: &str) {
        let (output, value) = text.split_once(',').unwrap();
        if output != self.output {
            return;
        }
        assert!(self.exact, "the arc is switched while the robot moves");
        match value {
            "1" => self.machine.arc_on(),
            // At its end the program makes sure once more.
            _ if self.machine.burns() => self.machine.arc_off(),
            _ => {}
        }
    }

    fn motion(&mut self, module: &str, word: &str, rest: &str) {
        let mut pieces = parts(rest);
        let place = |text: &str| -> Stand {
            let target = literal(text);
            check("robtarget", &target);
            let [w, x, y, z] = [0, 1, 2, 3].map(|i| target.part(1).part(i).number());
            let axis = |i: usize| Some(target.part(3).part(i).number()).filter(|value| *value < 9e9);
            let at = [0, 1, 2].map(|i| target.part(0).part(i).number());
            Stand { at, tool: DQuat::from_xyzw(x, y, z, w), axes: [0, 1].map(axis) }
        };
        let circular = matches!(word, "MoveC" | "ArcC" | "ArcCEnd");
        let via = circular.then(|| place(pieces.remove(0)));
        let to = place(pieces[0]);
        let go = |machine: &mut Machine, speed: f64| match via {
            Some(via) => machine.arc_to(via, to, speed),
            None => machine.move_to(to, speed),
        };
        if word == "MoveJ" {
            let [_, speed, zone, tool] = pieces[..] else { panic!("{rest}") };
            self.common(module, speed, zone, tool);
            return self.machine.approach(to);
        }
        if matches!(word, "MoveL" | "MoveC") {
            let [_, speed, zone, tool] = pieces[..] else { panic!("{rest}") };
            assert!(!self.machine.burns() || !self.output.is_empty(), "a Move while the arc is on: {rest}");
            let speed = self.common(module, speed, zone, tool);
            go(&mut self.machine, speed);
            return;
        }
        let [_, speed, seam, weld, zone, tool] = pieces[..] else { panic!("{rest}") };
        let (weld, weave) = weld.split_once("\\Weave:=").map_or((weld, None), |(weld, weave)| (weld, Some(weave)));
        weave.into_iter().for_each(|weave| assert!(self.datum(module, weave, "weavedata").local));
        let approach = self.common(module, speed, zone, tool);
        self.datum(module, seam, "seamdata");
        let speed = self.datum(module, weld, "welddata").value.part(0).number();
        match word {
            "ArcLStart" => {
                assert!(self.exact, "the arc is lit at a blended point");
                self.machine.move_to(to, approach);
                self.machine.arc_on();
            }
            _ => {
                assert!(self.machine.burns(), "{word} without ArcLStart");
                go(&mut self.machine, speed);
            }
        }
        if word.ends_with("End") {
            assert!(self.exact, "the arc ends at a blended point");
            self.machine.arc_off();
        }
    }

    /// Checks zone, tool and work object; gives the speed, mm/s.
    fn common(&mut self, module: &str, speed: &str, zone: &str, tool: &str) -> f64 {
        self.exact = zone == "fine";
        if !self.exact {
            self.datum(module, zone, "zonedata");
        }
        let (tool, wobj) = tool.split_once("\\WObj:=").expect("a work object");
        self.datum(module, tool, "tooldata");
        let wobj = &self.datum(module, wobj, "wobjdata").value;
        let (fixed, unit) = (wobj.part(1).truth(), wobj.part(2).text());
        assert_eq!(fixed, unit.is_empty(), "a frame is fixed, or moves with a unit");
        assert!(fixed || self.active.contains(unit), "{unit} is not active");
        self.machine.frame_turns = !fixed;
        self.datum(module, speed, "speeddata").value.part(0).number()
    }

    /// Declared data of the module itself or of the main one.
    fn datum(&self, module: &str, name: &str, kind: &str) -> &Datum {
        let own = self.modules[module].data.get(name);
        let datum = own.or_else(|| self.modules[self.main].data.get(name).filter(|d| !d.local));
        let datum = datum.unwrap_or_else(|| panic!("{name} is not declared"));
        assert_eq!(datum.kind, kind, "{name}");
        datum
    }
}

fn legal(name: &str) {
    assert!(name.len() <= 32 && name.starts_with(|c: char| c.is_ascii_alphabetic()), "{name} is no identifier");
    assert!(name.bytes().all(|b| b.is_ascii_alphanumeric() || b == b'_'), "{name} is no identifier");
    let letters = name.trim_end_matches(|c: char| c.is_ascii_digit()).to_lowercase();
    assert!(
        !["v", "z", "tool", "wobj", "load", "fine", "vmax", "inpos"].contains(&&*letters),
        "{name} is the system's"
    );
}
