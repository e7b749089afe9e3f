//! Thermal eccentricity: how far the heat of a build lies from the middle of its metal.
//!
//! Zhao, Panzer, Zapata, Riegger, Baehr, Zaeh (Journal of Manufacturing Systems, 2025, doi 10.1016/j.jmsy.2025.05.010)
//! compare three scores that they compute from temperatures of a simplified simulation, and find that the one that
//! considers the thermal eccentricity ranks deposition sequences as measured plates do. Only the abstract could be read
//! for this crate, so **all formulas here are our own**: what they share with the study is the idea that heat beside the
//! middle bends the plate.
//!
//! With places *x*, volumes *V* and temperatures *T* of the metal that is there, and the ambient temperature *T₀*:
//!
//! - heat *Q* = Σ *ρc V* (*T* − *T₀*); metal that is colder than its surroundings counts as if it were as warm;
//! - eccentricity *e* = Σ *V* (*T* − *T₀*) *x* / Σ *V* (*T* − *T₀*) − Σ *V x* / Σ *V*, zero while there is no heat;
//! - score = ∫ |*Q e*| d*t* / ∫ *Q* d*t*, with *e* seen from above: the mean eccentricity, weighted by heat.

use crate::error::{DistortError, within};
use glam::DVec3;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// A piece of metal at some time.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Warm {
    /// Its middle, mm.
    pub at: DVec3,
    /// Its volume, mm³.
    pub volume: f64,
    /// Its temperature, °C.
    pub temperature: f64,
}

/// All metal at some time, plate included.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Snapshot {
    /// The time, s.
    pub time: f64,
    /// The metal.
    pub metal: Vec<Warm>,
}

/// Where the heat is at some time.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct Eccentricity {
    /// The time, s.
    pub time: f64,
    /// Heat above ambient temperature, J.
    pub heat: f64,
    /// From the middle of the metal to that of the heat, mm.
    pub offset: DVec3,
}

/// A course of eccentricities in one number each.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct EccentricityScore {
    /// Mean distance seen from above, weighted by heat, mm.
    pub mean: f64,
    /// The largest distance seen from above, mm.
    pub largest: f64,
    /// When that was, s.
    pub largest_at: f64,
    /// Mean offset, weighted by heat, mm: what does not cancel over the build.
    pub lasting: DVec3,
}

/// Eccentricity at each of several times; `heat_capacity` is that of the volume, J/(mm³·K), `ambient` in °C.
///
/// # Errors
/// A heat capacity or an ambient temperature out of range.
///
/// ```
/// use distort::{DVec3, Snapshot, Warm, eccentricity};
///
/// // Two equal blocks 100 mm apart; all of the heat is in the right one.
/// let block = |x: f64, temperature: f64| Warm { at: DVec3::X * x, volume: 1000.0, temperature };
/// let snapshot = Snapshot { time: 0.0, metal: vec![block(0.0, 20.0), block(100.0, 220.0)] };
/// let found = eccentricity(&[snapshot], 4.5e-3, 20.0)?;
/// assert!((found[0].heat - 900.0).abs() < 1e-9);
/// assert!((found[0].offset - DVec3::X * 50.0).length() < 1e-9);
/// # Ok::<(), distort::DistortError>(())
/// ```
pub fn eccentricity(
    snapshots: &[Snapshot],
    heat_capacity: f64,
    ambient: f64,
) -> Result<Vec<Eccentricity>, DistortError> {
    within("heat capacity", heat_capacity, [1e-6, 1.0], "J/(mm³·K)")?;
    within("ambient temperature", ambient, [-100.0, 1000.0], "°C")?;
    let of = |snapshot: &Snapshot| {
        let excess = |piece: &Warm| piece.volume * (piece.temperature - ambient).max(0.0);
        let (volume, middle) = weighted(snapshot.metal.iter().map(|piece| (piece.volume, piece.at)));
        let (warmth, hot) = weighted(snapshot.metal.iter().map(|piece| (excess(piece), piece.at)));
        let offset = if volume > 0.0 && warmth > 0.0 { hot - middle } else { DVec3::ZERO };
        Eccentricity { time: snapshot.time, heat: heat_capacity * warmth, offset }
    };
    Ok(snapshots.par_iter().map(of).collect())
}

/// Sum of weights and the middle of places.
fn weighted(places: impl Iterator<Item = (f64, DVec3)>) -> (f64, DVec3) {
    let (weight, sum) = places.fold((0.0, DVec3::ZERO), |(weight, sum), (w, at)| (weight + w, sum + w * at));
    (weight, if weight > 0.0 { sum / weight } else { DVec3::ZERO })
}

impl EccentricityScore {
    /// The score of a course, times ascending; between two times, values change linearly (trapezoids).
    pub fn of(course: &[Eccentricity]) -> Self {
        let mut score = Self::default();
        let (mut heat, mut moment, mut lasting) = (0.0, 0.0, DVec3::ZERO);
        for pair in course.windows(2) {
            let half = 0.5 * (pair[1].time - pair[0].time).max(0.0);
            for end in pair {
                heat += half * end.heat;
                moment += half * end.heat * end.offset.truncate().length();
                lasting += half * end.heat * end.offset;
            }
        }
        for moment in course {
            let distance = moment.offset.truncate().length();
            if distance > score.largest {
                (score.largest, score.largest_at) = (distance, moment.time);
            }
        }
        if heat > 0.0 {
            (score.mean, score.lasting) = (moment / heat, lasting / heat);
        }
        score
    }
}

/// Metal that is laid at some time, with its heat.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Deposit {
    /// When, s.
    pub time: f64,
    /// Where, mm.
    pub at: DVec3,
    /// Its volume, mm³.
    pub volume: f64,
    /// The heat that comes with it, J.
    pub energy: f64,
}

/// Metal with the heat of deposits that fades as exp(−t/τ), without a heat model: each deposit keeps its heat to itself and
/// loses it with the same time constant, s. `plate` is cold metal that is there from the beginning. Our own simplification.
///
/// # Errors
/// A time constant or a heat capacity out of range.
pub fn cooling(
    deposits: &[Deposit],
    plate: Option<Warm>,
    times: &[f64],
    time_constant: f64,
    heat_capacity: f64,
    ambient: f64,
) -> Result<Vec<Snapshot>, DistortError> {
    within("time constant of cooling", time_constant, [1e-3, 1e7], "s")?;
    within("heat capacity", heat_capacity, [1e-6, 1.0], "J/(mm³·K)")?;
    let at_time = |&time: &f64| {
        let laid = deposits.iter().filter(|deposit| deposit.time <= time && deposit.volume > 0.0);
        let warm = |deposit: &Deposit| {
            let left = deposit.energy * (-(time - deposit.time) / time_constant).exp();
            let temperature = ambient + left / (heat_capacity * deposit.volume);
            Warm { at: deposit.at, volume: deposit.volume, temperature }
        };
        Snapshot { time, metal: plate.into_iter().chain(laid.map(warm)).collect() }
    };
    Ok(times.iter().map(at_time).collect())
}
