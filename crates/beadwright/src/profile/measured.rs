//! The law of the bead from a library of measured beads (`bead.library`).

use super::Profile;
use crate::bead::Law;
use crate::bead::library::BeadLibrary;

/// Number of speeds at which the library is evaluated.
const SPEEDS: u32 = 16;
/// Fraction by which the library's bead for the profile's process may be wider or narrower than bead.width.
const ALIKE: f64 = 0.1;

/// How the bead changes with the speed at the profile's process, as given by a library (the text of a file written by
/// `beadwright bead fit`).
///
/// # Errors
/// A sentence that says what the library lacks, or how it differs from the profile.
pub(super) fn law(text: &str, profile: &Profile) -> Result<Law, String> {
    let library = BeadLibrary::parse(text).map_err(|error| error.to_string())?;
    let speed = library.input_number("deposition_speed").map_err(|error| error.to_string())?;
    let process = &profile.process;
    let value = |name: &str| match name {
        "deposition_speed" => Some(process.deposition_speed),
        "wire_feed" | "wire_feed_speed" => Some(process.wire_feed_speed),
        "current" => process.current,
        "voltage" => process.voltage,
        "weave_length" => Some(profile.weave.as_ref()?.length),
        "weave_amplitude" => Some(profile.weave.as_ref()?.amplitude),
        "weave_dwell" => Some(profile.weave.as_ref()?.dwell),
        _ => None,
    };
    let own = library.inputs.iter().map(|input| {
        value(&input.name)
            .ok_or_else(|| format!("the library depends on {}, which the profile does not give.", input.name))
    });
    let own: Vec<f64> = own.collect::<Result<_, _>>()?;
    let nominal = library.predict(&own).map_err(|error| error.to_string())?.width.value;
    if (nominal / profile.bead.width - 1.0).abs() > ALIKE {
        return Err(format!(
            "at {} it gives a bead {nominal:.2} mm wide, but bead.width is {} mm. Make the two agree.",
            library.describe(&own),
            profile.bead.width
        ));
    }
    let range = &library.inputs[speed];
    let at = |k: u32| {
        let mut values = own.clone();
        values[speed] = range.max + (range.min - range.max) * f64::from(k) / f64::from(SPEEDS);
        let bead = library.predict(&values).ok()?.bead();
        Some([bead.width, bead.height])
    };
    // Slower beads are wider; a fit that says otherwise at one of its ends is cut off there.
    let mut beads: Vec<[f64; 2]> = Vec::new();
    for bead in (0..=SPEEDS).filter_map(at) {
        if beads.last().is_none_or(|last| bead[0] > last[0] && bead[0] * bead[1] > last[0] * last[1]) {
            beads.push(bead);
        }
    }
    if beads.len() < 2 {
        return Err("its beads do not become wider as the deposition speed falls.".to_owned());
    }
    Ok(Law::Library(beads))
}
