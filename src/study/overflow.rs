//! Loads and initial motions under which a run would stop at numbers that are too large: found by `check` without solving.

use super::prepare::Prepared;
use crate::model::case::Analysis;
use crate::number::{place, short_to};
use crate::solve::assembly::nodal_forces;
use crate::solve::system::is_finite;
use crate::{Error, Result};

/// Errors: a load that gives a node an acceleration (in statics a displacement) beyond what a step can hold, force over the
/// node's own mass (stiffness); an initial motion beyond it.
pub fn refuse_overflow(prepared: &Prepared) -> Result<()> {
    let (model, system) = (&prepared.model, &prepared.system);
    let (matrix, what) = match model.analysis {
        Analysis::Dynamic => (&system.mass, "an acceleration [m/s^2]"),
        Analysis::Static => (&system.stiffness, "a displacement [m]"),
    };
    let end = model.time.step * model.time.steps as f64;
    for load in model.loads.iter().filter(|load| load.pulse.start() <= end) {
        let forces = nodal_forces(model, &load.target);
        for (&node, force) in forces.iter().flat_map(|f| f.nodes.iter().zip(&f.forces)) {
            for (axis, force) in force.iter().enumerate() {
                let Some(unknown) = system.unknowns.of(node, axis) else { continue };
                let motion = force * load.pulse.largest() / matrix.get(unknown, unknown).copied().unwrap_or(0.);
                if *force != 0. && !is_finite(motion) {
                    return Err(too_large(prepared, &format!("the load on \"{}\"", load.group), node, what, motion));
                }
            }
        }
    }
    let initial = model.initial.displacement.iter().chain(&model.initial.velocity).enumerate();
    match initial.flat_map(|(i, motion)| motion.map(|x| (i % model.mesh.points.len(), x))).find(|(_, x)| !is_finite(*x))
    {
        Some((node, x)) => {
            Err(too_large(prepared, "the initial motion", node, "displacement (m) or velocity (m/s)", x))
        }
        None => Ok(()),
    }
}

fn too_large(prepared: &Prepared, whose: &str, node: usize, what: &str, size: f64) -> Error {
    let at = place(prepared.model.mesh.points[node]);
    Error::input(format!(
        "{whose} gives the node at {at} {what} of {}, too large for a computer to calculate with: check its \
         values, densities and stiffnesses",
        short_to(3, size)
    ))
}
