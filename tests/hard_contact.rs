//! Contact that is hard to settle: it converges, or the run ends with exit code 3 and names place and cause.

mod program;

use program::{Bench, Outcome};
use serde_json::Value;

/// Two blows from the side and the top of the block in turn, undamped: joints open, close and slip both ways.
const BLOWS: &str = "loads={\"top\":{\"traction\":{\"law\":\"table\",\"direction\":[1,-2],\"times\":[0,0.002,0.004,0.006,0.01],\
                     \"values\":[0,1e6,-1e6,1e6,0]}}}";

fn run(bench: &Bench, sets: &[&str]) -> Outcome {
    let sets = sets.iter().flat_map(|set| ["--set", set]);
    bench.run(&["run", "block.json"].into_iter().chain(sets).collect::<Vec<_>>())
}

fn summary(bench: &Bench) -> Value {
    serde_json::from_slice(&std::fs::read(bench.path("output/block/summary.json")).unwrap()).unwrap()
}

fn number(summary: &Value, pointer: &str) -> f64 {
    summary.pointer(pointer).and_then(Value::as_f64).unwrap_or_else(|| panic!("no {pointer}"))
}

/// Done with a ledger that closes to round-off over some hundred steps, or stopped with joints and what helps.
fn settles_or_says_where(bench: &Bench, sets: &[&str]) -> Option<Value> {
    let Outcome { code, stderr, .. } = run(bench, sets);
    match code {
        Some(0) => {
            let summary = summary(bench);
            assert!(number(&summary, "/contact/status_changes") > 0., "{sets:?}: nothing to settle");
            assert!(number(&summary, "/energy/max_relative_error") < 1e-9, "{sets:?}");
            Some(summary)
        }
        Some(3) => {
            if stderr.contains("of the energy supplied") {
                assert!(stderr.contains("; take time.hht"), "{sets:?}: {stderr}");
                return None;
            }
            for words in ["no convergence in step", "interface at (", "try "] {
                assert!(stderr.contains(words), "{sets:?}: {words}: {stderr}");
            }
            None
        }
        _ => panic!("{sets:?}: {stderr}"),
    }
}

/// Thin joints (1 mm), damped and not, with little and with much friction, at a step that does not resolve them.
#[test]
fn thin_joints_friction_and_chatter_converge_or_name_the_joints() {
    let bench = Bench::new("hard");
    let mut done = 0;
    for thickness in ["1 cm", "1 mm"] {
        for damping in ["null", "{\"ratio\":0.05}"] {
            for friction in ["0", "0.3", "1.5"] {
                let sets = [
                    format!("interfaces.interface.thickness={thickness}"),
                    format!("interfaces.interface.friction={friction}"),
                    format!("damping={damping}"),
                    "time.end=40 ms".into(),
                    BLOWS.into(),
                ];
                let sets: Vec<&str> = sets.iter().map(String::as_str).collect();
                done += usize::from(settles_or_says_where(&bench, &sets).is_some());
            }
        }
    }
    println!("{done} of 12 converge");
    assert!(done >= 11, "{done}");
}

/// `time.energy_tolerance` bounds what chattering joints make, by steps cut where they make it.
#[test]
fn an_energy_tolerance_keeps_undamped_chatter_from_making_energy() {
    let bench = Bench::new("chatter");
    let undamped = ["damping=null", "interfaces.interface.thickness=1 mm", "time.end=40 ms", BLOWS];
    let made = |summary: &Value| -number(summary, "/energy/last/contact") / number(summary, "/energy/last/work");
    let plain = settles_or_says_where(&bench, &undamped).expect("it converges");
    let kept = [&undamped[..], &["time.energy_tolerance=0.001"]].concat();
    let kept = settles_or_says_where(&bench, &kept).expect("it converges");
    println!(
        "made: {:.2e} of the work without, {:.2e} with; {} cut",
        made(&plain),
        made(&kept),
        kept["contact"]["cut_steps"]
    );
    assert!(number(&kept, "/contact/cut_steps") > 0.);
    assert!(made(&kept) < made(&plain) / 4., "{} and {}", made(&plain), made(&kept));
    let bad = run(&bench, &["time.energy_tolerance=1"]);
    assert!(bad.code == Some(1) && bad.stderr.contains("less than 1"), "{}", bad.stderr);
    let still = run(&bench, &["time.energy_tolerance=0.1", "analysis=static"]);
    assert!(still.code == Some(1) && still.stderr.contains("static"), "{}", still.stderr);
}

/// The body flies at 10 m/s against the ground around it: closed at once, no damping of any kind.
#[test]
fn an_impact_without_damping_converges() {
    let bench = Bench::new("impact");
    for gap in ["0", "1 mm"] {
        let gap = format!("interfaces.interface.gap={gap}");
        let sets = ["damping=null", "initial={\"body\":{\"velocity\":[0,-10]}}", "loads={}", "time.step=0.05 ms", &gap];
        settles_or_says_where(&bench, &sets);
    }
}

/// A body of 1 m x 1 m on a foundation of the same size, which is held at its base.
const TOWER: &str = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n4\n2 1 \"ground\"\n2 2 \"body\"\n1 3 \"foot\"\n1 4 \"base\"\n\
    $EndPhysicalNames\n$Nodes\n6\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 1 1 0\n5 0 2 0\n6 1 2 0\n$EndNodes\n$Elements\n4\n\
    1 1 2 3 1 3 4\n2 1 2 4 1 1 2\n3 3 2 1 1 1 2 4 3\n4 3 2 2 1 3 4 6 5\n$EndElements\n";

const TOWER_CASE: &str = r#"{
  "analysis": "static", "gravity": 10, "geometry": { "mesh": "tower.msh" },
  "materials": { "ground": { "young": "100 MPa", "poisson": 0, "density": 2000 },
                 "body": { "young": "100 MPa", "poisson": 0, "density": 2000 } },
  "interfaces": { "foot": { "body": "body", "thickness": "1 cm", "friction": 0.5 } },
  "supports": { "base": ["x", "y"] },
  "time": { "step": 1, "end": 1 }
}"#;

/// The body weighs 20 kN, so f N = 10 kN: it stands a pull of 9 kN, slides under 11 kN and comes off when lifted by 30
/// kN, at once or while the load grows; no advice that only fits motion.
#[test]
fn statics_names_the_body_that_slides_or_comes_off() {
    let bench = Bench::new("statics");
    bench.write("tower.msh", TOWER);
    bench.write("tower.json", TOWER_CASE);
    let pulled = |force: &str, direction: &str, law: &str| {
        let history = law.replace("PEAK", force);
        let load = format!("loads={{\"body\":{{\"body_force\":{{{history},\"direction\":{direction}}}}}}}");
        bench.run(&["run", "tower.json", "--set", &load])
    };
    for law in ["\"law\":\"step\",\"peak\":PEAK", "\"law\":\"table\",\"times\":[0,1],\"values\":[0,PEAK]"] {
        let holds = pulled("9000", "[1,0]", law);
        assert_eq!(holds.code, Some(0), "{}", holds.stderr);
        for (force, direction, words) in
            [("11000", "[1,0]", "body body, which slides"), ("30000", "[0,1]", "has come off")]
        {
            let Outcome { code, stderr, .. } = pulled(force, direction, law);
            assert_eq!(code, Some(3), "{stderr}");
            for words in ["no equilibrium was found", words, "foot at (0.0000, 1.0000) m", "more friction, a support"] {
                assert!(stderr.contains(words), "{words}: {stderr}");
            }
            assert!(!stderr.contains("damping"), "{stderr}");
        }
    }
}
