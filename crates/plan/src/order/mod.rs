//! Order: in which sequence the passes of a layer are laid, and where each begins.
//!
//! Islands are finished one after another, and the stages of an island in their order. Within a stage, and among the
//! islands, the order and the start points are chosen together so that the torch travels little: a travelling salesman
//! who may enter every town by any of its gates. An open pass has two gates; a closed one may begin at any point, even
//! in the middle of an edge.
//!
//! | file | what it does |
//! | --- | --- |
//! | [`tour`] | the problem: stops with their gates, and a tour through them |
//! | [`nearest`] | nearest next; and the improved nearest neighbour of Han et al. 2018 (2.1) |
//! | [`ant_colony`] | the ant colony of Han et al. 2018 (2.2) |
//! | [`local_search`] | 2-opt, Or-opt and start points together; the default |
//! | [`exact`] | the optimum by dynamic programming, for few stops |
//! | `seams` | starts of closed passes moved off those of the layers below |
//! | `direction` | passes reversed on every second layer |
//! | `balance` | heat kept around the middle of the plate |

pub mod ant_colony;
mod balance;
mod direction;
pub mod exact;
pub mod local_search;
pub mod nearest;
mod seams;
pub mod tour;

pub use balance::Balance;

use crate::fill::{Fill, Path};
use balance::Warmth;
use glam::DVec2;
use seams::Seams;
use serde::{Deserialize, Serialize};
use std::collections::VecDeque;
use tour::{Ends, Stop, Visit};

/// How the order is found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub enum Method {
    /// Always the nearest pass next.
    Nearest,
    /// The best nearest-neighbour tour over all vertices as seeds (Han et al. 2018, 2.1).
    ImprovedNearest,
    /// The ant colony over the start points of `improved-nearest` (Han et al. 2018, 2.2).
    AntColony,
    /// Local search over order, start points and directions together.
    #[default]
    LocalSearch,
    /// The optimum over vertices and ends for up to nine passes; local search for more.
    Exact,
}

impl Method {
    /// A tour through all stops.
    pub fn tour(self, stops: &[Stop], ends: Ends) -> Vec<Visit> {
        match self {
            Self::Nearest => nearest::tour(stops, ends),
            Self::ImprovedNearest => nearest::improved(stops, ends),
            Self::AntColony => ant_colony::tour(stops, ends, &ant_colony::Colony::default()),
            Self::Exact if stops.len() <= exact::MAX_STOPS => exact::tour(stops, ends),
            Self::LocalSearch | Self::Exact => local_search::tour(stops, ends),
        }
    }
}

/// Where closed passes begin.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub enum Seam {
    /// Wherever the travel to it is short, or where the strategy put it.
    #[default]
    Nearest,
    /// At the same place on every layer, the rearmost (greatest y), where it can be dressed.
    Aligned,
    /// Two bead widths further on every layer.
    Rotate,
    /// As far as possible from the seams of the layers below: moved on each layer by the golden section of the length.
    Spread,
}

/// How the passes of a layer are put in order.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct OrderSettings {
    /// How order and start points are found.
    pub method: Method,
    /// Where closed passes begin.
    pub seam: Seam,
    /// Whether passes run the other way on every second layer.
    pub alternate: bool,
    /// Index of the layer, from 0.
    pub layer: usize,
    /// Bead width, mm.
    pub bead_width: f64,
    /// How heat is kept around the middle of the plate; `None` where only travels count. Only a [`Memory`] knows the heat.
    pub balance: Option<Balance>,
}

impl OrderSettings {
    /// The same for a plate whose middle is here, mm.
    pub fn around(self, middle: DVec2) -> Self {
        Self { balance: self.balance.map(|balance| Balance { middle, ..balance }), ..self }
    }

    /// Whether passes are laid alike on every layer.
    fn repeats(&self) -> bool {
        !self.alternate && self.balance.is_none() && matches!(self.seam, Seam::Nearest | Seam::Aligned)
    }

    /// Where a closed pass must begin; `None` where the order may choose.
    fn seam_of(&self, pass: &Path) -> Option<DVec2> {
        /// One minus the golden section: its multiples spread evenly.
        const GOLDEN: f64 = 0.381_966_011_250_105;
        if !pass.closed || self.seam == Seam::Nearest {
            return None;
        }
        let (path, length) = (pass.path(), pass.length());
        let rear = (0..pass.points.len()).max_by(|&a, &b| pass.points[a].y.total_cmp(&pass.points[b].y))?;
        let layer = self.layer as f64;
        let further = match self.seam {
            Seam::Nearest | Seam::Aligned => 0.0,
            Seam::Rotate => 2.0 * self.bead_width * layer,
            Seam::Spread => GOLDEN * length * layer,
        };
        let at = planar::polyline::length(&path[..=rear]) + further;
        planar::polyline::point_at(&path, at.rem_euclid(length.max(f64::MIN_POSITIVE)))
    }

    /// The pass as a stop, with its seam fixed where it must be.
    fn stop(&self, pass: &Path) -> Stop {
        self.seam_of(pass).map_or_else(|| Stop::of(pass), |seam| Stop::anywhere([seam]))
    }
}

/// Puts the passes of a layer in order. `torch` is the torch's position, mm (`None`:
/// the origin), updated to where the last pass ends.
///
/// ```
/// use bead_plan::fill::{Fill, Path};
/// use bead_plan::order::{Method, OrderSettings, order};
/// use planar::{DVec2, Ring};
///
/// // Two triangles: the torch, at the origin, comes to the second one first.
/// let ring = |x: f64| Ring::new([(x, 0.0), (x + 5.0, 0.0), (x, 5.0)].map(DVec2::from).to_vec());
/// let stage = vec![Path::contour(ring(30.0), 4.0), Path::contour(ring(10.0), 4.0)];
/// let settings = OrderSettings { method: Method::Exact, ..OrderSettings::default() };
/// let laid = order(vec![Fill { stages: vec![stage], fixed_order: false }], &settings, &mut None);
/// assert!(laid[0].points.contains(&DVec2::new(10.0, 0.0)));
/// ```
pub fn order(mut islands: Vec<Fill>, settings: &OrderSettings, torch: &mut Option<DVec2>) -> Vec<Path> {
    let mut ordered = Vec::with_capacity(islands.iter().flat_map(|f| &f.stages).map(Vec::len).sum());
    direction::settle_open(&mut islands, settings);
    for fill in islands_in_order(islands, settings, torch.unwrap_or_default()) {
        for stage in fill.stages {
            let stage = if fill.fixed_order {
                stage.into_iter().map(|pass| begin_at_seam(pass, settings)).collect()
            } else {
                stage_in_order(stage, settings, torch.unwrap_or_default())
            };
            *torch = stage.last().and_then(last_point).or(*torch);
            ordered.extend(stage);
        }
    }
    direction::turn_closed(&mut ordered, settings);
    ordered
}

/// What the layers of a part know about those below: the order of passes that other layers have too, so that what begins at the
/// same place is not searched again, and where they begin.
#[derive(Debug, Clone, Default)]
pub struct Memory {
    known: VecDeque<Known>,
    seams: Seams,
    warmth: Warmth,
    detour: f64,
}

#[derive(Debug, Clone)]
struct Known {
    islands: Vec<Fill>,
    settings: OrderSettings,
    from: Option<DVec2>,
    ordered: Vec<Path>,
    to: Option<DVec2>,
}

/// Scan lines turn from layer to layer: the same passes come again after two of them, or a few more.
const REMEMBERED: usize = 6;

impl Memory {
    /// [`order`], with starts of closed passes moved away from those of the layers below; `shared` says that other
    /// layers have the same passes.
    pub fn order(
        &mut self,
        islands: Vec<Fill>,
        shared: bool,
        settings: &OrderSettings,
        torch: &mut Option<DVec2>,
    ) -> Vec<Path> {
        let ordered = match &settings.balance {
            Some(balance) => self.balanced(islands, settings, balance, *torch),
            None => self.known(islands, shared, settings, torch),
        };
        let settled = self.seams.settle(ordered, settings);
        *torch = settled.last().and_then(last_point).or(*torch);
        settled
    }

    /// How much longer travels became so that heat is balanced, mm.
    pub fn detour(&self) -> f64 {
        self.detour
    }

    fn balanced(
        &mut self,
        islands: Vec<Fill>,
        settings: &OrderSettings,
        balance: &Balance,
        mut torch: Option<DVec2>,
    ) -> Vec<Path> {
        let from = torch.unwrap_or_default();
        let usual = order(islands.clone(), settings, &mut torch);
        let (laid, travel) = balance::order(&islands, usual, settings, balance, from, self.warmth);
        (self.warmth, self.detour) = (laid.warmth, self.detour + laid.travel - travel);
        laid.passes
    }

    fn known(
        &mut self,
        islands: Vec<Fill>,
        shared: bool,
        settings: &OrderSettings,
        torch: &mut Option<DVec2>,
    ) -> Vec<Path> {
        if !shared || !settings.repeats() {
            return order(islands, settings, torch);
        }
        let (settings, from) = (OrderSettings { layer: 0, ..*settings }, *torch);
        let same = |known: &&Known| known.from == from && known.settings == settings && known.islands == islands;
        if let Some(known) = self.known.iter().find(same) {
            *torch = known.to;
            return known.ordered.clone();
        }
        let ordered = order(islands.clone(), &settings, torch);
        self.known.truncate(REMEMBERED - 1);
        self.known.push_front(Known { islands, settings, from, ordered: ordered.clone(), to: *torch });
        ordered
    }
}

/// Islands are visited like closed passes: wherever a pass of their first stage may begin.
fn islands_in_order(mut islands: Vec<Fill>, settings: &OrderSettings, from: DVec2) -> Vec<Fill> {
    for fill in &mut islands {
        fill.stages.retain(|stage| !stage.is_empty());
    }
    islands.retain(|fill| !fill.stages.is_empty());
    let first = |fill: &Fill| if fill.fixed_order { 1 } else { usize::MAX };
    let starts = |fill: &Fill| {
        let passes = fill.stages.iter().take(1).flatten().take(first(fill));
        Stop::anywhere(passes.flat_map(|pass| settings.stop(pass).gates().map(|gate| gate.enter).collect::<Vec<_>>()))
    };
    let stops: Vec<Stop> = islands.iter().map(starts).collect();
    let tour = settings.method.tour(&stops, Ends::From(from));
    let mut islands: Vec<Option<Fill>> = islands.into_iter().map(Some).collect();
    tour.iter().filter_map(|visit| islands.get_mut(visit.stop)?.take()).collect()
}

fn stage_in_order(stage: Vec<Path>, settings: &OrderSettings, from: DVec2) -> Vec<Path> {
    let stops: Vec<Stop> = stage.iter().map(|pass| settings.stop(pass)).collect();
    let tour = settings.method.tour(&stops, Ends::From(from));
    let mut stage: Vec<Option<Path>> = stage.into_iter().map(Some).collect();
    tour.iter().filter_map(|visit| Some(begin_at(stage.get_mut(visit.stop)?.take()?, visit.enter))).collect()
}

fn begin_at_seam(pass: Path, settings: &OrderSettings) -> Path {
    match settings.seam_of(&pass) {
        Some(seam) => begin_at(pass, seam),
        None => pass,
    }
}

/// The pass, starting at the given point on it.
pub fn begin_at(mut pass: Path, start: DVec2) -> Path {
    if pass.closed {
        let index = vertex_at(&mut pass, start);
        pass.points.rotate_left(index);
        pass.width.rotate_left(index);
    } else if pass.points.last() == Some(&start) && pass.points.first() != Some(&start) {
        pass.points.reverse();
        pass.width.reverse();
    }
    pass
}

/// Index of the vertex of a closed pass at a point of its path; inserted if there is none yet.
fn vertex_at(pass: &mut Path, point: DVec2) -> usize {
    let path = pass.path();
    let distance = |(a, b): (DVec2, DVec2)| tour::nearest_on(a, b, point).distance_squared(point);
    let edges = path.windows(2).map(|w| (w[0], w[1]));
    let (edge, _) = edges.map(distance).enumerate().min_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or_default();
    let next = (edge + 1) % pass.points.len().max(1);
    for end in [edge, next] {
        if pass.points.get(end).is_some_and(|p| p.distance(point) < SAME_POINT_MM) {
            return end;
        }
    }
    pass.points.insert(edge + 1, point);
    pass.width.split(edge);
    edge + 1
}

/// A start nearer to a vertex than this is that vertex, mm.
const SAME_POINT_MM: f64 = 1e-3;

/// Position of the torch after a pass.
fn last_point(pass: &Path) -> Option<DVec2> {
    if pass.closed { pass.points.first().copied() } else { pass.points.last().copied() }
}
