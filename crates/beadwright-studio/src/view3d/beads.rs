//! One layer as it is drawn and timed: its segments in print order, the passes, and the travels between them.
//!
//! This is plain data, made on a worker thread. Numbers that only the picture needs are `f32`. Layers that are not
//! level are placed in space: their pieces are divided into segments that follow them.

use super::lie::{Lie, Stance, packed, unpacked};
use beadwright::layer::Layer;
use beadwright::pass::{Pass, PassKind, Segment};
use beadwright::weld::{Torch, Transfer, Way, path};
use bytemuck::{Pod, Zeroable};
use glam::{DVec3, Vec3};
use std::ops::Range;
use std::sync::atomic::{AtomicU64, Ordering};

/// Segments per bounding box.
pub(super) const BLOCK: usize = 64;

/// Cosine of the sharpest bend at which two segments are mitred; sharper ones get a round joint. 50°.
const MITRE_COS: f32 = 0.643;

/// Rough beads deviate from the exact ones by less than this fraction of the width, and by less than 20° in direction.
pub(super) const ROUGH: f32 = 0.05;
const ROUGH_COS: f32 = 0.94;

/// A rough segment stands for at most this many segments plus one.
const MOST_MERGED: usize = 24;

/// A straight piece of a bead, as the graphics card reads it; mm.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Bead {
    from: [f32; 3],
    /// Width; negative if the previous segment is mitred into this one.
    width: f32,
    to: [f32; 3],
    /// Height; negative if this segment is mitred into the next.
    height: f32,
    /// The direction out of its layer, packed: 0 straight up.
    pub(super) up: u32,
}

impl Bead {
    /// Where it begins, mm, on its top.
    pub fn from(&self) -> Vec3 {
        self.from.into()
    }

    /// Where it ends, mm, on its top.
    pub fn to(&self) -> Vec3 {
        self.to.into()
    }

    /// Length, mm.
    pub fn length(&self) -> f64 {
        f64::from(self.from().distance(self.to()))
    }

    /// Width, mm.
    pub fn width(&self) -> f32 {
        self.width.abs()
    }

    /// Height, mm.
    pub fn height(&self) -> f32 {
        self.height.abs()
    }

    /// The direction out of its layer, of length 1, along which its height is measured.
    pub fn up(&self) -> Vec3 {
        unpacked(self.up)
    }

    /// The torch at a fraction (0 to 1) of its length.
    pub fn torch(&self, part: f64) -> Stance {
        Stance { at: self.from().as_dvec3().lerp(self.to().as_dvec3(), part), up: self.up().as_dvec3() }
    }

    /// A bead like this one from one place to another, not mitred.
    fn between(&self, from: Vec3, to: Vec3) -> Self {
        Self { from: from.into(), to: to.into(), width: self.width(), height: self.height(), up: self.up }
    }

    /// The ends of the line in its middle, mm.
    pub(super) fn middle_line(&self) -> [Vec3; 2] {
        let below = self.up() * (self.height() / 2.0);
        [self.from() - below, self.to() - below]
    }

    /// How far it reaches from its middle line along x, y and z, mm.
    fn reach(&self) -> Vec3 {
        let (across, high) = (self.width() / 2.0, self.height() / 2.0);
        if self.up == 0 {
            return Vec3::new(across, across, high);
        }
        let part = self.up() * self.up();
        (across * across * (Vec3::ONE - part) + high * high * part).map(|square| square.max(0.0).sqrt())
    }

    /// The round end of the bead at one of its ends.
    fn cap(&self, at: [f32; 3]) -> Cap {
        Cap { at, width: self.width(), height: self.height(), up: self.up }
    }
}

/// A round end or joint, as the graphics card reads it; mm.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub(super) struct Cap {
    pub at: [f32; 3],
    pub width: f32,
    pub height: f32,
    /// Packed, as for a bead.
    pub up: u32,
}

/// A pass among the segments of its layer. Times are s from the start of the layer.
#[derive(Debug, Clone, PartialEq)]
pub struct PassSpan {
    /// What it is for.
    pub kind: PassKind,
    /// Temperature of the metal where it begins, °C, where the plan has it.
    pub temperature: Option<f32>,
    /// Its segments.
    pub segments: Range<usize>,
    /// When the travel to it begins.
    pub travel_start: f64,
    /// When the torch is at its start.
    pub arrival: f64,
    /// When the torch begins to move with the arc on.
    pub arc_start: f64,
    /// When the torch may leave: after crater filling and gas.
    pub end: f64,
    /// The travel to it: from where the torch was, up, across, down; empty before the very first pass.
    pub travel: Vec<Stance>,
}

/// A layer's segments, passes and travels in print order.
#[derive(Debug)]
pub struct LayerBeads {
    pub(super) id: u64,
    pub(super) beads: Vec<Bead>,
    pub(super) speeds: Vec<f32>,
    /// When each segment ends, s from the start of the layer.
    pub(super) ends: Vec<f32>,
    /// The piece of the layer that each segment is part of; empty where each segment is a whole piece.
    pieces: Vec<u32>,
    pub(super) passes: Vec<PassSpan>,
    pub(super) caps: Vec<Cap>,
    /// The segment with which each cap appears.
    pub(super) cap_segments: Vec<u32>,
    /// The same beads in fewer segments, for a view in motion.
    pub(super) rough: Vec<Bead>,
    /// The last segment that each rough one stands for.
    pub(super) rough_segments: Vec<u32>,
    /// Lowest and highest corner of each block of [`BLOCK`] segments, mm.
    pub(super) boxes: Vec<(Vec3, Vec3)>,
    seconds: f64,
}

static NEXT_ID: AtomicU64 = AtomicU64::new(1);

/// A number that no other caller gets; a different one shows that something has changed.
pub(super) fn fresh_id() -> u64 {
    NEXT_ID.fetch_add(1, Ordering::Relaxed)
}

impl LayerBeads {
    /// A layer as the torch runs it, with the wait before it.
    pub fn of(layer: &Layer, torch: &mut Torch) -> Self {
        let count = layer.passes.iter().map(|p| p.points.len()).sum();
        let mut beads = Self::empty(count);
        // The rise at the end of the layer before, in that layer's lie.
        let begins = layer.passes.first().is_some_and(|pass| pass.start().is_some());
        let before = torch.at().filter(|_| begins).map(|at| Lie(torch.sheet()).stance(at));
        let up = if begins { torch.retract() } else { Way::default() };
        let begun = torch.begin_layer(layer, 0);
        beads.seconds = up.moving + begun.moving() + begun.waiting();
        for (i, pass) in layer.passes.iter().enumerate() {
            beads.add(pass, layer.height, torch);
            if let (Some(span), Some(temperature)) = (beads.passes.last_mut(), layer.temperatures.get(i)) {
                span.temperature = Some(temperature.start as f32);
            }
        }
        if let (Some(from), Some(first)) = (before, beads.passes.first_mut()) {
            first.comes_from(from, up.moving, begun.transfer.as_ref());
        }
        beads.boxes = beads.beads.chunks(BLOCK).map(box_of).collect();
        beads
    }

    fn add(&mut self, pass: &Pass, height: f64, torch: &mut Torch) {
        let first = self.beads.len();
        let (travel_start, mut arrival, mut travel) = (self.seconds, self.seconds, Vec::new());
        if let Some(start) = pass.start() {
            torch.turn_towards(start);
            let (from, up) = (torch.at(), if self.passes.is_empty() { Way::default() } else { torch.retract() });
            arrival += torch.wait(pass.wait).map_or(0.0, |pause| pause.moving + pause.seconds);
            let ways = [up, torch.approach(start)];
            arrival += ways.iter().map(|way| way.moving).sum::<f64>();
            let legs = ways.into_iter().flat_map(|way| way.legs).filter(|_| from.is_some());
            travel = from.into_iter().chain(legs).collect();
        }
        let mut arc_start = arrival;
        // A pass without points only keeps its place in the numbering.
        if pass.start().is_some() {
            let speed = |pace: f64| torch.speed_at(pace);
            let even: f64 = pass.segments().map(|s| s.length() / speed(s.pace)).sum();
            let speeds: Vec<f64> = pass.segments().map(|s| speed(s.pace)).collect();
            let welded = torch.weld(pass.kind, &path(pass, torch.ends()));
            arc_start += welded.before;
            // Overlaps, slow starts and acceleration are spread evenly along the pass.
            let (stretch, mut clock) = (if even > 0.0 { welded.moving / even } else { 1.0 }, arc_start);
            let (lie, pieces) = (Lie(torch.sheet()), self.piece_count());
            for (i, (piece, speed)) in pass.segments().zip(speeds).enumerate() {
                self.lay(&piece, height, lie);
                let along = |at: DVec3| clock + piece.from.distance(at) / speed * stretch;
                self.ends.extend(lie.divided(piece.from, piece.to).map(|at| along(at) as f32));
                clock = along(piece.to);
                self.speeds.resize(self.beads.len(), speed as f32);
                if !lie.is_level() {
                    self.pieces.resize(self.beads.len(), (pieces + i) as u32);
                }
            }
            self.seconds = arc_start + welded.moving + welded.crater + welded.after;
        }
        let segments = first..self.beads.len();
        self.join(segments.clone());
        self.roughen(segments.clone());
        let (kind, travel) = (pass.kind, Lie(torch.sheet()).line(&travel));
        let (temperature, end) = (None, self.seconds);
        self.passes.push(PassSpan { kind, temperature, segments, travel_start, arrival, arc_start, end, travel });
    }

    /// The same layer in segments no longer than this, mm.
    pub(super) fn divided(&self, longest: f32) -> Self {
        let mut divided = Self::empty(self.len());
        for pass in &self.passes {
            let first = divided.len();
            for i in pass.segments.clone() {
                let (bead, (begin, end)) = (self.beads[i], self.times(i).unwrap_or_default());
                let (from, to) = (bead.from(), bead.to());
                let parts = (from.distance(to) / longest).ceil().max(1.0) as usize;
                for k in 1..=parts {
                    let [before, after] = [k - 1, k].map(|k| k as f32 / parts as f32);
                    let at = |part: f32| if part < 1.0 { from.lerp(to, part) } else { to };
                    divided.beads.push(bead.between(at(before), at(after)));
                    divided.ends.push((begin + (end - begin) * f64::from(after)) as f32);
                    divided.pieces.push(self.piece(i) as u32);
                }
                divided.speeds.resize(divided.len(), self.speeds[i]);
            }
            divided.passes.push(PassSpan { segments: first..divided.len(), ..pass.clone() });
        }
        Self { seconds: self.seconds, ..divided }
    }

    /// The same layer with both ends of each segment moved by what is given (mm), multiplied by `times`.
    pub(super) fn moved(&self, by: &[[Vec3; 2]], times: f32) -> Self {
        let ends =
            |(bead, by): (&Bead, &[Vec3; 2])| bead.between(bead.from() + times * by[0], bead.to() + times * by[1]);
        let mut moved = Self {
            beads: self.beads.iter().zip(by).map(ends).collect(),
            speeds: self.speeds.clone(),
            ends: self.ends.clone(),
            pieces: self.pieces.clone(),
            passes: self.passes.clone(),
            seconds: self.seconds,
            ..Self::empty(0)
        };
        let mut left = None;
        for pass in 0..moved.passes.len() {
            let segments = moved.passes[pass].segments.clone();
            if let (Some([start, _]), Some([_, end])) = (by.get(segments.start), by[segments.clone()].last()) {
                let [from, to] = [left.unwrap_or(*start), *start].map(|by| f64::from(times) * by.as_dvec3());
                moved.passes[pass].shift(from, to);
                left = Some(*end);
            }
            moved.join(segments.clone());
            moved.roughen(segments);
        }
        moved.boxes = moved.beads.chunks(BLOCK).map(box_of).collect();
        moved
    }

    /// A layer without passes, with room for this many segments.
    fn empty(count: usize) -> Self {
        Self {
            id: fresh_id(),
            beads: Vec::with_capacity(count),
            speeds: Vec::with_capacity(count),
            ends: Vec::with_capacity(count),
            pieces: Vec::new(),
            passes: Vec::new(),
            caps: Vec::new(),
            cap_segments: Vec::new(),
            rough: Vec::new(),
            rough_segments: Vec::new(),
            boxes: Vec::new(),
            seconds: 0.0,
        }
    }

    /// Lays a piece of a pass.
    fn lay(&mut self, piece: &Segment, height: f64, lie: Lie<'_>) {
        let (width, mut before, mut start) = (piece.width as f32, piece.from, lie.stance(piece.from));
        for at in lie.divided(piece.from, piece.to) {
            let (middle, end) = (before.midpoint(at), lie.stance(at));
            let (from, to) = (start.at.as_vec3().into(), end.at.as_vec3().into());
            let height = lie.thickness(middle, height) as f32;
            self.beads.push(Bead { from, width, to, height, up: packed(lie.stance(middle).up) });
            (before, start) = (at, end);
        }
    }

    /// Mitres the gentle bends of a pass and rounds its ends and sharp corners.
    fn join(&mut self, segments: Range<usize>) {
        let Some(first) = self.beads.get(segments.start) else { return };
        self.caps.push(first.cap(first.from));
        self.cap_segments.push(segments.start as u32);
        for i in segments.clone() {
            let here = self.beads[i];
            let next = (i + 1 < segments.end).then(|| self.beads[i + 1]);
            if next.is_some_and(|next| way(&here).dot(way(&next)) > MITRE_COS) {
                self.beads[i].height = -here.height;
                self.beads[i + 1].width = -self.beads[i + 1].width;
            } else {
                self.caps.push(here.cap(here.to));
                self.cap_segments.push(i as u32);
            }
        }
    }

    /// Merges several segments into one, as long as it stays on the bead.
    fn roughen(&mut self, segments: Range<usize>) {
        let mut first = segments.start;
        while first < segments.end {
            let mut last = first;
            while last + 1 < segments.end && last - first < MOST_MERGED && merges(&self.beads[first..=last + 1]) {
                last += 1;
            }
            let (begin, end) = (self.beads[first], self.beads[last]);
            self.rough.push(Bead { to: end.to, height: end.height, up: between(&begin, &end), ..begin });
            self.rough_segments.push(last as u32);
            first = last + 1;
        }
    }

    /// The segments.
    pub fn beads(&self) -> &[Bead] {
        &self.beads
    }

    /// The passes.
    pub fn passes(&self) -> &[PassSpan] {
        &self.passes
    }

    /// Number of segments.
    pub fn len(&self) -> usize {
        self.beads.len()
    }

    /// Whether nothing is laid.
    pub fn is_empty(&self) -> bool {
        self.beads.is_empty()
    }

    /// Memory that the segments take, bytes.
    pub(super) fn bytes(&self) -> usize {
        let beads = (self.beads.capacity() + self.rough.capacity()) * size_of::<Bead>();
        let numbers = self.speeds.capacity() + self.ends.capacity() + self.pieces.capacity();
        let numbers = numbers + self.cap_segments.capacity();
        let caps = self.caps.capacity() * size_of::<Cap>();
        let boxes = self.boxes.capacity() * size_of::<(Vec3, Vec3)>();
        beads + 4 * (numbers + self.rough_segments.capacity()) + caps + boxes
    }

    /// Time for the layer, with the travel to its first pass, s.
    pub fn seconds(&self) -> f64 {
        self.seconds
    }

    /// Speed of the torch along a segment, mm/s.
    pub fn speed(&self, segment: usize) -> Option<f32> {
        self.speeds.get(segment).copied()
    }

    /// The pass that a segment belongs to.
    pub fn pass_of(&self, segment: usize) -> usize {
        self.passes.partition_point(|p| p.segments.end <= segment)
    }

    /// The piece of the layer, counted over all its passes, that a segment is part of.
    pub fn piece(&self, segment: usize) -> usize {
        self.pieces.get(segment).map_or(segment, |piece| *piece as usize)
    }

    /// The segments of a piece of the layer.
    pub fn segments_of(&self, piece: usize) -> Range<usize> {
        if self.pieces.is_empty() {
            return piece..piece + 1;
        }
        let before = |end: usize| self.pieces.partition_point(|other| (*other as usize) < end);
        before(piece)..before(piece + 1)
    }

    /// How much of a pass is laid with the torch at a place on one of its segments, mm; all of it beyond the last one.
    pub fn laid(&self, pass: usize, segment: usize, at: DVec3) -> f64 {
        let Some(of_pass) = self.passes.get(pass).map(|pass| pass.segments.clone()) else { return 0.0 };
        let whole = of_pass.start..segment.clamp(of_pass.start, of_pass.end);
        let here = self.beads.get(segment).filter(|_| of_pass.contains(&segment));
        let begun = here.map_or(0.0, |bead| bead.from().as_dvec3().distance(at));
        self.beads[whole].iter().map(Bead::length).sum::<f64>() + begun
    }

    /// How many pieces of the layer the first of its segments are part of.
    pub fn pieces_of(&self, segments: usize) -> usize {
        segments.min(self.len()).checked_sub(1).map_or(0, |last| self.piece(last) + 1)
    }

    fn piece_count(&self) -> usize {
        self.pieces_of(self.len())
    }

    /// When a segment begins and ends, s from the start of the layer.
    pub fn times(&self, segment: usize) -> Option<(f64, f64)> {
        let pass = self.passes.get(self.pass_of(segment))?;
        let end = f64::from(*self.ends.get(segment)?);
        let before = segment.checked_sub(1).filter(|_| segment > pass.segments.start);
        Some((before.map_or(pass.arc_start, |i| f64::from(self.ends[i])), end))
    }

    /// Slowest and fastest speed of the torch, mm/s.
    pub(super) fn speed_range(&self) -> (f32, f32) {
        self.speeds.iter().fold((f32::INFINITY, f32::NEG_INFINITY), |(low, high), &v| (low.min(v), high.max(v)))
    }

    /// Narrowest and widest bead, mm.
    pub(super) fn width_range(&self) -> (f32, f32) {
        let widths = self.beads.iter().map(Bead::width);
        widths.fold((f32::INFINITY, f32::NEG_INFINITY), |(low, high), w| (low.min(w), high.max(w)))
    }

    /// Lowest and highest corner of the beads, mm.
    pub fn bounds(&self) -> Option<(Vec3, Vec3)> {
        self.boxes.iter().copied().reduce(|(a, b), (c, d)| (a.min(c), b.max(d)))
    }
}

impl PassSpan {
    /// Moves the ends of its travel, and what is between accordingly, mm.
    fn shift(&mut self, from: DVec3, to: DVec3) {
        let last = self.travel.len().saturating_sub(1).max(1) as f64;
        for (i, leg) in self.travel.iter_mut().enumerate() {
            leg.at += from.lerp(to, i as f64 / last);
        }
    }

    /// Adds the way from the layer before: the rise, which takes `rising` s, and the transfer if another body follows.
    fn comes_from(&mut self, from: Stance, rising: f64, transfer: Option<&Transfer>) {
        let legs = transfer.iter().flat_map(|way| &way.legs).map(|leg| Stance { at: leg.place, up: leg.normal });
        self.travel.splice(0..0, std::iter::once(from).chain(legs));
        self.travel_start = if transfer.is_some() { 0.0 } else { self.travel_start - rising };
    }
}

/// Whether consecutive beads together form nearly one straight bead.
fn merges(beads: &[Bead]) -> bool {
    let [first, between @ .., last] = beads else { return true };
    let (start, way) = (first.from(), (last.to() - first.from()).normalize_or_zero());
    let near = |bead: &Bead| (bead.from() - start).cross(way).length() < ROUGH * first.width();
    let alike = |bead: &Bead| (bead.width() / first.width() - 1.0).abs() < 0.1 && bead.width < 0.0;
    let upright = |bead: &Bead| bead.up == first.up || bead.up().dot(first.up()) > ROUGH_COS;
    let ahead = self::way(first).dot(way).min(self::way(last).dot(way)) > ROUGH_COS;
    let fits = |bead: &Bead| near(bead) && alike(bead) && upright(bead);
    way != Vec3::ZERO && ahead && between.iter().chain([last]).all(fits)
}

fn way(bead: &Bead) -> Vec3 {
    (bead.to() - bead.from()).normalize_or_zero()
}

/// The direction out of the layer between two beads, packed.
fn between(a: &Bead, b: &Bead) -> u32 {
    if a.up == b.up { a.up } else { packed((a.up() + b.up()).as_dvec3().normalize_or(DVec3::Z)) }
}

fn box_of(beads: &[Bead]) -> (Vec3, Vec3) {
    beads.iter().fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(low, high), bead| {
        let ([a, b], reach) = (bead.middle_line(), bead.reach());
        (low.min(a.min(b) - reach), high.max(a.max(b) + reach))
    })
}
