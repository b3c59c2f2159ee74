//! The form in time that a peak, a duration and a decay are given.

use crate::physics::friedlander;
use crate::physics::pulse::Pulse;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The pulse's form in time.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Form {
    /// Friedlander's pulse, peak (1 - t/t_d) exp(-b t/t_d)
    #[default]
    Friedlander,
    /// its tangent at t = 0, a straight line to zero at t_d / (1 + b)
    Tangent,
    /// the straight line of the same peak and impulse, to zero at 2 i / peak
    EqualImpulse,
}

impl Form {
    /// The pulse of a peak, a duration of the positive phase [s] and a decay.
    pub fn pulse(self, peak: f64, duration: f64, decay: f64) -> Pulse {
        match self {
            Form::Friedlander => Pulse::Friedlander { peak, duration, decay, negative: None },
            Form::Tangent => Pulse::Linear { peak, duration: friedlander::tangent_duration(duration, decay) },
            Form::EqualImpulse => {
                Pulse::Linear { peak, duration: friedlander::equal_impulse_duration(duration, decay) }
            }
        }
    }
}
