//! Statics that is unique, or says so: bodies that nothing holds, loads that have ended, motions that nothing resists,
//! and load steps that decide the answer.

mod program;
mod support;

use coralpipe::model::mesh::{Mesh, Shape};
use coralpipe::model::resolve::Model;
use coralpipe::solve::free_body::Way;
use coralpipe::solve::free_motion::{Free, FreeMotions};
use coralpipe::solve::law::Scheme;
use coralpipe::solve::start;
use coralpipe::solve::step::{Step, Stepper};
use coralpipe::solve::system::{State, System};
use coralpipe::sparse::multiply;
use coralpipe::sparse::vector::norm;
use program::{Bench, Outcome};
use serde_json::{Value, json};
use support::{Drawing, peak, root, run_twin_pipes};

fn run(bench: &Bench, sets: &[&str]) -> Outcome {
    let sets = ["analysis=static", "damping=null"].into_iter().chain(sets.iter().copied());
    bench.run(&["run", "block.json"].into_iter().chain(sets.flat_map(|set| ["--set", set])).collect::<Vec<_>>())
}

/// The largest magnitude of a column of `histories.csv` [m].
fn largest(bench: &Bench, column: &str) -> f64 {
    let text = std::fs::read_to_string(bench.path("output/block/histories.csv")).unwrap();
    let mut lines = text.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let place = lines.next().unwrap().iter().position(|head| *head == column).unwrap();
    peak(&lines.map(|line| line[place].parse().unwrap()).collect::<Vec<f64>>())
}

const RISING: &str = r#"loads.top.pressure={"law":"table","times":[0,0.01],"values":[0,1e5]}"#;

/// The body lies in a hole that is 50 mm wider all round, and the ground comes nearer by less: nothing presses on the
/// body, so it stays where it is, but for round-off: 1e-16 of the forces over the springs of 1e-6 of the stiffness.
#[test]
fn a_body_that_touches_nothing_stays_at_rest_and_is_named() {
    let bench = Bench::new("statics_gap");
    let outcome = run(&bench, &[RISING, "interfaces.interface.gap=50 mm"]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    assert!(outcome.stderr.contains("body \"body\" touches nothing at t = 0 s"), "{}", outcome.stderr);
    let [body, ground] =
        ["P", "Q"].map(|node| largest(&bench, &format!("{node}.ux")).max(largest(&bench, &format!("{node}.uy"))));
    println!("body {body:.1e} m, ground {ground:.1e} m");
    assert!(ground > 1e-4 && body < 1e-9 * ground, "{body:e} m beside {ground:e} m");
    // what touches has no such warning
    let outcome = run(&bench, &[RISING]);
    assert!(outcome.code == Some(0) && !outcome.stderr.contains("touches nothing"), "{}", outcome.stderr);
}

/// The pressure of the default case is over after 50 ms, and nothing is left: neither forces nor, since no gravity
/// presses pipes and ground together, displacements. Residuals are measured against the largest force of the run, by
/// `newton.tolerance` = 1e-8.
#[test]
fn a_load_that_has_ended_leaves_nothing() {
    let run = run_twin_pipes(&["--set", "analysis=static", "--set", "damping=null", "--set", "time.step=5 ms"]);
    assert_eq!(run.number("/steps"), 20.);
    for (name, values) in run.displacements() {
        let left = values[values.len() - 1].abs() / run.peak();
        assert!(left < 1e-8, "{name}: {left:.1e} of the peak");
    }
    assert_eq!(
        run.summary["warnings"].as_array().unwrap().iter().filter(|w| w.to_string().contains("touch")).count(),
        0
    );
}

/// The small ground with one pipe.
fn one_ring() -> Mesh {
    Mesh::read(&root().join("tests/meshes/one_ring.msh")).unwrap()
}

/// Node n of the mesh becomes node n * step mod count: the same mesh, and other round-off.
fn renumbered(mesh: &Mesh, step: usize) -> (Mesh, Vec<usize>) {
    let count = mesh.points.len();
    let gcd = |mut a: usize, mut b: usize| {
        while b > 0 {
            (a, b) = (b, a % b);
        }
        a
    };
    let step = (step..).find(|&s| gcd(s, count) == 1).unwrap();
    let new: Vec<usize> = (0..count).map(|n| n * step % count).collect();
    let mut other = mesh.clone();
    for n in 0..count {
        other.points[new[n]] = mesh.points[n];
        other.tags[new[n]] = mesh.tags[n];
    }
    other.cells.iter_mut().for_each(|cell| cell.nodes.iter_mut().for_each(|n| *n = new[*n]));
    (other, new)
}

/// A steel ring in ground under gravity, then under a pressure, its joints with this friction and gap.
fn ring_case(friction: f64, gap: f64) -> Value {
    let material =
        |young: f64, poisson: f64, density: f64| json!({ "young": young, "poisson": poisson, "density": density });
    json!({
        "analysis": "static", "gravity": 9.81,
        "materials": { "layer_1": material(183e6, 0.46, 2200.), "layer_2": material(519e6, 0.38, 2600.),
                       "layer_3": material(863e6, 0.27, 2700.), "pipe_left": material(210e9, 0.3, 7800.) },
        "interfaces": { "interface_left": { "body": "pipe_left", "friction": friction, "gap": gap } },
        "supports": { "base": ["x", "y"], "side_left": ["x"], "side_right": ["x"] },
        "loads": { "surface": { "pressure": { "law": "table", "times": [0, 0.1], "values": [0, 1e5] } } },
        "time": { "step": 0.05, "end": 0.1 },
    })
}

/// The state under gravity and that after two load steps.
fn states(model: &Model, system: &System) -> [State; 2] {
    let symbolic = system.symbolic();
    let under_gravity = start::under_gravity(system, &symbolic, model.newton).unwrap().unwrap();
    let mut stepper = Stepper::new(system, &symbolic, Scheme::Static, model.time.step, model.newton).unwrap();
    let half = stepper.step(system, &Step::start(under_gravity.clone())).unwrap();
    let whole = stepper.step(system, &half).unwrap();
    [under_gravity, whole.into_state()]
}

fn free_motions(system: &System, state: &State) -> Vec<Free> {
    let motions = FreeMotions::new(system);
    motions.of(&motions.touching(system, state)).into_iter().map(|(_, free)| free).collect()
}

/// |K u + N'r - f| over |f|: the springs of least motion are in neither.
fn imbalance(system: &System, state: &State) -> f64 {
    let f = system.load(state.time);
    let mut left = multiply(&system.stiffness, system.displacements(&state.q));
    let forces = system.interface.forces(state.joints.iter().map(|joint| joint.traction));
    system.unknowns.sides.add_forces(&mut left, 1., &forces);
    left.iter_mut().zip(&f).for_each(|(left, f)| *left -= f);
    norm(&left) / norm(&f)
}

/// Without friction the ring can turn freely, and on one point of a wider hole also roll: it does neither, whatever the
/// order of the nodes, and the springs that keep it from that carry nothing.
#[test]
fn what_can_turn_freely_does_not_turn_whatever_the_order_of_nodes() {
    for gap in [0., 0.01] {
        let model = support::model(&ring_case(0., gap), &one_ring());
        let system = System::new(&model).unwrap();
        let reference = states(&model, &system);
        for state in &reference {
            assert!(free_motions(&system, state).contains(&Free::Along(Way::Turn)));
            // newton.tolerance is 1e-8 of the largest force inside, that of the weight of all the ground
            let left = imbalance(&system, state);
            assert!(left < 1e-8, "gap {gap}: the springs carry {left:.1e}");
        }
        for step in [7, 31] {
            let (mesh, new) = renumbered(&one_ring(), step);
            let model = support::model(&ring_case(0., gap), &mesh);
            let other = System::new(&model).unwrap();
            for (one, another) in reference.iter().zip(states(&model, &other)) {
                let largest = peak(system.displacements(&one.q));
                let apart = |n: usize| {
                    let [a, b] = [system.unknowns.at_node(&one.q, n), other.unknowns.at_node(&another.q, new[n])];
                    (a[0] - b[0]).hypot(a[1] - b[1]) / largest
                };
                let worst = (0..new.len()).map(apart).fold(0., f64::max);
                println!("gap {gap}, order {step}: {worst:.1e}");
                // round-off of a steel ring's stiffness, 1e-11 of the forces, over springs of 1e-6
                assert!(worst < 1e-5, "gap {gap}, order {step}: {worst:.1e} of the largest displacement");
            }
        }
    }
}

/// Friction leaves the ring no free motion; without it a warning says so.
#[test]
fn friction_makes_equilibrium_unique_and_its_absence_is_told() {
    for (friction, is_free) in [(0.3, false), (0., true)] {
        let model = support::model(&ring_case(friction, 0.), &one_ring());
        let system = System::new(&model).unwrap();
        for state in states(&model, &system) {
            assert_eq!(free_motions(&system, &state).is_empty(), !is_free, "friction {friction}");
        }
        let pipe = |side: &str| format!("interfaces.interface_{side}.friction={friction}");
        let sets = ["analysis=static", "damping=null", "time.step=50 ms", &pipe("left"), &pipe("right")];
        let run = run_twin_pipes(&sets.iter().flat_map(|set| ["--set", set]).collect::<Vec<_>>());
        let told = run.summary["warnings"].to_string();
        assert_eq!(told.contains("nothing resists a turn of body \\\"pipe_left\\\""), is_free, "{told}");
    }
}

/// Gravity closes a gap of 1 cm onto friction in one load step: how far the pipe slid before it touched is not resolved.
#[test]
fn gravity_through_a_gap_onto_friction_says_that_the_load_step_decides() {
    let joints = |gap: &str| {
        ["left", "right"]
            .map(|side| format!("interfaces.interface_{side}={{\"body\":\"pipe_{side}\",\"thickness\":\"1 cm\"{gap}}}"))
    };
    for (gap, decides) in [(",\"gap\":\"1 cm\"", true), ("", false)] {
        let [left, right] = joints(gap);
        let sets = ["analysis=static", "damping=null", "gravity=9.81", "time.step=50 ms", &left, &right];
        let run = run_twin_pipes(&sets.iter().flat_map(|set| ["--set", set]).collect::<Vec<_>>());
        let told = run.summary["warnings"].to_string();
        assert_eq!(told.contains("the answer depends on the size of the load step"), decides, "{told}");
    }
}

/// Friction of 2 on joints of .13 mm that the load has first pressed and then left: the bounds f p of the fixed point swing to and
/// fro unless they take shorter steps.
#[test]
fn much_friction_settles_when_the_load_has_gone() {
    let bench = Bench::new("statics_friction");
    let outcome = run(
        &bench,
        &[
            "interfaces.interface.friction=2",
            "interfaces.interface.thickness=0.128 mm",
            "time.step=1 ms",
            r#"loads.top={"traction":{"law":"half_sine","peak":4e4,"duration":"6 ms","direction":[1,-1]}}"#,
        ],
    );
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
}

/// A block of 20 kN with friction 1.5 under a pull of 25 kN: the joint sticks where it presses, and the block tips over its edge.
#[test]
fn a_body_that_tips_is_named_although_a_joint_of_it_sticks() {
    let bench = Bench::new("statics_tips");
    let mut drawing = Drawing::default();
    let [a, b, c, d, e, f] = [[0., 0.], [1., 0.], [0., 1.], [1., 1.], [0., 2.], [1., 2.]].map(|at| drawing.node(at));
    drawing.cell("ground", Shape::Quad4, &[a, b, d, c]);
    drawing.cell("body", Shape::Quad4, &[c, d, f, e]);
    drawing.cell("foot", Shape::Line2, &[c, d]);
    drawing.cell("base", Shape::Line2, &[a, b]);
    bench.write("tower.msh", drawing.text());
    let material = json!({ "young": 1e8, "poisson": 0, "density": 2000 });
    let case = |pull: f64| {
        json!({
            "analysis": "static", "gravity": 10, "geometry": { "mesh": "tower.msh" },
            "materials": { "ground": material, "body": material },
            "interfaces": { "foot": { "body": "body", "thickness": "1 cm", "friction": 1.5 } },
            "supports": { "base": ["x", "y"] },
            "loads": { "body": { "body_force": { "law": "step", "peak": pull, "direction": [1, 0] } } },
            "time": { "step": 1, "end": 1 },
        })
    };
    for (pull, tips) in [(15e3, false), (25e3, true)] {
        bench.write("tower.json", case(pull).to_string());
        let outcome = bench.run_line("run tower.json");
        assert_eq!(outcome.code, Some(if tips { 3 } else { 0 }), "{}", outcome.stderr);
        assert_eq!(outcome.stderr.contains("do not hold \"body\", which tips"), tips, "{}", outcome.stderr);
    }
}

/// Ground and a body on it, 1 m wide and high each, of n elements along the foot; "pin" and "toe" are the body's upper left
/// and lower right corners.
fn block_on_ground(n: usize) -> Drawing {
    let mut drawing = Drawing::default();
    let step = 1. / n as f64;
    let at = |row: usize, column: usize| row * (n + 1) + column;
    for row in 0..=2 * n {
        (0..=n).for_each(|column| {
            drawing.node([column as f64 * step, row as f64 * step]);
        });
    }
    for (row, column) in (0..2 * n).flat_map(|row| (0..n).map(move |column| (row, column))) {
        let corners = [at(row, column), at(row, column + 1), at(row + 1, column + 1), at(row + 1, column)];
        drawing.cell(if row < n { "ground" } else { "body" }, Shape::Quad4, &corners);
    }
    for (group, row) in [("base", 0), ("foot", n)] {
        (0..n).for_each(|column| drawing.cell(group, Shape::Line2, &[at(row, column), at(row, column + 1)]));
    }
    drawing.cell("pin", Shape::Point, &[at(2 * n, 0)]);
    drawing.cell("toe", Shape::Point, &[at(2 * n, n)]);
    drawing
}

/// The block of steel under gravity over a gap [m].
fn block_over_gap(gap: f64, friction: f64) -> Value {
    let material = json!({ "young": 2e11, "poisson": 0.3, "density": 7800 });
    json!({
        "analysis": "static", "gravity": 9.81, "geometry": { "mesh": "block.msh" },
        "materials": { "ground": material, "body": material },
        "interfaces": { "foot": { "body": "body", "thickness": "1 cm", "friction": friction, "gap": gap } },
        "supports": { "base": ["x", "y"] },
        "time": { "step": 1, "end": 1 },
        "probes": ["toe"],
    })
}

/// The block falls through the gap of 3 cm, however stiff the springs are that its elements give it: its first rounds go by
/// F / W, W as E / h, which is more than the gap for 8 elements and less for 32.
#[test]
fn a_block_falls_through_its_gap_on_any_mesh() {
    for n in [8, 32] {
        let bench = Bench::new(&format!("statics_falls_{n}"));
        bench.write("block.msh", block_on_ground(n).text());
        bench.write("block.json", block_over_gap(0.03, 0.3).to_string());
        let outcome = run(&bench, &[]);
        assert_eq!(outcome.code, Some(0), "{n} elements: {}", outcome.stderr);
        let fallen = largest(&bench, "toe.uy");
        println!("{n} elements: {:.3e} m beyond the gap", fallen - 0.03);
        // elements and joints give way by the weight over their stiffness, 7.7e4 N/m2 / 2e11 Pa * 2 m
        assert!((fallen - 0.03).abs() < 1e-5, "{n} elements: {fallen} m");
    }
}

/// Held in x and y at one corner, the block can only turn about it: its toe comes down by the gap.
#[test]
fn a_block_that_is_pinned_at_a_corner_turns_until_its_toe_touches() {
    for friction in [0., 0.3] {
        let bench = Bench::new(&format!("statics_pin_{friction}"));
        bench.write("block.msh", block_on_ground(8).text());
        let mut case = block_over_gap(0.001, friction);
        case["supports"]["pin"] = json!(["x", "y"]);
        bench.write("block.json", case.to_string());
        let outcome = run(&bench, &[]);
        assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
        let down = largest(&bench, "toe.uy");
        println!("friction {friction}: toe {:.3e} m beyond the gap", down - 0.001);
        // as above, and the pin's node gives way by F / E (1 + ln of the block over an element)
        assert!((down - 0.001).abs() < 1e-5, "friction {friction}: {down} m");
    }
}

/// Numbers that no model means are not an answer: 1e25 N/m3 on 2e11 Pa.
#[test]
fn a_displacement_beyond_all_measure_is_refused_with_its_place() {
    let bench = Bench::new("statics_far");
    bench.write("block.msh", block_on_ground(2).text());
    let mut case = block_over_gap(0., 0.3);
    (case["supports"]["pin"], case["supports"]["toe"]) = (json!(["x", "y"]), json!(["x", "y"]));
    let pull = json!({ "law": "table", "times": [0, 1], "values": [0, 1e25], "direction": [0, -1] });
    case["loads"] = json!({ "ground": { "body_force": pull } });
    bench.write("block.json", case.to_string());
    let outcome = run(&bench, &[]);
    assert_eq!(outcome.code, Some(3), "{}", outcome.stderr);
    assert!(outcome.stderr.contains("would go farther than 1e6 times the size of the model"), "{}", outcome.stderr);
}

/// The block rests on the ground under gravity, and the case then lifts it: that state has inertia.
#[test]
fn a_body_that_the_case_lifts_at_the_start_touched_under_gravity() {
    let bench = Bench::new("statics_lifted");
    bench.write("block.msh", block_on_ground(2).text());
    let mut case = block_over_gap(0., 0.3);
    case["initial"] = json!({ "body": { "displacement": [0, 0.05] } });
    case["time"] = json!({ "step": 1e-5, "end": 2e-5 });
    bench.write("block.json", case.to_string());
    let outcome = bench.run_line("run block.json --set analysis=dynamic");
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    assert!(!outcome.stderr.contains("touches nothing"), "{}", outcome.stderr);
    // m g h of 7800 kg and 5 cm; the joints stored less than 1e-6 of it
    let text = std::fs::read_to_string(bench.path("output/block/summary.json")).unwrap();
    let summary: Value = serde_json::from_str(&text).unwrap();
    let supplied = summary["energy"]["supplied"].as_f64().unwrap();
    assert!((supplied / (7800. * 9.81 * 0.05) - 1.).abs() < 1e-5, "{supplied} J/m");
}
