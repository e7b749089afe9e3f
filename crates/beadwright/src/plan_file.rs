//! plan.json, versions 2 and 3: the plan as text, written layer by layer and read back. It contains the whole profile
//! that it was made with. Lengths are in mm, paces in mm/s.
//!
//! Version 3 is for plans whose layers are not level (the profile's `layers.chart`). It gives points in space, close
//! enough together to follow the layer, with the layer's normal at each (`normals`). `z`, `height` and islands are
//! those of the layer as the chart unrolls it.
//!
//! Version 1, which is still read, holds only the name of the profile and its bead, and calls the pace `speed`.

use crate::bead::{Bead, Section};
use crate::chart::Sheet;
use crate::deposit::{DepositSettings, Nominal};
use crate::heat::LONGEST_WAIT;
use crate::layer::{Extent, Layer, Lit};
use crate::model::MAX_REACH_MM;
use crate::number::{fixed, push_fixed};
use crate::pass::{Along, Pass, PassKind};
use crate::plan::{self, Header, charted};
use crate::profile::{LayersSection, Profile, ProfileError};
use crate::slice::Half;
use glam::{DVec2, DVec3};
use planar::{Polygon, Ring};
use serde::Deserialize;
use serde_json::json;

/// Version of the format for level layers, and the newest one.
pub const VERSION: u32 = 2;
const NEWEST: u32 = 3;

/// Decimals of normals: 0.0001°.
const NORMAL_DECIMALS: usize = 6;

/// Decimals of coordinates: the 0.1 µm grid of planar geometry.
const DECIMALS: usize = 4;

/// The text before the first layer.
pub fn head(header: &Header, profile: &Profile) -> String {
    let Header { part, strategy, extent, .. } = header;
    let bounds = [extent.low, extent.high];
    let fields = json!({ "part": part, "strategy": strategy, "profile": profile, "bounds": bounds }).to_string();
    let version = if profile.layers.are_level() { VERSION } else { NEWEST };
    format!("{{\"version\":{version},\"units\":\"mm\",{},\"layers\":[", &fields[1..fields.len() - 1])
}

/// The text of one layer; all but the one with index 0 begin with a comma. `sheet` says how it lies in space, if it is not level.
pub fn layer(layer: &Layer, sheet: Option<&Sheet<'_>>) -> String {
    let points: usize = layer.passes.iter().map(|p| p.points.len()).sum();
    let mut text = String::with_capacity(256 + points * 28);
    text.push_str(if layer.index == 0 { "\n" } else { ",\n" });
    text.push_str(&format!("{{\"index\":{},\"z\":", layer.index));
    push_fixed(&mut text, layer.z, DECIMALS);
    text.push_str(",\"height\":");
    push_fixed(&mut text, layer.height, DECIMALS);
    if layer.body > 0 {
        text.push_str(&format!(",\"body\":{}", layer.body));
    }
    if layer.lit.after {
        text.push_str(",\"goes_on\":true");
    }
    if let Some(half) = layer.half {
        text.push_str(&format!(",\"half\":\"{}\"", half.name()));
    }
    text.push_str(",\"islands\":");
    list(&mut text, &layer.islands, |text, island| {
        text.push_str("{\"outline\":");
        ring(text, &island.outer);
        text.push_str(",\"holes\":");
        list(text, &island.holes, ring);
        text.push('}');
    });
    text.push_str(",\"passes\":");
    list(&mut text, &layer.passes, |text, own| match sheet {
        None => pass(text, own, None),
        Some(sheet) => {
            let (own, normals) = charted::in_space(own, sheet);
            pass(text, &own, Some(&normals));
        }
    });
    text.push('}');
    text
}

/// The text after the last layer.
pub fn tail() -> &'static str {
    "\n]}\n"
}

fn pass(text: &mut String, pass: &Pass, normals: Option<&[DVec3]>) {
    text.push_str(&format!("{{\"kind\":\"{}\",\"closed\":{},\"points\":", pass.kind.name(), pass.closed));
    // Nearly all points of a pass have the same height, so it is turned into text once.
    let (mut height, mut z) = (f64::NAN, String::new());
    list(text, &pass.points, |text, p| {
        if p.z != height {
            (height, z) = (p.z, fixed(p.z, DECIMALS));
        }
        text.push('[');
        push_fixed(text, p.x, DECIMALS);
        text.push(',');
        push_fixed(text, p.y, DECIMALS);
        text.push(',');
        text.push_str(&z);
        text.push(']');
    });
    if let Some(normals) = normals {
        text.push_str(",\"normals\":");
        list(text, normals, |text, normal| {
            list(text, &normal.to_array(), |text, v| push_fixed(text, *v, NORMAL_DECIMALS))
        });
    }
    text.push_str(",\"width\":");
    along(text, &pass.width);
    text.push_str(",\"pace\":");
    along(text, &pass.pace);
    if pass.wait > 0.0 {
        text.push_str(",\"wait\":");
        push_fixed(text, pass.wait, DECIMALS);
    }
    text.push('}');
}

fn along(text: &mut String, along: &Along) {
    match along {
        Along::Same(value) => push_fixed(text, *value, DECIMALS),
        Along::Each(values) => numbers(text, values),
    }
}

fn ring(text: &mut String, ring: &Ring) {
    list(text, ring.points(), |text, p| numbers(text, &p.to_array()));
}

fn numbers(text: &mut String, values: &[f64]) {
    list(text, values, |text, v| push_fixed(text, *v, DECIMALS));
}

fn list<T>(text: &mut String, items: &[T], mut write: impl FnMut(&mut String, &T)) {
    text.push('[');
    for (i, item) in items.iter().enumerate() {
        if i > 0 {
            text.push(',');
        }
        write(text, item);
    }
    text.push(']');
}

/// A plan read from its file.
#[derive(Debug, Clone, PartialEq)]
pub struct PlanFile {
    /// Part, profile and strategy.
    pub header: Header,
    /// The profile it was made with; `None` in version 1.
    pub profile: Option<Profile>,
    /// The deposit settings and bead that it was made for; `None` in files of version 1 that do not give them.
    pub settings: Option<DepositSettings>,
    /// Its layers; planned areas and warnings are not in the file.
    pub layers: Vec<Layer>,
}

/// Why a plan file cannot be read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PlanFileError {
    /// Not JSON, or not a plan.
    #[error("this is not a plan.json of Beadwright: {0}. Make the plan again with `beadwright plan`.")]
    Malformed(#[from] serde_json::Error),
    /// Another version.
    #[error(
        "this plan.json has version {0}; versions 1 to {NEWEST} are read. Make the plan again with `beadwright plan`."
    )]
    Version(u32),
    /// Version and chart disagree on whether layers are level.
    #[error(
        "this plan.json has version {0}, which does not fit layers.chart of its profile: layers that are not level \
         are in version {NEWEST}. Make the plan again with `beadwright plan`."
    )]
    Chart(u32),
    /// Not in millimetres.
    #[error("this plan.json is in \"{0}\"; plans are in \"mm\". Make the plan again with `beadwright plan`.")]
    Units(String),
    /// Its profile cannot be read.
    #[error("the profile in this plan.json: {0}. Make the plan again with `beadwright plan`.")]
    Profile(#[from] ProfileError),
    /// Nothing to weld.
    #[error("this plan.json holds no layers. Make the plan again with `beadwright plan`.")]
    Empty,
    /// An impossible bead.
    #[error(
        "width, height, speed and rise of the bead must be greater than 0 and at most {MAX_MEASURE}, the machining allowance \
         0 to 50 mm. Make the plan again with `beadwright plan`."
    )]
    Bead,
    /// An impossible layer.
    #[error("layer {layer}: {reason}. Make the plan again with `beadwright plan`.")]
    Layer {
        /// Number of the layer, from 1.
        layer: usize,
        /// What is wrong.
        reason: &'static str,
    },
    /// Values that do not fit together.
    #[error("layer {layer}, pass {pass}: {reason}. Make the plan again with `beadwright plan`.")]
    Pass {
        /// Number of the layer, from 1.
        layer: usize,
        /// Number of the pass, from 1.
        pass: usize,
        /// What is wrong.
        reason: &'static str,
    },
}

/// Reads a plan file.
///
/// ```
/// use beadwright::{Profile, StrategyName, Task, example, plan, plan_file};
///
/// let mut profile = Profile::built_in("cmt-al2319-kuka")?;
/// profile.fill.strategy = StrategyName::Zigzag;
/// let cross = example::find("cross").ok_or("no such example")?.mesh();
/// let plan = plan("cross", &cross, &profile, &Task::new())?;
/// let layers: String = plan.layers.iter().map(|layer| plan_file::layer(layer, None)).collect();
/// let again = plan_file::read(&(plan_file::head(&plan.header, &profile) + &layers + plan_file::tail()))?;
/// assert_eq!((again.header.part.as_str(), again.layers.len()), ("cross", plan.layers.len()));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`PlanFileError`], which names the line, or the layer and pass.
pub fn read(text: &str) -> Result<PlanFile, PlanFileError> {
    let file: File = serde_json::from_str(text)?;
    if !(1..=NEWEST).contains(&file.version) {
        return Err(PlanFileError::Version(file.version));
    }
    if file.units != "mm" {
        return Err(PlanFileError::Units(file.units));
    }
    let (name, profile, settings) = match file.profile {
        FileProfile::Whole(profile) => {
            let profile = Profile::from_json(&profile)?;
            (profile.name.clone(), Some(profile.clone()), Some(plan::deposit_settings(&profile)))
        }
        FileProfile::Name(name) => (name, None, file.bead.map(|b| b.settings(file.machining_allowance)).transpose()?),
    };
    let section = profile.as_ref().map(|profile| &profile.layers);
    let mut layers = file
        .layers
        .into_iter()
        .enumerate()
        .map(|layer| FileLayer::layer(layer, section))
        .collect::<Result<Vec<_>, _>>()?;
    Lit::join(&mut layers).map_err(|index| PlanFileError::Layer { layer: index + 1, reason: NOT_ONE_TURN })?;
    if layers.is_empty() {
        return Err(PlanFileError::Empty);
    }
    let extent = match file.bounds {
        Some([low, high]) => Extent { layers: layers.len(), low, high },
        None => Extent::of(&layers),
    };
    let header = Header { part: file.part, profile: name, strategy: file.strategy, extent };
    Ok(PlanFile { header, profile, settings, layers })
}

#[derive(Deserialize)]
struct File {
    version: u32,
    #[serde(default = "millimetres")]
    units: String,
    #[serde(default)]
    part: String,
    #[serde(default)]
    profile: FileProfile,
    #[serde(default)]
    strategy: String,
    bead: Option<FileBead>,
    #[serde(default)]
    machining_allowance: f64,
    /// Where the part lies, mm.
    bounds: Option<[DVec3; 2]>,
    layers: Vec<FileLayer>,
}

fn millimetres() -> String {
    "mm".to_owned()
}

#[derive(Deserialize)]
#[serde(untagged)]
enum FileProfile {
    Name(String),
    Whole(serde_json::Value),
}

impl Default for FileProfile {
    fn default() -> Self {
        Self::Name(String::new())
    }
}

#[derive(Deserialize)]
struct FileBead {
    width: f64,
    height: f64,
    speed: f64,
    rise: f64,
    #[serde(default)]
    section: Section,
}

#[derive(Deserialize)]
struct FileLayer {
    index: usize,
    z: f64,
    height: f64,
    #[serde(default)]
    body: usize,
    #[serde(default)]
    half: Option<Half>,
    #[serde(default)]
    goes_on: bool,
    islands: Vec<FileIsland>,
    passes: Vec<FilePass>,
}

/// Why a layer is not a turn of a helix.
const NOT_ONE_TURN: &str = "the arc continues from layer to layer there (goes_on), so it must have one pass";

#[derive(Deserialize)]
struct FileIsland {
    outline: Vec<DVec2>,
    holes: Vec<Vec<DVec2>>,
}

#[derive(Deserialize)]
struct FilePass {
    kind: PassKind,
    closed: bool,
    points: Vec<DVec3>,
    width: FileAlong,
    #[serde(alias = "speed")]
    pace: FileAlong,
    #[serde(default)]
    wait: f64,
}

#[derive(Deserialize)]
#[serde(untagged)]
enum FileAlong {
    Same(f64),
    Each(Vec<f64>),
}

impl FileBead {
    fn settings(self, machining_allowance: f64) -> Result<DepositSettings, PlanFileError> {
        let Self { width, height, speed, rise, section } = self;
        if ![width, height, speed, rise].iter().all(|&v| possible(v)) || !(0.0..=50.0).contains(&machining_allowance) {
            return Err(PlanFileError::Bead);
        }
        let nominal = Nominal { bead: Bead { width, height, section }, pace: speed, rise };
        Ok(DepositSettings::new(nominal, machining_allowance))
    }
}

/// Whether a width or a height (mm) or a pace (mm/s) is possible for a machine.
fn possible(value: f64) -> bool {
    value > 0.0 && value <= MAX_MEASURE
}

/// Greatest width (mm), height (mm) or pace (mm/s).
const MAX_MEASURE: f64 = 2000.0;

impl FileLayer {
    fn layer((number, layer): (usize, Self), section: Option<&LayersSection>) -> Result<Layer, PlanFileError> {
        let Self { index, z, height, body, half, goes_on, islands, passes } = layer;
        let wrong = |reason| Err(PlanFileError::Layer { layer: number + 1, reason });
        if index != number {
            return wrong("its index is not its place in the list, counted from 0");
        }
        let islands: Vec<Polygon> = islands.into_iter().map(FileIsland::polygon).collect();
        if let Err(reason) = check_layer(z, height, &islands) {
            return wrong(reason);
        }
        let read = |(i, pass): (usize, FilePass)| {
            pass.pass().map_err(|reason| PlanFileError::Pass { layer: index + 1, pass: i + 1, reason })
        };
        let passes = passes.into_iter().enumerate().map(read).collect::<Result<Vec<_>, _>>()?;
        let slice_area = islands.iter().map(Polygon::area).sum();
        let lit = Lit { before: false, after: goes_on };
        let mut layer = Layer { index, z, height, body, half, islands, passes, lit, slice_area, ..Layer::default() };
        if body > 0 && section.is_none_or(|section| body >= section.bodies.len()) {
            return wrong("its body is none of those in layers.bodies of the profile");
        }
        if let Some(sheet) = section.and_then(|section| section.sheet(&layer)) {
            let on_layer = |pass| charted::on_layer(pass, &sheet, &layer.islands);
            layer.passes = std::mem::take(&mut layer.passes).into_iter().map(on_layer).collect();
        }
        Ok(layer)
    }
}

/// Whether a coordinate (mm) is within bounds.
fn near(coordinate: f64) -> bool {
    coordinate.abs() <= MAX_REACH_MM
}

impl FileIsland {
    fn polygon(self) -> Polygon {
        Polygon { outer: Ring::new(self.outline), holes: self.holes.into_iter().map(Ring::new).collect() }
    }
}

impl FilePass {
    fn pass(self) -> Result<Pass, &'static str> {
        let along = |along: FileAlong| match along {
            FileAlong::Same(value) => Along::Same(value),
            FileAlong::Each(values) => Along::Each(values),
        };
        let (width, pace) = (along(self.width), along(self.pace));
        let wait = self.wait;
        let pass = Pass { kind: self.kind, closed: self.closed, points: self.points, width, pace, wait };
        check_pass(&pass).map(|()| pass)
    }
}

/// What no machine could weld in a pass that was read, as a clause.
pub(crate) fn check_pass(pass: &Pass) -> Result<(), &'static str> {
    let count = pass.points.len();
    if count < 2 {
        return Err("a pass needs two points");
    }
    if !pass.points.iter().all(|p| near(p.x) && near(p.y) && near(p.z)) {
        return Err("a coordinate is out of bounds (20 m)");
    }
    if !(0.0..=LONGEST_WAIT).contains(&pass.wait) {
        return Err("a wait must last 0 to 36000 s");
    }
    [&pass.width, &pass.pace].into_iter().try_for_each(|along| match along {
        Along::Same(value) if possible(*value) => Ok(()),
        Along::Each(values) if values.len() != count => Err("width and pace need one value, or one per point"),
        Along::Each(values) if values.iter().all(|&v| possible(v)) => Ok(()),
        _ => Err("widths and paces must be greater than 0 and at most 2000"),
    })
}

/// What is impossible about the height (mm), thickness (mm) and outlines of a layer that was read.
pub(crate) fn check_layer(z: f64, height: f64, islands: &[Polygon]) -> Result<(), &'static str> {
    let mut points = islands.iter().flat_map(Polygon::rings).flat_map(Ring::points);
    if possible(height) && near(z) && points.all(|p| near(p.x) && near(p.y)) {
        Ok(())
    } else {
        Err("its thickness (at most 2 m) or a coordinate (at most 20 m) is out of bounds")
    }
}
