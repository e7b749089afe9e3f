//! How the deposit model treats plans made with a profile.

use super::turns::unrolled_once;
use crate::chart::Chart;
use crate::deposit::{DepositSettings, Nominal};
use crate::layer::Layer;
use crate::profile::Profile;
use crate::weld;
use glam::DVec3;
use planar::Bounds;
use std::borrow::Cow;

/// A layer as its chart shows it; a wedge gets the metal of a layer of even thickness.
pub fn even<'a>(layer: &'a Layer, profile: &Profile) -> Cow<'a, Layer> {
    let Some(wedge) = profile.layers.wedge(layer) else { return Cow::Borrowed(layer) };
    let mut even = layer.clone();
    wedge.even(&mut even.passes);
    Cow::Owned(even)
}

/// A layer as it is welded, for the deposit model: with overlaps, hot starts, lead-outs, humps and craters where the
/// profile has them, [`even`] and [`unrolled_once`].
pub fn welded<'a>(layer: &'a Layer, profile: &Profile) -> Cow<'a, Layer> {
    then(then(even(layer, profile), profile, as_welded), profile, unrolled_once)
}

/// The same for judging the layer alone, when only one bead height is possible: each layer of a pair is judged as if it
/// were that high.
pub fn welded_alone<'a>(layer: &'a Layer, profile: &Profile) -> Cow<'a, Layer> {
    let mut welded = welded(layer, profile);
    if let Some(wedge) = profile.layers.wedge(layer).filter(|_| layer.half.is_some()) {
        wedge.single(&mut welded.to_mut().passes, profile.usual_height(layer.height));
    }
    welded
}

/// Applies one more change to a layer, unless it changes nothing.
fn then<'a>(
    layer: Cow<'a, Layer>,
    profile: &Profile,
    change: for<'l> fn(&'l Layer, &Profile) -> Cow<'l, Layer>,
) -> Cow<'a, Layer> {
    match layer {
        Cow::Borrowed(layer) => change(layer, profile),
        Cow::Owned(layer) => Cow::Owned(change(&layer, profile).into_owned()),
    }
}

fn as_welded<'a>(layer: &'a Layer, profile: &Profile) -> Cow<'a, Layer> {
    let ends = weld::ends_of(layer, &profile.start_stop);
    if !ends.changes_passes() {
        return Cow::Borrowed(layer);
    }
    let passes = layer.passes.iter().map(|pass| weld::welded(pass, &ends, profile.bead.height)).collect();
    Cow::Owned(Layer { passes, ..layer.clone() })
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
pub fn grid_over(profile: &Profile, (low, high): (DVec3, DVec3)) -> (Bounds, usize) {
    (Bounds { min: low.truncate(), max: high.truncate() }, (high.z / profile.layers.height) as usize)
}
