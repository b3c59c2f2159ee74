//! Elimination orders that are known already, by the graphs that they belong to: to read one takes less time than to
//! find it.

use std::sync::Mutex;

use sha2::{Digest, Sha256};

use super::{Graph, elimination_order};
use crate::Result;

/// Known orders, more of them with each graph that is asked for. As bytes they can be kept until another day.
#[derive(Debug, Default)]
pub struct Orders {
    known: Mutex<Known>,
}

#[derive(Debug, Clone, Default)]
struct Known {
    /// the last one that was used stands last
    orders: Vec<Order>,
    /// whether one was found that had not been known
    grown: bool,
}

#[derive(Debug, Clone, PartialEq)]
struct Order {
    graph: Hash,
    /// `old_of[new] = old`
    old_of: Vec<u32>,
}

type Hash = [u8; 32];

/// First bytes of the written form. The number counts up when [`elimination_order`] comes to give other orders.
const HEADER: &[u8] = b"coralpipe orders 1\n";
/// What the first bytes of any number have in common.
const NAME: &[u8] = b"coralpipe orders ";
/// As many are written: of a mesh's cases with open and with bonded interfaces, of its columns, of other supports.
const MOST: usize = 8;

impl Orders {
    /// What [`Orders::to_bytes`] gave; none if it is anything else, or not whole.
    pub fn from_bytes(bytes: &[u8]) -> Option<Orders> {
        let (sum, mut rest) = bytes.strip_prefix(HEADER)?.split_first_chunk::<32>()?;
        if Hash::from(Sha256::digest(rest)) != *sum {
            return None;
        }
        let mut orders = Vec::new();
        while !rest.is_empty() {
            let (graph, behind) = rest.split_first_chunk::<32>()?;
            let (length, behind) = behind.split_first_chunk::<4>()?;
            let (old_of, behind) = behind.split_at_checked(4 * u32::from_le_bytes(*length) as usize)?;
            let old_of = old_of.as_chunks().0.iter().map(|bytes| u32::from_le_bytes(*bytes)).collect();
            orders.push(Order { graph: *graph, old_of });
            rest = behind;
        }
        Some(Orders { known: Known { orders, grown: false }.into() })
    }

    /// Whether bytes begin as those of some orders do, of whatever number; a crash may have left none.
    pub fn are_orders(bytes: &[u8]) -> bool {
        bytes.is_empty() || bytes.starts_with(NAME)
    }

    /// The last ones that were used.
    pub fn to_bytes(&self) -> Vec<u8> {
        let orders = self.known().orders.clone();
        let mut content = Vec::new();
        for order in &orders[orders.len().saturating_sub(MOST)..] {
            content.extend(order.graph);
            content.extend((order.old_of.len() as u32).to_le_bytes());
            content.extend(order.old_of.iter().flat_map(|old| old.to_le_bytes()));
        }
        [HEADER, Sha256::digest(&content).as_slice(), &content].concat()
    }

    /// Whether some were found that had not been known.
    pub fn have_grown(&self) -> bool {
        self.known().grown
    }

    /// [`elimination_order`], found or known.
    ///
    /// # Errors
    /// If the graph is too large for METIS, which counts in 32 bits.
    ///
    /// # Panics
    /// If `last` names a vertex that is not in the graph, or one twice.
    pub fn of(&self, graph: &Graph, last: &[usize]) -> Result<Vec<usize>> {
        let hash = hash(graph, last);
        let mut known = self.known();
        let place = known.orders.iter().position(|o| o.graph == hash && is_order(&o.old_of, graph.len(), last));
        let order = match place {
            Some(place) => known.orders.remove(place),
            None => {
                let order = elimination_order(graph, last)?;
                known.grown = true;
                // METIS has counted the vertices in 32 bits
                Order { graph: hash, old_of: order.into_iter().map(|old| old as u32).collect() }
            }
        };
        let old_of = order.old_of.iter().map(|&old| old as usize).collect();
        known.orders.push(order);
        Ok(old_of)
    }

    fn known(&self) -> std::sync::MutexGuard<'_, Known> {
        self.known.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
    }
}

/// Of the vertices, their neighbours, and those that come last.
fn hash(graph: &Graph, last: &[usize]) -> Hash {
    let mut bytes = Vec::new();
    for list in [&graph.start, &graph.neighbours, last] {
        bytes.extend((list.len() as u64).to_le_bytes());
        bytes.extend(list.iter().flat_map(|&i| (i as u64).to_le_bytes()));
    }
    Sha256::digest(&bytes).into()
}

/// Every vertex once, with `last` at the end.
fn is_order(old_of: &[u32], vertices: usize, last: &[usize]) -> bool {
    let mut seen = vec![false; vertices];
    let once = |&old: &u32| seen.get_mut(old as usize).is_some_and(|seen| !std::mem::replace(seen, true));
    let ends = old_of.iter().rev().zip(last.iter().rev()).all(|(&old, &vertex)| old as usize == vertex);
    old_of.len() == vertices && old_of.iter().all(once) && ends
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sparse::testing::triangles;

    fn grid() -> Graph {
        Graph::from_cliques(31 * 21, triangles(30, 20).iter().map(|e| &e[..]))
    }

    /// As if it had been written.
    fn kept(graph: &Graph, last: &[usize], old_of: Vec<u32>) -> Orders {
        let orders = vec![Order { graph: hash(graph, last), old_of }];
        let bytes = Orders { known: Known { orders, grown: true }.into() }.to_bytes();
        Orders::from_bytes(&bytes).expect("it was written so")
    }

    #[test]
    fn a_kept_order_is_taken_and_is_the_one_that_would_be_found() {
        let (graph, last) = (grid(), [5, 600, 6]);
        let found = elimination_order(&graph, &last).expect("small graphs can be ordered");
        let first = Orders::default();
        assert_eq!(first.of(&graph, &last), Ok(found.clone()));
        assert!(first.have_grown());
        let second = Orders::from_bytes(&first.to_bytes()).expect("it was written so");
        assert_eq!(second.of(&graph, &last), Ok(found.clone()));
        assert!(!second.have_grown());

        // Taken, not found again: another order of the same graph comes back as it was kept.
        let mut other: Vec<u32> = found.iter().map(|&old| old as u32).collect();
        other.swap(0, 1);
        let taken = kept(&graph, &last, other.clone()).of(&graph, &last).expect("small graphs can be ordered");
        assert!(taken.iter().zip(&other).all(|(&taken, &other)| taken == other as usize));
    }

    #[test]
    fn an_order_of_another_graph_or_of_other_last_vertices_is_not_taken() {
        let (graph, last) = (grid(), [5, 600, 6]);
        let mut edges = triangles(30, 20);
        edges.pop();
        let other = Graph::from_cliques(31 * 21, edges.iter().map(|e| &e[..]));
        let orders = Orders::default();
        for (graph, last) in [(&graph, &last[..]), (&other, &last), (&graph, &[5, 6, 600]), (&graph, &[])] {
            assert_eq!(orders.of(graph, last), elimination_order(graph, last));
        }
        assert_eq!(orders.known().orders.len(), 4);
    }

    #[test]
    fn what_is_no_order_of_the_graph_is_found_anew() {
        let (graph, last) = (grid(), [5]);
        let found = elimination_order(&graph, &last).expect("small graphs can be ordered");
        let sound: Vec<u32> = found.iter().map(|&old| old as u32).collect();
        let spoilt = |spoil: &dyn Fn(&mut Vec<u32>)| {
            let mut old_of = sound.clone();
            spoil(&mut old_of);
            old_of
        };
        for old_of in [
            vec![],
            spoilt(&|o| o.truncate(650)),
            spoilt(&|o| o.push(0)),
            spoilt(&|o| o[3] = o[4]),
            spoilt(&|o| o[3] = u32::MAX),
            spoilt(&|o| o.swap(3, 650)),
        ] {
            let orders = kept(&graph, &last, old_of);
            assert_eq!(orders.of(&graph, &last), Ok(found.clone()));
            assert!(orders.have_grown());
        }
    }

    #[test]
    fn bytes_that_are_not_whole_are_no_orders() {
        let orders = Orders::default();
        orders.of(&grid(), &[5]).expect("small graphs can be ordered");
        orders.of(&grid(), &[6]).expect("small graphs can be ordered");
        let bytes = orders.to_bytes();
        for length in (0..bytes.len()).step_by(7) {
            assert!(Orders::from_bytes(&bytes[..length]).is_none(), "{length} bytes");
        }
        for place in (0..bytes.len()).step_by(11) {
            let mut spoilt = bytes.clone();
            spoilt[place] ^= 4;
            assert!(Orders::from_bytes(&spoilt).is_none(), "byte {place}");
        }
        assert!(Orders::from_bytes(&bytes).is_some() && Orders::from_bytes(b"").is_none());
    }

    #[test]
    fn the_orders_that_were_used_last_are_kept() {
        let orders = Orders::default();
        let last = |m: usize| (0..m).collect::<Vec<_>>();
        (0..10).for_each(|m| drop(orders.of(&grid(), &last(m))));
        orders.of(&grid(), &last(1)).expect("small graphs can be ordered");
        let kept = Orders::from_bytes(&orders.to_bytes()).expect("it was written so");
        assert_eq!(kept.known().orders.len(), MOST);
        kept.of(&grid(), &last(1)).expect("small graphs can be ordered");
        assert!(!kept.have_grown());
        kept.of(&grid(), &last(2)).expect("small graphs can be ordered");
        assert!(kept.have_grown());
    }
}
