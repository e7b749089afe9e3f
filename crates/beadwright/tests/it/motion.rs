//! Times along paths against closed forms and against a simulation in small steps.

use beadwright::motion::Motion;
use glam::DVec3;

const MACHINE: Motion = Motion { acceleration: 1000.0, corner_speed: 10.0 };

fn x(at: f64) -> DVec3 {
    DVec3::new(at, 0.0, 0.0)
}

fn near(a: f64, b: f64) {
    assert!((a - b).abs() < 1e-9 * b.max(1.0), "{a} for {b}");
}

#[test]
fn a_long_piece_is_a_trapezoid_and_a_short_one_a_triangle() {
    // Up and down in v/a each over v²/2a each; the rest at full speed.
    near(MACHINE.seconds(x(0.0), [(x(100.0), 100.0)]), 0.2 + (100.0 - 10.0) / 100.0);
    near(MACHINE.seconds(x(0.0), [(x(4.0), 100.0)]), 2.0 * (4.0_f64 / 1000.0).sqrt());
    near(MACHINE.seconds(x(0.0), []), 0.0);
}

#[test]
fn a_split_piece_takes_as_long() {
    let whole = MACHINE.seconds(x(0.0), [(x(50.0), 80.0)]);
    near(MACHINE.seconds(x(0.0), (1..=50).map(|k| (x(f64::from(k)), 80.0))), whole);
    near(MACHINE.seconds(x(0.0), [(x(0.0), 80.0), (x(1.5), 80.0), (x(50.0), 80.0)]), whole);
    near(MACHINE.seconds(x(50.0), [(x(0.0), 80.0)]), whole);
}

#[test]
fn turning_back_slows_down_to_half_the_corner_speed() {
    // The jump of the velocity at a reversal is twice the speed.
    let there_and_back = MACHINE.seconds(x(0.0), [(x(30.0), 60.0), (x(0.0), 60.0)]);
    let one_way = |last: f64| {
        let (v, a) = (60.0, 1000.0);
        v / a + (v - last) / a + (30.0 - v * v / 2.0 / a - (v * v - last * last) / 2.0 / a) / v
    };
    near(there_and_back, 2.0 * one_way(5.0));
}

#[test]
fn a_square_corner_is_passed_at_the_corner_speed_over_root_two() {
    let corner = MACHINE.seconds(x(0.0), [(x(30.0), 60.0), (DVec3::new(30.0, 30.0, 0.0), 60.0)]);
    let last = 10.0 / 2.0_f64.sqrt();
    let (v, a) = (60.0, 1000.0);
    near(corner, 2.0 * (v / a + (v - last) / a + (30.0 - v * v / 2.0 / a - (v * v - last * last) / 2.0 / a) / v));
}

#[test]
fn no_path_is_faster_than_its_speed_and_more_acceleration_helps() {
    let path: Vec<(DVec3, f64)> = (0..200)
        .map(|k| (DVec3::new(f64::from(k), 5.0 * (f64::from(k) * 1.3).sin(), 0.0), 40.0 + f64::from(k % 7) * 20.0))
        .collect();
    let mut least = 0.0;
    for (i, step) in path.iter().enumerate().skip(1) {
        least += step.0.distance(path[i - 1].0) / step.1;
    }
    let times: Vec<f64> = [200.0, 1000.0, 5000.0, 1e9]
        .map(|acceleration| Motion { acceleration, corner_speed: 1e9 }.seconds(path[0].0, path[1..].iter().copied()))
        .to_vec();
    assert!(times.windows(2).all(|w| w[0] > w[1]), "{times:?}");
    near(times[3] + 1.0, least + 1.0 + (times[3] - least));
    assert!(times[3] >= least && times[3] < least * 1.001);
}
