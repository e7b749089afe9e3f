//! A shape to which plate and part bend: how far their metal moves, computed once, and drawn as far as is wanted.

use super::beads::LayerBeads;
use super::gpu::BELOW;
use beadwright::distort::{Distortion, Shape};
use glam::{DVec3, Vec3};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Nodes of a plate (x, y, z, mm, and the place in the colour map), and its triangles.
pub(super) type Plate<'a> = (Vec<[f32; 4]>, &'a [[u32; 3]]);

/// Where plate and beads are, and how far each of their places moves.
#[derive(Debug)]
pub struct Bent {
    layers: Vec<Option<Moving>>,
    /// Nodes of the plate, mm, and how far each of them moves.
    nodes: Vec<(Vec3, Vec3)>,
    /// The plate's triangles, by index of their nodes.
    triangles: Vec<[u32; 3]>,
    /// How far the metal moves at most, mm.
    most: f64,
}

/// A layer in segments short enough to bend.
#[derive(Debug)]
struct Moving {
    straight: Arc<LayerBeads>,
    /// How far both ends of each segment move, mm.
    by: Vec<[Vec3; 2]>,
    /// How far the middle of each segment moves, mm.
    far: Arc<[f32]>,
}

impl Bent {
    /// The layers of a build in segments short enough to bend.
    pub fn divided(built: &Distortion, drawn: &[Option<Arc<LayerBeads>>]) -> Vec<Option<Arc<LayerBeads>>> {
        let divided = |layer: &Arc<LayerBeads>| Arc::new(layer.divided(built.grid.size.x as f32));
        drawn.iter().map(|layer| layer.as_ref().map(divided)).collect()
    }

    /// A shape of a build, for its divided layers.
    pub fn new(built: &Distortion, shape: &Shape, divided: &[Option<Arc<LayerBeads>>]) -> Self {
        let most = shape.moved.iter().map(|moved| moved.length()).fold(0.0, f64::max);
        let moving = |layer: &Arc<LayerBeads>| Moving::new(layer, built, shape);
        let layers = divided.iter().map(|layer| layer.as_ref().map(moving)).collect();
        let (nodes, triangles) = of_plate(built, shape);
        Self { layers, nodes, triangles, most }
    }

    /// How far the metal moves at most, mm.
    pub fn most(&self) -> f64 {
        self.most
    }

    /// The layers, with the computed movement multiplied by `times`.
    pub(super) fn layers(&self, times: f64) -> Vec<Option<Arc<LayerBeads>>> {
        let moved = |layer: &Moving| Arc::new(layer.straight.moved(&layer.by, times as f32));
        self.layers.iter().map(|layer| layer.as_ref().map(moved)).collect()
    }

    /// How far the segments of a layer move as computed, mm.
    pub(super) fn far(&self, layer: usize) -> Option<&Arc<[f32]>> {
        Some(&self.layers.get(layer)?.as_ref()?.far)
    }

    /// The plate, with the computed movement multiplied by `times`.
    pub(super) fn plate(&self, times: f64) -> Plate<'_> {
        let part = |by: &Vec3| by.length() / (self.most as f32).max(f32::MIN_POSITIVE);
        let moved = |(at, by): &(Vec3, Vec3)| (*at + times as f32 * *by).extend(part(by)).into();
        (self.nodes.iter().map(moved).collect(), &self.triangles)
    }
}

impl Moving {
    fn new(straight: &Arc<LayerBeads>, built: &Distortion, shape: &Shape) -> Self {
        let mut last = DVec3::ZERO;
        // A bead's place is the line in its middle. Beside all voxels it moves as the metal before it.
        let mut moved = |at: Vec3| {
            last = built.at(shape, at.as_dvec3()).unwrap_or(last);
            last.as_vec3()
        };
        let by: Vec<[Vec3; 2]> = straight.beads().iter().map(|bead| bead.middle_line().map(&mut moved)).collect();
        let far = by.iter().map(|[from, to]| (*from + *to).length() / 2.0).collect();
        Self { straight: straight.clone(), by, far }
    }
}

/// The plate's nodes, each with how far it moves, and its triangles.
fn of_plate(built: &Distortion, shape: &Shape) -> (Vec<(Vec3, Vec3)>, Vec<[u32; 3]>) {
    let faces = built.plate_surface();
    let mut numbers: BTreeMap<usize, u32> = faces.iter().flatten().map(|&node| (node, 0)).collect();
    numbers.values_mut().zip(0..).for_each(|(number, i)| *number = i);
    let node = |node: &usize| {
        let moved = shape.nodes.binary_search(node).map_or(DVec3::ZERO, |at| shape.moved[at]);
        let at = built.grid.place(*node).as_vec3();
        (at.with_z(at.z - BELOW), moved.as_vec3())
    };
    let halves = |[a, b, c, d]: [u32; 4]| [[a, b, c], [a, c, d]];
    let triangles = faces.iter().flat_map(|face| halves(face.map(|node| numbers[&node]))).collect();
    (numbers.keys().map(node).collect(), triangles)
}
