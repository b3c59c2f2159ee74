//! The sections of MSH 4.1; ASCII and binary have the same numbers in the same order.

use super::elements::element_type;
use super::tokens::Tokens;
use super::{Block, Node, parametric};
use crate::Result;
use std::collections::HashMap;

/// (dimension, tag) of an entity -> its physical tags; negative: the entity's direction is reversed in the group.
pub(super) type Entities = HashMap<(usize, i64), Vec<i64>>;

/// `points curves surfaces volumes`, then each: `tag box(3 or 6) n physical... [n boundary...]`.
pub(super) fn entities(tokens: &mut Tokens) -> Result<Entities> {
    let counts = [tokens.size()?, tokens.size()?, tokens.size()?, tokens.size()?];
    let mut entities = Entities::new();
    for (dimension, &count) in counts.iter().enumerate() {
        let coordinates = if dimension == 0 { 3 } else { 6 };
        tokens.checked_count(count, coordinates + 2, 8 * coordinates + 12, "entities")?;
        for _ in 0..count {
            let tag = tokens.int()?;
            for _ in 0..coordinates {
                tokens.real()?;
            }
            let physicals = tags(tokens, "physical tags")?;
            if dimension > 0 {
                tags(tokens, "boundary tags")?;
            }
            entities.insert((dimension, tag), physicals);
        }
    }
    Ok(entities)
}

/// `n tag...`
fn tags(tokens: &mut Tokens, things: &str) -> Result<Vec<i64>> {
    let count = tokens.size()?;
    tokens.checked_count(count, 1, 4, things)?;
    (0..count).map(|_| tokens.int()).collect()
}

/// `blocks nodes min max`, then each block: `dimension entity parametric n`, `tag...`, `x y z...`.
pub(super) fn nodes(tokens: &mut Tokens) -> Result<Vec<Node>> {
    let (blocks, total) = (tokens.size()?, tokens.size()?);
    let (_min, _max) = (tokens.size()?, tokens.size()?);
    tokens.checked_count(total, 4, 32, "nodes")?;
    let mut nodes = Vec::with_capacity(total);
    for _ in 0..blocks {
        let (_dimension, _entity) = (tokens.int()?, tokens.int()?);
        if tokens.int()? != 0 {
            return Err(parametric(tokens));
        }
        let size = tokens.size()?;
        let count = tokens.checked_count(size, 4, 32, "nodes of a block")?;
        let start = nodes.len();
        for _ in 0..count {
            nodes.push(Node { tag: tokens.size()?, xyz: [0.0; 3] });
        }
        for node in &mut nodes[start..] {
            node.xyz = tokens.xyz()?;
        }
    }
    match nodes.len() == total {
        true => Ok(nodes),
        false => Err(tokens.error(format!("{total} nodes are announced, but the blocks hold {}", nodes.len()))),
    }
}

/// `blocks elements min max`, then each block: `dimension entity type n`, and n times `tag node...`.
pub(super) fn elements(tokens: &mut Tokens, entities: Option<&Entities>) -> Result<Vec<Block>> {
    let (blocks, total) = (tokens.size()?, tokens.size()?);
    let (_min, _max) = (tokens.size()?, tokens.size()?);
    let mut read = Vec::new();
    for _ in 0..blocks {
        read.push(block(tokens, entities)?);
    }
    let count: usize = read.iter().map(|b| b.element_tags.len()).sum();
    match count == total {
        true => Ok(read),
        false => Err(tokens.error(format!("{total} elements are announced, but the blocks hold {count}"))),
    }
}

fn block(tokens: &mut Tokens, entities: Option<&Entities>) -> Result<Block> {
    let (dimension, entity) = (tokens.unsigned(Tokens::int)?, tokens.int()?);
    let number = tokens.int()?;
    let kind = element_type(number).ok_or_else(|| tokens.error(format!("element type {number} is unknown")))?;
    let physicals = match entities.map(|e| e.get(&(dimension, entity))) {
        None => Vec::new(),
        Some(Some(physicals)) => physicals.clone(),
        Some(None) => {
            return Err(tokens.error(format!("entity {entity} of dimension {dimension} is not among the $Entities")));
        }
    };
    let size = tokens.size()?;
    let count = tokens.checked_count(size, 1 + kind.nodes, 8 * (1 + kind.nodes), "elements of a block")?;
    let mut element_tags = Vec::with_capacity(count);
    let mut node_tags = Vec::with_capacity(count * kind.nodes);
    for _ in 0..count {
        element_tags.push(tokens.size()?);
        for _ in 0..kind.nodes {
            node_tags.push(tokens.size()?);
        }
    }
    Ok(Block { kind, physicals, element_tags, node_tags })
}
