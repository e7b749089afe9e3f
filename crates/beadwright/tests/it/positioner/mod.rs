//! Positioners in the programs: seen from the cell, the pool is level and the torch hangs as it always does, and on the part the path
//! is the one of the plan. The cell is computed here from the axes that independent readers find.

mod machines;
mod robots;
mod settings;

use crate::common::{profile, with_all_dialects};
use crate::readers;
use crate::readers::{Motion, Stand, Weld, distance};
use beadwright::chart::{Chart, Cylinder, Guide};
use beadwright::layer::Layer;
use beadwright::profile::{Body, Profile};
use beadwright::program::{Positioner, PositionerAxis, Turning};
use beadwright::task::Task;
use beadwright::{dialect, example, plan};
use glam::{DMat3, DQuat, DVec3};
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex};

const FREE: [f64; 2] = [-1e5, 1e5];

fn axis(direction: [f64; 3], limits: [f64; 2]) -> PositionerAxis {
    PositionerAxis { direction, through: [0.0; 3], limits, speed: 90.0 }
}

/// A chuck whose axis lies level and carries the part by its lower face.
fn chuck() -> Positioner {
    Positioner { turning: Turning::Follow, axes: vec![axis([0.0, 0.0, 1.0], FREE)], up: [1.0, 0.0, 0.0] }
}

/// A table that tilts about x and turns about its own axis.
fn tilting(turning: Turning) -> Positioner {
    let axes = vec![axis([1.0, 0.0, 0.0], [-135.0, 135.0]), axis([0.0, 0.0, 1.0], FREE)];
    Positioner { turning, axes, up: [0.0, 0.0, 1.0] }
}

type Layers = Arc<Vec<Layer>>;

/// The first layers of each body of an example, planned once, with a profile for all dialects.
fn planned(name: &'static str) -> (Layers, Profile) {
    planned_at(name, 0, DVec3::ZERO)
}

/// The same of a part that is turned about z, °, and then shifted, mm, in its own space.
fn planned_at(name: &'static str, degrees: i32, shift: DVec3) -> (Layers, Profile) {
    static PLANS: Mutex<BTreeMap<(&str, i32), Layers>> = Mutex::new(BTreeMap::new());
    let example = example::find(name).unwrap();
    let turn = about(DVec3::Z, f64::from(degrees));
    let mut profile = profile("cmt-al2319-kuka");
    profile.layers.bodies = Body::read(&example.bodies().unwrap()).unwrap();
    profile.layers.bodies.iter_mut().for_each(|body| body.chart = moved(&body.chart, turn, shift));
    let layers = Arc::clone(PLANS.lock().unwrap().entry((name, degrees)).or_insert_with(|| {
        let mut mesh = example.mesh();
        mesh.vertices.iter_mut().for_each(|p| *p = turn * *p + shift);
        let plan = plan::plan(name, &mesh, &profile, &Task::new()).unwrap();
        let of = |body: usize| plan.layers.iter().filter(move |layer| layer.body == body && !layer.passes.is_empty());
        let bodies = profile.layers.bodies.len();
        Arc::new((0..bodies).flat_map(|body| of(body).step_by(1 + of(body).count() / 4)).cloned().collect())
    }));
    (layers, in_all_dialects(profile))
}

/// A profile with sections for all dialects.
fn in_all_dialects(mut profile: Profile) -> Profile {
    profile.dialects = with_all_dialects("cmt-steel-robots").dialects;
    profile.dialects.krl.as_mut().unwrap().max_megabytes = 1000.0;
    profile.dialects.rapid.as_mut().unwrap().speed_step = 0.001;
    profile.dialects.fanuc.as_mut().unwrap().table_group = Some(2);
    let inform = profile.dialects.inform.as_mut().unwrap();
    (inform.station, inform.station_pulses) = (Some("ST1".to_owned()), Some(PULSES));
    inform.frame_turns = Some(false);
    profile
}

/// Pulses per degree of a station's axes; the second counts the other way.
const PULSES: [f64; 2] = [1994.296925, -1376.711214];

/// With this positioner under the part.
fn turned_by(plain: &Profile, positioner: &Positioner) -> Profile {
    let mut turned = plain.clone();
    turned.program.positioner = Some(positioner.clone());
    turned
}

/// Where a stand of a job of INFORM is on the part: the station's pulses turn it, and in the cell its place with it.
fn on_part(stand: Stand, positioner: &Positioner, in_cell: bool) -> Stand {
    let axes = [0, 1].map(|axis| stand.axes[axis].map(|pulses| pulses / PULSES[axis]));
    let back = if in_cell { cell(positioner, axes).transpose() } else { DMat3::IDENTITY };
    // All lines of the axes pass through the part's origin.
    let at = (back * DVec3::from(stand.at)).to_array();
    Stand { at, tool: DQuat::from_mat3(&back) * stand.tool, axes }
}

/// A chart turned and shifted with its part.
fn moved(chart: &Chart, turn: DMat3, shift: DVec3) -> Chart {
    let place = |p: DVec3| turn * p + shift;
    match chart.clone() {
        Chart::Cylinder(own) => Chart::Cylinder(Cylinder { axis: turn * own.axis, through: place(own.through), ..own }),
        Chart::Guide(own) => {
            let points = own.points().iter().map(|p| place(*p)).collect();
            Chart::Guide(Arc::new(Guide::new(points, own.radii().to_vec()).unwrap()))
        }
        other => {
            assert!(turn == DMat3::IDENTITY && shift == DVec3::ZERO);
            other
        }
    }
}

fn read(post: &str, layers: &[Layer], profile: &Profile) -> Motion {
    let files = dialect::write(post, layers, &profile.job("demo")).unwrap();
    match post {
        "krl" => readers::krl::run(&files, "DEMO", "$OUT[2]"),
        "fanuc" => readers::fanuc::run(&files, "DEMO"),
        "urscript" => readers::urscript::run(files.values().next().unwrap(), 0),
        "inform" => match &profile.program.positioner {
            Some(positioner) => {
                let in_cell = profile.dialects.inform.as_ref().unwrap().frame_turns == Some(false);
                readers::inform::run_turned(&files, "DEMO", &|stand| on_part(stand, positioner, in_cell))
            }
            None => readers::inform::run(&files, "DEMO"),
        },
        _ => readers::rapid::run(&files, "demo", ""),
    }
}

fn along(points: &[DVec3]) -> f64 {
    points.windows(2).map(|p| p[0].distance(p[1])).sum()
}

/// A turn about a unit vector (Rodrigues).
fn about(axis: DVec3, degrees: f64) -> DMat3 {
    let (sin, cos) = degrees.to_radians().sin_cos();
    let cross = DMat3::from_cols(axis.cross(DVec3::X), axis.cross(DVec3::Y), axis.cross(DVec3::Z));
    DMat3::IDENTITY + cross * sin + cross * cross * (1.0 - cos)
}

/// What takes the part's directions to the cell where up is up.
fn cell(positioner: &Positioner, axes: [Option<f64>; 2]) -> DMat3 {
    positioner.axes.iter().zip(axes).fold(DMat3::IDENTITY, |all, (axis, angle)| {
        all * about(DVec3::from(axis.direction).normalize(), angle.unwrap())
    })
}

/// Along a weld, how far the wire hangs from straight down in the cell at most, °.
fn off_plumb(weld: &Weld, positioner: &Positioner) -> f64 {
    let places = weld.tools.iter().zip(&weld.axes);
    let lean = places.map(|(tool, axes)| {
        let wire = cell(positioner, *axes) * (*tool * DVec3::Z);
        wire.angle_between(-DVec3::from(positioner.up)).to_degrees()
    });
    lean.fold(0.0, f64::max)
}

fn same_path(case: &str, a: &[Weld], b: &[Weld]) {
    assert!(!a.is_empty() && a.len() == b.len(), "{case}: {} {}", a.len(), b.len());
    for (a, b) in a.iter().zip(b) {
        assert_eq!((a.points.len(), a.speeds.len()), (b.points.len(), b.speeds.len()), "{case}");
        let off = a.points.iter().zip(&b.points).map(|(p, q)| distance(*p, *q)).fold(0.0, f64::max);
        let slower = a.speeds.iter().zip(&b.speeds).map(|(v, w)| (v / w - 1.0).abs()).fold(0.0, f64::max);
        assert!(off <= 0.01 && slower <= 0.005, "{case}: {off} mm, {slower}");
    }
}
