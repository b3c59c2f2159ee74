//! Finds all boxes that meet a given box, in time logarithmic in their number, however unequal their sizes.

/// Sides parallel to the axes: from [x, y] to [x, y].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    pub low: [f64; 2],
    pub high: [f64; 2],
}

impl Bounds {
    pub fn of(points: impl IntoIterator<Item = [f64; 2]>) -> Bounds {
        let empty = Bounds { low: [f64::INFINITY; 2], high: [f64::NEG_INFINITY; 2] };
        points.into_iter().fold(empty, |b, p| b.with(Bounds { low: p, high: p }))
    }

    fn with(self, other: Bounds) -> Bounds {
        Bounds {
            low: [0, 1].map(|i| self.low[i].min(other.low[i])),
            high: [0, 1].map(|i| self.high[i].max(other.high[i])),
        }
    }

    pub fn widened(self, by: f64) -> Bounds {
        Bounds { low: self.low.map(|x| x - by), high: self.high.map(|x| x + by) }
    }

    fn meets(&self, other: &Bounds) -> bool {
        (0..2).all(|i| self.low[i] <= other.high[i] && other.low[i] <= self.high[i])
    }

    /// The longer side [m].
    pub fn extent(&self) -> f64 {
        (0..2).map(|i| self.high[i] - self.low[i]).fold(0., f64::max)
    }
}

/// A binary tree of boxes, each half of a node's boxes on one side of their median along the longer axis.
pub struct Tree {
    boxes: Vec<Bounds>,
    /// indices of `boxes`, in the order of the leaves
    order: Vec<usize>,
    /// bounds of the whole, then of its halves: node k has the children 2k + 1 and 2k + 2
    nodes: Vec<Bounds>,
}

/// Boxes of a leaf.
const LEAF: usize = 4;

impl Tree {
    pub fn new(boxes: Vec<Bounds>) -> Tree {
        let mut order: Vec<usize> = (0..boxes.len()).collect();
        let mut nodes = Vec::new();
        build(&boxes, &mut order, 0, &mut nodes);
        Tree { boxes, order, nodes }
    }

    /// Calls `found` with the number of every box that meets `bounds`, borders included.
    pub fn meeting(&self, bounds: &Bounds, mut found: impl FnMut(usize)) {
        let mut open = vec![(0, 0, self.order.len())];
        while let Some((node, first, end)) = open.pop() {
            if first == end || !self.nodes[node].meets(bounds) {
                continue;
            }
            if end - first <= LEAF {
                self.order[first..end].iter().filter(|&&i| self.boxes[i].meets(bounds)).for_each(|&i| found(i));
            } else {
                let middle = first.midpoint(end);
                open.extend([(2 * node + 1, first, middle), (2 * node + 2, middle, end)]);
            }
        }
    }
}

fn build(boxes: &[Bounds], order: &mut [usize], node: usize, nodes: &mut Vec<Bounds>) {
    let all = order.iter().map(|&i| boxes[i]).reduce(Bounds::with).unwrap_or(Bounds::of([]));
    if nodes.len() <= node {
        nodes.resize(node + 1, Bounds::of([]));
    }
    nodes[node] = all;
    if order.len() > LEAF {
        let axis = usize::from(all.high[1] - all.low[1] > all.high[0] - all.low[0]);
        let middle = order.len() / 2;
        let along = |i: &usize| boxes[*i].low[axis] + boxes[*i].high[axis];
        order.select_nth_unstable_by(middle, |a, b| along(a).total_cmp(&along(b)));
        let (left, right) = order.split_at_mut(middle);
        build(boxes, left, 2 * node + 1, nodes);
        build(boxes, right, 2 * node + 2, nodes);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_tree_finds_what_a_search_through_all_finds() {
        // A lattice that is finer on one side: boxes of 1 beside boxes of 0.01.
        let boxes: Vec<Bounds> = (0..400)
            .map(|i| {
                let size = if i % 2 == 0 { 1. } else { 0.01 };
                let low = [(i % 20) as f64 * size, (i / 20) as f64 * size];
                Bounds { low, high: low.map(|x| x + size) }
            })
            .collect();
        let tree = Tree::new(boxes.clone());
        for query in boxes.iter().map(|b| b.widened(0.005)).chain([Bounds::of([[-2., -2.]])]) {
            let mut found = vec![];
            tree.meeting(&query, |i| found.push(i));
            found.sort_unstable();
            let all: Vec<usize> = (0..boxes.len()).filter(|&i| boxes[i].meets(&query)).collect();
            assert_eq!(found, all);
        }
        Tree::new(vec![]).meeting(&boxes[0], |_| panic!("an empty tree has no boxes"));
    }
}
