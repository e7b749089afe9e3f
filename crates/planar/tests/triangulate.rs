//! Triangles fill a polygon with holes exactly.

mod shapes;

use planar::triangulate::triangulate;
use planar::{DVec2, Polygon, Ring};
use proptest::prelude::*;
use shapes::{config, star, three_holes};

fn triangles(polygon: &Polygon) -> Vec<[DVec2; 3]> {
    let points: Vec<DVec2> = polygon.rings().flat_map(|r| r.points()).copied().collect();
    triangulate(polygon).iter().map(|t| t.map(|i| points[i])).collect()
}

fn area(t: &[DVec2; 3]) -> f64 {
    Ring::new(t.to_vec()).area()
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn triangles_fill_the_polygon(region in star()) {
        let polygon = &region.polygons()[0];
        let triangles = triangles(polygon);
        let corners: usize = polygon.rings().map(|r| r.points().len()).sum();
        prop_assert_eq!(triangles.len(), corners + 2 * polygon.holes.len() - 2);
        prop_assert!(triangles.iter().all(|t| area(t) >= 0.0));
        let total: f64 = triangles.iter().map(area).sum();
        prop_assert!((total - polygon.area()).abs() < 1e-9 * polygon.outer.area());
        for t in triangles.iter().filter(|t| area(t) > 1e-6) {
            prop_assert!(polygon.contains((t[0] + t[1] + t[2]) / 3.0));
        }
    }
}

#[test]
fn a_plate_with_three_holes() {
    let plate = three_holes();
    let triangles = triangles(&plate.polygons()[0]);
    // Collinear corners: the number of triangles is not fixed.
    assert!((triangles.iter().map(area).sum::<f64>() - plate.area()).abs() < 1e-9);
}

#[test]
fn nothing_to_fill() {
    assert!(triangulate(&Polygon::default()).is_empty());
}
