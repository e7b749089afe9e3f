//! The bent shape in 3-D is the one that the library computes.

use beadwright::distort::{Distortion, Shape};
use beadwright::distortion::{Clamps, Setup, Welding};
use beadwright::layer::Layer;
use beadwright::model::Model;
use beadwright::profile::Profile;
use beadwright::task::Task;
use beadwright::weld::Torch;
use beadwright_studio::distortion::{Distorted, Figure};
use beadwright_studio::view3d::{Bead, Colour, LayerBeads, Scene, Style, View3d, headless};
use glam::{DVec2, Vec3};
use std::sync::Arc;

/// A small part, planned.
struct Planned {
    profile: Profile,
    layers: Vec<Arc<Layer>>,
    scene: Scene,
}

fn planned() -> Planned {
    let profile = Profile::built_in("cmt-al2319-kuka").unwrap();
    let model = Model::read(&beadwright::example::find("cross").unwrap().stl(), &Task::new()).unwrap();
    let part = model.place(&Default::default(), None, profile.bead.width).unwrap();
    let plan = beadwright::plan::plan("cross", part.mesh().unwrap(), &profile, &Task::new()).unwrap();
    let (mut scene, mut torch) = (Scene::default(), Torch::of(&profile.weld_settings()));
    for layer in &plan.layers {
        scene.set_layer(layer.index, Arc::new(LayerBeads::of(layer, &mut torch)));
    }
    Planned { profile, layers: plan.layers.into_iter().map(Arc::new).collect(), scene }
}

impl Planned {
    fn distorted(&self, clamps: Clamps) -> Distorted {
        Distorted::of(&self.layers, self.scene.layers(), &self.profile, clamps, &Task::new()).unwrap()
    }

    /// What the command computes.
    fn built(&self, clamps: Clamps) -> Distortion {
        let layers: Vec<Layer> = self.layers.iter().map(|layer| (**layer).clone()).collect();
        let welding = Welding::of(&layers, &self.profile).unwrap();
        Setup { clamps, ..Setup::default() }.build(&welding, &self.profile, &Task::new()).unwrap()
    }

    /// All segments as they are drawn.
    fn beads(&self) -> Vec<Bead> {
        let layers = (0..self.layers.len()).filter_map(|layer| self.scene.drawn_layer(layer));
        layers.flat_map(|layer| layer.beads().to_vec()).collect()
    }
}

#[test]
fn the_figures_are_those_of_the_command() {
    let planned = planned();
    for clamps in [Clamps::Corners, Clamps::None] {
        let (distorted, built) = (planned.distorted(clamps), planned.built(clamps));
        let same = |figure: &Figure, shape: &Shape| {
            assert_eq!((figure.lift, figure.deviation), (shape.lift, shape.deviation));
            let most = shape.moved.iter().map(|moved| moved.length()).fold(0.0, f64::max);
            assert_eq!(figure.bent.most(), most);
        };
        same(&distorted.clamped, &built.clamped);
        same(&distorted.released, &built.released);
    }
}

#[test]
fn beads_are_drawn_moved_as_computed_and_as_planned_at_zero() {
    let mut planned = planned();
    let (distorted, built) = (planned.distorted(Clamps::Corners), planned.built(Clamps::Corners));
    let plan: Vec<Arc<LayerBeads>> = planned.scene.layers().iter().flatten().cloned().collect();
    let bent = &distorted.released.bent;
    planned.scene.bend(Some((bent, 0.0)));
    for (i, straight) in plan.iter().enumerate() {
        let drawn = planned.scene.drawn_layer(i).unwrap();
        assert_eq!(drawn.seconds(), straight.seconds());
        for (piece, bead) in straight.beads().iter().enumerate() {
            let parts = &drawn.beads()[drawn.segments_of(piece)];
            assert_eq!((parts[0].from(), parts[parts.len() - 1].to()), (bead.from(), bead.to()));
            let length: f64 = parts.iter().map(Bead::length).sum();
            assert!((length - bead.length()).abs() < 1e-3, "layer {i}: {length} of {} mm", bead.length());
            assert!(parts.iter().all(|part| part.length() < 1.01 * built.grid.size.x), "too long to bend");
        }
    }
    let at_zero = planned.beads();
    let middle = |place: Vec3, bead: &Bead| (place - 0.5 * bead.height() * Vec3::Z).as_dvec3();
    for times in [1.0, 20.0] {
        planned.scene.bend(Some((bent, times)));
        let moved = planned.beads();
        assert_eq!(moved.len(), at_zero.len());
        for (bead, before) in moved.iter().zip(&at_zero) {
            let wanted = times * built.at(&built.released, middle(before.to(), before)).unwrap();
            let found = (bead.to() - before.to()).as_dvec3();
            assert!(found.abs_diff_eq(wanted, 1e-4), "{found} is not {wanted} mm");
        }
    }
    planned.scene.bend(None);
    let same = |(i, layer): (usize, &Arc<LayerBeads>)| Arc::ptr_eq(planned.scene.drawn_layer(i).unwrap(), layer);
    assert!(plan.iter().enumerate().all(same), "the plan does not come back");
}

#[test]
fn at_zero_the_picture_is_that_of_the_plan() {
    let Ok(state) = headless() else { return };
    let mut planned = planned();
    let distorted = planned.distorted(Clamps::Corners);
    let mut view = View3d::default();
    let corners = planned.scene.outline();
    view.camera.fit_points(&corners, DVec2::new(600.0, 450.0));
    let style = Style { mesh: false, ..Style::default() };
    let mut picture = |bend: Option<f64>| {
        planned.scene.bend(bend.map(|times| (&distorted.released.bent, times)));
        view.picture(&state, &planned.scene, &style, [600, 450]).unwrap().2
    };
    let plan = picture(None);
    let off =
        |bytes: &[u8]| bytes.iter().zip(&plan).filter(|(a, b)| a.abs_diff(**b) > 24).count() as f64 / plan.len() as f64;
    let (zero, moved) = (off(&picture(Some(0.0))), off(&picture(Some(50.0))));
    assert!(zero < 0.002 && moved > 0.05, "{zero} of the picture at 0, {moved} at 50");
}

#[test]
fn the_colours_reach_from_nothing_to_the_largest_movement() {
    let mut planned = planned();
    let bent = planned.distorted(Clamps::Corners).clamped.bent;
    assert_eq!(planned.scene.value_range(Colour::Movement), None);
    planned.scene.bend(Some((&bent, 1.0)));
    assert_eq!(planned.scene.value_range(Colour::Movement), Some((0.0, bent.most())));
    assert!(bent.most() > 0.0 && bent.most() < 5.0, "{} mm", bent.most());
}

#[test]
fn what_cannot_be_computed_says_why_and_what_to_do() {
    let Planned { mut profile, layers, scene } = planned();
    profile.substrate = None;
    let refused = Distorted::of(&layers, scene.layers(), &profile, Clamps::None, &Task::new());
    let sentence = refused.err().unwrap();
    assert!(sentence.contains("[substrate]") && sentence.contains("Add it"), "{sentence}");
}
