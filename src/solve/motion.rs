//! Where a step takes the unknowns: of all cases at once, since what the matrices are multiplied by next comes from it.

use super::energy::Forms;
use super::law::Law;
use super::system::{State, System, is_finite};
use super::unsettled::{Place, Unsettled};
use crate::sparse::widest::{Kernel, on_widest};
use crate::sparse::{Factors, Lanes};

/// The motion of one case.
pub struct Motion {
    /// u, v, a of the unknowns
    vectors: [Vec<f64>; 3],
    /// as [`is_finite`] says
    finite: bool,
}

impl Motion {
    /// A state's vectors. Velocities and accelerations of the jumps are those of their sides: going on by themselves they
    /// would drift off by the round-off of every step.
    ///
    /// Error: a number has become too large.
    pub fn with_jumps(self, system: &System, jumps: &[f64]) -> Result<[Vec<f64>; 3], Unsettled> {
        let [mut q, mut v, mut a] = self.vectors;
        if !self.finite {
            let spoilt =
                |x: &Vec<f64>| system.unknowns.at_nodes(x).iter().position(|u| !u.iter().all(|&u| is_finite(u)));
            let node = [&q, &v, &a].into_iter().find_map(spoilt);
            return Err(Unsettled::Overflow(node.map_or(Place::Matrix, Place::Node)));
        }
        q.extend(jumps);
        v.extend(system.unknowns.differences(&v));
        a.extend(system.unknowns.differences(&a));
        Ok([q, v, a])
    }
}

/// Unknowns that are turned from cases into lanes and back at once: they stay in the nearest cache.
const TILE: usize = 64;

/// The motion of each case after a step from its `old` state to the displacements x, with `room` in each vector, and what the
/// matrices are multiplied by: a row for each unknown and a last one that stands for nothing.
pub fn moved<const K: usize>(law: Law, x: &Lanes<K>, old: &[&State], room: usize) -> (Vec<Motion>, Vec<Factors<K>>) {
    let with_room = |_| Motion { vectors: [0; 3].map(|_| Vec::with_capacity(room)), finite: true };
    let mut motions: Vec<Motion> = old.iter().map(with_room).collect();
    let mut factors = Vec::with_capacity(x.len() + 1);
    let mut tile = [[[0.; K]; 3]; TILE];
    for (number, x) in x.chunks(TILE).enumerate() {
        let start = TILE * number;
        for (k, State { q, v, a, .. }) in old.iter().enumerate() {
            let [q, v, a] = [q, v, a].map(|of_all| &of_all[start..][..x.len()]);
            for (((tile, q), v), a) in tile.iter_mut().zip(q).zip(v).zip(a) {
                (tile[0][k], tile[1][k], tile[2][k]) = (*q, *v, *a);
            }
        }
        on_widest(Follow { law, x, motions: &mut tile, factors: &mut factors });
        for (k, Motion { vectors, finite }) in motions.iter_mut().enumerate() {
            for (m, vector) in vectors.iter_mut().enumerate() {
                vector.extend(tile[..x.len()].iter().map(|tile| tile[m][k]));
                // all of them: a loop that may stop in the middle takes one at a time
                *finite &= vector[start..].iter().fold(true, |finite, &x| finite & is_finite(x));
            }
        }
    }
    factors.push(Factors::ZERO);
    (motions, factors)
}

/// Takes some unknowns' motions (u, v, a) to the displacements x, and appends what the matrices are multiplied by.
struct Follow<'a, const K: usize> {
    law: Law,
    x: &'a Lanes<K>,
    motions: &'a mut [[[f64; K]; 3]],
    factors: &'a mut Vec<Factors<K>>,
}

impl<const K: usize> Kernel for Follow<'_, K> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        for (u, motion) in self.x.iter().zip(self.motions) {
            let (now, factors) = follow(self.law, u, motion);
            *motion = now;
            self.factors.push(factors);
        }
    }
}

/// (u, v, a) of an unknown in all cases, and what the matrices are multiplied by there.
#[inline(always)]
fn follow<const K: usize>(law: Law, u: &[f64; K], before: &[[f64; K]; 3]) -> ([[f64; K]; 3], Factors<K>) {
    let (mut motions, mut factors) = ([[0.; K]; 3], Factors::ZERO);
    for k in 0..K {
        let v_before = before[1][k];
        let motion = law.follow(u[k], [before[0][k], v_before, before[2][k]]);
        let (forms, sum) = (Forms::factors(motion, v_before), law.onward(motion));
        (0..3).for_each(|m| motions[m][k] = motion[m]);
        (0..3).for_each(|m| factors.forms[m][k] = forms[m]);
        (0..2).for_each(|m| factors.sum[m][k] = sum[m]);
    }
    (motions, factors)
}
