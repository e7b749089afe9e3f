use beadwright::{model, slice::*, task::Task};
use std::time::Instant;
fn main() {
    let f = std::env::args().nth(1).unwrap();
    let n: f64 = std::env::args().nth(2).unwrap().parse().unwrap();
    let t = Instant::now();
    let b = std::fs::read(&f).unwrap();
    println!("read {:?}", t.elapsed());
    let t = Instant::now();
    let c = b.clone();
    println!("memcpy {:?} {}", t.elapsed(), c.len());
    let task = Task::new();
    let t = Instant::now();
    let mut i = match model::import(&b, &task) {
        Ok(i) => i,
        Err(e) => {
            println!("{e}");
            return;
        }
    };
    println!("import {:?} {:?}", t.elapsed(), i.repair);
    i.mesh.place(1.0, glam::DVec3::ZERO);
    let h = i.mesh.size().z / n;
    let t = Instant::now();
    let s = Slicer::new(&i.mesh, SliceOptions { layer_height: h, close_gap: 0.1, simplify: 0.01 }, &task).unwrap();
    println!("prep {:?}", t.elapsed());
    let l = s.all(&task).unwrap();
    println!("slice {:?}", t.elapsed());
    let v: f64 = l.iter().map(|l| l.area() * h).sum();
    println!(
        "layers {} vol ratio {} verts {} islands {}",
        l.len(),
        v / i.mesh.volume(),
        l.iter().flat_map(|l| &l.islands).flat_map(|p| p.rings()).map(|r| r.points().len()).sum::<usize>(),
        l.iter().map(|l| l.islands.len()).sum::<usize>()
    );
    let mut w = beadwright::warning::Warnings::default();
    for x in l.iter().flat_map(|l| &l.warnings) {
        w.add(*x)
    }
    for s in w.summaries() {
        println!("{}", s.sentence())
    }
}
