//! Turns a model file into a part: a solid or the centre-lines of a wall, in mm, turned, and standing on z = 0.

use super::cut;
use super::iges::{self, IgesError, IgesFile};
use super::outline::{self, Outlines};
use super::stand;
use super::units::{self, UnitsUnclear};
use super::wall_curves::{self, WallCurves, WallCurvesError};
use super::{
    Import, ImportError, MAX_REACH_MM, Mesh, Milled, RepairReport, Units, decoded, import, import_damaged, is_iges,
};
use crate::task::Task;
use glam::{DAffine3, DMat3, DQuat, DVec2, DVec3, EulerRot};
use planar::Bounds;
use serde::{Deserialize, Serialize};

/// A model as it was read.
#[derive(Debug, Clone, PartialEq)]
pub enum Model {
    /// A solid, in the units of the file.
    Mesh(Import),
    /// Curves.
    Curves(IgesFile),
    /// Outlines, to be extruded into a solid.
    Outlines(Outlines),
}

/// How a model is placed. The default leaves it as it is, and guesses the unit.
///
/// ```
/// use bead_part::model::{Model, Placement};
/// use bead_part::{example, task::Task};
/// use glam::DVec3;
///
/// // A wall of 120 × 4.5 × 72 mm, laid on its side.
/// let bytes = example::find("wall").ok_or("no such example")?.stl();
/// let lying = Placement { turn: DVec3::new(90.0, 0.0, 0.0), ..Placement::default() };
/// let (low, high) = Model::read(&bytes, &Task::new())?.place(&lying, None, 4.0)?.bounds();
/// assert_eq!(low.z, 0.0);
/// assert!((high - low).distance(DVec3::new(120.0, 72.0, 4.5)) < 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Placement {
    /// Unit of the coordinates; if not given, that of the file, or a guess.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub units: Option<Units>,
    /// Factor by which the part is scaled.
    pub scale: f64,
    /// Turns the part about x, then y, then z, °.
    pub turn: DVec3,
    /// Centres the part's extent on x = y = 0.
    pub centre: bool,
    /// Moves the part along x and y after everything else, mm.
    pub shift: DVec2,
}

impl Default for Placement {
    fn default() -> Self {
        Self { units: None, scale: 1.0, turn: DVec3::ZERO, centre: false, shift: DVec2::ZERO }
    }
}

/// The part to be planned.
#[derive(Debug, Clone, PartialEq)]
#[expect(clippy::large_enum_variant, reason = "there is one part at a time")]
pub enum Part {
    /// A solid that stands on z = 0.
    Mesh(Import),
    /// The centre-lines of a wall.
    Curves {
        /// The curves.
        curves: WallCurves,
        /// Height at which the wall ends, mm.
        height: f64,
        /// What was wrong with the file, as sentences.
        warnings: Vec<String>,
    },
}

/// A part to be planned: a [`Part`], or a solid alone.
#[derive(Debug, Clone, Copy)]
pub enum PartRef<'a> {
    /// A solid that stands on z = 0.
    Mesh {
        /// The solid to be welded.
        mesh: &'a Mesh,
        /// The part milled from it afterwards ([`Import::milled`]).
        milled: Option<&'a Mesh>,
        /// An existing part on which it is welded.
        onto: Option<&'a Mesh>,
    },
    /// The centre-lines of a wall, and the height at which it ends, mm.
    Curves(&'a WallCurves, f64),
}

impl<'a> PartRef<'a> {
    /// The same solid, welded onto an existing part; curves are unchanged.
    pub fn onto(self, base: &'a Mesh) -> Self {
        match self {
            Self::Mesh { mesh, milled, .. } => Self::Mesh { mesh, milled, onto: Some(base) },
            curves @ Self::Curves(..) => curves,
        }
    }

    /// Lowest and highest coordinates, mm.
    pub fn bounds(self) -> (DVec3, DVec3) {
        match self {
            Self::Mesh { mesh, .. } => mesh.bounds(),
            Self::Curves(curves, height) => {
                let bounds = curve_bounds(curves, height);
                (bounds.min.extend(0.0), bounds.max.extend(height))
            }
        }
    }
}

impl<'a> From<&'a Import> for PartRef<'a> {
    fn from(import: &'a Import) -> Self {
        Self::Mesh { mesh: &import.mesh, milled: import.milled.as_ref().map(|milled| &milled.mesh), onto: None }
    }
}

impl<'a> From<&'a Part> for PartRef<'a> {
    fn from(part: &'a Part) -> Self {
        match part {
            Part::Mesh(import) => import.into(),
            Part::Curves { curves, height, .. } => Self::Curves(curves, *height),
        }
    }
}

impl<'a> From<&'a Mesh> for PartRef<'a> {
    fn from(mesh: &'a Mesh) -> Self {
        Self::Mesh { mesh, milled: None, onto: None }
    }
}

/// Why a model cannot become a part.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PartError {
    /// The file holds no solid.
    #[error(transparent)]
    Import(#[from] ImportError),
    /// The IGES file cannot be read.
    #[error(transparent)]
    Iges(#[from] IgesError),
    /// The curves are not those of a wall.
    #[error(transparent)]
    Curves(#[from] WallCurvesError),
    /// The unit must be given.
    #[error(transparent)]
    Units(#[from] UnitsUnclear),
    /// A height was given for a solid.
    #[error("a height belongs to walls given by curves (IGES) and to outlines (DXF, SVG), not to a solid")]
    HeightOfSolid,
    /// All curves or outlines lie at one height, and no height for the top of the part was given.
    #[error("the curves lie at one height: say how high the part is, mm")]
    NoHeight,
    /// Nothing remains above the plane at which the part is cut.
    #[error("the part is {top:.2} mm high, so nothing of it lies above {z} mm")]
    NothingAbove {
        /// Height of the part, mm.
        top: f64,
        /// Height of the plane, mm.
        z: f64,
    },
    /// Curves cannot be cut.
    #[error("a part given by curves cannot be cut by a plane; give its solid")]
    CurvesUncut,
}

impl Model {
    /// Reads a solid, curves or outlines. The content decides, not the file's name.
    ///
    /// ```
    /// use bead_part::model::{Model, Placement};
    /// use bead_part::{example, task::Task};
    /// use glam::DVec3;
    ///
    /// // A wall of 120 × 4.5 × 72 mm.
    /// let bytes = example::find("wall").ok_or("no such example")?.stl();
    /// let part = Model::read(&bytes, &Task::new())?.place(&Placement::default(), None, 4.0)?;
    /// let (low, high) = part.bounds();
    /// assert_eq!(high - low, DVec3::new(120.0, 4.5, 72.0));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`PartError`].
    pub fn read(bytes: &[u8], task: &Task) -> Result<Self, PartError> {
        Self::read_by(import, bytes, task)
    }

    /// Like [`Self::read`], but accepts a damaged solid as it is, with a warning; see [`import_damaged`].
    ///
    /// # Errors
    /// [`PartError`].
    pub fn read_damaged(bytes: &[u8], task: &Task) -> Result<Self, PartError> {
        Self::read_by(import_damaged, bytes, task)
    }

    fn read_by(
        import: fn(&[u8], &Task) -> Result<Import, ImportError>,
        bytes: &[u8],
        task: &Task,
    ) -> Result<Self, PartError> {
        let bytes = &*decoded(bytes)?;
        Ok(if is_iges(bytes) {
            Self::Curves(iges::read(bytes)?)
        } else if outline::drawing(bytes).is_some() {
            Self::Outlines(outline::read(bytes)?)
        } else {
            Self::Mesh(import(bytes, task)?)
        })
    }

    /// Places the model as a part. Outlines, and curves that all lie at one height, need the `height` (mm) of the
    /// part's top. `bead_width` (mm) helps to guess the unit.
    ///
    /// # Errors
    /// [`PartError`].
    pub fn place(self, placement: &Placement, height: Option<f64>, bead_width: f64) -> Result<Part, PartError> {
        match self {
            Self::Mesh(_) if height.is_some() => Err(PartError::HeightOfSolid),
            Self::Mesh(import) => Ok(Part::Mesh(placement.solid(import, bead_width)?)),
            Self::Curves(file) => placement.wall(&file, height),
            Self::Outlines(outlines) => placement.grown(&outlines, height, bead_width),
        }
    }
}

impl Placement {
    /// A placed solid.
    ///
    /// # Errors
    /// [`PartError::Units`] if the unit must be given, [`ImportError::TooFar`].
    pub fn solid(&self, mut import: Import, bead_width: f64) -> Result<Import, PartError> {
        let units = match self.units.or(import.units) {
            Some(units) => units,
            None => units::guess(import.mesh.size() * self.scale, bead_width)?,
        };
        if let (Some(given), Some(_)) = (self.units.filter(|units| units.in_mm() != 1.0), import.units) {
            import.notes.push(format!(
                "The file states its own unit; the one given is applied on top of it, so the part is {} times as large: leave it out.",
                given.in_mm()
            ));
        }
        let mesh = &mut import.mesh;
        let placed = mesh.place(units.in_mm() * self.scale, self.turn);
        let (low, high) = mesh.bounds();
        let middle = if self.centre { ((low + high) / 2.0).truncate() } else { DVec2::ZERO };
        let by = (self.shift - middle).extend(0.0);
        if by != DVec3::ZERO {
            mesh.vertices.iter_mut().for_each(|vertex| *vertex += by);
        }
        mesh.check_reach()?;
        let points = import.objects.iter_mut().flat_map(|object| &mut object.at);
        points.for_each(|point| *point = placed.transform_point3(*point) + by);
        Ok(import)
    }

    /// A placed solid and the existing part it is welded onto, placed together: in their files they share coordinates.
    ///
    /// # Errors
    /// Those of [`Self::solid`].
    pub fn solid_onto(&self, import: Import, base: Import, bead_width: f64) -> Result<(Import, Mesh), PartError> {
        let (mesh, own) = (import.mesh.clone(), import.mesh.vertices.len());
        let mut joint = mesh.clone();
        joint.vertices.extend(&base.mesh.vertices);
        let units = import.units.or(base.units);
        let placed = self.solid(Import { mesh: joint, units, ..import }, bead_width)?;
        let (vertices, below) = placed.mesh.vertices.split_at(own);
        let base = Mesh { vertices: below.to_vec(), ..base.mesh };
        Ok((Import { mesh: Mesh { vertices: vertices.to_vec(), ..mesh }, ..placed }, base))
    }

    fn grown(&self, outlines: &Outlines, height: Option<f64>, bead_width: f64) -> Result<Part, PartError> {
        let height = height.ok_or(PartError::NoHeight)?;
        let units = match self.units.or(outlines.units) {
            Some(units) => units,
            None => units::guess(outlines.size().extend(0.0) * self.scale, bead_width)?,
        };
        let factor = units.in_mm() * self.scale;
        let reach = factor * outlines.reach();
        if reach.is_nan() || reach > MAX_REACH_MM {
            return Err(ImportError::TooFar { reach_m: reach / 1000.0 }.into());
        }
        let import = outlines.extruded(factor, height)?;
        Ok(Part::Mesh(Self { scale: 1.0, units: None, ..*self }.solid(import, bead_width)?))
    }

    fn wall(&self, file: &IgesFile, height: Option<f64>) -> Result<Part, PartError> {
        let unit = self.units.map_or(1.0, |units| units.in_mm() / file.unit_mm);
        let turn = self.turn * std::f64::consts::PI / 180.0;
        let turn = DQuat::from_rotation_z(turn.z) * DQuat::from_rotation_y(turn.y) * DQuat::from_rotation_x(turn.x);
        let place = DAffine3::from_scale_rotation_translation(DVec3::splat(unit * self.scale), turn, DVec3::ZERO);
        check_reach(file, unit * self.scale, self.shift)?;
        if let Some((mesh, repair)) = wall_curves::ruled(file, &place) {
            let (objects, notes, units) = (Vec::new(), file.warnings.clone(), Some(Units::Millimetre));
            let import = Import { mesh, repair, format: "IGES", units, objects, notes, milled: None };
            return self.between_edges(import, height);
        }
        let mut curves = WallCurves::of_iges(file, &place)?;
        let height = height.or(Some(curves.height()).filter(|height| *height > 0.0)).ok_or(PartError::NoHeight)?;
        let middle = if self.centre { curve_bounds(&curves, height).center() } else { DVec2::ZERO };
        if self.shift != middle {
            let by = (self.shift - middle).extend(0.0);
            curves = WallCurves::of_iges(file, &(DAffine3::from_translation(by) * place))?;
        }
        let unread = file.entities.iter().filter(|e| e.unread > 0);
        let unread = unread.map(|e| format!("{} of entity {} ({}) not read.", e.unread, e.entity, e.name));
        let warnings = file.warnings.iter().cloned().chain(unread).collect();
        Ok(Part::Curves { curves, height, warnings })
    }

    /// The wall between two edges that are not level, already scaled and turned.
    fn between_edges(&self, mut import: Import, height: Option<f64>) -> Result<Part, PartError> {
        if height.is_some() {
            return Err(PartError::HeightOfSolid);
        }
        let note =
            "The two curves are not level: they are taken for the edges of a wall, which is straight between them.";
        import.notes.push(note.to_owned());
        let placed = Self { units: None, scale: 1.0, turn: DVec3::ZERO, ..*self };
        // The unit is known, so no bead is needed to guess it.
        Ok(Part::Mesh(placed.solid(import, 0.0)?))
    }

    /// The turn, °, that lays the part flat: the largest flat face on which it can stand comes to lie at z = 0. `mesh`
    /// is the part as currently placed. Without such a face the turn is unchanged.
    ///
    /// ```
    /// use bead_part::{example, model::Placement};
    ///
    /// // The largest faces of a wall are its sides, and it is 4.5 mm thick.
    /// let mut wall = example::find("wall").ok_or("no such example")?.mesh();
    /// let turn = Placement::default().laid_flat(&wall);
    /// wall.place(1.0, turn);
    /// assert!((wall.size().z - 4.5).abs() < 1e-6);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn laid_flat(&self, mesh: &Mesh) -> DVec3 {
        stand::faces(mesh).next().map_or(self.turn, |face| self.turned_onto(face))
    }

    /// The turn, °, with the least overhang, among the flat faces on which the part can stand; if several are equal,
    /// the lowest part. `mesh` is the part as currently placed. Without such a face the turn is unchanged.
    pub fn least_overhang(&self, mesh: &Mesh) -> DVec3 {
        stand::least_overhang(mesh).map_or(self.turn, |face| self.turned_onto(face))
    }

    /// The turn, °, after which a face whose normal (of length 1) is now `normal` points down.
    pub fn turned_onto(&self, normal: DVec3) -> DVec3 {
        let [x, y, z] = self.turn.map(f64::to_radians).to_array();
        let now = DMat3::from_rotation_z(z) * DMat3::from_rotation_y(y) * DMat3::from_rotation_x(x);
        let turn = DMat3::from_quat(DQuat::from_rotation_arc(normal, DVec3::NEG_Z)) * now;
        // R = Rz Ry Rx, as `Mesh::place` turns.
        let (z, y, x) = turn.to_euler(EulerRot::ZYX);
        // Rounded, so that angles meant as whole degrees come out whole.
        DVec3::new(x, y, z).map(|angle| (angle.to_degrees() * 1e9).round() / 1e9)
    }

    /// The placement after moving the part by `shift` (mm) and turning it by `angle` (°) about the vertical through the
    /// middle of its extent, which is now at `foot` (mm).
    pub fn moved(&self, shift: DVec2, angle: f64, foot: DVec2) -> Self {
        // The middle of a centred part is placed by `shift` alone.
        let about = if self.centre { self.shift } else { foot };
        let turned = DVec2::from_angle(angle.to_radians()).rotate(self.shift - about);
        // Rounded, so that whole numbers come out whole.
        let shift = (about + turned + shift).map(|v| (v * 1e6).round() / 1e6);
        let z = (self.turn.z + angle + 180.0).rem_euclid(360.0) - 180.0;
        Self { shift, turn: self.turn.with_z((z * 1e9).round() / 1e9), ..*self }
    }
}

impl Part {
    /// Lowest and highest coordinates, mm.
    pub fn bounds(&self) -> (DVec3, DVec3) {
        PartRef::from(self).bounds()
    }

    /// The part above the height `z` (mm), moved down to z = 0.
    ///
    /// # Errors
    /// [`PartError::NothingAbove`], and [`PartError::CurvesUncut`] for curves.
    pub fn above(self, z: f64) -> Result<Self, PartError> {
        let Self::Mesh(import) = self else { return Err(PartError::CurvesUncut) };
        let top = import.mesh.bounds().1.z;
        let (mesh, cut) = cut::above(&import.mesh, z).ok_or(PartError::NothingAbove { top, z })?;
        // Repairs made before the cut are still reported.
        let (triangles, vertices, open_edges, shells) = (cut.triangles, cut.vertices, cut.open_edges, cut.shells);
        let repair = RepairReport { triangles, vertices, open_edges, shells, ..import.repair };
        let mut milled = import.milled;
        milled.iter_mut().for_each(|milled| milled.shift(DVec3::NEG_Z * z));
        let mut objects = import.objects;
        for object in &mut objects {
            object.at.iter_mut().for_each(|point| point.z -= z);
            object.at.retain(|point| point.z >= 0.0);
        }
        Ok(Self::Mesh(Import { mesh, repair, milled, objects, ..import }))
    }

    /// The solid; `None` for curves.
    pub fn mesh(&self) -> Option<&Mesh> {
        match self {
            Self::Mesh(import) => Some(&import.mesh),
            Self::Curves { .. } => None,
        }
    }

    /// For a preform, the part milled from it.
    pub fn milled(&self) -> Option<&Milled> {
        match self {
            Self::Mesh(import) => import.milled.as_deref(),
            Self::Curves { .. } => None,
        }
    }

    /// What was repaired; nothing for curves.
    pub fn repair(&self) -> RepairReport {
        match self {
            Self::Mesh(import) => import.repair.clone(),
            Self::Curves { .. } => RepairReport::default(),
        }
    }

    /// What was not read, as sentences, without the repairs ([`Self::repair`]).
    pub fn notes(&self) -> &[String] {
        match self {
            Self::Mesh(import) => &import.notes,
            Self::Curves { warnings, .. } => warnings,
        }
    }

    /// What was repaired or not read, as sentences.
    pub fn warnings(&self) -> Vec<String> {
        self.repair().sentences().into_iter().chain(self.notes().iter().cloned()).collect()
    }
}

/// Refuses curves that extend farther than parts may.
fn check_reach(file: &IgesFile, scale: f64, shift: DVec2) -> Result<(), ImportError> {
    let corners = file.curves.iter().flat_map(|curve| &curve.parts).map(|part| part.bounds());
    let reach = scale * corners.map(|(low, high)| low.abs().max(high.abs()).max_element()).fold(0.0, f64::max);
    let reach = reach + shift.abs().element_sum();
    // NaN is not within reach either.
    if reach <= MAX_REACH_MM { Ok(()) } else { Err(ImportError::TooFar { reach_m: reach / 1000.0 }) }
}

fn curve_bounds(curves: &WallCurves, height: f64) -> Bounds {
    curves.bounds(height).unwrap_or(Bounds { min: DVec2::ZERO, max: DVec2::ZERO })
}
