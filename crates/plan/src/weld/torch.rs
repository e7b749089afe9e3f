//! Follows the torch: the travels between passes, the time that everything takes, and the waits.

use super::WeldSettings;
use super::path::ends_of;
use super::room::Room;
use crate::layer::{Layer, Lit};
use crate::motion::Motion;
use crate::pass::PassKind;
use crate::process::{Process, StartStop};
use bead_part::chart::{At, Chart, Sheet};
use glam::DVec3;

/// Waits are multiples of this, s; they are rounded up, never down.
const WAIT_STEP: f64 = 0.01;

/// Position of the torch, and the time since the layer began.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Torch {
    /// The process in the current layer, and that of the profile.
    process: Option<Process>,
    nominal: Option<Process>,
    /// How passes begin and end in general, and in the current layer, where the arc may stay lit.
    usual: StartStop,
    ends: StartStop,
    lit: Lit,
    motion: Option<Motion>,
    arc_end_time: Option<f64>,
    travel_speed: f64,
    /// The chart of each body, the body being welded, and the height of its layer's middle, mm.
    charts: Vec<Chart>,
    body: usize,
    middle: f64,
    /// The box around the welded bodies, if there are several.
    room: Room,
    clearance: f64,
    at: Option<DVec3>,
    /// Height of the end of the last pass, mm: travels stay clear of it.
    low: f64,
    /// Height of all that is built, mm: the travel to another part leads over it.
    highest: f64,
    /// Whether a layer has just begun.
    fresh: bool,
    /// Time since the layer began, s.
    seconds: f64,
}

/// A wait with the arc off.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pause {
    /// Position of the torch while it waits, mm.
    pub at: DVec3,
    /// How long, s.
    pub seconds: f64,
    /// Length of the move there, mm.
    pub length: f64,
    /// Time of the move there, s.
    pub moving: f64,
}

/// A travel with the arc off.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Way {
    /// Ends of its legs, mm.
    pub legs: Vec<DVec3>,
    /// Its length, mm; 0 for the travel to the first pass, which may come from anywhere.
    pub length: f64,
    /// Its time, s.
    pub moving: f64,
}

/// The path from the end of one body to the beginning of another, in space: out along the normal, around all that is
/// welded, and to a point straight above the new body's first pass.
#[derive(Debug, Clone, PartialEq)]
pub struct Transfer {
    /// Ends of its legs, and the torch's orientation there.
    pub legs: Vec<At>,
    /// Its length, mm.
    pub length: f64,
    /// Its time, s.
    pub moving: f64,
}

/// What comes before the first pass of a layer.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Begun {
    /// The travel to another body.
    pub transfer: Option<Transfer>,
    /// The wait after the previous layer.
    pub pause: Option<Pause>,
}

impl Begun {
    /// Length of the moves, mm.
    pub fn length(&self) -> f64 {
        self.transfer.as_ref().map_or(0.0, |way| way.length) + self.pause.map_or(0.0, |pause| pause.length)
    }

    /// Time of the moves, s.
    pub fn moving(&self) -> f64 {
        self.transfer.as_ref().map_or(0.0, |way| way.moving) + self.pause.map_or(0.0, |pause| pause.moving)
    }

    /// Time for which the torch waits, s.
    pub fn waiting(&self) -> f64 {
        self.pause.map_or(0.0, |pause| pause.seconds)
    }
}

/// The length of a pass and the times it takes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Welded {
    /// Its length, mm.
    pub length: f64,
    /// Time with the torch moving, s.
    pub moving: f64,
    /// The part of it lost to acceleration, s.
    pub slowed: f64,
    /// Time in which the nominal wire feed supplies its metal, including the crater's, s.
    pub metal: f64,
    /// Time for which the arc burns on the spot in the crater, s.
    pub crater: f64,
    /// Time for gas preflow and arc start before the torch moves, s.
    pub before: f64,
    /// Time for arc end, gas postflow and retracting the wire after the crater, s.
    pub after: f64,
}

impl Torch {
    /// A torch that counts travels but no times, and never waits; `clearance` is that of travels, mm.
    pub fn new(clearance: f64) -> Self {
        Self {
            process: None,
            nominal: None,
            usual: StartStop::default(),
            ends: StartStop::default(),
            lit: Lit::default(),
            motion: None,
            arc_end_time: None,
            travel_speed: f64::INFINITY,
            charts: vec![Chart::default()],
            body: 0,
            middle: 0.0,
            room: Room::default(),
            clearance,
            at: None,
            low: 0.0,
            highest: 0.0,
            fresh: false,
            seconds: 0.0,
        }
    }

    /// A torch that counts travels and times.
    pub fn of(settings: &WeldSettings) -> Self {
        let WeldSettings { process, ends, travel, motion, arc_end_time, standing, charts, base } = settings.clone();
        let mut room = Room::default();
        base.iter().flatten().for_each(|corner| room.add(*corner));
        Self {
            process: Some(process.at_layer(0)),
            nominal: Some(process),
            usual: ends.clone(),
            ends,
            motion,
            arc_end_time,
            travel_speed: travel.speed,
            charts,
            room,
            highest: standing,
            ..Self::new(travel.clearance)
        }
    }

    /// How passes of the current layer begin and end.
    pub fn ends(&self) -> &StartStop {
        &self.ends
    }

    /// Whether the arc stays lit before and after the pass of the current layer.
    pub fn lit(&self) -> Lit {
        self.lit
    }

    /// Whether all layers of all bodies are level.
    pub fn is_level(&self) -> bool {
        self.charts.iter().all(Chart::is_level)
    }

    /// The current layer in its chart; `None` if it is level.
    pub fn sheet(&self) -> Option<Sheet<'_>> {
        let chart = &self.charts[self.body];
        (!chart.is_level()).then(|| chart.sheet(self.middle))
    }

    /// Position, mm; `None` before the first pass.
    pub fn at(&self) -> Option<DVec3> {
        self.at
    }

    /// Speed at a pace, mm/s.
    pub fn speed_at(&self, pace: f64) -> f64 {
        self.process.as_ref().map_or(pace, |process| process.speed_at(pace))
    }

    /// Wire feed at a pace (mm/s), as a multiple of the nominal one.
    pub fn feed_at(&self, pace: f64) -> f64 {
        self.process.as_ref().map_or(1.0, |process| process.feed_at(pace))
    }

    /// Wire feed while a crater is filled, as a multiple of the nominal one.
    pub fn crater_feed(&self) -> f64 {
        self.ends.crater_power * self.process.as_ref().map_or(1.0, Process::rate)
    }

    /// Begins a layer at the pass with index `first`: the travel to it if it belongs to another body, and the wait that
    /// the previous layer needs, unless the arc stays lit. Does nothing if the layer has no passes.
    pub fn begin_layer(&mut self, layer: &Layer, first: usize) -> Begun {
        let (Some(start), lit) = (layer.passes.get(first).and_then(|pass| pass.start()), layer.lit) else {
            return Begun::default();
        };
        let transfer = self.move_to(layer, start);
        self.process = self.nominal.as_ref().map(|process| process.at_layer(layer.index));
        (self.fresh, self.lit, self.ends) = (true, lit, ends_of(layer, &self.usual));
        let missing = self.usual.min_layer_time - self.seconds;
        let waits = if lit.before { 0.0 } else { missing.max(self.usual.interpass_time) };
        let pause = self.pause(waits);
        // The wait belongs to neither layer.
        self.seconds = 0.0;
        Begun { transfer, pause }
    }

    /// Converts the torch's position to the coordinates of a layer whose first pass begins at `start`; travels if that
    /// is another body.
    fn move_to(&mut self, layer: &Layer, start: DVec3) -> Option<Transfer> {
        let (from, middle) = (self.charts[self.body].clone(), std::mem::replace(&mut self.middle, layer.middle()));
        if layer.body == self.body {
            let (here, there) = (from.sheet(self.middle), from.sheet(middle));
            self.at = self.at.map(|at| here.across(at.truncate(), &there).extend(at.z));
            return None;
        }
        self.body = layer.body.min(self.charts.len() - 1);
        (self.low, self.highest) = (0.0, 0.0);
        let at = from.sheet(middle).at(self.at.take()?);
        let entry = self.charts[self.body].sheet(self.middle);
        let above = start.with_z(start.z + self.room.out(&entry.at(start), self.clearance));
        let last = entry.at(above);
        let first = At { place: at.place + at.normal * self.room.out(&at, self.clearance), ..at };
        let around = self.room.around(first.place, last.place, self.clearance);
        let legs: Vec<At> =
            std::iter::once(first).chain(around.into_iter().map(|place| At { place, ..last })).collect();
        let (length, moving) = self.travel_from(at.place, legs.iter().map(|leg| leg.place));
        self.seconds += moving;
        self.at = Some(above);
        Some(Transfer { legs, length, moving })
    }

    /// Waits for `seconds` before a pass, above the part; `None` if there is no wait.
    pub fn wait(&mut self, seconds: f64) -> Option<Pause> {
        if self.lit.before {
            return None;
        }
        let pause = self.pause(seconds)?;
        self.seconds += pause.moving + pause.seconds;
        Some(pause)
    }

    fn pause(&mut self, seconds: f64) -> Option<Pause> {
        let seconds = (seconds.max(0.0) / WAIT_STEP - 1e-6).ceil() * WAIT_STEP;
        let from = self.at.filter(|_| seconds > 0.0)?;
        let at = from.with_z(from.z.max(self.low + self.clearance + self.usual.dwell_height));
        let (length, moving) = self.travel(&[at]);
        self.at = Some(at);
        Some(Pause { at, seconds, length, moving })
    }

    /// The travel to the start of a pass: up above the higher end, across, and down. Before the first pass there is no
    /// position to rise from. A layer that does not rise above the last one begins another part, and the travel leads
    /// over all that is built.
    ///
    /// ```
    /// use bead_plan::{pass::PassKind, weld::Torch};
    /// use glam::DVec3;
    ///
    /// // Up by the clearance, 4 mm across, and down again.
    /// let mut torch = Torch::new(5.0);
    /// torch.approach(DVec3::ZERO);
    /// torch.weld(PassKind::Infill, &[(DVec3::ZERO, 8.0), (DVec3::X * 40.0, 8.0)]);
    /// let way = torch.approach(DVec3::new(40.0, 4.0, 0.0));
    /// assert_eq!((way.legs.len(), way.length), (3, 5.0 + 4.0 + 5.0));
    /// ```
    pub fn approach(&mut self, start: DVec3) -> Way {
        if self.lit.before && self.at.is_some() {
            return Way::default();
        }
        self.turn_towards(start);
        let another = std::mem::take(&mut self.fresh) && start.z <= self.low;
        let below = if another || self.at.is_none() { self.highest } else { self.low };
        let high = below.max(start.z) + self.clearance;
        // After a wait the torch is already at least this high.
        let top = self.at.map_or(high, |at| at.z.max(high));
        let rise = self.at.map(|at| at.with_z(top));
        self.go(rise.into_iter().chain([start.with_z(top), start]))
    }

    /// Shifts the position by whole turns around the chart's axis so that the travel to a point is short.
    pub fn turn_towards(&mut self, to: DVec3) {
        let chart = &self.charts[self.body];
        let Some(at) = self.at.filter(|_| chart.goes_around()) else { return };
        let sheet = chart.sheet(self.middle);
        let turns = sheet.turns_to(at.truncate(), to.truncate()).round();
        self.at = Some(sheet.turned(at.truncate(), turns).map_or(at, |p| p.extend(at.z)));
    }

    /// The move up from the end of a pass: everything between passes happens above the fresh bead.
    pub fn retract(&mut self) -> Way {
        if self.lit.after {
            return Way::default();
        }
        let up = self.at.map(|at| at.with_z(at.z.max(self.low + self.clearance)));
        self.go(up.into_iter())
    }

    /// Travels; legs without length are left out.
    fn go(&mut self, legs: impl Iterator<Item = DVec3>) -> Way {
        let mut ends: Vec<DVec3> = self.at.into_iter().chain(legs).collect();
        ends.dedup();
        let legs = ends.split_off(usize::from(self.at.is_some()));
        let (length, moving) = self.travel(&legs);
        self.seconds += moving;
        self.at = legs.last().copied().or(self.at);
        Way { legs, length, moving }
    }

    /// Length and time of a travel from the torch's position, mm and s; each leg begins and ends at rest. The travel to
    /// the very first point counts as 0.
    fn travel(&self, legs: &[DVec3]) -> (f64, f64) {
        self.at.map_or((0.0, 0.0), |at| self.travel_from(at, legs.iter().copied()))
    }

    fn travel_from(&self, mut at: DVec3, legs: impl Iterator<Item = DVec3>) -> (f64, f64) {
        let (mut length, mut time) = (0.0, 0.0);
        for to in legs {
            let leg = at.distance(to);
            length += leg;
            time += self.motion.map_or(leg / self.travel_speed, |m| m.seconds(at, [(to, self.travel_speed)]));
            at = to;
        }
        (length, time)
    }

    /// Welds a pass from the torch's position: points and paces, as [`path`](super::path) gives them. A dot has no
    /// crater to fill.
    ///
    /// ```
    /// use bead_plan::{pass::PassKind, weld::Torch};
    /// use glam::DVec3;
    ///
    /// // 40 mm at 8 mm/s, then 40 mm at 4 mm/s.
    /// let moves = [(DVec3::ZERO, 8.0), (DVec3::X * 40.0, 8.0), (DVec3::X * 80.0, 4.0)];
    /// let welded = Torch::new(5.0).weld(PassKind::Infill, &moves);
    /// assert_eq!((welded.length, welded.moving), (80.0, 5.0 + 10.0));
    /// ```
    pub fn weld(&mut self, kind: PassKind, moves: &[(DVec3, f64)]) -> Welded {
        let (mut length, mut steady, mut metal) = (0.0, 0.0, 0.0);
        for ends in moves.windows(2) {
            let (piece, pace) = (ends[0].0.distance(ends[1].0), ends[1].1);
            length += piece;
            steady += piece / self.speed_at(pace);
            metal += piece / pace;
        }
        let speeds = moves.iter().skip(1).map(|&(to, pace)| (to, self.speed_at(pace)));
        let moving = match (&self.motion, moves.first()) {
            (Some(motion), Some(first)) => motion.seconds(first.0, speeds),
            _ => steady,
        };
        let crater = if kind == PassKind::Spot { 0.0 } else { self.ends.crater_fill_time };
        let filling = crater * self.crater_feed();
        let metal = metal + filling;
        let [before, after] = self.delays();
        let (before, after) = (if self.lit.before { 0.0 } else { before }, if self.lit.after { 0.0 } else { after });
        let welded = Welded { length, moving, slowed: moving - steady, metal, crater, before, after };
        self.seconds += before + moving + crater + after;
        if let Some(&(end, _)) = moves.last() {
            (self.at, self.low) = (Some(end), end.z);
            self.highest = moves.iter().fold(self.highest, |high, (place, _)| high.max(place.z));
            if self.charts.len() > 1 {
                let sheet = self.charts[self.body].sheet(self.middle);
                moves.iter().for_each(|(place, _)| self.room.add(sheet.at(*place).place));
            }
        }
        welded
    }

    /// Time for gas preflow and arc start, and for arc end, gas postflow and retracting the wire at its nominal speed,
    /// s per pass.
    fn delays(&self) -> [f64; 2] {
        let Some(process) = &self.process else { return [0.0; 2] };
        let end = || process.arc_end_delay + process.gas_postflow + retract_time(&self.usual, process);
        [process.gas_preflow + process.arc_start_delay, self.arc_end_time.unwrap_or_else(end)]
    }
}

/// Time to retract the wire at its nominal speed, s.
pub fn retract_time(ends: &StartStop, process: &Process) -> f64 {
    ends.wire_retract / (process.wire_feed_speed * 1000.0 / 60.0)
}
