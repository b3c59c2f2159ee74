//! Where memory ends: a sentence and an exit code of the program's own, in place of a signal and a trace of calls.

use std::alloc::{GlobalAlloc, Layout, System};
use std::io::Write;

/// The system's allocator, but for what happens where it has nothing left to give.
pub struct Telling;

// SAFETY: every call is the system allocator's own; where that gives nothing, the process ends.
unsafe impl GlobalAlloc for Telling {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        // SAFETY: the caller keeps to the contract of `GlobalAlloc`; so below
        given(unsafe { System.alloc(layout) }, layout.size())
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        // SAFETY: as above
        given(unsafe { System.alloc_zeroed(layout) }, layout.size())
    }

    unsafe fn realloc(&self, old: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        // SAFETY: as above
        given(unsafe { System.realloc(old, layout, size) }, size)
    }

    unsafe fn dealloc(&self, memory: *mut u8, layout: Layout) {
        // SAFETY: as above
        unsafe { System.dealloc(memory, layout) }
    }
}

fn given(memory: *mut u8, size: usize) -> *mut u8 {
    if memory.is_null() {
        end(size);
    }
    memory
}

/// Numbers are written to stderr without any more memory.
#[cold]
fn end(size: usize) -> ! {
    let _ = writeln!(
        std::io::stderr(),
        "coralpipe: there is no memory for another {} KiB: take a coarser mesh, end other programs, or raise the limit (ulimit -v)",
        size.div_ceil(1024)
    );
    std::process::exit(1)
}
