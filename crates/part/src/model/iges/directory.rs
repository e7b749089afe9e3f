//! Directory entries: two cards of ten fields of eight columns each.

use super::cards::Card;
use super::{Dependence, IgesError};

/// One entity, as the directory describes it.
#[derive(Debug, Clone)]
pub(super) struct Entry {
    /// Number of its first D card, by which others point to it.
    pub(super) number: u32,
    pub(super) entity: u32,
    pub(super) form: i32,
    /// First P card, from 1, and number of P cards.
    pub(super) first_card: usize,
    pub(super) cards: usize,
    pub(super) level: i32,
    /// Directory entry of the matrix (124), or 0.
    pub(super) matrix: i64,
    pub(super) is_visible: bool,
    pub(super) dependence: Dependence,
    /// Entity use flag; 5 is a curve in the parameter plane of a surface.
    pub(super) usage: u32,
    pub(super) label: String,
}

/// Reads the directory section.
///
/// # Errors
/// [`IgesError::Card`] for a field that is not a number or a lone card at the end.
pub(super) fn read(cards: &[Card]) -> Result<Vec<Entry>, IgesError> {
    let (pairs, rest) = cards.as_chunks::<2>();
    if let Some(card) = rest.first() {
        let reason = "a directory entry has two cards, and the second is missing".to_owned();
        return Err(IgesError::Card { line: card.line, reason });
    }
    pairs.iter().enumerate().map(|(i, pair)| entry(2 * i as u32 + 1, pair)).collect()
}

fn entry(number: u32, [first, second]: &[Card; 2]) -> Result<Entry, IgesError> {
    let entity = integer(first, 1)?;
    let repeated = integer(second, 1)?;
    if entity != repeated && repeated != 0 {
        let reason = format!("the entry is of type {entity} on its first card and {repeated} on its second");
        return Err(IgesError::Card { line: second.line, reason });
    }
    let (digits, level, form) = (status(first), integer(first, 5)?, integer(second, 5)?);
    Ok(Entry {
        number,
        entity: u32::try_from(entity).unwrap_or_default(),
        form: i32::try_from(form).unwrap_or_default(),
        first_card: usize::try_from(integer(first, 2)?).unwrap_or_default(),
        cards: usize::try_from(integer(second, 4)?).unwrap_or_default(),
        level: i32::try_from(level).unwrap_or_default(),
        matrix: integer(first, 7)?,
        is_visible: digits / 1_000_000 == 0,
        dependence: match digits / 10_000 % 100 {
            1 => Dependence::Physical,
            2 => Dependence::Logical,
            3 => Dependence::Both,
            _ => Dependence::Independent,
        },
        usage: digits / 100 % 100,
        label: field(second, 8).trim().to_owned(),
    })
}

/// Field of a card, from 1.
fn field(card: &Card, number: usize) -> String {
    String::from_utf8_lossy(&card.text[8 * (number - 1)..8 * number]).into_owned()
}

/// A whole number; blank is 0.
fn integer(card: &Card, number: usize) -> Result<i64, IgesError> {
    let text = field(card, number);
    match text.trim() {
        "" => Ok(0),
        word => word.parse().map_err(|_| IgesError::Card {
            line: card.line,
            reason: format!("columns {} to {} hold \"{word}\", not a whole number", 8 * number - 7, 8 * number),
        }),
    }
}

/// The eight status digits as one number; blanks are zeros, and a field that is not a number counts as 0.
fn status(card: &Card) -> u32 {
    let digits: String = field(card, 9).replace(' ', "0");
    digits.parse().unwrap_or_default()
}
