//! Objects that a file places: meshes, and assemblies of other objects, each with a transform (3MF, AMF).
//!
//! The expansion of a file is bounded: triangles including all copies, and nesting of assemblies.

use super::formats::{self, Facet, MOST_TRIANGLES};
use super::{Import, ImportError, Object, Solids, Units};
use crate::task::Task;
use glam::{DAffine3, DVec3, Vec3};
use std::collections::BTreeMap;

/// Deepest nesting of assemblies.
const DEEPEST: usize = 32;

/// Objects are matched with their solids up to this number of shells; only a broken mesh has more.
const MOST_SHELLS: usize = 100;

/// A file of the archive, and the number of an object in it.
pub(super) type Id = (String, u32);

/// What an object consists of.
pub(super) enum Shape {
    Mesh { vertices: Vec<DVec3>, triangles: Vec<[u32; 3]> },
    Components(Vec<(Id, DAffine3)>),
}

/// An object of the file.
pub(super) struct Resource {
    pub(super) name: String,
    /// Whether it is part of what is to be built, which supports are not.
    pub(super) solid: bool,
    pub(super) shape: Shape,
}

/// All objects, and those that are built.
pub(super) struct Resources {
    pub(super) objects: BTreeMap<Id, Resource>,
    /// What is built.
    pub(super) items: Vec<(Id, DAffine3)>,
    /// Millimetres per unit.
    pub(super) unit: f64,
    format: &'static str,
    triangles: usize,
}

impl Resources {
    pub(super) fn of(format: &'static str) -> Self {
        Self { objects: BTreeMap::new(), items: Vec::new(), unit: 1.0, format, triangles: 0 }
    }

    /// Counts one triangle; fails above the limit.
    pub(super) fn count_triangle(&mut self) -> Result<(), ImportError> {
        self.triangles += 1;
        if self.triangles > MOST_TRIANGLES { Err(self.too_many()) } else { Ok(()) }
    }

    /// Assembles the items into one mesh.
    pub(super) fn build(&self, task: &Task) -> Result<Import, ImportError> {
        let (mut counts, mut sum) = (BTreeMap::new(), 0_usize);
        for (id, _) in &self.items {
            sum = sum.saturating_add(self.count(id, 0, &mut counts)?);
        }
        if sum > MOST_TRIANGLES {
            return Err(self.too_many());
        }
        let (mut facets, mut objects): (Vec<Facet>, Vec<Object>) = (Vec::with_capacity(sum), Vec::new());
        let mut ranges = Vec::new();
        for (id, at) in &self.items {
            let first = facets.len();
            self.lay(id, &(DAffine3::from_scale(DVec3::splat(self.unit)) * *at), &mut facets)?;
            task.check()?;
            if let (Some(object), true) = (self.objects.get(id), facets.len() > first) {
                objects.push(Object { name: object.name.clone(), triangles: facets.len() - first, at: Vec::new() });
                ranges.push(first..facets.len());
            }
        }
        if facets.is_empty() {
            return Err(self.broken("its build holds no object with triangles"));
        }
        let count = facets.len();
        let place = |i| format!("triangle {}", i + 1);
        let import = formats::of_facets(facets.iter().copied(), count, self.format, place, task)?;
        if import.repair.shells <= MOST_SHELLS {
            let solids = Solids::of(&import.mesh);
            let corners = |(_, corners): &Facet| corners.map(|corner| Vec3::from(corner).as_dvec3());
            let groups = solids.of_groups(ranges.into_iter().map(|range| facets[range].iter().map(corners)));
            for (object, group) in objects.iter_mut().zip(groups) {
                object.at = group.into_iter().filter_map(|number| solids.point(number)).collect();
            }
        }
        Ok(Import { units: Some(Units::Millimetre), objects, ..import })
    }

    fn broken(&self, reason: impl Into<String>) -> ImportError {
        ImportError::Broken { format: self.format, reason: reason.into() }
    }

    fn too_many(&self) -> ImportError {
        self.broken(format!("it has more than {MOST_TRIANGLES} triangles, with all copies"))
    }

    /// The number of triangles of an object with all its parts; known objects are looked up.
    fn count(&self, id: &Id, depth: usize, counts: &mut BTreeMap<Id, usize>) -> Result<usize, ImportError> {
        if let Some(known) = counts.get(id) {
            return Ok(*known);
        }
        if depth > DEEPEST {
            return Err(self.broken(format!("components are nested more than {DEEPEST} deep, or contain themselves")));
        }
        let missing = || match &id.0 {
            file if file.is_empty() => self.broken(format!("object {} is missing", id.1)),
            file => self.broken(format!("object {} of {file} is missing", id.1)),
        };
        let object = self.objects.get(id).ok_or_else(missing)?;
        let mut sum = 0_usize;
        match &object.shape {
            _ if !object.solid => {}
            Shape::Mesh { triangles, .. } => sum = triangles.len(),
            Shape::Components(parts) => {
                for (part, _) in parts {
                    sum = sum.saturating_add(self.count(part, depth + 1, counts)?);
                }
            }
        }
        counts.insert(id.clone(), sum);
        Ok(sum)
    }

    /// Adds the triangles of an object and its parts, which [`Self::count`] has checked.
    fn lay(&self, id: &Id, at: &DAffine3, facets: &mut Vec<Facet>) -> Result<(), ImportError> {
        let Some(object) = self.objects.get(id).filter(|object| object.solid) else { return Ok(()) };
        match &object.shape {
            Shape::Components(parts) => {
                parts.iter().try_for_each(|(part, place)| self.lay(part, &(*at * *place), facets))
            }
            Shape::Mesh { vertices, triangles } => {
                let placed: Vec<[f32; 3]> =
                    vertices.iter().map(|v| at.transform_point3(*v).as_vec3().to_array()).collect();
                let mirrored = at.matrix3.determinant() < 0.0;
                for &[a, b, c] in triangles {
                    let corners = if mirrored { [a, c, b] } else { [a, b, c] };
                    let facet = formats::indexed(&placed, corners);
                    let missing =
                        || self.broken(format!("a triangle of \"{}\" refers to a missing vertex", object.name));
                    facets.push(facet.ok_or_else(missing)?);
                }
                Ok(())
            }
        }
    }
}
