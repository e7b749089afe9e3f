//! The common table of all strategies: five parts, three angles, all layers, planned as `beadwright plan` does.
//!
//! `cargo bench -p beadwright --bench strategies` writes it into docs/strategies.md between the two marks there, with the
//! worst of the three angles in each cell. `-- --parts star --strategies mat` prints only these and writes nothing. plate_holes.stl is
//! read from `BEADWRIGHT_MODELS` (default ../shared/models).
#![allow(clippy::unwrap_used, missing_docs)]

use beadwright::fill::STRATEGIES;
use beadwright::glam::DVec3;
use beadwright::model::{self, Mesh};
use beadwright::profile::Profile;
use beadwright::task::Task;
use beadwright::{compare, example, plan};
use std::fmt::Write;
use std::path::{Path, PathBuf};

const PARTS: [(&str, f64); 5] =
    [("cross", 1.0), ("star", 1.0), ("gear", 1.0), ("propeller", 1.0), ("plate_holes.stl", 0.7)];
const TURNS: [f64; 3] = [0.0, 10.0, 37.0];
const MARKS: [&str; 2] = ["<!-- table -->\n", "<!-- end of table -->\n"];

fn main() {
    let words: Vec<String> = std::env::args().collect();
    let given = |name: &str| words.iter().position(|word| word == name).and_then(|at| words.get(at + 1));
    let chosen = given("--parts");
    let profile = Profile::built_in("cmt-al2319-kuka").unwrap();
    let mut tables = String::new();
    for (name, scale) in
        PARTS.into_iter().filter(|part| chosen.is_none_or(|chosen| chosen.split(',').any(|c| c == part.0)))
    {
        let mesh = mesh(name);
        let head = "void % | worst layer | overfill % | arc starts | bead m | turns | time min | refilled | left out |";
        let times = if scale == 1.0 { String::new() } else { format!(" × {scale}") };
        writeln!(tables, "\n| {name}{times} | {head}\n| --- |{}", " ---: |".repeat(9)).unwrap();
        for strategy in STRATEGIES
            .into_iter()
            .filter(|s| given("--strategies").is_none_or(|list| list.split(',').any(|name| name == s.name())))
        {
            let worst = TURNS.map(|turn| row(&mesh, scale, turn, strategy.name(), &profile)).into_iter();
            let worst = worst.reduce(|a, b| std::array::from_fn(|k| a[k].max(b[k]))).unwrap();
            let [void, layer, over, starts, metres, turns, minutes, refilled, lost] = worst;
            let line = format!(
                "| {} | {void:.2} | {layer:.2} | {over:.2} | {starts:.1} | {metres:.2} | {turns:.0} | {minutes:.1} | {refilled:.0} | {lost:.0} |",
                strategy.name()
            );
            println!("{name} {line}");
            writeln!(tables, "{line}").unwrap();
        }
    }
    if chosen.or(given("--strategies")).is_none() {
        let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/strategies.md");
        let text = std::fs::read_to_string(&page).unwrap();
        let (before, rest) = text.split_once(MARKS[0]).unwrap();
        let (_, behind) = rest.split_once(MARKS[1]).unwrap();
        std::fs::write(&page, format!("{before}{}{tables}{}{behind}", MARKS[0], MARKS[1])).unwrap();
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
fn row(mesh: &Mesh, scale: f64, turn: f64, strategy: &str, profile: &Profile) -> [f64; 9] {
    let (mut mesh, mut profile) = (mesh.clone(), profile.clone());
    mesh.place(scale, DVec3::new(0.0, 0.0, turn));
    profile.fill.strategy = strategy.to_owned();
    let entry =
        compare::strategy(&mesh, &profile, strategy, plan::deposit_settings(&profile), &None, &Task::new()).unwrap();
    let warnings = plan::plan(strategy, &mesh, &profile, &Task::new()).unwrap().summary.warnings;
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
