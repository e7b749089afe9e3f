//! The command `beadwright`: arguments, files and progress. All planning is in the library.
//!
//! Exit status: 0 done, 1 refused with a clear error, 2 wrong usage, 3 the plan has faults that somebody should look at.

mod adapt;
mod batch;
mod bead;
mod build;
mod calibrate;
mod check;
mod clad;
mod compare;
mod completions;
mod convert;
mod deviation;
mod directions;
mod distort;
mod example;
mod export;
mod file;
mod found;
mod guide;
mod heat;
mod inspect;
mod learn;
#[cfg(feature = "listen")]
mod listen;
mod memory;
mod model;
mod onto;
mod parts;
mod plan;
mod preform;
mod profile;
mod program;
mod progress;
mod reach;
mod record;
mod remedy;
mod repair;
mod reproduce;
mod say;
mod scanned;
mod serve;
mod several;
mod simulate;
mod studio;
mod surface;
mod trial;

use clap::{Parser, Subcommand};
use std::process::ExitCode;

/// Plans weld deposition: turns a model into a robot program with a report.
#[derive(Parser)]
#[command(name = "beadwright", version, about, max_term_width = 110)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
    /// Maximum memory to use, GB; three quarters of the machine's if left out.
    #[arg(long, global = true, value_name = "GB", value_parser = parse_memory)]
    max_memory: Option<f64>,
    /// Print only what is asked for, and warnings and errors on standard error.
    #[arg(long, short, global = true, conflicts_with = "verbose")]
    quiet: bool,
    /// Print how long each stage took.
    #[arg(long, short, global = true)]
    verbose: bool,
}

#[derive(Subcommand)]
enum Command {
    /// Plan a model: write the program, plan.json, metrics.json and report.html.
    Plan(plan::Arguments),
    /// Make the preform of a model: the part plus the stock that is milled off afterwards, with weights, hours and prices.
    Preform(preform::Arguments),
    /// Find the tip of the wire, the frame of the part, the axes of a positioner or the place of a scanner from measured points.
    Calibrate(calibrate::Arguments),
    /// Find build directions in which as little as possible of a part overhangs: around a hub, along a bent tube, or in
    /// pieces cut by planes; written as a file of bodies for `plan --bodies`.
    Directions(directions::Arguments),
    /// Print the guide curve of a bent part, to which its layers are perpendicular, for plan --chart: found in a bent tube or bar that
    /// stands on one end, or read from a curve (IGES, or a CSV table with the columns x, y, z in mm).
    Guide(guide::Arguments),
    /// Write the surface of a model as one to stack layers on (a file of bodies for `plan --bodies`).
    Surface(surface::Arguments),
    /// Make a model of the cladding of a base, over its surface or around a pipe, with its bodies for `plan --onto`.
    Clad(clad::Arguments),
    /// Find what a scan of a damaged part lacks: the metal to be welded as a model with its bodies, and the damaged part with its
    /// grooves milled, for `plan --onto`.
    Repair(repair::Arguments),
    /// Plan a model with every strategy, and judge them side by side.
    Compare(compare::Arguments),
    /// Plan many models with many profiles, strategies and values, and put the results into one table.
    Batch(batch::Arguments),
    /// Judge a plan, or a program from any source, by what it would build.
    Simulate(simulate::Arguments),
    /// Report what would go wrong if a plan were welded as it is; without a plan, list the checks.
    Check(check::Arguments),
    /// Fit the width and height of measured beads, and find the parameters for a wanted one.
    #[command(subcommand)]
    Bead(bead::Command),
    /// Plan the layers that follow a scan of a build, corrected by place.
    Adapt(adapt::Arguments),
    /// Compare a scan of the built part with the part: how far its surface lies outside and inside.
    Deviation(deviation::Arguments),
    /// Build a plan in the height model, with errors, to see how much feedback from scans helps.
    Build(build::Arguments),
    /// Check whether a robot can weld a plan: joint angles, margins, and a better place for the part.
    Reach(reach::Arguments),
    /// Compute how warm the metal is before each pass of a plan, and how much time an interpass limit costs.
    Heat(heat::Arguments),
    /// Compute how plate and part bend as the beads shrink, on the clamps and released.
    Distort(distort::Arguments),
    /// Join a plan with the logs of its build: what was welded pass by pass, what is doubtful and where, with hashes that show later
    /// changes.
    Record(record::Arguments),
    /// Write what a cell publishes over MQTT and OPC UA to logs for `record`; it only reads.
    #[cfg(feature = "listen")]
    Listen(listen::Arguments),
    /// Write what a cell publishes to logs: this program was built without it.
    #[cfg(not(feature = "listen"))]
    #[command(disable_help_flag = true)]
    Listen {
        #[arg(trailing_var_arg = true, allow_hyphen_values = true, hide = true)]
        _arguments: Vec<std::ffi::OsString>,
    },
    /// Reproduce the papers' experiments: our results next to theirs.
    Reproduce(reproduce::Arguments),
    /// Write a plan for other programs: tables, lines for ParaView, toolpaths in 3MF, the shape as built, drawings of layers.
    Export(export::Arguments),
    /// Show what a model, a plan or a program contains, and what is wrong with it.
    Inspect(inspect::Arguments),
    /// Write one of the example parts as STL; without a name, list them.
    Example(example::Arguments),
    /// List, print or check profiles, or print their JSON schema.
    #[command(subcommand)]
    Profile(profile::Command),
    /// Print the completion script of a shell, such as `beadwright completions bash`.
    Completions(completions::Completions),
    /// Print the manual page, or write the pages of all commands.
    Man(completions::Man),
    /// Open the desktop program: see the part, the beads and the voids, change a parameter, export.
    Studio(studio::Arguments),
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    memory::watch(arguments.max_memory);
    say::set(arguments.quiet, arguments.verbose);
    let result = match arguments.command {
        Command::Plan(arguments) => parts::run(&arguments),
        Command::Preform(arguments) => preform::run(&arguments),
        Command::Calibrate(arguments) => calibrate::run(&arguments),
        Command::Directions(arguments) => directions::run(&arguments),
        Command::Guide(arguments) => guide::run(&arguments),
        Command::Surface(arguments) => surface::run(&arguments),
        Command::Clad(arguments) => clad::run(&arguments),
        Command::Repair(arguments) => repair::run(&arguments),
        Command::Compare(arguments) => compare::run(&arguments),
        Command::Batch(arguments) => batch::run(&arguments),
        Command::Simulate(arguments) => simulate::run(&arguments),
        Command::Check(arguments) => check::run(&arguments),
        Command::Bead(command) => bead::run(&command),
        Command::Adapt(arguments) => adapt::run(&arguments),
        Command::Deviation(arguments) => deviation::run(&arguments),
        Command::Build(arguments) => build::run(&arguments),
        Command::Reach(arguments) => reach::run(&arguments),
        Command::Heat(arguments) => heat::run(&arguments),
        Command::Distort(arguments) => distort::run(&arguments),
        Command::Record(arguments) => record::run(&arguments),
        #[cfg(feature = "listen")]
        Command::Listen(arguments) => listen::run(&arguments),
        #[cfg(not(feature = "listen"))]
        Command::Listen { .. } => Err(anyhow::anyhow!(
            "this program was built without MQTT and OPC UA. Build it with them: cargo build --release --features listen"
        )),
        Command::Reproduce(arguments) => reproduce::run(&arguments),
        Command::Export(arguments) => export::run(&arguments),
        Command::Inspect(arguments) => inspect::run(&arguments),
        Command::Example(arguments) => example::run(&arguments),
        Command::Profile(command) => profile::run(&command),
        Command::Completions(arguments) => completions::completions::<Arguments>(&arguments),
        Command::Man(arguments) => completions::man::<Arguments>(&arguments),
        Command::Studio(arguments) => match studio::run(&arguments) {
            Ok(status) => return status,
            Err(error) => Err(error),
        },
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        // Whatever reads our output may stop reading: that is not our failure.
        Err(error) if is_broken_pipe(&error) => ExitCode::SUCCESS,
        Err(error) => {
            let error = memory::exceeded(&error).map_or(error, anyhow::Error::msg);
            let remedy = remedy::of(&error).map_or(String::new(), |remedy| format!(" {remedy}"));
            eprintln!("error: {error:#}{remedy}");
            let doubtful = error.is::<plan::Refused>() || error.is::<say::Findings>() || error.is::<batch::Unfit>();
            if doubtful { ExitCode::from(FINDINGS) } else { ExitCode::FAILURE }
        }
    }
}

/// Exit status of a plan with faults.
const FINDINGS: u8 = 3;

fn parse_memory(text: &str) -> Result<f64, String> {
    let most: f64 = text.parse().map_err(|_| "a number of GB is expected, such as 8".to_owned())?;
    if (0.1..=1e5).contains(&most) { Ok(most) } else { Err("it must lie between 0.1 and 100000 GB".to_owned()) }
}

fn is_broken_pipe(error: &anyhow::Error) -> bool {
    error.downcast_ref::<std::io::Error>().is_some_and(|e| e.kind() == std::io::ErrorKind::BrokenPipe)
}
