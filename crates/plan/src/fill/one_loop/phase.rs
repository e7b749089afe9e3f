//! Phase: a field that is 1 on the first ring, 2 on the second, and so on, and half-way between two whole numbers in
//! the middle of every wall.
//!
//! u = (D − e + φ)/d + ½, with D the distance from the outline. φ is harmonic, 0 on the outline, and in the middle
//! pulled softly towards the amount missing for a whole number of rings. Where the width is a whole number of beads, φ
//! is 0 and the rings are plain offsets.

use super::LoopSettings;
use super::room::{HALVINGS, Room};
use planar::lattice::Lattice;

/// Strength with which φ is held in the middle, per bead width.
const HOLD: f32 = 9.6;
/// Sweeps on each lattice, from the coarsest to the finest.
const SWEEPS: usize = 12;
/// Each step is this many times the step to the local solution (successive over-relaxation).
const OVER: f32 = 1.5;

/// The field, as 32-bit floats on the room's lattice; below ½ outside.
pub fn phase(room: &Room, counts: &[u32], settings: &LoopSettings) -> Vec<f32> {
    let (d, e) = (settings.stepover, settings.edge());
    let mut pins = Pins { weight: vec![0.0; room.lattice.len()], value: vec![0.0; room.lattice.len()] };
    let hold = HOLD * (room.lattice.step / settings.bead_width) as f32;
    for (middle, &count) in room.middles.iter().zip(counts) {
        if middle.radius > e {
            pins.weight[middle.point] = hold;
            pins.value[middle.point] = (f64::from(count) * d - (middle.radius - e)) as f32;
        }
    }
    let free: Vec<bool> = room.distance.iter().map(|&distance| f64::from(distance) > e).collect();
    // φ is smooth: every second lattice point is enough.
    let (coarse, coarse_free, coarse_pins) = halved(&room.lattice, &free, &pins);
    let phi = harmonic(&coarse, &coarse_free, &coarse_pins, HALVINGS - 1);
    let phi = refined(&room.lattice, &coarse, &phi, &free);
    let (e, d) = (e as f32, d as f32);
    room.distance.iter().zip(&phi).map(|(&distance, &phi)| (distance - e + phi) / d + 0.5).collect()
}

struct Pins {
    weight: Vec<f32>,
    value: Vec<f32>,
}

/// The harmonic field that is 0 at fixed points and pulled towards the pins; solved on lattices from coarse to fine,
/// each starting from the previous one.
fn harmonic(lattice: &Lattice, free: &[bool], pins: &Pins, halvings: u32) -> Vec<f32> {
    let mut field = if halvings == 0 {
        vec![0.0; lattice.len()]
    } else {
        let (coarse, coarse_free, coarse_pins) = halved(lattice, free, pins);
        let field = harmonic(&coarse, &coarse_free, &coarse_pins, halvings - 1);
        refined(lattice, &coarse, &field, free)
    };
    let columns = lattice.columns;
    let sweeps = if halvings == 0 { 4 * SWEEPS } else { SWEEPS };
    for sweep in 0..sweeps {
        for parity in [sweep % 2, 1 - sweep % 2] {
            for row in 1..lattice.rows - 1 {
                let first = row * columns + 1 + (row + parity) % 2;
                for i in (first..(row + 1) * columns - 1).step_by(2) {
                    if free[i] {
                        let sum = field[i - 1] + field[i + 1] + field[i - columns] + field[i + columns];
                        let weight = pins.weight[i];
                        let new = (sum + weight * pins.value[i]) / (4.0 + weight);
                        field[i] += OVER * (new - field[i]);
                    }
                }
            }
        }
    }
    field
}

fn halved(lattice: &Lattice, free: &[bool], pins: &Pins) -> (Lattice, Vec<bool>, Pins) {
    let coarse = lattice.halved();
    let mut result = Pins { weight: vec![0.0; coarse.len()], value: vec![0.0; coarse.len()] };
    let mut coarse_free = vec![false; coarse.len()];
    for row in 0..coarse.rows {
        for column in 0..coarse.columns {
            coarse_free[row * coarse.columns + column] = free[2 * row * lattice.columns + 2 * column];
        }
    }
    for (i, &weight) in pins.weight.iter().enumerate().filter(|(_, weight)| **weight > 0.0) {
        // A pin between coarse points is shared among them.
        let (row, column) = (i / lattice.columns, i % lattice.columns);
        for r in [row / 2, row.div_ceil(2)] {
            for c in [column / 2, column.div_ceil(2)] {
                result.weight[r * coarse.columns + c] += weight / 4.0;
                result.value[r * coarse.columns + c] += weight / 4.0 * pins.value[i];
            }
        }
    }
    for (value, weight) in result.value.iter_mut().zip(&result.weight) {
        if *weight > 0.0 {
            *value /= weight;
        }
    }
    (coarse, coarse_free, result)
}

fn refined(lattice: &Lattice, coarse: &Lattice, field: &[f32], free: &[bool]) -> Vec<f32> {
    let mut fine = vec![0.0; lattice.len()];
    for row in 0..lattice.rows {
        let (r, odd_row) = (row / 2 * coarse.columns, row % 2);
        for column in 0..lattice.columns {
            let i = row * lattice.columns + column;
            if free[i] {
                let (c, odd) = (column / 2, column % 2);
                let low = 0.5 * (field[r + c] + field[r + c + odd]);
                let above = r + odd_row * coarse.columns;
                fine[i] = 0.5 * (low + 0.5 * (field[above + c] + field[above + c + odd]));
            }
        }
    }
    fine
}
