//! The metal of one straight piece of bead, in closed form.
//!
//! A pool that moves along a line and lays the footprint k(r) = c √(a² − r²), a = w/2, builds exactly the parabolic
//! bead h (1 − (2y/w)²), when c = 2h/(π a²). The height that a piece from t = 0 to L adds at a point (t, y) is
//! c [F(q₂) − F(q₁)] with ρ = √(a² − y²), q₁ = −t and q₂ = L − t, both clamped to ±ρ, and
//! F(q) = ½ (q √(ρ² − q²) + ρ² asin(q/ρ)). Pieces add up: cutting one in two changes nothing, and no volume is lost.
//!
//! Other footprints give other cross-sections in the same way: an even one, k = h/(2a), builds half an ellipse,
//! F(q) = q; and k(r) = h/(π √(a² − r²)) builds a flat bead, F(q) = asin(q/ρ): the stadium of a printer, taken as wide
//! as its area over its height.

use crate::bead::{Bead, Section};
use crate::pass::Pass;
use glam::DVec2;
use std::f64::consts::{FRAC_1_PI, FRAC_PI_2};

/// A straight piece of bead seen from above.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stroke {
    /// Where it begins, mm.
    pub from: DVec2,
    /// Where it ends, mm.
    pub to: DVec2,
    /// Its cross-section.
    pub bead: Bead,
}

/// The nominal bead of a profile, and its pace.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Nominal {
    /// The single bead.
    pub bead: Bead,
    /// Deposition speed of the process, mm/s.
    pub pace: f64,
    /// Height of a closed layer of such beads, mm.
    pub rise: f64,
}

impl Nominal {
    /// The bead of the given width (mm) at the given pace (mm/s): its cross-section is that of the nominal bead times
    /// nominal pace / pace.
    pub fn bead_at(&self, width: f64, pace: f64) -> Bead {
        let section = self.bead.section;
        let area = self.bead.area() * self.pace / pace;
        Bead { width, height: section.height_of(width, area), section }
    }
}

/// The pieces of a pass.
pub fn strokes(pass: &Pass, nominal: &Nominal) -> impl Iterator<Item = Stroke> {
    pass.segments().map(|s| {
        let bead = nominal.bead_at(s.width, s.pace);
        Stroke { from: s.from.truncate(), to: s.to.truncate(), bead }
    })
}

impl Stroke {
    /// Height it adds at a point, mm.
    ///
    /// ```
    /// use bead_plan::{bead::Bead, deposit::Stroke};
    /// use glam::DVec2;
    ///
    /// // Far from its ends, a piece is the parabola: the crown, and three quarters of it half-way to the edge.
    /// let piece = Stroke { from: DVec2::ZERO, to: DVec2::X * 60.0, bead: Bead::parabola(6.0, 2.0) };
    /// assert!((piece.height_at(DVec2::new(30.0, 0.0)) - 2.0).abs() < 1e-6);
    /// assert!((piece.height_at(DVec2::new(30.0, 1.5)) - 1.5).abs() < 1e-6);
    /// assert_eq!(piece.height_at(DVec2::new(30.0, 4.0)), 0.0);
    /// ```
    pub fn height_at(&self, p: DVec2) -> f64 {
        self.frame().map_or(0.0, |frame| frame.height_at(p))
    }

    /// Volume of its metal, mm³.
    pub fn volume(&self) -> f64 {
        self.from.distance(self.to) * self.bead.area()
    }

    /// The values that do not change from point to point; `None` for a piece without length or bead.
    pub(super) fn frame(&self) -> Option<Frame> {
        let Bead { width, height, section } = self.bead;
        let (way, a) = (self.to - self.from, section.footprint(width, height) / 2.0);
        let length = way.length();
        let along = way / length;
        let frame = Frame { from: self.from, along, recip: along.recip(), length, a, height, section };
        (length > 0.0 && a > 0.0).then_some(frame)
    }
}

/// A stroke prepared for evaluation at many points.
#[derive(Debug, Clone, Copy)]
pub(super) struct Frame {
    pub(super) from: DVec2,
    pub(super) along: DVec2,
    /// 1 / `along`.
    recip: DVec2,
    pub(super) length: f64,
    pub(super) a: f64,
    pub(super) section: Section,
    pub(super) height: f64,
}

/// The footprint of a pool: what it adds while it passes.
pub(super) trait Footprint {
    /// The fraction of the height that is added while the pool moves from 0 to `u` half-chords, at a point with
    /// `inside` = 1 − (y/a)²: half of the whole at u = 1.
    fn swept(inside: f64, u: f64) -> f64;

    /// The fraction that the whole pool adds.
    fn whole(inside: f64) -> f64;
}

/// Builds a parabola.
pub(super) struct Domed;
/// Builds half an ellipse.
pub(super) struct Even;
/// Builds a flat bead.
pub(super) struct Rimmed;

impl Footprint for Domed {
    #[inline]
    fn swept(inside: f64, u: f64) -> f64 {
        inside * FRAC_1_PI * swept(u)
    }

    #[inline]
    fn whole(inside: f64) -> f64 {
        inside.max(0.0)
    }
}

impl Footprint for Even {
    #[inline]
    fn swept(inside: f64, u: f64) -> f64 {
        0.5 * inside.sqrt() * u.clamp(-1.0, 1.0)
    }

    #[inline]
    fn whole(inside: f64) -> f64 {
        inside.max(0.0).sqrt()
    }
}

impl Footprint for Rimmed {
    #[inline]
    fn swept(inside: f64, u: f64) -> f64 {
        // Outside the bead there is nothing to sweep.
        if inside > 0.0 { FRAC_1_PI * asin(u.clamp(-1.0, 1.0)) } else { 0.0 }
    }

    #[inline]
    fn whole(inside: f64) -> f64 {
        if inside > 0.0 { 1.0 } else { 0.0 }
    }
}

impl Frame {
    /// Height at a point, mm.
    pub(super) fn height_at(&self, p: DVec2) -> f64 {
        match self.section {
            Section::Parabola => self.height_of::<Domed>(p),
            Section::Ellipse => self.height_of::<Even>(p),
            Section::Stadium => self.height_of::<Rimmed>(p),
        }
    }

    /// Height at a point, mm. Straight-line code without branches: the loops over rows become vector instructions.
    #[inline]
    pub(super) fn height_of<F: Footprint>(&self, p: DVec2) -> f64 {
        let d = p - self.from;
        let (t, y) = (d.dot(self.along), self.along.perp_dot(d));
        let square = 1.0 - (y / self.a) * (y / self.a);
        // Outside the bead the square is negative and the product zero.
        let inside = square.max(0.0);
        let reach = self.a * inside.max(f64::MIN_POSITIVE).sqrt();
        self.height * (F::swept(inside, (self.length - t) / reach) - F::swept(inside, -t / reach))
    }

    /// Height at a point over which the whole footprint passes, mm.
    #[inline]
    pub(super) fn passed_over<F: Footprint>(&self, p: DVec2) -> f64 {
        let y = self.along.perp_dot(p - self.from) / self.a;
        self.height * F::whole(1.0 - y * y)
    }

    /// The interval of row `y` that gets metal, and the interval in it over which the whole footprint passes; x in mm.
    #[inline]
    pub(super) fn row(&self, y: f64) -> Option<(f64, f64, f64, f64)> {
        let (u, a, dy) = (self.along, self.a, y - self.from.y);
        // Along a row, t = dx u.x + dy u.y and the distance from the line is dy u.x − dx u.y.
        let across = between(-self.recip.y, dy * u.x, -a, a);
        let whole = between(self.recip.x, dy * u.y, 0.0, self.length);
        let inner = between(self.recip.x, dy * u.y, a, self.length - a);
        let disc = |dx: f64, dy: f64| {
            let square = a * a - dy * dy;
            if square >= 0.0 { (dx - square.sqrt(), dx + square.sqrt()) } else { NOWHERE }
        };
        let ends = [disc(0.0, dy), disc(self.length * u.x, dy - self.length * u.y)];
        let (low, high) = ends.into_iter().fold(meet(across, whole), |a, b| (a.0.min(b.0), a.1.max(b.1)));
        let (plain_low, plain_high) = meet(across, inner);
        let x = self.from.x;
        (low <= high).then_some((x + low, x + high, x + plain_low, x + plain_high))
    }
}

/// The empty interval.
const NOWHERE: (f64, f64) = (f64::INFINITY, f64::NEG_INFINITY);

/// The interval in which x / `per` + `start` is between `low` and `high`.
#[inline]
fn between(per: f64, start: f64, low: f64, high: f64) -> (f64, f64) {
    if low > high {
        return NOWHERE;
    }
    if per.abs() > 1e12 {
        return if low <= start && start <= high { (f64::NEG_INFINITY, f64::INFINITY) } else { NOWHERE };
    }
    let (a, b) = ((low - start) * per, (high - start) * per);
    (a.min(b), a.max(b))
}

#[inline]
fn meet(a: (f64, f64), b: (f64, f64)) -> (f64, f64) {
    let (low, high) = (a.0.max(b.0), a.1.min(b.1));
    if low <= high { (low, high) } else { NOWHERE }
}

/// u √(1 − u²) + asin u for u clamped to ±1: −π/2 to π/2, exact at the ends; elsewhere the error is below 3e-8.
#[inline]
fn swept(u: f64) -> f64 {
    let u = u.clamp(-1.0, 1.0);
    u * (1.0 - u * u).sqrt() + asin(u)
}

/// Arc sine after Abramowitz and Stegun 4.4.46, error below 2e-8; without branches.
#[inline]
fn asin(u: f64) -> f64 {
    const P: [f64; 8] = [
        1.570_796_305_0,
        -0.214_598_801_6,
        0.088_978_987_4,
        -0.050_174_304_6,
        0.030_891_881_0,
        -0.017_088_125_6,
        0.006_670_090_1,
        -0.001_262_491_1,
    ];
    let x = u.abs();
    let series = P.iter().rev().fold(0.0, |sum, p| sum * x + p);
    (FRAC_PI_2 - (1.0 - x).sqrt() * series).copysign(u)
}
