//! Writes URScript of Universal Robots: `NAME.script`, with one function per layer and a program that calls them.
//!
//! Lengths are in metres and angles in radians. Poses are given in the part's frame; `pose_trans` transforms them to
//! the robot's base. Moves of a pass are blended, by less than half the length of the shorter of two neighbours, but
//! not where the arc is switched. Before a positioner turns the part, the torch goes home, and the part's frame is set
//! anew. Lines end with a line feed alone, as on the controller, which runs Linux.

use super::section::Urscript;
use crate::dialect::writing::frame::{self, Frame, Part, Piece, Skippable, Syntax};
use crate::dialect::writing::orientation::{self, Turn};
use crate::dialect::writing::volumes::Volumes;
use crate::dialect::writing::{Chunk, Job, restart, upper_name};
use crate::number::{fixed, push_fixed};
use crate::program::{Attitude, Held, Instruction};
use bead_plan::pass::PassKind;
use glam::{DQuat, DVec3};

/// Words of the language and names of its functions after which a part might happen to be named.
const RESERVED: &str = "\
    and break continue def elif else end false global halt if local not or pass return sec self thread true while xor acos \
    asin atan ceil cos d2r exp fail floor force freedrive_mode get_inverse_kin join kill length log movec movej movel movep \
    norm ones part_frame pause popup pow r2d random rotvec2rpy servoj set_tcp set_payload sin size sleep speedj speedl sqrt \
    stopj stopl sync tan textmsg wrench zeros";

/// Greatest blend between two moves, as a fraction of the length of the shorter one.
const BLEND_PART: f64 = 0.45;

/// Blends smaller than this are omitted, mm.
const MIN_BLEND: f64 = 0.01;

/// A function has at most about this many moves; a longer pass makes a longer function.
const MAX_MOVES: usize = 2000;

/// Comments are wrapped at this many characters.
const MAX_COMMENT: usize = 76;

/// The variable that holds the pass at which to begin.
const START: &str = "start_at";

/// Writes URScript.
pub(super) struct UniversalScript {
    frame: Frame,
    urscript: Urscript,
    /// Rotation vector of the torch, rad.
    orientation: [f64; 3],
    /// How the positioner is to hold the part.
    held: Option<Held>,
    /// Its angles as last written, °.
    turned: Option<[f64; 2]>,
    /// Index of the current layer.
    layer: usize,
    /// Names of the layers' functions in the current volume.
    functions: Vec<String>,
    at: Option<DVec3>,
}

/// The lines of a function.
pub(super) struct Function {
    text: String,
    indent: &'static str,
}

impl Function {
    fn line(&mut self, line: &str) {
        for part in [self.indent, line, "\n"] {
            self.text.push_str(part);
        }
    }
}

impl UniversalScript {
    /// Begins the program of a part and names it after the part.
    pub(super) fn new(job: &Job<'_>, urscript: Urscript) -> Self {
        let mut name = upper_name(&job.part).to_lowercase();
        if RESERVED.split(' ').any(|word| word == name) || name.starts_with("layer_") {
            name.insert_str(0, "p_");
        }
        let volumes = Some(Volumes::new(urscript.max_megabytes, "URScript", "script"));
        let frame = Frame { volumes, ..Frame::new(job, name, MAX_COMMENT, &urscript) };
        let orientation = urscript.orientation;
        let functions = Vec::new();
        Self { frame, urscript, orientation, held: None, turned: None, layer: 0, functions, at: None }
    }

    fn home(&self, main: &mut Function) {
        let axes = self.urscript.home.map(|axis| fixed(axis.to_radians(), 6)).join(",");
        let speed = fixed(self.urscript.home_speed.to_radians(), 6);
        main.line(&format!("movej([{axes}], a=1.400000, v={speed})"));
    }

    fn pose(&self, text: &mut String, to: DVec3) {
        text.push_str("pose_trans(part_frame, ");
        push_frame(text, to, &self.orientation);
        text.push(')');
    }

    fn motion(&self, function: &mut Function, via: Option<DVec3>, to: DVec3, speed: f64, blend: f64) {
        let Function { text, indent } = function;
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
            // Rounded down: it must stay below half of the shorter move.
            push_fixed(text, (blend * 1000.0).floor() / 1e6, 6);
        }
        text.push_str(if via.is_some() { ", mode=0)\n" } else { ")\n" });
    }

    /// Turns the part, with the torch at home, if it is not yet held as required.
    fn turn(&mut self, function: &mut Function) {
        let Some(held) = self.held.filter(|held| self.turned != Some(held.angles)) else { return };
        self.home(function);
        self.turn_to(held, function);
        self.turned = Some(held.angles);
    }

    fn turn_to(&mut self, held: Held, function: &mut Function) {
        self.frame.values.set_turned(held.angles);
        self.frame.values.expand(&self.urscript.turn).for_each(|line| function.line(&line));
        let frame = frame_text(&self.part_frame(held));
        if self.frame.program.layer_offsets {
            function.line(&format!("global place = {frame}"));
            function.line(&format!("global part_frame = lifted(layer_dz[{}])", self.layer));
        } else {
            function.line(&format!("global part_frame = {frame}"));
        }
    }

    /// The frame of the part in the robot's base, mm and rad, as the positioner holds it.
    fn part_frame(&self, held: Held) -> [f64; 6] {
        let [x, y, z, rx, ry, rz] = self.urscript.part_frame;
        let (at, stands) = (DVec3::new(x, y, z), DQuat::from_scaled_axis(DVec3::new(rx, ry, rz)));
        let Some(positioner) = &self.frame.program.positioner else { return self.urscript.part_frame };
        let at_zero = positioner.held([0.0; 2]).turn.inverse();
        let (at, turn) = (at + stands * at_zero * held.shift, (stands * at_zero * held.turn).normalize());
        let turn = (if turn.w < 0.0 { -turn } else { turn }).to_scaled_axis();
        [at.x, at.y, at.z, turn.x, turn.y, turn.z]
    }

    /// The blend at the end of a move, mm; `next` is the move after it, if there is one without a stop between.
    fn blend(&self, to: DVec3, next: Option<&Instruction>) -> f64 {
        let before = self.at.map_or(0.0, |at| at.distance(to));
        match next {
            Some(Instruction::Weld { to: next, .. }) => {
                self.urscript.blend.min(BLEND_PART * before.min(to.distance(*next)))
            }
            _ => 0.0,
        }
    }

    /// Declarations at the head of the program.
    fn head(&self, main: &mut Function) {
        let Frame { comment, supplies, program, layers, .. } = &self.frame;
        main.line(&format!("# {comment}"));
        supplies.iter().for_each(|line| main.line(&format!("# {line}")));
        if program.restart {
            main.line(&format!("# {}", restart::comment(START)));
            main.line(&format!("global {START} = 0"));
        }
        if let Some(frame) = &self.urscript.tool_frame {
            main.line(&format!("set_tcp({})", frame_text(frame)));
        }
        if let Some(mass) = self.urscript.payload {
            main.line(&format!("set_payload({})", fixed(mass, 3)));
        }
        let frame = frame_text(&self.urscript.part_frame);
        main.line(&format!("global part_frame = {frame}"));
        if program.layer_offsets {
            main.line("# mm to be added to the height of each layer");
            main.line(&format!("global layer_dz = [{}]", vec!["0.0"; *layers].join(", ")));
            main.line(&format!("global place = {frame}"));
            main.line("def lifted(height):");
            main.line("  return pose_trans(place, p[0.0,0.0,height/1000.0,0.0,0.0,0.0])");
            main.line("end");
        }
    }

    fn chunks(&self, function: Function) -> Vec<Chunk> {
        vec![Chunk::new(format!("{}.script", self.frame.main), function.text)]
    }
}

impl Syntax for UniversalScript {
    type Text = Function;

    fn frame(&self) -> &Frame {
        &self.frame
    }

    fn frame_mut(&mut self) -> &mut Frame {
        &mut self.frame
    }

    fn most_moves(&self) -> usize {
        MAX_MOVES
    }

    /// The functions of the layers follow, inside the program.
    fn begin_main(&mut self) -> Vec<Chunk> {
        self.functions.clear();
        self.turned = None;
        let mut main = Function { text: format!("def {}():\n", self.frame.main), indent: "  " };
        self.head(&mut main);
        frame::routines(self, &mut main);
        self.chunks(main)
    }

    /// The statements that run: home, the functions of the layers, home.
    fn end_main(&mut self) -> Vec<Chunk> {
        let mut main = Function { text: String::new(), indent: "  " };
        self.home(&mut main);
        frame::start(self, &mut main);
        self.functions.iter().for_each(|name| main.line(&format!("{name}()")));
        frame::end(self, &mut main);
        self.home(&mut main);
        if let Some(at_zero) = self.frame.program.positioner.as_ref().map(|own| own.held([0.0; 2])) {
            self.turn_to(at_zero, &mut main);
        }
        main.text.push_str("end\n");
        if self.urscript.call {
            main.text.push_str(&format!("{}()\n", self.frame.main));
        }
        self.chunks(main)
    }

    fn name_of(&self, part: &Part) -> String {
        format!("layer_{}", part.number)
    }

    fn part(&mut self, part: &Part, moves: &[Instruction]) -> Vec<Chunk> {
        let mut function = Function { text: format!("  def {}():\n", self.name_of(part)), indent: "    " };
        function.text.reserve(moves.len() * 120);
        self.layer = part.layer;
        function.line(&format!("# layer {}, z {} mm", part.layer + 1, fixed(part.z, 3)));
        if self.frame.program.layer_offsets {
            function.line(&format!("global part_frame = lifted(layer_dz[{}])", part.layer));
        }
        frame::body(self, &mut function, part, moves);
        function.text.push_str("  end\n");
        self.chunks(function)
    }

    /// The calls come at the end.
    fn call(&mut self, part: &Part) -> Vec<Chunk> {
        self.functions.push(self.name_of(part));
        Vec::new()
    }

    fn line(&mut self, function: &mut Function, line: &str) {
        function.line(line);
    }

    fn begin_skippable(&mut self, function: &mut Function, what: Skippable) {
        function.line(&format!("if {START} <= {}:", what.number()));
    }

    fn end_skippable(&mut self, function: &mut Function) {
        function.line("end");
    }

    fn begin_way(&mut self, function: &mut Function, _number: usize, above: DVec3) {
        function.line(&format!("if {START} > 0:"));
        // How the part was turned before is unknown there, but known on the other path.
        let turned = self.turned.take();
        self.approach(function, above);
        self.turned = turned;
        function.line(&format!("global {START} = 0"));
        function.line("else:");
    }

    fn stand(&mut self, attitude: Attitude) {
        self.held = attitude.held.or(self.held);
        self.orientation = orientation::vector(self.urscript.orientation, Turn::Attitude(attitude));
    }

    fn approach(&mut self, function: &mut Function, to: DVec3) {
        self.turn(function);
        let mut text = "movej(".to_owned();
        self.pose(&mut text, to);
        text.push_str(&format!(", a=1.400000, v={})", fixed(self.urscript.home_speed.to_radians(), 6)));
        function.line(&text);
        self.at = Some(to);
    }

    fn travel(&mut self, function: &mut Function, to: DVec3) {
        self.motion(function, None, to, self.frame.travel_speed, 0.0);
        self.at = Some(to);
    }

    fn pass(&mut self, function: &mut Function, pass: usize, kind: PassKind) {
        function.line(&format!("# pass {pass} {}", kind.name()));
    }

    fn weld(&mut self, function: &mut Function, piece: Piece, next: &[Instruction]) {
        let next = next.iter().find(|next| !matches!(next, Instruction::WireFeed { .. }));
        let blend = if piece.last { 0.0 } else { self.blend(piece.to, next) };
        self.motion(function, piece.circle.map(|circle| circle.via), piece.to, piece.speed, blend);
        self.at = Some(piece.to);
    }

    fn wait(&mut self, function: &mut Function, seconds: f64) {
        function.line(&format!("sleep({})", fixed(seconds, 3)));
    }
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
