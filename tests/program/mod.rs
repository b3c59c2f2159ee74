//! Runs of the program in a folder of their own, on a small case: a block of 5 x 5 squares of 1 m that stands on its
//! base, the middle square a body behind an interface, pressed from above.
#![allow(dead_code, reason = "each test file uses its part")]

use std::ffi::OsStr;
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

pub const CASE: &str = r#"{
  "geometry": { "mesh": "block.msh" },
  "materials": { "ground": { "young": "100 MPa", "poisson": 0.3, "density": 2000, "friction": 0.3 },
                 "body": { "young": "1 GPa", "poisson": 0.2, "density": 7800 } },
  "interfaces": { "interface": { "body": "body", "thickness": "1 cm" } },
  "supports": { "base": ["x", "y"] },
  "loads": { "top": { "pressure": { "law": "linear", "peak": "100 kPa", "duration": "20 ms" } } },
  "damping": { "ratio": 0.05 },
  "time": { "step": "0.5 ms", "end": "10 ms" },
  "probes": ["P", "Q"],
  "output": { "every": "1 ms" }
}
"#;

/// Side of the block [m] and number of squares along it.
const SIDE: usize = 5;

/// The block in MSH 2.2; P is a corner of the body, Q a node of the top.
pub fn block_msh() -> String {
    let node = |i: usize, j: usize| j * (SIDE + 1) + i + 1;
    let mut nodes = String::new();
    for (j, i) in (0..=SIDE).flat_map(|j| (0..=SIDE).map(move |i| (j, i))) {
        nodes += &format!("{} {i} {j} 0\n", node(i, j));
    }
    // (type, physical group, nodes): 15 point, 1 line, 3 quadrangle
    let mut elements = vec![(15, 6, vec![node(2, 3)]), (15, 7, vec![node(2, 5)])];
    for i in 0..SIDE {
        elements.push((1, 4, vec![node(i, 0), node(i + 1, 0)]));
        elements.push((1, 5, vec![node(i, SIDE), node(i + 1, SIDE)]));
    }
    let ring = [node(2, 2), node(3, 2), node(3, 3), node(2, 3)];
    elements.extend((0..4).map(|k| (1, 3, vec![ring[k], ring[(k + 1) % 4]])));
    for (j, i) in (0..SIDE).flat_map(|j| (0..SIDE).map(move |i| (j, i))) {
        let group = if (i, j) == (2, 2) { 2 } else { 1 };
        elements.push((3, group, vec![node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)]));
    }
    let line = |(n, (kind, group, nodes)): (usize, &(usize, usize, Vec<usize>))| {
        let nodes: Vec<String> = nodes.iter().map(ToString::to_string).collect();
        format!("{} {kind} 2 {group} 1 {}\n", n + 1, nodes.join(" "))
    };
    let count = elements.len();
    let elements: String = elements.iter().enumerate().map(line).collect();
    format!(
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n7\n2 1 \"ground\"\n2 2 \"body\"\n1 3 \"interface\"\n\
         1 4 \"base\"\n1 5 \"top\"\n0 6 \"P\"\n0 7 \"Q\"\n$EndPhysicalNames\n$Nodes\n{}\n{nodes}$EndNodes\n\
         $Elements\n{count}\n{elements}$EndElements\n",
        (SIDE + 1) * (SIDE + 1)
    )
}

/// A folder of its own with block.json and block.msh; removed in the end.
pub struct Bench {
    pub folder: PathBuf,
}

/// How a run of the program ended.
#[derive(Debug, Clone)]
pub struct Outcome {
    /// none if a signal ended it
    pub code: Option<i32>,
    pub stdout: String,
    pub stderr: String,
}

/// A run that takes longer has run for ever.
const LONGEST: Duration = Duration::from_secs(60);

impl Bench {
    pub fn new(test: &str) -> Bench {
        let folder = std::env::temp_dir().join(format!("coralpipe-{}-{test}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        let bench = Bench { folder };
        bench.write("block.json", CASE);
        bench.write("block.msh", block_msh());
        bench
    }

    pub fn path(&self, name: impl AsRef<Path>) -> PathBuf {
        self.folder.join(name)
    }

    pub fn write(&self, name: impl AsRef<Path>, content: impl AsRef<[u8]>) {
        fs::write(self.path(name), content).unwrap();
    }

    /// The program in this folder, with no gmsh to be found.
    pub fn program<A: AsRef<OsStr>>(&self, arguments: &[A]) -> Command {
        let mut program = Command::new(env!("CARGO_BIN_EXE_coralpipe"));
        program.args(arguments).current_dir(&self.folder).stdin(Stdio::null());
        program.env("PATH", self.path("no_programs")).env_remove("CORALPIPE_GMSH");
        program
    }

    pub fn run<A: AsRef<OsStr>>(&self, arguments: &[A]) -> Outcome {
        let mut program = self.program(arguments);
        let (stdout, stderr) = (self.path(".stdout"), self.path(".stderr"));
        program.stdout(File::create(&stdout).unwrap()).stderr(File::create(&stderr).unwrap());
        let code = code_of(program.spawn().unwrap());
        let text = |path| String::from_utf8_lossy(&fs::read(path).unwrap()).into_owned();
        Outcome { code, stdout: text(stdout), stderr: text(stderr) }
    }

    /// `line` in words that blanks separate.
    pub fn run_line(&self, line: &str) -> Outcome {
        self.run(&line.split_whitespace().collect::<Vec<_>>())
    }
}

impl Drop for Bench {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.folder);
    }
}

/// Waits for the end: the exit code, none after a signal.
pub fn code_of(mut child: Child) -> Option<i32> {
    let start = Instant::now();
    loop {
        match child.try_wait().unwrap() {
            Some(status) => return status.code(),
            None if start.elapsed() > LONGEST => {
                child.kill().unwrap();
                panic!("the program had not ended after {LONGEST:?}");
            }
            None => std::thread::sleep(Duration::from_millis(2)),
        }
    }
}

/// Fails after 20 ms: friction so strong, and iterations so few, that no statuses agree with their jumps.
pub const FAILS: [&str; 8] = [
    "interfaces.interface.friction=50",
    "interfaces.interface.tangential_stiffness=1e12 Pa/m",
    "newton.max_iterations=1",
    "time.step=5 ms",
    "time.end=100 ms",
    "output.every=5 ms",
    "loads={\"top\":{\"traction\":{\"law\":\"table\",\"times\":[0,0.020,0.025],\"values\":[0,0,1e7],\"direction\":[1,1]}}}",
    "damping=null",
];

/// A run that ends without convergence.
pub fn failing_run(bench: &Bench) -> Outcome {
    let sets = FAILS.iter().flat_map(|set| ["--set", set]);
    bench.run(&["run", "block.json"].into_iter().chain(sets).collect::<Vec<_>>())
}
