//! C = alpha M + beta K of the bodies.

use schemars::JsonSchema;
use serde::Deserialize;

use super::range;
use super::schema::{self, NotNegative};
use crate::model::units::{Rate, Time};

/// Rayleigh damping, by its ratio in two modes or by its coefficients.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(try_from = "DampingKeys")]
pub struct Damping {
    pub rayleigh: Rayleigh,
    /// whether the stiffness of closed interfaces is damped too (the paper's C(U), eq. 16)
    pub interfaces: bool,
}

/// The two numbers that fix C = alpha M + beta K.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Rayleigh {
    /// fraction of critical damping [-] in two natural modes, counted from 1
    Ratio { ratio: f64, modes: [usize; 2] },
    /// alpha [1/s] and beta [s]
    Coefficients { alpha: f64, beta: f64 },
}

/// `ratio` and `modes`, or `alpha` and `beta`.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "an object")]
#[schemars(transform = ratio_or_coefficients)]
pub(super) struct DampingKeys {
    /// Fraction of critical damping [-] in both modes, at least 0 and less than 1.
    #[serde(default, deserialize_with = "range::optional_damping_ratio")]
    #[schemars(extend("minimum" = 0, "exclusiveMaximum" = 1))]
    ratio: Option<f64>,
    /// Numbers of the two natural modes that get this ratio, counted from 1. Default: [1, 2].
    #[schemars(inner(range(min = 1)), extend("uniqueItems" = true))]
    modes: Option<[usize; 2]>,
    /// Coefficient of the mass matrix [1/s], at least 0.
    #[serde(default, deserialize_with = "range::optional_not_negative")]
    #[schemars(with = "Option<NotNegative<Rate>>")]
    alpha: Option<Rate>,
    /// Coefficient of the stiffness matrix [s], at least 0.
    #[serde(default, deserialize_with = "range::optional_not_negative")]
    #[schemars(with = "Option<NotNegative<Time>>")]
    beta: Option<Time>,
    /// true damps the closed interfaces too (the paper's C(U)). Default: false.
    #[serde(default)]
    interfaces: bool,
}

fn ratio_or_coefficients(keys: &mut schemars::Schema) {
    let ratio = schema::combination(&["ratio"], &["alpha", "beta"]);
    let coefficients = schema::combination(&["alpha", "beta"], &["ratio", "modes"]);
    keys.insert("oneOf".into(), vec![ratio, coefficients].into());
}

impl TryFrom<DampingKeys> for Damping {
    type Error = String;

    fn try_from(keys: DampingKeys) -> Result<Self, String> {
        let rayleigh = match (keys.ratio, keys.modes, keys.alpha, keys.beta) {
            (Some(ratio), modes, None, None) => Rayleigh::Ratio { ratio, modes: two_modes(modes.unwrap_or([1, 2]))? },
            (None, None, Some(alpha), Some(beta)) => Rayleigh::Coefficients { alpha: alpha.0, beta: beta.0 },
            _ => {
                return Err("write either \"ratio\" with \"modes\", or both \"alpha\" and \"beta\"".into());
            }
        };
        Ok(Damping { rayleigh, interfaces: keys.interfaces })
    }
}

fn two_modes(modes: [usize; 2]) -> Result<[usize; 2], String> {
    match modes {
        [i, j] if i > 0 && j > 0 && i != j => Ok(modes),
        _ => Err(format!("\"modes\" must be two different numbers counted from 1, and is {modes:?}")),
    }
}
