//! The gmsh command: where it is, and how it is asked for a mesh.

use crate::{Error, Result};
use std::collections::BTreeMap;
use std::ffi::{OsStr, OsString};
use std::os::unix::ffi::OsStrExt;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

/// The environment variable that names the gmsh command.
pub const VARIABLE: &str = "CORALPIPE_GMSH";

/// How gmsh is started: the program and what comes before gmsh's own arguments.
#[derive(Debug, Clone, PartialEq)]
pub struct Gmsh {
    program: PathBuf,
    script: Option<PathBuf>,
}

/// What gmsh said while it made a mesh.
#[derive(Debug, Clone, PartialEq)]
pub struct Said {
    /// gmsh's version, `4.15.2`
    pub version: String,
    pub warnings: Vec<String>,
    /// files that it reported to read: the script, and what that includes and merges
    pub read: Vec<PathBuf>,
}

impl Gmsh {
    /// The gmsh command of this machine: `CORALPIPE_GMSH`, else `gmsh` on PATH, else `.venv/bin/gmsh` in the current
    /// folder, in `folder`, or above one of them.
    ///
    /// Errors: there is none, with how to install it; or `CORALPIPE_GMSH` names none.
    pub fn find(folder: &Path) -> Result<Gmsh> {
        let current = std::env::current_dir().unwrap_or_default();
        let folder = std::path::absolute(folder).unwrap_or(folder.into());
        Gmsh::find_in(std::env::var_os(VARIABLE).as_deref(), std::env::var_os("PATH").as_deref(), &[&current, &folder])
    }

    /// [`Gmsh::find`] with the value of `CORALPIPE_GMSH`, of `PATH`, and the absolute folders given.
    pub fn find_in(chosen: Option<&OsStr>, path: Option<&OsStr>, folders: &[&Path]) -> Result<Gmsh> {
        let on_path = |name: &OsStr| std::env::split_paths(path?).map(|p| p.join(name)).find(|p| is_program(p));
        if let Some(chosen) = chosen.filter(|c| !c.is_empty()) {
            let file = Path::new(chosen);
            let found =
                if file.components().count() == 1 { on_path(chosen) } else { file.is_file().then(|| file.into()) };
            let missing = || {
                Error::input(format!(
                    "{VARIABLE} is \"{}\", but there is no such program: set it to the path of gmsh, \
                                     or unset it, and gmsh is looked for on PATH and in .venv",
                    file.display()
                ))
            };
            return found.map(Gmsh::at).ok_or_else(missing);
        }
        let environments = folders.iter().flat_map(|f| f.ancestors()).map(|f| f.join(".venv/bin/gmsh"));
        on_path(OsStr::new("gmsh")).or_else(|| environments.into_iter().find(|p| p.is_file())).map(Gmsh::at).ok_or_else(|| {
            Error::input(format!(
                "no gmsh command was found on PATH or in .venv; install it by scripts/setup.sh, pip install gmsh or \
                 apt-get install gmsh, or set {VARIABLE} to its path"
            ))
        })
    }

    /// pip's `gmsh` is a Python script that asks for any `python`: only the one beside it has gmsh's library.
    fn at(file: PathBuf) -> Gmsh {
        let python = file.with_file_name("python");
        match is_python_script(&file) && is_program(&python) {
            true => Gmsh { program: python, script: Some(file) },
            false => Gmsh { program: file, script: None },
        }
    }

    /// The command, for gmsh's arguments to be added.
    pub fn command(&self) -> Command {
        let mut command = Command::new(&self.program);
        command.args(&self.script);
        command
    }

    /// The command as a user would type it.
    fn name(&self) -> String {
        self.script.as_ref().unwrap_or(&self.program).display().to_string()
    }

    /// Meshes `script` in the plane into `mesh`, MSH 4.1.
    ///
    /// Errors: gmsh does not run, or it reports errors: they are the sentence. `mesh` may or may not exist then.
    pub fn mesh(&self, script: &Path, parameters: &BTreeMap<String, f64>, mesh: &Path) -> Result<Said> {
        let mut arguments: Vec<OsString> = vec!["-2".into(), script.into()];
        // without AbortOnError an error leaves a mesh behind, and the exit code may be 0
        arguments.extend(["-setnumber", "General.AbortOnError", "4"].map(OsString::from));
        for (name, value) in parameters {
            arguments.extend(["-setnumber", name, &value.to_string()].map(OsString::from));
        }
        arguments.extend(["-format", "msh41", "-nt", "1", "-o"].map(OsString::from));
        arguments.push(mesh.into());
        let output = self
            .command()
            .args(arguments)
            .stdin(Stdio::null())
            .output()
            .map_err(|e| Error::input(format!("the gmsh command {} does not run: {e}", self.name())))?;
        self.judge(&output, script)
    }

    fn judge(&self, output: &Output, script: &Path) -> Result<Said> {
        let text = format!("{}\n{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
        let errors = messages(&text, "Error", script);
        let name = script.display();
        if !errors.is_empty() {
            return Err(Error::input(format!("gmsh could not mesh {name}: {}", errors.join("; "))));
        }
        let said =
            Said { version: version(&text), warnings: messages(&text, "Warning", script), read: read(&output.stdout) };
        if output.status.success() {
            return Ok(said);
        }
        let last = text.lines().map(str::trim).rfind(|l| !l.is_empty()).unwrap_or("it said nothing");
        let sentence = match text.contains("Info    : Running") {
            true => format!("gmsh broke off while it meshed {name} ({}): {last}", output.status),
            false => format!("the gmsh command {} does not run ({}): {last}", self.name(), output.status),
        };
        Err(Error::input(sentence))
    }
}

/// The messages of one level, in gmsh's words without its rules and without the script's folder; each once.
fn messages(text: &str, level: &str, script: &Path) -> Vec<String> {
    let folder = script.parent().map(|p| format!("{}/", p.display())).filter(|f| f.len() > 1);
    let mut messages: Vec<String> = Vec::new();
    for line in text.lines() {
        let Some(message) = line.strip_prefix(level).and_then(|rest| rest.trim_start().strip_prefix(':')) else {
            continue;
        };
        let message = folder.iter().fold(message.trim().to_owned(), |m, f| m.replace(f, ""));
        if !is_summary(&message) && !message.is_empty() && !messages.contains(&message) {
            messages.push(message);
        }
    }
    messages
}

/// From lines such as `Info    : Reading 'geo/box.geo'...`, whose names are any bytes.
fn read(output: &[u8]) -> Vec<PathBuf> {
    let name = |line: &&[u8]| {
        let rest = line.strip_prefix(b"Info")?.trim_ascii_start().strip_prefix(b":")?.trim_ascii_start();
        let name = rest.strip_prefix(b"Reading '")?;
        // gmsh may add times and memory behind
        let end = name.windows(4).rposition(|w| w == b"'...")?;
        Some(PathBuf::from(OsStr::from_bytes(&name[..end])))
    };
    output.split(|&b| b == b'\n').filter_map(|line| name(&line)).collect()
}

/// Lines of the summary that gmsh closes with, which only counts what it has said: `1 warning`, `0 errors`.
fn is_summary(message: &str) -> bool {
    let counts = |rest: &str| ["warning", "warnings", "error", "errors"].contains(&rest);
    message.starts_with("-----")
        || message.starts_with("Mesh generation error summary")
        || message.starts_with("Check the full log")
        || message.split_once(' ').is_some_and(|(n, rest)| n.parse::<usize>().is_ok() && counts(rest.trim()))
}

/// From `... [Gmsh 4.15.2, 1 node, max. 1 thread]`.
fn version(text: &str) -> String {
    let behind = text.split_once("[Gmsh ").map_or("", |(_, rest)| rest);
    let version = behind.split([',', ']', '\n']).next().unwrap_or_default();
    if version.is_empty() { "of unknown version".into() } else { version.into() }
}

fn is_python_script(file: &Path) -> bool {
    let Ok(bytes) = std::fs::read(file) else {
        return false;
    };
    let first = bytes.split(|&b| b == b'\n').next().unwrap_or_default();
    first.starts_with(b"#!") && String::from_utf8_lossy(first).contains("python")
}

fn is_program(file: &Path) -> bool {
    use std::os::unix::fs::PermissionsExt;
    file.metadata().is_ok_and(|m| m.is_file() && m.permissions().mode() & 0o111 != 0)
}
