//! Laws that hold for every input: the joint, the elements, the change of variables.

mod support;

use coralpipe::model::mesh::{Mesh, Shape};
use coralpipe::model::split::Pair;
use coralpipe::physics::element::{self, Integral};
use coralpipe::physics::joint::{Friction, JointLaw, Status};
use coralpipe::physics::material::Material;
use coralpipe::solve::unknowns::Unknowns;
use coralpipe::sparse::Orders;
use nalgebra::{DVector, Vector2};
use proptest::prelude::*;
use support::Drawing;

fn law() -> impl Strategy<Value = JointLaw> {
    (1e6..1e12, 1e6..1e12, 0_f64..2.).prop_map(|(normal_stiffness, tangential_stiffness, friction)| JointLaw {
        normal_stiffness,
        tangential_stiffness,
        friction: Friction::Coulomb(friction),
        gap: 0.,
    })
}

/// Jumps and slips of the size that a blast makes [m].
fn jump() -> impl Strategy<Value = Vector2<f64>> {
    (-1e-3..1e-3, -1e-3..1e-3).prop_map(|(s, n)| Vector2::new(s, n))
}

fn coefficient(law: &JointLaw) -> f64 {
    match law.friction {
        Friction::Coulomb(f) => f,
        Friction::Tresca(_) => unreachable!("laws here are Coulomb's"),
    }
}

proptest! {
    // a failing input is printed; nothing is written into the tree
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    /// |tau| <= f p, no tension, nothing at all where open.
    #[test]
    fn tractions_stay_in_the_friction_cone(law in law(), jump in jump(), slip in -1e-3..1e-3) {
        let r = law.respond(jump, slip);
        let [tau, normal] = [r.traction[0], r.traction[1]];
        prop_assert!(normal <= 0. && tau.abs() <= -coefficient(&law) * normal * (1. + 1e-15));
        prop_assert_eq!(r.status == Status::Open, jump[1] > 0.);
        prop_assert!(r.status != Status::Open || r.traction == Vector2::zeros());
    }

    /// tau times the growth of slip is never negative: friction takes energy.
    #[test]
    fn friction_never_gives_energy(law in law(), path in prop::collection::vec(jump(), 1..20)) {
        let mut slip = 0.;
        for jump in path {
            let r = law.respond(jump, slip);
            prop_assert!(r.traction[0] * (r.slip - slip) >= 0.);
            slip = r.slip;
        }
    }

    /// t(lambda j) = lambda t(j) along a whole path, slips included.
    #[test]
    fn the_joint_law_is_homogeneous(law in law(), path in prop::collection::vec(jump(), 1..20), lambda in 1e-3..1e3) {
        let (mut slip, mut scaled) = (0., 0.);
        for jump in path {
            let (r, s) = (law.respond(jump, slip), law.respond(jump * lambda, scaled));
            let scale = (law.normal_stiffness + law.tangential_stiffness) * 1e-3 * lambda;
            let difference: Vector2<f64> = r.traction * lambda - s.traction;
            prop_assert!(difference.norm() <= 1e-12 * scale);
            (slip, scaled) = (r.slip, s.slip);
        }
    }

    /// Any shape with any corners that stay convex: K t = 0 for a translation, and for a small rotation about the
    /// origin.
    #[test]
    fn rigid_motion_makes_no_force(off in prop::array::uniform8(-0.2..0.2), poisson in 0_f64..0.49) {
        for shape in [Shape::Tri3, Shape::Quad4, Shape::Tri6, Shape::Quad8] {
            let square = [[0., 0.], [1., 0.], [1., 1.], [0., 1.]];
            let mut nodes: Vec<[f64; 2]> = (0..shape.corner_count())
                .map(|i| [square[i][0] + off[2 * i], square[i][1] + off[2 * i + 1]])
                .collect();
            for side in shape.sides().iter().filter(|s| s.len() == 3) {
                let (a, b) = (nodes[side[0]], nodes[side[1]]);
                nodes.push([(a[0] + b[0]) / 2., (a[1] + b[1]) / 2.]);
            }
            let d = Material { young: 1., poisson, density: 1. }.plane_strain();
            let k = element::stiffness(&element::points(shape, &nodes, Integral::Stiffness), &d);
            let motion = |f: &dyn Fn(&[f64; 2]) -> [f64; 2]| DVector::from_vec(nodes.iter().flat_map(f).collect());
            for u in [motion(&|_| [1., 0.]), motion(&|_| [0., 1.]), motion(&|[x, y]| [-y, *x])] {
                prop_assert!((&k * u).amax() < 1e-12 * k.amax(), "{shape:?}");
            }
        }
    }

    /// Grids with pairs between them and any nodes held: there are as many unknowns as free displacements, those of the
    /// pairs' nodes last; held nodes stay; and the jump of each pair, which is there wherever one of its nodes can
    /// move, is the difference of its nodes' motions.
    #[test]
    fn unknowns_describe_every_motion_that_supports_allow(
        held in prop::collection::vec(prop::array::uniform2(prop::bool::weighted(0.2)), 30),
        values in prop::collection::vec(prop::array::uniform2(-1_f64..1.), 30),
    ) {
        let (mesh, pairs) = two_halves();
        let unknowns = Unknowns::new(&mesh, &held, &pairs, &Orders::default()).unwrap();
        prop_assert_eq!(unknowns.count, held.iter().flatten().filter(|held| !**held).count());
        let q = unknowns.from_nodes(&values);
        let u = unknowns.at_nodes(&q);
        for axis in 0..2 {
            for (node, held) in held.iter().enumerate() {
                prop_assert_eq!(u[node][axis], if held[axis] { 0. } else { values[node][axis] });
                let paired = pairs.iter().any(|p| p.ground == node || p.body == node);
                prop_assert!(unknowns.of(node, axis).is_none_or(|i| (i >= unknowns.border) == paired));
            }
            for (pair, jumps) in pairs.iter().zip(&unknowns.jumps) {
                let moves = !held[pair.ground][axis] || !held[pair.body][axis];
                prop_assert_eq!(jumps[axis].len(), usize::from(moves), "no interfaces meet here");
                let exact = u[pair.ground][axis] - u[pair.body][axis];
                let of_sides = |place| unknowns.sides.of(place).map(|(i, sign)| sign * q[i]).sum::<f64>();
                for &(place, sign) in &jumps[axis] {
                    prop_assert_eq!(sign * q[unknowns.count + place], exact);
                    prop_assert_eq!(sign * of_sides(place), exact);
                }
            }
        }
    }
}

/// Two grids of 5 x 3 nodes, one on the other, and the pairs where they meet.
fn two_halves() -> (Mesh, Vec<Pair>) {
    let mut drawing = Drawing::default();
    for half in 0..2 {
        for (row, column) in (0..3).flat_map(|row| (0..5).map(move |column| (row, column))) {
            drawing.node([f64::from(column), f64::from(row + 2 * half)]);
        }
        for (row, column) in (0..2).flat_map(|row| (0..4).map(move |column| (row, column))) {
            let n = 15 * half as usize + 5 * row + column;
            drawing.cell("grid", Shape::Quad4, &[n, n + 1, n + 6, n + 5]);
        }
    }
    let pairs = (0..5).map(|i| Pair { ground: 10 + i, body: 15 + i }).collect();
    (drawing.mesh(), pairs)
}
