//! AMF: the meshes of all objects, placed by constellations.

use super::formats::Format;
use super::placed::{Id, Resource, Resources, Shape};
use super::xml::{Element, Elements, Step};
use super::{Import, ImportError};
use crate::task::Task;
use glam::{DAffine3, DMat3, DVec3};
use std::collections::BTreeSet;
use std::io::BufRead;

pub(super) const FORMAT: Format = Format { is: looks_amf, read: |bytes, task| read(bytes, task) };

fn looks_amf(bytes: &[u8]) -> bool {
    let head = &bytes[..bytes.len().min(1000)];
    head.trim_ascii_start().starts_with(b"<") && head.windows(4).any(|w| w == b"<amf")
}

fn broken(reason: impl Into<String>) -> ImportError {
    ImportError::Broken { format: "AMF", reason: reason.into() }
}

/// Reads the text of an AMF file.
fn read(text: impl BufRead, task: &Task) -> Result<Import, ImportError> {
    let mut elements = Elements::new(text, "AMF");
    let mut file = File::new();
    let (mut value, mut steps) = (String::new(), 0_u64);
    while let Some(step) = elements.step()? {
        steps += 1;
        if steps.is_multiple_of(65_536) {
            task.check()?;
        }
        match step {
            Step::Begin(element) => {
                value.clear();
                file.begin(&element)?;
            }
            Step::Text(text) => value.push_str(&text),
            Step::End(name) => file.end(&name, value.trim())?,
        }
    }
    file.finish().build(task)
}

/// What has been read.
struct File {
    resources: Resources,
    /// The object or constellation that is open.
    open: Option<(u32, Resource)>,
    /// Its current vertex, triangle or instance.
    at: DVec3,
    corners: [u32; 3],
    instance: Instance,
    /// Objects that constellations place.
    placed: BTreeSet<u32>,
}

/// An object placed by a constellation: turned about x, then y, then z (degrees), then moved.
#[derive(Default)]
struct Instance {
    object: u32,
    moved: DVec3,
    turned: DVec3,
}

impl Instance {
    fn transform(&self) -> DAffine3 {
        let [x, y, z] = self.turned.to_array().map(f64::to_radians);
        let turn = DMat3::from_rotation_z(z) * DMat3::from_rotation_y(y) * DMat3::from_rotation_x(x);
        DAffine3 { matrix3: turn, translation: self.moved }
    }
}

/// The key of an object; a file names only its own objects.
fn id(number: u32) -> Id {
    (String::new(), number)
}

impl File {
    fn new() -> Self {
        let (resources, placed) = (Resources::of("AMF"), BTreeSet::new());
        Self { resources, open: None, at: DVec3::NAN, corners: [u32::MAX; 3], instance: Instance::default(), placed }
    }

    fn begin(&mut self, element: &Element) -> Result<(), ImportError> {
        let open = |name: &str, shape: Shape| -> Result<(u32, Resource), ImportError> {
            let number = element.number("id").map_err(broken)?;
            Ok((number, Resource { name: format!("{name} {number}"), solid: true, shape }))
        };
        match element.name() {
            "amf" => self.resources.unit = in_mm(&element.attribute("unit").unwrap_or_default())?,
            "object" => {
                self.open = Some(open("object", Shape::Mesh { vertices: Vec::new(), triangles: Vec::new() })?);
            }
            "constellation" => self.open = Some(open("constellation", Shape::Components(Vec::new()))?),
            "coordinates" => self.at = DVec3::NAN,
            "triangle" => self.corners = [u32::MAX; 3],
            "instance" => {
                let object = element.number("objectid").map_err(broken)?;
                self.instance = Instance { object, ..Instance::default() };
            }
            _ => {}
        }
        Ok(())
    }

    fn end(&mut self, name: &str, value: &str) -> Result<(), ImportError> {
        let number = || value.parse::<f64>().map_err(|_| broken(format!("\"{value}\" in <{name}> is not a number")));
        let index = || value.parse::<u32>().map_err(|_| broken(format!("\"{value}\" in <{name}> is not a number")));
        match (name, self.open.as_mut().map(|(_, resource)| &mut resource.shape)) {
            ("x", _) => self.at.x = number()?,
            ("y", _) => self.at.y = number()?,
            ("z", _) => self.at.z = number()?,
            ("v1", _) => self.corners[0] = index()?,
            ("v2", _) => self.corners[1] = index()?,
            ("v3", _) => self.corners[2] = index()?,
            ("deltax", _) => self.instance.moved.x = number()?,
            ("deltay", _) => self.instance.moved.y = number()?,
            ("deltaz", _) => self.instance.moved.z = number()?,
            ("rx", _) => self.instance.turned.x = number()?,
            ("ry", _) => self.instance.turned.y = number()?,
            ("rz", _) => self.instance.turned.z = number()?,
            ("coordinates", Some(Shape::Mesh { vertices, .. })) => vertices.push(self.at),
            ("triangle", Some(Shape::Mesh { triangles, .. })) => {
                triangles.push(self.corners);
                self.resources.count_triangle()?;
            }
            ("instance", Some(Shape::Components(parts))) => {
                self.placed.insert(self.instance.object);
                parts.push((id(self.instance.object), self.instance.transform()));
            }
            ("object" | "constellation", Some(_)) => {
                if let Some((number, resource)) = self.open.take() {
                    self.resources.objects.insert(id(number), resource);
                }
            }
            _ => {}
        }
        Ok(())
    }

    /// Objects that no constellation places stay where they are.
    fn finish(mut self) -> Resources {
        let free = self.resources.objects.keys().filter(|(_, number)| !self.placed.contains(number));
        self.resources.items = free.map(|id| (id.clone(), DAffine3::IDENTITY)).collect();
        self.resources
    }
}

/// Millimetres per unit of AMF.
fn in_mm(unit: &str) -> Result<f64, ImportError> {
    Ok(match unit {
        "" | "millimeter" => 1.0,
        "micron" => 1e-3,
        "meter" => 1000.0,
        "inch" => 25.4,
        "feet" => 304.8,
        other => return Err(broken(format!("its unit \"{other}\" is not an AMF unit"))),
    })
}
