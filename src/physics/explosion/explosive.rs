//! Explosives by the mass of TNT that gives the same peak pressure.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Averaged factors for the peak pressure in free air, as TM 5-855-1 is commonly cited. They depend on distance and
/// quantity (pressure or impulse) by 10 to 30 %: where that matters, `equivalence` takes a factor of the user's own.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Explosive {
    /// 1
    #[default]
    Tnt,
    /// 0.82
    Anfo,
    /// 1.11
    CompositionB,
    /// 1.37
    C4,
    /// 1.38
    H6,
    /// 1.20
    Minol,
    /// 1.06
    Octol,
    /// 1.27
    Petn,
    /// 1.42
    Pentolite,
    /// 1.07
    Tetryl,
    /// 1.07
    Tritonal,
}

impl Explosive {
    /// kg of TNT per kg.
    pub fn equivalence(self) -> f64 {
        match self {
            Explosive::Tnt => 1.,
            Explosive::Anfo => 0.82,
            Explosive::CompositionB => 1.11,
            Explosive::C4 => 1.37,
            Explosive::H6 => 1.38,
            Explosive::Minol => 1.20,
            Explosive::Octol => 1.06,
            Explosive::Petn => 1.27,
            Explosive::Pentolite => 1.42,
            Explosive::Tetryl | Explosive::Tritonal => 1.07,
        }
    }
}
