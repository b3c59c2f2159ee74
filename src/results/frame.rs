//! One moment as a VTK unstructured grid: faces with stresses, interfaces as line cells with gap, slip and tractions.

use super::sites::Sites;
use super::stress::{CellStress, Recovery, von_mises};
use crate::model::resolve::Model;
use crate::physics::joint::Status;
use crate::physics::shape::Shape;
use crate::solve::interface::Interface;
use crate::solve::system::{State, System};
use crate::{Error, Result};
use vtkio::model::{
    Attribute, Attributes, ByteOrder, CellType, Cells, DataSet, IOBuffer, Piece, UnstructuredGridPiece, Version,
    VertexNumbers, Vtk,
};
use vtkio::xml::Compressor;

/// Everything of a state that a frame shows, taken out of the solver so that another thread can write it.
#[derive(Debug, Clone)]
pub struct Frame {
    /// [s]
    pub time: f64,
    /// per node [m], [m/s], [m/s^2]; displacement since the equilibrium under gravity
    pub displacement: Vec<[f64; 2]>,
    pub velocity: Vec<[f64; 2]>,
    pub acceleration: Vec<[f64; 2]>,
    pub joints: Vec<JointCell>,
    /// what stresses come from, the part of gravity in it [m]
    total_displacement: Vec<[f64; 2]>,
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
    /// `origin`: the unknowns in equilibrium under gravity.
    pub fn of(model: &Model, system: &System, state: &State, origin: &[f64]) -> Frame {
        let moved: Vec<f64> = state.q.iter().zip(origin).map(|(q, o)| q - o).collect();
        Frame {
            time: state.time,
            displacement: system.unknowns.at_nodes(&moved),
            total_displacement: system.unknowns.at_nodes(&state.q),
            velocity: system.unknowns.at_nodes(&state.v),
            acceleration: system.unknowns.at_nodes(&state.a),
            joints: joint_cells(&system.interface, model.joints.len(), system.jumps(&state.q), state),
        }
    }
}

fn joint_cells(interface: &Interface, joints: usize, jumps: &[f64], state: &State) -> Vec<JointCell> {
    let mut cells = vec![JointCell::default(); joints];
    let mut areas = vec![0.; joints];
    for (point, memory) in interface.points.iter().zip(&state.joints) {
        let cell = &mut cells[point.joint];
        cell.gap += point.area * (interface.local(point, jumps)[1] + point.law.gap);
        cell.slip += point.area * memory.slip;
        cell.shear_traction += point.area * memory.traction[0];
        cell.normal_traction += point.area * memory.traction[1];
        cell.status = cell.status.max(status_number(memory.status));
        areas[point.joint] += point.area;
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

/// The part of every frame that does not change: points, cells, materials.
pub struct Grid {
    points: Vec<f64>,
    connectivity: Vec<u64>,
    offsets: Vec<u64>,
    types: Vec<CellType>,
    /// number of the material, from 1 in the order of [`Model::materials`]; 0 on interfaces
    material: Vec<i32>,
    /// the points, one for each material that meets at a node
    sites: Sites,
    recovery: Recovery,
}

impl Grid {
    pub fn new(model: &Model) -> Grid {
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
        for joint in &model.joints {
            push(&mut joint.pairs.iter().map(|&p| model.pairs[p].ground), joint.shape, 0);
        }
        let points = sites.spread(&model.mesh.points).into_iter().flat_map(|[x, y]| [x, y, 0.]).collect();
        let recovery = Recovery::new(model, &sites);
        Grid { points, connectivity, offsets, types, material, sites, recovery }
    }

    /// The .vtu file of a frame: inline base64, zlib at its quickest.
    pub fn vtu(&self, frame: &Frame) -> Result<Vec<u8>> {
        let centres = self.recovery.stresses(&frame.total_displacement);
        let piece = UnstructuredGridPiece {
            points: IOBuffer::F64(self.points.clone()),
            cells: Cells {
                cell_verts: VertexNumbers::XML {
                    connectivity: self.connectivity.clone(),
                    offsets: self.offsets.clone(),
                },
                types: self.types.clone(),
            },
            data: Attributes { point: self.point_data(frame, &centres), cell: self.cell_data(frame, &centres) },
        };
        let vtk = Vtk {
            version: Version::new_xml(1, 0),
            title: String::new(),
            byte_order: ByteOrder::LittleEndian,
            data: DataSet::UnstructuredGrid { meta: None, pieces: vec![Piece::Inline(Box::new(piece))] },
            file_path: None,
        };
        let mut bytes = Vec::new();
        vtk.try_into_xml_format(Compressor::ZLib, 1)
            .map_err(|e| e.to_string())
            .and_then(|xml| xml.write(&mut bytes).map_err(|e| e.to_string()))
            .map_err(|e| Error::input(format!("the frame at {} s cannot be written as VTU: {e}", frame.time)))?;
        Ok(bytes)
    }

    /// Recovered stress in single precision, far below its error: seven more numbers a point.
    fn point_data(&self, frame: &Frame, centres: &[CellStress]) -> Vec<Attribute> {
        let vector = |name: &str, values: &[[f64; 2]]| {
            let in_space: Vec<f64> = self.sites.spread(values).into_iter().flat_map(|[x, y]| [x, y, 0.]).collect();
            Attribute::vectors(name).with_data(in_space)
        };
        let recovered = self.recovery.nodal_stresses(&frame.total_displacement, centres);
        let stress: Vec<f32> = recovered.iter().flat_map(|s| six(*s).map(|x| x as f32)).collect();
        let von_mises: Vec<f32> = recovered.iter().map(|s| von_mises(*s) as f32).collect();
        vec![
            vector("displacement", &frame.displacement),
            vector("velocity", &frame.velocity),
            vector("acceleration", &frame.acceleration),
            Attribute::generic("nodal_stress", 6).with_data(stress),
            Attribute::scalars("nodal_von_mises", 1).with_data(von_mises),
        ]
    }

    /// Faces first, then interfaces; what only the other kind has is zero.
    fn cell_data(&self, frame: &Frame, faces: &[CellStress]) -> Vec<Attribute> {
        let tensor = |name: &str, of: fn(&CellStress) -> [f64; 4]| {
            let on_lines = std::iter::repeat_n(0., 6 * frame.joints.len());
            let values: Vec<f64> = faces.iter().flat_map(|f| six(of(f))).chain(on_lines).collect();
            Attribute::generic(name, 6).with_data(values)
        };
        let on_faces = |name: &str, of: fn(&CellStress) -> f64| {
            let on_lines = std::iter::repeat_n(0., frame.joints.len());
            let values: Vec<f64> = faces.iter().map(of).chain(on_lines).collect();
            Attribute::scalars(name, 1).with_data(values)
        };
        let on_lines = |name: &str, of: fn(&JointCell) -> f64| {
            let on_faces = std::iter::repeat_n(0., faces.len());
            let values: Vec<f64> = on_faces.chain(frame.joints.iter().map(of)).collect();
            Attribute::scalars(name, 1).with_data(values)
        };
        let status: Vec<i32> =
            std::iter::repeat_n(0, faces.len()).chain(frame.joints.iter().map(|j| j.status)).collect();
        vec![
            tensor("stress", |f| f.stress),
            tensor("strain", |f| f.strain),
            on_faces("von_mises", |f| von_mises(f.stress)),
            Attribute::scalars("material", 1).with_data(self.material.clone()),
            on_lines("gap", |j| j.gap),
            on_lines("slip", |j| j.slip),
            on_lines("normal_traction", |j| j.normal_traction),
            on_lines("shear_traction", |j| j.shear_traction),
            Attribute::scalars("status", 1).with_data(status),
        ]
    }
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
