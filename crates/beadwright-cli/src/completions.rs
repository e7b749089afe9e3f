//! `beadwright completions` and `beadwright man`: completion scripts and manual pages.

use anyhow::Context;
use beadwright::files::write_file;
use clap::{Command, CommandFactory};
use clap_complete::Shell;
use std::io::Write;
use std::path::PathBuf;

#[derive(clap::Args)]
pub(crate) struct Completions {
    /// Shell: bash, elvish, fish, powershell or zsh.
    shell: Shell,
}

#[derive(clap::Args)]
pub(crate) struct Man {
    /// Folder for a page of each subcommand; without it, the page of the command itself is printed.
    #[arg(long, short, value_name = "DIR")]
    output: Option<PathBuf>,
}

/// Prints the shell's completion script.
pub(crate) fn completions<A: CommandFactory>(arguments: &Completions) -> anyhow::Result<()> {
    let mut text = Vec::new();
    clap_complete::generate(arguments.shell, &mut A::command(), "beadwright", &mut text);
    Ok(std::io::stdout().write_all(&text)?)
}

/// Prints the page of the command, or writes all pages.
pub(crate) fn man<A: CommandFactory>(arguments: &Man) -> anyhow::Result<()> {
    let mut out = std::io::stdout().lock();
    let Some(folder) = &arguments.output else {
        return Ok(out.write_all(&page(built(A::command()))?)?);
    };
    std::fs::create_dir_all(folder).with_context(|| format!("{}", folder.display()))?;
    let pages = pages("beadwright", &built(A::command()))?;
    for (name, page) in &pages {
        write_file(&folder.join(format!("{name}.1")), page)?;
    }
    writeln!(out, "{} pages in {}", pages.len(), folder.display())?;
    Ok(())
}

/// A command whose subcommands know their full names.
fn built(mut command: Command) -> Command {
    command.build();
    command
}

/// The pages of a command with this name and of its subcommands, by their names.
fn pages(name: &str, command: &Command) -> std::io::Result<Vec<(String, Vec<u8>)>> {
    let mut pages = vec![(name.to_owned(), page(command.clone().display_name(name.to_owned()))?)];
    let shown = |sub: &&Command| !sub.is_hide_set() && sub.get_name() != "help";
    for subcommand in command.get_subcommands().filter(shown) {
        pages.extend(self::pages(&format!("{name}-{}", subcommand.get_name()), subcommand)?);
    }
    Ok(pages)
}

fn page(command: Command) -> std::io::Result<Vec<u8>> {
    let mut text = Vec::new();
    clap_mangen::Man::new(command).render(&mut text)?;
    Ok(text)
}
