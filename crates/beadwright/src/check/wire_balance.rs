//! Wire that does not fit the bead.

use super::{Check, Finding, Subject};
use crate::bead::MassBalance;

pub(super) const CHECK: Check = Check {
    name: "wire-balance",
    what: "wire feed against bead, for the profile and along every pass",
    why: "too much wire makes the part grow into the torch, too little leaves it hollow and low",
    example: "the wire brings 113.1 mm³/s, but the bead takes 215.6 mm³/s at this deposition speed (−48 %).",
    remedy: "take the deposition speed that the sentence names, or another wire feed",
    find,
};

fn find(subject: &Subject<'_>) -> Vec<Finding> {
    let profile = subject.profile;
    let nominal = profile.mass_balance().warning().map(|text| Finding::of_plan(&CHECK, text));
    let metal = profile.bead.width * profile.process.deposition_speed;
    let off = |width: f64, speed: f64| (width * speed / metal - 1.0).abs() > MassBalance::TOLERANCE;
    let along = subject.passes().filter_map(|(layer, i, pass)| {
        let s = pass.segments().find(|s| off(s.width, s.speed))?;
        let fitting = metal / s.width;
        let text =
            format!("a bead {:.2} mm wide is laid at {:.2} mm/s; the wire fits {fitting:.2} mm/s.", s.width, s.speed);
        Some(Finding::of_pass(&CHECK, layer, i, Some(s.from).filter(|p| p.is_finite()), text))
    });
    nominal.into_iter().chain(along).collect()
}
