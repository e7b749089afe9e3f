//! Heights of passes, as scans of their layers show them.

use crate::figures::Measured;
use crate::finding::{Finding, Kind, stretch};
use crate::planned::PlannedPass;
use crate::record::Record;
use crate::settings::Settings;

/// Heights along a planned pass, where a scan lies over it.
#[derive(Debug, Clone, PartialEq)]
pub struct Heights {
    /// Index of the pass.
    pub pass: usize,
    /// Distance between neighbouring places, mm.
    pub step: f64,
    /// Distance along the pass, rising, and measured minus planned height there, mm.
    pub places: Vec<[f64; 2]>,
}

impl Record {
    /// Adds what scans show: the figures of each pass, and where its height is out of the window of the settings.
    ///
    /// ```
    /// use bead_record::{Heights, Place, PlannedPass, Settings, Source, join};
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
    /// let bump = |along: f64| if (40.0..=50.0).contains(&along) { 0.8 } else { 0.1 };
    /// let places = (0..=40).map(|k| [2.0 * f64::from(k), bump(2.0 * f64::from(k))]).collect();
    /// record.add_heights(&[pass], &[Heights { pass: 0, step: 2.0, places }], &settings);
    /// let place = record.findings[0].place.ok_or("no place")?;
    /// assert_eq!(place.map(|spot| spot.along), [40.0, 50.0]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn add_heights(&mut self, passes: &[PlannedPass], heights: &[Heights], settings: &Settings) {
        for own in heights {
            let (Some(pass), Some(row)) = (passes.get(own.pass), self.passes.get_mut(own.pass)) else { continue };
            row.off = Measured::of(own.places.iter().map(|[_, off]| *off));
            let planned = Measured::of(own.places.iter().map(|[along, _]| pass.at(*along).1.at.z)).map(|z| z.mean);
            row.height = [planned, planned.zip(row.off).map(|(planned, off)| planned + off.mean)];
            let found = settings.height.map(|limit| outside(own, pass, limit)).unwrap_or_default();
            row.findings += found.len();
            self.findings.extend(found);
        }
        self.findings.sort_by_key(|finding| finding.kind);
    }
}

/// Neighbouring places lie no farther apart than this many steps; beyond, nothing was measured between them.
const APART: f64 = 1.5;
/// Fewer places out of the window than this are noise.
const FEWEST: usize = 2;

/// The stretches that are higher or lower than planned by more than `limit`, mm.
fn outside(heights: &Heights, pass: &PlannedPass, limit: f64) -> Vec<Finding> {
    let is_out = |place: &[f64; 2]| place[1].abs() > limit;
    let goes_on = |a: &[f64; 2], b: &[f64; 2]| {
        is_out(a) == is_out(b) && a[1].signum() == b[1].signum() && b[0] - a[0] <= APART * heights.step
    };
    let stretches =
        heights.places.chunk_by(goes_on).filter(|places| places.len() >= FEWEST && places.iter().all(is_out));
    let finding = |places: &[[f64; 2]]| {
        let ends = [places[0], places[places.len() - 1]].map(|place| pass.at(place[0]));
        let place = ends.map(|(_, spot)| spot);
        let worst = places.iter().map(|place| place[1]).max_by(|a, b| a.abs().total_cmp(&b.abs())).unwrap_or_default();
        let way = if worst > 0.0 { "higher" } else { "lower" };
        let sentence = format!(
            "Layer {}, pass {}: its top is up to {:.2} mm {way} than planned, {}.",
            pass.layer,
            pass.pass,
            worst.abs(),
            stretch(&place)
        );
        let planned = Some(ends.map(|(time, _)| time));
        Finding { kind: Kind::Height, pass: Some(heights.pass), time: None, planned, place: Some(place), sentence }
    };
    stretches.map(finding).collect()
}
