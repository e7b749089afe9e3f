//! A DXF drawing as text: pairs of lines, code and value, that form entities.

use super::super::ImportError;
use glam::DVec2;

/// An entity of a drawing.
pub(super) struct Entity<'a> {
    /// `LINE`, `ARC` …
    pub(super) name: &'a str,
    /// The line of the file on which it begins, from 1.
    pub(super) line: usize,
    /// Its codes and values.
    pub(super) groups: Vec<(i32, &'a str)>,
}

/// The entities of a drawing and the number that gives its unit.
pub(super) struct Drawing<'a> {
    pub(super) entities: Vec<Entity<'a>>,
    pub(super) unit: i32,
}

pub(super) fn broken(reason: String) -> ImportError {
    ImportError::Broken { format: "DXF", reason }
}

/// Splits the text of a drawing into entities.
///
/// # Errors
/// [`ImportError::Broken`] with the line that is not a code.
pub(super) fn drawing(text: &str) -> Result<Drawing<'_>, ImportError> {
    let mut drawing = Drawing { entities: Vec::new(), unit: 0 };
    let (mut section, mut variable) = ("", "");
    let mut lines = (1..).zip(text.lines());
    while let Some((number, code)) = lines.next() {
        let Some((_, value)) = lines.next() else { break };
        let code = code.trim();
        let code: i32 = code
            .parse()
            .map_err(|_| broken(format!("line {number}: a code is expected, but \"{}\" was found", shown(code))))?;
        let value = value.trim();
        match (code, section) {
            (0, _) if value == "ENDSEC" => section = "",
            (0, "ENTITIES") => {
                drawing.entities.push(Entity { name: value, line: number + 1, groups: Vec::new() });
            }
            (2, "") => section = value,
            (9, "HEADER") => variable = value,
            (70, "HEADER") if variable == "$INSUNITS" => drawing.unit = value.parse().unwrap_or(0),
            (_, "ENTITIES") => {
                drawing.entities.last_mut().into_iter().for_each(|entity| entity.groups.push((code, value)));
            }
            _ => {}
        }
    }
    Ok(drawing)
}

/// The beginning of a possibly long text.
fn shown(text: &str) -> String {
    text.chars().take(20).collect()
}

impl Entity<'_> {
    /// The number with this code; `missing` if there is none.
    pub(super) fn number(&self, code: i32, missing: f64) -> Result<f64, ImportError> {
        let value = self.groups.iter().find(|(other, _)| *other == code).map(|(_, value)| *value);
        value.map_or(Ok(missing), |value| self.parsed(code, value))
    }

    /// The point whose x has this code.
    pub(super) fn point(&self, code: i32) -> Result<DVec2, ImportError> {
        let number = |code| match self.number(code, f64::NAN)? {
            value if value.is_nan() => Err(self.broken(&format!("the coordinate {code} is missing"))),
            value => Ok(value),
        };
        Ok(DVec2::new(number(code)?, number(code + 10)?))
    }

    /// The bits of code 70.
    pub(super) fn flags(&self) -> Result<u32, ImportError> {
        Ok(self.number(70, 0.0)?.max(0.0) as u32)
    }

    pub(super) fn parsed(&self, code: i32, value: &str) -> Result<f64, ImportError> {
        let number = value.parse::<f64>().ok().filter(|number| number.is_finite());
        number.ok_or_else(|| self.broken(&format!("\"{}\" (code {code}) is not a number", shown(value))))
    }

    pub(super) fn broken(&self, reason: &str) -> ImportError {
        broken(format!("line {}, {}: {reason}", self.line, self.name))
    }
}
