//! `beadwright check`.

use crate::{profile, program, progress, reach};
use beadwright::check::{self, CHECKS, Finding};
use beadwright::files::write_file;
use beadwright::layer::Layer;
use beadwright::profile::Profile;
use beadwright::robot::{self, Cell, Track};
use std::io::Write;
use std::path::PathBuf;

#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// plan.json; without it, the checks are listed.
    plan: Option<PathBuf>,
    #[command(flatten)]
    wanted: profile::Wanted,
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
        return Ok(());
    };
    let source = program::Source::open(plan)?;
    anyhow::ensure!(
        source.plan().is_some(),
        "{}: plans are checked; give the plan.json of the program",
        plan.display()
    );
    let profile = source.profile(&arguments.wanted)?;
    let (task, bar) = progress::task()?;
    let loaded = source.load(&program::Reading::default(), &arguments.wanted, &profile, None, &task)?;
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
    if findings.is_empty() { Ok(()) } else { Err(Findings { count: findings.len(), plan: plan.clone() }.into()) }
}

/// A plan with findings.
#[derive(Debug, thiserror::Error)]
#[error("{count} {} in {}", if *count == 1 { "finding" } else { "findings" }, plan.display())]
pub(crate) struct Findings {
    count: usize,
    plan: PathBuf,
}

/// What the robot cannot do, as findings.
fn reach(cell: &Cell, layers: &[Layer], profile: &Profile) -> Vec<Finding> {
    let track = Track::of(layers, profile);
    let place = robot::turn_table(cell, cell.part, &track).map_or(cell.part, |table| table.place);
    let found = robot::reach(cell, place, &track).findings;
    let finding =
        |f: &robot::ReachFinding| Finding { check: REACH, layer: None, pass: None, place: None, text: f.sentence() };
    found.iter().map(finding).collect()
}

/// Name of the check that asks the robot.
const REACH: &str = "reach";

fn print(out: &mut impl Write, findings: &[Finding]) -> std::io::Result<()> {
    for check in &CHECKS {
        let found: Vec<&Finding> = findings.iter().filter(|f| f.check == check.name).collect();
        if found.is_empty() {
            continue;
        }
        writeln!(out, "{} ({}): {}.", check.name, found.len(), check.why)?;
        found.iter().take(PRINTED).try_for_each(|finding| writeln!(out, "  {}", finding.sentence()))?;
        if found.len() > PRINTED {
            writeln!(out, "  … and {} more", found.len() - PRINTED)?;
        }
        writeln!(out, "  Remedy: {}.", check.remedy)?;
    }
    let reach: Vec<&Finding> = findings.iter().filter(|f| f.check == REACH).collect();
    if !reach.is_empty() {
        writeln!(out, "{REACH} ({}): the robot stops, turns faster than it can, or hits something.", reach.len())?;
        reach.iter().try_for_each(|finding| writeln!(out, "  {}", finding.text))?;
    }
    if findings.is_empty() {
        writeln!(out, "{} checks, nothing found.", CHECKS.len())?;
    }
    Ok(())
}
