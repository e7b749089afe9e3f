//! How robot, positioner, table and floor look in the 3-D view. Sizes that a cell does not give are chosen for the eye.

use crate::view3d::{Floor, Look, Shape};
use beadwright::program::{Held, Positioner};
use beadwright::robot::{Cell, Frame, Joints};
use glam::{DQuat, DVec3};

/// Thickness of a table's top or a positioner's plate, mm.
const TOP: f64 = 35.0;
/// Where a cell's table is less than this above the floor, none is drawn, mm.
const LOW: f64 = 80.0;
/// Between the part and the edge of a positioner's plate, mm; and its least radius.
const EDGE: (f64, f64) = (60.0, 180.0);
/// From the end of the arm's reach to where the floor ends, mm.
const AROUND: f64 = 700.0;

/// The arm in a pose, without its torch, in the robot's frame.
pub fn arm(cell: &Cell, joints: &Joints) -> Vec<Shape> {
    let Some(body) = &cell.body else { return Vec::new() };
    let (arm, base, hand) = (cell.arm(), body.base, body.hand);
    let ([_, shoulder, elbow, wrist], flange) = (arm.links(joints), arm.forward(joints));
    let [one, two, three, four, five, six] = arm.axes(joints);
    let [upper, fore] = [body.upper_arm, body.forearm];
    // Where the forearm begins: beside the elbow, on the line about which it turns.
    let root = four.nearest(elbow);
    let waist = one.nearest(shoulder);
    let at = |height: f64| DVec3::Z * height;
    let (column, neck) = (waist.z * 0.35, (waist.z - upper).max(waist.z * 0.5));
    let hub = if four.along.dot(three.along).abs() > 0.9 { hand } else { fore };
    let face = flange.rotation * DVec3::Z;
    vec![
        Shape::cylinder([at(0.0), at(0.06 * waist.z)], 1.1 * base, Look::Joint),
        Shape::cylinder([at(0.06 * waist.z), at(column)], 0.8 * base, Look::Link),
        Shape::cylinder([at(column), at(column + 0.12 * waist.z)], 0.86 * base, Look::Joint),
        Shape::link([at(neck), shoulder], [0.68 * base, 0.85 * upper], Look::Link),
        Shape::drum(shoulder, two.along, 2.5 * upper, 0.82 * upper, Look::Joint),
        Shape::link([shoulder, elbow], [0.72 * upper, 0.6 * upper], Look::Link),
        Shape::drum(elbow, three.along, 2.1 * fore, 0.72 * fore, Look::Joint),
        Shape::link([elbow, root], [0.7 * fore, 0.7 * hub], Look::Link),
        Shape::drum(root, four.along, 2.2 * hub, 0.78 * hub, Look::Link),
        Shape::link([root, wrist], [0.62 * hub, 0.8 * hand], Look::Link),
        Shape::drum(wrist, five.along, 2.0 * hand, 0.82 * hand, Look::Joint),
        Shape::cylinder([wrist, flange.position], 0.66 * hand, Look::Link),
        Shape::cylinder([flange.position - face * 14.0, six.nearest(flange.position)], 0.8 * hand, Look::Joint),
    ]
}

/// The torch from the flange to where its nozzle begins: the two pieces of its neck, mm.
pub fn torch([flange, bend, nozzle]: [DVec3; 3], radius: f64) -> Vec<Shape> {
    let way = (bend - flange).normalize_or_zero();
    let mount = flange + way * (2.4 * radius).min(0.5 * flange.distance(bend));
    vec![
        Shape::cylinder([flange, mount], 1.3 * radius, Look::Joint),
        Shape::link([mount, bend], [0.72 * radius, 0.6 * radius], Look::Torch),
        Shape::link([bend, nozzle], [0.6 * radius, 0.5 * radius], Look::Torch),
    ]
}

/// The table under the part and what is on it, in the part's space: its top lies `below` the part's origin, mm, the floor `floor`.
/// A table that `turns` stands on a column.
pub fn table(cell: &Cell, below: f64, floor: f64, turns: bool) -> Vec<Shape> {
    let Some(body) = &cell.body else { return Vec::new() };
    let [x, y] = body.table.map(|size| size / 2.0);
    let mut shapes = Vec::new();
    if x > 0.0 && y > 0.0 && floor > LOW {
        let corners = |share: f64, low: f64, high: f64| {
            [DVec3::new(-x * share, -y * share, -low), DVec3::new(x * share, y * share, -high)]
        };
        shapes.push(Shape::block(&Frame::IDENTITY, corners(1.0, below + TOP, below), Look::Table));
        if turns {
            let down = |by: f64| DVec3::Z * -by;
            shapes.push(Shape::cylinder([down(floor), down(below + TOP)], 0.35 * x.min(y), Look::Joint));
        } else {
            shapes.push(Shape::block(&Frame::IDENTITY, corners(0.9, floor, below + TOP), Look::Joint));
        }
    }
    let fixtures = body.fixtures.iter().map(|fixture| [fixture.low, fixture.high].map(DVec3::from));
    shapes.extend(fixtures.map(|corners| Shape::block(&Frame::IDENTITY, corners, Look::Joint)));
    shapes
}

/// A positioner that holds a part, in the part's space: its plate lies `below` the part's origin, mm, the floor `floor` below that
/// with all axes at 0; the part reaches `radius` sideways, mm.
pub fn positioner(positioner: &Positioner, held: &Held, [below, floor, radius]: [f64; 3]) -> Vec<Shape> {
    let part_from_cell = Frame::from(*held).inverse();
    let frame = |angles: [f64; 2]| Frame::from(positioner.held(angles));
    let line = |axis: usize| {
        let axis = positioner.axes.get(axis)?;
        Some((DVec3::from(axis.through), DVec3::from(axis.direction).normalize_or_zero()))
    };
    let Some((first_on, first)) = line(0) else { return Vec::new() };
    let (last_on, last) = line(1).unwrap_or((first_on, first));
    let radius = (radius + EDGE.0).max(EDGE.1);
    // Out of the plate, towards the part.
    let out = if last.z < -0.1 { -last } else { last };
    let top = if out.z > 0.1 { last_on + out * ((-below - last_on.z) / out.z) } else { DVec3::Z * -below };
    let plate = Shape::cylinder([top - DVec3::Z * TOP, top], radius, Look::Table);
    let mut shapes = vec![plate];
    let under = if out.z > 0.1 { top - out * TOP } else { top - DVec3::Z * TOP };
    let shaft = 0.28 * radius;
    let hub = under - (if out.z > 0.1 { out } else { DVec3::Z }) * 90.0;
    if positioner.axes.len() == 1 {
        // What stands still while the part turns.
        let still = |at: DVec3| frame([0.0; 2]).apply(at);
        let (under, hub) = (still(under), still(hub));
        let turned = Shape::cylinder([hub, under], 1.15 * shaft, Look::Joint);
        let foot = hub.with_z(-floor);
        let stand = (hub.z > -floor).then(|| Shape::leg([foot, hub], [1.5 * shaft, 1.1 * shaft], Look::Link));
        let plinth = Shape::cylinder([foot, foot + DVec3::Z * 20.0], 2.2 * shaft, Look::Joint);
        shapes.extend(stand.into_iter().chain([turned, plinth]).map(|shape| shape.moved(&part_from_cell)));
        return shapes;
    }
    // The frame that tilts carries the plate's bearing.
    let carried = part_from_cell.then(&frame([held.angles[0], 0.0]));
    let across = radius + 70.0;
    let on_axis = first_on + first * (hub - first_on).dot(first);
    let mut frame_parts = vec![Shape::cylinder([hub, under], 1.15 * shaft, Look::Joint)];
    let [left, right] = [-across, across].map(|by| (hub + first * by, on_axis + first * by));
    frame_parts.push(Shape::link([left.0, right.0], [0.6 * shaft; 2], Look::Link));
    for (beam, bearing) in [left, right] {
        frame_parts.push(Shape::link([beam, bearing], [0.6 * shaft, 0.75 * shaft], Look::Link));
    }
    shapes.extend(frame_parts.into_iter().map(|shape| shape.moved(&carried)));
    // It turns between two stands on the floor.
    let cell = frame([0.0; 2]);
    let axis = cell.rotation * first;
    for (side, (_, bearing)) in [(-1.0, left), (1.0, right)] {
        let inner = cell.apply(bearing) - axis * (side * 0.5 * shaft);
        let outer = inner + axis * (side * (1.0 * shaft + 90.0));
        let middle = inner.lerp(outer, 0.75);
        let foot = middle.with_z(-floor);
        let mut stand = vec![Shape::cylinder([inner, outer], 0.95 * shaft, Look::Joint)];
        if middle.z > -floor {
            stand.push(Shape::leg([foot, middle], [1.25 * shaft, 0.8 * shaft], Look::Link));
            stand.push(Shape::cylinder([foot, foot + DVec3::Z * 20.0], 1.7 * shaft, Look::Joint));
        }
        shapes.extend(stand.into_iter().map(|shape| shape.moved(&part_from_cell)));
    }
    shapes
}

/// The floor on which the robot stands, in the part's space.
pub fn floor(cell: &Cell, part_from_base: &Frame) -> Floor {
    let part = DVec3::from(cell.part.position).with_z(0.0);
    let half = cell.arm().reach() + AROUND;
    let middle = Frame { position: part / 2.0, rotation: DQuat::IDENTITY };
    Floor { frame: part_from_base.then(&middle), half }
}
