//! What a study of several runs compares: a probe's motion, or the section forces of a pipe wall.

use super::history::History;
use super::run::Loaded;
use crate::results::columns::Columns;
use crate::{Error, Result};
use std::fmt;
use std::path::Path;

/// A name before the dot, what of it behind.
#[derive(Debug, Clone, PartialEq)]
pub enum Quantity {
    /// columns of `histories.csv`: one component, or the two of a vector
    Motion { probe: String, what: &'static str },
    /// a column of `rings.csv`, all round the wall
    Ring { body: String, what: &'static str },
}

const MOTIONS: [&str; 9] = ["u", "v", "a", "ux", "uy", "vx", "vy", "ax", "ay"];
const FORCES: [&str; 5] = ["N", "Q", "M", "hoop_inner", "hoop_outer"];

impl fmt::Display for Quantity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (Quantity::Motion { probe: name, what } | Quantity::Ring { body: name, what }) = self;
        f.pad(&format!("{name}.{what}"))
    }
}

impl Quantity {
    /// Those of `texts` (`A`, `A.u`, `A.uy`, `pipe_left.M`), or every probe's `motions` where there are none.
    ///
    /// Errors: names that are neither a probe nor a body of the case, unknown letters behind the dot, nothing to
    /// compare.
    pub fn all(texts: &[String], loaded: &Loaded, motions: &[&'static str]) -> Result<Vec<Quantity>> {
        let probes: Vec<&str> = loaded.model.probes.iter().map(|p| p.name.as_str()).collect();
        let bodies: Vec<&str> = loaded.model.bodies.iter().map(String::as_str).collect();
        let of_probe = |what: &&'static str| probes.iter().map(|p| Quantity::Motion { probe: p.to_string(), what });
        match (texts, probes.is_empty()) {
            ([], false) => Ok(motions.iter().flat_map(of_probe).collect()),
            ([], true) => Err(Error::input(format!(
                "{} has no probes, so there is nothing to compare: name some in \"probes\"",
                loaded.case.path().display()
            ))),
            _ => texts.iter().map(|text| Quantity::one(text, &probes, &bodies)).collect(),
        }
    }

    fn one(text: &str, probes: &[&str], bodies: &[&str]) -> Result<Quantity> {
        if probes.contains(&text) {
            return Ok(Quantity::Motion { probe: text.into(), what: "u" });
        }
        let (name, what) = text.rsplit_once('.').unwrap_or((text, ""));
        let known = |list: &[&'static str]| list.iter().copied().find(|known| *known == what);
        match (probes.contains(&name), bodies.contains(&name)) {
            (true, _) if known(&MOTIONS).is_some() => {
                Ok(Quantity::Motion { probe: name.into(), what: known(&MOTIONS).unwrap_or("u") })
            }
            (_, true) if known(&FORCES).is_some() => {
                Ok(Quantity::Ring { body: name.into(), what: known(&FORCES).unwrap_or("N") })
            }
            (true, _) => Err(Error::input(format!(
                "--compare {text}: behind a probe's name stands one of {}",
                MOTIONS.join(", ")
            ))),
            (_, true) => {
                Err(Error::input(format!("--compare {text}: behind a pipe's name stands one of {}", FORCES.join(", "))))
            }
            _ => Err(Error::input(format!(
                "--compare {text}: there is no probe or pipe \"{name}\"; probes: {}; pipes: {}",
                listed(probes),
                listed(bodies)
            ))),
        }
    }

    pub fn is_ring(&self) -> bool {
        matches!(self, Quantity::Ring { .. })
    }

    /// m, m/s, m/s2, or the unit of the section force per metre of depth.
    pub fn unit(&self) -> &'static str {
        let (Quantity::Motion { what, .. } | Quantity::Ring { what, .. }) = self;
        match what.as_bytes()[0] {
            b'u' => "m",
            b'v' => "m/s",
            b'a' => "m/s2",
            b'M' => "N m/m",
            b'h' => "Pa",
            _ => "N/m",
        }
    }

    pub fn is_acceleration(&self) -> bool {
        matches!(self, Quantity::Motion { what: "a" | "ax" | "ay", .. })
    }

    /// What a run wrote into `folder`.
    pub fn history(&self, folder: &Path) -> Result<History> {
        match self {
            Quantity::Motion { probe, what } => {
                let table = Columns::read(&folder.join("histories.csv"))?;
                let axes: &[&str] = if what.len() == 1 { &["x", "y"] } else { &[""] };
                let column = |axis: &&str| table.numbers(&format!("{probe}.{what}{axis}"));
                let columns: Vec<Vec<f64>> = axes.iter().map(column).collect::<Result<_>>()?;
                let at = |row: usize| columns.iter().map(|c| c[row]).collect();
                let values = (0..columns[0].len()).map(at).collect();
                Ok(History { times: table.numbers("t")?, values, angles: vec![] })
            }
            Quantity::Ring { body, what } => round(body, what, &Columns::read(&folder.join("rings.csv"))?),
        }
    }
}

/// Names for a sentence.
pub fn listed(names: &[&str]) -> String {
    if names.is_empty() { "none".into() } else { names.join(", ") }
}

/// At each frame the values at the body's rays.
fn round(body: &str, what: &str, table: &Columns) -> Result<History> {
    let (times, bodies) = (table.numbers("t")?, table.texts("body")?);
    let (angles, values) = (table.numbers("angle_deg")?, table.numbers(what)?);
    let mut history = History::default();
    for row in (0..times.len()).filter(|&row| bodies[row] == body) {
        if history.times.last() != Some(&times[row]) {
            history.times.push(times[row]);
            history.values.push(vec![]);
        }
        if history.times.len() == 1 {
            history.angles.push(angles[row]);
        }
        history.values.last_mut().expect("each time has its row").push(values[row]);
    }
    match history.times.is_empty() {
        true => Err(Error::input(format!(
            "there are no section forces of \"{body}\": it is no ring that can be cut into sections"
        ))),
        false => Ok(history),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_says_what_is_compared() {
        let one = |text: &str| Quantity::one(text, &["A", "a.b"], &["pipe"]);
        assert_eq!(one("A").unwrap().to_string(), "A.u");
        assert_eq!(one("a.b").unwrap().to_string(), "a.b.u");
        assert_eq!(one("a.b.vy").unwrap().to_string(), "a.b.vy");
        assert!(one("pipe.M").unwrap().is_ring() && one("A.ay").unwrap().is_acceleration());
        for (text, words) in [("B", "no probe or pipe \"B\""), ("A.M", "one of u, v, a"), ("pipe.ux", "one of N, Q, M")]
        {
            assert!(one(text).unwrap_err().to_string().contains(words), "{text}");
        }
    }
}
