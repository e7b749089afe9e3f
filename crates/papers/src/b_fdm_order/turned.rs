//! A plate turned by an angle, planned in each of the ways.

use super::plans::{Lines, Loops, Outcome, Plan, Raster};
use super::plate::Plate;
use crate::ReproduceError;
use beadwright::fill::angle;
use beadwright::fill::compound::Compound;
use beadwright::fill::zigzag::regions::Weave;
use beadwright::fill::{FillSettings, Strategy as _};
use beadwright::motion::Motion;
use beadwright::order::ant_colony::{self, Colony, Round};
use beadwright::order::begin_at;
use beadwright::order::tour::{self, Ends, Gate, Stop, Visit};
use beadwright::palette;
use beadwright::plan::{self, ToFill};
use beadwright::profile::Profile;
use beadwright::report::sketch::Sketch;
use glam::DVec2;
use planar::scan::{End, Scan, Spacing};
use planar::{Bounds, Polygon, Region, Ring};
use std::f64::consts::FRAC_PI_2;

/// The printer of the paper.
#[derive(Debug, Clone)]
pub struct Printer {
    pub(super) profile: Profile,
    motion: Motion,
}

impl Printer {
    /// The profile `fdm-abs-0.4`.
    ///
    /// # Errors
    /// [`ReproduceError`] where the profile gives no acceleration.
    pub fn new() -> Result<Self, ReproduceError> {
        let profile = Profile::built_in("fdm-abs-0.4").map_err(|e| ReproduceError(e.to_string()))?;
        let motion = profile.motion.ok_or_else(|| ReproduceError("fdm-abs-0.4 gives no acceleration".to_owned()))?;
        Ok(Self { profile, motion })
    }

    /// Time of the paths and of the travels between them, s; each begins and ends at rest.
    fn seconds(&self, paths: &[&Vec<DVec2>]) -> f64 {
        let run = |points: &[DVec2], speed: f64| {
            let to = points.iter().skip(1).map(|p| (p.extend(0.0), speed));
            points.first().map_or(0.0, |first| self.motion.seconds(first.extend(0.0), to))
        };
        let laid: f64 = paths.iter().map(|path| run(path, self.profile.process.deposition_speed)).sum();
        laid + travels(paths).map(|ends| run(&ends, self.profile.travel.speed)).sum::<f64>()
    }
}

/// A plate turned by an angle, ready to be planned in several ways. Its two layers are alike.
pub struct Turned<'a> {
    printer: &'a Printer,
    settings: FillSettings<'a>,
    slice: Region,
    /// The contours in file order, each from its first vertex.
    loops: Vec<Ring>,
    /// Their order by columns of the plate as it lies in the file.
    columns: Vec<usize>,
    core: Region,
    pub(super) best: f64,
    fewest_turns: f64,
}

impl<'a> Turned<'a> {
    /// The plate turned by `degrees`.
    pub fn new(plate: &Plate, degrees: f64, printer: &'a Printer) -> Self {
        let polygon = plate.turned(degrees);
        let settings = printer.profile.fill_settings(0);
        let layer = ToFill { islands: std::slice::from_ref(&polygon), solid: None };
        let best = plan::raster_angle(&[layer; 2], &Compound, &printer.profile).unwrap_or_default();
        let core = Compound.infill(&polygon, &settings);
        let fewest_turns = angle::fewest_turns(&[vec![core.clone()]], &settings).unwrap_or_default();
        let (loops, columns) = (loops(&polygon, &settings), columns(&plate.polygon));
        Self { printer, settings, slice: polygon.into(), loops, columns, core, best, fewest_turns }
    }

    /// The number of sub-regions of scan lines at 0°.
    pub fn sub_regions(&self) -> usize {
        Weave::new(&self.scan(0.0), self.settings.stepover).regions().len()
    }

    /// The number of regions that remain once these are merged (3.2).
    pub fn merged_regions(&self) -> usize {
        Weave::new(&self.scan(0.0), self.settings.stepover).merged().len()
    }

    /// How the tours of the ants through the contours get shorter (figure 4).
    pub fn convergence(&self) -> Vec<Round> {
        ant_colony::convergence(&self.stops(), &Colony::default())
    }

    fn stops(&self) -> Vec<Stop> {
        self.loops.iter().map(|ring| Stop::ring(ring.points().to_vec())).collect()
    }

    /// The figures of a plan.
    pub fn outcome(&self, plan: &Plan) -> Outcome {
        let laid = self.laid(plan);
        let count = |of: fn(&Laid) -> usize| laid.iter().map(of).sum::<usize>() as f64 / 2.0;
        let corners = |layer: &Laid| angle::corner_area(&self.core, layer.angle, &self.settings);
        let all: Vec<&Vec<DVec2>> = laid.iter().flat_map(Laid::paths).collect();
        let contours: Vec<&Vec<DVec2>> = laid[0].contours.iter().collect();
        let between = length(travels(&contours));
        Outcome {
            // The paper counts the closed tour through the start points.
            contour_travel: between + contours.last().zip(contours.first()).map_or(0.0, |(a, b)| a[0].distance(b[0])),
            fill_travel: length(travels(&all)) / 2.0 - between,
            seconds: self.printer.seconds(&all) / 2.0,
            paths: count(|layer| layer.fill.len()),
            turns: count(|layer| layer.turns),
            corner_area: laid.iter().map(corners).sum::<f64>() / 2.0,
        }
    }

    /// The two layers as they are laid.
    fn laid(&self, plan: &Plan) -> [Laid; 2] {
        let first = match plan.raster {
            Raster::Zero | Raster::Alike => 0.0,
            Raster::At(angle) => angle,
            Raster::FewestTurns => self.fewest_turns,
            Raster::Best => self.best,
        };
        let second = if plan.raster == Raster::Alike { first } else { first + FRAC_PI_2 };
        [first, second].map(|angle| {
            let (contours, scan) = (self.contours(plan.loops), self.scan(angle));
            let from = contours.last().map_or(DVec2::ZERO, |path| path[0]);
            Laid { fill: self.fill(plan, &scan, from), contours, turns: 2 * scan.spans().len(), angle }
        })
    }

    fn scan(&self, angle: f64) -> Scan {
        Scan::new(&self.core, angle, Spacing::AtMost(self.settings.stepover))
    }

    /// The tour through the contours.
    pub(super) fn tour(&self, loops: Loops) -> Vec<Visit> {
        let stops = self.stops();
        let one_by_one = |order: &mut dyn Iterator<Item = usize>| {
            order.filter_map(|i| Some(Visit::new(i, stops[i].gates().next()?))).collect()
        };
        match loops {
            Loops::File => one_by_one(&mut (0..stops.len())),
            Loops::Columns => one_by_one(&mut self.columns.iter().copied()),
            Loops::By(method) => method.tour(&stops, Ends::Closed),
        }
    }

    fn contours(&self, loops: Loops) -> Vec<Vec<DVec2>> {
        let ring = |visit: &Visit| begin_at_point(self.loops[visit.stop].clone(), visit.enter);
        self.tour(loops).iter().map(ring).collect()
    }

    /// The fill as it is laid, from the end of the contours.
    fn fill(&self, plan: &Plan, scan: &Scan, from: DVec2) -> Vec<Vec<DVec2>> {
        let weave = Weave::new(scan, self.settings.stepover);
        let paths = match plan.lines {
            Lines::Whole => whole_lines(scan),
            Lines::SubRegions => weave.paths(&weave.apart()),
            Lines::Merged => weave.paths(&weave.merged()),
        };
        let Some(method) = plan.fill else { return paths };
        let line = |path: &Vec<DVec2>| {
            let gate = Gate { enter: path[0], leave: path[path.len() - 1] };
            Stop::Line { gate, reversible: true }
        };
        let stops: Vec<Stop> = paths.iter().map(line).collect();
        let laid = |visit: &Visit| {
            let mut path = paths[visit.stop].clone();
            if path.first() != Some(&visit.enter) {
                path.reverse();
            }
            path
        };
        method.tour(&stops, Ends::From(from)).iter().map(laid).collect()
    }

    /// The first layer of a plan with its travels.
    pub(super) fn sketch(&self, plan: &Plan, title: &str) -> Sketch {
        let mut sketch = Sketch::new(self.slice.bounds().unwrap_or(Bounds::EMPTY), title);
        sketch.region(&self.slice, palette::SLICE);
        let [layer, _] = self.laid(plan);
        let paths: Vec<&Vec<DVec2>> = layer.paths().collect();
        for (path, colour) in paths.iter().zip(palette::CURVES.iter().cycle()) {
            sketch.line(path, false, *colour, 0.4 * self.settings.stepover);
        }
        for ends in travels(&paths) {
            sketch.line(&ends, false, palette::END, self.settings.stepover);
        }
        sketch
    }
}

/// What is laid on a layer.
struct Laid {
    contours: Vec<Vec<DVec2>>,
    fill: Vec<Vec<DVec2>>,
    turns: usize,
    /// Angle of the scan lines, radians.
    angle: f64,
}

impl Laid {
    fn paths(&self) -> impl Iterator<Item = &Vec<DVec2>> {
        self.contours.iter().chain(&self.fill)
    }
}

/// Scan lines one after another, to and fro. A path ends where a hole is in the way, and where the boundary does not
/// lead to the next line.
fn whole_lines(scan: &Scan) -> Vec<Vec<DVec2>> {
    let (mut paths, mut path): (Vec<Vec<DVec2>>, Vec<DVec2>) = (Vec::new(), Vec::new());
    let (mut first, mut from, mut last) = (0, End::Left, None);
    for line in scan.spans().chunk_by(|a, b| a.line == b.line) {
        let mut spans: Vec<usize> = (first..first + line.len()).collect();
        first += line.len();
        if from == End::Right {
            spans.reverse();
        }
        for span in spans {
            let up = last.and_then(|last| scan.chain_up(last, from)).filter(|chain| chain.to == span);
            match up {
                Some(chain) => path.extend(chain.via),
                None => paths.push(std::mem::take(&mut path)),
            }
            path.extend([scan.end(span, from), scan.end(span, from.other())]);
            last = Some(span);
        }
        from = from.other();
    }
    paths.push(path);
    let turned = |path: Vec<DVec2>| path.into_iter().map(|p| scan.turn_back(p)).collect();
    paths.into_iter().filter(|path| !path.is_empty()).map(turned).collect()
}

/// The ends of the travel from each path to the next.
fn travels<'a>(paths: &'a [&Vec<DVec2>]) -> impl Iterator<Item = [DVec2; 2]> + 'a {
    paths.windows(2).map(|w| [w[0][w[0].len() - 1], w[1][0]])
}

fn length(travels: impl Iterator<Item = [DVec2; 2]>) -> f64 {
    travels.map(|[from, to]| from.distance(to)).sum()
}

/// The contours of a plate as its file gives the loops: in their order, and each from its first vertex.
fn loops(plate: &Polygon, settings: &FillSettings) -> Vec<Ring> {
    let contours = settings.outermost(plate);
    let near = |p: DVec2| move |a: &DVec2, b: &DVec2| a.distance_squared(p).total_cmp(&b.distance_squared(p));
    let of = |ring: &Ring| {
        let start = ring.points()[0];
        let first = |contour: &&Ring| contour.points().iter().copied().min_by(near(start)).unwrap_or_default();
        let contour = contours.rings().min_by(|a, b| near(start)(&first(a), &first(b)))?;
        let mut points = contour.points().to_vec();
        let at = points.iter().position(|p| *p == first(&contour))?;
        points.rotate_left(at);
        Some(Ring::new(points))
    };
    plate.rings().filter_map(of).collect()
}

/// The loops of a plate by columns, which are walked up and down; the outline comes first.
fn columns(plate: &Polygon) -> Vec<usize> {
    let bounds = Bounds::of(plate.outer.points().iter().copied()).unwrap_or(Bounds::EMPTY);
    let size = bounds.size();
    // The number of columns that makes their cells about square.
    let count = (plate.holes.len() as f64 * size.x / size.y).sqrt().round().max(1.0);
    let place = |hole: &Ring| {
        let centre = tour::centroid(hole.points()) - bounds.min;
        let column = (count * centre.x / size.x) as usize;
        (column, if column.is_multiple_of(2) { centre.y } else { -centre.y })
    };
    let mut holes: Vec<usize> = (0..plate.holes.len()).collect();
    holes.sort_by(|&a, &b| {
        let (a, b) = (place(&plate.holes[a]), place(&plate.holes[b]));
        a.0.cmp(&b.0).then(a.1.total_cmp(&b.1))
    });
    [0].into_iter().chain(holes.into_iter().map(|hole| hole + 1)).collect()
}

/// A ring as a path that begins and ends at a point of it.
fn begin_at_point(ring: Ring, start: DVec2) -> Vec<DVec2> {
    begin_at(beadwright::fill::Path::contour(ring, 0.0), start).path()
}
