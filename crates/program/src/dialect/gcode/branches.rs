//! Evaluates branches whose conditions are known: O words of LinuxCNC, and forward jumps of Fanuc (`IF[#100GT0]GOTO1`),
//! Siemens (`IF R90>0 GOTOF LB1`) and TwinCAT NC I (`@126 R90 K0 K1`).

use crate::dialect::reading::loops::holds;
use crate::dialect::reading::words::{compact, number};
use std::collections::{HashMap, HashSet};

/// The comparisons of LinuxCNC, and how others write them.
const SIGNS: [(&str, &str); 6] = [("LE", "<="), ("LT", "<"), ("GE", ">="), ("GT", ">"), ("EQ", "=="), ("NE", "!=")];

/// The result of M66 if the input came in time.
const INPUT: (&str, f64) = ("#5399", 1.0);

/// How a line is to be treated.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Seen {
    /// A line to be read.
    Block,
    /// Nothing more to do.
    Done,
    /// A branch or a loop that cannot be evaluated: its lines are read once.
    Unknown,
}

/// Parameters, and open branches.
#[derive(Default)]
pub(super) struct Branches {
    values: HashMap<String, f64>,
    /// Branches that were taken.
    taken: HashSet<String>,
    /// The O word up to which lines are skipped.
    skipping: Option<String>,
    /// The block that a jump leads to: its number (`N1`) or its label (`LB1:`).
    target: Option<String>,
}

/// A line without its N number, if it sets a parameter or begins with a Siemens keyword that no block has.
pub(super) fn without_number(line: &[u8]) -> &[u8] {
    let Some(rest) = line.strip_prefix(b"N").or_else(|| line.strip_prefix(b"n")) else { return line };
    let digits = rest.iter().take_while(|b| b.is_ascii_digit()).count();
    let behind = rest[digits..].trim_ascii_start();
    let own = [&b"#"[..], b"TRANS", b"TRAORI", b"TRAFOOF"].into_iter().any(|word| behind.starts_with(word));
    if digits > 0 && own { behind } else { line }
}

/// Whether a line may be a branch, a label or an assignment, rather than a block.
fn begins_branch(line: &[u8]) -> bool {
    let word = |word: &[u8]| line.get(..word.len()).is_some_and(|head| head.eq_ignore_ascii_case(word));
    match line.first() {
        Some(b'O' | b'o' | b'#' | b'@') => true,
        Some(b'R' | b'r') => line.get(1).is_some_and(u8::is_ascii_digit) && line.contains(&b'='),
        Some(_) => word(b"IF") || word(b"GOTO") || line.trim_ascii_end().ends_with(b":"),
        None => false,
    }
}

/// Whether a text is a variable: `#100`, `#<_start>` or `R90`.
fn is_parameter(text: &str) -> bool {
    let number = |text: &str| !text.is_empty() && text.bytes().all(|b| b.is_ascii_digit());
    text.starts_with('#') || text.trim().strip_prefix(['R', 'r']).is_some_and(number)
}

/// The condition with the comparison signs of the other controls.
fn signs(condition: &str) -> String {
    let word = SIGNS.iter().find(|(word, _)| condition.contains(word));
    word.map_or_else(|| condition.to_owned(), |(word, sign)| condition.replacen(word, sign, 1))
}

/// Condition and target of `@126 R90 K0 K1`, given without blanks and `@`: jumps if greater; `@100 K1` has no
/// condition.
fn at_jump(text: &str) -> Option<(Option<String>, String)> {
    let (code, rest) = text.split_at_checked(3)?;
    if code == "100" {
        return Some((None, format!("N{}", rest.strip_prefix('K')?)));
    }
    let sign = match code {
        "121" => "<>",
        "122" => "=",
        "123" => "<=",
        "124" => "<",
        "125" => ">=",
        "126" => ">",
        _ => return None,
    };
    let (variable, rest) = rest.split_once('K')?;
    let (value, target) = rest.split_once('K')?;
    Some((Some(format!("{variable}{sign}{value}")), format!("N{target}")))
}

impl Branches {
    /// Examines a line before it is read.
    pub(super) fn see(&mut self, line: &[u8]) -> Seen {
        let line = line.trim_ascii_start();
        if let Some(target) = &self.target {
            let first = line.split(|b| b.is_ascii_whitespace()).next().unwrap_or_default();
            if !first.eq_ignore_ascii_case(target.as_bytes()) {
                return Seen::Done;
            }
            self.target = None;
        }
        if self.skipping.is_none() && !begins_branch(line) {
            return Seen::Block;
        }
        let text = String::from_utf8_lossy(line);
        let text = text.split([';', '(']).next().unwrap_or_default().trim();
        if self.skipping.is_none()
            && let Some(seen) = self.jump(text)
        {
            return seen;
        }
        if let Some((parameter, value)) = text.split_once('=').filter(|(p, _)| is_parameter(p)) {
            return self.assign(parameter, value);
        }
        let word = text.split_once(char::is_whitespace).filter(|(word, _)| {
            word.strip_prefix(['O', 'o']).is_some_and(|n| !n.is_empty() && n.bytes().all(|b| b.is_ascii_digit()))
        });
        match word {
            Some((word, rest)) => self.word(&word.to_ascii_uppercase(), rest.trim()),
            None if self.skipping.is_some() => Seen::Done,
            None => Seen::Block,
        }
    }

    /// Evaluates a jump or a label; `None` if the line is neither.
    fn jump(&mut self, text: &str) -> Option<Seen> {
        if text.ends_with(':') {
            return Some(Seen::Done);
        }
        let flat = compact(text);
        let (condition, target) = if let Some(rest) = flat.strip_prefix('@') {
            at_jump(rest)?
        } else {
            let (condition, target) = flat.split_once("GOTO")?;
            let target = match target.strip_prefix('F') {
                Some(label) => format!("{label}:"),
                None => format!("N{target}"),
            };
            (condition.strip_prefix("IF").map(|c| signs(c.trim_matches(['[', ']']))), target)
        };
        // Without a condition the jump is always taken.
        let taken = condition.map_or(Some(true), |c| holds(&c, |name| self.values.get(name).copied()));
        match taken {
            Some(true) => self.target = Some(target),
            Some(false) => {}
            None => return Some(Seen::Unknown),
        }
        Some(Seen::Done)
    }

    fn assign(&mut self, parameter: &str, value: &str) -> Seen {
        let parameter = compact(parameter);
        match (self.skipping.is_some(), number(value)) {
            (true, _) => {}
            (false, Some(value)) => drop(self.values.insert(parameter, value)),
            (false, None) => drop(self.values.remove(&parameter)),
        }
        Seen::Done
    }

    fn word(&mut self, word: &str, rest: &str) -> Seen {
        let keyword: String =
            rest.chars().take_while(char::is_ascii_alphabetic).collect::<String>().to_ascii_lowercase();
        if let Some(open) = &self.skipping {
            if open == word && ["endif", "endwhile", "else"].contains(&keyword.as_str()) {
                self.skipping = None;
            }
            return Seen::Done;
        }
        match keyword.as_str() {
            "if" | "while" => match self.holds(&rest[keyword.len()..]) {
                Some(false) => self.skipping = Some(word.to_owned()),
                Some(true) if keyword == "if" => drop(self.taken.insert(word.to_owned())),
                _ => return Seen::Unknown,
            },
            "else" if self.taken.contains(word) => self.skipping = Some(word.to_owned()),
            "else" | "endif" | "endwhile" => {}
            _ => return Seen::Unknown,
        }
        Seen::Done
    }

    /// Whether `[#<_start> LE 70003]` holds.
    fn holds(&self, condition: &str) -> Option<bool> {
        let condition = compact(condition);
        let mut condition = condition.strip_prefix('[')?.strip_suffix(']')?.to_owned();
        // Names may contain the letters of a comparison, but are in angle brackets.
        let from = condition.find('>').map_or(0, |at| at + 1);
        let (at, (word, sign)) = SIGNS.iter().find_map(|s| Some((from + condition[from..].find(s.0)?, *s)))?;
        condition.replace_range(at..at + word.len(), "\u{1}");
        let (a, b) = condition.split_once('\u{1}')?;
        let value = |text: &str| {
            let known = self.values.get(text).copied();
            number(text).or(known).or_else(|| (text == INPUT.0).then_some(INPUT.1))
        };
        let (a, b) = (value(a)?, value(b)?);
        holds(&format!("{a}{sign}{b}"), |_| None)
    }
}
