//! From elements to the matrices and load vectors of the unknowns.

use super::unknowns::Unknowns;
use crate::model::absorbing::Absorber;
use crate::model::boundary::Border;
use crate::model::case::{Mass, Quad4};
use crate::model::mesh::Cell;
use crate::model::resolve::{Load, Model, Target};
use crate::physics::element::{self, Integral};
use crate::physics::material::Material;
use crate::physics::shape::Shape;
use crate::sparse::Graph;
use crate::threads::both;
use nalgebra::DMatrix;
use sprs::CsMat;

/// K and M of all faces on one pattern; both triangles stored.
pub fn stiffness_and_mass(model: &Model, unknowns: &Unknowns) -> (CsMat<f64>, CsMat<f64>) {
    let faces = as_eliminated(model, unknowns);
    let zeros = pattern(model, unknowns, &faces);
    let pattern = zeros.clone();
    both(
        || sum_of_faces(model, unknowns, &faces, zeros, stiffness_of_face),
        || sum_of_faces(model, unknowns, &faces, pattern, mass_of_face),
    )
}

/// The faces in the order of their first unknowns: neighbours in it share rows of the matrices, which so stay in the
/// cache.
fn as_eliminated<'a>(model: &'a Model, unknowns: &Unknowns) -> Vec<(usize, &'a Material)> {
    let mut faces: Vec<(usize, &Material)> = model.faces().collect();
    faces.sort_by_cached_key(|(cell, _)| of_nodes(unknowns, &model.mesh.cells[*cell].nodes).min());
    faces
}

/// The unknowns of some nodes.
fn of_nodes<'a>(unknowns: &'a Unknowns, nodes: &'a [usize]) -> impl Iterator<Item = usize> + 'a {
    nodes.iter().flat_map(|&n| [unknowns.of(n, 0), unknowns.of(n, 1)]).flatten()
}

/// Zeros where unknowns are coupled: within a face and, for closed joints, within a joint.
fn pattern(model: &Model, unknowns: &Unknowns, faces: &[(usize, &Material)]) -> CsMat<f64> {
    let faces = faces.iter().map(|(cell, _)| of_nodes(unknowns, &model.mesh.cells[*cell].nodes).collect());
    let joints = model.joints.iter().map(|joint| {
        let jumps = joint.pairs.iter().flat_map(|&pair| unknowns.jumps[pair].iter().flatten());
        jumps.flat_map(|&(jump, _)| unknowns.sides.of(jump).map(|(unknown, _)| unknown)).collect()
    });
    let cliques: Vec<Vec<usize>> = faces.chain(joints).collect();
    Graph::from_cliques(unknowns.count, cliques.iter().map(Vec::as_slice)).zeros()
}

/// Sum of the matrices a of all faces, on the pattern of `zeros`.
fn sum_of_faces(
    model: &Model,
    unknowns: &Unknowns,
    faces: &[(usize, &Material)],
    zeros: CsMat<f64>,
    of_face: fn(&Model, usize, &Material) -> DMatrix<f64>,
) -> CsMat<f64> {
    let (start, columns, mut values) = zeros.into_raw_storage();
    for &(cell, material) in faces {
        let a = of_face(model, cell, material);
        let nodes = &model.mesh.cells[cell].nodes;
        let numbered = |k: usize| Some((k, unknowns.of(nodes[k / 2], k % 2)?));
        let terms: Vec<(usize, usize)> = (0..a.nrows()).filter_map(numbered).collect();
        for &(k, i) in &terms {
            let row = start[i]..start[i + 1];
            for &(l, j) in &terms {
                // Some twenty columns: to look at one after the other is quicker than to halve them.
                let place = columns[row.clone()].iter().position(|&column| column == j);
                let place = place.expect("the pattern couples the unknowns of a face");
                values[row.start + place] += a[(k, l)];
            }
        }
    }
    CsMat::new((unknowns.count, unknowns.count), start, columns, values)
}

/// k of one face [N/m].
pub fn stiffness_of_face(model: &Model, cell: usize, material: &Material) -> DMatrix<f64> {
    let Cell { shape, nodes } = &model.mesh.cells[cell];
    let points = element::points(*shape, &corners(model, nodes), Integral::Stiffness);
    match (shape, model.quad4) {
        (Shape::Quad4, Quad4::BBar) => element::b_bar_stiffness(&points, material),
        _ => element::stiffness(&points, &material.plane_strain()),
    }
}

/// m of one face [kg].
pub fn mass_of_face(model: &Model, cell: usize, material: &Material) -> DMatrix<f64> {
    let Cell { shape, nodes } = &model.mesh.cells[cell];
    let points = element::points(*shape, &corners(model, nodes), Integral::Mass);
    match model.mass {
        Mass::Consistent => element::mass(&points, material.density),
        Mass::Lumped => element::lumped_mass(&points, material.density),
        Mass::Redistributed => {
            let light: Vec<bool> = nodes.iter().map(|&node| model.light[node]).collect();
            element::redistributed_mass(&points, material.density, &light)
        }
    }
}

/// Forces on the nodes of one loaded line or face, or on one point [N, or N per unit of the pulse].
#[derive(Debug, Clone, PartialEq)]
pub struct NodalForces {
    pub nodes: Vec<usize>,
    pub forces: Vec<[f64; 2]>,
}

/// f = integral of N' t over the loaded lines, or the forces on the points [N per unit of the pulse].
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

/// f of nodal forces.
fn gathered(unknowns: &Unknowns, forces: &[NodalForces]) -> Vec<f64> {
    let mut f = vec![0.; unknowns.count];
    for (node, force) in forces.iter().flat_map(|p| p.nodes.iter().zip(&p.forces)) {
        for axis in 0..2 {
            unknowns.of(*node, axis).iter().for_each(|&i| f[i] += force[axis]);
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
                    if let (Some(i), Some(j)) = (unknowns.of(node_a, axis_a), unknowns.of(node_b, axis_b)) {
                        let entry = c.get_mut(i, j).expect("nodes of a line share the face behind it");
                        *entry += block[axis_a][axis_b];
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
