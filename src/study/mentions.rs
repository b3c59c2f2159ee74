//! Which files a Gmsh script reads, as far as its words tell.
//!
//! Gmsh reports what it includes and merges. What else it reads needs one of the words below, and a script cannot compose
//! a word from strings: so a script without them reads no file that Gmsh does not report.

use super::words::{Word, words};

/// What the words of one file say about other files.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Mentions {
    /// names of included files, as written
    pub included: Vec<String>,
    /// names of other files that are read, as written
    pub read: Vec<String>,
    /// words that include or merge a file whose name is an expression: only Gmsh knows it
    pub composed: Vec<String>,
    /// words that make the mesh depend on things that neither Gmsh reports nor the script names
    pub hidden: Vec<String>,
    /// the file can keep Gmsh from reporting what it reads
    pub is_silencing: bool,
}

enum Kind {
    Includes,
    Merges,
    /// reads a file without a report
    Reads,
    /// depends on files, commands or the environment that cannot be followed
    Hides,
    Silences,
}

fn kind(name: &str) -> Option<Kind> {
    Some(match name {
        "Include" => Kind::Includes,
        "Merge" | "MergeWithBoundingBox" => Kind::Merges,
        "ShapeFromFile" | "ListFromFile" => Kind::Reads,
        // fields that read a file or run a command; Gmsh looks for the file in the current folder, not the script's
        "FileName" | "CommandLine" | "p4estFileToLoad" => Kind::Hides,
        "System" | "SystemCall" | "NonBlockingSystemCall" | "OnelabRun" | "Plugin" => Kind::Hides,
        "FileExists" | "GetEnv" | "Today" => Kind::Hides,
        // a part of a STEP assembly that lies in another file
        "DOCUMENT_FILE" => Kind::Hides,
        "Verbosity" | "Terminal" => Kind::Silences,
        _ => return None,
    })
}

/// Of a file that Gmsh parses. Meshes and other data of Gmsh's own formats, which begin with `$`, name no files.
pub(super) fn mentions(bytes: &[u8]) -> Mentions {
    let mut found = Mentions::default();
    if bytes.starts_with(b"$") {
        return found;
    }
    let source = String::from_utf8_lossy(bytes);
    let mut rest = words(&source);
    while let Some(word) = rest.next() {
        let Word::Name(name) = word else { continue };
        let Some(kind) = kind(name) else { continue };
        let behind = rest.clone().find(|w| !w.is('('));
        match (kind, behind) {
            (Kind::Includes, Some(Word::Text(file))) => found.included.push(file.into()),
            (Kind::Merges | Kind::Reads, Some(Word::Text(file))) => found.read.push(file.into()),
            (Kind::Includes | Kind::Merges, _) => found.composed.push(name.into()),
            (Kind::Reads | Kind::Hides, _) => found.hidden.push(name.into()),
            (Kind::Silences, _) => found.is_silencing = true,
        }
    }
    found
}
