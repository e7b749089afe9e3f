//! The keys of `[program.positioner]`, and the built-in positioners that `machine` names.

use super::{Positioner, PositionerAxis, Turning};
use bead_part::text::toml::nearest;
use serde::Deserialize;

/// The built-in positioners as (name, TOML text).
pub const MACHINES: [(&str, &str); 7] = [
    ("kuka-dkp-400", include_str!("../../positioners/kuka-dkp-400.toml")),
    ("abb-irbp-a250", include_str!("../../positioners/abb-irbp-a250.toml")),
    ("yaskawa-mt1-500", include_str!("../../positioners/yaskawa-mt1-500.toml")),
    ("yaskawa-d500", include_str!("../../positioners/yaskawa-d500.toml")),
    ("trunnion-ac", include_str!("../../positioners/trunnion-ac.toml")),
    ("trunnion-bc", include_str!("../../positioners/trunnion-bc.toml")),
    ("head-tailstock", include_str!("../../positioners/head-tailstock.toml")),
];

/// A built-in positioner. Its axes are given in the part's frame, whose origin is the middle of the plate.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Machine {
    /// One line of description.
    pub description: String,
    /// From the floor to the part.
    pub axes: Vec<PositionerAxis>,
    /// The upward direction in the cell, in the part's x, y and z with all axes at 0.
    #[serde(default = "upright")]
    pub up: [f64; 3],
}

impl Machine {
    /// A built-in positioner.
    ///
    /// # Errors
    /// A sentence with the nearest name, or all of them.
    pub fn built_in(name: &str) -> Result<Self, String> {
        toml::from_str(Self::built_in_text(name)?).map_err(|error| format!("{name}: {error}"))
    }

    /// Its text, for reading or copying.
    ///
    /// ```
    /// use bead_program::program::Machine;
    ///
    /// assert!(Machine::built_in_text("kuka-dkp-400").is_ok_and(|text| text.contains("through = [0, 0, -347]")));
    /// let refused = Machine::built_in_text("kuka-dkp-40").err();
    /// assert!(refused.is_some_and(|reason| reason.ends_with("Did you mean \"kuka-dkp-400\"?")));
    /// ```
    ///
    /// # Errors
    /// As above.
    pub fn built_in_text(name: &str) -> Result<&'static str, String> {
        let known = MACHINES.map(|(name, _)| name);
        let found = MACHINES.iter().find(|(known, _)| *known == name).map(|(_, text)| *text);
        found.ok_or_else(|| {
            let hint = match nearest(name, known) {
                Some(near) => format!("Did you mean \"{near}\"?"),
                None => format!("Known: {}.", known.join(", ")),
            };
            format!("there is no built-in positioner \"{name}\". {hint}")
        })
    }
}

/// The section `[program.positioner]`: one or two axes that turn the part so that layers lie level under the torch.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema), schemars(rename = "Positioner"))]
pub(super) struct Keys {
    /// `"index"` turns it between passes, `"index-at-home"` too, with the torch at home (URScript), `"follow"` at every point.
    turning: Turning,
    /// Name of a built-in positioner, such as `kuka-dkp-400`; `beadwright profile positioner` lists them. The part's origin is the
    /// middle of its plate. It stands for `axes` and `up`; leave it out where they are given.
    machine: Option<String>,
    /// From the floor to the part: one axis, or the one that tilts and the one that it carries. Leave it out with `machine`.
    axes: Option<Vec<PositionerAxis>>,
    /// What is up in the cell when all axes are at 0, in the part's x, y and z; default 0, 0, 1. Where a chuck holds the part by its
    /// lower face with its axis level, it is a direction across the part.
    up: Option<[f64; 3]>,
}

fn upright() -> [f64; 3] {
    [0.0, 0.0, 1.0]
}

impl TryFrom<Keys> for Positioner {
    type Error = String;

    fn try_from(keys: Keys) -> Result<Self, String> {
        let Keys { turning, machine, axes, up } = keys;
        match (machine, axes, up) {
            (None, Some(axes), up) => Ok(Self { turning, axes, up: up.unwrap_or_else(upright) }),
            (Some(name), None, None) => {
                let Machine { axes, up, .. } = Machine::built_in(&name)?;
                Ok(Self { turning, axes, up })
            }
            (None, None, _) => Err("program.positioner needs the key \"machine\" or \"axes\".".to_owned()),
            (Some(name), ..) => Err(format!(
                "program.positioner.machine = \"{name}\" stands for \"axes\" and \"up\": remove it or them."
            )),
        }
    }
}
