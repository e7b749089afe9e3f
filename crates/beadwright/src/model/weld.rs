//! Corners with equal coordinates become one vertex: an open-addressing table over the exact bits.

use glam::DVec3;

/// Vertices found so far, and the table that finds them again.
pub(crate) struct Welder {
    vertices: Vec<[f32; 3]>,
    /// Index + 1 of a vertex, 0 for an empty slot; a power of two in length.
    slots: Vec<u32>,
}

impl Welder {
    /// Room for a closed mesh of that many triangles, which has about half as many vertices.
    pub(crate) fn for_triangles(triangles: usize) -> Self {
        let slots = triangles.max(16).next_power_of_two();
        Self { vertices: Vec::with_capacity(triangles / 2 + 8), slots: vec![0; slots] }
    }

    /// The index of the vertex at `corner`; negative zero counts as zero.
    pub(crate) fn add(&mut self, corner: [f32; 3]) -> u32 {
        let corner = corner.map(|v| v + 0.0);
        let mask = self.slots.len() - 1;
        let mut slot = hash(corner) & mask;
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
        self.vertices.into_iter().map(|[x, y, z]| DVec3::new(x.into(), y.into(), z.into())).collect()
    }
}

fn hash(corner: [f32; 3]) -> usize {
    const K: u64 = 0x9E37_79B9_7F4A_7C15;
    let [x, y, z] = corner.map(|v| u64::from(v.to_bits()));
    let mixed = (x | (y << 32)).wrapping_mul(K).rotate_left(29) ^ z.wrapping_mul(0xD6E8_FEB8_6659_FD93);
    (mixed.wrapping_mul(K) >> 24) as usize
}
