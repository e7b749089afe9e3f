//! Whether the torch has room next to finished parts, where parts are welded one after another.
//!
//! Torch and hand fill a cone above the wire's tip ([`TorchShape`]). Parts are taken to be as wide as the extents of
//! their layers: never narrower than they are.

use super::{Header, Sink};
use crate::layer::Layer;
use crate::process::TorchShape;
use planar::Bounds;

/// The extent of the metal of a layer, and its top, mm.
type Slab = (f64, Bounds);

/// The finished parts, and where the torch came too close to one of them.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Clearance {
    standing: Vec<(String, Vec<Slab>)>,
    close: Vec<Close>,
}

/// A finished part that is too close to one that is being welded.
#[derive(Debug, Clone, PartialEq)]
pub struct Close {
    /// The part that is being welded.
    pub welded: String,
    /// The finished part.
    pub standing: String,
    /// Height of the wire's tip, mm.
    pub z: f64,
    /// Height at which the other part is too close, mm.
    pub height: f64,
    /// The room that the torch needs there next to its path, mm.
    pub needs: f64,
    /// The room that it has, mm.
    pub has: f64,
}

impl Close {
    fn lacks(&self) -> f64 {
        self.needs - self.has
    }

    /// What would happen, and the remedy.
    pub fn sentence(&self) -> String {
        let Self { welded, standing, z, height, needs, has } = self;
        format!(
            "The torch would hit {standing} while it welds {welded} at z {z:.1} mm: at a height of {height:.1} mm it needs \
             {needs:.1} mm next to its path and has {has:.1} mm (section [torch]). Place the parts {:.0} mm farther apart, or \
             build them together, layer by layer.",
            self.lacks().ceil()
        )
    }
}

impl Clearance {
    /// Begins the next part; all earlier ones are finished.
    pub fn begin(&mut self, part: &str) {
        self.standing.push((part.to_owned(), Vec::new()));
    }

    /// Checks the next layer of the part, with beads of this `width`, mm.
    pub fn layer(&mut self, layer: &Layer, torch: &TorchShape, width: f64) {
        let path = Bounds::of(layer.passes.iter().flat_map(|pass| &pass.points).map(|point| point.truncate()));
        let (Some(path), Some(((welded, own), before))) = (path, self.standing.split_last_mut()) else { return };
        let half = glam::DVec2::splat(width / 2.0);
        own.push((layer.z, Bounds { min: path.min - half, max: path.max + half }));
        for (standing, slabs) in before {
            let near = slabs.iter().filter_map(|(height, extent)| {
                let (needs, has) = (torch.radius(height - layer.z)?, apart(&path, extent));
                (has < needs).then_some((needs, has, *height))
            });
            let worst = near.max_by(|a, b| (a.0 - a.1).total_cmp(&(b.0 - b.1)));
            if let Some((needs, has, height)) = worst {
                let (welded, standing) = (welded.clone(), standing.clone());
                note(&mut self.close, Close { welded, standing, z: layer.z, height, needs, has });
            }
        }
    }

    /// Each pair of parts that come too close, at its worst place.
    pub fn close(&self) -> &[Close] {
        &self.close
    }

    /// Height of the finished parts, not counting the one being welded, mm.
    pub fn height(&self) -> f64 {
        let before = self.standing.split_last().map_or(&[][..], |(_, before)| before);
        before.iter().flat_map(|(_, slabs)| slabs).map(|(z, _)| *z).fold(0.0, f64::max)
    }
}

/// Keeps the worst place of each pair.
fn note(close: &mut Vec<Close>, new: Close) {
    match close.iter_mut().find(|old| old.welded == new.welded && old.standing == new.standing) {
        Some(old) if old.lacks() < new.lacks() => *old = new,
        Some(_) => {}
        None => close.push(new),
    }
}

/// Distance between two extents, mm.
fn apart(a: &Bounds, b: &Bounds) -> f64 {
    (a.min - b.max).max(b.min - a.max).max(glam::DVec2::ZERO).length()
}

/// Hands layers on and checks where the torch goes.
pub struct Watch<'a, S> {
    /// Receives the layers.
    pub sink: &'a mut S,
    /// The finished parts.
    pub clearance: &'a mut Clearance,
    /// Shape of the torch.
    pub torch: TorchShape,
    /// Width of a bead, mm.
    pub width: f64,
}

impl<S: Sink> Sink for Watch<'_, S> {
    type Error = S::Error;

    fn begin(&mut self, header: &Header) -> Result<(), S::Error> {
        self.sink.begin(header)
    }

    fn layer(&mut self, layer: Layer) -> Result<(), S::Error> {
        self.clearance.layer(&layer, &self.torch, self.width);
        self.sink.layer(layer)
    }

    fn asks_how_it_grows(&self) -> bool {
        self.sink.asks_how_it_grows()
    }
}
