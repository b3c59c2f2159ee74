//! Forward and backward sweep beside what memory allows and beside faer's own solve.

use super::case::Size;
use super::clock::{Samples, in_turns};
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
    let factor_on = |threads| symbolic.factor(&effective).expect("K* is positive definite").on_threads(threads);
    let (factor, on_two) = (factor_on(1), factor_on(2));
    let mut faer = FaerSolve::new(&effective);

    let load = system.load(0.);
    let (mut ours, mut theirs, mut on_both) = (load.clone(), load.clone(), load.clone());
    factor.solve(&mut ours);
    on_two.solve(&mut on_both);
    assert_eq!(ours, on_both, "digits with one thread and with two");
    faer.solve(&mut theirs);
    let largest = theirs.iter().fold(0., |m: f64, x| m.max(x.abs()));
    let differ = ours.iter().zip(&theirs).all(|(a, b)| (a - b).abs() <= 1e-10 * largest);
    assert!(differ, "two solutions of one system differ by more than round-off");

    // One array for each packed copy of L.
    let copies = [vec![1.; factor.entries()], vec![1.; factor.entries()]];
    let [limit, sweeps, two_threads, faer_solve] = in_turns(
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
                on_both.copy_from_slice(&load);
                on_two.solve(&mut on_both);
            },
            &mut || {
                theirs.copy_from_slice(&load);
                faer.solve(&mut theirs);
            },
        ],
    );
    let row = |what, sweeps: &Samples, beside: &str, reference: &Samples, goal| Row {
        what,
        unknowns: system.unknowns.count,
        joint_points: system.interface.points.len(),
        value: seconds(sweeps.median()),
        beside: beside.into(),
        reference: seconds(reference.median()),
        ratio: sweeps.over(reference),
        goal,
    };
    let what = "forward + backward sweep";
    vec![
        row(what, &sweeps, "reading L twice", &limit, Some(1.6)),
        row(what, &sweeps, "faer's solve", &faer_solve, Some(0.5)),
        row("the same, two threads", &two_threads, "one thread", &sweeps, None),
    ]
}
