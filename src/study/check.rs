//! `coralpipe check`: everything that can be wrong with a case or a mesh, found without solving.

use super::cost::Cost;
use super::damping;
use super::loads;
use super::mesh_report::{self, counts, groups, shapes};
use super::overflow::refuse_overflow;
use super::prepare::Prepared;
use super::run::{Loaded, Request, load};
use crate::escape;
use crate::model::borders::Borders;
use crate::model::case::{Analysis, Axis, Boundary, Case, MeshUnit};
use crate::model::hold::refuse_loose;
use crate::model::implausible::extent;
use crate::model::mesh::{Group, Mesh, SIDE};
use crate::model::quality;
use crate::model::resolve::Model;
use crate::number::{fixed, seconds, short};
use crate::physics::joint::{Friction, JointLaw};
use crate::physics::material::Material;
use crate::results::ring;
use crate::solve::system::Rayleigh;
use crate::{Error, Result};
use std::collections::BTreeMap;

/// Elements a wavelength needs for linear shape functions to carry it with a few per cent error in speed.
const ELEMENTS_PER_WAVELENGTH: f64 = 10.;

/// A report on a case, or on a mesh alone where the request names an `.msh`; errors as those of a run.
pub fn command(request: &Request) -> Result<String> {
    if request.case.extension().is_some_and(|e| e.eq_ignore_ascii_case("msh")) {
        if !request.geo.is_empty() || !request.sets.is_empty() || request.mesh.is_some() {
            return Err(Error::input("check FILE.msh looks at the mesh alone: --geo, --set and --mesh need a case"));
        }
        let mesh = Mesh::read(&request.case)?;
        quality::refuse_folded(&mesh)?;
        let mut warnings = mesh_report::warnings(&mesh);
        warnings.extend(mesh_report::without_group(&mesh));
        warnings.extend(Borders::of(&mesh).warnings(&mesh));
        warnings.extend(extent(&mesh, MeshUnit::default()));
        let warnings: String = warnings.iter().map(|w| format!("warning: {w}\n")).collect();
        return Ok(report(&[counts(&mesh), groups(&mesh, |_| String::new()), shapes(&mesh), warnings]));
    }
    let Loaded { case, meshed, model } = load(request)?;
    refuse_loose(&model)?;
    let prepared = Prepared::beside(&meshed.path, model)?;
    refuse_overflow(&prepared)?;
    let Prepared { model, rayleigh, .. } = prepared;
    let rayleigh = if model.analysis == Analysis::Static { Rayleigh::default() } else { rayleigh };
    let parts = [
        format!("{}\n{}", meshed.told, counts(&meshed.mesh)),
        groups(&meshed.mesh, |group| taken_for(group, &case, &model)),
        shapes(&meshed.mesh),
        waves(&model),
        time(&model) + &loads::report(&model),
        damping::told(&model, rayleigh),
        warnings(&meshed.mesh, &model, too_large(request, &case, &meshed.mesh)),
    ];
    Ok(report(&parts))
}

fn report(parts: &[String]) -> String {
    parts.iter().filter(|p| !p.is_empty()).map(String::as_str).collect::<Vec<_>>().join("\n")
}

/// What the case uses a group for.
fn taken_for(group: &Group, case: &Case, model: &Model) -> String {
    let is = |dimension: usize, name: &str| group.dimension == dimension && group.is_called(name);
    // supports and initial do not say which dimension they mean
    let meant = |name: &str| {
        group.is_called(name)
            && model.mesh.group(name).is_ok_and(|g| (g.dimension, &g.name) == (group.dimension, &group.name))
    };
    let mut roles = Vec::new();
    if let Some((_, material)) = model.materials.iter().find(|(name, _)| is(2, name)) {
        roles.push(material_role(material));
    }
    if let Some(seam) = model.seams.iter().position(|s| is(1, &s.curve)) {
        roles.push(interface_role(seam, model));
    }
    if case.slits.iter().any(|name| is(1, name)) {
        roles.push("slit: its two sides share no nodes".into());
    }
    for (_, axes) in case.supports.iter().filter(|(name, _)| meant(name)) {
        let names: Vec<&str> = axes.iter().map(|a| ["x", "y"][a.index()]).collect();
        let both = if on_interface(group, model) { ", on both sides of the interface" } else { "" };
        roles.push(format!("support: u_{} = 0{both}", names.join(" = u_")));
    }
    if case.initial.keys().any(|name| meant(name)) {
        roles.push("initial motion".into());
    }
    if let Some((_, kind)) = case.boundaries.iter().find(|(name, _)| is(1, name)) {
        roles.push(boundary_role(*kind, case.analysis).into());
    }
    roles.extend(model.loads.iter().filter(|load| is(load.target.dimension(), &load.group)).map(loads::role));
    if model.probes.iter().any(|p| is(0, &p.name)) {
        roles.push(if on_interface(group, model) { "probe, on the body's side" } else { "probe" }.into());
    }
    if case.interfaces.bonded.iter().any(|name| is(1, name)) {
        roles.push("interface, bonded: both sides share their nodes".into());
    }
    roles.extend(roles_of_sides(group, case, model));
    if roles.is_empty() { "not used".into() } else { roles.join("; ") }
}

/// What the case uses the sides of a group on an interface for: `joint@ground`, `P@layer_1`.
fn roles_of_sides(group: &Group, case: &Case, model: &Model) -> Vec<String> {
    let is_side = |name: &str| {
        let of_group = name.split_once(SIDE).is_some_and(|(group_name, _)| group.is_called(group_name));
        of_group && model.mesh.group(name).is_ok_and(|side| side.dimension == group.dimension)
    };
    let axes = |axes: &[Axis]| axes.iter().map(|a| ["x", "y"][a.index()]).collect::<Vec<_>>().join(" = u_");
    let supports = case.supports.iter().map(|(name, held)| (name, format!("support: u_{} = 0", axes(held))));
    let initial = case.initial.keys().map(|name| (name, "initial motion".to_string()));
    let loads = model.loads.iter().map(|load| (&load.group, loads::role(load)));
    let probes = model.probes.iter().map(|probe| (&probe.name, "probe".to_string()));
    let all = supports.chain(initial).chain(loads).chain(probes);
    all.filter(|(name, _)| is_side(name)).map(|(name, role)| format!("{name}: {role}")).collect()
}

fn on_interface(group: &Group, model: &Model) -> bool {
    model.mesh.ground_side(group).is_some()
}

fn boundary_role(kind: Boundary, analysis: Analysis) -> &'static str {
    match (analysis, kind) {
        (Analysis::Static, _) => "boundary: holds, since nothing moves",
        (_, Boundary::Viscous) => "boundary: viscous",
        (_, Boundary::FreeField) => "boundary: viscous against the free field beyond it",
    }
}

fn material_role(m: &Material) -> String {
    format!(
        "material: E {} MPa, nu {}, rho {} kg/m3; c_p {}, c_s {} m/s; impedances {}, {} MPa s/m",
        fixed(4, m.young / 1e6),
        short(m.poisson),
        short(m.density),
        fixed(1, m.p_speed()),
        fixed(1, m.s_speed()),
        fixed(4, m.density * m.p_speed() / 1e6),
        fixed(4, m.density * m.s_speed() / 1e6)
    )
}

/// The laws along an interface, once for each ground it runs through.
fn interface_role(seam: usize, model: &Model) -> String {
    let mut laws: BTreeMap<&str, (usize, JointLaw)> = BTreeMap::new();
    for (joint, (law, _)) in model.joints.iter().zip(&model.laws).filter(|(j, _)| j.seam == seam) {
        let ground = model.material_of[joint.ground_cell].map_or("", |m| &model.materials[m].0);
        laws.entry(ground).or_insert((0, *law)).0 += 1;
    }
    let text = laws.iter().map(|(ground, (joints, law))| {
        let friction = match law.friction {
            Friction::Coulomb(f) => f,
            Friction::Tresca(_) => f64::NAN,
        };
        format!(
            "{joints} joints in {ground}, kappa_n {:.4e}, kappa_s {:.4e} Pa/m, f {friction}",
            law.normal_stiffness, law.tangential_stiffness
        )
    });
    format!("interface of {}: {}", model.seams[seam].body, text.collect::<Vec<_>>().join("; "))
}

/// For each material: how fine its elements are against its waves and the time step.
fn waves(model: &Model) -> String {
    let mut text = format!(
        "waves ({ELEMENTS_PER_WAVELENGTH} elements a wavelength; steps = time step over the time a P wave takes through an element)\n"
    );
    for (number, (name, material)) in model.materials.iter().enumerate() {
        let [shortest, longest] = size_range(model, number);
        let carried = |speed: f64| speed / (ELEMENTS_PER_WAVELENGTH * longest);
        let courant = |h: f64| material.p_speed() * model.time.step / h;
        text += &format!(
            "  {:<18} h {} to {} m: P waves to {} Hz, S waves to {} Hz; steps {} to {}\n",
            escape::name(name),
            fixed(4, shortest),
            fixed(4, longest),
            fixed(0, carried(material.p_speed())),
            fixed(0, carried(material.s_speed())),
            fixed(2, courant(longest)),
            fixed(2, courant(shortest))
        );
    }
    text
}

fn size_range(model: &Model, material: usize) -> [f64; 2] {
    let cells = (0..model.mesh.cells.len()).filter(|&c| model.material_of[c] == Some(material));
    let sides = cells.map(|c| quality::sides(&model.mesh, &model.mesh.cells[c]));
    sides.fold([f64::INFINITY, 0.], |[low, high], [l, h]| [low.min(l), high.max(h)])
}

fn time(model: &Model) -> String {
    let time = &model.time;
    format!(
        "time\n  {} steps of {} to {}, a frame every {} steps\n",
        time.steps,
        seconds(time.step),
        seconds(time.step * time.steps as f64),
        time.steps_per_frame
    )
}

/// What a run would refuse without `--large`.
fn too_large(request: &Request, case: &Case, mesh: &Mesh) -> Option<String> {
    let cost = Cost::of_run(case, mesh, true);
    let excess = cost.excess(&request.folder(case))?;
    Some(format!("a run is refused for its size: {excess}; {}", cost.remedy()))
}

fn warnings(mesh: &Mesh, model: &Model, too_large: Option<String>) -> String {
    let mut warnings = model.warnings.clone();
    warnings.extend(too_large);
    warnings.extend(ring::uncut(model));
    warnings.extend(mesh_report::warnings(mesh));
    for load in &model.loads {
        let rise = load.pulse.rise_time();
        if rise > 0. && rise < 5. * model.time.step {
            warnings.push(format!(
                "the load on {} rises in {}, less than 5 time steps of {}: its rise is not resolved",
                load.group,
                seconds(rise),
                seconds(model.time.step)
            ));
        }
    }
    warnings.iter().map(|w| format!("warning: {w}\n")).collect()
}
