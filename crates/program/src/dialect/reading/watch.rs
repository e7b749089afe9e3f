//! Arc monitoring while a program is read: what strikes the arc, what is armed, what was checked, and whether the torch
//! has stopped.

use super::Place;
use super::fault::{BLENDED_SWITCH, Faults, UNWATCHED_ARC, UNWATCHED_END, UNWATCHED_START};

/// Monitoring of an arc that is struck by outputs; packages monitor theirs themselves.
#[derive(Debug, Clone, Default)]
pub(in crate::dialect) struct Watch {
    /// Whether outputs strike the arc, or did before.
    pub(in crate::dialect) by_outputs: bool,
    lit: bool,
    armed: bool,
    looked: bool,
    /// Whether metal was laid since the arc was struck.
    moved: bool,
    /// How the last move is blended into the next, if it is.
    blended: Option<String>,
    /// Whether the program waited for the torch since the last move.
    waited: bool,
}

impl Watch {
    /// An output switches the arc.
    pub(in crate::dialect) fn switch(&mut self, on: bool, faults: &mut Faults, place: Place) {
        if let Some(blend) = self.blended.as_ref().filter(|_| on != self.lit) {
            let what = if on { "struck" } else { "ended" };
            faults.add(&BLENDED_SWITCH, Some(place), format!("the arc is {what} after a move with {blend}."));
        }
        self.by_outputs |= on;
        (self.lit, self.moved) = (on, false);
        if on {
            self.looked = false;
        }
    }

    /// Monitoring is armed on the arc's input.
    pub(in crate::dialect) fn arm(&mut self) {
        (self.armed, self.looked) = (true, false);
    }

    /// Monitoring ends.
    pub(in crate::dialect) fn disarm(&mut self, how: &str, faults: &mut Faults, place: Place) {
        if self.armed && self.lit && self.moved && !self.waited {
            let text = format!("{how} comes directly after a move, which the robot has not made yet.");
            faults.add(&UNWATCHED_END, Some(place), text);
        }
        self.armed = false;
    }

    /// The program checks the arc's input.
    pub(in crate::dialect) fn look(&mut self) {
        self.looked = true;
    }

    /// The program waits for the robot.
    pub(in crate::dialect) fn wait(&mut self) {
        self.waited = true;
        self.blended = None;
    }

    /// The robot moves; `blended` says how the move blends into the next.
    pub(in crate::dialect) fn go(&mut self, blended: Option<&str>, faults: &mut Faults, place: Place) {
        if self.lit && !self.moved {
            if !self.armed {
                faults.add(&UNWATCHED_ARC, Some(place), "the torch leaves with the arc on, and nothing watches it.");
            } else if !self.looked {
                let text = "the watch is armed, but nothing checks whether the arc burns before the torch leaves.";
                faults.add(&UNWATCHED_START, Some(place), text);
            }
        }
        (self.moved, self.waited, self.blended) = (true, false, blended.map(str::to_owned));
    }
}
