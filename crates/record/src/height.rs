//! Heights of passes, as scans of their layers show them.

use crate::figures::Measured;
use crate::finding::{Finding, Kind, stretch};
use crate::planned::{PlannedPass, Spot};
use crate::record::Record;
use crate::settings::Settings;

/// Heights along a planned pass, where a scan shows it.
#[derive(Debug, Clone, PartialEq)]
pub struct Heights {
    /// Index of the pass.
    pub pass: usize,
    /// Distance between neighbouring places, mm.
    pub step: f64,
    /// Fraction of the length of the pass, 0 to 1, that the scan shows.
    pub share: f64,
    /// The places that it shows, in the order of welding.
    pub tops: Vec<Top>,
}

/// The top of a pass at one of its places.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Top {
    /// Where the torch was.
    pub spot: Spot,
    /// When it was planned to be there, s from the start of the build.
    pub time: f64,
    /// Planned height, mm.
    pub planned: f64,
    /// Measured height, mm.
    pub measured: f64,
}

impl Top {
    /// Measured minus planned height, mm.
    pub fn off(&self) -> f64 {
        self.measured - self.planned
    }
}

impl Record {
    /// Adds what scans show: the figures of each pass, and where its height is out of the window of the settings.
    ///
    /// ```
    /// use bead_record::{Heights, Place, PlannedPass, Settings, Source, Top, join};
    /// use glam::DVec3;
    ///
    /// let place = |x: f64, time: f64| Place { at: DVec3::new(x, 0.0, 2.0), time, feed: 8.0, speed: 8.0 };
    /// let path = vec![place(0.0, 0.0), place(80.0, 10.0)];
    /// let pass = PlannedPass {
    ///     layer: 1, pass: 1, struck: 0.0, out: 10.0, path, current: None, voltage: None, temperature: None,
    /// };
    /// let log = Source::read("power.csv", "time_s,current_a\n0,0\n5,180\n15,0\n".as_bytes(), &[])?;
    /// let settings = Settings { height: Some(0.5), ..Settings::default() };
    /// let mut record = join(std::slice::from_ref(&pass), &[log], &settings)?;
    /// // A bump between 40 and 50 mm.
    /// let height = |along: f64| if (40.0..=50.0).contains(&along) { 2.8 } else { 2.1 };
    /// let top = |(time, spot): (f64, bead_record::Spot)| {
    ///     Top { spot, time, planned: 2.0, measured: height(spot.along) }
    /// };
    /// let tops = pass.every(2.0).into_iter().map(top).collect();
    /// record.add_heights(&[pass], &[Heights { pass: 0, step: 2.0, share: 1.0, tops }], &settings);
    /// let place = record.findings[0].place.ok_or("no place")?;
    /// assert_eq!(place.map(|spot| spot.along), [40.0, 50.0]);
    /// assert_eq!(record.passes[0].height[0], Some(2.0));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn add_heights(&mut self, passes: &[PlannedPass], heights: &[Heights], settings: &Settings) {
        for own in heights {
            let (Some(pass), Some(row)) = (passes.get(own.pass), self.passes.get_mut(own.pass)) else { continue };
            let mean = |of: fn(&Top) -> f64| Measured::of(own.tops.iter().map(of)).map(|of| of.mean);
            row.height = [mean(|top| top.planned), mean(|top| top.measured)];
            row.off = Measured::of(own.tops.iter().map(Top::off));
            row.scanned = Some(own.share);
            let found = settings.height.map(|limit| outside(own, pass, limit)).unwrap_or_default();
            row.findings += found.len();
            self.findings.extend(found);
        }
        self.findings.sort_by_key(|finding| (finding.kind, finding.pass));
    }
}

/// Neighbouring places lie no farther apart than this many steps; beyond, nothing was measured between them.
const APART: f64 = 1.5;
/// Fewer places out of the window than this are noise.
const FEWEST: usize = 2;

/// The stretches that are higher or lower than planned by more than `limit`, mm.
fn outside(heights: &Heights, pass: &PlannedPass, limit: f64) -> Vec<Finding> {
    let is_out = |top: &Top| top.off().abs() > limit;
    let goes_on = |a: &Top, b: &Top| {
        let near = b.spot.along - a.spot.along <= APART * heights.step;
        near && is_out(a) == is_out(b) && a.off().signum() == b.off().signum()
    };
    let stretches = heights.tops.chunk_by(goes_on).filter(|tops| tops.len() >= FEWEST && tops.iter().all(is_out));
    let finding = |tops: &[Top]| {
        let ends = [tops[0], tops[tops.len() - 1]];
        let place = ends.map(|top| top.spot);
        let worst = tops.iter().map(Top::off).max_by(|a, b| a.abs().total_cmp(&b.abs())).unwrap_or_default();
        let way = if worst > 0.0 { "higher" } else { "lower" };
        let sentence = format!(
            "Layer {}, pass {}: its top is up to {:.2} mm {way} than planned, {}.",
            pass.layer,
            pass.pass,
            worst.abs(),
            stretch(&place)
        );
        let planned = Some(ends.map(|top| top.time));
        Finding { kind: Kind::Height, pass: Some(heights.pass), time: None, planned, place: Some(place), sentence }
    };
    stretches.map(finding).collect()
}
