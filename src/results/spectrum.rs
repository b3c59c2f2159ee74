//! Where in frequency a load lives: the energy spectrum of its history.

use std::f64::consts::PI;

/// Share of the energy of p(t), first <= t <= last, that lies below each of the rising `frequencies` [Hz].
///
/// P(f) = integral of p exp(-2 pi i f t) dt; energy = integral of p^2 dt = 2 integral of |P|^2 df over f > 0
/// (Parseval).
#[derive(Debug, Clone, PartialEq)]
pub struct Spectrum {
    frequencies: Vec<f64>,
    below: Vec<f64>,
}

/// Intervals of the history, of the length last - first; what lies above SAMPLES / 4 length counts as lying there.
const SAMPLES: usize = 2048;
/// Frequencies, equally far apart on a logarithmic scale.
const FREQUENCIES: usize = 300;
/// The lowest of them, times the length: below it |P| is |P(0)|.
const LOWEST: f64 = 0.01;

impl Spectrum {
    /// Of a history from its first moment to its last [s]; none where it is zero throughout.
    pub fn of(history: impl Fn(f64) -> f64, [first, last]: [f64; 2]) -> Option<Spectrum> {
        let length = last - first;
        let dt = length / SAMPLES as f64;
        let weight = |i: usize| if i == 0 || i == SAMPLES { dt / 2. } else { dt };
        let p: Vec<f64> = (0..=SAMPLES).map(|i| history(first + i as f64 * dt)).collect();
        let energy: f64 = p.iter().enumerate().map(|(i, p)| weight(i) * p * p).sum();
        let density = |f: f64| {
            let wave = |i: usize| (2. * PI * f * i as f64 * dt).sin_cos();
            let [re, im] = p.iter().enumerate().fold([0., 0.], |[re, im], (i, p)| {
                let (sin, cos) = wave(i);
                [re + weight(i) * p * cos, im - weight(i) * p * sin]
            });
            re * re + im * im
        };
        let [low, high] = [LOWEST / length, SAMPLES as f64 / (4. * length)];
        let step = (high / low).powf(1. / (FREQUENCIES - 1) as f64);
        let frequencies: Vec<f64> = (0..FREQUENCIES).map(|k| low * step.powi(k as i32)).collect();
        let densities: Vec<f64> = frequencies.iter().map(|&f| density(f)).collect();
        let mut below = vec![2. * density(0.) * low / energy];
        for k in 1..FREQUENCIES {
            let mean = (densities[k] + densities[k - 1]) / 2.;
            below.push(below[k - 1] + 2. * mean * (frequencies[k] - frequencies[k - 1]) / energy);
        }
        (energy > 0. && energy.is_finite()).then_some(Spectrum { frequencies, below })
    }

    /// Share of the energy below `f` [Hz], from 0 to 1.
    pub fn share_below(&self, f: f64) -> f64 {
        let after = self.frequencies.partition_point(|&x| x < f);
        let share = match after {
            0 => self.below[0] * f / self.frequencies[0],
            n if n == self.frequencies.len() => 1.,
            n => {
                let [a, b] = [n - 1, n].map(|i| (self.frequencies[i], self.below[i]));
                a.1 + (b.1 - a.1) * (f - a.0) / (b.0 - a.0)
            }
        };
        share.clamp(0., 1.)
    }

    /// The frequency [Hz] below which that share of the energy lies.
    pub fn frequency_of(&self, share: f64) -> f64 {
        match self.below.partition_point(|&x| x < share) {
            0 => self.frequencies[0],
            n if n == self.below.len() => self.frequencies[n - 1],
            n => {
                let [a, b] = [n - 1, n].map(|i| (self.frequencies[i], self.below[i]));
                a.0 + (b.0 - a.0) * (share - a.1) / (b.1 - a.1)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A triangle of duration tau that jumps at t = 0 has energy p^2 tau / 3 and, far up, |P| = p / (2 pi f): above f
    /// lies the share 3 / (2 pi^2 f tau). At f tau = 10 the next term is smaller by 1 / (pi f tau)^2, far below the
    /// tolerance of 2 %.
    #[test]
    fn a_load_that_jumps_has_a_tail_of_one_over_f() {
        let tau = 0.05;
        let spectrum = Spectrum::of(|t| if t < tau { 1. - t / tau } else { 0. }, [0., 2. * tau]).unwrap();
        let f = 10. / tau;
        let expected = 3. / (2. * PI * PI * f * tau);
        assert!(((1. - spectrum.share_below(f)) / expected - 1.).abs() < 0.02);
    }

    /// P(0) is the impulse p tau / 2, so at low frequencies the share is 2 (p tau / 2)^2 f / (p^2 tau / 3) = 1.5 f tau.
    #[test]
    fn at_low_frequencies_a_pulse_is_its_impulse() {
        let tau = 0.02;
        let spectrum = Spectrum::of(|t| if t < tau { 1. - t / tau } else { 0. }, [0., tau]).unwrap();
        // |P| falls by (2 pi f tau)^2 / 36 relative to P(0): 1e-4 at f tau = 0.01
        assert!((spectrum.share_below(0.01 / tau) / 0.015 - 1.).abs() < 1e-3);
        let half = spectrum.frequency_of(0.5);
        assert!((spectrum.share_below(half) - 0.5).abs() < 0.02);
    }

    #[test]
    fn a_load_of_nothing_has_no_spectrum() {
        assert_eq!(Spectrum::of(|_| 0., [0., 1.]), None);
    }
}
