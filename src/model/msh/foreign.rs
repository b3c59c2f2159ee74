//! Files that are often given in place of a mesh: what they are, and what to do.

use super::tokens::BYTE_ORDER_MARK;

/// As much of a file as is looked at.
const HEAD: usize = 4096;

/// A sentence on a file that is known and is no Gmsh mesh.
pub(super) fn recognised(bytes: &[u8]) -> Option<String> {
    let head = &bytes[..bytes.len().min(HEAD)];
    let (what, remedy) = binary(head).or_else(|| text(head))?;
    Some(format!("this is no Gmsh mesh, which begins with $MeshFormat, but {what}; {remedy}"))
}

/// What a file is, and the remedy.
type Kind = (&'static str, &'static str);

const AS_GMSH: &str = "convert it to MSH 4.1: gmsh FILE -save -format msh41 -o new.msh, or meshio convert";

/// By the first bytes.
fn binary(head: &[u8]) -> Option<Kind> {
    const UNPACK: &str = "unpack it and give the .msh that is in it";
    const KINDS: [(&[u8], Kind); 14] = [
        (b"\x1f\x8b", ("a file compressed with gzip", UNPACK)),
        (b"PK\x03\x04", ("a zip archive", UNPACK)),
        (b"BZh", ("a file compressed with bzip2", UNPACK)),
        (b"\xfd7zXZ\x00", ("a file compressed with xz", UNPACK)),
        (b"\x28\xb5\x2f\xfd", ("a file compressed with zstd", UNPACK)),
        (b"7z\xbc\xaf\x27\x1c", ("a 7z archive", UNPACK)),
        (b"Rar!", ("a rar archive", UNPACK)),
        (b"\x89HDF", ("an HDF5 file (MED, CGNS, XDMF or other)", AS_GMSH)),
        (b"CDF", ("a netCDF file (Exodus or other)", "convert it to MSH 4.1, as with meshio convert")),
        (b"%PDF", ("a PDF document", "give the mesh itself")),
        (b"\x89PNG", ("a PNG picture", "give the mesh itself")),
        (b"\x7fELF", ("a program", "give the mesh itself")),
        (b"\xff\xfe", UTF_16),
        (b"\xfe\xff", UTF_16),
    ];
    const UTF_16: Kind = ("text in UTF-16", "save it in ASCII or UTF-8");
    if head.get(257..262) == Some(b"ustar") {
        return Some(("a tar archive", UNPACK));
    }
    KINDS.iter().find(|(mark, _)| head.starts_with(mark)).map(|&(_, kind)| kind)
}

/// By the first line that is not blank.
fn text(head: &[u8]) -> Option<Kind> {
    let head = head.strip_prefix(BYTE_ORDER_MARK).unwrap_or(head).trim_ascii_start();
    if head.starts_with(b"$") {
        let ends_in_cr = head.contains(&b'\r') && !head.contains(&b'\n');
        return ends_in_cr.then_some(("text whose lines end in a carriage return alone", "save it with line feeds"));
    }
    let whole = String::from_utf8_lossy(head).to_lowercase();
    // text may stand before the first section
    if whole.lines().any(|line| line.trim_start().starts_with("$meshformat")) && !whole.starts_with('<') {
        return None;
    }
    let line = whole.lines().next().unwrap_or_default().trim_end();
    let begins = |marks: &[&str]| marks.iter().any(|mark| line.starts_with(mark));
    let has = |marks: &[&str]| marks.iter().any(|mark| whole.contains(mark));
    let numbers = || line.split_whitespace().all(|word| word.parse::<u64>().is_ok());
    const DOWNLOAD: &str = "download the mesh itself, not the page that shows it";
    Some(match () {
        () if begins(&["version https://git-lfs"]) => {
            ("a Git LFS pointer, which stands for the file in the repository", "fetch the file itself: git lfs pull")
        }
        () if begins(&["<!doctype html", "<html"]) => ("a web page (HTML)", DOWNLOAD),
        () if begins(&["404: not found", "404 not found", "not found"]) => {
            ("the answer to a failed download", DOWNLOAD)
        }
        () if begins(&["# vtk datafile", "<vtkfile"]) || has(&["<vtkfile"]) => ("a VTK file", AS_GMSH),
        () if begins(&["<?xml", "<"]) => ("an XML file", "give the .msh"),
        () if begins(&["{", "["]) => {
            ("a JSON file", "give the .msh; a case names it as \"geometry\": { \"mesh\": \"FILE.msh\" }")
        }
        () if begins(&["*heading", "*node", "**", "*include", "*part"]) => {
            ("an Abaqus or CalculiX input (.inp)", AS_GMSH)
        }
        () if begins(&["meshversionformatted"]) => ("a Medit mesh (.mesh)", AS_GMSH),
        () if begins(&["solid "]) || line == "solid" => ("an STL surface", AS_GMSH),
        () if line == "ply" => ("a PLY surface", AS_GMSH),
        () if line == "off" => ("an OFF surface", "convert it to MSH 4.1, as with meshio convert"),
        () if begins(&["ndime"]) => ("an SU2 mesh", AS_GMSH),
        () if begins(&["mesh dimension", "mesh \""]) => ("a GiD mesh", "convert it to MSH 4.1"),
        () if begins(&["(0 ", "(1 ", "(2 "]) => {
            ("a Fluent mesh, whose names also end in .msh", "convert it to MSH 4.1, as with meshio convert")
        }
        () if begins(&["begin bulk", "sol ", "cend", "grid"]) => ("a Nastran input", AS_GMSH),
        () if is_script(&whole) => (
            "a Gmsh script (.geo)",
            "mesh it: gmsh -2 FILE.geo -format msh41 -o new.msh, or name it as geometry.script in the case",
        ),
        () if !line.is_empty() && line.split_whitespace().count() == 3 && numbers() => {
            ("a list of numbers, perhaps a FreeFem mesh, whose names also end in .msh", AS_GMSH)
        }
        () => return None,
    })
}

/// Commands that hardly a script is without; `text` in lower case.
fn is_script(text: &str) -> bool {
    const COMMANDS: [&str; 8] =
        ["setfactory", "point(", "point (", "physical ", "rectangle(", "include \"", "defineconstant", "merge \""];
    !text.contains("$meshformat") && COMMANDS.iter().any(|command| text.contains(command)) && text.contains(';')
}
