//! The profile of a dry run: programs that only move.

use super::{FanucSpeed, KrlArc, Profile, RapidArc};

impl Profile {
    /// The profile for programs that only move: the same ways at the same speeds, but arc, gas and wire never on. The
    /// lines that light and end the arc are left out; `start`, `layer_start`, `header`, `end` and `footer` stay.
    pub fn dry_run(mut self) -> Self {
        self.dry_run = true;
        self.name.push_str(", DRY RUN");
        if let Some(rapid) = &mut self.rapid {
            rapid.arc = RapidArc::Plain;
        }
        if let Some(krl) = &mut self.krl {
            krl.arc = KrlArc::Outputs;
        }
        // The weld schedule gives no speed while nothing is welded.
        if let Some(fanuc) = self.fanuc.as_mut().filter(|fanuc| fanuc.speed == FanucSpeed::WeldSpeed) {
            fanuc.speed = FanucSpeed::MillimetresPerSecond;
        }
        self
    }

    /// Whether programs only move.
    pub fn is_dry_run(&self) -> bool {
        self.dry_run
    }
}
