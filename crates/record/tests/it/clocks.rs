//! Clocks with hidden offsets and drifts are found again by the arcs.

use crate::cell::{Cell, Clock, Dice, log, wall};
use bead_record::{Kind, Quantity, Record, Settings, Trust, join};

fn of_part(record: &Record) -> Vec<&str> {
    record
        .findings
        .iter()
        .filter(|finding| finding.kind.is_of_part())
        .map(|finding| finding.sentence.as_str())
        .collect()
}

#[test]
fn offsets_and_drifts_are_those_of_the_cell() {
    for seed in 0..8 {
        // Passes of different lengths, and all of the same.
        let plan = wall(24, 3, (seed % 2 == 0).then_some(100.0));
        let (cell, mut dice) = (Cell::new(&plan, seed), Dice(seed + 100));
        let mut clock = |drift: f64| Clock::new(dice.between(-5000.0, 5000.0), dice.between(-drift, drift));
        let clocks = [clock(0.0), clock(8e-4), clock(8e-4)];
        let logs = [
            log("controller.csv", &cell.controller_log(&clocks[0], false)),
            log("power.csv", &cell.power_log(&clocks[1], 20.0, &[])),
            log("pyrometer.csv", &cell.pyrometer_log(&clocks[2], 10.0)),
        ];
        let record = join(&plan, &logs, &Settings::default()).unwrap();
        assert_eq!(of_part(&record), Vec::<&str>::new(), "seed {seed}");
        for (row, done) in record.passes.iter().zip(&cell.done) {
            assert!((row.time.unwrap()[0] - clocks[0].at(done.start)).abs() < 2e-3, "seed {seed}: {row:?}");
        }
        for (known, clock) in record.logs.iter().zip(&clocks).skip(1) {
            assert_eq!((known.trust, known.matched), (Trust::Arcs, plan.len()), "seed {seed}: {known:?}");
            // By how much it runs slow is minus by how much it runs fast.
            assert!((known.drift + 1e6 * clock.fast).abs() < 30.0, "seed {seed}: {} {}", known.drift, clock.fast);
            let ahead = clocks[0].at(0.0) - clock.at(0.0);
            // The power source needs 0.1 s to strike the arc, and is asked a little later.
            assert!((known.offset - ahead).abs() < 0.2, "seed {seed}: {} {ahead}", known.offset);
            let drifts = record.findings.iter().any(|f| f.kind == Kind::ClockDrift && f.sentence.contains(&known.name));
            assert_eq!(drifts, known.drift.abs() >= 100.0);
        }
    }
}

#[test]
fn a_log_that_starts_late_and_one_that_ends_early_are_placed() {
    let plan = wall(20, 3, None);
    let cell = Cell::new(&plan, 3);
    let (early, late) = (Clock::new(70.0, 1e-4), Clock::new(-900.0, -2e-4));
    let middle = cell.end() / 2.0;
    let logs = [
        log("controller.csv", &cell.controller_log(&Clock::new(0.0, 0.0), false)),
        log("early.csv", &cell.power_log(&early, 20.0, &[[middle, 1e9]])),
        log(
            "late.csv",
            &cell
                .pyrometer_log(&late, 10.0)
                .lines()
                .enumerate()
                .filter(|(k, _)| *k == 0 || *k > 4000)
                .map(|(_, line)| format!("{line}\n"))
                .collect::<String>(),
        ),
    ];
    let record = join(&plan, &logs, &Settings::default()).unwrap();
    for (known, clock) in record.logs.iter().zip([Clock::new(0.0, 0.0), early, late]).skip(1) {
        let begins = known.time[0] - known.offset;
        assert!((clock.at(known.time[0]) - begins).abs() < 0.15, "{known:?}");
    }
    assert_eq!(of_part(&record), Vec::<&str>::new());
    // What no log saw is not taken for a lost arc.
    let unlogged = record.findings.iter().filter(|finding| finding.kind == Kind::NotLogged).count();
    assert!((plan.len() / 2 - 2..=plan.len() / 2 + 2).contains(&unlogged), "{unlogged}");
    assert!(
        record.passes[5].measured(Quantity::Current).is_some()
            && record.passes[55].measured(Quantity::Current).is_none()
    );
}

#[test]
fn without_a_common_arc_dates_are_trusted_and_said_so() {
    let plan = wall(4, 2, None);
    let cell = Cell::new(&plan, 9);
    let controller = log("controller.csv", &cell.controller_log(&Clock::new(0.0, 0.0), false));
    let cold = log("wall.csv", "time_s,temperature_c\n1000,80\n1001,81\n1002,82\n");
    let record = join(&plan, &[controller, cold], &Settings::default()).unwrap();
    assert_eq!(record.logs[1].trust, Trust::Nothing);
    assert!(record.findings.iter().any(|finding| finding.kind == Kind::ClockUnknown), "{:?}", record.findings);
}
