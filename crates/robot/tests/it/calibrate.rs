//! Calibrations from points with noise: the true values are found, and the stated intervals hold them as often as they say.

use bead_robot::calibrate::{AtAngle, Calibrated, Flange, Pair, Place, Touch, axis, base, scanner, tool};
use glam::{DMat3, DQuat, DVec3};

/// Noise of a measured coordinate, mm.
const NOISE: f64 = 0.2;
const DRAWS: usize = 1000;

/// Numbers that are the same in every run: even ones by Lehmer's generator, normal ones by Box and Muller.
struct Random(u64);

impl Random {
    fn even(&mut self) -> f64 {
        self.0 = self.0 * 48_271 % 0x7fff_ffff;
        self.0 as f64 / f64::from(0x7fff_ffff)
    }

    fn normal(&mut self) -> f64 {
        let (a, b) = (self.even(), self.even());
        (-2.0 * a.ln()).sqrt() * (std::f64::consts::TAU * b).cos()
    }

    fn noise(&mut self) -> DVec3 {
        DVec3::new(self.normal(), self.normal(), self.normal()) * NOISE
    }

    fn turn(&mut self) -> DQuat {
        let axis = DVec3::new(self.normal(), self.normal(), self.normal()).normalize();
        DQuat::from_axis_angle(axis, 6.0 * self.even())
    }
}

/// How often intervals held the true value.
#[derive(Default)]
struct Held {
    held: usize,
    all: usize,
}

impl Held {
    fn add(&mut self, off: DVec3, within: DVec3) {
        let inside = |k: usize| off[k].abs() <= within[k];
        self.held += (0..3).filter(|k| inside(*k)).count();
        self.all += 3;
    }

    /// 95 of 100, as far as a thousand draws can say.
    fn is_as_stated(&self, what: &str) {
        let part = self.held as f64 / self.all as f64;
        println!("{what}: {:.1} % of {} intervals hold the true value", 100.0 * part, self.all);
        assert!((0.935..=0.965).contains(&part), "{what}: {part}");
    }
}

#[test]
fn the_tip_of_the_wire_is_found_within_the_stated_interval() {
    let (mut random, mut held, mut worst) = (Random(7), Held::default(), 0.0_f64);
    for _ in 0..DRAWS {
        let (tip, point) = (DVec3::new(40.0, -20.0, 380.0), DVec3::new(1100.0, 80.0, 450.0));
        let poses: Vec<Flange> = (0..8)
            .map(|_| {
                let lean = DQuat::from_rotation_x(3.1 + 0.7 * (random.even() - 0.5) * 2.0)
                    * DQuat::from_rotation_y(0.7 * (random.even() - 0.5) * 2.0);
                let turn = lean * DQuat::from_rotation_z(3.0 * random.even());
                Flange { at: point - turn * tip + random.noise(), turn }
            })
            .collect();
        let found = tool(&poses).unwrap();
        held.add(found.tip - tip, found.within);
        worst = worst.max(found.tip.distance(tip));
        assert!(found.touched.distance(point) < 3.0 && found.residuals.rms < 1.0, "{found:?}");
    }
    println!("worst {worst:.2} mm");
    held.is_as_stated("tool");
}

#[test]
fn the_axis_of_a_positioner_is_found_within_the_stated_interval() {
    for angles in [[-80.0, -50.0, -20.0, 10.0, 40.0, 70.0], [0.0, 60.0, 120.0, 180.0, 240.0, 300.0]] {
        let (mut random, mut direction, mut centre) = (Random(11), Held::default(), Held::default());
        for _ in 0..DRAWS {
            let turn = random.turn();
            let (way, middle) = (turn * DVec3::Z, DVec3::new(900.0, -300.0, 500.0));
            let points = angles.map(|angle| {
                let arm = DQuat::from_axis_angle(way, f64::to_radians(angle)) * (turn * DVec3::new(180.0, 30.0, 0.0));
                AtAngle { angle, at: middle + arm + random.noise() }
            });
            let found = axis(&points).unwrap();
            direction.add(found.direction - way, found.direction_within);
            centre.add(found.centre - middle, found.centre_within);
            assert!((found.radius - 182.48).abs() < 2.0 && found.direction.dot(way) > 0.9999);
        }
        direction.is_as_stated("direction of an axis");
        centre.is_as_stated("middle of an axis");
    }
}

/// Where the true origin lies, and how it is turned, as seen from the one that was found: °.
fn off(found: &Calibrated, truth: &Place) -> (DVec3, DVec3) {
    let turn = found.place.turn.inverse() * truth.turn;
    let turn = if turn.w < 0.0 { -turn } else { turn };
    (truth.at - found.place.at, turn.to_scaled_axis().map(f64::to_degrees))
}

#[test]
fn the_part_is_found_by_its_sides_within_the_stated_interval() {
    let (mut random, mut at, mut turn) = (Random(13), Held::default(), Held::default());
    for _ in 0..DRAWS {
        let stands = DQuat::from_rotation_z(6.0 * random.even()) * DQuat::from_rotation_x(0.2 * random.even() - 0.1);
        let truth = Place { at: DVec3::new(1200.0, 150.0, 480.0), turn: stands };
        let sides = [
            (Touch::Top, [[20.0, 30.0, 0.0], [280.0, 40.0, 0.0], [150.0, 190.0, 0.0], [30.0, 180.0, 0.0]].to_vec()),
            (Touch::Front, [[20.0, 0.0, -8.0], [150.0, 0.0, -6.0], [280.0, 0.0, -9.0]].to_vec()),
            (Touch::Left, [[0.0, 40.0, -7.0], [0.0, 160.0, -9.0]].to_vec()),
        ];
        let mut touches = Vec::new();
        for (touch, points) in sides {
            touches.extend(points.into_iter().map(|p| (touch, truth.outside(DVec3::from_array(p)) + random.noise())));
        }
        let found = base(&touches).unwrap();
        let (shift, angle) = off(&found, &truth);
        at.add(shift, found.at_within);
        turn.add(angle, found.turn_within);
    }
    at.is_as_stated("origin of the part");
    turn.is_as_stated("turn of the part");
}

/// The three points that controllers ask for determine a frame exactly, and say nothing of its errors.
#[test]
fn three_points_give_a_frame_without_an_interval() {
    let truth = Place { at: DVec3::new(900.0, 40.0, 300.0), turn: DQuat::from_rotation_z(0.4) };
    let touch = |touch: Touch, p: [f64; 3]| (touch, truth.outside(DVec3::from_array(p)));
    let touches = [
        touch(Touch::Origin, [0.0; 3]),
        touch(Touch::AlongX, [200.0, 0.0, 0.0]),
        touch(Touch::Top, [50.0, 150.0, 0.0]),
    ];
    let found = base(&touches).unwrap();
    let (shift, angle) = off(&found, &truth);
    assert!(shift.length() < 1e-6 && angle.length() < 1e-6, "{shift} {angle}");
    assert!(found.at_within.x.is_infinite() && found.residuals.spare == 0);
    assert!(base(&touches[..2]).unwrap_err().to_string().contains("three points on top"));
}

#[test]
fn a_scanner_is_placed_within_the_stated_interval() {
    let (mut random, mut at, mut turn) = (Random(17), Held::default(), Held::default());
    for _ in 0..DRAWS {
        let truth = Place { at: DVec3::new(400.0, -700.0, 1500.0), turn: random.turn() };
        let pairs: Vec<Pair> = (0..6)
            .map(|_| {
                let scanned = DVec3::new(random.even() - 0.5, random.even() - 0.5, 0.4 * random.even()) * 600.0;
                Pair { scanned, known: truth.outside(scanned) + random.noise() }
            })
            .collect();
        let found = scanner(&pairs).unwrap();
        let (shift, angle) = off(&found, &truth);
        at.add(shift, found.at_within);
        turn.add(angle, found.turn_within);
    }
    at.is_as_stated("place of a scanner");
    turn.is_as_stated("turn of a scanner");
}

/// Points that leave something open are refused, with what is missing.
#[test]
fn points_that_leave_something_open_are_refused() {
    let upright = |k: i32| {
        let turn = DQuat::from_rotation_z(f64::from(k) * 0.4);
        Flange { at: DVec3::new(900.0, 0.0, 700.0) - turn * DVec3::new(30.0, 0.0, 300.0), turn }
    };
    let poses: Vec<Flange> = (0..6).map(upright).collect();
    assert!(tool(&poses).unwrap_err().to_string().contains("two different directions"));
    assert!(tool(&poses[..3]).unwrap_err().to_string().starts_with("3 touches are too few"));
    let line: Vec<Pair> = (0..5)
        .map(|k| Pair {
            scanned: DVec3::X * f64::from(k),
            known: DMat3::from_rotation_z(1.0) * DVec3::X * f64::from(k),
        })
        .collect();
    assert!(scanner(&line).unwrap_err().to_string().contains("one line"));
    let still = [0.0, 40.0, 80.0].map(|angle| AtAngle { angle, at: DVec3::new(5.0, 6.0, 7.0) });
    assert!(axis(&still).unwrap_err().to_string().contains("not on the axis"));
}
