//! Histories in time of a load: every law is zero before t = 0.

/// The value of a load over time; a peak or value in the load's own unit [Pa, N/m^3 or N/m], times in seconds.
#[derive(Debug, Clone, PartialEq)]
pub enum Pulse {
    /// Blast wave as a triangle, THEORY eq. (1): p(t) = peak (1 - t/duration) for 0 <= t <= duration, then 0.
    Linear { peak: f64, duration: f64 },
    /// p(t) = peak for t >= 0.
    Step { peak: f64 },
    /// Straight lines between the points, times strictly ascending: zero before the first, the last value held after it.
    Table { times: Vec<f64>, values: Vec<f64> },
}

impl Pulse {
    /// Value at time `t`; at a jump, the value after it.
    pub fn at(&self, t: f64) -> f64 {
        match self {
            Pulse::Linear { peak, duration } if (0.0..=*duration).contains(&t) => peak * (1.0 - t / duration),
            Pulse::Linear { .. } => 0.0,
            Pulse::Step { peak } if t >= 0.0 => *peak,
            Pulse::Step { .. } => 0.0,
            Pulse::Table { times, values } => interpolate(times, values, t),
        }
    }

    /// Time the load takes from zero to its greatest magnitude [s]; 0 where it jumps.
    pub fn rise_time(&self) -> f64 {
        match self {
            Pulse::Linear { .. } | Pulse::Step { .. } => 0.0,
            Pulse::Table { times, values } => rise_of(times, values),
        }
    }
}

/// p(t) = p_i + (p_{i+1} - p_i) (t - t_i) / (t_{i+1} - t_i) for t_i <= t < t_{i+1}
fn interpolate(times: &[f64], values: &[f64], t: f64) -> f64 {
    let after = times.partition_point(|&ti| ti <= t);
    match (after, values.last()) {
        (0, _) | (_, None) => 0.0,
        (i, Some(&last)) if i == times.len() => last,
        (i, _) => values[i - 1] + (values[i] - values[i - 1]) * (t - times[i - 1]) / (times[i] - times[i - 1]),
    }
}

/// From the last zero before the peak to the peak; a table that does not begin at zero jumps there.
fn rise_of(times: &[f64], values: &[f64]) -> f64 {
    let peak = values.iter().fold(0.0_f64, |largest, v| largest.max(v.abs()));
    let top = values.iter().position(|v| v.abs() == peak).unwrap_or(0);
    match values[..top].iter().rposition(|&v| v == 0.0) {
        Some(foot) => times[top] - times[foot],
        None => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// THEORY eq. (1), with 100 kPa and 50 ms of the paper's case.
    #[test]
    fn the_linear_law_is_the_papers_triangle() {
        let p = Pulse::Linear { peak: 100e3, duration: 0.05 };
        for (t, expected) in [(-1e-9, 0.0), (0.0, 100e3), (0.0125, 75e3), (0.025, 50e3), (0.05, 0.0), (0.06, 0.0)] {
            assert!((p.at(t) - expected).abs() < 1e-9, "t = {t}");
        }
        assert_eq!(p.rise_time(), 0.0);
    }

    /// The area of a triangle: impulse = peak * duration / 2, by the trapezium rule, exact on a straight line.
    #[test]
    fn the_linear_law_carries_half_of_peak_times_duration() {
        let p = Pulse::Linear { peak: 3.0, duration: 2.0 };
        let dt = 2.0 / 64.0;
        let impulse: f64 = (0..64).map(|i| 0.5 * dt * (p.at(i as f64 * dt) + p.at((i + 1) as f64 * dt))).sum();
        assert!((impulse - 3.0).abs() < 1e-12);
    }

    #[test]
    fn a_step_stays() {
        let p = Pulse::Step { peak: -2.0 };
        assert_eq!([p.at(-1.0), p.at(0.0), p.at(9.0)], [0.0, -2.0, -2.0]);
        assert_eq!(p.rise_time(), 0.0);
    }

    #[test]
    fn a_table_is_straight_between_points_zero_before_and_held_after() {
        let p = Pulse::Table { times: vec![1.0, 2.0, 4.0], values: vec![5.0, 7.0, 1.0] };
        for (t, expected) in [(0.999, 0.0), (1.0, 5.0), (1.5, 6.0), (2.0, 7.0), (3.0, 4.0), (4.0, 1.0), (99.0, 1.0)] {
            assert!((p.at(t) - expected).abs() < 1e-12, "t = {t}");
        }
    }

    #[test]
    fn rise_time_is_measured_from_the_foot_of_the_peak() {
        let rise =
            |values: &[f64]| Pulse::Table { times: vec![0.0, 1.0, 3.0, 4.0], values: values.to_vec() }.rise_time();
        assert_eq!(rise(&[0.0, 2.0, 5.0, 0.0]), 3.0);
        assert_eq!(rise(&[0.0, 0.0, -5.0, 0.0]), 2.0);
        assert_eq!(rise(&[1.0, 2.0, 5.0, 0.0]), 0.0);
        assert_eq!(rise(&[0.0; 4]), 0.0);
    }
}
