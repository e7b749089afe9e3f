//! The command in a folder: what it says where it succeeds, and where it refuses.

use std::path::Path;
use std::process::{Command, Output};

/// Runs the command.
pub(crate) fn beadwright(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_beadwright")).current_dir(folder).args(arguments).output().unwrap()
}

/// Runs what must succeed; gives what it prints.
pub(crate) fn ok(folder: &Path, arguments: &[&str]) -> String {
    let output = beadwright(folder, arguments);
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

/// Runs what must be refused; gives the message.
pub(crate) fn refused(folder: &Path, arguments: &[&str], status: i32) -> String {
    let output = beadwright(folder, arguments);
    assert_eq!(output.status.code(), Some(status), "{arguments:?}");
    String::from_utf8(output.stderr).unwrap()
}
