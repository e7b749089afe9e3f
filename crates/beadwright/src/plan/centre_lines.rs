//! Walls of one bead by their centre-lines: curves, or the lines in which layers cut an open surface.

use super::filled::{Filled, Filling};
use super::{PlanError, levels};
use crate::fill::wall::{self, graph::Line};
use crate::fill::{FillSettings, Path, coverage};
use crate::model::wall_curves::{CurvesAre, Section, WallCurves};
use crate::slice::{Lines, Slab, Slice};
use crate::warning::{Warning, WarningKind};
use glam::DVec2;
use planar::medial::Node;
use std::borrow::Cow;

/// The lines in which a layer cuts an open surface as passes.
pub(super) fn weld_lines(Lines { index, slab, sections, warnings }: Lines, filling: &Filling) -> Filled {
    let half = filling.first.bead.width / 2.0;
    let mut filled = weld_sections(&sections, |_| half, index, slab, filling);
    filled.slice.warnings.splice(0..0, warnings);
    filled
}

/// The sides of a wall lie at most this far apart, in bead widths: beyond that two beads would fit between them.
const SIDES: f64 = 2.0;

/// The centre-lines of a wall for beads of some width (mm): its curves, or the middle lines between them if they are its
/// sides.
pub(super) fn centre_lines<E>(
    curves: &WallCurves,
    are: Option<CurvesAre>,
    width: f64,
) -> Result<Cow<'_, WallCurves>, PlanError<E>> {
    let within = SIDES * width;
    match are {
        Some(CurvesAre::Centre) => Ok(Cow::Borrowed(curves)),
        Some(CurvesAre::Sides) => curves.between_sides(within).map(Cow::Owned).ok_or(PlanError::NoSides { within }),
        None => match curves.sides(within).first() {
            Some(sides) => Err(PlanError::SideBySide(*sides)),
            None => Ok(Cow::Borrowed(curves)),
        },
    }
}

/// Beads may be wider or narrower than the wall between its sides by this fraction without a note.
const AS_THICK: f64 = 0.1;

/// How thick a wall is between its sides, as a sentence where its beads have another width, mm.
pub(super) fn other_thickness(curves: &WallCurves, are: Option<CurvesAre>, width: f64) -> Option<String> {
    let sides = curves.sides(SIDES * width).into_iter().filter(|_| are == Some(CurvesAre::Sides));
    let thickness = sides.map(|sides| sides.thickness).reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)));
    let (least, greatest) = thickness?;
    let is_other = (least / width - 1.0).abs().max((greatest / width - 1.0).abs()) > AS_THICK;
    is_other.then(|| {
        format!(
            "The sides of the wall lie {least:.2} to {greatest:.2} mm apart, the bead is {width} mm wide: what is welded has the \
             width of the bead (bead.width)."
        )
    })
}

/// The centre-lines of a layer as passes.
pub(super) fn weld_curves(curves: &WallCurves, index: usize, slab: Slab, filling: &Filling) -> Filled {
    let FillSettings { bead, wall, .. } = filling.first;
    let sections = curves.at(slab.z - slab.height / 2.0, wall.chord_error);
    let leans = levels::leans(curves, slab);
    // A layer cuts a leaning wall at a slant: it is wider there.
    let half = |at: DVec2| bead.width / 2.0 / levels::lean_at(&leans, at).cos();
    weld_sections(&sections, half, index, slab, filling)
}

/// Centre-lines of walls as passes; `half` gives half the width at a place (mm), and the area that they cover takes the
/// place of the slice.
fn weld_sections(
    sections: &[Section],
    half: impl Fn(DVec2) -> f64,
    index: usize,
    slab: Slab,
    filling: &Filling,
) -> Filled {
    let settings = filling.in_layer(index);
    let width = settings.bead.width;
    let mut slice = Slice { index, z: slab.z, height: slab.height, ..Slice::default() };
    let node = |&at: &DVec2| Node { at, radius: half(at) };
    let line = |section: &Section| Line { nodes: section.points.iter().map(node).collect(), closed: section.closed };
    let mut fill = wall::along(&sections.iter().map(line).collect::<Vec<_>>(), &settings);
    for stage in &mut fill.stages {
        filling.drop_short(stage, None, index, &mut slice.warnings);
    }
    let along = |closed: bool| {
        let lines = sections.iter().filter(|section| section.closed == closed).map(|section| section.points.clone());
        planar::buffer(&lines.collect::<Vec<_>>(), closed, width / 2.0, COVER_TOLERANCE_MM)
    };
    let covered = along(true).union(&along(false));
    let paths: Vec<&Path> = fill.stages.iter().flatten().collect();
    let bare = coverage::bare(&paths, &covered, width);
    // Bare where a curve was too short or vanished in a junction.
    if bare.area > BARE_CURVE * width * width {
        let (kind, layer) = (WarningKind::Bare, index);
        slice.warnings.push(Warning { kind, layer, place: bare.place, size: bare.area });
    }
    let planned_area = (covered.area() - bare.area).max(0.0);
    slice.islands = covered.into_polygons();
    Filled {
        slice,
        fills: vec![fill],
        planned_area,
        reaches: Vec::new(),
        known: 0,
        has_helix: false,
        milled: None,
        shared: false,
    }
}

/// Bare area along curves is reported from this size, in squared bead widths.
const BARE_CURVE: f64 = 0.5;

/// Accuracy of the round ends of the area that a curve covers, mm.
const COVER_TOLERANCE_MM: f64 = 0.02;
