//! How the deposit model treats plans made with a profile.

use super::turns::Unrolling;
use crate::chart::Chart;
use crate::deposit::{DepositSettings, Nominal};
use crate::layer::Layer;
use crate::process::StartStop;
use crate::profile::{LayersSection, Profile};
use crate::weld;
use glam::DVec3;
use planar::Bounds;
use std::borrow::Cow;

/// How layers are welded, for the deposit model.
#[derive(Debug, Clone, Copy)]
pub(crate) struct AsWelded<'p> {
    pub(super) unrolling: Unrolling<'p>,
    /// How passes begin and end.
    pub(super) ends: &'p StartStop,
    /// Height of the nominal bead, mm.
    pub(super) bead_height: f64,
    /// Whether passes fill the height of their layer as they are paced, or that of a usual layer.
    pub(super) fills_layers: bool,
}

impl<'p> AsWelded<'p> {
    /// A layer as its chart shows it; a wedge gets the metal of a layer of even thickness.
    pub(crate) fn even<'l>(&self, layer: &'l Layer) -> Cow<'l, Layer> {
        let Some(wedge) = self.unrolling.layers.wedge(layer) else { return Cow::Borrowed(layer) };
        let mut even = layer.clone();
        wedge.even(&mut even.passes);
        Cow::Owned(even)
    }

    /// How layers lie in space.
    pub(crate) fn layers(&self) -> &'p LayersSection {
        self.unrolling.layers
    }

    /// A layer with its ends as they are welded, even, and unrolled once.
    pub(crate) fn welded<'l>(&self, layer: &'l Layer) -> Cow<'l, Layer> {
        let welded = then(self.even(layer), |layer| self.with_ends(layer));
        then(welded, |layer| self.unrolling.once(layer))
    }

    /// The same for judging the layer alone.
    pub(crate) fn alone<'l>(&self, layer: &'l Layer) -> Cow<'l, Layer> {
        let mut welded = self.welded(layer);
        if let Some(wedge) = self.unrolling.layers.wedge(layer).filter(|_| layer.half.is_some()) {
            wedge.single(&mut welded.to_mut().passes, self.usual_height(layer.height));
        }
        welded
    }

    fn with_ends<'l>(&self, layer: &'l Layer) -> Cow<'l, Layer> {
        let ends = weld::ends_of(layer, self.ends);
        if !ends.changes_passes() {
            return Cow::Borrowed(layer);
        }
        let passes = layer.passes.iter().map(|pass| weld::welded(pass, &ends, self.bead_height)).collect();
        Cow::Owned(Layer { passes, ..layer.clone() })
    }

    /// The height that the passes of a layer (`height`, mm) fill at their pace before metal is shared out, mm.
    pub(crate) fn usual_height(&self, height: f64) -> f64 {
        if self.fills_layers { height } else { self.unrolling.layers.height }
    }
}

/// Applies one more change to a layer, unless it changes nothing.
fn then<'l>(layer: Cow<'l, Layer>, change: impl for<'a> Fn(&'a Layer) -> Cow<'a, Layer>) -> Cow<'l, Layer> {
    match layer {
        Cow::Borrowed(layer) => change(layer),
        Cow::Owned(layer) => Cow::Owned(change(&layer).into_owned()),
    }
}

/// A layer as its chart shows it; a wedge gets the metal of a layer of even thickness.
pub fn even<'a>(layer: &'a Layer, profile: &Profile) -> Cow<'a, Layer> {
    AsWelded::of(profile).even(layer)
}

/// A layer as it is welded, for the deposit model: with overlaps, hot starts, lead-outs, humps and craters where the
/// profile has them, [`even`] and [`unrolled_once`](super::unrolled_once).
pub fn welded<'a>(layer: &'a Layer, profile: &Profile) -> Cow<'a, Layer> {
    AsWelded::of(profile).welded(layer)
}

/// The same for judging the layer alone, when only one bead height is possible: each layer of a pair is judged as if it
/// were that high.
pub fn welded_alone<'a>(layer: &'a Layer, profile: &Profile) -> Cow<'a, Layer> {
    AsWelded::of(profile).alone(layer)
}

/// The deposit model's settings for plans made with a profile.
pub fn deposit_settings(profile: &Profile) -> DepositSettings {
    let (bead, pace) = (profile.bead(), profile.process.deposition_speed);
    let nominal = Nominal { bead, pace, rise: bead.rise(profile.stepover()) };
    // Layers of several bodies lie over one another only in space.
    let over_one_another = profile.layers.bodies.len() < 2 && !profile.layers.charts().any(Chart::goes_around);
    DepositSettings { over_one_another, ..DepositSettings::new(nominal, profile.fill.machining_allowance) }
}

/// Like [`deposit_settings`], with a grid fitted to a part: its lowest and its highest place, mm.
pub fn deposit_settings_over(profile: &Profile, part: (DVec3, DVec3)) -> DepositSettings {
    let (bounds, layers) = grid_over(profile, part);
    deposit_settings(profile).fitted_to(&bounds, layers)
}

/// What the grid for a part is fitted to: the box around it seen from above, and about how many layers it takes.
pub fn grid_over(profile: &Profile, part: (DVec3, DVec3)) -> (Bounds, usize) {
    grid(profile.layers.height, part)
}

/// The same for layers of a usual height, mm.
pub(super) fn grid(height: f64, (low, high): (DVec3, DVec3)) -> (Bounds, usize) {
    (Bounds { min: low.truncate(), max: high.truncate() }, (high.z / height) as usize)
}
