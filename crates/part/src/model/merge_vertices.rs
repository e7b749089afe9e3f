//! Corners with equal coordinates become one vertex: an open-addressing table over the exact bits.

use glam::DVec3;
use rayon::prelude::*;

/// Triangles whose corners are looked up in one batch.
pub(crate) const BLOCK: usize = 32;

/// Vertices found so far, and the table that finds them again.
pub(crate) struct VertexMerger {
    vertices: Vec<[f32; 3]>,
    /// Index + 1 of a vertex, 0 for an empty slot; a power of two in length.
    slots: Vec<u32>,
}

impl VertexMerger {
    /// Capacity for a closed mesh of this many triangles, which has about half as many vertices.
    pub(crate) fn for_triangles(triangles: usize) -> Self {
        let slots = triangles.max(16).next_power_of_two();
        Self { vertices: Vec::with_capacity(triangles / 2 + 8), slots: vec![0; slots] }
    }

    /// Appends the triangles between `corners`, three for each; negative zero counts as zero.
    ///
    /// All corners of a block are looked up before the first is needed, so that the memory latencies overlap; they take
    /// most of the time in a big model. Only corners not found that way are searched for one by one.
    pub(crate) fn add(&mut self, corners: &[[[f32; 3]; 3]], triangles: &mut Vec<[u32; 3]>) {
        for block in corners.chunks(BLOCK) {
            let mut found = [([0.0; 3], 0, None); 3 * BLOCK];
            let found = &mut found[..3 * block.len()];
            for (entry, corner) in found.iter_mut().zip(block.as_flattened()) {
                let corner = corner.map(|v| v + 0.0);
                let hash = hash(corner);
                *entry = (corner, hash, self.slots[hash & (self.slots.len() - 1)].checked_sub(1));
            }
            for (corner, _, index) in &mut *found {
                *index = index.filter(|&i| self.vertices[i as usize] == *corner);
            }
            let mut index = |k: usize| {
                let (corner, hash, index) = found[k];
                index.unwrap_or_else(|| self.find_or_insert(corner, hash))
            };
            triangles.extend((0..block.len()).map(|t| [0, 1, 2].map(|k| index(3 * t + k))));
        }
    }

    fn find_or_insert(&mut self, corner: [f32; 3], hash: usize) -> u32 {
        let mask = self.slots.len() - 1;
        let mut slot = hash & mask;
        loop {
            match self.slots[slot] {
                0 => break,
                found if self.vertices[found as usize - 1] == corner => return found - 1,
                _ => slot = (slot + 1) & mask,
            }
        }
        self.vertices.push(corner);
        let index = self.vertices.len() as u32;
        self.slots[slot] = index;
        if self.vertices.len() * 4 > self.slots.len() * 3 {
            self.grow();
        }
        index - 1
    }

    fn grow(&mut self) {
        let mask = self.slots.len() * 2 - 1;
        let mut slots = vec![0_u32; mask + 1];
        for (i, &vertex) in self.vertices.iter().enumerate() {
            let mut slot = hash(vertex) & mask;
            while slots[slot] != 0 {
                slot = (slot + 1) & mask;
            }
            slots[slot] = i as u32 + 1;
        }
        self.slots = slots;
    }

    pub(crate) fn into_vertices(self) -> Vec<DVec3> {
        self.vertices.into_par_iter().map(|[x, y, z]| DVec3::new(x.into(), y.into(), z.into())).collect()
    }
}

fn hash(corner: [f32; 3]) -> usize {
    const K: u64 = 0x9E37_79B9_7F4A_7C15;
    let [x, y, z] = corner.map(|v| u64::from(v.to_bits()));
    let mixed = (x | (y << 32)).wrapping_mul(K).rotate_left(29) ^ z.wrapping_mul(0xD6E8_FEB8_6659_FD93);
    (mixed.wrapping_mul(K) >> 24) as usize
}
