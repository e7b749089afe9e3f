//! Beads as a table: one line a piece, units in the head.

use super::{Beads, ExportError, Format};
use crate::number::push_fixed;

pub(super) const FORMAT: Format =
    Format { extension: "csv", purpose: "a table of all pieces, for spreadsheets and pandas", write };

const HEAD: &str = "layer,pass,kind,x0 (mm),y0 (mm),z0 (mm),x1 (mm),y1 (mm),z1 (mm),width (mm),height (mm),speed (mm/s),\
                    pace (mm/s),wire feed (ratio),start (s),time (s)\n";

fn write(beads: &Beads<'_>) -> Result<Vec<u8>, ExportError> {
    let pieces = beads.pieces();
    let mut text = String::with_capacity(HEAD.len() + 120 * pieces.len());
    text.push_str(HEAD);
    for p in &pieces {
        text.push_str(&format!("{},{},{}", p.layer, p.pass, p.kind.name()));
        let [from, to] = [p.from, p.to];
        let places = [from.x, from.y, from.z, to.x, to.y, to.z];
        let values = [p.width, p.height, p.speed, p.pace, p.feed, p.start, p.seconds];
        for (value, decimals) in places.iter().map(|v| (*v, 4)).chain(values.iter().map(|v| (*v, 6))) {
            text.push(',');
            push_fixed(&mut text, value, decimals);
        }
        text.push('\n');
    }
    Ok(text.into_bytes())
}
