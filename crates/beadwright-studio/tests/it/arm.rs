//! The arm in the 3-D view reaches to where the torch is.

use beadwright::model::Model;
use beadwright::profile::Profile;
use beadwright::robot::body::Solid;
use beadwright::robot::{self, Cell};
use beadwright::task::Task;
use beadwright_studio::arm::stand;
use beadwright_studio::holding::{Come, Place};
use beadwright_studio::view3d::Stance;
use glam::DVec3;

#[test]
fn the_wire_tip_of_every_arm_is_at_the_bead() {
    let profile = Profile::built_in("cmt-al2319-kuka").unwrap();
    let model = Model::read(&beadwright::example::find("star").unwrap().stl(), &Task::new()).unwrap();
    let part = model.place(&Default::default(), None, profile.bead.width).unwrap();
    let plan = beadwright::plan::plan("star", part.mesh().unwrap(), &profile, &Task::new()).unwrap();
    let track = profile.track(&plan.layers);
    for (name, _) in robot::cell::BUILT_IN {
        let cell = Cell::built_in(name).unwrap();
        let reach = robot::reach(&cell, cell.part, &track);
        let (arm, base_from_part) = (cell.arm(), cell.part.base_from_part());
        let mut stood = 0;
        for layer in plan.layers.iter().step_by(3) {
            for (pass, of) in layer.passes.iter().enumerate() {
                for segment in of.segments().step_by(7) {
                    let at = (segment.from + segment.to) / 2.0;
                    let (come, torch) = (Come::Along(0.0), Stance::upright(at));
                    let place = Place { layer: layer.index, pass, come, torch };
                    let Some(found) = stand(&cell, &reach, &place) else { continue };
                    stood += 1;
                    // Forward kinematics, along the torch to the wire's tip.
                    let flange = arm.forward(&found.joints);
                    let tip = flange.apply(cell.flange_from_tool().position);
                    let wanted = base_from_part.apply(at);
                    assert!(tip.distance(wanted) < 0.01, "{name}: {tip} instead of {wanted}");
                    // The torch stands straight over the bead, and the base on the floor of the cell.
                    let end = found.links.iter().rfind(|link| link.solid == Solid::Torch).unwrap().ends[1];
                    let beside = (end - at).truncate().length();
                    assert!(beside < 0.01 && end.z > at.z, "{name}: the nozzle is {beside} mm beside the bead");
                    let base = found.links.iter().find(|link| link.solid == Solid::Base).unwrap();
                    assert!(base_from_part.apply(base.ends[0]).distance(DVec3::ZERO) < 0.01, "{name}");
                }
            }
        }
        assert!(stood > 20, "{name}: the arm is shown at {stood} beads only");
    }
}

#[test]
fn no_arm_is_shown_where_there_is_no_pass() {
    let profile = Profile::built_in("cmt-al2319-kuka").unwrap();
    let cell = Cell::built_in("kuka-kr20-r1810").unwrap();
    let reach = robot::reach(&cell, cell.part, &profile.track::<beadwright::layer::Layer>(&[]));
    let (come, torch) = (Come::Towards(0.5), Stance::upright(DVec3::ZERO));
    assert_eq!(stand(&cell, &reach, &Place { layer: 0, pass: 0, come, torch }), None);
}
