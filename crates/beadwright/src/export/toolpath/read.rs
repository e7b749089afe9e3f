//! A package with toolpaths becomes a plan.
//!
//! Beadwright's own files are read back completely. From other files, each pass takes the width of its profile, and the
//! speed as its pace; waits come from the Beadwright profile that the plan is judged with. What cannot be followed
//! exactly (a value that changes within a line, an unknown segment) is refused, as the extension demands.

use super::read_layer;
use crate::layer::{Extent, Layer, Lit};
use crate::model::ImportError;
use crate::model::package::{self, OLD_TOOLPATH, PRODUCTION, Package, TOOLPATH, broken, entry_name};
use crate::model::xml::{Element, Step};
use crate::pass::PassKind;
use crate::plan::{self, Header};
use crate::plan_file::PlanFile;
use crate::profile::Profile;
use glam::DVec3;
use std::collections::BTreeMap;

/// Extensions that a file may require.
const KNOWN: [&str; 4] =
    ["http://schemas.microsoft.com/3dmanufacturing/core/2015/02", PRODUCTION, TOOLPATH, OLD_TOOLPATH];

/// A value of a profile, and how the factors of a line change it.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Value {
    /// The value without a factor.
    base: f64,
    /// The letter of the factor, with the values that it has at 0 and at 1.
    modifier: Option<(char, f64, f64)>,
}

/// A profile of the extension.
#[derive(Debug, Clone, Default)]
pub(super) struct Style {
    pub(super) kind: Option<PassKind>,
    /// mm
    pub(super) width: Option<Value>,
    /// mm/s
    pub(super) speed: Option<Value>,
    /// mm/s
    pub(super) pace: Option<Value>,
    /// mm
    pub(super) height: Option<f64>,
}

/// A toolpath of the model file.
#[derive(Debug, Default)]
pub(super) struct Resource {
    id: u32,
    /// Millimetres per unit.
    pub(super) unit: f64,
    pub(super) styles: BTreeMap<String, Style>,
    /// Path and top (units) of each layer.
    layers: Vec<(String, Option<f64>)>,
    /// Bottom of the first layer, units.
    bottom: f64,
    /// Part, strategy, profile and bounds, if Beadwright wrote the file.
    pub(super) plan: Option<[String; 4]>,
}

/// Whether the bytes are those of a 3MF file with toolpaths.
pub fn is_toolpath(bytes: &[u8]) -> bool {
    let required = || -> Result<Vec<String>, ImportError> {
        let mut package = Package::open(bytes)?;
        let main = package.main()?;
        let mut elements = package.elements(&main)?;
        while let Some(step) = elements.step()? {
            if let Step::Begin(element) = step {
                return Ok(package::required_extensions(&element));
            }
        }
        Ok(Vec::new())
    };
    package::is_package(bytes)
        && required().is_ok_and(|spaces| spaces.iter().any(|space| [TOOLPATH, OLD_TOOLPATH].contains(&space.as_str())))
}

/// Reads a 3MF file with toolpaths as a plan.
///
/// # Errors
/// [`ImportError`] with the layer and segment, and what is wrong there.
pub fn read(bytes: &[u8]) -> Result<PlanFile, ImportError> {
    let mut package = Package::open(bytes)?;
    let main = package.main()?;
    let resource = model(&mut package, &main)?;
    let (mut layers, mut below) = (Vec::with_capacity(resource.layers.len()), resource.bottom);
    for (index, (path, top)) in resource.layers.iter().enumerate() {
        let slab = top.map(|top| [below, top].map(|z| z * resource.unit));
        layers.push(read_layer::read(&mut package, path, &resource, index, slab)?);
        below = top.unwrap_or(below);
    }
    if layers.is_empty() {
        return Err(broken("its toolpath has no layers"));
    }
    Lit::join(&mut layers).map_err(|index| {
        broken(format!("layer {}: the arc continues from layer to layer there, so it must have one segment", index + 1))
    })?;
    let [part, strategy, profile, bounds] = resource.plan.unwrap_or_default();
    let profile = if profile.is_empty() { None } else { Some(profile_of(&profile)?) };
    let name = profile.as_ref().map_or_else(String::new, |profile| profile.name.clone());
    let header = Header { part, profile: name, strategy, extent: extent(&bounds, &layers) };
    Ok(PlanFile { header, settings: profile.as_ref().map(plan::deposit_settings), profile, layers })
}

/// Where the part lies: as the file says (six numbers, mm), or else where its passes lie.
fn extent(bounds: &str, layers: &[Layer]) -> Extent {
    let numbers: Vec<f64> = bounds.split_whitespace().filter_map(|text| text.parse().ok()).collect();
    match (&numbers[..], layers.len()) {
        (&[a, b, c, d, e, f], layers) => Extent { layers, low: DVec3::new(a, b, c), high: DVec3::new(d, e, f) },
        _ => Extent::of(layers),
    }
}

fn profile_of(json: &str) -> Result<Profile, ImportError> {
    let value = serde_json::from_str(json).map_err(|error| broken(format!("the profile in it: {error}")))?;
    Profile::from_json(&value).map_err(|error| broken(format!("the profile in it: {error}")))
}

/// The toolpath that the build names, or the only one.
fn model(package: &mut Package<'_>, path: &str) -> Result<Resource, ImportError> {
    let mut elements = package.elements(path)?;
    let (mut resources, mut wanted, mut unit): (Vec<Resource>, Option<u32>, f64) = (Vec::new(), None, 1.0);
    let mut style = String::new();
    while let Some(step) = elements.step()? {
        let Step::Begin(element) = step else { continue };
        match (element.name(), resources.last_mut()) {
            ("model", _) => {
                package::check_extensions(&element, &KNOWN)?;
                unit = package::unit_in_mm(&element)?;
            }
            ("build", _) if element.attribute("toolpathid").is_some() => {
                wanted = Some(element.number("toolpathid").map_err(broken)?);
            }
            ("toolpathresource", _) => {
                let number = |key: &str| element.number::<f64>(key).map_err(broken);
                let (id, unit) = (element.number("id").map_err(broken)?, unit * number("unitfactor")?);
                resources.push(Resource { id, unit, ..Resource::default() });
            }
            ("toolpathprofile", Some(resource)) => {
                style = element.attribute("uuid").unwrap_or_default().to_ascii_lowercase();
                resource.styles.insert(style.clone(), Style::of(&element)?);
            }
            ("modifier", Some(resource)) => {
                resource.styles.get_mut(&style).map_or(Ok(()), |style| style.modify(&element))?;
            }
            ("toolpathlayers", Some(resource)) => resource.bottom = optional(&element, "zbottom")?.unwrap_or(0.0),
            ("toolpathlayer", Some(resource)) => {
                let path = element.attribute("path").ok_or_else(|| broken("a layer without a path"))?;
                resource.layers.push((entry_name(&path), optional(&element, "ztop")?));
            }
            ("plan", Some(resource)) => {
                let text = |key| element.attribute(key).unwrap_or_default();
                resource.plan = Some(["part", "strategy", "profile", "bounds"].map(text));
            }
            _ => {}
        }
    }
    let count = resources.len();
    let found = resources.into_iter().find(|resource| wanted.is_none_or(|id| id == resource.id));
    found.filter(|_| wanted.is_some() || count == 1).ok_or_else(|| {
        broken(match (wanted, count) {
            (Some(id), _) => format!("its build names toolpath {id}, which does not exist"),
            (None, 0) => "it holds no toolpath".to_owned(),
            (None, count) => format!("it holds {count} toolpaths, and its build does not say which one is meant"),
        })
    })
}

/// A number that may be missing.
pub(super) fn optional(element: &Element, key: &str) -> Result<Option<f64>, ImportError> {
    element.attribute(key).map(|_| element.number(key).map_err(broken)).transpose()
}

impl Style {
    fn of(element: &Element) -> Result<Self, ImportError> {
        let value = |key: &str| optional(element, key).map(|base| base.map(|base| Value { base, modifier: None }));
        let kind = element.attribute("kind").map(|name| {
            let quoted = serde_json::Value::String(name.clone());
            serde_json::from_value(quoted).map_err(|_| broken(format!("there is no kind of pass \"{name}\"")))
        });
        Ok(Self {
            kind: kind.transpose()?,
            width: value("beadwidth")?,
            speed: value("depositionspeed")?,
            pace: value("pace")?,
            height: optional(element, "beadheight")?,
        })
    }

    fn modify(&mut self, element: &Element) -> Result<(), ImportError> {
        let text = |key: &str| element.attribute(key).unwrap_or_default();
        let attribute = text("attribute");
        if text("type") != "constant" {
            return Err(broken(format!(
                "{attribute} changes within lines (a modifier of type \"{}\"), which is not read; only values that are \
                 the same along a line are",
                text("type")
            )));
        }
        let value = match attribute.as_str() {
            "beadwidth" => &mut self.width,
            "depositionspeed" => &mut self.speed,
            // The prefix is the writer's choice.
            own if own.ends_with(":pace") => &mut self.pace,
            own if own.ends_with(":wirefeed") => return Ok(()),
            other => return Err(broken(format!("{other} changes along segments, which is not read"))),
        };
        let number = |key: &str| element.number::<f64>(key).map_err(broken);
        let factor = text("factor").chars().next().ok_or_else(|| broken("a modifier without a factor"))?;
        let modifier = Some((factor, number("minvalue")?, number("maxvalue")?));
        value
            .as_mut()
            .ok_or_else(|| broken(format!("a modifier changes {attribute}, which the profile lacks")))?
            .modifier = modifier;
        Ok(())
    }
}

impl Value {
    /// The value on the line that ends at a point.
    pub(super) fn on(&self, point: &Element) -> Result<f64, ImportError> {
        let Some((letter, low, high)) = self.modifier else { return Ok(self.base) };
        let factor = optional(point, letter.encode_utf8(&mut [0; 4]))?;
        Ok(factor.map_or(self.base, |factor| low + factor * (high - low)))
    }
}
