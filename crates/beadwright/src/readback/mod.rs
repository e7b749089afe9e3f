//! Programs read back, ours and anyone's, as moves with and without metal: G-code, KRL, RAPID, FANUC TP, INFORM, URScript.
//!
//! | part | holds |
//! | --- | --- |
//! | [`read`] | tells the dialect by the text and reads the moves |
//! | `gcode`, `krl`, `rapid`, `fanuc`, `inform`, `urscript` | the dialects, one file each |
//! | `block`, `hints` | the words of a line of G-code; what its comments tell |
//! | `words` | numbers, names and patterns of the robots' languages |
//! | `trace` | the moves as they come: places, flattened arcs, notes |
//! | `layers` | [`Program::layers`] and [`Program::totals`] |
//!
//! Programs are read from top to bottom and calls are followed, but nothing is computed: branches and loops are read
//! once, variables and expressions are not evaluated. Whatever is not understood ends in [`Program::notes`].

mod block;
mod fanuc;
mod gcode;
mod hints;
mod inform;
mod krl;
mod layers;
mod module;
mod rapid;
mod trace;
mod urscript;
mod words;

pub use layers::{ReadLayer, ReadPass, Totals};
pub use trace::CHORD_MM;

use glam::DVec3;
use std::fmt;

/// The language of a program.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Dialect {
    /// G-code of CNC machines and printers.
    Gcode,
    /// KUKA KRL.
    Krl,
    /// ABB RAPID.
    Rapid,
    /// FANUC TP as ASCII.
    Fanuc,
    /// Yaskawa INFORM.
    Inform,
    /// URScript of Universal Robots.
    Urscript,
}

impl Dialect {
    /// As people write it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Gcode => "G-code",
            Self::Krl => "KRL",
            Self::Rapid => "RAPID",
            Self::Fanuc => "FANUC TP",
            Self::Inform => "INFORM",
            Self::Urscript => "URScript",
        }
    }
}

/// What a move lays.
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
    /// Where it ends, mm. It begins where the move before ends; the first one only tells where the program begins.
    pub to: DVec3,
    /// Speed, mm/s; 0 where the program does not tell it (rapids, point-to-point moves).
    pub speed: f64,
    /// What it lays.
    pub metal: Metal,
    /// Bead width where the program says it, mm.
    pub width: Option<f64>,
    /// Line of the file or module that holds the move, from 1.
    pub line: usize,
}

/// A program read back.
#[derive(Debug, Clone, PartialEq)]
pub struct Program {
    /// Its language.
    pub dialect: Dialect,
    /// All moves in order.
    pub moves: Vec<Move>,
    /// Sum of all waits, s.
    pub dwell: f64,
    /// What was not understood or had to be assumed, one sentence each with count and first line.
    pub notes: Vec<String>,
}

/// Codes that light and end the arc, besides those that a dialect knows by itself.
///
/// For G-code they are words (`M64 P1`) or a macro's name; for robots a statement such as `$OUT[2] = TRUE`, `SetDO doArc,1`
/// or `set_standard_digital_out(1, True)`. Case and blanks do not matter.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct ArcCodes {
    /// Light the arc.
    pub on: Vec<String>,
    /// End it.
    pub off: Vec<String>,
}

/// How to read a program.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Options {
    /// More codes that switch the arc.
    pub arc: ArcCodes,
    /// Diameter of a printer's filament, mm. Without it the program's comments tell, or else it is 1.75 mm.
    pub filament_diameter: Option<f64>,
    /// Whether `V=` in INFORM counts cm/min, as controllers can be set to, and not mm/s; jobs do not tell.
    pub inform_cm_per_min: bool,
}

/// A line of the program, or of one of its modules.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Place {
    /// Line from 1.
    pub line: usize,
    /// Name of the module; none for the main file.
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
        /// What stands there.
        text: String,
    },
    /// A called program is not there.
    #[error(
        "{place} calls {name}, which is not in the program and was not found beside it. Put its file there, or take the call out if nothing moves in it."
    )]
    MissingModule {
        /// Where it is called.
        place: Place,
        /// Its name as written.
        name: String,
    },
    /// Calls nest without end.
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
    /// The file declares data and holds nothing to run.
    #[error("this {0} file holds no program to run (no DEF, no PROC). Give the file with the motions.")]
    NoProgram(&'static str),
    /// No metal.
    #[error(
        "no move with the arc on was found: say which codes light and end the arc with --arc-on and --arc-off.{hint}"
    )]
    NoDeposition {
        /// Switching codes that the program has, as a sentence, or nothing.
        hint: String,
    },
}

/// Reads a program. `module` finds the text of another module by its name as the program writes it: a KRL
/// subprogram (`PART_L001`), its data (`PART_L001.dat`), a RAPID module or procedure (`L001`), a FANUC program, a job.
///
/// # Errors
/// [`ReadError`] when the dialect is unknown, a number is malformed, a called module is missing or no move lays
/// metal.
pub fn read(
    text: &str,
    module: &mut dyn FnMut(&str) -> Option<String>,
    options: &Options,
) -> Result<Program, ReadError> {
    match dialect(text).ok_or(ReadError::UnknownDialect)? {
        Dialect::Gcode => gcode::read(text, options),
        Dialect::Krl => krl::read(text, module, options),
        Dialect::Rapid => rapid::read(text, module, options),
        Dialect::Fanuc => fanuc::read(text, module, options),
        Dialect::Inform => inform::read(text, module, options),
        Dialect::Urscript => urscript::read(text, module, options),
    }
}

/// The language of a program, if it is one of those that can be read: the first line that is typical of one decides.
pub fn dialect(text: &str) -> Option<Dialect> {
    const KRL: [&str; 9] = ["DEF", "DEFDAT", "DEFFCT", "LIN", "PTP", "SLIN", "SPTP", "$VEL", "$OUT"];
    const RAPID: [&str; 9] = ["MODULE", "PROC", "MoveL", "MoveJ", "MoveC", "MoveAbsJ", "ArcLStart", "PERS", "CONST"];
    // Calls: in RAPID no bracket follows a move.
    const URSCRIPT: [&str; 5] = ["movel(", "movej(", "movep(", "movec(", "set_tcp("];
    text.trim_start_matches('\u{feff}').lines().map(str::trim).find_map(|line| {
        let line = words::strip_word(line, "GLOBAL").or_else(|| words::strip_word(line, "LOCAL")).unwrap_or(line);
        let begins = |word: &&str| words::strip_word(line, word).is_some();
        if words::strip_word(line, "/PROG").is_some() {
            Some(Dialect::Fanuc)
        } else if line == "/JOB" {
            Some(Dialect::Inform)
        } else if (line.starts_with("def ") && words::before_comment(line, '#').trim_end().ends_with(':'))
            || URSCRIPT.iter().any(|w| line.starts_with(w))
        {
            Some(Dialect::Urscript)
        } else if line.starts_with('&') || line.starts_with(";FOLD") || KRL.iter().any(&begins) {
            Some(Dialect::Krl)
        } else if RAPID.iter().any(begins) {
            Some(Dialect::Rapid)
        } else {
            block::begins_block(line.as_bytes()).then_some(Dialect::Gcode)
        }
    })
}
