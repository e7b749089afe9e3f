//! KUKA KRL for KR C4 (KSS 8.x): `NAME.src` calls `NAME_L001.src` and so on, `NAME.dat` holds the home position.
//!
//! One module per layer keeps the files small enough for the pendant, and a build can be resumed at any layer. The arc
//! is switched at exact stops only; points inside a pass are blended with `C_DIS`. With `arc = "arctech"` the inline
//! forms of ArcTech Basic switch the arc; their data are in a `.dat` next to each layer's module.

use super::arctech::{Filling, Forms, Seam, Target};
use super::arctech_section::KrlArc;
use super::section::{Krl, KrlMotion};
use crate::dialect::writing::orientation::{self, Turn};
use crate::dialect::writing::volumes::{Volumes, from_anywhere};
use crate::dialect::writing::{Chunk, Job, Values, Writer, crater_lines, restart, split, upper_name};
use crate::number::{fixed, push_fixed};
use crate::program::{Circle, Instruction, LayerProgram, ProgramSettings, Weave};
use bead_plan::layer::Extent;
use bead_plan::process::Process;
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
    /// Angle of the turn table, °.
    table: Option<f64>,
    /// A, B, C of the torch, °.
    orientation: [f64; 3],
    /// The wire feed as a multiple of the nominal one.
    feed: f64,
    /// Index of the layer.
    layer: usize,
    digits: usize,
    layers: usize,
    /// Speed set last in the module, mm/s.
    speed: f64,
    volumes: Volumes,
    /// Name of the main program of the current volume.
    main: String,
}

impl KukaKrl {
    /// Begins the program of a part and names the module after the part.
    pub(super) fn new(job: &Job<'_>, krl: Krl) -> Self {
        let name = upper_name(&job.part);
        let comment = job.comment();
        let values = Values::new(&name, job);
        let (process, travel_speed) = (job.weld.process.clone(), job.weld.travel.speed);
        let table = job.program.table_angle.or(job.program.table_side.map(|_| 0.0));
        let orientation = krl.orientation;
        let (volumes, main) = (Volumes::new(krl.max_megabytes), String::new());
        let (supplies, program, weave) = (job.supplies(MAX_COMMENT), job.program.clone(), job.weave.cloned());
        Self {
            name,
            comment,
            supplies,
            krl,
            program,
            weave,
            process,
            values,
            travel_speed,
            table,
            orientation,
            feed: 1.0,
            layer: 0,
            digits: 3,
            layers: 0,
            speed: 0.0,
            volumes,
            main,
        }
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
            let main = &self.main;
            text.push_str(&format!("{main}_SHIFT.Z = {main}_DZ[{}]\r\n", program.index + 1));
            text.push_str(&format!("$BASE = {}\r\n", self.base(&format!(":{main}_SHIFT"))));
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

    /// The part's frame, turned with the table where there is one, and moved by what is written after it.
    fn base(&self, moved: &str) -> String {
        let data = format!("BASE_DATA[{}]{moved}", self.krl.base);
        match self.krl.table_machine.filter(|_| self.table.is_some()) {
            Some(n) => format!("EK(MACHINE_DEF[{n}].ROOT,MACHINE_DEF[{n}].MECH_TYPE,{data})"),
            None => data,
        }
    }

    /// The axes other than the robot's with their numbers: the linear axis (mm) and the turn table (°).
    fn external(&self, table: Option<f64>) -> impl Iterator<Item = (u32, f64)> + use<> {
        let linear = self.program.linear_axis.map(|place| (1, place));
        let free = if linear.is_some() { 2 } else { 1 };
        let table = table.map(|angle| (self.krl.table_axis.unwrap_or(free), angle));
        linear.into_iter().chain(table)
    }

    /// Begins a pass: a program that begins at it comes from anywhere, others by the moves that follow.
    fn pass_start(&mut self, text: &mut String, pass: usize, above: DVec3) {
        let number = self.values.set_pass(pass);
        self.begin_skippable(text, number);
        if self.program.restart {
            let variable = format!("{}_START", self.main);
            text.push_str(&format!("IF {variable} > 0 THEN\r\n"));
            self.instruction(text, Instruction::Approach { to: above });
            text.push_str(&format!("{variable} = 0\r\nELSE\r\n"));
        }
    }

    /// The torch is above the start of the pass, whichever way it came.
    fn above(&mut self, text: &mut String) {
        if self.program.restart {
            text.push_str("ENDIF\r\n");
            self.speed = 0.0;
        }
        self.lines(text, &self.krl.hooks.pass_start);
    }

    /// Sets the attitude of torch and table from here on, as an instruction says.
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
        let target = |krl: &Self, circle: Option<Circle>, to| (circle.map(|c| krl.aggregate(c.via)), krl.aggregate(to));
        match all[i] {
            // ARCON itself moves there.
            Instruction::Travel { .. } if matches!(all.get(i + 1), Some(Instruction::ArcOn { .. })) => {}
            Instruction::ArcOn { pass, kind } => {
                text.push_str(&format!("; pass {pass} {}\r\n", kind.name()));
                if let Some(to) = i.checked_sub(1).and_then(|before| all[before].target()) {
                    forms.on(text, &self.aggregate(to), self.seam(&all[i..]));
                }
                // A form leaves its own speed set.
                self.speed = 0.0;
            }
            Instruction::Weld { to, circle, last: true, .. } => {
                let (via, to) = target(self, circle, to);
                let filling = match all.get(i + 1) {
                    Some(&Instruction::Crater { seconds, ratio }) => Some(Filling { seconds, feed: ratio }),
                    _ => None,
                };
                forms.off(text, Target { via: via.as_deref(), to: &to }, filling, self.job());
            }
            Instruction::Weld { to, circle, .. } if matches!(all.get(i + 1), Some(Instruction::WireFeed { .. })) => {
                if let Some(&Instruction::WireFeed { ratio }) = all.get(i + 1) {
                    self.feed = ratio;
                }
                let (via, to) = target(self, circle, to);
                forms.switch(text, Target { via: via.as_deref(), to: &to }, self.seam(&all[i + 1..]));
                self.speed = 0.0;
            }
            Instruction::WireFeed { ratio } => self.feed = ratio,
            // ARCOFF fills it.
            Instruction::Crater { .. } => {}
            Instruction::ArcOff { .. } => self.speed = 0.0,
            other => self.instruction(text, other),
        }
    }

    /// What is welded from the beginning of these instructions on; ARCOFF moves at the speed that the last form has set.
    fn seam(&self, all: &[Instruction]) -> Seam {
        let ends = |i: &Instruction| matches!(i, Instruction::Weld { last: true, .. } | Instruction::WireFeed { .. });
        let until = all.iter().skip(1).position(ends).map_or(all.len(), |at| at + 2);
        let speed = all[..until].iter().rev().find_map(|next| match next {
            Instruction::Weld { speed, .. } => Some(*speed),
            _ => None,
        });
        Seam { speed: speed.unwrap_or(self.process.deposition_speed), feed: self.feed, job: self.job() }
    }

    /// Job of the power source in the current layer.
    fn job(&self) -> u32 {
        self.process.at_layer(self.layer).job
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
        for (number, value) in self.external(self.table) {
            text.push_str(",E");
            text.push_str(&number.to_string());
            text.push(' ');
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
            Instruction::Above => self.above(text),
            Instruction::Turn { .. } => {}
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
        self.values.set("program", &self.main);
        let (name, krl) = (&self.main, &self.krl);
        let data = format!(
            "&ACCESS RVP\r\n&REL 1\r\n&COMMENT {}\r\nDEFDAT {name}{}\r\nDECL E6AXIS XHOME={{{}}}\r\n{}ENDDAT\r\n",
            self.comment,
            if self.program.restart || self.program.layer_offsets { " PUBLIC" } else { "" },
            self.home(),
            self.start_variable() + &if self.program.layer_offsets { self.offsets() } else { String::new() }
        );
        let mut text = self.head(name);
        self.supplies.iter().for_each(|line| text.push_str(&format!("; {line}\r\n")));
        text.push_str(";FOLD INI;%{PE}\r\n  GLOBAL INTERRUPT DECL 3 WHEN $STOPMESS==TRUE DO IR_STOPM( )\r\n");
        text.push_str("  INTERRUPT ON 3\r\n  BAS(#INITMOV,0)\r\n;ENDFOLD (INI)\r\n");
        text.push_str(&format!("$TOOL = TOOL_DATA[{}]\r\n$BASE = {}\r\n", krl.tool, self.base("")));
        // The torch is held in the part's frame, along arcs too.
        text.push_str("$ORI_TYPE = #VAR\r\n$CIRC_TYPE = #BASE\r\n");
        text.push_str(&format!("BAS(#VEL_PTP,{})\r\n", fixed(krl.ptp_speed, 0)));
        text.push_str(&format!("$APO.CDIS = {}\r\n", fixed(krl.blend, 3)));
        text.push_str(&format!("$VEL.CP = {}\r\n", fixed(self.travel_speed / 1000.0, 6)));
        self.coupled(&mut text);
        self.lines(&mut text, &self.krl.start);
        self.lines(&mut text, &self.krl.hooks.watch);
        text.push_str("PTP XHOME\r\n");
        let chunks = vec![Chunk::new(format!("{name}.dat"), data), Chunk::new(format!("{name}.src"), text)];
        self.volumes.add_frame(size(&chunks) + size(&self.end_volume()));
        chunks
    }

    /// The axes at home; those other than the robot's are as in the program, a table that turns at 0, unless the profile says
    /// otherwise.
    fn home(&self) -> String {
        let table = self.program.table_angle.or(self.program.table_side.map(|_| 0.0));
        let missing = self.external(table).filter(|(number, _)| !self.krl.home.contains(&format!("E{number} ")));
        let missing: String = missing.map(|(number, value)| format!(",E{number} {}", fixed(value, 4))).collect();
        format!("{}{missing}", self.krl.home)
    }

    /// The forms of ArcTech set the base by its number alone, so the controller itself must couple it to the table.
    fn coupled(&self, text: &mut String) {
        let table = self.krl.table_machine.filter(|_| self.krl.arc == KrlArc::Arctech && self.table.is_some());
        if let Some(machine) = table {
            let base = self.krl.base;
            text.push_str(&format!(
                "; halts where $config.dat does not couple base {base} to machine {machine}\r\n\
                 WHILE MACHINE_FRAME_DAT[{base}].MACH_DEF_INDEX <> {machine}\r\nHALT\r\nENDWHILE\r\n"
            ));
        }
    }

    /// The heights to be added to the layers.
    fn offsets(&self) -> String {
        let main = &self.main;
        let mut text =
            format!("; mm to be added to the height of each layer\r\nDECL GLOBAL REAL {main}_DZ[{}]\r\n", self.layers);
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
        self.lines(&mut text, &self.krl.hooks.all_off);
        self.lines(&mut text, &self.krl.end);
        text.push_str("PTP XHOME\r\nEND\r\n");
        self.lines(&mut text, &self.krl.hooks.watch_routines);
        self.lines(&mut text, &self.krl.routines);
        vec![Chunk::new(format!("{}.src", self.main), text)]
    }

    /// The modules of a layer, and their calls; each that does not fit in the volume begins another.
    fn modules(&mut self, program: &LayerProgram) -> Vec<Chunk> {
        let parts = split::passes(&program.instructions, self.krl.max_points);
        let (count, mut all) = (parts.len(), Vec::new());
        for (part, moves) in parts.into_iter().enumerate() {
            let mut chunks = self.module(program, part, part + 1 == count, moves);
            if !self.volumes.has_room(size(&chunks)) {
                all.extend(self.end_volume());
                all.extend(self.begin_volume());
                chunks = self.module(program, part, part + 1 == count, &from_anywhere(moves));
            }
            self.volumes.add(size(&chunks));
            all.extend(chunks);
        }
        all
    }
}

impl Writer for KukaKrl {
    fn weaves(&self) -> bool {
        self.weave.is_some() && self.krl.arc == KrlArc::Arctech
    }

    fn begin(&mut self, extent: &Extent) -> Vec<Chunk> {
        self.digits = extent.layers.to_string().len().max(3);
        self.values.set("layers", extent.layers);
        self.layers = extent.layers;
        // Room for "_L" and the number, and for that of a part.
        self.name.truncate(MAX_NAME - 2 - self.digits - PART);
        self.begin_volume()
    }

    fn layer(&mut self, program: &LayerProgram) -> Vec<Chunk> {
        if program.instructions.is_empty() {
            return Vec::new();
        }
        self.values.set_layer(program);
        self.layer = program.index;
        self.modules(program)
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
