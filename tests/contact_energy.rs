//! Energy that joints make without damping: bounded in a run that is done, and a run that makes more does not count as
//! done.

mod program;
mod support;

use coralpipe::model::mesh::Shape;
use program::{Bench, Outcome};
use serde_json::{Value, json};
use support::Drawing;

/// Pseudorandom numbers in [0, 1): the linear congruential generator of Knuth (MMIX).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low * (high / low).powf(self.next())
    }

    fn one_of<T: Copy>(&mut self, choices: &[T]) -> T {
        choices[(self.next() * choices.len() as f64) as usize]
    }
}

/// 9 m x 6 m of ground in squares of 0.75 m, in two layers, with a block of 1.5 m x 1.5 m.
fn ground_with_block() -> Drawing {
    const NX: usize = 12;
    const NY: usize = 8;
    let mut drawing = Drawing::default();
    let node = |i: usize, j: usize| j * (NX + 1) + i;
    (0..=NY).for_each(|j| (0..=NX).for_each(|i| _ = drawing.node([0.75 * i as f64, 0.75 * j as f64])));
    let in_block = |i: usize, j: usize| (5..7).contains(&i) && (4..6).contains(&j);
    for j in 0..NY {
        for i in 0..NX {
            let group = match (in_block(i, j), j < 5) {
                (true, _) => "block",
                (false, true) => "lower",
                (false, false) => "upper",
            };
            drawing.cell(group, Shape::Quad4, &[node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)]);
        }
        drawing.cell("left", Shape::Line2, &[node(0, j), node(0, j + 1)]);
        drawing.cell("right", Shape::Line2, &[node(NX, j), node(NX, j + 1)]);
    }
    for i in 0..NX {
        drawing.cell("base", Shape::Line2, &[node(i, 0), node(i + 1, 0)]);
        drawing.cell("top", Shape::Line2, &[node(i, NY), node(i + 1, NY)]);
    }
    for k in 0..2 {
        drawing.cell("ring", Shape::Line2, &[node(5 + k, 4), node(6 + k, 4)]);
        drawing.cell("ring", Shape::Line2, &[node(5 + k, 6), node(6 + k, 6)]);
        drawing.cell("ring", Shape::Line2, &[node(5, 4 + k), node(5, 5 + k)]);
        drawing.cell("ring", Shape::Line2, &[node(7, 4 + k), node(7, 5 + k)]);
    }
    drawing
}

/// A blast on undamped layers, with all that makes joints chatter: stiff and thin joints, long steps, gravity, borders
/// that let waves out.
fn undamped(random: &mut Random) -> Value {
    let mut layer = |low: f64, high: f64| {
        json!({ "young": random.between(low, high), "poisson": 0.1 + 0.3 * random.next(), "density": 2000,
                "friction": random.one_of(&[0., 0.2, 0.4, 0.8]) })
    };
    let materials = json!({ "lower": layer(1e8, 1e9), "upper": layer(5e7, 5e8), "block": layer(1e9, 2e11) });
    let absorbs = random.next() < 0.5;
    let [supports, boundaries] = match absorbs {
        true => [json!({}), json!({ "base": "viscous", "left": "free_field", "right": "free_field" })],
        false => [json!({ "base": ["x", "y"], "left": ["x"], "right": ["x"] }), json!({})],
    };
    let step = random.between(1e-4, 2e-3);
    json!({
        "geometry": { "mesh": "ground.msh" },
        "materials": materials,
        "interfaces": { "ring": { "body": "block", "thickness": random.between(1e-3, 5e-2) } },
        "supports": supports,
        "boundaries": boundaries,
        "gravity": if random.next() < 0.5 { 9.81 } else { 0. },
        "loads": { "top": { "pressure": { "law": "linear", "peak": random.between(2e4, 5e5), "duration": "20 ms" } } },
        "time": { "step": step, "end": 300. * step },
        "output": { "every": 300. * step },
    })
}

fn number(summary: &Value, pointer: &str) -> f64 {
    summary.pointer(pointer).and_then(Value::as_f64).unwrap_or_else(|| panic!("no {pointer}"))
}

/// Energies of `block.json` in this bench [J/m].
fn energy(bench: &Bench) -> Value {
    let summary: Value =
        serde_json::from_slice(&std::fs::read(bench.path("output/block/summary.json")).unwrap()).unwrap();
    summary["energy"].clone()
}

/// Of 30 random cases each is done with at most 2 % of the energy supplied, or ends with exit code 3.
#[test]
fn thirty_undamped_runs_make_next_to_no_energy_or_are_not_done() {
    let bench = Bench::new("thirty");
    bench.write("ground.msh", ground_with_block().text());
    let mut random = Random(2026);
    let (mut done, mut cut) = (0, 0);
    for case in 0..30 {
        bench.write("block.json", undamped(&mut random).to_string());
        let Outcome { code, stderr, .. } = bench.run_line("run block.json --quiet");
        let energy = energy(&bench);
        let made = number(&energy, "/made") / number(&energy, "/supplied");
        println!("case {case}: exit {code:?}, made {:.3} %", 100. * made);
        match code {
            Some(0) => {
                assert!(made <= 0.02, "case {case}: {made}");
                done += 1;
                cut += usize::from(number(&energy, "/made") > 0.01 * number(&energy, "/supplied"));
            }
            Some(3) => assert!(stderr.contains("of the energy supplied") && stderr.contains("time.hht"), "{stderr}"),
            _ => panic!("case {case}: {code:?}: {stderr}"),
        }
    }
    println!("{done} of 30 are done, {cut} of them with more than 1 %");
    assert!(done >= 25, "only {done} of 30 are done, where all were");
    assert!(cut > 0, "no case came near the limit, so that none shows that steps are cut");
}

/// A block that hammers for a second after a blast of 20 ms, on joints of 1 mm whose period, 0.8 ms, the step of 1 ms does
/// not resolve.
fn hammering() -> Value {
    let ground = |young: f64| json!({ "young": young, "poisson": 0.3, "density": 2000, "friction": 0.4 });
    json!({
        "geometry": { "mesh": "ground.msh" },
        "materials": { "lower": ground(2e8), "upper": ground(1e8),
                       "block": { "young": 1e9, "poisson": 0.2, "density": 2400 } },
        "interfaces": { "ring": { "body": "block", "thickness": "1 mm" } },
        "boundaries": { "base": "viscous", "left": "free_field", "right": "free_field" },
        "gravity": 9.81,
        "loads": { "top": { "pressure": { "law": "linear", "peak": "500 kPa", "duration": "20 ms" } } },
        "time": { "step": "1 ms", "end": 1 },
        "output": { "every": 1 },
    })
}

/// Shares of the energy supplied: 24 % as good as without a limit, 0.01 % with redistributed mass, 0.6 % with HHT.
#[test]
fn redistributed_mass_and_hht_end_the_chatter_of_undamped_joints() {
    let bench = Bench::new("remedies");
    bench.write("ground.msh", ground_with_block().text());
    bench.write("block.json", hammering().to_string());
    let made = |set: &str| {
        let Outcome { code, stderr, .. } = bench.run(&["run", "block.json", "--quiet", "--set", set]);
        assert_eq!(code, Some(0), "{set}: {stderr}");
        let energy = energy(&bench);
        number(&energy, "/made") / number(&energy, "/supplied")
    };
    let [plain, mass, hht] = ["time.energy_tolerance=0.999", "mass=redistributed", "time.hht=-0.1"].map(made);
    println!("made: {plain:.2e} plain, {mass:.2e} redistributed, {hht:.2e} hht");
    assert!(plain > 0.1 && mass < 1e-3 && hht < 0.02, "{plain} {mass} {hht}");
}

/// The weight's work on motions about the equilibrium is no supply. The loads' work is that of the first 20 ms, before which
/// the weight changes only which joints open: a tenth.
#[test]
fn weight_supplies_no_energy_to_a_motion_about_its_equilibrium() {
    let bench = Bench::new("weight");
    bench.write("ground.msh", ground_with_block().text());
    bench.write("block.json", hammering().to_string());
    let [with, without] = ["gravity=9.81", "gravity=0"].map(|set| {
        let run = ["run", "block.json", "--quiet", "--set", set, "--set", "time.hht=-0.1", "--set", "time.end=0.1"];
        let Outcome { code, stderr, .. } = bench.run(&run);
        assert_eq!(code, Some(0), "{set}: {stderr}");
        number(&energy(&bench), "/supplied")
    });
    println!("{with} J/m with weight, {without} J/m without");
    assert!((with / without - 1.).abs() < 0.1, "{with} and {without}");
}

/// Where even the shortest steps make more than is tolerated, the run ends with exit code 3; what it computed is on disk.
#[test]
fn a_run_whose_joints_make_too_much_energy_is_not_done() {
    let bench = Bench::new("too_much");
    bench.write("ground.msh", ground_with_block().text());
    let mut case = hammering();
    case["time"]["energy_tolerance"] = json!(1e-6);
    bench.write("block.json", case.to_string());
    let Outcome { code, stderr, .. } = bench.run_line("run block.json --quiet");
    assert_eq!(code, Some(3), "{stderr}");
    for words in ["joints that open and close within steps have made", "time.energy_tolerance = 0.000001", "hht = -0.1"]
    {
        assert!(stderr.contains(words), "{words}: {stderr}");
    }
    let summary: Value =
        serde_json::from_slice(&std::fs::read(bench.path("output/block/summary.json")).unwrap()).unwrap();
    assert_eq!(summary["status"], "no_convergence");
}

/// A body that vibrates on its joints faster than the step resolves: m = 7800 kg, sum of kappa_s l = 4 m x 38.46 MPa / t.
/// 2 pi sqrt(m / k) = 0.447 ms for t = 0.1 mm, 4.47 ms for 1 cm; the step is 0.5 ms.
#[test]
fn an_undamped_body_on_joints_that_the_step_does_not_resolve_is_warned_of() {
    let bench = Bench::new("unresolved");
    let warns = |sets: &[&str]| {
        let sets = sets.iter().flat_map(|set| ["--set", set]);
        let outcome = bench.run(&["check", "block.json"].into_iter().chain(sets).collect::<Vec<_>>());
        assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
        outcome.stdout.lines().any(|line| line.contains("body body vibrates on its joints with a period of 0.447 ms"))
    };
    let thin = "interfaces.interface.thickness=0.1 mm";
    assert!(warns(&[thin, "damping=null"]));
    for otherwise in [&[thin][..], &[thin, "damping=null", "time.hht=-0.1"], &["damping=null"]] {
        assert!(!warns(otherwise), "{otherwise:?}");
    }
    assert!(!warns(&[thin, "damping=null", "time.step=0.1 ms"]));
}
