//! What a Gmsh mesh file says, before anything is made of it: MSH 4.1, 4.0 and 2.0 to 2.2, ASCII and binary.
//! Format: Gmsh reference manual, "Gmsh file formats" and "Legacy formats".

mod elements;
mod foreign;
mod format;
mod markers;
mod names;
mod tokens;
mod v2;
mod v4;

use crate::escape::one_line;
use crate::input::{self, Kind};
use crate::{Error, Result};
use format::{Version, mesh_format};
use names::{Named, physical_names};
use std::path::Path;
use tokens::Tokens;

pub use elements::{ElementType, element_type};

/// The content of a mesh file.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Msh {
    pub nodes: Vec<Node>,
    pub blocks: Vec<Block>,
    pub names: Vec<PhysicalName>,
    /// MSH 4 without the section `$Entities`: nothing says which group an element belongs to
    pub without_entities: bool,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Node {
    pub tag: usize,
    /// in the unit of the file, or after [`Msh::scaled`] in metres; finite
    pub xyz: [f64; 3],
}

/// Elements of one type on one entity: a point, curve, surface or volume of the geometry.
#[derive(Debug, Clone, PartialEq)]
pub struct Block {
    pub kind: ElementType,
    /// tags of the physical groups the elements belong to; negative: with the opposite direction
    pub physicals: Vec<i64>,
    pub element_tags: Vec<usize>,
    /// node tags, `kind.nodes` for each element
    pub node_tags: Vec<usize>,
}

/// A line of `$PhysicalNames`. Bytes of the name that are not UTF-8 stand in it as `%E4`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PhysicalName {
    /// 0 point, 1 curve, 2 surface, 3 volume
    pub dimension: usize,
    pub tag: i64,
    pub name: String,
}

impl Msh {
    /// With all coordinates times a factor: those of another unit in metres.
    pub fn scaled(mut self, factor: f64) -> Msh {
        self.nodes.iter_mut().for_each(|node| node.xyz = node.xyz.map(|x| factor * x));
        self
    }

    pub fn element_count(&self) -> usize {
        self.blocks.iter().map(|b| b.element_tags.len()).sum()
    }
}

impl Block {
    /// Element tag and node tags of each element.
    pub fn elements(&self) -> impl Iterator<Item = (usize, &[usize])> {
        self.element_tags.iter().copied().zip(self.node_tags.chunks_exact(self.kind.nodes))
    }
}

/// Reads a mesh file.
///
/// Errors: the file cannot be read, is no MSH 2 or 4, is cut off or corrupt, is partitioned, or has parametric nodes.
pub fn read(path: &Path) -> Result<Msh> {
    let bytes = input::read(path, Kind::Mesh).map_err(|e| not_read(path, &e))?;
    parse(&bytes, &file_name(path))
}

pub fn not_read(path: &Path, why: &std::io::Error) -> Error {
    Error::input(format!("the mesh {} cannot be read: {why}", path.display()))
}

/// `meshes/twin_pipes.msh` -> `twin_pipes.msh`, as messages call the file.
pub fn file_name(path: &Path) -> String {
    one_line(&path.file_name().unwrap_or(path.as_os_str()).to_string_lossy()).into_owned()
}

/// The content of a mesh file whose bytes are `bytes` and whose name in messages is `file`.
///
/// Sections may stand in any order. Those that are not needed decide nothing, whatever is in them and however they end.
pub fn parse(bytes: &[u8], file: &str) -> Result<Msh> {
    let mut tokens = Tokens::new(bytes, file);
    let version = mesh_format(&mut tokens, bytes)?;
    let mut msh = Msh::default();
    let mut names = Vec::new();
    let (mut entities, mut blocks) = (None, Vec::new());
    let mut seen: Vec<String> = Vec::new();
    while let Some(name) = tokens.next_section() {
        tokens.section.clone_from(&name);
        let needed = is_needed(&name, version);
        if needed && seen.contains(&name) {
            return Err(tokens.error("the section stands twice in the file"));
        }
        match (name.as_str(), version) {
            ("PhysicalNames", _) => names = physical_names(&mut tokens)?,
            ("Nodes", Version::V4(layout)) => msh.nodes = v4::nodes(&mut tokens, layout)?,
            ("Nodes", Version::V2(_)) => msh.nodes = v2::nodes(&mut tokens)?,
            ("Entities", Version::V4(layout)) => entities = Some(v4::entities(&mut tokens, layout)?),
            ("Elements", Version::V4(layout)) => blocks = v4::elements(&mut tokens, layout)?,
            ("Elements", Version::V2(layout)) => msh.blocks = v2::elements(&mut tokens, layout)?,
            ("PartitionedEntities", _) => return Err(partitioned(&tokens)),
            ("ParametricNodes", _) => return Err(parametric(&tokens)),
            _ => tokens.skip_section(),
        }
        if needed {
            tokens.section_end()?;
            seen.push(name);
        }
    }
    tokens.section.clear();
    let has = |name: &str| seen.iter().any(|s| s == name);
    if has("Nodes") != has("Elements") {
        return Err(tokens.error("$Nodes and $Elements must both be there; the file was cut off, make the mesh again"));
    }
    if let Version::V4(_) = version {
        msh.blocks = v4::grouped(blocks, entities.as_ref(), &tokens)?;
        msh.without_entities = entities.is_none();
    }
    msh.names = names.into_iter().flat_map(|named: Named| named.of_dimensions(&msh.blocks)).collect();
    Ok(msh)
}

fn is_needed(section: &str, version: Version) -> bool {
    match section {
        "Nodes" | "Elements" | "PhysicalNames" => true,
        "Entities" => matches!(version, Version::V4(_)),
        _ => false,
    }
}

fn partitioned(tokens: &Tokens) -> Error {
    tokens.error("the mesh is partitioned; save it whole, without -part and without PartitionMesh")
}

fn parametric(tokens: &Tokens) -> Error {
    tokens.error("the nodes carry parametric coordinates; save the mesh with Mesh.SaveParametric = 0")
}
