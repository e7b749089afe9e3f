//! Beads as a table: one line per piece, units in the header.

use super::table::{COUNTS, KIND, measures};
use super::{Beads, ExportError, Format};
use crate::number::push_fixed;

pub(super) const FORMAT: Format =
    Format { extension: "csv", purpose: "a table of all pieces, for spreadsheets and pandas", write };

fn write(beads: &Beads<'_>) -> Result<Vec<u8>, ExportError> {
    let pieces = beads.pieces();
    let mut text = String::with_capacity(256 + 120 * pieces.len());
    let measures = measures(beads);
    let names: Vec<&str> =
        COUNTS.iter().map(|(name, _)| *name).chain([KIND]).chain(measures.iter().map(|m| m.name)).collect();
    text.push_str(&names.join(","));
    text.push('\n');
    for piece in &pieces {
        COUNTS.iter().for_each(|(_, count)| text.push_str(&format!("{},", count(piece))));
        text.push_str(piece.kind.name());
        for column in &measures {
            text.push(',');
            push_fixed(&mut text, (column.value)(piece), column.decimals);
        }
        text.push('\n');
    }
    Ok(text.into_bytes())
}
