//! A program's passes by layer, and its totals.

use super::{Metal, Move, ReadProgram};
use bead_plan::motion::Motion;
use glam::DVec3;

/// Passes whose first points differ by no more than this in z belong to one layer, mm: programs round coordinates, and
/// spirals begin a little above the layer below.
const SAME_Z_MM: f64 = 0.01;

/// Consecutive deposited moves of `n` points.
#[derive(Debug, Clone, PartialEq)]
pub struct ReadPass {
    /// Centre-line of the bead, mm.
    pub points: Vec<DVec3>,
    /// Speed between two points, mm/s, 0 if unknown; n − 1 values.
    pub speed: Vec<f64>,
    /// Volume laid between two points, if the program gives it, mm³; n − 1 values.
    pub volume: Vec<Option<f64>>,
    /// Bead width between two points, if the program gives it, mm; n − 1 values.
    pub width: Vec<Option<f64>>,
    /// Line of the first deposited move, from 1.
    pub line: usize,
}

/// Passes that begin at one height.
#[derive(Debug, Clone, PartialEq)]
pub struct ReadLayer {
    /// Height at which the passes begin, mm.
    pub z: f64,
    /// Rise above the layer below, mm; for the lowest layer its z if positive, otherwise the rise of the next. 0 if
    /// unknown.
    pub height: f64,
    /// Passes in the order of the program.
    pub passes: Vec<ReadPass>,
}

/// Totals of a program.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ReadTotals {
    /// Runs of deposited moves.
    pub arc_starts: usize,
    /// Length of the deposited moves, mm.
    pub deposited_length_mm: f64,
    /// Length of all other moves, mm.
    pub travel_length_mm: f64,
    /// Time of the moves with known speed and of all waits, s; without acceleration.
    pub time_s: f64,
    /// Volume of metal, if the program gives it, mm³.
    pub volume_mm3: Option<f64>,
}

impl ReadProgram {
    /// The passes by layer, lowest layer first. A pass belongs to the height of its first point, even if it rises (vase
    /// mode); a program that returns to a height adds to the layer already there.
    ///
    /// ```
    /// use bead_program::dialect::reading::{Options, read};
    ///
    /// let text = "G21 G90\nG0 X0 Y0 Z2\nM3 S1\nG1 X30 F600\nM5\nG0 Z4\nG0 X0\nM3 S1\nG1 X30\nM5\n";
    /// let layers = read(text, &mut |_| None, &Options::default())?.layers();
    /// assert_eq!(layers.iter().map(|layer| (layer.z, layer.height)).collect::<Vec<_>>(), [(2.0, 2.0), (4.0, 2.0)]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn layers(&self) -> Vec<ReadLayer> {
        let passes = self.passes();
        let mut order: Vec<(f64, usize)> = passes.iter().map(height).zip(0..).collect();
        order.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut layers: Vec<ReadLayer> = Vec::new();
        let mut layer_of = vec![0; passes.len()];
        for (z, pass) in order {
            if layers.last().is_none_or(|layer| z - layer.z > SAME_Z_MM) {
                layers.push(ReadLayer { z, height: 0.0, passes: Vec::new() });
            }
            layer_of[pass] = layers.len() - 1;
        }
        for (pass, layer) in passes.into_iter().zip(layer_of) {
            layers[layer].passes.push(pass);
        }
        set_heights(&mut layers);
        layers
    }

    /// Arc starts, lengths, time and volume.
    pub fn totals(&self) -> ReadTotals {
        let mut totals = ReadTotals { time_s: self.dwell, ..ReadTotals::default() };
        let mut before: Option<&Move> = None;
        for step in &self.moves {
            let length = before.map_or(0.0, |b| b.to.distance(step.to));
            if step.speed > 0.0 {
                totals.time_s += length / step.speed;
            }
            if step.metal.is_laid() {
                totals.arc_starts += usize::from(!before.is_some_and(|b| b.metal.is_laid()));
                totals.deposited_length_mm += length;
            } else {
                totals.travel_length_mm += length;
            }
            if let Some(volume) = volume(step) {
                *totals.volume_mm3.get_or_insert(0.0) += volume;
            }
            before = Some(step);
        }
        totals
    }

    /// Time of all moves with known speed, with acceleration, and of all waits, s. Every run of deposited moves and
    /// every run of other moves begins and ends at rest.
    pub fn seconds(&self, motion: &Motion) -> f64 {
        let Some(first) = self.moves.first() else { return self.dwell };
        let (mut at, mut time) = (first.to, self.dwell);
        for run in self.moves[1..].chunk_by(|a, b| a.metal.is_laid() == b.metal.is_laid()) {
            time += motion.seconds(at, run.iter().map(|m| (m.to, m.speed)));
            at = run.last().map_or(at, |m| m.to);
        }
        time
    }

    /// Runs of deposited moves in order.
    fn passes(&self) -> Vec<ReadPass> {
        let mut passes: Vec<ReadPass> = Vec::new();
        let mut before: Option<&Move> = None;
        for step in &self.moves {
            if step.metal.is_laid() {
                let goes_on = before.is_some_and(|b| b.metal.is_laid());
                match passes.last_mut() {
                    Some(pass) if goes_on => extend(pass, step),
                    _ => passes.push(begin(before.map_or(step.to, |b| b.to), step)),
                }
            }
            before = Some(step);
        }
        passes
    }
}

fn begin(from: DVec3, step: &Move) -> ReadPass {
    let mut pass =
        ReadPass { points: vec![from], speed: Vec::new(), volume: Vec::new(), width: Vec::new(), line: step.line };
    extend(&mut pass, step);
    pass
}

fn extend(pass: &mut ReadPass, step: &Move) {
    pass.points.push(step.to);
    pass.speed.push(step.speed);
    pass.volume.push(volume(step));
    pass.width.push(step.width);
}

fn volume(step: &Move) -> Option<f64> {
    match step.metal {
        Metal::Volume(volume) => Some(volume),
        Metal::Arc | Metal::Off => None,
    }
}

fn height(pass: &ReadPass) -> f64 {
    pass.points.first().map_or(0.0, |p| p.z)
}

fn set_heights(layers: &mut [ReadLayer]) {
    let z: Vec<f64> = layers.iter().map(|l| l.z).collect();
    for (i, layer) in layers.iter_mut().enumerate() {
        layer.height = match i {
            0 if layer.z > SAME_Z_MM => layer.z,
            0 => z.get(1).map_or(0.0, |next| next - layer.z),
            _ => layer.z - z[i - 1],
        };
    }
}
