//! The slices of Kuipers et al. 2020 and Hornus et al. 2020 by the strategy `loop`: what stays unfilled, what is laid twice,
//! how many paths, how long. `cargo bench --bench outlines [-- --rounds 0]`; the files lie in `BEADWRIGHT_OUTLINES`
//! (default ../shared/outlines).
//!
//! A bead is counted as flat and round at its ends: what a union of discs covers. The least and greatest width of each file
//! are the window; the nominal bead is 0.5 mm.
#![allow(clippy::unwrap_used, clippy::panic, missing_docs)]

use beadwright::bead::Section;
use beadwright::fill::{FillSettings, Path, StrategyName};
use beadwright::planar::{DVec2, FillRule, Lattice, Region, Ring};
use beadwright::profile::Profile;
use rayon::prelude::*;
use std::path::{self, PathBuf};
use std::time::Instant;

/// Nominal width of a bead, mm.
const WIDTH: f64 = 0.5;

struct Outline {
    limits: (f64, f64),
    region: Region,
}

struct Row {
    name: String,
    unfilled: f64,
    overlap: f64,
    outside: f64,
    paths: f64,
    islands: f64,
    seconds: f64,
}

fn main() {
    let folder = std::env::var_os("BEADWRIGHT_OUTLINES")
        .map_or_else(|| path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/outlines"), PathBuf::from);
    let mut words = std::env::args().skip_while(|word| word != "--rounds").skip(1);
    let rounds: u32 = words.next().map_or(25, |word| word.parse().unwrap());
    let Ok(entries) = std::fs::read_dir(&folder) else {
        return eprintln!("there are no outlines in {}; set BEADWRIGHT_OUTLINES", folder.display());
    };
    let mut files: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
    files.retain(|path| path.extension().is_some_and(|extension| extension == "txt"));
    files.sort();
    let mut rows: Vec<Row> = files.par_iter().map(|file| row(file, rounds)).collect();
    rows.sort_by(|a, b| b.unfilled.total_cmp(&a.unfilled));
    println!("{} outlines, {rounds} rounds of relaxation; the ten that are filled worst:", rows.len());
    for row in rows.iter().take(10) {
        let Row { name, unfilled, overlap, paths, islands, seconds, .. } = row;
        println!(
            "  {unfilled:6.3} % unfilled {overlap:6.2} % twice {paths:4} paths {islands:3} islands {seconds:6.3} s  {name}"
        );
    }
    type Figure = (&'static str, fn(&Row) -> f64);
    let figures: [Figure; 6] = [
        ("unfilled %", |row| row.unfilled),
        ("twice %", |row| row.overlap),
        ("outside %", |row| row.outside),
        ("paths", |row| row.paths),
        ("paths an island", |row| row.paths / row.islands),
        ("s", |row| row.seconds),
    ];
    println!("{:16} {:>8} {:>8} {:>8} {:>8}", "", "median", "mean", "95 %", "worst");
    for (name, value) in figures {
        let mut values: Vec<f64> = rows.iter().map(value).collect();
        values.sort_by(f64::total_cmp);
        let at = |share: f64| values[((values.len() - 1) as f64 * share) as usize];
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        println!("{name:16} {:8.3} {mean:8.3} {:8.3} {:8.3}", at(0.5), at(0.95), at(1.0));
    }
}

fn read(file: &path::Path) -> Outline {
    let text = std::fs::read_to_string(file).unwrap();
    let mut numbers = text.split_whitespace().map(|word| word.parse::<f64>().unwrap());
    let limits = (numbers.next().unwrap(), numbers.next().unwrap());
    let mut rings = Vec::new();
    while let Some(count) = numbers.next() {
        let mut point = || DVec2::new(numbers.next().unwrap(), numbers.next().unwrap());
        rings.push(Ring::new((0..count as usize).map(|_| point()).collect()));
    }
    Outline { limits, region: Region::from_rings(&rings, FillRule::EvenOdd) }
}

fn row(file: &path::Path, rounds: u32) -> Row {
    let Outline { limits, region } = read(file);
    let mut profile = Profile::built_in("fdm-abs-0.4").unwrap();
    profile.bead.width = WIDTH;
    profile.bead.section = Section::Stadium;
    let mut settings: FillSettings = profile.fill_settings(0);
    // A printer changes its flow at once and in the finest steps.
    (settings.one_loop.smoothing_length, settings.one_loop.width_step) = (0.0, 0.01 * WIDTH);
    // Flat beads side by side, thin enough that their round sides do not count.
    (settings.stepover, settings.bead.height, settings.min_pass_length) = (WIDTH, 1e-3, 0.0);
    (settings.one_loop.width_limits, settings.wall.width_limits, settings.one_loop.rounds) = (limits, limits, rounds);
    let strategy = StrategyName::Loop.strategy();
    let clock = Instant::now();
    let fills = region.polygons().iter().flat_map(|island| strategy.fill(island, &settings).stages);
    let passes: Vec<Path> = fills.flatten().collect();
    let seconds = clock.elapsed().as_secs_f64();
    let cover = Cover::of(&region, &passes);
    Row {
        name: file.file_stem().unwrap().to_string_lossy().into_owned(),
        unfilled: 100.0 * cover.missed / region.area(),
        overlap: 100.0 * (cover.laid - cover.covered) / region.area(),
        outside: 100.0 * cover.outside / region.area(),
        paths: passes.len() as f64,
        islands: region.polygons().len() as f64,
        seconds,
    }
}

/// Areas, mm².
struct Cover {
    missed: f64,
    covered: f64,
    outside: f64,
    laid: f64,
}

impl Cover {
    fn of(region: &Region, passes: &[Path]) -> Self {
        let grid = (region.area() / 4e6).sqrt().clamp(0.008, 0.03);
        let lattice = Lattice::covering(&region.bounds().unwrap(), 1.0, grid, 1);
        let inside = lattice.inside(region.rings());
        let mut covered = vec![false; lattice.len()];
        let mut laid = 0.0;
        for pass in passes {
            for (i, ends) in pass.path().windows(2).enumerate() {
                let width = pass.width.after(i);
                laid += width * ends[0].distance(ends[1]);
                paint(&mut covered, &lattice, [ends[0], ends[1]], width / 2.0);
            }
            if !pass.closed {
                laid += std::f64::consts::PI * (WIDTH / 2.0).powi(2);
            }
        }
        let cell = grid * grid;
        let area = |wanted: fn(bool, bool) -> bool| {
            inside.iter().zip(&covered).filter(|(inside, covered)| wanted(**inside, **covered)).count() as f64 * cell
        };
        Self {
            missed: area(|inside, covered| inside && !covered),
            covered: area(|_, covered| covered),
            outside: area(|inside, covered| !inside && covered),
            laid,
        }
    }
}

fn paint(covered: &mut [bool], lattice: &Lattice, [a, b]: [DVec2; 2], radius: f64) {
    let low = lattice.in_steps(a.min(b) - radius).ceil().max(DVec2::ZERO);
    let high = lattice.in_steps(a.max(b) + radius).floor();
    for row in low.y as usize..=high.y as usize {
        for column in low.x as usize..=high.x as usize {
            let place = lattice.place(column, row);
            if beadwright::planar::polyline::distance_squared_to_segment(place, a, b) <= radius * radius {
                covered[row * lattice.columns + column] = true;
            }
        }
    }
}
