//! Bodies that hang on joints alone, joints of very unlike stiffness, and steps in which no digits are left.

mod support;

use coralpipe::model::mesh::{Mesh, Shape};
use coralpipe::model::resolve::Model;
use coralpipe::solve::assembly;
use coralpipe::solve::condensed::Condensed;
use coralpipe::solve::interface::JointState;
use coralpipe::solve::law::Scheme;
use coralpipe::solve::step::{Step, Stepper};
use coralpipe::solve::system::{State, System};
use coralpipe::sparse::multiply;
use coralpipe::sparse::vector::norm;
use serde_json::json;
use support::Drawing;

const COLUMNS: usize = 8;

/// Ground, a on it and b on a, 2 m wide and 1 m high each.
fn stack() -> Mesh {
    let mut drawing = Drawing::default();
    let at = |row: usize, column: usize| row * (COLUMNS + 1) + column;
    for row in 0..=6 {
        (0..=COLUMNS).for_each(|column| {
            drawing.node([2. * column as f64 / COLUMNS as f64, 0.5 * row as f64]);
        });
    }
    for (row, column) in (0..6).flat_map(|row| (0..COLUMNS).map(move |column| (row, column))) {
        let corners = [at(row, column), at(row, column + 1), at(row + 1, column + 1), at(row + 1, column)];
        drawing.cell(["ground", "a", "b"][row / 2], Shape::Quad4, &corners);
    }
    for (group, row) in [("base", 0), ("ga", 2), ("ab", 4), ("top", 6)] {
        (0..COLUMNS).for_each(|column| drawing.cell(group, Shape::Line2, &[at(row, column), at(row, column + 1)]));
    }
    drawing.mesh()
}

/// Joints of these normal stiffnesses [Pa/m]; pressed down, and a tenth of that sideways.
fn model(stiffness: [f64; 2], young_of_a: f64, step: f64) -> Model {
    let material = |young: f64| json!({ "young": young, "poisson": 0.3, "density": 2000, "friction": 0.5 });
    let interface = |body: &str, k: f64| json!({ "body": body, "normal_stiffness": k, "tangential_stiffness": k / 3. });
    let json = json!({
        "materials": { "ground": material(1e8), "a": material(young_of_a), "b": material(1e8) },
        "interfaces": { "ga": interface("a", stiffness[0]), "ab": interface("b", stiffness[1]) },
        "supports": { "base": ["x", "y"] },
        "loads": { "top": { "traction": { "law": "step", "peak": 1e5, "direction": [0.1, -1.] } } },
        "time": { "step": step, "end": 4. * step },
    });
    support::model(&json, &stack())
}

/// |K u + N'r - f| over |f|.
fn imbalance(model: &Model, system: &System, q: &[f64], joints: &[JointState]) -> f64 {
    let f = assembly::load(model, &system.unknowns, &model.loads[0]);
    let f: Vec<f64> = f.iter().map(|f| f * model.loads[0].pulse.at(0.)).collect();
    let mut left = multiply(&system.stiffness, system.displacements(q));
    let forces = system.interface.forces(joints.iter().map(|joint| joint.traction));
    system.unknowns.sides.add_forces(&mut left, 1., &forces);
    left.iter_mut().zip(&f).for_each(|(left, f)| *left -= f);
    norm(&left) / norm(&f)
}

/// A soft joint must hold its body while Newton finds out how stiff another one is.
#[test]
fn joints_of_unlike_stiffness_find_their_equilibrium() {
    for (stiffness, young_of_a) in [
        ([1e9, 1e9], 1e8),
        ([1e7, 1e13], 1e8),
        ([1e6, 1e14], 1e8),
        ([1e10, 1e16], 1e8),
        ([1e14, 1e8], 1e8),
        ([1e4, 1e20], 1e8),
        ([1e6, 1e12], 2e11),
    ] {
        let model = model(stiffness, young_of_a, 1.);
        let system = System::new(&model).unwrap();
        let load = assembly::load(&model, &system.unknowns, &model.loads[0]);
        let load = load.iter().map(|f| f * model.loads[0].pulse.at(0.)).collect();
        let mut condensed = Condensed::hanging(&system, &system.symbolic(), model.newton).unwrap();
        let (q, solution) = condensed.solve(&system, load, &State::at_rest(&system)).unwrap();
        let joints: Vec<JointState> = solution.responses.iter().map(JointState::from).collect();
        let left = imbalance(&model, &system, &q, &joints);
        println!("{stiffness:?}, {young_of_a:e}: {} iterations, imbalance {left:.1e}", solution.iterations);
        // newton.tolerance is 1e-8 of the largest force inside, which may be twice the load
        assert!(left < 2e-8, "{stiffness:?}, {young_of_a:e}: {left:.1e}");
        assert!(solution.iterations < 10, "{stiffness:?}: {} iterations", solution.iterations);
    }
}

/// In a step of 10 s inertia is nothing, and what bodies on stiff joints do is round-off of K*: such a step is refused.
#[test]
fn a_step_that_leaves_no_digits_is_not_accepted() {
    let model = model([1e12, 1e12], 1e8, 10.);
    let system = System::new(&model).unwrap();
    let scheme = Scheme::Dynamic(model.integrator);
    let mut stepper = Stepper::new(&system, &system.symbolic(), scheme, 10., model.newton).unwrap();
    assert!(stepper.step(&system, &Step::start(State::at_rest(&system))).is_err());
}
