//! Temperatures computed afterwards are those of a plan that was made with them.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use beadwright::heat::Interpass;
use beadwright::layer::Layer;
use beadwright::model::Model;
use beadwright::profile::Profile;
use beadwright::task::Task;
use beadwright_studio::heat::temperatures;
use std::sync::Arc;

fn layers(name: &str, profile: &Profile) -> Vec<Arc<Layer>> {
    let model = Model::read(&beadwright::example::find(name).unwrap().stl(), &Task::new()).unwrap();
    let part = model.place(&Default::default(), None, profile.bead.width).unwrap();
    let plan = beadwright::plan::plan(name, part.mesh().unwrap(), profile, &Task::new()).unwrap();
    plan.layers.into_iter().map(Arc::new).collect()
}

#[test]
fn they_are_those_of_a_plan_with_a_limit_that_is_never_met() {
    for (name, strategy) in [("cross", "contour"), ("star", "zigzag")] {
        let mut profile = Profile::built_in("cmt-al2319-kuka").unwrap();
        strategy.clone_into(&mut profile.fill.strategy);
        profile.interpass = Some(Interpass { max_temperature: 1500.0, min_temperature: None, reorder: false });
        let with = layers(name, &profile);
        let found = temperatures(&with, &profile).unwrap();
        assert_eq!(found.len(), with.len());
        for (layer, found) in with.iter().zip(&found) {
            assert_eq!(layer.temperatures.len(), found.len());
            for (wanted, found) in layer.temperatures.iter().zip(&**found) {
                // With a limit, the model stops more often on the way, to see whether it must wait.
                let allowed = 0.5 + 0.03 * (wanted.start - 20.0);
                assert!((wanted.start - f64::from(*found)).abs() < allowed, "{name}: {found} °C, not {}", wanted.start);
            }
        }
    }
}

#[test]
fn a_profile_without_a_material_says_so() {
    let mut profile = Profile::built_in("cmt-al2319-kuka").unwrap();
    profile.material = None;
    let error = temperatures(&layers("cross", &profile), &profile).unwrap_err();
    assert!(error.contains("[material]"), "{error}");
}
