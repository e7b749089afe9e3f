//! Why measurements or a library were refused, in sentences for welders.

/// Why measurements, a library or a wish were refused.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LibraryError {
    /// The CSV holds no header or no measurements.
    #[error("the measurements are empty: {reason}")]
    Empty {
        /// What is missing.
        reason: String,
    },
    /// A line of the CSV cannot be used.
    #[error("line {line}: {reason}")]
    Line {
        /// Line number, from 1.
        line: usize,
        /// What is wrong and what would be right.
        reason: String,
    },
    /// A value in the CSV cannot be used.
    #[error("line {line}, column \"{column}\": {reason}")]
    Cell {
        /// Line number, from 1.
        line: usize,
        /// Name of the column as in the header.
        column: String,
        /// What is wrong and what would be right.
        reason: String,
    },
    /// A column or an input that does not exist.
    #[error("there is no {what} \"{name}\". Known: {known}.")]
    Unknown {
        /// `column` or `input`.
        what: &'static str,
        /// What was asked for.
        name: String,
        /// The names that exist.
        known: String,
    },
    /// The inputs cannot be fitted.
    #[error("{reason}")]
    Inputs {
        /// Which inputs, why, and what to do.
        reason: String,
    },
    /// Too few rows for any fit.
    #[error(
        "{rows} measured beads are too few for {inputs} inputs: at least {needed} are needed for a first-order fit, \
         {full} for the full second order."
    )]
    TooFew {
        /// Rows that were measured.
        rows: usize,
        /// Inputs that vary.
        inputs: usize,
        /// Rows needed for a first-order fit.
        needed: usize,
        /// Rows needed for the full second-order fit.
        full: usize,
    },
    /// The text is not a bead library, or its values are inconsistent.
    #[error("this is not a bead library: {reason}")]
    File {
        /// What is wrong.
        reason: String,
    },
    /// An input without a value.
    #[error("a value for {missing} is missing. Give it as {missing}=VALUE, in {unit}.")]
    Missing {
        /// Name of the input.
        missing: String,
        /// Its unit.
        unit: String,
    },
    /// A value outside its measured range.
    #[error(
        "{name} = {value} {unit} is {side} the measured range of {min} to {max} {unit}; beads were not measured there."
    )]
    Outside {
        /// Name of the input.
        name: String,
        /// Its value.
        value: f64,
        /// Its unit.
        unit: String,
        /// `above` or `below`.
        side: &'static str,
        /// Least measured value.
        min: f64,
        /// Greatest measured value.
        max: f64,
    },
    /// Every value is in its range, but no similar combination was measured.
    #[error(
        "the combination {point} lies outside what was measured: its leverage {leverage:.3} is above {limit:.3}, the \
         largest of the measured beads. The nearest of these is {nearest}."
    )]
    Unlike {
        /// The values.
        point: String,
        /// Leverage there.
        leverage: f64,
        /// Largest leverage among the measurements.
        limit: f64,
        /// The nearest measured combination.
        nearest: String,
    },
    /// The fit predicts an impossible bead.
    #[error(
        "at {point} the fit gives a bead of {width:.3} × {height:.3} mm, which is impossible; measure beads nearby."
    )]
    NoBead {
        /// The values.
        point: String,
        /// Width, mm.
        width: f64,
        /// Height, mm.
        height: f64,
    },
    /// The request makes no sense in itself: a size that is not above 0, or limits that leave no value.
    #[error("{reason}")]
    Wish {
        /// What is wrong and what is possible.
        reason: String,
    },
    /// No parameters inside the measured range and the limits lay the wanted bead.
    #[error(
        "a bead {width} mm wide with layers of {layer_height} mm is out of reach: {blocked}. The nearest is {near_width:.2} mm \
         wide with layers of {near_layer:.2} mm, at {point}."
    )]
    OutOfReach {
        /// Wanted width, mm.
        width: f64,
        /// Wanted layer height, mm.
        layer_height: f64,
        /// The bounds that stand in the way.
        blocked: String,
        /// Nearest width, mm.
        near_width: f64,
        /// Its layer height, mm.
        near_layer: f64,
        /// Its parameters.
        point: String,
    },
}
