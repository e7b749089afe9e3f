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

/// The triangles across all edges, and how clean the edges are.
#[derive(Debug, Default)]
pub(crate) struct Adjacency {
    pub(crate) neighbours: Vec<[u32; 3]>,
    /// Half-edges of edges that are not shared by exactly two triangles in opposite directions, edge by edge.
    pub(crate) odd_edges: Vec<Vec<HalfEdge>>,
}

impl Adjacency {
    pub(crate) fn new(vertex_count: usize, triangles: &[[u32; 3]]) -> Self {
        let mut result = Self { neighbours: vec![[NO_NEIGHBOUR; 3]; triangles.len()], odd_edges: Vec::new() };
        let (starts, half_edges) = bucket_by_lower_vertex(vertex_count, triangles);
        let mut bucket: Vec<(u32, HalfEdge)> = Vec::new();
        for range in starts.windows(2) {
            bucket.clear();
            for &packed in &half_edges[range[0] as usize..range[1] as usize] {
                let (triangle, edge) = (packed / 3, (packed % 3) as u8);
                let (a, b) = ends(triangles[triangle as usize], edge);
                bucket.push((a.max(b), HalfEdge { triangle, edge, forward: a < b }));
            }
            bucket.sort_unstable_by_key(|&(higher, h)| (higher, h.triangle, h.edge));
            for edge in bucket.chunk_by(|x, y| x.0 == y.0) {
                result.match_edge(edge);
            }
        }
        result
    }

    /// Joins the half-edges of one edge in pairs of opposite direction.
    fn match_edge(&mut self, edge: &[(u32, HalfEdge)]) {
        if let [(_, a), (_, b)] = *edge
            && a.forward != b.forward
        {
            return self.join(a, b);
        }
        let side = |forward: bool| edge.iter().map(|e| e.1).filter(move |h| h.forward == forward);
        for (a, b) in side(true).zip(side(false)) {
            self.join(a, b);
        }
        self.odd_edges.push(edge.iter().map(|e| e.1).collect());
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

/// Counting sort: bucket starts, and `3 · triangle + edge` in each bucket.
fn bucket_by_lower_vertex(vertex_count: usize, triangles: &[[u32; 3]]) -> (Vec<u32>, Vec<u32>) {
    let lower = |t: &[u32; 3]| [t[0].min(t[1]), t[1].min(t[2]), t[2].min(t[0])];
    let mut starts = vec![0_u32; vertex_count + 2];
    for triangle in triangles {
        for vertex in lower(triangle) {
            starts[vertex as usize + 2] += 1;
        }
    }
    for i in 2..starts.len() {
        starts[i] += starts[i - 1];
    }
    let mut half_edges = vec![0_u32; triangles.len() * 3];
    for (t, triangle) in triangles.iter().enumerate() {
        for (edge, vertex) in lower(triangle).into_iter().enumerate() {
            let place = &mut starts[vertex as usize + 1];
            half_edges[*place as usize] = (3 * t + edge) as u32;
            *place += 1;
        }
    }
    starts.pop();
    (starts, half_edges)
}
