//! How figures depend on steps and voxels.

use crate::parts::{bead, built, on_corners, plate, settings, wall};
use distort::{Bead, Clamp, DVec3, Plate, Settings};

/// Layers laid several at a time bend the plate less than one by one, and less so the fewer there are at a time.
#[test]
fn layers_at_a_time() {
    let beads = wall(0.0, 24, 0.0);
    let mut lifts = Vec::new();
    for most_steps in [1, 3, 6, 12, 24] {
        let bent = on_corners(&beads, &Settings { most_steps, ..settings() });
        println!("wall of 24 layers, {:>2} steps: lift {:.4} mm", bent.steps.len(), bent.released.lift.range);
        lifts.push(bent.released.lift.range);
    }
    let last = lifts[4];
    let errors: Vec<f64> = lifts.iter().map(|lift| (lift / last - 1.0).abs()).collect();
    assert!(errors[3] < 0.05 && errors[3] < 0.3 * errors[2] && errors[2] < 0.5 * errors[1], "{errors:?}");
}

#[test]
fn smaller_voxels() {
    let beads = wall(0.0, 6, 0.0);
    let mut lifts = Vec::new();
    for (voxel, voxel_height) in [(6.0, 3.0), (6.0, 2.0), (3.0, 2.0), (3.0, 1.0), (1.5, 1.0)] {
        let bent = on_corners(&beads, &Settings { voxel, voxel_height, ..settings() });
        println!(
            "wall of 6 layers, voxels of {voxel} × {voxel} × {voxel_height} mm: {} voxels, lift {:.4} mm on clamps, {:.4} mm released; part {:.4} mm",
            bent.voxels.len(),
            bent.clamped.lift.range,
            bent.released.lift.range,
            bent.released.deviation.largest
        );
        lifts.push(bent.released.lift.range);
    }
    assert!((lifts[2] / lifts[4] - 1.0).abs() < 0.1, "{lifts:?}");
}

/// A wall that does not lie along the lattice bends its plate as one that does.
#[test]
fn at_any_angle() {
    // A round table of a plate would be fairer; a large square one is nearly so.
    let plate = Plate { low: DVec3::new(-90.0, -90.0, -8.0), high: DVec3::new(90.0, 90.0, 0.0), stiffness: 1.0 };
    let lift = |degrees: f64| {
        let way = DVec3::new(degrees.to_radians().cos(), degrees.to_radians().sin(), 0.0) * 40.0;
        let layer = |i: usize| {
            let top = DVec3::Z * 2.0 * (i + 1) as f64;
            let (from, to) = (top - way, top + way);
            bead(from.to_array(), to.to_array(), 100.0 * i as f64)
        };
        let beads: Vec<Bead> = (0..4).map(layer).collect();
        built(&plate, &beads, &[], &settings()).released.deviation.largest
    };
    let found = [0.0, 17.0, 30.0, 45.0].map(lift);
    println!("largest deviation of a wall at 0, 17, 30, 45°: {found:.4?} mm");
    assert!(found.iter().all(|f| (f / found[0] - 1.0).abs() < 0.1));
}

/// Two walls: welded in turns, mirrored, they bend the plate less than one after the other does to twist it.
#[test]
fn orders_differ() {
    let (near, far) = (wall(15.0, 6, 0.0), wall(-15.0, 6, 1000.0));
    let one_by_one: Vec<Bead> = near.iter().chain(&far).cloned().collect();
    let in_turns: Vec<Bead> = (0..6)
        .flat_map(|i| {
            [near[i].clone(), Bead { start: near[i].start + 50.0, end: near[i].end + 50.0, ..far[i].clone() }]
        })
        .collect();
    let clamps = plate().clamped_at_corners(10.0, Clamp::FIRM);
    let [a, b] = [&one_by_one, &in_turns].map(|beads| built(&plate(), beads, &clamps, &settings()));
    println!("one after the other {:.4} mm, in turns {:.4} mm", a.released.lift.range, b.released.lift.range);
    assert_ne!(a.released.lift.range, b.released.lift.range);
}

/// What is reported of the course of a build.
#[test]
fn course() {
    let bent = on_corners(&wall(0.0, 5, 0.0), &settings());
    assert_eq!(bent.steps.iter().map(|step| step.beads).sum::<usize>(), 5);
    assert!(bent.steps.windows(2).all(|pair| pair[0].time < pair[1].time));
    // 40 × 20 × 3 voxels of the plate, and 2 across × 5 levels × 30 of the wall.
    assert_eq!(bent.born.iter().filter(|&&born| born == 0).count(), 2400);
    let metal: f64 =
        bent.factors.iter().zip(&bent.born).filter(|(_, born)| **born > 0).map(|(f, _)| f * bent.grid.volume()).sum();
    assert!((metal / (90.0 * 6.0 * 10.0) - 1.0).abs() < 1e-9, "{metal}");
    assert_eq!(bent.steps.last().map(|step| step.lift), Some(bent.steps[4].lift));
}
