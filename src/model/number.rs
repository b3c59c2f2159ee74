//! Numbers for people.

/// Nine digits at most, without the round-off of sums and products: 0.06, not 0.060000000000000005.
pub fn short(value: f64) -> String {
    let rounded: f64 = format!("{value:.8e}").parse().unwrap_or(value);
    match rounded.abs() {
        0. => "0".into(),
        size if (1e-4..1e7).contains(&size) => format!("{rounded}"),
        _ => format!("{rounded:e}"),
    }
}

#[cfg(test)]
mod tests {
    use super::short;

    #[test]
    fn round_off_is_not_shown_and_nothing_else_is_lost() {
        let sums = [(0.1 + 0.2, "0.3"), (3. * 0.3, "0.9"), (0.06f64.next_up(), "0.06"), (-0., "0"), (1e5, "100000")];
        let ends = [(2.5e-5, "2.5e-5"), (1e7, "1e7"), (-1.5e300, "-1.5e300"), (f64::INFINITY, "inf")];
        for (value, text) in sums.into_iter().chain(ends) {
            assert_eq!(short(value), text);
        }
    }
}
