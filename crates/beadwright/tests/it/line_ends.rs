//! Hooked line ends (`fill.line_ends`): inside the region, crossing nothing, and no wedges at slanted edges.

use crate::families::{FAMILIES, islands};
use beadwright::compare;
use beadwright::fill::{FillSettings, LineEnds, Path, RasterSpacing, StrategyName, sound};
use beadwright::model::Mesh;
use beadwright::model::solid::Solid;
use beadwright::plan;
use beadwright::planar::{DVec2, Polygon, Ring};
use beadwright::profile::{Profile, RasterTurn};
use beadwright::task::Task;
use std::collections::BTreeSet;

fn laid(strategy: StrategyName, island: &Polygon, settings: &FillSettings) -> Vec<Path> {
    strategy.strategy().fill(island, settings).stages.into_iter().flatten().collect()
}

#[test]
fn hooks_stay_inside_cross_nothing_and_take_no_starts() {
    let profile = Profile::built_in("cmt-al2319-kuka").unwrap();
    let (mut hooked_more, mut starts) = (0, [0, 0]);
    for (family, name) in FAMILIES.iter().enumerate() {
        for (seed, degrees) in [(1, 0.0_f64), (2, 25.0), (3, 60.0), (4, 90.0), (5, 130.0)] {
            for island in islands(family, seed) {
                for strategy in [StrategyName::Zigzag, StrategyName::Compound] {
                    // A hook may make a short pass long enough to be kept.
                    let all = FillSettings { min_pass_length: 0.0, ..profile.fill_settings(0) };
                    let plain = FillSettings { raster_angle: degrees.to_radians(), ..all };
                    let hooked = FillSettings { line_ends: LineEnds::Hooked, ..plain };
                    let [plain, hooked] = [plain, hooked].map(|settings| laid(strategy, &island, &settings));
                    let all: Vec<&Path> = hooked.iter().collect();
                    let fault = sound::fault(&all, &island, profile.fill.machining_allowance);
                    assert!(fault.is_none(), "{name} {seed} at {degrees}°, {strategy:?}: {fault:?}");
                    // A thin wall is welded on from an end that lies near it; hooks move ends.
                    let counts =
                        format!("{name} {seed} at {degrees}°, {strategy:?}: {} for {}", hooked.len(), plain.len());
                    assert!(hooked.len() <= plain.len() + 1, "{counts}");
                    starts[0] += plain.len();
                    starts[1] += hooked.len();
                    let length = |paths: &[Path]| paths.iter().map(Path::length).sum::<f64>();
                    hooked_more += usize::from(length(&hooked) > length(&plain));
                }
            }
        }
    }
    assert!(hooked_more > 20, "{hooked_more}");
    println!("passes with plain and with hooked ends: {starts:?}");
    assert!(100 * starts[1] <= 101 * starts[0], "{starts:?}");
}

/// Void of a rectangle turned by some degrees, mm² for each mm of its edges: the lines run along x.
fn wedges(degrees: f64, ends: LineEnds) -> f64 {
    let mut profile = Profile::built_in("plasma-304-cnc").unwrap();
    profile.layers.level = false;
    (profile.fill.line_ends, profile.fill.raster_spacing) = (ends, RasterSpacing::Even);
    (profile.fill.raster_angle, profile.fill.raster_turn) = (0.0, RasterTurn::Fixed);
    let corners = [(-150.0, -75.0), (150.0, -75.0), (150.0, 75.0), (-150.0, 75.0)].map(DVec2::from);
    let way = DVec2::from_angle(degrees.to_radians());
    let plate = Polygon::simple(Ring::new(corners.map(|p| way.rotate(p)).to_vec()));
    let solid = Solid::extrude(&plate, 0.0, profile.layers.height);
    let mesh = Mesh::from_triangles(solid.vertices, solid.triangles).0;
    let (settings, first) = (plan::deposit_settings(&profile), Some(BTreeSet::from([0])));
    let judged = compare::strategy(&mesh, &profile, StrategyName::Compound, settings, &first, &Task::new()).unwrap();
    judged.figures.void_percent() / 100.0 * plate.area() / plate.outer.length()
}

/// Void at a straight edge that the lines meet at 30°, 45° and 60°, mm² for each mm, summed over the deposit model of an
/// infinite edge by a program of its own: plain ends 0.204, 0.108 and 0.027 with beads of 5 mm, hooked none.
#[test]
fn wedges_at_slanted_edges_are_those_of_an_infinite_edge_and_hooks_fill_them() {
    for (degrees, edge) in [(45.0, 0.108), (30.0, (2.0 * 0.204 + 0.027) / 3.0)] {
        let [plain, hooked] = [LineEnds::Plain, LineEnds::Hooked].map(|ends| wedges(degrees, ends));
        println!("{degrees}°: plain {plain:.4}, hooked {hooked:.4}, infinite edge {edge:.4}");
        assert!((plain / edge - 1.0).abs() < 0.15, "{degrees}°: {plain} mm, an infinite edge {edge} mm");
        assert!(hooked < plain / 5.0, "{degrees}°: {hooked} mm for {plain} mm");
    }
}
