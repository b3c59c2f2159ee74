//! What every frame of a run shares, and a moment as a VTK unstructured grid: faces with stresses, interfaces as line
//! cells with gap, slip and tractions.

use super::frame::{Frame, JointCell};
use super::groups::Groups;
use super::polar::Polar;
use super::sites::Sites;
use super::stress::{CellStress, Recovery, principal, von_mises};
use super::vtu;
use super::xml_text::possible;
use crate::model::case::Analysis;
use crate::model::resolve::Model;
use crate::number::seconds;
use crate::physics::shape::Shape;
use crate::solve::system::System;
use crate::solve::unknowns::Unknowns;
use crate::{Error, Result};
use std::sync::Arc;
use vtkio::model::{Attribute, CellType};

/// The part of every frame that does not change: points, cells, materials, and what makes fields of a state.
pub struct Grid {
    base: vtu::Base,
    /// the points, one for each material that meets at a node
    sites: Sites,
    recovery: Recovery,
    polar: Polar,
    unknowns: Arc<Unknowns>,
}

/// Names of field data, which ParaView lists among the arrays.
const UNITS: &str = "units: SI (m, s, m/s, m/s2, Pa)";
const SIGNS: &str = "signs: tension and opening positive; normal from body to ground; shear and slip positive where the ground \
                     drags the body, or moves along it, anticlockwise round the body; traction_vector acts on the body";
const ALL_TOTAL: &str = "totals: every value is counted from the state without loads";
const FROM_GRAVITY: &str = "totals: displacement is counted from the equilibrium under gravity; stress, strain, tractions, gap, \
                            slip and jump are totals, with gravity in them";
const MODE: &str = "mode shape: displacement u is scaled to u'M u = 1 kg m2 per metre of depth; stresses and interface values belong to it";

impl Grid {
    /// Of a run.
    pub fn new(model: &Model, system: &System) -> Grid {
        let from_gravity = model.gravity != 0. && model.analysis == Analysis::Dynamic;
        Grid::with_note(model, system, if from_gravity { FROM_GRAVITY } else { ALL_TOTAL })
    }

    /// Of mode shapes.
    pub fn of_modes(model: &Model, system: &System) -> Grid {
        Grid::with_note(model, system, MODE)
    }

    fn with_note(model: &Model, system: &System, note: &str) -> Grid {
        let sites = Sites::new(model);
        let mut base = geometry(model, &sites);
        for name in [UNITS, SIGNS, note] {
            base.field(name, &[1]);
        }
        add_materials(&mut base, model);
        let groups = Groups::new(model);
        for (name, members) in groups.cells {
            base.cell(Attribute::scalars(name, 1), "", &members);
        }
        for (name, members) in groups.nodes {
            base.point(Attribute::scalars(name, 1), "", &sites.spread(&members));
        }
        Grid {
            base,
            recovery: Recovery::new(model, &sites),
            polar: Polar::new(model),
            sites,
            unknowns: system.unknowns.clone(),
        }
    }

    /// The .vtu file of a frame, displacements counted from the unknowns `origin`. Displacement, stress and the
    /// interfaces' numbers are in double precision; what has an error far above round-off or can be had from them is in
    /// single precision: half the bytes and time.
    pub fn vtu(&self, frame: &Frame, origin: &[f64]) -> Result<Vec<u8>> {
        // what stresses come from: the part of gravity is in it
        let total_displacement = self.unknowns.at_nodes(&frame.q);
        let centres = self.recovery.stresses(&total_displacement);
        let mut file = vtu::File::new(&self.base);
        let nodal_stresses = self.recovery.nodal_stresses(&total_displacement, &centres);
        self.add_point_data(&mut file, frame, origin, &nodal_stresses);
        self.add_face_data(&mut file, &centres, frame.joints.len());
        add_joint_data(&mut file, &frame.joints, centres.len());
        let why = |e| Error::input(format!("the frame at {} cannot be written as VTU: {e}", seconds(frame.time)));
        file.bytes().map_err(why)
    }

    fn add_point_data(&self, file: &mut vtu::File, frame: &Frame, origin: &[f64], stress: &[[f64; 4]]) {
        let moved: Vec<f64> = frame.q.iter().zip(origin).map(|(q, o)| q - o).collect();
        let in_space = |q: &[f64]| self.sites.in_space(&self.unknowns.at_nodes(q)).into_flattened();
        let six: Vec<[f64; 6]> = stress.iter().copied().map(six).collect();
        let von_mises: Vec<f64> = stress.iter().copied().map(von_mises).collect();
        file.point(Attribute::vectors("displacement"), "m", &in_space(&moved));
        file.point(Attribute::vectors("velocity"), "m/s", &single(&in_space(&frame.v)));
        file.point(Attribute::vectors("acceleration"), "m/s2", &single(&in_space(&frame.a)));
        file.point(Attribute::generic("nodal_stress", 6), "Pa", &single(six.as_flattened()));
        file.point(Attribute::scalars("nodal_von_mises", 1), "Pa", &single(&von_mises));
    }

    /// Faces first, then interfaces; what only the other kind has is zero.
    fn add_face_data(&self, file: &mut vtu::File, faces: &[CellStress], joints: usize) {
        let tensor = |of: fn(&CellStress) -> [f64; 4]| -> Vec<f64> {
            let values: Vec<[f64; 6]> = faces.iter().map(|face| six(of(face))).collect();
            padded(0, values.into_flattened(), 6 * joints)
        };
        let von_mises = faces.iter().map(|face| von_mises(face.stress)).collect();
        file.cell(Attribute::generic("stress", 6), "Pa", &tensor(|face| face.stress));
        file.cell(Attribute::generic("strain", 6), "", &single(&tensor(|face| face.strain)));
        file.cell(Attribute::scalars("von_mises", 1), "Pa", &single(&padded(0, von_mises, joints)));
        let principal: Vec<[f64; 3]> = faces.iter().map(|face| principal(face.stress)).collect();
        for (k, name) in ["principal_stress_1", "principal_stress_2", "principal_stress_3"].into_iter().enumerate() {
            let values = principal.iter().map(|stresses| stresses[k]).collect();
            file.cell(Attribute::scalars(name, 1), "Pa", &single(&padded(0, values, joints)));
        }
        let [hoop, radial] = self.polar.stresses(faces);
        file.cell(Attribute::scalars("hoop_stress", 1), "Pa", &single(&padded(0, hoop, joints)));
        file.cell(Attribute::scalars("radial_stress", 1), "Pa", &single(&padded(0, radial, joints)));
    }
}

fn geometry(model: &Model, sites: &Sites) -> vtu::Base {
    let (mut connectivity, mut offsets, mut types) = (vec![], vec![], vec![]);
    let mut push = |nodes: &mut dyn Iterator<Item = usize>, shape: Shape| {
        connectivity.extend(nodes.map(|n| n as u64));
        offsets.push(connectivity.len() as u64);
        types.push(cell_type(shape));
    };
    for ((cell, _), of_face) in model.faces().zip(&sites.faces) {
        push(&mut of_face.iter().copied(), model.mesh.cells[cell].shape);
    }
    for joint in model.joints.iter() {
        push(&mut joint.pairs.iter().map(|&p| model.pairs[p].ground), joint.shape);
    }
    vtu::Base::new(&sites.in_space(&model.mesh.points), &connectivity, &offsets, &types)
}

/// Number of each cell's material, from 1 in the order of [`Model::materials`], 0 on interfaces; and for each material
/// an entry of the field data under its name with its number and the dimension 2, as meshio keeps physical names.
fn add_materials(base: &mut vtu::Base, model: &Model) {
    let faces = model.faces().map(|(cell, _)| model.material_of[cell].map_or(0, |m| m as i32 + 1));
    // the case may write "surface:NAME"
    let name = |(material, _): &'_ (String, _)| {
        possible(model.mesh.group_of(material, 2, "material").map_or(material, |group| &group.name))
    };
    let names: Vec<String> = model.materials.iter().map(name).collect();
    let legend: Vec<String> = names.iter().enumerate().map(|(i, name)| format!("{} {name}", i + 1)).collect();
    let numbers: Vec<i32> = faces.chain(model.joints.iter().map(|_| 0)).collect();
    base.cell(Attribute::scalars("material", 1), &legend.join("; "), &numbers);
    for (i, name) in names.into_iter().enumerate() {
        base.field(&name, &[i as i32 + 1, 2]);
    }
}

/// `faces`: how many cells there are before the interfaces'.
fn add_joint_data(file: &mut vtu::File, joints: &[JointCell], faces: usize) {
    let mut scalar = |name: &str, unit: &str, of: fn(&JointCell) -> f64| {
        let values = padded(faces, joints.iter().map(of).collect(), 0);
        file.cell(Attribute::scalars(name, 1), unit, &values);
    };
    scalar("gap", "m", |joint| joint.gap);
    scalar("slip", "m", |joint| joint.slip);
    scalar("normal_traction", "Pa", |joint| joint.normal_traction);
    scalar("shear_traction", "Pa", |joint| joint.shear_traction);
    let mut vector = |name: &str, unit: &str, of: fn(&JointCell) -> [f64; 2]| {
        let in_space = |joint: &JointCell| [of(joint)[0], of(joint)[1], 0.];
        let values = padded(3 * faces, joints.iter().flat_map(in_space).collect(), 0);
        file.cell(Attribute::generic(name, 3), unit, &values);
    };
    vector("gap_vector", "m", |joint| joint.gap_vector);
    vector("slip_vector", "m", |joint| joint.slip_vector);
    vector("jump_vector", "m", |joint| joint.jump_vector);
    vector("traction_vector", "Pa", |joint| joint.traction_vector);
    let status = padded(faces, joints.iter().map(|joint| joint.status).collect(), 0);
    file.cell(Attribute::scalars("status", 1), "1 sticks; 2 slips; 3 open", &status);
}

/// `values` with zeros before and after.
fn padded<T: Copy + Default>(before: usize, values: Vec<T>, after: usize) -> Vec<T> {
    [vec![T::default(); before], values, vec![T::default(); after]].concat()
}

fn single(values: &[f64]) -> Vec<f32> {
    values.iter().map(|&x| x as f32).collect()
}

/// ParaView's order of a symmetric tensor: xx, yy, zz, xy, yz, xz.
fn six([xx, yy, zz, xy]: [f64; 4]) -> [f64; 6] {
    [xx, yy, zz, xy, 0., 0.]
}

fn cell_type(shape: Shape) -> CellType {
    match shape {
        Shape::Point => CellType::Vertex,
        Shape::Line2 => CellType::Line,
        Shape::Line3 => CellType::QuadraticEdge,
        Shape::Tri3 => CellType::Triangle,
        Shape::Quad4 => CellType::Quad,
        Shape::Tri6 => CellType::QuadraticTriangle,
        Shape::Quad8 => CellType::QuadraticQuad,
    }
}
