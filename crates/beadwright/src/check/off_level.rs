//! Pools that lean.

use super::{Check, Finding, Subject, turned};
use crate::layer::Layer;
use crate::pass::Pass;
use crate::plan::charted;
use glam::DVec3;

pub(super) const CHECK: Check = Check {
    name: "off-level",
    what: "passes on layers that lean farther than program.max_off_level as the part lies, or as program.positioner holds it",
    why: "the pool runs down before it freezes, and falls where the layer faces the floor",
    example: "layer 1, pass 1, x 0.0 y -50.0 z 20.00 mm: the layer leans by 180.0° there; 15° are allowed. 27 other passes lean \
              too far, too.",
    remedy: "have a positioner turn the part so that the pool stays level (program.positioner), or raise program.max_off_level if \
             the process can weld in that position",
    find,
};

fn find(subject: &Subject<'_>) -> Vec<Finding> {
    let most = subject.settings.program.max_off_level;
    let turned = subject.settings.program.positioner.is_some();
    let leaning: Vec<Leaning<'_>> = if turned { as_turned(subject) } else { as_lying(subject) };
    let leaning: Vec<&Leaning<'_>> = leaning.iter().filter(|(lean, ..)| *lean > most).collect();
    let Some(&&(lean, place, layer, pass)) = leaning.iter().max_by(|a, b| a.0.total_cmp(&b.0)) else {
        return Vec::new();
    };
    let more = match leaning.len() - 1 {
        0 => String::new(),
        1 => " Another pass leans too far, too.".to_owned(),
        others => format!(" {others} other passes lean too far, too."),
    };
    let how = if turned { "as the positioner holds the part, the layer leans" } else { "the layer leans" };
    let text = format!("{how} by {lean:.1}° there; {most}° are allowed.{more}");
    let found = CHECK.of_pass(layer, pass, Some(place), text).sized(lean);
    vec![if turned { Finding { remedy: Some(TURNED.to_owned()), ..found } } else { found }]
}

/// What to do where a positioner turns the part already.
const TURNED: &str = "Let it turn at every point (program.positioner.turning = \"follow\") if it turns between passes only, widen the \
                      limits of its axes, or hold the part so that its second axis lies along the axis of the layers.";

/// A pass with how far it leans at most, °, and where.
type Leaning<'a> = (f64, DVec3, &'a Layer, usize);

/// As the part lies.
fn as_lying<'a>(subject: &'a Subject<'_>) -> Vec<Leaning<'a>> {
    let worst = |(layer, i, pass)| {
        let layer: &Layer = layer;
        let pass: &Pass = pass;
        let sheet = subject.settings.layers.sheet(layer)?;
        let points = charted::followed(&pass.points, pass.closed, &sheet).into_iter().map(|(p, _)| p);
        let lean = |p: DVec3| (sheet.at(p).normal.angle_between(DVec3::Z).to_degrees(), p);
        let (lean, place) = points.filter(|p| p.is_finite()).map(lean).max_by(|a, b| a.0.total_cmp(&b.0))?;
        Some((lean, place, layer, i))
    };
    subject.passes().filter_map(worst).collect()
}

/// As a positioner holds it.
fn as_turned<'a>(subject: &'a Subject<'_>) -> Vec<Leaning<'a>> {
    let moves = turned::moves(subject);
    let passes = moves.chunk_by(|a, b| a.layer.index == b.layer.index && a.pass == b.pass);
    let worst = passes.filter_map(|pass| pass.iter().max_by(|a, b| a.off_level.total_cmp(&b.off_level)));
    worst.map(|turned| (turned.off_level, turned.place, turned.layer, turned.pass)).collect()
}
