//! Strategies and programs side by side: what each lays, and what the deposit model says about it.

use crate::deposit::{DepositSettings, Figures, Judge, Patch, Picture, Stack, stack::Growth};
use crate::dialect::reading::ReadTotals;
use crate::fill::StrategyName;
use crate::layer::{self, Layer};
use crate::metrics::Metrics;
use crate::model::Mesh;
use crate::pass::{Pass, Segment};
use crate::plan::{self, AsWelded, Header, PlanError, Sink};
use crate::profile::{CheckLimits, Profile};
use crate::report::encode;
use crate::report::plot::{Curve, Plot};
use crate::report::sheet::Sheet;
use crate::report::steps;
use crate::slice::{BATCH, Slicer};
use crate::task::{Cancelled, Stage, Task};
use glam::DVec2;
use planar::Bounds;
use serde::Serialize;
use std::collections::BTreeSet;
use std::convert::Infallible;

/// Which layers are judged, by index from 0; `None` for all.
pub type Chosen = Option<BTreeSet<usize>>;

/// One strategy or program.
#[derive(Debug, Clone, PartialEq)]
pub struct Entry {
    /// Name of the strategy or of the file.
    pub name: String,
    /// Its arc starts, lengths, times and metal.
    pub totals: Totals,
    /// What the deposit model says about the judged layers together.
    pub figures: Figures,
    /// The judged layers.
    pub layers: Vec<JudgedLayer>,
    /// How the part grows, layer by layer; empty where only some layers are judged.
    pub growth: Vec<Growth>,
    /// How it ends; `None` where only some layers are judged.
    pub built: Option<Growth>,
}

/// Arc starts, lengths, times and metal of a strategy or program.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Totals {
    /// Arc starts, one per pass.
    pub arc_starts: usize,
    /// Length of all beads, mm.
    pub deposited_length_mm: f64,
    /// Length of all other moves, mm.
    pub travel_length_mm: f64,
    /// Total time, s.
    pub total_time_s: f64,
    /// Wire or filament, by volume, mm³.
    pub metal_volume_mm3: f64,
    /// Turns sharper than 30° within passes.
    pub turns: usize,
    /// The shortest time that the torch moves with the arc on in one pass, s; `None` without passes.
    pub shortest_arc_s: Option<f64>,
    /// Time for gas, starting and ending the arc, and for craters, s.
    pub start_stop_time_s: f64,
    /// Time lost to slowing down before corners and ends, s.
    pub corner_time_s: f64,
}

/// One layer of an entry.
#[derive(Debug, Clone, PartialEq)]
pub struct JudgedLayer {
    /// Index from 0.
    pub index: usize,
    /// Top of the layer, mm.
    pub z: f64,
    /// Its figures.
    pub figures: Figures,
    /// The largest voids.
    pub voids: Vec<Patch>,
    /// The highest peaks.
    pub peaks: Vec<Patch>,
    /// Its height field.
    pub picture: Option<Picture>,
    /// Its passes in the compact form of pages ([`encode::shape`]).
    pub beads: String,
}

/// Pixels of a height field, along its longer side.
pub const MAP_PIXELS: usize = 320;

/// Patches kept of each layer.
const KEPT_PATCHES: usize = 8;

/// Judges layers as they come.
struct EntryBuilder<'a> {
    judge: Judge,
    chosen: &'a Chosen,
    layers: Vec<JudgedLayer>,
    turns: usize,
}

impl<'a> EntryBuilder<'a> {
    fn new(settings: DepositSettings, bounds: &Bounds, chosen: &'a Chosen) -> Self {
        let judge = Judge::new(settings).with_pictures(MAP_PIXELS);
        // Beads are laid on all layers below, so all must be judged.
        let judge = if chosen.is_none() { judge.with_stack(bounds) } else { judge };
        Self { judge, chosen, layers: Vec::new(), turns: 0 }
    }

    fn take(&mut self, layer: &Layer) {
        self.turns += layer.passes.iter().map(Pass::turns).sum::<usize>();
        if self.chosen.as_ref().is_some_and(|chosen| !chosen.contains(&layer.index)) {
            return;
        }
        let mut judged = self.judge.layer(layer);
        judged.voids.truncate(KEPT_PATCHES);
        judged.peaks.truncate(KEPT_PATCHES);
        let (index, z) = (layer.index, layer.z);
        let (figures, voids, peaks, picture) = (judged.figures, judged.voids, judged.peaks, judged.picture);
        self.layers.push(JudgedLayer { index, z, figures, voids, peaks, picture, beads: encode::shape(layer) });
    }

    fn entry(self, name: &str, totals: Totals) -> Entry {
        let stack = self.judge.stack();
        let (growth, built) =
            (stack.map_or_else(Vec::new, |stack| stack.growth().to_vec()), stack.and_then(Stack::built));
        Entry { name: name.to_owned(), totals, figures: *self.judge.total(), layers: self.layers, growth, built }
    }
}

/// Judges the layers of a plan as they are welded.
struct Planned<'a> {
    entry: EntryBuilder<'a>,
    welded: AsWelded<'a>,
}

impl Sink for Planned<'_> {
    type Error = Infallible;

    fn begin(&mut self, _: &Header) -> Result<(), Infallible> {
        Ok(())
    }

    fn layer(&mut self, layer: Layer) -> Result<(), Infallible> {
        self.entry.take(&self.welded.alone(&layer));
        Ok(())
    }
}

fn bounds(mesh: &Mesh) -> Bounds {
    let (low, high) = mesh.bounds();
    Bounds { min: low.truncate(), max: high.truncate() }
}

/// Plans a mesh with a strategy and judges the chosen layers; only these are kept.
///
/// ```
/// use beadwright::{Profile, StrategyName, Task, compare, example, plan};
/// use std::collections::BTreeSet;
///
/// // Only the lowest layer is judged.
/// let profile = Profile::built_in("cmt-al2319-kuka")?;
/// let cross = example::find("cross").ok_or("no such example")?.mesh();
/// let (settings, lowest) = (plan::deposit_settings(&profile), Some(BTreeSet::from([0])));
/// let entry = compare::strategy(&cross, &profile, StrategyName::Zigzag, settings, &lowest, &Task::new())?;
/// assert_eq!((entry.name.as_str(), entry.layers.len()), ("zigzag", 1));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`PlanError`].
pub fn strategy(
    mesh: &Mesh,
    profile: &Profile,
    name: StrategyName,
    settings: DepositSettings,
    chosen: &Chosen,
    task: &Task,
) -> Result<Entry, PlanError<Infallible>> {
    let mut profile = profile.clone();
    profile.fill.strategy = name;
    let mut planned =
        Planned { entry: EntryBuilder::new(settings, &bounds(mesh), chosen), welded: AsWelded::of(&profile) };
    let metrics = plan::plan_into(name.name(), mesh, &profile, task, &mut planned)?.metrics;
    let entry = planned.entry;
    let totals = Totals { turns: entry.turns, ..Totals::of_plan(&metrics) };
    Ok(entry.entry(name.name(), totals))
}

impl Totals {
    /// The totals of a plan.
    pub fn of_plan(metrics: &Metrics) -> Self {
        Self {
            arc_starts: metrics.arc_starts,
            deposited_length_mm: metrics.deposited_length_mm,
            travel_length_mm: metrics.travel_length_mm,
            total_time_s: metrics.total_time_s,
            metal_volume_mm3: metrics.deposited_volume_mm3,
            turns: 0,
            shortest_arc_s: metrics.shortest_arc_s,
            start_stop_time_s: metrics.start_stop_time_s,
            corner_time_s: metrics.corner_time_s,
        }
    }

    /// The totals of a program read back, with its `layers`. The profile gives the times of its starts, ends and
    /// corners.
    pub fn of_program(totals: &ReadTotals, layers: &[Layer], profile: &Profile) -> Self {
        let nominal = plan::deposit_settings(profile).nominal;
        let mut metrics = Metrics::new(profile);
        layers.iter().for_each(|layer| metrics.add(layer));
        let metal = |s: Segment| s.length() * nominal.bead_at(s.width, s.pace).area();
        Self {
            arc_starts: totals.arc_starts,
            deposited_length_mm: totals.deposited_length_mm,
            travel_length_mm: totals.travel_length_mm,
            total_time_s: totals.time_s,
            metal_volume_mm3: layers.iter().flat_map(|l| &l.passes).flat_map(Pass::segments).map(metal).sum(),
            ..Self::of_plan(&metrics)
        }
    }
}

/// Judges the chosen layers of a program or plan. `layers` hold the islands of the part.
///
/// # Errors
/// [`Cancelled`].
pub fn program(
    name: &str,
    layers: &[Layer],
    totals: Totals,
    settings: DepositSettings,
    chosen: &Chosen,
    task: &Task,
) -> Result<Entry, Cancelled> {
    let bounds = layer::bounds(layers).unwrap_or(Bounds { min: DVec2::ZERO, max: DVec2::ZERO });
    let mut entry = EntryBuilder::new(settings, &bounds, chosen);
    for (done, layer) in layers.iter().enumerate() {
        task.step(Stage::Deposit, done as f64 / layers.len() as f64)?;
        entry.take(layer);
    }
    let totals = Totals { turns: entry.turns, ..totals };
    Ok(entry.entry(name, totals))
}

/// One column of the comparison.
pub struct Column {
    /// Heading, with unit.
    pub name: &'static str,
    /// Decimals shown.
    pub decimals: usize,
    /// Its value.
    pub value: fn(&Entry) -> f64,
    /// Whether a greater value is better.
    pub more: bool,
}

/// The columns.
pub const COLUMNS: [Column; 14] = [
    Column { name: "arc starts", decimals: 0, value: |e| e.totals.arc_starts as f64, more: false },
    Column { name: "bead m", decimals: 2, value: |e| e.totals.deposited_length_mm / 1e3, more: false },
    Column { name: "travel m", decimals: 2, value: |e| e.totals.travel_length_mm / 1e3, more: false },
    Column { name: "time min", decimals: 1, value: |e| e.totals.total_time_s / 60.0, more: false },
    Column { name: "metal cm³", decimals: 1, value: |e| e.totals.metal_volume_mm3 / 1e3, more: false },
    Column { name: "turns", decimals: 0, value: |e| e.totals.turns as f64, more: false },
    Column { name: "shortest s", decimals: 1, value: |e| e.totals.shortest_arc_s.unwrap_or_default(), more: true },
    Column { name: "starts min", decimals: 1, value: |e| e.totals.start_stop_time_s / 60.0, more: false },
    Column { name: "corners min", decimals: 1, value: |e| e.totals.corner_time_s / 60.0, more: false },
    Column { name: "void %", decimals: 2, value: |e| e.figures.void_percent(), more: false },
    Column { name: "low %", decimals: 2, value: |e| e.figures.low_percent(), more: false },
    Column { name: "overfill %", decimals: 2, value: |e| e.figures.overfill_percent(), more: false },
    Column { name: "outside %", decimals: 2, value: |e| e.figures.outside_percent(), more: false },
    Column { name: "score", decimals: 1, value: Entry::score, more: false },
];

/// How the score is computed, in words.
pub const SCORE: &str = "score: 10 for each % of void and of metal outside, 1 for each % of overfill, \
                         10 for each arc start per metre of bead; the lowest score is best.";

/// What becomes of those that leave the part empty, in words.
pub const GATE: &str = "What leaves more than 5 % of the area void, or 25 % low, comes last and is never best.";

/// The most that may stay void and low, % of the area ([`GATE`] names both): with less metal than that, short times and
/// few starts are no merits.
const MOST_VOID: f64 = 5.0;
const MOST_LOW: f64 = 25.0;

impl Entry {
    /// Whether the part is filled well enough for all other figures to count.
    pub fn fills(&self) -> bool {
        self.figures.void_percent() <= MOST_VOID && self.figures.low_percent() <= MOST_LOW
    }

    /// One figure for the quality of the deposit and the number of arc starts; the lower, the better ([`SCORE`]).
    pub fn score(&self) -> f64 {
        let starts_a_metre = 1e3 * self.totals.arc_starts as f64 / self.totals.deposited_length_mm.max(1.0);
        10.0 * (self.figures.void_percent() + self.figures.outside_percent() + starts_a_metre)
            + self.figures.overfill_percent()
    }
}

/// Sorts by score, the best first; those that leave the part empty come last.
pub fn rank(entries: &mut [Entry]) {
    entries.sort_by(|a, b| b.fills().cmp(&a.fills()).then(a.score().total_cmp(&b.score())));
}

/// The cells of the table as text, and whether each is the best of its column.
pub fn table(entries: &[Entry]) -> Vec<Vec<(String, bool)>> {
    let text = |entry: &Entry, column: &Column| format!("{:.*}", column.decimals, (column.value)(entry));
    let best = |column: &Column| {
        let sign = if column.more { -1.0 } else { 1.0 };
        let filling = entries.iter().filter(|entry| entry.fills());
        let best = filling.min_by(|a, b| (sign * (column.value)(a)).total_cmp(&(sign * (column.value)(b))));
        best.map(|entry| text(entry, column))
    };
    let cell = |entry: &Entry, column: &Column| {
        let text = text(entry, column);
        let is_best = entries.len() > 1 && entry.fills() && best(column).as_ref() == Some(&text);
        (text, is_best)
    };
    entries.iter().map(|entry| COLUMNS.iter().map(|column| cell(entry, column)).collect()).collect()
}

/// Adds the table to a page.
pub fn tabulate(page: &mut Sheet, entries: &[Entry]) {
    let head: Vec<&str> = ["name", "layers judged"].into_iter().chain(COLUMNS.iter().map(|c| c.name)).collect();
    let row = |(entry, cells): (&Entry, Vec<(String, bool)>)| {
        let name = if entry.fills() { entry.name.clone() } else { format!("{} (not filled)", entry.name) };
        let first = [name, entry.layers.len().to_string()].map(|text| (text, false));
        first.into_iter().chain(cells).collect()
    };
    let rows: Vec<_> = entries.iter().zip(table(entries)).map(row).collect();
    page.table(&head, &rows);
}

/// The page with the table and the height fields side by side; `limits` are drawn into the plots.
pub fn page(title: &str, lead: &str, entries: &[Entry], limits: Option<&CheckLimits>) -> Sheet {
    let mut page = Sheet::new(title, lead);
    tabulate(&mut page, entries);
    let longest = entries.iter().map(|e| &e.layers).max_by_key(|layers| layers.len());
    let labels: Vec<String> =
        longest.into_iter().flatten().map(|l| format!("layer {}, z {:.2} mm", l.index + 1, l.z)).collect();
    let mut columns = Vec::new();
    for entry in entries {
        let maps = (0..labels.len()).map(|k| entry.layers.get(k)?.picture.as_ref()).collect();
        columns.push((entry.name.clone(), maps));
    }
    let beads = |entry: &Entry| entry.layers.iter().map(|layer| layer.beads.clone()).collect();
    page.heading("Beads in 3-D");
    page.beads(&labels, &entries.iter().map(|entry| (entry.name.clone(), beads(entry))).collect::<Vec<_>>());
    page.heading("Heights of the metal");
    page.maps(&labels, &columns);
    if labels.len() > 1 {
        page.heading("Layer by layer");
        let [void, overfill] = [limits.map(|l| l.max_void), limits.map(|l| l.max_overfill)];
        page.svg(&layer_plot("Void", entries, Figures::void_percent, void).svg());
        page.svg(&layer_plot("Overfill", entries, Figures::overfill_percent, overfill).svg());
    }
    page
}

/// Adds the steps of a strategy (`loop` or `hybrid`; others have none) on one layer, by index from 0, to a page.
///
/// # Errors
/// [`Cancelled`].
pub fn add_steps(
    page: &mut Sheet,
    mesh: &Mesh,
    profile: &Profile,
    strategy: StrategyName,
    layer: usize,
    task: &Task,
) -> Result<(), Cancelled> {
    let slicer = Slicer::new(mesh, profile.slice_options(), task)?;
    let layer = layer.min(slicer.layer_count() - 1);
    let slices = slicer.batch(layer / BATCH, task)?;
    let Some(slice) = slices.get(layer % BATCH) else { return Ok(()) };
    let settings = profile.fill_settings(layer);
    let sketches = match strategy {
        StrategyName::Loop => steps::loop_sketches(&slice.islands, &settings),
        StrategyName::Hybrid => steps::sketches(&slice.islands, &settings),
        _ => return Ok(()),
    };
    page.heading(&format!("The steps of the {strategy} on layer {}", layer + 1));
    for sketch in &sketches {
        page.svg(&sketch.svg());
    }
    Ok(())
}

fn layer_plot(title: &str, entries: &[Entry], value: fn(&Figures) -> f64, limit: Option<f64>) -> Plot {
    let points = |e: &Entry| e.layers.iter().map(|l| DVec2::new(l.index as f64 + 1.0, value(&l.figures))).collect();
    let curves = entries.iter().map(|e| Curve { name: e.name.clone(), points: points(e) }).collect();
    let limits = limit.map(|most| (most, format!("limit {most} %"))).into_iter().collect();
    let [title, x, y] = [title, "layer", "% of the area"].map(str::to_owned);
    Plot { title, x, y, curves, limits, ..Plot::default() }
}
