//! From elements to the matrices and load vectors of the unknowns: K = sum T' k T.

use super::unknowns::Unknowns;
use crate::model::absorbing::Absorber;
use crate::model::boundary::Border;
use crate::model::case::{Mass, Quad4};
use crate::model::resolve::{Load, Model, Target};
use crate::physics::element::{self, Integral};
use crate::physics::material::Material;
use crate::physics::shape::Shape;
use nalgebra::DMatrix;
use sprs::{CsMat, TriMat};

/// K and M of all faces on one pattern; both triangles stored.
pub fn stiffness_and_mass(model: &Model, unknowns: &Unknowns) -> (CsMat<f64>, CsMat<f64>) {
    let shape = (unknowns.count, unknowns.count);
    let (mut k, mut m) = (TriMat::new(shape), TriMat::new(shape));
    for (cell, material) in model.faces() {
        let (stiffness, mass) = of_face(model, cell, material);
        scatter(&mut k, &mut m, unknowns, &model.mesh.cells[cell].nodes, &stiffness, &mass);
    }
    // Where a support holds one side of a pair, its two jumps stand in the rows of different faces: the joint couples them.
    for joint in &model.joints {
        let jumps: Vec<usize> = joint.pairs.iter().flat_map(|&p| unknowns.jumps[p]).flatten().collect();
        for (&i, &j) in jumps.iter().flat_map(|i| jumps.iter().map(move |j| (i, j))) {
            k.add_triplet(i, j, 0.);
            m.add_triplet(i, j, 0.);
        }
    }
    (k.to_csr(), m.to_csr())
}

/// k [N/m] and m [kg] of one face.
pub fn of_face(model: &Model, cell: usize, material: &Material) -> (DMatrix<f64>, DMatrix<f64>) {
    let shape = model.mesh.cells[cell].shape;
    let at = corners(model, &model.mesh.cells[cell].nodes);
    let for_stiffness = element::points(shape, &at, Integral::Stiffness);
    let for_mass = element::points(shape, &at, Integral::Mass);
    let mass = match model.mass {
        Mass::Consistent => element::mass(&for_mass, material.density),
        Mass::Lumped => element::lumped_mass(&for_mass, material.density),
    };
    let stiffness = match (shape, model.quad4) {
        (Shape::Quad4, Quad4::BBar) => element::b_bar_stiffness(&for_stiffness, material),
        _ => element::stiffness(&for_stiffness, &material.plane_strain()),
    };
    (stiffness, mass)
}

/// Adds T' k T and T' m T of one element, entry by entry alike, zeros too: that keeps the patterns the same.
fn scatter(
    k: &mut TriMat<f64>,
    m: &mut TriMat<f64>,
    unknowns: &Unknowns,
    nodes: &[usize],
    stiffness: &DMatrix<f64>,
    mass: &DMatrix<f64>,
) {
    let row = |local: usize| unknowns.row(nodes[local / 2], local % 2);
    for a in 0..stiffness.nrows() {
        for b in 0..stiffness.ncols() {
            for &(i, sign_i) in row(a) {
                for &(j, sign_j) in row(b) {
                    k.add_triplet(i, j, sign_i * sign_j * stiffness[(a, b)]);
                    m.add_triplet(i, j, sign_i * sign_j * mass[(a, b)]);
                }
            }
        }
    }
}

/// Forces on the nodes of one loaded line or face, or on one point [N, or N per unit of the pulse].
#[derive(Debug, Clone, PartialEq)]
pub struct NodalForces {
    pub nodes: Vec<usize>,
    pub forces: Vec<[f64; 2]>,
}

/// f = T' (integral of N' t over the loaded lines, or the forces on the points) [N per unit of the pulse].
pub fn load(model: &Model, unknowns: &Unknowns, load: &Load) -> Vec<f64> {
    gathered(unknowns, &nodal_forces(model, &load.target))
}

/// The same, line by line, face by face, point by point.
pub fn nodal_forces(model: &Model, target: &Target) -> Vec<NodalForces> {
    let on_lines = |lines: &[Border], g: &dyn Fn([f64; 2]) -> [f64; 2]| {
        let on_line = |line: &Border| NodalForces { nodes: line.nodes.clone(), forces: line_integral(model, line, g) };
        lines.iter().map(on_line).collect()
    };
    match target {
        Target::Pressure { lines } => on_lines(lines, &|[tx, ty]| [-ty, tx]),
        Target::Traction { lines, direction: [dx, dy] } => {
            on_lines(lines, &|[tx, ty]| [dx * tx.hypot(ty), dy * tx.hypot(ty)])
        }
        Target::BodyForce { cells, direction } => cells.iter().map(|&c| body_force(model, c, *direction)).collect(),
        Target::Force { nodes, direction } => {
            nodes.iter().map(|&node| NodalForces { nodes: vec![node], forces: vec![*direction] }).collect()
        }
    }
}

/// Weight of all faces, integral of N' rho g dv, downwards [N].
pub fn gravity(model: &Model, unknowns: &Unknowns) -> Vec<f64> {
    gathered(unknowns, &weights(model))
}

/// The weight of each face [N], if there is gravity.
pub fn weights(model: &Model) -> Vec<NodalForces> {
    let heavy = model.faces().filter(|_| model.gravity > 0.);
    heavy.map(|(cell, material)| body_force(model, cell, [0., -material.density * model.gravity])).collect()
}

/// Integral of N' b dv over a face, b [N/m^3].
fn body_force(model: &Model, cell: usize, [bx, by]: [f64; 2]) -> NodalForces {
    let cell = &model.mesh.cells[cell];
    let points = element::points(cell.shape, &corners(model, &cell.nodes), Integral::Mass);
    let volume = |local: usize| points.iter().map(|p| p.n[local] * p.dv).sum::<f64>();
    let forces = (0..cell.nodes.len()).map(|local| [bx * volume(local), by * volume(local)]).collect();
    NodalForces { nodes: cell.nodes.clone(), forces }
}

/// f = T' of nodal forces.
fn gathered(unknowns: &Unknowns, forces: &[NodalForces]) -> Vec<f64> {
    let mut f = vec![0.; unknowns.count];
    for (node, force) in forces.iter().flat_map(|p| p.nodes.iter().zip(&p.forces)) {
        for axis in 0..2 {
            for &(i, sign) in unknowns.row(*node, axis) {
                f[i] += sign * force[axis];
            }
        }
    }
    f
}

/// C of the absorbing lines: integral of N' rho (c_p n n' + c_s s s') N ds, added on the pattern of `zeros` [N s/m].
pub fn dashpots(model: &Model, unknowns: &Unknowns, zeros: CsMat<f64>) -> CsMat<f64> {
    let mut c = zeros;
    for Absorber { line, material, .. } in &model.absorbers {
        let impedances = [material.density * material.p_speed(), material.density * material.s_speed()];
        for (a, &node_a) in line.nodes.iter().enumerate() {
            for (b, &node_b) in line.nodes.iter().enumerate() {
                let block = dashpot_block(&corners(model, &line.nodes), line.shape, impedances, a, b);
                for (axis_a, axis_b) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                    for &(i, sign_i) in unknowns.row(node_a, axis_a) {
                        for &(j, sign_j) in unknowns.row(node_b, axis_b) {
                            let entry = c.get_mut(i, j).expect("nodes of a line share the face behind it");
                            *entry += sign_i * sign_j * block[axis_a][axis_b];
                        }
                    }
                }
            }
        }
    }
    c
}

/// Integral of N_a N_b (Z_p n n' + Z_s s s') ds over a line [N s/m].
pub fn dashpot_block(at: &[[f64; 2]], shape: Shape, [z_p, z_s]: [f64; 2], a: usize, b: usize) -> [[f64; 2]; 2] {
    let mut block = [[0.; 2]; 2];
    for (r, weight) in element::gauss_3() {
        let functions = shape.functions([r, 0.]);
        let tangent = [0, 1].map(|i| at.iter().zip(&functions).map(|(x, f)| f.1[0] * x[i]).sum::<f64>());
        let length = tangent[0].hypot(tangent[1]);
        let (s, n) = (tangent.map(|t| t / length), [-tangent[1] / length, tangent[0] / length]);
        let share = functions[a].0 * functions[b].0 * length * weight;
        for i in 0..2 {
            for j in 0..2 {
                block[i][j] += share * (z_p * n[i] * n[j] + z_s * s[i] * s[j]);
            }
        }
    }
    block
}

pub fn corners(model: &Model, nodes: &[usize]) -> Vec<[f64; 2]> {
    nodes.iter().map(|&n| model.mesh.points[n]).collect()
}

/// Integral of N g(dx/dr) dr over a line; a pressure's g turns the tangent to the left, where the solid lies.
fn line_integral(model: &Model, line: &Border, g: impl Fn([f64; 2]) -> [f64; 2]) -> Vec<[f64; 2]> {
    let at = corners(model, &line.nodes);
    let mut forces = vec![[0.; 2]; at.len()];
    for (r, weight) in element::gauss_3() {
        let functions = line.shape.functions([r, 0.]);
        let tangent = [0, 1].map(|i| at.iter().zip(&functions).map(|(x, f)| f.1[0] * x[i]).sum::<f64>());
        let value = g(tangent);
        for (force, (n, _)) in forces.iter_mut().zip(&functions) {
            force[0] += n * value[0] * weight;
            force[1] += n * value[1] * weight;
        }
    }
    forces
}
