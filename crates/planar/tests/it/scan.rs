//! Scan lines: spans in closed form, area by summation, chains that never leave the boundary.

use crate::shapes;

use planar::scan::{End, Scan, Spacing, count_and_length};
use planar::{DVec2, Region};
use proptest::prelude::*;
use shapes::{config, distance_to_boundary, map_points, plate, star, three_holes, v};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Regions to scan: loose stars united, or the plate with three holes turned.
fn region() -> impl Strategy<Value = Region> {
    let stars = (star(), star()).prop_map(|(a, b)| a.union(&b));
    let turned = (0.0..TAU).prop_map(|angle| map_points(&three_holes(), |p| DVec2::from_angle(angle).rotate(p)));
    prop_oneof![stars, turned]
}

fn spacing() -> impl Strategy<Value = Spacing> {
    prop_oneof![(0.3..4.0).prop_map(Spacing::AtMost), (0.3..4.0).prop_map(Spacing::Exact)]
}

fn lengths(scan: &Scan) -> Vec<f64> {
    (0..scan.spans().len()).map(|i| scan.length(i)).collect()
}

/// Extent across lines at `angle`.
fn extent(region: &Region, angle: f64) -> f64 {
    let across = DVec2::from_angle(angle).perp();
    let heights = || region.rings().flat_map(|r| r.points()).map(|p| p.dot(across));
    heights().fold(f64::NEG_INFINITY, f64::max) - heights().fold(f64::INFINITY, f64::min)
}

/// Spans lie in the region and end on its boundary.
fn check_spans(region: &Region, angle: f64, spacing: Spacing) -> Result<(), TestCaseError> {
    let scan = Scan::new(region, angle, spacing);
    for i in 0..scan.spans().len() {
        let (a, b) = (scan.turn_back(scan.end(i, End::Left)), scan.turn_back(scan.end(i, End::Right)));
        prop_assert!(distance_to_boundary(region, a) < 1e-9 && distance_to_boundary(region, b) < 1e-9);
        for t in [0.01, 0.3, 0.5, 0.77, 0.99] {
            let p = a.lerp(b, t);
            prop_assert!(region.contains(p) || distance_to_boundary(region, p) < 1e-9);
        }
    }
    Ok(())
}

/// Chains lead along the boundary to the next line and no farther, no two of them to the same end.
fn check_chains(region: &Region, angle: f64, spacing: Spacing) -> Result<(), TestCaseError> {
    let scan = Scan::new(region, angle, spacing);
    let vertices: Vec<DVec2> = region.rings().flat_map(|r| r.points()).copied().collect();
    for end in [End::Left, End::Right] {
        let mut reached = Vec::new();
        for i in 0..scan.spans().len() {
            let Some(chain) = scan.chain_up(i, end) else { continue };
            prop_assert_eq!(scan.spans()[chain.to].line, scan.spans()[i].line + 1);
            reached.push(chain.to);
            let (from, to) = (scan.end(i, end), scan.end(chain.to, end));
            for via in &chain.via {
                let vertex = scan.turn_back(*via);
                prop_assert!(vertices.iter().any(|p| p.distance(vertex) < 1e-9), "{vertex} is no vertex");
                prop_assert!(from.y <= via.y && via.y <= to.y, "{via} leaves the strip");
            }
            let path: Vec<DVec2> = [from].into_iter().chain(chain.via).chain([to]).collect();
            for w in path.windows(2) {
                let middle = scan.turn_back(w[0].midpoint(w[1]));
                prop_assert!(distance_to_boundary(region, middle) < 1e-9, "{middle} is off the boundary");
            }
        }
        let count = reached.len();
        reached.sort_unstable();
        reached.dedup();
        prop_assert_eq!(reached.len(), count, "two chains reach the same span");
    }
    Ok(())
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn lengths_add_up_to_the_area(region in region(), angle in 0.0..TAU) {
        let extent = extent(&region, angle);
        for gaps in [20.0, 100.0, 1000.0] {
            let step = extent / gaps;
            let scan = Scan::new(&region, angle, Spacing::AtMost(step));
            let sum: f64 = lengths(&scan).iter().sum::<f64>() * step;
            // A sum of steps misses an integral by at most the step times the total variation of the length,
            // and each edge varies the length by no more than its own.
            prop_assert!((sum - region.area()).abs() <= step * region.perimeter(), "{sum} {}", region.area());
        }
    }

    #[test]
    fn lines_are_level_ordered_and_evenly_spaced(region in region(), angle in 0.0..TAU, spacing in spacing()) {
        let scan = Scan::new(&region, angle, spacing);
        let extent = extent(&region, angle);
        let (gaps, step) = match spacing {
            Spacing::AtMost(d) => ((extent / d).ceil(), extent / (extent / d).ceil()),
            Spacing::Exact(d) => ((extent / d).floor(), d),
        };
        let first = scan.end(0, End::Left).y;
        prop_assert_eq!(scan.spans()[0].line, 0);
        for (i, span) in scan.spans().iter().enumerate() {
            let (left, right) = (scan.end(i, End::Left), scan.end(i, End::Right));
            prop_assert!(left.y == right.y && left.x <= right.x && scan.length(i) == right.x - left.x);
            // First and last line lie half a micrometre off the edge.
            prop_assert!((left.y - first - span.line as f64 * step).abs() < 1.1e-3, "line {} at {}", span.line, left.y);
            if let Some(next) = scan.spans().get(i + 1) {
                let same = span.line == next.line && right.x <= scan.end(i + 1, End::Left).x;
                prop_assert!(same || span.line < next.line);
            }
        }
        prop_assert_eq!(scan.spans().last().unwrap().line, gaps as usize);
    }

    #[test]
    fn count_and_length_are_those_of_the_spans(region in region(), angle in 0.0..TAU, spacing in spacing()) {
        let spans = lengths(&Scan::new(&region, angle, spacing));
        let (count, length) = count_and_length(&region, angle, spacing);
        prop_assert_eq!(count, spans.len());
        prop_assert!((length - spans.iter().sum::<f64>()).abs() < 1e-9 * (1.0 + length));
    }

    #[test]
    fn spans_lie_inside_and_end_on_the_boundary(region in region(), angle in 0.0..TAU, spacing in spacing()) {
        check_spans(&region, angle, spacing)?;
    }

    #[test]
    fn chains_follow_the_boundary_between_two_lines(region in region(), angle in 0.0..TAU, spacing in spacing()) {
        check_chains(&region, angle, spacing)?;
    }

    #[test]
    fn turning_region_and_angle_together_changes_nothing(region in region(), angle in 0.0..TAU, turn in 0.0..TAU,
                                                         spacing in spacing()) {
        let turned = map_points(&region, |p| DVec2::from_angle(turn).rotate(p));
        let (a, b) = (Scan::new(&region, angle, spacing), Scan::new(&turned, angle + turn, spacing));
        let (a, b) = (lengths(&a), lengths(&b));
        prop_assert_eq!(a.len(), b.len());
        prop_assert!(a.iter().zip(&b).all(|(a, b)| (a - b).abs() < 1e-6));
    }

    #[test]
    fn opposite_angle_gives_the_same_lines_upside_down(region in region(), angle in 0.0..PI, d in 0.3..4.0) {
        let a = Scan::new(&region, angle, Spacing::AtMost(d));
        let b = Scan::new(&region, angle + PI, Spacing::AtMost(d));
        let (a, mut b) = (lengths(&a), lengths(&b));
        b.reverse();
        prop_assert_eq!(a.len(), b.len());
        prop_assert!(a.iter().zip(&b).all(|(a, b)| (a - b).abs() < 1e-6));
    }

    #[test]
    fn convex_lines_are_chained_one_to_the_next(region in shapes::convex(), angle in 0.0..TAU, d in 0.3..4.0) {
        let scan = Scan::new(&region, angle, Spacing::AtMost(d));
        let count = scan.spans().len();
        for i in 0..count {
            for end in [End::Left, End::Right] {
                prop_assert_eq!(scan.chain_up(i, end).map(|c| c.to), (i + 1 < count).then_some(i + 1));
            }
        }
    }
}

#[test]
fn spans_of_a_rectangle() {
    let rect = plate(30.0, 10.0, &[]);
    let count = |angle, spacing| lengths(&Scan::new(&rect, angle, spacing)).len();
    for (spacing, along_x, along_y) in [
        (Spacing::AtMost(2.5), 5, 13),
        (Spacing::AtMost(3.0), 5, 11),
        (Spacing::Exact(2.5), 5, 13),
        (Spacing::Exact(3.0), 4, 11),
        (Spacing::AtMost(25.0), 1, 3),
        (Spacing::Exact(25.0), 1, 2),
    ] {
        assert_eq!((count(0.0, spacing), count(FRAC_PI_2, spacing)), (along_x, along_y), "{spacing:?}");
        let all =
            |angle, length: f64| lengths(&Scan::new(&rect, angle, spacing)).iter().all(|l| (l - length).abs() < 1e-9);
        assert!(all(0.0, 30.0) && all(FRAC_PI_2, 10.0) && all(PI, 30.0));
    }
    let middle = Scan::new(&rect, 0.0, Spacing::AtMost(25.0));
    assert_eq!((middle.end(0, End::Left), middle.end(0, End::Right)), (v(0.0, 5.0), v(30.0, 5.0)));
}

#[test]
fn diagonal_spans_of_a_square() {
    // At height t above the lowest corner of a square on its tip, the width is 2t up to the middle.
    let square = plate(10.0, 10.0, &[]);
    let scan = Scan::new(&square, PI / 4.0, Spacing::AtMost(1.0));
    let half = 50.0_f64.sqrt();
    for (i, length) in lengths(&scan).into_iter().enumerate() {
        let height = scan.end(i, End::Left).y;
        assert!((length - 2.0 * (half - height.abs())).abs() < 1e-9);
    }
    assert_eq!(scan.spans().len(), 16);
}

#[test]
fn holes_split_spans_and_chains_run_round_them() {
    // A hole from x = 10 to 20 and y = 4 to 6; of the lines at 0, 2.5, 5 and 7.5 it splits the third.
    let plate = plate(30.0, 9.0, &[(v(10.0, 4.0), v(20.0, 6.0))]);
    let scan = Scan::new(&plate, 0.0, Spacing::Exact(2.5));
    let per_line: Vec<usize> = scan.spans().iter().map(|s| s.line).collect();
    assert_eq!(per_line, [0, 1, 2, 2, 3]);
    let to = |span, end| scan.chain_up(span, end).map(|c| c.to);
    assert_eq!((to(1, End::Left), to(1, End::Right)), (Some(2), Some(3)));
    assert_eq!((to(2, End::Left), to(2, End::Right)), (Some(4), None));
    assert_eq!((to(3, End::Left), to(3, End::Right)), (None, Some(4)));
    assert_eq!(End::Left.other(), End::Right);
}

#[test]
fn lines_may_run_through_vertices_and_along_edges() {
    for spacing in [Spacing::Exact(1.0), Spacing::Exact(2.5), Spacing::AtMost(5.0)] {
        for angle in [0.0, FRAC_PI_2, PI, -FRAC_PI_2, PI / 4.0] {
            check_spans(&three_holes(), angle, spacing).unwrap();
            check_chains(&three_holes(), angle, spacing).unwrap();
        }
    }
}

#[test]
fn a_chain_names_the_vertices_it_turns_at() {
    let hexagon = [v(0.0, 0.0), v(10.0, 0.0), v(13.0, 5.0), v(10.0, 10.0), v(0.0, 10.0), v(-3.0, 5.0)];
    let hexagon = Region::from(planar::Polygon::simple(planar::Ring::new(hexagon.to_vec())));
    let scan = Scan::new(&hexagon, 0.0, Spacing::AtMost(10.0));
    assert_eq!(scan.chain_up(0, End::Left).unwrap().via, [v(-3.0, 5.0)]);
    assert_eq!(scan.chain_up(0, End::Right).unwrap().via, [v(13.0, 5.0)]);
    assert_eq!(scan.chain_up(1, End::Left), None);
}

#[test]
fn an_empty_region_has_no_spans() {
    assert!(Scan::new(&Region::EMPTY, 0.3, Spacing::AtMost(1.0)).spans().is_empty());
}

/// A block with a step: lines run along the step, whatever its height, and along the outer edges.
#[test]
fn fitted_lines_run_along_long_edges() {
    let spacing = 3.0;
    for step in [7.3, 11.0, 16.45] {
        for angle in [0.0, 0.7, FRAC_PI_2] {
            let corners = [(0.0, 0.0), (60.0, 0.0), (60.0, step), (30.0, step), (30.0, 25.0), (0.0, 25.0)];
            let way = DVec2::from_angle(angle);
            let points = corners.map(|p| way.rotate(DVec2::from(p))).to_vec();
            let region = Region::from_rings(&[planar::Ring::new(points)], planar::FillRule::NonZero);
            let scan = Scan::fitted(&region, angle, spacing);
            let lines: Vec<f64> = (0..scan.spans().len()).map(|i| scan.end(i, End::Left).y).collect();
            for edge in [0.0, step, 25.0] {
                assert!(lines.iter().any(|y| (y - edge).abs() < 1e-2), "step {step}, angle {angle}: no line at {edge}");
            }
            let gaps: Vec<f64> = lines.windows(2).map(|w| w[1] - w[0]).collect();
            assert!(gaps.iter().all(|gap| (0.5 * spacing..=1.25 * spacing + 1e-2).contains(gap)), "{gaps:?}");
            // The step's own line is as long as the whole block.
            let on_step = (0..lines.len()).find(|&i| (lines[i] - step).abs() < 1e-2).unwrap();
            assert!((scan.length(on_step) - 60.0).abs() < 0.1);
        }
    }
}
