//! The values that the colours are made from. A layer's values are sent again when its beads, the quantity shown, or
//! the layers before it have changed.

use super::chunks::{Card, Chunk, Counts};
use super::growing::Growing;
use crate::view3d::beads::LayerBeads;
use crate::view3d::palette::{self, KINDS};
use crate::view3d::scene::Scene;
use crate::view3d::style::Colour;

/// The value of a segment that has none.
const MISSING: f32 = -2e30;

/// What the values of a layer depend on besides the layer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct ValueKey {
    colour: Colour,
    segments_before: usize,
    seconds_before: f64,
    supplied: u64,
}

/// Sends the values of all layers for which they have changed.
pub(super) fn send_values(chunks: &mut [Chunk], card: Card<'_>, scene: &Scene, colour: Colour) {
    let (mut segments, mut seconds) = (0, 0.0);
    for chunk in chunks {
        let (mut begin, mut run) = (Counts::default(), Run::default());
        for slot in &mut chunk.slots {
            let (here, ends) = (begin, slot.ends);
            begin = ends;
            let Some(layer) = scene.drawn_layer(slot.layer) else { continue };
            let supplied = match colour {
                Colour::HeightError => scene.values(slot.layer),
                Colour::Temperature => scene.temperatures(slot.layer),
                Colour::OffLevel => scene.leans(slot.layer),
                Colour::Movement => scene.movements(slot.layer),
                _ => None,
            };
            let key = ValueKey {
                colour,
                segments_before: if colour == Colour::Order { segments } else { 0 },
                seconds_before: if colour == Colour::Time { seconds } else { 0.0 },
                supplied: supplied.map_or(0, |values| values.id),
            };
            segments += layer.len();
            seconds += layer.seconds();
            if slot.values.replace(key) == Some(key) {
                run.send(card, [&mut chunk.bead_values, &mut chunk.rough_values, &mut chunk.cap_values]);
                continue;
            }
            if run.beads.is_empty() {
                run.first = here;
            }
            let from = run.beads.len();
            values_of(layer, &key, supplied.map(|values| &*values.of), &mut run.beads);
            run.caps.extend(layer.cap_segments.iter().map(|&s| run.beads[from + s as usize]));
            run.rough.extend(layer.rough_segments.iter().map(|&s| run.beads[from + s as usize]));
        }
        run.send(card, [&mut chunk.bead_values, &mut chunk.rough_values, &mut chunk.cap_values]);
    }
}

/// Values of consecutive layers, to be sent together.
#[derive(Default)]
struct Run {
    first: Counts,
    beads: Vec<f32>,
    rough: Vec<f32>,
    caps: Vec<f32>,
}

impl Run {
    fn send(&mut self, card: Card<'_>, [beads, rough, caps]: [&mut Growing; 3]) {
        beads.write(card, self.first.beads, &self.beads);
        rough.write(card, self.first.rough, &self.rough);
        caps.write(card, self.first.caps, &self.caps);
        self.beads.clear();
        self.rough.clear();
        self.caps.clear();
    }
}

/// A supplied value, where there is one.
fn known(supplied: Option<&[f32]>, index: usize) -> f32 {
    supplied.and_then(|values| values.get(index)).copied().filter(|value| value.is_finite()).unwrap_or(MISSING)
}

fn values_of(layer: &LayerBeads, key: &ValueKey, supplied: Option<&[f32]>, out: &mut Vec<f32>) {
    match key.colour {
        Colour::Speed => out.extend(&layer.speeds),
        Colour::Width => out.extend(layer.beads.iter().map(|bead| bead.width())),
        Colour::Order => out.extend((0..layer.len()).map(|i| (key.segments_before + i) as f32)),
        Colour::Time => out.extend(layer.ends.iter().map(|&end| (key.seconds_before + f64::from(end)) as f32)),
        Colour::HeightError => out.extend((0..layer.len()).map(|i| known(supplied, layer.piece(i)))),
        // Bodies colour the part; beads have none of their own.
        Colour::Body => out.extend(std::iter::repeat_n(MISSING, layer.len())),
        Colour::OffLevel | Colour::Movement => out.extend((0..layer.len()).map(|i| known(supplied, i))),
        Colour::Temperature => {
            for (i, pass) in layer.passes().iter().enumerate() {
                let known = pass.temperature.or_else(|| supplied?.get(i).copied());
                out.extend(std::iter::repeat_n(known.unwrap_or(MISSING), pass.segments.len()));
            }
        }
        Colour::Kind => {
            for pass in layer.passes() {
                let colour = palette::kind(pass.kind);
                let kind = KINDS.iter().position(|k| palette::kind(*k) == colour).unwrap_or_default();
                out.extend(std::iter::repeat_n(kind as f32, pass.segments.len()));
            }
        }
    }
}
