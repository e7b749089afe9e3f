//! Layers square to a curve: elbows, bent tubes and bars.
//!
//! The curve is given as a pipe is dimensioned: by points, and a radius for the bend at each corner. So it consists of
//! straight lines and arcs, and everything about it has a closed form. h is the length along it; (u, v) lie in the
//! plane square to it, which is carried along without twist. In a bend a layer is a wedge: 1 mm of h is
//! `1 - bend · (u, v)` mm thick ([`Guide::rise`]).

use super::At;
use glam::{DQuat, DVec2, DVec3};

/// A curve of straight lines and arcs; layers are square to it.
#[derive(Debug, Clone, PartialEq)]
pub struct Guide {
    points: Vec<DVec3>,
    radii: Vec<f64>,
    spans: Vec<Span>,
}

/// A plane square to a guide.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Frame {
    origin: DVec3,
    /// Unit vectors along u and v.
    along: [DVec3; 2],
    /// Unit vector along the guide.
    forth: DVec3,
}

/// A straight line or an arc of a guide.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Span {
    start: Frame,
    /// Where it begins and ends along the guide, mm.
    from: f64,
    to: f64,
    /// The point halfway along.
    middle: DVec3,
    /// Vector towards the centre of the arc in (u, v), of length 1 / radius, 1/mm; 0 on straight lines.
    bend: DVec2,
}

/// Why points and radii give no guide.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum GuideError {
    /// Fewer than two points, or two in the same place.
    #[error("a guide needs two points or more, all in different places")]
    Points,
    /// A number of radii that is neither one nor one per corner.
    #[error("{radii} radii are given for {corners} corners: write one for all, or one for each")]
    Radii {
        /// How many radii there are.
        radii: usize,
        /// How many points are corners.
        corners: usize,
    },
    /// A corner too sharp to be bent.
    #[error("at point {point} the guide turns back on itself")]
    Back {
        /// Number of the point, from 1.
        point: usize,
    },
    /// Not enough length between two points for the arcs there.
    #[error(
        "from point {} to point {} it is {length:.3} mm, but the bends there take {needed:.3} mm of it: give smaller radii",
        .points[0], .points[1]
    )]
    Room {
        /// Numbers of the points, from 1.
        points: [usize; 2],
        /// Distance between them, mm.
        length: f64,
        /// Length that the arcs take up, mm.
        needed: f64,
    },
}

impl Guide {
    /// A guide through points (mm), with the largest bends that fit; the points are rounded to 0.001 mm, so that they
    /// are short as text.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn through(points: &[DVec3]) -> Result<Self, GuideError> {
        /// Per mm.
        const PLACES: f64 = 1e3;
        let mut points: Vec<DVec3> = points.iter().map(|p| (p * PLACES).round() / PLACES + DVec3::ZERO).collect();
        points.dedup();
        Self::new(points, Vec::new())
    }

    /// A guide through `points` (mm) whose corners are bent to `radii` (mm): one radius for all, one for each corner,
    /// or none for the largest that fit.
    ///
    /// ```
    /// use bead_part::chart::Guide;
    /// use glam::DVec3;
    ///
    /// // Up, a quarter turn of 120 mm radius, and away.
    /// let points = vec![DVec3::ZERO, DVec3::new(0.0, 0.0, 140.0), DVec3::new(140.0, 0.0, 140.0)];
    /// let guide = Guide::new(points, vec![120.0])?;
    /// assert!((guide.length() - (20.0 + 60.0 * std::f64::consts::PI + 20.0)).abs() < 1e-9);
    /// # Ok::<(), bead_part::chart::GuideError>(())
    /// ```
    ///
    /// # Errors
    /// [`GuideError`].
    pub fn new(points: Vec<DVec3>, radii: Vec<f64>) -> Result<Self, GuideError> {
        let legs: Vec<DVec3> = points.windows(2).map(|w| w[1] - w[0]).collect();
        if legs.is_empty() || legs.iter().any(|leg| leg.length() < SHORTEST) {
            return Err(GuideError::Points);
        }
        let corners = legs.len() - 1;
        if radii.len() > 1 && radii.len() != corners {
            return Err(GuideError::Radii { radii: radii.len(), corners });
        }
        let turn = |k: usize| legs[k].angle_between(legs[k + 1]);
        if let Some(k) = (0..corners).find(|k| turn(*k) > SHARPEST) {
            return Err(GuideError::Back { point: k + 2 });
        }
        let half = |k: usize| legs[k].length() * if k == 0 || k == corners { 1.0 } else { 0.5 };
        let bend = |k: usize| {
            let (tangent, most) = ((turn(k) / 2.0).tan(), half(k).min(half(k + 1)));
            let radius = radii.get(k).or(radii.first()).copied().unwrap_or(most / tangent);
            (tangent > STRAIGHT).then_some(Bend { radius, cut: radius * tangent })
        };
        let bends: Vec<Option<Bend>> = (0..corners).map(bend).collect();
        for (k, leg) in legs.iter().enumerate() {
            let (length, needed) = (leg.length(), cut_before(&bends, k) + cut_after(&bends, k));
            if needed > length * (1.0 + ROUNDING) {
                return Err(GuideError::Room { points: [k + 1, k + 2], length, needed });
            }
        }
        let spans = spans(points[0], &legs, &bends);
        Ok(Self { points, radii, spans })
    }

    /// The points it was made from, mm.
    pub fn points(&self) -> &[DVec3] {
        &self.points
    }

    /// The radii it was made from, mm.
    pub fn radii(&self) -> &[f64] {
        &self.radii
    }

    /// Length of the curve, mm. Beyond both ends it continues straight.
    pub fn length(&self) -> f64 {
        self.spans.last().map_or(0.0, |last| last.to)
    }

    /// Radius of its tightest bend, mm; `None` for a straight line.
    pub fn tightest(&self) -> Option<f64> {
        self.spans.iter().filter_map(|span| span.centre()).map(|(_, radius)| radius).reduce(f64::min)
    }

    /// Thickness of 1 mm of h at point `p` (u, v) of the layer at `height` (mm), mm: 1 on straight lines, less towards
    /// the centre of a bend, 0 or less from the centre on.
    pub fn rise(&self, p: DVec2, height: f64) -> f64 {
        1.0 - self.bend(height).dot(p)
    }

    /// Vector towards the centre of the bend at a height (mm), of length 1 / radius, 1/mm; 0 on straight lines.
    pub(super) fn bend(&self, height: f64) -> DVec2 {
        self.span(height).bend
    }

    /// Coordinates (u, v, h) of a point in space; where there are several, those nearest to the curve.
    pub(super) fn coordinates(&self, p: DVec3) -> DVec3 {
        let last = self.spans.len() - 1;
        let mut best = (f64::INFINITY, DVec3::ZERO);
        for (k, span) in self.spans.iter().enumerate() {
            let is_end = k == 0 || k == last;
            if !is_end && p.distance(span.middle) - (span.to - span.from) / 2.0 > best.0 {
                continue;
            }
            let at = span.coordinates(p);
            let low = if k == 0 { f64::NEG_INFINITY } else { span.from };
            let high = if k == last { f64::INFINITY } else { span.to };
            let beyond = (low - at.z).max(at.z - high).max(0.0);
            let cost = at.truncate().length() + BEYOND * beyond;
            if cost < best.0 {
                best = (cost, at);
            }
        }
        best.1
    }

    /// Where an edge crosses the first plane between its heights (mm) in which two spans meet.
    pub(super) fn joint_between(&self, [a, b]: [DVec3; 2], heights: [f64; 2]) -> Option<DVec3> {
        let (low, high) = (heights[0].min(heights[1]) + AT_JOINT, heights[0].max(heights[1]) - AT_JOINT);
        let first = self.spans.partition_point(|span| span.to < low);
        let span = self.spans[..self.spans.len() - 1].get(first).filter(|span| span.to < high)?;
        let joint = span.frame(span.to);
        let [from, to] = [a, b].map(|p| (p - joint.origin).dot(joint.forth));
        let part = from / (from - to);
        (part > 0.0 && part < 1.0).then(|| a.lerp(b, part))
    }

    /// The point in space with these coordinates.
    pub(super) fn place(&self, p: DVec3) -> DVec3 {
        let Frame { origin, along: [u, v], .. } = self.span(p.z).frame(p.z);
        origin + u * p.x + v * p.y
    }

    /// The point in space for a point near the layer with this middle (mm). Heights are measured straight out of the
    /// layer and scaled by its local thickness up to [`WITHIN`] mm; above that, for travels, they are true.
    pub(super) fn at(&self, p: DVec3, middle: f64) -> At {
        let Frame { origin, along, forth } = self.span(middle).frame(middle);
        let (rise, out) = (self.rise(p.truncate(), middle), p.z - middle);
        let out = rise * out.min(WITHIN) + (out - WITHIN).max(0.0);
        At { place: origin + along[0] * p.x + along[1] * p.y + forth * out, along, normal: forth }
    }

    /// The same guide, starting `by` mm earlier.
    pub(super) fn begun_earlier(&self, by: f64) -> Self {
        let mut points = self.points.clone();
        points[0] -= self.spans[0].start.forth * by;
        let bends = self.spans.iter().map(|span| span.bend.length()).filter(|bend| *bend > 0.0);
        let radii: Vec<f64> = bends.map(f64::recip).collect();
        let radii = if self.radii.is_empty() && radii.len() + 2 == points.len() { radii } else { self.radii.clone() };
        Self::new(points, radii).unwrap_or_else(|_| self.clone())
    }

    /// Inverse of [`Self::at`].
    pub(super) fn on_layer(&self, p: DVec3, middle: f64) -> DVec3 {
        let Frame { origin, along, forth } = self.span(middle).frame(middle);
        let from = p - origin;
        let on_it = DVec2::new(from.dot(along[0]), from.dot(along[1]));
        let (rise, out) = (self.rise(on_it, middle), from.dot(forth));
        let above = (out - rise * WITHIN).max(0.0);
        on_it.extend(middle + (out - above) / rise + above)
    }

    fn span(&self, height: f64) -> &Span {
        let after = self.spans.partition_point(|span| span.to < height);
        &self.spans[after.min(self.spans.len() - 1)]
    }
}

/// An arc in place of a corner.
#[derive(Debug, Clone, Copy)]
struct Bend {
    /// Radius, mm.
    radius: f64,
    /// How far from the corner it begins and ends, mm.
    cut: f64,
}

/// Length that the arcs at both ends of a leg take up, mm.
fn cut_before(bends: &[Option<Bend>], leg: usize) -> f64 {
    leg.checked_sub(1).map_or(0.0, |corner| cut_after(bends, corner))
}

fn cut_after(bends: &[Option<Bend>], leg: usize) -> f64 {
    bends.get(leg).copied().flatten().map_or(0.0, |bend| bend.cut)
}

/// Points of a guide lie farther apart than this, mm.
const SHORTEST: f64 = 1e-3;
/// Lines are collinear if the tangent of half the angle between them is below this.
const STRAIGHT: f64 = 1e-9;
/// Lines must turn by less than this, rad.
const SHARPEST: f64 = 3.0;
/// Arcs may exceed the length of their line by this fraction, for rounding.
const ROUNDING: f64 = 1e-9;
/// Heights this close to the joint of two spans count as on it, mm.
const AT_JOINT: f64 = 1e-6;
/// Up to this height above its middle, mm, the local thickness of a layer applies; higher up there are only travels.
const WITHIN: f64 = 2.5;
/// Weight of a distance beyond the end of a span, relative to a distance beside it.
const BEYOND: f64 = 1e3;

/// The spans: lines and arcs in sequence.
fn spans(start: DVec3, legs: &[DVec3], bends: &[Option<Bend>]) -> Vec<Span> {
    let forth = legs[0].normalize();
    let turn = DQuat::from_rotation_arc(DVec3::Z, forth);
    let mut frame = Frame { origin: start, along: [turn * DVec3::X, turn * DVec3::Y], forth };
    let (mut spans, mut from) = (Vec::new(), 0.0);
    let mut add = |frame: &mut Frame, length: f64, bend: DVec2| {
        let mut span = Span { start: *frame, from, to: from + length, middle: frame.origin, bend };
        span.middle = span.frame(from + length / 2.0).origin;
        *frame = span.frame(span.to);
        from = span.to;
        spans.push(span);
    };
    for (k, leg) in legs.iter().enumerate() {
        let straight = leg.length() - cut_before(bends, k) - cut_after(bends, k);
        add(&mut frame, straight.max(0.0), DVec2::ZERO);
        let bend = bends.get(k).copied().flatten();
        if let (Some(Bend { radius, .. }), Some(next)) = (bend, legs.get(k + 1)) {
            let inwards = next.reject_from(*leg);
            let bend = DVec2::new(inwards.dot(frame.along[0]), inwards.dot(frame.along[1])).normalize() / radius;
            add(&mut frame, radius * leg.angle_between(*next), bend);
        }
    }
    spans
}

impl Span {
    /// Unit vector towards the centre of the arc in (u, v), and the arc's radius, mm; `None` on a straight line.
    fn centre(&self) -> Option<(DVec2, f64)> {
        let radius = self.bend.length().recip();
        radius.is_finite().then(|| (self.bend * radius, radius))
    }

    fn frame(&self, height: f64) -> Frame {
        let Frame { origin, along: [u, v], forth } = self.start;
        let Some((to, radius)) = self.centre() else {
            return Frame { origin: origin + forth * (height - self.from), ..self.start };
        };
        let inwards = u * to.x + v * to.y;
        let turn = DQuat::from_axis_angle(forth.cross(inwards), (height - self.from) / radius);
        let centre = origin + inwards * radius;
        Frame { origin: centre - turn * inwards * radius, along: [turn * u, turn * v], forth: turn * forth }
    }

    fn coordinates(&self, p: DVec3) -> DVec3 {
        let Frame { origin, along: [u, v], forth } = self.start;
        let from = p - origin;
        let on_it = DVec2::new(from.dot(u), from.dot(v));
        let Some((to, radius)) = self.centre() else {
            return on_it.extend(self.from + from.dot(forth));
        };
        // Seen along the axis of the arc.
        let (ahead, out) = (from.dot(forth), radius - on_it.dot(to));
        let inwards = radius - ahead.hypot(out);
        (to * inwards + to.perp() * on_it.dot(to.perp())).extend(self.from + radius * ahead.atan2(out))
    }
}
