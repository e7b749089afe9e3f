//! Loops, branches and jumps of programs, as far as their bounds and conditions are known: run as a controller runs them.
//! What is not known is reported, and its lines are read once.

use beadwright::dialect::reading::{ArcCodes, Options, ReadError, ReadProgram, read};

#[track_caller]
fn near(a: f64, b: f64) {
    assert!((a - b).abs() <= 1e-9 * b.abs().max(1.0), "{a} is not {b}");
}

/// `inside` a loop of every language that has them, behind a start at the origin, arc on.
fn looped(inside: [&str; 3]) -> [String; 3] {
    let [krl, rapid, script] = inside;
    [
        format!("DEF P( )\nLIN {{X 0,Y 0,Z 0}}\nARC_ON( )\n{krl}\nARC_OFF( )\nEND\n"),
        format!(
            "MODULE M\nPROC main()\nMoveL [[0,0,0]],v10,fine,t;\nSetDO doArc,1;\n{rapid}\nSetDO doArc,0;\nENDPROC\nENDMODULE\n"
        ),
        format!(
            "def p():\nmovel(p[0,0,0,0,0,0], v=0.1)\nset_digital_out(1, True)\n{script}\nset_digital_out(1, False)\nend\n"
        ),
    ]
}

fn read_looped(text: &str) -> Result<ReadProgram, ReadError> {
    let [on, off] = [["SetDO doArc,1", "set_digital_out(1, True)"], ["SetDO doArc,0", "set_digital_out(1, False)"]]
        .map(|codes| codes.map(str::to_owned).to_vec());
    read(text, &mut |_| None, &Options { arc: ArcCodes { on, off, alone: false }, ..Options::default() })
}

#[test]
fn loops_turn_as_often_as_they_say() {
    const THERE_AND_BACK: [&str; 3] = [
        "LIN {X 10}\nLIN {X 0}",
        "MoveL [[10,0,0]],v10,fine,t;\nMoveL [[0,0,0]],v10,fine,t;",
        "movel(p[0.01,0,0,0,0,0], v=0.1)\nmovel(p[0,0,0,0,0,0], v=0.1)",
    ];
    let [krl, rapid, script] = THERE_AND_BACK;
    // Head and end of a loop in each language, and how often it turns.
    let loops: [(&str, &str, f64); 13] = [
        ("FOR I=1 TO 4", "ENDFOR", 4.0),
        ("for i = 10 to 1 step -3 ;down", "endfor", 4.0),
        ("FOR I=2 TO 1", "LIN {Y 7}\nENDFOR\nLIN {X 10}\nLIN {X 0}", 1.0),
        ("FOR I=1 TO 3\nFOR J=0 TO 4", "ENDFOR\nENDFOR", 15.0),
        ("FOR i FROM 1 TO 4 DO", "ENDFOR", 4.0),
        ("FOR i FROM 4 TO 1 DO", "ENDFOR", 4.0),
        ("FOR i FROM 0 TO 10 STEP 5 DO", "ENDFOR", 3.0),
        ("i = 0\nwhile i < 4:", "i = i + 1\nend", 4.0),
        ("i = 4\nwhile (i >= 1):", "i = i - 1\nend", 4.0),
        ("i = 0\nwhile i < 3:\nj = 0\nwhile j <= 1:", "j = j + 1\nend\ni = i + 1\nend", 6.0),
        ("FOR R[1]=1 TO 4", "ENDFOR", 4.0),
        ("FOR R[1]=4 DOWNTO 1", "ENDFOR", 4.0),
        ("FOR R[1]=1 TO 2 ;\n   6:  FOR R[2]=1 TO 3", "ENDFOR ;\n   9:  ENDFOR", 6.0),
    ];
    for (k, (head, end, turns)) in loops.into_iter().enumerate() {
        let inside = [krl, rapid, script].map(|motion| format!("{head}\n{motion}\n{end}"));
        let texts = looped([&inside[0], &inside[1], &inside[2]]);
        let program = match k {
            0..4 => read_looped(&texts[0]),
            4..7 => read_looped(&texts[1]),
            7..10 => read_looped(&texts[2]),
            _ => read_looped(&fanuc_loop(head, end)),
        };
        let program = program.unwrap();
        near(program.totals().deposited_length_mm, 20.0 * turns);
        assert_eq!(program.totals().arc_starts, 1, "{head}");
        assert!(program.notes.iter().all(|n| !n.contains("not followed")), "{head}: {:?}", program.notes);
    }
}

fn fanuc_loop(head: &str, end: &str) -> String {
    let place = |n: usize, x: f64| {
        format!("P[{n}]{{\n   GP1:\n\tUF : 1, UT : 1,\n\tX = {x:.3} mm, Y = 0.000 mm, Z = 0.000 mm\n}};\n")
    };
    format!(
        "/PROG  A\n/MN\n   1:L P[1] 10mm/sec FINE Weld Start[1,1] ;\n   2:  {head} ;\n   3:L P[2] 10mm/sec FINE ;\n   4:L P[1] \
         10mm/sec FINE ;\n   5:  {end} ;\n   6:  Weld End[1,1] ;\n/POS\n{}{}/END\n",
        place(1, 0.0),
        place(2, 10.0)
    )
}

#[test]
fn loops_that_cannot_be_counted_are_reported_and_endless_ones_refused() {
    let once = [
        "FOR I=1 TO N\nLIN {X 10}\nENDFOR",
        "FOR i FROM 1 TO n DO\nMoveL [[10,0,0]],v10,fine,t;\nENDFOR",
        "i = 0\nwhile i < 5:\nif x > 1:\ni = i + 1\nend\nmovel(p[0.01,0,0,0,0,0], v=0.1)\nend",
    ];
    for text in looped(once) {
        let program = read_looped(&text).unwrap();
        near(program.totals().deposited_length_mm, 10.0);
        assert!(program.notes.iter().any(|n| n.contains("read once")), "{:?}", program.notes);
    }
    let many = [
        "FOR I=1 TO 1000\nFOR J=1 TO 1000\nLIN {X 10}\nENDFOR\nENDFOR",
        "FOR i FROM 1 TO 1e9 DO\nMoveL [[10,0,0]],v10,fine,t;\nENDFOR",
        "i = 0\nwhile i < 1e9:\nmovel(p[0.01,0,0,0,0,0], v=0.1)\ni = i + 1\nend",
    ];
    for (text, line) in looped(many).iter().zip([7, 7, 8]) {
        let error = read_looped(text).unwrap_err().to_string();
        assert!(error.starts_with(&format!("line {line}: the loops")) && error.contains("100000 times"), "{error}");
    }
}

/// Where the arc burns first to 10, then back and forth; the branch is what lies between.
#[test]
fn branches_run_where_their_conditions_are_known() {
    let [ahead, back] = ["LIN {X 10}", "LIN {X 0}"];
    let krl = |branch: &str| looped([branch, "", ""])[0].clone();
    let rapid = |branch: &str| looped(["", branch, ""])[1].clone();
    let script = |branch: &str| looped(["", "", branch])[2].clone();
    let (move_on, move_back) = ("MoveL [[10,0,0]],v10,fine,t;", "MoveL [[0,0,0]],v10,fine,t;");
    let (line_on, line_back) = ("movel(p[0.01,0,0,0,0,0], v=0.1)", "movel(p[0,0,0,0,0,0], v=0.1)");
    // 10 mm where the first branch runs, 30 where the other does, 40 where neither is known.
    let thrice = [
        format!("{ahead}\n{back}\n{ahead}"),
        format!("{move_on}\n{move_back}\n{move_on}"),
        format!("{line_on}\n{line_back}\n{line_on}"),
    ];
    let [three, rapid_three, script_three] = &thrice;
    for (text, length) in [
        (krl(&format!("N=3\nIF N <= 3 THEN\n{ahead}\nELSE\n{three}\nENDIF")), 10.0),
        (krl(&format!("N=3\nIF (N > 3) THEN\n{three}\nENDIF\n{ahead}")), 10.0),
        (krl(&format!("N=3\nIF N > 3 THEN\n{ahead}\nELSE\n{three}\nENDIF")), 30.0),
        (krl(&format!("N=1\nIF N==1 THEN\nIF N==2 THEN\n{three}\nENDIF\n{ahead}\nENDIF")), 10.0),
        (rapid(&format!("n:=3;\nIF n<=3 THEN\n{move_on}\nELSE\n{rapid_three}\nENDIF")), 10.0),
        (rapid(&format!("n:=3;\nIF n>3 THEN\n{move_on}\nELSE\n{rapid_three}\nENDIF")), 30.0),
        (script(&format!("n = 3\nif n <= 3:\n{line_on}\nelse:\n{script_three}\nend")), 10.0),
        (script(&format!("n = 3\nif n > 3:\n{line_on}\nelse:\n{script_three}\nend")), 30.0),
        (
            "#<_n> = 3\nG1 X0 Y0 Z0 F600\nM3\nO1 if [#<_n> LE 3]\nG1 X10\nO1 else\nG1 X30\nO1 endif\nM5\n".to_owned(),
            10.0,
        ),
        ("#1 = 3\nG1 X0 Y0 Z0 F600\nM3\nO1 if [#1 GT 3]\nG1 X10\nO1 else\nG1 X30\nO1 endif\nM5\n".to_owned(), 30.0),
    ] {
        let program = read_looped(&text).unwrap_or_else(|error| panic!("{text}: {error}"));
        assert!(
            (program.totals().deposited_length_mm - length).abs() < 1e-9,
            "{text}: {}",
            program.totals().deposited_length_mm
        );
        assert!(program.notes.iter().all(|n| !n.contains("not followed")), "{text}: {:?}", program.notes);
    }
}

/// A condition of which nothing is known: reported, and no motion is lost.
#[test]
fn branches_of_which_nothing_is_known_are_reported() {
    let unknown = [
        "IF N > 3 THEN\nLIN {X 10}\nELSE\nLIN {X 0}\nENDIF",
        "IF n>3 THEN\nMoveL [[10,0,0]],v10,fine,t;\nELSE\nMoveL [[0,0,0]],v10,fine,t;\nENDIF",
        "if n > 3:\nmovel(p[0.01,0,0,0,0,0], v=0.1)\nelse:\nmovel(p[0,0,0,0,0,0], v=0.1)\nend",
    ];
    // An input may be off, too, where something moves then.
    let input = "IF NOT $IN[5] THEN\nLIN {X 10}\nLIN {X 0}\nENDIF";
    let texts = looped(unknown).into_iter().chain([looped([input, "", ""])[0].clone()]);
    for text in texts {
        let program = read_looped(&text).unwrap();
        near(program.totals().deposited_length_mm, 20.0);
        assert!(program.notes.iter().any(|n| n.contains("read once")), "{text}: {:?}", program.notes);
    }
    // A wait for the arc moves nothing and lights nothing.
    let wait = "WHILE NOT $IN[1]\nARC_OFF( )\nHALT\nARC_ON( )\nENDWHILE\nLIN {X 10}";
    let program = read_looped(&looped([wait, "", ""])[0]).unwrap();
    assert_eq!((program.totals().arc_starts, program.notes.len()), (1, 0), "{:?}", program.notes);
}

/// Jumps of FANUC and INFORM: forward, and known.
#[test]
fn jumps_go_forward_where_their_conditions_are_known() {
    let fanuc = |set: usize| {
        let text = fanuc_loop(&format!("R[5]={set} ;\n   3:  IF R[5]>3,JMP LBL[1]"), "LBL[1]");
        read_looped(&text).map(|program| program.totals().deposited_length_mm)
    };
    near(fanuc(3).unwrap(), 20.0);
    assert!(fanuc(4).is_err(), "nothing is laid");
    let inform = |set: usize| {
        let text = format!(
            "/JOB\n//NAME A\n//POS\n///NPOS 3,0,0,0,0,0\n///RECTAN\nC00000=0,0,0,180,0,0\nC00001=10,0,0,180,0,0\nC00002=0,30,0,180,0,0\n\
             //INST\nNOP\nMOVL C00000 V=10.0\nARCON\nSET D001 {set}\nMOVL C00001 V=10.0\nJUMP *A IF D001>3\nMOVL C00000 V=10.0\n*A\n\
             ARCOF\nEND\n"
        );
        read_looped(&text).unwrap().totals().deposited_length_mm
    };
    near(inform(3), 20.0);
    near(inform(4), 10.0);
}
