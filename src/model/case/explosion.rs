//! A charge and where it is.

use schemars::JsonSchema;
use serde::Deserialize;

use super::load::Clock;
use super::range;
use crate::model::units::{Length, Mass};
use crate::physics::explosion::{Burst, Explosion, Explosive, Form, Formula, Wave};

/// A charge, its place, and whose formula gives the blast.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "an object")]
pub struct ExplosionKeys {
    /// Mass of the charge [kg], greater than 0.
    #[serde(deserialize_with = "range::positive")]
    charge: Mass,
    /// What it is made of. Default: "tnt".
    #[serde(default)]
    explosive: Explosive,
    /// Mass of TNT that a unit mass of it equals [-], greater than 0. Default: the explosive's, for the peak pressure.
    #[serde(default, deserialize_with = "range::optional_positive")]
    equivalence: Option<f64>,
    /// Distance along the ground [m], greater than 0.
    #[serde(default, deserialize_with = "range::optional_positive")]
    standoff: Option<Length>,
    /// Height of the burst above the ground [m]; the distance is that of both. Default: 0.
    #[serde(default, deserialize_with = "range::optional_not_negative")]
    height: Option<Length>,
    /// Place (x, y) [m], instead of `standoff` and `height`: the blast sweeps over the curve.
    at: Option<[Length; 2]>,
    /// Whose formula. Default: "kingery_bulmash".
    #[serde(default)]
    formula: Formula,
    /// Default: "spherical" where there is a height, else "hemispherical".
    burst: Option<Burst>,
    /// Which pressure acts: "incident" along the ground, "reflected" where the wave meets it at right angles.
    wave: Wave,
    /// The pulse's form. Default: "friedlander".
    #[serde(default)]
    form: Form,
    /// What t = 0 is, with `at`. Default: "arrival".
    clock: Option<Clock>,
}

/// A charge at a distance from all of the curve, or at a place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Blast {
    /// the distance is in the formula's range [m]
    At {
        explosion: Explosion,
        distance: f64,
    },
    Placed {
        explosion: Explosion,
        at: [f64; 2],
        clock: Clock,
    },
}

impl ExplosionKeys {
    /// Errors where the place is not clear, or out of the formula's range.
    pub fn blast(&self) -> Result<Blast, String> {
        let height = self.height.map_or(0.0, f64::from);
        let burst = match (self.burst, self.at) {
            (Some(burst), _) => burst,
            (None, Some(_)) => {
                return Err("a charge \"at\" a point needs \"burst\": \"hemispherical\" or \"spherical\"".into());
            }
            (None, None) if height > 0.0 => Burst::Spherical,
            (None, None) => Burst::Hemispherical,
        };
        let tnt = self.charge.0 * self.equivalence.unwrap_or(self.explosive.equivalence());
        let explosion = Explosion { tnt, formula: self.formula, burst, wave: self.wave, form: self.form };
        match (self.at, self.standoff, self.height) {
            (Some(at), None, None) => {
                Ok(Blast::Placed { explosion, at: at.map(f64::from), clock: self.clock.unwrap_or_default() })
            }
            (None, None, None) => {
                Err("an explosion needs \"standoff\", \"height\" or both, or a point \"at\" which it is".into())
            }
            (None, standoff, _) if self.clock.is_none() => {
                let distance = standoff.map_or(0.0, f64::from).hypot(height);
                explosion.check(distance).map_err(|e| e.to_string())?;
                Ok(Blast::At { explosion, distance })
            }
            (None, ..) => Err("\"clock\" is for a charge \"at\" a point; elsewhere t = 0 is the arrival".into()),
            _ => Err("an explosion has either a point \"at\" which it is, or \"standoff\" and \"height\"".into()),
        }
    }
}

impl Blast {
    /// Speed of the front where the distance is known [m/s].
    pub fn front_speed(&self) -> f64 {
        match self {
            Blast::At { explosion, distance } => explosion.parameters(*distance).front_speed,
            Blast::Placed { .. } => f64::NAN,
        }
    }
}
