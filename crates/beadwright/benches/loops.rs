//! The strategies on eight parts, all layers, turned by several angles: voids, overfill, arc starts, time. What the table of
//! docs/strategies.md is made with.
//!
//! `cargo bench --bench loops [-- --turns 0,10,37,45] [--strategies loop,contour] [--parts star,gear] [--set KEY=VALUE]…`;
//! models are read from `BEADWRIGHT_MODELS` (default ../shared/models), and left out with a word where there are none.
#![allow(clippy::unwrap_used, clippy::panic, missing_docs)]

use beadwright::deposit::{Figures, Judge};
use beadwright::fill::{self, Strategy, StrategyName};
use beadwright::layer::Layer;
use beadwright::model::{self, Mesh};
use beadwright::pass::Pass;
use beadwright::planar::{DVec2, Join, Polygon, Region};
use beadwright::profile::{Profile, edit};
use beadwright::program::Instruction;
use beadwright::slice::{Slice, Slicer};
use beadwright::task::Task;
use beadwright::{example, plan};
use std::path::{Path, PathBuf};
use std::time::Instant;

const PARTS: [(&str, f64); 8] = [
    ("cross", 1.0),
    ("star", 1.0),
    ("gear", 1.0),
    ("propeller", 1.0),
    ("plate_holes.stl", 0.7),
    ("body_structure_top.stl", 0.6),
    ("pulley_t30.stl", 9.0),
    ("bunny_closed.stl", 1.0),
];

/// Voids count where a disc of that many bead widths fits.
const DISC: f64 = 1.4;

fn main() {
    let words: Vec<String> = std::env::args().collect();
    let given = |name: &str, default: &str| -> Vec<String> {
        let at = words.iter().position(|word| word == name);
        let list = at.and_then(|at| words.get(at + 1)).map_or(default, String::as_str);
        list.split(',').map(str::to_owned).collect()
    };
    let sets = words.windows(2).filter(|pair| pair[0] == "--set").map(|pair| pair[1].split_once('=').unwrap());
    let text = Profile::built_in_text("cmt-al2319-kuka").unwrap().to_owned();
    let text = sets.fold(text, |text, (key, value)| edit::with_value(&text, key, value).unwrap());
    let profile = Profile::parse(&text).unwrap();
    let all: Vec<&str> = PARTS.iter().map(|part| part.0).collect();
    let names = given("--parts", &all.join(","));
    let everyone = "loop,contour,compound,zigzag,raster,hybrid";
    println!(
        "part, strategy, turn: void (worst layer), void where a disc of {DISC} w fits (worst), overfill (worst), outside;"
    );
    println!(
        "arc starts and islands a layer, moves a layer (arcs, 0.05 mm), ms a layer; layers whose starts are not their islands"
    );
    for (name, scale) in PARTS.into_iter().filter(|part| names.iter().any(|name| name == part.0)) {
        let Some(mesh) = mesh(name) else { continue };
        for turn in given("--turns", "0,10,37,45") {
            let mut mesh = mesh.clone();
            mesh.place(scale, glam::DVec3::new(0.0, 0.0, turn.parse().unwrap()));
            let slicer = Slicer::new(&mesh, profile.slice_options(), &Task::new()).unwrap();
            let layers = slicer.all(&Task::new()).unwrap();
            for strategy in given("--strategies", everyone) {
                let strategy = strategy.parse::<StrategyName>().unwrap_or_else(|error| panic!("{error}")).strategy();
                let row = Row::of(&layers, strategy, &profile, mesh.bounds().0.midpoint(mesh.bounds().1).truncate());
                println!("{name:24} {:9} {turn:>3}°: {row}", strategy.name());
            }
        }
    }
}

fn mesh(name: &str) -> Option<Mesh> {
    if let Some(example) = example::find(name) {
        return Some(example.mesh());
    }
    let default = || Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/models");
    let folder = std::env::var_os("BEADWRIGHT_MODELS").map_or_else(default, PathBuf::from);
    let Ok(bytes) = std::fs::read(folder.join(name)) else {
        eprintln!("left out: there is no {name} in {}", folder.display());
        return None;
    };
    Some(model::import(&bytes, &Task::new()).unwrap().mesh)
}

#[derive(Default)]
struct Row {
    layers: usize,
    all: Total,
    open: Total,
    starts: usize,
    islands: usize,
    moves: usize,
    seconds: f64,
    /// Layers that have more or fewer starts than islands.
    odd: Vec<usize>,
}

/// Figures over all layers, and the worst layer.
#[derive(Default)]
struct Total {
    sum: Figures,
    void: (f64, usize),
    overfill: (f64, usize),
}

impl Total {
    fn add(&mut self, layer: usize, figures: &Figures) {
        self.sum.add(figures);
        for (worst, value) in
            [(&mut self.void, figures.void_percent()), (&mut self.overfill, figures.overfill_percent())]
        {
            if value > worst.0 {
                *worst = (value, layer + 1);
            }
        }
    }
}

impl Row {
    fn of(layers: &[Slice], strategy: &dyn Strategy, profile: &Profile, datum: DVec2) -> Self {
        let mut row = Self { layers: layers.len(), ..Self::default() };
        let w = profile.bead.width;
        for slice in layers {
            let settings = fill::FillSettings { datum, ..profile.fill_settings(slice.index) };
            let clock = Instant::now();
            let fills: Vec<fill::Fill> = slice.islands.iter().map(|island| strategy.fill(island, &settings)).collect();
            row.seconds += clock.elapsed().as_secs_f64();
            let passes: Vec<Pass> = fills
                .into_iter()
                .flat_map(|fill| fill.stages)
                .flatten()
                .map(|path| lifted(path, slice.z, profile))
                .collect();
            let judged = |islands: &[Polygon]| {
                let layer =
                    Layer { index: slice.index, islands: islands.to_vec(), passes: passes.clone(), ..Layer::default() };
                Judge::new(plan::deposit_settings(profile)).layer(&layer).figures
            };
            let open = Region::from_normalised(slice.islands.clone());
            let open = open.offset(-DISC / 2.0 * w, Join::ROUND).offset(DISC / 2.0 * w, Join::ROUND).into_polygons();
            row.all.add(slice.index, &judged(&slice.islands));
            row.open.add(slice.index, &judged(&open));
            row.moves += moves(slice, &passes, profile);
            (row.starts, row.islands) = (row.starts + passes.len(), row.islands + slice.islands.len());
            if passes.len() != slice.islands.len() {
                row.odd.push(slice.index + 1);
            }
        }
        row
    }
}

fn lifted(path: fill::Path, z: f64, profile: &Profile) -> Pass {
    let (bead, law, speed) = (profile.bead(), &profile.bead.law, profile.process.deposition_speed);
    Pass {
        kind: path.kind,
        closed: path.closed,
        points: path.points.iter().map(|p| p.extend(z)).collect(),
        pace: path.width.map(|width| speed * law.pace(&bead, width)),
        width: path.width,
        wait: 0.0,
    }
}

fn moves(slice: &Slice, passes: &[Pass], profile: &Profile) -> usize {
    let mut profile = profile.clone();
    (profile.program.chord_tolerance, profile.program.arcs) = (0.05, true);
    let layer = Layer { index: slice.index, z: slice.z, passes: passes.to_vec(), ..Layer::default() };
    let program = profile.programmer().layer(&layer);
    program.instructions.iter().filter(|i| matches!(i, Instruction::Weld { .. })).count()
}

impl std::fmt::Display for Row {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let (all, open, layers) = (&self.all, &self.open, self.layers as f64);
        write!(
            f,
            "void {:.3} ({:.3} on {}), open {:.3} ({:.3} on {}), over {:.2} ({:.2} on {}), out {:.3}; ",
            all.sum.void_percent(),
            all.void.0,
            all.void.1,
            open.sum.void_percent(),
            open.void.0,
            open.void.1,
            all.sum.overfill_percent(),
            all.overfill.0,
            all.overfill.1,
            all.sum.outside_percent(),
        )?;
        let [starts, islands, moves] = [self.starts, self.islands, self.moves].map(|count| count as f64 / layers);
        write!(f, "{starts:.1} starts, {islands:.1} islands, {moves:.0} moves, {:.0} ms", 1e3 * self.seconds / layers)?;
        if self.odd.is_empty() { Ok(()) } else { write!(f, "; odd {:?}", &self.odd[..self.odd.len().min(12)]) }
    }
}
