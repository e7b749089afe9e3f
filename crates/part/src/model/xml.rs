//! Common to the readers of XML files: elements in sequence, with their attributes, in bounded memory.

use super::ImportError;
use quick_xml::events::{BytesStart, Event};
use quick_xml::{Reader, XmlVersion};
use std::io::BufRead;

/// An XML file read element by element.
pub struct Elements<R> {
    reader: Reader<R>,
    buffer: Vec<u8>,
    format: &'static str,
    depth: usize,
}

/// The next item of the file; names have no prefix.
pub enum Step {
    /// An element begins; an empty one has no end of its own.
    Begin(Element),
    /// An element ends.
    End(String),
    /// Text.
    Text(String),
}

/// The beginning of an element.
pub struct Element(BytesStart<'static>);

/// Deepest nesting of elements.
const DEEPEST: usize = 256;

impl<R: BufRead> Elements<R> {
    pub fn new(text: R, format: &'static str) -> Self {
        Self { reader: Reader::from_reader(text), buffer: Vec::new(), format, depth: 0 }
    }

    /// The next step; `None` at the end of the file.
    pub fn step(&mut self) -> Result<Option<Step>, ImportError> {
        loop {
            self.buffer.clear();
            let place = self.reader.buffer_position();
            let broken =
                |reason: String| ImportError::Broken { format: self.format, reason: format!("byte {place}: {reason}") };
            match self.reader.read_event_into(&mut self.buffer) {
                Err(error) => return Err(broken(error.to_string())),
                Ok(Event::Start(_)) if self.depth >= DEEPEST => {
                    return Err(broken(format!("elements are nested more than {DEEPEST} deep")));
                }
                Ok(Event::Start(start)) => {
                    self.depth += 1;
                    return Ok(Some(Step::Begin(Element(start.into_owned()))));
                }
                Ok(Event::Empty(start)) => {
                    return Ok(Some(Step::Begin(Element(start.into_owned()))));
                }
                Ok(Event::End(end)) => {
                    self.depth = self.depth.saturating_sub(1);
                    return Ok(Some(Step::End(end.local_name().as_ref().to_owned())));
                }
                Ok(Event::Text(text)) => return Ok(Some(Step::Text(text.to_string()))),
                Ok(Event::DocType(_)) => return Err(broken("a DOCTYPE is not allowed here".to_owned())),
                Ok(Event::Eof) => {
                    let open = self.depth > 0;
                    return if open { Err(broken("it ends within an element".to_owned())) } else { Ok(None) };
                }
                Ok(_) => {}
            }
        }
    }
}

impl Element {
    /// Its name without prefix.
    pub fn name(&self) -> &str {
        self.0.local_name().into_inner()
    }

    /// The attribute of this name, with any prefix.
    pub fn attribute(&self, name: &str) -> Option<String> {
        let own = |key: &str| key.rsplit(':').next() == Some(name);
        self.attributes().into_iter().find(|(key, _)| own(key)).map(|(_, value)| value)
    }

    /// The attributes with their full names, prefix included.
    pub fn attributes(&self) -> Vec<(String, String)> {
        let mut found = Vec::new();
        for attribute in self.0.attributes().with_checks(false).flatten() {
            let value = attribute.normalized_value(XmlVersion::Explicit1_0).unwrap_or_default().into_owned();
            found.push((attribute.key.as_ref().to_owned(), value));
        }
        found
    }

    /// An attribute that must hold a number.
    pub fn number<T: std::str::FromStr>(&self, name: &str) -> Result<T, String> {
        let text = self.attribute(name).ok_or_else(|| format!("<{}> lacks {name}", self.name()))?;
        text.trim().parse().map_err(|_| format!("{name}=\"{text}\" in <{}> is not a number", self.name()))
    }
}
