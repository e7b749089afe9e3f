//! Trial beads: what to weld on plates in order to learn how a wire behaves, and the sheet for the measurements.
//!
//! A [`Design`] says which combinations of the [`Factor`]s are welded; [`Series`] lays each as a [`Shape`] on a plate, in
//! random order within each block, and numbers it in weld metal. Every trial is a layer of its own, since the wire feed and
//! the job of a plan change from layer to layer.
//!
//! | file | what it holds |
//! | --- | --- |
//! | `factor` | process parameters that are varied, and their values |
//! | `design` | full factorial, Box–Behnken, Latin hypercube |
//! | `shape` | what is welded with each combination: beads, their ends, overlaps, walls, corners |
//! | `digits` | numbers as strokes |
//! | `plate` | where everything lies on the plates, as layers |
//! | `sheet` | the table to fill in |
//! | `found` | valleys between beads, humps, craters and corners over what was varied |
//! | `measure` | beads measured in a scan of the plate |

mod design;
mod digits;
mod factor;
mod found;
mod measure;
mod plate;
mod shape;
mod sheet;

pub use design::{Design, points};
pub use factor::{Factor, FactorError, Parameter};
pub use found::{Best, Found, FoundError, Subject, Widest};
pub use measure::{BeadSize, MeasureError, More, Slope, Sought, measured};
pub use plate::{Layout, Nominal, Placed, Plate, PlateError, Series, Span};
pub use shape::Shape;
pub use sheet::{SheetError, TrialWelded, as_measured, csv, filled, numbers_on, plates};
