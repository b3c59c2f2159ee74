//! Closed formulas for the incident peak overpressure [kPa] of TNT and, where they have them, duration and impulse, per
//! Z = R / W^(1/3) [m/kg^(1/3)]; durations [ms/kg^(1/3)], impulses [kPa ms/kg^(1/3)].

/// Standard atmosphere [kPa].
const ATMOSPHERE: f64 = super::air::ATMOSPHERE / 1e3;
/// 1 kgf/cm^2, exact [kPa]
const KGF_CM2: f64 = 98.0665;
const BAR: f64 = 100.;

/// (Z/a)^n
fn over(z: f64, a: f64, n: i32) -> f64 {
    (z / a).powi(n)
}

/// Kinney and Graham 1985, free air:
/// P/P_0 = 808 (1 + (Z/4.5)^2) / sqrt((1 + (Z/0.048)^2)(1 + (Z/0.32)^2)(1 + (Z/1.35)^2)).
pub fn kinney_graham(z: f64) -> f64 {
    let below = (1. + over(z, 0.048, 2)) * (1. + over(z, 0.32, 2)) * (1. + over(z, 1.35, 2));
    ATMOSPHERE * 808. * (1. + over(z, 4.5, 2)) / below.sqrt()
}

/// t_d = 980 (1 + (Z/0.54)^10) / ((1 + (Z/0.02)^3)(1 + (Z/0.74)^6) sqrt(1 + (Z/6.9)^2)).
pub fn kinney_graham_duration(z: f64) -> f64 {
    let below = (1. + over(z, 0.02, 3)) * (1. + over(z, 0.74, 6)) * (1. + over(z, 6.9, 2)).sqrt();
    980. * (1. + over(z, 0.54, 10)) / below
}

/// i = 6.7 sqrt(1 + (Z/0.23)^4) / (Z^2 (1 + (Z/1.55)^3)^(1/3)).
pub fn kinney_graham_impulse(z: f64) -> f64 {
    6.7 * (1. + over(z, 0.23, 4)).sqrt() / (z * z * (1. + over(z, 1.55, 3)).cbrt())
}

/// Sadovsky: a/Z + b/Z^2 + c/Z^3 kgf/cm^2.
pub fn sadovsky(z: f64, [a, b, c]: [f64; 3]) -> f64 {
    KGF_CM2 * (a / z + b / (z * z) + c / z.powi(3))
}

/// Sadovsky's constants in free air.
pub const SADOVSKY_AIR: [f64; 3] = [0.84, 2.7, 7.0];
/// On the ground: the same charge counted twice.
pub const SADOVSKY_GROUND: [f64; 3] = [1.06, 4.3, 14.0];
/// On the ground, as Soviet and Vietnamese manuals print it.
pub const SADOVSKY_MANUALS: [f64; 3] = [0.95, 3.9, 13.0];

/// t_d = 1.35 sqrt Z in air, 1.7 sqrt Z on the ground: from t_d = 1.35e-3 W^(1/6) sqrt R seconds.
pub fn sadovsky_duration(z: f64, factor: f64) -> f64 {
    factor * z.sqrt()
}

/// Brode 1955, free air: 6.7/Z^3 + 1 bar where that is above 10 bar, else 0.975/Z + 1.455/Z^2 + 5.85/Z^3 - 0.019 bar.
pub fn brode(z: f64) -> f64 {
    let near = 6.7 / z.powi(3) + 1.;
    BAR * if near > 10. { near } else { 0.975 / z + 1.455 / (z * z) + 5.85 / z.powi(3) - 0.019 }
}

/// Henrych 1979, free air, bar: three polynomials in 1/Z that change at Z = 0.3 and 1.
pub fn henrych(z: f64) -> f64 {
    let c: [f64; 4] = match z {
        z if z < 0.3 => [14.072, 5.540, -0.357, 0.00625],
        z if z < 1. => [6.194, -0.326, 2.132, 0.],
        _ => [0.662, 4.05, 3.288, 0.],
    };
    BAR * c.iter().rev().fold(0., |sum, c| (sum + c) / z)
}

/// t_d = 0.107 + 0.444 Z + 0.264 Z^2 - 0.129 Z^3 + 0.0335 Z^4, for Z <= 3 only.
pub fn henrych_duration(z: f64) -> Option<f64> {
    (z <= 3.).then(|| [0.107, 0.444, 0.264, -0.129, 0.0335].iter().rev().fold(0., |sum, c| sum * z + c))
}

/// Mills 1987, free air: 1772/Z^3 - 114/Z^2 + 108/Z.
pub fn mills(z: f64) -> f64 {
    1772. / z.powi(3) - 114. / (z * z) + 108. / z
}

/// Newmark and Hansen 1961, on the ground: 6784 W/R^3 + 93 sqrt(W/R^3) bar, W in tonnes: W/R^3 = 1e-3/Z^3.
pub fn newmark_hansen(z: f64) -> f64 {
    let tonnes = 1e-3 / z.powi(3);
    BAR * (6784. * tonnes + 93. * tonnes.sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A row of values at one Z, as many digits as it prints: within half a unit of the last of five digits.
    fn agree(what: &str, z: f64, value: f64, expected: f64) {
        assert!((value / expected - 1.).abs() < 1e-4, "{what} at Z = {z}: {value}, not {expected}");
    }

    /// Values computed independently from the formulas as printed; the tolerance is their last digit.
    #[test]
    fn closed_formulas_give_the_reference_rows() {
        type Row = (f64, [f64; 3], [f64; 3], f64, f64, Option<f64>, f64);
        let rows: [Row; 4] = [
            (1., [1008.8, 0.52016, 117.16], [1033.6, 1898.6, 1750.5], 826.1, 800.0, Some(0.7195), 972.49),
            (2., [207.93, 1.1700, 86.423], [193.19, 329.01, 301.55], 156.35, 175.45, Some(1.555), 188.78),
            (5., [29.238, 2.4722, 38.881], [32.558, 48.641, 44.130], 28.10, 32.07, None, 31.732),
            (10., [9.9854, 3.4678, 19.607], [11.572, 15.985, 14.416], 9.89, 10.999, None, 9.978),
        ];
        for (z, kinney, sadovsky_row, brode_value, henrych_value, henrych_td, surface) in rows {
            agree("Kinney-Graham", z, kinney_graham(z), kinney[0]);
            agree("Kinney-Graham duration", z, kinney_graham_duration(z), kinney[1]);
            agree("Kinney-Graham impulse", z, kinney_graham_impulse(z), kinney[2]);
            agree("Sadovsky, air", z, sadovsky(z, SADOVSKY_AIR), sadovsky_row[0]);
            agree("Sadovsky, ground", z, sadovsky(z, SADOVSKY_GROUND), sadovsky_row[1]);
            agree("Sadovsky, manuals", z, sadovsky(z, SADOVSKY_MANUALS), sadovsky_row[2]);
            // four and three printed digits
            assert!((brode(z) / brode_value - 1.).abs() < 5e-4, "Brode at {z}: {}", brode(z));
            agree("Henrych", z, henrych(z), henrych_value);
            match (henrych_duration(z), henrych_td) {
                (Some(value), Some(expected)) => assert!((value / expected - 1.).abs() < 5e-4, "Henrych t_d at {z}"),
                (value, expected) => assert_eq!(value, expected),
            }
            agree("Newmark-Hansen", z, newmark_hansen(z), surface);
        }
        // printed without decimals
        for (z, expected, digit) in [(1., 1766., 0.5), (2., 247., 0.5), (5., 31.216, 5e-4), (10., 11.432, 5e-4)] {
            assert!((mills(z) - expected).abs() <= digit, "Mills at {z}: {}", mills(z));
        }
    }

    /// The first two branches of Henrych and the near one of Brode, worked out by hand.
    #[test]
    fn near_branches_are_as_printed() {
        agree("Henrych", 0.2, henrych(0.2), 100. * (14.072 / 0.2 + 5.540 / 0.04 - 0.357 / 0.008 + 0.00625 / 0.0016));
        agree("Henrych", 0.5, henrych(0.5), 100. * (6.194 / 0.5 - 0.326 / 0.25 + 2.132 / 0.125));
        agree("Brode", 0.5, brode(0.5), 100. * (6.7 / 0.125 + 1.));
        agree("Sadovsky's duration", 4., sadovsky_duration(4., 1.35), 2.7);
    }
}
