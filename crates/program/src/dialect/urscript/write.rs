//! URScript of Universal Robots: `NAME.script`, with one function per layer and a program that calls them.
//!
//! Lengths are in metres and angles in radians. Poses are given in the part's frame; `pose_trans` moves them to the
//! robot's base. Moves of a pass are blended, by less than half the length of the shorter of two neighbours, but not
//! where the arc switches. Lines end with a line feed alone, as on the controller, which runs Linux.

use super::section::Urscript;
use crate::dialect::writing::orientation::{self, Turn};
use crate::dialect::writing::volumes::{Volumes, from_anywhere};
use crate::dialect::writing::{Chunk, Job, Values, Writer, crater_lines, restart, split, upper_name};
use crate::number::{fixed, push_fixed};
use crate::program::{Instruction, LayerProgram, ProgramSettings};
use bead_plan::layer::Extent;
use glam::DVec3;

/// Words of the language and names of its functions that a part might happen to be named after.
const RESERVED: &str = "\
    and break continue def elif else end false global halt if local not or pass return sec self thread true while xor acos \
    asin atan ceil cos d2r exp fail floor force freedrive_mode get_inverse_kin join kill length log movec movej movel movep \
    norm ones part_frame pause popup pow r2d random rotvec2rpy servoj set_tcp set_payload sin size sleep speedj speedl sqrt \
    stopj stopl sync tan textmsg wrench zeros";

/// Greatest blend between two moves, as a fraction of the length of the shorter one.
const BLEND_PART: f64 = 0.45;

/// Smaller blends are left out, mm.
const MIN_BLEND: f64 = 0.01;

/// A function has about this many moves at most; a longer pass makes a longer function.
const MAX_MOVES: usize = 2000;

/// Comments are wrapped at this many characters.
const MAX_COMMENT: usize = 76;

/// Where to begin.
const START: &str = "start_at";

/// Writes URScript.
pub(super) struct UniversalScript {
    name: String,
    comment: String,
    supplies: Vec<String>,
    urscript: Urscript,
    program: ProgramSettings,
    values: Values,
    /// Rotation vector of the torch, rad.
    orientation: [f64; 3],
    travel_speed: f64,
    wire_feed_speed: f64,
    digits: usize,
    /// Number of layers.
    count: usize,
    /// Names of the layers' functions.
    layers: Vec<String>,
    at: Option<DVec3>,
    volumes: Volumes,
    /// Name of the current volume.
    main: String,
}

impl UniversalScript {
    /// Begins the program of a part and names it after the part.
    pub(super) fn new(job: &Job<'_>, urscript: Urscript) -> Self {
        let mut name = upper_name(&job.part).to_lowercase();
        if RESERVED.split(' ').any(|word| word == name) || name.starts_with("layer_") {
            name.insert_str(0, "p_");
        }
        let comment = job.comment();
        let values = Values::new(&name, job);
        let (travel_speed, wire_feed_speed) = (job.weld.travel.speed, job.weld.process.wire_feed_speed);
        let (layers, volumes, main) = (Vec::new(), Volumes::new(urscript.max_megabytes), String::new());
        let (supplies, program, orientation) = (job.supplies(MAX_COMMENT), job.program.clone(), urscript.orientation);
        Self {
            name,
            comment,
            supplies,
            urscript,
            program,
            values,
            orientation,
            travel_speed,
            wire_feed_speed,
            digits: 3,
            count: 0,
            layers,
            at: None,
            volumes,
            main,
        }
    }

    fn lines(&self, text: &mut String, indent: &str, template: &[String]) {
        for line in self.values.expand(template) {
            text.push_str(&format!("{indent}{line}\n"));
        }
    }

    /// Lines that a program begun later than `number` leaves out.
    fn skippable(&self, text: &mut String, indent: &str, number: usize, lines: &[String]) {
        if lines.is_empty() {
            return;
        }
        self.begin_skippable(text, indent, number);
        self.lines(text, indent, lines);
        self.end_skippable(text, indent);
    }

    fn begin_skippable(&self, text: &mut String, indent: &str, number: usize) {
        if self.program.restart {
            text.push_str(&format!("{indent}if {START} <= {number}:\n"));
        }
    }

    fn end_skippable(&self, text: &mut String, indent: &str) {
        if self.program.restart {
            text.push_str(&format!("{indent}end\n"));
        }
    }

    /// Begins a pass: a program that begins at it comes from anywhere, others by the moves that follow.
    fn pass_start(&mut self, text: &mut String, indent: &str, pass: usize, above: DVec3) {
        let number = self.values.set_pass(pass);
        self.begin_skippable(text, indent, number);
        if self.program.restart {
            text.push_str(&format!("{indent}if {START} > 0:\n"));
            self.instruction(text, indent, Instruction::Approach { to: above }, None);
            text.push_str(&format!("{indent}global {START} = 0\n{indent}else:\n"));
        }
    }

    /// The torch is above the start of the pass, whichever way it came.
    fn above(&mut self, text: &mut String, indent: &str) {
        if self.program.restart {
            text.push_str(&format!("{indent}end\n"));
        }
        self.lines(text, indent, &self.urscript.hooks.pass_start);
    }

    fn home(&self, text: &mut String) {
        let axes = self.urscript.home.map(|axis| fixed(axis.to_radians(), 6)).join(",");
        let speed = fixed(self.urscript.home_speed.to_radians(), 6);
        text.push_str(&format!("  movej([{axes}], a=1.400000, v={speed})\n"));
    }

    fn pose(&self, text: &mut String, to: DVec3) {
        text.push_str("pose_trans(part_frame, ");
        push_frame(text, to, &self.orientation);
        text.push(')');
    }

    fn motion(&self, text: &mut String, indent: &str, via: Option<DVec3>, to: DVec3, speed: f64, blend: f64) {
        text.push_str(indent);
        text.push_str(if via.is_some() { "movec(" } else { "movel(" });
        if let Some(via) = via {
            self.pose(text, via);
            text.push_str(", ");
        }
        self.pose(text, to);
        text.push_str(", a=");
        push_fixed(text, self.urscript.acceleration / 1000.0, 6);
        text.push_str(", v=");
        push_fixed(text, (speed / 1000.0).max(1e-6), 6);
        if blend >= MIN_BLEND {
            text.push_str(", r=");
            // Rounded down: it must stay under half of the shorter move.
            push_fixed(text, (blend * 1000.0).floor() / 1e6, 6);
        }
        text.push_str(if via.is_some() { ", mode=0)\n" } else { ")\n" });
    }

    /// The blend at the end of a move, mm; `next` is the move after it, if one follows without a stop.
    fn blend(&self, to: DVec3, next: Option<&Instruction>) -> f64 {
        let before = self.at.map_or(0.0, |at| at.distance(to));
        match next {
            Some(Instruction::Weld { to: next, .. }) => {
                self.urscript.blend.min(BLEND_PART * before.min(to.distance(*next)))
            }
            _ => 0.0,
        }
    }

    fn instruction(&mut self, text: &mut String, indent: &str, instruction: Instruction, next: Option<&Instruction>) {
        if let Some(attitude) = instruction.attitude() {
            self.orientation = orientation::vector(self.urscript.orientation, Turn::Attitude(attitude));
        }
        match instruction {
            Instruction::Approach { to } => {
                text.push_str(&format!("{indent}movej("));
                self.pose(text, to);
                text.push_str(&format!(", a=1.400000, v={})\n", fixed(self.urscript.home_speed.to_radians(), 6)));
                self.at = Some(to);
            }
            Instruction::Travel { to } | Instruction::Retract { to } => {
                self.motion(text, indent, None, to, self.travel_speed, 0.0);
                self.at = Some(to);
            }
            Instruction::ArcOn { pass, kind } => {
                text.push_str(&format!("{indent}# pass {pass} {}\n", kind.name()));
                self.lines(text, indent, &self.urscript.arc_on);
                self.lines(text, indent, &self.urscript.hooks.arc_established);
            }
            Instruction::Weld { to, circle, speed, last, .. } => {
                let blend = if last { 0.0 } else { self.blend(to, next) };
                self.motion(text, indent, circle.map(|c| c.via), to, speed, blend);
                self.at = Some(to);
            }
            Instruction::WireFeed { ratio } => {
                self.values.set_wire_feed(ratio, self.wire_feed_speed);
                self.lines(text, indent, &self.urscript.wire_feed);
            }
            Instruction::Crater { seconds, ratio } => {
                if let Some(ratio) = ratio {
                    self.values.set_wire_feed(ratio, self.wire_feed_speed);
                    self.lines(text, indent, crater_lines(&self.urscript.crater, &self.urscript.wire_feed));
                }
                wait(text, indent, seconds);
            }
            Instruction::Dwell { seconds } => wait(text, indent, seconds),
            Instruction::ArcOff { .. } => {
                self.lines(text, indent, &self.urscript.hooks.before_arc_off);
                self.lines(text, indent, &self.urscript.arc_off);
            }
            Instruction::PassStart { pass, above, .. } => self.pass_start(text, indent, pass, above),
            Instruction::Above => self.above(text, indent),
            Instruction::Turn { .. } => {}
            Instruction::PassEnd => {
                self.lines(text, indent, &self.urscript.hooks.pass_end);
                self.end_skippable(text, indent);
            }
        }
    }

    fn chunk(&self, text: String) -> Chunk {
        Chunk::new(format!("{}.script", self.main), text)
    }
}

impl UniversalScript {
    fn begin_volume(&mut self) -> Vec<Chunk> {
        self.main = self.volumes.begin(&self.name);
        self.layers.clear();
        let mut text = format!("def {}():\n  # {}\n", self.main, self.comment);
        self.supplies.iter().for_each(|line| text.push_str(&format!("  # {line}\n")));
        if self.program.restart {
            text.push_str(&format!("  # {}\n  global {START} = 0\n", restart::comment(START)));
        }
        if let Some(frame) = &self.urscript.tool_frame {
            text.push_str(&format!("  set_tcp({})\n", frame_text(frame)));
        }
        if let Some(mass) = self.urscript.payload {
            text.push_str(&format!("  set_payload({})\n", fixed(mass, 3)));
        }
        let frame = frame_text(&self.urscript.part_frame);
        text.push_str(&format!("  global part_frame = {frame}\n"));
        if self.program.layer_offsets {
            let zeros = vec!["0.0"; self.count].join(", ");
            text.push_str(&format!("  # mm to be added to the height of each layer\n  global layer_dz = [{zeros}]\n"));
            text.push_str(&format!("  global place = {frame}\n  def lifted(height):\n"));
            text.push_str("    return pose_trans(place, p[0.0,0.0,height/1000.0,0.0,0.0,0.0])\n  end\n");
        }
        self.lines(&mut text, "  ", &self.urscript.hooks.watch_routines);
        self.lines(&mut text, "  ", &self.urscript.routines);
        self.volumes.add_frame(text.len() + self.closing().len());
        vec![self.chunk(text)]
    }

    /// What runs: home, the functions of the layers, home.
    fn closing(&self) -> String {
        let mut text = String::new();
        self.home(&mut text);
        self.lines(&mut text, "  ", &self.urscript.start);
        self.lines(&mut text, "  ", &self.urscript.hooks.watch);
        self.layers.iter().for_each(|name| text.push_str(&format!("  {name}()\n")));
        self.lines(&mut text, "  ", &self.urscript.hooks.all_off);
        self.lines(&mut text, "  ", &self.urscript.end);
        self.home(&mut text);
        text.push_str("end\n");
        if self.urscript.call {
            text.push_str(&format!("{}()\n", self.main));
        }
        text
    }

    fn end_volume(&self) -> Vec<Chunk> {
        vec![self.chunk(self.closing())]
    }

    /// The function of one part of a layer (`part` counts from 0; `last` if no other follows).
    fn function(
        &mut self,
        name: &str,
        program: &LayerProgram,
        (part, last): (usize, bool),
        moves: &[Instruction],
    ) -> String {
        let mut text = format!("  def {name}():\n    # layer {}, z {} mm\n", program.index + 1, fixed(program.z, 3));
        text.reserve(moves.len() * 120);
        if self.program.layer_offsets {
            text.push_str(&format!("    global part_frame = lifted(layer_dz[{}])\n", program.index));
        }
        if part == 0 {
            let lines = self.urscript.hooks.before_layer(&self.urscript.layer_start, program.index, &self.program);
            self.skippable(&mut text, "    ", self.values.last_number(), &lines);
        }
        for (i, &instruction) in moves.iter().enumerate() {
            let behind = moves[i + 1..].iter();
            let next = behind.into_iter().find(|next| !matches!(next, Instruction::WireFeed { .. }));
            self.instruction(&mut text, "    ", instruction, next);
        }
        if last {
            self.skippable(&mut text, "    ", self.values.last_number(), &self.urscript.hooks.layer_end);
        }
        text + "  end\n"
    }
}

impl Writer for UniversalScript {
    fn begin(&mut self, extent: &Extent) -> Vec<Chunk> {
        self.digits = extent.layers.to_string().len().max(3);
        self.values.set("layers", extent.layers);
        self.count = extent.layers;
        self.begin_volume()
    }

    fn layer(&mut self, program: &LayerProgram) -> Vec<Chunk> {
        if program.instructions.is_empty() {
            return Vec::new();
        }
        self.values.set_layer(program);
        let parts = split::passes(&program.instructions, MAX_MOVES);
        let (count, mut chunks) = (parts.len(), Vec::new());
        for (part, moves) in parts.into_iter().enumerate() {
            let more = if part == 0 { String::new() } else { format!("_{}", part + 1) };
            let name = format!("layer_{:0digits$}{more}", program.index + 1, digits = self.digits);
            let place = (part, part + 1 == count);
            let mut text = self.function(&name, program, place, moves);
            if !self.volumes.has_room(text.len()) {
                chunks.extend(self.end_volume());
                chunks.extend(self.begin_volume());
                text = self.function(&name, program, place, &from_anywhere(moves));
            }
            // With its call.
            self.volumes.add(text.len() + name.len() + 5);
            self.layers.push(name);
            chunks.push(self.chunk(text));
        }
        chunks
    }

    fn end(&mut self) -> Vec<Chunk> {
        self.end_volume()
    }

    fn notes(&self) -> Vec<String> {
        self.volumes.note("URScript", "script").into_iter().collect()
    }
}

fn wait(text: &mut String, indent: &str, seconds: f64) {
    text.push_str(&format!("{indent}sleep({})\n", fixed(seconds, 3)));
}

/// A position in mm, written as `p[x,y,z,rx,ry,rz]` in metres and radians.
fn push_frame(text: &mut String, place: DVec3, rotation: &[f64]) {
    text.push_str("p[");
    for (i, value) in place.to_array().iter().map(|v| v / 1000.0).chain(rotation.iter().copied()).enumerate() {
        if i > 0 {
            text.push(',');
        }
        push_fixed(text, value, 6);
    }
    text.push(']');
}

fn frame_text(frame: &[f64; 6]) -> String {
    let mut text = String::new();
    push_frame(&mut text, DVec3::new(frame[0], frame[1], frame[2]), &frame[3..]);
    text
}
