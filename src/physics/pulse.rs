//! Histories in time of a load: every law is zero before t = 0.

use std::f64::consts::PI;

/// The value of a load over time; a peak or value in the load's own unit [Pa, N/m^3 or N/m], times in seconds.
#[derive(Debug, Clone, PartialEq)]
pub enum Pulse {
    /// Blast wave as a triangle, THEORY eq. (1): p(t) = peak (1 - t/duration) for 0 <= t <= duration, then 0.
    Linear { peak: f64, duration: f64 },
    /// p(t) = peak for t >= 0.
    Step { peak: f64 },
    /// p(t) = peak t/duration until `duration`, then peak.
    Ramp { peak: f64, duration: f64 },
    /// p(t) = peak sin(pi t/duration) for 0 <= t <= duration, then 0.
    HalfSine { peak: f64, duration: f64 },
    /// Modified Friedlander pulse: p(t) = peak (1 - t/duration) exp(-decay t/duration) for 0 <= t <= duration, then its
    /// negative phase, if it has one.
    Friedlander { peak: f64, duration: f64, decay: f64, negative: Option<Suction> },
    /// Straight lines between the points, times strictly ascending: zero before the first, the last value held after
    /// it.
    Table { times: Vec<f64>, values: Vec<f64> },
    /// Nothing before `start`, then a straight line to the law's first value within `rise`, then the law:
    /// p(t) = law(t - start - rise).
    Delayed { law: Box<Pulse>, start: f64, rise: f64 },
}

/// Negative phase p(t) = -6.75 peak s (1 - s)^2 of 0 <= s <= 1, s the time since the positive phase over `duration`;
/// deepest, -peak, at s = 1/3 (NAVFAC DM 2.08).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Suction {
    /// greater than 0, in the load's own unit
    pub peak: f64,
    /// [s]
    pub duration: f64,
}

impl Pulse {
    /// Value at time `t`; at a jump, the value after it.
    pub fn at(&self, t: f64) -> f64 {
        match self {
            Pulse::Linear { peak, duration } if (0.0..=*duration).contains(&t) => peak * (1.0 - t / duration),
            Pulse::Linear { .. } => 0.0,
            Pulse::Step { peak } if t >= 0.0 => *peak,
            Pulse::Step { .. } => 0.0,
            Pulse::Ramp { peak, duration } => peak * (t / duration).clamp(0.0, 1.0),
            Pulse::HalfSine { peak, duration } if (0.0..=*duration).contains(&t) => peak * (PI * t / duration).sin(),
            Pulse::HalfSine { .. } => 0.0,
            Pulse::Friedlander { peak, duration, decay, .. } if (0.0..=*duration).contains(&t) => {
                peak * (1.0 - t / duration) * (-decay * t / duration).exp()
            }
            Pulse::Friedlander { duration, negative, .. } => negative.map_or(0.0, |n| n.at(t - duration)),
            Pulse::Table { times, values } => interpolate(times, values, t),
            Pulse::Delayed { law, start, rise } => match t - start - law.start() {
                since if since < 0.0 => 0.0,
                since if since < *rise => law.at(law.start()) * since / rise,
                _ => law.at(t - start - rise),
            },
        }
    }

    /// The time from which on the load may be other than zero [s].
    pub fn start(&self) -> f64 {
        match self {
            Pulse::Table { times, .. } => times.first().copied().unwrap_or(0.0),
            Pulse::Delayed { law, start, .. } => start + law.start(),
            _ => 0.0,
        }
    }

    /// The time from which on the load is zero for good [s]; infinite for one that stays.
    pub fn end(&self) -> f64 {
        match self {
            Pulse::Linear { duration, .. } | Pulse::HalfSine { duration, .. } => *duration,
            Pulse::Friedlander { duration, negative, .. } => duration + negative.map_or(0.0, |n| n.duration),
            Pulse::Step { peak } | Pulse::Ramp { peak, .. } => {
                if *peak == 0.0 {
                    0.0
                } else {
                    f64::INFINITY
                }
            }
            Pulse::Table { times, values } => match values.iter().rposition(|&v| v != 0.0) {
                None => times.first().copied().unwrap_or(0.0),
                Some(last) => times.get(last + 1).copied().unwrap_or(f64::INFINITY),
            },
            Pulse::Delayed { law, start, rise } => start + rise + law.end(),
        }
    }

    /// Its greatest magnitude, infinite where a number of it is not finite.
    pub fn largest(&self) -> f64 {
        match self {
            Pulse::Linear { peak, .. } | Pulse::Step { peak } | Pulse::Ramp { peak, .. } => magnitude(&[*peak]),
            Pulse::HalfSine { peak, .. } => magnitude(&[*peak]),
            Pulse::Friedlander { peak, negative, .. } => magnitude(&[*peak, negative.map_or(0.0, |n| n.peak)]),
            Pulse::Table { values, .. } => magnitude(values),
            Pulse::Delayed { law, .. } => law.largest(),
        }
    }

    /// The last time at which the law changes its course [s].
    pub fn last_time(&self) -> f64 {
        match self {
            Pulse::Step { .. } => 0.0,
            Pulse::Linear { duration, .. } | Pulse::Ramp { duration, .. } | Pulse::HalfSine { duration, .. } => {
                *duration
            }
            Pulse::Friedlander { duration, negative, .. } => duration + negative.map_or(0.0, |n| n.duration),
            Pulse::Table { times, .. } => times.last().copied().unwrap_or(0.0),
            Pulse::Delayed { law, start, rise } => start + rise + law.last_time(),
        }
    }

    /// Whether it is zero at all times.
    pub fn is_zero(&self) -> bool {
        match self {
            Pulse::Linear { peak, .. } | Pulse::Step { peak } | Pulse::Ramp { peak, .. } => *peak == 0.0,
            Pulse::HalfSine { peak, .. } | Pulse::Friedlander { peak, .. } => *peak == 0.0,
            Pulse::Table { values, .. } => values.iter().all(|&v| v == 0.0),
            Pulse::Delayed { law, .. } => law.is_zero(),
        }
    }

    /// Whether it begins with a jump, from zero to a value.
    pub fn jumps(&self) -> bool {
        self.at(self.start()) != 0.0
    }

    /// The same history, `factor` times as large.
    pub fn scaled(self, factor: f64) -> Pulse {
        match self {
            Pulse::Linear { peak, duration } => Pulse::Linear { peak: factor * peak, duration },
            Pulse::Step { peak } => Pulse::Step { peak: factor * peak },
            Pulse::Ramp { peak, duration } => Pulse::Ramp { peak: factor * peak, duration },
            Pulse::HalfSine { peak, duration } => Pulse::HalfSine { peak: factor * peak, duration },
            Pulse::Friedlander { peak, duration, decay, negative } => {
                let negative = negative.map(|n| Suction { peak: factor * n.peak, ..n });
                Pulse::Friedlander { peak: factor * peak, duration, decay, negative }
            }
            Pulse::Table { times, values } => {
                Pulse::Table { times, values: values.into_iter().map(|v| factor * v).collect() }
            }
            Pulse::Delayed { law, start, rise } => Pulse::Delayed { law: Box::new(law.scaled(factor)), start, rise },
        }
    }

    /// The same history, later by `start`, and with a straight line of `rise` in place of its first jump [s].
    pub fn delayed(self, start: f64, rise: f64) -> Pulse {
        match start == 0.0 && rise == 0.0 {
            true => self,
            false => Pulse::Delayed { law: Box::new(self), start, rise },
        }
    }

    /// Time the load takes from zero to its greatest magnitude [s]; 0 where it jumps.
    pub fn rise_time(&self) -> f64 {
        match self {
            Pulse::Linear { .. } | Pulse::Step { .. } | Pulse::Friedlander { .. } => 0.0,
            Pulse::Ramp { duration, .. } => *duration,
            Pulse::HalfSine { duration, .. } => duration / 2.0,
            Pulse::Table { times, values } => rise_of(times, values),
            Pulse::Delayed { law, rise, .. } => rise + law.rise_time(),
        }
    }
}

impl Suction {
    /// `t` since the end of the positive phase [s].
    fn at(&self, t: f64) -> f64 {
        let s = (t / self.duration).clamp(0.0, 1.0);
        -6.75 * self.peak * s * (1.0 - s).powi(2)
    }
}

fn magnitude(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |largest, v| if v.is_finite() { v.abs().max(largest) } else { f64::INFINITY })
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

    /// NAVFAC DM 2.08: the negative phase is deepest, exactly its peak, at a third of its duration.
    #[test]
    fn the_negative_phase_has_its_peak_at_a_third_and_ends() {
        let p = |t| {
            let negative = Some(Suction { peak: 2.0, duration: 3.0 });
            Pulse::Friedlander { peak: 10.0, duration: 1.0, decay: 1.5, negative }.at(t)
        };
        assert_eq!([p(-1e-9), p(0.0), p(1.0), p(4.0), p(9.0)], [0.0, 10.0, 0.0, 0.0, 0.0]);
        assert!((p(2.0) + 2.0).abs() < 1e-14);
        assert!((p(0.5) - 10.0 * 0.5 * (-0.75_f64).exp()).abs() < 1e-14);
        assert!(p(1.9) > -2.0 && p(2.1) > -2.0);
    }

    #[test]
    fn a_ramp_is_held_and_a_half_sine_ends() {
        let ramp = Pulse::Ramp { peak: 4.0, duration: 2.0 };
        assert_eq!([-1.0, 0.0, 0.5, 2.0, 7.0].map(|t| ramp.at(t)), [0.0, 0.0, 1.0, 4.0, 4.0]);
        let sine = Pulse::HalfSine { peak: 4.0, duration: 2.0 };
        let expected = [0.0, 0.0, 4.0 * 0.5_f64.sqrt(), 4.0, 0.0];
        for (t, p) in [-0.5, 0.0, 0.5, 1.0, 2.1].into_iter().zip(expected) {
            assert!((sine.at(t) - p).abs() < 1e-15, "t = {t}");
        }
        assert_eq!([ramp.rise_time(), sine.rise_time()], [2.0, 1.0]);
    }

    #[test]
    fn a_load_ends_where_it_is_zero_for_good_or_never() {
        let table = |values: &[f64]| Pulse::Table { times: vec![1.0, 2.0, 4.0, 9.0], values: values.to_vec() };
        let negative = Some(Suction { peak: 1.0, duration: 3.0 });
        for (pulse, end) in [
            (Pulse::Linear { peak: 1.0, duration: 2.0 }, 2.0),
            (Pulse::Step { peak: 1.0 }, f64::INFINITY),
            (Pulse::Ramp { peak: 1.0, duration: 2.0 }, f64::INFINITY),
            (Pulse::Friedlander { peak: 1.0, duration: 2.0, decay: 1.0, negative }, 5.0),
            (table(&[0.0, 1.0, 0.0, 0.0]), 4.0),
            (table(&[0.0, 1.0, 0.0, 0.5]), f64::INFINITY),
            (table(&[0.0; 4]), 1.0),
            (Pulse::Linear { peak: 1.0, duration: 2.0 }.delayed(10.0, 0.5), 12.5),
        ] {
            assert_eq!(pulse.end(), end, "{pulse:?}");
            assert!(end.is_infinite() || pulse.at(end) == 0.0 && pulse.at(end + 1.0) == 0.0, "{pulse:?}");
        }
    }

    #[test]
    fn a_rise_goes_straight_to_the_first_value_and_keeps_the_law_behind_it() {
        let p = Pulse::Linear { peak: 8.0, duration: 4.0 }.delayed(10.0, 2.0);
        for (t, expected) in [(9.9, 0.0), (10.0, 0.0), (11.0, 4.0), (12.0, 8.0), (14.0, 4.0), (16.0, 0.0), (17.0, 0.0)]
        {
            assert!((p.at(t) - expected).abs() < 1e-15, "t = {t}");
        }
        assert_eq!((p.start(), p.rise_time(), p.jumps()), (10.0, 2.0, false));
        let table = Pulse::Table { times: vec![1.0, 2.0], values: vec![6.0, 0.0] }.delayed(0.0, 0.5);
        assert_eq!([0.9, 1.25, 1.5, 2.0, 2.5].map(|t| table.at(t)), [0.0, 3.0, 6.0, 3.0, 0.0]);
        let twice = p.clone().scaled(2.0);
        assert!([11.0, 13.0].iter().all(|&t| twice.at(t) == 2.0 * p.at(t)));
        assert_eq!(Pulse::Step { peak: 1.0 }.delayed(0.0, 0.0), Pulse::Step { peak: 1.0 });
    }
}
