//! Parts that are welded one after another, each with its own plan and programs.

use crate::plan::{self, Arguments, Files, Refused, print_findings, print_head, print_summary, refused};
use crate::several::Programs;
use crate::{progress, remedy, say};
use beadwright::compare::MAP_PIXELS;
use beadwright::deposit::{Figures, Judge};
use beadwright::model::together::Place;
use beadwright::model::{Import, Part};
use beadwright::plan::choice::{self, Choice};
use beadwright::plan::clearance::{Clearance, Close, Watch};
use beadwright::plan::{Summary, plan_into, torch_of};
use beadwright::profile::Profile;
use beadwright::task::Task;
use std::io::Write;
use std::path::{Path, PathBuf};

/// Plans one model or several, each on its own if each is to have its own program.
pub(crate) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    plan::prepare(arguments)?;
    if arguments.several.programs == Programs::Parts { each(arguments) } else { plan::run(arguments) }
}

/// A part that is planned, with its files still to be written.
struct Planned<'a> {
    name: &'a str,
    profile: &'a Profile,
    model: &'a Part,
    folder: PathBuf,
    files: Files<'a>,
    summary: Summary,
    figures: Option<Figures>,
}

/// A part with the profile that it is welded with.
struct Own {
    name: String,
    /// The profile's name.
    named: String,
    profile: Profile,
    model: Part,
    note: Option<String>,
}

/// Plans the parts one after another, each with its own programs. All are written, or none.
fn each(arguments: &Arguments) -> anyhow::Result<()> {
    let (task, bar) = progress::task()?;
    let build = arguments.build(&arguments.profile(&arguments.profile)?, &task)?;
    let own = |(name, import): (String, Import)| own(arguments, name, import, &task);
    let owned: Vec<Own> = build.lowest_first.into_iter().map(own).collect::<anyhow::Result<_>>()?;
    let mut clearance = Clearance::default();
    let mut planned = Vec::with_capacity(owned.len());
    for (index, own) in owned.iter().enumerate() {
        planned.push(one(arguments, index, own, &mut clearance, &task)?);
    }
    bar.finish_and_clear();
    let named = |one: &Planned<'_>| -> Vec<String> {
        remedy::reasons(&one.summary, remedy::words(one.profile))
            .iter()
            .map(|reason| format!("{}: {reason}", one.name))
            .collect()
    };
    let reasons: Vec<String> =
        planned.iter().flat_map(named).chain(clearance.close().iter().map(Close::sentence)).collect();
    if !reasons.is_empty() && !arguments.allow_findings {
        return Err(Refused { reasons, report: None }.into());
    }
    let mut all = Vec::new();
    for part in planned {
        all.extend(part.write(arguments, &build.places)?);
    }
    if arguments.json {
        writeln!(std::io::stdout(), "{:#}", serde_json::Value::from(all))?;
    }
    Ok(())
}

fn own(arguments: &Arguments, name: String, import: Import, task: &Task) -> anyhow::Result<Own> {
    let named = arguments.several.profile_of(&name).unwrap_or(&arguments.profile).to_owned();
    let (profile, model) = (arguments.profile(&named)?, Part::Mesh(import));
    let Choice { profile, note } = choice::choose(&model, &profile, arguments.strategy.is_some(), task)?;
    Ok(Own { name, named, profile, model, note })
}

/// Plans one of the parts; its files are numbered in the order of welding.
fn one<'a>(
    arguments: &Arguments,
    index: usize,
    own: &'a Own,
    clearance: &mut Clearance,
    task: &Task,
) -> anyhow::Result<Planned<'a>> {
    let Own { name, named, profile, model, note } = own;
    clearance.begin(name);
    let folder = arguments.output.join(format!("{}-{name}", index + 1));
    let programs = arguments.programs(named, profile, name, clearance.height())?;
    let settings = plan::deposit_settings(arguments.grid, profile, model.bounds())?;
    let judge = (!arguments.no_deposit).then(|| Judge::new(settings).with_pictures(MAP_PIXELS).without_patches());
    let mut files = Files::new(&folder, programs, profile)?.judged(judge);
    let torch = torch_of(profile).map_err(|error| refused(error, Path::new(name)))?;
    let mut watch = Watch { sink: &mut files, clearance, torch, width: profile.bead.width };
    let summary = plan_into(name, model, profile, task, &mut watch);
    let mut summary = summary.map_err(|error| refused(error, Path::new(name)))?;
    let own = model.notes().iter().cloned();
    summary.notes.splice(0..0, own.chain(note.clone()));
    summary.notes.extend(files.notes());
    let figures = files.figures();
    Ok(Planned { name, profile, model, folder, files, summary, figures })
}

impl Planned<'_> {
    /// Writes the files and reports them; with `--json` it gives the totals instead.
    fn write(self, arguments: &Arguments, places: &[Place]) -> anyhow::Result<Option<serde_json::Value>> {
        let Self { name, profile, model, folder, mut files, summary, figures } = self;
        let found = remedy::findings(
            &summary,
            &model.repair().sentences(),
            files.check(&summary, &Task::new())?,
            remedy::words(profile),
        );
        let built = files.built();
        let written = files.finish(&summary, &model.repair())?;
        if arguments.json {
            let mut value = summary.json(figures.as_ref());
            value["part"] = name.into();
            value["findings"] = serde_json::json!(found);
            value["built"] = serde_json::json!(built);
            return Ok(Some(value));
        }
        let place: Vec<Place> = places.iter().filter(|(part, _)| part == name).cloned().collect();
        print_head(&mut say::done(false), name, profile, model, &place)?;
        print_findings(&found)?;
        print_summary(&mut say::done(false), &folder, &summary, (figures.as_ref(), built.as_ref()), &written)?;
        writeln!(say::done(false))?;
        Ok(None)
    }
}
