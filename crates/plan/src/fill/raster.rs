//! Parallel scan lines, each a pass of its own, all in one direction.

use super::{Fill, FillSettings, PassKind, Path, Strategy};
use planar::scan::{End, Scan};
use planar::{Polygon, Region};

/// One-way scan lines.
pub struct Raster;

impl Strategy for Raster {
    fn name(&self) -> &'static str {
        "raster"
    }

    fn repeats(&self) -> bool {
        true
    }

    fn fill(&self, island: &Polygon, settings: &FillSettings) -> Fill {
        self.lines(&self.infill(island, settings), settings)
    }

    fn narrowest(&self, settings: &FillSettings) -> f64 {
        settings.bead.width
    }

    fn infill(&self, island: &Polygon, settings: &FillSettings) -> Region {
        settings.outermost(island)
    }

    fn lines(&self, infill: &Region, settings: &FillSettings) -> Fill {
        let scan = Scan::new(infill, settings.raster_angle, settings.spacing());
        let line = |span| {
            let points = [End::Left, End::Right].map(|end| scan.turn_back(scan.end(span, end)));
            Path { reversible: false, ..Path::line(PassKind::Infill, points.to_vec(), settings.bead.width) }
        };
        Fill { stages: vec![(0..scan.spans().len()).map(line).collect()], fixed_order: true }
    }
}
