//! 3MF: the core specification with build transforms, components and several objects, and the production extension's parts
//! in several files.
//!
//! The unpacked size is bounded: bytes of the model files, triangles including all copies, nesting of components.

use super::formats::Format;
use super::package::{self, Package, broken, entry_name};
use super::placed::{Id, Resource, Resources, Shape};
use super::xml::{Element, Step};
use super::{Import, ImportError};
use crate::task::Task;
use glam::{DAffine3, DMat3, DVec3};

pub(super) const FORMAT: Format = Format { is: package::is_package, read };

/// Extensions that a file may require because they change neither shape nor placement.
const KNOWN: [&str; 4] = [
    "http://schemas.microsoft.com/3dmanufacturing/core/2015/02",
    package::PRODUCTION,
    "http://schemas.microsoft.com/3dmanufacturing/material/2015/02",
    "http://schemas.microsoft.com/3dmanufacturing/slice/2015/07",
];

fn read(bytes: &[u8], task: &Task) -> Result<Import, ImportError> {
    let mut package = Package::open(bytes)?;
    let main = package.main()?;
    let mut resources = Resources::of("3MF");
    let mut wanted = vec![main.clone()];
    let mut done: Vec<String> = Vec::new();
    while let Some(path) = wanted.pop() {
        if done.contains(&path) {
            continue;
        }
        let others = read_model(&mut package, &path, path == main, &mut resources, task)?;
        wanted.extend(others);
        done.push(path);
    }
    resources.build(task)
}

/// Reads a model file of the archive; returns the other files that it refers to.
fn read_model(
    package: &mut Package<'_>,
    path: &str,
    main: bool,
    resources: &mut Resources,
    task: &Task,
) -> Result<Vec<String>, ImportError> {
    let mut elements = package.elements(path)?;
    let mut others = Vec::new();
    let mut open: Option<(u32, Resource)> = None;
    let mut steps = 0_u64;
    while let Some(step) = elements.step()? {
        steps += 1;
        if steps.is_multiple_of(65_536) {
            task.check()?;
        }
        let element = match step {
            Step::Begin(element) => element,
            Step::End(name) if name == "object" => {
                if let Some((id, object)) = open.take() {
                    resources.objects.insert((path.to_owned(), id), object);
                }
                continue;
            }
            _ => continue,
        };
        let id = |key: &str| -> Result<Id, ImportError> {
            let file = element.attribute("path").map_or(path.to_owned(), |path| entry_name(&path));
            Ok((file, element.number(key).map_err(broken)?))
        };
        match element.name() {
            "model" => {
                package::check_extensions(&element, &KNOWN)?;
                let unit = package::unit_in_mm(&element)?;
                resources.unit = if main { unit } else { resources.unit };
            }
            "object" => {
                let kind = element.attribute("type").unwrap_or_default();
                let number = element.number("id").map_err(broken)?;
                let name = element.attribute("name").unwrap_or_else(|| format!("object {number}"));
                let solid = matches!(kind.as_str(), "" | "model" | "solidsupport" | "surface");
                open = Some((number, Resource { name, solid, shape: Shape::Components(Vec::new()) }));
            }
            "mesh" => {
                if let Some((_, object)) = &mut open {
                    object.shape = Shape::Mesh { vertices: Vec::new(), triangles: Vec::new() };
                }
            }
            "vertex" => {
                if let Some((_, Resource { shape: Shape::Mesh { vertices, .. }, .. })) = &mut open {
                    let number = |key: &str| element.number::<f64>(key).map_err(broken);
                    vertices.push(DVec3::new(number("x")?, number("y")?, number("z")?));
                }
            }
            "triangle" => {
                if let Some((_, Resource { shape: Shape::Mesh { triangles, .. }, .. })) = &mut open {
                    let number = |key: &str| element.number::<u32>(key).map_err(broken);
                    triangles.push([number("v1")?, number("v2")?, number("v3")?]);
                    resources.count_triangle()?;
                }
            }
            "component" => {
                let (id, transform) = (id("objectid")?, transform(&element)?);
                others.push(id.0.clone());
                if let Some((_, Resource { shape: Shape::Components(parts), .. })) = &mut open {
                    parts.push((id, transform));
                }
            }
            "item" if main => {
                let (id, transform) = (id("objectid")?, transform(&element)?);
                others.push(id.0.clone());
                resources.items.push((id, transform));
            }
            _ => {}
        }
    }
    Ok(others)
}

/// The transform of a component or item: twelve numbers, the rows of a matrix applied to row vectors.
fn transform(element: &Element) -> Result<DAffine3, ImportError> {
    let Some(text) = element.attribute("transform") else { return Ok(DAffine3::IDENTITY) };
    let numbers: Vec<f64> = text.split_whitespace().filter_map(|word| word.parse().ok()).collect();
    let [a, b, c, d, e, f, g, h, i, x, y, z] = numbers[..] else {
        return Err(broken(format!("transform=\"{text}\" does not hold twelve numbers")));
    };
    let axes = DMat3::from_cols(DVec3::new(a, b, c), DVec3::new(d, e, f), DVec3::new(g, h, i));
    if axes.determinant() == 0.0 || !axes.is_finite() {
        return Err(broken(format!("transform=\"{text}\" makes the object flat")));
    }
    Ok(DAffine3 { matrix3: axes, translation: DVec3::new(x, y, z) })
}
