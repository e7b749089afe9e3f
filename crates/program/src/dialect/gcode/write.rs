//! Writes CNC G-code: one file, feeds in mm/min, G0 never with the arc on. Flavours (LinuxCNC, Fanuc, Siemens, TwinCAT)
//! are set by keys and templates in the profile. If rotary axes turn the part, coordinates are those on the part.

use super::control::GcodeControl;
use super::positioner::Axes;
use super::section::{Gcode, GcodeComments};
use crate::dialect::DialectError;
use crate::dialect::writing::frame::{self, Frame, Part, Piece, Skippable, Syntax};
use crate::dialect::writing::{Chunk, Job, ascii, restart};
use crate::number::push_fixed;
use crate::program::{Attitude, Circle, Instruction};
use bead_plan::pass::PassKind;
use glam::DVec3;

/// Highest block number that a jump can find.
const MAX_LABEL: usize = 99_999;

/// Block numbers start again after this one.
const MAX_BLOCK: usize = 99_990;

/// Most characters of a comment, so that blocks stay under 80.
const MAX_COMMENT: usize = 60;

/// Writes G-code.
pub(super) struct CncGcode {
    frame: Frame,
    file: String,
    gcode: Gcode,
    block: usize,
    /// Feed written last, mm/s.
    feed: f64,
    /// Wire fed so far, mm.
    wire: f64,
    /// X, Y and Z last written, mm.
    at: Option<DVec3>,
    /// The axes that turn the part.
    axes: Option<Axes>,
    /// Whether blocks have numbers.
    numbered: bool,
    /// Number of labels written.
    labels: usize,
    /// Lines that end the open branches.
    open: Vec<String>,
}

impl CncGcode {
    /// Begins the program of a part.
    pub(super) fn new(job: &Job<'_>, gcode: Gcode) -> Self {
        let name = gcode.control.map_or_else(|| job.part.clone(), |control| control.file_name(&job.part));
        let file = format!("{name}.{}", gcode.extension);
        let jumps = gcode.control.is_some_and(GcodeControl::jumps_to_numbers) && job.program.restart;
        let numbered = gcode.block_numbers && !jumps;
        let turned = gcode.positioner.as_ref().zip(job.program.positioner.as_ref());
        let axes = turned.map(|(words, positioner)| Axes::new(words, positioner));
        Self {
            frame: Frame::new(job, ascii(&job.part), MAX_COMMENT, &gcode),
            file,
            gcode,
            block: 0,
            feed: 0.0,
            wire: 0.0,
            at: None,
            axes,
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

    /// A line that is not a block: an O word, or a jump.
    fn plain(&self, text: &mut String, line: &str) {
        text.push_str(line);
        text.push('\n');
    }

    /// The control, if the program can begin at any pass.
    fn restarts(&self) -> Option<GcodeControl> {
        self.gcode.control.filter(|_| self.frame.program.restart)
    }

    fn new_label(&mut self) -> usize {
        self.labels += 1;
        self.labels
    }

    /// Adds a height, mm, to the following moves.
    fn raise(&mut self, text: &mut String, height: &str) {
        if let Some(control) = self.gcode.control.filter(|_| self.frame.program.layer_offsets) {
            self.begin_block(text);
            self.plain(text, &control.raise(height));
            // Whether this changes the torch's coordinates is unknown here.
            self.at = None;
        }
    }

    /// A move to a point of the part; axes that do not move are omitted.
    fn motion(&mut self, text: &mut String, word: &str, place: DVec3, circle: Option<Circle>, pace: Pace) {
        let to = self.axes.as_ref().map_or(place, |axes| axes.on_part(place));
        let moved = [0, 1, 2].map(|axis| self.at.is_none_or(|at| at[axis] != to[axis]));
        let turns = self.axes.as_ref().is_some_and(Axes::turns);
        if moved == [false; 3] && !turns {
            return;
        }
        let alone = self.axes.as_ref().filter(|_| moved == [false; 3]).and_then(Axes::turn);
        self.begin_block(text);
        text.push_str(word);
        self.push_places(text, to, moved);
        self.axes.iter_mut().for_each(|axes| axes.write(text));
        if let (Some(circle), Some(at)) = (circle, self.at) {
            push_centre(text, circle.centre - at, self.gcode.decimals);
        }
        if let (Pace::Weld(speed), Some(at)) = (pace, self.at) {
            self.feed_wire(text, circle.map_or_else(|| at.distance(to), |c| c.length()) / speed);
        }
        let feed = alone.map_or_else(|| pace.feed(), |(seconds, angle)| Some(angle / seconds));
        if let Some(feed) = feed.filter(|&f| f != self.feed) {
            self.feed = feed;
            text.push_str(" F");
            push_fixed(text, feed * 60.0, 1);
        }
        text.push('\n');
        self.at = Some(to);
    }

    fn push_places(&self, text: &mut String, to: DVec3, moved: [bool; 3]) {
        for axis in (0..3).filter(|&axis| moved[axis]) {
            text.push_str([" X", " Y", " Z"][axis]);
            push_fixed(text, to[axis], self.gcode.decimals);
        }
    }

    /// Writes the blocks that switch tool centre point control, if there are any; X, Y and Z are then unknown.
    fn switch_tcp(&mut self, text: &mut String, on: bool) {
        let Some(axes) = &self.axes else { return };
        let lines = if on { &axes.words.tcp_on } else { &axes.words.tcp_off };
        let lines: Vec<String> = self.frame.values.expand(lines).collect();
        lines.iter().for_each(|line| self.line(text, line));
        self.at = None;
    }

    /// Moves the wire axis, if there is one, as far as it feeds in that time.
    fn feed_wire(&mut self, text: &mut String, seconds: f64) {
        if let Some(axis) = &self.gcode.wire_axis {
            self.wire += self.wire_speed() * seconds;
            text.push_str(&format!(" {axis}"));
            push_fixed(text, self.wire, 3);
        }
    }

    /// Speed of the wire, mm/s.
    fn wire_speed(&self) -> f64 {
        self.frame.process.wire_feed_speed * self.frame.feed * 1000.0 / 60.0
    }

    fn chunk(&self, text: String) -> Vec<Chunk> {
        vec![Chunk { file: self.file.clone(), text }]
    }
}

/// Speed of a move.
#[derive(Clone, Copy)]
enum Pace {
    /// Rapid.
    Rapid,
    /// Speed, mm/s, with the arc off.
    Travel(f64),
    /// Speed, mm/s, with the arc on.
    Weld(f64),
}

impl Pace {
    fn feed(self) -> Option<f64> {
        match self {
            Self::Rapid => None,
            Self::Travel(speed) | Self::Weld(speed) => Some(speed),
        }
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

impl Syntax for CncGcode {
    type Text = String;

    fn frame(&self) -> &Frame {
        &self.frame
    }

    fn frame_mut(&mut self) -> &mut Frame {
        &mut self.frame
    }

    fn begin_main(&mut self) -> Vec<Chunk> {
        let mut text = String::new();
        if self.gcode.percent_signs {
            text.push_str("%\n");
        }
        if let Some(number) = self.gcode.program_number {
            text.push_str(&format!("O{number:04}\n"));
        }
        self.comment(&mut text, &self.frame.comment);
        self.frame.supplies.iter().for_each(|line| self.comment(&mut text, line));
        if let Some(control) = self.restarts() {
            self.comment(&mut text, &restart::comment(control.variable()));
            self.plain(&mut text, &control.reset());
        }
        frame::start(self, &mut text);
        self.chunk(text)
    }

    fn end_main(&mut self) -> Vec<Chunk> {
        let mut text = String::new();
        self.raise(&mut text, "0.000");
        self.switch_tcp(&mut text, false);
        frame::end(self, &mut text);
        if self.gcode.percent_signs {
            text.push_str("%\n");
        }
        self.chunk(text)
    }

    fn part(&mut self, part: &Part, moves: &[Instruction]) -> Vec<Chunk> {
        let mut text = String::with_capacity(moves.len() * 32);
        self.comment(&mut text, &format!("LAYER {} Z {:.3}", part.layer + 1, part.z));
        if self.frame.program.layer_offsets {
            self.comment(&mut text, "MM ADDED TO THIS LAYER");
            self.raise(&mut text, "0.000");
        }
        frame::body(self, &mut text, part, moves);
        self.chunk(text)
    }

    fn line(&mut self, text: &mut String, line: &str) {
        // LinuxCNC accepts no block number before an O word, nor here before a parameter.
        if !line.starts_with(['O', '#']) {
            self.begin_block(text);
        }
        self.plain(text, line);
    }

    /// Every O word has its own number: that of the pass or layer, followed by a digit, which is 1 or 2 here; the
    /// others are left to the lines of the profile.
    fn begin_skippable(&mut self, text: &mut String, what: Skippable) {
        let Some(control) = self.restarts() else { return };
        let (number, label) = (what.number(), self.new_label());
        match (control.jump_if_above(number, label), control.label(label)) {
            (Some(jump), Some(label)) => {
                self.plain(text, &jump);
                self.open.push(label);
            }
            _ => {
                let word = number * 10 + if matches!(what, Skippable::LayerEnd(_)) { 2 } else { 1 };
                self.plain(text, &format!("O{word} if [{} LE {number}]", control.variable()));
                self.open.push(format!("O{word} endif"));
            }
        }
    }

    /// After the branch, nothing is known of its effects.
    fn end_skippable(&mut self, text: &mut String) {
        if let Some(end) = self.open.pop() {
            self.plain(text, &end);
            (self.at, self.feed) = (None, 0.0);
            self.axes.iter_mut().for_each(|axes| axes.stand(None));
        }
    }

    fn begin_way(&mut self, text: &mut String, number: usize, above: DVec3) {
        let Some(control) = self.restarts() else { return };
        let (way, behind) = (self.new_label(), self.new_label());
        // Between the two branches, and after both.
        let jumps = (control.jump_if_zero(way), control.jump(behind), control.label(way), control.label(behind));
        let (begin, between, end) = match jumps {
            (Some(unless), Some(jump), Some(way), Some(behind)) => (unless, vec![jump, way], behind),
            _ => {
                let word = number * 10 + 2;
                let begin = format!("O{word} if [{} GT 0]", control.variable());
                (begin, vec![format!("O{word} else")], format!("O{word} endif"))
            }
        };
        let standing = (self.at, self.feed, self.axes.as_ref().and_then(Axes::written));
        self.plain(text, &begin);
        self.approach(text, above);
        self.plain(text, &control.reset());
        between.iter().for_each(|line| self.plain(text, line));
        let written;
        (self.at, self.feed, written) = standing;
        self.axes.iter_mut().for_each(|axes| axes.stand(written));
        self.open.push(end);
    }

    /// The machine may start anywhere: moves to the safe height, across, and down. Axes that turn the part turn it at
    /// that height.
    fn approach(&mut self, text: &mut String, to: DVec3) {
        self.switch_tcp(text, false);
        self.axes.iter_mut().for_each(|axes| axes.stand(None));
        let place = self.axes.as_ref().map_or(to, |axes| axes.in_machine(to));
        let safe = self.gcode.safe_z.max(place.z);
        self.begin_block(text);
        text.push_str("G0 Z");
        push_fixed(text, safe, self.gcode.decimals);
        text.push('\n');
        self.begin_block(text);
        text.push_str("G0");
        self.push_places(text, place, [true, true, false]);
        self.axes.iter_mut().for_each(|axes| axes.write(text));
        text.push('\n');
        self.at = Some(place.with_z(safe));
        self.switch_tcp(text, true);
        self.travel(text, to);
    }

    fn stand(&mut self, attitude: Attitude) {
        self.axes.iter_mut().for_each(|axes| axes.held = attitude.held.or(axes.held));
    }

    /// Not rapid if axes turn the part, since a rapid move would turn it as fast as it can.
    fn travel(&mut self, text: &mut String, to: DVec3) {
        let speed = self.frame.travel_speed;
        match self.axes {
            Some(_) => self.motion(text, "G1", to, None, Pace::Travel(speed)),
            None => self.motion(text, "G0", to, None, Pace::Rapid),
        }
    }

    fn pass(&mut self, text: &mut String, pass: usize, kind: PassKind) {
        self.comment(text, &format!("PASS {pass} {}", kind.name()));
    }

    fn weld(&mut self, text: &mut String, piece: Piece, _next: &[Instruction]) {
        let word = piece.circle.map_or("G1", |circle| circle.word());
        self.motion(text, word, piece.to, piece.circle, Pace::Weld(piece.speed));
    }

    /// Where others wait, a wire axis continues on its own at its own speed.
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

    fn wait(&mut self, text: &mut String, seconds: f64) {
        self.frame.values.set_dwell(seconds);
        let lines: Vec<String> = self.frame.values.expand(&self.gcode.dwell).collect();
        lines.iter().for_each(|line| self.line(text, line));
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
