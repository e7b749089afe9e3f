//! The structure that the programs of all welding machines share: heads and ends, layers in separate files, volumes,
//! the lines of the profile in their places, passes at which a program may begin. A language adds its [`Syntax`].

use super::volumes::{Volumes, from_anywhere};
use super::{Chunk, DialectError, Hooks, Job, Values, Writer, split};
use crate::dialect::Section;
use crate::program::{Attitude, Circle, Instruction, LayerProgram, ProgramSettings};
use bead_plan::layer::Extent;
use bead_plan::pass::PassKind;
use bead_plan::process::Process;
use glam::DVec3;

/// Characters reserved in the name of a layer's file for `_L`, and for the number of a part of it: `_999`.
pub(in crate::dialect) const SUFFIX: usize = 2 + 4;

/// Bytes of a call, besides the name.
const CALL: usize = 5;

/// The lines of a section that go into programs.
#[derive(Debug, Clone)]
pub(in crate::dialect) struct Lines {
    pub(in crate::dialect) start: Vec<String>,
    pub(in crate::dialect) layer_start: Vec<String>,
    pub(in crate::dialect) arc_on: Vec<String>,
    pub(in crate::dialect) arc_off: Vec<String>,
    pub(in crate::dialect) wire_feed: Vec<String>,
    /// Those that set the wire feed in a crater.
    pub(in crate::dialect) crater: Vec<String>,
    pub(in crate::dialect) end: Vec<String>,
    pub(in crate::dialect) routines: Vec<String>,
    pub(in crate::dialect) hooks: Hooks,
}

impl Lines {
    fn of(section: &dyn Section) -> Self {
        let templates = section.templates();
        let lines = |names: &[&str]| -> Vec<String> {
            let named = templates.iter().find(|(key, _)| names.iter().any(|name| key.ends_with(name)));
            named.map(|(_, lines)| lines.to_vec()).unwrap_or_default()
        };
        let (wire_feed, crater) = (lines(&[".wire_feed"]), lines(&[".crater"]));
        Self {
            start: lines(&[".start", ".header"]),
            layer_start: lines(&[".layer_start"]),
            arc_on: lines(&[".arc_on"]),
            arc_off: lines(&[".arc_off"]),
            // Without lines of its own, a crater gets the general ones.
            crater: if crater.is_empty() { wire_feed.clone() } else { crater },
            wire_feed,
            end: lines(&[".end", ".footer"]),
            routines: lines(&[".routines"]),
            hooks: section.hooks().cloned().unwrap_or_default(),
        }
    }
}

/// The state and data that every program of a welding machine has.
pub(in crate::dialect) struct Frame {
    /// Name of the program.
    pub(in crate::dialect) name: String,
    /// Name of the main program: that of the volume, if there are several.
    pub(in crate::dialect) main: String,
    /// Comment for the head of files.
    pub(in crate::dialect) comment: String,
    /// What the cell must supply, as comment lines.
    pub(in crate::dialect) supplies: Vec<String>,
    pub(in crate::dialect) program: ProgramSettings,
    pub(in crate::dialect) process: Process,
    /// Travel speed, mm/s.
    pub(in crate::dialect) travel_speed: f64,
    pub(in crate::dialect) lines: Lines,
    pub(in crate::dialect) values: Values,
    /// The wire feed as a multiple of the nominal one.
    pub(in crate::dialect) feed: f64,
    /// Index of the layer that is written.
    pub(in crate::dialect) layer: usize,
    /// Number of layers.
    pub(in crate::dialect) layers: usize,
    /// Digits of layer numbers in names.
    pub(in crate::dialect) digits: usize,
    /// The size of each volume, if the controller's memory may be too small for the whole program.
    pub(in crate::dialect) volumes: Option<Volumes>,
}

impl Frame {
    /// The frame of a job; `name` is the name of the program in the language, `width` the most characters of a comment
    /// line.
    pub(in crate::dialect) fn new(job: &Job<'_>, name: String, width: usize, section: &dyn Section) -> Self {
        Self {
            values: Values::new(&name, job),
            name,
            main: String::new(),
            comment: job.comment(),
            supplies: job.supplies(width),
            program: job.program.clone(),
            process: job.weld.process.clone(),
            travel_speed: job.weld.travel.speed,
            lines: Lines::of(section),
            feed: 1.0,
            layer: 0,
            layers: 0,
            digits: 3,
            volumes: None,
        }
    }

    /// The lines of the profile with their placeholders replaced.
    fn expand(&self, lines: fn(&Lines) -> &[String]) -> Vec<String> {
        self.values.expand(lines(&self.lines)).collect()
    }
}

/// A layer, or a part of one that is too long for one file.
#[derive(Debug, Clone)]
pub(in crate::dialect) struct Part {
    /// Its number in names: `007`, or `007_2` for the second part.
    pub(in crate::dialect) number: String,
    /// Index of the layer.
    pub(in crate::dialect) layer: usize,
    /// Top of the layer, mm.
    pub(in crate::dialect) z: f64,
    /// Whether it is the first part of its layer.
    pub(in crate::dialect) first: bool,
    /// Whether it is the last part of its layer.
    pub(in crate::dialect) last: bool,
}

/// Part of a program that is skipped if the program begins at a later pass. Each has a number; those below the number
/// at which to begin are skipped.
#[derive(Debug, Clone, Copy)]
pub(in crate::dialect) enum Skippable {
    LayerStart(usize),
    Pass(usize),
    LayerEnd(usize),
}

impl Skippable {
    /// Its number.
    pub(in crate::dialect) fn number(self) -> usize {
        let (Self::LayerStart(number) | Self::Pass(number) | Self::LayerEnd(number)) = self;
        number
    }
}

/// A move with the arc on.
#[derive(Debug, Clone, Copy)]
pub(in crate::dialect) struct Piece {
    /// Tool point, mm.
    pub(in crate::dialect) to: DVec3,
    /// The circle along which it moves there; `None` for a straight move.
    pub(in crate::dialect) circle: Option<Circle>,
    /// Speed, mm/s.
    pub(in crate::dialect) speed: f64,
    /// Whether the pass ends here, with an exact stop.
    pub(in crate::dialect) last: bool,
}

/// How a language writes the elements of the frame.
pub(in crate::dialect) trait Syntax: Send {
    /// The text of a layer, or of the main program.
    type Text;

    fn frame(&self) -> &Frame;

    fn frame_mut(&mut self) -> &mut Frame;

    /// Most characters of the program's name; `digits` is the number of digits in layer numbers.
    fn longest_name(&self, _digits: usize) -> usize {
        usize::MAX
    }

    /// Most moves in one part of a layer.
    fn most_moves(&self) -> usize {
        usize::MAX
    }

    /// The main program up to the calls of the layers.
    fn begin_main(&mut self) -> Vec<Chunk>;

    /// The main program after the calls of the layers.
    fn end_main(&mut self) -> Vec<Chunk>;

    /// The name of a part of a layer.
    fn name_of(&self, part: &Part) -> String {
        format!("{}_L{}", self.frame().name, part.number)
    }

    /// Prepares what all parts of a layer need.
    fn begin_layer(&mut self, _program: &LayerProgram) {}

    /// A part of a layer, around its [`body`].
    fn part(&mut self, part: &Part, moves: &[Instruction]) -> Vec<Chunk>;

    /// Calls a part of a layer in the main program.
    fn call(&mut self, _part: &Part) -> Vec<Chunk> {
        Vec::new()
    }

    /// A line of the profile.
    fn line(&mut self, text: &mut Self::Text, line: &str);

    /// Waits until the torch stands still, in languages that execute ahead of it.
    fn settle(&mut self, _text: &mut Self::Text) {}

    /// Begins a part that is skipped if the program begins later. Only programs that can begin at any pass use this and
    /// the next three.
    fn begin_skippable(&mut self, text: &mut Self::Text, what: Skippable);

    fn end_skippable(&mut self, text: &mut Self::Text);

    /// A program that begins at the pass with this number moves to a point above it from anywhere; then, up to
    /// [`end_way`](Syntax::end_way), comes the path by which others get there.
    fn begin_way(&mut self, text: &mut Self::Text, number: usize, above: DVec3);

    fn end_way(&mut self, text: &mut Self::Text) {
        self.end_skippable(text);
    }

    /// Sets the attitude of torch and table from here on.
    fn stand(&mut self, _attitude: Attitude) {}

    /// Writes an instruction that a package of the controller carries out instead of the lines of the profile; false if
    /// it leaves the instruction to them.
    fn by_package(&mut self, _text: &mut Self::Text, _moves: &[Instruction], _at: usize) -> bool {
        false
    }

    /// A joint move.
    fn approach(&mut self, text: &mut Self::Text, to: DVec3);

    /// A straight move with the arc off.
    fn travel(&mut self, text: &mut Self::Text, to: DVec3);

    /// A comment at the start of a pass.
    fn pass(&mut self, text: &mut Self::Text, pass: usize, kind: PassKind);

    fn begin_weave(&mut self, _text: &mut Self::Text) {}

    fn end_weave(&mut self, _text: &mut Self::Text) {}

    /// A move with the arc on; `next` are the instructions after it.
    fn weld(&mut self, text: &mut Self::Text, piece: Piece, next: &[Instruction]);

    /// Stands still with the arc on.
    fn fill(&mut self, text: &mut Self::Text, seconds: f64) {
        self.wait(text, seconds);
    }

    fn wait(&mut self, text: &mut Self::Text, seconds: f64);

    /// See [`Writer::weaves`].
    fn weaves(&self) -> bool {
        false
    }

    /// See [`Writer::failure`].
    fn failure(&self) -> Option<DialectError> {
        None
    }
}

impl<S: Syntax> Writer for S {
    fn begin(&mut self, extent: &Extent) -> Vec<Chunk> {
        let digits = extent.layers.to_string().len().max(3);
        let longest = self.longest_name(digits);
        let frame = self.frame_mut();
        (frame.digits, frame.layers) = (digits, extent.layers);
        frame.name.truncate(longest);
        frame.values.set("layers", extent.layers);
        begin_main(self)
    }

    fn layer(&mut self, program: &LayerProgram) -> Vec<Chunk> {
        if program.instructions.is_empty() {
            return Vec::new();
        }
        self.frame_mut().values.set_layer(program);
        self.frame_mut().layer = program.index;
        self.begin_layer(program);
        let parts = split::passes(&program.instructions, self.most_moves());
        let (count, digits) = (parts.len(), self.frame().digits);
        let mut all = Vec::new();
        for (i, moves) in parts.into_iter().enumerate() {
            let more = if i == 0 { String::new() } else { format!("_{}", i + 1) };
            let number = format!("{:0digits$}{more}", program.index + 1);
            let part = Part { number, layer: program.index, z: program.z, first: i == 0, last: i + 1 == count };
            all.extend(add(self, &part, moves));
        }
        all
    }

    fn end(&mut self) -> Vec<Chunk> {
        self.end_main()
    }

    fn weaves(&self) -> bool {
        Syntax::weaves(self)
    }

    fn notes(&self) -> Vec<String> {
        self.frame().volumes.as_ref().and_then(Volumes::note).into_iter().collect()
    }

    fn failure(&self) -> Option<DialectError> {
        Syntax::failure(self)
    }
}

/// Writes a part of a layer and its call; a part that does not fit in the volume begins another one.
fn add<S: Syntax>(syntax: &mut S, part: &Part, moves: &[Instruction]) -> Vec<Chunk> {
    let call = syntax.name_of(part).len() + CALL;
    let (mut chunks, mut all) = (syntax.part(part, moves), Vec::new());
    if syntax.frame().volumes.as_ref().is_some_and(|volumes| !volumes.has_room(size(&chunks) + call)) {
        all.extend(syntax.end_main());
        all.extend(begin_main(syntax));
        chunks = syntax.part(part, &from_anywhere(moves));
    }
    syntax.frame_mut().volumes.iter_mut().for_each(|volumes| volumes.add(size(&chunks) + call));
    all.extend(syntax.call(part));
    all.extend(chunks);
    all
}

/// Begins a main program: the only one, or that of a volume.
fn begin_main<S: Syntax>(syntax: &mut S) -> Vec<Chunk> {
    let frame = syntax.frame_mut();
    frame.main = frame.volumes.as_mut().map_or_else(|| frame.name.clone(), |volumes| volumes.begin(&frame.name));
    let chunks = syntax.begin_main();
    if syntax.frame().volumes.is_some() {
        let bytes = size(&chunks) + size(&syntax.end_main());
        syntax.frame_mut().volumes.iter_mut().for_each(|volumes| volumes.add_frame(bytes));
    }
    chunks
}

/// Total bytes of some files.
fn size(chunks: &[Chunk]) -> usize {
    chunks.iter().map(|chunk| chunk.text.len()).sum()
}

/// Lines at the beginning of the main program.
pub(in crate::dialect) fn start<S: Syntax>(syntax: &mut S, text: &mut S::Text) {
    lines(syntax, text, |lines| &lines.start);
    lines(syntax, text, |lines| &lines.hooks.watch);
}

/// Lines at the end of the main program.
pub(in crate::dialect) fn end<S: Syntax>(syntax: &mut S, text: &mut S::Text) {
    lines(syntax, text, |lines| &lines.hooks.all_off);
    lines(syntax, text, |lines| &lines.end);
}

/// Subprograms that the other lines call.
pub(in crate::dialect) fn routines<S: Syntax>(syntax: &mut S, text: &mut S::Text) {
    lines(syntax, text, |lines| &lines.hooks.watch_routines);
    lines(syntax, text, |lines| &lines.routines);
}

/// The body of a part of a layer.
pub(in crate::dialect) fn body<S: Syntax>(syntax: &mut S, text: &mut S::Text, part: &Part, moves: &[Instruction]) {
    let number = syntax.frame().values.last_number();
    if part.first {
        let Frame { lines, program, .. } = syntax.frame();
        let lines = lines.hooks.before_layer(&lines.layer_start, part.layer, program);
        skippable(syntax, text, Skippable::LayerStart(number), &lines);
    }
    (0..moves.len()).for_each(|at| instruction(syntax, text, moves, at));
    if part.last {
        let lines = syntax.frame().lines.hooks.layer_end.clone();
        skippable(syntax, text, Skippable::LayerEnd(number), &lines);
    }
}

fn lines<S: Syntax>(syntax: &mut S, text: &mut S::Text, lines: fn(&Lines) -> &[String]) {
    syntax.frame().expand(lines).iter().for_each(|line| syntax.line(text, line));
}

/// Lines for when the torch stands still, if there are any.
fn standing<S: Syntax>(syntax: &mut S, text: &mut S::Text, of: fn(&Lines) -> &[String]) {
    if !of(&syntax.frame().lines).is_empty() {
        syntax.settle(text);
        lines(syntax, text, of);
    }
}

/// Lines that are skipped if the program begins later.
fn skippable<S: Syntax>(syntax: &mut S, text: &mut S::Text, what: Skippable, lines: &[String]) {
    if lines.is_empty() {
        return;
    }
    let restart = syntax.frame().program.restart;
    if restart {
        syntax.begin_skippable(text, what);
    }
    let lines: Vec<String> = syntax.frame().values.expand(lines).collect();
    lines.iter().for_each(|line| syntax.line(text, line));
    if restart {
        syntax.end_skippable(text);
    }
}

fn instruction<S: Syntax>(syntax: &mut S, text: &mut S::Text, moves: &[Instruction], at: usize) {
    if let Some(attitude) = moves[at].attitude() {
        attitude.held.iter().for_each(|held| syntax.frame_mut().values.set_turned(held.angles));
        syntax.stand(attitude);
    }
    if let Instruction::WireFeed { ratio } = moves[at] {
        syntax.frame_mut().feed = ratio;
    }
    if syntax.by_package(text, moves, at) {
        return;
    }
    match moves[at] {
        Instruction::Approach { to } => syntax.approach(text, to),
        Instruction::Travel { to } | Instruction::Retract { to } => syntax.travel(text, to),
        Instruction::PassStart { pass, above, .. } => begin_pass(syntax, text, pass, above),
        Instruction::Above => above(syntax, text),
        Instruction::ArcOn { pass, kind } => arc_on(syntax, text, pass, kind),
        Instruction::Weld { to, circle, speed, last, .. } => {
            syntax.weld(text, Piece { to, circle, speed, last }, &moves[at + 1..]);
        }
        Instruction::WireFeed { ratio } => {
            set_wire_feed(syntax.frame_mut(), ratio);
            lines(syntax, text, |lines| &lines.wire_feed);
        }
        Instruction::Crater { seconds, ratio } => crater(syntax, text, seconds, ratio),
        Instruction::ArcOff { .. } => arc_off(syntax, text),
        Instruction::Dwell { seconds } => syntax.wait(text, seconds),
        Instruction::PassEnd => end_pass(syntax, text),
        Instruction::Turn { .. } => {}
    }
}

/// A program that begins at this pass comes from anywhere, others by the moves that follow.
fn begin_pass<S: Syntax>(syntax: &mut S, text: &mut S::Text, pass: usize, above: DVec3) {
    let number = syntax.frame_mut().values.set_pass(pass);
    if syntax.frame().program.restart {
        syntax.begin_skippable(text, Skippable::Pass(number));
        syntax.begin_way(text, number, above);
    }
}

/// The torch is above the start of the pass, by whichever path.
fn above<S: Syntax>(syntax: &mut S, text: &mut S::Text) {
    if syntax.frame().program.restart {
        syntax.end_way(text);
    }
    standing(syntax, text, |lines| &lines.hooks.pass_start);
}

fn end_pass<S: Syntax>(syntax: &mut S, text: &mut S::Text) {
    standing(syntax, text, |lines| &lines.hooks.pass_end);
    if syntax.frame().program.restart {
        syntax.end_skippable(text);
    }
}

fn arc_on<S: Syntax>(syntax: &mut S, text: &mut S::Text, pass: usize, kind: PassKind) {
    syntax.pass(text, pass, kind);
    syntax.settle(text);
    lines(syntax, text, |lines| &lines.arc_on);
    lines(syntax, text, |lines| &lines.hooks.arc_established);
    syntax.begin_weave(text);
}

fn arc_off<S: Syntax>(syntax: &mut S, text: &mut S::Text) {
    syntax.end_weave(text);
    standing(syntax, text, |lines| &lines.hooks.before_arc_off);
    syntax.settle(text);
    lines(syntax, text, |lines| &lines.arc_off);
}

fn crater<S: Syntax>(syntax: &mut S, text: &mut S::Text, seconds: f64, ratio: Option<f64>) {
    if let Some(ratio) = ratio {
        set_wire_feed(syntax.frame_mut(), ratio);
        syntax.settle(text);
        lines(syntax, text, |lines| &lines.crater);
    }
    syntax.fill(text, seconds);
}

fn set_wire_feed(frame: &mut Frame, ratio: f64) {
    frame.feed = ratio;
    frame.values.set_wire_feed(ratio, frame.process.wire_feed_speed);
}
