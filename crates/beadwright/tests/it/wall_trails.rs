//! The fewest trails that cover a plane graph and never cross, on random graphs.

use beadwright::fill::trails::{Dart, Network, Trail, trails};
use glam::DVec2;
use std::collections::HashMap;

/// Numbers that look random (SplitMix64).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// A graph with straight edges.
struct Drawing {
    places: Vec<DVec2>,
    edges: Vec<[usize; 2]>,
}

impl Drawing {
    /// Some edges of a grid of triangles, its nodes moved a little.
    fn random(random: &mut Random) -> Self {
        let size = 2 + (random.next() * 5.0) as usize;
        let keep = 0.3 + 0.7 * random.next();
        let mut drawing = Self { places: Vec::new(), edges: Vec::new() };
        for y in 0..size {
            for x in 0..size {
                let moved = DVec2::new(random.next(), random.next()) * 0.3;
                drawing.places.push(DVec2::new(x as f64, y as f64) + moved);
                for (dx, dy) in [(1, 0), (0, 1), (1, 1)] {
                    if x + dx < size && y + dy < size && random.next() < keep {
                        drawing.edges.push([y * size + x, (y + dy) * size + x + dx]);
                    }
                }
            }
        }
        drawing
    }

    fn node(&self, dart: Dart) -> usize {
        self.edges[dart / 2][dart % 2]
    }

    fn angle(&self, dart: Dart) -> f64 {
        (self.places[self.node(dart ^ 1)] - self.places[self.node(dart)]).to_angle()
    }

    fn network(&self) -> Network {
        let mut stars = vec![Vec::new(); self.places.len()];
        for dart in 0..2 * self.edges.len() {
            stars[self.node(dart)].push((dart, self.angle(dart)));
        }
        stars.iter_mut().for_each(|star| star.sort_by(|a, b| a.1.total_cmp(&b.1)));
        Network { stars, walls: (0..self.edges.len()).collect() }
    }

    /// The connected graph of each node, by its lowest node.
    fn components(&self) -> Vec<usize> {
        let mut component: Vec<usize> = (0..self.places.len()).collect();
        for _ in 0..self.places.len() {
            for [a, b] in &self.edges {
                let low = component[*a].min(component[*b]);
                (component[*a], component[*b]) = (low, low);
            }
        }
        component
    }
}

fn check(drawing: &Drawing) -> Vec<Trail> {
    let found = trails(&drawing.network());
    assert_each_edge_once(drawing, &found);
    assert_fewest(drawing, &found);
    assert_no_crossing(drawing, &found);
    found
}

fn assert_each_edge_once(drawing: &Drawing, found: &[Trail]) {
    let mut edges: Vec<usize> = found.iter().flat_map(|t| &t.darts).map(|d| d / 2).collect();
    edges.sort_unstable();
    assert!(edges.iter().copied().eq(0..drawing.edges.len()));
    for trail in found {
        let again = trail.closed.then(|| trail.darts[0]);
        let darts: Vec<Dart> = trail.darts.iter().copied().chain(again).collect();
        assert!(darts.windows(2).all(|w| drawing.node(w[0] ^ 1) == drawing.node(w[1])), "edges follow each other");
    }
}

fn assert_fewest(drawing: &Drawing, found: &[Trail]) {
    let component = drawing.components();
    let mut odd: HashMap<usize, usize> = HashMap::new();
    for (node, component) in component.iter().enumerate() {
        let degree = drawing.edges.iter().flatten().filter(|&&end| end == node).count();
        if degree > 0 {
            *odd.entry(*component).or_default() += degree % 2;
        }
    }
    let mut laid: HashMap<usize, usize> = HashMap::new();
    for trail in found {
        *laid.entry(component[drawing.node(trail.darts[0])]).or_default() += 1;
    }
    let expected: HashMap<usize, usize> = odd.into_iter().map(|(c, odd)| (c, (odd / 2).max(1))).collect();
    assert_eq!(laid, expected);
}

/// Two transitions at a node cross when their four darts alternate around it.
fn assert_no_crossing(drawing: &Drawing, found: &[Trail]) {
    let mut at_node: HashMap<usize, Vec<[f64; 2]>> = HashMap::new();
    for trail in found {
        let count = trail.darts.len();
        for i in 0..if trail.closed { count } else { count - 1 } {
            let (into, out) = (trail.darts[i] ^ 1, trail.darts[(i + 1) % count]);
            at_node.entry(drawing.node(out)).or_default().push([drawing.angle(into), drawing.angle(out)]);
        }
    }
    for pairs in at_node.values() {
        for (i, [a, b]) in pairs.iter().enumerate() {
            let between = |angle: f64| angle > a.min(*b) && angle < a.max(*b);
            assert!(pairs[i + 1..].iter().all(|[c, d]| between(*c) == between(*d)), "paths cross");
        }
    }
}

#[test]
fn random_plane_graphs_get_the_fewest_trails_and_none_cross() {
    let mut random = Random(7);
    let mut edges = 0;
    for _ in 0..600 {
        let drawing = Drawing::random(&mut random);
        edges += drawing.edges.len();
        check(&drawing);
    }
    assert!(edges > 10_000, "{edges}");
}

#[test]
fn a_star_of_many_arms_goes_there_and_back() {
    let arm = |k: usize| DVec2::from_angle(k as f64);
    for arms in 1..20 {
        let places = std::iter::once(DVec2::ZERO).chain((0..arms).map(arm)).collect();
        let drawing = Drawing { places, edges: (1..=arms).map(|k| [0, k]).collect() };
        check(&drawing);
    }
}

#[test]
fn the_frame_of_the_paper_needs_two() {
    // 田: corners 0 2 6 8, middles of the sides 1 3 5 7, middle 4.
    let places = (0..9).map(|k| DVec2::new(f64::from(k % 3), f64::from(k / 3))).collect();
    let edges = [[0, 1], [1, 2], [3, 4], [4, 5], [6, 7], [7, 8], [0, 3], [3, 6], [1, 4], [4, 7], [2, 5], [5, 8]];
    assert_eq!(check(&Drawing { places, edges: edges.to_vec() }).len(), 2);
}
