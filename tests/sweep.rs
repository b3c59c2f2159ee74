//! `coralpipe sweep`: runs that march together give what each gives alone, and nothing done is done again.

mod program;

use program::Bench;
use serde_json::Value;
use std::fs;

/// Six runs over one factor, and six over another: the time step changes the matrix.
const PLAN: &str = r#"{
  "case": "block.json",
  "set": { "time.step": ["0.5 ms", "0.25 ms"],
           "interfaces.interface.friction": [0.1, 0.5],
           "loads.top.pressure.peak": ["50 kPa", "1 MPa", "-200 kPa"] }
}"#;

fn swept(test: &str) -> Bench {
    let bench = Bench::new(test);
    bench.write("plan.json", PLAN);
    let outcome = bench.run_line("sweep plan.json");
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    bench
}

/// To the last digit: the histories, the table of rings and the energies.
#[test]
fn a_run_among_others_gives_what_it_gives_alone() {
    let bench = swept("sweep-alone");
    let mut slipped = 0;
    for (step, name_of_step) in [("0.5 ms", "0.5ms"), ("0.25 ms", "0.25ms")] {
        for friction in ["0.1", "0.5"] {
            for (peak, name_of_peak) in [("50 kPa", "50kPa"), ("1 MPa", "1MPa"), ("-200 kPa", "-200kPa")] {
                let sets = [
                    format!("time.step=\"{step}\""),
                    format!("interfaces.interface.friction={friction}"),
                    format!("loads.top.pressure.peak=\"{peak}\""),
                ];
                let arguments =
                    ["run", "block.json", "--out", "alone", "--set", &sets[0], "--set", &sets[1], "--set", &sets[2]];
                assert_eq!(bench.run(&arguments).code, Some(0));
                let folder = format!("output/plan/step{name_of_step}_friction{friction}_peak{name_of_peak}");
                let read = |folder: &str, file: &str| fs::read_to_string(bench.path(folder).join(file)).unwrap();
                for file in ["histories.csv", "rings.csv"] {
                    assert!(read("alone", file) == read(&folder, file), "{file} of {folder}");
                }
                let summary = |folder: &str| serde_json::from_str::<Value>(&read(folder, "summary.json")).unwrap();
                let (alone, among) = (summary("alone"), summary(&folder));
                for key in ["status", "steps", "iterations", "contact", "peaks", "energy", "frequencies_hz"] {
                    assert_eq!(alone[key], among[key], "{key} of {folder}");
                }
                slipped += usize::from(among["contact"]["status_changes"].as_u64() > Some(0));
            }
        }
    }
    assert!(slipped > 6, "joints must open and slip for the comparison to say something");
}

#[test]
fn what_is_done_is_not_done_again_and_what_changed_is() {
    let bench = swept("sweep-again");
    let folder = "output/plan/step0.5ms_friction0.1_peak50kPa";
    let when = || fs::metadata(bench.path(folder).join("summary.json")).unwrap().modified().unwrap();
    let first = when();
    assert!(bench.run_line("sweep plan.json").stderr.contains("12 done before"));
    assert_eq!(when(), first);

    fs::remove_file(bench.path("output/plan/step0.25ms_friction0.5_peak1MPa/summary.json")).unwrap();
    assert!(bench.run_line("sweep plan.json").stderr.contains("11 done before"));
    bench.write(
        "block.json",
        program::CASE.replace("\"damping\": { \"ratio\": 0.05 }", "\"damping\": { \"ratio\": 0.03 }"),
    );
    assert!(bench.run_line("sweep plan.json").stderr.contains(" 0 done before"));
    assert!(when() > first);
}

#[test]
fn the_table_has_a_row_a_run() {
    let bench = swept("sweep-table");
    let table = fs::read_to_string(bench.path("output/plan/sweep.csv")).unwrap();
    let rows: Vec<Vec<&str>> = table.lines().map(|line| line.split(',').collect()).collect();
    assert_eq!(rows.len(), 13);
    let column = |name: &str| rows[0].iter().position(|c| *c == name).unwrap();
    let (peak, load) = (column("Q.uy"), column("loads.top.pressure.peak"));
    for row in &rows[1..] {
        assert_eq!(row[column("status")], "done");
        let down: f64 = row[peak].parse().unwrap();
        assert_eq!(down > 0., row[load].starts_with('-'), "suction lifts, pressure presses: {row:?}");
    }
}

#[test]
fn a_bad_plan_is_refused_before_anything_runs() {
    let bench = Bench::new("sweep-bad");
    let rows: [(&str, &[&str]); 10] = [
        ("{", &["bad.json", "line 1", "interfaces.interface_left.friction"]),
        (r#"{"case": "block.json", "geo": {"crown": [4, 4.0]}}"#, &["geo.crown", "4.0 stands twice"]),
        (r#"{"case": "block.json", "set": {"time.step": ["1 ms", "1 ms"]}}"#, &["set.time.step", "stands twice"]),
        (r#"{"set": {}}"#, &["bad.json", "case"]),
        (r#"{"case": "block.json"}"#, &["bad.json", "vary something"]),
        (r#"{"case": "block.json", "set": {"time.step": "1 ms"}}"#, &["set.time.step", "a list"]),
        (r#"{"case": "block.json", "set": {"time.stop": [1, 2]}}"#, &["stop1", "time", "\"step\""]),
        (r#"{"case": "block.json", "geo": {"width": ["wide"]}}"#, &["geo.width", "no number"]),
        (r#"{"case": "block.json", "geo": {"a": [1]}, "geo": {"b": [2]}}"#, &["bad.json", "\"geo\" stands twice"]),
        (r#"{"case": "block.json", "runs": [1]}"#, &["bad.json", "runs"]),
    ];
    for (plan, words) in rows {
        bench.write("bad.json", plan);
        let outcome = bench.run_line("sweep bad.json");
        assert_eq!(outcome.code, Some(1), "{plan}: {}", outcome.stderr);
        for word in words {
            assert!(outcome.stderr.contains(word), "{plan}: no {word:?} in {}", outcome.stderr);
        }
        assert!(!bench.path("output").exists(), "{plan}: a refused sweep must not write");
    }
}

/// As on a disk that is full after the first run: the second one's folder cannot be made.
#[test]
fn a_sweep_that_cannot_go_on_says_what_is_done() {
    let bench = Bench::new("sweep-full");
    bench.write("plan.json", r#"{ "case": "block.json", "set": { "damping.ratio": [0.02, 0.05] } }"#);
    fs::create_dir_all(bench.path("output/plan")).unwrap();
    bench.write("output/plan/ratio0.05", "in the way");
    let outcome = bench.run_line("sweep plan.json");
    assert_eq!(outcome.code, Some(1), "{}", outcome.stderr);
    assert!(outcome.stderr.contains("1 of 2 runs are done and stay in output/plan"), "{}", outcome.stderr);
    fs::remove_file(bench.path("output/plan/ratio0.05")).unwrap();
    assert!(bench.run_line("sweep plan.json").stderr.contains("2 runs, 1 done before"));
}
