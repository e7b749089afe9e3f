//! Import: bytes become a [`Mesh`], and a [`RepairReport`] says what had to be repaired.
//!
//! | file | what it does |
//! | --- | --- |
//! | `formats` | the formats of solids, and how loose triangles become a mesh |
//! | [`stl`] | binary and ASCII STL, distinguished by content |
//! | `threemf`, `amf`, `obj`, `ply` | one other format each |
//! | `placed` | objects placed by a file, copies and assemblies |
//! | [`outline`] | drawings in DXF and SVG, whose outlines become solids |
//! | `package` | a 3MF file as an archive of files |
//! | `xml` | elements of XML files, one after another |
//! | `merge_vertices` | equal corners become one vertex |
//! | `adjacency` | which triangle lies across each edge |
//! | `connected` | which faces hang together |
//! | [`repair`] | degenerate and duplicate triangles, cracks, inconsistent winding |
//! | [`cut`] | the part of a solid above a plane |
//! | [`iges`] | curves from IGES files, and curves written as IGES |
//! | `solid` | outlines become closed meshes |
//! | `solids` | a mesh divided into its solids |
//! | `triangle` | how near a point lies to a triangle |
//! | [`units`] | is the file in millimetres or inches? |
//! | `part` | a model is placed and becomes the part that is planned |
//! | [`wall_curves`] | walls given by their centre-lines |

mod adjacency;
mod amf;
pub(crate) mod connected;
pub mod cut;
mod formats;
mod gzip;
pub mod holes;
pub mod iges;
mod merge_vertices;
mod obj;
pub mod outline;
#[doc(hidden)]
pub mod package;
mod part;
mod placed;
mod ply;
pub mod repair;
pub mod solid;
mod solids;
pub mod stand;
pub mod stl;
mod threemf;
pub mod together;
pub(crate) mod triangle;
pub mod units;
pub mod wall_curves;
#[doc(hidden)]
pub mod xml;

pub use outline::Outlines;
pub use part::{Model, Part, PartError, PartRef, Placement};
pub use ply::points as ply_points;
pub use repair::RepairReport;
pub use solids::Solids;
pub use units::Units;

use crate::task::{Cancelled, Task};
use crate::text::{self, TextError};
use glam::{DAffine3, DMat3, DVec3};
use serde::{Deserialize, Serialize};
use std::borrow::Cow;

/// Greatest distance of a part from the origin along x, y or z, mm; the 2-D grid ends at 50 m.
pub const MAX_REACH_MM: f64 = 20_000.0;

/// Means "no triangle" in [`Mesh::neighbours`].
pub const NO_NEIGHBOUR: u32 = u32::MAX;

/// A triangle mesh, mm, wound counter-clockwise seen from outside.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Mesh {
    /// Welded vertices, mm.
    pub vertices: Vec<DVec3>,
    /// Corners of each triangle.
    pub triangles: Vec<[u32; 3]>,
    /// For each triangle, the one across its edges 0–1, 1–2 and 2–0, or [`NO_NEIGHBOUR`].
    pub neighbours: Vec<[u32; 3]>,
}

/// A model as it was read.
#[derive(Debug, Clone, PartialEq)]
pub struct Import {
    /// The repaired mesh, in the units of the file.
    pub mesh: Mesh,
    /// What was found and repaired.
    pub repair: RepairReport,
    /// The format, in words: `binary STL`.
    pub format: &'static str,
    /// The unit of the coordinates, if the file states it.
    pub units: Option<Units>,
    /// The objects in the file, if it names them.
    pub objects: Vec<Object>,
    /// What was skipped, as sentences.
    pub notes: Vec<String>,
    /// For a preform, the part milled from it.
    pub milled: Option<Box<Milled>>,
}

/// A part that is milled from its preform.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Milled {
    /// The part, as it lies in the preform.
    pub mesh: Mesh,
    /// Machining stock over each of its triangles, along the normal from the triangle's middle, mm.
    pub stock: Vec<f64>,
}

impl Milled {
    /// Moves the part, mm.
    pub(crate) fn shift(&mut self, by: DVec3) {
        self.mesh.vertices.iter_mut().for_each(|vertex| *vertex += by);
    }
}

/// An object of a file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Object {
    /// Its name.
    pub name: String,
    /// Its triangles, as read.
    pub triangles: usize,
    /// A point on each of its solids, in the coordinates of the mesh.
    pub at: Vec<DVec3>,
}

/// Why a model was refused.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ImportError {
    /// The file is empty.
    #[error("the file is empty (0 bytes). Export the model again.")]
    Empty,
    /// A format that is recognised but not read.
    #[error(
        "this is {found}, which Beadwright does not read by itself. Save the model as STL, 3MF or OBJ and try again."
    )]
    OtherFormat {
        /// What the content looks like.
        found: &'static str,
    },
    /// Curves where a solid is needed.
    #[error(
        "this is an IGES file: its curves can be welded as walls, but here a solid is needed. Save the model as STL (binary or ASCII)."
    )]
    Iges,
    /// Outlines where a solid is needed.
    #[error(
        "this is {found}: it becomes a part when it is given a height, but here a solid is needed. Save the model as STL (binary \
         or ASCII)."
    )]
    Outline {
        /// What it is.
        found: &'static str,
    },
    /// No known format.
    #[error(
        "this is not an STL file: {reason}; and it is not 3MF, OBJ, PLY or AMF. Save the model as STL (binary or ASCII) and try \
         again."
    )]
    NotStl {
        /// The reason, with the byte or line.
        reason: String,
    },
    /// The file ends too early, or holds more than it says.
    #[error("the file is damaged: {reason}. Copy or export it again.")]
    Damaged {
        /// Where it ends and where it should.
        reason: String,
    },
    /// A file in another format that does not hold what it should.
    #[error("the {format} file cannot be read: {reason}. Export the model again.")]
    Broken {
        /// The format.
        format: &'static str,
        /// Where, and what is wrong.
        reason: String,
    },
    /// The text cannot be decoded.
    #[error(transparent)]
    Text(#[from] TextError),
    /// A line of an ASCII STL that cannot be read.
    #[error("line {line} of the ASCII STL file cannot be read: {reason}.")]
    Line {
        /// Line number, from 1.
        line: usize,
        /// What was expected and what was found.
        reason: String,
    },
    /// A coordinate that is not a finite number.
    #[error("triangle {triangle} has a coordinate that is not a finite number ({place}). Export the model again.")]
    NotFinite {
        /// Triangle number, from 1.
        triangle: usize,
        /// Byte or line.
        place: String,
    },
    /// No triangle has an area.
    #[error("the model has no triangle with an area ({triangles} read, all degenerate), so there is nothing to build.")]
    NoTriangles {
        /// Number read.
        triangles: usize,
    },
    /// The part lies too far from the origin.
    #[error(
        "the model reaches {reach} m from the origin; at most {most} m are supported. Move it to the origin, or check the unit of the file.",
        reach = metres(*reach_m),
        most = MAX_REACH_MM / 1000.0
    )]
    TooFar {
        /// Largest coordinate, m.
        reach_m: f64,
    },
    /// Stopped by the caller.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// A length that may be arbitrarily large, in m, as text.
fn metres(length: f64) -> String {
    if length < 1e6 { format!("{length:.1}") } else { format!("{length:.0e}") }
}

/// Reads a model from the bytes of a file; its content decides the format, not its name. A file that ends too early or
/// holds more than it says is refused.
///
/// # Errors
/// [`ImportError`], with the byte or line and the reason.
pub fn import(bytes: &[u8], task: &Task) -> Result<Import, ImportError> {
    let import = import_damaged(bytes, task)?;
    match import.repair.damage {
        Some(reason) => Err(ImportError::Damaged { reason }),
        None => Ok(import),
    }
}

/// Like [`import`], but accepts the triangles that a damaged file holds; [`RepairReport::damage`] says what is wrong.
///
/// # Errors
/// [`ImportError`], with the byte or line and the reason.
pub fn import_damaged(bytes: &[u8], task: &Task) -> Result<Import, ImportError> {
    let bytes = &*decoded(bytes)?;
    if bytes.is_empty() {
        return Err(ImportError::Empty);
    }
    if is_iges(bytes) {
        return Err(ImportError::Iges);
    }
    if stl::announced_size(bytes) != Some(bytes.len())
        && let Some(found) = other_format(bytes)
    {
        return Err(ImportError::OtherFormat { found });
    }
    if let Some(found) = outline::drawing(bytes) {
        return Err(ImportError::Outline { found });
    }
    let known = formats::ALL.iter().find(|format| (format.is)(bytes));
    // A file of the right size is binary STL, whatever its header looks like.
    match known.filter(|_| stl::announced_size(bytes) != Some(bytes.len())) {
        Some(format) => (format.read)(bytes, task),
        None => stl::read(bytes, task),
    }
}

/// Decompresses gzip, and turns text into UTF-8 with `\n` line ends; anything else is unchanged.
///
/// # Errors
/// [`ImportError`] for text in an encoding that is not read, and for data that cannot be unpacked.
pub fn decoded(bytes: &[u8]) -> Result<Cow<'_, [u8]>, ImportError> {
    // A binary STL may have any header.
    if gzip::is_packed(bytes) && stl::announced_size(bytes) != Some(bytes.len()) {
        let unpacked = gzip::unpacked(bytes)?;
        return Ok(decoded_text(&unpacked)?.into_owned().into());
    }
    Ok(decoded_text(bytes)?)
}

fn decoded_text(bytes: &[u8]) -> Result<Cow<'_, [u8]>, TextError> {
    let is_text = stl::announced_size(bytes) != Some(bytes.len()) && text::needs_decoding(bytes);
    Ok(if is_text { text::of(bytes)?.into_bytes().into() } else { bytes.into() })
}

/// Whether the bytes are those of an IGES file: the first card of the start section has S and its number in columns 73
/// to 80.
pub fn is_iges(bytes: &[u8]) -> bool {
    let first = bytes.get(72..80);
    first.is_some_and(|end| end[0] == b'S' && end[1..].iter().all(|b| b" 01".contains(b)))
        && stl::announced_size(bytes) != Some(bytes.len())
}

/// Whether the bytes are a solid in a format that can be recognised by content, which excludes STL.
pub fn is_solid(bytes: &[u8]) -> bool {
    let [known @ .., _stl] = &formats::ALL;
    stl::announced_size(bytes) != Some(bytes.len()) && known.iter().any(|format| (format.is)(bytes))
}

/// Whether the bytes are an STL file: the size is the one it announces, or it begins like ASCII STL.
pub fn is_stl(bytes: &[u8]) -> bool {
    stl::announced_size(bytes) == Some(bytes.len()) || stl::looks_ascii(bytes)
}

/// Formats that people give by mistake.
fn other_format(bytes: &[u8]) -> Option<&'static str> {
    let head = &bytes[..bytes.len().min(400)];
    if gzip::is_packed(head) {
        Some("a gzip archive in another")
    } else if head.starts_with(b"ISO-10303-21") {
        Some("a STEP file")
    } else {
        None
    }
}

impl Mesh {
    /// A mesh from vertices and triangles, repaired like an imported one.
    ///
    /// ```
    /// use bead_part::model::Mesh;
    /// use glam::DVec3;
    ///
    /// // A tetrahedron whose first triangle is wound the wrong way.
    /// let corners = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    /// let triangles = vec![[0, 1, 2], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
    /// let (mesh, report) = Mesh::from_triangles(corners, triangles);
    /// assert_eq!((report.flipped, report.open_edges), (1, 0));
    /// assert!((mesh.volume() - 1.0 / 6.0).abs() < 1e-12);
    /// ```
    pub fn from_triangles(vertices: Vec<DVec3>, triangles: Vec<[u32; 3]>) -> (Self, RepairReport) {
        repair::mend(vertices, triangles)
    }

    /// Adds the triangles of another mesh; the two are not joined.
    pub fn add(&mut self, other: Self) {
        let (vertices, triangles) = (self.vertices.len() as u32, self.triangles.len() as u32);
        self.vertices.extend(other.vertices);
        self.triangles.extend(other.triangles.iter().map(|corners| corners.map(|corner| corner + vertices)));
        let shifted = |across: u32| if across == NO_NEIGHBOUR { across } else { across + triangles };
        self.neighbours.extend(other.neighbours.iter().map(|across| across.map(shifted)));
    }

    /// The faces for whose corners `kept` holds, without neighbours.
    pub(crate) fn only(&self, kept: impl Fn(&[DVec3; 3]) -> bool) -> Self {
        let corners = |triangle: &[u32; 3]| triangle.map(|corner| self.vertices[corner as usize]);
        let triangles = self.triangles.iter().copied().filter(|triangle| kept(&corners(triangle))).collect();
        Self { vertices: self.vertices.clone(), triangles, neighbours: Vec::new() }
    }

    /// Lowest and highest coordinates, mm.
    pub fn bounds(&self) -> (DVec3, DVec3) {
        self.vertices.iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), &v| (low.min(v), high.max(v)))
    }

    /// Extent along x, y and z, mm.
    pub fn size(&self) -> DVec3 {
        let (low, high) = self.bounds();
        high - low
    }

    /// Signed volume, mm³, by the divergence theorem; exact only when the mesh is closed.
    pub fn volume(&self) -> f64 {
        let (low, high) = self.bounds();
        let origin = (low + high) / 2.0;
        let corner = |i: u32| self.vertices[i as usize] - origin;
        self.triangles.iter().map(|&[a, b, c]| corner(a).dot(corner(b).cross(corner(c)))).sum::<f64>() / 6.0
    }

    /// Scales by `factor`, turns by `degrees` about x, then y, then z, and moves the part down to z = 0. Returns that
    /// transform.
    pub fn place(&mut self, factor: f64, degrees: DVec3) -> DAffine3 {
        let radians = degrees * std::f64::consts::PI / 180.0;
        let turn =
            DMat3::from_rotation_z(radians.z) * DMat3::from_rotation_y(radians.y) * DMat3::from_rotation_x(radians.x);
        if degrees != DVec3::ZERO || factor != 1.0 {
            for vertex in &mut self.vertices {
                *vertex = turn * *vertex * factor;
            }
        }
        let floor = self.bounds().0.z;
        for vertex in &mut self.vertices {
            vertex.z -= floor;
        }
        DAffine3::from_mat3_translation(turn * factor, DVec3::NEG_Z * floor)
    }

    /// Refuses a part that extends beyond the 2-D grid.
    ///
    /// # Errors
    /// [`ImportError::TooFar`].
    pub fn check_reach(&self) -> Result<(), ImportError> {
        let (low, high) = self.bounds();
        let reach = low.abs().max(high.abs()).max_element();
        if reach > MAX_REACH_MM { Err(ImportError::TooFar { reach_m: reach / 1000.0 }) } else { Ok(()) }
    }
}
