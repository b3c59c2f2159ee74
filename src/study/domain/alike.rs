//! What lets sizes be compared: the same mesh inside, the same t = 0.

use super::report::short;
use super::{Options, Size};
use crate::model::case::{Case, MeshSource};
use crate::model::resolve::Model;
use crate::study::run::Request;
use crate::study::script::Script;
use crate::{Error, Result};
use std::collections::BTreeMap;

/// Round-off of arrivals [s]
const SAME_TIME: f64 = 1e-9;

/// Histories counted from different times cannot be compared.
pub fn refuse_shift(old: &[Option<f64>], new: &Vec<Option<f64>>, model: &Model, [width, height]: Size) -> Result<()> {
    let shift = |(a, b): (&Option<f64>, &Option<f64>)| Some((b.as_ref()? - a.as_ref()?).abs());
    let shifts = old.iter().zip(new).map(|pair| shift(pair).unwrap_or(0.));
    match shifts.zip(&model.loads).find(|(shift, _)| *shift > SAME_TIME) {
        None => Ok(()),
        Some((shift, load)) => Err(Error::input(format!(
            "the load on \"{}\" counts t = 0 from its front's arrival at the curve, which at {} x {} comes {} ms away from that of the size \
             before: the histories cannot be compared; give a charge \"clock\": \"detonation\", or load a curve that does not grow",
            load.group,
            short(width),
            short(height),
            short(1e3 * shift)
        ))),
    }
}

pub fn core_names(options: &Options) -> [String; 2] {
    [&options.width, &options.height].map(|name| format!("core_{name}"))
}

/// `core_WIDTH` and `core_HEIGHT` of the script at the first size, where the user gives no others.
pub fn core(script: &Script, options: &Options, start: Size, given: &[String]) -> BTreeMap<String, f64> {
    let pairs = core_names(options).into_iter().zip(start);
    let is_known = |name: &String| script.constants.iter().any(|c| c.name == *name);
    pairs.filter(|(name, _)| is_known(name) && !given.contains(name)).collect()
}

/// Constants that the case or the command line sets.
pub fn given(case: &Case, request: &Request) -> Vec<String> {
    let parameters = match case.geometry.as_ref().and_then(|geometry| geometry.source.as_ref()) {
        Some(MeshSource::Script { parameters, .. }) => parameters.keys().cloned().collect(),
        _ => vec![],
    };
    request.geo.keys().cloned().chain(parameters).collect()
}
