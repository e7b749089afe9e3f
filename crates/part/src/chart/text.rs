//! Charts as people write them: a name, then keys and values, such as `cylinder:axis=z,radius=36`.

use super::{Bound, Chart, Cone, Cylinder, Guide, GuideError, Plane, Side, Surface, SurfaceError};
use glam::{DVec2, DVec3};
use std::fmt;
use std::str::FromStr;
use std::sync::Arc;

/// Why a chart cannot be read.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ChartError {
    /// No such chart.
    #[error(
        "\"{0}\" is no kind of layers: write plane, cylinder, cone, guide or surface, such as cylinder:axis=z,radius=36"
    )]
    Kind(String),
    /// No such key for this chart.
    #[error("a {kind} has no \"{key}\": it takes {known}")]
    Key {
        /// The kind of chart.
        kind: &'static str,
        /// What was written.
        key: String,
        /// What may be written.
        known: &'static str,
    },
    /// A key without a value.
    #[error("\"{0}\" is no KEY=VALUE, such as axis=z")]
    Pair(String),
    /// A value that cannot be read or makes no sense.
    #[error("{key}={value}: {expected}")]
    Value {
        /// The key.
        key: String,
        /// What was written.
        value: String,
        /// What may be written.
        expected: &'static str,
    },
    /// Something other than a plane where a half-space is meant.
    #[error("\"{0}\" is no plane: write up=X/Y/Z,through=X/Y/Z; what lies above it is kept")]
    Half(String),
    /// Something other than a plane or a cylinder as a bound.
    #[error(
        "\"{0}\" bounds nothing: write up=X/Y/Z,through=X/Y/Z for what lies above a plane, or \
         cylinder:axis=X/Y/Z,through=X/Y/Z,radius=R,side=inner (or outer)"
    )]
    Bound(String),
    /// Points and radii that do not define a guide.
    #[error(transparent)]
    Guide(#[from] GuideError),
    /// Heights that do not define a surface.
    #[error(transparent)]
    Surface(#[from] SurfaceError),
    /// A required value is missing.
    #[error("a {kind} needs {key}: {why}")]
    Missing {
        /// The chart.
        kind: &'static str,
        /// The key.
        key: &'static str,
        /// What the value means.
        why: &'static str,
    },
}

const PLANE: &str = "up and through";
const CYLINDER: &str = "axis, through, radius, side and seam";
const CONE: &str = "axis, tip, angle and seam";
const GUIDE: &str = "points and radius";
const SURFACE: &str = "up, from, step, columns and heights";

impl FromStr for Chart {
    type Err = ChartError;

    fn from_str(text: &str) -> Result<Self, ChartError> {
        let (name, values) = text.split_once(':').unwrap_or((text, ""));
        match name.trim() {
            "plane" => Ok(Self::Plane(plane(values)?)),
            "cylinder" => Ok(Self::Cylinder(cylinder(values)?)),
            "cone" => {
                let given = Given::new("cone", CONE, values, &["axis", "tip", "angle", "seam"])?;
                let why = "the angle between its axis and its side, °";
                let missing = ChartError::Missing { kind: "cone", key: "angle", why };
                let half_angle = given.angle("angle", 1.0..=89.0)?.ok_or(missing)?;
                let (axis, tip) = (given.direction("axis")?, given.place("tip")?);
                let seam = given.angle("seam", -360.0..=360.0)?.unwrap_or(SEAM);
                Ok(Self::Cone(Cone { tip, axis, half_angle, seam }))
            }
            "guide" => {
                let given = Given::new("guide", GUIDE, values, &["points", "radius"])?;
                Ok(Self::Guide(Arc::new(Guide::new(given.places("points")?, given.radii()?)?)))
            }
            "surface" => Ok(Self::Surface(Arc::new(surface(values)?))),
            other => Err(ChartError::Kind(other.to_owned())),
        }
    }
}

fn surface(values: &str) -> Result<Surface, ChartError> {
    let given = Given::new("surface", SURFACE, values, &["up", "from", "step", "columns", "heights"])?;
    let heights = given.needed("heights", "those of a grid, row by row, mm; beadwright surface writes them")?;
    let all: Option<Vec<f64>> = heights.split(BETWEEN).map(number).collect();
    let all =
        all.ok_or_else(|| Given::wrong("heights", &shortened(heights), "write numbers in mm, such as 0:0.5:1.2"))?;
    let from = given.needed("from", "where the first height lies, mm")?;
    let place: Option<Vec<f64>> = from.split('/').map(number).collect();
    let Some([x, y]) = place.as_deref() else {
        return Err(Given::wrong("from", from, "write x/y in mm, such as -60/-60"));
    };
    let step = given.needed("step", "the distance of heights, mm")?;
    let apart = number(step).filter(|step| (0.01..=1000.0).contains(step));
    let apart = apart.ok_or_else(|| Given::wrong("step", step, "write mm, 0.01 to 1000"))?;
    let columns = given.needed("columns", "how many heights a row has")?;
    let count = columns.parse().map_err(|_| Given::wrong("columns", columns, "write a whole number"))?;
    Ok(Surface::new(given.direction("up")?, DVec2::new(*x, *y), apart, count, all)?)
}

/// A finite number.
fn number(text: &str) -> Option<f64> {
    text.trim().parse().ok().filter(|number: &f64| number.is_finite())
}

/// The beginning of a long value.
fn shortened(value: &str) -> String {
    let start: String = value.chars().take(40).collect();
    if start.len() < value.len() { format!("{start}…") } else { start }
}

fn plane(values: &str) -> Result<Plane, ChartError> {
    let given = Given::new("plane", PLANE, values, &["up", "through"])?;
    Ok(Plane { up: given.direction("up")?, origin: given.place("through")? })
}

fn cylinder(values: &str) -> Result<Cylinder, ChartError> {
    let given = Given::new("cylinder", CYLINDER, values, &["axis", "through", "radius", "side", "seam"])?;
    Ok(Cylinder {
        axis: given.direction("axis")?,
        through: given.place("through")?,
        radius: given.radius()?,
        side: given.side()?,
        seam: given.angle("seam", -360.0..=360.0)?.unwrap_or(SEAM),
    })
}

impl FromStr for Bound {
    type Err = ChartError;

    /// Reads a plane, or `cylinder:axis=z,through=0/0/0,radius=15,side=inner`.
    fn from_str(text: &str) -> Result<Self, ChartError> {
        match text.split_once(':') {
            Some((name, values)) if name.trim() == "cylinder" => cylinder(values).map(Self::Cylinder),
            Some((name, _)) if name.trim() != "plane" => Err(ChartError::Bound(text.to_owned())),
            _ => text.parse().map(Self::Plane),
        }
    }
}

impl FromStr for Plane {
    type Err = ChartError;

    /// Reads `up=0/0/1,through=0/0/60`, with or without the chart's name before it.
    fn from_str(text: &str) -> Result<Self, ChartError> {
        match text.split_once(':') {
            Some((name, _)) if name.trim() != "plane" => Err(ChartError::Half(text.to_owned())),
            Some((_, values)) => plane(values),
            None => plane(text),
        }
    }
}

/// Separates the values of a list.
const BETWEEN: &str = ":";
/// Default angle at which layers are cut open, °: angle 0 is then along x.
const SEAM: f64 = 180.0;

impl fmt::Display for Chart {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Plane(plane) => write!(f, "plane:{plane}"),
            Self::Cylinder(cylinder) => write!(f, "{},seam={}", seamless(cylinder), cylinder.seam),
            Self::Cone(Cone { tip, axis, half_angle, seam }) => {
                write!(f, "cone:axis={},tip={},angle={half_angle},seam={seam}", three_of(*axis), three_of(*tip))
            }
            Self::Surface(surface) => {
                let heights: Vec<String> = surface.heights().iter().map(f64::to_string).collect();
                let (up, from) = (three_of(surface.up()), surface.from());
                write!(
                    f,
                    "surface:up={up},from={}/{},step={},columns={}",
                    from.x,
                    from.y,
                    surface.step(),
                    surface.columns()
                )?;
                write!(f, ",heights={}", heights.join(BETWEEN))
            }
            Self::Guide(guide) => {
                let joined = |values: Vec<String>| values.join(BETWEEN);
                write!(f, "guide:points={}", joined(guide.points().iter().map(|p| three_of(*p)).collect()))?;
                match guide.radii() {
                    [] => Ok(()),
                    radii => write!(f, ",radius={}", joined(radii.iter().map(f64::to_string).collect())),
                }
            }
        }
    }
}

/// A vector as text.
fn three_of(v: DVec3) -> String {
    format!("{}/{}/{}", v.x, v.y, v.z)
}

/// A cylinder as text, without the seam.
fn seamless(Cylinder { through, axis, radius, side, .. }: &Cylinder) -> String {
    let side = if *side == Side::Inner { "inner" } else { "outer" };
    format!("cylinder:axis={},through={},radius={radius},side={side}", three_of(*axis), three_of(*through))
}

impl fmt::Display for Bound {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Plane(plane) => plane.fmt(f),
            Self::Cylinder(cylinder) => f.write_str(&seamless(cylinder)),
        }
    }
}

impl From<Bound> for String {
    fn from(bound: Bound) -> Self {
        bound.to_string()
    }
}

impl TryFrom<String> for Bound {
    type Error = ChartError;

    fn try_from(text: String) -> Result<Self, ChartError> {
        text.parse()
    }
}

impl fmt::Display for Plane {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "up={},through={}", three_of(self.up), three_of(self.origin))
    }
}

impl From<Plane> for String {
    fn from(plane: Plane) -> Self {
        plane.to_string()
    }
}

impl TryFrom<String> for Plane {
    type Error = ChartError;

    fn try_from(text: String) -> Result<Self, ChartError> {
        text.parse()
    }
}

impl From<Chart> for String {
    fn from(chart: Chart) -> Self {
        chart.to_string()
    }
}

impl TryFrom<String> for Chart {
    type Error = ChartError;

    fn try_from(text: String) -> Result<Self, ChartError> {
        text.parse()
    }
}

/// Keys and values as written.
struct Given<'a> {
    kind: &'static str,
    pairs: Vec<(&'a str, &'a str)>,
}

impl<'a> Given<'a> {
    fn new(kind: &'static str, known: &'static str, text: &'a str, keys: &[&str]) -> Result<Self, ChartError> {
        let pair = |pair: &'a str| {
            let (key, value) = pair.split_once('=').ok_or_else(|| ChartError::Pair(pair.to_owned()))?;
            let (key, value) = (key.trim(), value.trim());
            if keys.contains(&key) {
                Ok((key, value))
            } else {
                Err(ChartError::Key { kind, key: key.to_owned(), known })
            }
        };
        let pairs = text.split(',').filter(|pair| !pair.trim().is_empty()).map(pair).collect::<Result<_, _>>()?;
        Ok(Self { kind, pairs })
    }

    fn value(&self, key: &str) -> Option<&'a str> {
        self.pairs.iter().rfind(|(known, _)| *known == key).map(|(_, value)| *value)
    }

    fn needed(&self, key: &'static str, why: &'static str) -> Result<&'a str, ChartError> {
        self.value(key).ok_or(ChartError::Missing { kind: self.kind, key, why })
    }

    fn wrong(key: &str, value: &str, expected: &'static str) -> ChartError {
        ChartError::Value { key: key.to_owned(), value: value.to_owned(), expected }
    }

    /// A unit vector; along z if not given.
    fn direction(&self, key: &str) -> Result<DVec3, ChartError> {
        let Some(value) = self.value(key) else { return Ok(DVec3::Z) };
        let (sign, name) = value.strip_prefix('-').map_or((1.0, value), |name| (-1.0, name));
        let axis = match name {
            "x" => Some(DVec3::X),
            "y" => Some(DVec3::Y),
            "z" => Some(DVec3::Z),
            _ => None,
        };
        let axis = axis.map(|axis| axis * sign).or_else(|| point(value).and_then(unit));
        axis.ok_or_else(|| Self::wrong(key, value, "write x, y, z, -x, -y, -z, or three numbers such as 1/0/0.5"))
    }

    /// A point, mm; the origin if not given.
    fn place(&self, key: &str) -> Result<DVec3, ChartError> {
        let Some(value) = self.value(key) else { return Ok(DVec3::ZERO) };
        point(value).ok_or_else(|| Self::wrong(key, value, "write x/y/z in mm, such as 0/0/25"))
    }

    /// A list of points, mm.
    fn places(&self, key: &'static str) -> Result<Vec<DVec3>, ChartError> {
        let why = "where the curve begins, its corners, and where it ends, mm";
        let value = self.value(key).ok_or(ChartError::Missing { kind: self.kind, key, why })?;
        let places = value.split(BETWEEN).map(point).collect::<Option<_>>();
        places.ok_or_else(|| Self::wrong(key, value, "write points x/y/z in mm, such as 0/0/0:0/0/140:140/0/140"))
    }

    fn radius(&self) -> Result<f64, ChartError> {
        let why = "that of what the build begins on, mm";
        let value = self.value("radius").ok_or(ChartError::Missing { kind: self.kind, key: "radius", why })?;
        radius(value).ok_or_else(|| Self::wrong("radius", value, "write mm, 0.1 to 20000"))
    }

    /// The bend radii of a guide, mm.
    fn radii(&self) -> Result<Vec<f64>, ChartError> {
        let Some(value) = self.value("radius") else { return Ok(Vec::new()) };
        let radii = value.split(BETWEEN).map(radius).collect::<Option<_>>();
        radii.ok_or_else(|| Self::wrong("radius", value, "write mm, 0.1 to 20000, one for all bends or such as 120:90"))
    }

    fn side(&self) -> Result<Side, ChartError> {
        match self.value("side") {
            None | Some("outer") => Ok(Side::Outer),
            Some("inner") => Ok(Side::Inner),
            Some(other) => Err(Self::wrong("side", other, "write outer or inner")),
        }
    }

    /// An angle, °, within the range.
    fn angle(&self, key: &str, range: std::ops::RangeInclusive<f64>) -> Result<Option<f64>, ChartError> {
        let Some(value) = self.value(key) else { return Ok(None) };
        let degrees = value.parse().ok().filter(|degrees: &f64| range.contains(degrees));
        let expected = if key == "seam" { "write degrees, -360 to 360" } else { "write degrees, 1 to 89" };
        degrees.map(Some).ok_or_else(|| Self::wrong(key, value, expected))
    }
}

/// A radius, mm.
fn radius(text: &str) -> Option<f64> {
    text.trim().parse().ok().filter(|radius| (0.1..=20_000.0).contains(radius))
}

/// Normalises a vector; a unit vector is unchanged, so that written text reads back the same.
fn unit(vector: DVec3) -> Option<DVec3> {
    if vector.is_normalized() { Some(vector) } else { vector.try_normalize() }
}

/// Reads a point `x/y/z`.
pub fn point(text: &str) -> Option<DVec3> {
    let numbers: Vec<f64> = text.split('/').map(|number| number.trim().parse().ok()).collect::<Option<_>>()?;
    let vector = DVec3::from_array(numbers.try_into().ok()?);
    vector.is_finite().then_some(vector)
}
