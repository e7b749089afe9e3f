//! What is doubtful about a part, in sentences.

use crate::planned::Spot;
use crate::quantity::Quantity;

/// What kind of thing was found; the gravest first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// A planned pass for which no arc was seen.
    NotWelded,
    /// The arc was out within a pass.
    ArcLost,
    /// A quantity left its window.
    OutOfWindow(Quantity),
    /// A scan shows it higher or lower than planned.
    Height,
    /// The pass began on metal that was too hot.
    TooHot,
    /// The arc was struck again within a pass.
    StruckAgain,
    /// The pass was begun several times.
    Repeated,
    /// The pass took longer or shorter than planned.
    Pace,
    /// An arc that belongs to no planned pass.
    Extra,
    /// The build stood still before the pass.
    Stop,
    /// No log has rows of this stretch.
    NotLogged,
    /// A log has no rows for some time.
    Gap,
    /// A log lost the connection to what it logs.
    Interrupted,
    /// The clock of a log was set.
    ClockSet,
    /// The clock of a log runs slow or fast.
    ClockDrift,
    /// The clock of a log could not be aligned.
    ClockUnknown,
    /// Rows of a log are doubled, late or broken.
    Rows,
}

impl Kind {
    /// Its name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::NotWelded => "not welded",
            Self::ArcLost => "arc lost",
            Self::OutOfWindow(quantity) => quantity.word(),
            Self::Height => "height",
            Self::TooHot => "too hot",
            Self::StruckAgain => "struck again",
            Self::Repeated => "repeated",
            Self::Pace => "pace",
            Self::Extra => "extra arc",
            Self::Stop => "stop",
            Self::NotLogged => "not logged",
            Self::Gap => "rows missing",
            Self::Interrupted => "interrupted",
            Self::ClockSet => "clock set",
            Self::ClockDrift => "clock drift",
            Self::ClockUnknown => "clock unknown",
            Self::Rows => "rows",
        }
    }

    /// Whether it is about the part, not about its logs.
    pub fn is_of_part(self) -> bool {
        self < Self::NotLogged
    }
}

/// Something doubtful.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Finding {
    /// What it is.
    pub kind: Kind,
    /// Index of the planned pass, where there is one.
    pub pass: Option<usize>,
    /// When it begins and ends, s by the reference, where it has a time.
    pub time: Option<[f64; 2]>,
    /// Planned times of the places, s from the start of the build, where it has a place.
    pub planned: Option<[f64; 2]>,
    /// Where it begins and ends.
    pub place: Option<[Spot; 2]>,
    /// A sentence with values, units and place.
    pub sentence: String,
}

/// `x 12.3, y -4.0, z 6.0 mm`.
fn shown(spot: &Spot) -> String {
    let [x, y, z] = spot.at.to_array().map(|v| (v * 10.0).round() / 10.0 + 0.0);
    format!("x {x:.1}, y {y:.1}, z {z:.1} mm")
}

/// `from 12.3 to 18.0 mm along it (x … to x …)`.
pub(crate) fn stretch([from, to]: &[Spot; 2]) -> String {
    format!("from {:.1} to {:.1} mm along it ({} to {})", from.along, to.along, shown(from), shown(to))
}
