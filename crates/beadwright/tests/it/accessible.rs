//! `report.html` and `compare.html` as someone meets them who does not see them: a language, headings in order, a name for
//! every control and a text for every picture. `docs/accessibility/check` asks axe-core the rest, in a browser.

use crate::common;

use beadwright::compare;
use beadwright::deposit::Judge;
use beadwright::example;
use beadwright::fill::StrategyName;
use beadwright::model::RepairReport;
use beadwright::plan;
use beadwright::profile::Profile;
use beadwright::report::Report;
use beadwright::task::Task;
use common::profile_by;

/// A tag of a page: its name, its attributes, and the text up to the next tag.
struct Tag<'a> {
    name: &'a str,
    attributes: &'a str,
    text: &'a str,
    /// Whether a `label` is open around it.
    labelled: bool,
}

impl Tag<'_> {
    fn value(&self, attribute: &str) -> Option<&str> {
        Some(self.attributes.split_once(&format!(" {attribute}=\""))?.1.split_once('"')?.0)
    }

    fn named(&self) -> bool {
        self.value("aria-label").is_some_and(|name| !name.trim().is_empty())
    }
}

/// The tags of a page in their order, without those in scripts.
fn tags(html: &str) -> Vec<Tag<'_>> {
    let (mut tags, mut labels, mut script) = (Vec::new(), 0, false);
    for piece in html.split('<').skip(1) {
        if script && !piece.starts_with("/script") {
            continue;
        }
        let (tag, text) = piece.split_once('>').unwrap_or((piece, ""));
        let name = tag.split_whitespace().next().unwrap_or_default();
        script = name == "script";
        labels += usize::from(name == "label");
        labels -= usize::from(name == "/label");
        tags.push(Tag { name, attributes: &tag[name.len()..], text, labelled: labels > 0 });
    }
    tags
}

/// What is wrong with a page, as sentences.
fn faults(html: &str) -> Vec<String> {
    let tags = tags(html);
    let mut faults = Vec::new();
    let mut ask = |well: bool, tag: &Tag, what: &str| {
        if !well {
            faults.push(format!("<{}{}> {what}", tag.name, tag.attributes));
        }
    };
    let mut level = 0;
    for (i, tag) in tags.iter().enumerate() {
        let pointed = |id: &str| tags.iter().any(|label| label.name == "label" && label.value("for") == Some(id));
        match tag.name {
            "html" => ask(tag.value("lang") == Some("en"), tag, "states its language"),
            "input" | "select" => {
                ask(tag.labelled || tag.named() || tag.value("id").is_some_and(pointed), tag, "has a label");
            }
            "button" => ask(tag.text.chars().any(char::is_alphabetic) || tag.named(), tag, "has a name"),
            "canvas" => ask(tag.named() || tag.value("aria-hidden") == Some("true"), tag, "has a text"),
            "svg" => ask(tag.named() && tag.value("role") == Some("img"), tag, "has a text"),
            "th" => {
                let text = tags[i..].iter().take_while(|next| next.name != "/th").map(|next| next.text);
                ask(text.collect::<String>().trim() != "" && tag.value("scope").is_some(), tag, "heads something");
            }
            "h1" | "h2" | "h3" | "h4" => {
                let next = usize::from(tag.name.as_bytes()[1] - b'0');
                ask(next <= level + 1 && (next > 1 || level == 0), tag, "follows the heading before it");
                level = next;
            }
            _ => {}
        }
    }
    if level == 0 {
        faults.push("no headings".to_owned());
    }
    faults
}

fn report(part: &str, profile: &Profile) -> String {
    let plan = common::planned(part, profile);
    let mut judge = Judge::new(plan::deposit_settings(profile)).with_pictures(40);
    let mut report = Report::new(&plan.header, profile);
    for layer in &plan.layers {
        report.layer(layer, Some(&judge.layer(layer)));
    }
    report.finish(&plan.summary, &RepairReport::default(), &["a.src".to_owned()], &[])
}

#[test]
fn the_report_can_be_read_without_sight() {
    for (part, strategy) in [("cross", "loop"), ("propeller", "zigzag"), ("star", "hybrid")] {
        let html = report(part, &profile_by("cmt-al2319-kuka", strategy));
        assert_eq!(faults(&html), [""; 0], "{part}, {strategy}");
    }
}

#[test]
fn the_comparison_can_be_read_without_sight() {
    let profile = profile_by("cmt-al2319-kuka", "loop");
    let settings = plan::deposit_settings(&profile);
    for part in ["cross", "star"] {
        let mesh = example::find(part).unwrap().mesh();
        let entry = |name| compare::strategy(&mesh, &profile, name, settings, &None, &Task::new()).unwrap();
        let mut page = compare::page(
            part,
            "One & other",
            &[StrategyName::Loop, StrategyName::Hybrid, StrategyName::Raster].map(entry),
            Some(&profile.check),
        );
        for strategy in [StrategyName::Loop, StrategyName::Hybrid] {
            compare::add_steps(&mut page, &mesh, &profile, strategy, 2, &Task::new()).unwrap();
        }
        assert_eq!(faults(&page.html()), [""; 0], "{part}");
    }
}

#[test]
fn faults_are_found() {
    let page = |body: &str| format!("<html lang=\"en\"><h1>A</h1>{body}</html>");
    assert_eq!(faults(&page("<label><input type=\"radio\">B</label><button>Show</button>")), [""; 0]);
    let wrong = [
        "<input id=\"b\">",
        "<button>+</button>",
        "<canvas></canvas>",
        "<svg viewBox=\"0 0 1 1\"></svg>",
        "<table><tr><th scope=\"col\"></th></tr></table>",
        "<h3>C</h3>",
        "<h1>D</h1>",
    ];
    for body in wrong {
        assert_eq!(faults(&page(body)).len(), 1, "{body}");
    }
}
