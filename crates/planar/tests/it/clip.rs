//! Open lines cut by a region: closed forms, conservation of length, an oracle that sorts crossings.

use crate::shapes;

use planar::clip::Keep;
use planar::polyline::length;
use planar::{DVec2, Region, Ring};
use proptest::prelude::*;
use shapes::{config, distance_to_boundary, plate, star, v};

fn total(pieces: &[Vec<DVec2>]) -> f64 {
    pieces.iter().map(|piece| length(piece)).sum()
}

/// Length of the segment inside the region: cut at every edge, each part judged by its middle.
fn length_inside(region: &Region, a: DVec2, b: DVec2) -> f64 {
    let cut = |(c, d): (DVec2, DVec2)| {
        let cross = (b - a).perp_dot(d - c);
        let (t, u) = ((c - a).perp_dot(d - c) / cross, (c - a).perp_dot(b - a) / cross);
        ((0.0..=1.0).contains(&t) && (0.0..=1.0).contains(&u)).then_some(t)
    };
    let mut cuts: Vec<f64> = region.rings().flat_map(Ring::edges).filter_map(cut).chain([0.0, 1.0]).collect();
    cuts.sort_by(f64::total_cmp);
    let inside = |w: &&[f64]| region.contains(a.lerp(b, (w[0] + w[1]) / 2.0));
    cuts.windows(2).filter(inside).map(|w| (w[1] - w[0]) * a.distance(b)).sum()
}

fn line() -> impl Strategy<Value = Vec<DVec2>> {
    prop::collection::vec((-30.0..30.0, -30.0..30.0).prop_map(|(x, y)| v(x, y)), 2..8)
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn inside_and_outside_add_up(region in star(), line in line()) {
        let (inside, outside) = (region.clip_line(&line, Keep::Inside), region.clip_line(&line, Keep::Outside));
        let pieces = (inside.len() + outside.len() + line.len()) as f64;
        let tolerance = 4.0 * planar::GRID_MM * pieces;
        let expected: f64 = line.windows(2).map(|w| length_inside(&region, w[0], w[1])).sum();
        prop_assert!((total(&inside) + total(&outside) - length(&line)).abs() < tolerance);
        // A crossing at a sharp angle moves along the line by more than the grid.
        prop_assert!((total(&inside) - expected).abs() < 0.01, "{} inside, not {expected}", total(&inside));
    }

    #[test]
    fn pieces_lie_on_their_side(region in star(), line in line()) {
        for (keep, side) in [(Keep::Inside, true), (Keep::Outside, false)] {
            for w in region.clip_line(&line, keep).iter().flat_map(|piece| piece.windows(2)) {
                let middle = w[0].midpoint(w[1]);
                prop_assert!(region.contains(middle) == side || distance_to_boundary(&region, middle) < 1e-3);
            }
        }
    }

    #[test]
    fn pieces_run_along_the_line(region in star(), a in (-30.0..30.0, -30.0..30.0), b in (-30.0..30.0, -30.0..30.0)) {
        let (a, b) = (v(a.0, a.1), v(b.0, b.1));
        prop_assume!(a.distance(b) > 1.0);
        for keep in [Keep::Inside, Keep::Outside] {
            for piece in region.clip_line(&[a, b], keep) {
                prop_assert!(piece.windows(2).all(|w| (w[1] - w[0]).dot(b - a) > 0.0), "{:?}", piece);
            }
        }
    }
}

#[test]
fn across_a_square_with_a_hole() {
    let square = plate(10.0, 10.0, &[(v(4.0, 4.0), v(6.0, 6.0))]);
    let line = [v(12.0, 5.0), v(-3.0, 5.0)];
    let sorted = |keep| {
        let mut pieces = square.clip_line(&line, keep);
        pieces.sort_by(|a, b| b[0].x.total_cmp(&a[0].x));
        pieces
    };
    let expect = |ends: &[(f64, f64)]| ends.iter().map(|&(a, b)| vec![v(a, 5.0), v(b, 5.0)]).collect::<Vec<_>>();
    assert_eq!(sorted(Keep::Inside), expect(&[(10.0, 6.0), (4.0, 0.0)]));
    assert_eq!(sorted(Keep::Outside), expect(&[(12.0, 10.0), (6.0, 4.0), (0.0, -3.0)]));
}

#[test]
fn the_boundary_belongs_to_the_inside() {
    let square = plate(10.0, 10.0, &[]);
    let along = [v(-5.0, 0.0), v(15.0, 0.0)];
    assert_eq!(total(&square.clip_line(&along, Keep::Inside)), 10.0);
    assert_eq!(total(&square.clip_line(&along, Keep::Outside)), 10.0);
}

#[test]
fn a_bent_line_inside_stays_in_one_piece() {
    let line = vec![v(1.0, 1.0), v(9.0, 1.0), v(9.0, 9.0), v(2.0, 4.0)];
    assert_eq!(plate(10.0, 10.0, &[]).clip_line(&line, Keep::Inside), [line]);
}

#[test]
fn nothing_inside_an_empty_region() {
    let line = [v(0.0, 0.0), v(1.0, 2.0)];
    assert!(Region::EMPTY.clip_line(&line, Keep::Inside).is_empty());
    assert_eq!(total(&Region::EMPTY.clip_line(&line, Keep::Outside)), length(&line));
}
