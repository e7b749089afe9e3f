//! Exports programs, plan and report. The bytes are those of `beadwright plan`, since the library makes them.

use crate::disk;
use crate::state::PlanState;
use beadwright::adapt::{Adapted, Unfinished};
use beadwright::dialect::{self, Chunk, DialectError};
use beadwright::files::{PLAN, PlanFiles, Programs, Selection};
use beadwright::layer::Layer;
use beadwright::plan::Summary;
use std::path::Path;

/// What can be written into a folder.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Export {
    /// The program in a dialect.
    Program(String),
    /// One of the files that belong to the plan, by its name.
    File(&'static str),
    /// Everything the command writes: the programs in the profile's dialects, plan, metrics and report.
    All,
}

impl Default for Export {
    fn default() -> Self {
        Self::File(PLAN)
    }
}

impl Export {
    /// Whether programs are among the files.
    pub fn has_program(&self) -> bool {
        !matches!(self, Self::File(_))
    }

    /// The texts, in pieces.
    ///
    /// # Errors
    /// A sentence: the plan is not complete, or the profile lacks a dialect's section.
    pub fn chunks(&self, state: &PlanState) -> Result<Vec<Chunk>, String> {
        if let Some(adapted) = &state.adapted {
            return self.following(state, adapted);
        }
        match self {
            Self::Program(name) => program(state, name),
            Self::File(name) => {
                let mut chunks = files(state, &[])?;
                chunks.retain(|chunk| chunk.file == *name);
                Ok(chunks)
            }
            Self::All => files(state, state.profile.as_ref().map_or(&[], |profile| &profile.posts)),
        }
    }

    /// The same of the layers that follow a scan, as `beadwright adapt` writes it.
    fn following(&self, state: &PlanState, adapted: &Adapted) -> Result<Vec<Chunk>, String> {
        match self {
            Self::All => following(state, adapted, state.profile.as_ref().map_or(&[], |profile| &profile.posts)),
            Self::File(name) => {
                let mut chunks = following(state, adapted, &[])?;
                chunks.retain(|chunk| chunk.file == *name);
                Ok(chunks)
            }
            Self::Program(name) => {
                let others = following(state, adapted, &[])?;
                let mut chunks = following(state, adapted, std::slice::from_ref(name))?;
                chunks.retain(|chunk| !others.iter().any(|other| other.file == chunk.file));
                Ok(chunks)
            }
        }
    }

    /// Writes the files into a folder, all or none, and returns their names.
    ///
    /// # Errors
    /// A sentence: the error of [`Self::chunks`], or the file that cannot be written.
    pub fn write(&self, state: &PlanState, folder: &Path) -> Result<Vec<String>, String> {
        let part = state.header.as_ref().map_or("plan", |header| &header.part);
        disk::write_folder(folder, part, self.chunks(state)?)
    }
}

/// Refuses programs that should not be started.
fn allowed(summary: &Summary) -> Result<(), String> {
    match summary.forbidden.first() {
        Some(reason) => Err(format!("Nothing was written, since the program should not be started. {reason}")),
        None => Ok(()),
    }
}

const NOT_YET: &str = "The plan is not complete yet.";

fn program(state: &PlanState, name: &str) -> Result<Vec<Chunk>, String> {
    let (Some(header), Some(profile), Some(summary), true) =
        (&state.header, &state.profile, &state.summary, state.is_of_last_request())
    else {
        return Err(NOT_YET.to_owned());
    };
    allowed(summary)?;
    let job = profile.job(&header.part);
    let written =
        dialect::writer(name, &job).and_then(|writer| dialect::write_with(writer, &header.extent, &state.layers, &job));
    let files = written.map_err(|error| error.to_string())?;
    Ok(files.into_iter().map(|(file, text)| Chunk { file, text }).collect())
}

fn following(state: &PlanState, adapted: &Adapted, dialects: &[String]) -> Result<Vec<Chunk>, String> {
    let (Some(header), Some(profile), Some(summary)) = (&state.header, &state.profile, &state.summary) else {
        return Err(NOT_YET.to_owned());
    };
    if !dialects.is_empty() {
        allowed(summary)?;
    }
    let posts = disk::posts(dialects)?;
    let programs = Programs::of(&posts, &profile.job(&header.part)).map_err(|error| error.to_string())?;
    let built: Vec<Layer> = state.layers.iter().take(adapted.number).map(|layer| (**layer).clone()).collect();
    let build = Unfinished { header, layers: &built, profile, number: adapted.number };
    let mut all = Vec::new();
    let take = |chunks: Vec<Chunk>| -> Result<(), DialectError> {
        all.extend(chunks);
        Ok(())
    };
    adapted.files(build, programs, take).map_err(|error| error.to_string())?;
    Ok(all)
}

fn files(state: &PlanState, dialects: &[String]) -> Result<Vec<Chunk>, String> {
    let PlanState { header: Some(header), profile: Some(profile), summary: Some(summary), total: Some(total), .. } =
        state
    else {
        return Err(NOT_YET.to_owned());
    };
    let Some(part) = state.part.as_ref().filter(|_| state.is_of_last_request()) else {
        return Err(NOT_YET.to_owned());
    };
    if !dialects.is_empty() {
        allowed(summary)?;
    }
    let posts = disk::posts(dialects)?;
    let programs = Programs::of(&posts, &profile.job(&header.part)).map_err(|error| error.to_string())?;
    let (mut files, mut chunks) =
        PlanFiles::begin(header, profile, programs, Selection::default()).map_err(|error| error.to_string())?;
    for (layer, judgement) in state.layers.iter().zip(&state.judgements) {
        chunks.extend(files.layer(layer, Some(judgement)));
    }
    let mut summary = summary.clone();
    summary.notes.extend(files.notes());
    chunks.extend(files.end(&summary, &part.repair(), Some(total)).map_err(|error| error.to_string())?);
    Ok(chunks)
}
