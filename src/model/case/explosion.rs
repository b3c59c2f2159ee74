//! A charge and where it is.

use schemars::JsonSchema;
use serde::Deserialize;

use super::load::Clock;
use super::range;
use super::schema::{self, NotNegative, Positive};
use crate::model::units::{Length, Mass};
use crate::physics::explosion::{Burst, Explosion, Explosive, Form, Formula, Wave};

/// A charge, its place, and whose formula gives the blast.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "an object")]
#[schemars(transform = distance_or_place)]
pub struct ExplosionKeys {
    /// Mass of the charge [kg], greater than 0.
    #[serde(deserialize_with = "range::positive")]
    #[schemars(with = "Positive<Mass>")]
    charge: Mass,
    /// What it is made of. Default: "tnt".
    #[serde(default)]
    explosive: Explosive,
    /// Mass of TNT that a unit mass of it equals [-], greater than 0. Default: the explosive's, for the peak pressure.
    #[serde(default, deserialize_with = "range::optional_positive")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    equivalence: Option<f64>,
    /// Distance along the ground [m], greater than 0.
    #[serde(default, deserialize_with = "range::optional_positive")]
    #[schemars(with = "Option<Positive<Length>>")]
    standoff: Option<Length>,
    /// Height of the burst above the ground [m]; the distance is that of both. Default: 0.
    #[serde(default, deserialize_with = "range::optional_not_negative")]
    #[schemars(with = "Option<NotNegative<Length>>")]
    height: Option<Length>,
    /// Place (x, y) [m], instead of `standoff` and `height`: the blast sweeps over the curve.
    at: Option<[Length; 2]>,
    /// Whose formula. Default: "kingery_bulmash".
    #[serde(default)]
    formula: Formula,
    /// On the ground ("hemispherical") or in the air ("spherical"). Default: "spherical" where there is a `height`, else "hemispherical"; with `at` it must be given.
    burst: Option<Burst>,
    /// Which pressure acts: "incident" along the ground, "reflected" where the wave meets it at right angles.
    wave: Wave,
    /// The pulse's form. Default: "friedlander".
    #[serde(default)]
    form: Form,
    /// What t = 0 is, with `at`: the wave reaches the curve ("arrival") or the charge explodes ("detonation"). Default: "arrival".
    clock: Option<Clock>,
}

/// At a distance, by `standoff`, `height` or both; or at a place.
fn distance_or_place(keys: &mut schemars::Schema) {
    let choices = [
        schema::combination(&["at", "burst"], &["standoff", "height"]),
        schema::combination(&["standoff"], &["at", "clock"]),
        schema::combination(&["height"], &["at", "clock", "standoff"]),
    ];
    keys.insert("oneOf".into(), choices.to_vec().into());
}

/// A charge at a distance from all of the curve, or at a place.
#[derive(Debug, Clone, PartialEq)]
pub enum Blast {
    /// the distance is in the formula's range [m]; the note says what does not fit
    At {
        explosion: Explosion,
        distance: f64,
        note: Option<String>,
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
        match (self.at, self.standoff.or(self.height)) {
            (Some(at), None) => self.placed(at),
            (None, Some(_)) => self.at_a_distance(),
            (None, None) => {
                Err("an explosion needs \"standoff\", \"height\" or both, or a point \"at\" which it is".into())
            }
            (Some(_), Some(_)) => {
                Err("an explosion has either a point \"at\" which it is, or \"standoff\" and \"height\", \
                                       and here are both: leave one out"
                    .into())
            }
        }
    }

    fn placed(&self, at: [Length; 2]) -> Result<Blast, String> {
        let burst = self.burst.ok_or("a charge \"at\" a point needs \"burst\": \"hemispherical\" or \"spherical\"")?;
        let clock = self.clock.unwrap_or_default();
        Ok(Blast::Placed { explosion: self.explosion(burst), at: at.map(f64::from), clock })
    }

    fn at_a_distance(&self) -> Result<Blast, String> {
        if self.clock.is_some() {
            return Err("\"clock\" is for a charge \"at\" a point; elsewhere t = 0 is the arrival".into());
        }
        let [standoff, height] = [self.standoff, self.height].map(|length| length.map_or(0.0, f64::from));
        let default = if height > 0.0 { Burst::Spherical } else { Burst::Hemispherical };
        let explosion = self.explosion(self.burst.unwrap_or(default));
        let distance = standoff.hypot(height);
        explosion.check(distance).map_err(|e| e.to_string())?;
        let angle = standoff.atan2(height).to_degrees();
        let note = if height > 0.0 { explosion.misfit(height, [angle; 2]) } else { None };
        Ok(Blast::At { explosion, distance, note })
    }

    fn explosion(&self, burst: Burst) -> Explosion {
        let tnt = self.charge.0 * self.equivalence.unwrap_or(self.explosive.equivalence());
        Explosion { tnt, formula: self.formula, burst, wave: self.wave, form: self.form }
    }
}

impl Blast {
    /// Speed of the front where the distance is known [m/s].
    pub fn front_speed(&self) -> f64 {
        match self {
            Blast::At { explosion, distance, .. } => explosion.parameters(*distance).front_speed,
            Blast::Placed { .. } => f64::NAN,
        }
    }
}
