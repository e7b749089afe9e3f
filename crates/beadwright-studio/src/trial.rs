//! A remedy that is tried: the plan as it was beside the plan as it is with it, until it is kept or taken back.

use crate::project::Project;
use crate::remedy::Change;
use crate::state::{PlanState, Rows};

/// A change that is tried.
pub(crate) struct Trial {
    pub(crate) change: Change,
    /// The value that it replaces, as in TOML.
    pub(crate) from: Option<String>,
    /// The plan before.
    pub(crate) before: Rows,
    /// The project before.
    pub(crate) was: Project,
    /// The project with the change.
    pub(crate) tried: Project,
}

/// What is found in a plan, and its totals; `None` until they are known.
pub(crate) fn figures(plan: &PlanState) -> Option<Rows> {
    if !plan.is_complete() || !plan.is_of_last_request() {
        return None;
    }
    let found = [("serious-count", plan.serious().count()), ("findings", plan.found())];
    Some(found.map(|(name, count)| (name, count.to_string())).into_iter().chain(plan.totals()).collect())
}
