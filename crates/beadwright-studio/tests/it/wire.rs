//! What passes between a browser's page and its worker comes out as it went in, without a browser.

use beadwright::model::Part;
use beadwright_studio::planner::wire::{Packer, Unpacker};
use beadwright_studio::planner::{Event, Order, Planner};
use beadwright_studio::project::{Project, Source};
use beadwright_studio::state::PlanState;
use std::sync::Arc;
use std::sync::mpsc::channel;

/// The plan of a project, as the desktop has it, and as a page has it.
fn plans(project: &Project) -> (PlanState, PlanState) {
    let (bell, rung) = channel();
    let mut planner = Planner::new(move |_| _ = bell.send(()));
    let (mut own, mut sent) = (PlanState::default(), PlanState::default());
    let (mut packer, mut unpacker) = (Packer::default(), Unpacker::default());
    let order = Order { number: 7, project: project.clone(), layer: 1 };
    let received = Order::unpack(&order.pack().unwrap()).unwrap();
    assert_eq!(received, order);
    unpacker.begin(&received.project.profile);
    planner.plan(&received.project, received.layer);
    while own.findings.is_none() {
        assert_eq!(own.failure, None);
        rung.recv().unwrap();
        for event in planner.events() {
            let (number, copy) = unpacker.unpack(&packer.pack(7, clone(&event)).unwrap()).unwrap();
            assert_eq!(number, 7);
            own.take(event);
            sent.take(copy);
        }
    }
    (own, sent)
}

fn clone(event: &Event) -> Event {
    match event {
        Event::Progress(stage, fraction) => Event::Progress(*stage, *fraction),
        Event::Part(part, mesh, profile) => Event::Part(part.clone(), mesh.clone(), profile.clone()),
        Event::Preview(layer, beads) => Event::Preview(layer.clone(), beads.clone()),
        Event::Begin(header) => Event::Begin(header.clone()),
        Event::Layer(layer, beads) => Event::Layer(layer.clone(), beads.clone()),
        Event::Planned(summary) => Event::Planned(summary.clone()),
        Event::Judged(index, judgement, errors) => Event::Judged(*index, judgement.clone(), errors.clone()),
        Event::Checked(total, findings) => Event::Checked(*total, findings.clone()),
        Event::Failed(failure) => Event::Failed(failure.clone()),
    }
}

fn example(name: &str, strategy: &str) -> Project {
    let mut project = Project { source: Some(Source::Example(name.to_owned())), ..Project::default() };
    project.profile = beadwright::profile::edit::with_value(&project.profile, "fill.strategy", strategy).unwrap();
    project
}

#[test]
fn a_plan_comes_to_the_page_as_it_is() {
    for (name, strategy) in [("propeller", "hybrid"), ("star", "zigzag"), ("pot", "loop")] {
        let (own, sent) = plans(&example(name, &format!("\"{strategy}\"")));
        assert!(!own.layers.is_empty(), "{name}");
        assert_eq!(own.part, sent.part, "{name}");
        assert_eq!(own.profile, sent.profile, "{name}");
        assert_eq!(own.header, sent.header, "{name}");
        assert_eq!(own.layers, sent.layers, "{name}");
        assert_eq!(own.judgements, sent.judgements, "{name}");
        assert_eq!(own.total, sent.total, "{name}");
        assert_eq!(own.findings, sent.findings, "{name}");
        let [json, copy] = [&own, &sent].map(|plan| plan.summary.as_ref().unwrap().json(plan.total.as_ref()));
        assert_eq!(json, copy, "{name}");
        for k in 0..own.layers.len() {
            let [a, b] = [&own, &sent].map(|plan| plan.scene.layer(k).unwrap());
            assert_eq!((a.beads(), a.passes(), a.seconds()), (b.beads(), b.passes(), b.seconds()), "{name}, layer {k}");
        }
    }
}

#[test]
fn a_part_is_sent_only_when_it_has_changed() {
    let cross = example("cross", "\"zigzag\"");
    let (own, _) = plans(&cross);
    let (part, profile) = (own.part.unwrap(), own.profile.unwrap());
    let (mut packer, mut unpacker) = (Packer::default(), Unpacker::default());
    unpacker.begin(&cross.profile);
    let mut sent = |part: &Arc<Part>| {
        let bytes = packer.pack(1, Event::Part(part.clone(), None, profile.clone())).unwrap();
        let Event::Part(part, mesh, _) = unpacker.unpack(&bytes).unwrap().1 else { panic!("another event") };
        (bytes.len(), part, mesh.unwrap())
    };
    let (first, second, other) = (sent(&part), sent(&part), sent(&Arc::new((*part).clone())));
    assert!(first.0 > 1000 && second.0 < 100 && other.0 == first.0);
    assert!(Arc::ptr_eq(&first.1, &second.1) && Arc::ptr_eq(&first.2, &second.2));
    assert!(!Arc::ptr_eq(&first.1, &other.1) && first.1 == other.1);
}

#[test]
fn other_bytes_end_with_a_sentence() {
    let order = Order { number: 1, project: example("star", "\"zigzag\""), layer: 0 }.pack().unwrap();
    for bytes in [&b"no order"[..], &order[..order.len() / 2], &[]] {
        assert!(Order::unpack(bytes).unwrap_err().ends_with("Load the page again."));
        assert!(Unpacker::default().unpack(bytes).is_err());
    }
}
