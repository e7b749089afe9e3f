//! The shapes of footprints on rows: strips, their round ends, and slabs between parallel lines.

use glam::DVec2;

/// From one position on a row to another, mm.
pub(super) type Span = (f64, f64);

/// Shorter pieces are covered one by one, in radii: they link scan lines, whose run continues after them.
const SHORT: f64 = 8.0;

/// Strips of a run overlap by at least this fraction of their width, and are parallel to within this fraction of it.
const OVERLAP: f64 = 1e-3;

/// The strip that a straight piece covers.
#[derive(Debug, Clone, Copy)]
pub(super) struct Strip {
    pub(super) from: DVec2,
    /// Unit vector along it.
    pub(super) way: DVec2,
    pub(super) length: f64,
    pub(super) radius: f64,
    /// How far it extends beyond both ends, mm.
    pub(super) on: [f64; 2],
    /// Whether its ends are round.
    pub(super) round: [bool; 2],
}

impl Strip {
    /// `None` for a piece without length.
    pub(super) fn new(from: DVec2, to: DVec2, radius: f64) -> Option<Self> {
        let length = from.distance(to);
        (length > 0.0).then(|| Self {
            from,
            way: (to - from) / length,
            length,
            radius,
            on: [0.0; 2],
            round: [false; 2],
        })
    }

    pub(super) fn ends(&self) -> [DVec2; 2] {
        [self.from, self.from + self.length * self.way]
    }

    pub(super) fn is_short(&self) -> bool {
        self.length < SHORT * self.radius
    }

    /// Its lowest and highest y.
    pub(super) fn all(&self) -> (f64, f64) {
        let (low, high) = self.along();
        let [one, other] = self.round;
        let across = if one || other { self.radius } else { self.way.x.abs() * self.radius };
        (low - across, high + across)
    }

    /// The heights between which rows cross both long sides.
    pub(super) fn core(&self) -> (f64, f64) {
        let (low, high) = self.along();
        let across = self.way.x.abs() * self.radius;
        (low + across, high - across)
    }

    /// The lowest and highest y of its centre-line.
    pub(super) fn along(&self) -> (f64, f64) {
        let (a, b) = (self.from.y - self.on[0] * self.way.y, self.from.y + (self.length + self.on[1]) * self.way.y);
        (a.min(b), a.max(b))
    }

    /// The area between its long sides.
    pub(super) fn sides(&self) -> Slab {
        let half = self.radius / self.way.y.abs();
        Slab { y: self.from.y, low: self.from.x - half, high: self.from.x + half, lean: self.way.x / self.way.y }
    }

    /// The area between its ends.
    pub(super) fn between_ends(&self) -> Slab {
        let (a, b) = (-self.on[0] / self.way.x, (self.length + self.on[1]) / self.way.x);
        Slab {
            y: self.from.y,
            low: self.from.x + a.min(b),
            high: self.from.x + a.max(b),
            lean: -self.way.y / self.way.x,
        }
    }

    /// Whether another strip is adjacent to this one: parallel, equally wide and overlapping; then, whether it is at
    /// greater x.
    pub(super) fn beside(&self, other: &Self) -> Option<bool> {
        let reach = self.length.max(other.length) + self.from.distance(other.from);
        let parallel = self.way.perp_dot(other.way).abs() * reach < OVERLAP * self.radius;
        let apart = self.way.perp_dot(other.from - self.from);
        let near = (OVERLAP..2.0 - OVERLAP).contains(&(apart.abs() / self.radius));
        // To the left of an upward direction x decreases.
        (parallel && near && self.radius == other.radius).then_some((apart > 0.0) != (self.way.y > 0.0))
    }
}

/// A round end of a strip.
pub(super) struct Disc {
    pub(super) middle: DVec2,
    pub(super) radius: f64,
}

impl Disc {
    #[inline]
    pub(super) fn on(&self, y: f64) -> Span {
        let up = y - self.middle.y;
        // NaN where the row misses it.
        let half = (self.radius * self.radius - up * up).sqrt();
        (self.middle.x - half, self.middle.x + half)
    }
}

/// The span from the lower end of two spans to the higher end; NaN is ignored.
#[inline]
pub(super) fn union(a: Span, b: Span) -> Span {
    (a.0.min(b.0), a.1.max(b.1))
}

/// The area between two parallel lines.
pub(super) struct Slab {
    /// The y at which it extends from `low` to `high`.
    pub(super) y: f64,
    pub(super) low: f64,
    pub(super) high: f64,
    /// Its shift in x per unit of y.
    pub(super) lean: f64,
}

impl Slab {
    #[inline]
    pub(super) fn at(&self, y: f64) -> Span {
        let moved = (y - self.y) * self.lean;
        (self.low + moved, self.high + moved)
    }

    /// Its intersection with another slab on a row that meets both.
    #[inline]
    pub(super) fn meet(&self, other: &Self, y: f64) -> Span {
        let (a, b) = (self.at(y), other.at(y));
        // Lines along the row have no position on it (NaN) and are ignored.
        (a.0.max(b.0), a.1.min(b.1))
    }
}
