//! Steps, the integrator and how hard it works.

use schemars::JsonSchema;
use serde::Deserialize;

use super::range;
use super::schema::Positive;
use crate::model::units;

/// The time that is calculated, from t = 0.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "an object")]
#[schemars(extend("not" = { "required": ["hht", "newmark"], "properties": { "hht": { "not": { "const": 0 } } } }))]
pub struct TimeStepping {
    /// Time step [s], greater than 0.
    #[serde(deserialize_with = "range::positive")]
    #[schemars(with = "Positive<units::Time>")]
    pub step: units::Time,
    /// End [s], at least one step.
    #[serde(deserialize_with = "range::positive")]
    #[schemars(with = "Positive<units::Time>")]
    pub end: units::Time,
    /// Parameters of Newmark's method. Default: the trapezium rule.
    #[serde(default)]
    pub newmark: Newmark,
    /// Numerical damping alpha of Hilber, Hughes and Taylor [-], from -1/3 to 0; sets alpha and delta of Newmark's method. Default: 0, none.
    #[serde(default, deserialize_with = "range::hht")]
    #[schemars(extend("minimum" = -1.0 / 3.0, "maximum" = 0))]
    pub hht: f64,
    /// Share of the energy supplied (initial motion, work of loads and free field) that joints which open, close or begin to slip within steps may make [-], greater than 0 and less than 1. From half of it on steps that make more than their part of the rest are cut in half, up to five times; a run whose joints make more than all of it ends without convergence. Default: 0.02.
    #[serde(default, deserialize_with = "range::optional_tolerance")]
    #[schemars(extend("exclusiveMinimum" = 0, "exclusiveMaximum" = 1))]
    pub energy_tolerance: Option<f64>,
    /// Acceleration at t = 0: "equilibrium" or "rest". Default: "equilibrium".
    #[serde(default)]
    pub start: Start,
}

/// Newmark's method; unconditionally stable for delta >= 1/2 and alpha >= (delta + 1/2)^2 / 4.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default, expecting = "an object")]
pub struct Newmark {
    /// Weight of the new acceleration in the displacement [-]. Default: 0.25.
    #[schemars(range(min = 0.25))]
    pub alpha: f64,
    /// Weight of the new acceleration in the velocity [-]. Default: 0.5.
    #[schemars(range(min = 0.5))]
    pub delta: f64,
}

impl Default for Newmark {
    fn default() -> Self {
        Newmark { alpha: 0.25, delta: 0.5 }
    }
}

/// Newmark's parameters with the alpha of Hilber, Hughes and Taylor, 0 for Newmark's method itself.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Integrator {
    pub newmark: Newmark,
    pub hht: f64,
}

impl TimeStepping {
    /// With hht = a: alpha = (1 - a)^2 / 4, delta = 1/2 - a, second order and unconditionally stable.
    pub fn integrator(&self) -> Integrator {
        let newmark = match self.hht {
            0. => self.newmark,
            a => Newmark { alpha: (1. - a).powi(2) / 4., delta: 0.5 - a },
        };
        Integrator { newmark, hht: self.hht }
    }
}

/// The first acceleration.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Start {
    /// M a0 = R(0) - C v0 - K u0: a blast begins with its peak
    #[default]
    Equilibrium,
    /// a0 = 0
    Rest,
}

/// When a step with contact counts as solved.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default, expecting = "an object")]
pub struct Newton {
    /// Residual over load [-], greater than 0 and less than 1. Default: 1e-8.
    #[serde(deserialize_with = "range::tolerance")]
    #[schemars(extend("exclusiveMinimum" = 0, "exclusiveMaximum" = 1))]
    pub tolerance: f64,
    /// Iterations before the step is cut, at least 1. Default: 30.
    #[serde(deserialize_with = "range::at_least_one")]
    #[schemars(range(min = 1))]
    pub max_iterations: usize,
}

impl Default for Newton {
    fn default() -> Self {
        Newton { tolerance: 1e-8, max_iterations: 30 }
    }
}

/// What is written for ParaView.
#[derive(Debug, Clone, Copy, PartialEq, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default, expecting = "an object")]
pub struct Output {
    /// Time between frames [s], at least one step. Default: a hundredth of the end.
    #[serde(deserialize_with = "range::optional_positive")]
    #[schemars(with = "Option<Positive<units::Time>>")]
    pub every: Option<units::Time>,
}
