//! Fits a response surface to measured beads: full second order where the measurements allow it, fewer terms elsewhere.

use super::least_squares::{self, Factored, dot};
use super::{BeadLibrary, Estimate, Input, LibraryError, Measured, Response, Sample, t_95};

/// Largest number of inputs; the full second order of six has 28 terms.
const MOST_INPUTS: usize = 6;
/// Inputs whose values are names, and what they name.
const UNORDERED: [(&str, &str); 2] = [("job", "jobs of the power source"), ("weave_file", "weaving files")];
/// Fraction of a column's range within which two values count as one level.
const SAME_LEVEL: f64 = 1e-9;

/// A polynomial over the inputs of measurements, of the terms that they allow, for any values that were measured with them.
#[derive(Debug, Clone)]
pub(crate) struct Surface {
    /// The measurements without inputs that do not vary.
    pub(crate) measured: Measured,
    /// Terms as indices of inputs.
    pub(super) terms: Vec<Vec<usize>>,
    /// What had to be left out, as sentences.
    pub(crate) notes: Vec<String>,
    factored: Factored,
    /// The terms of each measurement, and its leverage.
    rows: Vec<Vec<f64>>,
    leverages: Vec<f64>,
}

impl Surface {
    /// # Errors
    /// Too few measurements; inputs that do not vary, or that depend on each other.
    pub(crate) fn over(measured: &Measured) -> Result<Self, LibraryError> {
        let (measured, mut notes) = varying(measured)?;
        if measured.unmeasured > 0 {
            notes.insert(0, format!("{} without measurements left out.", counted(measured.unmeasured)));
        }
        let inputs = &measured.inputs;
        let coded: Vec<Vec<f64>> = measured.rows.iter().map(|row| code(inputs, row)).collect();
        let wanted = terms(&measured, &mut notes)?;
        let column = |term: &Vec<usize>| coded.iter().map(|r| term.iter().map(|&i| r[i]).product()).collect();
        let factored = Factored::new(&wanted.iter().map(column).collect::<Vec<Vec<f64>>>());
        let terms = kept(inputs, &wanted, &factored, &mut notes)?;
        let rows: Vec<Vec<f64>> = coded.iter().map(|row| of_terms(&terms, row)).collect();
        let leverages: Vec<f64> = rows.iter().map(|r| least_squares::leverage(&factored.triangle, r)).collect();
        Ok(Self { terms, notes, factored, rows, leverages, measured })
    }

    /// The fit of values that were measured, one for each measurement.
    pub(crate) fn response(&self, values: &[f64]) -> Response {
        response(&self.factored, &self.rows, &self.leverages, values)
    }

    fn largest_leverage(&self) -> f64 {
        self.leverages.iter().copied().fold(0.0, f64::max)
    }

    /// A fitted value at a point (−1 to 1 for each input), with the interval in which the next single measurement is expected;
    /// `None` if the point is unlike all measurements.
    pub(crate) fn at(&self, response: &Response, coded: &[f64]) -> Option<Estimate> {
        let (row, leverage) = self.within(coded)?;
        let spread = t_95(self.rows.len() - self.terms.len()) * (1.0 + leverage).sqrt();
        Some(Estimate { value: dot(&response.coefficients, &row), plus_minus: spread * response.residual })
    }

    /// A fitted value at a point (−1 to 1 for each input); `None` if the point is unlike all measurements.
    pub(crate) fn value(&self, response: &Response, coded: &[f64]) -> Option<f64> {
        Some(dot(&response.coefficients, &self.within(coded)?.0))
    }

    /// The terms at a point and its leverage, if the point is like the measurements.
    fn within(&self, coded: &[f64]) -> Option<(Vec<f64>, f64)> {
        let row = of_terms(&self.terms, coded);
        let leverage = least_squares::leverage(&self.factored.triangle, &row);
        // Rounding must not exclude the measurements themselves.
        (leverage <= self.largest_leverage() * (1.0 + 1e-9)).then_some((row, leverage))
    }
}

/// Values coded: −1 at the least measured value of an input, 1 at the greatest.
pub(crate) fn code(inputs: &[Input], values: &[f64]) -> Vec<f64> {
    inputs.iter().zip(values).map(|(input, value)| input.coded(*value)).collect()
}

fn of_terms(terms: &[Vec<usize>], coded: &[f64]) -> Vec<f64> {
    terms.iter().map(|term| term.iter().map(|&i| coded[i]).product()).collect()
}

impl BeadLibrary {
    /// Fits width and height.
    ///
    /// # Errors
    /// Too few beads; inputs that do not vary, or that depend on each other.
    pub fn fit(measured: &Measured) -> Result<Self, LibraryError> {
        let surface = Surface::over(measured)?;
        let [width, height] = [&measured.widths, &measured.heights].map(|values| surface.response(values));
        let largest_leverage = surface.largest_leverage();
        let Surface { measured, terms, notes, factored, .. } = surface;
        let sample = |((r, w), h): ((&Vec<f64>, &f64), &f64)| Sample { inputs: r.clone(), width: *w, height: *h };
        Ok(Self {
            version: Self::VERSION,
            synthetic: measured.remarks.iter().any(|r| r.to_lowercase().contains("synthetic")),
            width,
            height,
            largest_leverage,
            measured: measured.rows.iter().zip(&measured.widths).zip(&measured.heights).map(sample).collect(),
            inputs: measured.inputs,
            remarks: measured.remarks,
            triangle: factored.triangle,
            terms,
            notes,
        })
    }
}

fn counted(beads: usize) -> String {
    if beads == 1 { "1 bead".to_owned() } else { format!("{beads} beads") }
}

/// The measurements without the inputs that have the same value throughout.
fn varying(measured: &Measured) -> Result<(Measured, Vec<String>), LibraryError> {
    let mut kept = measured.clone();
    let mut notes = Vec::new();
    for (k, input) in measured.inputs.iter().enumerate().rev() {
        if levels(measured, k) > 1 {
            if let Some((_, what)) = UNORDERED.iter().find(|(name, _)| input.name == *name) {
                let reason = format!("{what} have no order. Fit the beads of each by themselves, or name the inputs.");
                return Err(LibraryError::Inputs { reason });
            }
            continue;
        }
        notes.insert(
            0,
            format!(
                "{} is {} {} for every bead and is left out: the library holds for this value only.",
                input.name, input.min, input.unit
            ),
        );
        kept.inputs.remove(k);
        for row in &mut kept.rows {
            row.remove(k);
        }
    }
    let reason = match kept.inputs.len() {
        0 => "no input varies: every bead was welded with the same parameters.".to_owned(),
        n if n > MOST_INPUTS => {
            format!("{n} inputs vary, at most {MOST_INPUTS} can be fitted. Name those that matter.")
        }
        _ => return Ok((kept, notes)),
    };
    Err(LibraryError::Inputs { reason })
}

/// Number of different values of an input, at most 3.
fn levels(measured: &Measured, k: usize) -> usize {
    let Input { min, max, .. } = measured.inputs[k];
    let near = |a: f64, b: f64| (a - b).abs() <= SAME_LEVEL * (max - min).max(SAME_LEVEL * max.abs());
    let between = measured.rows.iter().any(|r| !near(r[k], min) && !near(r[k], max));
    if near(min, max) { 1 } else { 2 + usize::from(between) }
}

/// The terms that the number of beads and the number of levels allow: constant, inputs, squares, products.
fn terms(measured: &Measured, notes: &mut Vec<String>) -> Result<Vec<Vec<usize>>, LibraryError> {
    let (rows, n) = (measured.rows.len(), measured.inputs.len());
    let first: Vec<Vec<usize>> = std::iter::once(vec![]).chain((0..n).map(|i| vec![i])).collect();
    let (bent, straight): (Vec<usize>, Vec<usize>) = (0..n).partition(|&i| levels(measured, i) > 2);
    let squares: Vec<Vec<usize>> = bent.iter().map(|&i| vec![i, i]).collect();
    let products: Vec<Vec<usize>> = (0..n).flat_map(|i| (i + 1..n).map(move |j| vec![i, j])).collect();
    // One bead more than terms, so that the error can be estimated.
    let full = first.len() + squares.len() + products.len() + 1;
    if rows <= first.len() {
        return Err(LibraryError::TooFew { rows, inputs: n, needed: first.len() + 1, full });
    }
    for i in straight {
        notes.push(format!("{} has two levels only, so its square is left out.", measured.inputs[i].name));
    }
    let mut terms = first;
    if rows >= full {
        terms.extend(squares.into_iter().chain(products));
    } else if rows > terms.len() + squares.len() && !squares.is_empty() {
        terms.extend(squares);
        notes.push(format!(
            "{rows} beads are too few for products of two inputs ({full} are needed): they are left out."
        ));
    } else {
        notes.push(format!(
            "{rows} beads are too few for the second order ({full} are needed): the fit is of first order."
        ));
    }
    Ok(terms)
}

/// The terms that were kept. A term that depends on others is dropped with a note; an input that does is refused.
fn kept(
    inputs: &[Input],
    wanted: &[Vec<usize>],
    factored: &Factored,
    notes: &mut Vec<String>,
) -> Result<Vec<Vec<usize>>, LibraryError> {
    for (k, term) in wanted.iter().enumerate().filter(|(k, _)| !factored.kept.contains(k)) {
        let names: Vec<&str> = term.iter().map(|&i| inputs[i].name.as_str()).collect();
        if term.len() == 1 {
            let others = wanted[1..k].iter().map(|t| inputs[t[0]].name.as_str()).collect::<Vec<_>>().join(", ");
            let reason = format!(
                "{} follows from {others} in every measured bead, so their effects cannot be told apart. Leave one of them out.",
                names[0]
            );
            return Err(LibraryError::Inputs { reason });
        }
        notes.push(format!(
            "the measured beads do not distinguish the term {} from the others: it is left out.",
            names.join(" × ")
        ));
    }
    Ok(factored.kept.iter().map(|&k| wanted[k].clone()).collect())
}

/// Fit and goodness of fit of one response. The leave-one-out errors are residual / (1 − leverage) (PRESS).
fn response(factored: &Factored, rows: &[Vec<f64>], leverages: &[f64], y: &[f64]) -> Response {
    let coefficients = factored.solve(y);
    let residuals: Vec<f64> = rows.iter().zip(y).map(|(row, y)| y - dot(row, &coefficients)).collect();
    let (n, p) = (y.len() as f64, coefficients.len() as f64);
    let mean = y.iter().sum::<f64>() / n;
    let total: f64 = y.iter().map(|y| (y - mean).powi(2)).sum();
    let missed = dot(&residuals, &residuals);
    let unexplained = if total > 0.0 { missed / total } else { 0.0 };
    let alone = leverages.iter().any(|h| *h > 1.0 - 1e-9);
    let press: f64 = residuals.iter().zip(leverages).map(|(r, h)| (r / (1.0 - h)).powi(2)).sum();
    Response {
        coefficients,
        r_squared: 1.0 - unexplained,
        adjusted_r_squared: 1.0 - unexplained * (n - 1.0) / (n - p),
        residual: (missed / (n - p)).sqrt(),
        leave_one_out: (!alone).then(|| (press / n).sqrt()),
    }
}
