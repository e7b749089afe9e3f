//! Which triangle lies across each edge: half-edges are bucketed by their lower vertex and matched there.

use super::NO_NEIGHBOUR;

/// One side of an edge: the triangle, and which of its three edges.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct HalfEdge {
    pub(crate) triangle: u32,
    pub(crate) edge: u8,
    /// Whether it runs from the lower vertex to the higher one.
    pub(crate) forward: bool,
}

/// The triangles across all edges, and the edges that are not clean.
#[derive(Debug, Default)]
pub(crate) struct Adjacency {
    pub(crate) neighbours: Vec<[u32; 3]>,
    /// Half-edges of edges that are not shared by exactly two triangles in opposite directions, edge by edge.
    pub(crate) odd_edges: Vec<Vec<HalfEdge>>,
}

impl Adjacency {
    pub(crate) fn new(vertex_count: usize, triangles: &[[u32; 3]]) -> Self {
        let mut result = Self { neighbours: vec![[NO_NEIGHBOUR; 3]; triangles.len()], odd_edges: Vec::new() };
        let (starts, mut half_edges) = bucket_by_lower_vertex(vertex_count, triangles);
        sort_buckets(&starts, &mut half_edges);
        for range in starts.windows(2) {
            let mut rest = &half_edges[range[0] as usize..range[1] as usize];
            while let [first, tail @ ..] = rest {
                let same = |other: &u64| other >> 32 == first >> 32;
                match tail {
                    // The usual edge: two triangles in opposite directions, and no third.
                    [second, tail @ ..]
                        if same(second) && (first ^ second) & 1 == 1 && !tail.first().is_some_and(same) =>
                    {
                        result.join(unpack(*first), unpack(*second));
                        rest = tail;
                    }
                    _ => {
                        let count = 1 + tail.iter().take_while(|h| same(h)).count();
                        result.match_odd(rest[..count].iter().copied().map(unpack).collect());
                        rest = &rest[count..];
                    }
                }
            }
        }
        result
    }

    /// Pairs half-edges of opposite direction on one edge.
    fn match_odd(&mut self, edge: Vec<HalfEdge>) {
        let side = |forward: bool| edge.iter().filter(move |h| h.forward == forward);
        for (&a, &b) in side(true).zip(side(false)) {
            self.join(a, b);
        }
        self.odd_edges.push(edge);
    }

    fn join(&mut self, a: HalfEdge, b: HalfEdge) {
        self.neighbours[a.triangle as usize][usize::from(a.edge)] = b.triangle;
        self.neighbours[b.triangle as usize][usize::from(b.edge)] = a.triangle;
    }
}

/// The vertices of an edge, in the triangle's direction.
pub(crate) fn ends(triangle: [u32; 3], edge: u8) -> (u32, u32) {
    let k = usize::from(edge);
    (triangle[k], triangle[(k + 1) % 3])
}

/// A half-edge in one number that sorts by higher vertex, triangle and edge; the lowest bit is the direction.
/// 32 bits hold the lower part of 700 million triangles, a file of 35 GB.
fn pack(higher: u32, triangle: usize, edge: usize, forward: bool) -> u64 {
    u64::from(higher) << 32 | (6 * triangle + 2 * edge) as u64 | u64::from(forward)
}

fn unpack(packed: u64) -> HalfEdge {
    let half = packed as u32;
    HalfEdge { triangle: half / 6, edge: (half / 2 % 3) as u8, forward: half & 1 == 1 }
}

/// Counting sort: bucket starts, and the packed half-edges of each bucket.
fn bucket_by_lower_vertex(vertex_count: usize, triangles: &[[u32; 3]]) -> (Vec<u32>, Vec<u64>) {
    let mut starts = vec![0_u32; vertex_count + 2];
    for &[a, b, c] in triangles {
        for lower in [a.min(b), b.min(c), c.min(a)] {
            starts[lower as usize + 2] += 1;
        }
    }
    for i in 2..starts.len() {
        starts[i] += starts[i - 1];
    }
    let mut half_edges = vec![0_u64; triangles.len() * 3];
    for (t, &[a, b, c]) in triangles.iter().enumerate() {
        for (edge, (from, to)) in [(a, b), (b, c), (c, a)].into_iter().enumerate() {
            let place = &mut starts[from.min(to) as usize + 1];
            half_edges[*place as usize] = pack(from.max(to), t, edge, from < to);
            *place += 1;
        }
    }
    starts.pop();
    (starts, half_edges)
}

/// Sorts each bucket; recursively halves the mesh for parallel work while that pays.
fn sort_buckets(starts: &[u32], half_edges: &mut [u64]) {
    if starts.len() > 1 << 15 {
        let middle = starts.len() / 2;
        let (left, right) = half_edges.split_at_mut((starts[middle] - starts[0]) as usize);
        rayon::join(|| sort_buckets(&starts[..=middle], left), || sort_buckets(&starts[middle..], right));
        return;
    }
    for range in starts.windows(2) {
        half_edges[(range[0] - starts[0]) as usize..(range[1] - starts[0]) as usize].sort_unstable();
    }
}
