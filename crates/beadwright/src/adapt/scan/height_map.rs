//! A height map: a line `height_map x0=… y0=… step=…` in mm, then a line of heights for each row, the lowest y first.
//!
//! Heights are separated by commas, semicolons, tabs or spaces; where nothing was seen, there is `nan`, `-` or, between
//! commas, nothing.

use super::{ScanError, lines, number};
use glam::DVec3;

/// The word that the first line begins with.
const WORD: &str = "height_map";

/// The points; `None` where the text is not a height map.
pub(super) fn read(text: &str) -> Result<Option<Vec<DVec3>>, ScanError> {
    let mut lines = lines(text);
    let Some((line, head)) = lines.next().filter(|(_, head)| head.starts_with(WORD)) else { return Ok(None) };
    let [x0, y0, step] = head_values(head).map_err(|reason| ScanError::Line { line, reason })?;
    let mut points = Vec::new();
    for (row, (line, heights)) in lines.enumerate() {
        for (column, field) in fields(heights).into_iter().enumerate() {
            let reason = || format!("\"{}\" is not a height in mm", field.trim());
            let z = number(field).ok_or_else(|| ScanError::Line { line, reason: reason() })?;
            points.push(DVec3::new(x0 + column as f64 * step, y0 + row as f64 * step, z));
        }
    }
    Ok(Some(points))
}

fn head_values(head: &str) -> Result<[f64; 3], String> {
    let mut words = head[WORD.len()..].split([' ', ',', ';', '\t']).filter(|word| !word.is_empty());
    let mut values = [None; 3];
    for word in &mut words {
        let (name, value) = word.split_once('=').unwrap_or((word, ""));
        let place = ["x0", "y0", "step"].iter().position(|known| *known == name);
        let value = value.parse().ok().filter(|value: &f64| value.is_finite());
        match place.zip(value) {
            Some((place, value)) => values[place] = Some(value),
            None => return Err(format!("x0=…, y0=… and step=… in mm are expected, not \"{word}\"")),
        }
    }
    match values {
        [Some(x0), Some(y0), Some(step)] if step > 0.0 => Ok([x0, y0, step]),
        [_, _, Some(step)] if step <= 0.0 => Err(format!("the step must be above 0 mm, not {step}")),
        _ => Err("it must give x0, y0 and step in mm, such as height_map x0=-20 y0=0 step=0.5".to_owned()),
    }
}

fn fields(line: &str) -> Vec<&str> {
    match [';', ','].into_iter().find(|separator| line.contains(*separator)) {
        Some(separator) => line.split(separator).collect(),
        None => line.split_whitespace().collect(),
    }
}
