//! The section `[krl.arctech]`: data sets of KUKA ArcTech Basic 3.x, and the limits of their values.
//!
//! "(unconfirmed)" marks details that no source confirms for every version of the package: compare them with a form
//! made on the pendant.

use bead_plan::limit::{Broken, CONTROLLER, Limit, limit, limits};
use serde::{Deserialize, Serialize};

/// What switches the arc in KRL.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub enum KrlArc {
    /// The lines `arc_on` and `arc_off`.
    #[default]
    Outputs,
    /// The inline forms ARCON, ARCSWI and ARCOFF of ArcTech Basic, with the data of `[krl.arctech]`.
    Arctech,
}

/// ArcTech Basic. Gas and ignition times come from `[process]`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ArcTech {
    /// Version of the package on the controller, such as `3.3.3.366`; the controller refuses data of any other version, and
    /// only forms of 3.3 and 3.4 are written: 3.6 has others.
    pub version: String,
    /// The channel of `weld` and `crater` that holds the wire feed in m/min, 1 to 8 (2 where the power source is a Fronius TPS/i in
    /// its mode for command values). Needed for `process.follow = "wire-feed"`, a `start_stop.crater_power` below 1 and
    /// other speeds by `[[process.layers]]`: ARCSWI then switches it along the pass. Leave it out where a job of the power source sets
    /// the wire feed.
    pub wire_feed_channel: Option<u32>,
    /// The channel of `strike`, `weld` and `crater` that holds the job's number, 1 to 8. Needed where `[[process.layers]]` has jobs.
    pub job_channel: Option<u32>,
    /// Ignition.
    pub strike: ArcTechStrike,
    /// Welding.
    pub weld: ArcTechWeld,
    /// End crater.
    pub crater: ArcTechCrater,
}

/// The group `Strike` of a data set.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ArcTechStrike {
    /// Mode of the power source (`JobModeId`), named as in WorkVisual: `Job mode`, `GMAW synergic S2-Step`
    /// (unconfirmed).
    pub mode: String,
    /// Parameter set (`ParamSetId`), such as `Set1` (unconfirmed).
    pub set: String,
    /// Values of channels 1 to 8 as configured in WorkVisual: job number; or synergic line, wire feed in m/min,
    /// arc-length correction and dynamic correction (unconfirmed).
    pub channels: [f64; 8],
    /// Time to fill the gas lines, s.
    pub purge_time: f64,
}

/// The group `Weld` of a data set; its speed is the speed of the path.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ArcTechWeld {
    /// Mode of the power source (`JobModeId`).
    pub mode: String,
    /// Parameter set (`ParamSetId`).
    pub set: String,
    /// Values of channels 1 to 8.
    pub channels: [f64; 8],
}

/// The group `Crater` of a data set.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ArcTechCrater {
    /// Mode of the power source (`JobModeId`).
    pub mode: String,
    /// Parameter set (`ParamSetId`).
    pub set: String,
    /// Values of channels 1 to 8.
    pub channels: [f64; 8],
    /// Crater filling time at the end point, s.
    pub time: f64,
    /// Burnback time of the wire, s.
    pub burnback_time: f64,
}

/// Beginnings of the versions whose forms are known, from programs made on pendants.
const WRITTEN: [&str; 2] = ["3.3.", "3.4."];

impl ArcTech {
    /// The version as the data sets store it: 3.3.3.366 is 303030366; `None` if the text is not a version.
    pub(crate) fn number(&self) -> Option<u64> {
        let parts: Vec<u64> = self.version.split('.').map(|p| p.parse().ok()).collect::<Option<_>>()?;
        let [major, minor, revision, build] = parts[..] else { return None };
        let fits = (1..100).contains(&major) && minor < 100 && revision < 100 && build < 10_000;
        fits.then(|| ((major * 100 + minor) * 100 + revision) * 10_000 + build)
    }

    /// The limits of the numbers.
    pub(super) fn limits(&self) -> Vec<Limit> {
        let mut limits = limits! {
            "krl.arctech.strike.purge_time": self.strike.purge_time, 0.0, 60.0, "s",
                "values outside this range make no sense";
            "krl.arctech.crater.time": self.crater.time, 0.0, 60.0, "s", "values outside this range make no sense";
            "krl.arctech.wire_feed_channel": self.wire_feed_channel.unwrap_or(1).into(), 1.0, 8.0, "(channel)", CONTROLLER;
            "krl.arctech.job_channel": self.job_channel.unwrap_or(1).into(), 1.0, 8.0, "(channel)", CONTROLLER;
            "krl.arctech.crater.burnback_time": self.crater.burnback_time, 0.0, 10.0, "s",
                "values outside this range make no sense";
        };
        for (key, channels) in [
            ("krl.arctech.strike.channels", self.strike.channels),
            ("krl.arctech.weld.channels", self.weld.channels),
            ("krl.arctech.crater.channels", self.crater.channels),
        ] {
            limits.extend(channels.map(|value| {
                limit(
                    key,
                    value,
                    (-1e5, 1e5),
                    "(as the channel is configured)",
                    "the welding package accepts no other values",
                )
            }));
        }
        limits
    }

    /// The first text that a controller would refuse.
    pub(super) fn broken(&self) -> Option<Broken> {
        if self.number().is_none() {
            return Some(Broken::text("krl.arctech.version", &self.version, "four numbers such as \"3.3.3.366\"."));
        }
        if !WRITTEN.iter().any(|version| self.version.starts_with(version)) {
            let reason =
                "forms of 3.3 and 3.4 are written, and this version may run others (3.6 does). Use arc = \"outputs\".";
            return Some(Broken::text("krl.arctech.version", &self.version, reason));
        }
        let texts = [
            ("krl.arctech.strike.mode", &self.strike.mode),
            ("krl.arctech.strike.set", &self.strike.set),
            ("krl.arctech.weld.mode", &self.weld.mode),
            ("krl.arctech.weld.set", &self.weld.set),
            ("krl.arctech.crater.mode", &self.crater.mode),
            ("krl.arctech.crater.set", &self.crater.set),
        ];
        // Strings of the package: braces and quotes would end the data set.
        let legal = |b: u8| b.is_ascii_alphanumeric() || b" _-.+/".contains(&b);
        let wrong = texts.iter().find(|(_, text)| text.is_empty() || text.len() > 32 || !text.bytes().all(legal));
        wrong.map(|(key, text)| Broken::text(key, text, "1 to 32 letters, digits, blanks and _-.+/ only."))
    }
}
