//! Files are complete or absent as a set, whatever happens to the run.
#![cfg(unix)]

use beadwright::files::{Folder, write_file};
use std::collections::BTreeMap;
use std::fs;
use std::os::unix::fs::{PermissionsExt, symlink};
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Duration;

fn beadwright() -> Command {
    Command::new(env!("CARGO_BIN_EXE_beadwright"))
}

fn put(folder: &Path, files: &[(&str, &str)]) -> beadwright::files::Written {
    let mut run = Folder::new(folder).unwrap();
    files.iter().for_each(|(name, text)| run.append(name, text).unwrap());
    run.commit().unwrap()
}

/// The files of a folder and their text.
fn content(folder: &Path) -> BTreeMap<String, String> {
    let entries = fs::read_dir(folder).unwrap().map(Result::unwrap);
    let text = |path: &Path| if path.is_dir() { "folder".to_owned() } else { fs::read_to_string(path).unwrap() };
    entries.map(|e| (e.file_name().into_string().unwrap(), text(&e.path()))).collect()
}

fn is(folder: &Path, files: &[(&str, &str)]) {
    let wanted = files.iter().map(|(name, text)| ((*name).to_owned(), (*text).to_owned())).collect();
    assert_eq!(content(folder), wanted);
}

#[test]
fn a_set_replaces_the_earlier_one_and_nothing_else() {
    // Case 1610.
    let place = tempfile::tempdir().unwrap();
    let out = place.path().join("deep/out");
    let first = r#"{"files": ["plan.json", "metrics.json", "A.src", "A_L001.src", "A_L002.src", "../x", "gone"]}"#;
    put(
        &out,
        &[("plan.json", "1"), ("metrics.json", first), ("A.src", "a"), ("A_L001.src", "a1"), ("A_L002.src", "a2")],
    );
    fs::create_dir_all(out.join("notes/deep")).unwrap();
    fs::write(out.join("notes/deep/mine.txt"), "mine").unwrap();
    fs::write(out.join("B.src"), "of others").unwrap();
    symlink("nowhere", out.join("link")).unwrap();
    fs::set_permissions(&out, fs::Permissions::from_mode(0o750)).unwrap();
    fs::write(out.parent().unwrap().join("x"), "of others").unwrap();
    let second = r#"{"files": ["plan.json", "metrics.json", "A.src", "A_L001.src"]}"#;
    let new = [("plan.json", "2"), ("metrics.json", second), ("A.src", "b"), ("A_L001.src", "b1")];
    let written = put(&out, &new);
    assert_eq!(written.removed, ["A_L002.src"]);
    assert_eq!(fs::read_link(out.join("link")).unwrap(), Path::new("nowhere"));
    fs::remove_file(out.join("link")).unwrap();
    is(&out, &[&new[..], &[("B.src", "of others"), ("notes", "folder")]].concat());
    assert_eq!(fs::read_to_string(out.join("notes/deep/mine.txt")).unwrap(), "mine");
    assert_eq!(fs::metadata(&out).unwrap().permissions().mode() & 0o777, 0o750);
    // A program alone leaves the plan.
    put(&out, &[("A.src", "c")]);
    assert_eq!(content(&out)["plan.json"], "2");
    is(out.parent().unwrap(), &[("out", "folder"), ("x", "of others")]);
}

#[test]
fn the_current_folder_stays_the_one_that_a_shell_is_in() {
    // Case 1611.
    let place = tempfile::tempdir().unwrap();
    let plan = |part: &str, layers: &str| {
        let model = place.path().join(format!("{part}.stl"));
        beadwright().args(["example", part, "-o"]).arg(&model).output().unwrap();
        let mut run = beadwright();
        run.current_dir(place.path().join("out")).args(["plan", "-o", ".", "--no-deposit", "--set", layers]);
        let done = run.arg(&model).output().unwrap();
        assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    };
    let out = place.path().join("out");
    fs::create_dir(&out).unwrap();
    fs::write(out.join("mine.txt"), "mine").unwrap();
    let folder = fs::File::open(&out).unwrap();
    plan("cross", "layers.height=1.8");
    let first = content(&out);
    plan("plate", "layers.height=2.2");
    let second = content(&out);
    use std::os::unix::fs::MetadataExt;
    assert_eq!(folder.metadata().unwrap().ino(), fs::metadata(&out).unwrap().ino(), "the folder itself is the same");
    assert!(first.contains_key("CROSS.src") && second.contains_key("PLATE.src") && !second.contains_key("CROSS.src"));
    assert_eq!(second["mine.txt"], "mine");
    assert!(!second.keys().any(|name| name.starts_with(".beadwright-")), "{:?}", second.keys());
}

#[test]
fn a_move_that_fails_changes_nothing() {
    // Case 1612.
    let place = tempfile::tempdir().unwrap();
    let out = place.path().join("out");
    put(&out, &[("plan.json", "1"), ("A.src", "a")]);
    fs::create_dir(out.join("B.src")).unwrap();
    let before = content(&out);
    let mut run = Folder::new(&out).unwrap();
    run.append("plan.json", "2").unwrap();
    run.append("B.src", "b").unwrap();
    let error = run.commit().unwrap_err().to_string();
    assert!(error.contains("B.src is a folder there"), "{error}");
    assert_eq!(content(&out), before);
    let file = place.path().join("file");
    fs::write(&file, "x").unwrap();
    assert!(Folder::new(&file).err().unwrap().to_string().contains("it is a file, not a folder"));
    is(place.path(), &[("file", "x"), ("out", "folder")]);
}

#[test]
fn leftovers_of_dead_runs_are_cleared_and_live_runs_let_be() {
    // Case 1613.
    let place = tempfile::tempdir().unwrap();
    let out = place.path().join("out");
    // A dead run: its lock is free.
    let dead = place.path().join(".beadwright-dead");
    fs::create_dir_all(dead.join("new")).unwrap();
    // One that was killed while it moved its files: the old one is out, of two new ones one is in.
    fs::create_dir_all(out.join(".beadwright-moving/new")).unwrap();
    fs::create_dir_all(out.join(".beadwright-moving/old")).unwrap();
    for (name, text) in [("moving", "A.src\nB.src"), ("old/A.src", "old"), ("old/B.src", "old"), ("new/A.src", "new")] {
        fs::write(out.join(".beadwright-moving").join(name), text).unwrap();
    }
    fs::write(out.join("B.src"), "new").unwrap();
    let mut live = Folder::new(&out).unwrap();
    live.append("A.src", "live").unwrap();
    is(&out, &[("A.src", "new"), ("B.src", "new")]);
    assert!(!dead.exists());
    put(&out, &[("C.src", "c")]);
    live.commit().unwrap();
    is(&out, &[("A.src", "live"), ("B.src", "new"), ("C.src", "c")]);
}

#[test]
fn single_files_replace_no_device_and_no_link_and_have_the_usual_mode() {
    // Case 1614.
    let place = tempfile::tempdir().unwrap();
    let (file, link) = (place.path().join("a.html"), place.path().join("link.html"));
    fs::write(place.path().join("usual"), "").unwrap();
    let mode = |name: &str| fs::metadata(place.path().join(name)).unwrap().permissions().mode() & 0o777;
    write_file(&file, b"1").unwrap();
    assert_eq!(mode("a.html"), mode("usual"));
    fs::set_permissions(&file, fs::Permissions::from_mode(0o640)).unwrap();
    write_file(&file, b"2").unwrap();
    assert_eq!(mode("a.html"), 0o640, "that of the file before");
    symlink(&file, &link).unwrap();
    let error = write_file(&link, b"3").unwrap_err().to_string();
    assert!(error.contains("it is a link to"), "{error}");
    assert_eq!(fs::read(&file).unwrap(), b"2");
    write_file(Path::new("/dev/null"), b"4").unwrap();
    assert!(!fs::metadata("/dev/null").unwrap().is_file());
}

/// No space left, and places where nothing can be written.
#[test]
fn what_cannot_be_written_is_said_and_leaves_nothing() {
    // Case 1616.
    let place = tempfile::tempdir().unwrap();
    let model = place.path().join("part.stl");
    beadwright().args(["example", "cross", "-o"]).arg(&model).output().unwrap();
    let refused = |arguments: &[&str], words: &str| {
        let done = beadwright().current_dir(place.path()).args(arguments).output().unwrap();
        let said = String::from_utf8_lossy(&done.stderr).into_owned();
        assert!(done.status.code() == Some(1) && said.contains(words) && said.lines().count() == 1, "{said}");
        let clauses: Vec<&str> = said.trim_end().split(": ").collect();
        assert!(clauses.windows(2).all(|two| two[0] != two[1]), "said twice: {said}");
    };
    refused(&["plan", "part.stl", "--no-deposit", "-o", "/proc/here"], "/proc/here cannot be written");
    refused(&["plan", "part.stl", "--no-deposit", "-o", "part.stl/here"], "cannot be written");
    refused(&["plan", "part.stl", "--no-deposit", "-o", "part.stl"], "it is a file, not a folder");
    if Path::new("/dev/full").exists() {
        refused(&["example", "cross", "-o", "/dev/full"], "/dev/full cannot be written: No space left");
    }
    assert_eq!(fs::read_dir(place.path()).unwrap().count(), 1);
}

/// SIGTERM stops a run as Ctrl-C does: nothing is left behind.
#[test]
fn a_run_that_is_asked_to_end_leaves_nothing() {
    // Case 1617.
    let place = tempfile::tempdir().unwrap();
    let model = place.path().join("part.stl");
    beadwright().args(["example", "propeller", "-o"]).arg(&model).output().unwrap();
    let mut run = beadwright();
    run.current_dir(place.path()).args(["plan", "part.stl", "--set", "layers.height=0.1"]);
    let child = run.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    // The handler is there before the first file.
    while !fs::read_dir(place.path()).unwrap().any(|e| e.unwrap().file_name().to_string_lossy().starts_with(".beadwr"))
    {
    }
    assert!(Command::new("kill").args(["-TERM", &child.id().to_string()]).status().unwrap().success());
    let done = child.wait_with_output().unwrap();
    let said = String::from_utf8_lossy(&done.stderr).into_owned();
    assert!(done.status.code() == Some(1) && said.contains("cancelled"), "{:?}: {said}", done.status);
    is_empty_but(place.path(), "part.stl");
}

fn is_empty_but(folder: &Path, file: &str) {
    let names: Vec<_> = fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name()).collect();
    assert_eq!(names, [file]);
}

fn report_is_staged(place: &Path) -> bool {
    let entries = fs::read_dir(place).unwrap().filter_map(Result::ok);
    let mut stages = entries.filter(|e| e.file_name().to_string_lossy().starts_with(".beadwright-"));
    stages.any(|stage| stage.path().join("new/report.html").exists())
}

/// `BEADWRIGHT_KILLS=200` tries more.
#[test]
fn runs_killed_around_the_commit_leave_one_set_or_the_other() {
    // Case 1615.
    let kills: u32 = std::env::var("BEADWRIGHT_KILLS").ok().and_then(|n| n.parse().ok()).unwrap_or(24);
    let place = tempfile::tempdir().unwrap();
    let model = place.path().join("part.stl");
    beadwright().args(["example", "cross", "-o"]).arg(&model).output().unwrap();
    let run = |out: &Path, height: &str| {
        let mut run = beadwright();
        run.args(["plan", "--no-deposit", "-s", "contour", "-p", "cmt-steel-robots", "--set", height]);
        // As many layers at both heights.
        run.args(["--set", "layers.level=false", "-o"])
            .arg(out)
            .arg(&model)
            .stdout(Stdio::null())
            .stderr(Stdio::null());
        run
    };
    let set = |name: &str, height: &str| {
        let out = place.path().join(name);
        assert!(run(&out, height).status().unwrap().success());
        content(&out)
    };
    let (old_height, new_height) = ("layers.height=1.6", "layers.height=1.7");
    let (old, new) = (set("old", old_height), set("new", new_height));
    assert!(old.keys().eq(new.keys()) && old != new && new.len() > 6, "{} and {} files", old.len(), new.len());
    let (mut seen, mut into_nothing) = ([0, 0], [0, 0]);
    for kill in 0..kills {
        let out = place.path().join(format!("out{kill}"));
        // Every second one into a folder with an older program.
        let older = kill % 2 == 0;
        if older {
            set(&format!("out{kill}"), old_height);
            fs::write(out.join("mine.txt"), "mine").unwrap();
        }
        let mut child = run(&out, new_height).spawn().unwrap();
        // The report is written last: the commit begins at once.
        while !report_is_staged(place.path()) && child.try_wait().unwrap().is_none() {}
        std::thread::sleep(Duration::from_micros(150 * u64::from(kill % 20 / 2)));
        _ = child.kill();
        child.wait().unwrap();
        let mut left = if out.exists() { content(&out) } else { BTreeMap::new() };
        if older {
            assert_eq!(left.remove("mine.txt").as_deref(), Some("mine"), "kill {kill}");
            seen[usize::from(left == new)] += 1;
            assert!(left == old || left == new, "kill {kill}: {:?}", left.keys());
        } else {
            into_nothing[usize::from(left == new)] += 1;
            assert!(left.is_empty() || left == new, "kill {kill}: {:?}", left.keys());
        }
    }
    println!(
        "over an older program: {} old, {} new; fresh: {} none, {} new",
        seen[0], seen[1], into_nothing[0], into_nothing[1]
    );
    set("after", new_height);
    let leftovers = fs::read_dir(place.path()).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap());
    assert_eq!(leftovers.filter(|name| name.starts_with(".beadwright-")).count(), 0, "the next run clears them");
}
