//! The window before a part is open.

use crate::window::{Window, click, open_list, sees, studio, wait};
use beadwright::model::Mesh;
use beadwright::profile::Profile;
use beadwright::robot::Cell;
use beadwright_studio::thumbnail::thumbnail;
use beadwright_studio::view3d::Camera;
use egui_kittest::kittest::Queryable;
use glam::DVec3;

#[test]
fn one_click_on_an_example_leads_to_a_plan() {
    // A solid part and a thin wall.
    for name in ["cross", "tian"] {
        let folder = tempfile::tempdir().unwrap();
        let mut harness = studio(folder.path());
        assert!(sees(&harness, "Drop a part here") && sees(&harness, "Open…"));
        assert!(beadwright::example::ALL.iter().all(|example| sees(&harness, example.name)));
        click(&mut harness, name);
        wait(&mut harness);
        assert!(harness.state().plan().is_complete(), "{name}: {:?}", harness.state().plan().failure);
        assert!(!sees(&harness, "Drop a part here") && sees(&harness, "3-D view"));
    }
}

#[test]
fn process_and_robot_are_chosen_before_the_part() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = studio(folder.path());
    open_list(&mut harness, "Profile");
    click(&mut harness, "cmt-steel-abb");
    open_list(&mut harness, "Robot cell");
    click(&mut harness, "abb-irb1410");
    click(&mut harness, "cross");
    wait(&mut harness);
    assert_eq!(harness.state().plan().profile.as_ref().unwrap().name, "cmt-steel-abb");
    assert_eq!(harness.state_mut().view().cell, "abb-irb1410");
    // Programs are written in the language of the profile.
    assert_eq!(harness.state_mut().view().dialect, "rapid");
}

#[test]
fn the_robot_cell_follows_the_process_until_one_is_chosen() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = studio(folder.path());
    let choose = |harness: &mut Window, list: &str, entry: &str| {
        open_list(harness, list);
        // The chosen name is now in the list, too.
        harness.query_all_by_label(entry).last().unwrap().click();
        harness.run_steps(3);
    };
    for (profile, cell) in [
        ("cmt-steel-abb", "abb-irb1410"),
        ("cmt-steel-robots", "fanuc-arc-mate-100id"),
        // A machine without a robot has no cell of its own.
        ("plasma-304-cnc", "fanuc-arc-mate-100id"),
        ("cmt-al2319-kuka", "kuka-kr20-r1810"),
    ] {
        choose(&mut harness, "Profile", profile);
        assert_eq!(harness.state_mut().view().cell, cell, "{profile}");
        assert!(Profile::built_in(profile).is_ok() && Cell::built_in(cell).is_ok());
    }
    // The arm that is shown is that of the new cell, of an open part too.
    harness.state_mut().open_example("cross");
    harness.state_mut().view().robot = true;
    wait(&mut harness);
    choose(&mut harness, "Profile", "cmt-steel-abb");
    wait(&mut harness);
    // By hand, whatever the process.
    choose(&mut harness, "Robot cell", "ur5e");
    choose(&mut harness, "Profile", "cmt-al2319-kuka");
    wait(&mut harness);
    assert_eq!(harness.state_mut().view().cell, "ur5e");
    assert_eq!(harness.state_mut().view().dialect, "krl");
}

#[test]
fn recent_files_are_one_click_away() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("my part.stl");
    std::fs::write(&path, beadwright::example::find("cross").unwrap().stl()).unwrap();
    let store = folder.path().join("store");
    let mut harness = studio(&store);
    assert!(!sees(&harness, "my part.stl"));
    harness.state_mut().open(&path);
    wait(&mut harness);
    drop(harness);
    let mut harness = studio(&store);
    harness.get_by_label("my part.stl").click();
    harness.run_steps(3);
    wait(&mut harness);
    assert_eq!(harness.state().project().part(), "my part");
}

/// A box from −half to half of its size, mm.
fn cuboid(size: DVec3) -> Mesh {
    let corner = |i: usize| DVec3::from_array([0, 1, 2].map(|axis| (i >> axis & 1) as f64 - 0.5)) * size;
    let sides = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = sides.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    Mesh { vertices: (0..8).map(corner).collect(), triangles, ..Mesh::default() }
}

#[test]
fn the_picture_of_a_box_is_its_parallel_projection() {
    let camera = Camera::default();
    let (back, right, up) = (camera.back().abs(), camera.right().abs(), camera.up().abs());
    for size in [DVec3::new(10.0, 10.0, 10.0), DVec3::new(40.0, 10.0, 5.0), DVec3::new(3.0, 8.0, 30.0)] {
        let picture = thumbnail(&cuboid(size), [240, 200]);
        let drawn = |i: usize| f64::from(picture.pixels[i].a()) / 255.0;
        let area: f64 = (0..picture.pixels.len()).map(drawn).sum();
        let places: Vec<[usize; 2]> =
            (0..picture.pixels.len()).filter(|&i| drawn(i) > 0.4).map(|i| [i % 240, i / 240]).collect();
        let extent = |axis: usize| {
            let along = || places.iter().map(|place| place[axis]);
            (along().max().unwrap() - along().min().unwrap() + 1) as f64
        };
        // Three sides are seen, each smaller by the cosine of its angle; the frame around them is that of the corners.
        let seen = back.x * size.y * size.z + back.y * size.x * size.z + back.z * size.x * size.y;
        let frame = right.dot(size) * up.dot(size);
        let (found, wanted) = (area / (extent(0) * extent(1)), seen / frame);
        assert!((found / wanted - 1.0).abs() < 0.03, "{size}: {found:.3} of the frame, not {wanted:.3}");
        // It nearly fills the picture, whichever way it is larger.
        assert!(extent(0) > 215.0 || extent(1) > 179.0, "{} × {}", extent(0), extent(1));
    }
}
