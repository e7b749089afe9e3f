//! What a plan holds.

use crate::error::Refuse;
use crate::layer::Layers;
use beadwright::files::{Post, posts};
use beadwright::plan::{Header, Summary};
use beadwright::{model, profile};
use pyo3::prelude::*;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// What a plan holds.
pub(crate) struct Planned {
    pub(crate) header: Header,
    pub(crate) layers: Layers,
    pub(crate) summary: Summary,
    /// Why the strategy is not the profile's.
    pub(crate) note: Option<String>,
    pub(crate) profile: profile::Profile,
    /// Where the profile's own dialects lie.
    pub(crate) folder: PathBuf,
    pub(crate) part: Arc<model::Part>,
}

impl Planned {
    /// The profile with other posts, and the posts themselves; without any, the profile's.
    pub(crate) fn posts(&self, names: Vec<String>) -> PyResult<(profile::Profile, Vec<Post>)> {
        let base = if names.is_empty() { &*self.folder } else { Path::new("") };
        let mut profile = self.profile.clone();
        if !names.is_empty() {
            profile.posts = names;
        }
        let posts = posts(&profile.posts, base).refuse(None)?;
        Ok((profile, posts))
    }
}
