//! Writes KUKA KRL for KR C4 (KSS 8.x): `NAME.src` calls `NAME_L001.src` and so on; `NAME.dat` holds the home position.
//!
//! One module per layer keeps the files small enough for the pendant, and a build can be resumed at any layer. The arc
//! is switched at exact stops only; points inside a pass are blended with `C_DIS`. With `arc = "arctech"` the inline
//! forms of ArcTech Basic switch the arc; their data are in a `.dat` next to each layer's module.

use super::arctech::{Filling, Forms, Seam, Target};
use super::arctech_section::KrlArc;
use super::section::{Krl, KrlMotion};
use crate::dialect::writing::frame::{self, Frame, Part, Piece, SUFFIX, Skippable, Syntax};
use crate::dialect::writing::orientation::{self, Turn};
use crate::dialect::writing::volumes::Volumes;
use crate::dialect::writing::{Chunk, Job, restart, upper_name};
use crate::number::{fixed, push_fixed};
use crate::program::{Attitude, Circle, Instruction, Weave};
use bead_plan::pass::PassKind;
use glam::DVec3;

/// Most characters of a module name.
const MAX_NAME: usize = 24;

/// Comments are wrapped at this many characters.
const MAX_COMMENT: usize = 76;

/// Writes KRL.
pub(super) struct KukaKrl {
    frame: Frame,
    krl: Krl,
    weave: Option<Weave>,
    /// Angles of the axes that turn the part, °.
    table: Option<[f64; 2]>,
    /// A, B, C of the torch, °.
    orientation: [f64; 3],
    /// Speed last set in the module, mm/s.
    speed: f64,
    /// The module's forms, if ArcTech switches the arc.
    forms: Option<Forms>,
}

impl KukaKrl {
    /// Begins the program of a part and names the module after the part.
    pub(super) fn new(job: &Job<'_>, mut krl: Krl) -> Self {
        // Where `[start_stop]` fills craters, it says so for all of them.
        if let Some(arctech) = krl.arctech.as_mut().filter(|_| job.weld.ends.fills_craters()) {
            arctech.crater.time = 0.0;
        }
        let volumes = Some(Volumes::new(krl.max_megabytes, "KRL", "src"));
        let frame = Frame { volumes, ..Frame::new(job, upper_name(&job.part), MAX_COMMENT, &krl) };
        let table = job.program.first_angles();
        let orientation = krl.orientation;
        Self { frame, krl, weave: job.weave.cloned(), table, orientation, speed: 0.0, forms: None }
    }

    fn head(&self, module: &str) -> String {
        format!("&ACCESS RVP\r\n&REL 1\r\n&COMMENT {}\r\nDEF {module}( )\r\n", self.frame.comment)
    }

    /// Data of a module: its declarations.
    fn data(&self, module: &str, public: bool, declarations: &str) -> Chunk {
        let (comment, public) = (&self.frame.comment, if public { " PUBLIC" } else { "" });
        let head = format!("&ACCESS RVP\r\n&REL 1\r\n&COMMENT {comment}\r\nDEFDAT {module}{public}\r\n");
        Chunk::new(format!("{module}.dat"), format!("{head}{declarations}ENDDAT\r\n"))
    }

    /// The part's frame, turned with the table if there is one, followed by the frame operator `moved`.
    fn base(&self, moved: &str) -> String {
        let data = format!("BASE_DATA[{}]{moved}", self.krl.base);
        match self.krl.table_machine.filter(|_| self.table.is_some()) {
            Some(n) => format!("EK(MACHINE_DEF[{n}].ROOT,MACHINE_DEF[{n}].MECH_TYPE,{data})"),
            None => data,
        }
    }

    /// The axes other than the robot's with their numbers: the linear axis (mm) and those that turn the part (°).
    fn external(&self, table: Option<[f64; 2]>) -> impl Iterator<Item = (u32, f64)> + use<> {
        let linear = self.frame.program.linear_axis.map(|place| (1, place));
        let free = if linear.is_some() { 2 } else { 1 };
        let (first, count) = (self.krl.table_axis.unwrap_or(free), self.frame.program.turning_axes());
        let turning = table.into_iter().flatten().take(count);
        linear.into_iter().chain((first..).zip(turning))
    }

    fn set_speed(&mut self, text: &mut String, speed: f64) {
        if speed != self.speed {
            self.speed = speed;
            text.push_str("$VEL.CP = ");
            push_fixed(text, speed / 1000.0, 6);
            text.push_str("\r\n");
        }
    }

    fn new_forms(&self) -> Option<Forms> {
        let arctech = self.krl.arctech.as_ref().filter(|_| self.krl.arc == KrlArc::Arctech)?;
        let weave = self.weave.as_ref().map(|weave| weave.at_layer(self.frame.layer));
        Some(Forms::new(arctech, &self.krl, &self.frame.process, weave.as_ref(), self.frame.travel_speed))
    }

    /// Writes one instruction of a layer by forms, which include the move to their point; false for one without a form.
    fn with_forms(&mut self, text: &mut String, forms: &mut Forms, all: &[Instruction], i: usize) -> bool {
        let target = |krl: &Self, circle: Option<Circle>, to| (circle.map(|c| krl.aggregate(c.via)), krl.aggregate(to));
        match all[i] {
            // ARCON moves there itself.
            Instruction::Travel { .. } if matches!(all.get(i + 1), Some(Instruction::ArcOn { .. })) => {}
            Instruction::ArcOn { pass, kind } => {
                self.pass(text, pass, kind);
                if let Some(to) = i.checked_sub(1).and_then(|before| all[before].target()) {
                    forms.on(text, &self.aggregate(to), self.seam(&all[i..]));
                }
                // A form sets a speed of its own.
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
            Instruction::Weld { to, circle, .. } => {
                let Some(&Instruction::WireFeed { ratio }) = all.get(i + 1) else { return false };
                self.frame.feed = ratio;
                let (via, to) = target(self, circle, to);
                forms.switch(text, Target { via: via.as_deref(), to: &to }, self.seam(&all[i + 1..]));
                self.speed = 0.0;
            }
            // The forms contain the wire feed, and ARCOFF fills the crater.
            Instruction::WireFeed { .. } | Instruction::Crater { .. } => {}
            Instruction::ArcOff { .. } => self.speed = 0.0,
            _ => return false,
        }
        true
    }

    /// Weld parameters at the beginning of these instructions; ARCOFF moves at the speed set by the last form.
    fn seam(&self, all: &[Instruction]) -> Seam {
        let ends = |i: &Instruction| matches!(i, Instruction::Weld { last: true, .. } | Instruction::WireFeed { .. });
        let until = all.iter().skip(1).position(ends).map_or(all.len(), |at| at + 2);
        let speed = all[..until].iter().rev().find_map(|next| match next {
            Instruction::Weld { speed, .. } => Some(*speed),
            _ => None,
        });
        let speed = speed.unwrap_or(self.frame.process.deposition_speed);
        Seam { speed, feed: self.frame.feed, job: self.job() }
    }

    /// Job of the power source in the current layer.
    fn job(&self) -> u32 {
        self.frame.process.at_layer(self.frame.layer).job
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

    /// The axes at home; external axes are as in the program, and those that turn the part at 0, unless the profile
    /// says otherwise.
    fn home(&self) -> String {
        let first = self.frame.program.first_angles();
        let missing = self.external(first).filter(|(number, _)| !self.krl.home.contains(&format!("E{number} ")));
        let missing: String = missing.map(|(number, value)| format!(",E{number} {}", fixed(value, 4))).collect();
        format!("{}{missing}", self.krl.home)
    }

    /// ArcTech's forms set the base by its number alone, so the controller itself must couple the base to the table.
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

    /// The declarations of the pass at which to begin, and of the heights added to the layers.
    fn variables(&self) -> String {
        let Frame { main, program, layers, .. } = &self.frame;
        let mut text = String::new();
        if program.restart {
            let variable = format!("{main}_START");
            text.push_str(&format!("; {}\r\nDECL GLOBAL INT {variable}=0\r\n", restart::comment(&variable)));
        }
        if program.layer_offsets {
            text.push_str("; mm to be added to the height of each layer\r\n");
            text.push_str(&format!("DECL GLOBAL REAL {main}_DZ[{layers}]\r\n"));
            (1..=*layers).for_each(|layer| text.push_str(&format!("{main}_DZ[{layer}]=0.0\r\n")));
            let zero = "{X 0.0,Y 0.0,Z 0.0,A 0.0,B 0.0,C 0.0}";
            text.push_str(&format!("DECL GLOBAL FRAME {main}_SHIFT={zero}\r\n"));
        }
        text
    }
}

impl Syntax for KukaKrl {
    type Text = String;

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
        self.krl.max_points
    }

    fn begin_main(&mut self) -> Vec<Chunk> {
        let name = self.frame.main.clone();
        self.frame.values.set("program", &name);
        let (program, krl) = (&self.frame.program, &self.krl);
        let home = format!("DECL E6AXIS XHOME={{{}}}\r\n", self.home());
        let data = self.data(&name, program.restart || program.layer_offsets, &(home + &self.variables()));
        let mut text = self.head(&name);
        self.frame.supplies.iter().for_each(|line| text.push_str(&format!("; {line}\r\n")));
        text.push_str(";FOLD INI;%{PE}\r\n  GLOBAL INTERRUPT DECL 3 WHEN $STOPMESS==TRUE DO IR_STOPM( )\r\n");
        text.push_str("  INTERRUPT ON 3\r\n  BAS(#INITMOV,0)\r\n;ENDFOLD (INI)\r\n");
        text.push_str(&format!("$TOOL = TOOL_DATA[{}]\r\n$BASE = {}\r\n", krl.tool, self.base("")));
        // The torch keeps its orientation in the part's frame, also along arcs.
        text.push_str("$ORI_TYPE = #VAR\r\n$CIRC_TYPE = #BASE\r\n");
        text.push_str(&format!("BAS(#VEL_PTP,{})\r\n", fixed(krl.ptp_speed, 0)));
        text.push_str(&format!("$APO.CDIS = {}\r\n", fixed(krl.blend, 3)));
        text.push_str(&format!("$VEL.CP = {}\r\n", fixed(self.frame.travel_speed / 1000.0, 6)));
        self.coupled(&mut text);
        frame::start(self, &mut text);
        text.push_str("PTP XHOME\r\n");
        vec![data, Chunk::new(format!("{name}.src"), text)]
    }

    fn end_main(&mut self) -> Vec<Chunk> {
        let mut text = String::new();
        frame::end(self, &mut text);
        text.push_str("PTP XHOME\r\nEND\r\n");
        frame::routines(self, &mut text);
        vec![Chunk::new(format!("{}.src", self.frame.main), text)]
    }

    /// The module and the data of its forms.
    fn part(&mut self, part: &Part, moves: &[Instruction]) -> Vec<Chunk> {
        let (module, layer) = (self.name_of(part), part.layer + 1);
        (self.speed, self.forms) = (0.0, self.new_forms());
        let mut text = self.head(&module);
        text.reserve(moves.len() * 70);
        text.push_str(&format!("; layer {layer}, z {} mm\r\n", fixed(part.z, 3)));
        if self.frame.program.layer_offsets {
            let main = &self.frame.main;
            text.push_str(&format!("{main}_SHIFT.Z = {main}_DZ[{layer}]\r\n"));
            text.push_str(&format!("$BASE = {}\r\n", self.base(&format!(":{main}_SHIFT"))));
        }
        frame::body(self, &mut text, part, moves);
        text.push_str("END\r\n");
        let data = self.forms.take().map(|forms| self.data(&module, false, &forms.declarations()));
        [Chunk::new(format!("{module}.src"), text)].into_iter().chain(data).collect()
    }

    fn call(&mut self, part: &Part) -> Vec<Chunk> {
        vec![Chunk::new(format!("{}.src", self.frame.main), format!("{}( )\r\n", self.name_of(part)))]
    }

    fn line(&mut self, text: &mut String, line: &str) {
        text.push_str(line);
        text.push_str("\r\n");
    }

    fn begin_skippable(&mut self, text: &mut String, what: Skippable) {
        text.push_str(&format!("IF {}_START <= {} THEN\r\n", self.frame.main, what.number()));
    }

    fn end_skippable(&mut self, text: &mut String) {
        text.push_str("ENDIF\r\n");
    }

    fn begin_way(&mut self, text: &mut String, _number: usize, above: DVec3) {
        let variable = format!("{}_START", self.frame.main);
        text.push_str(&format!("IF {variable} > 0 THEN\r\n"));
        self.approach(text, above);
        text.push_str(&format!("{variable} = 0\r\nELSE\r\n"));
    }

    fn end_way(&mut self, text: &mut String) {
        self.end_skippable(text);
        self.speed = 0.0;
    }

    fn stand(&mut self, attitude: Attitude) {
        self.orientation = orientation::zyx(self.krl.orientation, Turn::Attitude(attitude));
        self.table = attitude.held.map(|held| held.angles).or(self.table);
    }

    fn by_package(&mut self, text: &mut String, moves: &[Instruction], at: usize) -> bool {
        let Some(mut forms) = self.forms.take() else { return false };
        let done = self.with_forms(text, &mut forms, moves, at);
        self.forms = Some(forms);
        done
    }

    fn approach(&mut self, text: &mut String, to: DVec3) {
        text.push_str("PTP ");
        self.pose(text, to);
        self.end_move(text, false);
    }

    fn travel(&mut self, text: &mut String, to: DVec3) {
        self.set_speed(text, self.frame.travel_speed);
        self.lin(text, to, false);
    }

    fn pass(&mut self, text: &mut String, pass: usize, kind: PassKind) {
        text.push_str(&format!("; pass {pass} {}\r\n", kind.name()));
    }

    fn weld(&mut self, text: &mut String, piece: Piece, _next: &[Instruction]) {
        self.set_speed(text, piece.speed);
        match piece.circle {
            Some(circle) => self.circ(text, circle.via, piece.to, !piece.last),
            None => self.lin(text, piece.to, !piece.last),
        }
    }

    fn wait(&mut self, text: &mut String, seconds: f64) {
        text.push_str(&format!("WAIT SEC {}\r\n", fixed(seconds, 3)));
    }

    fn weaves(&self) -> bool {
        self.weave.is_some() && self.krl.arc == KrlArc::Arctech
    }
}
