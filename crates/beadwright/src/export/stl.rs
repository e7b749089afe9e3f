//! The shape as built as binary STL: the bodies of all beads, one after another.

use super::{Beads, ExportError, Format, swept};
use crate::model::stl;

pub(super) const FORMAT: Format =
    Format { extension: "stl", purpose: "the shape as built, each bead a closed body", write };

fn write(beads: &Beads<'_>) -> Result<Vec<u8>, ExportError> {
    let bodies = swept::bodies(beads);
    let solids = bodies.iter().map(|body| &body.solid);
    let facets = solids.flat_map(|solid| solid.triangles.iter().map(|t| t.map(|i| solid.vertices[i as usize])));
    if bodies.is_empty() {
        return Err(ExportError::Empty);
    }
    Ok(stl::write(&format!("{} as built by beadwright", beads.header.part), facets))
}
