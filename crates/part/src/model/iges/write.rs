//! Writes curves as rational B-spline curves (126) that read back exactly.

use crate::curve::Nurbs;
use glam::DVec3;
use std::fmt::Write;

/// The header data of a written file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct WriteOptions {
    /// Name of the file, as the file itself states it. Default: `curves.igs`.
    pub file_name: String,
    /// Date as `YYYYMMDD.HHNNSS`. Default: `20000101.000000`, so that the same curves give the same bytes.
    pub date: String,
}

impl Default for WriteOptions {
    fn default() -> Self {
        Self { file_name: "curves.igs".to_owned(), date: "20000101.000000".to_owned() }
    }
}

/// Longest label in a directory entry; longer names are cut.
const LABEL: usize = 8;

/// A curve is planar when its control points are off the plane by less than this fraction of its extent.
const FLAT: f64 = 1e-9;

/// Columns for data on global and on parameter cards.
const GLOBAL_WIDTH: usize = 72;
const PARAMETER_WIDTH: usize = 64;

/// Columns for the length of a string, which is never split.
const COUNT: usize = 8;

/// An IGES file of named curves, mm. Non-ASCII characters become question marks.
///
/// ```
/// use bead_part::curve::Nurbs;
/// use bead_part::model::iges::{WriteOptions, read, write};
/// use glam::DVec3;
///
/// let line = Nurbs::line(DVec3::ZERO, DVec3::new(120.0, 0.0, 0.0))?;
/// let text = write(&[("wall", &line)], &WriteOptions::default());
/// assert_eq!(read(text.as_bytes())?.curves[0].parts, [line]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn write(curves: &[(&str, &Nurbs)], options: &WriteOptions) -> String {
    let mut file = String::new();
    let mut directory = String::new();
    let mut parameters = String::new();
    let (mut entries, mut cards) = (0, 0);
    for (name, curve) in curves {
        let lines = wrapped(&fields(curve), PARAMETER_WIDTH);
        let entry = entries + 1;
        push_entry(&mut directory, entry, cards + 1, lines.len(), name);
        for line in &lines {
            cards += 1;
            let _ = writeln!(parameters, "{line:<64} {entry:>7}P{cards:>7}");
        }
        entries += 2;
    }
    push_section(&mut file, 'S', &["Curves written by Beadwright.".to_owned()]);
    let global = wrapped(&global(curves, options), GLOBAL_WIDTH);
    push_section(&mut file, 'G', &global);
    file += &directory;
    file += &parameters;
    let end = format!("S{:>7}G{:>7}D{entries:>7}P{cards:>7}", 1, global.len());
    push_section(&mut file, 'T', &[end]);
    file
}

fn push_section(file: &mut String, letter: char, lines: &[String]) {
    for (i, line) in lines.iter().enumerate() {
        let _ = writeln!(file, "{line:<72}{letter}{:>7}", i + 1);
    }
}

fn push_entry(directory: &mut String, entry: usize, card: usize, cards: usize, name: &str) {
    let label: String = ascii(name).trim().chars().take(LABEL).collect();
    let zero = 0;
    let _ = writeln!(
        directory,
        "     126{card:>8}{zero:>8}{:>8}{zero:>8}{zero:>8}{zero:>8}{zero:>8}00000000D{entry:>7}",
        1
    );
    let _ = writeln!(
        directory,
        "     126{zero:>8}{zero:>8}{cards:>8}{zero:>8}                {label:>8}{zero:>8}D{:>7}",
        entry + 1
    );
}

/// Parameters of entity 126.
fn fields(curve: &Nurbs) -> Vec<String> {
    let points = curve.control_points();
    let (is_plane, normal) = plane(points, curve.extent());
    let flag = |is: bool| u8::from(is).to_string();
    let mut fields = vec!["126".to_owned(), (points.len() - 1).to_string(), curve.degree().to_string()];
    // Plane, closed, polynomial, periodic.
    fields.extend([flag(is_plane), flag(curve.is_closed()), flag(!curve.is_rational()), flag(false)]);
    let (start, end) = curve.domain();
    let numbers = curve.knots().iter().chain(curve.weights()).copied();
    let coordinates = points.iter().flat_map(|p| p.to_array());
    fields.extend(numbers.chain(coordinates).chain([start, end]).chain(normal.to_array()).map(real));
    fields
}

/// Whether the points lie in a plane, and its unit normal (0, 0, 0 if not).
fn plane(points: &[DVec3], extent: f64) -> (bool, DVec3) {
    let first = points[0];
    let farthest = |from: &dyn Fn(DVec3) -> DVec3| {
        points.iter().map(|p| from(*p - first)).max_by(|a, b| a.length_squared().total_cmp(&b.length_squared()))
    };
    let along = farthest(&|p| p).unwrap_or_default().normalize_or_zero();
    let across = farthest(&|p| along.cross(p)).unwrap_or_default();
    let normal = if across.length() > FLAT * extent {
        across.normalize()
    } else if along == DVec3::ZERO {
        DVec3::Z
    } else {
        along.any_orthonormal_vector()
    };
    let is_plane = points.iter().all(|p| (*p - first).dot(normal).abs() <= FLAT * extent);
    if is_plane { (true, normal) } else { (false, DVec3::ZERO) }
}

fn global(curves: &[(&str, &Nurbs)], options: &WriteOptions) -> Vec<String> {
    let version = concat!("Beadwright ", env!("CARGO_PKG_VERSION"));
    let reach = |c: &Nurbs| c.bounds().0.abs().max(c.bounds().1.abs()).max_element();
    let reach = curves.iter().map(|(_, curve)| reach(curve)).fold(0.0, f64::max);
    let [file, date] = [&options.file_name, &options.date].map(|text| hollerith(text));
    let texts =
        [",", ";", "Beadwright"].map(hollerith).into_iter().chain([file]).chain([version, version].map(hollerith));
    // Bits of an integer, then exponents and digits of single and double reals.
    let numbers = ["32", "38", "6", "308", "15"].map(str::to_owned);
    // Scale 1, millimetres, one line weight.
    let unit = ["1.0".to_owned(), "2".to_owned(), hollerith("MM"), "1".to_owned(), "0.1".to_owned()];
    let ends = [real(1e-6), real(reach), String::new(), String::new(), "11".to_owned(), "0".to_owned()];
    let receiver = [hollerith("Beadwright")];
    texts.chain(numbers).chain(receiver).chain(unit).chain([date.clone()]).chain(ends).chain([date]).collect()
}

fn ascii(text: &str) -> String {
    text.chars().map(|c| if c == ' ' || c.is_ascii_graphic() { c } else { '?' }).collect()
}

/// A string with its length; an empty one is left out.
fn hollerith(text: &str) -> String {
    let text = ascii(text);
    if text.is_empty() { text } else { format!("{}H{text}", text.len()) }
}

/// The shortest number that reads back the same, with a point and a D before the exponent.
fn real(value: f64) -> String {
    let text = format!("{value:?}");
    match text.split_once('e') {
        Some((digits, exponent)) if digits.contains('.') => format!("{digits}D{exponent}"),
        Some((digits, exponent)) => format!("{digits}.0D{exponent}"),
        None => text,
    }
}

/// Fields with their delimiters on lines of at most `width` columns; a longer string continues on the next line.
fn wrapped(fields: &[String], width: usize) -> Vec<String> {
    let mut lines = vec![String::new()];
    for (i, field) in fields.iter().enumerate() {
        let end = if i + 1 == fields.len() { ';' } else { ',' };
        let mut rest = format!("{field}{end}");
        while !rest.is_empty() {
            let room = lines.last().map_or(0, |line| width - line.len());
            if rest.len() <= room || (rest.len() > width && room > COUNT) {
                let tail = rest.split_off(rest.len().min(room));
                lines.last_mut().into_iter().for_each(|line| line.push_str(&rest));
                rest = tail;
            } else {
                lines.push(String::new());
            }
        }
    }
    lines
}
