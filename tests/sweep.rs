//! `coralpipe sweep`: runs that march together give what each gives alone, and nothing done is done again.

mod program;

use program::{Bench, CASE, Outcome, code_of};
use serde_json::Value;
use std::fs;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

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
    let rows: [(&str, &[&str]); 14] = [
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
        // one and the same case however it is written
        (
            r#"{"case": "block.json", "set": {"time.step": ["0.2 ms", 0.0002]}}"#,
            &["step0.2ms and step0.0002 are the same case"],
        ),
        (
            r#"{"case": "block.json", "set": {"loads.top.pressure.peak": ["100 Pa", "50 kPa", "0.05 MPa"]}}"#,
            &["peak50kPa and peak0.05MPa are the same case"],
        ),
        (
            r#"{"case": "block.json", "set": {"materials.gruond": [{"young": 1}]}}"#,
            &["coralpipe: block.json with --set materials.gruond"],
        ),
        // what no case fits the mesh by is seen before a folder is made
        (
            r#"{"case": "block.json", "set": {"supports": [{"foot": ["x"]}, {"foot": ["y"]}]}}"#,
            &["supports#1: ", "foot"],
        ),
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

/// The table as column -> cell of each row.
fn rows(bench: &Bench, file: &str) -> Vec<Vec<(String, String)>> {
    let text = fs::read_to_string(bench.path(file)).unwrap();
    let mut lines = text.lines().map(|line| line.split(',').map(String::from).collect::<Vec<_>>());
    let columns = lines.next().unwrap();
    lines.map(|cells| columns.iter().cloned().zip(cells).collect()).collect()
}

fn cell<'a>(row: &'a [(String, String)], column: &str) -> &'a str {
    &row.iter().find(|(c, _)| c == column).unwrap_or_else(|| panic!("no {column} in {row:?}")).1
}

fn statuses(bench: &Bench, file: &str) -> Vec<String> {
    rows(bench, file).iter().map(|row| cell(row, "status").to_string()).collect()
}

/// A plan over two peaks and what else is given.
fn plan(more: &str) -> String {
    format!(r#"{{ "case": "block.json", "set": {{ "loads.top.pressure.peak": ["50 kPa", "60 kPa"]{more} }} }}"#)
}

fn sweep(bench: &Bench, text: &str) -> Outcome {
    bench.write("plan.json", text);
    bench.run_line("sweep plan.json")
}

/// The names of the folders are the same: only what they were made from tells the results apart.
#[test]
fn numbers_of_an_earlier_plan_are_never_in_the_table() {
    let bench = Bench::new("sweep-stale");
    let first = sweep(&bench, &plan(""));
    assert_eq!((first.code, statuses(&bench, "output/plan/sweep.csv")), (Some(0), vec!["done".to_string(); 2]));
    let refused = sweep(&bench, &plan(r#", "damping": [{ "ratio": 0.05, "modes": [1, 190] }]"#));
    assert_eq!(refused.code, Some(1), "bad input, not a lack of convergence: {}", refused.stderr);
    assert!(refused.stderr.contains("2 of them replace results of another case"), "{}", refused.stderr);
    for row in rows(&bench, "output/plan/sweep.csv") {
        assert_eq!(cell(&row, "status"), "refused");
        assert!(row.iter().all(|(column, _)| column != "f1" && column != "Q.uy"), "{row:?}");
    }
    assert!(refused.stdout.contains("peak50kPa  refused") && !refused.stdout.contains("gap"), "{}", refused.stdout);
}

/// Two runs without end are asked to stop, those over another factor wait for them: "not run", though their folders
/// hold results of the case before it was changed.
#[test]
fn an_interrupt_leaves_a_table_of_what_is_done_and_says_how_to_go_on() {
    let bench = Bench::new("sweep-interrupt");
    assert_eq!(sweep(&bench, &plan(r#", "time.step": ["0.5 ms", "0.25 ms"]"#)).code, Some(0));
    bench.write("block.json", CASE.replace("\"10 ms\"", "\"1000 s\"").replace("\"1 ms\"", "\"1 s\""));
    let begun = ["50", "60"].map(|peak| bench.path(format!("output/plan/peak{peak}kPa_step0.5ms/run.sta")));
    begun.iter().for_each(|file| fs::remove_file(file).unwrap());
    let (stdout, stderr) = (bench.path("stdout"), bench.path("stderr"));
    let mut program = bench.program(&["sweep", "plan.json", "--large"]);
    let file = |path| Stdio::from(fs::File::create(path).unwrap());
    let child = program.stdout(file(&stdout)).stderr(file(&stderr)).spawn().unwrap();
    let started = Instant::now();
    while !begun.iter().all(|file| file.exists()) && started.elapsed() < Duration::from_secs(30) {
        std::thread::sleep(Duration::from_millis(5));
    }
    assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
    assert_eq!(code_of(child), Some(130));
    let (stdout, stderr) = (fs::read_to_string(stdout).unwrap(), fs::read_to_string(stderr).unwrap());
    let found = statuses(&bench, "output/plan/sweep.csv");
    assert_eq!(found, ["interrupted", "not run", "interrupted", "not run"], "{stdout}{stderr}");
    assert_eq!(stdout.lines().count(), 5, "a line a run and the folder: {stdout}");
    assert!(!stdout.contains("gap"), "numbers of the earlier case: {stdout}");
    let last = stderr.lines().last().unwrap();
    assert!(last.starts_with("coralpipe: interrupted; 0 of 4 runs are done and stay in output/plan"), "{last}");
}

#[test]
fn a_run_is_done_again_where_files_are_lost_or_frames_are_asked_for() {
    let bench = Bench::new("sweep-lost");
    assert_eq!(sweep(&bench, &plan("")).code, Some(0));
    let before =
        |outcome: Outcome| outcome.stderr.split_once(" done before").unwrap().0.rsplit(' ').next().unwrap().to_string();
    let folder = bench.path("output/plan/peak50kPa");
    for file in ["histories.csv", "rings.csv", "run.sta"] {
        fs::remove_file(folder.join(file)).unwrap();
        assert_eq!(before(sweep(&bench, &plan(""))), "1", "{file}");
    }
    fs::OpenOptions::new().write(true).open(folder.join("histories.csv")).unwrap().set_len(1000).unwrap();
    assert_eq!(before(sweep(&bench, &plan(""))), "1", "cut");

    let with_frames = plan("").replace("\"set\"", "\"frames\": true, \"set\"");
    assert_eq!(before(sweep(&bench, &with_frames)), "0");
    assert_eq!(before(sweep(&bench, &with_frames)), "2");
    fs::remove_file(folder.join("frames/peak50kPa_00003.vtu")).unwrap();
    assert_eq!(before(sweep(&bench, &plan(""))), "2", "frames are not asked for");
    assert_eq!(before(sweep(&bench, &with_frames)), "1", "a frame is lost");
    fs::remove_file(folder.join("peak50kPa.pvd")).unwrap();
    assert_eq!(before(sweep(&bench, &with_frames)), "1", "the series is lost");
}

#[test]
fn warnings_of_a_run_are_told_and_counted() {
    let bench = Bench::new("sweep-warnings");
    let undamped =
        r#"{ "case": "block.json", "set": { "damping": [null], "loads.top.pressure.peak": ["10 GPa", "1 kPa"] } }"#;
    let outcome = sweep(&bench, undamped);
    assert_eq!(outcome.code, Some(0));
    let rows = rows(&bench, "output/plan/sweep.csv");
    let text = fs::read_to_string(bench.path("output/plan/peak10GPa/summary.json")).unwrap();
    let summary: Value = serde_json::from_str(&text).unwrap();
    let warnings = summary["warnings"].as_array().unwrap();
    assert!(warnings.len() > 1 && cell(&rows[0], "warnings") == warnings.len().to_string());
    // the square body has no section forces in either run
    assert_eq!(cell(&rows[1], "warnings"), "1");
    for warning in warnings {
        assert!(outcome.stderr.contains(&format!("warning: {}", warning.as_str().unwrap())), "{}", outcome.stderr);
    }
    let marks = [format!(" {} warnings", warnings.len()), " 1 warning".into()];
    let marked: Vec<bool> = outcome.stdout.lines().zip(&marks).map(|(line, mark)| line.ends_with(mark)).collect();
    assert_eq!(marked, [true, true], "{}", outcome.stdout);
}

#[test]
fn the_table_has_the_columns_of_all_rows() {
    let bench = Bench::new("sweep-columns");
    let outcome = sweep(&bench, r#"{ "case": "block.json", "set": { "probes": [["Q"], ["P"], ["P", "Q"]] } }"#);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let text = fs::read_to_string(bench.path("output/plan/sweep.csv")).unwrap();
    let header = text.lines().next().unwrap();
    assert!(header.ends_with("Q.ux,Q.uy,Q.vx,Q.vy,Q.ax,Q.ay,P.ux,P.uy,P.vx,P.vy,P.ax,P.ay"), "{header}");
}

#[test]
fn a_sweep_writes_into_folders_of_its_own_only() {
    let bench = Bench::new("sweep-foreign");
    bench.write("plan.json", plan(""));
    for (folder, file, content) in [("notes", "notes.txt", "mine"), ("table", "sweep.csv", "my,table")] {
        fs::create_dir_all(bench.path(folder)).unwrap();
        bench.write(format!("{folder}/{file}"), content);
        let outcome = bench.run_line(&format!("sweep plan.json --out {folder}"));
        assert_eq!(outcome.code, Some(1), "{}", outcome.stderr);
        assert!(outcome.stderr.contains(&format!("{folder} is no folder of a sweep: it holds {file};")));
        assert_eq!(fs::read_to_string(bench.path(format!("{folder}/{file}"))).unwrap(), content);
        assert_eq!(fs::read_dir(bench.path(folder)).unwrap().count(), 1);
    }
    assert_eq!(bench.run_line("sweep plan.json --out own").code, Some(0));
    let nested = bench.run_line("sweep plan.json --out own/peak50kPa");
    assert!(nested.code == Some(1) && nested.stderr.contains("no folder of a sweep"), "{}", nested.stderr);
    // another plan of the same name
    fs::create_dir(bench.path("other")).unwrap();
    bench.write("other/plan.json", plan("").replace("block.json", "../block.json"));
    let other = bench.run_line("sweep other/plan.json --out own");
    assert!(other.stderr.contains("the table in own is of another plan"), "{}", other.stderr);
    // another process
    let lock = fs::File::open(bench.path("own")).unwrap();
    lock.lock().unwrap();
    let locked = bench.run_line("sweep plan.json --out own");
    assert!(locked.code == Some(1) && locked.stderr.contains("another run is writing into own"), "{}", locked.stderr);
}

/// A step has no duration; a folder with a user's file in it is not written to.
#[test]
fn runs_that_cannot_start_leave_the_others_alone() {
    let bench = Bench::new("sweep-refused");
    let laws = r#"{ "case": "block.json", "set": { "loads.top.pressure.law": ["linear", "half_sine", "step"] } }"#;
    let outcome = sweep(&bench, laws);
    assert_eq!(outcome.code, Some(1), "{}", outcome.stderr);
    assert_eq!(statuses(&bench, "output/plan/sweep.csv"), ["done", "done", "refused"]);
    assert!(
        outcome
            .stderr
            .lines()
            .last()
            .unwrap()
            .contains("1 of 3 runs did not get to their end, the first of them lawstep")
    );

    let bench = Bench::new("sweep-in-the-way");
    assert_eq!(sweep(&bench, &plan("")).code, Some(0));
    fs::remove_dir_all(bench.path("output/plan/peak60kPa")).unwrap();
    bench.write("output/plan/peak60kPa", "in the way");
    let outcome = bench.run_line("sweep plan.json");
    assert_eq!(
        (outcome.code, statuses(&bench, "output/plan/sweep.csv")),
        (Some(1), vec!["done".into(), "refused".into()])
    );
    assert!(!outcome.stderr.contains("the same command goes on"), "it does not: {}", outcome.stderr);
}

/// Files may have so many blocks of 1024 bytes: what does not fit is refused in the middle of a line.
#[test]
fn a_full_disk_leaves_whole_lines_and_says_what_is_done() {
    let bench = Bench::new("sweep-full");
    let long = r#"{ "case": "block.json", "set": { "time.end": ["5 ms", "500 ms"] } }"#;
    bench.write("plan.json", long);
    let mut limited = Command::new("bash");
    limited.args(["-c", "trap '' XFSZ; ulimit -f 20; exec \"$0\" sweep plan.json", env!("CARGO_BIN_EXE_coralpipe")]);
    let outcome = limited.current_dir(&bench.folder).output().unwrap();
    let stderr = String::from_utf8_lossy(&outcome.stderr);
    assert_eq!(outcome.status.code(), Some(1), "{stderr}");
    let last = stderr.lines().last().unwrap();
    assert!(
        last.contains("cannot be written") && last.contains("1 of 2 runs are done and stay in output/plan"),
        "{last}"
    );
    for file in ["histories.csv", "run.sta"] {
        let text = fs::read_to_string(bench.path("output/plan/end500ms").join(file)).unwrap();
        assert!(text.is_empty() || text.ends_with('\n'), "{file} ends in {:?}", &text[text.len() - 40..]);
    }
    assert_eq!(statuses(&bench, "output/plan/sweep.csv"), ["done", "not run"]);
    assert!(sweep(&bench, long).stderr.contains("2 runs, 1 done before"));
    assert_eq!(statuses(&bench, "output/plan/sweep.csv"), ["done", "done"]);
}

/// Files on their way have the id of the process that writes them.
#[test]
fn what_a_killed_sweep_left_on_its_way_is_swept_up() {
    let bench = Bench::new("sweep-parts");
    assert_eq!(sweep(&bench, &plan("")).code, Some(0));
    let parts = ["output/plan/peak50kPa/.peak50kPa.pvd.27565.part", "output/plan/.sweep.csv.27565.part"];
    let others = ["output/plan/peak50kPa/.mine.part", "output/plan/peak50kPa/mine.27565.part"];
    parts.iter().chain(&others).for_each(|file| bench.write(file, "half"));
    fs::remove_file(bench.path("output/plan/peak50kPa/run.sta")).unwrap();
    assert_eq!(bench.run_line("sweep plan.json").code, Some(0));
    assert_eq!(parts.map(|file| bench.path(file).exists()), [false; 2]);
    assert_eq!(others.map(|file| bench.path(file).exists()), [true; 2]);
}

#[test]
fn a_sweep_counts_as_it_goes_and_a_plan_may_begin_with_a_byte_order_mark() {
    let bench = Bench::new("sweep-told");
    bench.write("block.json", format!("\u{feff}{CASE}"));
    let outcome = sweep(&bench, &format!("\u{feff}{}", plan("")));
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    for count in ["1 of 2, peak", "1 left, about ", "2 of 2, peak"] {
        assert!(outcome.stderr.contains(count), "no {count:?}: {}", outcome.stderr);
    }
}

/// Numbers are read from summaries as they were written, all 17 digits.
#[test]
fn a_sweep_with_nothing_to_do_leaves_its_table_byte_for_byte() {
    let bench = swept("sweep-idle");
    let table = || fs::read_to_string(bench.path("output/plan/sweep.csv")).unwrap();
    let first = table();
    let digits = first.split([',', '\n']).filter(|cell| cell.len() > 18 && cell.contains('.')).count();
    assert!(digits > 50, "too few long numbers to see a difference: {digits}");
    for _ in 0..2 {
        let idle = bench.run_line("sweep plan.json");
        assert!(idle.code == Some(0) && idle.stderr.contains("12 done before; 0 to do"), "{}", idle.stderr);
        assert!(table() == first, "the table has changed");
    }
}
