//! Rings parallel to the boundary, as a tree: each is attached to a ring one level further out, or across a gap that no
//! ring fills. Rings can be joined into one path along the tree.
//!
//! A *chain* is a sequence of rings, each inside the one before. All its rings are opened at one seam, side by side,
//! and joined there in one of two ways ([`Join`]). A chain on the side of a ring is a *detour*: it begins and ends
//! beside that ring, which is opened there.

use super::line_index::LineIndex;
use super::{Fill, FillSettings, PassKind, Path, contour, sound};
use glam::DVec2;
use planar::nearest::foot;
use planar::{Polygon, Region, Ring};
use std::cmp::{Ordering, Reverse};
use std::collections::{BTreeMap, BinaryHeap};

/// How the rings of the first chain are joined; detours always lead back out.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Join {
    /// From each ring to the next: the path ends in the middle.
    Inwards,
    /// In along every second ring and out along the others (Fermat spiral): the path ends beside its beginning.
    InAndOut,
}

/// Rings are connected up to this distance, in stepovers: one stepover where round joins are not cut short.
const NEIGHBOUR: f64 = 1.3;
/// Rings of one level face each other across a gap narrower than two stepovers.
const ACROSS: f64 = 2.2;
/// Rings are compared at points this far apart, in stepovers.
const SAMPLE: f64 = 0.5;
/// Links along a chain are at most this long, in stepovers; where rings lie farther apart the chain ends.
const LONGEST_LINK: f64 = 1.7;
/// Half the gap that the seam leaves in a ring, in stepovers: for links to the next ring, and to the next but one.
const INWARDS_GAP: f64 = 0.55;
const FERMAT_GAP: f64 = 1.0;
/// Half the gap that a detour leaves in the ring next to it, in stepovers.
const DETOUR_GAP: f64 = 0.5;
/// Links are compared with the rings this far before and after a seam, in stepovers.
const BESIDE: f64 = 3.0;
/// Greatest fraction of a ring taken by a gap.
const LARGEST_GAP: f64 = 0.2;
/// Seams tried for a chain, and whole paths tried for an island until one crosses nothing.
const SEAMS: usize = 24;
const TRIES: usize = 8;
/// If all of them cross, rings are laid closer by this factor, repeatedly, up to this many times.
const CLOSER: f64 = 0.995;
const CLOSER_TIMES: i32 = 6;
/// The golden ratio spreads the seams of successive layers.
const GOLDEN: f64 = 0.618_033_988_749_895;

/// Fills an island with joined rings: one path for each part of it through which a bead can pass.
pub(super) fn joined(island: &Polygon, settings: &FillSettings, join: Join) -> Fill {
    let outermost = settings.outermost(island);
    let part = |part: &Polygon| path_through(part, island, settings, join);
    Fill { stages: vec![outermost.polygons().iter().flat_map(part).collect()], fixed_order: false }
}

/// The paths through one part; the first attempt that is sound.
fn path_through(part: &Polygon, island: &Polygon, settings: &FillSettings, join: Join) -> Vec<Path> {
    let width = settings.bead.width;
    let mut last = Vec::new();
    let tries = (0..=CLOSER_TIMES).flat_map(|closer| (0..TRIES).map(move |attempt| (closer, attempt)));
    for (closer, attempt) in tries {
        let settings = &FillSettings { stepover: settings.stepover * CLOSER.powi(closer), ..*settings };
        let mut tree = RingTree::of(part, settings);
        let turn = (settings.layer as f64 + attempt as f64 / TRIES as f64) * GOLDEN;
        let lines = tree.paths(join, turn);
        last = lines.into_iter().map(|points| Path::line(PassKind::Contour, points, width)).collect::<Vec<_>>();
        let paths: Vec<&Path> = last.iter().collect();
        if sound::fault(&paths, island, settings.machining_allowance).is_none() {
            break;
        }
    }
    last
}

/// A closed line with the distance of its points along it.
struct Loop {
    level: usize,
    points: Vec<DVec2>,
    /// Distance of each point from the first, and the whole length, mm.
    along: Vec<f64>,
    /// Sections used by links: their middle and half their length, mm.
    taken: Vec<(f64, f64)>,
}

impl Loop {
    fn of(level: usize, ring: &Ring) -> Self {
        let mut along = vec![0.0];
        along.extend(ring.edges().scan(0.0, |sum, (a, b)| {
            *sum += a.distance(b);
            Some(*sum)
        }));
        Self { level, points: ring.points().to_vec(), along, taken: Vec::new() }
    }

    fn length(&self) -> f64 {
        self.along.last().copied().unwrap_or_default()
    }

    /// The points, the first one again at the end.
    fn closed(&self) -> Vec<DVec2> {
        self.points.iter().chain(self.points.first()).copied().collect()
    }

    /// The edge that contains a position along the loop, and the point there.
    fn at(&self, along: f64) -> (usize, DVec2) {
        let along = along.rem_euclid(self.length());
        let edge = self.along.partition_point(|&s| s <= along).clamp(1, self.points.len()) - 1;
        let (a, b) = (self.points[edge], self.points[(edge + 1) % self.points.len()]);
        let part = (along - self.along[edge]) / (self.along[edge + 1] - self.along[edge]).max(1e-12);
        (edge, a.lerp(b, part.clamp(0.0, 1.0)))
    }

    fn place(&self, along: f64) -> DVec2 {
        self.at(along).1
    }

    fn way(&self, along: f64) -> DVec2 {
        let edge = self.at(along).0;
        (self.points[(edge + 1) % self.points.len()] - self.points[edge]).normalize_or_zero()
    }

    /// The position along the loop nearest to a point, and its distance from it, mm.
    fn nearest(&self, to: DVec2) -> (f64, f64) {
        let feet = (0..self.points.len()).map(|k| {
            let (a, b) = (self.points[k], self.points[(k + 1) % self.points.len()]);
            let foot = foot((a, b), to);
            (self.along[k] + foot.distance(a), foot.distance(to))
        });
        feet.min_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or_default()
    }

    fn reverse(&mut self) {
        self.points.reverse();
        let length = self.length();
        // The last point is now the first.
        let first = length - self.along[self.points.len() - 1];
        let reversed = self.along.iter().rev().skip(1).map(|s| length - s - first);
        self.along = reversed.chain([length]).collect();
    }

    /// The part of a half gap that this loop can spare.
    fn spared(&self, half: f64) -> f64 {
        half.min(LARGEST_GAP / 2.0 * self.length())
    }

    fn is_free(&self, along: f64, half: f64) -> bool {
        let length = self.length();
        let apart = |middle: f64| {
            let ahead = (along - middle).rem_euclid(length);
            ahead.min(length - ahead)
        };
        self.taken.iter().all(|&(middle, other)| apart(middle) >= half + other)
    }

    /// The points from one position on, for a length.
    fn stretch(&self, from: f64, length: f64) -> Vec<DVec2> {
        let whole = self.length();
        let from = from.rem_euclid(whole);
        let mut points = vec![self.place(from)];
        let turns = [0.0, whole];
        let between = turns.iter().flat_map(|turn| self.along[..self.points.len()].iter().map(move |s| s + turn));
        let inside = between.zip(self.points.iter().cycle()).filter(|(s, _)| *s > from && *s < from + length);
        points.extend(inside.map(|(_, p)| *p));
        points.push(self.place(from + length));
        points
    }
}

/// The rings of a part, and how they are connected.
struct RingTree {
    loops: Vec<Loop>,
    /// For every ring, those attached to it.
    hanging: Vec<Vec<Facing>>,
    roots: Vec<usize>,
    /// Length of a ring with all those attached to it, mm.
    weight: Vec<f64>,
    stepover: f64,
}

/// Another ring, and pairs of points that face each other: on this one and on the other.
type Facing = (usize, Vec<[DVec2; 2]>);

/// For every other ring the points that face each other, with their distance, mm.
type Found = BTreeMap<usize, Vec<(f64, [DVec2; 2])>>;

/// A ring that may be attached: whether it is on the same level as the other ring, when it was found, its index, and
/// the ring it attaches to, with its index among the neighbours of that ring.
type Waiting = (bool, usize, usize, Option<(usize, usize)>);

/// Rings joined at one seam.
struct Chain {
    /// From outside in: each ring with the position of the seam along it, mm.
    rings: Vec<(usize, f64)>,
    /// Whether a link crosses a ring.
    crosses: bool,
    /// Length of the longest link, mm.
    longest: f64,
}

impl Chain {
    /// Compares chains: one that crosses nothing is better, then the longer one, then the one with shorter links.
    fn cmp(&self, other: &Self) -> Ordering {
        let lengths = || other.rings.len().cmp(&self.rings.len());
        self.crosses.cmp(&other.crosses).then_with(lengths).then(self.longest.total_cmp(&other.longest))
    }
}

impl RingTree {
    fn of(part: &Polygon, settings: &FillSettings) -> Self {
        let levels = contour::levels(Region::from(part.clone()), settings, u32::MAX);
        let rings = levels.iter().enumerate().flat_map(|(level, region)| region.rings().map(move |ring| (level, ring)));
        let loops: Vec<Loop> =
            rings.map(|(level, ring)| Loop::of(level, ring)).filter(|l| l.points.len() > 2).collect();
        let count = loops.len();
        let mut tree = Self {
            loops,
            hanging: vec![Vec::new(); count],
            roots: Vec::new(),
            weight: Vec::new(),
            stepover: settings.stepover,
        };
        let order = tree.hang();
        tree.weight = tree.loops.iter().map(Loop::length).collect();
        for ring in order.into_iter().rev() {
            tree.weight[ring] += tree.hanging[ring].iter().map(|(other, _)| tree.weight[*other]).sum::<f64>();
        }
        tree
    }

    /// For every pair of neighbouring rings the points that face each other, the nearest first.
    fn neighbours(&self) -> Vec<Vec<Facing>> {
        let d = self.stepover;
        let mut near = LineIndex::new(ACROSS * d);
        self.loops.iter().enumerate().for_each(|(number, ring)| near.add_line(number, &ring.closed()));
        let mut found = vec![Found::new(); self.loops.len()];
        for (number, ring) in self.loops.iter().enumerate() {
            let samples = (ring.length() / (SAMPLE * d)).ceil().max(8.0) as usize;
            for k in 0..samples {
                let here = ring.place(ring.length() * k as f64 / samples as f64);
                let mut feet = BTreeMap::new();
                for (other, _, a, b) in near.near(here).filter(|piece| piece.0 != number) {
                    let levels = self.loops[other].level.abs_diff(ring.level);
                    let foot = foot((a, b), here);
                    let (distance, reach) = (foot.distance(here), if levels == 0 { ACROSS } else { NEIGHBOUR });
                    let best = feet.get(&other).is_none_or(|&(nearest, _)| distance < nearest);
                    if levels <= 1 && distance <= reach * d && best {
                        feet.insert(other, (distance, [here, foot]));
                    }
                }
                for (other, (distance, [here, there])) in feet {
                    // Nothing lies between the two.
                    if !near.crosses(here.lerp(there, 1e-3), there.lerp(here, 1e-3)) {
                        found[number].entry(other).or_default().push((distance, [here, there]));
                        found[other].entry(number).or_default().push((distance, [there, here]));
                    }
                }
            }
        }
        let sorted = |mut places: Vec<(f64, [DVec2; 2])>| {
            places.sort_by(|a, b| a.0.total_cmp(&b.0));
            places.into_iter().map(|(_, pair)| pair).collect()
        };
        found.into_iter().map(|of| of.into_iter().map(|(other, places)| (other, sorted(places))).collect()).collect()
    }

    /// Attaches every ring to a neighbour that is attached to a root: rings one level apart first. Returns the rings,
    /// each after the one to which it is attached.
    fn hang(&mut self) -> Vec<usize> {
        let neighbours: Vec<Vec<Facing>> = self.neighbours();
        let mut known = vec![false; self.loops.len()];
        let mut order = Vec::new();
        let mut waiting: BinaryHeap<Reverse<Waiting>> = BinaryHeap::new();
        for root in 0..self.loops.len() {
            if known[root] {
                continue;
            }
            known[root] = true;
            self.roots.push(root);
            waiting.push(Reverse((false, 0, root, None)));
            while let Some(Reverse((_, _, ring, on))) = waiting.pop() {
                if let Some((on, which)) = on {
                    if std::mem::replace(&mut known[ring], true) {
                        continue;
                    }
                    let (_, places): &Facing = &neighbours[on][which];
                    self.turn_alike(on, ring, places);
                    self.hanging[on].push((ring, places.clone()));
                }
                order.push(ring);
                for (which, (other, _)) in neighbours[ring].iter().enumerate().filter(|(_, n)| !known[n.0]) {
                    let same = self.loops[*other].level == self.loops[ring].level;
                    waiting.push(Reverse((same, order.len(), *other, Some((ring, which)))));
                }
            }
        }
        order
    }

    /// Makes a ring run the same way as the one to which it is attached.
    fn turn_alike(&mut self, on: usize, ring: usize, places: &[[DVec2; 2]]) {
        let way = |ring: &Loop, place: DVec2| ring.way(ring.nearest(place).0);
        let against = |[a, b]: &[DVec2; 2]| way(&self.loops[on], *a).dot(way(&self.loops[ring], *b)) < 0.0;
        if places.first().is_some_and(against) {
            self.loops[ring].reverse();
        }
    }

    /// One path for every root. `turn` is the offset around the outermost ring at which the search for the first seam
    /// begins.
    fn paths(&mut self, join: Join, turn: f64) -> Vec<Vec<DVec2>> {
        let mut paths = Vec::new();
        // A ring becomes a root where there is no space for a detour.
        let mut next = 0;
        while let Some(&root) = self.roots.get(next) {
            next += 1;
            let length = self.loops[root].length();
            let seams = (0..SEAMS).map(|k| (turn + k as f64 / SEAMS as f64).fract() * length);
            let best = seams.map(|seam| self.chain(root, seam, join)).min_by(Chain::cmp);
            paths.extend(best.map(|chain| self.path(&chain, join, true)));
        }
        paths
    }

    /// The rings from a ring inwards that can be joined at a seam, always the heaviest first.
    fn chain(&self, first: usize, seam: f64, join: Join) -> Chain {
        let mut rings = vec![(first, seam)];
        let (mut ring, mut place, mut longest) = (first, self.loops[first].place(seam), 0.0);
        let heaviest = |ring: usize| {
            self.hanging[ring]
                .iter()
                .map(|(other, _)| *other)
                .max_by(|a, b| self.weight[*a].total_cmp(&self.weight[*b]))
        };
        while let Some(next) = heaviest(ring) {
            let (along, distance) = self.loops[next].nearest(place);
            if distance > LONGEST_LINK * self.stepover {
                break;
            }
            rings.push((next, along));
            longest = f64::max(longest, distance);
            (ring, place) = (next, self.loops[next].place(along));
        }
        let crosses = self.crosses(&rings, join);
        Chain { rings, crosses, longest }
    }

    /// Half the gap that a seam leaves in a ring, mm.
    fn half_gap(&self, ring: usize, join: Join) -> f64 {
        let gap = if join == Join::Inwards { INWARDS_GAP } else { FERMAT_GAP };
        self.loops[ring].spared(gap * self.stepover)
    }

    /// Whether the links at a seam cross each other or the rings next to it.
    fn crosses(&self, rings: &[(usize, f64)], join: Join) -> bool {
        let beside = |&(ring, seam): &(usize, f64)| {
            let (own, half) = (&self.loops[ring], self.half_gap(ring, join));
            let reach = (BESIDE * self.stepover).min(own.length() / 4.0);
            [own.stretch(seam + half, reach), own.stretch(seam - half - reach, reach)]
        };
        let beside: Vec<[Vec<DVec2>; 2]> = rings.iter().map(beside).collect();
        let step = if join == Join::Inwards { 1 } else { 2 };
        let link = |(k, [_, before]): (usize, &[Vec<DVec2>; 2])| {
            let [behind, _] = beside.get(k + step)?;
            Some(vec![*before.last()?, *behind.first()?])
        };
        let links = beside.iter().enumerate().filter_map(link);
        let lines: Vec<Vec<DVec2>> = links.chain(beside.iter().flatten().cloned()).collect();
        sound::crossings(&lines).next().is_some()
    }

    /// A chain as a path with all its detours.
    fn path(&mut self, chain: &Chain, join: Join, first: bool) -> Vec<DVec2> {
        let (d, rings) = (self.stepover, &chain.rings);
        let halves: Vec<f64> = rings.iter().map(|(ring, _)| self.half_gap(*ring, join)).collect();
        for (&(ring, seam), &half) in rings.iter().zip(&halves) {
            self.loops[ring].taken.push((seam, half));
        }
        let mut lines = Vec::new();
        for (k, (&(ring, seam), &half)) in rings.iter().zip(&halves).enumerate() {
            let next = rings.get(k + 1).map(|next| next.0);
            lines.push(self.opened(ring, seam, half, next));
        }
        if first {
            // The ends of the path close the gap in their rings, except for half a stepover on each side of a link.
            let beside = DETOUR_GAP * d;
            let longer = [2.0 * halves[0] - beside, halves.get(1).map_or(0.0, |half| half - beside)];
            let ends = if join == Join::Inwards { 1 } else { 2 };
            for (k, line) in lines.iter_mut().enumerate().take(ends).filter(|(k, _)| longer[*k] > 0.0) {
                let (ring, seam) = rings[k];
                line.splice(0..1, self.loops[ring].stretch(seam + halves[k] - longer[k], longer[k]));
            }
        }
        match join {
            Join::Inwards => lines.concat(),
            Join::InAndOut => in_and_out(lines),
        }
    }

    /// A ring from after its seam to before it, with a detour through everything attached to it except the next ring of
    /// its chain.
    fn opened(&mut self, ring: usize, seam: f64, half: f64, next: Option<usize>) -> Vec<DVec2> {
        let cut = self.loops[ring].spared(DETOUR_GAP * self.stepover);
        let mut detours = Vec::new();
        for (other, places) in self.hanging[ring].clone().into_iter().filter(|(other, _)| Some(*other) != next) {
            let Some((along, there)) = self.beginning(ring, other, &places, cut) else {
                self.roots.push(other);
                continue;
            };
            self.loops[ring].taken.push((along, cut));
            let chain = self.chain(other, self.loops[other].nearest(there).0, Join::InAndOut);
            detours.push((along, self.path(&chain, Join::InAndOut, false)));
        }
        let own = &self.loops[ring];
        let length = own.length();
        // Distance past the seam.
        let ahead = |along: f64| (along - seam).rem_euclid(length);
        detours.sort_by(|a, b| ahead(a.0).total_cmp(&ahead(b.0)));
        let (mut line, mut from) = (Vec::new(), half);
        for (along, detour) in detours {
            line.extend(own.stretch(seam + from, (ahead(along) - cut - from).max(0.0)));
            line.extend(detour);
            from = ahead(along) + cut;
        }
        line.extend(own.stretch(seam + from, (length - half - from).max(0.0)));
        line
    }

    /// Where a ring is left for another attached to it, and where that one is entered; `None` if no place is free.
    fn beginning(&self, ring: usize, other: usize, places: &[[DVec2; 2]], cut: f64) -> Option<(f64, DVec2)> {
        let nearest = places.first().map(|[a, b]| a.distance(*b))?;
        let near = places.iter().take_while(|[a, b]| a.distance(*b) <= nearest + 0.2 * self.stepover).count();
        let some = places[..near].iter().step_by(near.div_ceil(SEAMS));
        let free = some.filter_map(|[here, there]| {
            let along = self.loops[ring].nearest(*here).0;
            let chain = || self.chain(other, self.loops[other].nearest(*there).0, Join::InAndOut);
            self.loops[ring].is_free(along, 1.2 * cut).then(|| (along, *there, chain()))
        });
        free.min_by(|(.., a), (.., b)| a.cmp(b)).map(|(along, there, _)| (along, there))
    }
}

/// Opened rings from outside in, joined into a path that goes in along the even ones (counted from 1) and out along the
/// odd ones. It begins next to the seam of the first ring and ends there.
fn in_and_out(lines: Vec<Vec<DVec2>>) -> Vec<DVec2> {
    let (mut inwards, mut outwards) = (Vec::new(), Vec::new());
    for (k, line) in lines.into_iter().enumerate() {
        if k % 2 == 1 { inwards.extend(line) } else { outwards.extend(line) }
    }
    inwards.extend(outwards.into_iter().rev());
    inwards
}
