//! Nothing is lost silently: whatever is dropped, closed or cannot be built becomes a [`Warning`], and [`Warnings`]
//! sums them up over the layers in sentences for people.

mod about;

pub use about::About;

use crate::finding::{Finding, Severity, as_sentence};
use glam::{DVec2, DVec3};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// What happened.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum WarningKind {
    /// A hole in the surface was bridged; the size is the widest gap, mm.
    GapClosed,
    /// An open contour could not be closed and was dropped; the size is its length, mm.
    OpenContourDropped,
    /// Contours overlap or run the wrong way; the size is the area by which the layer changed, mm².
    ContoursUnited,
    /// Part of the slice is narrower than a bead and gets none; the size is its area, mm².
    ThinFeature,
    /// A whole island is narrower than a bead and gets none; the size is its area, mm².
    IslandTooSmall,
    /// Part of the slice is narrower than the narrowest bead and still gets one, which reaches outside; the size is its
    /// area, mm².
    ThinWall,
    /// The strategy could not fill an island (its passes left it, crossed, or there were none), so another one does;
    /// the size is its area, mm².
    Refilled,
    /// Beads leave bare a part of an island that they could reach; the size is that area, mm².
    Bare,
    /// Beads leave bare an area needed for a face of the part that is milled from the preform; the size is that area,
    /// mm².
    Undersize,
    /// Passes leave the part or cross, and nothing else could replace them; the size is the island's area, mm².
    Unsound,
    /// The lowest layers have no room for a bead, so the first would be laid above the plate; the size is its height,
    /// mm.
    HighStart,
    /// A whole layer has no bead below it; the size is the gap, mm.
    NothingBelow,
    /// Less than half of a pass lies over metal, or a long section of it over none; the size is the length without
    /// metal below, mm.
    InTheAir,
    /// The same, above a part of the layer below that got no bead; the size is the length without metal below, mm.
    OverUnwelded,
    /// A small new island, or a stub of a bead, hangs in the air and was left out; the size is its area, mm².
    HangingIsland,
    /// A layer is thinner or thicker than its window allows; the size is by how much, mm.
    LayerThickness,
    /// Part of a layer reaches farther than check.max_overhang beyond the one below; the size is its area, mm².
    Overhang,
    /// A pass ends before its arc is steady; the size is its length, mm.
    ShortArc,
    /// A pass is too long for one program of the controller and was cut; the size is the number of extra arc starts.
    Relit,
    /// A layer has more points than check.max_points; the size is their number.
    ManyPoints,
    /// A hole or an island too thin to matter was left out; the size is its area, mm².
    Sliver,
    /// A pass was shorter than the shortest allowed and was dropped; the size is its length, mm.
    PassTooShort,
    /// Metal does not cool to interpass.max_temperature before a pass; the size is its temperature, °C.
    NeverCools,
    /// A pass that starts within interpass.max_temperature runs into hotter metal; the size is its temperature, °C.
    HotAhead,
    /// A pass was cut where the metal ahead of the torch would be too hot (interpass.along); the size is 1 for each cut.
    Paused,
    /// Metal is colder than interpass.min_temperature where a pass begins; the size is its temperature, °C.
    TooCold,
    /// A layer between the lowest and the highest holds nothing.
    EmptyLayer,
}

/// Holes and islands thinner than this are left out, mm.
pub const SLIVER_MM: f64 = 0.05;

impl WarningKind {
    /// Whether a program with this fault is written only on explicit request.
    pub fn forbids(self) -> bool {
        matches!(
            self,
            Self::Unsound
                | Self::HighStart
                | Self::NothingBelow
                | Self::InTheAir
                | Self::OverUnwelded
                | Self::LayerThickness
        )
    }

    /// How much a warning of this kind matters.
    pub fn severity(self) -> Severity {
        match self {
            kind if kind.forbids() => Severity::Serious,
            Self::GapClosed | Self::Sliver | Self::Paused | Self::Refilled | Self::EmptyLayer => Severity::Note,
            _ => Severity::Doubt,
        }
    }
}

impl From<&WarningSummary> for Finding {
    fn from(warning: &WarningSummary) -> Self {
        let largest = &warning.largest;
        Self {
            count: warning.count,
            layer: Some(largest.layer),
            place: Some(largest.place.extend(warning.z)),
            size: Some(largest.size),
            remedy: Some(as_sentence(warning.kind.about().remedy)),
            ..Self::new(warning.kind.about().name, warning.kind.severity(), warning.text())
        }
    }
}

/// One event on one layer.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Warning {
    /// What happened.
    pub kind: WarningKind,
    /// Layer index, from 0.
    pub layer: usize,
    /// Where, mm.
    pub place: DVec2,
    /// How much, in the unit of the kind.
    pub size: f64,
}

/// Summary of all warnings of one kind.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct WarningSummary {
    /// What happened.
    pub kind: WarningKind,
    /// Number of warnings.
    pub count: usize,
    /// Layers, as ranges of indices from 0, both ends included.
    pub layers: Vec<(usize, usize)>,
    /// The largest warning.
    pub largest: Warning,
    /// Height of the top of the largest one's layer, mm.
    pub z: f64,
    /// Its position in space, mm, if its layer is not level.
    #[serde(default)]
    pub at: Option<DVec3>,
    /// Sum of the sizes, in the unit of the kind.
    pub total: f64,
}

/// The warnings of a run, summed up by kind.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Warnings(BTreeMap<WarningKind, WarningSummary>);

impl Warnings {
    /// Counts one warning on a layer whose top lies at `z` (mm); warnings come in the order of layers.
    pub fn add(&mut self, warning: Warning, z: f64) {
        self.add_at(warning, z, None);
    }

    /// The same for a warning whose position in space (mm) differs from that on its layer.
    pub fn add_at(&mut self, warning: Warning, z: f64, at: Option<DVec3>) {
        let summary = self.0.entry(warning.kind).or_insert_with(|| WarningSummary {
            kind: warning.kind,
            count: 0,
            layers: Vec::new(),
            largest: warning,
            z,
            at,
            total: 0.0,
        });
        summary.count += 1;
        summary.total += warning.size;
        if warning.size > summary.largest.size {
            (summary.largest, summary.z, summary.at) = (warning, z, at);
        }
        match summary.layers.last_mut() {
            Some((_, last)) if warning.layer <= *last + 1 => *last = warning.layer.max(*last),
            _ => summary.layers.push((warning.layer, warning.layer)),
        }
    }

    /// The summaries, by kind.
    pub fn summaries(&self) -> impl Iterator<Item = &WarningSummary> {
        self.0.values()
    }
}

impl WarningSummary {
    /// What happened, with layer range, place and size, and what to do.
    pub fn sentence(&self) -> String {
        Finding::from(self).sentence()
    }

    /// What happened, with layer range, place and size.
    fn text(&self) -> String {
        let Self { count, largest, z, total, .. } = self;
        let at = self.at.unwrap_or(largest.place.extend(*z));
        let (layers, place, size) = (self.layer_text(), place_text(largest.layer, at), largest.size);
        let times = |one: &str, many: &str| format!("{count} {}", if *count == 1 { one } else { many });
        match self.kind {
            WarningKind::GapClosed => {
                format!("{layers}: {} in the surface bridged, the widest {size:.3} mm {place}.", times("gap", "gaps"))
            }
            WarningKind::OpenContourDropped => format!(
                "{layers}: {} dropped, the longest {size:.1} mm long {place}.",
                times("open contour", "open contours")
            ),
            WarningKind::ContoursUnited => format!(
                "{layers}: overlapping or wrongly wound contours united, changing at most {size:.1} mm² {place}."
            ),
            WarningKind::ThinFeature => format!(
                "{layers}: {} narrower than a bead left empty, {total:.1} mm² in all, the largest {size:.1} mm² \
                 {place}.",
                times("feature", "features")
            ),
            WarningKind::ThinWall => format!(
                "{layers}: {} thinner than the narrowest bead and welded with it, {total:.1} mm² in all, the largest \
                 {size:.1} mm² {place}. Metal lies outside them.",
                times("wall", "walls")
            ),
            WarningKind::IslandTooSmall => format!(
                "{layers}: {} left out with no room for a bead, {total:.1} mm² in all, the largest {size:.1} mm² {place}.",
                times("island", "islands")
            ),
            WarningKind::Refilled => format!(
                "{layers}: {} that the strategy could not fill without leaving the outline or crossing its own passes, \
                 filled by another strategy, {total:.1} mm² in all, the largest {size:.1} mm² {place}.",
                times("island", "islands")
            ),
            WarningKind::PassTooShort => format!(
                "{layers}: {} left out that would be shorter than fill.min_pass_length, or over before the arc is steady in \
                 programs that do not wait for it, {total:.1} mm in all, the longest {size:.1} mm {place}.",
                times("pass", "passes")
            ),
            WarningKind::Bare => format!(
                "{layers}: beads leave part of {} bare, {total:.1} mm² in all, the most {size:.1} mm² {place}.",
                times("island", "islands")
            ),
            WarningKind::Undersize => format!(
                "{layers}: metal is missing at faces of the part that is milled from this preform, {total:.1} mm² in all, the \
                 most {size:.1} mm² {place}."
            ),
            WarningKind::Unsound => format!(
                "{layers}: {} in which passes leave the part or cross each other {place}.",
                times("island", "islands")
            ),
            WarningKind::HighStart => {
                let base = if self.at.is_some() { "what its body stands on" } else { "the plate" };
                format!(
                    "{layers}: the layers below have no room for a bead; the first would be laid {size:.2} mm above {base} {place}."
                )
            }
            WarningKind::NothingBelow => {
                format!("{layers}: no bead lies below; these would be laid {size:.2} mm above the last one {place}.")
            }
            WarningKind::InTheAir if self.count == 1 => {
                format!("{layers}: 1 pass hangs over nothing, for {size:.1} mm {place}.")
            }
            WarningKind::InTheAir => format!(
                "{layers}: {} passes hang over nothing, for {total:.1} mm in all, the longest for {size:.1} mm {place}.",
                self.count
            ),
            WarningKind::OverUnwelded => format!(
                "{layers}: {} above places of the part that got no bead, {total:.1} mm in all, the longest for {size:.1} mm {place}.",
                times("pass lies", "passes lie")
            ),
            WarningKind::HangingIsland => format!(
                "{layers}: {} with nothing below left out, {total:.1} mm² in all, the largest {size:.1} mm² {place}.",
                times("small place", "small places")
            ),
            WarningKind::LayerThickness => format!(
                "{layers}: where the guide bends, layers are thinner than layers.min_height or thicker than layers.max_height, by up \
                 to {size:.2} mm {place}."
            ),
            WarningKind::Overhang => format!(
                "{layers}: places that reach farther beyond the layer below than check.max_overhang, {total:.1} mm² in all, \
                 the largest {size:.1} mm² {place}. Beads there have none below."
            ),
            WarningKind::ShortArc => format!(
                "{layers}: {} over before the arc is steady (process.arc_start_delay), the longest {size:.1} mm {place}.",
                times("pass is", "passes are")
            ),
            WarningKind::Relit => format!(
                "{layers}: {} longer than one program of the controller (max_points of its section), cut between programs: \
                 the arc is struck again {total:.0} times on the end of the bead, first {place}.",
                times("pass is", "passes are")
            ),
            WarningKind::ManyPoints => format!(
                "{layers}: more points than check.max_points, at most {size:.0}. The controller may not load the program."
            ),
            WarningKind::Sliver => format!(
                "{layers}: {} thinner than {SLIVER_MM} mm left out, {total:.2} mm² in all, the largest {size:.2} mm² {place}: \
                 gaps between shells that touch, or remains of the model's rounding.",
                times("hole or island", "holes or islands")
            ),
            WarningKind::NeverCools => format!(
                "{layers}: {} on metal that does not cool to interpass.max_temperature in ten hours; at most {size:.0} °C \
                 {place}.",
                times("pass begins", "passes begin")
            ),
            WarningKind::HotAhead => format!(
                "{layers}: {} hotter metal ahead of the torch than interpass.max_temperature allows where it begins, at most \
                 {size:.0} °C {place}. Waits cool the places where passes begin.",
                times("pass meets", "passes meet")
            ),
            WarningKind::Paused => format!(
                "{layers}: {} where the metal ahead would be hotter than interpass.max_temperature: the torch waits there, and \
                 the arc is struck again on the end of the bead, first {place}.",
                times("pass is cut", "passes are cut")
            ),
            WarningKind::TooCold => format!(
                "{layers}: {} on metal colder than interpass.min_temperature, for example at {size:.0} °C {place}.",
                times("pass begins", "passes begin")
            ),
            WarningKind::EmptyLayer => {
                format!("{layers}: nothing to deposit: the part has a gap there, or all of its contours were dropped.")
            }
        }
    }

    fn layer_text(&self) -> String {
        const SHOWN: usize = 6;
        let range =
            |&(a, b): &(usize, usize)| if a == b { format!("{}", a + 1) } else { format!("{}–{}", a + 1, b + 1) };
        let mut text = self.layers.iter().take(SHOWN).map(range).collect::<Vec<_>>().join(", ");
        if self.layers.len() > SHOWN {
            text += &format!(" … {}", self.layers.last().map_or(0, |l| l.1 + 1));
        }
        let single = matches!(self.layers[..], [(a, b)] if a == b);
        format!("{} {text}", if single { "Layer" } else { "Layers" })
    }
}

fn place_text(layer: usize, at: DVec3) -> String {
    format!("(layer {}, near x {:.1} y {:.1} z {:.1} mm)", layer + 1, at.x, at.y, at.z)
}
