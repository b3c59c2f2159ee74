//! Section forces N, Q, M and hoop stress round a pipe wall, in equilibrium, and what the ground does to it.
//!
//! Forces of an element on its nodes' side: p = k (u + beta v) + m (a + alpha v) - loads - joints. On a ray the
//! elements anticlockwise of it and those clockwise of it hold each other: their sums of p over the ray's nodes are F
//! and -F. Then N = -F.e_theta, Q = -F.e_r, M = sum of -F.e_theta (r - r_m): tension, sigma_r_theta, and compression of
//! the inner fibre are positive. What is not told apart by elements (reactions, forces on points, the ground of a
//! bonded pipe) is shared between the two sides by the lengths of their outer faces.
//!
//! The traction at a ray is the mean over the hat function of its outer node: with mid-sides the single nodes' forces
//! over their areas alternate round the right mean (by 0.5 % in Q8, 1 % in T6 on 96 elements round).

use super::hoop::{self, Weights};
use crate::model::mesh::{Cell, Group, Mesh, Shape};
use crate::model::resolve::Model;
use crate::model::ring::RingShape;
use crate::physics::material::Material;
use crate::solve::assembly;
use crate::solve::system::{Rayleigh, State, System};
use nalgebra::{DMatrix, DVector, Matrix2, Matrix3x2, Vector2, Vector3};

/// What a ray shows; forces per metre of pipe.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Section {
    /// anticlockwise from +x, 0 to 2 pi
    pub angle: f64,
    /// [N/m], tension positive
    pub normal_force: f64,
    /// [N/m], as sigma_r_theta
    pub shear_force: f64,
    /// about the wall's middle [N m/m], positive where the inner fibre is compressed
    pub moment: f64,
    /// hoop stress at the inner and at the outer face [Pa]
    pub hoop: [f64; 2],
    /// displacement of the outer face along e_r and e_theta [m]
    pub displacement: [f64; 2],
    /// traction of the ground on the outer face along e_r and e_theta [Pa]
    pub traction: [f64; 2],
}

/// A pipe wall, ready to be asked at any state.
pub struct Ring {
    pub body: String,
    rays: Vec<Ray>,
    elements: Vec<Element>,
    rayleigh: Rayleigh,
}

struct Ray {
    angle: f64,
    outer_node: usize,
    /// of the outer face that the outer node stands for [m^2]
    area: f64,
    /// joint points of the outer node, and half those of the mid-side nodes beside it: (which, area [m^2])
    joints: Vec<(usize, f64)>,
    /// at the inner and the outer face
    hoop: [Weights; 2],
}

struct Element {
    nodes: Vec<usize>,
    stiffness: DMatrix<f64>,
    mass: DMatrix<f64>,
    weight: DVector<f64>,
    /// (which of the model, what it does here)
    loads: Vec<(usize, ElementLoad)>,
    joints: Vec<JointShare>,
    /// where it ends at a ray
    ends: Vec<End>,
    /// where it carries the outer face
    outer: Vec<Outer>,
}

/// What a joint point does to a node of the element.
struct JointShare {
    point: usize,
    /// number of the node in the element
    local: usize,
    /// N there
    n: f64,
    /// the part of the point's area that belongs to this element [m^2]
    area: f64,
}

/// One line's or face's share of a load.
enum ElementLoad {
    /// force per unit of the pulse
    Simultaneous(DVector<f64>),
    /// the line's number among those the front sweeps over
    Sweeping(usize),
}

/// A node that an element has on a ray.
struct End {
    local: usize,
    ray: usize,
    /// force on the element -> its part of (N, Q, M)
    section: Matrix3x2<f64>,
}

/// A node that an element has on the outer face.
struct Outer {
    local: usize,
    ray: usize,
    /// force on the element -> its part of the ray's (along e_r, along e_theta)
    part: Matrix2<f64>,
}

/// The bodies of the interfaces, each with its faces.
pub fn bodies(model: &Model) -> impl Iterator<Item = &Group> {
    model.bodies.iter().filter_map(|body| model.mesh.group_of(body, 2, "body").ok())
}

/// All pipe walls among the bodies of the interfaces; bodies of other shapes have none.
pub fn rings(model: &Model, system: &System, rayleigh: Rayleigh) -> Vec<Ring> {
    let shapes = bodies(model).filter_map(|g| Some((g.name.clone(), RingShape::find(&model.mesh, &g.cells).ok()?)));
    shapes.map(|(body, shape)| Ring::new(body, &shape, model, system, rayleigh)).collect()
}

/// Names the bodies that have no rows in `rings.csv`, each with the reason.
pub fn uncut(model: &Model) -> Option<String> {
    let why = |g: &Group| {
        let why = RingShape::find(&model.mesh, &g.cells).err()?;
        Some(format!("of \"{}\", since {why}", g.name))
    };
    let bodies: Vec<String> = bodies(model).filter_map(why).collect();
    (!bodies.is_empty()).then(|| {
        format!(
            "rings.csv has no section forces {}; a wall is cut where it is a whole circular ring, meshed in layers whose \
             nodes lie on common rays (Transfinite Surface in Gmsh)",
            bodies.join("; ")
        )
    })
}

impl Ring {
    fn new(body: String, shape: &RingShape, model: &Model, system: &System, rayleigh: Rayleigh) -> Ring {
        let lengths = outer_lengths(shape, &model.mesh);
        let mut elements: Vec<Element> =
            shape.sectors.iter().map(|&(cell, sector)| element(shape, model, &lengths, cell, sector)).collect();
        add_loads(&mut elements, model);
        add_joints(&mut elements, shape, model, system);
        let samples = hoop::samples(shape, model);
        let ray = |(i, ray): (usize, &crate::model::ring::Ray)| {
            let outer_node = ray.nodes[ray.nodes.len() - 1];
            let [before, after] = beside(&lengths, i);
            let part = |node: usize| match node {
                n if n == outer_node => Some(1.),
                n if [before.middle, after.middle].contains(&Some(n)) => Some(0.5),
                _ => None,
            };
            let of_element =
                |e: &Element, joint: &JointShare| Some((joint.point, part(e.nodes[joint.local])? * joint.area));
            let joints = elements.iter().flat_map(|e| e.joints.iter().filter_map(move |joint| of_element(e, joint)));
            let mut joints: Vec<(usize, f64)> = joints.collect();
            joints.sort_by_key(|&(point, _)| point);
            Ray {
                angle: ray.angle,
                outer_node,
                area: (before.length + after.length) / 2.,
                joints,
                hoop: hoop::at(shape, &samples, i),
            }
        };
        Ring { body, rays: shape.rays.iter().enumerate().map(ray).collect(), elements, rayleigh }
    }

    /// Section forces at every ray, anticlockwise; `origin`: the unknowns that displacements are counted from.
    pub fn sections(&self, model: &Model, system: &System, state: &State, origin: &[f64]) -> Vec<Section> {
        let mut forces = vec![Vector3::zeros(); self.rays.len()];
        let mut outside = vec![Vector2::zeros(); self.rays.len()];
        for element in &self.elements {
            let p = element.force(model, system, state, self.rayleigh);
            let joints = element.joint_force(system, state);
            for end in &element.ends {
                let at = |x: &DVector<f64>| Vector2::new(x[2 * end.local], x[2 * end.local + 1]);
                forces[end.ray] += end.section * (at(&p) - at(&joints));
            }
            for outer in &element.outer {
                outside[outer.ray] += outer.part * Vector2::new(p[2 * outer.local], p[2 * outer.local + 1]);
            }
        }
        let section = |(i, ray): (usize, &Ray)| {
            let [radial, along] = axes(ray.angle);
            let at = |q: &[f64]| Vector2::from(system.unknowns.at_node(q, ray.outer_node));
            let moved = at(&state.q) - at(origin);
            Section {
                angle: ray.angle,
                normal_force: forces[i][0],
                shear_force: forces[i][1],
                moment: forces[i][2],
                hoop: [0, 1].map(|face| ray.hoop_stress(face, system, state)),
                displacement: [moved.dot(&radial), moved.dot(&along)],
                traction: ray.traction(state).unwrap_or((outside[i] / ray.area).into()),
            }
        };
        self.rays.iter().enumerate().map(section).collect()
    }
}

impl Element {
    /// k (u + beta v) + m (a + alpha v) - loads [N].
    fn force(&self, model: &Model, system: &System, state: &State, Rayleigh { alpha, beta }: Rayleigh) -> DVector<f64> {
        // u + beta v and a + alpha v
        let sum = |x: &[f64], factor: f64| {
            let at = |&node: &usize| {
                let ([x, y], [vx, vy]) = (system.unknowns.at_node(x, node), system.unknowns.at_node(&state.v, node));
                [x + factor * vx, y + factor * vy]
            };
            DVector::from_iterator(2 * self.nodes.len(), self.nodes.iter().flat_map(at))
        };
        let load = |(number, line): &(usize, ElementLoad)| {
            let load = &model.loads[*number];
            match line {
                ElementLoad::Simultaneous(force) => force * load.pulse.at(state.time),
                ElementLoad::Sweeping(line) => {
                    let forces = load.front.iter().flat_map(|front| front.forces_on(*line, state.time));
                    forces.fold(DVector::zeros(2 * self.nodes.len()), |sum, at_node| sum + self.on_nodes(&[at_node]))
                }
            }
        };
        let mut force = &self.stiffness * sum(&state.q, beta) - &self.weight;
        force.gemv(1., &self.mass, &sum(&state.a, alpha), 1.);
        self.loads.iter().map(load).fold(force, |p, load| p - load)
    }

    /// Forces on some of its nodes as a vector of them all.
    fn on_nodes(&self, forces: &[(usize, [f64; 2])]) -> DVector<f64> {
        let mut vector = DVector::zeros(2 * self.nodes.len());
        for (node, force) in forces {
            let local = self.nodes.iter().position(|n| n == node).expect("the line is the element's own");
            vector[2 * local] += force[0];
            vector[2 * local + 1] += force[1];
        }
        vector
    }

    /// Sum of N area R' t over its joint points [N].
    fn joint_force(&self, system: &System, state: &State) -> DVector<f64> {
        let mut force = DVector::zeros(2 * self.nodes.len());
        for &JointShare { point, local, n, area } in &self.joints {
            let at = &system.interface.points[point];
            let part = at.rotation().transpose() * state.joints[point].traction * (n * area);
            force[2 * local] += part[0];
            force[2 * local + 1] += part[1];
        }
        force
    }
}

impl Ray {
    fn hoop_stress(&self, face: usize, system: &System, state: &State) -> f64 {
        let at = |node: usize| system.unknowns.at_node(&state.q, node);
        self.hoop[face].iter().map(|&(node, [x, y])| x * at(node)[0] + y * at(node)[1]).sum()
    }

    /// (sigma_n, tau) of its joint points, their mean; none if it has no joints.
    fn traction(&self, state: &State) -> Option<[f64; 2]> {
        let mean = |k: usize| {
            let sum: f64 = self.joints.iter().map(|&(point, area)| area * state.joints[point].traction[k]).sum();
            sum / self.joints.iter().map(|(_, area)| area).sum::<f64>()
        };
        (!self.joints.is_empty()).then(|| [mean(1), mean(0)])
    }
}

/// (e_r, e_theta).
fn axes(angle: f64) -> [Vector2<f64>; 2] {
    let (sin, cos) = angle.sin_cos();
    [Vector2::new(cos, sin), Vector2::new(-sin, cos)]
}

/// The outer face of a sector.
#[derive(Clone, Copy)]
struct OuterFace {
    /// times 1 m of depth [m^2]
    length: f64,
    /// its mid-side node
    middle: Option<usize>,
}

/// The outer faces before and after a ray.
fn beside(faces: &[OuterFace], ray: usize) -> [OuterFace; 2] {
    [faces[(ray + faces.len() - 1) % faces.len()], faces[ray]]
}

fn outer_lengths(shape: &RingShape, mesh: &Mesh) -> Vec<OuterFace> {
    let outer: Vec<usize> = shape.rays.iter().map(|ray| ray.nodes[ray.nodes.len() - 1]).collect();
    let mut faces = vec![OuterFace { length: 0., middle: None }; outer.len()];
    for &(cell, sector) in &shape.sectors {
        let nodes = &mesh.cells[cell].nodes;
        for side in mesh.cells[cell].shape.sides() {
            if [nodes[side[0]], nodes[side[1]]] == [outer[sector], outer[shape.after(sector)]] {
                let line = if side.len() == 3 { Shape::Line3 } else { Shape::Line2 };
                let line = Cell { shape: line, nodes: side.iter().map(|&local| nodes[local]).collect() };
                let middle = side.get(2).map(|&local| nodes[local]);
                faces[sector] = OuterFace { length: mesh.measure(&line), middle };
            }
        }
    }
    faces
}

fn element(shape: &RingShape, model: &Model, lengths: &[OuterFace], cell: usize, sector: usize) -> Element {
    let material = material_of(model, cell);
    let stiffness = assembly::stiffness_of_face(model, cell, &material);
    let mass = assembly::mass_of_face(model, cell, &material);
    let face = &model.mesh.cells[cell];
    let (inner, outer) = shape.faces();
    let (mut ends, mut outside) = (Vec::new(), Vec::new());
    let middle = lengths[sector].middle.and_then(|node| face.nodes.iter().position(|&n| n == node));
    for (ray, sign) in [(sector, 1.), (shape.after(sector), -1.)] {
        let [before, after] = beside(lengths, ray).map(|face| face.length);
        let share = [before, after].map(|l| l / (before + after));
        // N = -F.e_theta with F = (1 - w) F_after - w F_before, w the share of the outer face after the ray
        let factor = -sign * if sign > 0. { share[0] } else { share[1] };
        let [radial, along] = axes(shape.rays[ray].angle);
        for local in on_ray(face, &shape.rays[ray].nodes) {
            let [x, y] = model.mesh.points[face.nodes[local]];
            let r = (x - shape.centre[0]).hypot(y - shape.centre[1]);
            let arm = r - (inner + outer) / 2.;
            let rows = [along.transpose(), radial.transpose(), along.transpose() * arm];
            ends.push(End { local, ray, section: Matrix3x2::from_rows(&rows) * factor });
            if face.nodes[local] == shape.rays[ray].nodes[shape.radii.len() - 1] {
                outside.push(Outer { local, ray, part: along_axes(radial, along) });
            }
        }
        outside.extend(middle.map(|local| {
            let [x, y] = model.mesh.points[face.nodes[local]];
            let [radial, along] = axes((y - shape.centre[1]).atan2(x - shape.centre[0]));
            Outer { local, ray, part: along_axes(radial, along) / 2. }
        }));
    }
    let weight = DVector::zeros(2 * face.nodes.len());
    Element { nodes: face.nodes.clone(), stiffness, mass, weight, loads: vec![], joints: vec![], ends, outer: outside }
}

fn along_axes(radial: Vector2<f64>, along: Vector2<f64>) -> Matrix2<f64> {
    Matrix2::from_rows(&[radial.transpose(), along.transpose()])
}

/// Local nodes on a ray: corners, and the mid-sides between two of them.
fn on_ray(face: &Cell, ray: &[usize]) -> Vec<usize> {
    let is_on = |local: &usize| ray.contains(&face.nodes[*local]);
    let corners = (0..face.shape.corner_count()).filter(is_on);
    let sides = face.shape.sides();
    let middles = sides.iter().filter(|s| s.len() == 3 && is_on(&s[0]) && is_on(&s[1])).map(|s| s[2]);
    corners.chain(middles).collect()
}

pub(super) fn material_of(model: &Model, cell: usize) -> Material {
    model.material_of[cell].map(|m| model.materials[m].1).expect("every face has a material")
}

/// Gives each element its weight and the loads that act on it or on one of its sides.
fn add_loads(elements: &mut [Element], model: &Model) {
    let add = |elements: &mut [Element], forces: &assembly::NodalForces, put: &dyn Fn(&mut Element, DVector<f64>)| {
        let holds_all = |e: &&mut Element| forces.nodes.iter().all(|n| e.nodes.contains(n));
        if let Some(element) = elements.iter_mut().find(holds_all).filter(|_| forces.nodes.len() > 1) {
            let at_nodes: Vec<_> = forces.nodes.iter().copied().zip(forces.forces.iter().copied()).collect();
            let vector = element.on_nodes(&at_nodes);
            put(element, vector);
        }
    };
    for forces in assembly::weights(model) {
        add(elements, &forces, &|element, weight| element.weight += weight);
    }
    for (number, load) in model.loads.iter().enumerate() {
        for (line, forces) in assembly::nodal_forces(model, &load.target).iter().enumerate() {
            add(elements, forces, &|element, force| {
                let share = match load.front {
                    None => ElementLoad::Simultaneous(force),
                    Some(_) => ElementLoad::Sweeping(line),
                };
                element.loads.push((number, share));
            });
        }
    }
}

fn add_joints(elements: &mut [Element], shape: &RingShape, model: &Model, system: &System) {
    for (number, point) in system.interface.points.iter().enumerate() {
        for &(joint, area) in &point.parts {
            let body_cell = model.joints[joint].body_cell;
            let Some(i) = shape.sectors.iter().position(|&(cell, _)| cell == body_cell) else { continue };
            for &(pair, n) in &point.share {
                let local = elements[i].nodes.iter().position(|&node| node == model.pairs[pair].body);
                elements[i].joints.extend(local.map(|local| JointShare { point: number, local, n, area }));
            }
        }
    }
}
