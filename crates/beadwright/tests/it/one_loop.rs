//! One loop an island: invariants at any angle, closed forms, and what the loop is measured by.

use crate::common;

use beadwright::bead::{Bead, Law, Section};
use beadwright::deposit::{Figures, Judge};
use beadwright::fill::one_loop::squares::Squares;
use beadwright::fill::{Fill, FillSettings, Path, StrategyName};
use beadwright::layer::Layer;
use beadwright::planar::{DVec2, Join, Polygon, Region, Ring, polyline};
use beadwright::profile::Profile;
use beadwright::slice::Slicer;
use beadwright::task::Task;
use beadwright::{example, pass, plan};
use common::profile;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

fn lay(strategy: &str, island: &Polygon, settings: &FillSettings) -> Vec<Path> {
    let Fill { stages, .. } = strategy.parse::<StrategyName>().unwrap().strategy().fill(island, settings);
    stages.into_iter().flatten().collect()
}

fn looped(island: &Polygon, profile: &Profile) -> Vec<Path> {
    lay("loop", island, &profile.fill_settings(0))
}

fn slice(part: &str) -> Polygon {
    let mesh = example::find(part).unwrap().mesh();
    let slicer = Slicer::new(&mesh, profile("cmt-al2319-kuka").slice_options(), &Task::new()).unwrap();
    slicer.all(&Task::new()).unwrap().swap_remove(2).islands.swap_remove(0)
}

fn moved(island: &Polygon, place: impl Fn(DVec2) -> DVec2) -> Polygon {
    let ring = |ring: &Ring| Ring::new(ring.points().iter().map(|&p| place(p)).collect());
    Polygon { outer: ring(&island.outer), holes: island.holes.iter().map(ring).collect() }
}

fn turned(island: &Polygon, degrees: f64) -> Polygon {
    let way = DVec2::from_angle(degrees.to_radians());
    moved(island, |p| way.rotate(p))
}

fn circle(middle: (f64, f64), radius: f64, count: usize, way: f64) -> Ring {
    let place = |k: usize| DVec2::from(middle) + DVec2::from_angle(way * k as f64 / count as f64 * TAU) * radius;
    Ring::new((0..count).map(place).collect())
}

fn rectangle(low: (f64, f64), high: (f64, f64)) -> Ring {
    Ring::new([low, (high.0, low.1), high, (low.0, high.1)].map(DVec2::from).to_vec())
}

fn lifted(passes: &[Path], profile: &Profile) -> Vec<pass::Pass> {
    let (bead, law, speed) = (profile.bead(), &profile.bead.law, profile.process.deposition_speed);
    let lift = |path: &Path| pass::Pass {
        kind: path.kind,
        closed: path.closed,
        points: path.points.iter().map(|p| p.extend(2.0)).collect(),
        pace: path.width.map(|width| speed * law.pace(&bead, width)),
        width: path.width.clone(),
        wait: 0.0,
    };
    passes.iter().map(lift).collect()
}

fn judged(island: &Polygon, passes: &[Path], profile: &Profile) -> Figures {
    let (islands, passes) = (vec![island.clone()], lifted(passes, profile));
    Judge::new(plan::deposit_settings(profile)).layer(&Layer { islands, passes, ..Layer::default() }).figures
}

/// Where a disc of 1.4 bead widths fits.
fn open(island: &Polygon, profile: &Profile) -> Polygon {
    let r = 0.7 * profile.bead.width;
    let open = Region::from(island.clone()).offset(-r, Join::ROUND).offset(r, Join::ROUND);
    open.into_polygons().swap_remove(0)
}

fn to_boundary(island: &Polygon, p: DVec2) -> f64 {
    let edges = island.rings().flat_map(Ring::edges);
    edges.map(|(a, b)| polyline::distance_squared_to_segment(p, a, b)).fold(f64::INFINITY, f64::min).sqrt()
}

#[test]
fn parts_are_filled_by_one_arc_start_at_any_angle() {
    let profile = profile("cmt-al2319-kuka");
    // Overfill in %: points of a star are narrower than two beads.
    for (part, overfill) in [("cross", 1.5), ("star", 2.0), ("gear", 1.5), ("propeller", 1.5)] {
        let island = slice(part);
        for degrees in [0.0, 10.0, 37.0, 45.0] {
            let island = turned(&island, degrees);
            let passes = looped(&island, &profile);
            let case = format!("{part} turned by {degrees}°");
            assert_eq!(passes.len(), 1, "{case}");
            let figures = judged(&island, &passes, &profile);
            let open = judged(&open(&island, &profile), &passes, &profile).void_percent();
            assert!(open <= 0.15, "{case}: {open} % void where there is room for two beads");
            assert!(figures.void_percent() <= 0.3, "{case}: {} % void", figures.void_percent());
            assert!(figures.overfill_percent() <= overfill, "{case}: {} % overfill", figures.overfill_percent());
            assert!(figures.outside_percent() < 0.005, "{case}: {} % outside", figures.outside_percent());
        }
    }
}

#[test]
fn beads_keep_to_their_window_and_to_the_outline() {
    let profile = profile("cmt-al2319-kuka");
    let w = profile.bead.width;
    for part in ["cross", "star", "gear", "propeller"] {
        let island = turned(&slice(part), 23.0);
        for pass in looped(&island, &profile) {
            for (i, p) in pass.points.iter().enumerate() {
                let width = pass.width.after(i);
                assert!((0.8 * w - 1e-9..=1.3 * w + 1e-9).contains(&width), "{part}: {width} mm wide");
                assert!(
                    island.contains(*p) && to_boundary(&island, *p) >= width / 2.0 - 0.015 * w,
                    "{part}: {p} {} {width}",
                    to_boundary(&island, *p)
                );
            }
        }
    }
}

/// A bug once: edges that lay on a row of the lattice of distances were not seen from inside.
#[test]
fn outlines_a_whole_number_of_beads_wide_are_kept_to() {
    let island = slice("cross");
    let arm = 36.0;
    for beads in [4.0, 5.0, 6.0, 8.0, 9.0, 10.0, 12.0] {
        let mut profile = profile("cmt-al2319-kuka");
        let scale = arm / beads / profile.bead.width;
        (profile.bead.width, profile.bead.height) = (scale * profile.bead.width, scale * profile.bead.height);
        profile.layers.height *= scale;
        profile.fill.stepover = profile.fill.stepover.map(|stepover| scale * stepover);
        for degrees in [0.0, 90.0, 180.0, 270.0] {
            let island = turned(&island, degrees);
            let island = moved(&island, |p| (p * 1e6).round() / 1e6);
            for pass in looped(&island, &profile) {
                for (i, p) in pass.points.iter().enumerate() {
                    let (room, width) = (to_boundary(&island, *p), pass.width.after(i));
                    assert!(island.contains(*p) && room >= 0.485 * width, "{beads} beads: {p} {room} {width}");
                }
            }
        }
    }
}

/// A layer takes the metal of its area, less what its rounded rim lacks.
#[test]
fn loops_lay_the_metal_of_the_area() {
    let profile = profile("cmt-al2319-kuka");
    let (bead, law) = (profile.bead(), &profile.bead.law);
    let (w, d) = (bead.width, profile.stepover());
    let disc = Polygon::simple(circle((0.0, 0.0), 60.0, 400, 1.0));
    let plate = Polygon {
        outer: rectangle((0.0, 0.0), (160.0, 90.0)),
        holes: vec![circle((50.0, 45.0), 20.0, 120, -1.0), circle((115.0, 45.0), 25.0, 120, -1.0)],
    };
    for (name, island) in [("disc", disc), ("plate with two holes", plate)] {
        let passes = looped(&island, &profile);
        assert_eq!(passes.len(), 1, "{name}");
        let laid: f64 = lifted(&passes, &profile)
            .iter()
            .flat_map(|pass| pass.segments().collect::<Vec<_>>())
            .map(|s| s.length() * law.bead(&bead, s.width).area())
            .sum();
        // Cells end half the overlap before the outline.
        let cells = Region::from(island.clone()).offset(-(w - d) / 2.0, Join::ROUND).area() * bead.rise(d);
        assert!((laid / cells - 1.0).abs() < 0.03, "{name}: {laid} mm³ for {cells} mm³");
    }
}

#[test]
fn a_disc_is_a_spiral_with_metal_in_its_middle() {
    let profile = profile("cmt-al2319-kuka");
    for radius in [20.0, 31.0, 44.5, 58.0] {
        let island = Polygon::simple(circle((0.0, 0.0), radius, 300, 1.0));
        let passes = looped(&island, &profile);
        assert_eq!((passes.len(), passes[0].closed), (1, false), "{radius} mm");
        let void = judged(&island, &passes, &profile).void_percent();
        assert!(void < 0.3, "{radius} mm: {void} % void");
        let nearest = passes[0].points.iter().map(|p| p.length()).fold(f64::INFINITY, f64::min);
        assert!(nearest < 0.7 * profile.bead.width, "{radius} mm: nothing nearer to the middle than {nearest} mm");
    }
}

#[test]
fn a_part_may_lie_anywhere_and_a_quarter_turn_changes_nothing_that_counts() {
    let profile = profile("cmt-al2319-kuka");
    let (star, by) = (slice("star"), DVec2::new(1234.5, -771.25));
    let place = |datum: DVec2| FillSettings { datum, ..profile.fill_settings(3) };
    let (here, there) = (lay("loop", &star, &place(DVec2::ZERO)), lay("loop", &moved(&star, |p| p + by), &place(by)));
    assert_eq!(here.len(), there.len());
    for (a, b) in here.iter().zip(&there) {
        assert_eq!(a.points.len(), b.points.len());
        assert!(a.points.iter().zip(&b.points).all(|(p, q)| p.distance(*q - by) < 1e-6));
    }
    for part in ["cross", "star", "gear"] {
        let island = slice(part);
        let void = |island: &Polygon| {
            let passes = looped(island, &profile);
            (passes.len(), judged(island, &passes, &profile).void_percent())
        };
        let (before, after) = (void(&island), void(&turned(&island, 90.0)));
        assert_eq!(before.0, after.0, "{part}");
        // Flips may take other places of the same part, as good as the first.
        assert!((before.1 - after.1).abs() < 0.1, "{part}: {} and {} % void", before.1, after.1);
    }
}

#[test]
fn islands_of_many_kinds_have_one_arc_start() {
    let profile = profile("cmt-al2319-kuka");
    let comb = {
        let mut points = vec![(0.0, 0.0), (174.0, 0.0)];
        for tooth in (0..6).rev() {
            let x = 30.0 * f64::from(tooth);
            points.extend([(x + 24.0, 60.0), (x, 60.0)]);
            if tooth > 0 {
                points.extend([(x, 24.0), (x - 6.0, 24.0)]);
            }
        }
        Polygon::simple(Ring::new(points.into_iter().map(DVec2::from).collect()))
    };
    let sieve = Polygon {
        outer: rectangle((0.0, 0.0), (200.0, 150.0)),
        holes: (0..12)
            .map(|k| circle((30.0 + 46.0 * f64::from(k % 4), 30.0 + 45.0 * f64::from(k / 4)), 9.0, 40, -1.0))
            .collect(),
    };
    let dumb_bell = {
        let bodies = [rectangle((0.0, 0.0), (50.0, 50.0)), rectangle((90.0, 0.0), (140.0, 50.0))];
        let neck = rectangle((40.0, 17.0), (100.0, 32.0));
        let whole = bodies
            .into_iter()
            .chain([neck])
            .fold(Region::default(), |region, ring| region.union(&Polygon::simple(ring).into()));
        whole.into_polygons().swap_remove(0)
    };
    for (name, island) in [("comb", comb), ("sieve", sieve), ("dumb-bell", dumb_bell)] {
        for layer in 0..3 {
            let passes = lay("loop", &island, &profile.fill_settings(layer));
            assert_eq!(passes.len(), 1, "{name}, layer {layer}");
            let void = judged(&island, &passes, &profile).void_percent();
            assert!(void < 0.7, "{name}, layer {layer}: {void} % void");
        }
    }
}

#[test]
fn flips_lie_elsewhere_on_the_next_layer() {
    let profile = profile("cmt-al2319-kuka");
    let plate = Polygon::simple(rectangle((0.0, 0.0), (150.0, 110.0)));
    let way = |layer: usize| {
        let settings = FillSettings { layer, ..profile.fill_settings(layer) };
        let mut options = settings;
        options.one_loop.spirals = false;
        lay("loop", &plate, &options).swap_remove(0).points
    };
    let (first, second) = (way(0), way(1));
    let far = |p: &&DVec2| first.iter().all(|q| q.distance(**p) > profile.stepover() / 3.0);
    assert!(second.iter().filter(far).count() > 4, "both layers are joined at the same places");
}

#[test]
fn thin_walls_are_welded_by_every_solid_strategy_and_tied_in() {
    let profile = profile("cmt-al2319-kuka");
    // A block of 60 mm with a fin of 6 mm, under a bead of 7.54 mm.
    let outline =
        [(0.0, 0.0), (60.0, 0.0), (60.0, 27.0), (120.0, 27.0), (120.0, 33.0), (60.0, 33.0), (60.0, 60.0), (0.0, 60.0)];
    let island = Polygon::simple(Ring::new(outline.map(DVec2::from).to_vec()));
    for strategy in ["loop", "contour", "compound", "zigzag", "hybrid"] {
        let passes = lay(strategy, &island, &profile.fill_settings(0));
        let on_fin = |pass: &Path| {
            let path = pass.path();
            let pieces = path.windows(2).enumerate().map(|(i, w)| {
                let within = (w[0].x.max(w[1].x).min(115.0) - w[0].x.min(w[1].x).max(75.0)).max(0.0);
                if within > 0.0 {
                    let (off, width) = ((w[0].y - 30.0).abs(), pass.width.after(i));
                    assert!(off < 0.1 && (width - 6.0).abs() < 0.2, "{strategy}: {width} mm wide, {off} mm off");
                }
                within
            });
            pieces.sum::<f64>()
        };
        let length: f64 = passes.iter().map(on_fin).sum();
        assert!((30.0..45.0).contains(&length), "{strategy}: {length} mm along the fin");
        // Contours that the hybrid cuts are open already: there a wall of its own costs nothing.
        let carrier = passes.iter().find(|pass| on_fin(pass) > 0.0).unwrap();
        let tied = strategy == "hybrid" || carrier.points.iter().any(|p| p.x < 55.0);
        assert!(tied, "{strategy}: the fin is a pass of its own");
    }
    // A ring of 6 mm all around is one closed bead.
    let ring = Polygon { outer: circle((0.0, 0.0), 50.0, 200, 1.0), holes: vec![circle((0.0, 0.0), 44.0, 200, -1.0)] };
    for strategy in ["loop", "contour", "compound", "zigzag", "hybrid"] {
        let passes = lay(strategy, &ring, &profile.fill_settings(0));
        assert_eq!(passes.len(), 1, "{strategy}");
        assert!((passes[0].length() - TAU * 47.0).abs() < 8.0, "{strategy}: {} mm", passes[0].length());
    }
}

#[test]
fn programs_have_one_arc_start_a_layer_and_what_does_not_outlast_it_is_left_out() {
    let profile = profile("cmt-al2319-kuka");
    let mesh = example::find("propeller").unwrap().mesh();
    let plan = plan::plan("propeller", &mesh, &profile, &Task::new()).unwrap();
    assert_eq!(plan.header.strategy, "loop", "the default");
    assert_eq!(plan.summary.metrics.arc_starts, plan.layers.len());
    for strategy in ["contour", "hybrid", "raster", "zigzag", "compound"] {
        let mut profile = profile.clone();
        profile.fill.strategy = strategy.parse().unwrap();
        let star = example::find("star").unwrap().mesh();
        let plan = plan::plan("star", &star, &profile, &Task::new()).unwrap();
        // These programs stand still until the arc burns: any pass that is long enough is laid.
        let shortest = plan.layers.iter().flat_map(|l| &l.passes).map(|p| p.length()).fold(f64::INFINITY, f64::min);
        assert!(shortest >= profile.fill.min_pass_length, "{strategy}: a pass of {shortest} mm");
        // Programs that leave at once lay no pass that is over before.
        profile.dialects.krl.as_mut().unwrap().arc_on = vec!["$OUT[2] = TRUE".to_owned()];
        let plan = plan::plan("star", &star, &profile, &Task::new()).unwrap();
        let soonest = profile.process.arc_start_delay;
        let least = plan.summary.metrics.shortest_arc_s.unwrap();
        assert!(least >= soonest, "{strategy}: an arc of {least} s");
    }
}

#[test]
fn noise_of_the_width_does_little() {
    let profile = profile("cmt-al2319-kuka");
    let w = profile.bead.width;
    for part in ["cross", "gear", "propeller"] {
        let island = slice(part);
        let mut passes = looped(&island, &profile);
        // A sum of waves of 2 to 5 w, as large as a noise of 5 %.
        for pass in &mut passes {
            let lengths: Vec<f64> = pass.path().windows(2).map(|w| w[0].distance(w[1])).collect();
            let mut along = 0.0;
            let widths = lengths.iter().enumerate().map(|(i, length)| {
                along += length;
                let waves = [2.0, 3.1, 4.7].map(|wave| (TAU * along / (wave * w)).sin()).iter().sum::<f64>();
                pass.width.after(i) * (1.0 + 0.05 * waves * (2.0_f64 / 3.0).sqrt())
            });
            let mut widths: Vec<f64> = widths.collect();
            widths.resize(pass.points.len(), w);
            pass.width = pass::Along::Each(widths);
        }
        let figures = judged(&island, &passes, &profile);
        assert!(figures.void_percent() <= 0.25, "{part}: {} % void", figures.void_percent());
        assert!(figures.overfill_percent() <= 3.0, "{part}: {} % overfill", figures.overfill_percent());
    }
}

#[test]
fn sections_have_the_areas_of_geometry_books() {
    let (w, h) = (6.0, 2.0);
    assert!((Section::Parabola.area(w, h) - 8.0).abs() < 1e-12);
    assert!((Section::Ellipse.area(w, h) - PI * w * h / 4.0).abs() < 1e-12);
    // A box between two half circles of diameter h.
    assert!((Section::Stadium.area(w, h) - ((w - h) * h + PI * h * h / 4.0)).abs() < 1e-12);
    for section in [Section::Parabola, Section::Ellipse, Section::Stadium] {
        for (w, h) in [(6.0, 2.0), (2.0, 2.0), (1.5, 4.0), (0.4, 0.2)] {
            let area = section.area(w, h);
            assert!((section.height_of(w, area) - h).abs() < 1e-9, "{section:?}");
            assert!((section.width_of(h, area) - w).abs() < 1e-9, "{section:?}");
        }
    }
}

#[test]
fn laws_keep_the_metal() {
    let library = Law::Library(vec![[4.0, 1.8], [6.0, 2.2], [9.0, 2.4]]);
    for section in [Section::Parabola, Section::Ellipse, Section::Stadium] {
        let nominal = Bead { width: 6.0, height: 2.2, section };
        for law in [Law::ConstantHeight, Law::ConstantRatio, library.clone()] {
            for width in [4.5, 6.0, 7.7] {
                let bead = law.bead(&nominal, width);
                assert!((law.pace(&nominal, width) * bead.area() - nominal.area()).abs() < 1e-9, "{law:?}");
                assert!((law.width_of_area(&nominal, bead.area()) - width).abs() < 1e-6, "{law:?} {section:?}");
            }
        }
    }
    let nominal = Bead::parabola(6.0, 2.2);
    assert!((Law::ConstantRatio.pace(&nominal, 12.0) - 0.25).abs() < 1e-12, "twice as wide is a quarter of the speed");
    assert!((library.bead(&nominal, 7.5).height - 2.3).abs() < 1e-12, "halfway between two measured beads");
}

/// The height of a start hump and the depth of a crater are what the profile says, over the lengths that it says.
#[test]
fn starts_stand_up_and_ends_sink() {
    let mut profile = profile("cmt-al2319-kuka");
    let line = pass::Pass {
        kind: pass::PassKind::Contour,
        closed: false,
        points: vec![glam::DVec3::new(0.0, 0.0, 2.0), glam::DVec3::new(100.0, 0.0, 2.0)],
        pace: pass::Along::Same(profile.process.deposition_speed),
        width: pass::Along::Same(profile.bead.width),
        wait: 0.0,
    };
    let layer = Layer { passes: vec![line], ..Layer::default() };
    let metal = |profile: &Profile| {
        let bead = profile.bead();
        let time = |s: pass::Segment| s.length() / s.pace;
        plan::welded(&layer, profile).passes[0].segments().map(time).sum::<f64>()
            * bead.area()
            * profile.process.deposition_speed
    };
    let plain = metal(&profile);
    (profile.start_stop.hump_height, profile.start_stop.hump_length) = (1.0, 20.0);
    // A wedge on a parabola: two thirds of its width, half its length.
    let hump = metal(&profile) - plain;
    assert!((hump - 2.0 / 3.0 * profile.bead.width * 1.0 * 20.0 / 2.0).abs() < 1e-6 * plain, "{hump} mm³");
    (profile.start_stop.crater_depth, profile.start_stop.crater_length) = (1.0, 10.0);
    let crater = metal(&profile) - plain - hump;
    assert!((crater + 2.0 / 3.0 * profile.bead.width * 1.0 * 10.0 / 2.0).abs() < 1e-6 * plain, "{crater} mm³");
}

#[test]
fn a_quarter_turn_of_a_square_is_the_square() {
    // What symmetric islands get must not depend on which way they are looked at.
    let profile = profile("cmt-al2319-kuka");
    let square = Polygon::simple(rectangle((-40.0, -40.0), (40.0, 40.0)));
    let length = |island: &Polygon| looped(island, &profile).iter().map(Path::length).sum::<f64>();
    let way = DVec2::from_angle(FRAC_PI_2);
    let (a, b) = (length(&square), length(&moved(&square, |p| way.rotate(p))));
    assert!((a / b - 1.0).abs() < 0.01, "{a} and {b} mm");
}

/// Where a hole comes as near to the rim as one thin bead, that bead is laid once, with the same single arc start.
#[test]
fn a_neck_beside_a_hole_has_one_bead() {
    let profile = profile("cmt-al2319-kuka");
    for neck in [3.9, 4.2, 4.5, 4.8, 5.1, 5.6] {
        for degrees in [0.0, 33.0, 117.0] {
            let hole = circle((0.0, neck - 33.0), 42.0, 48, -1.0);
            let island =
                turned(&Polygon { outer: rectangle((-60.0, -75.0), (60.0, 75.0)), holes: vec![hole] }, degrees);
            let passes = looped(&island, &profile);
            let place = format!("a neck of {neck} mm, turned by {degrees}°");
            assert_eq!(passes.len(), 1, "{place}");
            let middle = DVec2::from_angle(f64::to_radians(degrees)).rotate(DVec2::new(0.0, -75.0 + neck / 2.0));
            let (half, way) = (DVec2::from_angle(f64::to_radians(degrees + 90.0)) * neck, passes[0].path());
            let across = |ends: &[DVec2]| {
                let (u, v, w) = (2.0 * half, ends[1] - ends[0], ends[0] - (middle - half));
                let [t, s] = [w.perp_dot(v), w.perp_dot(u)].map(|x| x / u.perp_dot(v));
                (0.0..1.0).contains(&t) && (0.0..1.0).contains(&s)
            };
            assert_eq!(way.windows(2).filter(|ends| across(ends)).count(), 1, "{place}");
        }
    }
}

#[test]
fn squares_find_every_point_near_a_place() {
    // Points in no order, from −1 to 1 times 50 mm; some places lie far beyond them.
    let part = |k: usize, by: f64| 100.0 * (k as f64 * by).fract() - 50.0;
    let points: Vec<DVec2> = (0..500).map(|k| DVec2::new(part(k, 0.618_034), part(k, 0.754_878))).collect();
    let places = (0..200).map(|k| DVec2::new(part(k, 0.414_214), part(k, 0.732_051)) * 1.3);
    for side in [3.0, 11.0, 400.0] {
        let squares = Squares::of(&points, side);
        for place in places.clone() {
            let mut found: Vec<usize> = squares.near(place).collect();
            found.sort_unstable();
            assert!(found.windows(2).all(|pair| pair[0] < pair[1]), "none twice");
            let far = |i: &usize| (points[*i] - place).abs().max_element() >= 2.0 * side;
            assert!(!found.iter().any(far), "{place} with squares of {side} mm");
            let near = |i: &usize| points[*i].distance(place) <= side;
            assert!((0..points.len()).filter(near).all(|i| found.contains(&i)), "{place} with squares of {side} mm");
        }
    }
    assert_eq!(Squares::of(&[], 3.0).near(DVec2::ZERO).count(), 0);
}
