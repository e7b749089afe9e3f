//! Han et al. 2018: order of contours, raster angle, merging and order of sub-regions, on three printed plates.
//!
//! The paper shows its parts only as pictures, so these are plates of the same kind. They are compared with two plans:
//! parallel lines across the whole section that jump over holes, as the paper describes them, and sub-regions one by
//! one in scan order, a step of its method. Both take loops in file order from their first vertex, and scan lines at 0°
//! on one layer and at 90° on the next. Two layers are planned, since scan lines alternate, and every plate is turned
//! by 0 to 175° in steps of 5°: a single layer of a well-placed plate can be made to show anything.

mod beside;
mod plans;
mod plate;
mod turned;

pub use plans::{ALIKE, COLUMNS, FIXED, LITERAL, Lines, Loops, OURS, Outcome, PLAIN, Plan, Raster, Saved, WHOLE};
pub use plate::{Plate, Printed, plates};
pub use turned::{Printer, Turned};

use crate::{ReproduceError, Reproduced, goal};
use beadwright::fill::angle;
use beadwright::fill::compound::Compound;
use beadwright::order::tour::{self, Ends};
use beadwright::report::angles;
use beadwright::report::plot::{Curve, Plot};
use beadwright::report::sheet::{Row, Sheet};
use beadwright::task::Task;
use glam::DVec2;
use plans::{CONTOURS, STEPS};
use rayon::prelude::*;

/// Angles by which every plate is turned, °.
fn rotations() -> impl IndexedParallelIterator<Item = f64> {
    (0..36_u8).into_par_iter().map(|k| 5.0 * f64::from(k))
}

/// The outcomes of all plans at one rotation.
struct At {
    degrees: f64,
    steps: [Outcome; STEPS.len()],
    /// The outcomes of [`COLUMNS`] and of the other plans that are not steps.
    columns: Outcome,
    literal: Outcome,
    fixed: Outcome,
    alike: Outcome,
    whole: Outcome,
}

/// One of the outcomes.
type Which = fn(&At) -> Outcome;

impl At {
    fn new(plate: &Plate, degrees: f64, printer: &Printer) -> Self {
        let turned = Turned::new(plate, degrees, printer);
        let outcome = |plan: Plan| turned.outcome(&plan);
        let [columns, literal, fixed, alike, whole] = [COLUMNS, LITERAL, FIXED, ALIKE, WHOLE].map(outcome);
        Self { degrees, steps: STEPS.map(outcome), columns, literal, fixed, alike, whole }
    }

    /// What all steps together save compared with the plain plan.
    fn saved(&self) -> Saved {
        self.ours().saved(self.plain())
    }

    fn plain(&self) -> &Outcome {
        &self.steps[0]
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
         shows its parts only as pictures, and its machine is not known; these are of the same kind. Two layers are planned, the second with its scan \
         lines turned by 90°, and every plate is turned by 0 to 175° in steps of 5°. Times are those of a layer, the mean \
         of the two, on a machine with 1000 mm/s² that passes corners at 10 mm/s and loses no time where a path starts \
         (ours: the paper gives none of these).",
    );
    let (mut lines, mut rows, mut goals, mut swept) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    for plate in plates() {
        let at = |degrees: f64| task.check().map(|()| At::new(&plate, degrees, &printer));
        let sweep: Result<Vec<At>, _> = rotations().map(at).collect();
        let sweep = sweep.map_err(|e| ReproduceError(e.to_string()))?;
        let found = goals_of(&plate, &sweep);
        lines.extend(summary(&plate, &sweep, &found));
        rows.extend(found.iter().map(|goal| goal.row(&plate)));
        goals.extend(found.iter().map(|goal| goal.shown(&plate)));
        swept.push((plate, sweep));
    }
    page.heading("Reached and not reached").table(&GOAL_HEAD, &rows);
    page.text(
        "The paper counts one part at one rotation, the one it was drawn at. Where lines at 0° already run along the \
         plate (0° and 90°), the raster angle saves nothing, and only merging, order and start points are left.",
    );
    beside::absolute(&mut page, &swept, &printer);
    let ants = beside::colony(&mut page, &printer);
    beside::corners(&mut page, &swept);
    for (plate, sweep) in &swept {
        describe(&mut page, plate, sweep, &printer);
    }
    let pictures = ants.into_iter().map(|svg| ("b-ants.svg", svg)).collect();
    Ok(Reproduced { page, goals, pictures, lines, files: Vec::new() })
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

    /// A saving of the paper counts as reached by the mean of all rotations; a loss is judged at each of them.
    fn shown(&self, plate: &Plate) -> goal::Goal {
        let [mean, worst, _] = self.ours.cells();
        let what = format!("{}: {}, saved on the mean of 36 rotations", plate.name, self.what);
        let (paper, judged) = if self.goal < 0.0 {
            (format!("not given (ours: nowhere more than {} % lost)", -self.goal), self.ours.least.0)
        } else {
            (format!("{:.1} %", self.goal), self.ours.mean)
        };
        goal::Goal::new(&what, format!("{mean} %, worst {worst}"), &paper, judged >= self.goal)
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
            format!("reached on average, at the worst rotation {worst:.1} short")
        } else {
            format!("not reached: {mean:.1} short on average, {worst:.1} at the worst")
        }
    }
}

/// At most this much may be lost against a fixed angle, %.
const LOSES_AT_MOST: f64 = 0.5;

/// Our figures next to the paper's, against its plain plan and against loops in columns; and the raster angle against a
/// fixed one.
fn goals_of(plate: &Plate, sweep: &[At]) -> Vec<Goal> {
    let [travel, time] = plate.paper;
    let goal = |what, goal, value: &dyn Fn(&At) -> f64| Goal { what, goal, ours: Spread::of(sweep, value) };
    vec![
        goal("contour travel against file order (shuffled, weak)", travel, &|at| at.saved().travel),
        goal("contour travel against columns (boustrophedon)", travel, &|at| at.ours().saved(&at.columns).travel),
        goal("layer time against whole lines over holes, as the paper describes them", time, &|at| {
            at.ours().saved(&at.whole).time
        }),
        goal("the same by the paper's methods", time, &|at| at.literal.saved(&at.whole).time),
        goal("layer time against plain (its sub-regions are a step of the method)", time, &|at| at.saved().time),
        goal("layer time against plain with columns", time, &|at| at.ours().saved(&at.columns).time),
        goal("layer time against plain, by the paper's methods", time, &|at| at.literal.saved(at.plain()).time),
        goal("layer time, best angle against 0°/90°", -LOSES_AT_MOST, &|at| at.ours().saved(&at.fixed).time),
        goal("layer time, best angle against 0° on both layers", -LOSES_AT_MOST, &|at| {
            at.ours().saved(&at.alike).time
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

/// What a start of a path would have to cost for the paper's layer time to be reached on average, as a sentence.
fn start_cost(plate: &Plate, sweep: &[At]) -> Option<String> {
    let starts = |o: &Outcome| o.paths + plate.polygon.rings().count() as f64;
    let mean = |value: &dyn Fn(&At) -> f64| Spread::of(sweep, value).mean;
    let left = 1.0 - plate.paper[1] / 100.0;
    // Time and starts in excess of the goal.
    let seconds = mean(&|at| at.ours().seconds - left * at.plain().seconds);
    let fewer = mean(&|at| left * starts(at.plain()) - starts(at.ours()));
    (seconds > 0.0 && fewer > 0.0).then(|| {
        format!(
            "  a printer that loses {:.1} s at every start of a path would reach the paper's layer time on average",
            seconds / fewer
        )
    })
}

/// What each step saves of the plain plan's time beyond the previous step, %.
fn shares(sweep: &[At]) -> impl Iterator<Item = (&'static Plan, Spread)> + '_ {
    STEPS.iter().enumerate().skip(1).map(|(i, plan)| {
        let saved = |at: &At, step: usize| at.steps[step].saved(at.plain()).time;
        (plan, Spread::of(sweep, |at| saved(at, i) - saved(at, i - 1)))
    })
}

/// The section of a plate.
fn describe(page: &mut Sheet, plate: &Plate, sweep: &[At], printer: &Printer) {
    let plain = |text: String| (text, false);
    page.heading(plate.name);

    let row = |(plan, of): (&Plan, &dyn Fn(&At) -> Outcome)| {
        let mean = |value: fn(&Outcome) -> f64| Spread::of(sweep, |at| value(&of(at))).mean;
        let saved = Spread::of(sweep, |at| of(at).saved(at.plain()).time);
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
    let others: [(&Plan, Which); 5] = [
        (&COLUMNS, |at| at.columns),
        (&LITERAL, |at| at.literal),
        (&FIXED, |at| at.fixed),
        (&ALIKE, |at| at.alike),
        (&WHOLE, |at| at.whole),
    ];
    let others = others.iter().map(|(plan, of)| row((plan, of)));
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
            curve("ours, of whole lines", &|at| at.ours().saved(&at.whole).time),
            curve("the paper's methods", &|at| at.literal.saved(at.plain()).time),
            curve("0° on both layers", &|at| at.alike.saved(at.plain()).time),
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
    let [turns, _, corners] = angles::plots(&curves, None);
    page.svg(&turns.svg()).svg(&corners.svg());
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
