//! The solids of a mesh: shells, each with the cavities inside it.

use super::triangle::Triangle;
use super::{Mesh, NO_NEIGHBOUR};
use glam::DVec3;
use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{AABB, PointDistance, RTree, RTreeObject};
use std::collections::{BTreeSet, HashMap};
use std::f64::consts::TAU;

/// A mesh divided into its solids, numbered in the order of their first triangles.
///
/// ```
/// use bead_part::{example, model::Solids};
/// use glam::DVec3;
///
/// // A cross, and another one beside it.
/// let cross = example::find("cross").ok_or("no such example")?.mesh();
/// let (mut both, mut other) = (cross.clone(), cross.clone());
/// other.vertices.iter_mut().for_each(|vertex| vertex.x += 500.0);
/// both.add(other);
/// let solids = Solids::of(&both);
/// assert_eq!((solids.count(), solids.nearest(DVec3::X * 500.0)), (2, Some(1)));
/// assert!((solids.mesh(&[1]).volume() - cross.volume()).abs() < 1e-6);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Solids<'a> {
    mesh: &'a Mesh,
    /// The solid of each triangle.
    solid: Vec<usize>,
    count: usize,
    tree: RTree<Face>,
}

impl<'a> Solids<'a> {
    /// Divides a mesh.
    pub fn of(mesh: &'a Mesh) -> Self {
        let (shell, shells) = shells(mesh);
        let owner = owners(mesh, &shell, shells);
        let mut number = HashMap::new();
        let mut numbered = |shell: usize| {
            let next = number.len();
            *number.entry(owner[shell]).or_insert(next)
        };
        let solid: Vec<usize> = shell.into_iter().map(&mut numbered).collect();
        let face = |(t, &solid): (usize, &usize)| Face { triangle: Triangle::of(mesh, t), solid };
        let faces = solid.iter().enumerate().map(face).filter(|face| face.triangle.normal().length_squared() > 0.0);
        // A single solid needs no search.
        let tree = RTree::bulk_load(if number.len() > 1 { faces.collect() } else { Vec::new() });
        Self { mesh, count: number.len(), solid, tree }
    }

    /// Number of solids.
    pub fn count(&self) -> usize {
        self.count
    }

    /// The solid whose surface is nearest to a point.
    pub fn nearest(&self, point: DVec3) -> Option<usize> {
        let single = Some(0).filter(|_| self.count == 1);
        single.or_else(|| self.tree.nearest_neighbor(&point.to_array()).map(|face| face.solid))
    }

    /// The solids with the given numbers as one mesh.
    pub fn mesh(&self, numbers: &[usize]) -> Mesh {
        let kept: Vec<usize> = (0..self.solid.len()).filter(|t| numbers.contains(&self.solid[*t])).collect();
        self.of_triangles(&kept)
    }

    /// Each solid as its own mesh.
    pub fn each(&self) -> impl Iterator<Item = Mesh> + '_ {
        let mut triangles = vec![Vec::new(); self.count];
        self.solid.iter().enumerate().for_each(|(t, solid)| triangles[*solid].push(t));
        triangles.into_iter().map(|kept| self.of_triangles(&kept))
    }

    fn of_triangles(&self, kept: &[usize]) -> Mesh {
        let (mut vertices, mut vertex, mut triangle) = (Vec::new(), HashMap::new(), HashMap::new());
        for (new, &old) in kept.iter().enumerate() {
            triangle.insert(old as u32, new as u32);
        }
        let mut renumbered = |old: u32| {
            *vertex.entry(old).or_insert_with(|| {
                vertices.push(self.mesh.vertices[old as usize]);
                vertices.len() as u32 - 1
            })
        };
        let triangles = kept.iter().map(|&t| self.mesh.triangles[t].map(&mut renumbered)).collect();
        let across = |old: u32| triangle.get(&old).copied().unwrap_or(NO_NEIGHBOUR);
        let neighbours = kept.iter().map(|&t| self.mesh.neighbours[t].map(across)).collect();
        Mesh { vertices, triangles, neighbours }
    }

    /// A point on the surface of a solid, away from all others if possible, so that [`Self::nearest`] finds it again.
    pub fn point(&self, number: usize) -> Option<DVec3> {
        if self.count == 1 {
            return self.mesh.triangles.first().map(|_| Triangle::of(self.mesh, 0).middle());
        }
        let own = || (0..self.solid.len()).filter(|t| self.solid[*t] == number);
        let middles = own().map(|t| Triangle::of(self.mesh, t).middle()).step_by(own().count() / TRIED + 1);
        let beside = (self.mesh.size().length() * BESIDE).powi(2);
        let alone = |p: &DVec3| self.tree.locate_within_distance(p.to_array(), beside).all(|face| face.solid == number);
        middles.clone().find(alone).or_else(|| middles.clone().next())
    }

    /// For each group of triangles, given by their corners, the solids to which they belong.
    pub(super) fn of_groups(&self, groups: impl Iterator<Item = impl Iterator<Item = [DVec3; 3]>>) -> Vec<Vec<usize>> {
        if self.count == 1 {
            return groups.map(|_| vec![0]).collect();
        }
        let key = |v: DVec3| v.to_array().map(f64::to_bits);
        let mut around: HashMap<[u64; 3], Vec<usize>> = HashMap::new();
        for (triangle, solid) in self.mesh.triangles.iter().zip(&self.solid) {
            for corner in triangle {
                let solids = around.entry(key(self.mesh.vertices[*corner as usize])).or_default();
                if !solids.contains(solid) {
                    solids.push(*solid);
                }
            }
        }
        let none = Vec::new();
        let of = |corners: [DVec3; 3]| {
            let [a, b, c] = corners.map(|corner| around.get(&key(corner)).unwrap_or(&none));
            let mut common = a.iter().filter(|solid| b.contains(solid) && c.contains(solid));
            // Where solids touch, their faces have the same corners.
            common.next().filter(|_| common.next().is_none()).copied()
        };
        groups.map(|group| group.filter_map(of).collect::<BTreeSet<_>>().into_iter().collect()).collect()
    }
}

/// Points tried on the surface of a solid.
const TRIED: usize = 200;
/// A point is on another solid if it is within this fraction of the mesh's size.
const BESIDE: f64 = 1e-4;

/// The shell of each triangle, and the number of shells.
fn shells(mesh: &Mesh) -> (Vec<usize>, usize) {
    let mut shell = vec![usize::MAX; mesh.triangles.len()];
    let (mut count, mut open) = (0, Vec::new());
    for first in 0..shell.len() {
        if shell[first] != usize::MAX {
            continue;
        }
        shell[first] = count;
        open.push(first);
        while let Some(t) = open.pop() {
            for across in mesh.neighbours[t].into_iter().filter(|across| *across != NO_NEIGHBOUR) {
                if std::mem::replace(&mut shell[across as usize], count) == usize::MAX {
                    open.push(across as usize);
                }
            }
        }
        count += 1;
    }
    (shell, count)
}

/// For each shell the one whose solid it belongs to: a cavity to the smallest shell around it, others to themselves.
fn owners(mesh: &Mesh, shell: &[usize], count: usize) -> Vec<usize> {
    let (mut volume, mut corners) = (vec![0.0; count], vec![0; count]);
    let mut bounds = vec![(DVec3::INFINITY, DVec3::NEG_INFINITY); count];
    for (triangle, &shell) in mesh.triangles.iter().zip(shell) {
        let [a, b, c] = triangle.map(|i| mesh.vertices[i as usize]);
        volume[shell] += a.dot(b.cross(c)) / 6.0;
        corners[shell] = triangle[0];
        for corner in [a, b, c] {
            bounds[shell] = (bounds[shell].0.min(corner), bounds[shell].1.max(corner));
        }
    }
    let boxes = (0..count).filter(|shell| volume[*shell] > 0.0).map(|shell| {
        let (low, high) = bounds[shell];
        GeomWithData::new(Rectangle::from_corners(low.to_array(), high.to_array()), shell)
    });
    let boxes = RTree::bulk_load(boxes.collect());
    // There are few cavities, and few boxes contain them.
    let is_inside = |p: DVec3, outer: usize| {
        let own = shell.iter().enumerate().filter(|(_, shell)| **shell == outer);
        own.map(|(t, _)| Triangle::of(mesh, t).solid_angle(p)).sum::<f64>() > TAU
    };
    let owner = |own: usize| {
        if volume[own] >= 0.0 {
            return own;
        }
        let corner = mesh.vertices[corners[own] as usize];
        let around = boxes.locate_all_at_point(&corner.to_array()).map(|around| around.data);
        let around = around.filter(|other| volume[*other] > -volume[own] && is_inside(corner, *other));
        around.min_by(|a, b| volume[*a].total_cmp(&volume[*b]).then(a.cmp(b))).unwrap_or(own)
    };
    (0..count).map(owner).collect()
}

/// A triangle and the solid it belongs to.
struct Face {
    triangle: Triangle,
    solid: usize,
}

impl RTreeObject for Face {
    type Envelope = AABB<[f64; 3]>;

    fn envelope(&self) -> Self::Envelope {
        self.triangle.envelope()
    }
}

impl PointDistance for Face {
    fn distance_2(&self, point: &[f64; 3]) -> f64 {
        self.triangle.distance_2(point)
    }
}
