//! Order of passes: nothing is lost or changed but its start, and the torch travels less.

use crate::solids;

use beadwright::fill::{Fill, FillSettings, Path, StrategyName};

use beadwright::order::{Balance, Memory, OrderSettings, Seam, order};
use beadwright::pass::Along;
use beadwright::pass::PassKind;
use beadwright::planar::{DVec2, Polygon, Ring};
use beadwright::profile::Profile;
use proptest::prelude::*;
use solids::runner;
use std::sync::LazyLock;

fn open(points: &[(f64, f64)], reversible: bool) -> Path {
    let points = points.iter().map(|&(x, y)| DVec2::new(x, y)).collect();
    Path { kind: PassKind::Infill, closed: false, points, width: Along::Same(5.0), reversible }
}

fn closed(points: &[(f64, f64)]) -> Path {
    Path { kind: PassKind::Contour, closed: true, ..open(points, true) }
}

fn end(pass: &Path) -> DVec2 {
    if pass.closed { pass.points[0] } else { *pass.points.last().unwrap() }
}

/// Length of the moves without arc, mm.
fn travel<'a>(passes: impl IntoIterator<Item = &'a Path>, mut torch: DVec2) -> f64 {
    let mut length = 0.0;
    for pass in passes {
        length += torch.distance(pass.points[0]);
        torch = end(pass);
    }
    length
}

fn between(point: DVec2, (a, b): (DVec2, DVec2)) -> bool {
    a.distance(point) + point.distance(b) - a.distance(b) < 1e-9
}

/// Whether `laid` is `pass` as it may be laid.
fn same(laid: &Path, pass: &Path) -> bool {
    let mut points = pass.points.clone();
    let turned = if pass.closed {
        // It may begin in the middle of an edge.
        let new = laid.points.len() > points.len();
        (0..points.len()).any(|_| {
            points.rotate_left(1);
            let edge = (points[points.len() - 1], points[0]);
            points == laid.points[usize::from(new)..] && (!new || between(laid.points[0], edge))
        })
    } else {
        points.reverse();
        pass.reversible && points == laid.points
    };
    let rest = |p: &Path| (p.kind, p.closed, p.reversible);
    rest(laid) == rest(pass) && (laid.points == pass.points || turned)
}

/// Orders the islands and returns, for each pass laid, its island and stage. Every pass must come once.
fn check(islands: &[Fill], torch: Option<DVec2>) -> (Vec<Path>, Vec<(usize, usize)>) {
    let mut at = torch;
    let laid = order(islands.to_vec(), &OrderSettings::default(), &mut at);
    assert_eq!(at, laid.last().map(end).or(torch), "the torch ends where the last pass ends");
    let mut left: Vec<(usize, usize, &Path)> = Vec::new();
    for (i, fill) in islands.iter().enumerate() {
        left.extend(fill.stages.iter().enumerate().flat_map(|(s, stage)| stage.iter().map(move |p| (i, s, p))));
    }
    let mut from = Vec::new();
    for pass in &laid {
        let k = left.iter().position(|(_, _, p)| same(pass, p)).expect("laid, but not among the passes or twice");
        let (island, stage, _) = left.remove(k);
        from.push((island, stage));
    }
    assert!(left.is_empty(), "never laid: {left:?}");
    let ends = from.chunk_by(|a, b| a.0 == b.0).map(|chunk| chunk[0].0).collect::<Vec<_>>();
    let mut once = ends.clone();
    once.sort_unstable();
    once.dedup();
    assert_eq!(once.len(), ends.len(), "an island is finished before the next begins");
    assert!(from.chunk_by(|a, b| a.0 == b.0).all(|chunk| chunk.is_sorted()), "stages in their order");
    (laid, from)
}

fn settings() -> FillSettings<'static> {
    static PROFILE: LazyLock<Profile> = LazyLock::new(|| Profile::built_in("cmt-al2319-kuka").unwrap());
    PROFILE.fill_settings(0)
}

fn square(x: f64, y: f64, side: f64) -> Polygon {
    let ring = |s: f64, d: f64| [(d, d), (s - d, d), (s - d, s - d), (d, s - d)].map(|(u, v)| DVec2::new(x + u, y + v));
    let hole = Ring::new(ring(side, side / 3.0).to_vec()).reversed();
    Polygon { outer: Ring::new(ring(side, 0.0).to_vec()), holes: vec![hole] }
}

#[test]
fn every_pass_of_every_strategy_comes_out_once() {
    for name in StrategyName::ALL {
        let islands: Vec<Fill> = [square(0.0, 0.0, 60.0), square(200.0, 10.0, 90.0), square(80.0, 0.0, 70.0)]
            .iter()
            .map(|island| name.strategy().fill(island, &settings()))
            .collect();
        let (laid, from) = check(&islands, None);
        assert!(laid.len() >= 3, "{name}");
        // From the origin the islands lie one behind the other.
        assert!([0, 2, 1].iter().eq(from.chunk_by(|a, b| a.0 == b.0).map(|c| &c[0].0)), "{name}");
    }
}

#[test]
fn nothing_gives_nothing_and_leaves_the_torch() {
    let torch = Some(DVec2::new(3.0, 4.0));
    assert_eq!(check(&[], torch).0, []);
    assert_eq!(check(&[Fill::default(), Fill { stages: vec![vec![], vec![]], fixed_order: false }], torch).0, []);
}

#[test]
fn an_open_pass_begins_at_its_nearer_end() {
    let line = [(0.0, 0.0), (5.0, 1.0), (10.0, 0.0)];
    let fill = |reversible| [Fill { stages: vec![vec![open(&line, reversible)]], fixed_order: false }];
    let torch = Some(DVec2::new(12.0, 0.0));
    assert_eq!(check(&fill(true), torch).0[0].points[0], DVec2::new(10.0, 0.0));
    assert_eq!(check(&fill(false), torch).0[0].points[0], DVec2::ZERO, "not reversible");
    assert_eq!(check(&fill(true), None).0[0].points[0], DVec2::ZERO);
}

#[test]
fn a_closed_pass_begins_at_its_nearest_point() {
    let ring = closed(&[(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0)]);
    let fill = [Fill { stages: vec![vec![ring]], fixed_order: false }];
    for (torch, start) in [((11.0, 9.0), (10.0, 9.0)), ((-1.0, 12.0), (0.0, 10.0)), ((6.0, -3.0), (6.0, 0.0))] {
        let laid = check(&fill, Some(torch.into())).0;
        assert_eq!(laid[0].points[0], start.into());
        assert!(Ring::new(laid[0].points.clone()).area() > 0.0, "the direction stays");
    }
}

#[test]
fn the_nearest_pass_comes_next() {
    let at = |x: f64| open(&[(x, 0.0), (x, 5.0)], true);
    let fill = [Fill { stages: vec![vec![at(30.0), at(10.0), at(20.0), at(0.0)]], fixed_order: false }];
    let laid = check(&fill, None).0;
    assert_eq!(laid.iter().map(|p| p.points[0].x).collect::<Vec<_>>(), [0.0, 10.0, 20.0, 30.0]);
    assert_eq!(laid.iter().map(|p| p.points[0].y).collect::<Vec<_>>(), [0.0, 5.0, 0.0, 5.0]);
}

#[test]
fn a_fixed_order_is_kept_with_its_directions() {
    let at = |x: f64| open(&[(x, 0.0), (x, 5.0)], true);
    let stages = vec![vec![at(30.0), at(10.0), at(20.0)], vec![at(0.0), closed(&[(1.0, 0.0), (2.0, 0.0), (2.0, 3.0)])]];
    let fill = Fill { stages: stages.clone(), fixed_order: true };
    assert_eq!(check(&[fill], Some(DVec2::new(20.0, 9.0))).0, stages.concat());
}

/// Passes of 2 to 6 points within 100 mm.
fn random_pass() -> impl Strategy<Value = Path> {
    let points = prop::collection::vec((0.0..100.0, 0.0..100.0), 2..7);
    (points, any::<bool>(), any::<bool>()).prop_map(|(points, ring, reversible)| {
        if ring && points.len() > 2 { closed(&points) } else { open(&points, reversible) }
    })
}

#[test]
fn random_passes_come_out_once_and_stages_stay_in_order() {
    let stage = || prop::collection::vec(random_pass(), 0..6);
    let fill = (prop::collection::vec(stage(), 0..4), any::<bool>());
    let fill = fill.prop_map(|(stages, fixed_order)| Fill { stages, fixed_order });
    runner(300)
        .run(&(prop::collection::vec(fill, 0..5), any::<bool>()), |(islands, placed)| {
            check(&islands, placed.then_some(DVec2::new(50.0, 50.0)));
            Ok(())
        })
        .unwrap();
}

#[test]
fn travel_is_not_longer_than_in_the_order_of_the_input() {
    runner(300)
        .run(&prop::collection::vec(random_pass(), 15..40), |passes| {
            let before = travel(&passes, DVec2::ZERO);
            let (laid, _) = check(&[Fill { stages: vec![passes], fixed_order: false }], None);
            let after = travel(&laid, DVec2::ZERO);
            prop_assert!(after <= before, "{after} mm for {before} mm");
            Ok(())
        })
        .unwrap();
}

/// Starts of a ring of 120 mm on successive layers, as lengths along it from the rear.
fn seams(seam: Seam, fixed_order: bool, layers: usize) -> Vec<f64> {
    let ring = closed(&[(0.0, 0.0), (30.0, 0.0), (30.0, 30.0), (0.0, 30.0)]);
    let fill = Fill { stages: vec![vec![ring.clone()]], fixed_order };
    let start = |layer: usize| {
        let settings = OrderSettings { seam, layer, bead_width: 5.0, ..OrderSettings::default() };
        let laid = order(vec![fill.clone()], &settings, &mut Some(DVec2::new(7.0, -9.0)));
        assert!(same(&laid[0], &ring), "{laid:?}");
        let path = Path {
            points: vec![(0.0, 30.0).into(), (0.0, 0.0).into(), (30.0, 0.0).into(), (30.0, 30.0).into()],
            ..ring.clone()
        }
        .path();
        let at = |k: u32| beadwright::planar::polyline::point_at(&path, f64::from(k) * 0.01).unwrap();
        let near = (0..12_000)
            .min_by(|&a, &b| at(a).distance(laid[0].points[0]).total_cmp(&at(b).distance(laid[0].points[0])));
        f64::from(near.unwrap()) * 0.01
    };
    (0..layers).map(start).collect()
}

#[test]
fn seams_lie_where_they_are_wanted() {
    for fixed_order in [false, true] {
        let aligned = seams(Seam::Aligned, fixed_order, 4);
        assert!(aligned.iter().all(|&at| at == aligned[0]), "{aligned:?}");
        let rotated = seams(Seam::Rotate, fixed_order, 8);
        assert!(rotated.windows(2).all(|w| ((w[1] - w[0]).rem_euclid(120.0) - 10.0).abs() < 0.02), "{rotated:?}");
        // Of eight layers, no two begin nearer than a twentieth of the way round.
        let spread = seams(Seam::Spread, fixed_order, 8);
        for (i, a) in spread.iter().enumerate() {
            let gap = |b: &f64| (a - b).abs().min(120.0 - (a - b).abs());
            assert!(spread[..i].iter().all(|b| gap(b) > 6.0), "{spread:?}");
        }
    }
    assert_eq!(seams(Seam::Nearest, false, 2), [37.0, 37.0], "below the torch at x 7");
}

/// Where a pass begins, and which way it goes on.
fn way(pass: &Path) -> [DVec2; 2] {
    [pass.points[0], pass.points[1]]
}

#[test]
fn passes_alternate_from_layer_to_layer() {
    let mut ring = closed(&[(0.0, 0.0), (30.0, 0.0), (30.0, 30.0), (0.0, 30.0)]);
    ring.width = Along::Each(vec![1.0, 2.0, 3.0, 4.0]);
    let mut line = open(&[(90.0, 5.0), (70.0, 0.0), (50.0, 0.0)], true);
    line.width = Along::Each(vec![5.0, 6.0, 7.0]);
    let upright = open(&[(100.0, 0.0), (100.0, 20.0)], true);
    let fixed = open(&[(140.0, 0.0), (120.0, 0.0)], false);
    for fixed_order in [false, true] {
        let passes = vec![ring.clone(), line.clone(), upright.clone(), fixed.clone()];
        let fill = Fill { stages: vec![passes], fixed_order };
        let laid = |layer: usize| {
            let settings = OrderSettings { seam: Seam::Aligned, alternate: true, layer, ..OrderSettings::default() };
            order(vec![fill.clone()], &settings, &mut Some(DVec2::new(7.0, -9.0)))
        };
        let find = |laid: &[Path], x: f64| laid.iter().find(|p| p.points.iter().any(|q| q.x == x)).unwrap().clone();
        for layer in 0..4 {
            let (laid, odd) = (laid(layer), layer % 2 == 1);
            let ring = find(&laid, 30.0);
            // Of the rearmost points the last one begins.
            let expected = if odd { [(0.0, 30.0), (30.0, 30.0)] } else { [(0.0, 30.0), (0.0, 0.0)] };
            assert_eq!(way(&ring), expected.map(DVec2::from));
            // Every piece keeps its width: that from (0, 0) to (30, 0) has 1.
            let Along::Each(widths) = &ring.width else { panic!("{ring:?}") };
            assert_eq!(widths[..], if odd { [3.0, 2.0, 1.0, 4.0] } else { [4.0, 1.0, 2.0, 3.0] });
            let (line, upright, fixed) = (find(&laid, 70.0), find(&laid, 100.0), find(&laid, 120.0));
            assert_eq!(line.points[0].x, if odd { 90.0 } else { 50.0 });
            assert_eq!(line.width.after(0), if odd { 5.0 } else { 6.0 });
            assert_eq!(upright.points[0].y, if odd { 20.0 } else { 0.0 });
            assert_eq!(fixed.points[0].x, 140.0, "what may not be turned is not");
        }
    }
}

#[test]
fn seams_that_wander_do_so_on_alternating_layers_too() {
    let ring = closed(&[(0.0, 0.0), (30.0, 0.0), (30.0, 30.0), (0.0, 30.0)]);
    let start = |alternate: bool, layer: usize| {
        let settings =
            OrderSettings { seam: Seam::Rotate, alternate, layer, bead_width: 5.0, ..OrderSettings::default() };
        let fill = Fill { stages: vec![vec![ring.clone()]], fixed_order: false };
        order(vec![fill], &settings, &mut None)[0].points[0]
    };
    (0..6).for_each(|layer| assert_eq!(start(true, layer), start(false, layer)));
}

/// Two kinds of layers take turns, with seams of each kind: what is remembered must not show.
#[test]
fn remembered_layers_are_laid_as_if_each_were_new() {
    let ring = |x: f64, y: f64| closed(&[(x, y), (x + 6.0, y), (x + 6.0, y + 4.0), (x, y + 4.0)]);
    let layer = |lean: f64| {
        let rings = (0..7).map(|k| ring(f64::from(k * 5 % 7) * 10.0, f64::from(k) * lean)).collect();
        let lines =
            (0..6).map(|k| open(&[(lean, f64::from(k) * 3.0), (40.0, f64::from(k) * 3.0 + lean)], true)).collect();
        vec![Fill { stages: vec![rings, lines], fixed_order: false }]
    };
    for (seam, alternate) in
        [(Seam::Nearest, false), (Seam::Aligned, false), (Seam::Rotate, false), (Seam::Nearest, true)]
    {
        let (mut memory, mut fresh) = (Memory::default(), Memory::default());
        let (mut torch, mut alone) = (None, None);
        for index in 0..14 {
            let settings = OrderSettings { seam, alternate, layer: index, bead_width: 3.0, ..OrderSettings::default() };
            let fills = || layer(if index % 2 == 0 { 8.0 } else { 3.0 });
            let laid = memory.order(fills(), true, &settings, &mut torch);
            let again = fresh.order(fills(), false, &settings, &mut alone);
            assert_eq!(laid, again, "layer {index}, {seam:?}, alternate {alternate}");
            assert_eq!(torch, alone);
        }
    }
}

/// Rings of many sizes beside lines that begin at the same place on every layer, at several turns.
#[test]
fn no_closed_pass_begins_within_half_a_bead_of_a_start_of_the_five_layers_below() {
    let width = 3.0;
    for turn in [0.0, 0.3, 1.2, 2.5] {
        let turned = |(x, y): (f64, f64)| DVec2::from_angle(turn).rotate(DVec2::new(x, y));
        let pass = |corners: &[(f64, f64)], closed| Path {
            kind: PassKind::Contour,
            closed,
            points: corners.iter().copied().map(turned).collect(),
            width: Along::Same(width),
            reversible: true,
        };
        let ring = |x: f64, side: f64| pass(&[(x, 0.0), (x + side, 0.0), (x + side, side), (x, side)], true);
        let fill = || {
            let rings = (1..6).map(|k| ring(f64::from(k) * 25.0, f64::from(k) * 4.0)).collect();
            let lines = vec![pass(&[(25.0, 0.0), (29.0, -9.0)], false)];
            vec![Fill { stages: vec![rings, lines], fixed_order: false }]
        };
        let length = |passes: &[Path]| passes.iter().map(Path::length).sum::<f64>();
        let whole: f64 = fill().iter().flat_map(|fill| &fill.stages).map(|stage| length(stage)).sum();
        for seam in [Seam::Nearest, Seam::Spread, Seam::Rotate] {
            let (mut memory, mut torch, mut below) = (Memory::default(), None, Vec::<Vec<DVec2>>::new());
            for layer in 0..20 {
                let settings = OrderSettings { seam, layer, bead_width: width, ..OrderSettings::default() };
                let laid = memory.order(fill(), true, &settings, &mut torch);
                assert!((length(&laid) - whole).abs() < 1e-9);
                for pass in laid.iter().filter(|pass| pass.closed) {
                    let near = below.iter().rev().take(5).flatten().map(|start| start.distance(pass.points[0]));
                    let near = near.fold(f64::INFINITY, f64::min);
                    assert!(near >= 0.5 * width - 1e-9, "turned {turn}, {seam:?}, layer {layer}: {near} mm");
                }
                below.push(laid.iter().map(|pass| pass.points[0]).collect());
            }
        }
    }
}

/// Mean distance of the middle of heat from the origin, mm, where heat fades over `fading` mm of bead: summed up mm by mm.
fn heat_apart(passes: &[Path], fading: f64) -> f64 {
    let (mut moment, mut sum, mut steps) = (DVec2::ZERO, 0.0, 0.0);
    for pass in passes {
        let path = pass.path();
        for mm in 0..pass.length() as usize {
            let place = beadwright::planar::polyline::point_at(&path, mm as f64 + 0.5).unwrap();
            moment = moment * (-1.0 / fading).exp() + place;
            sum += moment.length() / fading;
            steps += 1.0;
        }
    }
    sum / steps
}

/// Islands at random places: heat lies nearer to the middle than in the usual order, travels stay within bounds, and every pass is
/// laid once.
#[test]
fn balanced_orders_keep_heat_in_the_middle_within_their_travels() {
    let cases = prop::collection::vec((-90.0..90.0, -90.0..90.0, 4.0..30.0, any::<bool>(), any::<bool>()), 1..9);
    let gained = std::cell::RefCell::new(Vec::new());
    let check = |islands: Vec<(f64, f64, f64, bool, bool)>| {
        let island = |&(x, y, side, ring, reversible): &(f64, f64, f64, bool, bool)| {
            let square = closed(&[(x, y), (x + side, y), (x + side, y + side), (x, y + side)]);
            let line = |k: f64| open(&[(x, y + k), (x + side, y + k)], reversible);
            let stages =
                if ring { vec![vec![square]] } else { vec![vec![square], vec![line(2.0), line(4.0), line(6.0)]] };
            Fill { stages, fixed_order: false }
        };
        let islands: Vec<Fill> = islands.iter().map(island).collect();
        let balance = Balance { middle: DVec2::ZERO, fading: 300.0, detour: 0.8 };
        let settings = OrderSettings { balance: Some(balance), ..OrderSettings::default() };
        let usual = order(islands.clone(), &settings, &mut None);
        let (mut memory, mut torch) = (Memory::default(), None);
        let laid = memory.order(islands.clone(), false, &settings, &mut torch);
        assert_eq!(torch, laid.last().map(end));
        let mut left: Vec<&Path> = islands.iter().flat_map(|fill| &fill.stages).flatten().collect();
        for pass in &laid {
            let found = left.iter().position(|p| same(pass, p)).expect("laid, but not among the passes or twice");
            left.remove(found);
        }
        assert!(left.is_empty());
        let length: f64 = usual.iter().map(Path::length).sum();
        let longest = travel(&usual, DVec2::ZERO) + balance.detour * length;
        assert!(travel(&laid, DVec2::ZERO) < longest + 1e-6);
        let (before, after) = (heat_apart(&usual, balance.fading), heat_apart(&laid, balance.fading));
        assert!(after < before + 0.5, "{before} {after}");
        gained.borrow_mut().push([before, after]);
        Ok(())
    };
    runner(60).run(&cases, check).unwrap();
    let [before, after] = [0, 1].map(|k| gained.borrow().iter().map(|pair| pair[k]).sum::<f64>());
    println!("heat lies {:.1} mm instead of {:.1} mm from the middle", after / 60.0, before / 60.0);
    assert!(after < 0.9 * before);
}
