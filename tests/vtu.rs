//! What other programs find in a .vtu file.

mod frames;

use coralpipe::results::vtu::{Base, File};
use vtkio::model::{Attribute, CellType, IOBuffer, VertexNumbers};

/// Where the arrays of a file begin.
fn offsets_of(file: &[u8]) -> Vec<usize> {
    let text = String::from_utf8_lossy(file);
    text.split(" offset=\"").skip(1).map(|rest| rest.split('"').next().unwrap().parse().unwrap()).collect()
}

/// meshio gives each array that it has read the offset which it has in base64, a multiple of 4, and then looks for the
/// next one by its offset in the file: the first array with that number. 40 arrays of lengths 1 to 40 and of all kinds of
/// content begin anywhere but there, and are read back.
#[test]
fn no_array_begins_where_meshio_would_take_another_for_it() {
    let base = Base::new(&[[0.; 3]; 40], &[0, 1], &[2], &[CellType::Line]);
    let mut file = File::new(&base);
    let values = |n: usize| (0..40).map(|i| if i < n { (i * n) as f64 / 7. } else { 0. }).collect::<Vec<_>>();
    (0..40).for_each(|n| file.point(Attribute::scalars(format!("a{n}"), 1), "", &values(n)));
    let bytes = file.bytes().unwrap();
    let offsets = offsets_of(&bytes);
    assert_eq!((offsets.len(), offsets[0]), (44, 0));
    assert!(offsets[1..].iter().all(|offset| offset % 4 != 0), "{offsets:?}");
    let piece = frames::piece(&bytes).unwrap();
    for (n, attribute) in piece.data.point.iter().enumerate() {
        let Attribute::DataArray(array) = attribute else { panic!("no array") };
        assert_eq!(array.data, IOBuffer::F64(values(n)));
    }
}

/// As many points as fill blocks of 32 KiB exactly; numbers without zeros, which stay as they are, some with, a
/// constant.
#[test]
fn what_another_reader_finds_is_what_was_given() {
    let scattered = |i: usize| (i as f64 + 0.5).powf(1.7).sin() * 10f64.powi(i as i32 % 50 - 25);
    let points: Vec<[f64; 3]> = (0..4096).map(|i| [scattered(i), scattered(i + 7), 0.]).collect();
    let connectivity: Vec<u64> = (0..4095).flat_map(|i| [i, i + 1]).collect();
    let offsets: Vec<u64> = (1..4096).map(|i| 2 * i).collect();
    let values: Vec<f64> = (0..4096).map(scattered).collect();
    let single: Vec<f32> = (0..3 * 4096).map(|i| scattered(i) as f32).collect();
    let some: Vec<f64> = (0..4095).map(|i| if i % 3 == 0 { scattered(i) } else { 0. }).collect();
    let constant = vec![7i32; 4095];

    let mut base = Base::new(&points, &connectivity, &offsets, &[CellType::Line; 4095]);
    let member: Vec<u8> = (0..4096).map(|i| u8::from(i % 7 == 0)).collect();
    base.point(Attribute::scalars("group_<a> & \"b\"", 1), "", &member);
    base.cell(Attribute::scalars("kind", 1), "1 < 2", &constant);
    base.field("note: <a> & b", &[1]);
    let mut file = File::new(&base);
    file.point(Attribute::scalars("values", 1), "Pa", &values);
    file.point(Attribute::vectors("single"), "m", &single);
    file.cell(Attribute::scalars("some", 1), "m", &some);
    file.cell(Attribute::scalars("constant", 1), "", &constant);
    let bytes = file.bytes().unwrap();
    // the points' thirds of zeros and what surely counts up are in these too
    let raw = [size_of_val(&values[..]), size_of_val(&single[..]), size_of_val(&some[..]), size_of_val(&constant[..])];
    let [kept, of_some, of_constant] = [raw[0] + raw[1], raw[2], raw[3]];
    let empty = File::new(&base).bytes().unwrap().len();
    let added = bytes.len() - empty;
    assert!(
        added < kept + of_some / 4 * 3 + of_constant / 4 && added > kept,
        "{added} of {kept}, {of_some}, {of_constant}"
    );

    // the XML stands before the numbers
    let xml = String::from_utf8_lossy(&bytes[..bytes.windows(13).position(|at| at == b"<AppendedData").unwrap()]);
    for index in ["connectivity", "offsets"] {
        // meshio mixes unsigned offsets with signed numbers and gets floating-point node numbers (nschloe/meshio#831)
        assert!(xml.contains(&format!("type=\"Int64\" Name=\"{index}\"")), "{xml}");
    }
    assert!(!xml.contains("UInt64\" Name"), "{xml}");

    let piece = frames::piece(&bytes).unwrap();
    let found = |data: &[Attribute], i: usize| match &data[i] {
        Attribute::DataArray(array) => (array.name.clone(), array.data.clone()),
        Attribute::Field { .. } => panic!("no array"),
    };
    assert_eq!(piece.points, IOBuffer::F64(points.into_flattened()));
    assert_eq!(piece.cells.cell_verts, VertexNumbers::XML { connectivity, offsets });
    assert_eq!(piece.cells.types, [CellType::Line; 4095]);
    assert_eq!(found(&piece.data.point, 0), ("values".into(), IOBuffer::F64(values)));
    assert_eq!(found(&piece.data.point, 1), ("single".into(), IOBuffer::F32(single)));
    assert_eq!(found(&piece.data.cell, 0), ("some".into(), IOBuffer::F64(some)));
    assert_eq!(found(&piece.data.cell, 1), ("constant".into(), IOBuffer::I32(constant.clone())));
    // what all files share stands behind what is a file's own
    assert_eq!(found(&piece.data.point, 2), ("group_<a> & \"b\"".into(), IOBuffer::U8(member)));
    assert_eq!(found(&piece.data.cell, 2), ("kind".into(), IOBuffer::I32(constant)));
    let unit =
        |unit: &str| format!("<InformationKey name=\"UNITS_LABEL\" location=\"vtkDataArray\">{unit}</InformationKey>");
    for (unit, count) in [(unit("Pa"), 1), (unit("m"), 3), (unit("1 &lt; 2"), 1)] {
        assert_eq!(xml.matches(&unit).count(), count, "{unit} in {xml}");
    }
    assert!(xml.contains("Name=\"note: &lt;a&gt; &amp; b\" NumberOfTuples=\"1\" format=\"ascii\">1<"), "{xml}");
}
