//! Whether passes lie on metal, judged by the beads of the passes below.

mod block;
mod hanging;
mod metal;

use crate::chart::Chart;
use crate::layer::Layer;
use crate::pass::Pass;
use crate::plan::charted::Across;
use crate::plan::turns::Unrolling;
use crate::slice::Half;
use crate::warning::{Warning, WarningKind};
use glam::DVec2;
use hanging::{Hanging, Places, hanging};
use metal::{CLEAR, Metal};
use planar::{Polygon, Region};

/// So does one with a stretch of this length, in bead widths, that is clear of all metal below it.
const BRIDGE: f64 = 2.0;
/// A new island in the air is left out up to this area, in squared bead widths, and up to this fraction of its layer,
/// unless the layer below has no passes.
const SMALL: f64 = 4.0;
const SMALL_PART: f64 = 0.5;
/// A pass in the air is left out up to this length, in bead widths.
const STUB: f64 = 2.0;
/// Number of places per bead width at which a pass is checked.
const SAMPLES: f64 = 4.0;
/// Beads sag onto a plate that lies no farther below them than this, in heights of a layer.
const SAGS: f64 = 1.25;
/// An island rests on another if they share at least this fraction of the smaller one's area.
const RESTS: f64 = 0.05;

/// What lies below the next layer.
#[derive(Default)]
pub(super) struct Support {
    /// The passes of the layer below.
    passes: Vec<Pass>,
    /// Its outlines, and which of them were left out because they overhang.
    islands: Vec<Polygon>,
    left_out: Vec<Polygon>,
    /// Passes and outlines of the layer below that one.
    before: (Vec<Pass>, Vec<Polygon>),
    /// Height of its middle, mm.
    middle: f64,
    /// Whether anything is welded yet.
    begun: bool,
    footing: Footing,
}

/// What counts as metal below a pass.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ground<'p> {
    pub(super) unrolling: Unrolling<'p>,
    /// Whether layers are filled completely; sparse ones support the next as if they were.
    pub(super) is_solid: bool,
    /// Whether beads are printed, which bridge gaps.
    pub(super) prints: bool,
}

/// What the layers of a body lie on, apart from one another.
#[derive(Debug, Clone)]
pub(super) struct Footing {
    /// Whether there is metal everywhere below the first layer: a plate, or what the chart takes for granted.
    pub(super) plate: bool,
    /// Metal of other bodies under each layer; empty where there is none.
    pub(super) metal: Vec<Under>,
}

impl Footing {
    /// A plate alone.
    pub(super) const PLATE: Self = Self { plate: true, metal: Vec::new() };
}

impl Default for Footing {
    fn default() -> Self {
        Self::PLATE
    }
}

/// Existing metal under a layer.
#[derive(Debug, Clone)]
pub(super) struct Under {
    /// Its outlines, in the unrolled coordinates of the layer's underside.
    pub(super) outlines: Vec<Polygon>,
    /// Height of that underside, mm.
    pub(super) height: f64,
}

impl Support {
    /// The support of a body that stands on `footing`.
    pub(super) fn on(footing: Footing) -> Self {
        Self { footing, ..Self::default() }
    }

    /// Outlines of the metal of other bodies that lies under a layer.
    pub(super) fn there(&self, layer: &Layer, chart: &Chart) -> Vec<Polygon> {
        let Some(under) = self.footing.metal.get(layer.index) else { return Vec::new() };
        match Across::new(chart, under.height, layer.middle()) {
            Some(across) => across.islands(&under.outlines),
            None => under.outlines.clone(),
        }
    }

    /// Warns of passes that lie in the air, takes out small overhanging islands, and remembers the layer for the next
    /// one. Sparse layers support the next as if they were filled, and printed beads bridge gaps. The upper layer of a
    /// pair lies on the lower one and on what lies below that.
    pub(super) fn judge(&mut self, layer: &mut Layer, ground: &Ground) {
        let Unrolling { layers, bead_width: width, .. } = ground.unrolling;
        if let Some(across) = Across::new(&layers.chart, self.middle, layer.middle()) {
            self.passes = across.passes(&self.passes);
            self.islands = across.islands(&self.islands);
            self.left_out = across.islands(&self.left_out);
        }
        if layer.half == Some(Half::Upper) {
            self.passes.append(&mut self.before.0);
            self.islands.append(&mut self.before.1);
        }
        let alike = self.left_out.is_empty() && self.islands == layer.islands;
        // What begins within the first layer only shows in the next one.
        let near_plate = layer.z - layer.height <= SAGS * layers.height;
        let on_plate = self.footing.plate && (!self.begun || near_plate);
        if !on_plate && !alike {
            let (metal, there) = (Metal::of(&self.passes, width), self.there(layer, &layers.chart));
            let below = if ground.is_solid { &there[..] } else { &[&there[..], &self.islands[..]].concat()[..] };
            let within = |p: DVec2| below.iter().any(|island| island.contains(p));
            let bands = ground.unrolling.bands(layer);
            let once = |p: DVec2| bands.as_ref().map_or(p, |bands| bands.place(p));
            // From one turn of the seam to the next no bead goes on.
            let room = |p: DVec2, ahead: DVec2, reach: f64| {
                let p = once(p);
                let room = metal.room(p, ahead, reach).map(|room| if bands.is_none() { room } else { 0.0 });
                room.or_else(|| within(p).then_some(0.0))
            };
            let bridge = if ground.prints { f64::INFINITY } else { BRIDGE * width };
            let places = Places { step: width / SAMPLES, bridge, clear: CLEAR * width };
            let hanging: Vec<Option<Hanging>> = layer.passes.iter().map(|pass| hanging(pass, places, room)).collect();
            self.left_out = self.take_out(layer, &hanging, width, once);
        } else if !alike {
            self.left_out.clear();
        }
        let passes = std::mem::replace(&mut self.passes, ground.unrolling.once(layer).passes.clone());
        self.before = (passes, std::mem::replace(&mut self.islands, layer.islands.clone()));
        self.middle = layer.middle();
        self.begun |= !layer.passes.is_empty();
    }

    /// Whether an island of the last layer judged was left out.
    pub(super) fn is_left_out(&self, island: &Polygon) -> bool {
        self.left_out.contains(island)
    }

    /// Whether a place of the layer below belongs to the part but got no bead.
    fn is_unwelded(&self, place: DVec2) -> bool {
        let within = |islands: &[Polygon]| islands.iter().any(|island| island.contains(place));
        within(&self.islands) && !within(&self.left_out)
    }

    /// Takes out short overhanging passes, and small new islands whose passes all overhang, and warns of other
    /// overhanging passes. `once` gives the place of a pass on the layer unrolled once. Returns the islands taken out.
    fn take_out(
        &self,
        layer: &mut Layer,
        hanging: &[Option<Hanging>],
        width: f64,
        once: impl Fn(DVec2) -> DVec2,
    ) -> Vec<Polygon> {
        if hanging.iter().all(Option::is_none) {
            return Vec::new();
        }
        let start = |pass: &Pass| once(pass.start().unwrap_or_default().truncate());
        let island_of = |pass: &Pass| layer.islands.iter().position(|island| island.contains(start(pass)));
        let of: Vec<Option<usize>> = layer.passes.iter().map(island_of).collect();
        let area = layer.islands.iter().map(Polygon::area).sum::<f64>();
        // Above a layer in which no bead fits, all islands are new.
        let part = if self.passes.is_empty() { 1.0 } else { SMALL_PART };
        let largest = (SMALL * width * width).min(part * area);
        let small = |i: usize| {
            let island = &layer.islands[i];
            let all = of.iter().zip(hanging).all(|(of, hanging)| *of != Some(i) || hanging.is_some());
            all && island.area() <= largest && !self.left_out.iter().any(|lower| stands_on(island, lower))
        };
        let out: Vec<bool> = (0..layer.islands.len()).map(small).collect();
        let (mut kept, mut taken) = (Vec::new(), vec![false; layer.islands.len()]);
        for ((pass, of), hanging) in std::mem::take(&mut layer.passes).into_iter().zip(of).zip(hanging) {
            match of.filter(|i| hanging.is_some() && out[*i]) {
                Some(i) => taken[i] = true,
                None if hanging.is_some() && pass.length() <= STUB * width => {
                    let (kind, size) = (WarningKind::HangingIsland, pass.length() * width);
                    layer.warnings.push(Warning { kind, layer: layer.index, place: start(&pass), size });
                }
                None => {
                    if let Some(Hanging { length: size, place }) = *hanging {
                        let kind = if self.is_unwelded(once(place)) {
                            WarningKind::OverUnwelded
                        } else {
                            WarningKind::InTheAir
                        };
                        layer.warnings.push(Warning { kind, layer: layer.index, place, size });
                    }
                    kept.push(pass);
                }
            }
        }
        layer.passes = kept;
        let taken: Vec<Polygon> =
            layer.islands.iter().zip(taken).filter(|(_, taken)| *taken).map(|(island, _)| island.clone()).collect();
        for island in &taken {
            let place = island.outer.points().first().copied().unwrap_or_default();
            let (kind, size) = (WarningKind::HangingIsland, island.area());
            layer.warnings.push(Warning { kind, layer: layer.index, place, size });
            layer.planned_area = (layer.planned_area - size).max(0.0);
        }
        taken
    }
}

fn stands_on(island: &Polygon, lower: &Polygon) -> bool {
    let common = Region::from(island.clone()).intersection(&Region::from(lower.clone())).area();
    common > RESTS * island.area().min(lower.area())
}
