//! Files that a user names, read whole into memory, and none of them without end: a device, a pipe that nobody closes or
//! a file that is too large ends in a sentence.

use crate::free_memory::{free_memory, in_words};
use std::fs::File;
use std::io::{Error, ErrorKind, Read, Result};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{RecvTimeoutError, SyncSender, sync_channel};
use std::time::Duration;

/// What a file is read for, which says how large it may be.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    Case,
    /// of a sweep
    Plan,
    /// of a load
    Table,
    /// a Gmsh script, or a file that it includes
    Script,
    Mesh,
    /// what this program writes for itself, such as a summary
    Record,
}

const MIB: u64 = 1 << 20;
/// Memory [bytes] for each byte of a mesh file: the file, its numbers and the mesh made of them. Measured on 1,000 x
/// 1,000 squares: 549 MB for 59 MB of text, 563 MB for 72 MB of binary numbers.
const MEMORY_OF_A_MESH: f64 = 9.;
/// Of a mesh through a pipe, whose size is not known beforehand [bytes]: 36 million nodes as
/// text.
const MESH_THROUGH_A_PIPE: u64 = 2048 * MIB;
/// A pipe may keep silent for so long.
const SILENCE: Duration = Duration::from_secs(10);

impl Kind {
    fn name(self) -> &'static str {
        match self {
            Kind::Case => "a case",
            Kind::Plan => "a plan",
            Kind::Table => "a table",
            Kind::Script => "a script",
            Kind::Mesh => "a mesh",
            Kind::Record => "a record",
        }
    }

    /// [bytes] A case of 64 MiB has a million times and values in it, a table of 256 MiB ten million lines.
    fn most(self) -> u64 {
        match self {
            Kind::Case | Kind::Plan | Kind::Script | Kind::Record => 64 * MIB,
            Kind::Table => 256 * MIB,
            Kind::Mesh => free_memory().map_or(u64::MAX - 1, |free| (free / MEMORY_OF_A_MESH) as u64),
        }
    }
}

/// The bytes of a file.
///
/// Errors: it cannot be read, is a folder or a device, or is too large for its kind.
pub fn read(path: &Path, kind: Kind) -> Result<Vec<u8>> {
    let found = std::fs::metadata(path)?;
    if is_pipe(&found) {
        return from_pipe(path.into(), kind);
    }
    // Reading a folder fails with the system's own words.
    if !found.is_file() && !found.is_dir() {
        return Err(refused(format!("it is a device, and {} is a file", kind.name())));
    }
    let most = kind.most();
    if found.len() > most {
        return Err(too_large(&in_words(found.len() as f64), kind, most));
    }
    let mut bytes = Vec::with_capacity(found.len() as usize);
    // What /proc shows has no size; a file may grow meanwhile.
    File::open(path)?.take(most + 1).read_to_end(&mut bytes)?;
    match bytes.len() as u64 > most {
        true => Err(too_large("more", kind, most)),
        false => Ok(bytes),
    }
}

/// The text of a file.
///
/// Errors: those of [`read`]; it is not UTF-8.
pub fn read_text(path: &Path, kind: Kind) -> Result<String> {
    String::from_utf8(read(path, kind)?).map_err(|why| {
        let byte = why.utf8_error().valid_up_to();
        let line = 1 + why.as_bytes()[..byte].iter().filter(|b| **b == b'\n').count();
        Error::new(ErrorKind::InvalidData, format!("it is no UTF-8 text, first in line {line}"))
    })
}

fn refused(sentence: String) -> Error {
    Error::new(ErrorKind::InvalidInput, sentence)
}

fn too_large(size: &str, kind: Kind, most: u64) -> Error {
    let (name, most) = (kind.name(), in_words(most as f64));
    refused(match kind {
        Kind::Mesh => format!("it has {size}, and the memory that is free is enough for a mesh file of {most}"),
        _ => format!("it has {size}, and {name} may have {most} at most"),
    })
}

fn is_pipe(found: &std::fs::Metadata) -> bool {
    std::os::unix::fs::FileTypeExt::is_fifo(&found.file_type())
}

/// A thread reads, since opening and reading wait for a writer that may never come; it is left behind then.
fn from_pipe(path: PathBuf, kind: Kind) -> Result<Vec<u8>> {
    let most = if kind == Kind::Mesh { kind.most().min(MESH_THROUGH_A_PIPE) } else { kind.most() };
    let (sender, pieces) = sync_channel(1);
    std::thread::Builder::new().name("pipe".into()).spawn(move || send_all(&path, &sender))?;
    let mut bytes = Vec::new();
    loop {
        match pieces.recv_timeout(SILENCE) {
            Ok(piece) => bytes.extend(piece?),
            Err(RecvTimeoutError::Disconnected) => return Ok(bytes),
            Err(RecvTimeoutError::Timeout) => {
                let seconds = SILENCE.as_secs();
                return Err(refused(format!("it is a pipe through which nothing has come for {seconds} seconds")));
            }
        }
        if bytes.len() as u64 > most {
            let (name, most) = (kind.name(), in_words(most as f64));
            return Err(refused(format!("it is a pipe, and {name} through a pipe may have {most} at most")));
        }
    }
}

fn send_all(path: &Path, pieces: &SyncSender<Result<Vec<u8>>>) {
    let mut pipe = match File::open(path) {
        Ok(pipe) => pipe,
        Err(why) => return drop(pieces.send(Err(why))),
    };
    loop {
        let mut piece = vec![0; 1 << 16];
        match pipe.read(&mut piece) {
            Ok(0) => return,
            Ok(count) => {
                piece.truncate(count);
                if pieces.send(Ok(piece)).is_err() {
                    return;
                }
            }
            Err(why) if why.kind() == ErrorKind::Interrupted => {}
            Err(why) => return drop(pieces.send(Err(why))),
        }
    }
}
