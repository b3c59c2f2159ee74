//! A step that could not be solved, in words: what kept it from settling, where, and what helps in that case.

use super::prepare::Prepared;
use crate::Error;
use crate::model::case::Analysis;
use crate::model::split::Seam;
use crate::number::{place, seconds};
use crate::physics::joint::Status;
use crate::solve::condensed::FAR;
use crate::solve::energy::{AGAINST_CHATTER, of_supplied};
use crate::solve::march::MAX_CUTS;
use crate::solve::unsettled::{Place, Unsettled};

/// Relative residual near which a computer's 16 digits end.
const LAST_DIGITS: f64 = 1e-9;

/// The error of a run that finds no equilibrium at t = 0.
pub fn at_start(prepared: &Prepared, unsettled: &Unsettled) -> Error {
    let (cause, advice) = still(prepared, unsettled);
    Error::NoConvergence(format!("no equilibrium was found at t = 0: {cause}; {advice}"))
}

/// The error of a run at whose end joints have made more energy than is tolerated.
pub fn at_end(prepared: &Prepared, unsettled: &Unsettled) -> Error {
    Error::NoConvergence(format!("{}; {}", restless(prepared, unsettled), advice(unsettled, "")))
}

/// The error of a run that cannot go on from `time` [s] with step `number`.
pub fn in_step(prepared: &Prepared, unsettled: &Unsettled, time: f64, number: usize) -> Error {
    let what = match prepared.model.analysis {
        Analysis::Static => "no equilibrium was found",
        Analysis::Dynamic => "no convergence",
    };
    if let Unsettled::Energy { .. } = unsettled {
        let (cause, advice) = (restless(prepared, unsettled), advice(unsettled, ""));
        let cuts = 1 << MAX_CUTS;
        let time = seconds(time);
        return Error::NoConvergence(format!(
            "stopped in step {number} after t = {time}: {cause}, with steps cut by up to {cuts}; {advice}"
        ));
    }
    let (cause, advice) = match prepared.model.analysis {
        Analysis::Static => still(prepared, unsettled),
        Analysis::Dynamic => (
            restless(prepared, unsettled),
            advice(unsettled, "try a smaller time.step, a larger interface thickness, or damping"),
        ),
    };
    let cuts = 1 << MAX_CUTS;
    Error::NoConvergence(format!(
        "{what} in step {number} after t = {}, even with the time step cut by {cuts}: {cause}; {advice}",
        seconds(time)
    ))
}

/// Cause and advice without inertia, in statics and under gravity: what friction does not hold has no equilibrium.
fn still(prepared: &Prepared, unsettled: &Unsettled) -> (String, String) {
    let moving = moving_bodies(prepared, unsettled);
    let moves = prepared.model.analysis == Analysis::Dynamic;
    if moving.is_empty() {
        let fallback = match moves {
            true => "try more newton.max_iterations, or leave out \"gravity\" and give the weight as a \"body_force\"",
            false => {
                "try smaller steps of the load (a table that grows from 0, a smaller time.step), or more \
                 newton.max_iterations"
            }
        };
        return (restless(prepared, unsettled), advice(unsettled, fallback));
    }
    // A run that moves comes here under its weight alone, before its loads begin.
    let weight = "leave out \"gravity\" and give its weight as a \"body_force\"";
    let advice = match (moves, prepared.model.gravity > 0.) {
        (true, _) => format!("give it more friction or a support, or let it move from t = 0 on: {weight}"),
        (false, weighs) => format!(
            "give it more friction, a support or a smaller load, or let it move with analysis = \"dynamic\"{}",
            if weighs { format!(": there, {weight}") } else { String::new() }
        ),
    };
    (moving.join("; "), advice)
}

/// A sentence for every body whose joints all slip or stand open.
fn moving_bodies(prepared: &Prepared, unsettled: &Unsettled) -> Vec<String> {
    let (Unsettled::Statuses { last, .. } | Unsettled::Residual { last, .. } | Unsettled::Loose { last, .. }) =
        unsettled
    else {
        return vec![];
    };
    let model = &prepared.model;
    let sentence = |body: &String| {
        let of_body = |&i: &usize| seams(prepared, i).any(|seam| seam.body == *body);
        let points: Vec<usize> = (0..last.len()).filter(of_body).collect();
        let slipping: Vec<usize> = points.iter().copied().filter(|&i| last[i].is_slipping()).collect();
        let held = points.iter().any(|&i| last[i] == Status::Stick);
        match (held || points.is_empty(), slipping.is_empty()) {
            (true, _) => None,
            (false, true) => Some(format!(
                "nothing holds body {body}, which has come off: its joints are open everywhere ({})",
                places(prepared, &points)
            )),
            (false, false) => Some(format!(
                "friction does not hold body {body}, which slides: no joint of it sticks, and these slip: {}",
                places(prepared, &slipping)
            )),
        }
    };
    let sentences: Vec<String> = model.bodies.iter().filter_map(sentence).collect();
    match unsettled {
        Unsettled::Loose { body, .. } if sentences.is_empty() => {
            let name = &prepared.system.free_bodies[*body].name;
            vec![format!("the joints do not hold {name}, which tips or slides although some of them stick")]
        }
        _ => sentences,
    }
}

fn restless(prepared: &Prepared, unsettled: &Unsettled) -> String {
    let tolerance = prepared.model.newton.tolerance;
    match unsettled {
        Unsettled::Statuses { changing, .. } => {
            let places = places(prepared, changing);
            format!("joint points keep changing between open, sticking and slipping: {places}")
        }
        Unsettled::Residual { relative, largest, .. } => {
            let at = largest.map_or(String::new(), |i| format!(", most of it near {}", places(prepared, &[i])));
            format!(
                "no joint changes its status, but the residual stays at {relative:.1e} of the largest force{at}, above \
                 newton.tolerance = {tolerance:e}"
            )
        }
        Unsettled::Energy { made, supplied } => format!(
            "joints that open and close within steps have made {}, more than time.energy_tolerance = {}",
            of_supplied(*made, *supplied),
            prepared.model.time.energy.share
        ),
        Unsettled::Loose { body, .. } => format!("the joints do not hold {}", prepared.system.free_bodies[*body].name),
        Unsettled::Far { node } => format!(
            "the node at {} would go farther than {FAR:e} times the size of the model",
            place(prepared.model.mesh.points[*node])
        ),
        Unsettled::Overflow(first) => {
            let at = match *first {
                Place::JointPoint(i) => format!(", first at {}", places(prepared, &[i])),
                Place::Node(node) => {
                    let place = place(prepared.model.mesh.points[node]);
                    format!(", first at the node at {place}")
                }
                Place::Matrix => ", in the matrix of the shortened step".into(),
            };
            format!("numbers grow too large for a computer{at}")
        }
    }
}

/// What helps against this cause; `otherwise` against statuses that change.
fn advice(unsettled: &Unsettled, otherwise: &str) -> String {
    match unsettled {
        Unsettled::Energy { .. } => AGAINST_CHATTER.into(),
        Unsettled::Far { .. } => "check loads, stiffnesses, and whether supports hold every body".into(),
        Unsettled::Overflow(_) => "check loads, densities, stiffnesses and steps".into(),
        Unsettled::Residual { relative, .. } if *relative < LAST_DIGITS => {
            "a computer's 16 digits allow no less here: take a larger newton.tolerance".into()
        }
        _ => otherwise.into(),
    }
}

/// The interfaces that a joint point lies on: two where one of a body's goes over into the next.
fn seams(prepared: &Prepared, point: usize) -> impl Iterator<Item = &Seam> {
    let elements = prepared.system.interface.points[point].parts.iter();
    elements.map(|&(joint, _)| &prepared.model.seams[prepared.model.joints[joint].seam])
}

/// Up to six places of joint points; joints that meet in a corner, or under two laws, have a point each there.
fn places(prepared: &Prepared, points: &[usize]) -> String {
    let of_point = |&i: &usize| {
        let place = place(prepared.system.interface.points[i].at);
        seams(prepared, i).map(move |seam| format!("{} at {place}", seam.curve))
    };
    let mut places: Vec<String> = points.iter().flat_map(of_point).collect();
    places.sort_unstable();
    places.dedup();
    let and_more = if places.len() > 6 { format!(" and {} more", places.len() - 6) } else { String::new() };
    places.truncate(6);
    places.join(", ") + &and_more
}
