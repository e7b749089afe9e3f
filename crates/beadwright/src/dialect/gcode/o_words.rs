//! Branches in the O words of LinuxCNC, as far as their conditions are known.

use crate::dialect::reading::loops::holds;
use crate::dialect::reading::words::{compact, number};
use std::collections::{HashMap, HashSet};

/// The comparisons of LinuxCNC, and how others write them.
const SIGNS: [(&str, &str); 6] = [("LE", "<="), ("LT", "<"), ("GE", ">="), ("GT", ">"), ("EQ", "=="), ("NE", "!=")];

/// What M66 found: the input came in time.
const INPUT: (&str, f64) = ("#5399", 1.0);

/// What a line is.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Seen {
    /// A line to be read.
    Block,
    /// Nothing more to do.
    Done,
    /// A branch or a loop of which nothing is known: its lines are read once.
    Unknown,
}

/// Parameters, and branches that are open.
#[derive(Default)]
pub(super) struct OWords {
    values: HashMap<String, f64>,
    /// Branches that were taken.
    taken: HashSet<String>,
    /// The O word up to which lines are skipped.
    skipping: Option<String>,
}

impl OWords {
    /// Looks at a line before it is read.
    pub(super) fn see(&mut self, line: &[u8]) -> Seen {
        let line = line.trim_ascii_start();
        if self.skipping.is_none() && !matches!(line.first(), Some(b'O' | b'o' | b'#')) {
            return Seen::Block;
        }
        let text = String::from_utf8_lossy(line);
        let text = text.split([';', '(']).next().unwrap_or_default().trim();
        if let Some((parameter, value)) = text.split_once('=').filter(|(p, _)| p.starts_with('#')) {
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
        let keyword: String = rest.chars().take_while(char::is_ascii_alphabetic).collect::<String>().to_ascii_lowercase();
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
        // Names may hold the letters of a comparison: those are in angle brackets.
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
