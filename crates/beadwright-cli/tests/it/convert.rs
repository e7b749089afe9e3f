//! STEP files go through a converter of others: what it makes is planned, and what it fails to make is reported.
#![cfg(unix)]

use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use std::process::{Command, Output};

fn beadwright(folder: &Path, converter: &str, arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_beadwright"));
    command.current_dir(folder).env("BEADWRIGHT_CONVERTER", converter).args(arguments).output().unwrap()
}

fn script(folder: &Path, name: &str, text: &str) -> String {
    let path = folder.join(name);
    fs::write(&path, format!("#!/bin/sh\n{text}\n")).unwrap();
    fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).unwrap();
    path.to_string_lossy().into_owned()
}

#[test]
fn a_step_file_is_what_the_converter_makes_of_it() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    fs::write(at.join("part.step"), "ISO-10303-21;\nHEADER;\nENDSEC;\nEND-ISO-10303-21;\n").unwrap();
    assert!(beadwright(at, "none", &["example", "cross", "-o", "cross.stl"]).status.success());
    let copies = script(at, "copies", "cp cross.stl \"$2\"");
    let said = beadwright(at, &copies, &["inspect", "part.step"]);
    let text = String::from_utf8_lossy(&said.stdout).into_owned();
    assert!(said.status.success() && text.contains("closed and clean"), "{text}");
    assert!(beadwright(at, &copies, &["plan", "part.step", "--no-deposit", "-o", "plan"]).status.success());
    assert!(at.join("plan/PART.src").exists());
    let refused = |converter: &str, part: &str| {
        let said = beadwright(at, converter, &["plan", "part.step", "-o", "other"]);
        let text = String::from_utf8_lossy(&said.stderr).into_owned();
        assert!(said.status.code() == Some(1) && text.contains(part) && !at.join("other").exists(), "{text}");
    };
    refused("/nowhere/converter", "cannot be started");
    refused(&script(at, "fails", "echo 'no solid in it' >&2; exit 3"), "no solid in it");
    let open = "printf 'solid a\\nfacet normal 0 0 1\\nouter loop\\nvertex 0 0 0\\nvertex 50 0 0\\nvertex 0 50 9\\nendloop\\nendfacet\\nendsolid a\\n'";
    refused(&script(at, "opens", &format!("{open} > \"$2\"")), "3 open edges");
}
