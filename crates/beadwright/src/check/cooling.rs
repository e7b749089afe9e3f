//! Layers that follow each other hot.

use super::{Check, Finding, Subject};
use crate::plan::PlanSettings;

pub(super) const CHECK: Check = Check {
    name: "cooling",
    what: "layers over in less than check.cooling_time, where the program has no waits (welding torches only)",
    why: "the next layer is welded onto metal that still glows: beads spread and walls sag",
    example: "layer 30: it takes 8 s, and there is no wait before the next layer; 12 layers take less than 15 s.",
    remedy: "set start_stop.interpass_time or start_stop.min_layer_time, weld several parts alternately, or lower \
             check.cooling_time if you cool in another way",
    find,
};

fn find(subject: &Subject<'_>) -> Vec<Finding> {
    let PlanSettings { weld, limits, .. } = subject.settings;
    let waits = weld.ends.interpass_time > 0.0 || weld.ends.min_layer_time > 0.0;
    // Printers weld nothing; a separate limit says more.
    if waits || weld.process.ctwd <= 0.0 || limits.min_layer_time.is_some() {
        return Vec::new();
    }
    let (least, count) = (limits.cooling_time, subject.layers.len().saturating_sub(1));
    let followed = subject.layers.iter().take(count).filter(|layer| !layer.passes.is_empty());
    let short: Vec<_> = followed.map(|layer| (*layer, subject.seconds(layer))).filter(|(_, s)| *s < least).collect();
    let Some((layer, seconds)) = short.iter().min_by(|a, b| a.1.total_cmp(&b.1)) else { return Vec::new() };
    let more = match short.len() {
        1 => String::new(),
        count => format!("; {count} layers take less than {least} s"),
    };
    let text = format!("it takes {seconds:.0} s, and there is no wait before the next layer{more}.");
    vec![CHECK.of_layer(layer, None, text)]
}
