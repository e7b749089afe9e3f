//! The files of a plan: programs, `plan.json`, `metrics.json` and `report.html`.
//!
//! [`PlanFiles`] makes their text layer by layer, so the command and the desktop program write the same bytes.
//! [`Folder`] exchanges the files of a folder, all of them or none; it is the only part of the library that touches the disk,
//! and only with the feature `files`.

#[cfg(feature = "files")]
mod folder;
#[cfg(feature = "files")]
mod stage;

#[cfg(feature = "files")]
pub use folder::{Folder, FolderError, Written, write_file};

use crate::deposit::{Figures, Judgement};
use crate::dialect::{self, Chunk, DialectError, Job, Writer, writer};
use crate::layer::Layer;
use crate::model::RepairReport;
use crate::plan::{Header, Summary};
use crate::plan_file;
use crate::profile::Profile;
use crate::program::Programmer;
use crate::report::Report;
use std::collections::{BTreeMap, BTreeSet};

/// Name of the plan's file.
pub const PLAN: &str = "plan.json";
/// Name of the file of totals.
pub const METRICS: &str = "metrics.json";
/// Name of the report.
pub const REPORT: &str = "report.html";

/// Programs that are written together, layer by layer.
pub struct Programs {
    writers: Vec<Box<dyn Writer>>,
    programmer: Programmer,
}

impl Programs {
    /// Programs in these dialects.
    ///
    /// # Errors
    /// [`DialectError`] of the first dialect that cannot be written.
    pub fn new<S: AsRef<str>>(dialects: &[S], job: &Job<'_>) -> Result<Self, DialectError> {
        let (mut writers, mut taken) = (Vec::new(), BTreeMap::new());
        for name in dialects.iter().map(S::as_ref) {
            let second = dialect::find(name).map_or("", |dialect| dialect.name);
            // Asked of a writer of its own: the one that writes begins when the number of layers is known.
            let files: BTreeSet<String> = writer(name, job)?.begin(1).into_iter().map(|chunk| chunk.file).collect();
            for file in files {
                if let Some(first) = taken.insert(file.clone(), second) {
                    return Err(DialectError::SameFile { file, first, second });
                }
            }
            writers.push(writer(name, job)?);
        }
        Ok(Self { writers, programmer: job.programmer() })
    }

    fn each(&mut self, write: impl FnMut(&mut Box<dyn Writer>) -> Vec<Chunk>) -> Vec<Chunk> {
        self.writers.iter_mut().flat_map(write).collect()
    }

    fn begin(&mut self, layers: usize) -> Vec<Chunk> {
        self.each(|writer| writer.begin(layers))
    }

    fn layer(&mut self, layer: &Layer) -> Vec<Chunk> {
        let program = self.programmer.layer(layer);
        self.each(|writer| writer.layer(&program))
    }

    fn end(&mut self) -> Vec<Chunk> {
        self.each(|writer| writer.end())
    }
}

/// Makes the text of all files of a plan as its layers come.
pub struct PlanFiles {
    programs: Programs,
    report: Report,
    /// Index of the first layer of the programs.
    from_layer: usize,
    names: BTreeSet<String>,
}

impl PlanFiles {
    /// Begins the files of a plan and returns their first text; the programs begin with layer index `from_layer`.
    pub fn begin(header: &Header, profile: &Profile, mut programs: Programs, from_layer: usize) -> (Self, Vec<Chunk>) {
        let mut chunks = vec![Chunk::new(PLAN, plan_file::head(header, profile))];
        chunks.extend(programs.begin(header.layers));
        let report = Report::new(header, profile);
        let mut files = Self { programs, report, from_layer, names: BTreeSet::new() };
        files.note(&chunks);
        (files, chunks)
    }

    /// Takes the next layer, and what the deposit model says of it; returns their text.
    pub fn layer(&mut self, layer: &Layer, judgement: Option<&Judgement>) -> Vec<Chunk> {
        self.report.layer(layer, judgement);
        let mut chunks = vec![Chunk::new(PLAN, plan_file::layer(layer))];
        if layer.index >= self.from_layer {
            chunks.extend(self.programs.layer(layer));
        }
        self.note(&chunks);
        chunks
    }

    /// What people must know about the programs, once all layers are written: sentences.
    pub fn notes(&self) -> Vec<String> {
        self.programs.writers.iter().flat_map(|writer| writer.notes()).collect()
    }

    /// The last text of all files; `total` is what the deposit model says of all layers.
    pub fn end(mut self, summary: &Summary, repair: &RepairReport, total: Option<&Figures>) -> Vec<Chunk> {
        let mut chunks = self.programs.end();
        chunks.push(Chunk::new(PLAN, plan_file::tail()));
        self.note(&chunks);
        let names: Vec<String> = self.names.into_iter().chain([METRICS, REPORT].map(str::to_owned)).collect();
        let mut metrics = summary.json(total);
        // So that the next plan in this folder knows which files are those of this one.
        metrics["files"] = serde_json::json!(names);
        chunks.push(Chunk::new(METRICS, format!("{metrics:#}\n")));
        chunks.push(Chunk::new(REPORT, self.report.finish(summary, repair, &names)));
        chunks
    }

    fn note(&mut self, chunks: &[Chunk]) {
        for chunk in chunks {
            if !self.names.contains(&chunk.file) {
                self.names.insert(chunk.file.clone());
            }
        }
    }
}
