//! What a job may ask for that only some dialects can write.

use super::{DialectError, Job};
use crate::dialect::Section;

/// Something that only some dialects can write.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Extra {
    /// Programs that begin at any pass (`program.restart`).
    Restart,
    /// Heights added to layers (`program.layer_offsets`).
    LayerOffsets,
    /// The controller's own weaving (`[weave]`).
    Weave,
    /// A torch that leans (`program.follow_wall`, `program.travel_angle`).
    Tilt,
}

impl Extra {
    const ALL: [Self; 4] = [Self::Restart, Self::LayerOffsets, Self::Weave, Self::Tilt];

    fn is_asked(self, job: &Job<'_>) -> bool {
        match self {
            Self::Restart => job.program.restart,
            Self::LayerOffsets => job.program.layer_offsets,
            // A dry run has no arc to weave.
            Self::Weave => job.weave.is_some() && !job.dry_run,
            Self::Tilt => job.program.tilts(),
        }
    }

    /// What it is in a profile, and what to do without it.
    fn told(self) -> (&'static str, &'static str) {
        match self {
            Self::Restart => (
                "program.restart = true",
                "Take it out; a stopped build goes on with plan --from-layer N --from-pass N.",
            ),
            Self::LayerOffsets => {
                ("program.layer_offsets = true", "Take it out; KRL, RAPID, FANUC and URScript have it.")
            }
            Self::Weave => (
                "[weave]",
                "Controllers weave with ArcTech, RobotWare Arc, FANUC and Yaskawa; take [weave] out for others.",
            ),
            Self::Tilt => (
                "program.follow_wall or program.travel_angle",
                "Only robots lean their torch; set both to 0 for others.",
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
