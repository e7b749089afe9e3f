//! Han et al. 2018: order of contours, raster angle, merging and order of sub-regions, on three printed plates.
//!
//! The paper shows its parts only as pictures, so these are plates of the same kind. Its plain plan takes loops in file
//! order from their first vertex, scan lines at 0° on one layer and at 90° on the next, and sub-regions one by one in
//! scan order. Two layers are planned, since scan lines alternate, and every plate is turned by 0 to 175° in steps of 5°:
//! one layer of a plate that stands well shows whatever one likes.

use crate::{ReproduceError, Reproduced};
use beadwright::fill::angle;
use beadwright::fill::compound::Compound;
use beadwright::fill::zigzag::regions::Weave;
use beadwright::fill::{FillSettings, Strategy};
use beadwright::motion::Motion;
use beadwright::order::tour::{self, Ends, Gate, Stop, Visit};
use beadwright::order::{Method, begin_at};
use beadwright::plan::{self, ToFill};
use beadwright::profile::Profile;
use beadwright::report::angles;
use beadwright::report::plot::{Curve, Plot};
use beadwright::report::sheet::{Row, Sheet};
use beadwright::report::sketch::Sketch;
use beadwright::task::Task;
use glam::DVec2;
use planar::scan::{Scan, Spacing};
use planar::{Bounds, Polygon, Region, Ring};
use rayon::prelude::*;
use std::f64::consts::{FRAC_PI_2, TAU};

/// A plate, and what the paper saved on its own plate.
#[derive(Debug, Clone)]
pub struct Plate {
    /// Its kind and size.
    pub name: &'static str,
    /// Its outline and holes, mm; the holes in file order.
    pub polygon: Polygon,
    /// Contour travel and layer time saved in the paper, % (table 1).
    pub paper: [f64; 2],
}

/// The order of the loops.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Loops {
    /// As in the file, each from its first vertex. The files are shuffled, so this is a weak baseline.
    File,
    /// Columns of the part walked up and down (boustrophedon), each loop from its first vertex.
    Columns,
    /// Order and start points by a method.
    By(Method),
}

/// The angle of the scan lines of the first layer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Raster {
    /// 0°, the second layer 90°.
    Zero,
    /// 0° on both layers.
    Alike,
    /// The least turns on the first layer (the paper, eq 9), the second turned by 90°.
    FewestTurns,
    /// What `raster_turn = "best"` chooses for both layers, the second turned by 90°.
    Best,
}

/// How two layers are planned.
#[derive(Debug, Clone, Copy)]
pub struct Plan {
    /// What it adds to the one before.
    pub name: &'static str,
    /// How contours are ordered.
    pub loops: Loops,
    /// The angle of the scan lines.
    pub raster: Raster,
    /// Whether sub-regions are merged.
    pub merge: bool,
    /// How merged sub-regions are ordered; `None` for scan order.
    pub fill: Option<Method>,
}

/// The paper's plain plan.
pub const PLAIN: Plan =
    Plan { name: "plain: file order, 0°/90°", loops: Loops::File, raster: Raster::Zero, merge: false, fill: None };

/// The plain plan with its loops in columns.
pub const COLUMNS: Plan = Plan { name: "plain, loops in columns (boustrophedon)", loops: Loops::Columns, ..PLAIN };

/// The plans compared; each adds a step to the one before.
const STEPS: [Plan; 5] = [
    PLAIN,
    Plan { name: "+ contour order and start points", loops: Loops::By(Method::LocalSearch), ..PLAIN },
    Plan { name: "+ raster angle", raster: Raster::Best, merge: false, fill: None, ..OURS },
    Plan { name: "+ sub-regions merged", merge: true, fill: None, ..OURS },
    OURS,
];

/// All steps together, as `plan` takes them.
pub const OURS: Plan = Plan {
    name: "+ their order",
    loops: Loops::By(Method::LocalSearch),
    raster: Raster::Best,
    merge: true,
    fill: Some(Method::LocalSearch),
};

/// The paper to the letter: ant colony over the improved nearest neighbour, then the nearest region next.
pub const LITERAL: Plan = Plan {
    name: "the paper's methods",
    loops: Loops::By(Method::AntColony),
    raster: Raster::FewestTurns,
    merge: true,
    fill: Some(Method::Nearest),
};

/// All steps but the raster angle.
pub const FIXED: Plan = Plan { name: "all steps, fixed 0°/90°", raster: Raster::Zero, ..OURS };

/// All steps but the alternation: what crossing the lines of two layers costs.
pub const ALIKE: Plan = Plan { name: "all steps, 0° on both layers", raster: Raster::Alike, ..OURS };

/// The plans beside the steps.
const OTHERS: [Plan; 4] = [COLUMNS, LITERAL, FIXED, ALIKE];

/// The methods for start points and order of the contours.
const CONTOURS: [(&str, Loops); 6] = [
    ("file order (shuffled: a weak baseline)", Loops::File),
    ("columns walked up and down", Loops::Columns),
    ("improved nearest neighbour (2.1)", Loops::By(Method::ImprovedNearest)),
    ("ant colony over its start points (2.2): the paper's literal", Loops::By(Method::AntColony)),
    ("local search (ours)", Loops::By(Method::LocalSearch)),
    ("exact, at up to 48 vertices a loop (ours may begin between)", Loops::By(Method::Exact)),
];

/// What a plan of two layers takes.
#[derive(Debug, Clone, Copy)]
pub struct Outcome {
    /// The closed tour through the start points of one layer's contours, mm.
    pub contour_travel: f64,
    /// Travels of the fill, mm a layer.
    pub fill_travel: f64,
    /// Time, s a layer.
    pub seconds: f64,
    /// Paths of the fill, a layer.
    pub paths: f64,
    /// Turns, a layer.
    pub turns: f64,
}

/// What is saved between two outcomes.
#[derive(Debug, Clone, Copy)]
pub struct Saved {
    /// Contour travel, %.
    pub travel: f64,
    /// Layer time, %.
    pub time: f64,
}

impl Outcome {
    /// What this one saves of another.
    pub fn saved(&self, of: &Self) -> Saved {
        let percent = |before: f64, after: f64| 100.0 * (1.0 - after / before);
        Saved { travel: percent(of.contour_travel, self.contour_travel), time: percent(of.seconds, self.seconds) }
    }
}

/// The printer of the paper.
#[derive(Debug, Clone)]
pub struct Printer {
    profile: Profile,
    motion: Motion,
}

impl Printer {
    /// The profile `fdm-abs-0.4`.
    ///
    /// # Errors
    /// [`ReproduceError`] where the profile tells no acceleration.
    pub fn new() -> Result<Self, ReproduceError> {
        let profile = Profile::built_in("fdm-abs-0.4").map_err(|e| ReproduceError(e.to_string()))?;
        let motion = profile.motion.ok_or_else(|| ReproduceError("fdm-abs-0.4 gives no acceleration".to_owned()))?;
        Ok(Self { profile, motion })
    }

    /// Time of the paths and of the travels between them, s; each begins and ends at rest.
    fn seconds(&self, paths: &[&Vec<DVec2>]) -> f64 {
        let run = |points: &[DVec2], speed: f64| {
            let to = points.iter().skip(1).map(|p| (p.extend(0.0), speed));
            points.first().map_or(0.0, |first| self.motion.seconds(first.extend(0.0), to))
        };
        let laid: f64 = paths.iter().map(|path| run(path, self.profile.process.deposition_speed)).sum();
        laid + travels(paths).map(|ends| run(&ends, self.profile.travel.speed)).sum::<f64>()
    }
}

/// Angles by which every plate is turned, °.
fn rotations() -> impl IndexedParallelIterator<Item = f64> {
    (0..36_u8).into_par_iter().map(|k| 5.0 * f64::from(k))
}

/// The outcomes of all plans at one rotation.
struct At {
    degrees: f64,
    steps: [Outcome; STEPS.len()],
    others: [Outcome; OTHERS.len()],
}

impl At {
    fn new(plate: &Plate, degrees: f64, printer: &Printer) -> Self {
        let turned = Turned::new(plate, degrees, printer);
        let outcome = |plan: Plan| turned.outcome(&plan);
        Self { degrees, steps: STEPS.map(outcome), others: OTHERS.map(outcome) }
    }

    /// What all steps together save of the plain plan.
    fn saved(&self) -> Saved {
        self.ours().saved(&self.steps[0])
    }

    fn ours(&self) -> &Outcome {
        &self.steps[STEPS.len() - 1]
    }
}

/// A figure over all rotations.
#[derive(Debug, Clone, Copy)]
struct Spread {
    mean: f64,
    /// The least, and the rotation where it is found, °.
    least: (f64, f64),
    most: (f64, f64),
}

impl Spread {
    fn of(sweep: &[At], value: impl Fn(&At) -> f64) -> Self {
        let values: Vec<(f64, f64)> = sweep.iter().map(|at| (value(at), at.degrees)).collect();
        let mean = values.iter().map(|v| v.0).sum::<f64>() / values.len() as f64;
        let least = values.iter().copied().fold((f64::INFINITY, 0.0), |a, b| if b.0 < a.0 { b } else { a });
        let most = values.iter().copied().fold((f64::NEG_INFINITY, 0.0), |a, b| if b.0 > a.0 { b } else { a });
        Self { mean, least, most }
    }

    /// Mean, worst and best as cells of a table.
    fn cells(&self) -> [String; 3] {
        let at = |(value, degrees): (f64, f64)| format!("{value:.1} (at {degrees:.0}°)");
        [format!("{:.1}", self.mean), at(self.least), at(self.most)]
    }
}

/// Runs the experiment.
///
/// # Errors
/// [`ReproduceError`] when the task was cancelled.
pub fn run(task: &Task) -> Result<Reproduced, ReproduceError> {
    let printer = Printer::new()?;
    let mut page = Sheet::new(
        "b-fdm-order",
        "Han et al. 2018: three plates of ABS, nozzle 0.4 mm, layers of 0.2 mm, 120 mm/s, travels at 160 mm/s. The paper \
         shows its parts only as pictures; these are of the same kind. Two layers are planned, the second with its scan \
         lines turned by 90°, and every plate is turned by 0 to 175° in steps of 5°. Times are those of a layer, the mean \
         of the two, on a machine with 1000 mm/s² that passes corners at 10 mm/s and loses no time where a path starts \
         (ours: the paper tells none of these).",
    );
    let (mut lines, mut goals, mut swept) = (Vec::new(), Vec::new(), Vec::new());
    for plate in plates() {
        let at = |degrees: f64| task.check().map(|()| At::new(&plate, degrees, &printer));
        let sweep: Result<Vec<At>, _> = rotations().map(at).collect();
        let sweep = sweep.map_err(|e| ReproduceError(e.to_string()))?;
        let found = goals_of(&plate, &sweep);
        lines.extend(summary(&plate, &sweep, &found));
        goals.extend(found.iter().map(|goal| goal.row(&plate)));
        swept.push((plate, sweep));
    }
    page.heading("Reached and not reached").table(&GOAL_HEAD, &goals);
    page.text(
        "The paper counts one part at one rotation, the one it was drawn at. Where lines at 0° already run along the \
         plate (0° and 90°), the raster angle saves nothing, and only merging, order and start points are left.",
    );
    for (plate, sweep) in &swept {
        tell(&mut page, plate, sweep, &printer);
    }
    Ok(Reproduced { page, lines, files: Vec::new() })
}

const GOAL_HEAD: [&str; 6] = ["plate", "saved, %", "goal", "ours: mean of 36 rotations", "worst", "verdict"];

/// A figure that is to be reached, %.
struct Goal {
    what: &'static str,
    goal: f64,
    ours: Spread,
}

impl Goal {
    fn row(&self, plate: &Plate) -> Row {
        let [mean, worst, _] = self.ours.cells();
        let cells =
            [plate.name.to_owned(), self.what.to_owned(), format!("{:.1}", self.goal), mean, worst, self.verdict()];
        cells.map(|text| (text, false)).to_vec()
    }

    fn line(&self) -> String {
        let Spread { mean, least, most } = self.ours;
        format!(
            "  {} {mean:.1} % less (worst {:.1} at {:.0}°, best {:.1} at {:.0}°), goal {:.1}: {}",
            self.what,
            least.0,
            least.1,
            most.0,
            most.1,
            self.goal,
            self.verdict()
        )
    }

    /// Whether it is reached, in words.
    fn verdict(&self) -> String {
        let (mean, worst) = (self.goal - self.ours.mean, self.goal - self.ours.least.0);
        if worst <= 0.0 {
            "reached at every rotation".to_owned()
        } else if mean <= 0.0 {
            format!("reached on the mean, at the worst rotation {worst:.1} short")
        } else {
            format!("not reached: {mean:.1} short on the mean, {worst:.1} at the worst")
        }
    }
}

/// More than this is not lost to a fixed angle, %.
const LOSES_AT_MOST: f64 = 0.5;

/// Our figures beside the paper's, against its plain plan and against loops in columns; and the raster angle against a
/// fixed one.
fn goals_of(plate: &Plate, sweep: &[At]) -> Vec<Goal> {
    let [travel, time] = plate.paper;
    let goal = |what, goal, value: &dyn Fn(&At) -> f64| Goal { what, goal, ours: Spread::of(sweep, value) };
    vec![
        goal("contour travel against file order (shuffled, weak)", travel, &|at| at.saved().travel),
        goal("contour travel against columns (boustrophedon)", travel, &|at| at.ours().saved(&at.others[0]).travel),
        goal("layer time against plain", time, &|at| at.saved().time),
        goal("layer time against plain with columns", time, &|at| at.ours().saved(&at.others[0]).time),
        goal("layer time against plain, by the paper's methods", time, &|at| at.others[1].saved(&at.steps[0]).time),
        goal("layer time, best angle against 0°/90°", -LOSES_AT_MOST, &|at| at.ours().saved(&at.others[2]).time),
        goal("layer time, best angle against 0° on both layers", -LOSES_AT_MOST, &|at| {
            at.ours().saved(&at.others[3]).time
        }),
    ]
}

/// The findings on a plate in a few lines.
fn summary(plate: &Plate, sweep: &[At], goals: &[Goal]) -> Vec<String> {
    let shares: Vec<String> = shares(sweep)
        .map(|(plan, share)| format!("{} {:.1}", plan.name.trim_start_matches("+ "), share.mean))
        .collect();
    let mut lines = vec![format!("{}, two layers, mean of 36 rotations:", plate.name)];
    lines.extend(goals.iter().map(Goal::line));
    lines.push(format!("  of the time, %: {}", shares.join(", ")));
    lines.extend(start_cost(plate, sweep));
    lines
}

/// What a start of a path would have to cost for the paper's layer time to be reached on the mean, as a sentence.
fn start_cost(plate: &Plate, sweep: &[At]) -> Option<String> {
    let starts = |o: &Outcome| o.paths + plate.polygon.rings().count() as f64;
    let mean = |value: &dyn Fn(&At) -> f64| Spread::of(sweep, value).mean;
    let left = 1.0 - plate.paper[1] / 100.0;
    // Time and starts that are too many for the goal.
    let seconds = mean(&|at| at.ours().seconds - left * at.steps[0].seconds);
    let fewer = mean(&|at| left * starts(&at.steps[0]) - starts(at.ours()));
    (seconds > 0.0 && fewer > 0.0).then(|| {
        format!(
            "  a printer that loses {:.1} s at every start of a path would reach the paper's layer time on the mean",
            seconds / fewer
        )
    })
}

/// What each step saves of the plain plan's time beyond the step before, %.
fn shares(sweep: &[At]) -> impl Iterator<Item = (&'static Plan, Spread)> + '_ {
    STEPS.iter().enumerate().skip(1).map(|(i, plan)| {
        let saved = |at: &At, step: usize| at.steps[step].saved(&at.steps[0]).time;
        (plan, Spread::of(sweep, |at| saved(at, i) - saved(at, i - 1)))
    })
}

/// The section of a plate.
fn tell(page: &mut Sheet, plate: &Plate, sweep: &[At], printer: &Printer) {
    let plain = |text: String| (text, false);
    page.heading(plate.name);

    let row = |(plan, of): (&Plan, &dyn Fn(&At) -> Outcome)| {
        let mean = |value: fn(&Outcome) -> f64| Spread::of(sweep, |at| value(&of(at))).mean;
        let saved = Spread::of(sweep, |at| of(at).saved(&at.steps[0]).time);
        let means = [
            format!("{:.1}", mean(|o| o.contour_travel)),
            format!("{:.1}", mean(|o| o.fill_travel)),
            format!("{:.1}", mean(|o| o.paths)),
            format!("{:.0}", mean(|o| o.turns)),
            format!("{:.1}", mean(|o| o.seconds)),
        ];
        [plan.name.to_owned()].into_iter().chain(means).chain(saved.cells()).map(plain).collect()
    };
    let steps = STEPS.iter().enumerate().map(|(i, plan)| row((plan, &|at| at.steps[i])));
    let others = OTHERS.iter().enumerate().map(|(i, plan)| row((plan, &|at| at.others[i])));
    page.table(&STEP_HEAD, &steps.chain(others).collect::<Vec<Row>>());

    let share =
        |(plan, share): (&Plan, Spread)| [plan.name.to_owned()].into_iter().chain(share.cells()).map(plain).collect();
    page.table(
        &["share of the step, % of the plain time", "mean", "least", "most"],
        &shares(sweep).map(share).collect::<Vec<Row>>(),
    );

    page.table(&CONTOUR_HEAD, &contour_rows(plate, printer));

    let curve = |name: &str, value: &dyn Fn(&At) -> f64| Curve {
        name: name.to_owned(),
        points: sweep.iter().map(|at| DVec2::new(at.degrees, value(at))).collect(),
    };
    let plot = Plot {
        title: format!("{}: layer time saved of the plain plan", plate.name),
        x: "the plate is turned by, °".to_owned(),
        y: "saved, %".to_owned(),
        curves: vec![
            curve("ours", &|at| at.saved().time),
            curve("the paper's methods", &|at| at.others[1].saved(&at.steps[0]).time),
            curve("0° on both layers", &|at| at.others[3].saved(&at.steps[0]).time),
            curve("the paper's figure", &|_| plate.paper[1]),
        ],
        ..Plot::default()
    };
    page.svg(&plot.svg());

    let saved = Spread::of(sweep, |at| at.saved().time);
    for (word, (percent, degrees)) in [("most", saved.most), ("least", saved.least)] {
        let turned = Turned::new(plate, degrees, printer);
        let lines = format!("ours, lines at {:.1}°", turned.best.to_degrees());
        page.text(&format!(
            "Turned by {degrees:.0}°, where the {word} time is saved ({percent:.1} %); the first layer, travels in red:"
        ));
        page.svg(&turned.sketch(&PLAIN, "plain").svg()).svg(&turned.sketch(&OURS, &lines).svg());
    }
    let curves = angle::curves(&Compound, std::slice::from_ref(&plate.polygon), &printer.profile.fill_settings(0));
    let [turns, ..] = angles::plots(&curves, None);
    page.svg(&turns.svg());
}

const STEP_HEAD: [&str; 9] = [
    "a layer, mean of 36 rotations",
    "contour travel mm",
    "fill travel mm",
    "fill paths",
    "turns",
    "time s",
    "time saved %",
    "worst",
    "best",
];

const CONTOUR_HEAD: [&str; 5] = [
    "start points and order of the contours",
    "mm at 0°",
    "mm at 35°",
    "saved of columns, worst %",
    "saved of file order, worst %",
];

/// The methods for the contours at two orientations, against both baselines.
fn contour_rows(plate: &Plate, printer: &Printer) -> Vec<Row> {
    let at = |degrees: f64| {
        let turned = Turned::new(plate, degrees, printer);
        CONTOURS.map(|(_, loops)| tour::length(&turned.tour(loops), Ends::Closed))
    };
    let [upright, turned] = [0.0, 35.0].map(at);
    let row = |(i, (name, _)): (usize, &(&str, Loops))| {
        let saved = |of: usize| {
            let saved = |lengths: &[f64]| 100.0 * (1.0 - lengths[i] / lengths[of]);
            format!("{:.1}", saved(&upright).min(saved(&turned)))
        };
        [(*name).to_owned(), format!("{:.1}", upright[i]), format!("{:.1}", turned[i]), saved(1), saved(0)]
            .map(|text| (text, false))
            .to_vec()
    };
    CONTOURS.iter().enumerate().map(row).collect()
}

/// A plate turned by an angle, ready to be planned in several ways. Its two layers are alike.
pub struct Turned<'a> {
    printer: &'a Printer,
    settings: FillSettings<'a>,
    slice: Region,
    /// The contours in file order, each from its first vertex.
    loops: Vec<Ring>,
    /// Their order by columns of the plate as it lies in the file.
    columns: Vec<usize>,
    core: Region,
    best: f64,
    fewest_turns: f64,
}

impl<'a> Turned<'a> {
    /// The plate turned by `degrees`.
    pub fn new(plate: &Plate, degrees: f64, printer: &'a Printer) -> Self {
        let polygon = plate.turned(degrees);
        let settings = printer.profile.fill_settings(0);
        let layer = ToFill { islands: std::slice::from_ref(&polygon), solid: None };
        let best = plan::raster_angle(&[layer; 2], &Compound, &printer.profile).unwrap_or_default();
        let core = Compound.infill(&polygon, &settings);
        let fewest_turns = angle::fewest_turns(&[vec![core.clone()]], &settings).unwrap_or_default();
        let (loops, columns) = (loops(&polygon, &settings), columns(&plate.polygon));
        Self { printer, settings, slice: polygon.into(), loops, columns, core, best, fewest_turns }
    }

    /// The number of sub-regions of scan lines at 0°.
    pub fn sub_regions(&self) -> usize {
        Weave::new(&self.scan(0.0), self.settings.stepover).regions().len()
    }

    /// What a plan takes.
    pub fn outcome(&self, plan: &Plan) -> Outcome {
        let laid = self.laid(plan);
        let count = |of: fn(&Laid) -> usize| laid.iter().map(of).sum::<usize>() as f64 / 2.0;
        let all: Vec<&Vec<DVec2>> = laid.iter().flat_map(Laid::paths).collect();
        let contours: Vec<&Vec<DVec2>> = laid[0].contours.iter().collect();
        let between = length(travels(&contours));
        Outcome {
            // The paper counts the closed tour through the start points.
            contour_travel: between + contours.last().zip(contours.first()).map_or(0.0, |(a, b)| a[0].distance(b[0])),
            fill_travel: length(travels(&all)) / 2.0 - between,
            seconds: self.printer.seconds(&all) / 2.0,
            paths: count(|layer| layer.fill.len()),
            turns: count(|layer| layer.turns),
        }
    }

    /// The two layers as they are laid.
    fn laid(&self, plan: &Plan) -> [Laid; 2] {
        let first = match plan.raster {
            Raster::Zero | Raster::Alike => 0.0,
            Raster::FewestTurns => self.fewest_turns,
            Raster::Best => self.best,
        };
        let second = if plan.raster == Raster::Alike { first } else { first + FRAC_PI_2 };
        [first, second].map(|angle| {
            let (contours, scan) = (self.contours(plan.loops), self.scan(angle));
            let from = contours.last().map_or(DVec2::ZERO, |path| path[0]);
            Laid { fill: self.fill(plan, &scan, from), contours, turns: 2 * scan.spans().len() }
        })
    }

    fn scan(&self, angle: f64) -> Scan {
        Scan::new(&self.core, angle, Spacing::AtMost(self.settings.stepover))
    }

    /// The tour through the contours.
    fn tour(&self, loops: Loops) -> Vec<Visit> {
        let stops: Vec<Stop> = self.loops.iter().map(|ring| Stop::ring(ring.points().to_vec())).collect();
        let one_by_one = |order: &mut dyn Iterator<Item = usize>| {
            order.filter_map(|i| Some(Visit::new(i, stops[i].gates().next()?))).collect()
        };
        match loops {
            Loops::File => one_by_one(&mut (0..stops.len())),
            Loops::Columns => one_by_one(&mut self.columns.iter().copied()),
            Loops::By(method) => method.tour(&stops, Ends::Closed),
        }
    }

    fn contours(&self, loops: Loops) -> Vec<Vec<DVec2>> {
        let ring = |visit: &Visit| begin_at_point(self.loops[visit.stop].clone(), visit.enter);
        self.tour(loops).iter().map(ring).collect()
    }

    /// The fill as it is laid, from the end of the contours.
    fn fill(&self, plan: &Plan, scan: &Scan, from: DVec2) -> Vec<Vec<DVec2>> {
        let weave = Weave::new(scan, self.settings.stepover);
        let paths = weave.paths(&if plan.merge { weave.merged() } else { weave.apart() });
        let Some(method) = plan.fill else { return paths };
        let line = |path: &Vec<DVec2>| {
            let gate = Gate { enter: path[0], leave: path[path.len() - 1] };
            Stop::Line { gate, reversible: true }
        };
        let stops: Vec<Stop> = paths.iter().map(line).collect();
        let laid = |visit: &Visit| {
            let mut path = paths[visit.stop].clone();
            if path.first() != Some(&visit.enter) {
                path.reverse();
            }
            path
        };
        method.tour(&stops, Ends::From(from)).iter().map(laid).collect()
    }

    /// The first layer of a plan with its travels.
    fn sketch(&self, plan: &Plan, title: &str) -> Sketch {
        let mut sketch = Sketch::new(self.slice.bounds().unwrap_or(Bounds::EMPTY), title);
        sketch.region(&self.slice, "#eef0f3");
        let [layer, _] = self.laid(plan);
        let paths: Vec<&Vec<DVec2>> = layer.paths().collect();
        for (path, colour) in paths.iter().zip(COLOURS.iter().cycle()) {
            sketch.line(path, false, colour, 0.4 * self.settings.stepover);
        }
        for ends in travels(&paths) {
            sketch.line(&ends, false, "#d92d3a", self.settings.stepover);
        }
        sketch
    }
}

/// What is laid on a layer.
struct Laid {
    contours: Vec<Vec<DVec2>>,
    fill: Vec<Vec<DVec2>>,
    turns: usize,
}

impl Laid {
    fn paths(&self) -> impl Iterator<Item = &Vec<DVec2>> {
        self.contours.iter().chain(&self.fill)
    }
}

const COLOURS: [&str; 6] = ["#1f6fd6", "#e8862a", "#1a9c4b", "#7e57c2", "#0e7490", "#c2417c"];

/// The ends of the travel from each path to the next.
fn travels<'a>(paths: &'a [&Vec<DVec2>]) -> impl Iterator<Item = [DVec2; 2]> + 'a {
    paths.windows(2).map(|w| [w[0][w[0].len() - 1], w[1][0]])
}

fn length(travels: impl Iterator<Item = [DVec2; 2]>) -> f64 {
    travels.map(|[from, to]| from.distance(to)).sum()
}

/// The contours of a plate as its file gives the loops: in their order, and each from its first vertex.
fn loops(plate: &Polygon, settings: &FillSettings) -> Vec<Ring> {
    let contours = settings.outermost(plate);
    let near = |p: DVec2| move |a: &DVec2, b: &DVec2| a.distance_squared(p).total_cmp(&b.distance_squared(p));
    let of = |ring: &Ring| {
        let start = ring.points()[0];
        let first = |contour: &&Ring| contour.points().iter().copied().min_by(near(start)).unwrap_or_default();
        let contour = contours.rings().min_by(|a, b| near(start)(&first(a), &first(b)))?;
        let mut points = contour.points().to_vec();
        let at = points.iter().position(|p| *p == first(&contour))?;
        points.rotate_left(at);
        Some(Ring::new(points))
    };
    plate.rings().filter_map(of).collect()
}

/// The loops of a plate by columns, which are walked up and down; the outline comes first.
fn columns(plate: &Polygon) -> Vec<usize> {
    let bounds = Bounds::of(plate.outer.points().iter().copied()).unwrap_or(Bounds::EMPTY);
    let size = bounds.size();
    // About as many columns as make their cells square.
    let count = (plate.holes.len() as f64 * size.x / size.y).sqrt().round().max(1.0);
    let place = |hole: &Ring| {
        let centre = tour::centroid(hole.points()) - bounds.min;
        let column = (count * centre.x / size.x) as usize;
        (column, if column.is_multiple_of(2) { centre.y } else { -centre.y })
    };
    let mut holes: Vec<usize> = (0..plate.holes.len()).collect();
    holes.sort_by(|&a, &b| {
        let (a, b) = (place(&plate.holes[a]), place(&plate.holes[b]));
        a.0.cmp(&b.0).then(a.1.total_cmp(&b.1))
    });
    [0].into_iter().chain(holes.into_iter().map(|hole| hole + 1)).collect()
}

/// A ring as a path that begins and ends at a point of it.
fn begin_at_point(ring: Ring, start: DVec2) -> Vec<DVec2> {
    begin_at(beadwright::fill::Path::contour(ring, 0.0), start).path()
}

impl Plate {
    /// The plate turned by an angle, °.
    pub fn turned(&self, degrees: f64) -> Polygon {
        // Exact at right angles, so that edges stay parallel to the axes.
        let exact = |v: f64| if v.abs() < 1e-12 { 0.0 } else { v };
        let way = DVec2::from_angle(degrees.to_radians());
        let way = DVec2::new(exact(way.x), exact(way.y));
        let turn = |ring: &Ring| Ring::new(ring.points().iter().map(|p| way.rotate(*p)).collect());
        Polygon { outer: turn(&self.polygon.outer), holes: self.polygon.holes.iter().map(turn).collect() }
    }
}

fn circle(x: f64, y: f64, radius: f64) -> Ring {
    const VERTICES: usize = 64;
    let point = |k: usize| DVec2::new(x, y) + DVec2::from_angle(TAU * k as f64 / VERTICES as f64) * radius;
    Ring::new((0..VERTICES).map(point).collect())
}

fn rectangle(x: f64, y: f64, width: f64, height: f64) -> Ring {
    Ring::new([(x, y), (x + width, y), (x + width, y + height), (x, y + height)].map(DVec2::from).to_vec())
}

/// Plates of the kinds that the paper shows; lying, as the first there.
pub fn plates() -> [Plate; 3] {
    let plate = |name, paper, outer: Ring, holes: Vec<Ring>| {
        let holes = holes.into_iter().map(Ring::reversed).collect();
        Plate { name, polygon: Polygon { outer, holes }, paper }
    };
    let eight = [
        (12.0, 38.0),
        (62.0, 14.0),
        (36.0, 36.0),
        (86.0, 37.0),
        (14.0, 12.0),
        (60.0, 35.0),
        (88.0, 13.0),
        (38.0, 13.0),
    ];
    // One sub-region below all; a hole adds three, a notch in the upper edge two.
    let notched =
        [(0.0, 0.0), (80.0, 0.0), (80.0, 60.0), (52.0, 60.0), (52.0, 38.0), (30.0, 38.0), (30.0, 60.0), (0.0, 60.0)];
    let three = vec![rectangle(34.0, 20.0, 12.0, 8.0), circle(58.0, 14.0, 8.0), circle(16.0, 16.0, 7.0)];
    let five = vec![
        circle(20.0, 50.0, 9.0),
        rectangle(70.0, 44.0, 22.0, 14.0),
        circle(50.0, 25.0, 12.0),
        rectangle(12.0, 10.0, 16.0, 12.0),
        circle(88.0, 18.0, 8.0),
    ];
    [
        plate(
            "nine loops, 100 × 50 mm",
            [19.5, 12.6],
            rectangle(0.0, 0.0, 100.0, 50.0),
            eight.map(|(x, y)| circle(x, y, 6.0)).to_vec(),
        ),
        plate("twelve sub-regions, 80 × 60 mm", [12.5, 11.6], Ring::new(notched.map(DVec2::from).to_vec()), three),
        plate("six loops, 110 × 70 mm", [10.7, 8.9], rectangle(0.0, 0.0, 110.0, 70.0), five),
    ]
}
