//! Judges a program that someone else wrote: what would it build?
//!
//! `cargo run --example judge_gcode`

use beadwright::dialect::reading::{Options, read};
use beadwright::plan::deposit_settings;
use beadwright::{Judge, Profile, simulate};

type Failure = Box<dyn std::error::Error>;

const PROGRAM: &str = "G21 G90\nM3\nG1 X0 Y0 Z2 F600\nX60\nY3.6\nX0\nY7.2\nX60\nM5\n";

fn main() -> Result<(), Failure> {
    let profile = Profile::built_in("plasma-304-cnc")?;
    let program = read(PROGRAM, &mut |_| None, &Options::default())?;
    let settings = deposit_settings(&profile);
    for layer in simulate::layers(&program, &settings, &profile.bead.law, &profile.process, None) {
        let judgement = Judge::new(settings).layer(&layer);
        let height = judgement.figures.deposited_volume;
        println!("layer at z {} mm: {} passes, {height:.0} mm³ of metal", layer.z, layer.passes.len());
        assert!(height > 0.0);
    }
    Ok(())
}

#[test]
fn runs() -> Result<(), Failure> {
    main()
}
