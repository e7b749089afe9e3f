//! Scan lines joined into one path where the boundary leads from the end of one to the same end of the next
//! (Liu et al. 2022, eqs 11–13). Where it does not, another path begins.
//!
//! The link follows the boundary itself, so it neither leaves the region nor crosses another line.

use super::{Fill, FillSettings, Pass, PassKind, Strategy};
use glam::DVec2;
use planar::scan::{Chain, End, Scan};
use planar::{Polygon, Region};

/// Zigzag.
pub struct Zigzag;

impl Strategy for Zigzag {
    fn name(&self) -> &'static str {
        "zigzag"
    }

    fn fill(&self, island: &Polygon, settings: &FillSettings) -> Fill {
        Fill { stages: vec![zigzag(&settings.outermost(island), settings)], fixed_order: false }
    }
}

/// A link along an edge that lies closer than this to a scan line (in stepovers) would lay metal twice.
const MIN_LINK_GAP: f64 = 0.3;

/// Only links longer than this (in stepovers) are tested for it.
const SHORT_LINK: f64 = 2.0;

/// Zigzag paths that fill a region.
pub(super) fn zigzag(region: &Region, settings: &FillSettings) -> Vec<Pass> {
    let scan = Scan::new(region, settings.raster_angle, settings.spacing());
    let mut weaver = Weaver { scan: &scan, used: vec![false; scan.spans().len()], stepover: settings.stepover };
    let passes = (0..scan.spans().len()).filter_map(|span| weaver.path_from(span));
    passes.map(|points| Pass::line(PassKind::Infill, points, settings.bead_width)).collect()
}

struct Weaver<'a> {
    scan: &'a Scan,
    used: Vec<bool>,
    stepover: f64,
}

impl Weaver<'_> {
    /// The path that begins on a span and climbs from line to line; none when the span is laid already.
    fn path_from(&mut self, first: usize) -> Option<Vec<DVec2>> {
        if self.used[first] {
            return None;
        }
        // Leave by the right end unless only the left one leads on.
        let mut exit = if self.link(first, End::Right).is_none() && self.link(first, End::Left).is_some() {
            End::Left
        } else {
            End::Right
        };
        let (mut points, mut span) = (Vec::new(), first);
        loop {
            self.used[span] = true;
            points.extend([self.scan.end(span, exit.other()), self.scan.end(span, exit)]);
            let Some(chain) = self.link(span, exit) else { break };
            points.extend(chain.via);
            span = chain.to;
            exit = exit.other();
        }
        points.dedup_by(|a, b| a.distance_squared(*b) < 1e-8);
        Some(points.into_iter().map(|p| self.scan.turn_back(p)).collect())
    }

    fn link(&self, span: usize, end: End) -> Option<Chain> {
        let chain = self.scan.chain_up(span, end)?;
        let free = !self.used[chain.to] && !self.hugs_a_line(span, end, &chain);
        free.then_some(chain)
    }

    /// Whether a long link runs beside one of the two scan lines that it joins, so that the metal would be laid
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
