//! The plan welded in the model of height: metal is conserved, errors level and grow as closed forms say, the same seed
//! gives the same build, and feedback by place keeps the height.

use crate::common;

use beadwright::adapt::area::core;
use beadwright::adapt::{Feedback, Rules, Surface, pieces};
use beadwright::build::{Built, Errors, Settings, build};
use beadwright::deposit::Nominal;
use beadwright::layer::Layer;
use beadwright::pass::{Along, Pass};
use beadwright::plan;
use beadwright::profile::Profile;
use beadwright::task::Task;
use common::{flat, planned, profile, profile_by};
use std::f64::consts::TAU;

/// Fifty layers each of a straight wall and of a blade that turns on its way up.
fn walls() -> Vec<(&'static str, Vec<Layer>, Profile)> {
    let case = |(part, width): (&'static str, f64)| {
        let mut profile = profile_by("cmt-steel-abb", "wall");
        profile.bead.width = width;
        let mut layers = planned(part, &profile).layers;
        layers.truncate(50);
        (part, layers, profile)
    };
    [("wall", 4.5), ("blade", 3.5)].map(case).into()
}

const PERFECT: Errors = Errors { pass: 0.0, along: 0.0, correlation: 20.0, drift: 0.0, lost: None, scan: 0.0, seed: 1 };

/// The errors of the goal.
fn usual(seed: u64) -> Errors {
    Errors { pass: 0.1, along: 0.1, drift: 0.03, lost: Some(25), seed, ..PERFECT }
}

fn built(layers: &[Layer], profile: &Profile, by: Feedback, errors: Errors) -> Built {
    let rules = Rules { window: (0.7, 1.3), spacing: profile.bead.width };
    let settings = Settings { nominal: nominal(profile), errors, rules, heat: None };
    build(layers, by, &settings, &Task::new()).unwrap().unwrap()
}

fn nominal(profile: &Profile) -> Nominal {
    plan::deposit_settings(profile).nominal
}

/// Root mean square over builds, in layer heights.
fn pooled(rms: &[f64]) -> f64 {
    (rms.iter().map(|r| r * r).sum::<f64>() / rms.len() as f64).sqrt()
}

/// A layer whose metal is that of the plan times `metal`, by the distance along the pass (mm).
fn with_metal(layer: &Layer, metal: impl Fn(f64) -> f64) -> Layer {
    let pass = |pass: &Pass| {
        let fine = pieces(pass, 0.25);
        let mut along = 0.0;
        let mut paces: Vec<f64> = Vec::new();
        for segment in fine.segments() {
            paces.push(segment.pace / metal(along + segment.length() / 2.0));
            along += segment.length();
        }
        paces.extend(paces.last().copied().filter(|_| !fine.closed));
        Pass { pace: Along::Each(paces), ..fine }
    };
    Layer { passes: layer.passes.iter().map(pass).collect(), ..layer.clone() }
}

/// Metal of a layer, mm³: length × area, from the paces alone.
fn metal(layer: &Layer, profile: &Profile) -> f64 {
    let rate = profile.bead().area() * profile.process.deposition_speed;
    layer.passes.iter().flat_map(Pass::segments).map(|s| s.length() * rate / s.pace).sum()
}

#[test]
fn the_surface_holds_the_metal_that_was_laid() {
    let cross = flat(profile("cmt-al2319-kuka"));
    let layers = planned("cross", &cross).layers;
    let straight = walls().remove(0);
    for (part, layers, profile) in [("cross", layers, cross), straight] {
        let mut surface = Surface::plate(&layers, nominal(&profile));
        let mut fed = 0.0;
        for layer in layers.iter().take(8) {
            let laid = with_metal(layer, |s| 1.05 + 0.2 * (s / 9.0).sin());
            surface.lay(layer, &laid);
            fed += metal(&laid, &profile) - metal(layer, &profile);
        }
        let held = surface.excess_volume();
        println!("{part}: {held:.2} mm³ held, {fed:.2} mm³ fed too much");
        assert!((held - fed).abs() < 1e-3 * fed.abs(), "{part}: {held} {fed}");
    }
}

#[test]
fn a_wave_levels_by_the_gauss_curve_of_a_third_bead() {
    let (_, layers, profile) = walls().remove(0);
    for length in [15.0, 20.0, 30.0] {
        let wave = TAU / length;
        let mut surface = Surface::plate(&layers, nominal(&profile));
        let mut amplitudes = Vec::new();
        for (k, layer) in layers.iter().take(6).enumerate() {
            let laid = if k == 0 { with_metal(layer, |s| 1.0 + 0.2 * (wave * s).sin()) } else { layer.clone() };
            surface.lay(layer, &laid);
            // Its part in the middle of the wall, over two whole waves, by projection.
            let grid = surface.grid();
            let inner = |i: &usize| (grid.place(i % grid.columns, 0).x + 1e-9).abs() <= length;
            let points: Vec<usize> = core(grid, &layer.islands, profile.bead.width).into_iter().filter(inner).collect();
            let part = |f: fn(f64) -> f64| {
                let value = |i: &usize| surface.error(*i).unwrap() * f(wave * grid.place(i % grid.columns, 0).x);
                2.0 * points.iter().map(value).sum::<f64>() / points.len() as f64
            };
            amplitudes.push(part(f64::sin).hypot(part(f64::cos)));
        }
        let expected = (-(wave * profile.bead.width / 3.0).powi(2) / 2.0).exp();
        for pair in amplitudes.windows(2).skip(1) {
            let kept = pair[1] / pair[0];
            println!("{length} mm: {kept:.4} of a wave is kept a layer, the closed form says {expected:.4}");
            assert!((kept - expected).abs() < 0.02, "{length}: {kept} {expected}");
        }
    }
}

#[test]
fn without_errors_the_plan_is_built() {
    for (part, layers, profile) in walls() {
        for by in [Feedback::None, Feedback::Mean, Feedback::Place] {
            let built = built(&layers, &profile, by, PERFECT);
            assert_eq!(built.layers.len(), layers.len(), "{part} {by:?}");
            assert!(built.end.rms < 1e-6 && built.clipped == 0, "{part} {by:?}: {:?}", built.end);
        }
    }
}

#[test]
fn errors_from_pass_to_pass_add_up_without_feedback_and_only_the_last_counts_with_it() {
    let (_, layers, profile) = walls().remove(0);
    let (mut open, mut closed) = (Vec::new(), Vec::new());
    for seed in 1..=40 {
        let errors = Errors { pass: 0.1, seed, ..PERFECT };
        open.push(built(&layers, &profile, Feedback::None, errors).rms());
        closed.extend(built(&layers, &profile, Feedback::Place, errors).layers.iter().map(|l| l.error.mean / 1.4187));
    }
    let (open, closed) = (pooled(&open), pooled(&closed));
    println!("open loop {open:.3}, √50 · 0.1 = 0.707; with feedback {closed:.4}, 0.1 of a layer");
    assert!((open / 0.707 - 1.0).abs() < 0.25);
    assert!((closed / 0.1 - 1.0).abs() < 0.05);
}

#[test]
fn a_lost_pass_is_made_up_for() {
    for (part, layers, profile) in walls() {
        let built = built(&layers, &profile, Feedback::Place, Errors { lost: Some(20), ..PERFECT });
        let lost = built.layers[19].error;
        assert!(lost.mean < -0.9 * layers[19].height, "{part}: {lost:?}");
        assert!(built.end.rms < 0.01 * built.layer_height, "{part}: {:?}", built.end);
        // One layer more, or as many that are thicker.
        assert!((0..=1).contains(&(built.layers.len() - layers.len())), "{part}: {}", built.layers.len());
    }
}

#[test]
fn feedback_by_place_keeps_the_height() {
    for (part, layers, profile) in walls() {
        let rms = |by| {
            let rms: Vec<f64> = (1..=6).map(|seed| built(&layers, &profile, by, usual(seed)).rms()).collect();
            pooled(&rms)
        };
        let [open, mean, place] = [Feedback::None, Feedback::Mean, Feedback::Place].map(rms);
        println!("{part}: open loop {open:.3}, by the mean {mean:.3}, by place {place:.3} layer heights");
        assert!(place <= 0.2, "{part}: {place}");
        assert!(place <= 0.85 * mean && mean < open, "{part}: {place} {mean} {open}");
    }
}

#[test]
fn the_same_seed_gives_the_same_build_whatever_the_threads() {
    let (_, layers, profile) = walls().remove(1);
    let errors = Errors { scan: 0.1, ..usual(3) };
    let run = |threads| {
        let pool = rayon_pool(threads);
        let built = pool.install(|| built(&layers, &profile, Feedback::Place, errors));
        (built.layers, built.end)
    };
    assert_eq!(run(1), run(2));
    let other = built(&layers, &profile, Feedback::Place, Errors { seed: 4, ..errors });
    assert_ne!(run(1).1, other.end);
}

fn rayon_pool(threads: usize) -> rayon::ThreadPool {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap()
}

#[test]
#[ignore = "the figures of docs/height.md: cargo test -p beadwright --test it -- build:: --ignored --nocapture"]
fn twenty_seeds() {
    for (part, layers, profile) in walls() {
        println!("{part}: {} layers of {:.3} mm", layers.len(), layers[1].height);
        let runs = [0.0, 0.2].map(|scan| {
            [Feedback::None, Feedback::Mean, Feedback::Place].map(|by| {
                let rms: Vec<f64> =
                    (1..=20).map(|seed| built(&layers, &profile, by, Errors { scan, ..usual(seed) }).rms()).collect();
                let worst = rms.iter().copied().fold(0.0, f64::max);
                let within = rms.iter().filter(|r| **r <= 0.2).count();
                println!("  scan ±{scan} mm, {by:?}: {:.3}, worst {worst:.3}, {within} of 20 within 0.2", pooled(&rms));
                pooled(&rms)
            })
        });
        for [_, mean, place] in runs {
            assert!(place <= 0.2 && place <= 0.85 * mean, "{part}");
        }
    }
}
