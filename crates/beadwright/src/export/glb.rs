//! The shape as built as binary glTF 2.0: the beads of each kind in one colour, for browsers and viewers.
//!
//! glTF is in metres with y upwards; the node turns and scales what is written in mm.

use super::swept::{self, Body};
use super::{Beads, ExportError, Format};
use crate::model::solid::Solid;
use crate::palette;
use crate::pass::PassKind;
use glam::DVec3;
use serde_json::{Value, json};

pub(super) const FORMAT: Format = Format { extension: "glb", purpose: "the shape as built, for viewers", write };

/// From mm with z upwards to m with y upwards, column by column.
const NODE: [f64; 16] = [1e-3, 0.0, 0.0, 0.0, 0.0, 0.0, -1e-3, 0.0, 0.0, 1e-3, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0];

const FLOAT: u32 = 5126;
const UNSIGNED_INT: u32 = 5125;
const VERTICES: u32 = 34962;
const INDICES: u32 = 34963;

fn write(beads: &Beads<'_>) -> Result<Vec<u8>, ExportError> {
    let bodies = swept::bodies(beads);
    let mut scene = Scene::default();
    for kind in palette::KINDS.into_iter().chain([PassKind::Spot]) {
        let solid = joined(bodies.iter().filter(|body| body.kind == kind));
        if !solid.triangles.is_empty() {
            scene.add(kind.name(), palette::linear(palette::kind(kind)), &solid);
        }
    }
    if scene.primitives.is_empty() {
        return Err(ExportError::Empty);
    }
    scene.bytes(&beads.header.part)
}

fn joined<'b>(bodies: impl Iterator<Item = &'b Body>) -> Solid {
    let mut all = Solid::default();
    for Body { solid, .. } in bodies {
        let first = all.vertices.len() as u32;
        all.vertices.extend(&solid.vertices);
        all.triangles.extend(solid.triangles.iter().map(|t| t.map(|i| i + first)));
    }
    all
}

/// The scene as it grows, to become the two chunks of a file.
#[derive(Default)]
struct Scene {
    data: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
    materials: Vec<Value>,
    primitives: Vec<Value>,
}

impl Scene {
    fn add(&mut self, name: &str, [r, g, b]: [f64; 3], solid: &Solid) {
        let bounds = |by: fn(DVec3, DVec3) -> DVec3, from: DVec3| {
            solid.vertices.iter().copied().fold(from, by).as_vec3().to_array()
        };
        let (low, high) = (bounds(DVec3::min, DVec3::INFINITY), bounds(DVec3::max, DVec3::NEG_INFINITY));
        let places = solid.vertices.iter().flat_map(|v| v.as_vec3().to_array()).flat_map(f32::to_le_bytes);
        let view = self.view(VERTICES, places);
        self.accessors.push(json!({
            "bufferView": view, "componentType": FLOAT, "count": solid.vertices.len(), "type": "VEC3", "min": low, "max": high,
        }));
        let view = self.view(INDICES, solid.triangles.iter().flatten().flat_map(|i| i.to_le_bytes()));
        self.accessors.push(json!({
            "bufferView": view, "componentType": UNSIGNED_INT, "count": 3 * solid.triangles.len(), "type": "SCALAR",
        }));
        let (indices, material) = (self.accessors.len() - 1, self.materials.len());
        self.primitives.push(json!({
            "attributes": { "POSITION": indices - 1 }, "indices": indices, "material": material, "mode": 4,
        }));
        self.materials.push(json!({
            "name": name,
            "pbrMetallicRoughness": { "baseColorFactor": [r, g, b, 1.0], "metallicFactor": 0.3, "roughnessFactor": 0.6 },
        }));
    }

    /// Adds bytes as a view, and returns its number.
    fn view(&mut self, target: u32, bytes: impl Iterator<Item = u8>) -> usize {
        let offset = self.data.len();
        self.data.extend(bytes);
        let length = self.data.len() - offset;
        self.views.push(json!({ "buffer": 0, "byteOffset": offset, "byteLength": length, "target": target }));
        self.views.len() - 1
    }

    fn bytes(self, part: &str) -> Result<Vec<u8>, ExportError> {
        let generator = concat!("Beadwright ", env!("CARGO_PKG_VERSION"));
        let json = json!({
            "asset": { "version": "2.0", "generator": generator },
            "scene": 0, "scenes": [{ "nodes": [0] }], "nodes": [{ "name": part, "mesh": 0, "matrix": NODE }],
            "meshes": [{ "primitives": self.primitives }], "materials": self.materials, "accessors": self.accessors,
            "bufferViews": self.views, "buffers": [{ "byteLength": self.data.len() }],
        });
        let mut json = json.to_string().into_bytes();
        json.resize(json.len().next_multiple_of(4), b' ');
        let total = 12 + 8 + json.len() + 8 + self.data.len();
        let total = u32::try_from(total).map_err(|_| ExportError::TooLarge { gigabytes: total as f64 / 1e9 })?;
        let mut bytes = Vec::with_capacity(total as usize);
        bytes.extend(b"glTF");
        bytes.extend([2, total].iter().flat_map(|v: &u32| v.to_le_bytes()));
        for (kind, chunk) in [(b"JSON", &json), (b"BIN\0", &self.data)] {
            bytes.extend((chunk.len() as u32).to_le_bytes());
            bytes.extend(kind);
            bytes.extend(chunk);
        }
        Ok(bytes)
    }
}
