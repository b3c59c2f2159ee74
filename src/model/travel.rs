//! Times that no P wave through level layers can beat.
//!
//! With slowness (p, q), p^2 + q^2 = 1 / c^2, every path satisfies dT = ds / c >= p dx + q dy (Cauchy and Schwarz), so
//! in layers
//!
//! ```text
//! T >= p |dx| + sum of sqrt(1/c_i^2 - p^2) |dy_i|     for every p from 0 to 1 / (fastest c)
//! ```
//!
//! The largest of these is taken: exact for vertical paths (p = 0, the base under a uniform load), a safe lower bound
//! else.

/// Positions are those of the file, to its last digits [m].
pub const SAME_PLACE: f64 = 1e-6;

/// A rectangle [m]; a line or a point where it has no extent.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Region {
    pub x: [f64; 2],
    pub y: [f64; 2],
}

/// The ground's P speeds: (lowest y, highest y [m], c_p [m/s]) of each of its materials.
#[derive(Debug, Clone, PartialEq)]
pub struct Ground(pub Vec<([f64; 2], f64)>);

impl Region {
    pub fn of(points: impl Iterator<Item = [f64; 2]>) -> Option<Region> {
        points.map(|[x, y]| Region { x: [x, x], y: [y, y] }).reduce(|a, b| Region {
            x: [a.x[0].min(b.x[0]), a.x[1].max(b.x[1])],
            y: [a.y[0].min(b.y[0]), a.y[1].max(b.y[1])],
        })
    }

    pub fn point([x, y]: [f64; 2]) -> Region {
        Region { x: [x, x], y: [y, y] }
    }

    pub fn holds(&self, other: &Region) -> bool {
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
    pub fn speed_at(&self, y: f64) -> f64 {
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
    pub fn time_with(&self, bodies: &[Region], a: Region, b: Region) -> f64 {
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

    /// By hand: 3 / 620.140 + 4 / 611.290 + 8 / 631.977 = 24.040 ms down, 8 / 631.977 + 1.8 / 611.290 = 15.603 ms up to
    /// the invert at 5.2 m: 39.64 ms.
    #[test]
    fn the_base_returns_to_the_invert_of_the_papers_pipes_after_39_64_ms() {
        let invert = Region::point([-1.2, -5.2]);
        let t = coral().time(line(0.), line(-15.)) + coral().time(line(-15.), invert);
        assert!((t - 39.643e-3).abs() < 1e-6, "{t}");
    }

    /// In one material the bound is exact at any angle: the top of p dx + sqrt(1/c^2 - p^2) dy is sqrt(dx^2 + dy^2) /
    /// c.
    #[test]
    fn in_one_material_the_bound_is_the_straight_ray() {
        let ground = Ground(vec![([-20., 0.], 500.)]);
        for (dx, dy) in [(3., 4.), (4., 3.), (0., 5.), (5., 0.), (12., 0.5)] {
            let t = ground.time(Region::point([0., 0.]), Region::point([dx, -dy]));
            assert!((t - f64::hypot(dx, dy) / 500.).abs() < 1e-9, "{dx} {dy}: {t}");
        }
    }

    /// Through a slow layer of 2 m over a fast half-space, 30 m along the surface: the head wave arrives first, at 30 /
    /// 600 + 2 * 2 sqrt(1/300^2 - 1/600^2) = 61.55 ms; the bound must not be later, nor earlier than 30 m at the fast
    /// speed.
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
