//! A cut: what lies above a plane is taken off as pieces with directions of their own.

use super::between::between;
use super::samples::{area, samples};
use super::ways::Judge;
use super::{Piece, State};
use crate::chart::{Bound, Chart, Plane};
use crate::model::{Mesh, Solids};
use glam::DVec3;

/// Directions that differ by less than this are the same, °.
const SAME: f64 = 2.0;

/// What remains below a cut must be this thick, in bead widths, and have this fraction of the part's surface.
const THICK: f64 = 3.0;
const LEAST: f64 = 0.05;

/// Extent of a mesh along a direction, mm.
fn thickness(mesh: &Mesh, along: DVec3) -> f64 {
    let reach = mesh.vertices.iter().map(|p| along.dot(*p));
    let (low, high) = reach.fold((f64::MAX, f64::MIN), |(low, high), at| (low.min(at), high.max(at)));
    high - low
}

/// Solids that are built along one direction.
struct Group {
    up: DVec3,
    mesh: Mesh,
}

/// The division after a cut; `None` if nothing is cut or planes cannot separate the pieces.
pub(super) fn cut(state: &State, plane: Plane, judge: &Judge) -> Option<State> {
    let down = Plane { origin: plane.origin, up: DVec3::ZERO - plane.up };
    let (upper, trunk) = (plane.above(&state.trunk), down.above(&state.trunk));
    if upper.triangles.is_empty() || trunk.triangles.is_empty() {
        return None;
    }
    let samples = samples(&trunk, judge.size);
    // A thin slice of the part is nothing to stand on.
    if area(samples.iter()) < LEAST * judge.surface || thickness(&trunk, plane.up) < THICK * judge.settings.bead {
        return None;
    }
    let (groups, [hanging, skew]) = groups(&upper, plane, judge);
    // Undersides of the part itself that lie in the plane are not made by the cut.
    let hanging = hanging + area(state.samples.iter().filter(|sample| judge.stands(sample, plane)));
    let pieces = pieces(&groups, plane, &state.cuts)?;
    let hanging = [judge.hanging(&samples, DVec3::Z, judge.table()), state.hanging[1] + hanging];
    let all: Vec<Piece> = state.pieces.iter().cloned().chain(pieces).collect();
    let tilted = all.iter().map(Piece::tilt).fold(0.0, f64::max);
    let skew = state.skew + skew;
    let cost = hanging.iter().sum::<f64>() + skew + judge.pieces(all.len()) + judge.tilt(tilted);
    let cuts = state.cuts.iter().copied().chain([down]).collect();
    Some(State { trunk, samples, cuts, pieces: all, hanging, skew, cost })
}

/// What was taken off, grouped by direction; how much of it still overhangs, and what it costs that the cut lies at an angle
/// to the layers on both of its sides, mm².
fn groups(upper: &Mesh, plane: Plane, judge: &Judge) -> (Vec<Group>, [f64; 2]) {
    let solids = Solids::of(upper);
    let (mut groups, mut hanging, mut skew): (Vec<Group>, f64, f64) = (Vec::new(), 0.0, 0.0);
    for mesh in solids.each() {
        let samples = samples(&mesh, judge.size);
        let best = judge.best(&samples, plane);
        let up = if best.angle_between(plane.up).to_degrees() < SAME { plane.up } else { best };
        hanging += judge.hanging(&samples, up, plane);
        skew += judge.skew(&samples, up, plane) + judge.skew(&samples, DVec3::Z, plane);
        match groups.iter_mut().find(|group| group.up.angle_between(up).to_degrees() < SAME) {
            Some(group) => group.mesh.add(mesh),
            None => groups.push(Group { up, mesh }),
        }
    }
    (groups, [hanging, skew])
}

/// The groups as pieces above a plane, separated from each other by further planes.
fn pieces(groups: &[Group], plane: Plane, cuts: &[Plane]) -> Option<Vec<Piece>> {
    let piece = |(k, group): (usize, &Group)| {
        let others = groups.iter().enumerate().filter(|(other, _)| *other != k);
        let parted = others.map(|(_, other)| between(&group.mesh.vertices, &other.mesh.vertices).map(Plane::rounded));
        let parted = parted.collect::<Option<Vec<Plane>>>()?;
        let square = group.up == plane.up;
        let lowest = group.mesh.vertices.iter().map(|p| group.up.dot(*p)).fold(f64::MAX, f64::min);
        let first = if square { plane } else { Plane { origin: group.up * lowest, up: group.up } };
        let planes = cuts.iter().copied().chain((!square).then_some(plane)).chain(parted);
        let within = planes.map(Bound::Plane).collect();
        Some(Piece { chart: Chart::Plane(first.rounded()), within, also: Vec::new(), on_stock: false })
    };
    groups.iter().enumerate().map(piece).collect()
}
