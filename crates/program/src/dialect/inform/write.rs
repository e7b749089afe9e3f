//! Yaskawa INFORM (DX200, YRC1000): `NAME.jbi` calls `NAME-L001.jbi` and so on, relative jobs in a user frame; a long
//! layer continues in `NAME-L001-2.jbi`.
//!
//! Every move has its own position, and NPOS counts them. Three MOVC make an arc; the first is where the arc
//! begins, so the robot does not move for it. Consecutive MOVC are one chain to the controller, so a MOVL to the shared
//! point separates an arc from the next.

use super::section::{Inform, InformSpeed};
use crate::dialect::writing::orientation::{self, Turn};
use crate::dialect::writing::{Chunk, Job, Values, Writer, ascii, crater_lines, split, upper_name, waits};
use crate::number::fixed;
use crate::program::{Instruction, LayerProgram, ProgramSettings, Weave};
use bead_plan::layer::Extent;
use glam::DVec3;
use std::fmt::Write as _;

/// Comments may have this many characters.
const MAX_COMMENT: usize = 32;

/// Longest wait of one timer, s.
const MAX_WAIT: f64 = 600.0;

/// Room for `-L`, and for the number of a split layer (which short names do without as long as they can).
const SUFFIX: usize = 2;

/// Writes INFORM.
pub(super) struct YaskawaInform {
    name: String,
    comment: String,
    supplies: Vec<String>,
    inform: Inform,
    program: ProgramSettings,
    weave: Option<Weave>,
    values: Values,
    /// Rx, Ry, Rz of the torch, °.
    orientation: [f64; 3],
    travel_speed: f64,
    wire_feed_speed: f64,
    digits: usize,
    /// Instructions of the main job so far.
    main: String,
    at: DVec3,
    /// Whether the last move was along an arc.
    in_arc: bool,
    /// Label after the current pass.
    skip: Option<usize>,
    /// Label after the moves from the previous pass.
    way: Option<usize>,
}

/// Positions and instructions of one job.
#[derive(Default)]
struct JobText {
    positions: String,
    count: usize,
    instructions: String,
    labels: usize,
}

impl JobText {
    /// Number of a new label.
    fn label(&mut self) -> usize {
        self.labels += 1;
        self.labels
    }

    fn line(&mut self, text: &str) {
        self.instructions.push_str(text);
        self.instructions.push_str("\r\n");
    }
}

impl YaskawaInform {
    /// Begins the program of a part and names the job after the part.
    pub(super) fn new(job: &Job<'_>, inform: Inform) -> Self {
        let name = upper_name(&job.part);
        let values = Values::new(&name, job);
        let travel_speed = job.weld.travel.speed;
        Self {
            name,
            comment: ascii(&job.part),
            supplies: job.supplies(MAX_COMMENT),
            orientation: inform.orientation,
            inform,
            program: job.program.clone(),
            weave: job.weave(),
            values,
            travel_speed,
            wire_feed_speed: job.weld.process.wire_feed_speed,
            digits: 3,
            main: String::new(),
            at: DVec3::ZERO,
            in_arc: false,
            skip: None,
            way: None,
        }
    }

    fn lines(&self, text: &mut String, template: &[String]) {
        for line in self.values.expand(template) {
            text.push_str(&line);
            text.push_str("\r\n");
        }
    }

    /// Begins what a program begun later than `number` leaves out; returns the label where it continues.
    fn begin_skippable(&self, job: &mut JobText, number: usize) -> Option<usize> {
        let label = self.program.restart.then(|| job.label())?;
        job.line(&format!("JUMP *L{label} IF D{:03}>{number}", self.inform.restart_variable));
        Some(label)
    }

    /// Lines that a program begun later than `number` leaves out.
    fn skippable(&self, job: &mut JobText, number: usize, lines: &[String]) {
        if lines.is_empty() {
            return;
        }
        let label = self.begin_skippable(job, number);
        self.lines(&mut job.instructions, lines);
        label.into_iter().for_each(|label| job.line(&format!("*L{label}")));
    }

    /// Begins a pass: a program that begins at it comes from anywhere, others by the moves that follow.
    fn pass_start(&mut self, job: &mut JobText, pass: usize, above: DVec3) {
        let number = self.values.set_pass(pass);
        self.skip = self.begin_skippable(job, number);
        if self.program.restart {
            let (variable, label, behind) = (self.inform.restart_variable, job.label(), job.label());
            job.line(&format!("JUMP *L{label} IF D{variable:03}=0"));
            self.instruction(job, Instruction::Approach { to: above });
            job.line(&format!("SET D{variable:03} 0"));
            job.line(&format!("JUMP *L{behind}"));
            job.line(&format!("*L{label}"));
            self.way = Some(behind);
        }
    }

    /// The torch is above the start of the pass, whichever way it came.
    fn above(&mut self, job: &mut JobText) {
        self.way.take().into_iter().for_each(|label| job.line(&format!("*L{label}")));
        self.lines(&mut job.instructions, &self.inform.hooks.pass_start);
    }

    /// The height to be added to a layer, which is set in its job, µm; all moves up to SFTOF are shifted by it.
    fn offset(&self, job: &mut JobText) {
        if self.program.layer_offsets {
            let (variable, frame) = (self.inform.offset_variable, self.inform.user_frame);
            job.line("'UM ADDED TO THIS LAYER");
            job.line(&format!("SUB P{variable:03} P{variable:03}"));
            job.line(&format!("SETE P{variable:03} (3) 0"));
            job.line(&format!("SFTON P{variable:03} UF#({frame})"));
        }
    }

    fn offset_end(&self, job: &mut JobText) {
        if self.program.layer_offsets {
            job.line("SFTOF");
        }
    }

    /// Adds a position in the user frame and returns its name.
    fn pose(&self, job: &mut JobText, to: DVec3) -> String {
        let name = format!("C{:05}", job.count);
        let [x, y, z] = to.to_array().map(|v| fixed(v, 3));
        let [rx, ry, rz] = self.orientation.map(|v| fixed(v, 4));
        let _ = write!(job.positions, "{name}={x},{y},{z},{rx},{ry},{rz}\r\n");
        job.count += 1;
        name
    }

    fn speed(&self, speed: f64) -> String {
        let (value, least) = match self.inform.speed {
            InformSpeed::MillimetresPerSecond => (speed.min(1500.0), 0.1),
            InformSpeed::CentimetresPerMinute => (speed.min(1500.0) * 6.0, 1.0),
        };
        format!("V={}", fixed(value.max(least), 1))
    }

    fn motion(&mut self, job: &mut JobText, word: &str, to: DVec3, speed: f64, level: u32) {
        let pose = self.pose(job, to);
        job.line(&format!("{word} {pose} {} PL={level}", self.speed(speed)));
        (self.at, self.in_arc) = (to, word == "MOVC");
    }

    fn instruction(&mut self, job: &mut JobText, instruction: Instruction) {
        if let Some(attitude) = instruction.attitude() {
            self.orientation = orientation::xyz(self.inform.orientation, Turn::Attitude(attitude));
        }
        match instruction {
            Instruction::Approach { to } => {
                let pose = self.pose(job, to);
                job.line(&format!("MOVJ {pose} VJ={} PL=0", fixed(self.inform.home_speed, 2)));
                (self.at, self.in_arc) = (to, false);
            }
            Instruction::Travel { to } | Instruction::Retract { to } => {
                self.motion(job, "MOVL", to, self.travel_speed, 0);
            }
            Instruction::ArcOn { pass, kind } => {
                job.line(&format!("'PASS {pass} {}", kind.name().to_uppercase()));
                self.lines(&mut job.instructions, &self.inform.arc_on);
                self.lines(&mut job.instructions, &self.inform.hooks.arc_established);
                self.weave.iter().for_each(|weave| job.line(&format!("WVON WEV#({})", weave.file)));
            }
            Instruction::Weld { to, circle, speed, last, .. } => {
                let level = if last { 0 } else { self.inform.position_level };
                let Some(circle) = circle else { return self.motion(job, "MOVL", to, speed, level) };
                if self.in_arc {
                    self.motion(job, "MOVL", self.at, speed, self.inform.position_level);
                }
                for (to, level) in
                    [(self.at, self.inform.position_level), (circle.via, self.inform.position_level), (to, level)]
                {
                    self.motion(job, "MOVC", to, speed, level);
                }
            }
            Instruction::WireFeed { ratio } => {
                self.values.set_wire_feed(ratio, self.wire_feed_speed);
                self.lines(&mut job.instructions, &self.inform.wire_feed);
            }
            Instruction::Crater { seconds, ratio } => {
                if let Some(ratio) = ratio {
                    self.values.set_wire_feed(ratio, self.wire_feed_speed);
                    self.lines(&mut job.instructions, crater_lines(&self.inform.crater, &self.inform.wire_feed));
                }
                wait(job, seconds);
            }
            Instruction::Dwell { seconds } => wait(job, seconds),
            Instruction::ArcOff { .. } => {
                self.weave.iter().for_each(|_| job.line("WVOF"));
                self.lines(&mut job.instructions, &self.inform.hooks.before_arc_off);
                self.lines(&mut job.instructions, &self.inform.arc_off);
            }
            Instruction::PassStart { pass, above, .. } => self.pass_start(job, pass, above),
            Instruction::Above => self.above(job),
            Instruction::Turn { .. } => {}
            Instruction::PassEnd => {
                self.lines(&mut job.instructions, &self.inform.hooks.pass_end);
                self.skip.take().into_iter().for_each(|label| job.line(&format!("*L{label}")));
            }
        }
    }

    /// A job in the user frame.
    fn relative(&self, name: &str, comment: &str, job: &JobText) -> Chunk {
        let Inform { user_frame, tool, configuration, .. } = &self.inform;
        let head = format!(
            "///USER {user_frame}\r\n///TOOL {tool}\r\n///POSTYPE USER\r\n///RECTAN\r\n///RCONF {configuration}\r\n"
        );
        let attributes = format!("SC,RW,RJ\r\n////FRAME USER {user_frame}");
        self.file(name, comment, &head, &attributes, job)
    }

    fn file(&self, name: &str, comment: &str, head: &str, attributes: &str, job: &JobText) -> Chunk {
        let comment = &comment[..comment.len().min(MAX_COMMENT)];
        let text = format!(
            "/JOB\r\n//NAME {name}\r\n//POS\r\n///NPOS {},0,0,0,0,0\r\n{head}{}//INST\r\n///DATE {}\r\n\
             ///COMM {comment}\r\n///ATTR {attributes}\r\n///GROUP1 {}\r\nNOP\r\n{}END\r\n",
            job.count, job.positions, self.inform.date, self.inform.group, job.instructions
        );
        Chunk { file: format!("{name}.jbi"), text }
    }
}

fn wait(job: &mut JobText, seconds: f64) {
    waits(seconds, MAX_WAIT).for_each(|s| job.line(&format!("TIMER T={}", fixed(s, 2))));
}

impl Writer for YaskawaInform {
    fn weaves(&self) -> bool {
        self.weave.is_some()
    }

    fn begin(&mut self, extent: &Extent) -> Vec<Chunk> {
        self.digits = extent.layers.to_string().len().max(3);
        // Where names may be longer, those of split layers fit too: "-L001-2".
        let more = if self.inform.max_name > 16 { 4 } else { 2 };
        self.name.truncate((self.inform.max_name - SUFFIX - self.digits).saturating_sub(more).max(1));
        self.values.set("layers", extent.layers);
        let mut main = String::new();
        self.supplies.iter().for_each(|line| main.push_str(&format!("'{line}\r\n")));
        if self.program.restart {
            let variable = self.inform.restart_variable;
            main.push_str(&format!("'0, OR LAYER*10000+PASS\r\nSET D{variable:03} 0\r\n"));
        }
        self.lines(&mut main, &self.inform.start);
        self.lines(&mut main, &self.inform.hooks.watch);
        self.main = main;
        Vec::new()
    }

    fn layer(&mut self, layer: &LayerProgram) -> Vec<Chunk> {
        if layer.instructions.is_empty() {
            return Vec::new();
        }
        self.values.set_layer(layer);
        let mut chunks = Vec::new();
        let parts = split::passes(&layer.instructions, self.inform.max_points);
        let count = parts.len();
        for (i, part) in parts.into_iter().enumerate() {
            let more = if i == 0 { String::new() } else { format!("-{}", i + 1) };
            let name = format!("{}-L{:0digits$}{more}", self.name, layer.index + 1, digits = self.digits);
            let mut job = JobText::default();
            self.offset(&mut job);
            if i == 0 {
                let lines = self.inform.hooks.before_layer(&self.inform.layer_start, layer.index, &self.program);
                self.skippable(&mut job, self.values.last_number(), &lines);
            }
            part.iter().for_each(|&instruction| self.instruction(&mut job, instruction));
            if i + 1 == count {
                self.skippable(&mut job, self.values.last_number(), &self.inform.hooks.layer_end);
            }
            self.offset_end(&mut job);
            self.main.push_str(&format!("CALL JOB:{name}\r\n"));
            chunks.push(self.relative(&name, &format!("LAYER {} Z {}", layer.index + 1, fixed(layer.z, 3)), &job));
        }
        chunks
    }

    fn end(&mut self) -> Vec<Chunk> {
        let pulses = self.inform.home.map(|pulse| pulse.to_string()).join(",");
        let go = |number: usize| format!("MOVJ C{number:05} VJ={}\r\n", fixed(self.inform.home_speed, 2));
        let mut instructions = go(0) + &self.main;
        self.lines(&mut instructions, &self.inform.hooks.all_off);
        self.lines(&mut instructions, &self.inform.end);
        instructions.push_str(&go(1));
        let positions = format!("C00000={pulses}\r\nC00001={pulses}\r\n");
        let main = JobText { positions, count: 2, instructions, labels: 0 };
        let head = format!("///TOOL {}\r\n///POSTYPE PULSE\r\n///PULSE\r\n", self.inform.tool);
        vec![self.file(&self.name, &self.comment, &head, "SC,RW", &main)]
    }
}
