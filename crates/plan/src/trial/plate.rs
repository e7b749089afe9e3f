//! Where the trials lie on the plates, and the layers that weld them.

use super::design::shuffled;
use super::digits;
use super::measure::LEFT_OUT;
use super::shape::{Stroke, bounds};
use super::{Factor, Parameter, Shape};
use crate::layer::Layer;
use crate::pass::{Along, Pass, PassKind};
use crate::process::{LayerEnds, LayerProcess, Process, StartStop};
use crate::random::Random;
use glam::DVec2;
use planar::{Polygon, Ring};

/// A plate, mm; its lower left corner is the origin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plate {
    /// Along x, mm.
    pub length: f64,
    /// Along y, mm.
    pub width: f64,
    /// At all edges, mm: where clamps grip and nothing is welded.
    pub margin: f64,
}

/// How trials are laid on plates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Layout {
    /// The plates.
    pub plate: Plate,
    /// How often each combination is welded: in blocks, each in another random order.
    pub repeats: usize,
    /// Seed of the random order.
    pub seed: u64,
    /// Length of a bead, or of both legs of a corner, mm.
    pub length: f64,
    /// Least distance between the beads of two trials, mm.
    pub gap: f64,
    /// Time the torch waits before each trial so that the plate cools, s.
    pub wait: f64,
    /// Whether each trial is numbered in weld metal, once all of its plate are welded.
    pub numbers: bool,
}

/// The process that trials vary, and the beads that it lays.
#[derive(Debug, Clone)]
pub struct Nominal {
    /// The process.
    pub process: Process,
    /// How its beads begin and end.
    pub ends: StartStop,
    /// How far its torch swings to each side, mm; `None` if it does not weave.
    pub amplitude: Option<f64>,
    /// Width of a bead, mm.
    pub width: f64,
    /// Layer height, mm.
    pub height: f64,
}

/// A trial on its plate.
#[derive(Debug, Clone, PartialEq)]
pub struct Placed {
    /// Its number, from 1: the order of welding.
    pub number: usize,
    /// Its block, from 0: each has every combination once.
    pub block: usize,
    /// Its plate, from 0.
    pub plate: usize,
    /// A value for each factor.
    pub values: Vec<f64>,
    /// Its paths as seen from above, mm on the plate.
    pub paths: Vec<Vec<DVec2>>,
    /// Width of its beads, if they are as high as the nominal one, mm.
    pub width: f64,
    /// Where its number is welded: the lower left corner, mm.
    pub label: DVec2,
}

/// Trials on plates.
#[derive(Debug, Clone)]
pub struct Series {
    /// What is varied.
    pub factors: Vec<Factor>,
    /// What is welded.
    pub shape: Shape,
    /// The trials in the order of welding.
    pub trials: Vec<Placed>,
    layout: Layout,
    nominal: Nominal,
}

/// Beads may become this much wider than they should; the plate has room for these.
const WIDEST: f64 = 1.4;

impl Series {
    /// Places each combination as often as it is repeated, in a block each, in random order within the block.
    ///
    /// # Errors
    /// [`PlateError`] where a factor does not belong to the shape, a wire feed lies too far from the nominal one, or a trial is
    /// larger than the plate.
    pub fn new(
        factors: Vec<Factor>,
        combinations: &[Vec<f64>],
        shape: Shape,
        layout: Layout,
        nominal: Nominal,
    ) -> Result<Self, PlateError> {
        if let Some(strange) = factors.iter().find(|factor| !shape.allows(factor.parameter)) {
            return Err(PlateError::Factor(strange.parameter));
        }
        nominal.check(&factors)?;
        let mut random = Random::new(layout.seed);
        let mut series = Self { factors, shape, trials: Vec::new(), layout, nominal };
        for block in 0..layout.repeats {
            for k in shuffled(combinations.len(), &mut random) {
                let number = series.trials.len() + 1;
                let values = combinations[k].clone();
                let paths = series.strokes(&values).into_iter().map(|stroke| stroke.points).collect();
                let width = series.bead(&values);
                series.trials.push(Placed { number, block, plate: 0, values, paths, width, label: DVec2::ZERO });
            }
        }
        let feed = |trial: &Placed| series.speed_and_feed(&trial.values).1;
        if let Some(rate) = series.trials.iter().map(feed).find(|rate| !LayerProcess::RATES.contains(rate)) {
            let nominal = series.nominal.process.wire_feed_speed;
            return Err(PlateError::Feed { feed: rate * nominal, nominal });
        }
        series.leave_room_between_leads()?;
        // Blocks begin on plates of their own where each fits on one.
        series.place(true)?;
        if series.plates() > layout.repeats {
            series.place(false)?;
        }
        Ok(series)
    }

    /// The value of a parameter among those of a trial, if it is varied.
    pub fn value(&self, values: &[f64], parameter: Parameter) -> Option<f64> {
        self.factors.iter().zip(values).find(|(factor, _)| factor.parameter == parameter).map(|(_, value)| *value)
    }

    /// The speed of the torch, mm/s, and the wire feed over the nominal one.
    fn speed_and_feed(&self, values: &[f64]) -> (f64, f64) {
        let value = |parameter| self.value(values, parameter);
        let speed = value(Parameter::DepositionSpeed).unwrap_or(self.nominal.process.deposition_speed);
        (speed, value(Parameter::WireFeedSpeed).map_or(1.0, |feed| feed / self.nominal.process.wire_feed_speed))
    }

    /// Width of a bead that is as high as the nominal one, mm: the metal of the wire.
    fn bead(&self, values: &[f64]) -> f64 {
        let (speed, feed) = self.speed_and_feed(values);
        self.nominal.width * feed * self.nominal.process.deposition_speed / speed
    }

    /// Beads are measured in their middle, which hot starts and lead-outs must not reach.
    fn leave_room_between_leads(&self) -> Result<(), PlateError> {
        let length = self.layout.length;
        if matches!(self.shape, Shape::Wall(_) | Shape::Corner) {
            return Ok(());
        }
        let lead = |trial: &Placed, [over, power]: [Parameter; 2]| {
            let own =
                |parameter| self.value(&trial.values, parameter).or(self.nominal.end(parameter)).unwrap_or_default();
            if own(power) == 1.0 { 0.0 } else { own(over) }
        };
        let leads =
            [[Parameter::LeadInLength, Parameter::LeadInPower], [Parameter::LeadOutLength, Parameter::LeadOutPower]];
        let longest = |trial: &Placed| leads.map(|own| lead(trial, own)).into_iter().fold(0.0, f64::max);
        let long =
            self.trials.iter().map(|trial| (trial.number, longest(trial))).find(|(_, lead)| *lead > LEFT_OUT * length);
        long.map_or(Ok(()), |(number, lead)| Err(PlateError::Lead { number, lead, length }))
    }

    /// What is not varied of starts and ends, with its value.
    pub(super) fn held(&self) -> Vec<(Parameter, f64)> {
        let varied = |parameter: &Parameter| self.factors.iter().any(|factor| factor.parameter == *parameter);
        Parameter::all().filter(|own| !varied(own)).filter_map(|own| Some((own, self.nominal.end(own)?))).collect()
    }

    /// Length of a bead, or of both legs of a corner, mm.
    pub(super) fn length(&self) -> f64 {
        self.layout.length
    }

    /// How wide a trial may become, mm: hot starts, wider weaves, and beads that flow.
    fn room(&self, values: &[f64]) -> f64 {
        let power = self.value(values, Parameter::LeadInPower).unwrap_or(self.nominal.ends.lead_in_power);
        let usual = self.nominal.amplitude.unwrap_or_default();
        let swing = self.value(values, Parameter::WeaveAmplitude).unwrap_or(usual) - usual;
        WIDEST * self.bead(values).max(self.nominal.width) * power + 2.0 * swing.max(0.0)
    }

    fn strokes(&self, values: &[f64]) -> Vec<Stroke> {
        self.shape.strokes(self.layout.length, self.bead(values), |parameter| self.value(values, parameter))
    }

    /// Rows from below, each from the left: number, then trial.
    fn place(&mut self, apart: bool) -> Result<(), PlateError> {
        let Layout { plate, gap, numbers, .. } = self.layout;
        let nominal = self.nominal.width;
        let room = DVec2::new(plate.length, plate.width) - 2.0 * plate.margin;
        let widths: Vec<f64> = self.trials.iter().map(|trial| self.room(&trial.values)).collect();
        // The corner of the next trial, and the top of the row so far, from the corner of the room.
        let (mut corner, mut top, mut on, mut block) = (DVec2::ZERO, 0.0_f64, 0, 0);
        for (trial, widest) in self.trials.iter_mut().zip(widths) {
            let number = if numbers { digits::size(trial.number, nominal) } else { DVec2::ZERO };
            let label = if numbers { number + widest + DVec2::X * gap } else { DVec2::ZERO };
            let (low, high) = bounds(trial.paths.iter().map(Vec::as_slice));
            let own = high - low + widest;
            let size = DVec2::new(label.x + own.x, own.y.max(label.y));
            if size.x > room.x || size.y > room.y {
                return Err(PlateError::Small { number: trial.number, needs: size + 2.0 * plate.margin, plate });
            }
            if apart && trial.block != block {
                (corner, top, on, block) = (DVec2::ZERO, 0.0, on + 1, trial.block);
            }
            if corner.x + size.x > room.x {
                (corner, top) = (DVec2::new(0.0, top + gap), 0.0);
            }
            if corner.y + size.y > room.y {
                (corner, top, on) = (DVec2::ZERO, 0.0, on + 1);
            }
            let at = plate.margin + corner;
            trial.plate = on;
            trial.label = at + DVec2::new(widest / 2.0, (size.y - number.y) / 2.0);
            let by = at + DVec2::new(label.x, (size.y - own.y) / 2.0) + widest / 2.0 - low;
            trial.paths.iter_mut().flatten().for_each(|p| *p += by);
            (corner.x, top) = (corner.x + size.x + gap, top.max(corner.y + size.y));
        }
        Ok(())
    }

    /// Number of plates.
    pub fn plates(&self) -> usize {
        self.trials.last().map_or(0, |trial| trial.plate + 1)
    }

    /// The layers of a plate, and which of them belong to each trial.
    pub fn layers(&self, plate: usize) -> (Vec<Layer>, Vec<Span<'_>>) {
        let (mut layers, mut spans) = (Vec::new(), Vec::new());
        let trials = || self.trials.iter().filter(|trial| trial.plate == plate);
        for trial in trials() {
            let (speed, rate) = self.speed_and_feed(&trial.values);
            let dwell = self.value(&trial.values, Parameter::Dwell).unwrap_or(0.0);
            let from = layers.len() + 1;
            let strokes = self.strokes(&trial.values);
            let high = strokes.iter().map(|stroke| stroke.layer + 1).max().unwrap_or(0);
            for level in 0..high {
                let own = strokes.iter().zip(&trial.paths).filter(|(stroke, _)| stroke.layer == level);
                let paths: Vec<&[DVec2]> = own.map(|(_, path)| path.as_slice()).collect();
                let wait = if level > 0 { dwell } else { self.layout.wait };
                let laid = Laid { level, width: trial.width, pace: speed / rate, wait };
                layers.push(self.layer(layers.len(), &paths, &laid));
            }
            spans.push(Span { from, to: layers.len(), trial });
        }
        if self.layout.numbers {
            let numbers = trials().flat_map(|trial| digits::strokes(trial.number, trial.label, self.nominal.width));
            let numbers: Vec<Vec<DVec2>> = numbers.collect();
            let paths: Vec<&[DVec2]> = numbers.iter().map(Vec::as_slice).collect();
            let (pace, wait) = (self.nominal.process.deposition_speed, self.layout.wait);
            let laid = Laid { level: 0, width: self.nominal.width, pace, wait };
            layers.push(self.layer(layers.len(), &paths, &laid));
        }
        (layers, spans)
    }

    /// A row of `process.layers` for each trial whose wire feed or job differs from the nominal one.
    pub fn processes(&self, spans: &[Span<'_>]) -> Vec<LayerProcess> {
        let row = |&Span { from, to, trial }: &Span<'_>| {
            let (_, rate) = self.speed_and_feed(&trial.values);
            let job = self.value(&trial.values, Parameter::Job).map(|job| job as u32);
            let deposition_speed = rate * self.nominal.process.deposition_speed;
            (rate != 1.0 || job.is_some()).then_some(LayerProcess { from, to, deposition_speed, current: None, job })
        };
        spans.iter().filter_map(row).collect()
    }

    /// A row of `start_stop.layers` for each trial, if its start or end is varied.
    pub fn ends(&self, spans: &[Span<'_>]) -> Vec<LayerEnds> {
        let row = |&Span { from, to, trial }: &Span<'_>| {
            let value = |parameter| self.value(&trial.values, parameter);
            let usual = LayerEnds { from, to, ..LayerEnds::default() };
            let row = LayerEnds {
                lead_in_length: value(Parameter::LeadInLength),
                lead_in_power: value(Parameter::LeadInPower),
                lead_out_length: value(Parameter::LeadOutLength),
                lead_out_power: value(Parameter::LeadOutPower),
                crater_fill_time: value(Parameter::CraterFillTime),
                crater_power: value(Parameter::CraterPower),
                ..usual.clone()
            };
            (row != usual).then_some(row)
        };
        spans.iter().filter_map(row).collect()
    }

    fn layer(&self, index: usize, paths: &[&[DVec2]], laid: &Laid) -> Layer {
        let (z, width) = ((laid.level + 1) as f64 * self.nominal.height, laid.width);
        let islands: Vec<Polygon> = paths.iter().map(|path| around(path, width)).collect();
        let pass = |(k, path): (usize, &&[DVec2])| Pass {
            kind: PassKind::Wall,
            closed: false,
            points: path.iter().map(|p| p.extend(z)).collect(),
            width: Along::Same(width),
            pace: Along::Same(laid.pace),
            wait: if k == 0 && index > 0 { laid.wait } else { 0.0 },
        };
        let area = islands.iter().map(Polygon::area).sum();
        Layer {
            index,
            z,
            height: self.nominal.height,
            passes: paths.iter().enumerate().map(pass).collect(),
            slice_area: area,
            planned_area: area,
            islands,
            ..Layer::default()
        }
    }
}

/// Layers of a trial, from 1.
#[derive(Debug, Clone, Copy)]
pub struct Span<'a> {
    /// The first.
    pub from: usize,
    /// The last.
    pub to: usize,
    /// The trial.
    pub trial: &'a Placed,
}

/// A parameter that changes nothing by itself, its partner, and the value of the partner with which it is idle.
const PAIRS: [(Parameter, Parameter, f64); 5] = [
    (Parameter::LeadInLength, Parameter::LeadInPower, 1.0),
    (Parameter::LeadInPower, Parameter::LeadInLength, 0.0),
    (Parameter::LeadOutLength, Parameter::LeadOutPower, 1.0),
    (Parameter::LeadOutPower, Parameter::LeadOutLength, 0.0),
    (Parameter::CraterPower, Parameter::CraterFillTime, 0.0),
];

impl Nominal {
    /// Refuses factors that would change nothing.
    fn check(&self, factors: &[Factor]) -> Result<(), PlateError> {
        let varied = |parameter: Parameter| factors.iter().any(|factor| factor.parameter == parameter);
        let weaves = |parameter: &Parameter| parameter.key().is_some_and(|key| key.starts_with("weave."));
        if let Some(weave) = Parameter::all().find(|own| weaves(own) && varied(*own) && self.amplitude.is_none()) {
            return Err(PlateError::NoWeave(weave));
        }
        let is_idle = |(own, partner, idle): &&(Parameter, Parameter, f64)| {
            varied(*own) && !varied(*partner) && self.end(*partner) == Some(*idle)
        };
        match PAIRS.iter().find(is_idle) {
            Some(&(own, partner, idle)) => Err(PlateError::Idle { own, partner, idle }),
            None => Ok(()),
        }
    }

    /// The value of a parameter of starts and ends; `None` for any other.
    pub fn end(&self, parameter: Parameter) -> Option<f64> {
        Some(match parameter {
            Parameter::LeadInLength => self.ends.lead_in_length,
            Parameter::LeadInPower => self.ends.lead_in_power,
            Parameter::LeadOutLength => self.ends.lead_out_length,
            Parameter::LeadOutPower => self.ends.lead_out_power,
            Parameter::CraterFillTime => self.ends.crater_fill_time,
            Parameter::CraterPower => self.ends.crater_power,
            _ => return None,
        })
    }
}

/// How the beads of a layer are laid.
struct Laid {
    /// Number of layers of the trial below.
    level: usize,
    /// Width, mm.
    width: f64,
    /// Pace, mm/s.
    pace: f64,
    /// Time the torch waits before the first, s.
    wait: f64,
}

/// The box around a bead, mm.
fn around(path: &[DVec2], width: f64) -> Polygon {
    let (low, high) = bounds(std::iter::once(path));
    let [low, high] = [low - width / 2.0, high + width / 2.0];
    Polygon::simple(Ring::new(vec![low, DVec2::new(high.x, low.y), high, DVec2::new(low.x, high.y)]))
}

/// Why trials cannot be laid.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PlateError {
    /// A factor of another shape.
    #[error(
        "{0} cannot be varied here: stepover belongs to overlaps, dwell to walls, angle to corners, starts and ends to single beads (--shape ends) and corners."
    )]
    Factor(Parameter),
    /// A weave where the torch does not weave.
    #[error("{0} cannot be varied with a profile that does not weave: set weave.length and weave.amplitude (--set).")]
    NoWeave(Parameter),
    /// A parameter that does nothing by itself.
    #[error("{own} changes nothing while {} is {idle}: set it (--set), or vary it too.", .partner.key().unwrap_or_default())]
    Idle {
        /// It.
        own: Parameter,
        /// What it needs.
        partner: Parameter,
        /// The value of that with which it does nothing.
        idle: f64,
    },
    /// A lead that reaches where the bead is measured.
    #[error(
        "trial {number}: its hot start or lead-out takes {lead} mm of a bead of {length} mm, which is measured in its middle: at most \
         a fifth is possible at each end. Make the trials longer (--length)."
    )]
    Lead {
        /// The first trial with such a lead.
        number: usize,
        /// Length of the lead, mm.
        lead: f64,
        /// Length of its bead, mm.
        length: f64,
    },
    /// A wire feed that a plan cannot have.
    #[error(
        "a wire feed of {feed:.2} m/min cannot be tried with a profile for {nominal:.2} m/min: a fifth to five times as much is \
         possible. Set process.wire_feed_speed nearer to it."
    )]
    Feed {
        /// It, m/min.
        feed: f64,
        /// The nominal one, m/min.
        nominal: f64,
    },
    /// A trial that does not fit.
    #[error(
        "trial {number} needs a plate of {:.0} × {:.0} mm, edges included, and the plate has {:.0} × {:.0} mm. Give a larger \
         one (--plate), or make the trials shorter (--length).",
        .needs.x, .needs.y, .plate.length, .plate.width
    )]
    Small {
        /// The first that does not fit.
        number: usize,
        /// The least size of a plate for it, mm.
        needs: DVec2,
        /// The plate.
        plate: Plate,
    },
}
