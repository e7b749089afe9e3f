//! Which parts of the scene are shown, and in which colours.

use super::lie::Stance;
use super::pick::Pick;
use super::section::Section;
use super::shape::{Floor, Shape};
use glam::DVec2;
use std::ops::RangeInclusive;

/// What the colour of a bead means.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Colour {
    /// The kind of its pass.
    #[default]
    Kind,
    /// The order of deposition.
    Order,
    /// The deposition speed, mm/s.
    Speed,
    /// The width of the bead, mm.
    Width,
    /// The height error, mm, as given to [`super::Scene::set_values`].
    HeightError,
    /// The time since the start of the program, s.
    Time,
    /// The temperature of the metal where the pass begins, °C.
    Temperature,
    /// How far the layer leans from level there, as the part is held, °.
    OffLevel,
    /// How far the metal moves where plate and part are bent, mm.
    Movement,
    /// Which of the bodies of a division it belongs to; the colours of the part, not of beads.
    Body,
}

/// The plate on which the part is built; its top is z = 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plate {
    /// Lowest x and y, mm.
    pub low: DVec2,
    /// Highest x and y, mm.
    pub high: DVec2,
    /// Thickness, mm.
    pub thickness: f64,
}

/// What is shown and how. A picture is rendered again only when this, the camera, the size or the scene changed.
#[derive(Debug, Clone, PartialEq)]
pub struct Style {
    /// What the colour of a bead means.
    pub colour: Colour,
    /// The values at the two ends of the colours, where they are not the least and the largest of the scene.
    pub range: Option<(f64, f64)>,
    /// Whether the model is shown: solid by itself, translucent around beads.
    pub mesh: bool,
    /// Whether the scan is shown, coloured by its deviation; then only the edges of the model are.
    pub scan: bool,
    /// Whether the part is shown in the colours of its bodies; then only the edges of the model are shown besides.
    pub pieces: bool,
    /// Whether the bent plate is shown, in the colours of its movement; then only the edges of the model are.
    pub bent: bool,
    /// Whether travels (moves with the arc off) are shown.
    pub travels: bool,
    /// Whether starts and ends of passes are marked.
    pub starts: bool,
    /// The first layer, from 0, whose travels, starts and ends are shown.
    pub marks_from: usize,
    /// Whether beads are shown.
    pub beads: bool,
    /// The layers shown, from 0.
    pub layers: RangeInclusive<usize>,
    /// How many segments of the last of those layers are shown; `None` for all.
    pub segments_of_last: Option<usize>,
    /// A plane that cuts away what lies beyond it.
    pub section: Option<Section>,
    /// The plate below the part.
    pub plate: Option<Plate>,
    /// Robot, positioner and table; in the part's space.
    pub around: Vec<Shape>,
    /// The floor on which they stand; the grid below the part gives way to its own.
    pub floor: Option<Floor>,
    /// Where the torch is drawn.
    pub torch: Option<Stance>,
    /// The highlighted pass, and a segment in it.
    pub highlight: Option<Pick>,
    /// Whether the theme is dark.
    pub dark: bool,
}

impl Default for Style {
    fn default() -> Self {
        Self {
            colour: Colour::Kind,
            range: None,
            mesh: true,
            scan: false,
            pieces: false,
            bent: false,
            travels: false,
            starts: false,
            marks_from: 0,
            beads: true,
            layers: 0..=usize::MAX,
            segments_of_last: None,
            section: None,
            plate: None,
            around: Vec::new(),
            floor: None,
            torch: None,
            highlight: None,
            dark: true,
        }
    }
}

impl Style {
    /// How many of the `segments` of a layer are shown.
    pub(super) fn shown(&self, layer: usize, segments: usize) -> usize {
        if !self.layers.contains(&layer) {
            return 0;
        }
        let last = layer == *self.layers.end();
        self.segments_of_last.filter(|_| last).map_or(segments, |limit| limit.min(segments))
    }
}
