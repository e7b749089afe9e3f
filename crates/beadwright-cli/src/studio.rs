//! `beadwright studio`: starts the desktop program that lies beside this one.

use anyhow::{Context, bail};
use std::ffi::OsString;
use std::process::{Command, ExitCode};

#[derive(clap::Args)]
#[command(disable_help_flag = true)]
pub(crate) struct Arguments {
    /// Given to the desktop program as they are: a model, a project, options; --help lists them.
    #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
    args: Vec<OsString>,
}

/// Runs it to its end; gives its exit status.
pub(crate) fn run(arguments: &Arguments) -> anyhow::Result<ExitCode> {
    let own = std::env::current_exe().context("the place of this program is not known")?;
    let program = own.with_file_name(format!("beadwright-studio{}", std::env::consts::EXE_SUFFIX));
    if !program.is_file() {
        bail!(
            "the desktop program is not there: it was looked for at {}; build it with `cargo build --release -p \
             beadwright-studio`, and put it beside this program",
            program.display()
        );
    }
    let status = Command::new(&program).args(&arguments.args).status();
    let status = status.with_context(|| format!("{} cannot be started", program.display()))?;
    // A program that was ended from outside has no status of its own.
    let code = status.code().and_then(|code| u8::try_from(code).ok());
    Ok(if status.success() { ExitCode::SUCCESS } else { code.map_or(ExitCode::FAILURE, ExitCode::from) })
}
