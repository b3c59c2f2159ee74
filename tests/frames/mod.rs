//! Frames as vtkio reads them, which knows arrays in base64 only.

use base64::prelude::{BASE64_STANDARD, Engine as _};
use vtkio::Vtk;
use vtkio::model::{DataSet, Piece, UnstructuredGridPiece};
use vtkio::xml::VTKFile;

/// What stands in a .vtu file, or why it is none.
pub fn piece(file: &[u8]) -> Result<UnstructuredGridPiece, String> {
    let text = inline(file).ok_or("its arrays are not where they should be")?;
    let read = VTKFile::parse(text.as_bytes()).and_then(Vtk::try_from).map_err(|e| format!("{e:?}"))?;
    match read.data {
        DataSet::UnstructuredGrid { mut pieces, .. } => match pieces.swap_remove(0) {
            Piece::Inline(piece) => Ok(*piece),
            _ => Err("it has no piece of its own".into()),
        },
        _ => Err("another kind of grid".into()),
    }
}

/// The file with its arrays, which are appended as bytes, in base64 where they are named.
fn inline(file: &[u8]) -> Option<String> {
    let begin = file.windows(2).position(|at| at == b"\n_")?;
    let (xml, appended) = (std::str::from_utf8(&file[..begin]).ok()?, &file[begin + 2..]);
    // field data have their numbers with them, and vtkio leaves them aside
    let xml = match xml.split_once("<FieldData>") {
        Some((before, after)) => &(before.to_string() + after.split_once("</FieldData>")?.1),
        None => xml,
    };
    let (arrays, end) = xml.rsplit_once("</DataArray>")?;
    let (mut text, mut expected) = (String::new(), 0);
    for array in arrays.split("</DataArray>") {
        let (before, offset) = array.split_once(" format=\"appended\" offset=\"")?;
        let (offset, _) = offset.split_once('"')?;
        // one block: [1, size, size, compressed size]
        let (header, stream) = appended.get(offset.parse().ok()?..)?.split_at_checked(32)?;
        let size = u64::from_ne_bytes(header[24..].try_into().ok()?) as usize;
        // meshio wants them one right after the other
        (offset == expected.to_string()).then_some(())?;
        expected += header.len() + size;
        let [header, stream] = [header, stream.get(..size)?].map(|part| BASE64_STANDARD.encode(part));
        text += &format!("{before} format=\"binary\">{header}{stream}</DataArray>");
    }
    (&appended[expected..] == b"\n</AppendedData></VTKFile>").then_some(())?;
    Some(text + end.strip_suffix("<AppendedData encoding=\"raw\">")? + "</VTKFile>")
}
