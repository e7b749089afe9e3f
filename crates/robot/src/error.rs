//! What is wrong with a cell.

use crate::urdf::UrdfError;

/// Why a cell was refused.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CellError {
    /// No built-in cell has that name.
    #[error("there is no built-in cell \"{name}\". {hint}")]
    UnknownName {
        /// What was asked for.
        name: String,
        /// The nearest name, or all of them.
        hint: String,
    },
    /// The text is not TOML, a key is unknown or missing, or a value has the wrong type.
    #[error("line {line} of the cell: {reason}")]
    Text {
        /// Line number, from 1.
        line: usize,
        /// What is wrong and what would be right.
        reason: String,
    },
    /// An impossible value.
    #[error("line {line} of the cell: {key} = {value} is impossible: {reason}")]
    Value {
        /// Line number, from 1.
        line: usize,
        /// Full key, such as `arm.c2`.
        key: &'static str,
        /// The value.
        value: String,
        /// The range and the unit.
        reason: String,
    },
    /// The URDF file of the arm cannot be read.
    #[error("the file {file} of arm.urdf: {reason}")]
    File {
        /// Its name in the cell.
        file: String,
        /// Why.
        reason: String,
    },
    /// The URDF file of the arm cannot be used.
    #[error("the arm of the URDF file: {0}")]
    Urdf(#[from] UrdfError),
}
