//! Whether memory is enough for a mesh, told as soon as its factor's size is known and before anything of it is
//! computed.

use crate::free_memory::{free_memory, in_words};
use crate::sparse::Symbolic;
use crate::{Error, Result};

/// Errors: the factors need more than the machine, or the limit of this process, has left.
pub fn refuse_too_large(unknowns: usize, symbolic: &Symbolic) -> Result<()> {
    let needed = symbolic.bytes();
    match free_memory() {
        Some(free) if needed > free => Err(Error::input(format!(
            "the factor of {unknowns} unknowns needs about {} of memory, and {} are free: make the mesh coarser, end other programs, or \
             raise the limit (ulimit -v)",
            in_words(needed),
            in_words(free)
        ))),
        _ => Ok(()),
    }
}
