//! Plans whose layers are not level: they are those of the level part, bent; and what is written of them lies in space.

use crate::common;

use beadwright::chart::{Chart, Guide};
use beadwright::fill::StrategyName;
use beadwright::model::{Mesh, solid::Solid};
use beadwright::pass::Pass;
use beadwright::plan::{self, Plan};
use beadwright::planar::{Polygon, Ring};
use beadwright::profile::Profile;
use beadwright::read_back::ReadBack;
use beadwright::task::Task;
use beadwright::{Metrics, check, compare, dialect, example, plan_file};
use common::profile;
use glam::{DMat3, DQuat, DVec2, DVec3, EulerRot};
use std::f64::consts::TAU;
use std::sync::Arc;

fn charted(chart: &str) -> Profile {
    let mut profile = profile("cmt-al2319-kuka");
    profile.layers.chart = chart.parse().unwrap();
    profile
}

fn planned(mesh: &Mesh, profile: &Profile) -> Plan {
    common::planned_once("part", mesh, profile).unwrap()
}

fn mesh(name: &str) -> Mesh {
    example::find(name).unwrap().mesh()
}

fn text(plan: &Plan, profile: &Profile) -> String {
    let layers = plan.layers.iter().map(|layer| plan_file::layer(layer, profile.layers.sheet(layer).as_ref()));
    plan_file::head(&plan.header, profile) + &layers.collect::<String>() + plan_file::tail()
}

#[test]
fn level_planes_change_no_byte() {
    let (level, plane) = (profile("cmt-al2319-kuka"), charted("plane"));
    for name in ["cross", "tian", "plate"] {
        let (a, b) = (planned(&mesh(name), &level), planned(&mesh(name), &plane));
        assert_eq!(text(&a, &level), text(&b, &plane), "{name}");
        let programs =
            |plan: &Plan, profile: &Profile| dialect::write("krl", &plan.layers, &profile.job("part")).unwrap();
        assert_eq!(programs(&a, &level), programs(&b, &plane), "{name}");
    }
}

#[test]
fn a_part_turned_with_its_layers_has_the_same_passes() {
    let flat = planned(&mesh("cross"), &profile("cmt-al2319-kuka"));
    for (up, through) in [("1/0/1", "5/-3/40"), ("-0.3/0.2/-1", "0/0/0"), ("-x", "10/20/30")] {
        let profile = charted(&format!("plane:up={up},through={through}"));
        let sheet = profile.layers.chart.sheet(0.0);
        let mut turned = mesh("cross");
        turned.vertices.iter_mut().for_each(|p| *p = sheet.at(*p).place);
        let plan = planned(&turned, &profile);
        assert_eq!(plan.layers.len(), flat.layers.len());
        for (a, b) in flat.layers.iter().zip(&plan.layers).flat_map(|(a, b)| a.passes.iter().zip(&b.passes)) {
            assert!((a.length() - b.length()).abs() < 1e-3 * a.length(), "{up}: {} {}", a.length(), b.length());
            // Rounding adds and drops points on straight lines.
            let line = a.line();
            let off = |p: DVec2| {
                let piece = |w: &[DVec2]| beadwright::planar::polyline::distance_squared_to_segment(p, w[0], w[1]);
                line.windows(2).map(piece).fold(f64::INFINITY, f64::min).sqrt()
            };
            let farthest = b.line().into_iter().map(off).fold(0.0, f64::max);
            assert!(farthest < 0.02, "{up}: {farthest}");
        }
    }
}

/// A mesh whose edges are short.
fn fine(mut mesh: Mesh, longest: f64) -> Mesh {
    let length = |mesh: &Mesh, [a, b, c]: [u32; 3]| {
        let [a, b, c] = [a, b, c].map(|i| mesh.vertices[i as usize]);
        a.distance(b).max(b.distance(c)).max(c.distance(a))
    };
    while mesh.triangles.iter().any(|t| length(&mesh, *t) > longest) {
        let mut vertices = mesh.vertices.clone();
        let mut triangles = Vec::new();
        for &[a, b, c] in &mesh.triangles {
            let mut middle = |a: u32, b: u32| {
                vertices.push(mesh.vertices[a as usize].midpoint(mesh.vertices[b as usize]));
                vertices.len() as u32 - 1
            };
            let [ab, bc, ca] = [middle(a, b), middle(b, c), middle(c, a)];
            triangles.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
        }
        mesh = Mesh::from_triangles(vertices, triangles).0;
    }
    mesh
}

/// A cross bent around a cylinder is planned as the cross is, whatever way it lies and wherever the seam is.
#[test]
fn a_part_bent_around_a_cylinder_has_the_passes_of_the_flat_one() {
    let cross = fine(mesh("cross"), 2.0);
    let mut level = profile("cmt-al2319-kuka");
    // Beads of level layers are laid on what lies below; bent, each lies on a layer as planned.
    level.layers.level = false;
    let flat = planned(&cross, &level);
    for text in ["cylinder:axis=z,radius=60", "cylinder:axis=1/2/3,through=4/5/6,radius=60,seam=10"] {
        let mut profile = charted(text);
        profile.layers.level = false;
        let chart = profile.layers.chart.clone();
        let mut bent = cross.clone();
        bent.vertices.iter_mut().for_each(|p| *p = chart.sheet(p.z).at(*p).place);
        let plan = planned(&bent, &profile);
        assert_eq!(plan.layers.len(), flat.layers.len(), "{text}");
        for (a, b) in flat.layers.iter().zip(&plan.layers) {
            let area = |layer: &beadwright::Layer| layer.planned_area / layer.slice_area;
            assert!((b.slice_area / a.slice_area - 1.0).abs() < 1e-3, "{text}: {} {}", a.slice_area, b.slice_area);
            assert!((area(a) - area(b)).abs() < 2e-3, "{text}: {} {}", area(a), area(b));
            let length = |passes: &[Pass]| passes.iter().map(Pass::length).sum::<f64>();
            assert_eq!(a.passes.len(), b.passes.len(), "{text}");
            assert!((length(&b.passes) / length(&a.passes) - 1.0).abs() < 5e-3, "{text}, layer {}", a.index);
        }
    }
}

/// Whatever part of the shaft is metal outside its bar is laid, one pass for each flange and layer.
#[test]
fn flanges_are_laid_around_the_shaft() {
    let shaft = example::find("shaft").unwrap();
    let profile = charted(shaft.chart.unwrap());
    let plan = planned(&shaft.mesh(), &profile);
    let metrics = &plan.summary.metrics;
    let (laid, sliced) = (metrics.deposited_volume_mm3, metrics.part_volume_mm3);
    assert!((laid / sliced - 1.0).abs() < 0.02, "{laid} of {sliced}");
    for layer in &plan.layers {
        let radius = 25.0 + layer.middle();
        let wide = if radius < 45.0 { 30.0 + 22.0 } else { 30.0 };
        assert!((layer.slice_area / (TAU * radius * wide) - 1.0).abs() < 1e-3, "layer {}", layer.index);
        assert_eq!(layer.passes.len(), layer.islands.len(), "layer {}", layer.index);
    }
    assert!(plan.summary.forbidden.is_empty(), "{:?}", plan.summary.forbidden);
}

/// The file gives points in space, each with the normal there, and is read back as the plan it was made from.
#[test]
fn plan_files_hold_places_in_space() {
    for name in ["shaft", "hub"] {
        let example = example::find(name).unwrap();
        let profile = charted(example.chart.unwrap());
        let plan = planned(&example.mesh(), &profile);
        let text = text(&plan, &profile);
        let json: serde_json::Value = serde_json::from_str(&text).unwrap();
        assert_eq!(json["version"], 3);
        let three = |v: &serde_json::Value| DVec3::from_array([0, 1, 2].map(|k| v[k].as_f64().unwrap()));
        let radius = if name == "hub" { 40.0 } else { 25.0 };
        for (layer, written) in plan.layers.iter().zip(json["layers"].as_array().unwrap()) {
            for pass in written["passes"].as_array().unwrap() {
                let (points, normals) = (pass["points"].as_array().unwrap(), pass["normals"].as_array().unwrap());
                assert_eq!(points.len(), normals.len());
                for (p, normal) in points.iter().map(three).zip(normals.iter().map(three)) {
                    assert!((p.truncate().length() - radius - layer.z).abs() < 1e-3, "{name}: {p}");
                    assert!(normal.distance(p.with_z(0.0).normalize()) < 1e-4);
                }
            }
        }
        let again = plan_file::read(&text).unwrap();
        for (a, b) in plan.layers.iter().zip(&again.layers).flat_map(|(a, b)| a.passes.iter().zip(&b.passes)) {
            assert!((a.length() - b.length()).abs() < 1e-2, "{name}: {} {}", a.length(), b.length());
            assert!(a.start().unwrap().distance(b.start().unwrap()) < 1e-3, "{name}: {:?} {:?}", a.start(), b.start());
        }
    }
}

/// Targets of a KRL program while the arc is lit, and where the tool points.
fn krl_welds(text: &str) -> Vec<(DVec3, DVec3)> {
    let (mut lit, mut found) = (false, Vec::new());
    for line in text.lines() {
        lit = (lit || line.contains("_ARC( )")) && !line.contains("$OUT[2] = FALSE");
        let Some(target) = line.strip_prefix("LIN {").filter(|_| lit) else { continue };
        let value = |key: &str| -> f64 {
            let field = target.split([',', '}']).find_map(|field| field.trim().strip_prefix(key)).unwrap();
            field.trim().parse().unwrap()
        };
        let [a, b, c] = ["A", "B", "C"].map(|key| value(key).to_radians());
        let tool = DMat3::from_quat(DQuat::from_euler(EulerRot::ZYX, a, b, c)).z_axis;
        found.push((DVec3::new(value("X"), value("Y"), value("Z")), tool));
    }
    found
}

/// Read from the program's text: every weld ends on the layer, and the tool points along the layer's normal, into the part.
#[test]
fn programs_follow_the_layers_in_space() {
    let shaft = example::find("shaft").unwrap();
    let profile = charted(shaft.chart.unwrap());
    let plan = planned(&shaft.mesh(), &profile);
    let files = dialect::write("krl", &plan.layers, &profile.job("part")).unwrap();
    for layer in &plan.layers {
        let welds = krl_welds(&files[&format!("PART_L{:03}.src", layer.index + 1)]);
        assert!(welds.len() > 60 * layer.passes.len());
        for (at, tool) in &welds {
            assert!((at.truncate().length() - 25.0 - layer.z).abs() < 0.002, "layer {}: {at}", layer.index);
            assert!(tool.angle_between(-at.with_z(0.0)).to_degrees() < 0.05, "layer {}: {at} {tool}", layer.index);
        }
        // Chords stay close to the circle.
        for pair in welds.windows(2).filter(|pair| pair[0].0.distance(pair[1].0) < 12.0) {
            let middle = pair[0].0.midpoint(pair[1].0);
            assert!(25.0 + layer.z - middle.truncate().length() < 0.06, "layer {}: {middle}", layer.index);
        }
    }
    let gcode = dialect::write(
        "gcode",
        &plan.layers,
        &{
            let mut profile = common::profile("plasma-304-cnc");
            profile.layers.chart = "cylinder:radius=25".parse().unwrap();
            profile
        }
        .job("part"),
    );
    assert!(gcode.unwrap_err().to_string().contains("layers.chart"));
}

#[test]
fn blades_on_a_hub_are_supported_wherever_the_seam_lies() {
    let hub = example::find("hub").unwrap();
    for seam in [180, 45, 301] {
        let profile = charted(&format!("cylinder:axis=z,radius=40,seam={seam}"));
        let plan = planned(&hub.mesh(), &profile);
        assert!(plan.summary.forbidden.is_empty(), "seam {seam}: {:?}", plan.summary.forbidden);
        // The ends of the blades are flat, so that their corners reach farthest.
        let counts: Vec<usize> = plan.layers.iter().map(|layer| layer.islands.len()).collect();
        assert!(counts.iter().filter(|count| **count == 4).count() + 2 >= counts.len(), "seam {seam}: {counts:?}");
        let volume = plan.summary.metrics.part_volume_mm3;
        assert!((plan.summary.metrics.mesh_volume_mm3.unwrap() / volume - 1.0).abs() < 0.01, "seam {seam}");
    }
}

/// A wall that stands out from a shaft has the same layers at every angle.
#[test]
fn walls_rise_alike_at_every_angle() {
    let mut profile = charted("cylinder:radius=20");
    profile.fill.strategy = StrategyName::Wall;
    let plans: Vec<Plan> = [0.0_f64, 60.0, 170.0, 250.0]
        .into_iter()
        .map(|angle| {
            let base = [[18.0, -3.0], [60.0, -3.0], [60.0, 3.0], [18.0, 3.0]].map(DVec2::from_array);
            let Solid { vertices, triangles } = Solid::extrude(&Polygon::simple(Ring::new(base.to_vec())), 0.0, 60.0);
            let turn = DQuat::from_rotation_z(angle.to_radians());
            planned(&Mesh::from_triangles(vertices.iter().map(|p| turn * *p).collect(), triangles).0, &profile)
        })
        .collect();
    for plan in &plans {
        assert_eq!(plan.layers.len(), plans[0].layers.len());
        let length = plan.summary.metrics.deposited_length_mm / plans[0].summary.metrics.deposited_length_mm;
        assert!((length - 1.0).abs() < 0.01, "{length}");
    }
}

/// What would move the part otherwise than along the normals of its layers is refused by name.
#[test]
fn what_does_not_go_with_a_chart_is_refused() {
    let shaft = example::find("shaft").unwrap();
    let plain = charted("cylinder:radius=25");
    let layers = planned(&shaft.mesh(), &plain).layers;
    let refused = |change: fn(&mut Profile)| {
        let mut profile = plain.clone();
        change(&mut profile);
        dialect::write("krl", &layers, &profile.job("part")).unwrap_err().to_string()
    };
    assert!(refused(|p| p.program.table_side = Some(0.0)).contains("program.table_side"));
    assert!(refused(|p| p.program.layer_offsets = true).contains("program.layer_offsets"));
    assert!(refused(|p| p.program.follow_wall = 0.5).contains("program.follow_wall"));
    // A bore without room for travels.
    let bore = charted("cylinder:radius=12,side=inner");
    let ends = [[8.0, 0.0], [30.0, 0.0], [30.0, 40.0], [8.0, 40.0]].map(DVec2::from_array);
    let Solid { vertices, triangles } = Solid::revolve(&ends, 90);
    let plan = planned(&Mesh::from_triangles(vertices, triangles).0, &bore);
    assert!(plan.summary.forbidden.iter().any(|reason| reason.contains("no room for travels")), "{:?}", plan.summary);
}

/// A box without its lid, as a wall of one bead on tilted layers: the remedy is not the key that is set already.
#[test]
fn open_surfaces_are_walls_on_level_layers_only() {
    let mut mesh = mesh("cross");
    let (vertices, top) = (mesh.vertices.clone(), mesh.bounds().1.z);
    let lid = |corners: &[u32; 3]| corners.iter().all(|corner| vertices[*corner as usize].z > top - 1e-6);
    let open = mesh.triangles.iter().copied().filter(|corners| !lid(corners)).collect();
    mesh = Mesh::from_triangles(vertices.clone(), open).0;
    let mut profile = charted("plane:up=0.1/0/1");
    profile.slice.surface = Some(beadwright::slice::Surface::Wall);
    let refused = plan::plan("part", &mesh, &profile, &Task::new()).unwrap_err().to_string();
    assert!(refused.contains("open surface have level layers") && !refused.contains("slice.surface"), "{refused}");
}

#[test]
fn what_lies_below_the_first_layer_is_refused() {
    let profile = charted("cylinder:axis=z,radius=500");
    let refused = plan::plan("part", &mesh("cross"), &profile, &Task::new()).unwrap_err().to_string();
    assert!(refused.contains("below the first layer of cylinder"), "{refused}");
}

#[test]
fn torches_that_stand_overhead_are_found() {
    let shaft = example::find("shaft").unwrap();
    let profile = charted("cylinder:axis=z,radius=25");
    let plan = planned(&shaft.mesh(), &profile);
    let settings = plan::deposit_settings(&profile);
    let found = beadwright::check(&plan.layers, &profile, settings, &Task::new()).unwrap();
    let leaning: Vec<_> = found.iter().filter(|finding| finding.kind == "off-level").collect();
    assert!(leaning.len() == 1 && (leaning[0].size.unwrap() - 90.0).abs() < 1e-6, "{leaning:?}");
}

/// A thick pipe along a guide of one bend, with a straight line of this length (mm) at both ends; and its chart.
fn bent_pipe(straight: f64, radius: f64, degrees: f64, turn: DQuat) -> (Mesh, Chart) {
    let (sin, cos) = degrees.to_radians().sin_cos();
    let leg = straight + radius * (degrees.to_radians() / 2.0).tan();
    let corner = turn * (DVec3::Z * leg);
    let points = vec![DVec3::ZERO, corner, corner + turn * (DVec3::new(sin, 0.0, cos) * leg)];
    let guide = Guide::new(points, vec![radius]).unwrap();
    let levels: Vec<f64> = (0..=200).map(|k| guide.length() * f64::from(k) / 200.0).collect();
    let chart = Chart::Guide(Arc::new(guide));
    let ring =
        |radius: f64| Ring::new((0..160).map(|k| DVec2::from_angle(TAU * f64::from(k) / 160.0) * radius).collect());
    let section = Polygon { outer: ring(40.0), holes: vec![ring(20.0).reversed()] };
    let solid = Solid::loft(&section, &levels, |p, _| p);
    let mut mesh = Mesh::from_triangles(solid.vertices, solid.triangles).0;
    mesh.vertices.iter_mut().for_each(|p| *p = chart.sheet(p.z).at(*p).place);
    (mesh, chart)
}

/// The metal of an elbow is its volume (Pappus), with one start on every layer, and each piece is as thick as the bend makes it:
/// what a pass holds per length is its width times the distance of the layers there. Where the bend is tight, two layers on the
/// outer side stand against one on the inner.
#[test]
fn elbows_are_laid_square_to_their_guide() {
    for (radius, degrees, paired) in [(120.0, 90.0_f64, false), (110.0, 150.0, false), (75.0, 90.0, true)] {
        let turn = DQuat::from_rotation_x(0.3);
        let (mesh, chart) = bent_pipe(50.0, radius, degrees, turn);
        let mut profile = profile("cmt-al2319-kuka");
        profile.layers.chart = chart.clone();
        let plan = planned(&mesh, &profile);
        let metrics = &plan.summary.metrics;
        let pappus = TAU / 2.0 * (40.0 * 40.0 - 20.0 * 20.0) * (100.0 + radius * degrees.to_radians());
        assert!((metrics.part_volume_mm3 / pappus - 1.0).abs() < 2e-3, "{} {pappus}", metrics.part_volume_mm3);
        assert!((metrics.mesh_volume_mm3.unwrap() / pappus - 1.0).abs() < 1e-3);
        assert!(
            (metrics.deposited_volume_mm3 / pappus - 1.0).abs() < 0.03,
            "{} {pappus}",
            metrics.deposited_volume_mm3
        );
        assert!(plan.layers.iter().all(|layer| layer.passes.len() == layer.islands.len()), "one start on every layer");
        assert_eq!(plan.layers.iter().any(|layer| layer.half.is_some()), paired, "{radius}");
        assert!(plan.summary.forbidden.is_empty(), "{:?}", plan.summary.forbidden);
        let (thin, thick) = profile.layers.window();
        let area = profile.bead().area() * profile.process.deposition_speed;
        let (mut least, mut most) = (f64::INFINITY, 0.0_f64);
        for layer in &plan.layers {
            let sheet = chart.sheet(layer.middle());
            for piece in layer.passes.iter().flat_map(Pass::segments) {
                let height = area / piece.pace / piece.width;
                let rise = sheet.rise(piece.from.midpoint(piece.to).truncate());
                (least, most) = (least.min(height / rise), most.max(height / rise));
                assert!(
                    height > 0.75 * thin && height < 1.25 * thick,
                    "{height} of {thin} to {thick}, layer {}",
                    layer.index
                );
            }
        }
        if !paired {
            // Beads of one layer hold what beads of a level layer do, but for the bend.
            assert!(least > 1.2 && most < 2.5, "{least} {most}");
        }
        let findings = check::check(&plan.layers, &profile, plan::deposit_settings(&profile), &Task::new()).unwrap();
        let known = ["off-level", "overfill"];
        assert!(findings.iter().all(|finding| known.contains(&finding.kind)), "{findings:?}");
    }
}

/// The file keeps which of two layers is which, and points lie on the plane square to the guide.
#[test]
fn plan_files_of_elbows_are_read_back() {
    let (mesh, chart) = bent_pipe(50.0, 75.0, 90.0, DQuat::IDENTITY);
    let mut profile = profile("cmt-al2319-kuka");
    profile.layers.chart = chart;
    let plan = planned(&mesh, &profile);
    let again = plan_file::read(&text(&plan, &profile)).unwrap();
    for (a, b) in plan.layers.iter().zip(&again.layers) {
        assert_eq!((a.half, a.passes.len()), (b.half, b.passes.len()));
        for (a, b) in a.passes.iter().zip(&b.passes) {
            assert_eq!(a.points.len(), b.points.len());
            assert!(a.points.iter().zip(&b.points).all(|(a, b)| a.distance(*b) < 5e-3));
        }
    }
    let mut metrics = Metrics::new(&profile);
    again.layers.iter().for_each(|layer| metrics.add(layer));
    assert!((metrics.part_volume_mm3 / plan.summary.metrics.part_volume_mm3 - 1.0).abs() < 1e-4);
}

/// Metal that is as near to one stretch of a guide as to another is refused with the place.
#[test]
fn parts_between_two_stretches_of_a_guide_are_refused() {
    let base = [[-20.0, -20.0], [220.0, -20.0], [220.0, 20.0], [-20.0, 20.0]].map(DVec2::from_array);
    let solid = Solid::extrude(&Polygon::simple(Ring::new(base.to_vec())), 0.0, 60.0);
    let mesh = Mesh::from_triangles(solid.vertices, solid.triangles).0;
    let profile = charted("guide:points=0/0/0:0/0/200:200/0/200:200/0/0,radius=100");
    let refused = plan::plan("part", &mesh, &profile, &Task::new()).unwrap_err().to_string();
    assert!(refused.contains("as near to one stretch of the guide as to another"), "{refused}");
}

/// Wherever the bend ends between two layers, those near its end are neither too thin nor too thick.
#[test]
fn tight_bends_are_planned_wherever_their_ends_lie() {
    for (straight, radius) in [(29.0, 75.0), (30.0, 64.0), (30.5, 75.0), (31.3, 66.0), (32.0, 75.0), (32.6, 70.0)] {
        let (mesh, chart) = bent_pipe(straight, radius, 90.0, DQuat::IDENTITY);
        let mut profile = profile("cmt-al2319-kuka");
        profile.layers.chart = chart;
        let plan = planned(&mesh, &profile);
        assert!(plan.summary.forbidden.is_empty(), "{straight}, {radius}: {:?}", plan.summary.forbidden);
        assert!(plan.layers.iter().all(|layer| !layer.passes.is_empty()), "{straight}, {radius}");
        let metrics = &plan.summary.metrics;
        assert!((metrics.deposited_volume_mm3 / metrics.mesh_volume_mm3.unwrap() - 1.0).abs() < 0.03);
    }
}

/// What is read back from a plan file is judged as the plan was.
#[test]
fn elbows_are_judged_alike_before_and_after_they_are_written() {
    let (mesh, chart) = bent_pipe(30.0, 120.0, 60.0, DQuat::IDENTITY);
    let mut profile = profile("cmt-al2319-kuka");
    profile.layers.chart = chart;
    let plan = planned(&mesh, &profile);
    let read = ReadBack::plan("elbow", plan_file::read(&text(&plan, &profile)).unwrap(), &profile);
    let settings = read.deposit_settings(None).unwrap();
    let entry = compare::program("elbow", &read.judged(&profile), read.totals, settings, &None, &Task::new()).unwrap();
    let built = entry.built.unwrap();
    assert!(built.mean.abs() < 0.5 && built.within > 0.95, "{built:?}");
}

/// People hear of a guide that passes beside the part, and of metal below its first plane.
#[test]
fn guides_that_do_not_fit_are_noted() {
    let (mesh, chart) = bent_pipe(50.0, 120.0, 60.0, DQuat::IDENTITY);
    let mut profile = profile("cmt-al2319-kuka");
    profile.layers.chart = chart;
    let notes = |mesh: &Mesh| planned(mesh, &profile).summary.notes.join(" ");
    assert!(!notes(&mesh).contains("layers.chart"), "{}", notes(&mesh));
    let mut moved = mesh.clone();
    moved.vertices.iter_mut().for_each(|p| *p += DVec3::new(0.0, 12.0, 0.0));
    assert!(
        notes(&moved).contains("passes up to 12.0 mm beside the middle of the part's sections"),
        "{}",
        notes(&moved)
    );
    let mut lower = mesh;
    lower.vertices.iter_mut().for_each(|p| p.z -= 5.0);
    assert!(notes(&lower).contains("lie below the first plane of layers.chart"), "{}", notes(&lower));
}
