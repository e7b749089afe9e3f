//! ABB RAPID for IRC5 (RobotWare 6): `NAME.mod` holds the cell's data and `main`, `NAME_L001.mod` and so on hold one
//! layer each, and `NAME.pgf` lists the modules to be loaded.
//!
//! With RobotWare Arc a pass is `ArcLStart … fine`, `ArcL … zBead`, `ArcLEnd … fine`; without it, plain `MoveL` between
//! lines that the profile gives. While welding, the welddata set the speed: speeds are rounded to the nominal one plus
//! or minus whole multiples of `speed_step`, and each layer declares the few it uses, `LOCAL` to its module.

use super::section::{Rapid, RapidArc, RapidModules};
use super::{data, names};
use crate::dialect::writing::orientation::{self, Turn};
use crate::dialect::writing::{Chunk, Job, Values, Writer, crater_lines, restart, split};
use crate::number::fixed;
use crate::program::{Instruction, LayerProgram, ProgramSettings, Weave};
use bead_plan::layer::Extent;
use bead_plan::process::Process;
use bead_plan::weld::retract_time;
use glam::DVec3;

/// Comments are wrapped at this many characters.
const MAX_COMMENT: usize = 76;

/// Where to begin.
const START: &str = "nStart";

/// Words with which subprograms begin.
const ROUTINES: [&str; 5] = ["PROC ", "TRAP ", "FUNC ", "LOCAL PROC ", "LOCAL TRAP "];

/// Writes RAPID.
pub(super) struct AbbRapid {
    name: String,
    comment: String,
    supplies: Vec<String>,
    rapid: Rapid,
    program: ProgramSettings,
    weave: Option<Weave>,
    process: Process,
    values: Values,
    travel_speed: f64,
    orientation: String,
    /// External axes of targets.
    axes: String,
    digits: usize,
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
        let comment = job.comment();
        let values = Values::new(&name, job);
        let rapid = with_ends(rapid, job);
        let orientation = data::quaternion(&rapid.orientation);
        let axes = data::external_axes(job.program, job.program.table_angle, &rapid);
        let (process, travel_speed) = (job.weld.process.clone(), job.weld.travel.speed);
        let (supplies, program, weave) = (job.supplies(MAX_COMMENT), job.program.clone(), job.weave.cloned());
        Self {
            name,
            comment,
            supplies,
            rapid,
            program,
            weave,
            process,
            values,
            travel_speed,
            orientation,
            axes,
            digits: 3,
        }
    }

    fn numbered(&self, prefix: &str, index: usize) -> String {
        format!("{prefix}{:0digits$}", index + 1, digits = self.digits)
    }

    fn with_arc(&self) -> bool {
        self.rapid.arc == RapidArc::Instructions
    }

    /// The module for one part of a layer (`part` counts from 0; `last` if no other follows), with the lines that run it.
    fn module(
        &mut self,
        program: &LayerProgram,
        (part, last): (usize, bool),
        moves: &[Instruction],
        speeds: &Speeds,
        feed: &mut f64,
    ) -> Vec<Chunk> {
        let more = if part == 0 { String::new() } else { format!("_{}", part + 1) };
        let named = |prefix: &str| format!("{}{more}", self.numbered(prefix, program.index));
        let (module, routine) = (named(&format!("{}_L", self.name)), named("Layer"));
        let mut text = format!("MODULE {module}\r\n  ! {}\r\n", self.comment);
        text.reserve(moves.len() * 150);
        let z = fixed(program.z, 3);
        self.declare(&mut text, program.index, speeds);
        text.push_str(&format!("  PROC {routine}()\r\n    ! layer {}, z {z} mm\r\n", program.index + 1));
        if self.program.layer_offsets {
            let shift = format!("PDispSet [[0,0,nDz{{{}}}],[1,0,0,0]];", program.index + 1);
            statement(&mut text, &shift);
        }
        if part == 0 {
            let lines = self.rapid.hooks.before_layer(&self.rapid.layer_start, program.index, &self.program);
            self.skippable(&mut text, self.values.last_number(), &lines);
        }
        self.instructions(&mut text, moves, speeds, feed);
        if last {
            self.skippable(&mut text, self.values.last_number(), &self.rapid.hooks.layer_end);
        }
        text.push_str("  ENDPROC\r\nENDMODULE\r\n");
        let listed = self.rapid.modules == RapidModules::Call;
        let list = listed.then(|| self.pgf(format!("  <Module>{module}.mod</Module>\r\n"))).flatten();
        let run = self.main(self.run(&module, &routine));
        [run, Chunk { file: format!("{module}.mod"), text }].into_iter().chain(list).collect()
    }

    fn main(&self, text: String) -> Chunk {
        Chunk { file: format!("{}.mod", self.name), text }
    }

    fn pgf(&self, text: String) -> Option<Chunk> {
        self.rapid.pgf.then(|| Chunk { file: format!("{}.pgf", self.name), text })
    }

    fn lines(&self, text: &mut String, template: &[String]) {
        self.values.expand(template).for_each(|line| statement(text, &line));
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
            statement(text, &format!("IF {START}<={number} THEN"));
        }
    }

    fn end_skippable(&self, text: &mut String) {
        if self.program.restart {
            statement(text, "ENDIF");
        }
    }

    /// Begins a pass: a program that begins at it comes from anywhere, others by the moves that follow.
    fn pass_start(&mut self, text: &mut String, pass: usize, above: DVec3) {
        let number = self.values.set_pass(pass);
        self.begin_skippable(text, number);
        if self.program.restart {
            statement(text, &format!("IF {START}>0 THEN"));
            self.motion(text, "MoveJ", above, "vHome", false);
            statement(text, &format!("{START}:=0;"));
            statement(text, "ELSE");
        }
    }

    /// The torch is above the start of the pass, whichever way it came.
    fn above(&self, text: &mut String) {
        self.end_skippable(text);
        self.hook(text, &self.rapid.hooks.pass_start);
    }

    /// The mechanical unit that turns under the part, if there is one.
    fn table(&self) -> Option<&str> {
        self.rapid.table_unit.as_deref().filter(|_| self.program.has_table())
    }

    /// Activates the units that move along, and refuses a work object of the controller that does not turn with the table.
    fn units(&self, text: &mut String) {
        let track = self.rapid.track_unit.as_deref().filter(|_| self.program.linear_axis.is_some());
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

    /// Lines for when the torch stands still, if there are any.
    fn hook(&self, text: &mut String, lines: &[String]) {
        if !lines.is_empty() {
            self.switch(text, lines);
        }
    }

    /// The speed as it is written, thousandths of a mm/s: the nominal one plus or minus whole steps.
    fn rounded(&self, speed: f64) -> u64 {
        let (nominal, step) = (self.process.deposition_speed, self.rapid.speed_step);
        let near = nominal + ((speed - nominal) / step).round() * step;
        let written = if near >= 1e-3 { near } else { speed };
        (written * 1000.0).round().max(1.0) as u64
    }

    /// The data for a speed and the fraction `feed` of the nominal wire feed; plain moves set no wire feed.
    fn datum(&self, speed: f64, feed: f64) -> Datum {
        let pace = self.process.deposition_speed / feed;
        (self.rounded(speed), (self.with_arc() && feed != 1.0).then(|| self.rounded(pace)))
    }

    fn speeds(&self, program: &LayerProgram) -> Speeds {
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

    fn declare(&self, text: &mut String, layer: usize, speeds: &Speeds) {
        let process = self.process.at_layer(layer);
        for (i, &(speed, pace)) in speeds.iter().enumerate() {
            let speed = speed as f64 / 1000.0;
            let declaration = if self.with_arc() {
                let feed = pace.map_or(1.0, |pace| self.process.deposition_speed * 1000.0 / pace as f64);
                format!(
                    "LOCAL PERS welddata wd{}:={};",
                    i + 1,
                    data::weld(speed, feed, &process, &self.process, &self.rapid)
                )
            } else {
                format!("LOCAL CONST speeddata vd{}:={};", i + 1, data::speed(speed, &self.rapid))
            };
            text.push_str(&format!("  {declaration}\r\n"));
            if let Some(weave) = self.weave.as_ref().filter(|_| self.with_arc()) {
                let data = data::weave(weave, speed);
                text.push_str(&format!("  LOCAL PERS weavedata wv{}:={data};\r\n", i + 1));
            }
        }
    }

    /// Number of the data for a speed and a wire feed, from 1.
    fn number(&self, speeds: &Speeds, speed: f64, feed: f64) -> usize {
        let wanted = self.datum(speed, feed);
        speeds.iter().position(|&s| s == wanted).map_or(1, |i| i + 1)
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

    /// `feed` is the fraction of the nominal wire feed that was set last.
    fn instructions(&mut self, text: &mut String, all: &[Instruction], speeds: &Speeds, feed: &mut f64) {
        for (i, &instruction) in all.iter().enumerate() {
            if let Some(attitude) = instruction.attitude() {
                self.orientation =
                    data::quaternion(&orientation::quaternion(self.rapid.orientation, Turn::Attitude(attitude)));
                if attitude.table.is_some() {
                    self.axes = data::external_axes(&self.program, attitude.table, &self.rapid);
                }
            }
            match (instruction, all.get(i + 1)) {
                // ArcLStart itself moves there.
                (Instruction::Travel { .. }, Some(Instruction::ArcOn { .. })) if self.with_arc() => {}
                (Instruction::Approach { to }, _) => self.motion(text, "MoveJ", to, "vHome", false),
                (Instruction::Travel { to } | Instruction::Retract { to }, _) => {
                    self.motion(text, "MoveL", to, "vTravel", false)
                }
                (Instruction::ArcOn { pass, kind }, next) => {
                    statement(text, &format!("! pass {pass} {}", kind.name()));
                    let before = i.checked_sub(1).and_then(|before| all.get(before));
                    let first = next.and_then(|next| match *next {
                        Instruction::Weld { speed, .. } => Some(self.number(speeds, speed, *feed)),
                        _ => None,
                    });
                    self.arc_on(text, before, first);
                }
                (Instruction::WireFeed { ratio }, _) => {
                    *feed = ratio;
                    self.wire_feed(text, ratio);
                }
                (Instruction::Weld { to, circle, speed, last, .. }, _) => {
                    self.weld(text, circle.map(|c| c.via), to, self.number(speeds, speed, *feed), last);
                }
                // The seamdata fill the crater.
                (Instruction::Crater { .. }, _) if self.with_arc() => {}
                (Instruction::Crater { seconds, ratio }, _) => {
                    if let Some(ratio) = ratio {
                        self.values.set_wire_feed(ratio, self.process.wire_feed_speed);
                        self.switch(text, crater_lines(&self.rapid.crater, &self.rapid.wire_feed));
                    }
                    wait(text, seconds);
                }
                (Instruction::Dwell { seconds }, _) => wait(text, seconds),
                (Instruction::PassStart { pass, above, .. }, _) => self.pass_start(text, pass, above),
                (Instruction::Above, _) => self.above(text),
                (Instruction::Turn { .. }, _) => {}
                (Instruction::PassEnd, _) => {
                    self.hook(text, &self.rapid.hooks.pass_end);
                    self.end_skippable(text);
                }
                (Instruction::ArcOff { .. }, _) => self.arc_off(text),
            }
        }
    }

    /// Strikes the arc where the previous travel ended, with the data of the first piece.
    fn arc_on(&self, text: &mut String, before: Option<&Instruction>, first: Option<usize>) {
        if !self.with_arc() {
            self.switch(text, &self.rapid.arc_on);
            self.lines(text, &self.rapid.hooks.arc_established);
        } else if let (Some(to), Some(number)) = (before.and_then(Instruction::target), first) {
            let between = format!("vTravel,smBead,{}", self.weld_data(number));
            self.motion(text, "ArcLStart", to, &between, false);
        }
    }

    fn weld(&self, text: &mut String, via: Option<DVec3>, to: DVec3, number: usize, last: bool) {
        let with_data = || format!("vTravel,smBead,{}", self.weld_data(number));
        let (word, between) = match (self.with_arc(), via.is_some(), last) {
            (true, false, false) => ("ArcL", with_data()),
            (true, false, true) => ("ArcLEnd", with_data()),
            (true, true, false) => ("ArcC", with_data()),
            (true, true, true) => ("ArcCEnd", with_data()),
            (false, false, _) => ("MoveL", format!("vd{number}")),
            (false, true, _) => ("MoveC", format!("vd{number}")),
        };
        self.motion_over(text, word, via, to, &between, !last);
    }

    /// The welddata with this number, and the weavedata where the torch swings.
    fn weld_data(&self, number: usize) -> String {
        let weave = self.weave.as_ref().map(|_| format!("\\Weave:=wv{number}"));
        format!("wd{number}{}", weave.unwrap_or_default())
    }

    fn arc_off(&self, text: &mut String) {
        if !self.with_arc() {
            self.hook(text, &self.rapid.hooks.before_arc_off);
            self.switch(text, &self.rapid.arc_off);
        } else if self.process.arc_end_delay > 0.0 {
            statement(text, &format!("WaitTime \\InPos,{};", fixed(self.process.arc_end_delay, 3)));
        }
    }

    /// The welddata hold the wire feed; without them lines of the profile set it.
    fn wire_feed(&mut self, text: &mut String, ratio: f64) {
        if !self.with_arc() {
            self.values.set_wire_feed(ratio, self.process.wire_feed_speed);
            self.lines(text, &self.rapid.wire_feed);
        }
    }

    /// Lines that switch the arc, once the torch stands still: RAPID runs ahead of the robot.
    fn switch(&self, text: &mut String, template: &[String]) {
        statement(text, "WaitTime \\InPos,0;");
        self.lines(text, template);
    }

    /// The lines of `main` that run a layer.
    fn run(&self, module: &str, routine: &str) -> String {
        let mut text = String::new();
        let file = format!("{}/{module}.mod", self.rapid.folder);
        let load = self.rapid.modules == RapidModules::Load;
        if load {
            // After a stop the module may still be there, and Load would refuse (ERR_LOADED).
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
    /// The data that the profile's subprograms declare, which RAPID requires before all routines, and the subprograms.
    fn behind_main(&self) -> (Vec<String>, Vec<String>) {
        let (mut data, mut routines) = (Vec::new(), Vec::new());
        for lines in [&self.rapid.hooks.watch_routines, &self.rapid.routines] {
            let lines: Vec<String> = self.values.expand(lines).collect();
            let begins = |line: &String| ROUTINES.iter().any(|word| line.trim_start().starts_with(word));
            let first = lines.iter().position(begins).unwrap_or(lines.len());
            data.extend_from_slice(&lines[..first]);
            routines.extend_from_slice(&lines[first..]);
        }
        (data, routines)
    }
}

impl Writer for AbbRapid {
    fn weaves(&self) -> bool {
        self.weave.is_some() && self.with_arc()
    }

    fn begin(&mut self, extent: &Extent) -> Vec<Chunk> {
        self.digits = extent.layers.to_string().len().max(3);
        self.values.set("layers", extent.layers);
        // Room for "_L" and the number, and for that of a part: "_999".
        self.name.truncate(names::MAX_NAME - 2 - self.digits - 4);
        let mut text = format!("MODULE {}\r\n", self.name);
        text.push_str(&format!("  ! {}\r\n", self.comment));
        self.supplies.iter().for_each(|line| text.push_str(&format!("  ! {line}\r\n")));
        if self.program.restart {
            text.push_str(&format!("  ! {}\r\n  PERS num {START}:=0;\r\n", restart::comment(START)));
        }
        if self.program.layer_offsets {
            let zeros = vec!["0"; extent.layers].join(",");
            text.push_str("  ! mm to be added to the height of each layer\r\n");
            text.push_str(&format!("  PERS num nDz{{{}}}:=[{zeros}];\r\n", extent.layers));
        }
        let standing = self.program.table_angle.or(self.program.table_side.map(|_| 0.0));
        let (arc, home) = (self.with_arc(), data::external_axes(&self.program, standing, &self.rapid));
        for line in data::declarations(&self.process, self.travel_speed, &self.rapid, arc, self.table(), &home) {
            text.push_str(&format!("  {line}\r\n"));
        }
        self.behind_main().0.iter().for_each(|line| text.push_str(&format!("  {line}\r\n")));
        text.push_str("  PROC main()\r\n");
        // The robot chooses the posture nearest to the one that it has: configurations are unknown here.
        statement(&mut text, "ConfL \\Off;");
        statement(&mut text, "ConfJ \\Off;");
        statement(&mut text, "SingArea \\Wrist;");
        // The torch is held in the part's frame, along arcs too.
        statement(&mut text, "CirPathMode \\ObjectFrame;");
        self.units(&mut text);
        self.home(&mut text);
        self.lines(&mut text, &self.rapid.start);
        self.lines(&mut text, &self.rapid.hooks.watch);
        let head = "<?xml version=\"1.0\" encoding=\"ISO-8859-1\" ?>\r\n<Program>\r\n";
        let list = self.pgf(format!("{head}  <Module>{}.mod</Module>\r\n", self.name));
        [self.main(text)].into_iter().chain(list).collect()
    }

    fn layer(&mut self, program: &LayerProgram) -> Vec<Chunk> {
        if program.instructions.is_empty() {
            return Vec::new();
        }
        self.values.set_layer(program);
        let speeds = self.speeds(program);
        let parts = split::passes(&program.instructions, self.rapid.max_points);
        let (mut feed, count) = (1.0, parts.len());
        let module = |(part, moves)| self.module(program, (part, part + 1 == count), moves, &speeds, &mut feed);
        parts.into_iter().enumerate().flat_map(module).collect()
    }

    fn end(&mut self) -> Vec<Chunk> {
        let mut text = String::new();
        if self.program.layer_offsets {
            statement(&mut text, "PDispOff;");
        }
        self.lines(&mut text, &self.rapid.hooks.all_off);
        self.lines(&mut text, &self.rapid.end);
        self.home(&mut text);
        text.push_str("  ENDPROC\r\n");
        self.behind_main().1.iter().for_each(|line| text.push_str(&format!("  {line}\r\n")));
        text.push_str("ENDMODULE\r\n");
        [self.main(text)].into_iter().chain(self.pgf("</Program>\r\n".to_owned())).collect()
    }
}

fn wait(text: &mut String, seconds: f64) {
    statement(text, &format!("WaitTime \\InPos,{};", fixed(seconds, 3)));
}

/// Crater filling and wire retraction at the end of a seam as the section `start_stop` sets them, where it does.
fn with_ends(mut rapid: Rapid, job: &Job<'_>) -> Rapid {
    let ends = &job.weld.ends;
    if ends.crater_fill_time > 0.0 {
        (rapid.seam.fill_time, rapid.seam.fill_feed) = (ends.crater_fill_time, ends.crater_power);
    }
    if ends.wire_retract > 0.0 {
        rapid.seam.rollback_time = retract_time(ends, &job.weld.process);
    }
    rapid
}

/// A statement of a routine on its own line.
fn statement(text: &mut String, line: &str) {
    text.push_str("    ");
    text.push_str(line);
    text.push_str("\r\n");
}
