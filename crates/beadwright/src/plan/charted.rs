//! Parts whose layers are not level: their mesh is planned in the coordinates of the profile's chart, in which layers
//! are level.

use super::PlanError;
use super::slicing::Slicing;
use crate::chart::warp::{self, WarpError};
use crate::chart::{At, Chart, Cylinder, Sheet, Side};
use crate::layer::Layer;
use crate::model::{Mesh, PartRef};
use crate::pass::{Along, Pass};
use crate::slice::Surface;
use crate::task::Task;
use crate::weld::WeldSettings;
use glam::{DVec2, DVec3};
use planar::{Bounds, Polygon, Ring};
use std::borrow::Cow;

/// The edges of a mesh in the coordinates of a chart lie this close to the true ones, mm.
pub(super) const TOLERANCE: f64 = 0.02;

/// A mesh in the coordinates in which its layers are level.
///
/// # Errors
/// [`WarpError`].
pub(crate) fn unrolled<'a>(mesh: &'a Mesh, chart: &Chart, task: &Task) -> Result<Cow<'a, Mesh>, WarpError> {
    Ok(if chart.is_level() { Cow::Borrowed(mesh) } else { Cow::Owned(warp::warped(chart, mesh, TOLERANCE, task)?) })
}

/// If a part's middle lies farther from the axis of its layers than this fraction of its size, it may be misplaced.
const ASIDE: f64 = 0.1;
/// Metal below the first plane is reported from this fraction of the whole.
const MISSING: f64 = 1e-3;

/// What users should know about the chart of a part, as sentences. `placed` is the part as it stands on the table,
/// `unrolled` the same part in the chart's coordinates.
pub(super) fn notes(placed: &Mesh, unrolled: &Mesh, chart: &Chart) -> Vec<String> {
    let inside = matches!(chart, Chart::Cylinder(Cylinder { side: Side::Inner, .. })).then(|| {
        "The first move goes straight to the first layer inside the bore: bring the torch in along the axis before it starts, and out \
         after it ends."
            .to_owned()
    });
    [aside(placed, unrolled, chart), below(placed, unrolled, chart), stretched(unrolled, chart), inside]
        .into_iter()
        .flatten()
        .collect()
}

/// A note that a part may be misplaced.
fn aside(placed: &Mesh, unrolled: &Mesh, chart: &Chart) -> Option<String> {
    let (low, high) = placed.bounds();
    let (middle, size) = (low.midpoint(high), (high - low).length());
    if let Some(aside) = chart.off_axis(middle).filter(|aside| *aside > ASIDE * size) {
        return Some(format!(
            "The axis of layers.chart passes {aside:.1} mm beside the middle of the part (x {:.1} y {:.1} z {:.1} mm as it stands on \
             the table): check through and axis.",
            middle.x, middle.y, middle.z
        ));
    }
    let (low, high) = unrolled.bounds();
    let (aside, wide) = (low.midpoint(high).truncate().length(), (high - low).truncate().length());
    (chart.has_wedges() && aside > ASIDE * wide).then(|| {
        format!(
            "The guide of layers.chart passes up to {aside:.1} mm beside the middle of the part's sections: check its points; they are \
             those of the part as it stands on the table. beadwright guide finds them."
        )
    })
}

/// It is reported if beads lie farther apart than planned by more than this fraction.
const STRETCHED: f64 = 0.01;

/// A note that beads lie farther apart than planned on the slopes of a surface.
pub(super) fn stretched(unrolled: &Mesh, chart: &Chart) -> Option<String> {
    let most = unrolled.vertices.iter().map(|p| chart.stretch(p.truncate())).fold(1.0, f64::max) - 1.0;
    (most > STRETCHED).then(|| {
        format!(
            "Beads lie up to {:.1} % farther apart than planned, and layers are as much thinner, where the surface is steepest; the metal \
             is that of the part.",
            100.0 * most
        )
    })
}

/// A note that part of a solid lies below the first of its planes and is not welded.
fn below(placed: &Mesh, unrolled: &Mesh, chart: &Chart) -> Option<String> {
    let (whole, above) = (placed.volume(), chart.volume(unrolled));
    let missing = whole - above;
    (!chart.goes_around() && missing > MISSING * whole).then(|| {
        format!(
            "{:.1} of {:.1} cm³ of the part lie below the first plane of layers.chart and are not welded.",
            missing / 1e3,
            whole / 1e3
        )
    })
}

/// Why the programs of a part inside a bore should not be started: the torch would travel across the axis into the far
/// side.
pub(super) fn too_narrow(top: f64, chart: &Chart, weld: &WeldSettings) -> Option<String> {
    let Chart::Cylinder(Cylinder { side: Side::Inner, radius, .. }) = *chart else { return None };
    let above = weld.travel.clearance + weld.ends.dwell_height;
    (top + above >= radius).then(|| {
        format!(
            "Inside a bore of {radius} mm radius there is no room for travels {above} mm above layers {top:.1} mm high \
             (travel.clearance, start_stop.dwell_height)."
        )
    })
}

/// A solid in the coordinates of its chart, in which its layers are level.
pub(super) struct Unrolled<'a> {
    mesh: Cow<'a, Mesh>,
    milled: Option<Cow<'a, Mesh>>,
}

impl<'a> Unrolled<'a> {
    /// `None` for a part that is planned as it is.
    pub(super) fn of<E>(part: PartRef<'a>, slicing: &Slicing, task: &Task) -> Result<Option<Self>, PlanError<E>> {
        let chart = slicing.chart;
        if chart.is_level() {
            return Ok(None);
        }
        let PartRef::Mesh { mesh, milled, .. } = part else { return Err(PlanError::ChartOfCurves) };
        slicing.closed(mesh).map_err(|open| match slicing.surface {
            Some(Surface::Wall) => PlanError::ChartOfCurves,
            _ => open,
        })?;
        let own = unrolled(mesh, chart, task)?;
        if own.triangles.is_empty() {
            return Err(PlanError::Empty(format!(
                "all of the part lies below the first layer of {} (layers.chart); the part's coordinates are those in which it \
                 stands on the table.",
                chart.short()
            )));
        }
        let milled = milled.map(|part| unrolled(part, chart, task)).transpose()?;
        Ok(Some(Self { mesh: own, milled }))
    }

    pub(super) fn part(&self) -> PartRef<'_> {
        PartRef::Mesh { mesh: &self.mesh, milled: self.milled.as_deref(), onto: None }
    }
}

/// Maps places on a layer onto a layer above or below it: around an axis each unrolled layer is longer than the one
/// below it, and an island that crosses the seam may begin one turn earlier.
#[derive(Clone, Copy)]
pub(crate) struct Across<'a> {
    chart: &'a Chart,
    /// Heights of the middles of the two layers, mm.
    from: f64,
    to: f64,
}

/// Numbers of turns after which a place appears on a layer again.
const TURNS: [f64; 3] = [-1.0, 0.0, 1.0];

impl<'a> Across<'a> {
    /// From the layer whose middle is at the height `from` (mm) to the one at `to`; `None` where the two need no
    /// mapping.
    pub(crate) fn new(chart: &'a Chart, from: f64, to: f64) -> Option<Self> {
        chart.goes_around().then_some(Self { chart, from, to })
    }

    /// From one layer to another; `None` where the two need no mapping.
    pub(crate) fn layers(chart: &'a Chart, from: &Layer, to: &Layer) -> Option<Self> {
        Self::new(chart, from.middle(), to.middle())
    }

    /// The place on the other layer, one turn before, at the same turn, and one turn later.
    pub(crate) fn places(&self, p: DVec2) -> impl Iterator<Item = DVec2> {
        TURNS.into_iter().map(move |turns| self.place(p, turns))
    }

    fn place(&self, p: DVec2, turns: f64) -> DVec2 {
        let sheet = self.chart.sheet(self.to);
        let over = sheet.across(p, &self.chart.sheet(self.from));
        sheet.turned(over, turns).unwrap_or(over)
    }

    pub(crate) fn islands(&self, islands: &[Polygon]) -> Vec<Polygon> {
        let turned = |island: &Polygon| TURNS.map(|turns| island.moved(|p| self.place(p, turns)));
        islands.iter().flat_map(turned).collect()
    }

    pub(crate) fn passes(&self, passes: &[Pass]) -> Vec<Pass> {
        let moved = |pass: &Pass, turns: f64| {
            let points = pass.points.iter().map(|p| self.place(p.truncate(), turns).extend(p.z)).collect();
            Pass { points, ..pass.clone() }
        };
        passes.iter().flat_map(|pass| TURNS.map(|turns| moved(pass, turns))).collect()
    }
}

/// In space, pieces of passes keep this close to the line on their layer, mm, and the normal turns by no more than this
/// along each, rad.
const FINE: (f64, f64) = (0.01, 0.05);

/// Points of a line on a layer, close enough together that the straight pieces between them follow the layer; with each
/// the index of the original point whose piece it lies on.
pub(crate) fn followed(points: &[DVec3], closed: bool, sheet: &Sheet<'_>) -> Vec<(DVec3, usize)> {
    let (tolerance, angle) = FINE;
    let mut followed: Vec<(DVec3, usize)> = points.first().map(|first| (*first, 0)).into_iter().collect();
    let closing = points.last().zip(points.first()).filter(|_| closed).map(|(last, first)| [*last, *first]);
    let pieces = points.windows(2).map(|w| [w[0], w[1]]).chain(closing);
    for (i, [from, to]) in pieces.enumerate() {
        let ends = sheet.divided(from, to, tolerance, angle).map(|p| if p == to { (p, i + 1) } else { (p, i) });
        followed.extend(ends);
    }
    // The closing piece ends where the line began.
    followed.truncate(followed.len() - usize::from(closed && followed.len() > 1));
    followed
}

/// A pass in space, and the normal of its layer at each of its points.
pub(crate) fn in_space(pass: &Pass, sheet: &Sheet<'_>) -> (Pass, Vec<DVec3>) {
    let followed = followed(&pass.points, pass.closed, sheet);
    let along = |along: &Along| match along {
        Along::Same(value) => Along::Same(*value),
        Along::Each(_) => Along::Each(followed.iter().map(|(_, piece)| along.after(*piece)).collect()),
    };
    let (width, pace) = (along(&pass.width), along(&pass.pace));
    let at: Vec<At> = followed.iter().map(|(p, _)| sheet.at(*p)).collect();
    let points = at.iter().map(|at| at.place).collect();
    (Pass { points, width, pace, ..pass.clone() }, at.iter().map(|at| at.normal).collect())
}

/// A pass in space, brought back onto its layer; if some turn puts its first point within the layer's islands, that
/// turn is used.
pub(crate) fn on_layer(pass: Pass, sheet: &Sheet<'_>, islands: &[Polygon]) -> Pass {
    let Some(first) = pass.points.first() else { return pass };
    let start = sheet.coordinates(*first, DVec2::ZERO).truncate();
    let points = islands.iter().flat_map(Polygon::rings).flat_map(Ring::points).copied();
    let turns = Bounds::of(points).map_or([0.0; 2], |b| [b.min, b.max].map(|end| sheet.turns_to(start, end)));
    let [least, most] = [turns[0].min(turns[1]), turns[0].max(turns[1])].map(|turns| turns.round() as i32);
    let turned = (least..=most).filter_map(|turns| sheet.turned(start, f64::from(turns)));
    let inside = |p: &DVec2| islands.iter().any(|island| island.contains(*p));
    let mut near = turned.into_iter().find(inside).unwrap_or(start);
    let place = |p: &DVec3| {
        let on_it = sheet.coordinates(*p, near);
        near = on_it.truncate();
        on_it
    };
    let points = pass.points.iter().map(place).collect();
    Pass { points, ..pass }
}
