//! What a face group is made of.

use schemars::JsonSchema;
use serde::Deserialize;

use super::range;
use super::schema::Positive;
use crate::model::units::{Density, Pressure};

/// Isotropic linear elasticity in plane strain, and what an interface needs to know of the ground beside it.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "an object")]
pub struct Material {
    /// Young's modulus [Pa], greater than 0.
    #[serde(deserialize_with = "range::positive")]
    #[schemars(with = "Positive<Pressure>")]
    pub young: Pressure,
    /// Poisson's ratio [-], greater than -1 and less than 0.5.
    #[serde(deserialize_with = "range::poisson")]
    #[schemars(extend("exclusiveMinimum" = -1, "exclusiveMaximum" = 0.5))]
    pub poisson: f64,
    /// Mass density [kg/m^3], greater than 0.
    #[serde(deserialize_with = "range::positive")]
    #[schemars(with = "Positive<Density>")]
    pub density: Density,
    /// Coefficient of Coulomb friction [-] of interfaces in this ground, at least 0; needed only where no interface names its own.
    #[serde(default, deserialize_with = "range::optional_not_negative")]
    #[schemars(extend("minimum" = 0))]
    pub friction: Option<f64>,
}
