//! A .vtu file: vtkio writes the XML, its numbers are appended here.
//!
//! An array is compressed as one block: [blocks, size, size of the last, compressed size], then zlib's stream. What all
//! frames share is compressed once, so it may take its time; what each frame brings must not keep the solver waiting:
//! fdeflate takes a fifth of the time of zlib at its quickest, and bytes as they are, not in base64, make up for what
//! it leaves.

use bytemuck::Pod;
use flate2::{Compression, write::ZlibEncoder};
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
    arrays: Vec<Vec<u8>>,
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
            arrays: arrays.map(|bytes| zlib(bytes, Compression::default())).into(),
        }
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
    compressed: Vec<Vec<u8>>,
}

impl Arrays {
    fn push<T: Pod>(&mut self, attribute: Attribute, values: &[T])
    where
        Vec<T>: Into<IOBuffer>,
    {
        self.attributes.push(attribute.with_data(Vec::<T>::new()));
        self.compressed.push(quick(bytemuck::cast_slice(values)));
    }
}

impl File<'_> {
    pub fn new(base: &Base) -> File<'_> {
        File { base, point: Arrays::default(), cell: Arrays::default() }
    }

    /// Adds an array with `values` for each point.
    pub fn point<T: Pod>(&mut self, attribute: Attribute, values: &[T])
    where
        Vec<T>: Into<IOBuffer>,
    {
        self.point.push(attribute, values);
    }

    /// Adds an array with `values` for each cell.
    pub fn cell<T: Pod>(&mut self, attribute: Attribute, values: &[T])
    where
        Vec<T>: Into<IOBuffer>,
    {
        self.cell.push(attribute, values);
    }

    /// The file.
    pub fn bytes(self) -> Result<Vec<u8>, xml::Error> {
        let arrays = [&self.point.compressed, &self.cell.compressed, &self.base.arrays].into_iter().flatten();
        let xml = form(self.base, self.point.attributes, self.cell.attributes)?;
        Ok(with_appended(&xml, arrays))
    }
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
    Ok(xml.replacen("<Piece", &counts, 1))
}

/// `xml` with its arrays at its end, and where they begin there instead of what they held. For meshio they have to
/// stand in their order without gaps, and a line has to end after the last.
fn with_appended<'a>(xml: &str, arrays: impl Iterator<Item = &'a Vec<u8>> + Clone) -> Vec<u8> {
    const INLINE: &str = " format=\"binary\"";
    const END: &str = "</DataArray>";
    let length = arrays.clone().map(Vec::len).sum::<usize>();
    let mut bytes = Vec::with_capacity(2 * xml.len() + length);
    let (mut left, mut offset) = (xml, 0);
    for array in arrays.clone() {
        let (with_old, after) = left.split_once(END).expect("vtkio writes every array it is given");
        let (before, attributes) = with_old.rsplit_once(INLINE).expect("vtkio writes arrays inline");
        // base64 has no `>`
        let (attributes, _) = attributes.split_once('>').expect("a tag has an end");
        let tag = format!("{before} format=\"appended\" offset=\"{offset}\"{attributes}>{END}");
        bytes.extend(tag.as_bytes());
        (left, offset) = (after, offset + array.len());
    }
    let (rest, _) = left.rsplit_once("</VTKFile>").expect("vtkio writes a whole file");
    bytes.extend(rest.as_bytes());
    bytes.extend(b"<AppendedData encoding=\"raw\">\n_");
    arrays.for_each(|array| bytes.extend(array));
    bytes.extend(b"\n</AppendedData></VTKFile>");
    bytes
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
