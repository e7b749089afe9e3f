//! What is written: programs, plan, report. The bytes are those of `beadwright plan`, since the library makes them.

use crate::state::PlanState;
use beadwright::plan::deposit_settings_over;
use beadwright::report::Report;
use beadwright::{dialect, plan_file};
use std::collections::BTreeMap;
use std::path::Path;

/// A file that belongs to a plan.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Paper {
    /// `plan.json`.
    Plan,
    /// `report.html`.
    Report,
    /// `metrics.json`.
    Metrics,
}

impl Paper {
    /// Its file name.
    pub fn file(self) -> &'static str {
        match self {
            Self::Plan => "plan.json",
            Self::Report => "report.html",
            Self::Metrics => "metrics.json",
        }
    }
}

const NOT_YET: &str = "The plan is not complete yet.";

/// The program in a dialect: text by file name.
///
/// # Errors
/// A sentence: the plan is not complete, or the profile lacks the dialect's section.
pub fn program(state: &PlanState, name: &str) -> Result<BTreeMap<String, String>, String> {
    let (Some(header), Some(profile), Some(_), true) =
        (&state.header, &state.profile, &state.summary, state.is_of_last_request())
    else {
        return Err(NOT_YET.to_owned());
    };
    dialect::write(name, &state.layers, &profile.job(&header.part)).map_err(|error| error.to_string())
}

/// The text of a file that belongs to the plan; `files` are named in the report.
///
/// # Errors
/// A sentence: the plan is not complete.
pub fn paper(state: &PlanState, paper: Paper, files: &[String]) -> Result<String, String> {
    let PlanState { header: Some(header), profile: Some(profile), summary: Some(summary), total: Some(total), .. } =
        state
    else {
        return Err(NOT_YET.to_owned());
    };
    let Some(part) = state.part.as_ref().filter(|_| state.is_of_last_request()) else {
        return Err(NOT_YET.to_owned());
    };
    Ok(match paper {
        Paper::Plan => {
            let settings = deposit_settings_over(profile, part.bounds());
            let mut text = plan_file::head(header, &settings);
            state.layers.iter().enumerate().for_each(|(i, layer)| text.push_str(&plan_file::layer(layer, i == 0)));
            text.push_str(plan_file::tail());
            text
        }
        Paper::Metrics => format!("{:#}\n", summary.json(Some(total))),
        Paper::Report => {
            let mut report = Report::new(header, profile);
            for (layer, judgement) in state.layers.iter().zip(&state.judgements) {
                report.layer(layer, Some(judgement));
            }
            report.finish(summary, &part.repair(), files)
        }
    })
}

/// All files that `beadwright plan` writes, as it writes them: the programs of the profile's dialects, plan, metrics and
/// report.
///
/// # Errors
/// A sentence: the plan is not complete, or the profile lacks a dialect's section.
pub fn all(state: &PlanState) -> Result<BTreeMap<String, String>, String> {
    let Some(profile) = &state.profile else { return Err(NOT_YET.to_owned()) };
    let mut files = BTreeMap::new();
    for dialect in &profile.posts {
        files.extend(program(state, dialect)?);
    }
    for file in [Paper::Plan, Paper::Metrics] {
        files.insert(file.file().to_owned(), paper(state, file, &[])?);
    }
    let names: Vec<String> = files.keys().cloned().chain([Paper::Report.file().to_owned()]).collect();
    files.insert(Paper::Report.file().to_owned(), paper(state, Paper::Report, &names)?);
    Ok(files)
}

/// Writes files into a folder: all of them, or none. They come to their place when the last one is written, so that half a
/// program never lies there.
///
/// # Errors
/// A sentence that names the file.
pub fn write(folder: &Path, files: &BTreeMap<String, String>) -> Result<(), String> {
    let named = |path: &Path, error: std::io::Error| format!("{}: {error}.", path.display());
    std::fs::create_dir_all(folder).map_err(|error| named(folder, error))?;
    let aside = tempfile::Builder::new().prefix(".beadwright-").tempdir_in(folder);
    let aside = aside.map_err(|error| named(folder, error))?;
    for (name, text) in files {
        std::fs::write(aside.path().join(name), text).map_err(|error| named(&folder.join(name), error))?;
    }
    files.keys().try_for_each(|name| {
        let path = folder.join(name);
        std::fs::rename(aside.path().join(name), &path).map_err(|error| named(&path, error))
    })
}
