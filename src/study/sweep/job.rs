//! One run of a sweep: its case read and its mesh at hand. Its model is built when its turn comes, and not kept.

use super::plan::{Plan, Variant};
use crate::model::case::Case;
use crate::model::hold::refuse_loose;
use crate::model::resolve::Model;
use crate::results::ring;
use crate::results::summary::Inputs;
use crate::study::inputs::made_from;
use crate::study::mesh::{self, Meshed};
use crate::study::run::{self, Request};
use crate::study::screen::Screen;
use crate::{Error, Result};
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

pub struct Job {
    /// its row in the table
    pub number: usize,
    pub name: String,
    pub case: Case,
    pub meshed: Arc<Meshed>,
    pub inputs: Inputs,
    pub folder: PathBuf,
}

/// What kept a run from starting or from its end.
pub struct Failure {
    /// the run's row in the table
    pub number: usize,
    pub why: Error,
}

/// Meshes by what they are made from: runs of equal geometry share theirs.
#[derive(Default)]
pub struct Meshes(BTreeMap<String, Result<Arc<Meshed>>>);

impl Meshes {
    fn obtain(&mut self, case: &Case, geo: &BTreeMap<String, f64>, screen: &Screen) -> Result<Arc<Meshed>> {
        let made = self.0.entry(format!("{:?} {geo:?}", case.geometry)).or_insert_with(|| {
            let meshed = mesh::obtain(case, geo, None)?;
            screen.say(&meshed.told);
            Ok(meshed.into())
        });
        made.clone()
    }
}

impl Job {
    /// Errors: those of reading the case and of making its mesh.
    pub fn new(
        number: usize,
        variant: &Variant,
        plan: &Plan,
        folder: &Path,
        meshes: &mut Meshes,
        screen: &Screen,
    ) -> Result<Job> {
        let case = Case::read(&plan.case, &variant.sets)?;
        let meshed = meshes.obtain(&case, &variant.geo, screen)?;
        let folder = folder.join(&variant.name);
        let request = Request {
            case: plan.case.clone(),
            geo: variant.geo.clone(),
            sets: variant.sets.clone(),
            mesh: None,
            out: Some(folder.clone()),
            bonded: plan.bonded,
            quiet: true,
            large: true,
        };
        let inputs = made_from(&case, &meshed, &request);
        Ok(Job { number, name: variant.name.clone(), case, meshed, inputs, folder })
    }

    /// Errors: names, places and supports that do not fit the mesh.
    pub fn model(&self) -> Result<Model> {
        let mut model = run::model(&self.case, &self.meshed, self.inputs.bonded, &self.meshed.openings)?;
        refuse_loose(&model)?;
        model.warnings.extend(ring::uncut(&model));
        Ok(model)
    }

    /// Equal for runs that share their matrices.
    pub fn matrices(&self) -> String {
        format!("{} {}", self.inputs.mesh_sha256, without_loads(self.case.json()))
    }
}

/// The case without what changes no matrix: loads, friction, probes, titles, frames.
fn without_loads(case: &Value) -> Value {
    let mut rest = case.clone();
    for key in ["loads", "probes", "title", "output"] {
        rest.as_object_mut().map(|case| case.remove(key));
    }
    let interfaces = rest.get_mut("interfaces").and_then(Value::as_object_mut);
    for interface in interfaces.into_iter().flat_map(|all| all.values_mut()) {
        interface.as_object_mut().map(|keys| keys.remove("friction"));
    }
    rest
}

/// Errors: two runs are one and the same case, written in two ways.
pub fn refuse_equal(jobs: &[Job]) -> Result<()> {
    let mut names: BTreeMap<String, &str> = BTreeMap::new();
    for job in jobs {
        let what = format!("{:?} {}", job.inputs.geo, job.case.meaning());
        if let Some(first) = names.insert(what, &job.name) {
            return Err(Error::input(format!(
                "{first} and {} are the same case, written in two ways, which would run twice: take one of the two values \
                 out of its list",
                job.name
            )));
        }
    }
    Ok(())
}
