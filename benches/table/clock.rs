//! Times taken in turns.

use std::time::Instant;

/// Seconds, or another amount, one a round.
pub struct Samples(pub Vec<f64>);

impl Samples {
    pub fn median(&self) -> f64 {
        median(self.0.clone())
    }

    /// Median of the rounds' ratios: both of a ratio were taken side by side.
    pub fn over(&self, other: &Samples) -> f64 {
        median(self.0.iter().zip(&other.0).map(|(a, b)| a / b).collect())
    }
}

/// Times every contender once a round.
pub fn in_turns<const N: usize>(rounds: usize, mut contenders: [&mut dyn FnMut(); N]) -> [Samples; N] {
    let mut samples = [const { Vec::new() }; N];
    for _ in 0..rounds {
        for (contender, times) in contenders.iter_mut().zip(&mut samples) {
            times.push(seconds(contender));
        }
    }
    samples.map(Samples)
}

/// How long `action` takes [s].
pub fn seconds(action: impl FnOnce()) -> f64 {
    let start = Instant::now();
    action();
    start.elapsed().as_secs_f64()
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    let n = values.len();
    (values[n / 2] + values[(n - 1) / 2]) / 2.
}
