//! Friedlander's pulse p = P (1 - t/t_d) exp(-b t/t_d): its decay b, its impulse, and the straight lines drawn for it.

/// Impulse over peak times duration, k(b) = i / (P t_d) = 1/b - (1 - e^-b)/b^2; falls from 0.718 at b = -1 to 0.
pub fn impulse_ratio(b: f64) -> f64 {
    match b.abs() < 1e-3 {
        // the series of the same, whose terms do not cancel; the next one is below b^4/720
        true => 0.5 - b / 6. + b * b / 24. - b.powi(3) / 120.,
        false => 1. / b + (-b).exp_m1() / (b * b),
    }
}

/// Smallest and largest decay that [`decay`] looks for.
const DECAYS: [f64; 2] = [-1., 1e4];

/// The decay b of a pulse with i / (P t_d) = `ratio`, by bisection; none outside k(1e4) to k(-1) = 0.718.
pub fn decay(ratio: f64) -> Option<f64> {
    let [mut low, mut high] = DECAYS;
    if !(impulse_ratio(high)..impulse_ratio(low)).contains(&ratio) {
        return None;
    }
    while high - low > 1e-13 * (1. + high.abs()) {
        let middle = (low + high) / 2.;
        match impulse_ratio(middle) > ratio {
            true => low = middle,
            false => high = middle,
        }
    }
    Some((low + high) / 2.)
}

/// Where the tangent at t = 0 meets zero: t_d / (1 + b) [s], b > -1.
pub fn tangent_duration(duration: f64, b: f64) -> f64 {
    duration / (1. + b)
}

/// Duration of the triangle of the same peak and impulse: 2 i / P = 2 k(b) t_d [s].
pub fn equal_impulse_duration(duration: f64, b: f64) -> f64 {
    2. * impulse_ratio(b) * duration
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::physics::pulse::Pulse;

    /// NAVFAC DM 2.08, equation 13 and its table: k and b as printed, so half a digit of b's last place.
    #[test]
    fn decay_is_the_printed_table() {
        let rows = [(0.7, -0.93), (0.6, -0.52), (0.5, 0.), (0.4, 0.71), (0.3, 1.77), (0.2, 3.67), (0.1, 8.87)];
        for (k, b) in rows {
            let found = decay(k).unwrap();
            assert!((found - b).abs() <= 0.005, "k = {k}: {found}, printed {b}");
            assert!((impulse_ratio(found) - k).abs() < 1e-12, "k = {k}");
        }
        for (k, b) in [(0.7, -0.934), (0.6, -0.524), (0.4, 0.710), (0.3, 1.772), (0.2, 3.673), (0.1, 8.873)] {
            assert!((decay(k).unwrap() - b).abs() <= 0.0005, "k = {k}");
        }
        assert_eq!([decay(0.72), decay(0.), decay(-1.), decay(f64::NAN)], [None; 4]);
    }

    /// Simpson with 2000 intervals: its error, h^4 p''''/180, is below 1e-11 for these b.
    #[test]
    fn impulse_ratio_is_the_area_under_the_pulse() {
        for b in [-0.9, -1e-4, 0., 5e-4, 1e-3, 0.7, 3.67, 8.87] {
            let p = Pulse::Friedlander { peak: 1., duration: 1., decay: b, negative: None };
            let n = 2000;
            let weight = |i: usize| if i == 0 || i == n { 1. } else { 2. + 2. * (i % 2) as f64 };
            let area: f64 = (0..=n).map(|i| weight(i) * p.at(i as f64 / n as f64)).sum::<f64>() / (3. * n as f64);
            assert!((area - impulse_ratio(b)).abs() < 1e-10, "b = {b}: {area}, {}", impulse_ratio(b));
        }
    }

    /// 1000 kg of TNT on the ground at 30 m: t_d = 28.3 ms; P = 115.7 kPa, i = 928 kPa ms give b = 2.01.
    #[test]
    fn straight_lines_have_the_pulses_slope_or_its_impulse() {
        let (peak, duration, b) = (115.7e3, 28.3e-3, 2.);
        let pulse = Pulse::Friedlander { peak, duration, decay: b, negative: None };
        let h = 1e-8; // one-sided quotient: error h p''/2 < 1e-5 of the slope
        let slope = (pulse.at(h) - pulse.at(0.)) / h;
        assert!((slope * tangent_duration(duration, b) / -peak - 1.).abs() < 1e-5);
        let triangle = peak * equal_impulse_duration(duration, b) / 2.;
        assert!((triangle / (impulse_ratio(b) * peak * duration) - 1.).abs() < 1e-14);
    }
}
