//! Blades on a hub and flanges on a shaft: layers around an axis, on a hub that is turned from bar stock.

use super::samples::{Sample, area};
use super::ways::{Judge, lies};
use super::{Division, Piece, State};
use crate::chart::{Chart, Cylinder, Side};
use glam::{DMat2, DVec2, DVec3};

/// A face is parallel to the axis if the cosine of the angle between its normal and the axis is smaller than this.
const PARALLEL: f64 = 0.1;
/// Iterations in which the axis is found. In each, faces whose normals miss the axis by more than this fraction of the
/// size have little weight.
const STEPS: usize = 8;
const PAST: f64 = 0.02;
/// Faces are at one radius if their radii differ by less than this fraction of the size.
const SAME_RADIUS: f64 = 0.01;
/// Nor by more than this fraction of the radius; and their normals miss the axis by no more than that, as those of a cylinder of
/// 20 facets do.
const ROUGH: f64 = 0.16;
/// The hub must be visible on at least this fraction of the part's surface, and in this fraction of the sectors around
/// the axis.
const SEEN: f64 = 0.05;
const ROUND: f64 = 0.6;
/// At most this fraction of the area beyond the hub may lie past its ends.
const ASIDE: f64 = 0.02;
const SECTORS: usize = 24;
/// Level layers must leave this many times as much area overhanging.
const BETTER: f64 = 2.0;

/// The part as layers around its hub, if it has one and far less area overhangs than in level layers.
pub(super) fn around(whole: &State, judge: &Judge) -> Option<Division> {
    if judge.settings.tilt < 90.0 {
        return None;
    }
    let hubs = [DVec3::X, DVec3::Y, DVec3::Z].into_iter().chain(judge.faces.iter().copied());
    let hubs = hubs.filter_map(|axis| Hub::about(axis, &whole.samples, judge));
    let hub = hubs.max_by(|a, b| a.seen.total_cmp(&b.seen))?;
    let hanging = hub.hanging(&whole.samples, judge);
    let chart = Chart::Cylinder(Cylinder {
        axis: (hub.axis * 1e6).round() / 1e6 + DVec3::ZERO,
        through: (hub.through * 1e3).round() / 1e3 + DVec3::ZERO,
        radius: (hub.radius * 1e2).ceil() / 1e2,
        side: Side::Outer,
        seam: SEAM,
    });
    let piece = Piece { chart, within: Vec::new(), also: Vec::new(), on_stock: true };
    // All around a horizontal axis, layers also hang overhead.
    let lies = lies(hub.axis);
    let tilt = 90.0 + lies.min(180.0 - lies);
    (BETTER * hanging < whole.hanging[0]).then(|| Division { pieces: vec![piece], hanging, tilt, lean: None })
}

/// Where layers are cut open, °.
const SEAM: f64 = 180.0;

/// A cylinder whose surface shows between what stands on it.
struct Hub {
    axis: DVec3,
    through: DVec3,
    radius: f64,
    /// Its visible area, mm².
    seen: f64,
    /// Its ends along the axis, mm.
    ends: [f64; 2],
}

impl Hub {
    fn about(axis: DVec3, samples: &[Sample], judge: &Judge) -> Option<Self> {
        let (u, v) = axis.any_orthonormal_pair();
        let flat = |p: DVec3| DVec2::new(u.dot(p), v.dot(p));
        // Position, normal and area of the samples parallel to the axis.
        let faces: Vec<(DVec2, DVec2, f64)> = samples
            .iter()
            .filter(|sample| sample.normal.dot(axis).abs() < PARALLEL)
            .map(|sample| (flat(sample.place), flat(sample.normal).normalize_or_zero(), sample.area))
            .collect();
        let middle = middle(&faces, PAST * judge.size)?;
        let alike = |radius: f64| (SAME_RADIUS * judge.size).min(ROUGH * radius);
        let out = |(p, normal, _): &&(DVec2, DVec2, f64)| {
            let from = *p - middle;
            from.dot(*normal) > 0.0 && from.perp_dot(*normal).abs() < alike(from.length())
        };
        let mut areas = std::collections::BTreeMap::new();
        for (p, _, area) in faces.iter().filter(out) {
            *areas.entry((p.distance(middle) / (SAME_RADIUS * judge.size)).round() as i64).or_insert(0.0) += area;
        }
        let (at, _) = areas.iter().max_by(|a: &(&i64, &f64), b| a.1.total_cmp(b.1))?;
        let near = *at as f64 * SAME_RADIUS * judge.size;
        let own: Vec<&(DVec2, DVec2, f64)> =
            faces.iter().filter(out).filter(|(p, ..)| (p.distance(middle) - near).abs() < alike(near)).collect();
        let seen: f64 = own.iter().map(|(.., area)| area).sum();
        let radius = own.iter().map(|(p, _, area)| p.distance(middle) * area).sum::<f64>() / seen;
        let through = u * middle.x + v * middle.y;
        let at_radius =
            |sample: &&Sample| (flat(sample.place).distance(middle) - radius).abs() < SAME_RADIUS * judge.size;
        let along = samples.iter().filter(at_radius).map(|sample| axis.dot(sample.place));
        let ends = along.fold([f64::MAX, f64::MIN], |[low, high], at| [low.min(at), high.max(at)]);
        let hub = Self { axis, through, radius, seen, ends };
        (seen > SEEN * judge.surface && is_round(own.iter().map(|(p, ..)| *p - middle)) && hub.carries(samples, judge))
            .then_some(hub)
    }

    /// Vector from the axis to a sample of the surface.
    fn away(&self, sample: &Sample) -> DVec3 {
        (sample.place - self.through).reject_from_normalized(self.axis)
    }

    fn is_beyond(&self, sample: &Sample, judge: &Judge) -> bool {
        self.away(sample).length() > self.radius + SAME_RADIUS * judge.size
    }

    /// Whether (almost) everything beyond its radius lies between its ends.
    fn carries(&self, samples: &[Sample], judge: &Judge) -> bool {
        let slack = 2.0 * SAME_RADIUS * judge.size;
        let aside = |sample: &&Sample| {
            let at = self.axis.dot(sample.place);
            at < self.ends[0] - slack || at > self.ends[1] + slack
        };
        let beyond = || samples.iter().filter(|sample| self.is_beyond(sample, judge));
        let (all, aside) = (area(beyond()), area(beyond().filter(aside)));
        all > SEEN * judge.surface && aside < ASIDE * all
    }

    /// Area beyond the hub that overhangs if layers lie around it, mm².
    fn hanging(&self, samples: &[Sample], judge: &Judge) -> f64 {
        let hangs = |sample: &&Sample| {
            self.is_beyond(sample, judge) && judge.hangs(sample, self.away(sample).normalize_or_zero())
        };
        area(samples.iter().filter(hangs))
    }
}

/// Whether vectors from an axis point to most of the sectors around it.
pub(super) fn is_round(from_axis: impl Iterator<Item = DVec2>) -> bool {
    let mut sectors = [false; SECTORS];
    for from in from_axis {
        let turn = from.to_angle() / std::f64::consts::TAU + 0.5;
        sectors[((turn * SECTORS as f64) as usize).min(SECTORS - 1)] = true;
    }
    sectors.iter().filter(|seen| **seen).count() as f64 >= ROUND * SECTORS as f64
}

/// The point nearest to all normals, as lines (weighted least squares), mm.
pub(super) fn middle(faces: &[(DVec2, DVec2, f64)], past: f64) -> Option<DVec2> {
    let mut middle: Option<DVec2> = None;
    for _ in 0..STEPS {
        let (mut matrix, mut sum) = (DMat2::ZERO, DVec2::ZERO);
        for (p, normal, area) in faces {
            let across = normal.perp();
            let off = middle.map_or(0.0, |middle| (middle - *p).dot(across) / past);
            let weight = area / (1.0 + off * off).powi(2);
            matrix += DMat2::from_cols(across * across.x, across * across.y) * weight;
            sum += across * across.dot(*p) * weight;
        }
        let next = matrix.inverse() * sum;
        middle = Some(next).filter(|next| next.is_finite());
        middle?;
    }
    middle
}
