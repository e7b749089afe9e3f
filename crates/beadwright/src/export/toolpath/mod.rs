//! The 3MF Toolpath extension, version 1.0 (namespace of 2026/03, with the production extension that it requires): a plan
//! is written for other programs, and read back as a plan. From other programs' files, the deposition toolpaths are read.
//!
//! | file | what it does |
//! | --- | --- |
//! | `style` | the profiles of the extension: kinds, waits, and the ranges within which width, speed, pace and feed change |
//! | `layer` | one layer of a plan as a file of its own |
//! | `write` | the model file and the package around it |
//! | `read` | a package becomes a plan again |
//! | `read_layer` | its layers |
//!
//! Coordinates are whole multiples of 0.1 µm, as in plan.json. What the extension cannot express is in a namespace of
//! our own, which other readers skip: the kind of a pass, pace and wire feed, outlines, and the whole profile.

mod layer;
mod read;
mod read_layer;
mod style;
mod write;

pub use read::{is_toolpath, read};

use super::Format;

pub(super) const FORMAT: Format = Format {
    extension: "3mf",
    purpose: "toolpaths with widths, speeds and waits, by the 3MF Toolpath extension",
    write: write::write,
};

/// Our own namespace.
const OWN: &str = "https://github.com/beadwright/beadwright/3mf/2026/11";

/// Length of one coordinate unit, mm.
const UNIT_MM: f64 = 1e-4;

/// The tag of points that are only there because a closed pass overlaps its own beginning.
const OVERLAP: u32 = 1;

/// The tag of points between those of the plan, where hot start or lead-out changes the speed.
const BETWEEN: u32 = 2;

/// A length in coordinate units.
fn units(mm: f64) -> i64 {
    (mm / UNIT_MM).round() as i64
}
