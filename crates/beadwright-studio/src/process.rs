//! What follows the chosen process: the language of programs, and the robot cell.

use crate::studio::Studio;
use beadwright::dialect;

/// For each robot language, a built-in cell whose robot speaks it, among them the two that built-in profiles name.
const SPEAKERS: [(&str, &str); 5] = [
    ("krl", "kuka-kr20-r1810"),
    ("rapid", "abb-irb1410"),
    ("fanuc", "fanuc-arc-mate-100id"),
    ("inform", "yaskawa-ar2010"),
    ("urscript", "ur10e"),
];

impl Studio {
    /// Uses the first of the profile's dialects to write programs in and, unless a cell was chosen by hand, a cell whose
    /// robot speaks it.
    pub(crate) fn follow_profile(&mut self) {
        self.parse();
        let posts = self.known().parsed().map(|parsed| parsed.profile.posts.clone()).unwrap_or_default();
        let Some(post) = posts.into_iter().find(|post| dialect::find(post).is_some()) else { return };
        let speaker = SPEAKERS.iter().find(|(language, _)| *language == post);
        if let Some((_, cell)) = speaker.filter(|_| !self.view.cell_chosen) {
            self.take_cell(cell);
        }
        self.view.dialect = post;
    }

    /// Uses another robot cell; results for the previous one are discarded.
    pub(crate) fn take_cell(&mut self, name: &str) {
        if self.view.cell != name {
            name.clone_into(&mut self.view.cell);
            self.jobs.cell = None;
            self.jobs.forget_reach();
        }
    }
}
