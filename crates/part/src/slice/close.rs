//! Closes open contours of a broken mesh: ends within the gap are joined, nearest pair first.

use glam::DVec2;
use planar::Ring;
use rstar::RTree;
use rstar::primitives::GeomWithData;

/// Candidates examined around one end.
const NEAREST: usize = 8;

/// An end of a chain: its index and whether it is the last point.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct End {
    chain: usize,
    last: bool,
}

/// Joins open chains into rings, and returns the chains still open. `report` is called for each gap, with its position
/// and width, mm.
pub(super) fn close(
    chains: Vec<Vec<DVec2>>,
    gap: f64,
    rings: &mut Vec<Ring>,
    mut report: impl FnMut(DVec2, f64),
) -> Vec<Vec<DVec2>> {
    let mut partner: Vec<[Option<End>; 2]> = vec![[None; 2]; chains.len()];
    for (distance, a, b) in candidate_pairs(&chains, gap) {
        let free = |e: End| partner[e.chain][usize::from(e.last)].is_none();
        if free(a) && free(b) {
            partner[a.chain][usize::from(a.last)] = Some(b);
            partner[b.chain][usize::from(b.last)] = Some(a);
            if distance > 1e-3 {
                report(point(&chains, a), distance);
            }
        }
    }
    let (mut used, mut open) = (vec![false; chains.len()], Vec::new());
    // Chains with a loose end first, because they cannot become rings.
    let loose = |i: &usize| partner[*i].iter().any(Option::is_none);
    for start in (0..chains.len()).filter(loose) {
        if !used[start] {
            let enter = End { chain: start, last: partner[start][0].is_some() };
            open.push(follow(&chains, &partner, enter, &mut used));
        }
    }
    for start in 0..chains.len() {
        if !used[start] {
            let points = follow(&chains, &partner, End { chain: start, last: false }, &mut used);
            rings.push(Ring::new(points));
        }
    }
    open
}

fn point(chains: &[Vec<DVec2>], end: End) -> DVec2 {
    let chain = &chains[end.chain];
    chain[if end.last { chain.len() - 1 } else { 0 }]
}

/// Pairs of ends within the gap, nearest first; at the same distance an end precedes a start, as the winding requires.
fn candidate_pairs(chains: &[Vec<DVec2>], gap: f64) -> Vec<(f64, End, End)> {
    let ends = (0..chains.len()).flat_map(|chain| [false, true].map(|last| End { chain, last }));
    let items: Vec<_> = ends.map(|e| GeomWithData::new(point(chains, e).to_array(), e)).collect();
    let tree = RTree::bulk_load(items.clone());
    let mut pairs: Vec<(f64, End, End)> = Vec::new();
    for item in &items {
        let near = tree.nearest_neighbor_iter_with_distance_2(item.geom());
        let near = near.filter(|(other, _)| other.data != item.data).take(NEAREST);
        for (other, distance_squared) in near.take_while(|(_, d)| *d <= gap * gap) {
            pairs.push((distance_squared.sqrt(), item.data.min(other.data), item.data.max(other.data)));
        }
    }
    let against = |a: End, b: End| u8::from(a.last == b.last);
    pairs.sort_by(|x, y| {
        x.0.total_cmp(&y.0).then(against(x.1, x.2).cmp(&against(y.1, y.2))).then((x.1, x.2).cmp(&(y.1, y.2)))
    });
    pairs.dedup();
    pairs
}

/// Walks from chain to chain, entering the first at `enter`, until a loose end or a used chain.
fn follow(chains: &[Vec<DVec2>], partner: &[[Option<End>; 2]], enter: End, used: &mut [bool]) -> Vec<DVec2> {
    let mut points = Vec::new();
    let mut at = Some(enter);
    while let Some(end) = at {
        if std::mem::replace(&mut used[end.chain], true) {
            break;
        }
        let chain = chains[end.chain].iter().copied();
        if end.last {
            points.extend(chain.rev())
        } else {
            points.extend(chain)
        }
        at = partner[end.chain][usize::from(!end.last)];
    }
    points
}
