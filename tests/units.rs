//! Slips of units: values out of reason are warned of, a mesh may be drawn in another unit than metres.

mod program;

use program::{Bench, CASE, Outcome, block_msh};
use serde_json::{Value, json};
use std::fs;

/// What `check` warns of, without what it always says of this case.
fn warnings(bench: &Bench, arguments: &str) -> Vec<String> {
    let Outcome { code, stdout, stderr } = bench.run_line(&format!("check {arguments}"));
    assert_eq!(code, Some(0), "{arguments}: {stderr}");
    stdout.lines().filter_map(|line| line.strip_prefix("warning: ")).map(String::from).collect()
}

/// Each value with a unit forgotten or mistaken, and what the warning must name: key, value, range or unit.
#[test]
fn a_value_out_of_reason_is_warned_of_with_its_key_and_the_unit_that_was_probably_meant() {
    let bench = Bench::new("slips");
    let usual = warnings(&bench, "block.json");
    assert!(!usual.iter().any(|w| w.contains("a number without a unit")), "{usual:?}");
    for (set, words) in [
        ("materials.ground.density=2", ["materials.ground.density is 2 kg/m3", "\"t/m^3\""]),
        ("materials.ground.density=2.2e-3", ["materials.ground.density is 0.0022 kg/m3", "\"g/cm^3\""]),
        ("materials.body.density=7.8e6", ["materials.body.density is 7800000 kg/m3", "500 (pumice) to 20000"]),
        // c_p = sqrt(E (1 - nu) / (rho (1 + nu) (1 - 2 nu))) = sqrt(200 * 0.7 / (2000 * 1.3 * 0.4)) = 0.3669 m/s
        ("materials.ground.young=200", ["materials.ground: P waves would run at 0.3669 m/s", "young = 200 Pa"]),
        ("materials.ground.density=2", ["materials.ground.density", "P waves would run at 8204 m/s"]),
        ("materials.body.young=1e15", ["materials.body: P waves would run", "50 (peat) to 7000"]),
        ("gravity=981", ["gravity is 981 m/s2, 100 times", "\"1 g\""]),
        ("gravity=1", ["gravity is 1 m/s2, 0.102 times", "9.81"]),
        ("loads.top.pressure.peak=1e11", ["the load on top reaches 100 GPa", "in Pa"]),
        ("loads.top.pressure.duration=20", ["the load on top lasts 20 s", "\"ms\""]),
        ("interfaces.interface.thickness=10", ["interfaces.interface.thickness is 10 m", "longest element 1 m"]),
        ("time.end=100", ["time.end is 100 s", "\"ms\""]),
    ] {
        let told = warnings(&bench, &format!("block.json --set {set}"));
        assert!(told.iter().any(|w| words.iter().all(|word| w.contains(word))), "{set} {words:?}: {told:?}");
    }
}

/// A run says the same as `check`, and its summary keeps it.
#[test]
fn a_run_and_its_summary_carry_the_warning_of_a_slip() {
    let bench = Bench::new("slips-run");
    let run = bench.run_line("run block.json --quiet --set gravity=981");
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    assert!(run.stderr.contains("warning: gravity is 981 m/s2"), "{}", run.stderr);
    let summary: Value = serde_json::from_slice(&fs::read(bench.path("output/block/summary.json")).unwrap()).unwrap();
    assert!(summary["warnings"].as_array().unwrap().iter().any(|w| w.as_str().unwrap().starts_with("gravity is 981")));
}

/// Density counts in statics only under gravity, and no wave runs; a modulus in MPa still is a slip.
#[test]
fn statics_is_warned_of_moduli_but_not_of_waves_and_weightless_densities() {
    let bench = Bench::new("slips-static");
    let of = |sets: &str| warnings(&bench, &format!("block.json --set analysis=static --set damping=null {sets}"));
    let light = "--set materials.ground.density=2";
    assert!(!of(light).iter().any(|w| w.contains("density")));
    assert!(
        of(&format!("{light} --set gravity=9.81")).iter().any(|w| w.contains("materials.ground.density is 2 kg/m3"))
    );
    let soft = of("--set materials.ground.young=100");
    assert!(soft.iter().any(|w| w.contains("materials.ground.young is 100 Pa") && w.contains("\"MPa\"")), "{soft:?}");
    assert!(!soft.iter().any(|w| w.contains("P waves")), "{soft:?}");
}

#[test]
fn the_papers_case_is_not_out_of_reason() {
    let bench = Bench::new("slips-none");
    let root = env!("CARGO_MANIFEST_DIR");
    let told = warnings(&bench, &format!("{root}/geo/twin_pipes.json --mesh {root}/meshes/twin_pipes.msh"));
    assert!(
        !told.iter().any(|w| w.contains("without a unit") || w.contains("right units") || w.contains("unit")),
        "{told:?}"
    );
}

/// The block's mesh with its coordinates times a factor.
fn drawn(factor: f64) -> String {
    let text = block_msh();
    let (head, rest) = text.split_once("$Nodes\n").unwrap();
    let (nodes, tail) = rest.split_once("$EndNodes\n").unwrap();
    let mut lines = nodes.lines();
    let mut scaled = format!("{}\n", lines.next().unwrap());
    for line in lines {
        let mut words = line.split(' ');
        let tag = words.next().unwrap();
        let at: Vec<String> = words.map(|x| format!("{:?}", factor * x.parse::<f64>().unwrap())).collect();
        scaled += &format!("{tag} {}\n", at.join(" "));
    }
    format!("{head}$Nodes\n{scaled}$EndNodes\n{tail}")
}

/// Heads and columns of `histories.csv`.
fn histories(bench: &Bench, folder: &str) -> (String, Vec<Vec<f64>>) {
    let text = fs::read_to_string(bench.path(folder).join("histories.csv")).unwrap();
    let (head, rows) = text.split_once('\n').unwrap();
    let rows: Vec<Vec<f64>> = rows.lines().map(|line| line.split(',').map(|x| x.parse().unwrap()).collect()).collect();
    let columns = (0..rows[0].len()).map(|i| rows.iter().map(|row| row[i]).collect()).collect();
    (head.into(), columns)
}

/// Unit and how many of it make the metre; a yard of 3 feet and a mile would be others.
const UNITS: [(&str, f64); 5] = [("mm", 1e3), ("cm", 1e2), ("km", 1e-3), ("in", 1. / 0.0254), ("ft", 1. / 0.3048)];

#[test]
fn a_mesh_drawn_in_another_unit_gives_the_histories_of_the_same_mesh_in_metres() {
    let bench = Bench::new("units");
    let case =
        CASE.replace("\"probes\": [\"P\", \"Q\"]", "\"probes\": [\"P\", { \"name\": \"R\", \"at\": [2, \"400 cm\"] }]");
    bench.write("metres.json", &case);
    assert_eq!(bench.run_line("run metres.json --quiet --out m").code, Some(0));
    let (head, metres) = histories(&bench, "m");
    for (unit, count) in UNITS {
        bench.write("drawn.msh", drawn(count));
        bench.write("drawn.json", case.replace("\"block.msh\"", &format!("\"drawn.msh\", \"unit\": \"{unit}\"")));
        let run = bench.run_line(&format!("run drawn.json --quiet --out {unit}"));
        assert_eq!(run.code, Some(0), "{unit}: {}", run.stderr);
        assert!(!run.stderr.contains("geometry.unit"), "{unit}: {}", run.stderr);
        let (drawn_head, columns) = histories(&bench, unit);
        assert_eq!(drawn_head, head);
        for (name, (a, b)) in head.split(',').zip(columns.iter().zip(&metres)) {
            let peak = b.iter().fold(0f64, |m, x| m.max(x.abs()));
            let error = a.iter().zip(b).fold(0f64, |m, (a, b)| m.max((a - b).abs()));
            // round-off of 1e-16 in coordinates, times the condition of the matrix, some 1e4
            assert!(error <= 1e-11 * peak, "{unit} {name}: {error:e} of {peak:e}");
        }
        let summary: Value = serde_json::from_slice(&fs::read(bench.path(unit).join("summary.json")).unwrap()).unwrap();
        assert_eq!(summary["inputs"]["mesh_unit"], unit);
        assert_eq!(summary["inputs"]["effective_case"]["geometry"]["unit"], unit);
        assert!((summary["probes"][1]["y"].as_f64().unwrap() - 4.).abs() < 1e-12);
    }
}

/// Lengths, areas and places in what `check` says are in metres, also of a mesh that the command line gives.
#[test]
fn a_unit_holds_for_the_mesh_of_the_command_line_and_all_that_is_printed_is_in_metres() {
    let bench = Bench::new("units-check");
    bench.write("mm.msh", drawn(1e3));
    let without_names = |text: &str| text.replace("mm.msh", "block.msh");
    let metres = bench.run_line("check block.json").stdout;
    for line in [
        "check block.json --mesh mm.msh --set geometry.unit=mm",
        "check block.json --mesh mm.msh --set geometry={\"unit\":\"mm\"}",
    ] {
        assert_eq!(without_names(&bench.run_line(line).stdout), metres, "{line}");
    }
    // a load inside the solid is refused at its place in metres
    let inner = "--set loads={\"interface\":{\"pressure\":{\"law\":\"step\",\"peak\":1}}} --set interfaces={\"interface\":\"bonded\"}";
    let sentence = |more: &str| without_names(&bench.run_line(&format!("check block.json {inner} {more}")).stderr);
    let there = sentence("");
    assert!(there.contains(") m"), "{there}");
    assert_eq!(sentence("--mesh mm.msh --set geometry.unit=mm"), there);
}

/// 5 m drawn in mm are 5000 m from side to side, in inches twice that of 200 m, which nobody can tell from a valley.
#[test]
fn a_mesh_of_implausible_size_is_warned_of_with_the_key_that_gives_its_unit() {
    let bench = Bench::new("units-hint");
    for (count, size) in [(1e3, "7070 m"), (1e-3, "0.00707 m")] {
        bench.write("drawn.msh", drawn(count));
        for line in ["block.json --mesh drawn.msh", "drawn.msh"] {
            let told = warnings(&bench, line);
            let hint = told.iter().find(|w| w.contains("geometry.unit")).unwrap_or_else(|| panic!("{line}: {told:?}"));
            assert!(hint.contains(&format!("drawn.msh is {size} from corner to corner")), "{hint}");
        }
    }
    assert!(!warnings(&bench, "block.msh").iter().any(|w| w.contains("geometry.unit")));
    let unknown = bench.run_line("check block.json --set geometry.unit=yd");
    assert_eq!(unknown.code, Some(1));
    for words in ["geometry.unit: there is no \"yd\"", "mm, cm, m, km, in, ft"] {
        assert!(unknown.stderr.contains(words), "{}", unknown.stderr);
    }
}

/// Runs of a sweep on one mesh in two units are two geometries.
#[test]
fn a_sweep_tells_units_apart() {
    let bench = Bench::new("units-sweep");
    bench.write("plan.json", json!({ "case": "block.json", "set": { "geometry.unit": ["m", "ft"] } }).to_string());
    let outcome = bench.run_line("sweep plan.json");
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let [(_, metres), (_, feet)] = ["unitm", "unitft"].map(|name| histories(&bench, &format!("output/plan/{name}")));
    assert!(metres[1..] != feet[1..] && metres[0] == feet[0]);
}

/// Natural frequencies do not depend on loads, so `modes` says nothing about them; `check` does.
#[test]
fn modes_say_nothing_about_loads_and_initial_motion() {
    let bench = Bench::new("modes");
    for (sets, words) in [
        ("--set loads={}", "nothing loads or moves"),
        ("--set loads.top.pressure.start=1", "never acts"),
        ("--set loads.top.pressure.scale=0", "never acts"),
        ("--set loads.top.pressure.duration=0.7ms", "not resolved by the time steps"),
        ("--set initial={\"base\":{\"velocity\":[1,0]}}", "initial.base"),
    ] {
        let modes = bench.run_line(&format!("modes block.json -n 1 --out m {sets}"));
        assert!(modes.code == Some(0) && !modes.stderr.contains(words), "{sets}: {}", modes.stderr);
        let told = warnings(&bench, &format!("block.json {sets}"));
        assert!(told.iter().any(|w| w.contains(words)), "{sets}: {told:?}");
    }
}
