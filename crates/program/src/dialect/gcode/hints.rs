//! What the words and comments of a G-code file reveal about its machine.

use super::block::parse;

/// Results of a first pass through the whole file.
pub(super) struct Hints {
    /// Whether it has E words.
    pub(super) printer: bool,
    /// Diameter of the filament, mm.
    pub(super) diameter: Option<f64>,
    /// Whether E is a volume (UltiGCode).
    pub(super) volumetric: bool,
    /// Whether it has an O number alone on a line, as Fanuc controls require; their G4 P, if a whole number, is in
    /// milliseconds.
    pub(super) fanuc: bool,
}

/// Scans the file; slicers write the diameter at its end.
pub(super) fn of(text: &str) -> Hints {
    let mut hints = Hints { printer: false, diameter: None, volumetric: false, fanuc: false };
    for line in text.as_bytes().split(|&b| b == b'\n') {
        if let [b';', comment @ ..] = line {
            hints.diameter = hints.diameter.or_else(|| diameter(comment));
            hints.volumetric |= comment.starts_with(b"FLAVOR:UltiGCode");
        } else if !hints.printer {
            hints.fanuc |= is_number(line);
            hints.printer = extrudes(line);
        } else if hints.diameter.is_some() {
            break;
        }
    }
    hints
}

/// Whether a line is a program's number, such as `O1234`, perhaps with a comment.
fn is_number(line: &[u8]) -> bool {
    let code = line[..line.iter().position(|b| b";(".contains(b)).unwrap_or(line.len())].trim_ascii();
    matches!(code, [b'O' | b'o', digits @ ..] if !digits.is_empty() && digits.iter().all(u8::is_ascii_digit))
}

/// Whether a line of G-code has an E word.
fn extrudes(line: &[u8]) -> bool {
    let line = line.trim_ascii_start();
    let code = &line[..line.iter().position(|b| b";(".contains(b)).unwrap_or(line.len())];
    let begins = matches!(code, [b'G' | b'g' | b'N' | b'n' | b'X' | b'x', b'0'..=b'9' | b'-' | b'.', ..]);
    // `M67 E0 Q0.8` sets an analogue output of LinuxCNC, not an extruder.
    let switches = code.split(|b| b.is_ascii_whitespace()).take(2).any(|w| matches!(w, [b'M' | b'm', b'0'..=b'9', ..]));
    begins && !switches && code.windows(2).any(|w| matches!(w, [b'E' | b'e', b'0'..=b'9' | b'+' | b'-' | b'.']))
}

/// The diameter in a comment such as ` filament_diameter = 1.75,1.75`, mm.
fn diameter(comment: &[u8]) -> Option<f64> {
    let comment = comment.trim_ascii_start();
    let rest = comment.get(8..).filter(|_| comment[..8].eq_ignore_ascii_case(b"filament"))?;
    let rest = rest.trim_ascii_start().strip_prefix(b"_").unwrap_or(rest.trim_ascii_start());
    let rest = rest.get(8..).filter(|_| rest[..8].eq_ignore_ascii_case(b"diameter"))?;
    first_number(rest).filter(|d| (0.1..10.0).contains(d))
}

/// The bead width in `;WIDTH:0.45` or `; LINE_WIDTH: 0.45`, mm.
pub(super) fn width(comment: &[u8]) -> Option<f64> {
    let text = comment.get(1..)?.trim_ascii_start();
    let value = text.strip_prefix(b"WIDTH:").or_else(|| text.strip_prefix(b"LINE_WIDTH:"))?;
    first_number(value).filter(|&w| w > 0.0)
}

fn first_number(text: &[u8]) -> Option<f64> {
    let start = text.iter().position(u8::is_ascii_digit)?;
    let digits = text[start..].iter().take_while(|b| b.is_ascii_digit() || **b == b'.').count();
    parse(&text[start..start + digits])
}
