//! One moment as a VTK unstructured grid: faces with stresses, interfaces as line cells with gap, slip and tractions.

use super::sites::Sites;
use super::stress::{CellStress, Recovery, von_mises};
use super::vtu;
use crate::model::resolve::Model;
use crate::number::seconds;
use crate::physics::joint::Status;
use crate::physics::shape::Shape;
use crate::solve::interface::Interface;
use crate::solve::system::{State, System};
use crate::solve::unknowns::Unknowns;
use crate::{Error, Result};
use std::sync::Arc;
use vtkio::model::{Attribute, CellType};

/// Everything of a state that a frame shows, taken out of the solver so that another thread can write it.
#[derive(Debug, Clone)]
pub struct Frame {
    /// [s]
    pub time: f64,
    /// the unknowns and their rates: what moves the nodes
    q: Vec<f64>,
    v: Vec<f64>,
    a: Vec<f64>,
    pub joints: Vec<JointCell>,
}

/// A joint element's mean over its points.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct JointCell {
    /// normal distance of the two sides, positive open [m]
    pub gap: f64,
    /// plastic slip [m]
    pub slip: f64,
    /// tension positive [Pa]
    pub normal_traction: f64,
    pub shear_traction: f64,
    /// the most open of its points: 1 sticks, 2 slips, 3 open
    pub status: i32,
}

impl Frame {
    pub fn of(model: &Model, system: &System, state: &State) -> Frame {
        Frame {
            time: state.time,
            q: state.q.clone(),
            v: state.v.clone(),
            a: state.a.clone(),
            joints: joint_cells(&system.interface, model.joints.len(), system.jumps(&state.q), state),
        }
    }
}

fn joint_cells(interface: &Interface, joints: usize, jumps: &[f64], state: &State) -> Vec<JointCell> {
    let mut cells = vec![JointCell::default(); joints];
    let mut areas = vec![0.; joints];
    for (point, memory) in interface.points.iter().zip(&state.joints) {
        let gap = interface.local(point, jumps)[1] + point.law.gap;
        for &(joint, area) in &point.parts {
            let cell = &mut cells[joint];
            cell.gap += area * gap;
            cell.slip += area * memory.slip;
            cell.shear_traction += area * memory.traction[0];
            cell.normal_traction += area * memory.traction[1];
            cell.status = cell.status.max(status_number(memory.status));
            areas[joint] += area;
        }
    }
    for (cell, area) in cells.iter_mut().zip(areas) {
        for value in [&mut cell.gap, &mut cell.slip, &mut cell.shear_traction, &mut cell.normal_traction] {
            *value /= area;
        }
    }
    cells
}

fn status_number(status: Status) -> i32 {
    match status {
        Status::Stick => 1,
        Status::SlipForward | Status::SlipBackward => 2,
        Status::Open => 3,
    }
}

/// The part of every frame that does not change: points, cells, materials, and what makes fields of a state.
pub struct Grid {
    base: vtu::Base,
    /// number of the material, from 1 in the order of [`Model::materials`]; 0 on interfaces
    material: Vec<i32>,
    /// the points, one for each material that meets at a node
    sites: Sites,
    recovery: Recovery,
    unknowns: Arc<Unknowns>,
}

impl Grid {
    pub fn new(model: &Model, system: &System) -> Grid {
        let sites = Sites::new(model);
        let (mut connectivity, mut offsets, mut types, mut material) = (vec![], vec![], vec![], vec![]);
        let mut push = |nodes: &mut dyn Iterator<Item = usize>, shape: Shape, number: i32| {
            connectivity.extend(nodes.map(|n| n as u64));
            offsets.push(connectivity.len() as u64);
            types.push(cell_type(shape));
            material.push(number);
        };
        for ((cell, _), of_face) in model.faces().zip(&sites.faces) {
            let number = model.material_of[cell].map_or(0, |m| m as i32 + 1);
            push(&mut of_face.iter().copied(), model.mesh.cells[cell].shape, number);
        }
        for joint in model.joints.iter() {
            push(&mut joint.pairs.iter().map(|&p| model.pairs[p].ground), joint.shape, 0);
        }
        Grid {
            base: vtu::Base::new(&sites.in_space(&model.mesh.points), &connectivity, &offsets, &types),
            material,
            recovery: Recovery::new(model, &sites),
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
        self.add_cell_data(&mut file, &frame.joints, &centres);
        let why = |e| Error::input(format!("the frame at {} cannot be written as VTU: {e}", seconds(frame.time)));
        file.bytes().map_err(why)
    }

    fn add_point_data(&self, file: &mut vtu::File, frame: &Frame, origin: &[f64], stress: &[[f64; 4]]) {
        let moved: Vec<f64> = frame.q.iter().zip(origin).map(|(q, o)| q - o).collect();
        let in_space = |q: &[f64]| self.sites.in_space(&self.unknowns.at_nodes(q)).into_flattened();
        let six: Vec<[f64; 6]> = stress.iter().copied().map(six).collect();
        let von_mises: Vec<f64> = stress.iter().copied().map(von_mises).collect();
        file.point(Attribute::vectors("displacement"), &in_space(&moved));
        file.point(Attribute::vectors("velocity"), &single(&in_space(&frame.v)));
        file.point(Attribute::vectors("acceleration"), &single(&in_space(&frame.a)));
        file.point(Attribute::generic("nodal_stress", 6), &single(six.as_flattened()));
        file.point(Attribute::scalars("nodal_von_mises", 1), &single(&von_mises));
    }

    /// Faces first, then interfaces; what only the other kind has is zero.
    fn add_cell_data(&self, file: &mut vtu::File, joints: &[JointCell], faces: &[CellStress]) {
        let tensor = |of: fn(&CellStress) -> [f64; 4]| -> Vec<f64> {
            let values: Vec<[f64; 6]> = faces.iter().map(|face| six(of(face))).collect();
            padded(0, values.into_flattened(), 6 * joints.len())
        };
        let von_mises = faces.iter().map(|face| von_mises(face.stress)).collect();
        file.cell(Attribute::generic("stress", 6), &tensor(|face| face.stress));
        file.cell(Attribute::generic("strain", 6), &single(&tensor(|face| face.strain)));
        file.cell(Attribute::scalars("von_mises", 1), &single(&padded(0, von_mises, joints.len())));
        file.cell(Attribute::scalars("material", 1), &self.material);
        let mut on_lines = |name: &str, of: fn(&JointCell) -> f64| {
            let values = padded(faces.len(), joints.iter().map(of).collect(), 0);
            file.cell(Attribute::scalars(name, 1), &values);
        };
        on_lines("gap", |joint| joint.gap);
        on_lines("slip", |joint| joint.slip);
        on_lines("normal_traction", |joint| joint.normal_traction);
        on_lines("shear_traction", |joint| joint.shear_traction);
        let status = padded(faces.len(), joints.iter().map(|joint| joint.status).collect(), 0);
        file.cell(Attribute::scalars("status", 1), &status);
    }
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solve::interface::JointState;
    use crate::solve::interface::testing::{LAW, along};
    use nalgebra::Vector2;

    /// Two joints of lengths 1 and 3 that share the middle one of three points: each one's mean is of its own two ends.
    #[test]
    fn a_joint_shows_the_mean_of_its_own_points() {
        let interface = along(&[[0., 0.], [1., 0.], [4., 0.]], &[LAW, LAW]);
        let joint = |slip: f64, status: Status| JointState { slip, status, traction: Vector2::new(slip, -2. * slip) };
        let joints = vec![joint(1., Status::Stick), joint(3., Status::SlipForward), joint(7., Status::Open)];
        let state = State { time: 0., q: vec![], v: vec![], a: vec![], joints, free_field: vec![] };
        // normals point down: y opens a joint by less of it
        let jumps = [0., -0.1, 0., -0.3, 0., -0.7];
        let cells = joint_cells(&interface, 2, &jumps, &state);
        for (cell, [slip, gap, status]) in cells.iter().zip([[2., 0.2, 2.], [5., 0.5, 3.]]) {
            let found = [cell.slip, cell.shear_traction, cell.normal_traction, cell.gap, f64::from(cell.status)];
            let should = [slip, slip, -2. * slip, gap, status];
            assert!(found.iter().zip(should).all(|(a, b)| (a - b).abs() < 1e-14), "{found:?}, should be {should:?}");
        }
    }
}
