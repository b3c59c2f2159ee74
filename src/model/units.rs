//! Physical quantities as the user writes them: a plain number in SI, or a string with its unit.
//!
//! Each type is one `f64` in SI; its definition (what it measures, its units and their factors) is one entry below.
//! `N/cm^2`, `N/cm2`, `N/cm**2` and `N/cm²` are the same unit, and the blank before it may be left out.

use std::borrow::Cow;
use std::fmt;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Deserializer, de};

use crate::{Error, Result};

/// `(name, factor)`: value in SI = number * factor; the first unit of a table is the SI unit.
type Units = &'static [(&'static str, f64)];

macro_rules! quantity {
    ($(#[$doc:meta])* $name:ident, $noun:literal, $units:expr) => {
        $(#[$doc])*
        #[derive(Debug, Clone, Copy, PartialEq, PartialOrd, Default)]
        pub struct $name(pub f64);

        impl $name {
            const UNITS: Units = $units;

            /// Value in SI of one `unit`; the error lists the units there are.
            pub fn factor(unit: &str) -> std::result::Result<f64, String> {
                factor(unit, Self::UNITS).ok_or_else(|| {
                    let names: Vec<_> = Self::UNITS.iter().map(|(name, _)| *name).collect();
                    format!("\"{unit}\" is no unit of {}; there are: {}", $noun, names.join(", "))
                })
            }

            /// Reads `"100 kPa"`-like text; without a unit the number is in SI.
            pub fn parse(text: &str) -> Result<Self> {
                parse(text, $noun, Self::UNITS).map(Self).map_err(Error::Input)
            }
        }

        impl From<$name> for f64 {
            fn from(quantity: $name) -> f64 {
                quantity.0
            }
        }

        impl fmt::Display for $name {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(f, "{} {}", self.0, Self::UNITS[0].0)
            }
        }

        impl<'de> Deserialize<'de> for $name {
            fn deserialize<D: Deserializer<'de>>(input: D) -> std::result::Result<Self, D::Error> {
                input.deserialize_any(NumberOrText { noun: $noun, units: Self::UNITS }).map(Self)
            }
        }

        impl JsonSchema for $name {
            fn schema_name() -> Cow<'static, str> {
                stringify!($name).into()
            }

            fn json_schema(_: &mut SchemaGenerator) -> Schema {
                schema($noun, Self::UNITS)
            }
        }
    };
}

const KGF: f64 = 9.80665; // standard gravity, exact by definition [N]
const POUND_FORCE: f64 = 4.448_221_615_260_5; // exact by definition [N]
const INCH: f64 = 0.0254; // exact by definition [m]

quantity! {
    /// Pressure, stress or elastic modulus [Pa].
    Pressure, "a pressure", &[
        ("Pa", 1.0), ("kPa", 1e3), ("MPa", 1e6), ("GPa", 1e9),
        ("N/m^2", 1.0), ("N/cm^2", 1e4), ("N/mm^2", 1e6), ("kN/m^2", 1e3), ("kN/cm^2", 1e7), ("MN/m^2", 1e6),
        ("bar", 1e5), ("mbar", 1e2), ("atm", 101_325.0),
        ("kgf/m^2", KGF), ("kgf/cm^2", KGF * 1e4), ("psi", POUND_FORCE / (INCH * INCH)),
    ]
}

quantity! {
    /// Mass density [kg/m^3].
    Density, "a density", &[
        ("kg/m^3", 1.0), ("kg/dm^3", 1e3), ("kg/l", 1e3), ("kg/cm^3", 1e6), ("g/cm^3", 1e3), ("t/m^3", 1e3),
    ]
}

quantity! {
    /// Length [m].
    Length, "a length", &[
        ("m", 1.0), ("km", 1e3), ("dm", 1e-1), ("cm", 1e-2), ("mm", 1e-3), ("um", 1e-6), ("in", INCH), ("ft", 12.0 * INCH),
    ]
}

quantity! {
    /// Time [s].
    Time, "a time", &[("s", 1.0), ("ms", 1e-3), ("us", 1e-6), ("min", 60.0)]
}

quantity! {
    /// Velocity [m/s].
    Velocity, "a velocity", &[("m/s", 1.0), ("cm/s", 1e-2), ("mm/s", 1e-3), ("km/s", 1e3), ("km/h", 1.0 / 3.6)]
}

quantity! {
    /// Acceleration [m/s^2].
    Acceleration, "an acceleration", &[("m/s^2", 1.0), ("cm/s^2", 1e-2), ("mm/s^2", 1e-3), ("g", KGF)]
}

quantity! {
    /// Events or decay per time [1/s].
    Rate, "a rate", &[("1/s", 1.0), ("1/ms", 1e3), ("1/min", 1.0 / 60.0)]
}

quantity! {
    /// Stiffness of a joint: stress per jump [Pa/m].
    JointStiffness, "a joint stiffness (stress per length)", &[
        ("Pa/m", 1.0), ("kPa/m", 1e3), ("MPa/m", 1e6), ("GPa/m", 1e9), ("MPa/mm", 1e9), ("GPa/mm", 1e12),
        ("N/m^3", 1.0), ("N/cm^3", 1e6), ("N/mm^3", 1e9), ("kN/m^3", 1e3), ("MN/m^3", 1e6), ("GN/m^3", 1e9),
    ]
}

quantity! {
    /// Mass [kg].
    Mass, "a mass", &[("kg", 1.0), ("g", 1e-3), ("t", 1e3), ("kt", 1e6), ("lb", 0.453_592_37)]
}

quantity! {
    /// Pressure times time [Pa s].
    Impulse, "an impulse of a pressure", &[
        ("Pa s", 1.0), ("kPa s", 1e3), ("kPa ms", 1.0), ("MPa ms", 1e3), ("bar ms", 1e2),
        ("psi ms", 1e-3 * POUND_FORCE / (INCH * INCH)),
    ]
}

quantity! {
    /// Force per volume [N/m^3].
    ForceDensity, "a force per volume", &[
        ("N/m^3", 1.0), ("kN/m^3", 1e3), ("MN/m^3", 1e6), ("N/cm^3", 1e6), ("kgf/m^3", KGF),
    ]
}

quantity! {
    /// Force per metre of depth out of the plane [N/m].
    LineForce, "a force per length", &[
        ("N/m", 1.0), ("kN/m", 1e3), ("MN/m", 1e6), ("N/cm", 1e2), ("N/mm", 1e3), ("kgf/m", KGF),
    ]
}

/// Text to the value in SI, or the sentence that says why not.
fn parse(text: &str, noun: &str, units: Units) -> std::result::Result<f64, String> {
    let trimmed = text.trim();
    let split = (0..=trimmed.len()).rev().filter(|&i| trimmed.is_char_boundary(i));
    let (number, unit) = split
        .filter_map(|i| Some((trimmed[..i].trim_end().parse::<f64>().ok()?, trimmed[i..].trim())))
        .next()
        .ok_or_else(|| refusal(&format!("{text:?}"), noun, units))?;
    let factor = match unit {
        "" => 1.0,
        _ => factor(unit, units).ok_or_else(|| refusal(&format!("{text:?}"), noun, units))?,
    };
    finite(number * factor, noun)
}

fn factor(unit: &str, units: Units) -> Option<f64> {
    units.iter().find(|(name, _)| plain(name) == plain(unit)).map(|(_, factor)| *factor)
}

fn finite(value: f64, noun: &str) -> std::result::Result<f64, String> {
    match value.is_finite() {
        true => Ok(value),
        false => Err(format!("{value} is not {noun}: it must be a finite number")),
    }
}

fn refusal(written: &str, noun: &str, units: Units) -> String {
    let names: Vec<_> = units.iter().map(|(name, _)| *name).collect();
    format!("{written} is not {noun}; write a number in {}, or a number with one of: {}", names[0], names.join(", "))
}

/// One spelling for all: no blanks, powers as bare digits, `u` for micro.
fn plain(unit: &str) -> String {
    unit.chars()
        .filter(|c| !c.is_whitespace() && *c != '^' && *c != '*')
        .map(|c| match c {
            '²' => '2',
            '³' => '3',
            'µ' | 'μ' => 'u', // U+00B5 and U+03BC
            c => c,
        })
        .collect()
}

struct NumberOrText {
    noun: &'static str,
    units: Units,
}

impl de::Visitor<'_> for NumberOrText {
    type Value = f64;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let si = self.units[0].0;
        write!(f, "{} (a number in {si} or a string like \"1 {si}\")", self.noun)
    }

    fn visit_f64<E: de::Error>(self, value: f64) -> std::result::Result<f64, E> {
        finite(value, self.noun).map_err(E::custom)
    }

    fn visit_i64<E: de::Error>(self, value: i64) -> std::result::Result<f64, E> {
        Ok(value as f64)
    }

    fn visit_u64<E: de::Error>(self, value: u64) -> std::result::Result<f64, E> {
        Ok(value as f64)
    }

    fn visit_str<E: de::Error>(self, text: &str) -> std::result::Result<f64, E> {
        parse(text, self.noun, self.units).map_err(E::custom)
    }
}

/// Number, or string whose pattern lists the units in every accepted spelling.
fn schema(noun: &str, units: Units) -> Schema {
    let spelled = |unit: &str| {
        let loose = unit.replace('/', "\\s*/\\s*").replace(' ', "\\s*");
        let powers = loose.replace("^2", "(\\^|\\*\\*)?[2²]").replace("^3", "(\\^|\\*\\*)?[3³]");
        if powers.starts_with('u') { powers.replacen('u', "[uµμ]", 1) } else { powers }
    };
    let names: Vec<_> = units.iter().map(|(name, _)| *name).collect();
    let patterns: Vec<_> = names.iter().map(|name| spelled(name)).collect();
    json_schema!({
        "description": format!("{noun}: a number in {}, or a string with one of: {}", names[0], names.join(", ")),
        "type": ["number", "string"],
        "pattern": format!("^\\s*[+-]?([0-9]+\\.?[0-9]*|\\.[0-9]+)([eE][+-]?[0-9]+)?\\s*({})?\\s*$", patterns.join("|")),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(a: f64, b: f64) -> bool {
        (a - b).abs() <= 1e-12 * b.abs()
    }

    /// Le Tan, table of materials: N/cm^2 and kg/cm^3 as printed, against the same in SI.
    #[test]
    fn the_papers_table_in_printed_units_is_the_table_in_si() {
        for (printed, si) in [("1.83e4", 183e6), ("5.19e4", 519e6), ("8.63e4", 863e6), ("2.1e7", 210e9)] {
            assert!(close(Pressure::parse(&format!("{printed} N/cm^2")).unwrap().0, si), "{printed}");
        }
        for (printed, si) in [("2.2e-3", 2200.0), ("2.6e-3", 2600.0), ("2.7e-3", 2700.0), ("7.8e-3", 7800.0)] {
            assert!(close(Density::parse(&format!("{printed} kg/cm^3")).unwrap().0, si), "{printed}");
        }
    }

    /// NIST SP 811, appendix B.8: factors for units not of the SI, seven digits as printed there.
    #[test]
    fn units_outside_the_si_have_the_factors_of_nist_sp_811() {
        for (text, si) in [
            ("1 psi", 6.894757e3),
            ("1 atm", 1.01325e5),
            ("1 bar", 1e5),
            ("1 mbar", 1e2),
            ("1 kgf/cm^2", 9.80665e4),
            ("1 kgf/m^2", 9.80665),
        ] {
            assert!((Pressure::parse(text).unwrap().0 / si - 1.0).abs() < 1e-7, "{text}");
        }
        assert!(close(Length::parse("1 ft").unwrap().0, 0.3048));
        assert!(close(Length::parse("1 in").unwrap().0, 0.0254));
        assert!(close(Density::parse("1 g/cm^3").unwrap().0, 1000.0));
    }

    /// One newton over the square or cube of each length, from first principles.
    #[test]
    fn compound_units_follow_from_their_parts() {
        let (kilo, mega, giga) = (1e3, 1e6, 1e9);
        for (text, si) in [
            ("1 N/mm^2", 1.0 / (1e-3_f64 * 1e-3)),
            ("1 N/cm^2", 1.0 / (1e-2_f64 * 1e-2)),
            ("1 kN/m^2", kilo),
            ("1 kN/cm^2", kilo / (1e-2 * 1e-2)),
            ("1 MN/m^2", mega),
            ("1 kPa", kilo),
            ("1 MPa", mega),
            ("1 GPa", giga),
        ] {
            assert!(close(Pressure::parse(text).unwrap().0, si), "{text}");
        }
        for (text, si) in [
            ("1 N/cm^3", 1.0 / 1e-2_f64.powi(3)),
            ("1 N/mm^3", 1.0 / 1e-3_f64.powi(3)),
            ("1 MPa/mm", mega / 1e-3),
            ("1 GPa/mm", giga / 1e-3),
            ("1 GN/m^3", giga),
            ("1 kN/m^3", kilo),
        ] {
            assert!(close(JointStiffness::parse(text).unwrap().0, si), "{text}");
        }
        assert!(close(LineForce::parse("1 N/mm").unwrap().0, 1e3));
        assert!(close(ForceDensity::parse("1 N/cm^3").unwrap().0, 1e6));
        assert!(close(Rate::parse("1 1/ms").unwrap().0, 1e3));
        assert!(close(Rate::parse("60 1/min").unwrap().0, 1.0));
    }

    #[test]
    fn a_unit_may_be_spelled_in_every_usual_way() {
        for text in ["2 N/cm^2", "2N/cm^2", "2 N/cm2", "2 N/cm²", "2 N/cm**2", " 2e0  N / cm^2 ", "+2 N/cm^2"] {
            assert_eq!(Pressure::parse(text).unwrap(), Pressure(2e4), "{text}");
        }
        assert_eq!(Density::parse("3 t/m³").unwrap(), Density(3000.0));
        for text in ["50 us", "50 µs", "50 μs", "50us"] {
            assert!(close(Time::parse(text).unwrap().0, 50e-6), "{text}");
        }
        assert_eq!(Pressure::parse("7").unwrap(), Pressure(7.0));
    }

    #[test]
    fn a_wrong_unit_is_a_sentence_that_lists_the_right_ones() {
        let sentence = Pressure::parse("100 kg").unwrap_err().to_string();
        assert!(
            sentence.starts_with(
                "\"100 kg\" is not a pressure; write a number in Pa, or a number with one of: Pa, kPa, MPa"
            )
        );
        for text in ["", "kPa", "1,5 kPa", "100 mPa", "100 KPA", "1e Pa", "--1 Pa", "1 2 Pa", "é", "1 é"] {
            assert!(Pressure::parse(text).is_err(), "{text}");
        }
    }

    #[test]
    fn numbers_that_are_not_finite_are_refused() {
        for text in ["nan Pa", "inf Pa", "-inf", "infinity Pa", "1e999 Pa", "1e308 GPa"] {
            assert!(Pressure::parse(text).unwrap_err().to_string().contains("finite"), "{text}");
        }
        assert!(serde_json::from_str::<Pressure>("1e999").is_err());
    }

    #[test]
    fn json_numbers_are_si_and_json_strings_carry_units() {
        let read = |json: &str| serde_json::from_str::<Time>(json).map(|t| t.0);
        assert_eq!(read("2").unwrap(), 2.0);
        assert_eq!(read("-2").unwrap(), -2.0);
        assert_eq!(read("0.5").unwrap(), 0.5);
        assert_eq!(read("\"500 ms\"").unwrap(), 0.5);
        assert!(read("[1]").unwrap_err().to_string().contains("a number in s or a string like"));
    }
}
