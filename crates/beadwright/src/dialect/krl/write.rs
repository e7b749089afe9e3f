//! KUKA KRL for KR C4 (KSS 8.x): `NAME.src` calls `NAME_L001.src` and so on, `NAME.dat` holds the home position.
//!
//! One module per layer keeps the files small enough for the pendant, and a build can be resumed at any layer. The arc
//! is switched at exact stops only; points inside a pass are blended with `C_DIS`. With `arc = "arctech"` the inline
//! forms of ArcTech Basic switch the arc; their data are in a `.dat` beside each layer's module.

use super::arctech::{Forms, Target};
use crate::dialect::writing::volumes::{Volumes, from_anywhere};
use crate::dialect::writing::orientation::{self, Turn};
use crate::dialect::writing::{Chunk, Job, Values, Writer, crater_lines, restart, split, upper_name};
use crate::number::{fixed, push_fixed};
use super::arctech_section::KrlArc;
use super::section::{Krl, KrlMotion};
use crate::process::Process;
use crate::program::{Instruction, LayerProgram, ProgramSettings, Weave};
use glam::DVec3;

/// Module names may have this many characters.
const MAX_NAME: usize = 24;

/// Comments are wrapped at this many characters.
const MAX_COMMENT: usize = 76;

/// Room for the number of a part of a layer: `_999`.
const PART: usize = 4;

/// Writes KRL.
pub(super) struct KukaKrl {
    name: String,
    comment: String,
    supplies: Vec<String>,
    krl: Krl,
    program: ProgramSettings,
    weave: Option<Weave>,
    process: Process,
    values: Values,
    travel_speed: f64,
    /// Angle of the turn table, °: E1, or E2 where the robot stands on a linear axis.
    table: Option<f64>,
    /// A, B, C of the torch, °.
    orientation: [f64; 3],
    digits: usize,
    layers: usize,
    /// Speed set last in the module, mm/s.
    speed: f64,
    volumes: Volumes,
    /// Name of the main program of the present volume.
    main: String,
}

impl KukaKrl {
    /// Begins the program of a part and names the module after the part.
    pub(super) fn new(job: &Job<'_>, krl: Krl) -> Self {
        let name = upper_name(&job.part);
        let comment = job.comment();
        let values = Values::new(&name, job);
        let (process, travel_speed) = (job.weld.process.clone(), job.weld.travel.speed);
        let (table, orientation) = (job.program.table_angle, krl.orientation);
        let (volumes, main) = (Volumes::new(krl.max_megabytes), String::new());
        let (supplies, program, weave) = (job.supplies(MAX_COMMENT), job.program.clone(), job.weave.cloned());
        Self { name, comment, supplies, krl, program, weave, process, values, travel_speed, table, orientation, digits: 3, layers: 0, speed: 0.0, volumes, main }
    }

    fn layer_name(&self, index: usize) -> String {
        format!("{}_L{:0digits$}", self.name, index + 1, digits = self.digits)
    }

    /// The module for one part of a layer (`part` counts from 0; `last` if no other follows), with its data and its call.
    fn module(&mut self, program: &LayerProgram, part: usize, last: bool, moves: &[Instruction]) -> Vec<Chunk> {
        let more = if part == 0 { String::new() } else { format!("_{}", part + 1) };
        let module = format!("{}{more}", self.layer_name(program.index));
        self.speed = 0.0;
        let mut text = self.head(&module);
        text.reserve(moves.len() * 70);
        text.push_str(&format!("; layer {}, z {} mm\r\n", program.index + 1, fixed(program.z, 3)));
        if self.program.layer_offsets {
            let (main, base) = (&self.main, self.krl.base);
            text.push_str(&format!("{main}_SHIFT.Z = {main}_DZ[{}]\r\n", program.index + 1));
            text.push_str(&format!("$BASE = BASE_DATA[{base}]:{main}_SHIFT\r\n"));
        }
        if part == 0 {
            let lines = self.krl.hooks.before_layer(&self.krl.layer_start, program.index, &self.program);
            self.skippable(&mut text, self.values.last_number(), &lines);
        }
        let mut forms = self.forms();
        for i in 0..moves.len() {
            match (moves[i], &mut forms) {
                (_, Some(forms)) => self.with_forms(&mut text, forms, moves, i),
                (instruction, None) => self.instruction(&mut text, instruction),
            }
        }
        if last {
            self.skippable(&mut text, self.values.last_number(), &self.krl.hooks.layer_end);
        }
        text.push_str("END\r\n");
        let data = forms.map(|forms| Chunk {
            file: format!("{module}.dat"),
            text: format!(
                "&ACCESS RVP\r\n&REL 1\r\n&COMMENT {}\r\nDEFDAT {module}\r\n{}ENDDAT\r\n",
                self.comment,
                forms.declarations()
            ),
        });
        let main = Chunk { file: format!("{}.src", self.main), text: format!("{module}( )\r\n") };
        [main, Chunk { file: format!("{module}.src"), text }].into_iter().chain(data).collect()
    }

    fn head(&self, module: &str) -> String {
        format!("&ACCESS RVP\r\n&REL 1\r\n&COMMENT {}\r\nDEF {module}( )\r\n", self.comment)
    }

    fn lines(&self, text: &mut String, template: &[String]) {
        for line in self.values.expand(template) {
            text.push_str(&line);
            text.push_str("\r\n");
        }
    }

    /// Lines that a program begun later than `number` leaves out.
    fn skippable(&self, text: &mut String, number: usize, lines: &[String]) {
        if lines.is_empty() {
            return;
        }
        self.begin_skippable(text, number);
        self.lines(text, lines);
        self.end_skippable(text);
    }

    fn begin_skippable(&self, text: &mut String, number: usize) {
        if self.program.restart {
            text.push_str(&format!("IF {}_START <= {number} THEN\r\n", self.main));
        }
    }

    fn end_skippable(&self, text: &mut String) {
        if self.program.restart {
            text.push_str("ENDIF\r\n");
        }
    }

    /// Begins a pass, to which the torch comes from anywhere where the program begins at it.
    fn pass_start(&mut self, text: &mut String, pass: usize, above: DVec3) {
        let number = self.values.set_pass(pass);
        self.begin_skippable(text, number);
        if self.program.restart {
            let variable = format!("{}_START", self.main);
            text.push_str(&format!("IF {variable} > 0 THEN\r\n"));
            self.instruction(text, Instruction::Approach { to: above });
            text.push_str(&format!("{variable} = 0\r\nENDIF\r\n"));
            self.speed = 0.0;
        }
        self.lines(text, &self.krl.hooks.pass_start);
    }

    /// Torch and table stand from here on as an instruction says.
    fn stand(&mut self, instruction: &Instruction) {
        if let Some(attitude) = instruction.attitude() {
            self.orientation = orientation::zyx(self.krl.orientation, Turn::Attitude(attitude));
            self.table = attitude.table.or(self.table);
        }
    }

    fn set_speed(&mut self, text: &mut String, speed: f64) {
        if speed != self.speed {
            self.speed = speed;
            text.push_str("$VEL.CP = ");
            push_fixed(text, speed / 1000.0, 6);
            text.push_str("\r\n");
        }
    }

    fn forms(&self) -> Option<Forms> {
        let arctech = self.krl.arctech.as_ref().filter(|_| self.krl.arc == KrlArc::Arctech)?;
        Some(Forms::new(arctech, &self.krl, &self.process, self.weave.as_ref(), self.travel_speed))
    }

    /// Writes one instruction of a layer when ArcTech forms switch the arc; a form includes the move to its point.
    fn with_forms(&mut self, text: &mut String, forms: &mut Forms, all: &[Instruction], i: usize) {
        self.stand(&all[i]);
        match all[i] {
            // ARCON itself moves there.
            Instruction::Travel { .. } if matches!(all.get(i + 1), Some(Instruction::ArcOn { .. })) => {}
            Instruction::ArcOn { pass, kind } => {
                text.push_str(&format!("; pass {pass} {}\r\n", kind.name()));
                if let Some(to) = i.checked_sub(1).and_then(|before| all[before].target()) {
                    let speed = all[i..].iter().find_map(|next| match next {
                        Instruction::Weld { speed, last: true, .. } => Some(*speed),
                        _ => None,
                    });
                    forms.on(text, &self.aggregate(to), speed.unwrap_or(self.process.deposition_speed));
                }
                // A form leaves its own speed behind.
                self.speed = 0.0;
            }
            Instruction::Weld { to, circle, last: true, .. } => {
                let (via, to) = (circle.map(|c| self.aggregate(c.via)), self.aggregate(to));
                forms.off(text, Target { via: via.as_deref(), to: &to });
            }
            Instruction::ArcOff { .. } => self.speed = 0.0,
            other => self.instruction(text, other),
        }
    }

    fn aggregate(&self, to: DVec3) -> String {
        let mut text = String::new();
        self.pose(&mut text, to);
        text
    }

    /// Whether the pieces of passes are spline motions.
    fn splines(&self) -> bool {
        self.krl.motion == KrlMotion::Slin
    }

    fn lin(&self, text: &mut String, to: DVec3, blend: bool) {
        text.push_str(if self.splines() { "SLIN " } else { "LIN " });
        self.pose(text, to);
        self.end_move(text, blend);
    }

    /// `via` lies on the arc, less than half a turn from start and end.
    fn circ(&self, text: &mut String, via: DVec3, to: DVec3, blend: bool) {
        text.push_str(if self.splines() { "SCIRC " } else { "CIRC " });
        self.pose(text, via);
        text.push(',');
        self.pose(text, to);
        self.end_move(text, blend);
    }

    fn end_move(&self, text: &mut String, blend: bool) {
        let word = if self.splines() { " C_SPL" } else { " C_DIS" };
        text.push_str(if blend && self.krl.blend > 0.0 { word } else { "" });
        text.push_str("\r\n");
    }

    fn pose(&self, text: &mut String, to: DVec3) {
        text.push_str("{X ");
        push_fixed(text, to.x, 3);
        text.push_str(",Y ");
        push_fixed(text, to.y, 3);
        text.push_str(",Z ");
        push_fixed(text, to.z, 3);
        for (axis, angle) in [",A ", ",B ", ",C "].into_iter().zip(self.orientation) {
            text.push_str(axis);
            push_fixed(text, angle, 4);
        }
        let external = [self.program.linear_axis, self.table].into_iter().flatten();
        for (axis, value) in [",E1 ", ",E2 "].into_iter().zip(external) {
            text.push_str(axis);
            push_fixed(text, value, 4);
        }
        text.push('}');
    }

    fn instruction(&mut self, text: &mut String, instruction: Instruction) {
        self.stand(&instruction);
        match instruction {
            Instruction::Approach { to } => {
                text.push_str("PTP ");
                self.pose(text, to);
                self.end_move(text, false);
            }
            Instruction::Travel { to } | Instruction::Retract { to } => {
                self.set_speed(text, self.travel_speed);
                self.lin(text, to, false);
            }
            Instruction::ArcOn { pass, kind } => {
                text.push_str(&format!("; pass {pass} {}\r\n", kind.name()));
                self.lines(text, &self.krl.arc_on);
                self.lines(text, &self.krl.hooks.arc_established);
            }
            Instruction::Weld { to, circle, speed, last, .. } => {
                self.set_speed(text, speed);
                match circle {
                    Some(circle) => self.circ(text, circle.via, to, !last),
                    None => self.lin(text, to, !last),
                }
            }
            Instruction::WireFeed { ratio } => {
                self.values.set_wire_feed(ratio, self.process.wire_feed_speed);
                self.lines(text, &self.krl.wire_feed);
            }
            Instruction::Crater { seconds, ratio } => {
                if let Some(ratio) = ratio {
                    self.values.set_wire_feed(ratio, self.process.wire_feed_speed);
                    self.lines(text, crater_lines(&self.krl.crater, &self.krl.wire_feed));
                }
                wait(text, seconds);
            }
            Instruction::Dwell { seconds } => wait(text, seconds),
            Instruction::ArcOff { .. } => {
                self.lines(text, &self.krl.hooks.before_arc_off);
                self.lines(text, &self.krl.arc_off);
            }
            Instruction::PassStart { pass, above, .. } => self.pass_start(text, pass, above),
            Instruction::PassEnd => {
                self.lines(text, &self.krl.hooks.pass_end);
                self.end_skippable(text);
            }
        }
    }
}

impl KukaKrl {
    /// The head of a volume's main program, and its data.
    fn begin_volume(&mut self) -> Vec<Chunk> {
        self.main = self.volumes.begin(&self.name);
        let (name, krl) = (&self.main, &self.krl);
        let data = format!(
            "&ACCESS RVP\r\n&REL 1\r\n&COMMENT {}\r\nDEFDAT {name}{}\r\nDECL E6AXIS XHOME={{{}}}\r\n{}ENDDAT\r\n",
            self.comment,
            if self.program.restart || self.program.layer_offsets { " PUBLIC" } else { "" },
            krl.home,
            self.start_variable() + &if self.program.layer_offsets { self.offsets() } else { String::new() }
        );
        let mut text = self.head(name);
        self.supplies.iter().for_each(|line| text.push_str(&format!("; {line}\r\n")));
        text.push_str(";FOLD INI;%{PE}\r\n  GLOBAL INTERRUPT DECL 3 WHEN $STOPMESS==TRUE DO IR_STOPM( )\r\n");
        text.push_str("  INTERRUPT ON 3\r\n  BAS(#INITMOV,0)\r\n;ENDFOLD (INI)\r\n");
        text.push_str(&format!("$TOOL = TOOL_DATA[{}]\r\n$BASE = BASE_DATA[{}]\r\n", krl.tool, krl.base));
        text.push_str(&format!("BAS(#VEL_PTP,{})\r\n", fixed(krl.ptp_speed, 0)));
        text.push_str(&format!("$APO.CDIS = {}\r\n", fixed(krl.blend, 3)));
        text.push_str(&format!("$VEL.CP = {}\r\n", fixed(self.travel_speed / 1000.0, 6)));
        self.lines(&mut text, &self.krl.start);
        text.push_str("PTP XHOME\r\n");
        vec![Chunk::new(format!("{name}.dat"), data), Chunk::new(format!("{name}.src"), text)]
    }

    /// The heights to be added to the layers.
    fn offsets(&self) -> String {
        let main = &self.main;
        let mut text = format!("; mm to be added to the height of each layer\r\nDECL GLOBAL REAL {main}_DZ[{}]\r\n", self.layers);
        (1..=self.layers).for_each(|layer| text.push_str(&format!("{main}_DZ[{layer}]=0.0\r\n")));
        text + &format!("DECL GLOBAL FRAME {main}_SHIFT={{X 0.0,Y 0.0,Z 0.0,A 0.0,B 0.0,C 0.0}}\r\n")
    }

    /// The declaration of where to begin.
    fn start_variable(&self) -> String {
        let variable = format!("{}_START", self.main);
        let declaration = || format!("; {}\r\nDECL GLOBAL INT {variable}=0\r\n", restart::comment(&variable));
        self.program.restart.then(declaration).unwrap_or_default()
    }

    fn end_volume(&self) -> Vec<Chunk> {
        let mut text = String::new();
        self.lines(&mut text, &self.krl.end);
        text.push_str("PTP XHOME\r\nEND\r\n");
        self.lines(&mut text, &self.krl.routines);
        vec![Chunk::new(format!("{}.src", self.main), text)]
    }

    /// The modules of a layer, and their calls.
    fn modules(&mut self, program: &LayerProgram) -> Vec<Chunk> {
        let parts = split::passes(&program.instructions, self.krl.max_points);
        let count = parts.len();
        let module = |(part, moves)| self.module(program, part, part + 1 == count, moves);
        parts.into_iter().enumerate().flat_map(module).collect()
    }
}

impl Writer for KukaKrl {
    fn begin(&mut self, layers: usize) -> Vec<Chunk> {
        self.digits = layers.to_string().len().max(3);
        self.values.set("layers", layers);
        self.layers = layers;
        // Room for "_L" and the number, and for that of a part.
        self.name.truncate(MAX_NAME - 2 - self.digits - PART);
        self.begin_volume()
    }

    fn layer(&mut self, program: &LayerProgram) -> Vec<Chunk> {
        if program.instructions.is_empty() {
            return Vec::new();
        }
        self.values.set_layer(program);
        let mut chunks = self.modules(program);
        if !self.volumes.has_room(size(&chunks)) {
            let before = self.end_volume();
            chunks = [before, self.begin_volume()].concat();
            let instructions = from_anywhere(&program.instructions);
            let first = self.modules(&LayerProgram { instructions, ..program.clone() });
            self.volumes.add(size(&first));
            chunks.extend(first);
            return chunks;
        }
        self.volumes.add(size(&chunks));
        chunks
    }

    fn end(&mut self) -> Vec<Chunk> {
        self.end_volume()
    }

    fn notes(&self) -> Vec<String> {
        self.volumes.note("KRL", "src").into_iter().collect()
    }
}

/// Bytes of some files.
fn size(chunks: &[Chunk]) -> usize {
    chunks.iter().map(|chunk| chunk.text.len()).sum()
}

fn wait(text: &mut String, seconds: f64) {
    text.push_str(&format!("WAIT SEC {}\r\n", fixed(seconds, 3)));
}
