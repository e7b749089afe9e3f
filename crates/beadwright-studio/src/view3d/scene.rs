//! What can be shown: a model, and the layers planned so far.

use super::beads::{LayerBeads, fresh_id};
use super::bent::{self, Bent};
use super::lie::Stance;
use super::scanned::Scanned;
use super::style::{Colour, Style};
use beadwright::model::Mesh;
use glam::{DVec2, DVec3};
use std::sync::Arc;

/// Values for the segments of a layer.
#[derive(Debug, Clone)]
pub(super) struct Values {
    pub id: u64,
    pub of: Arc<[f32]>,
}

/// The layers as they are drawn where plate and part are bent.
#[derive(Debug)]
struct Bend {
    shape: Arc<Bent>,
    /// How often the movement is drawn as large as computed.
    times: f64,
    layers: Vec<Option<Arc<LayerBeads>>>,
    /// How far their segments move, mm.
    far: Vec<Option<Values>>,
}

/// A model, and its layers as they come in.
#[derive(Debug, Default)]
pub struct Scene {
    mesh: Option<Arc<Mesh>>,
    layers: Vec<Option<Arc<LayerBeads>>>,
    values: Vec<Option<Values>>,
    /// By pass, if the plan itself has none.
    temperatures: Vec<Option<Values>>,
    /// By segment.
    leans: Vec<Option<Values>>,
    scan: Option<Scanned>,
    /// The part in the colours of its bodies.
    pieces: Option<Arc<Scanned>>,
    bend: Option<Bend>,
    version: u64,
    mesh_version: u64,
    scan_version: u64,
    pieces_version: u64,
}

/// Sides of the prism of [`Scene::outline`].
const SIDES: usize = 16;

fn side_normal(side: usize) -> DVec2 {
    DVec2::from_angle(side as f64 * std::f64::consts::TAU / SIDES as f64)
}

/// Where the torch is at a given time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Position {
    /// The layer, from 0.
    pub layer: usize,
    /// The pass in its layer, from 0.
    pub pass: usize,
    /// The segment being laid or to be laid next, which is also the number of segments of the layer already laid.
    pub segment: usize,
    /// The torch.
    pub torch: Stance,
    /// Whether the arc is on.
    pub arc: bool,
    /// Fraction of the travel to the pass that is done, 0 to 1; `None` once the torch is there.
    pub come: Option<f64>,
}

impl Scene {
    /// Forgets model and layers.
    pub fn clear(&mut self) {
        let [version, mesh_version, scan_version, pieces_version] = std::array::from_fn(|_| fresh_id());
        *self = Self { version, mesh_version, scan_version, pieces_version, ..Self::default() };
    }

    /// Forgets the layers.
    pub fn clear_layers(&mut self) {
        self.layers.clear();
        self.values.clear();
        self.temperatures.clear();
        self.leans.clear();
        self.bend = None;
        self.version = fresh_id();
    }

    /// Forgets the layers from this index on.
    pub fn truncate(&mut self, count: usize) {
        self.layers.truncate(count);
        self.values.truncate(count);
        self.temperatures.truncate(count);
        self.leans.truncate(count);
        self.bend = None;
        self.version = fresh_id();
    }

    /// Sets the model, mm.
    pub fn set_mesh(&mut self, mesh: Option<Arc<Mesh>>) {
        self.mesh = mesh;
        (self.version, self.mesh_version) = (fresh_id(), fresh_id());
    }

    /// Sets the scan, mm.
    pub fn set_scan(&mut self, scan: Option<Scanned>) {
        self.scan = scan;
        (self.version, self.scan_version) = (fresh_id(), fresh_id());
    }

    /// Shows the part in the colours of its bodies, or no longer.
    pub fn show_pieces(&mut self, pieces: Option<Arc<Scanned>>) {
        if self.pieces.as_ref().map(Arc::as_ptr) != pieces.as_ref().map(Arc::as_ptr) {
            self.pieces = pieces;
            (self.version, self.pieces_version) = (fresh_id(), fresh_id());
        }
    }

    /// Bends plate and layers to a shape, its movement multiplied by a factor; without one they are straight again.
    /// A new layer makes all of them straight, too.
    pub fn bend(&mut self, wanted: Option<(&Arc<Bent>, f64)>) {
        let is_so =
            |bend: &Bend| wanted.is_some_and(|(shape, times)| Arc::ptr_eq(&bend.shape, shape) && bend.times == times);
        if self.bend.as_ref().map_or(wanted.is_none(), is_so) {
            return;
        }
        self.bend = wanted.map(|(shape, times)| {
            let values = |layer| shape.far(layer).map(|far| Values { id: fresh_id(), of: far.clone() });
            let layers = shape.layers(times);
            Bend { far: (0..layers.len()).map(values).collect(), shape: shape.clone(), times, layers }
        });
        self.version = fresh_id();
    }

    /// The bent plate.
    pub(super) fn bent_plate(&self) -> Option<bent::Plate<'_>> {
        self.bend.as_ref().map(|bend| bend.shape.plate(bend.times))
    }

    /// Sets the layer with this index; layers may come in any order.
    pub fn set_layer(&mut self, index: usize, beads: Arc<LayerBeads>) {
        let count = self.layers.len().max(index + 1);
        self.layers.resize(count, None);
        self.values.resize(count, None);
        self.temperatures.resize(count, None);
        self.leans.resize(count, None);
        self.layers[index] = Some(beads);
        self.bend = None;
        (self.values[index], self.temperatures[index], self.leans[index]) = (None, None, None);
        self.version = fresh_id();
    }

    /// Sets a value for each piece of an existing layer: the height error, mm; NaN where it is not known.
    pub fn set_values(&mut self, index: usize, values: Arc<[f32]>) {
        if let Some(place) = self.values.get_mut(index) {
            *place = Some(Values { id: fresh_id(), of: values });
            self.version = fresh_id();
        }
    }

    /// Sets the temperature of the metal where each pass of an existing layer begins, °C.
    pub fn set_temperatures(&mut self, index: usize, temperatures: Arc<[f32]>) {
        if let Some(place) = self.temperatures.get_mut(index) {
            *place = Some(Values { id: fresh_id(), of: temperatures });
            self.version = fresh_id();
        }
    }

    /// Sets how far an existing layer leans from level in each of its segments, °; NaN where it is not known.
    pub fn set_leans(&mut self, index: usize, leans: Arc<[f32]>) {
        if let Some(place) = self.leans.get_mut(index) {
            *place = Some(Values { id: fresh_id(), of: leans });
            self.version = fresh_id();
        }
    }

    /// The model.
    pub fn mesh(&self) -> Option<&Arc<Mesh>> {
        self.mesh.as_ref()
    }

    /// The scan.
    pub fn scan(&self) -> Option<&Scanned> {
        self.scan.as_ref()
    }

    /// The part in the colours of its bodies.
    pub fn pieces(&self) -> Option<&Arc<Scanned>> {
        self.pieces.as_ref()
    }

    /// The layers as planned; `None` for those not there yet.
    pub fn layers(&self) -> &[Option<Arc<LayerBeads>>] {
        &self.layers
    }

    /// The layers as they are drawn.
    fn drawn(&self) -> &[Option<Arc<LayerBeads>>] {
        self.bend.as_ref().map_or(&self.layers, |bend| &bend.layers)
    }

    /// The layer with this index, as planned.
    pub fn layer(&self, index: usize) -> Option<&Arc<LayerBeads>> {
        self.layers.get(index)?.as_ref()
    }

    /// The layer with this index, as it is drawn: bent, and then in more segments.
    pub fn drawn_layer(&self, index: usize) -> Option<&Arc<LayerBeads>> {
        self.drawn().get(index)?.as_ref()
    }

    /// How many drawn segments of a layer stand for the given number of segments of the plan.
    pub fn drawn_segments(&self, index: usize, planned: usize) -> usize {
        let both = self.layer(index).zip(self.drawn_layer(index)).filter(|_| self.bend.is_some());
        both.map_or(planned, |(layer, drawn)| drawn.segments_of(layer.piece(planned)).start)
    }

    /// The layers that have come, with their indices, as planned.
    fn present(&self) -> impl DoubleEndedIterator<Item = (usize, &Arc<LayerBeads>)> {
        present(&self.layers)
    }

    /// The same as they are drawn.
    pub(super) fn drawn_present(&self) -> impl DoubleEndedIterator<Item = (usize, &Arc<LayerBeads>)> {
        present(self.drawn())
    }

    pub(super) fn values(&self, index: usize) -> Option<&Values> {
        self.values.get(index)?.as_ref()
    }

    pub(super) fn temperatures(&self, index: usize) -> Option<&Values> {
        self.temperatures.get(index)?.as_ref()
    }

    pub(super) fn leans(&self, index: usize) -> Option<&Values> {
        self.leans.get(index)?.as_ref()
    }

    /// How far the segments of a bent layer move, mm.
    pub(super) fn movements(&self, index: usize) -> Option<&Values> {
        self.bend.as_ref()?.far.get(index)?.as_ref()
    }

    pub(super) fn version(&self) -> u64 {
        self.version
    }

    pub(super) fn mesh_version(&self) -> u64 {
        self.mesh_version
    }

    pub(super) fn scan_version(&self) -> u64 {
        self.scan_version
    }

    pub(super) fn pieces_version(&self) -> u64 {
        self.pieces_version
    }

    /// Lowest and highest corner of model and beads, mm.
    pub fn bounds(&self) -> Option<(DVec3, DVec3)> {
        let mesh = self.mesh.as_ref().filter(|mesh| !mesh.vertices.is_empty()).map(|mesh| mesh.bounds());
        let beads = self.drawn_present().filter_map(|(_, layer)| layer.bounds());
        let beads = beads.map(|(low, high)| (low.as_dvec3(), high.as_dvec3()));
        mesh.into_iter().chain(beads).reduce(|(a, b), (c, d)| (a.min(c), b.max(d)))
    }

    /// Corners of an upright 16-sided prism around model and beads, mm: the camera must get them into the picture.
    pub fn outline(&self) -> Vec<DVec3> {
        let Some((low, high)) = self.bounds() else { return Vec::new() };
        let mut reach = [f64::NEG_INFINITY; SIDES];
        let mut add = |point: DVec3, radius: f64| {
            for (side, reach) in reach.iter_mut().enumerate() {
                *reach = reach.max(point.truncate().dot(side_normal(side)) + radius);
            }
        };
        self.mesh.iter().flat_map(|mesh| &mesh.vertices).for_each(|&vertex| add(vertex, 0.0));
        for bead in self.drawn_present().flat_map(|(_, layer)| layer.beads()) {
            let radius = f64::from(bead.width().max(bead.height())) / 2.0;
            bead.middle_line().into_iter().for_each(|end| add(end.as_dvec3(), radius));
        }
        let corner = |side: usize| {
            let (a, b) = (side_normal(side), side_normal((side + 1) % SIDES));
            let (p, q) = (reach[side], reach[(side + 1) % SIDES]);
            DVec2::new(p * b.y - q * a.y, a.x * q - b.x * p) / a.perp_dot(b)
        };
        (0..SIDES).flat_map(|side| [corner(side).extend(low.z), corner(side).extend(high.z)]).collect()
    }

    /// Temperature of the metal where a pass begins, °C, where it is known.
    pub fn temperature(&self, layer: usize, pass: usize) -> Option<f32> {
        let planned = self.layer(layer)?.passes().get(pass)?.temperature;
        planned.or_else(|| self.temperatures(layer)?.of.get(pass).copied())
    }

    /// The highest layer that a style shows.
    pub(super) fn top(&self, style: &Style) -> Option<usize> {
        self.drawn_present().map(|(i, _)| i).rfind(|i| style.layers.contains(i))
    }

    /// Number of layers that a style shows, and of their rough segments.
    pub(super) fn rough(&self, style: &Style) -> (usize, usize) {
        let shown = self.drawn_present().filter(|(i, _)| style.layers.contains(i));
        shown.fold((0, 0), |(layers, rough), (_, layer)| (layers + 1, rough + layer.rough.len()))
    }

    /// Memory that the layers take, bytes.
    pub fn bytes(&self) -> usize {
        self.drawn_present().map(|(_, layer)| layer.bytes()).sum()
    }

    /// Number of segments that are drawn.
    pub(super) fn segments_drawn(&self) -> usize {
        self.drawn_present().map(|(_, layer)| layer.len()).sum()
    }

    /// Number of segments.
    pub fn segments(&self) -> usize {
        self.present().map(|(_, layer)| layer.len()).sum()
    }

    /// Time of all layers, s.
    pub fn total_seconds(&self) -> f64 {
        self.present().map(|(_, layer)| layer.seconds()).sum()
    }

    /// When a layer begins, s.
    pub fn seconds_before(&self, layer: usize) -> f64 {
        self.present().take_while(|(i, _)| *i < layer).map(|(_, beads)| beads.seconds()).sum()
    }

    /// Where the torch is after this many seconds; beyond the total time, at the end of the last layer.
    pub fn at_time(&self, seconds: f64) -> Option<Position> {
        let mut left = seconds.max(0.0);
        let last = self.present().rfind(|(_, layer)| !layer.is_empty())?.0;
        for (index, layer) in self.present() {
            if left < layer.seconds() || index == last {
                return position(index, layer, left.min(layer.seconds()));
            }
            left -= layer.seconds();
        }
        None
    }

    /// The range of all layers together, from the range of each.
    fn range(&self, of: fn(&LayerBeads) -> (f32, f32)) -> Option<(f64, f64)> {
        let ranges = self.present().filter(|(_, layer)| !layer.is_empty()).map(|(_, layer)| of(layer));
        let range = ranges.reduce(|(a, b), (c, d)| (a.min(c), b.max(d)));
        range.map(|(low, high)| (f64::from(low), f64::from(high)))
    }

    /// The values at the two ends of a colour map; `None` for kinds, and where there is nothing to show.
    pub fn value_range(&self, colour: Colour) -> Option<(f64, f64)> {
        match colour {
            Colour::Kind | Colour::Body => None,
            Colour::Order => Some((0.0, self.segments() as f64)),
            Colour::Time => Some((0.0, self.total_seconds())),
            Colour::Speed => self.range(LayerBeads::speed_range),
            Colour::Width => self.range(LayerBeads::width_range),
            Colour::Temperature => {
                let of_layer =
                    |(i, layer): (usize, &Arc<LayerBeads>)| (0..layer.passes().len()).map(move |pass| (i, pass));
                let all = self.present().flat_map(of_layer).filter_map(|(layer, pass)| self.temperature(layer, pass));
                let range = all.map(f64::from).map(|t| (t, t)).reduce(|(a, b), (c, d)| (a.min(c), b.max(d)));
                range.map(|(low, high)| (low, high.max(low + 1.0)))
            }
            Colour::Movement => Some((0.0, self.bend.as_ref()?.shape.most())),
            Colour::OffLevel => {
                let leans = self.leans.iter().flatten().flat_map(|leans| leans.of.iter().copied());
                let most = leans.filter(|lean| lean.is_finite()).reduce(f32::max)?;
                Some((0.0, f64::from(most.max(1.0))))
            }
            Colour::HeightError => {
                let values = self.values.iter().flatten().flat_map(|values| values.of.iter());
                let most = values.filter(|v| v.is_finite()).fold(0.0_f32, |most, v| most.max(v.abs()));
                (most > 0.0).then_some((f64::from(-most), f64::from(most)))
            }
        }
    }
}

/// The layers that have come, with their indices.
fn present(layers: &[Option<Arc<LayerBeads>>]) -> impl DoubleEndedIterator<Item = (usize, &Arc<LayerBeads>)> {
    layers.iter().enumerate().filter_map(|(i, layer)| Some((i, layer.as_ref()?)))
}

fn position(index: usize, layer: &LayerBeads, seconds: f64) -> Option<Position> {
    let number = layer.passes().partition_point(|p| p.end <= seconds).min(layer.passes().len().checked_sub(1)?);
    let pass = layer.passes().get(number)?;
    let at = |segment: usize, torch: Stance, arc: bool| {
        Some(Position { layer: index, pass: number, segment, torch, arc, come: None })
    };
    if seconds < pass.arrival && !pass.travel.is_empty() {
        let part = (seconds - pass.travel_start) / (pass.arrival - pass.travel_start);
        let on_way = at(pass.segments.start, along(&pass.travel, part)?, false);
        return on_way.map(|position| Position { come: Some(part), ..position });
    }
    let ends = &layer.ends[pass.segments.clone()];
    let segment = pass.segments.start + ends.partition_point(|&end| f64::from(end) <= seconds);
    if segment >= pass.segments.end {
        // The whole pass is laid; the torch waits for crater filling and gas.
        let last = layer.beads().get(pass.segments.end.checked_sub(1)?)?;
        return at(pass.segments.end, last.torch(1.0), false);
    }
    let ((begin, end), bead) = (layer.times(segment)?, layer.beads().get(segment)?);
    let part = if end > begin { ((seconds - begin) / (end - begin)).clamp(0.0, 1.0) } else { 1.0 };
    at(segment, bead.torch(part), seconds >= pass.arc_start)
}

/// The torch at a fraction (0 to 1) of the length of a polyline.
fn along(points: &[Stance], part: f64) -> Option<Stance> {
    let length: f64 = points.windows(2).map(|w| w[0].at.distance(w[1].at)).sum();
    let mut left = length * part.clamp(0.0, 1.0);
    for leg in points.windows(2) {
        let here = leg[0].at.distance(leg[1].at);
        if left <= here && here > 0.0 {
            return Some(leg[0].towards(leg[1], left / here));
        }
        left -= here;
    }
    points.last().copied()
}
