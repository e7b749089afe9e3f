//! A dialect of one's own: the moves as a table for a spreadsheet.
//!
//! `cargo run --example own_dialect`

use beadwright::dialect::{Chunk, Writer};
use beadwright::program::{Instruction, LayerProgram};
use beadwright::{Profile, Task, example, plan};

type Failure = Box<dyn std::error::Error>;

struct Table;

impl Writer for Table {
    fn begin(&mut self, _extent: &beadwright::layer::Extent) -> Vec<Chunk> {
        vec![Chunk::new("moves.csv", "layer,x,y,z,speed\n")]
    }

    fn layer(&mut self, program: &LayerProgram) -> Vec<Chunk> {
        let row = |instruction: &Instruction| {
            let Some(to) = instruction.target() else { return String::new() };
            let speed = match instruction {
                Instruction::Weld { speed, .. } => format!("{speed:.3}"),
                _ => String::new(),
            };
            format!("{},{:.3},{:.3},{:.3},{speed}\n", program.index + 1, to.x, to.y, to.z)
        };
        vec![Chunk::new("moves.csv", program.instructions.iter().map(row).collect::<String>())]
    }

    fn end(&mut self) -> Vec<Chunk> {
        Vec::new()
    }
}

fn main() -> Result<(), Failure> {
    let profile = Profile::built_in("plasma-304-cnc")?;
    let mesh = example::find("star").ok_or("no such example")?.mesh();
    let plan = plan("star", &mesh, &profile, &Task::new())?;
    let (mut programmer, mut table) = (profile.programmer(), Table);
    let mut text: String = table.begin(&plan.header.extent).into_iter().map(|chunk| chunk.text).collect();
    for layer in &plan.layers {
        text.extend(table.layer(&programmer.layer(layer)).into_iter().map(|chunk| chunk.text));
    }
    println!("{} lines, the first: {}", text.lines().count(), text.lines().nth(1).unwrap_or_default());
    assert!(text.lines().count() > plan.layers.len());
    Ok(())
}

#[test]
fn runs() -> Result<(), Failure> {
    main()
}
