//! One layer as it is drawn and timed: its segments in print order, the passes, and the travels between them.
//!
//! This is plain data, made on a worker thread. Numbers that only the picture needs are `f32`.

use beadwright::layer::Layer;
use beadwright::pass::{Pass, PassKind};
use beadwright::weld::{Torch, path};
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
}

impl Bead {
    /// Where it begins, mm; z is its top.
    pub fn from(&self) -> Vec3 {
        self.from.into()
    }

    /// Where it ends, mm; z is its top.
    pub fn to(&self) -> Vec3 {
        self.to.into()
    }

    /// Width, mm.
    pub fn width(&self) -> f32 {
        self.width.abs()
    }

    /// Height, mm.
    pub fn height(&self) -> f32 {
        self.height.abs()
    }
}

/// A round end or joint, as the graphics card reads it; mm.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub(super) struct Cap {
    pub at: [f32; 3],
    pub width: f32,
    pub height: f32,
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
    /// When the torch may leave.
    pub end: f64,
    /// The travel to it: from where the torch was, up, across, down; empty before the very first pass.
    pub travel: Vec<DVec3>,
}

/// A layer's segments, passes and travels in print order.
#[derive(Debug)]
pub struct LayerBeads {
    pub(super) id: u64,
    pub(super) beads: Vec<Bead>,
    pub(super) speeds: Vec<f32>,
    /// When each segment ends, s from the start of the layer.
    pub(super) ends: Vec<f32>,
    pub(super) passes: Vec<PassSpan>,
    pub(super) caps: Vec<Cap>,
    /// The segment with which each cap appears.
    pub(super) cap_segments: Vec<u32>,
    /// The same beads with fewer segments, for a view in motion.
    pub(super) rough: Vec<Bead>,
    /// The last segment that each rough one stands for.
    pub(super) rough_segments: Vec<u32>,
    /// Lowest and highest corner of each block of [`BLOCK`] segments, mm.
    pub(super) boxes: Vec<(Vec3, Vec3)>,
    seconds: f64,
}

static NEXT_ID: AtomicU64 = AtomicU64::new(1);

/// A number that no other caller gets; comparing it shows whether something changed.
pub(super) fn fresh_id() -> u64 {
    NEXT_ID.fetch_add(1, Ordering::Relaxed)
}

impl LayerBeads {
    /// A layer as the torch runs it, with the wait before it.
    pub fn of(layer: &Layer, torch: &mut Torch) -> Self {
        let count = layer.passes.iter().map(|p| p.points.len()).sum();
        let mut beads = Self {
            id: fresh_id(),
            beads: Vec::with_capacity(count),
            speeds: Vec::with_capacity(count),
            ends: Vec::with_capacity(count),
            passes: Vec::with_capacity(layer.passes.len()),
            caps: Vec::new(),
            cap_segments: Vec::new(),
            rough: Vec::new(),
            rough_segments: Vec::new(),
            boxes: Vec::new(),
            seconds: 0.0,
        };
        let begun = torch.begin_layer(layer, 0);
        beads.seconds = begun.moving() + begun.waiting();
        for (i, pass) in layer.passes.iter().enumerate() {
            beads.add(pass, layer.height, torch);
            if let (Some(span), Some(temperature)) = (beads.passes.last_mut(), layer.temperatures.get(i)) {
                span.temperature = Some(temperature.start as f32);
            }
        }
        beads.boxes = beads.beads.chunks(BLOCK).map(box_of).collect();
        beads
    }

    fn add(&mut self, pass: &Pass, height: f64, torch: &mut Torch) {
        let first = self.beads.len();
        let (travel_start, mut arrival, mut travel) = (self.seconds, self.seconds, Vec::new());
        if let Some(start) = pass.start() {
            let (from, up) = (torch.at(), torch.retract());
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
            for (segment, speed) in pass.segments().zip(speeds) {
                clock += segment.length() / speed * stretch;
                let (from, to) = (segment.from.as_vec3().into(), segment.to.as_vec3().into());
                self.beads.push(Bead { from, width: segment.width as f32, to, height: height as f32 });
                self.speeds.push(speed as f32);
                self.ends.push(clock as f32);
            }
            self.seconds = arc_start + welded.moving + welded.crater + welded.after;
        }
        let segments = first..self.beads.len();
        self.join(segments.clone());
        self.roughen(segments.clone());
        let kind = pass.kind;
        let (temperature, end) = (None, self.seconds);
        self.passes.push(PassSpan { kind, temperature, segments, travel_start, arrival, arc_start, end, travel });
    }

    /// Mitres the gentle bends of a pass and rounds its ends and sharp corners.
    fn join(&mut self, segments: Range<usize>) {
        let Some(first) = self.beads.get(segments.start) else { return };
        let start = Cap { at: first.from, width: first.width, height: first.height };
        self.caps.push(start);
        self.cap_segments.push(segments.start as u32);
        for i in segments.clone() {
            let here = self.beads[i];
            let next = (i + 1 < segments.end).then(|| self.beads[i + 1]);
            if next.is_some_and(|next| way(&here).dot(way(&next)) > MITRE_COS) {
                self.beads[i].height = -here.height;
                self.beads[i + 1].width = -self.beads[i + 1].width;
            } else {
                self.caps.push(Cap { at: here.to, width: here.width.abs(), height: here.height });
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
            self.rough.push(Bead { to: end.to, height: end.height, ..begin });
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
        let numbers = self.speeds.capacity() + self.ends.capacity() + self.cap_segments.capacity();
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

/// Whether consecutive beads together are nearly one straight bead.
fn merges(beads: &[Bead]) -> bool {
    let [first, between @ .., last] = beads else { return true };
    let (start, way) = (first.from(), (last.to() - first.from()).normalize_or_zero());
    let near = |bead: &Bead| (bead.from() - start).cross(way).length() < ROUGH * first.width();
    let alike = |bead: &Bead| (bead.width() / first.width() - 1.0).abs() < 0.1 && bead.width < 0.0;
    let ahead = self::way(first).dot(way).min(self::way(last).dot(way)) > ROUGH_COS;
    way != Vec3::ZERO && ahead && between.iter().chain([last]).all(|bead| near(bead) && alike(bead))
}

fn way(bead: &Bead) -> Vec3 {
    (bead.to() - bead.from()).normalize_or_zero()
}

fn box_of(beads: &[Bead]) -> (Vec3, Vec3) {
    beads.iter().fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(low, high), bead| {
        let (a, b, reach) = (bead.from(), bead.to(), bead.width() / 2.0);
        let below = Vec3::new(reach, reach, bead.height());
        (low.min(a.min(b) - below), high.max(a.max(b) + Vec3::new(reach, reach, 0.0)))
    })
}
