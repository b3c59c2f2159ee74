//! Newmark's time integration in Bathe's constants a0 ... a7; the paper's alpha and delta, eq. (20).
//!
//! alpha = 1/4, delta = 1/2 is the average acceleration: no numerical damping, unconditionally stable.

use crate::model::case::Newmark;

/// The constants for one length of step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Constants {
    /// time step [s]
    pub dt: f64,
    pub a0: f64,
    pub a1: f64,
    pub a2: f64,
    pub a3: f64,
    pub a4: f64,
    pub a5: f64,
    pub a6: f64,
    pub a7: f64,
}

impl Constants {
    pub fn new(Newmark { alpha, delta }: Newmark, dt: f64) -> Constants {
        Constants {
            dt,
            a0: 1. / (alpha * dt * dt),
            a1: delta / (alpha * dt),
            a2: 1. / (alpha * dt),
            a3: 1. / (2. * alpha) - 1.,
            a4: delta / alpha - 1.,
            a5: dt / 2. * (delta / alpha - 2.),
            a6: dt * (1. - delta),
            a7: delta * dt,
        }
    }

    /// a = a0 (u - u_t) - a2 v_t - a3 a_t.
    pub fn acceleration(&self, u: f64, [u_t, v_t, a_t]: [f64; 3]) -> f64 {
        self.a0 * (u - u_t) - self.a2 * v_t - self.a3 * a_t
    }

    /// v = v_t + a6 a_t + a7 a.
    pub fn velocity(&self, a: f64, [_, v_t, a_t]: [f64; 3]) -> f64 {
        v_t + self.a6 * a_t + self.a7 * a
    }

    /// What M is multiplied by on the right-hand side: a0 u + a2 v + a3 a.
    pub fn for_mass(&self, [u, v, a]: [f64; 3]) -> f64 {
        self.a0 * u + self.a2 * v + self.a3 * a
    }

    /// What C is multiplied by on the right-hand side: a1 u + a4 v + a5 a.
    pub fn for_damping(&self, [u, v, a]: [f64; 3]) -> f64 {
        self.a1 * u + self.a4 * v + self.a5 * a
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// omega = 2 pi, dt = 0.05, u0 = 1: u(1) = 0.99870359, computed independently from the method's exact phase.
    #[test]
    fn an_oscillator_keeps_amplitude_and_has_the_methods_period_error() {
        let c = Constants::new(Newmark { alpha: 0.25, delta: 0.5 }, 0.05);
        let k = (2. * std::f64::consts::PI).powi(2);
        let mut state = [1., 0., -k];
        for _ in 0..20 {
            let u = c.for_mass(state) / (k + c.a0);
            let a = c.acceleration(u, state);
            state = [u, c.velocity(a, state), a];
        }
        assert!((state[0] - 0.99870359).abs() < 1e-8, "{}", state[0]);
        let energy = (k * state[0].powi(2) + state[1].powi(2)) / k;
        assert!((energy - 1.).abs() < 1e-13);
    }
}
