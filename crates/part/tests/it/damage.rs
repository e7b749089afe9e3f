//! What a scan of a damaged part lacks, and the metal for it.

use bead_part::chart::Chart;
use bead_part::damage::{Damage, DamageError, Movement, Reason, Repair, Settings, moved, repair};
use bead_part::model::Mesh;
use bead_part::task::Task;
use glam::{DQuat, DVec2, DVec3};

const SIZE: DVec2 = DVec2::new(160.0, 110.0);
const TOP: f64 = 40.0;
const SETTINGS: Settings =
    Settings { up: None, step: 2.0, tolerance: 0.5, allowance: 2.0, layer: 2.0, bead: 6.0, sides: 45.0 };

/// A block on z = 0 whose top has these heights, mm, on a grid.
fn block(step: f64, height: impl Fn(DVec2) -> f64) -> Mesh {
    let [columns, rows] = [SIZE.x, SIZE.y].map(|size| (size / step).round() as usize + 1);
    let place = |k: usize| DVec2::new((k % columns) as f64, (k / columns) as f64) * step;
    let count = columns * rows;
    let tops = (0..count).map(|k| place(k).extend(height(place(k))));
    let vertices: Vec<DVec3> = tops.chain((0..count).map(|k| place(k).extend(0.0))).collect();
    let mut triangles = Vec::new();
    let mut quad = |[a, b, c, d]: [usize; 4]| {
        triangles.extend([[a, b, c], [a, c, d]].map(|corners| corners.map(|corner| corner as u32)));
    };
    for k in 0..count - columns {
        if k % columns + 1 < columns {
            quad([k, k + 1, k + columns + 1, k + columns]);
            quad([k, k + columns, k + columns + 1, k + 1].map(|corner| corner + count));
        }
    }
    let mut rim: Vec<usize> = (0..columns).collect();
    rim.extend((1..rows).map(|row| row * columns + columns - 1));
    rim.extend((0..columns - 1).rev().map(|column| (rows - 1) * columns + column));
    rim.extend((1..rows - 1).rev().map(|row| row * columns));
    for k in 0..rim.len() {
        let (a, b) = (rim[k], rim[(k + 1) % rim.len()]);
        quad([a + count, b + count, b, a]);
    }
    let (mesh, report) = Mesh::from_triangles(vertices, triangles);
    assert_eq!((report.open_edges, report.flipped), (0, 0));
    mesh
}

fn turned(mesh: &Mesh, turn: DQuat) -> Mesh {
    Mesh { vertices: mesh.vertices.iter().map(|p| turn * *p).collect(), ..mesh.clone() }
}

/// Five ways in which the top of a block is damaged: its height, mm.
fn damaged(kind: usize, p: DVec2) -> f64 {
    let DVec2 { x, y } = p;
    let low = match kind {
        // A worn dish, 3 mm deep.
        0 => TOP - 3.0 * (1.0 - ((x - 80.0) / 40.0).powi(2) - ((y - 55.0) / 30.0).powi(2)).max(0.0),
        // A crack, 3 mm wide and 7 deep.
        1 if (x - 80.0).abs() < 1.6 && (y - 55.0).abs() < 25.0 => TOP - 7.0,
        // A bore, 24 mm wide and 6 deep.
        2 if p.distance(DVec2::new(70.0, 60.0)) < 12.0 => TOP - 6.0,
        // A corner that is broken off.
        3 => TOP - 18.0 + 0.4 * ((SIZE.x - x) + y),
        // A worn edge.
        4 => TOP - 5.0 + 0.2 * y,
        _ => TOP,
    };
    low.min(TOP)
}

/// Where a line through a place along z enters a mesh first and leaves it last, mm.
fn column(mesh: &Mesh, p: DVec2) -> Option<[f64; 2]> {
    let mut span: Option<[f64; 2]> = None;
    for corners in &mesh.triangles {
        let [a, b, c] = corners.map(|corner| mesh.vertices[corner as usize]);
        let [q, r, s] = [a, b, c].map(|corner| corner.truncate());
        let area = (r - q).perp_dot(s - q);
        let parts = [(r - p).perp_dot(s - p), (s - p).perp_dot(q - p), (q - p).perp_dot(r - p)].map(|part| part / area);
        if area.abs() > 1e-9 && parts.iter().all(|part| *part >= -1e-9) {
            let z = parts[0] * a.z + parts[1] * b.z + parts[2] * c.z;
            span = Some(span.map_or([z, z], |[low, high]| [low.min(z), high.max(z)]));
        }
    }
    span
}

fn found(part: &Mesh, scan: &Mesh) -> Repair {
    repair(part, scan, SETTINGS, &Task::new()).unwrap()
}

fn only(repair: &Repair) -> &Damage {
    assert!(repair.left.is_empty(), "{:?}", repair.left);
    let [damage] = &repair.damages[..] else { panic!("{} places", repair.damages.len()) };
    damage
}

#[test]
fn metal_reaches_from_the_damage_to_the_allowance_wherever_the_part_lies() {
    let part = block(10.0, |_| TOP);
    let turns = [DQuat::IDENTITY, DQuat::from_rotation_y(1.1), DQuat::from_euler(glam::EulerRot::XYZ, 2.1, -0.7, 0.4)];
    for kind in 0..5 {
        let scan = block(1.0, |p| damaged(kind, p));
        let missing = part.volume() - scan.volume();
        for turn in turns {
            let repair = found(&turned(&part, turn), &turned(&scan, turn));
            let damage = only(&repair);
            // The rim below the tolerance stays as it is.
            let share = damage.missing / missing;
            assert!((0.93..1.03).contains(&share), "{kind}: {} of {missing} mm³", damage.missing);
            let follows = matches!(damage.chart, Chart::Surface(_));
            assert_eq!(follows, [true, false, false, false, true][kind] || kind == 3 && follows, "{kind}");
            let (metal, base) = (turned(&damage.mesh, turn.conjugate()), turned(&repair.base, turn.conjugate()));
            let slant = (turn * DVec3::Z).dot(damage.up);
            let over = SETTINGS.allowance - SETTINGS.layer / 2.0;
            let places = (1..39).flat_map(|i| (1..27).map(move |j| DVec2::new(4.0 * f64::from(i), 4.0 * f64::from(j))));
            for p in places.filter(|p| damaged(kind, *p) < TOP - 1.5) {
                let [low, high] = column(&metal, p).unwrap_or_else(|| panic!("{kind}: no metal at {p}"));
                let floor = column(&base, p).unwrap()[1];
                assert!(low < damaged(kind, p) + 0.3, "{kind}: begins at {low} at {p}");
                assert!((low - floor).abs() < 0.35, "{kind}: metal from {low}, floor at {floor} at {p}");
                // Seen from aside, what is welded over the part is as much longer.
                let more = high - TOP - over / slant;
                // Around edges and corners beads need room.
                let most = if kind < 3 { 0.35 } else { SETTINGS.bead };
                assert!((-0.35..most).contains(&more), "{kind}: ends at {high} at {p}");
            }
        }
    }
}

#[test]
fn what_is_milled_is_gone_from_the_damaged_part() {
    let part = block(10.0, |_| TOP);
    for kind in 0..5 {
        let scan = block(1.0, |p| damaged(kind, p));
        let repair = found(&part, &scan);
        let milled = scan.volume() - repair.base.volume();
        let said = only(&repair).milled;
        assert!((milled - said).abs() < 1e-3 * milled + 1.0, "{kind}: {milled}, {said} mm³");
        assert!([0.0..900.0, 3e3..6e3, 1e3..5e3, 0.0..900.0, 0.0..900.0][kind].contains(&said), "{kind}: {said} mm³");
    }
}

#[test]
fn noise_is_no_damage() {
    let part = block(10.0, |_| TOP);
    // As good as random.
    let rough = |p: DVec2| 0.3 * ((p.x * 127.1 + p.y * 311.7).sin() * 43758.5453).fract().abs() - 0.15;
    let whole = found(&part, &block(1.0, |p| TOP + rough(p)));
    assert!(whole.damages.is_empty() && whole.left.is_empty());
    let missing = part.volume() - block(1.0, |p| damaged(0, p)).volume();
    let scan = block(1.0, |p| damaged(0, p) + rough(p));
    let share = only(&found(&part, &scan)).missing / missing;
    assert!((0.93..1.05).contains(&share), "{share}");
}

#[test]
fn a_wall_beside_damage_is_not_milled() {
    // A step of 15 mm at x = 100, damaged at its foot.
    let step = |p: DVec2| if p.x > 100.5 { TOP + 15.0 } else { TOP };
    let worn = |p: DVec2| {
        let foot = (p.x - 88.0).abs() < 12.4 && (p.y - 55.0).abs() < 20.0;
        if foot && p.x < 100.5 { TOP - 5.0 } else { step(p) }
    };
    let repair = found(&block(1.0, step), &block(1.0, worn));
    let damage = only(&repair);
    for y in [40.0, 55.0, 70.0] {
        for x in [102.5, 105.0, 120.0] {
            let p = DVec2::new(x, y);
            assert_eq!(column(&damage.mesh, p), None, "metal in the wall at {p}");
            assert!((column(&repair.base, p).unwrap()[1] - TOP - 15.0).abs() < 1e-6, "the wall is milled at {p}");
        }
        assert!(column(&damage.mesh, DVec2::new(98.0, y)).is_some());
    }
}

#[test]
fn places_near_one_another_are_one_and_others_are_not() {
    let part = block(10.0, |_| TOP);
    let two = |apart: f64| {
        move |p: DVec2| {
            let near = |x: f64| p.distance(DVec2::new(x, 55.0)) < 8.0;
            if near(70.0 - apart / 2.0) || near(70.0 + apart / 2.0) { TOP - 6.0 } else { TOP }
        }
    };
    assert_eq!(found(&part, &block(1.0, two(70.0))).damages.len(), 2);
    assert_eq!(found(&part, &block(1.0, two(24.0))).damages.len(), 1);
}

#[test]
fn damage_that_cannot_be_welded_is_said() {
    let part = block(10.0, |_| TOP);
    let scan = block(1.0, |p| damaged(2, p));
    // From below, the block itself hides the bore.
    let from_below = Settings { up: Some(DVec3::NEG_Z), ..SETTINGS };
    let repair_from = |settings| repair(&part, &scan, settings, &Task::new());
    let hidden = repair_from(from_below).unwrap();
    assert!(hidden.damages.is_empty() && hidden.left[0].reason == Reason::Hidden);
    assert!((hidden.left[0].depth - 6.0).abs() < 1e-9);
    // Elsewhere, without faces, or without a surface.
    let far = Mesh { vertices: scan.vertices.iter().map(|p| *p + 500.0).collect(), ..scan.clone() };
    let cloud = Mesh { triangles: Vec::new(), ..scan.clone() };
    let ask = |part: &Mesh, scan: &Mesh| repair(part, scan, SETTINGS, &Task::new()).unwrap_err();
    assert!(matches!(ask(&part, &far), DamageError::Apart(_)));
    assert_eq!(ask(&part, &cloud), DamageError::NoFaces);
    assert_eq!(ask(&Mesh::default(), &scan), DamageError::NoSurface);
    let task = Task::new();
    task.cancel();
    assert!(matches!(repair(&part, &scan, SETTINGS, &task), Err(DamageError::Cancelled(_))));
}

/// Where a place on the block lies once it is turned.
fn at_any_angle(mut check: impl FnMut(DQuat)) {
    let steep = DQuat::from_euler(glam::EulerRot::XYZ, 2.1, -0.7, 0.4);
    [DQuat::IDENTITY, DQuat::from_rotation_y(1.1), steep].into_iter().for_each(&mut check);
}

/// A pocket of 40 × 30 mm in the middle of the block, so deep, mm.
fn pocket(p: DVec2, depth: f64) -> f64 {
    if (p.x - 80.0).abs() < 20.0 && (p.y - 55.0).abs() < 15.0 { TOP - depth } else { TOP }
}

#[test]
fn a_pocket_is_open_where_the_surface_is_missing_however_thin_its_floor_is() {
    let part = block(10.0, |_| TOP);
    at_any_angle(|turn| {
        for depth in [6.0, 25.0, 37.0] {
            let scan = block(1.0, |p| pocket(p, depth));
            let repair = found(&turned(&part, turn), &turned(&scan, turn));
            let damage = only(&repair);
            assert!(damage.up.dot(turn * DVec3::Z) > 0.999, "{depth} mm deep: along {}", turn.conjugate() * damage.up);
            assert!((damage.depth - depth).abs() < 0.1, "{} of {depth} mm", damage.depth);
            let missing = part.volume() - scan.volume();
            assert!((0.95..1.05).contains(&(damage.missing / missing)), "{} of {missing} mm³", damage.missing);
        }
    });
}

#[test]
fn a_place_is_named_by_its_middle_on_the_surface_of_the_part() {
    let part = block(10.0, |_| TOP);
    at_any_angle(|turn| {
        // A dish whose deepest place is far from its middle, and a pocket.
        let leaning = |p: DVec2| if pocket(p, 1.0) < TOP { TOP - 3.0 - 0.1 * (p.x - 60.0) } else { TOP };
        for scan in [block(1.0, leaning), block(1.0, |p| pocket(p, 30.0))] {
            let repair = found(&turned(&part, turn), &turned(&scan, turn));
            let off = turn.conjugate() * only(&repair).place - DVec3::new(80.0, 55.0, TOP);
            assert!(off.length() < 2.0 && off.z.abs() < 1e-6, "{off}");
        }
    });
}

/// The faces of a mesh whose middle is kept.
fn only_where(mesh: &Mesh, kept: impl Fn(DVec3) -> bool) -> Mesh {
    let middle = |corners: &[u32; 3]| corners.iter().map(|corner| mesh.vertices[*corner as usize]).sum::<DVec3>() / 3.0;
    let triangles = mesh.triangles.iter().copied().filter(|corners| kept(middle(corners))).collect();
    Mesh::from_triangles(mesh.vertices.clone(), triangles).0
}

/// The block with a square hole through its middle, 24 mm wide below and this much above.
fn holed(above: f64) -> Mesh {
    let square = |middle: DVec2, half: DVec2, z: f64| {
        [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|way| (middle + DVec2::from(way) * half).extend(z))
    };
    let middle = SIZE / 2.0;
    let rings = [(SIZE / 2.0, 0.0), (SIZE / 2.0, TOP), (DVec2::splat(above / 2.0), TOP), (DVec2::splat(12.0), 0.0)];
    let vertices: Vec<DVec3> = rings.iter().flat_map(|(half, z)| square(middle, *half, *z)).collect();
    let mut triangles = Vec::new();
    for (ring, k) in (0..4_u32).flat_map(|ring| (0..4_u32).map(move |k| (ring, k))) {
        let [a, b] = [k, (k + 1) % 4].map(|k| 4 * ring + k);
        let [c, d] = [b, a].map(|corner| (corner + 4) % 16);
        triangles.extend([[a, b, c], [a, c, d]]);
    }
    let (mesh, report) = Mesh::from_triangles(vertices, triangles);
    assert_eq!((report.open_edges, report.flipped), (0, 0));
    mesh
}

#[test]
fn damage_right_through_the_part_is_said_and_stays_bare() {
    let part = block(10.0, |_| TOP);
    at_any_angle(|turn| {
        // Straight, it has no floor at all; wider above, its sides are welded and its middle stays bare.
        for above in [24.0, 90.0] {
            let repair = found(&turned(&part, turn), &turned(&holed(above), turn));
            let [hole] = &repair.through[..] else { panic!("{above}: {} holes", repair.through.len()) };
            assert!((400.0..620.0).contains(&hole.area), "{above}: {} of 576 mm²", hole.area);
            assert!((28.0..37.0).contains(&hole.across), "{above}: {} mm across", hole.across);
            let place = turn.conjugate() * hole.place;
            assert!(place.truncate().distance(SIZE / 2.0) < 2.0, "{above}: at {place}");
            assert!(repair.unseen.is_empty());
            if above == 24.0 {
                assert!(repair.damages.is_empty() && repair.left[0].reason == Reason::Through, "{:?}", repair.left);
                assert!((repair.left[0].depth - TOP / 2.0).abs() < 1.0, "{}", repair.left[0].depth);
            } else {
                let damage = only(&repair);
                assert!((0.05..0.12).contains(&damage.bare), "{} of 576 / 8100", damage.bare);
                let metal = turned(&damage.mesh, turn.conjugate());
                assert_eq!(column(&metal, SIZE / 2.0), None, "metal over nothing");
                assert!(column(&metal, SIZE / 2.0 + 20.0).is_some());
            }
        }
    });
}

#[test]
fn a_hole_is_filled_once_it_is_backed() {
    let part = block(10.0, |_| TOP);
    at_any_angle(|turn| {
        // The scan shows the backing, on which metal is welded.
        let scan = block(1.0, |p| pocket(p, TOP - 0.1));
        let repair = found(&turned(&part, turn), &turned(&scan, turn));
        let damage = only(&repair);
        let missing = part.volume() - scan.volume();
        assert!(repair.through.is_empty() && damage.bare < 0.05, "{}", damage.bare);
        assert!((0.95..1.05).contains(&(damage.missing / missing)), "{} of {missing} mm³", damage.missing);
    });
}

#[test]
fn what_the_scan_does_not_show_is_neither_damage_nor_sound() {
    let part = block(10.0, |_| TOP);
    let is_near = |p: DVec3, at: DVec2, half: f64| (p.truncate() - at).abs().max_element() < half;
    at_any_angle(|turn| {
        let ask = |scan: &Mesh| found(&turned(&part, turn), &turned(scan, turn));
        let off = |place: DVec3, at: DVec3| (turn.conjugate() * place).distance(at);
        // Sound surface of 20 × 20 mm that was not scanned, a worn dish's middle, and the underside.
        let gap = only_where(&block(1.0, |_| TOP), |p| p.z < 1.0 || !is_near(p, DVec2::new(40.0, 30.0), 10.0));
        let repair = ask(&gap);
        let [unseen] = &repair.unseen[..] else { panic!("{} gaps", repair.unseen.len()) };
        assert!(repair.damages.is_empty() && repair.left.is_empty() && repair.through.is_empty());
        assert!((330.0..440.0).contains(&unseen.area), "{} mm²", unseen.area);
        assert!((25.0..31.0).contains(&unseen.across) && off(unseen.place, DVec3::new(40.0, 30.0, TOP)) < 3.0);
        let dish = block(1.0, |p| damaged(0, p));
        let repair = ask(&only_where(&dish, |p| p.z < 1.0 || !is_near(p, SIZE / 2.0, 10.0)));
        assert!((300.0..440.0).contains(&repair.unseen[0].area), "{} mm²", repair.unseen[0].area);
        assert_eq!(column(&turned(&only(&repair).mesh, turn.conjugate()), SIZE / 2.0), None, "metal over a gap");
        let repair = ask(&only_where(&dish, |p| p.z > 0.1));
        let [unseen] = &repair.unseen[..] else { panic!("{} gaps", repair.unseen.len()) };
        assert!(unseen.area > 0.97 * SIZE.x * SIZE.y && off(unseen.place, (SIZE / 2.0).extend(0.0)) < 4.0);
        assert!(only(&repair).bare < 0.05);
        // A pocket of which only the sides were scanned does not go through the part.
        let sides = only_where(&block(1.0, |p| pocket(p, 20.0)), |p| p.z < 1.0 || p.z > TOP - 19.9);
        let repair = ask(&sides);
        assert!(repair.through.is_empty() && repair.left[0].reason == Reason::Unseen, "{:?}", repair.left);
        assert!((900.0..1200.0).contains(&repair.unseen[0].area), "{} of 1200 mm²", repair.unseen[0].area);
    });
}

/// Where the scan lies in comparison with the part, if it is moved.
fn lies(part: &Mesh, scan: &Mesh) -> Option<Movement> {
    moved(part, scan, SETTINGS, &Task::new()).unwrap()
}

#[test]
fn a_scan_that_lies_shifted_or_turned_is_told_from_damage() {
    let part = block(10.0, |_| TOP);
    let middle = (SIZE / 2.0).extend(TOP / 2.0);
    let ways = [
        (DVec3::new(1.5, 0.0, 0.0), DVec3::ZERO),
        (DVec3::new(0.0, -0.8, 1.2), DVec3::ZERO),
        (DVec3::ZERO, DVec3::new(0.0, 0.025, 0.0)),
        (DVec3::new(0.4, 1.0, -1.1), DVec3::new(0.01, -0.015, 0.012)),
    ];
    at_any_angle(|turn| {
        let part = turned(&part, turn);
        for kind in 0..6 {
            let scan = turned(&block(2.0, |p| damaged(kind, p)), turn);
            assert_eq!(lies(&part, &scan), None, "{kind}: the damage itself");
            for (shift, axis) in ways.map(|(shift, axis)| (turn * shift, turn * axis)) {
                let about = turn * middle;
                let lie = |p: &DVec3| about + DQuat::from_scaled_axis(axis) * (*p - about) + shift;
                let scan = Mesh { vertices: scan.vertices.iter().map(lie).collect(), ..scan.clone() };
                let found = lies(&part, &scan).unwrap_or_else(|| panic!("{kind}: {shift} mm, {axis} rad"));
                let off = (found.shift.distance(shift), found.turn.distance(axis));
                assert!(off.0 < 0.15 && off.1 < 0.002, "{kind}: {shift} mm and {axis} rad, off by {off:?}");
            }
        }
    });
}

#[test]
fn wear_of_one_side_is_no_movement() {
    // All of the top is worn by 2 mm; the underside was scanned as well.
    let part = block(10.0, |_| TOP);
    at_any_angle(|turn| {
        assert_eq!(lies(&turned(&part, turn), &turned(&block(2.0, |_| TOP - 2.0), turn)), None);
    });
}

#[test]
fn a_grid_too_coarse_for_the_damage_is_said() {
    let part = block(10.0, |_| TOP);
    at_any_angle(|turn| {
        for (step, kind) in [2.0, 14.0].into_iter().flat_map(|step| (0..3).map(move |k| (step, k))) {
            let scan = block(1.0, |p| damaged(kind, p));
            let missing = part.volume() - scan.volume();
            let settings = Settings { step, ..SETTINGS };
            let repair = repair(&turned(&part, turn), &turned(&scan, turn), settings, &Task::new()).unwrap();
            let share = repair.damages.iter().map(|damage| damage.missing).sum::<f64>() / missing;
            let is_wrong = !(0.75..1.25).contains(&share);
            let unresolved = repair.damages.iter().find_map(|damage| damage.unresolved);
            let is_said = unresolved.is_some() || repair.left.iter().any(|left| left.reason == Reason::Coarse);
            assert!(is_said || !is_wrong, "{kind}, {step} mm: {share} of {missing} mm³");
            assert!(!is_said || step > 2.0, "{kind}: {share}");
            if let Some(unresolved) = unresolved {
                assert!(
                    (0.8..1.1).contains(&(unresolved / missing)),
                    "{kind}, {step} mm: {unresolved} of {missing} mm³"
                );
            }
        }
    });
}
