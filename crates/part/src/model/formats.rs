//! The formats of solids, one file each, and their common step: loose triangles become a repaired mesh.

use super::merge_vertices::{BLOCK, VertexMerger};
use super::{Import, ImportError, amf, obj, ply, repair, stl, threemf};
use crate::task::{Stage, Task};

/// A format of solids.
pub(super) struct Format {
    /// Whether a file looks like this format.
    pub(super) is: fn(&[u8]) -> bool,
    /// Reads it.
    pub(super) read: fn(&[u8], &Task) -> Result<Import, ImportError>,
}

/// All formats; STL comes last, since only its size identifies it.
pub(super) const ALL: [Format; 5] = [threemf::FORMAT, amf::FORMAT, ply::FORMAT, obj::FORMAT, stl::FORMAT];

/// A triangle: its normal (0 if the file gives none) and its corners.
pub(super) type Facet = ([f32; 3], [[f32; 3]; 3]);

/// Most triangles of a model: indices have 32 bits, and a hostile file must not exhaust the memory.
pub(super) const MOST_TRIANGLES: usize = 100_000_000;

/// A mesh of `count` loose triangles; `place` names a triangle's location in the file.
pub(super) fn of_facets(
    facets: impl Iterator<Item = Facet>,
    count: usize,
    format: &'static str,
    place: impl Fn(usize) -> String,
    task: &Task,
) -> Result<Import, ImportError> {
    task.step(Stage::Import, 0.0)?;
    let mut welder = VertexMerger::for_triangles(count);
    let mut triangles = Vec::with_capacity(count);
    let mut against = 0;
    let mut block = Vec::with_capacity(BLOCK);
    for (i, (normal, corners)) in facets.enumerate() {
        if i % 65_536 == 0 {
            task.step(Stage::Import, 0.6 * i as f64 / count as f64)?;
        }
        if !corners.as_flattened().iter().all(|v| v.is_finite()) {
            return Err(ImportError::NotFinite { triangle: i + 1, place: place(i) });
        }
        against += usize::from(opposes(normal, corners));
        block.push(corners);
        if block.len() == BLOCK {
            welder.add(&block, &mut triangles);
            block.clear();
        }
    }
    welder.add(&block, &mut triangles);
    task.step(Stage::Import, 0.6)?;
    let (mesh, mut repair) = repair::mend(welder.into_vertices(), triangles);
    let area = |&[a, b, c]: &[u32; 3]| {
        let [a, b, c] = [a, b, c].map(|i| mesh.vertices[i as usize]);
        (b - a).cross(c - a).length_squared()
    };
    if !mesh.triangles.iter().any(|t| area(t) > 0.0) {
        return Err(ImportError::NoTriangles { triangles: count });
    }
    repair.normals_against_winding = against;
    task.step(Stage::Import, 1.0)?;
    Ok(Import { mesh, repair, format, units: None, objects: Vec::new(), notes: Vec::new(), milled: None })
}

/// Whether a stored normal points against the winding of its corners.
fn opposes(normal: [f32; 3], [a, b, c]: [[f32; 3]; 3]) -> bool {
    let sub = |p: [f32; 3], q: [f32; 3]| [p[0] - q[0], p[1] - q[1], p[2] - q[2]];
    let (u, v) = (sub(b, a), sub(c, a));
    let cross = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    cross[0] * normal[0] + cross[1] * normal[1] + cross[2] * normal[2] < 0.0
}

/// Splits a polygon into a fan of triangles, which is correct for convex ones.
pub(super) fn fan(corners: &[u32]) -> impl Iterator<Item = [u32; 3]> + '_ {
    (2..corners.len()).map(|k| [corners[0], corners[k - 1], corners[k]])
}

/// The facet between three vertices; `None` if an index is out of range.
pub(super) fn indexed(vertices: &[[f32; 3]], [a, b, c]: [u32; 3]) -> Option<Facet> {
    let at = |i: u32| vertices.get(i as usize).copied();
    Some(([0.0; 3], [at(a)?, at(b)?, at(c)?]))
}
