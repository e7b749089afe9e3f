//! Profiles: TOML text, checked, and changed key by key.

use crate::error::{Refuse, raise};
use beadwright::fill::StrategyName;
use beadwright::profile::{self, BUILT_IN, ProfileError, edit};
use pyo3::prelude::*;
use std::path::PathBuf;
use std::sync::Arc;

/// A profile.
#[pyclass(frozen, module = "beadwright._core")]
pub(crate) struct Profile {
    /// As the user wrote it, with what was set since.
    text: String,
    /// Where its dialects and the profiles that it inherits from lie.
    pub(crate) folder: PathBuf,
    pub(crate) profile: Arc<profile::Profile>,
}

/// Names of the built-in profiles.
#[pyfunction]
pub(crate) fn profile_names() -> Vec<&'static str> {
    BUILT_IN.iter().map(|(name, _)| *name).collect()
}

/// Names of the strategies.
#[pyfunction]
pub(crate) fn strategy_names() -> Vec<&'static str> {
    StrategyName::ALL.iter().map(|strategy| strategy.name()).collect()
}

/// Parses a profile; `base` (Python) gives the text of what `inherits` names, or none for a built-in one. Exceptions from it
/// are passed on.
fn parse(text: &str, base: &Bound<'_, PyAny>) -> PyResult<Result<profile::Profile, ProfileError>> {
    let mut raised = None;
    let parsed = profile::Profile::parse_with(text, &mut |name| {
        let found = base.call1((name,)).and_then(|text| text.extract::<Option<String>>());
        match found {
            Ok(Some(text)) => Ok(text),
            Ok(None) => Ok(profile::Profile::built_in_text(name)?.to_owned()),
            Err(error) => {
                let reason = error.to_string();
                raised = Some(error);
                Err(ProfileError::File { path: name.into(), reason })
            }
        }
    });
    raised.map_or(Ok(parsed), Err)
}

#[pymethods]
impl Profile {
    /// Reads a profile's text.
    #[staticmethod]
    fn parse(text: String, place: Option<&str>, folder: PathBuf, base: &Bound<'_, PyAny>) -> PyResult<Self> {
        let profile = Arc::new(parse(&text, base)?.refuse(place)?);
        Ok(Self { text, folder, profile })
    }

    /// The text of a built-in profile.
    #[staticmethod]
    fn built_in_text(name: &str) -> PyResult<&'static str> {
        profile::Profile::built_in_text(name).refuse(None)
    }

    /// The profile with these keys set to these values, which are TOML.
    fn set(&self, values: Vec<(String, String)>, base: &Bound<'_, PyAny>) -> PyResult<Self> {
        let mut text = self.text.clone();
        for (key, value) in &values {
            text = edit::with_value(&text, key, value).refuse(None)?;
        }
        // The text is not the user's own any more: a line number would mislead.
        let profile = parse(&text, base)?.map_err(|error| match error {
            ProfileError::Text { reason, .. } => raise(&reason, keys(&values).as_deref(), None),
            ProfileError::Value { key, value, reason, .. } => {
                raise(&format!("{key} = {value} is impossible: {reason}"), Some(&key), None)
            }
            other => crate::error::exception(&other, None),
        })?;
        Ok(Self { text, folder: self.folder.clone(), profile: Arc::new(profile) })
    }

    #[getter]
    fn text(&self) -> &str {
        &self.text
    }

    #[getter]
    fn folder(&self) -> PathBuf {
        self.folder.clone()
    }

    #[getter]
    fn name(&self) -> &str {
        &self.profile.name
    }

    /// All values, by section and key.
    #[getter]
    fn values<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        Ok(pythonize::pythonize(py, &*self.profile)?)
    }

    /// Every key that has a value, as TOML: the same for two profiles that mean the same.
    #[getter]
    fn whole_text(&self) -> PyResult<String> {
        self.profile.toml_text().refuse(None)
    }

    /// What does not fit, as sentences.
    #[getter]
    fn notes(&self) -> Vec<String> {
        self.profile.notes()
    }
}

/// The keys, for people.
fn keys(values: &[(String, String)]) -> Option<String> {
    let keys: Vec<&str> = values.iter().map(|(key, _)| &**key).collect();
    (!keys.is_empty()).then(|| keys.join(", "))
}
