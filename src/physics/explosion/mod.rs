//! Explosions of TNT in air: peak, duration, impulse and arrival at a distance, by the formulas of several authors.
//!
//! All hang on the scaled distance Z = R / W^(1/3) [m/kg^(1/3)]; times and impulses are per W^(1/3). A formula gives
//! what it gives; the rest is Kingery and Bulmash's for the same burst, and [`Parameters::notes`] says so.

pub mod air;
mod explosive;
mod form;
mod formula;
mod kingery_bulmash;
mod peaks;
mod place;
mod scaled;
mod swisdak;
mod table;

pub use explosive::Explosive;
pub use form::Form;
pub use formula::Formula;

use super::friedlander;
use super::pulse::Pulse;
use crate::number::{short, short_to};
use crate::{Error, Result};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Burst {
    /// on the ground, whose reflection is in the values
    Hemispherical,
    /// in free air
    Spherical,
}

impl Burst {
    /// Name, as in the case file.
    pub fn name(self) -> &'static str {
        match self {
            Burst::Hemispherical => "hemispherical",
            Burst::Spherical => "spherical",
        }
    }
}

/// Which pressure acts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Wave {
    /// of the wave that passes along a surface
    Incident,
    /// on a surface that the wave meets at right angles
    Reflected,
}

impl Wave {
    /// Name, as in the case file.
    pub fn name(self) -> &'static str {
        match self {
            Wave::Incident => "incident",
            Wave::Reflected => "reflected",
        }
    }
}

/// A charge and what is asked of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Explosion {
    /// mass of TNT [kg]
    pub tnt: f64,
    pub formula: Formula,
    pub burst: Burst,
    pub wave: Wave,
    pub form: Form,
}

/// The blast at a distance, in SI.
#[derive(Debug, Clone, PartialEq)]
pub struct Parameters {
    /// [m/kg^(1/3)]
    pub scaled_distance: f64,
    pub incident: Phase,
    pub reflected: Phase,
    /// of the front, since the detonation [s]
    pub arrival: f64,
    /// of the positive phase [s]
    pub duration: f64,
    /// of the front [m/s]
    pub front_speed: f64,
    /// peak of the wind's pressure behind the front, of an ideal gas [Pa]
    pub dynamic_pressure: f64,
    /// what is not the formula's own, and what does not fit together
    pub notes: Vec<String>,
}

/// The positive phase of one pressure.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Phase {
    /// [Pa]
    #[serde(rename = "peak_pa")]
    pub peak: f64,
    /// [Pa s]
    #[serde(rename = "impulse_pa_s")]
    pub impulse: f64,
    /// b of the Friedlander pulse of this peak, duration and impulse
    pub decay: f64,
}

impl Explosion {
    /// Z = R / W^(1/3) [m/kg^(1/3)] at the distance R [m].
    pub fn scaled_distance(&self, distance: f64) -> f64 {
        distance / self.tnt.cbrt()
    }

    /// Errors where the formula does not hold, with its range.
    pub fn check(&self, distance: f64) -> Result<()> {
        let (name, z) = (self.formula.name(), self.scaled_distance(distance));
        let Some([low, high]) = self.formula.range(self.burst) else {
            let [is, other] = match self.burst {
                Burst::Hemispherical => ["on the ground (hemispherical)", "in free air (spherical)"],
                Burst::Spherical => ["in free air (spherical)", "on the ground (hemispherical)"],
            };
            return Err(Error::input(format!(
                "the formula \"{name}\" is for a burst {other}, and this one is {is}: choose another formula, as \
                 \"kingery_bulmash\", or the other \"burst\""
            )));
        };
        if (low..=high).contains(&z) {
            return Ok(());
        }
        let why = match z < low && low == kingery_bulmash::duration_from(self.burst) {
            true => "; nearer to the charge Kingery and Bulmash's duration, which every pulse needs, has no formula",
            false => "",
        };
        Err(Error::input(format!(
            "the scaled distance Z = R / W^(1/3) = {} m / ({} kg)^(1/3) = {} m/kg^(1/3) is out of the range of \"{name}\", \
             {low} to {high} m/kg^(1/3), that is {} to {} m from this charge{why}: {}",
            short(distance),
            short(self.tnt),
            short_to(5, z),
            short_to(5, low * self.tnt.cbrt()),
            short_to(5, high * self.tnt.cbrt()),
            self.way_out(z)
        )))
    }

    /// Which formulas hold for this burst where this one does not.
    fn way_out(&self, z: f64) -> String {
        let holds = |f: &&Formula| f.range(self.burst).is_some_and(|[low, high]| (low..=high).contains(&z));
        let names: Vec<String> = Formula::ALL.iter().filter(holds).map(|f| format!("\"{}\"", f.name())).collect();
        match names.is_empty() {
            true => "change the distance or the charge; no formula here holds there".into(),
            false => {
                format!("change the distance or the charge, or take a formula that holds there: {}", names.join(", "))
            }
        }
    }

    /// The blast at the distance R [m], which [`Explosion::check`] has found in range.
    pub fn parameters(&self, distance: f64) -> Parameters {
        let z = self.scaled_distance(distance);
        let mut notes = Vec::new();
        let scaled = scaled::scaled(self.formula, self.burst, z, &mut notes);
        let mut phase = |what: &str, [peak, impulse]: [f64; 2]| {
            let decay = decay_of(what, impulse / (peak * scaled.duration), &mut notes);
            let impulse = friedlander::impulse_ratio(decay) * peak * scaled.duration;
            Phase { peak: 1e3 * peak, impulse: impulse * self.tnt.cbrt(), decay }
        };
        let (incident, reflected) = (phase("incident", scaled.incident), phase("reflected", scaled.reflected));
        Parameters {
            scaled_distance: z,
            incident,
            reflected,
            arrival: 1e-3 * scaled.arrival * self.tnt.cbrt(),
            duration: 1e-3 * scaled.duration * self.tnt.cbrt(),
            front_speed: 1e3 * scaled.speed,
            dynamic_pressure: air::dynamic(incident.peak),
            notes,
        }
    }

    /// When the front reaches the distance R [m], since the detonation [s].
    pub fn arrival(&self, distance: f64) -> f64 {
        let z = self.scaled_distance(distance);
        let arrival = match self.formula {
            Formula::Swisdak => swisdak::value(&swisdak::ARRIVAL, z),
            _ => scaled::kingery_bulmash_arrival(self.burst, z),
        };
        1e-3 * arrival * self.tnt.cbrt()
    }

    /// The phase of the pressure that acts.
    pub fn acting(&self, parameters: &Parameters) -> Phase {
        match self.wave {
            Wave::Incident => parameters.incident,
            Wave::Reflected => parameters.reflected,
        }
    }

    /// The pressure's history at the distance R [m], from the front's arrival on.
    pub fn pulse(&self, distance: f64) -> Pulse {
        let parameters = self.parameters(distance);
        let Phase { peak, decay, .. } = self.acting(&parameters);
        self.form.pulse(peak, parameters.duration, decay)
    }
}

/// The decay b of i / (P t_d) = `ratio`; 0, a straight line, where no b > -1 has it.
fn decay_of(what: &str, ratio: f64, notes: &mut Vec<String>) -> f64 {
    let decay = friedlander::decay(ratio);
    if decay.is_none_or(|b| b < 0.) {
        let taken =
            if decay.is_some() { "its pulse falls slowly first (decay < 0)" } else { "a straight line is taken" };
        notes.push(format!("{what}: the impulse is {ratio:.3} of peak times duration, a straight line's 0.5: {taken}"));
    }
    decay.unwrap_or(0.)
}

#[cfg(test)]
mod published;
#[cfg(test)]
mod published_swisdak;
#[cfg(test)]
mod tests;
