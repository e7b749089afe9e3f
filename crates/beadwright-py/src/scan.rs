//! Scans of a build: compared with the part, and followed by corrected layers.

use crate::array::Array;
use crate::error::{Refuse, exception, raise};
use crate::part::{Part, unit_of};
use crate::plan::Plan;
use crate::running::Running;
use beadwright::adapt::scan;
use beadwright::adapt::{self as library, Align, Rules, Unfinished};
use beadwright::as_built::{AsBuilt, as_built};
use beadwright::deviation as distances;
use beadwright::dialect::DialectError;
use beadwright::files::{Folder, FolderError, Programs};
use glam::DVec3;
use pyo3::buffer::PyBuffer;
use pyo3::prelude::*;
use std::path::PathBuf;

/// Points on the surface of a build, mm.
#[pyclass(frozen, skip_from_py_object, module = "beadwright._core")]
pub(crate) struct Scan(scan::Scan);

#[pymethods]
impl Scan {
    /// A scan from the bytes of a file whose lengths are in this unit.
    #[staticmethod]
    fn read(py: Python<'_>, place: &str, bytes: &[u8], units: &str) -> PyResult<Self> {
        let unit = unit_of(units)?.in_mm();
        let mut scan = Running::new(Some(1), None).run(py, Some(place), |task| scan::read(bytes, task))?;
        scan.points.iter_mut().for_each(|point| *point *= unit);
        Ok(Self(scan))
    }

    /// A scan from points (three numbers each), mm.
    #[staticmethod]
    fn of(py: Python<'_>, points: PyBuffer<f64>) -> PyResult<Self> {
        let points = points.to_vec(py)?;
        let points: Vec<DVec3> = points.as_chunks::<3>().0.iter().copied().map(DVec3::from_array).collect();
        let read = points.len();
        let seen: Vec<DVec3> = points.into_iter().filter(|point| point.is_finite()).collect();
        let without_height = read - seen.len();
        Ok(Self(scan::Scan { points: seen, triangles: Vec::new(), format: "points", without_height }))
    }

    /// The format, for people.
    #[getter]
    fn format(&self) -> &'static str {
        self.0.format
    }

    #[getter]
    fn points(&self) -> Array {
        Array::places(self.0.points.clone())
    }
}

/// Distances of points from the surface of a part.
#[pyclass(frozen, module = "beadwright._core")]
pub(crate) struct Deviation {
    deviation: distances::Deviation,
    /// What the metal of a plan has in common with the part.
    built: Option<AsBuilt>,
}

#[pymethods]
impl Deviation {
    /// Figures, points of the plate, doubts and, for a plan, what metal and part have in common.
    #[getter]
    fn values<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let distances::Deviation { figures, plate, doubts, .. } = &self.deviation;
        let mut value = serde_json::json!({ "figures": figures, "plate": plate, "doubts": doubts });
        if let Some(built) = &self.built {
            value["built"] = serde_json::json!(built);
            value["built"]["agreement"] = built.agreement().into();
        }
        Ok(pythonize::pythonize(py, &value)?)
    }

    /// Distance of each point, mm: positive outside the part.
    #[getter]
    fn distances(&self) -> Array {
        Array::list(self.deviation.distances.clone())
    }
}

/// Compares a scan with a part; `allowance` (mm) is still to be milled off.
#[pyfunction]
#[pyo3(signature = (part, scan, allowance, threads, progress))]
pub(crate) fn deviation<'py>(
    py: Python<'py>,
    part: &Part,
    scan: &Scan,
    allowance: f64,
    threads: Option<usize>,
    progress: Option<Bound<'py, PyAny>>,
) -> PyResult<Deviation> {
    let mesh = part.solid()?;
    let deviation = Running::new(threads, progress)
        .run(py, Some(&part.name), |task| distances::deviation(mesh, &scan.0.points, allowance, task))?;
    Ok(Deviation { deviation, built: None })
}

/// Compares what the beads of a plan build with a part.
#[pyfunction]
#[pyo3(signature = (part, plan, threads, progress))]
pub(crate) fn built_deviation<'py>(
    py: Python<'py>,
    part: &Part,
    plan: &Plan,
    threads: Option<usize>,
    progress: Option<Bound<'py, PyAny>>,
) -> PyResult<Deviation> {
    let (mesh, planned) = (part.solid()?, &plan.0);
    let built = Running::new(threads, progress)
        .run(py, Some(&part.name), |task| as_built(&planned.layers, &planned.profile, mesh, task))?;
    Ok(Deviation { deviation: built.surface.clone(), built: Some(built) })
}

/// The layers that follow a scan.
#[pyclass(frozen, module = "beadwright._core")]
pub(crate) struct Adapted {
    adapted: library::Adapted,
    plan: Py<Plan>,
}

/// Why nothing was written.
#[derive(Debug, thiserror::Error)]
enum WriteError {
    #[error(transparent)]
    Dialect(#[from] DialectError),
    #[error(transparent)]
    Folder(#[from] FolderError),
}

/// Corrects the layers of a plan after layer `number` (from 1) by a scan; `align` is `as-is`, `plate` or `fit`.
#[pyfunction]
#[pyo3(signature = (plan, scan, number, align, window, spacing))]
pub(crate) fn adapt(
    py: Python<'_>,
    plan: Py<Plan>,
    scan: &Scan,
    number: usize,
    align: &str,
    window: (f64, f64),
    spacing: Option<f64>,
) -> PyResult<Adapted> {
    let how = match align {
        "as-is" => Align::AsIs,
        "plate" => Align::Plate,
        "fit" => Align::Fit,
        _ => {
            let message = format!("align = \"{align}\" is unknown: \"as-is\", \"plate\" and \"fit\" are known.");
            return Err(raise(&message, Some("align"), None));
        }
    };
    let planned = &plan.get().0;
    let rules = Rules { window, spacing: spacing.unwrap_or(planned.profile.bead.width) };
    let (build, scan) = (plan.get().unfinished(number), scan.0.clone());
    let adapted = Running::new(None, None)
        .run(py, Some(&planned.header.part), |_| library::Adapted::of(build, scan, how, rules))?;
    Ok(Adapted { adapted, plan })
}

#[pymethods]
impl Adapted {
    /// As `beadwright adapt --json` prints it.
    #[getter]
    fn values<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        Ok(pythonize::pythonize(py, &self.adapted.json())?)
    }

    #[getter]
    fn sentences(&self) -> Vec<String> {
        self.adapted.sentences()
    }

    #[getter]
    fn layers(&self) -> Vec<crate::layer::Layer> {
        crate::layer::Layer::all(&self.adapted.followed.layers.clone().into())
    }

    /// Writes the programs of the layers that follow, the whole plan and the page into a folder, and returns their names.
    fn save(&self, py: Python<'_>, folder: PathBuf, names: Vec<String>) -> PyResult<Vec<String>> {
        let plan = self.plan.get();
        let (profile, posts) = plan.0.posts(names)?;
        let build = Unfinished { profile: &profile, ..plan.unfinished(self.adapted.number) };
        let programs = Programs::of(&posts, &profile.job(&plan.0.header.part)).refuse(None)?;
        let written = || {
            let mut folder = Folder::new(&folder)?;
            self.adapted.files(build, programs, |chunks| Ok::<_, WriteError>(folder.extend(chunks)?))?;
            Ok::<_, WriteError>(folder.commit()?)
        };
        Ok(py.detach(written).map_err(|error| exception(&error, None))?.files)
    }
}

impl Plan {
    fn unfinished(&self, number: usize) -> Unfinished<'_> {
        let plan = &self.0;
        Unfinished { header: &plan.header, layers: &plan.layers, profile: &plan.profile, number }
    }
}
