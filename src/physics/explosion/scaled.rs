//! The blast of 1 kg of TNT at Z, completed where a formula gives less than all.

use super::{Burst, Formula, air, kingery_bulmash, swisdak, table};

/// Peaks [kPa], impulses [kPa ms/kg^(1/3)], times [ms/kg^(1/3)], speed [km/s].
#[derive(Debug, Clone, Copy)]
pub struct Scaled {
    pub incident: [f64; 2],
    pub reflected: [f64; 2],
    pub arrival: f64,
    pub duration: f64,
    pub speed: f64,
}

/// By one formula; what is not its own is told in `notes`.
pub fn scaled(formula: Formula, burst: Burst, z: f64, notes: &mut Vec<String>) -> Scaled {
    let all = kingery_bulmash_at(burst, z);
    match formula {
        Formula::KingeryBulmash => {
            if table_of(burst).speed.is_empty() {
                notes.push("the speed is an ideal gas's: the formula has none for this burst".into());
            }
            all
        }
        Formula::Swisdak => Scaled {
            incident: [swisdak::value(&swisdak::INCIDENT_PRESSURE, z), swisdak::value(&swisdak::INCIDENT_IMPULSE, z)],
            reflected: [
                swisdak::value(&swisdak::REFLECTED_PRESSURE, z),
                swisdak::value(&swisdak::REFLECTED_IMPULSE, z),
            ],
            arrival: swisdak::value(&swisdak::ARRIVAL, z),
            duration: swisdak::value(&swisdak::DURATION, z),
            speed: swisdak::value(&swisdak::SPEED, z),
        },
        formula => completed(formula, burst, z, all, notes),
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

fn table_of(burst: Burst) -> &'static kingery_bulmash::Table {
    match burst {
        Burst::Hemispherical => &table::HEMISPHERICAL,
        Burst::Spherical => &table::SPHERICAL,
    }
}

pub fn kingery_bulmash_arrival(burst: Burst, z: f64) -> f64 {
    kingery_bulmash::value(table_of(burst).arrival, z).expect("both tables have it")
}

pub fn kingery_bulmash_at(burst: Burst, z: f64) -> Scaled {
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
