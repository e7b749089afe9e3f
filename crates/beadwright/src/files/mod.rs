//! The files of a plan: programs, `plan.json`, `metrics.json` and `report.html`.
//!
//! [`PlanFiles`] makes their text layer by layer, so the command and the desktop program write the same bytes.
//! [`Folder`] exchanges the files of a folder, all of them or none, and [`posts`] fetches dialects of your own; nothing else
//! in the library touches the disk, and these only with the feature `files`.

#[cfg(feature = "files")]
mod folder;
#[cfg(feature = "files")]
mod own_folder;
#[cfg(feature = "files")]
mod stage;

#[cfg(feature = "files")]
pub use folder::{Folder, FolderError, Written, write_file};
#[cfg(feature = "files")]
pub use own_folder::posts;

use crate::check::{self, LayerFigures};
use crate::deposit::stack::{Grown, Growth};
use crate::deposit::{Figures, Judgement};
use crate::dialect::own::Own;
use crate::dialect::{Chunk, DialectError, Job, Writer, writer};
use crate::finding::{Finding, Words};
use crate::layer::{Extent, Layer};
use crate::metrics::Metrics;
use crate::model::RepairReport;
use crate::plan::{self, Header, Summary};
use crate::plan_file;
use crate::profile::Profile;
use crate::program::{Programmer, Turns};
use crate::report::Report;
use crate::task::{Cancelled, Task};
use glam::DVec3;
use std::collections::{BTreeMap, BTreeSet};

/// Name of the plan's file.
pub const PLAN: &str = "plan.json";
/// Name of the file of totals.
pub const METRICS: &str = "metrics.json";
/// Name of the report.
pub const REPORT: &str = "report.html";
/// Name of the report on a plan whose programs are not written.
pub const REFUSED: &str = "refused.html";

/// What writes programs in a machine's language.
#[derive(Debug, Clone)]
pub enum Post {
    /// A dialect of the library, by its name.
    Named(String),
    /// A dialect of your own.
    Own(Box<Own>),
}

impl Post {
    fn name(&self) -> &str {
        match self {
            Self::Named(name) => name,
            Self::Own(own) => own.name(),
        }
    }

    fn writer(&self, job: &Job<'_>) -> Result<Box<dyn Writer>, DialectError> {
        match self {
            Self::Named(name) => writer(name, job),
            Self::Own(own) => own.writer(job),
        }
    }
}

/// Programs that are written together, layer by layer.
pub struct Programs {
    writers: Vec<Box<dyn Writer>>,
    /// For controllers that weave by themselves, and for others.
    programmers: [Programmer; 2],
    turns: Turns,
}

impl Programs {
    /// Programs in these dialects of the library.
    ///
    /// # Errors
    /// [`DialectError`] of the first dialect that cannot be written.
    pub fn new<S: AsRef<str>>(dialects: &[S], job: &Job<'_>) -> Result<Self, DialectError> {
        Self::of(&dialects.iter().map(|name| Post::Named(name.as_ref().to_owned())).collect::<Vec<_>>(), job)
    }

    /// Programs in these posts.
    ///
    /// # Errors
    /// [`DialectError`] of the first post that cannot be written.
    pub fn of(posts: &[Post], job: &Job<'_>) -> Result<Self, DialectError> {
        let (mut writers, mut taken) = (Vec::new(), BTreeMap::new());
        for post in posts {
            // A separate writer is asked: the one that writes begins when the number of layers is known.
            let files: BTreeSet<String> =
                post.writer(job)?.begin(&Extent::default()).into_iter().map(|chunk| chunk.file).collect();
            for file in files {
                let second = post.name().to_owned();
                if let Some(first) = taken.insert(file.clone(), second.clone()) {
                    return Err(DialectError::SameFile { file, first, second });
                }
            }
            writers.push(post.writer(job)?);
        }
        Ok(Self { writers, programmers: [true, false].map(|weaves| job.programmer(weaves)), turns: Turns::default() })
    }

    /// Why a program is not complete; then nothing may be kept.
    pub fn failure(&self) -> Option<DialectError> {
        self.writers.iter().find_map(|writer| writer.failure())
    }

    fn each(&mut self, write: impl FnMut(&mut Box<dyn Writer>) -> Vec<Chunk>) -> Vec<Chunk> {
        self.writers.iter_mut().flat_map(write).collect()
    }

    fn begin(&mut self, extent: &Extent) -> Vec<Chunk> {
        self.each(|writer| writer.begin(extent))
    }

    fn layer(&mut self, layer: &Layer, first: usize) -> Vec<Chunk> {
        let ready = self.turns.take(layer);
        ready.into_iter().flat_map(|layer| self.whole(&layer, first)).collect()
    }

    /// Adds a layer whose arc goes out at its end.
    fn whole(&mut self, layer: &Layer, first: usize) -> Vec<Chunk> {
        let mut chunks = Vec::new();
        for (weaves, programmer) in [true, false].into_iter().zip(&mut self.programmers) {
            if !self.writers.iter().any(|writer| writer.weaves() == weaves) {
                continue;
            }
            let program = programmer.layer_from(layer, first);
            let writers = self.writers.iter_mut().filter(|writer| writer.weaves() == weaves);
            chunks.extend(writers.flat_map(|writer| writer.layer(&program)));
        }
        chunks
    }

    /// Records a layer that is in no program.
    fn pass_over(&mut self, layer: &Layer) {
        self.programmers.iter_mut().for_each(|programmer| programmer.pass_over(layer));
    }

    fn end(&mut self) -> Vec<Chunk> {
        let mut chunks = self.turns.end().map(|turns| self.whole(&turns, 0)).unwrap_or_default();
        chunks.extend(self.each(|writer| writer.end()));
        chunks
    }
}

/// What programs weld: all of a plan, or less where a stopped build is continued.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Selection {
    /// Indices of the layers, from 0; `None` for all from the first one onwards.
    pub layers: Option<BTreeSet<usize>>,
    /// Index of the first layer, from 0.
    pub from: usize,
    /// Index of the first pass in it, from 0.
    pub pass: usize,
}

impl Selection {
    /// Whether the whole plan is selected.
    fn is_all(&self) -> bool {
        *self == Self::default()
    }

    /// Index of the first selected pass of a layer; `None` where the layer is in no program.
    fn first_pass(&self, layer: usize) -> Option<usize> {
        let chosen = self.layers.as_ref().is_none_or(|layers| layers.contains(&layer));
        (chosen && layer >= self.from).then_some(if layer == self.from { self.pass } else { 0 })
    }
}

/// Plans with more points than this are not checked as they are written, since that needs all their layers at once.
const MOST_CHECKED: usize = 2_000_000;

/// Makes the text of all files of a plan as its layers come.
pub struct PlanFiles {
    programs: Programs,
    report: Report,
    profile: Profile,
    /// The lowest and the highest place of the part, mm.
    part: (DVec3, DVec3),
    /// The layers so far, of a plan that is small enough to be checked, and their figures.
    layers: Vec<Layer>,
    figures: Vec<Figures>,
    points: usize,
    found: Option<Vec<Finding>>,
    /// The same one by one, for the report.
    all: Vec<Finding>,
    /// How the built part ends, once checked.
    built: Option<Growth>,
    selection: Selection,
    /// Totals of what the programs weld.
    totals: Metrics,
    names: BTreeSet<String>,
}

impl PlanFiles {
    /// Begins the files of a plan and returns their first text; the programs weld what `selection` says.
    ///
    /// # Errors
    /// [`DialectError`] where a post cannot write a part as large as this.
    pub fn begin(
        header: &Header,
        profile: &Profile,
        mut programs: Programs,
        selection: Selection,
    ) -> Result<(Self, Vec<Chunk>), DialectError> {
        let mut chunks = vec![Chunk::new(PLAN, plan_file::head(header, profile))];
        chunks.extend(programs.begin(&header.extent));
        if let Some(failure) = programs.failure() {
            return Err(failure);
        }
        let report = Report::new(header, profile);
        let totals = Metrics::new(profile);
        let (profile, layers, names) = (profile.clone(), Vec::new(), BTreeSet::new());
        let Extent { low, high, .. } = header.extent;
        let mut files = Self {
            programs,
            report,
            profile,
            part: (low, high),
            layers,
            figures: Vec::new(),
            points: 0,
            found: None,
            all: Vec::new(),
            built: None,
            selection,
            totals,
            names,
        };
        files.note(&chunks);
        Ok((files, chunks))
    }

    /// Takes the next layer, and what the deposit model says about it; returns their text.
    pub fn layer(&mut self, layer: &Layer, judgement: Option<&Judgement>) -> Vec<Chunk> {
        self.report.layer(layer, judgement);
        self.points += layer.passes.iter().map(|pass| pass.points.len()).sum::<usize>();
        match judgement.filter(|_| self.points <= MOST_CHECKED) {
            Some(judgement) => {
                self.layers.push(layer.clone());
                self.figures.push(judgement.figures);
            }
            None => self.layers.clear(),
        }
        let mut chunks = vec![Chunk::new(PLAN, plan_file::layer(layer, self.profile.layers.sheet(layer).as_ref()))];
        match self.selection.first_pass(layer.index) {
            Some(first) => {
                chunks.extend(self.programs.layer(layer, first));
                if !self.selection.is_all() {
                    let passes = layer.passes.iter().skip(first).cloned().collect();
                    self.totals.add(&Layer { passes, ..layer.clone() });
                }
            }
            None => self.programs.pass_over(layer),
        }
        self.note(&chunks);
        chunks
    }

    /// Totals of what the programs weld, where that is not the whole plan.
    pub fn totals(&self) -> Option<&Metrics> {
        (!self.selection.is_all()).then_some(&self.totals)
    }

    /// How far the built part ends above and below the plan, once the plan is checked.
    pub fn built(&self) -> Option<&Growth> {
        self.built.as_ref()
    }

    /// What users must know about the programs, once all layers are written, as sentences.
    pub fn notes(&self) -> Vec<String> {
        let unchecked = (self.points > MOST_CHECKED).then(|| {
            format!("The plan has {} points, so its checks were skipped. They can be run on plan.json.", self.points)
        });
        self.programs.writers.iter().flat_map(|writer| writer.notes()).chain(unchecked).collect()
    }

    /// What the checks find, once all layers are written; nothing in a plan that was not judged by the deposit model.
    ///
    /// How the part grows is computed, unless it is `known` from planning ([`Summary::grown`]).
    ///
    /// # Errors
    /// [`Cancelled`].
    pub fn check(&mut self, known: Option<&Grown>, task: &Task) -> Result<&[Finding], Cancelled> {
        if self.found.is_none() {
            let (layers, figures) = (std::mem::take(&mut self.layers), std::mem::take(&mut self.figures));
            if !layers.is_empty() {
                let settings = plan::deposit_settings_over(&self.profile, self.part);
                let grown = match known {
                    Some(grown) => grown.clone(),
                    None => check::grown(&layers, &self.profile, settings, task)?,
                };
                self.built = grown.worst();
                let judged = LayerFigures { figures, grown, ..LayerFigures::default() };
                self.all = check::check_figures(&layers, &self.profile, judged);
            }
            self.found = Some(check::grouped(&self.all));
        }
        Ok(self.found.as_deref().unwrap_or_default())
    }

    /// The last text of all files; `total` is the judgement of the deposit model on all layers.
    ///
    /// # Errors
    /// [`DialectError`] of a program that is not complete; then nothing may be kept.
    pub fn end(
        mut self,
        summary: &Summary,
        repair: &RepairReport,
        total: Option<&Figures>,
    ) -> Result<Vec<Chunk>, DialectError> {
        // Nobody can cancel this task.
        let found = self.check(summary.grown.as_ref(), &Task::new()).map(<[Finding]>::to_vec).unwrap_or_default();
        let totals = self.totals().cloned();
        let mut chunks = self.programs.end();
        if let Some(failure) = self.programs.failure() {
            return Err(failure);
        }
        chunks.push(Chunk::new(PLAN, plan_file::tail()));
        self.note(&chunks);
        let names: Vec<String> = self.names.into_iter().chain([METRICS, REPORT].map(str::to_owned)).collect();
        let mut metrics = summary.json(total);
        // So that the next plan in this folder knows which files belong to this one.
        metrics["files"] = serde_json::json!(names);
        if let Some(totals) = &totals {
            metrics["programs"] = serde_json::json!(totals);
        }
        metrics["built"] = serde_json::json!(self.built);
        let all = |found: &[Finding]| check::all_findings(summary, &repair.sentences(), found);
        metrics["findings"] = serde_json::json!(all(&found));
        chunks.push(Chunk::new(METRICS, format!("{metrics:#}\n")));
        chunks.push(Chunk::new(REPORT, self.report.finish(summary, repair, &names, &all(&self.all))));
        Ok(chunks)
    }

    /// The report on a plan whose programs are not written; it shows the places at fault. Remedies are worded for the
    /// program in use (`words`).
    pub fn refused(self, summary: &Summary, repair: &RepairReport, words: Words) -> Chunk {
        let findings = check::all_findings(summary, &repair.sentences(), &[]).into_iter();
        let findings: Vec<Finding> = findings.map(|finding| finding.in_words(words)).collect();
        Chunk::new(REFUSED, self.report.finish(summary, repair, &[], &findings))
    }

    fn note(&mut self, chunks: &[Chunk]) {
        for chunk in chunks {
            if !self.names.contains(&chunk.file) {
                self.names.insert(chunk.file.clone());
            }
        }
    }
}
