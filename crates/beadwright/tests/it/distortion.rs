//! Parts bent beforehand come out straighter, also where metal shrinks otherwise than assumed; and where the heat of plans lies.

use crate::solids;
use beadwright::distort::{self, Clamp, Distortion, EccentricityScore, Settings};
use beadwright::distortion::compensate::{CompensateError, Compensation};
use beadwright::distortion::{Welding, eccentricity};
use beadwright::layer::Layer;
use beadwright::plan::plan;
use beadwright::{Mesh, Profile, StrategyName, Task};

fn steel() -> Profile {
    Profile::built_in("cmt-steel-abb").unwrap()
}

/// Boxes of one body.
fn boxes(corners: &[([f64; 3], [f64; 3])]) -> Mesh {
    let facets: Vec<_> = corners.iter().flat_map(|&(low, high)| solids::cuboid(low, high)).collect();
    solids::imported(&facets).mesh
}

/// A wall of one bead.
fn wall() -> Mesh {
    boxes(&[([-60.0, -2.25, 0.0], [60.0, 2.25, 20.0])])
}

fn layers(part: &Mesh, profile: &Profile) -> Vec<Layer> {
    plan("part", part, profile, &Task::new()).unwrap().layers
}

/// The plan of a part, built with all shrinkage multiplied by a factor.
fn built(part: &Mesh, profile: &Profile, calibration: f64) -> Distortion {
    let welding = Welding::of(&layers(part, profile), profile).unwrap();
    let settings = welding.settings(profile).unwrap();
    let settings = Settings { calibration, voxel: 4.0, voxel_height: 4.0, ..settings };
    let clamps = welding.plate.clamped_at_corners(10.0, Clamp::FIRM);
    distort::build(&welding.plate, &welding.beads, &clamps, &settings, &mut |_| true).unwrap()
}

#[test]
fn a_part_bent_beforehand_is_off_by_less_than_half_if_it_shrinks_by_a_fifth_more_or_less() {
    let mut profile = steel();
    profile.fill.strategy = StrategyName::Wall;
    let part = wall();
    let straight = Compensation::new(&part, 4.5, &Task::new()).unwrap();
    let assumed = built(&part, &profile, 1.0);
    let bent = straight.against(&assumed.bending(&assumed.released)).unwrap();
    let mesh = bent.mesh();
    assert!(mesh.bounds().0.z == 0.0 && mesh.volume() > part.volume());
    for shrinkage in [0.8, 1.0, 1.2] {
        let off = |compensation: &Compensation, part: &Mesh| {
            let built = built(part, &profile, shrinkage);
            compensation.left(&built.bending(&built.released)).unwrap()
        };
        let (before, after) = (off(&straight, &part), off(&bent, &mesh));
        println!(
            "shrinkage {shrinkage}: largest {:.3} → {:.3} mm, rms {:.3} → {:.3} mm",
            before.largest, after.largest, before.rms, after.rms
        );
        assert!(after.largest < 0.5 * before.largest && after.rms < 0.5 * before.rms);
    }
}

#[test]
fn what_the_model_does_not_reach_is_refused() {
    let (profile, part) = (steel(), wall());
    let straight = Compensation::new(&part, 4.5, &Task::new()).unwrap();
    let bent = built(&part, &profile, 30.0);
    let refused = straight.against(&bent.bending(&bent.released)).unwrap_err();
    assert!(matches!(refused, CompensateError::TooSteep { steepest, .. } if steepest > 0.1), "{refused}");
    let elsewhere = boxes(&[([-60.0, 100.0, 0.0], [60.0, 104.5, 20.0])]);
    let elsewhere = Compensation::new(&elsewhere, 4.5, &Task::new()).unwrap();
    assert!(matches!(elsewhere.against(&bent.bending(&bent.released)), Err(CompensateError::NoMetal(_))));
    let cancelled = Task::new();
    cancelled.cancel();
    assert!(matches!(Compensation::new(&part, 4.5, &cancelled), Err(CompensateError::Cancelled(_))));
}

/// Eight pillars around the middle, in two rows.
fn pillars() -> Mesh {
    let places = (0..8).map(|i| (f64::from(i % 4) * 30.0, f64::from(i / 4) * 60.0));
    boxes(&places.map(|(x, y)| ([x, y, 0.0], [x + 14.0, y + 14.0, 6.0])).collect::<Vec<_>>())
}

#[test]
fn an_order_against_distortion_keeps_the_heat_in_the_middle_at_little_cost() {
    let balanced = |distortion: bool| {
        let mut profile = steel();
        profile.order.distortion = distortion;
        let plan = plan("pillars", &pillars(), &profile, &Task::new()).unwrap();
        let course = eccentricity(&plan.layers, &profile, &Task::new()).unwrap();
        (EccentricityScore::of(&course), plan.summary)
    };
    let ((usual, plain), (balanced, summary)) = (balanced(false), balanced(true));
    let (before, after) = (&plain.metrics, &summary.metrics);
    println!("{usual:?}, {} s\n{balanced:?}, {} s", before.total_time_s, after.total_time_s);
    assert!(balanced.mean < 0.7 * usual.mean);
    assert!(after.total_time_s < 1.05 * before.total_time_s);
    assert!(
        (after.deposited_length_mm / before.deposited_length_mm - 1.0).abs() < 1e-9 && after.passes == before.passes
    );
    assert!(summary.notes.iter().any(|note| note.contains("order.distortion")), "{:?}", summary.notes);
    assert!(!plain.notes.iter().any(|note| note.contains("order.distortion")));
}

/// One bead at the side of a plate: its heat lies beside the middle of the metal, and turns with it.
#[test]
fn the_course_of_the_heat_turns_with_the_part() {
    let course = |at: [f64; 2]| {
        let [x, y] = at;
        let mut parts = vec![([x - 10.0, y - 10.0, 0.0], [x + 10.0, y + 10.0, 4.0])];
        parts.push(([-x - 10.0, -y - 10.0, 0.0], [-x + 10.0, -y + 10.0, 4.0]));
        let profile = steel();
        let course = eccentricity(&layers(&boxes(&parts), &profile), &profile, &Task::new()).unwrap();
        assert!(course.len() > 20 && course.is_sorted_by(|a, b| a.time <= b.time));
        // No more heat than the arc has given: 129 A at 15 V, of which 85 % reach the part.
        let given = |time: f64| 129.0 * 15.0 * 0.85 * time;
        assert!(course.iter().all(|at| 0.0 <= at.heat && at.heat <= 1.01 * given(at.time) && at.offset.is_finite()));
        EccentricityScore::of(&course)
    };
    let (along_x, along_y) = (course([40.0, 0.0]), course([0.0, 40.0]));
    println!("{along_x:?}\n{along_y:?}");
    assert!(along_x.largest > 20.0 && along_x.largest < 50.0);
    assert!((along_x.mean / along_y.mean - 1.0).abs() < 0.05);
}
