//! Maximal discs: one found between two samples touches both sides, one at a junction touches three.

use super::boundary::{Boundary, Foot};
use super::mesh::Sample;
use glam::DVec2;

/// Nodes are equidistant from what they touch to within this, mm.
const TOLERANCE_MM: f64 = 1e-9;

/// After this many steps to a nearer edge, the search for a disc settles for what it has.
const MOST_STEPS: usize = 60;

/// A circle through three samples may reach beyond the boundary by this, mm, and still be accepted as the disc.
const NEAR_MM: f64 = 0.01;

/// A maximal disc and how it touches the boundary.
#[derive(Clone, Copy)]
pub(super) struct Disc {
    pub at: DVec2,
    pub radius: f64,
    /// Object angle, rad: between the points it touches, seen from its centre; the largest such angle if there are
    /// three.
    pub angle: f64,
}

/// The path between two samples along which a disc is sought: via a peak near the axis, or straight if there is none.
#[derive(Clone, Copy)]
pub(super) struct Tent {
    pub ends: [Sample; 2],
    pub peak: Option<DVec2>,
}

impl Tent {
    fn at(&self, t: f64) -> DVec2 {
        let [a, b] = self.ends.map(|s| s.at);
        match self.peak {
            Some(peak) if t < 0.5 => a.lerp(peak, 2.0 * t),
            Some(peak) => peak.lerp(b, 2.0 * t - 1.0),
            None => a.lerp(b, t),
        }
    }
}

/// The disc found on a tent, and the points it touches on the side of either end.
#[derive(Clone, Copy)]
pub(super) struct TentDisc {
    pub disc: Disc,
    pub feet: [Foot; 2],
}

/// A position along a tent, 0 to 1, and the edge nearest to it.
#[derive(Clone, Copy)]
struct Bracket {
    t: f64,
    edge: usize,
}

/// The disc where, along the path between two samples, the nearest edge changes sides. Brackets it like a root finder,
/// but each step goes to the point equidistant from the two nearest edges known so far, so one or two steps suffice.
pub(super) fn on_tent(boundary: &Boundary, tent: &Tent) -> TentDisc {
    let mut low = Bracket { t: 0.0, edge: edge_at(boundary, tent.ends[0], tent.at(1e-6)) };
    let mut high = Bracket { t: 1.0, edge: edge_at(boundary, tent.ends[1], tent.at(1.0 - 1e-6)) };
    let mut steps = 0;
    loop {
        let t = balance(boundary, tent, low, high);
        let at = tent.at(t);
        let feet = [low, high].map(|b| boundary.foot_on(b.edge, at));
        let mut radius = feet[0].distance.min(feet[1].distance);
        let nearer = boundary.nearest(at, radius - TOLERANCE_MM);
        if let Some(nearer) = nearer
            && steps < MOST_STEPS
        {
            let to_low = boundary.along(&nearer, &feet[0]) <= boundary.along(&nearer, &feet[1]);
            *(if to_low { &mut low } else { &mut high }) = Bracket { t, edge: nearer.edge };
            steps += 1;
            continue;
        }
        radius = nearer.map_or(radius, |foot| foot.distance);
        // In the middle of an arc any of its edges may come out as nearest, so the angle between the samples counts
        // too.
        let [a, b] = tent.ends.map(|s| s.at);
        let angle = angle_between(at, feet[0].at, feet[1].at).min(angle_between(at, a, b));
        return TentDisc { disc: Disc { at, radius, angle }, feet };
    }
}

/// Of the edges that meet at a sample, the one nearer to the point `close_by`.
fn edge_at(boundary: &Boundary, sample: Sample, close_by: DVec2) -> usize {
    let edge = boundary.edges[sample.edge];
    let distance = |e: usize| boundary.foot_on(e, close_by).distance;
    let is_vertex = sample.at == edge.a;
    if is_vertex && distance(edge.previous) < distance(sample.edge) { edge.previous } else { sample.edge }
}

/// Where the edges of both brackets are equidistant (Illinois method). At each bracket its own edge is nearer.
fn balance(boundary: &Boundary, tent: &Tent, low: Bracket, high: Bracket) -> f64 {
    let lead = |t: f64| {
        let at = tent.at(t);
        boundary.foot_on(low.edge, at).distance - boundary.foot_on(high.edge, at).distance
    };
    let (mut a, mut b) = ((low.t, lead(low.t)), (high.t, lead(high.t)));
    for _ in 0..60 {
        let t = b.0 - b.1 * (b.0 - a.0) / (b.1 - a.1);
        let t = if t.is_finite() && t > a.0.min(b.0) && t < a.0.max(b.0) { t } else { (a.0 + b.0) / 2.0 };
        let now = (t, lead(t));
        if now.1.abs() < 0.1 * TOLERANCE_MM || (b.0 - a.0).abs() < 1e-15 {
            return t;
        }
        if now.1.signum() == b.1.signum() {
            a.1 /= 2.0
        } else {
            a = b
        }
        b = now;
    }
    b.0
}

/// The disc that touches three edges and comes nearer to no other, from a first guess; `None` when there is none
/// nearby.
pub(super) fn at_junction(boundary: &Boundary, guess: DVec2, edges: [usize; 3]) -> Option<Disc> {
    let (mut at, mut edges) = (guess, edges);
    for _ in 0..12 {
        at = equidistant(boundary, at, edges)?;
        let feet = edges.map(|e| boundary.foot_on(e, at));
        let radius = feet[0].distance;
        let Some(nearer) = boundary.nearest(at, radius - 2.0 * TOLERANCE_MM) else {
            let inside = feet.iter().all(|f| boundary.inside(f, at));
            return inside.then(|| Disc { at, radius, angle: widest_angle(at, feet.map(|f| f.at)) });
        };
        let gap = |k: &usize| boundary.along(&feet[*k], &nearer);
        let closest = (0..3).min_by(|i, j| gap(i).total_cmp(&gap(j)))?;
        edges[closest] = nearer.edge;
    }
    None
}

/// The circle through three samples, reduced until it only touches the boundary, where that takes less than
/// [`NEAR_MM`]: on an arc it touches too many edges to choose from.
pub(super) fn through_samples(boundary: &Boundary, centre: DVec2, samples: [DVec2; 3]) -> Option<Disc> {
    let reach = centre.distance(samples[0]);
    let foot = boundary.nearest(centre, f64::INFINITY)?;
    let fits = reach - foot.distance < NEAR_MM && boundary.inside(&foot, centre);
    fits.then(|| Disc { at: centre, radius: foot.distance, angle: widest_angle(centre, samples) })
}

/// Newton's method on the three distances.
fn equidistant(boundary: &Boundary, guess: DVec2, edges: [usize; 3]) -> Option<DVec2> {
    let mut at = guess;
    for _ in 0..40 {
        let feet = edges.map(|e| boundary.foot_on(e, at));
        let [d, e, f] = feet.map(|f| f.distance);
        if (e - d).abs() < TOLERANCE_MM && (f - d).abs() < TOLERANCE_MM {
            return Some(at);
        }
        let [u, v, w] = feet.map(|f| (at - f.at) / f.distance);
        let (p, q) = (u - v, u - w);
        let step = DVec2::new((e - d) * q.y - (f - d) * p.y, (f - d) * p.x - (e - d) * q.x) / p.perp_dot(q);
        if !step.is_finite() {
            return None;
        }
        at += step.clamp_length_max(d + e + f);
    }
    None
}

fn angle_between(at: DVec2, p: DVec2, q: DVec2) -> f64 {
    let (u, v) = (p - at, q - at);
    u.perp_dot(v).atan2(u.dot(v)).abs()
}

pub(super) fn widest_angle(at: DVec2, [p, q, r]: [DVec2; 3]) -> f64 {
    angle_between(at, p, q).max(angle_between(at, q, r)).max(angle_between(at, r, p))
}
