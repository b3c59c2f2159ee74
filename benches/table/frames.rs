//! Whole runs of the program: frames every ten steps beside none, contact beside bonded.

use super::case::Size;
use super::clock::Samples;
use super::program::{Finished, run};
use super::table::{Row, seconds};

const ROUNDS: usize = 3;
/// The first state and the last one only.
const NO_FRAMES: &str = "output.every=100 ms";
const EVERY_TEN_STEPS: &str = "output.every=1 ms";

pub fn rows(size: &Size) -> Vec<Row> {
    let rounds: Vec<[Finished; 3]> = (0..ROUNDS)
        .map(|_| [run(size, &[EVERY_TEN_STEPS], false), run(size, &[NO_FRAMES], false), run(size, &[NO_FRAMES], true)])
        .collect();
    let of = |which: usize, value: fn(&Finished) -> f64| Samples(rounds.iter().map(|r| value(&r[which])).collect());
    let row = |what, beside: &str, value: Samples, reference: Samples, goal| Row {
        what,
        unknowns: rounds[0][0].count("unknowns"),
        joint_points: 2 * rounds[0][0].count("joints"),
        value: seconds(value.median()),
        beside: beside.into(),
        reference: seconds(reference.median()),
        ratio: value.over(&reference),
        goal: Some(goal),
    };
    vec![
        row("contact step, program", "bonded step", of(1, Finished::step), of(2, Finished::step), 1.15),
        row("run, a frame every 10 steps", "run without frames", of(0, |f| f.wall), of(1, |f| f.wall), 1.10),
    ]
}
