//! The centre-lines of an island: its medial axis without the branches into corners, cut where walls turn sharply.

use super::graph::{KINK, Line};
use glam::DVec2;
use planar::medial::{Branch, CORNER, MedialAxis, MedialOptions, Node};
use planar::{Bounds, Polygon};

/// At a sharp turn between walls at an angle θ, the largest disc is larger than along the walls by at least this
/// fraction. The radii are 1/(1 + sin(θ/2)) and 1/2 of the wall thickness.
const BUMP: f64 = 0.015;
/// Nodes are at least this fraction of the spacing apart.
const CLOSEST: f64 = 0.5;
/// How far from a turn the walls that meet there are searched for, in disc radii.
const SIGHT: f64 = 1.5;

/// The centre-lines, with half the wall thickness along them, sampled about `spacing` (mm) apart. A disc has no
/// centre-line and gets a short line across it.
pub fn lines(island: &Polygon, spacing: f64) -> Vec<Line> {
    let options = MedialOptions { spacing, ..MedialOptions::default() };
    let axis = MedialAxis::of(island, &options).pruned(CORNER);
    if axis.branches.is_empty() {
        return axis.junctions.first().map(dot).into_iter().collect();
    }
    axis.branches.iter().map(|branch| thinned(branch, CLOSEST * spacing)).flat_map(|b| cut_at_corners(&b)).collect()
}

/// Drops nodes closer than `least` (mm) to the one before: over such short distances the axis may step backwards.
fn thinned(branch: &Branch, least: f64) -> Branch {
    let mut nodes: Vec<Node> = Vec::with_capacity(branch.nodes.len());
    for node in &branch.nodes {
        if nodes.last().is_none_or(|last| last.at.distance(node.at) >= least) {
            nodes.push(*node);
        }
    }
    if let Some(&last) = branch.nodes.last() {
        while nodes.len() > 1 && nodes[nodes.len() - 1].at.distance(last.at) < least {
            nodes.pop();
        }
        nodes.push(last);
    }
    Branch { nodes, ..*branch }
}

/// A line just long enough to be welded, across a part that is as long as wide.
fn dot(disc: &Node) -> Line {
    let half = DVec2::X * 0.25 * disc.radius;
    let node = |at: DVec2| Node { at, radius: disc.radius };
    Line { nodes: vec![node(disc.at - half), node(disc.at + half)], closed: false }
}

/// The pieces of a branch between its corners.
fn cut_at_corners(branch: &Branch) -> Vec<Line> {
    let corners = corners(branch);
    let nodes = &branch.nodes;
    if corners.is_empty() {
        return vec![Line { nodes: placed(nodes, branch.is_closed()), closed: branch.is_closed() }];
    }
    let ends: Vec<usize> = std::iter::once(0).chain(corners).chain([nodes.len() - 1]).collect();
    let piece = |w: &[usize]| Line { nodes: nodes[w[0]..=w[1]].to_vec(), closed: false };
    // A loop continues through its start, unless that is a junction: the graph joins pieces that meet without a kink.
    ends.windows(2).filter(|w| w[0] < w[1]).map(piece).collect()
}

/// The nodes of a loop, starting at the rightmost point level with its middle, so that loops on top of each other start
/// above each other.
fn placed(nodes: &[Node], closed: bool) -> Vec<Node> {
    let mut nodes = nodes.to_vec();
    if closed && nodes.len() > 2 {
        nodes.pop();
        let middle = Bounds::of(nodes.iter().map(|node| node.at)).map(|bounds| bounds.center()).unwrap_or_default();
        let next = nodes.iter().cycle().skip(1);
        let level = |(a, b): (&Node, &Node)| (a.at.y > middle.y) != (b.at.y > middle.y);
        let crossings = nodes.iter().zip(next).enumerate().filter(|(_, pair)| level(*pair));
        let first = crossings.max_by(|(_, a), (_, b)| a.0.at.x.total_cmp(&b.0.at.x)).map_or(0, |(i, _)| i);
        nodes.rotate_left(first);
    }
    nodes
}

/// Indices of nodes where two straight walls meet at a corner: the disc there is larger than before and after, and
/// the line turns.
fn corners(branch: &Branch) -> Vec<usize> {
    let nodes = &branch.nodes;
    let mut along = vec![0.0];
    for w in nodes.windows(2) {
        along.push(along[along.len() - 1] + w[0].at.distance(w[1].at));
    }
    let total = along[along.len() - 1];
    let walk = Walk { nodes, along: &along, closed: branch.is_closed().then_some(total) };
    let mut found: Vec<usize> = Vec::new();
    for (i, node) in nodes.iter().enumerate().skip(1).take(nodes.len().saturating_sub(2)) {
        let reach = SIGHT * node.radius;
        let Some([before, behind]) = walk.around(i, reach) else { continue };
        let bump = node.radius / before.radius.max(behind.radius) - 1.0;
        let Some([far_before, far_behind]) = walk.around(i, 2.0 * reach) else { continue };
        let turn = (before.at - far_before.at).angle_to(far_behind.at - behind.at).abs();
        if bump < BUMP || turn < KINK {
            continue;
        }
        match found.last_mut() {
            Some(last) if along[i] - along[*last] < reach => {
                if node.radius > nodes[*last].radius {
                    *last = i;
                }
            }
            _ => found.push(i),
        }
    }
    found
}

/// Nodes with their distances along the line, mm, and the total length if the line is closed.
struct Walk<'a> {
    nodes: &'a [Node],
    along: &'a [f64],
    closed: Option<f64>,
}

impl Walk<'_> {
    /// The nodes `reach` (mm) before and after node `i`; `None` if an open line ends first.
    fn around(&self, i: usize, reach: f64) -> Option<[Node; 2]> {
        Some([self.at(self.along[i] - reach)?, self.at(self.along[i] + reach)?])
    }

    fn at(&self, place: f64) -> Option<Node> {
        let place = match self.closed {
            Some(total) => place.rem_euclid(total),
            None => place,
        };
        let behind = self.along.partition_point(|&s| s < place);
        (place >= 0.0).then(|| self.nodes.get(behind).copied()).flatten()
    }
}
