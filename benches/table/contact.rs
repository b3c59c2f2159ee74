//! A contact step beside a linear one: the equations alone, over the whole run of the default case.

use super::case::{Size, ready_to_step};
use super::clock::{Samples, seconds as time};
use super::table::{Row, seconds};
use coralpipe::solve::step::{Step, Stepper};
use coralpipe::solve::system::System;

const ROUNDS: usize = 3;
/// Steps of one before the other has its turn: enough to have its own factor in the cache, if that fits.
const TURN: usize = 50;

struct Runner<'a> {
    system: &'a System,
    last: Step,
    stepper: Stepper,
    seconds: f64,
    /// steps that left some joint open, and slipping
    open: usize,
    slipping: usize,
}

impl Runner<'_> {
    fn take_turn(&mut self, steps: usize) {
        for _ in 0..steps {
            self.seconds += time(|| {
                self.last = self.stepper.step(self.system, &self.last).expect("the default case converges");
            });
            let joints = &self.last.state().joints;
            self.open += usize::from(joints.iter().any(|j| j.status.is_open()));
            self.slipping += usize::from(joints.iter().any(|j| j.status.is_slipping()));
        }
    }
}

pub fn rows(size: &Size) -> Vec<Row> {
    let [contact, bonded] = [false, true].map(|bonded| size.prepare(bonded));
    let steps = contact.model.time.steps;
    let (mut of_contact, mut of_bonded) = (Samples(vec![]), Samples(vec![]));
    for _ in 0..ROUNDS {
        let [mut a, mut b] = [&contact, &bonded].map(|prepared| {
            let (last, stepper) = ready_to_step(prepared);
            Runner { system: &prepared.system, last, stepper, seconds: 0., open: 0, slipping: 0 }
        });
        for _ in 0..steps / TURN {
            a.take_turn(TURN);
            b.take_turn(TURN);
        }
        assert!(a.open > steps / 10 && a.slipping > steps / 10, "a run without opening and slip shows nothing");
        of_contact.0.push(a.seconds / steps as f64);
        of_bonded.0.push(b.seconds / steps as f64);
    }
    vec![Row {
        what: "contact step, equations",
        unknowns: contact.system.unknowns.count,
        joint_points: contact.system.interface.element_points(),
        value: seconds(of_contact.median()),
        beside: "bonded step".into(),
        reference: seconds(of_bonded.median()),
        ratio: of_contact.over(&of_bonded),
        goal: Some(1.15),
    }]
}
