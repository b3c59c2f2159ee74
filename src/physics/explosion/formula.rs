//! Whose formula: its name, its range, and what is its own.

use super::scaled::kingery_bulmash_at;
use super::{Burst, kingery_bulmash, peaks};
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
    /// least, for every formula but Swisdak's. Brode's last branch ends at 0.1 bar, Z = 9.92. Kinney and Graham's
    /// tables go further than 40, Kingery and Bulmash's do not. For Mills, and Newmark and Hansen, the range is where
    /// they were compared with the others here.
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
    pub fn own(self, burst: Burst, z: f64) -> (f64, Option<f64>, Option<f64>) {
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
