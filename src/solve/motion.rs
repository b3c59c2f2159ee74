//! Where a step takes the unknowns of all cases, and what the matrices are multiplied by there.

use super::energy::Forms;
use super::law::Law;
use super::system::{State, System, is_finite};
use super::unsettled::{Place, Unsettled};
use crate::sparse::lanes::TILE;
use crate::sparse::reading::{U, V, W, X, Y};
use crate::sparse::widest::{Kernel, on_widest};
use crate::sparse::{Factors, Lanes};
use std::ops::Range;

/// The motion of one case.
#[derive(Debug, PartialEq)]
pub struct Motion {
    /// u, v, a of the unknowns
    vectors: [Vec<f64>; 3],
    /// as [`is_finite`] says
    finite: bool,
}

impl Motion {
    /// A state's vectors. Velocities and accelerations of the jumps are those of their sides: going on by themselves
    /// they would drift off by the round-off of every step.
    ///
    /// Error: a number has become too large.
    pub fn with_jumps(self, system: &System, jumps: &[f64]) -> Result<[Vec<f64>; 3], Unsettled> {
        let [mut q, mut v, mut a] = self.vectors;
        if !self.finite {
            let spoilt = |x: &Vec<f64>| x.iter().position(|&x| !is_finite(x));
            let unknown = [&q, &v, &a].into_iter().find_map(spoilt).expect("some number is too large");
            return Err(Unsettled::Overflow(Place::Node(system.unknowns.node_of(unknown))));
        }
        q.extend(jumps);
        v.extend(system.unknowns.sides.differences(&v));
        a.extend(system.unknowns.sides.differences(&a));
        Ok([q, v, a])
    }
}

/// The motions of all cases in the making: part by part, each from its old state to the displacements of a step.
pub struct Motions<'a, const K: usize> {
    law: Law,
    old: &'a [&'a State],
    /// u, v, a of the unknowns of each case
    vectors: Vec<[Vec<f64>; 3]>,
    /// 1 where a case has a number that is not as [`is_finite`] says
    spoilt: [f64; K],
}

impl<'a, const K: usize> Motions<'a, K> {
    /// `room`: for so many numbers in each vector.
    pub fn new(law: Law, old: &'a [&'a State], unknowns: usize, room: usize) -> Motions<'a, K> {
        let vector = || {
            let mut vector = Vec::with_capacity(room);
            vector.resize(unknowns, 0.);
            vector
        };
        Motions { law, old, vectors: old.iter().map(|_| [vector(), vector(), vector()]).collect(), spoilt: [0.; K] }
    }

    /// Moves a part of the unknowns to their new displacements among x, and tells what the matrices are multiplied by
    /// there.
    pub fn follow(&mut self, part: Range<usize>, x: &Lanes<K>, factors: &mut [Factors<K>]) {
        let mut tile = [[[0.; K]; TILE]; 3];
        for first in part.clone().step_by(TILE) {
            let here = first..part.end.min(first + TILE);
            for (k, State { q, v, a, .. }) in self.old.iter().enumerate() {
                for (rows, vector) in tile.iter_mut().zip([q, v, a]) {
                    rows.iter_mut().zip(&vector[here.clone()]).for_each(|(row, x)| row[k] = *x);
                }
            }
            let (x, factors) = (&x[here.clone()], &mut factors[here.clone()]);
            on_widest(Follow { law: self.law, x, motions: &mut tile, factors, spoilt: &mut self.spoilt });
            for (k, vectors) in self.vectors.iter_mut().enumerate() {
                for (vector, rows) in vectors.iter_mut().zip(&tile) {
                    vector[here.clone()].iter_mut().zip(rows).for_each(|(x, row)| *x = row[k]);
                }
            }
        }
    }

    /// When all parts have moved.
    pub fn done(self) -> Vec<Motion> {
        let motion = |(vectors, spoilt)| Motion { vectors, finite: spoilt == 0. };
        self.vectors.into_iter().zip(self.spoilt).map(motion).collect()
    }
}

/// Takes some unknowns' motions (u, v, a) to the displacements x, and tells what the matrices are multiplied by.
struct Follow<'a, const K: usize> {
    law: Law,
    x: &'a Lanes<K>,
    motions: &'a mut [[[f64; K]; TILE]; 3],
    factors: &'a mut [Factors<K>],
    /// 1 where a number is not as [`is_finite`] says
    spoilt: &'a mut [f64; K],
}

impl<const K: usize> Kernel for Follow<'_, K> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let [q, v, a] = self.motions;
        for ((((u, q), v), a), factors) in self.x.iter().zip(q).zip(v).zip(a).zip(self.factors) {
            let now;
            (now, *factors) = follow(self.law, u, [*q, *v, *a]);
            [*q, *v, *a] = now;
            for k in 0..K {
                let finite = is_finite(now[0][k]) & is_finite(now[1][k]) & is_finite(now[2][k]);
                self.spoilt[k] = if finite { self.spoilt[k] } else { 1. };
            }
        }
    }
}

/// (u, v, a) of an unknown in all cases, and what the matrices are multiplied by there.
#[inline(always)]
fn follow<const K: usize>(law: Law, u: &[f64; K], before: [[f64; K]; 3]) -> ([[f64; K]; 3], Factors<K>) {
    let (mut motions, mut factors) = ([[0.; K]; 3], [[0.; K]; 5]);
    for k in 0..K {
        let v_before = before[1][k];
        let motion = law.follow(u[k], [before[0][k], v_before, before[2][k]]);
        let (forms, sum) = (Forms::factors(motion[0], motion[1], v_before), law.onward(motion));
        (0..3).for_each(|m| motions[m][k] = motion[m]);
        [U, V, W].into_iter().zip(forms).for_each(|(row, x)| factors[row][k] = x);
        [X, Y].into_iter().zip(sum).for_each(|(row, x)| factors[row][k] = x);
    }
    (motions, factors)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::case::Integrator;
    use crate::solve::law::Scheme;

    /// More unknowns than a tile.
    const COUNT: usize = 2 * TILE + 3;

    fn motion(k: usize, i: usize) -> [f64; 3] {
        [1., 2., 3.].map(|factor| factor * (i + 7 * k) as f64)
    }

    fn cases() -> [State; 3] {
        std::array::from_fn(|k| {
            let [q, v, a] = [0, 1, 2].map(|m| (0..COUNT).map(|i| motion(k, i)[m]).collect());
            State { time: 0., q, v, a, joints: vec![], free_field: vec![], largest_force: 0. }
        })
    }

    fn displacements() -> Vec<[f64; 4]> {
        (0..COUNT).map(|i| std::array::from_fn(|k| (i * k) as f64)).collect()
    }

    /// In two parts, the last unknowns first.
    fn moved(law: Law, x: &[[f64; 4]], old: &[State; 3]) -> (Vec<Motion>, Vec<Factors<4>>) {
        let old = old.each_ref();
        let mut motions = Motions::new(law, &old, COUNT, COUNT);
        let mut factors = vec![[[0.; 4]; 5]; COUNT];
        [5..COUNT, 0..5].into_iter().for_each(|part| motions.follow(part, x, &mut factors));
        (motions.done(), factors)
    }

    #[test]
    fn each_case_moves_by_itself() {
        let law = Law::new(Scheme::Dynamic(Integrator::default()), 0.1);
        let (old, x) = (cases(), displacements());
        let (motions, factors) = moved(law, &x, &old);
        for k in 0..3 {
            assert!(motions[k].finite);
            for i in 0..COUNT {
                let before = motion(k, i);
                let now = law.follow(x[i][k], before);
                assert_eq!([0, 1, 2].map(|m| motions[k].vectors[m][i]), now);
                let [x, y] = law.onward(now);
                assert_eq!(factors[i].map(|f| f[k]), [now[0], now[1], (now[1] + before[1]) / 2., x, y]);
            }
        }
    }

    /// In u, v or a alone, in one case alone. a = 4 (u - u_0) / dt^2 - 4 v_0 / dt - a_0 and v = v_0 + dt (a_0 + a) / 2.
    #[test]
    fn a_case_with_a_number_that_is_too_large_is_told_from_the_others() {
        let dynamic = |dt: f64| Law::new(Scheme::Dynamic(Integrator::default()), dt);
        let spoilt_u = |law: Law, u: f64| {
            let mut x = displacements();
            x[COUNT - 2][1] = u;
            finite(law, &x, &cases())
        };
        for u in [f64::NAN, f64::INFINITY, -1e141] {
            assert_eq!(spoilt_u(Law::new(Scheme::Static, 0.1), u), [true, false, true], "u = {u}");
        }
        // a = 4e140, v = 2e137
        assert_eq!(spoilt_u(dynamic(1e-3), 1e134), [true, false, true], "a");
        // v = -1e141, a = -4e138
        let mut old = cases();
        old[1].v[COUNT - 2] = 1e141;
        assert_eq!(finite(dynamic(1e3), &displacements(), &old), [true, false, true], "v");
    }

    fn finite(law: Law, x: &[[f64; 4]], old: &[State; 3]) -> Vec<bool> {
        moved(law, x, old).0.iter().map(|motion| motion.finite).collect()
    }
}
