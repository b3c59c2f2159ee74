//! How time and memory of a run grow with the number of unknowns.

use super::case::Size;
use super::clock::Samples;
use super::program::{Finished, run};
use super::table::{Row, seconds};

const ROUNDS: usize = 3;
/// 200 steps, the last two thirds of them with the wave at the pipes.
const SETTINGS: [&str; 2] = ["time.end=20 ms", "output.every=20 ms"];

/// What is compared between sizes.
struct Quantity {
    what: &'static str,
    value: fn(&Finished) -> f64,
    written: fn(f64) -> String,
    /// largest exponent
    goal: Option<f64>,
}

const QUANTITIES: [Quantity; 3] = [
    Quantity { what: "growth of a contact step", value: Finished::step, written: seconds, goal: Some(1.15) },
    Quantity { what: "growth of set-up and factor", value: set_up, written: seconds, goal: None },
    Quantity { what: "growth of peak memory", value: |f| f.memory.unwrap_or(f64::NAN), written: mebibytes, goal: None },
];

/// A row a size beside the smallest, and the exponent p of value ~ N^p over all of them.
pub fn rows(sizes: &[Size]) -> Vec<Row> {
    let rounds: Vec<Vec<Finished>> =
        (0..ROUNDS).map(|_| sizes.iter().map(|size| run(size, &SETTINGS, false)).collect()).collect();
    QUANTITIES.iter().flat_map(|quantity| rows_of(quantity, &rounds)).collect()
}

fn rows_of(quantity: &Quantity, rounds: &[Vec<Finished>]) -> Vec<Row> {
    let samples = |i: usize| Samples(rounds.iter().map(|round| (quantity.value)(&round[i])).collect());
    let first = &rounds[0];
    let unknowns = |i: usize| first[i].count("unknowns");
    let beside_smallest = (1..first.len()).map(|i| Row {
        what: quantity.what,
        unknowns: unknowns(i),
        joint_points: 2 * first[i].count("joints"),
        value: (quantity.written)(samples(i).median()),
        beside: format!("{} unknowns", unknowns(0)),
        reference: (quantity.written)(samples(0).median()),
        ratio: samples(i).over(&samples(0)),
        goal: None,
    });
    let points: Vec<[f64; 2]> = (0..first.len()).map(|i| [unknowns(i) as f64, samples(i).median()]).collect();
    let p = exponent(&points);
    let all = Row {
        what: quantity.what,
        unknowns: unknowns(first.len() - 1),
        joint_points: 0,
        value: format!("N^{p:.2}"),
        beside: "exponent over all sizes".into(),
        reference: String::new(),
        ratio: p,
        goal: quantity.goal,
    };
    beside_smallest.chain([all]).collect()
}

/// Slope of log value over log N, by least squares.
fn exponent(points: &[[f64; 2]]) -> f64 {
    let logs: Vec<[f64; 2]> = points.iter().map(|p| p.map(f64::ln)).collect();
    let mean = [0, 1].map(|k| logs.iter().map(|l| l[k]).sum::<f64>() / logs.len() as f64);
    let moment = |k: usize| logs.iter().map(|l| (l[0] - mean[0]) * (l[k] - mean[k])).sum::<f64>();
    moment(1) / moment(0)
}

fn set_up(run: &Finished) -> f64 {
    let timing = &run.summary["timing"];
    ["setup_s", "factor_s"].iter().filter_map(|key| timing[key].as_f64()).sum()
}

fn mebibytes(m: f64) -> String {
    format!("{m:.0} MiB")
}
