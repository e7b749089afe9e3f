//! Pools that lean.

use super::{Check, Finding, Subject};
use glam::DVec3;

pub(super) const CHECK: Check = Check {
    name: "off-level",
    what: "passes on layers that lean farther than program.max_off_level, since the program turns the torch and not the part",
    why: "the pool runs down before it freezes, and falls where the layer faces the floor",
    example: "layer 1, pass 1, x 0.0 y -50.0 z 20.00 mm: the layer leans by 180.0° there, 15° are allowed, and so do 27 other \
              passes.",
    remedy: "have a positioner turn the part so that the pool stays level, or raise program.max_off_level if the process can \
             weld in that position",
    find,
};

fn find(subject: &Subject<'_>) -> Vec<Finding> {
    let most = subject.profile.program.max_off_level;
    let mut leaning = Vec::new();
    for (layer, i, pass) in subject.passes() {
        let Some(sheet) = subject.profile.layers.sheet(layer) else { continue };
        let lean = |p: &DVec3| sheet.at(*p).normal.angle_between(DVec3::Z).to_degrees();
        let worst =
            pass.points.iter().filter(|p| p.is_finite()).map(|p| (lean(p), *p)).max_by(|a, b| a.0.total_cmp(&b.0));
        leaning.extend(worst.filter(|(lean, _)| *lean > most).map(|(lean, place)| (lean, place, layer, i)));
    }
    let Some((lean, place, layer, pass)) = leaning.iter().copied().max_by(|a, b| a.0.total_cmp(&b.0)) else {
        return Vec::new();
    };
    let others = leaning.len() - 1;
    let more = if others == 0 { String::new() } else { format!(", and so do {others} other passes") };
    let text = format!("the layer leans by {lean:.1}° there, {most}° are allowed{more}.");
    vec![CHECK.of_pass(layer, pass, Some(place), text).sized(lean)]
}
