//! Parts built in the heat model: what goes in stays or is lost, whatever the grid and the angle, and waits end when the
//! metal is as cool as the limit says.

use beadwright::glam::{DVec2, dvec2};
use beadwright::heat::{Build, HeatSettings, LayerHeat};
use beadwright::layer::Layer;
use beadwright::pass::{Along, Pass, PassKind};
use beadwright::{Profile, Task, example};
use planar::{Bounds, Polygon, Ring};

/// The steel profile.
fn profile() -> Profile {
    Profile::built_in("cmt-steel-abb").unwrap()
}

/// A wall of `count` layers along a line, turned about the origin, with `wait` seconds before each layer.
fn wall(profile: &Profile, length: f64, degrees: f64, count: usize, wait: f64) -> Vec<Layer> {
    let turn = |p: DVec2| DVec2::from_angle(degrees.to_radians()).rotate(p);
    let (width, height) = (profile.bead.width, profile.layers.height);
    let layer = |index: usize| {
        let z = (index + 1) as f64 * height;
        let ends = [dvec2(-length / 2.0, 0.0), dvec2(length / 2.0, 0.0)].map(turn);
        let points = if index.is_multiple_of(2) { ends.to_vec() } else { vec![ends[1], ends[0]] };
        let half = dvec2(length, width) / 2.0;
        let outline = [dvec2(-half.x, -half.y), dvec2(half.x, -half.y), half, dvec2(-half.x, half.y)].map(turn);
        let pass = Pass {
            kind: PassKind::Wall,
            closed: false,
            points: points.into_iter().map(|p| p.extend(z)).collect(),
            width: Along::Same(width),
            pace: Along::Same(profile.process.deposition_speed),
            wait: if index > 0 { wait } else { 0.0 },
        };
        let islands = vec![Polygon::simple(Ring::new(outline.to_vec()))];
        Layer { index, z, height, islands, passes: vec![pass], ..Layer::default() }
    };
    (0..count).map(layer).collect()
}

/// The same plate at any angle: as long as it is wide.
fn bounds(layers: &[Layer]) -> Bounds {
    let points = layers.iter().flat_map(|l| &l.islands).flat_map(|i| i.outer.points());
    let reach = points.fold(0.0, |reach: f64, p| reach.max(p.length()));
    Bounds { min: DVec2::splat(-reach), max: DVec2::splat(reach) }
}

fn begin(profile: &Profile, settings: &HeatSettings, layers: &[Layer]) -> Build {
    let tops: Vec<(f64, f64)> = layers.iter().map(|l| (l.z, l.height)).collect();
    Build::new(settings, &profile.weld_settings(), &bounds(layers), &tops)
}

fn run(profile: &Profile, layers: &[Layer]) -> (Build, Vec<LayerHeat>) {
    let mut build = begin(profile, &profile.heat_settings().unwrap(), layers);
    let heats = layers.iter().map(|layer| build.layer(layer)).collect();
    (build, heats)
}

/// Plans an example part without limits.
fn planned(name: &str, profile: &Profile) -> Vec<Layer> {
    let part = beadwright::Model::read(&example::find(name).unwrap().stl(), &Task::new()).unwrap();
    let part = part.place(&beadwright::Placement::default(), None, profile.bead.width).unwrap();
    beadwright::plan(name, &part, profile, &Task::new()).unwrap().layers
}

#[test]
fn metal_and_heat_are_those_of_the_program() {
    for (name, base) in [("cross", "cmt-steel-abb"), ("vase", "cmt-steel-robots")] {
        let profile = Profile::built_in(base).unwrap();
        let layers = planned(name, &profile);
        let (build, heats) = run(&profile, &layers);
        let mut totals = beadwright::Metrics::new(&profile);
        layers.iter().for_each(|layer| totals.add(layer));
        let body = build.body();
        // All metal above the plate.
        let metal: f64 = (0..body.grid().len()).filter(|v| body.grid().middle(*v).z > 0.0).map(|v| body.metal(v)).sum();
        assert!((metal / totals.deposited_volume_mm3 - 1.0).abs() < 1e-6, "{name}: {metal} mm³");
        assert!((build.seconds() / totals.total_time_s - 1.0).abs() < 1e-6, "{name}: {} s", build.seconds());
        let power = profile.process.current.unwrap() * profile.process.voltage.unwrap();
        let arc = totals.arc_time_s + profile.process.arc_start_delay * totals.passes as f64;
        let supplied = profile.heat.unwrap().arc_efficiency * power * arc;
        assert!((body.supplied() / supplied - 1.0).abs() < 1e-6, "{name}: {} J for {supplied}", body.supplied());
        let missing = body.supplied() - body.lost() - body.energy();
        println!(
            "{name}: balance {:.1e}, last start {:.0} °C",
            missing.abs() / supplied,
            heats.last().unwrap().passes[0].start
        );
        assert!(missing.abs() <= 1e-6 * body.supplied(), "{name}: {missing} J");
    }
}

/// Rises over the surroundings in the last half of the layers, K: mean of what lies below, and where passes begin.
fn rises(profile: &Profile, degrees: f64, wait: f64) -> [f64; 2] {
    let heats = run(profile, &wall(profile, 120.0, degrees, 20, wait)).1;
    let late = &heats[heats.len() / 2..];
    let mean = |of: fn(&LayerHeat) -> f64| late.iter().map(|h| of(h) - 20.0).sum::<f64>() / late.len() as f64;
    [mean(|heat| heat.below), mean(|heat| heat.passes[0].start)]
}

/// How much two values differ, as a fraction.
fn apart(a: f64, b: f64) -> f64 {
    (a / b - 1.0).abs()
}

#[test]
fn a_wall_is_as_warm_at_any_angle() {
    let profile = profile();
    for wait in [30.0, 120.0] {
        let straight = rises(&profile, 0.0, wait);
        for degrees in [15.0, 30.0, 45.0, 77.0, 90.0, 133.0] {
            let turned = rises(&profile, degrees, wait);
            println!("wait {wait} s, {degrees}°: {turned:.0?} K for {straight:.0?} K");
            assert!(apart(turned[0], straight[0]) < 0.04, "{degrees}°: {turned:?} K for {straight:?} K");
            assert!(apart(turned[1], straight[1]) < 0.15, "{degrees}°: {turned:?} K for {straight:?} K");
        }
    }
}

#[test]
fn finer_voxels_say_the_same() {
    for wait in [30.0, 120.0] {
        let at = |voxel: f64| {
            let mut profile = profile();
            profile.heat.as_mut().unwrap().voxel = Some(voxel);
            rises(&profile, 0.0, wait)
        };
        let [coarse, own, fine, finest] = [at(8.0), at(4.5), at(3.0), at(2.0)];
        println!("wait {wait} s: {coarse:.0?}, {own:.0?}, {fine:.0?}, {finest:.0?} K with voxels of 8, 4.5, 3, 2 mm");
        assert!(apart(own[0], finest[0]) < 0.08 && apart(own[1], finest[1]) < 0.13, "{own:?} {finest:?}");
    }
}

#[test]
fn waits_end_when_the_metal_is_cool_enough() {
    for limit in [120.0, 200.0] {
        let mut profile = profile();
        profile.interpass = Some(beadwright::heat::Interpass {
            max_temperature: limit,
            min_temperature: None,
            reorder: false,
            along: false,
        });
        let mut layers = wall(&profile, 80.0, 20.0, 16, 0.0);
        let settings = profile.heat_settings().unwrap();
        let mut build = begin(&profile, &settings, &layers);
        layers.iter_mut().for_each(|layer| drop(build.layer_within_limits(layer)));
        assert!(layers.iter().map(|l| l.passes[0].wait).sum::<f64>() > 60.0, "the torch waits");
        // Told the same waits, the model finds the same temperatures; with a second less it is too hot.
        let heats = run(&profile, &layers).1;
        let hottest = heats.iter().filter_map(LayerHeat::hottest_start).fold(0.0, f64::max);
        assert!(hottest <= limit + 1.0, "{hottest} °C");
        for index in (0..layers.len()).step_by(5).filter(|i| layers[*i].passes[0].wait > 3.0) {
            let mut sooner = layers[..=index].to_vec();
            sooner[index].passes[0].wait -= 2.0;
            let heats = run(&profile, &sooner).1;
            assert!(heats[index].passes[0].start > limit - 1.0, "layer {index} waits too long");
        }
    }
}

/// A spiral of touching rings meets the metal that it has just laid: with `along` it waits on its way, and lays the same beads.
#[test]
fn the_limit_holds_all_along_a_pass_on_request() {
    let (w, limit) = (profile().bead.width, 150.0);
    let spiral =
        |k: usize| DVec2::from_angle(0.1 * k as f64) * (12.0 + 0.7 * w * 0.1 * k as f64 / std::f64::consts::TAU);
    for reorder in [false, true] {
        let mut profile = profile();
        let along = true;
        profile.interpass =
            Some(beadwright::heat::Interpass { max_temperature: limit, min_temperature: None, reorder, along });
        let mut layers = wall(&profile, 60.0, 0.0, 4, 0.0);
        for layer in &mut layers {
            let z = layer.z;
            let points: Vec<_> = (0..320).map(|k| (spiral(k) + dvec2(30.0, 0.0)).extend(z)).collect();
            layer.passes = vec![Pass { points, closed: false, ..layer.passes[0].clone() }];
        }
        let whole = layers.clone();
        let settings = profile.heat_settings().unwrap();
        let mut build = begin(&profile, &settings, &layers);
        let heats: Vec<LayerHeat> = layers.iter_mut().map(|layer| build.layer_within_limits(layer)).collect();
        let spacing = build.spacing();
        for ((layer, before), heat) in layers.iter().zip(&whole).zip(&heats) {
            let (cuts, length) = (heat.cuts.len(), |l: &Layer| l.passes.iter().map(Pass::length).sum::<f64>());
            assert_eq!(layer.passes.len(), cuts + 1);
            assert!(cuts > 0 && cuts < 20, "{cuts}");
            // Each begins one bead width back on the one before.
            assert!((length(layer) - length(before) - cuts as f64 * w).abs() < 1e-6);
            for (pass, heat) in layer.passes.iter().zip(&heat.passes) {
                assert!(heat.start <= limit + 1.0 && pass.length() >= 4.0 * w - 1e-6, "{heat:?}");
                for (k, ahead) in heat
                    .along
                    .iter()
                    .enumerate()
                    .filter(|(k, _)| pass.length() >= 8.0 * w && *k as f64 * spacing > 4.0 * w + spacing)
                {
                    assert!(*ahead <= limit + 2.0, "{ahead} °C at {k}");
                }
            }
        }
        // Told the same passes and waits, the model finds the same temperatures.
        for (again, heat) in run(&profile, &layers).1.iter().zip(&heats) {
            for (again, heat) in again.passes.iter().zip(&heat.passes) {
                assert!((again.peak().1 - heat.peak().1).abs() < 3.0, "{} {}", again.peak().1, heat.peak().1);
            }
        }
        // Without it the same spiral meets hotter metal.
        profile.interpass.as_mut().unwrap().along = false;
        let mut plain = whole.clone();
        let mut build = begin(&profile, &profile.heat_settings().unwrap(), &plain);
        let heats: Vec<LayerHeat> = plain.iter_mut().map(|layer| build.layer_within_limits(layer)).collect();
        let peak = heats.iter().flat_map(|h| &h.passes).map(|p| p.peak().1).fold(0.0, f64::max);
        println!(
            "a spiral at {limit} °C meets {peak:.0} °C, and waits {} times with along",
            layers.iter().map(|l| l.passes.len() - 1).sum::<usize>()
        );
        assert!(peak > limit + 20.0 && plain.iter().all(|l| l.passes.len() == 1), "{peak}");
    }
}

#[test]
fn cooler_starts_and_other_islands_save_waiting() {
    let mut profile = profile();
    let mut layers = Vec::new();
    for (i, mut layer) in wall(&profile, 60.0, 0.0, 12, 0.0).into_iter().enumerate() {
        // Three walls; every layer begins with the one that the last layer ended with.
        let at = |row: f64| move |p: DVec2| p + dvec2(0.0, 40.0 * row);
        let mut rows: Vec<f64> = vec![0.0, 1.0, 2.0];
        if i % 2 == 1 {
            rows.reverse();
        }
        let (pass, island) = (layer.passes[0].clone(), layer.islands[0].clone());
        let moved = |row: f64| {
            let mut pass = pass.clone();
            pass.points.iter_mut().for_each(|p| *p = at(row)(p.truncate()).extend(p.z));
            pass
        };
        layer.passes = rows.iter().map(|row| moved(*row)).collect();
        let ring = |row: f64| Polygon::simple(Ring::new(island.outer.points().iter().map(|p| at(row)(*p)).collect()));
        layer.islands = rows.iter().map(|row| ring(*row)).collect();
        layers.push(layer);
    }
    let mut time = |reorder: bool| {
        profile.interpass =
            Some(beadwright::heat::Interpass { max_temperature: 150.0, min_temperature: None, reorder, along: false });
        let mut own = layers.clone();
        let mut build = begin(&profile, &profile.heat_settings().unwrap(), &own);
        own.iter_mut().for_each(|layer| drop(build.layer_within_limits(layer)));
        for (layer, before) in own.iter().zip(&layers) {
            assert_eq!(layer.passes.len(), before.passes.len(), "no pass is lost");
            let length = |l: &Layer| l.passes.iter().map(Pass::length).sum::<f64>();
            assert!((length(layer) - length(before)).abs() < 1e-9);
        }
        build.seconds()
    };
    let (planned, ours) = (time(false), time(true));
    println!("three walls: {planned:.0} s in the planned order, {ours:.0} s reordered");
    assert!(ours < 0.95 * planned, "{ours} s for {planned} s");
}

/// A plan whose passes wait is as warm when it is looked at afterwards as when it was made.
#[test]
fn a_plan_is_as_warm_afterwards() {
    let mut profile = beadwright::Profile::built_in("cmt-al2319-kuka").unwrap();
    let limits =
        beadwright::heat::Interpass { max_temperature: 150.0, min_temperature: None, reorder: true, along: true };
    profile.interpass = Some(limits);
    let part = beadwright::Model::read(&example::find("propeller").unwrap().stl(), &Task::new()).unwrap();
    let part = part.place(&beadwright::Placement::default(), None, profile.bead.width).unwrap();
    let mut plan = beadwright::plan("propeller", &part, &profile, &Task::new()).unwrap();
    let over = Some(plan.header.extent.seen_from_above());
    let settings = HeatSettings { interpass: None, over, ..profile.heat_settings().unwrap() };
    let history = beadwright::heat::history(&mut plan.layers, &settings, &profile.weld_settings(), &Task::new());
    let history = history.unwrap().unwrap();
    let passes =
        plan.layers.iter().zip(&history.layers).flat_map(|(layer, heat)| layer.temperatures.iter().zip(&heat.passes));
    let worst =
        passes.clone().map(|(a, b)| (a.start - b.start).abs().max((a.mean - b.mean()).abs())).fold(0.0, f64::max);
    let ahead = history.hottest_ahead().unwrap().2;
    println!("{} passes, at most {worst:.1} K apart, {ahead:.0} °C ahead", passes.count());
    assert!(worst < 8.0 && ahead < 155.0, "{worst} {ahead}");
}

#[test]
fn longer_steps_far_from_the_torch_change_next_to_nothing() {
    let profile = Profile::built_in("cmt-steel-robots").unwrap();
    let plan = beadwright::plan("vase", &example::find("vase").unwrap().mesh(), &profile, &Task::new()).unwrap();
    let points = plan.layers.iter().flat_map(|l| &l.passes).flat_map(|p| &p.points).map(|p| p.truncate());
    let bounds = Bounds::of(points).unwrap();
    let tops: Vec<(f64, f64)> = plan.layers.iter().map(|l| (l.z, l.height)).collect();
    let starts = |every_step_short: bool| {
        let settings = profile.heat_settings().unwrap();
        let mut build = Build::new(&settings, &profile.weld_settings(), &bounds, &tops);
        if every_step_short {
            build.be_patient(0.0);
        }
        let passes = plan.layers.iter().take(60).flat_map(|layer| build.layer(layer).passes);
        passes.map(|pass| pass.start).collect::<Vec<f64>>()
    };
    let (eager, patient) = (starts(true), starts(false));
    assert!(eager.len() > 50);
    let worst = eager.iter().zip(&patient).map(|(a, b)| (b / a - 1.0).abs()).fold(0.0, f64::max);
    println!("longer steps far away change starts by {:.2} % at most", 100.0 * worst);
    assert!(worst < 0.03, "{worst}");
}
