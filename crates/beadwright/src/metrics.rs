//! The totals of a plan: passes, lengths, times, wire, heat.

use crate::bead::wire_area;
use crate::motion::Motion;
use crate::plan::Layer;
use crate::profile::Profile;
use glam::DVec3;
use serde::Serialize;

/// Totals of a plan, or of some of its layers.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Metrics {
    /// Layers with at least one pass.
    pub layers: usize,
    /// Passes.
    pub passes: usize,
    /// Arc starts, one for each pass.
    pub arc_starts: usize,
    /// Length of all passes, mm.
    pub deposited_length_mm: f64,
    /// Length of all moves without arc, mm.
    pub travel_length_mm: f64,
    /// Time with the arc on and the torch moving, s; with acceleration where the profile gives it.
    pub arc_time_s: f64,
    /// Whole time with travels, delays and gas, s; with acceleration where the profile gives it.
    pub total_time_s: f64,
    /// Wire, m.
    pub wire_length_m: f64,
    /// Wire, kg.
    pub wire_mass_kg: f64,
    /// Heat per length of bead, J/mm, where the profile gives current and voltage.
    pub heat_input_j_per_mm: Option<f64>,
    /// Sum of the slice areas, mm².
    pub slice_area_mm2: f64,
    /// Sum of the areas within reach of a bead, mm².
    pub planned_area_mm2: f64,
    /// Volume of the layers, mm³.
    pub part_volume_mm3: f64,
    /// Volume of the beads, mm³.
    pub deposited_volume_mm3: f64,
    #[serde(skip)]
    rates: Rates,
    #[serde(skip)]
    torch: Option<DVec3>,
}

/// What the totals need from the profile.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Rates {
    /// Metal laid, mm³/s.
    metal: f64,
    motion: Option<Motion>,
    travel_speed: f64,
    clearance: f64,
    delay: f64,
    wire_feed_speed: f64,
    wire_grams_per_mm: f64,
}

impl Metrics {
    /// Totals of nothing yet.
    pub fn new(profile: &Profile) -> Self {
        let process = &profile.process;
        let rates = Rates {
            metal: profile.bead().area() * process.deposition_speed,
            motion: profile.motion,
            travel_speed: profile.travel.speed,
            clearance: profile.travel.clearance,
            delay: process.gas_preflow + process.arc_start_delay + process.arc_end_delay + process.gas_postflow,
            wire_feed_speed: process.wire_feed_speed * 1000.0 / 60.0,
            wire_grams_per_mm: wire_area(profile.wire.diameter) * profile.wire.density / 1000.0,
        };
        Self {
            layers: 0,
            passes: 0,
            arc_starts: 0,
            deposited_length_mm: 0.0,
            travel_length_mm: 0.0,
            arc_time_s: 0.0,
            total_time_s: 0.0,
            wire_length_m: 0.0,
            wire_mass_kg: 0.0,
            heat_input_j_per_mm: profile.heat_input(),
            slice_area_mm2: 0.0,
            planned_area_mm2: 0.0,
            part_volume_mm3: 0.0,
            deposited_volume_mm3: 0.0,
            rates,
            torch: None,
        }
    }

    /// Counts the next layer.
    pub fn add(&mut self, layer: &Layer) {
        self.layers += usize::from(!layer.passes.is_empty());
        self.slice_area_mm2 += layer.slice_area;
        self.planned_area_mm2 += layer.planned_area;
        self.part_volume_mm3 += layer.slice_area * layer.height;
        for pass in &layer.passes {
            let (Some(start), Some(end)) = (pass.start(), pass.end()) else { continue };
            let legs = self.torch.map_or([start; 3], |from| travel_legs(from, start, self.rates.clearance));
            let (travel, travel_time) = self.rates.travel(self.torch.unwrap_or(start), legs);
            let (length, seconds) = (pass.length(), pass.seconds());
            let moving =
                self.rates.motion.map_or(seconds, |m| m.seconds(start, pass.segments().map(|s| (s.to, s.speed))));
            let wire = self.rates.wire_feed_speed * seconds;
            self.passes += 1;
            self.arc_starts += 1;
            self.deposited_length_mm += length;
            self.deposited_volume_mm3 += seconds * self.rates.metal;
            self.travel_length_mm += travel;
            self.arc_time_s += moving;
            self.total_time_s += moving + travel_time + self.rates.delay;
            self.wire_length_m += wire / 1000.0;
            self.wire_mass_kg += wire * self.rates.wire_grams_per_mm / 1000.0;
            self.torch = Some(end);
        }
    }

    /// Planned area over slice area, 0 to 1.
    pub fn coverage(&self) -> f64 {
        if self.slice_area_mm2 > 0.0 { self.planned_area_mm2 / self.slice_area_mm2 } else { 0.0 }
    }
}

impl Rates {
    /// Length and time of a travel, mm and s; its legs begin and end at rest.
    fn travel(&self, from: DVec3, legs: [DVec3; 3]) -> (f64, f64) {
        let (mut at, mut length, mut time) = (from, 0.0, 0.0);
        for to in legs {
            let leg = at.distance(to);
            length += leg;
            time += self.motion.map_or(leg / self.travel_speed, |m| m.seconds(at, [(to, self.travel_speed)]));
            at = to;
        }
        (length, time)
    }
}

/// Where a move without arc goes: up to the clearance above the higher end, across, and down.
fn travel_legs(from: DVec3, to: DVec3, clearance: f64) -> [DVec3; 3] {
    let top = from.z.max(to.z) + clearance;
    [from.with_z(top), to.with_z(top), to]
}
