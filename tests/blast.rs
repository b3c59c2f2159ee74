//! Explosions and moving fronts: the command, the laws of the case file, and the forces behind a front.

mod program;
mod support;

use coralpipe::model::mesh::{Mesh, Shape};
use coralpipe::model::moving_front::MovingFront;
use coralpipe::model::resolve::{Load, Model};
use coralpipe::physics::explosion::{Burst, Explosion, Form, Formula, Wave};
use coralpipe::solve::system::System;
use program::Bench;
use serde_json::{Value, json};

/// The number at a pointer of what `coralpipe blast --json` prints.
fn blast(bench: &Bench, line: &str) -> Value {
    let outcome = bench.run_line(&format!("blast {line} --json"));
    assert_eq!(outcome.code, Some(0), "{line}: {}", outcome.stderr);
    serde_json::from_str(&outcome.stdout).unwrap()
}

fn number(value: &Value, pointer: &str) -> f64 {
    value.pointer(pointer).and_then(Value::as_f64).unwrap_or_else(|| panic!("no {pointer} in {value}"))
}

/// Swisdak's example, 10,000 kg at 500 m; and that a burst at a height is one in free air at the slant distance.
#[test]
fn the_command_prints_the_parameters_as_text_and_json() {
    let bench = Bench::new("blast");
    let found = blast(&bench, "--charge 10t --standoff 500 --formula swisdak");
    for (pointer, expected) in [
        ("/arrival_s", 1.27617),
        ("/incident/peak_pa", 5054.96),
        ("/reflected/peak_pa", 10244.6),
        ("/duration_s", 0.133233),
        ("/incident/impulse_pa_s", 295.877),
        ("/scaled_distance", 23.2079),
    ] {
        assert!((number(&found, pointer) / expected - 1.).abs() < 1e-5, "{pointer}: {found}");
    }
    let [slant, same] = ["--standoff 30 --height 40m", "--standoff 50 --burst spherical"]
        .map(|place| number(&blast(&bench, &format!("--charge 500 {place}")), "/incident/peak_pa"));
    assert!((slant / same - 1.).abs() < 1e-12);
    let [c4, tnt] = ["--charge 100 --explosive c4", "--charge 137"]
        .map(|charge| number(&blast(&bench, &format!("{charge} --standoff 20")), "/incident/peak_pa"));
    assert!((c4 / tnt - 1.).abs() < 1e-12);
    let text = bench.run_line("blast --charge 1t --standoff 30m --wave reflected --form equal_impulse").stdout;
    for words in ["kingery_bulmash", "3.0000 m/kg^(1/3)", "115.6674 kPa", "zero at", "reflected", "****"] {
        assert!(text.contains(words), "no {words} in {text}");
    }
}

/// A tonne at 30 m: the tangent, 115.667 kPa for 9.41 ms, carries 544 kPa ms, the pulse and the line of equal impulse
/// 927.
#[test]
fn the_impulse_that_acts_is_that_of_the_form_chosen() {
    let bench = Bench::new("acting");
    for (form, words, expected) in [
        ("tangent", "impulse 544.", 544.4),
        ("friedlander", "impulse 927.", 927.6),
        ("equal_impulse", "impulse 927.", 927.6),
    ] {
        let line = format!("--charge 1t --standoff 30m --wave incident --form {form}");
        let told = bench.run_line(&format!("blast {line}")).stdout;
        assert!(told.lines().any(|l| l.starts_with("what acts") && l.contains(words)), "{told}");
        let found = number(&blast(&bench, &line), "/acting_impulse_pa_s");
        assert!((found / expected - 1.).abs() < 2e-3, "{form}: {found}");
    }
}

#[test]
fn the_curve_is_written_as_a_figure_and_as_a_table_that_a_case_reads() {
    let bench = Bench::new("curve");
    for (file, words) in [("p.csv", "points written to p.csv\n"), ("p.svg", "p.svg"), ("p.csv", "in place of the file")]
    {
        let outcome = bench.run_line(&format!("blast --charge 1t --standoff 30m --out {file}"));
        assert!(outcome.code == Some(0) && outcome.stderr.contains(words), "{}", outcome.stderr);
    }
    assert!(std::fs::read_to_string(bench.path("p.svg")).unwrap().contains("<polyline points=\"80.00,40.00"));
    let told = bench.run_line(r#"check block.json --set loads.top.pressure={"law":"table","file":"p.csv"}"#).stdout;
    assert!(told.contains(" times, largest value 115667."), "{told}");
    let refusal = bench.run_line("blast --charge 1t --standoff 30m --out p.png");
    assert!(refusal.code == Some(1) && refusal.stderr.contains(".csv or .svg"), "{}", refusal.stderr);
}

/// The curve's points lie where it bends: their straight lines carry the impulse within 0.1 %, near a charge (b = 10)
/// and far from it.
#[test]
fn a_written_curve_carries_the_impulse() {
    let bench = Bench::new("carried");
    for place in ["--standoff 1.8m", "--standoff 300m"] {
        let impulse = number(&blast(&bench, &format!("--charge 1t {place} --out p.csv")), "/incident/impulse_pa_s");
        let text = std::fs::read_to_string(bench.path("p.csv")).unwrap();
        let row = |line: &str| line.split(',').map(|x| x.parse::<f64>().unwrap()).collect::<Vec<_>>();
        let rows: Vec<Vec<f64>> = text.lines().skip(1).map(row).collect();
        let carried: f64 = rows.windows(2).map(|w| (w[1][0] - w[0][0]) * (w[0][1] + w[1][1]) / 2.).sum();
        assert!((carried / impulse - 1.).abs() < 1e-3 && rows.len() < 400, "{place}: {carried}, {impulse}");
    }
}

#[test]
fn writing_a_curve_touches_no_other_file() {
    let bench = Bench::new("beside");
    bench.write("x.part", "the user's own");
    assert_eq!(bench.run_line("blast --charge 1t --standoff 30m --out x.csv").code, Some(0));
    assert_eq!(std::fs::read_to_string(bench.path("x.part")).unwrap(), "the user's own");
    std::fs::create_dir(bench.path("full.csv")).unwrap(); // nothing can be written there, as on a full disk
    let outcome = bench.run_line("blast --charge 1t --standoff 30m --out full.csv");
    assert!(outcome.code == Some(1) && outcome.stderr.contains("full.csv cannot be written"), "{}", outcome.stderr);
    let left = std::fs::read_dir(&bench.folder).unwrap().flatten().map(|f| f.file_name().into_string().unwrap());
    assert_eq!(left.filter(|name| name.ends_with(".part")).collect::<Vec<_>>(), ["x.part"]);
}

/// What `blast` notes and `check` warns of: burst and wave against the place.
#[test]
fn a_burst_that_does_not_fit_its_place_is_told() {
    let bench = Bench::new("misfit");
    let oblique = "63 degrees from the perpendicular, and \"incident\"";
    let notes: [(&str, &str); 6] = [
        ("--standoff 20 --height 10", oblique),
        ("--height 10", "0 degrees from the perpendicular, and \"incident\""),
        ("--standoff 20 --height 10 --wave reflected", "and \"reflected\" is the pressure at 0 degrees"),
        ("--standoff 20 --height 10 --burst hemispherical", "\"hemispherical\" is a burst on the ground"),
        ("--height 10 --wave reflected", ""),
        ("--standoff 20", ""),
    ];
    for (place, words) in notes {
        let text = bench.run_line(&format!("blast --charge 1t {place}")).stdout;
        let told = text.contains("note: the wave of a burst") || text.contains("note: \"hemispherical\"");
        assert!(text.contains(words) && told != words.is_empty(), "{place}: {text}");
    }
    // the top is at y = 5 m, from x = 0 to 5 m; 8 kg of TNT are a sphere of 0.21 m
    let warnings: [(&str, &str); 7] = [
        (r#""standoff":8,"height":4,"wave":"incident""#, oblique),
        (r#""at":[2.5,9],"burst":"hemispherical","wave":"incident""#, "the charge is 4 m above it"),
        (r#""at":[-9,5],"burst":"spherical","wave":"incident""#, "on the ground, 0 m above it"),
        (r#""at":[2.5,9],"burst":"spherical","wave":"incident""#, "0 to 21 degrees"),
        (r#""at":[9,9],"burst":"spherical","wave":"reflected""#, "45 to 63 degrees"),
        (r#""at":[-9,5.2],"burst":"hemispherical","wave":"incident""#, ""),
        (r#""at":[2.5,30],"burst":"spherical","wave":"reflected""#, ""),
    ];
    for (place, words) in warnings {
        let set =
            format!(r#"loads.top.pressure={{"law":"charge","explosion":{{"charge":"8kg",{place}}},"rise":"3 ms"}}"#);
        let outcome = bench.run(&["check", "block.json", "--set", &set]);
        let told = outcome.stdout.contains("warning: load on top: ");
        assert!(outcome.stdout.contains(words) && told != words.is_empty(), "{set}: {}", outcome.stdout);
    }
}

#[test]
fn a_bad_explosion_is_a_sentence() {
    let bench = Bench::new("bad_blast");
    let lines: [(&str, &[&str]); 13] = [
        ("--charge 1kg --standoff 41m", &["41 m/kg", "\"kingery_bulmash\", 0.178 to 40 m/kg", "no formula here"]),
        ("--charge 1kg --standoff 0.17m", &["0.178 to 40 m/kg", "duration"]),
        (
            "--charge 1kg --standoff 0.14m --burst spherical --formula henrych",
            &["\"henrych\", 0.147 to 10", "duration"],
        ),
        ("--charge 1kg --standoff 0.14m --burst spherical --formula kinney_graham", &["0.147 to 40", "duration"]),
        ("--charge 8kg --standoff 1 --formula sadovsky", &["1 to 10", "holds there: \"kingery_bulmash\", \"swisdak\""]),
        ("--charge 1kg --standoff -20m", &["--standoff", "-20 m", "greater than 0"]),
        ("--charge 1000kg --standoff 1m --formula swisdak", &["0.1 m/kg", "\"swisdak\", 0.2 to 40", "2 to 400"]),
        ("--charge 1kg --height 11m --formula henrych", &["\"henrych\", 0.147 to 10"]),
        ("--charge 1kg --standoff 3m --formula brode", &["\"brode\"", "in free air", "burst"]),
        ("--charge 1kg", &["--standoff, --height or both"]),
        ("--charge 0 --standoff 3m", &["--charge", "greater than 0"]),
        ("--charge 1kg --standoff 3s", &["--standoff", "not a length"]),
        ("--charge 1kg --standoff 3 --explosive dynamit", &["--explosive", "there are: tnt, anfo"]),
    ];
    for (line, words) in lines {
        let outcome = bench.run_line(&format!("blast {line}"));
        assert_eq!((outcome.code, outcome.stdout.as_str()), (Some(1), ""), "{line}: {}", outcome.stderr);
        words.iter().for_each(|w| assert!(outcome.stderr.contains(w), "{line}: no {w} in {}", outcome.stderr));
    }
}

/// The pressure of a case, and what its sentence must contain.
#[test]
fn a_bad_charge_front_or_history_of_a_case_is_a_sentence() {
    let bench = Bench::new("bad_history");
    bench.write("unsorted.csv", "t [ms],p [kPa]\n0,1\n2,1\n1,0\n");
    bench.write("no_times.csv", "t,p\n,1\n,2\n");
    bench.write("one_unit.csv", "t [ms],p\n0,1\n2,1\n");
    bench.write("bad_unit.csv", "t [ms],p [kg]\n0,1\n2,1\n");
    bench.write("round.csv", "t (ms), p (kPa)\n0,100\n2,0\n");
    bench.write("slash.csv", "t/ms,p/kPa\n0,100\n2,0\n");
    bench.write("line.csv", "# made by hand\nt_ms p_kPa\n0 100\n2 0\n");
    bench.write("comment.csv", "# t [ms], p [kPa]\n0 100\n2 0\n");
    bench.write("comma.csv", "t;p\n0,5;100\n2,5;0\n");
    bench.write("quotes.csv", "t,p\n\"0\",\"100\"\n");
    let charge = |keys: &str| format!(r#"{{"law":"charge","explosion":{{"charge":"8kg",{keys}}}}}"#);
    let front = |keys: &str| format!(r#"{{"law":"step","peak":1,"front":{{{keys}}}}}"#);
    let rows: [(String, &[&str]); 33] = [
        (charge(r#""standoff":90,"wave":"incident""#), &["45 m/kg", "0.178 to 40 m/kg", "0.356 to 80 m"]),
        (
            charge(r#""at":[2.5,95],"burst":"spherical","wave":"incident""#),
            &["block.json: loads.top.pressure.explosion: at (1, 5) m of the curve", "45.006", "0.147 to 40"],
        ),
        (charge(r#""standoff":9"#), &["the key \"wave\" is missing"]),
        (charge(r#""at":[0,9],"wave":"incident""#), &["needs \"burst\""]),
        (charge(r#""at":[0,9],"standoff":9,"wave":"incident""#), &["either a point \"at\"", "here are both"]),
        (
            charge(r#""at":[-9,0],"burst":"hemispherical","wave":"incident""#),
            &["loads.top.pressure.explosion: the charge at (-9, 0) m lies 5 m under the curve"],
        ),
        (charge(r#""at":[2.5,1],"burst":"spherical","wave":"incident""#), &["lies 4 m under the curve", "buried"]),
        (charge(r#""standoff":9,"clock":"detonation","wave":"incident""#), &["\"clock\""]),
        (front(r#""speed":0,"direction":[1,0]"#), &["front.speed", "it is 0 m/s, and must be greater than 0"]),
        (front(r#""speed":"-3m/s","direction":[1,0]"#), &["front.speed", "greater than 0"]),
        (front(r#""direction":[1,0]"#), &["needs a \"speed\""]),
        (front(r#""speed":400"#), &["\"direction\"", "\"from\""]),
        (front(r#""speed":400,"direction":[1,0,0]"#), &["a list of 3 stands where a list of two"]),
        (
            r#"{"law":"step","peak":1,"front":{speed:479}}"#.into(),
            &["its value is no JSON, at character 33", "double quotes"],
        ),
        (front(r#""speed":400,"direction":[0,0]"#), &["zero vector"]),
        (r#"{"law":"table","file":"unsorted.csv"}"#.into(), &["unsorted.csv, line 4", "must ascend"]),
        (r#"{"law":"table","file":"no_times.csv"}"#.into(), &["no_times.csv, line 2", "a time"]),
        (r#"{"law":"table","file":"one_unit.csv"}"#.into(), &["one_unit.csv", "square brackets to both columns"]),
        (
            r#"{"law":"table","file":"bad_unit.csv"}"#.into(),
            &["bad_unit.csv, line 1", "\"kg\" is no unit of a pressure", "kPa"],
        ),
        (r#"{"law":"table","file":"round.csv"}"#.into(), &["round.csv, line 1", "t [ms], p [kPa]"]),
        (r#"{"law":"table","file":"slash.csv"}"#.into(), &["slash.csv, line 1", "t [ms], p [kPa]"]),
        (r#"{"law":"table","file":"line.csv"}"#.into(), &["line.csv, line 2", "t [ms], p [kPa]"]),
        (r#"{"law":"table","file":"comment.csv"}"#.into(), &["comment.csv, line 1", "take the # away"]),
        (r#"{"law":"table","file":"comma.csv"}"#.into(), &["comma.csv, line 2", "3 columns", "a decimal point"]),
        (r#"{"law":"table","file":"quotes.csv"}"#.into(), &["quotes.csv, line 2", "is no number", "no quotes"]),
        (
            r#"{"law":"table","file":"round.csv","times":[0,1]}"#.into(),
            &["loads.top.pressure", "both \"file\" and \"times\""],
        ),
        (
            r#"{"law":"table","values":[1,2]}"#.into(),
            &["\"times\" and \"values\" or a \"file\"", "\"times\" is missing"],
        ),
        (
            r#"{"law":"half_sine","peak":1,"duration":1,"rise":0.1}"#.into(),
            &["\"rise\"", "\"half_sine\" begins at zero"],
        ),
        (r#"{"law":"ramp","peak":1,"duration":1,"decay":1}"#.into(), &["\"decay\" is not its key"]),
        (r#"{"law":"friedlander","peak":1,"duration":1}"#.into(), &["one of \"decay\" and \"impulse\""]),
        (r#"{"law":"friedlander","peak":1,"duration":1,"impulse":0.8}"#.into(), &["0.8000 of peak times duration"]),
        (r#"{"law":"friedlander","peak":1,"duration":1,"decay":-1}"#.into(), &["decay", "greater than -1"]),
        (
            r#"{"law":"friedlander","peak":1,"duration":1,"decay":1,"negative_peak":1}"#.into(),
            &["\"negative_duration\""],
        ),
    ];
    for (pressure, words) in rows {
        for command in ["run", "check"] {
            let set = format!("loads.top.pressure={pressure}");
            let outcome = bench.run(&[command, "block.json", "--set", &set]);
            assert_eq!((outcome.code, outcome.stdout.as_str()), (Some(1), ""), "{set}: {}", outcome.stderr);
            words.iter().for_each(|w| assert!(outcome.stderr.contains(w), "{set}: no {w} in {}", outcome.stderr));
        }
    }
}

#[test]
fn check_names_the_front_against_the_grounds_waves() {
    let bench = Bench::new("front_words");
    // c_p = 259.4, c_s = 138.7 m/s of the ground
    for (speed, words) in
        [(300, "ground: superseismic"), (200, "ground: subseismic to P waves"), (50, "ground: subseismic (P and S")]
    {
        let set = format!(r#"loads.top.pressure.front={{"speed":{speed},"direction":[-1,0]}}"#);
        let told = bench.run(&["check", "block.json", "--set", &set]).stdout;
        assert!(told.contains(words) && told.contains(&format!("at {speed}.0 m/s")), "{told}");
        assert!(told.contains(&format!("load: pressure behind a front at {speed} m/s, at each point")), "{told}");
        assert!(!told.contains("body: su"), "a body behind an interface is no ground: {told}");
    }
    // straight down on a level surface, and nearly so: 1e-10 of direction is round-off of a unit vector
    for direction in ["[0,-1]", "[1e-10,-1]"] {
        let set = format!(r#"loads.top.pressure.front={{"speed":300,"direction":{direction}}}"#);
        let told = bench.run(&["check", "block.json", "--set", &set]).stdout;
        assert!(told.contains("reaches all of the curve at once, at ") && !told.contains("inf"), "{told}");
        assert!(!told.contains("seismic"), "{told}");
    }
}

/// Loads of nothing, loads that come when all is over, and damping that no ground has where the load lives.
#[test]
fn check_warns_of_loads_that_never_act_and_of_damping_by_beta_alone() {
    let bench = Bench::new("never_acts");
    let warned = |set: &str, words: &str| {
        let told = bench.run(&["check", "block.json", "--set", set]).stdout;
        assert!(told.lines().any(|l| l.starts_with("warning") && l.contains(words)), "{set}: no {words} in {told}");
    };
    warned("loads.top.pressure.start=1", "\"top\" never acts: it begins at 1 s, and the calculation ends at 0.01 s");
    warned("loads.top.pressure.scale=0", "\"top\" never acts: it is zero");
    warned("loads={}", "nothing loads or moves the model");
    // half of the energy of a triangle of 20 ms lies below 18 Hz: pi f beta = 57 %
    warned(r#"damping={"alpha":0,"beta":0.01}"#, "half of the energy of the load on top lies");
    let told = bench.run(&["check", "block.json", "--set", r#"damping={"alpha":0,"beta":0.0005}"#]).stdout;
    assert!(!told.contains("is that meant"), "{told}");
    let late = r#"loads.top.pressure={"law":"step","peak":1,"start":"2 ms","front":{"speed":500,"direction":[1,0]}}"#;
    let told = bench.run(&["check", "block.json", "--set", late]).stdout;
    // 5 m at 500 m/s, from 2 ms on
    assert!(
        told.contains("pressing from 0.002 s to 0.012 s on") && told.contains("not reached all of the curve"),
        "{told}"
    );
}

/// The top of a block 3 m wide, in elements of 1 m, pressed by `pressure`.
fn block(second_order: bool, pressure: Value) -> (Mesh, Value) {
    let mut drawing = support::Drawing::default();
    let rows = if second_order { 2 } else { 1 };
    let step = 1. / rows as f64;
    let count = 3 * rows + 1;
    for j in 0..=rows {
        for i in 0..count {
            drawing.node([i as f64 * step, j as f64 * step]);
        }
    }
    let at = |i: usize, j: usize| j * count + i;
    for e in 0..3 {
        let i = e * rows;
        let (l, r, t) = (i, i + rows, rows);
        let corners = [at(l, 0), at(r, 0), at(r, t), at(l, t)];
        if second_order {
            let middles = [at(l + 1, 0), at(r, 1), at(l + 1, t), at(l, 1)];
            drawing.cell("ground", Shape::Quad8, &[corners, middles].concat());
            drawing.cell("top", Shape::Line3, &[corners[2], corners[3], middles[2]]);
            drawing.cell("base", Shape::Line3, &[corners[0], corners[1], middles[0]]);
        } else {
            drawing.cell("ground", Shape::Quad4, &corners);
            drawing.cell("top", Shape::Line2, &[corners[2], corners[3]]);
            drawing.cell("base", Shape::Line2, &[corners[0], corners[1]]);
        }
    }
    let json = json!({
        "materials": { "ground": { "young": 1e8, "poisson": 0.3, "density": 2000 } },
        "supports": { "base": ["x", "y"] },
        "loads": { "top": { "pressure": pressure } },
        "time": { "step": "1 ms", "end": "10 ms" },
    });
    (drawing.mesh(), json)
}

/// Total force downwards [N] and its moment about x = 0 [N m].
fn resultant(model: &Model, sweep: &MovingFront, t: f64) -> [f64; 2] {
    sweep.forces(t).fold([0., 0.], |[f, m], (node, [_, fy])| [f - fy, m - fy * model.mesh.points[node][0]])
}

/// A step p behind a front at speed U has loaded the length s = U t: force p s, moment p s^2/2, at every time. Exact
/// for straight edges, so round-off.
#[test]
fn behind_a_front_the_force_is_pressure_times_the_length_it_has_passed() {
    for second_order in [false, true] {
        let pressure = json!({ "law": "step", "peak": 7, "front": { "speed": 100, "direction": [2, 0] } });
        let (mesh, json) = block(second_order, pressure);
        let model = support::model(&json, &mesh);
        let sweep = model.loads[0].front.as_ref().unwrap();
        for t in (0..400).map(|i| i as f64 * 1e-4) {
            let passed = (100. * t).min(3.);
            let [force, moment] = resultant(&model, sweep, t);
            assert!((force - 7. * passed).abs() < 1e-11, "t = {t}: {force}");
            assert!((moment - 3.5 * passed * passed).abs() < 1e-11, "t = {t}: {moment}");
        }
        let [first, last] = sweep.passage();
        assert!(first.abs() < 1e-15 && (last - 0.03).abs() < 1e-15);
        assert!(resultant(&model, sweep, -1e-9)[0] == 0.);
    }
}

/// A charge over the middle of an edge: the force is that of the pressure over x by 60,000 rectangles. These miss the
/// front by less than one of them, 5e-5 m of at least 0.3 m; three Gauss points an edge see the curved pressure to
/// 1e-3.
#[test]
fn a_charge_over_an_edge_loads_both_ways_and_without_jumps() {
    let keys = json!({ "charge": "8 kg", "at": [1.4, 3], "burst": "spherical", "wave": "incident" });
    let (mesh, json) = block(false, json!({ "law": "charge", "explosion": keys, "scale": 0.5 }));
    let model = support::model(&json, &mesh);
    let sweep = model.loads[0].front.as_ref().unwrap();
    let (formula, burst) = (Formula::KingeryBulmash, Burst::Spherical);
    let explosion = Explosion { tnt: 8., formula, burst, wave: Wave::Incident, form: Form::Friedlander };
    let zero = explosion.arrival(2.);
    let pressure = |x: f64, t: f64| {
        let r = (x - 1.4).hypot(2.);
        if explosion.arrival(r) - zero > t { 0. } else { 0.5 * explosion.pulse(r).at(t + zero - explosion.arrival(r)) }
    };
    let last = sweep.passage()[1];
    for t in [0.1, 0.3, 0.7, 0.99, 1.2, 3.].map(|part| part * last) {
        let n = 60_000;
        let expected: f64 = (0..n).map(|i| pressure(3. * (i as f64 + 0.5) / n as f64, t)).sum::<f64>() * 3. / n as f64;
        let [force, _] = resultant(&model, sweep, t);
        assert!((force / expected - 1.).abs() < 1.2e-3, "t = {t}: {force}, not {expected}");
    }
    let steps: Vec<f64> = (0..=4000).map(|i| resultant(&model, sweep, i as f64 / 2000. * last)[0]).collect();
    let largest = steps.windows(2).map(|w| (w[1] - w[0]).abs()).fold(0., f64::max);
    let peak = steps.iter().copied().fold(0., f64::max);
    // the most is loaded in the first step: up to s = sqrt(2 R U dt) on both sides of the point under the charge
    let under = explosion.parameters(2.);
    let most = 0.5 * under.incident.peak * 2. * (2. * 2. * under.front_speed * last / 2000.).sqrt();
    assert!(largest < 1.01 * most && most < 0.1 * peak, "{largest} N in one of 4000 steps, {most}");
    assert!(steps[0] < 1e-6 * peak, "{} N at t = 0", steps[0]); // round-off of t_a, under a square root
}

/// A front that takes 3 ns, and one from far away, load as everywhere at once; two loads of a list add up.
#[test]
fn a_very_fast_front_is_a_load_everywhere_at_once_and_loads_add_up() {
    let law = |front: Value| {
        let mut law = json!({ "law": "friedlander", "peak": "2 kPa", "duration": "8 ms", "decay": 1.2, "rise": "2 ms",
                              "negative_peak": "0.5 kPa", "negative_duration": "9 ms", "start": "1 ms" });
        if !front.is_null() {
            law["front"] = front;
        }
        law
    };
    let system = |law: Value, twice: bool| {
        let (mesh, mut json) = block(true, law);
        if twice {
            json["loads"] = json!([json["loads"], json["loads"]]);
        }
        System::new(&support::model(&json, &mesh)).unwrap()
    };
    let at_once = system(law(Value::Null), false);
    let fast = system(law(json!({ "speed": 1e9, "direction": [1, 0] })), false);
    let circle = system(law(json!({ "speed": 1e9, "from": [0, 9] })), false);
    let doubled = system(law(Value::Null), true);
    for t in [0.5e-3, 2e-3, 4e-3, 12e-3, 15e-3] {
        let expected = at_once.load(t);
        // 3 ns of a slope of 1e6 Pa/s or less
        for (found, factor) in [(fast.load(t), 1.), (circle.load(t), 1.), (doubled.load(t), 2.)] {
            assert!(found.iter().zip(&expected).all(|(f, e)| (f - factor * e).abs() < 0.02), "t = {t}");
        }
        assert!(t < 1e-3 || support::peak(&expected) > 100.);
    }
}

/// The work of a moving load is in the ledger: round-off of the peak energy, as with any load (README).
#[test]
fn a_run_behind_a_front_closes_its_energy_ledger() {
    let bench = Bench::new("front_run");
    let pressure = r#"loads.top.pressure={"law":"charge","explosion":{"charge":"100 kg","at":[-10,5],"burst":"hemispherical",
        "wave":"incident"},"rise":"0.5 ms"}"#;
    let outcome = bench.run(&["run", "block.json", "--set", pressure, "--set", "time.end=30ms", "--quiet"]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let summary: Value =
        serde_json::from_slice(&std::fs::read(bench.path("output/block/summary.json")).unwrap()).unwrap();
    assert!(number(&summary, "/energy/max_relative_error") < 1e-9, "{}", summary["energy"]);
}

/// The one load that a pressure of the case makes.
fn load(pressure: Value) -> Load {
    let (mesh, json) = block(false, pressure);
    support::model(&json, &mesh).loads.remove(0)
}

/// `scale` halves every law, at any time, the blast of a charge among them.
#[test]
fn scale_is_a_factor_on_every_law() {
    let charge = json!({ "charge": "8 kg", "standoff": "6 m", "wave": "reflected" });
    let laws = [
        json!({ "law": "linear", "peak": 8, "duration": 0.01 }),
        json!({ "law": "step", "peak": 8 }),
        json!({ "law": "ramp", "peak": 8, "duration": 0.01 }),
        json!({ "law": "half_sine", "peak": 8, "duration": 0.01 }),
        json!({ "law": "friedlander", "peak": 8, "duration": 0.002, "decay": 1, "negative_peak": 2, "negative_duration": 0.02 }),
        json!({ "law": "table", "times": [0, 0.01], "values": [8, 4] }),
        json!({ "law": "charge", "explosion": charge }),
    ];
    for law in laws {
        let mut half = law.clone();
        half["scale"] = json!(0.5);
        half["start"] = json!(0.001);
        let (whole, half) = (load(law.clone()).pulse, load(half).pulse);
        let times = [0.5e-3, 1.5e-3, 3e-3];
        assert!(times.iter().any(|&t| whole.at(t) != 0.), "{law}");
        // later by 1 ms: round-off of the time
        assert!(
            times.iter().all(|&t| (half.at(t + 1e-3) - 0.5 * whole.at(t)).abs() <= 1e-9 * whole.at(t).abs()),
            "{law}"
        );
    }
}

/// The averaged factors of TM 5-855-1, and a factor of the user's own before them.
#[test]
fn a_charge_counts_as_its_mass_of_tnt() {
    let bench = Bench::new("equivalence");
    let factors = [
        ("tnt", 1.),
        ("anfo", 0.82),
        ("composition_b", 1.11),
        ("c4", 1.37),
        ("h6", 1.38),
        ("minol", 1.2),
        ("octol", 1.06),
        ("petn", 1.27),
        ("pentolite", 1.42),
        ("tetryl", 1.07),
        ("tritonal", 1.07),
    ];
    let tnt = |line: &str| number(&blast(&bench, &format!("--charge 100 --standoff 20 {line}")), "/tnt_kg");
    for (name, factor) in factors {
        assert!((tnt(&format!("--explosive {name}")) / 100. - factor).abs() < 1e-12, "{name}");
    }
    assert!((tnt("--explosive c4 --equivalence 1.3") / 100. - 1.3).abs() < 1e-12);
}

/// Kingery and Bulmash at Z = 3 on the ground: U = 479.268 m/s, by an independent program, over the 3 m of the block.
#[test]
fn a_front_without_a_speed_has_the_shocks() {
    let charge = json!({ "charge": "1 t", "standoff": "30 m", "wave": "incident" });
    let load = load(json!({ "law": "charge", "explosion": charge, "front": { "direction": [1, 0] } }));
    let [first, last] = load.front.unwrap().passage();
    assert!(first == 0. && (last * 479.268 / 3. - 1.).abs() < 1e-5, "{first} {last}");
}

/// 8 kg on the level of the surface, 10 m from its end: Z = 5, t_a = 8.24491 ms/kg^(1/3) times 2.
#[test]
fn the_clock_counts_from_the_arrival_or_from_the_detonation() {
    for (clock, expected) in [("arrival", 0.), ("detonation", 16.48982e-3)] {
        let charge =
            json!({ "charge": "8 kg", "at": [-10, 1], "burst": "hemispherical", "wave": "incident", "clock": clock });
        let first = load(json!({ "law": "charge", "explosion": charge })).front.unwrap().passage()[0];
        assert!((first - expected).abs() < 1e-8, "{clock}: {first}");
    }
}

#[test]
fn a_file_gives_its_columns_in_the_units_of_its_heading() {
    let file = support::temporary("history.csv");
    std::fs::write(&file, "t [ms]; p [bar] # a comment\n1; 2\n3; 6\n").unwrap();
    let pulse = load(json!({ "law": "table", "file": file })).pulse;
    std::fs::remove_file(file).unwrap();
    for (t, expected) in [(0.9e-3, 0.), (1e-3, 2e5), (2e-3, 4e5), (9e-3, 6e5)] {
        assert!((pulse.at(t) - expected).abs() < 1e-6, "t = {t}: {}", pulse.at(t));
    }
}
