//! `beadwright profile`, and how `--profile` and `--set` are read.

use anyhow::Context;
use beadwright::dialect::{DialectError, Job};
use beadwright::files::{self, Programs};
use beadwright::profile::{BUILT_IN, Profile, ProfileError, edit};
use std::io::Write;
use std::path::{Path, PathBuf};

#[derive(clap::Subcommand)]
pub(crate) enum Command {
    /// List the built-in profiles.
    List,
    /// Print a built-in profile, to save and edit.
    Show {
        /// Name of the profile.
        name: String,
    },
    /// Check a profile: a built-in name or a file.
    Check {
        /// Name of a built-in profile, or a TOML file.
        profile: String,
    },
    /// Print the JSON schema of profiles, for editors.
    Schema,
}

pub(crate) fn run(command: &Command) -> anyhow::Result<()> {
    let mut out = std::io::stdout().lock();
    match command {
        Command::List => {
            for (name, text) in BUILT_IN {
                writeln!(out, "{name:<18} {}", Profile::parse(text)?.description)?;
            }
        }
        Command::Show { name } => write!(out, "{}", Profile::built_in_text(name)?)?,
        Command::Check { profile } => {
            let checked = load(profile, &[])?;
            // What `plan` would refuse for any part.
            checked.wall_bead()?;
            programs(&checked.posts, &folder(profile), &checked.job("part"))?;
            if let Some(reason) = checked.forbidden().into_iter().next() {
                anyhow::bail!("{profile}: {reason}");
            }
            writeln!(out, "{}: every value is possible.", checked.name)?;
            for note in checked.notes() {
                writeln!(out, "note: {note}")?;
            }
        }
        Command::Schema => writeln!(out, "{:#}", Profile::schema())?,
    }
    Ok(())
}

/// Which profile a plan or a program is read with.
#[derive(clap::Args, Default)]
pub(crate) struct Wanted {
    /// Profile: a built-in name or a TOML file; if left out, that of the plan, the one that the program names, or
    /// cmt-al2319-kuka.
    #[arg(long, short, value_name = "NAME|FILE")]
    pub(crate) profile: Option<String>,
    /// Change a value of the profile, such as bead.width=5; may be given several times.
    #[arg(long, value_name = "KEY=VALUE")]
    pub(crate) set: Vec<String>,
}

/// The profile of programs that name none.
pub(crate) const USUAL: &str = "cmt-al2319-kuka";

/// The profile with a built-in name or from a file, with `key=value` settings applied to it.
pub(crate) fn load(profile: &str, settings: &[String]) -> anyhow::Result<Profile> {
    let path = Path::new(profile);
    let is_file = path.extension().is_some_and(|e| e == "toml") || path.components().count() > 1 || path.is_file();
    let text = if is_file { crate::file::text(path)? } else { Profile::built_in_text(profile)?.to_owned() };
    let parsed = Profile::parse(&text).with_context(|| profile.to_owned())?;
    if settings.is_empty() { Ok(parsed) } else { with_settings(text, settings) }
}

/// The profile of a text with `key=value` settings applied to it.
pub(crate) fn with_settings(text: String, settings: &[String]) -> anyhow::Result<Profile> {
    let mut edited = text;
    for setting in settings {
        let lay = || -> anyhow::Result<String> {
            let (key, value) =
                setting.split_once('=').context("expected is key=value, such as fill.raster_angle=45")?;
            Ok(edit::with_value(&edited, key, value)?)
        };
        edited = lay().with_context(|| format!("--set {setting}"))?;
    }
    // The text with the settings is not the user's own: a line number would mislead.
    Profile::parse(&edited).map_err(|error| match error {
        ProfileError::Text { reason, .. } => anyhow::anyhow!("--set {}: {reason}", settings.join(" --set ")),
        ProfileError::Value { key, value, reason, .. } => anyhow::anyhow!("{key} = {value} is impossible: {reason}"),
        other => other.into(),
    })
}

/// The folder in which a profile lies, where its `posts` look for dialects of one's own; the current one for a built-in
/// name.
pub(crate) fn folder(profile: &str) -> PathBuf {
    Path::new(profile).parent().map_or_else(PathBuf::new, Path::to_owned)
}

/// Programs in these dialects, where folders begin at `base`; if the profile lacks a section, the error says which one to
/// copy.
pub(crate) fn programs(names: &[String], base: &Path, job: &Job<'_>) -> anyhow::Result<Programs> {
    Programs::of(&files::posts(names, base)?, job).map_err(|error| {
        let DialectError::NoSection { dialect, .. } = error else { return error.into() };
        let section = format!("\n[{dialect}]");
        let with = BUILT_IN.iter().find(|(_, text)| text.contains(&section));
        let hint =
            with.map_or(String::new(), |(with, _)| format!(" `beadwright profile show {with}` prints one to copy."));
        anyhow::anyhow!("{error}{hint}")
    })
}
