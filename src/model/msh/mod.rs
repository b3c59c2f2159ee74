//! What a Gmsh mesh file says, before anything is made of it: MSH 4.1 and 2.2, ASCII and binary.
//! Format: Gmsh reference manual, "Gmsh file formats".

mod elements;
mod tokens;
mod v2;
mod v4;

use crate::input::{self, Kind};
use crate::{Error, Result};
use std::path::Path;
use tokens::{Encoding, Tokens};

pub use elements::{ElementType, element_type};

/// The content of a mesh file.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Msh {
    pub nodes: Vec<Node>,
    pub blocks: Vec<Block>,
    pub names: Vec<PhysicalName>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Node {
    pub tag: usize,
    /// in the unit of the file, finite
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

/// A line of `$PhysicalNames`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PhysicalName {
    /// 0 point, 1 curve, 2 surface, 3 volume
    pub dimension: usize,
    pub tag: i64,
    pub name: String,
}

impl Msh {
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
/// Errors: the file cannot be read, is no MSH 4.1 or 2.2, is cut off or corrupt, is partitioned, or has parametric
/// nodes.
pub fn read(path: &Path) -> Result<Msh> {
    let bytes = input::read(path, Kind::Mesh).map_err(|e| not_read(path, &e))?;
    parse(&bytes, &file_name(path))
}

pub fn not_read(path: &Path, why: &std::io::Error) -> Error {
    Error::input(format!("the mesh {} cannot be read: {why}", path.display()))
}

/// `meshes/twin_pipes.msh` -> `twin_pipes.msh`, as messages call the file.
pub fn file_name(path: &Path) -> String {
    path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned()
}

/// The content of a mesh file whose bytes are `bytes` and whose name in messages is `file`.
pub fn parse(bytes: &[u8], file: &str) -> Result<Msh> {
    let mut tokens = Tokens::new(bytes, file);
    let version = mesh_format(&mut tokens)?;
    let mut msh = Msh::default();
    let mut entities = None;
    let mut seen: Vec<String> = Vec::new();
    while !tokens.at_end() {
        tokens.section.clear();
        let name = tokens.section_mark()?;
        tokens.section.clone_from(&name);
        let known = matches!(name.as_str(), "Nodes" | "Elements" | "Entities" | "PhysicalNames");
        if known && seen.contains(&name) {
            return Err(tokens.error("the section stands twice in the file"));
        }
        match (name.as_str(), version) {
            ("PhysicalNames", _) => msh.names = physical_names(&mut tokens)?,
            ("Nodes", Version::V41) => msh.nodes = v4::nodes(&mut tokens)?,
            ("Nodes", Version::V22) => msh.nodes = v2::nodes(&mut tokens)?,
            ("Entities", Version::V41) => entities = Some(v4::entities(&mut tokens)?),
            ("Elements", Version::V41) => msh.blocks = v4::elements(&mut tokens, entities.as_ref())?,
            ("Elements", Version::V22) => msh.blocks = v2::elements(&mut tokens)?,
            ("PartitionedEntities", _) => return Err(partitioned(&tokens)),
            ("ParametricNodes", _) => return Err(parametric(&tokens)),
            _ => tokens.skip_section()?,
        }
        if known {
            tokens.section_end()?;
            seen.push(name);
        }
    }
    tokens.section.clear();
    if seen.iter().any(|s| s == "Nodes") != seen.iter().any(|s| s == "Elements") {
        return Err(tokens.error("$Nodes and $Elements must both be there; the file was cut off, make the mesh again"));
    }
    Ok(msh)
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Version {
    V41,
    V22,
}

/// `$MeshFormat`: `version(text) binary(0|1) size_of_real(8)`, then in binary a 4-byte 1 that shows the byte order.
fn mesh_format(tokens: &mut Tokens) -> Result<Version> {
    if tokens.at_end() {
        return Err(tokens.error("the file is empty; make the mesh again"));
    }
    if !matches!(tokens.section_mark().as_deref(), Ok("MeshFormat")) {
        return Err(
            tokens.error("this is no Gmsh mesh: it does not begin with $MeshFormat; save it with -format msh41")
        );
    }
    tokens.section = "MeshFormat".into();
    let line = String::from_utf8_lossy(tokens.line()).into_owned();
    let words: Vec<&str> = line.split_whitespace().collect();
    let version = match words.first() {
        Some(&"4.1") => Version::V41,
        Some(&"2.2") => Version::V22,
        other => {
            let found = other.unwrap_or(&"nothing").escape_debug();
            return Err(tokens.error(format!(
                "the format's version is {found}; versions 4.1 and 2.2 are read: save the mesh with -format msh41"
            )));
        }
    };
    match words[1..] {
        ["0", "8"] => {}
        ["1", "8"] => tokens.encoding = byte_order(tokens)?,
        _ => {
            let found = line.escape_debug();
            return Err(tokens.error(format!("expected \"{} 0 8\" or \"{0} 1 8\", found \"{found}\"", words[0])));
        }
    }
    tokens.section_end()?;
    Ok(version)
}

fn byte_order(tokens: &mut Tokens) -> Result<Encoding> {
    match tokens.raw::<4>()? {
        [1, 0, 0, 0] => Ok(Encoding::LittleEndian),
        [0, 0, 0, 1] => Ok(Encoding::BigEndian),
        other => {
            Err(tokens.error(format!("the bytes that show the byte order are {other:?}, not a 1; the file is corrupt")))
        }
    }
}

/// `count`, then `dimension tag "name"` a line; ASCII in binary files, too.
fn physical_names(tokens: &mut Tokens) -> Result<Vec<PhysicalName>> {
    let count = tokens.unsigned(Tokens::ascii_integer)?;
    let mut names = Vec::new();
    for _ in 0..count {
        let dimension = tokens.unsigned(Tokens::ascii_integer)?;
        let tag = tokens.ascii_integer()?;
        let text = String::from_utf8_lossy(tokens.line()).trim().to_owned();
        match text.strip_prefix('"').and_then(|t| t.strip_suffix('"')) {
            Some(name) if dimension <= 3 => names.push(PhysicalName { dimension, tag, name: name.into() }),
            _ => {
                let found = format!("{dimension} {tag} {text}");
                return Err(
                    tokens.error(format!("expected dimension, tag and \"name\", found {}", found.escape_debug()))
                );
            }
        }
    }
    Ok(names)
}

fn partitioned(tokens: &Tokens) -> Error {
    tokens.error("the mesh is partitioned; save it whole, without -part and without PartitionMesh")
}

fn parametric(tokens: &Tokens) -> Error {
    tokens.error("the nodes carry parametric coordinates; save the mesh with Mesh.SaveParametric = 0")
}
