//! Straight pieces and arcs fitted to lines.

use planar::DVec2;
use planar::arcs::{Arc, Fit};
use std::f64::consts::{FRAC_PI_2, TAU};

const FIT: Fit = Fit { tolerance: 0.05, arcs: true, grid: 1e-3 };

fn round(radius: f64, count: usize, turn: f64) -> Vec<DVec2> {
    (0..=count).map(|i| DVec2::from_angle(turn * i as f64 / count as f64) * radius).collect()
}

#[test]
fn three_points_make_the_arc_through_them() {
    let at = DVec2::new;
    let left = Arc::through(at(1.0, 0.0), DVec2::from_angle(0.7), at(0.0, 1.0)).unwrap();
    assert!(left.centre.length() < 1e-12 && (left.radius - 1.0).abs() < 1e-12);
    assert!((left.sweep - FRAC_PI_2).abs() < 1e-12);
    let right = Arc::through(at(0.0, 1.0), DVec2::from_angle(0.7), at(1.0, 0.0)).unwrap();
    assert!((right.sweep + FRAC_PI_2).abs() < 1e-12);
    // Three quarters of a turn, and a line.
    assert_eq!(Arc::through(at(1.0, 0.0), at(-1.0, 0.0), at(0.0, -1.0)), None);
    assert_eq!(Arc::through(at(0.0, 0.0), at(1.0, 0.0), at(2.0, 0.0)), None);
}

#[test]
fn a_circle_becomes_three_arcs_of_its_radius() {
    for (turn, count) in [(TAU, 90), (-TAU, 90), (TAU, 2000)] {
        let pieces = FIT.pieces(&round(20.0, count, turn));
        assert_eq!(pieces.len(), 3, "{pieces:?}");
        assert_eq!(pieces.last().unwrap().end, count);
        for arc in pieces.iter().map(|p| p.arc.unwrap()) {
            // Chords lie inside the circle; a short arc determines its radius less well than its place.
            let off = (arc.via.length() - 20.0).abs();
            assert!(off < 0.013 && (arc.radius - 20.0).abs() < 0.02 / (1.0 - (arc.sweep / 2.0).cos()), "{arc:?}");
            assert_eq!(arc.sweep > 0.0, turn > 0.0);
        }
    }
}

#[test]
fn corners_stay_and_turning_back_is_kept() {
    let at = DVec2::new;
    let ends = |points: &[DVec2]| FIT.pieces(points).iter().map(|p| (p.end, p.arc.is_some())).collect::<Vec<_>>();
    let square = [at(0.0, 0.0), at(5.0, 0.0), at(10.0, 0.0), at(10.0, 10.0), at(0.0, 10.0), at(0.0, 0.0)];
    assert_eq!(ends(&square), [(2, false), (3, false), (4, false), (5, false)]);
    let back = [at(0.0, 0.0), at(10.0, 0.0), at(4.0, 0.0), at(12.0, 0.0)];
    assert_eq!(ends(&back), [(1, false), (2, false), (3, false)]);
    assert_eq!(ends(&[]), []);
    assert_eq!(ends(&[at(1.0, 1.0)]), []);
}

#[test]
fn without_arcs_a_circle_becomes_chords() {
    let circle = round(20.0, 2000, TAU);
    let pieces = Fit { arcs: false, ..FIT }.pieces(&circle);
    // The sagitta of a chord is the tolerance: 2 acos(1 - 0.05 / 20) each.
    let least = (TAU / (2.0 * (1.0 - FIT.tolerance / 20.0_f64).acos())).ceil() as usize;
    assert!(pieces.len() >= least && pieces.len() <= least + 2, "{} for {least}", pieces.len());
}

#[test]
fn a_wave_is_followed_within_the_tolerance() {
    let wave: Vec<DVec2> =
        (0..4000).map(|i| f64::from(i) * 0.02).map(|x| DVec2::new(x, 6.0 * (x / 5.0).sin())).collect();
    let pieces = FIT.pieces(&wave);
    assert!(pieces.len() < 60, "{}", pieces.len());
    let mut start = 0;
    for piece in pieces {
        if let Some(arc) = piece.arc {
            let off = |p: &DVec2| (p.distance(arc.centre) - arc.radius).abs();
            assert!(wave[start..=piece.end].iter().all(|p| off(p) <= FIT.tolerance + 1e-9));
        }
        start = piece.end;
    }
}
