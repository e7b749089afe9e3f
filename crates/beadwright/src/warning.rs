//! Nothing is lost in silence: whatever is dropped, closed or cannot be built is a [`Warning`], and
//! [`Warnings`] sums them up over the layers in sentences for people.

use glam::DVec2;
use serde::Serialize;
use std::collections::BTreeMap;

/// What happened.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
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
    /// Part of the slice is narrower than the narrowest bead and gets such a bead, which reaches outside; the size is
    /// its area, mm².
    ThinWall,
    /// The strategy could not fill an island (its passes left it, crossed, or were none), and contours fill it instead; the
    /// size is its area, mm².
    Refilled,
    /// A pass was shorter than the shortest allowed and was dropped; the size is its length, mm.
    PassTooShort,
    /// A layer between the lowest and the highest holds nothing.
    EmptyLayer,
}

/// One event on one layer.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
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

/// All events of one kind.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct WarningSummary {
    /// What happened.
    pub kind: WarningKind,
    /// How often.
    pub count: usize,
    /// Layers, as ranges of indices from 0, both ends included.
    pub layers: Vec<(usize, usize)>,
    /// The largest one.
    pub largest: Warning,
    /// Sum of the sizes, in the unit of the kind.
    pub total: f64,
}

/// The events of a run, summed up by kind.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Warnings(BTreeMap<WarningKind, WarningSummary>);

impl Warnings {
    /// Counts one event; events come in the order of layers.
    pub fn add(&mut self, warning: Warning) {
        let summary = self.0.entry(warning.kind).or_insert_with(|| WarningSummary {
            kind: warning.kind,
            count: 0,
            layers: Vec::new(),
            largest: warning,
            total: 0.0,
        });
        summary.count += 1;
        summary.total += warning.size;
        if warning.size > summary.largest.size {
            summary.largest = warning;
        }
        match summary.layers.last_mut() {
            Some((_, last)) if warning.layer <= *last + 1 => *last = warning.layer.max(*last),
            _ => summary.layers.push((warning.layer, warning.layer)),
        }
    }

    /// The sums, by kind.
    pub fn summaries(&self) -> impl Iterator<Item = &WarningSummary> {
        self.0.values()
    }
}

impl WarningSummary {
    /// One sentence with layer range, place, size and remedy.
    pub fn sentence(&self) -> String {
        let Self { count, largest, total, .. } = self;
        let (layers, place, size) = (self.layer_text(), place_text(largest), largest.size);
        let times = |one: &str, many: &str| format!("{count} {}", if *count == 1 { one } else { many });
        match self.kind {
            WarningKind::GapClosed => {
                format!("{layers}: {} in the surface bridged, the widest {size:.3} mm {place}.", times("gap", "gaps"))
            }
            WarningKind::OpenContourDropped => format!(
                "{layers}: {} dropped, the longest {size:.1} mm long {place}. The surface has a hole or a slit \
                 there: mend the model, or bridge wider gaps (slice.close_gap, mm).",
                times("open contour", "open contours")
            ),
            WarningKind::ContoursUnited => format!(
                "{layers}: overlapping or wrongly wound contours united, changing at most {size:.1} mm² {place}. \
                 Check the picture of the layer."
            ),
            WarningKind::ThinFeature => format!(
                "{layers}: {} narrower than a bead left empty, {total:.1} mm² in all, the largest {size:.1} mm² \
                 {place}.",
                times("feature", "features")
            ),
            WarningKind::ThinWall => format!(
                "{layers}: {} thinner than the narrowest bead and welded with that, {total:.1} mm² in all, the largest \
                 {size:.1} mm² {place}. Metal lies beside them.",
                times("wall", "walls")
            ),
            WarningKind::IslandTooSmall => format!(
                "{layers}: {} narrower than a bead left out, {total:.1} mm² in all, the largest {size:.1} mm² \
                 {place}. A narrower bead or a larger part would be needed.",
                times("island", "islands")
            ),
            WarningKind::Refilled => format!(
                "{layers}: {} that the strategy could not fill without leaving the outline or crossing its own passes, \
                 filled with contours instead, {total:.1} mm² in all, the largest {size:.1} mm² {place}.",
                times("island", "islands")
            ),
            WarningKind::PassTooShort => format!(
                "{layers}: {} left out that would be shorter than fill.min_pass_length or over before the arc is \
                 steady (process.arc_start_delay), {total:.1} mm in all, the longest \
                 {size:.1} mm {place}.",
                times("pass", "passes")
            ),
            WarningKind::EmptyLayer => format!("{layers}: nothing to deposit. The part has a gap there."),
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

fn place_text(w: &Warning) -> String {
    format!("(layer {}, near x {:.1} y {:.1} mm)", w.layer + 1, w.place.x, w.place.y)
}
