//! How much is said: `--quiet` and `--verbose`.

use beadwright::plan::{Expected, expected};
use beadwright::{Mesh, Profile};
use std::io::Write;
use std::path::PathBuf;
use std::sync::OnceLock;

/// How much a command says besides what it is asked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Loudness {
    /// Warnings and errors.
    Quiet,
    /// What was done too.
    Usual,
    /// How long each stage took too.
    Verbose,
}

static LOUDNESS: OnceLock<Loudness> = OnceLock::new();

/// Sets it, once.
pub(crate) fn set(quiet: bool, verbose: bool) {
    let loudness = match (quiet, verbose) {
        (true, _) => Loudness::Quiet,
        (_, true) => Loudness::Verbose,
        _ => Loudness::Usual,
    };
    _ = LOUDNESS.set(loudness);
}

pub(crate) fn loudness() -> Loudness {
    LOUDNESS.get().copied().unwrap_or(Loudness::Usual)
}

/// Where a command reports what it has done: nowhere with `--quiet`, on standard error where standard output takes a file.
pub(crate) fn done(output_is_standard: bool) -> Box<dyn Write> {
    match loudness() {
        Loudness::Quiet => Box::new(std::io::sink()),
        _ if output_is_standard => Box::new(std::io::stderr().lock()),
        _ => Box::new(std::io::stdout().lock()),
    }
}

/// Where warnings go: to the lines of the command, or with `--quiet` to standard error, where nothing else is said.
pub(crate) fn warnings() -> Box<dyn Write> {
    match loudness() {
        Loudness::Quiet => Box::new(std::io::stderr().lock()),
        _ => Box::new(std::io::stdout().lock()),
    }
}

/// A check that has found something.
#[derive(Debug, thiserror::Error)]
#[error("{count} {} in {}", if *count == 1 { "finding" } else { "findings" }, place.display())]
pub(crate) struct Findings {
    pub(crate) count: usize,
    pub(crate) place: PathBuf,
}

/// Prints how large a large plan will be, before it is made.
pub(crate) fn size(mesh: &Mesh, profile: &Profile) -> std::io::Result<()> {
    let Some(Expected { layers, layer_length, .. }) = expected(mesh, profile).filter(|expected| expected.large) else {
        return Ok(());
    };
    let (metres, kilometres) = (layer_length / 1e3, layers * layer_length / 1e6);
    writeln!(
        done(true),
        "about {layers} layers with {metres:.0} m of bead each, {kilometres:.1} km in all, are to be planned, which may take \
         many minutes. If that is not intended, press Ctrl-C and check bead.width ({} mm), layers.height ({} mm) and the unit \
         of the model.",
        profile.bead.width,
        profile.layers.height
    )
}
