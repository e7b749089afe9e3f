//! Ladders of shapes whose medial axis is known.

use glam::DVec2;
use planar::ladder::{Ladder, ladders};
use planar::{Polygon, Region, Ring};
use proptest::prelude::*;

fn region(points: &[(f64, f64)]) -> Region {
    Polygon::simple(Ring::new(points.iter().map(|&p| p.into()).collect())).into()
}

/// Cuts every edge so that no sample of both sides falls together by chance.
fn of(points: &[(f64, f64)], spacing: f64) -> Vec<Ladder> {
    ladders(&region(points), spacing)
}

#[test]
fn a_strip_is_one_ladder_in_its_middle() {
    let found = of(&[(0.0, 0.0), (40.0, 0.0), (40.0, 4.0), (0.0, 4.0)], 0.7);
    assert_eq!(found.len(), 1);
    let ladder = &found[0];
    assert_eq!(ladder.free, [true, true]);
    for rung in &ladder.rungs {
        assert!((rung.thickness - 4.0).abs() < 0.3, "{rung:?}");
        assert!((rung.middle().y - 2.0).abs() < 1e-9 || !(4.0..36.0).contains(&rung.middle().x));
    }
    assert!((30.0..40.0).contains(&ladder.length()), "{}", ladder.length());
}

#[test]
fn crosses_and_tees_have_a_ladder_an_arm() {
    let tee = of(
        &[(0.0, 0.0), (60.0, 0.0), (60.0, 4.0), (32.0, 4.0), (32.0, 30.0), (28.0, 30.0), (28.0, 4.0), (0.0, 4.0)],
        0.8,
    );
    assert_eq!(tee.len(), 3);
    assert!(tee.iter().all(|l| l.free.iter().filter(|f| **f).count() == 1));
    let a = 18.0;
    let b = 2.0;
    let cross = of(
        &[(-a, -b), (-b, -b), (-b, -a), (b, -a), (b, -b), (a, -b), (a, b), (b, b), (b, a), (-b, a), (-b, b), (-a, b)],
        0.5,
    );
    assert_eq!(cross.iter().filter(|l| l.free.contains(&true)).count(), 4, "{}", cross.len());
}

#[test]
fn a_ring_is_a_loop_of_its_thickness() {
    let circle = |r: f64, n: usize| -> Ring {
        Ring::new((0..n).map(|k| DVec2::from_angle(k as f64 / n as f64 * std::f64::consts::TAU) * r).collect())
    };
    let polygon = Polygon { outer: circle(20.0, 400), holes: vec![circle(17.0, 340).reversed()] };
    let found = ladders(&polygon.into(), 0.3);
    assert_eq!(found.len(), 1);
    assert!(found[0].closed);
    for rung in &found[0].rungs {
        assert!((rung.thickness - 3.0).abs() < 0.02, "{}", rung.thickness);
        assert!((rung.middle().length() - 18.5).abs() < 0.05);
    }
    let length = found[0].length() + found[0].rungs[0].middle().distance(found[0].rungs.last().unwrap().middle());
    assert!((length / (18.5 * std::f64::consts::TAU) - 1.0).abs() < 2e-3);
}

#[test]
fn a_wedge_shows_its_thickness() {
    // Thickness 1 at x = 0 and 5 at x = 40.
    let found = of(&[(0.0, -0.5), (40.0, -2.5), (40.0, 2.5), (0.0, 0.5)], 0.4);
    assert_eq!(found.len(), 1);
    for rung in &found[0].rungs {
        let m = rung.middle();
        if (2.0..36.0).contains(&m.x) {
            let expected = (1.0 + m.x / 10.0) * 0.9987;
            assert!(m.y.abs() < 0.05 && (rung.thickness - expected).abs() < 0.05, "{m} {} {expected}", rung.thickness);
        }
    }
}

proptest! {
    /// Every rung stands on the boundary and lies inside; whatever the shape, nothing fails.
    #[test]
    fn rungs_end_on_the_boundary(radii in prop::collection::vec(3.0..20.0_f64, 5..40)) {
        let n = radii.len() as f64;
        let points = radii.iter().enumerate().map(|(k, r)| DVec2::from_angle(k as f64 / n * std::f64::consts::TAU) * *r);
        let polygon = Polygon::simple(Ring::new(points.collect()));
        let boundary = |p: DVec2| {
            let edges = polygon.outer.edges();
            edges.map(|(a, b)| planar::polyline::distance_squared_to_segment(p, a, b)).fold(f64::INFINITY, f64::min)
        };
        for ladder in ladders(&polygon.clone().into(), 1.0) {
            for rung in &ladder.rungs {
                prop_assert!(boundary(rung.left) < 1e-12 && boundary(rung.right) < 1e-12);
                prop_assert!(polygon.contains(rung.middle()) || boundary(rung.middle()) < 1e-9);
            }
        }
    }
}
