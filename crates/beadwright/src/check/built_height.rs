//! Parts that end above or below the plan.

use super::{Check, Finding, Subject};
use crate::finding::Severity;

pub(super) const CHECK: Check = Check {
    name: "built-height",
    what: "parts whose metal, bead laid on bead, ends more than a layer above or below the plan over a quarter of the area \
           or more",
    why: "the torch stays at the planned heights: its stick-out grows or shrinks with every layer, until the arc fails; serious \
          where metal ends more than one and a half stick-outs (process.ctwd) away",
    example: "after the last layer 35 % of the area lies within one layer height (2.00 mm) of the plan, on average \
              13.95 mm below it, at most 0.31 mm above and 23.78 mm below.",
    remedy: "set layers.level = true so that layers are as high as their metal, if it is not set, or measure the layers as \
             they are built and correct the rest (beadwright adapt)",
    find,
};

/// The fraction of the area that may end elsewhere.
const ELSEWHERE: f64 = 0.25;
/// If metal ends this many stick-outs from where it should, no arc burns there. Smaller distances may be an error of
/// the model, which lets metal beyond a leaning wall drop onto the metal below.
const LOST: f64 = 1.5;

fn find(subject: &Subject<'_>) -> Vec<Finding> {
    let Some((built, last)) = subject.built.zip(subject.layers.last()).filter(|(b, _)| b.within < 1.0 - ELSEWHERE)
    else {
        return Vec::new();
    };
    let side = if built.mean < 0.0 { "below" } else { "above" };
    let text = format!(
        "after the last layer {:.0} % of the area lies within one layer height ({:.2} mm) of the plan, on average {:.2} mm \
         {side} it, at most {:.2} mm above and {:.2} mm below.",
        100.0 * built.within,
        last.height,
        built.mean.abs(),
        built.peak,
        built.hollow
    );
    let worst = if built.hollow > built.peak { built.hollow_place } else { built.peak_place };
    let found = CHECK.of_layer(last, Some(worst.extend(last.z)), text).sized(built.hollow.max(built.peak));
    let level = subject.settings.is_level();
    let remedy = level.then(|| "Measure the layers as they are built, and correct the rest.".to_owned());
    let stick_out = subject.settings.weld.process.ctwd;
    let fails = !subject.settings.prints() && built.hollow.max(built.peak) > LOST * stick_out;
    let severity = if fails { Severity::Serious } else { found.severity };
    vec![Finding { severity, remedy: remedy.or(found.remedy.clone()), ..found }]
}
