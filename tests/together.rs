//! Systems over one factor, stepped together in lanes: each gets the digits that it gets alone, whatever the others do.

mod support;

use coralpipe::model::mesh::Mesh;
use coralpipe::model::resolve::Model;
use coralpipe::solve::law::Scheme;
use coralpipe::solve::march::{Accepted, March};
use coralpipe::solve::start;
use coralpipe::solve::system::{Rayleigh, State, System};
use coralpipe::solve::unsettled::{Place, Unsettled};
use serde_json::{Value, json};
use support::root;

const STEPS: usize = 60;
const DAMPED: Rayleigh = Rayleigh { alpha: 5., beta: 1e-4 };

/// One pipe in layered ground, open at all sides; HHT and the joints' own damping, so that every term of a step is
/// there.
fn model(friction: f64, peak: f64) -> Model {
    let material =
        |young: f64, poisson: f64, density: f64| json!({ "young": young, "poisson": poisson, "density": density });
    let json: Value = json!({
        "materials": { "layer_1": material(183e6, 0.46, 2200.), "layer_2": material(519e6, 0.38, 2600.),
                       "layer_3": material(863e6, 0.27, 2700.), "pipe_left": material(210e9, 0.3, 7800.) },
        "interfaces": { "interface_left": { "body": "pipe_left", "friction": friction } },
        "boundaries": { "base": "viscous", "side_left": "free_field", "side_right": "free_field" },
        "loads": { "surface": { "pressure": { "law": "linear", "peak": peak, "duration": 5e-3 } } },
        "time": { "step": 2.5e-4, "end": STEPS as f64 * 2.5e-4, "hht": -0.05 },
    });
    let mesh = Mesh::read(&root().join("tests/meshes/one_ring.msh")).unwrap();
    support::model(&json, &mesh)
}

/// Friction and peak [Pa] of eight cases; the second is beyond numbers and never gets through its first step.
const CASES: [(f64, f64); 8] =
    [(0.3, 1e5), (0.3, 1e200), (0.1, 1e5), (0.5, -2e5), (0.3, 2e5), (0.2, -1e5), (0.4, 3e5), (0.1, -3e5)];

fn accepted(system: &System, start: State) -> Accepted {
    let origin = State::at_rest(system);
    Accepted::start(system, start, &origin)
}

#[test]
fn each_case_among_others_gets_the_digits_that_it_gets_alone() {
    let models = CASES.map(|(friction, peak)| model(friction, peak));
    let first = System::new(&models[0]).unwrap().with_damping(DAMPED, true);
    let systems = models.each_ref().map(|model| first.with_loads_of(model).unwrap());
    let symbolic = first.symbolic();
    let Model { integrator, time, newton, .. } = &models[0];
    let lead = March::new(&first, &symbolic, Scheme::Dynamic(*integrator), time.step, *newton).unwrap();
    let begin = |system: &System| start::with_acceleration(system, &symbolic, State::at_rest(system), models[0].start);

    // Nothing of the group's code is used here: the cases' own matrices, factored for themselves.
    let alone: Vec<Vec<Accepted>> = (0..CASES.len())
        .map(|k| {
            let system = System::new(&models[k]).unwrap().with_damping(DAMPED, true);
            let symbolic = system.symbolic();
            let mut march = March::new(&system, &symbolic, Scheme::Dynamic(*integrator), time.step, *newton).unwrap();
            let mut last = accepted(&system, begin(&system).unwrap());
            let mut all = Vec::new();
            for _ in 0..STEPS {
                let Ok(steps) = march.advance(&last) else { break };
                last = steps.last().unwrap().clone();
                all.extend(steps);
            }
            all
        })
        .collect();
    assert!(alone[1].is_empty(), "a load of 1e200 Pa has a state");
    // The columns come first; their overflow is told at a node of the model's side, not at one of their own.
    let mut march = lead.sharing_factor(&systems[1]);
    let why = march.advance(&accepted(&systems[1], begin(&systems[1]).unwrap())).unwrap_err();
    let Unsettled::Overflow(Place::Node(node)) = why else { panic!("{why:?}") };
    let xs = || models[1].mesh.points.iter().map(|point| point[0]);
    let sides = [xs().fold(f64::INFINITY, f64::min), xs().fold(f64::NEG_INFINITY, f64::max)];
    assert!(sides.contains(&models[1].mesh.points[node][0]), "node {node} lies inside");
    let slipped = |steps: &Vec<Accepted>| steps.iter().any(|s| s.state().joints.iter().any(|j| j.status.is_slipping()));
    assert!(alone.iter().filter(|steps| slipped(steps)).count() > 5, "joints must slip for this to say something");

    for count in [1, 2, 3, 5, 8] {
        let mut marches: Vec<March> = systems[..count].iter().map(|system| lead.sharing_factor(system)).collect();
        let mut last: Vec<Accepted> =
            systems[..count].iter().map(|system| accepted(system, begin(system).unwrap())).collect();
        let mut together: Vec<Vec<Accepted>> = vec![vec![]; count];
        let mut going: Vec<usize> = (0..count).collect();
        for _ in 0..STEPS {
            let mut there =
                marches.iter_mut().enumerate().filter(|(k, _)| going.contains(k)).map(|(_, m)| m).collect::<Vec<_>>();
            let old: Vec<&Accepted> = going.iter().map(|&k| &last[k]).collect();
            let advanced = March::advance_together(&mut there, &old);
            let ended: Vec<usize> = going.iter().zip(&advanced).filter(|(_, s)| s.is_err()).map(|(&k, _)| k).collect();
            for (&k, steps) in going.iter().zip(advanced).filter_map(|(k, steps)| Some((k, steps.ok()?))) {
                last[k] = steps.last().unwrap().clone();
                together[k].extend(steps);
            }
            going.retain(|k| !ended.contains(k));
        }
        for k in 0..count {
            assert!(together[k] == alone[k], "case {k} of {count}");
        }
    }
}
