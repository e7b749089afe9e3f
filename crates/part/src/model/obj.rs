//! Wavefront OBJ: vertices (`v`) and faces (`f`) of all objects and groups; textures, normals and materials are
//! skipped.

use super::formats::{self, Format};
use super::{Import, ImportError};
use crate::task::Task;

pub(super) const FORMAT: Format = Format { is: looks_obj, read };

/// Whether the first word that is not a comment is an OBJ keyword, and a vertex follows.
fn looks_obj(bytes: &[u8]) -> bool {
    let head = &bytes[..bytes.len().min(20_000)];
    let lines = || head.split(|&b| b == b'\n').map(|line| line.trim_ascii()).filter(|line| !line.is_empty());
    let word = |line: &[u8]| line.split(u8::is_ascii_whitespace).next().map(<[u8]>::to_vec).unwrap_or_default();
    let words: &[&[u8]] = &[b"v", b"vn", b"vt", b"o", b"g", b"s", b"mtllib", b"usemtl", b"f"];
    let first = lines().find(|line| line[0] != b'#');
    !head.contains(&0)
        && first.is_some_and(|line| words.contains(&&word(line)[..]))
        && lines().any(|line| word(line) == b"v")
}

fn read(bytes: &[u8], task: &Task) -> Result<Import, ImportError> {
    let (mut vertices, mut facets, mut lines) = (Vec::<[f32; 3]>::new(), Vec::new(), Vec::<u32>::new());
    let mut edges = 0;
    // Faces that refer to vertices that are not there: how many, and the line of the first.
    let mut broken_faces: Option<(usize, u32)> = None;
    for (number, line) in (1..).zip(bytes.split(|&b| b == b'\n')) {
        if number % 100_000 == 0 {
            task.check()?;
        }
        let broken = |reason: &str| ImportError::Broken { format: "OBJ", reason: format!("line {number}: {reason}") };
        let mut words = line.split(u8::is_ascii_whitespace).filter(|w| !w.is_empty());
        match words.next() {
            Some(b"v") => {
                let mut number = || std::str::from_utf8(words.next()?).ok()?.parse::<f32>().ok();
                let vertex = (|| Some([number()?, number()?, number()?]))();
                vertices.push(vertex.ok_or_else(|| broken("three numbers are expected after v"))?);
            }
            Some(b"f") => {
                let corners: Option<Vec<u32>> = words.map(|word| vertex(word, vertices.len())).collect();
                let Some(corners) = corners else {
                    broken_faces = broken_faces.map(|(count, line)| (count + 1, line)).or(Some((1, number)));
                    continue;
                };
                if corners.len() < 3 {
                    // Some programs write edges as two-cornered faces.
                    edges += 1;
                }
                for triangle in formats::fan(&corners) {
                    facets.extend(formats::indexed(&vertices, triangle));
                    lines.push(number);
                }
            }
            _ => {}
        }
    }
    let count = facets.len();
    let place = |i: usize| format!("line {}", lines.get(i).copied().unwrap_or_default());
    let damage = broken_faces.map(|(count, line)| {
        let faces = if count == 1 { "1 face refers" } else { &format!("{count} faces refer") };
        format!("{faces} to vertices that are not defined before them (first: line {line})")
    });
    if let (0, Some(reason)) = (count, &damage) {
        return Err(ImportError::Broken { format: "OBJ", reason: reason.clone() });
    }
    let mut import = formats::of_facets(facets.into_iter(), count, "OBJ", place, task)?;
    import.repair.degenerate += edges;
    import.repair.triangles_read += edges;
    import.repair.damage = damage;
    Ok(import)
}

/// The index of the vertex that a corner refers to: `7`, `7/1`, `7//2`, `7/1/2`, or `-1`, counted back from the last.
fn vertex(word: &[u8], count: usize) -> Option<u32> {
    let text = std::str::from_utf8(word.split(|&b| b == b'/').next()?).ok()?;
    let number: i64 = text.parse().ok()?;
    let index = if number < 0 { count as i64 + number } else { number - 1 };
    u32::try_from(index).ok().filter(|&index| (index as usize) < count)
}
