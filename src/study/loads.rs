//! What `check` says of loads: their laws, their rise against the time step, their fronts against the ground's waves.

use crate::model::moving_front::MovingFront;
use crate::model::resolve::{Load, Model, Target};
use crate::number::{fixed, seconds, short, short_to};
use crate::physics::front::Front;
use crate::physics::material::Material;
use crate::physics::pulse::Pulse;

/// What a load does to its group.
pub fn role(load: &Load) -> String {
    let (kind, unit) = match load.target {
        Target::Pressure { .. } => ("pressure", "Pa"),
        Target::Traction { .. } => ("traction", "Pa"),
        Target::BodyForce { .. } => ("body force", "N/m3"),
        Target::Force { .. } => ("force", "N/m"),
    };
    let front = match load.front.as_ref().map(MovingFront::front) {
        None => ": ".into(),
        Some(Front::Plane { speed, .. } | Front::Circle { speed, .. }) => {
            format!(" behind a front at {} m/s, at each point from its passage on: ", short_to(5, *speed))
        }
        Some(Front::Charge { .. }) => " behind the wave of a charge, at the point it strikes first: ".into(),
    };
    format!("load: {kind}{front}{}", law(&load.pulse, unit))
}

/// For each load its rise, and where it sweeps its front.
pub fn report(model: &Model) -> String {
    model
        .loads
        .iter()
        .map(|load| rise(load, model.time.step) + &load.front.as_ref().map_or(String::new(), |s| front(s, model)))
        .collect()
}

fn rise(load: &Load, step: f64) -> String {
    let rise = load.pulse.rise_time();
    match rise > 0. {
        true => format!("  load on {} rises in {}: {:.1} time steps\n", load.group, seconds(rise), rise / step),
        false => format!(
            "  load on {} jumps: peak accelerations follow the element size and the time step, displacements do not\n",
            load.group
        ),
    }
}

/// The front's speed along its lines against the waves of every ground.
fn front(sweep: &MovingFront, model: &Model) -> String {
    let ([slow, fast], [first, last]) = (sweep.trace_speeds(), sweep.onset());
    let [first, last] = [first, last].map(|t| seconds((1e9 * t).round() / 1e9)); // without the round-off of places
    if slow.is_infinite() {
        return format!("    its front reaches all of the curve at once, at {first}\n");
    }
    let [least, most] = [slow, fast].map(|u| fixed(1, u));
    let speeds = match fast {
        fast if fast - slow < 1e-6 * slow => format!("at {least} m/s"),
        fast if fast.is_finite() => format!("at {least} to {most} m/s"),
        _ => format!("at {least} m/s and more, a part of it at once"),
    };
    let mut text = format!("    its front runs along the surface {speeds}, pressing from {first} to {last} on\n");
    let end = model.time.step * model.time.steps as f64;
    if sweep.onset()[1] > end {
        text += &format!("    it has not reached all of the curve when the calculation ends, at {}\n", seconds(end));
    }
    for (name, material) in model.materials.iter().filter(|(name, _)| !model.bodies.contains(name)) {
        text += &format!(
            "    {name}: {}; c_p {:.1}, c_s {:.1}, c_R {:.1} m/s\n",
            regime([slow, fast], material),
            material.p_speed(),
            material.s_speed(),
            material.rayleigh_speed()
        );
    }
    text
}

/// How a front of these speeds stands to the waves of a ground.
fn regime([slow, fast]: [f64; 2], ground: &Material) -> String {
    let one = |u: f64| match u {
        u if u >= ground.p_speed() => "superseismic (no wave of it runs ahead of the front)",
        u if u >= ground.s_speed() => "subseismic to P waves, which run ahead of the front, superseismic to S waves",
        _ => "subseismic (P and S waves run ahead of the front)",
    };
    let near = |u: f64| (u / ground.rayleigh_speed() - 1.).abs() < 0.1;
    let rayleigh = if near(slow) || near(fast) || (slow < ground.rayleigh_speed() && fast > ground.rayleigh_speed()) {
        ", close to Rayleigh waves, which grow with it"
    } else {
        ""
    };
    match (one(fast), one(slow)) {
        (first, last) if first == last => format!("{first}{rayleigh}"),
        (first, last) => format!("{first}; where it is slowest {last}{rayleigh}"),
    }
}

/// A history in words; its values have this unit.
pub fn law(pulse: &Pulse, unit: &str) -> String {
    let value = |v: f64| format!("{} {unit}", short(v));
    let time = |t: f64| seconds(t);
    match pulse {
        Pulse::Linear { peak, duration } => {
            format!("linear from {} at t = 0 to zero at {}", value(*peak), time(*duration))
        }
        Pulse::Step { peak } => format!("step of {} at t = 0", value(*peak)),
        Pulse::Ramp { peak, duration } => format!("ramp to {} at {}", value(*peak), time(*duration)),
        Pulse::HalfSine { peak, duration } => format!("half sine of {} until {}", value(*peak), time(*duration)),
        Pulse::Friedlander { peak, duration, decay, negative } => {
            let negative = negative
                .map_or(String::new(), |n| format!(", then down to {} for {}", value(-n.peak), time(n.duration)));
            format!(
                "Friedlander pulse from {} to zero at {}, decay {decay:.4}{negative}",
                value(*peak),
                time(*duration)
            )
        }
        Pulse::Table { times, values } => {
            let largest = values.iter().fold(0f64, |m, v| if v.abs() > m.abs() { *v } else { m });
            format!("table of {} times, largest value {}", times.len(), value(largest))
        }
        Pulse::Delayed { law: delayed, start, rise } => {
            let start = if *start > 0. { format!(", later by {}", time(*start)) } else { String::new() };
            let rise = if *rise > 0. { format!(", after a rise of {}", time(*rise)) } else { String::new() };
            format!("{}{start}{rise}", law(delayed, unit))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// c_p = 620.1, c_s = 168.8, c_R = 160.4 m/s of the paper's first layer.
    #[test]
    fn fronts_are_named_by_the_waves_they_outrun() {
        let layer = Material { young: 183e6, poisson: 0.46, density: 2200. };
        let words = |slow, fast| regime([slow, fast], &layer);
        assert!(words(621., 621.).starts_with("superseismic (no wave"));
        assert!(words(620., 620.).starts_with("subseismic to P waves"));
        assert!(words(169., 169.).starts_with("subseismic to P waves") && words(169., 169.).contains("Rayleigh"));
        assert!(words(168., 168.).starts_with("subseismic (P and S"));
        assert!(words(100., 100.).starts_with("subseismic (P and S") && !words(100., 100.).contains("Rayleigh"));
        assert!(words(400., 900.).starts_with("superseismic") && words(400., 900.).contains("slowest subseismic to P"));
    }
}
