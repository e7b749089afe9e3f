//! Plans a part and writes its program: a solid, or a wall given by curves.
//!
//! `cargo run --example plan [MODEL]`

use beadwright::{Model, Placement, Profile, Task, dialect, example, plan};

type Failure = Box<dyn std::error::Error>;

fn program(name: &str, bytes: &[u8], height: Option<f64>, post: &str) -> Result<usize, Failure> {
    let profile = Profile::built_in(if post == "krl" { "cmt-al2319-kuka" } else { "cmt-steel-abb" })?;
    let part = Model::read(bytes, &Task::new())?.place(&Placement::default(), height, profile.bead.width)?;
    let plan = plan(name, &part, &profile, &Task::new())?;
    let files = dialect::write(post, &plan.layers, &profile.job(name))?;
    println!("{name}: {} arc starts, {} files", plan.summary.metrics.arc_starts, files.len());
    Ok(files.len())
}

fn main() -> Result<(), Failure> {
    if let Some(path) = std::env::args().nth(1).filter(|path| path.contains('.')) {
        program("part", &std::fs::read(path)?, None, "krl")?;
    }
    let [solid, wall] = ["cross", "tian"].map(example::find);
    program("cross", &solid.ok_or("no such example")?.stl(), None, "krl")?;
    let curves = wall.and_then(|wall| wall.iges()).ok_or("no curves")?;
    program("tian", curves.as_bytes(), Some(26.0), "rapid")?;
    Ok(())
}

#[test]
fn runs() -> Result<(), Failure> {
    main()
}
