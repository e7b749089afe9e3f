//! A remedy that is tried: the plan as it was beside the plan as it is with it, until it is kept or taken back.

use crate::form;
use crate::known::Known;
use crate::panels::rows_of;
use crate::project::Project;
use crate::remedy::Change;
use crate::state::PlanState;
use crate::studio::Studio;

/// Figures of a plan: their names, and their values.
pub(crate) type Rows = Vec<(&'static str, String)>;

/// A change that is tried.
pub(crate) struct Trial {
    pub(crate) change: Change,
    /// The value that it replaces, as in TOML.
    pub(crate) from: Option<String>,
    /// The plan before.
    pub(crate) before: Rows,
    /// The project with the change.
    tried: Project,
}

/// What is found in a plan, and its totals; `None` until they are known.
pub(crate) fn figures(plan: &PlanState) -> Option<Rows> {
    if !plan.is_complete() || !plan.is_of_last_request() {
        return None;
    }
    let found = [("serious-count", plan.serious().count()), ("findings", plan.found())];
    Some(found.map(|(name, count)| (name, count.to_string())).into_iter().chain(rows_of(plan)).collect())
}

impl Studio {
    /// Makes a change, to be kept or taken back.
    pub(crate) fn begin_trial(&mut self, change: Change) {
        let Some(before) = figures(&self.plans.own) else { return };
        let from = self.known().value_now(change.key);
        self.open.project.seal();
        self.set_value(change.key, &change.value);
        self.open.project.seal();
        self.open.trial = Some(Trial { change, from, before, tried: self.project().clone() });
    }

    /// Keeps the change that is tried, or takes it back.
    pub(crate) fn end_trial(&mut self, keeps: bool) {
        let takes_back = self.known().trial().is_some() && !keeps;
        self.open.trial = None;
        if takes_back {
            self.step_back();
        }
    }
}

impl<'a> Known<'a> {
    /// The change that is tried, as long as nothing else is changed.
    pub(crate) fn trial(self) -> Option<&'a Trial> {
        self.open.trial.as_ref().filter(|trial| trial.tried == *self.project())
    }

    /// A value of the profile, as in TOML; `None` where the profile does not set it.
    pub(crate) fn value_now(self, key: &str) -> Option<String> {
        form::value(&self.parsed()?.values, key).map(|value| value.to_string())
    }
}
