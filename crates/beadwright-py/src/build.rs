//! Plans welded in the height model, with errors and with feedback by scans.

use crate::error::{Refuse, raise};
use crate::plan::Plan;
use crate::running::Running;
use beadwright::adapt::{Feedback, Rules};
use beadwright::build::{self as library, Built, Errors, Settings, page, ready};
use beadwright::plan::deposit_settings;
use pyo3::prelude::*;

/// Errors of a build: of passes, along passes, its correlation (mm), drift, the pass that is lost, of scans (mm); as fractions
/// of the metal.
type Noise = (f64, f64, f64, f64, Option<usize>, f64);

/// A plan welded in the model, with each kind of feedback.
#[pyclass(frozen, module = "beadwright._core")]
pub(crate) struct Builds {
    builds: Vec<Built>,
    html: String,
}

/// Welds a plan with each kind of feedback: `none`, `mean` or `place`.
#[pyfunction]
#[pyo3(signature = (plan, feedback, noise, seed, window, spacing, threads, progress))]
#[expect(clippy::too_many_arguments, reason = "the arguments of the Python function")]
pub(crate) fn build<'py>(
    py: Python<'py>,
    plan: &Plan,
    feedback: Vec<String>,
    noise: Noise,
    seed: u64,
    window: (f64, f64),
    spacing: Option<f64>,
    threads: Option<usize>,
    progress: Option<Bound<'py, PyAny>>,
) -> PyResult<Builds> {
    let planned = &plan.0;
    let (name, profile) = (&planned.header.part, &planned.profile);
    let kinds = feedback.iter().map(|name| kind(name)).collect::<PyResult<Vec<_>>>()?;
    let layers = ready(&planned.layers, profile).refuse(Some(name))?;
    let (pass, along, correlation, drift, lost, scan) = noise;
    let settings = Settings {
        nominal: deposit_settings(profile).nominal,
        errors: Errors { pass, along, correlation, drift, lost, scan, seed },
        rules: Rules { window, spacing: spacing.unwrap_or(profile.bead.width) },
        heat: None,
    };
    let builds = Running::new(threads, progress).run(py, Some(name), |task| {
        let built = |by: &Feedback| library::build(&layers, *by, &settings, task);
        kinds.iter().map(built).collect::<Result<Option<Vec<_>>, _>>()
    })?;
    let Some(builds) = builds else { return Err(raise("the layers of the plan do not rise.", Some(name), None)) };
    let html = page::page(name, &builds, &settings).html();
    Ok(Builds { builds, html })
}

fn kind(name: &str) -> PyResult<Feedback> {
    match name {
        "none" => Ok(Feedback::None),
        "mean" => Ok(Feedback::Mean),
        "place" => Ok(Feedback::Place),
        _ => {
            let message = format!("feedback = \"{name}\" is unknown: \"none\", \"mean\" and \"place\" are known.");
            Err(raise(&message, Some("feedback"), None))
        }
    }
}

#[pymethods]
impl Builds {
    /// For each kind of feedback: the layers with their errors, the end, pieces and how many were clipped.
    #[getter]
    fn values<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let layer = |layer: &library::BuiltLayer| serde_json::json!({ "z": layer.z, "error": layer.error });
        let built = |built: &Built| {
            let layers: Vec<_> = built.layers.iter().map(layer).collect();
            serde_json::json!({
                "feedback": built.by, "layers": layers, "end": built.end, "rms_layers": built.rms(),
                "layer_height": built.layer_height, "pieces": built.pieces, "clipped": built.clipped,
            })
        };
        let values: Vec<_> = self.builds.iter().map(built).collect();
        Ok(pythonize::pythonize(py, &values)?)
    }

    #[getter]
    fn html(&self) -> &str {
        &self.html
    }
}
