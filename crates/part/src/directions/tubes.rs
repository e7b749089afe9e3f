//! Straight tubes and bars that branch: each is built along its own axis, and begins on the one that carries it.
//!
//! Cylinders are found by pairs of surface samples, whose normals both meet the axis (as in RANSAC by Schnabel et al.
//! 2007), and made better by all the samples that lie on them. A branch goes on in the layers of the tube that carries it
//! if it leans no more from them than a wall may. Otherwise its layers lie around that tube, so that the first is as wide
//! as all others; or flat on the place where it begins, as far as the part may be tilted. Layers square to the branch come
//! last: the first of them are crescents beside the tube, mostly with no room for a bead, so a wall may rather lean
//! somewhat more.

use super::around::{is_round, middle};
use super::samples::{FINE, Sample, area};
use super::ways::{Judge, lies};
use super::{Division, Piece, State};
use crate::chart::{Bound, Chart, Cylinder, Plane, Side};
use crate::model::Mesh;
use glam::{DMat3, DVec2, DVec3};

/// A sample lies on a cylinder if it is this near to it, as a fraction of the radius, and its normal this near to the
/// radial direction (cosine).
const NEAR: f64 = 0.04;
const RADIAL: f64 = 0.97;
/// Pairs of samples tried for each cylinder.
const PAIRS: usize = 3000;
/// Normals of a pair must differ by at least this sine.
const APART: f64 = 0.3;
/// Most tubes of a part.
const MOST: usize = 64;
/// A tube has at least this fraction of the part's surface.
const LEAST: f64 = 0.004;
/// A tube ends where its samples leave a gap this wide along the axis, in radii.
const GAP: f64 = 1.0;
/// At most this fraction of the surface may lie on no tube and at no end of one.
const ELSE: f64 = 0.03;
/// Tubes are this much thicker than their samples, mm, so that their own surface is cut nowhere.
const THICKER: f64 = 0.05;
/// Level layers must leave this many times as much area overhanging.
const BETTER: f64 = 2.0;
/// Ends of tubes are known to this fraction of the part's size.
const SLACK: f64 = 0.02;
/// A pair of samples lies within this fraction of the size.
const NEIGHBOURS: f64 = 0.3;
/// Samples by which a candidate is judged, at most about.
const COUNTED: usize = 2000;
/// Rounds in which a tube is fitted to its samples, and steps of the power iteration for its axis.
const FITS: usize = 4;
const POWERS: usize = 60;
/// Sine of the least angle between a branch and its carrier.
const FLATTEST: f64 = 0.3;
/// A tube leans at most this much from its layers, °: of 2 mm layers and 7 mm beads, half a bead then lies on the one below.
const MOST_LEAN: f64 = 60.0;
/// Flat layers this much off the surface on which they begin, °, soon have room for a bead: in a bar of 15 mm within 4 mm.
const MOST_SKEW: f64 = 15.0;
/// Directions that are found may lie this much beyond the largest tilt, °.
const BEYOND: f64 = 1.0;
/// Pieces of one part may lie this far over their bounds, mm.
const OVER: f64 = 0.1;

/// The part as straight tubes, each built along its axis, if it is made of several and far less area overhangs than in
/// level layers.
pub(super) fn tubes(whole: &State, judge: &Judge) -> Option<Division> {
    let slack = SLACK * judge.size;
    let mut open = found(&whole.samples, &whole.trunk, judge);
    let is_else = |sample: &&Sample| !open.iter().any(|tube| tube.has(sample.place, slack));
    if open.len() < 2 || area(whole.samples.iter().filter(is_else)) > ELSE * judge.surface {
        return None;
    }
    let mut tree = Tree::default();
    open.extract_if(.., |tube| tube.stands(judge, slack)).for_each(|root| tree.plant(root));
    let mut next = 0;
    while let Some(carrier) = tree.grown.get(next).copied() {
        let carried: Vec<Tube> = open.extract_if(.., |tube| !tube.branches(&carrier.tube, slack).is_empty()).collect();
        for (tube, up) in carried.iter().flat_map(|tube| tube.branches(&carrier.tube, slack)) {
            tree.grow(&carrier, tube, up, judge);
        }
        next += 1;
    }
    let Tree { pieces, tilt, lean, .. } = tree;
    if pieces.is_empty() || !open.is_empty() {
        return None;
    }
    let hangs = |sample: &&Sample| {
        let own = pieces.iter().find(|piece| piece.has(sample.place, OVER));
        let hangs = |own: &Piece| judge.hangs_beyond(lean + BEYOND, sample, stacked(own, sample.place));
        !judge.stands(sample, judge.table()) && own.is_none_or(hangs)
    };
    let hanging = area(whole.samples.iter().filter(hangs));
    let fits = tilt <= judge.settings.tilt + BEYOND && BETTER * hanging < whole.hanging[0];
    fits.then_some(Division { pieces, hanging, tilt, lean: (lean > 0.0).then_some(lean) })
}

/// A straight tube or bar.
#[derive(Debug, Clone, Copy)]
struct Tube {
    /// Unit vector.
    axis: DVec3,
    through: DVec3,
    radius: f64,
    /// Its ends along the axis from `through`, mm.
    ends: [f64; 2],
}

impl Tube {
    fn end(&self, k: usize) -> DVec3 {
        self.through + self.axis * self.ends[k]
    }

    /// Position along the axis, and distance from it, mm.
    fn place(&self, p: DVec3) -> (f64, f64) {
        let from = p - self.through;
        let along = from.dot(self.axis);
        (along, (from - self.axis * along).length())
    }

    /// Whether a point lies on it or in it.
    fn has(&self, p: DVec3, slack: f64) -> bool {
        let (along, away) = self.place(p);
        away < self.radius * (1.0 + NEAR) && self.is_between(along, slack)
    }

    fn is_between(&self, along: f64, slack: f64) -> bool {
        (self.ends[0] - slack..=self.ends[1] + slack).contains(&along)
    }

    /// Whether it stands on the table.
    fn stands(&self, judge: &Judge, slack: f64) -> bool {
        let lean = lies(if self.axis.z < 0.0 { -self.axis } else { self.axis });
        let low = self.end(0).z.min(self.end(1).z) - self.radius * lean.to_radians().sin();
        lean <= judge.settings.lean && low < slack
    }

    /// Its surface, rounded so that the text is short, and made this much thicker, mm.
    fn surface(&self, side: Side, thicker: f64) -> Cylinder {
        let to = |v: DVec3, places: f64| (v * places).round() / places + DVec3::ZERO;
        let radius = ((self.radius + thicker) * 1e3).round() / 1e3;
        Cylinder { through: to(self.through, 1e3), axis: to(self.axis, 1e6), radius, side, seam: 0.0 }
    }

    fn inside(&self) -> Bound {
        Bound::Cylinder(self.surface(Side::Inner, THICKER))
    }

    fn outside(&self) -> Bound {
        Bound::Cylinder(self.surface(Side::Outer, THICKER))
    }

    /// Layers around it, cut open on the other side than this one.
    fn around(&self, side: DVec3) -> Chart {
        let own = self.surface(Side::Outer, 0.0);
        // Seen from a seam at 0, the angle of what lies half a turn away from it is 0.
        let seam = own.angle(self.through + side * self.radius).rem_euclid(360.0).round();
        Chart::Cylinder(Cylinder { seam, ..own })
    }

    /// The tubes that grow out of a carrier, each with its direction: this one if one of its ends lies there, or both its
    /// halves if it crosses the carrier.
    fn branches(&self, carrier: &Self, slack: f64) -> Vec<(Self, DVec3)> {
        let (own, other) = nearest(self, carrier);
        let at = carrier.through + carrier.axis * other;
        let apart = at.distance(self.through + self.axis * own);
        if apart > carrier.radius || !carrier.is_between(other, self.radius + slack) {
            return Vec::new();
        }
        // Along the own axis, this far from the carrier's axis its surface may begin.
        let sine = self.axis.cross(carrier.axis).length().max(FLATTEST);
        let within = (carrier.radius + self.radius) / sine + slack;
        let half = |ends: [f64; 2], up: DVec3| (Self { ends, ..*self }, up);
        match self.ends.map(|end| (end - own).abs() < within) {
            [true, false] => vec![half([own, self.ends[1]], self.axis)],
            [false, true] => vec![half([self.ends[0], own], -self.axis)],
            [true, true] => Vec::new(),
            [false, false] if self.is_between(own, 0.0) => {
                vec![half([own, self.ends[1]], self.axis), half([self.ends[0], own], -self.axis)]
            }
            [false, false] => Vec::new(),
        }
    }

    /// Whether two tubes touch.
    fn touches(&self, other: &Self) -> bool {
        let (own, there) = nearest(self, other);
        let own = self.through + self.axis * own.clamp(self.ends[0], self.ends[1]);
        let there = other.through + other.axis * there.clamp(other.ends[0], other.ends[1]);
        own.distance(there) < self.radius + other.radius
    }
}

/// The positions along both axes where they are nearest to each other, mm.
fn nearest(a: &Tube, b: &Tube) -> (f64, f64) {
    let (between, across) = (b.through - a.through, a.axis.dot(b.axis));
    let scale = 1.0 - across * across;
    if scale < 1e-6 {
        return (between.dot(a.axis), 0.0);
    }
    let (along_a, along_b) = (between.dot(a.axis), between.dot(b.axis));
    ((along_a - across * along_b) / scale, (across * along_a - along_b) / scale)
}

/// A tube in its place.
#[derive(Clone, Copy)]
struct Grown {
    tube: Tube,
    /// The direction in which it grows.
    up: DVec3,
    /// Whether another tube carries it.
    carried: bool,
    /// Index of the piece to which it belongs.
    piece: usize,
}

/// Tubes on each other.
#[derive(Default)]
struct Tree {
    grown: Vec<Grown>,
    pieces: Vec<Piece>,
    /// Largest angle between a direction in which layers are stacked and the vertical, °.
    tilt: f64,
    /// Largest angle between a tube and its layers where that is more than it should be, °; 0 if it is nowhere.
    lean: f64,
}

impl Tree {
    /// A tube that stands on the table, in level layers.
    fn plant(&mut self, tube: Tube) {
        self.grown.push(Grown { tube, up: DVec3::Z, carried: false, piece: self.pieces.len() });
        let within = vec![tube.inside()];
        self.pieces.push(Piece { chart: Chart::default(), within, also: Vec::new(), on_stock: false });
    }

    /// A tube on a carrier, beside what has grown in much the same direction, in the layers that [`Layers::of`] chooses.
    fn grow(&mut self, carrier: &Grown, tube: Tube, up: DVec3, judge: &Judge) {
        let (own, other) = nearest(&tube, &carrier.tube);
        let start = tube.through + tube.axis * own;
        let tip = start + up * (tube.ends[1] - tube.ends[0]);
        // Cylinders are endless: one that grows the other way would take this side, too.
        let beside = |other: &&Grown| other.carried && other.up.dot(up) > 0.0 && other.tube.touches(&tube);
        let outside = self.grown.iter().filter(beside).map(|other| other.tube.outside());
        let mut within: Vec<Bound> = std::iter::once(tube.inside()).chain(outside).collect();
        let away = up.reject_from_normalized(carrier.tube.axis).normalize_or(up);
        let below = &self.pieces[carrier.piece];
        let on = [start, tip].map(|p| degrees(stacked(below, p), up)).into_iter().fold(0.0, f64::max);
        let tilt = judge.settings.tilt;
        let around = Some(degrees(away, up)).filter(|_| lies(away) <= tilt + BEYOND);
        let flat = raised(away, tilt);
        let (layers, lean) = Layers::of(on, around, (degrees(flat, up), degrees(flat, away)), judge.settings.lean);
        if lean > judge.settings.lean {
            self.lean = self.lean.max(lean);
        }
        let plane = |up: DVec3| Chart::Plane(Plane { origin: start, up }.rounded());
        // Cylinders are endless: behind the carrier, this one would go on.
        let half = Plane { origin: carrier.tube.through + carrier.tube.axis * other, up: away };
        let half = Bound::Plane(half.rounded());
        let (side, chart, last) = match layers {
            Layers::Carriers => {
                // A little into the carrier, so that they are one.
                within.extend([Bound::Cylinder(carrier.tube.surface(Side::Outer, -THICKER)), half]);
                self.pieces[carrier.piece].also.push(within);
                self.grown.push(Grown { tube, up, carried: true, piece: carrier.piece });
                return;
            }
            Layers::Around => (away, carrier.tube.around(away), half),
            Layers::Flat => (flat, plane(flat), carrier.tube.outside()),
            Layers::Square => (up, plane(up), carrier.tube.outside()),
        };
        within.push(last);
        self.tilt = self.tilt.max(lies(side));
        let piece = self.pieces.len();
        self.pieces.push(Piece { chart, within, also: Vec::new(), on_stock: false });
        self.grown.push(Grown { tube, up, carried: true, piece });
    }
}

/// The layers of a tube on a carrier.
#[derive(Clone, Copy)]
enum Layers {
    /// Those of the carrier go on.
    Carriers,
    /// Around the carrier: the first is as wide as all others.
    Around,
    /// Flat, nearly along the carrier's surface where the tube begins, as far as the part may be tilted.
    Flat,
    /// Square to the tube.
    Square,
}

impl Layers {
    /// The first of them from which the tube leans no more than a wall should, `lean`, and that soon have room for a bead; if
    /// there are none, those of them from which it leans least, within reason. And how much it leans, °. `flat` is how much it
    /// leans from flat layers, and they from the surface on which they begin.
    fn of(carriers: f64, around: Option<f64>, (flat, skew): (f64, f64), lean: f64) -> (Self, f64) {
        let around = around.map(|around| (Self::Around, around));
        let flat_soon = (skew <= MOST_SKEW).then_some((Self::Flat, flat));
        let mut all = vec![(Self::Carriers, carriers)];
        all.extend(around.into_iter().chain(flat_soon));
        let first = all.iter().copied().find(|(_, leans)| *leans <= lean);
        let least = all.into_iter().min_by(|a, b| a.1.total_cmp(&b.1)).filter(|(_, leans)| *leans <= MOST_LEAN);
        // Flat layers that begin late are still less askew than those square to the tube.
        let late = Some((Self::Flat, flat)).filter(|_| flat <= MOST_LEAN);
        first.or(least).or(late).unwrap_or((Self::Square, 0.0))
    }
}

/// The direction nearest to another that lies at most this far from the vertical, °.
fn raised(way: DVec3, tilt: f64) -> DVec3 {
    let (sin, cos) = tilt.to_radians().sin_cos();
    let level = DVec3::new(way.x, way.y, 0.0).normalize_or(DVec3::X);
    if lies(way) <= tilt { way } else { level * sin + DVec3::Z * cos }
}

fn degrees(a: DVec3, b: DVec3) -> f64 {
    a.angle_between(b).to_degrees()
}

/// The direction in which the layers of a piece are stacked at a point.
fn stacked(piece: &Piece, p: DVec3) -> DVec3 {
    match &piece.chart {
        Chart::Plane(plane) => plane.up,
        Chart::Cylinder(around) => (p - around.through).reject_from_normalized(around.axis).normalize_or(DVec3::Z),
        _ => DVec3::Z,
    }
}

/// Tubes on which the samples lie, those with most surface first.
fn found(samples: &[Sample], mesh: &Mesh, judge: &Judge) -> Vec<Tube> {
    let (mut left, mut tubes) = (samples.to_vec(), Vec::new());
    let mut random = Random(1);
    while tubes.len() < MOST {
        let Some(tube) = largest(&left, judge, &mut random) else { break };
        let Some((mut tube, on_it)) = refined(tube, &left, judge) else { break };
        tube.radius = corners(&tube, mesh).fold(tube.radius, f64::max);
        tubes.push(tube);
        let mut number = 0;
        left.retain(|_| {
            number += 1;
            !on_it[number - 1]
        });
    }
    tubes
}

/// Distances from the axis of the corners of the facets that make up a tube, mm.
fn corners(tube: &Tube, mesh: &Mesh) -> impl Iterator<Item = f64> {
    let facets = mesh.triangles.iter().map(|triangle| triangle.map(|corner| mesh.vertices[corner as usize]));
    let own = facets.filter(|[a, b, c]| {
        let (normal, from) = ((b - a).cross(c - a), (a + b + c) / 3.0 - tube.through);
        let out = from.reject_from_normalized(tube.axis);
        normal.dot(out) > RADIAL * normal.length() * out.length()
    });
    own.flatten().map(|p| tube.place(p).1).filter(|away| (away / tube.radius - 1.0).abs() < NEAR)
}

/// The best of the cylinders through pairs of samples.
fn largest(samples: &[Sample], judge: &Judge, random: &mut Random) -> Option<Tube> {
    let pick = |random: &mut Random| samples.get(random.below(samples.len()));
    let step = 1 + samples.len() / COUNTED;
    let mut best: Option<(f64, Tube)> = None;
    for _ in 0..PAIRS {
        let (a, b) = (pick(random)?, pick(random)?);
        let across = a.normal.cross(b.normal);
        if across.length() < APART || a.place.distance(b.place) > NEIGHBOURS * judge.size {
            continue;
        }
        let axis = across.normalize();
        let Some((through, radius)) = centre(a, b, axis).filter(|(_, radius)| *radius < NEIGHBOURS * judge.size) else {
            continue;
        };
        let tube = Tube { axis, through, radius, ends: [f64::NEG_INFINITY, f64::INFINITY] };
        let counted = samples.iter().step_by(step).filter(|sample| is_on(&tube, sample));
        let counted = area(counted);
        if best.as_ref().is_none_or(|(most, _)| counted > *most) {
            best = Some((counted, tube));
        }
    }
    best.map(|(_, tube)| tube)
}

/// Where the normals of two samples meet, seen along an axis, and their distance from there if it is the same.
fn centre(a: &Sample, b: &Sample, axis: DVec3) -> Option<(DVec3, f64)> {
    let flat = seen_along(axis);
    let ([p, q], [n, m]) = ([a.place, b.place].map(&flat), [a.normal, b.normal].map(&flat));
    let turn = n.perp_dot(m);
    let [first, second] = [(p - q).perp_dot(m) / turn, (p - q).perp_dot(n) / turn];
    let radius = (first + second) / 2.0;
    let fits = turn.abs() > 1e-9 && radius > 0.0 && (first - second).abs() < NEAR * radius;
    let middle = p - n * first;
    fits.then(|| (on_plane(axis, middle), radius))
}

/// Two directions square to an axis.
fn square(axis: DVec3) -> [DVec3; 2] {
    let first = axis.any_orthonormal_vector();
    [first, axis.cross(first)]
}

/// Places as seen along an axis.
fn seen_along(axis: DVec3) -> impl Fn(DVec3) -> DVec2 {
    let [u, v] = square(axis);
    move |p| DVec2::new(u.dot(p), v.dot(p))
}

/// The inverse, on the plane through the origin.
fn on_plane(axis: DVec3, p: DVec2) -> DVec3 {
    let [u, v] = square(axis);
    u * p.x + v * p.y
}

fn is_on(tube: &Tube, sample: &Sample) -> bool {
    let from = (sample.place - tube.through).reject_from_normalized(tube.axis);
    let away = from.length();
    (away / tube.radius - 1.0).abs() < NEAR && sample.normal.dot(from) > RADIAL * away
}

/// A tube fitted to the samples on it, and which they are; `None` if they are too few, or not all around.
fn refined(mut tube: Tube, samples: &[Sample], judge: &Judge) -> Option<(Tube, Vec<bool>)> {
    let gap = 2.0 * FINE * judge.size;
    for _ in 0..FITS {
        let on_it: Vec<&Sample> = run(&tube, samples, gap).into_iter().map(|k| &samples[k]).collect();
        let normals = on_it.iter().fold(DMat3::ZERO, |sum, sample| {
            let n = sample.normal * sample.area;
            sum + DMat3::from_cols(n * sample.normal.x, n * sample.normal.y, n * sample.normal.z)
        });
        // The direction in which normals point least.
        let others =
            DMat3::from_diagonal(DVec3::splat(normals.x_axis.x + normals.y_axis.y + normals.z_axis.z)) - normals;
        let axis = (0..POWERS).fold(tube.axis, |axis, _| (others * axis).normalize_or(axis));
        let flat = seen_along(axis);
        let faces: Vec<(DVec2, DVec2, f64)> = on_it
            .iter()
            .map(|sample| (flat(sample.place), flat(sample.normal).normalize_or_zero(), sample.area))
            .collect();
        let middle = middle(&faces, NEAR * tube.radius)?;
        let weight: f64 = faces.iter().map(|(.., area)| area).sum();
        let radius = faces.iter().map(|(p, _, area)| p.distance(middle) * area).sum::<f64>() / weight;
        tube = Tube { axis, through: on_plane(axis, middle), radius, ends: tube.ends };
    }
    let own = run(&tube, samples, gap);
    let along = own.iter().map(|k| tube.place(samples[*k].place).0);
    tube.ends = along.fold([f64::MAX, f64::MIN], |[low, high], at| [low.min(at), high.max(at)]);
    let flat = seen_along(tube.axis);
    let round = is_round(own.iter().map(|k| flat(samples[*k].place - tube.through)));
    let seen = area(own.iter().map(|k| &samples[*k]));
    let mut on_it = vec![false; samples.len()];
    own.into_iter().for_each(|k| on_it[k] = true);
    (round && seen > LEAST * judge.surface).then_some((tube, on_it))
}

/// The samples on a tube, as far as they lie along it without a gap (mm at least): the stretch with most of them.
fn run(tube: &Tube, samples: &[Sample], gap: f64) -> Vec<usize> {
    let on_it = (0..samples.len()).filter(|k| is_on(tube, &samples[*k]));
    let mut along: Vec<(f64, usize)> = on_it.map(|k| (tube.place(samples[k].place).0, k)).collect();
    along.sort_by(|a, b| a.0.total_cmp(&b.0));
    let runs = along.chunk_by(|a, b| b.0 - a.0 < gap.max(GAP * tube.radius));
    let most = |run: &&[(f64, usize)]| area(run.iter().map(|(_, k)| &samples[*k]));
    let longest = runs.max_by(|a, b| most(a).total_cmp(&most(b)));
    longest.unwrap_or_default().iter().map(|(_, k)| *k).collect()
}

/// A generator of numbers that are the same in every run (Lehmer).
struct Random(u64);

impl Random {
    fn below(&mut self, count: usize) -> usize {
        self.0 = self.0 * 48_271 % 0x7fff_ffff;
        self.0 as usize % count.max(1)
    }
}
