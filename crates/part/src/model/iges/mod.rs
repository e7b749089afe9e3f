//! IGES, fixed format: the curves of a drawing, and a list of everything else in it.
//!
//! | file | what it does |
//! | --- | --- |
//! | `cards` | 80-column cards, sorted into the sections S, G, D, P and T |
//! | `free_format` | delimited parameters over many cards, Hollerith strings, numbers |
//! | `global` | global section: delimiters, unit, scale |
//! | `directory` | directory entries |
//! | `entities` | curves from their parameters (100, 106, 110, 112, 126) and matrices (124) |
//! | `conic` | conic arcs (104) |
//! | `chain` | parts of a composite in the order in which they meet |
//! | `drawing` | assembles the drawing: placement, composites (102), names, what was not read |
//! | `names` | what the entity numbers mean |
//! | `write` | writes curves as entity 126 |
//!
//! Source: U.S. Product Data Association, IGES 5.3 (1996). Arcs and conics become exact rational quadratics,
//! parametric splines exact piecewise cubics; nothing is approximated.

mod cards;
mod chain;
mod conic;
mod directory;
mod drawing;
mod entities;
mod free_format;
mod global;
mod names;
mod write;

pub use drawing::read;
pub use write::{WriteOptions, write};

use crate::curve::Nurbs;

/// What was read from an IGES file.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct IgesFile {
    /// All curves in the order of the directory, including members of composites (which are also in the parts of their
    /// composite).
    pub curves: Vec<IgesCurve>,
    /// Every kind of entity in the file, by its number.
    pub entities: Vec<EntityCount>,
    /// What was wrong and how it was handled, in sentences.
    pub warnings: Vec<String>,
    /// Millimetres per unit of the file, scale included; the curves are already in mm.
    pub unit_mm: f64,
    /// The program that wrote the file, as it calls itself.
    pub system: String,
}

/// One curve entity.
#[derive(Debug, Clone, PartialEq)]
pub struct IgesCurve {
    /// Number of the directory entry: the D card it begins on.
    pub entry: u32,
    /// Entity type number: 126, 110 …
    pub entity: u32,
    /// Form number, as the type defines it.
    pub form: i32,
    /// Name property (406, form 15) or else the entity label; may be empty.
    pub name: String,
    /// Level (layer) number; negative when it points to a list of levels.
    pub level: i32,
    /// The geometry, mm, in place: one curve, or the curves of a composite in the order in which they meet. Copious
    /// data of forms 1 to 3 are points in order and become the polyline through them.
    pub parts: Vec<Nurbs>,
    /// Whether another entity owns or refers to this one.
    pub dependence: Dependence,
    /// Whether the entity is shown (not blanked).
    pub is_visible: bool,
    /// Whether the curve lies in the parameter plane of a surface; its coordinates are then not lengths and keep the
    /// numbers of the file.
    pub is_parametric: bool,
}

/// The subordinate switch of an entity.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Dependence {
    /// Independent of other entities.
    Independent,
    /// Part of another entity, which places it.
    Physical,
    /// Member of another entity, but also independent.
    Logical,
    /// Both.
    Both,
}

/// How many entities of a kind there are.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct EntityCount {
    /// Entity type number.
    pub entity: u32,
    /// What it is, in words.
    pub name: &'static str,
    /// Those that were read and used.
    pub read: usize,
    /// Those that were skipped.
    pub unread: usize,
}

impl IgesFile {
    /// The independent curves: shown, in space, and not part of another entity.
    pub fn independent_curves(&self) -> impl Iterator<Item = &IgesCurve> {
        let stands = |d| matches!(d, Dependence::Independent | Dependence::Logical);
        self.curves.iter().filter(move |c| c.is_visible && !c.is_parametric && stands(c.dependence))
    }
}

/// Why an IGES file was refused.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum IgesError {
    /// The file is empty.
    #[error("the file is empty (0 bytes). Export the drawing again.")]
    Empty,
    /// Not an IGES file.
    #[error("this is not an IGES file: {reason}. Save the drawing as IGES (fixed format, ASCII) and try again.")]
    NotIges {
        /// The reason, with the line.
        reason: String,
    },
    /// IGES, but not in 80-column cards.
    #[error("this is an IGES file in {form} form, which is not read. Save it as IGES in fixed (ASCII) format.")]
    OtherForm {
        /// `binary` or `compressed`.
        form: &'static str,
    },
    /// The file ends too early.
    #[error("the IGES file is cut short: {reason}. Copy or export it again.")]
    Truncated {
        /// Where it ends, in words.
        reason: String,
    },
    /// A card that cannot be read.
    #[error("line {line} of the IGES file cannot be read: {reason}. Export the drawing again.")]
    Card {
        /// Line number, from 1.
        line: usize,
        /// What was expected and what was found.
        reason: String,
    },
    /// The global section cannot be read.
    #[error("the global section of the IGES file (from line {line}) cannot be read: {reason}. Export it again.")]
    Global {
        /// Its first line.
        line: usize,
        /// What was expected and what was found.
        reason: String,
    },
    /// An unknown unit.
    #[error(
        "the IGES file has the unit flag {flag} and the unit name \"{name}\", which is not a known unit. Export it in mm."
    )]
    Unit {
        /// Global parameter 14.
        flag: i64,
        /// Global parameter 15.
        name: String,
    },
}
