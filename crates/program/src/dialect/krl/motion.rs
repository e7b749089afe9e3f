//! Interprets the motions of KRL.

use super::read::Reader;
use super::words::{Motion, Target, number_before, with_speed};
use crate::dialect::reading::fault::{RAPID_WITH_ARC, TURNING_TORCH};
use crate::dialect::reading::trace::{Stated, Step};
use crate::dialect::reading::words::{arguments, name, strip_word};
use crate::dialect::reading::{ReadError, words};
use glam::{DQuat, DVec3, EulerRot};

impl Reader<'_> {
    pub(super) fn motion(&mut self, motion: Motion, rest: &str, number: usize, source: usize) -> Result<(), ReadError> {
        let pieces = arguments(rest);
        let at = |i: usize| pieces.get(i).copied().unwrap_or_default();
        if motion.free && self.trace.arc {
            let place = self.trace.place(number);
            return Err(ReadError::UnknownCurve { place, word: "SPL", instead: "SLIN and SCIRC" });
        }
        if motion.free {
            self.trace.note(
                "SPL",
                "runs on a curve that only the controller knows and was read as a straight move",
                number,
            );
        }
        let mut targets = [None; 2];
        for (i, target) in targets.iter_mut().enumerate().take(if motion.circular { 2 } else { 1 }) {
            let Some(found) = self.target(at(i), number, source)? else {
                self.trace.note("a motion to a place that is computed or not declared", "was left out", number);
                self.trace.forget();
                return Ok(());
            };
            *target = Some(found);
        }
        let blend =
            ["C_DIS", "C_SPL", "C_VEL", "C_ORI", "C_PTP"].into_iter().find(|word| rest.to_uppercase().ends_with(word));
        let place = self.trace.place(number);
        if self.forms {
            self.trace.watch.wait();
        } else {
            self.trace.watch.go(blend, &mut self.trace.faults, place.clone());
        }
        if motion.joint && self.trace.arc {
            self.trace.faults.add(&RAPID_WITH_ARC, Some(place), "the joints move with the arc on.");
        }
        let speed = with_speed(rest).unwrap_or(if motion.joint { 0.0 } else { self.block_speed.unwrap_or(self.speed) });
        let step = Step { speed, metal: self.trace.metal(), width: None, line: number };
        let what = at(0).split(['{', '[']).next().map(str::trim).filter(|name| !name.is_empty());
        let what = what.map_or_else(|| "a target".to_owned(), str::to_owned);
        if let Some(last) = targets.iter().rev().find_map(|target| *target).filter(|_| !motion.relative) {
            match last.place {
                Some(to) => {
                    let to = self.whole(motion, to);
                    self.trace.stand(&last.stated, to, &what, number);
                }
                None => self.trace.home(&last.stated.axes, &what, number),
            }
        }
        match targets.map(|target| target.map(|target| target.place)) {
            [Some(Some(aux)), Some(Some(end))] => {
                if self.circle_by_path && self.trace.arc {
                    let place = Some(self.trace.place(number));
                    let text = "$CIRC_TYPE = #PATH carries the torch along with the arc's tangent.";
                    self.trace.faults.add(&TURNING_TORCH, place, text);
                }
                self.circle(motion, [aux, end], &pieces, step)?;
            }
            [Some(Some(to)), None] => self.trace.line(self.absolute(motion, to), step),
            _ => {
                let what = "a motion to axis angles";
                self.trace.note(what, "goes to a place that is unknown here and was left out", number);
                self.trace.forget();
            }
        }
        if let Some(on) = self.later.take() {
            self.trace.set_arc(on, number);
        }
        Ok(())
    }

    fn circle(
        &mut self,
        motion: Motion,
        ends: [[Option<f64>; 3]; 2],
        pieces: &[&str],
        step: Step,
    ) -> Result<(), ReadError> {
        let [aux, end] = ends.map(|target| self.whole(motion, target));
        let angle = pieces.iter().find_map(|p| strip_word(p, "CA"));
        let angle = match angle {
            Some(text) => Some(number_before(text).ok_or_else(|| self.trace.number_error(step.line, text))?),
            None => None,
        };
        self.trace.arc_over(aux, end, angle.map(f64::to_radians), step);
        Ok(())
    }

    /// A target in which omitted axes keep their current values.
    fn whole(&self, motion: Motion, target: [Option<f64>; 3]) -> DVec3 {
        let (target, start) = (self.absolute(motion, target), self.trace.at);
        DVec3::from_array([0, 1, 2].map(|i| target[i].unwrap_or(start[i])))
    }

    fn absolute(&self, motion: Motion, target: [Option<f64>; 3]) -> [Option<f64>; 3] {
        let at = self.trace.at;
        [0, 1, 2].map(|i| target[i].map(|v| if motion.relative { at[i] + v } else { v }))
    }

    /// A target written out or named; `None` if it is neither.
    fn target(&self, text: &str, number: usize, source: usize) -> Result<Option<Target>, ReadError> {
        if text.starts_with('{') {
            return self.aggregate(text, number).map(Some);
        }
        let (name, rest) = name(text);
        if rest.starts_with([':', '[', '.', '(']) {
            return Ok(None);
        }
        let name = name.to_ascii_uppercase();
        // Data of the main program may be global.
        Ok([source, 0].iter().find_map(|&s| self.sources[s].targets.get(&name)).copied())
    }

    /// `{X 1.0,Y 2.0,..}` or `{A1 0.0,..}`, perhaps with its type before a colon.
    pub(super) fn aggregate(&self, text: &str, number: usize) -> Result<Target, ReadError> {
        let inside = text.trim_start().trim_start_matches('{').split('}').next().unwrap_or_default();
        let inside = inside.split_once(':').map_or(inside, |(_, fields)| fields);
        let (mut place, mut turns, mut stated, mut joints) = ([None; 3], [None; 3], Stated::default(), false);
        for field in inside.split(',') {
            let (axis, value) = name(field.trim());
            let letter = |letters: [&str; 3]| letters.iter().position(|a| a.eq_ignore_ascii_case(axis));
            let external =
                axis.strip_prefix(['E', 'e']).and_then(|n| n.parse::<usize>().ok()).filter(|n| (1..=6).contains(n));
            if let Some(i) = letter(["X", "Y", "Z"]) {
                let value = words::number(value).ok_or_else(|| self.trace.number_error(number, field));
                place[i] = Some(value?);
            } else if let Some(i) = letter(["A", "B", "C"]) {
                turns[i] = words::number(value);
            } else if let Some(n) = external {
                stated.axes[n - 1] = words::number(value);
            } else {
                joints |= axis.len() == 2 && axis.starts_with(['A', 'a']);
            }
        }
        if let [Some(a), Some(b), Some(c)] = turns.map(|turn| turn.map(f64::to_radians)) {
            stated.tool = Some(DQuat::from_euler(EulerRot::ZYX, a, b, c));
        }
        Ok(Target { place: (!joints).then_some(place), stated })
    }
}
