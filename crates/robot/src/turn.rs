//! The course of the torch angle: which way the torch is turned about its own axis, station by station.
//!
//! Two dynamic programs run over a table of margins (station × branch × angle): the first finds the greatest least
//! margin of any course; the second finds, of all courses that keep it, the one that turns least. A turn from one
//! station to the next is at most one step of the table. Posts write one angle for the whole program, so a single angle
//! that does nearly as well is preferred.

use crate::arm::{Arm, Branch, Frame};
use crate::track::{PIECE_MM, Stop};
use rayon::prelude::*;
use std::collections::HashMap;

/// Number of torch angles tried.
pub(crate) const ANGLES: usize = 36;
/// Step from one to the next, °.
pub(crate) const STEP: f64 = 360.0 / ANGLES as f64;
/// The torch turns from one station to the next only if there is at least this much time, s.
const TURNING_SECONDS: f64 = 0.2;
/// Margin assigned to a pose that cannot be reached, °.
const NOWHERE: f32 = -1e3;
/// Margin that may be given up so that the torch does not have to turn, °.
const WORTH_TURNING: f32 = 5.0;
/// Margins that differ by less than this are equal, °.
const SAME: f32 = 1e-2;
/// Cost of a station beyond a limit, in turns.
const BAD: u64 = 1 << 12;

/// Up to this many stations each have their own margins; beyond that, neighbours with similar attitudes share them.
const EXACT: usize = 10_000;
/// Stations within about this distance share their margins, mm: those of arms with 1 to 2 m reach differ by 0.1° on
/// average, and by a few degrees only near a singularity. The walk along the chosen course computes every stop exactly.
const SHARED_MM: f64 = 5.0;
/// They also have tools that differ in rotation by less than about this, as the sine of half the angle: 0.3°.
const SHARED_TURN: f64 = 0.0025;

/// Margins of one station, °: for each angle, those of all branches.
type Row = [[f32; Branch::COUNT]; ANGLES];

/// The margins of all stations.
struct Rows {
    rows: Vec<Row>,
    /// Index of the row of each station.
    of: Vec<usize>,
}

/// The chosen course.
pub(crate) struct Course {
    /// The branch of the arm.
    pub(crate) branch: Branch,
    /// Torch angle at every stop, °.
    pub(crate) angles: Vec<f64>,
    /// The best single angle, °, and its least margin, °.
    pub(crate) single: (f64, f64),
    /// Number of poses computed.
    pub(crate) poses: usize,
}

/// Picks branch and angles.
pub(crate) fn course(arm: &Arm, base_from_part: &Frame, tool_from_flange: &Frame, stops: &[Stop]) -> Course {
    let stations = stations(stops);
    let rows = Rows::new(arm, base_from_part, tool_from_flange, stops, &stations, EXACT);
    let turnable = turnable(stops, &stations);
    let steps = |branch: usize| Steps { rows: &rows, turnable: &turnable, branch };
    let least: Vec<f32> = (0..Branch::COUNT).map(|b| steps(b).best_margin()).collect();
    let greatest = (0..Branch::COUNT).rev().max_by(|&a, &b| least[a].total_cmp(&least[b])).unwrap_or(0);
    let single = steps(greatest).single();
    let (branch, chosen) = if single.1 >= (least[greatest] - WORTH_TURNING).max(0.0) {
        (greatest, vec![single.0; stations.len()])
    } else if least[greatest] >= 0.0 {
        (greatest, steps(greatest).fewest_turns(least[greatest] - SAME).1)
    } else {
        // No branch reaches every station: take the one that reaches the most.
        let tried = (0..Branch::COUNT).map(|b| (b, steps(b).fewest_turns(0.0)));
        tried.min_by_key(|(b, (cost, _))| (*cost, *b)).map_or((0, Vec::new()), |(b, (_, path))| (b, path))
    };
    let single_of = |(k, margin): (usize, f32)| (k as f64 * STEP, f64::from(margin));
    Course {
        branch: Branch::new(branch),
        angles: spread(stops, &stations, &chosen),
        single: single_of(steps(branch).single()),
        poses: rows.rows.len() * ANGLES,
    }
}

/// Stops at which the angle is chosen: starts and ends of passes, and at least every [`PIECE_MM`] between.
fn stations(stops: &[Stop]) -> Vec<usize> {
    let mut found = Vec::new();
    let mut way = f64::INFINITY;
    for (i, stop) in stops.iter().enumerate() {
        let next = stops.get(i + 1);
        let length = if i > 0 { stops[i - 1].at.distance(stop.at) } else { 0.0 };
        way += length;
        if next.is_none_or(|n| n.arc != stop.arc || way + stop.at.distance(n.at) > PIECE_MM) {
            found.push(i);
            way = 0.0;
        }
    }
    found
}

/// Whether there is time to turn the torch on the way to each station.
fn turnable(stops: &[Stop], stations: &[usize]) -> Vec<bool> {
    let mut from = 0;
    let enough = |&station: &usize| {
        let time: f64 = stops[from..=station].iter().skip(1).map(|s| s.seconds).sum();
        from = station;
        time >= TURNING_SECONDS
    };
    stations.iter().map(enough).collect()
}

impl Rows {
    fn new(
        arm: &Arm,
        base_from_part: &Frame,
        tool_from_flange: &Frame,
        stops: &[Stop],
        stations: &[usize],
        exact: usize,
    ) -> Self {
        let (first, of) = if stations.len() <= exact {
            (stations.to_vec(), (0..stations.len()).collect())
        } else {
            neighbours(stops, stations)
        };
        let rows = first.par_iter().map(|&s| row(arm, base_from_part, tool_from_flange, &stops[s])).collect();
        Self { rows, of }
    }

    fn len(&self) -> usize {
        self.of.len()
    }
}

/// The first station of each group of neighbours with similar attitudes, and the group of each station.
fn neighbours(stops: &[Stop], stations: &[usize]) -> (Vec<usize>, Vec<usize>) {
    let (mut first, mut groups) = (Vec::new(), HashMap::new());
    let mut group = |&station: &usize| {
        let tool = stops[station].tool(0.0);
        // A quaternion and its negative are the same rotation.
        let turn = if tool.rotation.x < 0.0 { -tool.rotation } else { tool.rotation };
        let place = (tool.position / SHARED_MM).round().as_i64vec3();
        let key = (place, turn.to_array().map(|q| (q / SHARED_TURN).round() as i64));
        *groups.entry(key).or_insert_with(|| {
            first.push(station);
            first.len() - 1
        })
    };
    let of = stations.iter().map(&mut group).collect();
    (first, of)
}

fn row(arm: &Arm, base_from_part: &Frame, tool_from_flange: &Frame, stop: &Stop) -> Row {
    let mut row = [[NOWHERE; Branch::COUNT]; ANGLES];
    for (k, margins) in row.iter_mut().enumerate() {
        let tool = base_from_part.then(&stop.tool(k as f64 * STEP));
        for (branch, joints) in arm.inverse(&tool.then(tool_from_flange)) {
            let margin = &mut margins[branch.index()];
            *margin = margin.max(arm.margins(&joints).least() as f32);
        }
    }
    row
}

/// The table for one branch.
#[derive(Clone, Copy)]
struct Steps<'a> {
    rows: &'a Rows,
    turnable: &'a [bool],
    branch: usize,
}

impl Steps<'_> {
    fn margin(&self, station: usize, k: usize) -> f32 {
        self.rows.rows[self.rows.of[station]][k][self.branch]
    }

    /// Angles at the previous station from which angle `k` can be reached, the unturned one first.
    fn before(&self, station: usize, k: usize) -> impl Iterator<Item = usize> + use<> {
        let count = if self.turnable[station] { 3 } else { 1 };
        [k, (k + 1) % ANGLES, (k + ANGLES - 1) % ANGLES].into_iter().take(count)
    }

    /// The greatest least margin of any course, °.
    fn best_margin(&self) -> f32 {
        let mut best = [f32::INFINITY; ANGLES];
        for station in 0..self.rows.len() {
            best = std::array::from_fn(|k| {
                let before = self.before(station, k).map(|j| best[j]).fold(f32::NEG_INFINITY, f32::max);
                before.min(self.margin(station, k))
            });
        }
        best.into_iter().fold(f32::NEG_INFINITY, f32::max)
    }

    /// The course with the fewest stations below that margin, and among those the fewest turns; with its cost.
    fn fewest_turns(&self, margin: f32) -> (u64, Vec<usize>) {
        let mut costs = [0_u64; ANGLES];
        let mut came = Vec::with_capacity(self.rows.len());
        for station in 0..self.rows.len() {
            let mut from = [0_u8; ANGLES];
            costs = std::array::from_fn(|k| {
                let turned = |j: usize| (costs[j].saturating_add(u64::from(j != k)), j);
                let (cost, j) = self.before(station, k).map(turned).min_by_key(|(cost, _)| *cost).unwrap_or_default();
                from[k] = j as u8;
                // Beyond a limit is bad; out of reach is worse.
                let bad = if self.margin(station, k) >= margin {
                    0
                } else if self.margin(station, k) > NOWHERE {
                    BAD
                } else {
                    2 * BAD
                };
                cost.saturating_add(bad)
            });
            came.push(from);
        }
        let end = (0..ANGLES).min_by_key(|&k| costs[k]).unwrap_or(0);
        let mut path: Vec<usize> =
            came.iter().rev().scan(end, |k, from| Some(std::mem::replace(k, from[*k].into()))).collect();
        path.reverse();
        (costs[end], path)
    }

    /// The best constant angle, in steps of the table, and its least margin, °.
    fn single(&self) -> (usize, f32) {
        let least = |k: usize| (0..self.rows.len()).map(|s| self.margin(s, k)).fold(f32::INFINITY, f32::min);
        (0..ANGLES).map(|k| (k, least(k))).rev().max_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or((0, NOWHERE))
    }
}

/// The angles of all stops: between stations the torch turns evenly along the path.
fn spread(stops: &[Stop], stations: &[usize], chosen: &[usize]) -> Vec<f64> {
    let mut angles = vec![0.0; stops.len()];
    let mut last: Option<(usize, f64)> = None;
    for (&station, &k) in stations.iter().zip(chosen) {
        let (from, before) = last.unwrap_or((station, k as f64 * STEP));
        let to = crate::arm::turned_near(k as f64 * STEP, before);
        let lengths = (from + 1..=station).map(|i| stops[i - 1].at.distance(stops[i].at));
        let total: f64 = lengths.clone().sum::<f64>().max(1e-9);
        let mut way = 0.0;
        for (i, length) in (from + 1..=station).zip(lengths) {
            way += length;
            angles[i] = before + (to - before) * way / total;
        }
        angles[station] = to;
        last = Some((station, to));
    }
    angles
}

#[cfg(test)]
mod tests {
    use super::{Rows, stations};
    use crate::{Cell, Leg, Stop, cell};
    use bead_program::program::Attitude;
    use glam::DVec3;
    use std::f64::consts::TAU;

    /// The stops of a vase 200 mm high: rings of 48 points, 0.4 mm apart, with a travel to each.
    fn vase() -> Vec<Stop> {
        let ring = |layer: usize| {
            let z = 0.4 * (layer + 1) as f64;
            let radius = 35.0 + 12.0 * (z / 30.0).sin();
            (0..=48).map(move |point| {
                let (y, x) = (TAU * point as f64 / 48.0).sin_cos();
                Stop {
                    layer,
                    pass: 0,
                    point,
                    at: DVec3::new(radius * x, radius * y, z),
                    seconds: 0.5,
                    arc: point > 0,
                    attitude: Attitude::default(),
                    leg: Leg::Part,
                }
            })
        };
        (0..500).flat_map(ring).collect()
    }

    /// Margins that neighbours share equal those that each has of its own, within what the constants promise.
    #[test]
    fn shared_margins_are_near_ones_own() -> Result<(), Box<dyn std::error::Error>> {
        let stops = vase();
        let stations = stations(&stops);
        for (name, _) in cell::BUILT_IN {
            let cell = Cell::built_in(name)?;
            let (arm, place, tool) = (cell.arm(), cell.part.base_from_part(), cell.flange_from_tool().inverse());
            let rows = |exact| Rows::new(&arm, &place, &tool, &stops, &stations, exact);
            let (own, shared) = (rows(usize::MAX), rows(0));
            assert!(shared.rows.len() * 2 < own.rows.len(), "{} of {}", shared.rows.len(), own.rows.len());
            let (mut worst, mut sum, mut count) = (0.0_f32, 0.0, 0);
            for station in 0..own.len() {
                let (a, b) = (&own.rows[own.of[station]], &shared.rows[shared.of[station]]);
                for (a, b) in a.iter().flatten().zip(b.iter().flatten()).filter(|(a, b)| **a > -900.0 && **b > -900.0) {
                    (worst, sum, count) = (worst.max((a - b).abs()), sum + (a - b).abs(), count + 1);
                }
            }
            println!("{name}: {worst}° at worst, {}° on average", sum / count as f32);
            assert!(sum / (count as f32) < 0.3, "{name}: {} on average", sum / count as f32);
        }
        Ok(())
    }
}
