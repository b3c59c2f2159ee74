//! A table that grows: a kill at any moment, or a disk that is full, leaves whole lines.

use super::file;
use crate::Result;
use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};

pub struct Lines {
    path: PathBuf,
    file: File,
    /// whole lines not yet written
    pub waiting: String,
    /// [bytes]
    written: u64,
}

impl Lines {
    /// Makes the file, with `header`, which is a whole line, waiting.
    pub fn create(path: &Path, header: String) -> Result<Lines> {
        let file = File::create(path).map_err(|e| file::not_written(path, &e))?;
        Ok(Lines { path: path.into(), file, waiting: header, written: 0 })
    }

    /// Writes the lines that wait, all or none of them.
    pub fn flush(&mut self) -> Result<()> {
        let lines = std::mem::take(&mut self.waiting);
        match self.file.write_all(lines.as_bytes()) {
            Ok(()) => {
                self.written += lines.len() as u64;
                Ok(())
            }
            Err(e) => {
                let _ = self.file.set_len(self.written);
                Err(file::not_written(&self.path, &e))
            }
        }
    }
}
