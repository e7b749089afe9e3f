//! STL, binary and ASCII.
//!
//! A file is binary when its size is 84 + 50 · n for the count n that it announces, whatever its header says:
//! binary files that begin with "solid" are common.

use super::formats::{self, Facet, Format};
use super::{Import, ImportError};
use crate::task::Task;
use glam::DVec3;

pub(super) const FORMAT: Format = Format { is: |_| true, read };

const HEADER: usize = 84;
const RECORD: usize = 50;

/// A binary STL file of triangles, corners counter-clockwise seen from outside; up to 80 bytes of `name` go into its
/// header. Coordinates have single precision (24 bits).
pub fn write(name: &str, triangles: impl Iterator<Item = [DVec3; 3]>) -> Vec<u8> {
    let mut bytes = name.as_bytes().to_vec();
    bytes.resize(HEADER, 0);
    let mut count = 0_u32;
    for corners in triangles {
        let [a, b, c] = corners.map(|corner| corner.as_vec3());
        let [p, q, r] = [a, b, c].map(|corner| corner.as_dvec3());
        let normal = (q - p).cross(r - p).normalize_or(DVec3::Z).as_vec3();
        bytes.extend([normal, a, b, c].iter().flat_map(|v| v.to_array()).flat_map(f32::to_le_bytes));
        bytes.extend([0, 0]);
        count += 1;
    }
    bytes[80..HEADER].copy_from_slice(&count.to_le_bytes());
    bytes
}

/// Reads a binary or ASCII STL file.
///
/// # Errors
/// [`ImportError`] with the byte or line.
pub fn read(bytes: &[u8], task: &Task) -> Result<Import, ImportError> {
    if announced_size(bytes) == Some(bytes.len()) {
        return read_binary(bytes, None, task);
    }
    if looks_ascii(bytes) {
        return read_ascii(bytes, task);
    }
    let length = bytes.len();
    match announced_size(bytes) {
        None => Err(ImportError::NotStl {
            reason: format!("it has {} bytes, but a binary STL has at least {HEADER}", bytes.len()),
        }),
        Some(size) if size > length && plausible(&bytes[HEADER..]) => {
            let (announced, whole) = ((size - HEADER) / RECORD, (length - HEADER) / RECORD);
            let damage = format!(
                "it is cut short: it announces {announced} triangles, which take {size} bytes, but ends at byte {length}, in \
                 triangle {}",
                whole + 1
            );
            read_binary(&bytes[..HEADER + whole * RECORD], Some(damage), task)
        }
        Some(size) if size < length && size > HEADER && plausible(&bytes[HEADER..]) => {
            let (announced, more) = ((size - HEADER) / RECORD, (length - size) / RECORD);
            // Either the count is wrong and more triangles follow, or a program has appended data of its own.
            let next = &bytes[size..length.min(size + RECORD)];
            let counted_wrong = plausible(next) && next[..48].iter().any(|&byte| byte != 0);
            let damage = format!("bytes 80–83 announce {announced} triangles, but {more} more follow");
            let mut import = if counted_wrong {
                read_binary(bytes, Some(damage), task)?
            } else {
                read_binary(&bytes[..size], None, task)?
            };
            import.repair.appended_bytes = if counted_wrong { 0 } else { length - size };
            Ok(import)
        }
        Some(size) => Err(ImportError::NotStl {
            reason: format!(
                "bytes 80–83 announce {} triangles, but the file has {} bytes and no \"facet\" lines either",
                (size - HEADER) / RECORD,
                bytes.len()
            ),
        }),
    }
}

/// Size of the file according to the triangle count at byte 80.
pub(super) fn announced_size(bytes: &[u8]) -> Option<usize> {
    let count = bytes.get(80..HEADER)?;
    let count = u32::from_le_bytes([count[0], count[1], count[2], count[3]]);
    Some(HEADER + RECORD * count as usize)
}

/// Whether a record holds numbers of a usual magnitude, which random bytes hardly ever do.
fn plausible(record: &[u8]) -> bool {
    let Some(facet) = record.get(..48) else { return false };
    let mut numbers = facet.as_chunks::<4>().0.iter().map(|b| f32::from_le_bytes(*b));
    numbers.all(|v| v == 0.0 || (1e-12..1e9).contains(&v.abs()))
}

pub(super) fn looks_ascii(bytes: &[u8]) -> bool {
    let head = &bytes[..bytes.len().min(4096)];
    let start = head.iter().position(|b| !b.is_ascii_whitespace()).unwrap_or(0);
    let word = |w: &[u8]| head[start..].len() >= w.len() && head[start..start + w.len()].eq_ignore_ascii_case(w);
    word(b"solid") && !head.contains(&0)
}

fn read_binary(bytes: &[u8], damage: Option<String>, task: &Task) -> Result<Import, ImportError> {
    let records = bytes[HEADER..].as_chunks::<RECORD>().0;
    let facets = records.iter().map(|raw| {
        let number = |i: usize| f32::from_le_bytes([raw[4 * i], raw[4 * i + 1], raw[4 * i + 2], raw[4 * i + 3]]);
        let triple = |i: usize| [number(i), number(i + 1), number(i + 2)];
        (triple(0), [triple(3), triple(6), triple(9)])
    });
    let place = |i: usize| format!("byte {}", HEADER + RECORD * i);
    damaged(formats::of_facets(facets, records.len(), "binary STL", place, task)?, damage)
}

fn read_ascii(bytes: &[u8], task: &Task) -> Result<Import, ImportError> {
    let (facets, lines, damage) = parse_ascii(bytes, task)?;
    if let (true, Some(reason)) = (facets.is_empty(), &damage) {
        return Err(ImportError::Damaged { reason: reason.clone() });
    }
    if facets.is_empty() {
        return Err(ImportError::NotStl { reason: "it begins with \"solid\" but holds no \"facet\"".to_owned() });
    }
    let count = facets.len();
    let place = |i: usize| format!("line {}", lines[i]);
    damaged(formats::of_facets(facets.into_iter(), count, "ASCII STL", place, task)?, damage)
}

fn damaged(mut import: Import, damage: Option<String>) -> Result<Import, ImportError> {
    import.repair.damage = damage;
    Ok(import)
}

type Parsed = (Vec<Facet>, Vec<u32>, Option<String>);

/// Facets, the line on which each begins, and what is missing at the end. Names of solids may be any bytes; there may
/// be several solids.
fn parse_ascii(bytes: &[u8], task: &Task) -> Result<Parsed, ImportError> {
    let (mut facets, mut lines): (Vec<Facet>, Vec<u32>) = (Vec::new(), Vec::new());
    let mut open: Option<([f32; 3], Vec<[f32; 3]>)> = None;
    let (mut line_number, mut in_solid) = (0, false);
    for line in bytes.split(|&b| b == b'\n') {
        line_number += 1;
        if line_number % 100_000 == 0 {
            task.check()?;
        }
        let error = |reason: String| ImportError::Line { line: line_number, reason };
        let mut words = line.split(u8::is_ascii_whitespace).filter(|w| !w.is_empty());
        let Some(first) = words.next() else { continue };
        if first.eq_ignore_ascii_case(b"vertex") {
            let Some((_, corners)) = &mut open else { return Err(error("a vertex outside a facet".to_owned())) };
            corners.push(triple(words).map_err(error)?);
        } else if first.eq_ignore_ascii_case(b"facet") {
            if open.is_some() {
                return Err(error("a facet begins before the last one has ended (endfacet is missing)".to_owned()));
            }
            // The normal is not needed, so a missing or broken one is no reason to refuse the part.
            let normal = triple(words.skip(1)).unwrap_or_default();
            open = Some((normal, Vec::with_capacity(3)));
            in_solid = true;
            lines.push(line_number as u32);
        } else if first.eq_ignore_ascii_case(b"endfacet") {
            let Some((normal, corners)) = open.take() else {
                return Err(error("endfacet without a facet".to_owned()));
            };
            let corners = <[[f32; 3]; 3]>::try_from(corners)
                .map_err(|c| error(format!("the facet that ends here has {} vertices, not 3", c.len())))?;
            facets.push((normal, corners));
        } else if first.eq_ignore_ascii_case(b"endsolid") {
            in_solid = false;
        } else if first.eq_ignore_ascii_case(b"solid") {
            in_solid = true;
        }
    }
    let damage = if open.is_some() {
        Some(format!("it is cut short: it ends at line {line_number} in triangle {}", facets.len() + 1))
    } else {
        (in_solid && !facets.is_empty())
            .then(|| format!("it ends at line {line_number} after {} triangles, without \"endsolid\"", facets.len()))
    };
    Ok((facets, lines, damage))
}

fn triple<'a>(mut words: impl Iterator<Item = &'a [u8]>) -> Result<[f32; 3], String> {
    let mut number = || {
        let word = words.next().ok_or("three numbers are expected and one is missing")?;
        let text = std::str::from_utf8(word).unwrap_or("?");
        text.parse::<f32>().map_err(|_| format!("\"{}\" is not a number", String::from_utf8_lossy(word)))
    };
    Ok([number()?, number()?, number()?])
}
