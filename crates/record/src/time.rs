//! Times in logs: seconds, milliseconds, or ISO 8601.

use jiff::Timestamp;
use jiff::civil::DateTime;
use jiff::tz::Offset;

/// How the times of a log are written.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Style {
    /// Numbers, in a unit that lasts this many seconds.
    Number(f64),
    /// ISO 8601; without an offset it counts as UTC.
    Iso,
}

impl Style {
    /// The style of a log whose first time is `text`, in a column with this unit.
    pub(crate) fn of(text: &str, unit: &str) -> Result<Self, String> {
        if iso(text).is_some() {
            return Ok(Self::Iso);
        }
        let seconds = match unit {
            "" | "s" => 1.0,
            "ms" => 1e-3,
            "us" | "µs" => 1e-6,
            "min" => 60.0,
            "h" => 3600.0,
            other => return Err(format!("times in {other} are not understood; give them in s or ms, or as ISO 8601.")),
        };
        Ok(Self::Number(seconds))
    }

    /// Seconds, since 1970 where the times have a date.
    pub(crate) fn seconds(self, text: &str, decimal_comma: bool) -> Option<f64> {
        match self {
            Self::Iso => iso(text),
            Self::Number(unit) => number(text, decimal_comma).map(|value| value * unit),
        }
    }
}

/// A finite number.
pub(crate) fn number(text: &str, decimal_comma: bool) -> Option<f64> {
    let parsed = match decimal_comma && text.contains(',') {
        true => text.replace(',', ".").parse::<f64>(),
        false => text.parse::<f64>(),
    };
    parsed.ok().filter(|value| value.is_finite() && value.abs() < 1e15)
}

fn iso(text: &str) -> Option<f64> {
    let zoned = text.parse::<Timestamp>().ok();
    let instant = zoned.or_else(|| Offset::UTC.to_timestamp(text.parse::<DateTime>().ok()?).ok())?;
    Some(instant.as_nanosecond() as f64 * 1e-9)
}
