//! The command line: what goes in wrong comes out as one sentence and the right exit code (README, "Exit codes").

mod program;

use program::{Bench, CASE, Outcome, block_msh, code_of};
use std::os::unix::ffi::OsStrExt;

/// What is done, how the program is called (words between blanks), and what its sentence must contain.
type Row = (&'static str, &'static str, &'static [&'static str]);

fn refused(what: &str, outcome: &Outcome, words: &[&str]) {
    let Outcome { code, stdout, stderr } = outcome;
    assert_eq!(*code, Some(1), "{what}: exit code of: {stderr}");
    assert_eq!(stdout, "", "{what}: stdout is for results");
    let sentence = stderr.lines().last().unwrap_or_default();
    assert!(sentence.starts_with("coralpipe: "), "{what}: {stderr}");
    assert!(!stderr.contains("panicked"), "{what}: {stderr}");
    for word in words {
        assert!(sentence.contains(word), "{what}: no {word:?} in: {sentence}");
    }
}

/// `run`, `check` and `modes` must refuse alike, and `run` must leave nothing behind.
fn all_refuse(bench: &Bench, rows: &[Row]) {
    for (what, arguments, words) in rows {
        for command in ["run", "check", "modes"] {
            refused(&format!("{command}, {what}"), &bench.run_line(&format!("{command} {arguments}")), words);
        }
        assert!(!bench.path("output").exists(), "{what}: a refused run must not write");
    }
}

#[test]
fn a_bad_case_file_is_refused_with_its_place() {
    let bench = Bench::new("case");
    bench.write("broken.json", "{ \"materials\":\n { \"ground\" ");
    bench.write("empty.json", "");
    bench.write("binary.json", b"\xff\xfe\x00{}");
    bench.write("number.json", "7");
    bench.write("nan.json", CASE.replace("0.3,", "NaN,"));
    all_refuse(
        &bench,
        &[
            ("missing file", "nowhere.json", &["nowhere.json", "No such file", "block.json"]),
            ("missing folder", "no/where.json", &["no/where.json", "No such file"]),
            ("folder for a file", ".", &["Is a directory"]),
            ("broken JSON", "broken.json", &["broken.json", "line 2", "not JSON"]),
            ("empty file", "empty.json", &["empty.json", "not JSON"]),
            ("not text", "binary.json", &["binary.json", "UTF-8"]),
            ("not an object", "number.json", &["number.json", "7", "an object"]),
            ("NaN", "nan.json", &["nan.json", "line 3", "not JSON"]),
            ("NaN with a unit", "block.json --set time.end=NaN", &["time.end", "NaN", "finite"]),
            ("infinite", "block.json --set time.end=1e999", &["time.end", "finite"]),
            ("unknown key", "block.json --set matrials=1", &["matrials", "did you mean \"materials\"", "supports"]),
            ("unknown key below", "block.json --set time.stop=1", &["time", "\"stop\"", "\"step\"", "end"]),
            ("wrong unit", "block.json --set materials.body.young=3kg", &["materials.body.young", "3kg", "GPa"]),
            ("negative density", "block.json --set materials.body.density=-1", &["materials.body.density", "-1", "0"]),
            ("nu = 0.5", "block.json --set materials.body.poisson=0.5", &["materials.body.poisson", "less than 0.5"]),
            ("nu = -1", "block.json --set materials.body.poisson=-1", &["materials.body.poisson", "greater than -1"]),
            (
                "one key twice",
                "block.json --set time.step=1ms --set time.step=2ms",
                &["--set gives time.step twice", "leave it out"],
            ),
            ("one constant twice", "block.json --geo a=1 --geo a=2", &["--geo gives a twice"]),
            ("a key's value that is no JSON", "block.json --set damping={ratio:0.1}", &["no JSON, at character 2"]),
            ("zero time step", "block.json --set time.step=0", &["time.step", "greater than 0"]),
            ("negative time step", "block.json --set time.step=-1ms", &["time.step", "greater than 0"]),
            ("end before the first step", "block.json --set time.end=0.1ms", &["time.end", "at least one step"]),
            ("too many steps", "block.json --set time.step=1e-12", &["time.end", "time.step", "1e10 steps", "1e9"]),
            ("steps beyond numbers", "block.json --set time.step=5e-324", &["time.end", "time.step"]),
            ("frames between steps", "block.json --set output.every=0.1ms", &["output.every", "time step"]),
            ("no iterations", "block.json --set newton.max_iterations=0", &["newton.max_iterations", "at least 1"]),
            ("zero thickness", "block.json --set interfaces.interface.thickness=0", &["thickness", "greater than 0"]),
            ("axis z", "block.json --set supports.base=[\"z\"]", &["supports.base[0]", "\"z\"", "x, y"]),
            ("two probes of one name", "block.json --set probes=[\"P\",\"P\"]", &["probes[1]", "\"P\"", "already"]),
            ("a probe without a name", "block.json --set probes=[\"\"]", &["probes[0]", "column"]),
            (
                "hht and newmark",
                "block.json --set time.hht=-0.1 --set time.newmark={}",
                &["time.hht", "leave time.newmark out"],
            ),
            ("a script for a case", "block.geo", &["block.geo is a geometry", "\"script\"", "case"]),
            (
                "a material that the case has not",
                "block.json --set materials.gruond.young=1",
                &["materials.gruond", "did you mean \"ground\"?", "ground, body"],
            ),
            ("no geometry", "block.json --set geometry=null", &["block.json", "\"geometry\"", "--mesh"]),
            ("empty geometry", "block.json --set geometry={}", &["geometry", "\"script\"", "\"mesh\""]),
        ],
    );
}

#[test]
fn a_bad_mesh_is_refused_with_its_place() {
    let bench = Bench::new("mesh");
    let mesh = block_msh();
    bench.write("empty.msh", "");
    bench.write("solid.stl", "solid cube\nfacet normal 0 0 1\n");
    bench.write("plate.geo", "Point(1) = {0, 0, 0, 0.1};\nLine(1) = {1, 2};\n");
    bench.write("cut.msh", &mesh[..mesh.len() - 400]);
    bench.write("cut_nodes.msh", &mesh[..400]);
    bench.write("no_faces.msh", mesh.lines().take_while(|l| *l != "$Elements").collect::<Vec<_>>().join("\n"));
    bench.write("bent.msh", mesh.replace("\n8 1 1 0\n", "\n8 1 1 0.5\n"));
    bench.write("nan.msh", mesh.replace("\n8 1 1 0\n", "\n8 nan 1 0\n"));
    bench.write("folded.msh", mesh.replace("\n8 1 1 0\n", "\n8 4.5 4.5 0\n"));
    bench.write("tetrahedron.msh", tetrahedron());
    bench.write("no_groups.msh", without_names(&mesh));
    all_refuse(
        &bench,
        &[
            ("missing mesh", "block.json --mesh nowhere.msh", &["nowhere.msh", "No such file"]),
            (
                "missing mesh of the case",
                "block.json --set geometry.mesh=nowhere.msh",
                &["nowhere.msh", "No such file"],
            ),
            ("another format for a mesh", "block.json --mesh solid.stl", &["solid.stl", "STL", "-format msh41"]),
            ("another format for a case", "mesh.inp", &["mesh.inp is a mesh in another format", "gmsh mesh.inp -save"]),
            ("a script for a mesh", "block.json --mesh plate.geo", &["plate.geo", "Gmsh script", "geometry.script"]),
            ("folder for a mesh", "block.json --mesh .", &["the mesh .", "Is a directory"]),
            ("no mesh", "block.json --mesh block.json", &["block.json", "no Gmsh mesh", "$MeshFormat"]),
            ("empty mesh file", "block.json --mesh empty.msh", &["empty.msh", "empty"]),
            ("truncated in the elements", "block.json --mesh cut.msh", &["cut.msh", "$Elements", "cut off"]),
            ("truncated in the nodes", "block.json --mesh cut_nodes.msh", &["cut_nodes.msh", "$Nodes", "cut off"]),
            ("no elements", "block.json --mesh no_faces.msh", &["no_faces.msh", "$Elements"]),
            ("a bent plane", "block.json --mesh bent.msh", &["bent.msh", "node 8", "z = 0.5"]),
            ("a node nowhere", "block.json --mesh nan.msh", &["nan.msh", "$Nodes", "NaN"]),
            ("a folded element", "block.json --mesh folded.msh", &["folded.msh", "Quad4 element of \"ground\" at ("]),
            ("a mesh in space", "block.json --mesh tetrahedron.msh", &["tetrahedron.msh"]),
            ("a mesh without names", "block.json --mesh no_groups.msh", &["physical_2_1"]),
        ],
    );
}

/// The block with one element of second order: its type 8 (3-node line) or 16 (8-node quadrangle) and mid-side nodes.
fn with_mid_sides(element: &str, second_order: &str, mid_sides: &[[f64; 2]]) -> String {
    let mesh = block_msh();
    let nodes: String = mid_sides.iter().zip(37..).map(|([x, y], tag)| format!("{tag} {x} {y} 0\n")).collect();
    let count = 36 + mid_sides.len();
    let mixed = mesh.replace(element, second_order).replace("$Nodes\n36\n", &format!("$Nodes\n{count}\n"));
    let mixed = mixed.replace("$EndNodes", &(nodes + "$EndNodes"));
    assert_ne!(mesh.replace("$Nodes\n36\n", ""), mixed.replace(&format!("$Nodes\n{count}\n"), ""));
    mixed
}

/// Elements of first and second order are not joined at the mid-side nodes: loads on a 3-node line beside 4-node
/// quadrangles act on nodes that nothing else has, and an 8-node one overlaps its neighbours or gapes.
#[test]
fn elements_of_first_and_second_order_side_by_side_are_refused_with_their_groups_and_places() {
    let bench = Bench::new("orders");
    bench.write("load.msh", with_mid_sides(" 1 2 5 1 31 32\n", " 8 2 5 1 31 32 37\n", &[[0.5, 5.]]));
    bench.write("seam.msh", with_mid_sides(" 1 2 3 1 15 16\n", " 8 2 3 1 15 16 37\n", &[[2.5, 2.]]));
    let mids = [[0.5, 0.], [1., 0.5], [0.5, 1.], [0., 0.5]];
    bench.write("face.msh", with_mid_sides(" 3 2 1 1 1 2 8 7\n", " 16 2 1 1 1 2 8 7 37 38 39 40\n", &mids));
    // the mid-side node is a corner of its neighbours
    bench.write("corner.msh", with_mid_sides(" 1 2 5 1 31 32\n", " 8 2 5 1 31 33 32\n", &[]));
    all_refuse(
        &bench,
        &[
            (
                "a load's line",
                "block.json --mesh load.msh",
                &[
                    "load.msh",
                    "3-node element 4 of \"top\"",
                    "4-node",
                    "\"ground\"",
                    "(0.5000, 5.0000)",
                    "ElementOrder",
                ],
            ),
            (
                "an interface's line",
                "block.json --mesh seam.msh",
                &["3-node element 13 of \"interface\"", "order are mixed"],
            ),
            ("a face", "block.json --mesh face.msh", &["8-node element", "of \"ground\"", "(0.5000, 0.5000)", "mixed"]),
            ("a corner", "block.json --mesh corner.msh", &["3-node element 4 of \"top\"", "mixed"]),
        ],
    );
    refused("the mesh alone", &bench.run_line("check face.msh"), &["8-node element", "mixed"]);
}

/// A tetrahedron alone, in the volume group "rock".
fn tetrahedron() -> String {
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n3 1 \"rock\"\n$EndPhysicalNames\n\
     $Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n$EndNodes\n$Elements\n1\n1 4 2 1 1 1 2 3 4\n$EndElements\n"
        .into()
}

fn without_names(mesh: &str) -> String {
    let (head, rest) = mesh.split_once("$PhysicalNames").unwrap();
    head.to_string() + rest.split_once("$EndPhysicalNames\n").unwrap().1
}

/// The block's groups, as sentences list them.
const ALL: &str = "P, Q, base, body, ground, interface, top";

#[test]
fn names_that_do_not_fit_the_mesh_are_refused_with_those_that_exist() {
    let bench = Bench::new("groups");
    let mesh = block_msh();
    bench.write("unnamed_ground.msh", mesh.replace("2 1 \"ground\"", "2 1 \"soil\""));

    all_refuse(
        &bench,
        &[
            ("support", "block.json --set supports.foot=[\"x\"]", &["supports", "\"foot\"", ALL]),
            (
                "load",
                "block.json --set loads.roof={\"pressure\":{\"law\":\"step\",\"peak\":1}}",
                &["load", "\"roof\"", ALL],
            ),
            (
                "pressure on a surface",
                "block.json --set loads.ground={\"pressure\":{\"law\":\"step\",\"peak\":1}}",
                &["load \"ground\"", "curves", "surfaces"],
            ),
            (
                "pressure inside the solid",
                "block.json --set interfaces={\"interface\":\"bonded\"} --set loads={\"interface\":{\"pressure\":{\"law\":\"step\",\"peak\":1}}}",
                &[
                    "load or boundary \"interface\": its line at",
                    "has a surface on both sides; it must lie on the border",
                ],
            ),
            ("probe", "block.json --set probes=[\"Z\"]", &["probe \"Z\"", ALL]),
            ("probe on a surface", "block.json --set probes=[\"body\"]", &["probe \"body\"", "points", "surfaces"]),
            (
                "body of a probe",
                "block.json --set probes=[{\"name\":\"N\",\"at\":[1,1],\"body\":\"pipe\"}]",
                &["\"pipe\"", ALL],
            ),
            (
                "interface",
                "block.json --set interfaces.seam={\"body\":\"body\",\"thickness\":0.01}",
                &["interface \"seam\"", "no physical group", ALL],
            ),
            (
                "body of an interface",
                "block.json --set interfaces.interface.body=pipe",
                &["interface \"interface\"", "no physical group \"pipe\"", ALL],
            ),
            (
                "interface elsewhere",
                "block.json --set interfaces.base={\"body\":\"body\",\"thickness\":0.01}",
                &["interface \"base\"", "its body \"body\" on one side", "(0.0000, 0.0000)"],
            ),
            (
                "interface of surfaces",
                "block.json --set interfaces.ground={\"body\":\"body\",\"thickness\":0.01}",
                &["interface \"ground\"", "group of curves", "surfaces"],
            ),
            (
                "a probe far outside",
                "block.json --set probes=[{\"name\":\"f\",\"at\":[9,5]}]",
                &["\"f\" at (9, 5) m", "outside", "(5.0000, 5.0000) m, is 4 m away", "x from 0 to 5 m"],
            ),
            (
                "initial motions that differ",
                "block.json --set initial={\"base\":{\"velocity\":[1,0]},\"ground\":{}}",
                &["\"base\" and \"ground\"", "(0.0000, 0.0000) m", "velocity", "[1.0, 0.0]", "[0.0, 0.0]"],
            ),
            (
                "interface without friction",
                "block.json --set materials.ground={\"young\":1e8,\"poisson\":0,\"density\":2000}",
                &["interface \"interface\"", "materials.ground.friction"],
            ),
            ("material", "block.json --mesh unnamed_ground.msh", &["\"soil\"", "no material", "body, ground"]),
        ],
    );
}

#[test]
fn a_run_that_cannot_begin_says_why() {
    let bench = Bench::new("begin");
    bench.write("no_script.json", CASE.replace("\"mesh\": \"block.msh\"", "\"script\": \"nowhere.geo\""));
    bench.write("script.json", CASE.replace("\"mesh\": \"block.msh\"", "\"script\": \"block.geo\""));
    bench.write("block.geo", "DefineConstant[ width = 5 ];\n");
    let rows: [Row; 23] = [
        ("a mesh for a case", "run block.msh", &["block.msh is a mesh", "CASE.json --mesh block.msh"]),
        ("too few modes", "run block.json --set damping.modes=[1,9999]", &["damping.modes", "9999", "68 modes"]),
        ("all held", "run block.json --set supports.ground=[\"x\",\"y\"] --bonded", &["nothing can move"]),
        ("--set without =", "run block.json --set time", &["--set", "\"time\"", "PATH=VALUE"]),
        ("--set of nothing", "run block.json --set =1", &["--set", "not a path"]),
        ("--set with a hole", "run block.json --set time..step=1", &["\"time..step\"", "not a path"]),
        ("--set in a number", "run block.json --set time.step.x=1", &["\"x\"", "single value"]),
        ("--set behind a list", "run block.json --set probes.7=P", &["\"7\"", "list of 2"]),
        ("--geo with --mesh", "run block.json --geo a=1 --mesh block.msh", &["--geo", "--mesh"]),
        ("--geo without script", "run block.json --geo a=1", &["--geo", "block.json", "block.msh"]),
        ("--geo without value", "run block.json --geo a", &["--geo a", "NAME=NUMBER"]),
        ("--geo of a word", "run block.json --geo a=wide", &["--geo a=wide", "NAME=NUMBER"]),
        ("--geo NaN", "run block.json --geo a=nan", &["--geo a=nan", "NAME=NUMBER"]),
        ("--geo of nothing", "run script.json --geo =1", &["width"]),
        ("--geo unknown", "run script.json --geo widht=1", &["\"widht\"", "width"]),
        ("missing script", "run no_script.json", &["nowhere.geo"]),
        (
            "initial displacement whose energy is no number",
            "run block.json --set initial={\"body\":{\"displacement\":[0,1e200]}}",
            &["t = 0", "too large", "initial motion"],
        ),
        (
            "initial velocity beyond numbers, no joints",
            "run block.json --bonded --set initial={\"body\":{\"velocity\":[0,1e308]}}",
            &["t = 0", "too large", "initial motion"],
        ),
        (
            "static, nothing held in y",
            "run block.json --set analysis=static --set supports={\"base\":[\"x\"]}",
            &["nothing holds \"body\", \"ground\"", "in y", "supports"],
        ),
        (
            "static, free to turn",
            "run block.json --set analysis=static --set supports={\"Q\":[\"x\",\"y\"]}",
            &["nothing holds", "against turning"],
        ),
        (
            "gravity, nothing held",
            "run block.json --set gravity=9.81 --set damping=null --set supports={}",
            &["nothing holds", "in x and y"],
        ),
        ("gmsh not found", "run script.json", &["gmsh", "PATH", "install", "CORALPIPE_GMSH"]),
        ("gmsh not found by mesh", "mesh script.json", &["gmsh", "PATH", "install", "CORALPIPE_GMSH"]),
    ];
    for (what, line, words) in rows {
        refused(what, &bench.run_line(line), words);
        assert!(!bench.path("output").exists(), "{what}: a refused run must not write");
    }
}

/// Tests may run as root, whom permissions do not stop: a file stands where a folder must be made.
#[test]
fn a_folder_that_cannot_be_written_is_named_with_the_way_out() {
    let bench = Bench::new("out");
    let rows: [Row; 4] = [
        ("a file for the folder", "run block.json --out block.msh", &["block.msh", "--out"]),
        ("below a file", "run block.json --out block.msh/deep", &["block.msh/deep", "--out"]),
        ("no disk at all", "run block.json --out /proc/none", &["/proc/none", "--out"]),
        ("modes below a file", "modes block.json --out block.msh", &["block.msh/modes", "--out"]),
    ];
    for (what, line, words) in rows {
        refused(what, &bench.run_line(line), words);
    }
    assert_eq!(std::fs::read_to_string(bench.path("block.msh")).unwrap(), block_msh());
}

#[test]
fn usage_errors_end_with_2() {
    let bench = Bench::new("usage");
    let lines = [
        "",
        "fly",
        "run --wrong",
        "run a.json b.json",
        "run block.json --set",
        "run block.json --out",
        "modes block.json -n many",
        "modes block.json -n -1",
        "check block.json --bonded",
        "schema block.json",
        "blast",
        "blast block.json",
    ];
    for line in lines {
        let Outcome { code, stdout, stderr } = bench.run_line(line);
        assert_eq!((code, stdout.as_str()), (Some(2), ""), "{line}: {stderr}");
        assert!(stderr.contains("Usage") || stderr.contains("--help"), "{line}: {stderr}");
    }
    refused("no modes", &bench.run_line("modes block.json -n 0"), &["-n 0", "at least one"]);
}

/// Odd, but each of them means something: the run is done and the warning, if there is one, is on stderr.
#[test]
fn what_is_odd_but_has_a_meaning_runs() {
    let bench = Bench::new("odd");
    bench.write("triangles.msh", triangles());
    let rows: [Row; 20] = [
        (
            "unused group",
            "run block.json --set supports={\"top\":[\"x\",\"y\"]}",
            &["warning: ", "does not use", "base"],
        ),
        (
            "unused material",
            "run block.json --set materials.mud={\"young\":1,\"poisson\":0,\"density\":1}",
            &["\"mud\""],
        ),
        (
            "unused interface",
            "run block.json --set interfaces.i={\"body\":\"b\",\"thickness\":1}",
            &["\"i\" is not used"],
        ),
        ("end not a multiple of the step", "run block.json --set time.end=10.2ms", &["time.end", "0.01 s is used"]),
        (
            "a probe beside the mesh",
            "run block.json --set probes=[{\"name\":\"f\",\"at\":[5.5,5]}]",
            &["\"f\"", "0.500 m away"],
        ),
        (
            "static with keys of motion",
            "run block.json --set analysis=static --set time.hht=-0.1 --set mass=lumped",
            &["static", "time.hht, mass, damping has no effect"],
        ),
        (
            "b_bar without its elements",
            "run block.json --mesh triangles.msh --set elements.quad4=b_bar",
            &["b_bar", "no effect"],
        ),
        ("initial motion of nothing", "run block.json --set initial={\"body\":{}}", &["initial.body", "neither"]),
        (
            "initial motion of what is held",
            "run block.json --set initial={\"base\":{\"velocity\":[0,1]}}",
            &["initial.base", "hold 6 of its nodes", "(0.0000, 0.0000)"],
        ),
        (
            "large motion",
            "run block.json --set loads.top.pressure.peak=1GPa",
            &["turns or strains by", "taken as small"],
        ),
        (
            "large jumps",
            "run block.json --set interfaces.interface.gap=1m --set initial={\"body\":{\"velocity\":[20,0]}}",
            &["% of the joint's length"],
        ),
        ("a key taken out", "run block.json --set time.newmark=null --set output=null", &[]),
        ("no probes", "run block.json --set probes=[]", &[]),
        ("no loads", "run block.json --set loads={}", &["top"]),
        ("one step", "run block.json --set time.end=0.5ms --set output.every=0.5ms", &[]),
        ("more modes than there are", "modes block.json -n 18446744073709551615", &[]),
        ("endless iterations", "run block.json --set newton.max_iterations=18446744073709551615", &[]),
        ("frames after the end", "run block.json --set output.every=1e300", &[]),
        ("a body in a hole too wide to touch", "run block.json --set interfaces.interface.gap=1m", &[]),
        ("bonded", "run block.json --bonded", &[]),
    ];
    for (what, line, words) in rows {
        let Outcome { code, stderr, .. } = bench.run_line(line);
        assert_eq!(code, Some(0), "{what}: {stderr}");
        words.iter().for_each(|word| assert!(stderr.contains(word), "{what}: no {word:?} in: {stderr}"));
    }
}

/// The squares cut along a diagonal.
fn triangles() -> String {
    let (head, elements) = block_msh().split_once("$Elements\n").map(|(a, b)| (a.to_string(), b.to_string())).unwrap();
    let mut lines = Vec::new();
    for line in elements.lines().skip(1).take_while(|l| !l.starts_with('$')) {
        let words: Vec<&str> = line.split(' ').collect();
        match (words[1], &words[5..]) {
            ("3", [a, b, c, d]) => {
                lines.push(format!("2 2 {} 1 {a} {b} {c}", words[3]));
                lines.push(format!("2 2 {} 1 {a} {c} {d}", words[3]));
            }
            _ => lines.push(words[1..].join(" ")),
        }
    }
    let numbered: String = lines.iter().zip(1..).map(|(line, n)| format!("{n} {line}\n")).collect();
    format!("{head}$Elements\n{}\n{numbered}$EndElements\n", lines.len())
}

/// Statics needs no natural mode: the damping of a case that also runs dynamically does not stop it.
#[test]
fn a_static_run_computes_no_modes_and_stands_on_its_base() {
    let bench = Bench::new("static");
    let outcome = bench.run_line("run block.json --set analysis=static --set damping.modes=[1,9999]");
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    assert!(!outcome.stdout.contains("frequencies"), "{}", outcome.stdout);
    // `modes` of the same case, held by nothing, still tells its rigid motions
    let loose = bench.run_line("modes block.json --set analysis=static --set supports={}");
    assert!(loose.code == Some(0) && loose.stdout.contains("0.000000"), "{}", loose.stderr);
}

/// A slip such as `--out /` must not write among other people's files.
#[test]
fn a_folder_that_holds_other_things_is_refused_and_not_touched() {
    let bench = Bench::new("foreign");
    let there = || {
        let mut names: Vec<_> = std::fs::read_dir(&bench.folder).unwrap().map(|e| e.unwrap().file_name()).collect();
        // the second is the mesh's, beside which it may come to stand
        names.retain(|n| !n.to_string_lossy().starts_with(".std") && n != "block.orders");
        names.sort();
        names
    };
    let before = there();
    for line in ["run block.json --out .", "modes block.json --out .", "run block.json --out /"] {
        refused(line, &bench.run_line(line), &["no folder of results", "holds", "--out"]);
    }
    assert_eq!(there(), before);
    // what a batch or `modes` has left is no stranger
    std::fs::create_dir(bench.path("new")).unwrap();
    bench.write("new/batch.log", "");
    for line in ["modes block.json --out new", "run block.json --out new", "run block.json --out new"] {
        let outcome = bench.run_line(line);
        assert_eq!(outcome.code, Some(0), "{line}: {}", outcome.stderr);
    }
}

/// Read back from `histories.csv`: the first step that has the value is its time, and a peak is one of the two.
#[test]
fn the_summary_has_the_largest_and_the_least_value_of_each_history_with_its_time() {
    let bench = Bench::new("extremes");
    assert_eq!(bench.run_line("run block.json --set loads.top.pressure.peak=-100kPa --quiet").code, Some(0));
    let text = std::fs::read_to_string(bench.path("output/block/histories.csv")).unwrap();
    let mut lines = text.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let columns = lines.next().unwrap();
    let rows: Vec<Vec<f64>> = lines.map(|cells| cells.iter().map(|cell| cell.parse().unwrap()).collect()).collect();
    let summary = std::fs::read(bench.path("output/block/summary.json")).unwrap();
    let summary: serde_json::Value = serde_json::from_slice(&summary).unwrap();
    let (mut count, mut differ) = (0, 0);
    for (i, column) in columns.iter().enumerate().skip(1) {
        let (probe, component) = column.split_once('.').unwrap();
        let found = &summary["peaks"][probe][component];
        let first = |is: &dyn Fn(f64, f64) -> bool| {
            rows.iter().fold((f64::NAN, f64::NAN), |best, row| {
                if best.1.is_nan() || is(row[i], best.1) { (row[0], row[i]) } else { best }
            })
        };
        let (max, min) = (first(&|a, b| a > b), first(&|a, b| a < b));
        let read = |of: &serde_json::Value| (of["time"].as_f64().unwrap(), of["value"].as_f64().unwrap());
        let close = |a: (f64, f64), b: (f64, f64)| (a.0 - b.0).abs() < 1e-12 && (a.1 - b.1).abs() <= 1e-15 * b.1.abs();
        assert!(close(read(&found["max"]), max), "{column}: {} but {max:?}", found["max"]);
        assert!(close(read(&found["min"]), min), "{column}: {} but {min:?}", found["min"]);
        let peak = if max.1 >= -min.1 { max } else { min };
        assert!((read(found).1.abs() - peak.1.abs()).abs() <= 1e-15 * peak.1.abs(), "{column}: {found} but {peak:?}");
        count += 1;
        differ += usize::from(max.1 > 0. && min.1 < 0.);
    }
    assert!(count == 12 && differ >= 6, "{count} histories, {differ} of them with both signs");
}

#[test]
fn results_of_other_options_are_named_before_they_are_replaced() {
    let bench = Bench::new("replaced");
    assert!(!bench.run_line("run block.json").stderr.contains("replaces"));
    assert!(!bench.run_line("run block.json").stderr.contains("replaces"));
    let other = bench.run_line("run block.json --set time.end=5ms").stderr;
    for words in ["output/block are of another run (mesh block.msh)", "--set time.end=5ms) replaces", "--out DIR"] {
        assert!(other.contains(words), "{words}: {other}");
    }
}

/// 20,001 frames of 14 kB, as a finished run of this has them; 1e8 steps; and 100 s where 100 ms were meant.
#[test]
fn a_run_above_a_size_is_refused_with_its_numbers_and_let_run_by_large() {
    let bench = Bench::new("large");
    let often = "block.json --set time.step=0.5us --set output.every=0.5us";
    let numbers = [
        "20000 steps of about 72 unknowns and 20001 frames",
        "(time.end = 0.01 s, time.step = 5e-7 s, output.every = 5e-7 s)",
        "write about 300 MB into output/block, where ",
        "more than 10000 frames",
        "--large",
    ];
    let checked = bench.run_line(&format!("check {often}"));
    assert_eq!(checked.code, Some(0), "{}", checked.stderr);
    let refused = bench.run_line(&format!("run {often}"));
    assert_eq!(refused.code, Some(1), "{}", refused.stderr);
    assert!(!bench.path("output").exists(), "a refused run writes nothing");
    for words in numbers {
        assert!(checked.stdout.contains(words), "{words}: {}", checked.stdout);
        assert!(refused.stderr.contains(words), "{words}: {}", refused.stderr);
    }
    let told = bench.run_line("run block.json --set time.step=1e-10").stderr;
    for words in ["100000000 steps", "and 11 frames", "about 48 GB", "more than 100000 steps, more than 20 GB"] {
        assert!(told.contains(words), "{words}: {told}");
    }
    let milliseconds = bench.run_line("run block.json --set time.end=100");
    assert_eq!(milliseconds.code, Some(1), "100 ms was meant: {}", milliseconds.stderr);
    for words in ["200000 steps", "time.end = 100 s", "without a unit is in seconds"] {
        assert!(milliseconds.stderr.contains(words), "{words}: {}", milliseconds.stderr);
    }
    let short = "--set time.end=0.2ms --set time.step=0.01us --set output.every=0.01us --set probes=[]";
    let run = bench.run_line(&format!("run block.json {short} --large --quiet --out {}", "block.json"));
    let warned = run.stderr.find("20001 frames").expect("told though the folder for them cannot be made");
    assert!(run.code == Some(1) && run.stderr.find("coralpipe: ").expect("it cannot begin") > warned, "{}", run.stderr);
    assert!(!bench.run_line("check block.json").stdout.contains("--large"));
}

/// The step of one case is a slip; all cases of a plan together are what counts for time and disk.
#[test]
fn a_sweep_above_a_size_is_refused_before_it_begins() {
    let bench = Bench::new("large-sweep");
    bench.write("plan.json", r#"{ "case": "block.json", "set": { "time.step": ["0.5 ms", "0.05 us"] } }"#);
    let refused = bench.run_line("sweep plan.json");
    assert_eq!(refused.code, Some(1), "{}", refused.stderr);
    for words in ["2 runs, the longest of 200000 steps", "time.step = 5e-8 s", "output/plan", "--large"] {
        assert!(refused.stderr.contains(words), "{words}: {}", refused.stderr);
    }
    assert!(!bench.path("output").exists());
}

/// Triangles of 0.006 degrees, faces in no group, groups without elements, elements that stand twice.
#[test]
fn a_mesh_alone_is_warned_of_as_in_a_case() {
    let bench = Bench::new("alone");
    let flat = triangles().replace("\n8 1 1 0\n", "\n8 0.5 0.00005 0\n");
    bench.write("flat.msh", flat);
    let told = bench.run_line("check flat.msh").stdout;
    assert!(told.contains("smallest angle, 5.7e-3 degrees at (0.5000, 0.0000) m"), "{told}");
    let mesh = block_msh().replace(" 3 2 1 1 5 6 12 11\n", " 3 0 5 6 12 11\n");
    let mesh = mesh.replace("\n7\n2 1", "\n8\n1 9 \"nothing\"\n2 1").replace("$Elements\n41\n", "$Elements\n42\n");
    let mesh = mesh.replace("$EndElements", "99 3 2 1 1 29 30 36 35\n$EndElements");
    bench.write("bad.msh", mesh);
    let Outcome { code, stdout, stderr } = bench.run_line("check bad.msh");
    assert_eq!(code, Some(0), "{stderr}");
    for words in [
        "1 surface elements belong to no",
        "(4.5000, 0.5000)",
        "any element: nothing",
        "1 element stands more than once",
    ] {
        assert!(stdout.contains(words), "{words}: {stdout}");
    }
    let numbers = bench.run_line("check block.json --set time.step=0.3ms --set time.end=0.9ms").stdout;
    assert!(numbers.contains("3 steps of 0.0003 s to 0.0009 s"), "{numbers}");
}

/// Nothing holds the block: the impulse p T/2 * 5 m moves its 24 m2 of 2000 and 1 m2 of 7800 kg/m3 downwards.
#[test]
fn a_mesh_that_nothing_holds_moves_as_a_rigid_body_on_average() {
    let bench = Bench::new("loose");
    let refusal = bench.run_line("run block.json --set supports={}");
    refused("damping ratio of rigid motions", &refusal, &["damping.modes", "0 Hz", "alpha and beta"]);

    let outcome = bench.run_line("run block.json --set supports={} --set damping=null --set time.end=60ms --quiet");
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let table = std::fs::read_to_string(bench.path("output/block/histories.csv")).unwrap();
    let row = |at: f64| -> Vec<f64> {
        let rows = table.lines().skip(1).map(|l| l.split(',').map(|x| x.parse().unwrap()).collect());
        rows.min_by(|a: &Vec<f64>, b: &Vec<f64>| (a[0] - at).abs().total_cmp(&(b[0] - at).abs())).unwrap()
    };
    let (early, late) = (row(0.02), row(0.06));
    // mean velocity of P and Q; the block's own vibrations (3 mm at most) hide some of it
    let mean = [2, 8].map(|uy| (late[uy] - early[uy]) / (late[0] - early[0])).iter().sum::<f64>() / 2.;
    let rigid = -100e3 * 0.02 / 2. * 5. / (24. * 2000. + 7800.);
    assert!((mean / rigid - 1.).abs() < 0.1, "{mean} m/s, and {rigid} m/s by the impulse");
}

#[test]
fn names_that_are_no_text_and_names_xml_must_escape_give_a_series_that_opens() {
    let bench = Bench::new("names");
    for name in [&b"bl\xffck"[..], b"a & b <c> \"d\" 'e'", "Küste ö".as_bytes(), b".hidden", b"a.b.c"] {
        let file = [name, b".json"].concat();
        bench.write(std::ffi::OsStr::from_bytes(&file), CASE);
        let run = [std::ffi::OsStr::new("run"), std::ffi::OsStr::from_bytes(&file)];
        let outcome = bench.run(&run);
        assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
        let shown = String::from_utf8_lossy(name).into_owned();
        let series = std::fs::read_to_string(bench.path(format!("output/{shown}/{shown}.pvd"))).unwrap();
        let frame = |line: &str| Some(line.split_once("file=\"")?.1.split_once("\"/>")?.0.to_string());
        let frames: Vec<String> = series.lines().filter_map(frame).collect();
        assert_eq!(frames.len(), 11, "{series}");
        for frame in frames {
            assert!(!frame.contains(['<', '"']), "{frame}");
            let plain = frame.replace("&lt;", "<").replace("&gt;", ">").replace("&quot;", "\"").replace("&amp;", "&");
            assert!(bench.path(format!("output/{shown}/{plain}")).is_file(), "{plain}");
        }
    }
}

#[test]
fn results_go_to_stdout_and_all_else_to_stderr() {
    let bench = Bench::new("streams");
    let Outcome { code, stdout, stderr } =
        bench.run_line("run block.json --set probes=[{\"name\":\"f\",\"at\":[5.5,5]}]");
    assert_eq!(code, Some(0), "{stderr}");
    assert!(stdout.contains("frequencies") && stdout.contains("results in output/block\n"), "{stdout}");
    for told in ["mesh block.msh", "warning: ", "step 20 of 20"] {
        assert!(stderr.contains(told) && !stdout.contains(told), "{told}: {stderr}");
    }
    // undamped, since the case's damping is warned of; the block's body has no bore, and warnings are printed under --quiet
    let quiet = bench.run_line("run block.json --quiet --set damping=null");
    let is_warning = |line: &str| line.starts_with("warning: rings.csv has no section forces of \"body\"");
    assert!(quiet.code == Some(0) && quiet.stderr.lines().all(is_warning), "{}", quiet.stderr);
    assert!(quiet.stdout.contains("results in output/block\n"));
    for line in [
        "schema",
        "check block.json",
        "modes block.json --out m",
        "blast --charge 1t --standoff 30m",
        "--version",
        "run --help",
    ] {
        let outcome = bench.run_line(line);
        assert!(outcome.code == Some(0) && !outcome.stdout.is_empty(), "{line}: {}", outcome.stderr);
    }
}

/// xi = alpha / (4 pi f) + beta pi f: 5 % at 5 and 15 Hz, so alpha = 2.356194 1/s, beta = 7.957747e-4 s, least 4.330 %
/// at 8.660 Hz, and at 100 Hz 2.356194 / 1256.6 + 0.25 = 25.2 %.
#[test]
fn check_shows_the_damping_over_the_loads_spectrum_and_a_run_warns_outside_the_fitted_band_too() {
    let bench = Bench::new("damping");
    let fitted = "check block.json --set damping={\"alpha\":2.356194,\"beta\":7.957747e-4} --set time.end=0.1";
    let Outcome { code, stdout, stderr } = bench.run_line(fitted);
    assert_eq!(code, Some(0), "{stderr}");
    for words in ["least 4.330 % at 8.66 Hz", "25.2", "load on top: half of its energy below"] {
        assert!(stdout.contains(words), "no {words:?} in: {stdout}");
    }
    // 2 x 4.330 % at 8.66 (2 -+ sqrt 3) = 2.32 and 32.3 Hz; |P|^2 of a triangle of 20 ms in closed form, integrated apart from
    // the program: 6.9 % and 26.5 %
    let warning = "warning: damping: the load on top has 7 % of its energy below 2.32 Hz and 26 %";
    assert!(stdout.contains(warning), "{stdout}");
    // a run says the same before it marches, and its summary keeps it
    let run = bench.run_line(&fitted.replace("check", "run"));
    let (said, marched) = (run.stderr.find(warning), run.stderr.find("step 20 of 200"));
    assert!(said.is_some() && said < marched && run.stderr.matches(warning).count() == 1, "{}", run.stderr);
    let summary = std::fs::read_to_string(bench.path("output/block/summary.json")).unwrap();
    assert!(summary.contains(warning.trim_start_matches("warning: ")), "{summary}");
    let undamped = bench.run_line("check block.json --set damping=null").stdout;
    assert!(!undamped.contains("xi ="), "{undamped}");
}

/// `coralpipe schema | head -1`, `coralpipe run 2>&1 | head -1`: the other end is closed before a word is said.
#[test]
fn a_pipe_that_nobody_reads_stops_nothing() {
    let bench = Bench::new("pipe");
    for line in ["schema", "check block.json", "run block.json", "--help"] {
        let words: Vec<&str> = line.split_whitespace().collect();
        let (_, broken) = std::io::pipe().unwrap();
        let stderr = bench.path("stderr");
        let mut program = bench.program(&words);
        program.stdout(broken).stderr(std::fs::File::create(&stderr).unwrap());
        let code = code_of(program.spawn().unwrap());
        let told = std::fs::read_to_string(stderr).unwrap();
        assert!(code == Some(0) && !told.contains("panicked"), "{line}: {code:?}, {told}");
    }
    let (_, broken) = std::io::pipe().unwrap();
    let both = broken.try_clone().unwrap();
    assert_eq!(code_of(bench.program(&["run", "block.json"]).stdout(broken).stderr(both).spawn().unwrap()), Some(0));
    assert!(bench.path("output/block/summary.json").is_file());

    let (_, broken) = std::io::pipe().unwrap();
    assert_eq!(code_of(bench.program(&["run", "nowhere.json"]).stderr(broken).spawn().unwrap()), Some(1));
}

/// A full disk is no closed pipe: what was asked for is lost, and that is told.
#[test]
#[cfg(target_os = "linux")]
fn a_result_that_stdout_does_not_take_is_an_error() {
    let bench = Bench::new("full");
    let full = || std::fs::File::options().write(true).open("/dev/full").unwrap();
    let stderr = bench.path("stderr");
    let mut program = bench.program(&["schema"]);
    program.stdout(full()).stderr(std::fs::File::create(&stderr).unwrap());
    assert_eq!(code_of(program.spawn().unwrap()), Some(1));
    assert!(std::fs::read_to_string(stderr).unwrap().contains("stdout cannot be written"));
    assert_eq!(
        code_of(
            bench.program(&["run", "block.json"]).stdout(std::process::Stdio::null()).stderr(full()).spawn().unwrap()
        ),
        Some(0)
    );
}

/// The point P is called "base" as the curve is, the ground "body" as the curve of the interface.
#[test]
fn one_name_in_two_dimensions_is_used_by_what_it_means_and_refused_where_that_is_unclear() {
    let bench = Bench::new("shared_names");
    let mesh = block_msh().replace("0 6 \"P\"", "0 6 \"base\"").replace("1 3 \"interface\"", "1 3 \"body\"");
    bench.write("block.msh", mesh);
    let case = CASE.replace("\"interface\":", "\"body\":").replace("[\"P\"", "[\"base\"");
    bench.write("unclear.json", &case);
    const WORDS: [&str; 2] =
        ["supports: \"base\" is a group of points and a group of curves", "write \"point:base\" or \"curve:base\""];
    all_refuse(&bench, &[("a support", "unclear.json", &WORDS)]);
    let case = case.replace("\"base\": [\"x\", \"y\"]", "\"curve:base\": [\"x\", \"y\"]");
    bench.write("clear.json", &case);
    let motion = "\"initial\": { \"base\": { \"velocity\": [0, 0] } }, \"time\"";
    bench.write("initial.json", case.replace("\"time\"", motion));
    all_refuse(
        &bench,
        &[("a motion", "initial.json", &["initial: \"base\" is a group of points and a group of curves"])],
    );

    let table = bench.run_line("check clear.json").stdout;
    let row = |begin: &str| table.lines().find(|line| line.trim_start().starts_with(begin)).unwrap_or_default();
    assert!(row("base                    5 lines").ends_with("support: u_x = u_y = 0"), "{table}");
    assert!(row("base               point at (2.0000, 3.0000) m").ends_with("probe, on the body's side"), "{table}");
    assert!(row("body                    4 lines").contains("interface of body: 4 joints in ground"), "{table}");
    assert!(row("body                    1 elements").contains("material: E 1000.0000 MPa"), "{table}");
    assert!(!table.contains("does not use"), "{table}");
    // the numbers are those of the case whose names differ
    let histories = |name: &str| std::fs::read_to_string(bench.path(format!("output/{name}/histories.csv"))).unwrap();
    assert_eq!(bench.run_line("run clear.json --quiet").code, Some(0));
    bench.write("block.msh", block_msh());
    assert_eq!(bench.run_line("run block.json --quiet").code, Some(0));
    assert_eq!(histories("clear").replace("base.", "P."), histories("block"));
}

#[test]
fn groups_without_elements_have_no_negative_size() {
    let bench = Bench::new("no_size");
    let names = "\n9\n2 8 \"nothing\"\n1 9 \"no_line\"\n2 1 \"ground\"";
    bench.write("few.msh", block_msh().replace("\n7\n2 1 \"ground\"", names));
    let table = bench.run_line("check few.msh").stdout;
    assert!(table.contains("nothing                 0 elements,     0.0000 m2"), "{table}");
    assert!(table.contains("no_line                 0 lines,     0.0000 m"), "{table}");
    assert!(!table.contains("-0.0"), "{table}");
}

/// ESC begins a command to the terminal, NUL ends a text in C, a carriage return overwrites a line.
#[test]
fn control_characters_from_files_names_and_arguments_never_reach_the_terminal() {
    let bench = Bench::new("control");
    let esc = "\u{1b}[31mX";
    bench.write("word.msh", format!("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n{esc}\n"));
    bench.write("nul.msh", "$MeshFormat\n4.1\0\r 0 8\n$EndMeshFormat\n");
    bench.write("section.msh", format!("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n${esc}\n$Nodes\n\0\n"));
    bench.write("named.msh", block_msh().replace("\"interface\"", &format!("\"inter{esc}\r\u{202e}face\"")));
    bench.write("two\nlines.msh", block_msh());
    bench.write("two\nlines.json", CASE);
    bench.write(format!("key{esc}.json"), CASE.replace("\"supports\"", "\"sup\\u001bports\""));
    let body = "interfaces.interface.body=no\nbody\u{7f}";
    let rows: [(&[&str], i32, &str); 12] = [
        (&["check", "block.json", "--mesh", "word.msh"], 1, "found \"\\u{1b}[31mX\""),
        (&["check", "nul.msh"], 1, r"4.1\0"),
        (&["check", "section.msh"], 1, r"\0"),
        (&["check", "named.msh"], 0, r"inter\u{1b}[31mX\r\u{202e}face"),
        (&["check", "block.json", "--mesh", "named.msh"], 1, r"inter\u{1b}[31mX\r\u{202e}face"),
        (&["check", "two\nlines.msh"], 0, r"two\nlines.msh: 36 nodes"),
        (&["check", "two\nlines.json"], 0, r"block.msh: 36 nodes"),
        (&["check", "no\nsuch.json"], 1, r"no\nsuch.json"),
        (&["check", &format!("key{esc}.json")], 1, r"sup\u{1b}ports"),
        (&["check", "block.json", "--set", body], 1, r"no\nbody\u{7f}"),
        (&["check", "block.json", "--set", "probes=[\"N\\u001b\\nM\"]"], 1, r"N\u{1b}\nM"),
        (&["\u{1b}]0;title\u{7}\nfly"], 2, r"\u{1b}]0;title\u{7}\nfly"),
    ];
    for (arguments, code, shown) in rows {
        let outcome = bench.run(arguments);
        let all = format!("{}{}", outcome.stdout, outcome.stderr);
        assert_eq!(outcome.code, Some(code), "{arguments:?}: {all}");
        assert!(all.contains(shown), "{arguments:?}: no {shown} in {all}");
        assert!(!all.chars().any(|c| c != '\n' && (c.is_control() || c == '\u{202e}')), "{arguments:?}: {all:?}");
        assert!(code != 1 || outcome.stderr.lines().count() == 1, "one sentence, one line: {all}");
    }
    // files hold the names as they are
    let probe = r#"probes=[{"name":"N\u001b","at":[2,5]}]"#;
    let outcome = bench.run(&["run", "block.json", "--set", probe, "--out", "out\nput"]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    assert!(
        outcome.stdout.ends_with("results in out\\nput\n") && !outcome.stdout.contains('\u{1b}'),
        "{}",
        outcome.stdout
    );
    let summary = std::fs::read_to_string(bench.path("out\nput/summary.json")).unwrap();
    assert!(summary.contains("N\\u001b") && !summary.contains('\u{1b}'), "{summary}");
}

#[test]
fn large_numbers_take_no_more_room_than_small_ones() {
    let bench = Bench::new("digits");
    let far: String = block_msh().lines().map(|line| line.to_string() + "\n").collect();
    let (head, rest) = far.split_once("$Nodes\n36\n").unwrap();
    let (nodes, tail) = rest.split_once("$EndNodes").unwrap();
    let grown: String = nodes
        .lines()
        .map(|line| {
            let words: Vec<&str> = line.split(' ').collect();
            format!("{} {}e150 {}e150 0\n", words[0], words[1], words[2])
        })
        .collect();
    bench.write("far.msh", format!("{head}$Nodes\n36\n{grown}$EndNodes{tail}"));
    for line in
        ["check far.msh", "check block.json --mesh far.msh", "check block.json --mesh far.msh --set probes=[\"base\"]"]
    {
        let outcome = bench.run_line(line);
        let all = format!("{}{}", outcome.stdout, outcome.stderr);
        let longest = all.split(|c: char| !c.is_ascii_digit()).map(str::len).max();
        assert!(longest <= Some(12), "{longest:?} digits in a row: {all}");
        assert!(!all.contains("panicked"), "{all}");
    }
}
