//! The plan welded in the model of height: metal is conserved, the same seed gives the same build, and feedback by place
//! keeps the height.
#![allow(clippy::unwrap_used, reason = "a test may fail by panic, in its helpers too")]

mod common;

use beadwright::adapt::{Feedback, Rules};
use beadwright::build::{Built, Errors, Settings, build};
use beadwright::layer::Layer;
use beadwright::plan;
use beadwright::profile::Profile;
use beadwright::task::Task;
use common::{planned, profile_by};

fn walls() -> Vec<(&'static str, Vec<Layer>, Profile)> {
    let case = |(part, width): (&'static str, f64)| {
        let mut profile = profile_by("cmt-steel-abb", "wall");
        profile.bead.width = width;
        (part, planned(part, &profile).layers, profile)
    };
    [("wall", 4.5), ("blade", 3.5)].map(case).into()
}

fn settings(profile: &Profile, seed: u64) -> Settings {
    let errors = Errors { pass: 0.1, along: 0.1, correlation: 20.0, drift: 0.03, lost: Some(25), scan: 0.0, seed };
    let rules = Rules { window: (0.7, 1.3), spacing: profile.bead.width };
    Settings { nominal: plan::deposit_settings(profile).nominal, errors, rules }
}

fn built(layers: &[Layer], by: Feedback, settings: &Settings) -> Built {
    build(layers, by, settings, &Task::new()).unwrap().unwrap()
}

#[test]
#[ignore = "the figures of docs/height.md"]
fn twenty_seeds() {
    let seeds: u64 = std::env::var("SEEDS").map_or(20, |n| n.parse().unwrap());
    for (part, layers, profile) in walls() {
        println!("{part}: {} layers of {:.3} mm", layers.len(), layers[1].height);
        for by in [Feedback::None, Feedback::Mean, Feedback::Place] {
            let rms: Vec<f64> = (1..=seeds).map(|seed| built(&layers, by, &settings(&profile, seed)).rms()).collect();
            let pooled = (rms.iter().map(|r| r * r).sum::<f64>() / rms.len() as f64).sqrt();
            let worst = rms.iter().copied().fold(0.0, f64::max);
            let kept = rms.iter().filter(|r| **r <= 0.2).count();
            println!("{by:?} {pooled:.3} worst {worst:.3} within 0.2: {kept}");
        }
    }
}
