//! What equal time steps see of a load.

use super::resolve::{Load, Target, TimeGrid};
use crate::number::{seconds, short_to};
use crate::physics::polyline;
use crate::physics::pulse::Pulse;

/// Share of the impulse that steps may miss without a word [-], and that the advised step misses at most. Of a pulse
/// that falls as exp(-t/T) steps see (dt/T)^2/12 too much: 2 % are half of T, far below any other error of such a run.
const UNSEEN: [f64; 2] = [0.02, 0.01];
/// A pulse of more steps is resolved.
const MANY: f64 = 1e6;

/// A sentence where the impulse that the steps see, dt sum p(k dt) (with half of p(0)), is not the load's.
pub fn unseen(load: &Load, time: &TimeGrid) -> Option<String> {
    let end = time.step * time.steps as f64;
    let points = until(&polyline::points(&load.pulse), end, &load.pulse);
    let [own, size] = polyline::impulse(&points);
    let last = points.last()?[0];
    let error = |step: f64| (seen(&load.pulse, step, last) - own) / size;
    let resolved = size <= 0. || !size.is_finite() || last / time.step > MANY;
    if resolved || error(time.step).abs() <= UNSEEN[0] {
        return None;
    }
    let finer = (1..30).map(|k| time.step / 2f64.powi(k)).take_while(|step| last / step <= MANY);
    let enough = finer.into_iter().find(|&step| error(step).abs() <= UNSEEN[1]);
    let advice = enough.map_or("smaller steps".into(), |step| format!("time.step = {}", seconds(step)));
    let unit = match load.target {
        Target::Pressure { .. } | Target::Traction { .. } => "Pa s",
        Target::BodyForce { .. } => "N s/m3",
        Target::Force { .. } => "N s/m",
    };
    let late = match load.pulse.jumps() && load.pulse.start() > 0. {
        true => {
            "; it jumps after t = 0, where the step before sees half of the jump: let it begin at t = 0, or give it a \"rise\""
        }
        false => "",
    };
    Some(format!(
        "the load on {} is not resolved by the time steps: its impulse is {} {unit}, and steps of {} see {} {unit} \
         ({:+.1} %); {advice} would see it within {:.0} %{late}",
        load.group,
        short_to(4, own),
        seconds(time.step),
        short_to(4, own + size * error(time.step)),
        100. * error(time.step),
        100. * UNSEEN[1]
    ))
}

/// The points that lie before the end, and the end.
fn until(points: &[[f64; 2]], end: f64, pulse: &Pulse) -> Vec<[f64; 2]> {
    let inside: Vec<[f64; 2]> = points.iter().copied().filter(|[t, _]| *t <= end).collect();
    let cut = (!inside.is_empty() && inside.len() < points.len()).then(|| [end, pulse.at(end)]);
    inside.into_iter().chain(cut).collect()
}

/// Impulse until `last` [s], where the load stays as it is, by the trapezium rule over whole steps, which is Newmark's.
fn seen(pulse: &Pulse, step: f64, last: f64) -> f64 {
    let first = (pulse.start() / step).floor() - 1.; // the step before it sees half a jump
    let first = first.max(0.);
    let steps = ((last / step - 1e-9).ceil() - first).max(1.);
    let at = |k: f64| pulse.at((first + k) * step);
    let inner: f64 = (1..steps as usize).map(|k| at(k as f64)).sum();
    let beyond = ((first + steps) * step - last) * at(steps);
    step * (inner + (at(0.) + at(steps)) / 2.) - beyond
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::physics::friedlander::impulse_ratio;

    fn load(pulse: Pulse) -> Load {
        Load { group: "top".into(), pulse, target: Target::Pressure { lines: vec![] }, front: None }
    }

    fn told(pulse: &Pulse, step: f64) -> Option<String> {
        let time = TimeGrid {
            step,
            steps: (0.1 / step).round() as usize,
            steps_per_frame: 1,
            energy: crate::model::resolve::EnergyTolerance::new(None, 0.1),
        };
        unseen(&load(pulse.clone()), &time)
    }

    /// Steps of 0.4 ms: a pulse that is over before the second step carries p dt/2 by the trapezium rule.
    #[test]
    fn a_pulse_within_a_step_carries_the_steps_half() {
        let (duration, decay) = (1e-6, 1.);
        let pulse = Pulse::Friedlander { peak: 100e3, duration, decay, negative: None };
        assert!((seen(&pulse, 0.4e-3, duration) - 20.).abs() < 1e-9);
        let own = 100e3 * duration * impulse_ratio(decay); // 0.03679 Pa s, and the polyline's is within 0.1 %
        let sentence = told(&pulse, 0.4e-3).unwrap();
        assert!(sentence.contains("steps of 0.0004 s see 20 Pa s"), "{sentence}");
        assert!(sentence.contains(&format!("impulse is {}", short_to(3, own))), "{sentence}");
    }

    /// The step that is advised is within 1 %, twice as long ones are not.
    #[test]
    fn the_advised_step_is_fine_enough() {
        for pulse in [
            Pulse::Friedlander { peak: 1., duration: 1e-3, decay: 5., negative: None },
            Pulse::Linear { peak: 1., duration: 2e-3 }.delayed(4e-3, 0.),
            Pulse::HalfSine { peak: 1., duration: 0.9e-3 },
            Pulse::Table { times: vec![0., 1e-4, 2e-4], values: vec![0., 5., 0.] },
        ] {
            let sentence = told(&pulse, 0.4e-3).unwrap_or_else(|| panic!("{pulse:?}"));
            let step: f64 = sentence.split("time.step = ").nth(1).unwrap().split(' ').next().unwrap().parse().unwrap();
            assert_eq!(told(&pulse, step), None, "{sentence}");
        }
    }

    #[test]
    fn what_steps_resolve_is_not_told() {
        for pulse in [
            Pulse::Linear { peak: 100e3, duration: 0.05 },
            Pulse::Step { peak: 1. },
            Pulse::Ramp { peak: 1., duration: 2e-3 },
            Pulse::Table { times: vec![0., 0.03, 0.05], values: vec![1., 2., 0.5] },
            Pulse::Friedlander { peak: 1., duration: 28e-3, decay: 2., negative: None }.delayed(1e-3, 1e-3),
        ] {
            assert_eq!(told(&pulse, 0.1e-3), None, "{pulse:?}");
        }
    }
}
