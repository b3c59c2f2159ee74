//! Kingery and Bulmash (1984): y = 10^(sum c_i u^i), u = k_0 + k_1 log10 Z, with Z = R / W^(1/3) [m/kg^(1/3)].

use super::Burst;

/// One polynomial, for log10 Z up to `until`.
pub struct Branch {
    pub until: f64,
    pub k: [f64; 2],
    pub c: &'static [f64],
}

/// One kind of burst; a quantity with several branches changes from one to the next with Z, one without has no formula.
pub struct Table {
    /// [kPa]
    pub incident_pressure: &'static [Branch],
    pub reflected_pressure: &'static [Branch],
    /// [kPa ms/kg^(1/3)]
    pub incident_impulse: &'static [Branch],
    pub reflected_impulse: &'static [Branch],
    /// [ms/kg^(1/3)]
    pub arrival: &'static [Branch],
    pub duration: &'static [Branch],
    /// [km/s]
    pub speed: &'static [Branch],
}

/// Where the polynomial of the duration begins, Z [m/kg^(1/3)]: its u runs over [-2, 2], and nearer to the charge it
/// leaves all sense (0.0531 spherical: 1e-24 ms). Peak, impulse and arrival begin at the charge, 0.0674 and 0.0531.
pub fn duration_from(burst: Burst) -> f64 {
    match burst {
        Burst::Hemispherical => 0.178,
        Burst::Spherical => 0.147,
    }
}

/// The quantity at Z, in the table's unit; none where it has no formula.
pub fn value(branches: &[Branch], z: f64) -> Option<f64> {
    let log_z = z.log10();
    let branch = branches.iter().find(|b| log_z <= b.until)?;
    let u = branch.k[0] + branch.k[1] * log_z;
    Some(10f64.powf(branch.c.iter().rev().fold(0., |sum, c| sum * u + c)))
}
