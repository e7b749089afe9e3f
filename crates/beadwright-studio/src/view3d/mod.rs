//! stub until the real one is merged
pub mod beads {
    use beadwright::plan::Layer;
    use glam::DVec3;
    pub struct LayerBeads(Option<DVec3>);
    impl LayerBeads {
        pub fn of(layer: &Layer, _: f64, _: f64, from: Option<DVec3>) -> Self {
            Self(layer.passes.last().and_then(|p| p.end()).or(from))
        }
        pub fn end(&self) -> Option<DVec3> {
            self.0
        }
    }
}
use std::sync::Arc;
#[derive(Default)]
pub struct Scene;
impl Scene {
    pub fn set_layer(&mut self, _: usize, _: Arc<beads::LayerBeads>) {}
    pub fn set_mesh(&mut self, _: Option<Arc<beadwright::model::Mesh>>) {}
    pub fn clear_layers(&mut self) {}
    pub fn set_values(&mut self, _: usize, _: Arc<[f32]>) {}
    pub fn total_seconds(&self) -> f64 {
        0.0
    }
}
#[derive(Default)]
pub struct View3d;
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Colour {
    #[default]
    Kind,
}
pub struct Position {
    pub layer: usize,
}
impl Scene {
    pub fn at_time(&self, _: f64) -> Option<Position> {
        None
    }
    pub fn part_of_layer(&self, _: &Position) -> f64 {
        1.0
    }
    pub fn seconds_before(&self, _: usize) -> f64 {
        0.0
    }
}
impl View3d {
    pub fn fit_next(&mut self) {}
    pub fn look(&mut self, _: crate::actions::Action) {}
}
pub(crate) fn bar(_: &mut crate::app::Studio, _: &mut eframe::egui::Ui) {}
pub(crate) fn show(_: &mut crate::app::Studio, _: &mut eframe::egui::Ui) {}
impl crate::app::Studio {
    pub(crate) fn save_picture(&mut self, _: &std::path::Path) {}
}
