//! Heat over the limit.

use super::{Check, Finding, Subject};

pub(super) const CHECK: Check = Check {
    name: "heat-input",
    what: "heat per length of bead above check.max_heat_input; and layers done before check.min_layer_time is over",
    why: "the layer below is still too hot, so beads spread, walls sag and the structure coarsens",
    example: "layer 30: it takes 8 s; at least 30 s are needed to cool.",
    remedy: "weld faster or with less current, weld several parts in turn, or wait (start_stop.min_layer_time)",
    find,
};

fn find(subject: &Subject<'_>) -> Vec<Finding> {
    let (profile, limits) = (subject.profile, &subject.profile.check);
    let hot = profile.heat_input().zip(limits.max_heat_input).filter(|(heat, limit)| heat > limit);
    let hot = hot.map(|(heat, limit)| {
        Finding::of_plan(&CHECK, format!("the heat input is {heat:.0} J/mm; the limit is {limit} J/mm."))
    });
    let least = limits.min_layer_time.unwrap_or(0.0);
    let waits = &profile.start_stop;
    let time = |layer: &crate::layer::Layer| {
        let welded = layer.passes.iter().map(crate::pass::Pass::seconds).sum::<f64>();
        (welded + waits.interpass_time).max(waits.min_layer_time)
    };
    let short = subject.layers.iter().filter(|layer| !layer.passes.is_empty() && time(layer) < least);
    let short = short.map(|layer| {
        let text = format!("it takes {:.0} s; at least {least:.0} s are needed to cool.", time(layer));
        Finding::of_layer(&CHECK, layer, text)
    });
    hot.into_iter().chain(short).collect()
}
