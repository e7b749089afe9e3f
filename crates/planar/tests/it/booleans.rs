//! Union, difference and intersection: conservation of area, invariance, fill rules, the library Clipper2.

use crate::shapes;

use clipper2_rust::{FillRule as ClipperRule, difference_64, intersect_64, union_64};
use planar::{DVec2, FillRule, Region};
use proptest::prelude::*;
use shapes::{
    box_ring, clipper_area, config, grid_error, plate, same_shapes, star, symmetric_difference, to_clipper, v,
};

fn close(a: f64, b: f64, tolerance: f64) -> Result<(), TestCaseError> {
    prop_assert!((a - b).abs() <= tolerance, "{a} and {b} differ by {:e} > {tolerance:e}", (a - b).abs());
    Ok(())
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn areas_are_conserved(a in star(), b in star()) {
        let tolerance = grid_error(a.perimeter() + b.perimeter());
        let both = a.intersection(&b).area();
        close(a.union(&b).area() + both, a.area() + b.area(), tolerance)?;
        close(a.difference(&b).area() + both, a.area(), tolerance)?;
        close(b.difference(&a).area() + both, b.area(), tolerance)?;
    }

    #[test]
    fn a_point_is_where_the_operands_say(a in star(), b in star(), x in -25.0..25.0, y in -25.0..25.0) {
        let p = v(x, y);
        prop_assume!([&a, &b].iter().all(|r| shapes::distance_to_boundary(r, p) > 1e-3));
        let (in_a, in_b) = (a.contains(p), b.contains(p));
        prop_assert_eq!(a.union(&b).contains(p), in_a || in_b);
        prop_assert_eq!(a.intersection(&b).contains(p), in_a && in_b);
        prop_assert_eq!(a.difference(&b).contains(p), in_a && !in_b);
    }

    #[test]
    fn areas_do_not_depend_on_the_description(a in star(), b in star()) {
        let tolerance = grid_error(a.perimeter() + b.perimeter());
        for (a2, b2) in same_shapes(&a).iter().zip(&same_shapes(&b)) {
            close(a2.area(), a.area(), 1e-9)?;
            close(a2.union(b2).area(), a.union(&b).area(), tolerance)?;
            close(a2.intersection(b2).area(), a.intersection(&b).area(), tolerance)?;
            close(a2.difference(b2).area(), a.difference(&b).area(), tolerance)?;
        }
    }

    #[test]
    fn results_are_wound_as_promised(a in star(), b in star()) {
        for polygon in a.difference(&b).polygons() {
            prop_assert!(polygon.outer.area() > 0.0 && polygon.holes.iter().all(|h| h.area() < 0.0));
        }
    }

    #[test]
    fn clipper_finds_the_same_areas(a in star(), b in star()) {
        let tolerance = grid_error(a.perimeter() + b.perimeter());
        let (pa, pb) = (to_clipper(&a), to_clipper(&b));
        close(a.union(&b).area(), clipper_area(&union_64(&pa, &pb, ClipperRule::NonZero)), tolerance)?;
        close(a.intersection(&b).area(), clipper_area(&intersect_64(&pa, &pb, ClipperRule::NonZero)), tolerance)?;
        close(a.difference(&b).area(), clipper_area(&difference_64(&pa, &pb, ClipperRule::NonZero)), tolerance)?;
    }

    #[test]
    fn a_ten_metre_part_is_not_moved(a in star()) {
        let far = shapes::map_points(&a, |p| p + v(9_970.0, -9_970.0));
        let united = far.union(&far);
        let before: Vec<DVec2> = far.rings().flat_map(|r| r.points()).copied().collect();
        let after: Vec<DVec2> = united.rings().flat_map(|r| r.points()).copied().collect();
        prop_assert_eq!(before.len(), after.len());
        for p in before {
            prop_assert!(after.iter().any(|q| q.distance(p) < 1e-3), "{} has moved", p);
        }
    }

    #[test]
    fn identities(a in star()) {
        let tolerance = grid_error(a.perimeter());
        prop_assert!(symmetric_difference(&a, &a) == 0.0);
        prop_assert!(a.intersection(&Region::EMPTY).is_empty() && Region::EMPTY.difference(&a).is_empty());
        close(a.union(&Region::EMPTY).area(), a.area(), tolerance)?;
        close(a.difference(&Region::EMPTY).area(), a.area(), tolerance)?;
    }
}

#[test]
fn fill_rules_of_nested_squares() {
    let (outer, inner) = (box_ring(v(0.0, 0.0), v(10.0, 10.0)), box_ring(v(4.0, 4.0), v(6.0, 6.0)));
    let area = |clockwise: bool, rule| {
        let inner = if clockwise { inner.clone().reversed() } else { inner.clone() };
        Region::from_rings(&[outer.clone(), inner], rule).area()
    };
    assert_eq!([area(false, FillRule::EvenOdd), area(true, FillRule::EvenOdd)], [96.0, 96.0]);
    assert_eq!([area(false, FillRule::NonZero), area(true, FillRule::NonZero)], [100.0, 96.0]);
    assert_eq!([area(false, FillRule::Positive), area(true, FillRule::Positive)], [100.0, 96.0]);
    assert!(Region::from_rings(&[outer.reversed()], FillRule::Positive).is_empty());
}

#[test]
fn measures_of_a_plate() {
    let plate = plate(10.0, 6.0, &[(v(1.0, 1.0), v(3.0, 2.0)), (v(5.0, 1.0), v(8.0, 4.0))]);
    assert_eq!((plate.area(), plate.perimeter(), plate.euler()), (60.0 - 2.0 - 9.0, 32.0 + 6.0 + 12.0, -1));
    let bounds = plate.bounds().unwrap();
    assert_eq!((bounds.size(), bounds.center()), (v(10.0, 6.0), v(5.0, 3.0)));
    assert!(plate.contains(v(4.0, 1.5)) && !plate.contains(v(2.0, 1.5)) && !plate.contains(v(11.0, 1.5)));
    assert_eq!(Region::EMPTY.bounds(), None);
}

#[test]
fn squares_that_share_an_edge_become_one() {
    let left = plate(5.0, 5.0, &[]);
    let right = shapes::map_points(&left, |p| p + v(5.0, 0.0));
    let both = left.union(&right);
    assert_eq!((both.area(), both.perimeter(), both.polygons().len()), (50.0, 30.0, 1));
    assert!(left.intersection(&right).is_empty());
}
