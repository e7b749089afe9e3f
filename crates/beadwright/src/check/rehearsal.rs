//! Writes a small program in each dialect of a profile and reads it back, so that dangerous lines in its templates and
//! settings are found before anything is planned.

use crate::chart::Chart;
use crate::dialect::reading::{self, Fault};
use crate::dialect::{self, own};
use crate::layer::Layer;
use crate::pass::{Along, Pass, PassKind};
use crate::profile::Profile;
use glam::{DVec2, DVec3};
use std::collections::BTreeMap;
use std::f64::consts::TAU;

/// Name of the part that is rehearsed.
const PART: &str = "rehearsal";

/// Moves of a circle.
const MOVES: usize = 72;

/// Dangerous lines of the programs that a profile writes, each with its dialect. Printers' programs and your own
/// dialects are not searched; what a profile cannot write at all is refused elsewhere.
pub fn rehearse(profile: &Profile) -> Vec<(String, Fault)> {
    // The lines of the profile are rehearsed; where the two layers lie does not matter.
    let mut profile = profile.clone();
    profile.layers.chart = Chart::default();
    profile.layers.bodies.clear();
    let profile = &profile;
    let posts = profile.posts.iter().filter(|post| !own::is_folder(post) && *post != "marlin");
    posts.flat_map(|post| faults(profile, post).into_iter().map(|fault| (post.clone(), fault))).collect()
}

fn faults(profile: &Profile, post: &str) -> Vec<Fault> {
    let bead = (profile.bead.width, profile.process.deposition_speed, profile.layers.height);
    let layers = [0, 1].map(|index| layer(bead, index));
    let Ok(files) = dialect::write(post, &layers, &profile.job(PART)) else { return Vec::new() };
    let Some((main, text)) = main_file(&files) else { return Vec::new() };
    let mut find = |name: &str| {
        let named = |file: &&String| {
            let stem = file.rsplit_once('.').map_or(file.as_str(), |(stem, _)| stem);
            file.eq_ignore_ascii_case(name) || (stem.eq_ignore_ascii_case(name) && !file.ends_with(".dat"))
        };
        files.keys().find(named).and_then(|file| files.get(file)).cloned()
    };
    let options = profile.reading_options(Some(main), Some(post));
    reading::read(text, &mut find, &options).map(|program| program.faults).unwrap_or_default()
}

/// The file that calls the others: the one with the shortest name that is neither data nor a list.
fn main_file(files: &BTreeMap<String, String>) -> Option<(&str, &str)> {
    let programs = files.iter().filter(|(file, _)| !file.ends_with(".dat") && !file.ends_with(".pgf"));
    programs.min_by_key(|(file, _)| file.len()).map(|(file, text)| (file.as_str(), text.as_str()))
}

/// A circle, and a line along which the torch becomes slower, with beads of a width (mm), a pace (mm/s) and a height (mm).
fn layer((width, pace, height): (f64, f64, f64), index: usize) -> Layer {
    let (z, radius) = (height * (index + 1) as f64, 10.0 * width);
    let around = |k: usize| radius * DVec2::from_angle(TAU * k as f64 / MOVES as f64);
    let circle = (0..MOVES).map(|k| around(k).extend(z)).collect();
    let along = |k: usize| DVec3::new(2.0 * radius + 4.0 * width * k as f64, 0.0, z);
    let pass = |kind, closed, points, pace| Pass { kind, closed, points, width: Along::Same(width), pace, wait: 0.0 };
    let paces = Along::Each(vec![pace, pace, 0.75 * pace, 0.75 * pace]);
    let passes = vec![
        pass(PassKind::Contour, true, circle, Along::Same(pace)),
        pass(PassKind::Infill, false, (0..4).map(along).collect(), paces),
    ];
    Layer { index, z, height, passes, ..Layer::default() }
}
