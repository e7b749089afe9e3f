//! Errors of the library become `beadwright.BeadwrightError`, with the place and, where Python has one, the remedy.

use beadwright::bead::library::LibraryError;
use beadwright::dialect::own::OwnError;
use beadwright::finding::{Words, lacks_metal_below};
use beadwright::model::{ImportError, PartError};
use beadwright::profile::{Profile, ProfileError};
use beadwright::read_back::ReadBackError;
use pyo3::prelude::*;
use std::error::Error;

/// Turns the error of a result into a Python exception.
pub(crate) trait Refuse<T> {
    /// The value, or the exception; `place` is what the user gave, such as a path.
    fn refuse(self, place: Option<&str>) -> PyResult<T>;
}

impl<T, E: Error + 'static> Refuse<T> for Result<T, E> {
    fn refuse(self, place: Option<&str>) -> PyResult<T> {
        self.map_err(|error| exception(&error, place))
    }
}

/// The exception for an error of the library.
pub(crate) fn exception(error: &(dyn Error + 'static), place: Option<&str>) -> PyErr {
    let places: Vec<String> = place.map(str::to_owned).into_iter().chain(place_in(error)).collect();
    let message = place.map_or_else(|| error.to_string(), |place| format!("{place}: {error}"));
    let place = (!places.is_empty()).then(|| places.join(", "));
    raise(&message, place.as_deref(), remedy(error))
}

/// A `BeadwrightError` with these words.
pub(crate) fn raise(message: &str, place: Option<&str>, remedy: Option<&str>) -> PyErr {
    let made = |py: Python<'_>| {
        let class = py.import("beadwright._errors")?.getattr("BeadwrightError")?;
        Ok(PyErr::from_value(class.call1((message, place, remedy))?))
    };
    Python::attach(made).unwrap_or_else(|error: PyErr| error)
}

/// Where in the file or text it went wrong.
fn place_in(error: &(dyn Error + 'static)) -> Option<String> {
    if let Some(error) = error.downcast_ref() {
        return match error {
            ProfileError::Text { line, .. } => Some(format!("line {line}")),
            ProfileError::Value { key, .. } | ProfileError::Key { key } => Some(key.clone()),
            _ => None,
        };
    }
    if let Some(OwnError { file, line, .. }) = error.downcast_ref() {
        return Some(line.map_or_else(|| file.clone(), |line| format!("{file}, line {line}")));
    }
    match error.downcast_ref()? {
        PartError::Import(ImportError::Line { line, .. }) => Some(format!("line {line}")),
        PartError::Import(ImportError::NotFinite { triangle, .. }) => Some(format!("triangle {triangle}")),
        _ => None,
    }
}

/// What the package offers against a kind of finding.
pub(crate) fn words(profile: &Profile) -> Words {
    profile.layers.by_lie(of_level, of_charted, of_bodies)
}

/// The part is already divided into bodies: only dividing it elsewhere helps.
fn of_bodies(kind: &str) -> Option<&'static str> {
    if lacks_metal_below(kind) {
        Some("Other planes in layers.bodies divide the part elsewhere.")
    } else {
        of_level(kind)
    }
}

/// Layers that are not level begin where their chart does.
fn of_charted(kind: &str) -> Option<&'static str> {
    if lacks_metal_below(kind) {
        Some("layers.bodies divides the part into bodies that each have metal below.")
    } else {
        of_level(kind)
    }
}

fn of_level(kind: &str) -> Option<&'static str> {
    Some(match kind {
        "high-start" | "nothing-below" => "Part.above(z) begins higher up, stand=\"flat\" turns the part.",
        "in-the-air" => "stand=\"orient\" and \"flat\" turn the part, Part.above(z) begins higher up.",
        "over-unwelded" => "Part.read(scale=…) enlarges the part, stand=\"orient\" and \"flat\" turn it.",
        "hanging-island" | "overhang" => "stand=\"orient\" turns the part.",
        "bare" | "void" => "compare() shows what other strategies leave.",
        "reach" => "suggest=True looks for a better place.",
        _ => return None,
    })
}

/// Which argument helps; the library knows no arguments.
fn remedy(error: &(dyn Error + 'static)) -> Option<&'static str> {
    if let Some(LibraryError::Inputs { .. } | LibraryError::TooFew { .. }) = error.downcast_ref() {
        return Some("inputs=[…] names those that are fitted.");
    }
    if let Some(ReadBackError::Printer) = error.downcast_ref() {
        return Some("profile=… names it.");
    }
    Some(match error.downcast_ref()? {
        PartError::Units(_) => "units=\"in\", \"cm\", \"m\" or \"mm\" sets it; scale=… enlarges the part.",
        PartError::NoHeight => "height=… sets it, in mm.",
        PartError::HeightOfSolid => "Leave height out.",
        PartError::Import(ImportError::TooFar { .. }) => "units=… sets the unit.",
        PartError::Import(ImportError::Damaged { .. }) => "accept_damaged=True uses what there is of it.",
        _ => return None,
    })
}
