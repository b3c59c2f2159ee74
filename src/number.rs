//! Numbers for people.

/// Nine digits at most, without the round-off of sums and products: 0.06, not 0.060000000000000005.
pub fn short(value: f64) -> String {
    short_to(9, value)
}

/// A time [s] as in "t = 0.0029 s".
pub fn seconds(time: f64) -> String {
    format!("{} s", short(time))
}

/// The number of twelve significant digits nearest to a value. The time of step k is the decimal number k dt, 0.03 where
/// the product in binary is 0.030000000000000002: twelve digits keep apart any two of 10^9 steps, and round-off is in
/// the sixteenth. A file has this number; the computation uses the product.
pub fn nearest_decimal(value: f64) -> f64 {
    // adding zero takes the sign off -0
    format!("{value:.11e}").parse().unwrap_or(value) + 0.
}

/// [`nearest_decimal`] as a table has it, in its shortest form: without an exponent from 1e-9 to 1e15.
pub fn decimal(value: f64) -> String {
    let nearest = nearest_decimal(value);
    match nearest.abs() {
        size if size == 0. || (1e-9..1e15).contains(&size) => format!("{nearest}"),
        _ => format!("{nearest:e}"),
    }
}

/// An angle in degrees to 1e-9 degrees: 67.5, not 67.49999999999997, and 0, not 4e-15.
pub fn degrees(radians: f64) -> f64 {
    (1e9 * radians.to_degrees()).round() / 1e9 + 0.
}

/// So many digits at most.
pub fn short_to(digits: usize, value: f64) -> String {
    let rounded: f64 = format!("{value:.*e}", digits - 1).parse().unwrap_or(value);
    match rounded.abs() {
        0. => "0".into(),
        size if (1e-4..1e7).contains(&size) => format!("{rounded}"),
        _ => format!("{rounded:e}"),
    }
}

/// So many decimals; where that would be a row of digits or of zeros, five digits. Never longer than 12 characters with
/// up to four decimals.
pub fn fixed(decimals: usize, value: f64) -> String {
    let value = value + 0.; // -0 becomes 0
    match value.abs() {
        size if size < 1e7 && (size == 0. || size >= 10f64.powi(-(decimals as i32))) => format!("{value:.decimals$}"),
        _ => short_to(5, value),
    }
}

/// A place in the plane [m]: `(0.1250, -3.0000) m`, to a tenth of a millimetre.
pub fn place([x, y]: [f64; 2]) -> String {
    let coordinate = |value: f64| fixed(4, if value.abs() < 0.5e-4 { 0. } else { value });
    format!("({}, {}) m", coordinate(x), coordinate(y))
}

/// In nine places: four decimals, or three digits where those would show nothing.
pub fn readable(value: f64) -> String {
    match value.abs() {
        0. => format!("{:9.4}", 0.),
        size if (0.01..1e4).contains(&size) => format!("{value:9.4}"),
        _ => format!("{value:9.2e}"),
    }
}

#[cfg(test)]
mod tests {
    use super::{decimal, degrees, fixed, nearest_decimal, place, seconds, short, short_to};

    #[test]
    fn round_off_is_not_shown_and_nothing_else_is_lost() {
        let sums = [(0.1 + 0.2, "0.3"), (3. * 0.3, "0.9"), (0.06f64.next_up(), "0.06"), (-0., "0"), (1e5, "100000")];
        let ends = [(2.5e-5, "2.5e-5"), (1e7, "1e7"), (-1.5e300, "-1.5e300"), (f64::INFINITY, "inf")];
        for (value, text) in sums.into_iter().chain(ends) {
            assert_eq!(short(value), text);
        }
        assert_eq!([short_to(3, 1234.5), short_to(5, 1e102 / 3.)], ["1230", "3.3333e101"]);
    }

    #[test]
    fn times_are_told_without_the_round_off_of_their_steps() {
        let [twentynine_steps, late, early] = [29. * 1e-4, 3. * 0.1, 7. * 1e-7];
        assert_ne!([twentynine_steps, late, early], [0.0029, 0.3, 7e-7]);
        assert_eq!([twentynine_steps, late, early].map(seconds), ["0.0029 s", "0.3 s", "7e-7 s"]);
    }

    /// Each step's time as a person multiplies it, whatever its product in binary is. Steps of 1/3 ms have as many
    /// digits as are kept, and every third of them is a whole millisecond.
    #[test]
    fn the_time_of_a_step_is_the_decimal_number_that_it_is() {
        let times = |dt: f64, steps: &[f64]| steps.iter().map(|k| decimal(k * dt)).collect::<Vec<_>>();
        assert_ne!(300. * 1e-4, 0.03);
        assert_eq!(times(1e-4, &[0., 3., 300., 1200.]), ["0", "0.0003", "0.03", "0.12"]);
        assert_eq!(times(1e-7, &[1., 3., 1e9]), ["0.0000001", "0.0000003", "100"]);
        assert_eq!(times(1e-3 / 3., &[1., 2., 3.]), ["0.000333333333333", "0.000666666666667", "0.001"]);
        assert_eq!(times(1., &[-0., 1e15, 1e-12]), ["0", "1e15", "1e-12"]);
        let all = (0..100_000).map(|k| decimal(f64::from(k) * 1e-5));
        all.enumerate().for_each(|(k, text)| assert_eq!(text, format!("{}", k as f64 / 1e5)));
        // a reader gets the number that is nearest to the decimal
        assert_eq!(decimal(0.1 + 0.2).parse::<f64>(), Ok(0.3));
        assert_eq!(nearest_decimal(3. * 0.1), 0.3);
    }

    #[test]
    fn an_angle_is_the_decimal_number_that_it_is() {
        let of_turn = |part: f64| degrees(std::f64::consts::TAU * part);
        assert_eq!([0., 3. / 16., 1. / 64., 61. / 64.].map(of_turn), [0., 67.5, 5.625, 343.125]);
        assert_eq!(degrees(-1e-16).to_bits(), 0);
    }

    #[test]
    fn decimals_end_where_they_say_nothing() {
        for (value, text) in [(115.66742, "115.6674"), (0., "0.0000"), (1.5e300, "1.5e300"), (2.5e-7, "2.5e-7")] {
            assert_eq!(fixed(4, value), text);
        }
    }

    #[test]
    fn places_have_four_decimals_and_never_a_row_of_digits() {
        assert_eq!(place([0.125, -3.]), "(0.1250, -3.0000) m");
        assert_eq!(place([-1e-17, 3e-6]), "(0.0000, 0.0000) m");
        assert_eq!(place([1e155 / 3., -9_999_999.]), "(3.3333e154, -9999999.0000) m");
    }
}
