//! The mesh reader against Gmsh's own files and hand-written ones. Format: Gmsh reference manual, "Gmsh file formats".

use coralpipe::model::mesh::{Mesh, Shape};
use coralpipe::model::msh::{self, Block, Msh};
use coralpipe::study::gmsh::Gmsh;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::Mutex;

// ---- Gmsh's tutorials -------------------------------------------------------------------------------------------

const FORMATS: [(&str, &str, u8); 5] =
    [("41a", "4.1", 0), ("41b", "4.1", 1), ("40a", "4.0", 0), ("22a", "2.2", 0), ("22b", "2.2", 1)];

/// The tutorials' folder, and the gmsh they belong to: those of `.venv`, or the folder `CORALPIPE_TUTORIALS` and the
/// gmsh found as always. None if they are not installed, which is a failure where CI is set.
fn tutorials() -> Option<(PathBuf, Gmsh)> {
    let top = Path::new(env!("CARGO_MANIFEST_DIR"));
    let (folder, gmsh) = match std::env::var_os("CORALPIPE_TUTORIALS") {
        Some(folder) => (PathBuf::from(folder), Gmsh::find(top)),
        None => (top.join(".venv/share/doc/gmsh/tutorials"), Gmsh::find_in(None, None, &[top])),
    };
    match gmsh {
        Ok(gmsh) if folder.join("t1.geo").is_file() => Some((folder, gmsh)),
        found => {
            let why = found.err().map_or_else(|| format!("no t1.geo in {}", folder.display()), |e| e.to_string());
            assert!(std::env::var_os("CI").is_none(), "gmsh's tutorials cannot be meshed: {why}");
            eprintln!("\n*** SKIPPED: gmsh's tutorials cannot be meshed: {why} ***\n");
            None
        }
    }
}

/// Meshes tutorial `i` once and saves that mesh in all formats; kept from one test run to the next.
fn meshed(i: usize, tutorials: &Path, gmsh: &Gmsh) -> BTreeMap<&'static str, PathBuf> {
    static ONE_AT_A_TIME: Mutex<()> = Mutex::new(());
    let _guard = ONE_AT_A_TIME.lock().unwrap();
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("tutorials").join(format!("t{i}"));
    let files: BTreeMap<_, _> = FORMATS.iter().map(|f| (f.0, folder.join(format!("{}.msh", f.0)))).collect();
    if files.values().all(|f| f.is_file()) {
        return files;
    }
    std::fs::create_dir_all(&folder).unwrap();
    // the scripts write beside themselves: work on copies
    for entry in std::fs::read_dir(tutorials).unwrap().map(|e| e.unwrap().path()).filter(|p| p.is_file()) {
        std::fs::copy(&entry, folder.join(entry.file_name().unwrap())).unwrap();
    }
    let dimension = if [2, 5, 10, 12, 13, 14, 15, 16, 18, 20].contains(&i) { 3 } else { 2 };
    let mut script = std::fs::read_to_string(folder.join(format!("t{i}.geo"))).unwrap();
    script += &format!("\nMesh {dimension};\n");
    for (name, version, binary) in FORMATS {
        script += &format!("Mesh.MshFileVersion = {version}; Mesh.Binary = {binary}; Save \"{name}.part.msh\";\n");
    }
    // t21 shows how to partition a mesh, which the reader refuses: the test takes the mesh before that
    script = script.replace("  PartitionMesh N;", "");
    std::fs::write(folder.join("all.geo"), script).unwrap();
    let output = gmsh.command().arg("-").arg(folder.join("all.geo")).args(["-nt", "1"]).output().unwrap();
    for (name, file) in &files {
        let part = folder.join(format!("{name}.part.msh"));
        assert!(part.is_file(), "t{i}: {}", String::from_utf8_lossy(&output.stderr));
        std::fs::rename(part, file).unwrap();
    }
    files
}

/// (dimension, physical tag) -> elements; the same in all formats.
fn group_counts(msh: &Msh) -> BTreeMap<(usize, i64), usize> {
    let mut counts = BTreeMap::new();
    for block in &msh.blocks {
        for tag in &block.physicals {
            *counts.entry((block.kind.dimension, tag.abs())).or_default() += block.element_tags.len();
        }
    }
    counts
}

/// Every node's tag and place.
fn places(msh: &Msh) -> BTreeMap<usize, [f64; 3]> {
    msh.nodes.iter().map(|n| (n.tag, n.xyz)).collect()
}

/// Every element's type and sorted nodes, once.
fn elements(msh: &Msh) -> BTreeSet<(i64, Vec<usize>)> {
    let sorted = |nodes: &[usize]| nodes.iter().copied().collect::<BTreeSet<_>>().into_iter().collect();
    let of_block = |b: &Block| b.elements().map(|(_, n)| (b.kind.number, sorted(n))).collect::<Vec<_>>();
    msh.blocks.iter().flat_map(of_block).collect()
}

#[test]
fn all_formats_of_a_tutorials_mesh_say_the_same_and_mshio_counts_the_same() {
    let Some((folder, gmsh)) = tutorials() else {
        return;
    };
    for i in 1..=21 {
        let files = meshed(i, &folder, &gmsh);
        let read = |format: &str| msh::read(&files[format]).unwrap_or_else(|e| panic!("t{i}: {e}"));
        let reference = read("41a");
        let (nodes, distinct) = (places(&reference), elements(&reference).len());
        assert_eq!(nodes.is_empty(), i == 9, "t{i}: only t9 makes no mesh of its own");
        // gmsh writes 4.0 in ASCII only
        for (text, binary) in [("41a", "41b"), ("41a", "40a"), ("22a", "22b")] {
            let (text, binary) = (read(text), read(binary));
            let (text_nodes, binary_nodes) = (places(&text), places(&binary));
            assert_eq!(elements(&text), elements(&binary), "t{i}");
            assert_eq!((&text.names, &binary.names), (&reference.names, &reference.names), "t{i}");
            assert_eq!(group_counts(&text), group_counts(&reference), "t{i}");
            assert_eq!(group_counts(&binary), group_counts(&reference), "t{i}");
            // of t14, gmsh numbers the nodes anew in 2.2
            assert_eq!((text_nodes.len(), elements(&text).len()), (nodes.len(), distinct), "t{i}");
            assert_eq!(binary_nodes.len(), nodes.len(), "t{i}");
            for (tag, xyz) in &binary_nodes {
                // text has 16 digits
                let near = |k: usize| (xyz[k] - text_nodes[tag][k]).abs() <= 1e-15 * (1.0 + xyz[k].abs());
                assert!((0..3).all(near), "t{i}: node {tag} lies at {xyz:?} and at {:?}", text_nodes[tag]);
            }
        }
        for format in if i == 9 { vec![] } else { vec!["41a", "41b"] } {
            let theirs = mshio::parse_msh_bytes(&std::fs::read(&files[format]).unwrap()).unwrap().data;
            assert_eq!(theirs.nodes.unwrap().num_nodes, nodes.len() as u64, "t{i} {format}");
            assert_eq!(theirs.elements.unwrap().num_elements, reference.element_count() as u64, "t{i} {format}");
        }
    }
}

#[test]
fn plane_tutorials_become_the_same_plane_mesh_from_all_formats_and_others_are_refused_by_a_sentence() {
    let Some((folder, gmsh)) = tutorials() else {
        return;
    };
    for i in 1..=21 {
        let files = meshed(i, &folder, &gmsh);
        let summary = |format: &str| {
            let mesh = Mesh::read(&files[format])?;
            let groups = mesh.groups.iter().map(|g| (g.name.clone(), g.dimension, g.cells.len())).collect::<Vec<_>>();
            Ok::<_, coralpipe::Error>((mesh.points.len(), mesh.cells.len(), groups, mesh.turned))
        };
        let reference = summary("41a").map_err(|e| e.to_string());
        for format in ["41b", "40a", "22a", "22b"] {
            assert_eq!(summary(format).ok(), reference.clone().ok(), "t{i} {format}");
        }
        let plane = [1, 3, 4, 6, 7, 8, 10, 11, 17, 21].contains(&i);
        assert_eq!(reference.is_ok(), plane, "t{i}: {reference:?}");
    }
    // t1: a rectangle of 0.1 x 0.3; its curves 1, 2 and 4 are the group 5, which has no name
    let mesh = Mesh::read(&meshed(1, &folder, &gmsh)["41a"]).unwrap();
    let measure = |name: &str| mesh.measure_of(mesh.group(name).unwrap());
    assert!((measure("My surface") - 0.03).abs() < 1e-14 && (measure("physical_1_5") - 0.7).abs() < 1e-14);
}

// ---- Hand-written files -----------------------------------------------------------------------------------------

/// Two unit triangles over a square; curve 1 (bottom) in the groups "base" and, reversed, "loop"; node 9 is unused.
const SQUARE_41: &str = "$MeshFormat\n4.1 0 8\n$EndMeshFormat
$Comments\nmade by hand: $Nodes\n$EndComments
$PhysicalNames\n4\n1 1 \"base\"\n1 2 \"loop of pipe\"\n2 7 \"s\u{e4}nd\"\n1 9 \"unused\"\n$EndPhysicalNames
$Entities\n1 2 1 0\n5 0 0 0 1 3\n1 0 0 0 1 0 0 2 1 -2 0\n2 1 0 0 1 1 0 0 0\n1 0 0 0 1 1 0 1 7 2 1 -2\n$EndEntities
$Nodes\n1 5 1 900\n2 1 0 5\n1\n2\n3\n4\n9\n0 0 2\n1 0 2\n1 1 2\n0 1 2\n5 5 2\n$EndNodes
$Elements\n4 5 1 5\n0 5 15 1\n1 1\n1 1 1 1\n2 1 2\n1 2 1 1\n3 2 3\n2 1 2 2\n4 1 2 3\n5 1 4 3\n$EndElements
$Periodic\n0\n$EndPeriodic\n$NodeData\n1\n\"a\"\n$EndNodeData\n";

/// The same square in 2.2: an element stands once in each of its groups, reversed in "loop".
const SQUARE_22: &str = "$MeshFormat\n2.2 0 8\n$EndMeshFormat
$PhysicalNames\n4\n1 1 \"base\"\n1 2 \"loop of pipe\"\n2 7 \"s\u{e4}nd\"\n1 9 \"unused\"\n$EndPhysicalNames
$Nodes\n5\n1 0 0 2\n2 1 0 2\n3 1 1 2\n4 0 1 2\n9 5 5 2\n$EndNodes
$Elements\n6\n1 15 2 3 5 1\n2 1 2 1 1 1 2\n3 1 2 2 1 2 1\n4 1 2 0 2 2 3\n5 2 2 7 1 1 2 3\n6 2 2 7 1 1 4 3\n$EndElements\n";

fn mesh_of(text: &str) -> coralpipe::Result<Mesh> {
    Mesh::from_msh(&msh::parse(text.as_bytes(), "square.msh")?, "square.msh")
}

/// The sentence `text` is refused with.
fn refusal(text: &str) -> String {
    mesh_of(text).expect_err("the file must be refused").to_string()
}

#[test]
fn the_same_mesh_comes_from_both_versions_each_cell_once_faces_anticlockwise() {
    let mesh = mesh_of(SQUARE_41).unwrap();
    assert_eq!(mesh, mesh_of(SQUARE_22).unwrap());
    assert_eq!((mesh.points.len(), mesh.turned), (4, 1), "node 9 is dropped, element 5 turned");
    let faces: Vec<_> = mesh.cells.iter().filter(|c| c.shape == Shape::Tri3).map(|c| c.nodes.clone()).collect();
    assert_eq!(faces, [[0, 1, 2], [0, 2, 3]]);
    let groups: Vec<_> = mesh.groups.iter().map(|g| (g.name.as_str(), g.dimension, g.cells.clone())).collect();
    assert_eq!(
        groups,
        [
            ("physical_0_3", 0, vec![0]),
            ("base", 1, vec![1]),
            ("loop of pipe", 1, vec![1]),
            ("unused", 1, vec![]),
            ("s\u{e4}nd", 2, vec![2, 3])
        ]
    );
    assert_eq!(mesh.nodes_of(mesh.group("base").unwrap()), [0, 1]);
    assert_eq!(mesh.centroid(&mesh.cells[2]), [2.0 / 3.0, 1.0 / 3.0]);
}

#[test]
fn a_group_that_does_not_exist_or_is_empty_is_named_with_those_that_exist() {
    let mesh = mesh_of(SQUARE_41).unwrap();
    let sentence = |name| mesh.group(name).unwrap_err().to_string();
    assert_eq!(
        sentence("blast"),
        "no physical group \"blast\" in square.msh; it has: base, loop of pipe, physical_0_3, s\u{e4}nd, unused"
    );
    assert_eq!(sentence("unused"), "the physical group \"unused\" in square.msh has no elements");
}

/// One face of `kind` with the nodes 1.. of `points`, in the physical group 7.
fn one_face(kind: usize, points: &[[f64; 2]]) -> String {
    let mut text = format!("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{}\n", points.len());
    for (i, [x, y]) in points.iter().enumerate() {
        text += &format!("{} {x} {y} 0\n", i + 1);
    }
    let nodes: Vec<String> = (1..=points.len()).map(|i| i.to_string()).collect();
    text + &format!("$EndNodes\n$Elements\n1\n3 {kind} 2 7 1 {}\n$EndElements\n", nodes.join(" "))
}

#[test]
fn clockwise_faces_of_second_order_are_turned_with_their_mid_side_nodes() {
    let (corners, bulge) = ([[0.0, 0.0], [0.0, 2.0], [2.0, 2.0], [2.0, 0.0]], [-0.3, 1.0]);
    let quad = [&corners[..], &[bulge, [1.0, 2.0], [2.0, 1.0], [1.0, 0.0]]].concat();
    let mesh = mesh_of(&one_face(16, &quad)).unwrap();
    assert_eq!((mesh.turned, &mesh.cells[0].nodes[..]), (1, &[0, 3, 2, 1, 7, 6, 5, 4][..]));
    // Archimedes: a parabola's segment is 2/3 of chord x rise
    assert!((mesh.measure(&mesh.cells[0]) - (4.0 + 2.0 / 3.0 * 2.0 * 0.3)).abs() < 1e-14);

    let triangle = [[0.0, 0.0], [0.0, 2.0], [2.0, 0.0], [0.0, 1.0], [1.0, 1.0], [1.0, 0.0]];
    let mesh = mesh_of(&one_face(9, &triangle)).unwrap();
    assert_eq!((mesh.turned, &mesh.cells[0].nodes[..]), (1, &[0, 2, 1, 5, 4, 3][..]));
    assert!((mesh.measure(&mesh.cells[0]) - 2.0).abs() < 1e-14);
}

#[test]
fn the_length_of_a_curved_line_is_that_of_its_parabola() {
    let corners = [[0.0, 0.0], [2.0, 0.0], [2.0, 4.0], [0.0, 4.0]];
    let arched = one_face(16, &[&corners[..], &[[1.0, 1.0], [2.0, 2.0], [1.0, 4.0], [0.0, 2.0]]].concat());
    let text = arched.replace("$Elements\n1\n", "$Elements\n2\n1 8 2 4 1 1 2 5\n");
    let mesh = mesh_of(&text).unwrap();
    // y = 2x - x^2 on 0..2: integral of sqrt(1 + 4u^2) over u = -1..1 = sqrt 5 + asinh(2)/2
    let exact = 5_f64.sqrt() + 2_f64.asinh() / 2.0;
    let length = mesh.measure_of(mesh.group("physical_1_4").unwrap());
    assert!((length / exact - 1.0).abs() < 2e-3, "{length} against {exact}");
}

#[test]
fn what_cannot_be_a_plane_mesh_is_refused_by_a_sentence_that_names_it() {
    let cases = [
        (SQUARE_41.replace("1 1 2\n0 1 2", "1 1 3\n0 1 2"), "not plane: node 1 lies at z = 2, node 3 at z = 3"),
        (
            SQUARE_41.replace("0 1 2\n5 5", "2 2 2\n5 5"),
            "element 5 of square.msh has no area; its corners are (0, 0), (2, 2), (1, 1)",
        ),
        (SQUARE_41.replace("5 1 4 3", "5 1 4 1"), "element 5 of square.msh has no area"),
        (SQUARE_41.replace("5 1 4 3", "5 1 4 1"), "it is a triangle of \"s\u{e4}nd\"; it has node 1 twice"),
        (SQUARE_41.replace("5 1 4 3", "5 1 8 3"), "element 5 of square.msh uses node 8, which is not among its nodes"),
        (SQUARE_41.replace("4\n9\n0", "4\n3\n0"), "node 3 stands twice in square.msh"),
        (SQUARE_41.replace("loop of pipe", "base"), "two physical groups of curves called \"base\", 1 and 2"),
        (one_face(10, &[[0.0; 2]; 9]), "9-node quadrangle elements in the physical group \"physical_2_7\""),
        (one_face(10, &[[0.0; 2]; 9]), "Mesh.SecondOrderIncomplete = 1"),
        (one_face(4, &[[0.0; 2]; 4]), "4-node tetrahedron elements in the physical group"),
        (one_face(1, &[[0.0, 0.0], [1.0, 0.0]]), "square.msh is empty: it has no faces"),
        ("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n".into(), "square.msh is empty"),
    ];
    for (text, wanted) in cases {
        let sentence = refusal(&text);
        assert!(sentence.contains(wanted), "{sentence}\n  should say: {wanted}");
    }
}

#[test]
fn partitioned_parametric_and_foreign_files_are_refused_with_how_to_save_them() {
    let cases = [
        (SQUARE_41.replace("$Nodes\n", "$PartitionedEntities\n2\n$EndPartitionedEntities\n$Nodes\n"), "without -part"),
        (
            SQUARE_22.replace("6 2 2 7 1 1 4 3", "6 2 4 7 1 1 1 1 4 3"),
            "square.msh, $Elements, line 26: the mesh is partitioned",
        ),
        (SQUARE_41.replace("\n2 1 0 5\n", "\n2 1 1 5\n"), "Mesh.SaveParametric = 0"),
        (SQUARE_22.replace("$Nodes", "$ParametricNodes"), "Mesh.SaveParametric = 0"),
        (
            SQUARE_41.replace("4.1 0 8", "3 0 8"),
            "version is 3; versions 4.1, 4.0 and 2.0 to 2.2 are read: save the mesh with -format msh41",
        ),
        ("solid cube\n".into(), "this is no Gmsh mesh"),
        (String::new(), "square.msh, line 1: the file is empty"),
    ];
    for (text, wanted) in cases {
        let sentence = refusal(&text);
        assert!(sentence.contains(wanted), "{sentence}\n  should say: {wanted}");
    }
}

#[test]
fn a_corrupt_file_is_refused_with_section_and_line() {
    let cases = [
        (SQUARE_41.replace("1 0 2\n1 1", "1 O 2\n1 1"), "square.msh, $Nodes, line 30: expected a number, found \"O\""),
        (
            SQUARE_41.replace("1 0 2\n1 1", "1 nan 2\n1 1"),
            "square.msh, $Nodes, line 30: a node lies at [1.0, NaN, 2.0]",
        ),
        (SQUARE_41.replace("1 5 1 900", "1 5000000000000 1 900"), "5000000000000 nodes are announced, but only"),
        (SQUARE_41.replace("1 5 1 900", "1 6 1 900"), "6 nodes are announced, but the blocks hold 5"),
        (SQUARE_41.replace("2 1 2 2\n4", "2 1 140 2\n4"), "element type 140 is unknown"),
        (SQUARE_41.replace("1 2 1 1\n3", "1 3 1 1\n3"), "entity 3 of dimension 1 is not among the $Entities"),
        (SQUARE_41.replace("$EndElements", "$EndElement"), "expected $EndElements, found \"$EndElement\""),
        (SQUARE_22.replace("$Elements\n6", "$Elements\n7"), "expected an integer, found \"$EndElements\""),
    ];
    for (text, wanted) in cases {
        let sentence = refusal(&text);
        assert!(sentence.contains(wanted), "{sentence}\n  should say: {wanted}");
    }
}

/// `SQUARE_41` and `SQUARE_22` in binary of either byte order.
fn square_binary(version: &str, big_endian: bool) -> Vec<u8> {
    let int = |v: i32| if big_endian { v.to_be_bytes() } else { v.to_le_bytes() }.to_vec();
    let size = |v: u64| if big_endian { v.to_be_bytes() } else { v.to_le_bytes() }.to_vec();
    let real = |v: f64| size(v.to_bits());
    let ints = |v: &[i32]| v.iter().flat_map(|&v| int(v)).collect::<Vec<u8>>();
    let sizes = |v: &[u64]| v.iter().flat_map(|&v| size(v)).collect::<Vec<u8>>();
    let reals = |v: &[f64]| v.iter().flat_map(|&v| real(v)).collect::<Vec<u8>>();
    let text = |s: &str| s.as_bytes().to_vec();
    let names =
        "$PhysicalNames\n4\n1 1 \"base\"\n1 2 \"loop of pipe\"\n2 7 \"s\u{e4}nd\"\n1 9 \"unused\"\n$EndPhysicalNames\n";
    let xyz = [[0.0, 0.0, 2.0], [1.0, 0.0, 2.0], [1.0, 1.0, 2.0], [0.0, 1.0, 2.0], [5.0, 5.0, 2.0]];
    let head =
        [text(&format!("$MeshFormat\n{version} 1 8\n")), int(1), text("\n$EndMeshFormat\n"), text(names)].concat();
    if version == "2.2" {
        let node = |(tag, xyz): (&i32, &[f64; 3])| [int(*tag), reals(xyz)].concat();
        let nodes: Vec<u8> = [1, 2, 3, 4, 9].iter().zip(&xyz).flat_map(node).collect();
        let lines = [&[1, 3, 2][..], &[2, 1, 1, 1, 2], &[3, 2, 1, 2, 1], &[4, 0, 2, 2, 3]].concat();
        let faces = [&[2, 2, 2][..], &[5, 7, 1, 1, 2, 3], &[6, 7, 1, 1, 4, 3]].concat();
        let elements = [ints(&[15, 1, 2, 1, 3, 5, 1]), ints(&lines), ints(&faces)].concat();
        let middle = [text("$Nodes\n5\n"), nodes, text("\n$EndNodes\n$Elements\n6\n"), elements].concat();
        return [head, middle, text("\n$EndElements\n")].concat();
    }
    let entities = [
        [sizes(&[1, 2, 1, 0]), int(5), reals(&[0.0; 3]), size(1), int(3)].concat(),
        [int(1), reals(&[0.0; 6]), size(2), ints(&[1, -2]), size(0)].concat(),
        [int(2), reals(&[0.0; 6]), sizes(&[0, 0])].concat(),
        [int(1), reals(&[0.0; 6]), size(1), int(7), size(2), ints(&[1, -2])].concat(),
    ];
    let nodes = [sizes(&[1, 5, 1, 9]), ints(&[2, 1, 0]), sizes(&[5, 1, 2, 3, 4, 9]), reals(&xyz.concat())].concat();
    let elements = [
        [sizes(&[4, 5, 1, 5]), ints(&[0, 5, 15]), sizes(&[1, 1, 1])].concat(),
        [ints(&[1, 1, 1]), sizes(&[1, 2, 1, 2]), ints(&[1, 2, 1]), sizes(&[1, 3, 2, 3])].concat(),
        [ints(&[2, 1, 2]), sizes(&[2, 4, 1, 2, 3, 5, 1, 4, 3])].concat(),
    ];
    let entities = [text("$Entities\n"), entities.concat(), text("\n$EndEntities\n")].concat();
    let nodes = [text("$Nodes\n"), nodes, text("\n$EndNodes\n")].concat();
    [head, entities, nodes, text("$Elements\n"), elements.concat(), text("\n$EndElements\n")].concat()
}

#[test]
fn binary_files_of_either_byte_order_give_the_mesh_of_the_text() {
    let wanted = mesh_of(SQUARE_41).unwrap();
    for (version, big_endian) in [("4.1", false), ("4.1", true), ("2.2", false), ("2.2", true)] {
        let bytes = square_binary(version, big_endian);
        let mesh = Mesh::from_msh(&msh::parse(&bytes, "square.msh").unwrap(), "square.msh");
        assert_eq!(mesh.unwrap(), wanted, "{version} {big_endian}");
    }
}

/// Every file cut off anywhere, and with any byte changed, is read or refused, but never panics.
#[test]
fn files_cut_off_or_changed_at_any_byte_are_refused_or_read() {
    let mut files = vec![SQUARE_41.as_bytes().to_vec(), SQUARE_22.as_bytes().to_vec()];
    files.extend(["4.1", "2.2"].iter().flat_map(|v| [square_binary(v, false), square_binary(v, true)]));
    for file in &files {
        torture(file, 1);
    }
    let Some((folder, gmsh)) = tutorials() else {
        return;
    };
    for file in meshed(1, &folder, &gmsh).values() {
        torture(&std::fs::read(file).unwrap(), 37);
    }
}

fn torture(bytes: &[u8], stride: usize) {
    let read = |bytes: &[u8]| msh::parse(bytes, "x.msh").and_then(|msh| Mesh::from_msh(&msh, "x.msh"));
    let whole = read(bytes).unwrap();
    for end in (0..bytes.len()).step_by(stride) {
        // only sections behind the elements may be missing, or white space
        match read(&bytes[..end]) {
            Ok(mesh) => assert!(mesh == whole && contains(&bytes[..end], b"$EndElements"), "cut off at {end}"),
            Err(sentence) => assert!(sentence.to_string().contains("x.msh"), "{sentence}"),
        }
    }
    for at in (0..bytes.len()).step_by(stride) {
        for change in [0x01, 0x10, 0x80, 0xff] {
            let mut changed = bytes.to_vec();
            changed[at] ^= change;
            let _ = read(&changed);
        }
    }
}

fn contains(bytes: &[u8], wanted: &[u8]) -> bool {
    bytes.windows(wanted.len()).any(|w| w == wanted)
}

#[test]
fn a_missing_file_is_named_with_its_path() {
    let sentence = Mesh::read(Path::new("meshes/nowhere.msh")).unwrap_err().to_string();
    assert!(sentence.starts_with("the mesh meshes/nowhere.msh cannot be read"), "{sentence}");
}

// ---- Sections that are not needed, versions, names --------------------------------------------------------------

/// A mesh must be read, and be that of `SQUARE_41`.
fn reads_as_the_square(what: &str, text: &str) {
    let mesh = mesh_of(text).unwrap_or_else(|e| panic!("{what}: {e}"));
    assert_eq!(mesh, mesh_of(SQUARE_41).unwrap(), "{what}");
}

/// `text` with its section `name` moved behind all others, or without it.
fn section_last(text: &str, name: &str, kept: bool) -> String {
    let (head, rest) = text.split_once(&format!("\n${name}\n")).unwrap();
    let (content, tail) = rest.split_once(&format!("$End{name}\n")).unwrap();
    head.to_string() + "\n" + tail + &if kept { format!("${name}\n{content}$End{name}\n") } else { String::new() }
}

/// Each was opened with gmsh 4.15.2, too, which reads the mesh unless said otherwise.
#[test]
fn sections_that_are_not_needed_decide_nothing() {
    const DATA: &str = "1\n\"u\"\n1\n0.0\n3\n0\n1\n1\n1 2.5\n";
    for square in [SQUARE_41, SQUARE_22] {
        let before = |section: &str, text: &str| match section {
            "MeshFormat" => format!("{text}{square}"),
            _ => square.replace(&format!("\n${section}\n"), &format!("\n{text}${section}\n")),
        };
        let format = &square[..square.find("$EndMeshFormat\n").unwrap() + "$EndMeshFormat\n".len()];
        let rows = [
            ("an indented end", format!("{square}$NodeData\n{DATA} $EndNodeData\n")),
            ("indented markers, a tab", format!("{square} $ElementData\n{DATA}\t$EndElementData\n")),
            ("no end", format!("{square}$ElementNodeData\n{DATA}")),
            ("no end of several", format!("{square}$NodeData\n{DATA}$NodeData\n{DATA}$InterpolationScheme\n0\n")),
            ("only a marker", format!("{square}$Periodic")),
            ("words behind the end", format!("{square}$GhostElements\n0\n$EndGhostElements of part 1\n")),
            ("a name with other characters", format!("{square}$my-section_2\nx\n$Endmy-section_2\n")),
            // gmsh finds no nodes: the section runs to the end of the file
            ("no end before the nodes", before("Nodes", &format!("$NodeData\n{DATA}"))),
            ("an indented end before the nodes", before("Nodes", &format!("$NodeData\n{DATA}  $EndNodeData\n"))),
            ("a needed section named in a comment", before("Nodes", "$Comments\n$Nodes\n1\n$EndComments\n")),
            ("comments before the format", before("MeshFormat", "$Comments\nmade by hand\n$EndComments\n")),
            // gmsh takes the file for a script
            ("text before the format", before("MeshFormat", "made by hand\n// costs 5 $\n\n")),
            ("text between sections", before("Elements", "42 words, and $some with a dollar\n")),
            ("the end of a section that did not begin", before("Elements", "$EndSomething\n")),
            ("text behind all", format!("{square}end of file\n")),
            ("what DOS puts behind text", format!("{square}\u{1a}")),
            ("zero bytes behind all", format!("{square}\0\0\0")),
            ("the format a second time", before("Nodes", format)),
            ("names behind all", section_last(square, "PhysicalNames", true)),
            ("nodes behind elements", section_last(square, "Nodes", true)),
            ("DOS line ends", square.replace('\n', "\r\n")),
            ("a byte order mark", format!("\u{feff}{square}")),
            ("blank lines", square.replace("Format\n", "Format\n\n").replace("$Nodes\n", "$Nodes\n \n")),
            ("blanks behind and before markers", square.replace("Nodes\n", "Nodes \t\n").replace("$E", "  $E")),
            ("words behind a marker", before("Nodes", "").replace("\n$Nodes\n", "\n$Nodes of the square\n")),
            ("another size of reals in ASCII", square.replace(" 0 8\n", " 0 4\n")),
        ];
        for (what, text) in rows {
            reads_as_the_square(what, &text);
        }
    }
    reads_as_the_square("entities behind all", &section_last(SQUARE_41, "Entities", true));
}

#[test]
fn binary_data_in_a_section_that_is_not_needed_decides_nothing() {
    let wanted = mesh_of(SQUARE_41).unwrap();
    let data = [&b"$NodeData\n1\n\"u\"\n"[..], &[0, 10, 36, 69, 255, 10, 36, 10, 128, 36], &[b'$'; 300]].concat();
    for version in ["4.1", "2.2"] {
        for end in [&b"\n$EndNodeData\n"[..], b"\n  $EndNodeData", b""] {
            let bytes = [square_binary(version, false), data.clone(), end.to_vec()].concat();
            let mesh = Mesh::from_msh(&msh::parse(&bytes, "square.msh").unwrap(), "square.msh");
            assert_eq!(mesh.unwrap(), wanted, "{version} {end:?}");
        }
    }
}

#[test]
fn a_needed_section_that_is_cut_off_is_refused_wherever_it_stands() {
    let cut = |text: &str, end: &str| refusal(&text[..text.find(end).unwrap()]);
    let names_last = section_last(SQUARE_22, "PhysicalNames", true);
    let nodes_last = section_last(SQUARE_22, "Nodes", true);
    let entities_last = section_last(SQUARE_41, "Entities", true);
    for sentence in [
        cut(&names_last, "2 7 \"s"),
        cut(&names_last, "$EndPhysicalNames"),
        cut(&nodes_last, "4 0 1 2"),
        cut(&nodes_last, "$Nodes\n5"),
        cut(&entities_last, "$EndEntities"),
        cut(SQUARE_41, "$EndElements"),
    ] {
        assert!(sentence.contains("cut off"), "{sentence}");
    }
}

#[test]
fn many_sections_without_end_take_no_longer_than_their_bytes() {
    // each end is looked up, not searched for: 3 MB in 2e5 sections would else take minutes
    let sections: String = (0..200_000).map(|i| format!("$Section{i}\n\n")).collect();
    let start = std::time::Instant::now();
    reads_as_the_square("many sections", &format!("{SQUARE_22}{sections}"));
    assert!(start.elapsed().as_secs() < 20, "{:?}", start.elapsed());
}

#[test]
fn msh_2_of_all_versions_is_read_and_third_tags_are_no_partitions() {
    for version in ["2", "2.0", "2.1", "2.2", "2.3"] {
        reads_as_the_square(version, &SQUARE_22.replace("2.2 0 8", &format!("{version} 0 8")));
    }
    // in 2.0 names have no dimension: 2 is the name of curves; gmsh 4.15 writes such names with the dimension -1
    for dimension in ["", "-1 "] {
        let names = format!("$PhysicalNames\n2\n{dimension}7 \"sand\"\n{dimension}2 \"loop\"\n$EndPhysicalNames\n");
        let text = section_last(&SQUARE_22.replace("2.2 0", "2 0"), "PhysicalNames", false) + &names;
        let mesh = mesh_of(&text).unwrap();
        let groups: Vec<_> = mesh.groups.iter().map(|g| (g.dimension, g.name.as_str())).collect();
        assert_eq!(groups, [(0, "physical_0_3"), (1, "loop"), (1, "physical_1_1"), (2, "sand")]);
    }
    // a third tag is a partition before 2.2, and says nothing in 2.2 without a fourth
    let tagged = SQUARE_22.replace("5 2 2 7 1", "5 2 3 7 1 1").replace("6 2 2 7 1", "6 2 3 7 1 2");
    reads_as_the_square("3 tags in 2.2", &tagged);
    reads_as_the_square("3 tags in 2.1", &tagged.replace("2.2 0", "2.1 0"));
    // binary is written in 2.0 as in 2.2
    let mut bytes = square_binary("2.2", false);
    bytes[14] = b'0';
    assert!(bytes.starts_with(b"$MeshFormat\n2.0 1 8"));
    assert_eq!(Mesh::from_msh(&msh::parse(&bytes, "x").unwrap(), "square.msh").unwrap(), mesh_of(SQUARE_41).unwrap());
}

/// `SQUARE_41` in MSH 4.0: entity before dimension, boxes of 6 for points, each tag with its coordinates, no ranges.
const SQUARE_40: &str = "$MeshFormat\n4 0 8\n$EndMeshFormat
$PhysicalNames\n4\n1 1 \"base\"\n1 2 \"loop of pipe\"\n2 7 \"s\u{e4}nd\"\n1 9 \"unused\"\n$EndPhysicalNames
$Entities\n1 2 1 0\n5 0 0 0 0 0 0 1 3\n1 0 0 0 1 0 0 2 1 -2 0\n2 1 0 0 1 1 0 0 0\n1 0 0 0 1 1 0 1 7 2 1 -2\n$EndEntities
$Nodes\n1 5\n1 2 0 5\n1 0 0 2\n2 1 0 2\n3 1 1 2\n4 0 1 2\n9 5 5 2\n$EndNodes
$Elements\n4 5\n5 0 15 1\n1 1\n1 1 1 1\n2 1 2\n2 1 1 1\n3 2 3\n1 2 2 2\n4 1 2 3\n5 1 4 3\n$EndElements\n";

#[test]
fn msh_4_0_gives_the_mesh_of_4_1() {
    reads_as_the_square("4.0", SQUARE_40);
    for (broken, wanted) in [
        (SQUARE_40.replace("1 2 0 5\n", "1 2 1 5\n"), "Mesh.SaveParametric = 0"),
        (SQUARE_40.replace("1 2 0 5\n", "1 7 0 5\n"), "the dimension of an entity, 0 to 3, found 7"),
        (SQUARE_40.replace("\n1 5\n", "\n1 6\n"), "6 nodes are announced, but the blocks hold 5"),
    ] {
        let sentence = refusal(&broken);
        assert!(sentence.contains(wanted), "{sentence}");
    }
}

#[test]
fn elements_of_a_file_without_entities_belong_to_no_group_and_the_sentence_says_why() {
    let mesh = mesh_of(&section_last(SQUARE_41, "Entities", false)).unwrap();
    assert_eq!(mesh.cells.len(), 2, "the faces");
    for sentence in [mesh.group("base").unwrap_err().to_string(), mesh.remarks.concat()] {
        assert!(sentence.contains("no section $Entities") && sentence.contains("4 physical groups"), "{sentence}");
    }
    assert!(mesh_of(SQUARE_22).unwrap().remarks.is_empty(), "2.2 has no such section");
}

/// Point "left" at node 4 and curve "left" from 4 to 1, surface "top" and curve "top".
const SHARED_NAMES: &str = "$MeshFormat\n2.2 0 8\n$EndMeshFormat
$PhysicalNames\n5\n0 1 \"left\"\n1 2 \"left\"\n1 3 \"top\"\n2 4 \"top\"\n0 5 \"foot\"\n$EndPhysicalNames
$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n$EndNodes
$Elements\n6\n1 15 2 1 1 4\n2 1 2 2 1 4 1\n3 1 2 3 1 3 4\n4 3 2 4 1 1 2 3 4\n5 15 2 5 1 1\n6 15 2 5 1 2\n$EndElements\n";

#[test]
fn one_name_in_several_dimensions_means_what_its_use_asks_for() {
    let mesh = mesh_of(SHARED_NAMES).unwrap();
    let of = |name: &str, dimension| mesh.group_of(name, dimension, "load").map(|g| mesh.nodes_of(g));
    assert_eq!((of("left", 0).unwrap(), of("left", 1).unwrap()), (vec![3], vec![0, 3]));
    assert_eq!((of("top", 1).unwrap(), of("top", 2).unwrap()), (vec![2, 3], vec![0, 1, 2, 3]));
    assert_eq!(mesh.nodes_of(mesh.group("curve:left").unwrap()), [0, 3]);
    assert_eq!(mesh.nodes_of(mesh.group("point:left").unwrap()), [3]);
    assert_eq!(of("surface:top", 2).unwrap().len(), 4);
    assert_eq!(
        mesh.group("left").unwrap_err().to_string(),
        "\"left\" is a group of points and a group of curves in square.msh, and not all of the same nodes: write \"point:left\" \
         or \"curve:left\""
    );
    let sentence = of("left", 2).unwrap_err().to_string();
    assert_eq!(
        sentence,
        "load \"left\" needs a group of surfaces; in square.msh it is one of points and one of curves"
    );
    // the same nodes in both dimensions: nothing is unclear
    let same = mesh_of(
        &SHARED_NAMES
            .replace("0 5 \"foot\"", "0 5 \"base\"")
            .replace("1 3 \"top\"", "1 3 \"base\"")
            .replace("3 1 2 3 1 3 4", "3 1 2 3 1 1 2"),
    )
    .unwrap();
    assert_eq!(same.nodes_of(same.group("base").unwrap()), [0, 1]);
    // a group that has no elements is not meant
    let empty = mesh_of(&SHARED_NAMES.replace("1 15 2 1 1 4", "1 15 2 5 1 4")).unwrap();
    assert_eq!(empty.nodes_of(empty.group("left").unwrap()), [0, 3]);
    // a group that really has this name comes first
    let real = mesh_of(&SHARED_NAMES.replace("0 5 \"foot\"", "0 5 \"curve:left\"")).unwrap();
    assert_eq!(real.nodes_of(real.group("curve:left").unwrap()), [0, 1]);
}

/// The square's file with the name of its surface in these bytes.
fn named_in(name: &[u8]) -> Mesh {
    let (head, tail) = SQUARE_22.split_once("s\u{e4}nd").unwrap();
    let bytes = [head.as_bytes(), name, tail.as_bytes()].concat();
    Mesh::from_msh(&msh::parse(&bytes, "square.msh").unwrap(), "square.msh").unwrap()
}

#[test]
fn names_in_other_encodings_stay_apart_and_can_be_named() {
    // two words in Latin-1, two in Windows-1251, which the replacement character would make equal
    let names = [&b"s\xe4nd"[..], b"s\xf6nd", b"\xef\xe5\xf1\xee\xea", b"\xe3\xeb\xe8\xed\xe0"];
    for (bytes, name) in names.iter().zip(["s%E4nd", "s%F6nd", "%EF%E5%F1%EE%EA", "%E3%EB%E8%ED%E0"]) {
        assert_eq!(named_in(bytes).group(name).unwrap().cells.len(), 2);
    }
    let two = SQUARE_22.replace("loop of pipe", "s?nd").replace("1 9 \"unused\"", "1 9 \"s!nd\"");
    let bytes: Vec<u8> = two
        .bytes()
        .map(|b| {
            if b == b'?' {
                0xe4
            } else if b == b'!' {
                0xe5
            } else {
                b
            }
        })
        .collect();
    let mesh = Mesh::from_msh(&msh::parse(&bytes, "square.msh").unwrap(), "square.msh").unwrap();
    assert_eq!((mesh.group("s%E4nd").unwrap().cells.len(), mesh.group("s\u{e4}nd").unwrap().cells.len()), (1, 2));
    assert!(mesh.group("s%E5nd").unwrap_err().to_string().contains("has no elements"));
    let sentence = named_in(b"s\xe4nd").group("s\u{e4}nd").unwrap_err().to_string();
    assert!(sentence.contains("it has: base, loop of pipe, physical_0_3, s%E4nd"), "{sentence}");
    assert!(sentence.contains("\"s%E4nd\" is not UTF-8 in the mesh: write it in this form"), "{sentence}");
}

#[test]
fn names_keep_quotes_and_blanks_and_an_empty_name_is_none() {
    let long = "x".repeat(5000);
    for (bytes, name) in [
        ("wet sand", "wet sand"),
        (" sand ", " sand "),
        ("the \"wet\" sand", "the \"wet\" sand"),
        ("", "physical_2_7"),
        (&*long, &*long),
    ] {
        assert!(named_in(bytes.as_bytes()).group(name).is_ok(), "{bytes:?}");
    }
    for (line, name) in [("2 7 sand", "sand"), ("2 7 \"sand\" // a comment", "sand"), ("  2\t7   \"sand\"  ", "sand")] {
        let mesh = mesh_of(&SQUARE_22.replace("2 7 \"s\u{e4}nd\"", line)).unwrap();
        assert!(mesh.group(name).is_ok(), "{line:?}");
    }
    let sentence = named_in(long.as_bytes()).group("sand").unwrap_err().to_string();
    assert!(sentence.len() < 300, "long names are shortened in lists: {sentence}");
}

#[test]
fn names_that_only_look_equal_are_shown_letter_by_letter() {
    let (composed, decomposed) = ("s\u{e4}nd", "sa\u{308}nd");
    for (there, asked) in [(composed, decomposed), (decomposed, composed)] {
        let sentence = named_in(there.as_bytes()).group(asked).unwrap_err().to_string();
        assert!(sentence.contains(r"s\u{e4}nd") && sentence.contains(r"sa\u{308}nd"), "{sentence}");
        assert!(sentence.contains("looks like"), "{sentence}");
    }
    let other = named_in(composed.as_bytes()).group("sand").unwrap_err().to_string();
    assert!(!other.contains("looks like"), "{other}");
}

#[test]
fn files_that_are_no_mesh_are_called_what_they_are_with_a_remedy() {
    let lfs = "version https://git-lfs.github.com/spec/v1\noid sha256:0000\nsize 12345\n";
    let utf_16: Vec<u8> = "\u{feff}$MeshFormat\n".encode_utf16().flat_map(u16::to_le_bytes).collect();
    let rows: [(&[u8], &str, &str); 18] = [
        (lfs.as_bytes(), "Git LFS pointer", "git lfs pull"),
        (b"\n<!DOCTYPE html>\n<html>", "a web page", "download the mesh itself"),
        (b"<html lang=\"en\">$MeshFormat", "a web page", "download the mesh itself"),
        (b"404: Not Found", "failed download", "download"),
        (b"\x1f\x8b\x08\0\0", "gzip", "unpack"),
        (b"PK\x03\x04\x14", "zip archive", "unpack"),
        (b"\xfd7zXZ\0\0", "compressed with xz", "unpack"),
        (b"*HEADING\n*NODE\n1, 0, 0\n", "Abaqus", "gmsh FILE -save -format msh41"),
        (b"** made by hand\n*Node\n", "Abaqus", "gmsh FILE -save -format msh41"),
        (b"# vtk DataFile Version 3.0\nmesh\nASCII\n", "VTK", "-format msh41"),
        (b"<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\">", "VTK", "-format msh41"),
        (b"SetFactory(\"OpenCASCADE\");\nRectangle(1) = {0, 0, 0, 1, 1};\n", "Gmsh script", "gmsh -2"),
        (b"// two layers\nlc = 0.1;\nPoint(1) = {0, 0, 0, lc};\n", "Gmsh script", "geometry.script"),
        (b"\x89HDF\r\n\x1a\n", "HDF5", "convert"),
        (b"(0 \"made by\")\n(2 2)\n", "Fluent", "convert"),
        (b"4 2 4\n0 0 1\n1 0 1\n", "FreeFem", "convert"),
        (&utf_16, "UTF-16", "UTF-8"),
        (
            b"$NOD\n1\n1 0 0 0\n$ENDNOD\n$ELM\n0\n$ENDELM\n",
            "MSH version 1",
            "gmsh x.msh -save -format msh41 -o new.msh",
        ),
    ];
    for (bytes, what, remedy) in rows {
        let sentence = msh::parse(bytes, "x.msh").unwrap_err().to_string();
        assert!(sentence.starts_with("x.msh: ") && sentence.contains(what) && sentence.contains(remedy), "{sentence}");
    }
}

/// A square of two unit quadrangles beside each other, the first with these nodes.
fn quadrangle(nodes: &str, fifth: &str) -> String {
    format!(
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n2 7 \"sand\"\n$EndPhysicalNames\n\
         $Nodes\n5\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 {fifth} 0\n$EndNodes\n\
         $Elements\n1\n12 3 2 7 1 {nodes}\n$EndElements\n"
    )
}

#[test]
fn quadrangles_whose_corners_are_one_are_refused_with_number_group_place_and_remedy() {
    for (text, wanted) in [
        (
            quadrangle("1 2 3 3", "9 9"),
            "element 12 of square.msh has node 3 twice; its corners are (0, 0), (1, 0), (1, 1), (1, 1)",
        ),
        (
            quadrangle("1 2 3 3", "9 9"),
            "a quadrangle of \"sand\"; a quadrangle with a repeated corner is a triangle: write it",
        ),
        (quadrangle("1 2 1 4", "9 9"), "has node 1 twice"),
        (quadrangle("1 2 3 5", "1 1"), "has its nodes 3 and 5 in one place, (1, 1); its corners are"),
        (quadrangle("1 2 3 5", "1 1"), "Coherence Mesh"),
        (quadrangle("1 2 3 5", "1.0000000000001 1"), "has its nodes 3 and 5 in one place"),
        (quadrangle("1 1 3 3", "9 9"), "twice"),
    ] {
        let sentence = refusal(&text);
        assert!(sentence.contains(wanted), "{sentence}\n  should say: {wanted}");
    }
    assert!(mesh_of(&quadrangle("1 2 3 5", "0.001 1")).is_ok());
    // the shortest side of 1e-6 is legal
    assert!(mesh_of(&quadrangle("1 2 3 5", "0.999999 1")).is_ok());
}

#[test]
fn coordinates_in_sentences_never_fill_the_line() {
    let far = quadrangle("1 2 3 5", "1 1").replace("3 1 1 0", "3 1e155 1e155 0").replace("5 1 1 0", "5 1e155 1e155 0");
    let sentence = refusal(&far);
    assert!(sentence.contains("1e155") && sentence.len() < 300, "{sentence}");
    let bent = SQUARE_41.replace("1 1 2\n0 1 2", "1 1 3e200\n0 1 2");
    assert!(refusal(&bent).contains("at z = 3e200"), "{}", refusal(&bent));
}

/// Bytes changed, lines dropped, doubled and exchanged, tails cut off, by a fixed sequence of numbers: the reader ends
/// with a mesh or with a sentence that names the file.
#[test]
fn damaged_files_end_in_a_mesh_or_a_sentence() {
    let mut random = 0x2545_f491_4f6c_dd1d_u64; // xorshift64, Marsaglia (2003)
    let mut below = |limit: usize| {
        random ^= random << 13;
        random ^= random >> 7;
        random ^= random << 17;
        (random % limit.max(1) as u64) as usize
    };
    let mut files = [SQUARE_41, SQUARE_40, SQUARE_22, SHARED_NAMES].map(|s| s.as_bytes().to_vec()).to_vec();
    files.extend(["4.1", "2.2"].iter().flat_map(|v| [square_binary(v, false), square_binary(v, true)]));
    let mut read = 0;
    for round in 0..40_000 {
        let mut lines: Vec<Vec<u8>> =
            files[round % files.len()].split_inclusive(|&b| b == b'\n').map(<[u8]>::to_vec).collect();
        for _ in 0..1 + below(3) {
            let [i, j] = [below(lines.len()), below(lines.len())];
            match below(6) {
                0 => drop(lines.remove(i)),
                1 => lines.insert(j, lines[i].clone()),
                2 => lines.swap(i, j),
                3 => lines.truncate(i + 1),
                4 => {
                    let at = below(lines[i].len());
                    lines[i][at] = below(256) as u8;
                }
                _ => {
                    let digits =
                        ["-1", "0", "99999999999999999999", "1e308", "nan", "9223372036854775807", "\u{1b}[2J"];
                    let at = below(lines[i].len());
                    let word = digits[below(digits.len())].bytes();
                    drop(lines[i].splice(at..at, word));
                }
            }
            if lines.is_empty() {
                lines.push(vec![b'\n']);
            }
        }
        match msh::parse(&lines.concat(), "x.msh").and_then(|msh| Mesh::from_msh(&msh, "x.msh")) {
            Ok(_) => read += 1,
            Err(sentence) => {
                let sentence = sentence.to_string();
                assert!(sentence.contains("x.msh") && sentence.len() < 1000, "{sentence}");
                assert!(!sentence.contains('\u{1b}'), "{sentence:?}");
            }
        }
    }
    assert!(read > 1000, "the damage should leave some files whole: {read}");
}
