//! Projects, their files, their history, and the form of the profile.

use beadwright::files::Folder;
use beadwright::model::{Placement, Units};
use beadwright::profile::{BUILT_IN, Profile, edit};
use beadwright_studio::form::{self, Kind, Parsed};
use beadwright_studio::history::History;
use beadwright_studio::project::{Project, ProjectError, Source};
use beadwright_studio::settings::{Settings, Store};
use std::path::{Path, PathBuf};

#[test]
fn a_project_comes_back_exactly() {
    let placement = Placement {
        units: Some(Units::Inch),
        scale: 1.0 / 3.0,
        turn: glam::DVec3::new(0.1, -90.0, 1e-17),
        centre: true,
        shift: glam::DVec2::new(1.0 / 7.0, -250.0),
    };
    for (_, text) in BUILT_IN {
        // Comments, quotes and blanks at the end of a profile are the person's own.
        let profile = format!("{text}\n# \"\"\" ''' \\n\ttab  \n");
        for source in [None, Some(Source::Example("gear".to_owned())), Some(Source::File(PathBuf::from("/a b/ü.stl")))]
        {
            let project = Project {
                source,
                placement,
                accept_damaged: true,
                preform: true,
                height: Some(0.1 + 0.2),
                profile: profile.clone(),
                adapted: None,
            };
            let written = project.write(None).unwrap();
            assert_eq!(Project::read(&written, None).unwrap(), project, "{written}");
        }
    }
}

#[test]
fn a_model_beside_its_project_moves_with_it() {
    let project = Project { source: Some(Source::File("/work/parts/a.stl".into())), ..Project::default() };
    let written = project.write(Some(Path::new("/work"))).unwrap();
    assert!(written.contains("model = \"parts/a.stl\""), "{written}");
    let moved = Project::read(&written, Some(Path::new("/else"))).unwrap();
    assert_eq!(moved.source, Some(Source::File("/else/parts/a.stl".into())));
    let far = Project { source: Some(Source::File("/far/b.stl".into())), ..Project::default() };
    let written = far.write(Some(Path::new("/work"))).unwrap();
    assert_eq!(Project::read(&written, Some(Path::new("/else"))).unwrap(), far);
}

#[test]
fn projects_that_cannot_be_are_refused() {
    let good = Project::default().write(None).unwrap();
    let read = |text: &str| Project::read(text, None);
    assert!(matches!(read("x"), Err(ProjectError::Text(_))));
    assert!(matches!(read(&good.replace("version = 1", "version = 2")), Err(ProjectError::Version(2))));
    assert!(matches!(read(&format!("example = \"nix\"\n{good}")), Err(ProjectError::Model(_))));
    assert!(matches!(read(&format!("example = \"cross\"\nmodel = \"a\"\n{good}")), Err(ProjectError::Model(_))));
    assert!(matches!(read(&good.replace("raster_turn", "raster_torn")), Err(ProjectError::Profile(_))));
    let adapted = |after: usize, window: &str| {
        format!("{good}\n[adapted]\nscan = \"a.ply\"\nafter_layer = {after}\nwindow = {window}\n")
    };
    assert!(read(&adapted(3, "[0.7, 1.3]")).is_ok());
    for (after, window) in
        [(0, "[0.7, 1.3]"), (3, "[1.3, 0.7]"), (3, "[0.0, 1.3]"), (3, "[nan, 1.3]"), (3, "[0.7, inf]")]
    {
        assert!(matches!(read(&adapted(after, window)), Err(ProjectError::Text(_))), "{after} {window}");
    }
}

#[test]
fn steps_are_undone_and_redone() {
    let mut history = History::new(0);
    assert!(!history.undo() && !history.redo());
    for value in 1..=3 {
        assert!(history.set("drag", value));
    }
    history.seal();
    assert!(history.set("drag", 4) && !history.set("drag", 4));
    assert!(history.set("other", 5));
    let back: Vec<i32> = std::iter::from_fn(|| history.undo().then(|| *history.now())).collect();
    assert_eq!(back, [4, 3, 0]);
    let forth: Vec<i32> = std::iter::from_fn(|| history.redo().then(|| *history.now())).collect();
    assert_eq!(forth, [3, 4, 5]);
    history.undo();
    assert!(history.set("new", 7) && history.redoes().is_none());
}

#[test]
fn the_form_has_every_key_and_its_values_can_be_set() {
    for (name, text) in BUILT_IN {
        let profile = Profile::parse(text).unwrap();
        let values = toml::Table::try_from(&profile).unwrap();
        let fields: Vec<_> = form::sections().iter().flat_map(|section| &section.fields).collect();
        let mut leaves = Vec::new();
        collect("", &toml::Value::Table(values.clone()), &mut leaves);
        for leaf in &leaves {
            assert!(fields.iter().any(|f| f.key == *leaf), "{name}: {leaf} is not in the form");
        }
        // Setting every value to what it is changes nothing.
        for field in fields.iter().filter(|f| leaves.contains(&f.key)) {
            let value = form::value(&values, &field.key).unwrap();
            let set = edit::with_value(text, &field.key, &value.to_string()).unwrap();
            assert_eq!(Profile::parse(&set).unwrap(), profile, "{name}: {}", field.key);
            assert!(!field.about.is_empty(), "{}", field.key);
            if let Kind::Choice(words) = &field.kind {
                assert!(words.iter().any(|(word, _)| Some(word.as_str()) == value.as_str()), "{}", field.key);
            }
        }
    }
}

fn collect(path: &str, value: &toml::Value, leaves: &mut Vec<String>) {
    match value {
        toml::Value::Table(table) => table.iter().for_each(|(key, value)| {
            let path = if path.is_empty() { key.clone() } else { format!("{path}.{key}") };
            collect(&path, value, leaves);
        }),
        _ => leaves.push(path.to_owned()),
    }
}

#[test]
fn a_number_may_be_left_out_and_given_by_hand() {
    for key in ["hybrid.pocket_depth", "hybrid.tip_reach"] {
        let parsed = Parsed::of(BUILT_IN[0].1).unwrap();
        let field = form::field(key).unwrap();
        assert!(field.optional && field.kind == (Kind::Number { whole: false }), "{field:?}");
        assert_eq!(form::value(&parsed.values, key), None, "{key}");
        // What the form puts in at first is possible.
        let start = form::limit(&parsed.limits, key).unwrap().value;
        let given = edit::with_value(&parsed.text, key, &start.to_string()).unwrap();
        let given = Parsed::of(&given).unwrap();
        assert_eq!(form::value(&given.values, key).and_then(|value| value.as_float()), Some(start), "{key}");
        let without = edit::without_value(&given.text, key).unwrap();
        assert_eq!(Parsed::of(&without).unwrap().profile, parsed.profile, "{key}");
    }
}

#[test]
fn numbers_have_limits_with_reasons() {
    for (_, text) in BUILT_IN {
        let profile = Profile::parse(text).unwrap();
        for limit in profile.limits() {
            assert!(limit.least <= limit.value && limit.value <= limit.greatest, "{}", limit.key);
            assert!(limit.reason.len() > 10, "{}", limit.key);
        }
    }
}

#[test]
fn settings_and_a_lost_project_come_back() {
    let folder = tempfile::tempdir().unwrap();
    let store = Store::at(folder.path().join("deep/store"));
    assert_eq!((store.settings(), store.lost_project()), (Settings::default(), None));
    let mut settings = Settings { light: true, ..Settings::default() };
    for i in 0..20 {
        settings.remember(Path::new(&format!("/{}", i % 15)));
    }
    assert_eq!((settings.recent.len(), settings.recent[0].as_path()), (10, Path::new("/4")));
    store.keep_settings(&settings);
    let project = Project { source: Some(Source::Example("star".to_owned())), ..Project::default() };
    store.keep_project(&project).unwrap();
    assert_eq!((store.settings(), store.lost_project()), (settings, Some(project)));
    store.forget_project();
    assert_eq!(store.lost_project(), None);
    let left = std::fs::read_dir(folder.path().join("deep/store")).unwrap().map(|e| e.unwrap().file_name());
    assert!(left.into_iter().all(|name| !name.to_string_lossy().ends_with(".bwp")));
}

#[test]
fn windows_at_a_time_keep_projects_of_their_own() {
    let folder = tempfile::tempdir().unwrap();
    let store = || Store::at(folder.path().to_owned());
    let project = |name: &str| Project { source: Some(Source::Example(name.to_owned())), ..Project::default() };
    let (first, second) = (store(), store());
    first.keep_project(&project("star")).unwrap();
    second.keep_project(&project("gear")).unwrap();
    // The second ends without a word while the first goes on.
    drop(second);
    let third = store();
    assert_eq!(third.lost_project(), Some(project("gear")));
    third.forget_project();
    assert_eq!(first.lost_project(), Some(project("star")));
    drop((first, third));
    assert_eq!(store().lost_project(), Some(project("star")));
}

#[test]
fn files_of_a_program_are_all_written_or_none() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let write = |names: &[&str]| {
        let mut folder = Folder::new(&out)?;
        names.iter().try_for_each(|name| folder.append(name, "text"))?;
        folder.commit().map(|written| written.files)
    };
    let error = write(&["a.src", "no/such/b.src"]).unwrap_err().to_string();
    assert!(error.contains("b.src"), "{error}");
    assert!(!out.exists() && std::fs::read_dir(folder.path()).unwrap().count() == 0);
    assert_eq!(write(&["a.src", "b.src"]).unwrap(), ["a.src", "b.src"]);
    assert_eq!(std::fs::read_dir(&out).unwrap().count(), 2);
}
