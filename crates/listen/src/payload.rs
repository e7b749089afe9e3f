//! Cells and times of the log from what was sent.

use crate::source::{Column, Time, TimeUnit};
use jiff::Timestamp;
use serde_json::Value;

/// Longest text that a cell takes.
const LONGEST: usize = 500;

/// What a message holds: JSON, or else text.
pub(crate) fn parsed(payload: &[u8]) -> Value {
    serde_json::from_slice(payload).unwrap_or_else(|_| Value::String(String::from_utf8_lossy(payload).into_owned()))
}

/// The cell of a column; `None` where the message lacks its field.
pub(crate) fn cell(message: &Value, column: &Column) -> Result<Option<String>, String> {
    field(message, column.field.as_deref()).map(|value| of_value(value, column)).transpose()
}

fn of_value(value: &Value, column: &Column) -> Result<String, String> {
    match column.is_text() {
        true => Ok(text(value)),
        false => number(value).map(|number| number.to_string()),
    }
}

/// The time that a message carries, as the log has it.
pub(crate) fn time(message: &Value, time: &Time) -> Result<String, String> {
    let missing = || format!("it has no field {}, which holds the time: {}", time.field, short(message));
    let value = field(message, Some(&time.field)).ok_or_else(missing)?;
    if time.unit == TimeUnit::Iso {
        let text = text(value);
        let parsed: Result<Timestamp, _> = text.parse();
        return parsed.map(iso).map_err(|_| format!("\"{text}\" is not a time of ISO 8601 with an offset or Z."));
    }
    let count = number(value)?;
    let seconds = count
        * match time.unit {
            TimeUnit::Ms | TimeUnit::UnixMs => 1e-3,
            TimeUnit::Us => 1e-6,
            _ => 1.0,
        };
    if matches!(time.unit, TimeUnit::Unix | TimeUnit::UnixMs) {
        return micros((seconds * 1e6).round() as i64).ok_or_else(|| format!("{count} is not a time since 1970."));
    }
    Ok(seconds.to_string())
}

/// A number of microseconds since 1970 as the log has it.
pub(crate) fn micros(since_1970: i64) -> Option<String> {
    Timestamp::from_microsecond(since_1970).ok().map(iso)
}

/// The present time by the clock of this machine.
pub(crate) fn now() -> String {
    iso(Timestamp::now())
}

fn iso(time: Timestamp) -> String {
    format!("{time:.6}")
}

/// The value under a path such as `data.current` or `values.0`.
fn field<'a>(message: &'a Value, path: Option<&str>) -> Option<&'a Value> {
    let pointer = path.map_or(String::new(), |path| format!("/{}", path.replace('.', "/")));
    message.pointer(&pointer).filter(|value| !value.is_null())
}

fn number(value: &Value) -> Result<f64, String> {
    let number = match value {
        Value::Number(number) => number.as_f64(),
        Value::Bool(on) => Some(f64::from(u8::from(*on))),
        Value::String(text) => of_text(text.trim()),
        _ => None,
    };
    number.filter(|number| number.is_finite()).ok_or_else(|| format!("{} is not a number.", short(value)))
}

/// A number with a decimal point or comma, or a word for on or off.
fn of_text(text: &str) -> Option<f64> {
    match text.to_lowercase().as_str() {
        "on" | "true" | "yes" => Some(1.0),
        "off" | "false" | "no" => Some(0.0),
        text => text.replacen(',', ".", 1).parse().ok(),
    }
}

/// Text in one line.
pub(crate) fn text(value: &Value) -> String {
    let text = value.as_str().map_or_else(|| value.to_string(), str::to_owned);
    text.trim().chars().take(LONGEST).map(|c| if c.is_control() { ' ' } else { c }).collect()
}

pub(crate) fn short(value: &Value) -> String {
    let text = text(value);
    let cut: String = text.chars().take(60).collect();
    if cut.len() < text.len() { format!("\"{cut}…\"") } else { format!("\"{cut}\"") }
}
