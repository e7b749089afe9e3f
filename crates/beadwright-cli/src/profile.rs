//! `beadwright profile`, and how `--profile` and `--set` are read.

use anyhow::Context;
use beadwright::profile::{BUILT_IN, Profile, ProfileError};
use std::io::Write;
use std::path::Path;

#[derive(clap::Subcommand)]
pub(crate) enum Command {
    /// List the built-in profiles.
    List,
    /// Print a built-in profile, to be saved and edited.
    Show {
        /// Name of the profile.
        name: String,
    },
    /// Check a profile: a built-in name or a file.
    Check {
        /// Name or file.
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
            writeln!(out, "{}: every value is possible.", checked.name)?;
            for note in checked.notes() {
                writeln!(out, "note: {note}")?;
            }
        }
        Command::Schema => writeln!(out, "{:#}", Profile::schema())?,
    }
    Ok(())
}

/// The profile of a built-in name or a file, with `key=value` settings laid over it.
pub(crate) fn load(profile: &str, settings: &[String]) -> anyhow::Result<Profile> {
    let path = Path::new(profile);
    let is_file = path.extension().is_some_and(|e| e == "toml") || path.components().count() > 1 || path.is_file();
    let text = if is_file {
        std::fs::read_to_string(path)
            .map_err(|e| ProfileError::File { path: path.to_owned(), reason: e.to_string() })?
    } else {
        Profile::built_in_text(profile)?.to_owned()
    };
    let parsed = Profile::parse(&text).with_context(|| profile.to_owned())?;
    if settings.is_empty() {
        return Ok(parsed);
    }
    let mut document: toml_edit::DocumentMut = text.parse()?;
    for setting in settings {
        set(&mut document, setting).with_context(|| format!("--set {setting}"))?;
    }
    // The text with the settings is not the user's: a line number would mislead.
    Profile::parse(&document.to_string()).map_err(|error| match error {
        ProfileError::Text { reason, .. } => anyhow::anyhow!("--set {}: {reason}", settings.join(" --set ")),
        ProfileError::Value { key, value, reason, .. } => anyhow::anyhow!("{key} = {value} is impossible: {reason}"),
        other => other.into(),
    })
}

/// Lays one `section.key=value` over a profile; a value that is no TOML is taken as text.
fn set(document: &mut toml_edit::DocumentMut, setting: &str) -> anyhow::Result<()> {
    let (key, value) = setting.split_once('=').context("expected is key=value, such as fill.raster_angle=45")?;
    let value = value.trim();
    let value: toml_edit::Value = value.parse().unwrap_or_else(|_| value.into());
    // A whole number will do where a fraction is meant.
    let value = match value.as_integer() {
        Some(whole) if expects_float(document, key.trim()) => (whole as f64).into(),
        _ => value,
    };
    let parts: Vec<&str> = key.trim().split('.').collect();
    let mut item = document.as_item_mut();
    for (i, part) in parts.iter().enumerate() {
        let table = item.as_table_like_mut().with_context(|| format!("{key} is not a key of a profile"))?;
        // A section whose keys all have defaults may be missing.
        let missing = if i + 1 < parts.len() { toml_edit::table() } else { toml_edit::Item::None };
        item = table.entry(part).or_insert(missing);
    }
    *item = toml_edit::value(value);
    Ok(())
}

fn expects_float(document: &toml_edit::DocumentMut, key: &str) -> bool {
    let found = key.split('.').try_fold(document.as_item(), |item, part| item.get(part));
    found.is_none_or(|item| item.as_float().is_some())
}
