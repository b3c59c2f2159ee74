//! Linear elastic, isotropic material in plane strain.

use nalgebra::Matrix3;

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Material {
    /// Young's modulus E [Pa]
    pub young: f64,
    /// Poisson's ratio, -1 < nu < 1/2
    pub poisson: f64,
    /// mass density [kg/m^3]
    pub density: f64,
}

impl Material {
    /// Shear modulus G = E / 2(1 + nu) [Pa].
    pub fn shear_modulus(&self) -> f64 {
        self.young / (2. * (1. + self.poisson))
    }

    /// Constrained modulus, of compression without lateral strain: E(1 - nu) / (1 + nu)(1 - 2nu) [Pa].
    pub fn oedometric_modulus(&self) -> f64 {
        let nu = self.poisson;
        self.young * (1. - nu) / ((1. + nu) * (1. - 2. * nu))
    }

    /// sigma = D epsilon, with sigma = (xx, yy, xy) and epsilon = (xx, yy, gamma_xy), eps_zz = 0 [Pa].
    pub fn plane_strain(&self) -> Matrix3<f64> {
        let (m, g) = (self.oedometric_modulus(), self.shear_modulus());
        let lambda = m - 2. * g;
        Matrix3::new(m, lambda, 0., lambda, m, 0., 0., 0., g)
    }

    /// Bulk modulus E / 3(1 - 2 nu) [Pa].
    pub fn bulk_modulus(&self) -> f64 {
        self.young / (3. * (1. - 2. * self.poisson))
    }

    /// The part of D that is not the bulk modulus: D = D_dev + K_b (1, 1, 0)'(1, 1, 0) [Pa].
    pub fn deviatoric(&self) -> Matrix3<f64> {
        let g = self.shear_modulus();
        Matrix3::new(4. * g / 3., -2. * g / 3., 0., -2. * g / 3., 4. * g / 3., 0., 0., 0., g)
    }

    /// Speed of P waves, sqrt(M / rho) [m/s].
    pub fn p_speed(&self) -> f64 {
        (self.oedometric_modulus() / self.density).sqrt()
    }

    /// Speed of S waves, sqrt(G / rho) [m/s].
    pub fn s_speed(&self) -> f64 {
        (self.shear_modulus() / self.density).sqrt()
    }

    /// Speed of Rayleigh's surface wave c [m/s]: x = (c/c_s)^2 in (0, 1) with
    /// x^3 - 8 x^2 + (24 - 16 k) x - 16 (1 - k) = 0, k = (c_s/c_p)^2.
    pub fn rayleigh_speed(&self) -> f64 {
        let k = (self.s_speed() / self.p_speed()).powi(2);
        let [mut low, mut high] = [0.1, 1.]; // negative at 0.1 for every nu > -1, and 1 at 1
        for _ in 0..60 {
            let x: f64 = (low + high) / 2.;
            match x.powi(3) - 8. * x * x + (24. - 16. * k) * x - 16. * (1. - k) < 0. {
                true => low = x,
                false => high = x,
            }
        }
        self.s_speed() * f64::sqrt((low + high) / 2.)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector3;

    /// The three coral layers and the steel: constrained and shear modulus [MPa], wave speeds [m/s], computed
    /// independently from the paper's Table 2; printed to 6 digits, hence the tolerance.
    #[test]
    fn layers_have_the_moduli_and_wave_speeds_of_the_papers_table() {
        let rows = [
            (183e6, 0.46, 2200., 846.062, 62.671, 620.14, 168.78),
            (519e6, 0.38, 2600., 971.558, 188.043, 611.29, 268.93),
            (863e6, 0.27, 2700., 1078.381, 339.764, 631.98, 354.74),
            (210e9, 0.30, 7800., 282_692., 80_769.2, 6020.18, 3217.92),
        ];
        for (young, poisson, density, m, g, cp, cs) in rows {
            let material = Material { young, poisson, density };
            let near = |a: f64, b: f64| (a / b - 1.).abs() < 3e-5;
            assert!(near(material.oedometric_modulus(), m * 1e6));
            assert!(near(material.shear_modulus(), g * 1e6));
            assert!(near(material.p_speed(), cp) && near(material.s_speed(), cs));
        }
    }

    /// D_dev + K_b (1, 1, 0)'(1, 1, 0) is D, and sigma_zz = nu (sigma_xx + sigma_yy) is what the two leave out of
    /// plane.
    #[test]
    fn bulk_and_deviatoric_parts_make_up_plane_strain() {
        let m = Material { young: 7., poisson: 0.3, density: 1. };
        let trace = Vector3::new(1., 1., 0.);
        let sum = m.deviatoric() + trace * trace.transpose() * m.bulk_modulus();
        assert!((sum - m.plane_strain()).norm() < 1e-14);
        let strain = Vector3::new(0.2, -0.5, 0.1);
        let (stress, deviator) = (m.plane_strain() * strain, m.deviatoric() * strain);
        let out_of_plane = m.bulk_modulus() * (strain[0] + strain[1]) - deviator[0] - deviator[1];
        assert!((out_of_plane - 0.3 * (stress[0] + stress[1])).abs() < 1e-14);
    }

    /// The three layers of the paper: speeds computed independently, five digits.
    #[test]
    fn rayleigh_waves_of_the_layers_have_the_reference_speeds() {
        let layers = [(183e6, 0.46, 2200., 160.39), (519e6, 0.38, 2600., 252.63), (863e6, 0.27, 2700., 327.30)];
        for (young, poisson, density, expected) in layers {
            let c = Material { young, poisson, density }.rayleigh_speed();
            assert!((c - expected).abs() < 0.006, "{c}, not {expected} m/s");
        }
    }
}
