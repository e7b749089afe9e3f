//! CNC G-code, three axes: one file, feeds in mm/min, G0 never with the arc on. Flavours (LinuxCNC, Fanuc, Siemens, TwinCAT) are
//! set by keys and templates in the profile.

use super::control::GcodeControl;
use super::section::{Gcode, GcodeComments};
use crate::dialect::DialectError;
use crate::dialect::writing::{Chunk, Job, Values, Writer, ascii, crater_lines, restart};
use crate::number::push_fixed;
use crate::program::{Circle, Instruction, LayerProgram, ProgramSettings};
use bead_plan::layer::Extent;
use glam::DVec3;

/// Highest block number that a jump finds.
const MAX_LABEL: usize = 99_999;

/// Block numbers start again after this one.
const MAX_BLOCK: usize = 99_990;

/// A comment may have this many characters: blocks stay under 80.
const MAX_COMMENT: usize = 60;

/// Writes G-code.
pub(super) struct CncGcode {
    file: String,
    comment: String,
    supplies: Vec<String>,
    gcode: Gcode,
    program: ProgramSettings,
    values: Values,
    wire_feed_speed: f64,
    block: usize,
    /// Feed written last, mm/s.
    feed: f64,
    /// The wire feed as a multiple of its nominal value.
    feed_ratio: f64,
    /// Wire fed so far, mm.
    wire: f64,
    at: Option<DVec3>,
    /// Whether blocks have numbers.
    numbered: bool,
    /// Labels so far.
    labels: usize,
    /// What ends the branches that are open.
    open: Vec<String>,
}

impl CncGcode {
    /// Begins the program of a part.
    pub(super) fn new(job: &Job<'_>, gcode: Gcode) -> Self {
        let name = gcode.control.map_or_else(|| job.part.clone(), |control| control.file_name(&job.part));
        let file = format!("{name}.{}", gcode.extension);
        let jumps = gcode.control.is_some_and(GcodeControl::jumps_to_numbers) && job.program.restart;
        let numbered = gcode.block_numbers && !jumps;
        let values = Values::new(&ascii(&job.part), job);
        let comment = job.comment();
        let wire_feed_speed = job.weld.process.wire_feed_speed;
        let (supplies, program) = (job.supplies(MAX_COMMENT), job.program.clone());
        Self {
            file,
            comment,
            supplies,
            gcode,
            program,
            values,
            wire_feed_speed,
            block: 0,
            feed: 0.0,
            feed_ratio: 1.0,
            wire: 0.0,
            at: None,
            numbered,
            labels: 0,
            open: Vec::new(),
        }
    }

    fn begin_block(&mut self, text: &mut String) {
        if self.numbered {
            self.block = if self.block >= MAX_BLOCK { 10 } else { self.block + 10 };
            text.push_str(&format!("N{} ", self.block));
        }
    }

    fn comment(&self, text: &mut String, comment: &str) {
        let clean = comment.replace(['(', ')'], "_").replace(';', ",").to_uppercase();
        let clean = &clean[..clean.len().min(MAX_COMMENT)];
        match self.gcode.comments {
            GcodeComments::Parentheses => text.push_str(&format!("({clean})\n")),
            GcodeComments::Semicolon => text.push_str(&format!("; {clean}\n")),
        }
    }

    fn blocks(&mut self, text: &mut String, template: &[String]) {
        let lines: Vec<String> = self.values.expand(template).collect();
        for line in lines {
            // LinuxCNC accepts no number before an O word; parameters are set in the same way.
            if !line.starts_with(['O', '#']) {
                self.begin_block(text);
            }
            text.push_str(&line);
            text.push('\n');
        }
    }

    /// A line that is not a block: an O word, or a jump.
    fn line(&self, text: &mut String, line: &str) {
        text.push_str(line);
        text.push('\n');
    }

    /// The control, where the program can begin at any pass.
    fn restarts(&self) -> Option<GcodeControl> {
        self.gcode.control.filter(|_| self.program.restart)
    }

    fn new_label(&mut self) -> usize {
        self.labels += 1;
        self.labels
    }

    /// Lines that a program begun later than `number` leaves out.
    fn skippable(&mut self, text: &mut String, number: usize, word: usize, lines: &[String]) {
        if lines.is_empty() {
            return;
        }
        self.begin_skippable(text, number, word);
        self.blocks(text, lines);
        self.end_branch(text);
    }

    /// Every O word has a number of its own: that of the pass or layer, and a digit, which is 1 or 2 here; the others are for
    /// the lines of the profile.
    fn begin_skippable(&mut self, text: &mut String, number: usize, word: usize) {
        let Some(control) = self.restarts() else { return };
        let label = self.new_label();
        match (control.jump_if_above(number, label), control.label(label)) {
            (Some(jump), Some(label)) => {
                self.line(text, &jump);
                self.open.push(label);
            }
            _ => {
                let word = number * 10 + word;
                self.line(text, &format!("O{word} if [{} LE {number}]", control.variable()));
                self.open.push(format!("O{word} endif"));
            }
        }
    }

    /// Ends the branch that began last; nothing is known about what it did.
    fn end_branch(&mut self, text: &mut String) {
        if let Some(end) = self.open.pop() {
            self.line(text, &end);
            (self.at, self.feed) = (None, 0.0);
        }
    }

    /// Begins a pass: a program that begins at it comes from anywhere, others by the moves that follow.
    fn pass_start(&mut self, text: &mut String, pass: usize, above: DVec3) {
        let number = self.values.set_pass(pass);
        self.begin_skippable(text, number, 1);
        let Some(control) = self.restarts() else { return };
        let (way, behind) = (self.new_label(), self.new_label());
        let word = number * 10 + 2;
        // What comes between the two branches, and after both.
        let jumps = (control.jump_if_zero(way), control.jump(behind), control.label(way), control.label(behind));
        let (begin, between, end) = match jumps {
            (Some(unless), Some(jump), Some(way), Some(behind)) => (unless, vec![jump, way], behind),
            _ => {
                let begin = format!("O{word} if [{} GT 0]", control.variable());
                (begin, vec![format!("O{word} else")], format!("O{word} endif"))
            }
        };
        let standing = (self.at, self.feed);
        self.line(text, &begin);
        self.approach(text, above);
        self.line(text, &control.reset());
        between.iter().for_each(|line| self.line(text, line));
        (self.at, self.feed) = standing;
        self.open.push(end);
    }

    /// The torch is above the start of the pass, whichever way it came.
    fn above(&mut self, text: &mut String) {
        if self.program.restart {
            self.end_branch(text);
        }
        let lines = self.gcode.hooks.pass_start.clone();
        self.blocks(text, &lines);
    }

    /// A height, mm, that is added to all that follows.
    fn raise(&mut self, text: &mut String, height: &str) {
        if let Some(control) = self.gcode.control.filter(|_| self.program.layer_offsets) {
            self.begin_block(text);
            self.line(text, &control.raise(height));
            // Whether it moves the torch's coordinates is not known here.
            self.at = None;
        }
    }

    fn wait(&mut self, text: &mut String, seconds: f64) {
        self.values.set_dwell(seconds);
        let lines = self.gcode.dwell.clone();
        self.blocks(text, &lines);
    }

    /// A straight move; axes that do not move are left out.
    fn go(&mut self, text: &mut String, word: &str, to: DVec3, feed: Option<f64>) {
        self.motion(text, word, to, None, feed);
    }

    /// The machine may be anywhere at first: to the safe height, across, and down.
    fn approach(&mut self, text: &mut String, to: DVec3) {
        let safe = self.gcode.safe_z.max(to.z);
        self.begin_block(text);
        text.push_str("G0 Z");
        push_fixed(text, safe, self.gcode.decimals);
        text.push('\n');
        self.at = Some(DVec3::new(f64::NAN, f64::NAN, safe));
        self.go(text, "G0", to.with_z(safe), None);
        self.go(text, "G0", to, None);
    }

    fn weld(&mut self, text: &mut String, to: DVec3, circle: Option<Circle>, speed: f64) {
        let word = circle.map_or("G1", |circle| circle.word());
        self.motion(text, word, to, circle, Some(speed));
    }

    fn motion(&mut self, text: &mut String, word: &str, to: DVec3, circle: Option<Circle>, feed: Option<f64>) {
        let moved = [0, 1, 2].map(|axis| self.at.is_none_or(|at| at[axis] != to[axis]));
        if moved == [false; 3] {
            return;
        }
        self.begin_block(text);
        text.push_str(word);
        for axis in (0..3).filter(|&axis| moved[axis]) {
            text.push_str([" X", " Y", " Z"][axis]);
            push_fixed(text, to[axis], self.gcode.decimals);
        }
        if let (Some(circle), Some(at)) = (circle, self.at) {
            push_centre(text, circle.centre - at, self.gcode.decimals);
        }
        if let (Some(speed), Some(at)) = (feed, self.at) {
            self.feed_wire(text, circle.map_or_else(|| at.distance(to), |c| c.length()) / speed);
        }
        if let Some(feed) = feed.filter(|&f| f != self.feed) {
            self.feed = feed;
            text.push_str(" F");
            push_fixed(text, feed * 60.0, 1);
        }
        text.push('\n');
        self.at = Some(to);
    }

    /// Moves the wire axis, if there is one, as far as it goes in that time.
    fn feed_wire(&mut self, text: &mut String, seconds: f64) {
        if let Some(axis) = &self.gcode.wire_axis {
            self.wire += self.wire_speed() * seconds;
            text.push_str(&format!(" {axis}"));
            push_fixed(text, self.wire, 3);
        }
    }

    /// mm/s
    fn wire_speed(&self) -> f64 {
        self.wire_feed_speed * self.feed_ratio * 1000.0 / 60.0
    }

    /// Fills a crater: a wire axis continues alone, at its own speed, where others wait.
    fn fill(&mut self, text: &mut String, seconds: f64) {
        if self.gcode.wire_axis.is_none() {
            return self.wait(text, seconds);
        }
        self.begin_block(text);
        text.push_str("G1");
        self.feed_wire(text, seconds);
        self.feed = self.wire_speed();
        text.push_str(" F");
        push_fixed(text, self.feed * 60.0, 1);
        text.push('\n');
    }

    fn instruction(&mut self, text: &mut String, instruction: Instruction) {
        match instruction {
            Instruction::Approach { to } => self.approach(text, to),
            Instruction::Travel { to } | Instruction::Retract { to } => self.go(text, "G0", to, None),
            Instruction::ArcOn { pass, kind } => {
                self.comment(text, &format!("PASS {pass} {}", kind.name()));
                let lines = [&self.gcode.arc_on[..], &self.gcode.hooks.arc_established].concat();
                self.blocks(text, &lines);
            }
            Instruction::Weld { to, circle, speed, .. } => self.weld(text, to, circle, speed),
            Instruction::WireFeed { ratio } => {
                self.feed_ratio = ratio;
                self.values.set_wire_feed(ratio, self.wire_feed_speed);
                let lines = self.gcode.wire_feed.clone();
                self.blocks(text, &lines);
            }
            Instruction::Crater { seconds, ratio } => {
                if let Some(ratio) = ratio {
                    self.feed_ratio = ratio;
                    self.values.set_wire_feed(ratio, self.wire_feed_speed);
                    let lines = crater_lines(&self.gcode.crater, &self.gcode.wire_feed).to_vec();
                    self.blocks(text, &lines);
                }
                self.fill(text, seconds);
            }
            Instruction::Dwell { seconds } => self.wait(text, seconds),
            Instruction::ArcOff { .. } => {
                let lines = [&self.gcode.hooks.before_arc_off[..], &self.gcode.arc_off].concat();
                self.blocks(text, &lines);
            }
            Instruction::PassStart { pass, above, .. } => self.pass_start(text, pass, above),
            Instruction::Above => self.above(text),
            Instruction::Turn { .. } => {}
            Instruction::PassEnd => {
                let lines = self.gcode.hooks.pass_end.clone();
                self.blocks(text, &lines);
                self.end_branch(text);
            }
        }
    }

    fn chunk(&self, text: String) -> Vec<Chunk> {
        vec![Chunk { file: self.file.clone(), text }]
    }
}

/// I and J: the centre relative to the start of the arc, mm. They have one decimal more than the points, because
/// rounding them shifts the whole arc.
pub(in crate::dialect) fn push_centre(text: &mut String, centre: DVec3, decimals: usize) {
    let decimals = (decimals + 1).min(4);
    text.push_str(" I");
    push_fixed(text, centre.x, decimals);
    text.push_str(" J");
    push_fixed(text, centre.y, decimals);
}

impl Writer for CncGcode {
    fn begin(&mut self, extent: &Extent) -> Vec<Chunk> {
        let mut text = String::new();
        if self.gcode.percent_signs {
            text.push_str("%\n");
        }
        if let Some(number) = self.gcode.program_number {
            text.push_str(&format!("O{number:04}\n"));
        }
        self.values.set("layers", extent.layers);
        self.comment(&mut text, &self.comment);
        self.supplies.iter().for_each(|line| self.comment(&mut text, line));
        if let Some(control) = self.restarts() {
            self.comment(&mut text, &restart::comment(control.variable()));
            self.line(&mut text, &control.reset());
        }
        let header = [&self.gcode.header[..], &self.gcode.hooks.watch].concat();
        self.blocks(&mut text, &header);
        self.chunk(text)
    }

    fn layer(&mut self, program: &LayerProgram) -> Vec<Chunk> {
        if program.instructions.is_empty() {
            return Vec::new();
        }
        let mut text = String::with_capacity(program.instructions.len() * 32);
        self.values.set_layer(program);
        self.comment(&mut text, &format!("LAYER {} Z {:.3}", program.index + 1, program.z));
        if self.program.layer_offsets {
            self.comment(&mut text, "MM ADDED TO THIS LAYER");
            self.raise(&mut text, "0.000");
        }
        let lines = self.gcode.hooks.before_layer(&self.gcode.layer_start, program.index, &self.program);
        self.skippable(&mut text, self.values.last_number(), 1, &lines);
        for &instruction in &program.instructions {
            self.instruction(&mut text, instruction);
        }
        let lines = self.gcode.hooks.layer_end.clone();
        self.skippable(&mut text, self.values.last_number(), 2, &lines);
        self.chunk(text)
    }

    fn end(&mut self) -> Vec<Chunk> {
        let mut text = String::new();
        self.raise(&mut text, "0.000");
        let footer = [&self.gcode.hooks.all_off[..], &self.gcode.footer].concat();
        self.blocks(&mut text, &footer);
        if self.gcode.percent_signs {
            text.push_str("%\n");
        }
        self.chunk(text)
    }

    fn failure(&self) -> Option<DialectError> {
        let control = self.restarts().filter(|control| control.jumps_to_numbers());
        control.filter(|_| self.labels > MAX_LABEL).map(|_| DialectError::Cannot {
            dialect: "gcode",
            what: "program.restart for so many passes, as jumps of this control find blocks up to N99999 only",
            remedy: "Set program.restart = false; after a stop, programs are written from the layer and pass that come next.",
        })
    }
}
