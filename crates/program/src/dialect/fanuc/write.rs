//! Writes FANUC TP as ASCII (R-30iB, ArcTool): `NAME.ls` calls `NAME_L001.ls` and so on; a long layer continues in
//! `NAME_L001_2.ls`.
//!
//! Every move has its own position, in the frames of the profile. The arc is switched on separate lines after FINE;
//! moves inside a pass are CNT. Lines are numbered from 1; the second position of an arc is on a line without a number.

use super::section::{Fanuc, FanucSpeed};
use crate::dialect::writing::frame::{self, Frame, Part, Piece, SUFFIX, Skippable, Syntax};
use crate::dialect::writing::orientation::{self, Turn};
use crate::dialect::writing::{Chunk, Job, ascii, upper_name, waits};
use crate::number::fixed;
use crate::program::{Attitude, Instruction, Weave};
use bead_plan::pass::PassKind;
use glam::DVec3;
use std::fmt::Write as _;

/// Most characters of a program name.
const MAX_NAME: usize = 36;

/// Most characters of a program's comment.
const MAX_COMMENT: usize = 16;

/// Most characters of a remark.
const MAX_REMARK: usize = 32;

/// Longest wait of one line, s.
const MAX_WAIT: f64 = 300.0;

/// Writes FANUC.
pub(super) struct FanucTp {
    frame: Frame,
    fanuc: Fanuc,
    weave: Option<Weave>,
    /// W, P, R of the torch, °.
    orientation: [f64; 3],
    /// Angles of the axes that turn the part, °; unused ones are ignored.
    turned: Option<[f64; 2]>,
    main: Program,
    /// Labels where open branches end.
    open: Vec<usize>,
    /// The weave in effect, as it is written.
    weaving: Option<String>,
}

/// Lines and positions of one program.
#[derive(Default)]
pub(super) struct Program {
    lines: String,
    count: usize,
    positions: String,
    points: usize,
    labels: usize,
}

impl Program {
    fn line(&mut self, text: &str) {
        self.count += 1;
        // Motions begin right after the colon, instructions two blanks after it.
        let _ = write!(self.lines, "{:>4}:{text} ;\r\n", self.count);
    }

    /// Number of a new label.
    fn label(&mut self) -> usize {
        self.labels += 1;
        self.labels
    }

    /// Adds a position and returns its number; `turning` is the line for the axes that turn the part, if any.
    fn position(&mut self, head: &str, axes: [(&str, String); 6], turning: &str) -> usize {
        self.points += 1;
        let _ = write!(self.positions, "P[{}]{{\r\n   GP1:\r\n    {head}\r\n", self.points);
        for (i, (axis, value)) in axes.iter().enumerate() {
            let end = ["", ",", ",\r\n"][if i == 5 { 0 } else { 1 + usize::from(i == 2) }];
            let _ = write!(self.positions, "{}{axis} = {value}{end}", if i % 3 == 0 { "    " } else { " " });
        }
        let _ = write!(self.positions, "\r\n{turning}}};\r\n");
        self.points
    }

    /// The program as a file; `groups` are the motion groups of its points.
    fn text(&self, name: &str, comment: &str, groups: &str) -> String {
        let comment = &comment[..comment.len().min(MAX_COMMENT)];
        format!(
            "/PROG  {name}\r\n/ATTR\r\nOWNER = MNEDITOR;\r\nCOMMENT = \"{comment}\";\r\nLINE_COUNT = {};\r\n\
             PROTECT = READ_WRITE;\r\nDEFAULT_GROUP = {groups};\r\n/MN\r\n{}/POS\r\n{}/END\r\n",
            self.count, self.lines, self.positions
        )
    }
}

impl FanucTp {
    /// Begins the program of a part and names it after the part.
    pub(super) fn new(job: &Job<'_>, fanuc: Fanuc) -> Self {
        let comment = ascii(&job.part).replace('"', "_");
        let frame = Frame { comment, ..Frame::new(job, upper_name(&job.part), MAX_REMARK, &fanuc) };
        let (orientation, main) = (fanuc.orientation, Program::default());
        let (weave, turned) = (job.weave(), job.program.first_angles());
        Self { frame, fanuc, weave, orientation, turned, main, open: Vec::new(), weaving: None }
    }

    /// The motion group that turns the part, if any.
    fn table(&self) -> Option<u32> {
        self.fanuc.table_group.filter(|_| self.frame.program.has_table())
    }

    /// The motion groups of a program's points.
    fn groups(&self) -> String {
        let moved = |group: u32| if group == 1 || Some(group) == self.table() { "1" } else { "*" };
        (1..=5).map(moved).collect::<Vec<_>>().join(",")
    }

    /// The line of a position for the axes that turn the part.
    fn turning(&self, angles: Option<[f64; 2]>) -> String {
        let Some((group, angles)) = self.table().zip(angles) else { return String::new() };
        let axes = angles.iter().take(self.frame.program.turning_axes()).zip(1..);
        let axes: Vec<String> = axes.map(|(angle, k)| format!("J{k} = {:>9} deg", fixed(*angle, 4))).collect();
        let Fanuc { user_frame, tool_frame, .. } = &self.fanuc;
        format!("   GP{group}:\r\n    UF : {user_frame}, UT : {tool_frame},\r\n    {}\r\n", axes.join(", "))
    }

    /// The option of a linear motion by which both groups move in coordination.
    fn together(&self) -> &'static str {
        if self.table().is_some() { " COORD" } else { "" }
    }

    /// Weaves with a pitch that is the same at any speed (mm/s).
    fn weave_at(&mut self, program: &mut Program, speed: f64) {
        let Some(weave) = self.weave.as_ref().map(|weave| weave.at_layer(self.frame.layer)) else { return };
        let [hertz, amplitude] = [speed / weave.length, weave.amplitude].map(|v| fixed(v, 1));
        let dwell = fixed(weave.dwell, 3);
        let wanted = format!("[{hertz}Hz,{amplitude}mm,{dwell}s,{dwell}s]");
        if self.weaving.as_ref() != Some(&wanted) {
            self.end_weave(program);
            program.line(&format!("  Weave Sine{wanted}"));
            self.weaving = Some(wanted);
        }
    }

    /// The height added to a layer, set in its program.
    fn offset(&self, program: &mut Program) {
        if self.frame.program.layer_offsets {
            let register = self.fanuc.offset_register;
            program.line("  !mm added to this layer");
            program.line(&format!("  PR[{register}]=LPOS-LPOS"));
            program.line(&format!("  PR[{register},3]=0"));
            program.line(&format!("  OFFSET CONDITION PR[{register}]"));
        }
    }

    /// The option of a motion whose layer has an added height.
    fn offset_word(&self) -> &'static str {
        if self.frame.program.layer_offsets { " Offset" } else { "" }
    }

    fn frames(&self, program: &mut Program) {
        program.line(&format!("  UFRAME_NUM={}", self.fanuc.user_frame));
        program.line(&format!("  UTOOL_NUM={}", self.fanuc.tool_frame));
    }

    /// Adds a position in the user frame and returns its number.
    fn pose(&self, program: &mut Program, to: DVec3) -> usize {
        let (Fanuc { user_frame, tool_frame, configuration, .. }, [w, p, r]) = (&self.fanuc, &self.orientation);
        let head = format!("UF : {user_frame}, UT : {tool_frame}, CONFIG : '{configuration}',");
        let (mm, deg) = (|v: f64| format!("{:>9} mm", fixed(v, 3)), |v: &f64| format!("{:>9} deg", fixed(*v, 4)));
        let axes = [("X", mm(to.x)), ("Y", mm(to.y)), ("Z", mm(to.z)), ("W", deg(w)), ("P", deg(p)), ("R", deg(r))];
        program.position(&head, axes, &self.turning(self.turned))
    }

    fn home(&self, program: &mut Program) {
        let names = ["J1", "J2", "J3", "J4", "J5", "J6"];
        let axes = std::array::from_fn(|i| (names[i], format!("{:>9} deg", fixed(self.fanuc.home[i], 3))));
        let head = format!("UF : {}, UT : {},", self.fanuc.user_frame, self.fanuc.tool_frame);
        let number = program.position(&head, axes, &self.turning(self.frame.program.first_angles()));
        program.line(&format!("J P[{number}] {}% FINE", fixed(self.fanuc.home_speed, 0)));
    }

    fn speed(&self, speed: f64) -> String {
        match self.fanuc.speed {
            FanucSpeed::WeldSpeed if (speed - self.frame.process.deposition_speed).abs() < 1e-9 => {
                "WELD_SPEED".to_owned()
            }
            FanucSpeed::CentimetresPerMinute => format!("{}cm/min", fixed((speed * 6.0).max(0.1), 1)),
            _ => format!("{}mm/sec", fixed(speed.max(0.1), 1)),
        }
    }
}

impl Syntax for FanucTp {
    type Text = Program;

    fn frame(&self) -> &Frame {
        &self.frame
    }

    fn frame_mut(&mut self) -> &mut Frame {
        &mut self.frame
    }

    fn longest_name(&self, digits: usize) -> usize {
        MAX_NAME - SUFFIX - digits
    }

    fn most_moves(&self) -> usize {
        self.fanuc.max_points
    }

    /// The main program is written at its end, when its number of lines is known.
    fn begin_main(&mut self) -> Vec<Chunk> {
        let mut main = Program::default();
        self.frame.supplies.iter().for_each(|line| main.line(&format!("  !{line}")));
        if self.frame.program.restart {
            main.line("  !0, or layer*10000+pass");
            main.line(&format!("  R[{}]=0", self.fanuc.restart_register));
        }
        self.frames(&mut main);
        self.home(&mut main);
        frame::start(self, &mut main);
        self.main = main;
        Vec::new()
    }

    fn end_main(&mut self) -> Vec<Chunk> {
        let mut main = std::mem::take(&mut self.main);
        frame::end(self, &mut main);
        self.home(&mut main);
        let Frame { name, comment, .. } = &self.frame;
        vec![Chunk { file: format!("{name}.ls"), text: main.text(name, comment, &self.groups()) }]
    }

    fn part(&mut self, part: &Part, moves: &[Instruction]) -> Vec<Chunk> {
        let (mut program, layer) = (Program::default(), part.layer + 1);
        self.frames(&mut program);
        self.offset(&mut program);
        if part.first {
            program.line(&format!("  !layer {layer}, z {} mm", fixed(part.z, 3)));
        }
        frame::body(self, &mut program, part, moves);
        let name = self.name_of(part);
        vec![Chunk { file: format!("{name}.ls"), text: program.text(&name, &format!("LAYER {layer}"), &self.groups()) }]
    }

    fn call(&mut self, part: &Part) -> Vec<Chunk> {
        self.main.line(&format!("  CALL {}", self.name_of(part)));
        Vec::new()
    }

    fn line(&mut self, program: &mut Program, line: &str) {
        program.line(&format!("  {line}"));
    }

    fn begin_skippable(&mut self, program: &mut Program, what: Skippable) {
        let label = program.label();
        program.line(&format!("  IF R[{}]>{},JMP LBL[{label}]", self.fanuc.restart_register, what.number()));
        self.open.push(label);
    }

    fn end_skippable(&mut self, program: &mut Program) {
        self.open.pop().into_iter().for_each(|label| program.line(&format!("  LBL[{label}]")));
    }

    fn begin_way(&mut self, program: &mut Program, _number: usize, above: DVec3) {
        let (register, label, behind) = (self.fanuc.restart_register, program.label(), program.label());
        program.line(&format!("  IF R[{register}]=0,JMP LBL[{label}]"));
        self.approach(program, above);
        program.line(&format!("  R[{register}]=0"));
        program.line(&format!("  JMP LBL[{behind}]"));
        program.line(&format!("  LBL[{label}]"));
        self.open.push(behind);
    }

    fn stand(&mut self, attitude: Attitude) {
        self.orientation = orientation::xyz(self.fanuc.orientation, Turn::Attitude(attitude));
        self.turned = attitude.held.map(|held| held.angles).or(self.turned);
    }

    fn approach(&mut self, program: &mut Program, to: DVec3) {
        let number = self.pose(program, to);
        program.line(&format!("J P[{number}] {}% FINE{}", fixed(self.fanuc.home_speed, 0), self.offset_word()));
    }

    fn travel(&mut self, program: &mut Program, to: DVec3) {
        let number = self.pose(program, to);
        // L takes at most 2000 mm/sec.
        let speed = fixed(self.frame.travel_speed.clamp(0.1, 2000.0), 1);
        program.line(&format!("L P[{number}] {speed}mm/sec FINE{}{}", self.together(), self.offset_word()));
    }

    fn pass(&mut self, program: &mut Program, pass: usize, kind: PassKind) {
        program.line(&format!("  !pass {pass} {}", kind.name()));
    }

    fn end_weave(&mut self, program: &mut Program) {
        if self.weaving.take().is_some() {
            program.line("  Weave End");
        }
    }

    fn weld(&mut self, program: &mut Program, piece: Piece, _next: &[Instruction]) {
        self.weave_at(program, piece.speed);
        let via = piece.circle.map(|circle| self.pose(program, circle.via));
        let number = self.pose(program, piece.to);
        let end = if piece.last { "FINE".to_owned() } else { format!("CNT{}", self.fanuc.continuity) };
        let (speed, together) = (self.speed(piece.speed), self.together());
        let end = format!("P[{number}] {speed} {end}{together}{}", self.offset_word());
        match via {
            Some(via) => program.line(&format!("C P[{via}]\r\n    :  {end}")),
            None => program.line(&format!("L {end}")),
        }
    }

    fn wait(&mut self, program: &mut Program, seconds: f64) {
        waits(seconds, MAX_WAIT).for_each(|s| program.line(&format!("  WAIT {}(sec)", fixed(s, 2))));
    }

    fn weaves(&self) -> bool {
        self.weave.is_some()
    }
}
