//! The neutral program: moves, arc on, arc off, wire feed, waits. Dialects turn it into a controller's language.
//!
//! Coordinates are rounded to [`RESOLUTION_MM`] here, once, and points closer than [`MIN_MOVE_MM`] to the last one are
//! dropped: a weld move of zero length burns through. Then, if requested, straight pieces and circular arcs are fitted
//! within a tolerance ([`Programmer::with_fit`]): fewer moves along the same path. A dry run has the same moves without
//! arc: `Weld` is then just a move along the path, since no `ArcOn` precedes it.

mod attitude;
mod holder;
mod machine;
mod placed;
mod positioner;
mod safety;
mod settings;
mod spread;
mod table;
mod tilt;
mod turning;
mod turns;
mod weave;

pub use attitude::Attitude;
use holder::Holder;
pub use machine::{MACHINES, Machine};
pub use positioner::{Held, Positioner, PositionerAxis, Turning};
pub use safety::Safety;
pub use settings::ProgramSettings;
pub use turns::Turns;
use weave::Swing;
pub use weave::{LayerWeave, Weave};

use crate::number;
use bead_plan::layer::Layer;
use bead_plan::pass::{Pass, PassKind};
use bead_plan::process::Follow;
use bead_plan::weld::{Begun, Pause, Torch, WeldSettings, path};
use glam::{DVec2, DVec3};
use planar::arcs::{Fit, Piece};
use spread::Spread;
use table::Follower;
pub use tilt::Tilt;

/// Coordinates of a program are multiples of this, mm.
pub const RESOLUTION_MM: f64 = 1e-3;

/// No two points of a pass lie closer together than this, mm.
pub const MIN_MOVE_MM: f64 = 0.01;

/// One step of a program. The arc is off until `ArcOn`, and `ArcOff` comes before the next move with the arc off.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Instruction {
    /// The first move, from wherever the machine is to a point above the part: a joint move, not along a line.
    Approach {
        /// Tool point, mm.
        to: DVec3,
    },
    /// A straight move with the arc off, at travel speed; ends with an exact stop.
    Travel {
        /// Tool point, mm.
        to: DVec3,
    },
    /// A straight move up from the end of a pass, at travel speed; ends with an exact stop. A program may be cut after
    /// it.
    Retract {
        /// Tool point, mm.
        to: DVec3,
    },
    /// A pass begins; the torch is above the part, or anywhere if the program begins at this pass.
    PassStart {
        /// Number of the pass in its layer, from 1.
        pass: usize,
        /// A point above its start to which the torch can come from anywhere, mm.
        above: DVec3,
        /// The attitude of torch and part on the way to the start and there.
        attitude: Attitude,
    },
    /// The torch is above the start of the pass. The instructions since `PassStart` led there from the previous pass; a
    /// program that begins at this pass skips them.
    Above,
    /// The pass is done; the torch is above the part.
    PassEnd,
    /// Strikes the arc at the start of a pass.
    ArcOn {
        /// Number of the pass in its layer, from 1.
        pass: usize,
        /// What the pass is for.
        kind: PassKind,
    },
    /// The wire feed from here on; nominal at first. Written where the wire feed changes, and only in programs whose
    /// profile allows it to change.
    WireFeed {
        /// Multiple of the nominal wire feed.
        ratio: f64,
    },
    /// The attitude of torch and part at the end of the next move and from there on.
    Turn {
        /// The attitude.
        attitude: Attitude,
    },
    /// A move with the arc on.
    Weld {
        /// Tool point, mm.
        to: DVec3,
        /// The circle along which it moves there; `None` for a straight move.
        circle: Option<Circle>,
        /// Deposition speed, mm/s.
        speed: f64,
        /// Whether the pass ends here, with an exact stop.
        last: bool,
        /// The attitude of torch and part at its end; it stays so until the next `Weld` or `PassStart`.
        attitude: Attitude,
    },
    /// The arc burns on the spot, at the end of a pass, to fill its crater.
    Crater {
        /// How long, s.
        seconds: f64,
        /// The wire feed meanwhile, as a fraction of the nominal wire feed; `None` if it is unchanged.
        ratio: Option<f64>,
    },
    /// Ends the arc.
    ArcOff {
        /// Number of the pass in its layer, from 1.
        pass: usize,
    },
    /// The torch waits with the arc off until the next layer or pass may begin.
    Dwell {
        /// How long, s.
        seconds: f64,
    },
}

impl Instruction {
    /// The point to which it moves the torch, mm; `None` if it does not move.
    pub fn target(&self) -> Option<DVec3> {
        match *self {
            Self::Approach { to } | Self::Travel { to } | Self::Retract { to } | Self::Weld { to, .. } => Some(to),
            _ => None,
        }
    }

    /// The attitude it sets.
    fn attitude_mut(&mut self) -> Option<&mut Attitude> {
        match self {
            Self::PassStart { attitude, .. } | Self::Turn { attitude } | Self::Weld { attitude, .. } => Some(attitude),
            _ => None,
        }
    }

    /// The attitude of torch and part from here on; `None` if it does not change.
    pub fn attitude(&self) -> Option<Attitude> {
        match *self {
            Self::PassStart { attitude, .. } | Self::Turn { attitude } | Self::Weld { attitude, .. } => Some(attitude),
            _ => None,
        }
    }
}

/// A circular arc in a plane of constant height, from where the torch is; less than half a turn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Circle {
    /// A point near the middle of the arc, mm. The circle is the one through its start, this point and its end, as
    /// rounded.
    pub via: DVec3,
    /// Its centre, mm.
    pub centre: DVec3,
    /// Its radius, mm.
    pub radius: f64,
    /// Angle of the arc, radians; above 0 it is counter-clockwise as seen from above.
    pub sweep: f64,
}

impl Circle {
    /// Length of the arc, mm.
    ///
    /// ```
    /// use bead_program::program::Circle;
    /// use glam::DVec3;
    /// use std::f64::consts::{FRAC_PI_2, SQRT_2};
    ///
    /// // A quarter of a turn, clockwise, on a radius of 10 mm.
    /// let via = DVec3::new(10.0 / SQRT_2, 10.0 / SQRT_2, 0.0);
    /// let quarter = Circle { via, centre: DVec3::ZERO, radius: 10.0, sweep: -FRAC_PI_2 };
    /// assert!((quarter.length() - 5.0 * std::f64::consts::PI).abs() < 1e-9);
    /// assert_eq!(quarter.word(), "G2");
    /// ```
    pub fn length(&self) -> f64 {
        self.radius * self.sweep.abs()
    }

    /// The G-code word that runs it: G2 clockwise, G3 counter-clockwise.
    pub fn word(&self) -> &'static str {
        if self.sweep < 0.0 { "G2" } else { "G3" }
    }
}

/// The instructions of one layer.
#[derive(Debug, Clone, PartialEq)]
pub struct LayerProgram {
    /// Index from 0.
    pub index: usize,
    /// Top of the layer, mm.
    pub z: f64,
    /// Instructions in order.
    pub instructions: Vec<Instruction>,
}

/// Turns layers into instructions, keeping track of the torch.
#[derive(Debug, Clone)]
pub struct Programmer {
    torch: Torch,
    /// Whether instructions are transformed from the layer's chart to space.
    placed: bool,
    fit: Option<Fit>,
    speed_tolerance: f64,
    /// The wire feed last set, as a multiple of the nominal one; `None` if unknown.
    feed: Option<f64>,
    sets_feed: bool,
    /// Whether programs may begin at any pass.
    restarts: bool,
    dry: bool,
    spread: Option<Spread>,
    tilt: Option<Tilt>,
    table: Option<Follower>,
    positioner: Option<Holder>,
    /// The weave, if it is written as moves, and that of the current layer.
    weave: Option<Weave>,
    swung: Option<Weave>,
}

impl Programmer {
    /// Programs passes as planned; travels run `clearance` (mm) above the higher of their ends.
    pub fn new(clearance: f64) -> Self {
        let torch = Torch::new(clearance);
        Self {
            torch,
            placed: true,
            fit: None,
            speed_tolerance: 0.0,
            feed: None,
            sets_feed: false,
            restarts: false,
            dry: false,
            spread: None,
            tilt: None,
            table: None,
            positioner: None,
            weave: None,
            swung: None,
        }
    }

    /// Programs passes as welded; a dry run has the same moves without arc.
    pub fn of(weld: &WeldSettings, program: &ProgramSettings, dry: bool) -> Self {
        let other_layers = weld.process.feeds_by_layer();
        let sets_feed = weld.process.follow == Follow::WireFeed || weld.ends.crater_is_weaker() || other_layers;
        let (torch, restarts) = (Torch::of(weld), program.restart);
        let (tilt, table) = (Tilt::new(program), Follower::new(program));
        let positioner = Holder::new(program.positioner.as_ref(), weld.travel.speed);
        let own = Self::new(weld.travel.clearance);
        let programmer = Self { torch, sets_feed, restarts, dry, tilt, table, positioner, ..own };
        programmer.with_fit(program)
    }

    /// The same programmer, but with the weave written as moves.
    pub fn woven(self, weave: Option<&Weave>) -> Self {
        Self { weave: weave.cloned(), ..self }
    }

    /// The same programmer, but it stays in the coordinates in which layers are level.
    pub fn unplaced(self) -> Self {
        Self { placed: false, ..self }
    }

    /// The same programmer, but it keeps every point of the passes.
    pub fn unfitted(self) -> Self {
        Self { fit: None, spread: None, ..self }
    }

    /// Fits straight pieces and arcs; without a tolerance every point is kept.
    pub fn with_fit(mut self, program: &ProgramSettings) -> Self {
        // Dropping close points may already have moved the path by this much.
        let tolerance = program.chord_tolerance - MIN_MOVE_MM;
        // Merging points and fitting pieces each use half of the rest.
        let time = program.min_point_time;
        self.spread = (time > 0.0 && tolerance > 0.0).then_some(Spread { time, tolerance: tolerance / 2.0 });
        let tolerance = if self.spread.is_some() { tolerance / 2.0 } else { tolerance };
        self.speed_tolerance = program.speed_tolerance;
        self.fit = (tolerance > 0.0).then_some(Fit {
            tolerance,
            arcs: program.arcs && self.torch.is_level(),
            grid: RESOLUTION_MM,
        });
        self
    }

    /// The instructions of the next layer; the torch ends above its last pass, clear of it.
    ///
    /// ```
    /// use bead_plan::layer::Layer;
    /// use bead_plan::pass::{Along, Pass, PassKind};
    /// use bead_program::program::{Instruction, Programmer};
    /// use glam::DVec3;
    ///
    /// // A pass of three points takes two moves with the arc on.
    /// let (points, width, pace) = ([0.0, 20.0, 50.0].map(|x| DVec3::X * x).to_vec(), Along::Same(5.0), Along::Same(8.0));
    /// let pass = Pass { kind: PassKind::Wall, closed: false, points, width, pace, wait: 0.0 };
    /// let layer = Layer { height: 2.0, passes: vec![pass], ..Layer::default() };
    /// let steps = Programmer::new(10.0).layer(&layer).instructions;
    /// assert_eq!(steps.iter().filter(|step| matches!(step, Instruction::Weld { .. })).count(), 2);
    /// ```
    pub fn layer(&mut self, layer: &Layer) -> LayerProgram {
        self.layer_from(layer, 0)
    }

    /// The same, beginning at the pass with index `first`, for a build that was stopped there.
    pub fn layer_from(&mut self, layer: &Layer, first: usize) -> LayerProgram {
        let mut instructions = Vec::with_capacity(layer.passes.iter().map(|p| p.points.len() + 6).sum());
        self.pass_over(layer);
        // A build may be resumed at any layer, so each sets the wire feed that it needs.
        self.feed = None;
        self.swung = self.weave.as_ref().map(|weave| weave.at_layer(layer.index));
        let mut begun = self.torch.begin_layer(layer, first);
        for (i, pass) in layer.passes.iter().enumerate().skip(first) {
            self.pass(i + 1, pass, &mut begun, &mut instructions);
        }
        if let Some(positioner) = self.positioner.as_mut().filter(|_| self.placed) {
            positioner.hold(&mut instructions);
        }
        if self.dry {
            let kept = |i: &Instruction| {
                let places = matches!(i, Instruction::PassStart { .. } | Instruction::Above | Instruction::PassEnd);
                places || matches!(i, Instruction::Turn { .. }) || i.target().is_some()
            };
            instructions.retain(kept);
        }
        LayerProgram { index: layer.index, z: layer.z, instructions }
    }

    /// Time that travels have waited for the axes of a positioner so far, s.
    pub fn waited(&self) -> f64 {
        self.positioner.as_ref().map_or(0.0, Holder::waited)
    }

    /// Takes note of a layer that is not programmed here; the torch leans with the walls built on it.
    pub fn pass_over(&mut self, layer: &Layer) {
        self.tilt.iter_mut().for_each(|tilt| tilt.enter(layer));
    }

    fn pause(&self, pause: Pause, out: &mut Vec<Instruction>) {
        out.extend((pause.length > 0.0).then_some(Instruction::Travel { to: pause.at }));
        match out.last_mut() {
            // The waits of the layer and of its first pass are combined.
            Some(Instruction::Dwell { seconds }) => *seconds += pause.seconds,
            _ => out.push(Instruction::Dwell { seconds: pause.seconds }),
        }
    }

    /// Programs a pass, preceded by what its layer still requires before the first one.
    fn pass(&mut self, number: usize, pass: &Pass, begun: &mut Begun, out: &mut Vec<Instruction>) {
        let mut moves = distinct(path(pass, self.torch.ends()));
        level_paces(&mut moves, self.speed_tolerance);
        self.spread.into_iter().for_each(|s| spread::spread(&mut moves, s));
        let width = pass.width.max();
        if self.tilt.is_some() {
            moves = Tilt::divided(moves, width);
        }
        let [(start, _), (_, first), ..] = moves[..] else { return };
        self.torch.turn_towards(start);
        let (own, before) = (out.len(), self.torch.at());
        let leans = self.tilt.as_ref().map(|tilt| tilt.leans(&moves, width)).unwrap_or_default();
        let lean = |i: usize| leans.get(i).copied().unwrap_or_default();
        let places = || moves.iter().map(|(at, _)| *at).collect::<Vec<_>>();
        let turned = self.table.as_mut().map(|table| table.begin(&places()));
        let held = turned.map(|turned| Held::on_table(turned.angle));
        let begins = self.torch.at().is_none();
        let lit = self.torch.lit();
        let Begun { transfer, pause } = std::mem::take(begun);
        let pauses = [pause, self.torch.wait(pass.wait)];
        // From another body the torch comes down from directly above.
        let over = before.filter(|_| transfer.is_some()).map_or(start.z, |at| at.z);
        let mut legs = self.torch.approach(start).legs;
        let above = start.with_z(legs.iter().map(|to| to.z).fold(over, f64::max));
        let down = legs.pop();
        let mut legs = legs.into_iter();
        if !lit.before {
            let attitude = Attitude { lean: lean(0), held, ..Attitude::default() };
            out.push(Instruction::PassStart { pass: number, above, attitude });
        }
        pauses.into_iter().flatten().for_each(|pause| self.pause(pause, out));
        let joints = begins || turned.is_some_and(|turned| turned.far);
        out.extend(legs.by_ref().take(usize::from(joints)).map(|to| Instruction::Approach { to }));
        out.extend(legs.map(|to| Instruction::Travel { to }));
        out.extend((!lit.before).then_some(Instruction::Above));
        if self.restarts {
            self.feed = None;
        }
        self.set_feed(self.torch.feed_at(first), out);
        out.extend(down.map(|to| Instruction::Travel { to }));
        out.extend((!lit.before).then_some(Instruction::ArcOn { pass: number, kind: pass.kind }));
        let mut from = start;
        let pieces = self.pieces(&moves, &leans);
        for (i, &Stretch { end, to, circle, speed }) in pieces.iter().enumerate() {
            self.set_feed(self.torch.feed_at(moves[end].1), out);
            let length = circle.map_or(from.distance(to), |circle| circle.length());
            let held = self.table.as_mut().map(|table| Held::on_table(table.follow(to, length)));
            let attitude = Attitude { lean: lean(end), held, ..Attitude::default() };
            out.push(Instruction::Weld { to, circle, speed, last: i + 1 == pieces.len(), attitude });
            from = to;
        }
        let seconds = self.torch.weld(pass.kind, &moves).crater;
        if seconds > 0.0 {
            let ratio = Some(self.torch.crater_feed()).filter(|_| self.sets_feed);
            self.feed = ratio;
            out.push(Instruction::Crater { seconds, ratio });
        }
        if !lit.after {
            out.push(Instruction::ArcOff { pass: number });
            out.extend(self.torch.retract().legs.into_iter().map(|to| Instruction::Retract { to }));
            out.push(Instruction::PassEnd);
        }
        if let Some(sheet) = self.torch.sheet().filter(|_| self.placed) {
            let of_chart = out.split_off(own);
            out.extend(placed::placed(of_chart, &sheet, before));
        }
        if let Some(transfer) = transfer.filter(|_| self.placed) {
            // From here the pass has begun.
            let first = own + 1;
            let moves: Vec<Instruction> = placed::transferred(&transfer).collect();
            let there = moves.iter().rev().find_map(Instruction::target);
            let is_there = |i: &Instruction| match (i, there) {
                (Instruction::Travel { to }, Some(there)) => to.distance(there) < MIN_MOVE_MM,
                _ => false,
            };
            let known = out[first..].iter().position(is_there).map(|at| first + at);
            if let Some(at) = known {
                out.remove(at);
            }
            out.splice(first..first, moves);
        }
    }

    /// The pieces in which a path is executed: as a weave, as fitted pieces, or as all its moves.
    fn pieces(&self, moves: &[(DVec3, f64)], leans: &[DVec2]) -> Vec<Stretch> {
        let speed = |end: usize| self.torch.speed_at(moves[end].1);
        if let Some(weave) = &self.swung {
            let path: Vec<DVec3> = moves.iter().map(|(to, _)| *to).collect();
            let speeds: Vec<f64> = (0..moves.len()).map(speed).collect();
            let swings = weave::swings(&path, &speeds, weave).into_iter();
            return swings.map(|Swing { to, of, speed }| Stretch { end: of, to, circle: None, speed }).collect();
        }
        let whole = |end, circle| Stretch { end, to: moves[end].0, circle, speed: speed(end) };
        match &self.fit {
            Some(fit) => fitted(moves, leans, fit).into_iter().map(|(end, circle)| whole(end, circle)).collect(),
            None => (1..moves.len()).map(|end| whole(end, None)).collect(),
        }
    }

    /// Sets the wire feed, as a multiple of the nominal one, if it changes.
    fn set_feed(&mut self, ratio: f64, out: &mut Vec<Instruction>) {
        if self.sets_feed && self.feed != Some(ratio) {
            self.feed = Some(ratio);
            out.push(Instruction::WireFeed { ratio });
        }
    }
}

/// Gives neighbouring moves whose paces differ by at most the fraction `tolerance` a common pace: the one that takes
/// the same time over all of them, and so lays the same metal.
fn level_paces(moves: &mut [(DVec3, f64)], tolerance: f64) {
    let mut start = 1;
    while tolerance > 0.0 && start < moves.len() {
        let (mut low, mut high, mut end) = (f64::INFINITY, 0.0_f64, start);
        while let Some(&(_, speed)) = moves.get(end) {
            (low, high) = (low.min(speed), high.max(speed));
            if high > low * (1.0 + tolerance) {
                break;
            }
            end += 1;
        }
        let end = end.max(start + 1);
        let pieces = || moves[start - 1..end].windows(2).map(|w| (w[0].0.distance(w[1].0), w[1].1));
        let (length, time) = pieces().fold((0.0, 0.0), |(l, t), (length, speed)| (l + length, t + length / speed));
        let (first, alike) = (moves[start].1, pieces().all(|(_, speed)| speed == moves[start].1));
        let speed = if alike || time <= 0.0 { first } else { length / time };
        moves[start..end].iter_mut().for_each(|(_, s)| *s = speed);
        start = end;
    }
}

/// A piece as executed.
struct Stretch {
    /// Index of the path's move at which it ends.
    end: usize,
    to: DVec3,
    circle: Option<Circle>,
    /// Speed, mm/s.
    speed: f64,
}

/// The moves from the first point on, fitted: the index of the move that ends each piece, and its circle if it has one.
/// Pieces end where the pace, the height or the torch's lean changes.
fn fitted(moves: &[(DVec3, f64)], leans: &[DVec2], fit: &Fit) -> Vec<(usize, Option<Circle>)> {
    let (mut out, mut start) = (Vec::new(), 0);
    let lean = |i: usize| leans.get(i).copied().unwrap_or_default();
    while let Some(&(first, pace)) = moves.get(start + 1) {
        let leans_alike = |i: usize| lean(i).distance(lean(start)) <= tilt::ALIKE;
        let alike = |i: &usize| moves[*i].1 == pace && moves[*i].0.z == first.z && leans_alike(*i);
        let level = moves[start].0.z == first.z && leans_alike(start + 1);
        let end = start + if level { (start + 1..moves.len()).take_while(alike).count() } else { 1 };
        let points: Vec<_> = moves[start..=end].iter().map(|(p, _)| p.truncate()).collect();
        let piece = |p: Piece| {
            let lift = |arc: planar::arcs::Arc| Circle {
                via: arc.via.extend(first.z),
                centre: arc.centre.extend(first.z),
                radius: arc.radius,
                sweep: arc.sweep,
            };
            (start + p.end, p.arc.map(lift))
        };
        out.extend(fit.pieces(&points).into_iter().map(piece));
        start = end;
    }
    out
}

/// A point rounded as in programs.
fn rounded(p: DVec3) -> DVec3 {
    DVec3::from_array(p.to_array().map(|v| number::rounded(v / RESOLUTION_MM) * RESOLUTION_MM))
}

/// The points of a path, rounded, without those too close to the last one; the end point is always kept.
fn distinct(path: Vec<(DVec3, f64)>) -> Vec<(DVec3, f64)> {
    let end = path.last().map(|(to, _)| rounded(*to));
    let mut moves: Vec<(DVec3, f64)> = Vec::with_capacity(path.len());
    for (to, pace) in path {
        let to = rounded(to);
        if moves.last().is_none_or(|(last, _)| last.distance(to) >= MIN_MOVE_MM) {
            moves.push((to, pace));
        }
    }
    if let (Some(end), [_, .., last]) = (end, &mut moves[..]) {
        last.0 = end;
    }
    moves
}
