//! Numbers for people.

/// Nine digits at most, without the round-off of sums and products: 0.06, not 0.060000000000000005.
pub fn short(value: f64) -> String {
    short_to(9, value)
}

/// A time [s] as in "t = 0.0029 s".
pub fn seconds(time: f64) -> String {
    format!("{} s", short(time))
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

/// So many decimals; where that would be a row of digits or of zeros, five digits.
pub fn fixed(decimals: usize, value: f64) -> String {
    match value.abs() {
        size if size < 1e9 && (size == 0. || size >= 10f64.powi(-(decimals as i32))) => format!("{value:.decimals$}"),
        _ => short_to(5, value),
    }
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
    use super::{fixed, seconds, short, short_to};

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

    #[test]
    fn decimals_end_where_they_say_nothing() {
        for (value, text) in [(115.66742, "115.6674"), (0., "0.0000"), (1.5e300, "1.5e300"), (2.5e-7, "2.5e-7")] {
            assert_eq!(fixed(4, value), text);
        }
    }
}
