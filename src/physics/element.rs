//! Plane-strain elements T3, Q4, T6, Q8: stiffness and mass by Gauss quadrature, eqs. (2)-(6) of the paper.
//!
//! Matrices run over the element's unknowns (u_x, u_y of node 0, of node 1, ...), for a slice 1 m thick.

use super::material::Material;
use super::shape::Shape;
use nalgebra::{DMatrix, DVector, Matrix3};

/// An integration point: shape functions and their gradients in x, y, and the volume it stands for.
#[derive(Debug, Clone, PartialEq)]
pub struct Point {
    /// where it lies [m]
    pub at: [f64; 2],
    /// N_i [-]
    pub n: Vec<f64>,
    /// dN_i/dx, dN_i/dy [1/m]
    pub gradient: Vec<[f64; 2]>,
    /// det J times the weight, times 1 m [m^3]; not positive where the element is folded
    pub dv: f64,
}

impl Point {
    /// epsilon = B u, with epsilon = (xx, yy, gamma_xy): 3 x 2n [1/m].
    pub fn b(&self) -> DMatrix<f64> {
        let mut b = DMatrix::zeros(3, 2 * self.n.len());
        for (i, [dx, dy]) in self.gradient.iter().enumerate() {
            b[(0, 2 * i)] = *dx;
            b[(1, 2 * i + 1)] = *dy;
            b[(2, 2 * i)] = *dy;
            b[(2, 2 * i + 1)] = *dx;
        }
        b
    }

    /// u(x) = N u: 2 x 2n [-].
    pub fn n_matrix(&self) -> DMatrix<f64> {
        let mut n = DMatrix::zeros(2, 2 * self.n.len());
        for (i, ni) in self.n.iter().enumerate() {
            n[(0, 2 * i)] = *ni;
            n[(1, 2 * i + 1)] = *ni;
        }
        n
    }
}

/// K = sum B' D B dv [N/m], eq. (5).
pub fn stiffness(points: &[Point], d: &Matrix3<f64>) -> DMatrix<f64> {
    points.iter().map(|p| p.b().transpose() * d * p.b() * p.dv).sum()
}

/// B-bar (Hughes 1980): the dilatation is its mean over the element, so nothing locks as nu nears 1/2.
///
/// K = sum B' D_dev B dv + K_b V b b', with b' = 1/V sum (1, 1, 0) B dv [N/m].
pub fn b_bar_stiffness(points: &[Point], material: &Material) -> DMatrix<f64> {
    let b = mean_dilatation(points);
    let volume: f64 = points.iter().map(|p| p.dv).sum();
    stiffness(points, &material.deviatoric()) + b.transpose() * &b * (material.bulk_modulus() * volume)
}

/// The row that gives the mean of eps_xx + eps_yy over an element: 1 x 2n [1/m].
pub fn mean_dilatation(points: &[Point]) -> DMatrix<f64> {
    let volume: f64 = points.iter().map(|p| p.dv).sum();
    let trace = DMatrix::from_row_slice(1, 3, &[1., 1., 0.]);
    points.iter().map(|p| &trace * p.b() * (p.dv / volume)).sum()
}

/// Consistent mass M = sum rho N' N dv [kg], eq. (6).
pub fn mass(points: &[Point], density: f64) -> DMatrix<f64> {
    points.iter().map(|p| p.n_matrix().transpose() * p.n_matrix() * (density * p.dv)).sum()
}

/// Lumped mass: the diagonal of the consistent one, scaled to the element's mass (Hinton, Rock, Zienkiewicz 1976) [kg].
pub fn lumped_mass(points: &[Point], density: f64) -> DMatrix<f64> {
    let diagonal = mass(points, density).diagonal();
    let total: f64 = points.iter().map(|p| density * p.dv).sum();
    let along_x: f64 = diagonal.iter().step_by(2).sum();
    DMatrix::from_diagonal(&(diagonal * (total / along_x)))
}

/// What a node that leaves its mass to others keeps of it, so that the mass matrix stays positive definite [-].
const KEPT: f64 = 1e-6;

/// s D M D [kg]: the consistent mass M with D^2 = [`KEPT`] at the `light` nodes and 1 at the others, and s such that the
/// element keeps its mass; M itself where all nodes are light (after Khenous, Laborde and Renard 2008).
pub fn redistributed_mass(points: &[Point], density: f64, light: &[bool]) -> DMatrix<f64> {
    let consistent = mass(points, density);
    if light.iter().all(|light| *light) {
        return consistent;
    }
    let d = DVector::from_iterator(2 * light.len(), light.iter().flat_map(|&l| [if l { KEPT.sqrt() } else { 1. }; 2]));
    let moved = consistent.component_mul(&(&d * d.transpose()));
    &moved * (consistent.sum() / moved.sum())
}

/// What an integral must be exact for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Integral {
    Stiffness,
    Mass,
}

/// Integration points of a face with the given nodes [m], anticlockwise.
pub fn points(shape: Shape, nodes: &[[f64; 2]], integral: Integral) -> Vec<Point> {
    rule(shape, integral).iter().map(|&(at, weight)| point(shape, nodes, at, weight)).collect()
}

/// The point at (r, s) of the reference cell: gradients by the chain rule, dN/dx = J^-1 dN/dr.
pub fn point(shape: Shape, nodes: &[[f64; 2]], at: [f64; 2], weight: f64) -> Point {
    let functions = shape.functions(at);
    let sum = |f: &dyn Fn(usize) -> f64| (0..nodes.len()).map(f).sum::<f64>();
    // J[k][i] = dx_i / dr_k
    let j = [0, 1].map(|k| [0, 1].map(|i| sum(&|a| functions[a].1[k] * nodes[a][i])));
    let det = j[0][0] * j[1][1] - j[0][1] * j[1][0];
    let gradient = functions
        .iter()
        .map(|(_, [dr, ds])| [(j[1][1] * dr - j[0][1] * ds) / det, (j[0][0] * ds - j[1][0] * dr) / det])
        .collect();
    Point {
        at: [0, 1].map(|i| sum(&|a| functions[a].0 * nodes[a][i])),
        n: functions.iter().map(|f| f.0).collect(),
        gradient,
        dv: det * weight,
    }
}

/// Points (r, s) and weights. Stiffness: 1, 2x2, 3, 3x3 points for T3, Q4, T6, Q8; mass: exact for N N' on straight
/// sides.
fn rule(shape: Shape, integral: Integral) -> Vec<([f64; 2], f64)> {
    match (shape, integral) {
        (Shape::Tri3, Integral::Stiffness) => vec![([1. / 3., 1. / 3.], 0.5)],
        (Shape::Tri3, Integral::Mass) | (Shape::Tri6, Integral::Stiffness) => triangle_3(),
        (Shape::Tri6, Integral::Mass) => triangle_6(),
        (Shape::Quad4, _) => square(&gauss_2()),
        (Shape::Quad8, _) => square(&gauss_3()),
        (Shape::Point | Shape::Line2 | Shape::Line3, _) => vec![],
    }
}

/// Gauss-Legendre on [-1, 1], exact to degree 3: (point, weight).
pub fn gauss_2() -> [(f64, f64); 2] {
    let a = 1. / 3f64.sqrt();
    [(-a, 1.), (a, 1.)]
}

/// Gauss-Legendre on [-1, 1], exact to degree 5.
pub fn gauss_3() -> [(f64, f64); 3] {
    let a = 0.6f64.sqrt();
    [(-a, 5. / 9.), (0., 8. / 9.), (a, 5. / 9.)]
}

fn square(line: &[(f64, f64)]) -> Vec<([f64; 2], f64)> {
    let grid = line.iter().flat_map(|a| line.iter().map(move |b| (a, b)));
    grid.map(|((r, wr), (s, ws))| ([*r, *s], wr * ws)).collect()
}

/// Exact to degree 2.
fn triangle_3() -> Vec<([f64; 2], f64)> {
    let (a, b) = (1. / 6., 2. / 3.);
    [[a, a], [b, a], [a, b]].map(|p| (p, 1. / 6.)).to_vec()
}

/// Exact to degree 4 (Strang and Fix 1973; the roots in closed form).
fn triangle_6() -> Vec<([f64; 2], f64)> {
    let root10 = 10f64.sqrt();
    let inner = (38. - 44. * 0.4f64.sqrt()).sqrt();
    let spread = (213_125. - 53_320. * root10).sqrt();
    [(1., 1.), (-1., -1.)]
        .iter()
        .flat_map(|&(sign, spread_sign)| {
            let a = (8. - root10 + sign * inner) / 18.;
            let weight = (620. + spread_sign * spread) / 3720. / 2.;
            let b = 1. - 2. * a;
            [[a, a], [b, a], [a, b]].map(|p| (p, weight))
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const STEEL: Material = Material { young: 1e6, poisson: 0.25, density: 7800. };

    /// A distorted face of each shape, mid-sides moved a little off the straight line.
    fn distorted(shape: Shape) -> Vec<[f64; 2]> {
        let mut nodes = match shape.corner_count() {
            3 => vec![[0., 0.], [1.3, 0.2], [0.3, 0.9]],
            _ => vec![[0., 0.], [1.2, 0.1], [1., 1.1], [-0.1, 0.8]],
        };
        for side in shape.sides().iter().filter(|s| s.len() == 3) {
            let (a, b) = (nodes[side[0]], nodes[side[1]]);
            nodes.push([(a[0] + b[0]) / 2. + 0.02, (a[1] + b[1]) / 2. - 0.01]);
        }
        nodes
    }

    /// Translations keep their kinetic energy; light nodes keep a millionth of theirs.
    #[test]
    fn redistributed_mass_is_that_of_the_element_and_leaves_next_to_none_at_light_nodes() {
        for shape in SHAPES {
            let points = points(shape, &distorted(shape), Integral::Mass);
            let light: Vec<bool> = (0..shape.node_count()).map(|node| node < 2).collect();
            let [whole, moved] = [mass(&points, 2.), redistributed_mass(&points, 2., &light)];
            assert!((moved.sum() / whole.sum() - 1.).abs() < 1e-14, "{shape:?}: round-off of a sum");
            let share = moved[(0, 0)] / whole[(0, 0)];
            // times s, what the other nodes gain: 0.94 for T6, whose mid-side nodes have negative terms, 9 for Q4
            assert!((KEPT / 2. ..20. * KEPT).contains(&share), "{shape:?}: {share}");
            assert!(moved.cholesky().is_some(), "{shape:?}");
            assert_eq!(redistributed_mass(&points, 2., &vec![true; shape.node_count()]), whole);
        }
    }

    const SHAPES: [Shape; 4] = [Shape::Tri3, Shape::Quad4, Shape::Tri6, Shape::Quad8];

    /// Relative to the largest eigenvalue the zero ones are round-off, the smallest elastic one is above 1e-3.
    #[test]
    fn an_element_has_exactly_three_rigid_modes() {
        let count = |k: DMatrix<f64>| {
            let eigen = k.symmetric_eigenvalues();
            eigen.iter().filter(|e| e.abs() < 1e-8 * eigen.max()).count()
        };
        for shape in SHAPES {
            let points = points(shape, &distorted(shape), Integral::Stiffness);
            assert_eq!(count(stiffness(&points, &STEEL.plane_strain())), 3, "{shape:?}");
        }
        let points = points(Shape::Quad4, &distorted(Shape::Quad4), Integral::Stiffness);
        assert_eq!(count(b_bar_stiffness(&points, &STEEL)), 3, "B-bar");
    }

    /// u = 1e-3 (x + y / 2, y + x / 2): stress 1600, 1600, 400; u'K u = integral of sigma . epsilon = 3.6 times the
    /// area that the points sum to, curved sides and B-bar included.
    #[test]
    fn a_linear_field_gives_its_exact_stress_and_energy() {
        for shape in SHAPES {
            let nodes = distorted(shape);
            let u = DVector::from_iterator(
                2 * nodes.len(),
                nodes.iter().flat_map(|[x, y]| [1e-3 * (x + y / 2.), 1e-3 * (y + x / 2.)]),
            );
            let d = STEEL.plane_strain();
            let points = points(shape, &nodes, Integral::Stiffness);
            let energy = 3.6 * points.iter().map(|p| p.dv).sum::<f64>();
            let b_bar = (shape == Shape::Quad4).then(|| b_bar_stiffness(&points, &STEEL));
            for k in b_bar.into_iter().chain([stiffness(&points, &d)]) {
                assert!((u.dot(&(k * &u)) / energy - 1.).abs() < 1e-13, "{shape:?}");
            }
            for p in points {
                let stress = d * p.b() * &u;
                for (s, exact) in stress.iter().zip([1600., 1600., 400.]) {
                    assert!((s - exact).abs() < 1e-9, "{shape:?}: {s}");
                }
            }
        }
    }

    /// A rectangle's linear dilatation field has no mean: B-bar then stores the deviatoric energy alone, whatever nu.
    #[test]
    fn b_bar_agrees_under_constant_strain_and_ignores_the_dilatation_of_bending() {
        let square = [[-1., -1.], [1., -1.], [1., 1.], [-1., 1.]];
        let points = points(Shape::Quad4, &square, Integral::Stiffness);
        let (plain, bar) = (stiffness(&points, &STEEL.plane_strain()), b_bar_stiffness(&points, &STEEL));
        let field = |f: fn(f64, f64) -> [f64; 2]| DVector::from_iterator(8, square.iter().flat_map(|[x, y]| f(*x, *y)));
        let linear = field(|x, y| [1e-3 * (x + y / 2.), 1e-3 * (y - x)]);
        assert!((&plain * &linear - &bar * &linear).norm() < 1e-12 * (&plain * &linear).norm());
        // u = (xy, 0): eps_xx = y, gamma = x; energy per G: integral of 4/3 y^2 + x^2 = 4 (4/3 + 1) / 3.
        let bending = field(|x, y| [x * y, 0.]);
        let energy = bending.dot(&(&bar * &bending));
        assert!((energy / STEEL.shear_modulus() - 28. / 9.).abs() < 1e-12);
    }

    /// Integrals of r^p s^q over the reference triangle are p! q! / (p + q + 2)!.
    #[test]
    fn triangle_rules_are_exact_to_their_degree() {
        let factorial = |n: i32| (1..=n).map(f64::from).product::<f64>();
        for (rule, degree) in [(triangle_3(), 2), (triangle_6(), 4)] {
            for p in 0..=degree {
                for q in 0..=degree - p {
                    let sum: f64 = rule.iter().map(|([r, s], w)| w * r.powi(p) * s.powi(q)).sum();
                    let exact = factorial(p) * factorial(q) / factorial(p + q + 2);
                    assert!((sum - exact).abs() < 1e-15, "r^{p} s^{q}: {sum} {exact}");
                }
            }
        }
    }

    #[test]
    fn both_masses_carry_the_elements_mass_in_each_direction() {
        for shape in SHAPES {
            let points = points(shape, &distorted(shape), Integral::Mass);
            let total: f64 = points.iter().map(|p| 7800. * p.dv).sum();
            for m in [mass(&points, 7800.), lumped_mass(&points, 7800.)] {
                let ones = DVector::from_fn(m.nrows(), |i, _| f64::from(i % 2 == 0));
                assert!((ones.dot(&(&m * &ones)) / total - 1.).abs() < 1e-14, "{shape:?}");
            }
        }
    }
}
