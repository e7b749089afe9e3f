//! Which value of the profile usually helps against a finding, so that people can try it.

use beadwright::Finding;
use beadwright::fill::StrategyName;
use beadwright::order::Seam;
use beadwright::profile::Profile;

/// Travels pass this much above what they must clear, mm.
const CLEAR: f64 = 3.0;

/// A value to be changed in a profile.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Change {
    /// Its key.
    pub key: &'static str,
    /// The new value, as in TOML.
    pub value: String,
}

/// The change of one value that usually helps against a finding; `None` where there is none, or it is made already.
pub fn change(finding: &Finding, profile: &Profile) -> Option<Change> {
    let clearance = profile.travel.clearance;
    let (key, value) = match finding.kind {
        "clearance" => ("travel.clearance", number((profile.bead.height + CLEAR).ceil())),
        "towers" => ("travel.clearance", number((finding.size?.max(clearance) + CLEAR).ceil())),
        "low-travel" => ("travel.clearance", number(2.0 * clearance)),
        "void" if profile.fill.strategy != StrategyName::Hybrid => ("fill.strategy", "\"hybrid\"".to_owned()),
        "short-arc" => ("fill.min_pass_length", number((1.5 * shortest_pass(profile)).ceil())),
        "cooling" => ("start_stop.min_layer_time", number(profile.check.cooling_time)),
        "stacked-starts" if profile.order.seam != Seam::Spread => ("order.seam", "\"spread\"".to_owned()),
        "built-height" if !profile.layers.level => ("layers.level", "true".to_owned()),
        "program-size" => ("slice.simplify", number(2.0 * profile.slice.simplify)),
        "wire-balance" if finding.layer.is_none() => {
            let fitting = profile.mass_balance().fitting_speed;
            ("process.deposition_speed", number((100.0 * fitting).round() / 100.0))
        }
        _ => return None,
    };
    Some(Change { key, value })
}

/// A number as in TOML.
fn number(value: f64) -> String {
    format!("{value:?}")
}

/// The length that passes have already where the strategy has the choice, mm: at least the way of the torch while the arc starts.
fn shortest_pass(profile: &Profile) -> f64 {
    let start = profile.process.arc_start_delay * profile.process.deposition_speed;
    profile.fill.min_pass_length.max(start)
}
