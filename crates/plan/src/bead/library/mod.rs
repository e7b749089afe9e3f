//! The bead library: width and height of single beads as second-order polynomials of the process parameters.
//!
//! [`Measured`] beads from a CSV are fitted once ([`BeadLibrary::fit`]); the library is kept as TOML. It
//! [predicts](BeadLibrary::predict) a bead, and [solves](BeadLibrary::solve) for the parameters of a wanted one. It
//! answers only where beads were measured: inside the range of every input, and at no larger leverage than that of
//! the measurements themselves.
//!
//! | file | what it holds |
//! | --- | --- |
//! | `measured` | CSV to measured beads |
//! | `fit` | which terms the measurements allow, the fit and how good it is |
//! | `solve` | parameters for a wanted bead |
//! | `next` | which trial to weld next |
//! | `demonstration` | invented measurements to try it with |
//! | `least_squares`, `student` | Householder QR; Student's t |

mod demonstration;
mod error;
mod fit;
mod least_squares;
mod measured;
mod next;
mod printed;
mod solve;
mod student;

pub use demonstration::demonstration_csv;
pub use error::LibraryError;
pub(crate) use fit::{Surface, code};
pub(crate) use least_squares::Factored;
pub(crate) use measured::fields;
pub use measured::{Columns, Measured};
pub(crate) use next::{along, grid};
pub use printed::{PrintedRow, median, printed_rows};
pub use solve::{Layering, Limit, PREFERRED_RATIOS, Recipe, Wish};
pub use student::t_95;

use super::Bead;
use serde::{Deserialize, Serialize};

/// A process parameter and the range in which it was measured.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Input {
    /// Name without unit, such as `current`.
    pub name: String,
    /// Unit; empty where the header names none.
    pub unit: String,
    /// Least measured value.
    pub min: f64,
    /// Greatest measured value.
    pub max: f64,
}

/// The fit of width or height, and how good it is.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Response {
    /// Coefficients of the library's terms, mm.
    pub coefficients: Vec<f64>,
    /// Fraction of the variance that the fit explains, 0 to 1.
    pub r_squared: f64,
    /// The same, adjusted for the number of terms: less what this many terms would explain by chance.
    pub adjusted_r_squared: f64,
    /// Standard deviation of the residuals, mm.
    pub residual: f64,
    /// Root mean square error of every bead when predicted from all others, mm; absent if a single bead determines a
    /// term.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub leave_one_out: Option<f64>,
}

/// A measured bead as the library keeps it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Sample {
    /// The inputs in the library's order.
    pub inputs: Vec<f64>,
    /// Width, mm.
    pub width: f64,
    /// Height, mm.
    pub height: f64,
}

/// Width and height of beads over the process parameters.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BeadLibrary {
    /// Version of the file format.
    pub version: u32,
    /// Whether the measurements are invented; one of their remarks says so.
    pub synthetic: bool,
    /// Comment lines of the measurements.
    pub remarks: Vec<String>,
    /// What the fit had to leave out, as sentences.
    pub notes: Vec<String>,
    /// Terms of the polynomial as indices of inputs: `[]` is the constant, `[0]` the first input, `[0, 0]` its square.
    /// Inputs are coded: −1 at the least measured value, 1 at the greatest.
    pub terms: Vec<Vec<usize>>,
    /// The upper triangle R of the QR factorisation of the measurements' terms, by columns; the leverage is computed
    /// from it.
    pub triangle: Vec<Vec<f64>>,
    /// Largest leverage among the measurements.
    pub largest_leverage: f64,
    /// The inputs.
    pub inputs: Vec<Input>,
    /// Fit of the width.
    pub width: Response,
    /// Fit of the height.
    pub height: Response,
    /// The measured beads.
    pub measured: Vec<Sample>,
}

/// A predicted value.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Estimate {
    /// The value, mm.
    pub value: f64,
    /// Half width of the 95 % interval in which the next single bead is expected, mm.
    pub plus_minus: f64,
}

/// A predicted bead.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Prediction {
    /// Width, mm.
    pub width: Estimate,
    /// Height, mm.
    pub height: Estimate,
    /// Leverage of the point: near 0 it is well supported; at the library's largest leverage it lies at the edge of the
    /// measurements.
    pub leverage: f64,
}

impl Prediction {
    /// λ, width over height.
    pub fn ratio(&self) -> f64 {
        self.width.value / self.height.value
    }

    /// The bead.
    pub fn bead(&self) -> Bead {
        Bead::parabola(self.width.value, self.height.value)
    }
}

impl BeadLibrary {
    /// Version of the file format that is read and written.
    pub const VERSION: u32 = 1;

    /// The library as TOML; [`parse`](Self::parse) restores it exactly.
    pub fn to_toml(&self) -> String {
        let warning = if self.synthetic { "# SYNTHETIC data for demonstration: no bead was measured.\n" } else { "" };
        let head = "# Bead library of Beadwright, made by `beadwright bead fit`. Lengths of beads in mm.\n";
        format!("{warning}{head}{}", toml::to_string(self).unwrap_or_default())
    }

    /// Reads a library.
    ///
    /// ```
    /// use bead_plan::bead::library::{BeadLibrary, Columns, Measured, demonstration_csv};
    ///
    /// let library = BeadLibrary::fit(&Measured::read(&demonstration_csv(), &Columns::default())?)?;
    /// assert_eq!(BeadLibrary::parse(&library.to_toml())?, library);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`LibraryError::File`] where the text is not a library or its values are inconsistent.
    pub fn parse(text: &str) -> Result<Self, LibraryError> {
        let refuse = |reason: String| LibraryError::File { reason };
        let library: Self = toml::from_str(text).map_err(|e| {
            let line = e.span().map_or(1, |s| text[..s.start.min(text.len())].matches('\n').count() + 1);
            refuse(format!("line {line}: {}.", e.message()))
        })?;
        match library.contradiction() {
            None => Ok(library),
            Some(reason) => Err(refuse(reason.to_owned())),
        }
    }

    /// What is inconsistent in a library that was read; `None` if nothing is.
    fn contradiction(&self) -> Option<&'static str> {
        let (n, p) = (self.inputs.len(), self.terms.len());
        let finite = |values: &[f64]| values.iter().all(|v| v.is_finite());
        let range = |i: &Input| finite(&[i.min, i.max]) && i.min < i.max;
        let term = |t: &Vec<usize>| t.len() <= 2 && t.iter().all(|&i| i < n);
        let column = |(j, c): (usize, &Vec<f64>)| c.len() == j + 1 && finite(c) && c[j] != 0.0;
        let response = |r: &Response| r.coefficients.len() == p && finite(&r.coefficients) && finite(&[r.residual]);
        let sample = |s: &Sample| s.inputs.len() == n && finite(&s.inputs) && finite(&[s.width, s.height]);
        let checks = [
            (self.version == Self::VERSION, "its version is not 1. Fit the measurements again."),
            (n > 0 && self.inputs.iter().all(range), "an input has no range with min below max."),
            (p > 0 && self.terms.iter().all(term), "a term names an input that does not exist."),
            (
                self.triangle.len() == p && self.triangle.iter().enumerate().all(column),
                "the triangle does not fit the terms.",
            ),
            (response(&self.width) && response(&self.height), "the coefficients do not fit the terms."),
            (self.measured.len() > p && self.measured.iter().all(sample), "the measured beads do not fit the terms."),
            (self.largest_leverage.is_finite(), "the largest leverage is not a number."),
        ];
        checks.into_iter().find(|(fine, _)| !fine).map(|(_, reason)| reason)
    }

    /// The bead at `values`, one per input in the library's order and in its units.
    ///
    /// ```
    /// use bead_plan::bead::library::{BeadLibrary, Columns, Measured, demonstration_csv};
    ///
    /// // Invented beads, measured from 60 to 250 A and from 4 to 12 mm/s.
    /// let library = BeadLibrary::fit(&Measured::read(&demonstration_csv(), &Columns::default())?)?;
    /// let bead = library.predict(&[125.0, 8.0])?;
    /// assert!((2.5..3.0).contains(&bead.ratio()));
    /// assert!(library.predict(&[300.0, 8.0]).is_err(), "no bead was measured there");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// When the values lie outside the measured range, or the fit predicts an impossible bead.
    pub fn predict(&self, values: &[f64]) -> Result<Prediction, LibraryError> {
        self.check_count(values)?;
        for (input, &value) in self.inputs.iter().zip(values) {
            input.check(value)?;
        }
        let coded = self.coded(values);
        let found = self.at(&coded);
        // Rounding must not exclude the measurements themselves.
        if found.leverage > self.largest_leverage * (1.0 + 1e-9) {
            let distance =
                |s: &Sample| self.coded(&s.inputs).iter().zip(&coded).map(|(a, b)| (a - b).powi(2)).sum::<f64>();
            let nearest = self.measured.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)));
            return Err(LibraryError::Unlike {
                point: self.describe(values),
                leverage: found.leverage,
                limit: self.largest_leverage,
                nearest: nearest.map(|s| self.describe(&s.inputs)).unwrap_or_default(),
            });
        }
        let (width, height) = (found.width.value, found.height.value);
        if !(width > 0.0 && height > 0.0) {
            return Err(LibraryError::NoBead { point: self.describe(values), width, height });
        }
        Ok(found)
    }

    /// Values in the library's order, from names (with or without unit) and values.
    ///
    /// # Errors
    /// When an input is missing, or a name belongs to no input.
    pub fn arrange(&self, named: &[(String, f64)]) -> Result<Vec<f64>, LibraryError> {
        for (name, _) in named {
            self.input_number(name)?;
        }
        let find = |input: &Input| {
            let found = named.iter().find(|(name, _)| measured::is_named(input, name));
            found.map(|(_, value)| *value).ok_or_else(|| LibraryError::Missing {
                missing: input.name.clone(),
                unit: if input.unit.is_empty() {
                    "the unit of the measurements".to_owned()
                } else {
                    input.unit.clone()
                },
            })
        };
        self.inputs.iter().map(find).collect()
    }

    /// Index of the input with this name, with or without its unit.
    ///
    /// # Errors
    /// [`LibraryError::Unknown`].
    pub fn input_number(&self, name: &str) -> Result<usize, LibraryError> {
        let known = || self.inputs.iter().map(|i| i.name.as_str()).collect::<Vec<_>>().join(", ");
        let found = self.inputs.iter().position(|i| measured::is_named(i, name));
        found.ok_or_else(|| LibraryError::Unknown { what: "input", name: name.to_owned(), known: known() })
    }

    /// Values with names and units, as in `current = 120 A, deposition_speed = 8 mm/s`.
    pub fn describe(&self, values: &[f64]) -> String {
        let one = |(i, v): (&Input, &f64)| format!("{} = {} {}", i.name, rounded(*v), i.unit).trim_end().to_owned();
        self.inputs.iter().zip(values).map(one).collect::<Vec<_>>().join(", ")
    }

    fn check_count(&self, values: &[f64]) -> Result<(), LibraryError> {
        match self.inputs.get(values.len()) {
            None if values.len() == self.inputs.len() => Ok(()),
            Some(input) => Err(LibraryError::Missing { missing: input.name.clone(), unit: input.unit.clone() }),
            None => Err(LibraryError::Wish {
                reason: format!("the library has {} inputs, not {}.", self.inputs.len(), values.len()),
            }),
        }
    }

    /// Coded values: −1 at the least measured value of an input, 1 at the greatest.
    fn coded(&self, values: &[f64]) -> Vec<f64> {
        code(&self.inputs, values)
    }

    fn row(&self, coded: &[f64]) -> Vec<f64> {
        self.terms.iter().map(|term| term.iter().map(|&i| coded[i]).product()).collect()
    }

    /// The value of the polynomials at a coded point, even outside the measured range.
    fn at(&self, coded: &[f64]) -> Prediction {
        let row = self.row(coded);
        let leverage = least_squares::leverage(&self.triangle, &row);
        let spread = student::t_95(self.measured.len() - self.terms.len()) * (1.0 + leverage).sqrt();
        let estimate = |r: &Response| Estimate {
            value: least_squares::dot(&r.coefficients, &row),
            plus_minus: spread * r.residual,
        };
        Prediction { width: estimate(&self.width), height: estimate(&self.height), leverage }
    }
}

impl Input {
    fn coded(&self, value: f64) -> f64 {
        (value - 0.5 * (self.min + self.max)) / (0.5 * (self.max - self.min))
    }

    pub(crate) fn value(&self, coded: f64) -> f64 {
        (0.5 * (self.min + self.max) + coded * 0.5 * (self.max - self.min)).clamp(self.min, self.max)
    }

    pub(crate) fn check(&self, value: f64) -> Result<(), LibraryError> {
        if (self.min..=self.max).contains(&value) {
            return Ok(());
        }
        let (name, unit) = (self.name.clone(), self.unit.clone());
        let side = if value < self.min {
            "below"
        } else if value > self.max {
            "above"
        } else {
            "outside"
        };
        Err(LibraryError::Outside { name, value, unit, side, min: self.min, max: self.max })
    }
}

/// Five significant digits, without trailing zeros.
fn rounded(value: f64) -> f64 {
    format!("{value:.4e}").parse().unwrap_or(value)
}
