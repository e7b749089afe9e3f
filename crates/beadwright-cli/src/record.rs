//! `beadwright record`: a plan joined with the logs of its build, as a record that shows later changes.

use crate::{file, profile, program, progress, say, scanned};
use anyhow::Context;
use beadwright::export::Beads;
use beadwright::files::Folder;
use beadwright::heat::{self, HeatSettings};
use beadwright::layer::Layer;
use beadwright::profile::Profile;
use beadwright::record::{
    self, Broken, FileHash, Finding, JSON, Moved, Part, PlannedPass, Quantity, Record, Scanned, Settings, Source,
};
use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::{BufReader, Write};
use std::path::{Path, PathBuf};

#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// plan.json of the part; with --verify, it is compared with the one that was read.
    #[arg(required_unless_present = "verify")]
    plan: Option<PathBuf>,
    #[command(flatten)]
    wanted: profile::Wanted,
    /// Log of the build as CSV: of the controller, the power source, a pyrometer; may be given several times.
    #[arg(long, value_name = "FILE", required_unless_present = "verify")]
    source: Vec<PathBuf>,
    /// Name of a column for current, voltage, wire_feed_speed, speed, temperature or arc, where a log calls it otherwise; may be given
    /// several times.
    #[arg(long, value_name = "QUANTITY=COLUMN", value_parser = parse_column)]
    column: Vec<(Quantity, String)>,
    /// What else belongs to the part, such as wire_batch=…, gas=…, operator=…, wps=…; may be given several times.
    #[arg(long, value_name = "NAME=VALUE", value_parser = parse_pair)]
    trace: Vec<(String, String)>,
    /// The same from a TOML file.
    #[arg(long, value_name = "FILE")]
    trace_file: Option<PathBuf>,
    /// File to be covered by its hash, such as the program that was run; may be given several times.
    #[arg(long, value_name = "FILE")]
    file: Vec<PathBuf>,
    /// How far a quantity may differ from the plan, in per cent; by default 10 for wire_feed_speed, current, voltage and speed; may be
    /// given several times.
    #[arg(long, value_name = "QUANTITY=PERCENT", value_parser = parse_window)]
    window: Vec<(Quantity, f64)>,
    /// Shortest stretch out of its window that counts, s.
    #[arg(long, value_name = "S")]
    least: Option<f64>,
    /// Scan of the build: PLY, STL, lines of x, y, z in mm, or a height map, with z = 0 on the plate; may be given several times, each
    /// with its --after-layer.
    #[arg(long, value_name = "FILE")]
    scan: Vec<PathBuf>,
    /// Layer after which the scan was taken, counted from 1.
    #[arg(long, value_name = "LAYER", value_parser = clap::value_parser!(u32).range(1..))]
    after_layer: Vec<u32>,
    #[command(flatten)]
    scanner: scanned::Scanner,
    /// How far the top of a pass may be from its planned height, mm; by default half of layers.height.
    #[arg(long, value_name = "MM", requires = "scan")]
    height: Option<f64>,
    /// Shortest stop of the build that is reported, s longer than planned.
    #[arg(long, value_name = "S")]
    stop: Option<f64>,
    /// Also compute how warm the metal should have been before each pass.
    #[arg(long)]
    temperatures: bool,
    /// Folder to write to.
    #[arg(short, long, default_value = "record", value_name = "FOLDER")]
    output: PathBuf,
    /// Say what was changed in the record of this folder since it was written, instead of writing one.
    #[arg(long, value_name = "FOLDER", conflicts_with_all = ["trace", "trace_file", "window", "least", "stop", "after_layer", "height", "temperatures"])]
    verify: Option<PathBuf>,
    /// With --verify: the seal that was printed when the record was written.
    #[arg(long, requires = "verify", value_name = "HASH")]
    seal: Option<String>,
    /// Print machine-readable JSON: what is doubtful, or with --verify what was changed.
    #[arg(long)]
    json: bool,
}

/// Findings that are printed.
const SHOWN: usize = 12;

fn parse_pair(text: &str) -> Result<(String, String), String> {
    let (name, value) = text.split_once('=').ok_or("NAME=VALUE is expected, such as wire_batch=4711")?;
    let (name, value) = (name.trim(), value.trim());
    if name.is_empty() { Err("the name is missing".to_owned()) } else { Ok((name.to_owned(), value.to_owned())) }
}

fn parse_quantity(name: &str) -> Result<Quantity, String> {
    Quantity::ALL.into_iter().find(|quantity| quantity.name() == name).ok_or_else(|| {
        format!("\"{name}\" is not a quantity of a log. Known: {}.", Quantity::ALL.map(Quantity::name).join(", "))
    })
}

fn parse_column(text: &str) -> Result<(Quantity, String), String> {
    let (name, column) = parse_pair(text)?;
    Ok((parse_quantity(&name)?, column))
}

fn parse_window(text: &str) -> Result<(Quantity, f64), String> {
    let (name, percent) = parse_pair(text)?;
    let quantity = parse_quantity(&name)?;
    if !Quantity::PLANNED.contains(&quantity) {
        return Err(format!("no {name} is planned. Planned: {}.", Quantity::PLANNED.map(Quantity::name).join(", ")));
    }
    let percent = percent.trim_end_matches('%').trim();
    Ok((quantity, percent.parse().map_err(|_| format!("\"{percent}\" is not a number of per cent"))?))
}

pub(crate) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    match &arguments.verify {
        Some(folder) => verify(arguments, folder),
        None => write(arguments),
    }
}

fn write(arguments: &Arguments) -> anyhow::Result<()> {
    let path = arguments.plan.as_deref().context("give the plan.json of the part")?;
    let opened = program::Source::open(path)?;
    let plan = opened.plan().with_context(|| format!("{}: give the plan.json of the program", path.display()))?;
    let profile = opened.profile(&arguments.wanted)?;
    let place = arguments.place(path, &plan.layers, &profile)?;
    let heat = arguments.temperatures.then(|| {
        let over = Some(plan.header.extent.seen_from_above());
        let settings = HeatSettings { interpass: None, over, ..profile.heat_settings()? };
        let (task, bar) = progress::task()?;
        let heat = heat::history(&mut plan.layers.clone(), &settings, &profile.weld_settings(), &task)?;
        bar.finish_and_clear();
        anyhow::Ok(heat)
    });
    let heat = heat.transpose()?.flatten();
    let beads = Beads { header: &plan.header, layers: &plan.layers, profile: &profile, heat: heat.as_ref() };
    let planned = record::planned(&beads);
    let sources =
        arguments.source.iter().map(|path| log(path, &arguments.column)).collect::<anyhow::Result<Vec<_>>>()?;
    let unknown = |(quantity, _): &&(Quantity, String)| sources.iter().all(|source| source.column(*quantity).is_none());
    if let Some((quantity, column)) = arguments.column.iter().find(unknown) {
        anyhow::bail!("--column {}={column}: no log has such a column.", quantity.name());
    }
    let settings = arguments.settings(record::settings(&profile));
    let mut record = record::join(&planned, &sources, &settings).with_context(|| format!("{}", path.display()))?;
    let scans = arguments.scans(&place, &plan.layers, &profile, &planned)?;
    scans.iter().for_each(|scan| record.add_heights(&planned, &scan.shown.heights, &settings));
    drop(sources);
    let (trace, inputs) = (arguments.traced()?, arguments.inputs()?);
    let part = Part {
        header: &plan.header,
        layers: &plan.layers,
        profile: &profile,
        planned: &planned,
        record: &record,
        settings: &settings,
        trace: &trace,
        scans: &scans,
        inputs: &inputs,
    };
    let sealed = part.files()?;
    let mut folder = Folder::new(&arguments.output)?;
    sealed.files.iter().try_for_each(|(name, bytes)| folder.append(name, bytes))?;
    folder.commit()?;
    if arguments.json {
        let Record { findings, logs, .. } = &record;
        let said = serde_json::json!({ "findings": findings, "logs": logs, "scans": scans, "seal": sealed.seal });
        return Ok(writeln!(std::io::stdout(), "{said:#}")?);
    }
    print(&part, &sealed.seal, &arguments.output)
}

fn print(part: &Part<'_>, seal: &str, folder: &Path) -> anyhow::Result<()> {
    let Record { passes, findings, logs } = part.record;
    let mut out = say::done(false);
    writeln!(out, "{}: {}\n", part.header.part, part.summary())?;
    for log in logs {
        writeln!(
            out,
            "  {:<24} {} rows, {} arcs, {} of them aligned within {:.2} s",
            log.name, log.tally.rows, log.arcs, log.matched, log.within
        )?;
    }
    for Scanned { file, after_layer, shown, .. } in part.scans {
        let ([seen, all], off) = (shown.passes, shown.off().map_or(0.0, |off| off.mean));
        writeln!(
            out,
            "  {file:<24} {seen} of {all} passes of layer {after_layer}, {:.0} % of their length: the tops are {off:+.2} mm from the plan \
             on average",
            100.0 * shown.covered
        )?;
    }
    let mut warnings = say::warnings();
    for Finding { sentence, .. } in findings.iter().take(SHOWN) {
        writeln!(warnings, "warning: {sentence}")?;
    }
    if findings.len() > SHOWN {
        writeln!(warnings, "warning: {} more findings are in {}.", findings.len() - SHOWN, folder.display())?;
    }
    writeln!(
        out,
        "\n{} passes in {}; keep the seal elsewhere, to be able to prove that nothing was changed:\n{seal}",
        passes.len(),
        folder.display()
    )?;
    Ok(())
}

/// A log, read row by row.
fn log(path: &Path, columns: &[(Quantity, String)]) -> anyhow::Result<Source> {
    let context = || format!("{}", path.display());
    let opened = File::open(path).with_context(context)?;
    anyhow::ensure!(opened.metadata().with_context(context)?.is_file(), "{}: this is not a file", path.display());
    Source::read(&name(path), BufReader::with_capacity(1 << 18, opened), columns).with_context(context)
}

fn name(path: &Path) -> String {
    path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default()
}

/// `1 scan`, `2 scans`.
fn several(count: usize, what: &str) -> String {
    format!("{count} {what}{}", if count == 1 { "" } else { "s" })
}

impl Arguments {
    fn settings(&self, usual: Settings) -> Settings {
        let mut windows: BTreeMap<Quantity, f64> = usual.windows.iter().copied().collect();
        windows.extend(self.window.iter().copied());
        Settings {
            windows: windows.into_iter().collect(),
            least: self.least.unwrap_or(usual.least),
            stop: self.stop.unwrap_or(usual.stop),
            height: self.height.or(usual.height),
            ..usual
        }
    }

    /// Where the scans lie; an error if they cannot be compared with layers of the plan.
    fn place(&self, plan: &Path, layers: &[Layer], profile: &Profile) -> anyhow::Result<scanned::Place> {
        let (scans, numbers) = (self.scan.len(), &self.after_layer);
        anyhow::ensure!(
            scans == numbers.len(),
            "Each --scan needs its --after-layer ({}, {} given).",
            several(scans, "scan"),
            several(numbers.len(), "layer")
        );
        anyhow::ensure!(
            scans > 0 || self.scanner.file().is_none(),
            "--scanner says where scans lie: give them with --scan and --after-layer, or leave it out."
        );
        if let Some((_, number)) = numbers.iter().enumerate().find(|(k, number)| numbers[..*k].contains(number)) {
            anyhow::bail!("--after-layer {number} is given twice: put the scans of a layer into one file.");
        }
        let known = |number: &u32| record::scannable(layers, profile, *number as usize).map(|_| ());
        numbers.iter().try_for_each(known).with_context(|| plan.display().to_string())?;
        self.scanner.place()
    }

    /// What each scan shows of the passes of its layer.
    fn scans(
        &self,
        place: &scanned::Place,
        layers: &[Layer],
        profile: &Profile,
        planned: &[PlannedPass],
    ) -> anyhow::Result<Vec<Scanned>> {
        if self.scan.is_empty() {
            return Ok(Vec::new());
        }
        let (task, bar) = progress::task()?;
        let of_scan = |(path, number): (&PathBuf, &u32)| {
            let (scan, after_layer) = (place.read(path, 1.0, &task)?, *number as usize);
            let shown = record::heights(layers, profile, planned, &scan.points, after_layer);
            let shown = shown.with_context(|| path.display().to_string())?;
            Ok(Scanned { file: name(path), after_layer, part_from_scanner: place.0.map(Moved::from), shown })
        };
        let all = self.scan.iter().zip(&self.after_layer).map(of_scan).collect();
        bar.finish_and_clear();
        all
    }

    /// What else belongs to the part: of the file, and given one by one.
    fn traced(&self) -> anyhow::Result<Vec<(String, String)>> {
        let mut trace = match &self.trace_file {
            Some(path) => record::trace(&file::text(path)?).with_context(|| format!("{}", path.display()))?,
            None => Vec::new(),
        };
        trace.extend(self.trace.iter().cloned());
        Ok(trace)
    }

    /// The files that belong to the part, with their hashes.
    fn inputs(&self) -> anyhow::Result<Vec<FileHash>> {
        let hash = |path: &PathBuf| {
            File::open(path)
                .and_then(|opened| FileHash::read(&name(path), opened))
                .with_context(|| format!("{}", path.display()))
        };
        let cell = self.scanner.file();
        self.plan.iter().chain(&self.source).chain(&self.scan).chain(&cell).chain(&self.file).map(hash).collect()
    }
}

fn verify(arguments: &Arguments, folder: &Path) -> anyhow::Result<()> {
    let path = folder.join(JSON);
    // As it is, so that a changed line end shows too.
    let bytes = fs::read(&path).with_context(|| format!("{}", path.display()))?;
    let text = String::from_utf8(bytes).unwrap_or_default();
    let mut broken = record::verify(&text, arguments.seal.as_deref(), &mut |name| {
        fs::read(folder.join(Path::new(name).file_name()?)).ok()
    });
    broken.extend(record::other_inputs(&text, &arguments.inputs()?));
    if arguments.json {
        let changed: Vec<String> = broken.iter().map(Broken::to_string).collect();
        writeln!(std::io::stdout(), "{:#}", serde_json::json!({ "whole": broken.is_empty(), "changed": changed }))?;
    } else if broken.is_empty() {
        writeln!(say::done(false), "{}: the record is whole.", folder.display())?;
    } else {
        let mut out = say::warnings();
        broken.iter().try_for_each(|broken| writeln!(out, "warning: {broken}."))?;
    }
    match broken.len() {
        0 => Ok(()),
        count => Err(say::Findings { count, place: folder.to_owned() }.into()),
    }
}
