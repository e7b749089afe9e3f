//! What heat does to beads: on warm metal they spread, and the layers of a wall rise less.

use super::settings::PlanSettings;
use super::{Collect, PlanError, Start, plan_at};
use crate::bead::BeadByHeat;
use crate::chart::Chart;
use crate::heat::{Build, HeatSettings, Interpass, LayerHeat, PassHeat, Site};
use crate::layer::Layer;
use crate::model::{Mesh, PartRef};
use crate::pass::{Along, Pass, Segment};
use crate::slice::Slab;
use crate::task::Task;
use crate::weld::WeldSettings;
use glam::DVec3;
use planar::Bounds;

/// How often a wall is planned until its layers lie where its own heat lets them rise; each round reduces the error by
/// a factor of ten.
const ROUNDS: usize = 3;

/// Heights that differ by no more than this are the same, mm.
const SAME: f64 = 1e-6;

/// How a part warms up, and what that does to it.
#[derive(Debug, Clone)]
pub(super) struct Warming {
    /// What the heat model needs; `None` where temperatures are not limited and do nothing to beads, or cannot be computed.
    pub(super) model: Option<(HeatSettings, WeldSettings)>,
    /// How beads change with the heat of the metal below, if they do.
    pub(super) by_heat: Option<BeadByHeat>,
    /// How warm the metal may be where passes begin, if that is limited.
    pub(super) interpass: Option<Interpass>,
    /// Height of a usual layer, mm.
    pub(super) height: f64,
}

/// How warm the metal ahead of the torch is at each height of a wall, and how that changes its layers.
#[derive(Debug, Clone, Default)]
pub(super) struct Warmth {
    /// Tops of layers, mm, and their rise as a multiple of that at the temperature of the profile.
    lifts: Vec<(f64, f64)>,
}

impl Warmth {
    /// Thickness of a layer on metal at a height (mm), as a multiple of its thickness at the temperature of the
    /// profile.
    pub(super) fn lift(&self, z: f64) -> f64 {
        // At the boundary between two layers, rounding must not decide.
        let next = self.lifts.partition_point(|(top, _)| *top <= z + SAME);
        self.lifts.get(next).or(self.lifts.last()).map_or(1.0, |(_, lift)| *lift)
    }
}

/// The part as it warms up while its layers are planned.
#[derive(Debug, Default)]
pub(super) struct Heat {
    /// The body whose layers come.
    pub(super) body: usize,
    /// Its metal; `None` where the profile neither limits temperatures nor says what heat does to beads.
    pub(super) build: Option<Build>,
    warmth: Warmth,
}

impl Heat {
    /// The plate before the first layer.
    pub(super) fn of(warming: &Warming, bounds: &Bounds, slabs: &[Slab], warmth: &Warmth) -> Self {
        let layers: Vec<(f64, f64)> = slabs.iter().map(|slab| (slab.z, slab.height)).collect();
        let build = warming.model.as_ref().map(|(heat, weld)| Build::new(heat, weld, bounds, &layers));
        Self { body: 0, build, warmth: warmth.clone() }
    }

    /// What the bodies of a part begin on, each given by its chart and its mesh in the chart's coordinates.
    pub(super) fn of_bodies<'a>(warming: &Warming, bodies: impl Iterator<Item = (&'a Chart, &'a Mesh)>) -> Self {
        let build = warming.model.as_ref().map(|(heat, weld)| {
            let site = |(chart, mesh): (&Chart, &Mesh)| {
                // Around an axis the mesh includes what lies below the first layer.
                let least = if chart.goes_around() { warming.height / 2.0 } else { f64::NEG_INFINITY };
                let welded: Vec<DVec3> = mesh.vertices.iter().copied().filter(|p| p.z > least).collect();
                Site::of(chart, &welded, 0.0)
            };
            let sites: Vec<Option<Site>> = bodies.map(site).collect();
            Build::in_space(heat, weld, &sites)
        });
        Self { build, ..Self::default() }
    }

    /// What a part whose layers are not level begins on; `part` is given in the coordinates of its chart.
    pub(super) fn in_space(part: PartRef, settings: &PlanSettings) -> Option<Self> {
        let chart = settings.slicing.chart;
        let PartRef::Mesh { mesh, .. } = part else { return None };
        (!chart.is_level()).then(|| Self::of_bodies(&settings.warming, std::iter::once((chart, mesh))))
    }

    /// The same heat, before the layers of the next body.
    pub(super) fn before(&mut self, body: usize, warmth: &Warmth) -> &mut Self {
        (self.body, self.warmth) = (body, warmth.clone());
        self
    }

    /// Thickness of a layer on metal at a height (mm), as a multiple of its thickness at the temperature of the
    /// profile.
    pub(super) fn lift(&self, index: usize, below: f64) -> f64 {
        // The first bead of a wall is a cap on the cold plate.
        if index == 0 { 1.0 } else { self.warmth.lift(below) }
    }
}

/// The warmth of a wall, if it is known what heat does to its layers, and its layers follow their height.
pub(super) fn predicted<E>(part: PartRef, settings: &PlanSettings, task: &Task) -> Result<Warmth, PlanError<E>> {
    let mut warmth = Warmth::default();
    let Some(law) = settings.warming.by_heat else { return Ok(warmth) };
    let wall = match part {
        PartRef::Mesh { .. } => settings.wall?,
        PartRef::Curves(..) => Some(settings.curve_wall?),
    };
    let Some(wall) = wall else { return Ok(warmth) };
    for _ in 0..ROUNDS {
        let (mut planned, mut heat) = (Collect::default(), Heat::in_space(part, settings));
        match plan_at(Start::alone(&warmth, heat.as_mut()), "", part, settings, task, &mut planned) {
            Ok(_) => {}
            Err(PlanError::Cancelled(cancelled)) => return Err(cancelled.into()),
            // The plan itself reports the fault.
            Err(_) => return Ok(warmth),
        }
        let lift = |layer: &Layer| Some((layer.z, law.lift(wall.rise(), ahead(layer)?)));
        warmth = Warmth { lifts: planned.layers.iter().filter_map(lift).collect() };
    }
    Ok(warmth)
}

/// Mean temperature of the metal ahead of the torch in a layer, °C.
fn ahead(layer: &Layer) -> Option<f64> {
    let (mut sum, mut whole) = (0.0, 0.0);
    for (pass, temperature) in layer.passes.iter().zip(&layer.temperatures) {
        sum += pass.length() * temperature.mean;
        whole += pass.length();
    }
    (whole > 0.0).then(|| sum / whole)
}

/// Makes the passes of a layer as wide as their beads become on the warm metal below; `nominal` (mm) is the width of
/// the profile's bead. Their paces stay the same: the metal is the same, but flatter.
pub(super) fn widen(layer: &mut Layer, heat: &LayerHeat, build: &Build, law: &BeadByHeat, nominal: f64) {
    for (pass, heat) in layer.passes.iter_mut().zip(&heat.passes) {
        pass.width = along(pass, heat, build, |piece, ahead| piece.width * law.widening(nominal, ahead));
    }
}

/// A value for every piece of a pass, from the temperature (°C) ahead of the torch there.
pub(crate) fn along(pass: &Pass, heat: &PassHeat, build: &Build, value: impl Fn(&Segment, f64) -> f64) -> Along {
    let mut way = 0.0;
    let mut of = |piece: Segment| {
        let from = way;
        way += piece.length();
        value(&piece, heat.ahead(from..way, build.spacing()))
    };
    let mut values: Vec<f64> = pass.segments().map(&mut of).collect();
    // The last point of an open pass.
    values.extend(values.last().copied().filter(|_| !pass.closed));
    Along::Each(values)
}
