//! Newmark's method on oscillators whose motion is known in closed form, through the program's own march.

mod support;

use coralpipe::model::case::{Integrator, Newmark};
use coralpipe::model::mesh::{Mesh, Shape};
use coralpipe::model::resolve::Model;
use coralpipe::solve::energy::{Forms, Ledger};
use coralpipe::solve::modes::{natural_modes, rayleigh};
use coralpipe::solve::system::Rayleigh;
use coralpipe::solve::system::{State, System};
use coralpipe::sparse::multiply;
use coralpipe::sparse::vector::{add, norm};
use serde_json::{Value, json};
use std::f64::consts::PI;
use support::{Drawing, dot, root};

/// One square of 1 m on a fixed base between rollers, which moves like a mass on a spring: with nu = 0 and consistent
/// mass k = E, m = rho / 3; E = (2 pi)^2, rho = 3 makes omega = 2 pi 1/s and T = 1 s.
fn oscillator(dt: f64, steps: usize, pressure: Value) -> (Model, System) {
    let mut drawing = Drawing::default();
    let n = [[0., 0.], [1., 0.], [1., 1.], [0., 1.]].map(|at| drawing.node(at));
    drawing.cell("mass", Shape::Quad4, &n);
    for (group, a, b) in [("base", 0, 1), ("sides", 1, 2), ("top", 2, 3), ("sides", 3, 0)] {
        drawing.cell(group, Shape::Line2, &[n[a], n[b]]);
    }
    let json = json!({
        "materials": { "mass": { "young": (2. * PI).powi(2), "poisson": 0, "density": 3 } },
        "supports": { "base": ["x", "y"], "sides": ["x"] }, "loads": { "top": { "pressure": pressure } },
        "time": { "step": dt, "end": dt * steps as f64 },
    });
    let model = support::model(&json, &drawing.mesh());
    let system = System::new(&model).unwrap();
    (model, system)
}

/// Displacement of the free oscillator, released from 1 m, at every step.
fn released(dt: f64, steps: usize) -> Vec<f64> {
    let (model, system) = oscillator(dt, steps, json!({ "law": "step", "peak": 0 }));
    let ones = vec![1.; system.unknowns.count];
    let a = vec![-(2. * PI).powi(2); ones.len()];
    let start = State { q: ones, a, ..State::at_rest(&system) };
    let mut u = Vec::new();
    support::march_from(start, &model, &system, |state| u.push(state.q[0]));
    u
}

/// omega = 2 pi, dt = 0.05: u(1) = 0.99870359, all digits of the method, computed independently.
#[test]
fn the_average_acceleration_has_its_exact_digits() {
    let u = released(0.05, 20)[20];
    println!("u(1) = {u:.10}");
    assert!((u - 0.99870359).abs() < 1e-8, "{u}");
}

/// u_n = cos(n phi): the period is 2 pi dt / phi. Elongation [%] by dt / T as tabulated for the method (Bathe).
#[test]
fn the_average_acceleration_lengthens_the_period_as_tabulated() {
    for (dt, percent) in [(0.01, 0.0329), (0.02, 0.1315), (0.05, 0.8171), (0.1, 3.2075), (0.2, 12.0033)] {
        let u = released(dt, 1);
        let elongation = 100. * (2. * PI * dt / u[1].acos() - 1.);
        assert!((elongation - percent).abs() < 1e-4, "dt / T = {dt}: {elongation} %, not {percent} %");
    }
}

/// Undamped load factors of the triangular pulse by duration over period (Biggs' chart, computed to 5 digits). At 2000
/// steps a period the method errs by (omega dt)^2 / 24, below 1e-6; what is left is the table's rounding. Half a step
/// of the load would be 1e-3.
#[test]
fn a_triangular_pulse_has_its_load_factors() {
    let factors = [
        (0.1, 0.31073),
        (0.25, 0.73303),
        (0.5, 1.19619),
        (0.75, 1.42208),
        (1., 1.55024),
        (1.5, 1.68910),
        (2., 1.76264),
        (5., 1.90203),
        (10., 1.95051),
    ];
    let mut worst: f64 = 0.;
    for (duration, factor) in factors {
        let (model, system) = oscillator(5e-4, 2400, json!({ "law": "linear", "peak": 7., "duration": duration }));
        let mut largest: f64 = 0.;
        support::march(&model, &system, |state| largest = largest.max(state.q[0].abs()));
        let found = largest / (7. / (2. * PI).powi(2));
        worst = worst.max((found - factor).abs());
        assert!((found - factor).abs() < 2e-5, "td / T = {duration}: {found}, not {factor}");
    }
    println!("load factors: {worst:.1e}");
}

/// The small ground with one pipe glued in, pressed for 5 ms.
fn bonded_ring(dt: f64, steps: usize, peak: f64) -> Model {
    let material =
        |young: f64, poisson: f64, density: f64| json!({ "young": young, "poisson": poisson, "density": density });
    let json = json!({
        "materials": { "layer_1": material(183e6, 0.46, 2200.), "layer_2": material(519e6, 0.38, 2600.),
                       "layer_3": material(863e6, 0.27, 2700.), "pipe_left": material(210e9, 0.3, 7800.) },
        "interfaces": { "interface_left": "bonded" },
        "supports": { "base": ["x", "y"], "side_left": ["x"], "side_right": ["x"] },
        "loads": { "surface": { "pressure": { "law": "linear", "peak": peak, "duration": "5 ms" } } },
        "time": { "step": dt, "end": dt * steps as f64 },
    });
    support::model(&json, &Mesh::read(&root().join("tests/meshes/one_ring.msh")).unwrap())
}

/// Log decrement of mode 1 in one damped period of `steps` steps, released in its shape; 5 % in modes 1 and 2. The
/// amplitude is that of the exact motion through (y, y'): A^2 = y^2 + ((y' + xi omega y) / omega_d)^2.
fn decrement(steps: usize) -> f64 {
    let mut model = bonded_ring(1., steps, 0.);
    let system = System::new(&model).unwrap();
    let modes = natural_modes(&system, &system.symbolic(), 2).unwrap();
    let (shape, omega) = (&modes[0].shape, 2. * PI * modes[0].frequency);
    let (xi, omega_d) = (0.05_f64, omega * (1. - 0.05_f64.powi(2)).sqrt());
    let system = system.with_damping(rayleigh(xi, [modes[0].frequency, modes[1].frequency]), false);
    model.time.step = 2. * PI / omega_d / steps as f64;
    let a = shape.iter().map(|phi| -omega * omega * phi).collect();
    let start = State { q: shape.clone(), a, ..State::at_rest(&system) };
    let mut amplitudes = Vec::new();
    support::march_from(start, &model, &system, |state| {
        let m_phi = multiply(&system.mass, shape);
        let (y, rate) = (dot(&m_phi, &state.q), dot(&m_phi, &state.v));
        amplitudes.push(y.hypot((rate + xi * omega * y) / omega_d));
    });
    (amplitudes[0] / amplitudes[steps]).ln()
}

/// 2 pi xi / sqrt(1 - xi^2) = 0.3145527 for 5 %; the average acceleration's own error falls with dt^2.
#[test]
fn a_mode_damped_by_five_per_cent_loses_its_log_decrement() {
    let errors = [100, 200].map(|steps| (decrement(steps) / 0.3145527 - 1.).abs());
    println!("log decrement: {:.1e} at 100 steps a period, {:.1e} at 200", errors[0], errors[1]);
    assert!(errors[1] < 5e-4 && errors[1] < 0.3 * errors[0], "{errors:?}");
}

/// Average acceleration, linear: the change of v'Mv/2 + u'Ku/2 in a step is (R_n + R_n+1)'(u_n+1 - u_n)/2 - dt v'Cv, v
/// the mean velocity (Krenk 2006, for one); relative to the energy in the ground, step by step, and in the ledger.
#[test]
fn the_average_acceleration_balances_energy_in_every_step() {
    let model = bonded_ring(1e-4, 300, 1e5);
    let system = System::new(&model).unwrap();
    let system = system.with_damping(coralpipe::solve::system::Rayleigh { alpha: 8., beta: 1e-4 }, false);
    let energy =
        |s: &State| (dot(&s.v, &multiply(&system.mass, &s.v)) + dot(&s.q, &multiply(&system.stiffness, &s.q))) / 2.;
    let mut states: Vec<State> = Vec::new();
    support::march(&model, &system, |state| states.push(state.clone()));
    let largest = states.iter().map(energy).fold(0., f64::max);
    let mut worst: f64 = 0.;
    let mut ledger = Ledger::start(&system, &states[0], &State::at_rest(&system));
    for pair in states.windows(2) {
        let [old, new] = pair else { unreachable!() };
        let du: Vec<f64> = (0..new.q.len()).map(|i| new.q[i] - old.q[i]).collect();
        let v: Vec<f64> = (0..new.v.len()).map(|i| (new.v[i] + old.v[i]) / 2.).collect();
        let work = (dot(&system.load(old.time), &du) + dot(&system.load(new.time), &du)) / 2.;
        let lost = model.time.step * dot(&v, &multiply(&system.damping, &v));
        worst = worst.max((energy(new) - energy(old) - work + lost).abs() / largest);
        ledger = ledger.after(&system, old, new, Forms::of(&system, old, new));
    }
    println!("energy: {worst:.1e} in a step, ledger {:.1e}", ledger.max_relative_error());
    assert!(worst < 1e-12 && ledger.max_relative_error() < 1e-10, "{worst:.1e} {:.1e}", ledger.max_relative_error());
}

/// M a + (1 + alpha)(C v + K u) - alpha (C v + K u)_t = (1 + alpha) f - alpha f_t (Hilber, Hughes and Taylor 1977) in
/// every step under a load that changes and a weight that does not.
#[test]
fn a_step_of_hilber_hughes_and_taylor_satisfies_their_equation() {
    let alpha = -0.2;
    let (mut model, _) = oscillator(0.05, 20, json!({ "law": "linear", "peak": 1, "duration": 0.5 }));
    model.integrator = Integrator { newmark: Newmark { alpha: 0.36, delta: 0.7 }, hht: alpha };
    model.gravity = 9.81;
    let system = System::new(&model).unwrap().with_damping(Rayleigh { alpha: 0.3, beta: 0.02 }, false);
    let mut states = Vec::new();
    support::march_from(State::at_rest(&system), &model, &system, |state| states.push(state.clone()));
    // f - C v - K u
    let rest = |state: &State| {
        let mut rest = system.load(state.time);
        add(&mut rest, -1., &multiply(&system.damping, &state.v));
        add(&mut rest, -1., &multiply(&system.stiffness, &state.q));
        rest
    };
    for pair in states.windows(2) {
        let mut missed = multiply(&system.mass, &pair[1].a);
        let largest = norm(&missed);
        add(&mut missed, -(1. + alpha), &rest(&pair[1]));
        add(&mut missed, alpha, &rest(&pair[0]));
        // a is a small difference of displacements: of its sixteen digits some are lost
        assert!(norm(&missed) < 1e-12 * largest, "{:e} of {largest:e} N", norm(&missed));
    }
}
