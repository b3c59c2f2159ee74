//! What Rayleigh's damping does to the loads: xi(f) beside their spectra, for `coralpipe check`.

use crate::model::case::{Damping, Rayleigh as Asked};
use crate::model::resolve::Model;
use crate::physics::damping::{band, least, ratio};
use crate::results::spectrum::Spectrum;
use crate::solve::system::Rayleigh;

const FREQUENCIES: [f64; 10] = [1., 2., 5., 10., 20., 50., 100., 200., 500., 1000.];
/// Damped more than so many times the ratio asked for counts as outside the fitted band.
const TOO_MUCH: f64 = 2.;
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

/// A sentence for each load that lives outside the band in which the damping is about what was asked for.
pub fn warnings(model: &Model, rayleigh: Rayleigh) -> Vec<String> {
    let Rayleigh { alpha, beta } = rayleigh;
    let asked = match model.damping {
        Some(Damping { rayleigh: Asked::Ratio { ratio, .. }, .. }) => Some(ratio),
        _ => least(alpha, beta).map(|(_, xi)| xi),
    };
    let Some((asked, [low, high])) = asked.and_then(|xi| Some((xi, band(alpha, beta, TOO_MUCH * xi)?))) else {
        return vec![];
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

/// Each load's group and spectrum over the time computed; loads of nothing are left out.
fn spectra(model: &Model) -> Vec<(String, Spectrum)> {
    let end = model.time.step * model.time.steps as f64;
    let spectrum =
        |load: &crate::model::resolve::Load| Some((load.group.clone(), Spectrum::of(|t| load.pulse.at(t), end)?));
    model.loads.iter().filter_map(spectrum).collect()
}

/// `0.0123`, `12.3`, `1230`
fn three_digits(x: f64) -> String {
    let digits = if x > 0. && x.is_finite() { (2. - x.log10().floor()).clamp(0., 9.) as usize } else { 0 };
    format!("{x:.digits$}")
}
