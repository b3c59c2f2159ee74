//! The section `$MeshFormat`: which version, and how numbers are written.

use super::foreign;
use super::tokens::{Encoding, Tokens, beginning};
use super::{v2, v4};
use crate::Result;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Version {
    V4(v4::Layout),
    V2(v2::Layout),
}

/// `$MeshFormat`: `version(text) binary(0|1) size_of_real(8)`, then in binary a 4-byte 1 that shows the byte order.
/// Before it, `$Comments`, other sections that are not needed, and text may stand.
pub(super) fn mesh_format(tokens: &mut Tokens, bytes: &[u8]) -> Result<Version> {
    if let Some(what) = foreign::recognised(bytes) {
        return Err(tokens.of_file(what));
    }
    if tokens.at_end() {
        return Err(tokens.error("the file is empty; make the mesh again"));
    }
    loop {
        let Some(name) = tokens.next_section() else {
            return Err(tokens.of_file(NO_MESH));
        };
        match name.as_str() {
            "MeshFormat" => break,
            "NOD" | "NOE" | "ELM" => return Err(tokens.of_file(convert(tokens, "is MSH version 1"))),
            "Nodes" | "Elements" | "Entities" | "PhysicalNames" => {
                return Err(tokens.error(format!("${name} stands before $MeshFormat; make the mesh again")));
            }
            _ => {}
        }
        tokens.section = name;
        tokens.skip_section();
    }
    tokens.section = "MeshFormat".into();
    tokens.skip_space();
    let line = String::from_utf8_lossy(tokens.line()).into_owned();
    let words: Vec<&str> = line.split_whitespace().collect();
    let version = version(words.first().copied().unwrap_or_default(), tokens)?;
    match words[1..] {
        // the size of binary numbers says nothing about those in ASCII
        ["0", _] => {}
        ["1", "8"] => tokens.encoding = byte_order(tokens)?,
        _ => {
            let found = beginning(line.as_bytes());
            return Err(tokens.error(format!("expected \"{} 0 8\" or \"{0} 1 8\", found \"{found}\"", words[0])));
        }
    }
    tokens.section_end()?;
    Ok(version)
}

const NO_MESH: &str = "this is no Gmsh mesh: it has no section $MeshFormat; save it with -format msh41";

/// Gmsh reads 2.3 as 2.2, too; neither 3 nor 1.x with $MeshFormat exists.
fn version(word: &str, tokens: &Tokens) -> Result<Version> {
    match word.parse::<f64>() {
        Ok(4.1) => Ok(Version::V4(v4::Layout::V41)),
        Ok(4.0) => Ok(Version::V4(v4::Layout::V40)),
        Ok(number) if (2.2..3.).contains(&number) => Ok(Version::V2(v2::Layout::V22)),
        Ok(number) if (2.0..2.2).contains(&number) => Ok(Version::V2(v2::Layout::V20)),
        _ => {
            let found = if word.is_empty() { "nothing".into() } else { beginning(word.as_bytes()) };
            Err(tokens.error(format!(
                "the format's version is {found}; versions 4.1, 4.0 and 2.0 to 2.2 are read: save the mesh with -format msh41"
            )))
        }
    }
}

/// What the file is, and how to make a file of it that can be read.
fn convert(tokens: &Tokens, what: &str) -> String {
    format!(
        "the file {what}, which is not read; convert it: gmsh {} -save -format msh41 -o new.msh (it has no names of groups: \
         physical group 7 of surfaces is then called \"physical_2_7\")",
        tokens.file()
    )
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
