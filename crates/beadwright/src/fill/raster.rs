//! Parallel scan lines, each a pass of its own, all in one direction.

use super::{Fill, FillSettings, Pass, Strategy};
use planar::Polygon;
use planar::scan::{End, Scan};

/// One-way scan lines.
pub struct Raster;

impl Strategy for Raster {
    fn name(&self) -> &'static str {
        "raster"
    }

    fn fill(&self, island: &Polygon, settings: &FillSettings) -> Fill {
        let scan = Scan::new(&settings.outermost(island), settings.raster_angle, settings.spacing());
        let line = |span| {
            let points = [End::Left, End::Right].map(|end| scan.turn_back(scan.end(span, end)));
            Pass::infill(points.to_vec(), false)
        };
        Fill { stages: vec![(0..scan.spans().len()).map(line).collect()], fixed_order: true }
    }
}
