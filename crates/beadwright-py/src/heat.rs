//! How warm the metal is before each pass.

use crate::array::{Array, Numbers};
use crate::error::{Refuse, raise};
use crate::plan::Plan;
use crate::running::Running;
use beadwright::heat::{self as library, HeatSettings, History, Interpass};
use beadwright::report::temperature;
use pyo3::prelude::*;
use std::sync::Arc;

/// Temperatures of a plan.
#[pyclass(frozen, module = "beadwright._core")]
pub(crate) struct Heat {
    history: Arc<History>,
    html: String,
}

/// Computes the temperatures of a plan as it is, or with waits for a limit between passes (°C).
#[pyfunction]
#[pyo3(signature = (plan, limit, threads, progress))]
pub(crate) fn heat<'py>(
    py: Python<'py>,
    plan: &Plan,
    limit: Option<f64>,
    threads: Option<usize>,
    progress: Option<Bound<'py, PyAny>>,
) -> PyResult<Heat> {
    let planned = &plan.0;
    let (name, profile) = (&planned.header.part, &planned.profile);
    let usual = Interpass { max_temperature: 0.0, min_temperature: None, reorder: true, along: false };
    // Without a limit, the plan keeps the waits for its own limit.
    let interpass = limit.map(|max_temperature| Interpass { max_temperature, ..profile.interpass.unwrap_or(usual) });
    let least = profile.heat.as_ref().map_or(30.0, |heat| heat.ambient + 10.0);
    if let Some(limit) = limit.filter(|limit| !(least..=1500.0).contains(limit)) {
        let message = format!("limit = {limit} is impossible here; {least:.0} to 1500 °C is possible.");
        return Err(raise(&message, Some("limit"), None));
    }
    let over = Some(planned.header.extent.seen_from_above());
    let settings = HeatSettings { interpass, over, ..profile.heat_settings().refuse(Some(name))? };
    let mut layers = planned.layers.to_vec();
    if interpass.is_some() {
        layers.iter_mut().flat_map(|layer| &mut layer.passes).for_each(|pass| pass.wait = 0.0);
    }
    let weld = profile.weld_settings();
    let history = Running::new(threads, progress)
        .run(py, Some(name), |task| library::history(&mut layers, &settings, &weld, task))?;
    let Some(history) = history else {
        return Err(raise("the plan has no passes.", Some(name), None));
    };
    let limits = interpass.or(profile.interpass);
    let html = temperature::page(name, &layers, &history, limits.as_ref()).html();
    Ok(Heat { history: Arc::new(history), html })
}

#[pymethods]
impl Heat {
    /// All of it, as `beadwright heat --json` prints it.
    #[getter]
    fn values<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        Ok(pythonize::pythonize(py, &*self.history)?)
    }

    /// Number of passes of each layer.
    #[getter]
    fn passes(&self) -> Vec<usize> {
        self.history.layers.iter().map(|layer| layer.passes.len()).collect()
    }

    /// Temperatures just ahead of the torch along a pass, °C; both counted from 0.
    fn along(&self, layer: usize, number: usize) -> PyResult<Array> {
        let known = self.history.layers.get(layer).is_some_and(|layer| number < layer.passes.len());
        if !known {
            return Err(raise(&format!("layer {layer} has no pass {number}; both count from 0."), Some("pass"), None));
        }
        Ok(Array::list(AlongPass { history: self.history.clone(), layer, pass: number }))
    }

    #[getter]
    fn html(&self) -> &str {
        &self.html
    }
}

struct AlongPass {
    history: Arc<History>,
    layer: usize,
    pass: usize,
}

impl Numbers for AlongPass {
    fn bytes(&self) -> &[u8] {
        bytemuck::cast_slice(&self.history.layers[self.layer].passes[self.pass].along)
    }
}
