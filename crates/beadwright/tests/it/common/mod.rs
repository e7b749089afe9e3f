//! What many tests begin with: profiles, planned examples, shared models.
#![allow(dead_code, reason = "each test uses some of it")]

use beadwright::Mesh;
use beadwright::dialect::reading::{ArcCodes, Options, ReadError, ReadProgram, read};
use beadwright::example;
use beadwright::model::{Import, Part, RepairReport};
use beadwright::plan::{self, Plan, PlanError};
use beadwright::profile::Profile;
use beadwright::task::Task;
use std::collections::BTreeMap;
use std::convert::Infallible;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, OnceLock};

/// A built-in profile.
pub(crate) fn profile(name: &str) -> Profile {
    Profile::built_in(name).unwrap()
}

/// The same with layers of one height and beads as the strategy lays them: no metal is shared out.
pub(crate) fn flat(mut profile: Profile) -> Profile {
    profile.layers.level = false;
    profile
}

/// A built-in profile with a strategy.
pub(crate) fn profile_by(name: &str, strategy: &str) -> Profile {
    let mut profile = profile(name);
    profile.fill.strategy = strategy.parse().unwrap();
    profile
}

/// A built-in profile with the sections of all dialects.
pub(crate) fn with_all_dialects(name: &str) -> Profile {
    let (mut all, robots) = (profile(name), profile("cmt-steel-robots").dialects);
    all.dialects = profile("cmt-steel-abb").dialects;
    all.dialects.krl = profile("cmt-al2319-kuka").dialects.krl;
    all.dialects.gcode = profile("plasma-304-cnc").dialects.gcode;
    // The way in is as long as that of the robots.
    all.dialects.gcode.as_mut().expect("just set").safe_z = 0.0;
    all.dialects.marlin = profile("fdm-abs-0.4").dialects.marlin;
    // Parts stay where they are, as with robots.
    all.dialects.marlin.as_mut().expect("just set").bed = None;
    all.dialects.krl.as_mut().expect("just set").table_machine = Some(2);
    // The part stands on the axis of the table.
    let rapid = all.dialects.rapid.as_mut().expect("of the ABB cell");
    (rapid.table_unit, rapid.part_frame) = (Some("STN1".to_owned()), Some([0.0, 0.0, 400.0, 1.0, 0.0, 0.0, 0.0]));
    (all.dialects.fanuc, all.dialects.inform, all.dialects.urscript) = (robots.fanuc, robots.inform, robots.urscript);
    all
}

/// The folder of the documents.
pub(crate) fn docs() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs")
}

/// A page of the documents shows a text between the marks of a part; `BEADWRIGHT_GOLDEN=write` writes it anew.
pub(crate) fn page_shows(page: &str, part: &str, text: &str) {
    let (path, mark) = (docs().join(page), format!("<!-- {part}: written by "));
    let old = std::fs::read_to_string(&path).unwrap();
    let (head, rest) = old.split_once(&mark).unwrap_or_else(|| panic!("docs/{page} has no mark of {part}"));
    let (test, rest) = rest.split_once('\n').unwrap();
    let end = format!("<!-- end of {part} -->\n");
    let (_, tail) = rest.split_once(&end).unwrap();
    let now = format!("{head}{mark}{test}\n\n{text}{end}{tail}");
    if std::env::var("BEADWRIGHT_GOLDEN").is_ok_and(|v| v == "write") {
        std::fs::write(&path, &now).unwrap();
    } else {
        let differs = now.lines().zip(old.lines()).find(|(a, b)| a != b);
        assert!(now == old, "docs/{page} is stale: {differs:?}. BEADWRIGHT_GOLDEN=write writes it anew.");
    }
}

/// An example part, planned.
pub(crate) fn planned(part: &str, profile: &Profile) -> Plan {
    planned_once(part, &example::find(part).unwrap().mesh(), profile).unwrap()
}

/// A part, planned with a profile: once, however many tests begin with it.
pub(crate) fn planned_once(name: &str, mesh: &Mesh, profile: &Profile) -> Result<Plan, PlanError<Infallible>> {
    type Plans = BTreeMap<String, Arc<OnceLock<Option<Plan>>>>;
    static PLANS: Mutex<Plans> = Mutex::new(Plans::new());
    let key = serde_json::to_string(&(name, mesh, profile)).unwrap();
    let place = PLANS.lock().unwrap().entry(key).or_default().clone();
    let mut refused = None;
    let plan =
        place.get_or_init(|| plan::plan(name, mesh, profile, &Task::new()).map_err(|error| refused = Some(error)).ok());
    match (plan, refused) {
        (Some(plan), _) => Ok(plan.clone()),
        (None, Some(error)) => Err(error),
        (None, None) => plan::plan(name, mesh, profile, &Task::new()),
    }
}

/// Reads a program of the built-in profiles back, whose files are known by their names.
pub(crate) fn read_back(files: &BTreeMap<String, String>, main: &str) -> Result<ReadProgram, ReadError> {
    let words = |words: [&str; 4]| words.map(str::to_owned).to_vec();
    let on = words(["$OUT[2] = TRUE", "SetDO doArc,1", "set_standard_digital_out(1, True)", "M62"]);
    let off = words(["$OUT[2] = FALSE", "SetDO doArc,0", "set_standard_digital_out(1, False)", "M63"]);
    let mut find = |name: &str| {
        let names = ["", ".src", ".dat", ".mod", ".ls", ".jbi"].map(|end| format!("{name}{end}"));
        names.iter().find_map(|name| files.get(name)).cloned()
    };
    read(&files[main], &mut find, &Options { arc: ArcCodes { on, off, ..ArcCodes::default() }, ..Options::default() })
}

/// Where the shared models lie. Tests that need them are ignored where the folder is missing, but fail under CI=true
/// (`build.rs`).
pub(crate) fn models() -> PathBuf {
    let default = || Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/models");
    std::env::var_os("BEADWRIGHT_MODELS").map_or_else(default, PathBuf::from)
}

/// The bytes of a shared model.
pub(crate) fn model(name: &str) -> Vec<u8> {
    let path = models().join(name);
    std::fs::read(&path)
        .unwrap_or_else(|error| panic!("{}: {error}. BEADWRIGHT_MODELS names the folder.", path.display()))
}

/// A round tube that stands on the plate: outer radius, wall, height (mm), and by how much it leans outwards, mm per mm.
pub(crate) fn tube(radius: f64, wall: f64, height: f64, lean: f64) -> Mesh {
    use beadwright::glam::DVec3;
    const SIDES: u32 = 90;
    let ring = |radius: f64, z: f64| {
        (0..SIDES).map(move |k| {
            let (y, x) = (f64::from(k) * std::f64::consts::TAU / f64::from(SIDES)).sin_cos();
            DVec3::new(radius * x, radius * y, z)
        })
    };
    let rings = [
        (radius, 0.0),
        (radius + lean * height, height),
        (radius - wall + lean * height, height),
        (radius - wall, 0.0),
    ];
    let vertices = rings.iter().flat_map(|&(radius, z)| ring(radius, z)).collect();
    let side = |(below, above): (u32, u32)| {
        (0..SIDES).flat_map(move |k| {
            let next = (k + 1) % SIDES;
            let [a, b, c, d] = [below * SIDES + k, below * SIDES + next, above * SIDES + next, above * SIDES + k];
            [[a, b, c], [a, c, d]]
        })
    };
    let triangles = [(0, 1), (1, 2), (2, 3), (3, 0)].into_iter().flat_map(side).collect();
    Mesh::from_triangles(vertices, triangles).0
}

/// A mesh as a part that needed no repair.
pub(crate) fn imported(mesh: Mesh) -> Part {
    Part::Mesh(Import {
        mesh,
        repair: RepairReport::default(),
        format: "test",
        units: None,
        objects: Vec::new(),
        notes: Vec::new(),
        milled: None,
    })
}
