//! STEP and IGES solids are converted to STL by another program, where one is installed: Open CASCADE is not linked in.

use crate::file;
use anyhow::Context;
use beadwright::model::{self, is_iges};
use beadwright::task::Task;
use std::path::Path;
use std::process::{Command, Stdio};

/// A program that takes the file to read and the STL file to write.
const VARIABLE: &str = "BEADWRIGHT_CONVERTER";

/// How to get the usual one.
const REMEDY: &str = "Install Open CASCADE for Python (pip install cadquery-ocp-novtk; BEADWRIGHT_PYTHON names a Python other \
                      than python3), or set BEADWRIGHT_CONVERTER to a program that takes the file and the STL file to write; \
                      or save the model as STL.";

/// The usual converter: reads the file, sews its faces, meshes them within 0.02 mm, and writes STL.
const SCRIPT: &str = include_str!("convert.py");

/// The bytes of a model file, converted to STL where it is a solid in STEP or IGES.
///
/// # Errors
/// A sentence where there is no converter, it fails, or what it writes is not closed.
pub(crate) fn solid(path: &Path, bytes: Vec<u8>) -> anyhow::Result<Vec<u8>> {
    let kind = if is_step(&bytes) {
        "a STEP file"
    } else if is_iges(&bytes) && has_surfaces(&bytes) {
        "an IGES file with surfaces"
    } else {
        return Ok(bytes);
    };
    let folder = tempfile::tempdir().context("cannot make a temporary folder for the converted model")?;
    let stl = folder.path().join("model.stl");
    let from = match file::is_standard(path) {
        true => folder.path().join(format!("model.{}", if is_step(&bytes) { "step" } else { "igs" })),
        false => path.to_owned(),
    };
    if file::is_standard(path) {
        std::fs::write(&from, &bytes).context("cannot write the model into a temporary folder")?;
    }
    let mut command = converter(&from, &stl);
    let program = command.get_program().to_string_lossy().into_owned();
    let done = command.stdin(Stdio::null()).output();
    let done = done.map_err(|error| {
        anyhow::anyhow!(
            "{}: this is {kind}, and the converter {program} cannot be started: {error}. {REMEDY}",
            path.display()
        )
    })?;
    let said = String::from_utf8_lossy(&done.stderr);
    if said.contains("No module named 'OCP'") {
        anyhow::bail!("{}: this is {kind}, which needs a converter. {REMEDY}", path.display());
    }
    let written = std::fs::read(&stl);
    match (done.status.success(), written) {
        (true, Ok(stl)) => {
            let open =
                model::import(&stl, &Task::new()).with_context(|| format!("{}", path.display()))?.repair.open_edges;
            anyhow::ensure!(
                open == 0,
                "{}: this is {kind}, and the solid that the converter {program} made from it has {open} open edges: it is not \
                 closed. Mend it in the program that it comes from, or save it as STL there.",
                path.display()
            );
            Ok(stl)
        }
        _ => anyhow::bail!(
            "{}: this is {kind}, and the converter {program} did not turn it into STL: {}. {REMEDY}",
            path.display(),
            said.lines().last().unwrap_or("it says nothing").trim()
        ),
    }
}

fn converter(from: &Path, to: &Path) -> Command {
    if let Some(own) = std::env::var_os(VARIABLE) {
        let mut command = Command::new(own);
        command.arg(from).arg(to);
        return command;
    }
    let mut command = Command::new(std::env::var_os("BEADWRIGHT_PYTHON").unwrap_or_else(|| "python3".into()));
    command.args(["-c", SCRIPT]).arg(from).arg(to);
    command
}

fn is_step(bytes: &[u8]) -> bool {
    bytes.trim_ascii_start().starts_with(b"ISO-10303-21")
}

/// Whether the directory of an IGES file names trimmed or bounded surfaces or solids (entities 143, 144, 186).
fn has_surfaces(bytes: &[u8]) -> bool {
    bytes.split(|&b| b == b'\n').any(|line| {
        let entity = line.get(..8).and_then(|field| std::str::from_utf8(field).ok()).unwrap_or_default().trim();
        line.get(72) == Some(&b'D') && matches!(entity, "143" | "144" | "186")
    })
}
