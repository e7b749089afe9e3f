//! Writes Yaskawa INFORM (DX200, YRC1000): `NAME.jbi` calls `NAME-L001.jbi` and so on, relative jobs in a user frame; a
//! long layer continues in `NAME-L001-2.jbi`.
//!
//! Every move has its own position, and NPOS counts them. Three MOVC make an arc; the first is at the arc's start, so
//! the robot does not move for it. To the controller, consecutive MOVC are one chain, so a MOVL to the shared point
//! separates an arc from the next.
//!
//! With a station under the part, robot and station move together: `SMOVL C00003 V=11.0  +MOVJ EC00003`, as a DX200
//! exports it (rpiRobotics/dx200_motion_progam_exec, `example_inform/R1-S1-SAMPLE.JBI`). Straight on the part is
//! then straight to the controller. Positions are on the part or in the cell, as the profile says of the user frame.

use super::section::{Inform, InformSpeed};
use crate::dialect::writing::frame::{self, Frame, Part, Piece, Skippable, Syntax};
use crate::dialect::writing::in_cell::InCell;
use crate::dialect::writing::orientation::{self, Turn};
use crate::dialect::writing::{Chunk, Job, ascii, upper_name, waits};
use crate::number::fixed;
use crate::program::{Attitude, Instruction, Weave};
use bead_plan::pass::PassKind;
use glam::DVec3;
use std::fmt::Write as _;

/// Most characters of a comment.
const MAX_COMMENT: usize = 32;

/// Longest wait of one timer, s.
const MAX_WAIT: f64 = 600.0;

/// Characters reserved for `-L`, and for the number of a split layer (which short names omit if they can).
const SUFFIX: usize = 2;

/// Writes INFORM.
pub(super) struct YaskawaInform {
    frame: Frame,
    inform: Inform,
    weave: Option<Weave>,
    /// Rx, Ry, Rz of the torch, °.
    orientation: [f64; 3],
    /// Where the station holds the part, if the user frame does not turn with it.
    in_cell: Option<InCell>,
    /// Angles of the station, °; unused ones are ignored.
    turned: Option<[f64; 2]>,
    main: JobText,
    at: DVec3,
    /// Whether the last move was along an arc.
    in_arc: bool,
    /// Labels where open branches end.
    open: Vec<usize>,
}

/// Positions and instructions of one job.
#[derive(Default)]
pub(super) struct JobText {
    positions: String,
    /// Positions of the station, one for each of the robot's; empty without one.
    stations: String,
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
        let frame = Frame::new(job, upper_name(&job.part), MAX_COMMENT, &inform);
        let fixed = inform.frame_turns == Some(false);
        Self {
            in_cell: fixed.then(|| InCell::new(job.program.positioner.as_ref())),
            turned: job.program.first_angles(),
            frame: Frame { comment: ascii(&job.part), ..frame },
            orientation: inform.orientation,
            inform,
            weave: job.weave(),
            main: JobText::default(),
            at: DVec3::ZERO,
            in_arc: false,
            open: Vec::new(),
        }
    }

    /// The height added to a layer, set in its job, µm; all moves up to SFTOF are shifted by it.
    fn offset(&self, job: &mut JobText) {
        if self.frame.program.layer_offsets {
            let (variable, frame) = (self.inform.offset_variable, self.inform.user_frame);
            job.line("'UM ADDED TO THIS LAYER");
            job.line(&format!("SUB P{variable:03} P{variable:03}"));
            job.line(&format!("SETE P{variable:03} (3) 0"));
            job.line(&format!("SFTON P{variable:03} UF#({frame})"));
        }
    }

    fn offset_end(&self, job: &mut JobText) {
        if self.frame.program.layer_offsets {
            job.line("SFTOF");
        }
    }

    /// The control group of the station, if it turns the part.
    fn station(&self) -> Option<&str> {
        self.inform.station.as_deref().filter(|_| self.frame.program.has_table())
    }

    /// Adds a position in the user frame and returns its number.
    fn pose(&self, job: &mut JobText, to: DVec3) -> usize {
        let to = self.in_cell.map_or(to, |cell| cell.place(to));
        let [x, y, z] = to.to_array().map(|v| fixed(v, 3));
        let [rx, ry, rz] = self.orientation.map(|v| fixed(v, 4));
        let _ = write!(job.positions, "C{:05}={x},{y},{z},{rx},{ry},{rz}\r\n", job.count);
        self.turn(job, self.turned);
        job.count += 1;
        job.count - 1
    }

    /// Adds the station's position beside the robot's.
    fn turn(&self, job: &mut JobText, angles: Option<[f64; 2]>) {
        let Some(angles) = angles.filter(|_| self.station().is_some()) else { return };
        let pulses = self.inform.station_pulses.unwrap_or([1.0; 2]);
        let axes = angles.iter().zip(pulses).take(self.frame.program.turning_axes());
        let pulses: Vec<String> = axes.map(|(angle, pulses)| fixed(angle * pulses, 0)).collect();
        let _ = write!(job.stations, "EC{:05}={}\r\n", job.count, pulses.join(","));
    }

    /// A move of the joints to a position, and of the station with them.
    fn joints(&self, position: usize, end: &str) -> String {
        let speed = format!("VJ={}", fixed(self.inform.home_speed, 2));
        let station = self.station().map_or(String::new(), |_| format!("  +MOVJ EC{position:05} {speed}"));
        format!("MOVJ C{position:05} {speed}{end}{station}")
    }

    fn speed(&self, speed: f64) -> String {
        let (value, least) = match self.inform.speed {
            InformSpeed::MillimetresPerSecond => (speed.min(1500.0), 0.1),
            InformSpeed::CentimetresPerMinute => (speed.min(1500.0) * 6.0, 1.0),
        };
        format!("V={}", fixed(value.max(least), 1))
    }

    fn motion(&mut self, job: &mut JobText, word: &str, to: DVec3, speed: f64, level: u32) {
        let position = self.pose(job, to);
        let (together, station) = match self.station() {
            Some(_) => ("S", format!("  +MOVJ EC{position:05}")),
            None => ("", String::new()),
        };
        job.line(&format!("{together}{word} C{position:05} {} PL={level}{station}", self.speed(speed)));
        (self.at, self.in_arc) = (to, word == "MOVC");
    }

    /// Three MOVC from the current position.
    fn arc(&mut self, job: &mut JobText, via: DVec3, to: DVec3, speed: f64, level: u32) {
        let between = self.inform.position_level;
        if self.in_arc {
            self.motion(job, "MOVL", self.at, speed, between);
        }
        for (to, level) in [(self.at, between), (via, between), (to, level)] {
            self.motion(job, "MOVC", to, speed, level);
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
        let group = self.station().map_or(String::new(), |station| format!("///GROUP2 {station}\r\n"));
        // Positions of a station are never Cartesian.
        let pulses = if head.ends_with("///PULSE\r\n") { "" } else { "///POSTYPE PULSE\r\n///PULSE\r\n" };
        let (pulses, stations) = if job.stations.is_empty() { ("", 0) } else { (pulses, job.count) };
        let text = format!(
            "/JOB\r\n//NAME {name}\r\n//POS\r\n///NPOS {},0,{stations},0,0,0\r\n{head}{}{pulses}{}//INST\r\n\
             ///DATE {}\r\n///COMM {comment}\r\n///ATTR {attributes}\r\n///GROUP1 {}\r\n{group}NOP\r\n{}END\r\n",
            job.count, job.positions, job.stations, self.inform.date, self.inform.group, job.instructions
        );
        Chunk { file: format!("{name}.jbi"), text }
    }
}

impl Syntax for YaskawaInform {
    type Text = JobText;

    fn frame(&self) -> &Frame {
        &self.frame
    }

    fn frame_mut(&mut self) -> &mut Frame {
        &mut self.frame
    }

    fn longest_name(&self, digits: usize) -> usize {
        // If names may be longer, reserve space for split layers: "-L001-2".
        let more = if self.inform.max_name > 16 { 4 } else { 2 };
        (self.inform.max_name - SUFFIX - digits).saturating_sub(more).max(1)
    }

    fn most_moves(&self) -> usize {
        self.inform.max_points
    }

    fn name_of(&self, part: &Part) -> String {
        format!("{}-L{}", self.frame.name, part.number.replace('_', "-"))
    }

    /// The main job is written at its end, when its number of positions is known.
    fn begin_main(&mut self) -> Vec<Chunk> {
        let pulses = self.inform.home.map(|pulse| pulse.to_string()).join(",");
        let mut main = JobText::default();
        for _ in 0..2 {
            let _ = write!(main.positions, "C{:05}={pulses}\r\n", main.count);
            self.turn(&mut main, self.frame.program.first_angles());
            main.count += 1;
        }
        main.line(&self.joints(0, ""));
        self.frame.supplies.iter().for_each(|line| main.line(&format!("'{line}")));
        if self.frame.program.restart {
            main.line("'0, OR LAYER*10000+PASS");
            main.line(&format!("SET D{:03} 0", self.inform.restart_variable));
        }
        frame::start(self, &mut main);
        self.main = main;
        Vec::new()
    }

    fn end_main(&mut self) -> Vec<Chunk> {
        let mut main = std::mem::take(&mut self.main);
        frame::end(self, &mut main);
        main.line(&self.joints(1, ""));
        let head = format!("///TOOL {}\r\n///POSTYPE PULSE\r\n///PULSE\r\n", self.inform.tool);
        vec![self.file(&self.frame.name, &self.frame.comment, &head, "SC,RW", &main)]
    }

    fn part(&mut self, part: &Part, moves: &[Instruction]) -> Vec<Chunk> {
        let mut job = JobText::default();
        self.offset(&mut job);
        frame::body(self, &mut job, part, moves);
        self.offset_end(&mut job);
        let comment = format!("LAYER {} Z {}", part.layer + 1, fixed(part.z, 3));
        vec![self.relative(&self.name_of(part), &comment, &job)]
    }

    fn call(&mut self, part: &Part) -> Vec<Chunk> {
        self.main.line(&format!("CALL JOB:{}", self.name_of(part)));
        Vec::new()
    }

    fn line(&mut self, job: &mut JobText, line: &str) {
        job.line(line);
    }

    fn begin_skippable(&mut self, job: &mut JobText, what: Skippable) {
        let label = job.label();
        job.line(&format!("JUMP *L{label} IF D{:03}>{}", self.inform.restart_variable, what.number()));
        self.open.push(label);
    }

    fn end_skippable(&mut self, job: &mut JobText) {
        self.open.pop().into_iter().for_each(|label| job.line(&format!("*L{label}")));
    }

    fn begin_way(&mut self, job: &mut JobText, _number: usize, above: DVec3) {
        let (variable, label, behind) = (self.inform.restart_variable, job.label(), job.label());
        job.line(&format!("JUMP *L{label} IF D{variable:03}=0"));
        self.approach(job, above);
        job.line(&format!("SET D{variable:03} 0"));
        job.line(&format!("JUMP *L{behind}"));
        job.line(&format!("*L{label}"));
        self.open.push(behind);
    }

    fn stand(&mut self, attitude: Attitude) {
        self.turned = attitude.held.map(|held| held.angles).or(self.turned);
        let turn = self.in_cell.as_mut().map_or(Turn::Attitude(attitude), |cell| cell.stand(attitude));
        self.orientation = orientation::xyz(self.inform.orientation, turn);
    }

    fn approach(&mut self, job: &mut JobText, to: DVec3) {
        let position = self.pose(job, to);
        job.line(&self.joints(position, " PL=0"));
        (self.at, self.in_arc) = (to, false);
    }

    fn travel(&mut self, job: &mut JobText, to: DVec3) {
        self.motion(job, "MOVL", to, self.frame.travel_speed, 0);
    }

    fn pass(&mut self, job: &mut JobText, pass: usize, kind: PassKind) {
        job.line(&format!("'PASS {pass} {}", kind.name().to_uppercase()));
    }

    fn begin_weave(&mut self, job: &mut JobText) {
        let own = self.weave.iter().map(|weave| weave.at_layer(self.frame.layer).file);
        own.for_each(|file| job.line(&format!("WVON WEV#({file})")));
    }

    fn end_weave(&mut self, job: &mut JobText) {
        self.weave.iter().for_each(|_| job.line("WVOF"));
    }

    fn weld(&mut self, job: &mut JobText, piece: Piece, _next: &[Instruction]) {
        let level = if piece.last { 0 } else { self.inform.position_level };
        match piece.circle {
            Some(circle) => self.arc(job, circle.via, piece.to, piece.speed, level),
            None => self.motion(job, "MOVL", piece.to, piece.speed, level),
        }
    }

    fn wait(&mut self, job: &mut JobText, seconds: f64) {
        waits(seconds, MAX_WAIT).for_each(|s| job.line(&format!("TIMER T={}", fixed(s, 2))));
    }

    fn weaves(&self) -> bool {
        self.weave.is_some()
    }
}
