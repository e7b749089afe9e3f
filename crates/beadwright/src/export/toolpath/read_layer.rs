//! A layer of a package becomes a layer of a plan.

use super::read::{Resource, Style, optional};
use super::style::MICROSECONDS;
use super::{BETWEEN, OVERLAP};
use crate::layer::{Layer, Lit};
use crate::model::ImportError;
use crate::model::package::{Package, broken};
use crate::model::xml::{Element, Step};
use crate::pass::{Along, Pass, PassKind};
use crate::plan_file::{check_layer, check_pass};
use glam::{DVec2, DVec3};
use planar::{Polygon, Ring};
use std::collections::BTreeMap;

/// A point with the values of the line that ends there.
struct Vertex {
    at: DVec3,
    tag: u32,
    /// mm
    width: f64,
    /// mm/s
    pace: f64,
}

/// A segment that is being read.
struct Open<'a> {
    style: &'a Style,
    shape: String,
    closed: bool,
    /// Wait before it, s, as Beadwright wrote it.
    wait: f64,
    vertices: Vec<Vertex>,
}

/// Reads the file of the layer with an index; `slab` has its bottom and top (mm), where the model file gives them.
pub(super) fn read(
    package: &mut Package<'_>,
    path: &str,
    resource: &Resource,
    index: usize,
    slab: Option<[f64; 2]>,
) -> Result<Layer, ImportError> {
    let mut reader = Reader { resource, top: slab.map(|slab| slab[1]), ..Reader::new(resource) };
    let mut elements = package.elements(path)?;
    while let Some(step) = elements.step()? {
        let done = match step {
            Step::Begin(element) => reader.begin(&element),
            Step::End(name) if name == "segment" => reader.end(),
            _ => Ok(()),
        };
        done.map_err(|error| at(error, index, reader.segments))?;
    }
    let layer = reader.layer(index, slab);
    check_layer(layer.z, layer.height, &layer.islands).map_err(|why| broken(format!("layer {}: {why}", index + 1)))?;
    Ok(layer)
}

/// An error with the place where it is.
fn at(error: ImportError, index: usize, segment: usize) -> ImportError {
    match error {
        ImportError::Broken { reason, .. } => broken(format!("layer {}, segment {segment}: {reason}", index + 1)),
        other => other,
    }
}

struct Reader<'a> {
    resource: &'a Resource,
    /// Profiles by their numbers in this layer.
    styles: BTreeMap<u32, &'a Style>,
    parts: Vec<u32>,
    /// Height of planar passes, mm.
    top: Option<f64>,
    /// Top and thickness as Beadwright wrote them, mm.
    own: Option<[f64; 2]>,
    /// Whether its arc continues in the next layer.
    goes_on: bool,
    islands: Vec<Polygon>,
    segments: usize,
    open: Option<Open<'a>>,
    passes: Vec<Pass>,
    /// The thickness of beads, as a profile gives it, mm.
    height: Option<f64>,
}

impl<'a> Reader<'a> {
    fn new(resource: &'a Resource) -> Self {
        Self {
            resource,
            styles: BTreeMap::new(),
            parts: Vec::new(),
            top: None,
            own: None,
            goes_on: false,
            islands: Vec::new(),
            segments: 0,
            open: None,
            passes: Vec::new(),
            height: None,
        }
    }

    fn begin(&mut self, element: &Element) -> Result<(), ImportError> {
        let ours = self.resource.plan.is_some();
        match element.name() {
            "part" => self.parts.push(element.number("id").map_err(broken)?),
            "profile" => {
                let uuid = element.attribute("uuid").unwrap_or_default().to_ascii_lowercase();
                let style = self.resource.styles.get(&uuid);
                let style = style.ok_or_else(|| broken(format!("the profile {uuid} is not in the model")))?;
                self.styles.insert(element.number("id").map_err(broken)?, style);
            }
            "layer" if ours && element.attribute("z").is_some() => {
                let number = |key: &str| element.number::<f64>(key).map_err(broken);
                self.own = Some([number("z")?, number("height")?].map(|units| units * self.resource.unit));
                self.goes_on = element.attribute("goes_on").is_some();
            }
            "outline" if ours => {
                self.islands.push(Polygon { outer: self.ring(element)?, holes: Vec::new() });
            }
            "hole" if ours => {
                let ring = self.ring(element)?;
                self.islands.last_mut().into_iter().for_each(|island| island.holes.push(ring.clone()));
            }
            "segment" => self.segment(element)?,
            "point" | "point3d" | "point6d" => self.point(element)?,
            "hatch" => self.hatch(element)?,
            _ => {}
        }
        Ok(())
    }

    fn ring(&self, element: &Element) -> Result<Ring, ImportError> {
        let text = element.attribute("points").unwrap_or_default();
        let numbers: Result<Vec<f64>, _> = text.split_whitespace().map(str::parse::<f64>).collect();
        let numbers = numbers.map_err(|_| broken("an outline holds something that is not a number"))?;
        let points = numbers.as_chunks::<2>().0.iter().map(|&[x, y]| DVec2::new(x, y) * self.resource.unit);
        Ok(Ring::new(points.collect()))
    }

    fn segment(&mut self, element: &Element) -> Result<(), ImportError> {
        self.segments += 1;
        let shape = element.attribute("type").unwrap_or_default();
        if !["polyline", "loop", "hatch", "polyline3d", "polyline6d"].contains(&shape.as_str()) {
            return Err(broken(format!("segments of the type \"{shape}\" are unknown")));
        }
        let (profile, part): (u32, u32) =
            (element.number("profileid").map_err(broken)?, element.number("partid").map_err(broken)?);
        let style = self.styles.get(&profile).copied();
        let style = style.ok_or_else(|| broken(format!("its profile {profile} is not among those of the layer")))?;
        if !self.parts.contains(&part) {
            return Err(broken(format!("its part {part} is not among those of the layer")));
        }
        self.height = self.height.or(style.height);
        let closed = shape == "loop" || element.attribute("closed").is_some_and(|closed| closed == "1");
        let wait = optional(element, "wait")?.map_or(0.0, |wait: f64| wait / MICROSECONDS);
        self.open = Some(Open { style, shape, closed, wait, vertices: Vec::new() });
        Ok(())
    }

    fn point(&mut self, element: &Element) -> Result<(), ImportError> {
        let (unit, top) = (self.resource.unit, self.top);
        let Some(open) = &mut self.open else { return Ok(()) };
        let number = |key: &str| element.number::<f64>(key).map_err(broken);
        let z = match element.name() {
            "point" => top.ok_or_else(|| broken("the layer gives no height (ztop) for its flat segments"))?,
            _ => number("z")? * unit,
        };
        if element.name() == "point6d" {
            // Beadwright takes the torch's lean from the profile, but what cannot be an orientation is refused all the
            // same.
            let q = [number("i")?, number("j")?, number("k")?, number("w")?];
            if q.iter().map(|v| v * v).sum::<f64>() < 1e-12 {
                return Err(broken("a point has an orientation (i, j, k, w) of 0, which is not valid"));
            }
        }
        let at = DVec3::new(number("x")? * unit, number("y")? * unit, z);
        let tag = optional(element, "tag")?.unwrap_or(0.0) as u32;
        let (width, pace) = open.style.values(element)?;
        open.vertices.push(Vertex { at, tag, width, pace });
        Ok(())
    }

    /// A line that is a pass of its own.
    fn hatch(&mut self, element: &Element) -> Result<(), ImportError> {
        let unit = self.resource.unit;
        let Some(open) = &self.open else { return Ok(()) };
        let top = self.top.ok_or_else(|| broken("the layer gives no height (ztop) for its flat segments"))?;
        let number = |key: &str| element.number::<f64>(key).map(|units| units * unit).map_err(broken);
        let points = vec![DVec3::new(number("x1")?, number("y1")?, top), DVec3::new(number("x2")?, number("y2")?, top)];
        let (width, pace) = open.style.values(element)?;
        let kind = open.style.kind.unwrap_or(PassKind::Infill);
        let pass = Pass { kind, closed: false, points, width: Along::Same(width), pace: Along::Same(pace), wait: 0.0 };
        self.add(pass)
    }

    fn end(&mut self) -> Result<(), ImportError> {
        let Some(open) = self.open.take().filter(|open| open.shape != "hatch") else { return Ok(()) };
        let ours = self.resource.plan.is_some();
        self.add(open.pass(ours))
    }

    fn add(&mut self, pass: Pass) -> Result<(), ImportError> {
        check_pass(&pass).map_err(broken)?;
        self.passes.push(pass);
        Ok(())
    }

    fn layer(self, index: usize, slab: Option<[f64; 2]>) -> Layer {
        let highest = self.passes.iter().flat_map(|pass| &pass.points).map(|p| p.z).fold(0.0, f64::max);
        let of_slab = slab.map(|[bottom, top]| [top, top - bottom]);
        let [z, height] = self.own.or(of_slab).unwrap_or([highest, self.height.unwrap_or(0.0)]);
        let slice_area = self.islands.iter().map(Polygon::area).sum();
        let lit = Lit { before: false, after: self.goes_on };
        Layer { index, z, height, islands: self.islands, passes: self.passes, lit, slice_area, ..Layer::default() }
    }
}

impl Style {
    /// Width (mm) and pace (mm/s) of the line that ends at an element's point.
    fn values(&self, element: &Element) -> Result<(f64, f64), ImportError> {
        let width = self.width.ok_or_else(|| broken("its profile gives no beadwidth: it is not for deposition"))?;
        let pace = self.pace.or(self.speed);
        let pace = pace.ok_or_else(|| broken("its profile gives no depositionspeed: it is not for deposition"))?;
        Ok((width.on(element)?, pace.on(element)?))
    }
}

impl Open<'_> {
    /// The pass of a chain of lines; in our own files, what only welding added (such as overlap) is removed again.
    fn pass(self, ours: bool) -> Pass {
        let Self { style, closed, shape, wait, mut vertices } = self;
        if ours {
            vertices.retain(|vertex| ![OVERLAP, BETWEEN].contains(&vertex.tag));
        }
        // The values of a line are given at its end; those of the closing line of a loop at the first point.
        let is_loop = shape == "loop";
        let returns = vertices.len() > 2 && vertices.first().zip(vertices.last()).is_some_and(|(a, b)| a.at == b.at);
        let last = vertices.pop_if(|_| closed && returns);
        let closing = last.as_ref().or(vertices.first().filter(|_| is_loop)).or(vertices.last());
        let closing = closing.map(|vertex| (vertex.width, vertex.pace));
        let values: Vec<(f64, f64)> = vertices.iter().skip(1).map(|v| (v.width, v.pace)).chain(closing).collect();
        let along = |value: fn(&(f64, f64)) -> f64| same_or_each(values.iter().map(value).collect());
        let (width, pace) = (along(|v| v.0), along(|v| v.1));
        let kind = style.kind.unwrap_or(if closed { PassKind::Contour } else { PassKind::Infill });
        Pass { kind, closed, points: vertices.iter().map(|v| v.at).collect(), width, pace, wait }
    }
}

fn same_or_each(values: Vec<f64>) -> Along {
    match values.first() {
        Some(&first) if values.iter().all(|&value| value == first) => Along::Same(first),
        _ => Along::Each(values),
    }
}
