//! Lines grown to areas, against closed forms.

use glam::DVec2;
use planar::buffer;
use std::f64::consts::PI;

#[test]
fn a_line_becomes_a_capsule_and_a_ring_a_band() {
    let line = vec![DVec2::new(3.0, -2.0), DVec2::new(43.0, 28.0)];
    let area = buffer(&[line], false, 4.0, 0.001).area();
    let expected = 50.0 * 8.0 + PI * 16.0;
    assert!((area / expected - 1.0).abs() < 1e-3, "{area} {expected}");
    let square = vec![DVec2::ZERO, DVec2::new(40.0, 0.0), DVec2::new(40.0, 40.0), DVec2::new(0.0, 40.0)];
    let band = buffer(&[square], true, 2.0, 0.001);
    // Outside round corners, inside square ones.
    let expected = 44.0 * 44.0 - (16.0 - PI * 4.0) - 36.0 * 36.0;
    assert!((band.area() / expected - 1.0).abs() < 1e-3, "{} {expected}", band.area());
    assert_eq!((band.polygons().len(), band.polygons()[0].holes.len()), (1, 1));
}

#[test]
fn crossing_lines_unite() {
    let lines =
        [vec![DVec2::new(-20.0, 0.0), DVec2::new(20.0, 0.0)], vec![DVec2::new(0.0, -20.0), DVec2::new(0.0, 20.0)]];
    let cross = buffer(&lines, false, 3.0, 0.001);
    let expected = 2.0 * (40.0 * 6.0 + PI * 9.0) - 36.0;
    assert_eq!(cross.polygons().len(), 1);
    assert!((cross.area() / expected - 1.0).abs() < 1e-3);
}
