//! Pressure that sweeps over a surface: p(x, t) = pulse of x at t - arrival(x).

use super::explosion::Explosion;
use super::pulse::Pulse;

/// What moves.
#[derive(Debug, Clone, PartialEq)]
pub enum Front {
    /// A plane front: arrival = x.direction / speed, one pulse for all.
    Plane {
        pulse: Pulse,
        /// unit vector
        direction: [f64; 2],
        /// [m/s]
        speed: f64,
    },
    /// A circular front: arrival = |x - from| / speed, one pulse for all.
    Circle {
        pulse: Pulse,
        /// [m]
        from: [f64; 2],
        /// [m/s]
        speed: f64,
    },
    /// The blast of a charge: arrival and pulse by the distance from it.
    Charge {
        explosion: Explosion,
        /// [m]
        at: [f64; 2],
        scale: f64,
        /// delay and rise [s]
        delay: [f64; 2],
    },
}

impl Front {
    /// When the front passes x [s]; for a plane front counted from its passage of the origin.
    pub fn arrival(&self, x: [f64; 2]) -> f64 {
        match self {
            Front::Plane { speed, .. } | Front::Circle { speed, .. } => self.way(x) / speed,
            Front::Charge { explosion, .. } => explosion.arrival(self.way(x)),
        }
    }

    /// Grows with the arrival, and is cheap and defined everywhere: a distance [m].
    pub fn way(&self, x: [f64; 2]) -> f64 {
        match self {
            Front::Plane { direction: [dx, dy], .. } => x[0] * dx + x[1] * dy,
            Front::Circle { from, .. } => distance(x, *from),
            Front::Charge { at, .. } => distance(x, *at),
        }
    }

    /// From the front's passage of a point to the beginning of its pulse [s].
    pub fn start(&self) -> f64 {
        match self {
            Front::Plane { pulse, .. } | Front::Circle { pulse, .. } => pulse.start(),
            Front::Charge { delay: [start, _], .. } => *start,
        }
    }

    /// The history at x, from the front's passage on.
    pub fn pulse(&self, x: [f64; 2]) -> Pulse {
        match self {
            Front::Plane { pulse, .. } | Front::Circle { pulse, .. } => pulse.clone(),
            Front::Charge { explosion, at, scale, delay: [start, rise] } => {
                explosion.pulse(distance(x, *at)).scaled(*scale).delayed(*start, *rise)
            }
        }
    }
}

pub fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::physics::explosion::{Burst, Form, Formula, Wave};

    #[test]
    fn fronts_arrive_by_distance_over_speed() {
        let pulse = Pulse::Step { peak: 1. };
        let plane = Front::Plane { pulse: pulse.clone(), direction: [0.6, 0.8], speed: 5. };
        assert!((plane.arrival([3., 4.]) - 1.).abs() < 1e-15);
        assert!((plane.arrival([-4., 3.])).abs() < 1e-15);
        let circle = Front::Circle { pulse, from: [1., 1.], speed: 2.5 };
        assert!((circle.arrival([4., 5.]) - 2.).abs() < 1e-15);
    }

    /// The published arrival and speed are two polynomials of one thing: dR/dt_a = U within 1.3 %, the worst at Z = 1.
    #[test]
    fn the_charges_front_moves_with_the_published_speed() {
        let (formula, burst) = (Formula::KingeryBulmash, Burst::Hemispherical);
        let explosion = Explosion { tnt: 1000., formula, burst, wave: Wave::Incident, form: Form::Friedlander };
        let front = Front::Charge { explosion, at: [0., 0.], scale: 1., delay: [0., 0.] };
        for r in [10., 20., 30., 50., 100., 200.] {
            let h = 0.01;
            let speed = 2. * h / (front.arrival([r + h, 0.]) - front.arrival([r - h, 0.]));
            let published = explosion.parameters(r).front_speed;
            assert!((speed / published - 1.).abs() < 0.013, "R = {r} m: {speed}, published {published} m/s");
        }
        assert_eq!(front.pulse([0., 30.]), explosion.pulse(30.));
    }
}
