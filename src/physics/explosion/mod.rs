//! Explosions of TNT in air: peak, duration, impulse and arrival at a distance, by the formulas of several authors.
//!
//! All hang on the scaled distance Z = R / W^(1/3) [m/kg^(1/3)]; times and impulses are per W^(1/3). A formula gives what
//! it gives; the rest is Kingery and Bulmash's for the same burst, and [`Parameters::notes`] says so.

pub mod air;
mod explosive;
mod kingery_bulmash;
mod peaks;
mod place;
mod swisdak;
mod table;

pub use explosive::Explosive;

use super::friedlander;
use super::pulse::Pulse;
use crate::number::{short, short_to};
use crate::{Error, Result};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Whose formula gives the peak.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Formula {
    /// Kingery and Bulmash 1984, either burst: everything
    #[default]
    KingeryBulmash,
    /// Swisdak 1994, hemispherical: Kingery and Bulmash's in shorter polynomials
    Swisdak,
    /// Kinney and Graham 1985, spherical: incident peak, duration, impulse
    KinneyGraham,
    /// Sadovsky, either burst: incident peak and duration
    Sadovsky,
    /// Sadovsky as Soviet and Vietnamese manuals print it, hemispherical: incident peak and duration
    SadovskyManuals,
    /// Brode 1955, spherical: incident peak
    Brode,
    /// Henrych 1979, spherical: incident peak, and the duration up to Z = 3
    Henrych,
    /// Mills 1987, spherical: incident peak
    Mills,
    /// Newmark and Hansen 1961, hemispherical: incident peak
    NewmarkHansen,
}

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

/// Peaks [kPa], impulses [kPa ms/kg^(1/3)], times [ms/kg^(1/3)], speed [km/s].
#[derive(Debug, Clone, Copy)]
struct Scaled {
    incident: [f64; 2],
    reflected: [f64; 2],
    arrival: f64,
    duration: f64,
    speed: f64,
}

impl Formula {
    /// Name, as in the case file.
    pub fn name(self) -> &'static str {
        match self {
            Formula::KingeryBulmash => "kingery_bulmash",
            Formula::Swisdak => "swisdak",
            Formula::KinneyGraham => "kinney_graham",
            Formula::Sadovsky => "sadovsky",
            Formula::SadovskyManuals => "sadovsky_manuals",
            Formula::Brode => "brode",
            Formula::Henrych => "henrych",
            Formula::Mills => "mills",
            Formula::NewmarkHansen => "newmark_hansen",
        }
    }

    pub const ALL: [Formula; 9] = [
        Formula::KingeryBulmash,
        Formula::Swisdak,
        Formula::KinneyGraham,
        Formula::Sadovsky,
        Formula::SadovskyManuals,
        Formula::Brode,
        Formula::Henrych,
        Formula::Mills,
        Formula::NewmarkHansen,
    ];

    /// Smallest and largest Z it holds for, none for a burst it is not made for.
    ///
    /// No pulse begins nearer than Kingery and Bulmash's duration: from it comes the decay, of the reflected pulse at
    /// least, for every formula but Swisdak's. Brode's last branch ends at 0.1 bar, Z = 9.92. Kinney and Graham's tables
    /// go further than 40, Kingery and Bulmash's do not. For Mills, and Newmark and Hansen, the range is where they were
    /// compared with the others here.
    pub fn range(self, burst: Burst) -> Option<[f64; 2]> {
        let nearest = kingery_bulmash::duration_from(burst);
        match (self, burst) {
            (Formula::KingeryBulmash, _) | (Formula::KinneyGraham, Burst::Spherical) => Some([nearest, 40.]),
            (Formula::Swisdak, Burst::Hemispherical) => Some([0.2, 40.]),
            (Formula::Sadovsky, _) | (Formula::SadovskyManuals, Burst::Hemispherical) => Some([1., 10.]),
            (Formula::Brode, Burst::Spherical) => Some([nearest, 9.92]),
            (Formula::Henrych, Burst::Spherical) => Some([nearest, 10.]),
            (Formula::Mills, Burst::Spherical) | (Formula::NewmarkHansen, Burst::Hemispherical) => Some([1., 10.]),
            _ => None,
        }
    }

    /// (incident peak [kPa], duration, impulse) of its own, of a formula that is not Kingery and Bulmash's.
    fn own(self, burst: Burst, z: f64) -> (f64, Option<f64>, Option<f64>) {
        match (self, burst) {
            (Formula::KinneyGraham, _) => {
                let [duration, impulse] = [peaks::kinney_graham_duration(z), peaks::kinney_graham_impulse(z)];
                (peaks::kinney_graham(z), Some(duration), Some(impulse))
            }
            (Formula::Sadovsky, Burst::Spherical) => {
                (peaks::sadovsky(z, peaks::SADOVSKY_AIR), Some(peaks::sadovsky_duration(z, 1.35)), None)
            }
            (Formula::SadovskyManuals, _) => {
                (peaks::sadovsky(z, peaks::SADOVSKY_MANUALS), Some(peaks::sadovsky_duration(z, 1.7)), None)
            }
            (Formula::Sadovsky, Burst::Hemispherical) => {
                (peaks::sadovsky(z, peaks::SADOVSKY_GROUND), Some(peaks::sadovsky_duration(z, 1.7)), None)
            }
            (Formula::Brode, _) => (peaks::brode(z), None, None),
            (Formula::Henrych, _) => (peaks::henrych(z), peaks::henrych_duration(z), None),
            (Formula::Mills, _) => (peaks::mills(z), None, None),
            (Formula::NewmarkHansen, _) => (peaks::newmark_hansen(z), None, None),
            (Formula::KingeryBulmash | Formula::Swisdak, _) => {
                let all = kingery_bulmash_at(burst, z);
                (all.incident[0], Some(all.duration), Some(all.incident[1]))
            }
        }
    }
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
        let scaled = self.scaled(z, &mut notes);
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
            _ => kingery_bulmash_arrival(self.burst, z),
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

    fn scaled(&self, z: f64, notes: &mut Vec<String>) -> Scaled {
        let all = kingery_bulmash_at(self.burst, z);
        match self.formula {
            Formula::KingeryBulmash => {
                if table_of(self.burst).speed.is_empty() {
                    notes.push("the speed is an ideal gas's: the formula has none for this burst".into());
                }
                all
            }
            Formula::Swisdak => Scaled {
                incident: [
                    swisdak::value(&swisdak::INCIDENT_PRESSURE, z),
                    swisdak::value(&swisdak::INCIDENT_IMPULSE, z),
                ],
                reflected: [
                    swisdak::value(&swisdak::REFLECTED_PRESSURE, z),
                    swisdak::value(&swisdak::REFLECTED_IMPULSE, z),
                ],
                arrival: swisdak::value(&swisdak::ARRIVAL, z),
                duration: swisdak::value(&swisdak::DURATION, z),
                speed: swisdak::value(&swisdak::SPEED, z),
            },
            formula => completed(formula, self.burst, z, all, notes),
        }
    }
}

/// A formula's own values; what it has not is Kingery and Bulmash's: arrival, duration, decay (and so the impulse).
fn completed(formula: Formula, burst: Burst, z: f64, all: Scaled, notes: &mut Vec<String>) -> Scaled {
    let (peak, duration, impulse) = formula.own(burst, z);
    let lacking = [duration.map_or("duration, ", |_| ""), impulse.map_or("decay, ", |_| "")].concat();
    notes.push(format!(
        "Kingery and Bulmash's: {lacking}arrival, decay of the reflected pulse; an ideal gas's: reflected peak, speed"
    ));
    let duration = duration.unwrap_or(all.duration);
    let with_decay_of = |[p, i]: [f64; 2], peak: f64| [peak, i / (p * all.duration) * peak * duration];
    Scaled {
        incident: impulse.map_or_else(|| with_decay_of(all.incident, peak), |impulse| [peak, impulse]),
        reflected: with_decay_of(all.reflected, 1e-3 * air::reflected(1e3 * peak)),
        arrival: all.arrival,
        duration,
        speed: 1e-3 * air::front_speed(1e3 * peak),
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

fn table_of(burst: Burst) -> &'static kingery_bulmash::Table {
    match burst {
        Burst::Hemispherical => &table::HEMISPHERICAL,
        Burst::Spherical => &table::SPHERICAL,
    }
}

fn kingery_bulmash_arrival(burst: Burst, z: f64) -> f64 {
    kingery_bulmash::value(table_of(burst).arrival, z).expect("both tables have it")
}

fn kingery_bulmash_at(burst: Burst, z: f64) -> Scaled {
    let table = table_of(burst);
    let value = |branches| kingery_bulmash::value(branches, z).expect("both tables have it");
    let peak = value(table.incident_pressure);
    let ideal = || 1e-3 * air::front_speed(1e3 * peak);
    Scaled {
        incident: [peak, value(table.incident_impulse)],
        reflected: [value(table.reflected_pressure), value(table.reflected_impulse)],
        arrival: value(table.arrival),
        duration: value(table.duration),
        speed: kingery_bulmash::value(table.speed, z).unwrap_or_else(ideal),
    }
}

#[cfg(test)]
mod tests;
