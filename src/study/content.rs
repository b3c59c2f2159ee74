//! A file's bytes and their hash, read at once: what is parsed is what is recorded, whatever becomes of the file
//! meanwhile.

use crate::input::{self, Kind};
use sha2::{Digest, Sha256};
use std::path::Path;

#[derive(Clone, PartialEq)]
pub struct Content {
    pub bytes: Vec<u8>,
    /// 64 hexadecimal digits
    pub sha256: String,
}

impl Content {
    pub fn of(bytes: Vec<u8>) -> Content {
        Content { sha256: sha256(&bytes), bytes }
    }

    pub fn read(path: &Path) -> std::io::Result<Content> {
        input::read(path, Kind::Mesh).map(Content::of)
    }
}

/// Not the bytes: they fill screens.
impl std::fmt::Debug for Content {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} bytes with SHA-256 {}", self.bytes.len(), self.sha256)
    }
}

pub fn sha256(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|b| format!("{b:02x}")).collect()
}
