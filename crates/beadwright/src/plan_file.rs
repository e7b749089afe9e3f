//! plan.json, version 1: the plan as text, written layer by layer, and read back.

use crate::bead::{Bead, Section};
use crate::deposit::{DepositSettings, Nominal};
use crate::layer::Layer;
use crate::number::push_fixed;
use crate::pass::{Along, Pass, PassKind};
use crate::plan::Header;
use glam::{DVec2, DVec3};
use planar::{Polygon, Ring};
use serde::Deserialize;
use serde_json::json;

/// Version of the format.
pub const VERSION: u32 = 1;

/// Decimals of coordinates: the 0.1 µm grid of the plane.
const DECIMALS: usize = 4;

/// The text before the first layer.
pub fn head(header: &Header, settings: &DepositSettings) -> String {
    let Header { part, profile, strategy, .. } = header;
    let Nominal { bead, pace, rise } = settings.nominal;
    let fields = json!({
        "part": part, "profile": profile, "strategy": strategy,
        "bead": { "width": bead.width, "height": bead.height, "speed": pace, "rise": rise, "section": bead.section },
        "machining_allowance": settings.machining_allowance,
    });
    let fields = fields.to_string();
    format!("{{\"version\":{VERSION},\"units\":\"mm\",{},\"layers\":[", &fields[1..fields.len() - 1])
}

/// The text of one layer; a comma comes before all but the one of index 0.
pub fn layer(layer: &Layer) -> String {
    let points: usize = layer.passes.iter().map(|p| p.points.len()).sum();
    let mut text = String::with_capacity(256 + points * 28);
    text.push_str(if layer.index == 0 { "\n" } else { ",\n" });
    text.push_str(&format!("{{\"index\":{},\"z\":", layer.index));
    push_fixed(&mut text, layer.z, DECIMALS);
    text.push_str(",\"height\":");
    push_fixed(&mut text, layer.height, DECIMALS);
    text.push_str(",\"islands\":");
    list(&mut text, &layer.islands, |text, island| {
        text.push_str("{\"outline\":");
        ring(text, &island.outer);
        text.push_str(",\"holes\":");
        list(text, &island.holes, ring);
        text.push('}');
    });
    text.push_str(",\"passes\":");
    list(&mut text, &layer.passes, pass);
    text.push('}');
    text
}

/// The text after the last layer.
pub fn tail() -> &'static str {
    "\n]}\n"
}

fn pass(text: &mut String, pass: &Pass) {
    text.push_str(&format!("{{\"kind\":\"{}\",\"closed\":{},\"points\":", pass.kind.name(), pass.closed));
    list(text, &pass.points, |text, p| numbers(text, &p.to_array()));
    text.push_str(",\"width\":");
    along(text, &pass.width);
    text.push_str(",\"speed\":");
    along(text, &pass.pace);
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
    /// The settings and bead it was made for; `None` in files that do not say.
    pub settings: Option<DepositSettings>,
    /// Its layers; planned areas and warnings are not in the file.
    pub layers: Vec<Layer>,
}

/// Why a plan file cannot be read.
#[derive(Debug, thiserror::Error)]
pub enum PlanFileError {
    /// Not JSON, or not a plan.
    #[error("this is not a plan.json of Beadwright: {0}. Make the plan again with `beadwright plan`.")]
    Malformed(#[from] serde_json::Error),
    /// Another version.
    #[error("this plan.json has version {0}; version {VERSION} is read. Make the plan again with `beadwright plan`.")]
    Version(u32),
    /// An impossible bead.
    #[error(
        "width, height, speed and rise of the bead must be greater than 0. Make the plan again with `beadwright plan`."
    )]
    Bead,
    /// Values that do not belong together.
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
/// # Errors
/// [`PlanFileError`] with the line, or the layer and pass.
pub fn read(text: &str) -> Result<PlanFile, PlanFileError> {
    let file: File = serde_json::from_str(text)?;
    if file.version != VERSION {
        return Err(PlanFileError::Version(file.version));
    }
    if file.bead.as_ref().is_some_and(|b| [b.width, b.height, b.speed, b.rise].iter().any(|&v| v <= 0.0)) {
        return Err(PlanFileError::Bead);
    }
    let settings = file.bead.map(|b| {
        let bead = Bead { width: b.width, height: b.height, section: b.section };
        DepositSettings::new(Nominal { bead, pace: b.speed, rise: b.rise }, file.machining_allowance)
    });
    let layers = file.layers.into_iter().map(FileLayer::layer).collect::<Result<Vec<_>, _>>()?;
    let header = Header { part: file.part, profile: file.profile, strategy: file.strategy, layers: layers.len() };
    Ok(PlanFile { header, settings, layers })
}

#[derive(Deserialize)]
struct File {
    version: u32,
    #[serde(default)]
    part: String,
    #[serde(default)]
    profile: String,
    #[serde(default)]
    strategy: String,
    bead: Option<FileBead>,
    #[serde(default)]
    machining_allowance: f64,
    layers: Vec<FileLayer>,
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
    islands: Vec<FileIsland>,
    passes: Vec<FilePass>,
}

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
    speed: FileAlong,
}

#[derive(Deserialize)]
#[serde(untagged)]
enum FileAlong {
    Same(f64),
    Each(Vec<f64>),
}

impl FileLayer {
    fn layer(self) -> Result<Layer, PlanFileError> {
        let Self { index, z, height, islands, passes } = self;
        let islands: Vec<Polygon> = islands.into_iter().map(FileIsland::polygon).collect();
        let read = |(i, pass): (usize, FilePass)| {
            pass.pass().map_err(|reason| PlanFileError::Pass { layer: index + 1, pass: i + 1, reason })
        };
        let passes = passes.into_iter().enumerate().map(read).collect::<Result<Vec<_>, _>>()?;
        let slice_area = islands.iter().map(Polygon::area).sum();
        Ok(Layer { index, z, height, islands, passes, slice_area, ..Layer::default() })
    }
}

impl FileIsland {
    fn polygon(self) -> Polygon {
        Polygon { outer: Ring::new(self.outline), holes: self.holes.into_iter().map(Ring::new).collect() }
    }
}

impl FilePass {
    fn pass(self) -> Result<Pass, &'static str> {
        let count = self.points.len();
        if count < 2 {
            return Err("a pass needs two points");
        }
        let along = |along: FileAlong| match along {
            FileAlong::Same(value) if value > 0.0 => Ok(Along::Same(value)),
            FileAlong::Each(values) if values.len() != count => Err("width and speed need one value, or one per point"),
            FileAlong::Each(values) if values.iter().all(|&v| v > 0.0) => Ok(Along::Each(values)),
            _ => Err("widths and speeds must be greater than 0"),
        };
        let (width, pace) = (along(self.width)?, along(self.speed)?);
        Ok(Pass { kind: self.kind, closed: self.closed, points: self.points, width, pace })
    }
}
