//! Features that only some dialects can write.

use super::{DialectError, Job};
use crate::dialect::Section;
use bead_part::chart::Chart;

/// A feature that only some dialects can write.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Extra {
    /// Programs that begin at any pass (`program.restart`).
    Restart,
    /// Heights added to layers (`program.layer_offsets`).
    LayerOffsets,
    /// A torch that weaves (`[weave]`).
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
            Self::Chart => !job.weld.is_level(),
        }
    }

    /// Its name in a profile, and what to do without it.
    fn words(self) -> (&'static str, &'static str) {
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
                "Only robots turn their torch to layers that are not level, and CNC controls the part under it (gcode.positioner): choose \
                 another post, or leave layers.chart out.",
            ),
        }
    }
}

/// The feature that cannot be combined with layers that are not level, and what to do.
fn beside_chart(job: &Job<'_>) -> Option<(&'static str, &'static str)> {
    let (weld, program) = (&job.weld, job.program);
    let pairs = [
        (
            program.table_angle.is_some() || program.table_side.is_some(),
            "layers.chart together with program.table_angle or program.table_side",
            "The table would turn by angles on the unrolled layers: leave it out; program.positioner turns the part with its layers.",
        ),
        (
            program.layer_offsets,
            "layers.chart together with program.layer_offsets",
            "An offset moves a layer along z, and not along its normal: leave it out.",
        ),
        (
            weld.charts.iter().any(Chart::goes_around) && program.follow_wall != 0.0,
            "layers.chart together with program.follow_wall",
            "The torch already stands along the layer's normal: set program.follow_wall = 0.",
        ),
    ];
    pairs.into_iter().find(|(is_asked, ..)| *is_asked && !weld.is_level()).map(|(_, what, remedy)| (what, remedy))
}

/// Refuses a job that needs more than the dialect of a section can write.
pub(super) fn check(dialect: &'static str, section: &dyn Section, job: &Job<'_>) -> Result<(), DialectError> {
    if let Some((what, remedy)) = beside_chart(job) {
        return Err(DialectError::Cannot { dialect, what, remedy });
    }
    let missing = Extra::ALL.into_iter().find(|extra| extra.is_asked(job) && !section.supports(*extra));
    missing.map_or(Ok(()), |extra| {
        let (what, remedy) = extra.words();
        Err(DialectError::Cannot { dialect, what, remedy })
    })
}
