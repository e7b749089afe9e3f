//! Lines of a program and places of the torch belong together, in every dialect.

use beadwright::plan::Header;
use beadwright::profile::Profile;
use beadwright::task::Task;
use beadwright::weld::Torch;
use beadwright_studio::listing::Listing;
use beadwright_studio::view3d::{LayerBeads, Scene};
use std::sync::Arc;

/// The cross by a profile: its scene, and its program in a dialect.
fn listed(profile: &str, dialect: &str) -> (Scene, Listing) {
    let profile = Profile::built_in(profile).unwrap();
    let mesh = beadwright::example::find("cross").unwrap().mesh();
    let plan = beadwright::plan::plan("cross", &mesh, &profile, &Task::new()).unwrap();
    let (mut scene, mut torch) = (Scene::default(), Torch::of(&profile.weld_settings()));
    for layer in &plan.layers {
        scene.set_layer(layer.index, Arc::new(LayerBeads::of(layer, &mut torch)));
    }
    let header: Header = plan.header;
    let layers: Vec<_> = plan.layers.into_iter().map(Arc::new).collect();
    let listing = Listing::of(&header, &profile, &layers, dialect).unwrap();
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
