//! Forward and backward sweep beside what memory allows and beside faer's own solve.

use super::case::Size;
use super::clock::in_turns;
use super::faer_solve::FaerSolve;
use super::stream;
use super::table::{Row, seconds};
use coralpipe::solve::newmark::Constants;
use coralpipe::solve::system::combine;
use coralpipe::study::prepare::Prepared;

const ROUNDS: usize = 51;

pub fn rows(size: &Size) -> Vec<Row> {
    let Prepared { model, system, symbolic, .. } = &size.prepare(false);
    let constants = Constants::new(model.integrator.newmark, model.time.step);
    let effective = combine(&[(1., &system.stiffness), (constants.a0, &system.mass), (constants.a1, &system.damping)]);
    let factor = symbolic.factor(&effective).expect("K* is positive definite");
    let mut faer = FaerSolve::new(&effective);

    let load = system.load(0.);
    let (mut ours, mut theirs) = (load.clone(), load.clone());
    factor.solve(&mut ours);
    faer.solve(&mut theirs);
    let largest = theirs.iter().fold(0., |m: f64, x| m.max(x.abs()));
    let differ = ours.iter().zip(&theirs).all(|(a, b)| (a - b).abs() <= 1e-10 * largest);
    assert!(differ, "two solutions of one system differ by more than round-off");

    // One array for each packed copy of L.
    let copies = [vec![1.; factor.entries()], vec![1.; factor.entries()]];
    let [limit, sweeps, faer_solve] = in_turns(
        ROUNDS,
        [
            &mut || {
                copies.iter().for_each(|l| {
                    stream::read(l);
                })
            },
            &mut || {
                ours.copy_from_slice(&load);
                factor.solve(&mut ours);
            },
            &mut || {
                theirs.copy_from_slice(&load);
                faer.solve(&mut theirs);
            },
        ],
    );
    let row = |beside: &str, reference: &super::clock::Samples, goal| Row {
        what: "forward + backward sweep",
        unknowns: system.unknowns.count,
        joint_points: system.interface.element_points(),
        value: seconds(sweeps.median()),
        beside: beside.into(),
        reference: seconds(reference.median()),
        ratio: sweeps.over(reference),
        goal: Some(goal),
    };
    vec![row("reading L twice", &limit, 1.6), row("faer's solve", &faer_solve, 0.5)]
}
