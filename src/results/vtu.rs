//! A .vtu file: vtkio writes the XML, its numbers are appended here.
//!
//! An array is compressed as one block: [blocks, size, size of the last, compressed size], then zlib's stream. What all
//! frames share is compressed once, so it may take its time; what each frame brings must not keep the solver waiting:
//! fdeflate takes a fifth of the time of zlib at its quickest, and bytes as they are, not in base64, make up for what
//! it leaves.

use super::xml_text::escaped;
use bytemuck::Pod;
use flate2::{Compression, write::ZlibEncoder};
use std::borrow::Cow;
use std::io::Write as _;
use vtkio::model::{
    Attribute, Attributes, ByteOrder, CellType, Cells, DataSet, IOBuffer, Piece, UnstructuredGridPiece, Version,
    VertexNumbers, Vtk,
};
use vtkio::xml::{self, Compressor};

/// What all files of a series share, compressed.
pub struct Base {
    point_count: usize,
    cell_count: usize,
    /// points, connectivity, offsets, types
    geometry: Vec<Vec<u8>>,
    /// arrays whose values do not change from file to file
    point: Arrays,
    cell: Arrays,
    /// elements of the grid's field data
    field: String,
}

impl Base {
    /// `points` in space [m]; `connectivity`: nodes of all cells; `offsets`: where each cell's end.
    pub fn new(points: &[[f64; 3]], connectivity: &[u64], offsets: &[u64], types: &[CellType]) -> Base {
        let types: Vec<u8> = types.iter().map(|&cell_type| cell_type as u8).collect();
        let arrays: [&[u8]; 4] =
            [bytemuck::cast_slice(points), bytemuck::cast_slice(connectivity), bytemuck::cast_slice(offsets), &types];
        Base {
            point_count: points.len(),
            cell_count: types.len(),
            geometry: arrays.map(|bytes| zlib(bytes, Compression::default())).into(),
            point: Arrays::default(),
            cell: Arrays::default(),
            field: String::new(),
        }
    }

    /// Adds an array to all files, with `values` for each point; `unit` as in [`File::point`].
    pub fn point<T: Pod>(&mut self, attribute: Attribute, unit: &str, values: &[T])
    where
        Vec<T>: Into<IOBuffer>,
    {
        let compressed = zlib(bytemuck::cast_slice(values), Compression::default());
        self.point.push::<T>(attribute, unit, compressed);
    }

    /// Adds an array to all files, with `values` for each cell; `unit` as in [`File::point`].
    pub fn cell<T: Pod>(&mut self, attribute: Attribute, unit: &str, values: &[T])
    where
        Vec<T>: Into<IOBuffer>,
    {
        let compressed = zlib(bytemuck::cast_slice(values), Compression::default());
        self.cell.push::<T>(attribute, unit, compressed);
    }

    /// Adds integers under a name to the field data of all files. Texts would be an array of strings, which meshio
    /// refuses, and with it the file; so what is to be read stands in names.
    pub fn field(&mut self, name: &str, values: &[i32]) {
        let (name, count) = (escaped(name), values.len());
        let values: Vec<String> = values.iter().map(ToString::to_string).collect();
        self.field += &format!(
            "<DataArray type=\"Int32\" Name=\"{name}\" NumberOfTuples=\"{count}\" format=\"ascii\">{}</DataArray>",
            values.join(" ")
        );
    }
}

/// A file in the making: arrays are given in the order in which they are to stand there.
pub struct File<'a> {
    base: &'a Base,
    point: Arrays,
    cell: Arrays,
}

#[derive(Default)]
struct Arrays {
    /// name and kind, without data
    attributes: Vec<Attribute>,
    units: Vec<String>,
    compressed: Vec<Vec<u8>>,
}

impl Arrays {
    fn push<T>(&mut self, attribute: Attribute, unit: &str, compressed: Vec<u8>)
    where
        Vec<T>: Into<IOBuffer>,
    {
        self.attributes.push(attribute.with_data(Vec::<T>::new()));
        self.units.push(unit.into());
        self.compressed.push(compressed);
    }
}

impl File<'_> {
    pub fn new(base: &Base) -> File<'_> {
        File { base, point: Arrays::default(), cell: Arrays::default() }
    }

    /// Adds an array with `values` for each point. `unit`, or what numbers mean, goes where VTK keeps it, in the array's
    /// information under `vtkDataArray::UNITS_LABEL`; none where it is empty.
    pub fn point<T: Pod>(&mut self, attribute: Attribute, unit: &str, values: &[T])
    where
        Vec<T>: Into<IOBuffer>,
    {
        self.point.push::<T>(attribute, unit, quick(bytemuck::cast_slice(values)));
    }

    /// Adds an array with `values` for each cell; `unit` as in [`File::point`].
    pub fn cell<T: Pod>(&mut self, attribute: Attribute, unit: &str, values: &[T])
    where
        Vec<T>: Into<IOBuffer>,
    {
        self.cell.push::<T>(attribute, unit, quick(bytemuck::cast_slice(values)));
    }

    /// The file: what is its own before what it shares with others.
    pub fn bytes(self) -> Result<Vec<u8>, xml::Error> {
        let File { base, point, cell } = self;
        let groups = [&point, &base.point, &cell, &base.cell];
        let units = groups.into_iter().flat_map(|arrays| arrays.units.iter().map(String::as_str));
        let arrays = groups.into_iter().flat_map(|arrays| &arrays.compressed).chain(&base.geometry);
        let arrays: Vec<Appended> =
            units.chain(["m", "", "", ""]).zip(arrays).map(|(unit, bytes)| Appended { unit, bytes }).collect();
        let all = |own: &Arrays, shared: &Arrays| [&own.attributes[..], &shared.attributes].concat();
        Ok(with_appended(&form(base, all(&point, &base.point), all(&cell, &base.cell))?, &arrays))
    }
}

/// An array's bytes, which stand behind the XML.
struct Appended<'a> {
    /// empty where there is none
    unit: &'a str,
    bytes: &'a Vec<u8>,
}

/// The file without numbers.
fn form(base: &Base, point: Vec<Attribute>, cell: Vec<Attribute>) -> Result<String, xml::Error> {
    let empty = UnstructuredGridPiece {
        points: IOBuffer::F64(vec![]),
        cells: Cells { cell_verts: VertexNumbers::XML { connectivity: vec![], offsets: vec![] }, types: vec![] },
        data: Attributes { point, cell },
    };
    let vtk = Vtk {
        version: Version::new_xml(1, 0),
        title: String::new(),
        byte_order: if cfg!(target_endian = "little") { ByteOrder::LittleEndian } else { ByteOrder::BigEndian },
        data: DataSet::UnstructuredGrid { meta: None, pieces: vec![Piece::Inline(Box::new(empty))] },
        file_path: None,
    };
    let xml = vtk.try_into_xml_format(Compressor::ZLib, 1)?.to_string();
    // vtkio counts what it is given, and leaves out a count of zero
    let counts = format!("<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\"", base.point_count, base.cell_count);
    let field = match base.field.is_empty() {
        true => String::new(),
        false => format!("<FieldData>{}</FieldData>", base.field),
    };
    Ok(with_signed_indices(xml.replacen("<Piece", &(field + &counts), 1)))
}

/// Connectivity and offsets as Int64, the type that VTK and ParaView write: meshio adds unsigned offsets to signed
/// numbers, gets floating-point node numbers and can neither index with them nor convert the file. vtkio writes UInt64;
/// the bytes of both types are equal below 2^63.
fn with_signed_indices(xml: String) -> String {
    ["connectivity", "offsets"].into_iter().fold(xml, |xml, name| {
        let unsigned = format!("type=\"UInt64\" Name=\"{name}\"");
        debug_assert!(xml.contains(&unsigned), "vtkio writes {name} as UInt64");
        xml.replacen(&unsigned, &format!("type=\"Int64\" Name=\"{name}\""), 1)
    })
}

/// `xml` with its arrays at its end, and where they begin there instead of what they held. For meshio they have to
/// stand in their order without gaps, and a line has to end after the last.
fn with_appended(xml: &str, arrays: &[Appended]) -> Vec<u8> {
    const INLINE: &str = " format=\"binary\"";
    const END: &str = "</DataArray>";
    let length = arrays.iter().map(|array| array.bytes.len() + array.unit.len()).sum::<usize>();
    let mut bytes = Vec::with_capacity(4 * xml.len() + 2 * length);
    let (head, mut left) = xml.split_at(xml.find("<Piece").expect("a grid has a piece"));
    bytes.extend(head.as_bytes());
    let (mut offset, mut appended) = (0, Vec::with_capacity(length));
    for Appended { unit, bytes: array } in arrays {
        let (with_old, after) = left.split_once(END).expect("vtkio writes every array it is given");
        let (before, attributes) = with_old.rsplit_once(INLINE).expect("vtkio writes arrays inline");
        // base64 has no `>`
        let (attributes, _) = attributes.split_once('>').expect("a tag has an end");
        let unit = information(unit);
        let tag = format!("{before} format=\"appended\" offset=\"{offset}\"{attributes}>{unit}{END}");
        bytes.extend(tag.as_bytes());
        let next_at_multiple = (offset + array.len()).is_multiple_of(4);
        let array = if next_at_multiple { Cow::Owned(lengthened(array)) } else { Cow::Borrowed(&array[..]) };
        appended.extend_from_slice(&array);
        (left, offset) = (after, appended.len());
    }
    let (rest, _) = left.rsplit_once("</VTKFile>").expect("vtkio writes a whole file");
    bytes.extend(rest.as_bytes());
    bytes.extend(b"<AppendedData encoding=\"raw\">\n_");
    bytes.extend(appended);
    bytes.extend(b"\n</AppendedData></VTKFile>");
    bytes
}

/// A compressed array with an empty stored block of five bytes at the beginning of its stream (RFC 1951, 3.2.4).
///
/// meshio looks an array up by its offset and then writes another offset over it, that of the array in base64, a multiple
/// of 4: where a later array begins at that very number, it takes the earlier one for it. So none but the first begins
/// at a multiple of 4.
fn lengthened(array: &[u8]) -> Vec<u8> {
    const EMPTY: [u8; 5] = [0, 0, 0, 0xff, 0xff];
    let (header, stream) = array.split_at(4 * size_of::<u64>());
    let (header, size) = header.split_at(3 * size_of::<u64>());
    let size = u64::from_ne_bytes(size.try_into().expect("a header ends with the size of the stream"));
    // zlib's own header has two bytes
    let (start, blocks) = stream.split_at(2);
    [header, &(size + EMPTY.len() as u64).to_ne_bytes(), start, &EMPTY, blocks].concat()
}

/// How VTK keeps the unit of an array.
fn information(unit: &str) -> String {
    match unit {
        "" => String::new(),
        _ => {
            format!("<InformationKey name=\"UNITS_LABEL\" location=\"vtkDataArray\">{}</InformationKey>", escaped(unit))
        }
    }
}

/// In little time. fdeflate's code has short words for zeros and long ones for all else: numbers without zeros would
/// grow by a third or more, and are better left alone.
fn quick(bytes: &[u8]) -> Vec<u8> {
    let stream = fdeflate::compress_to_vec(bytes);
    if stream.len() <= bytes.len() { block(bytes.len(), &stream) } else { zlib(bytes, Compression::none()) }
}

fn zlib(bytes: &[u8], level: Compression) -> Vec<u8> {
    let mut encoder = ZlibEncoder::new(vec![], level);
    let stream = encoder.write_all(bytes).and_then(|()| encoder.finish());
    block(bytes.len(), &stream.expect("memory takes all bytes"))
}

/// A compressed array of `length` bytes with its header.
fn block(length: usize, stream: &[u8]) -> Vec<u8> {
    let header = [1, length, length, stream.len()].map(|n| n as u64);
    [bytemuck::bytes_of(&header), stream].concat()
}
