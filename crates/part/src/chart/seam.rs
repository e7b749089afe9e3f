//! Islands that cross the seam, where a layer around an axis is unrolled: their halves are put together again, and each island is
//! kept once. What goes all around stays cut open, each layer elsewhere, so that no cut lies over another.

use super::Sheet;
use planar::{DVec2, Polygon, Region, Ring};
use std::f64::consts::{PI, TAU};

/// Points this close to the seam lie on it, mm.
const ON_SEAM: f64 = 2e-3;
/// By how much halves overlap, so that they become one, mm.
const OVERLAP: f64 = 1e-3;
/// Stretches of the seam that two halves share must be longer than this, mm.
const SHARED: f64 = 1e-2;

/// By how much of a turn the cut moves from one layer to the next: the golden section keeps it away from all that came before.
const ON: f64 = 0.618_034;

/// The islands of the layer with a number, put together across the seam, as they lie on the sheet of their layer. `cut` is the
/// sheet on which the mesh was cut.
pub fn joined(islands: Vec<Polygon>, number: usize, cut: &Sheet<'_>, layer: &Sheet<'_>) -> Vec<Polygon> {
    let islands = together(islands, TAU * (ON * number as f64).fract(), cut);
    if cut == layer { islands } else { islands.iter().map(|island| moved(island, |p| layer.across(p, cut))).collect() }
}

/// What goes all around is cut open `later` (rad) than at the seam.
fn together(islands: Vec<Polygon>, later: f64, sheet: &Sheet<'_>) -> Vec<Polygon> {
    let ends: Vec<[Vec<[f64; 2]>; 2]> =
        islands.iter().map(|island| [1.0, -1.0].map(|side| on_seam(island, side, sheet))).collect();
    let meeting = meeting(&ends);
    if meeting.is_empty() {
        return islands;
    }
    let turns = turns(islands.len(), &meeting);
    let mut joined: Vec<Polygon> = Vec::new();
    let mut groups: Vec<(usize, Vec<usize>)> = Vec::new();
    for (i, (group, _)) in turns.iter().enumerate() {
        match groups.iter_mut().find(|(known, _)| known == group) {
            Some((_, members)) => members.push(i),
            None => groups.push((*group, vec![i])),
        }
    }
    for (_, members) in groups {
        let around = members.iter().any(|&i| turns[i].1.is_none());
        match &members[..] {
            _ if around => {
                let all = Region::from_normalised(members.iter().map(|&i| islands[i].clone()).collect());
                joined.extend(cut_later(&all, later, sheet));
            }
            [alone] => joined.push(islands[*alone].clone()),
            _ => {
                let first = members.iter().filter_map(|&i| turns[i].1).min().unwrap_or(0);
                let united = members.iter().fold(Region::default(), |all, &i| {
                    let turn = f64::from(turns[i].1.unwrap_or(0) - first);
                    let further = moved(&islands[i], |p| sheet.over_seam(p, turn, ON_SEAM, OVERLAP));
                    all.union(&Region::from(further))
                });
                joined.extend(united.simplified(OVERLAP).into_polygons());
            }
        }
    }
    joined
}

/// A region that goes all around, cut open at another angle: what lies before it comes a turn later.
fn cut_later(region: &Region, later: f64, sheet: &Sheet<'_>) -> Vec<Polygon> {
    let Some(reach) = region.bounds().map(|bounds| bounds.min.length().max(bounds.max.length()) * 2.0) else {
        return Vec::new();
    };
    let part = |from: f64, to: f64| region.intersection(&Region::from(sheet.sector([from, to], reach)));
    let (before, after) = (part(-PI, later - PI), part(later - PI, PI));
    let further = |island: &Polygon| Region::from(moved(island, |p| sheet.over_seam(p, 1.0, ON_SEAM, OVERLAP)));
    let own = |island: &Polygon| Region::from(moved(island, |p| sheet.over_seam(p, 0.0, ON_SEAM, OVERLAP)));
    let pieces = before.polygons().iter().map(further).chain(after.polygons().iter().map(own));
    pieces.fold(Region::default(), |all, piece| all.union(&piece)).simplified(OVERLAP).into_polygons()
}

fn moved(island: &Polygon, to: impl Fn(DVec2) -> DVec2) -> Polygon {
    let ring = |ring: &Ring| Ring::new(ring.points().iter().map(|p| to(*p)).collect());
    Polygon { outer: ring(&island.outer), holes: island.holes.iter().map(ring).collect() }
}

/// The stretches of the seam at the end (side 1) or the beginning (-1) of a turn along which an island lies, from and to, mm.
fn on_seam(island: &Polygon, side: f64, sheet: &Sheet<'_>) -> Vec<[f64; 2]> {
    let place = |p: DVec2| sheet.on_seam(p, side * PI, ON_SEAM);
    let edge = |(a, b): (DVec2, DVec2)| Some([place(a)?, place(b)?]);
    let stretches = island.rings().flat_map(Ring::edges).filter_map(edge);
    stretches.map(|[a, b]| [a.min(b), a.max(b)]).filter(|[a, b]| b - a > SHARED).collect()
}

/// Pairs of islands of which the second continues the first, a turn further on.
fn meeting(ends: &[[Vec<[f64; 2]>; 2]]) -> Vec<[usize; 2]> {
    let share =
        |a: &[[f64; 2]], b: &[[f64; 2]]| a.iter().any(|a| b.iter().any(|b| a[1].min(b[1]) - a[0].max(b[0]) > SHARED));
    let pairs = (0..ends.len()).flat_map(|a| (0..ends.len()).map(move |b| [a, b]));
    pairs.filter(|[a, b]| share(&ends[*a][0], &ends[*b][1])).collect()
}

/// For each island its group and its turn in it; no turn in groups that go all around.
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
