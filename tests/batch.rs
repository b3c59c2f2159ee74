//! `make batch`: scripts/batch.mk and scripts/batch.py over a list of variants, with a fake gmsh.

mod program;

use program::{Bench, CASE, block_msh};
use std::fs;
use std::os::unix::fs::{PermissionsExt, symlink};
use std::os::unix::process::CommandExt;
use std::process::{Command, Stdio};
use std::time::{Duration, SystemTime};

/// Copies the mesh that a file names, which the script includes by way of another.
const GMSH: &str = r#"#!/bin/sh
for OUT; do :; done
echo "Info    : Running 'gmsh' [Gmsh 9.8.7, 1 node]"
echo "Info    : Reading '$2'..."
cp "$(cat geo/which.dat)" "$OUT"
"#;

const SCRIPT: &str = "Include \"level1.dat\";\nDefineConstant[ width = {5, Min 1}, depth = 4, half = width / 2 ];\n";

/// A folder with what `make batch` uses.
fn bench(test: &str, list: impl AsRef<[u8]>) -> Bench {
    let bench = Bench::new(test);
    for folder in ["geo", "target/release"] {
        fs::create_dir_all(bench.path(folder)).unwrap();
    }
    symlink(env!("CARGO_BIN_EXE_coralpipe"), bench.path("target/release/coralpipe")).unwrap();
    symlink(concat!(env!("CARGO_MANIFEST_DIR"), "/scripts"), bench.path("scripts")).unwrap();
    let case = CASE.replace("\"mesh\": \"block.msh\"", "\"script\": \"block.geo\"");
    bench.write("geo/block.json", &case);
    bench.write("geo/block.geo", SCRIPT);
    bench.write("geo/level1.dat", "Include \"which.dat\";\n");
    bench.write("geo/which.dat", "block.msh");
    bench.write("geo/batch.txt", list);
    bench.write("gmsh", GMSH);
    fs::set_permissions(bench.path("gmsh"), PermissionsExt::from_mode(0o755)).unwrap();
    bench
}

/// As the Makefile's target does it, once the program is built.
fn batch(bench: &Bench) -> Command {
    let mut command = Command::new("sh");
    command.arg("-c").arg(
        "make -j2 --no-print-directory --keep-going --file scripts/batch.mk; made=$?; \
         python3 scripts/batch.py table geo/batch.txt output/batch.csv && exit $made",
    );
    command.current_dir(&bench.folder).env("CORALPIPE_GMSH", bench.path("gmsh")).stdin(Stdio::null());
    command.env_remove("MAKEFLAGS").env_remove("MAKELEVEL");
    command
}

/// Exit code, and all that was printed.
fn made(bench: &Bench) -> (Option<i32>, String) {
    let output = batch(bench).output().unwrap();
    let text = [output.stdout, output.stderr].concat();
    (output.status.code(), String::from_utf8_lossy(&text).into_owned())
}

/// The table as rows of (column, cell).
fn table(bench: &Bench) -> Vec<Vec<(String, String)>> {
    let text = fs::read_to_string(bench.path("output/batch.csv")).unwrap();
    let mut lines = text.lines().map(|line| line.split(',').map(String::from).collect::<Vec<_>>());
    let columns = lines.next().unwrap();
    lines.map(|cells| columns.iter().cloned().zip(cells).collect()).collect()
}

fn column(bench: &Bench, name: &str) -> Vec<String> {
    let cell = |row: &Vec<(String, String)>| row.iter().find(|(c, _)| c == name).map(|(_, v)| v.clone());
    table(bench).iter().map(|row| cell(row).unwrap_or_else(|| panic!("no {name} in {row:?}"))).collect()
}

fn written(bench: &Bench, variant: &str) -> SystemTime {
    fs::metadata(bench.path(format!("output/batch/{variant}/summary.json"))).unwrap().modified().unwrap()
}

#[test]
fn odd_lines_and_unreadable_bytes_stop_themselves_alone_and_are_reported() {
    let list: [&[u8]; 19] = [
        b"\xef\xbb\xbf# gr\xfc\xdfe in Latin-1",
        b"block\twidth=4\r",
        b"block width=3 # gr\xfc\xdfe",
        b"  block width=0.25e1 depth=+4",
        b"block depth=4.0 width=2.5 # as line 4",
        b"",
        b"o$d%:;\\|(x)~'\"*.case",
        b"block width;=1",
        b"block $(shell touch made)=1",
        b"block width=1:2",
        b"block width=1e999",
        b"block width=1_0",
        b"block width",
        b"width=1",
        b"bl\xf6ck width=3",
        b"../block",
        b"block width=1 width=2",
        b"block_width 3=",
        b"block\0x width=1",
    ];
    let bench = bench("batch-lines", list.join(&b'\n'));
    fs::copy(bench.path("geo/block.json"), bench.path("geo/o$d%:;\\|(x)~'\"*.case.json")).unwrap();
    // the only variant of its case, called as line 2 is
    bench.write("geo/batch.txt", [list.join(&b'\n'), b"\nblock_width4\n".to_vec()].concat());
    fs::copy(bench.path("geo/block.json"), bench.path("geo/block_width4.json")).unwrap();
    let (code, text) = made(&bench);
    assert!(code != Some(0) && code.is_some(), "{text}");
    for number in 8..=20 {
        assert!(text.contains(&format!("geo/batch.txt, line {number}: ")), "line {number}: {text}");
    }
    for number in [1, 2, 3, 4, 6, 7] {
        assert!(!text.contains(&format!("line {number}: ")), "line {number}: {text}");
    }
    for words in [
        "line 5: the same as line 4",
        "line 8: 'width;' is no name of a constant",
        "line 10: '1:2' is no number",
        "line 15: byte 0xf6 is not UTF-8",
        "line 17: width is given twice",
        "line 20: its results would be called 'block_width4', as those of line 2",
        "4 of 4 variants are in output/batch.csv",
    ] {
        assert!(text.contains(words), "{words}: {text}");
    }
    assert!(!text.contains("Traceback") && !text.contains("missing separator"), "{text}");
    assert!(!bench.path("made").exists(), "no line is run by a shell");
    let variants = column(&bench, "variant");
    assert_eq!(variants[..3], ["block_width4", "block_width3", "block_depth4_width2.5"]);
    assert!(column(&bench, "status").iter().all(|status| status == "done"), "{:?}", table(&bench));

    // with good lines only, all is done and nothing is done again
    bench.write("geo/batch.txt", list[1..5].join(&b'\n'));
    let before = written(&bench, "block_width4");
    let (code, text) = made(&bench);
    assert_eq!(code, Some(0), "{text}");
    assert_eq!(written(&bench, "block_width4"), before);
}

#[test]
fn a_list_without_variants_is_refused_in_a_sentence() {
    let bench = bench("batch-empty", "# nothing\n");
    for (list, words) in
        [("# nothing\n", "lists no variant; write lines such as"), ("nothing=1\n", "line 1: begin with the case")]
    {
        bench.write("geo/batch.txt", list);
        let (code, text) = made(&bench);
        assert!(code != Some(0) && text.contains(words) && !text.contains("Traceback"), "{text}");
    }
    fs::remove_file(bench.path("geo/batch.txt")).unwrap();
    let (code, text) = made(&bench);
    assert!(code != Some(0) && text.contains("geo/batch.txt cannot be read") && !text.contains("Traceback"), "{text}");
}

/// The values of lines that give none are those of the script; a column of largest and one of least values.
#[test]
fn the_table_has_all_inputs_first_with_defaults_then_largest_and_least_values() {
    let bench = bench("batch-table", "block width=2\nblock depth=3\nblock width=0\nblock\n");
    let (code, text) = made(&bench);
    assert!(code != Some(0) && text.contains("3 of 4 variants"), "{text}");
    let names: Vec<String> = table(&bench)[0].iter().map(|(column, _)| column.clone()).collect();
    assert_eq!(names[..8], ["variant", "case", "width", "depth", "f1", "f2", "max_open", "max_slip"]);
    assert_eq!(names[8..12], ["P.ux.max", "P.ux.min", "P.uy.max", "P.uy.min"]);
    assert_eq!(names[names.len() - 3..], ["status", "warnings", "reason"]);
    assert_eq!(column(&bench, "width"), ["2.0", "5.0", "0.0", "5.0"]);
    // the third one has no mesh, and so no record of its constants
    assert_eq!(column(&bench, "depth"), ["4.0", "3.0", "", "4.0"]);
    assert_eq!(column(&bench, "status"), ["done", "done", "not run", "done"]);
    assert!(column(&bench, "reason")[2].contains("width = 0 is out of bounds"), "{:?}", column(&bench, "reason"));
    let numbers = |name: &str| column(&bench, name).iter().map(|v| v.parse().unwrap_or(f64::NAN)).collect::<Vec<f64>>();
    let (max, min) = (numbers("Q.uy.max"), numbers("Q.uy.min"));
    for i in [0, 1, 3] {
        assert!(max[i] >= 0. && min[i] < 0., "pressed down and from rest: {max:?} {min:?}");
    }
}

/// A result is that of the mesh which an included file's included file gives now, and of the values of the case now.
#[test]
fn what_an_included_file_or_the_case_changes_is_run_again_and_nothing_else() {
    let bench = bench("batch-stale", "block width=2\nblock\n");
    assert_eq!(made(&bench).0, Some(0));
    let before = [written(&bench, "block_width2"), written(&bench, "block")];
    bench.write("other.msh", block_msh().replace("6 3 5 0\n", "6 3 5.5 0\n").replace("36 5 5 0\n", "36 5 6 0\n"));
    bench.write("geo/which.dat", "other.msh");
    let (code, text) = made(&bench);
    assert_eq!(code, Some(0), "{text}");
    let log = fs::read_to_string(bench.path("output/batch/block/batch.log")).unwrap();
    assert!(log.contains("(which.dat has changed)"), "{log}");
    let after = [written(&bench, "block_width2"), written(&bench, "block")];
    assert!(after[0] > before[0] && after[1] > before[1]);
    // as by hand: the same results, though the file is newer
    let case = fs::read(bench.path("geo/block.json")).unwrap();
    bench.write("geo/block.json", &case);
    assert_eq!(made(&bench).0, Some(0));
    assert_eq!([written(&bench, "block_width2"), written(&bench, "block")], after);
    bench.write("geo/block.json", String::from_utf8(case).unwrap().replace("100 kPa", "90 kPa"));
    assert_eq!(made(&bench).0, Some(0));
    assert!(written(&bench, "block") > after[1]);
}

/// SIGKILL of make and all that it started, 10 times from its start to its end; and rules of earlier versions that such a
/// kill had cut off.
#[test]
fn killed_at_any_moment_the_next_batch_has_the_whole_table() {
    let bench = bench("batch-killed", "block width=2\nblock width=3\nblock\n");
    let kills = 10;
    let start = std::time::Instant::now();
    assert_eq!(made(&bench).0, Some(0));
    let whole = start.elapsed();
    for kill in 0..kills {
        fs::remove_dir_all(bench.path("output")).unwrap();
        fs::remove_dir_all(bench.path("meshes")).unwrap();
        fs::create_dir(bench.path("output")).unwrap();
        bench.write("output/batch.mk", "");
        let mut child = batch(&bench).stdout(Stdio::null()).stderr(Stdio::null()).process_group(0).spawn().unwrap();
        std::thread::sleep(whole * kill / kills + Duration::from_millis(u64::from(kill)));
        let _ = Command::new("kill").args(["-KILL", "--", &format!("-{}", child.id())]).stderr(Stdio::null()).status();
        child.wait().unwrap();
        let (code, text) = made(&bench);
        assert_eq!(code, Some(0), "kill {kill}: {text}");
        assert_eq!(column(&bench, "status"), ["done", "done", "done"], "kill {kill}: {text}");
        let left = fs::read_dir(bench.path("meshes")).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap());
        let left: Vec<String> = left.filter(|name| name.starts_with('.')).collect();
        assert!(left.is_empty(), "kill {kill}: {left:?} are left in meshes");
    }
}
