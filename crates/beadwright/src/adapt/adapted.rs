//! A scan, aligned and compared, with the layers that follow it and their files: the same for the command and Python.

use super::page::page;
use super::{Align, AlignError, Aligned, Followed, Rules, Scan, SeeError, Seen, Spread, align, follow, see};
use crate::dialect::{Chunk, DialectError};
use crate::files::{PlanFiles, Programs, Selection};
use crate::layer::{Extent, Layer};
use crate::metrics::Metrics;
use crate::model::RepairReport;
use crate::plan::{self, Header, Summary};
use crate::profile::Profile;
use crate::warning::Warnings;

/// A plan of which some layers are welded.
#[derive(Debug, Clone, Copy)]
pub struct Unfinished<'a> {
    /// Names of part, profile and strategy.
    pub header: &'a Header,
    /// All planned layers.
    pub layers: &'a [Layer],
    /// How they are welded.
    pub profile: &'a Profile,
    /// Number of layers that are welded.
    pub number: usize,
}

/// The layers that follow a scan.
#[derive(Debug, Clone)]
pub struct Adapted {
    /// The scan where it lies on the part.
    pub aligned: Aligned,
    /// The scan compared with the plan.
    pub seen: Seen,
    /// The layers that follow.
    pub followed: Followed,
    /// Number of layers that were welded.
    pub number: usize,
    /// The scan in words.
    scanned: String,
    how: Align,
    rules: Rules,
}

/// Why no layers can follow a scan.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum AdaptError {
    /// Layers around an axis, along a guide or over a surface.
    #[error("scans are compared with level layers only, and these are not level (layers.chart).")]
    NotLevel,
    /// The scan cannot be aligned.
    #[error(transparent)]
    Align(#[from] AlignError),
    /// The scan cannot be of this build.
    #[error(transparent)]
    See(#[from] SeeError),
}

impl Adapted {
    /// Aligns a scan with what is welded of a plan, compares the two, and corrects the layers that follow.
    ///
    /// # Errors
    /// [`AdaptError`].
    pub fn of(build: Unfinished<'_>, scan: Scan, how: Align, rules: Rules) -> Result<Self, AdaptError> {
        let Unfinished { layers, profile, number, .. } = build;
        if !profile.layers.are_level() {
            return Err(AdaptError::NotLevel);
        }
        let Scan { points, format, without_height, .. } = scan;
        let missing =
            if without_height > 0 { format!(", {without_height} more without a height") } else { String::new() };
        let scanned = format!("{format} of {} points{missing}", points.len());
        let width = profile.bead.width;
        let aligned = align(points, layers.get(..number).unwrap_or(layers), width, how)?;
        let seen = see(layers, number, &aligned.points, plan::deposit_settings(profile).nominal)?;
        let followed = follow(layers, number, &seen, width, &rules);
        Ok(Self { aligned, seen, followed, number, scanned, how, rules })
    }

    /// What the scan shows and what follows from it, as sentences.
    pub fn sentences(&self) -> Vec<String> {
        let Self { aligned, seen, followed, scanned, how, rules, .. } = self;
        let Spread { mean, rms, low, high } = seen.error;
        let mut sentences = vec![
            format!(
                "Scan: {scanned}; {} of them lie over the layer and cover {:.0} % of it.",
                seen.points,
                100.0 * seen.covered
            ),
            format!("Measured minus predicted: {mean:+.2} mm on average, {low:+.2} to {high:+.2} mm, RMS {rms:.2} mm."),
        ];
        let (shift, turn) = (aligned.shift, aligned.turn.to_degrees());
        if *how != Align::AsIs {
            let height = if aligned.plate { "the plate gave z" } else { "no plate was seen, so z was kept" };
            sentences.push(format!(
                "Aligned: moved by x {:+.2} y {:+.2} z {:+.2} mm, turned by {turn:+.2}°; {height}.",
                shift.x, shift.y, shift.z
            ));
        }
        let (layers, planned) = (followed.layers.len(), followed.planned);
        let Some(first) = followed.layers.first() else {
            sentences.push(format!("The part has reached its height: no layer follows; {planned} were planned."));
            return sentences;
        };
        let (least, most) = (100.0 * followed.metal.0, 100.0 * followed.metal.1);
        sentences.push(format!(
            "{layers} layers follow ({planned} were planned); the next ends at z {:.2} mm with {least:.0} to {most:.0} % of the \
             planned metal.",
            first.z
        ));
        if followed.clipped > 0 {
            sentences.push(format!(
                "{} of {} pieces need more or less than the window of {} to {} times the planned metal: the layers above them make \
                 up for it.",
                followed.clipped, followed.pieces, rules.window.0, rules.window.1
            ));
        }
        let end = followed.end;
        sentences.push(format!(
            "Expected at the end: {:+.2} mm on average, {:+.2} to {:+.2} mm.",
            end.mean, end.low, end.high
        ));
        sentences
    }

    /// The figures as JSON; lengths in mm, the turn in degrees, metal as multiples of the planned metal.
    pub fn json(&self) -> serde_json::Value {
        let Followed { layers, planned, pieces, clipped, metal, end } = &self.followed;
        let Aligned { shift, turn, astray, plate, .. } = &self.aligned;
        serde_json::json!({
            "after_layer": self.number,
            "error": self.seen.error,
            "points": self.seen.points,
            "covered": self.seen.covered,
            "align": { "shift": shift, "turn": turn.to_degrees(), "astray": astray, "plate": plate },
            "layers": layers.len(),
            "planned_layers": planned,
            "metal": [metal.0, metal.1],
            "pieces": pieces,
            "clipped": clipped,
            "end": end,
        })
    }

    /// What the layers that are welded and those that follow have in common; `planned` is that of the plan.
    pub fn header(&self, planned: &Header) -> Header {
        let layers = self.number + self.followed.layers.len();
        Header { extent: Extent { layers, ..planned.extent }, ..planned.clone() }
    }

    /// The totals of the layers that are welded and of those that follow, given their metrics.
    pub fn summary(&self, metrics: Metrics, profile: &Profile) -> Summary {
        let (warnings, forbidden) = (Warnings::default(), profile.forbidden());
        Summary { metrics, warnings, notes: self.sentences(), forbidden, blocked: Vec::new(), grown: None }
    }

    /// Hands over the text of all files, piece by piece: the programs of the layers that follow, the whole plan with them,
    /// and the page `adapt.html`; only the page where no layer follows.
    ///
    /// # Errors
    /// Those of `take`, and a [`DialectError`].
    pub fn files<E: From<DialectError>>(
        &self,
        build: Unfinished<'_>,
        programs: Programs,
        mut take: impl FnMut(Vec<Chunk>) -> Result<(), E>,
    ) -> Result<(), E> {
        let (Unfinished { header, layers, profile, .. }, number) = (build, self.number);
        let (sentences, built) = (self.sentences(), &layers[..number]);
        let z = built.last().map_or(0.0, |layer| layer.z);
        let page = page(&header.part, number, z, &self.seen, &sentences).html();
        take(vec![Chunk::new("adapt.html", page)])?;
        if self.followed.layers.is_empty() {
            return Ok(());
        }
        let all = || built.iter().chain(&self.followed.layers);
        let header = self.header(header);
        let selection = Selection { from: number, ..Selection::default() };
        let (mut files, chunks) = PlanFiles::begin(&header, profile, programs, selection)?;
        take(chunks)?;
        let mut metrics = Metrics::new(profile);
        for layer in all() {
            metrics.add(layer);
            take(files.layer(layer, None))?;
        }
        let mut summary = self.summary(metrics, profile);
        summary.notes.extend(files.notes());
        take(files.end(&summary, &RepairReport::default(), None)?)
    }
}
