//! Joints whose own vibration the time step does not resolve and nothing damps: a stuck joint then creeps.

use super::case::{Analysis, Integrator, Rayleigh};
use super::mesh::Cell;
use super::resolve::Model;
use super::split::Joint;
use crate::number::short_to;
use std::f64::consts::TAU;

/// Steps in a period of the joints below which a stopped block creeps. Measured on the Coulomb oscillator of the
/// verification book (period 0.63 ms): 1.3 mm in the 1.4 s after its stop at 1 ms, 1e-5 mm at 0.2 ms.
const STEPS_IN_A_PERIOD: f64 = 3.;

/// A sentence for each body that vibrates on its joints faster than the time step resolves, where nothing damps.
///
/// The period is that of the rigid body on the tangential stiffness of all its joints: 2 pi sqrt(m / sum kappa_s l).
pub fn warnings(model: &Model) -> Vec<String> {
    let Integrator { newmark, hht } = model.integrator;
    if has_damping(model) || newmark.delta > 0.5 || hht < 0. || model.analysis == Analysis::Static {
        return vec![];
    }
    let sentence = |body: &String| {
        let period = TAU * (mass(model, body)? / tangential_stiffness(model, body)).sqrt();
        let step = model.time.step;
        (step > period / STEPS_IN_A_PERIOD).then(|| {
            format!(
                "body {body} vibrates on its joints with a period of {}, which time.step = {} does not resolve, and nothing \
                 damps it: stuck joints may creep and closed ones chatter; take time.hht = -0.1, damping, or a step of {} at \
                 most",
                milliseconds(period),
                milliseconds(step),
                milliseconds(period / STEPS_IN_A_PERIOD)
            )
        })
    };
    model.bodies.iter().filter_map(sentence).collect()
}

fn has_damping(model: &Model) -> bool {
    model.damping.is_some_and(|damping| match damping.rayleigh {
        Rayleigh::Coefficients { alpha, beta } => alpha > 0. || beta > 0.,
        Rayleigh::Ratio { .. } => true,
    })
}

fn milliseconds(time: f64) -> String {
    format!("{} ms", short_to(3, 1e3 * time))
}

/// Of the faces of a group, per metre of depth [kg]; none if there is no such group.
fn mass(model: &Model, body: &str) -> Option<f64> {
    let group = model.mesh.groups.iter().find(|g| g.dimension == 2 && g.is_called(body))?;
    let density = |cell: usize| model.material_of[cell].map_or(0., |material| model.materials[material].1.density);
    Some(group.cells.iter().map(|&cell| density(cell) * model.mesh.measure(&model.mesh.cells[cell])).sum())
}

/// Sum of kappa_s times length over the joints round a body, per metre of depth [N/m].
fn tangential_stiffness(model: &Model, body: &str) -> f64 {
    let of_body = model.joints.iter().zip(&model.laws).filter(|(joint, _)| model.seams[joint.seam].body == body);
    let length = |joint: &Joint| {
        let nodes = joint.pairs.iter().map(|&pair| model.pairs[pair].ground).collect();
        model.mesh.measure(&Cell { shape: joint.shape, nodes })
    };
    of_body.map(|(joint, (law, _))| law.tangential_stiffness * length(joint)).sum()
}
