//! The text of a .vtu file: vtkio writes the XML, its numbers are encoded here.
//!
//! An array is inline base64: [blocks, size, size of the last, compressed size], then zlib's stream at its quickest.
//! Here it is a single block, and what all frames share is encoded once.

use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use bytemuck::Pod;
use flate2::{Compress, Compression, FlushCompress, Status};
use vtkio::model::{
    Attribute, Attributes, ByteOrder, CellType, Cells, DataSet, IOBuffer, Piece, UnstructuredGridPiece, Version,
    VertexNumbers, Vtk,
};
use vtkio::xml::{self, Compressor};

/// What all files of a series share, encoded.
pub struct Base {
    point_count: usize,
    cell_count: usize,
    /// points, connectivity, offsets, types
    arrays: Vec<String>,
}

impl Base {
    /// `points` in space [m]; `connectivity`: nodes of all cells; `offsets`: where each cell's end.
    pub fn new(points: &[[f64; 3]], connectivity: &[u64], offsets: &[u64], types: &[CellType]) -> Base {
        let types: Vec<u8> = types.iter().map(|&cell_type| cell_type as u8).collect();
        let mut zlib = Compress::new(Compression::default(), true);
        Base {
            point_count: points.len(),
            cell_count: types.len(),
            arrays: vec![
                encoded(&mut zlib, bytemuck::cast_slice(points)),
                encoded(&mut zlib, bytemuck::cast_slice(connectivity)),
                encoded(&mut zlib, bytemuck::cast_slice(offsets)),
                encoded(&mut zlib, &types),
            ],
        }
    }
}

/// A file in the making: arrays are given in the order in which they are to stand there.
pub struct File<'a> {
    base: &'a Base,
    zlib: Compress,
    point: Arrays,
    cell: Arrays,
}

#[derive(Default)]
struct Arrays {
    /// name and kind, without data
    attributes: Vec<Attribute>,
    encoded: Vec<String>,
}

impl File<'_> {
    pub fn new(base: &Base) -> File<'_> {
        let zlib = Compress::new(Compression::fast(), true);
        File { base, zlib, point: Arrays::default(), cell: Arrays::default() }
    }

    /// Adds an array with `values` for each point.
    pub fn point<T: Pod>(&mut self, attribute: Attribute, values: &[T])
    where
        Vec<T>: Into<IOBuffer>,
    {
        self.point.attributes.push(attribute.with_data(Vec::<T>::new()));
        self.point.encoded.push(encoded(&mut self.zlib, bytemuck::cast_slice(values)));
    }

    /// Adds an array with `values` for each cell.
    pub fn cell<T: Pod>(&mut self, attribute: Attribute, values: &[T])
    where
        Vec<T>: Into<IOBuffer>,
    {
        self.cell.attributes.push(attribute.with_data(Vec::<T>::new()));
        self.cell.encoded.push(encoded(&mut self.zlib, bytemuck::cast_slice(values)));
    }

    /// The file.
    pub fn text(self) -> Result<String, xml::Error> {
        let arrays = [&self.point.encoded, &self.cell.encoded, &self.base.arrays].into_iter().flatten();
        let xml = form(self.base, self.point.attributes, self.cell.attributes)?;
        Ok(filled(&xml, arrays))
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

/// `xml` with other text in its arrays, one after the other.
fn filled<'a>(xml: &str, arrays: impl Iterator<Item = &'a String> + Clone) -> String {
    const END: &str = "</DataArray>";
    let mut text = String::with_capacity(xml.len() + arrays.clone().map(String::len).sum::<usize>());
    let mut left = xml;
    for array in arrays {
        let (with_old, after) = left.split_once(END).expect("vtkio writes every array it is given");
        // base64 has no `>`
        let tag = with_old.rfind('>').map_or("", |end| &with_old[..=end]);
        text.extend([tag, array, END]);
        left = after;
    }
    text + left
}

fn encoded(zlib: &mut Compress, bytes: &[u8]) -> String {
    // the quickest level adds at most an eighth
    let mut stream = Vec::with_capacity(bytes.len() + bytes.len() / 8 + 64);
    zlib.reset();
    loop {
        let left = &bytes[zlib.total_in() as usize..];
        match zlib.compress_vec(left, &mut stream, FlushCompress::Finish).expect("a new stream takes all bytes") {
            Status::StreamEnd => break,
            Status::Ok | Status::BufError => stream.reserve(stream.capacity() / 2 + 64),
        }
    }
    let header = [1, bytes.len(), bytes.len(), stream.len()].map(|n| n as u64);
    let mut text = String::with_capacity(4 * (stream.len() / 3 + 1) + 44);
    BASE64_STANDARD.encode_string(bytemuck::bytes_of(&header), &mut text);
    BASE64_STANDARD.encode_string(stream, &mut text);
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use vtkio::xml::VTKFile;

    /// As many points as fill blocks of 32 KiB exactly, numbers that zlib cannot make smaller, and a constant.
    #[test]
    fn what_another_reader_finds_is_what_was_given() {
        let scattered = |i: usize| (i as f64 + 0.5).powf(1.7).sin() * 10f64.powi(i as i32 % 50 - 25);
        let points: Vec<[f64; 3]> = (0..4096).map(|i| [scattered(i), scattered(i + 7), 0.]).collect();
        let connectivity: Vec<u64> = (0..4095).flat_map(|i| [i, i + 1]).collect();
        let offsets: Vec<u64> = (1..4096).map(|i| 2 * i).collect();
        let values: Vec<f64> = (0..4096).map(scattered).collect();
        let single: Vec<f32> = (0..3 * 4096).map(|i| scattered(i) as f32).collect();
        let constant = vec![7i32; 4095];

        let base = Base::new(&points, &connectivity, &offsets, &[CellType::Line; 4095]);
        let mut file = File::new(&base);
        file.point(Attribute::scalars("values", 1), &values);
        file.point(Attribute::vectors("single"), &single);
        file.cell(Attribute::scalars("constant", 1), &constant);
        let text = file.text().unwrap();

        let read = Vtk::try_from(VTKFile::parse(text.as_bytes()).unwrap()).unwrap();
        let DataSet::UnstructuredGrid { pieces, .. } = read.data else { panic!("another kind of grid") };
        let Piece::Inline(piece) = &pieces[0] else { panic!("no piece") };
        let found = |data: &[Attribute], i: usize| match &data[i] {
            Attribute::DataArray(array) => (array.name.clone(), array.data.clone()),
            Attribute::Field { .. } => panic!("no array"),
        };
        assert_eq!(piece.points, IOBuffer::F64(points.into_flattened()));
        assert_eq!(piece.cells.cell_verts, VertexNumbers::XML { connectivity, offsets });
        assert_eq!(piece.cells.types, [CellType::Line; 4095]);
        assert_eq!(found(&piece.data.point, 0), ("values".into(), IOBuffer::F64(values)));
        assert_eq!(found(&piece.data.point, 1), ("single".into(), IOBuffer::F32(single)));
        assert_eq!(found(&piece.data.cell, 0), ("constant".into(), IOBuffer::I32(constant)));
    }
}
