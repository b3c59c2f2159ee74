//! Keys of the case that have a meaning, but none here: said so, since somebody meant something by them.

use super::case::{Analysis, Case, Mass, Quad4};
use super::initial::Initial;
use super::mesh::Shape;
use super::resolve::{Load, Model};
use super::sampled::unseen;
use crate::number::{place, seconds};

/// A sentence for each.
pub fn idle(case: &Case, model: &Model) -> Vec<String> {
    let mut idle = Vec::new();
    let given = |key: &str| case.json().pointer(&format!("/{}", key.replace('.', "/"))).is_some_and(|v| !v.is_null());
    let of_motion: Vec<&str> =
        ["time.hht", "time.newmark", "time.start", "mass", "damping"].into_iter().filter(|k| given(k)).collect();
    if case.analysis == Analysis::Static && !of_motion.is_empty() {
        idle.push(format!(
            "a static calculation has no inertia and no damping: {} has no effect",
            of_motion.join(", ")
        ));
    }
    if case.mass == Mass::Redistributed && model.pairs.is_empty() {
        idle.push("mass = \"redistributed\" has no effect: no interface is open".into());
    }
    for probe in model.probes.iter().filter(|probe| model.light[probe.node]) {
        idle.push(format!(
            "probe {} lies on an interface, whose nodes have next to no mass with mass = \"redistributed\": its accelerations mean \
             nothing; take a place beside the interface for them",
            probe.name
        ));
    }
    let is_quad4 = |(cell, _): (usize, _)| model.mesh.cells[cell].shape == Shape::Quad4;
    if case.elements.quad4 == Quad4::BBar && !model.faces().any(is_quad4) {
        idle.push("elements.quad4 = \"b_bar\" has no effect: the mesh has no 4-node quadrangles".into());
    }
    idle
}

/// What is suspicious about loads and initial motion: a sentence for each. Natural modes do not depend on them.
pub fn excitation(case: &Case, model: &Model) -> Vec<String> {
    let end = model.time.step * model.time.steps as f64;
    let mut idle: Vec<String> = model.loads.iter().filter_map(|load| never_acts(load, end)).collect();
    if case.analysis == Analysis::Dynamic {
        idle.extend(model.loads.iter().filter_map(|load| unseen(load, &model.time)));
    }
    if nothing_acts(model) {
        idle.push("nothing loads or moves the model: there is no load, no gravity and no initial motion".into());
    }
    for name in case.initial.keys() {
        if case.json()["initial"][name].as_object().is_some_and(|keys| keys.is_empty()) {
            idle.push(format!("initial.{name} has no effect: it gives neither \"velocity\" nor \"displacement\""));
        }
        idle.extend(held_motion(case, model, name));
    }
    idle
}

pub fn nothing_acts(model: &Model) -> bool {
    let still = |motion: &[[f64; 2]]| motion.iter().all(|m| *m == [0.; 2]);
    let Initial { displacement, velocity } = &model.initial;
    model.loads.is_empty() && model.gravity == 0. && still(displacement) && still(velocity)
}

/// A load that is zero, or begins when all is over; one that begins at the end acts in the last step.
fn never_acts(load: &Load, end: f64) -> Option<String> {
    let first = load.front.as_ref().map_or(load.pulse.start(), |sweep| sweep.onset()[0]);
    let because = match load.pulse.is_zero() {
        true => "it is zero at all times".into(),
        false if first > end => {
            format!("it begins at {}, and the calculation ends at {}", seconds(first), seconds(end))
        }
        false => return None,
    };
    Some(format!("the load on \"{}\" never acts: {because}", load.group))
}

/// A motion at t = 0 of nodes that supports hold.
fn held_motion(case: &Case, model: &Model, name: &str) -> Option<String> {
    let motion = &case.initial[name];
    let moves = [0, 1].map(|axis| motion.velocity[axis].0 != 0. || motion.displacement[axis].0 != 0.);
    let nodes = model.mesh.nodes_of(model.mesh.group(name).ok()?);
    let held: Vec<usize> =
        nodes.into_iter().filter(|&n| (0..2).any(|axis| moves[axis] && model.fixed[n][axis])).collect();
    let place = place(model.mesh.points[*held.first()?]);
    Some(format!(
        "initial.{name}: supports hold {} of its nodes against the motion it gives them, one at {place}; they \
         do not move",
        held.len()
    ))
}
