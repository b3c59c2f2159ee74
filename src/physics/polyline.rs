//! A history in time as points that straight lines join.

use super::pulse::Pulse;

/// Largest way from a chord's middle to the curve, over the chord's larger end.
const BEND: f64 = 1e-3;
/// What is smaller, over the peak, is drawn straight.
const NOTHING: f64 = 1e-7;

/// (t, p) from the beginning, with the value after the jump there, to the last time at which the history bends; from
/// there on it stays. Straight lines between them keep the impulse within 0.1 %.
pub fn points(pulse: &Pulse) -> Vec<[f64; 2]> {
    let curved = |corners: &[f64], peak: f64| {
        let mut points = vec![[corners[0], pulse.at(corners[0])]];
        corners.windows(2).for_each(|ends| refine(pulse, [ends[0], ends[1]], NOTHING * peak.abs(), &mut points));
        points
    };
    match pulse {
        Pulse::Step { peak } => vec![[0., *peak]],
        Pulse::Linear { peak, duration } => vec![[0., *peak], [*duration, 0.]],
        Pulse::Ramp { peak, duration } => vec![[0., 0.], [*duration, *peak]],
        Pulse::HalfSine { peak, duration } => curved(&[0., duration / 2., *duration], *peak),
        Pulse::Friedlander { peak, duration, negative, .. } => {
            // the negative phase turns at 1/3 and bends the other way from 2/3 on
            let later = negative.map_or(vec![], |n| [1., 2., 3.].map(|k| duration + k / 3. * n.duration).to_vec());
            curved(&[vec![0., *duration], later].concat(), *peak)
        }
        Pulse::Table { times, values } => times.iter().zip(values).map(|(t, v)| [*t, *v]).collect(),
        Pulse::Delayed { law, start, rise } => {
            let foot = (*rise > 0.).then_some([start + law.start(), 0.]);
            foot.into_iter().chain(points(law).into_iter().map(|[t, p]| [t + start + rise, p])).collect()
        }
    }
}

/// Impulse of the straight lines between points, and of their magnitude.
pub fn impulse(points: &[[f64; 2]]) -> [f64; 2] {
    let areas = points.windows(2).map(|w| (w[1][0] - w[0][0]) * (w[0][1] + w[1][1]) / 2.);
    areas.fold([0., 0.], |[sum, size], area| [sum + area, size + area.abs()])
}

/// Adds the points after `from` up to `to`, between which the history bends one way.
fn refine(pulse: &Pulse, [from, to]: [f64; 2], nothing: f64, points: &mut Vec<[f64; 2]>) {
    let middle = (from + to) / 2.;
    let [a, m, b] = [from, middle, to].map(|t| pulse.at(t));
    let size = a.abs().max(b.abs());
    if size <= nothing || (m - (a + b) / 2.).abs() <= BEND * size || middle <= from || middle >= to {
        points.push([to, b]);
    } else {
        refine(pulse, [from, middle], nothing, points);
        refine(pulse, [middle, to], nothing, points);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::physics::friedlander::impulse_ratio;
    use crate::physics::pulse::Suction;

    /// The impulse k(b) P T of Friedlander's pulse; the negative phase carries 6.75/12 of its peak times its duration.
    #[test]
    fn the_points_carry_the_impulse_however_steeply_a_pulse_falls() {
        let suction = Suction { peak: 0.5, duration: 3. };
        for b in [-0.9, 0., 0.5, 3., 30., 1e3, 1e4] {
            for negative in [None, Some(suction)] {
                let pulse = Pulse::Friedlander { peak: 2., duration: 4., decay: b, negative };
                let points = points(&pulse);
                let [sum, size] = impulse(&points);
                let lost = if negative.is_some() { 6.75 / 12. * 0.5 * 3. } else { 0. };
                let own = impulse_ratio(b) * 8.;
                assert!((sum - (own - lost)).abs() < 1e-3 * (own + lost), "b = {b}: {sum}");
                assert!((size - (own + lost)).abs() < 1e-3 * (own + lost), "b = {b}: {size}");
                assert!(points.len() < 600, "b = {b}: {} points", points.len());
            }
        }
    }

    #[test]
    fn straight_laws_have_their_corners_only_and_a_delay_moves_them() {
        let linear = Pulse::Linear { peak: 3., duration: 2. };
        assert_eq!(points(&linear), [[0., 3.], [2., 0.]]);
        assert_eq!(points(&linear.clone().delayed(0.5, 0.)), [[0.5, 3.], [2.5, 0.]]);
        assert_eq!(points(&linear.delayed(0.5, 0.25)), [[0.5, 0.], [0.75, 3.], [2.75, 0.]]);
        let table = Pulse::Table { times: vec![1., 2.], values: vec![5., 4.] };
        assert_eq!(points(&table.delayed(1., 1.)), [[2., 0.], [3., 5.], [4., 4.]]);
        // the half sine carries 2/pi of peak times duration
        let [sum, _] = impulse(&points(&Pulse::HalfSine { peak: 1., duration: 1. }));
        assert!((sum * std::f64::consts::PI / 2. - 1.).abs() < 1e-3, "{sum}");
    }
}
