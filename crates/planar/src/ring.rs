//! The shapes: a closed [`Ring`], a [`Polygon`] with holes, a [`Region`] of disjoint polygons.

use crate::{boolean, polyline};
use glam::DVec2;
use serde::{Deserialize, Serialize};

/// A closed loop of points, mm; the first point is not repeated at the end.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Ring(Vec<DVec2>);

/// One outer ring, counter-clockwise, with clockwise holes.
///
/// ```
/// use planar::{DVec2, Polygon, Ring};
///
/// let square = |low: f64, high: f64| {
///     Ring::new([(low, low), (high, low), (high, high), (low, high)].map(DVec2::from).to_vec())
/// };
/// let frame = Polygon { outer: square(0.0, 10.0), holes: vec![square(4.0, 6.0).reversed()] };
/// assert_eq!(frame.area(), 100.0 - 4.0);
/// assert!(frame.contains(DVec2::new(2.0, 5.0)) && !frame.contains(DVec2::new(5.0, 5.0)));
/// ```
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Polygon {
    /// The outer boundary, counter-clockwise.
    pub outer: Ring,
    /// The holes, clockwise, inside `outer`.
    pub holes: Vec<Ring>,
}

/// Polygons with disjoint interiors. Every boolean and offset returns one.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Region(Vec<Polygon>);

/// Which winding numbers count as inside when loose rings become a [`Region`].
///
/// ```
/// use planar::{DVec2, FillRule, Region, Ring};
///
/// // A square within a square, both counter-clockwise: a hole for one rule, part of the whole for the other.
/// let square = |low: f64, high: f64| {
///     Ring::new([(low, low), (high, low), (high, high), (low, high)].map(DVec2::from).to_vec())
/// };
/// let area = |rule| Region::from_rings(&[square(0.0, 10.0), square(4.0, 6.0)], rule).area();
/// assert_eq!([area(FillRule::EvenOdd), area(FillRule::NonZero)], [96.0, 100.0]);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FillRule {
    /// Inside where the winding number is odd: orientation does not matter.
    EvenOdd,
    /// Inside where the winding number is not zero: overlapping outlines unite.
    NonZero,
    /// Inside where the winding number is positive: clockwise outlines cut away.
    Positive,
}

/// An axis-parallel box, mm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// Lowest x and y.
    pub min: DVec2,
    /// Highest x and y.
    pub max: DVec2,
}

impl Bounds {
    /// A box without extent at the origin.
    pub const EMPTY: Self = Self { min: DVec2::ZERO, max: DVec2::ZERO };

    /// The box around `points`; `None` when there are none.
    pub fn of(points: impl IntoIterator<Item = DVec2>) -> Option<Self> {
        let mut points = points.into_iter();
        let first = points.next()?;
        let start = Self { min: first, max: first };
        Some(points.fold(start, |b, p| Self { min: b.min.min(p), max: b.max.max(p) }))
    }

    /// The box around both.
    pub(crate) fn with(&self, other: &Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// Whether they have a point in common.
    pub(crate) fn meets(&self, other: &Self) -> bool {
        (self.min.cmple(other.max) & other.min.cmple(self.max)).all()
    }

    /// Width and height, mm.
    pub fn size(&self) -> DVec2 {
        self.max - self.min
    }

    /// The middle of the box.
    pub fn center(&self) -> DVec2 {
        (self.min + self.max) / 2.0
    }
}

impl Ring {
    /// A ring through `points`; the last is joined to the first.
    pub fn new(points: Vec<DVec2>) -> Self {
        Self(points)
    }

    /// The vertices in order.
    pub fn points(&self) -> &[DVec2] {
        &self.0
    }

    /// The vertices, by value.
    pub fn into_points(self) -> Vec<DVec2> {
        self.0
    }

    /// The edges as (from, to), the closing one last.
    pub fn edges(&self) -> impl Iterator<Item = (DVec2, DVec2)> + Clone + '_ {
        let closing = self.0.last().copied().zip(self.0.first().copied());
        self.0.windows(2).map(|w| (w[0], w[1])).chain(closing)
    }

    /// Signed area, mm²: positive when counter-clockwise.
    ///
    /// ```
    /// use planar::{DVec2, Ring};
    ///
    /// let triangle = Ring::new([(0.0, 0.0), (4.0, 0.0), (0.0, 3.0)].map(DVec2::from).to_vec());
    /// assert_eq!(triangle.area(), 6.0);
    /// assert_eq!(triangle.reversed().area(), -6.0);
    /// ```
    pub fn area(&self) -> f64 {
        let Some(&origin) = self.0.first() else { return 0.0 };
        self.edges().map(|(a, b)| (a - origin).perp_dot(b - origin)).sum::<f64>() / 2.0
    }

    /// The centroid of the area it bounds, mm; `None` where it bounds none.
    ///
    /// ```
    /// use planar::{DVec2, Ring};
    ///
    /// // That of a triangle is the mean of its corners.
    /// let triangle = Ring::new([(0.0, 0.0), (6.0, 0.0), (0.0, 3.0)].map(DVec2::from).to_vec());
    /// assert_eq!(triangle.centroid(), Some(DVec2::new(2.0, 1.0)));
    /// ```
    pub fn centroid(&self) -> Option<DVec2> {
        let origin = *self.0.first()?;
        let triangles = self.edges().map(|(a, b)| (a - origin, b - origin));
        let (area, moment) = triangles.fold((0.0, DVec2::ZERO), |(area, moment), (a, b)| {
            let twice = a.perp_dot(b);
            (area + twice, moment + (a + b) / 3.0 * twice)
        });
        (area.abs() > 1e-9).then(|| origin + moment / area)
    }

    /// Perimeter, mm.
    pub fn length(&self) -> f64 {
        self.edges().map(|(a, b)| a.distance(b)).sum()
    }

    /// The same loop run the other way.
    pub fn reversed(mut self) -> Self {
        self.0.reverse();
        self
    }

    /// Whether `p` lies inside (even-odd rule); either answer is possible on the boundary itself.
    pub fn contains(&self, p: DVec2) -> bool {
        self.edges().fold(false, |inside, (a, b)| {
            let crosses = (a.y > p.y) != (b.y > p.y) && p.x < (b.x - a.x) * (p.y - a.y) / (b.y - a.y) + a.x;
            inside != crosses
        })
    }
}

impl Polygon {
    /// Its points moved.
    pub fn moved(&self, to: impl Fn(DVec2) -> DVec2) -> Self {
        let ring = |ring: &Ring| Ring::new(ring.points().iter().map(|p| to(*p)).collect());
        Self { outer: ring(&self.outer), holes: self.holes.iter().map(ring).collect() }
    }

    /// A polygon without holes; the ring is turned counter-clockwise.
    pub fn simple(outer: Ring) -> Self {
        let outer = if outer.area() < 0.0 { outer.reversed() } else { outer };
        Self { outer, holes: Vec::new() }
    }

    /// The outer ring, then the holes.
    pub fn rings(&self) -> impl Iterator<Item = &Ring> {
        std::iter::once(&self.outer).chain(&self.holes)
    }

    /// Area, mm²: the outer ring less the holes.
    pub fn area(&self) -> f64 {
        self.rings().map(Ring::area).sum()
    }

    /// Whether `p` lies inside the outer ring and in no hole.
    pub fn contains(&self, p: DVec2) -> bool {
        self.rings().fold(false, |inside, ring| inside != ring.contains(p))
    }
}

impl Region {
    /// The empty region.
    pub const EMPTY: Self = Self(Vec::new());

    /// Unites loose, possibly crossing rings into disjoint polygons.
    pub fn from_rings(rings: &[Ring], rule: FillRule) -> Self {
        boolean::unite_rings(rings, rule)
    }

    /// Takes polygons that are disjoint and correctly wound already, as booleans return them.
    pub fn from_normalised(polygons: Vec<Polygon>) -> Self {
        Self(polygons)
    }

    /// The disjoint polygons.
    pub fn polygons(&self) -> &[Polygon] {
        &self.0
    }

    /// The disjoint polygons, by value.
    pub fn into_polygons(self) -> Vec<Polygon> {
        self.0
    }

    /// Every outer ring and hole.
    pub fn rings(&self) -> impl Iterator<Item = &Ring> {
        self.0.iter().flat_map(Polygon::rings)
    }

    /// Whether nothing is inside.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Area, mm².
    pub fn area(&self) -> f64 {
        self.0.iter().map(Polygon::area).sum()
    }

    /// Length of the whole boundary, mm.
    pub fn perimeter(&self) -> f64 {
        self.rings().map(Ring::length).sum()
    }

    /// Number of polygons less number of holes (Euler characteristic).
    pub fn euler(&self) -> i64 {
        self.0.iter().map(|p| 1 - p.holes.len() as i64).sum()
    }

    /// The box around everything; `None` when empty.
    pub fn bounds(&self) -> Option<Bounds> {
        Bounds::of(self.0.iter().flat_map(|p| p.outer.points().iter().copied()))
    }

    /// Whether `p` lies inside.
    pub fn contains(&self, p: DVec2) -> bool {
        self.0.iter().any(|polygon| polygon.contains(p))
    }

    /// The region turned about the origin; `direction` is the unit vector onto which the x axis is turned.
    pub fn turned(&self, direction: DVec2) -> Self {
        let ring = |ring: &Ring| Ring::new(ring.points().iter().map(|p| direction.rotate(*p)).collect());
        let polygon = |polygon: &Polygon| Polygon {
            outer: ring(&polygon.outer),
            holes: polygon.holes.iter().map(ring).collect(),
        };
        Self(self.0.iter().map(polygon).collect())
    }

    /// Drops polygons and holes smaller than `least`, mm².
    pub(crate) fn without_specks(self, least: f64) -> Self {
        let mut polygons = self.0;
        polygons.retain(|polygon| polygon.outer.area() >= least);
        polygons.iter_mut().for_each(|polygon| polygon.holes.retain(|hole| hole.area() <= -least));
        Self(polygons)
    }

    /// Drops vertices that lie within `tolerance` (mm) of the line that remains, and rings that vanish with them.
    pub fn simplified(self, tolerance: f64) -> Self {
        let ring = |r: Ring| polyline::simplify_ring(r, tolerance);
        let polygon = |p: Polygon| {
            let outer = ring(p.outer)?;
            Some(Polygon { outer, holes: p.holes.into_iter().filter_map(ring).collect() })
        };
        Self(self.0.into_iter().filter_map(polygon).collect())
    }
}

impl From<Polygon> for Region {
    fn from(polygon: Polygon) -> Self {
        Self(vec![polygon])
    }
}
