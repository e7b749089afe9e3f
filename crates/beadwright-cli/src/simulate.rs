//! `beadwright simulate`: what a plan, or a program from any source, would build.

use crate::plan::parse_grid;
use crate::{model, profile, program, progress};
use anyhow::Context;
use beadwright::compare::{self, Entry};
use beadwright::files::write_file;
use beadwright::model::Units;
use beadwright::report::rows;
use std::collections::BTreeMap;
use std::io::Write;
use std::path::PathBuf;

#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// plan.json, toolpaths in 3MF, or a program in G-code (also a printer's), KRL, RAPID, FANUC TP, INFORM or
    /// URScript; if it has several files, the main one.
    file: PathBuf,
    /// Model of the part that the program was made for, as for `plan`; without it a program has no outline, and no
    /// voids or overfill are reported.
    #[arg(long, value_name = "MODEL")]
    model: Option<PathBuf>,
    /// Unit of the part's coordinates.
    #[arg(long, value_parser = model::parse_units, value_name = "mm|cm|m|in", requires = "model")]
    units: Option<Units>,
    #[command(flatten)]
    wanted: profile::Wanted,
    #[command(flatten)]
    reading: program::Reading,
    /// Grid spacing, mm; a twentieth of the bead width if left out.
    #[arg(long, value_name = "MM", value_parser = parse_grid)]
    grid: Option<f64>,
    /// HTML page to write, with the height fields.
    #[arg(long, short, default_value = "simulate.html", value_name = "FILE")]
    output: PathBuf,
    /// Print machine-readable JSON.
    #[arg(long)]
    json: bool,
}

pub(crate) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let source = program::Source::open(&arguments.file)?;
    let profile = source.profile(&arguments.wanted)?;
    let (task, bar) = progress::task()?;
    let part = program::part(arguments.model.as_deref(), arguments.units, &profile, &task)?;
    let loaded = source.load(&arguments.reading, &arguments.wanted, &profile, part.as_ref(), &task)?;
    let settings = loaded
        .deposit_settings(arguments.grid)
        .with_context(|| format!("--grid {}", arguments.grid.unwrap_or_default()))?;
    let entry = compare::program(&loaded.name, &loaded.judged(&profile), loaded.totals, settings, &None, &task)?;
    bar.finish_and_clear();
    let lead = format!(
        "{} in {} layers, judged by the deposit model with beads of {} mm.",
        loaded.language,
        entry.layers.len(),
        settings.nominal.bead.width
    );
    let page = compare::page(&loaded.name, &lead, std::slice::from_ref(&entry), Some(&profile.check));
    write_file(&arguments.output, page.html().as_bytes())?;
    let mut out = std::io::stdout().lock();
    if arguments.json {
        let layers: Vec<_> = entry.layers.iter().map(|l| serde_json::json!({ "index": l.index, "z": l.z, "figures": l.figures.summary(), "voids": l.voids, "peaks": l.peaks })).collect();
        let value = serde_json::json!({ "totals": entry.totals, "deposit": entry.figures.summary(), "layers": layers, "growth": entry.growth, "built": entry.built, "notes": loaded.notes });
        writeln!(out, "{value:#}")?;
        return Ok(());
    }
    print(&mut out, &loaded, &entry)?;
    writeln!(crate::say::done(false), "\nheight fields in {}", arguments.output.display())?;
    Ok(())
}

fn print(out: &mut impl Write, loaded: &beadwright::read_back::ReadBack, entry: &Entry) -> std::io::Result<()> {
    let (t, f) = (&entry.totals, &entry.figures);
    writeln!(out, "{}  {}, {} layers\n", loaded.name, loaded.language, entry.layers.len())?;
    let mut rows = vec![
        ("arc starts", t.arc_starts.to_string()),
        ("deposited length", format!("{:.2} m", t.deposited_length_mm / 1e3)),
        ("travel length", format!("{:.2} m", t.travel_length_mm / 1e3)),
        ("time", format!("{:.1} min", t.total_time_s / 60.0)),
        ("metal", format!("{:.2} cm³", t.metal_volume_mm3 / 1e3)),
    ];
    if f.area > 0.0 {
        rows.extend(rows::deposit(f));
        rows.push((
            "height per layer",
            format!("{:.2} ± {:.2} mm, {:.2} to {:.2} mm", f.mean(), f.deviation(), f.min, f.max),
        ));
    }
    for (name, value) in rows {
        writeln!(out, "  {name:<22} {value}")?;
    }
    if f.area > 0.0 {
        print_patches(out, entry)?;
    }
    loaded.notes.iter().try_for_each(|note| writeln!(out, "note: {note}"))
}

/// The worst places, and how the part grows from layer to layer.
fn print_patches(out: &mut impl Write, entry: &Entry) -> std::io::Result<()> {
    const LISTED: usize = 5;
    let place =
        |p: &beadwright::deposit::Patch| format!("layer {}, x {:.1} y {:.1}", p.layer + 1, p.place.x, p.place.y);
    let mut voids: Vec<_> = entry.layers.iter().flat_map(|l| &l.voids).collect();
    voids.sort_by(|a, b| b.area.total_cmp(&a.area));
    let mut peaks: Vec<_> = entry.layers.iter().flat_map(|l| &l.peaks).collect();
    peaks.sort_by(|a, b| b.height.total_cmp(&a.height));
    if !voids.is_empty() {
        writeln!(out, "\n  largest voids")?;
    }
    for void in voids.iter().take(LISTED) {
        writeln!(out, "    {:8.2} mm²  {}", void.area, place(void))?;
    }
    if !peaks.is_empty() {
        writeln!(out, "\n  highest peaks")?;
    }
    for peak in peaks.iter().take(LISTED) {
        let cause = peak.cause.map_or("", |c| c.name());
        writeln!(out, "    {:8.2} mm   {}  {cause}", peak.height, place(peak))?;
    }
    let mut causes: BTreeMap<&str, usize> = BTreeMap::new();
    peaks.iter().filter_map(|p| p.cause).for_each(|c| *causes.entry(c.name()).or_default() += 1);
    if !causes.is_empty() {
        let counts: Vec<String> = causes.iter().map(|(name, n)| format!("{name} {n}")).collect();
        writeln!(out, "    by cause: {}", counts.join(", "))?;
    }
    if let Some(built) = entry.built.filter(|_| entry.growth.len() > 1) {
        writeln!(
            out,
            "\n  bead laid on bead, {:.1} % of the area ends within one layer height of the last layers, on average {:+.2} \
             mm off,",
            100.0 * built.within,
            built.mean
        )?;
        writeln!(
            out,
            "  at most {:.2} mm above (x {:.1} y {:.1}) and {:.2} mm below (x {:.1} y {:.1})",
            built.peak,
            built.peak_place.x,
            built.peak_place.y,
            built.hollow,
            built.hollow_place.x,
            built.hollow_place.y
        )?;
    }
    Ok(())
}
