//! Temperatures computed afterwards are those of a plan that was made with them.

use beadwright::heat::plate;
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
fn they_are_those_that_the_model_finds_layer_by_layer() {
    for (name, strategy) in [("cross", "contour"), ("star", "zigzag")] {
        let mut profile = Profile::built_in("cmt-al2319-kuka").unwrap();
        profile.fill.strategy = strategy.parse().unwrap();
        let layers = layers(name, &profile);
        let found = temperatures(&layers, &profile).unwrap();
        let owned: Vec<Layer> = layers.iter().map(|layer| (**layer).clone()).collect();
        let mut build = plate(&owned, &profile.heat_settings().unwrap(), &profile.weld_settings()).unwrap();
        for (layer, found) in owned.iter().zip(&found) {
            let wanted: Vec<f32> = build.layer(layer).passes.iter().map(|pass| pass.start as f32).collect();
            assert_eq!(**found, wanted, "{name}, layer {}", layer.index);
        }
    }
}

#[test]
fn a_wait_between_layers_lets_the_metal_cool() {
    let mut profile = Profile::built_in("cmt-al2319-kuka").unwrap();
    let without = temperatures(&layers("cross", &profile), &profile).unwrap();
    profile.start_stop.interpass_time = 300.0;
    let with = temperatures(&layers("cross", &profile), &profile).unwrap();
    for (layer, (hot, cool)) in without.iter().zip(&with).enumerate().skip(1) {
        assert!(cool[0] < hot[0] - 1.0 && cool[0] > 20.0, "layer {layer}: {} and {} °C", hot[0], cool[0]);
    }
}

#[test]
fn a_profile_without_a_material_says_so() {
    let mut profile = Profile::built_in("cmt-al2319-kuka").unwrap();
    profile.material = None;
    let error = temperatures(&layers("cross", &profile), &profile).unwrap_err();
    assert!(error.contains("[material]"), "{error}");
}
