//! Whether a pass lies in the air: how much of it lies over metal, and in which stretches.

use super::metal::Bead;
use bead_plan::pass::Pass;
use glam::DVec2;
use std::cell::Cell;

/// A pass with less than this fraction of its length over metal lies in the air.
const LEAST: f64 = 0.5;
/// A pass is held if this many scattered places, the first ones, all lie over metal: chance would bring that about once
/// in four billion passes of which half lies over metal.
const FIRST: usize = 32;
/// A long pass is looked at in more scattered places, and is held if this fraction of them lies over metal: more than
/// four standard deviations beyond [`LEAST`].
const SCATTERED: usize = 500;
const CLEARLY: f64 = 0.6;
/// The golden section: multiples of it are spread evenly.
const GOLDEN: f64 = 0.618_033_988_749_895;

/// What lies below a place.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Below {
    Metal,
    /// The edge of a bead is near enough for the next bead to adhere to it.
    Edge,
    Air,
}

/// How a pass overhangs.
#[derive(Clone, Copy)]
pub(super) struct Hanging {
    /// Length without metal below, mm.
    pub(super) length: f64,
    /// The middle of the longest stretch without metal below.
    pub(super) place: DVec2,
}

/// Where a pass is looked at, mm.
#[derive(Clone, Copy)]
pub(super) struct Places {
    /// Distance from place to place.
    pub(super) step: f64,
    /// A stretch of this length that is clear of all metal hangs; infinite where beads bridge gaps.
    pub(super) bridge: f64,
    /// A place this far from all metal is clear of it.
    pub(super) clear: f64,
}

/// Checks whether less than [`LEAST`] of a pass's length lies over metal, or a stretch as long as `places.bridge` is
/// clear of it. `room` says whether there is metal within a reach (mm) of a place, and how much of a way from there (a
/// vector) it surely goes on like this, mm.
pub(super) fn hanging(pass: &Pass, places: Places, room: impl Fn(DVec2, DVec2, f64) -> Option<f64>) -> Option<Hanging> {
    let path = Path::of(pass);
    if path.is_clearly_held(places, &room) && path.has_no_gap(places, pass.closed, &room) {
        return None;
    }
    let Places { step, bridge, clear } = places;
    let mut stretches: Vec<Stretch> = Vec::new();
    let below = |p: DVec2, ahead: DVec2| match room(p, ahead, 0.0) {
        Some(room) => (Below::Metal, room),
        None if room(p, ahead, clear).is_some() => (Below::Edge, 0.0),
        None => (Below::Air, 0.0),
    };
    for stretch in self::stretches(pass, step, below) {
        match stretches.last_mut().filter(|last| last.below == stretch.below) {
            Some(last) => last.places += stretch.places,
            None => stretches.push(stretch),
        }
    }
    let places = |stretches: &[Stretch]| stretches.iter().map(|s| s.places).sum::<usize>();
    let (all, mut first) = (places(&stretches), 0);
    if pass.closed {
        // No stretch may be split at the seam of a closed pass.
        let held = stretches.iter().position(|s| s.below == Below::Metal).unwrap_or(0);
        first = places(&stretches[..held]);
        stretches.rotate_left(held);
    }
    let is_free = |s: &Stretch| s.below != Below::Metal;
    // The longest stretch without metal, the last of equals: its first place, and how many they are.
    let (mut at, mut free, mut longest) = (0, 0, None::<(usize, usize)>);
    for alike in stretches.chunk_by(|a, b| is_free(a) == is_free(b)) {
        let long = places(alike);
        if is_free(&alike[0]) {
            free += long;
            longest = longest.filter(|(_, longest)| *longest > long).or(Some((at, long)));
        }
        at += long;
    }
    let (from, long) = longest?;
    let clear = stretches.chunk_by(|a, b| a.below == b.below).filter(|s| s[0].below == Below::Air).map(places).max();
    let in_the_air = all - free < (LEAST * all as f64).ceil() as usize;
    let hangs = in_the_air || clear.unwrap_or(0) as f64 * step >= bridge;
    let middle = (first + from + long / 2) % all;
    hangs.then(|| Hanging { length: free as f64 * step, place: path.at(middle as f64 * step).0 })
}

/// Neighbouring places on a pass with the same below them.
struct Stretch {
    below: Below,
    places: usize,
}

/// The pieces of a pass by the length of the pass up to each.
struct Path {
    pieces: Vec<(f64, Bead)>,
    /// The piece of the last place.
    last: Cell<usize>,
}

impl Path {
    fn of(pass: &Pass) -> Self {
        let along = |along: &mut f64, piece: Bead| {
            let from = *along;
            *along += piece.length;
            Some((from, piece))
        };
        Self { pieces: pieces(pass).scan(0.0, along).collect(), last: Cell::new(0) }
    }

    fn length(&self) -> f64 {
        self.pieces.last().map_or(0.0, |(from, piece)| from + piece.length)
    }

    /// The place at a length along the path, and the rest of its piece as a vector, mm.
    fn at(&self, length: f64) -> (DVec2, DVec2) {
        let begins_before = |number: usize| self.pieces.get(number).is_some_and(|(from, _)| *from < length);
        let is_last_before = |number: &usize| begins_before(*number) && !begins_before(number + 1);
        let last = self.last.get();
        let near = (last..last + 3).find(is_last_before);
        let number = near.unwrap_or_else(|| self.pieces.partition_point(|(from, _)| *from < length).saturating_sub(1));
        self.last.set(number);
        let Some((from, piece)) = self.pieces.get(number) else { return Default::default() };
        let along = length - from;
        (piece.from + piece.axis * along, piece.axis * (piece.length - along).max(0.0))
    }

    /// Whether clearly more than [`LEAST`] of the pass lies over metal, by scattered places: they do not keep step with the
    /// beads that they cross.
    fn is_clearly_held(&self, places: Places, room: impl Fn(DVec2, DVec2, f64) -> Option<f64>) -> bool {
        let place = |k: usize| self.at((k as f64 * GOLDEN).fract() * self.length()).0;
        let is_held = |k: &usize| room(place(*k), DVec2::ZERO, 0.0).is_some();
        let has = |number: usize| self.length() >= number as f64 * places.step;
        if !has(FIRST) {
            return false;
        }
        (0..FIRST).all(|k| is_held(&k))
            || has(SCATTERED) && (0..SCATTERED).filter(is_held).count() as f64 >= CLEARLY * SCATTERED as f64
    }

    /// Whether no stretch as long as a bridge is clear of all metal: not every place has to be looked at for that, only the
    /// last of each bridge that could begin after metal, and those beside it where it is clear.
    fn has_no_gap(&self, places: Places, closed: bool, room: impl Fn(DVec2, DVec2, f64) -> Option<f64>) -> bool {
        let Places { step, bridge, clear } = places;
        if bridge == f64::INFINITY {
            return true;
        }
        let many = (bridge / step).ceil().max(1.0) as usize;
        let all = (self.length() / step) as usize + 1;
        // How many places after this one are surely as near to metal; none if it is clear.
        let held = |place: usize| {
            let (p, ahead) = self.at(place as f64 * step);
            room(p, ahead, clear).map(|room| (room / step) as usize)
        };
        if closed && held(0).is_none() {
            return false;
        }
        let mut place = many - 1;
        while place < all {
            place = match held(place) {
                Some(more) => place + more + many,
                None => {
                    let is_clear = |place: &usize| held(*place).is_none();
                    let before = (place + 1 - many..place).rev().take_while(is_clear).count();
                    let after = (place + 1..all).take(many - before - 1).take_while(is_clear).count();
                    if before + 1 + after >= many {
                        return false;
                    }
                    // The place after the last clear one is not clear.
                    place + after + 1 + many
                }
            };
        }
        true
    }
}

/// The places on a pass, `step` (mm) apart, as stretches; neighbouring ones may be alike. `below` says what lies below a
/// place, and how much of a way from there (a vector) it surely goes on, mm.
fn stretches(pass: &Pass, step: f64, below: impl Fn(DVec2, DVec2) -> (Below, f64)) -> impl Iterator<Item = Stretch> {
    // A piece, the length of the pass up to it, and up to the next place.
    let (mut pieces, mut piece, mut along, mut next) = (pieces(pass), None::<Bead>, 0.0, 0.0);
    std::iter::from_fn(move || {
        loop {
            if let Some(piece) = piece.as_ref().filter(|piece| next <= along + piece.length) {
                let ahead = piece.axis * (along + piece.length - next);
                let (below, room) = below(piece.from + piece.axis * (next - along), ahead);
                let places = 1 + (room / step) as usize;
                next += places as f64 * step;
                return Some(Stretch { below, places });
            }
            along += piece.as_ref().map_or(0.0, |piece| piece.length);
            piece = Some(pieces.next()?);
        }
    })
}

fn pieces(pass: &Pass) -> impl Iterator<Item = Bead> {
    pass.segments().filter(|piece| piece.from.is_finite()).map(Bead::of)
}

#[cfg(test)]
mod tests {
    use super::super::metal::{CLEAR, Metal};
    use super::*;
    use bead_plan::pass::{Along, PassKind};
    use glam::DVec3;
    use proptest::prelude::*;

    const WIDTH: f64 = 2.0;

    fn pass(points: Vec<DVec2>, closed: bool, width: f64) -> Pass {
        let points: Vec<DVec3> = points.into_iter().map(|p| p.extend(1.0)).collect();
        Pass { kind: PassKind::Infill, closed, points, width: Along::Same(width), pace: Along::Same(8.0), wait: 0.0 }
    }

    /// What lies below a place, by all beads one after another; none where rounding decides.
    fn by_all(passes: &[Pass], p: DVec2) -> Option<Below> {
        let nearest = |piece: Bead| {
            let foot = (p - piece.from).dot(piece.axis).clamp(0.0, piece.length);
            p.distance(piece.from + piece.axis * foot) - piece.half
        };
        let away = passes.iter().flat_map(pieces).map(nearest).fold(f64::INFINITY, f64::min);
        let clear = CLEAR * WIDTH;
        let kind = match away {
            ..0.0 => Below::Metal,
            away if away < clear => Below::Edge,
            _ => Below::Air,
        };
        (away.abs() > 1e-6 && (away - clear).abs() > 1e-6).then_some(kind)
    }

    const PLACES: Places = Places { step: 0.5, bridge: f64::INFINITY, clear: CLEAR * WIDTH };

    fn below(metal: &Metal, p: DVec2, ahead: DVec2) -> (Below, f64) {
        match metal.room(p, ahead, 0.0) {
            Some(room) => (Below::Metal, room),
            None if metal.room(p, ahead, CLEAR * WIDTH).is_some() => (Below::Edge, 0.0),
            None => (Below::Air, 0.0),
        }
    }

    fn points() -> impl Strategy<Value = Vec<DVec2>> {
        proptest::collection::vec((-30..30_i32, -30..30_i32).prop_map(|(x, y)| DVec2::new(x.into(), y.into())), 1..9)
    }

    /// Lines that begin and end anywhere, so far apart, turned.
    fn any_zigzag() -> impl Strategy<Value = Vec<DVec2>> {
        let ends = proptest::collection::vec((-30..0_i32, 0..30_i32), 3..80);
        (ends, 0.5..2.2, 0.0..7.0).prop_map(|(ends, apart, angle)| {
            let line = |(k, (low, high)): (usize, (i32, i32))| {
                let (y, ends) = (apart * k as f64 - 20.0, if k % 2 == 0 { [low, high] } else { [high, low] });
                ends.map(|x| DVec2::from_angle(angle).rotate(DVec2::new(f64::from(x), y)))
            };
            ends.into_iter().enumerate().flat_map(line).collect()
        })
    }

    /// Checks each place of a pass over beads.
    fn each_place_lies_over_what_was_found(beads: &[Pass], over: &Pass) -> Result<(), TestCaseError> {
        let metal = Metal::of(beads, WIDTH);
        let stretches = stretches(over, 0.5, |p, ahead| below(&metal, p, ahead));
        let found = stretches.flat_map(|stretch| std::iter::repeat_n(stretch.below, stretch.places));
        let mut number = 0;
        for (k, found) in found.enumerate() {
            let expected = by_all(beads, Path::of(over).at(k as f64 * 0.5).0);
            prop_assert!(expected.is_none_or(|expected| expected == found), "place {k}");
            number += 1;
        }
        let last = over.length() / 0.5;
        prop_assert!(
            over.points.len() < 2 || (f64::from(number) - 1.0 - last.floor()).abs() <= 1.0,
            "{number} of {last}"
        );
        Ok(())
    }

    proptest! {
        #[test]
        fn stretches_hold_what_lies_below_each_place(
            beads in proptest::collection::vec((points(), any::<bool>(), 0.5..4.0), 0..5),
            over in points(),
            closed in any::<bool>(),
        ) {
            let beads: Vec<Pass> = beads.into_iter().map(|(points, closed, width)| pass(points, closed, width)).collect();
            each_place_lies_over_what_was_found(&beads, &pass(over, closed, WIDTH))?;
        }

        #[test]
        fn stretches_across_zigzags_hold_what_lies_below_each_place(
            beads in proptest::collection::vec(any_zigzag(), 1..3),
            over in points(),
        ) {
            let beads: Vec<Pass> = beads.into_iter().map(|points| pass(points, false, WIDTH)).collect();
            each_place_lies_over_what_was_found(&beads, &pass(over, false, WIDTH))?;
        }
    }

    proptest! {
        #[test]
        fn a_gap_is_found_wherever_it_lies(
            beads in proptest::collection::vec(points(), 0..12),
            over in points(),
            bridge in 1..20_i32,
        ) {
            let beads: Vec<Pass> = beads.into_iter().map(|points| pass(points, false, WIDTH)).collect();
            let (over, metal, bridge) = (pass(over, false, WIDTH), Metal::of(&beads, WIDTH), f64::from(bridge) / 2.0);
            let places = Places { bridge, ..PLACES };
            let mut gap = 0;
            let kinds = stretches(&over, 0.5, |p, ahead| below(&metal, p, ahead));
            let longest = kinds.map(|stretch| {
                gap = if stretch.below == Below::Air { gap + stretch.places } else { 0 };
                gap
            }).max().unwrap_or_default();
            // Places that a bead touches may count as within it or not.
            let edge = (0..=(over.length() / 0.5) as usize).any(|k| by_all(&beads, Path::of(&over).at(k as f64 * 0.5).0).is_none());
            let none = Path::of(&over).has_no_gap(places, false, |p, ahead, reach| metal.room(p, ahead, reach));
            // Where no gap is found there is none; where one may be, all places are looked at.
            prop_assert!(edge || !none || (longest as f64) * 0.5 < bridge, "{longest} places of {bridge} mm");
        }
    }

    /// Lines 2 mm apart from x = 0 to `end`, as one zigzag over y = 0 to 200.
    fn zigzag(end: f64) -> Pass {
        let line = |k: i32| {
            let (y, there) = (2.0 * f64::from(k), k % 2 == 0);
            [0.0, end].map(|x| DVec2::new(if there { x } else { end - x }, y))
        };
        pass((0..100).flat_map(line).collect(), false, WIDTH)
    }

    #[test]
    fn a_long_pass_hangs_if_less_than_half_of_it_lies_over_metal() {
        let over = zigzag(1000.0);
        for percent in [10, 40, 45, 49, 51, 55, 65, 90] {
            let lines = pass(
                (0..100)
                    .flat_map(|k| {
                        let (x, there) = (0.1 * f64::from(percent * k), k % 2 == 0);
                        [0.0, 200.0].map(|y| DVec2::new(x, if there { y } else { 200.0 - y }))
                    })
                    .collect(),
                false,
                0.1 * f64::from(percent),
            );
            let metal = Metal::of(&[lines], WIDTH);
            let found = hanging(&over, PLACES, |p, ahead, reach| metal.room(p, ahead, reach));
            assert_eq!(found.is_some(), percent < 50, "{percent} %");
            if let Some(Hanging { length, place }) = found {
                let free = f64::from(100 - percent) / 100.0;
                assert!((length / over.length() - free).abs() < 0.01, "{percent} %: {length} mm");
                assert!(metal.room(place, DVec2::X, 0.0).is_none());
            }
        }
    }
}
