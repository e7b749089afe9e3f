//! `beadwright distort`: how plate and part bend, on the clamps and released; and the part bent beforehand.

use crate::{file, model, profile, program, progress};
use anyhow::Context;
use beadwright::distort::{Clamp, Deviation, Distortion, Eccentricity, EccentricityScore, Shape};
use beadwright::distortion::compensate::Compensation;
use beadwright::distortion::{self, Setup, Welding};
use beadwright::export::solids;
use beadwright::layer::Layer;
use beadwright::model::{Mesh, stl};
use beadwright::plan::plan;
use beadwright::profile::Profile;
use beadwright::task::Task;
use std::io::Write;
use std::path::{Path, PathBuf};

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
    /// Bend this part, of which the plan was made, beforehand, so that it comes out straight once the clamps are opened. Place it as it
    /// was for the plan.
    #[arg(long, value_name = "MODEL")]
    compensate: Option<PathBuf>,
    /// How often the bent part is planned anew, to see what is left of the deviation and to bend it against that.
    #[arg(long, value_name = "NUMBER", default_value_t = 2, requires = "compensate", value_parser = clap::value_parser!(u8).range(1..=9))]
    rounds: u8,
    /// File for the bent part, as STL or 3MF; NAME_bent.stl if left out.
    #[arg(long, short, value_name = "FILE", requires = "compensate")]
    output: Option<PathBuf>,
    #[command(flatten)]
    placing: model::Placing,
    /// HTML page to write: the bent shape in 3-D, exaggerated by a slider, and its figures.
    #[arg(long, value_name = "FILE")]
    page: Option<PathBuf>,
    /// Print machine-readable JSON: figures, the courses of lift and thermal eccentricity, and both shapes.
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
    let idle = arguments.compensate.is_none() && arguments.placing.moves();
    anyhow::ensure!(
        !idle,
        "--units, --scale, --turn, --shift and the like place the part that --compensate names; name it"
    );
    let profile = source.profile(&arguments.wanted)?;
    let part = source.plan().map_or_else(String::new, |plan| plan.header.part.clone());
    let (task, bar) = progress::task()?;
    let loaded = source.load(&program::Reading::default(), &arguments.wanted, &profile, None, &task)?;
    let (beads, bent) = arguments.build(&loaded.layers, &profile, &task)?;
    let course = distortion::eccentricity(&loaded.layers, &profile, &task)?;
    let rounds = match &arguments.compensate {
        Some(part) => arguments.compensated(part, &bent, &profile, &task)?,
        None => Vec::new(),
    };
    bar.finish_and_clear();
    if let Some(page) = &arguments.page {
        file::write(page, distortion::page::page(&part, &bent, &course).html().as_bytes())?;
    }
    let mut out = std::io::stdout().lock();
    if arguments.json {
        return Ok(writeln!(out, "{:#}", json(&bent, &course, &rounds))?);
    }
    print(&mut out, &loaded.name, &bent, beads)?;
    print_eccentricity(&mut out, &EccentricityScore::of(&course))?;
    print_rounds(&mut out, &rounds)?;
    if let Some(part) = &arguments.compensate {
        writeln!(crate::say::done(false), "\nbent part in {}", arguments.bent(part).display())?;
    }
    Ok(())
}

/// What came of a part bent beforehand.
struct Round {
    compensation: Compensation,
    /// How far the built part is off where it was meant to be.
    left: Deviation,
}

impl Arguments {
    /// Number of beads of layers, and what becomes of them.
    fn build(&self, layers: &[Layer], profile: &Profile, task: &Task) -> anyhow::Result<(usize, Distortion)> {
        let welding = Welding::of(layers, profile)?;
        let setup = Setup {
            material: self.material.map(|material| match material {
                Material::Steel => distortion::Material::Steel,
                Material::Aluminium => distortion::Material::Aluminium,
            }),
            clamps: match self.clamps {
                Clamps::Corners => distortion::Clamps::Corners,
                Clamps::Edge => distortion::Clamps::Edge,
                Clamps::None => distortion::Clamps::None,
            },
            clamp_stiffness: self.clamp_stiffness,
            calibration: self.calibration,
            voxel: self.voxel,
            voxel_height: self.voxel_height,
            most_steps: self.steps,
        };
        Ok((welding.beads.len(), setup.build(&welding, profile, task)?))
    }

    /// The file of the bent part.
    fn bent(&self, model: &Path) -> PathBuf {
        let name = || model::Model::placed_so(model, &self.placing).part();
        self.output.clone().unwrap_or_else(|| format!("{}_bent.stl", name()).into())
    }

    /// Bends a part against what a plan of it does, plans it anew, bends it against what that does, and so on; writes the one of which
    /// least is left.
    fn compensated(
        &self,
        model: &Path,
        bent: &Distortion,
        profile: &Profile,
        task: &Task,
    ) -> anyhow::Result<Vec<Round>> {
        let part = model::Model::placed_so(model, &self.placing);
        let mesh = part.placed(profile, model::Use::AsDrawn, task)?.mesh;
        let context = || format!("{}", model.display());
        let mut compensation = Compensation::new(&mesh, profile.bead.width, task)?;
        let mut bending = bent.bending(&bent.released);
        let mut rounds = vec![Round {
            left: compensation.left(&bending).with_context(context)?,
            compensation: compensation.clone(),
        }];
        for _ in 0..self.rounds {
            compensation = compensation.against(&bending).with_context(context)?;
            let planned = plan(&part.part(), &compensation.mesh(), profile, task)?;
            let (_, bent) = self.build(&planned.layers, profile, task)?;
            bending = bent.bending(&bent.released);
            rounds.push(Round {
                left: compensation.left(&bending).with_context(context)?,
                compensation: compensation.clone(),
            });
        }
        let path = self.bent(model);
        if let Some(best) = rounds[1..].iter().min_by(|a, b| a.left.rms.total_cmp(&b.left.rms)) {
            file::write(&path, &written(&path, &part.part(), &best.compensation.mesh())?)?;
        }
        Ok(rounds)
    }
}

/// A mesh as 3MF, if the file is called so, or as STL.
fn written(path: &Path, name: &str, mesh: &Mesh) -> anyhow::Result<Vec<u8>> {
    if path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("3mf")) {
        return Ok(solids::threemf(&[(name, mesh)])?);
    }
    let corners = |t: &[u32; 3]| t.map(|corner| mesh.vertices[corner as usize]);
    Ok(stl::write(&format!("{name}, bent beforehand"), mesh.triangles.iter().map(corners)))
}

fn json(bent: &Distortion, course: &[Eccentricity], rounds: &[Round]) -> serde_json::Value {
    let shape = |shape: &Shape| {
        let nodes = shape.nodes.iter().zip(&shape.moved);
        let nodes: Vec<_> = nodes.map(|(&node, moved)| [bent.grid.place(node).to_array(), moved.to_array()]).collect();
        serde_json::json!({ "lift": shape.lift, "deviation": shape.deviation, "nodes": nodes })
    };
    let round = |round: &Round| {
        let c = &round.compensation;
        let (bent, at, steepest, raised) = (c.largest, c.at, c.steepest, c.raised);
        serde_json::json!({ "bent": bent, "at": at, "steepest": steepest, "raised": raised, "left": round.left })
    };
    let mut value = serde_json::json!({
        "voxels": bent.voxels.len(),
        "steps": bent.steps,
        "clamped": shape(&bent.clamped),
        "released": shape(&bent.released),
        "eccentricity": { "score": EccentricityScore::of(course), "course": course },
        "balance": { "clamped": bent.clamped_balance, "released": bent.released_balance },
    });
    if !rounds.is_empty() {
        value["compensation"] = rounds.iter().map(round).collect();
    }
    value
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

fn print_eccentricity(out: &mut impl Write, score: &EccentricityScore) -> std::io::Result<()> {
    let EccentricityScore { mean, largest, largest_at, lasting } = score;
    let lasting = lasting.truncate().length();
    writeln!(
        out,
        "  {:<32} {mean:.1} mm on the mean, {largest:.1} mm after {:.0} min, {lasting:.1} mm that does not cancel",
        "thermal eccentricity",
        largest_at / 60.0
    )
}

fn print_rounds(out: &mut impl Write, rounds: &[Round]) -> std::io::Result<()> {
    for (number, Round { compensation: c, left }) in rounds.iter().enumerate() {
        let (largest, rms) = (left.largest, left.rms);
        if number == 0 {
            writeln!(out, "\nbent beforehand")?;
            writeln!(out, "  {:<32} {largest:.2} mm at most, {rms:.2} mm rms", "off as it was planned")?;
            continue;
        }
        let name = format!("off with bend {number}");
        writeln!(
            out,
            "  {name:<32} {largest:.2} mm at most, {rms:.2} mm rms; bent by up to {:.2} mm ({:.3} mm per mm), raised by {:.2} mm",
            c.largest, c.steepest, c.raised
        )?;
    }
    Ok(())
}
