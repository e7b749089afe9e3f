//! How much of a slice beads cover, and which bare areas matter.

use crate::fill::coverage::Coverage;
use crate::fill::{Fill, FillSettings, Path};
use crate::layer::Layer;
use crate::pass::Pass;
use crate::warning::WarningKind;
use glam::DVec2;
use planar::{Join, Polygon, Region};

/// How well passes cover an island, or several.
#[derive(Default)]
pub(super) struct Cover {
    /// mm²
    pub(super) area: f64,
    /// The bare areas that matter: kind, place, and size, mm².
    pub(super) doubts: Vec<(WarningKind, DVec2, f64)>,
}

/// Bare area is reported if it is more than this fraction of an island.
const WORTH_TELLING: f64 = 0.01;

/// A place too thin for a bead counts as welded if less than this fraction of it is left bare.
const WELDED: f64 = 0.5;

impl Cover {
    /// What the paths of an island cover.
    pub(super) fn of(fill: &Fill, island: &Polygon, settings: &FillSettings, reach: &Reach) -> Self {
        let paths: Vec<&Path> = fill.stages.iter().flatten().collect();
        let is_sparse = settings.infill_density < 1.0 && !paths.is_empty();
        if is_sparse && reach.lost.is_empty() {
            return Self { area: reach.area, doubts: Vec::new() };
        }
        let Some(coverage) = Coverage::of(&paths, &island.clone().into(), settings.bead.width) else {
            return Self::default();
        };
        let mut own = Self::of_island(&coverage, coverage.bare().area, island, settings.bead.width, reach);
        if is_sparse {
            // Left bare on purpose.
            own.area = reach.area;
            own.doubts.retain(|(kind, ..)| *kind != WarningKind::Bare);
        }
        own
    }

    /// What the passes of a layer cover of its islands, for those whose `reaches` are known; `width` (mm) is that of the
    /// nominal bead.
    pub(super) fn of_layer(layer: &Layer, reaches: &[Option<Reach>], width: f64) -> Self {
        let paths: Vec<Path> = layer.passes.iter().map(path).collect();
        let (paths, whole) = (paths.iter().collect::<Vec<_>>(), Region::from_normalised(layer.islands.clone()));
        let Some(coverage) = Coverage::of(&paths, &whole, width) else { return Self::default() };
        let mut all = Self::default();
        for (island, reach) in layer.islands.iter().zip(reaches) {
            let Some(reach) = reach else { continue };
            let bare = coverage.bare_of(&island.clone().into()).area;
            let own = Self::of_island(&coverage, bare, island, width, reach);
            all.area += own.area;
            all.doubts.extend(own.doubts);
        }
        all
    }

    fn of_island(coverage: &Coverage, bare: f64, island: &Polygon, width: f64, reach: &Reach) -> Self {
        let area = island.area();
        let mut unreached = (area - reach.area).max(0.0);
        let mut doubts = Vec::new();
        for piece in reach.thin_places() {
            let size = piece.area();
            let is_welded = coverage.bare_of(&piece.clone().into()).area < WELDED * size;
            if is_welded {
                unreached -= size;
            }
            let kind = if is_welded { WarningKind::ThinWall } else { WarningKind::ThinFeature };
            doubts.push((kind, piece.outer.points().first().copied().unwrap_or_default(), size));
        }
        let least = WORTH_TELLING * area;
        // What no bead reaches, such as sharp corners, is not left bare by the strategy.
        let left = bare - unreached;
        if left > least {
            let inner = coverage.bare_of(&Region::from(island.clone()).offset(-FLANK * width, Join::ROUND));
            let size = if left > FLANKS_TOO * area { left } else { inner.area - unreached };
            doubts.extend((size > least).then_some((WarningKind::Bare, inner.place, size)));
        }
        Self { area: (area - bare).max(0.0), doubts }
    }
}

/// A pass as a path on its layer.
pub(super) fn path(pass: &Pass) -> Path {
    let points = pass.points.iter().map(|p| p.truncate()).collect();
    Path { kind: pass.kind, closed: pass.closed, points, width: pass.width.clone(), reversible: true }
}

/// Strips along the outline count, too, from this fraction of an island.
const FLANKS_TOO: f64 = 0.02;

/// A bead slopes so gently over this fraction of its width that strips of it along the outline make little difference.
const FLANK: f64 = 0.1;

/// A feature of this area or more is reported, in squared bead widths.
const THIN_FEATURE: f64 = 0.25;

/// Lost pieces end this far, in bead widths, from the area that a bead reaches, so that their edges do not touch it.
const CLEAR: f64 = 0.01;

/// The part of an island that a bead reaches without leaving it.
#[derive(Clone)]
pub(super) struct Reach {
    /// Its width, mm.
    width: f64,
    /// mm²
    pub(super) area: f64,
    /// The rest, with corners; empty where that is too little to look at.
    lost: Region,
}

impl Reach {
    /// The part of an island that a bead of the given width, mm, reaches.
    ///
    /// That area is the opening of the island by a disc of the bead's width. With C the region inside the outermost
    /// centre-lines and r half a width, Steiner's formula gives it as long as C has the same connectivity as the
    /// island. So shapes are computed only at necks, and where this figure shows that something is lost; the area is
    /// then too large by a hair, [`CLEAR`] along what is lost.
    pub(super) fn of(island: &Polygon, width: f64) -> Self {
        let (r, area) = (width / 2.0, island.area());
        let centre = island.centres_of_disc(r, Join::ROUND);
        if centre.is_empty() {
            return Self { width, area: 0.0, lost: island.clone().into() };
        }
        if let Some(opened) = island.reached_by_disc(r, &centre)
            && island.is_roomy_for_disc(r, &centre, THIN_FEATURE * width * width)
        {
            return Self { width, area: opened.clamp(0.0, area), lost: Region::default() };
        }
        let lost = Region::from(island.clone()).difference(&centre.offset(r + CLEAR * width, Join::ROUND));
        Self { width, area: (area - lost.area()).max(0.0), lost }
    }

    /// Places too thin for a bead, except corners.
    fn thin_places(&self) -> impl Iterator<Item = &Polygon> {
        let smallest = THIN_FEATURE * self.width * self.width;
        self.lost.polygons().iter().filter(move |piece| piece.area() > smallest)
    }
}
