//! `beadwright distort`: how plate and part bend, on the clamps and released.

use crate::{profile, program, progress};
use beadwright::distort::{self, Clamp, Distortion, Settings, Shape};
use beadwright::distortion::Welding;
use beadwright::task::Stage;
use std::io::Write;
use std::path::PathBuf;

/// Radius of a clamp, mm, and the distance of those along an edge, mm.
const CLAMP: (f64, f64) = (10.0, 60.0);

#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// plan.json.
    plan: PathBuf,
    #[command(flatten)]
    wanted: profile::Wanted,
    /// Elastic values and shrinkage; by default those that suit the density of the wire.
    #[arg(long, value_enum)]
    material: Option<Material>,
    /// Where clamps hold the plate until the build is done.
    #[arg(long, value_enum, default_value_t)]
    clamps: Clamps,
    /// Stiffness of a clamp in each direction, N/mm.
    #[arg(long, value_name = "N/MM", default_value_t = Clamp::FIRM.x)]
    clamp_stiffness: f64,
    /// Factor of all shrinkage, found with a measured plate.
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0)]
    calibration: f64,
    /// Length and width of voxels, mm; by default half a bead, or more for large parts.
    #[arg(long, value_name = "MM")]
    voxel: Option<f64>,
    /// Height of voxels, mm; by default that of a layer, or more for large parts.
    #[arg(long, value_name = "MM")]
    voxel_height: Option<f64>,
    /// Most steps: beads are laid in as many groups.
    #[arg(long, value_name = "NUMBER")]
    steps: Option<usize>,
    /// Print machine-readable JSON: figures, the course of the lift, and both shapes.
    #[arg(long)]
    json: bool,
}

#[derive(Clone, Copy, clap::ValueEnum)]
enum Material {
    Steel,
    Aluminium,
}

#[derive(Clone, Copy, Default, clap::ValueEnum)]
enum Clamps {
    /// One at each corner of the plate.
    #[default]
    Corners,
    /// All along its edge.
    Edge,
    /// It lies free.
    None,
}

pub(crate) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let source = program::Source::open(&arguments.plan)?;
    let path = arguments.plan.display();
    anyhow::ensure!(source.plan().is_some(), "{path}: give the plan.json of the program");
    let profile = source.profile(&arguments.wanted)?;
    let (task, bar) = progress::task()?;
    let loaded = source.load(&program::Reading::default(), &arguments.wanted, &profile, None, &task)?;
    let welding = Welding::of(&loaded.layers, &profile)?;
    let settings = match arguments.material {
        Some(Material::Steel) => welding.with_voxels(Settings::steel(), &profile),
        Some(Material::Aluminium) => welding.with_voxels(Settings::aluminium(), &profile),
        None => welding.settings(&profile)?,
    };
    let settings = Settings {
        calibration: arguments.calibration,
        voxel: arguments.voxel.unwrap_or(settings.voxel),
        voxel_height: arguments.voxel_height.unwrap_or(settings.voxel_height),
        most_steps: arguments.steps.unwrap_or(settings.most_steps),
        ..settings
    };
    let (stiffness, (radius, spacing)) = (distort::DVec3::splat(arguments.clamp_stiffness), CLAMP);
    let clamps = match arguments.clamps {
        Clamps::Corners => welding.plate.clamped_at_corners(radius, stiffness),
        Clamps::Edge => welding.plate.clamped_along_edge(spacing, radius, stiffness),
        Clamps::None => Vec::new(),
    };
    let bent = distort::build(&welding.plate, &welding.beads, &clamps, &settings, &mut |fraction| {
        task.step(Stage::Distort, fraction).is_ok()
    })?;
    bar.finish_and_clear();
    let mut out = std::io::stdout().lock();
    if arguments.json {
        return Ok(writeln!(out, "{:#}", json(&bent))?);
    }
    Ok(print(&mut out, &loaded.name, &bent, welding.beads.len())?)
}

fn json(bent: &Distortion) -> serde_json::Value {
    let shape = |shape: &Shape| {
        let nodes = shape.nodes.iter().zip(&shape.moved);
        let nodes: Vec<_> = nodes.map(|(&node, moved)| [bent.grid.place(node).to_array(), moved.to_array()]).collect();
        serde_json::json!({ "lift": shape.lift, "deviation": shape.deviation, "nodes": nodes })
    };
    serde_json::json!({
        "voxels": bent.voxels.len(),
        "steps": bent.steps,
        "clamped": shape(&bent.clamped),
        "released": shape(&bent.released),
        "balance": { "clamped": bent.clamped_balance, "released": bent.released_balance },
    })
}

fn print(out: &mut impl Write, name: &str, bent: &Distortion, beads: usize) -> std::io::Result<()> {
    let [x, y, z] = bent.grid.size.to_array();
    let (voxels, steps) = (bent.voxels.len(), bent.steps.len());
    writeln!(out, "{name}: {beads} beads in {steps} steps, {voxels} voxels of {x:.1} × {y:.1} × {z:.1} mm\n")?;
    let rows = [
        ("lift of the plate, clamped", bent.clamped.lift.range, bent.clamped.lift.at),
        ("lift of the plate, released", bent.released.lift.range, bent.released.lift.at),
        ("deviation of the part, clamped", bent.clamped.deviation.largest, bent.clamped.deviation.at),
        ("deviation of the part, released", bent.released.deviation.largest, bent.released.deviation.at),
    ];
    for (name, value, at) in rows {
        writeln!(out, "  {name:<32} {value:.2} mm, most at x {:.0}, y {:.0}, z {:.0}", at.x, at.y, at.z)?;
    }
    let force = bent.clamped_balance.largest_reaction;
    writeln!(out, "  {:<32} {:.1} kN at a node", "largest force of a clamp", force / 1e3)
}
