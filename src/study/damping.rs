//! What Rayleigh's damping does to the loads: xi(f) beside their spectra, as a table for `coralpipe check` and as warnings.

use crate::model::case::{Damping, Rayleigh as Asked};
use crate::model::resolve::Model;
use crate::physics::damping::{band, least, ratio};
use crate::physics::pulse::Pulse;
use crate::results::spectrum::Spectrum;
use crate::solve::system::Rayleigh;

const FREQUENCIES: [f64; 10] = [1., 2., 5., 10., 20., 50., 100., 200., 500., 1000.];
/// Damped more than so many times the ratio asked for counts as outside the fitted band.
const TOO_MUCH: f64 = 2.;
/// Ratio that ground does not have at small strains.
const STRONG: f64 = 0.2;
/// Share of a load's energy outside the band from which on it is warned of.
const TOLERATED: f64 = 0.1;

/// The table of xi(f) and where each load lives; empty without damping.
pub fn told(model: &Model, rayleigh: Rayleigh) -> String {
    let Rayleigh { alpha, beta } = rayleigh;
    if alpha == 0. && beta == 0. {
        return String::new();
    }
    let lowest = least(alpha, beta).map_or(String::new(), |(f, xi)| format!("; least {:.3} % at {f:.2} Hz", 100. * xi));
    let row = |name: &str, value: &dyn Fn(f64) -> f64| {
        FREQUENCIES
            .iter()
            .map(|&f| format!(" {:>7}", three_digits(value(f))))
            .fold(format!("  {name:<7}"), |t, c| t + &c)
    };
    let mut text = format!(
        "damping (xi = alpha / (4 pi f) + beta pi f with alpha {alpha:.4} 1/s, beta {beta:.4e} s{lowest})\n{}\n{}\n",
        row("f [Hz]", &|f| f),
        row("xi [%]", &|f| 100. * ratio(alpha, beta, f))
    );
    for (group, spectrum) in spectra(model) {
        let [half, most] = [0.5, 0.9].map(|share| spectrum.frequency_of(share));
        text += &format!(
            "  load on {group}: half of its energy below {} Hz (xi there {} %), nine tenths below {} Hz ({} %)\n",
            three_digits(half),
            three_digits(100. * ratio(alpha, beta, half)),
            three_digits(most),
            three_digits(100. * ratio(alpha, beta, most))
        );
    }
    text
}

/// All that is suspicious about the damping of a model; nothing without damping, as in statics.
pub fn warnings(model: &Model, rayleigh: Rayleigh) -> Vec<String> {
    if rayleigh.alpha == 0. && rayleigh.beta == 0. {
        return vec![];
    }
    [outside_the_band(model, rayleigh), beyond_the_boundaries(model, rayleigh.alpha).into_iter().collect()].concat()
}

/// A sentence for each load that lives outside the band in which the damping is about what was asked for.
fn outside_the_band(model: &Model, rayleigh: Rayleigh) -> Vec<String> {
    let Rayleigh { alpha, beta } = rayleigh;
    let asked = match model.damping {
        Some(Damping { rayleigh: Asked::Ratio { ratio, .. }, .. }) => Some(ratio),
        _ => least(alpha, beta).map(|(_, xi)| xi),
    };
    let Some((asked, [low, high])) = asked.and_then(|xi| Some((xi, band(alpha, beta, TOO_MUCH * xi)?))) else {
        return one_sided(model, rayleigh);
    };
    let warning = |(group, spectrum): (String, Spectrum)| {
        let [below, above] = [spectrum.share_below(low), 1. - spectrum.share_below(high)];
        (below + above > TOLERATED).then(|| {
            format!(
                "damping: the load on {group} has {:.0} % of its energy below {} Hz and {:.0} % above {} Hz, where xi is more \
                 than {TOO_MUCH} times {} %: give damping.modes, or alpha and beta, that fit where it lives",
                100. * below,
                three_digits(low),
                100. * above,
                three_digits(high),
                three_digits(100. * asked)
            )
        })
    };
    spectra(model).into_iter().filter_map(warning).collect()
}

/// Damping by alpha or by beta alone has no band; it may be more than any ground has where the load lives.
fn one_sided(model: &Model, Rayleigh { alpha, beta }: Rayleigh) -> Vec<String> {
    let warning = |(group, spectrum): (String, Spectrum)| {
        let half = spectrum.frequency_of(0.5);
        let [below, there, above] = [0.25, 0.5, 0.75].map(|share| ratio(alpha, beta, spectrum.frequency_of(share)));
        (below.max(above) > STRONG).then(|| {
            format!(
                "damping: xi is {} % at {} Hz, below which half of the energy of the load on {group} lies, and more than {} % over a \
                 quarter of it: is that meant?",
                three_digits(100. * there),
                three_digits(half),
                three_digits(100. * STRONG)
            )
        })
    };
    spectra(model).into_iter().filter_map(warning).collect()
}

/// Where absorbing boundaries are asked for more than the first term of their damping in alpha / w can give: longer
/// than 1 / alpha after the first load.
fn beyond_the_boundaries(model: &Model, alpha: f64) -> Option<String> {
    let end = model.time.step * model.time.steps as f64;
    let first = model.loads.iter().map(|l| l.pulse.start()).fold(f64::INFINITY, f64::min);
    (!model.absorbers.is_empty() && alpha * (end - first) > 1.).then(|| {
        format!(
            "boundaries: the ground beyond them is damped to first order in alpha t, and the calculation goes on for {} s after the \
             loads begin, longer than 1 / alpha = {} s: displacements drift by some per cent from then on; end it before, take a smaller \
             alpha, or damp by beta alone",
            three_digits(end - first),
            three_digits(1. / alpha)
        )
    })
}

/// Each load's group and spectrum, from its beginning to its end, or that of the time computed for one that stays;
/// loads that never act are left out.
fn spectra(model: &Model) -> Vec<(String, Spectrum)> {
    let end = model.time.step * model.time.steps as f64;
    model.loads.iter().filter_map(|load| Some((load.group.clone(), spectrum(&load.pulse, end)?))).collect()
}

fn spectrum(pulse: &Pulse, end: f64) -> Option<Spectrum> {
    let first = pulse.start();
    let last = if pulse.end().is_finite() { pulse.end() } else { end };
    (first < last.min(end)).then(|| Spectrum::of(|t| pulse.at(t), [first, last]))?
}

/// `0.0123`, `12.3`, `1230`
fn three_digits(x: f64) -> String {
    let digits = if x > 0. && x.is_finite() { (2. - x.log10().floor()).clamp(0., 9.) as usize } else { 0 };
    format!("{x:.digits$}")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A pulse of 5 ms has the same frequencies however long the calculation goes on, and however late it begins.
    #[test]
    fn a_pulses_spectrum_is_its_own_whatever_the_time_computed() {
        let pulse = Pulse::Linear { peak: 1e5, duration: 5e-3 };
        let most = |pulse: &Pulse, end| spectrum(pulse, end).unwrap().frequency_of(0.9);
        let own = most(&pulse, 5e-3);
        // above f lies the share 3 / (2 pi^2 f tau), a tenth of it from 1.52 / tau on: 304 Hz, where the next term is 1 / (pi f tau)^2 = 4 %
        assert!((own / 304. - 1.).abs() < 0.05, "{own}");
        for end in [2e-3, 0.1, 2., 10., 100.] {
            assert_eq!(most(&pulse, end), own);
            // later, and cut by the end of the calculation: to round-off
            assert!((most(&pulse.clone().delayed(0.09, 0.), end.max(0.092)) / own - 1.).abs() < 1e-6);
        }
        assert!(spectrum(&pulse.delayed(1., 0.), 0.5).is_none());
    }
}
