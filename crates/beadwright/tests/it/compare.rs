//! Strategies side by side: their order, and what is marked as best.

use crate::common;

use beadwright::compare::{self, COLUMNS, Entry};
use beadwright::fill::StrategyName;
use beadwright::report::sheet::Sheet;
use beadwright::{example, plan, task::Task};
use std::collections::BTreeSet;

/// The lowest layer of the cross by each of these strategies.
fn entries(names: &[StrategyName]) -> Vec<Entry> {
    let profile = common::profile("cmt-al2319-kuka");
    let mesh = example::find("cross").unwrap().mesh();
    let (settings, lowest) = (plan::deposit_settings(&profile), Some(BTreeSet::from([0])));
    let entry = |name: &StrategyName| compare::strategy(&mesh, &profile, *name, settings, &lowest, &Task::new());
    let mut entries: Vec<Entry> = names.iter().map(|name| entry(name).unwrap()).collect();
    compare::rank(&mut entries);
    entries
}

/// Numbers end on the right, below each other; sentences begin on the left, where one begins to read.
#[test]
fn sentences_in_tables_begin_on_the_left() {
    let rows = ["all is well", "the current reached 150.0 A where 129.0 A was planned, in layer 3"];
    let rows: Vec<_> = rows.iter().map(|what| vec![("1".to_owned(), false), ((*what).to_owned(), false)]).collect();
    let html = Sheet::new("t", "").table(&["layer", "what"], &rows).html();
    assert!(html.contains("<th scope=\"col\">layer</th><th scope=\"col\" class=\"said\">what</th>"), "{html}");
    assert_eq!(html.matches("<td class=\"said\">").count(), 2);
    let html = Sheet::new("t", "").table(&["layer", "what"], &rows[..1]).html();
    assert!(!html.contains("class=\"said\""), "{html}");
}

#[test]
fn what_leaves_the_part_empty_comes_last_and_is_never_best() {
    let names = [StrategyName::Wall, StrategyName::Raster, StrategyName::Zigzag, StrategyName::Loop];
    let entries = entries(&names);
    let order: Vec<&str> = entries.iter().map(|entry| &*entry.name).collect();
    assert_eq!(order, ["loop", "zigzag", "wall", "raster"]);
    // One bead along the middle is soon welded: by the score alone it would be first.
    assert!(entries[2].score() < entries[0].score() && entries[2].figures.low_percent() > 25.0);
    let table = compare::table(&entries);
    for (i, column) in COLUMNS.iter().enumerate() {
        let best: Vec<bool> = table.iter().map(|row| row[i].1).collect();
        assert!(best[0] || best[1], "{}: none is best", column.name);
        assert!(!best[2] && !best[3], "{}: an empty part is praised", column.name);
    }
    let mut page = Sheet::new("cross", "");
    compare::tabulate(&mut page, &entries);
    let html = page.html();
    assert!(html.contains("<td>wall (not filled)</td>") && html.contains("<td>loop</td>"));
}
