//! Section forces and hoop stress of pipe walls, against Lame, exact balance, and the ring in an infinite plane.

use coralpipe::model::case::{Case, Integrator, Newmark};
use coralpipe::model::mesh::{Cell, Group, Mesh, Shape};
use coralpipe::model::resolve::Model;
use coralpipe::model::ring::{NoRing, RingShape};
use coralpipe::physics::element::{self, Integral};
use coralpipe::results::ring::{Section, rings};
use coralpipe::results::sites::Sites;
use coralpipe::results::stress::Recovery;
use coralpipe::solve::law::Scheme;
use coralpipe::solve::start;
use coralpipe::solve::step::{Step, Stepper};
use coralpipe::solve::system::State;
use coralpipe::study::prepare::Prepared;
use std::collections::BTreeSet;
use std::f64::consts::PI;
use std::path::Path;

const SHAPES: [Shape; 4] = [Shape::Tri3, Shape::Quad4, Shape::Tri6, Shape::Quad8];

/// A wall from a to b in `layers`, and ground in `ground_layers` out to a box of half-width `width`, on `rays`.
#[derive(Clone, Copy)]
struct Polar {
    shape: Shape,
    rays: usize,
    radii: [f64; 2],
    layers: usize,
    ground_layers: usize,
    width: f64,
    /// sectors are 1 + uneven and 1 - uneven times as wide as their mean, in turn
    uneven: f64,
}

impl Polar {
    /// Place of a node; i and j count half layers outwards and half sectors anticlockwise.
    fn at(&self, i: usize, j: usize) -> [f64; 2] {
        // the second ray of four half sectors is turned, those between follow it by half
        let turned = self.uneven * [0., 0.5, 1., 0.5][j % 4];
        let angle = (j as f64 + 2. * turned) * PI / self.rays as f64;
        let [a, b] = self.radii;
        let outward = i as f64 / 2. - self.layers as f64;
        let to_box = self.width / angle.cos().abs().max(angle.sin().abs());
        let r = match outward <= 0. {
            true => b + (b - a) * outward / self.layers as f64,
            false => b * (to_box / b).powf(outward / self.ground_layers as f64),
        };
        [r * angle.cos(), r * angle.sin()]
    }

    /// Groups: pipe, ground, interface (the pipe's outer face), bore, top, left, bottom, right; points east, north,
    /// west, south on the border.
    fn mesh(&self) -> Mesh {
        let (m, n) = (2 * (self.layers + self.ground_layers), 2 * self.rays);
        let number = |i: usize, j: usize| i * n + j % n;
        let mut mesh = Mesh { name: "polar".into(), ..Mesh::default() };
        mesh.points = (0..=m).flat_map(|i| (0..n).map(move |j| self.at(i, j))).collect();
        mesh.tags = (1..=mesh.points.len()).collect();
        let second = self.shape.node_count() > 4;
        let mut groups: Vec<(&str, usize, Vec<usize>)> = vec![];
        let mut add = |mesh: &mut Mesh, name: &'static str, shape: Shape, nodes: Vec<usize>| {
            mesh.cells.push(Cell { shape, nodes });
            if groups.iter().all(|g| g.0 != name) {
                groups.push((name, shape.dimension(), vec![]));
            }
            groups.iter_mut().find(|g| g.0 == name).unwrap().2.push(mesh.cells.len() - 1);
        };
        for (i, j) in (0..m / 2).flat_map(|i| (0..n / 2).map(move |j| (2 * i, 2 * j))) {
            let name = if i / 2 < self.layers { "pipe" } else { "ground" };
            // lattice places of the corners, then of the mid-sides between them
            let quad = [(i, j), (i + 2, j), (i + 2, j + 2), (i, j + 2)];
            let parts = if self.shape.corner_count() == 4 {
                vec![vec![0, 1, 2, 3]]
            } else {
                vec![vec![0, 1, 2], vec![0, 2, 3]]
            };
            for corners in parts {
                let corners: Vec<(usize, usize)> = corners.into_iter().map(|c| quad[c]).collect();
                let middle = |k: usize| {
                    let (p, q) = (corners[k], corners[(k + 1) % corners.len()]);
                    ((p.0 + q.0) / 2, (p.1 + q.1) / 2)
                };
                let middles = (0..corners.len()).filter(|_| second).map(middle);
                let nodes = corners.iter().copied().chain(middles).map(|(i, j)| number(i, j)).collect();
                add(&mut mesh, name, self.shape, nodes);
            }
        }
        let line = if second { Shape::Line3 } else { Shape::Line2 };
        for j in (0..n).step_by(2) {
            let along = |i: usize| [j, j + 2, j + 1].iter().take(line.node_count()).map(|&j| number(i, j)).collect();
            let side = ["right", "top", "left", "bottom"][(j * 4 + n / 2) / n % 4];
            add(&mut mesh, "bore", line, along(0));
            add(&mut mesh, "interface", line, along(2 * self.layers));
            if self.ground_layers > 0 {
                add(&mut mesh, side, line, along(m));
            }
        }
        for (k, name) in ["east", "north", "west", "south"].into_iter().enumerate() {
            add(&mut mesh, name, Shape::Point, vec![number(m, k * n / 4)]);
        }
        mesh.groups =
            groups.into_iter().map(|(name, dimension, cells)| Group { name: name.into(), dimension, cells }).collect();
        mesh
    }
}

/// What holds a body under loads that balance each other.
const HELD: &str = r#""supports": { "east": ["y"], "west": ["y"], "north": ["x"], "south": ["x"] }"#;

fn prepared(name: &str, json: &str, mesh: &Mesh, bonded: bool) -> Prepared {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("ring");
    std::fs::create_dir_all(&folder).unwrap();
    let path = folder.join(format!("{name}.json"));
    std::fs::write(&path, json).unwrap();
    let case = Case::read(&path, &[]).unwrap();
    Prepared::new(Model::new(&case, mesh, bonded).unwrap()).unwrap()
}

/// One static step to t = 1 s.
fn statics(prepared: &Prepared) -> State {
    let Prepared { model, system, symbolic, .. } = prepared;
    let mut stepper = Stepper::new(system, symbolic, Scheme::Static, 1., model.newton).unwrap();
    stepper.step(system, &Step::start(State::at_rest(system))).unwrap().into_state()
}

fn sections(prepared: &Prepared, state: &State) -> Vec<Section> {
    let rings = rings(&prepared.model, &prepared.system, prepared.rayleigh);
    assert_eq!(rings.len(), 1);
    rings[0].sections(&prepared.model, &prepared.system, state, &State::at_rest(&prepared.system).q)
}

/// Largest distance from a value over all rays, over `scale`.
fn worst(sections: &[Section], of: impl Fn(&Section) -> f64, exact: f64, scale: f64) -> f64 {
    sections.iter().map(|s| (of(s) - exact).abs() / scale.abs()).fold(0., f64::max)
}

/// The paper's pipe alone under 1 MPa from outside or inside.
fn lame(shape: Shape, rays: usize, layers: usize, loaded: &str) -> (Prepared, State) {
    let mesh = Polar { shape, rays, radii: [0.4, 0.6], layers, ground_layers: 0, width: 0.6, uneven: 0. }.mesh();
    let json = format!(
        r#"{{ "analysis": "static", "materials": {{ "pipe": {{ "young": 2.1e11, "poisson": 0.3, "density": 7800 }} }},
        "interfaces": {{ "interface": {{ "body": "pipe" }} }}, {HELD}, "time": {{ "step": 1, "end": 1 }},
        "loads": {{ "{loaded}": {{ "pressure": {{ "law": "step", "peak": "1 MPa" }} }} }} }}"#
    );
    let prepared = prepared(&format!("lame_{shape:?}_{rays}_{loaded}"), &json, &mesh, true);
    let state = statics(&prepared);
    (prepared, state)
}

/// sigma_theta = A + B / r^2: N = -p_o b or p_i a, M = B (ln(b/a) - r_m (1/a - 1/b)).
#[test]
fn a_free_ring_under_pressure_has_lames_forces_and_hoop_stress() {
    let (a, b): (f64, f64) = (0.4, 0.6);
    // N, hoop at a and b (VERIFICATION: Lame), B
    let cases = [
        ("interface", -1e6 * b, [-3.6e6, -2.6e6], -1e6 * 0.36 * 0.16 / 0.2),
        ("bore", 1e6 * a, [2.6e6, 1.6e6], 1e6 * 0.36 * 0.16 / 0.2),
    ];
    for (loaded, n, hoop, capital_b) in cases {
        let m = capital_b * ((b / a).ln() - 0.5 * (1. / a - 1. / b));
        for shape in SHAPES {
            let errors = [(32, 2), (64, 4), (128, 8)].map(|(rays, layers)| {
                let (prepared, state) = lame(shape, rays, layers, loaded);
                let s = sections(&prepared, &state);
                [
                    worst(&s, |s| s.normal_force, n, n),
                    worst(&s, |s| s.shear_force, 0., n),
                    worst(&s, |s| s.moment, m, m),
                    worst(&s, |s| s.hoop[0], hoop[0], hoop[0]),
                    worst(&s, |s| s.hoop[1], hoop[1], hoop[1]),
                ]
            });
            println!("{loaded} {shape:?} [N, Q, M, hoop a, hoop b]");
            errors
                .iter()
                .for_each(|e| println!("   {:9.1e} {:9.1e} {:9.1e} {:9.1e} {:9.1e}", e[0], e[1], e[2], e[3], e[4]));
            let hoop = if shape == Shape::Tri3 { 0.04 } else { 0.01 };
            assert!(errors.iter().all(|e| e[0] < 1e-11 && e[1] < 1e-11), "{shape:?}: N, Q");
            assert!(errors[1][3] < hoop && errors[1][4] < hoop, "{shape:?}: hoop");
            // observed order of M: 2 for T3 and Q4, 4 for T6 and Q8
            let order = (errors[1][2] / errors[2][2]).log2();
            assert!(order > if shape.node_count() > 4 { 3.8 } else { 1.9 }, "{shape:?}: order {order}");
        }
    }
}

/// Error of nodal sigma_theta and sigma_r under 1 MPa from outside, over 3.6 MPa: root mean square, and the largest.
fn nodal_error(shape: Shape, rays: usize, layers: usize) -> [f64; 2] {
    let (prepared, state) = lame(shape, rays, layers, "interface");
    let sites = Sites::new(&prepared.model);
    let u = prepared.system.unknowns.at_nodes(&state.q);
    let recovery = Recovery::new(&prepared.model, &sites);
    let stress = recovery.nodal_stresses(&u, &recovery.stresses(&u));
    let used: BTreeSet<usize> = sites.faces.iter().flatten().copied().collect();
    let error = |&site: &usize| {
        let ([x, y], [xx, yy, zz, xy]) = (prepared.model.mesh.points[sites.nodes[site]], stress[site]);
        let r2 = x * x + y * y;
        let radial = (xx * x * x + yy * y * y + 2. * xy * x * y) / r2;
        // Lame: -A -+ B / r^2, A = p b^2 / (b^2 - a^2), B = p a^2 b^2 / (b^2 - a^2); sigma_zz = nu (sigma_r + sigma_theta)
        let (a, b) = (0.36e6 / 0.2, 0.0576e6 / 0.2);
        assert!((zz - 0.3 * (xx + yy)).abs() < 1e-3);
        ((xx + yy - radial + a + b / r2) / 3.6e6).hypot((radial + a - b / r2) / 3.6e6)
    };
    let errors: Vec<f64> = used.iter().map(error).collect();
    let mean_square = errors.iter().map(|e| e * e).sum::<f64>() / errors.len() as f64;
    [mean_square.sqrt(), errors.iter().copied().fold(0., f64::max)]
}

/// Element stress is of order p; the mean of what elements extrapolate to a node was measured at 1.4, 1.4, 2, 2 in the
/// mean square, on a quarter. Recovered: p + 1 on this mesh; observed 2.25, 2.36, 2.96, 3.33, asked a quarter less.
#[test]
fn nodal_stress_converges_faster_than_the_elements_to_lames() {
    for (shape, order, finest) in
        [(Shape::Tri3, 2., 5e-3), (Shape::Quad4, 2.1, 3e-3), (Shape::Tri6, 2.7, 1e-4), (Shape::Quad8, 3.1, 1e-4)]
    {
        let errors = [(64, 4), (128, 8)].map(|(rays, layers)| nodal_error(shape, rays, layers));
        let observed = [0, 1].map(|k| (errors[0][k] / errors[1][k]).log2());
        println!("{shape:?} [rms, largest]: {errors:.6?}, orders {observed:.2?}");
        assert!(observed[0] > order, "{shape:?}");
        assert!(errors[1][0] < finest, "{shape:?}");
    }
}

/// The body's faces in the half from ray i anticlockwise to the opposite ray.
fn half(shape: &RingShape, i: usize) -> Vec<usize> {
    let n = shape.rays.len();
    shape.sectors.iter().filter(|(_, s)| (s + n - i) % n < n / 2).map(|(cell, _)| *cell).collect()
}

/// Rate of momentum of faces, with the part alpha v of Rayleigh damping: integral of rho (a + alpha v) [N].
fn inertia(prepared: &Prepared, state: &State, cells: &[usize]) -> [f64; 2] {
    let Prepared { model, system, rayleigh, .. } = prepared;
    let mut sum = [0.; 2];
    for cell in cells.iter().map(|&c| &model.mesh.cells[c]) {
        let at: Vec<[f64; 2]> = cell.nodes.iter().map(|&n| model.mesh.points[n]).collect();
        for p in element::points(cell.shape, &at, Integral::Mass) {
            for (n, &node) in p.n.iter().zip(&cell.nodes) {
                let [a, v] = [&state.a, &state.v].map(|x| system.unknowns.at_node(x, node));
                (0..2).for_each(|k| sum[k] += 7800. * n * p.dv * (a[k] + rayleigh.alpha * v[k]));
            }
        }
    }
    sum
}

/// What is missing in: forces of the two cuts + joint forces between them = inertia; over the largest |N|.
fn imbalance(prepared: &Prepared, state: &State) -> f64 {
    let Prepared { model, system, .. } = prepared;
    let shape = RingShape::find(&model.mesh, &model.mesh.group("pipe").unwrap().cells).unwrap();
    let sections = sections(prepared, state);
    let n = sections.len();
    // on the part anticlockwise of a cut acts -(N e_theta + Q e_r)
    let force = |s: &Section| {
        let (sin, cos) = s.angle.sin_cos();
        [-s.normal_force * -sin + s.shear_force * -cos, -s.normal_force * cos + s.shear_force * -sin]
    };
    let missing = |i: usize| {
        let cells = half(&shape, i);
        let (first, last, inertia) =
            (force(&sections[i]), force(&sections[(i + n / 2) % n]), inertia(prepared, state, &cells));
        let mut sum = [0, 1].map(|k| first[k] - last[k] - inertia[k]);
        for (point, joint) in system.interface.points.iter().zip(&state.joints) {
            for (_, area) in point.parts.iter().filter(|(element, _)| cells.contains(&model.joints[*element].body_cell))
            {
                let f = point.rotation().transpose() * joint.traction * *area;
                (0..2).for_each(|k| sum[k] += f[k]);
            }
        }
        // the bore's chords between two opposite corners carry the pressure times the diameter
        let (sin, cos) = sections[i].angle.sin_cos();
        sum[0] -= BORE_PRESSURE * 0.8 * sin;
        sum[1] += BORE_PRESSURE * 0.8 * cos;
        sum[1] -= 7800. * 9.81 * cells.iter().map(|&c| model.mesh.measure(&model.mesh.cells[c])).sum::<f64>();
        sum[0].hypot(sum[1])
    };
    let largest = sections.iter().map(|s| s.normal_force.abs()).fold(0., f64::max);
    assert!(largest > 1e3, "nothing acts");
    (0..n).map(missing).fold(0., f64::max) / largest
}

const COARSE: Polar =
    Polar { shape: Shape::Quad4, rays: 32, radii: [0.4, 0.6], layers: 2, ground_layers: 10, width: 5., uneven: 0. };

const BORE_PRESSURE: f64 = 20e3;
fn buried(analysis: &str, integration: &str) -> String {
    format!(
        r#"{{ "analysis": "{analysis}", "materials": {{
            "pipe": {{ "young": 2.1e11, "poisson": 0.3, "density": 7800 }},
            "ground": {{ "young": 5.19e8, "poisson": 0.38, "density": 2600 }} }},
        "interfaces": {{ "interface": {{ "body": "pipe", "friction": 0.2, "integration": "{integration}" }} }},
        "supports": {{ "bottom": ["x", "y"], "left": ["x"] }}, "gravity": 9.81, "newton": {{ "tolerance": 1e-10 }},
        "damping": {{ "alpha": 5, "beta": 4e-4 }}, "time": {{ "step": 2e-4, "end": 0.02 }},
        "loads": [ {{ "top": {{ "pressure": {{ "law": "linear", "peak": "300 kPa", "duration": 0.01 }} }} }},
                   {{ "bore": {{ "pressure": {{ "law": "step", "peak": {BORE_PRESSURE} }} }} }},
                   {{ "right": {{ "traction": {{ "law": "step", "peak": "40 kPa", "direction": [-1, 0.3] }} }} }} ] }}"#
    )
}

#[test]
fn opposite_cuts_balance_the_joint_tractions_between_them() {
    let lobatto = SHAPES.map(|shape| (shape, "lobatto"));
    // one point an element has each element's own normal and traction: only its own force goes to its side of a cut
    for (shape, integration) in lobatto.into_iter().chain([(Shape::Quad4, "gauss_1")]) {
        let name = format!("balance_{shape:?}_{integration}");
        let prepared =
            prepared(&name, &buried("static", integration), &Polar { shape, uneven: 0.2, ..COARSE }.mesh(), false);
        let state = statics(&prepared);
        assert!(state.joints.iter().any(|j| j.status.is_slipping()));
        let imbalance = imbalance(&prepared, &state);
        println!("{name}: {imbalance:.1e}");
        assert!(imbalance < 1e-9);
    }
}

#[test]
fn opposite_cuts_balance_tractions_and_inertia_while_the_pipe_moves() {
    let json = buried("dynamic", "lobatto");
    let prepared = prepared("balance_dynamic", &json, &COARSE.mesh(), false);
    let Prepared { model, system, symbolic, .. } = &prepared;
    let scheme = Scheme::Dynamic(Integrator { newmark: Newmark::default(), hht: 0. });
    let mut stepper = Stepper::new(system, symbolic, scheme, model.time.step, model.newton).unwrap();
    let rest = start::under_gravity(system, symbolic, model.newton).unwrap().unwrap();
    let mut last = Step::start(start::with_acceleration(system, symbolic, rest, model.start).unwrap());
    for step in 1..=100 {
        last = stepper.step(system, &last).unwrap();
        let state = last.state();
        if step % 20 == 0 {
            let imbalance = imbalance(&prepared, state);
            println!(
                "step {step}: {imbalance:.1e}, inertia {:.0?}",
                inertia(&prepared, state, &prepared.model.mesh.group("pipe").unwrap().cells)
            );
            assert!(imbalance < 1e-9);
        }
    }
}

/// The far field sv = -100 kPa, sh = K sv on a box, and the pipe in it.
fn in_plane(name: &str, polar: Polar, pipe: &str, ground: [f64; 2], interface: &str, bonded: bool) -> Vec<Section> {
    let (prepared, state) = far_field(name, polar, pipe, ground, interface, bonded);
    sections(&prepared, &state)
}

fn far_field(
    name: &str,
    polar: Polar,
    pipe: &str,
    ground: [f64; 2],
    interface: &str,
    bonded: bool,
) -> (Prepared, State) {
    let [young, poisson] = ground;
    let side = 100e3 * poisson / (1. - poisson);
    let pressure = |name: &str, p: f64| format!(r#""{name}": {{ "pressure": {{ "law": "step", "peak": {p} }} }}"#);
    let loads = [pressure("top", 100e3), pressure("bottom", 100e3), pressure("left", side), pressure("right", side)];
    let json = format!(
        r#"{{ "analysis": "static", "materials": {{ "pipe": {pipe},
            "ground": {{ "young": {young}, "poisson": {poisson}, "density": 2600, "friction": 0 }} }},
        "interfaces": {{ "interface": {{ "body": "pipe" {interface} }} }}, {HELD},
        "time": {{ "step": 1, "end": 1 }}, "loads": {{ {} }} }}"#,
        loads.join(", ")
    );
    let prepared = prepared(name, &json, &polar.mesh(), bonded);
    println!("{name}: {} unknowns", prepared.system.unknowns.count);
    let state = statics(&prepared);
    (prepared, state)
}

/// Springline and crown: [hoop in, hoop out, N, M, p_r, u_r] against the reference; relative to the larger of the two
/// places.
fn errors(sections: &[Section], springline: [f64; 6], crown: [f64; 6]) -> [[f64; 6]; 2] {
    let values = |s: &Section| [s.hoop[0], s.hoop[1], s.normal_force, s.moment, s.traction[0], s.displacement[0]];
    let at = |place: usize, exact: [f64; 6], other: [f64; 6]| {
        let got = values(&sections[place * sections.len() / 4]);
        [0, 1, 2, 3, 4, 5].map(|k| (got[k] - exact[k]) / exact[k].abs().max(other[k].abs()))
    };
    [at(0, springline, crown), at(1, crown, springline)]
}

const RING: &str = r#"{ "young": 3e10, "poisson": 0.2, "density": 2500 }"#;
const BONDED: [[f64; 6]; 2] = [
    [-5.02567e6, 1.89894e6, -143.772e3, 5.7543e3, -111.862e3, 0.633766e-3],
    [2.96925e6, -3.76001e6, -51.588e3, -5.5919e3, -83.499e3, -0.691757e-3],
];
const SMOOTH: [[f64; 6]; 2] = [
    [-5.89967e6, 3.45384e6, -105.777e3, 7.7731e3, -73.390e3, 0.866775e-3],
    [3.84324e6, -5.31491e6, -89.584e3, -7.6106e3, -121.970e3, -0.924766e-3],
];
const STEEL: &str = r#"{ "young": 2.1e11, "poisson": 0.3, "density": 7800 }"#;
const PAPERS: [[f64; 6]; 2] = [
    [-1.1171e6, 0.1383e6, -79.182e3, 4.0134e3, -69.400e3, 0.001749e-3],
    [0.3997e6, -0.6565e6, -40.395e3, -3.3705e3, -129.894e3, -0.002874e-3],
];

fn all_within(name: &str, sections: &[Section], exact: [[f64; 6]; 2], tolerance: f64) {
    let errors = errors(sections, exact[0], exact[1]);
    println!("{name}: {errors:.4?}, tau at 45 deg {:.0}", sections[sections.len() / 8].traction[1]);
    assert!(errors.as_flattened().iter().all(|e| e.abs() < tolerance), "{name}");
}

/// VERIFICATION: exact elastic ring in an infinite plane. A wall of Q4 that are long for its thickness is too stiff by
/// (G/E')(l/h)^2, 9 % here: its order is 2, that of the second-order meshes higher.
#[test]
fn a_buried_ring_has_the_exact_forces_bonded_stuck_and_frictionless() {
    for (shape, rays, layers, ground, tolerance) in
        [(Shape::Quad4, 128, 4, 96, 0.08), (Shape::Quad8, 64, 2, 24, 0.003), (Shape::Tri6, 64, 2, 24, 0.005)]
    {
        let polar = Polar { shape, rays, radii: [0.9, 1.0], layers, ground_layers: ground, width: 40., uneven: 0. };
        let run = |name: &str, interface: &str, bonded: bool, exact| {
            let name = format!("{name}_{shape:?}_{rays}");
            let sections = in_plane(&name, polar, RING, [1e8, 0.25], interface, bonded);
            all_within(&name, &sections, exact, tolerance);
            sections
        };
        let bonded = run("bonded", "", true, BONDED);
        // tau(45 degrees) = -76.229 kPa; its mean over the hat of length h is 1 - 4 h^2 / 12 of it, 0.3 % less on 64 rays
        let tau = bonded[bonded.len() / 8].traction[1].abs();
        // (Q4 are as far off as their bending is)
        assert!((tau / 76.229e3 - 1.).abs() < if shape == Shape::Quad4 { 0.08 } else { 0.006 }, "{shape:?}: tau {tau}");
        let stiff = r#", "normal_stiffness": 1e13, "tangential_stiffness": 1e13"#;
        run("stuck", &format!(r#"{stiff}, "friction": 1e3"#), false, BONDED);
        run("smooth", &format!(r#"{stiff}, "friction": 0"#), false, SMOOTH);
    }
}

/// VERIFICATION: the paper's pipe bonded to its second layer.
#[test]
fn the_papers_pipe_has_the_exact_forces() {
    for (shape, rays, ground, tolerance) in
        [(Shape::Quad4, 64, 48, 0.035), (Shape::Quad4, 128, 96, 0.01), (Shape::Quad8, 64, 24, 0.002)]
    {
        let polar =
            Polar { shape, rays, radii: [0.4, 0.6], layers: rays / 16, ground_layers: ground, width: 24., uneven: 0. };
        let name = format!("paper_{shape:?}_{rays}");
        let sections = in_plane(&name, polar, STEEL, [519e6, 0.38], "", true);
        all_within(&name, &sections, PAPERS, tolerance);
    }
}

/// Which hoop stress to take at a wall's faces. At the bore stress grows as 1/r^2 to 1/r^4; rings.csv fits these terms,
/// recovery at the nodes (superconvergent patches) extrapolates from inside by a polynomial of first degree: on a wall of
/// four linear elements it misses three times as much. Exact: -1.1171 MPa at the springline, 0.3997 at the crown.
#[test]
fn at_the_bore_the_hoop_stress_of_a_section_is_nearer_to_the_exact_one_than_that_of_recovery() {
    let polar = Polar {
        shape: Shape::Quad4,
        rays: 64,
        radii: [0.4, 0.6],
        layers: 4,
        ground_layers: 48,
        width: 24.,
        uneven: 0.,
    };
    let (prepared, state) = far_field("paper_recovery", polar, STEEL, [519e6, 0.38], "", true);
    let sections = sections(&prepared, &state);
    let sites = Sites::new(&prepared.model);
    let u = prepared.system.unknowns.at_nodes(&state.q);
    let recovery = Recovery::new(&prepared.model, &sites);
    let stress = recovery.nodal_stresses(&u, &recovery.stresses(&u));
    let at = |place: [f64; 2]| {
        let is_there = |&node: &usize| {
            let [x, y] = prepared.model.mesh.points[node];
            (x - place[0]).hypot(y - place[1]) < 1e-9
        };
        stress[sites.nodes.iter().position(is_there).unwrap()]
    };
    // sigma_theta is sigma_yy at the springline and sigma_xx at the crown
    for (quarter, nodal, exact) in [(0, at([0.4, 0.])[1], PAPERS[0][0]), (1, at([0., 0.4])[0], PAPERS[1][0])] {
        let section = sections[quarter * sections.len() / 4].hoop[0];
        let [of_section, of_recovery] = [section, nodal].map(|value| (value - exact).abs() / PAPERS[0][0].abs());
        println!("hoop at the bore: exact {exact:.4e}, section {section:.4e}, recovery {nodal:.4e}");
        // the wall of Q4 is 2 % too stiff in bending, which both share
        assert!(of_section < 0.03 && of_recovery > 2. * of_section, "{of_section} and {of_recovery}");
    }
}

/// Pressure p in the bore of a ring bonded to ground of its own material: sigma_r = -p (a/r)^2, Q = 0 at every cut. The
/// ground's hold on a bonded pipe is not told apart by elements; half of it to each side of a cut, whatever their
/// lengths, would make Q = sigma_r (l_after - l_before) / 4, here 0.5 % of p a.
#[test]
fn a_cut_between_sectors_of_unlike_length_shares_the_grounds_hold_by_them() {
    let ring = Polar { shape: Shape::Quad4, rays: 128, radii: [0.9, 1.0], layers: 2, ground_layers: 60, ..COARSE };
    let polar = Polar { width: 40., uneven: 0.25, ..ring };
    let json = format!(
        r#"{{ "analysis": "static", "materials": {{ "pipe": {RING}, "ground": {RING} }},
        "interfaces": {{ "interface": {{ "body": "pipe" }} }}, {HELD}, "time": {{ "step": 1, "end": 1 }},
        "loads": {{ "bore": {{ "pressure": {{ "law": "step", "peak": "100 kPa" }} }} }} }}"#
    );
    let prepared = prepared("uneven", &json, &polar.mesh(), true);
    let sections = sections(&prepared, &statics(&prepared));
    let q = sections.iter().map(|s| s.shear_force.abs()).fold(0., f64::max) / (100e3 * 0.9);
    println!("uneven sectors: Q / (p a) {q:.1e}");
    // the box far away, which is not round, leaves 4e-6
    assert!(q < 1e-4);
}

#[test]
fn a_body_of_another_shape_is_no_ring() {
    let mesh = COARSE.mesh();
    let found = |name: &str| RingShape::find(&mesh, &mesh.group(name).unwrap().cells);
    assert!(found("pipe").is_ok_and(|ring| ring.rays.len() == 32 && ring.radii.len() == 3));
    assert!(matches!(found("ground"), Err(NoRing::NotRound("outer border", _))));
    let pipe = &mesh.group("pipe").unwrap().cells;
    assert!(matches!(RingShape::find(&mesh, &pipe[1..]), Err(NoRing::NotRound("bore", _))));
    assert_eq!(RingShape::find(&mesh, &[]), Err(NoRing::Parts(0)));
}

/// Each shape's own reason, on one mesh of 32 rays and 3 rings of nodes that is bent or cut into it.
#[test]
fn a_body_that_is_no_ring_has_the_reason_that_holds() {
    let straight = COARSE.mesh();
    let pipe = straight.group("pipe").unwrap().cells.clone();
    let bent = |of: &dyn Fn([f64; 2]) -> [f64; 2]| {
        let mesh = Mesh { points: straight.points.iter().map(|&p| of(p)).collect(), ..straight.clone() };
        RingShape::find(&mesh, &pipe).unwrap_err()
    };
    // the bore's nodes at 0.4 m, moved to the right by 1 cm
    let NoRing::Eccentric(off) = bent(&|[x, y]| if x.hypot(y) < 0.41 { [x + 0.01, y] } else { [x, y] }) else {
        panic!("an eccentric bore")
    };
    assert!((off - 0.01).abs() < 1e-9);
    // a square of half-width r, with round bore and without: its corners are sqrt(2) times as far away as its sides
    let square = |[x, y]: [f64; 2]| [x, y].map(|k| k * x.hypot(y) / x.abs().max(y.abs()));
    let NoRing::NotRound("outer border", [least, most]) = bent(&square) else { panic!("a box") };
    assert!((least - 0.6).abs() < 1e-9 && (most - 0.6 * 2f64.sqrt()).abs() < 1e-9);
    let of_bore = |p: [f64; 2]| if p[0].hypot(p[1]) < 0.41 { square(p).map(|x| x / 2.) } else { p };
    assert!(matches!(bent(&of_bore), NoRing::NotRound("bore", _)));
    // an ellipse
    assert!(matches!(bent(&|[x, y]| [x, 1.001 * y]), NoRing::NotRound("outer border", _)));
    // one node between the faces off its ray; all of them turned; one off its radius
    let one = straight.points.iter().position(|[x, y]| (x.hypot(*y) - 0.5).abs() < 1e-9).unwrap();
    let place = straight.points[one];
    let off_ray = |p: [f64; 2]| if p == place { [p[0], p[1] + 0.01] } else { p };
    assert_eq!(bent(&off_ray), NoRing::Unstructured([place[0], place[1] + 0.01]));
    let between =
        |[x, y]: [f64; 2]| if (x.hypot(y) - 0.5).abs() < 1e-9 { [x - 0.02 * y, y + 0.02 * x] } else { [x, y] };
    assert!(matches!(bent(&between), NoRing::Unstructured(_)));
    let off_radius = |p: [f64; 2]| if p == place { p.map(|x| 1.02 * x) } else { p };
    assert!(matches!(bent(&off_radius), NoRing::Unstructured(_)));
    // half of it, two quarters apart, a notch in the bore, one in the outer face
    let sectors = RingShape::find(&straight, &pipe).unwrap().sectors;
    let cut = |keeps: &dyn Fn(usize, usize) -> bool| {
        let cells =
            sectors.iter().enumerate().filter(|(i, (_, sector))| keeps(*i, *sector)).map(|(_, (cell, _))| *cell);
        RingShape::find(&straight, &cells.collect::<Vec<_>>()).unwrap_err()
    };
    assert_eq!(cut(&|_, sector| sector < 16), NoRing::Bores(0));
    assert_eq!(cut(&|_, sector| sector < 8 || (16..24).contains(&sector)), NoRing::Parts(2));
    let inner = |cell: usize| straight.centroid(&straight.cells[cell]).iter().fold(0f64, |r, x| r.hypot(*x)) < 0.5;
    assert!(matches!(cut(&|i, sector| sector != 3 || !inner(sectors[i].0)), NoRing::NotRound("bore", _)));
    let outer_hole = cut(&|i, sector| sector != 3 || inner(sectors[i].0));
    assert!(matches!(outer_hole, NoRing::NotRound("outer border", _)), "{outer_hole:?}");
    assert_eq!(NoRing::Bores(2).to_string(), "it has 2 bores");
}

/// Triangles that Gmsh lays at will into a round wall: the reason names where they leave the rays.
#[test]
fn unstructured_triangles_in_a_round_wall_are_no_ring_of_rays() {
    let inputs = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/inputs/walls_that_cannot_be_cut");
    let found = |name: &str| {
        let mesh = Mesh::read(&inputs.join(name)).unwrap();
        RingShape::find(&mesh, &mesh.group("wall").unwrap().cells).unwrap_err()
    };
    let NoRing::Unstructured([x, y]) = found("unstructured_triangles.msh") else { panic!("triangles") };
    assert!((0.8 - 1e-9..1. + 1e-9).contains(&x.hypot(y + 3.)), "({x}, {y}) m is not in the wall");
    assert!(matches!(found("paved_quadrangles.msh"), NoRing::Unstructured(_)));
    assert!(matches!(found("box.msh"), NoRing::NotRound("outer border", _)));
    assert!(matches!(found("eccentric_bore.msh"), NoRing::Eccentric(d) if (d - 0.05).abs() < 1e-6));
}

/// A front that takes 1 ns over the bore is a load everywhere at once: the same section forces to round-off.
#[test]
fn a_front_over_the_bore_gives_the_ring_its_load() {
    let mesh =
        Polar { shape: Shape::Quad8, rays: 32, radii: [0.4, 0.6], layers: 2, ground_layers: 0, width: 0.6, uneven: 0. }
            .mesh();
    let ring = |name: &str, front: &str| {
        let json = format!(
            r#"{{ "analysis": "static", "materials": {{ "pipe": {{ "young": 2.1e11, "poisson": 0.3, "density": 7800 }} }},
            "interfaces": {{ "interface": {{ "body": "pipe" }} }}, {HELD}, "time": {{ "step": 1, "end": 1 }},
            "loads": {{ "bore": {{ "pressure": {{ "law": "step", "peak": "1 MPa"{front} }} }} }} }}"#
        );
        let prepared = prepared(name, &json, &mesh, true);
        sections(&prepared, &statics(&prepared))
    };
    let front = r#", "front": { "speed": 1e9, "direction": [1, 0.3] }"#;
    for (at_once, swept) in ring("bore_at_once", "").iter().zip(&ring("bore_swept", front)) {
        assert!((at_once.normal_force / swept.normal_force - 1.).abs() < 1e-9);
        assert!((at_once.moment - swept.moment).abs() < 1e-9 * 1e6);
    }
}
