//! Runs the branches of a program, so that readers of plain programs can read what is left: inputs are on, and a variable
//! says at which pass to begin.

use std::collections::BTreeMap;

/// The files with their branches run one after another, as the main program calls them; the program begins at the number
/// that its variable holds.
pub fn resolved(files: &BTreeMap<String, String>) -> BTreeMap<String, String> {
    let declared = |text: &String| text.lines().find_map(declaration);
    let mut start = files.values().find_map(declared).unwrap_or(0.0);
    files.iter().map(|(name, text)| (name.clone(), resolve(text, &mut start))).collect()
}

/// `DEMO_START=0`, `PERS num nStart:=0;`, `global start_at = 0` or `#<_start> = 0`.
pub(super) fn declaration(line: &str) -> Option<f64> {
    let line = line.trim().trim_end_matches(';');
    let names = ["_START=", "nStart:=", "start_at = ", "#<_start> = "];
    names.iter().find_map(|name| line.split_once(name)?.1.parse().ok())
}

/// The same for one file.
pub fn resolve(text: &str, start: &mut f64) -> String {
    let end = if text.contains("\r\n") { "\r\n" } else { "\n" };
    let (mut out, mut skipped, mut open) = (String::with_capacity(text.len()), None::<usize>, Vec::new());
    for line in text.lines() {
        let bare = line.trim();
        let (begins, ends) = (begins(bare), ends(bare));
        let otherwise = ["ELSE", "else", "else:"].contains(&keyword(bare));
        if let Some(depth) = &mut skipped {
            if otherwise && *depth == 0 {
                // The other branch is run.
                skipped = None;
                open.push(true);
                continue;
            }
            *depth = (*depth + usize::from(begins)).checked_sub(usize::from(ends)).unwrap_or(usize::MAX);
            if *depth == usize::MAX {
                skipped = None;
            }
            continue;
        }
        if otherwise {
            assert_eq!(open.pop(), Some(true), "{bare} without a branch");
            skipped = Some(0);
            continue;
        }
        if begins {
            match holds(bare, *start) {
                true => open.push(true),
                false => skipped = Some(0),
            }
        } else if ends && open.pop() == Some(true) {
        } else if is_reset(bare) && open.last() == Some(&true) {
            *start = 0.0;
        } else if !SILENT.iter().any(|word| bare.starts_with(word))
            && !bare.ends_with("_ARC( )")
            && !bare.contains("#<tried> = ")
        {
            if bare.starts_with("def ") {
                open.push(false);
            }
            out.push_str(line);
            out.push_str(end);
            // What comes behind are subprograms for interrupts.
            if bare == "END" {
                break;
            }
        }
    }
    out
}

/// Statements that deal with inputs only.
const SILENT: [&str; 11] = [
    "$FLAG[1] = FALSE",
    "set_runstate_",
    "INTERRUPT DECL ",
    "INTERRUPT ON ",
    "INTERRUPT OFF ",
    "WAIT FOR",
    "HALT",
    "kill ",
    "watch = run ",
    "#<_start> = ",
    "global start_at = ",
];

fn keyword(line: &str) -> &str {
    let mut words = line.split_whitespace();
    let first = words.next().unwrap_or_default();
    let numbered = first.strip_prefix('O').is_some_and(|n| !n.is_empty() && n.bytes().all(|b| b.is_ascii_digit()));
    if numbered { words.next().unwrap_or_default() } else { first }
}

fn begins(line: &str) -> bool {
    let branch = ["IF", "WHILE", "if", "while"].contains(&keyword(line));
    (branch && !line.contains("EraseModule")) || line.starts_with("thread ")
}

fn ends(line: &str) -> bool {
    ["ENDIF", "ENDWHILE", "endif", "endwhile", "end"].contains(&keyword(line))
}

fn is_reset(line: &str) -> bool {
    declaration(line).is_some() || line.ends_with("_START = 0")
}

fn holds(line: &str, start: f64) -> bool {
    if line.starts_with("thread ")
        || [
            "NOT ($IN[",
            "OR NOT $OUT[",
            "NOT $FLAG[",
            "WHILE late",
            "while get_",
            "not (get_",
            "[#5399 LT 0]",
            "MACH_DEF_INDEX <> ",
        ]
        .iter()
        .any(|asks| line.contains(asks))
    {
        return false;
    }
    let digits = |text: &str| -> f64 {
        text.trim().chars().take_while(char::is_ascii_digit).collect::<String>().parse().unwrap()
    };
    if let Some((_, bound)) = ["<=", " LE "].iter().find_map(|sign| line.split_once(sign)) {
        return start <= digits(bound);
    }
    let (_, bound) = [" GT ", ">"].iter().find_map(|sign| line.split_once(sign)).unwrap();
    start > digits(bound)
}
