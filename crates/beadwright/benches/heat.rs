//! The heat model at size: `cargo bench -p beadwright --bench heat`. Time, steps of growth in beads and voxels, and what
//! choosing islands and starts by temperature saves.
#![allow(clippy::unwrap_used, missing_docs)]

use beadwright::glam::{DVec2, dvec2};
use beadwright::heat::{self, Build, HeatSettings, Interpass};
use beadwright::layer::Layer;
use beadwright::pass::{Along, Pass, PassKind};
use beadwright::{Profile, Task};
use planar::{Bounds, Polygon, Ring};
use std::time::Instant;

fn main() {
    let profile = Profile::built_in("cmt-steel-robots").unwrap();
    println!("blocks of beads 40 mm long, {} threads", rayon::current_num_threads());
    println!("| beads a layer | layers | beads | voxels | s | ms a bead | memory of voxels |");
    println!("| --- | --- | --- | --- | --- | --- | --- |");
    for (beads, layers, voxel) in [(50, 50, 4.5), (100, 50, 4.5), (50, 100, 4.5), (100, 100, 4.5), (100, 100, 3.5)] {
        let (seconds, voxels) = timed(&profile, beads, layers, voxel);
        let all = beads * layers;
        let each = 1e3 * seconds / all as f64;
        println!(
            "| {beads} | {layers} | {all} | {voxels} ({voxel} mm) | {seconds:.2} | {each:.2} | {:.1} MB |",
            voxels as f64 * 104.0 / 1e6
        );
    }
    islands(&profile);
}

/// Seconds for a block of parallel beads, and its voxels.
fn timed(profile: &Profile, beads: usize, count: usize, voxel: f64) -> (f64, usize) {
    let mut settings = profile.heat_settings().unwrap();
    settings.heat.voxel = Some(voxel);
    let layers: Vec<Layer> =
        (0..count).map(|index| block(profile, index, dvec2(40.0, beads as f64 * profile.stepover()))).collect();
    let high = dvec2(40.0, beads as f64 * profile.stepover());
    let tops: Vec<(f64, f64)> = layers.iter().map(|l| (l.z, l.height)).collect();
    let start = Instant::now();
    let mut build = Build::new(&settings, &profile.weld_settings(), &Bounds { min: DVec2::ZERO, max: high }, &tops);
    layers.iter().for_each(|layer| drop(build.layer(layer)));
    (start.elapsed().as_secs_f64(), build.body().grid().len())
}

/// A layer of parallel beads to and fro.
fn block(profile: &Profile, index: usize, size: DVec2) -> Layer {
    let (height, apart) = (profile.layers.height, profile.stepover());
    let z = (index + 1) as f64 * height;
    let pass = |row: usize| {
        let y = (row as f64 + 0.5) * apart;
        let mut points = vec![dvec2(0.0, y).extend(z), dvec2(size.x, y).extend(z)];
        if row % 2 == 1 {
            points.reverse();
        }
        let (width, pace) = (Along::Same(profile.bead.width), Along::Same(profile.process.deposition_speed));
        Pass { kind: PassKind::Infill, closed: false, points, width, pace, wait: 0.0 }
    };
    let passes = (0..(size.y / apart).round() as usize).map(pass).collect();
    let ring = vec![DVec2::ZERO, dvec2(size.x, 0.0), size, dvec2(0.0, size.y)];
    let islands = vec![Polygon::simple(Ring::new(ring))];
    Layer { index, z, height, islands, passes, ..Layer::default() }
}

/// Four blocks of 40 × 60 × 40 mm, 80 mm apart, and three other parts: build times with a limit of 150 °C.
fn islands(profile: &Profile) {
    println!(
        "\nlimit 150 °C, min: arc and travel alone (no plan is faster), block after block, layer by layer as planned, ours"
    );
    println!("| part | arc and travel | part after part | as planned | ours | saved |");
    println!("| --- | --- | --- | --- | --- | --- |");
    for (name, places, size, degrees) in [
        (
            "four blocks",
            vec![dvec2(0.0, 0.0), dvec2(120.0, 0.0), dvec2(0.0, 140.0), dvec2(120.0, 140.0)],
            dvec2(40.0, 60.0),
            0.0,
        ),
        (
            "four blocks, turned",
            vec![dvec2(0.0, 0.0), dvec2(120.0, 0.0), dvec2(0.0, 140.0), dvec2(120.0, 140.0)],
            dvec2(40.0, 60.0),
            33.0,
        ),
        ("three bars", vec![dvec2(0.0, 0.0), dvec2(0.0, 60.0), dvec2(0.0, 120.0)], dvec2(100.0, 20.0), 0.0),
    ] {
        let part = mesh(&places, size, 40.0, degrees);
        let planned = beadwright::plan(name, &part, profile, &Task::new()).unwrap().layers;
        let run = |layers: &mut [Layer], interpass: Option<Interpass>| {
            let settings = HeatSettings { interpass, ..profile.heat_settings().unwrap() };
            heat::history(layers, &settings, &profile.weld_settings(), &Task::new()).unwrap().unwrap().seconds / 60.0
        };
        let limit =
            |reorder: bool| Some(Interpass { max_temperature: 150.0, min_temperature: None, reorder, along: false });
        let bare = run(&mut planned.clone(), None);
        let as_planned = run(&mut planned.clone(), limit(false));
        let ours = run(&mut planned.clone(), limit(true));
        let alone = mesh(&places[..1], size, 40.0, degrees);
        let mut alone = beadwright::plan(name, &alone, profile, &Task::new()).unwrap().layers;
        let parts = run(&mut alone, limit(true)) * places.len() as f64;
        println!(
            "| {name} | {bare:.1} | {parts:.1} | {as_planned:.1} | {ours:.1} | {:.0} % |",
            100.0 * (1.0 - ours / as_planned)
        );
    }
}

/// Boxes of one size at these places.
fn mesh(places: &[DVec2], size: DVec2, height: f64, degrees: f64) -> beadwright::Mesh {
    let turn = DVec2::from_angle(f64::to_radians(degrees));
    let mut text = String::from("solid blocks\n");
    for place in places {
        let corner = |x: f64, y: f64, z: f64| turn.rotate(*place + dvec2(x * size.x, y * size.y)).extend(z * height);
        let quads = [
            [(0, 0, 0), (0, 1, 0), (1, 1, 0), (1, 0, 0)],
            [(0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)],
            [(0, 0, 0), (1, 0, 0), (1, 0, 1), (0, 0, 1)],
            [(1, 0, 0), (1, 1, 0), (1, 1, 1), (1, 0, 1)],
            [(1, 1, 0), (0, 1, 0), (0, 1, 1), (1, 1, 1)],
            [(0, 1, 0), (0, 0, 0), (0, 0, 1), (0, 1, 1)],
        ];
        for quad in quads {
            let p = quad.map(|(x, y, z)| corner(f64::from(x), f64::from(y), f64::from(z)));
            for [a, b, c] in [[p[0], p[1], p[2]], [p[0], p[2], p[3]]] {
                let vertex = |p: beadwright::glam::DVec3| format!("vertex {} {} {}\n", p.x, p.y, p.z);
                text += &format!(
                    "facet normal 0 0 0\nouter loop\n{}{}{}endloop\nendfacet\n",
                    vertex(a),
                    vertex(b),
                    vertex(c)
                );
            }
        }
    }
    text += "endsolid blocks\n";
    let part = beadwright::Model::read(text.as_bytes(), &Task::new()).unwrap();
    match part.place(&beadwright::Placement::default(), None, 4.5).unwrap() {
        beadwright::Part::Mesh(import) => import.mesh,
        beadwright::Part::Curves { .. } => unreachable!("a solid"),
    }
}
