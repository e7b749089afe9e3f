//! What a job may ask for that only some dialects can write.

use super::{DialectError, Job};
use crate::dialect::Section;

/// Something that only some dialects can write.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Extra {
    /// Programs that begin at any pass (`program.restart`).
    Restart,
    /// Heights added to layers (`program.layer_offsets`).
    LayerOffsets,
    /// A torch that swings (`[weave]`).
    Weave,
    /// A torch that leans (`program.follow_wall`, `program.travel_angle`).
    Tilt,
    /// Layers that are not level (`layers.chart`).
    Chart,
}

impl Extra {
    const ALL: [Self; 5] = [Self::Restart, Self::LayerOffsets, Self::Weave, Self::Tilt, Self::Chart];

    fn is_asked(self, job: &Job<'_>) -> bool {
        match self {
            Self::Restart => job.program.restart,
            Self::LayerOffsets => job.program.layer_offsets,
            Self::Weave => job.weave.is_some(),
            Self::Tilt => job.program.tilts(),
            Self::Chart => !job.weld.chart.is_level(),
        }
    }

    /// What it is in a profile, and what to do without it.
    fn told(self) -> (&'static str, &'static str) {
        match self {
            Self::Restart => (
                "program.restart = true",
                "Remove it; after a stop, programs are written from the layer and pass that come next. Robots support it, and \
                 CNC controls whose gcode.control is given and whose wire is not an axis.",
            ),
            Self::LayerOffsets => (
                "program.layer_offsets = true",
                "Remove it; robots support it, and CNC controls whose gcode.control is given.",
            ),
            Self::Weave => ("[weave]", "A printer does not weave: remove it."),
            Self::Tilt => (
                "program.follow_wall or program.travel_angle",
                "Only robots lean their torch; set both to 0 for others.",
            ),
            Self::Chart => (
                "layers.chart",
                "Only robots turn their torch to layers that are not level: choose a robot's post, or leave layers.chart out.",
            ),
        }
    }
}

/// Refuses a job that asks for more than the dialect of a section can write.
pub(super) fn check(dialect: &'static str, section: &dyn Section, job: &Job<'_>) -> Result<(), DialectError> {
    let missing = Extra::ALL.into_iter().find(|extra| extra.is_asked(job) && !section.supports(*extra));
    missing.map_or(Ok(()), |extra| {
        let (what, remedy) = extra.told();
        Err(DialectError::Cannot { dialect, what, remedy })
    })
}
