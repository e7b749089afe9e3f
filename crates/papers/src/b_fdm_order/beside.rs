//! The paper's printed figures next to ours: lengths and times, merged sub-regions, the ants' tours, and what turns lay
//! twice.

use super::plans::{LITERAL, OURS, Outcome, Plan, WHOLE};
use super::plate::{Plate, plates};
use super::turned::{Printer, Turned};
use super::{At, Spread};
use beadwright::order::Method;
use beadwright::order::tour::{self, Ends};
use beadwright::report::plot::{Curve, Plot};
use beadwright::report::sheet::{Row, Sheet};
use glam::DVec2;

fn plain(cells: impl IntoIterator<Item = String>) -> Row {
    cells.into_iter().map(|text| (text, false)).collect()
}

/// Table 1 in mm and s, and the numbers of sub-regions.
pub(super) fn absolute(page: &mut Sheet, swept: &[(Plate, Vec<At>)], printer: &Printer) {
    page.heading("Lengths and times as printed (table 1)");
    page.text(
        "The paper's parts are pictures, and its acceleration, its starts and its contours are not given, so only the \
         order of size can agree. Ours take longer before and after: our machine brakes at every corner. What is saved is \
         judged above.",
    );
    page.table(
        &ABSOLUTE_HEAD,
        &swept.iter().flat_map(|(plate, sweep)| absolute_rows(plate, sweep, printer)).collect::<Vec<_>>(),
    );
    let rows = swept.iter().filter_map(|(plate, _)| {
        let [before, after] = plate.printed.regions?;
        let turned = Turned::new(plate, 0.0, printer);
        let ours = [turned.sub_regions(), turned.merged_regions()];
        let text = |[before, after]: [usize; 2]| format!("{before} become {after}");
        Some(plain([plate.name.to_owned(), text([before, after]), text(ours)]))
    });
    page.table(&["sub-regions at 0°, merged (3.2)", "the paper", "ours"], &rows.collect::<Vec<_>>());
}

const ABSOLUTE_HEAD: [&str; 8] = [
    "plate",
    "a layer",
    "the paper: zigzag",
    "the paper: its method",
    "ours at 0°: whole lines",
    "ours at 0°: the paper's methods",
    "ours at 0°: all steps",
    "ours, mean of 36 rotations: whole lines, all steps",
];

fn absolute_rows(plate: &Plate, sweep: &[At], printer: &Printer) -> [Row; 2] {
    let turned = Turned::new(plate, 0.0, printer);
    let at_zero = [WHOLE, LITERAL, OURS].map(|plan: Plan| turned.outcome(&plan));
    let row = |what: &str, [before, after]: [f64; 2], value: fn(&Outcome) -> f64| {
        let means = [Spread::of(sweep, |at| value(&at.whole)), Spread::of(sweep, |at| value(at.ours()))];
        let [whole, literal, ours] = at_zero.each_ref().map(|outcome| format!("{:.1}", value(outcome)));
        let figure = format!("{} (figure {})", plate.name, plate.printed.figure);
        let means = format!("{:.1}, {:.1}", means[0].mean, means[1].mean);
        plain([figure, what.to_owned(), before.to_string(), after.to_string(), whole, literal, ours, means])
    };
    [
        row("contour travel, mm", plate.printed.travel, |o| o.contour_travel),
        row("time, s", plate.printed.seconds, |o| o.seconds),
    ]
}

/// Figure 4: the mean and the shortest tour of the ants over the rounds. Returns the picture for the first plate, which
/// is that of figure 4.
pub(super) fn colony(page: &mut Sheet, printer: &Printer) -> Option<String> {
    page.heading("The ant colony (figure 4)");
    page.text(
        "50 ants, 200 rounds, as in the paper; α = 1, β = 5, ρ = 0.1 are ours. The colony begins with the tour of the \
         improved nearest neighbour and orders its start points, but never moves them: so the optimum over order and start \
         points together, which the local search finds, stays out of its reach however long it runs. The mean does \
         not come down to the shortest tour, since ants explore to the end.",
    );
    let (rows, pictures): (Vec<Row>, Vec<String>) = plates().iter().map(|plate| colony_row(plate, printer)).unzip();
    pictures.iter().for_each(|svg| {
        page.svg(svg);
    });
    page.table(
        &[
            "plate",
            "improved nearest mm",
            "mean of round 1",
            "mean of round 200",
            "shortest",
            "found in round",
            "local search mm",
        ],
        &rows,
    );
    pictures.into_iter().next()
}

fn colony_row(plate: &Plate, printer: &Printer) -> (Row, String) {
    let turned = Turned::new(plate, 0.0, printer);
    let rounds = turned.convergence();
    let length = |method| tour::length(&turned.tour(super::Loops::By(method)), Ends::Closed);
    let (first, ours) = (length(Method::ImprovedNearest), length(Method::LocalSearch));
    let curve = |name: &str, value: &dyn Fn(usize) -> f64| Curve {
        name: name.to_owned(),
        points: (0..rounds.len()).map(|k| DVec2::new((k + 1) as f64, value(k))).collect(),
    };
    let plot = Plot {
        title: format!("{}: tours of 50 ants", plate.name),
        x: "round".to_owned(),
        y: "closed tour, mm".to_owned(),
        curves: vec![
            curve("mean of the round", &|k| rounds[k].mean),
            curve("shortest so far", &|k| rounds[k].shortest),
            curve("local search (ours)", &|_| ours),
        ],
        floating: true,
        ..Plot::default()
    };
    let shortest = rounds.last().map_or(first, |round| round.shortest);
    let found = match rounds.iter().position(|round| round.shortest <= shortest) {
        _ if shortest >= first => "none: it began with it".to_owned(),
        found => found.map_or_else(String::new, |k| (k + 1).to_string()),
    };
    let mean = |k: usize| rounds.get(k).map_or(0.0, |round| round.mean);
    let means = [first, mean(0), mean(rounds.len().saturating_sub(1)), shortest].map(|mm| format!("{mm:.1}"));
    let row = plain([plate.name.to_owned()].into_iter().chain(means).chain([found, format!("{ours:.1}")]));
    (row, plot.svg())
}

/// Eqs 10 and 11, and what tables 2 and 3 say of printed parts.
pub(super) fn corners(page: &mut Sheet, swept: &[(Plate, Vec<At>)]) {
    page.heading("What turns lay twice (eqs 10 and 11), and tables 2 and 3");
    page.text(
        "Tables 2 and 3 are measured on printed parts: a plan has neither roughness nor size. Table 2, of figure 1's part \
         of 100 × 50 × 20 mm: 99.752, 49.856, 20.141 mm by its method and 99.614, 49.725, 20.221 mm by zigzag, so errors \
         of 0.25, 0.14, 0.14 and 0.39, 0.28, 0.22 mm. The paper blames turns, where S = r² (cot θ/2 + θ/2 − π/2) is laid \
         twice and as much missed. On the mean of all rotations S falls about as much as the roughness of tops did. But a \
         plate that lies along the lines, as the paper's first and third do, keeps its angle and thus its turns, and S with \
         them: there the fewer starts and travels are the only difference that a plan shows. (The paper's text gives 235 to \
         250 µm for Rz of zigzag's tops; its table has 252.144.)",
    );
    let rows: Vec<Row> = swept.iter().map(|(plate, sweep)| corner_row(plate, sweep)).collect();
    page.table(&CORNER_HEAD, &rows);
}

const CORNER_HEAD: [&str; 8] = [
    "plate",
    "Ra of the top, the paper: less by %",
    "Ra of the side, the paper: less by %",
    "S at 0°/90° mm², mean of 36 rotations",
    "S by the paper's methods: less by %, mean",
    "the same at 0°",
    "S by all steps: less by %, mean",
    "ends of fill paths by all steps: less by %, mean",
];

fn corner_row(plate: &Plate, sweep: &[At]) -> Row {
    let less = |[before, after]: [f64; 2]| 100.0 * (1.0 - after / before);
    let [top, side] = plate.printed.roughness.map(less);
    let mean = |value: &dyn Fn(&At) -> f64| format!("{:.1}", Spread::of(sweep, value).mean);
    plain([
        plate.name.to_owned(),
        format!("{top:.1}"),
        format!("{side:.1}"),
        mean(&|at| at.whole.corner_area),
        mean(&|at| less([at.whole.corner_area, at.literal.corner_area])),
        sweep
            .first()
            .map_or_else(String::new, |at| format!("{:.1}", less([at.whole.corner_area, at.literal.corner_area]))),
        mean(&|at| less([at.whole.corner_area, at.ours().corner_area])),
        mean(&|at| less([at.whole.paths, at.ours().paths])),
    ])
}
