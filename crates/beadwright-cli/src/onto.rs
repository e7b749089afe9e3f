//! The command that plans metal onto an existing part, as `clad` and `repair` print it.

use crate::profile::Wanted;
use std::path::Path;

/// A model that is written is STL, so its name ends in .stl.
pub(crate) fn check_name(output: &Path) -> anyhow::Result<()> {
    let is_stl = output.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("stl"));
    let named = output.with_extension("stl");
    anyhow::ensure!(is_stl, "--output {}: the model is written as STL; name it {}", output.display(), named.display());
    Ok(())
}

/// Plans a model onto a base, with its bodies.
pub(crate) struct Onto<'a> {
    pub(crate) model: &'a Path,
    pub(crate) base: &'a Path,
    pub(crate) bodies: &'a Path,
    /// Whether the base is a file that ends too early.
    pub(crate) accept_damaged: bool,
    pub(crate) wanted: &'a Wanted,
    /// Settings besides those that were wanted.
    pub(crate) set: &'a [&'a str],
}

impl Onto<'_> {
    /// As it is typed in a shell.
    pub(crate) fn command(&self) -> String {
        let path = |path: &Path| path.display().to_string();
        let mut words = vec!["beadwright".to_owned(), "plan".to_owned(), path(self.model)];
        let mut flag = |name: &str, value: String| words.extend([name.to_owned(), value]);
        flag("--onto", path(self.base));
        flag("--bodies", path(self.bodies));
        self.wanted.profile.iter().for_each(|profile| flag("--profile", profile.clone()));
        let own = self.set.iter().map(|set| (*set).to_owned());
        self.wanted.set.iter().cloned().chain(own).for_each(|set| flag("--set", set));
        if self.accept_damaged {
            words.push("--accept-damaged".to_owned());
        }
        let plain = |c: char| c.is_ascii_alphanumeric() || "-_./=,:+@%".contains(c);
        let quoted = |word: &String| {
            if word.chars().all(plain) { word.clone() } else { format!("'{}'", word.replace('\'', "'\\''")) }
        };
        words.iter().map(quoted).collect::<Vec<_>>().join(" ")
    }
}
