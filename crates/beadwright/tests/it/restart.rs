//! Programs that begin at any pass by a variable of their own: run from their beginning they do what plain programs do;
//! begun at a pass they weld exactly the rest.

use crate::common;
use crate::readers;
use beadwright::fill::StrategyName;

use beadwright::dialect::reading::ReadTotals;
use beadwright::plan::{self, Plan};
use beadwright::profile::Profile;
use beadwright::task::Task;
use beadwright::{dialect, example};
use readers::Motion;
use readers::cnc::Control;
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex};

type Files = BTreeMap<String, String>;

/// Post, profile, main file.
const POSTS: [(&str, &str, &str); 9] = [
    ("krl", "cmt-al2319-kuka", "DEMO.src"),
    ("rapid", "cmt-steel-abb", "demo.mod"),
    ("fanuc", "cmt-steel-robots", "DEMO.ls"),
    ("inform", "cmt-steel-robots", "DEMO.jbi"),
    ("urscript", "cmt-steel-robots", "demo.script"),
    ("gcode", "plasma-304-cnc", "demo.nc"),
    ("gcode", "plasma-304-fanuc", "demo.nc"),
    ("gcode", "plasma-304-siemens", "DEMO.MPF"),
    ("gcode", "plasma-304-twincat", "demo.nc"),
];

/// Eight layers of a gear, planned once for each profile.
fn planned(profile: &Profile) -> Arc<Plan> {
    static PLANS: Mutex<BTreeMap<String, Arc<Plan>>> = Mutex::new(BTreeMap::new());
    let mut plans = PLANS.lock().unwrap();
    let plan = || {
        let mut profile = profile.clone();
        profile.fill.strategy = StrategyName::Contour;
        let mut plan = plan::plan("demo", &example::find("gear").unwrap().mesh(), &profile, &Task::new()).unwrap();
        plan.layers.truncate(8);
        Arc::new(plan)
    };
    Arc::clone(plans.entry(profile.name.clone()).or_insert_with(plan))
}

fn profile(post: &str, name: &str) -> Profile {
    let mut profile = Profile::built_in(name).unwrap();
    profile.start_stop.interpass_time = 12.0;
    if let Some(urscript) = profile.dialects.urscript.as_mut() {
        // One file.
        urscript.max_megabytes = 1000.0;
    }
    if let Some(gcode) = profile.dialects.gcode.as_mut() {
        // An axis of the wire would feed at once what was left out.
        gcode.wire_axis = None;
    }
    if post == "rapid" {
        profile.dialects.rapid.as_mut().unwrap().arc = beadwright::dialect::rapid::RapidArc::Plain;
    }
    profile
}

fn written(post: &str, plan: &Plan, profile: &Profile) -> Files {
    dialect::write(post, &plan.layers, &profile.job("demo")).unwrap()
}

/// The program from one pass on, as `--from-layer` and `--from-pass` write it.
fn resumed(post: &str, plan: &Plan, profile: &Profile, (layer, pass): (usize, usize)) -> Files {
    let job = profile.job("demo");
    let (mut writer, mut programmer) = (dialect::writer(post, &job).unwrap(), job.programmer(false));
    let mut chunks = writer.begin(&plan.header.extent);
    for at in &plan.layers[layer..] {
        chunks.extend(writer.layer(&programmer.layer_from(at, if at.index == layer { pass } else { 0 })));
    }
    chunks.extend(writer.end());
    let mut files = Files::new();
    chunks.into_iter().for_each(|chunk| files.entry(chunk.file).or_default().push_str(&chunk.text));
    files
}

/// Sets the variable that says where to begin.
fn begin_at(files: &mut Files, number: usize) {
    let variables = [
        ("DEMO_START=0", format!("DEMO_START={number}")),
        ("nStart:=0;", format!("nStart:={number};")),
        ("R[90]=0 ;", format!("R[90]={number} ;")),
        ("SET D090 0", format!("SET D090 {number}")),
        ("global start_at = 0", format!("global start_at = {number}")),
        ("#<_start> = 0", format!("#<_start> = {number}")),
        ("#100=0", format!("#100={number}")),
        ("R90=0", format!("R90={number}")),
    ];
    // The modules of layers only set it back.
    let main = files.iter_mut().filter(|(file, _)| !file.contains("L0")).map(|(_, text)| text);
    let found = main.filter_map(|text| Some((variables.iter().find(|v| text.contains(v.0))?, text)));
    let changed = found.map(|((old, new), text)| *text = text.replacen(old, new, 1)).count();
    assert_eq!(changed, 1, "{:?}", files.keys());
}

/// What our own reader finds.
fn totals(files: &Files, main: &str) -> ReadTotals {
    let program = common::read_back(files, main).unwrap();
    let odd: Vec<_> = program.notes.iter().filter(|note| note.contains("not followed")).collect();
    assert!(odd.is_empty(), "{main}: {odd:?}");
    program.totals()
}

/// What readers find that know nothing of ours.
fn motion(post: &str, name: &str, files: &Files) -> Motion {
    let cnc = |control, arc| readers::cnc::run(control, files.values().next().unwrap(), arc).motion;
    match post {
        "krl" => readers::krl::run(files, "DEMO", "$OUT[2]"),
        "rapid" => readers::rapid::run(files, "demo", "doArc"),
        "urscript" => readers::urscript::run(&files["demo.script"], 1),
        "fanuc" => readers::fanuc::run(files, "DEMO"),
        "inform" => readers::inform::run(files, "DEMO"),
        _ => match name {
            "plasma-304-fanuc" => cnc(Control::Fanuc, [3, 5]),
            "plasma-304-siemens" => cnc(Control::Siemens, [3, 5]),
            "plasma-304-twincat" => cnc(Control::TwinCat, [62, 63]),
            _ => readers::gcode::run(&files["demo.nc"], 3, 5),
        },
    }
}

fn same(a: &ReadTotals, b: &ReadTotals, case: &str) {
    assert_eq!(a.arc_starts, b.arc_starts, "{case}: starts");
    let (a, b) = (a.deposited_length_mm, b.deposited_length_mm);
    assert!((a - b).abs() < 1e-6 * b, "{case}: {a} for {b}");
}

#[test]
fn programs_begin_at_any_pass_by_their_variable() {
    for (post, name, main) in POSTS {
        let plain = profile(post, name);
        let mut profile = plain.clone();
        profile.program.restart = true;
        let plan = planned(&profile);
        let (layer, pass) = (6, 2);
        assert!(plan.layers.len() > layer + 1 && plan.layers[layer].passes.len() > pass, "{post}");
        let mut files = written(post, &plan, &profile);
        let whole = written(post, &plan, &plain);
        same(&totals(&files, main), &totals(&whole, main), post);
        let before = plan.layers[..layer].iter().map(|l| l.passes.len()).sum::<usize>() + pass;
        let all = motion(post, name, &whole);
        assert_eq!(motion(post, name, &files), all, "{name} {post}: from the beginning");
        begin_at(&mut files, 70_003);
        let resumed = resumed(post, &plan, &plain, (layer, pass));
        same(&totals(&files, main), &totals(&resumed, main), post);
        let (run, wanted) = (motion(post, name, &files), motion(post, name, &resumed));
        assert_eq!(run.welds, all.welds[before..], "{name} {post}: the rest");
        // No way to where the pass before ended, and no wait there.
        assert!((run.travel - wanted.travel).abs() < 0.01, "{name} {post}: {} mm for {}", run.travel, wanted.travel);
        assert!((run.waits - wanted.waits).abs() < 0.01, "{name} {post}: {} s for {}", run.waits, wanted.waits);
    }
}

/// Controls without such branches say so.
#[test]
fn posts_that_cannot_restart_refuse() {
    for (post, name) in [("gcode", "plasma-304-cnc"), ("gcode", "plasma-304-twincat"), ("marlin", "fdm-abs-0.4")] {
        let mut profile = Profile::built_in(name).unwrap();
        profile.program.restart = true;
        // TwinCAT's wire is an axis, which would feed at once what was left out.
        if name == "plasma-304-cnc" {
            profile.dialects.gcode.as_mut().unwrap().control = None;
        }
        let error = dialect::write(post, &planned(&profile).layers, &profile.job("demo")).unwrap_err().to_string();
        assert!(error.contains("program.restart") && error.contains("the layer and pass that come next"), "{error}");
    }
}

/// Lines of the profile are where they should be, each as often as it should.
#[test]
fn hooks_are_written_at_their_places() {
    for (post, name, _) in POSTS {
        let mut profile = profile(post, name);
        let plan = planned(&profile);
        let layers = plan.layers.len();
        let passes: usize = plan.layers.iter().map(|l| l.passes.len()).sum();
        let sections = &mut profile.dialects;
        let hooks = match post {
            "krl" => &mut sections.krl.as_mut().unwrap().hooks,
            "rapid" => &mut sections.rapid.as_mut().unwrap().hooks,
            "fanuc" => &mut sections.fanuc.as_mut().unwrap().hooks,
            "inform" => &mut sections.inform.as_mut().unwrap().hooks,
            "urscript" => &mut sections.urscript.as_mut().unwrap().hooks,
            _ => &mut sections.gcode.as_mut().unwrap().hooks,
        };
        let line = |name: &str| vec![format!("{name} {{{{layer}}}} {{{{pass}}}}")];
        hooks.arc_established = line("ESTABLISHED");
        hooks.before_arc_off = line("RELEASED");
        hooks.pass_start = line("BEGUN");
        hooks.pass_end = line("DONE");
        hooks.layer_end = line("LAYERDONE");
        hooks.interpass = line("COOL");
        hooks.measure = line("TOUCH");
        profile.program.measure_every = 3;
        let files = written(post, &plan, &profile);
        let text: String = files.values().map(String::as_str).collect();
        let order: Vec<&str> = text
            .split_whitespace()
            .filter(|word| ["ESTABLISHED", "RELEASED", "BEGUN", "DONE", "LAYERDONE", "COOL", "TOUCH"].contains(word))
            .collect();
        let count = |name: &str| order.iter().filter(|word| **word == name).count();
        assert_eq!(["ESTABLISHED", "RELEASED", "BEGUN", "DONE"].map(count), [passes; 4], "{post}");
        assert_eq!(
            [count("LAYERDONE"), count("COOL"), count("TOUCH")],
            [layers, layers - 1, (layers - 1) / 3],
            "{post}"
        );
        let one: Vec<&str> = order.iter().copied().skip_while(|word| *word != "BEGUN").take(4).collect();
        assert_eq!(one, ["BEGUN", "ESTABLISHED", "RELEASED", "DONE"], "{post}");
        assert!(text.contains("BEGUN 2 1") && text.contains("DONE 2 1"), "{post}");
        // A dry run has no arc to wait for.
        let dry: String = written(post, &plan, &profile.dry_run()).into_values().collect();
        assert!(!dry.contains("ESTABLISHED") && !dry.contains("RELEASED") && dry.contains("BEGUN"), "{post}");
    }
}

/// What the cell must supply is listed at the head of every program.
#[test]
fn the_head_lists_what_the_cell_must_supply() {
    for (post, name, main) in POSTS {
        let profile = profile(post, name);
        let files = written(post, &planned(&profile), &profile);
        let head: String = files[main].lines().take(40).collect::<String>().to_lowercase();
        assert_eq!(head.contains("the cell must supply"), !profile.safety.supplies.is_empty(), "{post}");
        assert!(post == "rapid" || head.contains("emergency"), "{post}");
    }
}
