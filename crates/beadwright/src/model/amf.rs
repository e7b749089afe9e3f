//! AMF: the meshes of all objects; constellations place them. Plain or in a ZIP archive.

use super::formats::{self, Facet, Format};
use super::xml::{Elements, Step};
use super::{Import, ImportError, Object, Units};
use crate::task::Task;
use std::io::BufRead;

pub(super) const FORMAT: Format = Format { is: looks_amf, read: |bytes, task| read(bytes, task) };

fn looks_amf(bytes: &[u8]) -> bool {
    let head = &bytes[..bytes.len().min(1000)];
    head.trim_ascii_start().starts_with(b"<") && head.windows(4).any(|w| w == b"<amf")
}

fn broken(reason: impl Into<String>) -> ImportError {
    ImportError::Broken { format: "AMF", reason: reason.into() }
}

/// Reads the text of an AMF file.
fn read(text: impl BufRead, task: &Task) -> Result<Import, ImportError> {
    let mut elements = Elements::new(text, "AMF");
    let (mut unit, mut facets, mut objects): (f64, Vec<Facet>, Vec<Object>) = (1.0, Vec::new(), Vec::new());
    let (mut vertices, mut triangles): (Vec<[f32; 3]>, Vec<[u32; 3]>) = (Vec::new(), Vec::new());
    let (mut at, mut corners, mut value) = ([f32::NAN; 3], [u32::MAX; 3], String::new());
    let mut name = String::new();
    let mut steps = 0_u64;
    while let Some(step) = elements.next()? {
        steps += 1;
        if steps.is_multiple_of(65_536) {
            task.check()?;
        }
        let ended = match step {
            Step::Begin(element) => {
                value.clear();
                match element.name() {
                    "amf" => unit = in_mm(&element.attribute("unit").unwrap_or_default())?,
                    "constellation" => {
                        return Err(broken(
                            "it places its objects in a constellation, which is not read; save it as 3MF",
                        ));
                    }
                    "object" => {
                        name = format!("object {}", element.attribute("id").unwrap_or_default());
                        (vertices, triangles) = (Vec::new(), Vec::new());
                    }
                    _ => {}
                }
                continue;
            }
            Step::Text(text) => {
                value.push_str(&text);
                continue;
            }
            Step::End(ended) => ended,
        };
        let number = || {
            value
                .trim()
                .parse::<f64>()
                .map_err(|_| broken(format!("\"{}\" in <{ended}> is not a number", value.trim())))
        };
        let index = || {
            value
                .trim()
                .parse::<u32>()
                .map_err(|_| broken(format!("\"{}\" in <{ended}> is not a number", value.trim())))
        };
        match ended.as_str() {
            "x" => at[0] = (number()? * unit) as f32,
            "y" => at[1] = (number()? * unit) as f32,
            "z" => at[2] = (number()? * unit) as f32,
            "coordinates" => vertices.push(std::mem::replace(&mut at, [f32::NAN; 3])),
            "v1" => corners[0] = index()?,
            "v2" => corners[1] = index()?,
            "v3" => corners[2] = index()?,
            "triangle" => triangles.push(std::mem::replace(&mut corners, [u32::MAX; 3])),
            "object" => {
                for triangle in &triangles {
                    let facet = formats::indexed(&vertices, *triangle);
                    facets.push(
                        facet
                            .ok_or_else(|| broken(format!("a triangle of {name} names a vertex that is not there")))?,
                    );
                }
                objects.push(Object { name: std::mem::take(&mut name), triangles: triangles.len() });
            }
            _ => {}
        }
    }
    let count = facets.len();
    let import = formats::of_facets(facets.into_iter(), count, "AMF", |i| format!("triangle {}", i + 1), task)?;
    Ok(Import { units: Some(Units::Millimetre), objects, ..import })
}

/// Millimetres in a unit of AMF.
fn in_mm(unit: &str) -> Result<f64, ImportError> {
    Ok(match unit {
        "" | "millimeter" => 1.0,
        "micron" => 1e-3,
        "meter" => 1000.0,
        "inch" => 25.4,
        "feet" => 304.8,
        other => return Err(broken(format!("its unit \"{other}\" is not one of AMF"))),
    })
}
