//! The profile of a dry run: programs that only move.

use super::Profile;

impl Profile {
    /// The profile for programs that only move: the same paths at the same speeds, but with arc, gas and wire always
    /// off. The lines that strike and end the arc are left out; `start`, `layer_start`, `header`, `end` and `footer`
    /// stay.
    pub fn dry_run(mut self) -> Self {
        self.dry_run = true;
        self.name.push_str(", DRY RUN");
        self.dialects.dry_run();
        self
    }

    /// Whether programs only move.
    pub fn is_dry_run(&self) -> bool {
        self.dry_run
    }
}
