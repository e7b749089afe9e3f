//! Why logs or a plan cannot be joined, in sentences for welders.

/// Why a log cannot be read or a record not be made.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RecordError {
    /// A log without a line of names, or without rows.
    #[error("the log is empty: {0}")]
    Empty(&'static str),
    /// The header cannot be used.
    #[error("line {line}: {reason}")]
    Header {
        /// Line number, from 1.
        line: u64,
        /// What is wrong and what would be right.
        reason: String,
    },
    /// Too many rows are broken.
    #[error(
        "{broken} of {rows} rows cannot be read, the first in line {line}: {reason}. Check whether the separator and the \
         decimal sign are the same in the whole file."
    )]
    Rows {
        /// Rows that cannot be read.
        broken: usize,
        /// All rows.
        rows: usize,
        /// Line of the first broken one, from 1.
        line: u64,
        /// What is wrong with it.
        reason: String,
    },
    /// The file cannot be read on.
    #[error("the log cannot be read after line {line}: {reason}")]
    Read {
        /// The last line that was read.
        line: u64,
        /// Of the operating system or the reader.
        reason: String,
    },
    /// More rows than can be counted.
    #[error("the log has more than {0} rows. Divide it, for example by day.")]
    TooLong(usize),
    /// A planned pass that makes no sense.
    #[error("layer {layer}, pass {pass} of the plan: {reason}.")]
    Pass {
        /// Layer, from 1.
        layer: usize,
        /// Pass in its layer, from 1.
        pass: usize,
        /// What is wrong.
        reason: &'static str,
    },
    /// Nothing was planned.
    #[error("the plan has no passes.")]
    NoPasses,
    /// No source knows when the arc burned.
    #[error(
        "no log says when the arc burned: at least one needs a column current, arc or wire_feed_speed, or events such as \
         arc_on and arc_off."
    )]
    NoArcs,
    /// The arcs of the logs have nothing in common with the plan.
    #[error(
        "none of the {seen} arcs in the logs fits any of the {planned} planned passes. Check whether plan and logs belong to \
         the same part."
    )]
    NothingFits {
        /// Arcs in the logs.
        seen: usize,
        /// Planned passes.
        planned: usize,
    },
    /// A setting is out of its range.
    #[error("{name} = {value} {unit}: the value must lie between {low} and {high} {unit}.")]
    OutOfRange {
        /// Which setting.
        name: &'static str,
        /// What it is.
        value: f64,
        /// Lowest value allowed.
        low: f64,
        /// Highest value allowed.
        high: f64,
        /// Its unit.
        unit: &'static str,
    },
}
