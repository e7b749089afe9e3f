//! Liu et al. 2022: zigzag inside a contour. Figure 7 (four paths on a cross), the distance between the two on five parts
//! at twelve angles, and figure 8 (two larger parts).

use crate::goal::{self, Goal};
use crate::{ReproduceError, Reproduced};
use beadwright::compare::{self, Entry};
use beadwright::example;
use beadwright::fill::{RasterSpacing, StrategyName};
use beadwright::plan;
use beadwright::profile::{Profile, RasterTurn};
use beadwright::report::plot::{Curve, Plot};
use beadwright::report::sheet::{Row, Sheet};
use beadwright::task::Task;
use glam::{DVec2, DVec3};
use rayon::prelude::*;
use std::collections::BTreeSet;

/// The paper's distance between contour and zigzag, in bead widths.
const PAPER: f64 = 0.591;
/// The stepover of the zigzag lines, in bead widths.
const TANGENT: f64 = 0.738;

/// What the paper says of its four specimens, and our own strategy next to them.
const SPECIMENS: [(StrategyName, &str, f64, &str); 5] = [
    (StrategyName::Zigzag, "zigzag only", PAPER, "the outline is ragged"),
    (StrategyName::Contour, "contour only", PAPER, "pores along the middle"),
    (StrategyName::Compound, "compound, 0.738 w", TANGENT, "pores where zigzag meets contour"),
    (StrategyName::Compound, "compound, 0.591 w", PAPER, "dense, the shape is kept"),
    (StrategyName::Loop, "our loop", PAPER, "not in the paper"),
];

/// The parts on which the distance is tried.
const PARTS: [&str; 5] = ["cross", "star", "gear", "propeller", "plate"];
/// The angles, about the vertical, at which each of them is tried, degrees.
const TURNS: [f64; 12] = [0.0, 15.0, 30.0, 45.0, 60.0, 75.0, 90.0, 105.0, 120.0, 135.0, 150.0, 165.0];
/// The cross lies as in the paper, and turned by this angle, degrees.
const ASKEW: f64 = 10.0;
/// The cross whose distance is varied: its name, its angle in degrees, and how its lines are spread.
const SWEEPS: [(&str, f64, RasterSpacing); 3] = [
    ("as in the paper", 0.0, RasterSpacing::Even),
    ("lines fitted to long edges", 0.0, RasterSpacing::Fitted),
    ("turned by 10°", ASKEW, RasterSpacing::Fitted),
];
/// The sweep may fall by this much on its way up, % of the area.
const JUMP: f64 = 0.2;

/// Figure 8: a part with holes, and one of 200 × 200 mm, which the paper shows only as a picture: our gear stands in.
const FIGURE_8: [(&str, &str, f64); 2] =
    [("plate", "120 × 80 mm with holes", 1.0), ("gear", "200 × 200 mm", 200.0 / 140.0)];

/// One layer of a part.
#[derive(Clone, Copy)]
struct Case<'a> {
    part: &'a str,
    scale: f64,
    /// About the vertical, degrees.
    turn: f64,
    strategy: StrategyName,
    /// From the contour to the zigzag, in bead widths.
    gap: f64,
    lattice: RasterSpacing,
}

/// The paper's own case.
const CROSS: Case<'_> = Case {
    part: "cross",
    scale: 1.0,
    turn: 0.0,
    strategy: StrategyName::Compound,
    gap: PAPER,
    lattice: RasterSpacing::Even,
};

/// The void of one part at all angles, %, at the paper's distance and at that of the scan lines.
struct Turned {
    part: &'static str,
    near: Vec<f64>,
    far: Vec<f64>,
    /// Greatest overfill at the paper's distance, %.
    overfill: f64,
}

/// Runs the experiment.
///
/// # Errors
/// [`ReproduceError`] when the task was cancelled.
pub fn run(task: &Task) -> Result<Reproduced, ReproduceError> {
    let specimens = SPECIMENS.map(|(strategy, name, gap, words)| {
        let turned = |turn| Case { strategy, gap, turn, ..CROSS }.judged(task);
        Ok((name, words, [turned(0.0)?, turned(ASKEW)?]))
    });
    let specimens = specimens.into_iter().collect::<Result<Vec<_>, ReproduceError>>()?;
    let sweeps = SWEEPS.map(|(name, turn, lattice)| Ok((name, sweep(turn, lattice, task)?)));
    let sweeps = sweeps.into_iter().collect::<Result<Vec<_>, ReproduceError>>()?;
    let turned = turned(task)?;
    let goals = goals(&specimens, &sweeps, &turned);

    let mut page = Sheet::new(
        "c-compound",
        "Liu et al. 2022: a zigzag inside one contour, beads of 5 mm, one layer, scan lines parallel to y. The paper \
         shows photographs and prints no void: the figures are those of our deposit model. The paper's part lies along \
         the scan lines; here five parts are turned to twelve angles as well.",
    );
    goal::tabulate(&mut page, &goals);
    page.heading("Figure 7: four paths on a cross of 100 mm with arms of 36 mm");
    let rows: Vec<Row> = specimens
        .iter()
        .flat_map(|(name, words, [straight, askew])| {
            [row(name, words, straight), row(&format!("{name}, turned by {ASKEW}°"), "", askew)]
        })
        .collect();
    page.table(&FIGURES, &rows);
    for (turn, which) in [("as in the paper", 0), ("turned by 10°", 1)] {
        let maps: Vec<_> =
            specimens.iter().map(|(name, _, e)| ((*name).to_owned(), vec![picture(&e[which])])).collect();
        page.maps(&[turn.to_owned()], &maps);
    }
    page.heading("The distance from contour to zigzag");
    page.text(
        "Too far, and pores appear where the zigzag turns away from the contour; too near, and metal piles up there. On \
         the cross along the lines, pores have all but gone at the paper's 0.591 w. Turned, they stay: a line that \
         leaves the edge at a slant lays half of the wedges between line and edge bare, at any distance.",
    );
    page.svg(&swept(&sweeps).svg());
    page.heading("Five parts at twelve angles");
    page.table(&TURNED, &turned.iter().map(Turned::row).collect::<Vec<_>>());
    page.svg(&over_angles(&turned).svg());
    page.heading("Figure 8: two larger parts");
    page.text(
        "The paper's second part is known only from a picture; a gear of the same size stands in for it. The errors of \
         size (0.3 to 1.5 mm) and height (0.1 mm) that the paper measured are those of its machine.",
    );
    for (part, size, scale) in FIGURE_8 {
        let strategies = [StrategyName::Zigzag, StrategyName::Contour, StrategyName::Compound];
        let entries = strategies.map(|strategy| Case { part, scale, strategy, ..CROSS }.judged(task));
        let entries = entries.into_iter().collect::<Result<Vec<_>, _>>()?;
        let rows: Vec<Row> = entries.iter().map(|entry| row(&entry.name, "dense, even", entry)).collect();
        page.text(&format!("Of {size}:"));
        page.table(&FIGURES, &rows);
        page.maps(&[size.to_owned()], &entries.iter().map(|e| (e.name.clone(), vec![picture(e)])).collect::<Vec<_>>());
    }
    let lines = goals.iter().map(Goal::line).chain(specimens.iter().map(|(name, words, [e, _])| line(name, words, e)));
    Ok(Reproduced { page, lines: lines.collect(), files: Vec::new() })
}

impl Case<'_> {
    fn judged(&self, task: &Task) -> Result<Entry, ReproduceError> {
        let wrong = |e: &dyn std::fmt::Display| ReproduceError(e.to_string());
        let mut profile = Profile::built_in("plasma-304-cnc").map_err(|e| wrong(&e))?;
        profile.layers.level = false;
        profile.fill.contour_gap = self.gap;
        profile.fill.raster_angle = 90.0;
        profile.fill.raster_turn = RasterTurn::Fixed;
        profile.fill.raster_spacing = self.lattice;
        let part =
            example::find(self.part).ok_or_else(|| wrong(&format!("there is no example called {}", self.part)))?;
        let mut mesh = part.mesh();
        mesh.place(self.scale, DVec3::new(0.0, 0.0, self.turn));
        // One layer is enough.
        let height = profile.layers.height;
        mesh.vertices.iter_mut().for_each(|v| v.z = v.z.min(height));
        let (chosen, settings) = (Some(BTreeSet::from([0])), plan::deposit_settings(&profile));
        compare::strategy(&mesh, &profile, self.strategy, settings, &chosen, task).map_err(|e| wrong(&e))
    }
}

/// The cross over distances from contour to zigzag.
fn sweep(turn: f64, lattice: RasterSpacing, task: &Task) -> Result<Vec<(f64, Entry)>, ReproduceError> {
    let gaps: Vec<f64> = (0..=35).map(|k| 0.45 + 0.01 * f64::from(k)).collect();
    let judged = |gap: f64| Ok((gap, Case { gap, turn, lattice, ..CROSS }.judged(task)?));
    gaps.into_par_iter().map(judged).collect()
}

/// Five parts at twelve angles, lines fitted to long edges.
fn turned(task: &Task) -> Result<Vec<Turned>, ReproduceError> {
    let turned = |part: &'static str| {
        let judged = |gap: f64| -> Result<Vec<Entry>, ReproduceError> {
            let case = Case { part, gap, lattice: RasterSpacing::Fitted, ..CROSS };
            TURNS.par_iter().map(|&turn| Case { turn, ..case }.judged(task)).collect()
        };
        let (near, far) = (judged(PAPER)?, judged(TANGENT)?);
        let overfill = near.iter().map(|e| e.figures.overfill_percent()).fold(0.0, f64::max);
        let voids = |entries: &[Entry]| entries.iter().map(|e| e.figures.void_percent()).collect();
        Ok(Turned { part, near: voids(&near), far: voids(&far), overfill })
    };
    PARTS.into_iter().map(turned).collect()
}

impl Turned {
    /// The void at 0.738 w over that at 0.591 w, at each angle.
    fn ratios(&self) -> Vec<f64> {
        self.near.iter().zip(&self.far).map(|(near, far)| far / near.max(1e-3)).collect()
    }

    fn row(&self) -> Row {
        let ratios = self.ratios();
        let least = ratios.iter().copied().fold(f64::INFINITY, f64::min);
        let [near, far] = [&self.near, &self.far].map(|voids| voids.iter().copied().fold(0.0, f64::max));
        let figures = [near, self.overfill, far, median(ratios), least].map(|v| format!("{v:.2}"));
        std::iter::once(self.part.to_owned()).chain(figures).map(|text| (text, false)).collect()
    }
}

/// Columns of [`Turned::row`].
const TURNED: [&str; 6] = [
    "part, worst of twelve angles",
    "void at 0.591 w, %",
    "overfill, %",
    "void at 0.738 w, %",
    "ratio of the voids, median",
    "least",
];

/// The middle value; the mean of the two in the middle.
fn median(mut values: Vec<f64>) -> f64 {
    values.sort_unstable_by(f64::total_cmp);
    let half = values.len() / 2;
    if values.len() % 2 == 1 { values[half] } else { values[half - 1].midpoint(values[half]) }
}

/// What is judged.
fn goals(specimens: &[(&str, &str, [Entry; 2])], sweeps: &[(&str, Vec<(f64, Entry)>)], turned: &[Turned]) -> Vec<Goal> {
    let mut goals = Vec::new();
    if let [zigzag, contour, (_, _, far), (_, _, near), ..] = specimens {
        for (k, turn) in ["along the scan lines", "turned by 10°"].into_iter().enumerate() {
            let [zigzag, contour, far, near] = [&zigzag.2, &contour.2, far, near].map(|entries| &entries[k].figures);
            let ratio = far.void_percent() / near.void_percent().max(1e-3);
            goals.push(Goal::new(
                &format!("cross, {turn}: void at 0.738 w over void at 0.591 w, at least 5"),
                format!("{ratio:.1}"),
                "pores, and no pores; no figures",
                ratio >= 5.0,
            ));
            let [own, contour, zigzag] = [near, contour, zigzag].map(|figures| figures.void_percent());
            goals.push(Goal::new(
                &format!("cross, {turn}: less void at 0.591 w than contours or a zigzag alone leave"),
                format!("{own:.2} % for {contour:.2} and {zigzag:.2} %"),
                "photographs",
                own < contour.min(zigzag),
            ));
        }
    }
    let ratio = median(turned.iter().flat_map(Turned::ratios).collect());
    let void = turned.iter().flat_map(|t| &t.near).copied().fold(0.0, f64::max);
    let overfill = turned.iter().map(|t| t.overfill).fold(0.0, f64::max);
    goals.push(Goal::new(
        "five parts at twelve angles: median of that ratio, at least 5",
        format!("{ratio:.1}"),
        "not tried",
        ratio >= 5.0,
    ));
    goals.push(Goal::new(
        "the same, 0.591 w: void at most 0.5 % with overfill at most 2 %, worst of all",
        format!("void {void:.2} %, overfill {overfill:.2} %"),
        "not tried",
        void <= 0.5 && overfill <= 2.0,
    ));
    for (name, sweep) in sweeps {
        let fall = greatest_fall(sweep);
        goals.push(Goal::new(
            &format!("cross, {name}: void grows with the distance and falls back by at most {JUMP} points"),
            format!("{fall:.2} points"),
            "not given",
            fall <= JUMP,
        ));
    }
    goals
}

/// How far the void falls below what it was at a smaller distance, % of the area.
fn greatest_fall(sweep: &[(f64, Entry)]) -> f64 {
    let (mut most, mut fall): (f64, f64) = (0.0, 0.0);
    for (_, entry) in sweep {
        let void = entry.figures.void_percent();
        (most, fall) = (most.max(void), fall.max(most - void));
    }
    fall
}

/// Columns of [`row`].
const FIGURES: [&str; 7] = ["path", "the paper says", "void %", "low %", "overfill %", "outside %", "arc starts"];

fn row(name: &str, words: &str, entry: &Entry) -> Row {
    let f = &entry.figures;
    let percents = [f.void_percent(), f.low_percent(), f.overfill_percent(), f.outside_percent()];
    let texts = [name.to_owned(), words.to_owned()].into_iter().chain(percents.map(|v| format!("{v:.2}")));
    texts.chain([entry.totals.arc_starts.to_string()]).map(|text| (text, false)).collect()
}

fn picture(entry: &Entry) -> Option<&beadwright::deposit::Picture> {
    entry.layers.first().and_then(|layer| layer.picture.as_ref())
}

fn swept(sweeps: &[(&str, Vec<(f64, Entry)>)]) -> Plot {
    let curve = |name: &str, sweep: &[(f64, Entry)], value: fn(&Entry) -> f64| Curve {
        name: name.to_owned(),
        points: sweep.iter().map(|(gap, entry)| DVec2::new(*gap, value(entry))).collect(),
    };
    let (void, overfill) = (|e: &Entry| e.figures.void_percent(), |e: &Entry| e.figures.overfill_percent());
    let both = |(name, sweep): &(&str, Vec<(f64, Entry)>)| {
        [curve(&format!("void, {name}"), sweep, void), curve("overfill", sweep, overfill)]
    };
    Plot {
        title: "Pores and humps of the cross over the distance of contour and zigzag".to_owned(),
        x: "distance, bead widths".to_owned(),
        y: "% of the area".to_owned(),
        curves: sweeps.iter().flat_map(both).collect(),
        marks: vec![(PAPER, "0.591 w".to_owned()), (TANGENT, "0.738 w".to_owned())],
        ..Plot::default()
    }
}

/// The void of each part over the angle.
fn over_angles(turned: &[Turned]) -> Plot {
    let curve = |of: &Turned| Curve {
        name: of.part.to_owned(),
        points: TURNS.iter().zip(&of.near).map(|(&turn, &void)| DVec2::new(turn, void)).collect(),
    };
    Plot {
        title: "Pores at 0.591 w over the angle of the part".to_owned(),
        x: "angle, °".to_owned(),
        y: "% of the area".to_owned(),
        curves: turned.iter().map(curve).collect(),
        ..Plot::default()
    }
}

fn line(name: &str, words: &str, entry: &Entry) -> String {
    let f = &entry.figures;
    format!("{name:<20} void {:5.2} %  overfill {:5.2} %   paper: {words}", f.void_percent(), f.overfill_percent())
}
