//! The goals of a page, and whether they are reached.

use beadwright::report::sheet::{Row, Sheet};

/// Something that can be reached or not.
#[derive(Debug, Clone, PartialEq)]
pub struct Goal {
    /// What, and under which conditions.
    pub what: String,
    /// Our figure; the worst one of all turns.
    pub ours: String,
    /// The paper's figure.
    pub paper: String,
    /// Whether ours is good enough.
    pub reached: bool,
}

impl Goal {
    /// A goal.
    pub fn new(what: &str, ours: String, paper: &str, reached: bool) -> Self {
        Self { what: what.to_owned(), ours, paper: paper.to_owned(), reached }
    }

    fn verdict(&self) -> &'static str {
        if self.reached { "reached" } else { "not reached" }
    }

    /// The goal as a line for the terminal.
    pub fn line(&self) -> String {
        format!("{:<11}  {}: {} (paper: {})", self.verdict(), self.what, self.ours, self.paper)
    }

    fn row(&self) -> Row {
        [self.what.as_str(), self.verdict(), &self.ours, &self.paper].map(|text| (text.to_owned(), false)).to_vec()
    }
}

/// Goals as a table of the book.
pub fn markdown(goals: &[Goal]) -> String {
    let cell = |text: &str| text.replace('|', "\\|");
    let row = |goal: &Goal| {
        let [what, ours, paper] = [&goal.what, &goal.ours, &goal.paper].map(|text| cell(text));
        format!("| {what} | {paper} | {ours} | {} |\n", goal.verdict())
    };
    let rows: String = goals.iter().map(row).collect();
    format!("| claim and conditions | the paper | ours | |\n| --- | --- | --- | --- |\n{rows}")
}

/// Puts goals on a page as a table.
pub fn tabulate(page: &mut Sheet, goals: &[Goal]) {
    page.heading("Reached or not");
    page.table(&["what", "", "ours", "the paper"], &goals.iter().map(Goal::row).collect::<Vec<_>>());
}
