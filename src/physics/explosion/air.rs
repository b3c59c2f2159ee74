//! A shock in air as an ideal gas with gamma = 1.4: exact relations behind and at the front (Rankine and Hugoniot).

/// Standard atmosphere [Pa].
pub const ATMOSPHERE: f64 = 101_325.;
/// Speed of sound at 15 degrees Celsius [m/s].
pub const SOUND: f64 = 340.29;

/// Peak on a wall that the wave meets at right angles: P_r = 2 P_s (7 P_0 + 4 P_s) / (7 P_0 + P_s) [Pa].
pub fn reflected(peak: f64) -> f64 {
    2. * peak * (7. * ATMOSPHERE + 4. * peak) / (7. * ATMOSPHERE + peak)
}

/// Pressure of the wind behind the front: q = 5 P_s^2 / 2(P_s + 7 P_0) [Pa].
pub fn dynamic(peak: f64) -> f64 {
    5. * peak * peak / (2. * (peak + 7. * ATMOSPHERE))
}

/// Speed of the front: U = c_0 sqrt(1 + 6 P_s / 7 P_0) [m/s].
pub fn front_speed(peak: f64) -> f64 {
    SOUND * (1. + 6. * peak / (7. * ATMOSPHERE)).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Values computed independently, six digits (P_0 = 101.325 kPa, c_0 = 340.29 m/s).
    #[test]
    fn shock_relations_give_the_reference_values() {
        let rows = [
            (10e3, [20.8342e3, 0.34757e3, 354.391]),
            (100e3, [274.140e3, 30.8918e3, 462.336]),
            (1000e3, [5510.26e3, 1462.61e3, 1046.60]),
        ];
        for (p, expected) in rows {
            for (value, expected) in [reflected(p), dynamic(p), front_speed(p)].into_iter().zip(expected) {
                assert!((value / expected - 1.).abs() < 2e-5, "P = {p} Pa: {value}, not {expected}");
            }
        }
        // 115.7 kPa travel at 479 m/s, printed to three digits
        assert!((front_speed(115.7e3) - 479.).abs() < 0.7, "{}", front_speed(115.7e3));
    }
}
