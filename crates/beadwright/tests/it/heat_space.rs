//! Heat where it is in space: a build is as warm however its layers lie, and bodies warm one another.

use crate::common;

use beadwright::heat::{self, HeatSettings, History, Interpass, LayerHeat};
use beadwright::layer::Layer;
use beadwright::plan::Plan;
use beadwright::profile::{Body, Profile};
use beadwright::{Metrics, Task, example};

/// The example part as its own bodies say, or as level layers.
fn planned(name: &str, profile: &Profile) -> (Plan, Profile) {
    let (example, mut profile) = (example::find(name).unwrap(), profile.clone());
    profile.layers.bodies = example.bodies().map(|bodies| Body::read(&bodies).unwrap()).unwrap_or_default();
    let plan = common::planned_once(name, &example.mesh(), &profile).unwrap();
    (plan, profile)
}

fn warmed(layers: &[Layer], profile: &Profile) -> History {
    let settings = HeatSettings { interpass: None, ..profile.heat_settings().unwrap() };
    heat::history(&mut layers.to_vec(), &settings, &profile.weld_settings(), &Task::new()).unwrap().unwrap()
}

/// Mean temperatures ahead of the torch of all layers but the first, °C.
fn means(history: &History) -> Vec<f64> {
    let mean = |layer: &LayerHeat| {
        let all = || layer.passes.iter().flat_map(|pass| &pass.along);
        all().sum::<f64>() / all().count().max(1) as f64
    };
    history.layers.iter().skip(1).map(mean).collect()
}

#[test]
fn a_build_is_as_warm_however_it_leans() {
    for (name, base) in [("cross", "cmt-al2319-kuka"), ("star", "cmt-steel-robots"), ("vase", "cmt-steel-robots")] {
        let (plan, mut profile) = planned(name, &common::profile(base));
        let layers = &plan.layers[..plan.layers.len().min(16)];
        let level = means(&warmed(layers, &profile));
        for up in ["0/0/1", "1/0/0", "1/1/1", "-0.3/0.2/-0.8"] {
            profile.layers.chart = format!("plane:up={up},through=0/0/1").parse().unwrap();
            let leaning = means(&warmed(layers, &profile));
            let ratios: Vec<f64> = level.iter().zip(&leaning).map(|(a, b)| b / a).collect();
            let mean = ratios.iter().sum::<f64>() / ratios.len() as f64;
            let worst = ratios.iter().map(|ratio| (ratio - 1.0).abs()).fold(0.0, f64::max);
            println!("{name}, up {up}: {mean:.3} times as warm, worst layer off by {worst:.3}");
            assert!((mean - 1.0).abs() < 0.07 && worst < 0.15, "{name}, {up}: {mean} {worst}");
        }
    }
}

/// The plate is as large as the profile says, however it lies.
#[test]
fn the_plate_has_its_volume_at_any_angle() {
    let (plan, mut profile) = planned("cross", &common::profile("cmt-steel-robots"));
    let bounds = beadwright::layer::bounds(&plan.layers).unwrap();
    for thickness in [2.0, 7.0, 20.0] {
        profile.substrate.as_mut().unwrap().thickness = thickness;
        let margin = profile.substrate.unwrap().margin;
        // Slices reach a bead's half beyond the passes, about.
        let size = bounds.size() + 2.0 * margin;
        for up in ["0/0/1", "1/0/0", "1/1/1", "-0.3/0.2/-0.8"] {
            profile.layers.chart = format!("plane:up={up},through=0/0/1").parse().unwrap();
            let build = heat::plate(&plan.layers, &profile.heat_settings().unwrap(), &profile.weld_settings()).unwrap();
            let body = build.body();
            let metal: f64 = (0..body.grid().len()).map(|voxel| body.metal(voxel)).sum();
            let wanted = size.x * size.y * thickness;
            println!("{thickness} mm, up {up}: {:.3} of the plate", metal / wanted);
            assert!((metal / wanted - 1.0).abs() < 0.06, "{thickness} mm, {up}: {metal} for {wanted} mm³");
        }
    }
}

#[test]
fn no_heat_and_no_metal_are_lost_in_space() {
    let base = common::profile("cmt-steel-robots");
    for name in ["hub", "elbow", "y-tube", "dome"] {
        let (plan, profile) = planned(name, &base);
        let (settings, weld) = (profile.heat_settings().unwrap(), profile.weld_settings());
        let mut build = heat::plate(&plan.layers, &settings, &weld).unwrap();
        let before: f64 = (0..build.body().grid().len()).map(|voxel| build.body().metal(voxel)).sum();
        let mut totals = Metrics::new(&profile);
        for layer in plan.layers.iter().take(12) {
            build.layer(layer);
            totals.add(layer);
        }
        let body = build.body();
        let metal = (0..body.grid().len()).map(|voxel| body.metal(voxel)).sum::<f64>() - before;
        assert!((metal / totals.deposited_volume_mm3 - 1.0).abs() < 1e-6, "{name}: {metal} mm³");
        let missing = body.supplied() - body.lost() - body.energy();
        assert!(missing.abs() <= 1e-6 * body.supplied(), "{name}: {missing} J");
    }
}

/// A body that begins on another is not cold.
#[test]
fn bodies_warm_one_another() {
    let (plan, profile) = planned("y-tube", &common::profile("cmt-steel-robots"));
    let history = warmed(&plan.layers, &profile);
    let first = plan.layers.iter().position(|layer| layer.body == 1).unwrap();
    let (trunk, branch) = (history.layers[0].passes[0].start, history.layers[first].passes[0].start);
    println!("the trunk begins at {trunk:.0} °C, the branch at {branch:.0} °C");
    assert!(trunk < 21.0 && branch > 60.0, "{trunk} {branch}");
}

/// Waits keep the limit in space too, and a plan is as warm afterwards as when it was made.
#[test]
fn waits_keep_the_limit_around_an_axis_and_along_a_guide() {
    for (name, limit) in [("hub", 200.0), ("y-tube", 600.0)] {
        let limits = Interpass { max_temperature: limit, min_temperature: None, reorder: true, along: false };
        let mut base = common::profile("cmt-steel-robots");
        base.interpass = Some(limits);
        let (plan, profile) = planned(name, &base);
        let history = warmed(&plan.layers, &profile);
        let hottest = history.hottest_start().unwrap().2;
        let starts = plan
            .layers
            .iter()
            .zip(&history.layers)
            .flat_map(|(layer, heat)| layer.temperatures.iter().zip(&heat.passes));
        let apart = starts.map(|(planned, found)| (planned.start - found.start).abs()).fold(0.0, f64::max);
        println!(
            "{name}: hottest start {hottest:.0} °C, at most {apart:.1} K from what was planned, {:.0} s of waits",
            history.waits()
        );
        assert!(hottest < limit + 5.0 && apart < 5.0 && history.waits() > 60.0, "{name}: {hottest} {apart}");
    }
}
