//! `beadwright reproduce`: the papers' tables and figures, ours next to theirs.

use crate::progress;
use anyhow::Context;
use beadwright::files::Folder;
use beadwright_papers::PAPERS;
use std::io::Write;
use std::path::PathBuf;

#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// Name of the paper; all papers if left out.
    paper: Option<String>,
    /// Folder for the pages.
    #[arg(long, short, default_value = "beadwright-out", value_name = "DIR")]
    output: PathBuf,
}

pub(crate) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let names = || PAPERS.iter().map(|p| p.name).collect::<Vec<_>>().join(", ");
    let papers: Vec<_> = match &arguments.paper {
        None => PAPERS.iter().collect(),
        Some(name) => {
            let paper = PAPERS.iter().find(|p| p.name == name);
            vec![paper.with_context(|| format!("there is no paper \"{name}\". The papers are {}.", names()))?]
        }
    };
    let (task, bar) = progress::task()?;
    let mut output = Folder::new(&arguments.output)?;
    let mut said = Vec::new();
    for paper in papers {
        let done = (paper.run)(&task)?;
        let file = format!("reproduce-{}.html", paper.name);
        output.append(&file, done.page.html())?;
        done.files.iter().try_for_each(|(name, text)| output.append(name, text))?;
        said.push(format!("{}: {}", paper.name, paper.about));
        said.extend(done.lines.iter().map(|line| format!("  {line}")));
        said.push(format!("  tables and pictures in {}", arguments.output.join(&file).display()));
    }
    bar.finish_and_clear();
    output.commit()?;
    let mut out = std::io::stdout().lock();
    said.iter().try_for_each(|line| writeln!(out, "{line}"))?;
    Ok(())
}
