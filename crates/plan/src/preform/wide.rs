//! At least one bead everywhere.

use super::PreformSettings;
use crate::fill::thin::{ThinLimits, split};
use glam::DVec2;
use planar::nearest::foot;
use planar::{Join, Polygon, Region, min_area_rect};
use rstar::RTree;
use rstar::primitives::Line;

/// Pieces of the part that no bead reaches are considered from this area on, in squared bead widths.
const WORTH: f64 = 1e-3;
/// The same for other pieces with too little space for two beads: smaller ones are corners, which every outline has.
const FEATURE: f64 = 0.12;
/// Rounds in which space is made for two beads.
const ROUNDS: usize = 6;
/// Accuracy of bead outlines, mm.
const TOLERANCE_MM: f64 = 0.01;
/// A bead laid along an edge is narrower by this fraction, to allow for rounding.
const HAIR: f64 = 1e-3;
/// Islands are longer than the shortest pass by this fraction, because a pass ends before the end of its island.
const LONGER: f64 = 0.1;

/// A region in which beads reach everything that is `bare` part. Walls become as wide as a bead; areas that are narrow
/// and too short for a pass of their own get space for two beads side by side; a bead is added at each corner of the
/// part that is too sharp; and islands become long enough for a pass.
pub fn widened(region: &Region, bare: &Region, settings: &PreformSettings) -> Region {
    let (w, room) = (settings.bead_width, settings.room);
    let walls: Vec<Vec<DVec2>> = region.polygons().iter().flat_map(|island| thin_walls(island, w, room)).collect();
    let along = beads(&walls, w);
    let mut wide = with(region.clone(), &along);
    // A neck is reached from its ends, one after the other.
    for _ in 0..ROUNDS {
        let roomy = with(opened(&wide, room), &along);
        let more = beads_into(&wide.difference(&roomy), &wide, room, FEATURE * w * w);
        if more.is_empty() {
            break;
        }
        wide = wide.union(&more);
    }
    let sharp = bare.difference(&opened(&wide, w));
    let wide = with(wide.clone(), &beads_into(&sharp, &wide, w, WORTH * w * w));
    let short = wide.polygons().iter().filter_map(|island| longer(island, (1.0 + LONGER) * settings.shortest, w));
    let short = beads(&short.collect::<Vec<_>>(), w);
    with(wide, &short)
}

fn with(region: Region, more: &Region) -> Region {
    if more.is_empty() { region } else { region.union(more) }
}

/// Beads of a width (mm) into pieces of a region that are larger than `least`, mm².
fn beads_into(pieces: &Region, region: &Region, width: f64, least: f64) -> Region {
    let mut pieces = pieces.polygons().iter().filter(|piece| piece.area() > least).peekable();
    if pieces.peek().is_none() {
        return Region::default();
    }
    let centres = region.offset(-(1.0 - HAIR) * width / 2.0, Join::ROUND);
    let edges = centres.rings().flat_map(|ring| ring.edges()).map(|(a, b)| Line::new(a.to_array(), b.to_array()));
    let centres = RTree::bulk_load(edges.collect());
    beads(&pieces.filter_map(|piece| bead_into(piece, &centres, width)).collect::<Vec<_>>(), width)
}

fn beads(lines: &[Vec<DVec2>], width: f64) -> Region {
    if lines.is_empty() {
        return Region::default();
    }
    planar::buffer(lines, false, width / 2.0, TOLERANCE_MM)
}

/// The area that a disc of this width (mm) reaches.
fn opened(region: &Region, width: f64) -> Region {
    let by = (1.0 - HAIR) * width / 2.0;
    region.offset(-by, Join::ROUND).offset(by, Join::ROUND)
}

/// The middles of walls with space for at most one bead.
fn thin_walls(island: &Polygon, width: f64, room: f64) -> Vec<Vec<DVec2>> {
    let centre = island.centres_of_disc(room / 2.0, Join::ROUND);
    if island.is_roomy_for_disc(room / 2.0, &centre, FEATURE * width * width) {
        return Vec::new();
    }
    let limits = ThinLimits { bead_width: width, single: (width, room), thinnest: HAIR * width, double: room };
    let walls = split(island, &limits).thin.into_iter();
    walls.map(|wall| wall.nodes.iter().map(|node| node.at).collect()).collect()
}

/// A bead from where its centre may lie into a piece, as far as the piece's tip.
fn bead_into(piece: &Polygon, centres: &RTree<Line<[f64; 2]>>, width: f64) -> Option<Vec<DVec2>> {
    let nearest =
        |p: DVec2| centres.nearest_neighbor(&p.to_array()).map(|edge| foot((edge.from.into(), edge.to.into()), p));
    let from_centre = |p: DVec2| (p, nearest(p).map_or(0.0, |centre| centre.distance(p)));
    let points = piece.outer.points().iter().copied();
    let (tip, _) = points.map(from_centre).max_by(|a, b| a.1.total_cmp(&b.1))?;
    let centre = nearest(tip).filter(|centre| centre.distance(tip) > width / 2.0)?;
    Some(vec![centre, tip + (centre - tip).normalize_or_zero() * width / 2.0])
}

/// A pass through an island that is too short for one, mm; `None` if it is long enough.
fn longer(island: &Polygon, shortest: f64, width: f64) -> Option<Vec<DVec2>> {
    let rect = min_area_rect(island.outer.points())?;
    let (long, along) =
        if rect.size.x >= rect.size.y { (rect.size.x, rect.axis) } else { (rect.size.y, rect.axis.perp()) };
    let middle = rect.center;
    let half = along * shortest / 2.0;
    (long < (1.0 - HAIR) * (shortest + width)).then(|| vec![middle - half, middle + half])
}
