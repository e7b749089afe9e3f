//! Li et al.: four thin-walled parts, the heights predicted for their layers, and the frame whose junctions must not
//! pile up.

use super::{ReproduceError, Reproduced};
use crate::bead::wall::WallBead;
use crate::compare::MAP_PIXELS;
use crate::deposit::{Judge, Picture};
use crate::dialect;
use crate::example;
use crate::layer::Layer;
use crate::pass::{Along, Pass, PassKind};
use crate::plan::{self, Plan};
use crate::profile::Profile;
use crate::report::sheet::Sheet;
use crate::report::svg;
use crate::task::Task;
use glam::DVec3;
use planar::Bounds;

/// A part of the paper.
struct Part {
    /// Name of the example.
    name: &'static str,
    /// B₁ and h₁, mm.
    bead: (f64, f64),
    /// Layers, height mm and h_n mm that the specification gives.
    paper: (usize, f64, f64),
}

const PARTS: [Part; 4] = [
    Part { name: "tian", bead: (4.5, 1.884), paper: (18, 26.0, 1.4186) },
    Part { name: "blade", bead: (3.5, 1.6885), paper: (74, 100.0, 1.3467) },
    Part { name: "gourd", bead: (4.0, 1.6072), paper: (168, 200.0, 1.1880) },
    Part { name: "pot", bead: (4.0, 1.6237), paper: (66, 80.0, 1.2058) },
];

/// Layers of the frame that are judged.
const JUDGED: usize = 8;

/// Runs the experiment.
///
/// # Errors
/// [`ReproduceError`] when the task was cancelled.
pub fn run(task: &Task) -> Result<Reproduced, ReproduceError> {
    let wrong = |e: &dyn std::fmt::Display| ReproduceError(e.to_string());
    let mut page = Sheet::new(
        "d-thin-wall",
        "Li et al.: a frame 田, a blade, a gourd and a pot, each wall one bead thick. Where a wall leans, its layers rise \
         less, so more of them are laid than on an upright wall of that height.",
    );
    let (mut rows, mut lines, mut files) = (Vec::new(), Vec::new(), Vec::new());
    let mut plans = Vec::new();
    for part in &PARTS {
        let profile = profile(part).map_err(|e| wrong(&e))?;
        let mesh = example::find(part.name).ok_or_else(|| wrong(&"an example part is missing"))?.mesh();
        let plan = plan::plan(part.name, &mesh, &profile, task).map_err(|e| wrong(&e))?;
        let wall = WallBead::new(part.bead.0, part.bead.1).map_err(|e| wrong(&e))?;
        rows.push(row(part, &wall, &plan));
        lines.push(line(part, &wall, &plan));
        plans.push((plan, profile));
    }
    page.heading("Heights");
    page.table(&HEAD, &rows);
    page.heading("Paths");
    for (plan, profile) in &plans {
        let layer = &plan.layers[plan.layers.len() / 3];
        page.text(&format!("{}, layer {} at z {:.2} mm", plan.header.part, layer.index + 1, layer.z));
        page.svg(&svg::layer(layer, &plan.header.part));
        files.extend(dialect::write("rapid", &plan.layers, &profile.job(&plan.header.part)).map_err(|e| wrong(&e))?);
    }
    let (frame, profile) = &plans[0];
    page.heading("Junctions of the frame after eight layers");
    let finding = junctions(&mut page, frame, profile);
    page.text(&finding);
    lines.push(finding);
    lines.push("RAPID of the four parts beside the page".to_owned());
    Ok(Reproduced { page, lines, files })
}

const HEAD: [&str; 8] = [
    "part",
    "B₁ / h₁ mm",
    "h_n mm",
    "the paper's h_n",
    "layers, upright",
    "height of them mm",
    "layers planned",
    "arc starts a layer",
];

fn profile(part: &Part) -> Result<Profile, crate::profile::ProfileError> {
    let mut profile = Profile::built_in("cmt-steel-abb")?;
    profile.fill.strategy = "wall".to_owned();
    (profile.bead.width, profile.bead.height) = part.bead;
    profile.fill.stepover = profile.fill.stepover.map(|_| part.bead.0);
    Ok(profile)
}

fn row(part: &Part, wall: &WallBead, plan: &Plan) -> Vec<(String, bool)> {
    let (_, height, rise) = part.paper;
    let upright = wall.layers_for(height);
    let starts = plan.layers.iter().map(|l| l.passes.len()).max().unwrap_or_default();
    let cells = [
        part.name.to_owned(),
        format!("{} / {}", part.bead.0, part.bead.1),
        format!("{:.4}", wall.rise()),
        format!("{rise:.4}"),
        upright.to_string(),
        format!("{:.1}", wall.total(upright)),
        plan.layers.len().to_string(),
        starts.to_string(),
    ];
    cells.map(|text| (text, false)).to_vec()
}

fn line(part: &Part, wall: &WallBead, plan: &Plan) -> String {
    let (layers, height, rise) = part.paper;
    let upright = wall.layers_for(height);
    format!(
        "{:<6} h_n {:.4} mm (paper {rise:.4}), {upright} upright layers are {:.1} mm (paper {layers} and {height}); {} planned",
        part.name,
        wall.rise(),
        wall.total(upright),
        plan.layers.len()
    )
}

/// Peaks of the planned frame and of one welded straight through its junctions.
fn junctions(page: &mut Sheet, frame: &Plan, profile: &Profile) -> String {
    let planned: Vec<&Layer> = frame.layers.iter().take(JUDGED).collect();
    let straight: Vec<Layer> = planned.iter().map(|layer| straight_through(layer)).collect();
    let (ours, our_map) = stacked(&planned, profile);
    let (theirs, their_map) = stacked(&straight.iter().collect::<Vec<_>>(), profile);
    let maps =
        [("planned".to_owned(), vec![our_map.as_ref()]), ("straight through".to_owned(), vec![their_map.as_ref()])];
    page.maps(&["layer 1".to_owned()], &maps);
    format!(
        "tian: after {JUDGED} layers the highest point is {ours:.2} times as high as the wall's mean with the planned paths, \
         {theirs:.2} times with walls welded straight through their junctions"
    )
}

/// Height of the highest point after some layers over the mean height of the wall, and the field of the first.
fn stacked(layers: &[&Layer], profile: &Profile) -> (f64, Option<Picture>) {
    let points = layers.iter().flat_map(|l| &l.passes).flat_map(|p| &p.points).map(|p| p.truncate());
    let Some(bounds) = Bounds::of(points) else { return (0.0, None) };
    let width = profile.bead.width;
    let bounds = Bounds { min: bounds.min - width, max: bounds.max + width };
    let mut judge = Judge::new(plan::deposit_settings(profile)).with_stack(&bounds).with_pictures(MAP_PIXELS);
    let judged: Vec<_> = layers.iter().map(|layer| judge.layer(layer)).collect();
    let nominal = plan::deposit_settings(profile).nominal.rise * layers.len() as f64;
    let mean = judge.total().mean() * layers.len() as f64;
    let peak = judge.stack().and_then(|stack| stack.growth().last().map(|growth| (nominal + growth.peak) / mean));
    (peak.unwrap_or_default(), judged.into_iter().next().and_then(|j| j.picture))
}

/// The frame as the paper's first plan: around, and straight through the middle, along and across.
fn straight_through(layer: &Layer) -> Layer {
    let half = layer.passes.iter().flat_map(|p| &p.points).map(|p| p.x.abs().max(p.y.abs())).fold(0.0, f64::max);
    let first = &layer.passes[0];
    let pass = |closed: bool, points: &[(f64, f64)]| Pass {
        kind: PassKind::Wall,
        closed,
        points: points.iter().map(|(x, y)| DVec3::new(x * half, y * half, layer.z)).collect(),
        width: Along::Same(first.width.after(0)),
        pace: Along::Same(first.pace.after(0)),
    };
    let passes = [
        pass(true, &[(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]),
        pass(false, &[(-1.0, 0.0), (1.0, 0.0)]),
        pass(false, &[(0.0, -1.0), (0.0, 1.0)]),
    ];
    Layer { passes: passes.to_vec(), ..layer.clone() }
}
