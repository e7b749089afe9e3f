//! Parts divided into pieces with directions of their own: nothing is lost, and what overhangs is spared however the part is turned.

use bead_part::chart::{Bound, Chart};
use bead_part::directions::{Division, Settings, divisions};
use bead_part::example;
use bead_part::model::Mesh;
use bead_part::model::solid::Solid;
use bead_part::task::Task;
use glam::{DQuat, DVec3};
use planar::{DVec2, Polygon, Ring};
use std::f64::consts::FRAC_PI_2;

const SETTINGS: Settings = Settings { lean: 45.0, tilt: 90.0, bead: 7.0 };

/// A sheet 40 mm thick with an outline in x and z, mm, turned about z.
fn upright(outline: &[(f64, f64)], degrees: f64) -> Mesh {
    let outline = Polygon::simple(Ring::new(outline.iter().copied().map(DVec2::from).collect()));
    let solid = Solid::extrude(&outline, -20.0, 20.0);
    let stand = DQuat::from_rotation_z(degrees.to_radians()) * DQuat::from_rotation_x(FRAC_PI_2);
    let vertices = solid.vertices.iter().map(|p| stand * *p).collect();
    Mesh::from_triangles(vertices, solid.triangles).0
}

/// A post with an arm to the right, whose underside is 80 × 40 mm.
fn post_with_arm(degrees: f64) -> Mesh {
    let outline = [
        (0.0, 0.0),
        (40.0, 0.0),
        (40.0, 60.0),
        (120.0, 60.0),
        (120.0, 100.0),
        (40.0, 100.0),
        (40.0, 140.0),
        (0.0, 140.0),
    ];
    upright(&outline, degrees)
}

fn found(mesh: &Mesh, settings: Settings) -> Vec<Division> {
    divisions(mesh, settings, &Task::new()).unwrap()
}

/// What of a part a piece consists of.
fn cut_out(mesh: &Mesh, chart: &Chart, within: &[Bound]) -> Mesh {
    let Chart::Plane(first) = *chart else { panic!("{chart}") };
    within.iter().chain([&Bound::Plane(first)]).fold(mesh.clone(), |rest, bound| bound.part_of(&rest))
}

#[test]
fn an_arm_that_would_hang_is_built_along_itself_however_the_post_is_turned() {
    for degrees in [0.0, 17.0, 90.0, 203.0] {
        let mesh = post_with_arm(degrees);
        let found = found(&mesh, SETTINGS);
        let level = found.last().unwrap();
        assert!((level.hanging - 80.0 * 40.0).abs() < 1.0, "{}", level.hanging);
        let best = &found[0];
        assert!(best.hanging < 0.05 * level.hanging && best.pieces.len() == 2, "{degrees}°: {best:?}");
        // By how little it must lean is a matter of the lean that walls may have.
        let Chart::Plane(plane) = &best.pieces[1].chart else { panic!("{best:?}") };
        let along = DQuat::from_rotation_z(degrees.to_radians()) * DVec3::X;
        assert!(plane.up.reject_from(DVec3::Z).angle_between(along).to_degrees() < 15.0, "{degrees}°: {}", plane.up);
        assert!((44.0..=91.0).contains(&best.tilt), "{degrees}°: {}", best.tilt);
    }
}

/// Every division is a division: its pieces together are the part, and no two have anything in common.
#[test]
fn pieces_are_the_whole_part_and_share_nothing() {
    let fork = [
        (0.0, 0.0),
        (40.0, 0.0),
        (40.0, 40.0),
        (110.0, 80.0),
        (110.0, 120.0),
        (90.0, 120.0),
        (20.0, 70.0),
        (-50.0, 120.0),
        (-70.0, 120.0),
        (-70.0, 80.0),
        (0.0, 40.0),
    ];
    for mesh in [post_with_arm(0.0), post_with_arm(37.0), upright(&fork, 0.0), upright(&fork, 61.0)] {
        let found = found(&mesh, SETTINGS);
        assert!(found.len() > 1);
        for division in found {
            let pieces: Vec<Mesh> = division.pieces.iter().map(|p| cut_out(&mesh, &p.chart, &p.within)).collect();
            let volume: f64 = pieces.iter().map(Mesh::volume).sum();
            assert!((volume / mesh.volume() - 1.0).abs() < 1e-3, "{volume} of {}: {division:?}", mesh.volume());
            for (k, piece) in division.pieces.iter().enumerate() {
                for other in &pieces[k + 1..] {
                    let common = cut_out(other, &piece.chart, &piece.within).volume();
                    assert!(common < 1e-3 * mesh.volume(), "{common} mm³ in two pieces: {division:?}");
                }
            }
        }
    }
}

/// An underside in which a cut lies is no face of the cut: an arm at any height must still be built along itself.
#[test]
fn a_cut_along_an_underside_spares_nothing() {
    for under in [40.0, 50.0, 56.0, 70.0] {
        let outline = [
            (0.0, 0.0),
            (40.0, 0.0),
            (40.0, under),
            (120.0, under),
            (120.0, under + 30.0),
            (40.0, under + 30.0),
            (40.0, 2.0 * under),
            (0.0, 2.0 * under),
        ];
        for division in found(&upright(&outline, 0.0), SETTINGS).iter().rev().skip(1) {
            assert!(division.tilt > 40.0 || division.hanging > 3000.0, "{under}: {division:?}");
        }
    }
}

#[test]
fn what_does_not_hang_is_left_whole() {
    for name in ["cross", "plate", "star"] {
        assert_eq!(found(&example::find(name).unwrap().mesh(), SETTINGS).len(), 1, "{name}");
    }
}

/// Hubs and their axes are found wherever they lie, and bent tubes stay whole.
#[test]
fn hubs_and_bent_tubes_are_recognized_at_any_angle() {
    for degrees in [0.0, 23.0, 90.0] {
        let turn = DQuat::from_rotation_z(f64::to_radians(degrees));
        for (stand, axis) in [(DQuat::IDENTITY, DVec3::Z), (DQuat::from_rotation_y(FRAC_PI_2), DVec3::X)] {
            let mut hub = example::find("hub").unwrap().mesh();
            hub.vertices.iter_mut().for_each(|p| *p = turn * (stand * *p));
            let low = hub.bounds().0.z;
            hub.vertices.iter_mut().for_each(|p| p.z -= low);
            let found = found(&hub, SETTINGS);
            let piece = &found[0].pieces[0];
            let Chart::Cylinder(cylinder) = &piece.chart else { panic!("{degrees}°: {}", piece.chart) };
            assert!(piece.on_stock && cylinder.axis.dot(turn * axis).abs() > 0.9999, "{degrees}°: {}", cylinder.axis);
            assert!((cylinder.radius - 40.0).abs() < 0.2, "{degrees}°: {}", cylinder.radius);
        }
        let mut elbow = example::find("elbow").unwrap().mesh();
        elbow.vertices.iter_mut().for_each(|p| *p = turn * *p);
        let found = found(&elbow, SETTINGS);
        let Chart::Guide(guide) = &found[0].pieces[0].chart else { panic!("{degrees}°: {:?}", found[0]) };
        assert!((guide.length() - (50.0 + 120.0 * FRAC_PI_2)).abs() < 1.0, "{}", guide.length());
    }
}

/// No layer lies farther from level than allowed.
#[test]
fn directions_stay_within_the_tilt() {
    for tilt in [30.0, 45.0, 60.0] {
        for division in found(&post_with_arm(12.0), Settings { tilt, ..SETTINGS }) {
            assert!(division.tilt <= tilt + 0.01, "{} of {tilt}", division.tilt);
        }
    }
}

/// Cuts at 45° would spare all arms at once, and leave wedges without room for a bead.
#[test]
fn arms_are_cut_off_along_the_faces_of_their_post() {
    let both = [
        (0.0, 0.0),
        (40.0, 0.0),
        (40.0, 60.0),
        (130.0, 60.0),
        (130.0, 90.0),
        (0.0, 90.0),
        (0.0, 65.0),
        (-90.0, 65.0),
        (-90.0, 40.0),
        (0.0, 40.0),
    ];
    for degrees in [0.0, 17.0, 90.0, 203.0] {
        let best = found(&upright(&both, degrees), SETTINGS).remove(0);
        assert!(best.hanging < 20.0 && best.pieces.len() == 3, "{degrees}°: {best:?}");
        let along = DQuat::from_rotation_z(f64::to_radians(degrees)) * DVec3::X;
        let mut ends: Vec<f64> = Vec::new();
        for piece in &best.pieces[1..] {
            let Chart::Plane(plane) = &piece.chart else { panic!("{best:?}") };
            assert!(plane.up.cross(along).length() < 1e-3, "{degrees}°: {}", plane.up);
            ends.push(plane.origin.dot(along));
        }
        ends.sort_by(f64::total_cmp);
        assert!(ends[0].abs() < 0.05 && (ends[1] - 40.0).abs() < 0.05, "{degrees}°: {ends:?}");
    }
}
