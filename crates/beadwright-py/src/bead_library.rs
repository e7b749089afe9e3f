//! Measured beads: fitted, predicted, and solved for.

use crate::error::{Refuse, raise};
use beadwright::bead::Overlap;
use beadwright::bead::library::{self, Columns, Layering, Limit, Measured, Prediction, Wish};
use beadwright::report::bead_window;
use pyo3::prelude::*;
use serde_json::{Value, json};

/// A library of measured beads.
#[pyclass(frozen, module = "beadwright._core")]
pub(crate) struct BeadLibrary(library::BeadLibrary);

/// Invented measurements, to try it out.
#[pyfunction]
pub(crate) fn demonstration_csv() -> String {
    library::demonstration_csv()
}

#[pymethods]
impl BeadLibrary {
    /// Fits width and height of the beads of a CSV table.
    #[staticmethod]
    #[pyo3(signature = (text, place, inputs, width, height))]
    fn fit(
        text: &str,
        place: Option<&str>,
        inputs: Option<Vec<String>>,
        width: String,
        height: String,
    ) -> PyResult<Self> {
        let columns = Columns { inputs, width: Some(width), height: Some(height) };
        let measured = Measured::read(text, &columns).refuse(place)?;
        Ok(Self(library::BeadLibrary::fit(&measured).refuse(place)?))
    }

    /// Reads a library.
    #[staticmethod]
    #[pyo3(signature = (text, place))]
    fn parse(text: &str, place: Option<&str>) -> PyResult<Self> {
        Ok(Self(library::BeadLibrary::parse(text).refuse(place)?))
    }

    fn toml(&self) -> String {
        self.0.to_toml()
    }

    /// All of it.
    #[getter]
    fn values<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        Ok(pythonize::pythonize(py, &self.0)?)
    }

    /// The bead for given parameters.
    #[pyo3(signature = (values, overlap))]
    fn predict<'py>(
        &self,
        py: Python<'py>,
        values: Vec<(String, f64)>,
        overlap: Option<&str>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let values = self.0.arrange(&values).refuse(None)?;
        let found = self.0.predict(&values).refuse(None)?;
        let height = layering(overlap, found.width.value)?.height(&found);
        Ok(pythonize::pythonize(py, &self.as_json(&values, &found, height, &[]))?)
    }

    /// Parameters for a wanted bead; `limits` are names with least and greatest value, `tolerance` is relative.
    #[pyo3(signature = (width, layer_height, overlap, limits, tolerance))]
    fn solve<'py>(
        &self,
        py: Python<'py>,
        width: f64,
        layer_height: f64,
        overlap: Option<&str>,
        limits: Vec<(String, f64, f64)>,
        tolerance: f64,
    ) -> PyResult<Bound<'py, PyAny>> {
        let limits = limits.into_iter().map(|(input, min, max)| Limit { input, min, max }).collect();
        let layering = layering(overlap, width)?;
        let wish = Wish { width, layer_height, layering, limits, tolerance };
        let recipe = self.0.solve(&wish).refuse(None)?;
        let recipe_json = self.as_json(&recipe.values, &recipe.prediction, recipe.layer_height, &recipe.notes);
        Ok(pythonize::pythonize(py, &recipe_json)?)
    }

    /// Width over height of the beads over their inputs, as a picture.
    fn svg(&self) -> String {
        bead_window::plot(&self.0).svg()
    }
}

impl BeadLibrary {
    fn as_json(&self, values: &[f64], found: &Prediction, layer_height: f64, notes: &[String]) -> Value {
        let inputs = self.0.inputs.iter().zip(values);
        let parameters: serde_json::Map<String, Value> =
            inputs.map(|(input, value)| (input.name.clone(), json!({ "value": value, "unit": input.unit }))).collect();
        json!({
            "synthetic": self.0.synthetic, "parameters": parameters, "width_mm": found.width, "height_mm": found.height,
            "width_over_height": found.ratio(), "leverage": found.leverage, "layer_height_mm": layer_height,
            "notes": notes,
        })
    }
}

/// What a layer's height means for beads of `width` mm: `tangent`, `inclined-flat-top` or a stepover in mm; without one,
/// a layer is a single bead.
fn layering(overlap: Option<&str>, width: f64) -> PyResult<Layering> {
    let ratio = |overlap: Overlap| overlap.ratio().unwrap_or(1.0) * width;
    let stepover = match overlap {
        None => return Ok(Layering::SinglePass),
        Some("tangent") => ratio(Overlap::Tangent),
        Some("inclined-flat-top") => ratio(Overlap::InclinedFlatTop),
        Some(text) => text.parse().ok().filter(|step: &f64| step.is_finite() && *step > 0.0).ok_or_else(|| {
            let expected = "tangent, inclined-flat-top, or a stepover above 0 mm";
            raise(&format!("overlap = {text} is impossible: {expected} is expected."), Some("overlap"), None)
        })?,
    };
    Ok(Layering::Overlapping { stepover })
}
