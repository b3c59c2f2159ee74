//! Swisdak's constants against the table printed in his paper (*Simplified Kingery airblast calculations*, ADA526744) and
//! against Kingery and Bulmash; the closed formulas and the air against properties.

use super::kingery_bulmash::value;
use super::{Burst, Explosive, air, kingery_bulmash, peaks, place, swisdak, table};

/// The printed table: Z, t_a, P_so, P_r, t_d, i_s, i_r, U [km/s], 1 kg.
const SWISDAK: [[f64; 8]; 31] = [
    [0.2, 0.037, 17310.36, 185301., 0.243, 369.5, 10520., 3.962],
    [0.3, 0.066, 10180., 97546., 0.222, 215.7, 5285., 3.098],
    [0.4, 0.101, 6853., 59549., 0.234, 175.1, 3336., 2.561],
    [0.5, 0.143, 4888., 39422., 0.281, 166.2, 2371., 2.178],
    [0.6, 0.193, 3613., 27381., 0.378, 170.9, 1810., 1.887],
    [0.7, 0.25, 2744., 19624., 0.548, 183.4, 1449., 1.658],
    [0.8, 0.315, 2129., 14390., 0.818, 201.5, 1201., 1.473],
    [0.9, 0.387, 1684., 10746., 1.211, 223.9, 1021., 1.322],
    [1., 0.467, 1354., 8152., 1.72, 236.3, 884.7, 1.196],
    [1.5, 0.989, 551.4, 2511., 2.148, 177.4, 520.7, 0.808],
    [2., 1.693, 283.7, 1058., 2.053, 134.6, 363.8, 0.623],
    [2.5, 2.557, 171.3, 547.3, 2.305, 107.5, 278., 0.532],
    [3., 3.546, 115.7, 330.7, 2.819, 92.7, 224.3, 0.48],
    [3.5, 4.63, 84.2, 223., 3.177, 81.35, 187.7, 0.447],
    [4., 5.785, 64.89, 162.6, 3.436, 72.42, 161.2, 0.425],
    [4.5, 6.993, 52.14, 125.5, 3.634, 65.22, 141.2, 0.409],
    [5., 8.242, 43.23, 100.9, 3.793, 59.31, 125.6, 0.398],
    [6., 10.82, 31.81, 71.37, 4.048, 50.19, 102.7, 0.383],
    [7., 13.48, 24.94, 54.64, 4.258, 43.48, 86.89, 0.373],
    [8., 16.18, 20.42, 44.05, 4.445, 38.35, 75.25, 0.368],
    [9., 18.91, 17.24, 36.8, 4.618, 34.31, 66.35, 0.363],
    [10., 21.66, 14.89, 31.54, 4.779, 31.04, 59.33, 0.361],
    [12., 27.21, 11.67, 24.43, 5.074, 26.07, 48.93, 0.357],
    [15., 35.64, 8.758, 18.11, 5.452, 21.02, 38.72, 0.353],
    [20., 49.93, 6.102, 12.44, 5.94, 15.89, 28.67, 0.349],
    [24., 61.54, 4.871, 9.802, 6.238, 13.29, 23.7, 0.347],
    [28., 73.22, 3.922, 7.979, 6.487, 11.41, 20.17, 0.345],
    [32., 84.89, 3.25, 6.637, 6.712, 9.982, 17.53, 0.344],
    [34., 90.69, 2.984, 6.088, 6.821, 9.37, 16.45, 0.344],
    [36., 96.44, 2.754, 5.602, 6.932, 8.818, 15.49, 0.344],
    [40., 107.8, 2.375, 4.775, 7.162, 7.885, 13.85, 0.344],
];

/// Coefficients up to a Z.
type Piece = (f64, &'static [f64]);

/// The pieces in the order of the table's columns.
const SWISDAK_PIECES: [&[Piece]; 7] = [
    &swisdak::ARRIVAL,
    &swisdak::INCIDENT_PRESSURE,
    &swisdak::REFLECTED_PRESSURE,
    &swisdak::DURATION,
    &swisdak::INCIDENT_IMPULSE,
    &swisdak::REFLECTED_IMPULSE,
    &swisdak::SPEED,
];

/// Half a unit of the last of four digits or three decimals.
fn half_a_digit(printed: f64) -> f64 {
    0.500_1 * 10f64.powf(printed.log10().floor() - 3.).max(1e-3)
}

/// Some printed number of this column is missed.
fn swisdak_misses(pieces: &[Piece], column: usize) -> bool {
    SWISDAK.iter().any(|row| (swisdak::value(pieces, row[0]) - row[1 + column]).abs() > half_a_digit(row[1 + column]))
}

#[test]
fn swisdak_gives_every_number_of_his_printed_table() {
    for (column, pieces) in SWISDAK_PIECES.iter().enumerate() {
        assert!(!swisdak_misses(pieces, column), "column {column}");
    }
}

/// Any coefficient that is wrong by 1 % misses a printed number, but for the last three of the arrival's near piece, of
/// which three decimals are printed: these are held by Kingery and Bulmash's arrival, within 0.3 %.
#[test]
fn the_printed_table_sees_a_hundredth_of_swisdaks_coefficients() {
    let mut unseen = Vec::new();
    for (column, pieces) in SWISDAK_PIECES.iter().enumerate() {
        for (number, piece) in pieces.iter().enumerate() {
            for i in 0..piece.1.len() {
                let seen = |relative: f64| {
                    let mut c = piece.1.to_vec();
                    c[i] *= 1. + relative;
                    let mut all = pieces.to_vec();
                    all[number] = (piece.0, c.leak());
                    swisdak_misses(&all, column)
                };
                if !seen(0.01) && !seen(-0.01) {
                    unseen.push((column, number, i));
                }
            }
        }
    }
    assert_eq!(unseen, [(0, 0, 3), (0, 0, 4), (0, 0, 5)]);
}

/// Swisdak's fit follows Kingery and Bulmash over its range, from Z = 0.2 to 40, within these shares, the largest found
/// (2.1 % where his incident impulse has a jump of its own, at Z = 2.38), and its pieces meet within them.
#[test]
fn swisdak_follows_kingery_and_bulmash() {
    let h = &table::HEMISPHERICAL;
    let curves = [
        (h.arrival, 0.003),
        (h.incident_pressure, 0.0136),
        (h.reflected_pressure, 0.0096),
        (h.duration, 0.0165),
        (h.incident_impulse, 0.0215),
        (h.reflected_impulse, 0.0002),
        (h.speed, 0.0101),
    ];
    for (column, ((branches, tolerance), pieces)) in curves.into_iter().zip(SWISDAK_PIECES).enumerate() {
        for z in (0..=400).map(|i| 0.2 * 200f64.powf(f64::from(i) / 400.)) {
            let error = swisdak::value(pieces, z) / value(branches, z).unwrap() - 1.;
            assert!(error.abs() < tolerance, "column {column}, Z = {z}: {error}");
        }
        for pair in pieces.windows(2) {
            let z = pair[0].0;
            let jump = swisdak::value(&pair[1..], z) / swisdak::value(&pair[..1], z) - 1.;
            assert!(jump.abs() < 0.025, "column {column} at Z = {z}: {jump}");
        }
    }
}

/// The closed formulas: Henrych's branches meet at Z = 0.3 (3e-4) and at 1 (to round-off); Brode's within 7 % at 10 bar;
/// Sadovsky's ground is his air with 2 W, to the constants' two digits; the far field P Z of Kinney and Graham, 83.8 kPa,
/// is Sadovsky's 82.4 within 2 %; a sphere of TNT of 1630 kg/m^3 has the radius that a burst "on the ground" is measured by.
#[test]
fn closed_formulas_fit_together() {
    use peaks::{SADOVSKY_AIR, SADOVSKY_GROUND, brode, henrych, kinney_graham, sadovsky};
    for (z, tolerance) in [(0.3, 4e-4), (1., 1e-12)] {
        let jump = henrych(z) / henrych(f64::next_down(z)) - 1.;
        assert!(jump.abs() < tolerance, "Henrych at Z = {z}: {jump}");
    }
    let ten_bar = (6.7f64 / 9.).cbrt();
    let jump = brode(ten_bar * 1.000_001) / brode(ten_bar * 0.999_999) - 1.;
    assert!(jump.abs() < 0.072, "Brode: {jump}");
    for (i, (air, ground)) in SADOVSKY_AIR.iter().zip(SADOVSKY_GROUND).enumerate() {
        let doubled = air * 2f64.powf((i + 1) as f64 / 3.);
        assert!((doubled / ground - 1.).abs() < 0.005, "Sadovsky's {ground}: {doubled}");
    }
    let far = 1e6;
    let [kinney, sadovsky] = [kinney_graham(far), sadovsky(far, SADOVSKY_AIR)].map(|p| p * far);
    assert!((kinney / sadovsky - 1.).abs() < 0.02, "{kinney} {sadovsky} kPa");
    let volume = 4. / 3. * std::f64::consts::PI * place::RADIUS.powi(3);
    assert!((1630. * volume - 1.).abs() < 2e-3, "{} kg", 1630. * volume);
}

/// c_0 = sqrt(gamma R T) at 15 degrees Celsius, R = 287.053 J/(kg K), gamma = 1.4; and where each burst's duration begins
/// its u is -2, within 2.1 %, as the report's charts end there.
#[test]
fn air_is_the_standard_atmosphere() {
    assert!((air::SOUND - (1.4 * 287.053 * 288.15f64).sqrt()).abs() < 0.005);
    assert_eq!(air::ATMOSPHERE, 101_325.);
    assert_eq!([Burst::Hemispherical, Burst::Spherical].map(kingery_bulmash::duration_from), [0.178, 0.147]);
}

/// Masses of TNT of the same pressure: MSB B02-301 (2017), table 2.2, column of pressures.
#[test]
fn explosives_have_the_equivalences_of_the_swedish_tables() {
    use Explosive::{Anfo, C4, CompositionB, H6, Minol, Octol, Pentolite, Petn, Tetryl, Tnt, Tritonal};
    let table = [
        (Anfo, 0.82),
        (CompositionB, 1.11),
        (C4, 1.37),
        (H6, 1.38),
        (Minol, 1.20),
        (Octol, 1.06),
        (Petn, 1.27),
        (Pentolite, 1.42),
        (Tetryl, 1.07),
        (Tnt, 1.00),
        (Tritonal, 1.07),
    ];
    assert!(table.iter().all(|(explosive, factor)| explosive.equivalence() == *factor));
}
