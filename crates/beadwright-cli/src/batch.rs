//! `beadwright batch`: many plans, one table. Every file is planned with every profile, strategy and swept value.
//!
//! | file | what it does |
//! | --- | --- |
//! | `sweep` | keys of the profile with the values they take |
//! | `row` | one plan and what is kept of it |
//! | `side_by_side` | runs on all processors, each kept in its place |
//! | `table` | rows for the terminal, as CSV, JSON and HTML |

mod row;
mod side_by_side;
mod sweep;
mod table;

use crate::plan::{parse_grid, parse_height};
use crate::{file, model, profile, progress, say};
use beadwright::fill::StrategyName;
use row::{Asked, Row, Run};
use std::io::Write;
use std::path::PathBuf;
use sweep::Sweep;
use table::{Format, Table};

#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// Models, each planned separately.
    #[arg(required = true, value_name = "MODEL")]
    files: Vec<PathBuf>,
    #[command(flatten)]
    placing: model::Placing,
    /// Height of a part given by its outlines (DXF, SVG) or of a wall given by its centre-lines (IGES), mm.
    #[arg(long, value_name = "MM", value_parser = parse_height)]
    height: Option<f64>,
    /// Profile: a built-in name or a TOML file; may be given several times.
    #[arg(long, short, default_value = profile::USUAL, value_name = "NAME|FILE")]
    profile: Vec<String>,
    /// Strategy instead of the profile's; may be given several times.
    #[arg(long, short, value_name = "NAME")]
    strategy: Vec<StrategyName>,
    /// Values of a key of the profile, such as fill.strategy=loop,zigzag, or N of them from A to B, such as
    /// layers.height=1.8:2.2:3; if given several times, every value of one is combined with every value of the others.
    #[arg(long, value_name = "KEY=V1,V2,…|KEY=A:B:N", value_parser = sweep::parse)]
    sweep: Vec<Sweep>,
    /// Change a value of the profile in all plans; may be given several times.
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Table to write: .csv, .json or .html, by the extension of the name.
    #[arg(long, short, value_name = "FILE", value_parser = table::parse_output)]
    output: Option<(PathBuf, Format)>,
    /// Skip the deposit model: faster, but no voids and no overfill.
    #[arg(long)]
    no_deposit: bool,
    /// Grid spacing of the deposit model, mm; a twentieth of the bead width if left out.
    #[arg(long, value_name = "MM", value_parser = parse_grid, conflicts_with = "no_deposit")]
    grid: Option<f64>,
    /// Print the table as JSON.
    #[arg(long)]
    json: bool,
    /// Number of plans made at the same time; one for each of the machine's processors if left out. The table does
    /// not depend on it.
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
}

/// Maximum number of plans in a batch.
const MOST_PLANS: usize = 100_000;

/// Plans that should not be welded as they are.
#[derive(Debug, thiserror::Error)]
#[error("{unfit} of {plans} plans should not be welded as they are; their rows say why.")]
pub(crate) struct Unfit {
    unfit: usize,
    plans: usize,
}

pub(crate) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let runs = arguments.runs()?;
    let (task, bar) = progress::counting(runs.len())?;
    let asked = arguments.asked();
    let planned = side_by_side::map(&runs, arguments.threads, |run| {
        let row = Row::of(run, &asked, &task);
        bar.inc(1);
        row
    })?;
    bar.finish_and_clear();
    anyhow::ensure!(task.check().is_ok(), "cancelled; nothing was written");
    let table = Table::new(planned);
    if let Some((path, format)) = &arguments.output {
        file::write(path, table.written(*format)?.as_bytes())?;
    }
    let mut out = std::io::stdout().lock();
    out.write_all(if arguments.json { table.written(Format::Json)? } else { table.terminal() }.as_bytes())?;
    drop(out);
    if let Some((path, _)) = arguments.output.as_ref().filter(|_| !arguments.json) {
        writeln!(say::done(false), "\n{} rows in {}", runs.len(), path.display())?;
    }
    verdict(&table)
}

/// The exit status: plans that failed weigh more than plans that should not be welded.
fn verdict(table: &Table) -> anyhow::Result<()> {
    let (plans, failed, unfit) = table.counts();
    anyhow::ensure!(failed == 0, "{failed} of {plans} plans could not be made; their rows say why.");
    if unfit == 0 { Ok(()) } else { Err(Unfit { unfit, plans }.into()) }
}

impl Arguments {
    /// Every file with every profile, strategy and swept value, in this order.
    fn runs(&self) -> anyhow::Result<Vec<Run>> {
        let strategies: Vec<Option<StrategyName>> =
            if self.strategy.is_empty() { vec![None] } else { self.strategy.iter().copied().map(Some).collect() };
        let factors = [self.files.len(), self.profile.len(), strategies.len()];
        let plans = factors.into_iter().chain(self.sweep.iter().map(Sweep::len)).fold(1, usize::saturating_mul);
        anyhow::ensure!(
            plans <= MOST_PLANS,
            "this makes {plans} plans, and at most {MOST_PLANS} are made at a time. Sweep fewer keys or fewer values."
        );
        let points = sweep::points(&self.sweep);
        let mut runs = Vec::with_capacity(plans);
        for file in &self.files {
            for profile in &self.profile {
                for &strategy in &strategies {
                    let run = |swept: &Vec<(String, String)>| Run {
                        file: file.clone(),
                        profile: profile.clone(),
                        strategy,
                        swept: swept.clone(),
                    };
                    runs.extend(points.iter().map(run));
                }
            }
        }
        Ok(runs)
    }

    /// What is the same for all plans.
    fn asked(&self) -> Asked<'_> {
        let html = self.output.as_ref().is_some_and(|(_, format)| *format == Format::Html);
        Asked {
            placing: &self.placing,
            height: self.height,
            set: &self.set,
            grid: self.grid,
            deposit: !self.no_deposit,
            pictures: html,
        }
    }
}

impl Row {
    /// The row of a run; an error is kept in it, so that the others continue.
    fn of(run: &Run, asked: &Asked<'_>, task: &beadwright::task::Task) -> Self {
        let planned =
            if task.check().is_ok() { row::plan(run, asked, task) } else { Err(anyhow::anyhow!("cancelled")) };
        let planned = planned.map_err(|error| {
            let remedy = crate::remedy::of(&error).map_or(String::new(), |remedy| format!(" {remedy}"));
            format!("{error:#}{remedy}")
        });
        Self { run: run.clone(), planned }
    }
}
