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
}

impl Parameter {
    /// All of them.
    pub const ALL: [Self; 6] =
        [Self::DepositionSpeed, Self::WireFeedSpeed, Self::Job, Self::Stepover, Self::Dwell, Self::Angle];

    /// Its name, as in a profile.
    pub fn name(self) -> &'static str {
        match self {
            Self::DepositionSpeed => "deposition_speed",
            Self::WireFeedSpeed => "wire_feed_speed",
            Self::Job => "job",
            Self::Stepover => "stepover",
            Self::Dwell => "dwell",
            Self::Angle => "angle",
        }
    }

    /// Its column in the sheet: name and unit.
    pub fn column(self) -> &'static str {
        match self {
            Self::DepositionSpeed => "deposition_speed_mm_s",
            Self::WireFeedSpeed => "wire_feed_speed_m_min",
            Self::Job => "job",
            Self::Stepover => "stepover",
            Self::Dwell => "dwell_s",
            Self::Angle => "angle_deg",
        }
    }

    /// Its unit as read by people; empty for numbers.
    pub fn unit(self) -> &'static str {
        match self {
            Self::DepositionSpeed => "mm/s",
            Self::WireFeedSpeed => "m/min",
            Self::Job => "",
            Self::Stepover => "of the width",
            Self::Dwell => "s",
            Self::Angle => "°",
        }
    }

    /// The least and the greatest value that make sense.
    fn range(self) -> (f64, f64) {
        match self {
            Self::DepositionSpeed => (0.1, 200.0),
            Self::WireFeedSpeed => (0.1, 100.0),
            Self::Job => (0.0, 9999.0),
            Self::Stepover => (0.3, 1.5),
            Self::Dwell => (0.0, 3600.0),
            Self::Angle => (10.0, 180.0),
        }
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
        let parameter = Parameter::ALL.into_iter().find(|parameter| parameter.name() == name.trim());
        let parameter = parameter.ok_or_else(|| FactorError::Unknown(name.trim().to_owned()))?;
        let number = |text: &str| text.trim().parse::<f64>().ok().filter(|value| value.is_finite());
        let (values, listed): (Option<Vec<f64>>, bool) = match values.split_once("..") {
            Some((low, high)) => (number(low).zip(number(high)).map(|(low, high)| vec![low, high]), false),
            None => (values.split(',').map(number).collect(), true),
        };
        let values = values.ok_or_else(form)?;
        let (least, most) = parameter.range();
        if let Some(value) = values.iter().find(|value| !(least..=most).contains(*value)) {
            return Err(FactorError::Range { parameter, value: *value, least, most });
        }
        if values.len() < 2 || values.windows(2).any(|pair| pair[0] >= pair[1]) {
            return Err(FactorError::Order(text.to_owned()));
        }
        if parameter == Parameter::Job && (!listed || values.iter().any(|value| value.fract() != 0.0)) {
            return Err(FactorError::Jobs(text.to_owned()));
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
    #[error("trials vary deposition_speed, wire_feed_speed, job, stepover, dwell or angle, not \"{0}\".")]
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
    #[error("\"{0}\": jobs are whole numbers and are given one by one, such as job=11,12,15.")]
    Jobs(String),
}
