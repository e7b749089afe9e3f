//! A RAPID module: its statements, procedures and data.

use crate::dialect::reading::trace::Stated;
use crate::dialect::reading::words::{name, number, strip_word};
use glam::{DQuat, DVec3};
use std::collections::HashMap;
use std::ops::Range;

/// Lines that are statements although they do not end with `;`.
const LINES: [&str; 21] = [
    "MODULE",
    "ENDMODULE",
    "PROC",
    "ENDPROC",
    "FUNC",
    "ENDFUNC",
    "TRAP",
    "ENDTRAP",
    "ELSE",
    "ENDIF",
    "ENDFOR",
    "ENDWHILE",
    "TEST",
    "ENDTEST",
    "CASE",
    "DEFAULT",
    "RECORD",
    "ENDRECORD",
    "ERROR",
    "UNDO",
    "BACKWARD",
];

/// Data types whose values matter.
const KINDS: [&str; 8] =
    ["ROBTARGET", "SPEEDDATA", "WELDDATA", "SEAMDATA", "NUM", "WOBJDATA", "JOINTTARGET", "WEAVEDATA"];

/// A value of named data.
#[derive(Clone, Copy)]
pub(super) enum Value {
    /// A robtarget.
    Target(Target),
    /// External axes of a jointtarget.
    Joints([Option<f64>; 6]),
    /// Whether a work object moves with a mechanical unit.
    WorkObject(bool),
    /// Length of a weave, and dwell at its left side, mm; for some types the length is a frequency.
    Weave([f64; 2]),
    /// Speed, mm/s, or a plain number.
    Speed(f64),
    /// Times that the torch stands still at the start and at the end of a seam, s.
    Seam([f64; 2]),
}

/// A robtarget.
#[derive(Clone, Copy)]
pub(super) struct Target {
    /// Position, mm.
    pub(super) at: DVec3,
    pub(super) stated: Stated,
    /// Whether its configuration is all 0, as when it is unknown.
    pub(super) unconfigured: bool,
}

/// A module.
pub(super) struct Module {
    /// Name by which it was requested; `None` for the main file.
    pub(super) name: Option<String>,
    /// The text with blanks in place of comments.
    pub(super) text: String,
    /// Text range and line (from 1) of each statement.
    statements: Vec<(Range<usize>, usize)>,
    /// Name in upper case and statements of each procedure.
    procs: Vec<(String, Range<usize>)>,
    data: HashMap<String, Value>,
}

impl Module {
    pub(super) fn new(name: Option<&str>, text: &str) -> Self {
        let text = without_comments(text);
        let statements = statements(&text);
        let procs = procs(&text, &statements);
        Self { name: name.map(str::to_owned), text, statements, procs, data: HashMap::new() }
    }

    pub(super) fn proc(&self, name: &str) -> Option<usize> {
        self.procs.iter().position(|p| p.0.eq_ignore_ascii_case(name))
    }

    pub(super) fn first_proc(&self) -> Option<usize> {
        (!self.procs.is_empty()).then_some(0)
    }

    /// Statements of a procedure with their lines.
    pub(super) fn body(&self, proc: usize) -> impl Iterator<Item = (&str, usize)> {
        self.statements[self.procs[proc].1.clone()].iter().map(|(range, line)| (&self.text[range.clone()], *line))
    }

    /// Line, type, name and value of all data that matter, including those within procedures.
    pub(super) fn declarations(&self) -> Vec<(usize, &'static str, String, String)> {
        let declaration = |(range, line): &(Range<usize>, usize)| {
            let (left, value) = self.text[range.clone()].split_once(":=")?;
            let mut words = left.split_whitespace().rev();
            let (variable, kind) = (words.next()?, words.next()?);
            let kind = KINDS.into_iter().find(|k| k.eq_ignore_ascii_case(kind))?;
            Some((*line, kind, variable.to_owned(), value.trim().to_owned()))
        };
        self.statements.iter().filter_map(declaration).collect()
    }

    /// Whether the array with this name has only zeros.
    pub(super) fn zeros(&self, array: &str) -> bool {
        let of = |(range, _): &(Range<usize>, usize)| {
            let (left, value) = self.text[range.clone()].split_once(":=")?;
            let name = left.split_whitespace().next_back()?.split('{').next()?;
            name.eq_ignore_ascii_case(array).then_some(value)
        };
        let value = self.statements.iter().find_map(of);
        value.is_some_and(|value| value.trim_matches(['[', ']', ' ']).split(',').all(|v| number(v) == Some(0.0)))
    }

    pub(super) fn set(&mut self, variable: &str, value: Value) {
        self.data.insert(variable.to_ascii_uppercase(), value);
    }

    pub(super) fn get(&self, variable: &str) -> Option<Value> {
        self.data.get(&variable.to_ascii_uppercase()).copied()
    }
}

/// Replaces comments (`! ..` up to the line's end) by blanks, so that everything else keeps its position.
fn without_comments(text: &str) -> String {
    let (mut quoted, mut comment) = (false, false);
    let blank = |b: u8| {
        match b {
            b'\n' => (quoted, comment) = (false, false),
            b'"' if !comment => quoted = !quoted,
            b'!' if !quoted => comment = true,
            _ => {}
        }
        if comment { b' ' } else { b }
    };
    String::from_utf8_lossy(&text.bytes().map(blank).collect::<Vec<u8>>()).into_owned()
}

/// Splits at `;` outside quotes, and at the end of lines that begin or end a block.
fn statements(text: &str) -> Vec<(Range<usize>, usize)> {
    let mut found = Vec::new();
    let (mut line, mut start, mut quoted) = (1, None, false);
    for (i, b) in text.bytes().enumerate() {
        let ends = match b {
            b'"' => {
                quoted = !quoted;
                false
            }
            b';' => !quoted,
            b'\n' => {
                quoted = false;
                start.is_some_and(|(from, _)| stands_alone(&text[from..i]))
            }
            _ => false,
        };
        if ends {
            found.extend(start.take().map(|(from, line)| (trimmed(text, from..i), line)));
        } else if !b.is_ascii_whitespace() && b != b';' && start.is_none() {
            start = Some((i, line));
        }
        line += usize::from(b == b'\n');
    }
    found.extend(start.map(|(from, line)| (trimmed(text, from..text.len()), line)));
    found
}

fn trimmed(text: &str, range: Range<usize>) -> Range<usize> {
    range.start..range.start + text[range.clone()].trim_end().len()
}

fn stands_alone(text: &str) -> bool {
    let text = text.trim_end();
    let text = strip_word(text, "LOCAL").unwrap_or(text);
    let (word, _) = name(text);
    let closed = text.matches('(').count() == text.matches(')').count();
    let ends = |last: &str| text.len() > last.len() && text.to_ascii_uppercase().ends_with(last);
    match word.to_ascii_uppercase().as_str() {
        "" => text.starts_with('%'),
        "IF" | "ELSEIF" => ends("THEN"),
        "FOR" | "WHILE" => ends("DO"),
        "VERSION" | "LANGUAGE" => true,
        word => closed && LINES.contains(&word),
    }
}

fn procs(text: &str, statements: &[(Range<usize>, usize)]) -> Vec<(String, Range<usize>)> {
    let mut procs: Vec<(String, Range<usize>)> = Vec::new();
    let mut open = None;
    for (i, (range, _)) in statements.iter().enumerate() {
        let statement = &text[range.clone()];
        let statement = strip_word(statement, "LOCAL").unwrap_or(statement);
        if let Some(head) = strip_word(statement, "PROC") {
            open = Some((name(head).0.to_ascii_uppercase(), i + 1));
        } else if strip_word(statement, "ENDPROC").is_some() {
            procs.extend(open.take().map(|(name, from)| (name, from..i)));
        }
    }
    procs
}

/// The first number of an aggregate.
pub(super) fn first_number(text: &str) -> Option<f64> {
    number(text.trim_start().trim_start_matches('[').split([',', ']']).next()?)
}

/// The times that the torch stands still at the start (gas, ignition) and at the end of a seam (crater, burnback, wire
/// retraction, gas), s; `None` if the seamdata do not have the components of RobotWare Arc 6.
pub(super) fn seam_times(text: &str) -> Option<[f64; 2]> {
    const PARTS: usize = 48;
    let numbers = text.split([',', '[', ']']).filter(|part| !part.trim().is_empty()).map(number);
    let parts: Vec<f64> = numbers.collect::<Option<_>>()?;
    let sum = |places: &[usize]| places.iter().map(|&i| parts[i].max(0.0)).sum();
    // Preflow and delay of the move; filling, burnback, rollback and postflow. Each arcdata has nine components.
    (parts.len() == PARTS).then(|| [sum(&[1, 11]), sum(&[26, 36, 37, 47])])
}

/// A value of 9E9 or more stands for an axis that does not exist.
fn axis(value: f64) -> Option<f64> {
    (value < 9e8).then_some(value)
}

/// A robtarget as a literal, or the text that is not a number; anything after its position may be omitted.
pub(super) fn target(text: &str) -> Result<Target, &str> {
    let at = DVec3::from_array(three_numbers(text)?);
    let numbers: Vec<f64> = text.split([',', '[', ']']).filter_map(number).collect();
    let mut stated = Stated::default();
    if let [_, _, _, w, x, y, z, ..] = numbers[..] {
        stated.tool = Some(DQuat::from_xyzw(x, y, z, w)).filter(|tool| (tool.length() - 1.0).abs() < 0.01);
    }
    if let Some(axes) = numbers.get(11..17) {
        stated.axes = std::array::from_fn(|i| axis(axes[i]));
    }
    Ok(Target { at, stated, unconfigured: numbers.get(7..11).is_some_and(|conf| conf == [0.0; 4]) })
}

/// The external axes of a jointtarget as a literal.
pub(super) fn external_axes(text: &str) -> Option<[Option<f64>; 6]> {
    let numbers: Vec<f64> = text.split([',', '[', ']']).filter_map(number).collect();
    let axes = numbers.get(6..12)?;
    Some(std::array::from_fn(|i| axis(axes[i])))
}

/// Whether a work object, as a literal, moves with a mechanical unit: its user frame is not fixed.
pub(super) fn moves_with_unit(text: &str) -> Option<bool> {
    let mut fields = text.trim_start().strip_prefix('[')?.split(',').map(str::trim);
    let (_, fixed) = (fields.next()?, fields.next()?);
    Some(fixed.eq_ignore_ascii_case("FALSE"))
}

/// Length, and dwell at the left side, of weavedata as a literal, mm.
pub(super) fn weave(text: &str) -> Option<[f64; 2]> {
    let numbers: Vec<f64> = text.split([',', '[', ']']).filter_map(number).collect();
    Some([*numbers.get(2)?, *numbers.get(5)?])
}

/// The first three numbers of an aggregate, or the text that is not a number.
fn three_numbers(text: &str) -> Result<[f64; 3], &str> {
    let inside = text.trim_start_matches(|c: char| c == '[' || c.is_whitespace());
    let mut fields = inside.split([',', ']']);
    let mut next = || {
        let field = fields.next().unwrap_or_default();
        number(field).ok_or(if field.trim().is_empty() { text } else { field })
    };
    Ok([next()?, next()?, next()?])
}

/// The file's name without folder and extension, from the last string of a `Load`.
pub(super) fn stem(text: &str) -> Option<&str> {
    let path = text.rsplit('"').nth(1)?;
    let file = path.rsplit(['/', '\\', ':']).next()?;
    Some(file.rsplit_once('.').map_or(file, |(stem, _)| stem))
}
