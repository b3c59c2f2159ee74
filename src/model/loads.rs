//! The loads of the case on the lines, faces and nodes of the mesh.

use super::boundary::{Border, border};
use super::case::{self, Case, Clock, Directed, Pressure};
use super::charge;
use super::mesh::{BODY_SIDE, GROUND_SIDE, Group, Mesh};
use super::moving_front::MovingFront;
use super::resolve::{Load, Target};
use super::sides::Sides;
use crate::physics::front::Front;
use crate::{Error, Result};

/// Each with what of its explosion does not fit as a warning.
///
/// Errors name the group and the key: groups that do not exist, lines inside the solid, charges under the ground or out
/// of their formula's range.
pub fn loads(case: &Case, mesh: &Mesh, sides: &Sides, warnings: &mut Vec<String>) -> Result<Vec<Load>> {
    let mut load = |(name, load): (&str, &case::Load)| {
        let group = mesh.group_of(name, load.dimension(), "load")?;
        let lines_of = |group: &Group| -> Result<Vec<Border>> {
            Ok(border(mesh, group, sides)?.into_iter().map(|(line, _)| line).collect())
        };
        // in a joint a pressure presses on both sides
        let pressed = || -> Result<Vec<Border>> {
            Ok(mesh.both_sides(group).map(lines_of).collect::<Result<Vec<_>>>()?.concat())
        };
        let everywhere =
            |d: &Directed, target| Load { group: name.into(), pulse: d.pulse.clone(), target, front: None };
        Ok(match load {
            case::Load::Pressure(p) => {
                let (load, notes) = pressure(name, p, pressed()?, mesh).map_err(|why| in_case(case, name, &why))?;
                warnings.extend(notes.into_iter().map(|note| format!("load on {name}: {note}")));
                load
            }
            case::Load::Traction(d) => {
                everywhere(d, Target::Traction { lines: lines_of(one_side(mesh, group)?)?, direction: d.direction })
            }
            case::Load::BodyForce(d) => {
                everywhere(d, Target::BodyForce { cells: group.cells.clone(), direction: d.direction })
            }
            case::Load::Force(d) => {
                everywhere(d, Target::Force { nodes: mesh.nodes_of(group), direction: d.direction })
            }
        })
    };
    case.loads.iter().map(&mut load).collect()
}

/// The curve that a traction acts on. Errors: it lies on an interface, and no side of it is named.
fn one_side<'a>(mesh: &Mesh, group: &'a Group) -> Result<&'a Group> {
    let name = &group.name;
    match mesh.ground_side(group) {
        None => Ok(group),
        Some(_) => Err(Error::input(format!(
            "loads.{name}: a traction acts on one side of an interface: write \"{name}{BODY_SIDE}\" or \"{name}{GROUND_SIDE}\""
        ))),
    }
}

/// A pressure on its lines, and what of its explosion does not fit.
fn pressure(name: &str, pressure: &Pressure, lines: Vec<Border>, mesh: &Mesh) -> Result<(Load, Vec<String>)> {
    let load = |pulse, lines, front| Load { group: name.into(), pulse, target: Target::Pressure { lines }, front };
    let swept = |front: &Front, clock: Clock, lines: Vec<Border>| -> Result<Load> {
        let front = MovingFront::new(mesh, &lines, front, clock)?;
        Ok(load(front.first_pulse(), lines, Some(front)))
    };
    Ok(match pressure {
        Pressure::Simultaneous(pulse) => (load(pulse.clone(), lines, None), vec![]),
        Pressure::Sweeping(front, clock) => {
            let note = match front {
                Front::Charge { explosion, at, .. } => charge::stands(explosion, *at, mesh, &lines)?,
                Front::Plane { .. } | Front::Circle { .. } => None,
            };
            (swept(front, *clock, lines)?, note.into_iter().collect())
        }
        Pressure::Noted { pressure: noted, note } => {
            let (load, notes) = self::pressure(name, noted, lines, mesh)?;
            (load, notes.into_iter().chain([note.clone()]).collect())
        }
    })
}

/// Only explosions are refused on the mesh.
fn in_case(case: &Case, name: &str, why: &Error) -> Error {
    Error::input(format!("{}: loads.{name}.pressure.explosion: {why}", case.path().display()))
}
