//! `beadwright heat`: how warm the metal is before each pass.

use crate::{profile, program, progress};
use beadwright::files::write_file;
use beadwright::heat::{self, History, Interpass, MOST_VOXELS};
use beadwright::report::temperature;
use std::io::Write;
use std::path::PathBuf;

#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// plan.json.
    plan: PathBuf,
    #[command(flatten)]
    wanted: profile::Wanted,
    /// Compute how long the build would take with this limit between passes, °C; the plan stays as it is.
    #[arg(long, value_name = "°C", value_parser = parse_limit)]
    limit: Option<f64>,
    /// HTML page to write, with pictures of the layers.
    #[arg(long, short, default_value = "heat.html", value_name = "FILE")]
    output: PathBuf,
    /// Print machine-readable JSON: all passes.
    #[arg(long)]
    json: bool,
}

fn parse_limit(text: &str) -> Result<f64, String> {
    let limit: f64 = text.parse().map_err(|_| "a temperature in °C is expected, such as 150".to_owned())?;
    if (30.0..=1500.0).contains(&limit) {
        Ok(limit)
    } else {
        Err("the limit must lie between 30 and 1500 °C".to_owned())
    }
}

pub(crate) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let source = program::Source::open(&arguments.plan)?;
    let path = arguments.plan.display();
    anyhow::ensure!(source.plan().is_some(), "{path}: give the plan.json of the program");
    let profile = source.profile(&arguments.wanted)?;
    let (task, bar) = progress::task()?;
    let loaded = source.load(&program::Reading::default(), &arguments.wanted, &profile, None, &task)?;
    let usual = Interpass { max_temperature: 0.0, min_temperature: None, reorder: true, along: false };
    // Without --limit, the plan keeps the waits for its own limit.
    let limit = |max_temperature| Interpass { max_temperature, ..profile.interpass.unwrap_or(usual) };
    let interpass = arguments.limit.map(limit);
    if let (Some(limits), Some(heat)) = (&interpass, &profile.heat) {
        let (limit, ambient) = (limits.max_temperature, heat.ambient);
        anyhow::ensure!(
            limit >= ambient + 10.0,
            "--limit {limit}: the limit must lie 10 °C or more above the surroundings, which are at {ambient} °C (heat.ambient)"
        );
    }
    let over = loaded.over.as_ref().map(|(bounds, _)| *bounds);
    let settings = heat::HeatSettings { interpass, over, ..profile.heat_settings()? };
    let mut layers = loaded.layers;
    if interpass.is_some() {
        layers.iter_mut().flat_map(|layer| &mut layer.passes).for_each(|pass| pass.wait = 0.0);
    }
    let history = heat::history(&mut layers, &settings, &profile.weld_settings(), &task)?;
    bar.finish_and_clear();
    let Some(history) = history else { anyhow::bail!("{path}: the plan has no passes.") };
    let limits = interpass.or(profile.interpass);
    let page = temperature::page(&loaded.name, &layers, &history, limits.as_ref());
    write_file(&arguments.output, page.html().as_bytes())?;
    let mut out = std::io::stdout().lock();
    if arguments.json {
        return Ok(writeln!(out, "{:#}", serde_json::json!(history))?);
    }
    print(&mut out, &loaded.name, &history, limits, settings.voxel())?;
    Ok(writeln!(crate::say::done(false), "\npictures in {}", arguments.output.display())?)
}

fn print(
    out: &mut impl Write,
    name: &str,
    history: &History,
    limits: Option<Interpass>,
    wanted: f64,
) -> std::io::Result<()> {
    writeln!(out, "{name}: {} layers, {} voxels of {:.1} mm", history.layers.len(), history.voxels, history.voxel)?;
    if history.voxel > wanted * 1.001 {
        writeln!(
            out,
            "warning: more than {MOST_VOXELS} voxels of {wanted:.1} mm would be needed; larger ones are less accurate."
        )?;
    }
    let Some((layer, pass, hottest)) = history.hottest_start() else { return Ok(()) };
    if let Some(limits) = limits.filter(|limits| hottest > limits.max_temperature + 1.0) {
        let limit = limits.max_temperature;
        writeln!(
            out,
            "warning: passes begin on metal hotter than {limit:.0} °C; plan again with [interpass] to wait."
        )?;
    }
    let last = history.layers.iter().rev().find_map(|layer| layer.hottest_start()).unwrap_or_default();
    let at = history.hottest_ahead().unwrap_or((layer, pass, hottest));
    let ahead = at.2;
    let percent = |part: f64| 100.0 * part / history.supplied.max(1e-9);
    let rows = [
        ("hottest start", format!("{hottest:.0} °C (layer {}, pass {})", layer + 1, pass + 1)),
        ("hottest ahead of torch", format!("{ahead:.0} °C (layer {}, pass {})", at.0 + 1, at.1 + 1)),
        ("starts of the last layer", format!("up to {last:.0} °C")),
        ("waits for cooling", format!("{:.1} min", history.waits() / 60.0)),
        ("total time", format!("{:.1} min", history.seconds / 60.0)),
        ("heat of arc and preheating", format!("{:.1} MJ", history.supplied / 1e6)),
        ("taken by air and table", format!("{:.1} %", percent(history.lost))),
        ("left in part and plate", format!("{:.1} %", percent(history.held))),
    ];
    writeln!(out)?;
    rows.iter().try_for_each(|(name, value)| writeln!(out, "  {name:<26} {value}"))
}
