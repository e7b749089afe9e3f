//! Edges made smooth: straight into their nodes, and fitted.
//!
//! Near a corner or a junction the medial axis leaves the middle of the walls, since the disc extends into the space
//! where they meet. There the disc's radius decreases away from the node. An edge keeps only what lies beyond that
//! section and continues straight to the node, which is moved to where these lines come nearest to each other (least
//! squares). The thickness along the straight section is that of the wall.

use super::graph::Graph;
use bead_part::curve::Nurbs;
use glam::{DMat2, DVec2, DVec3};
use planar::medial::Node;
use planar::polyline::distance_squared_to_segment;

/// Where the radius decreases by less than this per mm, it is that of the wall.
const LEVEL: f64 = 0.02;
/// The wall counts as undisturbed only this much farther on, in radii: the radius levels off slowly.
const MARGIN: f64 = 0.4;
/// The slope of the radius and the direction of a wall are measured over this fraction of the radius.
const WINDOW: f64 = 0.5;
/// An edge may be straightened up to this far from a node, in radii at the node.
const FARTHEST: f64 = 3.0;
/// At most this fraction of an edge is straightened at either end.
const MOST: f64 = 0.45;

/// Nodes are at most this many radii apart when a curve is fitted to them.
const STEP: f64 = 0.5;
/// Most steps between two nodes.
const MOST_STEPS: f64 = 1000.0;
/// A fitted curve that strays from the nodes by more than this many tolerances is not used.
const STRAY: f64 = 4.0;

/// Straightens the ends of all edges at nodes where edges meet, and moves the nodes there.
pub fn straighten(graph: &mut Graph) {
    let degrees = graph.degrees();
    let rings: Vec<bool> = graph.edges.iter().map(|edge| graph.is_ring(edge, &degrees)).collect();
    let mut lines: Vec<Vec<(DVec2, DVec2)>> = vec![Vec::new(); graph.places.len()];
    for (edge, is_ring) in graph.edges.iter_mut().zip(&rings) {
        for node in [edge.from, edge.to] {
            if degrees[node] > 1 && !is_ring {
                lines[node].extend(shorten(&mut edge.nodes));
            }
            edge.nodes.reverse();
        }
    }
    for (place, lines) in graph.places.iter_mut().zip(&lines) {
        *place = nearest_to(lines, *place);
    }
    for (edge, _) in graph.edges.iter_mut().zip(&rings).filter(|(_, is_ring)| !*is_ring) {
        for node in [edge.from, edge.to] {
            lead_to(&mut edge.nodes, graph.places[node], degrees[node] > 1);
            edge.nodes.reverse();
        }
    }
}

/// Removes the nodes near the first one, as long as the radius decreases. Returns where the wall begins, and its
/// direction from there to the node.
fn shorten(nodes: &mut Vec<Node>) -> Option<(DVec2, DVec2)> {
    let radius = nodes.first()?.radius;
    let mut along = vec![0.0];
    for w in nodes.windows(2) {
        along.push(along[along.len() - 1] + w[0].at.distance(w[1].at));
    }
    let limit = (FARTHEST * radius).min(MOST * along[along.len() - 1]);
    let ahead = |i: usize| {
        let far = along.partition_point(|&s| s < along[i] + WINDOW * nodes[i].radius);
        far.min(nodes.len() - 1).max(i + 1).min(nodes.len() - 1)
    };
    let falls = |i: usize| {
        let far = ahead(i);
        nodes[i].radius - nodes[far].radius > LEVEL * (along[far] - along[i])
    };
    let level = (0..nodes.len()).find(|&i| along[i] > limit || !falls(i))?;
    // Where the radius does not decrease, nothing is disturbed.
    let undisturbed = if level == 0 { 0.0 } else { (along[level] + MARGIN * nodes[level].radius).min(limit) };
    let first = along.partition_point(|&s| s < undisturbed).min(nodes.len() - 1);
    let (wall, far) = (nodes[first], nodes[ahead(first)]);
    let way = (wall.at - far.at).try_normalize()?;
    nodes.drain(..first);
    Some((wall.at, way))
}

/// The point with the least sum of squared distances from lines, each a point and a direction; `fallback` if they are
/// parallel or meet far away.
fn nearest_to(lines: &[(DVec2, DVec2)], fallback: DVec2) -> DVec2 {
    let mut matrix = DMat2::ZERO;
    let mut right = DVec2::ZERO;
    for (point, way) in lines {
        let normal = way.perp();
        let outer = DMat2::from_cols(normal * normal.x, normal * normal.y);
        matrix += outer;
        right += outer * *point;
    }
    let reach = lines.iter().map(|(point, _)| point.distance(fallback)).fold(0.0, f64::max);
    if lines.len() < 2 || matrix.determinant() < 0.05 {
        return fallback;
    }
    let place = matrix.inverse() * right;
    if place.distance(fallback) <= reach.max(1e-6) { place } else { fallback }
}

/// Extends an edge straight from a node to where its wall begins; the thickness is that of the wall.
fn lead_to(nodes: &mut Vec<Node>, place: DVec2, straight: bool) {
    let Some(&wall) = nodes.first() else { return };
    if !straight {
        nodes[0].at = place;
        return;
    }
    let (length, step) = (wall.at.distance(place), 0.25 * wall.radius);
    if length < 1e-9 {
        return;
    }
    let count = (length / step.max(1e-6)).ceil().clamp(1.0, 50.0) as usize;
    let lead = (0..count).map(|k| Node { at: place.lerp(wall.at, k as f64 / count as f64), radius: wall.radius });
    nodes.splice(0..0, lead);
}

/// Fits a smooth curve to every edge, position and thickness together, within `error` (mm), and replaces the edge by
/// chords that deviate from the curve by at most that. Edges that cannot be fitted are unchanged.
pub fn fit(graph: &mut Graph, error: f64) {
    let degrees = graph.degrees();
    let rings: Vec<bool> = graph.edges.iter().map(|edge| graph.is_ring(edge, &degrees)).collect();
    for (edge, closed) in graph.edges.iter_mut().zip(rings) {
        let Some(nodes) = fitted(&edge.nodes, closed, error) else { continue };
        edge.nodes = nodes;
        if let (true, Some(first)) = (closed, edge.nodes.first()) {
            graph.places[edge.from] = first.at;
        }
    }
}

/// A smooth line near nodes, as nodes; `None` if none stays near them throughout.
fn fitted(nodes: &[Node], closed: bool, error: f64) -> Option<Vec<Node>> {
    let mut points: Vec<DVec3> = dense(nodes).map(|node| node.at.extend(2.0 * node.radius)).collect();
    if closed {
        points.pop();
    }
    let fit = Nurbs::fitted(&points, closed, error).ok()?;
    let node = |p: DVec3| Node { at: p.truncate(), radius: p.z / 2.0 };
    let smooth: Vec<Node> = fit.curve.points_by_chord(error).into_iter().map(node).collect();
    stays_near(&smooth, nodes, STRAY * error).then_some(smooth)
}

/// The nodes with more inserted between those far apart: between its points a fitted curve is unconstrained.
fn dense(nodes: &[Node]) -> impl Iterator<Item = Node> + '_ {
    let between = nodes.windows(2).flat_map(|w| {
        let (a, b) = (w[0], w[1]);
        let step = STEP * a.radius.max(b.radius);
        let count = (a.at.distance(b.at) / step.max(1e-6)).ceil().clamp(1.0, MOST_STEPS) as usize;
        (0..count).map(move |k| {
            let part = k as f64 / count as f64;
            Node { at: a.at.lerp(b.at, part), radius: a.radius + (b.radius - a.radius) * part }
        })
    });
    between.chain(nodes.last().copied())
}

/// Whether every node of `line` lies within `tolerance` (mm) of the polyline through `nodes`; both run the same way.
fn stays_near(line: &[Node], nodes: &[Node], tolerance: f64) -> bool {
    let near = |p: DVec2, w: &[Node]| distance_squared_to_segment(p, w[0].at, w[1].at) <= tolerance * tolerance;
    let mut pieces = nodes.windows(2).enumerate().cycle();
    let mut now = pieces.next();
    line.iter().all(|node| {
        // Usually it is the same piece as for the previous node, or the next one.
        let found = (0..nodes.len()).find(|_| {
            let fits = now.is_some_and(|(_, piece)| near(node.at, piece));
            if !fits {
                now = pieces.next();
            }
            fits
        });
        found.is_some()
    })
}
