//! The files of a plan: the same bytes as the command writes.

use crate::error::words;
use crate::planned::Planned;
use beadwright::Finding;
use beadwright::check;
use beadwright::compare::MAP_PIXELS;
use beadwright::deposit::Judge;
use beadwright::dialect::DialectError;
use beadwright::files::{Folder, FolderError, METRICS, PLAN, PlanFiles, Post, Programs, REPORT, Selection};
use beadwright::plan;
use beadwright::profile::Profile;
use beadwright::task::{Cancelled, Stage, Task};
use std::collections::BTreeMap;
use std::path::Path;

/// What is to be written, and where.
pub(crate) struct Wanted<'a> {
    pub(crate) folder: &'a Path,
    pub(crate) profile: &'a Profile,
    pub(crate) posts: &'a [Post],
    /// Whether the deposit model judges the layers, for the report.
    pub(crate) deposit: bool,
    pub(crate) allow_findings: bool,
}

/// Why nothing was written.
#[derive(Debug, thiserror::Error)]
pub(crate) enum SaveError {
    #[error("nothing was written, since the program should not be started: {0} allow_findings=True writes it anyway.")]
    Refused(String),
    #[error(transparent)]
    Dialect(#[from] DialectError),
    #[error(transparent)]
    Folder(#[from] FolderError),
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// Writes the files into the folder, all of them or none, and returns their names.
pub(crate) fn save(planned: &Planned, wanted: &Wanted<'_>, task: &Task) -> Result<Vec<String>, SaveError> {
    let &Wanted { profile, .. } = wanted;
    if !planned.summary.forbidden.is_empty() && !wanted.allow_findings {
        return Err(SaveError::Refused(planned.summary.forbidden.join(" ")));
    }
    let programs = Programs::of(wanted.posts, &profile.job(&planned.header.part))?;
    let settings = plan::deposit_settings_over(profile, planned.part.bounds());
    let mut judge = wanted.deposit.then(|| Judge::new(settings).with_pictures(MAP_PIXELS).without_patches());
    let mut folder = Folder::new(wanted.folder)?;
    let (mut files, chunks) = PlanFiles::begin(&planned.header, profile, programs, Selection::default())?;
    folder.extend(chunks)?;
    for (done, layer) in planned.layers.iter().enumerate() {
        task.step(Stage::Deposit, done as f64 / planned.layers.len() as f64)?;
        let judgement = judge.as_mut().map(|judge| judge.layer(&plan::welded_alone(layer, profile)));
        folder.extend(files.layer(layer, judgement.as_ref()))?;
    }
    let mut summary = planned.summary.clone();
    summary.notes.splice(0..0, planned.part.notes().iter().chain(&planned.note).cloned());
    summary.notes.extend(files.notes());
    folder.extend(files.end(&summary, &planned.part.repair(), judge.as_ref().map(Judge::total))?)?;
    Ok(folder.commit()?.files)
}

/// Everything to report about a plan, the worst first.
pub(crate) fn findings(planned: &Planned, task: &Task) -> Result<Vec<Finding>, Cancelled> {
    let (layers, profile) = (&planned.layers[..], &planned.profile);
    let settings = plan::deposit_settings_over(profile, planned.part.bounds());
    let judged = check::judge_layers(layers, profile, Judge::new(settings).without_patches(), None, task, |_, _| ())?;
    let found = check::grouped(&check::check_figures(layers, profile, judged));
    let mut summary = planned.summary.clone();
    summary.notes.splice(0..0, planned.part.notes().iter().chain(&planned.note).cloned());
    Ok(check::all_findings(&summary, &planned.part.repair().sentences(), &found)
        .into_iter()
        .map(|finding| finding.in_words(words(profile)))
        .collect())
}

/// The programs alone: the text of each file by its name.
pub(crate) fn programs(
    planned: &Planned,
    profile: &Profile,
    posts: &[Post],
) -> Result<BTreeMap<String, String>, DialectError> {
    let programs = Programs::of(posts, &profile.job(&planned.header.part))?;
    let (mut files, mut chunks) = PlanFiles::begin(&planned.header, profile, programs, Selection::default())?;
    planned.layers.iter().for_each(|layer| chunks.extend(files.layer(layer, None)));
    chunks.extend(files.end(&planned.summary, &planned.part.repair(), None)?);
    let mut texts = BTreeMap::<String, String>::new();
    for chunk in chunks.into_iter().filter(|chunk| ![PLAN, METRICS, REPORT].contains(&&*chunk.file)) {
        texts.entry(chunk.file).or_default().push_str(&chunk.text);
    }
    Ok(texts)
}
