//! The area that two sets of faces both cover.

use super::segment::cross;
use super::tree::{Bounds, Tree};
use crate::model::mesh::Mesh;

/// The faces of a mesh as polygons.
pub struct Faces<'a> {
    mesh: &'a Mesh,
    /// indices into `Mesh::cells`
    cells: Vec<usize>,
    tree: Tree,
}

/// An area and its centre of mass.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Area {
    /// [m^2]
    pub size: f64,
    /// integrals of x and y over it [m^3]
    moment: [f64; 2],
}

impl Area {
    fn with(self, other: Area) -> Area {
        Area { size: self.size + other.size, moment: [0, 1].map(|i| self.moment[i] + other.moment[i]) }
    }

    pub fn centre(&self) -> [f64; 2] {
        self.moment.map(|moment| moment / self.size)
    }

    /// Of a polygon that runs anticlockwise: triangles from its first corner.
    fn of(polygon: &[[f64; 2]]) -> Area {
        let Some((&first, rest)) = polygon.split_first() else { return Area::default() };
        let triangle = |ends: &[[f64; 2]]| {
            let size = cross(first, ends[0], ends[1]) / 2.;
            Area { size, moment: [0, 1].map(|i| size * (first[i] + ends[0][i] + ends[1][i]) / 3.) }
        };
        rest.windows(2).map(triangle).fold(Area::default(), Area::with)
    }
}

impl Faces<'_> {
    pub fn of(mesh: &Mesh) -> Faces<'_> {
        let cells: Vec<usize> = (0..mesh.cells.len()).filter(|&c| mesh.cells[c].shape.dimension() == 2).collect();
        let bounds = |&cell: &usize| Bounds::of(outline(mesh, cell));
        let tree = Tree::new(cells.iter().map(bounds).collect());
        Faces { mesh, cells, tree }
    }

    /// A face that covers a point, other than `not`.
    pub fn around(&self, point: [f64; 2], not: usize) -> Option<usize> {
        let mut found = None;
        self.tree.meeting(&Bounds::of([point]), |number| {
            let cell = self.cells[number];
            let covers =
                |part: &Vec<[f64; 2]>| (0..part.len()).all(|i| cross(part[i], part[(i + 1) % part.len()], point) > 0.);
            if cell != not && convex_parts(self.mesh, cell).iter().any(covers) {
                found = Some(cell);
            }
        });
        found
    }

    /// What faces of one set and faces of the other both cover; each pair counts once, also where the sets are one.
    pub fn covered_by_both(&self, in_one: impl Fn(usize) -> bool, in_other: impl Fn(usize) -> bool) -> Area {
        let mut both = Area::default();
        for &one in self.cells.iter().filter(|&&cell| in_one(cell)) {
            self.tree.meeting(&Bounds::of(outline(self.mesh, one)), |number| {
                let other = self.cells[number];
                let seen = in_one(other) && in_other(one) && other < one;
                if in_other(other) && other != one && !seen {
                    both = both.with(self.common(one, other));
                }
            });
        }
        both
    }

    fn common(&self, one: usize, other: usize) -> Area {
        let [of_one, of_other] = [one, other].map(|cell| convex_parts(self.mesh, cell));
        let pairs = of_one.iter().flat_map(|a| of_other.iter().map(move |b| Area::of(&clipped(a, b))));
        pairs.fold(Area::default(), Area::with)
    }
}

/// Corners and mid-side nodes of a face, anticlockwise.
fn outline(mesh: &Mesh, cell: usize) -> Vec<[f64; 2]> {
    let cell = &mesh.cells[cell];
    cell.shape
        .sides()
        .iter()
        .flat_map(|side| [Some(side[0]), side.get(2).copied()])
        .flatten()
        .map(|local| mesh.points[cell.nodes[local]])
        .collect()
}

/// A face of straight sides as it is; one of curved sides in triangles from its centre.
fn convex_parts(mesh: &Mesh, cell: usize) -> Vec<Vec<[f64; 2]>> {
    let (outline, face) = (outline(mesh, cell), &mesh.cells[cell]);
    if outline.len() == face.shape.corner_count() {
        return vec![outline];
    }
    let centre = mesh.centroid(face);
    (0..outline.len()).map(|i| vec![centre, outline[i], outline[(i + 1) % outline.len()]]).collect()
}

/// The part of a polygon inside a convex one, both anticlockwise: cut by one side after the other (Sutherland and
/// Hodgman 1974).
fn clipped(polygon: &[[f64; 2]], window: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let mut kept = polygon.to_vec();
    for i in 0..window.len() {
        let (a, b) = (window[i], window[(i + 1) % window.len()]);
        let whole = std::mem::take(&mut kept);
        for j in 0..whole.len() {
            let (p, q) = (whole[j], whole[(j + 1) % whole.len()]);
            let [inside_p, inside_q] = [p, q].map(|x| cross(a, b, x));
            if inside_p >= 0. {
                kept.push(p);
            }
            if inside_p * inside_q < 0. {
                let s = inside_p / (inside_p - inside_q);
                kept.push([0, 1].map(|k| p[k] + s * (q[k] - p[k])));
            }
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_squares_share_the_square_where_they_overlap() {
        let square = |x: f64, y: f64| [[x, y], [x + 2., y], [x + 2., y + 2.], [x, y + 2.]];
        let both = Area::of(&clipped(&square(0., 0.), &square(1., 0.5)));
        assert!((both.size - 1.5).abs() < 1e-14, "{both:?}");
        assert!((0..2).all(|i| (both.centre()[i] - [1.5, 1.25][i]).abs() < 1e-14), "{both:?}");
        assert_eq!(Area::of(&clipped(&square(0., 0.), &square(3., 0.))).size, 0.);
    }
}
