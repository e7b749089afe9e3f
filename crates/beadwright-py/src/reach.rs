//! Whether a robot can weld a plan, and with what margins.

use crate::array::{Array, Item};
use crate::error::{Refuse, raise};
use crate::plan::Plan;
use crate::running::Running;
use beadwright::robot::{self as library, Cell, PartPlace, Track, Trajectory, cell};
use pyo3::prelude::*;
use std::convert::Infallible;

/// The path of a robot along a plan.
#[pyclass(frozen, module = "beadwright._core")]
pub(crate) struct Reach {
    values: serde_json::Value,
    trajectory: Option<Trajectory>,
    html: String,
}

/// Names of the built-in cells.
#[pyfunction]
pub(crate) fn cell_names() -> Vec<&'static str> {
    cell::BUILT_IN.iter().map(|(name, _)| *name).collect()
}

/// The text of a built-in cell.
#[pyfunction]
pub(crate) fn cell_text(name: &str) -> PyResult<&'static str> {
    Cell::built_in_text(name).refuse(None)
}

/// Follows a plan with the robot of a cell, whose text is TOML; `urdf` is the text of the arm's file, if the cell names
/// one. `at` is the position of the part: x, y, z (mm) and the turn about the vertical (°).
#[pyfunction]
#[pyo3(signature = (plan, cell, place, urdf, at, suggest))]
pub(crate) fn reach(
    py: Python<'_>,
    plan: &Plan,
    cell: &str,
    place: &str,
    urdf: Option<String>,
    at: Option<[f64; 4]>,
    suggest: bool,
) -> PyResult<Reach> {
    let no_file = |name: &str| urdf.ok_or_else(|| format!("{name} is not there"));
    let cell = Cell::parse_with(cell, no_file).refuse(Some(place))?;
    let planned = &plan.0;
    let track = planned.profile.track(&planned.layers);
    if track.stops.is_empty() {
        return Err(raise("the plan has no passes.", Some(&planned.header.part), None));
    }
    let wanted = at.map_or(cell.part, |[x, y, z, rotation]| PartPlace { position: [x, y, z], rotation });
    let name = &planned.header.part;
    Running::new(None, None).run(py, None, |_| Ok::<_, Infallible>(walked(name, &cell, wanted, &track, suggest)))
}

/// What `beadwright reach --json` prints, and the trajectory where there is one.
fn walked(name: &str, cell: &Cell, place: PartPlace, track: &Track, suggest: bool) -> Reach {
    let library::External { cell, place, station, table } = library::external_axes(cell, place, track);
    let reach = library::reach(&cell, place, track);
    let better = suggest.then(|| library::suggest(&cell, place, track)).flatten();
    let finding = |f: &library::ReachFinding| serde_json::json!({ "fatal": f.trouble.is_fatal(), "sentence": f.sentence(), "finding": f });
    let findings: Vec<_> = reach.findings.iter().map(finding).collect();
    let joints: Vec<_> = (0..6).map(|joint| reach.joint(joint)).collect();
    let values = serde_json::json!({
        "cell": cell.name, "place": reach.place, "reachable": reach.is_reachable(), "least_margin": reach.least_margin(),
        "posture": reach.branch.name(), "joints": joints, "turning": reach.turning,
        "torch_angle": reach.turning.program_angle(), "linear_axis": station, "table": table, "points": reach.poses.len(), "findings": findings,
        "suggestion": better,
    });
    let html = beadwright::report::reach::page(name, &cell, &reach, better.as_ref()).html();
    Reach { values, trajectory: Trajectory::of(&cell, &reach), html }
}

#[pymethods]
impl Reach {
    #[getter]
    fn values<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        Ok(pythonize::pythonize(py, &self.values)?)
    }

    /// Time of each point, s, and angles of the six joints, °; `None` if a point is out of reach.
    #[getter]
    fn trajectory(&self) -> Option<(Array, Array)> {
        let points = &self.trajectory.as_ref()?.points;
        let times: Vec<f64> = points.iter().map(|point| point.seconds).collect();
        let joints: Vec<f64> = points.iter().flat_map(|point| point.joints).collect();
        Some((Array::list(times), Array::rows(joints, Item::Float, 6)))
    }

    #[getter]
    fn html(&self) -> &str {
        &self.html
    }
}
