//! `beadwright check`.

use crate::say::Findings;
use crate::{profile, program, progress, reach};
use beadwright::Finding;
use beadwright::check::{self, CHECKS, Check};
use beadwright::dialect::reading::{FAULTS, Fault};
use beadwright::files::write_file;
use beadwright::layer::Layer;
use beadwright::profile::Profile;
use beadwright::robot::{self, Cell};
use std::io::Write;
use std::path::{Path, PathBuf};

#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// plan.json, or a program in KRL, RAPID, FANUC TP, INFORM, URScript or G-code (if it has several files, the main one),
    /// which is read as a welding programmer would read it; without a file, the checks are listed.
    plan: Option<PathBuf>,
    #[command(flatten)]
    wanted: profile::Wanted,
    #[command(flatten)]
    reading: program::Reading,
    /// Also check whether the robot of this cell can weld the plan: a built-in name or a TOML file.
    #[arg(long, value_name = "NAME|FILE")]
    cell: Option<String>,
    /// Write the findings as JSON into this file.
    #[arg(long, short, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Print the findings as JSON.
    #[arg(long)]
    json: bool,
}

/// Number of findings of one check that are printed; the JSON has all of them.
const PRINTED: usize = 5;

pub(crate) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let mut out = std::io::stdout().lock();
    let Some(plan) = &arguments.plan else {
        for check in &CHECKS {
            writeln!(
                out,
                "{}: {}.\n  Why: {}.\n  Example: {}\n  Remedy: {}.",
                check.name, check.what, check.why, check.example, check.remedy
            )?;
        }
        writeln!(out, "\nIn programs:")?;
        for kind in FAULTS {
            writeln!(out, "{}: {}.\n  Why: {}.\n  Remedy: {}.", kind.name, kind.what, kind.why, kind.remedy)?;
        }
        return Ok(());
    };
    let source = program::Source::open(plan)?;
    let (profile, is_program) = (source.profile(&arguments.wanted)?, source.plan().is_none());
    let (task, bar) = progress::task()?;
    let loaded = source.load(&arguments.reading, &arguments.wanted, &profile, None, &task)?;
    if is_program {
        anyhow::ensure!(
            arguments.cell.is_none(),
            "--cell checks the robot against a plan: give the plan.json of the program."
        );
        bar.finish_and_clear();
        return read_program(arguments, plan, &loaded, &mut out);
    }
    let settings = loaded.deposit_settings(None)?;
    let mut findings = check::check(&loaded.layers, &profile, settings, &task)?;
    if let Some(cell) = &arguments.cell {
        findings.extend(reach(&reach::load_cell(cell)?, &loaded.layers, &profile));
    }
    bar.finish_and_clear();
    let json = serde_json::to_string_pretty(&findings)?;
    if let Some(path) = &arguments.output {
        write_file(path, json.as_bytes())?;
    }
    if arguments.json {
        writeln!(out, "{json}")?
    } else {
        print(&mut out, &findings)?
    }
    if findings.is_empty() { Ok(()) } else { Err(Findings { count: findings.len(), place: plan.clone() }.into()) }
}

/// Reports the dangerous lines of a program.
fn read_program(
    arguments: &Arguments,
    path: &Path,
    loaded: &beadwright::read_back::ReadBack,
    out: &mut impl Write,
) -> anyhow::Result<()> {
    let value = |fault: &Fault| {
        let (line, module) =
            (fault.place.as_ref().map(|p| p.line), fault.place.as_ref().and_then(|p| p.module.clone()));
        serde_json::json!({
            "check": fault.kind.name, "module": module, "line": line, "count": fault.count, "text": fault.text,
            "remedy": fault.kind.remedy,
        })
    };
    let json = format!("{:#}", serde_json::Value::from(loaded.faults.iter().map(value).collect::<Vec<_>>()));
    if let Some(file) = &arguments.output {
        write_file(file, json.as_bytes())?;
    }
    if arguments.json {
        writeln!(out, "{json}")?;
    } else {
        writeln!(out, "{}: {}, {} arc starts", loaded.name, loaded.language, loaded.totals.arc_starts)?;
        for kind in FAULTS {
            let found: Vec<&Fault> = loaded.faults.iter().filter(|fault| fault.kind == *kind).collect();
            if found.is_empty() {
                continue;
            }
            writeln!(out, "{} ({}): {}.", kind.name, found.iter().map(|fault| fault.count).sum::<usize>(), kind.why)?;
            found.iter().take(PRINTED).try_for_each(|fault| writeln!(out, "  {fault}"))?;
            writeln!(out, "  Remedy: {}.", kind.remedy)?;
        }
        loaded.notes.iter().try_for_each(|note| writeln!(out, "note: {note}"))?;
        if loaded.faults.is_empty() {
            writeln!(out, "{} checks of programs, nothing found.", FAULTS.len())?;
        }
    }
    match loaded.faults.len() {
        0 => Ok(()),
        count => Err(Findings { count, place: path.to_owned() }.into()),
    }
}

/// What the robot cannot do.
fn reach(cell: &Cell, layers: &[Layer], profile: &Profile) -> Vec<Finding> {
    let track = profile.track(layers);
    let place = robot::turn_table(cell, cell.part, &track).map_or(cell.part, |table| table.place);
    robot::reach(cell, place, &track).findings.iter().map(Finding::from).collect()
}

/// Name of the check of the robot.
const REACH: &str = "reach";

fn print(out: &mut impl Write, findings: &[Finding]) -> std::io::Result<()> {
    let mut checks: Vec<&Check> = CHECKS.iter().collect();
    checks.sort_by_key(|check| check.severity());
    for check in checks {
        let found: Vec<&Finding> = findings.iter().filter(|f| f.kind == check.name).collect();
        if found.is_empty() {
            continue;
        }
        let word = found.iter().map(|f| f.severity).min().unwrap_or(check.severity()).word();
        writeln!(out, "{word}: {} ({}): {}.", check.name, found.len(), check.why)?;
        found.iter().take(PRINTED).try_for_each(|finding| writeln!(out, "  {}", finding.text))?;
        if found.len() > PRINTED {
            writeln!(out, "  … and {} more", found.len() - PRINTED)?;
        }
        // The remedy of the first one fits this plan.
        found.first().and_then(|f| f.remedy.as_ref()).map_or(Ok(()), |remedy| writeln!(out, "  {remedy}"))?;
    }
    let reach: Vec<&Finding> = findings.iter().filter(|f| f.kind == REACH).collect();
    if !reach.is_empty() {
        writeln!(out, "{REACH} ({}): the robot stops, turns faster than it can, or hits something.", reach.len())?;
        reach.iter().try_for_each(|finding| writeln!(out, "  {}", finding.text))?;
    }
    if findings.is_empty() {
        writeln!(out, "{} checks, nothing found.", CHECKS.len())?;
    }
    Ok(())
}
