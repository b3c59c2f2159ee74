//! The energy ledger: work of loads and of the free field = kinetic + strain + joint-elastic + damping + boundary +
//! friction + contact + residual.
//!
//! For the average acceleration the equation of motion at both ends of a step gives, exactly, (R_n + R_n+1)'du/2 =
//! change of (kinetic + strain) + dt v'Cv + (r_n + r_n+1)'dj/2, v the mean velocity. The joints' share is then told
//! apart: what they store, what friction turns to heat, and `contact`: the rest, which comes from joints that open,
//! close or begin to slip inside a step, and from joint damping where the case asks for it. The residual is round-off;
//! with other Newmark parameters or HHT it is their numerical damping, and where the case starts with a = 0 it holds
//! the first imbalance.

use super::system::{Rayleigh, State, System};
use crate::model::case::Analysis;
use crate::sparse::multiply;
use crate::sparse::vector::dot;
use sprs::CsMat;

/// Energies since the start, per metre of pipe [J].
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize)]
pub struct Energies {
    pub work: f64,
    /// work that the ground beyond free-field sides did on the model
    pub free_field: f64,
    pub kinetic: f64,
    pub strain: f64,
    pub joint: f64,
    pub damping: f64,
    /// what left through the dashpots of viscous and free-field boundaries
    pub boundary: f64,
    pub friction: f64,
    pub contact: f64,
    pub residual: f64,
}

/// Share of the largest stored energy that opening and closing may gain or lose unsaid.
const SUSPICIOUS: f64 = 0.02;

/// Residual beyond what round-off leaves [of the largest stored energy]: 1e-10 in common runs, 2e-7 after 1e5 steps a
/// thousandth as long.
const UNCLOSED: f64 = 1e-4;

#[derive(Debug, Clone)]
pub struct Ledger {
    pub now: Energies,
    /// the largest kinetic + strain + joint energy so far
    pub peak: f64,
    /// the largest |residual| so far
    worst: f64,
    /// forces at the last state: loads that come and go, free field and joints
    load: Vec<(usize, f64)>,
    free_field: Vec<(usize, f64)>,
    joint_force: Vec<f64>,
}

impl Ledger {
    pub fn start(system: &System, state: &State) -> Ledger {
        let now = stored(system, state, Forms::of(system, state, state));
        Ledger {
            now: Energies { work: now.kinetic + now.strain + now.joint, ..now },
            peak: now.kinetic + now.strain + now.joint,
            worst: 0.,
            load: system.passing_load(state.time),
            free_field: free_field(system, state),
            joint_force: joint_force(system, state),
        }
    }

    /// The ledger after one accepted step; `forms` of its two states.
    pub fn after(&self, system: &System, old: &State, new: &State, forms: Forms) -> Ledger {
        let dt = new.time - old.time;
        let load = system.passing_load(new.time);
        let free_field = free_field(system, new);
        let joint_force = joint_force(system, new);

        let [u, before] = [new, old].map(|state| system.displacements(&state.q));
        let lasting: f64 = system.lasting_loads().map(|f| dot(f, &growth(before, u))).sum();
        let work = lasting + mean_work(&self.load, &load, old, new);
        let joint_work = mean_dot(&self.joint_force, &joint_force, &growth_of_jumps(system, old, new));
        let stored = stored(system, new, forms);
        let dashpots = system
            .dashpots
            .as_ref()
            .map_or(0., |c| dt * drained_by(c, system.displacements(&old.v), system.displacements(&new.v)));
        let damping = dt * forms.drained - dashpots;
        let beyond = outside(system, new).iter().sum::<f64>() - outside(system, old).iter().sum::<f64>();
        let friction = friction(system, old, new);
        let mut now = Energies {
            work: self.now.work + work,
            free_field: self.now.free_field + mean_work(&self.free_field, &free_field, old, new),
            damping: self.now.damping + damping,
            boundary: self.now.boundary + dashpots + beyond,
            friction: self.now.friction + friction,
            contact: self.now.contact + joint_work - (stored.joint - self.now.joint) - friction,
            ..stored
        };
        now.residual = now.work + now.free_field
            - (now.kinetic + now.strain + now.joint + now.damping + now.boundary + now.friction + now.contact);
        Ledger {
            peak: self.peak.max(now.kinetic + now.strain + now.joint),
            worst: self.worst.max(now.residual.abs()),
            now,
            load,
            free_field,
            joint_force,
        }
    }

    /// Says where the joints' bookkeeping is more than a small part of what is stored. In motion joints chatter, and peaks
    /// are not to be trusted. In statics a body slid, or joints opened or closed, between two load steps, whose forces do
    /// not give the work of what lies between them.
    pub fn warning(&self, analysis: Analysis) -> Option<String> {
        let share = self.now.contact / self.peak;
        let percent = 100. * share.abs();
        let sentence = match analysis {
            Analysis::Dynamic => format!(
                "joints that open and close within steps have {} energy, {percent:.1} % of the largest stored: take \
                 time.hht, time.energy_tolerance, damping, or a smaller time.step",
                if share < 0. { "made" } else { "lost" },
            ),
            Analysis::Static => format!(
                "{} between two load steps: the energies are sums over the steps, and {percent:.1} % of the largest stored is \
                 unaccounted for; every step is in equilibrium, but friction depends on the path, so take smaller load steps \
                 (time.step) to follow it",
                if self.now.friction > 0. { "a body slid" } else { "joints opened or closed" },
            ),
        };
        (self.peak > 0. && share.abs() > SUSPICIOUS).then_some(sentence)
    }

    /// Says where the residual is more than round-off, for integrators that leave nothing else in it: then numbers
    /// cancel in the equations themselves, and their solution is not to be trusted either.
    pub fn unclosed(&self) -> Option<String> {
        let error = self.max_relative_error();
        let sound = error < UNCLOSED; // false for NaN
        (!sound).then(|| {
            format!(
                "the energies do not add up: {error:.1e} of the largest stored is missing, where round-off alone would be \
                 some 1e-10: look for damping, a stiffness or a density that is far too large beside the others"
            )
        })
    }

    /// Largest |residual| over the largest stored energy.
    pub fn max_relative_error(&self) -> f64 {
        if self.worst == 0. { 0. } else { self.worst / self.peak }
    }
}

/// What the joints have stored and friction has eaten in one step beyond the work done on them: stored + friction -
/// (r_n + r_n+1)'dj/2 [J].
pub fn joint_gain(system: &System, old: &State, new: &State) -> f64 {
    let work = mean_dot(&joint_force(system, old), &joint_force(system, new), &growth_of_jumps(system, old, new));
    stored_in_joints(system, new) - stored_in_joints(system, old) + friction(system, old, new) - work
}

/// Kinetic + strain + joint energy of a state [J].
pub fn mechanical(system: &System, state: &State, forms: Forms) -> f64 {
    let stored = stored(system, state, forms);
    stored.kinetic + stored.strain + stored.joint
}

/// Quadratic forms of a state and the one before, over all of K, M and C.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Forms {
    /// u'Ku [J]
    pub strain: f64,
    /// v'Mv [J]
    pub kinetic: f64,
    /// w'Cw [W], w the mean of the last velocity and this one
    pub drained: f64,
}

impl Forms {
    /// u, v and w in one unknown.
    #[inline(always)]
    pub fn factors(u: f64, v: f64, v_before: f64) -> [f64; 3] {
        [u, v, (v + v_before) / 2.]
    }

    pub fn of(system: &System, old: &State, new: &State) -> Forms {
        let factors = |i: usize| Forms::factors(new.q[i], new.v[i], old.v[i]);
        let [strain, kinetic, drained] = system.interleaved().forms(factors);
        Forms { strain, kinetic, drained }
    }
}

/// Kinetic v'Mv/2, strain u'Ku/2 and what the joints store [J], without the boundaries' shares of M and K.
fn stored(system: &System, state: &State, forms: Forms) -> Energies {
    let [beyond_v, beyond_q] = outside(system, state);
    Energies {
        kinetic: forms.kinetic / 2. - beyond_v,
        strain: forms.strain / 2. - beyond_q,
        joint: stored_in_joints(system, state),
        ..Energies::default()
    }
}

/// w'Cw [W], w the mean velocity.
fn drained_by(c: &CsMat<f64>, old: &[f64], new: &[f64]) -> f64 {
    let mean: Vec<f64> = new.iter().zip(old).map(|(n, o)| (n + o) / 2.).collect();
    dot(&mean, &multiply(c, &mean))
}

fn stored_in_joints(system: &System, state: &State) -> f64 {
    let jumps = system.jumps(&state.q);
    let points = system.interface.points.iter().zip(&state.joints);
    points.map(|(p, joint)| p.area * p.law.stored_energy(system.interface.local(p, jumps), joint.slip)).sum()
}

/// v'(beta D / 2)v / 2 and u'(alpha D / 2)u / 2: the ground beyond the dashpots D holds them, so they have left.
fn outside(system: &System, state: &State) -> [f64; 2] {
    let Rayleigh { alpha, beta } = system.rayleigh;
    let Some(dashpots) = &system.dashpots else { return [0.; 2] };
    [(beta, &state.v), (alpha, &state.q)].map(|(factor, x)| {
        let x = system.displacements(x);
        factor / 4. * dot(x, &multiply(dashpots, x))
    })
}

fn free_field(system: &System, state: &State) -> Vec<(usize, f64)> {
    let inertia = system.free_field_inertia(&state.free_field);
    system.free_field_force(&state.free_field).into_iter().chain(inertia).collect()
}

/// tau times the growth of plastic slip, over the area.
fn friction(system: &System, old: &State, new: &State) -> f64 {
    let joints = old.joints.iter().zip(&new.joints).zip(&system.interface.points);
    joints.map(|((o, n), p)| p.area * n.traction[0] * (n.slip - o.slip)).sum()
}

fn joint_force(system: &System, state: &State) -> Vec<f64> {
    system.interface.forces(state.joints.iter().map(|j| j.traction))
}

/// Of forces (unknown, [N]) that change from old to new ones while the unknowns move.
fn mean_work(old_forces: &[(usize, f64)], new_forces: &[(usize, f64)], old: &State, new: &State) -> f64 {
    old_forces.iter().chain(new_forces).map(|&(i, f)| f / 2. * (new.q[i] - old.q[i])).sum()
}

fn growth_of_jumps(system: &System, old: &State, new: &State) -> Vec<f64> {
    growth(system.jumps(&old.q), system.jumps(&new.q))
}

fn growth(old: &[f64], new: &[f64]) -> Vec<f64> {
    new.iter().zip(old).map(|(n, o)| n - o).collect()
}

fn mean_dot(a: &[f64], b: &[f64], x: &[f64]) -> f64 {
    (dot(a, x) + dot(b, x)) / 2.
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn energies_that_do_not_add_up_are_told() {
        let with = |worst: f64, peak: f64| Ledger {
            now: Energies::default(),
            peak,
            worst,
            load: vec![],
            free_field: vec![],
            joint_force: vec![],
        };
        for (worst, peak) in [(0., 0.), (1e-10, 1.), (1e-5, 1.)] {
            assert_eq!(with(worst, peak).unclosed(), None, "{worst} of {peak}");
        }
        for (worst, peak) in [(1e-3, 1.), (7.2, 1.), (1., 0.), (f64::NAN, 1.)] {
            assert!(
                with(worst, peak).unclosed().is_some_and(|told| told.contains("do not add up")),
                "{worst} of {peak}"
            );
        }
    }
}
