//! What was planned: passes with their path in space and time.

use crate::error::RecordError;
use crate::quantity::Quantity;
use glam::DVec3;

/// A place along a planned pass; feed and speed hold up to the next place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// Where, mm.
    pub at: DVec3,
    /// When the torch is there, s from the start of the build.
    pub time: f64,
    /// Wire feed from here on, m/min.
    pub feed: f64,
    /// Speed of the torch from here on, mm/s.
    pub speed: f64,
}

/// A planned pass, arc on to arc off.
#[derive(Debug, Clone, PartialEq)]
pub struct PlannedPass {
    /// Layer, from 1.
    pub layer: usize,
    /// Pass in its layer, from 1.
    pub pass: usize,
    /// When the arc is struck, s from the start of the build; the torch may still wait.
    pub struck: f64,
    /// When it goes out, s.
    pub out: f64,
    /// The path, at least one place, with times that do not decrease, between `struck` and `out`.
    pub path: Vec<Place>,
    /// Current, A, where it is known.
    pub current: Option<f64>,
    /// Voltage, V, where it is known.
    pub voltage: Option<f64>,
    /// Temperature of the metal where it begins, just before, °C, where it was computed.
    pub temperature: Option<f64>,
}

/// A place of a pass that is not one of its corners.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Spot {
    /// Distance along the pass, mm.
    pub along: f64,
    /// Where, mm.
    pub at: DVec3,
}

/// Planned times are equal within this, s.
const SAME: f64 = 1e-6;

impl PlannedPass {
    /// Length, mm.
    pub fn length(&self) -> f64 {
        self.path.windows(2).map(|pair| pair[0].at.distance(pair[1].at)).sum()
    }

    /// Time for which the arc burns, s.
    pub fn seconds(&self) -> f64 {
        self.out - self.struck
    }

    /// Where the torch is at a planned time, s; before and after the path it is at its ends.
    pub fn spot(&self, time: f64) -> Spot {
        let mut along = 0.0;
        for pair in self.path.windows(2) {
            let length = pair[0].at.distance(pair[1].at);
            if time < pair[1].time {
                let part = ((time - pair[0].time) / (pair[1].time - pair[0].time)).clamp(0.0, 1.0);
                return Spot { along: along + part * length, at: pair[0].at.lerp(pair[1].at, part) };
            }
            along += length;
        }
        Spot { along, at: self.path.last().map_or(DVec3::ZERO, |last| last.at) }
    }

    /// Places `step` mm apart along the pass, from its beginning: when the torch is there, s, and where. None unless `step` is positive.
    ///
    /// ```
    /// use bead_record::{Place, PlannedPass};
    /// use glam::DVec3;
    ///
    /// let place = |x: f64, y: f64, time: f64| Place { at: DVec3::new(x, y, 2.0), time, feed: 8.0, speed: 8.0 };
    /// // 20 mm along x in 2 s, then 30 mm along y in 1 s.
    /// let path = vec![place(0.0, 0.0, 5.0), place(20.0, 0.0, 7.0), place(20.0, 30.0, 8.0)];
    /// let pass = PlannedPass {
    ///     layer: 1, pass: 1, struck: 5.0, out: 8.0, path, current: None, voltage: None, temperature: None,
    /// };
    /// let places = pass.every(12.5);
    /// assert_eq!(places.len(), 5);
    /// assert_eq!((places[1].0, places[1].1.at), (6.25, DVec3::new(12.5, 0.0, 2.0)));
    /// assert_eq!((places[4].0, places[4].1.along), (8.0, 50.0));
    /// assert_eq!(places[2].1.at, DVec3::new(20.0, 5.0, 2.0));
    /// ```
    pub fn every(&self, step: f64) -> Vec<(f64, Spot)> {
        let (mut places, mut passed, mut along) = (Vec::new(), 0.0, 0.0);
        for pair in self.path.windows(2).filter(|_| step > 0.0) {
            let length = pair[0].at.distance(pair[1].at);
            while along <= passed + length {
                let part = if length > 0.0 { (along - passed) / length } else { 0.0 };
                let time = pair[0].time + part * (pair[1].time - pair[0].time);
                places.push((time, Spot { along, at: pair[0].at.lerp(pair[1].at, part) }));
                along = places.len() as f64 * step;
            }
            passed += length;
        }
        places
    }

    /// The path between two planned times.
    pub fn stretch(&self, from: f64, to: f64) -> Vec<DVec3> {
        let inside = self.path.iter().filter(|place| place.time > from && place.time < to).map(|place| place.at);
        [self.spot(from).at].into_iter().chain(inside).chain([self.spot(to).at]).collect()
    }

    /// The planned value of a quantity at a planned time, s; `None` where the plan does not prescribe it.
    pub fn value(&self, quantity: Quantity, time: f64) -> Option<f64> {
        let place = || {
            let next = self.path.partition_point(|place| place.time <= time);
            self.path.get(next.saturating_sub(1))
        };
        match quantity {
            Quantity::Feed => place().map(|place| place.feed),
            Quantity::Speed => place().map(|place| place.speed),
            Quantity::Current => self.current,
            Quantity::Voltage => self.voltage,
            Quantity::Temperature | Quantity::Arc => None,
        }
    }

    /// Mean of a planned quantity over the time of the path; of the speed, that with which the torch covers the whole path.
    pub fn mean(&self, quantity: Quantity) -> Option<f64> {
        let pieces = || self.path.windows(2).map(|pair| (pair[1].time - pair[0].time, pair[0].feed));
        let time: f64 = pieces().map(|(time, _)| time).sum();
        match quantity {
            Quantity::Speed if time > 0.0 => Some(self.length() / time),
            Quantity::Feed if time > 0.0 => Some(pieces().map(|(time, feed)| time * feed).sum::<f64>() / time),
            _ => self.value(quantity, self.struck),
        }
    }

    fn check(&self) -> Result<(), RecordError> {
        let fault = |reason| Err(RecordError::Pass { layer: self.layer, pass: self.pass, reason });
        let (Some(first), Some(last)) = (self.path.first(), self.path.last()) else {
            return fault("it has no places");
        };
        let finite =
            |place: &Place| place.at.is_finite() && [place.time, place.feed, place.speed].iter().all(|v| v.is_finite());
        if !self.path.iter().all(finite) {
            return fault("a place, time, feed or speed is not a finite number");
        }
        if self.path.windows(2).any(|pair| pair[1].time < pair[0].time - SAME) {
            return fault("its times decrease");
        }
        if !(self.struck <= first.time + SAME && last.time <= self.out + SAME) {
            return fault("the torch moves before the arc burns, or after it");
        }
        Ok(())
    }
}

/// An error unless the passes follow one another in time.
pub(crate) fn check(passes: &[PlannedPass]) -> Result<(), RecordError> {
    if passes.is_empty() {
        return Err(RecordError::NoPasses);
    }
    passes.iter().try_for_each(PlannedPass::check)?;
    match passes.windows(2).find(|pair| pair[1].struck < pair[0].out - SAME) {
        Some(pair) => {
            let (layer, pass) = (pair[1].layer, pair[1].pass);
            Err(RecordError::Pass { layer, pass, reason: "it begins before the pass before it ends" })
        }
        None => Ok(()),
    }
}
