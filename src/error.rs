//! What can go wrong, sorted by the exit code it ends with.

use std::fmt;

pub type Result<T> = std::result::Result<T, Error>;

/// Every variant carries a whole sentence for the user: the thing, its place, what exists, what to do.
#[derive(Debug, Clone, PartialEq)]
pub enum Error {
    /// The case, the mesh, a file or a tool is not as it must be (exit code 1).
    Input(String),
    /// No converged step could be found; what was computed until then is on disk (exit code 3).
    NoConvergence(String),
    /// The user stopped the run; what was computed until then is on disk (exit code 130).
    Interrupted(String),
}

impl Error {
    pub fn input(sentence: impl Into<String>) -> Self {
        Error::Input(sentence.into())
    }

    pub fn exit_code(&self) -> u8 {
        match self {
            Error::Input(_) => 1,
            Error::NoConvergence(_) => 3,
            Error::Interrupted(_) => 130,
        }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Error::Input(s) | Error::NoConvergence(s) | Error::Interrupted(s) => f.write_str(s),
        }
    }
}

impl std::error::Error for Error {}
