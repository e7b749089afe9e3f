//! Charts: the shape of a part's layers where they are not level.
//!
//! A chart gives each point in space coordinates (u, v, h), all mm: h is the height above the surface on which the
//! build begins, (u, v) are lengths on a layer. A layer of a plan is a plane in the chart, so everything between
//! slicing and welding sees level layers; [`Sheet`] maps its points back to space.
//!
//! | file | what it holds |
//! | --- | --- |
//! | `plane` | level layers, and layers square to any direction |
//! | `cylinder` | layers around an axis, outwards or inwards |
//! | `cone` | layers on a cone |
//! | `guide` | layers square to a curve of lines and arcs |
//! | `surface` | layers that follow a surface |
//! | `polar` | what layers around an axis have in common: angles, and where a turn ends |
//! | [`warp`] | a mesh in the coordinates of a chart |
//! | [`seam`] | islands that cross the line at which a layer is unrolled |
//! | `text` | charts as people write them: `cylinder:axis=z,radius=36` |

mod bound;
mod cone;
mod cylinder;
mod guide;
mod plane;
mod polar;
pub mod seam;
pub(crate) mod surface;
mod text;
pub mod warp;

pub use bound::Bound;
pub use cone::Cone;
pub use cylinder::{Cylinder, Side};
pub use guide::{Guide, GuideError};
pub use plane::Plane;
pub use surface::{Surface, SurfaceError};
pub use text::{ChartError, point};

use crate::model::Mesh;
use glam::{DVec2, DVec3};
use planar::{Bounds, Polygon, Ring};
use polar::Polar;
use serde::{Deserialize, Serialize};
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

/// The shape of a part's layers; level by default. In files it is text, as people write it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub enum Chart {
    /// Planes square to a direction.
    Plane(Plane),
    /// Cylinders around an axis.
    Cylinder(Cylinder),
    /// Cones around an axis.
    Cone(Cone),
    /// Planes square to a curve.
    Guide(Arc<Guide>),
    /// Parallel to a surface.
    Surface(Arc<Surface>),
}

impl Default for Chart {
    fn default() -> Self {
        Self::Plane(Plane::default())
    }
}

/// A point of a layer in space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct At {
    /// Position, mm.
    pub place: DVec3,
    /// Unit vectors along which u and v increase.
    pub along: [DVec3; 2],
    /// Unit vector out of the layer, along which h increases.
    pub normal: DVec3,
}

/// The kinds of charts, by how they are computed.
enum Lie<'a> {
    Flat(&'a Plane),
    Along(&'a Guide),
    Over(&'a Surface),
    Around(&'a dyn Polar),
}

/// One layer of a chart. Lengths on it are true at its mid-height.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sheet<'a> {
    chart: &'a Chart,
    /// Height h of its middle, mm.
    middle: f64,
}

impl Chart {
    /// Whether layers are level and h is z, so that chart and part have the same coordinates.
    pub fn is_level(&self) -> bool {
        *self == Self::default()
    }

    /// Whether layers lie around an axis.
    pub fn goes_around(&self) -> bool {
        self.polar().is_some()
    }

    /// The same layers, starting `by` mm lower, so that they include what lies under the first layer.
    pub fn lowered(&self, by: f64) -> Self {
        match self {
            Self::Plane(plane) => Self::Plane(Plane { origin: plane.origin - plane.up * by, ..*plane }),
            Self::Cylinder(cylinder) => {
                let inwards = if cylinder.side == Side::Inner { -by } else { by };
                Self::Cylinder(Cylinder { radius: (cylinder.radius - inwards).max(0.0), ..*cylinder })
            }
            Self::Cone(cone) => Self::Cone(cone.lowered(by)),
            Self::Guide(guide) => Self::Guide(Arc::new(guide.begun_earlier(by))),
            Self::Surface(surface) => Self::Surface(Arc::new(surface.lowered(by))),
        }
    }

    /// The name that people type.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Plane(_) => "plane",
            Self::Cylinder(_) => "cylinder",
            Self::Cone(_) => "cone",
            Self::Guide(_) => "guide",
            Self::Surface(_) => "surface",
        }
    }

    /// Its text, without long lists of numbers.
    pub fn short(&self) -> String {
        match self {
            Self::Surface(surface) => format!("surface:up={}, over {} heights", surface.up(), surface.heights().len()),
            _ => self.to_string(),
        }
    }

    /// How its layers lie, for people: `around an axis, from a radius of 28.0 mm`.
    ///
    /// ```
    /// use bead_part::chart::Chart;
    ///
    /// assert_eq!(Chart::default().in_words(), "level");
    /// let leaning: Chart = "plane:up=0/1/1".parse()?;
    /// assert_eq!(leaning.in_words(), "leaning 45°");
    /// let around: Chart = "cylinder:axis=z,radius=20,side=inner".parse()?;
    /// assert_eq!(around.in_words(), "around an axis, inwards from a radius of 20.0 mm");
    /// # Ok::<(), bead_part::chart::ChartError>(())
    /// ```
    pub fn in_words(&self) -> String {
        match self {
            Self::Plane(plane) => match plane.up.angle_between(DVec3::Z).to_degrees() {
                lean if lean < 0.05 => "level".to_owned(),
                lean => format!("leaning {lean:.0}°"),
            },
            Self::Cylinder(cylinder) => {
                let inwards = if cylinder.side == Side::Inner { "inwards " } else { "" };
                format!("around an axis, {inwards}from a radius of {:.1} mm", cylinder.radius)
            }
            Self::Cone(cone) => format!("around a cone of {:.0}°", 2.0 * cone.half_angle),
            Self::Guide(guide) => format!("along a guide {:.0} mm long", guide.length()),
            Self::Surface(_) => "over a surface".to_owned(),
        }
    }

    /// The layer whose middle is at height `middle`, mm.
    pub fn sheet(&self, middle: f64) -> Sheet<'_> {
        Sheet { chart: self, middle }
    }

    /// The coordinates of a point in space, unrolled at its own height; angles lie within half a turn of the start of a
    /// layer.
    ///
    /// ```
    /// use bead_part::chart::Chart;
    /// use glam::DVec3;
    /// use std::f64::consts::FRAC_PI_2;
    ///
    /// // Layers around the z axis, from a radius of 20 mm on.
    /// let chart: Chart = "cylinder:axis=z,radius=20".parse()?;
    /// let at = chart.coordinates(DVec3::new(0.0, 30.0, 7.0));
    /// // The seam, and with it the angle 0, lies a little beside where it is asked for.
    /// assert!(at.distance(DVec3::new(FRAC_PI_2 * 30.0, 7.0, 10.0)) < 0.01);
    /// # Ok::<(), bead_part::chart::ChartError>(())
    /// ```
    pub fn coordinates(&self, p: DVec3) -> DVec3 {
        match self.lie() {
            Lie::Flat(plane) => plane.coordinates(p),
            Lie::Along(guide) => guide.coordinates(p),
            Lie::Over(surface) => surface.coordinates(p),
            Lie::Around(polar) => {
                let around = polar.around(p);
                polar.unrolled(around.angle, around.along, around.height).extend(around.height)
            }
        }
    }

    /// Whether the thickness of a layer varies from point to point.
    pub fn has_wedges(&self) -> bool {
        matches!(self, Self::Guide(_))
    }

    /// The volume in space, mm³, of a mesh given in the chart's coordinates.
    pub fn volume(&self, mesh: &Mesh) -> f64 {
        let Self::Guide(guide) = self else { return mesh.volume() };
        let mut placed = mesh.clone();
        placed.vertices.iter_mut().for_each(|p| *p = guide.place(*p));
        placed.volume()
    }

    /// The greatest factor by which beads lie farther apart than planned at a point of a layer: 1 except on the slopes
    /// of a surface.
    pub fn stretch(&self, p: DVec2) -> f64 {
        match self {
            Self::Surface(surface) => surface.stretch(p),
            _ => 1.0,
        }
    }

    /// Distance of a point from the axis, mm; `None` for charts without an axis.
    pub fn off_axis(&self, p: DVec3) -> Option<f64> {
        self.polar().map(|polar| polar.off_axis(p))
    }

    /// How layers around an axis are unrolled; `None` for charts without an axis.
    fn polar(&self) -> Option<&dyn Polar> {
        match self {
            Self::Plane(_) | Self::Guide(_) | Self::Surface(_) => None,
            Self::Cylinder(cylinder) => Some(cylinder),
            Self::Cone(cone) => Some(cone),
        }
    }

    fn lie(&self) -> Lie<'_> {
        match self {
            Self::Plane(plane) => Lie::Flat(plane),
            Self::Guide(guide) => Lie::Along(guide),
            Self::Surface(surface) => Lie::Over(surface),
            Self::Cylinder(cylinder) => Lie::Around(cylinder),
            Self::Cone(cone) => Lie::Around(cone),
        }
    }
}

impl Sheet<'_> {
    /// The point in space with these coordinates.
    pub fn at(&self, p: DVec3) -> At {
        match self.chart.lie() {
            Lie::Flat(plane) => plane.at(p),
            Lie::Along(guide) => guide.at(p, self.middle),
            Lie::Over(surface) => surface.at(p),
            Lie::Around(polar) => {
                let (angle, along) = polar.rolled(p.truncate(), self.middle);
                let (angle, along) = polar.risen(angle, along, p.z - self.middle);
                polar.at(angle, along, p.z)
            }
        }
    }

    /// The coordinates of a point in space, its angle within half a turn of that of `near`.
    pub fn coordinates(&self, p: DVec3, near: DVec2) -> DVec3 {
        match self.chart.lie() {
            Lie::Flat(plane) => plane.coordinates(p),
            Lie::Along(guide) => guide.on_layer(p, self.middle),
            Lie::Over(surface) => surface.coordinates(p),
            Lie::Around(polar) => {
                let around = polar.around(p);
                let (nearest, _) = polar.rolled(near, self.middle);
                let (angle, along) = polar.risen(around.angle, around.along, self.middle - around.height);
                polar.unrolled(polar::near(angle, nearest), along, self.middle).extend(around.height)
            }
        }
    }

    /// Thickness of 1 mm of h at a point of the layer, mm: 1 except on a wedge.
    pub fn rise(&self, p: DVec2) -> f64 {
        match self.chart {
            Chart::Guide(guide) => guide.rise(p, self.middle),
            _ => 1.0,
        }
    }

    /// The part of a layer, within `bounds` (mm), on which 1 mm of h is more than `more` mm thick; `None` if there is
    /// none.
    pub fn rising(&self, more: f64, bounds: &Bounds) -> Option<Polygon> {
        let Chart::Guide(guide) = self.chart else { return None };
        let bend = guide.bend(self.middle);
        let reach = bounds.min.length() + bounds.max.length() + bounds.size().length();
        // On a straight line that is all of the layer or nothing.
        let (outwards, from) = match bend.try_normalize() {
            Some(inwards) => (-inwards, (more - 1.0) / bend.length()),
            None => (DVec2::X, if more < 1.0 { -reach } else { reach }),
        };
        let (near, far, aside) = (outwards * from, outwards * reach, outwards.perp() * reach);
        (from < reach).then(|| Polygon::simple(Ring::new(vec![near - aside, far - aside, far + aside, near + aside])))
    }

    /// The point of this layer over or under a point of another layer, along the normal.
    pub fn across(&self, p: DVec2, from: &Sheet<'_>) -> DVec2 {
        let Some(polar) = self.chart.polar() else { return p };
        let (angle, along) = polar.rolled(p, from.middle);
        let (angle, along) = polar.risen(angle, along, self.middle - from.middle);
        polar.unrolled(angle, along, self.middle)
    }

    /// Whether the unrolled layer may continue beyond one turn. On a cone a second turn would overlap the first.
    fn goes_on(&self) -> bool {
        matches!(self.chart, Chart::Cylinder(_))
    }

    /// Number of turns about the axis from `p` to `to`; 0 where layers do not continue beyond one turn.
    pub fn turns_to(&self, p: DVec2, to: DVec2) -> f64 {
        let angle = |polar: &dyn Polar, p: DVec2| polar.rolled(p, self.middle).0;
        let polar = self.chart.polar().filter(|_| self.goes_on());
        polar.map_or(0.0, |polar| (angle(polar, to) - angle(polar, p)) / TAU)
    }

    /// The same point some turns further around the axis; `None` where layers do not continue beyond one turn.
    pub fn turned(&self, p: DVec2, turns: f64) -> Option<DVec2> {
        let polar = self.chart.polar().filter(|_| self.goes_on())?;
        let (angle, along) = polar.rolled(p, self.middle);
        Some(polar.unrolled(angle + turns * TAU, along, self.middle))
    }

    /// The part of an unrolled layer between two angles (rad), extended by `reach` (mm) along the layer's straight
    /// lines to both sides.
    fn sector(&self, [from, to]: [f64; 2], reach: f64) -> Polygon {
        let Some(polar) = self.chart.polar() else { return Polygon::default() };
        let count = ((to - from) / SECTOR_STEP).ceil().max(1.0) as usize;
        let at =
            |k: usize, along: f64| polar.unrolled(from + (to - from) * k as f64 / count as f64, along, self.middle);
        let near = (0..=count).map(|k| at(k, -reach));
        let far = (0..=count).rev().map(|k| at(k, reach));
        Polygon::simple(Ring::new(near.chain(far).collect()))
    }

    /// Position of a point along the seam at this angle (rad), mm; `None` if it is farther than `within` (mm) from the
    /// seam.
    fn on_seam(&self, p: DVec2, angle: f64, within: f64) -> Option<f64> {
        let polar = self.chart.polar()?;
        let (_, along) = polar.rolled(p, self.middle);
        (polar.unrolled(angle, along, self.middle).distance(p) <= within).then_some(along)
    }

    /// A point some turns further on; if it is within `within` (mm) of a seam, it is also moved across it by `over`
    /// (mm).
    fn over_seam(&self, p: DVec2, turns: f64, within: f64, over: f64) -> DVec2 {
        let Some(polar) = self.chart.polar() else { return p };
        let (angle, along) = polar.rolled(p, self.middle);
        let side = [1.0, -1.0].into_iter().find(|side| self.on_seam(p, side * PI, within).is_some()).unwrap_or(0.0);
        let further = |by: f64| polar.unrolled(angle + turns * TAU + by, along, self.middle);
        // Length of a small turn, mm.
        let around = further(SMALL_TURN).distance(further(0.0));
        further(side * over / around.max(over) * SMALL_TURN)
    }

    /// Points between `from` (excluded) and `to` (included), so close that straight lines in space between them stay
    /// within `tolerance` (mm) of the straight line in the chart, and the normal turns by at most `angle` (rad) along
    /// each.
    pub fn divided(&self, from: DVec3, to: DVec3, tolerance: f64, angle: f64) -> impl Iterator<Item = DVec3> + use<> {
        let count = match self.chart {
            Chart::Plane(_) | Chart::Guide(_) => 1,
            Chart::Cylinder(_) | Chart::Cone(_) | Chart::Surface(_) => self.pieces(from, to, tolerance, angle),
        };
        (1..=count).map(move |k| if k == count { to } else { from.lerp(to, k as f64 / count as f64) })
    }

    fn pieces(&self, from: DVec3, to: DVec3, tolerance: f64, angle: f64) -> usize {
        let turn = self.chart.polar().map_or(0.0, |polar| {
            polar.rolled(to.truncate(), self.middle).0 - polar.rolled(from.truncate(), self.middle).0
        });
        let mut count = ((turn.abs() / angle).ceil() as usize).clamp(1, MOST_PIECES);
        let fits = |count: usize| {
            let end = |k: usize| self.at(from.lerp(to, k as f64 / count as f64));
            (0..count).all(|k| {
                let (a, b) = (end(k), end(k + 1));
                let middle = self.at(from.lerp(to, (k as f64 + 0.5) / count as f64)).place;
                a.normal.angle_between(b.normal) <= angle && middle.distance(a.place.midpoint(b.place)) <= tolerance
            })
        };
        while count < MOST_PIECES && !fits(count) {
            count *= 2;
        }
        count
    }
}

/// Most pieces into which a straight line is divided.
const MOST_PIECES: usize = 1 << 16;

/// A small angle, rad, for measuring lengths around the axis.
const SMALL_TURN: f64 = 1e-3;

/// Sectors have corners this close together, rad: their far sides lie well outside what is cut.
const SECTOR_STEP: f64 = 0.2;
