//! The energy ledger: work of loads and of the free field = kinetic + strain + joint-elastic + damping + boundary +
//! friction + contact + residual.
//!
//! For the average acceleration the equation of motion at both ends of a step gives, exactly, (R_n + R_n+1)'du/2 =
//! change of (kinetic + strain) + dt v'Cv + (r_n + r_n+1)'dj/2, v the mean velocity. The joints' share is then split
//! into: what they store, what friction turns to heat, and `contact`: the rest, which comes from joints that open,
//! close or begin to slip inside a step, and from joint damping where the case asks for it. The residual is round-off;
//! with other Newmark parameters or HHT it is their numerical damping, and where the case starts with a = 0 it holds
//! the first imbalance.

use super::system::{Rayleigh, State, System};
use crate::model::case::Analysis;
use crate::number::short_to;
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

/// Share of the supplied energy that opening and closing may gain or lose without a warning.
const SUSPICIOUS: f64 = 0.02;

/// Share of the largest stored energy below which energy made by joints is round-off: the ledger's sums lose up to 2e-7
/// of it in 1e5 steps.
const ROUND_OFF: f64 = 1e-7;

/// Residual beyond what round-off leaves [of the largest stored energy]: 1e-10 in common runs, 2e-7 after 1e5 steps a
/// thousandth as long.
const UNCLOSED: f64 = 1e-4;

#[derive(Debug, Clone, PartialEq)]
pub struct Ledger {
    pub now: Energies,
    /// the largest kinetic + strain + joint energy so far
    pub peak: f64,
    /// what a motion can draw on: the largest so far of the energy of the initial motion plus the work of the free field
    /// and of the loads that come and go [J]. Weight and reactions are in equilibrium with the prestress, so that their
    /// work on a motion about that state is no supply.
    pub supplied: f64,
    /// the largest fall of `contact` so far: energy that opening, closing and first slip have made [J]
    pub made: f64,
    /// energy of the initial motion plus the work of the free field and of the loads that come and go [J]
    supply: f64,
    /// the largest `contact` so far [J]
    most_lost: f64,
    /// the largest |residual| so far
    worst: f64,
    /// forces at the last state: loads that come and go, free field and joints
    load: Vec<(usize, f64)>,
    free_field: Vec<(usize, f64)>,
    joint_force: Vec<f64>,
}

impl Ledger {
    /// At t = 0, with `origin` the equilibrium under gravity, which displacements are counted from.
    pub fn start(system: &System, state: &State, origin: &State) -> Ledger {
        let now = stored(system, state, Forms::of(system, state, state));
        let all = now.kinetic + now.strain + now.joint;
        let supplied = now.kinetic + energy_of_displacement(system, state, origin);
        Ledger {
            now: Energies { work: all, ..now },
            peak: all,
            supplied,
            made: 0.,
            supply: supplied,
            most_lost: 0.,
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
        let passing = mean_work(&self.load, &load, old, new);
        let of_free_field = mean_work(&self.free_field, &free_field, old, new);
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
            work: self.now.work + lasting + passing,
            free_field: self.now.free_field + of_free_field,
            damping: self.now.damping + damping,
            boundary: self.now.boundary + dashpots + beyond,
            friction: self.now.friction + friction,
            contact: self.now.contact + joint_work - (stored.joint - self.now.joint) - friction,
            ..stored
        };
        now.residual = now.work + now.free_field
            - (now.kinetic + now.strain + now.joint + now.damping + now.boundary + now.friction + now.contact);
        let most_lost = self.most_lost.max(now.contact);
        let supply = self.supply + passing + of_free_field;
        Ledger {
            peak: self.peak.max(now.kinetic + now.strain + now.joint),
            supplied: self.supplied.max(supply),
            made: self.made.max(most_lost - now.contact),
            supply,
            most_lost,
            worst: self.worst.max(now.residual.abs()),
            now,
            load,
            free_field,
            joint_force,
        }
    }

    /// Whether joints have made more than this share of the supplied energy, and more than round-off.
    pub fn has_made_more_than(&self, share: f64) -> bool {
        self.made > share * self.supplied + ROUND_OFF * self.peak
    }

    /// A sentence where joints have made or lost more than a small part of the supplied energy. In statics a body slid, or
    /// joints opened or closed, between two load steps, whose forces do not give the work of what lies between them.
    pub fn warning(&self, analysis: Analysis) -> Option<String> {
        let lost_too_much = self.now.contact > SUSPICIOUS * self.supplied + ROUND_OFF * self.peak;
        match analysis {
            Analysis::Dynamic if self.has_made_more_than(SUSPICIOUS) => Some(format!(
                "joints that open and close within steps have made {}: {AGAINST_CHATTER}",
                of_supplied(self.made, self.supplied)
            )),
            Analysis::Dynamic if lost_too_much => Some(format!(
                "joints that open and close within steps have lost {}: take a smaller time.step",
                of_supplied(self.now.contact, self.supplied)
            )),
            Analysis::Static if self.now.contact.abs() > SUSPICIOUS * self.peak => Some(format!(
                "{} between two load steps: the energies are sums over the steps, and {:.1} % of the largest stored is \
                 unaccounted for; every step is in equilibrium, but friction depends on the path, so take smaller load steps \
                 (time.step) to follow it",
                if self.now.friction > 0. { "a body slid" } else { "joints opened or closed" },
                100. * self.now.contact.abs() / self.peak
            )),
            _ => None,
        }
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

/// An energy beside the energy supplied, in words.
pub fn of_supplied(energy: f64, supplied: f64) -> String {
    match supplied > 0. {
        true => format!("{} % of the energy supplied", short_to(3, 100. * energy / supplied)),
        false => format!("{} J/m, where neither loads nor an initial motion supply energy", short_to(2, energy)),
    }
}

/// What helps against energy made by joints.
pub const AGAINST_CHATTER: &str =
    "take time.hht = -0.1, mass = \"redistributed\", damping, a smaller time.step or a larger interface thickness";

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

/// u'K u / 2 of the displacement u since the equilibrium `origin`, and what the joints gain beyond the work r_0'dj of the
/// forces that they had there [J]. Weight, reactions and prestress K u_0 + r_0 cancel; a body that is lifted off has its
/// weight's work in r_0.
fn energy_of_displacement(system: &System, state: &State, origin: &State) -> f64 {
    if state.q == origin.q {
        return 0.;
    }
    let from_origin = State { q: growth(&origin.q, &state.q), ..State::at_rest(system) };
    let strain = stored(system, &from_origin, Forms::of(system, &from_origin, &from_origin)).strain;
    let gained = stored_in_joints(system, state) - stored_in_joints(system, origin);
    let work = dot(&joint_force(system, origin), &growth_of_jumps(system, origin, state));
    strain + (gained - work).max(0.)
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
            supplied: peak,
            made: 0.,
            supply: peak,
            most_lost: 0.,
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
