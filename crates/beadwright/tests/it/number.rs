//! Numbers as programs and files want them, and the templates that carry them.

use crate::solids;

use beadwright::number::{fixed, push_fixed};
use beadwright::template::{expand, unknown_placeholder};
use proptest::prelude::*;
use solids::runner;

#[test]
fn fixed_decimals() {
    for (value, decimals, expect) in [
        (0.0, 3, "0.000"),
        (-0.0, 3, "0.000"),
        (-0.0004, 3, "0.000"),
        (-0.0006, 3, "-0.001"),
        (0.05, 1, "0.1"),
        (1.0, 0, "1"),
        (-1.6, 0, "-2"),
        (0.999_96, 4, "1.0000"),
        (9.999_6, 3, "10.000"),
        (-123.456, 2, "-123.46"),
        (1e9, 3, "1000000000.000"),
        (1e-7, 3, "0.000"),
        (1.000_000_001, 9, "1.000000001"),
        (1.5, 12, "1.500000000"),
    ] {
        assert_eq!(fixed(value, decimals), expect);
    }
}

#[test]
fn text_is_appended() {
    let mut line = "X".to_owned();
    push_fixed(&mut line, 1.25, 1);
    line.push_str(" Y");
    push_fixed(&mut line, -2.0, 3);
    assert_eq!(line, "X1.3 Y-2.000");
}

#[test]
fn random_numbers_are_written_as_the_standard_library_does() {
    let value = prop_oneof![-20_000.0..20_000.0, -1.0..1.0, -1e6..1e6_f64];
    runner(5000)
        .run(&(value, 0..7_usize), |(value, decimals)| {
            let (ours, theirs) = (fixed(value, decimals), format!("{value:.decimals$}"));
            // Ties may be rounded the other way: one unit of the last digit.
            let unit = 10_f64.powi(-(decimals as i32));
            let off = (ours.parse::<f64>().unwrap() - theirs.parse::<f64>().unwrap()).abs();
            let tie = ((value / unit).fract().abs() - 0.5).abs() < 1e-3 && off < 1.01 * unit;
            // Theirs keeps the sign of a zero.
            prop_assert!(ours == theirs || tie || (is_zero(&theirs) && is_zero(&ours)), "{ours} {theirs}");
            prop_assert_eq!(ours.split_once('.').map_or(0, |(_, d)| d.len()), decimals);
            prop_assert!(!(is_zero(&ours) && ours.starts_with('-')));
            Ok(())
        })
        .unwrap();
}

fn is_zero(text: &str) -> bool {
    text.bytes().all(|b| b"-.0".contains(&b))
}

fn check(template: &str, expect: &str, unknown: Option<&str>) {
    let values = [("speed", "10.5".to_owned()), ("pass", "7".to_owned())];
    assert_eq!(expand(template, &values), expect);
    assert_eq!(unknown_placeholder(template, &["speed", "pass"]), unknown);
}

#[test]
fn placeholders_become_their_values() {
    check("M3", "M3", None);
    check("", "", None);
    check("F{{speed}}", "F10.5", None);
    check("{{pass}}: {{ speed }}{{pass}};", "7: 10.57;", None);
    check("A{{sped}}B{{speed}}", "AB10.5", Some("sped"));
    check("{{}}", "", Some(""));
}

#[test]
fn single_braces_are_text() {
    check("$POS = {X 0, Y {{pass}}}", "$POS = {X 0, Y 7}", None);
    check("{A {B 1}} {{pass}}", "{A {B 1}} 7", None);
}
