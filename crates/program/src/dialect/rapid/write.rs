//! Writes ABB RAPID for IRC5 (RobotWare 6): `NAME.mod` holds the cell's data and `main`, `NAME_L001.mod` and so on hold
//! one layer each, and `NAME.pgf` lists the modules to be loaded.
//!
//! With RobotWare Arc a pass is `ArcLStart … fine`, `ArcL … zBead`, `ArcLEnd … fine`; without it, plain `MoveL` between
//! lines that the profile gives. While welding, the welddata set the speed: speeds are rounded to the nominal one plus
//! or minus whole multiples of `speed_step`, and each layer declares the few it uses, `LOCAL` to its module.

use super::section::{Rapid, RapidArc, RapidModules};
use super::{data, names};
use crate::dialect::writing::frame::{self, Frame, Part, Piece, SUFFIX, Skippable, Syntax};
use crate::dialect::writing::orientation::{self, Turn};
use crate::dialect::writing::{Chunk, Job, restart};
use crate::number::fixed;
use crate::program::{Attitude, Instruction, LayerProgram, Weave};
use bead_plan::pass::PassKind;
use bead_plan::process::{Process, StartStop};
use bead_plan::weld::retract_time;
use glam::DVec3;

/// Comments are wrapped at this many characters.
const MAX_COMMENT: usize = 76;

/// The variable that holds the pass at which to begin.
const START: &str = "nStart";

/// Keywords that begin subprograms.
const ROUTINES: [&str; 5] = ["PROC ", "TRAP ", "FUNC ", "LOCAL PROC ", "LOCAL TRAP "];

/// Writes RAPID.
pub(super) struct AbbRapid {
    frame: Frame,
    rapid: Rapid,
    /// How passes begin and end.
    ends: StartStop,
    /// The seamdata of the program, and those of the current layer if they differ.
    seam: String,
    own_seam: Option<String>,
    weave: Option<Weave>,
    orientation: String,
    /// External axes of targets.
    axes: String,
    /// The data of the layer.
    speeds: Speeds,
}

/// The speed of a weld and, where its wire feed is not the nominal one, its pace: the speed at which the nominal wire
/// feed would lay the metal. Both in thousandths of a mm/s.
type Datum = (u64, Option<u64>);

/// The data of a layer in order of appearance: number n is at index n − 1.
type Speeds = Vec<Datum>;

impl AbbRapid {
    /// Begins the program of a part and names the module after the part.
    pub(super) fn new(job: &Job<'_>, rapid: Rapid) -> Self {
        let name = names::module_name(&job.part, 3, [&rapid.tool, &rapid.wobj]);
        let ends = job.weld.ends.clone();
        let seam = seam(&rapid, &ends, &job.weld.process, None);
        let orientation = data::quaternion(&rapid.orientation);
        let axes = data::external_axes(job.program, job.program.first_angles(), &rapid);
        let frame = Frame::new(job, name, MAX_COMMENT, &rapid);
        let (weave, speeds) = (job.weave.cloned(), Speeds::new());
        Self { frame, rapid, ends, seam, own_seam: None, weave, orientation, axes, speeds }
    }

    fn with_arc(&self) -> bool {
        self.rapid.arc == RapidArc::Instructions
    }

    fn main(&self, text: String) -> Chunk {
        Chunk { file: format!("{}.mod", self.frame.name), text }
    }

    fn pgf(&self, text: String) -> Option<Chunk> {
        self.rapid.pgf.then(|| Chunk { file: format!("{}.pgf", self.frame.name), text })
    }

    /// The mechanical unit that turns under the part, if there is one.
    fn table(&self) -> Option<&str> {
        self.rapid.table_unit.as_deref().filter(|_| self.frame.program.has_table())
    }

    /// Activates the units that move along, and refuses a work object of the controller's that does not turn with the
    /// table.
    fn units(&self, text: &mut String) {
        let track = self.rapid.track_unit.as_deref().filter(|_| self.frame.program.linear_axis.is_some());
        track.into_iter().chain(self.table()).for_each(|unit| statement(text, &format!("ActUnit {unit};")));
        if let Some(unit) = self.table().filter(|_| self.rapid.part_frame.is_none()) {
            let wobj = &self.rapid.wobj;
            statement(text, &format!("IF {wobj}.ufprog OR {wobj}.ufmec<>\"{unit}\" THEN"));
            statement(
                text,
                &format!("ErrWrite \"{wobj} does not turn with {unit}\",\"The path would not follow the part.\";"),
            );
            statement(text, "EXIT;");
            statement(text, "ENDIF");
        }
    }

    /// The speed as written, in thousandths of a mm/s: the nominal speed plus or minus whole steps.
    fn rounded(&self, speed: f64) -> u64 {
        let (nominal, step) = (self.frame.process.deposition_speed, self.rapid.speed_step);
        let near = nominal + ((speed - nominal) / step).round() * step;
        let written = if near >= 1e-3 { near } else { speed };
        (written * 1000.0).round().max(1.0) as u64
    }

    /// The data for a speed and the fraction `feed` of the nominal wire feed; plain moves do not set the wire feed.
    fn datum(&self, speed: f64, feed: f64) -> Datum {
        let pace = self.frame.process.deposition_speed / feed;
        (self.rounded(speed), (self.with_arc() && feed != 1.0).then(|| self.rounded(pace)))
    }

    fn speeds_of(&self, program: &LayerProgram) -> Speeds {
        let (mut speeds, mut feed) = (Speeds::new(), 1.0);
        for instruction in &program.instructions {
            match *instruction {
                Instruction::WireFeed { ratio } => feed = ratio,
                Instruction::Weld { speed, .. } => {
                    let datum = self.datum(speed, feed);
                    if !speeds.contains(&datum) {
                        speeds.push(datum);
                    }
                }
                _ => {}
            }
        }
        speeds
    }

    fn declare(&self, text: &mut String, layer: usize) {
        let nominal = &self.frame.process;
        let process = nominal.at_layer(layer);
        if let Some(seam) = self.own_seam.as_ref().filter(|_| self.with_arc()) {
            text.push_str(&format!("  LOCAL PERS seamdata smLayer:=[{seam}];\r\n"));
        }
        for (i, &(speed, pace)) in self.speeds.iter().enumerate() {
            let speed = speed as f64 / 1000.0;
            let declaration = if self.with_arc() {
                let feed = pace.map_or(1.0, |pace| nominal.deposition_speed * 1000.0 / pace as f64);
                format!("LOCAL PERS welddata wd{}:={};", i + 1, data::weld(speed, feed, &process, nominal, &self.rapid))
            } else {
                format!("LOCAL CONST speeddata vd{}:={};", i + 1, data::speed(speed, &self.rapid))
            };
            text.push_str(&format!("  {declaration}\r\n"));
            if let Some(weave) = self.weave.as_ref().filter(|_| self.with_arc()) {
                let data = data::weave(&weave.at_layer(layer), speed);
                text.push_str(&format!("  LOCAL PERS weavedata wv{}:={data};\r\n", i + 1));
            }
        }
    }

    /// Number of the data for a speed at the current wire feed, from 1.
    fn number(&self, speed: f64) -> usize {
        let wanted = self.datum(speed, self.frame.feed);
        self.speeds.iter().position(|&s| s == wanted).map_or(1, |i| i + 1)
    }

    /// `word target,between,zone,tool\WObj:=wobj;`
    fn motion(&self, text: &mut String, word: &str, to: DVec3, between: &str, blend: bool) {
        self.motion_over(text, word, None, to, between, blend);
    }

    /// The same along an arc, with its via point before the target: `word via,target,…;`
    fn motion_over(&self, text: &mut String, word: &str, via: Option<DVec3>, to: DVec3, between: &str, blend: bool) {
        let zone = if blend && self.rapid.zone > 0.0 { "zBead" } else { "fine" };
        text.push_str("    ");
        text.push_str(word);
        text.push(' ');
        if let Some(via) = via {
            data::push_target(text, via, &self.orientation, &self.axes);
            text.push(',');
        }
        data::push_target(text, to, &self.orientation, &self.axes);
        text.push_str(&format!(",{between},{zone},{}\\WObj:={};\r\n", self.rapid.tool, self.rapid.wobj));
    }

    /// Moves the torch home.
    fn home(&self, text: &mut String) {
        statement(text, &format!("MoveAbsJ jHome,vHome,fine,{}\\WObj:={};", self.rapid.tool, self.rapid.wobj));
    }

    /// Moves to the start of a pass and strikes the arc, with the data of the first piece.
    fn arc_start(&self, text: &mut String, before: Option<&Instruction>, next: Option<&Instruction>) {
        if let (Some(to), Some(&Instruction::Weld { speed, .. })) = (before.and_then(Instruction::target), next) {
            self.motion(text, "ArcLStart", to, &self.arc_data(self.number(speed)), false);
        }
    }

    /// The data of a move with the arc on: the welddata with this number, and the weavedata if the torch weaves.
    fn arc_data(&self, number: usize) -> String {
        let weave = self.weave.as_ref().map(|_| format!("\\Weave:=wv{number}"));
        let seam = if self.own_seam.is_some() { "smLayer" } else { "smBead" };
        format!("vTravel,{seam},wd{number}{}", weave.unwrap_or_default())
    }

    /// The lines of `main` that run a layer.
    fn run(&self, module: &str, routine: &str) -> String {
        let mut text = String::new();
        let file = format!("{}/{module}.mod", self.rapid.folder);
        let load = self.rapid.modules == RapidModules::Load;
        if load {
            // The module may still be loaded after a stop, and Load would refuse it (ERR_LOADED).
            statement(&mut text, &format!("IF ModExist(\"{module}\") EraseModule \"{module}\";"));
            statement(&mut text, &format!("Load \\Dynamic,\"{file}\";"));
        }
        statement(&mut text, &format!("%\"{module}:{routine}\"%;"));
        if load {
            statement(&mut text, &format!("UnLoad \"{file}\";"));
        }
        text
    }
}

impl AbbRapid {
    /// The data declared by the profile's subprograms, which RAPID requires before all routines, and the subprograms.
    fn behind_main(&self) -> (Vec<String>, Vec<String>) {
        let (mut data, mut routines) = (Vec::new(), Vec::new());
        let Frame { lines, values, .. } = &self.frame;
        for lines in [&lines.hooks.watch_routines, &lines.routines] {
            let lines: Vec<String> = values.expand(lines).collect();
            let begins = |line: &String| ROUTINES.iter().any(|word| line.trim_start().starts_with(word));
            let first = lines.iter().position(begins).unwrap_or(lines.len());
            data.extend_from_slice(&lines[..first]);
            routines.extend_from_slice(&lines[first..]);
        }
        (data, routines)
    }

    /// The data of the main module.
    fn declarations(&self, text: &mut String) {
        let Frame { program, travel_speed, layers, .. } = &self.frame;
        if program.restart {
            text.push_str(&format!("  ! {}\r\n  PERS num {START}:=0;\r\n", restart::comment(START)));
        }
        if program.layer_offsets {
            let zeros = vec!["0"; *layers].join(",");
            text.push_str("  ! mm to be added to the height of each layer\r\n");
            text.push_str(&format!("  PERS num nDz{{{layers}}}:=[{zeros}];\r\n"));
        }
        let home = data::external_axes(program, program.first_angles(), &self.rapid);
        let seam = self.with_arc().then_some(self.seam.as_str());
        for line in data::declarations(*travel_speed, &self.rapid, seam, self.table(), &home) {
            text.push_str(&format!("  {line}\r\n"));
        }
        self.behind_main().0.iter().for_each(|line| text.push_str(&format!("  {line}\r\n")));
    }
}

impl Syntax for AbbRapid {
    type Text = String;

    fn frame(&self) -> &Frame {
        &self.frame
    }

    fn frame_mut(&mut self) -> &mut Frame {
        &mut self.frame
    }

    fn longest_name(&self, digits: usize) -> usize {
        names::MAX_NAME - SUFFIX - digits
    }

    fn most_moves(&self) -> usize {
        self.rapid.max_points
    }

    fn begin_main(&mut self) -> Vec<Chunk> {
        let mut text = format!("MODULE {}\r\n", self.frame.name);
        text.push_str(&format!("  ! {}\r\n", self.frame.comment));
        self.frame.supplies.iter().for_each(|line| text.push_str(&format!("  ! {line}\r\n")));
        self.declarations(&mut text);
        text.push_str("  PROC main()\r\n");
        // The robot chooses the posture nearest to its current one: configurations are unknown here.
        statement(&mut text, "ConfL \\Off;");
        statement(&mut text, "ConfJ \\Off;");
        statement(&mut text, "SingArea \\Wrist;");
        // The torch keeps its orientation in the part's frame, also along arcs.
        statement(&mut text, "CirPathMode \\ObjectFrame;");
        self.units(&mut text);
        self.home(&mut text);
        frame::start(self, &mut text);
        let head = "<?xml version=\"1.0\" encoding=\"ISO-8859-1\" ?>\r\n<Program>\r\n";
        let list = self.pgf(format!("{head}  <Module>{}.mod</Module>\r\n", self.frame.name));
        [self.main(text)].into_iter().chain(list).collect()
    }

    fn end_main(&mut self) -> Vec<Chunk> {
        let mut text = String::new();
        if self.frame.program.layer_offsets {
            statement(&mut text, "PDispOff;");
        }
        frame::end(self, &mut text);
        self.home(&mut text);
        text.push_str("  ENDPROC\r\n");
        self.behind_main().1.iter().for_each(|line| text.push_str(&format!("  {line}\r\n")));
        text.push_str("ENDMODULE\r\n");
        [self.main(text)].into_iter().chain(self.pgf("</Program>\r\n".to_owned())).collect()
    }

    fn begin_layer(&mut self, program: &LayerProgram) {
        self.frame.feed = 1.0;
        self.speeds = self.speeds_of(program);
        let own = seam(&self.rapid, &self.ends, &self.frame.process, Some(program.index));
        self.own_seam = (own != self.seam).then_some(own);
    }

    /// The module, and its line in the list of modules.
    fn part(&mut self, part: &Part, moves: &[Instruction]) -> Vec<Chunk> {
        let (module, routine, layer) = (self.name_of(part), routine(part), part.layer + 1);
        let mut text = format!("MODULE {module}\r\n  ! {}\r\n", self.frame.comment);
        text.reserve(moves.len() * 150);
        self.declare(&mut text, part.layer);
        text.push_str(&format!("  PROC {routine}()\r\n    ! layer {layer}, z {} mm\r\n", fixed(part.z, 3)));
        if self.frame.program.layer_offsets {
            statement(&mut text, &format!("PDispSet [[0,0,nDz{{{layer}}}],[1,0,0,0]];"));
        }
        frame::body(self, &mut text, part, moves);
        text.push_str("  ENDPROC\r\nENDMODULE\r\n");
        let listed = self.rapid.modules == RapidModules::Call;
        let list = listed.then(|| self.pgf(format!("  <Module>{module}.mod</Module>\r\n"))).flatten();
        [Chunk { file: format!("{module}.mod"), text }].into_iter().chain(list).collect()
    }

    fn call(&mut self, part: &Part) -> Vec<Chunk> {
        vec![self.main(self.run(&self.name_of(part), &routine(part)))]
    }

    fn line(&mut self, text: &mut String, line: &str) {
        statement(text, line);
    }

    fn settle(&mut self, text: &mut String) {
        statement(text, "WaitTime \\InPos,0;");
    }

    fn begin_skippable(&mut self, text: &mut String, what: Skippable) {
        statement(text, &format!("IF {START}<={} THEN", what.number()));
    }

    fn end_skippable(&mut self, text: &mut String) {
        statement(text, "ENDIF");
    }

    fn begin_way(&mut self, text: &mut String, _number: usize, above: DVec3) {
        statement(text, &format!("IF {START}>0 THEN"));
        self.approach(text, above);
        statement(text, &format!("{START}:=0;"));
        statement(text, "ELSE");
    }

    fn stand(&mut self, attitude: Attitude) {
        self.orientation = data::quaternion(&orientation::quaternion(self.rapid.orientation, Turn::Attitude(attitude)));
        if let Some(held) = attitude.held {
            self.axes = data::external_axes(&self.frame.program, Some(held.angles), &self.rapid);
        }
    }

    /// RobotWare Arc: its instructions strike and end the arc; its data set the wire feed and fill craters.
    fn by_package(&mut self, text: &mut String, moves: &[Instruction], at: usize) -> bool {
        if !self.with_arc() {
            return false;
        }
        match moves[at] {
            // ArcLStart moves there itself.
            Instruction::Travel { .. } if matches!(moves.get(at + 1), Some(Instruction::ArcOn { .. })) => {}
            Instruction::ArcOn { pass, kind } => {
                self.pass(text, pass, kind);
                self.arc_start(text, at.checked_sub(1).map(|before| &moves[before]), moves.get(at + 1));
            }
            Instruction::WireFeed { .. } | Instruction::Crater { .. } => {}
            Instruction::ArcOff { .. } => {
                if self.frame.process.arc_end_delay > 0.0 {
                    self.wait(text, self.frame.process.arc_end_delay);
                }
            }
            _ => return false,
        }
        true
    }

    fn approach(&mut self, text: &mut String, to: DVec3) {
        self.motion(text, "MoveJ", to, "vHome", false);
    }

    fn travel(&mut self, text: &mut String, to: DVec3) {
        self.motion(text, "MoveL", to, "vTravel", false);
    }

    fn pass(&mut self, text: &mut String, pass: usize, kind: PassKind) {
        statement(text, &format!("! pass {pass} {}", kind.name()));
    }

    fn weld(&mut self, text: &mut String, piece: Piece, _next: &[Instruction]) {
        let (via, number) = (piece.circle.map(|circle| circle.via), self.number(piece.speed));
        let (word, between) = match (self.with_arc(), via.is_some()) {
            (true, false) => (if piece.last { "ArcLEnd" } else { "ArcL" }, self.arc_data(number)),
            (true, true) => (if piece.last { "ArcCEnd" } else { "ArcC" }, self.arc_data(number)),
            (false, false) => ("MoveL", format!("vd{number}")),
            (false, true) => ("MoveC", format!("vd{number}")),
        };
        self.motion_over(text, word, via, piece.to, &between, !piece.last);
    }

    fn wait(&mut self, text: &mut String, seconds: f64) {
        statement(text, &format!("WaitTime \\InPos,{};", fixed(seconds, 3)));
    }

    fn weaves(&self) -> bool {
        self.weave.is_some() && self.with_arc()
    }
}

/// The routine of a part of a layer.
fn routine(part: &Part) -> String {
    format!("Layer{}", part.number)
}

/// The seamdata of the layer with this index, or those of the program. Where `[start_stop]` fills craters or draws the wire back, it
/// replaces the section's seam.
fn seam(rapid: &Rapid, ends: &StartStop, nominal: &Process, layer: Option<usize>) -> String {
    let of_layer = layer.map(|layer| (ends.at_layer(layer), nominal.at_layer(layer)));
    let (own, process) = of_layer.unwrap_or_else(|| (ends.clone(), nominal.clone()));
    let mut seam = rapid.seam.clone();
    if ends.fills_craters() {
        (seam.fill_time, seam.fill_feed) = (own.crater_fill_time, own.crater_power);
    }
    if own.wire_retract > 0.0 {
        seam.rollback_time = retract_time(&own, nominal);
    }
    data::seam(&process, nominal, rapid, &seam)
}

/// A statement of a routine on its own line.
fn statement(text: &mut String, line: &str) {
    text.push_str("    ");
    text.push_str(line);
    text.push_str("\r\n");
}
