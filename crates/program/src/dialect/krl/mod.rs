//! KUKA KRL.

mod arctech;
mod arctech_section;
mod motion;
mod read;
mod review;
mod section;
mod words;
mod write;

pub use arctech_section::{ArcTech, ArcTechCrater, ArcTechStrike, ArcTechWeld, KrlArc};
pub use section::{Krl, KrlMotion};

use super::Dialect;

/// The row in the table of dialects.
pub const DIALECT: Dialect = Dialect {
    name: "krl",
    language: "KRL",
    module_extensions: &["src", "sub"],
    linear_axis: true,
    table: true,
    positioner: true,
    typical: read::typical,
    read: read::read,
};
