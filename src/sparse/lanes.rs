//! Several vectors side by side, so that one reading of a matrix serves all of them.

use std::sync::Arc;

/// Several vectors at once: row i holds the entries of unknown i.
pub type Lanes<const K: usize> = [[f64; K]];

/// Calls a function of the number of lanes that is known when compiling, enough for `count` vectors.
///
/// # Panics
/// If there are more than [`MOST_LANES`].
macro_rules! with_lanes_for {
    ($count:expr, $f:ident($($argument:expr),*)) => {
        match $count {
            1 => $f::<1>($($argument),*),
            2 => $f::<2>($($argument),*),
            3 | 4 => $f::<4>($($argument),*),
            count => {
                assert!(count <= $crate::sparse::MOST_LANES, "{count} vectors are too many for one call");
                $f::<{ $crate::sparse::MOST_LANES }>($($argument),*)
            }
        }
    };
}
pub(crate) use with_lanes_for;

/// Cases whose numbers fill the widest vector register.
pub const MOST_LANES: usize = 8;

/// Rows that are turned at once: they stay in the nearest cache while one vector after the other is.
pub(crate) const TILE: usize = 64;

/// One of several vectors that stay side by side.
#[derive(Debug, Clone)]
pub struct Lane {
    /// row after row
    all: Arc<Vec<f64>>,
    /// vectors side by side
    width: usize,
    number: usize,
}

impl Lane {
    /// The first `count` lanes.
    pub fn each<const K: usize>(x: Vec<[f64; K]>, count: usize) -> Vec<Lane> {
        let all = Arc::new(x.into_flattened());
        (0..count).map(|number| Lane { all: all.clone(), width: K, number }).collect()
    }

    /// A vector by itself.
    pub fn alone(x: Vec<f64>) -> Lane {
        Lane { all: x.into(), width: 1, number: 0 }
    }

    fn len(&self) -> usize {
        self.all.len() / self.width
    }

    fn iter(&self) -> impl Iterator<Item = f64> {
        self.all.chunks(self.width).map(|row| row[self.number])
    }

    fn is_with(&self, other: &Lane) -> bool {
        Arc::ptr_eq(&self.all, &other.all)
    }
}

/// Whoever stands beside them.
impl PartialEq for Lane {
    fn eq(&self, other: &Lane) -> bool {
        self.iter().eq(other.iter())
    }
}

/// Up to K vectors side by side, the other lanes of no meaning and perhaps not finite.
///
/// # Panics
/// If there are more, or one has another length than the first.
pub fn side_by_side<const K: usize>(vectors: &[&Lane]) -> Vec<[f64; K]> {
    assert!(vectors.len() <= K, "a lane for each vector");
    let Some(first) = vectors.first() else { return vec![] };
    assert!(vectors.iter().all(|lane| lane.len() == first.len()), "vectors of one length");
    let in_place = |(k, lane): (usize, &&Lane)| lane.is_with(first) && lane.width == K && lane.number == k;
    if vectors.iter().enumerate().all(in_place) {
        return first.all.as_chunks().0.to_vec();
    }
    let mut x = vec![[0.; K]; first.len()];
    for (number, tile) in x.chunks_mut(TILE).enumerate() {
        for (k, lane) in vectors.iter().enumerate() {
            let own = lane.all[TILE * number * lane.width..].chunks(lane.width);
            tile.iter_mut().zip(own).for_each(|(x, row)| x[k] = row[lane.number]);
        }
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;

    /// More rows than a tile; the place of lanes in others' company says nothing about their own.
    #[test]
    fn lanes_come_together_from_wherever_they_are() {
        let row = |i: usize| std::array::from_fn::<f64, 4, _>(|k| (10 * i + k) as f64);
        let x: Vec<[f64; 4]> = (0..TILE + 3).map(row).collect();
        let lanes = Lane::each(x.clone(), 3);
        let alone = Lane::alone((0..TILE + 3).map(|i| -(i as f64)).collect());
        let [a, b, c] = [0, 1, 2].map(|k| &lanes[k]);
        assert_eq!(side_by_side::<4>(&[a, b, c]), x);
        assert!(*b == Lane::alone(x.iter().map(|row| row[1]).collect()) && b != c);
        let mixed = side_by_side::<4>(&[c, &alone, a]);
        assert!((0..TILE + 3).all(|i| mixed[i] == [x[i][2], -(i as f64), x[i][0], 0.]));
        // at their place, but of another company
        let others = Lane::each(x.iter().map(|row| row.map(|x| -x)).collect::<Vec<[f64; 4]>>(), 4);
        let met = side_by_side::<4>(&[a, &others[1], c]);
        assert!((0..TILE + 3).all(|i| met[i][..3] == [x[i][0], -x[i][1], x[i][2]]));
        let narrow = side_by_side::<2>(&[a, b]);
        assert!((0..TILE + 3).all(|i| narrow[i] == [x[i][0], x[i][1]]));
        assert_eq!(side_by_side::<1>(&[&alone]).into_flattened(), *alone.all);
    }
}
