//! The ground beyond an upright side: its layers go on for ever, so under a load that does so too it moves as one
//! column, which is modelled with the side's own nodes, materials, base and load.

use super::absorbing::Absorber;
use super::boundary::Border;
use super::case::{Boundary, Case};
use super::initial::Initial;
use super::mesh::{Cell, Mesh};
use super::resolve::{Load, Model, Target};
use super::sides::{edge, open_sides};
use crate::number::place;
use crate::physics::shape::Shape;
use crate::{Error, Result};
use std::collections::BTreeMap;

/// One side of the mesh and the column beyond it.
#[derive(Debug, Clone)]
pub struct FreeField {
    /// the side's lines with the solid on their left, from the top down
    pub lines: Vec<Absorber>,
    /// n_x of the side's outward normal, 1 on the right and -1 on the left
    pub outward: f64,
    /// for each node of the side its node in the column, where the two sides of an interface are one
    pub twin: BTreeMap<usize, usize>,
    /// for each node of the column the node of the side at its height
    pub origin: Vec<usize>,
    /// a strip that moves up and down only, as wide as the elements behind the side
    pub column: Model,
}

/// Every side of every free-field boundary with its column.
///
/// Errors: a side that is not straight, upright and whole, or under a load that a vertical P wave is no answer to.
pub fn free_fields(case: &Case, model: &Model) -> Result<Vec<FreeField>> {
    let mut found = Vec::new();
    let named = case.boundaries.iter().enumerate().filter(|(_, (_, kind))| **kind == Boundary::FreeField);
    for (number, (name, _)) in named {
        let mut lines: Vec<Absorber> = model.absorbers.iter().filter(|a| a.group == number).cloned().collect();
        for line in &lines {
            refuse_slope(name, &line.line, &model.mesh)?;
        }
        let top = |line: &Absorber| line.line.nodes.iter().map(|&n| model.mesh.points[n][1]).fold(f64::MIN, f64::max);
        lines.sort_by(|a, b| top(b).total_cmp(&top(a)));
        for outward in [-1., 1.] {
            // the solid lies to the left, so a right side runs up
            let runs = |a: &&Absorber| a.line.tangent(&model.mesh)[1] * outward > 0.;
            let lines: Vec<Absorber> = lines.iter().filter(runs).cloned().collect();
            if !lines.is_empty() {
                found.push(free_field(name, model, lines, outward)?);
            }
        }
    }
    Ok(found)
}

/// Two sides whose columns are not alike: then the layers between them are not level.
pub fn uneven(sides: &[FreeField], model: &Model) -> Option<String> {
    let layers = |side: &FreeField| {
        let bottom = |line: &Absorber| model.mesh.points[ends(&line.line, &model.mesh)[1]][1];
        let mut layers: Vec<(Option<usize>, f64)> = Vec::new();
        for line in &side.lines {
            let material = model.material_of[line.face];
            match layers.last_mut() {
                Some((last, low)) if *last == material => *low = bottom(line),
                _ => layers.push((material, bottom(line))),
            }
        }
        layers
    };
    let (first, other) = (layers(sides.first()?), layers(sides.get(1)?));
    let depth = first.iter().fold(1., |depth: f64, (_, y)| depth.max(y.abs()));
    let alike = first.len() == other.len()
        && first.iter().zip(&other).all(|(a, b)| a.0 == b.0 && (a.1 - b.1).abs() < UPRIGHT * depth);
    (!alike).then(|| {
        "the two free-field sides have different layers: each side's ground moves as if its own went on for ever, and waves \
         between the two are not a free field; keep the layers level near the sides"
            .into()
    })
}

/// What is only nearly so under a moving front.
pub fn swept(sides: &[FreeField], loads: &[Load]) -> Option<String> {
    let load = loads.iter().find(|load| load.front.is_some()).filter(|_| !sides.is_empty())?;
    Some(format!(
        "the load on \"{}\" sweeps over it, but the ground beyond free-field sides is taken to move straight up and down, under \
         the pressure that reaches the side's top: a front much faster than P waves does nearly so, a slower one does not",
        load.group
    ))
}

/// Share of a line's length by which it may lean.
const UPRIGHT: f64 = 1e-6;

fn refuse_slope(name: &str, line: &Border, mesh: &Mesh) -> Result<()> {
    let leans = |&node: &usize| (mesh.points[node][0] - mesh.points[line.nodes[0]][0]).abs();
    let [a, b] = [0, 1].map(|i| mesh.points[line.nodes[i]]);
    let lean = line.nodes.iter().map(leans).fold(0., f64::max);
    match lean <= UPRIGHT * (b[0] - a[0]).hypot(b[1] - a[1]) {
        true => Ok(()),
        false => Err(Error::input(format!(
            "boundaries.{name}: \"free_field\" needs a straight, upright side, and it slopes at {}; a curve below \
             the ground takes \"viscous\"",
            place([0, 1].map(|i| (a[i] + b[i]) / 2.))
        ))),
    }
}

/// Its top and bottom corner, by height.
fn ends(line: &Border, mesh: &Mesh) -> [usize; 2] {
    let [a, b] = [line.nodes[0], line.nodes[1]];
    if mesh.points[a][1] > mesh.points[b][1] { [a, b] } else { [b, a] }
}

fn free_field(name: &str, model: &Model, lines: Vec<Absorber>, outward: f64) -> Result<FreeField> {
    for pair in lines.windows(2) {
        let [above, below] = [&pair[0], &pair[1]].map(|l| ends(&l.line, &model.mesh));
        // an interface that runs into the side leaves two nodes at one place
        if model.mesh.points[above[1]] != model.mesh.points[below[0]] {
            let place = place(model.mesh.points[above[1]]);
            return Err(Error::input(format!(
                "boundaries.{name}: a side with a free field runs without a break from the surface to the base, and this one does \
                 not go on at {place}; name each side's curve alone, and all of it"
            )));
        }
    }
    refuse_part(name, &model.mesh, &lines)?;
    let strip = Strip::beside(&lines, &model.mesh, mean_width(&lines, &model.mesh));
    let column = column(name, model, &lines, &strip)?;
    Ok(FreeField { lines, outward, twin: strip.twin, origin: strip.origin, column })
}

/// The edge of the mesh goes on above or below the lines named.
fn refuse_part(name: &str, mesh: &Mesh, lines: &[Absorber]) -> Result<()> {
    let ends = [ends(&lines[0].line, mesh)[0], ends(&lines[lines.len() - 1].line, mesh)[1]];
    let own = |side: &[usize]| lines.iter().any(|l| edge(&l.line.nodes) == edge(side));
    let goes_on = |side: &&Vec<usize>| {
        let [a, b] = [0, 1].map(|i| mesh.points[side[i]]);
        let upright = (a[0] - b[0]).abs() <= UPRIGHT * (a[1] - b[1]).abs();
        upright && !own(side) && ends.iter().any(|end| side[..2].contains(end))
    };
    match open_sides(mesh).iter().find(goes_on) {
        None => Ok(()),
        Some(side) => {
            let end = ends.into_iter().find(|end| side.contains(end)).unwrap_or(side[0]);
            let place = place(mesh.points[end]);
            Err(Error::input(format!(
                "boundaries.{name}: a side with a free field runs from the surface to the base, and the edge of the mesh goes on \
                 straight beyond this one's end at {place}; name all of it, alone"
            )))
        }
    }
}

/// Mean width of the elements behind the lines: their area over the side's height [m].
///
/// The motion of the strip depends on its width only where mid-side nodes have a lumped mass, which does not carry a plane
/// wave evenly across an element. With the elements' own width a mesh of equal columns has the strip's own, uneven motion.
fn mean_width(lines: &[Absorber], mesh: &Mesh) -> f64 {
    let area = |line: &Absorber| {
        let corners: Vec<[f64; 2]> = mesh.cells[line.face].corners().iter().map(|&n| mesh.points[n]).collect();
        let next = corners.iter().cycle().skip(1);
        corners.iter().zip(next).map(|(a, b)| a[0] * b[1] - b[0] * a[1]).sum::<f64>().abs() / 2.
    };
    let height = |line: &Absorber| {
        let [top, bottom] = ends(&line.line, mesh).map(|n| mesh.points[n][1]);
        top - bottom
    };
    lines.iter().map(area).sum::<f64>() / lines.iter().map(height).sum::<f64>()
}

/// The column's mesh: a quadrilateral beside each line of the side.
struct Strip {
    points: Vec<[f64; 2]>,
    faces: Vec<Cell>,
    top: Border,
    base: Border,
    /// node of the side -> node on the strip's left edge
    twin: BTreeMap<usize, usize>,
    /// the strip's node -> node of the side at its height
    origin: Vec<usize>,
}

impl Strip {
    /// Nodes in threes at the height of each corner (left, right, middle), in twos at that of each mid-side node.
    fn beside(lines: &[Absorber], mesh: &Mesh, width: f64) -> Strip {
        let (mut points, mut origin, mut twin) = (Vec::new(), Vec::new(), BTreeMap::new());
        let second_order = lines[0].line.shape == Shape::Line3;
        let mut row = |node: usize, places: &[f64]| {
            points.extend(places.iter().map(|&x| [x, mesh.points[node][1]]));
            origin.extend(places.iter().map(|_| node));
            points.len() - places.len()
        };
        let corner: &[f64] = if second_order { &[0., width, width / 2.] } else { &[0., width] };
        let mut above = row(ends(&lines[0].line, mesh)[0], corner);
        twin.insert(ends(&lines[0].line, mesh)[0], above);
        let border = |line: [usize; 3]| match second_order {
            true => Border { shape: Shape::Line3, nodes: line.to_vec() },
            false => Border { shape: Shape::Line2, nodes: line[..2].to_vec() },
        };
        let top = border([above + 1, above, above + 2]);
        let mut faces = Vec::new();
        for Absorber { line, .. } in lines {
            let [top, bottom] = ends(line, mesh);
            let middle = second_order.then(|| row(line.nodes[2], &[0., width]));
            let below = row(bottom, corner);
            twin.insert(top, above);
            twin.insert(bottom, below);
            twin.extend(middle.map(|middle| (line.nodes[2], middle)));
            let mut nodes = vec![below, below + 1, above + 1, above];
            nodes.extend(middle.iter().flat_map(|m| [below + 2, m + 1, above + 2, *m]));
            faces.push(Cell { shape: if second_order { Shape::Quad8 } else { Shape::Quad4 }, nodes });
            above = below;
        }
        Strip { points, faces, top, base: border([above, above + 1, above + 2]), twin, origin }
    }
}

/// The strip with the materials behind the side's lines, the base below its lowest corner, the load on its highest.
fn column(name: &str, model: &Model, lines: &[Absorber], strip: &Strip) -> Result<Model> {
    let lowest = strip.origin[strip.base.nodes[0]];
    // what lets waves out at the side's foot, other than the side itself
    let at_foot = |a: &&Absorber| a.line.nodes.contains(&lowest) && !a.line.is_upright(&model.mesh);
    let base =
        model.absorbers.iter().find(at_foot).map(|a| Absorber { line: strip.base.clone(), face: 0, ..a.clone() });
    let loads = model.loads.iter().filter_map(|load| on_column(name, model, lines, strip, load).transpose());
    let still = vec![[0.; 2]; strip.points.len()];
    Ok(Model {
        mesh: Mesh {
            name: format!("the column beyond \"{name}\""),
            points: strip.points.clone(),
            tags: (1..=strip.points.len()).collect(),
            cells: strip.faces.clone(),
            ..Mesh::default()
        }
        .into(),
        material_of: lines.iter().map(|line| model.material_of[line.face]).collect(),
        fixed: strip.origin.iter().map(|&n| [true, model.fixed[n][1]]).collect(),
        absorbers: base.into_iter().collect(),
        loads: loads.collect::<Result<_>>()?,
        initial: Initial { displacement: still.clone(), velocity: still },
        gravity: 0.,
        seams: vec![],
        bodies: vec![],
        pairs: [].into(),
        joints: [].into(),
        laws: vec![],
        light: vec![false; strip.points.len()],
        probes: vec![],
        free_fields: vec![],
        warnings: vec![],
        ..model.clone()
    })
}

/// The load as the column feels it: what acts on the line that meets the side's top, or on the faces behind the side.
fn on_column(name: &str, model: &Model, lines: &[Absorber], strip: &Strip, load: &Load) -> Result<Option<Load>> {
    let top = strip.origin[strip.top.nodes[0]];
    let at_top = |line: &&Border| line.nodes.contains(&top) && !line.is_upright(&model.mesh);
    if let Target::Pressure { lines } | Target::Traction { lines, .. } = &load.target {
        let meets = |line: &&Border| !at_top(line) && line.nodes.iter().any(|node| strip.origin.contains(node));
        if let Some(line) = lines.iter().find(meets) {
            let node = line.nodes.iter().find(|n| strip.origin.contains(n)).unwrap_or(&line.nodes[0]);
            let place = place(model.mesh.points[*node]);
            return Err(Error::input(format!(
                "boundaries.{name}: the load on \"{}\" acts on the side or on its foot, at {place}, and the ground beyond \
                 a free-field side feels only what acts on its surface or its weight; end the load before the side, or take \
                 \"viscous\" or a support there",
                load.group
            )));
        }
    }
    let (sideways, target) = match &load.target {
        Target::Pressure { lines } => match lines.iter().find(at_top) {
            None => return Ok(None),
            Some(line) => (line.tangent(&model.mesh)[1], Target::Pressure { lines: vec![strip.top.clone()] }),
        },
        Target::Traction { lines, direction } => match lines.iter().find(at_top) {
            None => return Ok(None),
            Some(_) => (direction[0], Target::Traction { lines: vec![strip.top.clone()], direction: *direction }),
        },
        Target::BodyForce { cells, direction } => {
            let loaded = |&i: &usize| cells.contains(&lines[i].face);
            let cells: Vec<usize> = (0..lines.len()).filter(loaded).collect();
            if cells.is_empty() {
                return Ok(None);
            }
            (direction[0], Target::BodyForce { cells, direction: *direction })
        }
        Target::Force { .. } => return Ok(None),
    };
    if sideways.abs() > UPRIGHT {
        return Err(Error::input(format!(
            "boundaries.{name}: the load on \"{}\" pushes sideways where it meets the side, and the ground beyond a free-field \
             side only moves up and down; let it act straight down there, or end it before the side",
            load.group
        )));
    }
    let pulse = load.front.as_ref().map_or(load.pulse.clone(), |sweep| sweep.pulse(model.mesh.points[top]));
    Ok(Some(Load { target, pulse, front: None, group: load.group.clone() }))
}
