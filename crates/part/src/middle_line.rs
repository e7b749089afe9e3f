//! The guide of a bent tube or bar, found from the centroids of its sections.
//!
//! The part is followed in short steps from the section on which it stands: each new section is cut square to the
//! direction that the centroids have taken, and the island ahead is the next section. If a section is cut slightly
//! askew, its centroid hardly moves.

use crate::chart::{Chart, Guide, Plane};
use crate::model::Mesh;
use crate::slice::{Slab, SliceOptions, Slicer};
use crate::task::{Cancelled, Task};
use glam::{DVec2, DVec3};
use planar::Polygon;
use std::f64::consts::PI;

/// Why no guide can be found.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum NoMiddleLine {
    /// Stopped by the caller.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// The part rests on several sections, or on none.
    #[error(
        "the part stands on {0} sections; a tube or bar stands on one. Turn it so that one end stands on the table"
    )]
    Start(usize),
    /// A part not much longer than wide.
    #[error(
        "the part is no tube or bar: from its lower end it can be followed for {length:.1} mm only, and it is {width:.1} mm wide"
    )]
    Short {
        /// Length of the line, mm.
        length: f64,
        /// Width of the section, mm.
        width: f64,
    },
    /// A part that branches, or whose section changes abruptly.
    #[error("near x {:.1} y {:.1} z {:.1} mm the part branches or its section jumps: cut it there, or give the guide's points", .0.x, .0.y, .0.z)]
    Jump(DVec3),
}

/// Length of a step, as a fraction of the radius of a disc with the section's area.
const STEP: f64 = 0.15;
/// Number of steps from which the direction ahead is taken.
const WAY: usize = 2;
/// Most steps.
const MOST_STEPS: usize = 20_000;
/// Height above the table at which the lower end is cut, mm.
const ASIDE: f64 = 0.05;
/// Thickness of the layer cut at a plane, mm: a part that ends within it counts as cut.
const THIN: f64 = 1e-3;
/// How often the last step is halved.
const HALVED: usize = 8;
/// Greatest distance of the next section's centroid from where it is expected, in radii of the section.
const AHEAD: f64 = 0.35;
/// Greatest ratio of the areas of two consecutive sections.
const LIKE: f64 = 1.1;
/// The same for the last section, which must be whole.
const WHOLE: f64 = 1.01;
/// Steps between corners of the guide.
const APART: usize = 3;
/// Lines that turn by less than this have no corner between them, rad.
const STRAIGHT: f64 = 0.004;

/// The guide (mm) of a tube or bar that stands on one of its ends.
///
/// ```
/// use bead_part::{example, middle_line::middle_line, task::Task};
///
/// // 25 mm straight, a quarter turn of 120 mm radius, 25 mm straight.
/// let elbow = example::find("elbow").ok_or("no such example")?.mesh();
/// let guide = middle_line(&elbow, &Task::new())?;
/// assert!((guide.length() - (50.0 + 60.0 * std::f64::consts::PI)).abs() < 1.0, "{}", guide.length());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`NoMiddleLine`].
pub fn middle_line(mesh: &Mesh, task: &Task) -> Result<Guide, NoMiddleLine> {
    let low = mesh.bounds().0.z;
    let part = Followed { mesh, reach: mesh.size().length(), task };
    let first = part.islands(Plane { origin: DVec3::Z * (low + ASIDE), up: DVec3::Z })?;
    let [island] = &first[..] else { return Err(NoMiddleLine::Start(first.len())) };
    let start = Section::of(island).ok_or(NoMiddleLine::Start(0))?;
    let (radius, step) = (start.radius(), STEP * start.radius());
    let mut middles = vec![start.middle.extend(low)];
    let mut sections = vec![start];
    while middles.len() < MOST_STEPS {
        let (last, forth) = (middles[middles.len() - 1], way(&middles));
        let before = sections[sections.len() - 1];
        let other = match part.ahead(last, forth * step, before, LIKE)? {
            Ahead::Section(section, middle) => {
                middles.push(middle);
                sections.push(section);
                continue;
            }
            Ahead::Nothing => None,
            Ahead::Other(middle) => Some(middle),
        };
        // The step may end inside the face that closes the part.
        let goes_on = other.filter(|_| !matches!(part.ahead(last, forth * radius, before, LIKE), Ok(Ahead::Nothing)));
        if let Some(middle) = goes_on {
            return Err(NoMiddleLine::Jump(middle));
        }
        break;
    }
    // That face may also have cut the last section.
    if middles.len() > 2 {
        middles.pop();
        sections.pop();
    }
    let (last, before) = (middles[middles.len() - 1], sections[sections.len() - 1]);
    middles.extend(part.end(last, way(&middles) * 2.0 * step, before)?);
    let length: f64 = middles.windows(2).map(|w| w[0].distance(w[1])).sum();
    if length < 2.0 * radius {
        return Err(NoMiddleLine::Short { length, width: 2.0 * radius });
    }
    Guide::new(corners(&middles), Vec::new()).map_err(|_| NoMiddleLine::Jump(middles[0]))
}

/// A section of the part.
#[derive(Clone, Copy)]
struct Section {
    middle: DVec2,
    /// Area without its holes subtracted, mm².
    area: f64,
}

impl Section {
    fn of(island: &Polygon) -> Option<Self> {
        Some(Self { middle: island.outer.centroid()?, area: island.outer.area() })
    }

    fn radius(self) -> f64 {
        (self.area / PI).sqrt()
    }
}

/// A part being followed.
struct Followed<'a> {
    mesh: &'a Mesh,
    /// More than any of its coordinates in any plane, mm.
    reach: f64,
    task: &'a Task,
}

/// What lies ahead of a section.
enum Ahead {
    /// The next section, and its middle.
    Section(Section, DVec3),
    /// Nothing nearby.
    Nothing,
    /// Something that does not continue the section.
    Other(DVec3),
}

impl Followed<'_> {
    /// What lies one step ahead of a point.
    fn ahead(&self, from: DVec3, step: DVec3, before: Section, like: f64) -> Result<Ahead, Cancelled> {
        let plane = Plane { origin: from + step, up: step.normalize() };
        let islands = self.islands(plane)?;
        let nearest = islands.iter().filter_map(Section::of);
        let nearest = nearest.min_by(|a, b| a.middle.length().total_cmp(&b.middle.length()));
        let Some(section) = nearest.filter(|section| section.middle.length() < before.radius()) else {
            return Ok(Ahead::Nothing);
        };
        let middle = Chart::Plane(plane).sheet(0.0).at(section.middle.extend(0.0)).place;
        let is_like = section.area < like * before.area && before.area < like * section.area;
        let is_next = section.middle.length() < AHEAD * before.radius() && is_like;
        Ok(if is_next { Ahead::Section(section, middle) } else { Ahead::Other(middle) })
    }

    /// The last point within a step at which the part continues, found by bisection.
    fn end(&self, from: DVec3, step: DVec3, before: Section) -> Result<Option<DVec3>, Cancelled> {
        let (mut low, mut high, mut last) = (0.0, 1.0, None);
        for _ in 0..HALVED {
            let middle = 0.5 * (low + high);
            match self.ahead(from, step * middle, before, WHOLE)? {
                Ahead::Section(_, place) => (low, last) = (middle, Some(place)),
                _ => high = middle,
            }
        }
        Ok(last)
    }

    /// The islands in which a plane cuts the part, in the coordinates of the plane.
    fn islands(&self, plane: Plane) -> Result<Vec<Polygon>, Cancelled> {
        let mut turned = self.mesh.clone();
        let chart = Chart::Plane(plane);
        turned.vertices.iter_mut().for_each(|p| *p = chart.coordinates(*p) + DVec3::Z * self.reach);
        let options = SliceOptions { layer_height: THIN, close_gap: 0.1, simplify: 0.0 };
        let slicer =
            Slicer::of_slabs(&turned, vec![Slab { z: self.reach + THIN / 2.0, height: THIN }], options, self.task)?;
        Ok(slicer.batch(0, self.task)?.pop().map_or_else(Vec::new, |slice| slice.islands))
    }
}

/// The direction at the last centroid: that of the last steps, turned on by half as much as it turned since the steps
/// before.
fn way(middles: &[DVec3]) -> DVec3 {
    let back = |steps: usize| middles[middles.len().saturating_sub(steps + 1)];
    let [recent, earlier] = [back(0) - back(WAY), back(WAY) - back(2 * WAY)];
    let recent = recent.normalize_or(DVec3::Z);
    let earlier = earlier.normalize_or(recent);
    (recent + 0.5 * (recent - earlier)).normalize_or(recent)
}

/// Every few centroids, as the corners of a guide that follows them. The arcs at the corners of a polygon cut inside it
/// by a quarter of the corner's distance from the midpoint of its neighbours, so corners are moved out by that; where
/// the guide is straight, there are none.
fn corners(middles: &[DVec3]) -> Vec<DVec3> {
    let Some((last, others)) = middles.split_last() else { return Vec::new() };
    let mut points: Vec<DVec3> = others.iter().step_by(APART).copied().collect();
    // The last step is short.
    if points.len() > 1 && (others.len() - 1) % APART < APART / 2 {
        points.pop();
    }
    points.push(*last);
    let turns = |w: &[DVec3]| (w[1] - w[0]).angle_between(w[2] - w[1]) > STRAIGHT;
    let out = |w: &[DVec3]| w[1] + 0.25 * (w[1] - w[0].midpoint(w[2]));
    let inner = points.windows(3).filter(|w| turns(w)).map(out);
    points.first().copied().into_iter().chain(inner).chain([*last]).collect()
}
