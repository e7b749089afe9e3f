//! Several solids in one 3MF file, each an object with its name.

use super::ExportError;
use crate::model::Mesh;
use crate::number::fixed;
use crate::report::escape;
use std::fmt::Write as _;
use std::io::{Cursor, Write};
use zip::write::SimpleFileOptions;
use zip::{DateTime, ZipWriter};

const CONTENT_TYPES: &str = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n\
    <Types xmlns=\"http://schemas.openxmlformats.org/package/2006/content-types\">\n\
    <Default Extension=\"rels\" ContentType=\"application/vnd.openxmlformats-package.relationships+xml\"/>\n\
    <Default Extension=\"model\" ContentType=\"application/vnd.ms-package.3dmanufacturing-3dmodel+xml\"/>\n</Types>\n";

const RELATIONSHIPS: &str = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n\
    <Relationships xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\">\n\
    <Relationship Id=\"rel0\" Target=\"/3D/3dmodel.model\" \
    Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/>\n</Relationships>\n";

/// A 3MF file (core specification 1.3) with these solids, mm, where they are.
///
/// # Errors
/// [`ExportError`] where the archive cannot be written.
pub fn threemf(solids: &[(&str, &Mesh)]) -> Result<Vec<u8>, ExportError> {
    let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
    let options = SimpleFileOptions::default().last_modified_time(DateTime::default());
    let model = model(solids);
    for (name, text) in
        [("[Content_Types].xml", CONTENT_TYPES), ("_rels/.rels", RELATIONSHIPS), ("3D/3dmodel.model", &model)]
    {
        archive.start_file(name, options)?;
        archive.write_all(text.as_bytes())?;
    }
    Ok(archive.finish()?.into_inner())
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
