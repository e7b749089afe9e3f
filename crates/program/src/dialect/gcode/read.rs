//! Reads G-code of CNC machines and printers.
//!
//! A file with E words is for a printer: it lays metal when E exceeds its greatest value so far, so retracting and
//! priming lay nothing. In other files metal is laid while the arc is on (from M3 or M4 to M5, and by the codes in the
//! options).

use super::block::{Block, Code, Line, begins_block};
use super::branches::{Branches, Seen, without_number};
use super::hints;
use super::review;
use crate::dialect::reading::fault::{NO_OUTPUT, RAPID_WITH_ARC};
use crate::dialect::reading::trace::{Curve, Step, Trace};
use crate::dialect::reading::{FindModule, Metal, Options, ReadError, ReadProgram, words};
use glam::DVec3;
use std::f64::consts::{FRAC_PI_4, TAU};

/// Inch in mm.
const INCH: f64 = 25.4;

/// How offsets set by a program are reported.
const SHIFTS: &str = "shifts what follows, which is not applied";

/// Codes in tenths that affect neither position nor metal.
const HARMLESS_G: [i32; 21] =
    [40, 90, 100, 110, 170, 210, 290, 400, 490, 540, 610, 640, 690, 800, 940, 971, 980, 990, 430, 434, 51];

/// Codes in tenths whose axis words do not end a motion: offsets, levelling, probing, cycles, turned coordinates.
const AXES_OF_THEIR_OWN: [i32; 28] = [
    100, 110, 290, 300, 310, 382, 383, 384, 385, 500, 510, 520, 580, 590, 680, 730, 740, 760, 810, 820, 830, 840, 850,
    860, 870, 880, 890, 921,
];

/// M codes that affect neither position nor metal: stops, temperatures, fans, messages, limits of acceleration, gas.
const HARMLESS_M: [i32; 67] = [
    0, 1, 5, 7, 8, 9, 17, 18, 20, 42, 48, 49, 50, 51, 62, 63, 64, 65, 66, 67, 68, 73, 74, 75, 76, 77, 84, 85, 92, 104,
    105, 106, 107, 108, 109, 110, 111, 115, 117, 118, 119, 140, 141, 190, 191, 201, 202, 203, 204, 205, 207, 208, 209,
    211, 220, 221, 300, 301, 302, 304, 400, 486, 566, 572, 900, 155, 113,
];

/// Whether a line can occur only in G-code.
pub(super) fn typical(line: &str) -> bool {
    begins_block(line.as_bytes())
}

pub(super) fn read(text: &str, _module: &mut FindModule<'_>, options: &Options) -> Result<ReadProgram, ReadError> {
    let hints = hints::of(text);
    let mut reader = Reader::new(&hints, options);
    let mut block = Block::new();
    let mut branches = Branches::default();
    for (i, line) in text.as_bytes().split(|&b| b == b'\n').enumerate() {
        let line = without_number(line);
        match branches.see(line) {
            Seen::Block => {}
            Seen::Done => continue,
            Seen::Unknown => {
                reader.trace.note("a branch", "is not followed: its lines were read once", i + 1);
                continue;
            }
        }
        match block.read(line) {
            Line::Empty => reader.comment(line),
            Line::Words => {
                if reader.block(&block, i + 1)? {
                    break;
                }
            }
            Line::Macro => reader.macro_line(line, i + 1),
            Line::Malformed(word) => {
                return Err(reader.trace.number_error(i + 1, &String::from_utf8_lossy(word)));
            }
        }
    }
    if hints.printer && options.filament_diameter.is_none() && hints.diameter.is_none() && !hints.volumetric {
        reader.trace.note("the filament's diameter", "is not given and was taken as 1.75 mm", 1);
    }
    if let Some(line) = reader.lit_without_speed.filter(|_| review::is_linuxcnc(text)) {
        let place = Some(reader.trace.place(line));
        let text = "M3 without S: a spindle without a speed does not turn, so its output stays off and the arc is never struck.";
        reader.trace.faults.add(&NO_OUTPUT, place, text);
    }
    if !hints.printer {
        review::program(&mut reader.trace, text, options);
    }
    reader.trace.finish(super::DIALECT.language)
}

/// The extruder: the value of E, and the length of filament pushed in total.
#[derive(Default)]
struct Extruder {
    at: f64,
    relative: bool,
    pushed: f64,
    most: f64,
}

impl Extruder {
    /// Length of filament that leaves the nozzle for the word E`e`, mm.
    fn push(&mut self, e: f64, relative: bool) -> f64 {
        let by = if relative { e } else { e - self.at };
        self.at += by;
        self.pushed += by;
        let laid = (self.pushed - self.most).max(0.0);
        self.most = self.most.max(self.pushed);
        laid
    }
}

struct Reader {
    trace: Trace,
    printer: bool,
    /// Whether G4 P is in milliseconds, as on Fanuc controls.
    fanuc: bool,
    on: Vec<Code>,
    off: Vec<Code>,
    /// Millimetres per unit of the program.
    unit: f64,
    relative: bool,
    absolute_centres: bool,
    /// Whether arcs lie in the XY plane.
    flat: bool,
    inverse_time: bool,
    motion: Option<i32>,
    /// F in mm/min, or in 1/min for inverse time.
    feed: f64,
    /// Machine coordinates minus those of the program, mm.
    offset: DVec3,
    extruder: Extruder,
    /// Cross-section of the filament, mm²; `None` if E is a volume.
    filament_area: Option<f64>,
    width: Option<f64>,
    flow: f64,
    pace: f64,
    /// Spindle speed.
    spindle: f64,
    /// The first line that starts the spindle without a speed.
    lit_without_speed: Option<usize>,
    /// Angles of A, B and C, °.
    angles: [f64; 3],
    /// Whether tool centre point control is on: X, Y and Z are then positions on the part, however axes turn it.
    tip_control: bool,
}

impl Reader {
    fn new(hints: &hints::Hints, options: &Options) -> Self {
        let diameter = options.filament_diameter.or(hints.diameter).unwrap_or(1.75);
        let codes = |own: &[&str], more: &[String]| {
            let replaced = options.arc.alone && !more.is_empty();
            let own = own.iter().copied().filter(|_| !hints.printer && !replaced);
            own.chain(more.iter().map(String::as_str)).filter(|c| !c.trim().is_empty()).map(Code::new).collect()
        };
        Self {
            trace: Trace::new(),
            printer: hints.printer,
            fanuc: hints.fanuc,
            on: codes(&["M3", "M4"], &options.arc.on),
            off: codes(&["M5"], &options.arc.off),
            unit: 1.0,
            relative: false,
            absolute_centres: false,
            flat: true,
            inverse_time: false,
            motion: None,
            feed: 0.0,
            offset: DVec3::ZERO,
            extruder: Extruder::default(),
            filament_area: (!hints.volumetric).then_some(FRAC_PI_4 * diameter * diameter),
            width: None,
            flow: 1.0,
            pace: 1.0,
            spindle: 0.0,
            lit_without_speed: None,
            angles: [0.0; 3],
            tip_control: false,
        }
    }

    /// Reads the bead width that slicers write in comments.
    fn comment(&mut self, line: &[u8]) {
        if self.printer && line.first() == Some(&b';') {
            self.width = hints::width(line).or(self.width);
        }
    }

    fn macro_line(&mut self, line: &[u8], number: usize) {
        let text = String::from_utf8_lossy(line);
        let compact = words::compact(words::before_comment(&text, ';'));
        if self.on.iter().any(|c| c.is_macro(&compact)) {
            self.trace.set_arc(true, number);
        } else if self.off.iter().any(|c| c.is_macro(&compact)) {
            self.trace.set_arc(false, number);
        } else if let Some(rest) = words::strip_word(text.trim(), "TRANS") {
            // Siemens: a shift of the following coordinates.
            let zero = rest.split_whitespace().all(|word| words::number(&word[1..]) == Some(0.0));
            if !zero {
                self.trace.note("TRANS", SHIFTS, number);
            }
        } else if ["TRAORI", "TRAFOOF"].contains(&compact.as_str()) {
            self.control_tip(compact == "TRAORI");
        } else {
            let name = text.trim().split([' ', '=', '\t']).next().unwrap_or_default();
            self.trace.note(name, "is not understood and was left out", number);
            self.trace.see(name);
        }
    }

    /// Reads one block; true at the end of the program.
    fn block(&mut self, block: &Block, line: usize) -> Result<bool, ReadError> {
        self.modes(block, line);
        if self.on.iter().any(|c| c.is_in(block)) {
            self.trace.set_arc(true, line);
        }
        if let Some(speed) = block.get(b'S').filter(|_| !self.printer && !block.g.has(40)) {
            self.spindle = speed;
        }
        if !self.printer && block.m.has(30) && self.spindle == 0.0 {
            self.lit_without_speed = self.lit_without_speed.or(Some(line));
        }
        if block.g.has(40) {
            self.trace.dwell += self.dwell(block);
        } else if block.g.has(920) {
            self.set_position(block);
        } else if block.g.has(280) {
            self.home(block, line);
        } else if block.g.has(530) {
            self.trace.note("G53", "moves in machine coordinates, which are unknown here", line);
            self.trace.forget();
        } else if !(block.g.iter().any(|g| AXES_OF_THEIR_OWN.contains(&g)) || self.sets_only(block)) {
            self.moved(block, line)?;
        }
        if self.off.iter().any(|c| c.is_in(block)) {
            self.trace.set_arc(false, line);
        }
        Ok(!self.printer && (block.m.has(20) || block.m.has(300)))
    }

    fn modes(&mut self, block: &Block, line: usize) {
        for code in block.g.iter() {
            match code {
                0 | 10 | 20 | 30 => self.motion = Some(code / 10),
                50 => {
                    self.motion = Some(1);
                    self.trace.note("G5", "is a spline and was read as a straight move", line);
                }
                170 | 180 | 190 => self.flat = code == 170,
                // Also G70, G700, G71 and G710 of Siemens.
                200 | 700 | 7000 => self.unit = INCH,
                210 | 710 | 7100 => self.unit = 1.0,
                900 | 910 => self.relative = code == 910,
                901 | 911 => self.absolute_centres = code == 901,
                921..=923 => self.offset = DVec3::ZERO,
                930 | 940 => self.inverse_time = code == 930,
                434 | 435 => self.control_tip(true),
                490 => self.control_tip(false),
                40 | 280 | 530 | 920 => {}
                // Heights added to layers are 0 until somebody sets them.
                520 | 580 | 590 => {
                    let zero = [b'X', b'Y', b'Z'].iter().all(|&axis| block.get(axis).is_none_or(|value| value == 0.0));
                    if !zero {
                        self.trace.note(&name('G', code), SHIFTS, line);
                    }
                }
                _ if HARMLESS_G.contains(&code) => {}
                _ => self.trace.note(&name('G', code), "is not understood and was left out", line),
            }
        }
        for code in block.m.iter() {
            self.m_code(code, block, line);
        }
        if self.sets_only(block) {
            return;
        }
        if block.has(b'F') && !block.g.has(40) {
            let unit = if self.inverse_time { 1.0 } else { self.unit };
            self.feed = block.get(b'F').unwrap_or(0.0) * unit;
        }
        if block.m.iter().next().is_none() {
            let angles = [b'A', b'B', b'C'].map(|letter| block.get(letter));
            let before = std::mem::take(&mut self.angles);
            self.angles = std::array::from_fn(|k| {
                angles[k].map_or(before[k], |to| if self.relative { before[k] + to } else { to })
            });
        }
        if self.printer && block.get(b'T').is_some_and(|t| t != 0.0) {
            self.trace.note("T", "selects another tool, which was read as the first one", line);
        }
    }

    /// Switches tool centre point control. If axes have turned the part, the torch then has other coordinates.
    fn control_tip(&mut self, on: bool) {
        if on != self.tip_control && self.angles != [0.0; 3] {
            self.trace.forget();
        }
        self.tip_control = on;
    }

    /// Whether this is a printer's M code, whose words are settings (`M201 X9000 E5000`).
    fn sets_only(&self, block: &Block) -> bool {
        self.printer && block.m.iter().next().is_some()
    }

    fn m_code(&mut self, code: i32, block: &Block, line: usize) {
        match code {
            820 | 830 => self.extruder.relative = code == 830,
            2200 => self.pace = block.get(b'S').map_or(self.pace, |s| s / 100.0),
            2210 => self.flow = block.get(b'S').map_or(self.flow, |s| s / 100.0),
            // Volumetric E, or back to lengths.
            2000 => match block.get(b'D') {
                Some(d) if d > 0.0 => self.filament_area = None,
                _ => self.trace.note("M200", "without a diameter is not understood and was left out", line),
            },
            20 | 300 if !self.printer => {}
            // As used in LinuxCNC's examples of tilting tables.
            4280 | 4290 if !self.printer => self.control_tip(code == 4280),
            _ if code % 10 == 0 && HARMLESS_M.contains(&(code / 10)) => self.seen(code, block),
            _ if self.on.iter().chain(&self.off).any(|c| c.is_in(block)) => {}
            _ => {
                self.trace.note(&name('M', code), "is not understood and was left out", line);
                self.seen(code, block);
            }
        }
    }

    /// Remembers an M code, since any M code of a machine may strike its arc.
    fn seen(&mut self, code: i32, block: &Block) {
        if !self.printer {
            let more = block.get(b'P').map_or(String::new(), |p| format!(" P{p}"));
            self.trace.see(&format!("{}{more}", name('M', code)));
        }
    }

    /// Wait of a G4, s.
    fn dwell(&self, block: &Block) -> f64 {
        // On Fanuc controls a P with a decimal point is in seconds, and nobody waits less than 10 ms.
        let milliseconds = |p: f64| self.printer || (self.fanuc && p >= 10.0 && p.fract() == 0.0);
        let p = block.get(b'P').map(|p| if milliseconds(p) { p / 1000.0 } else { p });
        let seconds = [block.get(b'S'), p, block.get(b'X'), block.get(b'F')].into_iter().flatten().next();
        seconds.unwrap_or(0.0).max(0.0)
    }

    /// G92: gives the current position new coordinates.
    fn set_position(&mut self, block: &Block) {
        for (axis, letter) in [b'X', b'Y', b'Z'].into_iter().enumerate() {
            if let Some(value) = block.get(letter) {
                self.offset[axis] = self.trace.at[axis] - value * self.unit;
                // These coordinates make an unknown position known.
                if !self.trace.known[axis] {
                    (self.offset[axis], self.trace.at[axis]) = (0.0, value * self.unit);
                    self.trace.known[axis] = true;
                }
            }
        }
        if let Some(e) = block.get(b'E') {
            self.extruder.at = e * self.filament_unit();
        }
    }

    /// Inches count only where E is a length.
    fn filament_unit(&self) -> f64 {
        if self.filament_area.is_some() { self.unit } else { 1.0 }
    }

    /// G28: a printer is then at 0, while a machine's reference point may be anywhere.
    fn home(&mut self, block: &Block, line: usize) {
        let all = !b"XYZ".iter().any(|&l| block.names(l));
        let homed = [b'X', b'Y', b'Z'].map(|l| all || block.names(l));
        if self.printer {
            let step = Step { speed: 0.0, metal: Metal::Off, width: None, line };
            self.offset = DVec3::from_array([0, 1, 2].map(|i| if homed[i] { 0.0 } else { self.offset[i] }));
            self.trace.line(homed.map(|h| h.then_some(0.0)), step);
        } else {
            self.trace.known = [0, 1, 2].map(|i| self.trace.known[i] && !homed[i]);
        }
    }

    fn moved(&mut self, block: &Block, line: usize) -> Result<(), ReadError> {
        let target = self.target(block);
        let start = self.trace.at;
        let to = DVec3::from_array([0, 1, 2].map(|i| target[i].unwrap_or(start[i])));
        let laid = block.get(b'E').map_or(0.0, |e| {
            let relative = self.relative || self.extruder.relative;
            self.extruder.push(e * self.filament_unit(), relative) * self.filament_area.unwrap_or(1.0) * self.flow
        });
        let arc = matches!(self.motion, Some(2 | 3)) && block.has_any(b"IJR");
        self.whole(block, line, target != [None; 3])?;
        if target == [None; 3] && !arc {
            return Ok(());
        }
        let motion = self.motion.unwrap_or_else(|| {
            self.trace.note("a move before the first G0 to G3", "was read as G1", line);
            1
        });
        if motion == 0 && self.trace.arc && !self.printer {
            let place = Some(self.trace.place(line));
            self.trace.faults.add(&RAPID_WITH_ARC, place, "G0 moves with the arc on.");
        }
        let across = arc || to.truncate() != start.truncate();
        let metal = match laid > 0.0 && across {
            true => Metal::Volume(laid),
            // Whatever the state of the arc, no bead is laid in a rapid move.
            false if motion == 0 && !self.printer => Metal::Off,
            false => self.trace.metal(),
        };
        if !matches!(metal, Metal::Off) && !self.tip_control && self.angles != [0.0; 3] {
            self.trace.note("A, B or C", "turns an axis, which is not followed", line);
        }
        let mut step = Step { speed: 0.0, metal, width: self.width, line };
        let curve = if motion >= 2 { self.curve(block, to, line) } else { None };
        let length = curve.as_ref().map_or(start.distance(to), |c| (c.sweep * c.u.length()).hypot(c.rise.length()));
        step.speed = self.speed(motion, length);
        match curve {
            Some(curve) => {
                self.trace.settle(line);
                self.trace.curve(&curve, to, step);
            }
            None => self.trace.line(target, step),
        }
        Ok(())
    }

    /// Refuses a motion that names an axis without giving a number.
    fn whole(&self, block: &Block, line: usize, moves: bool) -> Result<(), ReadError> {
        let moves = moves || [0, 10, 20, 30].into_iter().any(|g| block.g.has(g));
        match [b'X', b'Y', b'Z'].into_iter().find(|&l| moves && block.names(l) && !block.has(l)) {
            Some(letter) => Err(self.trace.number_error(line, &char::from(letter).to_string())),
            None => Ok(()),
        }
    }

    /// Machine coordinates of the named axes, mm.
    fn target(&self, block: &Block) -> [Option<f64>; 3] {
        let mut target = [None; 3];
        for (axis, letter) in [b'X', b'Y', b'Z'].into_iter().enumerate() {
            let from = if self.relative { self.trace.at[axis] } else { self.offset[axis] };
            target[axis] = block.get(letter).map(|value| from + value * self.unit);
        }
        target
    }

    /// Speed, mm/s; 0 if unknown.
    fn speed(&self, motion: i32, length: f64) -> f64 {
        match motion {
            // A printer obeys F in G0 too.
            0 if !self.printer => 0.0,
            _ if self.inverse_time => length * self.feed / 60.0,
            _ => self.feed / 60.0 * self.pace,
        }
    }

    /// The arc of a G2 or G3; `None` if it was noted and is read as a line.
    fn curve(&mut self, block: &Block, to: DVec3, line: usize) -> Option<Curve> {
        if !self.flat {
            self.trace.note("an arc outside the XY plane (G18, G19)", "was read as a straight move", line);
            return None;
        }
        let clockwise = self.motion == Some(2);
        let start = self.trace.at;
        let Some(centre) = self.centre(block, to, clockwise) else {
            self.trace.note("an arc without a centre", "was read as a straight move", line);
            return None;
        };
        let (u, b) = (start - centre, to - centre);
        let off = (b.truncate().length() - u.truncate().length()).abs();
        if off > (0.005 * u.length()).max(0.05) {
            self.trace.note("an arc's end", "does not lie on its circle: the last chord goes there", line);
        }
        let turn = if clockwise { -1.0 } else { 1.0 };
        let angle = turn * u.truncate().perp_dot(b.truncate()).atan2(u.truncate().dot(b.truncate()));
        // Start and end coincide: a full circle.
        let full = start.truncate().distance(to.truncate()) < 1e-6;
        let sweep = if full { TAU } else { angle.rem_euclid(TAU) };
        let (u, v) = (u.with_z(0.0), DVec3::new(-u.y, u.x, 0.0) * turn);
        let rise = DVec3::new(0.0, 0.0, to.z - start.z);
        Some(Curve { centre: centre.with_z(start.z), u, v, sweep, rise })
    }

    fn centre(&self, block: &Block, to: DVec3, clockwise: bool) -> Option<DVec3> {
        let start = self.trace.at;
        if let Some(radius) = block.get(b'R') {
            let (half, radius) = ((to - start).with_z(0.0) / 2.0, radius * self.unit);
            let rest = radius * radius - half.length_squared();
            let side = if clockwise == (radius > 0.0) { -1.0 } else { 1.0 };
            let normal = DVec3::new(-half.y, half.x, 0.0).try_normalize()?;
            return Some(start + half + normal * side * rest.max(0.0).sqrt());
        }
        let from = if self.absolute_centres { self.offset } else { start };
        let whole = |letter, axis: usize| match block.get(letter) {
            Some(value) => from[axis] + value * self.unit,
            None => start[axis],
        };
        let centre = DVec3::new(whole(b'I', 0), whole(b'J', 1), start.z);
        (block.has_any(b"IJ") && centre.distance(start) > 1e-9).then_some(centre)
    }
}

fn name(letter: char, code: i32) -> String {
    match code % 10 {
        0 => format!("{letter}{}", code / 10),
        tenth => format!("{letter}{}.{tenth}", code / 10),
    }
}
