//! The part that is planned, placed on z = 0.

use crate::array::{Array, Item, Numbers};
use crate::error::{Refuse, raise};
use crate::profile::Profile;
use crate::running::Running;
use beadwright::directions::{Found, Outcome, Settings, Tried, tried};
use beadwright::model::{self, Import, Model, Placement, Units, units};
use beadwright::plan::stock::Stocked;
use beadwright::preform::{faces, figures::Figures};
use beadwright::{Mesh, example, model::PartError};
use glam::DVec3;
use pyo3::buffer::PyBuffer;
use pyo3::prelude::*;
use std::borrow::Cow;
use std::sync::Arc;

/// Names of the example parts.
#[pyfunction]
pub(crate) fn example_names() -> Vec<&'static str> {
    example::ALL.iter().map(|part| part.name).collect()
}

/// The bytes of the STL file of an example part.
#[pyfunction]
pub(crate) fn example_stl(name: &str) -> PyResult<Cow<'static, [u8]>> {
    let found = example::find(name).map(|part| part.stl().into());
    let known = || format!("there is no example part \"{name}\"; the parts are {}.", example_names().join(", "));
    found.ok_or_else(|| raise(&known(), Some("name"), None))
}

/// How a part is placed: unit, factor, turn about x, y and z (°), whether its middle is moved to x = y = 0, how far it is then
/// moved along x and y (mm), how it is laid ("flat" or "orient"), and where it ends (mm).
type Placing = (Option<String>, f64, [f64; 3], bool, [f64; 2], Option<String>, Option<f64>);

/// A part.
#[pyclass(frozen, module = "beadwright._core")]
pub(crate) struct Part {
    pub(crate) name: String,
    pub(crate) part: Arc<model::Part>,
    /// Size in the file's units, where these are a guess.
    guessed: Option<DVec3>,
    /// Mass, time and cost of a preform; `None` for a part as it is drawn.
    figures: Option<Figures>,
}

impl Part {
    /// Refuses a part whose unit is a guess, and which is too small for the bead to be millimetres.
    pub(crate) fn fits(&self, bead_width: f64) -> Result<(), PartError> {
        self.guessed.map_or(Ok(()), |size| Ok(units::guess(size, bead_width).map(drop)?))
    }

    fn of(name: String, model: Model, placing: Placing) -> PyResult<Self> {
        let (units, scale, turn, centre, shift, stand, height) = placing;
        let units = units.map(|unit| unit_of(&unit)).transpose()?;
        let placement = Placement { units, scale, turn: turn.into(), centre, shift: shift.into() };
        let guessed = guessed_size(&model, &placement);
        // No bead is known yet: the guess is judged when the part is planned.
        let place = |model: Model, placement: &Placement| model.place(placement, height, 0.0).refuse(Some(&name));
        let part = match stand {
            None => place(model, &placement)?,
            Some(stand) => {
                let part = place(model.clone(), &placement)?;
                let turn = part.mesh().map_or(placement.turn, |mesh| match &*stand {
                    "orient" => placement.least_overhang(mesh),
                    _ => placement.laid_flat(mesh),
                });
                place(model, &Placement { turn, ..placement })?
            }
        };
        Ok(Self { name, part: Arc::new(part), guessed, figures: None })
    }
}

/// A unit by its name.
pub(crate) fn unit_of(unit: &str) -> PyResult<Units> {
    let found = Units::ALL.iter().find(|(name, _)| *name == unit).map(|(_, units)| *units);
    found.ok_or_else(|| raise(&format!("\"{unit}\" is not a unit; use mm, cm, m or in."), Some("units"), None))
}

impl Part {
    /// The mesh of a solid.
    pub(crate) fn solid(&self) -> PyResult<&Mesh> {
        let curves =
            || raise("this is a wall given by curves, and it has no surface to compare.", Some(&self.name), None);
        self.part.mesh().ok_or_else(curves)
    }
}

/// The size of a model whose unit was not given, before it is turned.
fn guessed_size(model: &Model, placement: &Placement) -> Option<DVec3> {
    let (declared, size) = match model {
        Model::Mesh(import) => (import.units, import.mesh.size()),
        Model::Outlines(outlines) => (outlines.units, outlines.size().extend(0.0)),
        Model::Curves(_) => return None,
    };
    placement.units.or(declared).is_none().then_some(size * placement.scale)
}

#[pymethods]
impl Part {
    /// A part from the bytes of a file.
    #[staticmethod]
    fn read(
        py: Python<'_>,
        name: String,
        place: &str,
        bytes: &[u8],
        damaged: bool,
        placing: Placing,
    ) -> PyResult<Self> {
        let read = if damaged { Model::read_damaged } else { Model::read };
        let model = Running::new(Some(1), None).run(py, Some(place), |task| read(bytes, task))?;
        Self::of(name, model, placing)
    }

    /// A part from corners (three numbers each) and triangles (three indices each).
    #[staticmethod]
    fn from_triangles(
        py: Python<'_>,
        name: String,
        vertices: PyBuffer<f64>,
        triangles: PyBuffer<u32>,
        placing: Placing,
    ) -> PyResult<Self> {
        let (vertices, triangles) = (vertices.to_vec(py)?, triangles.to_vec(py)?);
        let corners: Vec<DVec3> = vertices.as_chunks::<3>().0.iter().copied().map(DVec3::from_array).collect();
        let triangles = triangles.as_chunks::<3>().0.to_vec();
        let import = solid(corners, triangles).map_err(|error| raise(&error, Some(&name), None))?;
        Self::of(name, Model::Mesh(import), placing)
    }

    #[getter]
    fn name(&self) -> &str {
        &self.name
    }

    /// Whether it is a solid; a wall given by curves is not.
    #[getter]
    fn is_solid(&self) -> bool {
        self.part.mesh().is_some()
    }

    /// Lowest and highest coordinates, mm.
    #[getter]
    fn bounds(&self) -> ([f64; 3], [f64; 3]) {
        let (low, high) = self.part.bounds();
        (low.to_array(), high.to_array())
    }

    /// Volume, mm³; none for curves.
    #[getter]
    fn volume(&self) -> Option<f64> {
        self.part.mesh().map(Mesh::volume)
    }

    #[getter]
    fn vertices(&self) -> Option<Array> {
        self.part.mesh().map(|_| Array::rows(Vertices(self.part.clone()), Item::Float, 3))
    }

    #[getter]
    fn faces(&self) -> Option<Array> {
        self.part.mesh().map(|_| Array::rows(Triangles(self.part.clone()), Item::Index, 3))
    }

    /// What was mended or is not read, as sentences.
    #[getter]
    fn notes(&self) -> Vec<String> {
        self.part.warnings()
    }

    /// What lies above a height (mm), set onto z = 0.
    fn above(&self, z: f64) -> PyResult<Self> {
        let part = model::Part::clone(&self.part).above(z).refuse(Some(&self.name))?;
        Ok(Self { name: self.name.clone(), part: Arc::new(part), guessed: self.guessed, figures: self.figures })
    }

    /// The preform of a solid.
    fn preform(&self, py: Python<'_>, profile: &Profile) -> PyResult<Self> {
        self.fits(profile.profile.bead.width).refuse(Some(&self.name))?;
        let part = model::Part::clone(&self.part);
        let made = |task: &_| Stocked::of(part, &profile.profile, task);
        let Stocked { part, figures, .. } = Running::new(None, None).run(py, Some(&self.name), made)?;
        Ok(Self { name: self.name.clone(), part: Arc::new(part), guessed: None, figures: Some(figures) })
    }

    /// Ways to divide a solid into bodies, those that can be welded first, and at last the whole of it in level layers.
    fn directions<'py>(
        &self,
        py: Python<'py>,
        profile: &Profile,
        lean: f64,
        tilt: f64,
    ) -> PyResult<Vec<Bound<'py, PyAny>>> {
        let bead = profile.profile.bead.width;
        self.fits(bead).refuse(Some(&self.name))?;
        let settings = Settings { lean, tilt, bead };
        let made = |task: &_| tried(&self.name, &self.part, &profile.profile, false, settings, task);
        let Found { divisions, .. } = Running::new(None, None).run(py, Some(&self.name), made)?;
        let as_values = |Tried { division, bodies, outcome }: &Tried| {
            let (metrics, refused) = match outcome {
                Outcome::Planned(metrics) => (Some(metrics), None),
                Outcome::Refused { reason, .. } => (None, Some(reason)),
                Outcome::Untried => (None, None),
            };
            let value = serde_json::json!({
                "bodies": bodies,
                "overhang": division.hanging,
                "tilt": division.tilt,
                "lean": division.lean,
                "metrics": metrics,
                "refused": refused,
            });
            Ok(pythonize::pythonize(py, &value)?)
        };
        divisions.iter().map(as_values).collect()
    }

    /// Mass, time and cost of a preform; `None` for a part as it is drawn.
    #[getter]
    fn figures<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        Ok(self.figures.as_ref().map(|figures| pythonize::pythonize(py, figures)).transpose()?)
    }

    /// The faces of the part that is milled from a preform, with the metal over them; empty for a part as it is drawn.
    #[getter]
    fn milled_faces<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let faces = self.part.milled().map(|milled| faces::faces(&milled.mesh, &milled.stock)).unwrap_or_default();
        Ok(pythonize::pythonize(py, &faces)?)
    }
}

/// A mended solid, or why there is none.
fn solid(corners: Vec<DVec3>, triangles: Vec<[u32; 3]>) -> Result<Import, String> {
    if let Some(at) = corners.iter().position(|corner| !corner.is_finite()) {
        return Err(format!("corner {at} (counted from 0) has a coordinate that is not a finite number."));
    }
    let strange = triangles.iter().position(|triangle| triangle.iter().any(|&corner| corner as usize >= corners.len()));
    if let Some(at) = strange {
        let count = corners.len();
        return Err(format!("triangle {at} (counted from 0) names a corner that does not exist; there are {count}."));
    }
    let read = triangles.len();
    let (mesh, repair) = Mesh::from_triangles(corners, triangles);
    let area = |&[a, b, c]: &[u32; 3]| {
        let [a, b, c] = [a, b, c].map(|corner| mesh.vertices[corner as usize]);
        (b - a).cross(c - a).length_squared()
    };
    if !mesh.triangles.iter().any(|triangle| area(triangle) > 0.0) {
        return Err(format!("there is no triangle with an area ({read} given), so there is nothing to build."));
    }
    Ok(Import { mesh, repair, format: "triangles", units: None, objects: Vec::new(), notes: Vec::new(), milled: None })
}

struct Vertices(Arc<model::Part>);
struct Triangles(Arc<model::Part>);

impl Numbers for Vertices {
    fn bytes(&self) -> &[u8] {
        self.0.mesh().map_or(&[], |mesh| bytemuck::cast_slice(&mesh.vertices))
    }
}

impl Numbers for Triangles {
    fn bytes(&self) -> &[u8] {
        self.0.mesh().map_or(&[], |mesh| bytemuck::cast_slice(&mesh.triangles))
    }
}
