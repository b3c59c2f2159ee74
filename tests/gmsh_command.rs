//! The gmsh command: found, asked, believed only when its mesh can be used; and the record that spares it.

use coralpipe::Result;
use coralpipe::model::mesh::Mesh;
use coralpipe::study::gmsh::Gmsh;
use coralpipe::study::meshing::{Meshing, Outcome, ensure_mesh_with};
use coralpipe::study::script::Script;
use std::collections::BTreeMap;
use std::ffi::OsStr;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

const SCRIPT: &str = r#"// DefineConstant[ commented = {1} ];
/* DefineConstant[ away = 1 ]; */
Include "shared.geo";
DefineConstant[
  width = {2, Name "Ground/Width [m]", Min 1, Max 1e1, Step .5} // no comma: Gmsh does not mind
  height = {1.5, Max 3, Name "Ground/Height // depth [m]"},
  order = {1, Choices{1="linear", 2="quadratic"}, Name "Mesh/Order"}, half = width / 2, size = .5,
  title = {"a text", Name "Title"}, list() = {{1, 2}, Name "List"}, offset = {-1e-1, Min -(1), Max 1, Name "Offset"}
];
SetFactory("OpenCASCADE");
Rectangle(1) = {0, offset, 0, width, height};
MeshSize{:} = size;
Physical Surface("ground") = {1};
Physical Curve("base") = {1};
If (width == 7)
  Error("width %g is unlucky", width);
EndIf
If (width == 8)
  Warning("width %g is odd", width);
EndIf
If (width == 9)
  Delete Physicals; Recursive Delete{ Surface{1}; }
EndIf
"#;

const SHARED: &str = "DefineConstant[ unused, depth = {4} ];\n";

/// What a fake gmsh writes.
const MESH: &str = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n3\n1 0 0 0\n2 1 0 0\n3 0 1 0\n$EndNodes\n$Elements\n1\n1 2 2 1 1 1 2 3\n$EndElements\n";

/// A folder of its own for each test, with the script in it.
struct Place(PathBuf);

impl Place {
    fn new(name: &str) -> Place {
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("gmsh_command").join(name);
        let _ = std::fs::remove_dir_all(&folder);
        std::fs::create_dir_all(folder.join("bin")).unwrap();
        std::fs::write(folder.join("box.geo"), SCRIPT).unwrap();
        std::fs::write(folder.join("shared.geo"), SHARED).unwrap();
        Place(folder)
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }

    /// A fake gmsh; `$OUT` is the file it is to write.
    fn fake(&self, body: &str) -> PathBuf {
        let file = self.path("bin/gmsh");
        let text =
            format!("#!/bin/sh\nfor OUT; do :; done\necho \"$@\" > '{}'\n{body}\n", self.path("arguments").display());
        std::fs::write(&file, text).unwrap();
        std::fs::set_permissions(&file, std::fs::Permissions::from_mode(0o755)).unwrap();
        file
    }

    fn ensure(&self, parameters: &[(&str, f64)], find: impl FnOnce() -> Result<Gmsh>) -> Result<Meshing> {
        let parameters = parameters.iter().map(|&(n, v)| (n.to_owned(), v)).collect();
        ensure_mesh_with(&self.path("box.geo"), &parameters, &self.path("meshes/box.msh"), find)
    }

    fn ensure_by_fake(&self, parameters: &[(&str, f64)], body: &str) -> Result<Meshing> {
        let fake = self.fake(body);
        self.ensure(parameters, || Gmsh::find_in(Some(fake.as_os_str()), None, &[]))
    }

    /// The folder of the meshes, its files' names sorted.
    fn files(&self) -> Vec<String> {
        let entries = std::fs::read_dir(self.path("meshes")).unwrap();
        let mut names: Vec<_> = entries.map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }
}

/// A small disk, unmounted in the end, also where a test fails.
struct Mounted(PathBuf);

impl Drop for Mounted {
    fn drop(&mut self) {
        let unmounted = Command::new("umount").arg(&self.0).status();
        assert!(unmounted.is_ok_and(|status| status.success()) || std::thread::panicking(), "{:?}", self.0);
    }
}

fn writes_mesh() -> String {
    format!("echo \"Info    : Running 'gmsh' [Gmsh 9.8.7, 1 node]\"\nprintf '{}' > \"$OUT\"", MESH.replace('\n', "\\n"))
}

fn never() -> Result<Gmsh> {
    panic!("an unchanged mesh needs no gmsh")
}

fn is_made(meshing: &Meshing) -> bool {
    matches!(meshing.outcome, Outcome::Made { .. })
}

fn reason(meshing: &Meshing) -> &str {
    match &meshing.outcome {
        Outcome::Made { reason, .. } => reason,
        Outcome::Unchanged => "unchanged",
        Outcome::Unchecked { reason } => reason,
    }
}

/// gmsh itself; none if it is not installed, which is a failure where CI is set.
fn real_gmsh() -> Option<Gmsh> {
    match Gmsh::find(Path::new(env!("CARGO_MANIFEST_DIR"))) {
        Ok(gmsh) => Some(gmsh),
        Err(e) => {
            assert!(std::env::var_os("CI").is_none(), "{e}");
            eprintln!("\n*** SKIPPED: {e} ***\n");
            None
        }
    }
}

// ---- the script's constants -------------------------------------------------------------------------------------

#[test]
fn constants_are_those_that_setnumber_can_set() {
    let place = Place::new("constants");
    let script = Script::read(&place.path("box.geo")).unwrap();
    let found: Vec<String> = script.constants.iter().map(|c| format!("{}={}", c.name, c.default)).collect();
    assert_eq!(
        found,
        ["width=2", "height=1.5", "order=1", "half=width/2", "size=0.5", "offset=-0.1", "unused=0", "depth=4"]
    );
    let height = &script.constants[1];
    assert_eq!(height.label.as_deref(), Some("Ground/Height // depth [m]"));
    assert_eq!(height.max.as_ref().map(ToString::to_string).as_deref(), Some("3"));
}

#[test]
fn unknown_parameters_and_values_out_of_bounds_are_refused_with_what_exists() {
    let place = Place::new("parameters");
    let refusal = |name: &str, value: f64| place.ensure(&[(name, value)], never).unwrap_err().to_string();
    let sentence = refusal("widht", 3.0);
    assert!(sentence.contains("box.geo has no constant \"widht\", did you mean \"width\"?"), "{sentence}");
    assert!(sentence.contains("It has: width = 2, height = 1.5, order = 1, half = width/2, size = 0.5"), "{sentence}");
    let sentence = refusal("commented", 1.0);
    assert!(sentence.contains("box.geo has no constant \"commented\". It has: width = 2"), "{sentence}");
    let sentence = refusal("width", 0.5);
    assert!(sentence.contains("width = 0.5 is out of bounds"), "{sentence}");
    assert!(sentence.contains("width (\"Ground/Width [m]\") must lie between 1 and 10"), "{sentence}");
    assert!(refusal("height", 3.1).contains("must be at most 3"));
    assert!(refusal("size", f64::NAN).contains("must be a finite number"));
}

#[test]
fn broken_scripts_do_not_stop_the_parser() {
    let place = Place::new("broken");
    let file = place.path("broken.geo");
    for end in 0..SCRIPT.len() {
        std::fs::write(&file, &SCRIPT.as_bytes()[..end]).unwrap();
        Script::read(&file).unwrap();
    }
    for text in [
        "DefineConstant[",
        "DefineConstant[=",
        "DefineConstant[a",
        "DefineConstant[a=",
        "DefineConstant[a={",
        "DefineConstant[a={,}]",
        "Include",
        "Merge(",
        "DefineConstant[]]",
        "a\"",
        "DefineConstant[a~{i}={1}]",
        "1e+",
        ".",
    ] {
        std::fs::write(&file, text).unwrap();
        Script::read(&file).unwrap();
    }
    std::fs::write(&file, "Include \"broken.geo\"; DefineConstant[ a = 1, b = a == 1 ? 2 : 3 ];").unwrap();
    assert_eq!(Script::read(&file).unwrap().constants.len(), 2, "a file that includes itself is read once");
}

// ---- where gmsh is ----------------------------------------------------------------------------------------------

#[test]
fn gmsh_is_taken_from_the_variable_then_the_path_then_a_venv_above() {
    let place = Place::new("find");
    let fake = place.fake("exit 0");
    let bin = place.path("bin");
    let by_path = Gmsh::find_in(None, Some(bin.as_os_str()), &[]).unwrap();
    assert_eq!(by_path, Gmsh::find_in(Some(fake.as_os_str()), None, &[]).unwrap());
    assert_eq!(by_path, Gmsh::find_in(Some(OsStr::new("gmsh")), Some(bin.as_os_str()), &[]).unwrap());

    std::fs::create_dir_all(place.path(".venv/bin")).unwrap();
    std::fs::create_dir_all(place.path("geo/deep")).unwrap();
    std::fs::rename(&fake, place.path(".venv/bin/gmsh")).unwrap();
    let found = Gmsh::find_in(None, Some(bin.as_os_str()), &[&place.path("geo/deep")]).unwrap();
    assert_eq!(found.command().get_program(), place.path(".venv/bin/gmsh"));

    let none = Gmsh::find_in(None, Some(bin.as_os_str()), &[Path::new("/")]).unwrap_err().to_string();
    for word in ["scripts/setup.sh", "pip install gmsh", "apt-get install gmsh", "CORALPIPE_GMSH"] {
        assert!(none.contains(word), "{none}");
    }
    let wrong = Gmsh::find_in(Some(OsStr::new("/no/such/gmsh")), Some(bin.as_os_str()), &[]).unwrap_err().to_string();
    assert!(wrong.starts_with("CORALPIPE_GMSH is \"/no/such/gmsh\", but there is no such program"), "{wrong}");
    assert!(wrong.contains("set it to the path of gmsh, or unset it"), "{wrong}");
}

#[test]
fn the_python_script_of_pip_is_run_by_the_python_beside_it() {
    let place = Place::new("python");
    let fake = place.fake("");
    std::fs::write(&fake, "#!/usr/bin/env python\nimport gmsh\n").unwrap();
    let python = place.path("bin/python");
    std::fs::write(&python, format!("#!/bin/sh\nfor OUT; do :; done\n{}", writes_mesh())).unwrap();
    std::fs::set_permissions(&python, std::fs::Permissions::from_mode(0o755)).unwrap();
    let meshing = place.ensure(&[], || Gmsh::find_in(Some(fake.as_os_str()), None, &[])).unwrap();
    assert_eq!(meshing.gmsh, "9.8.7");
}

// ---- what gmsh does ---------------------------------------------------------------------------------------------

#[test]
fn gmsh_gets_the_script_the_given_parameters_and_a_temporary_name() {
    let place = Place::new("arguments");
    place.ensure_by_fake(&[("width", 3.25), ("offset", -1e-7)], &writes_mesh()).unwrap();
    let arguments = std::fs::read_to_string(place.path("arguments")).unwrap();
    let geo = place.path("box.geo");
    let wanted = format!(
        "-2 {} -setnumber General.AbortOnError 4 -setnumber offset -0.0000001 -setnumber width 3.25 -format msh41 -nt 1 -o ",
        geo.display()
    );
    assert!(arguments.starts_with(&wanted), "{arguments}");
    assert_eq!(place.files(), ["box.json", "box.msh"]);
}

#[test]
fn a_mesh_survives_every_way_gmsh_can_fail() {
    let place = Place::new("failures");
    let meshing = place.ensure_by_fake(&[], &writes_mesh()).unwrap();
    let before = std::fs::read(&meshing.mesh).unwrap();
    let script = place.path("box.geo").display().to_string();
    let empty = "printf '$MeshFormat\\n4.1 0 8\\n$EndMeshFormat\\n$Entities\\n0 0 0 0\\n$EndEntities\\n' > \"$OUT\"";
    let report = format!(
        "echo \"Error   : '{script}', line 6: syntax error\" >&2\necho 'Error   : too deep' >&2\n{}",
        writes_mesh()
    );
    let cases = [
        (report.as_str(), format!("gmsh could not mesh {script}: 'box.geo', line 6: syntax error; too deep")),
        ("echo \"Info    : Running 'gmsh'\"; kill -SEGV $$", "gmsh broke off while it meshed".into()),
        (
            "echo 'ImportError: libGLU.so.1' >&2; exit 1",
            "does not run (exit status: 1): ImportError: libGLU.so.1".into(),
        ),
        ("exit 0", "gmsh made no usable mesh".into()),
        ("rm \"$OUT\"", "gmsh made no usable mesh".into()),
        (empty, "box.msh is empty".into()),
        ("echo 'Warning : no surface' >&2; echo half > \"$OUT\"", "this is no Gmsh mesh".into()),
        ("echo 'Warning : no surface' >&2; echo half > \"$OUT\"", "gmsh warned: no surface".into()),
    ];
    for (body, wanted) in cases {
        let sentence = place.ensure_by_fake(&[("width", 3.0)], body).unwrap_err().to_string();
        assert!(sentence.contains(&wanted), "{sentence}\n  should say: {wanted}");
        assert_eq!(std::fs::read(&meshing.mesh).unwrap(), before, "{body}");
        assert_eq!(place.files(), ["box.json", "box.msh"], "{body}");
    }
    // gmsh 4.15 closes with a count of what it has said
    let lines = [
        "no surface",
        "-----",
        "Mesh generation error summary",
        "    1 warning",
        "    0 errors",
        "Check the full log for details",
    ];
    let said: String = lines.iter().map(|line| format!("echo 'Warning : {line}' >&2; ")).collect();
    let sentence = place.ensure_by_fake(&[("width", 3.0)], &(said + "echo half > \"$OUT\"")).unwrap_err().to_string();
    assert!(sentence.ends_with("gmsh warned: no surface"), "{sentence}");
    let no_gmsh = || Gmsh::find_in(None, None, &[]);
    let sentence = place.ensure(&[("width", 3.0)], no_gmsh).unwrap_err().to_string();
    assert!(sentence.contains("(width was 2.0, is 3.0), but no gmsh command was found"), "{sentence}");
    assert_eq!(place.ensure(&[], never).unwrap().outcome, Outcome::Unchanged, "the old record still holds");
}

#[test]
fn a_program_that_cannot_be_started_is_a_sentence() {
    let place = Place::new("not_a_program");
    std::fs::write(place.path("bin/gmsh"), "#!/no/such/shell\n").unwrap();
    std::fs::set_permissions(place.path("bin/gmsh"), std::fs::Permissions::from_mode(0o755)).unwrap();
    let file = place.path("bin/gmsh");
    let sentence = place.ensure(&[], || Gmsh::find_in(Some(file.as_os_str()), None, &[])).unwrap_err().to_string();
    assert!(sentence.contains("bin/gmsh does not run: "), "{sentence}");
}

#[test]
fn a_mesh_is_made_again_exactly_when_script_included_file_parameter_or_mesh_changed() {
    let place = Place::new("record");
    let again = |parameters: &[(&str, f64)]| place.ensure_by_fake(parameters, &writes_mesh()).unwrap();
    assert_eq!(reason(&again(&[])), "there was no mesh");
    assert_eq!(place.ensure(&[], never).unwrap().outcome, Outcome::Unchanged);
    assert_eq!(place.ensure(&[("width", 2.0)], never).unwrap().outcome, Outcome::Unchanged, "2 is the default");
    assert_eq!(reason(&again(&[("width", 3.0)])), "width was 2.0, is 3.0");
    assert_eq!(place.ensure(&[("width", 3.0)], never).unwrap().gmsh, "9.8.7");
    assert_eq!(reason(&again(&[])), "width was 3.0, is 2.0");

    std::fs::write(place.path("shared.geo"), format!("{SHARED}//")).unwrap();
    assert_eq!(reason(&again(&[])), "shared.geo has changed");
    std::fs::write(place.path("box.geo"), format!("{SCRIPT}//")).unwrap();
    assert_eq!(reason(&again(&[])), "the script has changed");
    std::fs::write(place.path("meshes/box.msh"), format!("{MESH}\n")).unwrap();
    assert_eq!(reason(&again(&[])), "the mesh is not the one that was recorded");
    std::fs::remove_file(place.path("meshes/box.json")).unwrap();
    assert!(reason(&again(&[])).contains("box.json of what the mesh was made from"));
    std::fs::remove_file(place.path("meshes/box.msh")).unwrap();
    assert_eq!(reason(&again(&[])), "there was no mesh");
    assert_eq!(place.ensure(&[], never).unwrap().outcome, Outcome::Unchanged);
}

#[test]
fn a_case_file_in_the_place_of_the_record_is_not_written_over() {
    let place = Place::new("case_file");
    std::fs::create_dir(place.path("meshes")).unwrap();
    std::fs::write(place.path("meshes/box.json"), "{\"title\": \"a case\"}").unwrap();
    let sentence = place.ensure(&[], never).unwrap_err().to_string();
    assert!(sentence.contains("box.json stands where the record of the mesh belongs"), "{sentence}");
}

#[test]
fn parameters_of_17_digits_and_of_any_size_are_recognised_again() {
    let place = Place::new("digits");
    for value in [0.1 + 0.2, 1.0 / 3.0, 1e-300, 123_456_789.123_456_79, 5e22] {
        assert!(is_made(&place.ensure_by_fake(&[("size", value)], &writes_mesh()).unwrap()));
        assert_eq!(place.ensure(&[("size", value)], never).unwrap().outcome, Outcome::Unchanged, "{value}");
    }
}

#[test]
fn the_record_names_script_every_parameter_gmsh_and_the_hashes() {
    let place = Place::new("names");
    place.ensure_by_fake(&[("width", 3.0)], &writes_mesh()).unwrap();
    let record: serde_json::Value =
        serde_json::from_slice(&std::fs::read(place.path("meshes/box.json")).unwrap()).unwrap();
    assert_eq!((&record["script"], &record["gmsh"]), (&"box.geo".into(), &"9.8.7".into()));
    assert_eq!((&record["parameters"]["width"], &record["parameters"]["half"]), (&3.0.into(), &"width/2".into()));
    assert_eq!(record["parameters"].as_object().unwrap().len(), 8);
    // as `sha256sum` has it
    let files = &record["files"];
    let hashes = [(&record["script_sha256"], SCRIPT), (&files["shared.geo"], SHARED), (&record["mesh_sha256"], MESH)];
    for (hash, bytes) in hashes {
        use sha2::Digest;
        let wanted: String = sha2::Sha256::digest(bytes.as_bytes()).iter().map(|b| format!("{b:02x}")).collect();
        assert_eq!(*hash, wanted, "{bytes}");
    }
    assert!(files["box.geo.opt"].is_null() && files["shared.geo.opt"].is_null() && files.get("~/.gmshrc").is_some());
    assert!(record.get("doubts").is_none(), "{record}");
}

#[test]
fn a_folder_that_cannot_be_written_to_is_named() {
    let place = Place::new("writable");
    // a file where the folder should be: not even root can write there
    std::fs::write(place.path("meshes"), "").unwrap();
    let sentence = place.ensure_by_fake(&[], &writes_mesh()).unwrap_err().to_string();
    assert!(sentence.contains("writable/meshes cannot be written to: "), "{sentence}");
    assert!(sentence.contains("--mesh FILE.msh"), "{sentence}");
    assert!(!place.path("arguments").exists(), "gmsh is not started in vain");
    let missing = ensure_mesh_with(&place.path("no.geo"), &BTreeMap::new(), &place.path("x.msh"), never).unwrap_err();
    assert!(missing.to_string().contains("no.geo cannot be read"), "{missing}");
}

// ---- gmsh itself ------------------------------------------------------------------------------------------------

#[test]
fn gmsh_itself_makes_the_mesh_that_was_asked_for() {
    let Some(gmsh) = real_gmsh() else { return };
    let place = Place::new("real");
    let meshing = place.ensure(&[("width", 4.0), ("offset", 0.5)], || Ok(gmsh.clone())).unwrap();
    assert!(is_made(&meshing) && meshing.gmsh.starts_with(|c: char| c.is_ascii_digit()), "{meshing}");
    let mesh = Mesh::read(&meshing.mesh).unwrap();
    let measure = |name: &str| mesh.measure_of(mesh.group(name).unwrap());
    assert!((measure("ground") - 6.0).abs() < 1e-12 && (measure("base") - 4.0).abs() < 1e-12);
    assert_eq!(place.ensure(&[("width", 4.0), ("offset", 0.5)], never).unwrap().outcome, Outcome::Unchanged);

    let before = std::fs::read(&meshing.mesh).unwrap();
    let sentence = |width: f64| place.ensure(&[("width", width)], || Ok(gmsh.clone())).unwrap_err().to_string();
    let unlucky = sentence(7.0);
    assert!(unlucky.ends_with("box.geo: width 7 is unlucky"), "{unlucky}");
    assert!(sentence(9.0).contains("box.msh is empty"), "a script that makes nothing");
    assert_eq!(std::fs::read(&meshing.mesh).unwrap(), before);
    match place.ensure(&[("width", 8.0)], || Ok(gmsh.clone())).unwrap().outcome {
        Outcome::Made { warnings, .. } => assert_eq!(warnings, ["width 8 is odd"]),
        outcome => panic!("the width has changed: {outcome:?}"),
    }
    std::fs::write(place.path("box.geo"), "DefineConstant[ a = 1 ];\nPoint(1) = {0, 0\n").unwrap();
    let syntax = place.ensure(&[], || Ok(gmsh.clone())).unwrap_err().to_string();
    assert!(syntax.contains("box.geo: 'box.geo', line "), "{syntax}");
    assert_eq!(place.files(), ["box.json", "box.msh"]);
}

// ---- all that gmsh reads ----------------------------------------------------------------------------------------

/// A rectangle a x 2 m; what is before it gives `a`.
const RECTANGLE: &str = "Point(1)={0,0,0,1}; Point(2)={a,0,0,1}; Point(3)={a,2,0,1}; Point(4)={0,2,0,1};
Line(1)={1,2}; Line(2)={2,3}; Line(3)={3,4}; Line(4)={4,1}; Curve Loop(1)={1,2,3,4}; Plane Surface(1)={1};
Physical Surface(\"soil\")={1};\n";

type Text = (&'static str, &'static str);

/// A way in which a mesh can depend on a file beside its script.
struct Kind {
    name: &'static str,
    /// what the script has before the rectangle; `HERE` is its folder
    head: &'static str,
    /// name and content
    files: &'static [Text],
    /// the file that widens the rectangle from 3 to 6 m
    edit: Text,
}

const fn kind(name: &'static str, head: &'static str, files: &'static [Text], edit: Text) -> Kind {
    Kind { name, head, files, edit }
}

impl Kind {
    /// The script, the files and the mesh of 6 m2.
    fn draw(&self, gmsh: &Gmsh) -> Place {
        let place = Place::new(&format!("kind-{}", self.name));
        let here = |text: &str| text.replace("HERE", &place.0.display().to_string());
        std::fs::write(place.path("box.geo"), here(self.head) + "\n" + RECTANGLE).unwrap();
        std::fs::create_dir(place.path("sub")).unwrap();
        for (file, content) in self.files {
            std::fs::write(place.path(file), here(content)).unwrap();
        }
        let made = made(&place, gmsh);
        assert!((area(&made) - 6.).abs() < 1e-12, "{}: {}", self.name, area(&made));
        place
    }

    /// The edit is noticed; returns why the mesh was made again.
    fn edit(&self, place: &Place, gmsh: &Gmsh) -> String {
        std::fs::write(place.path(self.edit.0), self.edit.1).unwrap();
        let made = made(place, gmsh);
        assert!((area(&made) - 12.).abs() < 1e-12, "{}: {} in {made}", self.name, area(&made));
        reason(&made).into()
    }
}

fn made(place: &Place, gmsh: &Gmsh) -> Meshing {
    place.ensure(&[], || Ok(gmsh.clone())).unwrap()
}

fn area(meshing: &Meshing) -> f64 {
    let mesh = Mesh::read(&meshing.mesh).unwrap();
    mesh.measure_of(mesh.group("soil").unwrap())
}

fn nodes(meshing: &Meshing) -> usize {
    Mesh::read(&meshing.mesh).unwrap().points.len()
}

const THREE: Text = ("a.dat", "a = 3;");
const SIX: Text = ("a.dat", "a = 6;");
const SUB_THREE: Text = ("sub/a.dat", "a = 3;");
const SUB_SIX: Text = ("sub/a.dat", "a = 6;");

/// Files that gmsh reports to read, under whatever name the script composes, or that the script names: gmsh is not
/// started while they stay as they are.
#[test]
fn a_mesh_is_made_again_when_a_file_changes_that_gmsh_has_read() {
    let Some(gmsh) = real_gmsh() else { return };
    let kinds = [
        kind("nested", "Include \"b.dat\";", &[("b.dat", "Include \"a.dat\";"), THREE], SIX),
        kind("nested-in-folder", "Include \"sub/b.dat\";", &[("sub/b.dat", "Include \"a.dat\";"), SUB_THREE], SUB_SIX),
        kind("single-quotes", "Include/* \" */'b.geo';", &[("b.geo", "Include // it's\n 'a.dat';"), THREE], SIX),
        kind("joined", "Include StrCat(\"sub/\", \"a\", \".dat\");", &[SUB_THREE], SUB_SIX),
        kind("printed", "n=7; Include Sprintf(\"%g.dat\", n);", &[("7.dat", "a = 3;")], ("7.dat", "a = 6;")),
        kind("variable", "s = \"a.dat\"; Include Str(s);", &[THREE], SIX),
        kind("absolute", "Include \"HERE/sub/a.dat\";", &[SUB_THREE], SUB_SIX),
        kind("macro", "Include 'm.geo';\nCall f;", &[("m.geo", "Macro f\nInclude 'a.dat';\nReturn\n"), THREE], SIX),
        kind("merged", "Merge StrCat(\"a\", \".geo\");", &[("a.geo", "a = 3;")], ("a.geo", "a = 6;")),
        kind("merged-empty", "a = 3; Merge \"a.geo\";", &[("a.geo", "")], ("a.geo", "a = 6;")),
        kind("list", "l() = ListFromFile(\"a.dat\"); a = l(0);", &[("a.dat", "3")], ("a.dat", "6")),
        kind("silent", "General.Verbosity = 0; Include \"b.dat\";", &[("b.dat", "Include 'a.dat';"), THREE], SIX),
        kind("terminal", "General.Terminal = 0; Include \"a.dat\";", &[THREE], SIX),
    ];
    for kind in &kinds {
        let place = kind.draw(&gmsh);
        assert_eq!(place.ensure(&[], never).unwrap().outcome, Outcome::Unchanged, "{}", kind.name);
        let reason = kind.edit(&place, &gmsh);
        assert_eq!(reason, format!("{} has changed", kind.edit.0), "{}", kind.name);
        assert_eq!(place.ensure(&[], never).unwrap().outcome, Outcome::Unchanged, "{}", kind.name);
    }
}

/// What neither gmsh reports nor the script names: the mesh is made every time, and the reason says why. Without gmsh it
/// is used, with a warning.
#[test]
fn a_mesh_is_made_every_time_where_gmsh_does_not_report_what_it_depends_on() {
    let Some(gmsh) = real_gmsh() else { return };
    const COPIES: &str = "SystemCall \"cp 'HERE/a.dat' 'HERE/copy.dat'\"; Include \"copy.dat\";";
    const EXISTS: &str = "If (FileExists(\"HERE/flag\")) a = 6; Else a = 3; EndIf\n";
    let list = "l() = ListFromFile(StrCat(\"a\", \".dat\")); a = l(0);";
    let silent = "General.Verbosity = 0; Include StrCat(\"a\", \".dat\");";
    let nested = "Include Sprintf(\"%g.geo\", 1);";
    let kinds = [
        (kind("command", COPIES, &[THREE], SIX), "what box.geo reads by SystemCall is not recorded"),
        (kind("exists", EXISTS, &[], ("flag", "")), "what box.geo reads by FileExists is not recorded"),
        (kind("joined-list", list, &[("a.dat", "3")], ("a.dat", "6")), "by ListFromFile"),
        (kind("silent-joined", silent, &[THREE], SIX), "by Include"),
        (kind("inside", nested, &[("1.geo", EXISTS)], ("flag", "")), "what 1.geo reads by FileExists is not recorded"),
        (kind("environment", "a = 3; s = GetEnv(\"HOME\");", &[], ("box.geo", "")), "by GetEnv"),
    ];
    for (kind, says) in &kinds {
        let place = kind.draw(&gmsh);
        let again = made(&place, &gmsh);
        assert!(reason(&again).contains(says), "{}: {again}", kind.name);
        assert!(reason(&again).ends_with("; the new mesh equals the old one"), "{}: {again}", kind.name);
        let without = place.ensure(&[], || Gmsh::find_in(None, None, &[])).unwrap();
        assert!(matches!(&without.outcome, Outcome::Unchecked { reason } if reason.contains(says)), "{without}");
        if kind.edit.0 != "box.geo" {
            kind.edit(&place, &gmsh);
        }
    }
}

/// Shapes that gmsh itself has written, 3 and 6 m wide, read from a BREP and a STEP file.
#[test]
fn a_mesh_is_made_again_when_a_shape_changes_that_it_is_made_from() {
    let Some(gmsh) = real_gmsh() else { return };
    for (reads, file) in
        [("v() = ShapeFromFile(\"shape.brep\");", "shape.brep"), ("Merge StrCat(\"sha\", \"pe.step\");", "shape.step")]
    {
        let place = Place::new(file);
        let draw = |a: f64| {
            let text = format!("SetFactory(\"OpenCASCADE\"); Rectangle(1) = {{0, 0, 0, {a}, 2}};\n");
            std::fs::write(place.path("draw.geo"), text).unwrap();
            let drawn = gmsh.command().arg("-0").arg(place.path("draw.geo")).arg("-o").arg(place.path(file)).output();
            assert!(drawn.unwrap().status.success());
        };
        let script = format!("SetFactory(\"OpenCASCADE\");\n{reads}\nPhysical Surface(\"soil\") = {{Surface{{:}}}};\n");
        std::fs::write(place.path("box.geo"), script).unwrap();
        draw(3.);
        // STEP files keep millimetres, and about 1e-7 of a length
        let first = area(&made(&place, &gmsh));
        assert_eq!(place.ensure(&[], never).unwrap().outcome, Outcome::Unchanged, "{file}");
        draw(6.);
        let after = made(&place, &gmsh);
        assert_eq!(reason(&after), format!("{file} has changed"));
        assert!((area(&after) / first - 2.).abs() < 1e-6, "{file}: {first}, then {}", area(&after));
    }
}

/// `SCRIPT.geo.opt`, which gmsh's window writes, and sizes of a background field: 18 triangles become many.
#[test]
fn a_mesh_is_made_again_when_an_options_file_or_a_file_of_sizes_appears_changes_or_goes() {
    let Some(gmsh) = real_gmsh() else { return };
    let place = kind("options", "a = 3;", &[], ("", "")).draw(&gmsh);
    let coarse = nodes(&place.ensure(&[], never).unwrap());
    let steps = [
        (Some("Mesh.MeshSizeFactor = 0.3;"), "box.geo.opt is new"),
        (Some("Mesh.MeshSizeFactor = 0.2;"), "box.geo.opt has changed"),
        (None, "box.geo.opt is gone"),
    ];
    let mut counts = vec![coarse];
    for (content, says) in steps {
        match content {
            Some(content) => std::fs::write(place.path("box.geo.opt"), content).unwrap(),
            None => std::fs::remove_file(place.path("box.geo.opt")).unwrap(),
        }
        let after = made(&place, &gmsh);
        assert_eq!(reason(&after), says);
        counts.push(nodes(&after));
        assert_eq!(place.ensure(&[], never).unwrap().outcome, Outcome::Unchanged, "{says}");
    }
    assert!(counts[1] > 4 * counts[0] && counts[2] > counts[1] && counts[3] == counts[0], "{counts:?}");

    let field = "a = 3; Field[1] = Structured; Field[1].TextFormat = 1; Field[1].FileName = \"HERE/sizes.txt\"; Background Field = 1;";
    let place = kind("sizes", field, &[("sizes.txt", "0 0 0\n9 9 9\n2 2 2\n1 1 1 1 1 1 1 1\n")], ("", "")).draw(&gmsh);
    let coarse = nodes(&made(&place, &gmsh));
    std::fs::write(place.path("sizes.txt"), "0 0 0\n9 9 9\n2 2 2\n.2 .2 .2 .2 .2 .2 .2 .2\n").unwrap();
    let fine = made(&place, &gmsh);
    assert!(reason(&fine).contains("what box.geo reads by FileName is not recorded"), "{fine}");
    assert!(nodes(&fine) > 4 * coarse, "{coarse}, then {}", nodes(&fine));
}

/// `.gmshrc` and `.gmsh-options` in the folder that gmsh takes for the user's home, read at every start of gmsh. Who has
/// no gmsh can use a mesh that was made without them.
#[test]
fn a_mesh_is_made_again_when_personal_options_of_gmsh_appear_change_or_go() {
    let Some(gmsh) = real_gmsh() else { return };
    let place = kind("personal", "a = 3;", &[], ("", "")).draw(&gmsh);
    let soil = r#"{ "soil": { "young": "1 GPa", "poisson": 0.3, "density": 2000 } }"#;
    let case = format!(
        r#"{{ "geometry": {{ "script": "box.geo" }}, "materials": {soil}, "time": {{ "step": 1e-3, "end": 1 }} }}"#
    );
    std::fs::write(place.path("box.json"), case).unwrap();
    let home = place.path("home");
    std::fs::create_dir(&home).unwrap();
    let told = |gmsh: Option<&Gmsh>| {
        let mut program = Command::new(env!("CARGO_BIN_EXE_coralpipe"));
        program.args(["mesh", "box.json"]).current_dir(&place.0).env("HOME", &home).env_remove("GMSH_HOME");
        // the command itself, or the script of pip that the python beside it runs
        let file = |gmsh: &Gmsh| {
            let command = gmsh.command();
            command.get_args().next().unwrap_or(command.get_program()).to_owned()
        };
        match gmsh.map(file) {
            Some(file) => program.env("CORALPIPE_GMSH", file),
            None => program.env("CORALPIPE_GMSH", "/no/such/gmsh"),
        };
        let output = program.output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(output.stdout).unwrap()
    };
    let count = || Mesh::read(&place.path("meshes/box.msh")).unwrap().points.len();
    told(Some(&gmsh));
    let coarse = count();
    for (file, content, says) in [
        (".gmshrc", Some("Mesh.MeshSizeFactor = 0.3;"), "(~/.gmshrc is new"),
        (".gmsh-options", Some("Mesh.MeshSizeFactor = 0.2;"), "(~/.gmsh-options is new"),
        (".gmshrc", Some("// nothing"), "(~/.gmshrc has changed"),
        (".gmsh-options", None, "(~/.gmsh-options is gone"),
    ] {
        match content {
            Some(content) => std::fs::write(home.join(file), content).unwrap(),
            None => std::fs::remove_file(home.join(file)).unwrap(),
        }
        let sentence = told(Some(&gmsh));
        assert!(sentence.contains(says), "{sentence}");
        assert_eq!(count() > 4 * coarse, content.is_some(), "{says}");
        assert!(told(Some(&gmsh)).contains("is taken as it is"), "{says}");
    }
    std::fs::write(home.join(".gmshrc"), "Mesh.MeshSizeFactor = 0.3;").unwrap();
    let sentence = told(None);
    assert!(sentence.contains("there is no gmsh to make it again (~/.gmshrc has changed)"), "{sentence}");
}

#[test]
fn an_included_file_that_is_gone_is_named_and_the_mesh_stays() {
    let Some(gmsh) = real_gmsh() else { return };
    let place = kind("gone", "Include \"b.dat\";", &[("b.dat", "Include \"a.dat\";"), THREE], SIX).draw(&gmsh);
    let before = std::fs::read(place.path("meshes/box.msh")).unwrap();
    std::fs::remove_file(place.path("a.dat")).unwrap();
    let sentence = place.ensure(&[], || Ok(gmsh.clone())).unwrap_err().to_string();
    assert!(sentence.contains("a.dat"), "{sentence}");
    let sentence = place.ensure(&[], || Gmsh::find_in(None, None, &[])).unwrap_err().to_string();
    assert!(sentence.contains("(a.dat is gone)"), "{sentence}");
    assert_eq!(std::fs::read(place.path("meshes/box.msh")).unwrap(), before);
    std::fs::write(place.path("a.dat"), "a = 3;").unwrap();
    assert_eq!(place.ensure(&[], never).unwrap().outcome, Outcome::Unchanged, "the file is back");
}

/// Whichever of its contents gmsh has seen, the next command makes the mesh again.
#[test]
fn a_file_that_changes_while_gmsh_runs_is_not_trusted() {
    let place = Place::new("meanwhile");
    let shared = place.path("shared.geo").display().to_string();
    // file systems keep times to a tick of the kernel, 10 ms at most
    let during = format!("sleep 0.05\necho '// more' >> '{shared}'\n{}", writes_mesh());
    place.ensure_by_fake(&[], &during).unwrap();
    assert!(reason(&place.ensure_by_fake(&[], &writes_mesh()).unwrap()).contains("shared.geo changed while gmsh ran"));
    assert_eq!(place.ensure(&[], never).unwrap().outcome, Outcome::Unchanged);
    let script = format!("echo '// more' >> '{}'\n{}", place.path("box.geo").display(), writes_mesh());
    place.ensure_by_fake(&[("width", 3.)], &script).unwrap();
    assert_eq!(reason(&place.ensure_by_fake(&[("width", 3.)], &writes_mesh()).unwrap()), "the script has changed");
}

/// The file that the record calls `shared.geo` is the one beside the script that is asked for.
#[test]
fn scripts_of_one_name_in_two_folders_are_told_apart_by_what_they_include() {
    let place = Place::new("folders");
    std::fs::create_dir(place.path("other")).unwrap();
    std::fs::write(place.path("other/box.geo"), SCRIPT).unwrap();
    std::fs::write(place.path("other/shared.geo"), format!("{SHARED}//")).unwrap();
    place.ensure_by_fake(&[], &writes_mesh()).unwrap();
    let fake = place.fake(&writes_mesh());
    let find = || Gmsh::find_in(Some(fake.as_os_str()), None, &[]);
    let other = ensure_mesh_with(&place.path("other/box.geo"), &BTreeMap::new(), &place.path("meshes/box.msh"), find);
    assert_eq!(reason(&other.unwrap()), "shared.geo has changed");
}

/// A record of an earlier version lists no files; a power cut can leave a record empty, of zeros, or cut off.
#[test]
fn records_that_do_not_say_enough_lead_to_a_new_mesh() {
    let place = Place::new("old_records");
    place.ensure_by_fake(&[], &writes_mesh()).unwrap();
    let file = place.path("meshes/box.json");
    let text = std::fs::read_to_string(&file).unwrap();
    let mut old: serde_json::Value = serde_json::from_str(&text).unwrap();
    old.as_object_mut().unwrap().remove("files");
    std::fs::write(&file, old.to_string()).unwrap();
    let unchecked = place.ensure(&[], || Gmsh::find_in(None, None, &[])).unwrap();
    assert!(
        unchecked.to_string().contains("no gmsh to make it again (the record does not list the files"),
        "{unchecked}"
    );
    assert!(is_made(&place.ensure_by_fake(&[], &writes_mesh()).unwrap()));
    for cut in [String::new(), "\0".repeat(text.len()), text[..text.len() / 2].into(), text[..20].into()] {
        std::fs::write(&file, &cut).unwrap();
        assert!(reason(&place.ensure_by_fake(&[], &writes_mesh()).unwrap()).contains("no record"), "{cut:?}");
        assert_eq!(std::fs::read_to_string(&file).unwrap(), text, "{cut:?}");
    }
}

// ---- accidents --------------------------------------------------------------------------------------------------

/// A process that writes one has it locked.
#[test]
fn what_a_killed_meshing_left_is_cleared_but_not_what_another_process_writes() {
    let place = Place::new("leftovers");
    std::fs::create_dir(place.path("meshes")).unwrap();
    let left = [".box.msh.4711", ".box.json.4711", ".other_a3.msh.1", ".box.orders.99999999.part"];
    let kept = [".box.msh", ".msh.1", "box.msh.1", ".box.msh.1a", ".box.step.12"];
    for name in left.iter().chain(&kept) {
        std::fs::write(place.path("meshes").join(name), "half").unwrap();
    }
    let busy = std::fs::File::create(place.path("meshes/.box.msh.4712")).unwrap();
    busy.lock().unwrap();
    place.ensure_by_fake(&[], &writes_mesh()).unwrap();
    let mut wanted: Vec<&str> = kept.iter().copied().chain([".box.msh.4712", "box.json", "box.msh"]).collect();
    wanted.sort_unstable();
    assert_eq!(place.files(), wanted);
    drop(busy);
    assert_eq!(place.ensure(&[], never).unwrap().outcome, Outcome::Unchanged);
    assert!(!place.files().contains(&".box.msh.4712".to_string()));
}

/// Files may have so many blocks of 1024 bytes, as under a quota.
#[test]
fn a_mesh_that_does_not_fit_is_told_from_one_that_gmsh_spoiled() {
    let place = Place::new("no_room");
    std::fs::create_dir(place.path("meshes")).unwrap();
    let mount = ["-t", "tmpfs", "-o", "size=64k", "coralpipe-test"];
    let mounted = Command::new("mount").args(mount).arg(place.path("meshes")).stderr(Stdio::null()).status();
    if !mounted.is_ok_and(|status| status.success()) {
        eprintln!("\n*** SKIPPED: only root can mount a small disk ***\n");
        return;
    }
    // as gmsh, which writes on and ends without an error, so that the mesh is cut off; then a disk that is full before
    let unfinished = writes_mesh().replace("$EndElements\\n", "");
    let long = format!("{unfinished}\nhead -c 200000 /dev/zero >> \"$OUT\" 2>/dev/null\nexit 0");
    let cut = place.ensure_by_fake(&[], &long).map_err(|e| e.to_string());
    let nothing = "cat /dev/zero > \"$OUT\" 2>/dev/null; : > \"$OUT\"; exit 0";
    let small = place.ensure_by_fake(&[], nothing).map_err(|e| e.to_string());
    let fits = place.ensure_by_fake(&[], &writes_mesh()).map_err(|e| e.to_string());
    let mounted = Mounted(place.path("meshes"));
    assert!(fits.is_ok(), "{cut:?}, {small:?}, {fits:?}");
    // else the old ones make room for the new ones
    for file in ["box.msh", "box.json"] {
        std::fs::remove_file(place.path("meshes").join(file)).unwrap();
    }
    let fill = format!("cat /dev/zero > '{}' 2>/dev/null", place.path("meshes/filler").display());
    let record = place.ensure_by_fake(&[("width", 3.)], &format!("{}\n{fill}\nexit 0", writes_mesh()));
    let record = record.map_err(|e| e.to_string());
    let files = place.files();
    drop(mounted);
    for full in [&cut, &record] {
        let sentence = full.as_ref().unwrap_err();
        assert!(sentence.starts_with("the disk is full: the mesh does not fit into "), "{sentence}");
        assert!(sentence.contains("no_room/meshes") && sentence.contains("free some space"), "{sentence}");
    }
    assert!(small.as_ref().unwrap_err().contains("wrote nothing"), "{small:?}");
    assert!(files.iter().all(|name| !name.starts_with('.')), "{files:?}");
}
