//! Trees of round bars: the bars are found however the tree is turned, and the cylinders that part them lose nothing.

use bead_part::chart::{Bound, Chart};
use bead_part::directions::{Division, Piece, Settings, divisions};
use bead_part::model::Mesh;
use bead_part::model::solid::Solid;
use bead_part::slice::{SliceOptions, Slicer};
use bead_part::task::Task;
use glam::{DQuat, DVec3};
use planar::{DVec2, Polygon, Ring};
use std::f64::consts::{PI, TAU};

const SETTINGS: Settings = Settings { lean: 45.0, tilt: 90.0, bead: 7.0 };

/// A bar from a point along a direction, with its radius and length, mm.
#[derive(Clone, Copy)]
struct Bar {
    from: DVec3,
    along: DVec3,
    radius: f64,
    length: f64,
}

impl Bar {
    fn mesh(&self) -> Mesh {
        let corner = |k: i32| DVec2::from_angle(TAU * f64::from(k) / 96.0) * self.radius;
        let solid = Solid::extrude(&Polygon::simple(Ring::new((0..96).map(corner).collect())), 0.0, self.length);
        let turn = DQuat::from_rotation_arc(DVec3::Z, self.along);
        Mesh::from_triangles(solid.vertices.iter().map(|p| self.from + turn * *p).collect(), solid.triangles).0
    }
}

/// A trunk with branches at these heights, angles to the vertical and around it, °, turned about z.
fn tree(branches: &[(f64, f64, f64)], turned: f64) -> Vec<Bar> {
    let trunk = Bar { from: DVec3::ZERO, along: DVec3::Z, radius: 18.0, length: 150.0 };
    let branch = |(height, lean, around): &(f64, f64, f64)| {
        let lean = DQuat::from_rotation_y(lean.to_radians()) * DVec3::Z;
        let along = DQuat::from_rotation_z((around + turned).to_radians()) * lean;
        Bar { from: DVec3::Z * *height, along, radius: 12.0, length: 110.0 }
    };
    std::iter::once(trunk).chain(branches.iter().map(branch)).collect()
}

/// The bars as one closed mesh: each branch begins on the trunk.
fn united(bars: &[Bar]) -> Mesh {
    let mut whole = bars[0].mesh();
    // A little into the trunk, so that they are one.
    let outside: Bound = "cylinder:axis=z,radius=17.5,side=outer".parse().unwrap();
    bars[1..].iter().for_each(|bar| whole.add(outside.part_of(&bar.mesh())));
    whole
}

fn found(mesh: &Mesh) -> Vec<Division> {
    divisions(mesh, SETTINGS, &Task::new()).unwrap()
}

#[test]
fn bars_that_branch_are_built_along_their_axes_at_any_angle() {
    let trees: [&[(f64, f64, f64)]; 5] = [
        &[(90.0, 90.0, 0.0)],
        &[(60.0, 60.0, 0.0), (100.0, 60.0, 180.0)],
        &[(70.0, 45.0, 20.0), (70.0, 80.0, 140.0), (80.0, 70.0, 260.0)],
        &[(60.0, 88.0, 0.0), (60.0, 88.0, 180.0), (60.0, 88.0, 90.0), (60.0, 88.0, 270.0)],
        &[(50.0, 55.0, 10.0), (100.0, 75.0, 70.0)],
    ];
    for (tree_number, branches) in trees.iter().enumerate() {
        for turned in [0.0, 17.0 + 93.0 * tree_number as f64] {
            let bars = tree(branches, turned);
            let found = found(&united(&bars));
            let case = format!("tree {tree_number} at {turned}°");
            let (best, level) = (&found[0], found.last().unwrap());
            assert!(level.hanging > 500.0 && best.hanging < 200.0, "{case}: {} of {}", best.hanging, level.hanging);
            let of = |piece: &Piece| 1 + piece.also.len();
            assert_eq!(best.pieces.iter().map(of).sum::<usize>(), bars.len(), "{case}: {best:?}");
            assert!(best.pieces[0].chart.is_level(), "{case}");
            for bar in &bars[1..] {
                // Its own cylinder comes first.
                let lists = best.pieces.iter().flat_map(|piece| std::iter::once(&piece.within).chain(&piece.also));
                let near = lists.clone().any(|bounds| match &bounds[0] {
                    Bound::Cylinder(own) => own.axis.cross(bar.along).length().asin().to_degrees() < 0.5,
                    Bound::Plane(_) => false,
                });
                assert!(near, "{case}: {} is missing in {best:?}", bar.along);
                let tip = bar.from + bar.along * 0.9 * bar.length;
                let has = |bounds: &&Vec<Bound>| bounds.iter().all(|bound| bound.height(tip) > 0.0);
                assert_eq!(lists.filter(has).count(), 1, "{case}: the tip at {tip}");
            }
        }
    }
}

/// A trunk, a branch that leans this much, and a branch on that one along a direction, as one mesh; and the last of them.
fn branch_on_branch(lean: f64, along: DVec3, turn: DQuat) -> (Mesh, Bar) {
    let bars = tree(&[(57.0, lean, 0.0)], 0.0);
    let first = bars[1];
    let second = Bar { from: first.from + 75.0 * first.along, along: along.normalize(), radius: 9.0, length: 100.0 };
    let mut mesh = united(&bars);
    let [a, t] = [first.along, first.from].map(|v| format!("{}/{}/{}", v.x, v.y, v.z));
    let outside: Bound = format!("cylinder:axis={a},through={t},radius=11.5,side=outer").parse().unwrap();
    mesh.add(outside.part_of(&second.mesh()));
    mesh.vertices.iter_mut().for_each(|p| *p = turn * *p);
    (mesh, Bar { from: turn * second.from, along: turn * second.along, ..second })
}

/// The best division, and the layers of the piece that is bounded by a bar.
fn layers_of(mesh: &Mesh, bar: &Bar, settings: Settings) -> (Division, Chart) {
    let best = divisions(mesh, settings, &Task::new()).unwrap().remove(0);
    let own = |piece: &&Piece| {
        let mut lists = std::iter::once(&piece.within).chain(&piece.also);
        lists.any(|bounds| matches!(&bounds[0], Bound::Cylinder(own) if own.axis.cross(bar.along).length() < 0.01))
    };
    let chart = best.pieces.iter().find(own).unwrap().chart.clone();
    (best, chart)
}

/// Layers square to a branch begin as crescents beside its carrier: a little more lean is better, and it is said.
#[test]
fn a_branch_rather_leans_a_little_more_than_it_begins_in_crescents() {
    for turned in [0.0, 73.0] {
        let turn = DQuat::from_rotation_z(f64::to_radians(turned));
        // 48° from layers around the branch that carries it, more from that branch's own layers.
        let (mesh, bar) = branch_on_branch(52.0, DVec3::new(0.57, 0.67, 0.48), turn);
        let (best, chart) = layers_of(&mesh, &bar, SETTINGS);
        let lean = best.lean.unwrap_or_else(|| panic!("at {turned}°: {best:?}"));
        assert!(lean > 45.0 && lean < 60.0, "at {turned}°: {lean}");
        assert!(!matches!(chart, Chart::Plane(_)), "at {turned}°: {chart}");
        assert!(best.hanging < 200.0, "at {turned}°: {} mm² hang", best.hanging);
        // Nothing is said where no wall leans more than it should.
        let (wide, _) = layers_of(&mesh, &bar, Settings { lean: 60.0, ..SETTINGS });
        assert_eq!(wide.lean, None, "at {turned}°");
    }
}

/// Layers around a branch may face below the horizon only as far as the part may be turned.
#[test]
fn a_branch_on_a_branch_gets_layers_around_it_where_the_part_can_be_turned_over() {
    for turned in [0.0, 131.0] {
        let turn = DQuat::from_rotation_z(f64::to_radians(turned));
        let (mesh, bar) = branch_on_branch(30.0, DVec3::new(0.783, 0.585, 0.21), turn);
        let (best, chart) = layers_of(&mesh, &bar, SETTINGS);
        assert!(matches!(chart, Chart::Plane(_)) && best.tilt <= 91.0, "at {turned}°: {chart}, {}", best.tilt);
        let (best, chart) = layers_of(&mesh, &bar, Settings { tilt: 120.0, ..SETTINGS });
        assert!(matches!(chart, Chart::Cylinder(_)), "at {turned}°: {chart}");
        assert!(best.tilt > 100.0 && best.tilt < 121.0 && best.lean.is_none(), "at {turned}°: {}", best.tilt);
    }
}

/// Where the part cannot be turned over for layers around a branch, flat ones nearly along its surface begin with room for a
/// bead; those square to the branch would begin as crescents.
#[test]
fn a_branch_below_the_horizon_begins_flat_on_the_one_that_carries_it() {
    for turned in [0.0, 131.0] {
        let turn = DQuat::from_rotation_z(f64::to_radians(turned));
        // Away from its carrier it points 9° below the horizon.
        let along = DQuat::from_rotation_y(f64::to_radians(30.0)) * DVec3::new(0.1, 0.94, 0.28).normalize();
        let (mesh, bar) = branch_on_branch(30.0, along, turn);
        let (best, chart) = layers_of(&mesh, &bar, SETTINGS);
        let Chart::Plane(plane) = chart else { panic!("at {turned}°: {chart}") };
        let carrier = turn * DQuat::from_rotation_y(f64::to_radians(30.0)) * DVec3::Z;
        let away = bar.along.reject_from(carrier).normalize();
        let skew = plane.up.angle_between(away).to_degrees();
        assert!(skew <= 15.0, "at {turned}°: {skew}° off the carrier's surface");
        assert!(plane.up.angle_between(bar.along).to_degrees() <= 45.0, "at {turned}°: {plane:?}");
        assert!(best.tilt <= 91.0, "at {turned}°: {}", best.tilt);
    }
}

/// Inside and outside of a cylinder are the whole, wherever it lies; and a bar across a bar has the volume of the integral.
#[test]
fn a_cylinder_parts_a_bar_in_two() {
    let bar = Bar { from: DVec3::new(-60.0, 3.0, 20.0), along: DVec3::X, radius: 10.0, length: 120.0 };
    for (radius, lean) in [(15.0, 0.0), (15.0, 40.0), (10.0, 0.0), (6.0, 25.0), (40.0, 10.0)] {
        let axis = DQuat::from_rotation_y(f64::to_radians(lean)) * DVec3::Z;
        let turn = DQuat::from_axis_angle(DVec3::new(0.3, 0.5, 0.8).normalize(), 1.1);
        for turn in [DQuat::IDENTITY, turn] {
            let mut mesh = bar.mesh();
            mesh.vertices.iter_mut().for_each(|p| *p = turn * *p);
            let (axis, through) = (turn * axis, turn * DVec3::new(5.0, 0.0, 20.0));
            let part = |side: &str| {
                let text = format!(
                    "cylinder:axis={}/{}/{},through={}/{}/{},radius={radius},side={side}",
                    axis.x, axis.y, axis.z, through.x, through.y, through.z
                );
                text.parse::<Bound>().unwrap().part_of(&mesh).volume()
            };
            let (inner, outer) = (part("inner"), part("outer"));
            assert!(((inner + outer) / mesh.volume() - 1.0).abs() < 1e-3, "{radius} {lean}: {inner} {outer}");
            if lean == 0.0 {
                // Across the bar, y from its axis: the height of the bar there times the width of the cylinder.
                let steps = 4000;
                let slice = |k: i32| {
                    let y = -10.0 + (f64::from(k) + 0.5) * 20.0 / f64::from(steps);
                    let height = 2.0 * (100.0 - y * y).max(0.0).sqrt();
                    let width = 2.0 * (radius * radius - (y + 3.0) * (y + 3.0)).max(0.0).sqrt();
                    height * width * 20.0 / f64::from(steps)
                };
                let expected: f64 = (0..steps).map(slice).sum();
                assert!((inner / expected - 1.0).abs() < 0.005, "{radius}: {inner} {expected}");
            }
        }
    }
    // Cylinders that cut a bar all around, however thin they are.
    for radius in [0.1, 0.3, 0.5, 1.0, 2.0, 4.0] {
        let part = |side: &str| {
            let text = format!("cylinder:axis=z,through=0/3/0,radius={radius},side={side}");
            text.parse::<Bound>().unwrap().part_of(&bar.mesh()).volume()
        };
        let (inner, outer) = (part("inner"), part("outer"));
        assert!(((inner + outer) / bar.mesh().volume() - 1.0).abs() < 1e-3, "{radius}: {inner} {outer}");
        // Edges of the cut lie 0.02 mm from the circle, or span a half of the radius.
        let volume = inner / (PI * radius * radius * 20.0);
        assert!((0.93..1.01).contains(&volume), "{radius}: {volume}");
    }
    // A round hole through a plate is cut all around.
    let plate = Bar { from: DVec3::ZERO, along: DVec3::Z, radius: 50.0, length: 8.0 }.mesh();
    let rest: Bound = "cylinder:axis=z,through=4/2/0,radius=20,side=outer".parse().unwrap();
    let volume = plate.volume() - PI * 400.0 * 8.0;
    assert!((rest.part_of(&plate).volume() / volume - 1.0).abs() < 2e-3, "{} {volume}", rest.part_of(&plate).volume());
}

/// What a cylinder leaves of a trunk is not parted, however densely its branches stand around it.
#[test]
fn a_trunk_without_its_branches_has_one_island_a_layer() {
    let rounds: [&[(f64, f64, f64)]; 3] = [
        &[(60.0, 88.0, 0.0), (60.0, 88.0, 90.0), (60.0, 88.0, 180.0), (60.0, 88.0, 270.0)],
        // Their cuts leave no gap around the trunk.
        &[
            (40.0, 80.0, 0.0),
            (70.0, 80.0, 60.0),
            (100.0, 80.0, 120.0),
            (40.0, 80.0, 180.0),
            (70.0, 80.0, 240.0),
            (100.0, 80.0, 300.0),
        ],
        // One over another.
        &[(40.0, 90.0, 175.0), (75.0, 90.0, 185.0), (110.0, 90.0, 180.0), (110.0, 90.0, 0.0)],
    ];
    for (k, branches) in rounds.iter().enumerate() {
        for turned in [0.0, 41.0, 178.0] {
            let bars = tree(branches, turned);
            let mesh = united(&bars);
            let inner: Bound = "cylinder:axis=z,radius=18.05,side=inner".parse().unwrap();
            let trunk = inner.part_of(&mesh);
            let expected = bars[0].mesh().volume();
            assert!((trunk.volume() / expected - 1.0).abs() < 0.02, "{k} at {turned}°: {} {expected}", trunk.volume());
            let options = SliceOptions { layer_height: 2.0, close_gap: 0.1, simplify: 0.01 };
            let layers = Slicer::new(&trunk, options, &Task::new()).unwrap().all(&Task::new()).unwrap();
            assert!(layers.iter().all(|layer| layer.islands.len() == 1), "{k} at {turned}°");
        }
    }
}

/// A branch inside its own cylinder is whole: the cut goes all around where the trunk carries it.
#[test]
fn a_branch_cut_all_around_has_one_island_a_layer_at_any_angle() {
    for (lean, turned) in [(90.0, 0.0), (90.0, 37.0), (62.0, 37.0), (75.0, 111.0), (45.0, 203.0), (80.0, 290.5)] {
        let bars = tree(&[(75.0, lean, 0.0), (75.0, lean, 90.0), (75.0, 90.0, 180.0), (75.0, 88.0, 270.0)], turned);
        let mesh = united(&bars);
        for bar in &bars[1..] {
            let (axis, through) = (bar.along, bar.from);
            let [a, t] = [axis, through].map(|v| format!("{}/{}/{}", v.x, v.y, v.z));
            let inner: Bound = format!("cylinder:axis={a},through={t},radius=12.05,side=inner").parse().unwrap();
            let half: Bound = format!("up={a},through={t}").parse().unwrap();
            let case = format!("{lean}° at {turned}°, {axis}");
            let part = inner.part_of(&mesh);
            let open = part.neighbours.iter().flatten().filter(|across| **across == u32::MAX).count();
            assert_eq!(open, 0, "{case}: {open} open edges");
            let mut branch = half.part_of(&part);
            // From the middle of the trunk on it is a round bar, and no more.
            let expected = PI * 12.0 * 12.0 * bar.length;
            assert!((branch.volume() / expected - 1.0).abs() < 0.02, "{case}: {} {expected}", branch.volume());
            let turn = DQuat::from_rotation_arc(axis, DVec3::Z);
            branch.vertices.iter_mut().for_each(|p| *p = turn * (*p - through));
            let options = SliceOptions { layer_height: 2.0, close_gap: 0.1, simplify: 0.01 };
            let layers = Slicer::new(&branch, options, &Task::new()).unwrap().all(&Task::new()).unwrap();
            for layer in &layers {
                assert_eq!(layer.islands.len(), 1, "{case}: z {}", layer.z);
                assert!(layer.islands[0].holes.is_empty(), "{case}: z {}", layer.z);
            }
        }
    }
}

/// Only what a cylinder really cuts is divided: a bound a little outside its own bar touches the branches alone.
#[test]
fn bounds_divide_no_more_than_they_cut() {
    for turned in [0.0, 37.0] {
        let bars = tree(&[(90.0, 90.0, 0.0)], turned);
        let mesh = united(&bars);
        let [trunk, branch] = [&bars[0], &bars[1]];
        let part = |bar: &Bar, side: &str| {
            let [a, t] = [bar.along, bar.from].map(|v| format!("{}/{}/{}", v.x, v.y, v.z));
            let bound = format!("cylinder:axis={a},through={t},radius={},side={side}", bar.radius + 0.05);
            bound.parse::<Bound>().unwrap().part_of(&mesh)
        };
        for bar in [trunk, branch] {
            let (inner, outer) = (part(bar, "inner"), part(bar, "outer"));
            let [volume, count] =
                [inner.volume() + outer.volume(), (inner.triangles.len() + outer.triangles.len()) as f64];
            assert!((volume / mesh.volume() - 1.0).abs() < 1e-3, "at {turned}°: {volume}");
            assert!(count < 100_000.0, "at {turned}°: {count} triangles from {}", mesh.triangles.len());
        }
    }
}
