//! The surface of a preform.

use super::Preform;
use bead_part::model::Mesh;
use bead_part::model::solid::Solid;
use rayon::prelude::*;

impl Preform {
    /// A closed surface: a prism for each island of identical steps, face on face, standing on z = 0. Its slices are
    /// the steps themselves.
    pub fn mesh(&self) -> Mesh {
        let steps: Vec<usize> = (0..self.steps.len()).collect();
        let alike: Vec<&[usize]> = steps.chunk_by(|&a, &b| self.steps[a] == self.steps[b]).collect();
        let prisms = |steps: &&[usize]| -> Vec<Mesh> {
            let (Some(&first), Some(&last)) = (steps.first(), steps.last()) else { return Vec::new() };
            let (low, high) = (first as f64 * self.step, (last + 1) as f64 * self.step);
            let prism = |base| {
                let Solid { vertices, triangles } = Solid::extrude(base, low, high);
                Mesh::from_triangles(vertices, triangles).0
            };
            self.steps[first].polygons().iter().map(prism).collect()
        };
        let prisms: Vec<Vec<Mesh>> = alike.par_iter().map(prisms).collect();
        let mut whole = Mesh::default();
        prisms.into_iter().flatten().for_each(|prism| whole.add(prism));
        whole
    }
}
