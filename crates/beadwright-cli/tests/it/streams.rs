//! Standard input and output in place of files, and how much is said.

use std::fs;
use std::io::Write;
use std::path::Path;
use std::process::{Command, Output, Stdio};

fn run(folder: &Path, input: &[u8], arguments: &[&str]) -> Output {
    let mut child = Command::new(env!("CARGO_BIN_EXE_beadwright"))
        .current_dir(folder)
        .args(arguments)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let (mut stdin, input) = (child.stdin.take().unwrap(), input.to_vec());
    // A command that refuses its arguments does not read.
    let writer = std::thread::spawn(move || drop(stdin.write_all(&input)));
    let output = child.wait_with_output().unwrap();
    writer.join().unwrap();
    output
}

fn ok(folder: &Path, input: &[u8], arguments: &[&str]) -> Output {
    let output = run(folder, input, arguments);
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    output
}

#[test]
fn commands_make_a_chain_without_files() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let stl = ok(at, b"", &["example", "star", "-o", "-"]);
    assert!(String::from_utf8_lossy(&stl.stderr).contains("-: "), "messages go to standard error");
    ok(at, b"", &["example", "star", "-o", "star.stl"]);
    assert_eq!(stl.stdout, fs::read(at.join("star.stl")).unwrap());
    // The same plan, but for its name.
    ok(at, &stl.stdout, &["plan", "-", "--no-deposit", "-o", "piped"]);
    ok(at, b"", &["plan", "star.stl", "--no-deposit", "-o", "named"]);
    let plan = |name: &str| fs::read_to_string(at.join(name).join("plan.json")).unwrap();
    assert_eq!(plan("piped").replacen("\"part\":\"part\"", "\"part\":\"star\"", 1), plan("named"));
    // A profile by standard input.
    let profile = ok(at, b"", &["profile", "show", "cmt-steel-abb"]).stdout;
    assert!(profile.starts_with(b"#:schema ./profile.schema.json\n"));
    ok(at, &profile, &["plan", "star.stl", "--no-deposit", "--profile", "-", "-o", "steel"]);
    assert!(plan("steel").contains("cmt-steel-abb"));
    // Tables and drawings to standard output are those in files.
    let json = plan("named").into_bytes();
    for format in ["csv", "vtp", "3mf"] {
        let file = format!("beads.{format}");
        ok(at, b"", &["export", "named/plan.json", "-o", &file]);
        let piped = ok(at, &json, &["export", "-", "-o", "-", "--format", format]);
        assert!(piped.stdout == fs::read(at.join(&file)).unwrap(), "{format}");
    }
    let drawing = ok(at, &json, &["export", "-", "-o", "-", "--format", "svg", "--layer", "2"]).stdout;
    ok(at, b"", &["export", "named/plan.json", "-o", "two.svg", "--layer", "2"]);
    assert_eq!(drawing, fs::read(at.join("two.svg")).unwrap());
    // What is inspected may come from there, and what is mended go there.
    assert!(String::from_utf8_lossy(&ok(at, &json, &["inspect", "-"]).stdout).contains("arc starts"));
    let mended = ok(at, &stl.stdout, &["inspect", "-", "--repair", "-o", "-"]);
    ok(at, b"", &["inspect", "star.stl", "--repair", "-o", "mended.stl"]);
    assert_eq!(mended.stdout, fs::read(at.join("mended.stl")).unwrap());
    assert!(String::from_utf8_lossy(&mended.stderr).contains("closed and clean"));
}

#[test]
fn standard_output_needs_a_format() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let stl = ok(at, b"", &["example", "cross", "-o", "-"]).stdout;
    ok(at, &stl, &["plan", "-", "--no-deposit", "-o", "out"]);
    for (arguments, words) in [
        (&["export", "out/plan.json", "-o", "-"][..], "--format"),
        (&["export", "out/plan.json", "-o", "-", "--format", "svg"], "--layer"),
        (&["plan", "-", "-o", "none"], "standard input"),
        (&["inspect", "-"], "-: "),
    ] {
        let refused = run(at, b"", arguments);
        let text = String::from_utf8_lossy(&refused.stderr).into_owned();
        let named = text.contains(words) || text.contains("-: ");
        assert!(refused.status.code() == Some(1) && named && refused.stdout.is_empty(), "{arguments:?}: {text}");
    }
}

#[test]
fn quiet_says_warnings_only_and_verbose_times() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let said = |arguments: &[&str]| {
        let output = ok(at, b"", arguments);
        [output.stdout, output.stderr].map(|bytes| String::from_utf8(bytes).unwrap())
    };
    assert_eq!(said(&["example", "propeller", "-q"]), ["", ""]);
    let plan = ["plan", "propeller.stl", "--no-deposit", "-o", "out", "--set", "bead.height=1.5"];
    let [usual, silent] = said(&plan);
    let [none, warnings] = said(&[&plan[..], &["--quiet"]].concat());
    let named: Vec<&str> = usual
        .lines()
        .filter(|line| ["serious: ", "warning: ", "note: "].iter().any(|word| line.starts_with(word)))
        .collect();
    assert!(!named.is_empty() && silent.is_empty() && none.is_empty(), "{usual}");
    assert_eq!(warnings.lines().collect::<Vec<_>>(), named);
    // What is asked for is still said.
    assert!(!said(&["plan", "propeller.stl", "--no-deposit", "-o", "out", "--json", "-q"])[0].is_empty());
    let [loud, times] = said(&[&plan[..], &["-v"]].concat());
    assert_eq!(loud, usual);
    for stage in ["import", "slice", "plan", "all"] {
        let line = times.lines().find(|line| line.starts_with(stage)).unwrap();
        let seconds = line.split_whitespace().nth(1).unwrap().parse::<f64>().unwrap();
        assert!(seconds >= 0.0 && line.ends_with(" s"), "{times}");
    }
    let both = run(at, b"", &["profile", "list", "-q", "-v"]);
    assert_eq!(both.status.code(), Some(2));
}

#[test]
fn a_saved_profile_has_its_schema_beside_it() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    ok(at, b"", &["profile", "show", "cmt-al2319-kuka", "-o", "mine.toml"]);
    let text = fs::read_to_string(at.join("mine.toml")).unwrap();
    let named = text.lines().next().unwrap().strip_prefix("#:schema ./").unwrap();
    let schema: serde_json::Value = serde_json::from_str(&fs::read_to_string(at.join(named)).unwrap()).unwrap();
    assert!(schema["properties"]["wire"].is_object());
    ok(at, b"", &["profile", "check", "mine.toml"]);
    let again = run(at, b"", &["profile", "show", "cmt-steel-abb", "-o", "mine.toml"]);
    assert_eq!(again.status.code(), Some(1));
    assert_eq!(fs::read_to_string(at.join("mine.toml")).unwrap(), text);
}
