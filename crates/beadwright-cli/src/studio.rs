//! `beadwright studio`: starts the desktop program installed next to this one, or serves its page to a browser.

use crate::serve;
use anyhow::{Context, bail};
use std::ffi::OsString;
use std::path::PathBuf;
use std::process::{Command, ExitCode};

#[derive(clap::Args)]
#[command(disable_help_flag = true)]
pub(crate) struct Arguments {
    /// Show the studio in a browser instead: serve its page on this machine, at this port (0: any free one).
    #[arg(long, value_name = "PORT", num_args = 0..=1, default_missing_value = "8320")]
    serve: Option<u16>,
    /// Folder of that page, instead of the one next to this program.
    #[arg(long, value_name = "DIR", requires = "serve")]
    pages: Option<PathBuf>,
    /// Arguments passed unchanged to the desktop program: a model, a project, options; --help lists them.
    #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
    args: Vec<OsString>,
}

/// Runs it until it ends, and returns its exit status.
pub(crate) fn run(arguments: &Arguments) -> anyhow::Result<ExitCode> {
    if let Some(port) = arguments.serve {
        serve::run(port, arguments.pages.as_deref())?;
        return Ok(ExitCode::SUCCESS);
    }
    let own = std::env::current_exe().context("the folder of this program is not known")?;
    let program = own.with_file_name(format!("beadwright-studio{}", std::env::consts::EXE_SUFFIX));
    if !program.is_file() {
        bail!(
            "the desktop program was not found at {}; build it with `cargo build --release -p beadwright-studio`, and put it \
             next to this program",
            program.display()
        );
    }
    let mut command = Command::new(&program);
    start(command.args(&arguments.args)).with_context(|| format!("{} cannot be started", program.display()))
}

/// The desktop program takes the place of this one, so that signals reach it.
#[cfg(unix)]
fn start(command: &mut Command) -> std::io::Result<ExitCode> {
    Err(std::os::unix::process::CommandExt::exec(command))
}

#[cfg(not(unix))]
fn start(command: &mut Command) -> std::io::Result<ExitCode> {
    let code = command.status()?.code().and_then(|code| u8::try_from(code).ok());
    Ok(code.map_or(ExitCode::FAILURE, ExitCode::from))
}
