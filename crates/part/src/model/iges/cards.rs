//! The cards of a file: column 73 holds the letter of the section, columns 74 to 80 count within it.

use super::IgesError;

/// Column of the section letter, from 0.
const LETTER: usize = 72;

/// Columns of a card.
const WIDTH: usize = 80;

/// One card.
#[derive(Debug, Clone, Copy)]
pub(super) struct Card<'a> {
    /// Line in the file, from 1.
    pub(super) line: usize,
    /// Columns 1 to 72.
    pub(super) text: &'a [u8],
}

/// The sections; the start section, a text for people, is skipped.
#[derive(Debug, Default)]
pub(super) struct Cards<'a> {
    pub(super) global: Vec<Card<'a>>,
    pub(super) directory: Vec<Card<'a>>,
    pub(super) parameters: Vec<Card<'a>>,
    /// Numbers of G, D and P cards that the last card announces, if it does.
    pub(super) announced: Vec<(char, usize)>,
}

/// Sorts the lines into sections.
///
/// # Errors
/// [`IgesError`] when this is not IGES in fixed format, a card is broken or out of order, or the end is missing.
pub(super) fn sort(bytes: &[u8]) -> Result<Cards<'_>, IgesError> {
    if bytes.iter().all(u8::is_ascii_whitespace) {
        return Err(if bytes.is_empty() { IgesError::Empty } else { not_iges("it holds nothing but white space") });
    }
    let mut cards = Cards::default();
    let (mut section, mut last_line) = (None, 0);
    for (line, text) in lines(bytes).filter(|(_, text)| !text.iter().all(u8::is_ascii_whitespace)) {
        let letter = text.get(LETTER).copied();
        if section.is_none() {
            check_first(line, letter)?;
        }
        let rank = letter.and_then(|l| b"SGDPT".iter().position(|s| *s == l));
        let Some(rank) = rank else { return Err(bad_letter(bytes, line, text)) };
        if section.is_some_and(|before| rank < before) {
            let (this, before) = (b"SGDPT"[rank], b"SGDPT"[section.unwrap_or_default()]);
            let reason = format!("a card of section {} follows section {}", char::from(this), char::from(before));
            return Err(IgesError::Card { line, reason });
        }
        section = Some(rank);
        last_line = line;
        let card = Card { line, text: &text[..LETTER] };
        match rank {
            1 => cards.global.push(card),
            2 => cards.directory.push(card),
            3 => cards.parameters.push(card),
            4 => {
                cards.announced = announced(card.text);
                break;
            }
            _ => {}
        }
    }
    check_complete(&cards, section, last_line)?;
    Ok(cards)
}

/// Lines with their numbers; a file without any line ends is cut every 80 columns.
fn lines(bytes: &[u8]) -> Box<dyn Iterator<Item = (usize, &[u8])> + '_> {
    let end = [b'\n', b'\r'].into_iter().find(|end| bytes.contains(end));
    match end {
        Some(end) => Box::new(bytes.split(move |b| *b == end).map(trim_return).enumerate().map(|(i, l)| (i + 1, l))),
        None => Box::new(bytes.chunks(WIDTH).enumerate().map(|(i, l)| (i + 1, l))),
    }
}

fn trim_return(line: &[u8]) -> &[u8] {
    line.strip_suffix(b"\r").unwrap_or(line)
}

fn not_iges(reason: &str) -> IgesError {
    IgesError::NotIges { reason: reason.to_owned() }
}

fn check_first(line: usize, letter: Option<u8>) -> Result<(), IgesError> {
    match letter {
        Some(b'S' | b'G') => Ok(()),
        Some(b'C') => Err(IgesError::OtherForm { form: "compressed" }),
        Some(b'B') => Err(IgesError::OtherForm { form: "binary" }),
        _ => Err(IgesError::NotIges { reason: format!("line {line} has no S in column 73") }),
    }
}

/// The error for a line without a section letter: the last one was cut off, any other is broken.
fn bad_letter(bytes: &[u8], line: usize, text: &[u8]) -> IgesError {
    let is_last = lines(bytes).skip(line).all(|(_, rest)| rest.iter().all(u8::is_ascii_whitespace));
    if text.len() <= LETTER && is_last {
        let reason = format!("line {line}, the last, ends in column {}, and no T card follows", text.len());
        return IgesError::Truncated { reason };
    }
    let reason = match text.get(LETTER) {
        Some(&letter) => format!("column 73 holds \"{}\", not S, G, D, P or T", letter.escape_ascii()),
        None => format!("it ends in column {}, and the section letter belongs in column 73", text.len()),
    };
    IgesError::Card { line, reason }
}

fn check_complete(cards: &Cards, section: Option<usize>, last_line: usize) -> Result<(), IgesError> {
    if section != Some(4) {
        return Err(IgesError::Truncated { reason: format!("it ends at line {last_line} without a T card") });
    }
    match [(&cards.global, "global"), (&cards.directory, "directory")].iter().find(|(cards, _)| cards.is_empty()) {
        Some((_, name)) => {
            Err(IgesError::Card { line: last_line, reason: format!("the file ends without a {name} section") })
        }
        None => Ok(()),
    }
}

/// Letters and numbers of the last card: `S      2G      4D     24P     14`.
fn announced(text: &[u8]) -> Vec<(char, usize)> {
    let (fields, _) = text.as_chunks::<8>();
    let count = |field: &[u8; 8]| {
        let number = std::str::from_utf8(&field[1..]).ok()?.trim().parse().ok()?;
        b"GDP".contains(&field[0]).then_some((char::from(field[0]), number))
    };
    fields.iter().filter_map(count).collect()
}
