//! Heights of passes: figures of what a scan shows, and where they are out of the window.

use crate::cell::{Cell, Clock, log, wall};
use bead_record::{Finding, Heights, Kind, PlannedPass, Record, Settings, Top, join};

const STEP: f64 = 2.0;

fn joined(plan: &[PlannedPass], settings: &Settings) -> Record {
    let cell = Cell::new(plan, 1);
    join(plan, &[log("power.csv", &cell.power_log(&Clock::new(0.0, 0.0), 50.0, &[]))], settings).unwrap()
}

/// What a scan shows of a pass that was planned 1 mm above its path, and is off by the given heights (mm) at its places; nothing where it is not known.
fn heights(plan: &[PlannedPass], pass: usize, off: impl Fn(f64) -> Option<f64>) -> Heights {
    let top = |(time, spot): (f64, bead_record::Spot)| {
        let planned = spot.at.z + 1.0;
        Some(Top { spot, time, planned, measured: planned + off(spot.along)? })
    };
    let places = plan[pass].every(STEP);
    let tops: Vec<Top> = places.iter().copied().filter_map(top).collect();
    Heights { pass, step: STEP, share: tops.len() as f64 / places.len() as f64, tops }
}

fn of_height(record: &Record) -> Vec<&Finding> {
    record.findings.iter().filter(|finding| finding.kind == Kind::Height).collect()
}

#[test]
fn stretches_that_are_low_or_high_end_where_nothing_was_measured() {
    let plan = wall(4, 1, None);
    let settings = Settings { height: Some(0.5), ..Settings::default() };
    let mut record = joined(&plan, &settings);
    // Low up to 20 mm, not seen from 30 to 40 mm, high around there; a single place of spatter.
    let off = |along: f64| match along {
        a if a <= 20.0 => Some(-0.9),
        a if (24.0..30.0).contains(&a) || (40.0..=44.0).contains(&a) => Some(0.8),
        a if (30.0..40.0).contains(&a) => None,
        50.0 => Some(3.0),
        _ => Some(0.0),
    };
    record.add_heights(&plan, &[heights(&plan, 2, off)], &settings);
    let found = of_height(&record);
    let along: Vec<[f64; 2]> = found.iter().map(|found| found.place.unwrap().map(|spot| spot.along)).collect();
    assert_eq!(along, [[0.0, 20.0], [24.0, 28.0], [40.0, 44.0]]);
    assert!(found[0].sentence.contains("0.90 mm lower than planned"), "{}", found[0].sentence);
    assert!(found[1].sentence.contains("0.80 mm higher than planned"), "{}", found[1].sentence);
    for finding in &found {
        let (place, planned) = (finding.place.unwrap(), finding.planned.unwrap());
        let away = [0, 1].map(|end| plan[2].spot(planned[end]).at.distance(place[end].at));
        assert!(away.iter().all(|away| *away < 1e-6), "times and places are the same: {away:?}");
    }
    let row = &record.passes[2];
    let (height, measured) = (row.height.map(Option::unwrap), row.off.unwrap());
    assert!((height[0] - plan[2].path[0].at.z - 1.0).abs() < 1e-9, "{row:?}");
    assert!((height[1] - height[0] - measured.mean).abs() < 1e-9, "{row:?}");
    assert!((measured.min + 0.9).abs() < 1e-9 && (measured.max - 3.0).abs() < 1e-9, "{measured:?}");
    assert!(row.scanned.is_some_and(|share| (0.1..0.99).contains(&share)) && row.findings == 3, "{row:?}");
    assert!(record.passes[1].scanned.is_none() && record.passes[1].off.is_none());
}

#[test]
fn findings_of_scans_are_listed_in_the_order_of_welding() {
    let plan = wall(5, 1, None);
    let settings = Settings { height: Some(0.5), ..Settings::default() };
    let mut record = joined(&plan, &settings);
    for pass in [4, 1, 3] {
        record.add_heights(&plan, &[heights(&plan, pass, |_| Some(1.0))], &settings);
    }
    let passes: Vec<Option<usize>> = of_height(&record).iter().map(|finding| finding.pass).collect();
    assert_eq!(passes, [1, 3, 4].map(Some));
}

#[test]
fn a_pass_that_no_scan_shows_has_a_share_of_nothing() {
    let plan = wall(3, 1, None);
    let mut record = joined(&plan, &Settings::default());
    record.add_heights(&plan, &[heights(&plan, 1, |_| None)], &Settings::default());
    let row = &record.passes[1];
    assert_eq!((row.scanned, row.height, row.off), (Some(0.0), [None; 2], None));
}

/// Half of the thinnest layer that a profile allows, 0.01 mm, is a window.
#[test]
fn thin_layers_have_a_window_too() {
    let plan = wall(3, 1, None);
    joined(&plan, &Settings { height: Some(0.005), ..Settings::default() });
}

#[test]
fn places_are_evenly_spaced_along_a_pass_and_none_is_left_out() {
    let plan = wall(3, 2, Some(96.0));
    for (pass, step) in plan.iter().flat_map(|pass| [0.7, 2.0, 31.0, 500.0].map(|step| (pass, step))) {
        let places = pass.every(step);
        assert_eq!(places.len(), (pass.length() / step + 1e-9) as usize + 1);
        for (k, (time, spot)) in places.iter().enumerate() {
            assert!((spot.along - k as f64 * step).abs() < 1e-9);
            assert!(pass.spot(*time).at.distance(spot.at) < 1e-6, "{spot:?}");
        }
    }
    assert!(plan[0].every(0.0).is_empty() && plan[0].every(-1.0).is_empty() && plan[0].every(f64::NAN).is_empty());
}
