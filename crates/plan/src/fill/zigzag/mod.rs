//! Scan lines joined into paths where the boundary leads from the end of one to the same end of the next
//! (Liu et al. 2022, eqs 11–13). Consecutive, directly joined lines are one sub-region; sub-regions are merged where
//! the end of one meets a key point of another (Han et al. 2018, 3.2), so that few paths remain.
//!
//! The link follows the boundary itself, so it neither leaves the region nor crosses another line. On the other side, where
//! two line ends are not linked, one of them may hook along the boundary ([`LineEnds`]).

mod hooks;
pub mod regions;

use super::thin;
use super::{Fill, FillSettings, LineEnds, PassKind, Path, RasterSpacing, Strategy};
use planar::scan::{Scan, Spacing};
use planar::{Polygon, Region};
use regions::Weave;

/// Zigzag.
pub struct Zigzag;

impl Strategy for Zigzag {
    fn name(&self) -> &'static str {
        "zigzag"
    }

    fn repeats(&self) -> bool {
        true
    }

    fn fill(&self, island: &Polygon, settings: &FillSettings) -> Fill {
        thin::around(island, settings, |part, settings| self.lines(&self.infill(part, settings), settings))
    }

    fn infill(&self, island: &Polygon, settings: &FillSettings) -> Region {
        settings.outermost(island)
    }

    fn lines(&self, infill: &Region, settings: &FillSettings) -> Fill {
        Fill { stages: vec![zigzag(infill, settings)], fixed_order: false }
    }
}

/// Zigzag paths that fill a region.
pub(super) fn zigzag(region: &Region, settings: &FillSettings) -> Vec<Path> {
    match settings.raster_spacing {
        RasterSpacing::Fitted => {
            woven(&Scan::fitted(region, settings.raster_angle, settings.stepover), settings.stepover, settings)
        }
        RasterSpacing::Even | RasterSpacing::Exact => zigzag_spaced(region, settings, settings.spacing()),
    }
}

/// Zigzag paths through a region, with the given spacing of their lines.
pub(super) fn zigzag_spaced(region: &Region, settings: &FillSettings, spacing: Spacing) -> Vec<Path> {
    let scan = Scan::new(region, settings.raster_angle, spacing);
    let (Spacing::AtMost(distance) | Spacing::Exact(distance)) = spacing;
    woven(&scan, distance, settings)
}

fn woven(scan: &Scan, distance: f64, settings: &FillSettings) -> Vec<Path> {
    let weave = Weave::new(scan, distance);
    // Sparse lines leave gaps on purpose.
    let dense = distance <= settings.stepover;
    let passes = match settings.line_ends {
        LineEnds::Hooked if dense => weave.hooked(&weave.merged(), settings.bead.width),
        LineEnds::Hooked | LineEnds::Plain => weave.paths(&weave.merged()),
    };
    passes.into_iter().map(|points| Path::line(PassKind::Infill, points, settings.bead.width)).collect()
}
