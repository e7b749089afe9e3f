//! FANUC TP as ASCII (R-30iB, ArcTool): `NAME.ls` calls `NAME_L001.ls` and so on; a long layer continues in
//! `NAME_L001_2.ls`.
//!
//! Every move has its own position, in the frames of the profile. The arc is switched on separate lines after FINE;
//! moves inside a pass are CNT. Lines are numbered from 1; the second position of an arc is on a line without a number.

use super::section::{Fanuc, FanucSpeed};
use crate::dialect::writing::orientation::{self, Turn};
use crate::dialect::writing::{Chunk, Job, Values, Writer, ascii, crater_lines, split, upper_name, waits};
use crate::number::fixed;
use crate::program::{Instruction, LayerProgram, ProgramSettings, Weave};
use bead_plan::layer::Extent;
use bead_plan::process::Process;
use glam::DVec3;
use std::fmt::Write as _;

/// Program names may have this many characters.
const MAX_NAME: usize = 36;

/// Comments may have this many characters.
const MAX_COMMENT: usize = 16;

/// Remarks may have this many characters.
const MAX_REMARK: usize = 32;

/// Longest wait of one line, s.
const MAX_WAIT: f64 = 300.0;

/// Room for `_L`, and for the number of a split layer.
const SUFFIX: usize = 2 + 4;

/// Writes FANUC.
pub(super) struct FanucTp {
    name: String,
    comment: String,
    supplies: Vec<String>,
    fanuc: Fanuc,
    program: ProgramSettings,
    weave: Option<Weave>,
    values: Values,
    /// W, P, R of the torch, °.
    orientation: [f64; 3],
    travel_speed: f64,
    nominal_speed: f64,
    wire_feed_speed: f64,
    digits: usize,
    main: Program,
    /// Label after the current pass.
    skip: Option<usize>,
    /// Label after the moves from the previous pass.
    way: Option<usize>,
    /// How the torch swings at the moment, as it is written.
    weaving: Option<String>,
}

/// Lines and positions of one program.
#[derive(Default)]
struct Program {
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

    fn position(&mut self, head: &str, axes: [(&str, String); 6]) -> usize {
        self.points += 1;
        let _ = write!(self.positions, "P[{}]{{\r\n   GP1:\r\n    {head}\r\n", self.points);
        for (i, (axis, value)) in axes.iter().enumerate() {
            let end = ["", ",", ",\r\n"][if i == 5 { 0 } else { 1 + usize::from(i == 2) }];
            let _ = write!(self.positions, "{}{axis} = {value}{end}", if i % 3 == 0 { "    " } else { " " });
        }
        self.positions.push_str("\r\n};\r\n");
        self.points
    }

    fn text(&self, name: &str, comment: &str) -> String {
        let comment = &comment[..comment.len().min(MAX_COMMENT)];
        format!(
            "/PROG  {name}\r\n/ATTR\r\nOWNER = MNEDITOR;\r\nCOMMENT = \"{comment}\";\r\nLINE_COUNT = {};\r\n\
             PROTECT = READ_WRITE;\r\nDEFAULT_GROUP = 1,*,*,*,*;\r\n/MN\r\n{}/POS\r\n{}/END\r\n",
            self.count, self.lines, self.positions
        )
    }
}

impl FanucTp {
    /// Begins the program of a part and names it after the part.
    pub(super) fn new(job: &Job<'_>, fanuc: Fanuc) -> Self {
        let name = upper_name(&job.part);
        let values = Values::new(&name, job);
        let Process { deposition_speed: nominal_speed, wire_feed_speed, .. } = job.weld.process;
        let (travel_speed, orientation) = (job.weld.travel.speed, fanuc.orientation);
        let comment = ascii(&job.part).replace('"', "_");
        let main = Program::default();
        let (supplies, program, weave) = (job.supplies(MAX_REMARK), job.program.clone(), job.weave());
        Self {
            name,
            comment,
            supplies,
            fanuc,
            program,
            weave,
            values,
            orientation,
            travel_speed,
            nominal_speed,
            wire_feed_speed,
            digits: 3,
            main,
            skip: None,
            way: None,
            weaving: None,
        }
    }

    fn lines(&self, program: &mut Program, template: &[String]) {
        self.values.expand(template).for_each(|line| program.line(&format!("  {line}")));
    }

    /// Begins what a program begun later than `number` leaves out; returns the label where it continues.
    fn begin_skippable(&self, program: &mut Program, number: usize) -> Option<usize> {
        let label = self.program.restart.then(|| program.label())?;
        program.line(&format!("  IF R[{}]>{number},JMP LBL[{label}]", self.fanuc.restart_register));
        Some(label)
    }

    /// Lines that a program begun later than `number` leaves out.
    fn skippable(&self, program: &mut Program, number: usize, lines: &[String]) {
        if lines.is_empty() {
            return;
        }
        let label = self.begin_skippable(program, number);
        self.lines(program, lines);
        label.into_iter().for_each(|label| program.line(&format!("  LBL[{label}]")));
    }

    /// Begins a pass: a program that begins at it comes from anywhere, others by the moves that follow.
    fn pass_start(&mut self, program: &mut Program, pass: usize, above: DVec3) {
        let number = self.values.set_pass(pass);
        self.skip = self.begin_skippable(program, number);
        if self.program.restart {
            let (register, label, behind) = (self.fanuc.restart_register, program.label(), program.label());
            program.line(&format!("  IF R[{register}]=0,JMP LBL[{label}]"));
            self.instruction(program, Instruction::Approach { to: above });
            program.line(&format!("  R[{register}]=0"));
            program.line(&format!("  JMP LBL[{behind}]"));
            program.line(&format!("  LBL[{label}]"));
            self.way = Some(behind);
        }
    }

    /// The torch is above the start of the pass, whichever way it came.
    fn above(&mut self, program: &mut Program) {
        self.way.take().into_iter().for_each(|label| program.line(&format!("  LBL[{label}]")));
        self.lines(program, &self.fanuc.hooks.pass_start);
    }

    /// Swings the torch so that a period has the same length at any speed (mm/s).
    fn weave_at(&mut self, program: &mut Program, speed: f64) {
        let Some(weave) = &self.weave else { return };
        let [hertz, amplitude] = [speed / weave.length, weave.amplitude].map(|v| fixed(v, 1));
        let dwell = fixed(weave.dwell, 3);
        let wanted = format!("[{hertz}Hz,{amplitude}mm,{dwell}s,{dwell}s]");
        if self.weaving.as_ref() != Some(&wanted) {
            self.weave_end(program);
            program.line(&format!("  Weave Sine{wanted}"));
            self.weaving = Some(wanted);
        }
    }

    fn weave_end(&mut self, program: &mut Program) {
        if self.weaving.take().is_some() {
            program.line("  Weave End");
        }
    }

    /// The height to be added to a layer, which is set in its program.
    fn offset(&self, program: &mut Program) {
        if self.program.layer_offsets {
            let register = self.fanuc.offset_register;
            program.line("  !mm added to this layer");
            program.line(&format!("  PR[{register}]=LPOS-LPOS"));
            program.line(&format!("  PR[{register},3]=0"));
            program.line(&format!("  OFFSET CONDITION PR[{register}]"));
        }
    }

    /// What ends a motion where its layer has a height to be added.
    fn offset_word(&self) -> &'static str {
        if self.program.layer_offsets { " Offset" } else { "" }
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
        program.position(&head, axes)
    }

    fn home(&self, program: &mut Program) {
        let names = ["J1", "J2", "J3", "J4", "J5", "J6"];
        let axes = std::array::from_fn(|i| (names[i], format!("{:>9} deg", fixed(self.fanuc.home[i], 3))));
        let head = format!("UF : {}, UT : {},", self.fanuc.user_frame, self.fanuc.tool_frame);
        let number = program.position(&head, axes);
        program.line(&format!("J P[{number}] {}% FINE", fixed(self.fanuc.home_speed, 0)));
    }

    fn speed(&self, speed: f64) -> String {
        match self.fanuc.speed {
            FanucSpeed::WeldSpeed if (speed - self.nominal_speed).abs() < 1e-9 => "WELD_SPEED".to_owned(),
            FanucSpeed::CentimetresPerMinute => format!("{}cm/min", fixed((speed * 6.0).max(0.1), 1)),
            _ => format!("{}mm/sec", fixed(speed.max(0.1), 1)),
        }
    }

    fn instruction(&mut self, program: &mut Program, instruction: Instruction) {
        if let Some(attitude) = instruction.attitude() {
            self.orientation = orientation::xyz(self.fanuc.orientation, Turn::Attitude(attitude));
        }
        match instruction {
            Instruction::Approach { to } => {
                let number = self.pose(program, to);
                program.line(&format!("J P[{number}] {}% FINE{}", fixed(self.fanuc.home_speed, 0), self.offset_word()));
            }
            Instruction::Travel { to } | Instruction::Retract { to } => {
                let number = self.pose(program, to);
                // L takes at most 2000 mm/sec.
                program.line(&format!(
                    "L P[{number}] {}mm/sec FINE{}",
                    fixed(self.travel_speed.clamp(0.1, 2000.0), 1),
                    self.offset_word()
                ));
            }
            Instruction::ArcOn { pass, kind } => {
                program.line(&format!("  !pass {pass} {}", kind.name()));
                self.lines(program, &self.fanuc.arc_on);
                self.lines(program, &self.fanuc.hooks.arc_established);
            }
            Instruction::Weld { to, circle, speed, last, .. } => {
                self.weave_at(program, speed);
                let via = circle.map(|circle| self.pose(program, circle.via));
                let number = self.pose(program, to);
                let end = if last { "FINE".to_owned() } else { format!("CNT{}", self.fanuc.continuity) };
                let end = format!("P[{number}] {} {end}{}", self.speed(speed), self.offset_word());
                match via {
                    Some(via) => program.line(&format!("C P[{via}]\r\n    :  {end}")),
                    None => program.line(&format!("L {end}")),
                }
            }
            Instruction::WireFeed { ratio } => {
                self.values.set_wire_feed(ratio, self.wire_feed_speed);
                self.lines(program, &self.fanuc.wire_feed);
            }
            Instruction::Crater { seconds, ratio } => {
                if let Some(ratio) = ratio {
                    self.values.set_wire_feed(ratio, self.wire_feed_speed);
                    self.lines(program, crater_lines(&self.fanuc.crater, &self.fanuc.wire_feed));
                }
                wait(program, seconds);
            }
            Instruction::Dwell { seconds } => wait(program, seconds),
            Instruction::ArcOff { .. } => {
                self.weave_end(program);
                self.lines(program, &self.fanuc.hooks.before_arc_off);
                self.lines(program, &self.fanuc.arc_off);
            }
            Instruction::PassStart { pass, above, .. } => self.pass_start(program, pass, above),
            Instruction::Above => self.above(program),
            Instruction::Turn { .. } => {}
            Instruction::PassEnd => {
                self.lines(program, &self.fanuc.hooks.pass_end);
                self.skip.take().into_iter().for_each(|label| program.line(&format!("  LBL[{label}]")));
            }
        }
    }
}

fn wait(program: &mut Program, seconds: f64) {
    waits(seconds, MAX_WAIT).for_each(|s| program.line(&format!("  WAIT {}(sec)", fixed(s, 2))));
}

impl Writer for FanucTp {
    fn weaves(&self) -> bool {
        self.weave.is_some()
    }

    fn begin(&mut self, extent: &Extent) -> Vec<Chunk> {
        self.digits = extent.layers.to_string().len().max(3);
        self.name.truncate(MAX_NAME - SUFFIX - self.digits);
        self.values.set("layers", extent.layers);
        let mut main = Program::default();
        self.supplies.iter().for_each(|line| main.line(&format!("  !{line}")));
        if self.program.restart {
            main.line("  !0, or layer*10000+pass");
            main.line(&format!("  R[{}]=0", self.fanuc.restart_register));
        }
        self.frames(&mut main);
        self.home(&mut main);
        self.lines(&mut main, &self.fanuc.start);
        self.lines(&mut main, &self.fanuc.hooks.watch);
        self.main = main;
        Vec::new()
    }

    fn layer(&mut self, layer: &LayerProgram) -> Vec<Chunk> {
        if layer.instructions.is_empty() {
            return Vec::new();
        }
        self.values.set_layer(layer);
        let mut chunks = Vec::new();
        let parts = split::passes(&layer.instructions, self.fanuc.max_points);
        let count = parts.len();
        for (i, part) in parts.into_iter().enumerate() {
            let more = if i == 0 { String::new() } else { format!("_{}", i + 1) };
            let name = format!("{}_L{:0digits$}{more}", self.name, layer.index + 1, digits = self.digits);
            let mut program = Program::default();
            self.frames(&mut program);
            self.offset(&mut program);
            if i == 0 {
                program.line(&format!("  !layer {}, z {} mm", layer.index + 1, fixed(layer.z, 3)));
                let lines = self.fanuc.hooks.before_layer(&self.fanuc.layer_start, layer.index, &self.program);
                self.skippable(&mut program, self.values.last_number(), &lines);
            }
            part.iter().for_each(|&instruction| self.instruction(&mut program, instruction));
            if i + 1 == count {
                self.skippable(&mut program, self.values.last_number(), &self.fanuc.hooks.layer_end);
            }
            self.main.line(&format!("  CALL {name}"));
            chunks.push(Chunk {
                file: format!("{name}.ls"),
                text: program.text(&name, &format!("LAYER {}", layer.index + 1)),
            });
        }
        chunks
    }

    fn end(&mut self) -> Vec<Chunk> {
        let mut main = std::mem::take(&mut self.main);
        self.lines(&mut main, &self.fanuc.hooks.all_off);
        self.lines(&mut main, &self.fanuc.end);
        self.home(&mut main);
        vec![Chunk { file: format!("{}.ls", self.name), text: main.text(&self.name, &self.comment) }]
    }
}
