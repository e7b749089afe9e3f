//! Sub-regions of scan lines, and how they are merged into paths (Han et al. 2018, 3.2).
//!
//! A sub-region is a run of lines, each joined to the next on both sides. It has four key points, the ends of its first
//! and its last line, and is laid from one of them to another: an odd number of lines ends on the other side, an even
//! number on the same side (four-point rule). So each sub-region can be laid in two ways, from its lower left or from
//! its lower right point; where the exit of one sub-region is the entry of the next, the two merge. The ways are chosen
//! so that as many as possible merge.

use super::hooks::{Hooks, Place};
use glam::DVec2;
use planar::scan::{Chain, End, Scan};

/// A link along an edge that lies closer than this to a scan line (in stepovers) would lay metal twice.
const MIN_LINK_GAP: f64 = 0.3;

/// Only links longer than this (in stepovers) are tested for that.
const SHORT_LINK: f64 = 2.0;

/// Scan lines as sub-regions.
pub struct Weave<'a> {
    pub(super) scan: &'a Scan,
    stepover: f64,
    regions: Vec<SubRegion>,
    joints: Vec<Joint>,
}

/// Consecutive lines, each joined to the next on both sides.
#[derive(Debug, Clone, PartialEq)]
pub struct SubRegion {
    /// Spans of the scan, from the lowest to the highest line.
    pub spans: Vec<usize>,
}

impl SubRegion {
    /// The side of the last line on which a sub-region ends if it is entered on side `entry` of the first line.
    fn exit(&self, entry: End) -> End {
        if self.spans.len() % 2 == 1 { entry.other() } else { entry }
    }
}

/// A key point of the last line of `lower` that meets a key point of the first line of `upper`.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Joint {
    lower: usize,
    upper: usize,
    side: End,
}

/// Sub-regions in the order in which they are laid, and the end of the first line by which each is entered.
pub type Way = Vec<(usize, End)>;

impl<'a> Weave<'a> {
    /// Finds the sub-regions and where they meet. `stepover` is the distance between the lines, mm.
    pub fn new(scan: &'a Scan, stepover: f64) -> Self {
        let mut weave = Self { scan, stepover, regions: Vec::new(), joints: Vec::new() };
        let count = scan.spans().len();
        let next = |span: usize| {
            let (left, right) = (weave.link(span, End::Left)?.to, weave.link(span, End::Right)?.to);
            (left == right).then_some(left)
        };
        let next: Vec<Option<usize>> = (0..count).map(next).collect();
        let mut starts = vec![true; count];
        next.iter().flatten().for_each(|&span| starts[span] = false);
        let run = |first: usize| std::iter::successors(Some(first), |&span| next[span]).collect();
        let regions: Vec<SubRegion> =
            (0..count).filter(|&span| starts[span]).map(|first| SubRegion { spans: run(first) }).collect();
        weave.regions = regions;
        weave.find_joints();
        weave
    }

    fn find_joints(&mut self) {
        let first_of = |span: usize| self.regions.iter().position(|r| r.spans.first() == Some(&span));
        let mut joints = Vec::new();
        for (lower, region) in self.regions.iter().enumerate() {
            let Some(&last) = region.spans.last() else { continue };
            for side in [End::Right, End::Left] {
                let upper = self.link(last, side).and_then(|chain| first_of(chain.to));
                joints.extend(upper.map(|upper| Joint { lower, upper, side }));
            }
        }
        self.joints = joints;
    }

    /// The sub-regions.
    pub fn regions(&self) -> &[SubRegion] {
        &self.regions
    }

    /// Every sub-region on its own, in scan order, entered on the left.
    pub fn apart(&self) -> Vec<Way> {
        (0..self.regions.len()).map(|region| vec![(region, End::Left)]).collect()
    }

    /// Sub-regions merged by the four-point rule into as few ways as the search finds.
    pub fn merged(&self) -> Vec<Way> {
        let entries = self.choose_entries();
        let mut next = vec![None; self.regions.len()];
        let mut follows = vec![false; self.regions.len()];
        for joint in self.joints.iter().filter(|j| self.merges(j, &entries)) {
            next[joint.lower] = Some(joint.upper);
            follows[joint.upper] = true;
        }
        let way = |first: usize| {
            let regions = std::iter::successors(Some(first), |&region| next[region]);
            regions.map(|region| (region, entries[region])).collect()
        };
        (0..self.regions.len()).filter(|&region| !follows[region]).map(way).collect()
    }

    /// Whether the exit of one sub-region is the entry of the next.
    fn merges(&self, joint: &Joint, entries: &[End]) -> bool {
        self.regions[joint.lower].exit(entries[joint.lower]) == joint.side && entries[joint.upper] == joint.side
    }

    /// The entry side of each sub-region, chosen so that as many as possible merge: single sub-regions, from the lowest
    /// up, and then both sides of each joint are switched as long as more merge.
    fn choose_entries(&self) -> Vec<End> {
        let mut entries = vec![End::Left; self.regions.len()];
        let mut of: Vec<Vec<usize>> = vec![Vec::new(); self.regions.len()];
        for (j, joint) in self.joints.iter().enumerate() {
            of[joint.lower].push(j);
            of[joint.upper].push(j);
        }
        let merging = |regions: &[usize], entries: &[End]| {
            let mut around: Vec<usize> = regions.iter().flat_map(|&r| of[r].iter().copied()).collect();
            around.sort_unstable();
            around.dedup();
            around.into_iter().filter(|&j| self.merges(&self.joints[j], entries)).count()
        };
        let singles = (0..self.regions.len()).map(|r| vec![r]);
        let moves: Vec<Vec<usize>> = singles.chain(self.joints.iter().map(|j| vec![j.lower, j.upper])).collect();
        loop {
            let mut changed = false;
            for regions in &moves {
                let before = merging(regions, &entries);
                regions.iter().for_each(|&r| entries[r] = entries[r].other());
                if merging(regions, &entries) > before {
                    changed = true;
                } else {
                    regions.iter().for_each(|&r| entries[r] = entries[r].other());
                }
            }
            if !changed {
                return entries;
            }
        }
    }

    /// The points of each way, mm.
    pub fn paths(&self, ways: &[Way]) -> Vec<Vec<DVec2>> {
        ways.iter().map(|way| self.path(way, None)).collect()
    }

    /// The same, with line ends that hook along the boundary on the side that is not linked; `width` is that of a bead,
    /// mm.
    pub fn hooked(&self, ways: &[Way], width: f64) -> Vec<Vec<DVec2>> {
        let hooks = Hooks::new(self, width);
        ways.iter().map(|way| self.path(way, Some(&hooks))).collect()
    }

    fn path(&self, way: &Way, hooks: Option<&Hooks>) -> Vec<DVec2> {
        let hook = |place, span, end| hooks.map_or_else(Vec::new, |hooks| hooks.lay(place, span, end));
        let mut points = Vec::new();
        for (i, &(region, entry)) in way.iter().enumerate() {
            let (spans, mut from) = (&self.regions[region].spans, entry);
            for (k, &span) in spans.iter().enumerate() {
                let to = from.other();
                if points.is_empty() {
                    points.extend(hook(Place::Begin, span, from));
                }
                points.push(self.scan.end(span, from));
                points.extend(hook(Place::Above, span, from));
                points.extend(hook(Place::Below, span, to));
                points.push(self.scan.end(span, to));
                let more = k + 1 < spans.len() || i + 1 < way.len();
                points.extend(more.then(|| self.scan.chain_up(span, to)).flatten().into_iter().flat_map(|c| c.via));
                if !more {
                    points.extend(hook(Place::Finish, span, to));
                }
                from = to;
            }
        }
        points.dedup_by(|a, b| a.distance_squared(*b) < 1e-8);
        let points = if let Some(hooks) = hooks { hooks.blunt(points) } else { points };
        points.into_iter().map(|p| self.scan.turn_back(p)).collect()
    }

    /// The link up from an end of a span, unless it would lie along a line.
    pub(super) fn link(&self, span: usize, end: End) -> Option<Chain> {
        self.scan.chain_up(span, end).filter(|chain| !self.hugs_a_line(span, end, chain))
    }

    /// Whether a long link runs along one of the two scan lines that it joins, so that the metal would be laid
    /// twice there: its mean distance from the lines it passes is too small.
    fn hugs_a_line(&self, span: usize, end: End, chain: &Chain) -> bool {
        let (from, to) = (self.scan.end(span, end), self.scan.end(chain.to, end));
        if (to.x - from.x).abs() < SHORT_LINK * self.stepover {
            return false;
        }
        let covers = |s: usize, x: f64| (self.scan.end(s, End::Left).x..=self.scan.end(s, End::Right).x).contains(&x);
        let mut previous = from;
        let (mut run, mut area) = (0.0, 0.0);
        for &p in chain.via.iter().chain([&to]) {
            let (middle, width) = ((previous + p) / 2.0, (p.x - previous.x).abs());
            let below = if covers(span, middle.x) { middle.y - from.y } else { f64::INFINITY };
            let above = if covers(chain.to, middle.x) { to.y - middle.y } else { f64::INFINITY };
            let gap = below.min(above);
            if gap.is_finite() {
                run += width;
                area += width * gap;
            }
            previous = p;
        }
        run > SHORT_LINK * self.stepover && area < MIN_LINK_GAP * self.stepover * run
    }
}
