//! What is on disk is valid at any moment: while a run goes on, fails, is interrupted or killed; and the results of an
//! earlier run that was done are lost only to another run that is done.

mod frames;
mod program;

use program::{Bench, CASE, Outcome, code_of, failing_run};
use std::fs;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// A series that opens: its times ascend and every frame it names can be read. The number of frames.
fn frames_of_valid_series(folder: &Path, name: &str) -> usize {
    let index = folder.join(format!("{name}.pvd"));
    let text = fs::read_to_string(&index).unwrap_or_else(|e| panic!("{}: {e}", index.display()));
    assert!(text.starts_with("<?xml") && text.ends_with("</Collection>\n</VTKFile>\n"), "{text}");
    let attribute = |line: &str, name: &str| -> String {
        let behind = line.split_once(&format!("{name}=\"")).unwrap_or_else(|| panic!("no {name} in {line}")).1;
        behind.split_once('"').unwrap().0.into()
    };
    let sets: Vec<&str> = text.lines().filter(|l| l.contains("<DataSet")).collect();
    let times: Vec<f64> = sets.iter().map(|l| attribute(l, "timestep").parse().unwrap()).collect();
    assert!(times.is_sorted_by(|a, b| a < b), "{times:?}");
    for line in &sets {
        let path = folder.join(attribute(line, "file"));
        let told = |why| panic!("{}: {why}", path.display());
        let piece =
            fs::read(&path).map_err(|e| e.to_string()).and_then(|file| frames::piece(&file)).unwrap_or_else(told);
        // 36 nodes and the 4 copies of the body; 25 squares and 4 joints
        assert_eq!((piece.points.len(), piece.cells.num_cells()), (3 * 40, 29), "{}", path.display());
    }
    sets.len()
}

/// Linux copies a write into its pages one by one and looks for SIGKILL between them.
const PAGE: usize = 4096;

/// Only whole lines, of as many numbers as the header has names. Their number.
fn rows_of_valid_histories(path: &Path) -> usize {
    let text = fs::read_to_string(path).unwrap();
    if text.is_empty() {
        return 0;
    }
    assert!(text.ends_with('\n') || text.len().is_multiple_of(PAGE), "torn after {} bytes: {text}", text.len());
    let whole = &text[..=text.rfind('\n').unwrap()];
    let header = whole.lines().next().unwrap();
    assert!(header.starts_with("t,P.ux,P.uy,"), "{header}");
    let rows: Vec<Vec<f64>> =
        whole.lines().skip(1).map(|l| l.split(',').map(|x| x.parse().unwrap()).collect()).collect();
    assert!(rows.iter().all(|row| row.len() == header.split(',').count() && row.iter().all(|x| x.is_finite())));
    assert!(rows.is_sorted_by(|a, b| a[0] < b[0]));
    rows.len()
}

fn summary(folder: &Path) -> Option<serde_json::Value> {
    let text = fs::read(folder.join("summary.json")).ok()?;
    Some(serde_json::from_slice(&text).expect("a summary is whole or not there"))
}

fn is_done(folder: &Path) -> bool {
    summary(folder).is_some_and(|s| s["status"] == "done")
}

/// A finished run whose files are all there.
fn assert_done(folder: &Path, frames: usize, steps: usize) {
    assert!(is_done(folder), "{}", folder.display());
    assert_eq!(frames_of_valid_series(folder, "block"), frames);
    assert_eq!(rows_of_valid_histories(&folder.join("histories.csv")), steps + 1);
    assert_eq!(fs::read_to_string(folder.join("run.sta")).unwrap().lines().count(), steps + 1);
}

#[test]
fn without_convergence_the_joints_are_named_and_what_was_computed_stands() {
    let bench = Bench::new("convergence");
    let Outcome { code, stdout, stderr } = failing_run(&bench);
    assert_eq!((code, stdout.as_str()), (Some(3), ""), "{stderr}");
    let sentence = stderr.lines().last().unwrap();
    for words in ["no convergence in step ", " after t = 0.02", "interface at (", "is in output/block"] {
        assert!(sentence.contains(words), "{words}: {sentence}");
    }
    assert!(!sentence.contains("previous"), "{sentence}");
    let time = sentence.split_once("after t = ").unwrap().1.split(' ').next().unwrap();
    assert!(time.len() <= "0.025".len(), "round-off is not told: {time}");
    // the corners of the body, each once
    let corners = [[2, 2], [2, 3], [3, 2], [3, 3]].map(|[x, y]| format!("interface at ({x}.0000, {y}.0000) m"));
    let named: usize = corners.iter().map(|c| sentence.matches(c.as_str()).count()).sum();
    assert!(corners.iter().all(|c| sentence.matches(c.as_str()).count() <= 1), "{sentence}");
    assert_eq!(named, sentence.matches("interface at").count(), "{sentence}");

    let folder = bench.path("output/block");
    assert_eq!(summary(&folder).unwrap()["status"], "no_convergence");
    // a frame and a row for t = 0 and for each step before the one that failed
    let step: usize = sentence.split_once("in step ").unwrap().1.split(' ').next().unwrap().parse().unwrap();
    assert!(step >= 5, "nothing moves in the first four: {sentence}");
    assert_eq!(frames_of_valid_series(&folder, "block"), step);
    assert_eq!(rows_of_valid_histories(&folder.join("histories.csv")), step);
}

/// A pressure near the largest number there is, on a ground of next to no mass: a = p/m is beyond it.
#[test]
fn numbers_beyond_floating_point_end_the_run_and_are_not_written() {
    let bench = Bench::new("overflow");
    let blow = "run block.json --set materials.ground.density=0.001 --set loads.top.pressure.peak=1.7e308 --set \
                time.step=1e-6 --set time.end=1e-5 --set output.every=1e-6";
    let at_once = bench.run_line(blow);
    assert_eq!(at_once.code, Some(1), "{}", at_once.stderr);
    assert!(at_once.stderr.contains("t = 0") && at_once.stderr.contains("too large"), "{}", at_once.stderr);
    assert!(!bench.path("output").exists());
    for more in ["", "--bonded"] {
        let in_a_step = bench.run_line(&format!("{blow} --set time.start=rest {more}"));
        assert_eq!(in_a_step.code, Some(3), "{more}: {}", in_a_step.stderr);
        assert!(in_a_step.stderr.contains("too large for a computer, first at "), "{more}: {}", in_a_step.stderr);
        assert!(in_a_step.stderr.contains("check loads"), "{more}: {}", in_a_step.stderr);
        assert_eq!(rows_of_valid_histories(&bench.path("output/block/histories.csv")), 1);
    }
    let too_exact =
        bench.run_line("run block.json --set newton.tolerance=1e-300 --set interfaces.interface.thickness=1e-9");
    assert_eq!(too_exact.code, Some(3), "{}", too_exact.stderr);
    assert!(too_exact.stderr.contains("newton.tolerance = 1e-300"), "{}", too_exact.stderr);
    assert!(too_exact.stderr.contains("take a larger newton.tolerance"), "{}", too_exact.stderr);
}

/// The folder is locked by the system, so that a killed run leaves no lock behind.
#[test]
fn two_runs_never_write_into_one_folder() {
    let bench = Bench::new("two");
    let endless = ["run", "block.json", "--quiet", "--large", "--set", "time.end=1000 s", "--set", "output.every=1 s"];
    let mut first = bench.program(&endless).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
    let started = Instant::now();
    while !bench.path("output/block/run.sta").exists() && started.elapsed() < Duration::from_secs(30) {
        std::thread::sleep(Duration::from_millis(5));
    }
    let second = bench.run_line("run block.json");
    first.kill().unwrap();
    first.wait().unwrap();
    assert_eq!(second.code, Some(1), "{}", second.stderr);
    assert!(second.stderr.contains("another run is writing into output/block"), "{}", second.stderr);
    assert_eq!(bench.run_line("run block.json").code, Some(0));
    assert_done(&bench.path("output/block"), 11, 20);
}

#[test]
fn finished_results_survive_runs_that_fail_and_end_with_one_that_is_done() {
    let bench = Bench::new("earlier");
    let folder = bench.path("output/block");
    let previous = folder.join("previous");
    assert_eq!(bench.run_line("run block.json --quiet").code, Some(0));
    assert_done(&folder, 11, 20);

    // refused before anything is touched
    for bad in ["time.step=0", "supports.foot=[\"x\"]", "materials.body.density=-1"] {
        assert_eq!(bench.run_line(&format!("run block.json --set {bad}")).code, Some(1), "{bad}");
        assert_done(&folder, 11, 20);
        assert!(!previous.exists());
    }
    // failed again and again while it ran
    for _ in 0..3 {
        let outcome = failing_run(&bench);
        assert_eq!(outcome.code, Some(3), "{}", outcome.stderr);
        assert!(outcome.stderr.contains("output/block/previous"), "{}", outcome.stderr);
        assert_done(&previous, 11, 20);
        assert!(frames_of_valid_series(&folder, "block") >= 5);
    }
    assert_eq!(bench.run_line("run block.json --set time.end=5ms").code, Some(0));
    assert_done(&folder, 6, 10);
    assert!(!previous.exists() && !folder.join("previous.part").exists());
}

/// A kill while results move to `previous/` leaves some here and some there; the next run brings them together.
#[test]
fn results_killed_on_their_way_to_previous_are_picked_up() {
    let bench = Bench::new("moving");
    let folder = bench.path("output/block");
    let entries = ["block.pvd", "summary.json", "frames", "histories.csv", "run.sta"];
    for moved in 0..=entries.len() {
        assert_eq!(bench.run_line("run block.json --quiet").code, Some(0));
        let moving = folder.join("previous.part");
        fs::create_dir(&moving).unwrap();
        for entry in &entries[..moved] {
            fs::rename(folder.join(entry), moving.join(entry)).unwrap();
        }
        assert_eq!(failing_run(&bench).code, Some(3));
        assert_done(&folder.join("previous"), 11, 20);
        assert!(!moving.exists());
    }
}

#[test]
fn what_a_run_did_not_write_is_not_its_to_clear() {
    let bench = Bench::new("foreign");
    for file in ["strange/frames/photo.png", "strange/summary.json"] {
        fs::create_dir_all(bench.path(file).parent().unwrap()).unwrap();
        bench.write(file, "\"mine\"");
    }
    assert_eq!(bench.run_line("run block.json --out strange").code, Some(1));
    for file in ["strange/frames/photo.png", "strange/summary.json"] {
        assert_eq!(fs::read_to_string(bench.path(file)).unwrap(), "\"mine\"", "{file}");
    }
    // notes beside results
    assert_eq!(bench.run_line("run block.json --out own").code, Some(0));
    bench.write("own/summary.json.bak", "mine");
    bench.write("own/notes", "mine");
    assert_eq!(bench.run_line("run block.json --out own").code, Some(0));
    for file in ["own/summary.json.bak", "own/notes"] {
        assert_eq!(fs::read_to_string(bench.path(file)).unwrap(), "mine", "{file}");
    }
    // another case in the same folder leaves no series without frames
    bench.write("other.json", CASE);
    assert_eq!(bench.run_line("run other.json --out own").code, Some(0));
    assert!(!bench.path("own/block.pvd").exists());
    assert_eq!(frames_of_valid_series(&bench.path("own"), "other"), 11);
}

/// Steps without end, many of them written: there is always something to be torn.
const LONG: [&str; 4] = ["time.end=1000 s", "output.every=1 ms", "time.step=0.1 ms", "probes=[\"P\",\"Q\"]"];

fn started(bench: &Bench, sets: &[&str]) -> Child {
    let sets = sets.iter().flat_map(|set| ["--set", set]);
    let arguments: Vec<&str> = ["run", "block.json", "--quiet", "--large"].into_iter().chain(sets).collect();
    bench.program(&arguments).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap()
}

#[test]
fn killed_at_any_moment_the_series_opens_and_the_finished_results_are_there() {
    let bench = Bench::new("kill");
    let folder = bench.path("output/block");
    assert_eq!(bench.run_line("run block.json --quiet").code, Some(0));
    let start = Instant::now();
    let mut whole = started(&bench, &LONG);
    while !folder.join("histories.csv").metadata().is_ok_and(|m| m.len() > 100_000) {
        assert!(start.elapsed() < Duration::from_secs(30) && whole.try_wait().unwrap().is_none());
    }
    let most = start.elapsed();
    whole.kill().unwrap();
    whole.wait().unwrap();

    // golden ratio: moments spread evenly over the time, none twice; as many again in its first fifth, where files move
    let moments = (0..60).map(|i| (f64::from(i) * 0.618_034).fract() * if i % 2 == 0 { 1.0 } else { 0.2 });
    let mut with_frames = 0;
    for moment in moments {
        let mut child = started(&bench, &LONG);
        std::thread::sleep(most.mul_f64(moment));
        child.kill().unwrap();
        child.wait().unwrap();

        let [previous, moving] = ["previous", "previous.part"].map(|name| folder.join(name));
        if is_done(&folder) && !moving.exists() {
            assert_done(&folder, 11, 20);
        } else if !moving.exists() {
            assert_done(&previous, 11, 20);
        }
        if folder.join("block.pvd").exists() {
            with_frames += usize::from(frames_of_valid_series(&folder, "block") > 1);
        }
        if folder.join("histories.csv").exists() {
            rows_of_valid_histories(&folder.join("histories.csv"));
        }
    }
    assert!(with_frames >= 5, "only {with_frames} kills met a run that had written");
    assert_eq!(bench.run_line("run block.json --quiet --set time.end=5ms").code, Some(0));
    assert_done(&folder, 6, 10);
}

fn interrupt(child: &Child) {
    let sent = Command::new("sh").args(["-c", &format!("kill -INT {}", child.id())]).status().unwrap();
    assert!(sent.success());
}

#[test]
fn interrupted_a_run_ends_with_130_and_valid_files() {
    let bench = Bench::new("interrupt");
    let folder = bench.path("output/block");
    assert_eq!(bench.run_line("run block.json --quiet").code, Some(0));
    let stderr = bench.path("stderr");
    let mut program = bench.program(&[
        "run",
        "block.json",
        "--large",
        "--set",
        "time.end=1000 s",
        "--set",
        "output.every=50 ms",
        "--quiet",
    ]);
    let child = program.stdout(Stdio::null()).stderr(fs::File::create(&stderr).unwrap()).spawn().unwrap();
    let start = Instant::now();
    // the results of the run before, 11 frames, have gone, and new ones come
    while !folder.join("previous").exists() || !folder.join("frames/block_00012.vtu").exists() {
        assert!(start.elapsed() < Duration::from_secs(30));
        std::thread::sleep(Duration::from_millis(1));
    }
    interrupt(&child);
    assert_eq!(code_of(child), Some(130));
    let told = fs::read_to_string(stderr).unwrap();
    for words in ["interrupted at t = ", "of 2000000", "is in output/block", "output/block/previous"] {
        assert!(told.contains(words), "{words}: {told}");
    }
    let written = summary(&folder).unwrap();
    assert_eq!(written["status"], "interrupted");
    assert!(frames_of_valid_series(&folder, "block") >= 3);
    assert_eq!(written["frames"], frames_of_valid_series(&folder, "block"));
    let steps = written["steps"].as_u64().unwrap() as usize;
    assert_eq!(rows_of_valid_histories(&folder.join("histories.csv")), steps + 1);
    assert_done(&folder.join("previous"), 11, 20);
}

/// Nothing is written then, so there is nothing to wait for.
#[test]
fn interrupted_while_gmsh_works_the_program_ends_at_once() {
    let bench = Bench::new("gmsh");
    bench.write("script.json", CASE.replace("\"mesh\": \"block.msh\"", "\"script\": \"block.geo\""));
    bench.write("block.geo", "// nothing\n");
    bench.write("slow_gmsh", "#!/bin/sh\necho > started\nexec /bin/sleep 20\n");
    let slow = bench.path("slow_gmsh");
    fs::set_permissions(&slow, std::os::unix::fs::PermissionsExt::from_mode(0o755)).unwrap();
    let mut program = bench.program(&["run", "script.json"]);
    program.env("CORALPIPE_GMSH", &slow).stdout(Stdio::null()).stderr(Stdio::null());
    let child = program.spawn().unwrap();
    let start = Instant::now();
    while !bench.path("started").exists() {
        assert!(start.elapsed() < Duration::from_secs(30));
        std::thread::sleep(Duration::from_millis(1));
    }
    let sent = Instant::now();
    interrupt(&child);
    assert_eq!(code_of(child), Some(130));
    assert!(sent.elapsed() < Duration::from_secs(10));
    assert!(!bench.path("output").exists());
}

/// A disk that fills up: the run stops with the reason, and what stands is valid.
#[test]
#[cfg(target_os = "linux")]
fn on_a_full_disk_the_run_stops_and_finished_results_survive() {
    let bench = Bench::new("disk");
    fs::create_dir(bench.path("output")).unwrap();
    let mount = ["-t", "tmpfs", "-o", "size=300k", "coralpipe-test"];
    let target = bench.path("output");
    let mounted = Command::new("mount").args(mount).arg(&target).stderr(Stdio::null()).status();
    if !mounted.is_ok_and(|status| status.success()) {
        eprintln!("not tried: only root can mount a small disk");
        return;
    }
    let first = bench.run_line("run block.json --quiet");
    let second = bench.run_line("run block.json --large --set time.end=500ms");
    let refused = bench.run_line("run block.json --set time.end=500ms");
    let folder = bench.path("output/block");
    let checked = std::panic::catch_unwind(|| {
        assert_eq!((first.code, second.code), (Some(0), Some(1)), "{}", second.stderr);
        for words in ["No space left", "--out", "output/block/previous"] {
            assert!(second.stderr.contains(words), "{words}: {}", second.stderr);
        }
        assert_done(&folder.join("previous"), 11, 20);
        frames_of_valid_series(&folder, "block");
        // without --large it would not have begun
        for words in ["write about 7.9 MB into output/block, where ", "more than is free on that disk", "--large"] {
            assert!(refused.code == Some(1) && refused.stderr.contains(words), "{words}: {}", refused.stderr);
        }
    });
    assert!(Command::new("umount").arg(&target).status().unwrap().success());
    checked.unwrap_or_else(|e| std::panic::resume_unwind(e));
}

/// A later run of a mesh takes the elimination order that an earlier one has left beside it; where there is none, or
/// something else, it finds the order again.
#[test]
fn what_stands_in_the_place_of_an_elimination_order_changes_no_digit() {
    let bench = Bench::new("orders");
    let orders = bench.path("block.orders");
    let told = |told: bool| {
        let outcome = bench.run_line("run block.json --out out");
        assert_eq!((outcome.code, outcome.stderr.contains("block.orders")), (Some(0), told), "{}", outcome.stderr);
        fs::read(bench.path("out/histories.csv")).unwrap()
    };
    let run = || told(false);
    let first = run();
    let kept = fs::read(&orders).unwrap();
    assert!(run() == first && fs::read(&orders).unwrap() == kept);

    // Bonded it is another graph, whose order takes its place beside the first one.
    assert_eq!(bench.run_line("run block.json --bonded --out bonded").code, Some(0));
    let both = fs::read(&orders).unwrap();
    assert!(both.len() > kept.len() && run() == first && fs::read(&orders).unwrap() == both);

    fs::write(&orders, &both[..both.len() / 2]).unwrap();
    assert!(run() == first && fs::read(&orders).unwrap() == kept, "cut off: found and written again");
    fs::write(&orders, "something of the user's own").unwrap();
    assert!(told(true) == first && fs::read(&orders).unwrap() == b"something of the user's own");
    fs::remove_file(&orders).unwrap();
    fs::create_dir(&orders).unwrap();
    assert!(told(true) == first && orders.is_dir(), "it could not be written");
    let left = fs::read_dir(&bench.folder).unwrap().flatten().map(|f| f.file_name().into_string().unwrap());
    assert_eq!(left.filter(|name| name.ends_with(".part")).count(), 0, "nothing is left of what was not written");
}

/// Through a pipe a mesh can be read only once: the hash in the summary is that of what was parsed.
#[test]
fn a_mesh_is_read_once_and_the_hash_of_what_was_read_is_told() {
    use sha2::Digest;
    let bench = Bench::new("pipe");
    let pipe = bench.path("pipe.msh");
    assert!(Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    let mesh = program::block_msh();
    let written = std::thread::spawn({
        let (pipe, mesh) = (pipe.clone(), mesh.clone());
        move || fs::write(pipe, mesh).unwrap()
    });
    let outcome = bench.run_line("run block.json --mesh pipe.msh");
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    written.join().unwrap();
    let hash: String = sha2::Sha256::digest(mesh).iter().map(|b| format!("{b:02x}")).collect();
    assert_eq!(summary(&bench.path("output/block")).unwrap()["inputs"]["mesh_sha256"], hash.as_str());
}

/// From 24 MB, too few to assemble the default case, to 64 MB, nearly enough: before the factor its size is told, else
/// what could not be had.
#[test]
#[cfg(target_os = "linux")]
fn without_memory_a_run_ends_with_a_sentence() {
    let bench = Bench::new("memory");
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    fs::copy(root.join("meshes/twin_pipes.msh"), bench.path("pipes.msh")).unwrap();
    let case = root.join("geo/twin_pipes.json");
    let sentence = |kilobytes: usize| {
        let mut shell = Command::new("sh");
        shell.args(["-c", &format!("ulimit -v {kilobytes} && exec \"$@\""), "sh", env!("CARGO_BIN_EXE_coralpipe")]);
        shell.arg("run").arg(&case).args(["--mesh", "pipes.msh", "--quiet", "--set", "time.end=1ms"]);
        let ended = shell.current_dir(&bench.folder).output().unwrap();
        let stderr = String::from_utf8_lossy(&ended.stderr).into_owned();
        let refused = ended.status.code() == Some(1) && stderr.lines().any(|line| line.starts_with("coralpipe: "));
        // the C library ends by itself where it finds no memory for a new thread
        assert!(
            refused || ended.status.success() || stderr.contains("glibc"),
            "{kilobytes}: {} {stderr}",
            ended.status
        );
        stderr
    };
    let sentences: Vec<String> = (24_000..=64_000).step_by(8_000).map(sentence).collect();
    for words in ["the factor of 10068 unknowns needs about ", "there is no memory for another "] {
        assert!(sentences.iter().any(|s| s.contains(words) && s.contains("ulimit -v")), "{words}: {sentences:?}");
    }
}
