//! Swisdak (1994): Kingery and Bulmash's hemispherical burst by shorter polynomials, y = exp(sum c_i (ln Z)^i), metric.
//! (M. M. Swisdak, *Simplified Kingery airblast calculations*, 26th DoD Explosives Safety Seminar.)

/// Coefficients for Z up to the first number [m/kg^(1/3)].
type Branch = (f64, &'static [f64]);

/// [kPa], from Z = 0.2
pub const INCIDENT_PRESSURE: [Branch; 3] = [
    (2.9, &[7.2106, -2.1069, -0.3229, 0.1117, 0.0685]),
    (23.8, &[7.5938, -3.0523, 0.40977, 0.0261, -0.01267]),
    (198.5, &[6.0536, -1.4066]),
];
/// [kPa], from Z = 0.06
pub const REFLECTED_PRESSURE: [Branch; 2] = [
    (2.0, &[9.006, -2.6893, -0.6295, 0.1011, 0.29255, 0.13505, 0.019736]),
    (40.0, &[8.8396, -1.733, -2.64, 2.293, -0.8232, 0.14247, -0.0099]),
];
/// [ms/kg^(1/3)], from Z = 0.06
pub const ARRIVAL: [Branch; 2] = [
    (1.5, &[-0.7604, 1.8058, 0.1257, -0.0437, -0.0310, -0.00669]),
    (40.0, &[-0.7137, 1.5732, 0.5561, -0.4213, 0.1054, -0.00929]),
];
/// [ms/kg^(1/3)], from Z = 0.2
pub const DURATION: [Branch; 3] = [
    (1.02, &[0.5426, 3.2299, -1.5931, -5.9667, -4.0815, -0.9149]),
    (2.8, &[0.5440, 2.7082, -9.7354, 14.3425, -9.7791, 2.8535]),
    (40.0, &[-2.4608, 7.1639, -5.6215, 2.2711, -0.44994, 0.03486]),
];
/// [kPa ms/kg^(1/3)], from Z = 0.2
pub const INCIDENT_IMPULSE: [Branch; 4] = [
    (0.96, &[5.522, 1.117, 0.6, -0.292, -0.087]),
    (2.38, &[5.465, -0.308, -1.464, 1.362, -0.432]),
    (33.7, &[5.2749, -0.4677, -0.2499, 0.0588, -0.00554]),
    (158.7, &[5.9825, -1.062]),
];
/// [kPa ms/kg^(1/3)], from Z = 0.06; the last sign is minus: with the plus of one print its own table is missed
pub const REFLECTED_IMPULSE: [Branch; 1] = [(40.0, &[6.7853, -1.3466, 0.101, -0.01123])];
/// [km/s], from Z = 0.06
pub const SPEED: [Branch; 2] = [
    (1.5, &[0.1794, -0.956, -0.0866, 0.109, 0.0699, 0.01218]),
    (40.0, &[0.2597, -1.326, 0.3767, 0.0396, -0.0351, 0.00432]),
];

/// The quantity at Z, in its table's unit; beyond the table the last branch.
pub fn value(branches: &[Branch], z: f64) -> f64 {
    let branch = branches.iter().find(|(until, _)| z <= *until).unwrap_or(&branches[branches.len() - 1]);
    branch.1.iter().rev().fold(0., |sum, c| sum * z.ln() + c).exp()
}
