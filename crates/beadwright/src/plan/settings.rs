//! The settings of every stage of a plan, made from a profile once, before anything is planned. Only this file and the
//! functions by which a plan is asked for see a profile.

use super::deposit_settings;
use super::emitter::Laying;
use super::filled::Filling;
use super::judged::AsWelded;
use super::level_layers::Sharing;
use super::relight::Relighting;
use super::slicing::Slicing;
use super::support::Ground;
use super::turns::Unrolling;
use super::warm::Warming;
use crate::bead::MassBalance;
use crate::bead::pace::PaceSettings;
use crate::bead::wall::{WallBead, WallError};
use crate::fill::StrategyName;
use crate::fill::around::Around;
use crate::metrics::Metrics;
use crate::model::wall_curves::CurvesAre;
use crate::process::{Dot, TorchShape};
use crate::profile::{CheckLimits, LayersSection, Profile};
use crate::program::{ProgramSettings, Programmer, Turning};
use crate::weld::WeldSettings;

/// What planning and checking take from a profile. Each stage takes its own settings from here; what runs several stages
/// takes all.
#[derive(Debug, Clone)]
pub(crate) struct PlanSettings<'p> {
    /// Name of the profile.
    pub(super) profile: &'p str,
    /// What fills the layers, unless a plan is made with another strategy.
    pub(super) strategy: StrategyName,
    /// Width of the nominal bead, mm.
    pub(crate) bead_width: f64,
    /// How high the layers are, and how they lie in space.
    pub(crate) layers: &'p LayersSection,
    /// How layers that go around an axis are unrolled.
    pub(crate) unrolling: Unrolling<'p>,
    /// How a part is cut into layers.
    pub(super) slicing: Slicing<'p>,
    /// What curves side by side stand for.
    pub(super) curves: Option<CurvesAre>,
    /// The wall whose heights determine where the layers of a solid lie; `None` where they are not predicted.
    pub(super) wall: Result<Option<WallBead>, WallError>,
    /// The same for a wall given by curves.
    pub(super) curve_wall: Result<WallBead, WallError>,
    /// How islands are filled.
    pub(super) filling: Filling<'p>,
    /// How metal is shared out within layers as high as their metal; `None` where layers are not.
    pub(super) sharing: Option<Sharing<'p>>,
    /// Whether closed walls become the turns of one helix.
    pub(super) helix: bool,
    /// How passes are cut that are too long for a program.
    pub(super) relighting: Relighting,
    /// What counts as metal below a pass.
    pub(super) ground: Ground<'p>,
    /// How the part warms up.
    pub(super) warming: Warming,
    /// How layers are welded, for the deposit model.
    pub(crate) welded: AsWelded<'p>,
    /// Arc, moves and times.
    pub(crate) weld: WeldSettings,
    /// A pass that takes less time than this, s, ends before its arc is steady.
    pub(crate) soonest_arc_end: f64,
    /// Limits beyond which a layer is doubtful.
    pub(crate) limits: &'p CheckLimits,
    /// The room that the torch takes, if known.
    pub(super) torch: Option<TorchShape>,
    /// The totals before any layer is counted.
    pub(super) metrics: Metrics,
    /// What does not fit together in the profile, as sentences.
    pub(super) notes: Vec<String>,
    /// Why no program should be written with it, as sentences.
    pub(crate) forbidden: Vec<String>,
    /// How paths become moves of a program.
    pub(crate) program: &'p ProgramSettings,
    /// Balance of the wire fed and the nominal bead laid.
    pub(crate) balance: MassBalance,
}

impl<'p> PlanSettings<'p> {
    /// The settings of a part, or of a body by its own profile.
    pub(crate) fn of(profile: &'p Profile) -> Self {
        Self {
            profile: &profile.name,
            strategy: profile.fill.strategy,
            bead_width: profile.bead.width,
            layers: &profile.layers,
            unrolling: Unrolling::of(profile),
            slicing: Slicing::of(profile),
            curves: profile.wall.curves,
            wall: profile.wall_bead(),
            curve_wall: profile.single_wall(),
            filling: Filling::of(profile),
            sharing: profile.is_level().then(|| Sharing::of(profile)),
            helix: profile.wall.helix,
            relighting: Relighting::of(profile),
            ground: Ground::of(profile),
            warming: Warming::of(profile),
            welded: AsWelded::of(profile),
            weld: profile.weld_settings(),
            soonest_arc_end: profile.soonest_arc_end(),
            limits: &profile.check,
            torch: profile.torch,
            metrics: Metrics::new(profile),
            notes: profile.notes(),
            forbidden: profile.forbidden(),
            program: &profile.program,
            balance: profile.mass_balance(),
        }
    }

    /// Whether layers are as high as their metal.
    pub(crate) fn is_level(&self) -> bool {
        self.sharing.is_some()
    }

    /// Whether a printer lays the beads.
    pub(crate) fn prints(&self) -> bool {
        self.ground.prints
    }

    /// Shorter passes are left out, mm.
    pub(crate) fn shortest_pass(&self) -> f64 {
        self.filling.section.min_pass_length
    }

    /// What determines the pace of beads.
    pub(crate) fn paces(&self) -> PaceSettings<'p> {
        self.filling.laying.paces
    }

    /// The dot that the process lays, if it lays any.
    pub(crate) fn dot(&self) -> Option<Dot> {
        self.filling.laying.dot
    }

    /// Makes the instructions of layers, from the first one on.
    pub(crate) fn programmer(&self) -> Programmer {
        self.relighting.programmer.clone()
    }
}

impl<'p> Slicing<'p> {
    pub(super) fn of(profile: &'p Profile) -> Self {
        Self {
            options: profile.slice_options(),
            chart: &profile.layers.chart,
            thickest: profile.layers.window().1,
            surface: profile.slice.surface,
            bead_width: profile.bead.width,
        }
    }
}

impl<'p> Filling<'p> {
    pub(super) fn of(profile: &'p Profile) -> Self {
        // Walls are welded along their middle, not as a helix.
        let helix = profile.fill.around == Some(Around::Helix) && profile.fill.strategy != StrategyName::Wall;
        // The axis that carries the part turns it under the arc.
        let positioner = profile.program.positioner.as_ref();
        let follows = positioner.filter(|positioner| positioner.turning == Turning::Follow);
        let axis = follows.and_then(|positioner| positioner.axes.last());
        let most = axis.map_or(f64::INFINITY, |axis| (axis.limits[1] - axis.limits[0]) / 360.0);
        Self {
            first: profile.fill_settings(0),
            section: &profile.fill,
            unrolling: Unrolling::of(profile),
            most_turns: helix.then_some(most),
            laying: Laying::of(profile),
            process: &profile.process,
            soonest_arc_end: profile.soonest_arc_end(),
            is_level: profile.is_level(),
            height: profile.layers.height,
            deposit: deposit_settings(profile),
            still: Metrics::new(profile).unturned(),
        }
    }
}

impl<'p> Laying<'p> {
    fn of(profile: &'p Profile) -> Self {
        Self { order: profile.order_settings(0), paces: profile.pace_settings(), dot: profile.dot() }
    }
}

impl<'p> Sharing<'p> {
    fn of(profile: &'p Profile) -> Self {
        Self {
            deposit: deposit_settings(profile),
            height: profile.layers.height,
            law: &profile.bead.law,
            width_limits: profile.fill_settings(0).wall.width_limits,
        }
    }
}

impl Relighting {
    fn of(profile: &Profile) -> Self {
        Self {
            most: profile.longest_pass(),
            overlap: profile.start_stop.end_overlap.max(profile.bead.width),
            programmer: profile.programmer(),
        }
    }
}

impl<'p> Ground<'p> {
    fn of(profile: &'p Profile) -> Self {
        let is_solid = profile.fill.infill_density >= 1.0;
        Self { unrolling: Unrolling::of(profile), is_solid, prints: profile.prints() }
    }
}

impl Warming {
    fn of(profile: &Profile) -> Self {
        let (by_heat, interpass) = (profile.bead.by_heat, profile.interpass);
        let matters = interpass.is_some() || by_heat.is_some();
        let heat = profile.heat_settings().ok().filter(|_| matters);
        let model = heat.map(|heat| (heat, profile.weld_settings()));
        Self { model, by_heat, interpass, height: profile.layers.height }
    }
}

impl<'p> AsWelded<'p> {
    pub(crate) fn of(profile: &'p Profile) -> Self {
        Self {
            unrolling: Unrolling::of(profile),
            ends: &profile.start_stop,
            bead_height: profile.bead.height,
            fills_layers: profile.fills_layers(),
        }
    }
}

impl<'p> Unrolling<'p> {
    pub(crate) fn of(profile: &'p Profile) -> Self {
        let (bead_width, allowance) = (profile.bead.width, profile.fill.machining_allowance);
        Self { layers: &profile.layers, bead_width, allowance }
    }
}
