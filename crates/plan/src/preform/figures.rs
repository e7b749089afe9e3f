//! Weight, time and cost of a preform, compared with a block of the same material.

use super::section::{PlateIs, PreformSection};
use super::{Preform, PreformSettings};
use crate::process::Cost;
use bead_part::model::Mesh;
use planar::Region;
use serde::Serialize;

/// Deposition rate and prices of a process.
#[derive(Debug, Clone, PartialEq)]
pub struct Rates {
    /// Density of the metal, g/cm³.
    pub density: f64,
    /// Metal laid while the arc burns, mm³/s.
    pub deposition: f64,
    /// Prices.
    pub cost: Cost,
    /// The plate, and milling.
    pub preform: PreformSection,
}

/// The figures of a preform.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Figures {
    /// Mass of the part, kg.
    pub part_kg: f64,
    /// Mass of what is welded, kg.
    pub preform_kg: f64,
    /// Mass of the plate, kg.
    pub plate_kg: f64,
    /// Mass of the block from which the part could be milled, with the same allowances, kg.
    pub billet_kg: f64,
    /// Mass milled off the deposited metal and off a plate that is kept, kg.
    pub milled_kg: f64,
    /// Buy-to-fly ratio: mass bought per mass of the part.
    pub buy_to_fly: f64,
    /// Buy-to-fly ratio of the block.
    pub billet_buy_to_fly: f64,
    /// Time with the arc on, h.
    pub arc_hours: f64,
    /// Milling time, h.
    pub milling_hours: f64,
    /// Time to mill the part from the block, h.
    pub billet_milling_hours: f64,
    /// Cost of wire, plate and hours; `None` without prices.
    pub price: Option<f64>,
    /// Cost of the block and its milling; `None` without prices.
    pub billet_price: Option<f64>,
    /// Height above the plate at which the part is sawn off, mm; `None` if the plate is kept.
    pub cut_height: Option<f64>,
}

/// mm³ per cm³.
const CM3: f64 = 1e3;
/// Grams (cm³ times g/cm³) per kilogram.
const GRAMS: f64 = 1e3;

impl Figures {
    /// The figures of a part's preform.
    pub fn of(part: &Mesh, preform: &Preform, settings: &PreformSettings, rates: &Rates) -> Self {
        let stock = 2.0 * settings.side;
        let block = part.size() + glam::DVec3::new(stock, stock, settings.top + settings.bottom);
        let billet = block.x * block.y * block.z;
        Self::from_volumes(part.volume(), preform.volume(), plate_area(&preform.steps, rates), billet, rates)
    }

    /// From the volumes (mm³) of part, preform and block, and the area of the plate (mm²).
    pub(super) fn from_volumes(part: f64, preform: f64, plate_area: f64, billet: f64, rates: &Rates) -> Self {
        let Rates { density, deposition, cost, preform: keys } = rates;
        let kg = |volume: f64| volume / CM3 * density / GRAMS;
        let plate = plate_area * keys.plate_thickness;
        let kept = keys.plate == PlateIs::Kept;
        let milled = (preform + if kept { plate } else { 0.0 } - part).max(0.0);
        let milling = |volume: f64| volume / CM3 / keys.milling_rate / 60.0;
        let arc_hours = preform / deposition / 3600.0;
        let (milling_hours, billet_milling_hours) = (milling(milled), milling((billet - part).max(0.0)));
        let known = cost.hour > 0.0 || cost.wire_kg > 0.0 || cost.gas_m3 > 0.0 || keys.stock_kg > 0.0;
        let price = (arc_hours + milling_hours) * cost.hour + kg(preform) * cost.wire_kg + kg(plate) * keys.stock_kg;
        let billet_price = billet_milling_hours * cost.hour + kg(billet) * keys.stock_kg;
        Self {
            part_kg: kg(part),
            preform_kg: kg(preform),
            plate_kg: kg(plate),
            billet_kg: kg(billet),
            milled_kg: kg(milled),
            buy_to_fly: (preform + plate) / part,
            billet_buy_to_fly: billet / part,
            arc_hours,
            milling_hours,
            billet_milling_hours,
            price: known.then_some(price),
            billet_price: known.then_some(billet_price),
            cut_height: (!kept).then_some(keys.cut_height),
        }
    }

    /// The figures in sentences; prices in their currency.
    pub fn sentences(&self, currency: &str) -> Vec<String> {
        let Self { part_kg, preform_kg, plate_kg, milled_kg, buy_to_fly, billet_buy_to_fly, .. } = self;
        let Self { milling_hours, billet_milling_hours, .. } = self;
        let plate = if self.cut_height.is_some() { "is sawn off" } else { "becomes part of the part" };
        let mut sentences = vec![
            format!(
                "The preform weighs {preform_kg:.3} kg, the part {part_kg:.3} kg; {milled_kg:.3} kg are milled off, and the plate \
                 of {plate_kg:.3} kg {plate}."
            ),
            format!(
                "For each kg of the part {buy_to_fly:.2} kg are bought, {billet_buy_to_fly:.2} kg for a block; milling takes \
                 {milling_hours:.2} h, from the block {billet_milling_hours:.2} h."
            ),
        ];
        let prices = self.price.zip(self.billet_price);
        sentences.extend(prices.map(|(price, billet)| {
            format!(
                "Wire, plate, arc and milling cost {price:.2} {currency}, the block and its milling {billet:.2} {currency}."
            )
        }));
        sentences
    }

    /// The value to minimise: the price or, without prices, the hours of arc and milling, with a kilogram of plate
    /// counted as a fraction of a kilogram of wire.
    pub fn score(&self) -> f64 {
        let plate = self.plate_kg * self.arc_hours / self.preform_kg.max(f64::MIN_POSITIVE);
        self.price.unwrap_or(self.arc_hours + self.milling_hours + PLATE * plate)
    }
}

/// A kilogram of plate counts as this many kilograms of wire.
const PLATE: f64 = 0.1;

/// Area of the plate under a preform, mm²: the rectangle around its lowest step, plus the margin.
fn plate_area(steps: &[Region], rates: &Rates) -> f64 {
    let bounds = steps.first().and_then(Region::bounds);
    bounds.map_or(0.0, |bounds| {
        let size = bounds.size() + 2.0 * rates.preform.plate_margin;
        size.x * size.y
    })
}
