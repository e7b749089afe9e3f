//! Heat over the limit.

use super::{Check, Finding, Subject};
use crate::plan::PlanSettings;
use crate::process::Process;

pub(super) const CHECK: Check = Check {
    name: "heat-input",
    what: "heat per length of bead above check.max_heat_input, and layers finished before check.min_layer_time is over",
    why: "the layer below is still too hot, so beads spread, walls sag and the structure coarsens",
    example: "layer 30: it takes 8 s; at least 30 s are needed to cool.",
    remedy: "weld faster or with less current, weld several parts alternately, or wait (start_stop.min_layer_time)",
    find,
};

fn find(subject: &Subject<'_>) -> Vec<Finding> {
    let PlanSettings { weld, limits, .. } = subject.settings;
    let process = &weld.process;
    let over = |process: &Process, pace: f64| {
        process.heat_at(pace).zip(limits.max_heat_input).filter(|(heat, limit)| heat > limit)
    };
    let sentence = |(heat, limit)| format!("the heat input is {heat:.0} J/mm; the limit is {limit} J/mm.");
    let everywhere = over(process, process.deposition_speed).map(|found| CHECK.of_plan(sentence(found)));
    // Wider beads have more metal and more heat.
    let wide = subject.beads().filter(|_| everywhere.is_none()).filter_map(|(layer, i, pass)| {
        let process = process.at_layer(layer.index);
        let (s, found) = pass.segments().find_map(|s| Some((s, over(&process, s.pace)?)))?;
        Some(CHECK.of_pass(layer, i, Some(s.from).filter(|p| p.is_finite()), sentence(found)))
    });
    let hot: Vec<Finding> = everywhere.clone().into_iter().chain(wide).collect();
    let least = limits.min_layer_time.unwrap_or(0.0);
    let waits = &weld.ends;
    let time = |layer: &crate::layer::Layer| (subject.seconds(layer) + waits.interpass_time).max(waits.min_layer_time);
    let short = subject.layers.iter().filter(|layer| !layer.passes.is_empty() && time(layer) < least);
    let short = short.map(|layer| {
        let text = format!("it takes {:.0} s; at least {least:.0} s are needed to cool.", time(layer));
        CHECK.of_layer(layer, None, text)
    });
    hot.into_iter().chain(short).collect()
}
