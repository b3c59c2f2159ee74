//! Values that are impossible by themselves, refused at their place in the file.

use std::fmt::Display;

use serde::{Deserialize, Deserializer, de};

/// A number or a quantity in SI.
pub trait Number<'de>: Deserialize<'de> + Into<f64> + Display + Copy {}
impl<'de, T: Deserialize<'de> + Into<f64> + Display + Copy> Number<'de> for T {}

/// The value if it is `allowed`, else the sentence: what it is and what it must be.
fn check<T: Display + Copy, E: de::Error>(value: T, allowed: bool, must: &str) -> Result<T, E> {
    match allowed {
        true => Ok(value),
        false => Err(E::custom(format_args!("it is {value}, and must be {must}"))),
    }
}

fn check_positive<'de, Q: Number<'de>, E: de::Error>(value: Q) -> Result<Q, E> {
    check(value, value.into() > 0.0, "greater than 0")
}

fn check_not_negative<'de, Q: Number<'de>, E: de::Error>(value: Q) -> Result<Q, E> {
    check(value, value.into() >= 0.0, "at least 0")
}

pub fn positive<'de, D: Deserializer<'de>, Q: Number<'de>>(input: D) -> Result<Q, D::Error> {
    check_positive(Q::deserialize(input)?)
}

pub fn optional_positive<'de, D: Deserializer<'de>, Q: Number<'de>>(input: D) -> Result<Option<Q>, D::Error> {
    Option::<Q>::deserialize(input)?.map(check_positive).transpose()
}

pub fn not_negative<'de, D: Deserializer<'de>, Q: Number<'de>>(input: D) -> Result<Q, D::Error> {
    check_not_negative(Q::deserialize(input)?)
}

pub fn optional_not_negative<'de, D: Deserializer<'de>, Q: Number<'de>>(input: D) -> Result<Option<Q>, D::Error> {
    Option::<Q>::deserialize(input)?.map(check_not_negative).transpose()
}

pub fn poisson<'de, D: Deserializer<'de>>(input: D) -> Result<f64, D::Error> {
    let nu = f64::deserialize(input)?;
    let must = "greater than -1 and less than 0.5 (0.5 is incompressible: its stiffness in plane strain is infinite)";
    check(nu, -1.0 < nu && nu < 0.5, must)
}

pub fn optional_damping_ratio<'de, D: Deserializer<'de>>(input: D) -> Result<Option<f64>, D::Error> {
    let must = "at least 0 and less than 1 (1 is critical damping)";
    Option::<f64>::deserialize(input)?.map(|ratio| check(ratio, (0.0..1.0).contains(&ratio), must)).transpose()
}

pub fn hht<'de, D: Deserializer<'de>>(input: D) -> Result<f64, D::Error> {
    let alpha = f64::deserialize(input)?;
    check(alpha, (-1.0 / 3.0..=0.0).contains(&alpha), "from -1/3 to 0")
}

pub fn tolerance<'de, D: Deserializer<'de>>(input: D) -> Result<f64, D::Error> {
    let tolerance = f64::deserialize(input)?;
    check(tolerance, 0.0 < tolerance && tolerance < 1.0, "greater than 0 and less than 1")
}

pub fn optional_decay<'de, D: Deserializer<'de>>(input: D) -> Result<Option<f64>, D::Error> {
    let must = "greater than -1 (the pulse would grow)";
    Option::<f64>::deserialize(input)?.map(|decay| check(decay, decay > -1.0, must)).transpose()
}

pub fn optional_tolerance<'de, D: Deserializer<'de>>(input: D) -> Result<Option<f64>, D::Error> {
    let must = "greater than 0 and less than 1";
    Option::<f64>::deserialize(input)?.map(|share| check(share, 0.0 < share && share < 1.0, must)).transpose()
}

pub fn at_least_one<'de, D: Deserializer<'de>>(input: D) -> Result<usize, D::Error> {
    let count = usize::deserialize(input)?;
    check(count, count >= 1, "at least 1")
}
