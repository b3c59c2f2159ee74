//! Where statics, or the stage under gravity, has no unique answer: which bodies are free, and which load steps decide.

use crate::model::case::Analysis;
use crate::model::resolve::Model;
use crate::number::seconds;
use crate::physics::joint::Friction;
use crate::solve::free_body::Way;
use crate::solve::free_motion::{Free, FreeMotions};
use crate::solve::system::{State, System};

/// Share of the largest force of the run below which normal forces are what a load that has ended leaves.
const UNLOADED: f64 = 1e-6;

/// Share of the normal forces that joints may take up as shear in the load step that closes them.
const SHEAR: f64 = 0.01;

/// What the states without inertia say of their own uniqueness.
pub struct Equilibria {
    motions: FreeMotions,
    /// which joint points touched in the last state
    touched: Vec<bool>,
    /// each once
    free: Vec<FreeSince>,
    /// the largest share of shear taken up while closing, and when [s]
    shear: (f64, f64),
}

struct FreeSince {
    /// name of the body
    body: String,
    free: Free,
    /// [s]
    time: f64,
}

impl Equilibria {
    /// None in a run whose states all have inertia.
    pub fn new(model: &Model, system: &System) -> Option<Equilibria> {
        let has_any = model.analysis == Analysis::Static || model.gravity > 0.;
        (has_any && !system.interface.points.is_empty()).then(|| Equilibria {
            motions: FreeMotions::new(system),
            touched: vec![],
            free: vec![],
            shear: (0., 0.),
        })
    }

    /// With one more load step.
    pub fn after(mut self, system: &System, old: &State, new: &State) -> Equilibria {
        let touches = self.motions.touching(system, new);
        let free_now = if touches == self.touched { vec![] } else { self.motions.of(&touches) };
        for (body, free) in free_now {
            if !self.free.iter().any(|known| known.body == body.name && known.free == free) {
                self.free.push(FreeSince { body: body.name.clone(), free, time: new.time });
            }
        }
        self.touched = touches;
        let share = shear_while_closing(system, old, new);
        if share > self.shear.0 {
            self.shear = (share, new.time);
        }
        self
    }

    pub fn warnings(&self) -> Vec<String> {
        let of_body = |FreeSince { body, free, time }: &FreeSince| {
            let since = seconds(*time);
            match free {
                Free::Everywhere => format!(
                    "body {body} touches nothing at t = {since}: nothing says where it is, and it is left where it stood; a load \
                     that closes its gap, or a support, would place it"
                ),
                Free::Along(way) => format!(
                    "nothing resists {} of body {body} at t = {since}: of its equilibria the one of least motion is taken; \
                     friction or a support would make it unique",
                    match way {
                        Way::X => "a motion in x",
                        Way::Y => "a motion in y",
                        Way::Turn => "a turn",
                    }
                ),
            }
        };
        let of_path = (self.shear.0 > SHEAR).then(|| {
            format!(
                "joints that close in the load step to t = {} take up shear of {:.0} % of the normal forces in the same step: how \
                 far they slid before they touched is not resolved, so the answer depends on the size of the load step; compare \
                 with smaller ones",
                seconds(self.shear.1),
                100. * self.shear.0
            )
        });
        self.free.iter().map(of_body).chain(of_path).collect()
    }
}

/// Shear of the joints that were open before, over the normal forces of all that are closed. Friction counts the slide
/// of a whole load step, and how far the joint had slid when it touched is not known.
fn shear_while_closing(system: &System, old: &State, new: &State) -> f64 {
    let points = || system.interface.points.iter().zip(old.joints.iter().zip(&new.joints));
    let jumps = system.jumps(&old.q);
    let closes = points().filter(|(point, (before, now))| {
        let was_open = before.status.is_open() || system.interface.local(point, jumps)[1] + point.law.gap > 0.;
        was_open && !now.status.is_open() && point.law.friction != Friction::Coulomb(0.)
    });
    let shear: f64 = closes.map(|(point, (_, now))| point.area * now.traction[0].abs()).sum();
    let pressed: f64 = points().map(|(point, (_, now))| -point.area * now.traction[1]).sum();
    if pressed <= UNLOADED * new.largest_force { 0. } else { shear / pressed }
}
