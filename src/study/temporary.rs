//! Files on their way to a place where readers look for whole ones: `meshes/.x.msh.4711`, renamed to `meshes/x.msh`.

use crate::model::msh::file_name;
use crate::results::file::remove_parts_of;
use std::fs::{File, TryLockError};
use std::io::{self, ErrorKind, Write};
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};

/// An empty file beside `file` that other programs may fill; it goes away with this value unless it was renamed.
pub(super) struct Temporary {
    path: PathBuf,
    /// locked as long as this process lives, so that no other one clears it away; none where the disk knows no locks
    _lock: Option<File>,
}

impl Temporary {
    pub fn beside(file: &Path) -> io::Result<Temporary> {
        let path = file.with_file_name(format!(".{}.{}", file_name(file), std::process::id()));
        loop {
            let created = File::options().create(true).append(true).open(&path)?;
            let lock = match created.try_lock() {
                Ok(()) => Some(created),
                Err(TryLockError::Error(_)) => None,
                Err(TryLockError::WouldBlock) => {
                    return Err(io::Error::other(format!("another process is writing {}", path.display())));
                }
            };
            // a process that clears leftovers may have removed it before it was locked
            if lock.as_ref().is_none_or(|lock| is_at(lock, &path)) {
                std::fs::write(&path, "")?;
                return Ok(Temporary { path, _lock: lock });
            }
        }
    }

    pub fn path(&self) -> &Path {
        &self.path
    }

    pub fn rename(self, file: &Path) -> io::Result<()> {
        std::fs::rename(&self.path, file)
    }

    /// Why nothing more can be written into the folder; none if it can.
    pub fn fullness(&self) -> Option<io::Error> {
        // more than the last block that a program may have found too small
        let probe = [0; 1 << 16];
        let append = |mut file: File| file.write_all(&probe).and_then(|()| file.sync_data());
        File::options().append(true).create(true).open(&self.path).and_then(append).err().filter(is_full)
    }
}

impl Drop for Temporary {
    fn drop(&mut self) {
        // already gone if it was renamed
        let _ = std::fs::remove_file(&self.path);
    }
}

/// A full disk, a quota, or a limit on the size of a file.
pub(super) fn is_full(e: &io::Error) -> bool {
    matches!(e.kind(), ErrorKind::StorageFull | ErrorKind::QuotaExceeded | ErrorKind::FileTooLarge)
}

/// Removes what processes that no longer live have left in the folder of a mesh.
pub(super) fn remove_leftovers(mesh: &Path) {
    let folder = mesh.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
        let is_ours = entry.file_name().to_str().is_some_and(is_temporary);
        // locked by a process that still writes it, or on a disk without locks: left alone
        if is_ours && File::open(entry.path()).is_ok_and(|file| file.try_lock().is_ok()) {
            let _ = std::fs::remove_file(entry.path());
        }
    }
    remove_parts_of(&mesh.with_extension("orders"));
}

/// `.x.msh.4711` and `.x.json.4711`: a mesh and its record.
fn is_temporary(name: &str) -> bool {
    let Some((file, process)) = name.rsplit_once('.') else { return false };
    let is_number = !process.is_empty() && process.bytes().all(|b| b.is_ascii_digit());
    is_number
        && file.starts_with('.')
        && file.len() > ".msh".len() + 1
        && [".msh", ".json"].iter().any(|e| file.ends_with(e))
}

fn is_at(file: &File, path: &Path) -> bool {
    let identity = |m: std::fs::Metadata| (m.dev(), m.ino());
    matches!((file.metadata().map(identity), path.metadata().map(identity)), (Ok(a), Ok(b)) if a == b)
}
