//! Accidents around a run: leftovers of one that was cut short, a folder removed meanwhile, a stdout that takes nothing,
//! and inputs that never end.

mod program;

use program::{Bench, CASE, Outcome, code_of, failing_run};
use std::fs::{self, File};
use std::io::Write;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// Files with their contents, in a folder that is made.
type Files<'a> = &'a [(&'a str, &'a str)];

fn fill(bench: &Bench, folder: &str, files: Files) {
    fs::create_dir_all(bench.path(folder)).unwrap();
    for (name, content) in files {
        let path = bench.path(folder).join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, content).unwrap();
    }
}

const RINGS: &str = "t,body,angle_deg,N,Q,M,hoop_inner,hoop_outer,u_r,u_t,sigma_n,tau\n";
const SERIES: &str = "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" byte_or";

/// Each is what a kill or a full disk has left, of this version or of one that wrote `run.sta` later.
const LEFT: [Files; 9] = [
    &[("rings.csv", "")],
    &[("rings.csv", RINGS)],
    &[("frames/.block_00000.vtu.4711.part", "<VTK")],
    &[("rings.csv", RINGS), ("frames/block_00000.vtu", "<VTKFile"), ("block.pvd", SERIES), ("histories.csv", "t,P.ux")],
    &[(".block.pvd.4711.part", ""), ("run.sta", "")],
    &[(".summary.json.4711.part", "{")],
    &[("previous.part/run.sta", "")],
    &[(".previous.4711.part/frames/block_00000.vtu", "")],
    &[("batch.log", ""), ("modes/.block_mode_1.vtu.4711.part", ""), ("domain/width5_height5/run.sta", "")],
];

#[test]
fn leftovers_of_a_run_cut_short_are_taken_over() {
    let bench = Bench::new("left");
    for (i, files) in LEFT.iter().enumerate() {
        for command in ["run block.json --set time.end=1ms", "modes block.json -n 1"] {
            let folder = format!("{}{i}", command.split(' ').next().unwrap());
            fill(&bench, &folder, files);
            let outcome = bench.run_line(&format!("{command} --out {folder}"));
            assert_eq!(outcome.code, Some(0), "{command} over {files:?}: {}", outcome.stderr);
        }
        let found: Vec<String> = fs::read_dir(bench.path(format!("run{i}")))
            .unwrap()
            .map(|e| e.unwrap().file_name().into_string().unwrap())
            .collect();
        assert!(!found.iter().any(|name| name.contains("previous") || name.ends_with(".part")), "{files:?}: {found:?}");
        let frames = fs::read_dir(bench.path(format!("run{i}/frames"))).unwrap().count();
        assert_eq!(frames, 2, "frames of the run cut short are gone");
    }
}

/// In the folder of a run, and in that of the sweep before its record is written.
#[test]
fn a_sweep_takes_over_what_a_kill_has_left_in_its_folders() {
    let bench = Bench::new("left-by-sweep");
    bench.write("plan.json", r#"{ "case": "block.json", "set": { "time.end": ["1 ms", "2 ms"] } }"#);
    fill(&bench, "output/plan", &[(".sweep.json.4711.part", "{")]);
    let first = bench.run_line("sweep plan.json");
    assert_eq!(first.code, Some(0), "{}", first.stderr);
    for (i, files) in LEFT.iter().enumerate() {
        fs::remove_dir_all(bench.path("output/plan/end1ms")).unwrap();
        fill(&bench, "output/plan/end1ms", files);
        let outcome = bench.run_line("sweep plan.json");
        assert_eq!(outcome.code, Some(0), "{i}: {}", outcome.stderr);
    }
    assert!(!bench.path("output/plan/.sweep.json.4711.part").exists());
}

/// A finished run is not run again, but what a kill at its very end left beside it goes.
#[test]
fn a_sweep_clears_what_a_kill_left_beside_finished_runs() {
    let bench = Bench::new("left-beside");
    bench.write("plan.json", r#"{ "case": "block.json", "set": { "time.end": ["1 ms", "2 ms"] } }"#);
    assert_eq!(bench.run_line("sweep plan.json").code, Some(0));
    fill(&bench, "output/plan/end1ms", &[("previous/run.sta", ""), (".summary.json.4711.part", ""), ("notes", "mine")]);
    let outcome = bench.run_line("sweep plan.json");
    assert!(outcome.stderr.contains("2 done before"), "{}", outcome.stderr);
    let left =
        ["previous", ".summary.json.4711.part", "notes"].map(|f| bench.path("output/plan/end1ms").join(f).exists());
    assert_eq!(left, [false, false, true]);
}

#[test]
fn files_of_somebody_else_are_still_refused_and_kept() {
    let bench = Bench::new("foreign-files");
    let foreign: [Files; 9] = [
        &[("rings.csv", "t,ring\n")],
        &[("histories.csv", "time,x\n")],
        &[("frames/photo.png", "")],
        &[("frames/photo_1.vtu", "")],
        &[("frames/photos/block_00000.vtu", "")],
        &[("mine.pvd", "<?xml version=\"1.0\"?>\n<VTKFile type=\"ImageData\"")],
        &[("rings.csv", ""), ("notes.txt", "")],
        &[(".mine.part", "")],
        &[("summary.json", "{\"status\": \"done\"}")],
    ];
    for (i, files) in foreign.iter().enumerate() {
        let folder = format!("mine{i}");
        fill(&bench, &folder, files);
        for command in ["run block.json", "modes block.json -n 1"] {
            let Outcome { code, stderr, .. } = bench.run_line(&format!("{command} --out {folder}"));
            assert_eq!(code, Some(1), "{command} over {files:?}: {stderr}");
            assert!(stderr.contains("is no folder of results: it holds "), "{stderr}");
        }
        for (name, content) in *files {
            assert_eq!(fs::read_to_string(bench.path(&folder).join(name)).unwrap(), *content, "{name}");
        }
    }
}

/// A run replaces the frames of an earlier one.
#[test]
fn a_file_of_the_users_among_the_frames_is_kept() {
    let bench = Bench::new("among-frames");
    assert_eq!(bench.run_line("run block.json --quiet").code, Some(0));
    bench.write("output/block/frames/mine.txt", "mine");
    let Outcome { code, stderr, .. } = bench.run_line("run block.json --quiet");
    assert_eq!(code, Some(1), "{stderr}");
    assert!(stderr.contains("output/block/frames holds mine.txt") && stderr.contains("move it elsewhere"), "{stderr}");
    assert_eq!(fs::read_to_string(bench.path("output/block/frames/mine.txt")).unwrap(), "mine");
    assert!(bench.path("output/block/summary.json").exists());
}

/// Steps without end.
fn endless(bench: &Bench, stderr: &Path) -> Child {
    let sets = ["--set", "time.end=1000 s", "--set", "output.every=1 ms"];
    let mut program = bench.program(&[&["run", "block.json", "--quiet", "--large"][..], &sets].concat());
    let child = program.stdout(Stdio::null()).stderr(File::create(stderr).unwrap()).spawn().unwrap();
    wait_for(&bench.path("output/block/frames/block_00003.vtu"));
    child
}

fn wait_for(path: &Path) {
    let started = Instant::now();
    while !path.exists() {
        assert!(started.elapsed() < Duration::from_secs(30), "no {}", path.display());
        std::thread::sleep(Duration::from_millis(2));
    }
}

/// Until nothing new is written into it any more.
fn remove(path: &Path) {
    let started = Instant::now();
    while path.exists() && (fs::remove_dir_all(path).is_err() || path.exists()) {
        assert!(started.elapsed() < Duration::from_secs(30), "{} comes back", path.display());
    }
}

#[test]
fn a_folder_removed_or_moved_away_while_a_run_writes_ends_it_with_a_sentence() {
    type Accident = fn(&Bench);
    let accidents: [(&str, Accident); 6] = [
        ("output/block", |bench| remove(&bench.path("output/block"))),
        ("output", |bench| remove(&bench.path("output"))),
        ("output/block", |bench| fs::rename(bench.path("output/block"), bench.path("away")).unwrap()),
        ("output/block", |bench| {
            fs::rename(bench.path("output/block"), bench.path("away")).unwrap();
            fs::create_dir(bench.path("output/block")).unwrap();
            fs::create_dir(bench.path("output/block/frames")).unwrap();
        }),
        ("output/block/frames", |bench| fs::rename(bench.path("output/block/frames"), bench.path("away")).unwrap()),
        ("output/block/frames", |bench| remove(&bench.path("output/block/frames"))),
    ];
    for (i, (lost, accident)) in accidents.into_iter().enumerate() {
        let bench = Bench::new(&format!("removed{i}"));
        let stderr = bench.path("stderr");
        let child = endless(&bench, &stderr);
        accident(&bench);
        assert_eq!(code_of(child), Some(1), "{i}");
        let told = fs::read_to_string(stderr).unwrap();
        assert!(told.lines().last().unwrap().starts_with("coralpipe: ") && told.contains("removed"), "{i}: {told}");
        assert!(told.contains("output/block"), "{i}: {told}");
        let is_made_again = bench.path(lost).exists() && i != 3;
        assert!(!is_made_again, "{i}: {lost} was made again");
        assert!(!bench.path("output/block/summary.json").exists(), "{i}");
    }
}

#[test]
fn a_table_removed_while_a_run_writes_is_no_finished_run() {
    for name in ["histories.csv", "rings.csv", "run.sta", "frames/block_00000.vtu"] {
        let bench = Bench::new(&format!("removed-{}", name.replace('/', "-")));
        let stderr = bench.path("stderr");
        let child = endless(&bench, &stderr);
        fs::remove_file(bench.path("output/block").join(name)).unwrap();
        assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
        assert_eq!(code_of(child), Some(1), "{name}");
        let told = fs::read_to_string(stderr).unwrap();
        assert!(told.contains(&format!("output/block/{name} was removed")), "{told}");
    }
}

#[test]
fn a_sweep_whose_folder_is_removed_ends_and_does_not_make_it_again() {
    for removed in ["output/plan", "output"] {
        let bench = Bench::new(&format!("removed-sweep-{}", removed.len()));
        let peaks: Vec<String> = (1..=40).map(|k| format!("\"{k} kPa\"")).collect();
        let end = r#""time.end": ["5 s"]"#;
        let set = format!(r#"{{ "loads.top.pressure.peak": [{}], {end} }}"#, peaks.join(", "));
        bench.write("plan.json", format!(r#"{{ "case": "block.json", "set": {set} }}"#));
        let stderr = bench.path("stderr");
        let mut program = bench.program(&["sweep", "plan.json", "--quiet"]);
        let child = program.stdout(Stdio::null()).stderr(File::create(&stderr).unwrap()).spawn().unwrap();
        wait_for(&bench.path("output/plan/peak1kPa/run.sta"));
        remove(&bench.path(removed));
        assert_eq!(code_of(child), Some(1));
        let told = fs::read_to_string(stderr).unwrap();
        assert!(told.contains("output/plan") && told.contains("removed"), "{told}");
        assert!(!bench.path(removed).exists(), "it was made again: {told}");
    }
}

fn with_full_stdout(bench: &Bench, line: &str) -> Outcome {
    let full = File::options().write(true).open("/dev/full").unwrap();
    let stderr = bench.path(".stderr");
    let mut program = bench.program(&line.split_whitespace().collect::<Vec<_>>());
    let child = program.stdout(full).stderr(File::create(&stderr).unwrap()).spawn().unwrap();
    let code = code_of(child);
    Outcome { code, stdout: String::new(), stderr: fs::read_to_string(stderr).unwrap() }
}

/// What is on disk is not lost where stdout is full; what stdout alone was to have is.
#[test]
#[cfg(target_os = "linux")]
fn a_full_stdout_is_an_error_only_where_it_alone_has_the_result() {
    let bench = Bench::new("full-stdout");
    bench.write("plan.json", r#"{ "case": "block.json", "set": { "time.end": ["1 ms", "2 ms"] } }"#);
    let rows = [
        ("run block.json --quiet", 0),
        ("run block.json", 0),
        ("modes block.json -n 2", 0),
        ("mesh block.json", 0),
        ("sweep plan.json", 0),
        ("check block.json", 1),
        ("blast --charge 1t --standoff 30m", 1),
        ("blast --charge 1t --standoff 30m --json", 1),
        ("blast --charge 1t --standoff 30m --out pulse.csv", 1),
        ("schema", 1),
    ];
    for (line, code) in rows {
        let outcome = with_full_stdout(&bench, line);
        assert_eq!(outcome.code, Some(code), "{line}: {}", outcome.stderr);
        let last = outcome.stderr.lines().last().unwrap_or_default();
        assert!(last.contains("stdout cannot be written: No space left"), "{line}: {last}");
        assert_eq!(last.contains("the results are on disk"), code == 0, "{line}: {last}");
    }
    assert!(bench.path("output/block/summary.json").exists() && bench.path("output/plan/sweep.csv").exists());
}

/// The table that cannot be shown does not hide why the sweep failed.
#[test]
#[cfg(target_os = "linux")]
fn a_full_stdout_hides_no_other_failure() {
    let bench = Bench::new("full-stdout-failed");
    let sets: String = program::FAILS.iter().fold(String::new(), |sets, set| {
        let (path, value) = set.split_once('=').unwrap();
        let value = if serde_json::from_str::<serde_json::Value>(value).is_ok() {
            value.into()
        } else {
            format!("\"{value}\"")
        };
        format!("{sets}\"{path}\": [{value}], ")
    });
    bench.write("plan.json", format!(r#"{{ "case": "block.json", "set": {{ {sets} "title": ["a", "b"] }} }}"#));
    let outcome = with_full_stdout(&bench, "sweep plan.json");
    assert_eq!(outcome.code, Some(3), "{}", outcome.stderr);
    for words in ["stdout cannot be written", "2 of 2 runs did not get to their end", "no convergence"] {
        assert!(outcome.stderr.contains(words), "{words}: {}", outcome.stderr);
    }
    assert_eq!(failing_run(&bench).code, Some(3));
}

/// A file of so many bytes that takes no space on disk.
fn sparse(bench: &Bench, name: &str, bytes: u64) {
    File::create(bench.path(name)).unwrap().set_len(bytes).unwrap();
}

/// Every way in which a file is named, with `FILE` in its place.
const WAYS: [&str; 7] = [
    "run FILE",
    "check FILE",
    "run block.json --mesh FILE",
    "run block.json --set loads={\"top\":{\"pressure\":{\"law\":\"table\",\"file\":\"FILE\"}}}",
    "run block.json --set geometry={\"script\":\"FILE\"}",
    "run block.json --set geometry={\"mesh\":\"FILE\"}",
    "sweep FILE",
];

fn all_refuse(bench: &Bench, file: &str, words: &str, ways: &[&str]) {
    for way in ways {
        let started = Instant::now();
        let Outcome { code, stderr, .. } = bench.run_line(&way.replace("FILE", file));
        assert_eq!(code, Some(1), "{way}, {file}: {stderr}");
        assert!(stderr.lines().last().unwrap().contains(words), "{way}, {file}: no {words:?} in {stderr}");
        assert!(stderr.contains(file), "{way}: {stderr}");
        assert!(started.elapsed() < Duration::from_secs(30), "{way}, {file}");
        assert!(!bench.path("output").exists(), "{way}, {file}");
    }
}

#[test]
#[cfg(target_os = "linux")]
fn a_device_or_a_folder_is_no_input() {
    let bench = Bench::new("devices");
    fs::create_dir(bench.path("folder")).unwrap();
    for device in ["/dev/zero", "/dev/urandom", "/dev/null", "/dev/full"] {
        all_refuse(&bench, device, "it is a device", &WAYS);
    }
    std::os::unix::fs::symlink("/dev/zero", bench.path("link")).unwrap();
    all_refuse(&bench, "link", "it is a device", &WAYS);
    all_refuse(&bench, "folder", "Is a directory", &WAYS);
}

/// Of 8 TiB, more than any memory; of 10 GB; and just more than is allowed.
#[test]
fn a_file_too_large_for_its_kind_is_refused_with_what_is_allowed() {
    let bench = Bench::new("large");
    sparse(&bench, "vast", 8 << 40);
    all_refuse(
        &bench,
        "vast",
        "it has 8192.0 GiB, and the memory that is free is enough for a mesh file of ",
        &[WAYS[2], WAYS[5]],
    );
    sparse(&bench, "vast.msh", 8 << 40);
    all_refuse(&bench, "vast.msh", "it has 8192.0 GiB, and the memory that is free is enough", &["check FILE"]);
    sparse(&bench, "large", 10_000_000_000);
    all_refuse(&bench, "large", "it has 9.3 GiB, and a case may have 64 MiB at most", &WAYS[..2]);
    all_refuse(&bench, "large", "it has 9.3 GiB, and a table may have 256 MiB at most", &[WAYS[3]]);
    all_refuse(&bench, "large", "it has 9.3 GiB, and a script may have 64 MiB at most", &[WAYS[4]]);
    all_refuse(&bench, "large", "it has 9.3 GiB, and a plan may have 64 MiB at most", &[WAYS[6]]);
    // one byte less is read, and found to be no JSON
    sparse(&bench, "most", (64 << 20) + 1);
    all_refuse(&bench, "most", "a case may have 64 MiB at most", &WAYS[..1]);
    sparse(&bench, "most", 64 << 20);
    all_refuse(&bench, "most", "this is not JSON", &WAYS[..1]);
}

fn pipe(bench: &Bench, name: &str) {
    assert!(Command::new("mkfifo").arg(bench.path(name)).status().unwrap().success());
}

#[test]
fn a_pipe_without_a_writer_is_not_waited_for_without_end() {
    let bench = Bench::new("silent");
    pipe(&bench, "silent");
    // side by side: each waits
    std::thread::scope(|scope| {
        for (i, way) in WAYS.iter().enumerate() {
            let bench = &bench;
            scope.spawn(move || {
                let name = format!("told{i}");
                let line = way.replace("FILE", "silent");
                let mut program = bench.program(&line.split_whitespace().collect::<Vec<_>>());
                let child = program.stdout(Stdio::null()).stderr(File::create(bench.path(&name)).unwrap()).spawn();
                assert_eq!(code_of(child.unwrap()), Some(1), "{way}");
                let told = fs::read_to_string(bench.path(&name)).unwrap();
                assert!(told.contains("silent") && told.contains("nothing has come for 10 seconds"), "{way}: {told}");
            });
        }
    });
}

#[test]
fn a_pipe_that_never_ends_is_read_to_the_limit_and_one_that_ends_is_read_whole() {
    let bench = Bench::new("endless");
    pipe(&bench, "endless");
    let write = |content: &'static [u8], times: usize| {
        let path = bench.path("endless");
        std::thread::spawn(move || {
            let mut pipe = File::options().write(true).open(path).unwrap();
            // its reader has seen enough
            let _ = (0..times).try_for_each(|_| pipe.write_all(content));
        })
    };
    for (way, words) in
        [(WAYS[0], "a case through a pipe may have 64 MiB"), (WAYS[6], "a plan through a pipe may have 64 MiB")]
    {
        let writer = write(&[b' '; 4096], usize::MAX);
        all_refuse(&bench, "endless", words, &[way]);
        writer.join().unwrap();
    }
    let writer = write(CASE.as_bytes(), 1);
    let outcome = bench.run_line("run endless --out out");
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    writer.join().unwrap();
}
