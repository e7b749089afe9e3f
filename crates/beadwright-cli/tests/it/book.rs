//! The book in `docs`: every command in it runs and says what the page shows, and no link or picture is missing.
//!
//! A block of ```` ```sh ```` is run in a folder of its page, in which `part.stl` lies, the reader's own part. It must succeed;
//! `sh fails` must not, and `sh ignore: REASON` is not run. A block of ```` ```text ```` right below is what it says; a line
//! `…` in it stands for lines that are left out. `BEADWRIGHT_GOLDEN=write cargo test -p beadwright-cli --test it book::` writes
//! those without such a line anew.
#![cfg(unix)]

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use tempfile::TempDir;

fn root() -> PathBuf {
    fs::canonicalize(Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")).unwrap()
}

/// All pages below a folder.
fn pages_in(folder: &Path) -> Vec<PathBuf> {
    let entries: Vec<PathBuf> = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    let mut pages: Vec<PathBuf> = entries.iter().filter(|p| p.is_dir()).flat_map(|p| pages_in(p)).collect();
    pages.extend(entries.into_iter().filter(|p| p.extension().is_some_and(|end| end == "md")));
    pages.sort();
    pages
}

/// A fenced block: its first line without the fence, and the lines within, from and to (not included).
struct Block {
    info: String,
    from: usize,
    to: usize,
}

fn blocks(lines: &[&str]) -> Vec<Block> {
    let mut blocks = Vec::new();
    let mut open: Option<(String, usize)> = None;
    for (i, line) in lines.iter().enumerate() {
        match (line.trim_start().strip_prefix("```"), open.take()) {
            (Some(info), None) => open = Some((info.trim().to_owned(), i + 1)),
            (Some(_), Some((info, from))) => blocks.push(Block { info, from, to: i }),
            (None, still) => open = still,
        }
    }
    assert!(open.is_none(), "a block does not end");
    blocks
}

fn command(folder: &Path) -> Command {
    let binaries = Path::new(env!("CARGO_BIN_EXE_beadwright")).parent().unwrap();
    let path = format!("{}:{}", binaries.display(), std::env::var("PATH").unwrap());
    let mut command = Command::new("sh");
    command.current_dir(folder).env("PATH", path).env("HOME", folder).env_remove("XDG_CONFIG_HOME");
    command.env_remove("BEADWRIGHT_PROFILES");
    command
}

/// Runs a block; gives what it said and whether it ended well.
fn run(folder: &Path, script: &str) -> (String, bool) {
    let output = command(folder).args(["-euc", &format!("exec 2>&1\n{script}")]).output().unwrap();
    (String::from_utf8(output.stdout).unwrap(), output.status.success())
}

/// Whether text says what is expected, where lines `…` stand for any number of lines.
fn says(text: &str, expected: &str) -> bool {
    let trimmed = |text: &str| text.trim_end().lines().map(str::trim_end).map(str::to_owned).collect::<Vec<_>>();
    let (said, expected) = (trimmed(text), trimmed(expected));
    let pieces: Vec<&[String]> = expected.split(|line| line.trim() == "…").collect();
    let (first, last) = (pieces[0], pieces[pieces.len() - 1]);
    if pieces.len() == 1 {
        return said == expected;
    }
    let mut at = first.len();
    let between = pieces[1..pieces.len() - 1].iter().all(|piece| {
        let found = (at..=said.len().saturating_sub(piece.len())).find(|&i| said[i..].starts_with(piece));
        at = found.map_or(at, |i| i + piece.len());
        found.is_some()
    });
    between && said.starts_with(first) && said[at.min(said.len())..].ends_with(last)
}

/// Runs the blocks of a page; gives what is wrong, and the page as it should be.
fn follow(page: &Path) -> (Vec<String>, String) {
    let text = fs::read_to_string(page).unwrap();
    let lines: Vec<&str> = text.lines().collect();
    let blocks = blocks(&lines);
    let folder = TempDir::new().unwrap();
    let (mut wrong, mut outputs) = (Vec::new(), Vec::new());
    if blocks.iter().any(|block| block.info.starts_with("sh")) {
        assert!(run(folder.path(), "beadwright example cross -o part.stl").1);
    }
    for (i, block) in blocks.iter().enumerate().filter(|(_, block)| block.info.split(' ').next() == Some("sh")) {
        let (place, script) =
            (format!("{}:{}", page.display(), block.from + 1), lines[block.from..block.to].join("\n"));
        match block.info.strip_prefix("sh").unwrap().trim() {
            how if how.is_empty() || how == "fails" => {
                let (said, well) = run(folder.path(), &script);
                if well == (how == "fails") {
                    wrong.push(format!("{place}: ended {} with:\n{said}", if well { "well" } else { "badly" }));
                }
                let shown = blocks.get(i + 1).filter(|next| next.info == "text" && next.from == block.to + 3);
                if let Some(shown) = shown.filter(|s| !says(&said, &lines[s.from..s.to].join("\n"))) {
                    wrong.push(format!("{place}: the page shows something else than:\n{said}"));
                    outputs.push((shown.from, shown.to, said));
                }
            }
            how if how.strip_prefix("ignore:").is_some_and(|reason| reason.trim().len() > 10) => {}
            how => wrong.push(format!("{place}: \"sh {how}\" is neither sh, sh fails nor sh ignore: REASON")),
        }
    }
    let mut now: Vec<String> = lines.iter().map(|line| (*line).to_owned()).collect();
    for (from, to, said) in outputs.into_iter().rev().filter(|(from, to, _)| !lines[*from..*to].contains(&"…")) {
        now.splice(from..to, said.trim_end().lines().map(str::to_owned));
    }
    (wrong, now.join("\n") + "\n")
}

#[test]
fn every_command_of_the_book_runs() {
    let write = std::env::var("BEADWRIGHT_GOLDEN").is_ok_and(|v| v == "write");
    let pages = pages_in(&root().join("docs"));
    assert!(pages.len() > 20, "{pages:?}");
    let followed: Vec<(PathBuf, Vec<String>, String)> = std::thread::scope(|scope| {
        let running: Vec<_> = pages.iter().map(|page| (page, scope.spawn(|| follow(page)))).collect();
        running
            .into_iter()
            .map(|(page, follower)| {
                let (wrong, now) = follower.join().unwrap();
                (page.clone(), wrong, now)
            })
            .collect()
    });
    if write {
        followed.iter().for_each(|(page, _, now)| fs::write(page, now).unwrap());
    }
    let wrong: Vec<String> = followed.into_iter().flat_map(|(_, wrong, _)| wrong).collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// The first screen of the README is what the command says.
#[test]
fn the_readme_shows_what_is_planned() {
    let text = fs::read_to_string(root().join("README.md")).unwrap();
    let lines: Vec<&str> = text.lines().collect();
    assert!(lines.len() < 150, "{} lines", lines.len());
    let blocks = blocks(&lines);
    let (asked, shown) = (&blocks[0], &blocks[1]);
    assert_eq!(lines[asked.from..asked.to], ["cargo run --release -- plan examples/propeller.stl"]);
    let folder = TempDir::new().unwrap();
    let model = root().join("examples/propeller.stl");
    let (said, well) = run(folder.path(), &format!("beadwright plan {}", model.display()));
    assert!(well && says(&said, &lines[shown.from..shown.to].join("\n")), "{said}");
}

/// The page of all commands names each of them.
#[test]
fn no_command_is_missing() {
    let page = fs::read_to_string(root().join("docs/book/commands.md")).unwrap();
    let (help, _) = run(&root(), "beadwright --help");
    let listed = help.split_once("Commands:\n").unwrap().1.split_once("\n\n").unwrap().0;
    // Long descriptions go on in lines that begin farther right.
    let names = listed.lines().filter_map(|line| line.strip_prefix("  ")?.split(' ').next());
    let names: Vec<&str> = names.filter(|name| !["", "help"].contains(name)).collect();
    assert!(names.len() > 15, "{help}");
    for name in names {
        assert!(page.contains(&format!("`beadwright {name}")), "{name}");
    }
}

/// A page without its blocks and code.
fn prose(text: &str) -> String {
    let lines: Vec<&str> = text.lines().collect();
    let blocks = blocks(&lines);
    let outside = |i: &usize| !blocks.iter().any(|block| (block.from - 1..=block.to).contains(i));
    let outside: Vec<&str> = (0..lines.len()).filter(outside).map(|i| lines[i]).collect();
    let plain = |paragraph: &str| paragraph.split('`').step_by(2).collect::<Vec<_>>().join("`");
    outside.join("\n").split("\n\n").map(|paragraph| plain(paragraph) + "\n\n").collect()
}

/// Targets of links and pictures.
fn targets(text: &str) -> Vec<String> {
    let of = |mark: &str, end: char| {
        let after = text.split(mark).skip(1);
        after.filter_map(|rest| rest.split_once(end)).map(|(target, _)| target.to_owned()).collect::<Vec<_>>()
    };
    of("](", ')').into_iter().chain(of("src=\"", '"')).chain(of("href=\"", '"')).collect()
}

/// What GitHub and mdBook make of headings: lower case, hyphens for blanks, nothing for other marks.
fn anchors(text: &str) -> BTreeSet<String> {
    let lines: Vec<&str> = text.lines().collect();
    let blocks = blocks(&lines);
    let heading = |(i, line): (usize, &&str)| {
        let inside = blocks.iter().any(|block| (block.from..block.to).contains(&i));
        let letter = |c: char| match c {
            ' ' => Some('-'),
            c if c.is_alphanumeric() || c == '-' || c == '_' => Some(c.to_ascii_lowercase()),
            _ => None,
        };
        let words = line.strip_prefix('#').filter(|_| !inside)?.trim_start_matches('#').trim();
        Some(words.chars().filter_map(letter).collect())
    };
    lines.iter().enumerate().filter_map(heading).collect()
}

#[test]
fn no_link_and_no_picture_is_missing() {
    let root = root();
    let docs = root.join("docs");
    // The gallery's live report changes with every version and is large, so it is not kept here: `docs/book/build` makes it,
    // and fails where it or the link to it is missing.
    let made = docs.join("book/propeller/report.html");
    let mut pages = pages_in(&docs);
    pages.extend(["README.md", "CONTRIBUTING.md", "CHANGELOG.md"].map(|name| root.join(name)));
    let texts: BTreeMap<PathBuf, String> =
        pages.iter().map(|page| (page.clone(), fs::read_to_string(page).unwrap())).collect();
    let mut wrong = Vec::new();
    for (page, text) in &texts {
        for target in targets(&prose(text)).into_iter().filter(|target| !target.contains("://")) {
            if page.with_file_name(&target) == made {
                continue;
            }
            let (file, anchor) = target.split_once('#').unwrap_or((&target, ""));
            let path = if file.is_empty() { page.clone() } else { page.parent().unwrap().join(file) };
            let Ok(path) = fs::canonicalize(path) else {
                wrong.push(format!("{}: {target} is missing", page.display()));
                continue;
            };
            if !anchor.is_empty() && !texts.get(&path).is_some_and(|text| anchors(text).contains(anchor)) {
                wrong.push(format!("{}: {target} names no heading", page.display()));
            }
            if page.starts_with(&docs) && !path.starts_with(&docs) {
                wrong.push(format!("{}: {target} leads out of the book", page.display()));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Every page is in the book's list, once.
#[test]
fn the_book_holds_every_page() {
    let docs = root().join("docs");
    let summary = docs.join("SUMMARY.md");
    let mut listed: Vec<PathBuf> =
        targets(&fs::read_to_string(&summary).unwrap()).iter().map(|target| docs.join(target)).collect();
    listed.sort();
    let pages: Vec<PathBuf> = pages_in(&docs).into_iter().filter(|page| *page != summary).collect();
    assert_eq!(listed, pages);
}

#[test]
fn left_out_lines_are_told_apart_from_wrong_ones() {
    let said = "one\ntwo\nthree\nfour\n";
    for (expected, right) in [
        ("one\ntwo\nthree\nfour", true),
        ("one\n…\nfour", true),
        ("…\nthree\n…", true),
        ("one\n…", true),
        ("one\n…\nthree\n…\ntwo\n…", false),
        ("two\n…", false),
        ("one\ntwo", false),
    ] {
        assert_eq!(says(said, expected), right, "{expected}");
    }
}
