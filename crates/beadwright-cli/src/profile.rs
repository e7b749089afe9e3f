//! `beadwright profile`, and how `--profile` and `--set` are read.

use crate::file;
use crate::say::Findings;
use anyhow::{Context, Error};
use beadwright::check;
use beadwright::dialect::{DialectError, Job};
use beadwright::files::{self, Programs, write_file};
use beadwright::profile::{BUILT_IN, Profile, ProfileError, edit};
use beadwright::program::{MACHINES, Machine};
use std::io::Write;
use std::path::{Path, PathBuf};

#[derive(clap::Subcommand)]
pub(crate) enum Command {
    /// List the built-in profiles, and your own in the folder BEADWRIGHT_PROFILES (default ~/.config/beadwright/profiles).
    List {
        /// Print machine-readable JSON.
        #[arg(long)]
        json: bool,
    },
    /// Print a built-in profile, to save and edit.
    Show {
        /// Name of the profile.
        name: String,
        /// Save it to this new file instead, next to the schema that lets editors complete keys.
        #[arg(long, short, value_name = "FILE")]
        output: Option<PathBuf>,
    },
    /// Check a profile: a built-in name or a file.
    Check {
        /// Name of a built-in profile, or a TOML file.
        profile: String,
    },
    /// List the built-in positioners, or print one: a name for `program.positioner.machine`, or its axes to copy and edit.
    Positioner {
        /// Name of the positioner.
        name: Option<String>,
    },
    /// Print the JSON schema of profiles, for editors.
    Schema,
}

pub(crate) fn run(command: &Command) -> anyhow::Result<()> {
    let mut out = std::io::stdout().lock();
    match command {
        Command::List { json: false } => {
            for (name, place, profile) in known() {
                let own = if place == "built in" { String::new() } else { format!(" ({place})") };
                let about = profile.map_or_else(|error| format!("error: {error:#}"), |profile| profile.description);
                writeln!(out, "{name:<18} {about}{own}")?;
            }
        }
        Command::List { json: true } => {
            let entry = |(name, place, profile): (String, String, anyhow::Result<Profile>)| match profile {
                Ok(Profile { description, posts, wire, bead, layers, .. }) => serde_json::json!({
                    "name": name, "place": place, "description": description, "posts": posts, "material": wire.material,
                    "bead_width_mm": bead.width, "layer_height_mm": layers.height,
                }),
                Err(error) => serde_json::json!({ "name": name, "place": place, "error": format!("{error:#}") }),
            };
            let list: Vec<serde_json::Value> = known().into_iter().map(entry).collect();
            writeln!(out, "{:#}", serde_json::Value::from(list))?;
        }
        Command::Show { name, output: None } => write!(out, "{}", Profile::built_in_text(name)?)?,
        Command::Show { name, output: Some(path) } => save(Profile::built_in_text(name)?, path)?,
        Command::Check { profile } => {
            let checked = load(profile, &[])?;
            // What `plan` would refuse for any part.
            checked.wall_bead()?;
            programs(&checked.posts, &folder(profile), &checked.job("part"))?;
            if let Some(reason) = checked.forbidden().into_iter().next() {
                anyhow::bail!("{profile}: {reason}");
            }
            writeln!(out, "{}: every value is valid.", checked.name)?;
            for note in checked.notes() {
                writeln!(out, "note: {note}")?;
            }
            let found = check::rehearse(&checked);
            for (post, fault) in &found {
                writeln!(out, "{post}, {}: {fault} Remedy: {}.", fault.kind.name, fault.kind.remedy)?;
            }
            if !found.is_empty() {
                return Err(Findings { count: found.len(), place: PathBuf::from(profile) }.into());
            }
        }
        Command::Positioner { name: None } => {
            for (name, _) in MACHINES {
                writeln!(out, "{name:<18} {}", Machine::built_in(name).map_err(Error::msg)?.description)?;
            }
        }
        Command::Positioner { name: Some(name) } => {
            write!(out, "{}", Machine::built_in_text(name).map_err(Error::msg)?)?;
        }
        Command::Schema => writeln!(out, "{:#}", Profile::schema())?,
    }
    Ok(())
}

/// The file that the `#:schema` lines of profiles name.
const SCHEMA: &str = "profile.schema.json";

/// Writes a profile to be edited, and its schema next to it.
fn save(text: &str, path: &Path) -> anyhow::Result<()> {
    anyhow::ensure!(!path.exists(), "{}: this file already exists; give the name of a new one", path.display());
    write_file(path, text.as_bytes())?;
    Ok(write_file(&path.with_file_name(SCHEMA), format!("{:#}\n", Profile::schema()).as_bytes())?)
}

/// Which profile is used for a plan or a program.
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
    let text = text(profile)?;
    let parsed = parse(&text, &folder(profile)).with_context(|| profile.to_owned())?;
    if settings.is_empty() { Ok(parsed) } else { with_settings(text, &folder(profile), settings) }
}

/// The text of the profile with a built-in name or from a file.
pub(crate) fn text(profile: &str) -> anyhow::Result<String> {
    Ok(match file_of(profile) {
        Some(path) => file::text(&path)?,
        None => Profile::built_in_text(profile)?.to_owned(),
    })
}

/// The file that `profile` stands for: a path, or the name of one of the user's own profiles.
fn file_of(profile: &str) -> Option<PathBuf> {
    let path = Path::new(profile);
    let is_file = file::is_standard(path)
        || path.extension().is_some_and(|e| e == "toml")
        || path.components().count() > 1
        || path.is_file();
    let own = || own_folder().map(|folder| folder.join(format!("{profile}.toml"))).filter(|own| own.is_file());
    if is_file { Some(path.to_owned()) } else { own() }
}

/// Where a user keeps profiles to be called by their names: `BEADWRIGHT_PROFILES`, or beadwright/profiles in the folder for
/// settings.
fn own_folder() -> Option<PathBuf> {
    let variable = |name: &str| std::env::var_os(name).filter(|value| !value.is_empty()).map(PathBuf::from);
    let settings = || {
        let home = || variable("HOME").map(|home| home.join(".config"));
        variable("XDG_CONFIG_HOME").or_else(|| variable("APPDATA")).or_else(home)
    };
    variable("BEADWRIGHT_PROFILES").or_else(|| settings().map(|folder| folder.join("beadwright").join("profiles")))
}

/// Reads a profile whose `inherits` may name a built-in profile, one of the user's own, or a file relative to `folder`.
pub(crate) fn parse(text: &str, folder: &Path) -> Result<Profile, ProfileError> {
    let mut folder = folder.to_owned();
    Profile::parse_with(text, &mut |name| {
        let Some(named) = file_of(name) else { return Ok(Profile::built_in_text(name)?.to_owned()) };
        let path = if named.is_absolute() { named } else { folder.join(named) };
        folder = path.parent().map_or_else(PathBuf::new, Path::to_owned);
        file::text(&path).map_err(|error| ProfileError::File { path, reason: format!("{error:#}") })
    })
}

/// Built-in profiles and the user's own: name, place, description.
fn known() -> Vec<(String, String, anyhow::Result<Profile>)> {
    let built_in: Vec<_> = BUILT_IN
        .iter()
        .map(|(name, text)| ((*name).to_owned(), "built in".to_owned(), Profile::parse(text).map_err(Into::into)))
        .collect();
    let files = own_folder().and_then(|folder| std::fs::read_dir(folder).ok()).into_iter().flatten().flatten();
    let mut own: Vec<PathBuf> =
        files.map(|entry| entry.path()).filter(|path| path.extension().is_some_and(|e| e == "toml")).collect();
    own.sort();
    let own = own.into_iter().map(|path| {
        let name = path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
        let place = path.display().to_string();
        (name, place.clone(), load(&place, &[]))
    });
    built_in.into_iter().chain(own).collect()
}

/// The profile of a text with `key=value` settings applied to it; `inherits` looks for files in `folder`.
pub(crate) fn with_settings(text: String, folder: &Path, settings: &[String]) -> anyhow::Result<Profile> {
    let mut edited = text;
    for setting in settings {
        let lay = || -> anyhow::Result<String> {
            let (key, value) =
                setting.split_once('=').context("key=value is expected, such as fill.raster_angle=45")?;
            Ok(edit::with_value(&edited, key, value)?)
        };
        edited = lay().with_context(|| format!("--set {setting}"))?;
    }
    // The text with the settings is not the user's own: a line number would mislead.
    parse(&edited, folder).map_err(|error| match error {
        ProfileError::Text { reason, .. } => anyhow::anyhow!("--set {}: {reason}", settings.join(" --set ")),
        ProfileError::Value { key, value, reason, .. } => anyhow::anyhow!("{key} = {value} is impossible: {reason}"),
        other => other.into(),
    })
}

/// The folder in which a profile lies, where its `posts` look for dialects of your own; the current one for a built-in
/// name.
pub(crate) fn folder(profile: &str) -> PathBuf {
    file_of(profile).as_deref().and_then(Path::parent).map_or_else(PathBuf::new, Path::to_owned)
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
