//! What layers would build: the deposit model's figures, pages and height fields.

use crate::array::{Array, Item};
use crate::error::{Refuse, raise};
use crate::part::Part;
use crate::plan::Plan;
use crate::profile::Profile;
use crate::running::Running;
use beadwright::compare::{self as library, Chosen, Entry, Totals};
use beadwright::deposit::DepositSettings;
use beadwright::deposit::field::{Grid, bands};
use beadwright::deposit::stroke::strokes;
use beadwright::fill::StrategyName;
use beadwright::layer;
use beadwright::metrics::Metrics;
use beadwright::planar::Bounds;
use beadwright::read_back;
use beadwright::{Layer, plan};
use glam::{DVec2, DVec3};
use pyo3::prelude::*;
use std::borrow::Cow;
use std::collections::BTreeSet;

/// A strategy or a program, judged.
#[pyclass(frozen, skip_from_py_object, module = "beadwright._core")]
pub(crate) struct Judged {
    pub(crate) entry: Entry,
    pub(crate) notes: Vec<String>,
    /// Dangerous lines of a program, as sentences.
    pub(crate) faults: Vec<String>,
}

#[pymethods]
impl Judged {
    #[getter]
    fn name(&self) -> &str {
        &self.entry.name
    }

    /// Arc starts, lengths, times and metal; the figures; the figures of each layer with its voids and peaks; how the
    /// part grows from layer to layer.
    #[getter]
    fn values<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let Entry { totals, figures, layers, growth, built, .. } = &self.entry;
        let layer = |l: &library::JudgedLayer| {
            let (index, figures) = (l.index, l.figures.summary());
            serde_json::json!({ "index": index, "z": l.z, "figures": figures, "voids": l.voids, "peaks": l.peaks })
        };
        let layers: Vec<_> = layers.iter().map(layer).collect();
        let value = serde_json::json!({ "totals": totals, "deposit": figures.summary(), "layers": layers, "growth": growth, "built": built });
        Ok(pythonize::pythonize(py, &value)?)
    }

    /// The columns of the comparison: heading with unit, and value.
    #[getter]
    fn columns(&self) -> Vec<(&'static str, f64)> {
        library::COLUMNS.iter().map(|column| (column.name, (column.value)(&self.entry))).collect()
    }

    #[getter]
    fn notes(&self) -> Vec<String> {
        self.notes.clone()
    }

    #[getter]
    fn faults(&self) -> Vec<String> {
        self.faults.clone()
    }
}

/// The page with the table and the height fields side by side.
#[pyfunction]
pub(crate) fn page(title: &str, lead: &str, judged: Vec<PyRef<'_, Judged>>) -> String {
    let entries: Vec<Entry> = judged.iter().map(|judged| judged.entry.clone()).collect();
    library::page(title, lead, &entries, None).html()
}

/// The grid that is asked for, or one that fits the part, of `layers` layers.
fn fitted(grid: Option<f64>, settings: DepositSettings, bounds: &Bounds, layers: usize) -> PyResult<DepositSettings> {
    read_back::with_grid(grid, settings, bounds, layers).map_err(|error| raise(&error.to_string(), Some("grid"), None))
}

/// The extent of a part as seen from above, mm.
fn seen_from_above((low, high): (DVec3, DVec3)) -> Bounds {
    Bounds { min: low.truncate(), max: high.truncate() }
}

/// What layers with their slices cover, mm.
fn extent(layers: &[Layer]) -> Bounds {
    layer::bounds(layers).unwrap_or(Bounds { min: DVec2::ZERO, max: DVec2::ZERO })
}

/// Plans a solid with each strategy, and judges the chosen layers (indices from 0; all of them if none are given).
#[pyfunction]
#[pyo3(signature = (part, profile, strategies, layers, grid, threads, progress))]
#[expect(clippy::too_many_arguments, reason = "the arguments of the Python function")]
pub(crate) fn compare<'py>(
    py: Python<'py>,
    part: &Part,
    profile: &Profile,
    strategies: Vec<String>,
    layers: Option<BTreeSet<usize>>,
    grid: Option<f64>,
    threads: Option<usize>,
    progress: Option<Bound<'py, PyAny>>,
) -> PyResult<Vec<Judged>> {
    let profile = &*profile.profile;
    let Some(mesh) = part.part.mesh() else {
        return Err(raise(
            "strategies are compared on solids, and this is a wall given by curves.",
            Some(&part.name),
            None,
        ));
    };
    let count = (mesh.bounds().1.z / profile.layers.height) as usize;
    let settings = fitted(grid, plan::deposit_settings(profile), &seen_from_above(mesh.bounds()), count)?;
    let chosen: Chosen = layers;
    let strategies: Result<Vec<StrategyName>, _> = strategies.iter().map(|name| name.parse()).collect();
    let strategies = strategies.refuse(None)?;
    Running::new(threads, progress).run(py, Some(&part.name), |task| {
        let judged = |name: &StrategyName| {
            let entry = library::strategy(mesh, profile, *name, settings, &chosen, task)?;
            Ok::<_, beadwright::PlanError<_>>(Judged { entry, notes: Vec::new(), faults: Vec::new() })
        };
        strategies.iter().map(judged).collect::<Result<Vec<_>, _>>()
    })
}

/// Judges a plan as it is welded.
#[pyfunction]
#[pyo3(signature = (plan, grid, threads, progress))]
pub(crate) fn judge<'py>(
    py: Python<'py>,
    plan: &Plan,
    grid: Option<f64>,
    threads: Option<usize>,
    progress: Option<Bound<'py, PyAny>>,
) -> PyResult<Judged> {
    let planned = &plan.0;
    let layers: Vec<Layer> =
        planned.layers.iter().map(|layer| plan::welded_alone(layer, &planned.profile)).map(Cow::into_owned).collect();
    let settings = fitted(grid, plan::deposit_settings(&planned.profile), &extent(&layers), layers.len())?;
    let mut metrics = Metrics::new(&planned.profile);
    planned.layers.iter().for_each(|layer| metrics.add(layer));
    let (name, totals) = (&planned.header.part, Totals::of_plan(&metrics));
    let entry = Running::new(threads, progress)
        .run(py, Some(name), |task| library::program(name, &layers, totals, settings, &None, task))?;
    Ok(Judged { entry, notes: Vec::new(), faults: Vec::new() })
}

/// The height field of a layer: rows of heights above its bottom (mm) from low y to high, the lowest point (mm), and the
/// distance of the points (mm).
#[pyfunction]
#[pyo3(signature = (plan, layer, grid))]
pub(crate) fn height_field(
    py: Python<'_>,
    plan: &Plan,
    layer: usize,
    grid: Option<f64>,
) -> PyResult<(Array, (f64, f64), f64)> {
    let planned = &plan.0;
    let Some(layer) = planned.layers.get(layer) else {
        let last = planned.layers.len() - 1;
        return Err(raise(
            &format!("there is no layer {layer}; the layers have the indices 0 to {last}."),
            Some("layer"),
            None,
        ));
    };
    let welded = plan::welded_alone(layer, &planned.profile);
    let bounds = extent(std::slice::from_ref(&*welded));
    let settings = fitted(grid, plan::deposit_settings(&planned.profile), &bounds, 1)?;
    let strokes: Vec<_> = welded.passes.iter().flat_map(|pass| strokes(pass, &settings.nominal)).collect();
    let grid = Grid::covering(&bounds, settings.nominal.bead.width, settings.step);
    let heights = Running::new(None, None)
        .run(py, None, |_| Ok::<_, std::convert::Infallible>(bands(&strokes, &grid, |band| band.heights).concat()))?;
    let low = grid.place(0, 0);
    Ok((Array::rows(heights, Item::Float, grid.columns as isize), (low.x, low.y), grid.step))
}
