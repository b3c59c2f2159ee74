//! What other programs find in the files of a run: names, times, angles, units, vectors on the interfaces.

mod frames;
mod program;

use program::Bench;
use serde_json::{Value, json};
use std::fs;
use vtkio::model::{Attribute, IOBuffer, UnstructuredGridPiece, VertexNumbers};

/// A pipe of 64 rays, radii 0.4, 0.5 and 0.6 m, in ground out to 4 m, as MSH 2.2.
fn ring_msh(pipe: &str, skin: &str) -> String {
    const RAYS: usize = 64;
    let radii = [0.4, 0.5, 0.6, 0.8, 1.2, 2., 4.];
    let node = |layer: usize, ray: usize| layer * RAYS + ray % RAYS + 1;
    let (mut nodes, mut elements) = (String::new(), vec![(15, 6, vec![node(2, 0)])]);
    for (layer, ray) in (0..radii.len()).flat_map(|layer| (0..RAYS).map(move |ray| (layer, ray))) {
        let (sin, cos) = (std::f64::consts::TAU * ray as f64 / RAYS as f64).sin_cos();
        nodes += &format!("{} {} {} 0\n", node(layer, ray), 2. + radii[layer] * cos, -7. + radii[layer] * sin);
        // (type, physical group, nodes)
        for (curve, group) in [(0, 3), (2, 4), (6, 5)] {
            elements.extend((layer == curve).then(|| (1, group, vec![node(layer, ray), node(layer, ray + 1)])));
        }
        if layer + 1 < radii.len() {
            let corners = vec![node(layer, ray), node(layer + 1, ray), node(layer + 1, ray + 1), node(layer, ray + 1)];
            elements.push((3, if layer < 2 { 1 } else { 2 }, corners));
        }
    }
    let line = |(n, (kind, group, nodes)): (usize, &(usize, usize, Vec<usize>))| {
        let nodes: Vec<String> = nodes.iter().map(ToString::to_string).collect();
        format!("{} {kind} 2 {group} 1 {}\n", n + 1, nodes.join(" "))
    };
    format!(
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n6\n2 1 \"{pipe}\"\n2 2 \"ground\"\n1 3 \"bore\"\n1 4 \
         \"{skin}\"\n1 5 \"rim\"\n0 6 \"east\"\n$EndPhysicalNames\n$Nodes\n{}\n{nodes}$EndNodes\n$Elements\n{}\n{}$EndElements\n",
        radii.len() * RAYS,
        elements.len(),
        elements.iter().enumerate().map(line).collect::<String>()
    )
}

/// A static case on it under 1 MPa in the bore, with frames and rings at t = 0 and 1 s.
fn ring_case(pipe: &str, skin: &str) -> Value {
    let mut materials = serde_json::Map::new();
    materials.insert(pipe.into(), json!({ "young": "210 GPa", "poisson": 0.3, "density": 7800 }));
    let ground = json!({ "young": 519e6, "poisson": 0.38, "density": 2600, "friction": 0.3 });
    materials.insert("ground".into(), ground);
    let mut interfaces = serde_json::Map::new();
    interfaces.insert(skin.into(), json!({ "body": pipe }));
    json!({
        "geometry": { "mesh": "ring.msh" }, "analysis": "static", "materials": materials, "interfaces": interfaces,
        "supports": { "rim": ["x", "y"] },
        "loads": { "bore": { "pressure": { "law": "step", "peak": "1 MPa" } } },
        "time": { "step": 1, "end": 1 },
    })
}

fn ring_run(bench: &Bench, case: &Value, [pipe, skin]: [&str; 2]) {
    bench.write("ring.json", case.to_string());
    bench.write("ring.msh", ring_msh(pipe, skin));
    let outcome = bench.run_line("run ring.json --out ring --quiet");
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
}

fn text(bench: &Bench, path: &str) -> String {
    fs::read_to_string(bench.path(path)).unwrap()
}

fn summary(bench: &Bench, path: &str) -> Value {
    serde_json::from_str(&text(bench, path)).unwrap()
}

/// RFC 4180: a field with a comma, a quote or a line break is in quotes, quotes in it are doubled. Excel splits a line
/// at semicolons, too, in countries that write decimal commas; a leading `=` is the name's own.
#[test]
fn names_are_whole_fields_in_every_table_whatever_they_are_made_of() {
    let bodies = [("pipe, left", "\"pipe, left\""), ("rør; 左", "\"rør; 左\""), ("=1+1", "=1+1")];
    for (body, field) in bodies {
        let bench = Bench::new("names");
        let case = ring_case(body, "skin of; it");
        ring_run(&bench, &case, [body, "skin of; it"]);
        let table = text(&bench, "ring/rings.csv");
        let mut lines = table.lines();
        assert_eq!(lines.next(), Some("t,body,angle_deg,N,Q,M,hoop_inner,hoop_outer,u_r,u_t,sigma_n,tau"));
        assert_eq!(lines.clone().count(), 2 * 64);
        for line in lines {
            let rest = line.split_once(',').unwrap().1.strip_prefix(field).unwrap_or_else(|| panic!("{line}"));
            assert_eq!(rest.matches(',').count(), 10, "{line}");
        }
    }
}

/// Probes take any name: two commas, quotes, a line break, a semicolon, a formula, letters of any alphabet.
#[test]
fn a_probe_of_any_name_has_its_columns() {
    let bench = Bench::new("probes");
    let names = ["crown, \"left\"", "two\nlines", "=cmd()", "a;b", "Fuß", "P"];
    let probes: Vec<Value> = names.iter().map(|name| json!({ "name": name, "at": [2, 5] })).collect();
    let outcome =
        bench.run(&["run", "block.json", "--out", "out", "--quiet", "--set", &format!("probes={}", json!(probes))]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let written = ["\"crown, \"\"left\"\".C\"", "\"two\nlines.C\"", "=cmd().C", "\"a;b.C\"", "Fuß.C", "P.C"];
    let columns = |name: &&str| {
        ["ux", "uy", "vx", "vy", "ax", "ay"].map(|c| format!(",{}", name.replace(".C", &format!(".{c}")))).concat()
    };
    let head = written.iter().map(columns).collect::<String>();
    let table = text(&bench, "out/histories.csv");
    assert!(table.starts_with(&format!("t{head}\n0,")), "{}", &table[..400]);
    let summary = summary(&bench, "out/summary.json");
    assert!(names.iter().all(|name| summary["peaks"][name]["uy"]["value"].is_number()), "{}", summary["peaks"]);
    let outcome = bench.run(&["run", "block.json", "--out", "none", "--set", "probes=[\"\"]"]);
    assert!(
        outcome.code == Some(1) && outcome.stderr.contains("probes[0]: a probe needs a name"),
        "{}",
        outcome.stderr
    );
}

/// The plan's values and the probes' names head columns of a sweep's table.
#[test]
fn a_sweep_quotes_what_it_varies_and_whom_it_asks() {
    let bench = Bench::new("sweep-names");
    let probes = json!([{ "name": "roof, \"north\"", "at": [2, 5] }]);
    let plan = json!({ "case": "block.json", "set": { "probes": [probes], "loads.top.pressure.peak": ["50 kPa"] } });
    bench.write("plan.json", plan.to_string());
    let outcome = bench.run_line("sweep plan.json");
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let table = text(&bench, "output/plan/sweep.csv");
    let head = table.lines().next().unwrap();
    assert!(head.contains(",\"roof, \"\"north\"\".uy\","), "{head}");
}

/// The first column of a table, as it is written.
fn times(table: &str) -> Vec<&str> {
    table.lines().skip(1).map(|line| line.split(',').next().unwrap()).collect()
}

/// The values of an attribute of the series' index, as they are written.
fn steps_of_series(index: &str) -> Vec<&str> {
    index.split("timestep=\"").skip(1).map(|rest| rest.split('"').next().unwrap()).collect()
}

/// 3 x 1e-4 is 3.0000000000000003e-4 in binary; 0.7 us have seven zeros; a third of a millisecond goes on for ever.
#[test]
fn the_times_of_a_run_are_the_decimal_numbers_that_the_user_multiplies() {
    let bench = Bench::new("times");
    for (step, end, every, expected) in [
        ("0.1 ms", "0.7 ms", "0.3 ms", ["0", "0.0001", "0.0002", "0.0003", "0.0004", "0.0005", "0.0006", "0.0007"]),
        (
            "0.1 us",
            "0.7 us",
            "0.3 us",
            ["0", "0.0000001", "0.0000002", "0.0000003", "0.0000004", "0.0000005", "0.0000006", "0.0000007"],
        ),
        (
            "0.3333333333333333 ms",
            "2.3333333333333333 ms",
            "1 ms",
            [
                "0",
                "0.000333333333333",
                "0.000666666666667",
                "0.001",
                "0.00133333333333",
                "0.00166666666667",
                "0.002",
                "0.00233333333333",
            ],
        ),
        ("10 ms", "70 ms", "30 ms", ["0", "0.01", "0.02", "0.03", "0.04", "0.05", "0.06", "0.07"]),
    ] {
        let set = [format!("time.step={step}"), format!("time.end={end}"), format!("output.every={every}")];
        let outcome = bench.run(&[
            "run",
            "block.json",
            "--out",
            "out",
            "--quiet",
            "--set",
            &set[0],
            "--set",
            &set[1],
            "--set",
            &set[2],
            // no step is cut for the energy that joints make
            "--bonded",
        ]);
        assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
        assert_eq!(times(&text(&bench, "out/histories.csv")), expected, "{step}");
        let frames = [0, 3, 6, 7].map(|k| expected[k]);
        assert_eq!(steps_of_series(&text(&bench, "out/block.pvd")), frames, "{step}");
        let expected: Vec<f64> = expected.iter().map(|t| t.parse().unwrap()).collect();
        let summary = summary(&bench, "out/summary.json");
        for (_, peak) in summary["peaks"]["P"].as_object().unwrap() {
            assert!(expected.contains(&peak["time"].as_f64().unwrap()), "{step}: {peak}");
        }
        // seven digits in the table for the eye, in a column of its own whatever the step
        let status = text(&bench, "out/run.sta");
        for (line, time) in status.lines().skip(1).zip(&expected[1..]) {
            let shown: f64 = line.split_whitespace().nth(1).unwrap().parse().unwrap();
            assert!((shown / time - 1.).abs() < 1e-6, "{line}");
        }
    }
}

/// 64 rays stand at whole multiples of 5.625 degrees.
#[test]
fn the_angles_of_rays_are_the_decimal_numbers_that_they_are() {
    let bench = Bench::new("angles");
    ring_run(&bench, &ring_case("pipe", "skin"), ["pipe", "skin"]);
    let table = text(&bench, "ring/rings.csv");
    let angles: Vec<&str> = table.lines().skip(1).map(|line| line.split(',').nth(2).unwrap()).collect();
    let expected: Vec<String> = (0..2 * 64).map(|k| format!("{}", 5.625 * f64::from(k % 64))).collect();
    assert_eq!(angles, expected);
}

#[test]
fn a_body_that_cannot_be_cut_is_named_with_the_reason_by_run_check_and_sweep_and_not_by_modes() {
    let bench = Bench::new("uncut");
    let sentence = "rings.csv has no section forces of \"body\", since it has no bore: a single closed line bounds it; a wall is \
                    cut where it is a whole circular ring";
    let run = bench.run_line("run block.json --out out");
    assert!(run.code == Some(0) && run.stderr.contains(&format!("warning: {sentence}")), "{}", run.stderr);
    let of_summary = |path: &str| summary(&bench, path)["warnings"].to_string().replace("\\\"", "\"");
    assert!(of_summary("out/summary.json").contains(sentence), "{}", of_summary("out/summary.json"));
    let check = bench.run_line("check block.json");
    assert!(check.code == Some(0) && check.stdout.contains(&format!("warning: {sentence}")), "{}", check.stdout);
    bench.write("plan.json", r#"{ "case": "block.json", "set": { "loads.top.pressure.peak": ["50 kPa"] } }"#);
    let sweep = bench.run_line("sweep plan.json");
    assert!(sweep.code == Some(0) && sweep.stderr.contains(sentence), "{}", sweep.stderr);
    let modes = bench.run_line("modes block.json -n 1 --out shapes");
    assert!(modes.code == Some(0) && !modes.stderr.contains("rings.csv"), "{}", modes.stderr);
}

#[test]
fn a_ring_that_is_cut_is_not_warned_of() {
    let bench = Bench::new("cut");
    ring_run(&bench, &ring_case("pipe", "skin"), ["pipe", "skin"]);
    let warnings = summary(&bench, "ring/summary.json")["warnings"].to_string();
    assert!(!warnings.contains("rings.csv"), "{warnings}");
}

/// A frame with its XML, before the numbers.
struct Read {
    piece: UnstructuredGridPiece,
    xml: String,
}

fn frame(bench: &Bench, path: &str) -> Read {
    let bytes = fs::read(bench.path(path)).unwrap();
    let end = bytes.windows(13).position(|at| at == b"<AppendedData").unwrap();
    Read { piece: frames::piece(&bytes).unwrap(), xml: String::from_utf8(bytes[..end].to_vec()).unwrap() }
}

impl Read {
    fn find(data: &[Attribute], name: &str) -> Vec<f64> {
        let array = data.iter().find(|attribute| attribute.name() == name).unwrap_or_else(|| panic!("no {name}"));
        match array {
            Attribute::DataArray(array) => array.data.cast_into::<f64>().unwrap(),
            Attribute::Field { .. } => panic!("{name} is a field"),
        }
    }

    fn point(&self, name: &str) -> Vec<f64> {
        Read::find(&self.piece.data.point, name)
    }

    fn cell(&self, name: &str) -> Vec<f64> {
        Read::find(&self.piece.data.cell, name)
    }

    fn points(&self) -> Vec<[f64; 3]> {
        match &self.piece.points {
            IOBuffer::F64(points) => points.as_chunks().0.to_vec(),
            _ => panic!("points in another precision"),
        }
    }

    /// The nodes of each cell.
    fn nodes(&self) -> Vec<Vec<usize>> {
        let VertexNumbers::XML { connectivity, offsets } = &self.piece.cells.cell_verts else { panic!("other cells") };
        let starts = [0].iter().chain(offsets);
        let of_cell = |(&start, &end): (&u64, &u64)| {
            connectivity[start as usize..end as usize].iter().map(|&n| n as usize).collect()
        };
        starts.zip(offsets).map(of_cell).collect()
    }

    /// (number, end nodes) of the interfaces' cells.
    fn lines(&self) -> Vec<(usize, [usize; 2])> {
        let nodes = self.nodes();
        nodes.iter().enumerate().filter(|(_, n)| n.len() == 2).map(|(i, n)| (i, [n[0], n[1]])).collect()
    }

    fn length(&self, [a, b]: [usize; 2]) -> f64 {
        let points = self.points();
        (points[b][0] - points[a][0]).hypot(points[b][1] - points[a][1])
    }
}

/// Statics under gravity: the ground carries the pipe, so the tractions on it add up to its weight, pi (b^2 - a^2) rho g
/// for the circle and exactly the weight of its elements. That holds only if each point's traction is turned by its
/// own normal: along the curve normals turn by 5.6 degrees an element.
#[test]
fn traction_vectors_on_a_pipe_add_up_to_its_weight() {
    let bench = Bench::new("weight");
    let mut case = ring_case("pipe", "skin");
    case["gravity"] = json!(9.81);
    case["newton"] = json!({ "tolerance": 1e-12 });
    ring_run(&bench, &case, ["pipe", "skin"]);
    let read = frame(&bench, "ring/frames/ring_00001.vtu");
    let (traction, points, nodes) = (read.cell("traction_vector"), read.points(), read.nodes());
    let mut sum = [0.; 2];
    for (line, ends) in read.lines() {
        (0..2).for_each(|k| sum[k] += read.length(ends) * traction[3 * line + k]);
        assert_eq!(traction[3 * line + 2], 0.);
    }
    let pipe = read.cell("group_pipe");
    let area = |nodes: &[usize]| -> f64 {
        let cross = |i: usize| {
            let ([a, b, _], [c, d, _]) = (points[nodes[i]], points[nodes[(i + 1) % nodes.len()]]);
            (a * d - c * b) / 2.
        };
        (0..nodes.len()).map(cross).sum()
    };
    let area: f64 = nodes.iter().zip(&pipe).filter(|(_, member)| **member == 1.).map(|(nodes, _)| area(nodes)).sum();
    let weight = 7800. * 9.81 * area;
    assert!((weight / (7800. * 9.81 * std::f64::consts::PI * 0.2) - 1.).abs() < 0.01, "{weight}");
    // round-off of forces of 100 kPa on a metre, through a matrix of condition 1e6
    assert!(sum[0].abs() < 1e-6 * weight && (sum[1] / weight - 1.).abs() < 1e-6, "{sum:?} of {weight}");
}

/// The body, a square pressed from above, stands on straight joints: their normals are those of its sides, and both
/// faces of each are among the points.
#[test]
fn vectors_on_straight_joints_are_their_scalars_turned_and_the_faces_parting() {
    let bench = Bench::new("vectors");
    let sets = [
        "analysis=static",
        "damping=null",
        "time.step=1",
        "time.end=1",
        "output.every=1",
        "interfaces.interface.gap=1e-5",
    ];
    let load = r#"loads={"top":{"traction":{"law":"step","peak":"100 kPa","direction":[0.6,-0.8]}}}"#;
    let arguments: Vec<&str> = sets.iter().chain([&load]).flat_map(|set| ["--set", set]).collect();
    let outcome = bench.run(&[&["run", "block.json", "--out", "out", "--quiet"], &arguments[..]].concat());
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let read = frame(&bench, "out/frames/block_00001.vtu");
    let (points, displacement) = (read.points(), read.point("displacement"));
    let on_interface = read.point("group_interface");
    let [gap, slip, normal, shear] = ["gap", "slip", "normal_traction", "shear_traction"].map(|name| read.cell(name));
    let vectors = ["gap_vector", "slip_vector", "jump_vector", "traction_vector"].map(|name| read.cell(name));
    let lines = read.lines();
    assert_eq!(lines.len(), 4);
    let mut largest = [0f64; 3];
    for (line, ends) in lines {
        let [a, b] = ends.map(|n| points[n]);
        // the body is the square from (2, 2) to (3, 3) m
        let middle = [(a[0] + b[0]) / 2., (a[1] + b[1]) / 2.];
        let n = [2. * (middle[0] - 2.5), 2. * (middle[1] - 2.5)];
        let s = [-n[1], n[0]];
        let vector = |k: usize| [vectors[k][3 * line], vectors[k][3 * line + 1]];
        let expected = |along_n: f64, along_s: f64| [0, 1].map(|k| along_n * n[k] + along_s * s[k]);
        // the ground's node is the line's own; the body's is the other point of the interface at its place
        let parting = |k: usize| -> f64 {
            let of_end = |ground: usize| {
                let body =
                    (0..points.len()).find(|&p| p != ground && points[p] == points[ground] && on_interface[p] == 1.);
                displacement[3 * ground + k] - displacement[3 * body.unwrap() + k]
            };
            ends.iter().map(|&end| of_end(end)).sum::<f64>() / 2.
        };
        let jump = [parting(0), parting(1)];
        let all = [
            (vector(0), expected(gap[line], 0.), 1e-5),
            (vector(1), expected(0., slip[line]), 1e-5),
            (vector(2), jump, 1e-5),
            (vector(3), expected(normal[line], shear[line]), 1e5),
        ];
        for (found, should, scale) in all {
            // round-off of a few sums
            assert!((0..2).all(|k| (found[k] - should[k]).abs() < 1e-12 * scale), "{found:?}, not {should:?}");
        }
        // the gap before any load is in the gap, not in the jump
        assert!((gap[line] - (jump[0] * n[0] + jump[1] * n[1]) - 1e-5).abs() < 1e-17);
        let values = [gap[line].abs(), slip[line].abs(), shear[line].abs()];
        (0..3).for_each(|k| largest[k] = largest[k].max(values[k]));
    }
    assert!(largest[0] > 1e-8 && largest[1] > 1e-8 && largest[2] > 1e3, "nothing opens, slips or drags: {largest:?}");
}

/// A pipe in the ground under pressure in its bore: hoop stress is tension, radial stress compression, both are those of
/// the stress tensor turned to the element's place, and their sum is its trace in the plane. Elements outside have none.
#[test]
fn hoop_and_radial_stress_of_a_round_body_are_in_its_own_directions() {
    let bench = Bench::new("hoop");
    ring_run(&bench, &ring_case("pipe", "skin"), ["pipe", "skin"]);
    let read = frame(&bench, "ring/frames/ring_00001.vtu");
    let [hoop, radial, stress, pipe] = ["hoop_stress", "radial_stress", "stress", "group_pipe"].map(|n| read.cell(n));
    let principal = [1, 2, 3].map(|k| read.cell(&format!("principal_stress_{k}")));
    let (points, nodes) = (read.points(), read.nodes());
    let of_pipe: Vec<usize> = (0..nodes.len()).filter(|&cell| pipe[cell] == 1.).collect();
    let middle = |cell: usize| {
        let count = nodes[cell].len() as f64;
        [0, 1].map(|k| nodes[cell].iter().map(|&n| points[n][k]).sum::<f64>() / count)
    };
    // the ring's centre is that of all its elements, which lie evenly round it
    let centre = [0, 1].map(|k| of_pipe.iter().map(|&c| middle(c)[k]).sum::<f64>() / of_pipe.len() as f64);
    let largest = stress.iter().fold(0f64, |most, s| most.max(s.abs()));
    for cell in 0..nodes.len() {
        let [xx, yy, zz, xy] = [0, 1, 2, 3].map(|k| stress[6 * cell + k]);
        // single precision, and the centre's round-off
        let is = |found: f64, expected: f64| (found - expected).abs() < 1e-6 * largest;
        assert!(is(principal[0][cell] + principal[1][cell] + principal[2][cell], xx + yy + zz));
        assert!(principal[0][cell] >= principal[1][cell] && principal[1][cell] >= principal[2][cell]);
        if pipe[cell] == 0. {
            assert_eq!([hoop[cell], radial[cell]], [0., 0.]);
            continue;
        }
        let [x, y] = [0, 1].map(|k| middle(cell)[k] - centre[k]);
        let (sin, cos) = y.atan2(x).sin_cos();
        assert!(is(hoop[cell], sin * sin * xx + cos * cos * yy - 2. * sin * cos * xy), "{cell}");
        assert!(is(hoop[cell] + radial[cell], xx + yy), "{cell}");
        assert!(hoop[cell] > 0. && radial[cell] < 0., "{cell}: {} and {}", hoop[cell], radial[cell]);
    }
    assert!(of_pipe.len() > 100 && of_pipe.iter().any(|&c| hoop[c].abs() > 0.3 * largest));
}

/// meshio keeps physical names as entries of the field data, {name: [number, dimension]}; materials are numbered by name.
#[test]
fn materials_and_groups_are_in_the_frame_by_name() {
    let bench = Bench::new("groups");
    let pipe = "pipe 'left' & <right>";
    ring_run(&bench, &ring_case(pipe, "skin"), [pipe, "skin"]);
    let read = frame(&bench, "ring/frames/ring_00001.vtu");
    let escaped = "pipe 'left' &amp; &lt;right&gt;";
    let material = read.cell("material");
    for (number, (in_file, name)) in [("ground", "ground"), (escaped, pipe)].into_iter().enumerate() {
        let entry = format!(
            "<DataArray type=\"Int32\" Name=\"{in_file}\" NumberOfTuples=\"2\" format=\"ascii\">{} 2</DataArray>",
            number + 1
        );
        assert!(read.xml.contains(&entry), "{entry} is not in {}", read.xml);
        let member = read.cell(&format!("group_{name}"));
        let of_material = material.iter().map(|&m| f64::from(m == number as f64 + 1.));
        assert!(member.iter().copied().eq(of_material), "{name}");
    }
    let lines: Vec<usize> = read.lines().iter().map(|(line, _)| *line).collect();
    let skin = read.cell("group_skin");
    assert_eq!(lines, (0..skin.len()).filter(|&cell| skin[cell] == 1.).collect::<Vec<_>>());
    // both sides of the interface, a closed curve with as many nodes as lines; the ground's rim, and a point
    let count = |name: &str| read.point(name).iter().filter(|&&member| member == 1.).count();
    assert_eq!([count("group_skin"), count("group_east")], [2 * lines.len(), 1]);
    let (rim, points) = (read.point("group_rim"), read.points());
    let distance = |p: usize| (points[p][0] - 2.).hypot(points[p][1] + 7.);
    assert!((0..points.len()).all(|p| (rim[p] == 1.) == (distance(p) > 3.9)) && count("group_rim") == 64);
}

/// Where it is read: units in each array's information, what is total in the names of field data.
#[test]
fn a_frame_states_its_units_signs_and_from_where_it_counts() {
    let bench = Bench::new("units");
    let runs = [
        ("", "counted from the state without loads"),
        ("--set gravity=9.81", "counted from the equilibrium under gravity"),
    ];
    for (set, sentence) in runs {
        let outcome = bench.run_line(&format!("run block.json --out out --quiet {set}"));
        assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
        let xml = frame(&bench, "out/frames/block_00001.vtu").xml;
        let notes =
            ["Name=\"units: SI (m, s, m/s, m/s2, Pa)\"", "Name=\"signs: tension and opening positive; ", sentence];
        notes.iter().for_each(|note| assert!(xml.contains(note), "{note} is not in {xml}"));
        for (name, unit) in [
            ("displacement", "m"),
            ("velocity", "m/s"),
            ("acceleration", "m/s2"),
            ("nodal_stress", "Pa"),
            ("stress", "Pa"),
            ("principal_stress_1", "Pa"),
            ("hoop_stress", "Pa"),
            ("gap_vector", "m"),
            ("traction_vector", "Pa"),
            ("status", "1 sticks; 2 slips; 3 open"),
            ("material", "1 body; 2 ground"),
        ] {
            let tag = xml.split("<DataArray ").find(|tag| tag.contains(&format!(" Name=\"{name}\" "))).unwrap();
            assert!(tag.contains(&format!("location=\"vtkDataArray\">{unit}</InformationKey>")), "{tag}");
        }
    }
    let modes = bench.run_line("modes block.json -n 1 --out shapes");
    assert_eq!(modes.code, Some(0), "{}", modes.stderr);
    let xml = frame(&bench, "shapes/modes/block_mode_1.vtu").xml;
    assert!(xml.contains("Name=\"mode shape: ") && !xml.contains("totals: "), "{xml}");
}
