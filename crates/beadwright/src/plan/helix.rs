//! One helix in place of closed walls: every layer is a turn that rises from the layer below, with one arc start for all.
//!
//! The first turn lies level on the plate. The second one rises, so the gap below it grows from nothing at its start to
//! a whole layer at its end, and it lays the metal that this gap takes. A last, level turn fills what the ramp leaves
//! below the top. No piece gets less than [`Lit::LEAST`] of a bead, so the second turn begins with too much metal, and
//! the last one ends early by as much.

use crate::layer::{Layer, Lit};
use crate::pass::{Along, Pass, PassKind, Segment};
use crate::warning::{Warning, WarningKind};
use glam::DVec2;
use planar::polyline;

/// Pieces are at most this long, in bead widths, so that they follow the turn below.
const PIECE: f64 = 2.0;
/// Points of the next two turns together, as a multiple of those of the present one: each may have a fifth more than
/// the one before. Where a program cannot hold them, the arc goes out, so that no turn is ever alone.
const NEXT_TWO: f64 = 1.2 + 1.2 * 1.2;

/// A layer that cannot become a turn.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct NoTurn {
    /// Index of the layer.
    pub layer: usize,
    /// Why, as a clause.
    pub why: String,
}

/// The helix so far.
#[derive(Debug, Clone)]
pub(super) struct Helix {
    /// The number of layers, and the greatest number of points of a pass in a program.
    layers: usize,
    longest: Option<usize>,
    /// The closed line of the last turn, its top (mm), and the position of the torch.
    below: Option<(Vec<DVec2>, f64, DVec2)>,
    /// Number of turns.
    turns: usize,
    /// Whether the arc is on, and the number of points laid since it was struck.
    lit: bool,
    points: usize,
}

/// A place on a turn.
#[derive(Clone, Copy)]
struct Place {
    at: DVec2,
    /// Fraction of the turn that lies before it.
    part: f64,
    width: f64,
    pace: f64,
}

impl Helix {
    pub(super) fn new(layers: usize, longest: Option<usize>) -> Self {
        Self { layers, longest, below: None, turns: 0, lit: false, points: 0 }
    }

    /// Turns the only pass of a layer into a turn of the helix.
    ///
    /// # Errors
    /// [`NoTurn`] where it is not one closed wall, or too long for a program.
    pub(super) fn turn(&mut self, layer: &mut Layer, bead_width: f64) -> Result<(), NoTurn> {
        let (index, count) = (layer.index, layer.passes.len());
        let none = |why: String| Err(NoTurn { layer: index, why });
        let [pass] = &mut layer.passes[..] else { return none(format!("it has {count} passes")) };
        // A loop of two beads is a single closed pass, too.
        if !pass.closed || pass.kind != PassKind::Wall || pass.points.len() < 3 {
            return none("its pass is open, or is not a single bead along a wall".to_owned());
        }
        let places = places(pass, self.below.as_ref().map(|(.., torch)| *torch), PIECE * bead_width);
        let ring: Vec<DVec2> = places.iter().map(|place| place.at).collect();
        let left = self.layers - index - 1;
        let mut turn = Turn::default();
        match &self.below {
            Some((below, z, torch)) => {
                for (i, place) in places.iter().enumerate() {
                    let under = if i == 0 { *torch } else { nearest(below, place.at) };
                    let share = if self.turns == 1 { place.part.max(Lit::LEAST) } else { 1.0 };
                    let height = z + (layer.z - z) * place.part;
                    turn.add(under.lerp(place.at, place.part), height, place, share);
                }
            }
            None => places.iter().for_each(|place| turn.add(place.at, layer.z, place, 1.0)),
        }
        if left == 0 && self.turns > 0 {
            for place in places.iter().skip(1).take_while(|place| place.part <= 1.0 - Lit::LEAST) {
                turn.add(place.at, layer.z, place, 1.0 - place.part);
            }
        }
        *pass = turn.pass(pass);
        let count = pass.points.len();
        self.points += count;
        let fit = self.longest.is_none_or(|most| self.points as f64 + NEXT_TWO * (count as f64) < most as f64);
        if !fit && !self.lit && left > 0 {
            return none("a program of the controller is too small for three turns".to_owned());
        }
        let after = left == 1 || (left > 1 && fit);
        layer.lit = Lit { before: self.lit, after };
        let end = pass.end().unwrap_or_default().truncate();
        if !after && left > 0 {
            let (kind, size) = (WarningKind::Relit, 1.0);
            layer.warnings.push(Warning { kind, layer: index, place: end, size });
        }
        (self.turns, self.lit) = (self.turns + 1, after);
        self.points = if after { self.points } else { 0 };
        self.below = Some((ring, layer.z, end));
        Ok(())
    }
}

/// The points of a turn with their values.
#[derive(Default)]
struct Turn {
    points: Vec<glam::DVec3>,
    widths: Vec<f64>,
    paces: Vec<f64>,
}

impl Turn {
    /// Adds a place at a height (mm); from there on the piece gets `share` of a bead's metal.
    fn add(&mut self, at: DVec2, z: f64, place: &Place, share: f64) {
        self.points.push(at.extend(z));
        self.widths.push(place.width);
        self.paces.push(place.pace / share);
    }

    fn pass(self, of: &Pass) -> Pass {
        let (width, pace) = (Along::Each(self.widths), Along::Each(self.paces));
        Pass { kind: of.kind, closed: false, points: self.points, width, pace, wait: of.wait }
    }
}

/// Places at most `step` (mm) apart along a closed pass: once around counter-clockwise, from the point nearest to
/// `torch` back to it.
fn places(pass: &Pass, torch: Option<DVec2>, step: f64) -> Vec<Place> {
    let mut pieces: Vec<Segment> = pass.segments().filter(|s| s.length() > 0.0).collect();
    // Ordering may reverse passes; every turn of a helix continues in the same direction.
    if pieces.iter().map(|s| s.from.truncate().perp_dot(s.to.truncate())).sum::<f64>() < 0.0 {
        pieces.reverse();
        pieces.iter_mut().for_each(|s| std::mem::swap(&mut s.from, &mut s.to));
    }
    let on = |s: &Segment| {
        let (from, to) = (s.from.truncate(), s.to.truncate());
        let part = torch.map_or(0.0, |torch| (torch - from).dot(to - from) / from.distance_squared(to).max(1e-12));
        let part = part.clamp(0.0, 1.0);
        (torch.map_or(0.0, |torch| torch.distance_squared(from.lerp(to, part))), part)
    };
    let first = (0..pieces.len()).min_by(|&a, &b| on(&pieces[a]).0.total_cmp(&on(&pieces[b]).0)).unwrap_or(0);
    let part = pieces.get(first).map_or(0.0, |s| on(s).1);
    let whole: f64 = pieces.iter().map(|s| s.length()).sum();
    let (mut places, mut along) = (Vec::new(), 0.0);
    for k in 0..=pieces.len() {
        let s = &pieces[(first + k) % pieces.len()];
        // The first piece is laid from the torch onwards, and at the end up to the torch.
        let (begin, end) = if k == 0 {
            (part, 1.0)
        } else if k == pieces.len() {
            (0.0, part)
        } else {
            (0.0, 1.0)
        };
        let length = s.length() * (end - begin);
        let count = (length / step).ceil().max(1.0);
        for i in 0..if length > 1e-9 { count as usize } else { 0 } {
            let share = i as f64 / count;
            let at = s.from.lerp(s.to, begin + (end - begin) * share).truncate();
            places.push(Place { at, part: (along + length * share) / whole, width: s.width, pace: s.pace });
        }
        along += length;
    }
    if let Some(&begin) = places.first() {
        places.push(Place { part: 1.0, ..begin });
    }
    places
}

/// The point of a closed line that is nearest to a given point.
fn nearest(ring: &[DVec2], to: DVec2) -> DVec2 {
    let on = |pair: &[DVec2]| polyline::closest_on_segment(to, pair[0], pair[1]);
    let closer = |a: &DVec2, b: &DVec2| a.distance_squared(to).total_cmp(&b.distance_squared(to));
    ring.windows(2).map(on).min_by(closer).unwrap_or(to)
}
