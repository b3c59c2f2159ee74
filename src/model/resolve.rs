//! The case's names become indices into the mesh. The user's words end here: after it only physics can fail.

use super::absorbing::{self, Absorber, absorbers};
use super::borders::Slit;
use super::boundary::Border;
use super::case::{Analysis, Case, Damping, Integration, Integrator, Mass, Newton, Quad4, Start};
use super::free_field::{self, FreeField, free_fields};
use super::initial::{Initial, initial};
use super::loads::loads;
use super::mesh::Mesh;
use super::moving_front::MovingFront;
use super::openings::Openings;
use super::overflow::refuse_overflow;
use super::probes::{NodeProbe, probes};
use super::split::{Joint, Opened, Pair, Seam};
use super::unused;
use crate::number::seconds;
use crate::physics::joint::{Friction, JointLaw};
use crate::physics::material::Material;
use crate::physics::pulse::Pulse;
use crate::physics::shape::Shape;
use crate::{Error, Result};
use std::collections::BTreeSet;
use std::sync::Arc;

/// Everything the equations need, by index.
#[derive(Debug, Clone)]
pub struct Model {
    /// with its interfaces open, unless the case is bonded; what is counted by reference belongs to all cases on it
    pub mesh: Arc<Mesh>,
    /// (face group, material)
    pub materials: Vec<(String, Material)>,
    /// for each cell the index of its material, none for lines and points
    pub material_of: Vec<Option<usize>>,
    pub quad4: Quad4,
    pub mass: Mass,
    /// whether each node leaves its mass to the other nodes of its elements
    pub light: Vec<bool>,
    /// names of the open interfaces; joints refer to them
    pub seams: Vec<Seam>,
    /// names of the interfaces' bodies, each once; also where the case is bonded
    pub bodies: Vec<String>,
    /// borders inside the solid that are open on purpose
    pub slits: Arc<[Slit]>,
    pub pairs: Arc<[Pair]>,
    pub joints: Arc<[Joint]>,
    /// for each joint
    pub laws: Vec<(JointLaw, Integration)>,
    /// for each node and axis
    pub fixed: Vec<[bool; 2]>,
    /// lines of dashpots
    pub absorbers: Vec<Absorber>,
    /// sides with the ground beyond them
    pub free_fields: Vec<FreeField>,
    pub loads: Vec<Load>,
    pub probes: Vec<NodeProbe>,
    pub damping: Option<Damping>,
    pub analysis: Analysis,
    /// downwards [m/s^2]
    pub gravity: f64,
    /// displacement [m] and velocity [m/s] of every node at t = 0
    pub initial: Initial,
    pub integrator: Integrator,
    pub newton: Newton,
    pub start: Start,
    pub time: TimeGrid,
    pub warnings: Vec<String>,
}

/// Equal steps from t = 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TimeGrid {
    /// [s]
    pub step: f64,
    pub steps: usize,
    pub steps_per_frame: usize,
    pub energy: EnergyTolerance,
}

/// How much energy joints may make that open, close or begin to slip within a step, in shares of the energy supplied.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EnergyTolerance {
    /// at most [-]
    pub share: f64,
    /// before any step is cut for it [-]
    pub free: f64,
    /// beyond it per time, in steps that are not cut [1/s]
    pub rate: f64,
}

impl EnergyTolerance {
    /// Where the case names none [-].
    const DEFAULT: f64 = 0.02;

    /// Over a run until `end` [s]: half of the share is free, the other half is a budget by time.
    pub fn new(named: Option<f64>, end: f64) -> EnergyTolerance {
        let share = named.unwrap_or(EnergyTolerance::DEFAULT);
        EnergyTolerance { share, free: share / 2., rate: share / 2. / end }
    }
}

#[derive(Debug, Clone, PartialEq)]
pub struct Load {
    pub group: String,
    /// [Pa], [N/m^3] or [N/m], as the target says
    /// where it sweeps, the history at the point that it reaches first
    pub pulse: Pulse,
    pub target: Target,
    /// how it sweeps over its lines, if it does not act everywhere at once
    pub front: Option<MovingFront>,
}

/// Where a load acts, per unit of its pulse.
#[derive(Debug, Clone, PartialEq)]
pub enum Target {
    /// presses on the lines from outside
    Pressure { lines: Vec<Border> },
    /// force per area of the lines along a unit vector
    Traction { lines: Vec<Border>, direction: [f64; 2] },
    /// force per volume of the faces along a unit vector
    BodyForce { cells: Vec<usize>, direction: [f64; 2] },
    /// force per metre of depth on each node along a unit vector
    Force { nodes: Vec<usize>, direction: [f64; 2] },
}

impl Target {
    /// Of the group that the load acts on: 0 points, 1 curves, 2 surfaces.
    pub fn dimension(&self) -> usize {
        match self {
            Target::Pressure { .. } | Target::Traction { .. } => 1,
            Target::BodyForce { .. } => 2,
            Target::Force { .. } => 0,
        }
    }
}

impl Model {
    /// `bonded` leaves the interfaces closed: pipe and ground share their nodes.
    ///
    /// Errors name the group or the place: groups that do not exist, faces without material, joints without friction,
    /// loads that lie inside the solid.
    pub fn new(case: &Case, mesh: &Mesh, bonded: bool) -> Result<Model> {
        Model::opened(case, mesh, bonded, &Openings::default())
    }

    /// [`Model::new`] with what is known of the mesh's `openings`.
    pub fn opened(case: &Case, mesh: &Mesh, bonded: bool, openings: &Openings) -> Result<Model> {
        let mut warnings = Vec::new();
        let (materials, mut material_of) = materials(case, mesh, &mut warnings)?;
        let interfaces = seams(case, mesh, &mut warnings);
        let of_interfaces = interfaces.iter().map(|seam| seam.body.clone());
        let bodies: BTreeSet<String> = of_interfaces.chain(unused::bonded_bodies(case, mesh)).collect();
        if !bonded {
            unused::refuse_closed_curves(case, mesh)?;
        }
        let seams = if bonded { vec![] } else { interfaces };
        let closed = unused::on_closed_interfaces(case, mesh, bonded);
        let (Opened { mesh, pairs, joints, sides }, allowed) = openings.of(mesh, &seams, &case.slits)?;
        let mesh = if closed.is_empty() { mesh } else { Mesh { bonded: closed, ..Mesh::clone(&mesh) }.into() };
        warnings.extend(allowed.warnings);
        material_of.resize(mesh.cells.len(), None);
        let law = |joint: &Joint| joint_law(case, joint, &seams[joint.seam], &materials[ground(joint, &material_of)]);
        let laws = joints.iter().map(law).collect::<Result<_>>()?;
        warnings.extend(unused::groups(case, &mesh));
        let loads = loads(case, &mesh, &sides, &mut warnings)?;
        let material = |face: usize| materials[material_of[face].expect("every face has a material by now")].1;
        let time = time_grid(case, &mut warnings)?;
        let model = Model {
            fixed: supports(case, &mesh)?,
            absorbers: absorbers(case, &mesh, &sides, material, &loads)?,
            free_fields: vec![],
            loads,
            probes: probes(case, &mesh, &mut warnings)?,
            light: light_nodes(case.mass, &mesh, &pairs),
            pairs,
            joints,
            mass: case.mass,
            damping: case.damping,
            initial: initial(case, &mesh)?,
            analysis: case.analysis,
            gravity: case.gravity.0,
            quad4: case.elements.quad4,
            integrator: case.time.integrator(),
            newton: case.newton,
            start: case.time.start,
            time,
            materials,
            material_of,
            seams,
            bodies: bodies.into_iter().collect(),
            slits: allowed.slits.into(),
            laws,
            mesh,
            warnings,
        };
        refuse_overflow(case, &model)?;
        match case.analysis {
            Analysis::Static => Ok(model.held()),
            Analysis::Dynamic => model.with_free_fields(case),
        }
    }

    /// The model with the ground beyond its free-field sides.
    fn with_free_fields(self, case: &Case) -> Result<Model> {
        let free_fields = free_fields(case, &self)?;
        let mut warnings = self.warnings.clone();
        warnings.extend(free_field::swept(&free_fields, &self.loads));
        warnings.extend(free_field::uneven(&free_fields, &self));
        warnings.extend(absorbing::loaded(case, &self));
        Ok(Model { free_fields, warnings, ..self })
    }

    /// Whether nothing but round-off is left in the energy ledger: no numerical damping, no imbalance at the start.
    pub fn closes_its_ledger(&self) -> bool {
        self.analysis == Analysis::Dynamic && self.integrator == Integrator::default() && self.start != Start::Rest
    }

    /// Every face with its material.
    pub fn faces(&self) -> impl Iterator<Item = (usize, &Material)> {
        let cells = self.material_of.iter().enumerate();
        cells.filter_map(|(cell, material)| material.map(|m| (cell, &self.materials[m].1)))
    }
}

/// Whether each node lies on an open interface and leaves its mass to others, if the case asks for it.
fn light_nodes(mass: Mass, mesh: &Mesh, pairs: &[Pair]) -> Vec<bool> {
    let mut light = vec![false; mesh.points.len()];
    if mass == Mass::Redistributed {
        for pair in pairs.iter().filter(|pair| pair.is_open()) {
            light[pair.ground] = true;
            light[pair.body] = true;
        }
    }
    light
}

fn ground(joint: &Joint, material_of: &[Option<usize>]) -> usize {
    material_of[joint.ground_cell].expect("every face has a material by now")
}

type Materials = (Vec<(String, Material)>, Vec<Option<usize>>);

fn materials(case: &Case, mesh: &Mesh, warnings: &mut Vec<String>) -> Result<Materials> {
    let mut materials = Vec::new();
    let mut material_of = vec![None; mesh.cells.len()];
    for (name, m) in &case.materials {
        if !mesh.has_group(name) {
            warnings.push(format!("material \"{name}\" is not used: {} has no such group", mesh.name));
            continue;
        }
        for &cell in &mesh.group_of(name, 2, "material")?.cells {
            if let Some(other) = material_of[cell].replace(materials.len()) {
                let (other, _): &(String, Material) = &materials[other];
                return Err(Error::input(format!(
                    "the surface at {} belongs to both \"{other}\" and \"{name}\": give each surface one material",
                    mesh.place(cell)
                )));
            }
        }
        let material = Material { young: m.young.0, poisson: m.poisson, density: m.density.0 };
        materials.push((name.clone(), material));
    }
    match (0..mesh.cells.len()).find(|&c| mesh.cells[c].shape.dimension() == 2 && material_of[c].is_none()) {
        Some(cell) => Err(no_material(case, mesh, cell)),
        None if materials.is_empty() => Err(Error::input(format!("{} has no surfaces to calculate with", mesh.name))),
        None => Ok((materials, material_of)),
    }
}

fn no_material(case: &Case, mesh: &Mesh, cell: usize) -> Error {
    let groups = mesh.groups.iter().filter(|g| g.cells.binary_search(&cell).is_ok());
    let names: Vec<String> = groups.map(|g| format!("\"{}\"", g.name)).collect();
    let whose = match names.is_empty() {
        true => "which belongs to no physical group".to_string(),
        false => format!("of group {}", names.join(" and ")),
    };
    let given: Vec<&str> = case.materials.keys().map(String::as_str).collect();
    Error::input(format!(
        "the surface at {}, {whose}, has no material; materials are given for: {}",
        mesh.place(cell),
        given.join(", ")
    ))
}

/// Interfaces whose curve or body is in the mesh; one of which neither is there is left out with a warning.
fn seams(case: &Case, mesh: &Mesh, warnings: &mut Vec<String>) -> Vec<Seam> {
    let exists = |name: &str| mesh.has_group(name);
    let mut seams = Vec::new();
    for (curve, interface) in &case.interfaces.opened {
        if exists(curve) || exists(&interface.body) {
            seams.push(Seam { curve: curve.clone(), body: interface.body.clone() });
        } else {
            warnings.push(format!(
                "interface \"{curve}\" is not used: {} has neither it nor its body \"{}\"",
                mesh.name, interface.body
            ));
        }
    }
    let unknown = case.interfaces.bonded.iter().filter(|curve| !exists(curve));
    warnings.extend(unknown.map(|curve| format!("interface \"{curve}\" is not used: {} has no such group", mesh.name)));
    seams
}

/// The layer's stiffness and friction, unless the interface names its own.
fn joint_law(
    case: &Case,
    joint: &Joint,
    seam: &Seam,
    (ground, material): &(String, Material),
) -> Result<(JointLaw, Integration)> {
    let interface = &case.interfaces.opened[&seam.curve];
    if joint.shape == Shape::Line3 && interface.integration == Integration::Gauss1 {
        return Err(Error::input(format!(
            "interfaces.{}.integration: one point in the middle does not see the ends of 6-node joints; use \"lobatto\" with \
             second-order meshes",
            seam.curve
        )));
    }
    let friction = interface.friction.or(case.materials[ground].friction).ok_or_else(|| {
        Error::input(format!(
            "interface \"{}\" runs through \"{ground}\", which has no friction: write materials.{ground}.friction or \
             interfaces.{}.friction (0 for smooth)",
            seam.curve, seam.curve
        ))
    })?;
    let layer = JointLaw::of_layer(material, interface.thickness.0, friction);
    let law = JointLaw {
        normal_stiffness: interface.normal_stiffness.map_or(layer.normal_stiffness, |k| k.0),
        tangential_stiffness: interface.tangential_stiffness.map_or(layer.tangential_stiffness, |k| k.0),
        friction: Friction::Coulomb(friction),
        gap: interface.gap.0,
    };
    Ok((law, interface.integration))
}

/// Nodes that no face uses do not move either.
fn supports(case: &Case, mesh: &Mesh) -> Result<Vec<[bool; 2]>> {
    let mut fixed = vec![[true; 2]; mesh.points.len()];
    for face in mesh.cells.iter().filter(|c| c.shape.dimension() == 2) {
        face.nodes.iter().for_each(|&n| fixed[n] = [false; 2]);
    }
    for (name, axes) in &case.supports {
        let group = mesh.group(name).map_err(|e| Error::input(format!("supports: {e}")))?;
        for node in mesh.copies_of(group).flat_map(|group| mesh.nodes_of(group)) {
            axes.iter().for_each(|axis| fixed[node][axis.index()] = true);
        }
    }
    Ok(fixed)
}

/// More steps than any machine has time for.
const MOST_STEPS: f64 = 1e9;

/// Whole steps to the end and to each frame.
fn time_grid(case: &Case, warnings: &mut Vec<String>) -> Result<TimeGrid> {
    let step = case.time.step.0;
    if case.time.end.0 / step > MOST_STEPS {
        return Err(Error::input(format!(
            "time.end = {} is {:e} steps of time.step = {}; at most {MOST_STEPS:e} can be computed",
            seconds(case.time.end.0),
            case.time.end.0 / step,
            seconds(step)
        )));
    }
    let whole = |what: &str, span: f64, warnings: &mut Vec<String>| {
        let count = (span / step).round().max(1.);
        if (count * step / span - 1.).abs() > 1e-9 {
            let (span, used) = (seconds(span), seconds(count * step));
            warnings.push(format!("{what} = {span} is not a whole number of steps; {used} is used"));
        }
        count as usize
    };
    Ok(TimeGrid {
        step,
        steps: whole("time.end", case.time.end.0, warnings),
        steps_per_frame: whole("output.every", case.frame_interval(), warnings),
        energy: EnergyTolerance::new(case.time.energy_tolerance, case.time.end.0),
    })
}
