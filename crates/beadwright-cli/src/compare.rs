//! `beadwright compare`: strategies and programs side by side.

use crate::plan::{deposit_settings, parse_grid, parse_layers};
use crate::{model, profile, program, progress, say};
use anyhow::Context;
use beadwright::compare::{self, COLUMNS, Chosen, Entry};
use beadwright::files::write_file;
use beadwright::fill::StrategyName;
use std::io::Write;
use std::path::PathBuf;

#[derive(clap::Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    model: model::Model,
    /// Profile: a built-in name or a TOML file; cmt-al2319-kuka if left out. Programs are then read with the profile that
    /// they name.
    #[arg(long, short, value_name = "NAME|FILE")]
    profile: Option<String>,
    /// Change a value of the profile; may be given several times.
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Strategy to compare; may be given several times; all strategies if left out.
    #[arg(long, short, value_name = "NAME")]
    strategy: Vec<StrategyName>,
    /// Program for the same part, to be judged alongside the strategies; may be given several times.
    #[arg(long, value_name = "FILE")]
    program: Vec<PathBuf>,
    #[command(flatten)]
    reading: program::Reading,
    /// Layers to judge, counted from 1, such as 1,5,10-20; all layers if left out.
    #[arg(long, value_parser = parse_layers, value_name = "LIST")]
    layers: Option<Chosen>,
    /// Grid spacing of the deposit model, mm; a twentieth of the bead width if left out.
    #[arg(long, value_name = "MM", value_parser = parse_grid)]
    grid: Option<f64>,
    /// HTML page to write, with the table and the height fields.
    #[arg(long, short, default_value = "compare.html", value_name = "FILE")]
    output: PathBuf,
    /// Print machine-readable JSON.
    #[arg(long)]
    json: bool,
}

pub(crate) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let profile = profile::load(arguments.profile.as_deref().unwrap_or(profile::USUAL), &arguments.set)?;
    let names = if arguments.strategy.is_empty() { StrategyName::ALL } else { &arguments.strategy };
    let (task, bar) = progress::task()?;
    let import = arguments.model.placed(&profile, model::Use::AsDrawn, &task)?;
    say::size(&import.mesh, &profile)?;
    let settings = deposit_settings(arguments.grid, &profile, import.mesh.bounds())?;
    let chosen = arguments.layers.clone().flatten();
    let mut entries = Vec::new();
    for &name in names {
        let entry = compare::strategy(&import.mesh, &profile, name, settings, &chosen, &task);
        entries.push(entry.with_context(|| format!("{}", arguments.model.model.display()))?);
    }
    anyhow::ensure!(
        entries.iter().all(|entry| !entry.layers.is_empty()),
        "--layers: the part has none of these layers"
    );
    let mut notes = Vec::new();
    let wanted = profile::Wanted { profile: arguments.profile.clone(), set: arguments.set.clone() };
    for path in &arguments.program {
        let source = program::Source::open(path)?;
        let own = source.profile(&wanted)?;
        let loaded = source.load(&arguments.reading, &wanted, &own, Some(&import), &task)?;
        entries.push(compare::program(&loaded.name, &loaded.judged(&own), loaded.totals, settings, &chosen, &task)?);
        notes.extend(loaded.notes.into_iter().map(|note| format!("{}: {note}", loaded.name)));
    }
    bar.finish_and_clear();
    compare::rank(&mut entries);
    let part = arguments.model.part();
    let (name, width) = (&profile.name, profile.bead.width);
    let lead = format!("Profile {name}, beads of {width} mm; {} {}", compare::SCORE, compare::GATE);
    let mut page = compare::page(&part, &lead, &entries, Some(&profile.check));
    let middle = entries.first().and_then(|e| e.layers.get(e.layers.len() / 2));
    for (name, layer) in names.iter().flat_map(|&name| middle.map(|layer| (name, layer))) {
        compare::add_steps(&mut page, &import.mesh, &profile, name, layer.index, &task)?;
    }
    write_file(&arguments.output, page.html().as_bytes())?;
    let mut out = std::io::stdout().lock();
    if arguments.json {
        let value: Vec<_> = entries
            .iter()
            .map(|e| serde_json::json!({ "name": e.name, "totals": e.totals, "deposit": e.figures.summary() }))
            .collect();
        writeln!(out, "{:#}", serde_json::Value::from(value))?;
        return Ok(());
    }
    print(&mut out, &entries)?;
    notes.iter().try_for_each(|note| writeln!(out, "note: {note}"))?;
    writeln!(crate::say::done(false), "\nheight fields in {}", arguments.output.display())?;
    Ok(())
}

/// The table, with a star at the best of each column.
fn print(out: &mut impl Write, entries: &[Entry]) -> std::io::Result<()> {
    let widest = entries.iter().map(|e| e.name.chars().count()).max().unwrap_or(0);
    write!(out, "{:widest$}", "")?;
    COLUMNS.iter().try_for_each(|c| write!(out, " {:>11}", c.name))?;
    writeln!(out)?;
    for (entry, cells) in entries.iter().zip(compare::table(entries)) {
        write!(out, "{:widest$}", entry.name)?;
        for (text, best) in cells {
            write!(out, " {:>11}", if best { format!("*{text}") } else { text })?;
        }
        writeln!(out)?;
    }
    writeln!(out, "{:widest$} * best; {}", "", compare::SCORE)?;
    writeln!(out, "{:widest$} {}", "", compare::GATE)
}
