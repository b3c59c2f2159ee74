//! Several vectors side by side, so that one reading of a matrix serves all of them.

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

/// The first `of` lanes, each by itself.
pub fn apart<const K: usize>(x: &Lanes<K>, of: usize) -> Vec<Vec<f64>> {
    let mut vectors: Vec<Vec<f64>> = (0..of).map(|_| Vec::with_capacity(x.len())).collect();
    for tile in x.chunks(TILE) {
        for (k, vector) in vectors.iter_mut().enumerate() {
            vector.extend(tile.iter().map(|x| x[k]));
        }
    }
    vectors
}

/// Up to K vectors side by side, the other lanes zero.
///
/// # Panics
/// If there are more, or one is shorter than the first.
pub fn side_by_side<const K: usize>(vectors: &[&[f64]]) -> Vec<[f64; K]> {
    assert!(vectors.len() <= K, "a lane for each vector");
    let count = vectors.first().map_or(0, |first| first.len());
    let mut x = vec![[0.; K]; count];
    for (number, tile) in x.chunks_mut(TILE).enumerate() {
        for (k, vector) in vectors.iter().enumerate() {
            let own = &vector[TILE * number..][..tile.len()];
            tile.iter_mut().zip(own).for_each(|(x, own)| x[k] = *own);
        }
    }
    x
}
