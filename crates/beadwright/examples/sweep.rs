//! The same part with several stepovers, side by side.
//!
//! `cargo run --example sweep`

use beadwright::profile::edit;
use beadwright::{Judge, Profile, Task, example, plan};

type Failure = Box<dyn std::error::Error>;

fn main() -> Result<(), Failure> {
    let text = Profile::built_in_text("cmt-al2319-kuka")?;
    let text = edit::with_value(text, "fill.strategy", "contour")?;
    let text = edit::with_value(&text, "fill.overlap", "free")?;
    let mesh = example::find("cross").ok_or("no such example")?.mesh();
    let mut volumes = Vec::new();
    for stepover in [4.8, 5.4, 6.0] {
        let profile = Profile::parse(&edit::with_value(&text, "fill.stepover", &stepover.to_string())?)?;
        let plan = plan("cross", &mesh, &profile, &Task::new())?;
        let mut judge = Judge::new(beadwright::plan::deposit_settings(&profile));
        plan.layers.iter().for_each(|layer| drop(judge.layer(layer)));
        let (figures, metrics) = (judge.total(), &plan.summary.metrics);
        let void = 100.0 * figures.void / figures.area;
        println!("{stepover:.1} mm: void {void:.2} %, {:.0} s", metrics.total_time_s);
        volumes.push(metrics.deposited_volume_mm3);
    }
    assert!(volumes.is_sorted_by(|a, b| a > b), "wider stepovers lay less");
    Ok(())
}

#[test]
fn runs() -> Result<(), Failure> {
    main()
}
