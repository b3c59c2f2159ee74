//! The damping ratio that C = alpha M + beta K gives a motion of frequency f:
//!
//! ```text
//! xi(f) = alpha / (4 pi f) + beta pi f
//! ```
//!
//! From c = alpha m + beta k of one mode, xi = c / (2 m omega) and k = m omega^2 (Bathe, Finite Element Procedures,
//! 9.3).

use std::f64::consts::PI;

/// xi(f) [-]; `alpha` [1/s], `beta` [s], `f` [Hz] greater than 0.
pub fn ratio(alpha: f64, beta: f64, f: f64) -> f64 {
    alpha / (4. * PI * f) + beta * PI * f
}

/// Frequency [Hz] of the least ratio, and that ratio: d xi / d f = 0 at 2 pi f = sqrt(alpha / beta), where xi =
/// sqrt(alpha beta).
///
/// None where one of the two is 0: the ratio then falls or rises for ever.
pub fn least(alpha: f64, beta: f64) -> Option<(f64, f64)> {
    (alpha > 0. && beta > 0.).then(|| ((alpha / beta).sqrt() / (2. * PI), (alpha * beta).sqrt()))
}

/// Frequencies [Hz] between which xi(f) <= `most`: the roots of beta pi f^2 - most f + alpha / (4 pi) = 0.
///
/// None where xi is larger everywhere.
pub fn band(alpha: f64, beta: f64, most: f64) -> Option<[f64; 2]> {
    let root = (most * most - alpha * beta).sqrt();
    let high = if beta > 0. { (most + root) / (2. * PI * beta) } else { f64::INFINITY };
    // the smaller root in the form that does not cancel, and that holds for beta = 0
    root.is_finite().then(|| [alpha / (2. * PI * (most + root)), high])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 5 % at 5 and 15 Hz: beta = 2 xi / (omega_1 + omega_2) = 7.957747e-4 s, alpha = omega_1 omega_2 beta = 2.356194
    /// 1/s; by hand, the least ratio is sqrt(alpha beta) = 4.330 % at sqrt(5 * 15) = 8.660 Hz.
    const ALPHA: f64 = 2.356194;
    const BETA: f64 = 7.957747e-4;

    #[test]
    fn the_ratio_is_five_per_cent_where_it_was_fitted_and_least_between() {
        // the coefficients are printed to 7 digits
        assert!((ratio(ALPHA, BETA, 5.) - 0.05).abs() < 1e-8 && (ratio(ALPHA, BETA, 15.) - 0.05).abs() < 1e-8);
        let (f, xi) = least(ALPHA, BETA).unwrap();
        assert!((f - 8.660254).abs() < 1e-5 && (xi - 0.04330127).abs() < 1e-7, "{f} {xi}");
        assert!((ratio(ALPHA, BETA, f) - xi).abs() < 1e-15);
        assert_eq!((least(0., BETA), least(ALPHA, 0.)), (None, None));
    }

    #[test]
    fn the_band_ends_where_the_ratio_is_what_was_allowed() {
        let [low, high] = band(ALPHA, BETA, 0.05).unwrap();
        assert!((low - 5.).abs() < 1e-5 && (high - 15.).abs() < 1e-5, "{low} {high}");
        assert_eq!(band(ALPHA, BETA, 0.04), None);
        let [low, high] = band(0., BETA, 0.05).unwrap();
        assert!(low == 0. && (ratio(0., BETA, high) - 0.05).abs() < 1e-15);
        let [low, high] = band(ALPHA, 0., 0.05).unwrap();
        assert!(high.is_infinite() && (ratio(ALPHA, 0., low) - 0.05).abs() < 1e-15);
    }
}
