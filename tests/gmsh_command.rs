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
    assert_eq!(reason(&again(&[])), "the script has changed");
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
    // as `cat box.geo shared.geo | sha256sum` has it
    for (hash, bytes) in [("script_sha256", format!("{SCRIPT}{SHARED}")), ("mesh_sha256", MESH.into())] {
        use sha2::Digest;
        let wanted: String = sha2::Sha256::digest(bytes.as_bytes()).iter().map(|b| format!("{b:02x}")).collect();
        assert_eq!(record[hash], wanted, "{hash}");
    }
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
        Outcome::Unchanged => panic!("the width has changed"),
    }
    std::fs::write(place.path("box.geo"), "DefineConstant[ a = 1 ];\nPoint(1) = {0, 0\n").unwrap();
    let syntax = place.ensure(&[], || Ok(gmsh.clone())).unwrap_err().to_string();
    assert!(syntax.contains("box.geo: 'box.geo', line "), "{syntax}");
    assert_eq!(place.files(), ["box.json", "box.msh"]);
}
