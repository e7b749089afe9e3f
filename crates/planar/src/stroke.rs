//! Lines grown to areas.

use crate::Region;
use crate::grid::{GRID_MM, region_from_grid, to_grid};
use crate::offset::{Join, SIMPLIFY_MM};
use glam::DVec2;
use i_overlay::mesh::int::stroke::offset::IntStrokeOffset;
use i_overlay::mesh::int::style::{IntLineCap, IntLineJoin, IntStrokeStyle};
use i_overlay::mesh::math::MathMode;

/// All points within `distance` (mm) of the lines; `closed` joins the last point of each to its first. Corners and ends
/// are round, within [`ARC_TOLERANCE_MM`](crate::offset::ARC_TOLERANCE_MM).
pub fn buffer(lines: &[Vec<DVec2>], closed: bool, distance: f64) -> Region {
    let width = (2.0 * distance / GRID_MM).round() as i32;
    let join = Join::ROUND.to_style(distance);
    let cap = match join {
        IntLineJoin::Round(arc) => IntLineCap::Round(arc),
        IntLineJoin::Bevel | IntLineJoin::Miter(_) => IntLineCap::Butt,
    };
    let style = IntStrokeStyle::new(width).line_join(join).start_cap(cap.clone()).end_cap(cap).math(MathMode::Float);
    let paths: Vec<Vec<_>> = lines.iter().map(|line| line.iter().map(|&p| to_grid(p)).collect()).collect();
    let shapes = paths.stroke(&style, closed).unwrap_or_default();
    region_from_grid(shapes).simplified(SIMPLIFY_MM)
}
