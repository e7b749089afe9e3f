//! The medial axis: the centres of the maximal inscribed discs of a polygon, with their radii.
//!
//! It gives a wall's centre-line and local thickness (2 × radius). All lengths in mm, all angles in radians.
//!
//! # How
//!
//! 1. The outline passes through the grid of the crate once (union, even-odd): clean rings, at most 0.07 µm off.
//! 2. Points are put on it, `spacing` apart and closer towards convex corners, and joined by a constrained Delaunay
//!    triangulation (`spade`). The triangles inside, linked across their inner sides (*chords*), have the very
//!    topology of the polygon: one connected piece, one loop round every hole.
//! 3. On the way from one end of a chord to the other, over a point of its Voronoi edge, the nearest boundary
//!    changes sides: there lies a point of the medial axis. It is found exactly, against the true edges and not the
//!    samples (bracketing on the two nearest edges; a tree of boxes over the edges finds them). A triangle
//!    with three chords is a junction, its disc touches three edges (Newton); one with a single chord is a corner.
//! 4. Noise is removed (below) and the rest cut into branches; junctions closer than 1 µm are one.
//!
//! Every node is thus equidistant from what it touches to 1e-9 mm, and no farther from the truth than the grid; only
//! where a junction touches too many edges of an arc to choose from may it be 0.01 mm off. Nodes lie at most about
//! `spacing` apart; between them the curve is a chord of a line or parabola. Cost: n log n in the number of samples.
//!
//! # What is kept
//!
//! The *object angle* of a node is the angle between the two points its disc touches, seen from its centre (Attali and
//! Montanvert 1996, the θ of the θ-SMA of Foskey, Lin and Manocha 2003). It is 180° between parallel walls; on the
//! branch into a corner of interior angle θ it is 180° − θ, and the radius falls there by sin(θ/2) per mm of branch:
//! dr/ds = cos(object angle / 2) (Blum and Nagel 1978). Two rules use it:
//!
//! - [`MedialOptions::min_angle`] (50°): free ends below it are noise and never appear, and neither do free branches
//!   whose radius grows as fast from end to end. An arc sampled every 5° makes 5°; only corners blunter than 130° go
//!   with them. A scan's spikes with sharper corners stay until they are pruned.
//! - [`MedialAxis::pruned`] removes what runs into corners: from every free end, as long as the radius grows by
//!   at least sin(corner/2) per mm. [`CORNER`] = 40° takes square and slanted wall ends and leaves sharp trailing
//!   edges. A rounded end loses no more than about its end radius. A part that widens steadily at 40° or more is
//!   one great corner to this rule and goes too.

use crate::boolean::unite_rings;
use crate::offset::Join;
use crate::{FillRule, Polygon, Region, Ring};
use glam::DVec2;

mod boundary;
mod build;
mod disc;
mod graph;
mod join;
mod mesh;
mod prune;

/// Interior angle, rad (40°), of the sharpest corner that still counts as one in [`MedialAxis::pruned`].
pub const CORNER: f64 = 40.0 * std::f64::consts::PI / 180.0;

/// Branches between two junctions shorter than this are dropped and the junctions made one, mm.
const MERGE_MM: f64 = 1e-3;

/// The finest spacing, mm.
const LEAST_SPACING_MM: f64 = 1e-3;

/// An outline that touches itself and cannot be triangulated is shrunk by each of these distances in turn until it can
/// be, mm.
const SHRINK_MM: [f64; 4] = [0.0, 1e-3, 1e-2, 1e-1];

/// How finely the axis is sampled, and what counts as noise.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MedialOptions {
    /// Greatest distance between samples of the boundary, mm; the nodes of the axis are about as dense. Default 0.25.
    pub spacing: f64,
    /// Free ends whose object angle is below this, rad, are noise. Default 50°.
    pub min_angle: f64,
}

impl Default for MedialOptions {
    fn default() -> Self {
        Self { spacing: 0.25, min_angle: 50_f64.to_radians() }
    }
}

impl MedialOptions {
    /// Replaces a spacing that is not a length by the default, and never goes below [`LEAST_SPACING_MM`].
    fn sane(self) -> Self {
        let spacing = if self.spacing > 0.0 { self.spacing } else { Self::default().spacing };
        Self { spacing: spacing.max(LEAST_SPACING_MM), ..self }
    }
}

/// A maximal inscribed disc.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Node {
    /// Its middle.
    pub at: DVec2,
    /// Its radius, mm: the distance from `at` to the boundary.
    pub radius: f64,
}

/// A curve of the medial axis between two junctions or free ends.
#[derive(Debug, Clone, PartialEq)]
pub struct Branch {
    /// At least two nodes, in order; the first and the last are the junctions themselves.
    pub nodes: Vec<Node>,
    /// Where it begins: index into [`MedialAxis::junctions`].
    pub from: usize,
    /// Where it ends; the same as `from` for a closed loop.
    pub to: usize,
}

/// The medial axis of a polygon or region.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct MedialAxis {
    /// The curves.
    pub branches: Vec<Branch>,
    /// Where branches meet or end. A loop without junctions is given one; the axis of a disc is one junction without
    /// branches.
    pub junctions: Vec<Node>,
}

impl Branch {
    /// Length, mm.
    pub fn length(&self) -> f64 {
        length(&self.nodes)
    }

    /// Whether it comes back to where it began.
    pub fn is_closed(&self) -> bool {
        self.from == self.to
    }
}

impl MedialAxis {
    /// The medial axis of `polygon`. Rings may cross, touch or run either way: inside is where [`Polygon::contains`]
    /// says so.
    ///
    /// ```
    /// use planar::medial::{CORNER, MedialAxis, MedialOptions};
    /// use planar::{DVec2, Polygon, Ring};
    ///
    /// // Without what runs into its corners, the axis of a rectangle is a line in its middle.
    /// let plate = Polygon::simple(Ring::new([(0.0, 0.0), (20.0, 0.0), (20.0, 6.0), (0.0, 6.0)].map(DVec2::from).to_vec()));
    /// let axis = MedialAxis::of(&plate, &MedialOptions::default()).pruned(CORNER);
    /// assert_eq!(axis.branches.len(), 1);
    /// assert!((axis.length() - (20.0 - 6.0)).abs() < 1e-3);
    /// assert!(axis.branches[0].nodes.iter().all(|node| (node.radius - 3.0).abs() < 1e-3));
    /// ```
    pub fn of(polygon: &Polygon, options: &MedialOptions) -> Self {
        let options = &options.sane();
        let rings: Vec<Ring> = polygon.rings().cloned().collect();
        let mut axis = Self::default();
        for clean in unite_rings(&rings, FillRule::EvenOdd).polygons() {
            axis.append(of_clean(clean, options));
        }
        axis
    }

    /// The medial axes of all polygons of `region`, in their order.
    pub fn of_region(region: &Region, options: &MedialOptions) -> Self {
        let mut axis = Self::default();
        for polygon in region.polygons() {
            axis.append(Self::of(polygon, options));
        }
        axis
    }

    /// Length of all branches, mm.
    pub fn length(&self) -> f64 {
        self.branches.iter().map(Branch::length).sum()
    }

    /// How many branch ends meet at each junction; 1 is a free end, a closed loop counts as two.
    pub fn degrees(&self) -> Vec<usize> {
        let mut degrees = vec![0; self.junctions.len()];
        for branch in &self.branches {
            degrees[branch.from] += 1;
            degrees[branch.to] += 1;
        }
        degrees
    }

    fn append(&mut self, other: Self) {
        let offset = self.junctions.len();
        self.junctions.extend(other.junctions);
        let moved = |b: Branch| Branch { from: b.from + offset, to: b.to + offset, ..b };
        self.branches.extend(other.branches.into_iter().map(moved));
    }
}

fn length(nodes: &[Node]) -> f64 {
    nodes.windows(2).map(|w| w[0].at.distance(w[1].at)).sum()
}

/// `polygon` as the union returned it: rings that cross nowhere, though they may still touch.
fn of_clean(polygon: &Polygon, options: &MedialOptions) -> MedialAxis {
    for shrink in SHRINK_MM {
        let region = match shrink {
            0.0 => Region::from(polygon.clone()),
            mm => Region::from(polygon.clone()).offset(-mm, Join::Miter(4.0)),
        };
        let pieces: Option<Vec<_>> = region.polygons().iter().map(|p| of_triangulable(p, options)).collect();
        if let Some(pieces) = pieces {
            let mut axis = MedialAxis::default();
            pieces.into_iter().for_each(|piece| axis.append(piece));
            return axis;
        }
    }
    MedialAxis::default()
}

/// `None` when the samples cannot be triangulated without crossings.
fn of_triangulable(polygon: &Polygon, options: &MedialOptions) -> Option<MedialAxis> {
    let boundary = boundary::Boundary::of(polygon);
    let mesh = mesh::Mesh::of(&boundary, options)?;
    let mut graph = graph::Graph::of(&boundary, &mesh);
    graph.peel(options.min_angle);
    Some(graph.into_axis(options))
}
