//! Mirrored and turned input gives mirrored and turned output, and threads change nothing.

use crate::parts::{bead, built, on_corners, plate, settings, wall};
use distort::{Bead, Clamp, DVec3, Distortion, Plate, Settings};

/// Largest difference between a displacement and that of a mapped place in another build, over the lift.
fn difference(a: &Distortion, b: &Distortion, map: impl Fn(DVec3) -> DVec3) -> f64 {
    let apart = a.released.nodes.iter().zip(&a.released.moved).map(|(&node, moved)| {
        let there = b.at(&b.released, map(a.grid.place(node))).unwrap();
        map(*moved).distance(there)
    });
    apart.fold(0.0, f64::max) / a.released.lift.range
}

#[test]
fn symmetric_part() {
    let bent = on_corners(&wall(0.0, 4, 0.0), &settings());
    let (x, y) = (
        difference(&bent, &bent, |p| DVec3::new(-p.x, p.y, p.z)),
        difference(&bent, &bent, |p| DVec3::new(p.x, -p.y, p.z)),
    );
    println!("a wall in the middle: mirrored at x = 0 {x:.1e} of the lift, at y = 0 {y:.1e}");
    assert!(x < 1e-7 && y < 1e-7);
}

#[test]
fn mirrored_part() {
    let [left, right] = [15.0, -15.0].map(|y| on_corners(&wall(y, 4, 0.0), &settings()));
    let apart = difference(&left, &right, |p| DVec3::new(p.x, -p.y, p.z));
    println!("mirrored: {apart:.1e} of the lift");
    assert!(apart < 1e-7);
}

#[test]
fn turned_part() {
    let turn = |p: DVec3| DVec3::new(-p.y, p.x, p.z);
    let mut beads = wall(15.0, 3, 0.0);
    beads.push(bead([30.0, -20.0, 2.0], [30.0, 10.0, 2.0], 500.0));
    let turned: Vec<Bead> = beads
        .iter()
        .map(|bead| Bead { points: bead.points.iter().map(|&p| turn(p)).collect(), ..bead.clone() })
        .collect();
    let plate = plate();
    let across = Plate { low: DVec3::new(-30.0, -60.0, -6.0), high: DVec3::new(30.0, 60.0, 0.0), stiffness: 1.0 };
    let of =
        |plate: &Plate, beads: &[Bead]| built(plate, beads, &plate.clamped_at_corners(10.0, Clamp::FIRM), &settings());
    let apart = difference(&of(&plate, &beads), &of(&across, &turned), turn);
    println!("turned by 90°: {apart:.1e} of the lift");
    assert!(apart < 1e-7);
}

#[test]
fn shifted_part() {
    let shift = DVec3::new(300.0, -1000.0, 50.0);
    let moved: Vec<Bead> = wall(15.0, 3, 0.0)
        .iter()
        .map(|bead| Bead { points: bead.points.iter().map(|&p| p + shift).collect(), ..bead.clone() })
        .collect();
    let there = Plate { low: plate().low + shift, high: plate().high + shift, ..plate() };
    let lift = built(&there, &moved, &there.clamped_at_corners(10.0, Clamp::FIRM), &settings()).released.lift;
    let here = on_corners(&wall(15.0, 3, 0.0), &settings()).released.lift;
    assert!((lift.range / here.range - 1.0).abs() < 1e-6, "{lift:?} {here:?}");
}

#[test]
fn threads() {
    // Large enough for several chunks and levels.
    let settings = Settings { voxel: 1.0, voxel_height: 1.0, most_steps: 4, ..settings() };
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| on_corners(&wall(9.0, 4, 0.0), &settings))
    };
    let one = with(1);
    println!("{} voxels, {} iterations", one.voxels.len(), one.iterations);
    let bits = |bent: &Distortion| -> Vec<u64> {
        let shapes = [&bent.clamped, &bent.released];
        shapes.iter().flat_map(|shape| &shape.moved).flat_map(|m| m.to_array()).map(f64::to_bits).collect()
    };
    for threads in [2, 3] {
        let other = with(threads);
        assert!(bits(&one) == bits(&other), "{threads} threads");
        assert_eq!(one, other);
    }
}
