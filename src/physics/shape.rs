//! The cell shapes and their shape functions, nodes in Gmsh's order: corners anticlockwise, then mid-sides.

#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Shape {
    Point,
    Line2,
    Line3,
    Tri3,
    Quad4,
    Tri6,
    Quad8,
}

/// Corner signs of the reference square [-1, 1]^2.
const SQUARE: [[f64; 2]; 4] = [[-1., -1.], [1., -1.], [1., 1.], [-1., 1.]];

impl Shape {
    pub fn node_count(self) -> usize {
        match self {
            Shape::Point => 1,
            Shape::Line2 => 2,
            Shape::Line3 | Shape::Tri3 => 3,
            Shape::Quad4 => 4,
            Shape::Tri6 => 6,
            Shape::Quad8 => 8,
        }
    }

    pub fn corner_count(self) -> usize {
        match self {
            Shape::Point => 1,
            Shape::Line2 | Shape::Line3 => 2,
            Shape::Tri3 | Shape::Tri6 => 3,
            Shape::Quad4 | Shape::Quad8 => 4,
        }
    }

    /// 0 point, 1 line, 2 face.
    pub fn dimension(self) -> usize {
        match self {
            Shape::Point => 0,
            Shape::Line2 | Shape::Line3 => 1,
            _ => 2,
        }
    }

    /// Sides of a face as local node numbers, anticlockwise: two ends, then the mid-side node if there is one.
    pub fn sides(self) -> Vec<Vec<usize>> {
        let corners = self.corner_count();
        let has_midsides = self.node_count() > corners;
        (0..corners)
            .map(|i| {
                let mut side = vec![i, (i + 1) % corners];
                if has_midsides {
                    side.push(corners + i);
                }
                side
            })
            .collect()
    }

    /// Shape functions N_i and their derivatives (dN_i/dr, dN_i/ds) at (r, s).
    ///
    /// Triangles: r, s >= 0, r + s <= 1. Squares: [-1, 1]^2. Lines: r in [-1, 1], dN/ds = 0.
    pub fn functions(self, [r, s]: [f64; 2]) -> Vec<(f64, [f64; 2])> {
        match self {
            Shape::Point => vec![(1., [0., 0.])],
            Shape::Line2 => vec![((1. - r) / 2., [-0.5, 0.]), ((1. + r) / 2., [0.5, 0.])],
            Shape::Line3 => vec![
                (r * (r - 1.) / 2., [r - 0.5, 0.]),
                (r * (r + 1.) / 2., [r + 0.5, 0.]),
                (1. - r * r, [-2. * r, 0.]),
            ],
            Shape::Tri3 => vec![(1. - r - s, [-1., -1.]), (r, [1., 0.]), (s, [0., 1.])],
            Shape::Tri6 => tri6([r, s]),
            Shape::Quad4 => SQUARE
                .iter()
                .map(|[a, b]| {
                    let (fr, fs) = (1. + a * r, 1. + b * s);
                    (fr * fs / 4., [a * fs / 4., b * fr / 4.])
                })
                .collect(),
            Shape::Quad8 => quad8([r, s]),
        }
    }
}

/// Corners L(2L - 1), mid-sides 4 La Lb, in area coordinates L = (1 - r - s, r, s).
fn tri6([r, s]: [f64; 2]) -> Vec<(f64, [f64; 2])> {
    let area = [(1. - r - s, [-1., -1.]), (r, [1., 0.]), (s, [0., 1.])];
    let corner = area.iter().map(|(l, d)| (l * (2. * l - 1.), d.map(|d| d * (4. * l - 1.))));
    let middle = [(0, 1), (1, 2), (2, 0)].map(|(i, j)| {
        let ((li, di), (lj, dj)) = (area[i], area[j]);
        (4. * li * lj, [0, 1].map(|k| 4. * (di[k] * lj + li * dj[k])))
    });
    corner.chain(middle).collect()
}

/// Serendipity: corners (1 + ar)(1 + bs)(ar + bs - 1)/4; mid-sides (1 - r^2)(1 + bs)/2 or (1 + ar)(1 - s^2)/2.
fn quad8([r, s]: [f64; 2]) -> Vec<(f64, [f64; 2])> {
    let corner = SQUARE.iter().map(|[a, b]| {
        let (fr, fs, sum) = (1. + a * r, 1. + b * s, a * r + b * s);
        (fr * fs * (sum - 1.) / 4., [a * fs * (sum + a * r) / 4., b * fr * (sum + b * s) / 4.])
    });
    let horizontal = |b: f64| ((1. - r * r) * (1. + b * s) / 2., [-r * (1. + b * s), b * (1. - r * r) / 2.]);
    let vertical = |a: f64| ((1. + a * r) * (1. - s * s) / 2., [a * (1. - s * s) / 2., -s * (1. + a * r)]);
    corner.chain([horizontal(-1.), vertical(1.), horizontal(1.), vertical(-1.)]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const FACES: [(Shape, [f64; 2]); 4] = [
        (Shape::Tri3, [0.2, 0.3]),
        (Shape::Tri6, [0.2, 0.3]),
        (Shape::Quad4, [-0.4, 0.7]),
        (Shape::Quad8, [-0.4, 0.7]),
    ];
    const LINES: [(Shape, [f64; 2]); 2] = [(Shape::Line2, [0.3, 0.]), (Shape::Line3, [0.3, 0.])];

    #[test]
    fn functions_sum_to_one_and_their_derivatives_to_zero() {
        for (shape, at) in FACES.iter().chain(&LINES) {
            let f = shape.functions(*at);
            assert_eq!(f.len(), shape.node_count());
            let sum: f64 = f.iter().map(|f| f.0).sum();
            assert!((sum - 1.).abs() < 1e-15, "{shape:?}");
            for k in 0..2 {
                assert!(f.iter().map(|f| f.1[k]).sum::<f64>().abs() < 1e-15, "{shape:?}");
            }
        }
    }

    /// Central difference of step 1e-6: error h^2/6 N''' < 1e-11 for these polynomials.
    #[test]
    fn derivatives_meet_their_difference_quotient() {
        let h = 1e-6;
        for (shape, [r, s]) in FACES.iter().chain(&LINES) {
            let f = shape.functions([*r, *s]);
            let shifts = [[h, 0.], [0., h]];
            for k in 0..shape.dimension() {
                let plus = shape.functions([r + shifts[k][0], s + shifts[k][1]]);
                let minus = shape.functions([r - shifts[k][0], s - shifts[k][1]]);
                for i in 0..f.len() {
                    let quotient = (plus[i].0 - minus[i].0) / (2. * h);
                    assert!((quotient - f[i].1[k]).abs() < 1e-9, "{shape:?} node {i}");
                }
            }
        }
    }

    #[test]
    fn each_function_is_one_at_its_node_and_zero_at_the_others() {
        let corners = |shape: Shape| match shape.corner_count() {
            2 => vec![[-1., 0.], [1., 0.]],
            3 => vec![[0., 0.], [1., 0.], [0., 1.]],
            _ => SQUARE.to_vec(),
        };
        for shape in FACES.iter().chain(&LINES).map(|(shape, _)| *shape) {
            let mut nodes = corners(shape);
            let middles = shape.node_count() - shape.corner_count();
            for side in shape.sides().iter().take(middles) {
                let (a, b) = (nodes[side[0]], nodes[side[1]]);
                nodes.push([(a[0] + b[0]) / 2., (a[1] + b[1]) / 2.]);
            }
            for (i, at) in nodes.iter().enumerate() {
                for (j, (n, _)) in shape.functions(*at).iter().enumerate() {
                    assert!((n - f64::from(i == j)).abs() < 1e-15, "{shape:?} N{j} at node {i}");
                }
            }
        }
    }
}
