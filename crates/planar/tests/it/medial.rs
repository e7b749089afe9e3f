//! The medial axis: closed forms, what makes a disc a largest one (by brute force), and the same shape described
//! otherwise.

use crate::shapes;

use planar::medial::{Branch, CORNER, MedialAxis, MedialOptions, Node};
use planar::polyline::distance_squared_to_segment;
use planar::{DVec2, Join, Polygon, Region, Ring};
use proptest::prelude::*;
use shapes::{config, distance_to_boundary, map_points, plate, same_shapes, star, three_holes, v};
use std::f64::consts::{FRAC_1_SQRT_2, SQRT_2, TAU};

/// Where closed forms are concerned: the grid of the crate, 0.1 µm, and a little geometry on top.
const GRID: f64 = 5e-4;

fn axis(region: &Region) -> MedialAxis {
    MedialAxis::of_region(region, &MedialOptions::default())
}

fn polygon(points: &[(f64, f64)]) -> Region {
    Polygon::simple(Ring::new(points.iter().map(|&(x, y)| v(x, y)).collect())).into()
}

/// A ring along `f` for t from 0 to 1.
fn sampled(count: usize, f: impl Fn(f64) -> DVec2) -> Vec<DVec2> {
    (0..count).map(|i| f(i as f64 / count as f64)).collect()
}

fn circle(radius: f64, count: usize) -> Ring {
    Ring::new(sampled(count, |t| radius * DVec2::from_angle(t * TAU)))
}

/// All nodes, those of junctions included.
fn nodes(axis: &MedialAxis) -> impl Iterator<Item = Node> + '_ {
    axis.branches.iter().flat_map(|b| b.nodes.iter().copied()).chain(axis.junctions.iter().copied())
}

/// Distance from `p` to the curves.
fn distance_to(axis: &MedialAxis, p: DVec2) -> f64 {
    let segments = axis.branches.iter().flat_map(|b| b.nodes.windows(2)).map(|w| (w[0].at, w[1].at));
    let points = axis.junctions.iter().map(|j| (j.at, j.at));
    segments.chain(points).map(|(a, b)| distance_squared_to_segment(p, a, b)).fold(f64::INFINITY, f64::min).sqrt()
}

/// Largest distance of a node of one axis from the other.
fn hausdorff(a: &MedialAxis, b: &MedialAxis) -> f64 {
    let one_way = |a: &MedialAxis, b| nodes(a).map(|n| distance_to(b, n.at)).fold(0.0, f64::max);
    one_way(a, b).max(one_way(b, a))
}

/// The widest angle between two places that the disc touches, by brute force.
fn object_angle(region: &Region, node: Node) -> f64 {
    let foot =
        |(a, b): (DVec2, DVec2)| a.lerp(b, ((node.at - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0));
    let feet: Vec<DVec2> = region.rings().flat_map(Ring::edges).map(foot).collect();
    let touching = || feet.iter().filter(|f| f.distance(node.at) < node.radius + 1e-3).map(|&f| f - node.at);
    touching().flat_map(|u| touching().map(move |w| u.angle_to(w).abs())).fold(0.0, f64::max)
}

/// Pieces that hang together, and loops.
fn pieces_and_loops(axis: &MedialAxis) -> (usize, usize) {
    let mut piece: Vec<usize> = (0..axis.junctions.len()).collect();
    for branch in axis.branches.iter().cycle().take(axis.branches.len() * axis.junctions.len()) {
        let least = piece[branch.from].min(piece[branch.to]);
        (piece[branch.from], piece[branch.to]) = (least, least);
    }
    let pieces = piece.iter().enumerate().filter(|&(i, &p)| i == p).count();
    (pieces, axis.branches.len() + pieces - axis.junctions.len())
}

/// What holds for every medial axis; `every` node is looked at one by one.
fn check(region: &Region, axis: &MedialAxis, every: usize) -> Result<(), TestCaseError> {
    for branch in &axis.branches {
        prop_assert!(branch.nodes.len() > 1 && branch.nodes.windows(2).all(|w| w[0].at != w[1].at));
        prop_assert_eq!(branch.nodes[0], axis.junctions[branch.from]);
        prop_assert_eq!(branch.nodes[branch.nodes.len() - 1], axis.junctions[branch.to]);
    }
    for node in nodes(axis).step_by(every) {
        prop_assert!((distance_to_boundary(region, node.at) - node.radius).abs() < 2e-4, "{:?}", node);
        prop_assert!(node.radius < 1e-3 || region.contains(node.at), "outside: {:?}", node);
        prop_assert!(node.radius < 0.05 || object_angle(region, node) > 0.02, "touches once: {:?}", node);
    }
    let holes: usize = region.polygons().iter().map(|p| p.holes.len()).sum();
    prop_assert_eq!(pieces_and_loops(axis), (region.polygons().len(), holes));
    Ok(())
}

fn checked(region: &Region) -> MedialAxis {
    let axis = axis(region);
    check(region, &axis, 1).unwrap();
    check(region, &axis.clone().pruned(CORNER), 1).unwrap();
    axis
}

fn junction_near(axis: &MedialAxis, at: DVec2) -> Node {
    *axis.junctions.iter().min_by(|a, b| a.at.distance(at).total_cmp(&b.at.distance(at))).unwrap()
}

/// A junction at `at` with `radius`, both within the grid.
fn assert_junction(axis: &MedialAxis, at: DVec2, radius: f64, degree: usize) {
    let index = axis.junctions.iter().position(|j| *j == junction_near(axis, at)).unwrap();
    let junction = axis.junctions[index];
    assert!(junction.at.distance(at) < GRID && (junction.radius - radius).abs() < GRID, "{junction:?} for {at}");
    assert_eq!(axis.degrees()[index], degree, "at {at}");
}

/// How far the nodes of an axis lie from a curve that is known as a function of the place.
fn worst(axis: &MedialAxis, error: impl Fn(Node) -> f64) -> f64 {
    nodes(axis).map(|n| error(n).abs()).fold(0.0, f64::max)
}

#[test]
fn a_rectangle_has_its_middle_line_and_four_corners() {
    for (w, h) in [(20.0, 6.0), (100.0, 0.5), (7.0, 6.9)] {
        let axis = checked(&plate(w, h, &[]));
        assert_eq!(axis.branches.len(), 5);
        assert_junction(&axis, v(h / 2.0, h / 2.0), h / 2.0, 3);
        assert_junction(&axis, v(w - h / 2.0, h / 2.0), h / 2.0, 3);
        assert!((axis.length() - (w - h + 2.0 * SQRT_2 * h)).abs() < GRID);
        let slope = |b: &Branch| (b.nodes[0].radius - b.nodes[b.nodes.len() - 1].radius).abs() / b.length();
        let corners: Vec<f64> = axis.branches.iter().map(slope).filter(|&s| s > 1e-6).collect();
        assert!(corners.len() == 4 && corners.iter().all(|s| (s - FRAC_1_SQRT_2).abs() < GRID), "{corners:?}");

        let middle = axis.pruned(CORNER);
        assert_eq!((middle.branches.len(), middle.junctions.len()), (1, 2));
        assert!((middle.length() - (w - h)).abs() < GRID);
        assert!(worst(&middle, |n| n.at.y - h / 2.0) < GRID && worst(&middle, |n| n.radius - h / 2.0) < GRID);
    }
}

#[test]
fn a_square_and_a_triangle_shrink_to_their_middle() {
    let square = checked(&plate(8.0, 8.0, &[]));
    assert_eq!(square.branches.len(), 4);
    assert_junction(&square, v(4.0, 4.0), 4.0, 4);
    assert!((square.length() - 16.0 * SQRT_2).abs() < GRID);

    let height = 3_f64.sqrt() / 2.0 * 10.0;
    let triangle = checked(&polygon(&[(0.0, 0.0), (10.0, 0.0), (5.0, height)]));
    assert_eq!(triangle.branches.len(), 3);
    assert_junction(&triangle, v(5.0, height / 3.0), height / 3.0, 3);
    assert!((triangle.length() - 2.0 * height).abs() < GRID);

    for axis in [square, triangle] {
        let point = axis.pruned(CORNER);
        assert_eq!((point.branches.len(), point.junctions.len()), (0, 1));
    }
}

#[test]
fn an_l_bends_along_two_parabolas() {
    // Arms of width 4 and length 20: between the inner corner (4, 4) and the outer edges run parabolas.
    let l = polygon(&[(0.0, 0.0), (20.0, 0.0), (20.0, 4.0), (4.0, 4.0), (4.0, 20.0), (0.0, 20.0)]);
    let axis = checked(&l);
    let elbow = 4.0 * SQRT_2 / (1.0 + SQRT_2);
    assert_junction(&axis, v(elbow, elbow), elbow, 3);
    let line = axis.pruned(CORNER);
    assert_eq!(line.branches.len(), 1);
    let off = |n: Node| if n.at.x > n.at.y { (n.at, n.radius) } else { (v(n.at.y, n.at.x), n.radius) };
    let error = |n: Node| {
        let (p, radius) = off(n);
        let y = if p.x > 4.0 { 2.0 } else { 2.0 + (p.x - 4.0).powi(2) / 8.0 };
        (p.y - y).abs().max((radius - y).abs())
    };
    assert!(worst(&line, error) < GRID, "{}", worst(&line, error));
    assert_junction(&line, v(18.0, 2.0), 2.0, 1);
}

#[test]
fn a_t_and_a_cross_meet_where_they_must() {
    // Bar of width 4, y from 0 to 4, stem of width 4 up from its middle: the disc at the foot of the stem touches
    // both inner corners (±2, 4) and the lower edge, so r = y and (4 − r)² + 4 = r².
    let t = polygon(&[
        (-20.0, 0.0),
        (20.0, 0.0),
        (20.0, 4.0),
        (2.0, 4.0),
        (2.0, 20.0),
        (-2.0, 20.0),
        (-2.0, 4.0),
        (-20.0, 4.0),
    ]);
    let axis = checked(&t).pruned(CORNER);
    assert_eq!(axis.branches.len(), 3);
    assert_junction(&axis, v(0.0, 2.5), 2.5, 3);
    assert_junction(&axis, v(0.0, 18.0), 2.0, 1);

    let arms = [(20.0, -2.0), (20.0, 2.0), (2.0, 2.0)].map(|(x, y)| v(x, y));
    let corners = (0..4).flat_map(|k| arms.map(|p| DVec2::from_angle(f64::from(k) * TAU / 4.0).rotate(p)));
    let cross = checked(&Polygon::simple(Ring::new(corners.collect())).into()).pruned(CORNER);
    assert_eq!(cross.branches.len(), 4);
    assert_junction(&cross, DVec2::ZERO, 2.0 * SQRT_2, 4);
    assert!((cross.length() - 72.0).abs() < GRID);
}

#[test]
fn an_annulus_has_a_circle() {
    let ring = Polygon { outer: circle(15.0, 2000), holes: vec![circle(11.5, 1500).reversed()] };
    let axis = checked(&ring.into());
    assert_eq!((axis.branches.len(), axis.junctions.len()), (1, 1));
    assert!(axis.branches[0].is_closed());
    assert!(worst(&axis, |n| n.radius - 1.75) < 1e-3 && worst(&axis, |n| n.at.length() - 13.25) < 1e-3);
    assert!((axis.length() - 13.25 * TAU).abs() < 0.01);
    assert_eq!(axis.clone().pruned(CORNER).length(), axis.length());
}

#[test]
fn a_disc_has_a_point() {
    for count in [12, 64, 1001] {
        let axis = checked(&Polygon::simple(circle(10.0, count)).into());
        assert_eq!((axis.branches.len(), axis.junctions.len()), (0, 1), "{count}");
        assert!(axis.junctions[0].at.length() < 1e-3);
    }
}

#[test]
fn a_bent_wall_keeps_its_thickness() {
    // An arc of 120° with radius 60 and thickness 3.5; the ends square or round.
    let along =
        |count: usize, f: &dyn Fn(f64) -> DVec2| (0..=count).map(|i| f(i as f64 / count as f64)).collect::<Vec<_>>();
    let arc = |radius: f64| move |t: f64| radius * DVec2::from_angle(t * TAU / 3.0);
    let cap = |angle: f64, flip: f64| {
        let middle = DVec2::from_angle(angle);
        move |t: f64| 60.0 * middle + flip * 1.75 * middle.rotate(DVec2::from_angle(t * TAU / 2.0))
    };
    let outer = along(200, &arc(61.75));
    let inner: Vec<DVec2> = along(170, &arc(58.25)).into_iter().rev().collect();
    let square = [outer.clone(), inner.clone()].concat();
    let round = [outer, along(40, &cap(TAU / 3.0, 1.0)), inner, along(40, &cap(0.0, -1.0))].concat();
    let whole = TAU / 3.0 * 60.0;
    for (ring, length, slack) in [(square, whole - 3.5, 0.05), (round, whole, 0.01)] {
        let region = Region::from_rings(&[Ring::new(ring)], planar::FillRule::NonZero);
        let line = checked(&region).pruned(CORNER);
        assert_eq!(line.branches.len(), 1);
        let off = worst(&line, |n| n.at.length() - 60.0);
        let thick = worst(&line, |n| n.radius / 1.75 - 1.0);
        let found = line.length();
        println!("bent wall: off by {off:.5} mm, thickness by {:.3} %, length {found:.4}", 100.0 * thick);
        assert!(off < 0.01 && thick < 0.005);
        assert!((found - length).abs() < slack, "{found} for {length}");
    }
}

#[test]
fn an_ellipse_ends_at_its_centres_of_curvature() {
    let (a, b) = (30.0, 5.0);
    let ellipse = Polygon::simple(Ring::new(sampled(1500, |t| v(a * (t * TAU).cos(), b * (t * TAU).sin()))));
    let axis = checked(&ellipse.into());
    assert_eq!(axis.branches.len(), 1);
    let reach = a - b * b / a;
    let radius = |x: f64| b * (1.0 - x * x / (a * a - b * b)).sqrt();
    assert!(worst(&axis, |n| n.at.y) < 0.01 && worst(&axis, |n| n.radius - radius(n.at.x)) < 0.01);
    assert!(axis.length() < 2.0 * reach && axis.length() > 2.0 * reach - 1.0, "{}", axis.length());
}

#[test]
fn a_plate_has_a_loop_round_every_hole() {
    let axis = checked(&three_holes());
    let pruned = axis.pruned(CORNER);
    assert_eq!(pieces_and_loops(&pruned), (1, 3));
    for degrees in [1.0, 30.0, 45.0, 117.0, 200.0] {
        let turn = DVec2::from_angle(f64::to_radians(degrees));
        let mut back = self::axis(&map_points(&three_holes(), |p| turn.rotate(p))).pruned(CORNER);
        let every = back.branches.iter_mut().flat_map(|b| &mut b.nodes).chain(&mut back.junctions);
        every.for_each(|n| n.at = v(turn.x, -turn.y).rotate(n.at));
        assert_same(&pruned, &back).unwrap();
    }
}

#[test]
fn slanted_ends_go_and_sharp_edges_stay() {
    let slanted = checked(&polygon(&[(0.0, 0.0), (30.0, 0.0), (26.0, 4.0), (0.0, 4.0)])).pruned(CORNER);
    let end = junction_near(&slanted, v(30.0, 0.0));
    assert!(slanted.branches.len() == 1 && (end.radius - 2.0).abs() < GRID, "{end:?}");
    let edge = checked(&polygon(&[(0.0, -2.0), (20.0, -2.0), (40.0, 0.0), (20.0, 2.0), (0.0, 2.0)])).pruned(CORNER);
    assert!(edge.branches.len() == 1 && junction_near(&edge, v(40.0, 0.0)).at == v(40.0, 0.0));
}

#[test]
fn what_touches_itself_or_is_next_to_nothing_does_no_harm() {
    let touching_hole = Polygon {
        outer: Ring::new(vec![v(0.0, 0.0), v(17.0, 3.0), v(14.0, 20.0), v(-3.0, 17.0)]),
        holes: vec![Ring::new(vec![v(8.5, 1.5), v(6.0, 8.0), v(9.0, 9.0)])],
    };
    let two_holes = Polygon {
        outer: Ring::new(vec![v(0.0, 0.0), v(20.0, 0.0), v(20.0, 20.0), v(0.0, 20.0)]),
        holes: vec![
            Ring::new(vec![v(5.0, 5.0), v(10.0, 10.0), v(12.0, 5.0)]),
            Ring::new(vec![v(10.0, 10.0), v(15.0, 16.0), v(8.0, 15.0)]),
        ],
    };
    for polygon in [touching_hole, two_holes] {
        let region = Region::from_rings(&polygon.rings().cloned().collect::<Vec<_>>(), planar::FillRule::EvenOdd);
        let axis = axis(&region);
        assert!(
            axis.length() > 10.0 && nodes(&axis).all(|n| (distance_to_boundary(&region, n.at) - n.radius).abs() < 3e-3)
        );
    }
    let nothing = [
        vec![],
        vec![(0.0, 0.0)],
        vec![(0.0, 0.0), (1.0, 1.0)],
        vec![(0.0, 0.0), (1.0, 1.0), (2.0, 2.0)],
        vec![(0.0, 0.0), (1.0, f64::NAN), (f64::INFINITY, 2.0)],
        vec![(0.0, 0.0), (1e-4, 0.0), (0.0, 1e-4)],
        vec![(0.0, 0.0), (1e9, 0.0), (0.0, 1e9)],
    ];
    for points in nothing {
        let options = MedialOptions { spacing: 100.0, ..MedialOptions::default() };
        let _ = MedialAxis::of_region(&polygon(&points), &options).pruned(CORNER);
    }
    for (spacing, min_angle) in [(0.0, 0.0), (f64::NAN, 0.1), (-1.0, 4.0), (1e9, -1.0), (1e-9, 1.0)] {
        MedialAxis::of_region(&plate(0.2, 0.1, &[]), &MedialOptions { spacing, min_angle });
    }
}

#[test]
fn a_sliver_keeps_its_length() {
    let sliver = checked(&polygon(&[(0.0, 0.0), (50.0, 0.0), (50.0, 0.002), (0.0, 0.001)])).pruned(CORNER);
    assert!((sliver.length() - 50.0).abs() < 0.01, "{}", sliver.length());
}

/// A noisy outline of `count` vertices, as from a scan: a star with lobes and 20 µm of noise.
fn outline(count: usize) -> Region {
    let noise = |i: usize| 0.02 * ((i as f64 * 12.9898).sin() * 43758.5453).fract();
    let radius = |i: usize, t: f64| 60.0 + 25.0 * (5.0 * t * TAU).sin() + 4.0 * (31.0 * t * TAU).sin() + noise(i);
    let at = |i: usize| (i, i as f64 / count as f64);
    let point = |(i, t): (usize, f64)| radius(i, t) * DVec2::from_angle(t * TAU);
    Polygon::simple(Ring::new((0..count).map(|i| point(at(i))).collect())).into()
}

#[test]
fn many_vertices_make_no_trouble() {
    for count in [1_000, 5_000, 20_000] {
        let region = outline(count);
        let start = std::time::Instant::now();
        let raw = axis(&region);
        let made = start.elapsed();
        let pruned = raw.clone().pruned(CORNER);
        println!(
            "{count} vertices: {:.1} ms, pruning {:.1} ms; {} branches, {} pruned",
            made.as_secs_f64() * 1e3,
            (start.elapsed() - made).as_secs_f64() * 1e3,
            raw.branches.len(),
            pruned.branches.len()
        );
        check(&region, &raw, count / 100).unwrap();
    }
    let disc: Region = Polygon::simple(circle(50.0, 20_000)).into();
    let start = std::time::Instant::now();
    let point = axis(&disc);
    println!("disc of 20000: {:.1} ms", start.elapsed().as_secs_f64() * 1e3);
    assert!(point.length() < 0.01 && point.junctions[0].at.length() < 0.01, "{:?}", point.junctions);
}

/// The same region with every edge cut in three.
fn with_split_edges(region: &Region) -> Region {
    let ring = |r: &Ring| Ring::new(r.edges().flat_map(|(a, b)| [a, a.lerp(b, 0.3), a.lerp(b, 0.55)]).collect());
    let polygon = |p: &Polygon| Polygon { outer: ring(&p.outer), holes: p.holes.iter().map(ring).collect() };
    Region::from_normalised(region.polygons().iter().map(polygon).collect())
}

/// Whether both are the same curves, up to chords across parabolas and where noise is cut off.
fn assert_same(a: &MedialAxis, b: &MedialAxis) -> Result<(), TestCaseError> {
    prop_assert!(hausdorff(a, b) < 0.03, "{} mm apart", hausdorff(a, b));
    prop_assert!((a.length() - b.length()).abs() < 0.002 * a.length() + 0.05, "{} and {} mm", a.length(), b.length());
    Ok(())
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn any_star_with_holes_has_one(region in star()) {
        let axis = axis(&region);
        check(&region, &axis, 3)?;
        let pruned = axis.pruned(CORNER);
        check(&region, &pruned, 3)?;
    }

    #[test]
    fn the_discs_fill_the_shape(region in star(), x in -1.0..1.0, y in -1.0..1.0) {
        let axis = MedialAxis::of_region(&region, &MedialOptions { min_angle: 0.1, ..MedialOptions::default() });
        let box_ = region.bounds().unwrap();
        let p = box_.center() + v(x, y) * box_.size() / 2.0;
        if !region.contains(p) {
            return Ok(());
        }
        let reached = nodes(&axis).map(|n| n.radius - n.at.distance(p)).fold(f64::NEG_INFINITY, f64::max);
        prop_assert!(reached > -0.03, "{} is {} mm outside all discs", p, -reached);
    }

    #[test]
    fn it_moves_with_the_shape(region in star(), turn in 0.0..TAU, x in -300.0..300.0, y in -300.0..300.0) {
        let there = |p: DVec2| DVec2::from_angle(turn).rotate(p) + v(x, y);
        let moved = axis(&map_points(&region, there));
        let mut expected = axis(&region);
        let every = expected.branches.iter_mut().flat_map(|b| &mut b.nodes).chain(&mut expected.junctions);
        every.for_each(|n| n.at = there(n.at));
        assert_same(&moved, &expected)?;
    }

    #[test]
    fn it_does_not_depend_on_the_description(region in star()) {
        let found = axis(&region);
        assert_same(&found, &axis(&with_split_edges(&region)))?;
        let [turned, mirrored, restarted, reordered] = same_shapes(&region).map(|r| axis(&r));
        let moved = |f: fn(DVec2) -> DVec2| {
            let mut axis = found.clone();
            let every = axis.branches.iter_mut().flat_map(|b| &mut b.nodes).chain(&mut axis.junctions);
            every.for_each(|n| n.at = f(n.at));
            axis
        };
        assert_same(&turned, &moved(DVec2::perp))?;
        assert_same(&mirrored, &moved(|p| v(-p.x, p.y)))?;
        assert_same(&restarted, &found)?;
        assert_same(&reordered, &found)?;
    }

    #[test]
    fn spacing_does_not_move_it(region in star()) {
        let at = |spacing| MedialAxis::of_region(&region, &MedialOptions { spacing, ..MedialOptions::default() });
        assert_same(&at(0.25), &at(0.1))?;
    }

    #[test]
    fn an_offset_outline_is_as_good(region in star(), d in 0.2..2.0f64) {
        for region in region.offset(-d, Join::ROUND).into_polygons().into_iter().map(Region::from) {
            check(&region, &axis(&region), 3)?;
        }
    }

    /// Points on a coarse grid: edges cross, touch, overlap and run through vertices.
    #[test]
    fn crossing_and_touching_rings_do_no_harm(
        rings in prop::collection::vec(prop::collection::vec((0..7i32, 0..7i32), 3..12), 1..4), turn in 0..2i32
    ) {
        let place = |&(x, y): &(i32, i32)| DVec2::from_angle(f64::from(turn)).rotate(v(f64::from(x), f64::from(y)));
        let rings: Vec<Ring> = rings.iter().map(|r| Ring::new(r.iter().map(place).collect())).collect();
        let region = Region::from_rings(&rings, planar::FillRule::EvenOdd);
        let axis = axis(&region);
        for node in nodes(&axis).step_by(5) {
            prop_assert!((distance_to_boundary(&region, node.at) - node.radius).abs() < 3e-3, "{:?}", node);
        }
        prop_assert!(pieces_and_loops(&axis).0 >= region.polygons().len());
        prop_assert!(axis.length() <= 20.0 * region.perimeter());
    }
}

/// A ring with teeth outside, and a cut in it: of its axis without spurs one branch remains.
#[test]
fn a_wall_with_teeth_is_one_branch_without_them() {
    for cut in [false, true] {
        let teeth = 12;
        let outer: Vec<DVec2> = (0..4 * teeth)
            .map(|k| {
                DVec2::from_angle(TAU * (f64::from(k) + 0.3) / f64::from(4 * teeth))
                    * if k % 4 < 2 { 20.0 } else { 28.0 }
            })
            .collect();
        let mut region = Region::from(Polygon { outer: Ring::new(outer), holes: vec![circle(15.0, 60).reversed()] });
        if cut {
            region = region.difference(&polygon(&[(0.0, -1.0), (40.0, -1.0), (40.0, 1.0), (0.0, 1.0)]));
        }
        let axis = axis(&region).pruned(CORNER);
        assert!(axis.branches.len() > teeth as usize, "teeth have branches");
        let reach = |nodes: &[Node]| nodes.windows(2).map(|w| w[0].at.distance(w[1].at)).sum::<f64>();
        let longest = axis.clone().without_spurs(|nodes| reach(nodes) < 14.0);
        let [branch] = &longest.branches[..] else { panic!("{} branches", longest.branches.len()) };
        assert_eq!((branch.is_closed(), longest.degrees().len()), (!cut, if cut { 2 } else { 1 }));
        let around = reach(&branch.nodes) / (TAU * 18.5);
        assert!((around - 1.0).abs() < 0.15, "{around} of the way around");
        assert_eq!(axis.clone().without_spurs(|_| false), axis, "nothing is joined where nothing goes");
    }
}

/// Of a star of short arms the longest way through remains.
#[test]
fn the_longest_way_through_spurs_remains() {
    let arm = |degrees: f64, length: f64| {
        let (way, w) = (DVec2::from_angle(degrees.to_radians()), 1.0);
        let side = way.perp() * w;
        let corners = [-side, length * way - side, length * way + side, side].map(|p| (p.x, p.y));
        polygon(&corners)
    };
    let star =
        [(0.0, 6.0), (125.0, 9.0), (240.0, 7.0)].iter().fold(Region::EMPTY, |all, &(a, l)| all.union(&arm(a, l)));
    let axis = axis(&star).pruned(CORNER).without_spurs(|_| true);
    let [branch] = &axis.branches[..] else { panic!("{} branches", axis.branches.len()) };
    let length: f64 = branch.nodes.windows(2).map(|w| w[0].at.distance(w[1].at)).sum();
    assert!((length - 14.0).abs() < 0.7, "{length}: the arms of 7 and 9, less half a thickness at both ends");
}
