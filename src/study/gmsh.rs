use crate::Result;
use std::collections::BTreeMap;
use std::path::Path;
pub struct Meshing {
    pub warnings: Vec<String>,
}
impl std::fmt::Display for Meshing {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("stub")
    }
}
pub fn ensure_mesh(_s: &Path, _p: &BTreeMap<String, f64>, _m: &Path) -> Result<Meshing> {
    Ok(Meshing { warnings: vec![] })
}
