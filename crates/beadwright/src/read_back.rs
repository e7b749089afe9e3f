//! Programs and plans read back as layers that can be judged: the same for the command, the studio and Python.

use crate::chart::Chart;
use crate::compare::Totals;
use crate::deposit::{DepositSettings, MANY_POINTS};
use crate::dialect::reading::{self, ArcCodes, Fault, FindModule, Metal, Options, ReadError};
use crate::layer::{self, Extent, Layer};
use crate::metrics::Metrics;
use crate::model::Mesh;
use crate::plan;
use crate::plan_file::PlanFile;
use crate::process::Follow;
use crate::profile::{BUILT_IN, Profile};
use crate::simulate;
use crate::task::{Cancelled, Task};
use planar::Bounds;
use std::borrow::Cow;

/// How a program is read.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Reading {
    /// Words that strike the arc, such as `M64 P1`, instead of those of the profile and of M3 and M4 in G-code.
    pub arc_on: Vec<String>,
    /// Words that end the arc, instead of those of the profile and of M5 in G-code.
    pub arc_off: Vec<String>,
    /// Bead width, mm, instead of the one from the program or the profile.
    pub bead_width: Option<f64>,
    /// Whether the user chose the profile. A printer's program that names no profile is not read with a default one,
    /// which would lay a welding bead where filament is meant.
    pub profile_chosen: bool,
}

impl Reading {
    /// What switches the arc: the words given, or those of the profile.
    fn codes(&self, templates: ArcCodes) -> ArcCodes {
        let given = |words: &[String], templates| if words.is_empty() { templates } else { words.to_vec() };
        let alone = !self.arc_on.is_empty() || !self.arc_off.is_empty();
        ArcCodes { on: given(&self.arc_on, templates.on), off: given(&self.arc_off, templates.off), alone }
    }
}

/// A program or a plan as layers.
#[derive(Debug, Clone)]
pub struct ReadBack {
    /// Name of its file.
    pub name: String,
    /// Its language; `plan` for a plan.
    pub language: &'static str,
    /// Its layers, with the islands of the part where there is one.
    pub layers: Vec<Layer>,
    /// Its arc starts, lengths, times and metal.
    pub totals: Totals,
    /// How its layers are judged.
    pub settings: DepositSettings,
    /// What the grid is fitted to: the box around all layers seen from above, and their number; for a plan, as when it was
    /// made.
    pub over: Option<(Bounds, usize)>,
    /// What was assumed, as sentences.
    pub notes: Vec<String>,
    /// Dangerous lines of a program.
    pub faults: Vec<Fault>,
}

/// Why a program cannot be read back.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReadBackError {
    /// It is in no known language, or holds nothing to judge.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// It is for a printer, and its bead is unknown.
    #[error(
        "this is a printer's program, and it names no built-in profile: give the profile of its bead, such as fdm-abs-0.4 or \
         one of your own."
    )]
    Printer,
    /// Stopped by the caller.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// A grid that is too fine or too coarse.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error("a grid of points {step} mm apart is impossible here; {least:.3} to {COARSEST} mm is possible.")]
pub struct GridError {
    step: f64,
    least: f64,
}

/// The greatest distance of grid points, mm.
const COARSEST: f64 = 100.0;
/// The least distance of grid points, mm.
const FINEST: f64 = 1e-3;

/// Settings with the grid asked for, mm between its points, or with one that fits layers within `bounds`.
///
/// ```
/// use beadwright::planar::{Bounds, DVec2};
/// use beadwright::{Profile, plan, read_back::with_grid};
///
/// let settings = plan::deposit_settings(&Profile::built_in("cmt-al2319-kuka")?);
/// let bounds = Bounds { min: DVec2::ZERO, max: DVec2::splat(100.0) };
/// assert_eq!(with_grid(Some(0.5), settings, &bounds, 10)?.step, 0.5);
/// assert!(with_grid(Some(0.0), settings, &bounds, 10).is_err());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`GridError`] for a distance that gives no grid, or one of more than [`MANY_POINTS`].
pub fn with_grid(
    step: Option<f64>,
    settings: DepositSettings,
    bounds: &Bounds,
    layers: usize,
) -> Result<DepositSettings, GridError> {
    let Some(step) = step else { return Ok(settings.fitted_to(bounds, layers)) };
    let size = bounds.size();
    let least = (size.x * size.y / MANY_POINTS).sqrt().max(FINEST);
    // In whole thousandths, rounded up, so that the value named in the error is accepted.
    let least = (least * 1e3).ceil() / 1e3;
    if (least..=COARSEST).contains(&step) {
        Ok(DepositSettings { step, ..settings })
    } else {
        Err(GridError { step, least })
    }
}

/// The built-in profile that one of our programs names in its first comments, after the part: `; cross, fdm-abs-0.4`.
///
/// ```
/// use beadwright::read_back::named_profile;
///
/// assert_eq!(named_profile("; cross, fdm-abs-0.4\nG28\n"), Some("fdm-abs-0.4"));
/// assert_eq!(named_profile("G21 G90\nG28\n"), None);
/// ```
pub fn named_profile(text: &str) -> Option<&'static str> {
    const HEAD: usize = 40;
    let named = |line: &str| {
        let line = line.trim_end_matches(|c: char| !c.is_ascii_alphanumeric()).to_ascii_lowercase();
        BUILT_IN.iter().map(|(name, _)| *name).find(|name| line.strip_suffix(name).is_some_and(|l| l.ends_with(", ")))
    };
    text.lines().take(HEAD).find_map(named)
}

/// The language of a plan.
const PLAN: &str = "plan";

impl ReadBack {
    /// The layers as the deposit model judges them: those of a plan as its chart shows them ([`plan::even`],
    /// [`plan::unrolled_once`]).
    pub fn judged(&self, profile: &Profile) -> Cow<'_, [Layer]> {
        let differ = |chart: &Chart| chart.has_wedges() || chart.goes_around();
        if self.language != PLAN || !profile.layers.charts().any(differ) {
            return Cow::Borrowed(&self.layers);
        }
        let shown = |layer: &Layer| plan::unrolled_once(&plan::even(layer, profile), profile).into_owned();
        Cow::Owned(self.layers.iter().map(shown).collect())
    }

    /// A plan, judged with the profile that it carries or the one that was asked for.
    pub fn plan(name: &str, plan: PlanFile, profile: &Profile) -> Self {
        let own = plan.settings.filter(|_| plan.profile.is_none());
        let settings = own.unwrap_or_else(|| plan::deposit_settings(profile));
        let mut metrics = Metrics::new(profile);
        plan.layers.iter().for_each(|layer| metrics.add(layer));
        let Extent { low, high, .. } = plan.header.extent;
        Self {
            name: name.to_owned(),
            language: PLAN,
            layers: plan.layers,
            totals: Totals::of_plan(&metrics),
            settings,
            over: Some(plan::grid_over(profile, (low, high))),
            notes: Vec::new(),
            faults: Vec::new(),
        }
    }

    /// A program in any known language; `name` is that of its file, and `module` gives the text of a module by its
    /// name. With a part, its slices become the islands of the layers, and a program that lies elsewhere is centred on
    /// it.
    ///
    /// ```
    /// use beadwright::read_back::{ReadBack, Reading};
    /// use beadwright::{Profile, Task};
    ///
    /// // 60 mm at 240 mm/min, the speed of the profile: the bead has its width.
    /// let text = "G21 G90\nG0 X0 Y0 Z1.35\nM3 S1\nG1 X60 F240\nM5\n";
    /// let (profile, reading) = (Profile::built_in("plasma-304-cnc")?, Reading { profile_chosen: true, ..Reading::default() });
    /// let read = ReadBack::program("bar.nc", text, &mut |_| None, &profile, &reading, None, &Task::new())?;
    /// let pass = &read.layers[0].passes[0];
    /// assert_eq!((read.totals.arc_starts, pass.length()), (1, 60.0));
    /// assert!((pass.width.max() - profile.bead.width).abs() < 1e-9);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`ReadBackError`].
    pub fn program(
        name: &str,
        text: &str,
        module: &mut FindModule<'_>,
        profile: &Profile,
        reading: &Reading,
        part: Option<&Mesh>,
        task: &Task,
    ) -> Result<Self, ReadBackError> {
        let dialect = reading::recognise(text).map(|dialect| dialect.name);
        let options = profile.reading_options(Some(name), dialect);
        let options = Options { arc: reading.codes(options.arc), ..options };
        let mut program = reading::read(text, module, &options)?;
        let named = named_profile(text).is_some();
        let printer = program.moves.iter().any(|step| matches!(step.metal, Metal::Volume(_)));
        if printer && !named && !reading.profile_chosen {
            return Err(ReadBackError::Printer);
        }
        let settings = plan::deposit_settings(profile);
        let mut layers = simulate::layers(&program, &settings, &profile.bead.law, &profile.process, reading.bead_width);
        let mut notes = program.notes.clone();
        if !reading.profile_chosen {
            let source = if named { "the program names it" } else { "no other was chosen" };
            notes.insert(0, format!("Read with the profile {} ({source}).", profile.name));
        }
        if profile.process.follow == Follow::WireFeed && !printer {
            notes.push(
                "The profile changes the wire feed along a pass (process.follow), but wire feeds are not read from programs: all \
                 beads are judged with the nominal one. Judge plan.json for their true widths."
                    .to_owned(),
            );
        }
        let (rapids, length) = program.take_rapids_at(profile.travel.speed);
        if rapids > 0 {
            notes.push(format!(
                "Rapid and joint moves have no speed in the program: {rapids} of them, {:.2} m, were timed at the profile's \
                 travel.speed, {} mm/s.",
                length / 1e3,
                profile.travel.speed
            ));
        }
        if let Some(mesh) = part {
            if let Some(by) = simulate::shift(&layers, mesh, &settings) {
                simulate::translate(&mut layers, by);
                notes.push(format!(
                    "The program was moved by x {:.2} y {:.2} mm, so that its middle is the part's.",
                    by.x, by.y
                ));
            }
            simulate::outline(&mut layers, mesh, profile.slice_options(), task)?;
        }
        let mut totals = Totals::of_program(&program.totals(), &layers, profile);
        if let Some(motion) = &profile.motion {
            totals.total_time_s = program.seconds(motion);
        }
        let over = layer::bounds(&layers).map(|bounds| (bounds, layers.len()));
        let (name, language) = (name.to_owned(), program.language);
        Ok(Self { name, language, layers, totals, settings, over, notes, faults: program.faults })
    }

    /// How the layers are judged: with the grid asked for, mm between its points, or one that fits them.
    ///
    /// # Errors
    /// [`GridError`].
    pub fn deposit_settings(&self, grid: Option<f64>) -> Result<DepositSettings, GridError> {
        match &self.over {
            Some((bounds, layers)) => with_grid(grid, self.settings, bounds, *layers),
            None => Ok(self.settings),
        }
    }
}
