//! Whether burst and wave fit where a charge stands over a surface.

use super::{Burst, Explosion, Wave};
use crate::number::{short, short_to};

/// Scaled radius of a sphere of TNT, 1630 kg/m^3 [m/kg^(1/3)].
pub(super) const RADIUS: f64 = 0.0527;
/// Where a wave counts as passing along a surface: the angle from the perpendicular [degrees], a choice.
const GRAZING: f64 = 85.;
/// Up to here it counts as meeting it at right angles [degrees], a choice.
const UPRIGHT: f64 = 20.;

impl Explosion {
    /// What does not fit, for a charge `height` [m] over a surface that the wave meets at `least` to `most` degrees
    /// from its perpendicular. A charge that lies on the surface is not higher than it is wide.
    pub fn misfit(&self, height: f64, [least, most]: [f64; 2]) -> Option<String> {
        let (on_it, height) = (height <= 2. * RADIUS * self.tnt.cbrt(), short_to(5, height));
        let angles = match most - least < 1. {
            true => format!("{most:.0} degrees"),
            false => format!("{least:.0} to {most:.0} degrees"),
        };
        match (self.burst, self.wave) {
            (Burst::Hemispherical, _) if on_it => None,
            (Burst::Hemispherical, _) => Some(format!(
                "\"hemispherical\" is a burst on the ground, whose reflection is in its values, and the charge is {height} m \
                 above it: a burst in the air is \"spherical\""
            )),
            (Burst::Spherical, _) if on_it => Some(format!(
                "\"spherical\" is a burst in free air, and this charge of {} kg of TNT is on the ground, {height} m above it: \
                 \"hemispherical\" has the ground's reflection in its values",
                short(self.tnt)
            )),
            (_, Wave::Incident) if least < GRAZING => Some(format!(
                "the wave of a burst {height} m above it meets the ground at {angles} from the perpendicular, and \"incident\" is \
                 the pressure of a wave that passes along it (90 degrees): the ground takes more, at 0 degrees the \
                 \"reflected\" pressure; nothing between the two is computed"
            )),
            (_, Wave::Reflected) if most > UPRIGHT => Some(format!(
                "the wave of a burst {height} m above it meets the ground at {angles} from the perpendicular, and \"reflected\" \
                 is the pressure at 0 degrees: a wave that passes along the ground brings the \"incident\" one; nothing \
                 between the two is computed"
            )),
            _ => None,
        }
    }
}
