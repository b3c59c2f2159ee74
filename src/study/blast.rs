//! `coralpipe blast`: the load of an explosion, without a case.

use super::curve;
use super::screen::tell;
use crate::model::case::{Blast, ExplosionKeys, sentence_of};
use crate::number::{fixed, short};
use crate::physics::explosion::{Explosion, Form, Parameters};
use crate::physics::friedlander;
use crate::physics::polyline;
use crate::physics::pulse::Pulse;
use crate::results::file;
use crate::{Error, Result};
use serde_json::{Map, Value, json};
use std::path::{Path, PathBuf};

/// What is asked: keys of an explosion as in the case file, and how to answer.
#[derive(Debug)]
pub struct Request {
    /// (key, its text)
    pub keys: Vec<(&'static str, String)>,
    /// .csv or .svg
    pub out: Option<PathBuf>,
    pub json: bool,
}

/// Points of the curve that is drawn in characters.
const POINTS: usize = 200;

/// Parameters, pulse and curve; errors as those of the law "charge".
pub fn command(request: &Request) -> Result<String> {
    let (explosion, distance, note) = explosion(request)?;
    let mut parameters = explosion.parameters(distance);
    parameters.notes.extend(note);
    let pulse = explosion.pulse(distance);
    if let Some(path) = &request.out {
        write(path, &polyline::points(&pulse))?;
    }
    if request.json {
        return Ok(format!("{:#}\n", as_json(&explosion, distance, &parameters)));
    }
    let end = match pulse {
        Pulse::Linear { duration, .. } => duration,
        _ => parameters.duration,
    };
    let even: Vec<[f64; 2]> = (0..=POINTS).map(|i| end * i as f64 / POINTS as f64).map(|t| [t, pulse.at(t)]).collect();
    Ok(report(&explosion, distance, &parameters, &pulse) + &curve::text(&even))
}

/// The curve's points into a table or a figure, and a line on stderr that says so.
fn write(path: &Path, points: &[[f64; 2]]) -> Result<()> {
    let text = match path.extension().and_then(|e| e.to_str()) {
        Some("csv") => curve::csv(points),
        Some("svg") => curve::svg(points),
        _ => return Err(Error::input(format!("--out {}: write a file .csv or .svg", path.display()))),
    };
    let instead = if path.exists() { ", in place of the file that was there" } else { "" };
    file::remove_parts_of(path);
    file::replace(path, text.as_bytes())?;
    tell(&format!("curve of {} points written to {}{instead}", points.len(), path.display()));
    Ok(())
}

/// The keys read as those of a case file, a bare number as one, all else as a text; and what of the place does not fit.
fn explosion(request: &Request) -> Result<(Explosion, f64, Option<String>)> {
    if !request.keys.iter().any(|(key, _)| ["standoff", "height"].contains(key)) {
        return Err(Error::input("blast needs a place: --standoff, --height or both, as --standoff \"20 m\""));
    }
    let value = |text: &String| text.trim().parse::<f64>().ok().and_then(serde_json::Number::from_f64);
    let pair = |(key, text): &(&'static str, String)| {
        (key.to_string(), value(text).map_or_else(|| Value::from(text.as_str()), Value::Number))
    };
    let keys: Map<String, Value> = request.keys.iter().map(pair).collect();
    let keys: ExplosionKeys = serde_path_to_error::deserialize(Value::Object(keys))
        .map_err(|why| Error::input(format!("--{}: {}", why.path(), sentence_of(&why.inner().to_string()))))?;
    match keys.blast().map_err(Error::Input)? {
        Blast::At { explosion, distance, note } => Ok((explosion, distance, note)),
        Blast::Placed { .. } => Err(Error::input("--at is for cases: here, give --standoff or --height")),
    }
}

fn report(explosion: &Explosion, distance: f64, p: &Parameters, pulse: &Pulse) -> String {
    let line = |what: &str, value: String| format!("  {what:<34} {value}\n");
    let (formula, burst) = (explosion.formula.name(), explosion.burst.name());
    let (tnt, place) = (short(explosion.tnt), short(distance));
    let mut text = format!("{tnt} kg of TNT at {place} m: {formula}, {burst} burst\n");
    text += &line("scaled distance R / W^(1/3)", format!("{:.4} m/kg^(1/3)", p.scaled_distance));
    for (what, phase) in [("incident", p.incident), ("reflected", p.reflected)] {
        text += &line(&format!("{what} peak"), format!("{} kPa", fixed(4, phase.peak / 1e3)));
        text += &line(&format!("{what} impulse"), format!("{} kPa ms", fixed(4, phase.impulse)));
        text += &line(&format!("{what} decay b"), format!("{:.4}", phase.decay));
    }
    text += &line("arrival after the detonation", format!("{} ms", fixed(4, 1e3 * p.arrival)));
    text += &line("duration of the positive phase", format!("{} ms", fixed(4, 1e3 * p.duration)));
    text += &line("speed of the front", format!("{:.2} m/s", p.front_speed));
    text += &line("dynamic pressure", format!("{:.4} kPa", p.dynamic_pressure / 1e3));
    let [tangent, equal_impulse] = straight_lines(explosion, p).map(|t| format!("{} ms", fixed(4, 1e3 * t)));
    text += &line("straight line: tangent at t = 0", format!("zero at {tangent}"));
    text += &line("straight line: equal impulse", format!("zero at {equal_impulse}"));
    text += &p.notes.iter().map(|note| format!("  note: {note}\n")).collect::<String>();
    text + &format!(
        "\nwhat acts, the {} pressure: {}; impulse {} kPa ms\n",
        explosion.wave.name(),
        super::loads::law(pulse, "Pa"),
        fixed(4, impulse(explosion, p))
    )
}

/// Of the pulse that acts, in its form [Pa s].
fn impulse(explosion: &Explosion, p: &Parameters) -> f64 {
    let acting = explosion.acting(p);
    match explosion.form {
        Form::Tangent => acting.peak * straight_lines(explosion, p)[0] / 2.,
        Form::Friedlander | Form::EqualImpulse => acting.impulse,
    }
}

/// Durations of the two straight lines for the pressure that acts [s].
fn straight_lines(explosion: &Explosion, p: &Parameters) -> [f64; 2] {
    let decay = explosion.acting(p).decay;
    [friedlander::tangent_duration(p.duration, decay), friedlander::equal_impulse_duration(p.duration, decay)]
}

/// The same in SI.
fn as_json(explosion: &Explosion, distance: f64, parameters: &Parameters) -> Value {
    let [tangent, equal_impulse] = straight_lines(explosion, parameters);
    json!({
        "tnt_kg": explosion.tnt,
        "distance_m": distance,
        "formula": explosion.formula,
        "burst": explosion.burst,
        "wave": explosion.wave,
        "form": explosion.form,
        "scaled_distance": parameters.scaled_distance,
        "incident": parameters.incident,
        "reflected": parameters.reflected,
        "arrival_s": parameters.arrival,
        "duration_s": parameters.duration,
        "acting_impulse_pa_s": impulse(explosion, parameters),
        "tangent_duration_s": tangent,
        "equal_impulse_duration_s": equal_impulse,
        "front_speed_m_s": parameters.front_speed,
        "dynamic_pressure_pa": parameters.dynamic_pressure,
        "notes": parameters.notes,
    })
}
