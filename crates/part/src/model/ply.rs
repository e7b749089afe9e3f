//! PLY, as text or binary: the vertices and faces; colours and everything else are skipped.

use super::formats::{self, Format};
use super::{Import, ImportError};
use crate::task::Task;
use glam::{DVec3, Vec3};
use ply_rs_bw::parser::{Parser, Reader};
use ply_rs_bw::ply::{DefaultElement, Property, PropertyAccess, PropertyAccessResult};

pub(super) const FORMAT: Format =
    Format { is: |bytes| bytes.starts_with(b"ply\n") || bytes.starts_with(b"ply\r"), read };

/// x, y, z.
struct Vertex([f32; 3]);

/// Indices of the corners.
struct Face(Vec<u32>);

impl PropertyAccess for Vertex {
    fn new() -> Self {
        Self([f32::NAN; 3])
    }

    fn set_property(&mut self, key: &str, property: Property) -> PropertyAccessResult {
        let axis = match key {
            "x" => 0,
            "y" => 1,
            "z" => 2,
            _ => return PropertyAccessResult::Ignored,
        };
        self.0[axis] = match property {
            Property::Float(v) => v,
            Property::Double(v) => v as f32,
            Property::Int(v) => v as f32,
            Property::Short(v) => v.into(),
            _ => return PropertyAccessResult::UnsupportedType,
        };
        PropertyAccessResult::Set
    }
}

impl PropertyAccess for Face {
    fn new() -> Self {
        Self(Vec::new())
    }

    fn set_property(&mut self, key: &str, property: Property) -> PropertyAccessResult {
        if !matches!(key, "vertex_indices" | "vertex_index") {
            return PropertyAccessResult::Ignored;
        }
        // A negative number refers to no vertex.
        let number = |v: i64| u32::try_from(v).unwrap_or(u32::MAX);
        self.0 = match property {
            Property::ListInt(v) => v.into_iter().map(|v| number(v.into())).collect(),
            Property::ListUInt(v) => v,
            Property::ListShort(v) => v.into_iter().map(|v| number(v.into())).collect(),
            Property::ListUShort(v) => v.into_iter().map(u32::from).collect(),
            Property::ListUChar(v) => v.into_iter().map(u32::from).collect(),
            Property::ListChar(v) => v.into_iter().map(|v| number(v.into())).collect(),
            _ => return PropertyAccessResult::UnsupportedType,
        };
        PropertyAccessResult::Set
    }
}

/// The points of a PLY file, in units of the file, and the triangles between them if it has faces. Nothing is repaired.
///
/// # Errors
/// [`ImportError::Broken`] saying what cannot be read.
pub fn points(bytes: &[u8], task: &Task) -> Result<(Vec<DVec3>, Vec<[u32; 3]>), ImportError> {
    let (vertices, faces) = elements(bytes, task)?;
    let triangles: Vec<_> = faces.iter().flat_map(|Face(corners)| formats::fan(corners)).collect();
    if triangles.iter().flatten().any(|&corner| corner as usize >= vertices.len()) {
        return Err(broken("a face refers to a missing vertex"));
    }
    Ok((vertices.into_iter().map(|Vertex(at)| Vec3::from_array(at).as_dvec3()).collect(), triangles))
}

fn read(bytes: &[u8], task: &Task) -> Result<Import, ImportError> {
    let (vertices, faces) = elements(bytes, task)?;
    if faces.is_empty() {
        return Err(broken("it holds no faces: a point cloud is not a solid"));
    }
    let vertices: Vec<[f32; 3]> = vertices.into_iter().map(|Vertex(at)| at).collect();
    let mut facets = Vec::with_capacity(2 * faces.len());
    for (number, Face(corners)) in (1..).zip(&faces) {
        for triangle in formats::fan(corners) {
            let facet = formats::indexed(&vertices, triangle);
            facets.push(facet.ok_or_else(|| broken(format!("face {number} refers to a missing vertex")))?);
        }
    }
    let count = facets.len();
    formats::of_facets(facets.into_iter(), count, "PLY", |i| format!("triangle {}", i + 1), task)
}

/// All vertices and faces.
fn elements(bytes: &[u8], task: &Task) -> Result<(Vec<Vertex>, Vec<Face>), ImportError> {
    let mut reader = Reader::new(bytes);
    let header = Parser::<DefaultElement>::new().read_header(&mut reader).map_err(broken)?;
    let (mut vertices, mut faces) = (Vec::new(), Vec::new());
    for (name, element) in &header.elements {
        // Each value takes at least one byte, so a count beyond the file's size is wrong.
        if element.count > bytes.len() {
            return Err(broken(format!("it announces {} of \"{name}\", but has {} bytes", element.count, bytes.len())));
        }
        task.check()?;
        match name.as_ref() {
            "vertex" => {
                let read = Parser::<Vertex>::new().read_payload_for_element(&mut reader, element, &header);
                vertices = read.map_err(broken)?;
            }
            "face" => {
                let read = Parser::<Face>::new().read_payload_for_element(&mut reader, element, &header);
                faces = read.map_err(broken)?;
            }
            _ => {
                let read = Parser::<DefaultElement>::new().read_payload_for_element(&mut reader, element, &header);
                read.map_err(broken)?;
            }
        }
    }
    Ok((vertices, faces))
}

fn broken(reason: impl ToString) -> ImportError {
    ImportError::Broken { format: "PLY", reason: reason.to_string() }
}
