//! Values that are possible but out of reason, as after a slip of units: a warning for each.
//!
//! A value far from all that is built, dug in or blasted is rarely meant. The ranges are wide: what lies outside is rarely
//! a real material or load. Light fills such as geofoam are an exception, and are warned of.

use super::case::{Analysis, Case, MeshUnit};
use super::mesh::{Cell, Mesh};
use super::resolve::{Load, Model, Target};
use super::split::{Joint, Seam};
use crate::number::{seconds, short_to};
use crate::physics::material::Material;
use crate::physics::pulse::Pulse;

/// Speed of P waves [m/s]: peat and the loosest dry soils have some 100, steel and the hardest rocks 6000.
const P_SPEED: [f64; 2] = [50., 7000.];
/// Density [kg/m^3]: pumice and light foamed concrete have some 600, tungsten 19,300.
const DENSITY: [f64; 2] = [500., 20_000.];
/// Young's modulus [Pa] in statics, where no wave runs: peat has some 3e5, diamond 1.05e12.
const YOUNG: [f64; 2] = [1e5, 1.3e12];
/// Gravity [m/s^2]: the Moon's is 1.62, and twice the Earth's only a centrifuge has.
const GRAVITY: [f64; 2] = [1.5, 2. * 9.80665];
/// Pressure [Pa]: at that of a detonating explosive nothing is elastic.
const MOST_PRESSURE: f64 = 10e9;
/// Duration of a pulse [s]: the blast of a megaton at 10 kPa lasts some 5.
const LONGEST_PULSE: f64 = 10.;
/// Time that is calculated [s]: strong earthquakes shake for about so long.
const LONGEST_TIME: f64 = 60.;
/// Largest extent of a mesh [m]: a box for model tests has more than the one, ground that a blast shakes less than the
/// other.
const EXTENT: [f64; 2] = [0.05, 2000.];

/// All that is out of reason in a case on its mesh.
pub fn implausible(case: &Case, model: &Model) -> Vec<String> {
    let mut warnings: Vec<String> = extent(&model.mesh, case.mesh_unit()).into_iter().collect();
    warnings.extend(model.materials.iter().flat_map(|(name, material)| of_material(name, material, model)));
    warnings.extend(of_gravity(model.gravity));
    warnings.extend(model.loads.iter().flat_map(|load| of_load(load, model.analysis)));
    warnings.extend(thick_layers(case, model));
    warnings.extend(long_time(model));
    warnings
}

/// A mesh whose size says that it is drawn in another unit.
pub fn extent(mesh: &Mesh, unit: MeshUnit) -> Option<String> {
    let size = diagonal(mesh);
    (!within(size, EXTENT)).then(|| {
        format!(
            "{} is {} m from corner to corner, read in {unit}: if it is drawn in another unit, name that by geometry.unit in the \
             case, as in {{ \"script\": \"NAME.geo\", \"unit\": \"mm\" }}",
            mesh.name,
            short_to(3, size)
        )
    })
}

fn within(value: f64, [least, most]: [f64; 2]) -> bool {
    (least..=most).contains(&value)
}

/// Of the smallest rectangle round the mesh [m].
fn diagonal(mesh: &Mesh) -> f64 {
    let range = |axis: usize| {
        let values = || mesh.points.iter().map(|p| p[axis]);
        values().fold(f64::NEG_INFINITY, f64::max) - values().fold(f64::INFINITY, f64::min)
    };
    range(0).hypot(range(1))
}

/// In statics the density counts under gravity only, and no wave runs.
fn of_material(name: &str, material: &Material, model: &Model) -> Vec<String> {
    let Material { young, density, .. } = *material;
    let moves = model.analysis == Analysis::Dynamic;
    let mut warnings = Vec::new();
    if (moves || model.gravity != 0.) && !within(density, DENSITY) {
        let [least, most] = DENSITY;
        warnings.push(format!(
            "materials.{name}.density is {} kg/m3; materials have {least} (pumice) to {most} (tungsten), and P waves would run at {} m/s \
             in this one: a number without a unit is in kg/m3; is \"t/m^3\" or \"g/cm^3\" meant?",
            short_to(4, density),
            short_to(4, material.p_speed())
        ));
    } else if moves && !within(material.p_speed(), P_SPEED) {
        let [least, most] = P_SPEED;
        warnings.push(format!(
            "materials.{name}: P waves would run at {} m/s; they have {least} (peat) to {most} (the hardest rocks): are young = {} Pa and \
             density = {} kg/m3 in the right units?",
            short_to(4, material.p_speed()),
            short_to(4, young),
            short_to(4, density)
        ));
    }
    if !moves && !within(young, YOUNG) {
        warnings.push(format!(
            "materials.{name}.young is {} Pa; materials have 1e5 (peat) to 1e12 (diamond): a number without a unit is in Pa; is \"MPa\" \
             meant?",
            short_to(4, young)
        ));
    }
    warnings
}

fn of_gravity(gravity: f64) -> Option<String> {
    (gravity != 0. && !within(gravity, GRAVITY)).then(|| {
        let unless = if gravity > GRAVITY[1] { ", unless a centrifuge is meant" } else { "" };
        format!(
            "gravity is {} m/s2, {} times the Earth's: a number without a unit is in m/s2; write \"1 g\" or 9.81{unless}",
            short_to(4, gravity),
            short_to(3, gravity / 9.80665)
        )
    })
}

fn of_load(load: &Load, analysis: Analysis) -> Vec<String> {
    let (peak, duration) = (load.pulse.largest(), duration(&load.pulse));
    let mut warnings = Vec::new();
    if matches!(load.target, Target::Pressure { .. } | Target::Traction { .. }) && peak > MOST_PRESSURE {
        warnings.push(format!(
            "the load on {} reaches {} GPa, more than {} GPa, which an explosive has where it detonates: a number without a unit \
             is in Pa",
            load.group,
            short_to(4, 1e-9 * peak),
            1e-9 * MOST_PRESSURE
        ));
    }
    if analysis == Analysis::Dynamic && duration > LONGEST_PULSE {
        warnings.push(format!(
            "the load on {} lasts {}, longer than the blast of a megaton: a number without a unit is in seconds; is \"ms\" meant?",
            load.group,
            seconds(duration)
        ));
    }
    warnings
}

/// Of the laws that have one key for it [s]; the times of a table may be those of an earthquake.
fn duration(pulse: &Pulse) -> f64 {
    match pulse {
        Pulse::Linear { duration, .. }
        | Pulse::Ramp { duration, .. }
        | Pulse::HalfSine { duration, .. }
        | Pulse::Friedlander { duration, .. } => *duration,
        Pulse::Step { .. } | Pulse::Table { .. } => 0.,
        Pulse::Delayed { law, .. } => duration(law),
    }
}

/// Interfaces whose layer is thicker than their elements are long: no thin layer, and softer than the ground it is part
/// of.
fn thick_layers(case: &Case, model: &Model) -> Vec<String> {
    let longest = |seam: usize| {
        let side = |joint: &Joint| {
            let nodes = joint.pairs.iter().map(|&pair| model.pairs[pair].ground).collect();
            model.mesh.measure(&Cell { shape: joint.shape, nodes })
        };
        model.joints.iter().filter(|joint| joint.seam == seam).map(side).fold(0., f64::max)
    };
    let warning = |(number, seam): (usize, &Seam)| {
        let interface = &case.interfaces.opened[&seam.curve];
        let (thickness, longest) = (interface.thickness.0, longest(number));
        let counts = interface.normal_stiffness.is_none() || interface.tangential_stiffness.is_none();
        (counts && longest > 0. && thickness > longest).then(|| {
            format!(
                "interfaces.{}.thickness is {} m, and its longest element {} m: the layer between body and ground must be thin; a \
                 number without a unit is in m; is \"mm\" or \"cm\" meant?",
                seam.curve,
                short_to(4, thickness),
                short_to(3, longest)
            )
        })
    };
    model.seams.iter().enumerate().filter_map(warning).collect()
}

/// The time of a case with waves, which are over long before.
fn long_time(model: &Model) -> Option<String> {
    let end = model.time.step * model.time.steps as f64;
    (model.analysis == Analysis::Dynamic && end > LONGEST_TIME).then(|| {
        format!(
            "time.end is {}: a blast is over within seconds, and waves cross the ground within milliseconds; a number without a \
             unit is in seconds; is \"ms\" meant?",
            seconds(end)
        )
    })
}
