//! The case that is timed: the default one, on meshes of its own geometry.

use coralpipe::solve::law::Scheme;
use coralpipe::solve::start;
use coralpipe::solve::step::{Step, Stepper};
use coralpipe::solve::system::State;
use coralpipe::study::prepare::Prepared;
use coralpipe::study::run::{self, Request};
use std::collections::BTreeMap;

pub const CASE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/geo/twin_pipes.json");

/// Constants of the geometry's script that give a mesh of about so many unknowns. The number of joint points grows as
/// N^0.3, to 1024 at a million. Except in the default mesh the ground is of triangles, which gmsh makes in little time.
#[derive(Clone, Copy)]
pub struct Size {
    around: f64,
    through: f64,
    size_near: f64,
    size_far: f64,
    ground_nodes: f64,
}

pub const DEFAULT: Size = Size { around: 64., through: 4., size_near: 0.06, size_far: 0.4, ground_nodes: 4. };
pub const TEN_THOUSAND: Size = Size { ground_nodes: 3., ..DEFAULT };
pub const HUNDRED_THOUSAND: Size =
    Size { around: 128., through: 8., size_near: 0.0152, size_far: 0.101, ..TEN_THOUSAND };
pub const FOUR_HUNDRED_THOUSAND: Size =
    Size { around: 192., through: 12., size_near: 0.0074, size_far: 0.049, ..TEN_THOUSAND };
pub const MILLION: Size = Size { around: 256., through: 16., size_near: 0.005, size_far: 0.0305, ..TEN_THOUSAND };

impl Size {
    pub fn constants(&self) -> BTreeMap<String, f64> {
        let named = [
            ("around", self.around),
            ("through", self.through),
            ("size_near", self.size_near),
            ("size_far", self.size_far),
            ("ground_nodes", self.ground_nodes),
        ];
        named.into_iter().map(|(name, value)| (name.to_string(), value)).collect()
    }

    /// Matrices and natural modes, the mesh made if it is not there.
    pub fn prepare(&self, bonded: bool) -> Prepared {
        let request = Request {
            case: CASE.into(),
            geo: self.constants(),
            sets: vec![],
            mesh: None,
            out: None,
            bonded,
            quiet: true,
            large: false,
        };
        let loaded = run::load(&request).unwrap_or_else(|e| panic!("{e}"));
        Prepared::new(loaded.model).unwrap_or_else(|e| panic!("{e}"))
    }
}

/// The state at t = 0 and the steps from there, as `coralpipe run` makes them.
pub fn ready_to_step(prepared: &Prepared) -> (Step, Stepper) {
    let Prepared { model, system, symbolic, .. } = prepared;
    let state = start::with_acceleration(system, symbolic, State::at_rest(system), model.start)
        .expect("the mass of the default case is positive definite");
    let stepper = Stepper::new(system, symbolic, Scheme::Dynamic(model.integrator), model.time.step, model.newton)
        .expect("so is K*");
    (Step::start(state), stepper)
}
