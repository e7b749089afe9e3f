//! Lines of the profile at places of a program that the sections of robots and machines share: `[krl.hooks]` and the like.

use crate::dialect::Templates;
use crate::program::ProgramSettings;
use serde::{Deserialize, Serialize};

/// Lines at places of a program; each list is empty by default.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Hooks {
    /// Lines at the beginning of the program that watch over the arc and over stops. These three lists are left out of dry
    /// runs, and where a package strikes the arc (ArcTech, RobotWare Arc), which watches it itself.
    pub watch: Vec<String>,
    /// Subprograms that the lines of the watch call, in languages that have `routines`.
    pub watch_routines: Vec<String>,
    /// Lines at the end of the program that make sure that arc, wire and gas are off.
    pub all_off: Vec<String>,
    /// Lines after `arc_on` that wait until the arc burns, for `{{arc_timeout}}` s at most, and say what happens if it does
    /// not. Packages that strike the arc themselves watch it too and need none;
    /// with ArcTech and RobotWare Arc these lines and `before_arc_off` are left out.
    pub arc_established: Vec<String>,
    /// Lines before `arc_off` while the arc still burns, such as one that ends the watch over it.
    pub before_arc_off: Vec<String>,
    /// Lines before a pass, with the torch above its start: a touch of the part, a line in the log.
    pub pass_start: Vec<String>,
    /// Lines after a pass, with the torch above the part.
    pub pass_end: Vec<String>,
    /// Lines after a layer, with the torch above the part.
    pub layer_end: Vec<String>,
    /// Lines before every layer except the first, with the torch above the part: a wait until a pyrometer finds it cool enough.
    pub interpass: Vec<String>,
    /// Lines before every `program.measure_every`-th layer, with the torch above the part: a touch that measures how high it has
    /// become.
    pub measure: Vec<String>,
}

impl Hooks {
    /// Names and lines.
    pub(in crate::dialect) fn templates(&self) -> Templates<'_> {
        vec![
            ("watch", &self.watch),
            ("watch_routines", &self.watch_routines),
            ("all_off", &self.all_off),
            ("arc_established", &self.arc_established),
            ("before_arc_off", &self.before_arc_off),
            ("pass_start", &self.pass_start),
            ("pass_end", &self.pass_end),
            ("layer_end", &self.layer_end),
            ("interpass", &self.interpass),
            ("measure", &self.measure),
        ]
    }

    /// The lines before the layer with this index, after those of `layer_start`.
    pub(in crate::dialect) fn before_layer(
        &self,
        layer_start: &[String],
        index: usize,
        program: &ProgramSettings,
    ) -> Vec<String> {
        let none = Vec::new();
        let interpass = if index > 0 { &self.interpass } else { &none };
        let due = index > 0 && index.is_multiple_of(program.measure_every);
        let measure = if due { &self.measure } else { &none };
        [layer_start, interpass, measure].concat()
    }

    /// Removes what deals with the arc, for a dry run or a package that does all of it.
    pub(in crate::dialect) fn without_arc(&mut self) {
        *self = Self {
            pass_start: std::mem::take(&mut self.pass_start),
            pass_end: std::mem::take(&mut self.pass_end),
            layer_end: std::mem::take(&mut self.layer_end),
            interpass: std::mem::take(&mut self.interpass),
            measure: std::mem::take(&mut self.measure),
            ..Self::default()
        };
    }
}
