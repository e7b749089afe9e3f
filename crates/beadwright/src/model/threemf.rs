//! 3MF: the core specification with build transforms, components and several objects, and the production extension's parts
//! in several files.
//!
//! What an archive may unfold to is bounded: bytes of its model files, triangles with all copies, components in
//! components.

use super::formats::{self, Facet, Format, MOST_TRIANGLES};
use super::package::{self, Package, broken, entry_name};
use super::xml::{Element, Step};
use super::{Import, ImportError, Object, Units};
use crate::task::Task;
use glam::{DAffine3, DMat3, DVec3};
use std::collections::BTreeMap;

pub(super) const FORMAT: Format = Format { is: package::is_package, read };

/// Components lie no deeper in each other.
const DEEPEST: usize = 32;
/// Extensions that a file may require: they change neither shape nor place.
const KNOWN: [&str; 4] = [
    "http://schemas.microsoft.com/3dmanufacturing/core/2015/02",
    package::PRODUCTION,
    "http://schemas.microsoft.com/3dmanufacturing/material/2015/02",
    "http://schemas.microsoft.com/3dmanufacturing/slice/2015/07",
];

/// A file of the archive and a number in it.
type Id = (String, u32);

/// What an object consists of.
enum Shape {
    Mesh { vertices: Vec<DVec3>, triangles: Vec<[u32; 3]> },
    Components(Vec<(Id, DAffine3)>),
}

/// An object of the file.
struct Resource {
    name: String,
    /// Whether it is part of what is to be built: supports are not.
    solid: bool,
    shape: Shape,
}

#[derive(Default)]
struct Resources {
    objects: BTreeMap<Id, Resource>,
    /// What the main file builds.
    items: Vec<(Id, DAffine3)>,
    /// mm.
    unit: f64,
    triangles: usize,
}

fn read(bytes: &[u8], task: &Task) -> Result<Import, ImportError> {
    let mut package = Package::open(bytes)?;
    let main = package.main()?;
    let mut resources = Resources { unit: 1.0, ..Resources::default() };
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
    build(&resources, task)
}

/// Reads a model file of the archive; returns the other files that it names.
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
    while let Some(step) = elements.next()? {
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
                    resources.triangles += 1;
                    if resources.triangles > MOST_TRIANGLES {
                        return Err(too_many());
                    }
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

fn too_many() -> ImportError {
    broken(format!("it has more than {MOST_TRIANGLES} triangles, with all copies"))
}

/// The transform of a component or item: twelve numbers, the rows of a matrix that is applied to row vectors.
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

/// Puts the items of the build together.
fn build(resources: &Resources, task: &Task) -> Result<Import, ImportError> {
    let (mut counts, mut sum) = (BTreeMap::new(), 0_usize);
    for (id, _) in &resources.items {
        sum = sum.saturating_add(count(resources, id, 0, &mut counts)?);
    }
    if sum > MOST_TRIANGLES {
        return Err(too_many());
    }
    let (mut facets, mut objects): (Vec<Facet>, Vec<Object>) = (Vec::with_capacity(sum), Vec::new());
    for (id, at) in &resources.items {
        let first = facets.len();
        lay(resources, id, &(DAffine3::from_scale(DVec3::splat(resources.unit)) * *at), &mut facets)?;
        task.check()?;
        if let (Some(object), true) = (resources.objects.get(id), facets.len() > first) {
            objects.push(Object { name: object.name.clone(), triangles: facets.len() - first });
        }
    }
    if facets.is_empty() {
        return Err(broken("its build holds no object with triangles"));
    }
    let count = facets.len();
    let import = formats::of_facets(facets.into_iter(), count, "3MF", |i| format!("triangle {}", i + 1), task)?;
    Ok(Import { units: Some(Units::Millimetre), objects, ..import })
}

/// The triangles of an object with all its components, each object counted once.
fn count(resources: &Resources, id: &Id, depth: usize, counts: &mut BTreeMap<Id, usize>) -> Result<usize, ImportError> {
    if let Some(known) = counts.get(id) {
        return Ok(*known);
    }
    if depth > DEEPEST {
        return Err(broken(format!("components lie more than {DEEPEST} deep in each other, or in themselves")));
    }
    let object = resources.objects.get(id);
    let object = object.ok_or_else(|| broken(format!("object {} of {} is not there", id.1, id.0)))?;
    let mut sum = 0_usize;
    match &object.shape {
        _ if !object.solid => {}
        Shape::Mesh { triangles, .. } => sum = triangles.len(),
        Shape::Components(parts) => {
            for (part, _) in parts {
                sum = sum.saturating_add(count(resources, part, depth + 1, counts)?);
            }
        }
    }
    counts.insert(id.clone(), sum);
    Ok(sum)
}

/// Adds the triangles of an object and of its components, which [`count`] has looked at.
fn lay(resources: &Resources, id: &Id, at: &DAffine3, facets: &mut Vec<Facet>) -> Result<(), ImportError> {
    let Some(object) = resources.objects.get(id).filter(|object| object.solid) else { return Ok(()) };
    match &object.shape {
        Shape::Components(parts) => {
            parts.iter().try_for_each(|(part, place)| lay(resources, part, &(*at * *place), facets))
        }
        Shape::Mesh { vertices, triangles } => {
            let placed: Vec<[f32; 3]> = vertices.iter().map(|v| at.transform_point3(*v).as_vec3().to_array()).collect();
            let mirrored = at.matrix3.determinant() < 0.0;
            for &[a, b, c] in triangles {
                let corners = if mirrored { [a, c, b] } else { [a, b, c] };
                let facet = formats::indexed(&placed, corners);
                let missing = || broken(format!("a triangle of \"{}\" names a vertex that is not there", object.name));
                facets.push(facet.ok_or_else(missing)?);
            }
            Ok(())
        }
    }
}
