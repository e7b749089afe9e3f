//! Positions in a frame that does not turn with the part: that of the part with all axes of its positioner at 0.

use super::orientation::Turn;
use crate::program::{Attitude, Held, Positioner};
use glam::{DQuat, DVec3};

/// How a positioner holds the part while a program is written.
#[derive(Debug, Clone, Copy)]
pub(in crate::dialect) struct InCell {
    /// Rotation from the cell's directions to those of the frame.
    at_zero: DQuat,
    /// `None` without a positioner, and before the first move.
    held: Option<Held>,
}

impl InCell {
    pub(in crate::dialect) fn new(positioner: Option<&Positioner>) -> Self {
        let at_zero = |positioner: &Positioner| positioner.held([0.0; 2]).turn.inverse();
        Self { at_zero: positioner.map_or(DQuat::IDENTITY, at_zero), held: None }
    }

    /// Sets how the part is held from here on, and returns how the torch is to be turned.
    pub(in crate::dialect) fn stand(&mut self, attitude: Attitude) -> Turn {
        self.held = attitude.held.or(self.held);
        match self.held {
            Some(held) => Turn::By(self.at_zero * held.turn * attitude.rotation()),
            None => Turn::Attitude(attitude),
        }
    }

    /// Where a place of the part is in the frame, mm.
    pub(in crate::dialect) fn place(&self, of_part: DVec3) -> DVec3 {
        self.held.map_or(of_part, |held| self.at_zero * (held.turn * of_part + held.shift))
    }
}
