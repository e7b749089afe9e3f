//! Several solids in one 3MF file, each an object with its name.

use super::ExportError;
use super::archive::{Archive, MODEL};
use crate::model::Mesh;
use crate::number::fixed;
use crate::report::escape;
use std::fmt::Write as _;

/// A 3MF file (core specification 1.3) with these solids, mm, where they are.
///
/// # Errors
/// [`ExportError`] where the archive cannot be written.
pub fn threemf(solids: &[(&str, &Mesh)]) -> Result<Vec<u8>, ExportError> {
    let mut archive = Archive::new()?;
    archive.add(MODEL, &model(solids))?;
    archive.finish()
}

fn model(solids: &[(&str, &Mesh)]) -> String {
    let mut text = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<model unit=\"millimeter\" xml:lang=\"en-US\" \
                    xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\">\n<resources>\n"
        .to_owned();
    for (number, (name, mesh)) in solids.iter().enumerate() {
        _ = writeln!(text, "<object id=\"{}\" type=\"model\" name=\"{}\"><mesh><vertices>", number + 1, escape(name));
        for v in &mesh.vertices {
            let [x, y, z] = v.to_array().map(|length| fixed(length, DECIMALS));
            _ = writeln!(text, "<vertex x=\"{x}\" y=\"{y}\" z=\"{z}\"/>");
        }
        text.push_str("</vertices><triangles>\n");
        for [a, b, c] in &mesh.triangles {
            _ = writeln!(text, "<triangle v1=\"{a}\" v2=\"{b}\" v3=\"{c}\"/>");
        }
        text.push_str("</triangles></mesh></object>\n");
    }
    text.push_str("</resources>\n<build>\n");
    (1..=solids.len()).for_each(|id| _ = writeln!(text, "<item objectid=\"{id}\"/>"));
    text + "</build>\n</model>\n"
}

/// 0.01 µm.
const DECIMALS: usize = 5;
