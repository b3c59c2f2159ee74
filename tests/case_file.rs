//! The case file: what it means, and the sentence for everything that can be wrong in it.

use std::path::{Path, PathBuf};

use coralpipe::Error;
use coralpipe::model::case::{
    self, Axis, Case, Geometry, Integration, Load, Mass, MeshSource, MeshUnit, Pressure, Probe, Rayleigh, Start,
};
use coralpipe::physics::pulse::Pulse;
use serde_json::{Value, json};

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn default_case() -> PathBuf {
    root().join("geo/twin_pipes.json")
}

/// A folder of its own for each test, so that tests may run at once.
fn folder(test: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("coralpipe-case-{}-{test}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

fn read_text(test: &str, text: &str) -> Result<Case, Error> {
    let folder = folder(test);
    let file = folder.join("my case.json");
    std::fs::write(&file, text).unwrap();
    let case = Case::read(&file, &[]);
    std::fs::remove_dir_all(folder).unwrap();
    case
}

fn with(set: &str) -> Result<Case, Error> {
    Case::read(&default_case(), &[set.to_string()])
}

fn sentence(set: &str) -> String {
    match with(set) {
        Err(Error::Input(sentence)) => sentence,
        other => panic!("{set} must be refused as bad input, and gave {other:?}"),
    }
}

fn close(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-12 * b.abs()
}

/// Le Tan, the table of materials and the text around it: E [N/cm^2] * 1e4, rho [kg/cm^3] * 1e6.
#[test]
fn the_papers_case_reads_as_the_papers_numbers_in_si() {
    let case = Case::read(&default_case(), &[]).unwrap();
    for (group, young, poisson, density, friction) in [
        ("layer_1", 183e6, 0.46, 2200.0, Some(0.21)),
        ("layer_2", 519e6, 0.38, 2600.0, Some(0.32)),
        ("layer_3", 863e6, 0.27, 2700.0, Some(0.41)),
        ("pipe_left", 210e9, 0.30, 7800.0, None),
        ("pipe_right", 210e9, 0.30, 7800.0, None),
    ] {
        let material = case.materials[group];
        assert!(close(material.young.0, young) && close(material.density.0, density), "{group}: {material:?}");
        assert_eq!((material.poisson, material.friction), (poisson, friction), "{group}");
    }
    assert_eq!(case.materials.len(), 5);
    assert_eq!(case.interfaces.opened["interface_right"].body, "pipe_right");
    assert_eq!(case.interfaces.opened["interface_right"].thickness.0, 0.01);
    assert_eq!(case.supports["base"], [Axis::X, Axis::Y]);
    assert_eq!(case.supports["side_left"].iter().map(|axis| axis.index()).collect::<Vec<_>>(), [0]);
    let loads: Vec<_> = case.loads.iter().collect();
    assert_eq!(
        loads,
        [("surface", &Load::Pressure(Pressure::Simultaneous(Pulse::Linear { peak: 100e3, duration: 0.05 })))]
    );
    assert_eq!(case.damping.unwrap().rayleigh, Rayleigh::Ratio { ratio: 0.05, modes: [1, 2] });
    assert!(close(case.time.step.0, 1e-4) && close(case.time.end.0, 0.1) && close(case.frame_interval(), 1e-3));
    assert_eq!(case.probes.iter().map(Probe::name).collect::<Vec<_>>(), ["A", "C", "H", "K", "L", "I"]);
    assert_eq!(case.name(), "twin_pipes");
    let Some(Geometry { source: Some(MeshSource::Script { script, parameters }), .. }) = &case.geometry else {
        panic!("{:?}", case.geometry)
    };
    assert_eq!(case.resolve(script), root().join("geo/twin_pipes.geo"));
    assert_eq!(parameters["spacing"], 2.4);
}

#[test]
fn keys_left_out_take_the_defaults_of_the_design() {
    let text = r#"{ "materials": { "ground": { "young": 1e8, "poisson": 0.3, "density": 2000 } },
                    "interfaces": { "ring": { "body": "pipe" } },
                    "time": { "step": "0.1 ms", "end": "50 ms" } }"#;
    let case = read_text("defaults", text).unwrap();
    let ring = &case.interfaces.opened["ring"];
    assert_eq!((ring.thickness.0, ring.gap.0, ring.integration), (0.01, 0.0, Integration::Lobatto));
    assert_eq!((ring.friction, ring.normal_stiffness, ring.tangential_stiffness), (None, None, None));
    assert_eq!((case.mass, case.time.start), (Mass::Consistent, Start::Equilibrium));
    assert_eq!((case.time.newmark.alpha, case.time.newmark.delta), (0.25, 0.5));
    assert_eq!((case.newton.tolerance, case.newton.max_iterations), (1e-8, 30));
    assert_eq!((case.damping, case.geometry.is_none(), case.loads.iter().count()), (None, true, 0));
    assert!(close(case.frame_interval(), 5e-4), "a hundredth of the end");
}

#[test]
fn the_further_keys_of_the_design_are_read() {
    for (set, check) in [
        ("mass=lumped", (|c| c.mass == Mass::Lumped) as fn(&Case) -> bool),
        ("time.start=rest", |c| c.time.start == Start::Rest),
        ("time.newmark={\"alpha\":0.3025,\"delta\":0.6}", |c| c.time.newmark.alpha == 0.3025),
        ("newton.tolerance=1e-6", |c| c.newton.tolerance == 1e-6 && c.newton.max_iterations == 30),
        ("damping=null", |c| c.damping.is_none()),
        ("damping.interfaces=true", |c| c.damping.unwrap().interfaces),
        ("damping={\"alpha\":\"5 1/s\",\"beta\":\"0.5 ms\"}", |c| {
            c.damping.unwrap().rayleigh == Rayleigh::Coefficients { alpha: 5.0, beta: 5e-4 }
        }),
        ("interfaces.interface_left.integration=gauss_1", |c| {
            c.interfaces.opened["interface_left"].integration == Integration::Gauss1
        }),
        ("interfaces.interface_left.normal_stiffness=2 GPa/m", |c| {
            c.interfaces.opened["interface_left"].normal_stiffness.unwrap().0 == 2e9
        }),
        ("interfaces.interface_left.gap=2 mm", |c| c.interfaces.opened["interface_left"].gap.0 == 2e-3),
        ("geometry={\"mesh\":\"m.msh\"}", |c| {
            c.geometry == Some(Geometry { source: Some(MeshSource::Mesh("m.msh".into())), unit: MeshUnit::Metre })
        }),
        ("geometry.unit=ft", |c| c.mesh_unit() == MeshUnit::Foot && c.mesh_unit().length() == 0.3048),
        ("geometry={\"unit\":\"mm\"}", |c| c.geometry == Some(Geometry { source: None, unit: MeshUnit::Millimetre })),
        ("probes.0={\"name\":\"P\",\"at\":[1,\"50 cm\"],\"body\":\"layer_1\"}", |c| {
            c.probes[0] == Probe::Place { name: "P".into(), at: [1.0, 0.5], body: Some("layer_1".into()) }
        }),
        ("$schema=./case.schema.json", |c| c.title.starts_with("Two steel pipes")),
    ] {
        assert!(check(&with(set).unwrap()), "{set}");
    }
}

#[test]
fn loads_of_every_kind_and_law_are_read_alone_or_in_a_list() {
    let set = r#"loads=[
        { "surface": { "pressure": { "law": "step", "peak": "2 bar" } } },
        { "surface": { "traction": { "law": "step", "peak": "3 kPa", "direction": [3, -4] } },
          "layer_1": { "body_force": { "law": "step", "peak": "4 kN/m^3", "direction": [0, -1] } } },
        { "A": { "force": { "law": "table", "direction": [1, 0], "times": [0, "5 ms"], "values": [0, "6 kN/m"] } } }
    ]"#;
    let case = with(set).unwrap();
    let loads: Vec<_> = case.loads.iter().collect();
    assert_eq!(loads[0], ("surface", &Load::Pressure(Pressure::Simultaneous(Pulse::Step { peak: 2e5 }))));
    let Load::BodyForce(body_force) = loads[1].1 else { panic!("{loads:?}") };
    assert_eq!(body_force.pulse, Pulse::Step { peak: 4e3 });
    let Load::Traction(traction) = loads[2].1 else { panic!("{loads:?}") };
    assert_eq!((traction.direction, &traction.pulse), ([0.6, -0.8], &Pulse::Step { peak: 3e3 }));
    let Load::Force(force) = loads[3].1 else { panic!("{loads:?}") };
    assert_eq!(force.pulse, Pulse::Table { times: vec![0.0, 5e-3], values: vec![0.0, 6e3] });
}

#[test]
fn a_table_in_a_file_lies_beside_the_case_and_becomes_part_of_what_was_calculated() {
    let folder = folder("table");
    let case = folder.join("c.json");
    let text = std::fs::read_to_string(default_case()).unwrap();
    let text = text
        .replace(r#""law": "linear", "peak": "100 kPa", "duration": "50 ms""#, r#""law": "table", "file": "p.csv""#);
    std::fs::write(&case, text).unwrap();
    let read_with = |table: &str| {
        std::fs::write(folder.join("p.csv"), table).unwrap();
        Case::read(&case, &[])
    };
    for table in [
        "t,p\n0,0\n0.001,5e4\n0.05,0\n",
        "\u{feff}t 2 [ms];p [kPa]\r\n0;0\r\n1;50\r\n50;0",
        "# s  Pa\n0 0\n\n1e-3 5e4 # peak\n.05 0",
        "0;0\n0.001; 5e4\n0.05;0\r\n",
    ] {
        let case = read_with(table).unwrap();
        let expected = Pulse::Table { times: vec![0.0, 1e-3, 0.05], values: vec![0.0, 5e4, 0.0] };
        assert_eq!(case.loads.iter().next().unwrap().1, &Load::Pressure(Pressure::Simultaneous(expected)), "{table:?}");
        assert_eq!(case.json()["loads"]["surface"]["pressure"]["values"], json!([0.0, 5e4, 0.0]));
    }
    for (table, words) in [
        ("0,0\n1,x\n", "p.csv, line 2: \"x\" is no number"),
        ("0,0\n10\n", "p.csv, line 2: \"10\" has one column"),
        ("0,0\n1,2,3\n", "p.csv, line 2"),
        ("0,0\n1,nan\n", "p.csv, line 2"),
        ("# in [ms], [kPa]\nt,p\n0,0\n1,1\n", "p.csv, line 1: these units are in a comment"),
        ("ms,kPa\n0,0\n1,1\n", "p.csv, line 1: its heading is"),
        ("t [ms],p\n0,0\n1,1\n", "unit in square brackets to both columns"),
        ("0,0\n", "two lines of numbers or more"),
        ("", "two lines of numbers or more"),
        ("0,0\n1,1\n1,2\n", "must ascend"),
        ("-1,0\n1,1\n", "from 0 or later"),
    ] {
        let sentence = read_with(table).unwrap_err().to_string();
        assert!(sentence.contains(words) && sentence.contains("c.json: loads.surface.pressure: "), "{sentence}");
    }
    std::fs::remove_file(folder.join("p.csv")).unwrap();
    let sentence = Case::read(&case, &[]).unwrap_err().to_string();
    assert!(sentence.contains("cannot read the table") && sentence.contains("p.csv"), "{sentence}");
    std::fs::remove_dir_all(folder).unwrap();
}

/// Each: what is set in the paper's case, where the sentence must point, and what it must say.
#[test]
fn every_impossible_value_is_a_sentence_with_file_path_value_and_range() {
    for (set, place, words) in [
        (
            "materials.layer_1.young=100 kg",
            "materials.layer_1.young",
            "\"100 kg\" is not a pressure; write a number in Pa",
        ),
        ("materials.layer_1.young=-3 MPa", "materials.layer_1.young", "it is -3000000 Pa, and must be greater than 0"),
        ("materials.layer_1.young=0", "materials.layer_1.young", "must be greater than 0"),
        ("materials.layer_1.young=true", "materials.layer_1.young", "a number in Pa or a string like"),
        ("materials.layer_1.young=null", "materials.layer_1", "the key \"young\" is missing"),
        ("materials.layer_1.poisson=0.5", "materials.layer_1.poisson", "less than 0.5 (0.5 is incompressible"),
        ("materials.layer_1.poisson=-1", "materials.layer_1.poisson", "it is -1, and must be greater than -1"),
        ("materials.layer_1.poisson=0.3 MPa", "materials.layer_1.poisson", "stands where a number is expected"),
        (
            "materials.layer_2.density=-1 t/m^3",
            "materials.layer_2.density",
            "it is -1000 kg/m^3, and must be greater than 0",
        ),
        ("materials.layer_2.friction=-0.1", "materials.layer_2.friction", "it is -0.1, and must be at least 0"),
        ("interfaces.interface_left.thickness=0", "interfaces.interface_left.thickness", "greater than 0"),
        ("interfaces.interface_left.gap=-1 mm", "interfaces.interface_left.gap", "at least 0"),
        ("interfaces.interface_left.normal_stiffness=5 MPa", "interfaces.interface_left.normal_stiffness", "MPa/m"),
        (
            "interfaces.interface_left.integration=gauss",
            "interfaces.interface_left.integration",
            "did you mean \"gauss_1\"?",
        ),
        ("supports.base=[\"z\"]", "supports.base[0]", "there is no \"z\""),
        ("supports.base=x", "supports.base", "a list"),
        ("time.step=0", "time.step", "it is 0 s, and must be greater than 0"),
        ("time.end=0.01 ms", "time.end", "at least one step (0.0001 s)"),
        ("time.newmark.delta=0.4", "time.newmark", "not unconditionally stable"),
        ("time.newmark.delta=0.6", "time.newmark", "(delta + 0.5)^2 / 4 = 0.30"),
        ("time.start=later", "time.start", "there are: equilibrium, rest"),
        ("newton.tolerance=0", "newton.tolerance", "greater than 0 and less than 1"),
        ("newton.max_iterations=0", "newton.max_iterations", "at least 1"),
        ("newton.max_iterations=-3", "newton.max_iterations", "a whole number"),
        ("output.every=0.01 ms", "output.every", "at least one time step"),
        ("damping.ratio=1", "damping.ratio", "at least 0 and less than 1"),
        ("damping.modes=[1,1]", "damping", "two different numbers counted from 1, and is [1, 1]"),
        ("damping.modes=[0,1]", "damping", "two different numbers counted from 1"),
        ("damping.modes=[1]", "damping.modes", "a list of two"),
        ("damping.alpha=5", "damping", "either \"ratio\" with \"modes\", or both \"alpha\" and \"beta\""),
        ("loads.surface.pressure.duration=0", "loads.surface.pressure.duration", "greater than 0"),
        ("loads.surface.pressure.peak=1 kg", "loads.surface.pressure.peak", "is not a pressure"),
        (
            "loads.surface.pressure.law=triangle",
            "loads.surface.pressure.law",
            "there are: linear, step, table, ramp, half_sine, friedlander, charge",
        ),
        (
            "loads.surface.pressure.law=step",
            "loads.surface.pressure",
            "the law \"step\" needs \"peak\", and nothing else",
        ),
        ("loads.surface.pressure.law=table", "loads.surface.pressure", "\"times\" and \"values\" or a \"file\""),
        ("loads.surface={\"presure\":{}}", "loads.surface", "did you mean \"pressure\"?"),
        ("loads.surface={}", "loads.surface", "an object with exactly one key is expected"),
        ("loads.surface.traction={}", "loads.surface", "an object with exactly one key is expected"),
        ("loads={\"A\":{\"force\":{\"law\":\"step\",\"peak\":1,\"direction\":[0,0]}}}", "loads.A.force", "zero vector"),
        ("loads=[{\"s\":{\"pressure\":{\"law\":\"step\"}}}]", "loads[0].s.pressure", "needs \"peak\""),
        ("loads=5", "loads", "a list of such objects"),
        ("geometry={}", "geometry", "either \"script\""),
        ("geometry.mesh=x.msh", "geometry", "either \"script\""),
        ("geometry.parameters.width=wide", "geometry.parameters.width", "a number"),
        ("probes.1=A", "probes[1]", "a probe \"A\" already"),
        ("probes.1=\"\"", "probes[1]", "a probe needs a name"),
        ("probes.1=5", "probes[1]", "the name of a physical point, or an object"),
        ("probes.1={\"name\":\"P\"}", "probes[1]", "the key \"at\" is missing"),
        ("materials=[]", "materials", "an object is expected"),
        ("time=5", "time", "an object is expected"),
        ("time=[1e-4, 1e-2]", "time", "a list stands where an object is expected"),
        ("materials.layer_1=[1e8, 0.3, 2000]", "materials.layer_1", "a list stands where an object is expected"),
        ("probes.1=[\"P\", [1, 2]]", "probes[1]", "a list stands where"),
    ] {
        let sentence = sentence(set);
        let head = format!("geo/twin_pipes.json with --set {set}: {place}: ");
        assert!(sentence.contains(&head) && sentence.contains(words), "{set}\n  {sentence}");
    }
}

#[test]
fn an_unknown_key_is_named_with_its_neighbours_and_the_nearest() {
    for (set, words) in [
        (
            "tim=1",
            "there is no key \"tim\" (did you mean \"time\"?); the keys are: title, analysis, geometry, materials",
        ),
        (
            "materials.layer_1.yuong=1",
            "there is no key \"yuong\" (did you mean \"young\"?); the keys are: young, poisson, density, friction",
        ),
        ("time.zebra=1", "there is no key \"zebra\"; the keys are: step, end, newmark, hht, energy_tolerance, start"),
        ("damping.rato=1", "did you mean \"ratio\"?"),
        ("geometry.parameter=1", "did you mean \"parameters\"?"),
        ("gravty=9.81", "did you mean \"gravity\"?"),
    ] {
        let sentence = sentence(set);
        let parent = set.rsplit_once('.').map_or("", |(parent, _)| parent.split('=').next().unwrap());
        assert!(sentence.contains(words) && sentence.contains(parent), "{set}\n  {sentence}");
    }
    let lost = read_text("lost", r#"{ "time": { "step": 1, "end": 1 } }"#).unwrap_err().to_string();
    assert!(lost.ends_with("my case.json: the key \"materials\" is missing"), "{lost}");
}

#[test]
fn broken_json_is_found_by_line_and_column() {
    for (text, words) in [
        ("{\n  \"title\": \"x\"\n  \"time\": 1\n}", "line 3, column 3"),
        ("", "line 1, column 0"),
        ("{", "line 1, column 1"),
        ("{} {}", "line 1, column 4"),
        ("{ \"a\": 1e999 }", "line 1"),
        ("{\n\"materials\": { \"a\": 1, \"a\": 2 } }", "line 2, column"),
        ("[]", "an object"),
        ("5", "an object"),
        ("null", "an object"),
    ] {
        let sentence = read_text("broken", text).unwrap_err().to_string();
        assert!(sentence.contains("my case.json") && sentence.contains(words), "{text:?}\n  {sentence}");
    }
    let twice = read_text("twice", "{ \"materials\": { \"a\": 1, \"a\": 2 } }").unwrap_err().to_string();
    assert!(twice.contains("the key \"a\" stands twice"), "{twice}");
    let deep = read_text("deep", &"[".repeat(100_000)).unwrap_err().to_string();
    assert!(deep.contains("recursion limit"), "{deep}");
}

#[test]
fn a_missing_case_is_a_sentence_that_lists_the_cases_there_are() {
    let missing = Case::read(&root().join("geo/no.json"), &[]).unwrap_err();
    assert_eq!(missing.exit_code(), 1);
    assert!(
        missing.to_string().contains("geo/no.json") && missing.to_string().contains("geo/twin_pipes.json"),
        "{missing}"
    );
    for unreadable in ["geo", "no/such/folder/c.json", ""] {
        assert!(Case::read(Path::new(unreadable), &[]).unwrap_err().to_string().starts_with("cannot read the case"));
    }
    let folder = folder("latin1");
    std::fs::write(folder.join("c.json"), b"{ \"title\": \"\xe9\" }").unwrap();
    assert!(Case::read(&folder.join("c.json"), &[]).unwrap_err().to_string().contains("UTF-8"));
    std::fs::remove_dir_all(folder).unwrap();
}

#[test]
fn what_was_set_stands_in_the_case_and_in_its_effective_json() {
    let sets = [
        "time.step=0.2 ms",
        "loads.surface.pressure.peak=730 kPa",
        "probes=[\"A\"]",
        "interfaces.interface_left.gap=0.001",
    ];
    let case = Case::read(&default_case(), &sets.map(String::from)).unwrap();
    assert!(
        close(case.time.step.0, 2e-4)
            && case.probes.len() == 1
            && case.interfaces.opened["interface_left"].gap.0 == 1e-3
    );
    assert_eq!(case.json()["time"], json!({ "step": "0.2 ms", "end": "100 ms" }));
    assert_eq!(case.json()["loads"]["surface"]["pressure"]["peak"], "730 kPa");
    let again = read_text("again", &case.json().to_string()).unwrap();
    assert_eq!(again.json(), case.json());
    assert_eq!(again.loads, case.loads);
    assert!(sentence("time.step").starts_with("--set \"time.step\" has no"));
}

/// Whether every key of `value` is known to the schema at its place.
fn unknown_to(schema: &Value, root: &Value, value: &Value, place: &str) -> Vec<String> {
    if let Some(target) = schema.get("$ref").and_then(Value::as_str) {
        return unknown_to(root.pointer(target.trim_start_matches('#')).unwrap(), root, value, place);
    }
    let choices = schema.get("anyOf").or(schema.get("oneOf")).and_then(Value::as_array);
    // beside properties a choice says which of them go together
    if let Some(choices) = choices.filter(|_| schema.get("properties").is_none()) {
        let tries = choices.iter().map(|choice| unknown_to(choice, root, value, place));
        return tries.min_by_key(Vec::len).unwrap();
    }
    match value {
        Value::Object(map) => map
            .iter()
            .flat_map(|(key, inner)| {
                let place = format!("{place}.{key}");
                let known =
                    schema["properties"].get(key).or(schema.get("additionalProperties").filter(|s| s.is_object()));
                known.map_or_else(|| vec![place.clone()], |known| unknown_to(known, root, inner, &place))
            })
            .collect(),
        Value::Array(list) if schema["items"].is_object() => {
            list.iter().flat_map(|inner| unknown_to(&schema["items"], root, inner, place)).collect()
        }
        Value::Array(_) => vec![place.into()],
        _ => Vec::new(),
    }
}

#[test]
fn the_schema_knows_every_key_of_the_papers_case_and_no_other() {
    let schema = case::schema();
    let json = Case::read(&default_case(), &[]).unwrap().json().clone();
    assert_eq!(unknown_to(&schema, &schema, &json, ""), Vec::<String>::new());
    for wrong in ["time.zebra=1", "materials.layer_1.yuong=1", "loads.surface.pressure.peek=1", "damping.rato=1"] {
        let (path, _) = wrong.split_once('=').unwrap();
        let pointer = format!("/{}", path.rsplit_once('.').unwrap().0.replace('.', "/"));
        let mut json = json.clone();
        json.pointer_mut(&pointer).unwrap()[path.rsplit_once('.').unwrap().1] = json!(1);
        assert_eq!(unknown_to(&schema, &schema, &json, "").len(), 1, "{wrong}");
    }
}

#[test]
fn every_key_of_the_schema_is_described_and_quantities_list_their_units() {
    let schema = case::schema();
    let definitions = schema["$defs"].as_object().unwrap();
    let objects =
        definitions.iter().chain([("Case", &schema)].map(|(n, s)| (Box::leak(n.to_string().into()) as &String, s)));
    for (name, definition) in objects {
        for (key, property) in definition["properties"].as_object().into_iter().flatten() {
            let described = property.get("description").is_some() || property.get("$ref").is_some();
            assert!(described, "{name}.{key}: {property}");
        }
    }
    for (name, unit) in [("Pressure", "N/cm^2"), ("Density", "kg/cm^3"), ("Length", "cm"), ("Time", "ms")] {
        assert!(definitions[name]["description"].as_str().unwrap().contains(unit), "{name}");
    }
}

/// The law of a load, wherever loads stand; one that is near is offered.
#[test]
fn a_wrong_law_is_reported_at_its_place_with_the_nearest_name() {
    let traction = r#"{"traction":{"law":"half-sine","peak":1,"duration":1,"direction":[1,0]}}"#;
    for (set, place, words) in [
        (
            "loads.surface.pressure.law=linaer",
            "loads.surface.pressure.law",
            "\"linaer\" is no law (did you mean \"linear\"?)",
        ),
        (
            "loads.surface.pressure.law=Step",
            "loads.surface.pressure.law",
            "\"Step\" is no law (did you mean \"step\"?)",
        ),
        (
            "loads.surface.pressure.law=triangle",
            "loads.surface.pressure.law",
            "\"triangle\" is no law; there are: linear, step",
        ),
        ("loads.surface.pressure.law=5", "loads.surface.pressure.law", "stands where"),
        (&format!("loads={{\"A\":{traction}}}"), "loads.A.traction.law", "did you mean \"half_sine\"?"),
        (&format!("loads=[{{\"A\":{traction}}}]"), "loads[0].A.traction.law", "there are: linear, step, table"),
    ] {
        let sentence = sentence(set);
        assert!(sentence.contains(&format!(": {place}: ")) && sentence.contains(words), "{set}\n  {sentence}");
    }
}

/// Comments may stand twice in an object; they are no name of a group, and nothing that a result depends on.
#[test]
fn comments_and_the_place_of_the_schema_change_nothing_that_is_calculated() {
    let plain = Case::read(&default_case(), &[]).unwrap();
    let text = std::fs::read_to_string(default_case()).unwrap();
    let commented =
        text.replace('{', r#"{ "_comment": { "law": "table", "file": "none" }, "_comment": 1, "_comment_2": [{}], "#);
    let commented = commented.replacen('{', "{ \"$schema\": \"case.schema.json\", ", 1);
    let case = read_text("comments", &commented).unwrap();
    assert_eq!(case.json(), plain.json());
    let refused = read_text("comment", &text.replacen('{', "{ \"comment\": 1, ", 1)).unwrap_err().to_string();
    assert!(refused.contains("there is no key \"comment\""), "{refused}");
    let place = read_text("schema", &text.replacen('{', "{ \"$schema\": 5, ", 1)).unwrap_err().to_string();
    assert!(place.contains("$schema: "), "{place}");
}

/// Each law has an object of its own, told apart by a constant, and no other law's keys; beyond that
/// `scripts/check_schema.py` compares what the schema and the program refuse.
#[test]
fn the_schema_has_an_object_for_each_law_with_its_own_keys_alone() {
    let schema = case::schema();
    let laws = |name: &str| schema["$defs"][name]["oneOf"].as_array().unwrap().clone();
    let keys_of = |law: &Value| law["properties"].as_object().unwrap().keys().cloned().collect::<Vec<_>>();
    let pressures = laws("PressureLaw");
    let names: Vec<&str> = pressures.iter().map(|law| law["properties"]["law"]["const"].as_str().unwrap()).collect();
    assert_eq!(names, ["linear", "step", "table", "ramp", "half_sine", "friedlander", "charge"]);
    for law in &pressures {
        assert_eq!(law["additionalProperties"], false);
        assert!(keys_of(law).ends_with(&["front", "scale", "rise", "start"].map(String::from)), "{law}");
    }
    assert_eq!(pressures[0]["required"], json!(["law", "peak", "duration"]));
    assert_eq!(keys_of(&pressures[1]), ["law", "peak", "front", "scale", "rise", "start"]);
    assert_eq!(pressures[6]["required"], json!(["law", "explosion"]));
    for name in ["DirectedLawPressure", "DirectedLawForceDensity", "DirectedLawLineForce"] {
        assert_eq!(laws(name).len(), 6, "a charge is for pressures only");
        assert_eq!(laws(name)[1]["required"], json!(["law", "peak", "direction"]));
        assert!(laws(name).iter().all(|law| law["properties"].get("front").is_none()));
    }
}
