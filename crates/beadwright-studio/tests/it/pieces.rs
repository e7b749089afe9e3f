//! The part in the colours of its bodies, as pixels.

use beadwright::directions::Metal;
use beadwright::glam::{DVec2, DVec3};
use beadwright::model::Mesh;
use beadwright::model::solid::Solid;
use beadwright::palette::{BODIES, missing};
use beadwright::planar::{Polygon, Ring};
use beadwright_studio::view3d::{Camera, Scanned, Scene, StandardView, Style, View3d, headless};
use std::sync::Arc;

/// The cube that is there already.
const STOCK: usize = 6;
const PIXELS: [u32; 2] = [200, 100];

/// A cube of 10 mm that begins at this x.
fn cube(x: f64) -> Mesh {
    let corners = [(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0)];
    let outline = Polygon::simple(Ring::new(corners.map(|(dx, y)| DVec2::new(x + dx, y)).to_vec()));
    let Solid { vertices, triangles } = Solid::extrude(&outline, 0.0, 10.0);
    Mesh::from_triangles(vertices, triangles).0
}

#[test]
fn every_body_has_its_own_colour_colours_repeat_and_stock_is_grey() {
    let Ok(state) = headless() else {
        println!("pictures are skipped: there is nothing to draw with");
        return;
    };
    let of = |number: usize| Metal { mesh: cube(12.0 * number as f64), body: number, stock: number == STOCK };
    let cubes: Vec<Metal> = (0..10).map(of).collect();
    let mut scene = Scene::default();
    scene.show_pieces(Scanned::pieces(&cubes).map(Arc::new));
    let mut view = View3d::default();
    view.camera = Camera { orthographic: true, ..Camera::default() };
    view.camera.set_view(StandardView::Top);
    let size = DVec2::new(f64::from(PIXELS[0]), f64::from(PIXELS[1]));
    view.camera.fit((DVec3::ZERO, DVec3::new(118.0, 10.0, 10.0)), size);
    let mut seen = |pieces: bool| {
        let style = Style { pieces, ..Style::default() };
        let (width, _, pixels) = view.picture(&state, &scene, &style, PIXELS).unwrap();
        let at = |number: usize| {
            let middle = DVec3::new(12.0 * number as f64 + 5.0, 5.0, 10.0);
            let place = view.camera.project(middle, size).unwrap();
            let first = 4 * (place.y as usize * width as usize + place.x as usize);
            DVec3::from_array([0, 1, 2].map(|c| f64::from(pixels[first + c])))
        };
        (0..cubes.len()).map(at).collect::<Vec<_>>()
    };
    let shown = seen(true);
    for (number, ink) in shown.iter().enumerate() {
        // Light changes the length of a colour, hardly its direction.
        let off = |colour: [u8; 3]| ink.angle_between(DVec3::from_array(colour.map(f64::from)));
        if number == STOCK {
            assert!(off(missing(true)) < 0.03, "{number}: {ink} is not grey");
            continue;
        }
        let own = off(BODIES[number % BODIES.len()]);
        assert!(own < 0.12, "{number}: {ink} is off by {own:.2}");
        let nearest = BODIES.into_iter().map(off).fold(f64::MAX, f64::min);
        assert_eq!(own, nearest, "{number}: {ink}");
    }
    assert!(seen(false).iter().zip(shown).all(|(hidden, shown)| hidden.distance(shown) > 20.0));
}
