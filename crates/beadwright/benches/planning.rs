//! `cargo bench`: import, slicing and planning of the 1.1-million-triangle bunny, beside copying the same bytes.
//!
//! The model is taken from `BEADWRIGHT_MODELS` (default `../shared/models`); without it nothing is measured.
#![allow(clippy::unwrap_used)]

use beadwright::deposit::Judge;
use beadwright::example;
use beadwright::fill::StrategyName;
use beadwright::model::{self, Mesh};
use beadwright::order::Method;
use beadwright::order::tour::{Ends, Stop};
use beadwright::plan;
use beadwright::planar::{Polygon, Ring};
use beadwright::profile::Profile;
use beadwright::robot::{self, Cell, Track};
use beadwright::slice::{SliceOptions, Slicer};
use beadwright::task::Task;
use divan::{Bencher, black_box};
use glam::DVec2;
use rayon::prelude::*;
use std::f64::consts::TAU;
use std::io::Read;
use std::path::PathBuf;
use std::sync::LazyLock;

fn main() {
    divan::main();
}

static BYTES: LazyLock<Option<Vec<u8>>> = LazyLock::new(|| {
    let workspace = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");
    let folder = std::env::var("BEADWRIGHT_MODELS").unwrap_or_else(|_| format!("{workspace}/../shared/models"));
    let file = std::fs::File::open(PathBuf::from(folder).join("bunny_1114k.stl.gz")).ok()?;
    let mut bytes = Vec::new();
    flate2::read::GzDecoder::new(file).read_to_end(&mut bytes).ok()?;
    Some(bytes)
});

static MESH: LazyLock<Option<Mesh>> = LazyLock::new(|| {
    let mut mesh = model::import(BYTES.as_deref()?, &Task::new()).ok()?.mesh;
    mesh.place(1.0, glam::DVec3::ZERO);
    Some(mesh)
});

fn options(mesh: &Mesh) -> SliceOptions {
    SliceOptions { layer_height: mesh.size().z / 500.0, close_gap: 0.1, simplify: 0.01 }
}

/// The yardstick: one copy of the file's bytes.
#[divan::bench]
fn copy_bytes(bencher: Bencher) {
    if let Some(bytes) = BYTES.as_deref() {
        bencher.bench_local(|| black_box(bytes).to_vec());
    }
}

/// Reading, welding, repair.
#[divan::bench(sample_count = 20)]
fn import(bencher: Bencher) {
    if let Some(bytes) = BYTES.as_deref() {
        bencher.bench_local(|| model::import(black_box(bytes), &Task::new()).unwrap());
    }
}

/// 500 layers of the imported mesh.
#[divan::bench(sample_count = 20)]
fn slice_500_layers(bencher: Bencher) {
    if let Some(mesh) = MESH.as_ref() {
        bencher.bench_local(|| Slicer::new(mesh, options(mesh), &Task::new()).unwrap().all(&Task::new()).unwrap());
    }
}

/// Import and 500 layers: what the goal of ten file readings is about.
#[divan::bench(sample_count = 20)]
fn import_and_slice_500_layers(bencher: Bencher) {
    if let Some(bytes) = BYTES.as_deref() {
        bencher.bench_local(|| {
            let mut mesh = model::import(black_box(bytes), &Task::new()).unwrap().mesh;
            mesh.place(1.0, glam::DVec3::ZERO);
            let slicer = Slicer::new(&mesh, options(&mesh), &Task::new()).unwrap();
            slicer.all(&Task::new()).unwrap()
        });
    }
}

/// All 997 layers of 0.2 mm with a bead of 0.45 mm, kept in memory.
#[divan::bench(sample_count = 5)]
fn plan_997_layers(bencher: Bencher) {
    let profile = Profile::parse(include_str!("fdm-0.45x0.2.toml")).unwrap();
    if let Some(mesh) = MESH.as_ref() {
        bencher.bench_local(|| plan::plan("bunny", mesh, &profile, &Task::new()).unwrap());
    }
}

/// Planning of the propeller, the yardstick of the next one.
#[divan::bench]
fn plan_propeller(bencher: Bencher) {
    let (mesh, profile) = propeller();
    bencher.bench(|| plan::plan("propeller", &mesh, &profile, &Task::new()).unwrap());
}

/// Judging all layers of the propeller at w/20; items are points × strokes.
#[divan::bench]
fn judge_propeller(bencher: Bencher) {
    let (mesh, profile) = propeller();
    let plan = plan::plan("propeller", &mesh, &profile, &Task::new()).unwrap();
    let judged = |mut judge: Judge| plan.layers.iter().map(|layer| judge.layer(layer).work).sum::<usize>();
    let judge = || Judge::new(plan::deposit_settings(&profile));
    // A judge spares most of the work, so it is counted by the reference.
    let work = judged(judge().with_every_point());
    bencher.counter(divan::counter::ItemsCount::new(work)).bench(|| judged(judge()));
}

/// The bound of the last one: adding a number to as many places in memory (f64, larger than the cache), on all threads.
#[divan::bench]
fn add_to_memory(bencher: Bencher) {
    let mut field = vec![0.0_f64; 1 << 24];
    let count = divan::counter::ItemsCount::new(field.len());
    bencher
        .counter(count)
        .bench_local(|| field.par_chunks_mut(1 << 16).for_each(|c| c.iter_mut().for_each(|v| *v += 1.5)));
}

fn propeller() -> (Mesh, Profile) {
    (example::find("propeller").unwrap().mesh(), Profile::built_in("cmt-al2319-kuka").unwrap())
}

/// One layer by a strategy over the number of outline vertices: a wavy disc of 250 mm, every vertex of it off the line
/// between its neighbours.
#[divan::bench(args = [("loop", 1250), ("loop", 5000), ("loop", 20_000), ("contour", 20_000), ("hybrid", 1250), ("hybrid", 5000), ("hybrid", 20_000)], sample_count = 10)]
fn layer_of_vertices(bencher: Bencher, (strategy, vertices): (&str, usize)) {
    let place = |k: usize| {
        let turn = k as f64 / vertices as f64 * TAU;
        let noise = 0.005 * ((k * 7919) % 101) as f64 / 100.0;
        DVec2::from_angle(turn) * (115.0 + 10.0 * (9.0 * turn).sin() + noise)
    };
    fill_layer(bencher, strategy, &Polygon::simple(Ring::new((0..vertices).map(place).collect())));
}

/// One layer by the loop over the number of holes of 16 mm, each in 40 × 40 mm of plate: four times the holes are four times
/// the area.
#[divan::bench(args = [12, 50, 200], sample_count = 5)]
fn loop_of_holes(bencher: Bencher, holes: usize) {
    let columns = (holes as f64).sqrt().round() as usize;
    let rows = holes / columns;
    let size = DVec2::new(columns as f64, rows as f64) * 40.0;
    let outer = [DVec2::ZERO, DVec2::new(size.x, 0.0), size, DVec2::new(0.0, size.y)].to_vec();
    let hole = |k: usize| {
        let middle = DVec2::new((k % columns) as f64 + 0.5, (k / columns) as f64 + 0.5) * 40.0;
        Ring::new((0..48).map(|i| middle + DVec2::from_angle(-TAU * f64::from(i) / 48.0) * 8.0).collect())
    };
    let island = Polygon { outer: Ring::new(outer), holes: (0..columns * rows).map(hole).collect() };
    fill_layer(bencher, "loop", &island);
}

fn fill_layer(bencher: Bencher, strategy: &str, island: &Polygon) {
    let profile = Profile::built_in("cmt-al2319-kuka").unwrap();
    let settings = profile.fill_settings(0);
    let strategy = strategy.parse::<StrategyName>().unwrap().strategy();
    bencher.bench(|| strategy.fill(black_box(island), &settings));
}

/// Rings in a square of 100 mm, as contours of a layer.
fn rings(count: usize) -> Vec<Stop> {
    let mut seed = 1_u64;
    let mut next = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 33) as f64 / (1_u64 << 31) as f64
    };
    let mut ring = || {
        let (x, y, radius, corners) = (100.0 * next(), 100.0 * next(), 2.0 + 8.0 * next(), 3 + (6.0 * next()) as usize);
        let corner = |k: usize| DVec2::new(x, y) + DVec2::from_angle(TAU * k as f64 / corners as f64) * radius;
        Stop::ring((0..corners).map(corner).collect())
    };
    (0..count).map(|_| ring()).collect()
}

/// Order and start points by the default search.
#[divan::bench(args = [9, 20, 50, 100, 200], sample_count = 10)]
fn order_local_search(bencher: Bencher, count: usize) {
    let stops = rings(count);
    bencher.bench_local(|| Method::LocalSearch.tour(black_box(&stops), Ends::Closed));
}

/// The same by the ant colony of Han et al. 2018.
#[divan::bench(args = [9, 20, 50, 100, 200], sample_count = 3)]
fn order_ant_colony(bencher: Bencher, count: usize) {
    let stops = rings(count);
    bencher.bench_local(|| Method::AntColony.tour(black_box(&stops), Ends::Closed));
}

/// Joint angles and margins of all ways to stand at each stop of the propeller's program; items are poses.
#[divan::bench(args = ["kuka-kr20-r1810", "abb-irb1410"], sample_count = 50)]
fn solve_poses(bencher: Bencher, cell: &str) {
    let (cell, track) = (Cell::built_in(cell).unwrap(), propeller_track());
    let (arm, base_from_part) = (cell.arm(), cell.part.base_from_part());
    let tool_from_flange = cell.flange_from_tool().inverse();
    let flange = |at| base_from_part.then(&robot::part_from_tool(at, 100.0)).then(&tool_from_flange);
    let poses: Vec<robot::Frame> = track.stops.iter().map(|stop| flange(stop.at)).collect();
    let solve = |pose| arm.inverse(pose).iter().map(|(_, joints)| arm.margins(joints).least()).fold(0.0, f64::max);
    let count = divan::counter::ItemsCount::new(poses.len());
    bencher.counter(count).bench_local(|| poses.iter().map(solve).sum::<f64>());
}

/// The whole walk along the propeller's program with all its torch angles, on all threads; items are poses.
#[divan::bench(args = ["kuka-kr20-r1810", "abb-irb1410"], sample_count = 20)]
fn reach_propeller(bencher: Bencher, cell: &str) {
    let (cell, track) = (Cell::built_in(cell).unwrap(), propeller_track());
    let count = robot::reach(&cell, cell.part, &track).computed;
    bencher.counter(divan::counter::ItemsCount::new(count)).bench(|| robot::reach(&cell, cell.part, &track));
}

/// FK(IK(pose)) of 100 000 random poses of each arm within its limits: panics where one comes back more than 1e-6 m away.
#[divan::bench(args = ["kuka-kr20-r1810", "abb-irb1410"], sample_count = 5)]
fn there_and_back(bencher: Bencher, cell: &str) {
    const POSES: u64 = 100_000;
    let arm = Cell::built_in(cell).unwrap().arm();
    let noise = |k: u64| ((k + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 11) as f64 / (1_u64 << 53) as f64;
    let joints = |k: u64| {
        std::array::from_fn(|j| arm.limits[j][0] + (arm.limits[j][1] - arm.limits[j][0]) * noise(6 * k + j as u64))
    };
    bencher.counter(divan::counter::ItemsCount::new(POSES)).bench(|| {
        for k in 0..POSES {
            let flange = arm.forward(&joints(k));
            let solutions = arm.inverse(&flange);
            let misses = |found: &robot::Joints| arm.forward(found).position.distance(flange.position) > 1e-3;
            assert!(!solutions.is_empty() && !solutions.iter().any(|(_, found)| misses(found)));
        }
    });
}

fn propeller_track() -> Track {
    let (mesh, profile) = propeller();
    let plan = plan::plan("propeller", &mesh, &profile, &Task::new()).unwrap();
    profile.track(&plan.layers)
}
