//! What filled sheets say of valleys between beads, humps, craters and corners over what was varied.

use super::Parameter;
use super::shape::{CORNER, ENDS, OVERLAP};
use super::sheet::{self, Readings, SheetError};
use crate::bead::library::{Estimate, Input, LibraryError, Measured, Response, Surface, along, code, grid, t_95};

/// What the trials of a sheet were welded for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Subject {
    /// Humps and craters.
    Ends,
    /// The metal that piles up at corners.
    Corners,
    /// The valleys between beads side by side.
    Overlaps,
}

/// Fits of what was measured at the starts and ends of beads, at corners, or of beads side by side.
pub struct Found {
    /// Which of them.
    pub subject: Subject,
    /// Names of the two values that are fitted: heights of humps and depths of craters, the excess height of corners and their
    /// inner radius, or the depth of the deepest valley and the height of the beads, mm.
    pub names: [&'static str; 2],
    /// How good the fits are.
    pub responses: [Response; 2],
    /// For hump and crater, the length over which each fades, mm: the mean over the trials that have one, and the interval in which
    /// the next is expected.
    pub lengths: [Option<Estimate>; 2],
    /// What the fit had to leave out, as sentences.
    pub notes: Vec<String>,
    /// What all trials have in common of starts and ends.
    pub held: Vec<(Parameter, f64)>,
    factors: Vec<Parameter>,
    surface: Surface,
}

/// Settings with which hump and crater are least.
#[derive(Debug, Clone, PartialEq)]
pub struct Best {
    /// The settings that were varied.
    pub settings: Vec<(Parameter, f64)>,
    /// Height of the hump that is left and depth of the crater, mm.
    pub left: [Estimate; 2],
}

/// The widest stepover whose valleys are shallow enough.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Widest {
    /// The stepover as a fraction of the bead's width.
    pub stepover: f64,
    /// Depth of the deepest valley there, mm.
    pub valley: Estimate,
    /// Height of the beads there, mm.
    pub height: Estimate,
    /// Whether no wider one was tried.
    pub is_last: bool,
}

/// Stepovers that are tried, evenly over the range that was welded.
const STEPOVERS: u32 = 400;
/// The grid on which the best settings are sought is made finer about the best so far, down to this part of the range.
const FINEST: f64 = 1e-3;
/// Of settings that do equally well, those with the least power and length are chosen: what a step from the least to the greatest
/// value costs, mm².
const MORE: f64 = 1e-4;

impl Found {
    /// What a sheet says; `None` if it is not one for starts and ends, for corners or for overlaps.
    ///
    /// # Errors
    /// [`FoundError`] for a cell that is not a number, and for too few trials.
    pub fn read(text: &str) -> Result<Option<Self>, FoundError> {
        if let Some(readings) = sheet::readings(text, &ENDS[2..])? {
            let names = ["hump height", "crater depth"];
            return Self::of(&readings, Subject::Ends, names, |cells| [cells[0], cells[2]], [Some(1), Some(3)])
                .map(Some);
        }
        if let Some(readings) = sheet::readings(text, &CORNER)? {
            let excess = |cells: &[Option<f64>]| [cells[0].zip(cells[1]).map(|(corner, legs)| corner - legs), cells[2]];
            return Self::of(&readings, Subject::Corners, ["excess height", "inner radius"], excess, [None; 2])
                .map(Some);
        }
        let Some(readings) = sheet::readings(text, &OVERLAP[1..])? else { return Ok(None) };
        let names = ["deepest valley", "height"];
        Self::of(&readings, Subject::Overlaps, names, |cells| [cells[1], cells[0]], [None; 2]).map(Some)
    }

    /// `values` takes the two fitted values from the cells of a trial, which counts if it has both; `lengths` are the columns with
    /// the lengths that belong to them.
    fn of(
        readings: &Readings,
        subject: Subject,
        names: [&'static str; 2],
        values: fn(&[Option<f64>]) -> [Option<f64>; 2],
        lengths: [Option<usize>; 2],
    ) -> Result<Self, FoundError> {
        let trial = |(set, cells): &(Vec<f64>, Vec<Option<f64>>)| match values(cells) {
            [Some(first), Some(second)] => {
                let length = |k: usize, own: f64| cells[lengths[k]?].filter(|length| own > 0.0 && *length > 0.0);
                let lengths = [length(0, first), length(1, second)];
                Some(Trial { set: set.clone(), values: [first, second], lengths })
            }
            _ => None,
        };
        let kept: Vec<Trial> = readings.trials.iter().filter_map(trial).collect();
        let held = held(&readings.factors, &kept);
        let is_held = |k: usize| held.iter().any(|(factor, _)| *factor == readings.factors[k]);
        let varied: Vec<usize> = (0..readings.factors.len()).filter(|k| !is_held(*k)).collect();
        let unmeasured = readings.trials.len() - kept.len();
        let mut measured = Measured { unmeasured, ..Measured::default() };
        measured.rows = kept.iter().map(|trial| varied.iter().map(|k| trial.set[*k]).collect()).collect();
        if measured.rows.is_empty() {
            return Err(FoundError::Empty(names));
        }
        let inputs = varied.iter().enumerate();
        measured.inputs = inputs.map(|(k, own)| input(readings.factors[*own], k, &measured.rows)).collect();
        let surface = Surface::over(&measured)?;
        let own = |name: &str| readings.factors.iter().copied().find(|factor| factor.name() == name);
        Ok(Self {
            subject,
            names,
            responses: [0, 1].map(|k| surface.response(&kept.iter().map(|trial| trial.values[k]).collect::<Vec<_>>())),
            lengths: [0, 1].map(|k| mean(kept.iter().filter_map(|trial| trial.lengths[k]).collect())),
            held,
            notes: surface.notes.clone(),
            factors: surface.measured.inputs.iter().filter_map(|input| own(&input.name)).collect(),
            surface,
        })
    }

    /// Each combination that was measured, with the fitted values there.
    pub fn fitted(&self) -> Vec<(Vec<f64>, [Estimate; 2])> {
        let mut combinations = self.surface.measured.rows.clone();
        combinations.sort_by(|a, b| a.partial_cmp(b).unwrap_or(std::cmp::Ordering::Equal));
        combinations.dedup();
        let at = |values: Vec<f64>| Some((self.at(&code(&self.surface.measured.inputs, &values))?, values));
        combinations.into_iter().filter_map(at).map(|(fit, values)| (values, fit)).collect()
    }

    /// What varies, in the order of the values of [`fitted`](Self::fitted).
    pub fn factors(&self) -> &[Parameter] {
        &self.factors
    }

    /// Number of trials that were measured.
    pub fn trials(&self) -> usize {
        self.surface.measured.rows.len()
    }

    /// Within the range that was tried, the settings of starts and ends with which the sum of the squares of hump and crater is least;
    /// what else was varied has the value that `nominal` gives.
    ///
    /// # Errors
    /// [`FoundError`] if a nominal value is missing or lies outside the range that was tried.
    pub fn best(&self, nominal: impl Fn(Parameter) -> Option<f64>) -> Result<Best, FoundError> {
        let inputs = &self.surface.measured.inputs;
        let fixed = self.fixed(Parameter::is_of_ends, nominal)?;
        let place = |free: &[f64]| -> Vec<f64> {
            let mut free = free.iter().copied();
            fixed.iter().map(|own| own.unwrap_or_else(|| free.next().unwrap_or_default())).collect()
        };
        let misses = |free: &[f64]| {
            let more = free.iter().map(|own| MORE * (own + 1.0) / 2.0).sum::<f64>();
            let values = self.values(&place(free));
            values.map_or(f64::INFINITY, |values| values.iter().map(|own| own.powi(2)).sum::<f64>() + more)
        };
        let count = fixed.iter().filter(|own| own.is_none()).count();
        let mut best = (f64::INFINITY, vec![0.0; count]);
        // Each grid reaches to the neighbours of the best point of the one before.
        let finer = 2.0 / (along(count) - 1) as f64;
        for step in std::iter::successors(Some(1.0), |step| Some(step * finer)).take_while(|step| *step > FINEST) {
            let middle = best.1.clone();
            let about = |point: Vec<f64>| -> Vec<f64> {
                middle.iter().zip(point).map(|(middle, by)| (middle + step * by).clamp(-1.0, 1.0)).collect()
            };
            let tried = grid(count).map(about).map(|point| (misses(&point), point));
            best = tried.fold(best, |best, own| if own.0 < best.0 { own } else { best });
        }
        let coded = place(&best.1);
        let left = self.at(&coded).ok_or(FoundError::Unlike)?;
        let varied = self.factors.iter().zip(inputs).zip(&coded);
        let settings = varied.map(|((factor, input), own)| (*factor, input.value(*own)));
        Ok(Best { settings: settings.filter(|(factor, _)| factor.is_of_ends()).collect(), left })
    }

    /// The widest stepover, within what was tried, whose deepest valley is expected to be at most `deepest` mm deep; what else was
    /// varied has the value that `nominal` gives.
    ///
    /// # Errors
    /// [`FoundError`] if the stepover was not varied, a nominal value lies outside the range that was tried, or all valleys are
    /// deeper.
    pub fn widest(&self, deepest: f64, nominal: impl Fn(Parameter) -> Option<f64>) -> Result<Widest, FoundError> {
        let place = self.factors.iter().position(|factor| *factor == Parameter::Stepover);
        let place = place.ok_or(FoundError::Stepover)?;
        let fixed = self.fixed(|factor| factor == Parameter::Stepover, nominal)?;
        let along = |step: u32| {
            let mut coded: Vec<f64> = fixed.iter().map(|own| own.unwrap_or_default()).collect();
            coded[place] = 1.0 - 2.0 * f64::from(step) / f64::from(STEPOVERS);
            let [valley, height] = self.at(&coded)?;
            let stepover = self.surface.measured.inputs[place].value(coded[place]);
            Some(Widest { stepover, valley, height, is_last: step == 0 })
        };
        let all: Vec<Widest> = (0..=STEPOVERS).filter_map(along).collect();
        let least = all.iter().map(|own| own.valley.value).min_by(f64::total_cmp).ok_or(FoundError::Unlike)?;
        all.into_iter().find(|own| own.valley.value <= deepest).ok_or(FoundError::Valleys { least, deepest })
    }

    /// The values at which factors are held, coded; `None` for those that are sought.
    fn fixed(
        &self,
        sought: impl Fn(Parameter) -> bool,
        nominal: impl Fn(Parameter) -> Option<f64>,
    ) -> Result<Vec<Option<f64>>, FoundError> {
        let held = |(input, factor): (&Input, &Parameter)| {
            if sought(*factor) {
                return Ok(None);
            }
            let value = nominal(*factor).ok_or(FoundError::Unknown(*factor))?;
            input.check(value)?;
            Ok(Some(code(std::slice::from_ref(input), &[value])[0]))
        };
        self.surface.measured.inputs.iter().zip(&self.factors).map(held).collect()
    }

    fn at(&self, coded: &[f64]) -> Option<[Estimate; 2]> {
        let [first, second] = [0, 1].map(|k| self.surface.at(&self.responses[k], coded));
        Some([first?, second?])
    }

    fn values(&self, coded: &[f64]) -> Option<[f64; 2]> {
        let [first, second] = [0, 1].map(|k| self.surface.value(&self.responses[k], coded));
        Some([first?, second?])
    }
}

/// A trial that was measured: the values of its factors, the two values that are fitted, and the lengths that belong to them.
struct Trial {
    set: Vec<f64>,
    values: [f64; 2],
    lengths: [Option<f64>; 2],
}

/// What all trials that were measured have in common of starts and ends.
fn held(factors: &[Parameter], trials: &[Trial]) -> Vec<(Parameter, f64)> {
    let same = |(k, factor): (usize, &Parameter)| {
        let first = trials.first()?.set[k];
        (factor.is_of_ends() && trials.iter().all(|trial| trial.set[k] == first)).then_some((*factor, first))
    };
    factors.iter().enumerate().filter_map(same).collect()
}

/// A factor as an input, with the range of its values in column `k`.
fn input(factor: Parameter, k: usize, rows: &[Vec<f64>]) -> Input {
    let values = || rows.iter().map(|row| row[k]);
    let (min, max) = (values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max));
    Input { name: factor.name().to_owned(), unit: factor.unit().to_owned(), min, max }
}

/// The mean of values, with the interval in which the next is expected with 95 % probability; `None` without any.
fn mean(values: Vec<f64>) -> Option<Estimate> {
    let count = values.len() as f64;
    let value = values.iter().sum::<f64>() / count;
    let square = values.iter().map(|own| (own - value).powi(2)).sum::<f64>();
    match values.len() {
        0 => None,
        1 => Some(Estimate { value, plus_minus: f64::INFINITY }),
        n => Some(Estimate { value, plus_minus: t_95(n - 1) * (square / (count - 1.0) * (1.0 + 1.0 / count)).sqrt() }),
    }
}

/// Why a sheet says nothing of starts, ends, corners or overlaps.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum FoundError {
    /// No sheet, or one with a cell that is not a number.
    #[error(transparent)]
    Sheet(#[from] SheetError),
    /// Trials that allow no fit.
    #[error(transparent)]
    Library(#[from] LibraryError),
    /// Nothing was filled in.
    #[error("no trial has both {} and {} yet: fill in their columns of the sheet.", .0[0], .0[1])]
    Empty([&'static str; 2]),
    /// What was varied, and the profile does not have.
    #[error("the trials vary {0}, which the profile does not have: name the profile with which they were welded (-p).")]
    Unknown(Parameter),
    /// Beads side by side at one distance only.
    #[error("the stepover was not varied: weld beads side by side with --vary stepover=MIN..MAX.")]
    Stepover,
    /// Beads too far apart.
    #[error(
        "the shallowest valley is {least:.2} mm deep, and {deepest:.2} mm are allowed: weld beads closer together, or allow deeper \
         valleys (--valley)."
    )]
    Valleys {
        /// Depth of the shallowest valley, mm.
        least: f64,
        /// The depth that is allowed, mm.
        deepest: f64,
    },
    /// A point between trials that are too far apart.
    #[error("the process of the profile is too far from all trials together: weld some with it.")]
    Unlike,
}
