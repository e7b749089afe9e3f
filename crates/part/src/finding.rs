//! What is wrong or doubtful with a plan, wherever it was found: one type for checks, warnings, refusals, notes and reach.

use glam::DVec3;
use serde::{Deserialize, Serialize};

/// How much a finding matters, the worst first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Severity {
    /// The program should not be started as it is.
    Serious,
    /// The part may not turn out as intended.
    Doubt,
    /// Something was done that people should know about.
    Note,
}

impl Severity {
    /// The word before a finding in a terminal.
    pub fn word(self) -> &'static str {
        match self {
            Self::Serious => "serious",
            Self::Doubt => "warning",
            Self::Note => "note",
        }
    }

    /// The word before a finding on a page.
    pub fn title(self) -> &'static str {
        match self {
            Self::Serious => "Serious",
            Self::Doubt => "Warning",
            Self::Note => "Note",
        }
    }
}

/// Something that is wrong, doubtful or worth knowing.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Finding {
    /// What kind of finding: the name of a check or a warning, or `reach`, `model` (what was repaired), `plan` (a note),
    /// `lost-geometry` or `refused`.
    pub kind: &'static str,
    /// How much it matters.
    pub severity: Severity,
    /// How many findings this one stands for; it is the first of a check's findings, and the largest of a warning's.
    pub count: usize,
    /// Index of the layer, from 0; `None` if it concerns the whole plan.
    pub layer: Option<usize>,
    /// Index of the pass in its layer, from 0.
    pub pass: Option<usize>,
    /// Position, mm; on a layer that is not level, in unrolled coordinates.
    pub place: Option<DVec3>,
    /// Size, in the unit that the sentence names.
    pub size: Option<f64>,
    /// A sentence that says what is wrong, and where.
    pub text: String,
    /// A sentence that says what to do.
    pub remedy: Option<String>,
}

/// A remedy for a kind of finding in terms of the user's program (flags, arguments, buttons), as a sentence.
pub type Words = fn(kind: &str) -> Option<&'static str>;

/// Whether findings of a kind say that there is no metal underneath to weld on.
pub fn lacks_metal_below(kind: &str) -> bool {
    let kinds = ["high-start", "nothing-below", "in-the-air", "over-unwelded", "hanging-island", "overhang"];
    kinds.contains(&kind)
}

/// Capitalises and punctuates part of a sentence.
pub fn as_sentence(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map(|first| first.to_uppercase().chain(letters).chain(['.']).collect()).unwrap_or_default()
}

impl Finding {
    /// A finding about the whole plan.
    pub fn new(kind: &'static str, severity: Severity, text: String) -> Self {
        Self { kind, severity, count: 1, layer: None, pass: None, place: None, size: None, text, remedy: None }
    }

    /// The finding with its size, in the unit of its sentence.
    #[must_use]
    pub fn sized(self, size: f64) -> Self {
        Self { size: Some(size), ..self }
    }

    /// Adds the remedy in terms of the user's program.
    #[must_use]
    pub fn in_words(mut self, words: Words) -> Self {
        let sentences = self.remedy.take().into_iter().chain(words(self.kind).map(str::to_owned));
        self.remedy = sentences.reduce(|all, more| format!("{all} {more}"));
        self
    }

    /// What is wrong and what to do, in sentences for people.
    ///
    /// ```
    /// use bead_part::finding::{Finding, Severity};
    ///
    /// let found = Finding::new("reach", Severity::Serious, "Layer 3 is out of reach.".to_owned());
    /// let found = Finding { remedy: Some("Move the part closer.".to_owned()), ..found };
    /// assert_eq!(found.sentence(), "Layer 3 is out of reach. Move the part closer.");
    /// assert!(found.severity < Severity::Doubt, "the worst come first");
    /// ```
    pub fn sentence(&self) -> String {
        self.remedy.as_ref().map_or_else(|| self.text.clone(), |remedy| format!("{} {remedy}", self.text))
    }
}
