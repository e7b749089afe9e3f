//! Files that are no models, opened one after another: a clear sentence each, and the program lives on.

use crate::window;

use beadwright_studio::planner::Failure;
use egui_kittest::kittest::Queryable;
use std::path::PathBuf;
use window::{studio, wait};

/// A binary STL of some triangles.
fn stl(triangles: &[[[f32; 3]; 3]]) -> Vec<u8> {
    let mut bytes = vec![0; 80];
    bytes.extend((triangles.len() as u32).to_le_bytes());
    for corners in triangles {
        bytes.extend([0_u8; 12]);
        bytes.extend(corners.iter().flatten().flat_map(|v| v.to_le_bytes()));
        bytes.extend([0, 0]);
    }
    bytes
}

#[test]
fn broken_files_are_reported_and_the_program_lives_on() {
    let folder = tempfile::tempdir().unwrap();
    let triangle = |far: f32| [[0.0, 0.0, 0.0], [far, 0.0, 0.0], [0.0, far, 50.0]];
    let cut = { stl(&[triangle(100.0); 20])[..700].to_vec() };
    let files: [(&str, Vec<u8>); 12] = [
        ("empty.stl", Vec::new()),
        ("words.stl", b"This is not a model at all.".to_vec()),
        ("cut.stl", cut),
        ("nan.stl", stl(&[triangle(f32::NAN); 2])),
        ("flat.stl", stl(&[[[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]]; 3])),
        ("far.stl", stl(&[triangle(1e9); 2])),
        ("picture.stl", b"\x89PNG\r\n\x1a\n0000000000000000".to_vec()),
        ("archive.3mf", b"PK\x03\x04\x14\x00\x06\x00\x08\x00".to_vec()),
        ("ascii.stl", b"solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 zero\n".to_vec()),
        ("wrong.igs", format!("{:72}S      1\n{:72}X      9\n", "start", "nothing").into_bytes()),
        ("broken.bwp", b"version = 1\nprofile = 7\n".to_vec()),
        ("old.bwp", b"version = 99\nprofile = \"\"\n".to_vec()),
    ];
    let write = |(name, bytes): &(&str, Vec<u8>)| {
        let path = folder.path().join(name);
        std::fs::write(&path, bytes).unwrap();
        path
    };
    let nothing: [PathBuf; 2] = [folder.path().join("missing.stl"), folder.path().to_owned()];
    let mut harness = studio(&folder.path().join("store"));
    for path in files.iter().map(write).chain(nothing) {
        let known = harness.state().messages().len();
        harness.state_mut().open(&path);
        wait(&mut harness);
        let message = match (harness.state().messages().get(known), &harness.state().plan().failure) {
            (Some(message), _) => message.text.clone(),
            (
                None,
                Some(
                    Failure::Sentence(text) | Failure::Units(text, _) | Failure::Damaged(text) | Failure::Height(text),
                ),
            ) => text.clone(),
            (None, None) => panic!("{} is taken", path.display()),
        };
        let name = path.file_name().unwrap().to_string_lossy();
        assert!(message.contains(&*name) && message.len() > name.len() + 20, "{name}: {message}");
        assert!(message.ends_with('.'), "no sentence: {message}");
        println!("{message}");
    }
    harness.state_mut().open_example("cross");
    wait(&mut harness);
    assert_eq!(harness.state().plan().failure, None);
    assert!(harness.state().plan().is_complete());
    assert!(harness.query_by_label("10.02 m").is_some() || harness.state().plan().summary.is_some());
}

#[test]
fn a_part_in_inches_is_asked_about() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("inch.stl");
    let mut mesh = beadwright::example::find("cross").unwrap().mesh();
    mesh.place(1.0 / 25.4, glam::DVec3::ZERO);
    let corner = |i: &u32| mesh.vertices[*i as usize].as_vec3().to_array();
    let triangles: Vec<_> = mesh.triangles.iter().map(|t| [corner(&t[0]), corner(&t[1]), corner(&t[2])]).collect();
    std::fs::write(&path, stl(&triangles)).unwrap();
    let mut harness = studio(&folder.path().join("store"));
    harness.state_mut().open(&path);
    wait(&mut harness);
    assert!(matches!(harness.state().plan().failure, Some(Failure::Units(..))));
    // Every button says what would come of it.
    for size in ["mm: 3.94 × 3.94 × 0.79 mm", "cm: 39 × 39 × 8 mm", "m: 3937 × 3937 × 787 mm"] {
        assert!(window::sees(&harness, size), "{size} is not on the screen");
    }
    window::click(&mut harness, "in: 100 × 100 × 20 mm");
    wait(&mut harness);
    let (low, high) = harness.state().plan().part.as_ref().unwrap().bounds();
    assert!(((high - low).x - 100.0).abs() < 1e-3 && harness.state().plan().is_complete());
}

#[test]
fn broken_faces_of_an_obj_are_skipped_on_a_click() {
    let folder = tempfile::tempdir().unwrap();
    let mesh = beadwright::example::find("cross").unwrap().mesh();
    let mut text: String = mesh.vertices.iter().map(|v| format!("v {} {} {}\n", v.x, v.y, v.z)).collect();
    text += "f 1 2 999999\n";
    text.extend(mesh.triangles.iter().map(|[a, b, c]| format!("f {} {} {}\n", a + 1, b + 1, c + 1)));
    let path = folder.path().join("broken.obj");
    std::fs::write(&path, text).unwrap();
    let mut harness = studio(&folder.path().join("store"));
    harness.state_mut().open(&path);
    wait(&mut harness);
    let Some(Failure::Damaged(text)) = &harness.state().plan().failure else { panic!("nothing is asked") };
    assert!(text.contains("1 face refers") && !text.contains("--"), "{text}");
    window::click(&mut harness, "Skip what is broken");
    wait(&mut harness);
    assert!(harness.state().plan().is_complete() && harness.state().project().accept_damaged);
    // It is said in the messages what was left out.
    assert!(harness.query_all_by_label_contains("The file is damaged and was read as it is: 1 face").next().is_some());
}
