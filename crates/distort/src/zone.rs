//! The zone of a bead that shrinks, and by how much.

use crate::input::Bead;
use crate::metal::{Metal, Piece, pieces};
use crate::settings::Settings;
use rayon::prelude::*;
use rustc_hash::FxHashMap;

/// A piece with metal in less than this area, mm², pulls nothing.
const LEAST_AREA: f64 = 1e-6;

/// What a bead adds to a voxel.
#[derive(Default)]
struct Share {
    /// Strain (xx, yy, zz, xy, yz, zx; shear as angles).
    strain: [f64; 6],
    /// Shrinkage along the bead.
    amount: f64,
    /// The same times the dyad of the direction.
    direction: [f64; 6],
}

/// Components xx, yy, zz, xy, yz, zx of the dyad of a vector.
fn dyad(v: glam::DVec3) -> [f64; 6] {
    [v.x * v.x, v.y * v.y, v.z * v.z, v.x * v.y, v.y * v.z, v.z * v.x]
}

impl Settings {
    /// How far the zone reaches beneath a bead and beyond it on each side, mm: bead and zone together have the area that
    /// the tendon force needs.
    fn reach(&self, bead: &Bead) -> f64 {
        let area = self.tendon * bead.heat / (self.elastic.young * self.zone_strain);
        let beneath = (area - bead.width * bead.height).max(0.0);
        // (w + 2 s) s = area beneath.
        let w = bead.width;
        (-w + (w * w + 8.0 * beneath).sqrt()) / 4.0
    }

    /// Strain of a unit of shrinkage along a piece.
    fn unit_strain(&self, piece: &Piece) -> [f64; 6] {
        let [along, across, up] = [piece.along, piece.across, piece.up].map(dyad);
        std::array::from_fn(|i| {
            let shear = if i < 3 { 1.0 } else { 2.0 };
            -shear * (along[i] + self.across * across[i] + self.up * up[i])
        })
    }
}

/// Adds the stress-free strains of beads, in the order of welding, to those of the voxels so far; returns the voxels.
pub(crate) fn shrink(beads: &[&Bead], metal: &Metal, settings: &Settings, strains: &mut [[f64; 6]]) -> Vec<usize> {
    let most = settings.zone_strain * settings.saturation;
    let shares: Vec<Vec<(usize, Share)>> =
        beads.par_iter().map(|bead| in_order(shares(bead, metal, settings))).collect();
    for (voxel, share) in shares.iter().flatten() {
        let strain = &mut strains[*voxel];
        let before: f64 = -strain.iter().zip(&share.direction).map(|(s, d)| s * d).sum::<f64>() / share.amount;
        let part = ((most - before) / share.amount).clamp(0.0, 1.0);
        strain.iter_mut().zip(&share.strain).for_each(|(s, added)| *s += part * added);
    }
    shares.into_iter().flatten().map(|(voxel, _)| voxel).collect()
}

fn in_order(shares: FxHashMap<usize, Share>) -> Vec<(usize, Share)> {
    let mut shares: Vec<(usize, Share)> = shares.into_iter().collect();
    shares.sort_unstable_by_key(|&(voxel, _)| voxel);
    shares
}

fn shares(bead: &Bead, metal: &Metal, settings: &Settings) -> FxHashMap<usize, Share> {
    let force = settings.tendon * bead.heat;
    let (reach, most) = (settings.reach(bead), settings.zone_strain * settings.saturation);
    let mut found: FxHashMap<usize, Share> = FxHashMap::default();
    let mut zone: Vec<(usize, f64)> = Vec::new();
    for piece in pieces(bead, &metal.grid) {
        zone.clear();
        let own = piece.samples(&metal.grid, bead.width, 0.0..bead.height);
        let below = bead.height..bead.height + reach;
        let beneath = (reach > 0.0).then(|| piece.samples(&metal.grid, bead.width + 2.0 * reach, below));
        for sample in own.chain(beneath.into_iter().flatten()) {
            let voxel = metal.grid.voxel_of(sample.at).filter(|&voxel| metal.factors[voxel] > 0.0);
            zone.extend(voxel.map(|voxel| (voxel, sample.area)));
        }
        let area: f64 = zone.iter().map(|&(voxel, area)| area * metal.factors[voxel]).sum();
        if area < LEAST_AREA || force <= 0.0 {
            continue;
        }
        // Where there is less metal than the zone asks for, as in a thin wall, it cannot pull harder than it yields.
        let shrinkage = (force / (settings.elastic.young * area)).min(most);
        let (unit, direction) = (settings.unit_strain(&piece), dyad(piece.along));
        for &(voxel, area) in &zone {
            let share = found.entry(voxel).or_default();
            let amount = shrinkage * area * piece.length / metal.grid.volume();
            share.amount += amount;
            (0..6).for_each(|i| share.strain[i] += amount * unit[i]);
            (0..6).for_each(|i| share.direction[i] += amount * direction[i]);
        }
    }
    found
}
