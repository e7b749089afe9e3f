//! The guide of a bent tube or bar, from the middles of its sections.
//!
//! From the section on which the part stands, it is followed in short steps: each section is cut square to the way that the middles
//! so far have taken, and the island that lies ahead is the next one. Where a section is cut a little askew, its middle hardly moves.

use crate::chart::{Chart, Guide, Plane};
use crate::model::Mesh;
use crate::slice::{Slab, SliceOptions, Slicer};
use crate::task::{Cancelled, Task};
use glam::{DVec2, DVec3};
use planar::Polygon;
use std::f64::consts::PI;

/// Why no guide is found.
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
    /// A part that is hardly longer than wide.
    #[error(
        "the part is no tube or bar: from its lower end it can be followed for {length:.1} mm only, and it is {width:.1} mm wide"
    )]
    Short {
        /// Length of the line, mm.
        length: f64,
        /// Width of the section, mm.
        width: f64,
    },
    /// A part that divides, or whose section changes at once.
    #[error("near x {:.1} y {:.1} z {:.1} mm the part branches or its section jumps: cut it there, or give the guide's points", .0.x, .0.y, .0.z)]
    Jump(DVec3),
}

/// A step, as a part of the radius of a disc as large as the section.
const STEP: f64 = 0.15;
/// The way ahead is that of this many steps.
const WAY: usize = 2;
/// No part is followed for more steps.
const MOST_STEPS: usize = 20_000;
/// The lower end is looked at this far above the table, mm.
const ASIDE: f64 = 0.05;
/// A plane is cut as the middle of a layer this thick, mm: a part that ends within it counts as cut.
const THIN: f64 = 1e-3;
/// The last step is halved this often.
const HALVED: usize = 8;
/// The middle of the next section lies no farther from where it is expected, in radii of the section.
const AHEAD: f64 = 0.35;
/// A section is no more than this many times as large as the one before it, or as it is as large as this one.
const LIKE: f64 = 1.1;
/// The last one is whole: this many times.
const WHOLE: f64 = 1.01;
/// Corners of the guide are this many steps apart.
const APART: usize = 3;
/// Between lines that turn by less than this there is no corner, rad.
const STRAIGHT: f64 = 0.004;

/// The guide of a tube or bar that stands on one of its ends.
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
        // The step may end in the face that closes the part.
        let goes_on = other.filter(|_| !matches!(part.ahead(last, forth * radius, before, LIKE), Ok(Ahead::Nothing)));
        if let Some(middle) = goes_on {
            return Err(NoMiddleLine::Jump(middle));
        }
        break;
    }
    // Such a face may have cut the last section, too.
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
    /// Without its holes, mm².
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

/// A part that is followed.
struct Followed<'a> {
    mesh: &'a Mesh,
    /// Larger than all of its coordinates in any plane, mm.
    reach: f64,
    task: &'a Task,
}

/// What lies ahead of a section.
enum Ahead {
    /// The next section, and its middle.
    Section(Section, DVec3),
    /// Nothing near.
    Nothing,
    /// Something that is no continuation of it.
    Other(DVec3),
}

impl Followed<'_> {
    /// What lies a step ahead of a place.
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

    /// The last place within a step in which the part goes on, which is halved again and again.
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

    /// The islands in which a plane cuts the part, in the plane's coordinates.
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

/// The way at the last middle: that of the last steps, turned on by half as much as it turned since the steps before them.
fn way(middles: &[DVec3]) -> DVec3 {
    let back = |steps: usize| middles[middles.len().saturating_sub(steps + 1)];
    let [recent, earlier] = [back(0) - back(WAY), back(WAY) - back(2 * WAY)];
    let recent = recent.normalize_or(DVec3::Z);
    let earlier = earlier.normalize_or(recent);
    (recent + 0.5 * (recent - earlier)).normalize_or(recent)
}

/// Every few of the middles, as the corners of a guide that follows them. The arcs at the corners of a polygon lie within it by a
/// quarter of how far each corner stands out, so corners are moved out by that; where the guide is straight, there are none.
fn corners(middles: &[DVec3]) -> Vec<DVec3> {
    let Some((last, others)) = middles.split_last() else { return Vec::new() };
    let mut points: Vec<DVec3> = others.iter().step_by(APART).copied().collect();
    // The last step is a short one.
    if points.len() > 1 && (others.len() - 1) % APART < APART / 2 {
        points.pop();
    }
    points.push(*last);
    let turns = |w: &[DVec3]| (w[1] - w[0]).angle_between(w[2] - w[1]) > STRAIGHT;
    let out = |w: &[DVec3]| w[1] + 0.25 * (w[1] - w[0].midpoint(w[2]));
    let inner = points.windows(3).filter(|w| turns(w)).map(out);
    points.first().copied().into_iter().chain(inner).chain([*last]).collect()
}
