//! Lines that would be dangerous on a controller, or that it would refuse: what a welding programmer looks for before
//! pressing start.

use super::Place;
use std::fmt;

/// A kind of dangerous line.
#[derive(Debug, PartialEq, Eq)]
pub struct FaultKind {
    /// The name people type.
    pub name: &'static str,
    /// What is found.
    pub what: &'static str,
    /// Why that matters.
    pub why: &'static str,
    /// What to do.
    pub remedy: &'static str,
}

/// A dangerous line of a program.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Fault {
    /// What kind it is.
    pub kind: &'static FaultKind,
    /// Where it was first found; `None` if it concerns the program as a whole.
    pub place: Option<Place>,
    /// How often it was found.
    pub count: usize,
    /// What was found: a sentence.
    pub text: String,
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (&self.place, self.count) {
            (None, _) => write!(f, "{}", self.text),
            (Some(place), 1) => write!(f, "{place}: {}", self.text),
            (Some(place), count) => write!(f, "{place} and {} more: {}", count - 1, self.text),
        }
    }
}

macro_rules! kinds {
    ($($(#[$doc:meta])* $constant:ident $name:literal $what:literal $why:literal $remedy:literal)*) => {
        $($(#[$doc])* pub(in crate::dialect) static $constant: FaultKind =
            FaultKind { name: $name, what: $what, why: $why, remedy: $remedy };)*

        /// The kinds of dangerous lines that are searched for.
        pub static FAULTS: &[&FaultKind] = &[$(&$constant),*];
    };
}

kinds! {
    STATIC_FRAME "static-frame"
        "an axis under the part that moves while the arc burns, and a part frame that does not move"
        "the table turns away below the path, so the bead is laid off the part"
        "let the frame turn with the table: krl.table_machine, rapid.table_unit"
    MISSING_AXIS "missing-axis"
        "targets, home included, some of which state an axis that others leave out"
        "the axis stays where it was, or the controller refuses the target"
        "state the axis in every target and at home"
    TURNING_TORCH "turning-torch"
        "a torch that turns with the tangent of an arc, or by more than 5° at over 30° per mm, with the arc on"
        "the wrist swings while metal is laid, and has to swing back in the next move"
        "hold the orientation along arcs: mode=0, $CIRC_TYPE = #BASE, CirPathMode \\ObjectFrame"
    BLENDED_SWITCH "blended-switch"
        "an arc that is struck or ended after a blended move"
        "the interpreter runs ahead: the arc is switched before the torch is there"
        "stop exactly at the point before the arc is switched"
    UNWATCHED_ARC "unwatched-arc"
        "an arc that is struck by outputs and that nothing watches"
        "if the arc goes out, the wire is fed on into the part"
        "arm an interrupt or a thread on the input of the burning arc: hooks.watch, hooks.arc_established"
    UNWATCHED_START "unwatched-start"
        "a watch that is armed without checking the arc's input afterwards"
        "interrupts act on the edge of a signal: an arc that went out before is never seen"
        "check the input once more after the watch is armed"
    UNWATCHED_END "unwatched-end"
        "a watch that is ended directly after a move"
        "the interpreter runs some moves ahead of the robot, so the end of the pass is not watched"
        "wait until the torch has stopped: WAIT SEC 0, WaitTime \\InPos,0;"
    ENDLESS_WAIT "endless-wait"
        "a wait for the arc without a time limit"
        "wire and arc stay commanded until somebody notices"
        "give the wait a time-out, and halt with arc and wire off when it is over"
    LEFT_ON "left-on"
        "a halt, a question or the end of a program with arc, wire or gas on"
        "nobody knows how long a halt takes"
        "switch arc, wire and gas off before the halt"
    STOP_LEAVES_ON "stop-leaves-on"
        "outputs of arc and wire that a stop of the program leaves as they are"
        "after a protective stop or a press of the stop key the arc burns on one spot"
        "tie the outputs to the program's run: $STOPMESS and SPS.SUB, TriggStopProc, run states of outputs"
    TWO_SWITCHES "two-switches"
        "outputs that are switched alongside a package that strikes the arc"
        "two ways of switching conflict"
        "use one of them: the package, or outputs"
    NO_OUTPUT "no-output"
        "an arc that is commanded and switches no output"
        "wire and gas run, and the arc never burns"
        "give the spindle a speed (M3 S1), or switch an output (M64)"
    CONFIGURATION "configuration"
        "targets whose configuration is unknown, and a controller that enforces it"
        "the robot stops at the first target, or winds its wrist to reach the posture"
        "switch both off: ConfL \\Off; ConfJ \\Off;"
    WEAVE_PITCH "weave-pitch"
        "a weave whose pitch or dwell at the sides changes with the speed by more than a tenth"
        "the bead becomes wider or narrower than planned"
        "let the weave follow the speed of each move"
    WEAVE_LEFT_ON "weave-left-on"
        "a torch that still weaves, or moves that are still shifted, where they should no longer be"
        "travels swing, and the next program begins shifted"
        "end the weave before the arc, and the shift with its layer"
    TOO_LARGE "too-large"
        "a program larger than the controller's memory or longer than its programs may be"
        "it does not load, or the build stops in the middle"
        "use longer moves (program.chord_tolerance), or write volumes (max_megabytes, max_points)"
    BAD_NAME "bad-name"
        "a program name that the controller does not accept"
        "it does not load"
        "rename the part"
    RAPID_WITH_ARC "rapid-with-arc"
        "a rapid or joint move with the arc on"
        "the torch leaves its path at a speed that lays no bead"
        "end the arc before it"
}

/// Dangerous lines, being collected.
#[derive(Debug, Clone, Default)]
pub(in crate::dialect) struct Faults(Vec<Fault>);

/// Most distinct faults of a kind that are kept.
const MOST_OF_A_KIND: usize = 10;

impl Faults {
    /// Adds a fault; the same at another line only increases the count, and a line has each kind at most once.
    pub(in crate::dialect) fn add(&mut self, kind: &'static FaultKind, place: Option<Place>, text: impl Into<String>) {
        let text = text.into();
        if place.is_some() && self.0.iter().any(|fault| fault.kind == kind && fault.place == place) {
            return;
        }
        let alike = |fault: &&mut Fault| fault.kind == kind && fault.text == text;
        if let Some(known) = self.0.iter_mut().find(alike) {
            known.count += 1;
        } else if self.0.iter().filter(|fault| fault.kind == kind).count() < MOST_OF_A_KIND {
            self.0.push(Fault { kind, place, count: 1, text });
        }
    }

    /// The collected faults, in the order of the kinds.
    pub(in crate::dialect) fn sorted(self) -> Vec<Fault> {
        let mut all = self.0;
        let rank = |fault: &Fault| FAULTS.iter().position(|kind| *kind == fault.kind);
        all.sort_by_key(rank);
        all
    }
}
