//! The surface of a part as samples with a direction and an area, so small that a plane takes or leaves each as a
//! whole.

use crate::model::Mesh;
use glam::DVec3;

/// A sample of the surface.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sample {
    /// Its middle, mm.
    pub(super) place: DVec3,
    /// Unit vector outwards.
    pub(super) normal: DVec3,
    /// Area, mm².
    pub(super) area: f64,
}

/// Total area, mm².
pub(super) fn area<'a>(samples: impl Iterator<Item = &'a Sample>) -> f64 {
    // A sum of nothing would be a negative zero.
    samples.fold(0.0, |sum, sample| sum + sample.area)
}

/// Samples are divided until their edges are shorter than this fraction of the part's size.
pub(super) const FINE: f64 = 0.03;

/// The surface of a mesh, divided into samples with edges shorter than [`FINE`] times `size` (mm).
pub(super) fn samples(mesh: &Mesh, size: f64) -> Vec<Sample> {
    let mut samples = Vec::with_capacity(mesh.triangles.len());
    let mut open: Vec<[DVec3; 3]> = Vec::new();
    for corners in &mesh.triangles {
        open.push(corners.map(|corner| mesh.vertices[corner as usize]));
        while let Some(triangle @ [a, b, c]) = open.pop() {
            let edges = [a.distance(b), b.distance(c), c.distance(a)];
            let longest = (0..3).max_by(|i, j| edges[*i].total_cmp(&edges[*j])).unwrap_or_default();
            if edges[longest] > FINE * size {
                let [from, to, tip] = [0, 1, 2].map(|k| triangle[(longest + k) % 3]);
                let middle = (from + to) / 2.0;
                open.extend([[from, middle, tip], [middle, to, tip]]);
                continue;
            }
            let doubled = (b - a).cross(c - a);
            if let Some(normal) = doubled.try_normalize() {
                samples.push(Sample { place: (a + b + c) / 3.0, normal, area: doubled.length() / 2.0 });
            }
        }
    }
    samples
}
