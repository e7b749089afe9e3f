//! Reads programs back, ours and anyone's, as moves with and without metal: G-code, KRL, RAPID, FANUC TP, INFORM,
//! URScript.
//!
//! | file | what it does |
//! | --- | --- |
//! | `words` | numbers, names and patterns of the robots' languages |
//! | `trace` | the moves as they are read: positions, flattened arcs, notes |
//! | `loops` | loops with constant bounds |
//! | `fault`, `watch` | lines that would be dangerous, and arc monitoring |
//! | `layers` | [`ReadProgram::layers`] and [`ReadProgram::totals`] |
//!
//! Programs are read from top to bottom; calls are followed, and loops with constant bounds run as often as they say.
//! Nothing is computed: branches and other loops are read once, variables and expressions are not evaluated. Whatever is not understood is listed in [`ReadProgram::notes`].

pub(super) mod fault;
mod layers;
pub(super) mod loops;
pub(super) mod trace;
pub(super) mod truth;
pub(super) mod watch;
pub(super) mod words;

pub use fault::{FAULTS, Fault, FaultKind};
pub use layers::{ReadLayer, ReadPass, ReadTotals};
pub use trace::CHORD_MM;

use super::{ALL, Dialect};
use crate::program::Positioner;
use bead_part::model::MAX_REACH_MM;
use glam::DVec3;
use std::fmt;

/// The metal laid by a move.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Metal {
    /// Nothing.
    Off,
    /// A bead: the arc is on.
    Arc,
    /// This volume along the move, mm³.
    Volume(f64),
}

impl Metal {
    /// Whether the move deposits.
    pub fn is_laid(self) -> bool {
        self != Self::Off
    }
}

/// One straight move of a program; arcs are flattened to chords within [`CHORD_MM`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Move {
    /// End point, mm. The move begins where the one before ends; the first one only says where the program begins.
    pub to: DVec3,
    /// Speed, mm/s; 0 if the program does not give it (rapids, point-to-point moves).
    pub speed: f64,
    /// The metal it lays.
    pub metal: Metal,
    /// Bead width, if the program states it, mm.
    pub width: Option<f64>,
    /// Line of the file or module that holds the move, from 1.
    pub line: usize,
}

/// A program read back.
#[derive(Debug, Clone, PartialEq)]
pub struct ReadProgram {
    /// Its language in words, such as KRL.
    pub language: &'static str,
    /// All moves in order.
    pub moves: Vec<Move>,
    /// Sum of all waits, s.
    pub dwell: f64,
    /// What was not understood or had to be assumed, one sentence each with count and first line.
    pub notes: Vec<String>,
    /// Lines that would be dangerous, or that the controller would refuse.
    pub faults: Vec<Fault>,
}

/// Codes that strike and end the arc, in addition to those that a dialect recognises by itself, or in their place.
///
/// For G-code they are words (`M64 P1`) or a macro's name; for robots a statement such as `$OUT[2] = TRUE`,
/// `SetDO doArc,1` or `set_standard_digital_out(1, True)`. Case and blanks do not matter.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct ArcCodes {
    /// Codes that strike the arc.
    pub on: Vec<String>,
    /// Codes that end the arc.
    pub off: Vec<String>,
    /// Whether these codes replace M3, M4 and M5 of G-code, which then switch a spindle or a laser, say.
    pub alone: bool,
}

impl ReadProgram {
    /// Assumes a speed, mm/s, for every move without metal for which the program gives none: rapids (G0), and joint
    /// moves along the chord of their path. Returns the number of these moves, and their length, mm.
    ///
    /// ```
    /// use bead_program::dialect::reading::{Options, read};
    ///
    /// // Up by 2 mm and back by 30 mm, after a first rapid that may come from anywhere.
    /// let text = "G21 G90\nG0 X0 Y0 Z2\nM3 S1\nG1 X30 F600\nM5\nG0 Z4\nG0 X0\nM3 S1\nG1 X30\nM5\n";
    /// let mut program = read(text, &mut |_| None, &Options::default())?;
    /// assert_eq!(program.take_rapids_at(100.0), (2, 2.0 + 30.0));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn take_rapids_at(&mut self, speed: f64) -> (usize, f64) {
        let (mut count, mut length) = (0, 0.0);
        for i in 1..self.moves.len() {
            let from = self.moves[i - 1].to;
            let step = &mut self.moves[i];
            if !step.metal.is_laid() && step.speed <= 0.0 && step.to != from {
                step.speed = speed;
                count += 1;
                length += from.distance(step.to);
            }
        }
        (count, length)
    }
}

/// How to read a program.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Options {
    /// More codes that switch the arc.
    pub arc: ArcCodes,
    /// Diameter of a printer's filament, mm. If absent, the program's comments decide, or else it is 1.75 mm.
    pub filament_diameter: Option<f64>,
    /// Whether `V=` in INFORM is in cm/min instead of mm/s; controllers can be set to either, and jobs do not say
    /// which.
    pub inform_cm_per_min: bool,
    /// The station that turns the part in INFORM.
    pub inform_station: Option<Station>,
    /// Name of the main file on the controller.
    pub file: Option<String>,
    /// The largest KRL program or script that the controller accepts, MB.
    pub max_megabytes: Option<f64>,
}

/// A station under the part, as INFORM counts its axes.
#[derive(Debug, Clone, PartialEq)]
pub struct Station {
    /// Its axes; a table that turns about the part's z axis is one of them.
    pub positioner: Positioner,
    /// Pulses per degree of each axis; with one, the second does not matter.
    pub pulses: [f64; 2],
    /// Whether the user frame turns with it, so that positions are on the part.
    pub frame_turns: bool,
}

/// A line of the program, or of one of its modules.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Place {
    /// Line from 1.
    pub line: usize,
    /// Name of the module; `None` for the main file.
    pub module: Option<String>,
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.module {
            Some(module) => write!(f, "line {} of {module}", self.line),
            None => write!(f, "line {}", self.line),
        }
    }
}

/// Why a program cannot be read.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ReadError {
    /// No dialect fits.
    #[error(
        "this is neither G-code, KRL, RAPID, FANUC TP, INFORM nor URScript: no line begins with a word such as G1, with DEF, MODULE, /PROG, /JOB or def. Give the main program itself, as text."
    )]
    UnknownDialect,
    /// A number is expected.
    #[error(
        "{place}: \"{text}\" is not a number. Variables and expressions are not read: write the program out with plain numbers."
    )]
    Number {
        /// Where.
        place: Place,
        /// What was found instead.
        text: String,
    },
    /// A called program is missing.
    #[error(
        "{place} calls {name}, which is not in the program and was not found next to it. Put its file there, or remove the call \
         if nothing moves in it."
    )]
    MissingModule {
        /// Where it is called.
        place: Place,
        /// Its name as written.
        name: String,
    },
    /// Calls are nested too deep, or are too many.
    #[error(
        "{place}: calls nest deeper than {limit} or are too many, at the call of {name}. Does it call itself?",
        limit = trace::MAX_DEPTH
    )]
    TooDeep {
        /// Where it is called.
        place: Place,
        /// What is called.
        name: String,
    },
    /// Too many loop iterations.
    #[error(
        "{place}: the loops up to here run more than {most} times in all, and no more are read. Give part of the program, or \
         fewer runs.",
        most = trace::MAX_TURNS
    )]
    TooManyTurns {
        /// The end of the last of these loops.
        place: Place,
    },
    /// A bead on a curve that only the controller can compute.
    #[error(
        "{place}: {word} welds along a curve that only the controller can compute, so that its place and length are unknown \
         here. Write its path as {instead}."
    )]
    UnknownCurve {
        /// Where.
        place: Place,
        /// The motion.
        word: &'static str,
        /// What can be read.
        instead: &'static str,
    },
    /// A circle whose three points lie on one line or at one point.
    #[error(
        "{place}: no circle runs through the start, the auxiliary point and the end of this arc, because they lie on one line or \
         at one point. For a full circle, give two other points of it and CA 360, or write two half circles."
    )]
    NoCircle {
        /// Where.
        place: Place,
    },
    /// A weld to a position in motor pulses.
    #[error(
        "{place}: {name} is given in motor pulses (///POSTYPE PULSE), and only the robot's controller knows which place that is. Convert the job into a relative job on the pendant (JOB, UTILITY, RELATIVE JOB), or export it with POSTYPE BASE or USER, and read it again."
    )]
    Pulses {
        /// Where the move is.
        place: Place,
        /// The position.
        name: String,
    },
    /// A coordinate that no machine reaches.
    #[error("{place}: a coordinate lies farther out than {} m, or is not a number. Check the program there.", MAX_REACH_MM / 1000.0)]
    TooFar {
        /// Where.
        place: Place,
    },
    /// More moves than can be read.
    #[error(
        "{place}: up to here the program has {most} million moves (arcs in chords, calls each time), and no more are read. Give \
         part of it.",
        most = trace::MAX_MOVES / 1_000_000
    )]
    TooLong {
        /// Where.
        place: Place,
    },
    /// The file only declares data and has nothing to run.
    #[error("this {0} file holds no program to run (no DEF, no PROC). Give the file with the motions.")]
    NoProgram(&'static str),
    /// No move lays metal.
    #[error("no move with the arc on was found: say which codes strike and end the arc.{hint}")]
    NoDeposition {
        /// A sentence that names the switching codes of the program, or nothing.
        hint: String,
    },
}

/// Finds the text of another module by its name as the program writes it: a KRL subprogram (`PART_L001`), its data
/// (`PART_L001.dat`), a RAPID module or procedure (`L001`), a FANUC program, a job.
pub type FindModule<'a> = dyn FnMut(&str) -> Option<String> + 'a;

/// Reads a program, whatever its language; `module` finds the text of the modules that it calls.
///
/// ```
/// use bead_program::dialect::reading::{Options, read};
///
/// // 60 mm at 600 mm/min, which are 10 mm/s.
/// let text = "G21 G90\nG0 X0 Y0 Z2\nM3 S1\nG1 X60 F600\nM5\n";
/// let totals = read(text, &mut |_| None, &Options::default())?.totals();
/// assert_eq!((totals.arc_starts, totals.deposited_length_mm, totals.time_s), (1, 60.0, 6.0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`ReadError`] when the dialect is unknown, a number is malformed, a called module is missing or no move lays
/// metal.
pub fn read(text: &str, module: &mut FindModule<'_>, options: &Options) -> Result<ReadProgram, ReadError> {
    (recognise(text).ok_or(ReadError::UnknownDialect)?.read)(text, module, options)
}

/// The dialect of a program, if it can be read: decided by the first line that is typical of one.
///
/// ```
/// use bead_program::dialect::reading::recognise;
///
/// let name = |text: &str| recognise(text).map(|dialect| dialect.name);
/// assert_eq!(name("; a part\nG1 X10 F600\n"), Some("gcode"));
/// assert_eq!(name("DEF PART( )\nEND\n"), Some("krl"));
/// assert_eq!(name("MODULE Part\nENDMODULE\n"), Some("rapid"));
/// assert_eq!(name("Dear Sir,\n"), None);
/// ```
pub fn recognise(text: &str) -> Option<&'static Dialect> {
    let lines = text.trim_start_matches('\u{feff}').lines().map(str::trim);
    lines.filter_map(|line| ALL.iter().find(|dialect| (dialect.typical)(line))).next().copied()
}
