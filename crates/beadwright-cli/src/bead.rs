//! `beadwright bead`: a library of measured beads, and the parameters for a wanted one.

use crate::{file, profile};
use anyhow::Context;
use beadwright::bead::library::demonstration_csv;
use beadwright::bead::library::printed_rows;
use beadwright::bead::library::{
    BeadLibrary, Columns, Layering, Limit, Measured, Prediction, PrintedRow, Recipe, Response, Wish,
};
use beadwright::bead::{BeadByHeat, Overlap, wire_area};
use beadwright::files::write_file;
use beadwright::heat::{HeatSettings, MeasuredWall, Wall, WallLaw};
use beadwright::profile::edit;
use beadwright::report::bead_window;
use beadwright::trial::{Found, Parameter};
use serde_json::{Map, Value, json};
use std::io::Write;
use std::path::{Path, PathBuf};

#[derive(clap::Subcommand)]
pub(crate) enum Command {
    /// Write programs for trial beads on plates, and the sheet for their measurements.
    Trial(Box<crate::trial::Arguments>),
    /// Measure the beads of a trial in a scan of its plate, and fill in the sheet.
    Measure(crate::trial::Measure),
    /// Fit the width and height of measured single beads, and write the library.
    Fit(Box<Fit>),
    /// Predict the bead for given parameters.
    Predict(Predict),
    /// Find the parameters for a wanted bead within the measured range.
    Solve(Solve),
    /// Fit how thickness and width of walls depend on heat, from walls welded with different waits, and predict others.
    Walls(Walls),
    /// Check whether a printed table of process values is consistent: metal per ampere and second, row by row.
    CheckTable(CheckTable),
    /// Write invented measurements as CSV, to try out the other commands.
    Example {
        /// File to write.
        #[arg(short, long, default_value = "bead-example.csv", value_name = "FILE")]
        output: PathBuf,
    },
}

#[derive(clap::Args)]
pub(crate) struct Fit {
    /// CSV with one bead per line; the first line names the columns with their units, such as current_a, width_mm. May be left out
    /// with --from.
    #[arg(required_unless_present = "from")]
    data: Option<PathBuf>,
    /// Records of builds, by their folders. Alone, they are compared with the profile, and --to writes the values that were measured;
    /// with the sheet of a trial, one for each plate, what was measured counts instead of what was set.
    #[arg(long, num_args = 1.., value_name = "RECORD")]
    from: Vec<PathBuf>,
    /// Page that says what changes, for records without a sheet.
    #[arg(long, requires = "from", conflicts_with = "data", default_value = "learnt.html", value_name = "FILE.html")]
    page: PathBuf,
    /// Columns that are process parameters; all but width and height if left out.
    #[arg(long, value_delimiter = ',', value_name = "A,B,…")]
    inputs: Option<Vec<String>>,
    /// Column with the bead width.
    #[arg(long, default_value = "width", value_name = "COLUMN")]
    width: String,
    /// Column with the bead height.
    #[arg(long, default_value = "height", value_name = "COLUMN")]
    height: String,
    /// Library to write.
    #[arg(short, long, default_value = "bead-library.toml", value_name = "FILE")]
    output: PathBuf,
    /// Wanted bead, width and layer height in mm, such as 6x2: the parameters that lay it are printed, and written with --to.
    #[arg(long, value_parser = parse_bead, value_name = "WIDTHxHEIGHT")]
    want: Option<(f64, f64)>,
    /// Largest deviation of width and layer height from the wanted bead, %.
    #[arg(long, requires = "want", default_value_t = 0.5, value_name = "PERCENT")]
    tolerance: f64,
    /// Profile on which that for the wanted bead is based (cmt-al2319-kuka if left out), or the one of the builds that were recorded: a
    /// built-in name or a TOML file.
    #[arg(long, short, value_name = "NAME|FILE")]
    profile: Option<String>,
    /// Profile to write: with the bead, the layer height and the parameters of the wanted bead, with the values that records show, or
    /// with the starts and ends or the stepover that trials show.
    #[arg(long, value_name = "FILE.toml")]
    to: Option<PathBuf>,
    /// With a sheet of beads side by side: depth of the valleys that may remain between them, mm; a tenth of the bead's height if left
    /// out.
    #[arg(long, requires = "data", value_parser = parse_valley, value_name = "MM")]
    valley: Option<f64>,
    #[command(flatten)]
    layering: LayeringArguments,
    /// Write a picture of width/height over the first input, with a curve for each value of the second.
    #[arg(long, value_name = "FILE.svg")]
    plot: Option<PathBuf>,
    /// Print machine-readable JSON.
    #[arg(long)]
    json: bool,
}

#[derive(clap::Args)]
pub(crate) struct Walls {
    /// CSV with one wall per line, one bead thick: the columns dwell_s, length_mm, layers, height_mm, width_mm.
    data: PathBuf,
    /// Profile of the process they were welded with: a built-in name or a TOML file with [heat], [material] and [substrate].
    #[arg(long, short, value_name = "NAME|FILE")]
    profile: String,
    /// Change a value of the profile, such as process.current=132; may be given several times.
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Fit only the walls with these waits, s, and predict the others.
    #[arg(long, value_delimiter = ',', value_name = "S,S,…")]
    fit: Option<Vec<f64>>,
    /// Print machine-readable JSON.
    #[arg(long)]
    json: bool,
}

#[derive(clap::Args)]
pub(crate) struct CheckTable {
    /// CSV with the columns current_a, speed_mm_s, width_mm, height_mm and, for walls one bead thick, layers.
    data: PathBuf,
    /// Print machine-readable JSON.
    #[arg(long)]
    json: bool,
}

#[derive(clap::Args)]
pub(crate) struct Predict {
    /// Library written by `bead fit`.
    library: PathBuf,
    /// Parameters, such as current=120 deposition_speed=8.
    #[arg(required = true, value_parser = parse_value, value_name = "NAME=VALUE")]
    values: Vec<(String, f64)>,
    #[command(flatten)]
    layering: LayeringArguments,
    /// Print machine-readable JSON.
    #[arg(long)]
    json: bool,
}

#[derive(clap::Args)]
pub(crate) struct Solve {
    /// Library written by `bead fit`.
    library: PathBuf,
    /// Wanted width of the bead, mm.
    #[arg(long, value_name = "MM")]
    width: f64,
    /// Wanted height of a layer, mm.
    #[arg(long, value_name = "MM")]
    layer_height: f64,
    /// Narrower range for a parameter, such as current=100..150, or a single value; may be given several times.
    #[arg(long, value_parser = parse_limit, value_name = "NAME=MIN..MAX")]
    limit: Vec<Limit>,
    /// Largest deviation of width and layer height that still counts as a match, %.
    #[arg(long, default_value_t = 0.5, value_name = "PERCENT")]
    tolerance: f64,
    #[command(flatten)]
    layering: LayeringArguments,
    /// Print machine-readable JSON.
    #[arg(long)]
    json: bool,
}

#[derive(clap::Args)]
struct LayeringArguments {
    /// Overlap of neighbouring beads in closed layers: `tangent`, `inclined-flat-top`, or the stepover in mm. Without
    /// it, a layer is a single bead of a wall.
    #[arg(long, value_name = "OVERLAP|MM")]
    overlap: Option<String>,
}

impl LayeringArguments {
    /// What a layer height means for beads of `width` mm.
    fn layering(&self, width: f64) -> anyhow::Result<Layering> {
        let ratio = |overlap: Overlap| overlap.ratio().unwrap_or(1.0) * width;
        let stepover = match self.overlap.as_deref() {
            None => return Ok(Layering::SinglePass),
            Some("tangent") => ratio(Overlap::Tangent),
            Some("inclined-flat-top") => ratio(Overlap::InclinedFlatTop),
            Some(text) => {
                let stepover: Option<f64> = text.parse().ok().filter(|v: &f64| v.is_finite() && *v > 0.0);
                stepover.with_context(|| {
                    format!("--overlap {text}: tangent, inclined-flat-top, or a stepover above 0 mm is expected.")
                })?
            }
        };
        Ok(Layering::Overlapping { stepover })
    }
}

pub(crate) fn run(command: &Command) -> anyhow::Result<()> {
    match command {
        Command::Trial(arguments) => crate::trial::run(arguments),
        Command::Measure(arguments) => crate::trial::measure(arguments),
        Command::Fit(arguments) => fit(arguments),
        Command::Walls(arguments) => walls(arguments),
        Command::CheckTable(arguments) => check_table(arguments),
        Command::Predict(arguments) => predict(arguments),
        Command::Solve(arguments) => solve(arguments),
        Command::Example { output } => {
            write_file(output, demonstration_csv().as_bytes())?;
            writeln!(
                std::io::stdout().lock(),
                "{}: SYNTHETIC single beads over current and deposition speed, for demonstration",
                output.display()
            )?;
            Ok(())
        }
    }
}

fn walls(arguments: &Walls) -> anyhow::Result<()> {
    let profile = profile::load(&arguments.profile, &arguments.set)?;
    let (process, mut weld) = (&profile.process, profile.weld_settings());
    // The table says how long the torch waited.
    (weld.ends.min_layer_time, weld.ends.interpass_time) = (0.0, 0.0);
    // Walls hold the metal of the wire, whatever the profile says of its bead.
    let metal = wire_area(profile.wire.diameter) * process.wire_feed_speed * 1000.0 / 60.0 * process.efficiency;
    let settings = HeatSettings { bead_area: metal / process.deposition_speed, ..profile.heat_settings()? };
    let named = ["dwell", "length", "layers"].map(str::to_owned).to_vec();
    let columns = Columns { inputs: Some(named), width: None, height: None };
    let place = || arguments.data.display().to_string();
    let measured = Measured::read(&file::text(&arguments.data)?, &columns).with_context(place)?;
    for (input, unit) in measured.inputs.iter().zip(["s", "mm", ""]) {
        anyhow::ensure!(
            input.unit == unit,
            "{}: the column {} is in \"{}\"; dwell_s, length_mm and layers are expected",
            place(),
            input.name,
            input.unit
        );
    }
    let rows = measured.rows.iter().zip(measured.heights.iter().zip(&measured.widths));
    let wall = |(row, (height, width)): (&Vec<f64>, (&f64, &f64))| {
        let [dwell, length, layers] = row[..] else { anyhow::bail!("a wall needs dwell, length and layers") };
        let possible = (0.0..=36_000.0).contains(&dwell)
            && (10.0..=10_000.0).contains(&length)
            && (2.0..=2000.0).contains(&layers)
            && layers.fract() == 0.0;
        anyhow::ensure!(
            possible,
            "a wall with a dwell of {dwell} s, a length of {length} mm and {layers} layers is impossible: 0 to 36000 s, 10 to \
             10000 mm and 2 to 2000 whole layers are expected"
        );
        let wall = Wall { length, layers: layers as usize, dwell };
        Ok(MeasuredWall { wall, height: *height, width: *width })
    };
    let all: Vec<MeasuredWall> = rows.map(wall).collect::<anyhow::Result<_>>().with_context(place)?;
    let fitted = |wall: &&MeasuredWall| arguments.fit.as_ref().is_none_or(|waits| waits.contains(&wall.wall.dwell));
    let strange = arguments.fit.iter().flatten().find(|wait| all.iter().all(|wall| wall.wall.dwell != **wait));
    if let Some(wait) = strange {
        anyhow::bail!("--fit {wait}: no wall has that wait");
    }
    let chosen: Vec<MeasuredWall> = all.iter().filter(fitted).copied().collect();
    let law = WallLaw::fit(&chosen, &settings, &weld).with_context(place)?;
    let predicted: Vec<_> = all.iter().map(|wall| law.predict(&wall.wall, &settings, &weld)).collect();
    let mut out = std::io::stdout().lock();
    if arguments.json {
        let value = json!({ "layer": law.layer, "width": law.width, "walls": predicted });
        return Ok(writeln!(out, "{value:#}")?);
    }
    for (name, value) in [("layer", law.layer), ("width", law.width)] {
        writeln!(
            out,
            "{name} = {:.3} mm {:+.3} mm for every 100 °C of the metal below",
            value.cold,
            100.0 * value.slope
        )?;
    }
    writeln!(
        out,
        "\n  wait s    °C  height mm: predicted   measured   error %  width mm: predicted   measured   error %"
    )?;
    for (wall, own) in all.iter().zip(&predicted) {
        let error = |ours: f64, measured: f64| 100.0 * (ours / measured - 1.0);
        writeln!(
            out,
            "  {:6.0} {:5.0} {:22.1} {:10.1} {:9.1} {:20.2} {:10.2} {:9.1}{}",
            wall.wall.dwell,
            own.temperature,
            own.height,
            wall.height,
            error(own.height, wall.height),
            own.width,
            wall.width,
            error(own.width, wall.width),
            if fitted(&wall) { "   fitted" } else { "" }
        )?;
    }
    let width = profile.bead.width;
    match law.by_heat(width) {
        Some(BeadByHeat { temperature, width, rise }) => writeln!(
            out,
            "\nfor the profile:\n\n[bead.by_heat]\ntemperature = {temperature:.0}\nwidth = {width:.5}\nrise = {rise:.5}"
        )?,
        None => writeln!(
            out,
            "\nno section [bead.by_heat]: the walls are not {width} mm wide, as bead.width says, at any temperature"
        )?,
    }
    Ok(())
}

fn fit(arguments: &Fit) -> anyhow::Result<()> {
    let Some(data) = &arguments.data else {
        anyhow::ensure!(
            arguments.want.is_none(),
            "--want needs the sheet of measured beads: records alone hold no sizes."
        );
        let profile = arguments.profile.as_deref();
        return crate::learn::run(&crate::learn::Wanted {
            records: &arguments.from,
            profile: profile.context("name the profile with which the recorded parts were planned (-p).")?,
            to: arguments.to.as_deref(),
            page: &arguments.page,
            json: arguments.json,
        });
    };
    let text = crate::learn::into_sheet(&file::text(data)?, &arguments.from)?;
    if let Some(found) = Found::read(&text).with_context(|| data.display().to_string())? {
        anyhow::ensure!(
            arguments.want.is_none() && arguments.plot.is_none() && arguments.inputs.is_none(),
            "--want, --plot and --inputs need a sheet of single beads: this one is of starts and ends, of corners, or of beads side \
             by side."
        );
        let (profile, to) = (arguments.profile.as_deref(), arguments.to.as_deref());
        let wanted = crate::found::Wanted { profile, to, valley: arguments.valley, json: arguments.json };
        return crate::found::run(&found, &wanted);
    }
    anyhow::ensure!(
        arguments.valley.is_none(),
        "--valley needs a sheet of beads side by side (bead trial --shape overlap)."
    );
    let goes_into_profile = arguments.to.is_some() || arguments.profile.is_some() && arguments.from.is_empty();
    anyhow::ensure!(
        !goes_into_profile || arguments.want.is_some(),
        "--profile and --to need --want where beads are fitted."
    );
    let columns = Columns {
        inputs: arguments.inputs.clone(),
        width: Some(arguments.width.clone()),
        height: Some(arguments.height.clone()),
    };
    let measured = Measured::read(&text, &columns).with_context(|| data.display().to_string())?;
    let library = BeadLibrary::fit(&measured).with_context(|| data.display().to_string())?;
    let recipe = arguments.want.map(|want| wanted(arguments, &library, want)).transpose()?;
    let in_profile = recipe.as_ref().filter(|_| goes_into_profile);
    let profile = in_profile.map(|recipe| with_recipe(arguments, &library, recipe)).transpose()?;
    write_file(&arguments.output, library.to_toml().as_bytes())?;
    if let (Some(path), Some(text)) = (&arguments.to, &profile) {
        write_file(path, text.as_bytes())?;
    }
    if let Some(path) = &arguments.plot {
        write_file(path, bead_window::plot(&library).svg().as_bytes())?;
    }
    let mut out = std::io::stdout().lock();
    if arguments.json {
        let value = json!({ "synthetic": library.synthetic, "beads": library.measured.len(), "terms": library.terms, "inputs": library.inputs, "width": library.width, "height": library.height, "notes": library.notes, "next": library.next_trial(recipe.as_ref().map(|recipe| &recipe.values[..])).0,
            "recipe": recipe.map(|recipe| as_json(&library, &recipe.values, &recipe.prediction, recipe.layer_height, &recipe.notes)) });
        writeln!(out, "{value:#}")?;
        return Ok(());
    }
    warn(&mut out, &library)?;
    writeln!(out, "{} beads, {} terms\n", library.measured.len(), library.terms.len())?;
    for input in &library.inputs {
        writeln!(out, "  {:<20} {} to {} {}", input.name, input.min, input.max, input.unit)?;
    }
    writeln!(
        out,
        "\n  {:<8} {:>8} {:>12} {:>14} {:>18}",
        "", "R²", "adjusted R²", "residual, mm", "leave-one-out, mm"
    )?;
    for (name, r) in [("width", &library.width), ("height", &library.height)] {
        writeln!(out, "{}", goodness(name, r))?;
    }
    library.notes.iter().try_for_each(|note| writeln!(out, "note: {note}"))?;
    let (next, least) = library.next_trial(recipe.as_ref().map(|recipe| &recipe.values[..]));
    writeln!(
        out,
        "\nthe next bead that tells most{}: {} (width ± {:.2} mm, height ± {:.2} mm there so far)",
        if recipe.is_some() { " about the wanted one" } else { "" },
        library.describe(&next),
        least.width.plus_minus,
        least.height.plus_minus
    )?;
    if let Some(recipe) = &recipe {
        writeln!(out)?;
        print_recipe(&mut out, &library, recipe)?;
        if let Some(path) = &arguments.to {
            writeln!(out, "\nprofile in {}: beadwright plan PART -p {}", path.display(), path.display())?;
        }
    }
    let plot = arguments.plot.as_ref().map_or(String::new(), |p| format!(", plot in {}", p.display()));
    writeln!(out, "\nlibrary in {}{plot}", arguments.output.display())?;
    Ok(())
}

fn check_table(arguments: &CheckTable) -> anyhow::Result<()> {
    let rows = printed_rows(&file::text(&arguments.data)?).with_context(|| arguments.data.display().to_string())?;
    let mut out = std::io::stdout().lock();
    if arguments.json {
        let row = |row: &PrintedRow| json!({ "area_mm2": row.area, "metal_mm3_per_a_s": row.metal, "others_mm3_per_a_s": row.others, "contradicts": row.contradicts() });
        let value = json!({ "rows": rows.iter().map(row).collect::<Vec<_>>() });
        return Ok(writeln!(out, "{value:#}")?);
    }
    writeln!(out, "  row  current A  speed mm/s  bead mm²  mm³/(A·s)  others")?;
    for (k, row) in rows.iter().enumerate() {
        let PrintedRow { area, current, speed, metal, others, .. } = row;
        writeln!(out, "  {:3} {current:10.0} {speed:11.1} {area:9.2} {metal:10.3} {others:7.3}", k + 1)?;
    }
    let mut agrees = true;
    for (k, row) in rows.iter().enumerate().filter(|(_, row)| row.contradicts()) {
        let (speed, width, current) = row.agreeing();
        agrees = false;
        writeln!(
            out,
            "\nrow {} contradicts the others by {:+.0} %: {speed:.1} mm/s, a width of {width:.2} mm or {current:.0} A would agree. One \
             of its values is a misprint, or it was welded with another wire or gas.",
            k + 1,
            100.0 * (row.metal / row.others - 1.0)
        )?;
    }
    if agrees {
        writeln!(out, "\nall rows agree: metal per ampere and second is nearly the same")?;
    }
    Ok(())
}

fn goodness(name: &str, r: &Response) -> String {
    let left_out = r.leave_one_out.map_or("not possible".to_owned(), |v| format!("{v:.3}"));
    format!("  {name:<8} {:>8.4} {:>12.4} {:>14.3} {left_out:>18}", r.r_squared, r.adjusted_r_squared, r.residual)
}

fn predict(arguments: &Predict) -> anyhow::Result<()> {
    let library = load(&arguments.library)?;
    let values = library.arrange(&arguments.values)?;
    let found = library.predict(&values)?;
    let layer_height = arguments.layering.layering(found.width.value)?.height(&found);
    let mut out = std::io::stdout().lock();
    if arguments.json {
        writeln!(out, "{:#}", as_json(&library, &values, &found, layer_height, &[]))?;
        return Ok(());
    }
    warn(&mut out, &library)?;
    print_bead(&mut out, &found, layer_height)?;
    Ok(())
}

fn solve(arguments: &Solve) -> anyhow::Result<()> {
    let library = load(&arguments.library)?;
    let wish = Wish {
        layering: arguments.layering.layering(arguments.width)?,
        limits: arguments.limit.clone(),
        tolerance: arguments.tolerance / 100.0,
        ..Wish::new(arguments.width, arguments.layer_height)
    };
    let recipe = library.solve(&wish)?;
    let mut out = std::io::stdout().lock();
    if arguments.json {
        let value = as_json(&library, &recipe.values, &recipe.prediction, recipe.layer_height, &recipe.notes);
        writeln!(out, "{value:#}")?;
        return Ok(());
    }
    warn(&mut out, &library)?;
    Ok(print_recipe(&mut out, &library, &recipe)?)
}

fn print_recipe(out: &mut impl Write, library: &BeadLibrary, recipe: &Recipe) -> std::io::Result<()> {
    for (input, value) in library.inputs.iter().zip(&recipe.values) {
        writeln!(out, "  {:<20} {value:.2} {}", input.name, input.unit)?;
    }
    print_bead(out, &recipe.prediction, recipe.layer_height)?;
    recipe.notes.iter().try_for_each(|note| writeln!(out, "note: {note}"))
}

/// The parameters for a bead of this width and layer height, mm.
fn wanted(arguments: &Fit, library: &BeadLibrary, (width, layer_height): (f64, f64)) -> anyhow::Result<Recipe> {
    let (layering, tolerance) = (arguments.layering.layering(width)?, arguments.tolerance / 100.0);
    let wish = Wish { layering, tolerance, ..Wish::new(width, layer_height) };
    Ok(library.solve(&wish)?)
}

/// The text of the profile with a recipe: what no key of a profile is called by stays in the sheet.
fn with_recipe(arguments: &Fit, library: &BeadLibrary, recipe: &Recipe) -> anyhow::Result<String> {
    let bead = recipe.prediction.bead();
    let lengths = [("bead.width", bead.width), ("bead.height", bead.height), ("layers.height", recipe.layer_height)];
    let key = |name: &str| match name {
        "current" => Some("process.current"),
        "voltage" => Some("process.voltage"),
        _ => Parameter::named(name)?.key(),
    };
    let inputs = library.inputs.iter().zip(&recipe.values);
    let process = inputs.filter_map(|(input, value)| Some((key(&input.name)?, *value)));
    let name = arguments.profile.as_deref().unwrap_or(profile::USUAL);
    let weaves = profile::load(name, &[])?.weave.is_some();
    let mut text = profile::text(name)?;
    for (key, value) in process.chain(lengths) {
        anyhow::ensure!(
            weaves || !key.starts_with("weave."),
            "the trials vary {key}, and {name} does not weave: name the profile with which they were welded (-p)."
        );
        text = edit::with_value(&text, key, &format!("{value:.3}"))?;
    }
    profile::parse(&text, &profile::folder(name)).context("the profile with the wanted bead")?;
    Ok(text)
}

fn print_bead(out: &mut impl Write, found: &Prediction, layer_height: f64) -> std::io::Result<()> {
    let estimate = |e: &beadwright::bead::library::Estimate| format!("{:.2} ± {:.2} mm", e.value, e.plus_minus);
    writeln!(out, "  {:<20} {}", "bead width", estimate(&found.width))?;
    writeln!(out, "  {:<20} {}", "bead height", estimate(&found.height))?;
    writeln!(out, "  {:<20} {:.2}", "width/height", found.ratio())?;
    writeln!(out, "  {:<20} {layer_height:.2} mm", "layer height")
}

fn as_json(library: &BeadLibrary, values: &[f64], found: &Prediction, layer_height: f64, notes: &[String]) -> Value {
    let parameter = |(input, value): (&beadwright::bead::library::Input, &f64)| {
        (input.name.clone(), json!({ "value": value, "unit": input.unit }))
    };
    let parameters: Map<String, Value> = library.inputs.iter().zip(values).map(parameter).collect();
    json!({
        "synthetic": library.synthetic, "parameters": parameters, "width_mm": found.width, "height_mm": found.height,
        "width_over_height": found.ratio(), "leverage": found.leverage, "layer_height_mm": layer_height, "notes": notes,
    })
}

/// Invented data is labelled as such wherever it is shown.
fn warn(out: &mut impl Write, library: &BeadLibrary) -> std::io::Result<()> {
    if library.synthetic {
        writeln!(out, "SYNTHETIC data for demonstration: no bead was measured.\n")?;
    }
    Ok(())
}

fn load(path: &Path) -> anyhow::Result<BeadLibrary> {
    BeadLibrary::parse(&file::text(path)?).with_context(|| path.display().to_string())
}

fn parse_bead(text: &str) -> Result<(f64, f64), String> {
    let (width, height) = text.split_once(['x', '×']).ok_or("WIDTHxHEIGHT is expected, such as 6x2")?;
    Ok((number(width)?, number(height)?))
}

fn parse_value(text: &str) -> Result<(String, f64), String> {
    let (name, value) = text.split_once('=').ok_or("NAME=VALUE is expected, such as current=120")?;
    Ok((name.trim().to_owned(), number(value)?))
}

fn parse_valley(text: &str) -> Result<f64, String> {
    let depth = number(text)?;
    if (0.0..=50.0).contains(&depth) { Ok(depth) } else { Err("a depth of 0 to 50 mm is expected".to_owned()) }
}

fn parse_limit(text: &str) -> Result<Limit, String> {
    let (name, range) = text.split_once('=').ok_or("NAME=MIN..MAX is expected, such as current=100..150")?;
    let (min, max) = range.split_once("..").unwrap_or((range, range));
    Ok(Limit { input: name.trim().to_owned(), min: number(min)?, max: number(max)? })
}

fn number(text: &str) -> Result<f64, String> {
    let value = text.trim().parse().ok().filter(|v: &f64| v.is_finite());
    value.ok_or_else(|| format!("\"{}\" is not a number", text.trim()))
}
