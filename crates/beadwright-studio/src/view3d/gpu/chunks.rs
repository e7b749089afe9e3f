//! The layers on the graphics card, in print order, so that any range of layers is one draw.
//!
//! Layers are stored in chunks of about [`CHUNK`] segments, since the size of a buffer is limited. When layers are
//! added or change, only what follows the first change is sent again; when only the colours change, only the values.

use super::globals::role;
use super::growing::Growing;
use super::values::{ValueKey, send_values};
use crate::view3d::beads::{Bead, Cap, LayerBeads};
use crate::view3d::scene::Scene;
use crate::view3d::style::{Colour, Style};
use bytemuck::{Pod, Zeroable};
use eframe::egui_wgpu::wgpu;
use std::ops::Range;

/// A chunk is full once it has this number of segments.
const CHUNK: usize = 1 << 19;

/// Consecutive layers are drawn together until they have this many segments.
const PIECE: u32 = 4096;

/// Layers with more segments would not fit in a buffer of 256 MiB and are not drawn.
const LARGEST_LAYER: usize = 8_000_000;

/// A point of something other than a bead.
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
#[repr(C)]
pub(super) struct Point {
    pub at: [f32; 3],
    pub role: u32,
}

/// A dot where a pass starts or ends, and the direction out of its layer there, packed.
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
#[repr(C)]
pub(super) struct Dot {
    pub at: [f32; 3],
    pub role: u32,
    pub up: u32,
}

/// Numbers of beads, caps, travel vertices and dots in a chunk up to the end of some layer.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Counts {
    pub beads: usize,
    pub rough: usize,
    pub caps: usize,
    pub travels: usize,
    pub dots: usize,
}

/// What is drawn of a chunk.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Ranges {
    /// Beads, in groups of whole consecutive layers, because it is best to draw the nearest first.
    pub beads: Vec<Range<u32>>,
    /// Rough beads, likewise.
    pub rough: Vec<Range<u32>>,
    pub caps: Range<u32>,
    pub travels: Range<u32>,
    pub dots: Range<u32>,
}

/// A layer in its chunk.
#[derive(Debug)]
pub(super) struct Slot {
    pub layer: usize,
    id: u64,
    pub ends: Counts,
    pub values: Option<ValueKey>,
}

/// Some consecutive layers.
#[derive(Debug)]
pub(super) struct Chunk {
    pub slots: Vec<Slot>,
    /// Starts with one bead that is not drawn, since each bead looks at the one before it.
    pub beads: Growing,
    pub bead_values: Growing,
    /// Starts with an undrawn bead, too.
    pub rough: Growing,
    pub rough_values: Growing,
    pub caps: Growing,
    pub cap_values: Growing,
    pub travels: Growing,
    pub dots: Growing,
}

/// The graphics card.
pub(super) type Card<'a> = (&'a wgpu::Device, &'a wgpu::Queue);

/// Updates the chunks to match the scene.
pub(super) fn sync(chunks: &mut Vec<Chunk>, card: Card<'_>, scene: &Scene, colour: Colour) {
    let wanted: Vec<(usize, &LayerBeads)> =
        scene.drawn_present().map(|(i, l)| (i, &**l)).filter(|(_, l)| l.len() <= LARGEST_LAYER).collect();
    let slots = chunks.iter().flat_map(|chunk| &chunk.slots);
    let same = slots.zip(&wanted).take_while(|(slot, (i, layer))| slot.layer == *i && slot.id == layer.id).count();
    truncate(chunks, same);
    let mut rest = &wanted[same..];
    while !rest.is_empty() {
        if chunks.last().is_none_or(|chunk| chunk.ends().beads >= CHUNK) {
            chunks.push(Chunk::new());
        }
        let Some(chunk) = chunks.last_mut() else { return };
        let mut room = CHUNK.saturating_sub(chunk.ends().beads);
        let fitting = rest.iter().take_while(|(_, layer)| {
            let fits = room > 0;
            room = room.saturating_sub(layer.len());
            fits
        });
        let (now, later) = rest.split_at(fitting.count().max(1));
        chunk.append(card, now);
        rest = later;
    }
    send_values(chunks, card, scene, colour);
}

/// Forgets all but the first `layers`.
fn truncate(chunks: &mut Vec<Chunk>, layers: usize) {
    let mut left = layers;
    chunks.retain_mut(|chunk| {
        let keep = left.min(chunk.slots.len());
        chunk.slots.truncate(keep);
        left -= keep;
        keep > 0
    });
}

impl Chunk {
    fn new() -> Self {
        Self {
            slots: Vec::new(),
            beads: Growing::new("beads"),
            bead_values: Growing::new("values of beads"),
            rough: Growing::new("rough beads"),
            rough_values: Growing::new("values of rough beads"),
            caps: Growing::new("caps"),
            cap_values: Growing::new("values of caps"),
            travels: Growing::new("travels"),
            dots: Growing::new("starts and ends"),
        }
    }

    fn ends(&self) -> Counts {
        self.slots.last().map(|slot| slot.ends).unwrap_or_default()
    }

    fn append(&mut self, card: Card<'_>, layers: &[(usize, &LayerBeads)]) {
        let begin = self.ends();
        let segments = layers.iter().map(|(_, layer)| layer.len()).sum::<usize>();
        let mut beads: Vec<Bead> = Vec::with_capacity(segments + 1);
        let (mut caps, mut travels, mut dots): (Vec<Cap>, Vec<Point>, Vec<Dot>) = Default::default();
        // A bead that is not drawn precedes the first one.
        let pad = usize::from(begin.beads == 0);
        beads.resize(pad, Bead::zeroed());
        let mut rough = beads.clone();
        for (index, layer) in layers {
            beads.extend_from_slice(&layer.beads);
            rough.extend_from_slice(&layer.rough);
            caps.extend_from_slice(&layer.caps);
            marks(layer, &mut travels, &mut dots);
            let ends = Counts {
                beads: begin.beads + beads.len() - pad,
                rough: begin.rough + rough.len() - pad,
                caps: begin.caps + caps.len(),
                travels: begin.travels + travels.len(),
                dots: begin.dots + dots.len(),
            };
            self.slots.push(Slot { layer: *index, id: layer.id, ends, values: None });
        }
        self.beads.write(card, begin.beads + 1 - pad, &beads);
        self.rough.write(card, begin.rough + 1 - pad, &rough);
        self.caps.write(card, begin.caps, &caps);
        self.travels.write(card, begin.travels, &travels);
        self.dots.write(card, begin.dots, &dots);
    }

    /// The ranges of this chunk that the style shows; of rough beads, only one layer in `every`.
    pub(super) fn ranges(&self, scene: &Scene, style: &Style, every: usize) -> Ranges {
        let first = self.slots.partition_point(|slot| slot.layer < *style.layers.start());
        let last = self.slots.partition_point(|slot| slot.layer <= *style.layers.end());
        if first >= last {
            return Ranges::default();
        }
        let end_of = |slots: usize| slots.checked_sub(1).map(|i| self.slots[i].ends).unwrap_or_default();
        let (begin, mut end, top) = (end_of(first), end_of(last), &self.slots[last - 1]);
        if let (Some(limit), Some(layer)) = (style.segments_of_last, scene.drawn_layer(top.layer))
            && top.layer == *style.layers.end()
        {
            end = partly(end_of(last - 1), layer, limit);
        }
        let range = |of: fn(&Counts) -> usize| of(&begin) as u32..of(&end) as u32;
        let unmarked = end_of(self.slots.partition_point(|slot| slot.layer < style.marks_from).clamp(first, last));
        let marks = |of: fn(&Counts) -> usize| of(&unmarked) as u32..of(&end).max(of(&unmarked)) as u32;
        Ranges {
            beads: self.pieces(first..last, range(|c| c.beads), |c| c.beads),
            rough: match scene.top(style) {
                Some(layer) if every > 1 => self.sparse(first..last, range(|c| c.rough), layer, every),
                _ => self.pieces(first..last, range(|c| c.rough), |c| c.rough),
            },
            caps: range(|c| c.caps),
            travels: marks(|c| c.travels),
            dots: marks(|c| c.dots),
        }
    }

    /// Splits a range of beads between layers into pieces of a few thousand segments.
    fn pieces(&self, slots: Range<usize>, beads: Range<u32>, of: fn(&Counts) -> usize) -> Vec<Range<u32>> {
        let (mut pieces, mut start) = (Vec::new(), beads.start);
        for end in self.slots[slots].iter().map(|slot| (of(&slot.ends) as u32).min(beads.end)) {
            if end - start >= PIECE || (end == beads.end && end > start) {
                pieces.push(start..end);
                start = end;
            }
        }
        pieces
    }

    /// The rough beads of one layer of `every`, counted down from the top one.
    fn sparse(&self, slots: Range<usize>, rough: Range<u32>, top: usize, every: usize) -> Vec<Range<u32>> {
        let (mut pieces, mut start) = (Vec::new(), rough.start);
        for slot in &self.slots[slots] {
            let end = (slot.ends.rough as u32).min(rough.end);
            if end > start && (top - slot.layer.min(top)).is_multiple_of(every) {
                pieces.push(start..end);
            }
            start = end;
        }
        pieces
    }

    /// Where the given segments of a layer and their caps are in this chunk.
    pub(super) fn place(&self, layer: &LayerBeads, index: usize, segments: Range<usize>) -> Option<Ranges> {
        let slot = self.slots.iter().position(|slot| slot.layer == index)?;
        let begin = slot.checked_sub(1).map(|i| self.slots[i].ends).unwrap_or_default();
        let caps = |segment: usize| begin.caps + layer.cap_segments.partition_point(|&s| (s as usize) < segment);
        let rough = |segment: usize| begin.rough + layer.rough_segments.partition_point(|&s| (s as usize) < segment);
        let covering = rough(segments.start) as u32..(rough(segments.end.saturating_sub(1)) + 1) as u32;
        let rough = if segments.is_empty() { Vec::new() } else { vec![covering] };
        let beads = (begin.beads + segments.start) as u32..(begin.beads + segments.end) as u32;
        Some(Ranges {
            caps: caps(segments.start) as u32..caps(segments.end) as u32,
            beads: vec![beads],
            rough,
            ..Ranges::default()
        })
    }
}

/// Where a layer ends if only this number of its segments is shown.
fn partly(begin: Counts, layer: &LayerBeads, segments: usize) -> Counts {
    let begun = || layer.passes().iter().filter(|pass| !pass.segments.is_empty() && pass.segments.start < segments);
    let dots = begun().map(|pass| 1 + usize::from(pass.segments.end <= segments)).sum::<usize>();
    Counts {
        beads: begin.beads + segments.min(layer.len()),
        rough: begin.rough + layer.rough_segments.partition_point(|&s| (s as usize) < segments),
        caps: begin.caps + layer.cap_segments.partition_point(|&s| (s as usize) < segments),
        travels: begin.travels + begun().map(|pass| 2 * pass.travel.len().saturating_sub(1)).sum::<usize>(),
        dots: begin.dots + dots,
    }
}

/// Travels as lines, and starts and ends of passes as dots.
fn marks(layer: &LayerBeads, travels: &mut Vec<Point>, dots: &mut Vec<Dot>) {
    for pass in layer.passes() {
        let (Some(first), Some(last)) =
            (layer.beads.get(pass.segments.start), layer.beads[pass.segments.clone()].last())
        else {
            continue;
        };
        for leg in pass.travel.windows(2).flatten() {
            travels.push(Point { at: leg.at.as_vec3().into(), role: role::TRAVEL });
        }
        dots.push(Dot { at: first.from().into(), role: role::START, up: first.up });
        dots.push(Dot { at: last.to().into(), role: role::END, up: last.up });
    }
}
