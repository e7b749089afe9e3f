//! How plate and part bend.

use crate::array::Array;
use crate::error::raise;
use crate::plan::Plan;
use crate::running::Running;
use beadwright::distort::{EccentricityScore, Shape};
use beadwright::distortion::{self as library, Clamps, DistortionError, Material, Setup, Welding, page};
use pyo3::prelude::*;

/// Plate and part, bent.
#[pyclass(frozen, module = "beadwright._core")]
pub(crate) struct Distortion {
    bent: beadwright::distort::Distortion,
    course: Vec<beadwright::distort::Eccentricity>,
    html: String,
}

/// Computes how plate and part bend; `clamps` is `corners`, `edge` or `none`, `material` `steel` or `aluminium`.
#[pyfunction]
#[pyo3(signature = (plan, clamps, material, calibration, voxel, voxel_height, steps, threads, progress))]
#[expect(clippy::too_many_arguments, reason = "the arguments of the Python function")]
pub(crate) fn distort<'py>(
    py: Python<'py>,
    plan: &Plan,
    clamps: &str,
    material: Option<&str>,
    calibration: f64,
    voxel: Option<f64>,
    voxel_height: Option<f64>,
    steps: Option<usize>,
    threads: Option<usize>,
    progress: Option<Bound<'py, PyAny>>,
) -> PyResult<Distortion> {
    let clamps = match clamps {
        "corners" => Clamps::Corners,
        "edge" => Clamps::Edge,
        "none" => Clamps::None,
        _ => return Err(unknown("clamps", clamps, "\"corners\", \"edge\" and \"none\"")),
    };
    let material = match material {
        None => None,
        Some("steel") => Some(Material::Steel),
        Some("aluminium") => Some(Material::Aluminium),
        Some(other) => return Err(unknown("material", other, "\"steel\" and \"aluminium\"")),
    };
    let setup = Setup { clamps, material, calibration, voxel, voxel_height, most_steps: steps, ..Setup::default() };
    let planned = &plan.0;
    let (name, profile, layers) = (&planned.header.part, &planned.profile, &planned.layers);
    let (bent, course) = Running::new(threads, progress).run(py, Some(name), |task| {
        let bent = setup.build(&Welding::of(layers, profile)?, profile, task)?;
        Ok::<_, DistortionError>((bent, library::eccentricity(layers, profile, task)?))
    })?;
    let html = page::page(name, &bent, &course).html();
    Ok(Distortion { bent, course, html })
}

fn unknown(argument: &str, value: &str, known: &str) -> PyErr {
    raise(&format!("{argument} = \"{value}\" is unknown: {known} are known."), Some(argument), None)
}

#[pymethods]
impl Distortion {
    /// Figures of both shapes, of the steps and of the thermal eccentricity.
    #[getter]
    fn values<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let shape = |shape: &Shape| serde_json::json!({ "lift": shape.lift, "deviation": shape.deviation });
        let value = serde_json::json!({
            "voxels": self.bent.voxels.len(),
            "steps": self.bent.steps,
            "clamped": shape(&self.bent.clamped),
            "released": shape(&self.bent.released),
            "eccentricity": { "score": EccentricityScore::of(&self.course), "course": self.course },
            "balance": { "clamped": self.bent.clamped_balance, "released": self.bent.released_balance },
        });
        Ok(pythonize::pythonize(py, &value)?)
    }

    /// Where the nodes of a shape are, and how far each of them moves, n × 3, mm.
    fn moved(&self, released: bool) -> (Array, Array) {
        let shape = if released { &self.bent.released } else { &self.bent.clamped };
        let places = shape.nodes.iter().map(|&node| self.bent.grid.place(node)).collect();
        (Array::places(places), Array::places(shape.moved.clone()))
    }

    #[getter]
    fn html(&self) -> &str {
        &self.html
    }
}
