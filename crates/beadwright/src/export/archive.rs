//! 3MF files: archives of parts that refer to each other (Open Packaging Conventions).

use super::ExportError;
use std::io::{Cursor, Write};
use zip::write::SimpleFileOptions;
use zip::{DateTime, ZipWriter};

const CONTENT_TYPES: &str = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n\
    <Types xmlns=\"http://schemas.openxmlformats.org/package/2006/content-types\">\n\
    <Default Extension=\"rels\" ContentType=\"application/vnd.openxmlformats-package.relationships+xml\"/>\n\
    <Default Extension=\"model\" ContentType=\"application/vnd.ms-package.3dmanufacturing-3dmodel+xml\"/>\n\
    <Default Extension=\"xml\" ContentType=\"application/xml\"/>\n</Types>\n";

const MODEL_TYPE: &str = "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel";
/// Path of the model file in the archive.
pub(super) const MODEL: &str = "/3D/3dmodel.model";

/// A file of relationships, each with its type and target.
pub(super) fn relationships<'t>(targets: impl Iterator<Item = (&'t str, String)>) -> String {
    let mut text = String::from(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n\
         <Relationships xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\">\n",
    );
    for (number, (kind, target)) in (1..).zip(targets) {
        text.push_str(&format!("<Relationship Id=\"rel{number}\" Type=\"{kind}\" Target=\"{target}\"/>\n"));
    }
    text.push_str("</Relationships>\n");
    text
}

/// The archive as it grows.
pub(super) struct Archive(ZipWriter<Cursor<Vec<u8>>>);

impl Archive {
    /// An archive with the files that each one needs: the content types by file extension, and where its model is.
    pub(super) fn new() -> Result<Self, ExportError> {
        let mut archive = Self(ZipWriter::new(Cursor::new(Vec::new())));
        archive.add("[Content_Types].xml", CONTENT_TYPES)?;
        archive.add("_rels/.rels", &relationships([(MODEL_TYPE, MODEL.to_owned())].into_iter()))?;
        Ok(archive)
    }

    /// Adds a file; all have the same date, so that the same plan gives the same bytes.
    pub(super) fn add(&mut self, path: &str, text: &str) -> Result<(), ExportError> {
        let options = SimpleFileOptions::default().last_modified_time(DateTime::default());
        self.0.start_file(path.trim_start_matches('/'), options)?;
        Ok(self.0.write_all(text.as_bytes())?)
    }

    pub(super) fn finish(self) -> Result<Vec<u8>, ExportError> {
        Ok(self.0.finish()?.into_inner())
    }
}
