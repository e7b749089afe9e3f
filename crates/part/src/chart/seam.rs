//! Islands that cross the seam, where a layer around an axis is unrolled: their halves are joined again, and each
//! island is kept once. A ring all the way around stays cut open, at a different angle in each layer, so that no cut
//! lies over another. On a cone, where a second turn would overlap the first, islands end at the seam.

use super::Sheet;
use planar::{DVec2, Polygon, Region, Ring};
use std::collections::BTreeMap;
use std::f64::consts::{PI, TAU};

/// Points this close to the seam count as on it, mm.
const ON_SEAM: f64 = 2e-3;
/// Halves overlap by this to become one, mm.
const OVERLAP: f64 = 1e-3;
/// Two halves must share more than this length of the seam, mm.
const SHARED: f64 = 1e-2;

/// The cut moves by this fraction of a turn from layer to layer: the golden ratio keeps it away from all earlier cuts.
const ON: f64 = 0.618_034;

/// The islands of the layer with this number, joined across the seam, in the coordinates of `layer`. `cut` is the sheet
/// on which the mesh was cut.
pub fn joined(islands: Vec<Polygon>, number: usize, cut: &Sheet<'_>, layer: &Sheet<'_>) -> Vec<Polygon> {
    let islands = together(islands, TAU * (ON * number as f64).fract(), cut);
    if cut == layer { islands } else { islands.iter().map(|island| island.moved(|p| layer.across(p, cut))).collect() }
}

/// Joins islands across the seam; a ring all the way around is cut open at `later` (rad) past the seam.
fn together(islands: Vec<Polygon>, later: f64, sheet: &Sheet<'_>) -> Vec<Polygon> {
    if !sheet.goes_on() {
        return islands;
    }
    let ends: Vec<[Vec<[f64; 2]>; 2]> =
        islands.iter().map(|island| [1.0, -1.0].map(|side| on_seam(island, side, sheet))).collect();
    let meeting = meeting(&ends);
    if meeting.is_empty() {
        return islands;
    }
    let mut groups: BTreeMap<usize, Vec<(usize, Option<i32>)>> = BTreeMap::new();
    for (i, (group, turn)) in turns(islands.len(), &meeting).into_iter().enumerate() {
        groups.entry(group).or_default().push((i, turn));
    }
    let of_group = |members: &Vec<(usize, Option<i32>)>| match members[..] {
        _ if members.iter().any(|(_, turn)| turn.is_none()) => {
            let all = members.iter().map(|(i, _)| islands[*i].clone()).collect();
            cut_later(&Region::from_normalised(all), later, sheet)
        }
        [(alone, _)] => vec![islands[alone].clone()],
        _ => united(members.iter().map(|(i, turn)| (&islands[*i], turn.unwrap_or(0))), sheet),
    };
    groups.values().flat_map(of_group).collect()
}

/// Unites islands, each moved on by its number of turns, into one that begins within the first turn.
fn united<'a>(members: impl Iterator<Item = (&'a Polygon, i32)> + Clone, sheet: &Sheet<'_>) -> Vec<Polygon> {
    let first = members.clone().map(|(_, turn)| turn).min().unwrap_or(0);
    let further = |(island, turn): (&Polygon, i32)| {
        let turns = f64::from(turn - first);
        Region::from(island.moved(|p| sheet.over_seam(p, turns, ON_SEAM, OVERLAP)))
    };
    members.map(further).fold(Region::default(), |all, part| all.union(&part)).simplified(OVERLAP).into_polygons()
}

/// A region that goes all the way around, cut open at another angle: the part before that angle moves to the next turn.
fn cut_later(region: &Region, later: f64, sheet: &Sheet<'_>) -> Vec<Polygon> {
    let Some(reach) = region.bounds().map(|bounds| bounds.min.length().max(bounds.max.length()) * 2.0) else {
        return Vec::new();
    };
    let part = |from: f64, to: f64| region.intersection(&Region::from(sheet.sector([from, to], reach)));
    let (before, after) = (part(-PI, later - PI), part(later - PI, PI));
    let further = |island: &Polygon| Region::from(island.moved(|p| sheet.over_seam(p, 1.0, ON_SEAM, OVERLAP)));
    let own = |island: &Polygon| Region::from(island.moved(|p| sheet.over_seam(p, 0.0, ON_SEAM, OVERLAP)));
    let pieces = before.polygons().iter().map(further).chain(after.polygons().iter().map(own));
    pieces.fold(Region::default(), |all, piece| all.union(&piece)).simplified(OVERLAP).into_polygons()
}

/// The intervals of the seam, mm, along which an island lies, at the end (side 1) or the beginning (-1) of a turn.
fn on_seam(island: &Polygon, side: f64, sheet: &Sheet<'_>) -> Vec<[f64; 2]> {
    let place = |p: DVec2| sheet.on_seam(p, side * PI, ON_SEAM);
    let edge = |(a, b): (DVec2, DVec2)| Some([place(a)?, place(b)?]);
    let stretches = island.rings().flat_map(Ring::edges).filter_map(edge);
    stretches.map(|[a, b]| [a.min(b), a.max(b)]).filter(|[a, b]| b - a > SHARED).collect()
}

/// Pairs of islands where the second continues the first into the next turn.
fn meeting(ends: &[[Vec<[f64; 2]>; 2]]) -> Vec<[usize; 2]> {
    let share =
        |a: &[[f64; 2]], b: &[[f64; 2]]| a.iter().any(|a| b.iter().any(|b| a[1].min(b[1]) - a[0].max(b[0]) > SHARED));
    let pairs = (0..ends.len()).flat_map(|a| (0..ends.len()).map(move |b| [a, b]));
    pairs.filter(|[a, b]| share(&ends[*a][0], &ends[*b][1])).collect()
}

/// For each island its group and its turn within it; no turn in groups that go all the way around.
fn turns(count: usize, meeting: &[[usize; 2]]) -> Vec<(usize, Option<i32>)> {
    let mut turns: Vec<Option<(usize, i32)>> = vec![None; count];
    let mut around = vec![false; count];
    for start in 0..count {
        if turns[start].is_some() {
            continue;
        }
        turns[start] = Some((start, 0));
        let mut next = vec![start];
        while let Some(at) = next.pop() {
            let Some((group, turn)) = turns[at] else { continue };
            for &[a, b] in meeting.iter().filter(|pair| pair.contains(&at)) {
                let (other, turn) = if a == at { (b, turn + 1) } else { (a, turn - 1) };
                match turns[other] {
                    None => {
                        turns[other] = Some((group, turn));
                        next.push(other);
                    }
                    Some((_, known)) if known != turn => around[group] = true,
                    Some(_) => {}
                }
            }
        }
    }
    let known = |(i, turn): (usize, Option<(usize, i32)>)| {
        let (group, turn) = turn.unwrap_or((i, 0));
        (group, (!around[group]).then_some(turn))
    };
    turns.into_iter().enumerate().map(known).collect()
}
