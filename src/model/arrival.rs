//! The causal bound: until when no boundary can have been felt at a probe, and which boundaries can be felt at all.
//!
//! What moves, supports or absorbs at a boundary is felt at a probe only after a P wave has run from the load to the
//! boundary and on to the probe: see [`Ground::time`].

use super::initial::Initial;
use super::resolve::{Model, Target};
use super::sides::open_sides;
use super::travel::{Ground, Region, SAME_PLACE};
use crate::physics::material::Material;
use std::collections::BTreeSet;

/// When a boundary can first be felt at a probe [s]; infinite where it cannot.
#[derive(Debug, Clone, PartialEq)]
pub struct Return {
    pub probe: String,
    /// of a front that runs through the ground alone
    pub through_ground: f64,
    /// with bodies crossed in no time: nothing can be earlier
    pub not_before: f64,
}

/// What the boundaries of the mesh's bounding box are to the probes.
#[derive(Debug, Clone, PartialEq)]
pub struct Returns {
    pub base: Vec<Return>,
    pub sides: Vec<Return>,
    /// the base holds u_y: it gives a plane wave back whole
    pub base_is_held: bool,
    /// u_x = 0 or free field, under a load all over the level surface of level layers: only waves scattered inside feel
    /// the sides
    pub sides_carry_free_field: bool,
    /// bodies of interfaces, inner borders or inner supports are there to scatter waves
    pub something_scatters: bool,
    /// a pressure all along the top at once
    pub load_is_uniform: bool,
    /// P speed at the base [m/s]
    pub base_speed: f64,
}

/// None where nothing loads the model.
pub fn returns(model: &Model) -> Option<Returns> {
    let ground = ground(model);
    let bodies: Vec<Region> = model.bodies.iter().filter_map(|name| region_of(model, name)).collect();
    let all = Region::of(faces(model, |_| true))?;
    let load = source(model)?;
    let base = Region { y: [all.y[0]; 2], ..all };
    let sides = [0, 1].map(|end| Region { x: [all.x[end]; 2], ..all });
    let rollers = sides.iter().all(|side| on(model, *side).all(|n| model.fixed[n][0]))
        && sides.iter().all(|side| on(model, *side).any(|n| !model.fixed[n][1]));
    let uniform = is_uniform(model, all, load);
    let columns = [-1., 1.].iter().all(|&outward| model.free_fields.iter().any(|f| f.outward == outward));
    let carry = (rollers || columns) && uniform && is_level(&ground);

    let at = |node: usize| Region::point(model.mesh.points[node]);
    let to_and_fro = |bodies: &[Region], from: Region, by: Region, to: Region| {
        ground.time_with(bodies, from, by) + ground.time_with(bodies, by, to)
    };
    let scatterers: Vec<Region> = bodies.iter().copied().chain(obstacles(model, all, &bodies)).collect();
    // what scatters is struck first, then sends waves to the side
    let by_scatterer = |side: Region, probe: Region, between: &[Region]| {
        let path = |&b: &Region| ground.time_with(between, load, b) + to_and_fro(between, b, side, probe);
        scatterers.iter().map(path).fold(f64::INFINITY, f64::min)
    };
    let by_side = |side: Region, probe: Region, between: &[Region]| match carry {
        true => by_scatterer(side, probe, between),
        false => to_and_fro(between, load, side, probe),
    };
    let start = start(model);
    let of_probes = |time: &dyn Fn(Region, &[Region]) -> f64| {
        let one = |p: &super::probes::NodeProbe| Return {
            probe: p.name.clone(),
            through_ground: start + time(at(p.node), &[]),
            not_before: start + time(at(p.node), &bodies),
        };
        model.probes.iter().map(one).collect()
    };
    Some(Returns {
        base: of_probes(&|probe, between| to_and_fro(between, load, base, probe)),
        sides: of_probes(&|probe, between| by_side(sides[0], probe, between).min(by_side(sides[1], probe, between))),
        base_is_held: on(model, base).all(|n| model.fixed[n][1]),
        sides_carry_free_field: carry,
        load_is_uniform: uniform,
        base_speed: ground.speed_at(all.y[0]),
        something_scatters: !scatterers.is_empty(),
    })
}

/// P speeds of all materials that are no interface's body.
fn ground(model: &Model) -> Ground {
    let speed = |m: &Material| m.p_speed();
    let is_ground = |name: &String| !model.bodies.contains(name);
    let materials = model.materials.iter().filter(|(name, _)| is_ground(name));
    Ground(materials.filter_map(|(name, m)| Some((region_of(model, name)?.y, speed(m)))).collect())
}

fn region_of(model: &Model, material: &str) -> Option<Region> {
    let number = model.materials.iter().position(|(name, _)| name == material)?;
    Region::of(faces(model, |cell| model.material_of[cell] == Some(number)))
}

/// The corners of the faces wanted.
fn faces<'a>(model: &'a Model, wanted: impl Fn(usize) -> bool + 'a) -> impl Iterator<Item = [f64; 2]> + 'a {
    let cells = model.faces().map(|(cell, _)| cell).filter(move |&cell| wanted(cell));
    cells.flat_map(|cell| model.mesh.cells[cell].nodes.iter().map(|&n| model.mesh.points[n]))
}

/// Nodes of faces in a region.
fn on(model: &Model, region: Region) -> impl Iterator<Item = usize> + '_ {
    let inside = move |range: [f64; 2], x: f64| range[0] - SAME_PLACE <= x && x <= range[1] + SAME_PLACE;
    let nodes = model.faces().flat_map(|(cell, _)| model.mesh.cells[cell].nodes.iter().copied());
    nodes.filter(move |&n| inside(region.x, model.mesh.points[n][0]) && inside(region.y, model.mesh.points[n][1]))
}

/// Places inside at which a plane wave from the surface meets what it would not in endless ground: inner borders, as
/// those of a cavity, and nodes held away from the box's edges, or along a base that is held or open in part. Those in
/// `bodies` are known.
fn obstacles(model: &Model, all: Region, bodies: &[Region]) -> Vec<Region> {
    let near = |a: f64, b: f64| (a - b).abs() < SAME_PLACE;
    let place = |node: usize| model.mesh.points[node];
    let is_level = |y: f64, nodes: &[usize]| nodes.iter().all(|&n| near(place(n)[1], y));
    let is_upright = |nodes: &[usize]| all.x.iter().any(|&x| nodes.iter().all(|&n| near(place(n)[0], x)));
    let borders = open_sides(&model.mesh).into_iter().map(|side| [side[0], side[1]]);
    let inner = borders.filter(|line| !all.y.iter().any(|&y| is_level(y, line)) && !is_upright(line));

    let base: Vec<usize> = on(model, Region { y: [all.y[0]; 2], ..all }).collect();
    let dashpots = model.absorbers.iter().filter(|a| is_level(all.y[0], &a.line.nodes));
    let dashpots: BTreeSet<usize> = dashpots.flat_map(|a| a.line.nodes.iter().copied()).collect();
    let alike = |is: &dyn Fn(usize) -> bool| base.iter().all(|&n| is(n)) || !base.iter().any(|&n| is(n));
    let base_is_even = alike(&|n| model.fixed[n][1]) && alike(&|n| dashpots.contains(&n));
    let uneven = base.iter().copied().filter(|_| !base_is_even);
    // rollers on the sides, and an even base, are no obstacles
    let held = on(model, all).filter(|&n| match model.fixed[n] {
        [false, false] => false,
        [true, false] if is_upright(&[n]) => false,
        _ => !is_level(all.y[0], &[n]),
    });
    let nodes: BTreeSet<usize> = inner.flatten().chain(held).chain(uneven).collect();
    let is_new = |place: &Region| !bodies.iter().any(|b| b.holds(place));
    nodes.into_iter().map(|n| Region::point(place(n))).filter(is_new).collect()
}

/// Everything that is loaded, or in motion at t = 0.
fn source(model: &Model) -> Option<Region> {
    let moves = moving(model).map(|n| model.mesh.points[n]);

    let nodes = model.loads.iter().flat_map(|load| match &load.target {
        Target::Pressure { lines } | Target::Traction { lines, .. } => {
            lines.iter().flat_map(|l| l.nodes.iter().copied()).collect::<Vec<_>>()
        }
        Target::BodyForce { cells, .. } => {
            cells.iter().flat_map(|&c| model.mesh.cells[c].nodes.iter().copied()).collect()
        }
        Target::Force { nodes, .. } => nodes.clone(),
    });
    Region::of(nodes.map(|n| model.mesh.points[n]).chain(moves))
}

/// Nodes displaced or in motion at t = 0.
fn moving(model: &Model) -> impl Iterator<Item = usize> + '_ {
    let Initial { displacement, velocity } = &model.initial;
    (0..displacement.len()).filter(|&n| displacement[n] != [0.; 2] || velocity[n] != [0.; 2])
}

/// Pressure all along the top at once, and nothing else.
fn is_uniform(model: &Model, all: Region, load: Region) -> bool {
    let top = Region { y: [all.y[1]; 2], ..all };
    let same = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).abs() < SAME_PLACE && (a[1] - b[1]).abs() < SAME_PLACE;
    let length: f64 = model.loads.iter().map(|l| covered(model, &l.target)).fold(f64::INFINITY, f64::min);
    let at_once = model.loads.iter().all(|l| l.front.is_none());
    let at_rest = moving(model).next().is_none();
    at_once
        && at_rest
        && same(load.x, top.x)
        && same(load.y, top.y)
        && (length - (top.x[1] - top.x[0])).abs() < SAME_PLACE
}

/// When the first load begins [s]; 0 for a front that sweeps, which is safe, and where something moves from the start.
fn start(model: &Model) -> f64 {
    if moving(model).next().is_some() {
        return 0.;
    }
    let starts = model.loads.iter().map(|l| if l.front.is_some() { 0. } else { l.pulse.start().max(0.) });
    starts.reduce(f64::min).unwrap_or(0.)
}

/// Length of the lines under pressure [m].
fn covered(model: &Model, target: &Target) -> f64 {
    let Target::Pressure { lines } = target else { return 0. };
    let ends = lines.iter().map(|l| [l.nodes[0], l.nodes[1]].map(|n| model.mesh.points[n]));
    ends.map(|[a, b]| (a[0] - b[0]).hypot(a[1] - b[1])).sum()
}

/// No two materials of the ground share a level.
fn is_level(ground: &Ground) -> bool {
    let ranges: Vec<[f64; 2]> = ground.0.iter().map(|(range, _)| *range).collect();
    let overlap = |a: [f64; 2], b: [f64; 2]| a[0].max(b[0]) < a[1].min(b[1]) - SAME_PLACE;
    !(0..ranges.len()).any(|i| (0..i).any(|j| overlap(ranges[i], ranges[j])))
}
