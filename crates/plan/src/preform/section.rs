//! The section `[preform]`.

use super::{Plate, PreformSettings};
use crate::limit::{TINY, section};
use bead_part::slice::SliceOptions;
use serde::{Deserialize, Serialize};

/// What becomes of the plate on which a preform is welded.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum PlateIs {
    /// The part is sawn off it.
    Sawn,
    /// It becomes the lowest part of the part.
    Kept,
}

section! {
    /// How a part becomes its preform: the part plus the stock that is milled off afterwards; every key has a default.
    PreformSection "preform" {
        /// Stock on faces that look sideways, mm; default 1.5.
        side: f64 = 1.5, 0.0, 50.0, "mm", "thicker stock costs more than a second setup";
        /// Stock on faces that look up, mm; default 2.
        top: f64 = 2.0, 0.0, 50.0, "mm", "thicker stock costs more than a second setup";
        /// Stock on faces that look down, mm; default 1.5.
        bottom: f64 = 1.5, 0.0, 50.0, "mm", "thicker stock costs more than a second setup";
        /// Holes, slots and grooves narrower than this are welded shut, mm; default 12.
        fill_holes: f64 = 12.0, 0.0, 500.0, "mm", "wider holes save more wire than they cost in starts";
        /// How far a layer may hang beyond the one below, degrees from the vertical; default 30.
        reach: f64 = 30.0, 0.0, 60.0, "degrees", "a bead that hangs farther drops off, or lies on nothing";
        /// What becomes of the plate: `sawn` off, or `kept` as the lowest part of the part; default sawn.
        plate: PlateIs = PlateIs::Sawn;
        /// Thickness of the plate, mm; default 20.
        plate_thickness: f64 = 20.0, 1.0, 500.0, "mm", "thinner plates bend, and thicker ones are not sold";
        /// How far the plate extends beyond the preform, mm; default 30.
        plate_margin: f64 = 30.0, 0.0, 1000.0, "mm", "clamps need less room";
        /// Height above the plate in which the saw cuts, mm; default 4.
        cut_height: f64 = 4.0, 0.0, 100.0, "mm", "no saw needs more";
        /// How fast stock is milled off, cm³/min; default 60.
        milling_rate: f64 = 60.0, TINY, 1e4, "cm³/min", "no mill is faster";
        /// A kilogram of plate or of billet, in the currency of `[cost]`; default 0.
        stock_kg: f64 = 0.0, 0.0, 1e6, "per kg", "even gold costs less";
    }
}

impl PreformSection {
    /// In mm and rad, for beads `bead_width` wide, two of which lie side by side in `room`, that are at least `shortest` long,
    /// mm, in layers that are cut as `slicing` says.
    pub fn settings(&self, [bead_width, room]: [f64; 2], shortest: f64, slicing: SliceOptions) -> PreformSettings {
        let SliceOptions { layer_height, close_gap, simplify } = slicing;
        let plate = match self.plate {
            PlateIs::Sawn => Plate::Sawn { cut: self.cut_height },
            PlateIs::Kept => Plate::Kept { thickness: self.plate_thickness },
        };
        PreformSettings {
            side: self.side,
            top: self.top,
            bottom: self.bottom,
            fill_holes: self.fill_holes,
            reach: self.reach.to_radians(),
            plate,
            bead_width,
            room,
            step: STEPS.recip() * layer_height,
            shortest,
            close_gap,
            simplify,
        }
    }
}

/// Steps of a preform per layer.
const STEPS: f64 = 2.0;
