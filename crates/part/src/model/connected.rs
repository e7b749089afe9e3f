//! Which faces hang together.

/// For each face the least corner of those that hang together with it: faces that share a corner do.
pub(crate) fn joined(faces: &[[u32; 3]], corners: usize) -> Vec<u32> {
    let mut parents: Vec<u32> = (0..corners as u32).collect();
    fn root(parents: &mut [u32], mut corner: u32) -> u32 {
        while parents[corner as usize] != corner {
            parents[corner as usize] = parents[parents[corner as usize] as usize];
            corner = parents[corner as usize];
        }
        corner
    }
    for &[a, b, c] in faces {
        for other in [b, c] {
            let [one, other] = [a, other].map(|corner| root(&mut parents, corner));
            parents[one.max(other) as usize] = one.min(other);
        }
    }
    faces.iter().map(|face| root(&mut parents, face[0])).collect()
}

#[cfg(test)]
mod tests {
    use super::joined;

    /// Whatever the order of the faces and of their corners.
    #[test]
    fn faces_that_share_a_corner_hang_together() {
        let faces = [[5, 3, 4], [4, 6, 7], [9, 8, 10], [3, 11, 12], [10, 13, 14], [15, 16, 17]];
        assert_eq!(joined(&faces, 18), [3, 3, 8, 3, 8, 15]);
        let turned: Vec<_> = faces.iter().rev().map(|[a, b, c]| [*c, *a, *b]).collect();
        assert_eq!(joined(&turned, 18), [15, 8, 3, 8, 3, 3]);
    }
}
