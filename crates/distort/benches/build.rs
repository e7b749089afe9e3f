//! Seconds that a build takes, and how they grow: `cargo bench -p bead-distort --bench build`.
#![allow(clippy::expect_used, reason = "a benchmark may fail by panic")]

use distort::{Bead, Clamp, DVec3, Plate, Settings, build};
use std::time::Instant;

const LENGTH: f64 = 40.0;
const WIDTH: f64 = 4.0;
const HEIGHT: f64 = 2.0;

/// A block of beads of 40 mm, side by side and layer on layer, on a plate of 12 mm with 20 mm around.
fn block(beside: usize, layers: usize) -> (Plate, Vec<Bead>) {
    let wide = beside as f64 * WIDTH;
    let plate = Plate {
        low: DVec3::new(-20.0, -20.0, -12.0),
        high: DVec3::new(LENGTH + 20.0, wide + 20.0, 0.0),
        stiffness: 1.0,
    };
    let bead = |i: usize| {
        let (y, z) = ((i % beside) as f64 * WIDTH + 0.5 * WIDTH, (i / beside + 1) as f64 * HEIGHT);
        let start = 8.0 * i as f64;
        let points = vec![DVec3::new(0.0, y, z), DVec3::new(LENGTH, y, z)];
        Bead { points, width: WIDTH, height: HEIGHT, heat: 200.0, start, end: start + 5.0, up: DVec3::Z }
    };
    (plate, (0..beside * layers).map(bead).collect())
}

fn main() {
    let sizes = [(50, 50, 3.2, 80), (100, 50, 3.2, 80), (100, 100, 4.0, 80), (100, 100, 3.0, 80), (100, 100, 3.0, 160)];
    println!("{:>7} {:>8} {:>6} {:>11} {:>8} {:>7}", "beads", "voxels", "steps", "iterations", "lift mm", "s");
    // `-- 100 100` only those of a size.
    let wanted: Vec<usize> = std::env::args().filter_map(|word| word.parse().ok()).collect();
    for (beside, layers, voxel, most_steps) in sizes {
        if wanted.len() == 2 && wanted != [beside, layers] {
            continue;
        }
        let (plate, beads) = block(beside, layers);
        let clamps = plate.clamped_at_corners(10.0, Clamp::FIRM);
        let settings = Settings { voxel, voxel_height: 2.0, most_steps, ..Settings::steel() };
        let begin = Instant::now();
        let bent = build(&plate, &beads, &clamps, &settings, &mut |_| true).expect("a block can be built");
        println!(
            "{:>7} {:>8} {:>6} {:>11} {:>8.2} {:>7.1}",
            beads.len(),
            bent.voxels.len(),
            bent.steps.len(),
            bent.iterations,
            bent.released.lift.range,
            begin.elapsed().as_secs_f64()
        );
    }
}
