//! The sections of MSH 4.1 and 4.0; ASCII and binary have the same numbers in the same order.

use super::elements::element_type;
use super::tokens::Tokens;
use super::{Block, Node, parametric};
use crate::Result;
use std::collections::HashMap;

/// The two differ in the order of the numbers, 4.0 has no ranges of tags and writes tags as `int`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Layout {
    V41,
    V40,
}

impl Layout {
    fn tag(self, tokens: &mut Tokens) -> Result<usize> {
        match self {
            Layout::V41 => tokens.size(),
            Layout::V40 => tokens.unsigned(Tokens::int),
        }
    }

    /// `blocks things min max`; without min and max in 4.0.
    fn counts(self, tokens: &mut Tokens) -> Result<[usize; 2]> {
        let counts = [tokens.size()?, tokens.size()?];
        if self == Layout::V41 {
            let (_min, _max) = (tokens.size()?, tokens.size()?);
        }
        Ok(counts)
    }

    /// `dimension entity`; the other way round in 4.0.
    fn entity(self, tokens: &mut Tokens) -> Result<EntityKey> {
        let [first, second] = [tokens.int()?, tokens.int()?];
        let (dimension, tag) = if self == Layout::V41 { (first, second) } else { (second, first) };
        match usize::try_from(dimension) {
            Ok(dimension @ 0..=3) => Ok((dimension, tag)),
            _ => Err(tokens.error(format!("expected the dimension of an entity, 0 to 3, found {dimension}"))),
        }
    }

    /// Bytes of a tag in binary.
    fn tag_bytes(self) -> usize {
        if self == Layout::V41 { 8 } else { 4 }
    }
}

/// Dimension and tag of an entity.
pub(super) type EntityKey = (usize, i64);

/// The physical tags of each entity; negative: the entity's direction is reversed in the group.
pub(super) type Entities = HashMap<EntityKey, Vec<i64>>;

/// `points curves surfaces volumes`, then each: `tag box n physical... [n boundary...]`. A point has 3 coordinates in
/// 4.1, all else a box of 6.
pub(super) fn entities(tokens: &mut Tokens, layout: Layout) -> Result<Entities> {
    let counts = [tokens.size()?, tokens.size()?, tokens.size()?, tokens.size()?];
    let mut entities = Entities::new();
    for (dimension, &count) in counts.iter().enumerate() {
        let coordinates = if dimension == 0 && layout == Layout::V41 { 3 } else { 6 };
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

/// The counts, then each block: `dimension entity parametric n`, and in 4.1 all `tag...`, then all `x y z...`; in 4.0
/// n times `tag x y z`.
pub(super) fn nodes(tokens: &mut Tokens, layout: Layout) -> Result<Vec<Node>> {
    let [blocks, total] = layout.counts(tokens)?;
    let bytes = layout.tag_bytes() + 24;
    tokens.checked_count(total, 4, bytes, "nodes")?;
    let mut nodes = Vec::with_capacity(total);
    for _ in 0..blocks {
        layout.entity(tokens)?;
        if tokens.int()? != 0 {
            return Err(parametric(tokens));
        }
        let size = tokens.size()?;
        let count = tokens.checked_count(size, 4, bytes, "nodes of a block")?;
        let start = nodes.len();
        for _ in 0..count {
            let tag = layout.tag(tokens)?;
            nodes.push(Node { tag, xyz: if layout == Layout::V40 { tokens.xyz()? } else { [0.; 3] } });
        }
        if layout == Layout::V41 {
            for node in &mut nodes[start..] {
                node.xyz = tokens.xyz()?;
            }
        }
    }
    match nodes.len() == total {
        true => Ok(nodes),
        false => Err(tokens.error(format!("{total} nodes are announced, but the blocks hold {}", nodes.len()))),
    }
}

/// Elements of one type on one entity, whose groups are known once `$Entities` is read.
pub(super) struct EntityBlock {
    pub(super) entity: EntityKey,
    /// without groups
    pub(super) block: Block,
}

/// The counts, then each block: `dimension entity type n`, and n times `tag node...`.
pub(super) fn elements(tokens: &mut Tokens, layout: Layout) -> Result<Vec<EntityBlock>> {
    let [blocks, total] = layout.counts(tokens)?;
    let mut read = Vec::new();
    for _ in 0..blocks {
        read.push(block(tokens, layout)?);
    }
    let count: usize = read.iter().map(|b| b.block.element_tags.len()).sum();
    match count == total {
        true => Ok(read),
        false => Err(tokens.error(format!("{total} elements are announced, but the blocks hold {count}"))),
    }
}

fn block(tokens: &mut Tokens, layout: Layout) -> Result<EntityBlock> {
    let entity = layout.entity(tokens)?;
    let number = tokens.int()?;
    let kind = element_type(number).ok_or_else(|| tokens.error(format!("element type {number} is unknown")))?;
    let size = tokens.size()?;
    let bytes = layout.tag_bytes() * (1 + kind.nodes);
    let count = tokens.checked_count(size, 1 + kind.nodes, bytes, "elements of a block")?;
    let mut element_tags = Vec::with_capacity(count);
    let mut node_tags = Vec::with_capacity(count * kind.nodes);
    for _ in 0..count {
        element_tags.push(layout.tag(tokens)?);
        for _ in 0..kind.nodes {
            node_tags.push(layout.tag(tokens)?);
        }
    }
    Ok(EntityBlock { entity, block: Block { kind, physicals: vec![], element_tags, node_tags } })
}

/// The blocks with the groups of their entities; in none if the file has no `$Entities`.
pub(super) fn grouped(blocks: Vec<EntityBlock>, entities: Option<&Entities>, tokens: &Tokens) -> Result<Vec<Block>> {
    let of_entity = |EntityBlock { entity, block }: EntityBlock| {
        match entities.map(|e| e.get(&entity)) {
        None => Ok(block),
        Some(Some(physicals)) => Ok(Block { physicals: physicals.clone(), ..block }),
        Some(None) => Err(tokens.of_file(format!(
            "entity {} of dimension {} is not among the $Entities, and the element {} lies on it; the file is corrupt, make the \
             mesh again",
            entity.1,
            entity.0,
            block.element_tags.first().copied().unwrap_or_default()
        ))),
    }
    };
    blocks.into_iter().map(of_entity).collect()
}
