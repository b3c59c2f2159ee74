//! The causal bound: until when no boundary can have been felt at a probe.
//!
//! What moves, supports or absorbs at a boundary is felt at a probe only after a P wave has run from the load to the
//! boundary and on to the probe. With slowness (p, q), p^2 + q^2 = 1 / c^2, every path satisfies dT = ds / c >= p dx + q dy
//! (Cauchy and Schwarz), so in layers
//!
//! ```text
//! T >= p |dx| + sum of sqrt(1/c_i^2 - p^2) |dy_i|     for every p from 0 to 1 / (fastest c)
//! ```
//!
//! The largest of these is taken: exact for vertical paths (p = 0, the base under a uniform load), a safe lower bound else.

use super::initial::Initial;
use super::resolve::{Model, Target};
use super::sides::open_sides;
use crate::physics::material::Material;
use std::collections::BTreeSet;

/// A rectangle [m]; a line or a point where it has no extent.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Region {
    pub x: [f64; 2],
    pub y: [f64; 2],
}

/// The ground's P speeds: (lowest y, highest y [m], c_p [m/s]) of each of its materials.
#[derive(Debug, Clone, PartialEq)]
pub struct Ground(pub Vec<([f64; 2], f64)>);

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
    /// u_x = 0 or free field, under a load all over the level surface of level layers: only waves scattered inside feel the
    /// sides
    pub sides_carry_free_field: bool,
    /// bodies of interfaces, inner borders or inner supports are there to scatter waves
    pub something_scatters: bool,
    /// a pressure all along the top at once
    pub load_is_uniform: bool,
    /// P speed at the base [m/s]
    pub base_speed: f64,
}

impl Region {
    fn of(points: impl Iterator<Item = [f64; 2]>) -> Option<Region> {
        points.map(|[x, y]| Region { x: [x, x], y: [y, y] }).reduce(|a, b| Region {
            x: [a.x[0].min(b.x[0]), a.x[1].max(b.x[1])],
            y: [a.y[0].min(b.y[0]), a.y[1].max(b.y[1])],
        })
    }

    fn point([x, y]: [f64; 2]) -> Region {
        Region { x: [x, x], y: [y, y] }
    }

    fn holds(&self, other: &Region) -> bool {
        let inside = |a: [f64; 2], b: [f64; 2]| a[0] - SAME_PLACE <= b[0] && b[1] <= a[1] + SAME_PLACE;
        inside(self.x, other.x) && inside(self.y, other.y)
    }
}

/// What lies between two intervals: from the end of the lower to the start of the upper; nothing where they overlap.
fn gap(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    let (low, high) = (a[1].min(b[1]), a[0].max(b[0]));
    [low, high.max(low)]
}

impl Ground {
    /// The fastest P speed anywhere [m/s].
    pub fn fastest(&self) -> f64 {
        self.0.iter().map(|&(_, c)| c).fold(0., f64::max)
    }

    /// The fastest P speed at a level [m/s].
    fn speed_at(&self, y: f64) -> f64 {
        let there = self.0.iter().filter(|(range, _)| (range[0]..=range[1]).contains(&y)).map(|&(_, c)| c);
        let found = there.fold(0., f64::max);
        if found > 0. { found } else { self.fastest() }
    }

    /// (thickness [m], c_p [m/s]) of the layers from `low` to `high`.
    fn layers(&self, [low, high]: [f64; 2]) -> Vec<(f64, f64)> {
        let mut cuts: Vec<f64> =
            self.0.iter().flat_map(|(range, _)| *range).filter(|y| low < *y && *y < high).collect();
        cuts.extend([low, high]);
        cuts.sort_by(f64::total_cmp);
        cuts.windows(2).map(|c| (c[1] - c[0], self.speed_at((c[0] + c[1]) / 2.))).collect()
    }

    /// Time [s] that no path through the ground from `a` to `b` can beat.
    pub fn time(&self, a: Region, b: Region) -> f64 {
        let [left, right] = gap(a.x, b.x);
        let layers = self.layers(gap(a.y, b.y));
        let bound = |p: f64| {
            let vertical = layers.iter().map(|(dy, c)| dy * (1. / (c * c) - p * p).max(0.).sqrt());
            p * (right - left) + vertical.sum::<f64>()
        };
        // concave in p: golden or ternary search finds its top, and any p is a valid bound
        let [mut low, mut high] = [0., 1. / self.fastest()];
        for _ in 0..80 {
            let [p, q] = [low + (high - low) / 3., high - (high - low) / 3.];
            if bound(p) < bound(q) { low = p } else { high = q }
        }
        [0., low, 1. / self.fastest()].map(bound).into_iter().fold(0., f64::max)
    }

    /// [`Ground::time`] where a wave may also run through `bodies`, each crossed in no time.
    fn time_with(&self, bodies: &[Region], a: Region, b: Region) -> f64 {
        let mut reached: Vec<f64> = bodies.iter().map(|&body| self.time(a, body)).collect();
        for _ in bodies {
            for i in 0..bodies.len() {
                for j in 0..bodies.len() {
                    reached[j] = reached[j].min(reached[i] + self.time(bodies[i], bodies[j]));
                }
            }
        }
        let onwards = bodies.iter().zip(&reached).map(|(&body, t)| t + self.time(body, b));
        onwards.fold(self.time(a, b), f64::min)
    }
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

/// Positions are those of the file, to its last digits.
const SAME_PLACE: f64 = 1e-6;

/// Nodes of faces in a region.
fn on(model: &Model, region: Region) -> impl Iterator<Item = usize> + '_ {
    let inside = move |range: [f64; 2], x: f64| range[0] - SAME_PLACE <= x && x <= range[1] + SAME_PLACE;
    let nodes = model.faces().flat_map(|(cell, _)| model.mesh.cells[cell].nodes.iter().copied());
    nodes.filter(move |&n| inside(region.x, model.mesh.points[n][0]) && inside(region.y, model.mesh.points[n][1]))
}

/// Places inside at which a plane wave from the surface meets what it would not in endless ground: inner borders, as those of
/// a cavity, and nodes held away from the box's edges, or along a base that is held or open in part. Those in `bodies` are
/// known.
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

#[cfg(test)]
mod tests {
    use super::*;

    /// The paper's three layers, P speeds from its Table 2 to six digits.
    fn coral() -> Ground {
        Ground(vec![([-3., 0.], 620.140), ([-7., -3.], 611.290), ([-15., -7.], 631.977)])
    }

    fn line(y: f64) -> Region {
        Region { x: [-12.5, 12.5], y: [y, y] }
    }

    /// By hand: 3 / 620.140 + 4 / 611.290 + 8 / 631.977 = 24.040 ms down, 8 / 631.977 + 1.8 / 611.290 = 15.603 ms up to the
    /// invert at 5.2 m: 39.64 ms.
    #[test]
    fn the_base_returns_to_the_invert_of_the_papers_pipes_after_39_64_ms() {
        let invert = Region::point([-1.2, -5.2]);
        let t = coral().time(line(0.), line(-15.)) + coral().time(line(-15.), invert);
        assert!((t - 39.643e-3).abs() < 1e-6, "{t}");
    }

    /// In one material the bound is exact at any angle: the top of p dx + sqrt(1/c^2 - p^2) dy is sqrt(dx^2 + dy^2) / c.
    #[test]
    fn in_one_material_the_bound_is_the_straight_ray() {
        let ground = Ground(vec![([-20., 0.], 500.)]);
        for (dx, dy) in [(3., 4.), (4., 3.), (0., 5.), (5., 0.), (12., 0.5)] {
            let t = ground.time(Region::point([0., 0.]), Region::point([dx, -dy]));
            assert!((t - f64::hypot(dx, dy) / 500.).abs() < 1e-9, "{dx} {dy}: {t}");
        }
    }

    /// Through a slow layer of 2 m over a fast half-space, 30 m along the surface: the head wave arrives first, at
    /// 30 / 600 + 2 * 2 sqrt(1/300^2 - 1/600^2) = 61.55 ms; the bound must not be later, nor earlier than 30 m at the fast speed.
    #[test]
    fn no_path_beats_the_bound() {
        let ground = Ground(vec![([-2., 0.], 300.), ([-50., -2.], 600.)]);
        let t = ground.time(Region::point([0., 0.]), Region::point([30., 0.]));
        assert!((30. / 600. - 1e-12..0.06155).contains(&t), "{t}");
    }

    #[test]
    fn a_body_shortens_a_path_by_what_it_spans() {
        let ground = Ground(vec![([-20., 0.], 500.)]);
        let body = Region { x: [4., 6.], y: [-1., 1.] };
        let ends = [Region::point([0., 0.]), Region::point([10., 0.])];
        assert!((ground.time_with(&[body], ends[0], ends[1]) - 8. / 500.).abs() < 1e-9);
        assert!((ground.time_with(&[], ends[0], ends[1]) - 10. / 500.).abs() < 1e-9);
    }
}
