//! What follows from the case's numbers before anything is solved, and whether a computer can hold it.

use super::case::{Case, Damping, Rayleigh};
use super::resolve::{Load, Model, Target};
use crate::physics::joint::Friction;
use crate::{Error, Result};

/// A number that follows from others.
struct Derived {
    /// the key that it comes from
    key: String,
    /// what it is, and how it is computed
    what: &'static str,
    value: f64,
}

/// Error: the first number that is not finite, with its key.
pub fn refuse_overflow(case: &Case, model: &Model) -> Result<()> {
    let all = materials(model)
        .chain(joints(model))
        .chain(time(case, model))
        .chain(damping(model))
        .chain(model.loads.iter().flat_map(load))
        .chain(mesh(model));
    match all.into_iter().find(|number| !number.value.is_finite()) {
        None => Ok(()),
        Some(Derived { key, what, .. }) => Err(Error::input(format!(
            "{}: {key}: {what} is no finite number: it is more than a computer can hold (1.8e308); change the numbers that it \
             follows from",
            case.path().display()
        ))),
    }
}

fn materials(model: &Model) -> impl Iterator<Item = Derived> {
    model.materials.iter().flat_map(|(name, m)| {
        let numbers = [
            ("the constrained modulus E (1 - nu) / (1 + nu)(1 - 2 nu)", m.oedometric_modulus()),
            ("the bulk modulus E / 3 (1 - 2 nu)", m.bulk_modulus()),
            ("the speed of P waves, sqrt(constrained modulus / density),", m.p_speed()),
            ("the impedance density x speed of P waves", m.density * m.p_speed()),
            ("the weight density x gravity", m.density * model.gravity),
        ];
        numbers.map(|(what, value)| Derived { key: format!("materials.{name}"), what, value })
    })
}

fn joints(model: &Model) -> impl Iterator<Item = Derived> {
    model.joints.iter().zip(&model.laws).flat_map(|(joint, (law, _))| {
        let limit = match law.friction {
            Friction::Coulomb(f) => f * law.normal_stiffness,
            Friction::Tresca(bound) => bound,
        };
        let numbers = [
            ("the normal stiffness E_oed / thickness", law.normal_stiffness),
            ("the tangential stiffness G / thickness", law.tangential_stiffness),
            ("friction x normal stiffness", limit),
        ];
        let key = format!("interfaces.{}", model.seams[joint.seam].curve);
        numbers.map(|(what, value)| Derived { key: key.clone(), what, value })
    })
}

fn time(case: &Case, model: &Model) -> impl Iterator<Item = Derived> {
    let step = model.time.step;
    [
        (
            "step",
            "1 / (alpha step^2), which the mass is multiplied by,",
            1. / (case.time.integrator().newmark.alpha * step * step),
        ),
        ("energy_tolerance", "energy_tolerance / end", model.time.energy.rate),
    ]
    .map(|(key, what, value)| Derived { key: format!("time.{key}"), what, value })
    .into_iter()
}

fn damping(model: &Model) -> impl Iterator<Item = Derived> {
    let coefficients = model.damping.and_then(|Damping { rayleigh, .. }| match rayleigh {
        Rayleigh::Coefficients { alpha, beta } => Some([alpha, beta]),
        Rayleigh::Ratio { .. } => None,
    });
    coefficients.into_iter().flat_map(|[alpha, beta]| {
        let largest = |number: fn(&crate::physics::material::Material) -> f64| {
            model.materials.iter().map(|(_, m)| number(m)).fold(0., f64::max)
        };
        [
            ("alpha", "alpha x density", alpha * largest(|m| m.density)),
            ("beta", "beta x constrained modulus", beta * largest(|m| m.oedometric_modulus())),
            ("beta", "alpha x beta", alpha * beta),
        ]
        .map(|(key, what, value)| Derived { key: format!("damping.{key}"), what, value })
    })
}

fn load(load: &Load) -> impl Iterator<Item = Derived> {
    let kind = match load.target {
        Target::Pressure { .. } => "pressure",
        Target::Traction { .. } => "traction",
        Target::BodyForce { .. } => "body_force",
        Target::Force { .. } => "force",
    };
    let key = format!("loads.{}.{kind}", load.group);
    let [first, last] = load.front.as_ref().map_or([0.; 2], |front| front.passage());
    [
        ("its largest value, with \"scale\",", load.pulse.largest()),
        ("the time at which it ends, \"start\" + \"rise\" + its duration,", load.pulse.last_time()),
        ("the time at which its front reaches the curve", first),
        ("the time at which its front reaches the end of the curve", last),
    ]
    .map(|(what, value)| Derived { key: key.clone(), what, value })
    .into_iter()
}

/// Areas and masses of elements are no larger than those of the rectangle round the mesh.
fn mesh(model: &Model) -> impl Iterator<Item = Derived> {
    let extent = |axis: usize| {
        let places = model.mesh.points.iter().map(|p| p[axis]);
        let [low, high] = places.fold([f64::INFINITY, f64::NEG_INFINITY], |[l, h], x| [l.min(x), h.max(x)]);
        high - low
    };
    let area = extent(0) * extent(1);
    let heaviest = model.materials.iter().map(|(_, m)| m.density).fold(0., f64::max);
    [("the area of the mesh", area), ("the mass density x area", area * heaviest)]
        .map(|(what, value)| Derived { key: model.mesh.name.clone(), what, value })
        .into_iter()
}
