//! Whether passes lie on metal, judged by the footprints of the passes below.

use crate::fill::line_index::LineIndex;
use crate::layer::Layer;
use crate::pass::Pass;
use crate::warning::{Warning, WarningKind};
use glam::DVec2;
use planar::polyline::distance_squared_to_segment;
use planar::{Polygon, Region};

/// A pass with less than this part of its length over metal lies in the air.
const LEAST: f64 = 0.5;
/// A new island in the air is left out up to this area, in squared bead widths.
const SMALL: f64 = 4.0;
/// A pass in the air is left out up to this length, in bead widths.
const STUB: f64 = 2.0;
/// Places per bead width at which a pass is looked at.
const SAMPLES: f64 = 4.0;
/// An island stands on another from this part of the smaller one's area on.
const STANDS: f64 = 0.05;

/// What lies below the next layer.
#[derive(Default)]
pub(super) struct Support {
    /// The passes of the layer below; `None` before the first layer, which lies on the plate.
    metal: Option<Metal>,
    /// Outlines of the layer below.
    islands: Vec<Polygon>,
    /// Those of them that were left out, since they hang.
    left_out: Vec<Polygon>,
}

/// Footprints of passes.
struct Metal {
    index: LineIndex,
    /// Half the width of each piece of each pass, mm.
    halves: Vec<Vec<f64>>,
}

impl Support {
    /// Warns of passes that lie in the air, takes small islands out that hang, and remembers the layer for the next one.
    /// `solid` tells whether layers are filled; on sparse ones the next lie as if they were.
    pub(super) fn judge(&mut self, layer: &mut Layer, width: f64, solid: bool) {
        let alike = self.left_out.is_empty() && self.islands == layer.islands;
        if let Some(metal) = self.metal.take().filter(|_| !alike) {
            let over = |p: DVec2| metal.is_at(p) || (!solid && self.islands.iter().any(|island| island.contains(p)));
            let hanging: Vec<bool> = layer.passes.iter().map(|pass| hangs(pass, width, over)).collect();
            self.left_out = self.take_out(layer, &hanging, width);
        } else if !alike {
            self.left_out.clear();
        }
        self.metal = (!layer.passes.is_empty()).then(|| Metal::of(&layer.passes, width));
        self.islands.clone_from(&layer.islands);
    }

    /// Whether an island of the layer that was judged last was left out.
    pub(super) fn is_left_out(&self, island: &Polygon) -> bool {
        self.left_out.contains(island)
    }

    /// Takes out stubs that hang and small new islands whose passes all do, and warns of other passes that hang. The islands
    /// taken out.
    fn take_out(&self, layer: &mut Layer, hanging: &[bool], width: f64) -> Vec<Polygon> {
        if !hanging.contains(&true) {
            return Vec::new();
        }
        let start = |pass: &Pass| pass.start().unwrap_or_default().truncate();
        let island_of = |pass: &Pass| layer.islands.iter().position(|island| island.contains(start(pass)));
        let of: Vec<Option<usize>> = layer.passes.iter().map(island_of).collect();
        let small = |i: usize| {
            let island = &layer.islands[i];
            let all = of.iter().zip(hanging).all(|(of, hangs)| *of != Some(i) || *hangs);
            all && island.area() <= SMALL * width * width && !self.left_out.iter().any(|lower| stands_on(island, lower))
        };
        let out: Vec<bool> = (0..layer.islands.len()).map(small).collect();
        let (mut kept, mut taken) = (Vec::new(), vec![false; layer.islands.len()]);
        for ((pass, of), hangs) in std::mem::take(&mut layer.passes).into_iter().zip(of).zip(hanging) {
            match of.filter(|i| *hangs && out[*i]) {
                Some(i) => taken[i] = true,
                None if *hangs && pass.length() <= STUB * width => {
                    let (kind, size) = (WarningKind::HangingIsland, pass.length() * width);
                    layer.warnings.push(Warning { kind, layer: layer.index, place: start(&pass), size });
                }
                None => {
                    if *hangs {
                        let (kind, size) = (WarningKind::InTheAir, pass.length());
                        layer.warnings.push(Warning { kind, layer: layer.index, place: start(&pass), size });
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
    common > STANDS * island.area().min(lower.area())
}

/// Whether less than `LEAST` of a pass's length lies over metal.
fn hangs(pass: &Pass, width: f64, over: impl Fn(DVec2) -> bool) -> bool {
    let places = places_along(pass, width / SAMPLES);
    let needed = (LEAST * places.len() as f64).ceil() as usize;
    places.into_iter().filter(|place| over(*place)).take(needed).count() < needed
}

/// Places on a pass, `step` (mm) apart.
fn places_along(pass: &Pass, step: f64) -> Vec<DVec2> {
    let (mut along, mut next, mut places) = (0.0, 0.0, Vec::new());
    for piece in pass.segments().filter(|piece| piece.from.is_finite()) {
        let length = piece.length();
        while next <= along + length {
            let share = if length > 0.0 { (next - along) / length } else { 0.0 };
            places.push(piece.from.lerp(piece.to, share).truncate());
            next += step;
        }
        along += length;
    }
    places
}

impl Metal {
    fn of(passes: &[Pass], width: f64) -> Self {
        let halves: Vec<Vec<f64>> =
            passes.iter().map(|pass| pass.segments().map(|piece| piece.width / 2.0).collect()).collect();
        let widest = halves.iter().flatten().copied().fold(width / 2.0, f64::max);
        let mut index = LineIndex::new(widest);
        for (number, pass) in passes.iter().enumerate() {
            let ends = pass.segments().next().map(|piece| piece.from).into_iter().chain(pass.segments().map(|p| p.to));
            index.add_line(number, &ends.map(|p| p.truncate()).collect::<Vec<_>>());
        }
        Self { index, halves }
    }

    fn is_at(&self, p: DVec2) -> bool {
        self.index.near(p).any(|(line, piece, a, b)| {
            let half = self.halves[line].get(piece).copied().unwrap_or_default();
            distance_squared_to_segment(p, a, b) <= half * half
        })
    }
}
