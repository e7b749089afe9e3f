//! Han et al. 2018: order of contours, raster angle, merging and order of sub-regions, on three printed plates.
//!
//! The paper shows its parts only as pictures, so these are plates of the same kind. The plain plan takes loops in file
//! order from their first vertex, scan lines at 0°, and sub-regions one by one in scan order. One layer is counted, as
//! in the paper.

use super::{ReproduceError, Reproduced};
use crate::fill::angle;
use crate::fill::compound::Compound;
use crate::fill::zigzag::regions::Weave;
use crate::fill::{FillSettings, Strategy};
use crate::motion::Motion;
use crate::order::tour::{Ends, Gate, Stop, Visit};
use crate::order::{Method, begin_at};
use crate::profile::Profile;
use crate::report::angles;
use crate::report::sheet::Sheet;
use crate::report::sketch::Sketch;
use crate::task::Task;
use glam::DVec2;
use planar::scan::{Scan, Spacing};
use planar::{Bounds, Polygon, Region, Ring};
use std::f64::consts::TAU;

/// A plate, and what the paper found on its own plate: contour travel and layer time saved, %.
struct Plate {
    name: &'static str,
    polygon: Polygon,
    paper: [f64; 2],
}

/// How a layer is planned.
#[derive(Debug, Clone, Copy)]
struct Plan {
    name: &'static str,
    /// How contours are ordered; `None` for file order.
    contours: Option<Method>,
    best_angle: bool,
    merge: bool,
    /// How merged sub-regions are ordered; `None` for scan order.
    fill: Option<Method>,
}

const PLAIN: Plan = Plan { name: "plain", contours: None, best_angle: false, merge: false, fill: None };

/// The plans compared; each adds a step to the one before.
const STEPS: [Plan; 5] = [
    PLAIN,
    Plan { name: "+ contour order and start points", contours: Some(Method::LocalSearch), ..PLAIN },
    Plan { name: "+ raster angle", contours: Some(Method::LocalSearch), best_angle: true, ..PLAIN },
    Plan {
        name: "+ sub-regions merged",
        contours: Some(Method::LocalSearch),
        best_angle: true,
        merge: true,
        fill: None,
    },
    Plan {
        name: "+ their order",
        contours: Some(Method::LocalSearch),
        best_angle: true,
        merge: true,
        fill: Some(Method::LocalSearch),
    },
];

/// The paper to the letter: ant colony over the improved nearest neighbour, then the nearest region next.
const LITERAL: Plan = Plan {
    name: "the paper's methods",
    contours: Some(Method::AntColony),
    best_angle: true,
    merge: true,
    fill: Some(Method::Nearest),
};

/// The travels, time, paths and turns of a layer.
struct Outcome {
    contour_travel: f64,
    fill_travel: f64,
    seconds: f64,
    ways: usize,
    turns: usize,
}

/// Runs the experiment.
///
/// # Errors
/// [`ReproduceError`] when the task was cancelled.
pub fn run(task: &Task) -> Result<Reproduced, ReproduceError> {
    let wrong = |e: &dyn std::fmt::Display| ReproduceError(e.to_string());
    let profile = Profile::built_in("fdm-abs-0.4").map_err(|e| wrong(&e))?;
    let motion = profile.motion.ok_or_else(|| wrong(&"the profile fdm-abs-0.4 gives no acceleration"))?;
    let settings = profile.fill_settings(0);
    let mut page = Sheet::new(
        "b-fdm-order",
        "Han et al. 2018: three plates of ABS, nozzle 0.4 mm, layers of 0.2 mm, 120 mm/s, travels at 160 mm/s. Times are \
         those of one layer on a machine with 1000 mm/s² that passes corners at 10 mm/s (ours: the paper tells neither).",
    );
    let mut lines = Vec::new();
    for plate in plates() {
        task.check().map_err(|e| wrong(&e))?;
        let layer = Layer::new(&plate.polygon, &settings, motion, &profile);
        let steps: Vec<(Plan, Outcome)> = STEPS.iter().chain([&LITERAL]).map(|p| (*p, layer.outcome(p))).collect();
        page.heading(plate.name);
        page.table(&HEAD, &rows(&steps));
        let turned = Layer::new(&turned(&plate.polygon), &settings, motion, &profile);
        let told = [summary(&plate, &steps), turned.summary_turned()];
        for line in told {
            page.text(&line);
            lines.push(line);
        }
        for sketch in layer.sketches() {
            page.svg(&sketch.svg());
        }
        let best = layer.best_angle.to_degrees();
        for plot in angles::plots(&angle::curves(&Compound, &[plate.polygon], &settings), Some(best)) {
            page.svg(&plot.svg());
        }
    }
    Ok(Reproduced { page, lines, files: Vec::new() })
}

const HEAD: [&str; 7] =
    ["one layer", "contour travel mm", "fill travel mm", "fill paths", "turns", "time s", "time saved %"];

fn rows(steps: &[(Plan, Outcome)]) -> Vec<Vec<(String, bool)>> {
    let plain = steps[0].1.seconds;
    let row = |(plan, o): &(Plan, Outcome)| {
        let numbers = [
            format!("{:.2}", o.contour_travel),
            format!("{:.2}", o.fill_travel),
            o.ways.to_string(),
            o.turns.to_string(),
            format!("{:.1}", o.seconds),
            format!("{:.1}", 100.0 * (1.0 - o.seconds / plain)),
        ];
        [plan.name.to_owned()].into_iter().chain(numbers).map(|text| (text, false)).collect()
    };
    steps.iter().map(row).collect()
}

fn summary(plate: &Plate, steps: &[(Plan, Outcome)]) -> String {
    let [plain, .., ours, literal] = steps else { return String::new() };
    let saved = |before: f64, after: f64| 100.0 * (1.0 - after / before);
    let both = |o: &Outcome| (saved(plain.1.contour_travel, o.contour_travel), saved(plain.1.seconds, o.seconds));
    let ((travel, time), (their_travel, their_time)) = (both(&ours.1), both(&literal.1));
    let shares: Vec<String> = steps
        .windows(2)
        .take(STEPS.len() - 1)
        .map(|w| {
            format!(
                "{} {:.1}",
                w[1].0.name.trim_start_matches("+ "),
                saved(plain.1.seconds, w[1].1.seconds) - saved(plain.1.seconds, w[0].1.seconds)
            )
        })
        .collect();
    format!(
        "{}: contour travel −{travel:.1} % (paper −{:.1} %, its methods here −{their_travel:.1} %), layer time −{time:.1} % \
         (paper −{:.1} %, its methods here −{their_time:.1} %); of the time: {}",
        plate.name,
        plate.paper[0],
        plate.paper[1],
        shares.join(", ")
    )
}

/// A layer of a plate, ready to be planned in several ways.
struct Layer<'a> {
    slice: Region,
    loops: Vec<Ring>,
    core: Region,
    settings: &'a FillSettings<'a>,
    best_angle: f64,
    motion: Motion,
    speeds: (f64, f64),
}

impl<'a> Layer<'a> {
    fn new(plate: &Polygon, settings: &'a FillSettings<'a>, motion: Motion, profile: &Profile) -> Self {
        let best_angle = angle::best(&Compound, &[std::slice::from_ref(plate)], settings).unwrap_or_default();
        Self {
            slice: Region::from(plate.clone()),
            loops: settings.outermost(plate).rings().cloned().collect(),
            core: Compound.infill(plate, settings),
            settings,
            best_angle,
            motion,
            speeds: (profile.process.deposition_speed, profile.travel.speed),
        }
    }

    /// What is saved on the plate turned by 90°: where scan lines at 0° already run along it, the angle saves nothing.
    fn summary_turned(&self) -> String {
        let (plain, ours) = (self.outcome(&PLAIN), self.outcome(&STEPS[STEPS.len() - 1]));
        let saved = |before: f64, after: f64| 100.0 * (1.0 - after / before);
        format!(
            "  the same turned by 90°: contour travel −{:.1} %, layer time −{:.1} %",
            saved(plain.contour_travel, ours.contour_travel),
            saved(plain.seconds, ours.seconds)
        )
    }

    fn scan(&self, plan: &Plan) -> Scan {
        let angle = if plan.best_angle { self.best_angle } else { 0.0 };
        Scan::new(&self.core, angle, Spacing::AtMost(self.settings.stepover))
    }

    /// The contours as they are laid.
    fn contours(&self, plan: &Plan) -> Vec<Vec<DVec2>> {
        let stops: Vec<Stop> = self.loops.iter().map(|ring| Stop::ring(ring.points().to_vec())).collect();
        let tour = match plan.contours {
            Some(method) => method.tour(&stops, Ends::Closed),
            None => in_file_order(&stops),
        };
        let ring = |visit: &Visit| begin_at_point(self.loops[visit.stop].clone(), visit.enter);
        tour.iter().map(ring).collect()
    }

    /// The fill as it is laid, starting from the end of the contours.
    fn fill(&self, plan: &Plan, from: DVec2) -> Vec<Vec<DVec2>> {
        let scan = self.scan(plan);
        let weave = Weave::new(&scan, self.settings.stepover);
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

    fn outcome(&self, plan: &Plan) -> Outcome {
        let contours = self.contours(plan);
        let end = contours.last().and_then(|c| c.last()).copied().unwrap_or_default();
        let fill = self.fill(plan, end);
        let travel =
            |paths: &[Vec<DVec2>]| -> f64 { paths.windows(2).map(|w| w[0][w[0].len() - 1].distance(w[1][0])).sum() };
        // The paper counts the closed tour through the start points.
        let closing = contours.first().map_or(0.0, |first| first[0].distance(end));
        let all: Vec<&Vec<DVec2>> = contours.iter().chain(&fill).collect();
        Outcome {
            contour_travel: travel(&contours) + closing,
            fill_travel: fill.first().map_or(0.0, |first| end.distance(first[0])) + travel(&fill),
            seconds: self.seconds(&all),
            ways: fill.len(),
            turns: 2 * self.scan(plan).spans().len(),
        }
    }

    /// Time of the paths and of the travels between them; each begins and ends at rest.
    fn seconds(&self, paths: &[&Vec<DVec2>]) -> f64 {
        let run = |points: &[DVec2], speed: f64| {
            let to = points.iter().skip(1).map(|p| (p.extend(0.0), speed));
            points.first().map_or(0.0, |first| self.motion.seconds(first.extend(0.0), to))
        };
        let laid: f64 = paths.iter().map(|path| run(path, self.speeds.0)).sum();
        let travels = paths.windows(2).map(|w| [w[0][w[0].len() - 1], w[1][0]]);
        laid + travels.map(|ends| run(&ends, self.speeds.1)).sum::<f64>()
    }

    /// Sub-regions, the paths that they are merged into, and the whole layer with its travels.
    fn sketches(&self) -> [Sketch; 3] {
        let bounds = self.slice.bounds().unwrap_or(Bounds { min: DVec2::ZERO, max: DVec2::ONE });
        let ours = &STEPS[STEPS.len() - 1];
        let scan = self.scan(ours);
        let weave = Weave::new(&scan, self.settings.stepover);
        let (apart, merged) = (weave.apart(), weave.merged());
        let titles = [
            format!("1. {} sub-regions at {:.1}°", apart.len(), self.best_angle.to_degrees()),
            format!("2. merged into {} paths", merged.len()),
            "3. the layer with its travels".to_owned(),
        ];
        let mut sketches = titles.map(|title| {
            let mut sketch = Sketch::new(bounds, &title);
            sketch.region(&self.slice, "#eef0f3");
            sketch
        });
        let width = 0.8 * self.settings.stepover;
        for (sketch, ways) in sketches.iter_mut().zip([&apart, &merged]) {
            for (path, colour) in weave.paths(ways).iter().zip(COLOURS.iter().cycle()) {
                sketch.line(path, false, colour, width);
            }
        }
        let contours = self.contours(ours);
        let end = contours.last().and_then(|c| c.last()).copied().unwrap_or_default();
        let paths: Vec<Vec<DVec2>> = contours.into_iter().chain(self.fill(ours, end)).collect();
        for (path, colour) in paths.iter().zip(COLOURS.iter().cycle()) {
            sketches[2].line(path, false, colour, 0.4 * self.settings.stepover);
        }
        for ends in paths.windows(2) {
            sketches[2].line(&[ends[0][ends[0].len() - 1], ends[1][0]], false, "#d92d3a", self.settings.stepover);
        }
        sketches
    }
}

const COLOURS: [&str; 6] = ["#1f6fd6", "#e8862a", "#1a9c4b", "#7e57c2", "#0e7490", "#c2417c"];

fn in_file_order(stops: &[Stop]) -> Vec<Visit> {
    let first = |(i, stop): (usize, &Stop)| Some(Visit::new(i, stop.gates().next()?));
    stops.iter().enumerate().filter_map(first).collect()
}

/// A ring as a path that begins and ends at a point of it.
fn begin_at_point(ring: Ring, start: DVec2) -> Vec<DVec2> {
    begin_at(crate::fill::Path::contour(ring, 0.0), start).path()
}

fn circle(x: f64, y: f64, radius: f64) -> Ring {
    const VERTICES: usize = 64;
    let point = |k: usize| DVec2::new(x, y) + DVec2::from_angle(TAU * k as f64 / VERTICES as f64) * radius;
    Ring::new((0..VERTICES).map(point).collect())
}

fn rectangle(x: f64, y: f64, width: f64, height: f64) -> Ring {
    Ring::new([(x, y), (x + width, y), (x + width, y + height), (x, y + height)].map(DVec2::from).to_vec())
}

fn turned(polygon: &Polygon) -> Polygon {
    let turn = |ring: &Ring| Ring::new(ring.points().iter().map(|p| p.perp()).collect());
    Polygon { outer: turn(&polygon.outer), holes: polygon.holes.iter().map(turn).collect() }
}

/// Plates of the kinds that the paper shows. They stand upright: scan lines at 0° run across them.
fn plates() -> [Plate; 3] {
    let plate =
        |outer: Ring, holes: Vec<Ring>| Polygon { outer, holes: holes.into_iter().map(Ring::reversed).collect() };
    let eight = [
        (12.0, 12.0),
        (36.0, 62.0),
        (14.0, 36.0),
        (13.0, 86.0),
        (38.0, 14.0),
        (15.0, 60.0),
        (37.0, 88.0),
        (37.0, 38.0),
    ];
    let nine_loops = plate(rectangle(0.0, 0.0, 50.0, 100.0), eight.map(|(x, y)| circle(x, y, 6.0)).to_vec());
    let comb = [
        (0.0, 0.0),
        (80.0, 0.0),
        (80.0, 60.0),
        (68.0, 60.0),
        (68.0, 32.0),
        (56.0, 32.0),
        (56.0, 60.0),
        (44.0, 60.0),
        (44.0, 28.0),
        (32.0, 28.0),
        (32.0, 60.0),
        (20.0, 60.0),
        (20.0, 34.0),
        (10.0, 34.0),
        (10.0, 60.0),
        (0.0, 60.0),
    ];
    let comb = Ring::new(comb.map(DVec2::from).to_vec());
    let twelve_regions = plate(comb, vec![circle(16.0, 14.0, 7.0), circle(60.0, 16.0, 8.0)]);
    let five = vec![
        circle(20.0, 20.0, 9.0),
        rectangle(12.0, 70.0, 14.0, 22.0),
        circle(45.0, 50.0, 12.0),
        rectangle(48.0, 12.0, 12.0, 16.0),
        circle(52.0, 88.0, 8.0),
    ];
    let six_loops = plate(rectangle(0.0, 0.0, 70.0, 110.0), five);
    [
        Plate { name: "nine loops, 50 × 100 mm", polygon: nine_loops, paper: [19.5, 12.6] },
        Plate { name: "twelve sub-regions, 80 × 60 mm", polygon: twelve_regions, paper: [12.5, 11.6] },
        Plate { name: "six loops, 70 × 110 mm", polygon: six_loops, paper: [10.7, 8.9] },
    ]
}
