//! FANUC TP, INFORM and URScript read back: our own programs in every dialect, foreign words, errors, and any lines at all.

use crate::common;
use beadwright::fill::StrategyName;

use beadwright::compare::{self, Totals};
use beadwright::deposit::DepositSettings;
use beadwright::dialect::fanuc::FanucSpeed;
use beadwright::dialect::inform::InformSpeed;
use beadwright::dialect::krl::KrlArc;
use beadwright::dialect::rapid::RapidArc;
use beadwright::dialect::reading::{ArcCodes, Options, ReadError, ReadProgram, read};
use beadwright::plan::{self, Plan};
use beadwright::profile::Profile;
use beadwright::task::Task;
use beadwright::{dialect, example, simulate};
use common::{flat, with_all_dialects};
use glam::DVec3;
use proptest::prelude::*;
use std::collections::BTreeMap;

/// The lines by which the profiles switch the arc.
fn options() -> Options {
    let words = |words: [&str; 3]| words.map(str::to_owned).to_vec();
    let on = words(["$OUT[2] = TRUE", "SetDO doArc,1", "set_standard_digital_out(1, True)"]);
    let off = words(["$OUT[2] = FALSE", "SetDO doArc,0", "set_standard_digital_out(1, False)"]);
    Options { arc: ArcCodes { on, off, alone: false }, ..Options::default() }
}

fn try_read(text: &str) -> Result<ReadProgram, ReadError> {
    read(text, &mut |_| None, &options())
}

/// All dialects on the aluminium process, whose beads the hybrid lets grow and shrink.
fn profile() -> Profile {
    let mut profile = with_all_dialects("cmt-al2319-kuka");
    profile.fill.strategy = StrategyName::Hybrid;
    profile.dialects.rapid.as_mut().unwrap().speed_step = 0.01;
    profile
}

/// Two hybrid layers of the cross.
fn hybrid(profile: &Profile) -> Plan {
    let mut plan = plan::plan("part", &example::find("cross").unwrap().mesh(), profile, &Task::new()).unwrap();
    plan.layers.truncate(2);
    plan
}

/// Every dialect: the post, what is changed in the profile for it, and the main file.
type Dressed = (&'static str, fn(&mut Profile), &'static str, &'static str);

const DIALECTS: [Dressed; 9] = [
    ("krl", |_| {}, "PART.src", "KRL"),
    ("krl", |p| p.dialects.krl.as_mut().unwrap().arc = KrlArc::Arctech, "PART.src", "KRL"),
    ("rapid", |_| {}, "part.mod", "RAPID"),
    ("rapid", |p| p.dialects.rapid.as_mut().unwrap().arc = RapidArc::Plain, "part.mod", "RAPID"),
    ("gcode", |_| {}, "part.nc", "G-code"),
    ("fanuc", |_| {}, "PART.ls", "FANUC TP"),
    ("fanuc", |p| p.dialects.fanuc.as_mut().unwrap().speed = FanucSpeed::CentimetresPerMinute, "PART.ls", "FANUC TP"),
    ("inform", |_| {}, "PART.jbi", "INFORM"),
    ("urscript", |_| {}, "part.script", "URScript"),
];

fn files(post: &str, plan: &Plan, profile: &Profile) -> BTreeMap<String, String> {
    dialect::write(post, &plan.layers, &profile.job("part")).unwrap()
}

fn read_files(files: &BTreeMap<String, String>, main: &str, options: &Options) -> ReadProgram {
    let mut find = |name: &str| {
        let names = ["", ".src", ".mod", ".ls", ".jbi"].map(|end| format!("{name}{end}"));
        names.iter().find_map(|name| files.get(name)).cloned()
    };
    read(&files[main], &mut find, options).unwrap()
}

#[test]
fn every_dialect_of_a_hybrid_layer_reads_back_as_planned() {
    let mut profile = profile();
    let plan = hybrid(&profile);
    let planned: Vec<_> = plan.layers.iter().flat_map(|l| &l.passes).collect();
    let length: f64 = planned.iter().map(|p| p.length()).sum();
    let settings = plan::deposit_settings(&profile);
    let metal: f64 = planned.iter().flat_map(|p| p.segments()).map(|s| s.from.distance(s.to) / s.pace).sum::<f64>()
        * settings.nominal.pace
        * settings.nominal.bead.area();
    for arcs in [false, true] {
        (profile.program.arcs, profile.program.chord_tolerance) = (arcs, if arcs { 0.05 } else { 0.0 });
        for (post, change, main, dialect) in DIALECTS {
            let mut profile = profile.clone();
            change(&mut profile);
            let program = read_files(&files(post, &plan, &profile), main, &options());
            assert_eq!(program.language, dialect);
            let totals = program.totals();
            assert_eq!(totals.arc_starts, planned.len(), "{post}");
            let off = (totals.deposited_length_mm - length).abs();
            assert!(off < if arcs { 2e-3 * length } else { 0.01 * planned.len() as f64 }, "{post} arcs {arcs}: {off}");
            let layers = simulate::layers(&program, &settings, &profile.bead.law, &profile.process, None);
            let volume = Totals::of_program(&totals, &layers, &profile).metal_volume_mm3;
            // Speeds have one decimal in some dialects.
            let exact = matches!(dialect, "KRL" | "G-code" | "URScript");
            let part = (volume / metal - 1.0).abs();
            assert!(part < if arcs || !exact { 3e-3 } else { 3e-4 }, "{post} arcs {arcs}: {volume} for {metal}");
            let unread = program.notes.iter().filter(|n| n.contains("left out") && !n.contains("unknown here"));
            assert_eq!(unread.count(), 0, "{post}: {:?}", program.notes);
        }
    }
}

#[test]
fn every_dialect_is_judged_alike() {
    let profile = flat(profile());
    let plan = hybrid(&profile);
    let mesh = example::find("cross").unwrap().mesh();
    let settings = DepositSettings { step: 0.75, ..plan::deposit_settings(&profile) };
    let mut first: Option<[f64; 4]> = None;
    for (post, change, main, _) in DIALECTS {
        let mut profile = profile.clone();
        change(&mut profile);
        let program = read_files(&files(post, &plan, &profile), main, &options());
        let mut layers = simulate::layers(&program, &settings, &profile.bead.law, &profile.process, None);
        simulate::outline(&mut layers, &mesh, profile.slice_options(), &Task::new()).unwrap();
        let totals = Totals::of_program(&program.totals(), &layers, &profile);
        let entry = compare::program(post, &layers, totals, settings, &None, &Task::new()).unwrap();
        let f = entry.figures;
        let figures = [f.void_percent(), f.low_percent(), f.overfill_percent(), f.outside_percent()];
        println!("{post}: {figures:.3?}");
        let first = first.get_or_insert(figures);
        assert!(first[0] > 0.0 && first[2] > 0.0, "{figures:?}");
        // Speeds have one decimal in some dialects, and places that are just high enough then count as low.
        let alike = figures.iter().zip(*first).zip([0.1, 0.2, 0.1, 0.1]).all(|((a, b), most)| (a - b).abs() < most);
        assert!(alike, "{post}: {figures:?} for {first:?}");
    }
}

#[test]
fn the_unit_of_inform_is_an_option() {
    let mut profile = profile();
    profile.dialects.inform.as_mut().unwrap().speed = InformSpeed::CentimetresPerMinute;
    let plan = hybrid(&profile);
    let files = files("inform", &plan, &profile);
    let speed = |cm: bool| {
        let options = Options { inform_cm_per_min: cm, ..options() };
        read_files(&files, "PART.jbi", &options).layers()[0].passes[0].speed[0]
    };
    assert!((speed(false) / speed(true) - 6.0).abs() < 1e-9, "{} {}", speed(false), speed(true));
}

const FANUC: &str = "/PROG  WELD1\tMacro
/ATTR
OWNER\t\t= MNEDITOR;
COMMENT\t\t= \"x\";
/APPL
  ARC Welding Equipment : 1,*,*,*,*;
/MN
   1:  !Approach ;
   2:  UFRAME_NUM=1 ;
   3:J P[1] 100% CNT100    ;
   4:  IF R[1]=1,JMP LBL[2] ;
   5:L P[2:\"start, here\"] 50.0inch/min FINE
    :  Weld Start[1,1] ;
   6:L P[3] 60.0cm/min CNT100    ;
   7:C P[4]
    :  P[5] WELD_SPEED FINE ACC100
    :  Weld End[1,1] ;
   8:  WAIT   .50(sec) ;
   9:  WAIT DI[1]=ON ;
  10:  CALL OTHER(1,2) ;
  11:  DO[3]=ON ;
  12:  SHINE ON ;
  13:L PR[1] 10mm/sec FINE ;
/POS
P[1]{
   GP1:
	UF : 1, UT : 1,
	J1=     0.000 deg,	J2=   0.000 deg,	J3=   0.000 deg,
	J4=     0.000 deg,	J5= -90.000 deg,	J6=   0.000 deg
};
P[2:\"start, here\"]{
   GP1:
	UF : 1, UT : 1,		CONFIG : 'N U T, 0, 0, 0',
	X =    0.000  mm,	Y =     0.000  mm,	Z =     2.000  mm,
	W =  -180.000 deg,	P =     0.000 deg,	R =     0.000 deg
   GP2:
	UF : 1, UT : 1,
	J1=     0.000 deg
};
P[3]{
   GP1:
	UF : 1, UT : 1,		CONFIG : 'N U T, 0, 0, 0',
	X =    30.000  mm,	Y =     0.000  mm,	Z =     2.000  mm
};
P[4]{
   GP1:
	UF : 1, UT : 1,
	X =    40.000  mm,	Y =     10.000  mm,	Z =     2.000  mm
};
P[5]{
   GP1:
	UF : 1, UT : 1,
	X =    30.000  mm,	Y =     20.000  mm,	Z =     2.000  mm
};
P[6]{
   GP1:
	UF : 1, UT : 1,
	X = ********  mm,	Y = ********  mm,	Z = ********  mm
};
/END
";

#[test]
fn a_fanuc_listing_as_a_pendant_writes_it() {
    let program = try_read(FANUC).unwrap();
    let totals = program.totals();
    assert_eq!((program.language, totals.arc_starts, program.dwell), ("FANUC TP", 1, 0.5));
    let half = 10.0 * std::f64::consts::PI;
    assert!((totals.deposited_length_mm - 30.0 - half).abs() < 0.05, "{}", totals.deposited_length_mm);
    let pass = &program.layers()[0].passes[0];
    assert_eq!((pass.speed[0], pass.speed[1], pass.line), (10.0, 0.0, 14));
    for note in ["OTHER is called with arguments", "SHINE", "IF is not followed", "a speed", "unknown here"] {
        assert!(program.notes.iter().any(|n| n.contains(note)), "{note}: {:?}", program.notes);
    }
    let error = |from: &str, to: &str| try_read(&FANUC.replacen(from, to, 1)).unwrap_err().to_string();
    let bad = error("X =    40.000", "X =    4O.000");
    assert!(bad.starts_with("line 48") && bad.contains("4O.000"), "{bad}");
    assert!(error("CALL OTHER(1,2)", "CALL OTHER").contains("line 20 calls OTHER"));
    assert!(error(".50(sec)", "R[1](sec)").starts_with("line 18"));
    assert!(error("/MN", "/XX").contains("no program to run"));
}

const INFORM: &str = "/JOB
//NAME SEAM
//POS
///NPOS 5,0,0,0,0,0
///TOOL 0
///POSTYPE PULSE
///PULSE
C00000=0,0,0,0,0,0
///POSTYPE ROBOT
///RECTAN
///RCONF 0,0,0,0,0,0,0,0
C00001=0.000,0.000,2.000,180.0000,0.0000,0.0000
C00002=30.000,0.000,2.000,180.0000,0.0000,0.0000
C00003=40.000,10.000,2.000,180.0000,0.0000,0.0000
C00004=30.000,20.000,2.000,180.0000,0.0000,0.0000
C00005=20.000,30.000,2.000,180.0000,0.0000,0.0000
C00006=30.000,40.000,2.000,180.0000,0.0000,0.0000
//INST
///DATE 2020/01/01 00:00
///ATTR SC,RW
///GROUP1 RB1
NOP
*START
MOVJ C00000 VJ=50.00
MOVL C00001 V=100.0
ARCON ASF#(1)
MOVC C00002 V=10.0
MOVC C00003 V=10.0
MOVC C00004 V=10.0 FPT
MOVC C00005 V=10.0
MOVC C00006 V=10.0
ARCOF AEF#(1)
TIMER T=1.50
JUMP *START IF IN#(1)=ON
MOVL P001 V=I000
LAMP ON
END
";

#[test]
fn an_inform_job_of_another_hand() {
    let program = try_read(INFORM).unwrap();
    let totals = program.totals();
    assert_eq!((program.language, totals.arc_starts, program.dwell), ("INFORM", 1, 1.5));
    // A line, and two half circles one behind the other.
    let arcs = 20.0 * std::f64::consts::PI;
    assert!((totals.deposited_length_mm - 30.0 - arcs).abs() < 0.1, "{}", totals.deposited_length_mm);
    for note in ["JUMP is not followed", "LAMP", "unknown here"] {
        assert!(program.notes.iter().any(|n| n.contains(note)), "{note}: {:?}", program.notes);
    }
    // A MOVL to the shared point separates the arcs as well, and adds nothing.
    let separated = INFORM.replace("V=10.0 FPT\n", "V=10.0\nMOVL C00004 V=10.0\nMOVC C00004 V=10.0\n");
    let separated = try_read(&separated).unwrap();
    assert_eq!(separated.totals(), totals);
    assert_eq!(separated.notes.len(), program.notes.len(), "{:?}", separated.notes);
    // Without either the controller sees one chain: behind the half circle to (30, 20), the next point lies on the line
    // through its last two.
    let chained = try_read(&INFORM.replace(" FPT", "")).unwrap();
    let left = chained.notes.iter().find(|n| n.contains("another circle with neither FPT nor a MOVL"));
    assert!(left.is_some_and(|n| n.contains("line 30")), "{:?}", chained.notes);
    assert!((chained.totals().deposited_length_mm - totals.deposited_length_mm).abs() > 1.0);
    // The last arc lacks its end.
    let short = try_read(&INFORM.replace("MOVC C00006 V=10.0\n", "")).unwrap();
    assert!(short.notes.iter().any(|n| n.contains("no end point")), "{:?}", short.notes);
    let error = |from: &str, to: &str| try_read(&INFORM.replacen(from, to, 1)).unwrap_err().to_string();
    assert!(error("C00003=40.000", "C00003=4O.000").starts_with("line 14: \"4O.000\""));
    assert!(error("T=1.50", "T=D000").starts_with("line 33"));
    assert!(error("LAMP ON", "CALL JOB:GONE-1").contains("line 36 calls GONE-1"));
}

/// A whole circle as it is taught by hand: four quarters and the start again, all in one chain.
#[test]
fn a_chain_of_movc_on_one_circle_is_that_circle() {
    let points = [(0, 0), (10, 10), (20, 0), (10, -10), (0, 0)];
    let positions: String = (1..).zip(points).map(|(n, (x, y))| format!("C{n:05}={x},{y},2,180,0,0\n")).collect();
    let moves: String = (1..=5).map(|n| format!("MOVC C{n:05} V=10.0\n")).collect();
    let text = format!("/JOB\n//POS\n///RECTAN\n{positions}//INST\nMOVL C00001 V=10.0\nARCON\n{moves}ARCOF\nEND\n");
    let program = try_read(&text).unwrap();
    let whole = 20.0 * std::f64::consts::PI;
    assert!((program.totals().deposited_length_mm - whole).abs() < 0.1, "{:?}", program.totals());
    assert!(program.notes.is_empty(), "{:?}", program.notes);
    // Every chord lies on the circle.
    let off = |m: &beadwright::dialect::reading::Move| (m.to.distance(DVec3::new(10.0, 0.0, 2.0)) - 10.0).abs();
    assert!(program.moves.iter().all(|m| off(m) < 1e-9), "{:?}", program.moves.iter().map(off).fold(0.0, f64::max));
}

#[test]
fn welds_to_pulses_are_refused() {
    let error = try_read(&INFORM.replace("///POSTYPE ROBOT\n///RECTAN\n", "///POSTYPE PULSE\n///PULSE\n"))
        .unwrap_err()
        .to_string();
    assert!(error.starts_with("line 25: C00001 is given in motor pulses") && error.contains("relative job"), "{error}");
}

const URSCRIPT: &str = "\
def seam():  # of another hand
  global f = p[0.5,0,0,0,0,0]
  home = [0, -1.57, 1.57, 0, 0, 0]
  v_weld = 0.01
  start = pose_trans(f, p[0,0,0.002,3.1416,0,0])
  def go(x):
    movel(pose_trans(f, p[0.03, 0, 0.002, 3.1416, 0, 0]), a=0.5, v=v_weld, r=0.0005)
    movec(pose_trans(f, p[0.04,0.01,0.002,0,0,0]), pose_trans(f, p[0.03,0.02,0.002,0,0,0]), 0.5, 0.02, r=0, mode=1)
  end
  movej(home, a=1.4, v=1.05)
  movel(start, 1.2, 0.25)
  set_standard_digital_out(1, True)
  sleep(0.2)
  if (get_standard_digital_in(3)):
    go(1)
  end
  set_standard_digital_out(1, False)
  movel(pose_add(start, p[0,0,0.1,0,0,0]), a=1.2, v=0.25)
  blink()
end
";

#[test]
fn an_urscript_of_another_hand() {
    let program = try_read(URSCRIPT).unwrap();
    let totals = program.totals();
    assert_eq!((program.language, totals.arc_starts, program.dwell), ("URScript", 1, 0.2));
    let half = 10.0 * std::f64::consts::PI;
    assert!((totals.deposited_length_mm - 30.0 - half).abs() < 0.05, "{}", totals.deposited_length_mm);
    let pass = &program.layers()[0].passes[0];
    assert!((pass.speed[0] - 10.0).abs() < 1e-9 && (pass.speed[1] - 20.0).abs() < 1e-9, "{:?}", pass.speed);
    assert_eq!(pass.points[1], DVec3::new(30.0, 0.0, 2.0));
    for note in ["if is not followed", "blink", "unknown here"] {
        assert!(program.notes.iter().any(|n| n.contains(note)), "{note}: {:?}", program.notes);
    }
    let bad = try_read(&URSCRIPT.replacen("0.04,0.01", "0.04,O.01", 1)).unwrap_err().to_string();
    assert!(bad.starts_with("line 8: \"O.01\""), "{bad}");
    let none = read(URSCRIPT, &mut |_| None, &Options::default()).unwrap_err().to_string();
    assert!(none.contains("strike and end the arc") && none.contains("set_standard_digital_out(1, True)"), "{none}");
    let endless = try_read("def a():\n  a()\nend\n").unwrap_err().to_string();
    assert!(endless.contains("call of a"), "{endless}");
}

#[test]
fn broken_texts_never_panic() {
    for text in [FANUC, INFORM, URSCRIPT] {
        for cut in (0..text.len()).step_by(2) {
            let _ = try_read(&text[..cut]);
            let _ = try_read(&text[cut..]);
            let _ = try_read(&format!("{}\u{e4}\"])}}({{[;,:%\n{}", &text[..cut], &text[cut..]));
        }
    }
}

/// A line of one of the languages, of parts of such lines, or of anything.
fn any_line() -> impl Strategy<Value = String> {
    let lines: Vec<String> = [FANUC, INFORM, URSCRIPT].iter().flat_map(|t| t.lines()).map(str::to_owned).collect();
    let one = prop::sample::select(lines);
    let halves = (one.clone(), one.clone(), 0..30_usize).prop_map(|(a, b, at)| {
        let cut = |text: &str| (0..=at.min(text.len())).rev().find(|i| text.is_char_boundary(*i)).unwrap_or(0);
        format!("{}{}", &a[..cut(&a)], &b[cut(&b)..])
    });
    prop_oneof![4 => one, 3 => halves, 1 => "[-A-Za-z0-9 .,:;=\\[\\](){}#'\"/*!\u{e9}]{0,40}"]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_lines_are_read_or_refused(head in 0..4_usize, lines in prop::collection::vec(any_line(), 0..60)) {
        let head = ["/PROG X\n/MN\n", "/JOB\n//POS\n", "def x():\n", ""][head];
        let text = format!("{head}{}", lines.join("\n"));
        let mut other = |name: &str| (name == "OTHER" || name == "go").then(|| text.clone());
        match read(&text, &mut other, &options()) {
            Ok(program) => prop_assert!(program.moves.iter().all(|m| m.to.is_finite() && m.speed.is_finite())),
            Err(error) => prop_assert!(error.to_string().len() > 20),
        }
    }
}
