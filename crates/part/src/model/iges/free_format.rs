//! Free-format parameters: fields between delimiters, over many cards, with strings that state their own length.

use super::cards::Card;

/// The two delimiters a file has chosen.
#[derive(Debug, Clone, Copy)]
pub(super) struct Delimiters {
    /// Between parameters, usually a comma.
    pub(super) parameter: u8,
    /// After the last parameter, usually a semicolon.
    pub(super) record: u8,
}

/// One parameter.
#[derive(Debug, Clone, PartialEq)]
enum Field {
    /// Omitted: the default applies.
    Empty,
    /// A Hollerith string, `5Hwords`.
    Text(String),
    /// Anything else: a number or a pointer.
    Word(String),
}

/// The parameters of a record, with the line that each is on.
#[derive(Debug, Default)]
pub(super) struct Parameters {
    fields: Vec<(Field, usize)>,
}

/// Columns of many cards as one text; cards shorter than `width` are padded with blanks.
pub(super) struct Text {
    bytes: Vec<u8>,
    /// Line of the first card and how many columns each has: card k is on the k-th of the given lines.
    lines: Vec<usize>,
    width: usize,
}

impl Text {
    /// The first `width` columns of the cards.
    pub(super) fn new(cards: &[Card], width: usize) -> Self {
        let mut bytes = Vec::with_capacity(cards.len() * width);
        for card in cards {
            bytes.extend(card.text.iter().take(width));
            bytes.resize(bytes.len().next_multiple_of(width), b' ');
        }
        Self { bytes, lines: cards.iter().map(|card| card.line).collect(), width }
    }

    pub(super) fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    fn line(&self, at: usize) -> usize {
        self.lines.get(at / self.width).or(self.lines.last()).copied().unwrap_or_default()
    }

    /// Splits the text from byte `at` up to the record delimiter.
    ///
    /// # Errors
    /// The reason, with its line, when the delimiter is missing or a string is longer than the text.
    pub(super) fn split(&self, mut at: usize, delimiters: Delimiters) -> Result<Parameters, String> {
        let mut parameters = Parameters::default();
        loop {
            let line = self.line(at);
            let (field, end) = self.field(at, delimiters)?;
            parameters.fields.push((field, line));
            match self.bytes.get(end) {
                Some(&b) if b == delimiters.record => return Ok(parameters),
                Some(_) => at = end + 1,
                None => {
                    let record = delimiters.record.escape_ascii();
                    return Err(format!(
                        "line {} ends without the \"{record}\" that closes the record",
                        self.line(end)
                    ));
                }
            }
        }
    }

    /// The field from byte `at`, and where its delimiter is.
    fn field(&self, at: usize, delimiters: Delimiters) -> Result<(Field, usize), String> {
        let rest = self.bytes.get(at..).unwrap_or_default();
        let is_end = |b: &u8| *b == delimiters.parameter || *b == delimiters.record;
        let blank = rest.iter().take_while(|b| **b == b' ').count();
        let digits = rest[blank..].iter().take_while(|b| b.is_ascii_digit()).count();
        if digits > 0 && rest.get(blank + digits) == Some(&b'H') {
            let count: usize = ascii(&rest[blank..blank + digits]).parse().unwrap_or(usize::MAX);
            let start = blank + digits + 1;
            let Some(text) = start.checked_add(count).and_then(|end| rest.get(start..end)) else {
                let (line, digits) = (self.line(at), ascii(&rest[blank..blank + digits]));
                return Err(format!("the string of {digits} characters on line {line} is longer than the section"));
            };
            let behind = rest[start + count..].iter().position(is_end);
            let end = behind.map_or(self.bytes.len(), |behind| at + start + count + behind);
            return Ok((Field::Text(String::from_utf8_lossy(text).into_owned()), end));
        }
        let length = rest.iter().position(is_end).unwrap_or(rest.len());
        let word: Vec<u8> = rest[..length].iter().copied().filter(|b| !b.is_ascii_whitespace()).collect();
        let field = if word.is_empty() { Field::Empty } else { Field::Word(ascii(&word)) };
        Ok((field, at + length))
    }
}

fn ascii(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

impl Parameters {
    /// Number of parameters; they are counted from 0 throughout.
    pub(super) fn len(&self) -> usize {
        self.fields.len()
    }

    /// Parameter `i` as a number; 0 if omitted.
    ///
    /// # Errors
    /// The reason, with number and line, when it is missing or not a finite number.
    pub(super) fn real(&self, i: usize) -> Result<f64, String> {
        match self.get(i)? {
            (Field::Empty, _) => Ok(0.0),
            (Field::Word(word), line) => real(word).ok_or_else(|| not_a(i, line, word, "number")),
            (Field::Text(text), line) => Err(not_a(i, line, text, "number")),
        }
    }

    /// Parameter `i` as a whole number; 0 if omitted.
    ///
    /// # Errors
    /// As [`Parameters::real`].
    pub(super) fn integer(&self, i: usize) -> Result<i64, String> {
        let value = self.real(i)?;
        // Some programs write whole numbers with a decimal point.
        if value.fract() == 0.0 && value.abs() < 1e15 {
            return Ok(value as i64);
        }
        Err(format!("parameter {i} is {value}, not a whole number"))
    }

    /// Parameter `i` as the number of items that follow, each of `size` parameters.
    ///
    /// # Errors
    /// As [`Parameters::real`], and when the record has fewer items.
    pub(super) fn count(&self, i: usize, size: usize) -> Result<usize, String> {
        let value = self.integer(i)?;
        let room = self.len().saturating_sub(i + 1) / size.max(1);
        match usize::try_from(value) {
            Ok(count) if count <= room => Ok(count),
            _ => Err(format!("parameter {i} announces {value} items, but there are values for {room} at most")),
        }
    }

    /// Parameter `i` as a string; empty if omitted.
    pub(super) fn text(&self, i: usize) -> &str {
        match self.fields.get(i) {
            Some((Field::Text(text) | Field::Word(text), _)) => text.trim(),
            _ => "",
        }
    }

    /// Whether parameter `i` was given.
    pub(super) fn has(&self, i: usize) -> bool {
        self.fields.get(i).is_some_and(|(field, _)| *field != Field::Empty)
    }

    fn get(&self, i: usize) -> Result<(&Field, usize), String> {
        match self.fields.get(i) {
            Some((field, line)) => Ok((field, *line)),
            None => Err(format!("parameter {i} is missing (the record has {})", self.len().saturating_sub(1))),
        }
    }
}

fn not_a(i: usize, line: usize, word: &str, what: &str) -> String {
    let shown: String = word.chars().take(24).collect();
    format!("parameter {i} on line {line} is \"{shown}\", not a {what}")
}

/// A finite number in Fortran spelling: `1.5D-3`, `2.`, `.5E+02`, `-7`.
fn real(word: &str) -> Option<f64> {
    let is_plain = word.bytes().all(|b| b.is_ascii_digit() || b"+-.eEdD".contains(&b));
    let value: f64 = word.replace(['d', 'D'], "e").parse().ok()?;
    (is_plain && value.is_finite()).then_some(value)
}
