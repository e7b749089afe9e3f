//! Room: the distance of each point of an island from its outline, and the island's width along its middle.

use super::LoopSettings;
use glam::DVec2;
use planar::lattice::Lattice;
use planar::nearest::{self, NONE, Nearest};
use planar::{Bounds, Polygon, Region, Ring};

/// Lattice points across a bead.
const POINTS_ACROSS: f64 = 12.0;
/// How many times the lattice can be halved.
pub(super) const HALVINGS: u32 = 4;
/// Cosine of 115°: a point is in the middle of a wall if the directions to its nearest outlines differ by more than
/// that. The branches of the medial axis into square corners do not count.
const COS_BETWEEN: f64 = -0.4226;

/// A point in the middle of a wall.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Middle {
    /// Index of the lattice point.
    pub point: usize,
    /// Half the width of the wall, mm.
    pub radius: f64,
}

/// The space inside an island.
#[derive(Debug, Clone, PartialEq)]
pub struct Room {
    /// Points over the island.
    pub lattice: Lattice,
    /// Which points lie inside.
    pub inside: Vec<bool>,
    /// Distance from the outline, mm; 0 outside.
    pub distance: Vec<f32>,
    /// The points in the middle of walls.
    pub middles: Vec<Middle>,
}

impl Room {
    /// The room of an island.
    pub fn of(island: &Polygon, settings: &LoopSettings) -> Self {
        let bounds = Bounds::of(island.outer.points().iter().copied()).unwrap_or(Bounds::EMPTY);
        let step = settings.bead_width / POINTS_ACROSS;
        let lattice = Lattice::covering(&bounds, 2.0 * step, step, 1 << HALVINGS);
        let inside = lattice.inside(island.rings());
        let edges: Vec<(DVec2, DVec2)> = island.rings().flat_map(Ring::edges).collect();
        let near = nearest::nearest(&lattice, &edges, &inside);
        let middles = middles(&lattice, &edges, &near);
        let distance = near.distance.iter().map(|&d| if d.is_finite() { d } else { 0.0 }).collect();
        Self { lattice, inside, distance, middles }
    }

    /// Which points lie inside a region.
    pub fn inside_of(&self, region: &Region) -> Vec<bool> {
        self.lattice.inside(region.rings())
    }

    /// Distance from the outline at a place, mm.
    pub fn at(&self, p: DVec2) -> f64 {
        self.lattice.value_at(&self.distance, p)
    }

    /// Unit vector away from the outline.
    pub fn inwards(&self, p: DVec2) -> DVec2 {
        self.lattice.slope_at(&self.distance, p).normalize_or_zero()
    }
}

/// Neighbouring points whose nearest outlines lie on opposite sides.
fn middles(lattice: &Lattice, edges: &[(DVec2, DVec2)], near: &Nearest) -> Vec<Middle> {
    let mut radius = vec![0.0_f64; lattice.len()];
    let columns = lattice.columns;
    for row in 1..lattice.rows - 1 {
        for i in row * columns + 1..(row + 1) * columns - 1 {
            let own = near.segment[i];
            if own == NONE {
                continue;
            }
            for j in [i + 1, i + columns - 1, i + columns, i + columns + 1] {
                let other = near.segment[j];
                if other == NONE || other == own {
                    continue;
                }
                let (p, q) = (lattice.place_of(i), lattice.place_of(j));
                let (f, g) = (nearest::foot(edges[own as usize], p), nearest::foot(edges[other as usize], q));
                let cos = (f - p).normalize_or_zero().dot((g - q).normalize_or_zero());
                if cos < COS_BETWEEN {
                    // The chord between the points where a disc touches both sides.
                    let half = f.distance(g) / (2.0 * ((1.0 - cos) / 2.0).sqrt());
                    radius[i] = radius[i].max(half);
                    radius[j] = radius[j].max(half);
                }
            }
        }
    }
    let found = radius.iter().enumerate().filter(|(_, radius)| **radius > 0.0);
    found.map(|(point, &radius)| Middle { point, radius }).collect()
}
