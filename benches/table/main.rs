//! `make bench`: what a step costs, as one table of medians and ratios.
//!
//! Everything that a row compares is taken in turns in one run, so that what else the machine does falls on all alike.
//! `BENCH=full` adds a mesh of a million unknowns; `cargo bench -- NAME` runs the parts whose name holds NAME.

mod case;
mod cases;
mod clock;
mod contact;
mod faer_solve;
mod frames;
mod growth;
mod program;
mod stream;
mod sweeps;
mod table;

use case::{DEFAULT, FOUR_HUNDRED_THOUSAND, HUNDRED_THOUSAND, MILLION, TEN_THOUSAND};
use table::Row;

type Part = (&'static str, fn() -> Vec<Row>);

/// In the order of the table.
const PARTS: [Part; 5] = [
    ("sweeps", || [HUNDRED_THOUSAND, FOUR_HUNDRED_THOUSAND].iter().flat_map(sweeps::rows).collect()),
    ("contact", || [DEFAULT, HUNDRED_THOUSAND].iter().flat_map(contact::rows).collect()),
    ("frames", || [DEFAULT, HUNDRED_THOUSAND].iter().flat_map(frames::rows).collect()),
    ("cases", cases::rows),
    ("growth", || growth::rows(&growing())),
];

fn growing() -> Vec<case::Size> {
    let full = std::env::var("BENCH").is_ok_and(|v| v == "full");
    let largest = full.then_some(MILLION);
    [TEN_THOUSAND, HUNDRED_THOUSAND, FOUR_HUNDRED_THOUSAND].into_iter().chain(largest).collect()
}

fn main() {
    // cargo adds --bench
    let wanted: Vec<String> = std::env::args().skip(1).filter(|a| !a.starts_with('-')).collect();
    // Meshes and results stay there, the meshes for the next time.
    let folder = concat!(env!("CARGO_TARGET_TMPDIR"), "/bench");
    std::fs::create_dir_all(folder)
        .and_then(|()| std::env::set_current_dir(folder))
        .expect("target/ can be written to");
    let parts = PARTS.iter().filter(|(name, _)| wanted.is_empty() || wanted.iter().any(|w| name.contains(w.as_str())));
    let rows = |(name, rows): &Part| {
        eprintln!("bench: {name}");
        rows()
    };
    let rows: Vec<Row> = parts.flat_map(rows).collect();
    print!("{}", table::text(&rows));
}
