//! Wire that does not fit the bead.

use super::{Check, Finding, Subject};
use crate::bead::MassBalance;
use crate::layer::Lit;
use crate::pass::{PassKind, Segment};
use crate::plan::PlanSettings;
use crate::process::Follow;

pub(super) const CHECK: Check = Check {
    name: "wire-balance",
    what: "wire feed that does not match the bead, for the profile and along every pass",
    why: "too much wire makes the part grow into the torch, too little leaves it hollow and low",
    example: "The wire supplies 113.1 mm³/s, but the bead needs 215.6 mm³/s at this deposition speed (-48 %).",
    remedy: "use the deposition speed named in the message, or a different wire feed",
    find,
};

fn find(subject: &Subject<'_>) -> Vec<Finding> {
    let PlanSettings { layers, weld, balance, welded, .. } = subject.settings;
    let (process, settings, dot) = (&weld.process, subject.settings.paces(), subject.settings.dot());
    let nominal = balance.warning().map(|text| CHECK.of_plan(text));
    let along = subject.passes().filter_map(|(layer, i, pass)| {
        let paces = settings.in_layer(subject.number_in_body(layer), layer.height);
        // A wall takes the wire that fills its width over the rise of the layer.
        let rise = paces.wall_rise().filter(|_| pass.kind == PassKind::Wall);
        let fitting = |width: f64| match rise {
            Some(rise) => balance.wire / (width * rise),
            None => pass.kind.pace(&paces, dot, width),
        };
        // Where a helix begins and ends, it fills less than a layer.
        let most = if layer.lit.is_turn() { 1.0 / Lit::LEAST } else { 1.0 };
        let wedge = layers.wedge(layer);
        let thicker =
            |s: &Segment| wedge.as_ref().map_or(1.0, |wedge| wedge.thicker(s, welded.usual_height(layer.height)));
        let off = |s: &Segment| {
            let ratio = s.pace * thicker(s) / fitting(s.width);
            ratio < 1.0 - MassBalance::TOLERANCE || ratio > most * (1.0 + MassBalance::TOLERANCE)
        };
        let on_edge = |s: &Segment| wedge.as_ref().is_some_and(|wedge| wedge.is_on_edge(s));
        let s = pass.segments().find(|s| off(s) && !on_edge(s))?;
        let (width, fitting) = (s.width, fitting(s.width) / thicker(&s));
        let text = match process.follow {
            Follow::Speed => {
                let speed = process.speed_at(s.pace);
                format!("a bead {width:.2} mm wide is laid at {speed:.2} mm/s; the wire feed fits {fitting:.2} mm/s.")
            }
            Follow::WireFeed => {
                let [feed, fitting] = [s.pace, fitting].map(|pace| 100.0 * process.feed_at(pace));
                format!("a bead {width:.2} mm wide is laid with {feed:.0} % of the wire feed; it needs {fitting:.0} %.")
            }
        };
        Some(CHECK.of_pass(layer, i, Some(s.from).filter(|p| p.is_finite()), text))
    });
    nominal.into_iter().chain(along).collect()
}
