//! The figures of the page `d-thin-wall` (Li et al.), with the parts as they are and turned by 33°.
#![allow(clippy::unwrap_used)]

mod common;

use beadwright::check;
use beadwright::example;
use beadwright::model::Part;
use beadwright::pass::Pass;
use beadwright::plan::{self, choice};
use beadwright::profile::Profile;
use beadwright::reproduce::d_thin_wall::{self, Built, Figures, PARTS};
use beadwright::task::Task;
use std::f64::consts::PI;
use std::sync::OnceLock;

fn all() -> &'static [Figures; 2] {
    static ALL: OnceLock<[Figures; 2]> = OnceLock::new();
    ALL.get_or_init(|| [0.0, 33.0].map(|degrees| d_thin_wall::figures(degrees, &Task::new()).unwrap()))
}

fn built() -> impl Iterator<Item = &'static Built> {
    all().iter().flat_map(|figures| &figures.built)
}

#[test]
fn print_the_goals() {
    for goal in d_thin_wall::goals(all()) {
        println!("{goal:?}");
    }
    for b in built() {
        println!(
            "{} {:?} layers {} metal {:.4} cover {:.4} speeds {:?} curves {:?} feed {}",
            b.part.name,
            b.wall,
            b.plan.layers.len(),
            b.metal,
            b.plan.summary.metrics.coverage(),
            b.speeds,
            b.by_curves,
            b.profile.process.wire_feed_speed
        );
    }
    for f in all() {
        println!("{} {} {}", f.gourd_by_pot, f.pot_by_gourd, f.blade_by_pot);
        println!("{:?} {:?}", f.planned.heights, f.straight.heights);
    }
}
