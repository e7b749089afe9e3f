//! Forces and energies are in balance, and springs leave no trace when they are gone.

use crate::parts::{built, on_corners, plate, settings, wall};
use distort::{Balance, DVec3, Settings};

fn check(name: &str, balance: &Balance) {
    let energy = balance.energy + balance.clamp_energy;
    let error = (energy - balance.work).abs() / balance.work;
    println!(
        "{name}: residual {:.1e}, energy {energy:.3} N·mm, work differs by {error:.1e}, largest clamp force {:.0} N",
        balance.residual, balance.largest_reaction
    );
    println!(
        "    sum of clamp forces {:.1e} N, of moments {:.1e} N·mm",
        balance.reaction_sum.length(),
        balance.reaction_moment.length()
    );
    assert!(balance.residual < 1e-8);
    assert!(error < 1e-8);
    assert!(balance.reaction_sum.length() <= 1e-8 * balance.largest_reaction.max(1.0));
    assert!(balance.reaction_moment.length() <= 1e-8 * 60.0 * balance.largest_reaction.max(1.0));
}

#[test]
fn of_a_wall() {
    let bent = on_corners(&wall(9.0, 6, 0.0), &settings());
    check("clamped", &bent.clamped_balance);
    check("released", &bent.released_balance);
    let bent = on_corners(&wall(9.0, 6, 0.0), &Settings { most_steps: 2, ..settings() });
    check("released, three layers at a time", &bent.released_balance);
    assert!(bent.clamped_balance.clamp_energy > 0.0 && bent.released_balance.clamp_energy == 0.0);
}

#[test]
fn does_not_depend_on_the_tolerance_of_steps() {
    let [rough, fine] =
        [0.05, 1e-10].map(|tolerance| on_corners(&wall(9.0, 6, 0.0), &Settings { tolerance, ..settings() }));
    let difference =
        rough.released.moved.iter().zip(&fine.released.moved).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
    println!(
        "tolerance 0.05 or 1e-10: {difference:.1e} mm apart, {} and {} iterations",
        rough.iterations, fine.iterations
    );
    assert!(difference < 0.02 * fine.released.lift.range);
}

/// Metal that is all there from the beginning forgets the clamps.
#[test]
fn one_step_released_is_one_step_free() {
    let (settings, beads) = (settings(), wall(9.0, 1, 0.0));
    let (held, free) = (on_corners(&beads, &settings), built(&plate(), &beads, &[], &settings));
    for (a, b) in held.released.moved.iter().zip(&free.released.moved) {
        assert!(a.distance(*b) < 1e-7 * free.released.lift.range, "{a} {b}");
    }
    assert!(held.clamped.lift.range < held.released.lift.range);
    // Growth on clamps is another matter: later layers are laid on a plate that is held flat.
    let beads = wall(9.0, 4, 0.0);
    let (held, free) = (on_corners(&beads, &settings), built(&plate(), &beads, &[], &settings));
    println!(
        "four layers: {:.4} mm clamped and released, {:.4} mm free",
        held.released.lift.range, free.released.lift.range
    );
}

/// Softer clamps hold less, and clamps without stiffness nothing.
#[test]
fn soft_clamps() {
    let beads = wall(0.0, 2, 0.0);
    let lift = |k: f64| {
        let clamps = plate().clamped_along_edge(30.0, 5.0, DVec3::splat(k));
        built(&plate(), &beads, &clamps, &settings()).clamped.lift.range
    };
    let free = built(&plate(), &beads, &[], &settings()).clamped.lift.range;
    let lifts = [1e-3, 1e2, 1e4, 1e6].map(lift);
    println!("lift with clamps of 1e-3, 1e2, 1e4, 1e6 N/mm: {lifts:.4?} mm; free {free:.4} mm");
    assert!((lifts[0] / free - 1.0).abs() < 1e-3);
    assert!(lifts.windows(2).all(|pair| pair[1] < pair[0]));
    // A clamp that holds in z only leaves the plate free to slide, which is no fault.
    let clamps = plate().clamped_at_corners(5.0, DVec3::new(0.0, 0.0, 1e5));
    check("held in z only", &built(&plate(), &beads, &clamps, &settings()).clamped_balance);
}
