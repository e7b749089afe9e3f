//! Pools that lean.

use super::{Check, Finding, Subject};
use crate::layer::Layer;
use crate::pass::Pass;
use crate::plan::charted;
use glam::DVec3;

pub(super) const CHECK: Check = Check {
    name: "off-level",
    what: "passes on layers that lean farther than program.max_off_level, since the program turns the torch and not the part",
    why: "the pool runs down before it freezes, and falls where the layer faces the floor",
    example: "layer 1, pass 1, x 0.0 y -50.0 z 20.00 mm: the layer leans by 180.0° there; 15° are allowed. 27 other passes lean \
              too far, too.",
    remedy: "have a positioner turn the part so that the pool stays level, or raise program.max_off_level if the process can \
             weld in that position",
    find,
};

fn find(subject: &Subject<'_>) -> Vec<Finding> {
    let most = subject.profile.program.max_off_level;
    let worst = |(layer, i, pass)| {
        let layer: &Layer = layer;
        let pass: &Pass = pass;
        let sheet = subject.profile.layers.sheet(layer)?;
        let points = charted::followed(&pass.points, pass.closed, &sheet).into_iter().map(|(p, _)| p);
        let lean = |p: DVec3| (sheet.at(p).normal.angle_between(DVec3::Z).to_degrees(), p);
        let (lean, place) = points.filter(|p| p.is_finite()).map(lean).max_by(|a, b| a.0.total_cmp(&b.0))?;
        (lean > most).then_some((lean, place, layer, i))
    };
    let leaning: Vec<(f64, DVec3, &Layer, usize)> = subject.passes().filter_map(worst).collect();
    let Some(&(lean, place, layer, pass)) = leaning.iter().max_by(|a, b| a.0.total_cmp(&b.0)) else {
        return Vec::new();
    };
    let more = match leaning.len() - 1 {
        0 => String::new(),
        1 => " Another pass leans too far, too.".to_owned(),
        others => format!(" {others} other passes lean too far, too."),
    };
    let text = format!("the layer leans by {lean:.1}° there; {most}° are allowed.{more}");
    vec![CHECK.of_pass(layer, pass, Some(place), text).sized(lean)]
}
