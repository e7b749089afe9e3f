//! `beadwright bead fit` with the sheet of starts and ends, of corners or of overlaps: what it says, and what goes into the profile.

use crate::{profile, say};
use anyhow::Context;
use beadwright::bead::library::Estimate;
use beadwright::files::write_file;
use beadwright::profile::edit;
use beadwright::trial::{Found, Learnt, Lesson, Subject, ends_learnt, stepover_learnt};
use serde_json::json;
use std::io::Write;
use std::path::Path;

const STEPOVER: &str = "fill.stepover";

/// What is wanted of a sheet.
pub(crate) struct Wanted<'a> {
    /// The profile with which its trials were welded.
    pub(crate) profile: Option<&'a str>,
    /// The profile to write.
    pub(crate) to: Option<&'a Path>,
    /// Depth of the valleys that may remain between beads, mm.
    pub(crate) valley: Option<f64>,
    pub(crate) json: bool,
}

/// Prints what a sheet says and writes the profile if it is wanted.
pub(crate) fn run(found: &Found, wanted: &Wanted<'_>) -> anyhow::Result<()> {
    anyhow::ensure!(
        wanted.valley.is_none() || found.subject == Subject::Overlaps,
        "--valley needs a sheet of beads side by side (bead trial --shape overlap)."
    );
    let learnt = match (found.subject, wanted.profile) {
        (Subject::Corners, _) => {
            anyhow::ensure!(wanted.to.is_none(), "no key of a profile holds the metal of corners: leave out --to.");
            Learnt::default()
        }
        (_, Some(name)) => learn(found, name, wanted)?,
        (_, None) => {
            anyhow::ensure!(
                wanted.to.is_none() && wanted.valley.is_none(),
                "name the profile with which the beads were welded (-p)."
            );
            Learnt::default()
        }
    };
    if wanted.json {
        let row = |(values, [first, second]): (Vec<f64>, [Estimate; 2])| json!({ "values": values, "fitted": [first, second] });
        let factors: Vec<&str> = found.factors().iter().map(|factor| factor.name()).collect();
        let notes = [&found.notes[..], &learnt.notes].concat();
        let value = json!({ "trials": found.trials(), "factors": factors, "names": found.names,
            "fits": found.responses, "lengths": found.lengths, "combinations": found.fitted().into_iter().map(row).collect::<Vec<_>>(),
            "notes": notes, "lessons": learnt.lessons });
        return Ok(writeln!(std::io::stdout(), "{value:#}")?);
    }
    print(found, &learnt, wanted)
}

fn learn(found: &Found, name: &str, wanted: &Wanted<'_>) -> anyhow::Result<Learnt> {
    let profile = profile::load(name, &[])?;
    let learnt = match found.subject {
        Subject::Overlaps => stepover_learnt(found, &profile, wanted.valley)?,
        Subject::Ends | Subject::Corners => ends_learnt(found, &profile)?,
    };
    let text = learnt.lessons.iter().try_fold(profile::text(name)?, with_lesson)?;
    profile::parse(&text, &profile::folder(name)).context("the profile with what the trials say")?;
    if let Some(path) = wanted.to {
        write_file(path, text.as_bytes())?;
    }
    Ok(learnt)
}

/// The text of a profile with the value that trials show.
fn with_lesson(text: String, lesson: &Lesson) -> anyhow::Result<String> {
    let text = edit::with_value(&text, lesson.key, &format!("{:.3}", lesson.after))?;
    // A given stepover takes the place of the models of overlap.
    Ok(if lesson.key == STEPOVER { edit::with_value(&text, "fill.overlap", "\"free\"")? } else { text })
}

fn print(found: &Found, learnt: &Learnt, wanted: &Wanted<'_>) -> anyhow::Result<()> {
    let mut out = say::done(false);
    writeln!(out, "{} trials\n", found.trials())?;
    let heads = found.factors().iter().map(|factor| factor.name()).chain(found.names);
    writeln!(out, "{}", heads.map(|head| format!("  {head:>18}")).collect::<String>())?;
    for (values, fits) in found.fitted() {
        let values = values.iter().map(|value| format!("  {value:18}"));
        let fits = fits.iter().map(|fit| format!("  {:>18}", format!("{:.2} ± {:.2} mm", fit.value, fit.plus_minus)));
        writeln!(out, "{}", values.chain(fits).collect::<String>())?;
    }
    found.notes.iter().chain(&learnt.notes).try_for_each(|note| writeln!(out, "note: {note}"))?;
    if found.subject == Subject::Corners {
        writeln!(out, "\nNo key of a profile changes the metal of corners: a plan lays them as any other place.")?;
        return Ok(());
    }
    let ends = found.subject == Subject::Ends;
    if learnt.lessons.is_empty() {
        let what =
            if ends { "settings with which hump and crater are least" } else { "widest stepover with shallow valleys" };
        writeln!(out, "\n-p PROFILE names the {what}; --to FILE.toml writes it")?;
        return Ok(());
    }
    writeln!(out, "\n{}:\n", if ends { "least hump and crater" } else { "widest stepover with shallow valleys" })?;
    for Lesson { key, before, after, plus_minus } in &learnt.lessons {
        let within =
            plus_minus.filter(|within| within.is_finite()).map_or(String::new(), |within| format!(" ± {within:.3}"));
        writeln!(out, "  {key:<28} {before:>8.3} → {after:.3}{within}")?;
    }
    if let Some(path) = wanted.to {
        writeln!(out, "\nprofile in {}", path.display())?;
    }
    Ok(())
}
