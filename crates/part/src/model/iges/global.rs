//! The global section: the file's delimiters, its unit and its scale.

use super::IgesError;
use super::cards::Card;
use super::free_format::{Delimiters, Parameters, Text};

/// Columns of a global card that hold data.
const WIDTH: usize = 72;

/// The data needed to read the rest of the file.
#[derive(Debug)]
pub(super) struct Global {
    pub(super) delimiters: Delimiters,
    /// Millimetres per unit of the coordinates, with the drawing scale removed.
    pub(super) unit_mm: f64,
    /// Points closer than this coincide, mm.
    pub(super) resolution_mm: f64,
    /// The program that wrote the file.
    pub(super) system: String,
}

/// Reads the global section; tolerable faults are added to `warnings`.
///
/// # Errors
/// [`IgesError::Global`] and [`IgesError::Unit`].
pub(super) fn read(cards: &[Card], warnings: &mut Vec<String>) -> Result<Global, IgesError> {
    let line = cards.first().map_or(0, |card| card.line);
    let error = |reason| IgesError::Global { line, reason };
    let text = Text::new(cards, WIDTH);
    let (delimiters, at) = delimiters(text.bytes()).map_err(error)?;
    let Some(at) = at else {
        return Err(error("it ends after the delimiters".to_owned()));
    };
    // The first field split here is global parameter 3.
    let global = text.split(at, delimiters).map_err(error)?;
    let parameter = |number: usize| number - 3;
    let scale = scale(&global, parameter(13), warnings).map_err(error)?;
    let unit_mm = unit(&global, parameter(14), parameter(15), warnings)? / scale;
    let resolution = global.real(parameter(19)).unwrap_or_default().abs();
    let system = global.text(parameter(5)).to_owned();
    Ok(Global { delimiters, unit_mm, resolution_mm: resolution * unit_mm, system })
}

/// The two delimiters, and where the third parameter begins (`None` if the section ends before it).
fn delimiters(text: &[u8]) -> Result<(Delimiters, Option<usize>), String> {
    let mut at = 0;
    let mut next = |default: u8, known: Option<u8>| -> Result<(u8, u8), String> {
        at += text[at..].iter().take_while(|b| **b == b' ').count();
        let mut chosen = default;
        if text[at..].starts_with(b"1H") {
            chosen = *text.get(at + 2).ok_or("it ends within the delimiters")?;
            at += 3;
        }
        at += text[at..].iter().take_while(|b| **b == b' ' && chosen != b' ').count();
        let end = *text.get(at).ok_or("it ends within the delimiters")?;
        at += 1;
        let expected = known.unwrap_or(chosen);
        if end == expected || (known.is_some() && end == chosen) {
            return Ok((chosen, end));
        }
        Err(format!("\"{}\" is where the delimiter \"{}\" belongs", end.escape_ascii(), expected.escape_ascii()))
    };
    let (parameter, _) = next(b',', None)?;
    let (record, end) = next(b';', Some(parameter))?;
    if parameter == record || [parameter, record].iter().any(|b| b.is_ascii_alphanumeric() || b"+-. ".contains(b)) {
        let (a, b) = (parameter.escape_ascii(), record.escape_ascii());
        return Err(format!("\"{a}\" and \"{b}\" cannot be the delimiters"));
    }
    Ok((Delimiters { parameter, record }, (end == parameter).then_some(at)))
}

/// Scale of the drawing: its lengths over those of the part; 1 if not given.
fn scale(global: &Parameters, i: usize, warnings: &mut Vec<String>) -> Result<f64, String> {
    if !global.has(i) {
        return Ok(1.0);
    }
    let scale = global.real(i)?;
    if scale <= 0.0 {
        return Err(format!("the scale of the drawing is {scale}, and must be above 0"));
    }
    if scale != 1.0 {
        warnings.push(format!(
            "The file says that it is drawn at scale {scale}; all coordinates were divided by that. \
             Check the size of the part."
        ));
    }
    Ok(scale)
}

/// Units by flag: name and millimetres. Flag 3 means "see the name".
const UNITS: [(i64, &[&str], f64); 10] = [
    (1, &["IN", "INCH"], 25.4),
    (2, &["MM"], 1.0),
    (4, &["FT"], 304.8),
    (5, &["MI"], 1_609_344.0),
    (6, &["M"], 1000.0),
    (7, &["KM"], 1e6),
    (8, &["MIL"], 0.0254),
    (9, &["UM"], 1e-3),
    (10, &["CM"], 10.0),
    (11, &["UIN"], 2.54e-5),
];

/// Millimetres per unit.
fn unit(global: &Parameters, flag: usize, name: usize, warnings: &mut Vec<String>) -> Result<f64, IgesError> {
    let name = global.text(name).to_uppercase();
    // An omitted flag means inches.
    let flag = if global.has(flag) { global.integer(flag).unwrap_or(0) } else { 1 };
    let by_flag = UNITS.iter().find(|(f, ..)| *f == flag);
    let by_name = UNITS.iter().find(|(_, names, _)| names.contains(&name.as_str()));
    match (by_flag, by_name) {
        (Some(unit), Some(other)) if unit.0 != other.0 => {
            warnings.push(format!(
                "The file's unit flag means {}, but its unit is called {name}; the flag was used. \
                 Check the size of the part.",
                unit.1[0]
            ));
            Ok(unit.2)
        }
        (Some(unit), _) | (None, Some(unit)) => Ok(unit.2),
        (None, None) => Err(IgesError::Unit { flag, name }),
    }
}
