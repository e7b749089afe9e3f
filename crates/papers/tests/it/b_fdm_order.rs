//! The plates of Han et al. 2018 (`b-fdm-order`): sub-regions, angles, travel and time, at several rotations.

use beadwright::fill::compound::Compound;
use beadwright::fill::{Strategy as _, angle};
use beadwright::model::Mesh;
use beadwright::model::solid::Solid;
use beadwright::order::Method;
use beadwright::plan;
use beadwright::profile::{Profile, RasterTurn};
use beadwright::task::Task;
use beadwright_papers::b_fdm_order::{self as han, Loops, Printer, Turned};

/// Rotations at which the plates of Han et al. 2018 are tried, °: along the axes, close to them, and between.
const ROTATIONS: [f64; 5] = [0.0, 5.0, 40.0, 90.0, 135.0];

#[test]
fn the_plate_of_twelve_sub_regions_has_twelve() {
    let [_, twelve, _] = han::plates();
    assert_eq!(Turned::new(&twelve, 0.0, &Printer::new().unwrap()).sub_regions(), 12);
}

/// The page's figures: contour travel saved of columns and of file order, the same at every rotation, and layer time
/// saved of the plain plan along the axes and between them, %.
#[test]
fn plates_save_what_the_page_says() {
    let printer = Printer::new().unwrap();
    let stated = [(39.0, 60.0, [5.0, 9.5]), (44.0, 48.0, [1.9, 10.0]), (40.5, 55.5, [2.7, 9.0])];
    for (plate, (columns, file, times)) in han::plates().iter().zip(stated) {
        for (degrees, time) in [(0.0, times[0]), (90.0, times[0] - 0.5), (45.0, times[1]), (140.0, times[1] - 0.5)] {
            let turned = Turned::new(plate, degrees, &printer);
            let [plain, in_columns, ours] = [han::PLAIN, han::COLUMNS, han::OURS].map(|plan| turned.outcome(&plan));
            let (of_plain, of_columns) = (ours.saved(&plain), ours.saved(&in_columns));
            let what = format!("{} at {degrees}°: {of_plain:?} {of_columns:?}", plate.name);
            assert!(of_columns.travel >= columns && of_columns.travel >= plate.paper[0], "{what}");
            assert!(of_plain.travel >= file && of_plain.time >= time, "{what}");
        }
    }
}

/// Against parallel lines across the whole section. Against sub-regions, of which the method's first step is done already,
/// 7 to 8 % are saved.
#[test]
fn plates_save_the_layer_time_of_the_paper() {
    let printer = Printer::new().unwrap();
    for plate in han::plates() {
        let saved = |degrees: f64| {
            let turned = Turned::new(&plate, degrees, &printer);
            turned.outcome(&han::OURS).saved(&turned.outcome(&han::WHOLE)).time
        };
        let all: Vec<f64> = (0..36).map(|k| saved(5.0 * f64::from(k))).collect();
        let (mean, least) = (all.iter().sum::<f64>() / 36.0, all.iter().copied().fold(f64::INFINITY, f64::min));
        println!("{}: {mean:.1} % (worst {least:.1}), paper {}", plate.name, plate.paper[1]);
        assert!(mean >= plate.paper[1], "{}: {mean} %", plate.name);
    }
}

/// Whole lines lay what sub-regions lay, but for links along the boundary.
#[test]
fn whole_lines_and_sub_regions_have_the_same_turns() {
    let printer = Printer::new().unwrap();
    for plate in han::plates() {
        let turned = Turned::new(&plate, 30.0, &printer);
        let [whole, apart] = [han::WHOLE, han::PLAIN].map(|plan| turned.outcome(&plan));
        assert_eq!((whole.turns, whole.contour_travel), (apart.turns, apart.contour_travel), "{}", plate.name);
        assert!(
            whole.paths > apart.paths && whole.fill_travel > apart.fill_travel,
            "{}: {whole:?} {apart:?}",
            plate.name
        );
    }
}

/// How much longer two layers take with the best angle than with a plan of a fixed one, %.
fn longer_than(fixed: &han::Plan, plate: &han::Plate, degrees: f64, printer: &Printer) -> f64 {
    let turned = Turned::new(plate, degrees, printer);
    -turned.outcome(&han::OURS).saved(&turned.outcome(fixed)).time
}

#[test]
fn the_best_angle_is_never_slower_than_a_fixed_one() {
    let printer = Printer::new().unwrap();
    for (plate, degrees) in han::plates().iter().flat_map(|plate| ROTATIONS.map(|degrees| (plate, degrees))) {
        let longer = longer_than(&han::FIXED, plate, degrees, &printer);
        assert!(longer <= 0.5, "{} at {degrees}°: {longer:+} %", plate.name);
        // Between the axes it gains.
        assert!(
            longer <= -3.0 || degrees % 45.0 < 6.0 && degrees != 135.0,
            "{} at {degrees}°: {longer:+} %",
            plate.name
        );
    }
}

/// Lines at 0° on both layers are no goal for lines that cross: of all pairs of angles, ours is the best, and on the first plate
/// no pair comes near, since lines run along it on one layer only.
#[test]
fn no_pair_of_crossing_angles_is_quicker_than_ours() {
    let printer = Printer::new().unwrap();
    for (number, plate) in han::plates().iter().enumerate() {
        let turned = Turned::new(plate, 0.0, &printer);
        let longer = |plan: &han::Plan| -turned.outcome(plan).saved(&turned.outcome(&han::ALIKE)).time;
        let pairs = (0..45).map(|k| f64::from(2 * k)).map(|degrees| {
            let raster = han::Raster::At(degrees.to_radians());
            longer(&han::Plan { raster, ..han::OURS })
        });
        let (least, ours) = (pairs.fold(f64::INFINITY, f64::min), longer(&han::OURS));
        println!("{}: 45 pairs at least {least:.2} % longer, ours {ours:.2} %", plate.name);
        assert!(ours <= least + 0.1, "{}: ours {ours} %, the best pair {least} %", plate.name);
        assert!(number > 0 || least > 4.0, "{}: a pair takes only {least} % longer", plate.name);
    }
}

/// The same with whole plans, whose times are those of the page.
#[test]
fn whole_plans_take_the_time_of_the_page() {
    let (printer, profile) = (Printer::new().unwrap(), Profile::built_in("fdm-abs-0.4").unwrap());
    let [_, twelve, _] = han::plates();
    for degrees in [0.0, 35.0] {
        let solid = Solid::extrude(&twelve.turned(degrees), 0.0, 2.0 * profile.layers.height);
        let mesh = Mesh::from_triangles(solid.vertices, solid.triangles).0;
        let seconds = |turn: RasterTurn| {
            let mut profile = profile.clone();
            profile.fill.raster_turn = turn;
            plan::plan("plate", &mesh, &profile, &Task::new()).unwrap().summary.metrics.total_time_s
        };
        let stated = 2.0 * Turned::new(&twelve, degrees, &printer).outcome(&han::OURS).seconds;
        let (best, fixed) = (seconds(RasterTurn::Best), seconds(RasterTurn::Alternate));
        assert!((best / stated - 1.0).abs() < 0.01, "{degrees}°: {best} s, on the page {stated} s");
        assert!(best <= 1.005 * fixed, "{degrees}°: {best} s for {fixed} s");
    }
}

#[test]
fn contours_of_the_plates_lie_within_one_percent_of_the_optimum() {
    let printer = Printer::new().unwrap();
    // Nine loops take the optimum long; `tests/it/tour.rs` has random ones.
    for (plate, degrees) in han::plates()[1..].iter().flat_map(|plate| [0.0, 35.0].map(|degrees| (plate, degrees))) {
        let turned = Turned::new(plate, degrees, &printer);
        let travel = |method| turned.outcome(&han::Plan { loops: Loops::By(method), ..han::PLAIN }).contour_travel;
        let (ours, exact) = (travel(Method::LocalSearch), travel(Method::Exact));
        assert!(ours <= 1.01 * exact, "{} at {degrees}°: {ours} mm for {exact} mm", plate.name);
    }
}

/// Table 1 agrees with the abstract, and the plates have the loops and sub-regions of the paper's figures.
#[test]
fn plates_are_of_the_kinds_that_the_paper_prints() {
    let printer = Printer::new().unwrap();
    for plate in han::plates() {
        let saved = |[before, after]: [f64; 2]| 100.0 * (1.0 - after / before);
        let table = [saved(plate.printed.travel), saved(plate.printed.seconds)];
        assert!(table.iter().zip(plate.paper).all(|(table, stated)| (table - stated).abs() < 0.06), "{table:?}");
        let turned = Turned::new(&plate, 0.0, &printer);
        let ours = [turned.sub_regions(), turned.merged_regions()];
        println!("{}: {ours:?}, the paper {:?}", plate.name, plate.printed.regions);
        assert!(plate.printed.regions.is_none_or(|[all, _]| ours[0] == all) && 2 * ours[1] < ours[0], "{ours:?}");
    }
}

/// Figure 4: the shortest tour only becomes shorter, ends as the colony's tour, and the mean comes down towards it.
#[test]
fn the_colony_converges_to_its_tour() {
    let printer = Printer::new().unwrap();
    for plate in han::plates() {
        let turned = Turned::new(&plate, 0.0, &printer);
        let rounds = turned.convergence();
        let travel = |method| turned.outcome(&han::Plan { loops: Loops::By(method), ..han::PLAIN }).contour_travel;
        let (first, last) = (rounds[0], rounds[199]);
        assert_eq!(rounds.len(), 200);
        assert!(rounds.windows(2).all(|w| w[1].shortest <= w[0].shortest));
        assert!(rounds.iter().all(|round| round.shortest <= round.mean + 1e-9));
        assert!((last.shortest - travel(Method::AntColony)).abs() < 1e-6, "{last:?}");
        assert!(first.shortest <= travel(Method::ImprovedNearest) + 1e-6, "{first:?}");
        println!("{}: {first:?} {last:?}", plate.name);
        assert!(last.mean < first.mean && last.mean < 1.2 * last.shortest, "{first:?} {last:?}");
    }
}

/// Eqs 10 and 11 at every corner of the path itself, against the sum over edges.
#[test]
fn the_area_at_turns_is_that_of_the_corners_of_a_path() {
    let profile = Profile::built_in("fdm-abs-0.4").unwrap();
    let settings = profile.fill_settings(0);
    let r = settings.bead.width / 2.0;
    let [nine, ..] = han::plates();
    for degrees in [20.0_f64, 45.0, 70.0] {
        let square = nine.polygon.outer.clone();
        let island = planar::Polygon::simple(square);
        let core = Compound.infill(&island, &settings);
        let angle = degrees.to_radians();
        let scan = planar::scan::Scan::new(&core, angle, planar::scan::Spacing::AtMost(settings.stepover));
        let weave = beadwright::fill::zigzag::regions::Weave::new(&scan, settings.stepover);
        let corners: f64 = weave
            .paths(&weave.merged())
            .iter()
            .flat_map(|path| path.windows(3).map(|w| (w[0] - w[1]).angle_to(w[2] - w[1]).abs()))
            .map(|theta| r * r * (1.0 / (theta / 2.0).tan() + theta / 2.0 - std::f64::consts::FRAC_PI_2))
            .sum();
        let edges = angle::corner_area(&core, angle, &settings);
        println!("{degrees}°: {corners} {edges}");
        assert!((corners / edges - 1.0).abs() < 0.02, "{degrees}°: {corners} mm² by corners, {edges} mm² by edges");
    }
}
