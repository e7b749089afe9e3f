//! Plan and logs joined: figures in closed form, and what went wrong at its pass and place.

use crate::cell::{Cell, Clock, Dice, Fault, log, wall};
use bead_record::{Finding, Kind, PlannedPass, Quantity, Record, Settings, chain, join};

const TRUE: Clock = Clock { zero: 0.0, fast: 0.0, set: None };

fn joined(cell: &Cell<'_>, controller: Option<bool>) -> Record {
    let power = log("power.csv", &cell.power_log(&TRUE, 50.0, &[]));
    let mut logs = vec![power];
    logs.extend(controller.map(|named| log("controller.csv", &cell.controller_log(&TRUE, named))));
    join(cell.planned, &logs, &Settings::default()).unwrap()
}

fn found(record: &Record, kind: Kind) -> Vec<&Finding> {
    record.findings.iter().filter(|finding| finding.kind == kind).collect()
}

#[test]
fn figures_are_those_of_the_arc() {
    let plan = wall(6, 2, None);
    let cell = Cell::new(&plan, 1);
    let settings = Settings { efficiency: 0.8, ..Settings::default() };
    let logs = [log("power.csv", &cell.power_log(&TRUE, 100.0, &[]))];
    let record = join(&plan, &logs, &settings).unwrap();
    for (row, done) in record.passes.iter().zip(&cell.done) {
        let (current, feed) = (row.measured(Quantity::Current).unwrap(), row.measured(Quantity::Feed).unwrap());
        assert!((current.mean - 180.0).abs() < 1.0 && (feed.mean - 8.0).abs() < 0.02, "{row:?}");
        // Evenly spread noise of ± 4 %.
        assert!((current.deviation - 180.0 * 0.08 / 12_f64.sqrt()).abs() < 0.5, "{current:?}");
        assert!(current.min >= 180.0 * 0.959 && current.max <= 180.0 * 1.041);
        assert!((row.burned - (done.end - done.start - 0.1)).abs() < 0.03, "{row:?}");
        // 0.8 × 180 A × 20 V / 8 mm/s, slower by as much as the pass took longer.
        let slower = row.seconds[1].unwrap() / row.seconds[0].unwrap();
        assert!((row.heat[0].unwrap() - 360.0).abs() < 1e-9 && (row.heat[1].unwrap() / slower - 360.0).abs() < 2.0);
    }
    assert!(record.findings.is_empty(), "{:?}", record.findings);
}

/// In a wall, all passes are equally long: only times show which one is missing.
#[test]
fn lost_arcs_are_found_among_equal_passes() {
    for seed in 0..10 {
        let plan = wall(20, 2, Some(96.0));
        let mut cell = Cell::new(&plan, seed);
        let lost = Dice(seed).below(plan.len() - 4) + 2;
        cell.faults.push((lost, [0.0, 1.0], Fault::Out));
        for controller in [None, Some(false), Some(true)] {
            let record = joined(&cell, controller);
            let kind = if controller.is_some() { Kind::ArcLost } else { Kind::NotWelded };
            let passes: Vec<_> =
                record.findings.iter().filter(|f| f.kind.is_of_part()).map(|f| (f.kind, f.pass)).collect();
            assert_eq!(passes, [(kind, Some(lost))], "seed {seed}, {controller:?}: {:?}", record.findings);
        }
    }
}

#[test]
fn arcs_lost_within_a_pass_are_found_at_their_place() {
    for (seed, [from, to]) in [(0, [0.3, 0.5]), (1, [0.6, 1.0]), (2, [0.45, 0.5]), (3, [0.0, 0.4])] {
        let plan = wall(8, 3, None);
        let mut cell = Cell::new(&plan, seed);
        cell.faults.push((10, [from, to], Fault::Out));
        for controller in [None, Some(true)] {
            let record = joined(&cell, controller);
            let lost = found(&record, Kind::ArcLost);
            assert_eq!(lost.len(), 1, "seed {seed}, {controller:?}: {:?}", record.findings);
            let pass = &plan[10];
            let spots = [from, to].map(|part| pass.spot(pass.struck + part * pass.seconds()).along);
            let place = lost[0].place.unwrap().map(|spot| spot.along);
            assert!(
                lost[0].pass == Some(10) && (place[0] - spots[0]).abs() < 3.0 && (place[1] - spots[1]).abs() < 3.0,
                "seed {seed}, {controller:?}: {place:?} {spots:?}"
            );
        }
    }
}

#[test]
fn skipped_repeated_and_foreign_arcs_are_told_apart() {
    let plan = wall(8, 3, None);
    let mut cell = Cell::new(&plan, 5);
    // Pass 7 was never welded; pass 12 was given up after two seconds, and begun again ten minutes later.
    cell.done.retain(|done| done.planned != 7);
    let at = cell.done.iter().position(|done| done.planned == 12).unwrap();
    let given_up = cell.done[at].start;
    cell.done[at..].iter_mut().for_each(|done| (done.start, done.end) = (done.start + 600.0, done.end + 600.0));
    cell.done.insert(at, crate::cell::Done { planned: 12, start: given_up, end: given_up + 2.0 });
    for controller in [None, Some(false), Some(true)] {
        let record = joined(&cell, controller);
        let kinds: Vec<_> = record.findings.iter().map(|f| (f.kind, f.pass)).collect();
        let expected = [(Kind::NotWelded, Some(7)), (Kind::Repeated, Some(12)), (Kind::Stop, Some(12))];
        assert_eq!(kinds, expected, "{controller:?}: {:?}", record.findings);
        assert!(record.passes[12].wait[1].unwrap() > 590.0);
    }
    // An arc between two passes, to try the torch.
    let (before, after) = (cell.done[20].end, cell.done[21].start);
    let text = cell.power_log(&TRUE, 50.0, &[]);
    let tried = |line: &str| match line.split(',').next().unwrap().parse::<f64>() {
        Ok(time) if (before + 1.0..after - 1.0).contains(&time) => format!("{time},90,20,0\n"),
        _ => format!("{line}\n"),
    };
    let text: String = text.lines().map(tried).collect();
    let record = join(&plan, &[log("power.csv", &text)], &Settings::default()).unwrap();
    let extra = found(&record, Kind::Extra);
    assert!(extra.len() == 1 && (extra[0].time.unwrap()[0] - before - 1.0).abs() < 0.1, "{:?}", record.findings);
}

#[test]
fn notes_and_temperatures_come_to_their_pass() {
    let plan = wall(4, 2, None);
    let cell = Cell::new(&plan, 2);
    let mut controller = cell.controller_log(&TRUE, true);
    controller += &format!("{};note;;;nozzle cleaned\n", format!("{:.1}", cell.done[5].start - 1.0).replace('.', ","));
    // What the listener says of itself is no note of an operator.
    controller += &format!("{};resumed;;;restored\n", format!("{:.1}", cell.done[5].start - 0.5).replace('.', ","));
    let logs = [log("controller.csv", &controller), log("pyrometer.csv", &cell.pyrometer_log(&TRUE, 10.0))];
    let record = join(&plan, &logs, &Settings { hottest: Some(160.0), ..Settings::default() }).unwrap();
    let noted: Vec<usize> = (0..plan.len()).filter(|&k| record.passes[k].notes == ["nozzle cleaned"]).collect();
    assert_eq!(noted, [5]);
    assert_eq!(record.passes.iter().map(|pass| pass.notes.len()).sum::<usize>(), 1);
    for (k, row) in record.passes.iter().enumerate().skip(1) {
        // It cools from 1450 towards 120 °C with 1.5 s, and is read half a second before the arc.
        let wait = cell.done[k].start - cell.done[k - 1].end - 0.5;
        let expected = 120.0 + 1330.0 * (-wait / 1.5).exp();
        let before = row.before[1].unwrap();
        assert!((before - expected).abs() < 0.15 * (expected - 100.0), "{k}: {before} {expected}");
        assert_eq!(row.peak, Some(1450.0));
        assert_eq!(found(&record, Kind::TooHot).iter().any(|f| f.pass == Some(k)), before > 160.0);
    }
}

#[test]
fn impossible_plans_and_settings_are_refused() {
    let plan = wall(2, 2, None);
    let cell = Cell::new(&plan, 2);
    let logs = [log("power.csv", &cell.power_log(&TRUE, 20.0, &[]))];
    let error = |plan: &[PlannedPass], settings: &Settings| join(plan, &logs, settings).unwrap_err().to_string();
    let usual = Settings::default();
    assert!(error(&[], &usual).contains("no passes"));
    let mut wrong = plan.clone();
    wrong[1].struck = 0.0;
    assert!(
        error(&wrong, &usual).contains("layer 1, pass 2 of the plan: it begins before"),
        "{}",
        error(&wrong, &usual)
    );
    let far = Settings { least: 0.0, ..usual };
    assert_eq!(error(&plan, &far), "the least stretch = 0 s: the value must lie between 0.02 and 60 s.");
}

#[test]
fn any_change_of_a_row_changes_every_later_hash() {
    let rows: Vec<String> = (0..20).map(|k| format!("row {k}")).collect();
    let whole = chain("first", &rows);
    for k in 0..rows.len() {
        let mut changed = rows.clone();
        changed[k].push('.');
        let other = chain("first", &changed);
        let differ: Vec<bool> = whole.iter().zip(&other).map(|(a, b)| a != b).collect();
        assert_eq!(differ, (0..rows.len()).map(|at| at >= k).collect::<Vec<_>>());
        changed.remove(k);
        assert_ne!(chain("first", &changed).last(), whole.last());
    }
    assert_ne!(chain("second", &rows)[0], whole[0]);
}
