//! What the numerical tests share: meshes written as MSH text, cases as JSON, a march, and runs of the program.

#![allow(dead_code)] // each test target uses its own part

pub mod junction;

use coralpipe::model::case::Case;
use coralpipe::model::mesh::{Mesh, Shape};
use coralpipe::model::msh;
use coralpipe::model::resolve::Model;
use coralpipe::solve::law::Scheme;
use coralpipe::solve::start;
use coralpipe::solve::step::{Step, Stepper};
use coralpipe::solve::system::{State, System};
use nalgebra::DMatrix;
use serde_json::Value;
use sprs::CsMat;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::atomic::{AtomicUsize, Ordering};

/// A mesh as it is drawn by a test; the program reads it as MSH 2.2 text.
#[derive(Clone, Default)]
pub struct Drawing {
    nodes: Vec<[f64; 2]>,
    /// dimension and name; the tag of a group is its place here, from 1
    groups: Vec<(usize, String)>,
    /// Gmsh's type, tag of the group, nodes
    cells: Vec<(usize, usize, Vec<usize>)>,
}

impl Drawing {
    pub fn node(&mut self, at: [f64; 2]) -> usize {
        self.nodes.push(at);
        self.nodes.len() - 1
    }

    /// How many nodes there are.
    pub fn len(&self) -> usize {
        self.nodes.len()
    }

    pub fn at(&self, node: usize) -> [f64; 2] {
        self.nodes[node]
    }

    pub fn cell(&mut self, group: &str, shape: Shape, nodes: &[usize]) {
        let kind = match shape {
            Shape::Point => 15,
            Shape::Line2 => 1,
            Shape::Line3 => 8,
            Shape::Tri3 => 2,
            Shape::Quad4 => 3,
            Shape::Tri6 => 9,
            Shape::Quad8 => 16,
        };
        let wanted = (shape.dimension(), group.to_string());
        let known = self.groups.iter().position(|g| *g == wanted).unwrap_or_else(|| {
            self.groups.push(wanted);
            self.groups.len() - 1
        });
        self.cells.push((kind, known + 1, nodes.to_vec()));
    }

    /// With another name for a group.
    pub fn renamed(&self, old: &str, new: &str) -> Drawing {
        let groups = self.groups.iter().map(|(d, name)| (*d, if name == old { new.into() } else { name.clone() }));
        Drawing { groups: groups.collect(), ..self.clone() }
    }

    /// With nodes and cells numbered backwards.
    pub fn backwards(&self) -> Drawing {
        let last = self.nodes.len() - 1;
        let cells = self
            .cells
            .iter()
            .rev()
            .map(|(kind, group, nodes)| (*kind, *group, nodes.iter().map(|n| last - n).collect()));
        Drawing { nodes: self.nodes.iter().rev().copied().collect(), cells: cells.collect(), ..self.clone() }
    }

    pub fn text(&self) -> String {
        let mut text = format!("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n{}\n", self.groups.len());
        for (i, (dimension, name)) in self.groups.iter().enumerate() {
            let _ = writeln!(text, "{dimension} {} \"{name}\"", i + 1);
        }
        let _ = write!(text, "$EndPhysicalNames\n$Nodes\n{}\n", self.nodes.len());
        for (i, [x, y]) in self.nodes.iter().enumerate() {
            let _ = writeln!(text, "{} {x:?} {y:?} 0", i + 1);
        }
        let _ = write!(text, "$EndNodes\n$Elements\n{}\n", self.cells.len());
        for (i, (kind, group, nodes)) in self.cells.iter().enumerate() {
            let nodes: Vec<String> = nodes.iter().map(|n| (n + 1).to_string()).collect();
            let _ = writeln!(text, "{} {kind} 2 {group} {group} {}", i + 1, nodes.join(" "));
        }
        text + "$EndElements\n"
    }

    pub fn mesh(&self) -> Mesh {
        Mesh::from_msh(&msh::parse(self.text().as_bytes(), "drawing.msh").unwrap(), "drawing.msh").unwrap()
    }
}

pub fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// A path that no other test has.
pub fn temporary(name: &str) -> PathBuf {
    static NEXT: AtomicUsize = AtomicUsize::new(0);
    let number = NEXT.fetch_add(1, Ordering::Relaxed);
    std::env::temp_dir().join(format!("coralpipe-{}-{number}-{name}", std::process::id()))
}

pub fn case(json: &Value) -> Case {
    let file = temporary("case.json");
    std::fs::write(&file, json.to_string()).unwrap();
    let case = Case::read(&file, &[]).unwrap();
    std::fs::remove_file(file).unwrap();
    case
}

pub fn model(json: &Value, mesh: &Mesh) -> Model {
    Model::new(&case(json), mesh, false).unwrap()
}

/// The states at t = 0, dt, 2 dt ... of a model, from rest; every step is one step, never cut.
pub fn march(model: &Model, system: &System, watch: impl FnMut(&State)) {
    let rest = State::at_rest(system);
    let start = start::with_acceleration(system, &system.symbolic(), rest, model.start).unwrap();
    march_from(start, model, system, watch);
}

pub fn march_from(start: State, model: &Model, system: &System, mut watch: impl FnMut(&State)) {
    let symbolic = system.symbolic();
    let mut stepper =
        Stepper::new(system, &symbolic, Scheme::Dynamic(model.integrator), model.time.step, model.newton).unwrap();
    watch(&start);
    let mut last = Step::start(start);
    for _ in 0..model.time.steps {
        last = stepper.step(system, &last).unwrap_or_else(|why| panic!("at t = {} s: {why:?}", last.state().time));
        watch(last.state());
    }
}

/// The node of the mesh at a place.
pub fn node_at(mesh: &Mesh, [x, y]: [f64; 2]) -> usize {
    mesh.points.iter().position(|p| (p[0] - x).hypot(p[1] - y) < 1e-9).unwrap()
}

pub fn dense(a: &CsMat<f64>) -> DMatrix<f64> {
    let mut dense = DMatrix::zeros(a.rows(), a.cols());
    a.iter().for_each(|(&value, (i, j))| dense[(i, j)] += value);
    dense
}

pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// The largest magnitude.
pub fn peak(a: &[f64]) -> f64 {
    a.iter().fold(0., |peak: f64, x| peak.max(x.abs()))
}

/// What a run of the program wrote.
pub struct Run {
    /// column of `histories.csv` by its head
    pub histories: BTreeMap<String, Vec<f64>>,
    pub summary: Value,
}

impl Run {
    /// The largest displacement, along x or y, of any probe at any time [m].
    pub fn peak(&self) -> f64 {
        self.displacements().map(|(_, values)| peak(values)).fold(0., f64::max)
    }

    pub fn displacements(&self) -> impl Iterator<Item = (&String, &Vec<f64>)> {
        self.histories.iter().filter(|(name, _)| name.ends_with(".ux") || name.ends_with(".uy"))
    }

    pub fn number(&self, pointer: &str) -> f64 {
        self.summary.pointer(pointer).and_then(Value::as_f64).unwrap_or_else(|| panic!("no {pointer} in the summary"))
    }
}

/// `coralpipe run` of the default case on its committed mesh, a frame at the end only.
pub fn run_twin_pipes(arguments: &[&str]) -> Run {
    let folder = temporary("run");
    let output = Command::new(env!("CARGO_BIN_EXE_coralpipe"))
        .current_dir(root())
        .args(["run", "geo/twin_pipes.json", "--mesh", "meshes/twin_pipes.msh", "--quiet"])
        .args(["--set", "output.every=\"1 s\"", "--out"])
        .arg(&folder)
        .args(arguments)
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = std::fs::read_to_string(folder.join("histories.csv")).unwrap();
    let mut lines = text.lines();
    let heads: Vec<&str> = lines.next().unwrap().split(',').collect();
    let mut histories: BTreeMap<String, Vec<f64>> = BTreeMap::new();
    for line in lines {
        for (head, value) in heads.iter().zip(line.split(',')) {
            histories.entry(head.to_string()).or_default().push(value.parse().unwrap());
        }
    }
    let summary = serde_json::from_slice(&std::fs::read(folder.join("summary.json")).unwrap()).unwrap();
    std::fs::remove_dir_all(folder).unwrap();
    Run { histories, summary }
}
