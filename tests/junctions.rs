//! Interfaces that meet, cross and end, and what acts on their sides.

mod program;
mod support;

use coralpipe::model::case::Newton;
use coralpipe::model::mesh::{Mesh, Shape};
use coralpipe::model::resolve::Model;
use coralpipe::solve::law::Scheme;
use coralpipe::solve::step::{Step, Stepper};
use coralpipe::solve::system::{State, System};
use coralpipe::sparse::multiply;
use program::Bench;
use serde_json::{Value, json};
use support::junction::{box_on_a_bed, four_blocks};
use support::{Drawing, node_at, peak};

/// Ground held at its base and sides, pressed from above with 100 kPa in statics.
fn case(interfaces: Value) -> Value {
    let ground = |young: f64| json!({ "young": young, "poisson": 0.3, "density": 2000, "friction": 0.3 });
    json!({
        "analysis": "static",
        "materials": { "layer_1": ground(100e6), "layer_2": ground(50e6), "pipe_left": ground(1e9) },
        "interfaces": interfaces,
        "supports": { "base": ["x", "y"], "side_left": ["x"], "side_right": ["x"] },
        "loads": { "surface": { "pressure": { "law": "step", "peak": "100 kPa" } } },
        "time": { "step": 1, "end": 1 },
    })
}

/// Joints 1e6 times as stiff as 1 m of the ground, which do not slip.
fn glued(body: &str) -> Value {
    json!({ "body": body, "normal_stiffness": 1e14, "tangential_stiffness": 1e14, "friction": 10 })
}

/// The equilibrium under the loads at the end of the first step.
fn equilibrium(model: &Model, system: &System) -> State {
    let options = Newton { tolerance: 1e-12, ..Newton::default() };
    let mut stepper = Stepper::new(system, &system.symbolic(), Scheme::Static, 1., options).unwrap();
    let rest = Step::start(State::at_rest(system));
    assert!(!model.joints.is_empty());
    stepper.step(system, &rest).unwrap().into_state()
}

/// Displacements of the nodes of the opened mesh [m].
fn displacements(json: &Value, mesh: &Mesh) -> (Model, Vec<[f64; 2]>) {
    let model = support::model(json, mesh);
    let system = System::new(&model).unwrap();
    let state = equilibrium(&model, &system);
    (model, system.unknowns.at_nodes(&state.q))
}

fn merged(json: &Value, mesh: &Mesh) -> Vec<[f64; 2]> {
    let model = Model::new(&support::case(json), mesh, true).unwrap();
    let system = System::new(&model).unwrap();
    let mut u = system.load(1.);
    system.symbolic().solve_once(&system.stiffness, &mut u).unwrap();
    system.unknowns.at_nodes(&u)
}

/// The joints yield by 1e-6 of what 1 m of ground does, a tenth of that of the 6 m x 4 m of ground.
#[test]
fn stiff_joints_through_t_and_x_junctions_are_the_merged_mesh() {
    let t = (box_on_a_bed(), json!({ "interface_left": glued("pipe_left"), "bed": glued("layer_2") }));
    let x = (four_blocks(), json!({ "upright": glued("left"), "level": glued("layer_2") }));
    for (drawing, interfaces) in [t, x] {
        let (mesh, json) = (drawing.mesh(), case(interfaces));
        let (model, opened) = displacements(&json, &mesh);
        let merged = merged(&json, &mesh);
        assert!(opened.len() > merged.len());
        let at = |node: usize| merged[node_at(&mesh, model.mesh.points[node])];
        let largest = peak(merged.as_flattened());
        for (node, u) in opened.iter().enumerate() {
            let off = (0..2).map(|k| (u[k] - at(node)[k]).abs()).fold(0., f64::max);
            assert!(off < 1e-6 * largest, "{:e} of the peak at {:?}", off / largest, model.mesh.points[node]);
        }
    }
}

/// K u + N'r = f: round-off of sums of some ten forces of 50 kN.
#[test]
fn forces_balance_at_every_copy_of_a_triple_point() {
    let mesh = box_on_a_bed().mesh();
    let json = case(json!({ "interface_left": { "body": "pipe_left" }, "bed": { "body": "layer_2" } }));
    let model = support::model(&json, &mesh);
    let system = System::new(&model).unwrap();
    let state = equilibrium(&model, &system);
    let slipping = state.joints.iter().filter(|joint| joint.status.is_slipping()).count();
    assert!(slipping > 0, "the box is stiffer than the ground, which slides along it");
    let mut forces = multiply(&system.stiffness, system.displacements(&state.q));
    let joints = system.interface.forces(state.joints.iter().map(|joint| joint.traction));
    system.unknowns.sides.add_forces(&mut forces, 1., &joints);
    let load = system.load(1.);
    let triple: Vec<usize> =
        (0..model.mesh.points.len()).filter(|&n| [[2.5, 2.], [3.5, 2.]].contains(&model.mesh.points[n])).collect();
    assert_eq!(triple.len(), 6);
    for node in triple {
        for axis in 0..2 {
            let i = system.unknowns.of(node, axis).unwrap();
            let (carried, off) = (joints.iter().map(|f| f.abs()).fold(0., f64::max), (forces[i] - load[i]).abs());
            assert!(off < 1e-12 * carried, "{:e} of {carried:e} N", off / carried);
        }
    }
}

/// Names decide which interface is opened first, node numbers which copy is numbered first: neither counts.
#[test]
fn neither_names_nor_node_numbers_change_the_answer() {
    let names = |bed: &str| json!({ "interface_left": { "body": "pipe_left" }, bed: { "body": "layer_2" } });
    let drawing = box_on_a_bed();
    let (first, second) = (drawing.mesh(), drawing.renamed("bed", "z_bed").backwards().mesh());
    let (model, u) = displacements(&case(names("bed")), &first);
    let (other_model, other_u) = displacements(&case(names("z_bed")), &second);
    let largest = peak(u.as_flattened());
    // displacements at each place, sorted since copies are numbered otherwise
    let at = |model: &Model, u: &[[f64; 2]], place: [f64; 2], axis: usize| {
        let here = (0..u.len()).filter(|&n| model.mesh.points[n] == place);
        let mut values: Vec<f64> = here.map(|n| u[n][axis]).collect();
        values.sort_by(f64::total_cmp);
        values
    };
    for &place in &model.mesh.points {
        for axis in 0..2 {
            let [a, b] = [at(&model, &u, place, axis), at(&other_model, &other_u, place, axis)];
            assert_eq!(a.len(), b.len());
            // the tolerance of Newton's residual, 1e-12, times the condition of a block on a smooth bed
            assert!(a.iter().zip(&b).all(|(a, b)| (a - b).abs() < 1e-9 * largest), "{place:?}: {a:?} {b:?}");
        }
    }
}

/// A crack from (1, 1) to (2, 1) in a plate 3 m x 2 m: two nodes inside it, one at each tip.
#[test]
fn an_interface_may_end_inside_the_solid() {
    let mut drawing = plate(6, 4, |_, j| if j < 2 { "layer_1" } else { "layer_2" });
    for i in 2..4 {
        let row = |i: usize| 2 * 7 + i;
        drawing.cell("crack", Shape::Line2, &[row(i), row(i + 1)]);
    }
    let json = case(json!({ "crack": { "body": "layer_2" } }));
    let model = support::model(&json, &drawing.mesh());
    let copies = |x: f64| model.mesh.points.iter().filter(|p| **p == [x, 1.]).count();
    assert_eq!([1., 1.5, 2.].map(copies), [1, 2, 1]);
    let system = System::new(&model).unwrap();
    assert_eq!(system.unknowns.sides.count(), 2, "one pair along two axes");
}

/// 3 m x 2 m of squares of 0.5 m in `across` columns and `up` rows, held and loaded as in [`case`].
fn plate(across: usize, up: usize, group: impl Fn(usize, usize) -> &'static str) -> Drawing {
    let mut drawing = Drawing::default();
    let node = |i: usize, j: usize| j * (across + 1) + i;
    (0..=up).for_each(|j| (0..=across).for_each(|i| _ = drawing.node([i as f64 / 2., j as f64 / 2.])));
    for j in 0..up {
        for i in 0..across {
            let nodes = [node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)];
            drawing.cell(group(i, j), Shape::Quad4, &nodes);
        }
        drawing.cell("side_left", Shape::Line2, &[node(0, j), node(0, j + 1)]);
        drawing.cell("side_right", Shape::Line2, &[node(across, j), node(across, j + 1)]);
    }
    for i in 0..across {
        drawing.cell("base", Shape::Line2, &[node(i, 0), node(i + 1, 0)]);
        drawing.cell("surface", Shape::Line2, &[node(i, up), node(i + 1, up)]);
    }
    drawing
}

/// A block on another, the joint between them at y = 1 m called "joint".
fn two_blocks() -> Mesh {
    let mut drawing = plate(2, 4, |_, j| if j < 2 { "layer_1" } else { "layer_2" });
    (0..2).for_each(|i| drawing.cell("joint", Shape::Line2, &[6 + i, 7 + i]));
    drawing.mesh()
}

#[test]
fn a_support_on_an_interface_holds_both_sides_unless_it_names_one() {
    let held = |name: &str| {
        let mut json = case(json!({ "joint": { "body": "layer_2" } }));
        json["supports"] = json!({ "base": ["x", "y"], name: ["x", "y"] });
        let model = support::model(&json, &two_blocks());
        [0, 1].map(|of_body: usize| {
            let row = model.pairs.iter().map(|pair| [pair.ground, pair.body][of_body]);
            row.filter(|&n| model.fixed[n] == [true; 2]).count()
        })
    };
    assert_eq!(held("joint"), [3, 3]);
    assert_eq!(held("joint@ground"), [3, 0]);
    assert_eq!(held("joint@body"), [0, 3]);
}

/// 100 kPa on the upper block and 40 kPa in the joint: the joint carries 60 kPa, and is pressed together by that over
/// its stiffness. Exact but for round-off: stress and strain are uniform.
#[test]
fn a_pressure_on_an_interface_acts_in_the_joint_on_both_sides() {
    let mut json = case(json!({ "joint": { "body": "layer_2", "normal_stiffness": 1e9 } }));
    json["loads"]["joint"] = json!({ "pressure": { "law": "step", "peak": "40 kPa" } });
    let model = support::model(&json, &two_blocks());
    let system = System::new(&model).unwrap();
    let state = equilibrium(&model, &system);
    for (point, joint) in system.interface.points.iter().zip(&state.joints) {
        assert!((joint.traction[1] + 60e3).abs() < 1e-6 * 60e3, "{}", joint.traction[1]);
        let closed = system.interface.local(point, system.jumps(&state.q))[1];
        assert!((closed + 60e3 / 1e9).abs() < 1e-6 * 6e-5, "{closed}");
    }
}

#[test]
fn a_traction_on_an_interface_must_name_its_side() {
    let mut json = case(json!({ "joint": { "body": "layer_2" } }));
    json["loads"] = json!({ "joint": { "traction": { "law": "step", "peak": "1 kPa", "direction": [1, 0] } } });
    let sentence = Model::new(&support::case(&json), &two_blocks(), false).unwrap_err().to_string();
    assert!(sentence.contains("\"joint@body\" or \"joint@ground\""), "{sentence}");
}

#[test]
fn a_line_in_two_interfaces_is_refused() {
    let mut drawing = plate(2, 4, |_, j| if j < 2 { "layer_1" } else { "layer_2" });
    for name in ["first", "second"] {
        (0..2).for_each(|i| drawing.cell(name, Shape::Line2, &[6 + i, 7 + i]));
    }
    let json = case(json!({ "first": { "body": "layer_2" }, "second": { "body": "layer_2" } }));
    let sentence = Model::new(&support::case(&json), &drawing.mesh(), false).unwrap_err().to_string();
    assert!(sentence.contains("\"first\" and \"second\"") && sentence.contains("(0.2500, 1.0000)"), "{sentence}");
}

/// The body would be bonded unnoticed; "bonded" says that it is meant.
#[test]
fn a_closed_curve_that_the_case_forgets_is_refused_unless_it_is_bonded() {
    let mesh = box_on_a_bed().mesh();
    let model = |interfaces: Value| Model::new(&support::case(&case(interfaces)), &mesh, false);
    let why = model(json!({})).unwrap_err().to_string();
    for words in
        ["\"interface_left\"", "\"pipe_left\"", "{ \"body\": \"pipe_left\" }", "interfaces.interface_left = \"bonded\""]
    {
        assert!(why.contains(words), "{words}: {why}");
    }
    let bonded = model(json!({ "interface_left": "bonded" })).unwrap();
    assert!(bonded.joints.is_empty());
    assert!(!bonded.warnings.iter().any(|w| w.contains("interface_left")), "{:?}", bonded.warnings);
    let elsewhere = model(json!({ "interface_left": "bonded", "ring": "bonded" })).unwrap();
    assert!(elsewhere.warnings.iter().any(|w| w.contains("\"ring\" is not used")), "{:?}", elsewhere.warnings);
    // an open curve between two layers is no body's border
    assert!(model(json!({ "interface_left": glued("pipe_left") })).is_ok());
}

/// A square of 7 by 7 with a hollow block of 5 by 5 and a core of 3 by 3 in it, and curves round the block and the core.
fn block_round_a_core(block_face: &str, core_face: &str) -> Drawing {
    const N: usize = 7;
    let mut drawing = Drawing::default();
    let node = |i: usize, j: usize| j * (N + 1) + i;
    (0..=N).for_each(|j| (0..=N).for_each(|i| _ = drawing.node([i as f64, j as f64])));
    let from_edge = |i: usize, j: usize| i.min(j).min(N - 1 - i).min(N - 1 - j);
    for (j, i) in (0..N).flat_map(|j| (0..N).map(move |i| (j, i))) {
        let group = ["ground", "block", "core", "core"][from_edge(i, j)];
        drawing.cell(group, Shape::Quad4, &[node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)]);
    }
    for (curve, first, last) in [(block_face, 1, 6), (core_face, 2, 5)] {
        for k in first..last {
            for level in [first, last] {
                drawing.cell(curve, Shape::Line2, &[node(k, level), node(k + 1, level)]);
                drawing.cell(curve, Shape::Line2, &[node(level, k), node(level, k + 1)]);
            }
        }
    }
    (0..N).for_each(|i| drawing.cell("base", Shape::Line2, &[node(i, 0), node(i + 1, 0)]));
    drawing
}

/// Each of two nested closed curves, also where both are one group; a bonded body is still a body.
#[test]
fn forgotten_curves_round_hollow_bodies_are_refused_too() {
    let ground = json!({ "young": 1e8, "poisson": 0.3, "density": 2000, "friction": 0.3 });
    let model = |drawing: &Drawing, interfaces: Value| {
        let json = json!({
            "analysis": "static",
            "materials": { "ground": ground, "block": ground, "core": ground },
            "interfaces": interfaces,
            "supports": { "base": ["x", "y"] },
            "time": { "step": 1, "end": 1 },
        });
        Model::new(&support::case(&json), &drawing.mesh(), false)
    };
    let drawing = block_round_a_core("block_face", "core_face");
    for (given, forgotten, body) in [("core_face", "block_face", "block"), ("block_face", "core_face", "core")] {
        let other = if given == "core_face" { "core" } else { "block" };
        let why = model(&drawing, json!({ given: { "body": other } })).unwrap_err().to_string();
        assert!(why.contains(&format!("\"{forgotten}\" is the border between \"{body}\"")), "{why}");
    }
    let one_group = block_round_a_core("faces", "faces");
    let why = model(&one_group, json!({})).unwrap_err().to_string();
    assert!(why.contains("\"faces\" is the border"), "{why}");
    let bonded = model(&drawing, json!({ "core_face": { "body": "core" }, "block_face": "bonded" })).unwrap();
    assert_eq!(bonded.bodies, ["block", "core"]);
}

/// An arc of two lines that are drawn towards each other: the second is read as if it went on from the first.
#[test]
fn a_crack_has_one_body_side_along_the_whole_curve() {
    let mut sides = Vec::new();
    for second in [[1, 2], [2, 1]] {
        let mut drawing = four_blocks();
        let at = |x: f64, y: f64| [x, y];
        let nodes = [at(2., 1.), at(2.5, 1.), at(3., 1.)]
            .map(|place| (0..drawing.len()).find(|&node| drawing.at(node) == place).unwrap());
        drawing.cell("crack", Shape::Line2, &[nodes[0], nodes[1]]);
        drawing.cell("crack", Shape::Line2, &second.map(|k: usize| nodes[k]));
        let mut json = case(json!({ "crack": { "body": "layer_1" } }));
        json["materials"].as_object_mut().unwrap().remove("pipe_left");
        let model = support::model(&json, &drawing.mesh());
        let above = |joint: &coralpipe::model::split::Joint| {
            let [body, ground] = [joint.body_cell, joint.ground_cell].map(|face| model.mesh.place(face));
            (body, ground)
        };
        sides.push(model.joints.iter().map(above).collect::<Vec<_>>());
    }
    assert_eq!(sides[0].len(), 2);
    assert_eq!(sides[0], sides[1]);
}

/// With --bonded every side of an interface is the one node there.
#[test]
fn sides_of_a_bonded_interface_are_the_group_itself() {
    let mut json = case(json!({ "interface_left": glued("pipe_left"), "bed": glued("layer_2") }));
    json["supports"]["bed@ground"] = json!(["y"]);
    let mesh = box_on_a_bed().mesh();
    let model = Model::new(&support::case(&json), &mesh, true).unwrap();
    let on_bed = model.mesh.nodes_of(model.mesh.group("bed").unwrap());
    assert!(!on_bed.is_empty() && on_bed.iter().all(|&node| model.fixed[node][1]));
    json["supports"]["base@ground"] = json!(["y"]);
    assert!(Model::new(&support::case(&json), &mesh, true).is_err(), "the base lies on no interface");
}

/// At a T-junction the support of a point holds all three nodes.
#[test]
fn a_support_of_a_point_holds_all_its_nodes_where_interfaces_meet() {
    let mut drawing = box_on_a_bed();
    let there = (0..drawing.len()).find(|&node| drawing.at(node) == [2.5, 2.]).unwrap();
    drawing.cell("P", Shape::Point, &[there]);
    let mut json = case(json!({ "interface_left": glued("pipe_left"), "bed": glued("layer_2") }));
    json["supports"]["P"] = json!(["x"]);
    let model = support::model(&json, &drawing.mesh());
    let at_place = (0..model.mesh.points.len()).filter(|&node| model.mesh.points[node] == [2.5, 2.]);
    let held: Vec<bool> = at_place.map(|node| model.fixed[node][0]).collect();
    assert_eq!(held, [true; 3]);
}

/// At the T-junction on the left of the box three surfaces have a node each.
#[test]
fn a_point_where_interfaces_meet_has_a_node_for_each_surface() {
    let mut drawing = box_on_a_bed();
    let there = (0..drawing.len()).find(|&node| drawing.at(node) == [2.5, 2.]).unwrap();
    drawing.cell("P", Shape::Point, &[there]);
    let mut json = case(json!({ "interface_left": glued("pipe_left"), "bed": glued("layer_2") }));
    json["probes"] = json!(["P@layer_1", "P@layer_2", "P@pipe_left"]);
    let model = support::model(&json, &drawing.mesh());
    for (probe, surface) in model.probes.iter().zip(["layer_1", "layer_2", "pipe_left"]) {
        assert_eq!(model.mesh.points[probe.node], [2.5, 2.], "{surface}");
        assert!(model.mesh.nodes_of(model.mesh.group(surface).unwrap()).contains(&probe.node), "{surface}");
    }
    json["probes"] = json!(["P@layer_9"]);
    assert!(Model::new(&support::case(&json), &drawing.mesh(), false).is_err());
    // a surface that is called as a side comes first
    let called_as_a_side = drawing.renamed("layer_1", "body").mesh();
    json["probes"] = json!(["P@body"]);
    json["materials"] = json!({ "body": json["materials"]["layer_1"], "layer_2": json["materials"]["layer_2"],
                                "pipe_left": json["materials"]["pipe_left"] });
    let model = support::model(&json, &called_as_a_side);
    let of_surface = model.mesh.nodes_of(model.mesh.group("body").unwrap());
    assert!(of_surface.contains(&model.probes[0].node));
}

/// A bedding plane that runs into both free-field sides, pressed evenly: a plane wave, whose motion is upright
/// everywhere and, with joints 1e5 times as stiff as 1 m of the ground, that of the merged mesh. Gravity keeps the joints
/// closed before the wave comes.
#[test]
fn an_interface_runs_into_free_field_sides() {
    let mut json =
        case(json!({ "level": { "body": "layer_2", "normal_stiffness": 1e13, "tangential_stiffness": 1e13 } }));
    json["analysis"] = json!("dynamic");
    json["geometry"] = json!({ "mesh": "blocks.msh" });
    json["supports"] = json!({});
    json["materials"].as_object_mut().unwrap().remove("pipe_left");
    json["boundaries"] = json!({ "base": "viscous", "side_left": "free_field", "side_right": "free_field" });
    json["loads"] =
        json!({ "surface": { "pressure": { "law": "half_sine", "peak": "100 kPa", "duration": "40 ms" } } });
    json["gravity"] = json!(9.81);
    json["time"] = json!({ "step": "0.5 ms", "end": "30 ms" });
    json["probes"] = json!([{ "name": "side", "at": [0, 4] }, { "name": "middle", "at": [3, 4] }]);
    let bench = Bench::new("free_field_junction");
    bench.write("blocks.msh", four_blocks().text());
    bench.write("block.json", json.to_string());
    // u of side and middle at the end [m]
    let moved = |how: &str| -> [[f64; 2]; 2] {
        let outcome = bench.run_line(&format!("run block.json --quiet{how}"));
        assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
        let table = std::fs::read_to_string(bench.path("output/block/histories.csv")).unwrap();
        let [names, last] = [0, table.lines().count() - 1].map(|row| table.lines().nth(row).unwrap().split(','));
        let row: Vec<(&str, f64)> = names.zip(last.map(|number| number.parse().unwrap())).collect();
        let of = |name: &str| row.iter().find(|(column, _)| *column == name).unwrap().1;
        ["side", "middle"].map(|probe| ["ux", "uy"].map(|component| of(&format!("{probe}.{component}"))))
    };
    let [opened, merged] = ["", " --bonded"].map(moved);
    println!("{opened:?} {merged:?}");
    let along = merged[1][1].abs();
    for (opened, merged) in opened.iter().zip(&merged) {
        // the joint gives way by 1e-5 of 1 m of ground, and the columns beyond the sides have none
        assert!((opened[1] - merged[1]).abs() < 2e-5 * along && opened[0].abs() < 1e-5 * along);
    }
}
