//! The sections of MSH 2.0 to 2.2: an element in several groups is written once for each of them.

use super::elements::{ElementType, element_type};
use super::tokens::Tokens;
use super::{Block, Node, partitioned};
use crate::Result;

/// What an element's third tag is, if it has one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Layout {
    /// how many partitions follow; without any following, it says nothing
    V22,
    /// a partition: a label that changes neither elements nor nodes
    V20,
}

/// `n`, then n times `tag x y z`.
pub(super) fn nodes(tokens: &mut Tokens) -> Result<Vec<Node>> {
    let announced = count_line(tokens)?;
    let count = tokens.checked_count(announced, 4, 28, "nodes")?;
    let mut nodes = Vec::with_capacity(count);
    for _ in 0..count {
        let tag = tokens.unsigned(Tokens::int)?;
        nodes.push(Node { tag, xyz: tokens.xyz()? });
    }
    Ok(nodes)
}

/// `n`, then in ASCII n times `tag type n_tags tag... node...`;
/// in binary runs of `type n n_tags` followed by n times `tag tag... node...`.
pub(super) fn elements(tokens: &mut Tokens, layout: Layout) -> Result<Vec<Block>> {
    let announced = count_line(tokens)?;
    let count = tokens.checked_count(announced, 4, 8, "elements")?;
    let mut blocks = Vec::new();
    let mut read = 0;
    while read < count {
        let (tag, kind, run, tags);
        if tokens.is_binary() {
            (kind, run, tags) = (type_of(tokens)?, tokens.unsigned(Tokens::int)?, tokens.unsigned(Tokens::int)?);
            tag = None;
        } else {
            (tag, kind, run) = (Some(tokens.size()?), type_of(tokens)?, 1);
            tags = tokens.size()?;
        }
        if run == 0 || run > count - read {
            return Err(tokens.error(format!("{count} elements are announced, but {run} follow the first {read}")));
        }
        for _ in 0..run {
            let tag = tag.map_or_else(|| tokens.unsigned(Tokens::int), Ok)?;
            let physical = physical(tokens, tags, layout)?;
            element(tokens, Element { tag, kind, physical }, &mut blocks)?;
        }
        read += run;
    }
    Ok(blocks)
}

fn type_of(tokens: &mut Tokens) -> Result<ElementType> {
    let number = tokens.int()?;
    element_type(number).ok_or_else(|| tokens.error(format!("element type {number} is unknown")))
}

/// `physical entity [n_partitions partition...]`: the physical group, 0 for none.
fn physical(tokens: &mut Tokens, tags: usize, layout: Layout) -> Result<i64> {
    let mut physical = 0;
    for i in 0..tags {
        match (i, tokens.int()?) {
            (0, value) => physical = value,
            (2, partitions) if partitions != 0 && tags > 3 && layout == Layout::V22 => return Err(partitioned(tokens)),
            _ => {}
        }
    }
    Ok(physical)
}

/// What stands before an element's nodes.
struct Element {
    tag: usize,
    kind: ElementType,
    physical: i64,
}

/// `node...`: adds the element to the last block or begins another.
fn element(tokens: &mut Tokens, Element { tag, kind, physical }: Element, blocks: &mut Vec<Block>) -> Result<()> {
    let physicals: &[i64] = if physical == 0 { &[] } else { &[physical] };
    if !blocks.last().is_some_and(|b| b.kind == kind && b.physicals == physicals) {
        let physicals = physicals.to_vec();
        blocks.push(Block { kind, physicals, element_tags: Vec::new(), node_tags: Vec::new() });
    }
    let block = blocks.last_mut().expect("a block was pushed if there was none that fits");
    block.element_tags.push(tag);
    for _ in 0..kind.nodes {
        block.node_tags.push(tokens.unsigned(Tokens::int)?);
    }
    Ok(())
}

/// The count alone on its line, ASCII in binary files, too.
fn count_line(tokens: &mut Tokens) -> Result<usize> {
    let count = tokens.unsigned(Tokens::ascii_integer)?;
    tokens.end_line()?;
    Ok(count)
}
