//! A quantity over time, and how far one run's is from another's.

use crate::results::histories::Peak;

/// One component, the two of a vector, or the values at the rays of a pipe wall, at each time.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct History {
    pub times: Vec<f64>,
    pub values: Vec<Vec<f64>>,
    /// of the rays, ascending [deg]; none where it is a probe's motion
    pub angles: Vec<f64>,
}

/// How far a quantity in one run is from that in another, over the other's largest magnitude [-].
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Change {
    /// max |b(t) - a(t)| / max |b(t)|; round a wall each ray against itself
    pub history: f64,
    /// |max |b| - max |a|| / max |b|
    pub peak: f64,
}

/// The length of a vector; of a component, or of values round a wall, the one of largest magnitude with its sign.
fn size(values: &[f64]) -> f64 {
    match values {
        [x, y] => x.hypot(*y),
        all => all.iter().fold(0., |most: f64, &x| if x.abs() > most.abs() { x } else { most }),
    }
}

impl History {
    /// Until `end` [s], which counts.
    pub fn until(&self, end: f64) -> History {
        let count = self.times.partition_point(|&t| t <= end * (1. + 1e-9));
        let (times, values) = (self.times[..count].to_vec(), self.values[..count].to_vec());
        History { times, values, angles: self.angles.clone() }
    }

    /// The largest magnitude, with the sign of a component or of a section force.
    pub fn peak(&self) -> Peak {
        let rows = self.times.iter().zip(self.values.iter().map(|v| size(v)));
        let larger = |peak: Peak, (&time, value): (&f64, f64)| match value.abs() > peak.value.abs() {
            true => Peak { value, time },
            false => peak,
        };
        rows.fold(Peak::default(), larger)
    }

    /// From `self` to `other`, both at the same times; infinite where `other` is zero and `self` is not.
    pub fn change_to(&self, other: &History) -> Change {
        let scale = other.peak().value.abs();
        let of_scale = |x: f64| if x == 0. { 0. } else { x / scale };
        let distance = |(a, b): (&Vec<f64>, &Vec<f64>)| {
            let a = at_angles(a, &self.angles, &other.angles);
            size(&b.iter().zip(a).map(|(b, a)| b - a).collect::<Vec<_>>()).abs()
        };
        let largest = self.values.iter().zip(&other.values).map(distance).fold(0., f64::max);
        Change { history: of_scale(largest), peak: of_scale((scale - self.peak().value.abs()).abs()) }
    }
}

/// Values round a wall at other rays: straight lines between its own, the last of which is followed by the first.
fn at_angles(values: &[f64], from: &[f64], to: &[f64]) -> Vec<f64> {
    if from == to {
        return values.to_vec();
    }
    let count = from.len();
    let at = |&angle: &f64| {
        let after = from.partition_point(|&a| a <= angle);
        let [i, j] = [(after + count - 1) % count, after % count];
        let span = (from[j] - from[i]).rem_euclid(360.);
        let part = if span > 0. { (angle - from[i]).rem_euclid(360.) / span } else { 0. };
        values[i] + (values[j] - values[i]) * part
    };
    to.iter().map(at).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn history(values: &[&[f64]]) -> History {
        let times = (0..values.len()).map(|i| i as f64).collect();
        History { times, values: values.iter().map(|v| v.to_vec()).collect(), angles: vec![] }
    }

    #[test]
    fn a_change_is_the_largest_distance_over_the_largest_magnitude() {
        let a = history(&[&[0., 0.], &[3., 4.], &[0., 1.]]);
        let b = history(&[&[0., 0.], &[3., 4.], &[0., -3.]]);
        let change = a.change_to(&b);
        assert_eq!((change.history, change.peak), (0.8, 0.));
        assert_eq!(a.until(1.).change_to(&b.until(1.)), Change::default());
        assert_eq!(a.peak(), Peak { value: 5., time: 1. });
        assert!(a.change_to(&history(&[&[0., 0.], &[0., 0.], &[0., 0.]])).history.is_infinite());
        assert_eq!(history(&[&[1.], &[-2.]]).peak(), Peak { value: -2., time: 1. });
    }

    /// Where crown and springline carry nearly the same moment with opposite signs, a thousandth more makes the other
    /// one the largest round the wall: a change of a thousandth, not of twice the moment.
    #[test]
    fn a_wall_is_compared_ray_by_ray_whichever_carries_most() {
        let round = |values: [f64; 4]| History { angles: vec![0., 90., 180., 270.], ..history(&[&values]) };
        let (a, b) = (round([1., -0.999, 1., -0.999]), round([0.999, -1., 0.999, -1.]));
        assert_eq!((a.peak().value, b.peak().value), (1., -1.));
        let change = a.change_to(&b);
        assert!((change.history - 1e-3).abs() < 1e-12 && change.peak == 0., "{change:?}");
    }

    /// A wall of other rays is seen on straight lines between its own, across 360 degrees too.
    #[test]
    fn walls_of_different_rays_are_compared_at_the_same_angles() {
        let coarse = History { angles: vec![10., 100., 190., 280.], ..history(&[&[1., 2., 3., 4.]]) };
        // halves of the way; at 325 and at 0 degrees between 4 at 280 and 1 at 370: 2.5 and 1 + 3 / 9
        let fine = History { angles: vec![0., 10., 55., 325.], ..history(&[&[1. + 1. / 3., 1., 1.5, 2.5]]) };
        assert!(coarse.change_to(&fine).history < 1e-15);
        assert!((at_angles(&[5., 5., 5., 5.], &coarse.angles, &[0., 359.]))[1] == 5.);
    }
}
