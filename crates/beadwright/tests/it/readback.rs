//! Programs read back: known geometry in each dialect, the same program in other words, errors, our own programs.

use beadwright::dialect::reading::{ArcCodes, CHORD_MM, Metal, Options, ReadError, ReadProgram, ReadTotals, read};
use beadwright::plan::{self, Plan};
use beadwright::profile::Profile;
use beadwright::task::Task;
use beadwright::{dialect, example};
use glam::DVec3;
use std::collections::BTreeMap;
use std::f64::consts::{FRAC_PI_4, PI};

fn try_read(text: &str, options: &Options) -> Result<ReadProgram, ReadError> {
    read(text, &mut |_| None, options)
}

fn of(text: &str) -> ReadProgram {
    try_read(text, &Options::default()).unwrap()
}

/// Reads with other modules at hand.
fn with_modules(text: &str, modules: &[(&str, &str)]) -> Result<ReadProgram, ReadError> {
    let mut find = |name: &str| modules.iter().find(|m| m.0.eq_ignore_ascii_case(name)).map(|m| m.1.to_owned());
    read(text, &mut find, &Options::default())
}

fn arc_codes(on: &str, off: &str) -> Options {
    Options { arc: ArcCodes { on: vec![on.to_owned()], off: vec![off.to_owned()], alone: false }, ..Options::default() }
}

#[track_caller]
fn near(a: f64, b: f64) {
    assert!((a - b).abs() <= 1e-9 * b.abs().max(1.0), "{a} is not {b}");
}

#[track_caller]
fn totals_are(program: &ReadProgram, starts: usize, deposited: f64, travel: f64) -> ReadTotals {
    let totals = program.totals();
    assert_eq!(totals.arc_starts, starts, "{program:#?}");
    near(totals.deposited_length_mm, deposited);
    near(totals.travel_length_mm, travel);
    totals
}

/// Chords of an arc of that length and radius are at most this much shorter, mm.
fn chord_loss(length: f64, radius: f64) -> f64 {
    // 1 − sin(a/2)/(a/2) for the half angle a with r (1 − cos a) = CHORD_MM.
    length * CHORD_MM / radius
}

const TWO_LAYERS: &str = "\
%
O0001 (PART)
N10 G21 G90 G94 G17 G40 G49 G80
N20 G54
N30 G0 Z10
N40 G0 X0 Y0
N50 Z2
N60 G4 P2.5
N70 M3
N80 G1 X30 F600
N90 Y40
N100 M5
N110 G0 Z10.
N120 G0 X0 Y0
N130 G0 Z4.
N140 M03
N150 G1 X30. F300.
N160 M05
N170 M30
%
";

#[test]
fn gcode_of_a_machine() {
    let program = of(TWO_LAYERS);
    assert_eq!((program.language, program.notes.len()), ("G-code", 0), "{:?}", program.notes);
    // Down 8; up 8, back 50, down 6.
    let totals = totals_are(&program, 2, 100.0, 8.0 + 8.0 + 50.0 + 6.0);
    near(totals.time_s, 70.0 / 10.0 + 30.0 / 5.0 + 2.5);
    assert_eq!(totals.volume_mm3, None);
    let layers = program.layers();
    assert_eq!(layers.iter().map(|l| (l.z, l.height)).collect::<Vec<_>>(), [(2.0, 2.0), (4.0, 2.0)]);
    let pass = &layers[0].passes[0];
    assert_eq!(pass.points, [[0.0, 0.0, 2.0], [30.0, 0.0, 2.0], [30.0, 40.0, 2.0]].map(DVec3::from_array));
    assert_eq!((pass.line, &pass.speed[..], &pass.volume[..]), (10, &[10.0, 10.0][..], &[None, None][..]));
}

#[test]
fn gcode_in_other_words_is_the_same() {
    let program = of(TWO_LAYERS);
    let squeezed: String = TWO_LAYERS.lines().map(|l| l.replace(' ', "") + "\n").collect();
    assert_eq!(of(&squeezed), program, "without blanks");
    assert_eq!(of(&TWO_LAYERS.to_lowercase()), program, "lower case");
    assert_eq!(of(&TWO_LAYERS.replace('\n', "\r\n")), program, "CRLF");
    let commented = TWO_LAYERS.replace('\n', " (X1 Y2) ; M3 G1 X5\n");
    assert_eq!(of(&commented), program, "comments");
}

#[test]
fn inches_and_increments_give_the_same_moves() {
    let mm = of("G21 G90\nG1 X0 Y0 Z0 F254\nM3\nG1 X25.4\nG3 X0 Y25.4 I-25.4 J0\nM5\n");
    let inches = of("G20 G90\nG1 X0 Y0 Z0 F10\nM3\nG1 X1\nG3 X0 Y1 R1\nM5\n");
    let steps = of("G21 G91\nG1 X0 Y0 Z0 F254\nM3\nG1 X25.4\nG3 X-25.4 Y25.4 I-25.4 J0\nM5\n");
    assert_eq!(mm.moves.len(), inches.moves.len());
    for (a, b) in mm.moves.iter().zip(inches.moves.iter().zip(&steps.moves)) {
        assert!(a.to.distance(b.0.to) < 1e-9 && a.to.distance(b.1.to) < 1e-9);
        near(b.0.speed, a.speed);
        assert_eq!((a.metal, b.0.metal), (b.0.metal, b.1.metal));
    }
}

#[test]
fn circles_of_two_halves_of_one_and_with_a_rise() {
    let (radius, length) = (20.0, 2.0 * PI * 20.0);
    let head = "G90 G17\nG0 X20 Y0 Z0\nM3\n";
    for body in [
        "G2 X-20 Y0 I-20 J0 F600\nG2 X20 Y0 I20 J0",
        "G3 X-20 Y0 R20 F600\nG3 X20 Y0 R20",
        "G2 I-20 F600",
        "G3 X20 Y0 I-20 J0 F600",
        "G2 X0 Y20 R-20 F600\nG2 X20 Y0 R20",
    ] {
        let program = of(&format!("{head}{body}\nM5\n"));
        let totals = program.totals();
        let laid = totals.deposited_length_mm;
        assert!(laid < length && length - laid < chord_loss(length, radius), "{body}: {laid}");
        assert!((totals.time_s - laid / 10.0).abs() < 1e-9);
        let centre = DVec3::ZERO;
        assert!(program.moves.iter().all(|m| (m.to.distance(centre) - radius).abs() < 1e-9), "{body}");
        let chords = program.moves.windows(2).map(|w| w[0].to.midpoint(w[1].to).length());
        assert!(chords.fold(f64::INFINITY, f64::min) > radius - CHORD_MM, "{body}");
    }
    let helix = of(&format!("{head}G3 X-20 Y0 Z10 I-20 J0 F600\nM5\n"));
    let length = (PI * radius).hypot(10.0);
    assert!((helix.totals().deposited_length_mm - length).abs() < chord_loss(length, radius));
    assert!(helix.moves.windows(2).skip(1).all(|w| w[1].to.z > w[0].to.z));
}

#[test]
fn g2_goes_clockwise() {
    let quarter = |g: &str| {
        let program = of(&format!("G1 X10 Y0 Z0 F60\nM3\n{g}\nM5\n"));
        program.totals().deposited_length_mm
    };
    assert!((quarter("G3 X0 Y10 I-10 J0") - 5.0 * PI).abs() < 0.02);
    assert!((quarter("G2 X0 Y10 I-10 J0") - 15.0 * PI).abs() < 0.05);
    assert!((quarter("G90.1\nG2 X0 Y10 I0 J0") - 15.0 * PI).abs() < 0.05);
}

const PRINT: &str = "\
G28
G90
M82
G92 E0
G1 Z0.2 F6000
G1 E-2 F2400
G92 E0
G1 X10 Y10 F7800
G1 E2 F2400
;WIDTH:0.45
G1 F1800
G1 X20 Y10 E2.5
G1 X20 Y20 E3
G1 X20 Y18 E1 F4800
G1 Z0.6
G1 X10 Y20
G1 E3
;WIDTH:0.6
G1 X10 Y10 E4 F1200
G1 X0 Y0 F7800
G4 P500
";

#[test]
fn a_print_lays_what_e_pushes_beyond_its_most() {
    let program = of(PRINT);
    let area = FRAC_PI_4 * 1.75 * 1.75;
    let totals = program.totals();
    assert_eq!(totals.arc_starts, 2, "{program:#?}");
    near(totals.deposited_length_mm, 30.0);
    near(totals.volume_mm3.unwrap(), 2.0 * area);
    let layers = program.layers();
    let first = &layers[0].passes[0];
    assert_eq!((first.width[0], first.speed[0], first.line), (Some(0.45), 30.0, 12));
    near(first.volume[1].unwrap(), 0.5 * area);
    assert_eq!(layers[1].passes[0].width, [Some(0.6)]);
    assert_eq!(program.dwell, 0.5);
    assert!(program.notes.iter().any(|n| n.contains("1.75 mm")), "{:?}", program.notes);
}

#[test]
fn relative_e_and_inches_of_filament_give_the_same() {
    let absolute = of(PRINT);
    let relative = "G28\nG90\nM83\nG1 Z.2 F6000\nG1 E-2 F2400\nG1 X10 Y10 F7800\nG1 E2 F2400\n;WIDTH:0.45\nG1 F1800\n\
        G1 X20 Y10 E.5\nG1 X20 Y20 E.5\nG1 X20 Y18 E-2 F4800\nG1 Z.6\nG1 X10 Y20\nG1 E2\n;WIDTH:0.6\n\
        G1 X10 Y10 E1 F1200\nG1 X0 Y0 F7800\nG4 P500\n";
    let relative = of(relative);
    assert_eq!(relative.moves.len(), absolute.moves.len());
    for (a, b) in absolute.moves.iter().zip(&relative.moves) {
        assert_eq!((a.to, a.speed, a.width, a.metal.is_laid()), (b.to, b.speed, b.width, b.metal.is_laid()));
    }
    near(relative.totals().volume_mm3.unwrap(), absolute.totals().volume_mm3.unwrap());
    let inches = of("G20\nG28\nG1 Z1 F60\nG1 X1 E1\n").totals();
    near(inches.volume_mm3.unwrap(), 25.4 * FRAC_PI_4 * 1.75 * 1.75);
    near(inches.deposited_length_mm, 25.4);
}

#[test]
fn the_filament_is_known_by_options_comments_or_flavour() {
    let body = "G28\nG1 Z1 F60\nG1 X10 E1\n";
    let volume = |text: &str, options: &Options| try_read(text, options).unwrap().totals().volume_mm3.unwrap();
    let area = |d: f64| FRAC_PI_4 * d * d;
    let option = Options { filament_diameter: Some(3.0), ..Options::default() };
    let comment = format!("{body}; filament_diameter = 2.85,2.85\n");
    near(volume(body, &Options::default()), area(1.75));
    near(volume(&comment, &Options::default()), area(2.85));
    near(volume(&comment, &option), area(3.0));
    near(volume(&format!(";FLAVOR:UltiGCode\n{body}"), &Options::default()), 1.0);
    near(volume(&body.replace("G28", "G28\nM200 D1.75\nM221 S50"), &Options::default()), 0.5);
}

#[test]
fn settings_of_a_printer_move_nothing() {
    let plain = of("G28\nG1 Z1 F60\nG1 X10 E1\nG1 X20 E2\n");
    let settings =
        of("G28\nG1 Z1 F60\nG1 X10 E1\nM201 X9000 Y9000 E5000\nM207 S1 F3600\nM84 X Y E\nM117 X1 done\nG1 X20 E2\n");
    let ends = |p: &ReadProgram| p.moves.iter().map(|m| (m.to, m.speed, m.metal)).collect::<Vec<_>>();
    assert_eq!(ends(&settings), ends(&plain));
    assert!(settings.notes.iter().all(|n| n.contains("1.75")), "{:?}", settings.notes);
}

#[test]
fn coordinates_set_by_g92_stay_in_the_part() {
    let program = of("G28\nG1 X10 Y0 Z1 F60\nG92 X0\nG1 X5 E1\nG92 E0\nG1 X7 E1\n");
    near(program.moves.last().unwrap().to.x, 17.0);
    near(program.totals().volume_mm3.unwrap(), 2.0 * FRAC_PI_4 * 1.75 * 1.75);
}

#[test]
fn codes_of_the_options_light_the_arc() {
    let body = "G1 X0 Y0 Z0 F60\nM64 P1\nG1 X10\nM65 P1\nM64 P2\nG1 X20\n";
    totals_are(&try_read(body, &arc_codes("m64p1", "M65 P1")).unwrap(), 1, 10.0, 10.0);
    let body = "G1 X0 Y0 Z0 F60\nWELD_ON\nG1 X10\nWELD_OFF\nG1 X20\n";
    totals_are(&try_read(body, &arc_codes("weld_on", "weld_off")).unwrap(), 1, 10.0, 10.0);
    let error = try_read("G1 X0 Y0 Z0\nM64 P1\nG1 X10\n", &Options::default()).unwrap_err().to_string();
    assert!(error.contains("strike and end the arc") && error.contains("M64 P1"), "{error}");
}

#[test]
fn two_passes_that_meet_are_two() {
    totals_are(&of("G1 X0 Y0 Z0 F60\nM3\nG1 X10\nM5\nG4 P1\nM3\nG1 X20\nM5\n"), 2, 20.0, 0.0);
}

#[test]
fn islands_printed_one_after_the_other_share_layers() {
    let mut text = "G28\nM83\n".to_owned();
    for x in [0.0, 50.0] {
        for z in [0.3, 0.5, 0.7] {
            text.push_str(&format!("G0 X{x} Y0 Z{z}\nG1 Y10 E1 F600\n"));
        }
    }
    let layers = of(&text).layers();
    assert_eq!(layers.iter().map(|l| l.passes.len()).collect::<Vec<_>>(), [2, 2, 2]);
    assert!(layers.iter().all(|l| l.passes[0].points[0].x < l.passes[1].points[0].x));
    let heights: Vec<f64> = layers.iter().map(|l| l.height).collect();
    assert!(heights.iter().zip([0.3, 0.2, 0.2]).all(|(a, b)| (a - b).abs() < 1e-12), "{heights:?}");
    let vase = of("G28\nM83\nG1 Z0.3\nG1 X10 Z0.4 E1 F600\nG1 Y10 Z0.5 E1\n").layers();
    assert_eq!((vase.len(), vase[0].passes.len()), (1, 1));
}

#[test]
fn what_is_not_understood_is_noted() {
    let program = of("G28\nM83\nG1 Z1 F60\nM888 P1\nM888 P1\nSET_LED RED=1\nG5 X10 E1\nG1 X20 E1 A5\n");
    for sentence in
        ["M888 is not understood and was left out (2 times, first in line 4).", "SET_LED", "A, B or C", "G5 "]
    {
        assert!(program.notes.iter().any(|n| n.contains(sentence)), "{sentence}: {:?}", program.notes);
    }
}

const KRL: &str = "\
&ACCESS RVP
&REL 1
DEF PART( )
DECL INT K
;FOLD INI;%{PE}
  BAS(#INITMOV,0)
;ENDFOLD (INI)
$BASE = BASE_DATA[1]
$VEL.CP = 0.1
PTP XHOME
LIN {X 0.000,Y 0.000,Z 10.000,A 0.0,B 0.0,C 180.0}
LIN {Z 2.000}
WAIT SEC 0.5
ARC_ON( )
$VEL.CP = 0.010000
LIN {X 30.0} C_DIS
LIN {Y 40.0}
ARC_OFF( )
PART_SUB( )
END
DEF PART_SUB( )
SLIN XP1 WITH $VEL.CP = 0.02
ARC_ON()
CIRC {X 10.0,Y 10.0},{X 0.0,Y 20.0,Z 2.0}
ARC_OFF()
END
";
const KRL_DATA: &str = "&ACCESS RVP\nDEFDAT PART\nDECL E6AXIS XHOME={A1 0.0,A2 -90.0}\n\
    DECL E6POS XP1={X 0.0,Y 0.0,Z 2.0,A 0.0,B 0.0,C 180.0,S 2,T 2,E1 0.0}\nENDDAT\n";

#[test]
fn krl_with_data_and_subprograms() {
    let program = with_modules(KRL, &[("PART.dat", KRL_DATA)]).unwrap();
    let totals = program.totals();
    assert_eq!((program.language, totals.arc_starts), ("KRL", 2));
    near(totals.travel_length_mm, 8.0 + 50.0);
    let half = 10.0 * PI;
    assert!((totals.deposited_length_mm - 70.0 - half).abs() < chord_loss(half, 10.0));
    let arc = totals.deposited_length_mm - 70.0;
    near(totals.time_s, 8.0 / 100.0 + 0.5 + 7.0 + 50.0 / 20.0 + arc / 10.0);
    assert_eq!(program.notes.len(), 2, "{:?}", program.notes);
    assert_eq!(program.layers()[0].passes[0].line, 16);
}

#[test]
fn krl_subprograms_come_from_other_modules() {
    let main = "DEF M( )\nLIN {X 0,Y 0,Z 0}\nM_L001( )\nM_L002( )\nEND\n";
    let layer =
        |x: i32| format!("&REL 1\r\nDEF L( )\r\n$VEL.CP=0.01\r\nARC_ON( )\r\nLIN {{X {x}}}\r\nARC_OFF()\r\nEND\r\n");
    let (one, two) = (layer(10), layer(20));
    let program = with_modules(main, &[("M_L001", &one), ("M_L002", &two)]).unwrap();
    totals_are(&program, 2, 20.0, 0.0);
    let error = with_modules(main, &[("M_L001", &one)]).unwrap_err();
    let text = error.to_string();
    assert!(text.contains("line 4 calls M_L002"), "{text}");
    let bad = one.replace("X 10", "X 1O.0");
    let text = with_modules(main, &[("M_L001", &bad)]).unwrap_err().to_string();
    assert!(text.contains("line 5 of M_L001") && text.contains("1O.0"), "{text}");
    let endless = "DEF M( )\nM( )\nEND\n";
    assert!(with_modules(endless, &[]).unwrap_err().to_string().contains("call of M"));
}

#[test]
fn krl_arc_tech_lights_after_the_move_and_ends_after_the_last() {
    let text = "\
DEF S( )
LIN {X 0,Y 0,Z 0}
TRIGGER WHEN DISTANCE = 1 DELAY = 0 DO ArcMainNG(#ArcOnMoveStd, WDAT1, WP1) PRIO = -1
ArcMainNG(#ArcOnBeforeMoveStd, WDAT1, WP1)
LIN {X 10}
ArcMainNG(#ArcOnAfterMoveStd, WDAT1, WP1)
BAS(#CP_PARAMS, gArcBasVelDefinition)
LIN {X 20} C_DIS
TRIGGER WHEN DISTANCE = 1 DELAY = 0 DO ArcMainNG(#ArcOffMoveStd, WDAT1, WP2) PRIO = -1
ArcMainNG(#ArcOffBeforeMoveStd, WDAT1, WP2)
LIN {X 40}
ArcMainNG(#ArcOffAfterMoveStd, WDAT1, WP2)
LIN {X 50}
END
";
    let data = "DEFDAT S\nDECL stArcDat_T WDAT1={WdatId[] \"WDAT1\",Strike {StartTime 0.3},Weld {Velocity 0.008000,Channel1 1.0}}\nENDDAT\n";
    let program = with_modules(text, &[("S.dat", data)]).unwrap();
    totals_are(&program, 1, 30.0, 20.0);
    assert_eq!(program.layers()[0].passes[0].speed, [8.0, 8.0]);
}

#[test]
fn krl_splines_and_whole_circles() {
    let text = "\
DEF S( )
LIN {X 0,Y 0,Z 0}
$VEL.CP = 0.1
ARC_ON( )
SPLINE WITH $VEL.CP = 0.01
  SLIN {X 10}
  SCIRC {X 20,Y 10},{X 10,Y 20} WITH $VEL.CP = 0.02
ENDSPLINE C_SPL
ARC_OFF( )
LIN {X 0,Y 0}
ARC_ON( )
CIRC {X 10,Y 10},{X 20,Y 0}, CA 360 C_DIS
ARC_OFF( )
CIRC {X 10,Y 10},{X 20,Y 0}, CA -90
END
";
    let program = of(text);
    let (half, whole) = (10.0 * PI, 20.0 * PI);
    let totals = program.totals();
    assert!((totals.deposited_length_mm - 10.0 - half - whole).abs() < 2.0 * chord_loss(half + whole, 10.0));
    let layer = &program.layers()[0];
    assert_eq!((layer.passes[0].speed[0], layer.passes[0].speed[1]), (10.0, 20.0));
    assert_eq!(layer.passes[1].speed[0], 100.0, "the speed of a block ends with it");
    let (start, end) = (layer.passes[1].points[0], *layer.passes[1].points.last().unwrap());
    assert!(start.distance(end) < 1e-9, "{end}");
    // A quarter against the order of the points, about (10, 0): down to (10, -10).
    let last = program.moves.last().unwrap().to;
    assert!(last.distance(DVec3::new(10.0, -10.0, 0.0)) < 1e-9, "{last}");
    assert!(program.notes.is_empty(), "{:?}", program.notes);
    let error =
        |from: &str, to: &str| try_read(&text.replacen(from, to, 1), &Options::default()).unwrap_err().to_string();
    let curve = error("SLIN {X 10}", "SPL {X 10}");
    assert!(curve.starts_with("line 6: SPL ") && curve.contains("SLIN and SCIRC"), "{curve}");
    let spot = error("{X 20,Y 0}, CA 360", "{X 0,Y 0}, CA 360");
    assert!(spot.starts_with("line 12: no circle") && spot.contains("two half circles"), "{spot}");
    assert!(error("CA 360", "CA ANGLE").starts_with("line 12: \"ANGLE"), "{}", error("CA 360", "CA ANGLE"));
    // Without arc, how it curves does not matter much.
    let travel = of(&text.replace("CIRC {X 10,Y 10},{X 20,Y 0}, CA -90", "SPL {X 5}"));
    assert!(travel.notes[0].starts_with("SPL runs on a curve"), "{:?}", travel.notes);
}

#[test]
fn circles_that_turn_for_ever_are_stopped() {
    let circle = "CIRC {X 1,Y 1},{X 2,Y 0},CA 36000000\nLIN {X 0,Y 0}\n";
    let text = format!("DEF A( )\nLIN {{X 0,Y 0,Z 2}}\nARC_ON( )\n{}ARC_OFF( )\nEND\n", circle.repeat(200));
    let error = try_read(&text, &Options::default()).unwrap_err().to_string();
    assert!(error.contains("10 million moves"), "{error}");
}

#[test]
fn rapids_take_the_speed_that_is_given() {
    let text = "G1 X0 Y0 Z0 F600\nM3\nG1 X10\nM5\nG0 Z50\nG0 X110\nG1 Z0\nM3\nG1 X120\nM5\n";
    let mut program = of(text);
    near(program.totals().time_s, 1.0 + 5.0 + 1.0);
    assert_eq!(program.take_rapids_at(75.0), (2, 150.0));
    near(program.totals().time_s, 1.0 + 2.0 + 5.0 + 1.0);
    // What has a speed keeps it.
    assert_eq!(program.take_rapids_at(1.0), (0, 0.0));
    let motion = beadwright::motion::Motion { acceleration: 1e6, corner_speed: 1000.0 };
    assert!((program.seconds(&motion) - 9.0).abs() < 0.01, "{}", program.seconds(&motion));
}

#[test]
fn krl_outputs_need_to_be_named() {
    let text = "DEF P( )\nLIN {X 0,Y 0,Z 0}\n$OUT[2] = TRUE\nLIN {X 10}\n$OUT[2]=FALSE\nLIN_REL {Y 5}\nEND\n";
    totals_are(&try_read(text, &arc_codes("$out[2]=true", "$OUT[2] = FALSE")).unwrap(), 1, 10.0, 5.0);
    let error = try_read(text, &Options::default()).unwrap_err().to_string();
    assert!(error.contains("$OUT[2] = TRUE"), "{error}");
    assert!(try_read(text, &arc_codes("$OUT[22] = TRUE", "x")).is_err());
}

const RAPID: &str = r#"
MODULE Part
  PERS tooldata tTorch:=[TRUE,[[85,0,320],[1,0,0,0]],[4.5,[30,0,120],[1,0,0,0],0,0,0]];
  CONST robtarget p1:=[[0,0,2],[0,1,0,0],[0,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]]; ! start
  PERS welddata wd1:=[8,0,[5,0,0],[0,0,0]];
  CONST speeddata vTrav:=[100,500,5000,1000];
  PROC Layer2()
    MoveL Offs(p1,0,0,2),vTrav,fine,tTorch;
    ArcLStart p1,v1000,sm1,wd1,fine,tTorch\WObj:=wobj0;
    ArcC [[10,10,2],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],
      [[0,20,2],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v1000,sm1,wd1\Weave:=wv1,z1,tTorch;
    ArcLEnd Offs(p1,0,0,2),v1000,sm1,wd1,fine,tTorch;
  ENDPROC
  PROC main()
    ConfL \Off;
    MoveAbsJ jHome,v200,fine,tTorch;
    MoveJ [[0,0,10],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v50,fine,tTorch;
    WaitTime \InPos,0.5;
    ArcLStart p1,v5,sm1,wd1,fine,tTorch;
    ArcL [[30,0,2],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v5,sm1,wd1,z1,tTorch;
    ArcLEnd [[30,40,2],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v5,sm1,wd1,fine,tTorch;
    Layer2;
  ENDPROC
ENDMODULE
"#;

#[test]
fn rapid_with_weld_instructions() {
    let program = of(RAPID);
    let totals = program.totals();
    assert_eq!((program.language, totals.arc_starts), ("RAPID", 2));
    let lifted = DVec3::new(30.0, 40.0, 2.0).distance(DVec3::new(0.0, 0.0, 4.0));
    near(totals.travel_length_mm, 8.0 + lifted + 2.0);
    let (half, last) = (10.0 * PI, 20.0_f64.hypot(2.0));
    let arc = totals.deposited_length_mm - 70.0 - last;
    assert!((arc - half).abs() < chord_loss(half, 10.0), "{arc}");
    // Welding goes at weld_speed, approaches at their own.
    let time = 0.5 + 8.0 / 5.0 + 70.0 / 8.0 + lifted / 100.0 + 2.0 / 1000.0 + (arc + last) / 8.0;
    near(totals.time_s, time);
    assert!(program.notes.iter().all(|n| n.contains("MoveAbsJ")), "{:?}", program.notes);
    assert_eq!(of(&RAPID.replace('\n', "\r\n")), program);
    let upper = of(&RAPID.to_uppercase());
    assert_eq!((&upper.moves, upper.dwell), (&program.moves, program.dwell));
}

#[test]
fn rapid_outputs_and_loaded_modules() {
    let main = "MODULE M\nPROC main()\n  Load \\Dynamic, \"HOME:/part/L001.mod\";\n  %\"L001:Layer001\"%;\n  UnLoad \"HOME:/part/L001.mod\";\n  Layer002;\nENDPROC\nENDMODULE\n";
    let layer = |name: &str| {
        format!(
            "MODULE {name}\nLOCAL CONST robtarget p:=[[10,0,0],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\nPROC \
             Layer{}()\nMoveL Offs(p,-10,0,0),v100,fine,tool0;\nArcLStart Offs(p,-10,0,0),v100,s,w,fine,tool0;\nArcLEnd p,v10,s,w,fine,\
             tool0;\nENDPROC\nENDMODULE\n",
            &name[1..]
        )
    };
    let (one, two) = (layer("L001"), layer("L002"));
    let program = with_modules(main, &[("L001", &one), ("Layer002", &two)]).unwrap();
    totals_are(&program, 2, 20.0, 10.0);
    let error = with_modules(main, &[("L001", &one)]).unwrap_err().to_string();
    assert!(error.contains("line 6 calls Layer002"), "{error}");
    let text = "MODULE M\nPROC go()\nMoveL [[0,0,0]],v100,fine,t;\nSetDO doArc, 1;\nMoveL [[10,0,0]],v10,fine,t;\nSetDO doArc,0;\nENDPROC\nENDMODULE\n";
    totals_are(&try_read(text, &arc_codes("SetDO doArc,1", "SetDO doArc,0")).unwrap(), 1, 10.0, 0.0);
    let error = try_read(text, &Options::default()).unwrap_err().to_string();
    assert!(error.contains("SetDO doArc, 1"), "{error}");
    let error = try_read(&text.replace("[[10,0,0]]", "[[1o,0,0]]"), &Options::default()).unwrap_err().to_string();
    assert!(error.contains("line 5") && error.contains("1o"), "{error}");
}

#[test]
fn errors_name_the_line_and_the_remedy() {
    let error = |text: &str| try_read(text, &Options::default()).unwrap_err().to_string();
    assert!(
        error("solid cube\nfacet normal 0 0 1\n").contains("neither G-code, KRL, RAPID, FANUC TP, INFORM nor URScript")
    );
    assert!(error("").contains("neither"));
    for text in ["G1 X0 Y0 Z0\nM3\nG1 X1.2.3\n", "G1 X0 Y0 Z0\nM3\nG1 X#1 Y5\n", "G28\nG1 Z1 E1\nG1 X[#1+2] E1\n"] {
        assert!(error(text).starts_with("line 3: \"X"), "{}", error(text));
    }
    assert!(error("G1 X0 Y0\nG1 X Y5\n").starts_with("line 2: \"X"), "{}", error("G1 X0 Y0\nG1 X Y5\n"));
    assert!(error("&REL 1\nDEFDAT P\nENDDAT\n").contains("no program to run"));
    assert!(error("MODULE D\nENDMODULE\n").contains("no program to run"));
    assert!(error("DEF P( )\nLIN {X 0,Y 0,Z 0}\nWAIT SEC T\nEND\n").starts_with("line 3"));
}

#[test]
fn broken_texts_never_panic() {
    for text in [PRINT, TWO_LAYERS, KRL, RAPID] {
        for cut in (0..text.len()).step_by(3) {
            let _ = try_read(&text[..cut], &Options::default());
            let _ = try_read(&text[cut..], &Options::default());
            let garbled = format!("{}\u{e4}\"({{[;,:%{}", &text[..cut], &text[cut..]);
            let _ = try_read(&garbled, &Options::default());
        }
    }
}

/// Writes a plan with a post.
fn written(plan: &Plan, profile: &Profile, name: &str) -> BTreeMap<String, String> {
    dialect::write(name, &plan.layers, &profile.job("PART")).unwrap()
}

#[test]
fn our_own_programs_read_back_as_planned() {
    for part in ["cross", "gear"] {
        for (profile, post, file, options) in [
            ("cmt-al2319-kuka", "krl", "PART.src", arc_codes("$OUT[2] = TRUE", "$OUT[2] = FALSE")),
            ("plasma-304-cnc", "gcode", "PART.nc", Options::default()),
            ("cmt-steel-abb", "rapid", "PART.mod", Options::default()),
        ] {
            let profile = Profile::built_in(profile).unwrap();
            let plan = plan::plan(part, &example::find(part).unwrap().mesh(), &profile, &Task::new()).unwrap();
            let files = written(&plan, &profile, post);
            let mut find = |name: &str| {
                let names = [name.to_owned(), format!("{name}.src"), format!("{name}.mod")];
                names.iter().find_map(|name| files.get(name)).cloned()
            };
            let program = read(&files[file], &mut find, &options).unwrap();
            let (totals, planned) = (program.totals(), &plan.summary.metrics);
            assert_eq!(totals.arc_starts, planned.arc_starts, "{part} {post}");
            let off = (totals.deposited_length_mm - planned.deposited_length_mm).abs();
            assert!(off < 0.01 * planned.passes as f64, "{part} {post}: {off} mm off");
            let layers = program.layers();
            assert_eq!(layers.len(), planned.layers);
            assert!(
                layers
                    .iter()
                    .zip(&plan.layers)
                    .all(|(a, b)| (a.z - b.z).abs() < 1e-3 && a.passes.len() == b.passes.len())
            );
            let (bead, law, nominal) = (profile.bead(), &profile.bead.law, profile.process.deposition_speed);
            // RAPID has speeds in steps of 0.2 mm/s.
            let paces = |pass: &beadwright::pass::Pass| pass.segments().map(|s| s.pace).collect::<Vec<_>>();
            for (read, planned) in layers.iter().zip(&plan.layers) {
                for (read, planned) in read.passes.iter().zip(&planned.passes) {
                    let paces = paces(planned);
                    assert!(
                        read.speed.iter().all(|s| paces.iter().any(|pace| (s - pace).abs() < 0.11)),
                        "{part} {post}"
                    );
                    let law_says = |s: beadwright::pass::Segment| nominal * law.pace(&bead, s.width);
                    assert!(planned.segments().all(|s| (s.pace - law_says(s)).abs() < 1e-9));
                }
            }
            assert!(program.moves.iter().all(|m| !matches!(m.metal, Metal::Volume(_))));
        }
    }
}
