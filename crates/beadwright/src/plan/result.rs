//! What a plan is, where its layers go, and why there may be none.

use super::MAX_LAYERS;
use crate::bead::wall::WallError;
use crate::chart::warp::WarpError;
use crate::deposit::Figures;
use crate::deposit::stack::Grown;
use crate::layer::{Extent, Layer};
use crate::metrics::Metrics;
use crate::model::wall_curves::Sides;
use crate::task::Cancelled;
use crate::warning::{WarningSummary, Warnings};
use glam::DVec3;
use serde::{Deserialize, Serialize};
use std::convert::Infallible;

/// What all layers of a plan have in common.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Header {
    /// Name of the part, for files and headings.
    pub part: String,
    /// Name of the profile.
    pub profile: String,
    /// Name of the strategy.
    pub strategy: String,
    /// Number of layers, and the box around the part.
    pub extent: Extent,
}

/// A whole plan.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// What all layers have in common.
    pub header: Header,
    /// The layers, lowest first.
    pub layers: Vec<Layer>,
    /// Totals and warnings.
    pub summary: Summary,
}

/// Totals and warnings of a plan.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    /// The totals.
    pub metrics: Metrics,
    /// Warnings about layers.
    pub warnings: Warnings,
    /// What is inconsistent in the profile, as sentences.
    pub notes: Vec<String>,
    /// Why its programs should not be written, as sentences; empty for a plan that can be welded.
    pub forbidden: Vec<String>,
    /// Bodies for which the torch has no room beside others that are welded before them; `forbidden` says so, too. Neither parts
    /// welded one after another nor a part that is there already are among them.
    #[serde(default)]
    pub blocked: Vec<Blocked>,
    /// How the part grows, where planning finds out: in level layers of one body, whose metal is shared out, for sinks that
    /// [ask for it](Sink::asks_how_it_grows).
    #[serde(skip)]
    pub grown: Option<Grown>,
}

/// A body that cannot be welded once another is finished: the torch would hit it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Blocked {
    /// Index of the body in `layers.bodies`.
    pub body: usize,
    /// Index of the body in its way, in `layers.bodies`.
    pub by: usize,
}

impl Summary {
    /// The totals, warnings and notes, and what the deposit model says: the content of `metrics.json`.
    pub fn json(&self, figures: Option<&Figures>) -> serde_json::Value {
        let named = |summary: &WarningSummary| {
            let mut value = serde_json::json!(summary);
            if let (None, Some(fields)) = (summary.at, value.as_object_mut()) {
                fields.remove("at");
            }
            value
        };
        let warnings: Vec<_> = self.warnings.summaries().map(named).collect();
        let mut value = serde_json::json!(self.metrics);
        value["coverage"] = self.metrics.coverage().into();
        value["warnings"] = serde_json::json!(warnings);
        value["notes"] = serde_json::json!(self.notes);
        value["forbidden"] = serde_json::json!(self.forbidden);
        value["deposit"] = serde_json::json!(figures.map(Figures::summary));
        value
    }
}

/// Why a plan could not be made. `E` is the error of the sink.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PlanError<E> {
    /// Stopped by the caller.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// The plan would be too large.
    #[error(
        "the part is {height:.0} mm high and would take {layers} layers of {layer_height} mm; at most {MAX_LAYERS} are planned. \
         Check the unit of the file and layers.height."
    )]
    TooManyLayers {
        /// Height of the part, mm.
        height: f64,
        /// Number of layers.
        layers: usize,
        /// Thickness of a layer, mm.
        layer_height: f64,
    },
    /// A part that cannot be mapped into its chart.
    #[error(transparent)]
    Chart(WarpError),
    /// No wall can be predicted from the bead.
    #[error(transparent)]
    Wall(#[from] WallError),
    /// A surface that is not closed, and the profile does not say what it stands for.
    #[error(
        "the surface of the part is open: near x {:.1} y {:.1} z {:.1} mm it has an opening {width:.1} mm wide. If it is the \
         skin of a solid, mend the model, or set slice.surface = \"solid\", which fills what its contours enclose and leaves \
         out those that do not close. If it stands for a wall, set slice.surface = \"wall\", which lays one bead along it.",
        .place.x, .place.y, .place.z
    )]
    Open {
        /// Width of the widest opening, mm.
        width: f64,
        /// A place on it, mm.
        place: DVec3,
    },
    /// Curves where a solid is needed.
    #[error("only solids have a preform, and this part is given by curves. Give its solid.")]
    NoSolid,
    /// A preform for layers that are not level.
    #[error(
        "a preform adds metal below the overhangs of level layers. Leave layers.chart and layers.bodies out, or plan \
         the part without a preform."
    )]
    PreformOfChart,
    /// Curves with layers that are not level.
    #[error(
        "walls given by curves or by an open surface have level layers. Leave layers.chart out, or give the wall as a solid of its thickness."
    )]
    ChartOfCurves,
    /// Curves that may be the sides of one wall or the centre-lines of two.
    #[error(
        "curves run side by side {:.2} to {:.2} mm apart, near x {:.1} y {:.1} z {:.1} mm. If they are the two sides of a wall, \
         set wall.curves = \"sides\": one bead is laid in the middle between them. If they are the centre-lines of walls, set \
         wall.curves = \"centre\".",
        .0.thickness.0, .0.thickness.1, .0.place.x, .0.place.y, .0.place.z
    )]
    SideBySide(Sides),
    /// Curves that are given as the sides of walls, but are not.
    #[error(
        "not every curve has exactly one other at its side, less than {within:.1} mm away at the same height, as the sides of a \
         wall have (wall.curves). Leave the curves of one wall out of the file, or set wall.curves = \"centre\"."
    )]
    NoSides {
        /// Greatest distance between the sides of a wall, mm.
        within: f64,
    },
    /// Nothing would be laid.
    #[error("nothing would be deposited: {0}")]
    Empty(String),
    /// A layer that is not one closed wall, though all layers are to be turns of a helix.
    #[error(
        "layer {layer} cannot be a turn of the helix that wall.helix asks for: {why}. Leave wall.helix out, plan a surface as \
         walls (slice.surface = \"wall\"), or plan the part up to there."
    )]
    NoHelix {
        /// Number of the layer, from 1.
        layer: usize,
        /// Why, as a clause.
        why: String,
    },
    /// Parts cannot be welded one after another with this profile.
    #[error("the parts cannot be welded one after another: {0}")]
    Parts(&'static str),
    /// A body cannot be planned.
    #[error("body {name} (layers.bodies): {reason}")]
    Body {
        /// Its name.
        name: String,
        /// Why, as a sentence.
        reason: String,
    },
    /// The sink's own error.
    #[error(transparent)]
    Sink(E),
}

impl<E> From<WarpError> for PlanError<E> {
    fn from(error: WarpError) -> Self {
        match error {
            WarpError::Cancelled(cancelled) => Self::Cancelled(cancelled),
            misplaced => Self::Chart(misplaced),
        }
    }
}

/// Receives the layers of a plan in deposition order.
pub trait Sink {
    /// The error of taking in a layer.
    type Error: Send;

    /// Called once, before the first layer.
    ///
    /// # Errors
    /// Whatever the sink fails with; planning then stops.
    fn begin(&mut self, header: &Header) -> Result<(), Self::Error>;

    /// Takes the next layer.
    ///
    /// # Errors
    /// Whatever the sink fails with; planning then stops.
    fn layer(&mut self, layer: Layer) -> Result<(), Self::Error>;

    /// Whether planning should compare the metal with the plan after each layer ([`Summary::grown`]).
    fn asks_how_it_grows(&self) -> bool {
        false
    }
}

/// Keeps the layers of a plan.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Collect {
    /// What all layers have in common; `None` before the plan begins.
    pub header: Option<Header>,
    /// The layers so far.
    pub layers: Vec<Layer>,
}

impl Sink for Collect {
    type Error = Infallible;

    fn begin(&mut self, header: &Header) -> Result<(), Infallible> {
        self.header = Some(header.clone());
        Ok(())
    }

    fn layer(&mut self, layer: Layer) -> Result<(), Infallible> {
        self.layers.push(layer);
        Ok(())
    }
}
