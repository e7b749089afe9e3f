//! How a positioner or a table holds the part with the torch at a place of the plan.

use crate::view3d::Stance;
use beadwright::program::{Attitude, Held};
use beadwright::robot::{Pose, Stop};
use glam::DVec3;
use std::ops::RangeInclusive;

/// How much a millimetre along the pass counts compared with one sideways: it tells the end of a ring from its start.
const ALONG: f64 = 0.1;

/// How far the torch has come.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Come {
    /// A fraction of the way to the pass, 0 to 1.
    Towards(f64),
    /// Along the pass, mm.
    Along(f64),
}

/// A place of the torch on a pass, or on the way to it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// The layer, from 0.
    pub layer: usize,
    /// The pass in its layer, from 0.
    pub pass: usize,
    /// How far it has come.
    pub come: Come,
    /// The torch.
    pub torch: Stance,
}

/// The stops of a track, with the poses of the arm there.
type Poses = [(Stop, Option<Pose>)];

/// How the part is held with the torch at a place; `None` where nothing turns it.
pub fn held(poses: &Poses, place: &Place) -> Option<Held> {
    attitude(poses, place)?.held
}

/// The attitude of torch and part with the torch at a place.
pub fn attitude(poses: &Poses, place: &Place) -> Option<Attitude> {
    let Some(welds) = welds(poses, (place.layer, place.pass)) else {
        // Nothing is laid: the attitude is that after the pass before.
        let key = |stop: &Stop| (stop.layer, stop.pass);
        let before = poses.partition_point(|(stop, _)| key(stop) <= (place.layer, place.pass));
        return Some(poses.get(before.saturating_sub(1))?.0.attitude);
    };
    match place.come {
        Come::Towards(part) => on_way(poses, *welds.start(), part),
        Come::Along(laid) => along(&poses[welds.start().saturating_sub(1)..=*welds.end()], place.torch.at, laid),
    }
}

/// The stops at the ends of the welding moves of a pass.
fn welds(poses: &Poses, key: (usize, usize)) -> Option<RangeInclusive<usize>> {
    let begin = poses.partition_point(|(stop, _)| (stop.layer, stop.pass) < key);
    let end = poses.partition_point(|(stop, _)| (stop.layer, stop.pass) <= key);
    let arc = |i: &usize| poses[*i].0.arc;
    Some((begin..end).find(arc)?..=(begin..end).rfind(arc)?)
}

/// The attitude at a fraction `part` of the way from the weld before to the pass whose first weld goes to stop `first`.
fn on_way(poses: &Poses, first: usize, part: f64) -> Option<Attitude> {
    let start = poses[..first].iter().rposition(|(stop, _)| stop.arc).unwrap_or(0);
    let way = &poses[start..first];
    let length = |leg: &Poses| leg[0].0.at.distance(leg[1].0.at);
    let mut left = part.clamp(0.0, 1.0) * way.windows(2).map(length).sum::<f64>();
    for leg in way.windows(2) {
        let here = length(leg);
        if left < here {
            return Some(between(leg, left / here));
        }
        left -= here;
    }
    Some(way.last()?.0.attitude)
}

/// The attitude at the place of a pass nearest to a point, given that about `laid` mm of the pass are laid.
fn along(pass: &Poses, at: DVec3, laid: f64) -> Option<Attitude> {
    let mut before = 0.0;
    let near = pass.windows(2).map(|leg| {
        let (from, way) = (leg[0].0.at, leg[1].0.at - leg[0].0.at);
        let (length, begun) = (way.length(), before);
        before += length;
        let part = if length > 0.0 { ((at - from).dot(way) / (length * length)).clamp(0.0, 1.0) } else { 1.0 };
        let (beside, off) = ((from + way * part).distance(at), ALONG * (begun + part * length - laid));
        (beside.hypot(off), leg, part)
    });
    let nearest = near.min_by(|a, b| a.0.total_cmp(&b.0));
    nearest.map(|(_, leg, part)| between(leg, part)).or(Some(pass.last()?.0.attitude))
}

fn between(leg: &Poses, part: f64) -> Attitude {
    leg[0].0.attitude.towards(&leg[1].0.attitude, part)
}
