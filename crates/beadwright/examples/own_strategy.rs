//! A strategy of one's own: only the outermost contour of every island.
//!
//! `cargo run --example own_strategy`

use beadwright::fill::{Fill, Path};
use beadwright::plan::{Collect, plan_with};
use beadwright::planar::Polygon;
use beadwright::{FillSettings, Profile, Strategy, Task, example};

type Failure = Box<dyn std::error::Error>;

struct Skin;

impl Strategy for Skin {
    fn name(&self) -> &'static str {
        "skin"
    }

    fn fill(&self, island: &Polygon, settings: &FillSettings) -> Fill {
        let rings = settings.outermost(island).rings().cloned().collect::<Vec<_>>();
        let paths = rings.into_iter().map(|ring| Path::contour(ring, settings.bead.width));
        Fill { stages: vec![paths.collect()], fixed_order: false }
    }
}

fn main() -> Result<(), Failure> {
    let profile = Profile::built_in("cmt-al2319-kuka")?;
    let mesh = example::find("gear").ok_or("no such example")?.mesh();
    let mut kept = Collect::default();
    let summary = plan_with("gear", &mesh, &Skin, &profile, &Task::new(), &mut kept)?;
    println!("{} layers, {} arc starts", kept.layers.len(), summary.metrics.arc_starts);
    // The gear has a bore: two contours a layer.
    assert_eq!(summary.metrics.arc_starts, 2 * kept.layers.len());
    Ok(())
}

#[test]
fn runs() -> Result<(), Failure> {
    main()
}
