//! Rows as loggers write them: other separators, other times, doubled, late and broken.

use crate::cell::{Cell, Clock, log, wall};
use bead_record::{Quantity, Settings, Source, join};

#[test]
fn the_same_log_in_other_spellings_is_the_same() {
    let plain = log("a", "time_s,current_a,wire_feed_speed_m_min\n0,0,0\n0.5,180.5,8.4\n1.5,181,8.5\n");
    let same = [
        "time (ms);I (A);wire feed speed (mm/min)\n0;0;0\n500;180,5;8400\n1500;181;8500\n",
        "\u{feff}# a remark\r\ntime_s\tcurrent\twfs\r\n0\t0\t0\r\n0,5\t180,5\t8,4\r\n\r\n1,5\t181\t8,5\r\n",
        "time (min),\"current (kA)\",feed (mm/s)\n0,0,0\n0.0083333333333333,0.1805,140\n0.025,0.181,141.6666667\n",
    ];
    for text in same {
        let other = log("a", text);
        let near = |a: &[f32], b: &[f32]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-3);
        assert!(plain.times.iter().zip(&other.times).all(|(a, b)| (a - b).abs() < 1e-9), "{text}: {:?}", other.times);
        for quantity in [Quantity::Current, Quantity::Feed] {
            assert!(near(plain.column(quantity).unwrap(), other.column(quantity).unwrap()), "{text}: {other:?}");
        }
    }
    let dated = log(
        "a",
        "timestamp,current_a\n2026-11-28T14:00:00.000Z,0\n2026-11-28T15:00:00.500+01:00,180.5\n2026-11-28 14:00:01.5,1\n",
    );
    let steps: Vec<f64> = dated.times.windows(2).map(|pair| pair[1] - pair[0]).collect();
    assert!(dated.dated && (steps[0] - 0.5).abs() < 1e-6 && (steps[1] - 1.0).abs() < 1e-6, "{steps:?}");
    let called = [(Quantity::Current, "Ist".to_owned())];
    let named = Source::read("a", "time,current,Ist\n0,1,5\n1,1,6\n".as_bytes(), &called).unwrap();
    assert_eq!(named.column(Quantity::Current), Some(&[5.0, 6.0][..]));
}

#[test]
fn doubled_and_late_rows_change_nothing() {
    let plan = wall(10, 2, None);
    let cell = Cell::new(&plan, 4);
    let text = cell.power_log(&Clock::new(0.0, 0.0), 20.0, &[]);
    let whole = log("power.csv", &text);
    let mut lines: Vec<&str> = text.lines().collect();
    // A block that was sent again, single rows that were overtaken, and a block that came late.
    let again: Vec<&str> = lines[2000..2600].to_vec();
    lines.splice(2600..2600, again);
    lines.swap(500, 501);
    lines.swap(900, 907);
    let late: Vec<&str> = lines.drain(4000..4100).collect();
    lines.splice(4500..4500, late);
    let mixed = log("power.csv", &lines.iter().map(|line| format!("{line}\n")).collect::<String>());
    assert_eq!((mixed.tally.doubled, mixed.tally.set_back), (600, 0), "{:?}", mixed.tally);
    assert!(mixed.times == whole.times && mixed.columns == whole.columns);
    assert!((100..=120).contains(&mixed.tally.late), "{:?}", mixed.tally);
    let settings = Settings::default();
    let [a, b] = [&whole, &mixed].map(|log| join(&plan, std::slice::from_ref(log), &settings).unwrap());
    assert_eq!(a.passes, b.passes);
}

#[test]
fn faults_are_named_with_their_line() {
    let error = |text: &str| Source::read("a", text.as_bytes(), &[]).unwrap_err().to_string();
    assert!(error("").contains("no line with the names"));
    assert!(error("time,current\n").contains("no row"));
    assert!(error("zeit,current\n1,2\n").contains("no column is named time. The header names zeit, current."));
    assert!(error("time,power\n1,2\n").contains("no column is known"));
    assert!(error("time,current (furlong)\n1,2\n").contains("current in furlong is not understood"));
    assert!(error("time,current,i\n1,2,3\n").contains("two columns hold the current"));
    let broken = format!("time,current\n1,2\n{}", "x,3\n".repeat(20));
    assert!(
        error(&broken).contains("20 of 21 rows cannot be read, the first in line 3: \"x\" is not a time."),
        "{}",
        error(&broken)
    );
    let few = log("a", "time,current\n1,2\n2,two\n3,4\n4,");
    assert_eq!((few.tally.broken, few.times.len()), (1, 3));
    let none = join(&wall(2, 2, None), &[few], &Settings::default()).unwrap_err().to_string();
    assert!(none.contains("no log says when the arc burned"), "{none}");
}
