//! Scans: points on the surface of a build, in mm.
//!
//! | file | what it reads |
//! | --- | --- |
//! | `table` | lines of x, y, z: CSV with or without a header, XYZ, a few touched points |
//! | `height_map` | a grid of heights |
//!
//! The vertices of PLY files are read by `model::ply`.

mod height_map;
mod table;

use crate::model::{self, ImportError};
use crate::task::{Cancelled, Task};
use crate::text::{self, TextError};
use glam::DVec3;

/// Points on a surface.
#[derive(Debug, Clone, PartialEq)]
pub struct Scan {
    /// The points, mm.
    pub points: Vec<DVec3>,
    /// The format, for people: `PLY`.
    pub format: &'static str,
    /// Points that the file has without a height.
    pub without_height: usize,
}

/// Why a scan cannot be read.
#[derive(Debug, thiserror::Error)]
pub enum ScanError {
    /// The text cannot be decoded.
    #[error(transparent)]
    Text(#[from] TextError),
    /// A PLY file that cannot be read.
    #[error(transparent)]
    Ply(#[from] ImportError),
    /// A line that cannot be read.
    #[error("line {line} of the scan cannot be read: {reason}.")]
    Line {
        /// Number of the line, from 1.
        line: usize,
        /// What was expected, and what stands there.
        reason: String,
    },
    /// No points.
    #[error(
        "the scan holds no points. A scan is a PLY file, lines of x, y and z in mm, or a height map that begins with a line \
         such as height_map x0=0 y0=0 step=0.5."
    )]
    Empty,
    /// A coordinate out of all bounds.
    #[error("the scan has a point at {:.0}, {:.0}, {:.0} mm, farther than {reach:.0} m from the origin. Check its unit: mm is expected.", at.x, at.y, at.z, reach = model::MAX_REACH_MM / 1e3)]
    TooFar {
        /// The point, mm.
        at: DVec3,
    },
}

impl From<Cancelled> for ScanError {
    fn from(cancelled: Cancelled) -> Self {
        Self::Ply(cancelled.into())
    }
}

/// Reads a scan; its content tells the format.
///
/// # Errors
/// [`ScanError`] with the line where one is at fault.
pub fn read(bytes: &[u8], task: &Task) -> Result<Scan, ScanError> {
    let (points, format) = if bytes.starts_with(b"ply") {
        (model::ply_points(bytes, task)?, "PLY")
    } else {
        let text = text::of(bytes)?;
        match height_map::read(&text)? {
            Some(points) => (points, "height map"),
            None => (table::read(&text)?, "table of points"),
        }
    };
    let read = points.len();
    let points: Vec<DVec3> = points.into_iter().filter(|p| p.is_finite()).collect();
    if points.is_empty() {
        return Err(ScanError::Empty);
    }
    if let Some(&at) = points.iter().find(|p| p.abs().max_element() > model::MAX_REACH_MM) {
        return Err(ScanError::TooFar { at });
    }
    let without_height = read - points.len();
    Ok(Scan { points, format, without_height })
}

/// Lines with their numbers, from 1, less comments and empty ones.
fn lines(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let numbered = (1..).zip(text.lines().map(str::trim));
    numbered.filter(|(_, line)| !line.is_empty() && !line.starts_with('#') && !line.starts_with("//"))
}

/// A number, or what scanners write where they saw nothing.
fn number(field: &str) -> Option<f64> {
    match field.trim() {
        "" | "-" => Some(f64::NAN),
        text => text.parse().ok(),
    }
}
