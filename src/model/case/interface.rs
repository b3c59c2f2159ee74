//! A curve between a body and the ground that opens and slips.

use schemars::JsonSchema;
use serde::Deserialize;

use super::range;
use super::schema::{NotNegative, Positive};
use crate::model::units::{JointStiffness, Length};

/// Zero-thickness joints with the stiffness of a thin layer of the ground beside them.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "an object")]
pub struct Interface {
    /// Group of surfaces on the side that the normal leaves; the other side is the ground.
    pub body: String,
    /// Thickness t [m] of the thin layer of ground, greater than 0: the stiffness is E_oed/t (normal) and G/t (tangential). Default: 1 cm.
    #[serde(default = "one_centimetre", deserialize_with = "range::positive")]
    #[schemars(with = "Positive<Length>")]
    pub thickness: Length,
    /// Points where the joint law holds: "lobatto" (nodes) or "gauss_1" (one in the middle, as the paper). Default: "lobatto".
    #[serde(default)]
    pub integration: Integration,
    /// Coefficient of Coulomb friction [-], at least 0. Default: that of the ground's material.
    #[serde(default, deserialize_with = "range::optional_not_negative")]
    #[schemars(extend("minimum" = 0))]
    pub friction: Option<f64>,
    /// Normal stiffness [Pa/m], greater than 0. Default: E_oed/t of the ground.
    #[serde(default, deserialize_with = "range::optional_positive")]
    #[schemars(with = "Option<Positive<JointStiffness>>")]
    pub normal_stiffness: Option<JointStiffness>,
    /// Tangential stiffness [Pa/m], greater than 0. Default: G/t of the ground.
    #[serde(default, deserialize_with = "range::optional_positive")]
    #[schemars(with = "Option<Positive<JointStiffness>>")]
    pub tangential_stiffness: Option<JointStiffness>,
    /// Normal gap at the start [m], at least 0. Default: 0.
    #[serde(default, deserialize_with = "range::not_negative")]
    #[schemars(with = "NotNegative<Length>")]
    pub gap: Length,
}

fn one_centimetre() -> Length {
    Length(0.01)
}

/// Integration points of a joint element.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, JsonSchema)]
pub enum Integration {
    /// at the nodes: 2 points for the 4-node joint, 3 for the 6-node one
    #[default]
    #[serde(rename = "lobatto")]
    Lobatto,
    /// one point in the middle: the paper's, with zig-zag modes of zero energy
    #[serde(rename = "gauss_1")]
    Gauss1,
}
