//! Scans: points on the surface of a build, in mm.
//!
//! | file | what it reads |
//! | --- | --- |
//! | `table` | lines of x, y, z: CSV with or without a header, XYZ, a few touched points |
//! | `height_map` | a grid of heights |
//!
//! Surfaces (PLY, STL, OBJ, 3MF, AMF) are read by `model`; they need not be closed.

mod height_map;
mod table;

use crate::model::{self, ImportError, Units};
use crate::task::{Cancelled, Task};
use crate::text::{self, TextError};
use glam::DVec3;

/// Points on a surface.
#[derive(Debug, Clone, PartialEq)]
pub struct Scan {
    /// The points, mm.
    pub points: Vec<DVec3>,
    /// Triangles between them, by index; empty for a cloud of points.
    pub triangles: Vec<[u32; 3]>,
    /// The format, for people: `PLY`.
    pub format: &'static str,
    /// Number of points in the file that have no height.
    pub without_height: usize,
}

/// Why a scan cannot be read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ScanError {
    /// The text cannot be decoded.
    #[error(transparent)]
    Text(#[from] TextError),
    /// A surface that cannot be read.
    #[error(transparent)]
    Surface(#[from] ImportError),
    /// A line that cannot be read.
    #[error("line {line} of the scan cannot be read: {reason}.")]
    Line {
        /// Number of the line, from 1.
        line: usize,
        /// What was expected, and what is there.
        reason: String,
    },
    /// No points.
    #[error(
        "the scan holds no points. A scan is a surface or cloud (PLY, STL, OBJ, 3MF), lines of x, y and z in mm, or a height map \
         that begins with a line such as height_map x0=0 y0=0 step=0.5."
    )]
    Empty,
    /// A coordinate out of bounds.
    #[error("the scan has a point at {:.0}, {:.0}, {:.0} mm, more than {reach:.0} m from the origin. Check its unit: mm is \
             expected.", at.x, at.y, at.z, reach = model::MAX_REACH_MM / 1e3)]
    TooFar {
        /// The point, mm.
        at: DVec3,
    },
}

impl From<Cancelled> for ScanError {
    fn from(cancelled: Cancelled) -> Self {
        Self::Surface(cancelled.into())
    }
}

/// Reads a scan; its content shows the format.
///
/// # Errors
/// [`ScanError`], which names the line where one is at fault.
pub fn read(bytes: &[u8], task: &Task) -> Result<Scan, ScanError> {
    let (points, triangles, format) = if bytes.starts_with(b"ply") {
        let (points, triangles) = model::ply_points(bytes, task)?;
        (points, triangles, "PLY")
    } else if model::is_solid(bytes) || model::is_stl(bytes) {
        surface(bytes, task)?
    } else {
        let text = text::of(bytes)?;
        match height_map::read(&text)? {
            Some(points) => (points, Vec::new(), "height map"),
            None => (table::read(&text)?, Vec::new(), "table of points"),
        }
    };
    let without_height = points.iter().filter(|point| !point.is_finite()).count();
    let (points, triangles) = seen(points, &triangles);
    if points.is_empty() {
        return Err(ScanError::Empty);
    }
    if let Some(&at) = points.iter().find(|p| p.abs().max_element() > model::MAX_REACH_MM) {
        return Err(ScanError::TooFar { at });
    }
    Ok(Scan { points, triangles, format, without_height })
}

/// The surface in a file of solids; in a scan it need not be closed.
fn surface(bytes: &[u8], task: &Task) -> Result<Surface, ImportError> {
    let import = model::import_damaged(bytes, task)?;
    let millimetres = import.units.unwrap_or(Units::Millimetre).in_mm();
    let points = import.mesh.vertices.into_iter().map(|point| point * millimetres).collect();
    Ok((points, import.mesh.triangles, import.format))
}

/// The points that have a height, and the triangles between them.
fn seen(points: Vec<DVec3>, triangles: &[[u32; 3]]) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    if points.iter().all(|point| point.is_finite()) {
        return (points, triangles.to_vec());
    }
    let mut count = 0;
    let number = |point: &DVec3| {
        count += u32::from(point.is_finite());
        point.is_finite().then(|| count - 1)
    };
    let numbers: Vec<Option<u32>> = points.iter().map(number).collect();
    let renumbered = |&[a, b, c]: &[u32; 3]| {
        let [a, b, c] = [a, b, c].map(|corner| numbers.get(corner as usize).copied().flatten());
        Some([a?, b?, c?])
    };
    let triangles = triangles.iter().filter_map(renumbered).collect();
    (points.into_iter().filter(|point| point.is_finite()).collect(), triangles)
}

/// Points, triangles between them, and the format.
type Surface = (Vec<DVec3>, Vec<[u32; 3]>, &'static str);

/// Lines with their numbers, from 1, without comments and blank lines.
fn lines(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let numbered = (1..).zip(text.lines().map(str::trim));
    numbered.filter(|(_, line)| !line.is_empty() && !line.starts_with('#') && !line.starts_with("//"))
}

/// A number, or what scanners write where they saw nothing (NaN).
fn number(field: &str) -> Option<f64> {
    match field.trim() {
        "" | "-" => Some(f64::NAN),
        text => text.parse().ok(),
    }
}
