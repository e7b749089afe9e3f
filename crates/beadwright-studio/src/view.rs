//! What is shown, and how. None of it belongs to the project.

use crate::adaptation::Adaptation;
use crate::view2d::Show;
use crate::view3d::{Colour, Grip, Scene, Section, Stance};
use beadwright::distortion::Clamps;
use glam::{DVec2, DVec3};

/// Which view fills the window.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Mode {
    /// Part and beads.
    #[default]
    Solid,
    /// One layer.
    Layer,
    /// One layer of two strategies.
    Compare,
}

/// Which side panel is open on the right.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Side {
    /// Totals and the chosen bead.
    #[default]
    Totals,
    /// What the checks found.
    Findings,
    /// Curves.
    Plots,
    /// The lines of the program.
    Program,
    /// Divisions of the part into bodies.
    Directions,
    /// A scan of the unfinished build, and the layers that follow.
    Adapt,
    /// What can be exported.
    Export,
}

/// How plate and part are shown as they bend.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Bend {
    /// Whether they are shown bent.
    pub shown: bool,
    /// Where clamps hold the plate.
    pub clamps: Clamps,
    /// Whether they are shown on the clamps, not released.
    pub clamped: bool,
    /// How many times as large as computed the movement is drawn; as suits the part while nobody has chosen it.
    pub times: Option<f64>,
}

/// The marked place of a finding.
#[derive(Debug, Clone, PartialEq)]
pub struct Pin {
    /// Its layer, from 0.
    pub layer: usize,
    /// Where on its layer, mm; unrolled where the layer is not level.
    pub on_layer: DVec2,
    /// Where in space, mm.
    pub at: DVec3,
    /// The finding's text.
    pub text: String,
}

/// The state of the views.
#[derive(Debug, Clone, PartialEq)]
pub struct ViewState {
    /// Which view fills the window.
    pub mode: Mode,
    /// The open panel.
    pub side: Side,
    /// Lowest layer shown, from 0.
    pub first: usize,
    /// Highest layer shown, the one in view, from 0.
    pub last: usize,
    /// How much of the highest layer is shown, 0 to 1 of its pieces.
    pub progress: f64,
    /// Whether the torch is playing.
    pub playing: bool,
    /// How many times faster than the robot the torch plays.
    pub rate: f64,
    /// Time the torch has reached while it plays, s from the start of the program.
    pub seconds: f64,
    /// Where the torch is while it plays.
    pub torch: Option<Stance>,
    /// What the colours mean.
    pub colour: Colour,
    /// The values at the two ends of the colours that were chosen by hand, and for which colours.
    pub range: Option<(Colour, [f64; 2])>,
    /// Whether the part is shown.
    pub mesh: bool,
    /// Whether the scan is shown instead of the beads, where there is one.
    pub scan: bool,
    /// Whether the part within a preform is shown instead of the beads.
    pub stock: bool,
    /// Whether travels, starts and ends are shown for all layers, not only for the highest.
    pub all_marks: bool,
    /// Whether the projection is parallel, not in perspective.
    pub parallel: bool,
    /// Whether the plate below the part is shown.
    pub plate: bool,
    /// How plate and part are shown as they bend.
    pub bend: Bend,
    /// The division of the part that is shown in place of the beads, by its place among those that were found.
    pub division: Option<usize>,
    /// The scan of the unfinished build that is looked at.
    pub adapt: Option<Adaptation>,
    /// Whether the robot's arm is shown.
    pub robot: bool,
    /// Whether the next click in 3-D chooses the face on which the part is laid.
    pub laying: bool,
    /// Whether the part can be moved and turned by handles in 3-D.
    pub placing: bool,
    /// The handle that is being dragged.
    pub grip: Option<Grip>,
    /// Whether strategies are compared in 3-D, not layer by layer.
    pub compare_solid: bool,
    /// The section through the part.
    pub section: Option<Section>,
    /// What else is shown.
    pub show: Show,
    /// The finding whose place is marked.
    pub pin: Option<Pin>,
    /// The chosen bead: layer, pass, piece.
    pub chosen: Option<(usize, usize, usize)>,
    /// The line of the program that was last brought into view.
    pub listed: Option<usize>,
    /// The file of the program that is shown, counted from 0; the one that the torch is in while none is chosen.
    pub file: Option<usize>,
    /// The dialect to write.
    pub dialect: String,
    /// The folder to write into; if empty, the user is asked for one.
    pub folder: String,
    /// The robot cell to check the plan with.
    pub cell: String,
    /// Whether it was chosen by hand rather than by the profile.
    pub cell_chosen: bool,
    /// The text searched for among the parameters.
    pub search: String,
    /// The path that is typed where there is no dialog.
    pub typed: String,
    /// Whether the list of keys is shown.
    pub keys: bool,
    /// Whether the first steps are shown.
    pub first_steps: bool,
    /// Whether the table of several models is shown.
    pub batch: bool,
    /// Whether it is shown what this program is.
    pub about: bool,
    /// The layer wanted as the highest one; the top layer if none is wanted, or while there are fewer layers.
    wanted: Option<usize>,
    /// The layer wanted before the view switched to the layer of the chosen bead, and that layer.
    left: Option<(Option<usize>, usize)>,
}

impl Default for ViewState {
    fn default() -> Self {
        Self {
            mode: Mode::Solid,
            side: Side::Totals,
            first: 0,
            last: 0,
            progress: 1.0,
            playing: false,
            rate: 20.0,
            seconds: 0.0,
            torch: None,
            colour: Colour::Kind,
            range: None,
            mesh: true,
            scan: true,
            stock: false,
            all_marks: false,
            parallel: false,
            plate: true,
            bend: Bend::default(),
            division: None,
            adapt: None,
            robot: false,
            laying: false,
            placing: false,
            grip: None,
            compare_solid: false,
            section: None,
            show: Show::default(),
            pin: None,
            chosen: None,
            listed: None,
            file: None,
            dialect: "krl".to_owned(),
            folder: String::new(),
            cell: beadwright::robot::cell::BUILT_IN[0].0.to_owned(),
            cell_chosen: false,
            search: String::new(),
            typed: String::new(),
            keys: false,
            first_steps: false,
            about: false,
            batch: false,
            wanted: None,
            left: None,
        }
    }
}

impl ViewState {
    /// Shows all of a new part.
    pub fn reset(&mut self) {
        let (first, last, progress) = (0, 0, 1.0);
        let (laying, placing, grip) = (false, false, None);
        let (wanted, left, chosen, torch, section) = (None, None, None, None, None);
        let shown = Self { wanted, left, first, last, progress, chosen, torch, section, ..self.clone() };
        let (bend, division, adapt, range) = (Bend::default(), None, None, None);
        *self = Self { laying, placing, grip, pin: None, bend, division, adapt, range, ..shown };
    }

    /// Keeps the range within the existing layers.
    pub fn follow(&mut self, layers: usize) {
        if layers == 0 {
            return;
        }
        self.last = self.wanted.unwrap_or(usize::MAX).min(layers - 1);
        self.first = self.first.min(self.last);
    }

    /// Makes a layer the one in view.
    pub fn look_at(&mut self, layer: usize) {
        self.last = layer;
        self.first = self.first.min(layer);
        self.progress = 1.0;
        self.wanted = Some(layer);
        self.torch = None;
        self.playing = false;
    }

    /// Switches to a view. Views of one layer show that of the chosen bead; back in 3-D, the layers are shown as
    /// before.
    pub fn switch(&mut self, mode: Mode) {
        if mode == self.mode {
            return;
        }
        self.mode = mode;
        let elsewhere = self.chosen.map(|(layer, ..)| layer).filter(|layer| *layer != self.last && !self.playing);
        match (mode, elsewhere, self.left.take()) {
            (Mode::Solid, _, Some((wanted, layer))) if self.last == layer => self.wanted = wanted,
            (Mode::Layer | Mode::Compare, Some(layer), _) => {
                self.left = Some((self.wanted, layer));
                self.look_at(layer);
            }
            _ => {}
        }
    }

    /// Plays the torch from where it paused, or else from the start of the layer in view; or stops it.
    pub fn play(&mut self, on: bool, scene: &Scene) {
        self.playing = on;
        let waits = self.torch.is_some() && self.seconds < scene.total_seconds();
        if on && !waits {
            self.seconds = scene.seconds_before(self.last);
        }
    }

    /// Advances the torch after `passed` seconds of real time; it stops at the end of the last layer.
    pub fn advance(&mut self, passed: f64, scene: &Scene) {
        self.go_to(self.seconds + passed * self.rate, scene);
        self.playing = self.torch.is_some() && self.seconds < scene.total_seconds();
    }

    /// The time that what is shown has reached, s from the start of the program.
    pub fn now(&self, scene: &Scene) -> f64 {
        if self.torch.is_some() {
            return self.seconds;
        }
        let Some(layer) = scene.layer(self.last) else { return 0.0 };
        let shown = (self.progress * layer.len() as f64).round() as usize;
        let within =
            if shown < layer.len() { layer.times(shown).map_or(0.0, |(begin, _)| begin) } else { layer.seconds() };
        scene.seconds_before(self.last) + within
    }

    /// Takes the torch to a time, s from the start of the program, and stops it there.
    pub fn go_to(&mut self, seconds: f64, scene: &Scene) {
        self.seconds = seconds.min(scene.total_seconds());
        let Some(at) = scene.at_time(self.seconds) else {
            self.playing = false;
            return;
        };
        let pieces = scene.layer(at.layer).map_or(1, |layer| layer.len().max(1));
        self.look_at(at.layer);
        self.progress = at.segment as f64 / pieces as f64;
        self.torch = Some(at.torch);
    }

    /// Moves one layer up or down.
    pub fn step_layer(&mut self, by: isize, layers: usize) {
        self.look_at(self.last.saturating_add_signed(by).min(layers.saturating_sub(1)));
    }
}
