//! Layers and their passes. All of them are views of one list of layers that never changes.

use crate::array::{Array, Item, Numbers};
use beadwright::planar::Ring;
use beadwright::{Along, layer, pass, report};
use pyo3::prelude::*;
use std::sync::Arc;

/// The layers of a plan.
pub(crate) type Layers = Arc<Vec<layer::Layer>>;

/// A layer.
#[pyclass(frozen, module = "beadwright._core")]
pub(crate) struct Layer {
    layers: Layers,
    at: usize,
}

impl Layer {
    /// All of them.
    pub(crate) fn all(layers: &Layers) -> Vec<Self> {
        (0..layers.len()).map(|at| Self { layers: layers.clone(), at }).collect()
    }

    fn layer(&self) -> &layer::Layer {
        &self.layers[self.at]
    }

    fn ring(&self, island: usize, hole: Option<usize>) -> Array {
        Array::rows(RingPoints { layers: self.layers.clone(), at: self.at, island, hole }, Item::Float, 2)
    }
}

#[pymethods]
impl Layer {
    /// Index from 0.
    #[getter]
    fn index(&self) -> usize {
        self.layer().index
    }

    /// Its top, mm.
    #[getter]
    fn z(&self) -> f64 {
        self.layer().z
    }

    /// Its thickness, mm.
    #[getter]
    fn height(&self) -> f64 {
        self.layer().height
    }

    /// Area of the slice, mm².
    #[getter]
    fn slice_area(&self) -> f64 {
        self.layer().slice_area
    }

    /// Area that beads cover, mm².
    #[getter]
    fn planned_area(&self) -> f64 {
        self.layer().planned_area
    }

    /// Outer ring and holes of each island.
    #[getter]
    fn islands(&self) -> Vec<(Array, Vec<Array>)> {
        let island = |(at, island): (usize, &beadwright::planar::Polygon)| {
            (self.ring(at, None), (0..island.holes.len()).map(|hole| self.ring(at, Some(hole))).collect())
        };
        self.layer().islands.iter().enumerate().map(island).collect()
    }

    /// Passes in the order in which they are welded.
    #[getter]
    fn passes(&self) -> Vec<Pass> {
        let pass = |pass| Pass { layers: self.layers.clone(), layer: self.at, pass };
        (0..self.layer().passes.len()).map(pass).collect()
    }

    /// Its picture.
    fn svg(&self, title: &str) -> String {
        report::svg::layer(self.layer(), title)
    }
}

/// A pass.
#[pyclass(frozen, skip_from_py_object, module = "beadwright._core")]
#[derive(Clone)]
pub(crate) struct Pass {
    layers: Layers,
    layer: usize,
    pass: usize,
}

impl Pass {
    fn pass(&self) -> &pass::Pass {
        &self.layers[self.layer].passes[self.pass]
    }

    fn along(&self, which: Value) -> Array {
        let values = PassValues { pass: self.clone(), which };
        match values.along() {
            Along::Same(_) => {
                let count = self.pass().points.len();
                Array::same(values, count)
            }
            Along::Each(_) => Array::list(values),
        }
    }
}

#[pymethods]
impl Pass {
    /// What it is for: contour, infill, skeleton, wall or spot.
    #[getter]
    fn kind(&self) -> &'static str {
        self.pass().kind.name()
    }

    #[getter]
    fn closed(&self) -> bool {
        self.pass().closed
    }

    /// Wait before it, s.
    #[getter]
    fn wait(&self) -> f64 {
        self.pass().wait
    }

    /// Length, mm.
    #[getter]
    fn length(&self) -> f64 {
        self.pass().length()
    }

    #[getter]
    fn points(&self) -> Array {
        Array::rows(PassPoints(self.clone()), Item::Float, 3)
    }

    #[getter]
    fn width(&self) -> Array {
        self.along(Value::Width)
    }

    #[getter]
    fn pace(&self) -> Array {
        self.along(Value::Pace)
    }
}

struct PassPoints(Pass);

impl Numbers for PassPoints {
    fn bytes(&self) -> &[u8] {
        bytemuck::cast_slice(&self.0.pass().points)
    }
}

#[derive(Clone, Copy)]
enum Value {
    Width,
    Pace,
}

struct PassValues {
    pass: Pass,
    which: Value,
}

impl PassValues {
    fn along(&self) -> &Along {
        let pass = self.pass.pass();
        match self.which {
            Value::Width => &pass.width,
            Value::Pace => &pass.pace,
        }
    }
}

impl Numbers for PassValues {
    fn bytes(&self) -> &[u8] {
        match self.along() {
            Along::Same(value) => bytemuck::bytes_of(value),
            Along::Each(values) => bytemuck::cast_slice(values),
        }
    }
}

struct RingPoints {
    layers: Layers,
    at: usize,
    island: usize,
    hole: Option<usize>,
}

impl RingPoints {
    fn ring(&self) -> &Ring {
        let island = &self.layers[self.at].islands[self.island];
        self.hole.map_or(&island.outer, |hole| &island.holes[hole])
    }
}

impl Numbers for RingPoints {
    fn bytes(&self) -> &[u8] {
        bytemuck::cast_slice(self.ring().points())
    }
}
