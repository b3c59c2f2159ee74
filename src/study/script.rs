//! What a Gmsh script says about itself without being run: its constants.

use super::constants::{Constant, Expression, constants};
use super::mentions::mentions;
use super::words::words;
use crate::input::{self, Kind};
use crate::model::case::nearest;
use crate::{Error, Result};
use std::collections::BTreeMap;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

/// A Gmsh script and the constants of the scripts that it includes.
#[derive(Debug, Clone, PartialEq)]
pub struct Script {
    pub path: PathBuf,
    /// in order of appearance, over all included scripts; computed names (`r~{i}`) and texts are left out
    pub constants: Vec<Constant>,
    /// of the script itself
    pub bytes: Vec<u8>,
}

/// Error: an included file is a device, which Gmsh would read without end.
fn refuse_device(script: &Path, file: &Path) -> Result<()> {
    use std::os::unix::fs::FileTypeExt;
    let is_device = |m: std::fs::Metadata| m.file_type().is_char_device() || m.file_type().is_block_device();
    match file.metadata().is_ok_and(is_device) {
        false => Ok(()),
        true => Err(Error::input(format!(
            "the script {} includes {}, which is a device: include a file",
            script.display(),
            file.display()
        ))),
    }
}

impl Script {
    /// Errors: the script cannot be read.
    pub fn read(path: &Path) -> Result<Script> {
        let bytes = input::read(path, Kind::Script)
            .map_err(|e| Error::input(format!("the script {} cannot be read: {e}", path.display())))?;
        let mut script = Script { path: path.into(), constants: Vec::new(), bytes };
        let mut waiting = vec![path.to_path_buf()];
        let mut seen: Vec<PathBuf> = Vec::new();
        while let Some(file) = waiting.pop() {
            refuse_device(path, &file)?;
            let included = match seen.is_empty() {
                true => Ok(script.bytes.clone()),
                false if file.is_file() => input::read(&file, Kind::Script),
                false => Err(ErrorKind::NotFound.into()),
            };
            // a file that is missing is for Gmsh to report
            if let Ok(bytes) = included {
                let source = String::from_utf8_lossy(&bytes);
                for constant in constants(&words(&source).collect::<Vec<_>>()) {
                    // as in Gmsh, the first definition stays
                    if !script.constants.iter().any(|c| c.name == constant.name) {
                        script.constants.push(constant);
                    }
                }
                waiting.extend(scripts_in(&bytes, &file).into_iter().rev().filter(|f| !seen.contains(f)));
            }
            seen.push(file);
        }
        Ok(script)
    }

    /// Every constant's value in force: the one given, or the script's default.
    ///
    /// Errors: a parameter that is no constant of the script, is not finite, or lies outside the constant's bounds.
    pub fn values(&self, parameters: &BTreeMap<String, f64>) -> Result<BTreeMap<String, Expression>> {
        for (name, &value) in parameters {
            let constant = self.constants.iter().find(|c| c.name == *name).ok_or_else(|| self.unknown(name))?;
            self.check_bounds(constant, value)?;
        }
        let value = |c: &Constant| parameters.get(&c.name).map_or(c.default.clone(), |&v| Expression::Number(v));
        Ok(self.constants.iter().map(|c| (c.name.clone(), value(c))).collect())
    }

    fn check_bounds(&self, constant: &Constant, value: f64) -> Result<()> {
        let bound = |e: &Option<Expression>| e.as_ref().and_then(Expression::number);
        let (min, max) = (bound(&constant.min), bound(&constant.max));
        let inside = value.is_finite() && min.is_none_or(|m| value >= m) && max.is_none_or(|m| value <= m);
        let range = match (min, max) {
            _ if inside => return Ok(()),
            (Some(min), Some(max)) => format!("lie between {min} and {max}"),
            (Some(min), None) => format!("be at least {min}"),
            (None, Some(max)) => format!("be at most {max}"),
            (None, None) => "be a finite number".into(),
        };
        let label = constant.label.as_ref().map(|l| format!(" (\"{l}\")")).unwrap_or_default();
        let (name, script) = (&constant.name, self.path.display());
        Err(Error::input(format!("{name} = {value} is out of bounds: in {script} {name}{label} must {range}")))
    }

    fn unknown(&self, name: &str) -> Error {
        let script = self.path.display();
        if self.constants.is_empty() {
            return Error::input(format!("{script} has no constant \"{name}\": it has no DefineConstant at all"));
        }
        let hint = match nearest(name, self.constants.iter().map(|c| c.name.as_str())) {
            Some(near) => format!(", did you mean \"{near}\"?"),
            None => ".".into(),
        };
        let list: Vec<String> = self.constants.iter().map(|c| format!("{} = {}", c.name, c.default)).collect();
        Error::input(format!("{script} has no constant \"{name}\"{hint} It has: {}", list.join(", ")))
    }
}

/// The scripts that the script `file` includes or merges under a name that it gives in full.
fn scripts_in(bytes: &[u8], file: &Path) -> Vec<PathBuf> {
    let folder = file.parent().unwrap_or(Path::new(""));
    let found = mentions(bytes);
    let merged = found.read.iter().filter(|name| name.ends_with(".geo"));
    found.included.iter().chain(merged).map(|name| folder.join(name)).collect()
}
