//! A process parameter that is varied in trials, and its values.

use std::fmt;
use std::str::FromStr;

/// What may be varied.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Parameter {
    /// Speed of the torch while the arc burns, mm/s.
    DepositionSpeed,
    /// Wire feed speed, m/min.
    WireFeedSpeed,
    /// Job of the power source.
    Job,
    /// Distance of neighbouring beads as a fraction of their width.
    Stepover,
    /// Time the torch waits before each layer of a wall, s.
    Dwell,
    /// Angle between the legs of a corner, °.
    Angle,
    /// Length of the hot start, mm.
    LeadInLength,
    /// Power along the hot start over the nominal power.
    LeadInPower,
    /// Length of the lead-out, mm.
    LeadOutLength,
    /// Power along the lead-out over the nominal power.
    LeadOutPower,
    /// Time for which the arc fills the crater, s.
    CraterFillTime,
    /// Wire feed while the crater is filled over the nominal one.
    CraterPower,
    /// Distance along the bead of a swing to both sides, mm.
    WeaveLength,
    /// How far the torch swings to each side, mm.
    WeaveAmplitude,
    /// How long it stays at each side, s.
    WeaveDwell,
    /// Number of the weaving file, on Yaskawa controllers.
    WeaveFile,
}

/// What is known of a parameter.
struct About {
    parameter: Parameter,
    /// Its key in a profile; what belongs to a trial only has none.
    key: Option<&'static str>,
    name: &'static str,
    column: &'static str,
    unit: &'static str,
    /// The least and the greatest value that make sense.
    range: (f64, f64),
}

const fn about(
    parameter: Parameter,
    name: &'static str,
    key: Option<&'static str>,
    column: &'static str,
    unit: &'static str,
    range: (f64, f64),
) -> About {
    About { parameter, key, name, column, unit, range }
}

/// A row for each parameter; in the order of [`Parameter`].
#[rustfmt::skip]
const ABOUT: [About; 16] = {
    use Parameter as P;
    [
        about(P::DepositionSpeed, "deposition_speed", Some("process.deposition_speed"), "deposition_speed_mm_s", "mm/s", (0.1, 200.0)),
        about(P::WireFeedSpeed, "wire_feed_speed", Some("process.wire_feed_speed"), "wire_feed_speed_m_min", "m/min", (0.1, 100.0)),
        about(P::Job, "job", Some("process.job"), "job", "", (0.0, 9999.0)),
        about(P::Stepover, "stepover", None, "stepover", "of the width", (0.3, 1.5)),
        about(P::Dwell, "dwell", None, "dwell_s", "s", (0.0, 3600.0)),
        about(P::Angle, "angle", None, "angle_deg", "°", (10.0, 180.0)),
        about(P::LeadInLength, "lead_in_length", Some("start_stop.lead_in_length"), "lead_in_length_mm", "mm", (0.0, 200.0)),
        about(P::LeadInPower, "lead_in_power", Some("start_stop.lead_in_power"), "lead_in_power", "× the power", (1.0, 4.0)),
        about(P::LeadOutLength, "lead_out_length", Some("start_stop.lead_out_length"), "lead_out_length_mm", "mm", (0.0, 200.0)),
        about(P::LeadOutPower, "lead_out_power", Some("start_stop.lead_out_power"), "lead_out_power", "× the power", (0.1, 1.0)),
        about(P::CraterFillTime, "crater_fill_time", Some("start_stop.crater_fill_time"), "crater_fill_time_s", "s", (0.0, 60.0)),
        about(P::CraterPower, "crater_power", Some("start_stop.crater_power"), "crater_power", "× the wire feed", (0.05, 1.0)),
        about(P::WeaveLength, "weave_length", Some("weave.length"), "weave_length_mm", "mm", (0.5, 50.0)),
        about(P::WeaveAmplitude, "weave_amplitude", Some("weave.amplitude"), "weave_amplitude_mm", "mm", (0.1, 25.0)),
        about(P::WeaveDwell, "weave_dwell", Some("weave.dwell"), "weave_dwell_s", "s", (0.0, 5.0)),
        about(P::WeaveFile, "weave_file", Some("weave.file"), "weave_file", "", (1.0, 255.0)),
    ]
};

impl Parameter {
    /// All of them.
    pub fn all() -> impl Iterator<Item = Self> {
        ABOUT.iter().map(|about| about.parameter)
    }

    fn about(self) -> &'static About {
        &ABOUT[self as usize]
    }

    /// Its name, as in a profile.
    pub fn name(self) -> &'static str {
        self.about().name
    }

    /// Its key in a profile; `None` for what belongs to a trial only.
    pub fn key(self) -> Option<&'static str> {
        self.about().key
    }

    /// The parameter with this name.
    pub fn named(name: &str) -> Option<Self> {
        Self::all().find(|parameter| parameter.name() == name)
    }

    /// Its column in the sheet: name and unit.
    pub fn column(self) -> &'static str {
        self.about().column
    }

    /// Its unit as read by people; empty for numbers.
    pub fn unit(self) -> &'static str {
        self.about().unit
    }

    /// Whether it says how beads begin and end.
    pub fn is_of_ends(self) -> bool {
        self.key().is_some_and(|key| key.starts_with("start_stop."))
    }

    /// Whether it is the number of something, so that nothing lies between two of its values.
    fn is_number(self) -> bool {
        matches!(self, Self::Job | Self::WeaveFile)
    }
}

/// A parameter with the values between or at which it is tried.
#[derive(Debug, Clone, PartialEq)]
pub struct Factor {
    /// The parameter.
    pub parameter: Parameter,
    /// Its values, if only these are possible, as for jobs; otherwise the ends of its range.
    values: Vec<f64>,
    listed: bool,
}

impl Factor {
    /// The number of values, if only some are possible.
    pub fn listed(&self) -> Option<usize> {
        self.listed.then_some(self.values.len())
    }

    /// The value at a fraction of the range, 0 to 1; of listed values, the nearest.
    pub fn at(&self, part: f64) -> f64 {
        let last = self.values.len() - 1;
        if self.listed {
            return self.values[((part * last as f64).round() as usize).min(last)];
        }
        let value = self.values[0] + part * (self.values[last] - self.values[0]);
        // A thousandth is finer than any machine is set; the sheet stays readable.
        (value * 1000.0).round() / 1000.0
    }
}

/// A factor as text: `deposition_speed=6..12`, or the values one by one: `job=11,12,15`.
impl FromStr for Factor {
    type Err = FactorError;

    fn from_str(text: &str) -> Result<Self, FactorError> {
        let form = || FactorError::Form(text.to_owned());
        let (name, values) = text.split_once('=').ok_or_else(form)?;
        let parameter = Parameter::named(name.trim()).ok_or_else(|| FactorError::Unknown(name.trim().to_owned()))?;
        let number = |text: &str| text.trim().parse::<f64>().ok().filter(|value| value.is_finite());
        let (values, listed): (Option<Vec<f64>>, bool) = match values.split_once("..") {
            Some((low, high)) => (number(low).zip(number(high)).map(|(low, high)| vec![low, high]), false),
            None => (values.split(',').map(number).collect(), true),
        };
        let values = values.ok_or_else(form)?;
        let (least, most) = parameter.about().range;
        if let Some(value) = values.iter().find(|value| !(least..=most).contains(*value)) {
            return Err(FactorError::Range { parameter, value: *value, least, most });
        }
        if values.len() < 2 || values.windows(2).any(|pair| pair[0] >= pair[1]) {
            return Err(FactorError::Order(text.to_owned()));
        }
        if parameter.is_number() && (!listed || values.iter().any(|value| value.fract() != 0.0)) {
            return Err(FactorError::Numbers(parameter));
        }
        Ok(Self { parameter, values, listed })
    }
}

impl fmt::Display for Parameter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// What cannot be varied so.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum FactorError {
    /// Not of the form NAME=MIN..MAX.
    #[error(
        "\"{0}\": NAME=MIN..MAX is expected, such as deposition_speed=6..12, or values one by one, such as job=11,12,15."
    )]
    Form(String),
    /// No such parameter.
    #[error("trials do not vary \"{0}\". Known: {known}.", known = known())]
    Unknown(String),
    /// A value beyond any sense.
    #[error("{parameter} = {value} is impossible: {least} to {most} {} are expected.", .parameter.unit())]
    Range {
        /// The parameter.
        parameter: Parameter,
        /// Its value.
        value: f64,
        /// The least that makes sense.
        least: f64,
        /// The most that makes sense.
        most: f64,
    },
    /// Not rising.
    #[error("\"{0}\": two values or more are expected, the least first.")]
    Order(String),
    /// Jobs between jobs.
    #[error("{0}: whole numbers are expected, one by one, such as {0}=11,12,15.")]
    Numbers(Parameter),
}

fn known() -> String {
    Parameter::all().map(Parameter::name).collect::<Vec<_>>().join(", ")
}
