//! The part as welded so far: balls along its beads, in blocks of space.

use crate::body::Capsule;
use glam::{DVec3, IVec3};
use std::collections::HashMap;

/// Edge of a voxel, mm; only the last bead in each counts, which is the outermost. Depths are accurate to a millimetre
/// or so.
const VOXEL_MM: f64 = 5.0;
/// Edge of a block, in voxels.
const EDGE: i32 = 8;

/// Beads as balls of one size that touch the beads' tops from below.
pub(crate) struct Metal {
    /// Radius of the balls, mm.
    radius: f64,
    /// Centres of the balls by block and voxel, mm.
    blocks: HashMap<IVec3, Vec<Option<DVec3>>>,
    low: DVec3,
    high: DVec3,
}

impl Metal {
    /// No metal yet; beads will be this wide, mm.
    pub(crate) fn new(width: f64) -> Self {
        Self { radius: width / 2.0, blocks: HashMap::new(), low: DVec3::INFINITY, high: DVec3::NEG_INFINITY }
    }

    /// Lays a bead between two points on its top, mm, on layers with these normals.
    pub(crate) fn lay(&mut self, places: [DVec3; 2], normals: [DVec3; 2]) {
        let [from, to] = [0, 1].map(|k| places[k] - normals[k] * self.radius);
        // Balls are at most one radius apart; no part needs more.
        let count = (from.distance(to) / self.radius.max(1e-3)).ceil().clamp(1.0, 1e4) as usize;
        for k in 0..=count {
            self.add(from.lerp(to, k as f64 / count as f64));
        }
    }

    fn add(&mut self, middle: DVec3) {
        let voxel = (middle / VOXEL_MM).floor().as_ivec3();
        let block = voxel.div_euclid(IVec3::splat(EDGE));
        let at = voxel - block * EDGE;
        let slots = self.blocks.entry(block).or_insert_with(|| vec![None; EDGE.pow(3) as usize]);
        if let Some(slot) = slots.get_mut((at.x + EDGE * (at.y + EDGE * at.z)) as usize) {
            *slot = Some(middle);
        }
        (self.low, self.high) = (self.low.min(middle), self.high.max(middle));
    }

    /// Distance of a capsule from the metal, mm; negative if it is inside, infinite if it is far from any.
    pub(crate) fn gap(&self, capsule: &Capsule) -> f64 {
        let reach = capsule.radius + self.radius;
        let [a, b] = capsule.ends;
        let (low, high) = ((a.min(b) - reach).max(self.low), (a.max(b) + reach).min(self.high));
        if low.cmpgt(high).any() {
            return f64::INFINITY;
        }
        let edge = VOXEL_MM * f64::from(EDGE);
        let [first, last] = [low, high].map(|corner| (corner / edge).floor().as_ivec3());
        let half = DVec3::splat(edge / 2.0);
        let blocks = (first.z..=last.z).flat_map(|z| (first.y..=last.y).map(move |y| (y, z)));
        let blocks = blocks.flat_map(|(y, z)| (first.x..=last.x).map(move |x| IVec3::new(x, y, z)));
        let near = blocks.filter(|block| to_line(block.as_dvec3() * edge + half, capsule.ends) < reach + half.length());
        let balls = near.filter_map(|block| self.blocks.get(&block)).flatten().flatten();
        let nearest = balls.map(|middle| to_line(*middle, capsule.ends)).fold(f64::INFINITY, f64::min);
        if nearest < reach { nearest - reach } else { f64::INFINITY }
    }
}

/// Distance of a point from the line segment between two others, mm.
fn to_line(place: DVec3, [a, b]: [DVec3; 2]) -> f64 {
    let way = b - a;
    let along = ((place - a).dot(way) / way.length_squared().max(1e-12)).clamp(0.0, 1.0);
    place.distance(a + way * along)
}

#[cfg(test)]
mod tests {
    use super::{Metal, to_line};
    use crate::body::{Capsule, Solid};
    use glam::{DQuat, DVec3};

    /// Numbers that look random, -1 to 1.
    fn random(state: &mut u64) -> f64 {
        *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (*state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    fn torch(ends: [DVec3; 2], radius: f64) -> Capsule {
        Capsule { solid: Solid::Torch, ends, radius }
    }

    /// As deep in a long bead as two round bars are in each other, however both lie; nowhere else is there a hit.
    #[test]
    fn a_capsule_is_as_deep_in_a_bead_as_bars_are_in_each_other() {
        let mut state = 7;
        let mut hits = 0;
        for _ in 0..400 {
            let mut place = |size: f64| size * DVec3::from_array([(); 3].map(|()| random(&mut state)));
            let (middle, way, normal) = (place(300.0), place(1.0).normalize(), place(1.0));
            let normal = normal.reject_from(way).normalize();
            let width = 6.0;
            let mut metal = Metal::new(width);
            let ends = [middle - way * 80.0, middle + way * 80.0];
            metal.lay(ends, [normal; 2]);
            let (aside, lean) = (place(30.0), place(1.0).normalize());
            let capsule = torch([middle + aside - lean * 60.0, middle + aside + lean * 60.0], 12.0);
            // The bead's line, in steps that are much finer.
            let line = (0..=16_000).map(|k| ends[0].lerp(ends[1], f64::from(k) / 16_000.0) - normal * width / 2.0);
            let exact = line.map(|p| to_line(p, capsule.ends)).fold(f64::INFINITY, f64::min) - 12.0 - width / 2.0;
            let found = metal.gap(&capsule);
            // Balls in one voxel are one, so that up to two voxels lie between them.
            let most = (exact + 15.0).hypot(5.0) - 15.0;
            if most < 0.0 {
                assert!(exact - 0.01 <= found && found <= most, "{found} for {exact}");
                hits += 1;
            }
            assert!(exact < 0.0 || found == f64::INFINITY, "{found} for {exact}");
        }
        assert!(hits > 60, "{hits}");
    }

    /// Above its own bead there is room, on layers of any direction, and below its top there is none.
    #[test]
    fn beads_end_at_their_tops() {
        for turn in [DQuat::IDENTITY, DQuat::from_rotation_x(1.2), DQuat::from_rotation_y(-2.5)] {
            let mut metal = Metal::new(5.0);
            let normal = turn * DVec3::Z;
            for k in -10..=10 {
                let aside = turn * DVec3::Y * (4.0 * f64::from(k));
                metal.lay([turn * DVec3::X * -50.0 + aside, turn * DVec3::X * 50.0 + aside], [normal; 2]);
            }
            let over = |height: f64| metal.gap(&torch([normal * (height + 10.0), normal * 200.0], 10.0));
            assert_eq!(over(0.05), f64::INFINITY);
            assert!(over(-2.0) < -0.5 && over(-2.0) > -2.05, "{}", over(-2.0));
        }
    }
}
