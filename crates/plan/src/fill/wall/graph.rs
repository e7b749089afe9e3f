//! Centre-lines joined into a graph.
//!
//! Lines are cut where they cross and where another line ends next to them (T and L). Ends within the tolerance become
//! one node, so that two T-junctions that nearly face each other become one X; pieces shorter than the tolerance vanish
//! in their node. A node where only two pieces meet without a kink is removed, and they become one edge.

use glam::DVec2;
use planar::medial::Node;
use planar::polyline::point_at;
use rstar::RTree;
use rstar::primitives::GeomWithData;
use std::collections::BTreeMap;

/// Two edges that meet with a smaller turn than this become one, rad (25°).
pub const KINK: f64 = 25.0 * std::f64::consts::PI / 180.0;

/// A centre-line.
#[derive(Debug, Clone, PartialEq)]
pub struct Line {
    /// Its points, each with half the thickness of the wall there, mm.
    pub nodes: Vec<Node>,
    /// Whether it ends where it began; the first point is then not repeated.
    pub closed: bool,
}

/// A piece of centre-line between two nodes.
#[derive(Debug, Clone, PartialEq)]
pub struct Edge {
    /// The node where it begins: index into [`Graph::places`].
    pub from: usize,
    /// The node where it ends; the same as `from` for a loop.
    pub to: usize,
    /// At least two points; the first and the last are at the nodes.
    pub nodes: Vec<Node>,
}

/// Nodes and the edges between them.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Graph {
    /// Where the nodes are.
    pub places: Vec<DVec2>,
    /// The edges.
    pub edges: Vec<Edge>,
}

/// A position on a line: the index of a segment, and the fraction of it before the position.
type Cut = (usize, f64);

impl Edge {
    /// The points of the edge, mm.
    pub fn path(&self) -> Vec<DVec2> {
        self.nodes.iter().map(|node| node.at).collect()
    }

    /// Length, mm.
    pub fn length(&self) -> f64 {
        self.nodes.windows(2).map(|w| w[0].at.distance(w[1].at)).sum()
    }

    /// The direction in which it leaves its first node (its last if not `forward`), measured over `reach` (mm).
    pub fn direction(&self, forward: bool, reach: f64) -> DVec2 {
        let mut path = self.path();
        if !forward {
            path.reverse();
        }
        let reach = reach.min(0.5 * self.length());
        let there = point_at(&path, reach).unwrap_or_default();
        path.first().map_or(DVec2::X, |&here| (there - here).normalize_or(DVec2::X))
    }

    fn reversed(mut self) -> Self {
        self.nodes.reverse();
        Self { from: self.to, to: self.from, nodes: self.nodes }
    }
}

impl Graph {
    /// The graph of centre-lines; lines that come closer together than `tolerance` (mm) meet.
    pub fn of(lines: &[Line], tolerance: f64) -> Self {
        let lines: Vec<Line> = lines.iter().filter_map(opened).collect();
        let (mut cuts, pieces) = (crossings(&lines), pieces(&lines));
        for (i, line) in lines.iter().enumerate().filter(|(_, line)| !line.closed) {
            for end in [line.nodes.first(), line.nodes.last()].into_iter().flatten() {
                touches(&pieces, i, end.at, tolerance).for_each(|(other, cut)| cuts[other].push(cut));
            }
        }
        let cut = lines.iter().zip(&mut cuts).flat_map(|(line, cuts)| pieces_of(line, cuts, tolerance));
        Self::joining(cut.collect(), tolerance).without_passed(tolerance)
    }

    /// Whether an edge is a ring: it returns to its start without a kink and meets no other edge.
    pub fn is_ring(&self, edge: &Edge, degrees: &[usize]) -> bool {
        let reach = edge.nodes.first().map_or(0.0, |node| 2.0 * node.radius);
        let turn = edge.direction(true, reach).angle_to(-edge.direction(false, reach)).abs();
        edge.from == edge.to && degrees[edge.from] == 2 && turn < 2.0 * KINK
    }

    /// How many edge ends meet at each node.
    pub fn degrees(&self) -> Vec<usize> {
        let mut degrees = vec![0; self.places.len()];
        self.edges.iter().flat_map(|e| [e.from, e.to]).for_each(|node| degrees[node] += 1);
        degrees
    }

    /// Joins ends within the tolerance into one node; cuts outweigh other ends in placing it.
    fn joining(pieces: Vec<(Vec<Node>, [bool; 2])>, tolerance: f64) -> Self {
        let ends: Vec<(DVec2, bool)> = pieces
            .iter()
            .flat_map(|(nodes, cut)| [(nodes[0].at, cut[0]), (nodes[nodes.len() - 1].at, cut[1])])
            .collect();
        let cluster = clusters(&ends, tolerance);
        let count = cluster.iter().max().map_or(0, |last| last + 1);
        let mut sums = vec![(DVec2::ZERO, 0.0); count];
        for ((at, is_cut), &node) in ends.iter().zip(&cluster) {
            let weight = if *is_cut { 1.0 } else { 1e-6 };
            sums[node] = (sums[node].0 + *at * weight, sums[node].1 + weight);
        }
        let places: Vec<DVec2> = sums.iter().map(|(sum, weight)| *sum / *weight).collect();
        let mut edges = Vec::new();
        for (i, (mut nodes, _)) in pieces.into_iter().enumerate() {
            let (from, to) = (cluster[2 * i], cluster[2 * i + 1]);
            let last = nodes.len() - 1;
            (nodes[0].at, nodes[last].at) = (places[from], places[to]);
            let edge = Edge { from, to, nodes };
            if from != to || edge.length() > 3.0 * tolerance {
                edges.push(edge);
            }
        }
        Self { places, edges }
    }

    /// Removes nodes that a line only passes through, and those where nothing meets.
    fn without_passed(self, tolerance: f64) -> Self {
        let Self { places, edges } = self;
        let mut at: Vec<Vec<usize>> = vec![Vec::new(); places.len()];
        for (e, edge) in edges.iter().enumerate() {
            at[edge.from].push(e);
            at[edge.to].push(e);
        }
        let mut edges: Vec<Option<Edge>> = edges.into_iter().map(Some).collect();
        for node in 0..places.len() {
            // A loop at the node is listed twice.
            let [a, b] = at[node][..] else { continue };
            let (Some(first), Some(second)) = (&edges[a], &edges[b]) else { continue };
            let toward = |edge: &Edge| edge.direction(edge.from == node, tolerance);
            let is_loop = a == b || first.from == first.to || second.from == second.to;
            if is_loop || toward(first).angle_to(-toward(second)).abs() >= KINK {
                continue;
            }
            let (Some(first), Some(second)) = (edges[a].take(), edges[b].take()) else { continue };
            let first = if first.to == node { first } else { first.reversed() };
            let second = if second.from == node { second } else { second.reversed() };
            let nodes = first.nodes.into_iter().chain(second.nodes.into_iter().skip(1)).collect();
            let joined = edges.len();
            for end in [first.from, second.to] {
                at[end].iter_mut().filter(|e| **e == a || **e == b).for_each(|e| *e = joined);
            }
            edges.push(Some(Edge { from: first.from, to: second.to, nodes }));
        }
        Self { places, edges: edges.into_iter().flatten().collect() }.numbered()
    }

    fn numbered(mut self) -> Self {
        let mut number = vec![None; self.places.len()];
        let mut places = Vec::new();
        for end in self.edges.iter_mut().flat_map(|e| [&mut e.from, &mut e.to]) {
            *end = *number[*end].get_or_insert_with(|| {
                places.push(self.places[*end]);
                places.len() - 1
            });
        }
        Self { places, edges: self.edges }
    }
}

/// A line with its first point repeated at the end if it is closed; `None` if it is a single point.
fn opened(line: &Line) -> Option<Line> {
    let mut nodes = line.nodes.clone();
    nodes.dedup_by(|a, b| a.at == b.at);
    if line.closed && nodes.len() > 2 && nodes[0].at != nodes[nodes.len() - 1].at {
        nodes.push(nodes[0]);
    }
    (nodes.len() >= 2).then_some(Line { nodes, closed: line.closed })
}

/// Where lines cross each other and themselves.
fn crossings(lines: &[Line]) -> Vec<Vec<Cut>> {
    let mut segments: Vec<(usize, usize, DVec2, DVec2)> = Vec::new();
    for (i, line) in lines.iter().enumerate() {
        segments.extend(line.nodes.windows(2).enumerate().map(|(k, w)| (i, k, w[0].at, w[1].at)));
    }
    segments.sort_by(|a, b| a.2.x.min(a.3.x).total_cmp(&b.2.x.min(b.3.x)));
    let mut cuts = vec![Vec::new(); lines.len()];
    let mut active: Vec<usize> = Vec::new();
    for s in 0..segments.len() {
        let (i, k, a, b) = segments[s];
        active.retain(|&o| segments[o].2.x.max(segments[o].3.x) >= a.x.min(b.x));
        for &o in &active {
            let (j, l, c, d) = segments[o];
            let last = lines[i].nodes.len().saturating_sub(2);
            let neighbours = k.abs_diff(l) <= 1 || (lines[i].closed && k.min(l) == 0 && k.max(l) == last);
            if let Some((t, u)) = crossing(a, b, c, d).filter(|_| i != j || !neighbours) {
                cuts[i].push((k, t));
                cuts[j].push((l, u));
            }
        }
        active.push(s);
    }
    cuts
}

/// Where two segments cross or touch, as fractions along each.
fn crossing(a: DVec2, b: DVec2, c: DVec2, d: DVec2) -> Option<(f64, f64)> {
    let (r, s) = (b - a, d - c);
    let area = r.perp_dot(s);
    let (t, u) = ((c - a).perp_dot(s) / area, (c - a).perp_dot(r) / area);
    let within = |share: f64| (0.0..=1.0).contains(&share);
    (within(t) && within(u)).then_some((t, u))
}

/// A piece of a line: number of the line, number of the piece in it.
type Piece = GeomWithData<rstar::primitives::Line<[f64; 2]>, (usize, usize)>;

/// The pieces of all lines, searchable by position.
fn pieces(lines: &[Line]) -> RTree<Piece> {
    let of = |(i, line): (usize, &Line)| {
        let piece = move |(k, w): (usize, &[Node])| {
            GeomWithData::new(rstar::primitives::Line::new(w[0].at.to_array(), w[1].at.to_array()), (i, k))
        };
        line.nodes.windows(2).enumerate().map(piece).collect::<Vec<_>>()
    };
    RTree::bulk_load(lines.iter().enumerate().flat_map(of).collect())
}

/// The point nearest to `end` on every other line, if within the tolerance; cuts at a line's ends drop out later.
fn touches(pieces: &RTree<Piece>, own: usize, end: DVec2, tolerance: f64) -> impl Iterator<Item = (usize, Cut)> + '_ {
    let mut nearest: BTreeMap<usize, (f64, Cut)> = BTreeMap::new();
    let near = pieces.locate_within_distance(end.to_array(), tolerance * tolerance * (1.0 + 1e-9));
    for piece in near.filter(|piece| piece.data.0 != own) {
        let (a, b) = (DVec2::from(piece.geom().from), DVec2::from(piece.geom().to));
        let share = ((end - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
        let (distance, (line, k)) = (end.distance(a.lerp(b, share)), piece.data);
        let best = nearest.entry(line).or_insert((distance, (k, share)));
        // Of equally near pieces, the first.
        if (distance, k) < (best.0, best.1.0) {
            *best = (distance, (k, share));
        }
    }
    nearest.into_iter().filter(move |(_, (distance, _))| *distance <= tolerance).map(|(line, (_, cut))| (line, cut))
}

/// The pieces of a line between its cuts, each with whether its start and its end are cuts.
fn pieces_of(line: &Line, cuts: &mut Vec<Cut>, tolerance: f64) -> Vec<(Vec<Node>, [bool; 2])> {
    let mut along = vec![0.0];
    for w in line.nodes.windows(2) {
        along.push(along[along.len() - 1] + w[0].at.distance(w[1].at));
    }
    let total = along[along.len() - 1];
    let place = |&(k, t): &Cut| along[k] + t * (along[k + 1] - along[k]);
    cuts.sort_by(|a, b| place(a).total_cmp(&place(b)));
    cuts.dedup_by(|a, b| place(a) - place(b) < 1e-9);
    if !line.closed {
        // A cut at an end counts as that end.
        cuts.retain(|cut| place(cut) > tolerance && place(cut) < total - tolerance);
    }
    let mut pieces = Vec::new();
    let (mut piece, mut starts_cut, mut next) = (vec![line.nodes[0]], false, 0);
    for (k, w) in line.nodes.windows(2).enumerate() {
        while let Some(&(_, t)) = cuts.get(next).filter(|cut| cut.0 == k) {
            let at = Node { at: w[0].at.lerp(w[1].at, t), radius: w[0].radius + t * (w[1].radius - w[0].radius) };
            piece.push(at);
            pieces.push((std::mem::replace(&mut piece, vec![at]), [starts_cut, true]));
            (starts_cut, next) = (true, next + 1);
        }
        piece.push(w[1]);
    }
    // The remainder of a closed line continues into its first piece.
    match pieces.first_mut().filter(|_| line.closed) {
        Some((first, [is_cut, _])) => {
            piece.extend(first.drain(..).skip(1));
            (*first, *is_cut) = (piece, true);
        }
        None => pieces.push((piece, [starts_cut, false])),
    }
    for (piece, _) in &mut pieces {
        piece.dedup_by(|a, b| a.at == b.at);
    }
    pieces.retain(|(piece, _)| piece.len() >= 2);
    pieces
}

/// The cluster index of each end: ends within the tolerance of each other, directly or through others, share a cluster.
fn clusters(ends: &[(DVec2, bool)], tolerance: f64) -> Vec<usize> {
    let places = ends.iter().enumerate().map(|(i, (at, _))| GeomWithData::new(at.to_array(), i));
    let tree: RTree<GeomWithData<[f64; 2], usize>> = RTree::bulk_load(places.collect());
    let mut cluster = vec![usize::MAX; ends.len()];
    let mut count = 0;
    for first in 0..ends.len() {
        if cluster[first] != usize::MAX {
            continue;
        }
        let mut open = vec![first];
        cluster[first] = count;
        while let Some(here) = open.pop() {
            for other in tree.locate_within_distance(ends[here].0.to_array(), tolerance * tolerance) {
                if cluster[other.data] == usize::MAX {
                    cluster[other.data] = count;
                    open.push(other.data);
                }
            }
        }
        count += 1;
    }
    cluster
}
