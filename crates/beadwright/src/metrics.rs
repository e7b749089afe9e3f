//! The totals of a plan: passes, lengths, times, wire, heat.

use crate::bead::wire_area;
use crate::chart::Chart;
use crate::layer::Layer;
use crate::process::{Cost, Process, Spent};
use crate::profile::{LayersSection, Profile};
use crate::program::Programmer;
use crate::slice::Half;
use crate::weld::{Pause, Torch, path};
use serde::{Deserialize, Serialize};

/// Totals of a plan, or of some of its layers.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Metrics {
    /// Layers with at least one pass.
    pub layers: usize,
    /// Passes.
    pub passes: usize,
    /// Arc starts, one for each pass.
    pub arc_starts: usize,
    /// Length of all passes with their overlaps, mm.
    pub deposited_length_mm: f64,
    /// Length of all moves without arc, mm.
    pub travel_length_mm: f64,
    /// Time with the arc on, the torch moving or stationary in craters, s; with acceleration where the profile gives it.
    pub arc_time_s: f64,
    /// Waits between layers and passes, s.
    pub dwell_time_s: f64,
    /// Total time with travels, delays, gas, waits and turns of a positioner, s; with acceleration where the profile gives it.
    pub total_time_s: f64,
    /// Wire, including that of overlaps, hot starts and craters, m.
    pub wire_length_m: f64,
    /// Wire, kg.
    pub wire_mass_kg: f64,
    /// Shielding gas, m³.
    pub gas_m3: f64,
    /// Cost by the prices of `[cost]`; `None` where it has none.
    pub cost: Option<f64>,
    /// Emissions by the factors of `[cost]`, kg CO₂e; `None` where it has none.
    pub co2_kg: Option<f64>,
    /// Energy from the mains, kWh, by the currents and voltage of the profile; `None` where it gives none.
    pub energy_kwh: Option<f64>,
    /// Its currency.
    pub currency: String,
    /// The shortest time that the torch moves with the arc on in one pass, s; `None` without passes.
    pub shortest_arc_s: Option<f64>,
    /// Time for gas, starting and ending the arc, and for craters, s: what every arc start costs.
    pub start_stop_time_s: f64,
    /// Time lost to slowing down before corners and ends, s; 0 where the profile gives no acceleration.
    pub corner_time_s: f64,
    /// Heat per length of bead, J/mm, where the profile gives current and voltage.
    pub heat_input_j_per_mm: Option<f64>,
    /// Sum of the slice areas, mm².
    pub slice_area_mm2: f64,
    /// Sum of the areas that beads cover, mm².
    pub planned_area_mm2: f64,
    /// Volume of the layers, mm³.
    pub part_volume_mm3: f64,
    /// Volume of the part's mesh, mm³; `None` where it is not closed, and for curves.
    pub mesh_volume_mm3: Option<f64>,
    /// Volume of the part that is milled from a preform, mm³; `None` without a preform.
    pub milled_part_volume_mm3: Option<f64>,
    /// Volume of the beads, mm³.
    pub deposited_volume_mm3: f64,
    /// Energy of the arc, kWh; `None` where the current or voltage of a pass is not known.
    #[serde(skip)]
    arc_kwh: Option<f64>,
    #[serde(skip)]
    rates: Rates,
    #[serde(skip)]
    torch: Torch,
    #[serde(skip)]
    turns: Turns,
    /// Volume of the layer below, mm³.
    #[serde(skip)]
    below: f64,
}

/// What the totals need from the profile.
#[derive(Debug, Clone, PartialEq, Default)]
struct Rates {
    /// Metal laid, mm³/s.
    metal: f64,
    wire_feed_speed: f64,
    wire_grams_per_mm: f64,
    /// m³/s.
    gas: f64,
    gas_idle: f64,
    process: Option<Process>,
    cost: Cost,
    /// How layers lie in space, where their thickness varies.
    layers: Option<LayersSection>,
}

impl Rates {
    /// Power of the arc in a layer, kW.
    fn power(&self, layer: &Layer) -> Option<f64> {
        let process = self.process.as_ref()?.at_layer(layer.index);
        Some(process.current? * process.voltage? / 1000.0)
    }
}

impl Metrics {
    /// The totals before any layer is counted.
    pub fn new(profile: &Profile) -> Self {
        let process = &profile.process;
        let rates = Rates {
            metal: profile.bead().area() * process.deposition_speed,
            wire_feed_speed: process.wire_feed_speed * 1000.0 / 60.0,
            wire_grams_per_mm: wire_area(profile.wire.diameter) * profile.wire.density / 1000.0,
            gas: process.gas_flow / 60_000.0,
            // It flows before and after every pass.
            gas_idle: process.gas_preflow + process.arc_start_delay + process.arc_end_delay + process.gas_postflow,
            process: Some(process.clone()),
            cost: profile.cost.clone(),
            layers: profile.layers.charts().any(Chart::has_wedges).then(|| profile.layers.clone()),
        };
        Self {
            layers: 0,
            passes: 0,
            arc_starts: 0,
            deposited_length_mm: 0.0,
            travel_length_mm: 0.0,
            arc_time_s: 0.0,
            dwell_time_s: 0.0,
            total_time_s: 0.0,
            wire_length_m: 0.0,
            wire_mass_kg: 0.0,
            gas_m3: 0.0,
            cost: None,
            co2_kg: None,
            energy_kwh: None,
            currency: profile.cost.currency.clone(),
            shortest_arc_s: None,
            start_stop_time_s: 0.0,
            corner_time_s: 0.0,
            heat_input_j_per_mm: profile.heat_input(),
            slice_area_mm2: 0.0,
            planned_area_mm2: 0.0,
            part_volume_mm3: 0.0,
            mesh_volume_mm3: None,
            milled_part_volume_mm3: None,
            deposited_volume_mm3: 0.0,
            arc_kwh: process.voltage.map(|_| 0.0),
            rates,
            torch: Torch::of(&profile.weld_settings()),
            turns: Turns(profile.program.positioner.is_some().then(|| profile.programmer())),
            below: 0.0,
        }
    }

    /// The same totals, whose times do not depend on how a positioner is turned.
    pub(crate) fn unturned(self) -> Self {
        Self { turns: Turns(None), ..self }
    }

    /// Counts the next layer.
    ///
    /// ```
    /// use beadwright::{Along, Layer, Metrics, Pass, PassKind, Profile, glam::DVec3};
    ///
    /// // A pass of 50 mm at the nominal pace holds the metal of 50 mm of the nominal bead.
    /// let profile = Profile::built_in("cmt-al2319-kuka")?;
    /// let (points, width) = (vec![DVec3::ZERO, DVec3::X * 50.0], Along::Same(profile.bead.width));
    /// let pace = Along::Same(profile.process.deposition_speed);
    /// let pass = Pass { kind: PassKind::Infill, closed: false, points, width, pace, wait: 0.0 };
    /// let mut metrics = Metrics::new(&profile);
    /// metrics.add(&Layer { height: 2.0, passes: vec![pass], ..Layer::default() });
    /// assert!((metrics.deposited_volume_mm3 - 50.0 * profile.bead().area()).abs() < 1e-9);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn add(&mut self, layer: &Layer) {
        self.layers += usize::from(!layer.passes.is_empty());
        self.slice_area_mm2 += layer.slice_area;
        self.planned_area_mm2 += layer.planned_area;
        self.part_volume_mm3 += self.volume(layer);
        let begun = self.torch.begin_layer(layer, 0);
        self.travel_length_mm += begun.length();
        self.dwell_time_s += begun.waiting();
        self.total_time_s += begun.moving() + begun.waiting();
        let power = self.rates.power(layer);
        for pass in &layer.passes {
            let Some(start) = pass.start() else { continue };
            if let Some(pause) = self.torch.wait(pass.wait) {
                self.pause(pause);
            }
            let approach = self.torch.approach(start);
            let welded = self.torch.weld(pass.kind, &path(pass, self.torch.ends()));
            let retract = self.torch.retract();
            let wire = self.rates.wire_feed_speed * welded.metal;
            // A helix is one pass.
            self.passes += usize::from(!layer.lit.before);
            self.arc_starts += usize::from(!layer.lit.before);
            self.deposited_length_mm += welded.length;
            self.deposited_volume_mm3 += welded.metal * self.rates.metal;
            self.travel_length_mm += approach.length + retract.length;
            self.arc_time_s += welded.moving + welded.crater;
            self.arc_kwh = self.arc_kwh.zip(power).map(|(kwh, kw)| kwh + kw * (welded.moving + welded.crater) / 3600.0);
            self.total_time_s += approach.moving + retract.moving;
            self.total_time_s += welded.before + welded.moving + welded.crater + welded.after;
            self.shortest_arc_s = Some(self.shortest_arc_s.map_or(welded.moving, |least| least.min(welded.moving)));
            self.start_stop_time_s += welded.before + welded.crater + welded.after;
            self.corner_time_s += welded.slowed;
            self.wire_length_m += wire / 1000.0;
            self.wire_mass_kg += wire * self.rates.wire_grams_per_mm / 1000.0;
            let idle = if layer.lit.before { 0.0 } else { self.rates.gas_idle };
            self.gas_m3 += (welded.moving + welded.crater + idle) * self.rates.gas;
        }
        self.total_time_s += self.turns.waits(layer);
        let (spent, rates) = (self.spent(), &self.rates.cost);
        (self.cost, self.co2_kg, self.energy_kwh) = (rates.of(&spent), rates.co2_kg(&spent), rates.mains_kwh(&spent));
    }

    fn spent(&self) -> Spent {
        Spent {
            hours: self.total_time_s / 3600.0,
            wire_kg: self.wire_mass_kg,
            gas_m3: self.gas_m3,
            arc_kwh: self.arc_kwh,
        }
    }

    /// Volume that a layer adds, mm³; the upper layer of a pair fills what the lower one leaves.
    fn volume(&mut self, layer: &Layer) -> f64 {
        let wedge = self.rates.layers.as_ref().and_then(|layers| layers.wedge(layer));
        let whole = wedge.map_or(layer.slice_area * layer.height, |wedge| wedge.volume(&layer.islands));
        let below = std::mem::replace(&mut self.below, whole);
        if layer.half == Some(Half::Upper) { whole - below } else { whole }
    }

    fn pause(&mut self, pause: Pause) {
        self.travel_length_mm += pause.length;
        self.dwell_time_s += pause.seconds;
        self.total_time_s += pause.moving + pause.seconds;
    }

    /// Planned area over slice area, 0 to 1.
    pub fn coverage(&self) -> f64 {
        if self.slice_area_mm2 > 0.0 { self.planned_area_mm2 / self.slice_area_mm2 } else { 0.0 }
    }
}

/// Makes the program where travels may have to wait until a positioner has turned the part.
#[derive(Debug, Clone, Default)]
struct Turns(Option<Programmer>);

impl Turns {
    /// How long the travels of the next layer wait, s.
    fn waits(&mut self, layer: &Layer) -> f64 {
        let Some(programmer) = &mut self.0 else { return 0.0 };
        let before = programmer.waited();
        programmer.layer(layer);
        programmer.waited() - before
    }
}

/// Totals are compared without this state.
impl PartialEq for Turns {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}
