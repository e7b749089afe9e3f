//! Thin walls tied to the passes of the thick parts they meet, so that the fewest passes lay everything once.
//!
//! Passes and walls are the edges of a plane graph. Its nodes are the places where walls meet passes or each other, and
//! the ends of open passes. A set of [`trails`] lays every edge, with max(1, odd nodes / 2) arc starts per connected
//! component.

use super::{End, ThinLimits, ThinWall};
use crate::fill::trails::{Dart, Network, Trail, other_end, trails};
use crate::fill::{Path, sound};
use crate::pass::{Along, PassKind};
use glam::DVec2;
use planar::medial::Node;
use planar::polyline;

/// The end of a wall looks for a pass within this many bead widths.
const REACH: f64 = 1.5;
/// Walls that meet a pass within this many bead widths meet it at one point.
const SAME_PLACE: f64 = 0.5;
/// The direction in which an edge leaves a node is measured over this many bead widths.
const SIGHT: f64 = 0.5;
/// Where two passes touch at a node, each keeps this many bead widths away from it.
const ASIDE: f64 = 0.25;
/// Greatest fraction of its edge by which an end is held back from a node.
const MOST: f64 = 0.45;

/// How ends are tied.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TieSettings {
    /// Which walls are thin.
    pub limits: ThinLimits,
    /// Distance of an end from the pass that continues there, in bead widths.
    pub end_gap: f64,
    /// Passes are made at least this long where possible, mm.
    pub shortest: f64,
}

/// Joins passes and walls into the fewest passes. Walls that would then make them cross, as in corners hardly wider
/// than a bead, stay separate passes.
pub fn tie(passes: Vec<Path>, walls: &[ThinWall], settings: &TieSettings) -> Vec<Path> {
    let (mut joined, mut kept, mut loose) = (passes.clone(), Vec::new(), Vec::new());
    // Halve the set until each wall that crosses is alone.
    let mut left = vec![walls];
    while let Some(some) = left.pop().filter(|some| !some.is_empty()) {
        let more: Vec<&ThinWall> = kept.iter().copied().chain(some).collect();
        let together = tied(passes.clone(), &more, settings);
        let lines: Vec<Vec<DVec2>> = together.iter().map(Path::path).collect();
        if sound::crossings(&lines).next().is_none() {
            (joined, kept) = (together, more);
        } else if some.len() == 1 {
            loose.extend(some);
        } else {
            let (first, second) = some.split_at(some.len() / 2);
            left.extend([second, first]);
        }
    }
    joined.extend(tied(Vec::new(), &loose, settings));
    joined
}

fn tied(passes: Vec<Path>, walls: &[&ThinWall], settings: &TieSettings) -> Vec<Path> {
    let mut graph = Graph { width: settings.limits.bead_width, ..Graph::default() };
    let lines: Vec<Line> = passes.iter().map(Line::of_pass).collect();
    let mut places: Vec<Vec<Place>> = vec![Vec::new(); passes.len()];
    for wall in walls {
        graph.add_wall(wall, &lines, &mut places, settings);
    }
    let mut tied = Vec::new();
    for ((pass, line), places) in passes.into_iter().zip(lines).zip(places) {
        if places.is_empty() {
            tied.push(pass);
        } else {
            graph.add_pass(line, places);
        }
    }
    tied.extend(graph.passes(settings));
    tied
}

/// A line with a width for each of its pieces.
#[derive(Debug, Clone, Default)]
struct Line {
    points: Vec<DVec2>,
    widths: Vec<f64>,
    kind: Option<PassKind>,
    closed: bool,
}

/// Where a wall meets a pass: the index of a piece, the fraction of it before the meeting point, and the node there.
#[derive(Debug, Clone, Copy)]
struct Place {
    piece: usize,
    share: f64,
    node: usize,
}

impl Line {
    fn of_pass(pass: &Path) -> Self {
        let points = pass.path();
        let widths = (0..points.len().saturating_sub(1)).map(|i| pass.width.after(i)).collect();
        Self { points, widths, kind: Some(pass.kind), closed: pass.closed }
    }

    fn length(&self) -> f64 {
        polyline::length(&self.points)
    }

    fn reversed(mut self) -> Self {
        self.points.reverse();
        self.widths.reverse();
        self
    }

    /// The direction in which it leaves its first point.
    fn way(&self, reach: f64) -> DVec2 {
        let reach = reach.min(0.5 * self.length());
        let there = polyline::point_at(&self.points, reach).unwrap_or_default();
        self.points.first().map_or(DVec2::X, |&here| (there - here).normalize_or(DVec2::X))
    }

    /// Removes its last `by` mm.
    fn cut_end(&mut self, by: f64) {
        self.points = polyline::without_end(std::mem::take(&mut self.points), by);
        self.widths.truncate(self.points.len().saturating_sub(1));
    }

    /// Leaves its course `by` mm before its end for a point beside the end.
    fn turn_off(&mut self, place: DVec2, by: f64) {
        let width = self.widths.last().copied();
        self.cut_end(by.min(MOST * self.length()));
        self.points.push(place);
        self.widths.extend(width);
    }
}

#[derive(Debug, Default)]
struct Graph {
    width: f64,
    nodes: Vec<DVec2>,
    /// Nodes of the junctions of thin walls, by junction number.
    junctions: Vec<Option<usize>>,
    edges: Vec<(Line, [usize; 2])>,
}

impl Graph {
    fn node(&mut self, place: DVec2) -> usize {
        self.nodes.push(place);
        self.nodes.len() - 1
    }

    fn add_wall(&mut self, wall: &ThinWall, lines: &[Line], places: &mut [Vec<Place>], settings: &TieSettings) {
        let (low, high) = settings.limits.single;
        let mut nodes = wall.nodes.clone();
        let mut ends = [0, 0];
        for side in [0, 1] {
            // The end being handled comes last.
            if side == 0 {
                nodes.reverse();
            }
            let Some(&last) = nodes.last() else { return };
            ends[side] = match &wall.ends[side] {
                End::Free => self.node(last.at),
                End::Junction(number) => self.junction(*number, last.at),
                End::Mouth(tail) => {
                    let path: Vec<DVec2> = std::iter::once(last.at).chain(tail.iter().map(|node| node.at)).collect();
                    match meeting(&path, lines, REACH * self.width) {
                        Some(met) => {
                            nodes.extend(tail.iter().take(met.passed).map(|n| Node { radius: last.radius, ..*n }));
                            let node = self.node_on(met, &mut places[met.line]);
                            let at = self.nodes[node];
                            without_step_back(&mut nodes, at);
                            nodes.push(Node { at, radius: last.radius });
                            node
                        }
                        None => self.node(last.at),
                    }
                }
            };
            if side == 0 {
                nodes.reverse();
            }
        }
        let widths = nodes.windows(2).map(|w| (w[0].radius + w[1].radius).clamp(low, high)).collect();
        let points = nodes.iter().map(|node| node.at).collect();
        self.edges.push((Line { points, widths, kind: Some(PassKind::Wall), closed: false }, ends));
    }

    fn junction(&mut self, number: usize, at: DVec2) -> usize {
        if self.junctions.len() <= number {
            self.junctions.resize(number + 1, None);
        }
        match self.junctions[number] {
            Some(node) => node,
            None => {
                let node = self.node(at);
                self.junctions[number] = Some(node);
                node
            }
        }
    }

    /// The node where a wall meets a pass.
    fn node_on(&mut self, met: Meeting, places: &mut Vec<Place>) -> usize {
        let near = places.iter().find(|place| self.nodes[place.node].distance(met.at) < SAME_PLACE * self.width);
        if let Some(place) = near {
            return place.node;
        }
        let node = self.node(met.at);
        places.push(Place { piece: met.piece, share: met.share, node });
        node
    }

    /// A pass cut where walls meet it.
    fn add_pass(&mut self, line: Line, mut places: Vec<Place>) {
        places.sort_by(|a, b| a.piece.cmp(&b.piece).then(a.share.total_cmp(&b.share)));
        let (first, last) = (places[0], places[places.len() - 1]);
        let stretch = |from: Option<Place>, to: Option<Place>, nodes: &[DVec2]| {
            let (low, high) = (from.map_or(0, |p| p.piece + 1), to.map_or(line.points.len() - 1, |p| p.piece));
            let mut points: Vec<DVec2> = from.map(|p| nodes[p.node]).into_iter().collect();
            points.extend(line.points.get(low..=high).unwrap_or_default());
            points.extend(to.map(|p| nodes[p.node]));
            let widths =
                line.widths[from.map_or(0, |p| p.piece)..=to.map_or(line.widths.len() - 1, |p| p.piece)].to_vec();
            Line { points, widths, kind: line.kind, closed: false }
        };
        for pair in places.windows(2) {
            let edge = stretch(Some(pair[0]), Some(pair[1]), &self.nodes);
            self.edges.push((edge, [pair[0].node, pair[1].node]));
        }
        let (mut begin, end) = (stretch(Some(last), None, &self.nodes), stretch(None, Some(first), &self.nodes));
        if line.closed {
            begin.points.extend(&end.points[1..]);
            begin.widths.extend(&end.widths);
            self.edges.push((begin, [last.node, first.node]));
        } else {
            let [start, stop] = [end.points[0], begin.points[begin.points.len() - 1]].map(|at| self.node(at));
            self.edges.push((end, [start, first.node]));
            self.edges.push((begin, [last.node, stop]));
        }
    }

    fn network(&self) -> Network {
        let mut stars: Vec<Vec<(Dart, f64)>> = vec![Vec::new(); self.nodes.len()];
        for (number, (line, ends)) in self.edges.iter().enumerate() {
            let reach = SIGHT * self.width;
            stars[ends[0]].push((2 * number, line.way(reach).to_angle()));
            stars[ends[1]].push((2 * number + 1, line.clone().reversed().way(reach).to_angle()));
        }
        stars.iter_mut().for_each(|star| star.sort_by(|a, b| a.1.total_cmp(&b.1)));
        Network { stars, walls: (0..self.edges.len()).collect() }
    }

    fn node_of(&self, dart: Dart) -> usize {
        self.edges[dart / 2].1[dart % 2]
    }

    fn line_of(&self, dart: Dart) -> Line {
        let line = self.edges[dart / 2].0.clone();
        if dart.is_multiple_of(2) { line } else { line.reversed() }
    }

    /// A trail shorter than `shortest` (mm) that ends at a node another trail runs through takes over one half of that
    /// trail, if both are then longer than it was. Only nodes where three edges meet are used: nothing can cross there.
    fn lengthen(&self, trails: &mut [Trail], network: &Network, shortest: f64) {
        let length = |darts: &[Dart]| darts.iter().map(|dart| self.edges[dart / 2].0.length()).sum::<f64>();
        let back = |darts: &[Dart]| darts.iter().rev().map(|&dart| other_end(dart)).collect::<Vec<_>>();
        for short in 0..trails.len() {
            let own = trails[short].darts.clone();
            let mut longest = length(&own);
            if trails[short].closed || longest >= shortest {
                continue;
            }
            let mut change: Option<(usize, Vec<Dart>, Vec<Dart>)> = None;
            for own in [own.clone(), back(&own)] {
                let node = own.last().map(|&dart| self.node_of(other_end(dart)));
                let Some(node) = node.filter(|&node| network.stars[node].len() == 3) else { continue };
                for (number, other) in trails.iter().enumerate().filter(|(k, other)| *k != short && !other.closed) {
                    let Some(at) = (1..other.darts.len()).find(|&i| self.node_of(other.darts[i]) == node) else {
                        continue;
                    };
                    let (head, tail) = other.darts.split_at(at);
                    for (taken, left) in [(tail.to_vec(), head.to_vec()), (back(head), tail.to_vec())] {
                        let least = (length(&own) + length(&taken)).min(length(&left));
                        if least > longest {
                            longest = least;
                            change = Some((number, own.iter().copied().chain(taken).collect(), left));
                        }
                    }
                }
            }
            if let Some((number, joined, left)) = change {
                trails[short].darts = joined;
                trails[number].darts = left;
            }
        }
    }

    fn passes(&self, settings: &TieSettings) -> Vec<Path> {
        let network = self.network();
        let mut trails = trails(&network);
        self.lengthen(&mut trails, &network, settings.shortest);
        let mut through = vec![0; self.nodes.len()];
        for trail in &trails {
            let inner = trail.darts.len() - usize::from(!trail.closed);
            trail.darts.iter().rev().take(inner).for_each(|&dart| through[self.node_of(dart)] += 1);
        }
        let degree = |node: usize| network.stars[node].len();
        trails.iter().map(|trail| self.pass(trail, &through, degree, settings.end_gap * self.width)).collect()
    }

    fn pass(&self, trail: &Trail, through: &[usize], degree: impl Fn(usize) -> usize, gap: f64) -> Path {
        let mut lines: Vec<Line> = trail.darts.iter().map(|&dart| self.line_of(dart)).collect();
        let longest = lines.iter().max_by(|a, b| a.length().total_cmp(&b.length()));
        let kind = longest.and_then(|line| line.kind).unwrap_or(PassKind::Wall);
        if let (false, Some(&first), Some(&last)) = (trail.closed, trail.darts.first(), trail.darts.last()) {
            if degree(self.node_of(first)) > 1 {
                let mut line = std::mem::take(&mut lines[0]).reversed();
                line.cut_end(gap.min(MOST * line.length()));
                lines[0] = line.reversed();
            }
            if let Some(line) = lines.last_mut().filter(|_| degree(self.node_of(other_end(last))) > 1) {
                line.cut_end(gap.min(MOST * line.length()));
            }
        }
        for i in usize::from(!trail.closed)..lines.len() {
            let node = self.node_of(trail.darts[i]);
            if through[node] > 1 {
                let before = (i + lines.len() - 1) % lines.len();
                let ways = lines[before].clone().reversed().way(self.width) + lines[i].way(self.width);
                let aside = ASIDE * self.width;
                let at = self.nodes[node] + ways.clamp_length_max(1.0) * aside;
                lines[before].turn_off(at, aside);
                let mut line = std::mem::take(&mut lines[i]).reversed();
                line.turn_off(at, aside);
                lines[i] = line.reversed();
            }
        }
        let (mut points, mut widths): (Vec<DVec2>, Vec<f64>) = (Vec::new(), Vec::new());
        for line in &lines {
            // The next line begins where this one ends.
            points.extend(line.points.split_last().map_or(&[][..], |(_, others)| others));
            widths.extend(&line.widths);
        }
        if !trail.closed {
            points.extend(lines.last().and_then(|line| line.points.last()));
            widths.extend(widths.last().copied());
        }
        Path { kind, closed: trail.closed, points, width: Along::Each(widths), reversible: true }
    }
}

/// Drops the last nodes of a wall that has run past the point where it is to end: going there would be a step back.
fn without_step_back(wall: &mut Vec<Node>, end: DVec2) {
    while let [.., before, last] = wall[..]
        && (last.at - before.at).dot(end - last.at) < 0.0
    {
        wall.pop();
    }
}

/// Where a line meets another.
#[derive(Debug, Clone, Copy)]
struct Meeting {
    line: usize,
    piece: usize,
    share: f64,
    at: DVec2,
    /// Number of points of the path between its first point and the meeting.
    passed: usize,
}

/// Where a path first meets one of the lines; if it meets none, the point nearest to its start, within `reach` (mm).
fn meeting(path: &[DVec2], lines: &[Line], reach: f64) -> Option<Meeting> {
    let start = *path.first()?;
    let mut first: Option<(f64, Meeting)> = None;
    let mut nearest: Option<(f64, Meeting)> = None;
    for (number, line) in lines.iter().enumerate() {
        for (piece, w) in line.points.windows(2).enumerate() {
            let (a, b) = (w[0], w[1]);
            let foot = planar::nearest::foot((a, b), start);
            let distance = foot.distance(start);
            if distance > 2.0 * reach {
                continue;
            }
            let share_of = |at: DVec2| if a == b { 0.0 } else { at.distance(a) / a.distance(b) };
            if distance < reach && nearest.is_none_or(|(least, _)| distance < least) {
                let met = Meeting { line: number, piece, share: share_of(foot), at: foot, passed: 0 };
                nearest = Some((distance, met));
            }
            for (passed, step) in path.windows(2).enumerate() {
                if let Some((share, at)) = crossing(step[0], step[1], a, b) {
                    let along = passed as f64 + share;
                    if first.is_none_or(|(least, _)| along < least) {
                        first = Some((along, Meeting { line: number, piece, share: share_of(at), at, passed }));
                    }
                }
            }
        }
    }
    first.or(nearest).map(|(_, met)| met)
}

/// Where two segments cross: the fraction of the first before the crossing, and the point.
fn crossing(a: DVec2, b: DVec2, c: DVec2, d: DVec2) -> Option<(f64, DVec2)> {
    let (r, s) = (b - a, d - c);
    let area = r.perp_dot(s);
    let (t, u) = ((c - a).perp_dot(s) / area, (c - a).perp_dot(r) / area);
    let within = |share: f64| (0.0..=1.0).contains(&share);
    (within(t) && within(u)).then(|| (t, a.lerp(b, t)))
}
