//! Lines of a program and places of the torch belong together, in every dialect.

use beadwright::plan::Header;
use beadwright::profile::{Profile, edit};
use beadwright::task::Task;
use beadwright::weld::Torch;
use beadwright_studio::listing::Listing;
use beadwright_studio::view3d::{LayerBeads, Scene};
use std::sync::Arc;

/// The cross by a profile: its scene, and its program in a dialect.
fn listed(profile: &str, dialect: &str) -> (Scene, Listing) {
    of("cross", &Profile::built_in(profile).unwrap(), dialect)
}

fn of(part: &str, profile: &Profile, dialect: &str) -> (Scene, Listing) {
    let mesh = beadwright::example::find(part).unwrap().mesh();
    let plan = beadwright::plan::plan(part, &mesh, profile, &Task::new()).unwrap();
    let (mut scene, mut torch) = (Scene::default(), Torch::of(&profile.weld_settings()));
    for layer in &plan.layers {
        scene.set_layer(layer.index, Arc::new(LayerBeads::of(layer, &mut torch)));
    }
    let header: Header = plan.header;
    let layers: Vec<_> = plan.layers.into_iter().map(Arc::new).collect();
    let listing = Listing::of(&header, profile, &layers, dialect).unwrap();
    (scene, listing)
}

/// Numbers of a line, as they are written there.
fn numbers(line: &str) -> Vec<f64> {
    let words = line.split(|c: char| !(c.is_ascii_digit() || c == '.' || c == '-'));
    words.filter_map(|word| word.parse().ok()).collect()
}

#[test]
fn the_line_of_a_place_names_it_and_leads_back_to_it() {
    for (profile, dialect) in [
        ("cmt-al2319-kuka", "krl"),
        ("cmt-steel-abb", "rapid"),
        ("cmt-steel-robots", "fanuc"),
        ("cmt-steel-robots", "urscript"),
    ] {
        let (scene, listing) = listed(profile, dialect);
        let total = scene.total_seconds();
        for part in [0.05, 0.33, 0.5, 0.81] {
            let at = scene.at_time(part * total).unwrap();
            let line = listing.line(&scene, &at).unwrap_or_else(|| panic!("{dialect}: no line"));
            let text = listing.file(line).unwrap().line(line);
            // The controller is on its way to the point that the line names, at most a segment away.
            let seconds = listing.seconds(&scene, line).unwrap();
            assert!(seconds >= part * total - 0.2, "{dialect}, {text}: {seconds} s, not {} s", part * total);
            let there = scene.at_time(seconds).unwrap();
            assert_eq!((there.layer, there.pass), (at.layer, at.pass), "{dialect}, {text}");
            assert_eq!(listing.line(&scene, &there), Some(line), "{dialect}, {text}");
            if dialect == "krl" {
                let torch = there.torch.at;
                let named = numbers(text);
                let near = |value: f64| named.iter().any(|number| (number - value).abs() < 0.5);
                assert!(near(torch.x) && near(torch.y), "{text} is not at {torch}");
            }
        }
    }
}

#[test]
fn the_line_of_an_arc_leads_to_its_end() {
    let text = Profile::built_in_text("cmt-al2319-kuka").unwrap().to_owned();
    let with = [("program.chord_tolerance", "0.05"), ("program.arcs", "true")];
    let text = with.iter().fold(text, |text, (key, value)| edit::with_value(&text, key, value).unwrap());
    let (scene, listing) = of("pot", &Profile::parse(&text).unwrap(), "krl");
    let (mut arcs, mut line) = (0, 0);
    while let Some(file) = listing.file(line).filter(|file| file.lines().contains(&line)) {
        let text = file.line(line).trim();
        if let Some((_, end)) = text.split_once("CIRC {").and_then(|(_, arc)| arc.split_once("},")) {
            let seconds = listing.seconds(&scene, line).unwrap();
            let (torch, end) = (scene.at_time(seconds).unwrap().torch.at, numbers(end));
            assert!((torch.x - end[0]).abs() < 0.5 && (torch.y - end[1]).abs() < 0.5, "{text} is not at {torch}");
            arcs += 1;
        }
        line += 1;
    }
    assert!(arcs > 10, "{arcs} arcs");
}
