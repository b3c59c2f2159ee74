//! Stress at the nodes: superconvergent patch recovery (Zienkiewicz and Zhu 1992), each material by itself.
//!
//! Round an inner corner node a polynomial P(x) a = sigma is fitted by least squares to the best points of the elements
//! that meet there, with all terms of the degree of the shape functions: 1, x, y for T3 and Q4, and x^2, xy, y^2 for T6
//! and Q8. The node takes its value from it; a mid-side node from the fits of its two ends; a node on a border from all
//! fits round the corners of its elements. Where a body has no inner node, an element's own best points are fitted with
//! a degree less. Several fits give their mean. All of it is linear: sigma(node) = sum of weight times sigma(best
//! point).

use crate::physics::shape::Shape;
use nalgebra::{DMatrix, DVector};
use std::collections::{BTreeMap, BTreeSet};

/// (best point, weight)
type Weights = Vec<(usize, f64)>;

/// For each site the weights of the best points; none where no face is.
pub struct Nodal {
    /// of all sites, one after the other
    weights: Weights,
    /// where those of each site end
    ends: Vec<usize>,
}

/// A face between sites, its best points numbered through all faces.
pub struct Patchwork {
    pub shape: Shape,
    pub sites: Vec<usize>,
    pub best: Vec<usize>,
}

impl Nodal {
    /// `points`: place of each site [m]; `best`: places of the best points [m].
    pub fn new(faces: &[Patchwork], points: &[[f64; 2]], best: &[[f64; 2]]) -> Nodal {
        let mut around: Vec<Vec<usize>> = vec![vec![]; points.len()];
        for (f, face) in faces.iter().enumerate() {
            face.sites.iter().for_each(|&site| around[site].push(f));
        }
        let inner = inner_corners(faces);
        let fit_at = |site: usize| {
            let samples = around[site].iter().flat_map(|&f| faces[f].best.iter().copied()).collect();
            let fit =
                inner.contains(&site).then(|| Fit::new(points[site], samples, best, degree(&faces[around[site][0]])));
            // one sample to spare: with none a fit passes on their errors whole
            fit.flatten().filter(|fit| fit.samples.len() > fit.r.ncols())
        };
        let fits = (0..points.len()).map(fit_at).collect();
        let own = faces.iter().map(|face| own_fit(face, best)).collect();
        let all = Fits { faces, around, ends: ends_of_midsides(faces), fits, own };
        let mut nodal = Nodal { weights: vec![], ends: vec![] };
        for (site, &place) in points.iter().enumerate() {
            nodal.weights.extend(mean_at(place, all.of(site)));
            nodal.ends.push(nodal.weights.len());
        }
        nodal
    }

    /// Stress at every site from that at the best points; zero where no face is.
    pub fn at_sites(&self, best: &[[f64; 4]]) -> Vec<[f64; 4]> {
        let plus = |sum: [f64; 4], &(i, w): &(usize, f64)| [0, 1, 2, 3].map(|k| sum[k] + w * best[i][k]);
        let starts = std::iter::once(&0).chain(&self.ends);
        let of_sites = starts.zip(&self.ends).map(|(&start, &end)| &self.weights[start..end]);
        of_sites.map(|weights| weights.iter().fold([0.; 4], plus)).collect()
    }
}

/// All fits there are, to choose from.
struct Fits<'a> {
    faces: &'a [Patchwork],
    /// faces at each site
    around: Vec<Vec<usize>>,
    /// of each mid-side site
    ends: BTreeMap<usize, [usize; 2]>,
    /// round each inner corner
    fits: Vec<Option<Fit>>,
    /// of each face by itself
    own: Vec<Option<Fit>>,
}

impl Fits<'_> {
    /// Its own or its ends'; else those of the corners of its faces, or of the next faces; else its faces' own.
    fn of(&self, site: usize) -> Vec<&Fit> {
        let fitted = |corners: &[usize]| corners.iter().filter_map(|&c| self.fits[c].as_ref()).collect::<Vec<_>>();
        let mut near = self.ends.get(&site).map_or(vec![site], |ends| ends.to_vec());
        let mut faces: BTreeSet<usize> = self.around[site].iter().copied().collect();
        for _ in 0..3 {
            let fits = fitted(&near);
            if !fits.is_empty() {
                return fits;
            }
            let corners: BTreeSet<usize> = faces.iter().flat_map(|&f| corners(&self.faces[f])).copied().collect();
            faces = corners.iter().flat_map(|&c| self.around[c].iter().copied()).collect();
            near = corners.into_iter().collect();
        }
        self.around[site].iter().filter_map(|&f| self.own[f].as_ref()).collect()
    }
}

fn corners(face: &Patchwork) -> &[usize] {
    &face.sites[..face.shape.corner_count()]
}

/// Of the shape functions, as far as they are complete.
fn degree(face: &Patchwork) -> usize {
    if face.sites.len() > face.shape.corner_count() { 2 } else { 1 }
}

/// Corners with faces all round: none of their sides has a face on one side only.
fn inner_corners(faces: &[Patchwork]) -> BTreeSet<usize> {
    let mut sides: BTreeMap<[usize; 2], usize> = BTreeMap::new();
    for face in faces {
        for side in face.shape.sides() {
            let (a, b) = (face.sites[side[0]], face.sites[side[1]]);
            *sides.entry([a.min(b), a.max(b)]).or_default() += 1;
        }
    }
    let border: BTreeSet<usize> = sides.iter().filter(|&(_, &count)| count == 1).flat_map(|(&ends, _)| ends).collect();
    faces.iter().flat_map(corners).copied().filter(|corner| !border.contains(corner)).collect()
}

fn ends_of_midsides(faces: &[Patchwork]) -> BTreeMap<usize, [usize; 2]> {
    let with_middle = |face: &Patchwork| face.shape.sides().into_iter().filter(|side| side.len() == 3);
    let ends = |face: &Patchwork| {
        with_middle(face)
            .map(|side| (face.sites[side[2]], [face.sites[side[0]], face.sites[side[1]]]))
            .collect::<Vec<_>>()
    };
    faces.iter().flat_map(ends).collect()
}

/// An element's best points alone: constant in T3 and Q4, linear in T6 and Q8.
fn own_fit(face: &Patchwork, best: &[[f64; 2]]) -> Option<Fit> {
    Fit::new(best[face.best[0]], face.best.clone(), best, degree(face) - 1)
}

fn mean_at(place: [f64; 2], fits: Vec<&Fit>) -> Weights {
    let share = 1. / fits.len() as f64;
    let mut sum: BTreeMap<usize, f64> = BTreeMap::new();
    for (sample, weight) in fits.iter().flat_map(|fit| fit.at(place)) {
        *sum.entry(sample).or_default() += share * weight;
    }
    sum.into_iter().collect()
}

/// Least squares of a polynomial over samples, A = Q R with a row P(x_i) for each sample.
struct Fit {
    centre: [f64; 2],
    /// largest distance of a sample from the centre, along x or y [m]
    scale: f64,
    degree: usize,
    samples: Vec<usize>,
    q: DMatrix<f64>,
    r: DMatrix<f64>,
}

impl Fit {
    /// None where the samples do not tell the terms apart.
    fn new(centre: [f64; 2], samples: Vec<usize>, best: &[[f64; 2]], degree: usize) -> Option<Fit> {
        let from_centre = |&i: &usize| [best[i][0] - centre[0], best[i][1] - centre[1]];
        let scale = samples.iter().flat_map(from_centre).fold(f64::MIN_POSITIVE, |max, x| max.max(x.abs()));
        let rows: Vec<Vec<f64>> = samples.iter().map(|i| terms(from_centre(i).map(|x| x / scale), degree)).collect();
        let count = rows.first()?.len();
        if rows.len() < count {
            return None;
        }
        let (q, r) = DMatrix::from_fn(rows.len(), count, |i, k| rows[i][k]).qr().unpack();
        let diagonal = r.diagonal().abs();
        // 1e-6: a patch a thousand times as long as high is still fitted with squares.
        (diagonal.min() > 1e-6 * diagonal.max()).then_some(Fit { centre, scale, degree, samples, q, r })
    }

    /// sigma(x) = P(x) R^-1 Q' sigma: the weights of the samples at a place.
    fn at(&self, place: [f64; 2]) -> Weights {
        let p = terms([0, 1].map(|k| (place[k] - self.centre[k]) / self.scale), self.degree);
        let y = self.r.tr_solve_upper_triangular(&DVector::from_vec(p)).expect("no diagonal of R is zero");
        self.samples.iter().copied().zip((&self.q * y).iter().copied()).collect()
    }
}

fn terms([x, y]: [f64; 2], degree: usize) -> Vec<f64> {
    [1., x, y, x * x, x * y, y * y][..(degree + 1) * (degree + 2) / 2].to_vec()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::physics::element;
    use crate::results::stress::best_points;

    /// n by n squares or pairs of triangles, every node moved, mid-sides off the straight line.
    fn distorted(shape: Shape, n: usize) -> (Vec<Patchwork>, Vec<[f64; 2]>, Vec<[f64; 2]>) {
        let (mut points, mut best, mut faces) = (vec![], vec![], vec![]);
        let across = 2 * n + 1;
        for (i, j) in (0..across * across).map(|k| ((k % across) as f64 / 2., (k / across) as f64 / 2.)) {
            points.push([i + 0.11 * (5. * i + 3. * j).sin(), j + 0.11 * (2. * i + 7. * j).cos()]);
        }
        for (i, j) in (0..n * n).map(|k| (2 * (k % n), 2 * (k / n))) {
            let quad = [[i, j], [i + 2, j], [i + 2, j + 2], [i, j + 2]];
            let parts: &[&[usize]] =
                if shape.corner_count() == 4 { &[&[0, 1, 2, 3]] } else { &[&[0, 1, 2], &[0, 2, 3]] };
            for part in parts {
                let corners: Vec<[usize; 2]> = part.iter().map(|&k| quad[k]).collect();
                let middles = (0..corners.len()).map(|k| {
                    let (a, b) = (corners[k], corners[(k + 1) % corners.len()]);
                    [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2]
                });
                let places = corners.iter().copied().chain(middles).take(shape.node_count());
                let sites: Vec<usize> = places.map(|[i, j]| j * across + i).collect();
                let nodes: Vec<[f64; 2]> = sites.iter().map(|&s| points[s]).collect();
                let own = best_points(shape).into_iter().map(|at| element::point(shape, &nodes, at, 1.).at);
                let first = best.len();
                best.extend(own);
                faces.push(Patchwork { shape, sites, best: (first..best.len()).collect() });
            }
        }
        (faces, points, best)
    }

    const SHAPES: [Shape; 4] = [Shape::Tri3, Shape::Quad4, Shape::Tri6, Shape::Quad8];

    fn worst(shape: Shape, n: usize, sigma: fn([f64; 2]) -> [f64; 4]) -> f64 {
        let (faces, points, best) = distorted(shape, n);
        let samples: Vec<[f64; 4]> = best.iter().map(|&at| sigma(at)).collect();
        let nodal = Nodal::new(&faces, &points, &best).at_sites(&samples);
        let used: BTreeSet<usize> = faces.iter().flat_map(|f| f.sites.iter().copied()).collect();
        let off = |&s: &usize| (0..4).map(|k| (nodal[s][k] - sigma(points[s])[k]).abs()).fold(0., f64::max);
        used.iter().map(off).fold(0., f64::max)
    }

    /// Values up to 50 and weights below 10: round-off is far below 1e-10.
    #[test]
    fn a_linear_stress_is_recovered_exactly_on_distorted_meshes_a_quadratic_one_with_mid_sides() {
        for shape in SHAPES {
            assert!(worst(shape, 4, |[x, y]| [1. + 2. * x - y, y, 3. * x, x + y]) < 1e-10, "{shape:?}");
            if shape.node_count() > 4 {
                assert!(worst(shape, 4, |[x, y]| [x * x - y, x * y, 2. * y * y, 1. - x * y]) < 1e-10, "{shape:?}");
            }
        }
    }

    /// Without inner nodes the elements' own points are left: constant, with mid-sides linear.
    #[test]
    fn one_element_alone_gives_what_its_points_tell() {
        for shape in SHAPES {
            assert!(worst(shape, 1, |_| [1., -2., 3., 4.]) < 1e-12, "{shape:?}");
            if shape.node_count() > 4 {
                assert!(worst(shape, 1, |[x, y]| [x, y, x - y, 1. + x]) < 1e-12, "{shape:?}");
            }
        }
    }
}
