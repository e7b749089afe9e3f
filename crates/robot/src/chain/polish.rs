//! Newton's method on the six joints: makes closed forms exact for chains whose axes are not quite parallel or do not
//! quite meet, as in calibrated arms.

use super::Chain;
use crate::arm::Frame;
use glam::DVec3;

/// A solution is right if the flange is within this, mm; directions, in rad, are weighted as at 1000 mm from the
/// flange.
const RIGHT_MM: f64 = 1e-7;
const LEVER_MM: f64 = 1e3;
/// In a singularity, where Newton's method fails, a closed form is accepted if it is within this, mm.
const NEAR_MM: f64 = 1e-4;
/// Most steps from a start; each squares the error.
const STEPS: usize = 12;

/// A solution near given joint angles, rad; `None` if there is none.
pub(super) fn polished(chain: &Chain, mut joints: [f64; 6], wanted: &Frame) -> Option<[f64; 6]> {
    let mut best = (f64::INFINITY, joints);
    for _ in 0..STEPS {
        let now = chain.flange_at(&joints);
        let off = error(&now, wanted);
        let size = off.iter().fold(0.0, |most: f64, v| most.max(v.abs()));
        if size < best.0 {
            best = (size, joints);
        }
        if size < RIGHT_MM {
            break;
        }
        let Some(step) = solved(columns(chain, &joints, now.position), off) else { break };
        joints = std::array::from_fn(|j| joints[j] + step[j]);
    }
    (best.0 < NEAR_MM).then_some(best.1)
}

/// The difference between a frame and the wanted one: a shift and a weighted turn, mm.
fn error(now: &Frame, wanted: &Frame) -> [f64; 6] {
    let turn = wanted.rotation * now.rotation.conjugate();
    // Of the two quaternions of a rotation, the one with the smaller turn.
    let least = if turn.w < 0.0 { -turn } else { turn };
    join(wanted.position - now.position, least.to_scaled_axis() * LEVER_MM)
}

/// Derivative of the flange's frame by each joint, mm per rad.
fn columns(chain: &Chain, joints: &[f64; 6], flange: DVec3) -> [[f64; 6]; 6] {
    std::array::from_fn(|j| {
        let (before, axis) = (chain.moved(joints, j), chain.axes[j]);
        let along = before.rotation * axis.along;
        join(along.cross(flange - before.apply(axis.at)), along * LEVER_MM)
    })
}

fn join(way: DVec3, turn: DVec3) -> [f64; 6] {
    [way.x, way.y, way.z, turn.x, turn.y, turn.z]
}

/// The weights with which the columns add up to `sum`, by elimination with partial pivoting; `None` for a singular
/// matrix.
fn solved(columns: [[f64; 6]; 6], mut sum: [f64; 6]) -> Option<[f64; 6]> {
    let mut rows: [[f64; 6]; 6] = std::array::from_fn(|row| columns.map(|column| column[row]));
    for k in 0..6 {
        let pivot = (k..6).max_by(|&a, &b| rows[a][k].abs().total_cmp(&rows[b][k].abs()))?;
        rows.swap(k, pivot);
        sum.swap(k, pivot);
        let top = rows[k];
        if top[k].abs() < 1e-9 {
            return None;
        }
        for below in k + 1..6 {
            let factor = rows[below][k] / top[k];
            for (value, above) in rows[below].iter_mut().zip(top) {
                *value -= factor * above;
            }
            sum[below] -= factor * sum[k];
        }
    }
    let mut weights = [0.0; 6];
    for k in (0..6).rev() {
        let known: f64 = (k + 1..6).map(|j| rows[k][j] * weights[j]).sum();
        weights[k] = (sum[k] - known) / rows[k][k];
    }
    Some(weights)
}
