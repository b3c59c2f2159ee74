//! Borders inside the solid: parts that touch or overlap without sharing nodes are found wherever they are, and sound
//! meshes pass.

mod program;
mod support;

use coralpipe::model::borders::Borders;
use coralpipe::model::mesh::{Mesh, Shape};
use coralpipe::model::resolve::Model;
use program::Bench;
use serde_json::{Value, json};
use std::collections::HashMap;
use std::f64::consts::TAU;
use support::Drawing;

const FACES: [Shape; 4] = [Shape::Tri3, Shape::Quad4, Shape::Tri6, Shape::Quad8];

/// Surfaces mapped from the unit square; nodes of one layer at one place are one node.
#[derive(Default)]
struct Sketch {
    drawing: Drawing,
    known: HashMap<(usize, [i64; 2]), usize>,
}

/// How a surface is divided.
#[derive(Clone, Copy)]
struct Grid {
    shape: Shape,
    across: usize,
    up: usize,
    layer: usize,
}

impl Sketch {
    fn node(&mut self, layer: usize, at: [f64; 2]) -> usize {
        let key = (layer, at.map(|x| (x * 1e7).round() as i64));
        let Sketch { drawing, known } = self;
        *known.entry(key).or_insert_with(|| drawing.node(at))
    }

    /// `map` must keep the square's orientation.
    fn surface(&mut self, group: &str, grid: Grid, map: &dyn Fn([f64; 2]) -> [f64; 2]) {
        for (i, j) in (0..grid.across).flat_map(|i| (0..grid.up).map(move |j| (i, j))) {
            let corners: &[[f64; 2]] = &[[0., 0.], [1., 0.], [1., 1.], [0., 1.]];
            let faces: Vec<Vec<usize>> = match grid.shape {
                Shape::Quad4 | Shape::Quad8 => vec![vec![0, 1, 2, 3]],
                _ => vec![vec![0, 1, 2], vec![0, 2, 3]],
            };
            for face in faces {
                let mut places: Vec<[f64; 2]> = face.iter().map(|&c| corners[c]).collect();
                if matches!(grid.shape, Shape::Tri6 | Shape::Quad8) {
                    let next = |k: usize| places[(k + 1) % places.len()];
                    let middle = |k: usize| [0, 1].map(|i| (places[k][i] + next(k)[i]) / 2.);
                    places.extend((0..places.len()).map(middle).collect::<Vec<_>>());
                }
                let at =
                    |p: &[f64; 2]| map([(i as f64 + p[0]) / grid.across as f64, (j as f64 + p[1]) / grid.up as f64]);
                let nodes: Vec<usize> = places.iter().map(|p| self.node(grid.layer, at(p))).collect();
                self.drawing.cell(group, grid.shape, &nodes);
            }
        }
    }

    fn rectangle(&mut self, group: &str, grid: Grid, corner: [f64; 2], size: [f64; 2]) {
        self.surface(group, grid, &|p| [0, 1].map(|i| corner[i] + p[i] * size[i]));
    }

    fn mesh(&self) -> Mesh {
        self.drawing.mesh()
    }

    /// What a mesh without a case is warned of.
    fn warnings(&self) -> Vec<String> {
        let mesh = self.mesh();
        Borders::of(&mesh).warnings(&mesh)
    }

    fn found(&self) -> String {
        self.warnings().join("\n")
    }
}

/// A ring round (0, 0), from the inner radius to the outer, its nodes on circles.
fn ring([inner, outer]: [f64; 2], start: f64) -> impl Fn([f64; 2]) -> [f64; 2] {
    move |[u, v]| {
        let (radius, angle) = (outer + v * (inner - outer), start + TAU * u);
        [radius * angle.cos(), radius * angle.sin()]
    }
}

fn grid(shape: Shape, across: usize, up: usize, layer: usize) -> Grid {
    Grid { shape, across, up, layer }
}

/// Two layers of 6 m x 2 m and 6 m x 3 m, `lift` above each other.
fn layers(shape: Shape, divisions: [usize; 2], lift: f64) -> Sketch {
    let mut sketch = Sketch::default();
    sketch.rectangle("lower", grid(shape, divisions[0], 4, 0), [0., 0.], [6., 2.]);
    sketch.rectangle("upper", grid(shape, divisions[1], 6, 1), [0., 2. + lift], [6., 3.]);
    sketch
}

fn assert_touch(found: &str, groups: &str, length: f64, places: &[&str]) {
    let words = found.split("along ").nth(1).unwrap_or_else(|| panic!("no border in: {found:?}"));
    let said: f64 = words.split(' ').next().unwrap().parse().unwrap();
    // Four decimals are printed.
    assert!((said - length).abs() < 1e-4, "{length} m expected: {found}");
    for word in [groups, "without sharing nodes", "BooleanFragments or Coherence", "an interface"].iter().chain(places)
    {
        assert!(found.contains(word), "{word}: {found}");
    }
}

#[test]
fn layers_that_share_no_nodes_are_found_with_place_length_groups_and_remedy() {
    let places = ["(0.0000, 2.0000)", "(6.0000, 2.0000)"];
    for shape in FACES {
        for divisions in [[12, 12], [12, 17], [5, 40]] {
            let found = layers(shape, divisions, 0.).found();
            assert_touch(&found, "\"lower\" and \"upper\" touch", 6., &places);
        }
    }
}

#[test]
fn a_gap_that_comes_from_rounding_is_none_and_a_gap_that_is_drawn_is_air() {
    for shape in FACES {
        // A script that writes 2.0000001 for 2.
        assert_touch(&layers(shape, [12, 17], 1e-7).found(), "\"lower\" and \"upper\" touch", 6., &[]);
        // From 0.05 mm between sides of 0.5 m on, parts are apart.
        for gap in [5e-5, 1e-3, 0.1] {
            assert_eq!(layers(shape, [12, 12], gap).warnings(), [""; 0], "{gap}");
        }
    }
}

#[test]
fn layers_that_lap_by_part_of_a_side_touch_along_that_part() {
    for shape in FACES {
        let mut sketch = Sketch::default();
        sketch.rectangle("lower", grid(shape, 6, 2, 0), [0., 0.], [6., 2.]);
        sketch.rectangle("upper", grid(shape, 3, 2, 1), [5.97, 2.], [3., 1.]);
        assert_touch(&sketch.found(), "\"lower\" and \"upper\" touch", 0.03, &["(5.9700, 2.0000)", "(6.0000, 2.0000)"]);
    }
}

#[test]
fn hanging_nodes_are_found_also_inside_one_group_and_on_a_curve() {
    for (coarse, fine) in [(Shape::Quad4, Shape::Quad4), (Shape::Tri3, Shape::Quad4), (Shape::Tri3, Shape::Tri3)] {
        // Each second node of the fine part lies in the middle of a coarse side, the others are shared.
        let mut sketch = Sketch::default();
        sketch.rectangle("ground", grid(coarse, 4, 2, 0), [0., 0.], [4., 2.]);
        sketch.rectangle("ground", grid(fine, 8, 4, 0), [0., 2.], [4., 2.]);
        assert_touch(&sketch.found(), "parts of \"ground\" touch", 4., &["(0.0000, 2.0000)", "(4.0000, 2.0000)"]);
        // Shared nodes on a circle, hanging ones beyond the coarse chords (inside) or within them (outside).
        for [inner, outer] in [[16, 32], [32, 16], [12, 36]] {
            let mut sketch = Sketch::default();
            sketch.surface("pipe", grid(coarse, inner, 2, 0), &ring([0.8, 1.], 0.));
            sketch.surface("ground", grid(fine, outer, 3, 0), &ring([1., 2.], 0.));
            // Chords of the coarse division, all of them.
            let chords = 32. * (TAU / 32.).sin();
            let found = sketch.found();
            assert!(found.contains("\"ground\" and \"pipe\" touch"), "{inner} in {outer}: {found}");
            let words = found.split("along ").nth(1).unwrap().split(' ').next().unwrap();
            let length: f64 = words.parse().unwrap();
            assert!((length / chords - 1.).abs() < 0.02, "a circle of 2 pi m, found {length} m: {found}");
        }
    }
}

#[test]
fn one_crack_between_shared_ends_is_found() {
    // A single coarse side between two shared corners, with one hanging node.
    for hanging in [[1., 1.], [1., 1.04], [1., 0.96]] {
        let mut drawing = Drawing::default();
        let n: Vec<usize> = [[0., 0.], [2., 0.], [2., 1.], [0., 1.], hanging, [2., 2.], [1., 2.], [0., 2.]]
            .map(|at| drawing.node(at))
            .into();
        drawing.cell("ground", Shape::Quad4, &[n[0], n[1], n[2], n[3]]);
        drawing.cell("ground", Shape::Quad4, &[n[3], n[4], n[6], n[7]]);
        drawing.cell("ground", Shape::Quad4, &[n[4], n[2], n[5], n[6]]);
        let mesh = drawing.mesh();
        let found = Borders::of(&mesh).warnings(&mesh).join("\n");
        assert!(found.contains("without sharing nodes"), "{hanging:?}: {found}");
    }
}

#[test]
fn curves_divided_differently_touch_along_their_whole_length() {
    for shape in FACES {
        for (inner, outer, start) in [
            (16, 32, 0.),
            (32, 16, 0.),
            (16, 23, 0.),
            (24, 16, 0.1),
            (12, 36, 0.),
            (64, 96, 0.),
            (32, 32, 0.),
            (32, 32, 0.07),
        ] {
            let mut sketch = Sketch::default();
            sketch.surface("pipe", grid(shape, inner, 2, 0), &ring([0.8, 1.], start));
            sketch.surface("ground", grid(shape, outer, 3, 1), &ring([1., 2.], 0.));
            let found = sketch.found();
            let length: f64 = found.split("along ").nth(1).unwrap_or("0 ").split(' ').next().unwrap().parse().unwrap();
            // The chords of 12 sides are 1.1 % shorter than the circle; slivers count with whole sides.
            assert!((length / TAU - 1.).abs() < 0.02, "{shape:?} {inner} in {outer}: {found}");
            assert!(found.contains("\"ground\" and \"pipe\" touch"), "{found}");
        }
    }
}

#[test]
fn a_ring_with_air_round_it_is_apart() {
    for shape in FACES {
        for (inner, outer) in [(16, 32), (32, 16), (16, 23), (32, 32)] {
            let mut sketch = Sketch::default();
            sketch.surface("pipe", grid(shape, inner, 2, 0), &ring([0.7, 0.97], 0.));
            sketch.surface("ground", grid(shape, outer, 3, 1), &ring([1., 2.], 0.));
            // 30 mm of air; chords of 16 sides rise 19 mm.
            assert_eq!(sketch.warnings(), [""; 0], "{shape:?} {inner} in {outer}");
        }
    }
}

#[test]
fn surfaces_over_each_other_are_found_with_the_area_that_counts_twice() {
    let overlap = |sketch: Sketch, groups: &str, area: f64, centre: &str| {
        let found = sketch.found();
        assert!(found.contains(&format!("{groups} overlap over {area:.4} m2 round {centre} m")), "{found}");
        assert!(found.contains("BooleanFragments or Coherence") && found.contains("BooleanDifference"), "{found}");
    };
    for shape in FACES {
        let square = |x: f64, y: f64, size: f64| {
            let mut sketch = Sketch::default();
            sketch.rectangle("ground", grid(shape, 6, 5, 0), [0., 0.], [6., 5.]);
            sketch.rectangle("pipe", grid(shape, 3, 3, 1), [x, y], [size; 2]);
            sketch
        };
        let both = "\"ground\" and \"pipe\"";
        // Wholly inside; in a corner, with two borders in common; partly outside; across the whole with unlike divisions.
        overlap(square(2.05, 1.55, 1.9), both, 3.61, "(3.0000, 2.5000)");
        overlap(square(0., 0., 2.), both, 4., "(1.0000, 1.0000)");
        overlap(square(5., 1., 2.), both, 2., "(5.5000, 2.0000)");
        overlap(square(-1., -1., 8.), both, 30., "(3.0000, 2.5000)");
        // One surface twice, without common nodes, and with them at its border alone.
        let mut twice = Sketch::default();
        twice.rectangle("ground", grid(shape, 6, 5, 0), [0., 0.], [6., 5.]);
        twice.rectangle("pipe", grid(shape, 6, 5, 1), [0., 0.], [6., 5.]);
        overlap(twice, both, 30., "(3.0000, 2.5000)");
        let mut one_group = square(2.05, 1.55, 1.9);
        one_group.rectangle("rock", grid(shape, 4, 4, 2), [10., 0.], [2., 2.]);
        one_group.rectangle("rock", grid(shape, 3, 3, 3), [11., 1.], [2., 2.]);
        overlap(one_group, "; elements of \"rock\"", 1., "(11.5000, 1.5000)");
    }
    let mut borders_shared = Drawing::default();
    let n: Vec<usize> = [[0., 0.], [2., 0.], [2., 2.], [0., 2.], [0.9, 1.]].map(|at| borders_shared.node(at)).into();
    for k in 0..4 {
        borders_shared.cell("a", Shape::Tri3, &[n[k], n[(k + 1) % 4], n[4]]);
    }
    borders_shared.cell("b", Shape::Quad4, &n[..4]);
    let mesh = borders_shared.mesh();
    let found = Borders::of(&mesh).warnings(&mesh).join("\n");
    assert!(found.contains("\"a\" and \"b\" overlap over 4.0000 m2 round (1.0000, 1.0000) m"), "{found}");
}

#[test]
fn a_corner_that_pokes_into_another_part_is_found() {
    for shape in FACES {
        let mut sketch = Sketch::default();
        sketch.rectangle("a", grid(shape, 4, 2, 0), [0., -2.], [4., 2.]);
        // A square on its corner, which lies 0.05 m below the upper side of a: 2 (0.05^2 / 2) m2 of it.
        sketch.surface("b", grid(shape, 2, 2, 1), &|[u, v]| [1.5 + u - v, u + v - 0.05]);
        let found = sketch.found();
        assert!(found.contains("\"a\" and \"b\" touch and partly overlap along"), "{shape:?}: {found}");
    }
}

#[test]
fn a_disc_on_an_uncut_rectangle_is_found() {
    for shape in FACES {
        let mut sketch = Sketch::default();
        sketch.rectangle("ground", grid(shape, 12, 10, 0), [-3., -2.5], [6., 5.]);
        sketch.surface("pipe", grid(shape, 24, 2, 1), &ring([0.5, 1.], 0.));
        let found = sketch.found();
        assert!(found.contains("\"ground\" and \"pipe\" overlap over 2.3"), "pi (1 - 1/4) = 2.356: {found}");
    }
}

/// Open borders that lie close to each other on purpose.
#[test]
fn notches_slots_thin_walls_and_holes_are_no_faults() {
    for shape in FACES {
        // V-notches from 45 down to 0.06 degrees, their tip a shared node, the edges of the ground as close as that.
        for half_width in [0.8, 0.05, 1e-3] {
            let mut sketch = Sketch::default();
            let left = move |[u, v]: [f64; 2]| [u * (2. - half_width * v), 2. * v];
            let right = move |[u, v]: [f64; 2]| [2. + half_width * v + u * (2. - half_width * v), 2. * v];
            sketch.surface("ground", grid(shape, 4, 4, 0), &left);
            sketch.surface("ground", grid(shape, 4, 4, 0), &right);
            sketch.rectangle("ground", grid(shape, 4, 2, 0), [0., -1.], [2., 1.]);
            sketch.rectangle("ground", grid(shape, 4, 2, 0), [2., -1.], [2., 1.]);
            assert_eq!(sketch.warnings(), [""; 0], "{shape:?} {half_width}");
        }
        // A wall of 0.2 mm on ground with sides of 1 m, and one across a slot of 0.2 mm.
        let mut sketch = Sketch::default();
        sketch.rectangle("ground", grid(shape, 6, 2, 0), [0., 0.], [6., 2.]);
        sketch.rectangle("wall", grid(shape, 6, 1, 0), [0., 2.], [6., 2e-4]);
        sketch.rectangle("roof", grid(shape, 6, 2, 0), [0., 2.0004], [6., 2.]);
        assert_eq!(sketch.warnings(), [""; 0], "{shape:?}");
        // A wall of 1 mm in sides of 10 m.
        let mut sketch = Sketch::default();
        sketch.rectangle("wall", grid(shape, 100, 1, 0), [0., 0.], [1000., 1e-3]);
        assert_eq!(sketch.warnings(), [""; 0], "{shape:?}");
        // A ring that shares its nodes with the ground round it.
        let mut sketch = Sketch::default();
        sketch.surface("pipe", grid(shape, 16, 2, 0), &ring([0.8, 1.], 0.));
        sketch.surface("ground", grid(shape, 16, 3, 0), &ring([1., 2.], 0.));
        assert_eq!(sketch.warnings(), [""; 0], "{shape:?}");
    }
}

#[test]
fn parts_that_meet_in_a_point_pass_and_a_single_shared_node_is_reported() {
    for (layer, said) in [(1, None), (0, Some("parts of \"a\" and \"b\" meet at (2.0000, 2.0000) m in a single node"))]
    {
        let mut sketch = Sketch::default();
        sketch.rectangle("a", grid(Shape::Quad4, 4, 4, 0), [0., 0.], [2., 2.]);
        sketch.rectangle("b", grid(Shape::Tri3, 4, 4, layer), [2., 2.], [2., 2.]);
        let warnings = sketch.warnings();
        assert_eq!(warnings.len(), usize::from(said.is_some()), "{warnings:?}");
        assert!(said.is_none_or(|said| warnings[0].contains(said)), "{warnings:?}");
    }
    // A corner on the middle of a side.
    let mut sketch = Sketch::default();
    sketch.rectangle("a", grid(Shape::Quad4, 2, 2, 0), [0., -2.], [2., 2.]);
    sketch.surface("b", grid(Shape::Quad4, 2, 2, 1), &|[u, v]| [0.5 + u - v, u + v]);
    assert_eq!(sketch.warnings(), [""; 0]);
}

#[test]
fn every_mesh_that_the_program_comes_with_passes() {
    for name in ["meshes/twin_pipes.msh", "tests/meshes/one_ring.msh"] {
        let mesh = Mesh::read(&support::root().join(name)).unwrap();
        assert_eq!(Borders::of(&mesh).warnings(&mesh), [""; 0], "{name}");
    }
}

/// Numbers between 0 and 1 from a seed (Knuth's MMIX generator).
struct Random(u64);

impl Random {
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    fn whole(&mut self, low: usize, high: usize) -> usize {
        low + (self.unit() * (high - low + 1) as f64) as usize
    }
}

/// Two parts as drawn, and what must be found: "touch", "overlap", or nothing.
fn random_pair(random: &mut Random) -> (Sketch, &'static str) {
    let shape = FACES[random.whole(0, 3)];
    let (angle, unit) = (random.between(0., TAU), [1e-2, 1., 1e2][random.whole(0, 2)]);
    let shift = [random.between(-5., 5.), random.between(-5., 5.)];
    let placed = |[x, y]: [f64; 2]| {
        [x * angle.cos() - y * angle.sin() + shift[0], x * angle.sin() + y * angle.cos() + shift[1]].map(|x| x * unit)
    };
    let mut sketch = Sketch::default();
    let divisions = [random.whole(1, 12), random.whole(1, 12)];
    let widths = [random.between(1., 4.), random.between(1., 4.)];
    let side = (0..2).map(|i| widths[i] / divisions[i] as f64).fold(0.5, f64::min);
    let offset = random.between(0.05 - widths[1], widths[0] - 0.05);
    let pair = |sketch: &mut Sketch, lift: f64| {
        sketch.surface("a", grid(shape, divisions[0], 2, 0), &|[u, v]| placed([u * widths[0], v - 1.]));
        sketch.surface("b", grid(shape, divisions[1], 2, 1), &|[u, v]| placed([offset + u * widths[1], v + lift]));
    };
    let round = [random.whole(10, 64), random.whole(10, 64)];
    let start = random.between(0., TAU);
    let least = *round.iter().min().unwrap() as f64;
    let expected = match random.whole(0, 7) {
        0 => {
            pair(&mut sketch, 0.);
            "touch"
        }
        1 => {
            pair(&mut sketch, side * random.between(2e-3, 0.5));
            ""
        }
        2 => {
            pair(&mut sketch, -side * random.between(2e-3, 0.9));
            "overlap"
        }
        3 => {
            // shared nodes
            sketch.surface("a", grid(shape, divisions[0], 2, 0), &|[u, v]| placed([u, v - 1.]));
            sketch.surface("b", grid(shape, divisions[0], 2, 0), &|[u, v]| placed([u, v]));
            ""
        }
        4 => {
            sketch.surface("a", grid(shape, round[0], 2, 0), &|p| placed(ring([0.6, 1.], start)(p)));
            sketch.surface("b", grid(shape, round[1], 2, 1), &|p| placed(ring([1., 1.5], 0.)(p)));
            "touch"
        }
        5 => {
            // A chord of 10 sides rises by 1 - cos 18 degrees = 0.049.
            let air = 1.1 * (1. - (TAU / 2. / least).cos()) + 1e-3;
            sketch.surface("a", grid(shape, round[0], 2, 0), &|p| placed(ring([0.6, 1. - air], start)(p)));
            sketch.surface("b", grid(shape, round[1], 2, 1), &|p| placed(ring([1., 1.5], 0.)(p)));
            ""
        }
        6 => {
            sketch.surface("a", grid(shape, 7, 6, 0), &|[u, v]| placed([3. * u - 1.5, 3. * v - 1.4]));
            sketch.surface("b", grid(shape, round[1], 2, 1), &|p| placed(ring([0.5, 1.], start)(p)));
            "overlap"
        }
        _ => {
            // corner at corner
            sketch.surface("a", grid(shape, divisions[0], 2, 0), &|[u, v]| placed([u - 1., v - 1.]));
            sketch.surface("b", grid(shape, divisions[1], 2, 1), &|[u, v]| placed([u, v]));
            ""
        }
    };
    (sketch, expected)
}

#[test]
fn random_pairs_are_judged_as_they_were_drawn() {
    let mut seen = HashMap::new();
    for seed in 0..400 {
        let (sketch, expected) = random_pair(&mut Random(seed));
        let found = sketch.found();
        let right = match expected {
            "" => found.is_empty(),
            word => found.contains(word),
        };
        assert!(right, "seed {seed}, expected {expected:?}: {found}");
        *seen.entry(expected).or_insert(0) += 1;
    }
    assert!(["", "touch", "overlap"].iter().all(|kind| seen[kind] > 50), "{seen:?}");
}

fn material() -> Value {
    json!({ "young": "200 MPa", "poisson": 0.3, "density": "2 t/m^3", "friction": 0.4 })
}

/// Two layers on a fixed base, pressed from above; with the lines of groups base, top, border (lower side), crack (its
/// left half).
fn layers_with_lines(layer: usize, joined_from: f64) -> Sketch {
    let mut sketch = Sketch::default();
    let fine = |group| grid(Shape::Quad4, 6, group, 0);
    sketch.rectangle("lower", fine(2), [0., 0.], [6., 2.]);
    let key = |at: [f64; 2]| (0, at.map(|x: f64| (x * 1e7).round() as i64));
    for i in 0..=6 {
        // the upper layer takes the lower one's nodes from there on
        let at = [i as f64, 2.];
        if at[0] >= joined_from {
            sketch.known.insert((layer, key(at).1), sketch.known[&key(at)]);
        }
    }
    sketch.rectangle("upper", Grid { layer, ..fine(3) }, [0., 2.], [6., 3.]);
    for i in 0..6 {
        let mut line = |group: &str, layer: usize, y: f64| {
            let ends = [0, 1].map(|k| sketch.node(layer, [(i + k) as f64, y]));
            sketch.drawing.cell(group, Shape::Line2, &ends);
        };
        line("base", 0, 0.);
        line("top", layer, 5.);
        line("border", 0, 2.);
        if i < 3 {
            line("crack", 0, 2.);
        }
    }
    sketch
}

fn layers_case(more: Value) -> Value {
    let mut case = json!({
        "geometry": { "mesh": "layers.msh" },
        "materials": { "lower": material(), "upper": material() },
        "supports": { "base": ["x", "y"] },
        "loads": { "top": { "pressure": { "law": "step", "peak": "100 kPa" } } },
        "time": { "step": "1 ms", "end": "2 ms" },
        "output": { "every": "2 ms" }
    });
    for (key, value) in more.as_object().unwrap() {
        case[key] = value.clone();
    }
    case
}

fn bench(test: &str, sketch: &Sketch, case: &Value) -> Bench {
    let bench = Bench::new(test);
    bench.write("layers.msh", sketch.drawing.text());
    bench.write("layers.json", case.to_string());
    bench
}

#[test]
fn every_command_refuses_such_a_mesh_and_a_mesh_alone_is_warned_of() {
    let bench = bench("borders-commands", &layers_with_lines(1, 9.), &layers_case(json!({})));
    bench.write("plan.json", r#"{ "case": "layers.json", "set": { "time.step": ["1 ms", "2 ms"] } }"#);
    for command in
        ["run layers.json", "check layers.json", "modes layers.json", "run layers.json --bonded", "sweep plan.json"]
    {
        let outcome = bench.run_line(command);
        assert_eq!(outcome.code, Some(1), "{command}: {outcome:?}");
        let said = outcome.stdout.clone() + &outcome.stderr;
        assert!(said.contains("\"lower\" and \"upper\" touch along 6.0000 m"), "{command}: {said}");
    }
    let alone = bench.run_line("check layers.msh");
    assert_eq!(alone.code, Some(0));
    assert!(alone.stdout.contains("warning: layers.msh: \"lower\" and \"upper\" touch along 6.0000 m"), "{alone:?}");
}

#[test]
fn an_interface_on_a_border_without_common_nodes_is_refused_by_that_cause() {
    let interface = json!({ "interfaces": { "border": { "body": "upper", "thickness": "1 cm" } } });
    let mesh = layers_with_lines(1, 9.).mesh();
    let error = Model::new(&support::case(&layers_case(interface)), &mesh, false).unwrap_err().to_string();
    assert!(error.contains("without sharing nodes"), "{error}");
}

#[test]
fn a_slit_that_the_case_names_is_open_and_other_names_are_reported() {
    // Joined from x = 3 m on, open to the left of it.
    let mesh = layers_with_lines(1, 3.).mesh();
    let model = |slits: Value| Model::new(&support::case(&layers_case(json!({ "slits": slits }))), &mesh, false);
    let open = model(json!([])).unwrap_err().to_string();
    assert_touch(&open, "\"lower\" and \"upper\" touch", 3., &["(0.0000, 2.0000)", "(3.0000, 2.0000)"]);
    let meant = model(json!(["crack"])).unwrap();
    assert_eq!(meant.slits.len(), 3);
    assert!(!meant.warnings.iter().any(|w| w.contains("crack") || w.contains("slit")), "{:?}", meant.warnings);
    let warned = model(json!(["crack", "base"])).unwrap();
    assert!(warned.warnings.iter().any(|w| w.contains("slits: \"base\" is no slit")), "{:?}", warned.warnings);
    let unknown = model(json!(["crakc"])).unwrap_err().to_string();
    assert!(unknown.contains("crakc") && unknown.contains("border, crack"), "{unknown}");
    let surface = model(json!(["upper"])).unwrap_err().to_string();
    assert!(surface.contains("needs a group of curves"), "{surface}");
    // A slit allows no overlap.
    let mut over = layers_with_lines(1, 3.);
    over.rectangle("upper", grid(Shape::Quad4, 1, 1, 2), [1.2, 0.3], [0.5, 0.5]);
    let case = support::case(&layers_case(json!({ "slits": ["crack"] })));
    let refused = Model::new(&case, &over.mesh(), false).unwrap_err().to_string();
    assert!(refused.contains("overlap over 0.2500 m2") && !refused.contains("touch"), "{refused}");
}

#[test]
fn what_nothing_holds_beyond_a_slit_is_named_with_that_cause() {
    let sketch = layers_with_lines(1, 9.);
    for (analysis, code) in [("static", 1), ("dynamic", 0)] {
        let case = layers_case(json!({ "slits": ["border"], "analysis": analysis }));
        let bench = bench(&format!("borders-loose-{analysis}"), &sketch, &case);
        let outcome = bench.run_line("run layers.json");
        assert_eq!(outcome.code, Some(code), "{outcome:?}");
        let said = "nothing holds \"upper\" round (3.0000, 3.5000) m in x and y, since it shares no nodes with the part that it \
                    touches along a slit at (0.5000, 2.0000) m";
        assert!(outcome.stderr.contains(said), "{outcome:?}");
    }
}

#[test]
fn a_part_with_air_round_it_is_reported_to_float_unless_it_is_meant_to_fly() {
    let mut sketch = Sketch::default();
    sketch.surface("pipe", grid(Shape::Quad4, 16, 2, 0), &ring([0.6, 0.9], 0.));
    sketch.surface("ground", grid(Shape::Quad4, 16, 3, 0), &ring([1., 2.], 0.));
    let rim: Vec<usize> = (0..16).map(|k| sketch.node(0, ring([1., 2.], 0.)([k as f64 / 16., 0.]))).collect();
    (0..16).for_each(|k| sketch.drawing.cell("rim", Shape::Line2, &[rim[k], rim[(k + 1) % 16]]));
    let case = |more: Value| {
        let mut case = json!({
            "materials": { "ground": material(), "pipe": material() },
            "supports": { "rim": ["x", "y"] },
            "time": { "step": "1 ms", "end": "2 ms" }
        });
        for (key, value) in more.as_object().unwrap() {
            case[key] = value.clone();
        }
        case
    };
    let unheld = |case: Value| coralpipe::model::hold::unheld_parts(&support::model(&case, &sketch.mesh()));
    let told = unheld(case(json!({})));
    assert!(told.len() == 1 && told[0].starts_with("nothing holds \"pipe\" round"), "{told:?}");
    assert!(told[0].contains("0 Hz") && told[0].contains("an interface"), "{told:?}");
    assert_eq!(unheld(case(json!({ "initial": { "pipe": { "velocity": [1, 0] } } }))), [""; 0]);
    // A mesh that nothing holds at all is meant to be free.
    assert_eq!(unheld(case(json!({ "supports": {} }))), [""; 0]);
}
