//! The number of ends of scan lines over the angle, against scan lines laid at that angle.

use planar::scan::Spacing;
use planar::turns::{Turns, ends_at};
use planar::{DVec2, FillRule, Region, Ring};
use std::f64::consts::{PI, TAU};

fn ring(n: usize, middle: (f64, f64), radius: impl Fn(usize) -> f64) -> Ring {
    Ring::new((0..n).map(|k| DVec2::from(middle) + DVec2::from_angle(TAU * k as f64 / n as f64) * radius(k)).collect())
}

fn region(rings: Vec<Ring>) -> Region {
    Region::from_rings(&rings, FillRule::EvenOdd)
}

fn shapes() -> Vec<Region> {
    let rectangle = || Ring::new([(0.0, 0.0), (100.0, 0.0), (100.0, 50.0), (0.0, 50.0)].map(DVec2::from).to_vec());
    let holes = (0..8).map(|k| ring(24, (12.0 + 11.0 * f64::from(k), 20.0 + f64::from(k % 3) * 6.0), |_| 4.0));
    vec![
        region(vec![rectangle()]),
        region([rectangle()].into_iter().chain(holes).collect()),
        region(vec![ring(10, (3.0, -7.0), |k| if k % 2 == 0 { 40.0 } else { 15.0 })]),
        region(vec![ring(60, (0.0, 0.0), |k| 30.0 + 4.0 * (k as f64 * 1.7).sin()), ring(7, (2.0, 1.0), |_| 9.0)]),
        region(vec![ring(5, (0.0, 0.0), |_| 12.0), ring(4, (60.0, 10.0), |_| 8.0), ring(3, (20.0, 50.0), |_| 20.0)]),
    ]
}

#[test]
fn counts_as_many_ends_as_scan_lines_have() {
    for (s, shape) in shapes().iter().enumerate() {
        for spacing in [Spacing::AtMost(0.9), Spacing::Exact(0.9), Spacing::AtMost(3.7), Spacing::Exact(3.7)] {
            let turns = Turns::new(shape, spacing);
            let mut wrong = 0;
            for k in 0..2000 {
                let angle = PI * (f64::from(k) + 0.377) / 2000.0;
                wrong += usize::from(turns.at(angle) != ends_at(shape, angle, spacing));
            }
            // Lines at the edges are moved off them by half a micrometre, so counts may differ next to a step.
            assert!(wrong <= 4, "shape {s}, {spacing:?}: {wrong} of 2000 angles");
        }
    }
}

#[test]
fn a_rectangle_has_fewest_ends_along_its_long_side() {
    let shape = &shapes()[0];
    let (angle, count) = Turns::new(shape, Spacing::AtMost(0.4)).least().unwrap();
    assert!(angle.min(PI - angle) < 0.02, "{angle}");
    assert!((252..=254).contains(&count), "{count}");
    assert_eq!(ends_at(shape, 0.0, Spacing::AtMost(0.4)), 252);
}

#[test]
fn turning_the_part_turns_the_answer() {
    let shape = &shapes()[1];
    let turn = DVec2::from_angle(0.7);
    let turned =
        region(shape.rings().map(|r| Ring::new(r.points().iter().map(|p| turn.rotate(*p)).collect())).collect());
    let (a, b) = (Turns::new(shape, Spacing::AtMost(0.8)), Turns::new(&turned, Spacing::AtMost(0.8)));
    let same = (0..500).filter(|k| a.at(f64::from(*k) * 0.006 + 0.001) == b.at(f64::from(*k) * 0.006 + 0.701)).count();
    assert!(same >= 497, "{same}");
    let again = b.turned(0.7);
    let same =
        (0..500).filter(|k| again.at(f64::from(*k) * 0.006 + 0.001) == a.at(f64::from(*k) * 0.006 + 0.001)).count();
    assert!(same >= 497, "{same}");
    assert_eq!(a.plus(&a).least().unwrap().1, 2 * a.least().unwrap().1);
    assert_eq!(a.edges()[0].0, 0.0);
}
