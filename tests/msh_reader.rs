//! The mesh reader against Gmsh's own files and hand-written ones. Format: Gmsh reference manual, "Gmsh file formats".

use coralpipe::model::mesh::{Mesh, Shape};
use coralpipe::model::msh::{self, Block, Msh};
use coralpipe::study::gmsh::Gmsh;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::Mutex;

// ---- Gmsh's tutorials -------------------------------------------------------------------------------------------

const FORMATS: [(&str, &str, u8); 4] = [("41a", "4.1", 0), ("41b", "4.1", 1), ("22a", "2.2", 0), ("22b", "2.2", 1)];

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
        for (text, binary) in [("41a", "41b"), ("22a", "22b")] {
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
        for format in ["41b", "22a", "22b"] {
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
        (SQUARE_41.replace("5 1 4 3", "5 1 8 3"), "element 5 of square.msh uses node 8, which is not among its nodes"),
        (SQUARE_41.replace("4\n9\n0", "4\n3\n0"), "node 3 stands twice in square.msh"),
        (SQUARE_41.replace("loop of pipe", "base"), "two physical groups called \"base\", curve 1 and curve 2"),
        (SQUARE_41.replace("1 9 \"unused\"", "0 9 \"base\""), "called \"base\", point 9 and curve 1"),
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
        (SQUARE_41.replace("4.1 0 8", "4 0 8"), "versions 4.1 and 2.2 are read: save the mesh with -format msh41"),
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
        (SQUARE_41.replace("$EndNodeData", ""), "$NodeData has no $EndNodeData"),
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
