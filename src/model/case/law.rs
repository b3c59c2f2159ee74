//! Laws in time, as the case file gives them.

use std::path::PathBuf;

use schemars::JsonSchema;
use serde::{Deserialize, Deserializer, de};

use super::explosion::{Blast, ExplosionKeys};
use super::load::{Clock, Directed, Pressure};
use super::range::{self, Number};
use super::schema::{self, NotNegative, Positive};
use super::sentence;
use crate::model::units::{self, Impulse, Length, Time, Velocity};
use crate::physics::explosion::Form;
use crate::physics::friedlander;
use crate::physics::front::Front;
use crate::physics::pulse::{Pulse, Suction};

/// Name of a law in time.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum LawName {
    Linear,
    Step,
    Table,
    Ramp,
    HalfSine,
    Friedlander,
    Charge,
}

/// A law in time: zero before t = 0.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "an object", bound(deserialize = "Q: Number<'de>"))]
pub struct LawKeys<Q> {
    #[serde(deserialize_with = "law_name")]
    law: LawName,
    /// Direction (x right, y up) of all loads but pressures; only its direction counts, not its length.
    #[schemars(transform = schema::not_zero)]
    direction: Option<[f64; 2]>,
    /// Largest value: that at t = 0 (laws "linear", "step", "friedlander") or where the rise ends ("ramp", "half_sine").
    peak: Option<Q>,
    /// Time until zero [s], greater than 0; of the positive phase (law "friedlander"), of the rise (law "ramp").
    #[serde(default, deserialize_with = "range::optional_positive")]
    #[schemars(with = "Option<Positive<Time>>")]
    duration: Option<Time>,
    /// Decay b [-], greater than -1, of p = peak (1 - t/duration) exp(-b t/duration) (law "friedlander"; or `impulse`).
    #[serde(default, deserialize_with = "range::optional_decay")]
    #[schemars(extend("exclusiveMinimum" = -1))]
    decay: Option<f64>,
    /// Impulse of the positive phase [Pa s], from which the decay follows (law "friedlander"; or `decay`). Less than 0.718 peak times duration.
    #[serde(default, deserialize_with = "range::optional_positive")]
    #[schemars(with = "Option<Positive<Impulse>>")]
    impulse: Option<Impulse>,
    /// The pulse itself, or a straight line for it (law "friedlander"). Default: "friedlander".
    form: Option<Form>,
    /// Depth of the negative phase, greater than 0: from `duration` on the load is -6.75 negative_peak s (1 - s)^2, s the time since then over `negative_duration`; deepest at a third of it (law "friedlander"). Default: no negative phase.
    #[serde(default, deserialize_with = "range::optional_positive")]
    #[schemars(with = "Option<Positive<Q>>")]
    negative_peak: Option<Q>,
    /// Duration of the negative phase [s], greater than 0; given where `negative_peak` is (law "friedlander").
    #[serde(default, deserialize_with = "range::optional_positive")]
    #[schemars(with = "Option<Positive<Time>>")]
    negative_duration: Option<Time>,
    /// Times [s], each later than the one before; zero before the first, the last value held (law "table").
    #[schemars(with = "Option<Vec<NotNegative<Time>>>", length(min = 2))]
    times: Option<Vec<Time>>,
    /// Values at the times (law "table").
    #[schemars(length(min = 2))]
    values: Option<Vec<Q>>,
    /// Text file in place of `times` and `values`: a time and a value a line, decimal points, with commas, semicolons or blanks between; `#` starts a comment. In SI, unless its first line is a heading with units in square brackets: `t [ms], p [kPa]`.
    file: Option<PathBuf>,
    /// The charge and where it is (law "charge").
    explosion: Option<ExplosionKeys>,
    /// How a pressure sweeps over its curve. Default: everywhere at once.
    front: Option<FrontKeys>,
    /// Factor on all values. Default: 1.
    scale: Option<f64>,
    /// Straight rise from zero to the first value [s], in place of a jump. Default: 0.
    #[serde(default, deserialize_with = "range::optional_not_negative")]
    #[schemars(with = "Option<NotNegative<Time>>")]
    rise: Option<Time>,
    /// Time at which the law begins [s]. Default: 0.
    #[serde(default, deserialize_with = "range::optional_not_negative")]
    #[schemars(with = "Option<NotNegative<Time>>")]
    start: Option<Time>,
}

/// A front that travels; t = 0 is when it reaches the curve.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "an object")]
#[schemars(transform = plane_or_circle)]
pub struct FrontKeys {
    /// Speed [m/s], greater than 0. Default: the speed of the shock, where the law is "charge".
    #[serde(default, deserialize_with = "range::optional_positive")]
    #[schemars(with = "Option<Positive<Velocity>>")]
    speed: Option<Velocity>,
    /// Direction (x, y) in which a plane front travels.
    #[schemars(transform = schema::not_zero)]
    direction: Option<[f64; 2]>,
    /// Point (x, y) [m] that a circular front comes from at `speed`, in place of `direction`; each point's pulse begins as the front reaches it.
    from: Option<[Length; 2]>,
}

fn plane_or_circle(keys: &mut schemars::Schema) {
    let choices = [schema::combination(&["direction"], &["from"]), schema::combination(&["from"], &["direction"])];
    keys.insert("oneOf".into(), choices.to_vec().into());
}

/// Reads a pressure: its law, and its front if it has one.
pub fn pressure<'de, D: Deserializer<'de>>(input: D) -> Result<Pressure, D::Error> {
    let keys = LawKeys::<units::Pressure>::deserialize(input)?;
    if keys.direction.is_some() {
        return Err(de::Error::custom("a pressure has no \"direction\": it acts at right angles to its curve"));
    }
    keys.pressure().map_err(de::Error::custom)
}

/// Reads a load along a direction.
pub fn directed<'de, D: Deserializer<'de>, Q: Number<'de>>(input: D) -> Result<Directed, D::Error> {
    let keys = LawKeys::<Q>::deserialize(input)?;
    let Some(direction) = keys.direction else { return Err(de::Error::custom("the key \"direction\" is missing")) };
    if keys.law == LawName::Charge || keys.front.is_some() {
        return Err(de::Error::custom("the law \"charge\" and a \"front\" are for loads of the kind \"pressure\""));
    }
    Ok(Directed {
        direction: unit(direction).map_err(de::Error::custom)?,
        pulse: keys.pulse().map_err(de::Error::custom)?,
    })
}

fn unit(direction: [f64; 2]) -> Result<[f64; 2], String> {
    let length = direction[0].hypot(direction[1]);
    match length.is_normal() {
        true => Ok(direction.map(|d| d / length)),
        false => Err(format!("\"direction\" is {direction:?}, and must not be the zero vector")),
    }
}

/// The sentence for a wrong name is made here, where it is known that it should be a law's.
fn law_name<'de, D: Deserializer<'de>>(input: D) -> Result<LawName, D::Error> {
    LawName::deserialize(input).map_err(|why| de::Error::custom(sentence::of_noun("law", &why.to_string())))
}

impl LawName {
    pub const ALL: [LawName; 7] = [
        LawName::Linear,
        LawName::Step,
        LawName::Table,
        LawName::Ramp,
        LawName::HalfSine,
        LawName::Friedlander,
        LawName::Charge,
    ];

    /// What the load does.
    pub fn words(self) -> &'static str {
        match self {
            LawName::Linear => "falls in a straight line from `peak` at t = 0 to zero at `duration`",
            LawName::Step => "`peak` from t = 0 on",
            LawName::Table => "straight lines between `values` at `times`, given here or in a `file`",
            LawName::Ramp => "rises in a straight line to `peak` at `duration`, and stays",
            LawName::HalfSine => "half a sine wave of height `peak` until `duration`",
            LawName::Friedlander => {
                "`peak` (1 - t/duration) exp(-decay t/duration), then its negative phase if it has one"
            }
            LawName::Charge => "the blast of an `explosion`; pressures only",
        }
    }

    /// Its keys: in words, then those it must have and those it may have.
    pub fn keys(self) -> (&'static str, &'static str, &'static [&'static str], &'static [&'static str]) {
        match self {
            LawName::Linear => ("linear", "\"peak\" and \"duration\"", &["peak", "duration"], &[]),
            LawName::Step => ("step", "\"peak\"", &["peak"], &[]),
            LawName::Table => ("table", "either \"times\" and \"values\" or a \"file\"", &["times", "values"], &[]),
            LawName::Ramp => ("ramp", "\"peak\" and \"duration\"", &["peak", "duration"], &[]),
            LawName::HalfSine => ("half_sine", "\"peak\" and \"duration\"", &["peak", "duration"], &[]),
            LawName::Friedlander => (
                "friedlander",
                "\"peak\", \"duration\" and one of \"decay\" and \"impulse\"",
                &["peak", "duration"],
                &["decay", "impulse", "form", "negative_peak", "negative_duration"],
            ),
            LawName::Charge => ("charge", "\"explosion\"", &["explosion"], &[]),
        }
    }
}

/// Keys that every law may have.
pub const COMMON_KEYS: [&str; 3] = ["scale", "rise", "start"];
const COMMON: &str = "\"scale\", \"rise\" and \"start\"";

impl<Q: Into<f64> + Copy> LawKeys<Q> {
    /// The law's own keys that are given.
    fn given(&self) -> Vec<&'static str> {
        let all = [
            ("peak", self.peak.is_some()),
            ("duration", self.duration.is_some()),
            ("decay", self.decay.is_some()),
            ("impulse", self.impulse.is_some()),
            ("form", self.form.is_some()),
            ("negative_peak", self.negative_peak.is_some()),
            ("negative_duration", self.negative_duration.is_some()),
            ("times", self.times.is_some()),
            ("values", self.values.is_some()),
            ("file", self.file.is_some()),
            ("explosion", self.explosion.is_some()),
        ];
        all.into_iter().filter_map(|(name, is_given)| is_given.then_some(name)).collect()
    }

    /// Every key must belong to the law, and every key it needs must be there.
    fn check(&self) -> Result<(), String> {
        let (name, needs, required, optional) = self.law.keys();
        let given = self.given();
        let strange = given.iter().find(|key| !required.contains(key) && !optional.contains(key));
        let missing = required.iter().find(|key| !given.contains(key));
        let what = match (missing, strange) {
            (None, None) => return Ok(()),
            (Some(key), _) => format!("\"{key}\" is missing"),
            (_, Some(key)) => format!("\"{key}\" is not its key"),
        };
        let may: Vec<String> = optional[optional.len().min(2)..].iter().map(|key| format!("\"{key}\", ")).collect();
        Err(format!(
            "the law \"{name}\" needs {needs}, and nothing else but {}{COMMON} if wanted; {what}",
            may.concat()
        ))
    }

    /// The history in time of a load that acts everywhere at once.
    fn pulse(self) -> Result<Pulse, String> {
        self.check()?;
        let (scale, [start, rise]) = (self.scale.unwrap_or(1.0), self.delay());
        let name = self.law.keys().0;
        let law = self.unscaled()?;
        let (unscaled, law) = (law.largest(), law.scaled(scale));
        if !law.largest().is_finite() {
            return Err(format!(
                "the law's largest value, {unscaled:e}, times \"scale\", {scale:e}, is no finite number: it is more than a \
                 computer can hold"
            ));
        }
        delayed(name, law, start, rise)
    }

    /// (start, rise) [s]
    fn delay(&self) -> [f64; 2] {
        [self.start, self.rise].map(|t| t.map_or(0.0, f64::from))
    }

    fn unscaled(self) -> Result<Pulse, String> {
        let must = "the keys were checked";
        let peak = self.peak.map(Q::into);
        let duration = self.duration.map(f64::from);
        Ok(match self.law {
            LawName::Step => Pulse::Step { peak: peak.expect(must) },
            LawName::Linear => Pulse::Linear { peak: peak.expect(must), duration: duration.expect(must) },
            LawName::Ramp => Pulse::Ramp { peak: peak.expect(must), duration: duration.expect(must) },
            LawName::HalfSine => Pulse::HalfSine { peak: peak.expect(must), duration: duration.expect(must) },
            LawName::Table => {
                let (times, values) = (self.times.expect(must), self.values.expect(must));
                table(times.into_iter().map(|t| t.0).collect(), values.into_iter().map(Q::into).collect())?
            }
            LawName::Friedlander => self.friedlander(peak.expect(must), duration.expect(must))?,
            LawName::Charge => match self.explosion.expect(must).blast()? {
                Blast::At { explosion, distance, .. } => explosion.pulse(distance),
                Blast::Placed { .. } => return Err("a charge \"at\" a point has no one history".into()),
            },
        })
    }

    fn friedlander(&self, peak: f64, duration: f64) -> Result<Pulse, String> {
        let decay = match (self.decay, self.impulse) {
            (Some(decay), None) => decay,
            (None, Some(Impulse(impulse))) => friedlander::decay(impulse / (peak * duration)).ok_or_else(|| {
                format!(
                    "\"impulse\" is {impulse} Pa s, {:.4} of peak times duration; a Friedlander pulse carries more than 0.0001 \
                     and less than 0.718 of it",
                    impulse / (peak * duration)
                )
            })?,
            _ => return Err("the law \"friedlander\" needs one of \"decay\" and \"impulse\", and not both".into()),
        };
        let form = self.form.unwrap_or_default();
        match (form.pulse(peak, duration, decay), self.negative_peak, self.negative_duration) {
            (pulse, None, None) => Ok(pulse),
            (Pulse::Friedlander { peak, duration, decay, .. }, Some(depth), Some(Time(length))) => {
                let negative = Some(Suction { peak: depth.into(), duration: length });
                Ok(Pulse::Friedlander { peak, duration, decay, negative })
            }
            (_, Some(_), Some(_)) => {
                Err("a straight line has no negative phase: leave \"form\" or the phase out".into())
            }
            _ => Err("a negative phase needs both \"negative_peak\" and \"negative_duration\"".into()),
        }
    }
}

impl LawKeys<units::Pressure> {
    fn pressure(mut self) -> Result<Pressure, String> {
        let front = self.front.take();
        self.check()?;
        let blast = self.explosion.as_ref().map(ExplosionKeys::blast).transpose()?;
        let note = match &blast {
            Some(Blast::At { note, .. }) => note.clone(),
            Some(Blast::Placed { .. }) | None => None,
        };
        let pressure = self.swept(front, blast)?;
        Ok(match note {
            Some(note) => Pressure::Noted { pressure: pressure.into(), note },
            None => pressure,
        })
    }

    fn swept(self, front: Option<FrontKeys>, blast: Option<Blast>) -> Result<Pressure, String> {
        match (front, blast) {
            (None, Some(Blast::Placed { explosion, at, clock })) => {
                let front = Front::Charge { explosion, at, scale: self.scale.unwrap_or(1.0), delay: self.delay() };
                Ok(Pressure::Sweeping(front, clock))
            }
            (Some(_), Some(Blast::Placed { .. })) => {
                Err("a charge \"at\" a point makes its own front: leave \"front\" out, or give \"standoff\"".into())
            }
            (None, _) => self.pulse().map(Pressure::Simultaneous),
            (Some(front), blast) => {
                let shock = blast.map(|blast| blast.front_speed());
                Ok(Pressure::Sweeping(front.with(self.pulse()?, shock)?, Clock::Arrival))
            }
        }
    }
}

impl FrontKeys {
    /// `shock`: the speed of the charge's own front [m/s], if there is one.
    fn with(self, pulse: Pulse, shock: Option<f64>) -> Result<Front, String> {
        let speed =
            self.speed.map(f64::from).or(shock).ok_or("\"front\" needs a \"speed\"; only a charge has its own")?;
        match (self.direction, self.from) {
            (Some(direction), None) => Ok(Front::Plane { pulse, direction: unit(direction)?, speed }),
            (None, Some(from)) => Ok(Front::Circle { pulse, from: from.map(f64::from), speed }),
            _ => {
                Err("\"front\" needs either a \"direction\", for a plane front, or a point \"from\" which it comes"
                    .into())
            }
        }
    }
}

/// Errors where there is no jump to rise over.
fn delayed(law: &str, pulse: Pulse, start: f64, rise: f64) -> Result<Pulse, String> {
    match rise > 0.0 && !pulse.jumps() {
        true => Err(format!(
            "\"rise\" replaces a jump by a straight line, and this law \"{law}\" begins at zero: leave it out"
        )),
        false => Ok(pulse.delayed(start, rise)),
    }
}

fn table(times: Vec<f64>, values: Vec<f64>) -> Result<Pulse, &'static str> {
    if times.len() != values.len() || times.len() < 2 {
        return Err("a table needs as many values as times, and at least two of each");
    }
    if !times.is_sorted_by(|a, b| a < b) || times[0] < 0.0 {
        return Err("the times of a table must ascend, each later than the one before, from 0 or later");
    }
    Ok(Pulse::Table { times, values })
}
