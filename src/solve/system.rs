//! The equations M a + C v + K u + r(j) = f(t) in the unknowns q, and the state that moves.

use super::assembly;
use super::free_body::FreeBody;
use super::free_field::Column;
use super::interface::{Interface, JointState};
use super::unknowns::Unknowns;
use crate::Result;
use crate::model::moving_front::MovingFront;
use crate::model::resolve::Model;
use crate::physics::pulse::Pulse;
use crate::sparse::vector::{add, add_at};
use crate::sparse::{Interleaved, Orders, Symbolic, multiply, without_zeros};
use nalgebra::Matrix2;
use serde::Serialize;
use sprs::CsMat;
use std::sync::{Arc, OnceLock};

/// K, M and C hold the bodies and what lets waves out of them; they share one pattern, so that sums of them are sums of
/// their values. What is counted by reference belongs to all cases of a sweep.
pub struct System {
    /// the larger of the mesh's extents along x and y [m]
    pub size: f64,
    pub unknowns: Arc<Unknowns>,
    /// [N/m]
    pub stiffness: Arc<CsMat<f64>>,
    /// [kg]
    pub mass: Arc<CsMat<f64>>,
    /// [N s/m]; the dashpots alone until [`System::with_damping`]
    pub damping: Arc<CsMat<f64>>,
    /// the part of C that lets waves out, without its zeros, if there is any [N s/m]
    pub dashpots: Option<Arc<CsMat<f64>>>,
    /// zero until [`System::with_damping`]
    pub rayleigh: Rayleigh,
    /// K, M and what C has beside them, as every step reads them; made when first read, when damping is known
    interleaved: Arc<OnceLock<Interleaved>>,
    /// beta of the joints' own damping, where the case asks for it [s]
    pub joint_beta: Option<f64>,
    pub interface: Interface,
    /// weight of everything [N], if anything weighs; acts at all times
    pub gravity: Option<Arc<Vec<f64>>>,
    /// what held the absorbing boundaries in the static stage [N]; acts at all times, none until
    /// [`start::released`](super::start::released)
    pub reactions: Option<Vec<f64>>,
    /// the ground beyond free-field sides
    pub columns: Vec<Column>,
    /// the bodies that joints alone hold
    pub free_bodies: Arc<[FreeBody]>,
    /// (unknown, N per unit of the pulse) and history
    loads: Vec<(Vec<(usize, f64)>, Pulse)>,
    /// loads that do not act everywhere at once
    fronts: Vec<MovingFront>,
}

/// Rayleigh damping C = alpha M + beta K.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct Rayleigh {
    /// [1/s]
    pub alpha: f64,
    /// [s]
    pub beta: f64,
}

/// Displacement, velocity and acceleration of the unknowns at a time, and what the joints remember.
#[derive(Debug, Clone, PartialEq)]
pub struct State {
    /// [s]
    pub time: f64,
    /// [m], [m/s], [m/s^2], the jumps' behind the unknowns'
    pub q: Vec<f64>,
    pub v: Vec<f64>,
    pub a: Vec<f64>,
    pub joints: Vec<JointState>,
    /// of each column beyond a free-field side
    pub free_field: Vec<State>,
    /// the largest force at the joints in the load steps so far, which residuals without inertia are measured against
    /// [N]
    pub largest_force: f64,
}

impl System {
    pub fn new(model: &Model) -> Result<System> {
        System::ordered(model, &Orders::default())
    }

    /// With the elimination orders that are known; those that are not are added.
    pub fn ordered(model: &Model, orders: &Orders) -> Result<System> {
        let unknowns = Unknowns::new(&model.mesh, &model.fixed, &model.pairs, orders)?;
        let (stiffness, mass) = assembly::stiffness_and_mass(model, &unknowns);
        let damping = assembly::dashpots(model, &unknowns, scaled(&mass, 0.));
        Ok(System {
            size: model.mesh.size(),
            dashpots: (!model.absorbers.is_empty()).then(|| Arc::new(without_zeros(&damping))),
            interleaved: Arc::default(),
            rayleigh: Rayleigh::default(),
            joint_beta: None,
            interface: interface(model, &unknowns),
            gravity: (model.gravity > 0.).then(|| assembly::gravity(model, &unknowns).into()),
            reactions: None,
            columns: columns(model, &unknowns, orders)?,
            free_bodies: FreeBody::all(model, &unknowns),
            loads: loads(model, &unknowns),
            fronts: fronts(model),
            unknowns: unknowns.into(),
            stiffness: stiffness.into(),
            mass: mass.into(),
            damping: damping.into(),
        })
    }

    /// The system of a model that differs from this one's in its loads and the friction of its joints only.
    pub fn with_loads_of(&self, model: &Model) -> Result<System> {
        let columns = self.columns.iter().zip(&model.free_fields);
        Ok(System {
            size: self.size,
            columns: columns.map(|(column, side)| column.with_loads_of(side)).collect::<Result<_>>()?,
            unknowns: self.unknowns.clone(),
            stiffness: self.stiffness.clone(),
            mass: self.mass.clone(),
            damping: self.damping.clone(),
            dashpots: self.dashpots.clone(),
            rayleigh: self.rayleigh,
            interleaved: self.interleaved.clone(),
            joint_beta: self.joint_beta,
            interface: interface(model, &self.unknowns),
            gravity: self.gravity.clone(),
            reactions: None,
            free_bodies: self.free_bodies.clone(),
            loads: loads(model, &self.unknowns),
            fronts: fronts(model),
        })
    }

    /// C = alpha M + beta K of the bodies and the dashpots D; with `joints` beta also damps the closed joints, as the
    /// paper's C(U).
    ///
    /// The ground beyond the dashpots is damped alike: its impedance is rho c sqrt((1 + alpha / i w)(1 + i w beta)), to
    /// first order rho c (1 + alpha / 2 i w + i w beta / 2). So K gets alpha D / 2 and M gets beta D / 2.
    pub fn with_damping(self, Rayleigh { alpha, beta }: Rayleigh, joints: bool) -> System {
        let dashpots = &self.damping;
        let damping = combine(&[(alpha, &self.mass), (beta, &self.stiffness), (1., dashpots)]);
        let stiffness = combine(&[(1., &self.stiffness), (alpha / 2., dashpots)]);
        let mass = combine(&[(1., &self.mass), (beta / 2., dashpots)]);
        System {
            interleaved: Arc::default(),
            stiffness: stiffness.into(),
            mass: mass.into(),
            damping: damping.into(),
            joint_beta: joints.then_some(beta),
            rayleigh: Rayleigh { alpha, beta },
            columns: self.columns.into_iter().map(|c| c.with_damping(Rayleigh { alpha, beta })).collect(),
            ..self
        }
    }

    /// The pattern of all matrices, ready for factors that leave the nodes of the interfaces for last.
    pub fn symbolic(&self) -> Symbolic {
        Symbolic::bordered(&self.mass, self.unknowns.border)
    }

    /// f(t) [N]: loads, weight, and what held the boundaries when nothing moved.
    pub fn load(&self, time: f64) -> Vec<f64> {
        let mut f = vec![0.; self.unknowns.count];
        self.lasting_loads().for_each(|lasting| add(&mut f, 1., lasting));
        add_at(&mut f, 1., &self.passing_load(time));
        f
    }

    /// The parts of f that act at all times [N].
    pub fn lasting_loads(&self) -> impl Iterator<Item = &[f64]> {
        [self.gravity.as_deref(), self.reactions.as_ref()].into_iter().flatten().map(Vec::as_slice)
    }

    /// K, M and what C has beside them, as every step reads them.
    pub fn interleaved(&self) -> &Interleaved {
        let Rayleigh { alpha, beta } = self.rayleigh;
        // C = alpha M_b + beta K_b + D of the bodies' M_b = M - beta D / 2 and K_b = K - alpha D / 2
        let beyond = || self.dashpots.as_ref().map(|d| d.map(|d| (1. - alpha * beta) * d));
        self.interleaved
            .get_or_init(|| Interleaved::new([&self.stiffness, &self.mass], [alpha, beta], beyond().as_ref()))
    }

    /// The part of f that comes and goes: (unknown, force [N]), an unknown perhaps several times.
    pub fn passing_load(&self, time: f64) -> Vec<(usize, f64)> {
        let at_once = self.loads.iter().flat_map(|(vector, pulse)| {
            let factor = pulse.at(time);
            vector.iter().map(move |(i, r)| (*i, factor * r))
        });
        let of_front = |(node, force): (usize, [f64; 2])| {
            [0, 1].into_iter().filter_map(move |axis| Some((self.unknowns.of(node, axis)?, force[axis])))
        };
        let fronts = self.fronts.iter().flat_map(|front| front.forces(time)).flat_map(of_front);
        at_once.chain(fronts).collect()
    }

    /// The boundaries' share of K u, alpha D u / 2 [N].
    pub fn boundary_springs(&self, q: &[f64]) -> Vec<f64> {
        let count = self.unknowns.count;
        let forces = self.dashpots.as_ref().map_or(vec![0.; count], |d| multiply(d, self.displacements(q)));
        forces.into_iter().map(|f| self.rayleigh.alpha / 2. * f).collect()
    }

    /// (unknown, force [N]) of the ground beyond free-field sides in the states of its columns, but for the inertial
    /// part.
    pub fn free_field_force(&self, states: &[State]) -> Vec<(usize, f64)> {
        self.columns.iter().zip(states).flat_map(|(column, state)| column.force(state)).collect()
    }

    /// The part that goes with the columns' acceleration.
    pub fn free_field_inertia(&self, states: &[State]) -> Vec<(usize, f64)> {
        self.columns.iter().zip(states).flat_map(|(column, state)| column.inertia(state)).collect()
    }

    /// The part of a state's vector behind the unknowns: the jumps.
    pub fn jumps<'a>(&self, q: &'a [f64]) -> &'a [f64] {
        &q[self.unknowns.count..]
    }

    /// The part of a state's vector that the matrices know: the unknowns.
    pub fn displacements<'a>(&self, q: &'a [f64]) -> &'a [f64] {
        &q[..self.unknowns.count]
    }

    /// K with joints of these stiffnesses [Pa/m], one for each point.
    pub fn with_joints(&self, stiffnesses: &[Matrix2<f64>]) -> CsMat<f64> {
        let mut closed = CsMat::clone(&self.stiffness);
        for (point, stiffness) in self.interface.points.iter().zip(stiffnesses) {
            self.interface.tangent(point, stiffness, |i, j, value| {
                for (row, sign_i) in self.unknowns.sides.of(i) {
                    for (column, sign_j) in self.unknowns.sides.of(j) {
                        let entry = closed.get_mut(row, column).expect("the pattern holds every joint element");
                        *entry += sign_i * sign_j * value;
                    }
                }
            });
        }
        closed
    }

    /// Stiffness of springs at each joint point that is as large on the diagonal of K as K's own, on its softer side
    /// [Pa/m].
    pub fn stiffness_at_joints(&self) -> Vec<f64> {
        let interface = &self.interface;
        let mut of_unit_springs = vec![0.; self.unknowns.count];
        for point in &interface.points {
            interface.tangent(point, &Matrix2::identity(), |i, j, value| {
                if i == j {
                    self.unknowns.sides.of(i).for_each(|(row, _)| of_unit_springs[row] += value);
                }
            });
        }
        let of_row = |row: usize| self.stiffness.get(row, row).copied().unwrap_or(0.) / of_unit_springs[row];
        let rows = |point| interface.places(point).flat_map(|place| self.unknowns.sides.of(place)).map(|(row, _)| row);
        interface.points.iter().map(|point| rows(point).map(of_row).fold(f64::INFINITY, f64::min)).collect()
    }

    /// Every joint closed and sticking [Pa/m].
    pub fn closed_joints(&self) -> Vec<Matrix2<f64>> {
        self.interface.points.iter().map(|point| point.law.closed_stiffness()).collect()
    }

    /// The same, but none stiffer than the bodies beside it [Pa/m].
    pub fn closed_joints_as_stiff_as_bodies(&self) -> Vec<Matrix2<f64>> {
        let points = self.interface.points.iter().zip(self.stiffness_at_joints());
        points.map(|(point, stiffest)| point.law.closed_no_stiffer_than(stiffest)).collect()
    }
}

fn interface(model: &Model, unknowns: &Unknowns) -> Interface {
    Interface::new(&model.mesh, &model.pairs, &model.joints, &model.laws, &unknowns.jumps)
}

fn loads(model: &Model, unknowns: &Unknowns) -> Vec<(Vec<(usize, f64)>, Pulse)> {
    let simultaneous = model.loads.iter().filter(|load| load.front.is_none());
    let loaded = |vector: Vec<f64>| vector.into_iter().enumerate().filter(|(_, r)| *r != 0.).collect();
    simultaneous.map(|load| (loaded(assembly::load(model, unknowns, load)), load.pulse.clone())).collect()
}

fn fronts(model: &Model) -> Vec<MovingFront> {
    model.loads.iter().filter_map(|load| load.front.clone()).collect()
}

fn columns(model: &Model, unknowns: &Unknowns, orders: &Orders) -> Result<Vec<Column>> {
    model.free_fields.iter().map(|side| Column::new(model, unknowns, side, orders)).collect()
}

impl State {
    /// Every number as [`is_finite`] says, in the columns too.
    pub fn is_finite(&self) -> bool {
        let vectors = [&self.q, &self.v, &self.a];
        vectors.into_iter().flatten().all(|&x| is_finite(x)) && self.free_field.iter().all(State::is_finite)
    }

    pub fn at_rest(system: &System) -> State {
        let zero = vec![0.; system.unknowns.with_jumps()];
        State {
            time: 0.,
            q: zero.clone(),
            v: zero.clone(),
            a: zero,
            joints: vec![JointState::default(); system.interface.points.len()],
            free_field: system.columns.iter().map(|column| State::at_rest(&column.system)).collect(),
            largest_force: 0.,
        }
    }
}

/// Small enough for energies to be finite, too: their squares times stiffnesses, summed, stay below 1e308.
#[inline(always)]
pub fn is_finite(x: f64) -> bool {
    x.abs() < 1e140
}

/// Sum of factor times matrix, all on one pattern.
pub fn combine(terms: &[(f64, &CsMat<f64>)]) -> CsMat<f64> {
    let mut sum = scaled(terms[0].1, terms[0].0);
    for (factor, matrix) in &terms[1..] {
        debug_assert_eq!(sum.indices(), matrix.indices(), "one pattern for all");
        sum.data_mut().iter_mut().zip(matrix.data()).for_each(|(s, m)| *s += factor * m);
    }
    sum
}

fn scaled(matrix: &CsMat<f64>, factor: f64) -> CsMat<f64> {
    let mut scaled = matrix.clone();
    scaled.data_mut().iter_mut().for_each(|v| *v *= factor);
    scaled
}
