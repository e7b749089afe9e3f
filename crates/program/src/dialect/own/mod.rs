//! Users' own dialects: a folder of templates, written without a line of Rust (`docs/dialects/your-own.md`).
//!
//! | file of the folder | what it is |
//! | --- | --- |
//! | `dialect.toml` | names of the files to be written, line ends, block numbers |
//! | `begin.txt` | what comes before the first layer; optional |
//! | `layer.txt` | one layer, with its instructions as `steps` |
//! | `end.txt` | what comes after the last layer; optional |
//! | others | templates that these include or import |
//!
//! The library reads no folder: [`Own::new`] takes its texts, which `files::posts` fetches. A dialect is rehearsed
//! before anything is written (`rehearse`): a broken template, or one that would lose part of the job, is refused
//! with its file and line.

mod data;
mod environment;
mod rehearse;
mod settings;
mod write;

use super::{DialectError, Job, Writer};
use minijinja::Environment;
use settings::Settings;
use std::collections::BTreeMap;
use write::OwnWriter;

/// Names of the templates.
const BEGIN: &str = "begin.txt";
const LAYER: &str = "layer.txt";
const END: &str = "end.txt";
/// The settings file, and the names of the two templates in it.
const SETTINGS: &str = "dialect.toml";
const FILE: &str = "dialect.toml, file";
const LAYER_FILE: &str = "dialect.toml, layer_file";

/// A user-defined dialect.
#[derive(Debug, Clone)]
pub struct Own {
    folder: String,
    settings: Settings,
    environment: Environment<'static>,
}

/// What is wrong with a user-defined dialect.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{folder}, {file}{at}: {reason}", at = line.map_or(String::new(), |line| format!(", line {line}")))]
pub struct OwnError {
    /// The folder, as named by the user.
    pub folder: String,
    /// The file in that folder.
    pub file: String,
    /// Line number in the file, from 1.
    pub line: Option<usize>,
    /// What is wrong and what would be right, as sentences.
    pub reason: String,
}

impl Own {
    /// The dialect of a folder, from the texts of its files by their names.
    ///
    /// # Errors
    /// [`OwnError`] with the file and the line.
    pub fn new(folder: &str, files: BTreeMap<String, String>) -> Result<Self, OwnError> {
        let error = |file: &str, reason: String| OwnError {
            folder: folder.to_owned(),
            file: file.to_owned(),
            line: None,
            reason,
        };
        for (needed, what) in [(SETTINGS, "the names of the files to be written"), (LAYER, "the template of a layer")] {
            if !files.contains_key(needed) {
                let reason = format!("this file is missing; it holds {what}. docs/dialects/your-own.md explains how.");
                return Err(error(needed, reason));
            }
        }
        let settings =
            Settings::read(&files[SETTINGS]).map_err(|(line, reason)| OwnError { line, ..error(SETTINGS, reason) })?;
        let environment = environment::of(&settings, files).map_err(|fault| explained(folder, &fault))?;
        Ok(Self { folder: folder.to_owned(), settings, environment })
    }

    /// The folder, as named by the user.
    pub fn name(&self) -> &str {
        &self.folder
    }

    /// Begins a program.
    ///
    /// # Errors
    /// [`DialectError`] for templates that are broken, or that write less than the job asks for.
    pub fn writer(&self, job: &Job<'_>) -> Result<Box<dyn Writer>, DialectError> {
        if !job.weld.is_level() {
            let remedy =
                "Its templates see no orientation of the torch: choose a robot's post, or leave layers.chart out.";
            return Err(DialectError::Cannot { dialect: "a dialect of your own", what: "layers.chart", remedy });
        }
        rehearse::rehearse(self, job)?;
        Ok(Box::new(OwnWriter::new(self, job)))
    }
}

/// Whether a post is a folder rather than the name of a dialect: it has a `/` or a `\`.
pub fn is_folder(post: &str) -> bool {
    post.contains(['/', '\\'])
}

/// An error of the template engine with its location.
fn explained(folder: &str, fault: &minijinja::Error) -> OwnError {
    let file = fault.name().unwrap_or(SETTINGS).to_owned();
    // The templates in the settings have line numbers of their own.
    let line = fault.line().filter(|_| !file.starts_with(SETTINGS));
    OwnError { folder: folder.to_owned(), file, line, reason: environment::sentence(fault) }
}
