//! Writes programs from the templates of a user-defined dialect, a layer at a time.

use super::data::Steps;
use super::environment::{FUEL, FUEL_PER_STEP};
use super::settings::{LineEnds, Settings};
use super::{BEGIN, END, FILE, LAYER, LAYER_FILE, Own, OwnError, data, explained};
use crate::dialect::writing::{Chunk, DialectError, Job, Writer};
use crate::program::LayerProgram;
use bead_plan::layer::Extent;
use minijinja::{Environment, Error, Value, context};
use std::collections::BTreeSet;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

/// Longest file name.
const LONGEST_NAME: usize = 120;

/// Writes the program of a part.
pub(super) struct OwnWriter {
    folder: String,
    settings: Settings,
    environment: Environment<'static>,
    /// The last number returned by `block()`.
    block: Arc<AtomicUsize>,
    steps: Steps,
    /// The names of the layers' files.
    layer_files: Vec<String>,
    /// All file names in lower case: Windows treats names that differ only in case as the same.
    taken: BTreeSet<String>,
    failure: Option<OwnError>,
}

impl OwnWriter {
    /// Begins the program of a part.
    pub(super) fn new(own: &Own, job: &Job<'_>) -> Self {
        let Own { folder, settings, mut environment } = own.clone();
        data::job(job).into_iter().for_each(|(name, value)| environment.add_global(name, value));
        environment.add_global("layers", 0);
        let block = Arc::new(AtomicUsize::new(0));
        let (counter, step, most) = (Arc::clone(&block), settings.block_step, settings.block_most);
        environment.add_function("block", move || {
            let next = counter.load(Relaxed) + step;
            let next = if next > most { step } else { next };
            counter.store(next, Relaxed);
            next
        });
        let (steps, layer_files, taken) = (Steps::new(job), Vec::new(), BTreeSet::new());
        Self { folder, settings, environment, block, steps, layer_files, taken, failure: None }
    }

    /// The templates, and the names available in all of them.
    pub(super) fn environment(&self) -> &Environment<'static> {
        &self.environment
    }

    fn render(&mut self, template: &str, steps: usize, data: Value) -> Result<String, OwnError> {
        self.environment.set_fuel(Some(FUEL + FUEL_PER_STEP * steps as u64));
        let rendered = self.environment.get_template(template).and_then(|template| template.render(data));
        rendered.map_err(|fault| explained(&self.folder, innermost(&fault)))
    }

    fn text(&mut self, template: &str, steps: usize, data: Value) -> Result<String, OwnError> {
        let text = self.render(template, steps, data)?;
        let odd = text.chars().find(|c| !(c.is_ascii_graphic() || matches!(c, ' ' | '\n' | '\t')));
        if let Some(odd) = odd {
            let reason = format!(
                "it writes {odd:?}, but controllers read printable ASCII characters only. Inside {{# … #}} any are allowed."
            );
            return Err(self.error(template, reason));
        }
        Ok(if self.settings.line_ends == LineEnds::Crlf { text.replace('\n', "\r\n") } else { text })
    }

    fn error(&self, file: &str, reason: String) -> OwnError {
        OwnError { folder: self.folder.clone(), file: file.to_owned(), line: None, reason }
    }

    /// The name of a file, checked to stay in the folder of the plan and not to be one of the plan's own files.
    fn file(&mut self, template: &str, data: Value) -> Result<String, OwnError> {
        let name = self.render(template, 0, data)?;
        let plain = |c: char| c.is_ascii_alphanumeric() || "_-+. ".contains(c);
        let reason = if name.is_empty() || name.len() > LONGEST_NAME {
            format!("a name of a file has 1 to {LONGEST_NAME} characters.")
        } else if !name.chars().all(plain) || name.starts_with(['.', ' ']) || name.ends_with(['.', ' ']) {
            "a name of a file holds letters, digits, spaces and _ - + . only, and no folder: programs go into the folder \
             of the plan. {{ name }} is the part's name in such characters."
                .to_owned()
        } else if [".json", ".html", ".svg"].iter().any(|end| name.to_ascii_lowercase().ends_with(end)) {
            "names that end in .json, .html or .svg are those of the plan's own files. Take another end.".to_owned()
        } else {
            return Ok(name);
        };
        Err(self.error(template, format!("\"{}\" cannot be written: {reason}", name.escape_debug())))
    }

    /// A part of the program in the main file.
    fn main(&mut self, template: &str, data: Value) -> Result<Vec<Chunk>, OwnError> {
        let file = self.file(FILE, context! {})?;
        // A folder without this template writes nothing here.
        let text = match self.environment.get_template(template) {
            Ok(_) => self.text(template, 0, data)?,
            Err(_) => String::new(),
        };
        Ok(vec![Chunk { file, text }])
    }

    /// The file that a layer goes into.
    fn layer_file(&mut self, number: usize) -> Result<String, OwnError> {
        let main = self.file(FILE, context! {})?;
        if self.settings.layer_file.is_none() {
            return Ok(main);
        }
        let file = self.file(LAYER_FILE, context! { layer => number })?;
        self.taken.insert(main.to_ascii_lowercase());
        if !self.taken.insert(file.to_ascii_lowercase()) {
            let reason = format!(
                "layer {number} would be written into {file}, which already holds another part of the program. Put {{{{ layer }}}} \
                 into the name."
            );
            return Err(self.error(LAYER_FILE, reason));
        }
        self.layer_files.push(file.clone());
        Ok(file)
    }

    fn try_layer(&mut self, program: &LayerProgram) -> Result<Vec<Chunk>, OwnError> {
        let number = program.index + 1;
        let file = self.layer_file(number)?;
        let steps = self.steps.layer(program);
        let count = steps.len();
        let data = context! { layer => number, z => program.z, steps => steps, file => &file };
        // A separate file has its own block numbers.
        let of_main = self.block.load(Relaxed);
        if self.settings.layer_file.is_some() {
            self.block.store(0, Relaxed);
        }
        let text = self.text(LAYER, count, data)?;
        if self.settings.layer_file.is_some() {
            self.block.store(of_main, Relaxed);
        }
        Ok(vec![Chunk { file, text }])
    }

    /// Records an error; nothing more is written after one.
    fn keep(&mut self, written: Result<Vec<Chunk>, OwnError>) -> Vec<Chunk> {
        written.unwrap_or_else(|error| {
            self.failure = Some(error);
            Vec::new()
        })
    }
}

/// The error inside an included template or a macro, which has the right location.
fn innermost(fault: &Error) -> &Error {
    let source = std::error::Error::source(fault).and_then(|source| source.downcast_ref::<Error>());
    source.filter(|source| source.name().is_some()).map_or(fault, innermost)
}

impl Writer for OwnWriter {
    fn begin(&mut self, extent: &Extent) -> Vec<Chunk> {
        self.environment.add_global("layers", extent.layers);
        let written = self.main(BEGIN, context! {});
        self.keep(written)
    }

    fn layer(&mut self, program: &LayerProgram) -> Vec<Chunk> {
        if program.instructions.is_empty() || self.failure.is_some() {
            return Vec::new();
        }
        let written = self.try_layer(program);
        self.keep(written)
    }

    fn end(&mut self) -> Vec<Chunk> {
        if self.failure.is_some() {
            return Vec::new();
        }
        let written = self.main(END, context! { layer_files => &self.layer_files });
        self.keep(written)
    }

    fn failure(&self) -> Option<DialectError> {
        self.failure.clone().map(DialectError::Own)
    }
}
