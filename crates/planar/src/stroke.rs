//! Lines grown to areas.

use crate::Region;
use crate::grid::{GRID_MM, region_from_grid, to_grid};
use crate::offset::{Join, SIMPLIFY_MM};
use crate::polyline::simplify;
use glam::DVec2;
use i_overlay::mesh::int::stroke::offset::IntStrokeOffset;
use i_overlay::mesh::int::style::{IntLineCap, IntLineJoin, IntStrokeStyle};
use i_overlay::mesh::math::MathMode;

/// All points within `distance` (mm) of the lines; `closed` joins the last point of each to its first. Corners and ends
/// are round, and the result is accurate to `tolerance` (mm).
///
/// ```
/// use planar::{DVec2, buffer};
/// use std::f64::consts::PI;
///
/// // A line becomes a rectangle with half a disc at each end.
/// let line = vec![DVec2::ZERO, DVec2::new(30.0, 40.0)];
/// let expected = 50.0 * 8.0 + PI * 16.0;
/// assert!((buffer(&[line], false, 4.0, 0.001).area() / expected - 1.0).abs() < 1e-3);
/// ```
pub fn buffer(lines: &[Vec<DVec2>], closed: bool, distance: f64, tolerance: f64) -> Region {
    let width = (2.0 * distance / GRID_MM).round() as i32;
    let join = Join::Round(tolerance / 2.0).to_style(distance);
    let cap = match join {
        IntLineJoin::Round(arc) => IntLineCap::Round(arc),
        IntLineJoin::Bevel | IntLineJoin::Miter(_) => IntLineCap::Butt,
    };
    let style = IntStrokeStyle::new(width).line_join(join).start_cap(cap.clone()).end_cap(cap).math(MathMode::Float);
    let path = |line: &Vec<DVec2>| simplify(line, tolerance / 2.0).into_iter().map(to_grid).collect();
    let paths: Vec<Vec<_>> = lines.iter().map(path).collect();
    region_from_grid(paths.stroke(&style, closed).unwrap_or_default()).simplified(SIMPLIFY_MM)
}
