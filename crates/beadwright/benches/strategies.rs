//! The common table of all strategies: five parts, three angles, all layers, planned as `beadwright plan` does; and a page
//! for each strategy with its picture and its figures.
//!
//! `cargo bench -p beadwright --bench strategies` writes the table into docs/strategies.md, the figures into the pages of
//! docs/strategies, those of the propeller into README.md and docs/book/choosing.md, all between two marks, and the pictures
//! into docs/pictures/strategies. Each cell has the worst of the three angles. `-- --parts star --strategies mat` prints only these and writes nothing, `-- --pictures`
//! draws only the pictures. plate_holes.stl is read from `BEADWRIGHT_MODELS` (default ../shared/models).
#![allow(clippy::unwrap_used, missing_docs)]

use beadwright::fill::StrategyName;
use beadwright::glam::DVec3;
use beadwright::model::{self, Mesh};
use beadwright::profile::Profile;
use beadwright::task::Task;
use beadwright::{compare, example, plan, report};
use std::fmt::Write;
use std::path::{Path, PathBuf};

const PARTS: [(&str, f64); 5] =
    [("cross", 1.0), ("star", 1.0), ("gear", 1.0), ("propeller", 1.0), ("plate_holes.stl", 0.7)];
const TURNS: [f64; 3] = [0.0, 10.0, 37.0];
const HEAD: &str = "void % | worst layer | overfill % | arc starts | bead m | turns | time min | refilled | left out |";
/// The rows of README.md: the method as the table names it, and whose it is.
const README: [(&str, &str); 8] = [
    ("loop", "ours"),
    ("hybrid", "ours, after Zhao et al. 2023"),
    ("mat", "Ding et al. 2016"),
    (LITERAL, "Zhao et al. 2023"),
    ("contour", "slicers"),
    ("spiral", "Park et al. 2003"),
    ("compound", "Liu et al. 2022"),
    ("zigzag", "Han et al. 2018"),
];
/// The rows of docs/book/choosing.md.
const CHOOSING: [&str; 8] = ["loop", "hybrid", LITERAL, "spiral", "contour", "compound", "zigzag", "raster"];
/// The hybrid as its paper describes it.
const LITERAL: &str = "hybrid --literal";
/// The cells of a row that the short tables have: void, overfill, arc starts, time.
const SHORT: [usize; 4] = [0, 2, 3, 6];
/// Index of the layer that is drawn, from 0.
const DRAWN: usize = 4;

fn main() {
    let words: Vec<String> = std::env::args().collect();
    let given = |name: &str| words.iter().position(|word| word == name).and_then(|at| words.get(at + 1));
    let chosen = |list: Option<&String>, name: &str| list.is_none_or(|list| list.split(',').any(|one| one == name));
    let mut profile = Profile::built_in("cmt-al2319-kuka").unwrap();
    // Paths are compared, not what the pace makes good.
    profile.layers.level = false;
    if words.iter().any(|word| word == "--pictures") {
        return pictures(&profile);
    }
    let mut literal = profile.clone();
    literal.hybrid.literal = true;
    let mut methods: Vec<(String, StrategyName, &Profile)> =
        StrategyName::ALL.iter().map(|&strategy| (strategy.to_string(), strategy, &profile)).collect();
    methods.push((LITERAL.to_owned(), StrategyName::Hybrid, &literal));
    let mut rows: Vec<Row> = Vec::new();
    for (name, scale) in PARTS.into_iter().filter(|part| chosen(given("--parts"), part.0)) {
        let mesh = mesh(name);
        let part = if scale == 1.0 { name.to_owned() } else { format!("{name} × {scale}") };
        for (method, strategy, profile) in
            methods.iter().filter(|method| chosen(given("--strategies"), method.1.name()))
        {
            let worst = TURNS.map(|turn| row(&mesh, scale, turn, *strategy, profile)).into_iter();
            let worst = worst.reduce(|a, b| std::array::from_fn(|k| a[k].max(b[k]))).unwrap();
            let [void, layer, over, starts, metres, turns, minutes, refilled, lost] = worst;
            let cells = format!(
                "{void:.2} | {layer:.2} | {over:.2} | {starts:.1} | {metres:.2} | {turns:.0} | {minutes:.1} | {refilled:.0} | {lost:.0} |"
            );
            println!("{part} | {method} | {cells}");
            rows.push(Row { part: part.clone(), method: method.clone(), strategy: *strategy, cells });
        }
    }
    if given("--parts").or(given("--strategies")).is_none() {
        write(&rows);
        pictures(&profile);
    }
}

/// What a method does to a part.
struct Row {
    part: String,
    method: String,
    strategy: StrategyName,
    cells: String,
}

/// Writes the common table, and the figures of each strategy into its page, and those of the propeller where they are shown.
fn write(rows: &[Row]) {
    let mut common = String::new();
    for of_part in rows.chunk_by(|a, b| a.part == b.part) {
        let name = |row: &Row| format!("[{}](strategies/{}.md)", row.method, row.strategy);
        let lines: Vec<_> = of_part.iter().map(|row| (name(row), &row.cells)).collect();
        common += &table(&of_part[0].part, lines.iter().map(|(name, cells)| (name.as_str(), cells.as_str())));
    }
    fill("strategies.md", "table", &common);
    for &strategy in StrategyName::ALL {
        let own = rows.iter().filter(|row| row.method == strategy.name());
        let figures = table("part", own.map(|row| (row.part.as_str(), row.cells.as_str())));
        fill(&format!("strategies/{strategy}.md"), "figures", &figures);
    }
    let propeller = |method: &str| rows.iter().find(|row| row.part == "propeller" && row.method == method).unwrap();
    let readme = README.map(|(method, whose)| {
        let cells = short(propeller(method));
        // The default stands out.
        match method {
            "loop" => format!("| **{method}** | {whose} | **{}** |\n", cells.replace(" | ", "** | **")),
            _ => format!("| {method} | {whose} | {cells} |\n"),
        }
    });
    let head = "| strategy | method of | void % | overfill % | arc starts | time min |\n| --- | --- | ---: | ---: | ---: | ---: |\n";
    fill("../README.md", "propeller", &(head.to_owned() + &readme.concat()));
    let choosing = CHOOSING
        .map(propeller)
        .map(|row| format!("| [{}](../strategies/{}.md) | {} |\n", row.method, row.strategy, short(row)));
    let head =
        "| | void % | overfill % | arc starts a layer | time min a layer |\n| --- | ---: | ---: | ---: | ---: |\n";
    fill("book/choosing.md", "propeller", &(head.to_owned() + &choosing.concat()));
}

/// The cells of the short tables.
fn short(row: &Row) -> String {
    let cells: Vec<&str> = row.cells.split('|').map(str::trim).collect();
    SHORT.map(|k| cells[k]).join(" | ")
}

fn table<'a>(corner: &str, rows: impl Iterator<Item = (&'a str, &'a str)>) -> String {
    let mut table = format!("\n| {corner} | {HEAD}\n| --- |{}\n", " ---: |".repeat(9));
    rows.for_each(|(name, cells)| writeln!(table, "| {name} | {cells}").unwrap());
    table
}

fn docs(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs").join(name)
}

/// Puts text between the marks of a page.
fn fill(page: &str, mark: &str, text: &str) {
    let [begin, end] = [format!("<!-- {mark} -->\n"), format!("<!-- end of {mark} -->\n")];
    let old = std::fs::read_to_string(docs(page)).unwrap();
    let (before, rest) = old.split_once(&begin).unwrap();
    let (_, behind) = rest.split_once(&end).unwrap();
    std::fs::write(docs(page), format!("{before}{begin}{text}{end}{behind}")).unwrap();
}

/// A layer of the gear by each strategy, of the frame by `wall`.
fn pictures(profile: &Profile) {
    for &strategy in StrategyName::ALL {
        let part = if strategy == StrategyName::Wall { "tian" } else { "gear" };
        let mut profile = profile.clone();
        profile.fill.strategy = strategy;
        let plan = plan::plan(part, &mesh(part), &profile, &Task::new()).unwrap();
        let title = format!("{strategy}: layer {} of the example {part}", DRAWN + 1);
        let picture = report::svg::layer(&plan.layers[DRAWN], &title);
        std::fs::write(docs(&format!("pictures/strategies/{strategy}.svg")), picture).unwrap();
    }
}

fn mesh(name: &str) -> Mesh {
    if let Some(example) = example::find(name) {
        return example.mesh();
    }
    let default = || Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/models");
    let folder = std::env::var_os("BEADWRIGHT_MODELS").map_or_else(default, PathBuf::from);
    model::import(&std::fs::read(folder.join(name)).unwrap(), &Task::new()).unwrap().mesh
}

/// Void in %, over all layers and on the worst one; overfill in %; arc starts, metres of bead, turns and minutes a layer;
/// islands that contours had to fill, and passes left out since they were too short, in all.
fn row(mesh: &Mesh, scale: f64, turn: f64, strategy: StrategyName, profile: &Profile) -> [f64; 9] {
    let (mut mesh, mut profile) = (mesh.clone(), profile.clone());
    mesh.place(scale, DVec3::new(0.0, 0.0, turn));
    profile.fill.strategy = strategy;
    let entry =
        compare::strategy(&mesh, &profile, strategy, plan::deposit_settings(&profile), &None, &Task::new()).unwrap();
    let warnings = plan::plan(strategy.name(), &mesh, &profile, &Task::new()).unwrap().summary.warnings;
    let count = |kind| warnings.summaries().filter(|w| w.kind == kind).map(|w| w.count).sum::<usize>() as f64;
    let (figures, totals, layers) = (&entry.figures, &entry.totals, entry.layers.len() as f64);
    let worst = entry.layers.iter().map(|layer| layer.figures.void_percent()).fold(0.0, f64::max);
    [
        figures.void_percent(),
        worst,
        figures.overfill_percent(),
        totals.arc_starts as f64 / layers,
        totals.deposited_length_mm / 1e3 / layers,
        totals.turns as f64 / layers,
        totals.total_time_s / 60.0 / layers,
        count(beadwright::warning::WarningKind::Refilled),
        count(beadwright::warning::WarningKind::PassTooShort),
    ]
}
