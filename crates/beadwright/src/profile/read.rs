//! Reads TOML text into a [`Profile`], with errors that name the line and the nearest valid word.

use super::measured;
use super::missing::missing;
use super::{BUILT_IN, Profile, limits};
use crate::dialect::{self, Sections};
use crate::limit::Broken;
use crate::text::toml::{explain, line_of, line_of_key, nearest};
use serde::Deserialize as _;
use std::path::PathBuf;
use toml::Spanned;
use toml::de::{DeTable, DeValue, Deserializer};

/// Why a profile was refused.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ProfileError {
    /// No built-in profile has that name.
    #[error("there is no built-in profile \"{name}\". {hint}")]
    UnknownName {
        /// The name requested.
        name: String,
        /// The nearest name, or all of them.
        hint: String,
    },
    /// The text is not TOML, a key is unknown or missing, or a value has the wrong type.
    #[error("line {line} of the profile: {reason}")]
    Text {
        /// Line number, from 1.
        line: usize,
        /// What is wrong and what would be right.
        reason: String,
    },
    /// An impossible value.
    #[error("line {line} of the profile: {key} = {value} is impossible: {reason}")]
    Value {
        /// Line number, from 1.
        line: usize,
        /// Full key, such as `bead.width`.
        key: String,
        /// The value as written there.
        value: String,
        /// The range, the unit and the reason.
        reason: String,
    },
    /// A key that no profile has.
    #[error("{key} is not a key of a profile")]
    Key {
        /// The key.
        key: String,
    },
    /// The file cannot be read; created by callers, since the library does no I/O.
    #[error("the profile {path} cannot be read: {reason}")]
    File {
        /// The path.
        path: PathBuf,
        /// The message of the system.
        reason: String,
    },
}

/// The longest chain of profiles that may inherit from one another.
const MOST_ANCESTORS: usize = 8;

/// Reads a profile; `base` gives the texts of those that it inherits from, by the value of `inherits`.
pub(super) fn parse(
    text: &str,
    base: &mut dyn FnMut(&str) -> Result<String, ProfileError>,
) -> Result<Profile, ProfileError> {
    let mut ancestors: Vec<String> = Vec::new();
    // A library's path is relative to the profile that names it.
    let mut library = library(text, text, base)?;
    while let Some(name) = inherits(ancestors.last().map_or(text, |ancestor| ancestor)) {
        if ancestors.len() == MOST_ANCESTORS {
            return Err(ProfileError::Text {
                line: line_of_key(text, "inherits"),
                reason: format!("more than {MOST_ANCESTORS} profiles inherit from each other, perhaps in a circle."),
            });
        }
        let ancestor = base(&name)?;
        if let Err(error) = DeTable::parse(&ancestor) {
            let reason = format!("the profile \"{name}\", from which it inherits: {}", explain(error.message()));
            return Err(ProfileError::Text { line: 1, reason });
        }
        if library.is_none() {
            library = self::library(&ancestor, text, base)?;
        }
        ancestors.push(ancestor);
    }
    let mut profile = deserialize(text, &ancestors).map_err(|e| refused(&e, text, &ancestors))?;
    // The law goes with the profile where the library's file does not, such as into plan.json.
    if let Some((name, library)) = profile.bead.library.take().zip(library) {
        let law = measured::law(&library, &profile);
        profile.bead.law = law.map_err(|reason| of_library(text, name, reason))?;
    }
    match limits::first_broken(&profile) {
        None => Ok(profile),
        Some(Broken { key, value, reason }) => {
            Err(ProfileError::Value { line: line_of_key(text, &key), key, value, reason })
        }
    }
}

/// Reads a profile from the JSON that it was written as.
pub(super) fn from_json(value: &serde_json::Value) -> Result<Profile, ProfileError> {
    parse(&toml_text(value)?, &mut built_in_base)
}

/// The TOML text of a value of JSON; keys without a value are left out.
pub(super) fn toml_text(value: &serde_json::Value) -> Result<String, ProfileError> {
    let unfit = |reason: String| ProfileError::Text { line: 1, reason };
    let table = toml::Table::try_from(without_nulls(value)).map_err(|e| unfit(e.to_string()))?;
    toml::to_string(&table).map_err(|e| unfit(e.to_string()))
}

fn without_nulls(value: &serde_json::Value) -> serde_json::Value {
    match value {
        serde_json::Value::Object(map) => {
            let kept = map.iter().filter(|(_, value)| !value.is_null());
            kept.map(|(key, value)| (key.clone(), without_nulls(value))).collect()
        }
        serde_json::Value::Array(values) => values.iter().map(without_nulls).collect(),
        other => other.clone(),
    }
}

/// The value of `inherits`.
fn inherits(text: &str) -> Option<String> {
    let table = DeTable::parse(text).ok()?;
    Some(table.get_ref().get("inherits")?.get_ref().as_str()?.to_owned())
}

/// The text of the library that a profile names (`bead.library`), itself or the ancestor of another `text`.
fn library(
    profile: &str,
    text: &str,
    base: &mut dyn FnMut(&str) -> Result<String, ProfileError>,
) -> Result<Option<String>, ProfileError> {
    let named = |text| {
        let table = DeTable::parse(text).ok()?;
        let bead = table.get_ref().get("bead")?.get_ref().as_table()?;
        Some(bead.get("library")?.get_ref().as_str()?.to_owned())
    };
    let Some(name) = named(profile) else { return Ok(None) };
    base(&name).map(Some).map_err(|error| match error {
        ProfileError::UnknownName { .. } => {
            of_library(text, name, "files are not opened here; give bead.law itself.".to_owned())
        }
        other => other,
    })
}

/// What is wrong with the library of a profile.
fn of_library(text: &str, name: String, reason: String) -> ProfileError {
    let key = "bead.library".to_owned();
    ProfileError::Value { line: line_of_key(text, &key), key, value: name, reason }
}

/// The text of a built-in profile to inherit from.
pub(super) fn built_in_base(name: &str) -> Result<String, ProfileError> {
    Profile::built_in_text(name).map(str::to_owned)
}

/// Adds the keys of `base` that a table lacks; sections are filled key by key.
fn fill_in<'a>(table: &mut DeTable<'a>, base: DeTable<'a>) {
    for (key, value) in base {
        match table.get_mut(&key).map(Spanned::get_mut) {
            None => drop(table.insert(key, value)),
            Some(DeValue::Table(own)) => {
                if let DeValue::Table(inner) = value.into_inner() {
                    fill_in(own, inner);
                }
            }
            Some(_) => {}
        }
    }
}

fn deserialize(text: &str, ancestors: &[String]) -> Result<Profile, toml::de::Error> {
    let [general, sections] = tables(text, ancestors)?;
    let dialects = Sections::deserialize(Deserializer::from(sections))?;
    Ok(Profile { dialects, ..Profile::deserialize(Deserializer::from(general))? })
}

/// Why a profile cannot be read: all the keys that it lacks, or the first fault.
fn refused(error: &toml::de::Error, text: &str, ancestors: &[String]) -> ProfileError {
    let line = error.span().map_or(1, |span| line_of(text, span.start));
    let first = ProfileError::Text { line, reason: explain(error.message()) };
    let Ok([general, sections]) = tables(text, ancestors) else { return first };
    if !error.message().starts_with("missing field") {
        return first;
    }
    let lacks = [missing::<Profile>(general.into_inner()), missing::<Sections>(sections.into_inner())].concat();
    match &lacks[..] {
        [] | [_] => first,
        [lack, ..] => ProfileError::Text {
            line: line_of_key(text, lack),
            reason: format!("{} keys are missing: {}.", lacks.len(), lacks.join(", ")),
        },
    }
}

/// The tables of a profile and of its dialects, whose sections are taken out and read separately, so that a profile need
/// not know each of them.
fn tables<'a>(text: &'a str, ancestors: &'a [String]) -> Result<[Spanned<DeTable<'a>>; 2], toml::de::Error> {
    let mut general = DeTable::parse(text)?;
    for ancestor in ancestors {
        fill_in(general.get_mut(), DeTable::parse(ancestor)?.into_inner());
    }
    let mut sections = Spanned::new(general.span(), DeTable::new());
    for name in dialect::names() {
        if let Some((key, section)) = general.get_mut().remove_entry(name) {
            sections.get_mut().insert(key, section);
        }
    }
    Ok([general, sections])
}

pub(super) fn unknown_name(name: &str) -> ProfileError {
    let known = BUILT_IN.map(|(name, _)| name);
    let hint = match nearest(name, known) {
        Some(near) => format!("Did you mean \"{near}\"?"),
        None => format!("Known profiles: {}. The path of a TOML file is accepted, too.", known.join(", ")),
    };
    ProfileError::UnknownName { name: name.to_owned(), hint }
}
