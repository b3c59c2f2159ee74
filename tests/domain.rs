//! `domain` and `converge` from the command line to their files, on a block of one material made by gmsh; and the causal
//! bound on the default case.

mod program;
mod support;

use coralpipe::model::arrival::{Return, Returns, returns};
use coralpipe::model::mesh::Shape;
use coralpipe::study::run::{Request, load};
use program::{Bench, Outcome, code_of};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, Instant};

/// Squares of 0.5 m; P is the middle of the surface. c_p = sqrt(134.615 MPa / 2000 kg/m3) = 259.44 m/s: the base at 6 m
/// returns after 12 / 259.44 = 46.25 ms.
const SCRIPT: &str = r#"
DefineConstant[
  width = {4, Min 1, Max 100, Name "Width"}, height = {6, Min 1, Max 100, Name "Height"},
  refine = {1, Min 0.1, Max 16, Name "Refine"}, two = 1 + 1
];
across = Ceil(width * refine - 1e-6); down = Ceil(2 * height * refine - 1e-6);
Point(1) = {-width / 2, -height, 0}; Point(2) = {0, -height, 0}; Point(3) = {width / 2, -height, 0};
Point(4) = {width / 2, 0, 0}; Point(5) = {0, 0, 0}; Point(6) = {-width / 2, 0, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 5}; Line(5) = {5, 6}; Line(6) = {6, 1}; Line(7) = {2, 5};
Curve Loop(1) = {1, 7, 5, 6}; Plane Surface(1) = {1}; Curve Loop(2) = {2, 3, 4, -7}; Plane Surface(2) = {2};
Transfinite Curve{1, 2, 4, 5} = across + 1; Transfinite Curve{3, 6, 7} = down + 1;
Transfinite Surface{1, 2}; Recombine Surface{1, 2};
Physical Surface("ground") = {1, 2}; Physical Curve("base") = {1, 2}; Physical Curve("top") = {4, 5};
Physical Curve("left") = {6}; Physical Curve("right") = {3}; Physical Point("P") = {5};
"#;

const CASE: &str = r#"{
  "geometry": { "script": "box.geo" },
  "materials": { "ground": { "young": "100 MPa", "poisson": 0.3, "density": 2000 } },
  "supports": { "base": ["x", "y"], "left": ["x"], "right": ["x"] },
  "loads": { "top": { "pressure": { "law": "linear", "peak": "100 kPa", "duration": "20 ms" } } },
  "time": { "step": "0.5 ms", "end": "30 ms" },
  "probes": ["P"]
}
"#;

/// gmsh of this checkout or of PATH; none is a failure where CI is set.
fn gmsh() -> Option<PathBuf> {
    let here = Path::new(env!("CARGO_MANIFEST_DIR")).join(".venv/bin/gmsh");
    let path = std::env::var_os("PATH").unwrap_or_default();
    let found = std::iter::once(here).chain(std::env::split_paths(&path).map(|p| p.join("gmsh"))).find(|p| p.is_file());
    if found.is_none() {
        assert!(std::env::var_os("CI").is_none(), "no gmsh was found");
        eprintln!("\n*** SKIPPED: no gmsh was found ***\n");
    }
    found
}

fn box_bench(test: &str) -> Bench {
    let bench = Bench::new(test);
    bench.write("box.geo", SCRIPT);
    bench.write("box.json", CASE);
    bench
}

/// `line` in words between blanks, `_` for a blank inside a word.
fn run(bench: &Bench, gmsh: &Path, line: &str) -> Outcome {
    let words: Vec<String> = line.split_whitespace().map(|w| w.replace('_', " ")).collect();
    let output = bench.program(&words).env("CORALPIPE_GMSH", gmsh).output().unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    Outcome { code: output.status.code(), stdout: text(output.stdout), stderr: text(output.stderr) }
}

/// Killed while it writes a table, the study leaves a part of it; its next call clears that and goes on. Removed meanwhile,
/// its folder is not made again.
#[test]
fn a_study_clears_what_a_kill_left_and_ends_where_its_folder_is_removed() {
    let Some(gmsh) = gmsh() else { return };
    let bench = box_bench("domain-accidents");
    std::fs::create_dir_all(bench.path("output/box/domain/width4_height6")).unwrap();
    let left = ["domain/.domain.csv.99999999.part", "domain/width4_height6/rings.csv"];
    left.iter().for_each(|name| bench.write(format!("output/box/{name}"), ""));
    let first = run(&bench, &gmsh, "domain box.json --set time.end=1ms");
    assert_eq!(first.code, Some(0), "{}", first.stderr);
    assert!(!bench.path("output/box").join(left[0]).exists());
    let beside = run(&bench, &gmsh, "run box.json --set time.end=1ms");
    assert_eq!(beside.code, Some(0), "a run beside its study: {}", beside.stderr);

    let mut program = bench.program(&["domain", "box.json", "--set", "time.step=2 us", "--out", "lost"]);
    let stderr = bench.path("told");
    let child = program.env("CORALPIPE_GMSH", &gmsh).stderr(std::fs::File::create(&stderr).unwrap()).spawn().unwrap();
    let started = Instant::now();
    while !bench.path("lost/domain/width4_height6/run.sta").exists() && started.elapsed() < Duration::from_secs(30) {
        std::thread::sleep(Duration::from_millis(2));
    }
    std::fs::rename(bench.path("lost/domain"), bench.path("away")).unwrap();
    let code = code_of(child);
    let told = std::fs::read_to_string(stderr).unwrap();
    assert!(code == Some(1) && told.contains("removed") && told.contains("lost/domain"), "{told}");
    assert!(!bench.path("lost/domain").exists(), "it was made again: {told}");
}

fn json(bench: &Bench, name: &str) -> serde_json::Value {
    serde_json::from_slice(&std::fs::read(bench.path(name)).unwrap()).unwrap()
}

#[test]
fn a_box_whose_boundaries_are_not_felt_is_large_enough_and_is_not_computed_twice() {
    let Some(gmsh) = gmsh() else { return };
    let bench = box_bench("domain");
    let first = run(&bench, &gmsh, "domain box.json");
    assert_eq!(first.code, Some(0), "{}", first.stderr);
    assert!(first.stdout.contains("large enough: width = 4, height = 6:"), "{}", first.stdout);
    assert!(first.stdout.contains("46.25") && first.stdout.contains("never"), "{}", first.stdout);
    assert!(first.stdout.contains("nothing scatters it"), "{}", first.stdout);
    assert!(first.stdout.contains("no constants core_width and core_height"), "{}", first.stdout);
    // a value for each size: the block of lines begins with the quantity
    let values = first.stdout.split("P.u [m]\n").nth(1).unwrap().lines().take(4);
    assert!(values.zip(["4 x 6 ", "6 x 6 ", "4 x 9 ", "6 x 9 "]).all(|(l, size)| l.trim_start().starts_with(size)));
    let study = json(&bench, "output/box/domain/domain.json");
    let sizes = study["sizes"].as_array().unwrap();
    let expected = [[4., 6.], [6., 6.], [4., 9.], [6., 9.]];
    for (row, size) in sizes.iter().zip(expected) {
        assert_eq!(row["size"], serde_json::json!(size));
        // a uniform load makes every column the same, and a wave that P cannot feel yet is spread by coarse elements alone
        let change = row["quantities"]["P.u"]["change"].as_f64().unwrap_or(0.);
        assert!(change < 0.0174, "{row:#}");
    }
    assert_eq!(sizes.len(), 4);
    let table = std::fs::read_to_string(bench.path("output/box/domain/domain.csv")).unwrap();
    assert_eq!(table.lines().count(), 5, "{table}");
    assert!(std::fs::read_to_string(bench.path("output/box/domain/domain.svg")).unwrap().contains("</svg>"));
    assert!(bench.path("output/box/domain/width4_height9/histories.csv").is_file());

    // nothing is meshed or computed again: no gmsh is to be found now
    let again = bench.run_line("domain box.json");
    assert_eq!((again.code, again.stderr.matches("taken as it is").count()), (Some(0), 4), "{}", again.stderr);
    assert_eq!(again.stdout, first.stdout);
}

#[test]
fn a_held_base_does_not_converge_once_it_has_returned_and_that_is_said() {
    let Some(gmsh) = gmsh() else { return };
    let bench = box_bench("held");
    let Outcome { code, stdout, stderr } =
        run(&bench, &gmsh, "domain box.json --set time.end=120_ms --sizes 1 --compare P.uy");
    assert_eq!(code, Some(3), "{stderr}");
    // T = 2 * 6 / 259.44 = 46.25 ms; the height that delays it to 120 ms: 6 + (0.120 - 0.04625) * 259.44 / 2 = 15.57 m
    for words in ["the base is held", "after 46.25 ms", "below height = 15.6", "P.uy"] {
        assert!(stdout.contains(words), "no {words:?} in: {stdout}");
    }
    assert!(stderr.lines().last().unwrap().contains("still change by more than 1.74 %"), "{stderr}");
    assert!(bench.path("output/box/domain/domain.csv").is_file());
}

#[test]
fn peaks_come_with_their_error_and_an_acceleration_under_a_jump_does_not_converge() {
    let Some(gmsh) = gmsh() else { return };
    let bench = box_bench("converge");
    let Outcome { code, stdout, stderr } = run(&bench, &gmsh, "converge box.json --compare P.uy,P.ay --ratio 2");
    assert_eq!(code, Some(0), "{stderr}");
    let line = |name: &str| stdout.lines().find(|l| l.trim_start().starts_with(name)).unwrap().to_string();
    assert!(line("P.uy").contains("+-") && line("P.uy").contains("extrapolated"), "{stdout}");
    assert!(line("P.ay").contains("does not converge (the load begins with a jump"), "{stdout}");
    let found = &json(&bench, "output/box/converge/converge.json")["quantities"];
    assert_eq!((found["P.uy"]["converges"].as_bool(), found["P.ay"]["converges"].as_bool()), (Some(true), Some(false)));
    // before anything returns the surface moves by the integral of p / (rho c): 100 kPa * 20 ms / 2 / 518.8 kPa s/m
    let expected = -100e3 * 0.02 / 2. / (2000. * (1e8_f64 * 0.7 / (1.3 * 0.4) / 2000.).sqrt());
    let [limit, error] = ["extrapolated", "error"].map(|key| found["P.uy"][key].as_f64().unwrap());
    assert!((limit - expected).abs() <= error, "{limit} +- {error}, {expected}");
    assert!(stderr.contains("refine1:") && bench.path("output/box/converge/step_4/summary.json").is_file(), "{stderr}");
}

#[test]
fn what_a_study_cannot_do_is_refused_with_a_sentence() {
    let Some(gmsh) = gmsh() else { return };
    let bench = box_bench("refused");
    for (line, words) in [
        ("domain block.json", "needs a script"),
        ("domain box.json --mesh block.msh", "needs a script"),
        ("domain box.json --tolerance 0", "--tolerance 0: write a share greater than 0"),
        ("domain box.json --tolerance 100%", "--tolerance 100%"),
        ("domain box.json --tolerance little", "as in 0.0174 or 1.74%"),
        ("domain box.json --growth 1", "--growth 1: each size must be larger"),
        ("domain box.json --growth NaN", "--growth NaN"),
        ("domain box.json --sizes 0", "--sizes 0"),
        ("domain box.json --width wide", "no constant \"wide\""),
        ("domain box.json --height two", "it has: height, refine, width"),
        ("domain box.json --width height", "must be two constants"),
        ("domain box.json --geo width=1000", "width = 1000 is out of bounds"),
        ("domain box.json --until 1_s", "--until 1 s: the window must end between"),
        ("domain box.json --until 0", "--until 0"),
        ("domain box.json --until soon", "\"soon\" is not a time"),
        ("domain box.json --compare Q", "no probe or pipe \"Q\"; probes: P; pipes: none"),
        ("domain box.json --compare P.M", "one of u, v, a, ux"),
        ("domain box.json --set probes=[]", "nothing to compare"),
        ("converge block.json", "needs a script"),
        ("converge box.json --ratio 1", "--ratio 1: each mesh must be finer"),
        ("converge box.json --ratio 1.0001", "does not make the mesh finer by 1.0001: its elements measure 0.4"),
        ("converge box.json --refine width", "width = 6 does not make the mesh finer by 1.5"),
        ("converge box.json --refine fine", "no constant \"fine\""),
        ("converge box.json --compare Q.uy", "no probe or pipe \"Q\""),
    ] {
        let Outcome { code, stdout, stderr } = run(&bench, &gmsh, line);
        assert_eq!((code, stdout.as_str()), (Some(1), ""), "{line}: {stderr}");
        let sentence = stderr.lines().last().unwrap();
        assert!(sentence.starts_with("coralpipe: ") && sentence.contains(words), "{line}: no {words:?} in: {sentence}");
        assert!(!bench.path("output").exists(), "{line}");
    }
}

/// The surface's edge moves as the ground grows, and with it the front's t = 0; and a load that comes too late moves
/// nothing.
#[test]
fn sizes_that_cannot_be_compared_are_refused() {
    let Some(gmsh) = gmsh() else { return };
    let bench = box_bench("front");
    let front = r#"loads.top.pressure.front={"speed":300,"direction":[1,0]}"#;
    let Outcome { code, stderr, .. } = run(&bench, &gmsh, &format!("domain box.json --set {front}"));
    // 2 m wider, so 1 m earlier at 300 m/s
    assert!(code == Some(1) && stderr.contains("counts t = 0 from its front's arrival"), "{code:?}: {stderr}");
    assert!(stderr.contains("at 6 x 6 comes 3.333 ms away") && stderr.contains("\"detonation\""), "{stderr}");
    let late = "domain box.json --set loads.top.pressure.start=1";
    let Outcome { code, stderr, .. } = run(&bench, &gmsh, late);
    assert!(code == Some(1) && stderr.contains("nothing that is compared moves"), "{code:?}: {stderr}");
    assert!(stderr.contains("the load on \"top\" never acts: it begins at 1 s"), "{stderr}");
}

/// Four runs of 300,000 steps at the least; and five, of which the longest has four times the 30,000 steps of the case.
#[test]
fn studies_above_a_size_are_refused_before_they_begin() {
    let Some(gmsh) = gmsh() else { return };
    let bench = box_bench("large");
    for (line, words) in [
        ("domain box.json --set time.step=1e-7", "4 runs, the longest of 300000 steps"),
        ("converge box.json --set time.step=1e-6", "5 runs, the longest of 120000 steps"),
    ] {
        let Outcome { code, stderr, .. } = run(&bench, &gmsh, line);
        assert!(code == Some(1) && stderr.contains(words) && stderr.contains("--large"), "{line}: {stderr}");
        assert!(!bench.path("output").exists(), "{line}");
    }
}

/// Ctrl-C in the second size: exit code 130, and the first size is done and taken as it is the next time.
#[test]
#[cfg(unix)]
fn an_interrupt_keeps_the_finished_sizes() {
    let Some(gmsh) = gmsh() else { return };
    let bench = box_bench("interrupt");
    let words = ["domain", "box.json", "--set", "time.step=0.005 ms", "--set", "time.end=40 ms"];
    let stderr = bench.path("stderr");
    let mut program = bench.program(&words);
    program.env("CORALPIPE_GMSH", &gmsh).stderr(std::fs::File::create(&stderr).unwrap());
    let child = program.stdout(std::process::Stdio::null()).spawn().unwrap();
    let started = Instant::now();
    while !bench.path("output/box/domain/width6_height6/run.sta").exists() {
        assert!(started.elapsed() < Duration::from_secs(50), "the second size never began");
        std::thread::sleep(Duration::from_millis(1));
    }
    assert!(Command::new("sh").args(["-c", &format!("kill -INT {}", child.id())]).status().unwrap().success());
    let code = code_of(child);
    let told = std::fs::read_to_string(stderr).unwrap();
    assert!(code == Some(130) && told.contains("interrupted in the run width6_height6"), "{code:?}: {told}");
    let first = json(&bench, "output/box/domain/width4_height6/summary.json");
    assert_eq!(first["status"], "done");
    assert!(bench.path("output/box/domain/domain.csv").is_file());
}

fn of<'a>(list: &'a [Return], probe: &str) -> &'a Return {
    list.iter().find(|r| r.probe == probe).unwrap()
}

fn default_case(sets: &[&str]) -> Returns {
    let request = Request {
        case: "geo/twin_pipes.json".into(),
        geo: BTreeMap::new(),
        sets: sets.iter().map(ToString::to_string).collect(),
        mesh: Some("meshes/twin_pipes.msh".into()),
        out: None,
        bonded: false,
        quiet: true,
        large: false,
    };
    returns(&load(&request).unwrap().model).unwrap()
}

/// By hand from the paper's Table 2 (c_p = 620.140, 611.290, 631.977 m/s): 24.040 ms down to 15 m and 15.603 ms up to
/// the invert at 5.2 m; 1.2 m less of layer 2 where the front runs down through a pipe. The sides are felt only by what
/// the left pipe sends out: 6.473 ms to its crown at 4 m, then 2 x 10.7 m from and to its springline H at no more than
/// 631.977 m/s.
#[test]
fn the_default_cases_base_returns_to_the_invert_after_39_64_ms_and_its_sides_to_h_after_40_34_ms() {
    let r = default_case(&[]);
    assert!(r.base_is_held && r.sides_carry_free_field && r.load_is_uniform);
    let close = |a: f64, b: f64| (a - b).abs() < 2e-6;
    let c = of(&r.base, "C");
    assert!(close(c.through_ground, 39.643e-3) && close(c.not_before, 37.680e-3), "{c:?}");
    assert!(close(of(&r.base, "A").through_ground, 39.643e-3 + 1.2 / 611.290), "{r:?}");
    let h = of(&r.sides, "H");
    assert!(close(h.through_ground, 6.473e-3 + 2. * 10.7 / 631.977), "{h:?}");
    // the pipes are symmetric
    assert!(close(h.through_ground, of(&r.sides, "I").through_ground));
    assert!(r.base.iter().chain(&r.sides).all(|r| r.not_before <= r.through_ground));
}

/// Sides that are held in both directions are felt from the load's nearest point on: between 10.7 m at the fastest P
/// speed and the straight ray from the surface's corner, 4.6 m down and 10.7 m across at the slowest, 611.290 m/s.
#[test]
fn held_sides_are_felt_as_soon_as_a_wave_has_run_from_them() {
    let both = "supports={\"base\": [\"x\", \"y\"], \"side_left\": [\"x\", \"y\"], \"side_right\": [\"x\", \"y\"]}";
    let r = default_case(&[both]);
    assert!(!r.sides_carry_free_field);
    let h = of(&r.sides, "H").through_ground;
    let earliest = 10.7 / 631.977 - 1e-6; // speeds to six digits
    assert!((earliest..f64::hypot(4.6, 10.7) / 611.290).contains(&h), "{h}");
}

/// Squares of 1 m, 10 m wide and 6 m deep, without those for which `hole` holds; c_p = 259.44 m/s as above. P is the
/// middle of the surface; `pin` a point at (5, -4), `foot` the left tenth of the base.
fn with_hole(hole: bool, change: impl Fn(&mut serde_json::Value)) -> Returns {
    let mut drawing = support::Drawing::default();
    let nodes: Vec<Vec<usize>> =
        (0..=6).map(|j| (0..=10).map(|i| drawing.node([f64::from(i), f64::from(j) - 6.])).collect()).collect();
    for (j, i) in (0..6).flat_map(|j| (0..10).map(move |i| (j, i))).filter(|at| !hole || *at != (3, 4)) {
        drawing.cell("ground", Shape::Quad4, &[nodes[j][i], nodes[j][i + 1], nodes[j + 1][i + 1], nodes[j + 1][i]]);
    }
    for i in 0..10 {
        drawing.cell(if i == 0 { "foot" } else { "base" }, Shape::Line2, &[nodes[0][i], nodes[0][i + 1]]);
        drawing.cell("top", Shape::Line2, &[nodes[6][i + 1], nodes[6][i]]);
    }
    for j in 0..6 {
        drawing.cell("left", Shape::Line2, &[nodes[j][0], nodes[j + 1][0]]);
        drawing.cell("right", Shape::Line2, &[nodes[j][10], nodes[j + 1][10]]);
    }
    drawing.cell("P", Shape::Point, &[nodes[6][5]]);
    drawing.cell("pin", Shape::Point, &[nodes[2][5]]);
    let mut json = serde_json::json!({
        "materials": { "ground": { "young": "100 MPa", "poisson": 0.3, "density": 2000 } },
        "supports": { "base": ["x", "y"], "foot": ["x", "y"], "left": ["x"], "right": ["x"] },
        "loads": { "top": { "pressure": { "law": "step", "peak": "100 kPa" } } },
        "time": { "step": "1 ms", "end": "10 ms" }, "probes": ["P"],
    });
    change(&mut json);
    returns(&support::model(&json, &drawing.mesh())).unwrap()
}

/// Without pipes the sides are felt all the same where something inside scatters the plane wave. Lengths by hand: 2 m
/// down to the hole's corner at (4, -2), 4 m to the side, 5 m to P; 4 + 5 + 5 by the pin; 6 + 0 + 5 by a base that is
/// not held alike.
#[test]
fn sides_are_felt_by_way_of_whatever_scatters() {
    let c = (100e6 * 0.7 / (1.3 * 0.4) / 2000f64).sqrt();
    let side = |r: &Returns| of(&r.sides, "P").through_ground;
    let plain = with_hole(false, |_| ());
    assert!(plain.sides_carry_free_field && !plain.something_scatters && side(&plain).is_infinite(), "{plain:?}");
    let hole = with_hole(true, |_| ());
    let pin = with_hole(false, |json| json["supports"]["pin"] = serde_json::json!(["x"]));
    let foot = with_hole(false, |json| json["supports"]["base"] = serde_json::json!(["x"]));
    for (what, found, length) in [("hole", hole, 11.), ("pin", pin, 14.), ("foot", foot, 11.)] {
        assert!(found.sides_carry_free_field && found.something_scatters, "{what}: {found:?}");
        assert!((side(&found) * c / length - 1.).abs() < 1e-9, "{what}: {found:?}");
    }
}

/// A node that moves at t = 0 sends waves as a load does.
#[test]
fn what_moves_from_the_start_is_a_source_of_waves() {
    let c = (100e6 * 0.7 / (1.3 * 0.4) / 2000f64).sqrt();
    let pin = serde_json::json!({ "pin": { "velocity": [0, -1] } });
    let alone = with_hole(false, |json| {
        json["loads"] = serde_json::json!({});
        json["initial"] = pin.clone();
    });
    assert!(!alone.sides_carry_free_field && !alone.load_is_uniform, "{alone:?}");
    // from (5, -4): 2 m down and 6 m up, 5 m across and back
    assert!((of(&alone.base, "P").through_ground * c / 8. - 1.).abs() < 1e-9, "{alone:?}");
    assert!((of(&alone.sides, "P").through_ground * c / 10. - 1.).abs() < 1e-9, "{alone:?}");
    let both = with_hole(false, |json| json["initial"] = pin.clone());
    assert!(!both.load_is_uniform && of(&both.sides, "P").through_ground * c <= 5. + 1e-9, "{both:?}");
}
