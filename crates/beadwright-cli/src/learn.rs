//! `beadwright bead fit --from`: what records of builds say about the values of a profile, and about the beads of a trial.

use crate::{file, profile, say};
use anyhow::Context;
use beadwright::files::write_file;
use beadwright::profile::edit;
use beadwright::record::{AsWelded, JSON, Learnt, Lesson, Quantity, as_welded};
use beadwright::trial::{self, TrialWelded};
use serde_json::json;
use std::io::Write;
use std::path::{Path, PathBuf};

/// What is wanted of records.
pub(crate) struct Wanted<'a> {
    /// Folders or files of records.
    pub(crate) records: &'a [PathBuf],
    /// The profile that they are compared with.
    pub(crate) profile: &'a str,
    /// The profile to write.
    pub(crate) to: Option<&'a Path>,
    /// The page to write.
    pub(crate) page: &'a Path,
    pub(crate) json: bool,
}

/// Compares a profile with what was measured, and writes the page and, if it is wanted, the profile with the new values.
pub(crate) fn run(wanted: &Wanted<'_>) -> anyhow::Result<()> {
    let passes: Vec<Vec<AsWelded>> = wanted.records.iter().map(|path| read(path)).collect::<anyhow::Result<_>>()?;
    let own = profile::load(wanted.profile, &[])?;
    let learnt = Learnt::of(&passes.concat(), &own);
    let names: Vec<String> = wanted.records.iter().map(|path| path.display().to_string()).collect();
    let text = learnt
        .lessons
        .iter()
        .filter(|lesson| lesson.changes)
        .try_fold(profile::text(wanted.profile)?, |text, lesson| {
            edit::with_value(&text, lesson.key, &format!("{:.3}", lesson.after.value))
        })?;
    profile::parse(&text, &profile::folder(wanted.profile)).context("the profile with the measured values")?;
    write_file(wanted.page, learnt.page(&own.name, &names).html().as_bytes())?;
    if let Some(path) = wanted.to {
        write_file(path, text.as_bytes())?;
    }
    if wanted.json {
        return Ok(writeln!(std::io::stdout(), "{:#}", json!(learnt))?);
    }
    print(&learnt, wanted)
}

fn print(learnt: &Learnt, wanted: &Wanted<'_>) -> anyhow::Result<()> {
    let mut out = say::done(false);
    writeln!(out, "{} of {} passes were welded undisturbed\n", learnt.undisturbed, learnt.passes)?;
    for Lesson { key, unit, before, after, changes } in &learnt.lessons {
        let before = before.map_or("not given".to_owned(), |before| format!("{before:.3}"));
        let change = if *changes { "changed" } else { "holds" };
        writeln!(out, "  {key:<24} {before:>9} → {:.3} ± {:.3} {unit}  {change}", after.value, after.plus_minus)?;
    }
    learnt.seen.iter().chain(&learnt.unknown).try_for_each(|sentence| writeln!(out, "note: {sentence}"))?;
    match wanted.to {
        Some(path) => writeln!(out, "\nprofile in {}, page in {}", path.display(), wanted.page.display())?,
        None => writeln!(out, "\npage in {}; --to FILE.toml writes the profile", wanted.page.display())?,
    }
    Ok(())
}

/// The sheet of a trial with what was measured in place of what was set: a record for each of its plates, in order.
pub(crate) fn into_sheet(sheet: &str, records: &[PathBuf]) -> anyhow::Result<String> {
    if records.is_empty() {
        return Ok(sheet.to_owned());
    }
    let (given, plates) = (records.len(), trial::plates(sheet)?);
    anyhow::ensure!(given == plates, "{given} records for {plates} plates: give one for each plate, in order.");
    let mut sheet = sheet.to_owned();
    for (plate, path) in (1..).zip(records) {
        let passes = read(path)?;
        // The numbers of the trials follow as a layer of several passes.
        let of_layer = |layer: usize| passes.iter().filter(move |pass| pass.layer == layer);
        anyhow::ensure!(
            of_layer(1).count() == 1,
            "{}: its trials have several passes each. What was measured goes into sheets of single beads only.",
            path.display()
        );
        let single = (1..).map_while(|layer| match of_layer(layer).collect::<Vec<_>>()[..] {
            [pass] => Some(pass),
            _ => None,
        });
        let welded = |pass: &AsWelded| TrialWelded {
            feed: pass.measured(Quantity::Feed),
            speed: pass.measured(Quantity::Speed),
            current: pass.measured(Quantity::Current),
            voltage: pass.measured(Quantity::Voltage),
        };
        let trials: Vec<TrialWelded> = single.map(welded).collect();
        sheet = trial::as_measured(&sheet, plate, &trials).with_context(|| path.display().to_string())?;
    }
    Ok(sheet)
}

/// The passes of a record, which may be named by its folder.
fn read(path: &Path) -> anyhow::Result<Vec<AsWelded>> {
    let path = if path.is_dir() { path.join(JSON) } else { path.to_owned() };
    let remedy = "Give the folder of an unchanged record; `beadwright record --verify` says what was changed.";
    as_welded(&file::text(&path)?).with_context(|| format!("{}: nothing is learnt from it. {remedy}", path.display()))
}
