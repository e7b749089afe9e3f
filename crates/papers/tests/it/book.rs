//! The page of the book on the papers: its tables are those of `beadwright reproduce`, its pictures too.
//! `BEADWRIGHT_GOLDEN=write cargo test -p beadwright-papers --test it book::` writes both anew.

use beadwright::task::Task;
use beadwright_papers::{PAPERS, goal};
use std::fs;
use std::path::Path;

#[test]
fn the_page_on_the_papers_shows_what_is_reached() {
    let write = std::env::var("BEADWRIGHT_GOLDEN").is_ok_and(|v| v == "write");
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs");
    let page = docs.join("book/papers.md");
    let mut text = fs::read_to_string(&page).unwrap();
    for paper in PAPERS {
        let done = (paper.run)(&Task::new()).unwrap();
        let (from, to) = (format!("<!-- {} -->\n", paper.name), format!("<!-- end of {} -->", paper.name));
        let (first, last) = (text.find(&from).unwrap() + from.len(), text.find(&to).unwrap());
        let now = format!("\n{}\n", goal::markdown(&done.goals));
        if write {
            text.replace_range(first..last, &now);
        } else {
            assert_eq!(&text[first..last], now, "{}", paper.name);
        }
        for (name, svg) in done.pictures {
            let file = docs.join("pictures/papers").join(name);
            if write {
                fs::create_dir_all(file.parent().unwrap()).unwrap();
                fs::write(&file, svg).unwrap();
            } else {
                assert_eq!(fs::read_to_string(&file).unwrap(), svg, "{name}");
            }
        }
    }
    if write {
        fs::write(&page, text).unwrap();
    }
}
