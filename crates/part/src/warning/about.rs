//! The causes and remedies of warnings, for the page of all warnings (`docs/book/checks.md`).

use super::WarningKind;

/// What a welder should know about a kind of warning.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct About {
    /// The word in `metrics.json`.
    pub name: &'static str,
    /// The cause, as part of a sentence.
    pub cause: &'static str,
    /// What to do, as part of a sentence.
    pub remedy: &'static str,
}

impl WarningKind {
    /// All kinds, in their order.
    pub const ALL: [Self; 27] = [
        Self::GapClosed,
        Self::OpenContourDropped,
        Self::ContoursUnited,
        Self::ThinFeature,
        Self::IslandTooSmall,
        Self::ThinWall,
        Self::Refilled,
        Self::Bare,
        Self::Undersize,
        Self::Unsound,
        Self::HighStart,
        Self::NothingBelow,
        Self::InTheAir,
        Self::OverUnwelded,
        Self::HangingIsland,
        Self::LayerThickness,
        Self::Overhang,
        Self::ShortArc,
        Self::Relit,
        Self::ManyPoints,
        Self::Sliver,
        Self::PassTooShort,
        Self::NeverCools,
        Self::HotAhead,
        Self::Paused,
        Self::TooCold,
        Self::EmptyLayer,
    ];

    /// Cause and remedy.
    pub fn about(self) -> About {
        let (name, cause, remedy) = match self {
            Self::GapClosed => (
                "gap-closed",
                "the surface of the model has a gap, which was bridged",
                "check that the gap is not wider than you accept, and repair the model if it is",
            ),
            Self::OpenContourDropped => (
                "open-contour-dropped",
                "the surface has a hole or a slit, so a contour does not close and is left out",
                "repair the model, bridge wider gaps with slice.close_gap, or say what the surface is (slice.surface)",
            ),
            Self::ContoursUnited => (
                "contours-united",
                "solids of the model overlap, or a surface is wound the wrong way",
                "check the picture of the layer; unite the solids in CAD if it is wrong",
            ),
            Self::ThinFeature => (
                "thin-feature",
                "a place is thinner than wall.thinnest, or a short neck, or the strategy is raster, which welds no thin walls",
                "use a narrower bead or a thicker part; where the strategy is raster, another one welds thin walls",
            ),
            Self::IslandTooSmall => (
                "island-too-small",
                "an island has no room for a bead",
                "use a narrower bead or a larger part, or say how dots are welded ([spot])",
            ),
            Self::ThinWall => (
                "thin-wall",
                "a wall is thinner than the narrowest bead, so metal lies outside it",
                "machine it off, or allow narrower beads if the process can weld them ([loop], [wall])",
            ),
            Self::Refilled => (
                "refilled",
                "the strategy would have left the outline or crossed itself there, so another one fills the island, the best by the deposit model",
                "check the picture of the layer, and use another strategy if it is not acceptable",
            ),
            Self::Bare => ("bare", "beads do not reach part of an island", "choose a strategy that leaves less"),
            Self::Undersize => (
                "undersize",
                "beads do not reach a corner of the preform, or leave a gap, and the part that is milled from it ends there",
                "add stock (preform.side, preform.top, preform.bottom), or choose a strategy that leaves less",
            ),
            Self::Unsound => (
                "unsound",
                "passes leave the part or cross each other, and nothing could replace them",
                "use another strategy or another bead.width",
            ),
            Self::HighStart => (
                "high-start",
                "the lowest layers have no room for a bead, for example under a round part, so the first bead would be laid in \
                 the air",
                "begin at that height, stand the part on a flat face, or use a narrower bead (bead.width)",
            ),
            Self::NothingBelow => (
                "nothing-below",
                "the beads of a whole layer would be laid in the air",
                "begin at that height, turn the part, or use a narrower bead (bead.width), for which the layers below have room",
            ),
            Self::InTheAir => (
                "in-the-air",
                "a pass has no bead below for more than half of its length, or for two bead widths in a row",
                "turn the part, begin above the place, or add metal below that is machined off",
            ),
            Self::OverUnwelded => (
                "over-unwelded",
                "what lies below a pass got no bead, as a rule because it is too narrow, so the pass would be laid in the air",
                "use a narrower bead (bead.width), enlarge the part, or turn it",
            ),
            Self::HangingIsland => (
                "hanging-island",
                "a small island begins in the air, and nothing is built on it, or a pass of two bead widths hangs in the air, so \
                 it is left out",
                "turn the part, or add metal below that is machined off, if the island matters",
            ),
            Self::LayerThickness => (
                "layer-thickness",
                "the guide bends so tightly that the inner side of a layer is too thin for a bead, or half of its outer side too thick",
                "bend the guide less, divide the part, or widen the window (layers.min_height, layers.max_height) if your beads bear \
                 it",
            ),
            Self::Overhang => (
                "overhang",
                "a layer reaches farther beyond the one below than check.max_overhang",
                "turn the part, use a turn table, or add metal below that is machined off",
            ),
            Self::ShortArc => (
                "short-arc",
                "a pass is over before its arc burns steadily",
                "raise fill.min_pass_length to leave it out, or use a strategy with longer passes",
            ),
            Self::Relit => (
                "relit",
                "a pass has more points than one program of the controller may hold, so it is cut",
                "fit straight moves and arcs (program.chord_tolerance, program.arcs), so that fewer passes are cut",
            ),
            Self::ManyPoints => (
                "many-points",
                "a layer has more points than check.max_points",
                "raise slice.simplify, or fit arcs (program.arcs)",
            ),
            Self::Sliver => (
                "sliver",
                "shells of the model touch with a gap too thin to be intended, and it is left out",
                "nothing, as a rule; unite the shells in CAD if the place matters",
            ),
            Self::PassTooShort => (
                "pass-too-short",
                "a pass would be shorter than fill.min_pass_length, or over before the arc is steady in programs that do not wait \
                 for it (no {{arc_start_delay}} where the arc is struck), and is left out",
                "lower fill.min_pass_length if your arc is steady sooner, or use another strategy",
            ),
            Self::NeverCools => (
                "never-cools",
                "metal stays above interpass.max_temperature for ten hours",
                "raise the limit, preheat less (substrate.preheat), or use a thicker plate or better contact",
            ),
            Self::HotAhead => (
                "hot-ahead",
                "a long pass comes back to metal that it has heated itself, and no wait within a pass lets that cool",
                "let the torch wait within passes (interpass.along = true), wait longer before passes (a lower \
                 interpass.max_temperature), or use a strategy with shorter passes",
            ),
            Self::Paused => (
                "paused",
                "with interpass.along the limit also holds along passes, so a pass ends before metal that is too hot",
                "a higher interpass.max_temperature or a thicker plate needs fewer cuts",
            ),
            Self::TooCold => (
                "too-cold",
                "metal is colder than interpass.min_temperature where a pass begins",
                "heat the plate (substrate.preheat), or wait less",
            ),
            Self::EmptyLayer => (
                "empty-layer",
                "the part has a gap at this height, or all contours there were dropped",
                "check the layer's other warnings; join the two halves in CAD, or plan them as two parts",
            ),
        };
        About { name, cause, remedy }
    }
}
